//! Pleats, pressed folds, elastic and layers, in cloth that hangs.

use std::path::Path;
use std::sync::Arc;

use approx::assert_relative_eq;
use toile::contact::{Collider, closest_on_triangle};
use toile::drape::{DrapeError, DrapeOptions, check_fall, drape};
use toile::dynamics::Cut;
use toile::fabric::{self, Fabric};
use toile::geometry::Vec3;
use toile::mesh::ClothMesh;
use toile::pipeline::{Job, Overrides, Run, read};
use toile::report::Report;
use toile::sew::{Stitching, sewn_world};

/// A garment of `tests/data` at rest: its job, particles and report.
struct Draped {
    job: Job,
    x: Vec<Vec3>,
    report: Report,
}

fn draped(name: &str, spacing: f64) -> Draped {
    let file = Path::new("tests/data").join(name);
    let overrides = Overrides { spacing: Some(spacing * 1e-3), ..Overrides::default() };
    let job = Job::new(&file, read(&file).expect("a garment"), &overrides).map_err(|e| e.to_string()).expect("a job");
    let mut run = Run::new(&job);
    run.flatten(&toile::flatten::FlattenOptions::default(), &mut |_, _| {})
        .map_err(|e| e.to_string())
        .expect("laid flat");
    let (x, report) = (run.last().expect("draped").to_vec(), run.report());
    let contact = &report.contact;
    let crossings = contact.inside_body + contact.cloth_body_intersections + contact.cloth_cloth_intersections;
    assert_eq!(crossings, 0, "{name}: {contact:?}");
    assert!(report.stages.iter().all(|s| s.converged), "{name}: {:?}", report.stages);
    Draped { job, x, report }
}

impl Draped {
    /// Particles of a piece whose flat position passes `which` (mm).
    fn particles(&self, piece: &str, which: impl Fn(f64, f64) -> bool) -> Vec<usize> {
        let mesh = &self.job.mesh;
        let piece = mesh.pieces.iter().find(|p| p.name == piece).expect("a piece");
        piece.particles.clone().filter(|&p| which(mesh.flat[p].x * 1e3, mesh.flat[p].y * 1e3)).collect()
    }

    /// Distance from the upright axis through the middle of the body, metres.
    fn outward(&self, p: usize) -> f64 {
        self.x[p].x.hypot(self.x[p].z)
    }
}

#[test]
fn a_waist_elastic_draws_the_cloth_in_and_the_flat_piece_stays_as_drawn() {
    let skirt = draped("elastic_waist.yaml", 15.0);
    let line = &skirt.job.mesh.pieces[0].lines[0].particles;
    let length = |at: &dyn Fn(u32) -> Vec3| line.windows(2).map(|w| (at(w[1]) - at(w[0])).norm()).sum::<f64>();
    let flat = length(&|p| skirt.job.mesh.flat[p as usize].push(0.0));
    let worn = length(&|p| skirt.x[p as usize]);
    // At 0.7 the band is slack, no longer than the body's waist of 740 mm; how far it slides down from there depends on
    // friction, but it stays on the slope over the hip, 980 mm.
    assert!(worn > 0.69 * flat && worn < 0.95 * 0.98, "{worn} m of {flat} m");
    for piece in &skirt.report.pieces {
        assert!(piece.area_error.round_trip.is_some_and(|e| e < 2e-3), "{:?}", piece.area_error);
        assert!(piece.boundary_error.round_trip.is_some_and(|e| e < 3e-3), "{:?}", piece.boundary_error);
        assert!(piece.strain.p99 < 0.01, "{:?}", piece.strain);
    }
    // Without the elastic this skirt, 1040 mm at the waist, falls to the floor.
    let top = skirt.x.iter().map(|p| p.y).fold(0.0, f64::max);
    assert!(top > 0.8, "{top}");
}

/// Elastic on the very edge, over the mouth of a dart, draws the rim in; laid flat the rim has its drawn shape again.
#[test]
fn elastic_on_an_edge_draws_the_rim_in() {
    let skirt = draped("elastic_edge.yaml", 15.0);
    let names: Vec<&str> = skirt.job.mesh.pieces[0].lines.iter().map(|l| l.name.as_str()).collect();
    assert_eq!(names, ["tape.1", "tape.2"]);
    let waist = skirt.report.worn.iter().find(|w| w.opening == "waist").expect("a waist");
    // Two waists of 520 mm less 18 mm of dart each; slack at 0.7 of it, and hips of 980 mm below.
    assert!(waist.body_part.as_deref() == Some("torso") && (0.69 * 1004.0..0.95 * 980.0).contains(&waist.length));
    assert_eq!(waist.edges.len(), 2, "{:?}", waist.edges);
    for piece in &skirt.report.pieces {
        let (area, boundary) = (piece.area_error, piece.boundary_error);
        assert!([area.sew, area.drape, area.round_trip].into_iter().all(|e| e.is_some_and(|e| e < 2e-3)), "{area:?}");
        assert!([boundary.drape, boundary.round_trip].into_iter().all(|e| e.is_some_and(|e| e < 3e-3)), "{boundary:?}");
        assert!(piece.outline_distance.is_some_and(|mm| mm < 1.0), "{:?}", piece.outline_distance);
        assert!(piece.strain.p99 < 0.01, "{:?}", piece.strain);
    }
}

#[test]
fn pleats_hang_with_their_top_layer_outside() {
    let skirt = draped("pleated.yaml", 15.0);
    // The knife pleat at 100 mm from the waist's start (x = −260), 15 mm deep: 40 mm below the waist the panel it is
    // folded from lies over its middle layer.
    let near = |x: f64| skirt.particles("front", |px, py| (px - x).abs() < 8.0 && (30.0..55.0).contains(&py));
    let mean = |of: &[usize]| of.iter().map(|&p| skirt.outward(p)).sum::<f64>() / of.len() as f64;
    let (panel, bottom) = (near(-167.0), near(-137.0));
    assert!(!panel.is_empty() && !bottom.is_empty());
    assert!(mean(&panel) > mean(&bottom), "{} {}", mean(&panel), mean(&bottom));
    let waist = skirt.report.worn.iter().find(|w| w.edges.iter().any(|e| e.contains("waist"))).expect("a waist");
    // Six folds of 15 mm (one knife, one box; front and back) take up 30 mm each.
    assert_relative_eq!(waist.length, 2.0 * 520.0 - 2.0 * 4.0 * 30.0, max_relative = 0.01);
}

/// Folds that meet edge to edge behind a box pleat, with particles on them, neither start in one place nor blow up.
#[test]
fn folds_that_meet_behind_a_box_pleat_hang_still() {
    let skirt = draped("box_pleat.yaml", 20.0);
    let drape = skirt.report.stages.iter().find(|s| s.name == "drape").expect("a drape");
    assert!(drape.converged && drape.residual.is_some_and(|r| r < 1.0), "{:?}", drape.residual);
    for piece in &skirt.report.pieces {
        assert!(piece.area_error.drape.is_some_and(|e| e < 5e-3) && piece.strain.p99 < 0.02, "{:?}", piece.strain);
    }
}

/// A drape that has not come to rest, and holds more energy than the sewn garment, ends with an error that names the
/// piece, and with no shape.
#[test]
fn a_drape_that_drives_cloth_apart_is_an_error() {
    let file = Path::new("tests/data/box_pleat.yaml");
    let overrides = Overrides { spacing: Some(0.02), ..Overrides::default() };
    let job = Job::new(file, read(file).expect("a garment"), &overrides).map_err(|e| e.to_string()).expect("a job");
    let mut run = Run::new(&job);
    run.sew(&mut |_, _| {}).map_err(|e| e.to_string()).expect("sewn");
    let back = job.mesh.pieces.iter().find(|p| p.name == "back").expect("a back").particles.clone();
    let stitching = Stitching::new(&job.mesh);
    let sewn = stitching.welded(run.last().expect("sewn"));
    let (cut, body) = (job.cut(), &job.collider);
    let options = DrapeOptions { max_steps: 40, ..DrapeOptions::default() };
    let mut draped = drape(&cut, body, &stitching, sewn.clone(), &options, &mut |_| {}).expect("steps");
    assert!(!draped.converged, "only what has not come to rest is asked");
    check_fall(&cut, body, &stitching, sewn.clone(), &draped).expect("forty steps down");
    // Pulled to twice its size, as by forces that drive it apart.
    let mut at = stitching.spread(&draped.nodes);
    let middle = back.clone().map(|p| at[p]).sum::<Vec3>() / back.len() as f64;
    back.for_each(|p| at[p] = middle + (at[p] - middle) * 2.0);
    draped.nodes = stitching.welded(&at);
    let why = check_fall(&cut, body, &stitching, sewn, &draped).expect_err("no shape");
    assert!(matches!(&why, DrapeError::Diverged { piece, from, to, .. } if piece == "back" && to > from), "{why}");
}

/// How much further from the body's axis the particles of `outer` are than those of `inner` beside them, metres on
/// average; of those on the way down from a waist to the hem.
fn further_out(skirt: &Draped, outer: &str, inner: &str) -> f64 {
    let hem = |p: &usize| skirt.x[*p].y > 0.75;
    let near =
        |piece: &str| -> Vec<usize> { skirt.particles(piece, |_, y| y > 60.0).into_iter().filter(hem).collect() };
    let (outer, inner) = (near(outer), near(inner));
    let (mut sum, mut count) = (0.0, 0.0);
    for &p in &inner {
        let beside = |q: &&usize| {
            let (a, b) = (skirt.x[p], skirt.x[**q]);
            (a.y - b.y).abs() < 0.012 && (a.x.atan2(a.z) - b.x.atan2(b.z)).abs() < 0.06
        };
        for &q in outer.iter().filter(beside) {
            sum += skirt.outward(q) - skirt.outward(p);
            count += 1.0;
        }
    }
    assert!(count > 50.0, "{count}");
    sum / count
}

#[test]
fn a_lining_hangs_inside() {
    let skirt = draped("lined.yaml", 20.0);
    for (shell, lining) in [("front", "front_lining"), ("back", "back_lining")] {
        // By a cloth's thickness or more.
        let off = further_out(&skirt, shell, lining);
        assert!(off > 2e-4, "{shell}: {off} m");
    }
    assert_eq!(skirt.report.worn.iter().filter(|w| w.body_part.as_deref() == Some("legs")).count(), 2);
}

/// How far outside piece `over` the particles of `piece` at `x` are, metres, each from the triangle nearest to it;
/// without those within `rim` of where the two are one.
fn outside(mesh: &ClothMesh, x: &[Vec3], piece: &str, over: &str, rim: f64) -> Vec<f64> {
    let piece_of = |name: &str| mesh.pieces.iter().find(|p| p.name == name).expect("a piece");
    let (piece, over) = (piece_of(piece), piece_of(over));
    let triangles: Vec<[Vec3; 3]> =
        mesh.triangles[over.triangles.clone()].iter().map(|t| t.map(|p| x[p as usize])).collect();
    let signed = |p: Vec3| {
        let from = |[a, b, c]: [Vec3; 3]| {
            let [k, l, m] = closest_on_triangle(p, a, b, c);
            let away = p - (a * k + b * l + c * m);
            (away.norm(), (c - a).cross(&(b - a)).dot(&away).signum() * away.norm())
        };
        triangles.iter().map(|t| from(*t)).min_by(|a, b| a.0.total_cmp(&b.0)).expect("a triangle").1
    };
    let joined: Vec<Vec3> =
        piece.particles.clone().map(|p| x[p]).filter(|p| over.particles.clone().any(|q| x[q] == *p)).collect();
    let far = |p: &Vec3| joined.iter().all(|j| (j - p).norm() > rim);
    piece.particles.clone().map(|p| x[p]).filter(far).map(signed).collect()
}

#[test]
fn a_facing_over_the_shoulders_hangs_on_its_side_of_the_shell() {
    let top = draped("faced_top.yaml", 15.0);
    for (facing, shell) in [("front_facing", "front"), ("back_facing", "back")] {
        let off = outside(&top.job.mesh, &top.x, facing, shell, 0.01);
        assert!(off.len() > 40, "{}", off.len());
        let wrong = off.iter().filter(|d| **d > 0.0).count();
        assert_eq!(wrong, 0, "{facing}: {wrong} of {} outside the shell", off.len());
    }
}

/// Sewn to the facing alone, a lining goes on from it over the shell, and hangs inside it.
#[test]
fn a_lining_goes_on_from_its_facing() {
    let top = draped("lined_top.yaml", 18.0);
    let job = &top.job;
    let start = toile::sew::start::start(&job.garment, &job.mesh, &job.body, &job.collider).expect("a start");
    for (lining, shell) in [("front_lining", "front"), ("back_lining", "back")] {
        let off = outside(&job.mesh, &start, lining, shell, 0.0);
        assert!(off.iter().all(|d| (-0.008..-0.001).contains(d)), "{lining} starts {off:?}");
        let off = outside(&job.mesh, &top.x, lining, shell, 0.01);
        let wrong = off.iter().filter(|d| **d > 0.0).count();
        assert!(off.len() > 100 && wrong == 0, "{lining}: {wrong} of {} outside the shell", off.len());
    }
}

/// What is gathered onto a waistband beside the shell counts once in the band's ring; the band's ends overlap.
#[test]
fn an_overlay_gathered_onto_the_same_waistband_hangs_over_the_skirt() {
    let skirt = draped("overlay.yaml", 20.0);
    for shell in ["front", "back"] {
        let off = further_out(&skirt, "overlay", shell);
        assert!(off > 1e-3, "{shell}: {off} m");
    }
}

/// The lining is a tenth wider than its shell and hangs in folds: it crosses itself and the shell when it is stitched.
#[test]
fn a_gathered_lining_is_led_out_of_its_tangles() {
    let top = draped("gathered_lining.yaml", 25.0);
    assert!(top.report.worn.iter().any(|w| w.body_part.as_deref() == Some("torso")), "{:?}", top.report.worn);
}

#[test]
fn a_facing_starts_on_what_it_faces_and_a_yoke_of_another_layer_beside_it() {
    let file = Path::new("tests/data/faced_top.yaml");
    let job = Job::new(file, read(file).expect("a garment"), &Overrides::default()).map_err(|e| e.to_string());
    let job = job.expect("a job");
    let start = toile::sew::start::start(&job.garment, &job.mesh, &job.body, &job.collider).expect("a start");
    for (facing, shell) in [("front_facing", "front"), ("back_facing", "back")] {
        let off = outside(&job.mesh, &start, facing, shell, 0.0);
        assert!(off.iter().all(|d| (-0.008..-0.001).contains(d)), "{facing}: {off:?}");
    }
    // Less than a layer deep, which sewing pushes out.
    let deepest = start.iter().filter_map(|p| job.collider.nearest(*p, 0.1)).map(|near| near.distance);
    assert!(deepest.fold(0.0, f64::min) > -0.004, "in the body");
    // A cape reaches far beyond the top, round the arms: it has a ring of its own.
    let text = std::fs::read_to_string(file).expect("a file").replace("layer: -1", "layer: 1");
    let text = text.replace(
        "shoulder: L 14 2.105, outer: \"C 13 9, 9 16, 0 16\"",
        "shoulder: L 18.5 4, wide: L 34 20, outer: L 0 36",
    );
    let text = text.replace(
        "shoulder: L 14 2.105, outer: \"C 12 8, 8 9, 0 9\"",
        "shoulder: L 18.5 4, wide: L 34 20, outer: L 0 32",
    );
    let text = text.replace("\"*.outer\"", "\"*.outer\", \"*.wide\"");
    let cape = toile::io::garment::read_text("cape", "cape.yaml", &text).map_err(|e| e.to_string()).expect("a garment");
    let mesh = toile::mesh::build(&cape.garment, 0.015).expect("a mesh");
    let start = toile::sew::start::start(&cape.garment, &mesh, &job.body, &job.collider).expect("a start");
    assert_eq!(text.matches("wide").count(), 3, "the facings have become a cape");
    let off = outside(&mesh, &start, "front_facing", "front", 0.0);
    let flat_on_it = off.iter().filter(|d| (0.0035..0.0045).contains(*d)).count();
    assert!(flat_on_it < off.len() / 4, "{flat_on_it} of {} particles of a cape start flat on the top", off.len());
    // A flounce goes on from the hem, whatever its layer.
    let panel = |width: i32| {
        format!(
            "outline: {{start: -{width} 0, top: L {width} 0, right: L 290 300, hem: L -290 300, left: L -{width} 0}}"
        )
    };
    let text = format!(
        "garment: 1\nbody: woman_92\nfabrics: {{shell: cotton_poplin}}\npieces:\n  front: {{place: hip front, {}}}\n  \
         back: {{like: front, place: hip back}}\n  flounce: {{place: hip front, layer: -1, {}}}\n\
         seams:\n  left: {{sew: front.right, to: back.left}}\n  right: {{sew: front.left, to: back.right}}\n  \
         flounce: {{sew: flounce.top, to: front.hem}}\nfree: ['*.top', '*.hem', 'flounce.*']\n",
        panel(200),
        panel(290)
    );
    let garment = toile::io::garment::read_text("skirt", "skirt.yaml", &text).map_err(|e| e.to_string());
    let garment = garment.expect("a garment").garment;
    let mesh = toile::mesh::build(&garment, 0.015).expect("a mesh");
    let start = toile::sew::start::start(&garment, &mesh, &job.body, &job.collider).expect("a start");
    let lowest = |name: &str| {
        let piece = mesh.pieces.iter().find(|p| p.name == name).expect("a piece");
        piece.particles.clone().map(|p| start[p].y).fold(f64::INFINITY, f64::min)
    };
    assert!(lowest("flounce") < lowest("front") - 0.2, "{} {}", lowest("flounce"), lowest("front"));
}

#[test]
fn a_fold_comes_to_rest_at_the_angle_it_was_pressed_to() {
    let text = "garment: 1\nbody: woman_92\nfabrics: {shell: cotton_poplin}\npieces:\n  card:\n    \
                place: {at: [0, 1000, 1000]}\n    grain: [[10, 10], [10, 90]]\n    \
                outline: {start: 0 0, a: L 120 0, b: L 120 120, c: L 0 120, d: L 0 0}\n    \
                lines: {crease: {path: M 60 0 L 60 120, fold: ANGLE}}\nfree: ['*.*']\n";
    for angle in [60.0, -90.0] {
        let text = text.replace("ANGLE", &angle.to_string());
        let garment = toile::io::garment::read_text("card", "card.yaml", &text).map_err(|e| e.to_string());
        let garment = garment.expect("a garment").garment;
        let mesh = toile::mesh::build(&garment, 0.015).expect("a mesh");
        let fabrics: Vec<Arc<Fabric>> = vec![Arc::new(fabric::load("cotton_poplin").expect("shipped"))];
        let body = toile::mannequin::load("woman_92").expect("shipped");
        let collider = Collider::new(&body.mesh).expect("closed");
        let stitching = Stitching::new(&mesh);
        // Almost flat, so that the fold need not choose a side.
        let nodes = mesh.flat.iter().map(|p| Vec3::new(p.x, -p.y, 3.0)).collect();
        let cut = Cut { garment: &garment, mesh: &mesh, fabrics: &fabrics };
        let mut world = sewn_world(&cut, &collider, &stitching, nodes).expect("a world");
        for _ in 0..200 {
            world.newton(1.0, 5e-3).expect("a step");
        }
        let normal = |left: bool| {
            let side = |t: &&[u32; 3]| (t.iter().map(|&p| mesh.flat[p as usize].x).sum::<f64>() < 0.18) == left;
            mesh.triangles.iter().filter(side).fold(Vec3::zeros(), |sum, t| {
                let [a, b, c] = t.map(|p| world.x()[p as usize]);
                sum + (c - a).cross(&(b - a))
            })
        };
        let (left, right) = (normal(true), normal(false));
        assert!(left.z + right.z > 0.0, "the right side faces where it was drawn from");
        let turned = left.angle(&right).to_degrees();
        assert!((turned - f64::abs(angle)).abs() < 1.0, "{turned}");
        // Positive: the wrong sides (away from the normals) turn towards each other, the crease stands out.
        let middle = |edge: f64| {
            let on: Vec<usize> = (0..mesh.flat.len()).filter(|&p| (mesh.flat[p].x - edge).abs() < 1e-6).collect();
            on.iter().map(|&p| world.x()[p]).sum::<Vec3>() / on.len() as f64
        };
        let proud = (middle(0.06) - 0.5 * (middle(0.0) + middle(0.12))).dot(&(left + right));
        assert!(proud * angle > 0.0, "{proud}");
    }
}

/// A stand that is sewn at both rims started on a ring for both lengths together, and the collar turned down inside it.
#[test]
fn a_collar_turns_down_outside_its_stand() {
    let shirt = draped("collar.yaml", 15.0);
    let stand = shirt.particles("stand", |_, _| true);
    let [edge, crease] = [0.0, 50.0].map(|at| shirt.particles("collar", |_, y| (y - at).abs() < 1.0));
    let middle = |these: &[usize]| these.iter().map(|&p| shirt.x[p]).sum::<Vec3>() / these.len() as f64;
    let axis = middle(&stand);
    let out =
        |these: &[usize]| these.iter().map(|&p| (shirt.x[p] - axis).xz().norm()).sum::<f64>() / these.len() as f64;
    let fall = middle(&crease).y - middle(&edge).y;
    assert!(fall > 0.02, "its edge hangs {} mm below its crease", 1e3 * fall);
    let outside = out(&edge) - out(&stand);
    assert!(outside > 0.0, "its edge is {} mm out of the stand", 1e3 * outside);
}
