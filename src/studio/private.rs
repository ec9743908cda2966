//! Opening the page in a browser without telling its address to others on the machine.

use std::process::{Command, Stdio};

use crate::io::files::{Private, WriteError};

/// Opens an address in the user's browser. The command line of a browser can be read by everybody on the machine, and
/// the address holds the token: the browser gets a file instead that only the user can read and that leads on. The
/// file is removed with what is returned.
///
/// # Errors
/// [`WriteError`] when the file cannot be written. That no browser starts is no error: the address is printed.
pub fn opened(address: &str) -> Result<Private, WriteError> {
    let page = format!(
        "<!DOCTYPE html><meta charset=\"utf-8\"><title>toile studio</title>\
         <meta http-equiv=\"refresh\" content=\"0; url={address}\"><p><a href=\"{address}\">toile studio</a>\n"
    );
    let file = Private::new(".html", page.as_bytes())?;
    let program = if cfg!(target_os = "macos") {
        "open"
    } else if cfg!(windows) {
        "explorer"
    } else {
        "xdg-open"
    };
    let mut command = Command::new(program);
    let _ = command.arg(file.path()).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn();
    Ok(file)
}
