//! Bodies of one's own, read from OBJ.

use std::fs;
use std::path::{Path, PathBuf};

use toile::contact::Collider;
use toile::geometry::Vec3;
use toile::input::LengthUnit;
use toile::io::body::{Body, BodyError, body, floor_of, load_body, mannequin_obj, read_body};
use toile::io::obj_read::{ObjSurface, parse_obj};
use toile::mannequin::{BodyFault, GAP, Mannequin, MannequinSpec, PartKind, build, load};
use toile::pipeline::{self, Job, Overrides, PictureOptions, Run, SEWN_OBJ, judge};

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

/// A shipped mannequin with its arms lifted so far from the vertical, degrees.
fn with_arms_at(name: &str, degrees: u32) -> Mannequin {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("mannequins").join(name).with_extension("yaml");
    let text = fs::read_to_string(file).expect(name);
    let own = text.lines().find(|line| line.contains("abduction:")).expect("an angle");
    let spec = MannequinSpec::parse(&text.replace(own, &format!("  abduction: {degrees}")), name).expect(name);
    build(&spec).expect(name)
}

#[test]
fn parts_are_found_in_every_pose_up_to_a_t() {
    for (name, degrees) in [("child_110", 60), ("child_110", 90), ("man_100", 85), ("woman_92", 90)] {
        let ours = with_arms_at(name, degrees);
        let surface = parse_obj(&mannequin_obj(&ours), name).expect(name);
        let Body { mannequin: back, notes } = body(surface, name.to_owned(), name.to_owned(), None).expect(name);
        assert_eq!(back.parts.len(), 6, "{name} {degrees}: {notes:?}");
        for (kind, landmark, within) in [
            (PartKind::Torso, "waist", 0.05),
            (PartKind::LeftArm, "wrist", 0.05),
            (PartKind::RightArm, "elbow", 0.08),
            (PartKind::LeftLeg, "ankle", 0.06),
            (PartKind::Neck, "neck base", 0.05),
        ] {
            let off = (mark(&back, kind, landmark) - mark(&ours, kind, landmark)).norm();
            assert!(off < within, "{name} {degrees} {kind:?} {landmark} is {:.0} mm off", off * 1e3);
        }
    }
}

/// Adds a tail of hair to the back of the neck's end, so long and out to this side, millimetres: a tube of three sides
/// that hangs behind the back.
fn add_tail(surface: &mut ObjSurface, long: f64, aside: f64) {
    let top = surface.vertices.iter().map(|p| p.y).fold(0.0, f64::max);
    let root = surface.triangles.iter().position(|t| {
        let [a, b, c] = t.map(|v| surface.vertices[v as usize]);
        let middle = (a + b + c) / 3.0;
        middle.y > top - 30.0 && (b - a).cross(&(c - a)).z < 0.0 && middle.x * aside >= 0.0
    });
    let mut ring = surface.triangles.swap_remove(root.expect("a back"));
    for down in [0.0, long] {
        let first = surface.vertices.len() as u32;
        let along = Vec3::new(aside, -down, -120.0);
        surface.vertices.extend(ring.map(|v| surface.vertices[v as usize] + along));
        // Only the way to the first ring leads out.
        let next = [0, 1, 2].map(|k| first + k);
        if down > 0.0 {
            (0..3).for_each(|k| surface.vertices[next[k] as usize] -= Vec3::new(aside, 0.0, -120.0));
        }
        for i in 0..3 {
            let (j, [s, t]) = ((i + 1) % 3, [ring[i], next[i]]);
            surface.triangles.extend([[s, ring[j], next[j]], [s, next[j], t]]);
        }
        ring = next;
    }
    surface.triangles.push(ring);
}

/// Hair is skin that hangs down from the head, whatever it hangs beside.
#[test]
fn hair_is_no_part_of_the_body_and_hides_none() {
    let plain = read(child()).expect("a body").mannequin;
    for (long, asides) in [(200.0, vec![0.0]), (450.0, vec![0.0]), (350.0, vec![-60.0, 60.0])] {
        let mut surface = child();
        asides.iter().for_each(|aside| add_tail(&mut surface, long, *aside));
        let Body { mannequin: found, notes } = read(surface).expect("a body");
        assert_eq!(found.parts.len(), 6, "{long} {asides:?}: {notes:?}");
        for (with, without) in found.parts.iter().zip(&plain.parts) {
            let off = |(a, b): (&(String, Vec3), &(String, Vec3))| (a.1 - b.1).norm();
            let most = with.landmarks.iter().zip(&without.landmarks).map(off).fold(0.0, f64::max);
            assert!(most < 0.03, "{long} {asides:?}: {:?} is {:.0} mm off", with.kind, 1e3 * most);
        }
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
    let files = run.results(&run.report(), &PictureOptions::default()).expect("files");
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

/// Thighs that lean the same way fit into one another: each reaches over the body's middle, and over the other's side.
#[test]
fn thighs_that_reach_over_each_others_side_are_legs() {
    let top = 1e3 * mark(&read(child()).expect("a body").mannequin, PartKind::Torso, "crotch").y;
    let leant = turned(|p| if p.y < top { Vec3::new(p.x + 0.5 * (p.z - 18.0), p.y, p.z) } else { p });
    let found = read(leant).expect("a body").mannequin;
    assert_eq!(found.parts.len(), 6);
    assert!((1e3 * mark(&found, PartKind::Torso, "crotch").y - top).abs() < 30.0);
}

/// The least distance along x, metres, from the skin round `inside` to the next skin beyond it towards the middle, in
/// front of and behind it as well.
fn room_beside(body: &Mannequin, inside: Vec3) -> f64 {
    let collider = Collider::new(&body.mesh).expect("collider");
    let towards = -inside.x.signum();
    let along = |z: f64| {
        let is_in = |k: &i32| {
            let p = Vec3::new(inside.x + towards * 1e-4 * f64::from(*k), inside.y, inside.z + z);
            collider.nearest(p, 0.5).is_some_and(|near| near.distance < 0.0)
        };
        let skin = (0..1000).find(|k| !is_in(k))?;
        let other = (skin..skin + 1000).find(is_in)?;
        is_in(&0).then(|| 1e-4 * f64::from(other - skin))
    };
    (-6..=6).filter_map(|k| along(5e-3 * f64::from(k))).fold(f64::INFINITY, f64::min)
}

#[test]
fn thighs_that_almost_touch_make_room_for_cloth() {
    let plain = read(child()).expect("a body");
    let top = 1e3 * mark(&plain.mannequin, PartKind::Torso, "crotch").y;
    let thigh = child().vertices.into_iter().filter(|p| (0.7 * top..0.9 * top).contains(&p.y));
    let half_gap = thigh.map(|p| p.x.abs()).fold(f64::INFINITY, f64::min);
    let narrow = turned(|p| if p.y < top { p - Vec3::x() * p.x.signum() * (half_gap - 0.5) } else { p });
    let said = |notes: &[String]| notes.iter().any(|n| n.contains("left leg, right leg") && n.contains("moved aside"));
    assert!(!said(&plain.notes), "{:?}", plain.notes);
    let Body { mannequin: found, notes } = read(narrow).expect("a body");
    assert!(said(&notes), "{notes:?}");
    let legs = [&plain.mannequin, &found].map(|body| body.part(PartKind::LeftLeg).expect("a leg").clone());
    for section in legs[1].sections.iter().filter(|s| (0.7 * top..0.9 * top).contains(&(1e3 * s.center.y))) {
        let room = room_beside(&found, section.center);
        assert!(room > GAP - 2e-4, "{room} at {}", section.center.y);
    }
    let knee = |k: usize| legs[k].sections.iter().find(|s| s.center.y < 0.3).expect("a knee").girth;
    assert!((knee(0) - knee(1)).abs() < 1e-6, "limbs keep their girths");
}

#[test]
fn arms_that_almost_touch_the_hips_make_room_for_cloth() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes/close_limbs.obj");
    let mut surface = parse_obj(&fs::read_to_string(&file).expect("the body"), "close.obj").expect("the body");
    // Between trunk and arm at every height, millimetres; the wrists are leant against the hips.
    let between = |y: f64| 155.0 + 0.23 * (950.0 - y).max(0.0);
    for p in surface.vertices.iter_mut().filter(|p| p.y < 1150.0 && p.y > 750.0 && p.x.abs() > between(p.y)) {
        p.x -= p.x.signum() * 14.5 * ((1150.0 - p.y) / 300.0).min(1.0);
    }
    let Body { mannequin: found, notes } = read(surface).expect("a body");
    assert!(notes.iter().any(|n| n.contains("left arm") && n.contains("right arm")), "{notes:?}");
    for kind in [PartKind::LeftArm, PartKind::RightArm] {
        let arm = found.part(kind).expect("an arm");
        for section in arm.sections.iter().filter(|s| (0.82..0.9).contains(&s.center.y)) {
            let room = room_beside(&found, section.center);
            assert!(room > GAP - 2e-4, "{kind:?}: {room} at {}", section.center.y);
        }
    }
}

/// The average bodies of SMPL, which are not shipped.
#[test]
fn average_bodies_have_their_parts_found_and_make_room_between_their_thighs() {
    for name in ["f_smpl_average_A40.obj", "m_smpl_average_A40.obj"] {
        let path = PathBuf::from("../shared/bodies").join(name);
        if !path.exists() {
            println!("skipped: no {}", path.display());
            continue;
        }
        let Body { mannequin: found, notes } = read_body(&path, None).expect(name);
        assert_eq!(found.parts.len(), 6, "{notes:?}");
        assert!(notes.iter().any(|n| n.contains("moved aside")), "{notes:?}");
        let top = found.mesh.vertices.iter().map(|p| p.y).fold(0.0, f64::max);
        for (kind, landmark, [low, high]) in [
            (PartKind::Torso, "crotch", [0.42, 0.5]),
            (PartKind::Torso, "waist", [0.58, 0.68]),
            (PartKind::Neck, "neck base", [0.8, 0.88]),
            (PartKind::LeftArm, "wrist", [0.58, 0.66]),
            (PartKind::RightArm, "wrist", [0.58, 0.66]),
        ] {
            let y = mark(&found, kind, landmark).y / top;
            assert!((low..high).contains(&y), "{name}: {kind:?} {landmark} at {y}");
        }
        let thighs = &found.part(PartKind::LeftLeg).expect("a leg").sections;
        for section in thighs.iter().filter(|s| (0.6..0.74).contains(&s.center.y)) {
            let room = room_beside(&found, section.center);
            assert!(room > GAP - 2e-4, "{name}: {room} at {}", section.center.y);
        }
    }
}

/// A skirt on a body whose thighs nearly meet beside its middle, which is not shipped.
#[test]
fn a_garment_finds_the_parts_of_a_body_whose_thighs_nearly_meet_beside_its_middle() {
    let file = Path::new("../shared/cases/bodies/thighs_off_middle.yaml");
    if !file.exists() {
        println!("skipped: no {}", file.display());
        return;
    }
    let overrides = Overrides { spacing: Some(0.04), ..Overrides::default() };
    let job = Job::new(file, pipeline::read(file).expect("a garment"), &overrides).expect("a job");
    assert_eq!(job.body.parts.len(), 6, "{:?}", job.notes);
}
