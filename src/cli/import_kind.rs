//! `toile import FILE`: the word of the format may be left out where the ending of the file says it.

use std::ffi::{OsStr, OsString};
use std::path::Path;

use clap::Parser as _;
use clap::error::ErrorKind;

use super::args::Args;

/// Formats of `import`, as its words, and the endings of their files.
const FORMATS: [(&str, &str); 3] = [("svg", "svg"), ("dxf", "dxf"), ("garmentcode", "json")];

/// The arguments of the process as clap reads them, with the format of an `import` that has none added.
///
/// # Errors
/// The error of clap. If an `import` has no format and the ending of its file tells none, the error lists the formats.
pub(super) fn parsed(arguments: impl IntoIterator<Item = OsString>) -> Result<Args, clap::Error> {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    let said = match Args::try_parse_from(&arguments) {
        Err(said) if is_of_format(&said) => said,
        done => return done,
    };
    let Some(import) = unsaid(&arguments) else { return Err(said) };
    match format(&arguments[import + 1..]) {
        Some(format) => {
            let (before, after) = arguments.split_at(import + 1);
            Args::try_parse_from(before.iter().cloned().chain([format.into()]).chain(after.iter().cloned()))
        }
        None => Err(clap::Error::raw(
            ErrorKind::InvalidSubcommand,
            "the ending of the file does not say its format: write 'toile import svg FILE', 'toile import dxf FILE' \
             or 'toile import garmentcode FILE.json'\n",
        )),
    }
}

fn is_of_format(said: &clap::Error) -> bool {
    matches!(said.kind(), ErrorKind::InvalidSubcommand | ErrorKind::UnknownArgument | ErrorKind::MissingSubcommand)
}

/// Where `import` stands, if something follows it and no format does.
fn unsaid(arguments: &[OsString]) -> Option<usize> {
    let import = arguments.iter().skip(1).position(|word| word == "import")? + 1;
    let after = &arguments[import + 1..];
    let is_format = |word: &OsString| FORMATS.iter().any(|(format, _)| word == format);
    (!after.is_empty() && !is_format(&after[0])).then_some(import)
}

/// The format of the first argument that ends as a file of one.
fn format(arguments: &[OsString]) -> Option<&'static str> {
    let of = |word: &OsString| {
        let ending = Path::new(word).extension().and_then(OsStr::to_str)?;
        FORMATS.iter().find(|(_, own)| own.eq_ignore_ascii_case(ending)).map(|(format, _)| *format)
    };
    arguments.iter().find_map(of)
}
