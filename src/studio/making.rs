//! The process that makes the garment. It ends when the studio does, or when the file has changed again.

use std::ffi::OsStr;
use std::io::BufReader;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::thread::{self, JoinHandle};

use super::StudioOptions;
use super::frames::Frame;
use super::session::Session;
use super::wanted::Wanted;
use crate::io::files::Private;

/// A garment that is being made.
pub(super) struct Making {
    child: Child,
    /// The file with the garment that it goes on from.
    _earlier: Option<Private>,
    reader: Option<JoinHandle<()>>,
}

impl Making {
    /// Starts to make the garment of a file. Its frames go to the session.
    ///
    /// # Errors
    /// A process or a thread that cannot be started.
    pub(super) fn start(
        file: &Path,
        wanted: &Wanted,
        options: &StudioOptions,
        session: Arc<Session>,
    ) -> std::io::Result<Self> {
        let mut words = options.program.iter();
        let mut command = Command::new(words.next().cloned().unwrap_or_default());
        let earlier = session.earlier();
        // The worker ends when its standard input does.
        command.args(words).arg("--worker=0");
        command.args(options.threads.map(|threads| format!("--threads={threads}")));
        command.arg("studio").arg("--frames").arg(format!("--spacing={}", wanted.spacing));
        command.args(earlier.iter().flat_map(|file| [OsStr::new("--earlier"), file.path().as_os_str()]));
        command.args(wanted.size.iter().map(|size| format!("--size={size}"))).arg("--").arg(file);
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
        // Ctrl-C on a terminal is for the studio.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let mut child = command.spawn()?;
        let out = child.stdout.take();
        let read = move || {
            let mut from = out.map(BufReader::new);
            while let Some(frame) = from.as_mut().and_then(Frame::read) {
                session.take(frame);
            }
            session.ended();
        };
        let mut making = Self { child, _earlier: earlier, reader: None };
        making.reader = Some(thread::Builder::new().name("frames".into()).spawn(read)?);
        Ok(making)
    }
}

impl Drop for Making {
    /// Ends the process, and waits until nothing of it can come any more.
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
        let _ = self.reader.take().map(JoinHandle::join);
    }
}
