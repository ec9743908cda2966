//! What messages tell a maker to do, where the mistake shows far from where it was made.

use std::path::Path;

use toile::io::garment::{Refused, read_text};
use toile::pattern::{Diagnostic, Problem};
use toile::pipeline::{Job, Overrides, Run, read};

/// What is wrong with a file that cannot be used.
fn mistakes(text: &str) -> Vec<Diagnostic> {
    match read_text("wrong", "wrong.yaml", text) {
        Ok(_) => panic!("accepted:\n{text}"),
        Err(Refused { diagnostics }) => diagnostics,
    }
}

/// A waistband sewn to the front and the back of a skirt; `BACK` is the key that the back's half needs.
fn skirt(cut: &str, back: &str) -> String {
    let half = "grain: [[10, 50], [10, 250]]
    outline: {start: 0 0, waist: L 200 0, side: L 240 300, hem: L 0 300, center: L 0 0}";
    let (band, sewn) = match cut {
        "pair" => (400, "center: {sew: front.center, to: mirror}\n  back: {sew: back.center, to: mirror}"),
        _ => (800, "ring: {sew: band.right, to: band.left}"),
    };
    format!(
        "garment: 1
pieces:
  front:
    cut: {cut}
    {half}
  back:
    cut: {cut}
    {back}
    {half}
  band:
    {}
    grain: [[10, 0], [10, 30]]
    outline: {{start: 0 0, upper: L {band} 0, right: L {band} 30, lower: L 0 30, left: L 0 0}}
seams:
  side: {{sew: front.side, to: back.side}}
  waist: {{sew: [front.waist, back.waist], to: band.lower}}
  {sewn}
free: ['*.hem', band.upper{}]
",
        if cut == "pair" { "cut: pair" } else { "" },
        if cut == "pair" { ", band.right, band.left" } else { "" },
    )
}

/// Drawn as the half of the wrong side, the back is sewn to the front upside down, which only the waist's chain shows.
#[test]
fn a_broken_chain_names_drawn_where_a_half_may_be_the_other_one() {
    for cut in ["pair", "fold center"] {
        assert!(read_text("skirt", "skirt.yaml", &skirt(cut, "drawn: R")).is_ok());
        let found = mistakes(&skirt(cut, ""));
        let broken = found.iter().find(|d| matches!(d.problem, Problem::ChainBroken { .. })).expect("a broken chain");
        assert!(broken.hint.as_deref().is_some_and(|h| h.contains("'drawn: R'")), "{cut}: {broken}");
    }
    // A chain that goes round one piece in the wrong order has nothing to do with it.
    let found = mistakes(&skirt("pair", "drawn: R").replace("[front.waist, back.waist]", "[front.waist, front.hem]"));
    let broken = found.iter().find(|d| matches!(d.problem, Problem::ChainBroken { .. })).expect("a broken chain");
    assert_eq!(broken.hint.as_deref(), Some("name the edges in the order they are sewn, end to end"));
}

/// Folded at its hem instead of its center, a piece has no halves that meet there.
#[test]
fn a_broken_chain_of_two_halves_names_the_fold() {
    let folded = |edge: &str| {
        format!(
            "garment: 1\nfabrics: {{shell: cotton_poplin}}\npieces:\n  front:\n    cut: fold {edge}\n    \
             grain: [[9, 9], [9, 90]]\n    \
             outline: {{start: 0 0, waist: L 100 0, side: L 100 100, hem: L 0 100, center: L 0 0}}\n  band:\n    \
             grain: [[9, 9], [9, 19]]\n    \
             outline: {{start: 0 0, upper: L 200 0, right: L 200 20, lower: L 0 20, left: L 0 0}}\nseams:\n  \
             waist: {{sew: [front.R.waist, front.L.waist], to: band.lower}}\nfree: ['front.*', 'band.*']\n"
        )
    };
    assert!(read_text("skirt", "skirt.yaml", &folded("center")).is_ok());
    let found = mistakes(&folded("hem"));
    let broken = found.iter().find(|d| matches!(d.problem, Problem::ChainBroken { .. })).expect("a broken chain");
    assert!(broken.hint.as_deref().is_some_and(|h| h.contains("'cut: fold' names")), "{broken}");
}

/// Openings of both ends add up, against all edges of the chain together.
#[test]
fn openings_too_long_say_what_to_do_instead() {
    let opened = |open: &str| {
        let to = format!("to: band.lower, {open}}}");
        mistakes(&skirt("fold center", "drawn: R").replace("to: band.lower}", &to))
    };
    for (open, sum) in [
        ("open: {from: start, length: 900}", "900.0"),
        ("open: [{from: start, length: 300}, {from: end, length: 600}]", "900.0"),
        ("open: {from: start, length: 900, closure: buttons}", "900.0"),
    ] {
        let found = opened(open);
        let said = format!("seam 'waist' is 800.0 mm long but opens {sum} mm in all");
        let hit = found.iter().find(|d| d.message == said).unwrap_or_else(|| panic!("{open}: {found:#?}"));
        assert!(hit.hint.as_deref().is_some_and(|h| h.contains("'free'")), "{hit}");
    }
}

/// The first of them would be forgotten.
#[test]
fn two_openings_from_one_end_are_to_be_written_as_one() {
    let opened = |open: &str| {
        let to = format!("to: band.lower, open: [{open}]}}");
        let text = skirt("fold center", "drawn: R").replace("to: band.lower}", &to);
        read_text("skirt", "skirt.yaml", &text)
    };
    let twice = "seam 'waist' is opened twice from its start; write one opening there, as long as it is open in all";
    for other in ["", ", closure: zip"] {
        let both = format!("{{from: start, length: 20}}, {{from: start, length: 50{other}}}");
        let Err(Refused { diagnostics }) = opened(&both) else { panic!("accepted: {both}") };
        assert!(diagnostics.iter().any(|d| d.message == twice), "{diagnostics:#?}");
    }
    assert!(opened("{from: start, length: 20}, {from: end, length: 50}").is_ok());
}

#[test]
fn a_body_without_parts_says_so_and_how_positions_count() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let file = root.join("tests/data/skirt.yaml");
    let body = root.join("tests/scenes/sphere.obj").display().to_string();
    let overrides = Overrides { spacing: Some(0.04), body: Some(body), ..Overrides::default() };
    let job = Job::new(&file, read(&file).expect("a skirt"), &overrides).expect("a job");
    let said = Run::new(&job).sew(&mut |_, _| {}).expect_err("no parts").to_string();
    for words in ["'sphere' has no trunk or limbs", "x to the wearer's left, y up, z forward"] {
        assert!(said.contains(words), "{said}");
    }
}

/// A front and a back that the file puts before and behind the arms.
#[test]
fn a_seam_with_an_arm_between_its_edges_says_so() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/arms_between.yaml");
    let overrides = Overrides { spacing: Some(0.025), ..Overrides::default() };
    let job = Job::new(&file, read(&file).expect("a garment"), &overrides).expect("a job");
    let error = Run::new(&job).sew(&mut |_, _| {}).expect_err("an arm is in the way");
    assert!(!error.is_input() && error.has_remedy());
    let said = error.to_string();
    let side = if said.contains("seam 'right'") { "right arm" } else { "left arm" };
    for words in [side, "is between its two edges", "arms further from the trunk"] {
        assert!(said.contains(words), "{said}");
    }
}

/// Two lists of edges that cannot be laid on each other as they are written can be, one of them turned round.
#[test]
fn a_twisted_seam_says_which_list_to_turn_round() {
    let square = "grain: [[9, 9], [9, 90]], outline: {start: 0 0, top: L 100 0, right: L 100 100, bottom: L 0 100, \
                  left: L 0 0}";
    let sewn = |to: &str, face: &str| {
        format!(
            "garment: 1\npieces:\n  a: {{{square}}}\n  b: {{{square}}}\nseams:\n  side: {{sew: [a.right, a.bottom], \
             to: [{to}]{face}}}\nfree: [a.top, a.left, b.top, b.left, b.right, b.bottom]\n"
        )
    };
    for (to, face) in [("b.left, b.top", ""), ("b.top, b.left", ", face: same")] {
        let found = mistakes(&sewn(to, face));
        let twisted = found.iter().find(|d| matches!(d.problem, Problem::Twisted { .. })).expect("a twisted seam");
        let mut turned: Vec<&str> = to.split(", ").collect();
        turned.reverse();
        let turned = turned.join(", ");
        let hint = twisted.hint.as_deref().expect("a hint");
        assert!(hint.contains(&format!("to: [{turned}]")), "{hint}");
        assert!(face.is_empty() || hint.contains("leave face: same out"), "{hint}");
        // What is told to do helps.
        let text = sewn(&turned, face);
        let still = match read_text("again", "again.yaml", &text) {
            Ok(_) => Vec::new(),
            Err(Refused { diagnostics }) => diagnostics,
        };
        assert!(
            !still.iter().any(|d| matches!(d.problem, Problem::Twisted { .. } | Problem::ChainBroken { .. })),
            "{still:?}"
        );
    }
    let halves = "garment: 1\npieces:\n  a: {cut: pair, grain: [[9, 9], [9, 90]], outline: {start: 0 0, top: L 100 0, \
                  right: L 100 100, bottom: L 0 100, left: L 0 0}}\nseams:\n  side: {sew: [a.right, a.bottom], to: \
                  mirror, face: same}\nfree: ['*.top', '*.left']\n";
    let found = mistakes(halves);
    let twisted = found.iter().find(|d| matches!(d.problem, Problem::Twisted { .. })).expect("a twisted seam");
    let hint = twisted.hint.as_deref().expect("a hint");
    assert!(hint.starts_with("leave face: same out") && !hint.contains("to: ["), "{hint}");
}
