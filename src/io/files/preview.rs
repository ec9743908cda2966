//! Files that are shown before they are final.

use std::path::{Path, PathBuf};

use super::error::WriteError;
use super::refuse::refuse;
use super::temporary::{Pending, Previous, behind_links, registry};

/// A file that is shown before it is final, such as the picture of a garment that is still being sewn.
///
/// [`super::write_all`] makes it final by writing the file. If the program is interrupted before, or this is dropped,
/// what stood there before is put back: the file as it was, or none.
pub struct Preview(PathBuf);

impl Preview {
    /// A preview of the file at this path. Nothing is written yet.
    pub fn new(target: PathBuf) -> Self {
        Self(target)
    }

    /// Writes contents to the file, whole or not at all.
    ///
    /// # Errors
    /// [`WriteError`], naming the path; if it is one of the `inputs`, [`WriteError::IsInput`].
    pub fn show(&self, contents: &[u8], inputs: &[&Path]) -> Result<(), WriteError> {
        refuse(&self.0, inputs)?;
        let previous = Previous::read(&self.0)?;
        let pending = Pending::create(&self.0, contents)?;
        refuse(&self.0, inputs)?;
        let mut registry = registry();
        pending.rename(&self.0, &mut registry)?;
        registry.preview(behind_links(&self.0), previous);
        Ok(())
    }
}

impl Drop for Preview {
    fn drop(&mut self) {
        registry().put_back(&behind_links(&self.0));
    }
}

#[cfg(test)]
mod tests {
    use super::super::write_all;
    use super::*;
    use std::fs;

    #[test]
    fn a_preview_goes_and_leaves_no_folder() {
        let dir = tempfile::tempdir().expect("a folder");
        let file = dir.path().join("out/dress/picture");
        let preview = Preview::new(file.clone());
        for view in ["coarse", "finer"] {
            preview.show(view.as_bytes(), &[]).expect("written");
            assert_eq!(fs::read_to_string(&file).expect("there"), view);
        }
        drop(preview);
        assert_eq!(fs::read_dir(dir.path()).expect("a folder").count(), 0);
    }

    #[test]
    fn the_file_before_the_preview_comes_back() {
        let dir = tempfile::tempdir().expect("a folder");
        let file = dir.path().join("picture");
        fs::write(&file, "earlier").expect("written");
        let preview = Preview::new(file.clone());
        preview.show(b"coarse", &[]).expect("written");
        preview.show(b"finer", &[]).expect("written");
        drop(preview);
        assert_eq!(fs::read_to_string(&file).expect("there"), "earlier");
    }

    #[test]
    fn a_file_that_is_final_stays() {
        let dir = tempfile::tempdir().expect("a folder");
        let file = dir.path().join("out/picture");
        let preview = Preview::new(file.clone());
        preview.show(b"coarse", &[]).expect("written");
        write_all(&[(file.clone(), b"final".to_vec())], &[]).expect("written");
        drop(preview);
        assert_eq!(fs::read_to_string(&file).expect("there"), "final");
    }

    #[test]
    fn a_preview_takes_no_input_s_place() {
        let dir = tempfile::tempdir().expect("a folder");
        let file = dir.path().join("input");
        fs::write(&file, "read").expect("written");
        let refused = Preview::new(file.clone()).show(b"coarse", &[&file]);
        assert!(matches!(refused, Err(WriteError::IsInput(_))), "{refused:?}");
        assert_eq!(fs::read_to_string(&file).expect("there"), "read");
    }
}
