//! Mannequins with the measures of a person.

use std::cell::Cell;
use std::path::Path;

use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use toile::geometry::{Topology, Vec3};
use toile::io::garment::{read_text, write};
use toile::mannequin::{FilePlace, Mannequin, MannequinSpec, Measures, PartKind, build_measured, check_body};
use toile::pipeline::{Job, Overrides};

/// Measures of girth with the part and the landmark where a tape goes round.
const GIRTHS: [(&str, PartKind, &str); 12] = [
    ("neck", PartKind::Neck, "neck base"),
    ("chest", PartKind::Torso, "bust"),
    ("waist", PartKind::Torso, "waist"),
    ("hips", PartKind::Torso, "high hip"),
    ("seat", PartKind::Torso, "hip"),
    ("upper_leg", PartKind::LeftLeg, "thigh"),
    ("knee", PartKind::LeftLeg, "knee"),
    ("calf", PartKind::LeftLeg, "calf"),
    ("ankle", PartKind::LeftLeg, "ankle"),
    ("biceps", PartKind::LeftArm, "biceps"),
    ("elbow", PartKind::LeftArm, "elbow"),
    ("wrist", PartKind::LeftArm, "wrist"),
];

fn own(spec: &MannequinSpec, name: &str) -> f64 {
    let (_, _, row) = GIRTHS.iter().find(|girth| girth.0 == name).expect("a girth");
    let trunk = spec.torso.iter().map(|r| (&r.name, r.girth));
    let leg = spec.leg.rows.iter().map(|r| (&r.name, r.girth));
    let arm = spec.arm.rows.iter().map(|r| (&r.name, r.girth));
    trunk.chain(leg).chain(arm).find(|(own, _)| own == row).expect("a row").1
}

fn mark(body: &Mannequin, kind: PartKind, row: &str) -> (Vec3, Vec3) {
    let part = body.part(kind).expect("a part");
    let mark = part.landmarks.iter().find(|mark| mark.0 == row).expect("a landmark").1;
    let axis = if kind.is_arm() { part.sections[0].axis } else { Vec3::y() };
    (mark, axis)
}

/// Girth by a tape, mm: round what of the section lies within a hand's breadth of the landmark.
fn tape(body: &Mannequin, kind: PartKind, row: &str) -> f64 {
    let (mark, axis) = mark(body, kind, row);
    1e3 * body.tape(mark, axis, |center| (center - mark).norm() < 0.06).expect("a girth")
}

fn measures(given: &[(&str, f64)]) -> Measures {
    let mut out = Measures::default();
    given.iter().for_each(|(name, mm)| out.add(name, *mm).expect("a measure"));
    out
}

/// Sizes of a person: one factor for the whole, and 3 to 12 measures with how far each is off it.
fn people() -> impl Strategy<Value = (f64, Vec<(usize, f64)>)> {
    let measures = prop::sample::subsequence((0..GIRTHS.len()).collect::<Vec<_>>(), 3..=GIRTHS.len());
    (
        (0.88..1.25),
        measures.prop_flat_map(|chosen| chosen.into_iter().map(|k| (Just(k), -0.05..0.05)).collect::<Vec<_>>()),
    )
}

/// People per mannequin, unless the environment variable TOILE_PEOPLE says another number: a hundred take four minutes.
const PEOPLE: u32 = 24;

#[test]
fn every_girth_that_is_given_is_met_on_the_surface() {
    let count_of_people =
        std::env::var("TOILE_PEOPLE").map_or(PEOPLE, |number| number.parse().expect("a number of people"));
    for name in ["woman_92", "man_100"] {
        let spec = MannequinSpec::load(name).expect("shipped");
        let mut runner = TestRunner::new_with_rng(
            Config { failure_persistence: None, ..Config::with_cases(count_of_people) },
            TestRng::deterministic_rng(RngAlgorithm::ChaCha),
        );
        // Largest error, mm, and measures that were given in all.
        let (worst, count) = (Cell::new(0.0f64), Cell::new(0));
        let result = runner.run(&people(), |(size, chosen)| {
            let given = chosen.iter().map(|&(k, off)| {
                let name = GIRTHS[k].0;
                // Bones vary less than flesh.
                let bone = matches!(name, "knee" | "ankle" | "elbow" | "wrist" | "neck");
                (name, own(&spec, name) * (if bone { size.sqrt() } else { size } + off))
            });
            let given: Vec<(&str, f64)> = given.collect();
            let body = build_measured(&spec, &measures(&given)).map_err(|e| TestCaseError::fail(e.to_string()))?;
            for (name, wanted) in &given {
                let (_, kind, row) = GIRTHS.iter().find(|girth| girth.0 == *name).expect("a girth");
                let found = tape(&body, *kind, row);
                worst.set(worst.get().max((found - wanted).abs()));
                count.set(count.get() + 1);
                prop_assert!((found - wanted).abs() < 2.0, "{name} is {found}, wanted {wanted}");
            }
            let topology = Topology::new(&body.mesh.triangles);
            prop_assert!(topology.rim_edges().next().is_none() && topology.non_manifold.is_empty());
            let check = check_body(&body.mesh, FilePlace::millimetres).expect("a body");
            prop_assert!(check.crossings.is_none(), "{given:?} crosses itself {:?}", check.crossings);
            Ok(())
        });
        println!("{name}: {} measures of {count_of_people} people, off by {:.2} mm at most", count.get(), worst.get());
        result.unwrap_or_else(|e| panic!("{name}: {e}"));
    }
}

#[test]
fn heights_and_lengths_are_met() {
    let spec = MannequinSpec::load("woman_92").expect("shipped");
    let given = [("height", 1750.0), ("inseam", 830.0), ("waist_to_seat", 210.0), ("shoulder_to_wrist", 600.0)];
    let tall = spec.measured(&measures(&given)).expect("a body");
    let y = |name: &str| tall.torso_row(name).expect("a row").y;
    assert!((y("crotch") - 830.0).abs() < 1e-9 && (y("waist") - y("hip") - 210.0).abs() < 1e-9);
    assert!((tall.arm.rows[2].at - 600.0).abs() < 1e-9);
    assert_eq!(tall.height, Some(1750.0));
    let body = build_measured(&spec, &measures(&given)).expect("a body");
    assert!((mark(&body, PartKind::Torso, "crotch").0.y - 0.830).abs() < 1e-9);
    // Girths do not change with height alone.
    assert!((tape(&body, PartKind::Torso, "bust") - 916.0).abs() < 2.0);
    // Broader shoulders.
    let broad = spec.measured(&measures(&[("shoulder_to_shoulder", 400.0)])).expect("a body");
    assert!((2.0 * broad.arm.shoulder[0] - 400.0).abs() < 1e-9);
}

#[test]
fn what_cannot_be_is_refused_by_name() {
    let spec = MannequinSpec::load("woman_92").expect("shipped");
    let refused = |given: &[(&str, f64)]| build_measured(&spec, &measures(given)).expect_err("refused").to_string();
    let text = refused(&[("waist", 74.0)]);
    assert!(text.contains("'waist' is 74 mm, its own is 735") && text.contains("millimetres"), "{text}");
    let text = refused(&[("waist_to_floor", 1100.0), ("inseam", 700.0), ("crotch_depth", 250.0)]);
    assert!(text.contains("'waist_to_floor' is 1100 mm, but 'inseam' and 'crotch_depth' are 950 together"), "{text}");
    let text = refused(&[("waist_to_seat", 200.0), ("crotch_depth", 205.0)]);
    assert!(text.contains("contradict"), "{text}");
    let man = MannequinSpec::load("man_100").expect("shipped");
    let text = man.measured(&measures(&[("underbust", 900.0)])).expect_err("no such row").to_string();
    assert!(text.contains("'underbust' cannot be set"), "{text}");
}

const BAND: &str = "\
garment: 1
body: {like: woman_92, bust: 104 cm, hip: 1100}
fabrics: {cloth: rib}
pieces:
  band:
    place: waist
    grain: [[50, 20], [50, 60]]
    outline: {start: 0 0, top: L 900 0, right: L 900 80, bottom: L 0 80, left: L 0 0}
seams: {back: {sew: band.right, to: band.left}}
free: ['*.top', '*.bottom']
";

#[test]
fn a_garment_file_holds_measures_of_its_wearer() {
    let job = |text: &str| {
        let loaded = read_text("band", "band.yaml", text).unwrap_or_else(|e| panic!("{e}"));
        Job::new(Path::new("band.yaml"), loaded, &Overrides::default())
    };
    let made = job(BAND).expect("a job");
    assert_eq!(made.body.name, "woman_92, measured");
    assert!((tape(&made.body, PartKind::Torso, "bust") - 1040.0).abs() < 2.0);
    let wrong = |old: &str, new: &str| job(&BAND.replace(old, new)).err().expect("refused").to_string();
    assert!(wrong("hip: 1100", "hop: 1100").contains("'hop' is no measure; did you mean 'hip'?"));
    assert!(wrong("hip: 1100", "hip: 110").contains("'hip'") && wrong("hip: 1100", "hip: 110").contains("band.yaml:2"));
    // What is written back is the same body.
    let file = read_text("band", "band.yaml", BAND).expect("read").file;
    let again = read_text("band", "band.yaml", &write(&file).expect("written")).expect("read").file;
    let named = |file: &toile::pattern::GarmentFile| {
        file.body_measures.iter().map(|(name, q)| (name.value.clone(), q.value)).collect::<Vec<_>>()
    };
    assert_eq!(named(&again), named(&file));
    assert_eq!(again.body.map(|b| b.value), Some("woman_92".to_owned()));
}
