//! Contact and friction against known answers: what a search that remembers finds, sliding down a plane, the strap over
//! a cylinder, a sheet over a corner, a tube wrung out, and part of a sheet in motion.

use std::f64::consts::PI;
use std::path::Path;

use toile::contact::{Collider, Neighbourhood, swept_point_triangle};
use toile::dynamics::explicit::law_of;
use toile::dynamics::{ContactLaw, Forces, Hardening, Reach, World};
use toile::fabric::GRAVITY;
use toile::geometry::{TriMesh, Vec3};
use toile::pipeline::{Job, Overrides, read};
use toile::sew::Stitching;
use toile::verify::crossings;

/// Contact as a drape has it.
const LAW: ContactLaw =
    ContactLaw { stiffness: 60.0, hardening: Hardening::Slow, body_clearance: 0.25e-3, cloth_gap: None };
/// A grip that holds a node of 1 mN within a hundredth of a millimetre.
const GRIP: f64 = 100.0;

/// A sheet of `width` × `length` mm of poplin with friction `mu`, meshed at `spacing` mm;
/// the body is only there to be replaced.
fn sheet(width: f64, length: f64, spacing: f64, mu: f64) -> Job {
    garment(&format!("{}free: [sheet.*]\n", rectangle(width, length)), spacing, mu)
}

/// A piece of `width` × `length` mm, its edges `a` to `d` from above on clockwise.
fn rectangle(width: f64, length: f64) -> String {
    format!(
        "  sheet: {{grain: [[0, 0], [0, 1]], place: {{at: [0, 0, 0]}}, outline: {{start: 0 0, a: L {width} 0, \
         b: L {width} {length}, c: L 0 {length}, d: L 0 0}}}}\n"
    )
}

fn garment(pieces: &str, spacing: f64, mu: f64) -> Job {
    let folder = tempfile::tempdir().expect("a folder");
    let fabrics = format!("{{cloth: {{base: cotton_poplin, friction: {mu}}}}}");
    let text = format!("garment: 1\nname: sheet\nbody: child_110\nfabrics: {fabrics}\npieces:\n{pieces}");
    let file = folder.path().join("sheet.yaml");
    std::fs::write(&file, text).expect("written");
    let loaded = read(&file).expect("a garment");
    Job::new(Path::new(&file), loaded, &Overrides { spacing: Some(1e-3 * spacing), ..Overrides::default() })
        .expect("a job")
}

fn world<'a>(job: &Job, body: &'a Collider, x: Vec<Vec3>) -> World<'a> {
    let stitching = Stitching::new(&job.mesh);
    let cloth = toile::dynamics::Cloth::new(&job.cut(), stitching.class, toile::dynamics::SpringModel::Measured);
    let hood = Neighbourhood { class: (0..x.len() as u32).collect(), passing: Vec::new() };
    World::new(cloth, x, &[], body, hood, LAW, Reach::new(0.8 * job.mesh.spacing)).expect("a world")
}

/// A block of eight corners: the lowest bit of a corner's number says on which side in x it lies, then y, then z.
fn block(corner: impl Fn(usize) -> Vec3) -> Collider {
    Collider::new(&block_mesh(corner)).expect("a block")
}

fn block_mesh(corner: impl Fn(usize) -> Vec3) -> TriMesh {
    let vertices = (0..8).map(corner).collect();
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = quads.iter().flat_map(|q: &[u32; 4]| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect();
    TriMesh { vertices, triangles }
}

/// A block between `side[0]` and `side[1]` in x, y and z, one of which is 0,
/// turned until its corner at the origin points up.
fn corner_up(side: [f64; 2]) -> Collider {
    let up = -Vec3::repeat(side[0] + side[1]);
    let turn = nalgebra::Rotation3::rotation_between(&up, &Vec3::y()).expect("a turn");
    block(|i| turn * Vec3::new(side[i & 1], side[i >> 1 & 1], side[i >> 2 & 1]))
}

/// A slab 4 m long whose top is the plane through the origin that rises at `angle` along x.
fn slope(angle: f64) -> Collider {
    let turn = nalgebra::Rotation3::from_axis_angle(&nalgebra::Vector3::z_axis(), angle);
    let corner = |i: usize| Vec3::new([-2.0, 2.0][i & 1], [-0.1, 0.0][i >> 1 & 1], [-1.0, 1.0][i >> 2 & 1]);
    block(|i| turn * corner(i))
}

/// How far down the slope the middle of a sheet is after each of `steps` steps of `dt` seconds,
/// from when it lies still.
fn slide(mu: f64, angle: f64, dt: f64, steps: usize) -> Vec<f64> {
    let job = sheet(120.0, 120.0, 20.0, mu);
    let body = slope(angle);
    let (along, up) = (Vec3::new(angle.cos(), angle.sin(), 0.0), Vec3::new(-angle.sin(), angle.cos(), 0.0));
    // The distance at which it floats: half its thickness and the clearance; the weight presses it in from there.
    let height = 0.5 * job.fabrics[0].thickness + LAW.body_clearance;
    let x = job.mesh.flat.iter().map(|p| along * (1.5 - p.x) + Vec3::z() * p.y + up * height).collect();
    let mut world = world(&job, &body, x);
    world.gravity = 1.0;
    world.grip(GRIP);
    let middle = |w: &World| w.x().iter().map(|p| -p.dot(&along)).sum::<f64>() / w.x().len() as f64;
    let begin = middle(&world);
    (0..steps)
        .map(|_| {
            world.advance(dt, 1.0, &[]).expect("a step");
            middle(&world) - begin
        })
        .collect()
}

#[test]
fn a_sheet_on_a_slope_slides_if_and_only_if_the_slope_is_steeper_than_its_friction() {
    for mu in [0.3, 0.5] {
        let angle = f64::atan(mu);
        let end = |angle: f64| slide(mu, angle, 1.0 / 100.0, 100).pop().expect("steps");
        let (below, above) = (end(angle - 1f64.to_radians()), end(angle + 1f64.to_radians()));
        assert!(below < 1e-3, "μ {mu}: slides {below} m below the threshold");
        // g (sin α − μ cos α) t² / 2 is 79 mm for μ = 0.3 and 72 mm for 0.5.
        assert!(above > 0.05, "μ {mu}: goes only {above} m above the threshold");
    }
}

#[test]
fn a_sliding_sheet_gains_speed_as_coulomb_says() {
    for (mu, degrees) in [(0.3, 25.0), (0.5, 35.0), (0.2, 15.0)] {
        let angle = f64::to_radians(degrees);
        let (dt, steps) = (1e-3, 400);
        let way = slide(mu, angle, dt, steps);
        let speed = |k: usize| (way[k] - way[k - 1]) / dt;
        let measured = (speed(steps - 1) - speed(steps / 3)) / (dt * (steps - 1 - steps / 3) as f64);
        let expected = GRAVITY * (angle.sin() - mu * angle.cos());
        assert!((measured / expected - 1.0).abs() < 0.05, "μ {mu}, {degrees}°: {measured} against {expected} m/s²");
    }
}

/// A cylinder along z, `radius` metres, its axis through the origin.
fn cylinder(radius: f64) -> Collider {
    let round = 128u32;
    let ring = |z: f64| (0..round).map(move |k| (2.0 * PI * f64::from(k) / f64::from(round), z));
    let mut vertices: Vec<Vec3> =
        ring(-0.2).chain(ring(0.2)).map(|(a, z)| Vec3::new(radius * a.cos(), radius * a.sin(), z)).collect();
    let ends = vertices.len() as u32;
    vertices.extend([Vec3::z() * -0.2, Vec3::z() * 0.2]);
    let mut triangles = Vec::new();
    for k in 0..round {
        let (a, b) = (k, (k + 1) % round);
        triangles.extend([
            [a, b, b + round],
            [a, b + round, a + round],
            [ends, b, a],
            [ends + 1, a + round, b + round],
        ]);
    }
    Collider::new(&TriMesh { vertices, triangles }).expect("a cylinder")
}

/// Tension ratio of a strap that is drawn over a cylinder by `turn` radians and held at its other end. It stretches
/// and so slides everywhere towards the end that is drawn.
fn capstan(mu: f64, turn: f64) -> f64 {
    let (radius, width) = (0.05, 0.02);
    let arc = radius * turn;
    let tail = 0.06;
    let length = arc + 2.0 * tail;
    let job = sheet(1e3 * width, 1e3 * length, 5.0, mu);
    let body = cylinder(radius);
    let r = radius + 0.5 * job.fabrics[0].thickness + 0.5 * LAW.body_clearance;
    // The strap's first end hangs straight down from the cylinder's side at angle 0, its other leaves at `turn`.
    let x: Vec<Vec3> = job
        .mesh
        .flat
        .iter()
        .map(|p| {
            let (s, z) = (p.y - tail, p.x - 0.5 * width);
            let a = (s / radius).clamp(0.0, turn);
            let beyond = s - radius * a;
            Vec3::new(r * a.cos() - beyond * a.sin(), r * a.sin() + beyond * a.cos(), z)
        })
        .collect();
    let direction = Vec3::new(-turn.sin(), turn.cos(), 0.0);
    let mut world = world(&job, &body, x);
    let ends = |at: f64| -> Vec<usize> {
        (0..job.mesh.flat.len()).filter(|&i| (job.mesh.flat[i].y - at).abs() < 1e-6).collect()
    };
    let (held, drawn) = (ends(0.0), ends(length));
    // Nothing but the test moves the ends, and nothing weighs.
    for &i in held.iter().chain(&drawn) {
        world.cloth.mass[i] = 1e9;
    }
    world.grip(GRIP);
    for _ in 0..120 {
        world.shift(&drawn, direction * 5e-5).expect("a search");
        world.newton(1.0, 1e-3).expect("a step");
    }
    pull(&world, &drawn).norm() / pull(&world, &held).norm()
}

/// Force of the cloth on some of its nodes, N.
fn pull(world: &World, nodes: &[usize]) -> Vec3 {
    let nothing = Forces { gravity: 0.0, contacts: &[], law: LAW, pulls: &[], friction: None };
    let forces = law_of(&world.cloth, nothing)(world.x());
    nodes.iter().map(|&n| forces[n]).sum()
}

#[test]
fn a_strap_over_a_cylinder_holds_e_to_the_mu_theta() {
    for mu in [0.3, 0.5] {
        for turn in [0.5 * PI, PI] {
            let (measured, expected) = (capstan(mu, turn), f64::exp(mu * turn));
            assert!((measured / expected - 1.0).abs() < 0.05, "μ {mu}, {turn:.2} rad: {measured} against {expected}");
        }
    }
}

#[test]
fn a_search_that_remembers_finds_what_a_new_one_finds() {
    let (radius, width) = (0.05, 0.06);
    let job = sheet(1e3 * width, 1e3 * width, 6.0, 0.3);
    let body = cylinder(radius);
    let r = radius + 0.5 * job.fabrics[0].thickness + 0.5 * LAW.body_clearance;
    let lie = |p: &toile::geometry::Vec2| {
        let a = (p.y - 0.5 * width) / r;
        Vec3::new(r * a.sin(), r * a.cos(), p.x - 0.5 * width)
    };
    let mut known = world(&job, &body, job.mesh.flat.iter().map(lie).collect());
    for round in 1..=30 {
        // Some nodes go far enough for what was found at them to be searched again, most do not;
        // none gets into the body.
        let mut to = known.x().to_vec();
        for (i, x) in to.iter_mut().enumerate() {
            let k = (i * 37 + round * 101) as f64;
            let out = Vec3::new(x.x, x.y, 0.0).normalize();
            let far = if (i + round) % 9 == 0 { 4e-4 } else { 5e-5 };
            *x += (Vec3::z() * k.sin() + out.cross(&Vec3::z()) * k.cos()) * far;
            let out = Vec3::new(x.x, x.y, 0.0).normalize();
            *x = out * (r + 1e-4 * (3.0 * k).sin()) + Vec3::z() * x.z;
        }
        known.displace(to).expect("contacts");
        // Shares of contacts follow by halves.
        for _ in 0..50 {
            known.detect().expect("contacts");
        }
        let new = world(&job, &body, known.x().to_vec());
        let (found, expected) = (known.energy(), new.energy());
        assert!((found / expected - 1.0).abs() < 1e-9, "round {round}: {found} J against {expected} J");
    }
}

#[test]
fn a_search_that_remembers_misses_nothing_round_a_corner() {
    // Its first and its last corner, whose faces are cut otherwise, and a sheet that lies across them and their edges.
    let job = sheet(18.0, 18.0, 6.0, 0.3);
    let bodies = [[0.0, 0.05], [-0.05, 0.0]].map(corner_up);
    for trial in 0..400 {
        let body = &bodies[trial % 2];
        // Something between -1 and 1.
        let number = |k: usize| (43_758.5 * (12.9898 * trial as f64 + 78.233 * k as f64).sin()).fract();
        // Less steep than the block's edges, 35°.
        let lean = nalgebra::Rotation3::from_euler_angles(0.4 * number(1), 3.0 * number(2), 0.4 * number(3));
        let lift = 0.5 * job.fabrics[0].thickness + LAW.body_clearance * 0.5;
        let middle = Vec3::new(9e-3 + 4e-3 * number(4), -lift, 9e-3 + 4e-3 * number(5));
        let lie = |p: &toile::geometry::Vec2| lean * (Vec3::new(p.x, 0.0, p.y) - middle);
        let mut known = world(&job, body, job.mesh.flat.iter().map(lie).collect());
        let (sine, cosine) = (3.0 * number(6)).sin_cos();
        let way = lean * (Vec3::new(sine, 0.3 * number(7), cosine) * 3e-4);
        known.displace(known.x().iter().map(|x| x + way).collect()).expect("contacts");
        for _ in 0..50 {
            known.detect().expect("contacts");
        }
        let new = world(&job, body, known.x().to_vec());
        let (found, expected) = (known.energy(), new.energy());
        assert!(found >= expected * (1.0 - 1e-9) - 1e-15, "trial {trial}: {found:e} J, less than {expected:e} J");
    }
}

/// A sheet whose rim is drawn down over a corner of the body by 8 mm, and so many steps more, trusted as in a drape.
/// Returns what the rim pulls with, and the largest force out of balance before every one of these steps, N.
fn drawn_over_a_corner(harden: bool, steps: usize) -> (f64, Vec<f64>) {
    let size = 42.0;
    let job = sheet(size, size, 6.0, 0.0);
    let body = corner_up([-0.05, 0.0]);
    let lift = 0.5 * job.fabrics[0].thickness + LAW.body_clearance;
    let middle = 0.5e-3 * size + 1e-3;
    let x = job.mesh.flat.iter().map(|p| Vec3::new(p.x - middle, lift, p.y - middle)).collect();
    let mut world = world(&job, &body, x);
    if harden {
        world.harden();
    }
    let is_rim = |p: &toile::geometry::Vec2| p.iter().any(|c| c.min(1e-3 * size - c) < 1e-6);
    let rim: Vec<usize> = (0..world.x().len()).filter(|&i| is_rim(&job.mesh.flat[i])).collect();
    for &i in &rim {
        world.cloth.mass[i] = 1e9;
    }
    for _ in 0..200 {
        world.shift(&rim, Vec3::y() * -4e-5).expect("a search");
        world.newton(1.0, 1e-3).expect("a step");
    }
    let mut left = Vec::new();
    let mut trust = 1e-3;
    for _ in 0..=steps {
        let forces = world.unbalanced();
        left.push((0..forces.len()).filter(|i| !rim.contains(i)).map(|i| forces[i].norm()).fold(0.0, f64::max));
        trust = world.newton(1.0, trust).expect("a step").trust(trust).clamp(6e-5, 1.2e-3);
    }
    let forces = world.unbalanced();
    (rim.iter().map(|&i| forces[i].y).sum(), left)
}

#[test]
fn a_sheet_drawn_hard_over_a_corner_comes_to_rest() {
    // Nothing else carries what the drawn rim pulls: all of it goes through the few contacts at the corner.
    let [(pulled, swings), (hardened, left)] = [false, true].map(|harden| drawn_over_a_corner(harden, 100));
    assert!(pulled > 30.0 && hardened > 30.0, "the rim pulls with {pulled} and {hardened} N only");
    assert!(swings[100] < 1e-3 * pulled, "{} N of {pulled} N are out of balance", swings[100]);
    // Soft contacts go from one side of the corner to the other for ever, with up to 30 mN.
    let most = left[30..].iter().copied().fold(0.0, f64::max);
    assert!(most < 1e-3, "{most} N are out of balance after 30 steps");
}

#[test]
fn a_tube_twisted_twice_round_does_not_pass_through_itself() {
    let (radius, length) = (0.04, 0.3);
    let tube = rectangle(2e3 * PI * radius, 1e3 * length);
    let job =
        garment(&format!("{tube}seams:\n  side: {{sew: sheet.b, to: sheet.d}}\nfree: [sheet.a, sheet.c]\n"), 12.5, 0.3);
    let stitching = Stitching::new(&job.mesh);
    let round: Vec<Vec3> = job
        .mesh
        .flat
        .iter()
        .map(|p| {
            let (sine, cosine) = (p.x / radius).sin_cos();
            Vec3::new(radius * cosine, -p.y, radius * sine)
        })
        .collect();
    // The body lies far below.
    let body = slope(0.0);
    let x: Vec<Vec3> = stitching.welded(&round).iter().map(|p| p + Vec3::y() * 2.0).collect();
    let mut world = world(&job, &body, x.clone());
    let rim = |at: f64| -> Vec<usize> { (0..x.len()).filter(|&i| (x[i].y - at).abs() < 1e-6).collect() };
    let (top, bottom) = (rim(2.0), rim(2.0 - length));
    for &i in top.iter().chain(&bottom) {
        world.cloth.mass[i] = 1e9;
    }
    let triangles: Vec<[u32; 3]> = job.mesh.triangles.iter().map(|t| t.map(|p| stitching.class[p as usize])).collect();
    let (steps, dt, keep) = (600, 0.02, 0.8);
    for step in 1..=steps {
        // Nodes as heavy as these go where their velocity takes them.
        let turn = nalgebra::Rotation3::from_axis_angle(&nalgebra::Vector3::y_axis(), 4.0 * PI / f64::from(steps));
        for &i in &top {
            let way = turn * world.x()[i] - Vec3::y() * (0.3 * length / f64::from(steps)) - world.x()[i];
            world.velocity[i] = way / (dt * keep);
        }
        world.advance(dt, keep, &[]).expect("a step");
        if step % 40 == 0 {
            let cloth = TriMesh { vertices: world.x().to_vec(), triangles: triangles.clone() };
            assert!(crossings(&cloth).is_empty(), "after {} turns", 2.0 * f64::from(step) / f64::from(steps));
        }
    }
    let neck = world.x().iter().map(|p| p.x.hypot(p.z)).fold(f64::INFINITY, f64::min);
    assert!(neck < 3e-3, "it is wrung to a string, not {neck} m wide");
}

/// The interference test of the paper on every step of a sheet that is thrown at a block, some 30 mm in a step, to a
/// thickness of 20 mm: no particle goes through a side of it, though it would at once if nothing held it back.
#[test]
fn no_particle_passes_through_a_side_within_a_step() {
    let job = sheet(160.0, 160.0, 20.0, 0.3);
    let corner = |i: usize| Vec3::new([-0.05, 0.06][i & 1], [-0.02, 0.0][i >> 1 & 1], [-0.04, 0.05][i >> 2 & 1]);
    let mesh = block_mesh(corner);
    let sides: Vec<[Vec3; 3]> = (0..mesh.triangles.len()).map(|t| mesh.corners(t)).collect();
    let through = |from: &[Vec3], to: &[Vec3]| {
        let passes = |(a, b): (&Vec3, &Vec3)| sides.iter().any(|side| swept_point_triangle(*a, *b, *side).is_some());
        from.iter().zip(to).filter(|way| passes(*way)).count()
    };
    let body = block(corner);
    let (dt, speed) = (1e-3, Vec3::new(2.0, -30.0, 1.0));
    let lay = |p: &toile::geometry::Vec2| Vec3::new(p.x - 0.08, 0.015 + 0.1 * p.x, p.y - 0.08);
    let mut world = world(&job, &body, job.mesh.flat.iter().map(lay).collect());
    world.gravity = 1.0;
    world.velocity.fill(speed);
    let free: Vec<Vec3> = world.x().iter().map(|x| x + speed * dt).collect();
    assert!(through(world.x(), &free) > 5, "it is thrown at the block");
    for step in 0..40 {
        let from = world.x().to_vec();
        world.advance(dt, 1.0, &[]).expect("a step");
        assert_eq!(through(&from, world.x()), 0, "in step {step}");
    }
    let lowest = world.x().iter().map(|x| x.y).fold(f64::INFINITY, f64::min);
    assert!(lowest < -0.02, "its edges swing down past the block: {lowest} m");
}

/// A sheet on a cylinder that it slides down a little on, held by friction on one side, after so many steps.
fn sliding<'a>(job: &Job, body: &'a Collider, steps: usize) -> World<'a> {
    let height = 0.5 * job.fabrics[0].thickness + LAW.body_clearance;
    let lay = |p: &toile::geometry::Vec2| {
        let (angle, radius) = ((p.x - 0.05) / 0.1, 0.1 + height + 1e-4 * (40.0 * p.y).sin().abs());
        Vec3::new(radius * angle.sin(), radius * angle.cos(), p.y - 0.08)
    };
    let mut world = world(job, body, job.mesh.flat.iter().map(lay).collect());
    world.gravity = 1.0;
    world.grip(GRIP);
    for _ in 0..steps {
        world.newton(1.0, 2e-3).expect("a step");
    }
    world.detect().expect("a look");
    world
}

/// The largest difference of two lists of vectors, of those for which `counts` says so.
fn difference(a: &[Vec3], b: &[Vec3], counts: impl Fn(usize) -> bool) -> f64 {
    (0..a.len()).filter(|&i| counts(i)).map(|i| (a[i] - b[i]).norm()).fold(0.0, f64::max)
}

#[test]
fn what_moves_alone_feels_what_it_feels_with_the_rest_and_the_rest_stays() {
    let (job, body) = (sheet(160.0, 160.0, 10.0, 0.3), cylinder(0.1));
    let mut world = sliding(&job, &body, 6);
    let free: Vec<bool> = job.mesh.flat.iter().map(|p| p.x > 0.09 && p.y < 0.11).collect();
    let (before, forces, energy) = (world.x().to_vec(), world.unbalanced(), world.energy());
    let largest = forces.iter().map(|f| f.norm()).fold(0.0, f64::max);
    assert!(largest > 1e-6, "a sheet in balance would say nothing");
    let resting = world.hold_all_but(&free).expect("a part");
    assert!(difference(&world.unbalanced(), &forces, |i| free[i]) < 1e-9 * largest);
    let part_energy = world.energy();
    for _ in 0..4 {
        world.newton(1.0, 2e-3).expect("a step");
    }
    assert_eq!(difference(world.x(), &before, |i| !free[i]), 0.0);
    assert!(difference(world.x(), &before, |i| free[i]) > 1e-5, "nothing moves");
    let fallen = part_energy - world.energy();
    world.release(resting).expect("the whole");
    assert!(fallen > 0.0, "{fallen}");
    // Friction counts from where each look found its contacts: what it stored has become where they are.
    assert!((energy - world.energy() - fallen).abs() < 0.2 * fallen, "{} and not {fallen}", energy - world.energy());
}

#[test]
fn what_is_held_and_let_go_is_as_it_was() {
    let (job, body) = (sheet(160.0, 160.0, 10.0, 0.3), cylinder(0.1));
    let mut world = sliding(&job, &body, 6);
    let (forces, found) = (world.unbalanced(), world.contacts_found());
    let largest = forces.iter().map(|f| f.norm()).fold(0.0, f64::max);
    let half: Vec<bool> = job.mesh.flat.iter().map(|p| p.x > 0.07).collect();
    let quarter: Vec<bool> = job.mesh.flat.iter().map(|p| p.x > 0.07 && p.y > 0.05).collect();
    let outer = world.hold_all_but(&half).expect("a part");
    let inner = world.hold_all_but(&quarter).expect("a part of it");
    world.release(inner).expect("the part");
    assert!(difference(&world.unbalanced(), &forces, |i| half[i]) < 1e-9 * largest);
    world.release(outer).expect("the whole");
    assert_eq!(world.contacts_found(), found);
    assert!(difference(&world.unbalanced(), &forces, |_| true) < 1e-9 * largest);
}

#[test]
fn steps_of_a_part_that_is_all_are_those_of_the_whole() {
    let (job, body) = (sheet(160.0, 160.0, 10.0, 0.3), cylinder(0.1));
    let run = |part: bool| {
        let mut world = sliding(&job, &body, 6);
        let all = vec![true; world.x().len()];
        let resting = part.then(|| world.hold_all_but(&all).expect("a part"));
        for _ in 0..3 {
            world.newton(1.0, 2e-3).expect("a step");
        }
        resting.into_iter().for_each(|resting| world.release(resting).expect("the whole"));
        world.into_x()
    };
    let (whole, part) = (run(false), run(true));
    assert!(difference(&whole, &part, |_| true) < 1e-6, "{:e}", difference(&whole, &part, |_| true));
}
