//! The shipped mannequins: closed, oriented, symmetric, well meshed, and as large as their files say. The tape here is
//! a slicer of its own that knows nothing of how they are built.

use toile::geometry::{Topology, TriMesh, Vec3};
use toile::mannequin::{Mannequin, MannequinError, MannequinSpec, PartKind, library, load};

/// Millimetres per metre.
const MM: f64 = 1e3;
/// How far a girth may be off, mm.
const GIRTH: f64 = 2.0;

fn shipped() -> Vec<(MannequinSpec, Mannequin)> {
    library().into_iter().map(|n| (MannequinSpec::load(n).expect(n), load(n).expect(n))).collect()
}

/// Where the plane through `at` square to `axis` cuts the mesh: segments.
fn cut(mesh: &TriMesh, at: Vec3, axis: Vec3) -> Vec<[Vec3; 2]> {
    let side = |p: Vec3| (p - at).dot(&axis);
    let mut segments = Vec::new();
    for t in 0..mesh.triangles.len() {
        let c = mesh.corners(t);
        let mut ends = Vec::new();
        for k in 0..3 {
            let (p, q) = (c[k], c[(k + 1) % 3]);
            let (a, b) = (side(p), side(q));
            if (a < 0.0) != (b < 0.0) {
                ends.push(p + (q - p) * (a / (a - b)));
            }
        }
        if let [p, q] = ends[..] {
            segments.push([p, q]);
        }
    }
    segments
}

/// The connected loops of a cut.
fn loops(segments: &[[Vec3; 2]]) -> Vec<Vec<Vec3>> {
    let key = |p: Vec3| [p.x, p.y, p.z].map(|c| (c * 1e9).round() as i64);
    let mut label: std::collections::BTreeMap<[i64; 3], usize> = std::collections::BTreeMap::new();
    let mut group: Vec<usize> = Vec::new();
    fn root(group: &[usize], mut g: usize) -> usize {
        while group[g] != g {
            g = group[g];
        }
        g
    }
    for s in segments {
        let ends = s.map(|p| {
            *label.entry(key(p)).or_insert_with(|| {
                group.push(group.len());
                group.len() - 1
            })
        });
        let (a, b) = (root(&group, ends[0]), root(&group, ends[1]));
        group[a.max(b)] = a.min(b);
    }
    let mut out: std::collections::BTreeMap<usize, Vec<Vec3>> = std::collections::BTreeMap::new();
    for s in segments {
        out.entry(root(&group, label[&key(s[0])])).or_default().extend(s);
    }
    out.into_values().collect()
}

/// Length of a tape round the points, in the plane square to `axis` (the convex hull's perimeter).
fn tape(points: &[Vec3], axis: Vec3) -> f64 {
    let u = if axis.x.abs() < 0.9 { axis.cross(&Vec3::x()) } else { axis.cross(&Vec3::y()) }.normalize();
    let v = axis.cross(&u).normalize();
    let mut flat: Vec<[f64; 2]> = points.iter().map(|p| [p.dot(&u), p.dot(&v)]).collect();
    flat.sort_by(|a, b| a.partial_cmp(b).expect("finite"));
    let half = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut hull: Vec<[f64; 2]> = Vec::new();
        for p in points {
            while let [.., a, b] = hull[..] {
                if (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0.0 {
                    break;
                }
                hull.pop();
            }
            hull.push(p);
        }
        hull.windows(2).map(|w| (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1])).sum::<f64>()
    };
    half(&mut flat.iter().copied()) + half(&mut flat.iter().rev().copied())
}

/// The loop of a horizontal or square cut that goes round `at`.
fn loop_at(mesh: &TriMesh, at: Vec3, axis: Vec3) -> Vec<Vec3> {
    let center = |l: &Vec<Vec3>| l.iter().sum::<Vec3>() / l.len() as f64;
    loops(&cut(mesh, at, axis))
        .into_iter()
        .min_by(|a, b| (center(a) - at).norm().total_cmp(&(center(b) - at).norm()))
        .expect("the plane meets the body")
}

fn part(m: &Mannequin, kind: PartKind) -> &toile::mannequin::BodyPart {
    m.parts.iter().find(|p| p.kind == kind).expect("every mannequin has six parts")
}

fn mark(m: &Mannequin, kind: PartKind, name: &str) -> Vec3 {
    part(m, kind).landmarks.iter().find(|l| l.0 == name).expect(name).1
}

#[track_caller]
fn assert_girth(what: &str, measured: f64, wanted: f64) {
    println!("{what:24} {measured:7.1} {wanted:7.1} {:+5.2}", measured - wanted);
    assert!((measured - wanted).abs() < GIRTH, "{what}: {measured:.1} mm on the mesh, {wanted:.1} in the file");
}

#[test]
fn the_skin_is_closed_manifold_outward_and_symmetric() {
    for (_, m) in shipped() {
        let topology = Topology::new(&m.mesh.triangles);
        assert_eq!(topology.rim_edges().count(), 0, "{}", m.name);
        assert!(topology.non_manifold.is_empty() && topology.misoriented.is_empty(), "{}", m.name);
        // A sphere's: two arms and two legs make no handle, and all is one piece.
        let euler = m.mesh.vertices.len() as i64 - topology.edges.len() as i64 + m.mesh.triangles.len() as i64;
        assert_eq!(euler, 2, "{}", m.name);
        assert!(m.mesh.signed_volume() > 0.0);
        let bits = |p: &Vec3| [p.x + 0.0, p.y, p.z].map(f64::to_bits);
        let all: std::collections::HashSet<_> = m.mesh.vertices.iter().map(bits).collect();
        assert!(m.mesh.vertices.iter().all(|p| all.contains(&bits(&Vec3::new(-p.x, p.y, p.z)))), "{}", m.name);
        let lowest = m.mesh.vertices.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
        assert!(lowest.abs() < 5e-4, "{} stands at {lowest}", m.name);
    }
}

#[test]
fn what_has_legs_stands_on_a_floor() {
    for (_, mut m) in shipped() {
        assert_eq!(m.floor(), Some(0.0), "{}", m.name);
        m.parts.retain(|p| p.kind != PartKind::LeftLeg);
        assert_eq!(m.floor(), None, "{}", m.name);
    }
}

#[test]
fn triangles_are_well_shaped() {
    for (_, m) in shipped() {
        let mut worst = std::f64::consts::PI;
        for t in 0..m.mesh.triangles.len() {
            let c = m.mesh.corners(t);
            for k in 0..3 {
                worst = worst.min((c[(k + 1) % 3] - c[k]).angle(&(c[(k + 2) % 3] - c[k])));
            }
        }
        println!("{} {} triangles, smallest angle {:.1}", m.name, m.mesh.triangles.len(), worst.to_degrees());
        assert!(worst.to_degrees() > 15.0, "{}: {:.1} degrees", m.name, worst.to_degrees());
        assert!((15_000..50_000).contains(&m.mesh.triangles.len()));
    }
}

#[test]
fn torso_and_neck_have_their_girths() {
    for (spec, m) in shipped() {
        let axilla = spec.torso_row("axilla").expect("axilla").y;
        let neck = spec.torso_row("neck base").expect("neck base").y;
        let top = spec.torso.last().expect("rows").y;
        // Between axilla and neck base the arms are in the cut; the top row is where the cap begins.
        for row in spec.torso.iter().filter(|r| r.y <= axilla || (r.y >= neck && r.y < top)) {
            let at = Vec3::new(0.0, row.y / MM, row.z / MM);
            let found = loop_at(&m.mesh, at, Vec3::y());
            // At the crotch the tape goes round both legs, which may be one loop or two.
            let points = if row.name == "crotch" { both_legs(&m.mesh, at) } else { found };
            assert_girth(&format!("{} {}", m.name, row.name), tape(&points, Vec3::y()) * MM, row.girth);
        }
    }
}

/// Points of a horizontal cut without the arms (which hang outside the legs).
fn both_legs(mesh: &TriMesh, at: Vec3) -> Vec<Vec3> {
    let all = loops(&cut(mesh, at, Vec3::y()));
    let inner = |l: &Vec<Vec3>| l.iter().map(|p| p.x.abs()).fold(f64::INFINITY, f64::min);
    all.into_iter().filter(|l| inner(l) < 0.03).flatten().collect()
}

#[test]
fn legs_have_their_girths() {
    for (spec, m) in shipped() {
        for row in &spec.leg.rows {
            for kind in [PartKind::LeftLeg, PartKind::RightLeg] {
                let at = mark(&m, kind, &row.name);
                let girth = tape(&loop_at(&m.mesh, at, Vec3::y()), Vec3::y()) * MM;
                assert_girth(&format!("{} {kind:?} {}", m.name, row.name), girth, row.girth);
            }
        }
    }
}

#[test]
fn arms_have_their_girths() {
    for (spec, m) in shipped() {
        for row in &spec.arm.rows {
            for kind in [PartKind::LeftArm, PartKind::RightArm] {
                let at = mark(&m, kind, &row.name);
                let axis = part(&m, kind).sections[0].axis;
                let girth = tape(&loop_at(&m.mesh, at, axis), axis) * MM;
                assert_girth(&format!("{} {kind:?} {}", m.name, row.name), girth, row.girth);
            }
        }
    }
}

#[test]
fn arms_stand_off_the_torso_at_the_axilla_and_below() {
    for (spec, m) in shipped() {
        let axilla = spec.torso_row("axilla").expect("axilla").y;
        let wrist = mark(&m, PartKind::LeftArm, "wrist").y * MM;
        for y in [axilla, axilla - 20.0, 0.5 * (axilla + wrist)] {
            let all = loops(&cut(&m.mesh, Vec3::new(0.0, y / MM, 0.0), Vec3::y()));
            assert_eq!(all.len(), 3, "{} at {y} mm: two arms and the torso", m.name);
        }
        let above = spec.torso_row("shoulder").expect("shoulder").y;
        assert_eq!(loops(&cut(&m.mesh, Vec3::new(0.0, above / MM, 0.0), Vec3::y())).len(), 1);
        let crotch = spec.torso_row("crotch").expect("crotch").y;
        let below = loops(&cut(&m.mesh, Vec3::new(0.0, (crotch - 15.0) / MM, 0.0), Vec3::y()));
        let legs = below.iter().filter(|l| l.iter().all(|p| p.x.abs() < crotch / MM * 0.25)).count();
        assert_eq!(legs, 2, "{}: the legs part below the crotch", m.name);
    }
}

#[test]
fn sections_lie_on_the_skin() {
    for (_, m) in shipped() {
        let torso = part(&m, PartKind::Torso);
        let waist = mark(&m, PartKind::Torso, "waist");
        let section =
            torso.sections.iter().min_by(|a, b| (a.center - waist).norm().total_cmp(&(b.center - waist).norm()));
        let section = section.expect("sections");
        let points = loop_at(&m.mesh, section.center, section.axis);
        let width = points.iter().map(|p| p.x).fold(0.0, f64::max);
        assert!((width - section.half_width).abs() < 1e-3, "{}: {width} {}", m.name, section.half_width);
        assert!((tape(&points, section.axis) - section.girth).abs() < 2e-3);
        for p in &m.parts {
            assert!(p.sections.len() > 2, "{:?}", p.kind);
            let gaps = p.sections.windows(2).map(|w| (w[1].center - w[0].center).norm());
            assert!(gaps.fold(0.0, f64::max) < 0.03, "{:?}", p.kind);
        }
    }
}

#[test]
fn the_same_spec_gives_the_same_bytes() {
    assert_eq!(load("child_110").expect("child").mesh, load("child_110").expect("child").mesh);
}

#[test]
fn an_unknown_name_lists_the_known_ones() {
    let error = load("woman").expect_err("no such mannequin").to_string();
    assert!(error.contains("'woman'") && error.contains("woman_92, man_100, child_110"), "{error}");
}

#[test]
fn wrong_numbers_are_refused() {
    let text = include_str!("../mannequins/child_110.yaml");
    for (from, to, expected) in [
        ("girth: 560", "girth: .nan", "'waist'"),
        ("y: 660", "y: 900", "do not rise"),
        ("y: 660", "y: 700000", "numbers are millimetres"),
        ("girth: 185", "girth: -185", "'biceps'"),
        ("n: 2.12", "n: 0.5", "n = 0.5"),
        ("name: hip", "name: hips", "'hip'"),
        ("forward: 4", "forwards: 4", "forwards"),
        ("name: child_110", "name: \"child\\nv 0 0 0\"", "more than one line"),
    ] {
        let error = MannequinSpec::parse(&text.replacen(from, to, 1), "mine.yaml").expect_err(to);
        let said = error.to_string();
        assert!(said.starts_with("mine.yaml") && said.contains(expected), "{said}");
        assert!(matches!(error, MannequinError::Value { .. } | MannequinError::Syntax { .. }));
    }
}
