//! `toile fit`, as users call it: garments whose alterations are known are found again, and what cannot be had is said.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

/// A tunic without sleeves that drapes in a few seconds at this spacing (mm). Its names tell nothing.
const TUNIC: &str = "\
garment: 1
body: woman_92
fabrics: {shell: cotton_poplin}
pieces:
  # Not the shirt's.
  a:
    place: torso front
    grain: [[0, 300], [0, 500]]
    outline:
      start: -80 0
      k: Q 0 110, 80 0
      l: L 190 45
      m: C 180 130, 200 230, 255 240
      n: L 270 640
      o: L -270 640
      p: L -255 240
      q: C -200 230, -180 130, -190 45
      r: L -80 0
  b: {like: a, place: torso back}
seams:
  s: {sew: a.n, to: b.p}
  t: {sew: a.p, to: b.n}
  u: {sew: a.l, to: b.r}
  v: {sew: a.r, to: b.l}
free: ['*.k', '*.m', '*.q', '*.o']
";
const COARSE: &str = "40";

/// A folder of this test's own with the tunic.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("fit_command").join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    fs::write(folder.join("tunic.yaml"), TUNIC).expect("written");
    folder
}

fn toile(folder: &Path, args: &[&str]) -> (Option<i32>, String, String) {
    let command = Command::new(env!("CARGO_BIN_EXE_toile")).args(args).current_dir(folder).output();
    let Output { status, stdout, stderr } = command.expect("run");
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    (status.code(), text(stdout), text(stderr))
}

/// Fits the tunic to `wants`: exit code, what JSON says, what is complained of.
fn fitted(folder: &Path, wants: &str, more: &[&str]) -> (Option<i32>, Value, String) {
    fs::write(folder.join("wants.yaml"), wants).expect("written");
    let all = ["fit", "tunic.yaml", "--want", "wants.yaml", "-o", "new.yaml", "--spacing", COARSE, "--json"];
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

/// Side seams let out at the hem, and longer.
const SIDES: &str = "\
[{let_out: s, at: {60 %: -15..30, 100 %: -20..40}}, {let_out: t, at: {60 %: -15..30, 100 %: -20..40}}]";
const LONGER: &str = "{lengthen: [a, b], at: 400, by: -30..60, over: 100}";

#[test]
fn alterations_that_are_known_are_found_again() {
    let folder = folder("known");
    let truth = format!(
        "{TUNIC}alter:\n  - {{let_out: s, at: {{60 %: 15, 100 %: 20}}}}\n  \
         - {{let_out: t, at: {{60 %: 15, 100 %: 20}}}}\n  - {{lengthen: [a, b], at: 400, by: 30, over: 100}}\n"
    );
    fs::write(folder.join("truth.yaml"), truth).expect("written");
    let fit = fit_of(&folder, "truth.yaml");
    let hip = number(&row(&fit["girths"], "hip")["ease"]);
    let hem = number(&row(&fit["lengths"], "o")["value"]);
    let wants = format!(
        "ease: {{hip: {hip} mm}}\nhem: {{above_floor: {hem} mm}}\nknobs:\n  sides: {SIDES}\n  long: {LONGER}\n"
    );
    let (code, found, said) = fitted(&folder, &wants, &[]);
    assert_eq!(code, Some(0), "{said}{found}");
    assert!(number(&found["drapes"]) <= 12.0, "{found}");
    assert!((amount(&found, 0) - 20.0).abs() <= 1.5 && (amount(&found, 1) - 30.0).abs() <= 1.5, "{found}");
    // The file has the old words and the alterations, and hangs as it is wanted.
    let new = fs::read_to_string(folder.join("new.yaml")).expect("written");
    assert!(new.starts_with(TUNIC) && new.contains("\nalter:\n  - {let_out: s, at: {60 %: "), "{new}");
    let fit = fit_of(&folder, "new.yaml");
    assert!((number(&row(&fit["girths"], "hip")["ease"]) - hip).abs() <= 2.0, "{fit}");
    assert!((number(&row(&fit["lengths"], "o")["value"]) - hem).abs() <= 2.0, "{fit}");
}

#[test]
fn knobs_are_found_by_what_seams_do_and_not_by_their_names() {
    let folder = folder("own");
    let (code, found, said) = fitted(&folder, "ease: {waist: 240..270 mm}\nhem: {above_floor: 775 mm}\n", &[]);
    assert_eq!(code, Some(0), "{said}{found}");
    let names: Vec<&str> = [0, 1].iter().filter_map(|k| found["knobs"][*k]["knob"].as_str()).collect();
    assert_eq!(names, ["s and t at the waist", "length of a, b"], "{found}");
    assert!(amount(&found, 0) > 8.0 && (15.0..40.0).contains(&amount(&found, 1)), "{found}");
    assert!(found["changes"][0].as_str().is_some_and(|c| c.starts_with("take in seams 's' and 't' by ")), "{found}");
    assert!(found["wants"].as_array().is_some_and(|w| w.iter().all(|w| w["ok"] == true)), "{found}");
}

#[test]
fn wants_that_fight_and_knobs_at_their_end_are_refused_and_nothing_is_written() {
    let folder = folder("refused");
    let cases = [
        (
            format!("ease: {{hip: 150 mm, high hip: 150 mm}}\nknobs: {{sides: {SIDES}}}\n"),
            "ease at the hip and ease at the high hip fight",
        ),
        (
            "ease: {hip: 160 mm}\nknobs: {side: {let_out: s, at: {100 %: 0..6}}}\n".to_owned(),
            "'side' is at its end, 6 mm",
        ),
        (
            "hem: {above_floor: 600 mm}\nknobs: {side: {let_out: s, at: {40 %: 0..6}}}\n".to_owned(),
            "hem above the floor: no knob moves it",
        ),
        ("ease: {wrist: 60 mm}\n".to_owned(), "no cloth goes round the body at the wrist"),
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
    let text = format!("{TUNIC}tests: [{{ease: hip, from: 20 mm, to: 120 mm}}]\n");
    fs::write(folder.join("tunic.yaml"), text).expect("written");
    let (code, out, said) = toile(&folder, &["fit", "tunic.yaml", "-o", "new.yaml", "--spacing", COARSE]);
    assert_eq!(code, Some(0), "{said}");
    assert!(out.contains("nothing is to be changed") && out.contains("20..120 mm"), "{out}");
    assert!(!folder.join("new.yaml").exists());
}
