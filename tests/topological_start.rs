//! Garments that start from their topology: glued, their openings round the ends of the body, inflated.

use std::collections::HashMap;
use std::path::Path;

use toile::geometry::Vec3;
use toile::io::garment::read_text;
use toile::mannequin::{BodyPart, Mannequin, PartKind, Section};
use toile::pipeline::{Job, Overrides, Run, read};
use toile::report::ContactReport;
use toile::sew::Stitching;
use toile::sew::start::{glue, guess, openings, start};

/// The start's own spacing, metres: nothing is lost on the way to the mesh asked for.
const SPACING: f64 = 0.025;

fn job(garment: &str) -> Job {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(garment);
    let overrides = Overrides { spacing: Some(SPACING), ..Overrides::default() };
    Job::new(&file, read(&file).expect(garment), &overrides).expect(garment)
}

/// Mean relative error of the edges of a job's mesh.
fn strain(job: &Job, x: &[Vec3]) -> f64 {
    let sides = job.mesh.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let errors: Vec<f64> = sides
        .map(|[a, b]| [a as usize, b as usize])
        .map(|[a, b]| ((x[b] - x[a]).norm() / (job.mesh.flat[b] - job.mesh.flat[a]).norm() - 1.0).abs())
        .collect();
    errors.iter().sum::<f64>() / errors.len() as f64
}

/// Sews a garment: its openings are round these parts of the body, and nothing crosses anything.
fn is_sewn_round(job: &Job, parts: &[&str]) {
    let mut run = Run::new(job);
    run.sew(&mut |_, _| {}).expect("sewn");
    let report = run.report();
    let mut worn: Vec<&str> = report.worn.iter().filter_map(|w| w.body_part.as_deref()).collect();
    worn.sort_unstable();
    assert_eq!(worn, parts, "{:?}", report.worn);
    assert_eq!(report.contact.cloth_cloth_intersections, 0);
    assert_eq!(report.contact.cloth_body_intersections, 0);
}

#[test]
fn a_start_is_closed_outside_the_body_and_hardly_strained() {
    for (garment, strained) in [("patterns/child_dress.yaml", 0.05), ("patterns/sheath_dress.yaml", 0.05)] {
        let job = job(garment);
        let x = start(&job.garment, &job.mesh, &job.body, &job.collider).expect(garment);
        let widest = Stitching::new(&job.mesh).gaps(&x).into_iter().fold(0.0, f64::max);
        assert!(widest < 1e-9, "{garment}: a seam starts open by {widest} m");
        let inside = x.iter().filter(|p| job.collider.nearest(**p, 0.2).is_some_and(|n| n.distance < 0.0)).count();
        assert_eq!(inside, 0, "{garment}: particles that start in the body");
        let mean = strain(&job, &x);
        assert!(mean < strained, "{garment}: strained by {mean}");
    }
}

#[test]
fn a_start_is_the_same_bytes_again() {
    let job = job("patterns/child_dress.yaml");
    let start = || start(&job.garment, &job.mesh, &job.body, &job.collider).expect("a start");
    assert_eq!(start(), start());
}

#[test]
fn long_sleeves_cut_in_one_with_the_body_are_put_on_without_a_word_of_place() {
    let job = job("tests/data/dolman.yaml");
    is_sewn_round(&job, &["left arm", "neck", "right arm", "torso"]);
}

#[test]
fn a_tube_round_one_leg_is_put_round_it_where_its_word_says() {
    let job = job("tests/data/leg_warmers.yaml");
    is_sewn_round(&job, &["left leg", "left leg", "right leg", "right leg"]);
    // The knee of woman_92 is 447 mm above the floor.
    let x = start(&job.garment, &job.mesh, &job.body, &job.collider).expect("a start");
    for piece in &job.mesh.pieces {
        let heights = || piece.particles.clone().map(|p| x[p].y);
        let (low, high) = (heights().fold(f64::INFINITY, f64::min), heights().fold(0.0, f64::max));
        assert!(low > 0.05 && high > 0.42 && low < 0.447, "{}: from {low} to {high} m", piece.name);
    }
}

/// The job of a garment that lies beside the project; says so where it does not.
fn case(name: &str) -> Option<Job> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/cases/sew").join(name);
    if !file.is_file() {
        println!("skipped: {} is not there", file.display());
        return None;
    }
    Some(job(file.to_str()?))
}

#[test]
fn a_shirt_with_folded_cuffs_pleats_a_stand_and_a_collar_is_put_on() {
    if let Some(job) = case("mans_shirt.yaml") {
        is_sewn_round(&job, &["left arm", "legs", "neck", "right arm"]);
    }
}

/// The fold of this collar is drawn as a curve. Taken for a straight line, it left the collar 170 mm beside its stand.
#[test]
fn a_shirt_whose_collar_rolls_along_a_curve_is_put_on() {
    if let Some(job) = case("fs_simon.yaml") {
        is_sewn_round(&job, &["left arm", "neck", "right arm", "torso"]);
    }
}

/// Its cuffs start inside out as seen from anywhere above the hem.
#[test]
fn a_shirt_whose_star_is_found_at_its_hem_only_is_put_on() {
    let Some(job) = case("fs_simon_placewords.yaml") else { return };
    is_sewn_round(&job, &["left arm", "neck", "right arm", "torso"]);
}

#[test]
fn a_kimono_with_its_band_is_put_on() {
    if let Some(job) = case("kimono.yaml") {
        let x = start(&job.garment, &job.mesh, &job.body, &job.collider).expect("a start");
        let mut class_at = HashMap::new();
        for (p, class) in x.iter().zip(Stitching::new(&job.mesh).class) {
            let first = *class_at.entry([p.x, p.y, p.z].map(f64::to_bits)).or_insert(class);
            assert_eq!(first, class, "cloth that is not sewn together starts on one spot, {p:?}");
        }
        is_sewn_round(&job, &["left arm", "right arm", "torso"]);
    }
}

/// A cowl has more length than the way up to the neck: it starts in folds on the chest.
#[test]
fn a_cowl_does_not_stand_up_before_the_throat() {
    let Some(job) = case("fs_diana.yaml") else { return };
    let x = start(&job.garment, &job.mesh, &job.body, &job.collider).expect("a start");
    let piece = |name: &str| job.mesh.pieces.iter().find(|piece| piece.name == name).expect(name).particles.clone();
    // The middle of the neckline is drawn at the origin; the back ends at the shoulders.
    let middle = piece("front").min_by(|&a, &b| job.mesh.flat[a].norm().total_cmp(&job.mesh.flat[b].norm()));
    let cowl = x[middle.expect("particles")].y;
    let shoulders = piece("back").map(|p| x[p].y).fold(0.0, f64::max);
    assert!(cowl < shoulders + 0.03, "{cowl} m, the shoulders {shoulders} m");
}

/// A hood of GarmentCode comes with a position, all else with words: the position does not keep the garment from its
/// topology.
#[test]
fn one_piece_with_a_position_leaves_the_rest_to_the_topology() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/dolman.yaml");
    let text = std::fs::read_to_string(&file).expect("a file");
    let piece = text.find("    cut:").expect("a piece");
    let placed = format!("{}    place: {{at: [0, 900, 400]}}\n{}", &text[..piece], &text[piece..]);
    let garment = read_text("dolman", "dolman.yaml", &placed).expect("a garment");
    let overrides = Overrides { spacing: Some(SPACING), ..Overrides::default() };
    let job = Job::new(&file, garment, &overrides).expect("a job");
    let given = job.garment.pieces.iter().filter(|piece| piece.has_position()).count();
    assert!((1..job.garment.pieces.len()).contains(&given), "{given} pieces with a position");
    is_sewn_round(&job, &["left arm", "neck", "right arm", "torso"]);
}

/// Straps that are slack where a dress starts lie over the shoulders, and not round the upper arms.
#[test]
fn straps_start_over_the_shoulders() {
    let Some(job) = case("slip_bias.yaml") else { return };
    let x = start(&job.garment, &job.mesh, &job.body, &job.collider).expect("a start");
    let straps: Vec<_> = job.mesh.pieces.iter().filter(|piece| piece.particles.len() < 60).collect();
    assert_eq!(straps.len(), 2, "pieces with few particles");
    for strap in straps {
        let highest = strap.particles.clone().map(|p| x[p]).max_by(|a, b| a.y.total_cmp(&b.y)).expect("particles");
        // The shoulder points of woman_92 are 175 mm from the middle, 1,330 mm above the floor.
        assert!(highest.x.abs() < 0.175 && highest.y > 1.33, "{}: {highest:?}", strap.name);
    }
}

/// Straps from the waist at the back to a bib are as near to their arm all along. They start over the shoulders, their
/// right side out all the way.
#[test]
fn long_straps_start_over_the_shoulders_with_their_right_side_out() {
    let dungarees = case("dungarees.yaml").into_iter();
    for job in dungarees.chain([job("tests/data/pinafore.yaml")]) {
        let x = start(&job.garment, &job.mesh, &job.body, &job.collider).expect("a start");
        let straps: Vec<_> = job.mesh.pieces.iter().filter(|piece| piece.name.starts_with("strap")).collect();
        assert_eq!(straps.len(), 2, "straps");
        for strap in straps {
            let highest = strap.particles.clone().map(|p| x[p]).max_by(|a, b| a.y.total_cmp(&b.y)).expect("particles");
            assert!(highest.x.abs() < 0.175 && highest.y > 1.33, "{}: {highest:?}", strap.name);
            let wrong = job.mesh.triangles[strap.triangles.clone()].iter().filter(|t| {
                let [a, b, c] = t.map(|p| x[p as usize]);
                let near = job.collider.nearest((a + b + c) / 3.0, 0.3).expect("the body");
                (c - a).cross(&(b - a)).dot(&near.normal) < 0.0
            });
            let share = wrong.count() as f64 / strap.triangles.len() as f64;
            assert!(share < 0.1, "{}: {share} of it lies wrong side out", strap.name);
        }
    }
}

/// A pinafore whose straps are buttoned to the waistband at the back.
#[test]
fn a_pinafore_is_sewn() {
    is_sewn_round(&job("tests/data/pinafore.yaml"), &["left arm", "legs", "neck", "right arm"]);
}

/// The strap of a halter lies behind the neck, and its cups below the shoulders: it is measured from the nape.
#[test]
fn a_halter_starts_behind_the_neck_with_its_cups_on_the_bust() {
    let Some(job) = case("bralette.yaml") else { return };
    let x = start(&job.garment, &job.mesh, &job.body, &job.collider).expect("a start");
    let of = |name: &str| job.mesh.pieces.iter().find(|piece| piece.name == name).expect(name).particles.clone();
    let furthest_back = of("strap").map(|p| x[p]).min_by(|a, b| a.z.total_cmp(&b.z)).expect("particles");
    assert!(furthest_back.x.abs() < 0.1 && furthest_back.y > 1.33, "the strap: {furthest_back:?}");
    // The bust of woman_92 is at a height of 1,179 mm, the shoulder points at 1,330 mm.
    let cup: Vec<f64> = ["cup_inner.L", "cup_outer.L"].into_iter().flat_map(of).map(|p| x[p].y).collect();
    let (low, high) = (cup.iter().copied().fold(f64::INFINITY, f64::min), cup.iter().copied().fold(0.0, f64::max));
    assert!(low < 1.179 && high > 1.179 && high < 1.36, "a cup from {low} to {high} m");
}

/// A bolero is so short that its hem is nearer to its sleeves than its neck is: it was put on upside down.
#[test]
fn a_bolero_is_put_on_the_right_way_up() {
    let Some(job) = case("bolero.yaml") else { return };
    let x = start(&job.garment, &job.mesh, &job.body, &job.collider).expect("a start");
    let of = |name: &str| job.mesh.pieces.iter().find(|piece| piece.name == name).expect(name).particles.clone();
    let mean = |all: &[Vec3]| all.iter().sum::<Vec3>() / all.len() as f64;
    let [back, left] = ["back", "front.L"].map(|name| of(name).map(|p| x[p]).collect::<Vec<_>>());
    assert!(mean(&back).z < mean(&left).z, "the back lies before the front");
    let [top, bottom] = [f64::total_cmp, |a: &f64, b: &f64| b.total_cmp(a)].map(|order| {
        let lowest = of("back").min_by(|&a, &b| order(&job.mesh.flat[a].y, &job.mesh.flat[b].y));
        x[lowest.expect("particles")].y
    });
    assert!(top > bottom, "its neck is at {top} m, its hem at {bottom} m");
}

/// Two buttons of one lap may stand in one closure or in two.
#[test]
fn closures_that_hold_one_lap_together_count_as_one() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/wrap_skirt.yaml");
    let together = std::fs::read_to_string(&file).expect("a file");
    let (before, closure) = together.split_once("closures:").expect("closures");
    let (_, after) = closure.split_once("\nfree:").expect("free");
    let apart = format!(
        "{before}closures:
  - {{kind: button, piece: band, at: [[1.5, 2.5]], meets: band, meets_at: [[76.5, 2.5]]}}
  - {{kind: button, piece: band, at: [[25.7, 2.5]], meets: band, meets_at: [[100.7, 2.5]]}}
free:{after}"
    );
    let starts = [together.as_str(), apart.as_str()].map(|text| {
        let garment = read_text("skirt", "skirt.yaml", text).expect("a garment");
        let overrides = Overrides { spacing: Some(SPACING), ..Overrides::default() };
        let job = Job::new(&file, garment, &overrides).expect("a job");
        start(&job.garment, &job.mesh, &job.body, &job.collider).expect("a start")
    });
    assert_eq!(starts[0], starts[1]);
}

/// Straps that cross give the sewn garment a handle, and no part of the body can be dealt to its rims. They are put on
/// uncrossed, over the shoulders, and their ends are led across the back.
#[test]
fn straps_that_cross_at_the_back_lie_over_the_shoulders() {
    let job = job("tests/data/crossed_straps.yaml");
    let glued = glue(&job.garment, &job.mesh, &[]);
    assert_eq!(glued.crossed.len(), 2, "two straps have their ends exchanged");
    assert_eq!(glued.laps.len(), 2, "both are buttoned for the start");
    let mut run = Run::new(&job);
    run.drape(&mut |_, _| {}).expect("draped");
    let report = run.report();
    let mut worn: Vec<&str> = report.worn.iter().filter_map(|w| w.body_part.as_deref()).collect();
    worn.sort_unstable();
    assert_eq!(worn, ["left arm", "neck", "right arm", "torso"], "{:?}", report.worn);
    assert_eq!(report.contact, ContactReport::default());
    assert!(report.closures.iter().all(|c| c.closed && c.turned.is_none()), "{:?}", report.closures);
}

/// A skirt of two equal pieces whose side seams end above the hem, with a vent in the hem, so wide at its mouth.
fn slit_skirt(vent: f64) -> Job {
    let text = format!(
        "garment: 1
name: skirt
body: woman_92
fabrics: {{shell: cotton_poplin}}
pieces:
  front:
    place: hip front
    outline:
      start: -200 0
      waist: L 200 0
      right: L 240 300
      right_slit: L 265 490
      hem_1: L {half} 490
      vent_1: L 0 300
      vent_2: L -{half} 490
      hem_2: L -265 490
      left_slit: L -240 300
      left: L -200 0
  back: {{like: front, place: hip back}}
seams:
  left: {{sew: front.right, to: back.left}}
  right: {{sew: front.left, to: back.right}}
free: ['*.waist', '*.hem_1', '*.hem_2', '*.vent_1', '*.vent_2', '*.right_slit', '*.left_slit']
",
        half = vent / 2.0
    );
    let garment = read_text("skirt", "skirt.yaml", &text).expect("a garment");
    let overrides = Overrides { spacing: Some(SPACING), ..Overrides::default() };
    Job::new(Path::new("skirt.yaml"), garment, &overrides).expect("a job")
}

#[test]
fn slits_of_a_hem_start_closed_and_wide_ones_open() {
    for (vent, slits) in [(10.0, 4), (45.0, 4), (120.0, 2)] {
        let job = slit_skirt(vent);
        let glued = glue(&job.garment, &job.mesh, &[]);
        let dealing = guess(&job.garment, &job.mesh, &glued, &openings(&glued, &job.mesh), &job.body);
        let flat = |p: u32| job.mesh.flat[p as usize];
        for [a, b] in &dealing.zips {
            assert!((flat(*a).y - flat(*b).y).abs() < 1e-3, "{vent} mm: {:?} and {:?}", flat(*a), flat(*b));
        }
        let at_hem = dealing.zips.iter().filter(|[a, _]| flat(*a).y > 0.485).count();
        assert_eq!(at_hem, slits, "{vent} mm: slits closed as far as the hem");
        let closed = openings(&glue(&job.garment, &job.mesh, &dealing.zips), &job.mesh);
        assert_eq!(closed.len(), 2, "{vent} mm: waist and hem");
    }
}

/// Closed, the hem of a skirt for a mannequin twice as wide would hold no legs.
#[test]
fn a_slit_stays_open_where_the_hem_needs_it() {
    let job = slit_skirt(10.0);
    let glued = glue(&job.garment, &job.mesh, &[]);
    let wide = Mannequin { parts: job.body.parts.iter().map(|part| scaled(part, 2.0)).collect(), ..job.body.clone() };
    let dealing = guess(&job.garment, &job.mesh, &glued, &openings(&glued, &job.mesh), &wide);
    assert!(dealing.zips.is_empty(), "{} pairs", dealing.zips.len());
}

/// A part of a body whose girths are so many times as large.
fn scaled(part: &BodyPart, times: f64) -> BodyPart {
    let section = |section: &Section| Section { girth: section.girth * times, ..*section };
    BodyPart { sections: part.sections.iter().map(section).collect(), ..part.clone() }
}

#[test]
fn a_skirt_with_slits_is_sewn() {
    is_sewn_round(&slit_skirt(10.0), &["legs", "torso"]);
}

/// Pieces may stand in any order in a file. One that lies on a piece that lies on another one itself started at the
/// origin of the coordinates where it stood first.
#[test]
fn a_piece_is_laid_after_the_one_that_it_lies_on() {
    let text = "garment: 1
name: skirt with a facing that is turned up
body: woman_92
fabrics: {shell: cotton_poplin}
pieces:
  turned_up:
    layer: 1
    outline: {start: -200 20, top: L 200 20, right: L 212 100, edge: L -212 100, left: L -200 20}
  facing:
    layer: 1
    outline: {start: -200 0, waist: L 200 0, right: L 212 100, bottom: L -212 100, left: L -200 0}
  front:
    place: hip front
    outline: {start: -200 0, waist: L 200 0, right: L 248 400, hem: L -248 400, left: L -200 0}
  back: {like: front, place: hip back}
seams:
  left: {sew: front.right, to: back.left}
  right: {sew: front.left, to: back.right}
  faced: {sew: facing.waist, to: front.waist, face: same}
  turned: {sew: turned_up.edge, to: facing.bottom, face: same}
free: [back.waist, '*.hem', facing.right, facing.left, turned_up.top, turned_up.right, turned_up.left]
";
    let job = job_of("skirt", text);
    assert_eq!(glue(&job.garment, &job.mesh, &[]).left_out, [0, 1], "both lie on other cloth");
    let x = start(&job.garment, &job.mesh, &job.body, &job.collider).expect("a start");
    let highest = |piece: usize| job.mesh.pieces[piece].particles.clone().map(|p| x[p].y).fold(0.0, f64::max);
    let lowest = |piece: usize| job.mesh.pieces[piece].particles.clone().map(|p| x[p].y).fold(f64::INFINITY, f64::min);
    assert!(lowest(0) > highest(1) - 0.15, "from {} m, on a facing up to {} m", lowest(0), highest(1));
}

/// A vest whose lapels are turned over on the front, and whose collar stands at the back.
const LAPEL: &str = "garment: 1
body: woman_92
fabrics: {shell: cotton_poplin}
pieces:
  back:
    cut: pair
    drawn: R
    place: torso back
    outline: {start: 0 560, center: L 0 25, neck: 'C 50 25, 85 15, 90 0', shoulder: L 190 40,
              armhole: 'C 165 110, 175 190, 240 215', side: L 245 560, hem: L 0 560}
  front:
    cut: pair
    drawn: R
    place: torso front
    outline: {start: 0 560, hem: L -245 560, side: L -240 215, armhole: 'C -175 190, -165 110, -190 40',
              shoulder: L -90 0, neck: L 0 180, center: L 0 560}
  collar_back:
    cut: pair
    drawn: R
    layer: 1
    outline: {start: 0 40, neck: L -97.051 40, center: L -97.051 0, outer: L 0 0, end: L 0 40}
  collar_front:
    cut: pair
    drawn: R
    layer: 1
    outline: {start: 0 0, end: L 40 0, neck: L 40 201.246, outer: 'Q -36 74, 0 0'}
seams:
  shoulder: {sew: front.shoulder, to: back.shoulder}
  side: {sew: front.side, to: back.side}
  front_center: {sew: front.center, to: mirror}
  back_center: {sew: back.center, to: mirror}
  front_neck: {sew: front.neck, to: collar_front.neck, face: same}
  back_neck: {sew: back.neck, to: collar_back.neck}
  end: {sew: collar_front.end, to: collar_back.end, face: same}
  collar_center: {sew: collar_back.center, to: mirror}
free: ['*.armhole', '*.outer', '*.hem']
";

/// The job of the file `text` of this name.
fn job_of(name: &str, text: &str) -> Job {
    let file = format!("{name}.yaml");
    let garment = read_text(name, &file, text).expect("a garment");
    let overrides = Overrides { spacing: Some(SPACING), ..Overrides::default() };
    Job::new(Path::new(&file), garment, &overrides).expect("a job")
}

/// Laid on the front as a patch is, it started in the collar: 51 triangles crossed one another.
#[test]
fn a_lapel_is_turned_over_where_its_collar_stands() {
    let job = job_of("vest", LAPEL);
    let glued = glue(&job.garment, &job.mesh, &[]);
    assert!(glued.left_out.is_empty(), "{:?}", glued.left_out);
    let turned: Vec<&str> = glued.turned.iter().map(|&piece| job.mesh.pieces[piece].name.as_str()).collect();
    assert_eq!(turned, ["collar_front.R", "collar_front.L"]);
    is_sewn_round(&job, &["left arm", "neck", "right arm", "torso"]);
    // A collar that lies on the cloth all round is none.
    let flat = LAPEL.replace("to: collar_back.neck}", "to: collar_back.neck, face: same}");
    let job = job_of("flat", &flat.replace("to: collar_back.end, face: same}", "to: collar_back.end}"));
    let glued = glue(&job.garment, &job.mesh, &[]);
    assert!(glued.turned.is_empty() && glued.left_out.len() == 4, "{:?} {:?}", glued.turned, glued.left_out);
}

/// Its opening was held round the neck, above the shoulder that it hangs from.
#[test]
fn a_top_over_one_shoulder_is_sewn() {
    is_sewn_round(&job("tests/data/one_shoulder.yaml"), &["left arm", "torso", "torso"]);
}

/// The pressure lifted its skirt into the bodice, and arms that came down left their armholes.
#[test]
fn a_sleeveless_dress_with_a_wide_skirt_is_sewn() {
    is_sewn_round(&job("tests/data/flared_dress.yaml"), &["left arm", "legs", "neck", "right arm"]);
}

/// The crease ends on slanted edges, beside where it was drawn by less than a micrometre. Its particles counted as
/// folded over, and the collar started inside the shirt.
#[test]
fn a_collar_without_a_stand_starts_folded_and_is_sewn() {
    let job = job("tests/data/collar_on_neck.yaml");
    let glued = glue(&job.garment, &job.mesh, &[]);
    let collar = job.mesh.pieces.iter().find(|piece| piece.name == "collar").expect("a collar");
    let has_place = |p: usize| {
        let is_beyond = glued.beyond.iter().any(|beyond| beyond.particle as usize == p);
        glued.node_of[p].is_some() || glued.follows[p].is_some() || is_beyond
    };
    assert!(collar.particles.clone().all(has_place));
    is_sewn_round(&job, &["left arm", "neck", "right arm", "torso"]);
}

/// It started in the middle of the body.
#[test]
fn a_tacked_pocket_lies_on_its_skirt() {
    let job = job("tests/data/tacked_pocket.yaml");
    let x = start(&job.garment, &job.mesh, &job.body, &job.collider).expect("a start");
    let piece = |name: &str| job.mesh.pieces.iter().position(|piece| piece.name == name).expect("a piece");
    for p in job.mesh.pieces[piece("pocket")].particles.clone() {
        // The pocket is drawn where it lies on the front.
        let below = job.mesh.nearest(piece("front"), job.mesh.flat[p]).expect("cloth below");
        assert!(x[p].z > x[below].z, "{:?} lies under {:?}", x[p], x[below]);
    }
    is_sewn_round(&job, &["legs", "torso"]);
}

/// Arms were dealt to the leg holes of a bikini: its sides are short.
#[test]
fn a_bikini_is_sewn_round_the_hips() {
    is_sewn_round(&job("tests/data/bikini.yaml"), &["left leg", "right leg", "torso"]);
}

/// The bags of pockets close their mouths, and their own seams are no openings.
#[test]
fn a_pocket_is_no_opening() {
    let job = job("tests/data/slash_pockets.yaml");
    let mut run = Run::new(&job);
    run.sew(&mut |_, _| {}).expect("sewn");
    let faults: Vec<_> = run.report().worn.into_iter().filter_map(|worn| worn.fault).collect();
    assert!(faults.is_empty(), "{faults:?}");
}

/// A garment without a seam had no stage to sew.
#[test]
fn a_cloth_that_is_only_knotted_is_put_on() {
    let text = "garment: 1
body: woman_92
fabrics: {shell: chiffon}
pieces:
  cloth:
    grain: [[500, 100], [500, 300]]
    outline: {start: 0 0, top: L 1000 0, right: L 1000 400, hem: L 0 400, left: L 0 0}
closures:
  - {kind: knot, piece: cloth, at: [[40, 15], [40, 40]], meets: cloth, meets_at: [[960, 15], [960, 40]]}
free: ['cloth.*']
";
    let overrides = Overrides { spacing: Some(SPACING), ..Overrides::default() };
    let loaded = read_text("cloth", "cloth.yaml", text).expect("a garment");
    let job = Job::new(Path::new("cloth.yaml"), loaded, &overrides).expect("a job");
    let mut run = Run::new(&job);
    run.sew(&mut |_, _| {}).expect("put on");
    assert!(run.report().worn.iter().any(|worn| worn.body_part.as_deref() == Some("torso")));
}

/// Band and tails were one ring, twice as long as the waist.
#[test]
fn an_apron_is_tied_and_its_tails_are_no_part_of_the_band() {
    let job = job("tests/data/tied_apron.yaml");
    let glued = glue(&job.garment, &job.mesh, &[]);
    let shortest = openings(&glued, &job.mesh).iter().map(|opening| opening.length).fold(f64::INFINITY, f64::min);
    assert!((shortest - 0.76).abs() < SPACING, "from knot to knot: {shortest} m");
    // It has not fallen yet: the hem is still level with the trunk.
    is_sewn_round(&job, &["torso", "torso"]);
}

/// No mannequin has a head: a hood stands up when it is put on, and then falls off the end of the neck.
#[test]
fn a_hood_that_collapses_is_no_fault() {
    let job = job("tests/data/hooded_top.yaml");
    let mut run = Run::new(&job);
    run.sew(&mut |_, _| {}).expect("sewn");
    run.drape(&mut |_, _| {}).expect("draped");
    let report = run.report();
    let face = report.worn.iter().find(|worn| worn.opening == "face").expect("the hood's opening");
    assert_eq!(face.placed.as_ref().and_then(|placed| placed.body_part.as_deref()), Some("neck"));
    assert_eq!(face.body_part, None, "it has fallen");
    assert_eq!(report.worn.iter().filter_map(|worn| worn.fault.as_ref()).count(), 0, "{:?}", report.worn);
}

/// Its crotch was put at the body's, and the waistband under the arms.
#[test]
fn trousers_with_a_low_crotch_are_worn_at_the_waist() {
    let job = job("tests/data/low_crotch.yaml");
    let x = start(&job.garment, &job.mesh, &job.body, &job.collider).expect("a start");
    let band = job.mesh.pieces.iter().find(|piece| piece.name == "band").expect("a band");
    let middle = band.particles.clone().map(|p| x[p].y).sum::<f64>() / band.particles.len() as f64;
    let torso = job.body.part(PartKind::Torso).expect("a torso");
    let waist = torso.landmarks.iter().find(|(name, _)| name == "waist").expect("a waist").1.y;
    assert!((middle - waist).abs() < 0.07, "the band starts at {middle} m, the waist is at {waist} m");
    is_sewn_round(&job, &["left leg", "right leg", "torso"]);
}
