//! Shipped mannequins, and loading of others.

use std::path::Path;

use super::{Mannequin, MannequinError, MannequinSpec, build};
use crate::input::{InputError, bytes, nearest, shown};

/// Name and text of every shipped mannequin.
const SHIPPED: [(&str, &str); 3] = [
    ("woman_92", include_str!("../../mannequins/woman_92.yaml")),
    ("man_100", include_str!("../../mannequins/man_100.yaml")),
    ("child_110", include_str!("../../mannequins/child_110.yaml")),
];

/// Largest file of a body's sections, bytes. Such files are a page of text, and larger ones are refused before they are
/// read.
const LARGEST: u64 = 4 << 20;

/// Number of characters of an unknown name that an error shows.
const NAME: usize = 120;

/// Names of the shipped mannequins.
pub fn library() -> Vec<&'static str> {
    SHIPPED.iter().map(|s| s.0).collect()
}

impl MannequinSpec {
    /// The numbers of a shipped mannequin, or of a `.yaml` file.
    ///
    /// # Errors
    /// [`MannequinError`] when there is no such mannequin or its file is wrong.
    pub fn load(name_or_path: &str) -> Result<Self, MannequinError> {
        if let Some((name, text)) = SHIPPED.iter().find(|s| s.0 == name_or_path) {
            return Self::parse(text, name);
        }
        let path = Path::new(name_or_path);
        if path.extension().is_none() {
            let nearest = nearest(name_or_path, library()).map(str::to_owned);
            let (name, known) = (shown(name_or_path, NAME), library().join(", "));
            return Err(MannequinError::Unknown { name, nearest, known });
        }
        let fault = |why: String| MannequinError::Read { file: name_or_path.to_owned(), why };
        if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("obj")) {
            return Err(fault("an OBJ is a body as it is; give it to --body".to_owned()));
        }
        let bytes = bytes(path, LARGEST).map_err(|e| match e {
            InputError::TooLarge { bytes, limit } => {
                let (bytes, limit) = (bytes >> 20, limit >> 20);
                fault(format!("{bytes} MiB or more are no mannequin's sections; at most {limit} MiB are read"))
            }
            other => fault(other.to_string()),
        })?;
        let text = String::from_utf8(bytes).map_err(|_| fault("it is no UTF-8 text".to_owned()))?;
        Self::parse(&text, name_or_path)
    }
}

/// Builds a shipped mannequin, or one from a `.yaml` file. (A body of one's own as OBJ: `io::body`.)
///
/// # Errors
/// [`MannequinError`] when there is no such mannequin, its file is wrong, or its sections make no body.
pub fn load(name_or_path: &str) -> Result<Mannequin, MannequinError> {
    build(&MannequinSpec::load(name_or_path)?)
}
