//! Jobs: a garment and the options of `toile make`, as a line of a list says them.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize, Serializer};
use serde_json::{Map, Value};

use super::error::{BatchError, Mistake};
use crate::fabric;
use crate::input::{InputError, LengthUnit, bytes, is_file_name, shown, stem, whole};
use crate::io::garment::alterations_in;
use crate::mannequin::{self, Measures};

/// Bytes of a list: some million jobs.
const LARGEST_LIST: u64 = 1 << 30;
/// Characters of an id: more than any file's name and the number of its line have.
const LONGEST_ID: usize = 300;
/// Characters of a wrong id in a message.
const SHOWN_ID: usize = 60;

/// One garment to make. Its paths can be opened as they are.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BatchJob {
    /// Its name in the index.
    pub id: String,
    /// Garment files, the innermost first.
    #[serde(serialize_with = "one_or_many")]
    pub garment: Vec<PathBuf>,
    /// Body in place of the garment's own: library name or file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub body: Option<String>,
    /// Unit of the body's OBJ file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub body_units: Option<String>,
    /// Fabric in place of the garment's main one: library name or file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fabric: Option<String>,
    /// Mesh spacing, millimetres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spacing: Option<f64>,
    /// Size of the garment.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub size: Option<String>,
    /// Pressures in kPa from which cloth is tight, and above which it is too tight.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pressure_bands: Option<[f64; 2]>,
    /// Measures of the wearer, put on the mannequin: names and lengths, as `--measures` has them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measures: Option<Map<String, Value>>,
    /// Alterations that follow those of the garment file, as `--alter` has them: a mapping or a text each.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub alter: Vec<Value>,
}

/// A line of a list, unchecked. Its paths are relative to the list.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "an object such as {\"garment\": \"skirt.yaml\"}")]
struct JobLine {
    id: Option<String>,
    garment: Option<OneOrMany>,
    body: Option<String>,
    body_units: Option<String>,
    fabric: Option<String>,
    spacing: Option<f64>,
    size: Option<String>,
    pressure_bands: Option<[f64; 2]>,
    measures: Option<Map<String, Value>>,
    alter: Option<Vec<Value>>,
}

fn one_or_many<S: Serializer>(files: &[PathBuf], serializer: S) -> Result<S::Ok, S::Error> {
    match files {
        [file] => file.serialize(serializer),
        files => files.serialize(serializer),
    }
}

#[derive(Clone, Debug, Deserialize)]
#[serde(untagged, expecting = "a garment is the name of a file, or a list of names, the innermost first")]
enum OneOrMany {
    One(PathBuf),
    Many(Vec<PathBuf>),
}

impl BatchJob {
    /// A garment file with the options that jobs have which say nothing else.
    pub(super) fn of_file(id: String, file: PathBuf, defaults: &BatchJob) -> Self {
        Self { id, garment: vec![file], ..defaults.clone() }.with_whole_paths()
    }

    /// The job with whole paths, so that its record tells where everything was.
    fn with_whole_paths(mut self) -> Self {
        self.garment.iter_mut().for_each(|file| *file = whole(file));
        let named = [(&mut self.body, mannequin::library()), (&mut self.fabric, fabric::library())];
        for (name, shipped) in named {
            if let Some(name) = name.as_mut().filter(|name| is_file_name(name, &shipped)) {
                *name = whole(Path::new(name)).display().to_string();
            }
        }
        self
    }

    /// Options without a garment.
    pub fn options() -> Self {
        Self {
            id: String::new(),
            garment: Vec::new(),
            body: None,
            body_units: None,
            fabric: None,
            spacing: None,
            size: None,
            pressure_bands: None,
            measures: None,
            alter: Vec::new(),
        }
    }

    /// The arguments of `toile make` that make it, but for the folder.
    pub fn arguments(&self) -> Vec<String> {
        let mut options = Vec::new();
        let mut give = |name: &str, value: Option<String>| {
            // In one word: a value may begin with a dash.
            options.extend(value.map(|value| format!("--{name}={value}")));
        };
        give("body", self.body.clone());
        give("body-units", self.body_units.clone());
        give("fabric", self.fabric.clone());
        give("spacing", self.spacing.map(|mm| mm.to_string()));
        give("size", self.size.clone());
        give("pressure-bands", self.pressure_bands.map(|[tight, too_tight]| format!("{tight},{too_tight}")));
        give("measures", self.measures.as_ref().map(json));
        self.alter.iter().for_each(|alteration| give("alter", Some(words(alteration))));
        options
    }
}

/// Reads a list of jobs, one JSON object a line; blank lines are passed over. A job takes from `defaults` what it does
/// not say. Paths in the list are relative to its folder.
///
/// # Errors
/// [`BatchError`], with every line that is no job.
pub fn read_jobs(list: &Path, defaults: &BatchJob) -> Result<Vec<BatchJob>, BatchError> {
    let unreadable = |why: String| BatchError::Read { file: list.to_owned(), why };
    let bytes = bytes(list, LARGEST_LIST).map_err(|e: InputError| unreadable(e.to_string()))?;
    let text = String::from_utf8(bytes).map_err(|e| unreadable(format!("it is no UTF-8 text: {e}")))?;
    // Editors begin UTF-8 with a byte order mark.
    let lines = text.strip_prefix('\u{feff}').unwrap_or(&text).lines();
    let folder = list.parent().unwrap_or(Path::new(""));
    let numbered = (1..).zip(lines).filter(|(_, text)| !text.trim().is_empty());
    let jobs = check_jobs(numbered, "line", folder, defaults);
    let jobs = jobs.map_err(|mistakes| BatchError::Jobs { file: list.to_owned(), mistakes })?;
    if jobs.is_empty() {
        return Err(BatchError::Empty { file: list.to_owned(), why: "no job in this list" });
    }
    Ok(jobs)
}

/// Jobs from their JSON objects, each with its number, which is that of a `place` such as `line`. Paths are relative to
/// `folder`.
///
/// # Errors
/// Every text that is no job, and every id that another job has.
pub fn check_jobs<'t>(
    texts: impl Iterator<Item = (usize, &'t str)>,
    place: &str,
    folder: &Path,
    defaults: &BatchJob,
) -> Result<Vec<BatchJob>, Vec<Mistake>> {
    let (mut jobs, mut mistakes) = (Vec::new(), Vec::new());
    let mut first: HashMap<String, usize> = HashMap::new();
    for (line, text) in texts {
        let parsed = parse_job(text, folder, defaults, &line.to_string());
        let unique = parsed.and_then(|job| match first.insert(job.id.clone(), line) {
            Some(other) => Err(format!("the id '{}' is that of {place} {other}; ids must differ", job.id)),
            None => Ok(job),
        });
        match unique {
            Ok(job) => jobs.push(job),
            Err(why) => mistakes.push(Mistake { line, why }),
        }
    }
    if mistakes.is_empty() { Ok(jobs) } else { Err(mistakes) }
}

/// One job from its JSON object. Paths are relative to `folder`. A job without an id is named after its garment and
/// `mark`.
///
/// # Errors
/// The mistake, in words.
pub fn parse_job(text: &str, folder: &Path, defaults: &BatchJob, mark: &str) -> Result<BatchJob, String> {
    // A list of values would be taken for those of the keys in their order.
    if text.trim_start().starts_with('[') {
        return Err("a job is an object such as {\"garment\": \"skirt.yaml\"}, not a list".into());
    }
    let said: JobLine = serde_json::from_str(text).map_err(|e| plain(&e))?;
    let garment = match said.garment {
        Some(OneOrMany::One(file)) => vec![file],
        Some(OneOrMany::Many(files)) => files,
        None => Vec::new(),
    };
    if garment.is_empty() || garment.iter().any(|file| file.as_os_str().is_empty()) {
        return Err("a job needs a garment file: {\"garment\": \"skirt.yaml\"}".into());
    }
    let garment: Vec<PathBuf> = garment.iter().map(|file| folder.join(file)).collect();
    let id = said.id.unwrap_or_else(|| format!("{}-{mark}", stem(&garment[0])));
    if id.is_empty() || id.chars().count() > LONGEST_ID || id.chars().any(char::is_control) {
        let id = shown(&format!("{id:?}"), SHOWN_ID);
        return Err(format!("the id {id}: an id has 1 to {LONGEST_ID} visible characters"));
    }
    let at = |name: String, shipped: Vec<&str>| in_folder(folder, name, &shipped);
    let job = BatchJob {
        id,
        garment,
        // The unit is of the body beside it.
        body_units: said.body_units.or_else(|| defaults.body_units.clone().filter(|_| said.body.is_none())),
        body: said.body.map(|body| at(body, mannequin::library())).or_else(|| defaults.body.clone()),
        fabric: said.fabric.map(|fabric| at(fabric, fabric::library())).or_else(|| defaults.fabric.clone()),
        spacing: said.spacing.or(defaults.spacing),
        size: said.size.or_else(|| defaults.size.clone()),
        pressure_bands: said.pressure_bands.or(defaults.pressure_bands),
        measures: said.measures.or_else(|| defaults.measures.clone()),
        alter: said.alter.unwrap_or_else(|| defaults.alter.clone()),
    };
    checked(job.with_whole_paths())
}

fn json<T: Serialize>(value: &T) -> String {
    serde_json::to_string(value).unwrap_or_default()
}

/// An alteration as a text.
fn words(alteration: &Value) -> String {
    alteration.as_str().map_or_else(|| json(alteration), str::to_owned)
}

/// The job, if its numbers and units make sense. Its files are left to the process that makes it.
fn checked(job: BatchJob) -> Result<BatchJob, String> {
    if let Some(unit) = job.body_units.as_ref().filter(|unit| LengthUnit::from_symbol(unit).is_none()) {
        let known: Vec<&str> = LengthUnit::ALL.iter().map(|unit| unit.symbol()).collect();
        return Err(format!("body_units: '{unit}' is no unit; known are {}", known.join(", ")));
    }
    if let Some(mm) = job.spacing.filter(|mm| !(*mm > 0.0 && mm.is_finite())) {
        return Err(format!("spacing: {mm} is no positive number of millimetres, such as 10"));
    }
    if let Some(measures) = &job.measures {
        Measures::parse(&json(measures), "measures").map_err(|e| e.to_string())?;
    }
    for alteration in &job.alter {
        alterations_in(&words(alteration)).map_err(|refused| refused.to_string())?;
    }
    match job.pressure_bands {
        Some([tight, too_tight]) if !(0.0 < tight && tight <= too_tight && too_tight < 1e3) => {
            Err(format!("pressure_bands: two rising pressures in kPa are expected, not {tight} and {too_tight}"))
        }
        _ => Ok(job),
    }
}

/// A library name as it is, a file in `folder`.
fn in_folder(folder: &Path, name: String, shipped: &[&str]) -> String {
    if is_file_name(&name, shipped) { folder.join(name).display().to_string() } else { name }
}

/// The parser's message in plain words and without its line, which is always the first.
fn plain(error: &serde_json::Error) -> String {
    let text = error.to_string();
    let Some((message, _)) = text.rsplit_once(" at line ") else { return text };
    let message = message.replace("expected f64", "expected a number").replace("EOF while parsing", "the line ends in");
    // Where the parser expects a value, anything else is no JSON at all.
    let message =
        if message == "expected value" { "this is no JSON; a text stands in \"…\"".into() } else { message };
    format!("{message} (column {})", error.column())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lists() -> PathBuf {
        std::path::absolute("lists").expect("a folder")
    }

    fn parse(text: &str) -> Result<BatchJob, String> {
        let defaults = BatchJob { spacing: Some(25.0), body_units: Some("cm".into()), ..BatchJob::options() };
        parse_job(text, &lists(), &defaults, "7")
    }

    #[test]
    fn a_job_is_relative_to_its_list_and_takes_what_it_does_not_say() {
        let job = parse(r#"{"garment": "skirt.yaml", "body": "anna.obj", "fabric": "denim"}"#).expect("a job");
        assert_eq!(job.id, "skirt-7");
        assert_eq!(job.garment, [lists().join("skirt.yaml")]);
        let body = format!("--body={}", lists().join("anna.obj").display());
        assert_eq!(job.arguments(), [&body, "--fabric=denim", "--spacing=25"]);
        // Also where the folder is named from here.
        let same = parse_job(r#"{"garment": "skirt.yaml"}"#, Path::new("lists"), &BatchJob::options(), "7");
        assert_eq!(same.expect("a job").garment, job.garment);
    }

    #[test]
    fn mistakes_say_what_is_expected() {
        let said = |text| parse(text).expect_err("a mistake");
        assert!(
            said(r#"{"garmnt": "skirt.yaml"}"#).contains("unknown field `garmnt`, expected one of `id`, `garment`")
        );
        assert!(said(r#"{"id": "a"}"#).contains("needs a garment file"));
        assert!(said(r#"{"garment": "a.yaml", "spacing": -3}"#).contains("-3 is no positive number"));
        assert!(said(r#"{"garment": "a.yaml", "body_units": "ft"}"#).contains("known are mm, cm, dm, m, in"));
        assert!(said(r#"{"garment": 3}"#).contains("the name of a file"));
        assert!(said(r#" ["a", "skirt.yaml"]"#).contains("not a list"));
        // Words of the parser that only a programmer knows are translated.
        assert!(said("garment: a.yaml").starts_with("this is no JSON"));
        assert!(said(r#""a.yaml""#).contains(r#"expected an object such as {"garment": "skirt.yaml"}"#));
        assert!(said(r#"{"garment": "a.yaml", "spacing": "60"}"#).contains(r#"string "60", expected a number"#));
        assert!(said(r#"{"garment": "a.yaml""#).contains("the line ends in an object"));
        assert!(said(r#"{"garment": "a\u0000b.yaml"}"#).contains(r#"the id "a\0b-7": an id has"#));
        let measure = said(r#"{"garment": "a.yaml", "measures": {"wais": 700}}"#);
        assert!(measure.contains("'wais' is no measure; did you mean 'waist'?"), "{measure}");
        let alteration = said(r#"{"garment": "a.yaml", "alter": [{"lenghten": "front", "at": 200, "by": 20}]}"#);
        assert!(alteration.contains("lenghten"), "{alteration}");
    }
}
