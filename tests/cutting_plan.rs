//! Cutting plans: nothing overlaps, grain is kept, every piece is there, and no more cloth is taken than by hand.

use std::path::Path;

use toile::cutting::{CuttingOptions, Paper, Plan, PlanError, PlanOptions, labelled, plans};
use toile::geometry::Vec2;
use toile::io::garment::{Loaded, read, read_text};
use toile::pattern::drawings;

const GARMENTS: [&str; 5] = ["child_dress", "gore_skirt", "sheath_dress", "trousers", "tshirt"];
/// Rounding, metres.
const SAME: f64 = 1e-7;

fn shipped(name: &str) -> Loaded {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("patterns/{name}.yaml"));
    read(&file).unwrap_or_else(|e| panic!("{e}"))
}

fn papers(loaded: &Loaded, whole: bool) -> Vec<Paper> {
    let label = toile::cutting::Label { title: loaded.garment.title.clone(), wearer: None, date: None };
    labelled(&drawings(&loaded.file, &loaded.garment), &CuttingOptions { whole, ..CuttingOptions::default() }, &label)
}

fn planned(loaded: &Loaded, options: &PlanOptions) -> Vec<Plan> {
    plans(&papers(loaded, false), &papers(loaded, true), options).unwrap_or_else(|e| panic!("{e}"))
}

fn options(width: f64, nap: bool, open: bool) -> PlanOptions {
    PlanOptions { width, nap, open }
}

/// The outline that is cut; a half is closed by its fold.
fn outline(paper: &Paper) -> Vec<Vec2> {
    let mut points = paper.cut[0].clone();
    points.extend(paper.fold.map(|fold| fold[0]));
    points
}

fn sides(outline: &[Vec2]) -> impl Iterator<Item = [Vec2; 2]> + '_ {
    outline.iter().zip(outline.iter().cycle().skip(1)).map(|(p, q)| [*p, *q])
}

/// On which side of a line a point lies, in metres from it; 0 on it.
fn aside([p, q]: [Vec2; 2], r: Vec2) -> f64 {
    let far = (q - p).perp(&(r - p)) / (q - p).norm().max(f64::MIN_POSITIVE);
    if far.abs() < SAME { 0.0 } else { far }
}

fn cross(one: [Vec2; 2], other: [Vec2; 2]) -> bool {
    let apart = |line: [Vec2; 2], ends: [Vec2; 2]| aside(line, ends[0]) * aside(line, ends[1]) < 0.0;
    apart(one, other) && apart(other, one)
}

fn is_inside(outline: &[Vec2], p: Vec2) -> bool {
    if sides(outline).any(|[a, b]| {
        let share = ((p - a).dot(&(b - a)) / (b - a).norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (a.lerp(&b, share) - p).norm() < SAME
    }) {
        return false;
    }
    let over = |[a, b]: [Vec2; 2]| (a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y);
    sides(outline).filter(|side| over(*side)).count() % 2 == 1
}

fn overlap(one: &[Vec2], other: &[Vec2]) -> bool {
    sides(one).any(|a| sides(other).any(|b| cross(a, b)))
        || one.iter().any(|p| is_inside(other, *p))
        || other.iter().any(|p| is_inside(one, *p))
}

fn extent(points: &[Vec2]) -> [Vec2; 2] {
    points.iter().fold([Vec2::repeat(f64::MAX), Vec2::repeat(f64::MIN)], |[l, h], p| [l.inf(p), h.sup(p)])
}

fn check(plan: &Plan, nap: bool) {
    let outlines: Vec<Vec<Vec2>> = plan.papers.iter().map(|laid| outline(&laid.paper)).collect();
    for (k, one) in outlines.iter().enumerate() {
        let (laid, [low, high]) = (&plan.papers[k], extent(one));
        let (from, to, wide) = match laid.folded {
            true => (0.0, plan.folded, plan.width / 2.0),
            false => (plan.folded, plan.length(), plan.width),
        };
        let name = &laid.paper.name;
        assert!(low.x > -SAME && high.x < wide + SAME && low.y > from - SAME && high.y < to + SAME, "{name}");
        let grain = laid.paper.grain[1] - laid.paper.grain[0];
        assert!(grain.x.abs() < 1e-6 * grain.norm(), "{name}: {grain:?}");
        assert!(!(nap && laid.turned), "{name}");
        if let Some(fold) = laid.paper.fold {
            assert!(laid.folded && fold.iter().all(|p| p.x.abs() < SAME), "{name}: {fold:?}");
        }
        for (other, laid) in outlines[..k].iter().zip(&plan.papers) {
            assert!(!overlap(one, other), "{name} and {}", laid.paper.name);
        }
    }
}

#[test]
fn pieces_of_the_shipped_garments_lie_apart_along_the_grain_and_all_are_there() {
    for name in GARMENTS {
        let loaded = shipped(name);
        for (nap, open) in [(false, false), (true, false), (false, true)] {
            let found = planned(&loaded, &options(1.5, nap, open));
            found.iter().for_each(|plan| check(plan, nap));
            let laid: usize = found.iter().flat_map(|p| &p.papers).map(|laid| laid.pieces).sum();
            assert_eq!(laid, loaded.garment.pieces.len(), "{name}");
            assert!(!open || found.iter().all(|plan| plan.folded == 0.0));
            for plan in &found {
                let own = papers(&loaded, true).into_iter().filter(|p| p.fabric == plan.fabric);
                let area: f64 =
                    own.map(|p| sides(&outline(&p)).map(|[a, b]| a.perp(&b)).sum::<f64>().abs() / 2.0).sum();
                assert!((area - plan.area).abs() < 1e-9 && plan.efficiency() < 1.0, "{name}");
            }
        }
    }
}

/// A plan made by hand: garment, width of the cloth, whether it is open, and the length of the main fabric, metres.
type ByHand = (&'static str, f64, bool, f64);

/// Plans from the boxes of the pieces with their allowances of 10 mm.
const HAND: [ByHand; 5] = [
    // Front and back, 276 by 609 mm, at the fold below each other, and a sleeve of 346 mm beside the front.
    ("tshirt", 1.4, false, 1.218),
    // Front and back opened, side by side; both sleeves, 220 mm high, below them.
    ("tshirt", 1.4, true, 0.829),
    // Both gores side by side, 343 mm each and 638 mm long, then the waistband of 815 mm on open cloth.
    ("gore_skirt", 1.4, false, 1.453),
    // Four gores in a row, every other one upside down, and the waistband beside them.
    ("gore_skirt", 1.4, true, 0.815),
    // The front at the fold and a back beside it, 275 mm each; the front is 1078 mm long.
    ("sheath_dress", 1.4, false, 1.078),
];

#[test]
fn no_more_cloth_is_taken_than_by_hand() {
    for (name, width, open, by_hand) in HAND {
        let found = planned(&shipped(name), &options(width, false, open));
        let plan = &found[0];
        let hand = plan.area / (width * by_hand);
        assert!(plan.efficiency() >= hand - 0.03, "{name}: {} m, by hand {by_hand} m", plan.length());
    }
}

#[test]
fn plans_are_the_same_for_any_number_of_threads() {
    let loaded = shipped("trousers");
    let lengths = [1, 3].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let found = pool.install(|| planned(&loaded, &options(1.4, false, false)));
        format!("{found:?}")
    });
    assert_eq!(lengths[0], lengths[1]);
}

#[test]
fn a_piece_that_is_wider_than_half_the_cloth_is_cut_open_and_one_that_is_wider_than_all_is_refused() {
    let loaded = shipped("gore_skirt");
    // A gore is 343 mm wide.
    let found = planned(&loaded, &options(0.6, false, false));
    check(&found[0], false);
    let gores = found[0].papers.iter().filter(|laid| laid.paper.name.starts_with("front")).collect::<Vec<_>>();
    assert!(gores.len() == 2 && gores.iter().all(|laid| !laid.folded && !laid.flipped));
    let error = plans(&papers(&loaded, false), &papers(&loaded, true), &options(0.3, false, false)).err();
    assert!(matches!(error, Some(PlanError::TooWide { .. })), "{error:?}");
}

#[test]
fn pieces_that_are_no_mirror_images_are_not_cut_from_two_layers() {
    let text = "garment: 1\nfabrics: {cloth: denim}\npieces:\n  tab:\n    cut: 3\n    grain: [[5, 5], [5, 40]]\n    \
                outline: {start: 0 0, a: L 60 0, b: L 90 80, c: L 0 80, d: L 0 0}\nfree: ['*.*']\n";
    let loaded = read_text("tabs", "tabs.yaml", text).unwrap_or_else(|e| panic!("{e}"));
    let found = planned(&loaded, &options(1.4, false, false));
    check(&found[0], false);
    assert_eq!((found[0].papers.len(), found[0].folded), (3, 0.0));
    assert!(found[0].papers.iter().all(|laid| !laid.flipped && laid.pieces == 1));
}
