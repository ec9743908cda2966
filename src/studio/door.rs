//! The door: it lets in the page that was opened with the address, and nobody else.
//!
//! Every program and every web page on this machine can reach the port. The token in the address keeps them out. `Host`
//! keeps out pages whose name was made to lead to 127.0.0.1, `Origin` and `Sec-Fetch-Site` keep out pages of others.

use std::fmt::Write as _;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use super::StudioError;
use super::http::{Head, Method, Status};

/// Bytes of the token: 256 bits, which nobody guesses.
const TOKEN: usize = 32;
/// Requests that may come at once, and those that may follow in a second. A page needs three at each change of the
/// garment.
const BURST: f64 = 200.0;
const PER_SECOND: f64 = 50.0;

/// The door of a studio.
pub(super) struct Door {
    token: String,
    host: String,
    /// Requests that may come now, and when that was known.
    left: Mutex<(f64, Instant)>,
}

impl Door {
    /// A door with a new token for a port.
    ///
    /// # Errors
    /// [`StudioError::Random`].
    pub(super) fn new(port: u16) -> Result<Self, StudioError> {
        let mut bytes = [0u8; TOKEN];
        getrandom::fill(&mut bytes).map_err(|e| StudioError::Random(e.to_string()))?;
        let token = bytes.iter().fold(String::new(), |mut text, byte| {
            let _ = write!(text, "{byte:02x}");
            text
        });
        Ok(Self { token, host: format!("127.0.0.1:{port}"), left: Mutex::new((BURST, Instant::now())) })
    }

    /// The address of the page.
    pub(super) fn address(&self) -> String {
        format!("http://{}/{}/", self.host, self.token)
    }

    /// The part of a request's path behind the token, if the request may come in.
    ///
    /// # Errors
    /// The status that refuses it.
    pub(super) fn admit<'a>(&self, head: &'a Head) -> Result<&'a str, Status> {
        if head.one("host") != Some(self.host.as_str()) {
            return Err(Status::Forbidden);
        }
        let rest = head.path.strip_prefix('/').and_then(|path| path.split_once('/'));
        let (_, rest) = rest.filter(|(token, _)| same(token, &self.token)).ok_or(Status::Forbidden)?;
        let own = format!("http://{}", self.host);
        let origin = head.one("origin");
        let is_foreign = origin.is_some_and(|origin| origin != own) || (head.has("origin") && origin.is_none());
        // The page itself is opened from anywhere: by a click in a terminal, by a file.
        let is_page = head.method == Method::Get && rest.is_empty();
        let site = head.one("sec-fetch-site");
        let is_apart = !is_page && site.is_some_and(|site| site != "same-origin");
        let is_unsaid = head.method == Method::Post && origin.is_none();
        if is_foreign || is_apart || is_unsaid {
            return Err(Status::Forbidden);
        }
        if self.takes() { Ok(rest) } else { Err(Status::TooMany) }
    }

    /// Counts a request. Whether it is one of few.
    fn takes(&self) -> bool {
        let mut left = self.left.lock().unwrap_or_else(PoisonError::into_inner);
        let now = Instant::now();
        let refilled = left.0 + PER_SECOND * now.duration_since(left.1).as_secs_f64();
        *left = (refilled.min(BURST), now);
        let takes = left.0 >= 1.0;
        left.0 -= if takes { 1.0 } else { 0.0 };
        takes
    }
}

/// Whether two texts are the same, in a time that does not depend on where they differ.
fn same(a: &str, b: &str) -> bool {
    a.len() == b.len() && a.bytes().zip(b.bytes()).fold(0, |differ, (a, b)| differ | (a ^ b)) == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn head(method: Method, path: &str, fields: &[(&str, &str)]) -> Head {
        let fields = fields.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
        Head { method, path: path.to_owned(), fields }
    }

    #[test]
    fn only_the_page_comes_in() {
        let door = Door::new(4711).expect("random numbers");
        let inside = format!("/{}/", door.token);
        let host = ("host", "127.0.0.1:4711");
        let own = ("origin", "http://127.0.0.1:4711");
        let get = |path: &str, fields: &[(&str, &str)]| door.admit(&head(Method::Get, path, fields)).map(str::to_owned);
        let post = |fields: &[(&str, &str)]| {
            door.admit(&head(Method::Post, &format!("{inside}act"), fields)).map(str::to_owned)
        };
        assert_eq!(get(&inside, &[host]), Ok(String::new()));
        assert_eq!(
            get(&format!("{inside}state.json"), &[host, ("sec-fetch-site", "same-origin")]),
            Ok("state.json".into())
        );
        assert_eq!(post(&[host, own]), Ok("act".into()));
        let refused = Err(Status::Forbidden);
        assert_eq!(get("/", &[host]), refused);
        assert_eq!(get(&inside.replace(['a', 'b', 'c', '1'], "0"), &[host]), refused);
        assert_eq!(get(&inside[..inside.len() - 2], &[host]), refused);
        assert_eq!(get(&inside, &[]), refused);
        assert_eq!(get(&inside, &[("host", "evil.example:4711")]), refused);
        assert_eq!(get(&inside, &[("host", "localhost:4711")]), refused);
        assert_eq!(get(&inside, &[host, ("host", "evil.example")]), refused);
        assert_eq!(post(&[host]), refused);
        assert_eq!(post(&[host, ("origin", "null")]), refused);
        assert_eq!(post(&[host, ("origin", "http://127.0.0.1:4712")]), refused);
        assert_eq!(post(&[host, own, ("origin", "http://evil.example")]), refused);
        assert_eq!(post(&[host, own, ("sec-fetch-site", "cross-site")]), refused);
        assert_eq!(get(&format!("{inside}state.json"), &[host, ("sec-fetch-site", "cross-site")]), refused);
    }

    #[test]
    fn too_many_requests_are_refused() {
        let door = Door::new(4711).expect("random numbers");
        let page = head(Method::Get, &format!("/{}/", door.token), &[("host", "127.0.0.1:4711")]);
        let answers: Vec<_> = (0..1000).map(|_| door.admit(&page)).collect();
        assert!(answers[..100].iter().all(Result::is_ok));
        assert!(answers.contains(&Err(Status::TooMany)));
        // Nobody without the token uses them up.
        let door = Door::new(4711).expect("random numbers");
        let other = head(Method::Get, "/guess/", &[("host", "127.0.0.1:4711")]);
        assert!((0..1000).all(|_| door.admit(&other) == Err(Status::Forbidden)));
        let page = head(Method::Get, &format!("/{}/", door.token), &[("host", "127.0.0.1:4711")]);
        assert!(door.admit(&page).is_ok());
    }

    #[test]
    fn tokens_differ() {
        let [a, b] = [1, 2].map(|_| Door::new(1).expect("random numbers").token);
        assert!(a != b && a.len() == 2 * TOKEN);
    }
}
