//! The girths of the fit against a tape that shares no code with them: `garment.obj` and the body are cut by planes
//! here, and the cut is measured.

use std::collections::HashMap;
use std::f64::consts::TAU;
use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::{Value, json};
use toile::geometry::{TriMesh, Vec3};
use toile::io::body::load_body_of;
use toile::mannequin::{Mannequin, Measures, PartKind};

/// A tape and the report may differ by this, mm.
const CLOSE: f64 = 1.0;

/// Cloth whose ends are nearer than this is sewn together, mm: gaps of seams are smaller.
const SEWN: f64 = 1.2;

/// Ends nearer than this, mm, are one point of an edge between two triangles.
const SAME: f64 = 1e-6;

/// A point of a cut, mm, in a frame of the plane round the part's middle.
type Flat = [f64; 2];

/// A plane, and the middle of the part in it. Millimetres.
struct Plane {
    at: Vec3,
    axis: Vec3,
    u: Vec3,
    v: Vec3,
}

impl Plane {
    fn new(at: Vec3, axis: Vec3) -> Self {
        let u = axis.cross(&if axis.x.abs() < 0.6 { Vec3::x() } else { Vec3::z() }).normalize();
        Self { at, axis, u, v: axis.cross(&u) }
    }

    /// The segments in which it cuts triangles.
    fn cut(&self, mesh: &TriMesh) -> Vec<[Flat; 2]> {
        let off = |p: &Vec3| (p - self.at).dot(&self.axis);
        let flat = |p: Vec3| [(p - self.at).dot(&self.u), (p - self.at).dot(&self.v)];
        let segment = |corners: &[u32; 3]| {
            let p = corners.map(|c| mesh.vertices[c as usize]);
            let ends: Vec<Flat> = (0..3)
                .filter(|&k| (off(&p[k]) < 0.0) != (off(&p[(k + 1) % 3]) < 0.0))
                .map(|k| {
                    let (a, b) = (p[k], p[(k + 1) % 3]);
                    flat(a + (b - a) * (off(&a) / (off(&a) - off(&b))))
                })
                .collect();
            ends.try_into().ok()
        };
        mesh.triangles.iter().filter_map(segment).collect()
    }
}

fn far(p: Flat, q: Flat) -> f64 {
    (p[0] - q[0]).hypot(p[1] - q[1])
}

fn root(parent: &mut [usize], mut k: usize) -> usize {
    while parent[k] != k {
        parent[k] = parent[parent[k]];
        k = parent[k];
    }
    k
}

/// Segments that hang together. An end at the edge of a piece is joined to cloth nearer than `SEWN`; cloth that touches
/// cloth between its edges, as a sleeve does the trunk, is not.
fn strands(segments: &[[Flat; 2]]) -> Vec<Vec<[Flat; 2]>> {
    let cell = |p: Flat| p.map(|x| (x / SEWN).floor() as i64);
    let mut near: HashMap<[i64; 2], Vec<(usize, Flat)>> = HashMap::new();
    for (k, segment) in segments.iter().enumerate() {
        segment.iter().for_each(|&p| near.entry(cell(p)).or_default().push((k, p)));
    }
    let around = |p: Flat| {
        let [x, y] = cell(p);
        let cells = (-1..=1).flat_map(move |dx| (-1..=1).map(move |dy| [x + dx, y + dy]));
        cells.filter_map(|c| near.get(&c)).flatten().filter(move |(_, q)| far(p, *q) < SEWN)
    };
    let is_edge = |k: usize, p: Flat| around(p).all(|&(other, q)| other == k || far(p, q) >= SAME);
    let mut parent: Vec<usize> = (0..segments.len()).collect();
    for (k, segment) in segments.iter().enumerate() {
        for &p in segment {
            for &(other, q) in around(p) {
                if far(p, q) < SAME || is_edge(k, p) || is_edge(other, q) {
                    let (a, b) = (root(&mut parent, k), root(&mut parent, other));
                    parent[a] = b;
                }
            }
        }
    }
    let mut out: HashMap<usize, Vec<[Flat; 2]>> = HashMap::new();
    for (k, segment) in segments.iter().enumerate() {
        out.entry(root(&mut parent, k)).or_default().push(*segment);
    }
    out.into_values().collect()
}

/// Distances from the middle at which a ray in a direction meets segments, the nearest first.
fn met(strand: &[[Flat; 2]], angle: f64) -> Vec<f64> {
    let (sin, cos) = angle.sin_cos();
    let mut out: Vec<f64> = strand
        .iter()
        .filter_map(|&[p, q]| {
            let side = |r: Flat| cos * r[1] - sin * r[0];
            let along = |r: Flat| cos * r[0] + sin * r[1];
            let (s, t) = (side(p), side(q));
            let at = along(p) + (along(q) - along(p)) * (s / (s - t));
            ((s < 0.0) != (t < 0.0) && at > 0.0).then_some(at)
        })
        .collect();
    out.sort_by(f64::total_cmp);
    out
}

/// A garment is said to go round a part where its cloth is open by less than this, mm (`verify::ring`).
const BRIDGED: f64 = 30.0;

/// Rays of a tape that finds the innermost layer.
const RAYS: u32 = 3600;

/// The angle of a ray, radians: none runs through a vertex.
fn angle(k: u32) -> f64 {
    TAU * (f64::from(k) + 0.37) / f64::from(RAYS)
}

/// The strand's cloth once round the middle. `None` if it does not go round it.
///
/// A ray from the middle meets a single layer an odd number of times, be it folded or not: then the strand's length
/// counts. Where layers lap over each other the innermost ones count, seen from the middle.
fn once_round(strand: &[[Flat; 2]]) -> Option<f64> {
    /// Share of rays that may slip through the gaps of seams.
    const SLIP: f64 = 0.015;
    let rays: Vec<Vec<f64>> = (0..RAYS).map(|k| met(strand, angle(k))).collect();
    let share = |of: &dyn Fn(&Vec<f64>) -> bool| rays.iter().filter(|ray| of(ray)).count() as f64 / f64::from(RAYS);
    if share(&|ray| ray.is_empty()) > SLIP {
        return None;
    }
    if share(&|ray| ray.len() % 2 == 0) <= SLIP {
        return Some(strand.iter().map(|[p, q]| far(*p, *q)).sum());
    }
    let inner: Vec<Flat> = (0..RAYS)
        .zip(&rays)
        .filter_map(|(k, ray)| ray.first().map(|r| [r * angle(k).cos(), r * angle(k).sin()]))
        .collect();
    Some((0..inner.len()).map(|k| far(inner[k], inner[(k + 1) % inner.len()])).sum())
}

/// How far the cloth of a strand is open round the middle, mm: at a hem a level tape runs off it.
fn open(strand: &[[Flat; 2]]) -> f64 {
    let rays = (0..RAYS).map(|k| met(strand, angle(k)));
    let met: Vec<f64> = rays.filter_map(|ray| ray.first().copied()).collect();
    let missed = 1.0 - met.len() as f64 / f64::from(RAYS);
    missed * TAU * met.iter().sum::<f64>() / met.len().max(1) as f64
}

/// Length of a thread drawn tight round points (their convex hull, by gift wrapping).
fn hull(points: &[Flat]) -> f64 {
    let start = *points.iter().min_by(|a, b| a[0].total_cmp(&b[0])).expect("points");
    let (mut here, mut length) = (start, 0.0);
    loop {
        let left = |p: Flat, q: Flat| (p[0] - here[0]) * (q[1] - here[1]) - (p[1] - here[1]) * (q[0] - here[0]);
        let others = points.iter().copied().filter(|p| far(*p, here) > 1e-9);
        let next = others.reduce(|best, p| if left(best, p) < 0.0 { p } else { best }).expect("two points");
        length += far(here, next);
        here = next;
        if far(here, start) < 1e-9 {
            return length;
        }
    }
}

/// The landmark that a row is named after (mm), and the direction along the part there.
fn place(body: &Mannequin, name: &str) -> (Vec3, Vec3) {
    let (kind, landmark) = match name.split_once(' ') {
        Some(("left", rest)) if matches!(rest, "thigh" | "knee" | "calf") => (PartKind::LeftLeg, rest),
        Some(("right", rest)) if matches!(rest, "thigh" | "knee" | "calf") => (PartKind::RightLeg, rest),
        Some(("left", rest)) => (PartKind::LeftArm, rest),
        Some(("right", rest)) => (PartKind::RightArm, rest),
        _ if name == "neck" => (PartKind::Neck, "neck base"),
        _ => (PartKind::Torso, name),
    };
    let part = body.part(kind).expect("a part");
    let at = part.landmarks.iter().find(|mark| mark.0 == landmark).expect("a landmark").1;
    let off = |center: &Vec3| (center - at).norm();
    let nearest = part.sections.iter().min_by(|a, b| off(&a.center).total_cmp(&off(&b.center))).expect("a section");
    (1e3 * at, nearest.axis)
}

/// The surface of an OBJ, mm.
fn surface(file: &Path) -> TriMesh {
    let text = fs::read_to_string(file).expect("an OBJ");
    let mut mesh = TriMesh::default();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let p: Vec<f64> = words.map(|w| w.parse().expect("a number")).collect();
                mesh.vertices.push(Vec3::new(p[0], p[1], p[2]));
            }
            Some("f") => {
                let corner = |w: &str| w.split('/').next().and_then(|n| n.parse::<u32>().ok()).expect("a corner") - 1;
                let t: Vec<u32> = words.map(corner).collect();
                mesh.triangles.push([t[0], t[1], t[2]]);
            }
            _ => {}
        }
    }
    mesh
}

/// Drapes a garment of `patterns/` on its own body with other measures, and compares each row of its fit.
fn check(garment: &str, mannequin: &str, measures: &[(&str, f64)]) {
    let room = tempfile::tempdir().expect("a folder");
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("patterns").join(garment).with_extension("yaml");
    let mut command = Command::new(env!("CARGO_BIN_EXE_toile"));
    command.arg("drape").arg(file).arg("-o").arg(room.path()).args(["--spacing", "20", "-q"]);
    let mut given = Measures::default();
    if !measures.is_empty() {
        let map: serde_json::Map<String, Value> = measures.iter().map(|(n, mm)| ((*n).to_owned(), json!(mm))).collect();
        command.arg("--measures").arg(Value::Object(map).to_string());
        measures.iter().for_each(|(name, mm)| given.add(name, *mm).expect("a measure"));
    }
    // A garment may be out of its own bounds on another body.
    let status = command.status().expect("started");
    assert!(matches!(status.code(), Some(0 | 1)), "{garment}: {status}");
    let report: Value =
        serde_json::from_str(&fs::read_to_string(room.path().join("report.json")).expect("a report")).expect("JSON");
    let cloth = surface(&room.path().join("garment.obj"));
    let body = load_body_of(mannequin, None, &given).expect("a body").mannequin;
    let mut skin = body.mesh.clone();
    skin.vertices.iter_mut().for_each(|p| *p *= 1e3);
    let rows = report["fit"]["girths"].as_array().expect("girths");
    // A skirt that is too narrow is worn lower.
    assert!(rows.len() >= if measures.is_empty() { 3 } else { 2 }, "{garment}: {} rows", rows.len());
    for row in rows {
        let number = |key: &str| row[key].as_f64().expect("a number");
        let name = row["name"].as_str().expect("a name");
        let (mark, axis) = place(&body, name);
        // Of the trunk the cloth is measured below the armholes.
        let level = Vec3::new(mark.x, number("height"), mark.z);
        let own = strands(&Plane::new(level, axis).cut(&cloth));
        let bare = strands(&Plane::new(mark, axis).cut(&skin));
        let round = bare.iter().find(|s| once_round(s).is_some()).expect("skin round the part");
        let body_taped = hull(&round.iter().flatten().copied().collect::<Vec<_>>());
        assert!((number("body") - body_taped).abs() < CLOSE, "{garment}, {name}: {body_taped} mm, said {row}");
        let Some(taped) = own.iter().filter_map(|s| once_round(s)).reduce(f64::min) else {
            let open = own.iter().filter(|s| !s.is_empty()).map(|s| open(s)).fold(f64::INFINITY, f64::min);
            println!("{garment} {measures:?} {name}: open by {open:.1} mm");
            assert!(open < BRIDGED, "{garment}, {name}: open by {open} mm, said {row}");
            continue;
        };
        println!(
            "{garment} {measures:?} {name}: garment {:.2}, taped {taped:.2}; body {:.2}, taped {body_taped:.2}",
            number("garment"),
            number("body")
        );
        assert!((number("garment") - taped).abs() < CLOSE, "{garment}, {name}: the cloth is {taped} mm, said {row}");
        assert!((number("ease") - (taped - body_taped)).abs() < 2.0 * CLOSE, "{garment}, {name}: {row}");
    }
}

#[test]
fn the_tape_measures_what_is_known() {
    // A tube that is folded (a star), one that laps by a tenth of a turn, and a thread round a square.
    let ring = |turns: f64, at: &dyn Fn(f64) -> f64| -> Vec<[Flat; 2]> {
        let point = |k: u32| {
            let share = turns * f64::from(k) / 900.0;
            let r = at(share);
            [r * (TAU * share).cos(), r * (TAU * share).sin()]
        };
        (0..900).map(|k| [point(k), point(k + 1)]).collect()
    };
    let round = once_round(&ring(1.0, &|_| 150.0)).expect("closed");
    assert!((round - 300.0 * TAU / 2.0).abs() < 0.1, "{round}");
    let star = ring(1.0, &|share| 150.0 + 20.0 * (9.0 * TAU * share).cos());
    let length: f64 = star.iter().map(|[p, q]| far(*p, *q)).sum();
    assert!((once_round(&star).expect("closed") - length).abs() < 1e-9 && length > 1.25 * round);
    let lapped = once_round(&ring(1.1, &|share| 150.0 + 0.5 * share)).expect("closed");
    assert!((lapped - round).abs() < 3.0, "{lapped}");
    assert_eq!(once_round(&ring(0.9, &|_| 150.0)), None);
    assert!((hull(&[[0.0, 0.0], [3.0, 1.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0], [5.0, 5.0]]) - 40.0).abs() < 1e-9);
}

#[test]
fn a_t_shirt_on_three_bodies() {
    check("tshirt", "woman_92", &[]);
    check("tshirt", "woman_92", &[("bust", 1000.0), ("waist", 815.0), ("hip", 1050.0)]);
    check("tshirt", "woman_92", &[("bust", 840.0), ("waist", 660.0), ("hip", 895.0)]);
}

#[test]
fn a_skirt_on_two_bodies() {
    check("gore_skirt", "woman_92", &[]);
    check("gore_skirt", "woman_92", &[("waist", 815.0), ("hip", 1050.0)]);
}

#[test]
fn two_dresses() {
    check("sheath_dress", "woman_92", &[]);
    check("child_dress", "child_110", &[]);
}
