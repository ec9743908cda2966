//! Bodies of one's own, read from OBJ.

use std::fs;
use std::path::{Path, PathBuf};

use toile::geometry::Vec3;
use toile::input::LengthUnit;
use toile::io::body::{Body, BodyError, body, floor_of, load_body, mannequin_obj, read_body};
use toile::io::obj_read::{ObjSurface, parse_obj};
use toile::mannequin::{BodyFault, Mannequin, MannequinSpec, PartKind, load};
use toile::pipeline::{self, Color, Job, Overrides, Run, SEWN_OBJ, judge};

fn child() -> ObjSurface {
    parse_obj(&mannequin_obj(&load("child_110").expect("child")), "child.obj").expect("our own OBJ")
}

fn read(surface: ObjSurface) -> Result<Body, BodyError> {
    body(surface, "child".to_owned(), "child.obj".to_owned(), None)
}

fn turned(turn: impl Fn(Vec3) -> Vec3) -> ObjSurface {
    let mut surface = child();
    surface.vertices.iter_mut().for_each(|p| *p = turn(*p));
    surface
}

fn mark(m: &Mannequin, kind: PartKind, name: &str) -> Vec3 {
    let part = m.parts.iter().find(|p| p.kind == kind).expect("six parts");
    part.landmarks.iter().find(|l| l.0 == name).expect(name).1
}

#[test]
fn our_own_mannequins_come_back_with_their_parts() {
    for name in ["woman_92", "man_100", "child_110"] {
        let ours = load(name).expect(name);
        let surface = parse_obj(&mannequin_obj(&ours), name).expect(name);
        let back = body(surface, name.to_owned(), name.to_owned(), None).expect(name).mannequin;
        assert_eq!(back.mesh.triangles.len(), ours.mesh.triangles.len());
        assert_eq!(back.parts.len(), 6);
        for (kind, landmark, within) in [
            (PartKind::Torso, "waist", 0.05),
            (PartKind::Torso, "hip", 0.06),
            (PartKind::LeftArm, "wrist", 0.08),
            (PartKind::RightArm, "wrist", 0.08),
            (PartKind::LeftArm, "elbow", 0.08),
            (PartKind::LeftLeg, "knee", 0.08),
            (PartKind::RightLeg, "ankle", 0.06),
            (PartKind::Neck, "neck base", 0.05),
        ] {
            let off = (mark(&back, kind, landmark) - mark(&ours, kind, landmark)).norm();
            println!("{name} {kind:?} {landmark}: {:.0} mm", off * 1e3);
            assert!(off < within, "{name} {kind:?} {landmark} is {:.0} mm off", off * 1e3);
        }
    }
}

#[test]
fn units_and_axes_are_guessed_and_said() {
    for (scale, unit) in [(1.0, "millimetres"), (0.1, "centimetres"), (0.01, "decimetres"), (1e-3, "metres")] {
        let found = read(turned(|p| p * scale)).expect(unit);
        assert!(found.notes.iter().any(|n| n.starts_with(unit)), "{:?}", found.notes);
        let top = found.mannequin.mesh.vertices.iter().map(|p| p.y).fold(0.0, f64::max);
        assert!((top - 0.951).abs() < 1e-3);
    }
    let found = read(turned(|p| Vec3::new(p.x, -p.z, p.y + 500.0))).expect("z up");
    assert!(found.notes.iter().any(|n| n.contains("z is the tall axis")));
    assert!(found.notes.iter().any(|n| n.contains("feet are at y = 500.1 mm")), "{:?}", found.notes);
    assert!(mark(&found.mannequin, PartKind::LeftArm, "wrist").x > 0.2);
}

#[test]
fn the_floor_of_a_file_is_in_the_unit_that_the_body_is_read_in() {
    let folder = tempfile::tempdir().expect("a folder");
    for scale in [1.0, 0.1, 0.01, 1e-3] {
        let mut mannequin = load("child_110").expect("child");
        let off = |p: &Vec3| scale * (p + Vec3::new(0.0, -0.5, 0.0));
        mannequin.mesh.vertices = mannequin.mesh.vertices.iter().map(off).collect();
        let file = folder.path().join("child.obj");
        fs::write(&file, mannequin_obj(&mannequin)).expect("the body");
        let floor = floor_of(file.to_str().expect("a path"), None).expect("a body");
        assert!((floor + 0.5).abs() < 1e-3, "{scale}: {floor}");
    }
}

/// The child with something to tell its front by: toes, 15 mm high and 160 mm long.
fn with_toes() -> ObjSurface {
    let mut surface = child();
    add_corner(&mut surface, Vec3::new(40.0, 15.0, 160.0), Vec3::new(-20.0, 0.1, 0.0));
    surface
}

/// Adds the corner of a box of this size at `at`.
fn add_corner(surface: &mut ObjSurface, size: Vec3, at: Vec3) {
    let first = surface.vertices.len() as u32;
    let corners = [Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()];
    surface.vertices.extend(corners.map(|p| p.component_mul(&size) + at));
    surface.triangles.extend([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].map(|t| t.map(|v| v + first)));
}

/// The same with its back to us and 300 mm further down.
fn elsewhere() -> ObjSurface {
    let mut surface = with_toes();
    surface.vertices.iter_mut().for_each(|p| *p = Vec3::new(-p.x, p.y - 300.0, -p.z));
    surface
}

#[test]
fn a_body_that_stands_elsewhere_is_the_same_and_leads_back_to_its_file() {
    let (surface, plain) = (elsewhere(), read(with_toes()).expect("a body").mannequin);
    let Body { mannequin: found, notes } = read(surface.clone()).expect("a body");
    assert!(notes.iter().any(|n| n.contains("toes point to -z")), "{notes:?}");
    for (k, p) in found.mesh.vertices.iter().enumerate() {
        assert!((p - plain.mesh.vertices[k]).norm() < 1e-9, "{p:?}");
        let written = found.frame.to_file(*p);
        assert!((1e3 * written - surface.vertices[k]).norm() < 1e-6, "{written:?}");
        assert!((found.frame.from_file(written) - p).norm() < 1e-12);
    }
}

#[test]
fn a_body_is_found_whichever_way_it_faces() {
    let plain = read(with_toes()).expect("a body").mannequin;
    for degrees in (0..360).step_by(30) {
        let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
        let mut surface = with_toes();
        surface.vertices.iter_mut().for_each(|p| *p = Vec3::new(p.x * cos + p.z * sin, p.y, p.z * cos - p.x * sin));
        let Body { mannequin: found, notes } = read(surface.clone()).expect("a body");
        assert_eq!(found.parts.len(), 6, "{degrees}: {notes:?}");
        assert_eq!(notes.iter().any(|n| n.contains("it faces (")), degrees % 180 != 0, "{degrees}: {notes:?}");
        // The toes on one foot turn its axis by a little.
        let [z, x] = found.frame.front;
        assert!(z * cos + x * sin > 0.999, "{degrees}: {:?}", found.frame);
        for name in ["waist", "hip"] {
            let off = (mark(&found, PartKind::Torso, name) - mark(&plain, PartKind::Torso, name)).norm();
            assert!(off < 0.005, "{degrees} {name} is {:.1} mm off", 1e3 * off);
        }
        for (k, p) in found.mesh.vertices.iter().enumerate() {
            assert!((1e3 * found.frame.to_file(*p) - surface.vertices[k]).norm() < 1e-6, "{degrees}: {p:?}");
        }
    }
}

#[test]
fn what_is_sewn_on_a_body_that_stands_elsewhere_is_written_where_its_file_has_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let body = folder.path().join("elsewhere.obj");
    let Body { mut mannequin, .. } = read(with_toes()).expect("a body");
    mannequin.mesh.vertices = elsewhere().vertices.iter().map(|p| p / 1e3).collect();
    fs::write(&body, mannequin_obj(&mannequin)).expect("the body");
    let garment = Path::new(env!("CARGO_MANIFEST_DIR")).join("patterns/child_dress.yaml");
    let named = body.to_str().map(str::to_owned);
    let overrides = Overrides { spacing: Some(0.03), body: named.clone(), ..Overrides::default() };
    let job = Job::new(&garment, pipeline::read(&garment).expect("a garment"), &overrides).expect("a job");
    let mut run = Run::new(&job);
    run.sew(&mut |_, _| {}).expect("sewn");
    let files = run.results(&run.report(), Color::Piece).expect("files");
    let sewn = folder.path().join(SEWN_OBJ);
    fs::write(&sewn, &files.iter().find(|f| f.0 == SEWN_OBJ).expect("a sewn garment").1).expect("the garment");

    let judged =
        judge(&sewn, Some(LengthUnit::Millimetre), named.as_deref().map(|name| (name, Some(LengthUnit::Millimetre))))
            .expect("two surfaces");
    assert_eq!((judged.notes.len(), judged.seen.contact.cloth_body_intersections), (0, 0), "{:?}", judged.notes);
    let again = Run::from_sewn(&job, &sewn).expect("the same garment");
    let [first, second] = [&run, &again].map(|run| run.last().expect("sewn"));
    // OBJ coordinates have six decimals of a millimetre.
    assert!(first.iter().zip(second).all(|(a, b)| (a - b).norm() < 2e-9));

    // Nothing is told of what the earlier run did before; of the draped garment alone it is not known how it was sewn.
    let stages = |run: &Run| run.report().stages.into_iter().map(|s| s.name).collect::<Vec<_>>();
    assert_eq!((stages(&run), stages(&again)), (vec!["mesh".to_owned(), "sew".to_owned()], vec!["mesh".to_owned()]));
    let draped = Run::from_draped(&job, &sewn).expect("the same garment");
    let sewn_area = |run: &Run| run.report().total.sizes.area_sewn;
    assert!(sewn_area(&again).is_some() && sewn_area(&draped).is_none());
}

/// A tetrahedron whose faces share no vertices; the copies of a corner are up to 0.2 µm apart, and where rounding to a
/// grid of a micron parts them.
#[test]
fn vertices_nearer_than_a_micron_are_one_wherever_they_are() {
    for base in [0.0, 1e-7, 5e-7, 1.0, 1.000_000_5, -1.000_000_5, 1.000_001] {
        let corners = [Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()].map(|p| 0.1 * p + Vec3::repeat(base));
        let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let off =
            |face: usize, corner: usize| Vec3::repeat(if (face + corner).is_multiple_of(2) { 1e-7 } else { -1e-7 });
        let copies = faces.iter().enumerate().flat_map(|(f, face)| face.map(|c: usize| corners[c] + off(f, c)));
        let surface = ObjSurface {
            vertices: copies.collect(),
            triangles: (0..4).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect(),
        };
        let name = || "tetrahedron".to_owned();
        let found = body(surface, name(), name(), Some(LengthUnit::Metre)).unwrap_or_else(|e| panic!("{base}: {e}"));
        let mesh = found.mannequin.mesh;
        assert_eq!((mesh.vertices.len(), mesh.triangles.len()), (4, 4), "{base}");
    }
}

/// As programs write it that keep a normal per face: each triangle has vertices of its own.
#[test]
fn a_body_whose_faces_share_no_vertices_is_the_body_it_was() {
    let shared = child();
    let own = ObjSurface {
        vertices: shared.triangles.iter().flatten().map(|&v| shared.vertices[v as usize]).collect(),
        triangles: (0..shared.triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect(),
    };
    let [shared, own] = [shared, own].map(|surface| read(surface).expect("a body").mannequin.mesh);
    assert_eq!((own.vertices.len(), own.triangles.len()), (shared.vertices.len(), shared.triangles.len()));
    for t in 0..own.triangles.len() {
        assert_eq!(own.corners(t), shared.corners(t), "triangle {t}");
    }
}

#[test]
fn a_surface_that_is_no_body_is_refused_with_the_place() {
    let fault = |surface: ObjSurface| match read(surface).expect_err("no body") {
        BodyError::Fault { fault, .. } => fault,
        other => panic!("{other}"),
    };
    let mut open = child();
    open.triangles.pop();
    assert!(matches!(fault(open), BodyFault::Open { edges: 3, .. }));
    let mut inside_out = child();
    inside_out.triangles.iter_mut().for_each(|t| t.reverse());
    assert!(matches!(fault(inside_out), BodyFault::InsideOut { .. }));
    let mut turned_one = child();
    turned_one.triangles[0].reverse();
    assert!(matches!(fault(turned_one), BodyFault::Misoriented { pairs: 3, .. }));
    let mut doubled = child();
    doubled.triangles.push(doubled.triangles[0]);
    assert!(matches!(fault(doubled), BodyFault::NonManifold { edges: 3, .. }));
}

#[test]
fn crossings_are_said_with_their_place() {
    // Legs pushed into each other below the knees, or in a narrow band only.
    let crossed = |from: f64| {
        turned(|p| Vec3::new(if (from..250.0).contains(&p.y) { p.x - 60.0 * p.x.signum() } else { p.x }, p.y, p.z))
    };
    assert!(matches!(read(crossed(0.0)), Err(BodyError::Crossing { pairs: 369.., .. })));
    let found = read(crossed(240.0)).expect("still a body");
    assert!(found.notes.iter().any(|n| n.contains("crosses itself")), "{:?}", found.notes);
    assert!(read(child()).expect("a body").notes.iter().all(|n| !n.contains("crosses")));
}

#[test]
fn duplicate_vertices_are_merged() {
    let surface = child();
    let mut soup = ObjSurface::default();
    for t in &surface.triangles {
        let first = soup.vertices.len() as u32;
        soup.vertices.extend(t.map(|v| surface.vertices[v as usize]));
        soup.triangles.push([first, first + 1, first + 2]);
    }
    let found = read(soup).expect("a body");
    assert_eq!(found.mannequin.mesh.vertices.len(), surface.vertices.len());
}

#[test]
fn parts_that_do_not_touch_are_said() {
    let mut surface = child();
    add_corner(&mut surface, Vec3::repeat(50.0), Vec3::new(0.0, 500.0, 500.0));
    let found = read(surface).expect("a body and a pebble");
    assert!(found.notes.iter().any(|n| n.contains("2 parts that do not touch")), "{:?}", found.notes);
}

#[test]
fn a_body_of_no_bodys_size_is_refused_with_its_unit() {
    for (scale, says) in [(150.0, "142.6"), (1e-6, "9.5e-4")] {
        let error = read(turned(|p| p * scale)).expect_err("no body's size");
        assert!(matches!(error, BodyError::Size { .. }), "{error}");
        let text = error.to_string();
        assert!(text.contains(says) && text.contains("scale the file to millimetres"), "{text}");
    }
}

/// A ball of facets, `size` across, about (x, y, z) = (0, 10, 20) sizes.
fn ball(size: f64) -> ObjSurface {
    let (rows, columns) = (12, 16);
    let at = |row: usize, column: usize| {
        let [up, round] = [(row, rows, 1.0), (column, columns, 2.0)]
            .map(|(k, n, turns): (usize, usize, f64)| std::f64::consts::PI * turns * k as f64 / n as f64);
        0.5 * size * Vec3::new(up.sin() * round.sin(), up.cos(), up.sin() * round.cos())
            + size * Vec3::new(0.0, 10.0, 20.0)
    };
    let mut surface = ObjSurface::default();
    surface.vertices.push(at(0, 0));
    surface.vertices.push(at(rows, 0));
    surface.vertices.extend((1..rows).flat_map(|r| (0..columns).map(move |c| (r, c))).map(|(r, c)| at(r, c)));
    let index = |r: usize, c: usize| match r {
        0 => 0,
        r if r == rows => 1,
        r => (2 + (r - 1) * columns + c % columns) as u32,
    };
    for (r, c) in (0..rows).flat_map(|r| (0..columns).map(move |c| (r, c))) {
        let quad = [index(r, c), index(r + 1, c), index(r + 1, c + 1), index(r, c + 1)];
        let faces = [[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]];
        surface.triangles.extend(faces.iter().filter(|f| f[0] != f[1] && f[1] != f[2] && f[2] != f[0]));
    }
    surface
}

#[test]
fn a_small_object_has_the_unit_that_is_said() {
    let read = |unit| body(ball(190.0), "ball".to_owned(), "ball.obj".to_owned(), unit).expect("a ball");
    let wide = |found: &Body| {
        let x = found.mannequin.mesh.vertices.iter().map(|v| v.x);
        2.0 * x.fold(0.0, f64::max)
    };
    let guessed = read(None);
    assert!((wide(&guessed) - 1.9).abs() < 1e-9);
    let note = "centimetres assumed, since the object is 190.00 units long; if that is wrong, say --body-units";
    assert!(guessed.notes.iter().any(|n| n.starts_with(note)), "{:?}", guessed.notes);
    for (unit, metres) in [(LengthUnit::Millimetre, 0.19), (LengthUnit::Centimetre, 1.9), (LengthUnit::Inch, 4.826)] {
        let found = read(Some(unit));
        assert!((wide(&found) - metres).abs() < 1e-9 && found.mannequin.parts.is_empty(), "{unit:?}");
        assert!(found.notes.iter().all(|n| !n.contains("assumed")), "{:?}", found.notes);
    }
    // Of a named mannequin there is no doubt.
    assert!(matches!(load_body("child_110", Some(LengthUnit::Inch)), Err(BodyError::NoUnit(_))));
}

#[test]
fn places_of_faults_are_told_as_the_file_has_them() {
    let said = |surface: ObjSurface, unit| {
        body(surface, "a".to_owned(), "a.obj".to_owned(), unit).expect_err("open").to_string()
    };
    // The triangle that is missing begins at the top of the ball.
    let mut open = ball(190.0);
    open.triangles.remove(0);
    assert!(said(open.clone(), Some(LengthUnit::Millimetre)).contains("near (0, 1995, 3800) mm"));
    assert!(said(open.clone(), Some(LengthUnit::Centimetre)).contains("near (0.0, 1995.0, 3800.0) cm"));
    open.vertices.iter_mut().for_each(|v| *v /= 1e3);
    assert!(said(open, Some(LengthUnit::Metre)).contains("near (0.000, 1.995, 3.800) m"));
    // Upright along z, in centimetres: turned to be looked at, told as it was.
    let mut child = turned(|p| Vec3::new(p.x, -p.z, p.y) / 10.0);
    let corner = child.vertices[child.triangles.pop().expect("triangles")[0] as usize];
    let text = said(child, None);
    let near = |p: &Vec3| text.contains(&format!("near ({:.1}, {:.1}, {:.1}) cm", p.x, p.y, p.z));
    let rim = turned(|p| Vec3::new(p.x, -p.z, p.y) / 10.0);
    let last = rim.triangles[rim.triangles.len() - 1].map(|v| rim.vertices[v as usize]);
    assert!(last.contains(&corner) && last.iter().any(near), "{text} {last:?}");
}

#[test]
fn a_flat_surface_is_not_called_inside_out() {
    let both_sides = "v 0 0 0\nv 500 0 0\nv 500 900 0\nv 0 900 0\nf 1 2 3\nf 1 3 4\nf 3 2 1\nf 4 3 1\n";
    let surface = parse_obj(both_sides, "flat.obj").expect("a surface");
    let error = read(surface).expect_err("no body").to_string();
    assert!(!error.contains("inside out"), "{error}");
}

#[test]
fn a_squashed_body_is_flat() {
    let error = read(turned(|p| Vec3::new(p.x, p.y, 0.0))).expect_err("no body");
    assert!(matches!(error, BodyError::Fault { fault: BodyFault::Flat, .. }), "{error}");
}

#[test]
fn a_mannequin_in_another_unit_is_refused_before_it_is_built() {
    let text = include_str!("../mannequins/child_110.yaml");
    for (from, to) in [("y: ", "y: 100"), ("girth: ", "girth: 99")] {
        let spec = MannequinSpec::parse(&text.replace(from, to), "big.yaml");
        let error = spec.expect_err("too large").to_string();
        assert!(error.starts_with("big.yaml: ") && error.contains("millimetres"), "{error}");
    }
}

/// A scanned-like body of GarmentCode's, which is not shipped: `TOILE_BODY` or a neighbouring folder may have it.
#[test]
fn a_foreign_body_is_read() {
    let path = std::env::var_os("TOILE_BODY").map_or("../shared/garmentcode/mean_all.obj".into(), PathBuf::from);
    if !path.exists() {
        println!("skipped: no {} (set TOILE_BODY to the path of mean_all.obj)", path.display());
        return;
    }
    let start = std::time::Instant::now();
    let found = read_body(&path, None).expect("mean_all.obj");
    println!("{:?} {:?}", start.elapsed(), found.notes);
    assert_eq!(found.mannequin.parts.len(), 6);
    for part in &found.mannequin.parts {
        println!("{:?} {} sections {:?}", part.kind, part.sections.len(), part.landmarks);
    }
    let waist = mark(&found.mannequin, PartKind::Torso, "waist");
    assert!((1.0..1.15).contains(&waist.y), "waist at {}", waist.y);
    assert!(mark(&found.mannequin, PartKind::LeftArm, "wrist").x > 0.4);
    assert!(mark(&found.mannequin, PartKind::RightArm, "wrist").x < -0.4);
    let neck = mark(&found.mannequin, PartKind::Neck, "neck base");
    assert!((1.35..1.50).contains(&neck.y), "neck base at {}", neck.y);
}

/// Thighs that nearly touch have their gap where it is, not exactly in the middle of the body.
#[test]
fn thighs_that_nearly_touch_beside_the_middle_are_legs() {
    let crotch = |m: &Mannequin| mark(m, PartKind::Torso, "crotch").y;
    let straight = read(child()).expect("a body").mannequin;
    let top = crotch(&straight) * 1e3;
    // The legs moved aside until the middle is a millimetre within one of them.
    let thigh = child().vertices.into_iter().filter(|p| (0.8 * top..0.97 * top).contains(&p.y));
    let half_gap = thigh.map(|p| p.x.abs()).fold(f64::INFINITY, f64::min);
    let mut surface = child();
    surface.vertices.iter_mut().filter(|p| p.y < top).for_each(|p| p.x += half_gap + 1.0);
    let moved = read(surface).expect("a body").mannequin;
    assert_eq!(moved.parts.len(), 6);
    assert!((crotch(&moved) - crotch(&straight)).abs() < 0.03, "{} {}", crotch(&moved), crotch(&straight));
}
