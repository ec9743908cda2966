//! `toile fit`, as users call it: garments whose alterations are known are found again, and what cannot be had is said.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

/// A skirt of two pieces that drapes in a second at this spacing (mm). Its names tell nothing.
const SKIRT: &str = "\
garment: 1
body: woman_92
fabrics: {shell: cotton_poplin}
pieces:
  # Not the shirt's.
  a:
    place: hip front
    grain: [[0, 50], [0, 250]]
    outline: {start: -200 0, k: L 200 0, l: L 290 300, m: L -290 300, n: L -200 0}
  b: {like: a, place: hip back}
seams:
  s: {sew: a.l, to: b.n}
  t: {sew: a.n, to: b.l}
free: ['*.k', '*.m']
";
const COARSE: &str = "40";

/// A folder of this test's own with the skirt.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("fit_command").join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    fs::write(folder.join("skirt.yaml"), SKIRT).expect("written");
    folder
}

fn toile(folder: &Path, args: &[&str]) -> (Option<i32>, String, String) {
    let command = Command::new(env!("CARGO_BIN_EXE_toile")).args(args).current_dir(folder).output();
    let Output { status, stdout, stderr } = command.expect("run");
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    (status.code(), text(stdout), text(stderr))
}

/// Fits the skirt to `wants`: exit code, what JSON says, what is complained of.
fn fitted(folder: &Path, wants: &str, more: &[&str]) -> (Option<i32>, Value, String) {
    fs::write(folder.join("wants.yaml"), wants).expect("written");
    let all = ["fit", "skirt.yaml", "--want", "wants.yaml", "-o", "new.yaml", "--spacing", COARSE, "--json"];
    let (code, out, said) = toile(folder, &[&all[..], more].concat());
    (code, serde_json::from_str(&out).unwrap_or(Value::Null), said)
}

/// The draped fit of a garment file.
fn fit_of(folder: &Path, file: &str) -> Value {
    let (_, out, said) = toile(folder, &["drape", file, "--spacing", COARSE, "-o", "out", "--json"]);
    let report: Value = serde_json::from_str(&out).unwrap_or_else(|e| panic!("{e}: {said}"));
    report["fit"].clone()
}

fn row<'v>(rows: &'v Value, name: &str) -> &'v Value {
    rows.as_array().and_then(|rows| rows.iter().find(|row| row["name"] == name)).expect("a row")
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

fn amount(fit: &Value, knob: usize) -> f64 {
    number(&fit["knobs"][knob]["amount"])
}

#[test]
fn alterations_that_are_known_are_found_again() {
    let folder = folder("known");
    let truth = format!(
        "{SKIRT}alter:\n  - {{let_out: s, at: {{50 %: 14, 100 %: 20}}}}\n  - {{let_out: t, at: {{50 %: 14, 100 %: 20}}}}\n  \
         - {{lengthen: [a, b], at: 150, by: 30, over: 100}}\n"
    );
    fs::write(folder.join("truth.yaml"), truth).expect("written");
    let fit = fit_of(&folder, "truth.yaml");
    let hip = number(&row(&fit["girths"], "hip")["ease"]);
    let hem = &row(&fit["lengths"], "m")["value"];
    let wants = format!(
        "ease: {{hip: {hip} mm}}\nhem: {{above_floor: {hem} mm}}\nknobs:\n  \
         long: {{lengthen: [a, b], at: 150, by: -20..60, over: 100}}\n  \
         left: {{let_out: s, at: {{50 %: -7..28, 100 %: -10..40}}}}\n  \
         right: {{let_out: t, at: {{50 %: -7..28, 100 %: -10..40}}}}\n"
    );
    let (code, found, said) = fitted(&folder, &wants, &[]);
    assert_eq!(code, Some(0), "{said}{found}");
    assert!(number(&found["drapes"]) <= 12.0, "{found}");
    assert!((amount(&found, 0) - 30.0).abs() <= 1.5, "{found}");
    // Both sides act alike: their sum is what is known, and it is shared evenly.
    assert!((amount(&found, 1) - 20.0).abs() <= 1.5 && (amount(&found, 2) - 20.0).abs() <= 1.5, "{found}");
    // The file has the old words and the alterations, and hangs as it is wanted.
    let new = fs::read_to_string(folder.join("new.yaml")).expect("written");
    assert!(new.starts_with(SKIRT) && new.contains("\nalter:\n  - {lengthen: [a, b]"), "{new}");
    let fit = fit_of(&folder, "new.yaml");
    assert!((number(&row(&fit["girths"], "hip")["ease"]) - hip).abs() <= 2.0, "{fit}");
    assert!((number(&row(&fit["lengths"], "m")["value"]) - number(hem)).abs() <= 2.0, "{fit}");
}

#[test]
fn knobs_are_found_by_what_seams_do_and_not_by_their_names() {
    let folder = folder("own");
    let (code, found, said) = fitted(&folder, "ease: {hip: 85..100 mm}\nhem: {above_floor: 700 mm}\n", &[]);
    assert_eq!(code, Some(0), "{said}{found}");
    let names: Vec<&str> = [0, 1].iter().filter_map(|k| found["knobs"][*k]["knob"].as_str()).collect();
    assert_eq!(names, ["s and t at the hip", "length of a, b"], "{found}");
    assert!(amount(&found, 0) < -4.0 && amount(&found, 1) > 20.0, "{found}");
    assert!(found["changes"][0].as_str().is_some_and(|c| c.starts_with("let out seams 's' and 't' by ")), "{found}");
    assert!(found["wants"].as_array().is_some_and(|w| w.iter().all(|w| w["ok"] == true)), "{found}");
}

#[test]
fn wants_that_fight_and_knobs_at_their_end_are_refused_and_nothing_is_written() {
    let folder = folder("refused");
    let knob = "knobs: {all: {let_out: s, at: {0: -10..30, 100 %: -10..30}}}\n";
    let cases = [
        (format!("ease: {{hip: 90 mm, high hip: 15 mm}}\n{knob}"), "ease at the hip and ease at the high hip fight"),
        (
            "ease: {hip: 160 mm}\nknobs: {side: {let_out: s, at: {50 %: 0..6}}}\n".to_owned(),
            "'side' is at its end, 6 mm",
        ),
        (
            "hem: {above_floor: 600 mm}\nknobs: {side: {let_out: s, at: {50 %: 0..6}}}\n".to_owned(),
            "hem above the floor: no knob moves it",
        ),
        ("ease: {bust: 60 mm}\n".to_owned(), "no cloth goes round the body at the bust"),
    ];
    for (wants, why) in cases {
        let (code, found, said) = fitted(&folder, &wants, &[]);
        assert_eq!(code, Some(1), "{wants}: {said}{found}");
        assert!(said.contains(why), "{wants}: {said}");
        assert!(!folder.join("new.yaml").exists() && found["alter"] == Value::Array(Vec::new()));
    }
}

#[test]
fn a_file_of_wants_is_checked_with_places() {
    let folder = folder("wrong");
    for (wants, why) in [
        ("balance: side seams upright\n", "'balance' cannot be wanted"),
        ("ease: {bosom: 60 mm}\n", "no girth 'bosom'"),
        ("ease: {hip: 90..60 mm}\n", "ease must be a length or a range"),
        ("sleeve: {ends_at: elbow}\n", "against the wrist only"),
        ("easy: {hip: 60 mm}\n", "did you mean 'ease'?"),
        ("knobs: {k: {let_out: s, at: {50 %: 0..6}}}\n", "the file wants nothing"),
        ("ease: {hip: 60 mm}\nknobs: {k: {let_out: s, at: {50 %: 6}}}\n", "with a range of amount"),
        ("ease: {hip: 60 mm}\nknobs: {k: {let_out: s, at: {0: -5..5, 50 %: -1..6}}}\n", "pass zero"),
    ] {
        let (code, _, said) = fitted(&folder, wants, &[]);
        assert_eq!(code, Some(2), "{wants}: {said}");
        assert!(said.contains("wants.yaml:") && said.contains(why), "{wants}: {said}");
        assert!(!folder.join("new.yaml").exists());
    }
}

#[test]
fn a_garment_that_fits_is_left_as_it_is() {
    let folder = folder("fits");
    // Without a file of wants its own tests are.
    let text = format!("{SKIRT}tests: [{{ease: hip, from: 20 mm, to: 120 mm}}]\n");
    fs::write(folder.join("skirt.yaml"), text).expect("written");
    let (code, out, said) = toile(&folder, &["fit", "skirt.yaml", "-o", "new.yaml", "--spacing", COARSE]);
    assert_eq!(code, Some(0), "{said}");
    assert!(out.contains("nothing is to be changed") && out.contains("20..120 mm"), "{out}");
    assert!(!folder.join("new.yaml").exists());
}
