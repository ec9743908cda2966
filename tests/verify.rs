//! The independent checks against brute force and cases known by hand.

use std::f64::consts::PI;
use std::time::Instant;

use toile::geometry::{TriMesh, Vec3, rim_loops};
use toile::mannequin::{BodyFrame, BodyPart, Mannequin, PartKind, Section};
use toile::verify::{Through, crossings, crossings_between, inside, past_end, worn};

/// Numbers in 0..1, the same every time (a linear congruential generator).
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn point(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next())
    }
}

/// A closed ball of about `2 n²` triangles.
fn ball(center: Vec3, radius: f64, n: u32) -> TriMesh {
    let mut mesh = TriMesh::default();
    let around = 2 * n;
    mesh.vertices.push(center + Vec3::y() * radius);
    for ring in 1..n {
        for k in 0..around {
            let (polar, turn) = (PI * f64::from(ring) / f64::from(n), 2.0 * PI * f64::from(k) / f64::from(around));
            let at = Vec3::new(polar.sin() * turn.sin(), polar.cos(), polar.sin() * turn.cos());
            mesh.vertices.push(center + radius * at);
        }
    }
    mesh.vertices.push(center - Vec3::y() * radius);
    let at = |ring: u32, k: u32| 1 + (ring - 1) * around + k % around;
    let last = mesh.vertices.len() as u32 - 1;
    for k in 0..around {
        mesh.triangles.push([0, at(1, k), at(1, k + 1)]);
        mesh.triangles.push([last, at(n - 1, k + 1), at(n - 1, k)]);
        for ring in 1..n - 1 {
            mesh.triangles.push([at(ring, k), at(ring + 1, k), at(ring + 1, k + 1)]);
            mesh.triangles.push([at(ring, k), at(ring + 1, k + 1), at(ring, k + 1)]);
        }
    }
    mesh
}

/// An open tube about a vertical axis.
fn tube(center: Vec3, radius: f64, height: f64, around: u32, rows: u32) -> TriMesh {
    let mut mesh = TriMesh::default();
    for row in 0..=rows {
        for k in 0..around {
            let turn = 2.0 * PI * f64::from(k) / f64::from(around);
            let up = height * (f64::from(row) / f64::from(rows) - 0.5);
            mesh.vertices.push(center + Vec3::new(radius * turn.sin(), up, radius * turn.cos()));
        }
    }
    for row in 0..rows {
        for k in 0..around {
            let (a, b) = (row * around + k, row * around + (k + 1) % around);
            mesh.triangles.push([a, b, b + around]);
            mesh.triangles.push([a, b + around, a + around]);
        }
    }
    mesh
}

fn soup(noise: &mut Noise, count: usize, size: f64) -> TriMesh {
    let mut mesh = TriMesh::default();
    for k in 0..count as u32 {
        let at = noise.point();
        mesh.vertices.extend((0..3).map(|_| at + size * noise.point()));
        mesh.triangles.push([3 * k, 3 * k + 1, 3 * k + 2]);
    }
    mesh
}

/// Segment through triangle by solving for the point: another method than the one tested.
fn pierces(p: Vec3, q: Vec3, [a, b, c]: [Vec3; 3]) -> bool {
    let m = nalgebra::Matrix3::from_columns(&[p - q, b - a, c - a]);
    let Some(x) = m.lu().solve(&(p - a)) else { return false };
    x[0] > 0.0 && x[0] < 1.0 && x[1] > 0.0 && x[2] > 0.0 && x[1] + x[2] < 1.0
}

fn cross(a: [Vec3; 3], b: [Vec3; 3]) -> bool {
    (0..3).any(|k| pierces(a[k], a[(k + 1) % 3], b) || pierces(b[k], b[(k + 1) % 3], a))
}

#[test]
fn two_triangles_that_cross_and_two_that_touch() {
    let mut mesh = TriMesh {
        vertices: vec![
            Vec3::new(0.0, 0.0, 0.0),
            Vec3::new(1.0, 0.0, 0.0),
            Vec3::new(0.0, 1.0, 0.0),
            Vec3::new(0.2, 0.2, -1.0),
            Vec3::new(0.3, 0.2, 1.0),
            Vec3::new(2.0, 2.0, 1.0),
        ],
        triangles: vec![[0, 1, 2], [3, 4, 5]],
    };
    assert_eq!(crossings(&mesh), [[0, 1]]);
    mesh.vertices[3] = Vec3::new(0.25, 0.25, 0.0);
    assert!(crossings(&mesh).is_empty(), "a corner that touches the face");
    mesh.vertices[3].z = -1e-12;
    assert_eq!(crossings(&mesh), [[0, 1]], "a picometre through");
    mesh.vertices[4] = Vec3::new(0.6, 0.1, 0.0);
    mesh.vertices[3].z = 0.0;
    mesh.vertices[5] = Vec3::new(2.0, 2.0, 0.0);
    assert!(crossings(&mesh).is_empty(), "overlapping in one plane");
    mesh.triangles[1] = [0, 4, 5];
    assert!(crossings(&mesh).is_empty(), "sharing a corner");
    mesh.vertices[4] = Vec3::new(0.2, 0.2, -1.0);
    mesh.vertices[5] = Vec3::new(0.3, 0.2, 1.0);
    assert_eq!(crossings(&mesh), [[0, 1]], "from a shared corner through the face");
    mesh.triangles[1] = [0, 1, 5];
    assert!(crossings(&mesh).is_empty(), "sharing a side");
}

#[test]
fn a_triangle_without_area_passes_through_another() {
    let face = [Vec3::zeros(), Vec3::x(), Vec3::y()];
    let (below, above) = (Vec3::new(0.2, 0.2, -0.5), Vec3::new(0.2, 0.2, 0.5));
    for [k, third] in [[0.2, 0.1], [0.2, 0.5], [0.2, -0.5], [0.8, 0.1]] {
        // All three in one line, or two of them in one place.
        let needle = [below, above, Vec3::new(0.2, 0.2, third)].map(|p| Vec3::new(k, p.y, p.z));
        for (a, b) in [(face, needle), (needle, face)] {
            let mesh = TriMesh { vertices: [a, b].concat(), triangles: vec![[0, 1, 2], [3, 4, 5]] };
            let expected = if k < 0.5 { 1 } else { 0 };
            assert_eq!(crossings(&mesh).len(), expected, "{k} {third}");
        }
    }
}

/// A grid of `n` × `n` cells from `at` along `u` and `v`.
fn sheet(at: [f64; 3], u: [f64; 3], v: [f64; 3], n: u32) -> TriMesh {
    let mut mesh = TriMesh::default();
    for j in 0..=n {
        let row = Vec3::from(at) + Vec3::from(v) * f64::from(j);
        mesh.vertices.extend((0..=n).map(|i| row + Vec3::from(u) * f64::from(i)));
    }
    for j in 0..n {
        for a in (0..n).map(|i| j * (n + 1) + i) {
            mesh.triangles.extend([[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]);
        }
    }
    mesh
}

fn joined(parts: &[TriMesh]) -> TriMesh {
    let mut all = TriMesh::default();
    for part in parts {
        let shift = all.vertices.len() as u32;
        all.vertices.extend(&part.vertices);
        all.triangles.extend(part.triangles.iter().map(|t| t.map(|v| v + shift)));
    }
    all
}

/// Cells of 50 × 50 in the plane y = 0, x and z from −100 to 100.
fn floor() -> TriMesh {
    sheet([-100.0, 0.0, -100.0], [50.0, 0.0, 0.0], [0.0, 0.0, 50.0], 4)
}

/// A cube with corners at ±`half`, two cells of its faces along every side.
fn cube(half: f64) -> TriMesh {
    let face = |normal: usize, up: f64| {
        let mut axes = [[0.0; 3]; 3];
        (0..3).for_each(|k| axes[k][k] = half);
        let (u, v) = (axes[(normal + 1) % 3], axes[(normal + 2) % 3]);
        let mut at = [-half; 3];
        at[normal] = up * half;
        if up > 0.0 { sheet(at, u, v, 2) } else { sheet(at, v, u, 2) }
    };
    let faces: Vec<TriMesh> = (0..3).flat_map(|normal| [face(normal, 1.0), face(normal, -1.0)]).collect();
    let all = joined(&faces);
    let mut cube = TriMesh::default();
    let mut at = |p: Vec3| {
        let found = cube.vertices.iter().position(|q| *q == p);
        found.unwrap_or_else(|| {
            cube.vertices.push(p);
            cube.vertices.len() - 1
        }) as u32
    };
    cube.triangles = all.triangles.iter().map(|t| t.map(|v| at(all.vertices[v as usize]))).collect();
    cube
}

/// Crossings of two surfaces, seen three ways: as cloth and body, the other way round, and in one mesh.
fn seen(a: &TriMesh, b: &TriMesh) -> [usize; 3] {
    assert!(crossings(a).is_empty() && crossings(b).is_empty());
    let between = [(a, b), (b, a)].map(|(a, b)| crossings_between(a, b).pairs.len());
    [between[0], between[1], crossings(&joined(&[a.clone(), b.clone()])).len()]
}

/// The mesh turned about a diagonal: the coordinates change places.
fn turned(mesh: &TriMesh) -> TriMesh {
    TriMesh { vertices: mesh.vertices.iter().map(|p| Vec3::new(p.y, p.z, p.x)).collect(), ..mesh.clone() }
}

#[test]
fn what_goes_through_along_mesh_lines_crosses() {
    let upright = |x: f64, y: f64| sheet([x, y, 0.0], [50.0, 0.0, 0.0], [0.0, 50.0, 0.0], 4);
    let slanted = sheet([-97.0, -100.0, -100.0], [50.0, 0.0, 0.0], [0.0, 50.0, 50.0], 4);
    let diagonal = sheet([-100.0, -93.0, -100.0], [50.0, 0.0, 50.0], [0.0, 50.0, 0.0], 4);
    let through = [
        ("along a line of the floor", upright(-97.0, -93.0)),
        ("along lines of both", upright(-97.0, -100.0)),
        ("along lines of both, with common vertices", upright(-100.0, -100.0)),
        ("along lines of both, aslant", slanted),
        ("along the diagonals of the floor's cells", diagonal),
        ("a cube with its vertices at half height on the floor", cube(40.0)),
        ("and at its grid's points", cube(50.0)),
    ];
    for (name, other) in through {
        let [one, two, three] = seen(&floor(), &other);
        assert!(one >= 8 && one == two && one == three, "{name}: {one} {two} {three}");
        assert_eq!(seen(&turned(&floor()), &turned(&other)), [one; 3], "{name}");
    }
    // Through four vertices of the cube, along two of its sides and diagonals of its faces.
    let askew = sheet([-100.0, -100.0, -100.0], [50.0, 50.0, 0.0], [0.0, 0.0, 50.0], 4);
    assert!(seen(&askew, &cube(40.0))[0] >= 8);
}

/// The pairs along one side of a mesh are all that have it: two triangles of the floor for each part of the line.
#[test]
fn a_hole_cut_by_a_needle_between_two_triangles_is_two_pairs() {
    let needle = TriMesh {
        vertices: [[10.0, 20.0, 0.0], [20.0, -20.0, 0.0], [30.0, 20.0, 0.0]].map(Vec3::from).to_vec(),
        triangles: vec![[0, 1, 2]],
    };
    assert_eq!(seen(&floor(), &needle), [2; 3]);
}

#[test]
fn what_only_touches_along_mesh_lines_does_not_cross() {
    let standing = |x: f64, z: f64| sheet([x, 0.0, z], [50.0, 0.0, 0.0], [0.0, 50.0, 0.0], 4);
    let tent = |up: f64| {
        let mut tent = sheet([-97.0, 0.0, -100.0], [50.0, 0.0, 0.0], [0.0, 0.0, 50.0], 4);
        tent.vertices.iter_mut().for_each(|p| p.y = up * p.z.abs());
        tent
    };
    let mut box_below = cube(50.0);
    box_below.vertices.iter_mut().for_each(|p| p.y -= 50.0);
    let mut laid_over = floor();
    laid_over.vertices.iter_mut().filter(|p| p.x > 50.0).for_each(|p| (p.x, p.y) = (50.0, 50.0 - p.x));
    let touching = [
        ("standing on a line", standing(-97.0, 0.0)),
        ("standing on a line, with common vertices", standing(-100.0, 0.0)),
        ("standing beside the lines", standing(-97.0, 13.0)),
        ("a valley on it", tent(1.0)),
        ("a ridge under it", tent(-1.0)),
        ("lying on it", sheet([-97.0, 0.0, -93.0], [50.0, 0.0, 0.0], [0.0, 0.0, 50.0], 4)),
        ("the very same", floor()),
        ("a box whose top it lies on", box_below.clone()),
    ];
    for (name, other) in touching {
        assert_eq!(seen(&floor(), &other), [0; 3], "{name}");
        assert_eq!(seen(&turned(&floor()), &turned(&other)), [0; 3], "{name}");
    }
    assert_eq!(seen(&laid_over, &box_below), [0; 3], "over a box's edge and down its side");
    assert_eq!(seen(&cube(50.0), &cube(50.0)), [0; 3], "a cube and itself");
    assert_eq!(seen(&tent(1.0), &tent(0.5)), [0; 3], "a flat valley in a steep one, on one line");
}

/// Two folded sheets on one line: whether each has parts on both sides of the other.
#[test]
fn folded_sheets_that_meet_on_their_folds() {
    let fold = |one: f64, other: f64| {
        let at = |degrees: f64| {
            let (sine, cosine) = degrees.to_radians().sin_cos();
            Vec3::new(50.0 * cosine, 50.0 * sine, 0.5)
        };
        let vertices = vec![Vec3::zeros(), Vec3::z(), at(one), at(other)];
        TriMesh { vertices, triangles: vec![[0, 1, 2], [0, 3, 1]] }
    };
    let cases = [
        (fold(10.0, 70.0), fold(20.0, 50.0), 0),
        (fold(10.0, 70.0), fold(40.0, 110.0), 4),
        (fold(10.0, 250.0), fold(20.0, 240.0), 0),
        (fold(10.0, 250.0), fold(240.0, 300.0), 4),
        (fold(10.0, 250.0), fold(260.0, 300.0), 0),
    ];
    for (a, b, expected) in cases {
        assert_eq!(seen(&a, &b), [expected; 3]);
    }
}

/// What is sewn to one line of another surface is part of it there.
#[test]
fn a_flag_sewn_to_a_line_is_no_crossing() {
    let mut flagged = floor();
    let [a, b] = [12, 13];
    let [up, down] = [50.0, -50.0].map(|y| Vec3::new(25.0, y, 0.0));
    flagged.vertices.extend([up, down]);
    flagged.triangles.extend([[a, b, 25], [b, a, 26]]);
    assert!(crossings(&flagged).is_empty());
}

#[test]
fn random_soups_agree_with_brute_force() {
    let mut noise = Noise(7);
    for size in [0.25, 0.5, 1.0] {
        let (a, b) = (soup(&mut noise, 150, size), soup(&mut noise, 150, size));
        let mut within = Vec::new();
        let mut between = Vec::new();
        for i in 0..150 {
            within.extend((i + 1..150).filter(|&j| cross(a.corners(i), a.corners(j))).map(|j| [i as u32, j as u32]));
            between.extend((0..150).filter(|&j| cross(a.corners(i), b.corners(j))).map(|j| [i as u32, j as u32]));
        }
        assert!(!within.is_empty());
        assert_eq!(crossings(&a), within);
        let found = crossings_between(&a, &b);
        assert_eq!(found.pairs, between);
        let mut cloth: Vec<u32> = between.iter().map(|p| p[0]).collect();
        cloth.dedup();
        assert_eq!(found.cloth_triangles, cloth);
    }
}

#[test]
fn clean_meshes_cross_nothing() {
    let body = ball(Vec3::zeros(), 0.3, 20);
    assert!(crossings(&body).is_empty());
    assert!(crossings_between(&ball(Vec3::zeros(), 0.31, 20), &body).pairs.is_empty());
    assert!(crossings(&TriMesh::default()).is_empty());
    assert!(crossings_between(&body, &TriMesh::default()).pairs.is_empty());
}

#[test]
fn a_point_five_millimetres_inside() {
    let body = ball(Vec3::new(0.1, 1.0, 0.0), 0.3, 60);
    let mut points: Vec<Vec3> = ball(Vec3::new(0.1, 1.0, 0.0), 0.301, 25).vertices;
    assert_eq!(inside(&points, &body).count(), 0);
    points[77] = Vec3::new(0.1, 1.0, 0.0) + Vec3::new(1.0, 2.0, -1.0).normalize() * 0.295;
    let found = inside(&points, &body);
    assert_eq!((found.points.as_slice(), found.deepest_point), ([77].as_slice(), Some(77)));
    // The facets of the ball lie up to 0.3·(1 − cos(π/60)²) = 0.8 mm below the sphere.
    assert!((0.0042..=0.005).contains(&found.deepest), "{}", found.deepest);
    assert_eq!(inside(&body.vertices, &body).count(), 0, "touching is not inside");
}

#[test]
fn inside_agrees_with_the_sphere_near_and_far() {
    let body = ball(Vec3::zeros(), 0.3, 100);
    let mut noise = Noise(3);
    let points: Vec<Vec3> = (0..4000)
        .map(|k| (noise.point() - Vec3::repeat(0.5)).normalize() * (0.3 + 0.01 * f64::from(k % 41 - 20)))
        .filter(|p| p.norm() < 0.2995 || p.norm() > 0.3001)
        .collect();
    let expected: Vec<u32> = (0..points.len() as u32).filter(|&k| points[k as usize].norm() < 0.3).collect();
    assert_eq!(inside(&points, &body).points, expected);
}

#[test]
fn a_body_that_runs_through_itself_is_still_a_body() {
    let mut body = ball(Vec3::zeros(), 0.3, 30);
    let other = ball(Vec3::new(0.2, 0.0, 0.0), 0.3, 30);
    let shift = body.vertices.len() as u32;
    body.vertices.extend(other.vertices);
    body.triangles.extend(other.triangles.iter().map(|t| t.map(|v| v + shift)));
    let points = [-0.25, 0.1, 0.45, 0.55, -0.35].map(|x| Vec3::new(x, 0.01, 0.02));
    assert_eq!(inside(&points, &body).points, [0, 1, 2]);
}

fn part(kind: PartKind, from: Vec3, to: Vec3) -> BodyPart {
    let axis = (to - from).normalize();
    let section =
        |t: f64| Section { center: from + (to - from) * t, axis, half_width: 0.05, half_depth: 0.05, girth: 0.314 };
    BodyPart { kind, sections: [0.0, 0.5, 1.0].map(section).to_vec(), landmarks: vec![] }
}

fn mannequin() -> Mannequin {
    let limb = |kind, a: [f64; 3], b: [f64; 3]| part(kind, Vec3::from(a), Vec3::from(b));
    Mannequin {
        name: "stick".into(),
        mesh: TriMesh::default(),
        parts: vec![
            limb(PartKind::Torso, [0.0, 0.8, 0.0], [0.0, 1.4, 0.0]),
            limb(PartKind::Neck, [0.0, 1.4, 0.0], [0.0, 1.55, 0.0]),
            limb(PartKind::LeftArm, [0.2, 1.38, 0.0], [0.35, 0.85, 0.0]),
            limb(PartKind::RightArm, [-0.2, 1.38, 0.0], [-0.35, 0.85, 0.0]),
            limb(PartKind::LeftLeg, [0.1, 0.8, 0.0], [0.12, 0.1, 0.0]),
            limb(PartKind::RightLeg, [-0.1, 0.8, 0.0], [-0.12, 0.1, 0.0]),
        ],
        frame: BodyFrame::default(),
    }
}

fn ring(center: [f64; 3], radius: f64) -> Vec<Vec3> {
    let at = |k: u32| {
        let turn = 2.0 * PI * f64::from(k) / 60.0;
        // Rippled, as hems are.
        let r = radius * (1.0 + 0.05 * (7.0 * turn).sin());
        Vec3::from(center) + Vec3::new(r * turn.sin(), 0.02 * (5.0 * turn).cos(), r * turn.cos())
    };
    (0..60).map(at).collect()
}

#[test]
fn what_passes_through_a_ring() {
    let cases = [
        (ring([0.0, 1.45, 0.0], 0.1), Some("neck")),
        (ring([0.0, 1.75, 0.0], 0.1), Some("neck")),
        (ring([0.0, 1.0, 0.0], 0.2), Some("torso")),
        (ring([0.0, 0.5, 0.0], 0.5), Some("legs")),
        // A wide hem below the hands of hanging arms.
        (ring([0.0, 0.45, 0.0], 0.9), Some("legs")),
        (ring([0.115, 0.4, 0.0], 0.1), Some("left leg")),
        (ring([-0.115, 0.4, 0.0], 0.1), Some("right leg")),
        (ring([0.25, 1.2, 0.0], 0.1), Some("left arm")),
        (ring([-0.25, 1.2, 0.0], 0.1), Some("right arm")),
        // A bandeau's upper rim, outside of which the arms hang: round the trunk only.
        (ring([0.0, 1.2, 0.0], 0.12), Some("torso")),
        (ring([0.0, 1.2, 0.5], 0.2), None),
        (ring([0.0, 0.02, 0.6], 0.3), None),
    ];
    let (rims, expected): (Vec<_>, Vec<_>) = cases.into_iter().unzip();
    let found: Vec<_> = worn(&rims, &mannequin()).into_iter().map(|p| p.through.map(|t| t.name())).collect();
    assert_eq!(found, expected);
    let backwards: Vec<Vec<Vec3>> = rims.iter().map(|r| r.iter().rev().copied().collect()).collect();
    let found: Vec<_> = worn(&backwards, &mannequin()).into_iter().map(|p| p.through.map(|t| t.name())).collect();
    assert_eq!(found, expected);
}

#[test]
fn a_sleeve_ends_before_the_wrist_or_past_it() {
    let body = mannequin();
    let (shoulder, wrist) = (Vec3::new(0.2, 1.38, 0.0), Vec3::new(0.35, 0.85, 0.0));
    let along = (wrist - shoulder).normalize();
    for past in [-0.3, -0.01, 0.042] {
        // Slipped sideways, as a wide sleeve hangs.
        let middle = wrist + along * past + Vec3::z() * 0.02;
        let rim = ring(middle.into(), 0.08);
        let through = worn(std::slice::from_ref(&rim), &body)[0].through.expect("an arm");
        let found = past_end(&rim, through, &body).expect("past an arm's end");
        assert!((found - past).abs() < 1e-3, "{found} for {past}");
    }
    let neck = ring([0.0, 1.45, 0.0], 0.1);
    assert_eq!(past_end(&neck, Through::Part(PartKind::Neck), &body), None);
    assert_eq!(past_end(&neck, Through::Legs, &body), None);
}

#[test]
fn a_hood_is_worn_round_the_face() {
    let upright: Vec<Vec3> =
        ring([0.0, 0.0, 0.0], 0.12).into_iter().map(|p| Vec3::new(p.x, 1.65 + p.z, 0.12 + p.y)).collect();
    assert_eq!(worn(&[upright], &mannequin())[0].through.map(|t| t.name()), Some("neck"));
}

#[test]
fn a_hood_that_slipped_over_the_face_is_worn_round_the_chin() {
    let body = mannequin();
    let neck = body.parts.iter().find(|p| p.kind == PartKind::Neck).expect("a neck");
    let chin = neck.sections.last().expect("sections").center.y;
    let over = |height: f64| -> Vec<Vec3> {
        ring([0.0, 0.0, 0.0], 0.04).into_iter().map(|p| Vec3::new(p.x, chin + height + p.z, 0.12 + p.y)).collect()
    };
    let found: Vec<_> =
        worn(&[over(0.01), over(-0.06)], &body).into_iter().map(|p| p.through.map(|t| t.name())).collect();
    assert_eq!(found, [Some("neck"), None], "under the chin it is a slit in a front");
}

#[test]
fn a_tube_nobody_wears_has_two_empty_rims() {
    let cloth = tube(Vec3::new(0.0, 1.0, 0.6), 0.2, 0.5, 40, 10);
    let at = |l: Vec<u32>| l.into_iter().map(|v| cloth.vertices[v as usize]).collect();
    let rims: Vec<Vec<Vec3>> = rim_loops(&cloth.triangles).into_iter().map(at).collect();
    assert!(worn(&rims, &mannequin()).iter().all(|p| p.through.is_none() && p.ends.is_empty()));
}

/// Times are printed, not asserted: a busy machine must not fail a right program.
#[test]
fn large_meshes() {
    let body = ball(Vec3::new(0.0, 1.0, 0.0), 0.3, 87);
    let cloth = tube(Vec3::new(0.0, 1.0, 0.0), 0.302, 0.5, 100, 50);
    let (cloth_count, body_count) = (cloth.triangles.len(), body.triangles.len());
    let start = Instant::now();
    let own = crossings(&cloth);
    let own_time = start.elapsed();
    let start = Instant::now();
    let between = crossings_between(&cloth, &body);
    let between_time = start.elapsed();
    let points: Vec<Vec3> = cloth.vertices.iter().flat_map(|p| [*p, p + Vec3::new(0.001, 0.0, 0.002)]).collect();
    let start = Instant::now();
    let found = inside(&points, &body);
    let inside_time = start.elapsed();
    assert!(own.is_empty() && between.pairs.is_empty());
    assert!(found.count() > 0);
    println!("{cloth_count} x {body_count} triangles: {own_time:?} self, {between_time:?} body");
    println!("{} points in {inside_time:?}", points.len());
}
