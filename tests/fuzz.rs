//! Every reader with input nobody meant: it answers, in time, and never panics. Mutations are pseudo-random with fixed
//! seeds, so a failure comes back; `TOILE_FUZZ_SECONDS` and `TOILE_FUZZ_SEED` make a longer run elsewhere.

#[path = "fuzz/mutate.rs"]
mod mutate;

use std::time::{Duration, Instant};

use mutate::{Mutator, Source};
use toile::cutting::{CuttingOptions, papers};
use toile::digitize::{Digitized, garment_file};
use toile::io::dxf_read::read_dxf_text;
use toile::io::dxf_write::cutting_dxf;
use toile::io::svg_read::read_svg_text;
use toile::io::{body, garment, garmentcode, obj_read};
use toile::pattern::drawings;

/// A reader's answer to one input; what it says does not matter, that it comes back does.
type Reader = fn(&str);

/// Seconds per reader when nothing else is asked for.
const SECONDS: f64 = 2.0;
/// No input of a few kilobytes takes longer to refuse or read.
const LONGEST: Duration = Duration::from_secs(5);

fn number(name: &str, otherwise: f64) -> f64 {
    std::env::var(name).ok().and_then(|s| s.parse().ok()).unwrap_or(otherwise)
}

/// Feeds mutations of the seeds to a reader until the time is up.
fn fuzz(name: &str, source: &Source, read: Reader) {
    let mut mutator = Mutator::new(number("TOILE_FUZZ_SEED", 1.0) as u64);
    let end = Instant::now() + Duration::from_secs_f64(number("TOILE_FUZZ_SECONDS", SECONDS));
    let mut runs = 0;
    while runs < 50 || Instant::now() < end {
        let text = mutator.mutated(source);
        let begin = Instant::now();
        let outcome = std::panic::catch_unwind(|| read(&text));
        let mut took = begin.elapsed();
        assert!(outcome.is_ok(), "{name}: input {runs} panics:\n{text}");
        if took >= LONGEST {
            // A busy machine stops for seconds, too, but not twice at the same input.
            let begin = Instant::now();
            read(&text);
            took = begin.elapsed();
        }
        assert!(took < LONGEST, "{name}: input {runs} takes {took:?}:\n{text}");
        runs += 1;
    }
    eprintln!("{name}: {runs} inputs");
}

fn read_garment(text: &str) {
    let read = garment::read_text("fuzz", "fuzz.yaml", text);
    match read {
        // What was read can be written, and reads as the same.
        Ok(loaded) => {
            let written = garment::write(&loaded.file).expect("YAML");
            let again = garment::read_file_only("again.yaml", &written);
            assert_eq!(again.expect("our own YAML"), loaded.file, "{written}");
        }
        Err(refused) => assert!(!refused.to_string().is_empty()),
    }
}

fn read_specification(text: &str) {
    match garmentcode::read("fuzz", text, garmentcode::Wearer::default()) {
        Ok(file) => read_garment(&garment::write(&file).expect("YAML")),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

fn read_surface(text: &str) {
    match obj_read::parse_obj(text, "fuzz.obj") {
        Ok(surface) => {
            let _ = body::body(surface, "fuzz".to_owned(), "fuzz.obj".to_owned(), None);
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

fn read_svg(text: &str) {
    match read_svg_text(text) {
        Ok(drawing) => read_digitized(&garment_file("fuzz", &drawing.pieces)),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

fn read_dxf(text: &str) {
    match read_dxf_text(text, None) {
        Ok(drawing) => read_digitized(&garment_file("fuzz", &drawing.pieces)),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

/// Whatever a drawing says, what is made of it is a file that can be read.
fn read_digitized(made: &Digitized) {
    let yaml = garment::write(&made.file).expect("YAML");
    garment::read_file_only("fuzz.yaml", &yaml).unwrap_or_else(|e| panic!("{e}\n{yaml}"));
}

#[test]
fn garment_files() {
    let seeds = [
        include_str!("data/skirt.yaml"),
        include_str!("data/catalogue.yaml"),
        include_str!("data/pleated.yaml"),
        include_str!("data/lined.yaml"),
        include_str!("../patterns/child_dress.yaml"),
    ];
    let words = [
        "cut: fold a",
        "cut: pair",
        "like: a",
        "@20%..80%",
        "@0..1e9",
        "gather: 1.5",
        "ease: -5",
        "open: {from: a, length: 1}",
        "[mirror]",
        "to: mirror",
        "&a",
        "*a",
        "<<: *a",
        "A 5 5 0 1 0 9 9",
        "Q 1 1, 2 2",
        "C 0 0, 1e300 1, 5 5",
        "M 0 0 Z",
        "nan",
        "1e308",
        "-0",
        "99 %",
        "[]",
        "{}",
        "face: same",
        "pleats: [{edge: top, at: [1], depth: 1}]",
        "darts: [{edge: top, at: 1, intake: 1, length: 1}]",
        "\u{feff}",
        "\t",
        "é",
        "---",
    ];
    fuzz("garment file", &Source { seeds: &seeds, words: &words }, read_garment);
}

#[test]
fn specifications() {
    let seeds = [include_str!("fuzz/specification.json")];
    let words = [
        "null",
        "true",
        "[]",
        "{}",
        "-1",
        "1e308",
        "1e-308",
        "0",
        "18446744073709551616",
        "\"circle\"",
        "\"cubic\"",
        "\"quadratic\"",
        "\"right_wrong\"",
        "\"label\": \"arm\"",
        "\"left_a\"",
        "[0.5, 0.5]",
        "[[[[[[",
        "\"\\ud800\"",
        "\"units_in_meter\": 0",
    ];
    fuzz("specification", &Source { seeds: &seeds, words: &words }, read_specification);
}

#[test]
fn surfaces() {
    let cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nvt 0 0\nvn 0 0 1\ng cube\n\
                f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3/1/1 4/1/1 8/1/1 7/1/1\nf -8 -4 -1 -5\n";
    let words = [
        "nan",
        "inf",
        "1e308",
        "-1",
        "0",
        "99999999999",
        "f 1 1 1",
        "f 1 2",
        "f 1//1 2//1 3//1",
        "v 1 2",
        "o x",
        "#",
        "\\",
    ];
    fuzz("surface", &Source { seeds: &[cube], words: &words }, read_surface);
}

#[test]
fn drawings_in_svg() {
    let seeds = [include_str!("data/inkscape.svg"), include_str!("data/freesewing.svg")];
    let words = [
        "nan",
        "1e308",
        "-0",
        "0.0000001",
        "M",
        "z m 0 0",
        "L",
        "A 0 0 0 1 1 5 5",
        "C",
        "<g>",
        "</g>",
        "<",
        "\"",
        "transform=\"scale(0)\"",
        "transform=\"rotate(1e9)\"",
        "viewBox=\"0 0 0 0\"",
        "width=\"1e9in\"",
        "<use href=\"#a\"/>",
        "style=\"display:none\"",
        "&#0;",
        "é",
    ];
    fuzz("SVG", &Source { seeds: &seeds, words: &words }, read_svg);
}

/// A piece on the fold, with a notch, a dart and a hole.
const FOLDED: &str = "
garment: 1
pieces:
  front:
    cut: fold center
    grain: [[60, 250], [60, 60]]
    outline: {start: 0 20, neck: C 40 20 60 0 80 -20, side: L 140 300, hem: L 0 300, center: L 0 20}
    notches: {side: [100 double]}
    darts: [{edge: hem, at: 60, intake: 12, length: 80}]
    holes: {slit: M 20 120 L 20 130 L 60 130 L 60 120 Z}
free: ['*.*']
";

#[test]
fn drawings_in_dxf() {
    let loaded = garment::read_text("garment", "garment.yaml", FOLDED).expect("a garment");
    let seed = cutting_dxf("seed", &papers(&drawings(&loaded.file, &loaded.garment), &CuttingOptions::default()));
    let words = [
        "\n0\nPOLYLINE\n",
        "\n0\nVERTEX\n",
        "\n0\nSEQEND\n",
        "\n0\nBLOCK\n",
        "\n0\nENDBLK\n",
        "\n0\nINSERT\n",
        "\n0\nEOF\n",
        "\n8\n14\n",
        "\n10\nnan\n",
        "\n20\n1e308\n",
        "\n42\n1e9\n",
        "\n42\n0.7\n",
        "\n0\nARC\n",
        "\n70\n1\n",
        "99999999999999999999",
        "-1",
        "\r\n",
        "\0",
        "é",
    ];
    fuzz("DXF", &Source { seeds: &[&seed], words: &words }, read_dxf);
}
