//! GarmentCode specifications: what comes out has their lengths, their seams and their sides. The curves are measured
//! here by sampling their definitions, with no code of the program.

use std::f64::consts::TAU;
use std::path::PathBuf;

use serde_json::{Value, json};
use toile::geometry::Vec2;
use toile::io::garment::{read_text, write};
use toile::io::garmentcode::{ImportError, Wearer, read};
use toile::mesh::build;
use toile::pattern::{Garment, Give, PieceFile, PlaceFile, SeamKind};

/// A front and a back in centimetres, half of each, with every kind of curve, and a band over the back.
fn specification() -> Value {
    let line = |a: usize, b: usize| json!({"endpoints": [a, b]});
    let curved = |a: usize, b: usize, c: Value| json!({"endpoints": [a, b], "curvature": c});
    let half = |front: bool, side: f64| {
        let corners = [[0.0, 0.0], [side * 25.0, 0.0], [side * 25.0, 30.0], [side * 17.0, 50.0], [side * 9.0, 52.0]];
        let mut vertices: Vec<[f64; 2]> = corners.to_vec();
        vertices.push([0.0, if front { 40.0 } else { 48.0 }]);
        let edge = |k: usize| {
            let next = (k + 1) % 6;
            match k {
                1 => curved(1, 2, json!([0.5, -0.02 * side])),
                2 => curved(2, 3, json!({"type": "cubic", "params": [[0.3, 0.2 * side], [0.6, 0.25 * side]]})),
                4 => curved(4, 5, json!({"type": "circle", "params": [16.0, 0, if side > 0.0 { 0 } else { 1 }]})),
                _ => line(k, next),
            }
        };
        let mut edges: Vec<Value> = (0..6).map(edge).collect();
        // A front runs counter-clockwise, a back clockwise: its right side looks backward.
        if (side > 0.0) != front {
            edges = reversed(&edges);
        }
        let z = if front { 20.0 } else { -20.0 };
        json!({"translation": [0, 90, z], "rotation": [0, 0, 0], "vertices": vertices, "edges": edges, "label": "body"})
    };
    // Edge k of a reversed loop of six is 5 − k.
    let stitch = |a: (&str, usize), b: (&str, usize)| json!([{"panel": a.0, "edge": a.1}, {"panel": b.0, "edge": b.1}]);
    json!({
        "pattern": {
            "panels": {
                "left_ftorso": half(true, 1.0), "right_ftorso": half(true, -1.0),
                "left_btorso": half(false, 1.0), "right_btorso": half(false, -1.0),
            },
            "stitches": [
                stitch(("left_ftorso", 5), ("right_ftorso", 0)), stitch(("left_btorso", 0), ("right_btorso", 5)),
                stitch(("left_ftorso", 1), ("left_btorso", 4)), stitch(("right_ftorso", 4), ("right_btorso", 1)),
                stitch(("left_ftorso", 3), ("left_btorso", 2)), stitch(("right_ftorso", 2), ("right_btorso", 3)),
            ],
        },
        "properties": {"curvature_coords": "relative", "units_in_meter": 100},
    })
}

/// The same loop the other way round.
fn reversed(edges: &[Value]) -> Vec<Value> {
    let turn = |e: &Value| {
        let ends = [e["endpoints"][1].clone(), e["endpoints"][0].clone()];
        let mut out = json!({"endpoints": ends});
        if let Some(c) = e.get("curvature") {
            // Seen from the other end a point at (x, y) is at (1 − x, −y).
            let back = |p: &Value| json!([1.0 - p[0].as_f64().expect("x"), -p[1].as_f64().expect("y")]);
            out["curvature"] = match (c.get("type").and_then(Value::as_str), c.get("params")) {
                (Some("cubic"), Some(p)) => json!({"type": "cubic", "params": [back(&p[1]), back(&p[0])]}),
                (Some("circle"), Some(p)) => {
                    json!({"type": "circle", "params": [p[0], p[1], 1 - p[2].as_i64().expect("0 or 1")]})
                }
                _ => back(c),
            };
        }
        out
    };
    edges.iter().rev().map(turn).collect()
}

/// Points of an edge in its panel, millimetres, from the definition of the format.
fn sampled(panel: &Value, edge: &Value, unit: f64) -> Vec<Vec2> {
    let vertex = |k: &Value| {
        let v = &panel["vertices"][k.as_u64().expect("an index") as usize];
        unit * Vec2::new(v[0].as_f64().expect("x"), v[1].as_f64().expect("y"))
    };
    let (a, b) = (vertex(&edge["endpoints"][0]), vertex(&edge["endpoints"][1]));
    let e = b - a;
    let point = |p: &Value| a + p[0].as_f64().expect("x") * e + p[1].as_f64().expect("y") * Vec2::new(-e.y, e.x);
    let n = 4_000;
    let bezier = |control: &[Vec2]| {
        (0..=n)
            .map(|i| {
                let mut points = control.to_vec();
                let t = f64::from(i) / f64::from(n);
                while points.len() > 1 {
                    points = points.windows(2).map(|w| w[0] + t * (w[1] - w[0])).collect();
                }
                points[0]
            })
            .collect()
    };
    let Some(curvature) = edge.get("curvature").filter(|c| !c.is_null()) else { return vec![a, b] };
    let params = &curvature["params"];
    match curvature.get("type").and_then(Value::as_str) {
        None => bezier(&[a, point(curvature), b]),
        Some("quadratic") => bezier(&[a, point(&params[0]), b]),
        Some("cubic") => bezier(&[a, point(&params[0]), point(&params[1]), b]),
        Some("circle") => {
            let yes = |k: usize| params[k].as_f64().map_or_else(|| params[k].as_bool() == Some(true), |x| x != 0.0);
            let (large, positive) = (yes(1), yes(2));
            let r = (unit * params[0].as_f64().expect("a radius")).max(0.5 * e.norm());
            // Of the two centres the one from which the arc turns the way it says.
            let h = (r * r - 0.25 * e.norm_squared()).max(0.0).sqrt();
            let across = Vec2::new(-e.y, e.x) / e.norm();
            let center = a + 0.5 * e + if large == positive { -h } else { h } * across;
            let angle = |p: Vec2| (p - center).y.atan2((p - center).x);
            let mut sweep = (angle(b) - angle(a)).rem_euclid(TAU);
            if !positive {
                sweep -= TAU;
            }
            let at = |i: i32| angle(a) + sweep * f64::from(i) / f64::from(n);
            (0..=n).map(|i| center + r * Vec2::new(at(i).cos(), at(i).sin())).collect()
        }
        Some(other) => panic!("{other}"),
    }
}

fn length(points: &[Vec2]) -> f64 {
    points.windows(2).map(|w| (w[1] - w[0]).norm()).sum()
}

/// Lengths of a panel's edges in order, millimetres.
fn lengths(spec: &Value, panel: &str) -> Vec<f64> {
    let unit = 1000.0 / spec["properties"]["units_in_meter"].as_f64().unwrap_or(100.0);
    let panel = &spec["pattern"]["panels"][panel];
    panel["edges"].as_array().expect("edges").iter().map(|e| length(&sampled(panel, e, unit))).collect()
}

/// Area inside a panel, square millimetres.
fn area(spec: &Value, panel: &str) -> f64 {
    let unit = 1000.0 / spec["properties"]["units_in_meter"].as_f64().unwrap_or(100.0);
    let panel = &spec["pattern"]["panels"][panel];
    let edges = panel["edges"].as_array().expect("edges");
    let points: Vec<Vec2> = edges.iter().flat_map(|e| sampled(panel, e, unit)).collect();
    0.5 * (0..points.len()).map(|k| points[k].perp(&points[(k + 1) % points.len()])).sum::<f64>().abs()
}

fn import(spec: &Value) -> (Garment, Vec<PieceFile>) {
    let file = read("trial", &spec.to_string(), Wearer::default()).expect("a specification");
    let text = write(&file).expect("YAML");
    let loaded = read_text("trial", "trial.yaml", &text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    assert_eq!(loaded.file, file, "reads as it was written");
    (loaded.garment, file.pieces)
}

/// Whether two lists of lengths are the same going round, in either sense.
fn same_round(one: &[f64], other: &[f64], within: f64) -> bool {
    let n = one.len();
    let near = |a: f64, b: f64| (a - b).abs() <= within;
    n == other.len()
        && (0..n).any(|s| {
            (0..n).all(|k| near(one[k], other[(s + k) % n])) || (0..n).all(|k| near(one[k], other[(s + n - k) % n]))
        })
}

/// Every panel is a piece with its lengths to 0.01 mm and its area to a ten-thousandth (points are written
/// to the micrometre), and every stitch is in a seam that has its length.
fn check_lengths(spec: &Value, garment: &Garment) {
    let panels = spec["pattern"]["panels"].as_object().expect("panels");
    assert_eq!(garment.pieces.len(), panels.len());
    let mut free: Vec<Vec<f64>> =
        garment.pieces.iter().map(|p| p.loops[0].iter().map(|e| 1e3 * e.path.length()).collect()).collect();
    let mut areas: Vec<f64> = garment.pieces.iter().map(|p| 1e6 * p.area()).collect();
    let mut sewn = [0.0; 2];
    for name in panels.keys() {
        let (expected, inside) = (lengths(spec, name), area(spec, name));
        let is_it = |(f, a): (&Vec<f64>, &f64)| same_round(&expected, f, 0.01) && (a - inside).abs() < 1e-4 * inside;
        let found = free.iter().zip(&areas).position(is_it);
        let found = found.unwrap_or_else(|| panic!("no piece has the edges of {name}: {expected:?}, and {inside} mm²"));
        free.swap_remove(found);
        areas.swap_remove(found);
    }
    for stitch in spec["pattern"]["stitches"].as_array().expect("stitches") {
        for end in &stitch.as_array().expect("ends")[..2] {
            let panel = end["panel"].as_str().expect("a panel");
            sewn[0] += lengths(spec, panel)[end["edge"].as_u64().expect("an edge") as usize];
        }
    }
    for seam in &garment.seams {
        assert_eq!(seam.kind, SeamKind::Written);
        sewn[1] += 1e3 * (seam.length_a() + seam.length_b());
    }
    assert!((sewn[0] - sewn[1]).abs() < 0.01 * garment.seams.len() as f64, "{sewn:?} mm sewn");
}

#[test]
fn every_curve_keeps_its_length_and_mirrored_panels_are_pairs() {
    let spec = specification();
    let (garment, pieces) = import(&spec);
    check_lengths(&spec, &garment);
    let names: Vec<&str> = garment.pieces.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["front.L", "front.R", "back.L", "back.R"]);
    let edges: Vec<&str> = garment.pieces[0].loops[0].iter().map(|e| e.name.as_str()).collect();
    assert_eq!(edges, ["center", "neck", "shoulder", "armhole", "side", "hem"]);
    assert!(matches!(&pieces[1].place.as_ref().expect("a place").value, PlaceFile::Words(w) if w == "torso back"));
    let seams: Vec<&str> = garment.seams.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(seams, ["front_center", "back_center", "side.L", "side.R", "shoulder.L", "shoulder.R"]);
}

#[test]
fn sides_of_a_piece_are_where_its_wearer_has_them() {
    let (garment, _) = import(&specification());
    // Seen from outside the wearer's left is at larger x on a front and at smaller x on a back.
    for (piece, sign) in garment.pieces.iter().zip([1.0, -1.0, -1.0, 1.0]) {
        let xs = piece.loops[0].iter().map(|e| e.path.start().x);
        assert!(xs.clone().all(|x| sign * x > -1e-9) && xs.clone().any(|x| sign * x > 0.2), "{}", piece.name);
    }
}

#[test]
fn other_units_and_absolute_control_points_are_the_same_garment() {
    let spec = specification();
    let mut inches = spec.clone();
    inches["properties"]["units_in_meter"] = json!(1000.0 / 25.4);
    let scale = 25.4 / 10.0;
    let (centimetres, _) = import(&spec);
    let (large, _) = import(&inches);
    for (a, b) in centimetres.pieces.iter().zip(&large.pieces) {
        for (a, b) in a.loops[0].iter().zip(&b.loops[0]) {
            let (a, b) = (1e3 * scale * a.path.length(), 1e3 * b.path.length());
            // Only the arc, whose radius is in units too, must scale like everything else.
            assert!((a - b).abs() < 0.03, "{a} {b}");
        }
    }
}

/// Turns are degrees whatever lengths are: every back is turned by 180 of them.
#[test]
fn a_panel_that_is_turned_is_read_in_any_unit() {
    let mut metres = specification();
    metres["properties"]["units_in_meter"] = json!(1);
    for panel in metres["pattern"]["panels"].as_object_mut().expect("panels").values_mut() {
        for list in ["vertices", "translation"] {
            scale(&mut panel[list], 0.01);
        }
    }
    for back in ["left_btorso", "right_btorso"] {
        metres["pattern"]["panels"][back]["rotation"] = json!([0, 180, 0]);
    }
    assert_eq!(import(&metres).0.pieces.len(), 4);
}

fn scale(value: &mut Value, by: f64) {
    match value {
        Value::Array(values) => values.iter_mut().for_each(|v| scale(v, by)),
        number => *number = json!(number.as_f64().expect("a number") * by),
    }
}

#[test]
fn a_longer_edge_is_eased_or_gathered_and_says_so() {
    let mut spec = specification();
    for panel in ["left_ftorso", "right_ftorso"] {
        for v in spec["pattern"]["panels"][panel]["vertices"].as_array_mut().expect("vertices") {
            v[1] = json!(v[1].as_f64().expect("y") * 1.05);
        }
    }
    let (garment, _) = import(&spec);
    check_lengths(&spec, &garment);
    let side = garment.seams.iter().find(|s| s.name == "side.L").expect("a side seam");
    assert!(matches!(side.give, Give::Ease(extra) if extra > 0.010 && extra < 0.016), "{:?}", side.give);
}

/// A front and a back sewn at their sides, the lowest `slit` (centimetres) of the left side open on both: edge 1.
fn slit_skirt(slit: [f64; 2]) -> Value {
    let panel = |depth: f64, z: f64| {
        let corners = [[0.0, 0.0], [40.0, 0.0], [40.0, depth], [40.0, 50.0], [0.0, 50.0]];
        let edges: Vec<Value> = (0..5).map(|k| json!({"endpoints": [k, (k + 1) % 5]})).collect();
        json!({"translation": [-20, 50, z], "rotation": [0, 0, 0], "vertices": corners, "edges": edges})
    };
    let stitch = |k: usize| json!([{"panel": "skirt_front", "edge": k}, {"panel": "skirt_back", "edge": k}]);
    json!({
        "pattern": {
            "panels": {"skirt_front": panel(slit[0], 20.0), "skirt_back": panel(slit[1], -20.0)},
            "stitches": [stitch(2), stitch(4)],
        },
    })
}

#[test]
fn edges_too_short_to_be_meshed_are_left_out() {
    let shape = |spec: &Value| {
        let (garment, _) = import(spec);
        build(&garment, 0.020).expect("every edge is long enough");
        let edges = garment.pieces.iter().map(|p| p.loops[0].len()).collect();
        (edges, garment.seams.iter().map(|s| 1e3 * s.length_a()).collect())
    };
    let [free, real] = [[0.001; 2], [1.0; 2]].map(slit_skirt);
    let mut sewn = free.clone();
    let ends = json!([{"panel": "skirt_front", "edge": 1}, {"panel": "skirt_back", "edge": 1}]);
    sewn["pattern"]["stitches"].as_array_mut().expect("stitches").push(ends);
    for spec in [&free, &sewn] {
        let (edges, seams): (Vec<usize>, Vec<f64>) = shape(spec);
        assert_eq!(edges, [4, 4]);
        assert!(seams.len() == 2 && seams.iter().all(|mm| (mm - 500.0).abs() < 1e-3), "{seams:?}");
    }
    assert_eq!(shape(&real).0, [5, 5]);
}

#[test]
fn a_short_edge_that_is_sewn_to_a_long_one_stays_for_its_author_to_see() {
    let mut spec = slit_skirt([0.0015, 1.0]);
    let ends = json!([{"panel": "skirt_front", "edge": 1}, {"panel": "skirt_back", "edge": 1}]);
    spec["pattern"]["stitches"].as_array_mut().expect("stitches").push(ends);
    let (garment, _) = import(&spec);
    let refused = build(&garment, 0.020).map(|_| ()).expect_err("a short edge").to_string();
    assert!(refused.contains("is only 0.01 mm long"), "{refused}");
}

#[test]
fn what_is_wrong_is_named() {
    let broken = |change: &dyn Fn(&mut Value)| {
        let mut spec = specification();
        change(&mut spec);
        read("trial", &spec.to_string(), Wearer::default()).expect_err("an error").to_string()
    };
    let edge = |spec: &mut Value, k: usize, key: &str, value: Value| {
        spec["pattern"]["panels"]["left_ftorso"]["edges"][k][key] = value;
    };
    let cases: [(&str, String); 11] = [
        (
            "panel 'left_ftorso', edge 1: ends at vertex 3, but the next edge starts at vertex 2",
            broken(&|s| edge(s, 1, "endpoints", json!([1, 3]))),
        ),
        (
            "panel 'left_ftorso', edge 4: has the unknown curvature 'spline'; known are quadratic, cubic and circle",
            broken(&|s| edge(s, 4, "curvature", json!({"type": "spline", "params": []}))),
        ),
        (
            "panel 'left_ftorso', edge 4: its curvature 'circle' needs three numbers: radius, large arc, direction",
            broken(&|s| edge(s, 4, "curvature", json!({"type": "circle", "params": [3]}))),
        ),
        (
            "panel 'left_ftorso', edge 2: its curvature 'cubic' needs two control points",
            broken(&|s| edge(s, 2, "curvature", json!({"type": "cubic", "params": [[0.1, 0.2]]}))),
        ),
        ("stitch 0: no panel 'front'", broken(&|s| s["pattern"]["stitches"][0][0]["panel"] = json!("front"))),
        (
            "stitch 0: panel 'left_ftorso' has 6 edges, no edge 9",
            broken(&|s| s["pattern"]["stitches"][0][0]["edge"] = json!(9)),
        ),
        (
            "stitch 2: edge 5 of 'left_ftorso' is sewn by stitch 0 already",
            broken(&|s| s["pattern"]["stitches"][2][0]["edge"] = json!(5)),
        ),
        (
            "stitch 1: says \"wrong_wrong\"; only \"right_wrong\" is known",
            broken(&|s| s["pattern"]["stitches"][1].as_array_mut().expect("ends").push(json!("wrong_wrong"))),
        ),
        (
            "units_in_meter must be above zero, not 0; GarmentCode writes 100 for centimetres",
            broken(&|s| s["properties"]["units_in_meter"] = json!(0)),
        ),
        ("curvature_coords 'polar' is not known; use relative or absolute", {
            broken(&|s| s["properties"]["curvature_coords"] = json!("polar"))
        }),
        ("panel 'left_ftorso' holds a number beyond 100 m", {
            broken(&|s| s["pattern"]["panels"]["left_ftorso"]["vertices"][0][0] = json!(1e9))
        }),
    ];
    for (expected, found) in cases {
        assert_eq!(found, expected);
    }
    assert!(matches!(read("trial", "{", Wearer::default()), Err(ImportError::Json(_))));
    assert!(matches!(read("trial", "{\"garment\": 1}", Wearer::default()), Err(ImportError::NoPattern)));
}

#[test]
fn garments_of_the_program_itself_keep_lengths_and_sew_every_stitch() {
    let Some(specifications) = specifications() else { return };
    assert_eq!(specifications.len(), 10);
    for (_, text) in specifications {
        let spec: Value = serde_json::from_str(&text).expect("JSON");
        let (garment, _) = import(&spec);
        check_lengths(&spec, &garment);
    }
}

fn folder() -> PathBuf {
    std::env::var_os("TOILE_GARMENTCODE").map_or("../shared/garmentcode".into(), PathBuf::from)
}

/// Names and texts of the program's own garments; `None`, saying so, where they are not.
fn specifications() -> Option<Vec<(String, String)>> {
    let folder = folder();
    let Ok(entries) = std::fs::read_dir(&folder) else {
        eprintln!("skipped: {} is not here", folder.display());
        return None;
    };
    let text = |entry: std::fs::DirEntry| {
        let name = entry.file_name().to_string_lossy().into_owned();
        let file = entry.path().join(format!("{name}_specification.json"));
        (name, std::fs::read_to_string(file).expect("a file"))
    };
    Some(entries.filter_map(Result::ok).filter(|e| e.path().is_dir()).map(text).collect())
}

/// A rectangular panel, centimetres: its lower left corner is the origin of its own frame.
fn rectangle(width: f64, height: f64, translation: [f64; 3], rotation: Value) -> Value {
    let line = |a: usize, b: usize| json!({"endpoints": [a, b]});
    json!({
        "translation": translation, "rotation": rotation,
        "vertices": [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]],
        "edges": [line(0, 1), line(1, 2), line(2, 3), line(3, 0)],
    })
}

fn specified(panels: Value, stitches: Value) -> Value {
    json!({
        "pattern": {"panels": panels, "stitches": stitches},
        "properties": {"curvature_coords": "relative", "units_in_meter": 100},
    })
}

fn stitch(a: (&str, usize), b: (&str, usize)) -> Value {
    json!([{"panel": a.0, "edge": a.1}, {"panel": b.0, "edge": b.1}])
}

fn words(piece: &PieceFile) -> String {
    match piece.place.as_ref().map(|p| &p.value) {
        Some(PlaceFile::Words(words)) => words.clone(),
        other => format!("{other:?}"),
    }
}

/// Width and height of the box round a piece, millimetres.
fn extent(garment: &Garment, piece: usize) -> [f64; 2] {
    let points: Vec<Vec2> = garment.pieces[piece].loops[0].iter().flat_map(|e| e.path.sampled(1e-5)).collect();
    let size = |k: usize| {
        let of: Vec<f64> = points.iter().map(|p| p[k] * 1e3).collect();
        of.iter().copied().fold(f64::NEG_INFINITY, f64::max) - of.iter().copied().fold(f64::INFINITY, f64::min)
    };
    [size(0).round(), size(1).round()]
}

fn edge_names(piece: &PieceFile) -> Vec<String> {
    piece.outline.iter().flat_map(|o| &o.edges).map(|e| e.0.value.clone()).collect()
}

/// Relatives of the format write turns as quaternions x, y, z, w, in which half a turn about y is (0, 1, 0, 0).
#[test]
fn rotations_may_be_quaternions() {
    let spec = |back: Value| {
        let panels = json!({
            "front": rectangle(40.0, 50.0, [-20.0, 100.0, 20.0], json!([0, 0, 0, 1])),
            "back": rectangle(40.0, 50.0, [20.0, 100.0, -20.0], back),
        });
        specified(panels, json!([stitch(("front", 1), ("back", 3)), stitch(("front", 3), ("back", 1))]))
    };
    let (garment, pieces) = import(&spec(json!([0, 2, 0, 0])));
    let (same, _) = import(&spec(json!([0, 180, 0])));
    assert_eq!(pieces.iter().map(words).collect::<Vec<_>>(), ["torso front", "torso back"]);
    for piece in 0..2 {
        assert_eq!(extent(&garment, piece), [400.0, 500.0]);
        assert_eq!(extent(&same, piece), [400.0, 500.0]);
    }
    for wrong in [json!([0, 0, 0, 0]), json!([1, 2])] {
        let refused = read("trial", &spec(wrong).to_string(), Wearer::default()).expect_err("no turn").to_string();
        assert!(refused.starts_with("panel 'back' has a rotation of"), "{refused}");
    }
}

/// A panel is where it is: one behind the body is a back whichever way its outline runs.
#[test]
fn panels_are_placed_by_where_they_are() {
    let spec = |turn: bool| {
        let mut front = rectangle(40.0, 50.0, [-20.0, 100.0, 20.0], json!([0, 0, 0]));
        let mut back = rectangle(40.0, 50.0, [-20.0, 100.0, -20.0], json!([0, 0, 0]));
        // Seen from the front a back runs clockwise where its right side looks back.
        back["edges"] = json!(reversed(back["edges"].as_array().expect("edges")));
        if turn {
            for panel in [&mut front, &mut back] {
                panel["edges"] = json!(reversed(panel["edges"].as_array().expect("edges")));
            }
        }
        // Edge k of a reversed loop of four is 3 − k: the sides are 1 and 3 of one way, 2 and 0 of the other.
        let side = |reversed: bool, left: bool| match (reversed, left) {
            (false, true) => 1,
            (false, false) => 3,
            (true, true) => 2,
            (true, false) => 0,
        };
        let stitches = [true, false].map(|left| stitch(("front", side(turn, left)), ("back", side(!turn, left))));
        specified(json!({"front": front, "back": back}), json!(stitches))
    };
    for turn in [false, true] {
        let (garment, pieces) = import(&spec(turn));
        assert_eq!(pieces.iter().map(words).collect::<Vec<_>>(), ["torso front", "torso back"], "{turn}");
        assert_eq!(pieces.iter().map(|p| p.name.value.as_str()).collect::<Vec<_>>(), ["front", "back"]);
        let lengths: Vec<f64> = garment.seams.iter().map(|s| (s.length_a() * 1e3).round()).collect();
        assert_eq!(lengths, [500.0, 500.0]);
    }
}

/// Half a ring: all its corners lie on one line, and its arcs alone say which way its outline runs.
#[test]
fn halves_of_circle_skirts_are_placed_by_where_they_are() {
    let half = |z: f64, turned: bool| {
        let line = |a: usize, b: usize| json!({"endpoints": [a, b]});
        let circle = |radius: f64, sweep: usize| json!({"type": "circle", "params": [radius, 0, sweep]});
        let arc = |a: usize, b: usize, circle: Value| json!({"endpoints": [a, b], "curvature": circle});
        let edges = [line(0, 1), arc(1, 2, circle(40.0, 1)), line(2, 3), arc(3, 0, circle(12.0, 0))];
        json!({
            "translation": [0.0, 100.0, z], "rotation": [0, 0, 0],
            "vertices": [[-12.0, 0.0], [-40.0, 0.0], [40.0, 0.0], [12.0, 0.0]],
            "edges": if turned { reversed(&edges) } else { edges.to_vec() },
        })
    };
    for [front, back] in [[false, true], [true, false], [false, false], [true, true]] {
        let panels = json!({"skirt_front": half(20.0, front), "skirt_back": half(-20.0, back)});
        let edge = |turned: bool, k: usize| if turned { 3 - k } else { k };
        let sides = [0, 2].map(|k| stitch(("skirt_front", edge(front, k)), ("skirt_back", edge(back, k))));
        let (garment, pieces) = import(&specified(panels, json!(sides)));
        assert_eq!(pieces.iter().map(words).collect::<Vec<_>>(), ["skirt front", "skirt back"], "{front} {back}");
        let lengths: Vec<f64> = garment.seams.iter().map(|s| (s.length_a() * 1e3).round()).collect();
        assert_eq!(lengths, [280.0, 280.0]);
        assert_eq!([0, 1].map(|piece| extent(&garment, piece)), [[800.0, 400.0]; 2]);
    }
}

/// Where a body's origin is at its pelvis its specifications count heights from there too.
#[test]
fn heights_count_from_the_floor() {
    let spec = specified(json!({"collar": rectangle(36.0, 4.0, [-18.0, 43.0, 9.0], json!([0, 0, 0]))}), json!([]));
    let height = |floor: f64| {
        let file = read("trial", &spec.to_string(), Wearer { body: None, floor }).expect("a specification");
        match file.pieces[0].place.as_ref().map(|p| &p.value) {
            Some(PlaceFile::At { at, .. }) => at[1],
            other => panic!("{other:?}"),
        }
    };
    assert!((height(-1.0123) - height(0.0) - 1012.3).abs() < 0.051);
}

/// Of arms held out to the side both halves of a sleeve lie along the arm, however their frames are turned.
#[test]
fn sleeves_of_arms_held_out_run_along_them() {
    let line = |a: usize, b: usize| json!({"endpoints": [a, b]});
    let edges = json!([line(0, 1), line(1, 2), line(2, 3), line(3, 0)]);
    let half = |vertices: Value, z: f64, turn: f64| {
        let rotation = [0.0, 0.0, turn];
        json!({"translation": [20, 138, z], "rotation": rotation, "vertices": vertices, "edges": edges, "label": "arm"})
    };
    let front = half(json!([[0, -18], [50, -12], [50, 12], [0, 18]]), 9.0, 0.0);
    let back = half(json!([[18, 0], [12, -50], [-12, -50], [-18, 0]]), -9.0, 90.0);
    let seams = [stitch(("l_sleeve_f", 0), ("l_sleeve_b", 2)), stitch(("l_sleeve_f", 2), ("l_sleeve_b", 0))];
    let (garment, pieces) = import(&specified(json!({"l_sleeve_f": front, "l_sleeve_b": back}), json!(seams)));
    for (k, piece) in pieces.iter().enumerate() {
        assert_eq!(extent(&garment, k), [360.0, 500.0], "{}", piece.name.value);
        let outline = piece.outline.as_ref().expect("an outline");
        let hem = outline.edges.iter().position(|e| e.0.value == "hem").expect("a hem");
        let path = &garment.pieces[k].loops[0][hem].path;
        assert!((path.length() - 0.240).abs() < 1e-6 && (path.start().y - path.end().y).abs() < 1e-6);
        let [tail, head] = piece.grain.as_ref().expect("a grain").value;
        assert!(tail[0] == head[0] && tail[1] != head[1]);
    }
}

/// Panels are trousers if the seam in the middle goes on between the legs; names need not say so.
#[test]
fn trousers_are_told_by_how_they_are_sewn() {
    let leg = |side: f64, z: f64| {
        let mut vertices: Vec<[f64; 2]> =
            vec![[0.0, 0.0], [0.0, -24.0], [-5.0, -28.0], [0.0, -95.0], [22.0, -95.0], [26.0, -28.0], [23.0, 0.0]];
        vertices.iter_mut().for_each(|v| v[0] *= side);
        let mut edges: Vec<Value> = (0..7).map(|k| json!({"endpoints": [k, (k + 1) % 7]})).collect();
        let clockwise = (side > 0.0) != (z > 0.0);
        if clockwise {
            edges = reversed(&edges);
        }
        json!({"translation": [side, 98.0, z], "rotation": [0, 0, 0], "vertices": vertices, "edges": edges})
    };
    let panels = json!({"Lf": leg(1.0, 13.0), "Rf": leg(-1.0, 13.0), "Lb": leg(1.0, -13.0), "Rb": leg(-1.0, -13.0)});
    // Edges of the drawing: 0 and 1 in the middle, 2 between the legs, 4 and 5 outside.
    let of = |panel: &str, k: usize| if ["Rf", "Lb"].contains(&panel) { 6 - k } else { k };
    let sewn = |a: &'static str, b: &'static str, k: usize| stitch((a, of(a, k)), (b, of(b, k)));
    let mut stitches: Vec<Value> = [2, 4, 5].iter().flat_map(|&k| [sewn("Lf", "Lb", k), sewn("Rf", "Rb", k)]).collect();
    stitches.extend([0, 1].iter().flat_map(|&k| [sewn("Lf", "Rf", k), sewn("Lb", "Rb", k)]));
    let (_, pieces) = import(&specified(panels, json!(stitches)));
    assert!(pieces.len() == 2 && pieces.iter().all(|p| p.cut.is_some()), "two pairs");
    for piece in &pieces {
        let names = edge_names(piece);
        assert!(words(piece).starts_with("hip"), "{}", words(piece));
        for wanted in ["waist", "hem", "inseam", "outseam", "center"] {
            assert!(names.iter().any(|n| n.starts_with(wanted)), "{names:?}");
        }
        assert!(!names.iter().any(|n| n.starts_with("neck") || n.starts_with("side")), "{names:?}");
    }
}

/// Control points in a list: one is a quadratic's, two are a cubic's.
#[test]
fn control_points_may_stand_in_a_list() {
    let curved = |curvature: Value| import(&curved_front(&curvature)).0;
    let area = |garment: &Garment| -> f64 {
        garment.pieces[0].loops[0].iter().map(|e| e.path.double_area()).sum::<f64>().abs() / 2.0
    };
    // A quadratic's area beyond its chord is two thirds of its triangle's.
    let rectangle = 0.4 * 0.5;
    let quadratic = 0.4 * 0.1 * 0.5 * 2.0 / 3.0;
    assert!((area(&curved(json!([[0.5, -0.25]]))) - rectangle - quadratic).abs() < 1e-6);
    let third = 1.0 / 3.0;
    let cubic = curved(json!([[third, -0.25], [2.0 * third, -0.25]]));
    let told = curved(json!({"type": "cubic", "params": [[third, -0.25], [2.0 * third, -0.25]]}));
    assert!((area(&cubic) - area(&told)).abs() < 1e-12);
    let three = curved_front(&json!([[0.1, 0.1], [0.2, 0.1], [0.3, 0.1]]));
    let refused = read("trial", &three.to_string(), Wearer::default()).expect_err("three points").to_string();
    assert!(refused.contains("has 3 control points"), "{refused}");
}

fn curved_front(curvature: &Value) -> Value {
    let mut panel = rectangle(40.0, 50.0, [0.0, 100.0, 20.0], json!([0, 0, 0]));
    panel["edges"][0]["curvature"] = curvature.clone();
    specified(json!({"front": panel}), json!([]))
}
