//! A studio that runs, and a client that speaks to it byte by byte.

#![allow(dead_code, reason = "every test of the studio uses a part of this")]

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

/// Longest time for which a test waits: many times what it takes on a busy machine.
pub(crate) const PATIENCE: Duration = Duration::from_secs(120);

/// A studio of a garment file. It ends with this value.
pub(crate) struct Served {
    pub(crate) child: Child,
    /// Its address, as printed.
    pub(crate) address: String,
    /// `127.0.0.1:PORT`
    pub(crate) host: String,
    /// The path of the page: `/TOKEN/`.
    pub(crate) inside: String,
    pub(crate) file: PathBuf,
}

impl Served {
    pub(crate) fn start(file: &Path, more: &[&str]) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_toile"));
        command.arg("studio").arg(file).arg("--no-open").args(more);
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut child = command.spawn().expect("started");
        let mut line = String::new();
        BufReader::new(child.stdout.take().expect("piped")).read_line(&mut line).expect("an address");
        let address = line.trim_end().to_owned();
        let rest = address.strip_prefix("http://").expect("an address");
        let (host, inside) = rest.split_once('/').expect("a token");
        let (host, inside) = (host.to_owned(), format!("/{inside}"));
        Self { child, address, host, inside, file: file.to_owned() }
    }

    pub(crate) fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(&self.host).expect("connected");
        stream.set_read_timeout(Some(Duration::from_secs(30))).expect("set");
        stream
    }

    /// Sends bytes and gives the status and the body of the answer. 0 where the connection was closed without one.
    pub(crate) fn raw(&self, bytes: &[u8]) -> (u16, String) {
        let mut stream = self.connect();
        // The studio may have refused before it is all sent.
        let _ = stream.write_all(bytes);
        answer(&mut stream)
    }

    pub(crate) fn get(&self, path: &str) -> (u16, String) {
        self.raw(format!("GET {path} HTTP/1.1\r\nHost: {}\r\n\r\n", self.host).as_bytes())
    }

    /// A part of the data, as the page fetches it.
    pub(crate) fn part(&self, name: &str) -> Value {
        let (status, body) = self.get(&format!("{}{name}", self.inside));
        assert_eq!(status, 200, "{name}: {body}");
        serde_json::from_str(&body).expect("JSON")
    }

    pub(crate) fn state(&self) -> Value {
        self.part("state.json")
    }

    /// A message as the page sends it.
    pub(crate) fn message(&self, body: &str) -> String {
        format!(
            "POST {}act HTTP/1.1\r\nHost: {}\r\nOrigin: http://{}\r\nContent-Type: application/json\r\n\
             Content-Length: {}\r\n\r\n{body}",
            self.inside,
            self.host,
            self.host,
            body.len()
        )
    }

    /// Does an act for the present state.
    pub(crate) fn act(&self, act: &Value) -> (u16, String) {
        let body = json!({ "base": self.state()["version"], "act": act }).to_string();
        self.raw(self.message(&body).as_bytes())
    }

    /// The first state that is as wanted, and the time that it took.
    pub(crate) fn waited(&self, wanted: impl Fn(&Value) -> bool) -> (Value, Duration) {
        let begin = Instant::now();
        loop {
            let state = self.state();
            if wanted(&state) {
                return (state, begin.elapsed());
            }
            assert!(begin.elapsed() < PATIENCE, "{state}");
            std::thread::sleep(Duration::from_millis(60));
        }
    }

    pub(crate) fn text(&self) -> String {
        std::fs::read_to_string(&self.file).expect("a file")
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The status and the body of an answer.
pub(crate) fn answer(stream: &mut TcpStream) -> (u16, String) {
    let mut bytes = Vec::new();
    let _ = stream.read_to_end(&mut bytes);
    let text = String::from_utf8_lossy(&bytes).into_owned();
    let status = text.split(' ').nth(1).and_then(|word| word.parse().ok()).unwrap_or(0);
    (status, text.split_once("\r\n\r\n").map(|(_, body)| body.to_owned()).unwrap_or_default())
}
