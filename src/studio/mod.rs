//! `toile studio`: a garment file and its garment as a live page on this machine.
//!
//! ```text
//! editor ─▶ garment file ◀─ acts ◀──────── page (src/report/page, src/studio/page)
//!               │                            ▲
//!               └─▶ watch ─▶ session ─▶ server (127.0.0.1)
//!                             ▲
//!               worker process ┘ frames: body, coarse garment, finer ones, report
//! ```
//!
//! A `Session` holds all that the page shows. One thread watches the file and starts a process for each state of it
//! that has no mistakes; a newer state ends that process. The `server` answers the page, behind a `door` that lets
//! nobody else in. An `act` changes the file in one place and can be undone.

mod acts;
mod door;
mod earlier;
mod frames;
mod history;
mod http;
mod making;
mod names;
mod page;
mod private;
mod server;
mod session;
mod view;
mod wanted;
mod watch;
mod worker;

use std::ffi::OsString;
use std::net::{Ipv4Addr, TcpListener};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::Arc;

pub use private::opened;
pub use wanted::SPACINGS;
pub use worker::write_frames;

use door::Door;
use session::Session;
use wanted::Wanted;

/// A studio that cannot be opened.
#[derive(Debug, thiserror::Error)]
pub enum StudioError {
    /// The garment file cannot be read at all.
    #[error("{}: {why}", file.display())]
    File {
        /// The file.
        file: PathBuf,
        /// The reason.
        why: String,
    },
    /// A size that the file does not have.
    #[error("{}: it has no size '{size}'; leave out --size to see which it has", file.display())]
    Size {
        /// The file.
        file: PathBuf,
        /// The size.
        size: String,
    },
    /// The port is in use, or may not be used.
    #[error("cannot serve on port {port} of 127.0.0.1: {why}; choose another one with --port, or leave it out")]
    Port {
        /// The port.
        port: u16,
        /// The system's error.
        why: std::io::Error,
    },
    /// The system gives no random numbers, without which the page cannot be protected.
    #[error("the system gives no random numbers: {0}")]
    Random(String),
    /// The system gives no thread.
    #[error("cannot start a thread: {0}")]
    Thread(std::io::Error),
}

/// The means of a studio.
#[derive(Clone, Debug)]
pub struct StudioOptions {
    /// The port. 0 lets the system choose.
    pub port: u16,
    /// Spacing of the mesh at the beginning, mm.
    pub spacing: f64,
    /// Size of the garment at the beginning. `None` is as it is drawn and altered.
    pub size: Option<String>,
    /// The command that starts this program again. It makes the garment.
    pub program: Vec<OsString>,
    /// Threads of that process. `None` is as many as the machine has.
    pub threads: Option<NonZeroUsize>,
}

/// A studio whose port is open.
pub struct Studio {
    listener: TcpListener,
    door: Door,
    session: Arc<Session>,
    options: StudioOptions,
}

impl Studio {
    /// Opens a studio for a garment file.
    ///
    /// # Errors
    /// [`StudioError`]: a file that cannot be read, or a port that cannot be had.
    pub fn open(file: &Path, options: StudioOptions) -> Result<Self, StudioError> {
        let wanted = Wanted { spacing: options.spacing, size: options.size.clone() };
        let session = Session::new(file, wanted)?;
        let port = |why| StudioError::Port { port: options.port, why };
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, options.port)).map_err(port)?;
        let door = Door::new(listener.local_addr().map_err(port)?.port())?;
        Ok(Self { listener, door, session: Arc::new(session), options })
    }

    /// The address of the page, which holds the token.
    pub fn address(&self) -> String {
        self.door.address()
    }

    /// Serves until the process ends.
    ///
    /// # Errors
    /// [`StudioError::Thread`] when the watching thread cannot be started.
    pub fn serve(self) -> Result<(), StudioError> {
        watch::start(Arc::clone(&self.session), &self.options).map_err(StudioError::Thread)?;
        server::serve(&self.listener, self.door, self.session);
        Ok(())
    }
}
