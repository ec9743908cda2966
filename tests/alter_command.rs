//! `toile alter` and `--size`, as users call them.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const GARMENT: &str = "\
garment: 1
body: woman_92
fabrics: {cloth: rib}
pieces:
  band:
    place: waist
    grain: [[50, 20], [50, 60]]
    # The widest measure of the waist.
    outline: {start: 0 0, top: L 900 0, right: L 900 80, bottom: L 0 80, left: L 0 0}
seams: {back: {sew: band.right, to: band.left}}
free: ['*.top', '*.bottom']
sizes:
  S: []
  L: [{lengthen: band, at: 450, by: 60, along: x}]
";

/// A folder of this test's own with the garment.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("alter_command").join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    fs::write(folder.join("band.yaml"), GARMENT).expect("written");
    folder
}

fn toile(folder: &Path, args: &[&str]) -> (Option<i32>, String) {
    let Output { status, stdout, stderr } =
        Command::new(env!("CARGO_BIN_EXE_toile")).args(args).current_dir(folder).output().expect("run");
    (status.code(), String::from_utf8_lossy(&[stdout, stderr].concat()).into_owned())
}

#[test]
fn alter_writes_the_pattern() {
    let folder = folder("writes");
    fs::write(folder.join("changes.yaml"), "alter: [{lengthen: band, at: 40, by: 15}]\n").expect("written");
    let (code, said) = toile(&folder, &["alter", "band.yaml", "changes.yaml", "-o", "new.yaml"]);
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("band.left") && said.contains("+15.00"), "{said}");
    let (code, said) = toile(&folder, &["check", "new.yaml"]);
    assert_eq!(code, Some(0), "{said}");
}

#[test]
fn what_cannot_be_altered_writes_nothing() {
    let folder = folder("refused");
    for (changes, why) in [
        ("alter: [{lengthen: bund, at: 40, by: 15}]", "did you mean 'band'?"),
        ("alter: [{shorten: band, at: 40, by: 500}]", "band"),
        ("alter: [{stretch: band}]", "changes.yaml:1"),
    ] {
        fs::write(folder.join("changes.yaml"), changes).expect("written");
        let (code, said) = toile(&folder, &["alter", "band.yaml", "changes.yaml", "-o", "new.yaml"]);
        assert_eq!(code, Some(2), "{changes}: {said}");
        assert!(said.contains(why), "{said}");
        assert!(!folder.join("new.yaml").exists());
    }
}

#[test]
fn a_garment_is_made_in_the_size_asked_for() {
    let folder = folder("sizes");
    let area = |out: &str| {
        let report = fs::read_to_string(folder.join(out).join("report.json")).expect("written");
        let report: serde_json::Value = serde_json::from_str(&report).expect("JSON");
        report["pieces"][0]["area_flat"].as_f64().expect("an area")
    };
    for (size, wide) in [("S", 900.0), ("L", 960.0)] {
        let (code, said) = toile(&folder, &["sew", "band.yaml", "--size", size, "-o", size, "--spacing", "30", "-q"]);
        assert!(matches!(code, Some(0 | 1)), "{said}");
        assert!((area(size) / (80.0 * wide) - 1.0).abs() < 1e-3, "{size}: {}", area(size));
    }
    let (code, said) = toile(&folder, &["sew", "band.yaml", "--size", "XL", "-o", "XL"]);
    assert!(code == Some(2) && said.contains("size 'XL' not found") && said.contains("S, L"), "{said}");
    // Without a size every one is checked.
    let wrong = GARMENT.replace("by: 60", "by: 6000000");
    fs::write(folder.join("wrong.yaml"), wrong).expect("written");
    assert_eq!(toile(&folder, &["check", "wrong.yaml"]).0, Some(2));
    assert_eq!(toile(&folder, &["check", "wrong.yaml", "--size", "S"]).0, Some(0));
}
