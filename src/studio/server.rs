//! The server: a thread a connection, few connections at a time, and nothing but what is in memory.

use std::io::Write;
use std::net::{TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

use serde::Deserialize;

use super::acts::{Act, ActError};
use super::door::Door;
use super::http::{Client, Head, Method, Status, turn_away};
use super::page;
use super::session::{News, Part, Session};

/// Connections at a time. A browser opens six to one host.
const MOST_CONNECTIONS: usize = 48;
/// Pages that are told of changes at a time.
const MOST_STREAMS: usize = 8;
/// Stack of a connection's thread, bytes. It checks garment files, whose nesting is limited.
const STACK: usize = 4 << 20;
/// Time after which a page that nothing is told to is written to, to see whether it is still there.
const HEARTBEAT: Duration = Duration::from_secs(10);
/// Least time between two messages to a page.
const PACE: Duration = Duration::from_millis(50);

const TEXT: &str = "text/plain; charset=utf-8";
const JSON: &str = "application/json";
const GLB: &str = "model/gltf-binary";

/// All that connections share.
struct House {
    door: Door,
    session: Arc<Session>,
    streams: Arc<AtomicUsize>,
}

/// One of a limited number.
struct Place(Arc<AtomicUsize>);

impl Place {
    fn take(of: &Arc<AtomicUsize>, most: usize) -> Option<Self> {
        let taken = of.fetch_update(Ordering::SeqCst, Ordering::SeqCst, |n| (n < most).then_some(n + 1));
        taken.is_ok().then(|| Self(Arc::clone(of)))
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::SeqCst);
    }
}

/// Serves until the process ends.
pub(super) fn serve(listener: &TcpListener, door: Door, session: Arc<Session>) {
    let house = Arc::new(House { door, session, streams: Arc::default() });
    let connections = Arc::default();
    for stream in listener.incoming() {
        // The system may have no descriptor left for a while.
        let Ok(stream) = stream else {
            thread::sleep(PACE);
            continue;
        };
        // No thread is started for those that come too many.
        let Some(place) = Place::take(&connections, MOST_CONNECTIONS) else {
            turn_away(&stream);
            continue;
        };
        let house = Arc::clone(&house);
        let work = move || {
            let _place = place;
            if let Ok(client) = Client::new(stream) {
                house.serve(client);
            }
        };
        // Without a thread the connection is closed.
        let _ = thread::Builder::new().name("page".into()).stack_size(STACK).spawn(work);
    }
}

/// An act as the page sends it.
#[derive(Deserialize)]
struct Message {
    /// Number of the state that the page shows.
    base: u64,
    act: Act,
}

impl House {
    fn serve(&self, mut client: Client) {
        let head = match client.head() {
            Ok(Some(head)) => head,
            Ok(None) => return,
            Err(status) => return refuse(client, status),
        };
        match self.door.admit(&head).map(str::to_owned) {
            Err(status) => refuse(client, status),
            Ok(path) if head.method == Method::Post => self.post(client, &head, &path),
            Ok(path) => self.get(client, &path),
        }
    }

    /// Answers from a fixed list. No path leads to a file.
    fn get(&self, client: Client, path: &str) {
        let (kind, part) = match path {
            "" => return client.answer(Status::Done, "text/html; charset=utf-8", page::html().as_bytes()),
            "studio.css" => return client.answer(Status::Done, "text/css; charset=utf-8", page::css().as_bytes()),
            "studio.js" => {
                return client.answer(Status::Done, "text/javascript; charset=utf-8", page::script().as_bytes());
            }
            "events" => return self.tell(client),
            "state.json" => (JSON, Part::State),
            "about.json" => (JSON, Part::About),
            "report.json" => (JSON, Part::Report),
            "garment.glb" => (GLB, Part::Garment),
            "body.glb" => (GLB, Part::Body),
            _ => return refuse(client, Status::NotFound),
        };
        client.answer(Status::Done, kind, &self.session.part(&part));
    }

    fn post(&self, mut client: Client, head: &Head, path: &str) {
        if path != "act" {
            return refuse(client, Status::NotFound);
        }
        // A form of another page cannot send this type.
        if head.one("content-type") != Some(JSON) {
            return refuse(client, Status::Bad);
        }
        let body = match client.body(head) {
            Ok(Some(body)) => body,
            Ok(None) => return,
            Err(status) => return refuse(client, status),
        };
        let Ok(message) = serde_json::from_slice::<Message>(&body) else { return refuse(client, Status::Bad) };
        match self.session.act(message.base, &message.act) {
            Ok(()) => client.answer(Status::Done, TEXT, b"done"),
            Err(error) => {
                let status = if matches!(error, ActError::Old) { Status::Conflict } else { Status::Bad };
                client.answer(status, TEXT, error.to_string().as_bytes());
            }
        }
    }

    /// Tells a page what is new until it goes away. There is no queue: a slow page is told the latest.
    fn tell(&self, client: Client) {
        let Some(_place) = Place::take(&self.streams, MOST_STREAMS) else { return refuse(client, Status::Busy) };
        let Ok(mut stream) = client.stream() else { return };
        let mut old = News::default();
        loop {
            let message = match self.session.news(&old, HEARTBEAT) {
                Some(news) => {
                    let text = serde_json::to_string(&news).unwrap_or_default();
                    old = news;
                    format!("data: {text}\n\n")
                }
                None => ":\n\n".to_owned(),
            };
            if write(&mut stream, &message).is_err() {
                return;
            }
            thread::sleep(PACE);
        }
    }
}

fn write(stream: &mut TcpStream, text: &str) -> std::io::Result<()> {
    stream.write_all(text.as_bytes()).and_then(|()| stream.flush())
}

fn refuse(client: Client, status: Status) {
    client.answer(status, TEXT, b"refused");
}
