//! Files are read up to a limit, whatever their length is said to be.

use std::fs;

use toile::input::{InputError, bytes};

#[test]
fn only_so_much_is_read() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    let file = dir.path().join("a.txt");
    fs::write(&file, "12345").expect("written");
    assert_eq!(bytes(&file, 5).as_deref(), Ok(&b"12345"[..]));
    assert_eq!(bytes(&file, 4), Err(InputError::TooLarge { bytes: 5, limit: 4 }));
    assert_eq!(bytes(dir.path(), 4), Err(InputError::Folder));
    assert!(matches!(bytes(&dir.path().join("none"), 4), Err(InputError::System(_))));
}

#[cfg(target_os = "linux")]
#[test]
fn an_endless_device_ends_at_the_limit() {
    let zero = std::path::Path::new("/dev/zero");
    assert_eq!(bytes(zero, 1000), Err(InputError::TooLarge { bytes: 1001, limit: 1000 }));
}

#[cfg(target_os = "linux")]
#[test]
fn a_pipe_without_a_writer_is_not_waited_for() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    let pipe = dir.path().join("pipe.yaml");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.expect("mkfifo").success());
    assert_eq!(bytes(&pipe, 1000), Err(InputError::Pipe));
}
