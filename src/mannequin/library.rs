//! Shipped mannequins, and loading of others.

use std::path::Path;

use super::{Mannequin, MannequinError, MannequinSpec, Measures, build, build_measured};
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

/// A body as its file has it.
enum BodyFile {
    Sections(MannequinSpec),
    Measures(Measures),
}

impl MannequinSpec {
    /// The numbers of a shipped mannequin, or of a `.yaml` file: sections, or measures of a person and the mannequin
    /// that they are put on (`like`).
    ///
    /// # Errors
    /// [`MannequinError`] when there is no such mannequin or its file is wrong.
    pub fn load(name_or_path: &str) -> Result<Self, MannequinError> {
        let (base, measures) = of(name_or_path)?;
        if measures.is_empty() { Ok(base) } else { base.measured(&measures) }
    }
}

/// Builds a shipped mannequin, or one from a `.yaml` file. (A body of one's own as OBJ: `io::body`.)
///
/// # Errors
/// [`MannequinError`] when there is no such mannequin, its file is wrong, or its sections make no body.
pub fn load(name_or_path: &str) -> Result<Mannequin, MannequinError> {
    load_measured(name_or_path, &Measures::default())
}

/// As [`load`], with the measures of a person.
///
/// # Errors
/// [`MannequinError`] when there is no such mannequin, its file is wrong, or its sections make no body.
pub fn load_measured(name_or_path: &str, given: &Measures) -> Result<Mannequin, MannequinError> {
    let (base, own) = of(name_or_path)?;
    let base = if own.is_empty() || given.is_empty() { base } else { base.measured(&own)? };
    let measures = if given.is_empty() { &own } else { given };
    if measures.is_empty() { build(&base) } else { build_measured(&base, measures) }
}

/// The sections of a mannequin by name or path, and the measures that are put on them.
fn of(name_or_path: &str) -> Result<(MannequinSpec, Measures), MannequinError> {
    let measures = match file(name_or_path)? {
        BodyFile::Sections(spec) => return Ok((spec, Measures::default())),
        BodyFile::Measures(measures) => measures,
    };
    let fault = |why: String| MannequinError::Value { file: name_or_path.to_owned(), why };
    let known = library().join(", ");
    let like = measures.like.as_deref();
    let like =
        like.ok_or_else(|| fault(format!("measures need a mannequin that has the rest; say 'like: {known}'")))?;
    match file(like)? {
        BodyFile::Sections(spec) => {
            let stem = Path::new(name_or_path).file_stem().map(|stem| stem.to_string_lossy().into_owned());
            Ok((MannequinSpec { name: stem.unwrap_or_else(|| spec.name.clone()), ..spec }, measures))
        }
        BodyFile::Measures(_) => Err(fault(format!("like: '{like}' holds measures, too; there are {known}"))),
    }
}

fn file(name_or_path: &str) -> Result<BodyFile, MannequinError> {
    if let Some((name, text)) = SHIPPED.iter().find(|s| s.0 == name_or_path) {
        return MannequinSpec::parse(text, name).map(BodyFile::Sections);
    }
    let path = Path::new(name_or_path);
    if path.extension().is_none() {
        let nearest = nearest(name_or_path, library()).map(str::to_owned);
        let (name, known) = (shown(name_or_path, NAME), library().join(", "));
        return Err(MannequinError::Unknown { name, nearest, known });
    }
    if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("obj")) {
        let why = "an OBJ is a body as it is; give it to --body".to_owned();
        return Err(MannequinError::Read { file: name_or_path.to_owned(), why });
    }
    let text = text(path)?;
    // Sections always have a torso, measures never.
    let has_torso = text.lines().any(|line| line.trim_start().starts_with("torso:"));
    if has_torso {
        MannequinSpec::parse(&text, name_or_path).map(BodyFile::Sections)
    } else {
        Measures::parse(&text, name_or_path).map(BodyFile::Measures)
    }
}

impl Measures {
    /// Reads a file of measures; see [`Measures::parse`].
    ///
    /// # Errors
    /// [`MannequinError`] when the file cannot be read or is wrong.
    pub fn read(path: &Path) -> Result<Self, MannequinError> {
        Self::parse(&text(path)?, &path.display().to_string())
    }
}

fn text(path: &Path) -> Result<String, MannequinError> {
    let fault = |why: String| MannequinError::Read { file: path.display().to_string(), why };
    let bytes = bytes(path, LARGEST).map_err(|e| match e {
        InputError::TooLarge { bytes, limit } => {
            let (bytes, limit) = (bytes >> 20, limit >> 20);
            fault(format!("{bytes} MiB or more are no mannequin's sections; at most {limit} MiB are read"))
        }
        other => fault(other.to_string()),
    })?;
    String::from_utf8(bytes).map_err(|_| fault("it is no UTF-8 text".to_owned()))
}
