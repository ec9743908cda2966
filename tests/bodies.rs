//! Bodies of one's own, read from OBJ.

use std::path::PathBuf;

use toile::geometry::Vec3;
use toile::io::body::{Body, BodyError, body, mannequin_obj, read_body};
use toile::io::obj_read::{ObjSurface, parse_obj};
use toile::mannequin::{BodyFault, Mannequin, MannequinSpec, PartKind, load};

fn child() -> ObjSurface {
    parse_obj(&mannequin_obj(&load("child_110").expect("child")), "child.obj").expect("our own OBJ")
}

fn read(surface: ObjSurface) -> Result<Body, BodyError> {
    body(surface, "child".to_owned(), "child.obj".to_owned())
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
        let back = body(surface, name.to_owned(), name.to_owned()).expect(name).mannequin;
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
    for (scale, unit) in [(1.0, "millimetres"), (0.1, "centimetres"), (1e-3, "metres")] {
        let found = read(turned(|p| p * scale)).expect(unit);
        assert!(found.notes.iter().any(|n| n.starts_with(unit)), "{:?}", found.notes);
        let top = found.mannequin.mesh.vertices.iter().map(|p| p.y).fold(0.0, f64::max);
        assert!((top - 0.951).abs() < 1e-3);
    }
    let found = read(turned(|p| Vec3::new(p.x, -p.z, p.y + 500.0))).expect("z up");
    assert!(found.notes.iter().any(|n| n.contains("z is the tall axis")));
    assert!(found.notes.iter().any(|n| n.starts_with("lowered by 500.1 mm")), "{:?}", found.notes);
    assert!(mark(&found.mannequin, PartKind::LeftArm, "wrist").x > 0.2);
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
    let first = surface.vertices.len() as u32;
    let corners = [Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()];
    surface.vertices.extend(corners.map(|p| p * 50.0 + Vec3::new(0.0, 500.0, 500.0)));
    surface.triangles.extend([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].map(|t| t.map(|v| v + first)));
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
    let found = read_body(&path).expect("mean_all.obj");
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
