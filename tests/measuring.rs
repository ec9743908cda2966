//! From readings to fabric files (L2–L6): the three tests, photographs, sheets, curves, and what is refused.

use std::fs;
use std::path::{Path, PathBuf};

use approx::assert_relative_eq;
use toile::fabric::measure::{MeasureError, MeasuredFabric, Photo, fabric_yaml, measure};
use toile::fabric::{library, load, sheet};

/// Readings of one test whose mean over `initial` is `mean` and lies at the share `normalised` between the smallest and
/// the largest.
fn readings(initial: f64, mean: f64, normalised: f64, range: f64) -> Vec<f64> {
    let (low, high) = (mean - normalised * range, mean + (1.0 - normalised) * range);
    // Eighteen more readings, in pairs about the value that makes the mean right.
    let middle = (20.0 * mean - low - high) / 18.0;
    let off = |k: usize| 0.19 * range * (k as f64 / 9.0) * if k.is_multiple_of(2) { 1.0 } else { -1.0 };
    let mut out = vec![low, high];
    out.extend((0..9).flat_map(|k| [middle + off(k), middle - off(k)]));
    out.iter().map(|v| v * initial).collect()
}

fn list(values: &[f64]) -> String {
    let text: Vec<String> = values.iter().map(|v| format!("{v:.17}")).collect();
    format!("[{}]", text.join(", "))
}

struct Room(tempfile::TempDir);

impl Room {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("folder"))
    }

    fn file(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.path().join(name);
        fs::write(&path, bytes).expect("file");
        path
    }

    fn measure(&self, text: &str) -> Result<MeasuredFabric, MeasureError> {
        measure(&self.file("readings.yaml", text), "mine")
    }

    fn refused(&self, text: &str, says: &str) {
        let error = self.measure(text).expect_err(says).to_string();
        assert!(error.contains(says), "'{error}' does not say '{says}'");
    }

    /// The fabric written and read again.
    fn again(&self, made: &MeasuredFabric) -> toile::fabric::Fabric {
        let path = self.file("made.yaml", fabric_yaml(&made.sheet));
        load(&path.display().to_string()).expect("the file is a fabric")
    }
}

const MEANS: [f64; 3] = [0.87, 1.0643, 0.71];
const NORMALISED: [f64; 3] = [0.41, 0.62, 0.23];
const INITIAL: [f64; 3] = [1840.0, 609.6, 43.0];

/// Readings made from [`MEANS`] and [`NORMALISED`]; of the fold heights the largest must be the specimen's own 1.
fn synthetic() -> [Vec<f64>; 3] {
    let range = (1.0 - MEANS[2]) / (1.0 - NORMALISED[2]);
    [0.1, 0.05, range]
        .into_iter()
        .enumerate()
        .map(|(k, r)| readings(INITIAL[k], MEANS[k], NORMALISED[k], r))
        .collect::<Vec<_>>()
        .try_into()
        .expect("three")
}

fn yaml([r, s, b]: &[Vec<f64>; 3]) -> String {
    format!(
        "name: synthetic\nsource: made up\nrecovery: {{initial: 1840, unit: cm2, readings: {}}}\n\
         stretch: {{initial: 609.6, unit: mm, load: 600, readings: {}}}\nbend: {{unit: mm, readings: {}}}\n\
         values: {{weight: 115 g/m2}}\n",
        list(r),
        list(s),
        list(b)
    )
}

/// The same as a table.
fn table([r, s, b]: &[Vec<f64>; 3]) -> String {
    let row = |k: usize| format!("{}, {:.17}, {:.17}, {:.17}\n", k + 1, r[k], s[k], b[k]);
    let rows: String = (0..20).map(row).collect();
    format!("repeat, recovery cm2, stretch mm, bend mm\ninitial, 1840, 609.6,\n{rows}")
}

#[test]
fn a_synthetic_set_of_readings_gives_back_what_it_was_made_from() {
    let room = Room::new();
    let made = room.measure(&yaml(&synthetic())).expect("readings");
    let liu = made.sheet.liu.clone().expect("measures");
    let sum: f64 = NORMALISED.iter().sum();
    for k in 0..3 {
        assert_relative_eq!(liu.means[k], MEANS[k], epsilon = 1e-13);
        assert_relative_eq!(liu.normalised[k], NORMALISED[k], epsilon = 1e-12);
        assert_relative_eq!(liu.weights[k], 100.0 * NORMALISED[k] / sum, epsilon = 1e-10);
    }
    // The spread is the standard deviation of the single readings.
    let v: Vec<f64> = synthetic()[1].iter().map(|r| r / INITIAL[1]).collect();
    let variance = v.iter().map(|x| (x - MEANS[1]).powi(2)).sum::<f64>() / 19.0;
    assert_relative_eq!(liu.spread.expect("spread")[1], variance.sqrt(), epsilon = 1e-12);
    assert!(made.notes.is_empty());

    // The same as a table.
    let other = measure(&room.file("readings.csv", table(&synthetic())), "mine").expect("table");
    assert_eq!(other.sheet.liu, made.sheet.liu);
    assert_eq!(other.sheet.name, "mine");
}

#[test]
fn a_written_fabric_is_read_again() {
    let room = Room::new();
    let made = room.measure(&yaml(&synthetic())).expect("readings");
    let fabric = room.again(&made);
    let again = sheet(&room.0.path().join("made.yaml").display().to_string()).expect("sheet");
    let (a, b) = (made.sheet.liu.expect("measures"), again.liu.expect("measures"));
    for k in 0..3 {
        assert_relative_eq!(a.normalised[k], b.normalised[k], epsilon = 1e-6);
        assert_relative_eq!(a.weights[k], b.weights[k], epsilon = 1e-4);
    }
    // Bending was not measured: its length follows from the weights.
    assert!(fabric.defaults.iter().any(|d| d == "bend"));
    assert_relative_eq!(fabric.bending_length_mean(), b.fallback_bending_length(), max_relative = 1e-9);
    assert_relative_eq!(fabric.areal_density, 0.115);
}

#[test]
fn means_alone_go_through_the_spline_of_the_fifteen() {
    let room = Room::new();
    let of = |v: [f64; 3]| {
        let text = format!("means: {{recovery: {}, stretch: {}, bend: {}}}\n", v[0], v[1], v[2]);
        room.measure(&text).expect("means")
    };
    // At a published fabric whose means no other shares the spline passes through its own values.
    for name in library() {
        let Some(liu) = sheet(name).expect(name).liu else { continue };
        let found = of(liu.means).sheet.liu.expect("measures");
        let alone = |k: usize| {
            let same = |n: &&str| sheet(n).expect(n).liu.is_some_and(|l| l.means[k] == liu.means[k]);
            library().iter().filter(|n| same(n)).count() == 1
        };
        for k in (0..3).filter(|k| alone(*k)) {
            assert_relative_eq!(found.normalised[k], liu.normalised[k], epsilon = 1e-9);
        }
        assert!(found.normalised.iter().all(|v| (0.0..=1.0).contains(v)));
        assert_relative_eq!(found.weights.iter().sum::<f64>(), 100.0, epsilon = 1e-9);
    }
    let beyond = of([0.99, 1.2, 0.995]);
    assert!(beyond.notes.iter().any(|n| n.contains("stretch: 1.2 lies beyond")), "{:?}", beyond.notes);
    assert_eq!(of([0.98, 1.05, 0.995]).notes, [""; 0]);
}

#[test]
fn too_few_or_impossible_readings_are_refused() {
    let room = Room::new();
    let set = synthetic();
    let with = |change: fn(&mut [Vec<f64>; 3])| {
        let mut set = set.clone();
        change(&mut set);
        yaml(&set)
    };
    room.refused(&with(|s| s[1].truncate(12)), "stretch: 12 readings; the test has 20");
    room.refused(&with(|s| s[0][6] = 1900.0), "recovery: reading 7 (1900) against 1840");
    room.refused(&with(|s| s[1][2] = 500.0), "stretch: reading 3 (500) against 609.6");
    room.refused(&with(|s| s[2][3] = -2.0), "bend: reading 4 is -2");
    room.refused(&with(|s| s[2].fill(30.0)), "bend: all readings are the same");
    room.refused(&yaml(&set).replace("initial: 1840,", ""), "recovery: give initial: the flat specimen's area");
    room.refused(&format!("stretch: {{initial: 1, readings: {}}}", list(&set[1])), "recovery: not given");
    room.refused("name: x\n", "has no measurements");
    room.refused("recovrey: {}\n", "recovrey");
    room.refused("values: {weight: 100 g/m2}\n", "has no bend value");
    room.refused("means: {recovery: 98, stretch: 1.04, bend: 0.995}\n", "recovery: the mean 98 is no ratio");
    room.refused(&(yaml(&set) + "means: {recovery: 0.9, stretch: 1, bend: 0.9}\n"), "leave one out");
    room.refused("means: {recovery: 0.98, stretch: 1.04, bend: 1.2}\n", "bend: the mean 1.2 is no ratio");
    room.refused(&with(|s| s[2][4] *= 10.0), "is more than 3 times the median");
    room.refused(&yaml(&set).replace("load: 600", "load: .nan"), "stretch: a load of NaN gf");
    room.refused("- 1\n", "expected a map of recovery, stretch, bend");
    room.refused(
        "values: {weight: 115 g/m2, bend.warp: 1 uN.m, bend: {warp: 2 uN.m}}\n",
        "bend.warp stands there twice",
    );
    let both = "values: {weight: 115 g/m2, bend: 1 uN.m, tensile.warp: {EMT: 5 %, curve: '1:10'}}\n";
    room.refused(both, "values: tensile.warp.EMT and tensile.warp.curve say the same; leave one out");
    // Recovery weighs nothing then: a board.
    room.refused("means: {recovery: 0.96, stretch: 1.05, bend: 0.995}\nvalues: {weight: 115 g/m2}\n", "give bend");
    room.refused("values: {weight: 115 g/m2, bend: 1 uN.m, name: foo}\n", "values: name is none");
    room.refused("values: {weight: 115 g/m2, bend: 1 uN.m, weight: 9 g/m2}\n", "duplicate entry");
    room.refused("name: ''\nvalues: {weight: 115 g/m2, bend: 1 uN.m}\n", "name: a word or two");
    room.refused(&format!("values: {}", "[".repeat(200_000)), "nested deeper");
    let csv = measure(&room.file("bad.csv", "a, b\n1, 2\n"), "mine").expect_err("no columns").to_string();
    assert!(csv.contains("row 1: the first line must name the columns"), "{csv}");
}

#[test]
fn rows_that_are_no_readings_are_refused() {
    let room = Room::new();
    let head = "repeat, recovery, stretch, bend\ninitial, 1840, 609.6,\n1, 1674, 628, 30\n";
    for (rows, why) in [
        ("mean, 1700, 630, 31\n", "row 4: 'mean' is no repeat"),
        ("initial, 1900, 609.6,\n", "row 4: repeat 'initial' stands there twice"),
        ("1, 1674, 628, 30\n", "row 4: repeat '1' stands there twice"),
        ("2, 1674, 628,1, 30,5\n", "row 4: 6 fields, where the first row names 4"),
        ("2, 1674, nan, 30\n", "row 4: stretch: 'nan' is no number above 0"),
    ] {
        let said = measure(&room.file("bad.csv", format!("{head}{rows}")), "mine").expect_err(why).to_string();
        assert!(said.contains(why), "{said}");
    }
    // Row 5 has no recovery: the fourth reading of it is in row 7.
    let mut rows: Vec<String> = (1..=21).map(|k| format!("{k},{},{},{}", 1700 + k, 630 + k, 30 + k % 3)).collect();
    rows[2] = "3,,633,31".to_owned();
    let table = |fifth: &str| {
        let rows = [&rows[..4], &[fifth.to_owned()], &rows[5..]].concat().join("\n");
        measure(
            &room.file("rows.csv", format!("repeat,recovery,stretch,bend\ninitial,1840,609.6,50\n{rows}\n")),
            "mine",
        )
    };
    let said = table("5,1900,635,31").expect_err("more than flat").to_string();
    assert!(said.contains("recovery: reading 4 in row 7 (1900) against 1840"), "{said}");
    let notes = table("5,170.5,635,31").expect("a table").notes;
    assert!(notes[0].contains("bend: initial, 50, is not used"), "{notes:?}");
    assert!(notes[1].contains("recovery: reading 4 in row 7 (170.5) lies far from the others"), "{notes:?}");
    assert_eq!(notes.len(), 2);
    assert!(table("04,1705,635,31").expect_err("twice").to_string().contains("repeat '4' stands there twice"));
    let german = "repeat;recovery;stretch;bend\ninitial;1840;609,6;\n1;1674;628,1;30,5\n";
    let said = measure(&room.file("bad.csv", german), "mine").expect_err("commas").to_string();
    assert!(said.contains("row 2: stretch: '609,6' is no number; write a decimal point"), "{said}");
}

#[test]
fn values_replace_what_a_sheet_says_in_other_words() {
    let room = Room::new();
    // A byte order mark, as spreadsheets begin UTF-8 with.
    room.file(
        "fast.csv",
        "\u{feff}parameter,warp,weft,unit\nC,20,18,mm\nE5,.5,.8\nE100,2,3.5\nEB5,3,,%\nW,150,,g/m2\n",
    );
    let file =
        "sheet: fast.csv\nvalues: {tensile: {warp: {EMT: 9 %, LT: 0.9}}, shear: 2 gf/cm.deg, bend: 0.5 gf.cm2/cm}\n";
    let found = measure(&room.file("a.yaml", file), "mine").expect("measured");
    let keys: Vec<&str> = found.sheet.measurements.iter().map(|m| m.key.as_str()).collect();
    assert_eq!(keys, ["weight", "tensile.weft.curve", "tensile.warp.EMT", "tensile.warp.LT", "shear", "bend"]);
    assert_relative_eq!(found.fabric.bend_warp, 0.5 * 98.0665e-6, max_relative = 1e-9);
}

#[test]
fn a_table_of_the_three_tests_stands_beside_other_values() {
    let room = Room::new();
    let whole = room.measure(&yaml(&synthetic())).expect("typed in");
    room.file("readings.csv", table(&synthetic()));
    let beside = "values: {weight: 115 g/m2, bend: 0.05 gf.cm2/cm}\n";
    let joined = room.measure(&format!("table: readings.csv\n{beside}")).expect("joined");
    assert_eq!(joined.sheet.liu, whole.sheet.liu);
    assert_relative_eq!(joined.fabric.areal_density, 0.115, epsilon = 1e-12);
    assert_eq!(joined.inputs.len(), 2);
    room.refused("table: readings.csv\nmeans: {recovery: 0.9, stretch: 1.05, bend: 0.9}\n", "leave one out");
    room.refused("recovery: 1702 cm2\n", "expected a map of initial, unit, readings, photos or load");
    room.refused("table: none.csv\n", "none.csv");
    room.file("typo.csv", "repeat,recovery,stretch,bend\n1,1702,x,30\n");
    room.refused("table: typo.csv\n", "typo.csv, row 2");
}

#[test]
fn a_curve_among_the_values_is_written_down_and_never_over() {
    let room = Room::new();
    let curve = room.file("flex.csv", "strain %, load gf/cm\n1, 50\n2.5, 500\n");
    let file = "values: {weight: 100 g/m2, bend: 0.1 gf.cm2/cm, tensile: {warp: flex.csv}}\n";
    let found = measure(&room.file("a.yaml", file), "mine").expect("measured");
    assert!(found.inputs.contains(&curve), "{:?}", found.inputs);
    let written = found.sheet.measurements.iter().find(|m| m.key == "tensile.warp.curve").expect("the curve");
    assert_eq!(written.value, "1:50 2.5:500");
    // 275 gf/cm lie half-way between both rows.
    assert_relative_eq!(found.fabric.warp.strain(275.0 * 0.980_665), 0.017_5, max_relative = 1e-6);
}

#[test]
fn an_error_in_a_recorded_curve_names_its_line() {
    let room = Room::new();
    room.file("warp.csv", "# KES-FB1\n# warp\nstrain %, load gf/cm\n0,0\n.5,20\n1,15\n2,200\n");
    room.refused(
        "curves: {tensile: {warp: warp.csv}}\nvalues: {weight: 100 g/m2, bend: 1 uN.m}\n",
        "row 6: load falls",
    );
}

/// A picture of `side` pixels with a square of cloth of `cloth` pixels a side, as PNG.
fn photo(side: u32, cloth: u32, colours: png::ColorType, ink: &[u8], paper: &[u8]) -> Vec<u8> {
    let mut pixels = Vec::new();
    for k in 0..side * side {
        let inside = k % side < cloth && k / side < cloth;
        pixels.extend_from_slice(if inside { ink } else { paper });
    }
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, side, side);
    encoder.set_color(colours);
    encoder.write_header().and_then(|mut w| w.write_image_data(&pixels)).expect("png");
    bytes
}

#[test]
fn photographs_are_counted() {
    let room = Room::new();
    let grey = |cloth| photo(50, cloth, png::ColorType::Grayscale, &[90], &[200]);
    room.file("flat.png", grey(40));
    let names: Vec<String> = (0..20u32)
        .map(|k| {
            let name = format!("c{k}.png");
            // Dark blue on pale yellow, partly transparent paper: every kind of pixel counts the same.
            let colour = photo(50, 30 + k % 5, png::ColorType::Rgba, &[20, 20, 90, 255], &[0, 0, 0, 10]);
            room.file(&name, if k.is_multiple_of(2) { grey(30 + k % 5) } else { colour });
            name
        })
        .collect();
    let rest = yaml(&synthetic()).lines().filter(|l| !l.starts_with("recovery")).collect::<Vec<_>>().join("\n");
    let text = |extra: &str| {
        let files = names.join(", ");
        format!("{rest}\nrecovery: {{photos: {{flat: flat.png, crumpled: [{files}]{extra}}}}}\n")
    };
    let made = room.measure(&text("")).expect("photos");
    let sides: f64 = (0..20).map(|k| f64::from(30 + k % 5).powi(2)).sum::<f64>() / 20.0;
    assert_relative_eq!(made.sheet.liu.expect("measures").means[0], sides / 1600.0, epsilon = 1e-12);
    assert_eq!(made.inputs.len(), 22);
    room.refused(&text(", threshold: 40"), "no pixel is cloth at threshold 40");
    assert!(
        made.notes[0].contains("covers 64.0 % of the flat one's photograph, 36.0 to 46.2 % of"),
        "{:?}",
        made.notes
    );
    assert!(!made.notes.iter().any(|n| n.contains("threshold")), "{:?}", made.notes);
    let near = room.measure(&text(", threshold: 100")).expect("photos").notes;
    assert!(near[1].contains("the threshold 100 does not part cloth and table in 11 of 21"), "{near:?}");
    room.refused(&text(", cloth: light"), "is the cloth the light part");
    room.refused(&text("").replace("c4.png", "c3.png"), "c3.png: it stands there twice");
    room.file("c3.png", photo(60, 30, png::ColorType::Grayscale, &[90], &[200]));
    room.refused(&text(""), "c3.png: 60 × 60 pixels, the first 50 × 50; the camera must not move");
    room.file("c3.png", b"no picture");
    room.refused(&text(""), "it is neither PNG nor JPEG");
}

/// 8 × 8 pixels of one grey: the smallest JPEG there is, written by hand (baseline, one component).
fn jpeg(dark: bool) -> Vec<u8> {
    let mut out = vec![0xff, 0xd8, 0xff, 0xdb, 0, 67, 0];
    out.extend([1; 64]);
    out.extend([0xff, 0xc0, 0, 11, 8, 0, 8, 0, 8, 1, 1, 0x11, 0]);
    // DC: categories 0 and 10 with codes 0 and 10; AC: end of block with code 0.
    let table = |class: u8, counts: [u8; 2], values: &[u8]| {
        let mut segment = vec![0xff, 0xc4, 0, 19 + values.len() as u8, class];
        segment.extend(counts.iter().copied().chain([0; 14]));
        segment.extend(values);
        segment
    };
    out.extend(table(0x00, [1, 1], &[0, 10]));
    out.extend(table(0x10, [1, 0], &[0]));
    out.extend([0xff, 0xda, 0, 8, 1, 1, 0, 0, 63, 0]);
    // Difference ±640 (that is ±80 grey values about 128) in 10 bits, then the end of the block.
    let bits: u32 = if dark { 1023 - 640 } else { 640 };
    let stream = (0b10 << 11) | (bits << 1);
    let padded = (stream << 3) | 0b111;
    out.extend([(padded >> 8) as u8, padded as u8, 0xff, 0xd9]);
    out
}

#[test]
fn jpeg_photographs_are_read() {
    let room = Room::new();
    for (dark, share) in [(true, 1.0), (false, 0.0)] {
        let photo = Photo::read(&room.file("p.jpg", jpeg(dark))).expect("jpeg");
        assert_eq!((photo.width, photo.height), (8, 8));
        assert_eq!(photo.share(128, false), share);
        assert_eq!(photo.share(128, true), 1.0 - share);
    }
    let cut = jpeg(true);
    let said = Photo::read(&room.file("p.jpg", &cut[..cut.len() - 2])).expect_err("no end").to_string();
    assert!(said.contains("it is cut short"), "{said}");
    assert!(matches!(Photo::read(&room.file("p.jpg", [0xff, 0xd8, 1])), Err(MeasureError::Photo { .. })));
    assert!(matches!(Photo::read(Path::new("none.png")), Err(MeasureError::Photo { .. })));
}

#[test]
fn a_value_of_a_sheet_is_blamed_on_its_row() {
    let room = Room::new();
    let said = |rows: &str| {
        let sheet = room.file("kes.csv", format!("parameter,warp,weft,unit\nB,.067,.05\n{rows}\n"));
        measure(&sheet, "mine").expect_err(rows).to_string()
    };
    assert!(
        said("W,18,,mg/cm2\nEMT,5,5\nLT,60,65,%")
            .contains("kes.csv, row 5: fabric 'mine': cannot read tensile.warp.LT")
    );
    assert!(
        said("EMT,5,5")
            .ends_with("kes.csv: fabric 'mine' has no weight value; give weight in g/m2, kg/m2, mg/cm2 or oz/yd2")
    );
    room.file("kes.csv", "parameter,warp,weft\nB,.067,.05\nMIU,.2\n");
    // What the file of readings says itself is not the sheet's.
    room.refused("sheet: kes.csv\nvalues: {weight: 115 g/m2, friction: 40 %}\n", "readings.yaml: fabric 'mine'");
}

#[test]
fn a_fabric_that_hardly_any_cloth_is_like_is_doubted() {
    let room = Room::new();
    let notes = |values: &str| room.measure(&format!("values: {{{values}}}\n")).expect("a fabric").fabric.notes();
    let cloth = "weight: 115 g/m2, bend: 0.1 gf.cm2/cm";
    assert!(notes(cloth).is_empty());
    assert!(notes("weight: 115 g/m2, bend: 0.05 uN.m")[0].contains("a bending length of 3.5 mm"));
    assert!(
        notes(&format!("{cloth}, tensile: {{EMT: 0.05 %, LT: 0.7}}"))[1].contains("along the weft it gives 0.050 %")
    );
    assert!(notes(&format!("{cloth}, thickness: 0.01 mm"))[0].contains("11500 kg/m3"));
    for name in library() {
        assert!(load(name).expect(name).notes().is_empty(), "{name}");
    }
}

#[test]
fn sheets_and_curves_make_a_fabric() {
    let room = Room::new();
    room.file(
        "kes.csv",
        "parameter,warp,weft,unit\nB,.067,.05\nG,.6,.55\nW,18,,mg/cm2\nT0,.4\nMIU,.2\nEMT,4,8\nLT,.6,.6\n",
    );
    room.file("warp.csv", "strain %, load gf/cm\n0,0\n.5,20\n1,60\n2,200\n3,500\n2.5,200\n1.5,0\n");
    room.file("shear.csv", "0,0\n.5,.69\n5,3.45\n8,5.1\n5,2.3\n.5,-.11\n0,-.4\n");
    let text =
        "sheet: kes.csv\ncurves: {tensile: {warp: warp.csv}, shear: {warp: shear.csv}}\nvalues: {friction: 0.33}\n";
    let made = room.measure(text).expect("fabric");
    let fabric = room.again(&made);
    assert_relative_eq!(fabric.areal_density, 0.18, epsilon = 1e-12);
    assert_relative_eq!(fabric.bend_warp, 0.067 * 98.0665e-6, max_relative = 1e-9);
    // The curve replaces the sheet's extension, the weft keeps it; the friction is that of the file itself.
    assert_relative_eq!(fabric.warp.load(0.02), 200.0 * 0.980_665, max_relative = 1e-5);
    assert_relative_eq!(fabric.weft.load(0.08), 500.0 * 0.980_665, max_relative = 1e-5);
    assert_relative_eq!(fabric.friction, 0.33);
    // The middle line of the loop: (2.875 − 0.29) / 4.5 gf/cm per degree.
    let middle = (0.5 * (3.45 + 2.3) - 0.5 * (0.69 - 0.11)) / 4.5;
    assert_relative_eq!(fabric.shear, middle * 0.980_665 * 180.0 / std::f64::consts::PI, max_relative = 1e-4);
    let value = |key: &str| made.sheet.measurements.iter().find(|m| m.key == key).map(|m| m.value.as_str());
    assert_eq!(value("shear.two_HG"), Some("0.8 gf/cm"));
    assert_eq!(value("shear.two_HG5"), Some("1.15 gf/cm"));
    assert!(value("tensile.warp.RT").is_some_and(|rt| rt.ends_with('%')));
    // A sheet alone is enough.
    let alone = measure(&room.0.path().join("kes.csv"), "wool").expect("sheet");
    assert_eq!(alone.sheet.name, "wool");
    let wrong = room.file("short.csv", "parameter,warp,weft,unit\nEMT,4,8\n");
    assert!(measure(&wrong, "x").expect_err("no bending").to_string().contains("has no"));
}
