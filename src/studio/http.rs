//! Requests and answers of HTTP/1.1, one a connection, within limits of size and time. httparse reads the head.

use std::io::{self, Read, Write};
use std::net::{Shutdown, TcpStream};
use std::time::{Duration, Instant};

/// Longest head of a request, bytes. A browser's are below one kilobyte.
const LONGEST_HEAD: usize = 8 << 10;
/// Most fields of a head.
const MOST_FIELDS: usize = 64;
/// Longest body of a request, bytes. The largest act names the edges of a long chain.
const LONGEST_BODY: usize = 64 << 10;
/// Time in which a whole request must have come.
const IN_TIME: Duration = Duration::from_secs(5);
/// Time for which a client may not take what is written.
const STUCK: Duration = Duration::from_secs(10);
/// Bytes and time that are spent on the rest of a refused request, so that the client reads the answer.
const DRAINED: usize = 256 << 10;
const DRAINING: Duration = Duration::from_millis(300);

/// Method of a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Method {
    Get,
    Post,
}

/// The head of a request.
#[derive(Clone, Debug)]
pub(super) struct Head {
    pub(super) method: Method,
    /// As sent, without what follows a question mark.
    pub(super) path: String,
    /// Names in lower case.
    pub(super) fields: Vec<(String, String)>,
}

impl Head {
    /// The value of a field that is there exactly once.
    pub(super) fn one(&self, name: &str) -> Option<&str> {
        let mut found = self.fields.iter().filter(|(own, _)| own == name);
        let (_, value) = found.next()?;
        found.next().is_none().then_some(value.as_str())
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.fields.iter().any(|(own, _)| own == name)
    }

    /// Bytes of the body.
    fn length(&self) -> Result<usize, Status> {
        if self.has("transfer-encoding") {
            return Err(Status::Bad);
        }
        if !self.has("content-length") {
            return Ok(0);
        }
        let text = self.one("content-length").ok_or(Status::Bad)?;
        if text.is_empty() || !text.bytes().all(|b| b.is_ascii_digit()) {
            return Err(Status::Bad);
        }
        text.parse().ok().filter(|length| *length <= LONGEST_BODY).ok_or(Status::TooLarge)
    }
}

/// Status of an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Status {
    Done,
    Bad,
    Forbidden,
    NotFound,
    NotAllowed,
    Conflict,
    TooLarge,
    HeadTooLarge,
    TooMany,
    Busy,
}

impl Status {
    fn line(self) -> &'static str {
        match self {
            Self::Done => "200 OK",
            Self::Bad => "400 Bad Request",
            Self::Forbidden => "403 Forbidden",
            Self::NotFound => "404 Not Found",
            Self::NotAllowed => "405 Method Not Allowed",
            Self::Conflict => "409 Conflict",
            Self::TooLarge => "413 Content Too Large",
            Self::HeadTooLarge => "431 Request Header Fields Too Large",
            Self::TooMany => "429 Too Many Requests",
            Self::Busy => "503 Service Unavailable",
        }
    }
}

/// Fields of every answer. The page's scripts, styles and data come from here only; nobody may frame it or keep it.
const FIELDS: &str = "Cache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\nX-Frame-Options: DENY\r\n\
                      Referrer-Policy: no-referrer\r\nCross-Origin-Resource-Policy: same-origin\r\n\
                      Cross-Origin-Opener-Policy: same-origin\r\nContent-Security-Policy: default-src 'none'; \
                      script-src 'self'; style-src 'self'; connect-src 'self'; img-src data:; base-uri 'none'; \
                      form-action 'none'; frame-ancestors 'none'\r\nConnection: close\r\n";

/// A client.
pub(super) struct Client {
    stream: TcpStream,
    until: Instant,
    /// Bytes that were read beyond the head.
    rest: Vec<u8>,
}

impl Client {
    /// # Errors
    /// A stream whose limits of time cannot be set.
    pub(super) fn new(stream: TcpStream) -> io::Result<Self> {
        stream.set_write_timeout(Some(STUCK))?;
        stream.set_nodelay(true)?;
        Ok(Self { stream, until: Instant::now() + IN_TIME, rest: Vec::new() })
    }

    /// The head of the request. `None` of a client that goes away or takes too long.
    ///
    /// # Errors
    /// The status that refuses it.
    pub(super) fn head(&mut self) -> Result<Option<Head>, Status> {
        let mut bytes = Vec::new();
        loop {
            match parsed(&bytes)? {
                Some((head, length)) => {
                    self.rest = bytes.split_off(length);
                    return Ok(Some(head));
                }
                None if bytes.len() >= LONGEST_HEAD => return Err(Status::HeadTooLarge),
                None => {}
            }
            let room = LONGEST_HEAD - bytes.len();
            if self.more(&mut bytes, room).is_none() {
                return Ok(None);
            }
        }
    }

    /// The body of the request. `None` of a client that goes away or takes too long.
    ///
    /// # Errors
    /// The status that refuses it.
    pub(super) fn body(&mut self, head: &Head) -> Result<Option<Vec<u8>>, Status> {
        let length = head.length()?;
        let mut bytes = std::mem::take(&mut self.rest);
        if bytes.len() > length {
            return Err(Status::Bad);
        }
        while bytes.len() < length {
            let room = length - bytes.len();
            if self.more(&mut bytes, room).is_none() {
                return Ok(None);
            }
        }
        Ok(Some(bytes))
    }

    /// Reads more, at most `room` bytes. `None` at the end, or when the time is up.
    fn more(&mut self, bytes: &mut Vec<u8>, room: usize) -> Option<()> {
        let left = self.until.checked_duration_since(Instant::now()).filter(|left| !left.is_zero())?;
        self.stream.set_read_timeout(Some(left)).ok()?;
        let mut chunk = [0; 4096];
        let most = room.min(chunk.len());
        let read = self.stream.read(&mut chunk[..most]).ok().filter(|read| *read > 0)?;
        bytes.extend_from_slice(&chunk[..read]);
        Some(())
    }

    /// Answers with a body. A client that is gone needs no answer.
    pub(super) fn answer(mut self, status: Status, kind: &str, body: &[u8]) {
        let head = format!(
            "HTTP/1.1 {}\r\n{FIELDS}Content-Type: {kind}\r\nContent-Length: {}\r\n\r\n",
            status.line(),
            body.len()
        );
        let written = self.stream.write_all(head.as_bytes()).and_then(|()| self.stream.write_all(body));
        if written.is_ok() && status != Status::Done {
            self.drain();
        }
    }

    /// Begins a stream of events (`text/event-stream`).
    ///
    /// # Errors
    /// A client that is gone.
    pub(super) fn stream(mut self) -> io::Result<TcpStream> {
        let head = format!("HTTP/1.1 200 OK\r\n{FIELDS}Content-Type: text/event-stream\r\n\r\n");
        self.stream.write_all(head.as_bytes())?;
        Ok(self.stream)
    }

    /// Reads what a refused client still sends, for a while: unread bytes would take the answer from it.
    fn drain(&mut self) {
        let _ = self.stream.shutdown(Shutdown::Write);
        self.until = Instant::now() + DRAINING;
        let mut left = DRAINED;
        let mut bytes = Vec::new();
        while left > 0 && self.more(&mut bytes, left).is_some() {
            left -= bytes.len();
            bytes.clear();
        }
    }
}

/// Closes a connection that is one too many, without waiting for anything.
pub(super) fn turn_away(mut stream: &TcpStream) {
    let answer = format!("HTTP/1.1 {}\r\nConnection: close\r\nContent-Length: 0\r\n\r\n", Status::Busy.line());
    let _ = stream.set_nonblocking(true).and_then(|()| stream.write_all(answer.as_bytes()));
}

/// The head at the beginning of these bytes and its length, if it is all there.
fn parsed(bytes: &[u8]) -> Result<Option<(Head, usize)>, Status> {
    let mut fields = [httparse::EMPTY_HEADER; MOST_FIELDS];
    let mut request = httparse::Request::new(&mut fields);
    let length = match request.parse(bytes) {
        Ok(httparse::Status::Complete(length)) => length,
        Ok(httparse::Status::Partial) => return Ok(None),
        Err(httparse::Error::TooManyHeaders) => return Err(Status::HeadTooLarge),
        Err(_) => return Err(Status::Bad),
    };
    let method = match request.method {
        Some("GET") => Method::Get,
        Some("POST") => Method::Post,
        _ => return Err(Status::NotAllowed),
    };
    let path = request.path.unwrap_or_default();
    let path = path.split('?').next().unwrap_or_default().to_owned();
    let text = |value: &[u8]| String::from_utf8(value.to_vec()).map_err(|_| Status::Bad);
    let fields: Result<_, Status> =
        request.headers.iter().map(|field| Ok((field.name.to_ascii_lowercase(), text(field.value)?))).collect();
    Ok(Some((Head { method, path, fields: fields? }, length)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heads_are_read_within_their_limits() {
        let (head, length) = parsed(b"GET /a/../b?c HTTP/1.1\r\nHost: x\r\n\r\nrest").expect("read").expect("whole");
        assert_eq!((head.path.as_str(), head.one("host"), length), ("/a/../b", Some("x"), 35));
        assert!(parsed(b"GET / HTTP/1.1\r\nHost:").expect("so far").is_none());
        assert_eq!(parsed(b"\x16\x03\x01\x02\x00\x01\x00").err(), Some(Status::Bad));
        assert_eq!(parsed(b"DELETE / HTTP/1.1\r\n\r\n").err(), Some(Status::NotAllowed));
        let many = format!("GET / HTTP/1.1\r\n{}\r\n", "A: b\r\n".repeat(MOST_FIELDS + 1));
        assert_eq!(parsed(many.as_bytes()).err(), Some(Status::HeadTooLarge));
    }

    #[test]
    fn a_length_is_said_once_and_within_the_limit() {
        let length = |fields: &str| {
            let text = format!("POST / HTTP/1.1\r\n{fields}\r\n");
            parsed(text.as_bytes()).expect("read").expect("whole").0.length()
        };
        assert_eq!(length(""), Ok(0));
        assert_eq!(length("Content-Length: 12\r\n"), Ok(12));
        assert_eq!(length("Content-Length: +12\r\n"), Err(Status::Bad));
        assert_eq!(length("Content-Length: 12\r\nContent-Length: 13\r\n"), Err(Status::Bad));
        assert_eq!(length("Content-Length: 12\r\nTransfer-Encoding: chunked\r\n"), Err(Status::Bad));
        assert_eq!(length("Content-Length: 99999999999999999999\r\n"), Err(Status::TooLarge));
        assert_eq!(length("Content-Length: 65537\r\n"), Err(Status::TooLarge));
    }
}
