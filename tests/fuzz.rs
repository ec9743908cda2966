//! Every reader with input nobody meant: it answers, in time, and never panics. Mutations are pseudo-random with fixed
//! seeds, so a failure comes back; `TOILE_FUZZ_SECONDS` and `TOILE_FUZZ_SEED` make a longer run elsewhere.

#[path = "fuzz/mutate.rs"]
mod mutate;

use std::time::{Duration, Instant};

use mutate::{Mutator, Source};
use toile::batch::{BatchJob, check_jobs};
use toile::cutting::{CuttingOptions, papers};
use toile::digitize::{Digitized, garment_file};
use toile::fabric;
use toile::io::dxf_read::{DxfOptions, read_dxf_text, read_graded_dxf_text};
use toile::io::dxf_write::cutting_dxf;
use toile::io::svg_read::read_svg_text;
use toile::io::{body, garment, garmentcode, lines_read, obj_read, surface_read};
use toile::mannequin::Measures;
use toile::pattern::{Unit, drawings};

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
    feed(name, || mutator.mutated(source), &|text: &String| read(text));
}

/// The same for files that are no text.
fn fuzz_bytes(name: &str, seeds: &[&[u8]], read: &dyn Fn(&[u8])) {
    let mut mutator = Mutator::new(number("TOILE_FUZZ_SEED", 1.0) as u64);
    feed(name, || mutator.mutated_bytes(seeds), &|bytes: &Vec<u8>| read(bytes));
}

fn feed<T: std::fmt::Debug>(name: &str, mut next: impl FnMut() -> T, read: &dyn Fn(&T)) {
    let end = Instant::now() + Duration::from_secs_f64(number("TOILE_FUZZ_SECONDS", SECONDS));
    let mut runs = 0;
    while runs < 50 || Instant::now() < end {
        let input = next();
        let begin = Instant::now();
        let outcome = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| read(&input)));
        let mut took = begin.elapsed();
        assert!(outcome.is_ok(), "{name}: input {runs} panics:\n{input:?}");
        if took >= LONGEST {
            // A busy machine stops for seconds, too, but not twice at the same input.
            let begin = Instant::now();
            read(&input);
            took = begin.elapsed();
        }
        assert!(took < LONGEST, "{name}: input {runs} takes {took:?}:\n{input:?}");
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

/// A base size whose corners have grade rules, and the table of these.
const RULED: &str = "0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n8\n1\n2\nFRONT\n0\nTEXT\n8\n1\n1\nSize: M\n\
    0\nPOLYLINE\n8\n1\n70\n1\n\
    0\nVERTEX\n8\n1\n10\n0\n20\n0\n0\nVERTEX\n8\n1\n10\n200\n20\n0\n0\nVERTEX\n8\n1\n10\n210\n20\n150\n\
    0\nVERTEX\n8\n1\n10\n200\n20\n300\n0\nVERTEX\n8\n1\n10\n0\n20\n300\n0\nSEQEND\n8\n1\n\
    0\nTEXT\n8\n1\n10\n200\n20\n0\n1\n# 1\n0\nTEXT\n8\n1\n10\n200\n20\n300\n1\n# 2\n\
    0\nPOINT\n8\n4\n10\n205\n20\n75\n0\nPOLYLINE\n8\n14\n70\n1\n0\nVERTEX\n8\n14\n10\n10\n20\n10\n\
    0\nVERTEX\n8\n14\n10\n190\n20\n10\n0\nVERTEX\n8\n14\n10\n190\n20\n290\n\
    0\nVERTEX\n8\n14\n10\n10\n20\n290\n0\nSEQEND\n8\n14\n0\nENDBLK\n0\nENDSEC\n0\nEOF\n";
const RULES: &str = "UNITS: METRIC\nNUMBER OF SIZES: 3\nSIZE LIST: S M L\nSAMPLE SIZE: M\nRULE: DELTA 1\n\
                     -10.0, 0.0  0.0, 0.0\n 10.0, 0.0\nRULE: DELTA 2\n-10,-5 0,0 10,6\nEND\n";

/// The DXF is right and its rules are not, or the other way round.
fn read_grades(text: &str) {
    let large = || DxfOptions { unit: None, size: Some("L".to_owned()) };
    let [dxf, rules] = if text.contains("BLOCK") { [text, RULES] } else { [RULED, text] };
    match read_graded_dxf_text(dxf, rules, &large()) {
        Ok(drawing) => read_digitized(&garment_file("fuzz", &drawing.pieces)),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

#[test]
fn grade_rules() {
    let words =
        ["\nRULE: DELTA 1\n", "END\n", "1e9", "nan", "-5, 5", "SIZE LIST:", "# 2", "\n1\n# 99\n", ",,", "\n8\n5\n"];
    fuzz("grade rules", &Source { seeds: &[RULES, RULED], words: &words }, read_grades);
}

/// Readings of a fabric, measures of a person, lists of alterations and jobs, ranges and wants, one after the other.
fn read_statements(text: &str) {
    let said = [
        fabric::measure::measure_text(text, std::path::Path::new("fuzz.yaml"), "fuzz").err().map(|e| e.to_string()),
        fabric::load_text(text).err().map(|e| e.to_string()),
        Measures::parse(text, "fuzz").err().map(|e| e.to_string()),
        garment::alterations_of(text).err().map(|e| e.to_string()),
        garment::wants_of("fuzz", text, Unit::Millimetre).err().map(|e| e.to_string()),
        garment::Ranges::parse(text, "fuzz").err().map(|e| e.to_string()),
    ];
    assert!(said.into_iter().flatten().all(|words| !words.is_empty()));
    let lines = (1..).zip(text.lines());
    if let Err(mistakes) = check_jobs(lines, "line", std::path::Path::new(""), &BatchJob::options()) {
        assert!(mistakes.iter().all(|mistake| !mistake.why.is_empty()));
    }
}

#[test]
fn statements() {
    let seeds = [
        "name: own\nvalues: {weight: 115 g/m2, bend: 0.05 gf.cm2/cm, thickness: 0.3 mm, tensile: {warp: 3 %}}\n",
        "bust: 1040\nwaist: 33 in\nheight: 170 cm\nhip: 1100 mm\n",
        "- {lengthen: [front, back], at: 250, by: 20}\n- {take_in: side, at: {50 %: 8 mm, 0: 4}}\n",
        "measures: {bust: {from: 96 %, to: 106 %}}\nalter:\n  - {lengthen: front, at: 250, by: {from: 1, to: 60}}\n",
        "ease: {bust: 60..90 mm}\nhem: {above_floor: 660..680 mm}\nknobs: {side: {take_in: side, by: -9..9}}\n",
        "{\"garment\": [\"a.yaml\", \"b.yaml\"], \"spacing\": 20, \"measures\": {\"bust\": 1040}}\n",
    ];
    let words =
        ["..", "%", "1e308", "-0", "nan", ".inf", "mm", "gf.cm2/cm", "{from: 1, to: 0}", "[]", "{}", "&a", "*a", "<<:"];
    fuzz("statements", &Source { seeds: &seeds, words: &words }, read_statements);
}

/// A cube as an STL of letters, an STL of numbers, a PLY, and lines in space.
#[test]
fn surfaces_of_other_formats() {
    let room = tempfile::tempdir().expect("a folder");
    let file = room.path().join("surface");
    let ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
               element face 2\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n9 0 0\n9 9 0\n0 9 1\n\
               3 0 1 2\n3 0 2 3\n";
    let stl = "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 9 0 0\nvertex 9 9 0\nendloop\nendfacet\n\
               endsolid s\n";
    let mut numbers = vec![0u8; 80];
    numbers.extend(2u32.to_le_bytes());
    for corner in
        [[0.0f32; 3], [0., 0., 0.], [9., 0., 0.], [9., 9., 0.], [0., 0., 1.], [0.; 3], [9., 9., 0.], [0., 9., 1.]]
    {
        numbers.extend(corner.iter().flat_map(|x| x.to_le_bytes()));
        if numbers.len() % 50 == 32 {
            numbers.extend([0, 0]);
        }
    }
    let glb = {
        let json =
            r#"{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"scale":[2,2,2]}],"meshes":[{"#
                .to_owned()
                + r#""primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"buffers":[{"byteLength":42}],"#
                + r#""bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],"#
                + r#""accessors":[{"#
                + r#""bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},{"bufferView":1,"#
                + r#""componentType":5123,"#
                + r#""count":3,"type":"SCALAR"}]}"#;
        let padded = |bytes: &[u8], with: u8| [bytes, &vec![with; bytes.len().wrapping_neg() % 4]].concat();
        let corners = [0.0f32, 0., 0., 9., 0., 0., 0., 9., 1.].iter().flat_map(|x| x.to_le_bytes());
        let buffer: Vec<u8> = corners.chain([0u16, 1, 2].iter().flat_map(|k| k.to_le_bytes())).collect();
        let (json, buffer) = (padded(json.as_bytes(), b' '), padded(&buffer, 0));
        let chunk =
            |kind: u32, bytes: &[u8]| [&(bytes.len() as u32).to_le_bytes(), &kind.to_le_bytes(), bytes].concat();
        let chunks = [chunk(0x4E4F_534A, &json), chunk(0x004E_4942, &buffer)].concat();
        let head = [0x4654_6C67u32, 2, 12 + chunks.len() as u32].map(u32::to_le_bytes).concat();
        [head, chunks].concat()
    };
    let lines = "v 0 0 0\nv 9 0 0\nv 9 9 0\nl 1 2 3\nl -1 -3\n";
    let seeds: [&[u8]; 5] = [ply.as_bytes(), stl.as_bytes(), &numbers, &glb, lines.as_bytes()];
    for (k, seed) in seeds[..4].iter().enumerate() {
        std::fs::write(&file, seed).expect("a file");
        assert!(surface_read::read_surface(&file).is_ok_and(|surface| !surface.faces.is_empty()), "seed {k} is right");
    }
    fuzz_bytes("other surfaces", &seeds, &|bytes| {
        std::fs::write(&file, bytes).expect("a file");
        let said = [surface_read::read_surface(&file).err(), lines_read::read_lines(&file).err()];
        assert!(said.into_iter().flatten().all(|error| !error.to_string().is_empty()));
    });
}
