//! The reference of the garment file and its JSON Schema say what the reader knows: every key, and nothing else.

use std::collections::BTreeSet;
use std::path::Path;

use regex::Regex;
use serde_json::Value;
use toile::fabric::{Context, FabricError, FabricSpec, resolve};
use toile::io::garment::{Refused, SCHEMA, read_file_only, read_text};
use toile::pattern::{PlaceWord, Problem, place_words};

const REFERENCE: &str = include_str!("../docs/format.md");
const TUTORIAL: &str = include_str!("../docs/first-garment.md");

/// A key that no mapping has and that is near none that it has.
const STRANGER: &str = "qqzzxx";

/// A kind of mapping: its heading in the reference, its name in the schema, and files with `§` in the place of what
/// stands in it.
const MAPPINGS: [(&str, Option<&str>, &[&str]); 10] = [
    ("## The file", None, &["garment: 1\npieces: {}\n§\n"]),
    ("## A piece", Some("piece"), &["garment: 1\npieces:\n  a:\n    §\n"]),
    ("## A place", None, &["garment: 1\npieces:\n  a:\n    place: {§}\n"]),
    (
        "## A dart",
        Some("dart"),
        &[
            "garment: 1\npieces:\n  a:\n    darts:\n      - {intake: 1, edge: e, at: 1, length: 1, §}\n",
            "garment: 1\npieces:\n  a:\n    darts:\n      - {intake: 1, at: [1, 1], up: 1, down: 1, §}\n",
        ],
    ),
    (
        "## Pleats",
        Some("pleat"),
        &["garment: 1\npieces:\n  a:\n    pleats:\n      - {edge: e, at: [1], depth: 1, §}\n"],
    ),
    ("## A line", Some("line"), &["garment: 1\npieces:\n  a:\n    lines: {l: {path: M 0 0 L 1 1, §}}\n"]),
    ("## A seam", Some("seam"), &["garment: 1\npieces: {}\nseams: {s: {sew: a.b, to: a.c, §}}\n"]),
    (
        "## An opening of a seam",
        Some("opening"),
        &["garment: 1\npieces: {}\nseams: {s: {sew: a.b, to: a.c, open: {from: a, length: 1, §}}}\n"],
    ),
    (
        "## An alteration",
        Some("alteration"),
        &[
            "garment: 1\npieces: {}\nalter: [{take_in: side, at: {0: 1}, §}]\n",
            "garment: 1\npieces: {}\nalter: [{let_out: side, at: {0: 1}, §}]\n",
            "garment: 1\npieces: {}\nalter: [{lengthen: a, at: 1, by: 1, §}]\n",
            "garment: 1\npieces: {}\nalter: [{shorten: a, at: 1, by: 1, §}]\n",
            "garment: 1\npieces: {}\nalter: [{pivot: a.d, to: a.e@1, §}]\n",
            "garment: 1\npieces: {}\nalter: [{spread: a.e@1, to: a.f@1, by: 1, §}]\n",
            "garment: 1\npieces: {}\nalter: [{fullness: a.e, to: a.f, by: 1, §}]\n",
            "garment: 1\npieces: {}\nalter: [{cut: a.e@1, to: a.f@1, name: b, §}]\n",
            "garment: 1\npieces: {}\nalter: [{join: a, §}]\n",
            "garment: 1\npieces: {}\nalter: [{move: a.e, at: {0: [1, 1]}, §}]\n",
        ],
    ),
    (
        "## A test",
        Some("test"),
        &[
            "garment: 1\npieces: {}\ntests: [{seam: all, length: 1, §}]\n",
            "garment: 1\npieces: {}\ntests: [{gap: all, below: 1, §}]\n",
            "garment: 1\npieces: {}\ntests: [{closure: all, below: 1, §}]\n",
            "garment: 1\npieces: {}\ntests: [{drape: all, area: 1, §}]\n",
            "garment: 1\npieces: {}\ntests: [{flatten: all, area: 1, §}]\n",
            "garment: 1\npieces: {}\ntests: [{crossings: 1, §}]\n",
            "garment: 1\npieces: {}\ntests: [{openings: 1, §}]\n",
            "garment: 1\npieces: {}\ntests: [{worn: true, §}]\n",
            "garment: 1\npieces: {}\ntests: [{ease: bust, from: 1, §}]\n",
            "garment: 1\npieces: {}\ntests: [{pressure: bust, below: 1, §}]\n",
            "garment: 1\npieces: {}\ntests: [{hem: level within 1, §}]\n",
        ],
    ),
];

/// Keys the reader asks for in such a mapping.
fn known(templates: &[&str]) -> BTreeSet<String> {
    let mut all = BTreeSet::new();
    for template in templates {
        let text = template.replace('§', &format!("{STRANGER}: 1"));
        let Err(Refused { diagnostics }) = read_file_only("test.yaml", &text) else { panic!("read: {text}") };
        let known = diagnostics.iter().find_map(|d| match &d.problem {
            Problem::UnknownKey { key, known, .. } if key == STRANGER => Some(known.clone()),
            _ => None,
        });
        all.extend(known.unwrap_or_else(|| panic!("{diagnostics:?}")).split(", ").map(str::to_owned));
    }
    all
}

/// Rows of the table under a heading: key and example.
fn rows(heading: &str) -> Vec<(String, String)> {
    let start = REFERENCE.find(&format!("{heading}\n")).unwrap_or_else(|| panic!("no heading {heading}"));
    let section = &REFERENCE[start + heading.len()..];
    let section = &section[..section.find("\n## ").unwrap_or(section.len())];
    let row = |line: &str| {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        let code = |cell: &str| cell.strip_prefix('`')?.strip_suffix('`').map(str::to_owned);
        Some((code(cells.first()?)?, code(cells.get(4)?)?))
    };
    section.lines().filter(|l| l.starts_with("| `")).map(|l| row(l).unwrap_or_else(|| panic!("{l}"))).collect()
}

#[test]
fn the_reference_has_every_key_and_no_other() {
    for (heading, _, templates) in MAPPINGS {
        let written: BTreeSet<String> = rows(heading).into_iter().map(|r| r.0).collect();
        assert_eq!(written, known(templates), "{heading}");
    }
    assert!(rows("## A closure").len() >= 7);
}

#[test]
fn every_example_is_read() {
    for (heading, _, templates) in MAPPINGS {
        for (key, example) in rows(heading) {
            let names = |line: &str| line.starts_with(&format!("{key}: ")) || line.contains(&format!(" {key}: "));
            assert!(names(&example), "{heading}: the example of {key} is {example}");
            let bare = |template: &&str| {
                let text = match heading {
                    "## A test" => "garment: 1\npieces: {}\ntests: [{§}]\n".to_owned(),
                    "## An alteration" => "garment: 1\npieces: {}\nalter: [{§}]\n".to_owned(),
                    "## A place" if key == "turn" => template.replace("{§}", "{at: [0, 0, 0], §}"),
                    _ => without(template, &key),
                };
                read_file_only("test.yaml", &text.replace('§', &example))
            };
            let read: Vec<_> = templates.iter().map(bare).collect();
            let why = read.iter().filter_map(|r| r.as_ref().err()).map(ToString::to_string).collect::<Vec<_>>();
            assert!(read.iter().any(Result::is_ok), "{heading} {key}: {example}\n{}", why.join("\n"));
        }
    }
}

/// The template without its own entry for `key`, which stands once.
fn without(template: &str, key: &str) -> String {
    let entries = [
        ("garment: 1\n", "garment"),
        ("pieces: {}\n", "pieces"),
        ("intake: 1, ", "intake"),
        ("edge: e, ", "edge"),
        ("at: 1, ", "at"),
        ("at: [1, 1], ", "at"),
        ("at: [1], ", "at"),
        ("up: 1, ", "up"),
        ("down: 1, ", "down"),
        ("depth: 1, ", "depth"),
        ("path: M 0 0 L 1 1, ", "path"),
        ("sew: a.b, ", "sew"),
        ("to: a.c, ", "to"),
        ("from: a, ", "from"),
        ("length: 1, ", "length"),
        // A dart has a length or a tip.
        ("length: 1, ", "tip"),
    ];
    let own = entries.iter().filter(|(_, of)| *of == key);
    own.fold(template.to_owned(), |text, (entry, _)| text.replacen(entry, "", 1))
}

#[test]
fn the_schema_has_every_key_and_no_other() {
    let schema: Value = serde_json::from_str(SCHEMA).expect("JSON");
    let keys = |v: &Value| v["properties"].as_object().expect("properties").keys().cloned().collect::<BTreeSet<_>>();
    for (heading, name, templates) in MAPPINGS {
        let part = match (name, heading) {
            (Some(name), _) => &schema["$defs"][name],
            (None, "## The file") => &schema,
            _ => &schema["$defs"]["piece"]["properties"]["place"]["oneOf"][1],
        };
        assert_eq!(keys(part), known(templates), "{heading}");
        assert_eq!(part["additionalProperties"], Value::Bool(false), "{heading}");
    }
    // Every reference leads somewhere.
    for part in SCHEMA.split("\"$ref\": \"#/$defs/").skip(1) {
        let name = part.split('"').next().expect("a name");
        assert!(schema["$defs"][name].is_object(), "{name}");
    }
}

#[test]
fn the_words_of_a_place_are_those_of_the_table() {
    let listed = format!("\n{}.\n", place_words(|word| format!("`{word}`")));
    assert!(REFERENCE.contains(&listed), "docs/format.md must have the line{listed}");
    let schema: Value = serde_json::from_str(SCHEMA).expect("JSON");
    let examples = &schema["$defs"]["piece"]["properties"]["place"]["oneOf"][0]["examples"];
    let names: Vec<&str> = PlaceWord::all().map(PlaceWord::name).collect();
    assert_eq!(*examples, Value::from(names));
}

/// Keys of a kind of the schema, those of mappings in it after a point.
fn nested(kind: &Value, before: &str, keys: &mut BTreeSet<String>) {
    let forms = kind["oneOf"].as_array().into_iter().flatten().chain([kind]);
    for properties in forms.filter_map(|form| form["properties"].as_object()) {
        for (key, kind) in properties {
            let key = format!("{before}{key}");
            nested(kind, &format!("{key}."), keys);
            keys.insert(key);
        }
    }
}

#[test]
fn the_schema_has_every_key_of_a_fabric() {
    let schema: Value = serde_json::from_str(SCHEMA).expect("JSON");
    assert_eq!(schema["properties"]["fabrics"]["additionalProperties"]["$ref"], "#/$defs/fabric");
    let mut keys = BTreeSet::new();
    nested(&schema["$defs"]["fabric"], "", &mut keys);
    assert!(keys.remove("base"));
    let spec = FabricSpec { base: None, values: vec![(STRANGER.to_owned(), "1".to_owned())] };
    let context = Context { name: "cloth", folder: Path::new(""), garment: &[], given: None };
    let Err(FabricError::Key { known, .. }) = resolve(&spec, &context) else { panic!("a key that no fabric has") };
    assert_eq!(keys, known.split(", ").map(str::to_owned).collect());
}

/// What stands in a text is told as right and wrong by the schema as by the reader.
#[test]
fn the_schema_knows_lengths_paths_and_ways_to_cut() {
    let schema: Value = serde_json::from_str(SCHEMA).expect("JSON");
    let kinds = &schema["$defs"];
    let cut = &kinds["piece"]["properties"]["cut"];
    let point = &kinds["point"]["oneOf"][1];
    let path = "L 100 20 c 1e1,-.5 2-3 4 5 Z";
    for (kind, right, wrong) in [
        (cut, &["one", "pair", "fold center", "3", "100"][..], &["twice", "fold", "fold a b", "0", "101"][..]),
        (&kinds["path"], &[path, "M 0 0 H 3"], &["X 1 2", "neck", "L 1 2 mm"]),
        (&kinds["length"], &["12", "1.2 cm", "-.5in", "1e1 mm"], &["much", "12 furlongs", "5 %", "mm", "1 2"]),
        (&kinds["along"], &["12", "1.2 cm", "50 %"], &["half", "12 double"]),
        (&kinds["notch"], &["60 double", "50 %", "12 mm"], &["double", "60 triple"]),
        (&kinds["width"], &["30 folded", "1 cm mitred", "12"], &["folded 30", "30 round", "5 %"]),
        (&kinds["share"], &["0.5 %", "0.005"], &["5 mm", "most"]),
        (point, &["0 20", "1.5, -2"], &["0", "12 mm", "1 2 3"]),
    ] {
        let pattern = kind["pattern"].as_str().unwrap_or_else(|| panic!("a pattern: {kind}"));
        let pattern = Regex::new(pattern).expect(pattern);
        right.iter().for_each(|text| assert!(pattern.is_match(text), "{text}: {pattern}"));
        wrong.iter().for_each(|text| assert!(!pattern.is_match(text), "{text}: {pattern}"));
    }
    assert_eq!(kinds["seam"]["properties"]["gather"]["minimum"], 1);
}

#[test]
fn every_garment_of_the_tutorial_is_one() {
    let blocks: Vec<&str> = TUTORIAL.split("```yaml\n").skip(1).filter_map(|b| b.split("```").next()).collect();
    let whole: Vec<&&str> = blocks.iter().filter(|b| b.starts_with("garment: 1")).collect();
    assert!(whole.len() >= 2, "{} garments", whole.len());
    for text in whole {
        let read = read_text("tutorial", "tutorial.yaml", text);
        assert!(read.is_ok_and(|loaded| loaded.warnings.is_empty()), "{text}");
    }
}
