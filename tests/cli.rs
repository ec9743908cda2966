//! The real program in a folder of its own: exit codes, bad input, files written and not written.

use std::collections::HashSet;
use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Output, Stdio};

use serde_json::Value;
use tempfile::TempDir;
use toile::geometry::Vec3;
use toile::io::body::mannequin_obj;
use toile::mannequin::{Mannequin, load};

/// A skirt of two pieces that sews in a fraction of a second at this spacing (mm).
const SKIRT: &str = include_str!("data/skirt.yaml");
const COARSE: &str = "40";
/// Two garments that cannot be sewn.
const NARROW_TUBE: &str = include_str!("data/narrow_tube.yaml");
const IN_THE_BODY: &str = include_str!("data/in_the_body.yaml");

/// A folder to work in.
struct Room {
    dir: TempDir,
}

impl Room {
    fn new() -> Self {
        let room = Self { dir: tempfile::tempdir().expect("a temporary folder") };
        room.put("skirt.yaml", SKIRT);
        room
    }

    fn put(&self, name: &str, text: &str) {
        let file = self.dir.path().join(name);
        fs::create_dir_all(file.parent().expect("a folder")).expect("made");
        fs::write(file, text).expect("written");
    }

    fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_toile"));
        command.args(args).current_dir(self.dir.path());
        command
    }

    fn run(&self, args: &[&str]) -> Run {
        Run::new(self.command(args).output().expect("started"))
    }

    fn make(&self, garment: &str, more: &[&str]) -> Run {
        self.run(&[&["make", garment, "-o", "out", "--spacing", COARSE], more].concat())
    }

    fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.dir.path().join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    /// Names in a folder, sorted; none if there is no such folder.
    fn names(&self, folder: &str) -> Vec<String> {
        let Ok(entries) = fs::read_dir(self.dir.path().join(folder)) else { return Vec::new() };
        let mut names: Vec<String> = entries.filter_map(|e| e.ok()?.file_name().into_string().ok()).collect();
        names.sort();
        names
    }
}

/// How a run of the program ended.
struct Run {
    code: Option<i32>,
    out: String,
    err: String,
}

impl Run {
    fn new(output: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
        Self { code: output.status.code(), out: text(output.stdout), err: text(output.stderr) }
    }

    fn json(&self) -> Value {
        serde_json::from_str(&self.out).unwrap_or_else(|e| panic!("{e}: {}\n{}", self.out, self.err))
    }

    #[track_caller]
    fn ends(&self, code: i32) -> &Self {
        assert_eq!(self.code, Some(code), "{}\n{}", self.out, self.err);
        self
    }

    /// All of these stand in the messages.
    #[track_caller]
    fn says(&self, words: &[&str]) -> &Self {
        for word in words {
            assert!(self.err.contains(word), "'{word}' is missing in: {}", self.err);
        }
        self
    }
}

/// The skirt with something else in it.
#[track_caller]
fn skirt_with(old: &str, new: &str) -> String {
    assert!(SKIRT.contains(old), "the skirt has no '{old}'");
    SKIRT.replace(old, new)
}

#[test]
fn make_within_bounds_writes_everything() {
    let room = Room::new();
    let run = room.make("skirt.yaml", &[]);
    run.ends(0);
    assert_eq!(
        room.names("out"),
        ["garment.glb", "garment.obj", "garment.png", "pattern.svg", "report.html", "report.json", "sewn.obj"]
    );
    assert!(run.out.contains("skirt on woman_92, cotton_poplin"), "{}", run.out);
    let obj = String::from_utf8(room.bytes("out/garment.obj")).expect("text");
    assert!(obj.contains("\ng front\n") && obj.contains("\ng back\n"));
    assert!(room.bytes("out/garment.png").starts_with(b"\x89PNG"));
    let svg = String::from_utf8(room.bytes("out/pattern.svg")).expect("text");
    assert!(svg.contains("id=\"front.waist\""));
}

/// What an accessor of a GLB holds, as numbers, and how many stand together.
fn glb_numbers(glb: &[u8], json: &Value, accessor: &Value) -> Vec<Vec<f64>> {
    let whole = |v: &Value| v.as_u64().unwrap_or(0) as usize;
    let accessor = &json["accessors"][whole(accessor)];
    let view = &json["bufferViews"][whole(&accessor["bufferView"])];
    // Header, JSON chunk, header of the binary chunk.
    let json_length = u32::from_le_bytes(glb[12..16].try_into().expect("four bytes")) as usize;
    let begin = 12 + 8 + json_length + 8 + whole(&view["byteOffset"]);
    let bytes = &glb[begin..begin + whole(&view["byteLength"])];
    let word = |b: &[u8]| match whole(&accessor["componentType"]) {
        5126 => f64::from(f32::from_le_bytes(b.try_into().expect("four bytes"))),
        _ => f64::from(u32::from_le_bytes(b.try_into().expect("four bytes"))),
    };
    let wide = match accessor["type"].as_str() {
        Some("VEC3") => 3,
        Some("VEC2") => 2,
        _ => 1,
    };
    let numbers: Vec<f64> = bytes.chunks(4).map(word).collect();
    let rows: Vec<Vec<f64>> = numbers.chunks(wide).map(<[f64]>::to_vec).collect();
    assert_eq!(rows.len(), whole(&accessor["count"]));
    rows
}

#[test]
fn the_glb_is_the_obj() {
    let room = Room::new();
    room.make("skirt.yaml", &["-q"]).ends(0);
    let (glb, obj) = (room.bytes("out/garment.glb"), String::from_utf8(room.bytes("out/garment.obj")).expect("text"));
    assert_eq!(&glb[..4], b"glTF");
    assert_eq!(u32::from_le_bytes(glb[8..12].try_into().expect("four bytes")) as usize, glb.len());
    let json_length = u32::from_le_bytes(glb[12..16].try_into().expect("four bytes")) as usize;
    let json: Value = serde_json::from_slice(&glb[20..20 + json_length]).expect("JSON");
    let numbers = |line: &str| line.split_whitespace().skip(1).map(|w| w.parse::<f64>().expect("a number")).collect();
    let rows = |key: &str| -> Vec<Vec<f64>> { obj.lines().filter(|l| l.starts_with(key)).map(numbers).collect() };
    let (places, flat) = (rows("v "), rows("vt "));
    let mut faces = obj.split("\ng ").skip(1).map(|group| {
        let corner = |w: &str| w.split('/').map(|n| n.parse::<usize>().expect("a number") - 1).collect::<Vec<_>>();
        let corners = group.lines().filter(|l| l.starts_with("f ")).flat_map(|l| l.split_whitespace().skip(1));
        (group.lines().next().expect("a name").to_owned(), corners.map(corner).collect::<Vec<_>>())
    });
    for mesh in json["meshes"].as_array().expect("meshes") {
        let (name, corners) = faces.next().expect("a group per mesh");
        assert_eq!(mesh["name"], name.as_str());
        let primitive = &mesh["primitives"][0];
        let attribute = |key: &str| glb_numbers(&glb, &json, &primitive["attributes"][key]);
        let (at, uv, normals) = (attribute("POSITION"), attribute("TEXCOORD_0"), attribute("NORMAL"));
        let indices = glb_numbers(&glb, &json, &primitive["indices"]);
        assert_eq!(indices.len(), corners.len());
        for (index, corner) in indices.iter().zip(&corners) {
            let i = index[0] as usize;
            // Millimetres in the one, metres in the other; a hundredth of a millimetre is asked for.
            let off = |k: usize| (at[i][k] * 1e3 - places[corner[0]][k]).abs();
            assert!((0..3).all(|k| off(k) < 0.001));
            assert!((uv[i][0] - flat[corner[1]][0]).abs() < 0.001 && (uv[i][1] + flat[corner[1]][1]).abs() < 0.001);
            let length: f64 = normals[i].iter().map(|x| x * x).sum();
            assert!((length - 1.0).abs() < 1e-5);
        }
        let material = primitive["material"].as_u64().expect("a material") as usize;
        assert_eq!(json["materials"][material]["name"], "shell");
    }
    assert!(faces.next().is_none());
}

#[test]
fn export_writes_what_cutters_take() {
    let room = Room::new();
    for kind in ["svg", "pdf", "dxf"] {
        room.run(&["export", kind, "skirt.yaml", "-q"]).ends(0);
    }
    assert_eq!(room.names("out/skirt"), ["cutting.dxf", "cutting.pdf", "cutting.svg"]);
    assert!(room.bytes("out/skirt/cutting.pdf").starts_with(b"%PDF"));
    let run = room.run(&["export", "svg", "skirt.yaml", "-o", "whole.svg", "--whole", "--allowance", "15", "--json"]);
    run.ends(0);
    let json = run.json();
    assert_eq!(json["file"], "whole.svg");
    assert!(json["pieces"].as_array().expect("a list").iter().all(|p| p["cut"] == 1));
    room.run(&["export", "svg", "skirt.yaml", "-o", "cm.svg", "--whole", "--allowance", "1.5cm"]).ends(0);
    assert_eq!(room.bytes("cm.svg"), room.bytes("whole.svg"));
    room.run(&["export", "pdf", "skirt.yaml", "-o", "a4.pdf", "--page", "A4"]).ends(0);
    assert_eq!(room.bytes("a4.pdf"), room.bytes("out/skirt/cutting.pdf"));
    room.run(&["export", "svg", "skirt.yaml", "-o", "skirt.yaml"]).ends(2).says(&["skirt.yaml", "is an input"]);
    room.run(&["export", "pdf", "skirt.yaml", "--allowance", "-3"]).ends(2).says(&["from 0 to 200"]);
}

/// A drawing in the wrong unit, 30 m wide, is read, and has too many particles: `import` says so like `check`.
#[test]
fn import_says_what_a_check_of_its_file_says() {
    let room = Room::new();
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' width='30000mm' height='30000mm' viewBox='0 0 30000 30000'>\
               <path id='wedge' d='M 10 10 L 29990 10 L 29990 29990 Z'/></svg>";
    room.put("wedge.svg", svg);
    let run = room.run(&["import", "svg", "wedge.svg", "-o", "wedge.yaml"]);
    run.ends(1).says(&["particles", "mesh size 10 mm is too small"]);
    assert!(run.out.contains("1 piece and 0 seams"), "{}", run.out);
    room.run(&["check", "wedge.yaml", "-q"]).ends(2);
}

/// The name of `..yaml` is a dot: results are not written beside `out`.
#[test]
fn a_name_of_dots_leads_nowhere() {
    let room = Room::new();
    room.put("..yaml", SKIRT);
    room.run(&["export", "svg", "..yaml", "-q"]).ends(0);
    assert_eq!(room.names("out"), ["garment"]);
}

#[test]
fn drawings_come_back_as_garment_files() {
    let room = Room::new();
    for kind in ["svg", "dxf"] {
        let (drawing, made) = (format!("out/skirt/cutting.{kind}"), format!("from_{kind}.yaml"));
        room.run(&["export", kind, "skirt.yaml", "-q"]).ends(0);
        let run = room.run(&["import", kind, &drawing, "-o", &made, "--json"]);
        let json = run.ends(0).json();
        assert_eq!((&json["file"], &json["pieces"]), (&Value::from(made.as_str()), &Value::from(2)), "{json}");
        // Seams are only suggested, so that everything is still free: a check of the file as it is passes.
        assert_eq!((&json["seams"], &json["ok"]), (&Value::from(0), &Value::from(true)), "{json}");
        room.run(&["check", &made, "-q"]).ends(0);
        // What was written by hand since would be lost.
        room.put(&made, "mine");
        room.run(&["import", kind, &drawing, "-o", &made]).ends(2).says(&[&made, "--force", "-o"]);
        assert_eq!(room.bytes(&made), b"mine");
        room.run(&["import", kind, &drawing, "-o", &made, "--force", "-q"]).ends(0);
        let text = String::from_utf8(room.bytes(&made)).expect("UTF-8");
        for piece in ["  front:", "  back:"] {
            assert!(text.contains(piece), "{text}");
        }
        // A picture of what was read lies beside it, and what is offered may be taken as it is.
        assert!(room.bytes(&made.replace("yaml", "png")).starts_with(b"\x89PNG"));
        assert!(text.contains("# seams:"), "{text}");
        let run = room.run(&["import", kind, &drawing, "-o", &made, "--seams", "--force", "--json"]);
        let json = run.ends(0).json();
        assert!(json["seams"].as_u64() > Some(0) && json["ok"] == true, "{json}");
        room.run(&["import", kind, &drawing, "-o", &drawing]).ends(2).says(&["is an input"]);
        room.run(&["import", kind, "skirt.yaml", "-o", "no.yaml"]).ends(2).says(&["skirt.yaml"]);
        room.run(&["import", kind, "nowhere", "-o", "no.yaml"]).ends(2).says(&["nowhere"]);
        assert!(!room.dir.path().join("no.yaml").exists());
    }
    let drawing = String::from_utf8(room.bytes("out/skirt/cutting.dxf")).expect("UTF-8");
    let end = "0\nENDBLK\n";
    assert!(drawing.contains(end));
    room.put("curved.dxf", &drawing.replacen(end, &format!("0\nSPLINE\n8\n8\n{end}"), 1));
    let run = room.run(&["import", "dxf", "curved.dxf", "-o", "curved.yaml"]);
    run.ends(0).says(&["left out: 1 SPLINE", "polylines"]);
}

#[test]
fn without_o_results_go_to_out_name() {
    let room = Room::new();
    room.run(&["sew", "skirt.yaml", "--spacing", COARSE, "-q"]).ends(0);
    assert_eq!(room.names("out/skirt"), ["garment.png", "report.json", "sewn.obj"]);
}

#[test]
fn out_of_bounds_ends_with_1_and_says_which() {
    let room = Room::new();
    room.put("tight.yaml", &skirt_with("below: 1 mm", "below: 0.000001 mm"));
    let run = room.make("tight.yaml", &["--quiet"]);
    run.ends(1).says(&["out of bounds: gap all", "limit 0.000001 mm"]);
    assert_eq!(run.out, "");
    // The page is there as well.
    assert_eq!(room.names("out").len(), 7);
}

/// Numbers of the vertices that a group of an OBJ file uses.
fn vertices_of(obj: &str, group: &str) -> HashSet<String> {
    let body = obj.split("\ng ").find(|part| part.lines().next() == Some(group)).unwrap_or_default();
    let faces = body.lines().filter_map(|line| line.strip_prefix("f "));
    faces.flat_map(str::split_whitespace).filter_map(|corner| corner.split('/').next()).map(str::to_owned).collect()
}

/// Its seams close, but no poplin gives a quarter.
#[test]
fn a_garment_too_small_ends_with_3_and_leaves_its_last_state() {
    let room = Room::new();
    room.put("tube.yaml", NARROW_TUBE);
    let run = room.run(&["make", "tube.yaml", "-o", "out", "--spacing", "20"]);
    let out = Path::new("out");
    let left = ["sewn.obj", "garment.png"].map(|name| out.join(name).display().to_string());
    run.ends(3).says(&[
        "tube.yaml: piece '",
        "too small for the body",
        "along its weft",
        "cotton_poplin gives no more",
    ]);
    run.says(&["the last state is in", &left[0], &left[1]]);
    // The message says what to do: another spacing makes no waist smaller.
    assert!(!run.err.contains("--spacing"), "{}", run.err);
    assert_eq!(run.out, "");
    assert_eq!(room.names("out"), ["garment.png", "sewn.obj"]);
    let obj = String::from_utf8(room.bytes("out/sewn.obj")).expect("text");
    assert!(!obj.contains("NaN"));
    assert!(room.bytes("out/garment.png").starts_with(b"\x89PNG"));
    // Which a jersey does.
    room.run(&["sew", "tube.yaml", "--fabric", "jersey", "-o", "jersey", "--spacing", "20", "-q"]).ends(0);
}

/// A seam with an arm between its edges.
#[test]
fn a_seam_that_stays_open_ends_with_3_and_is_shown_open() {
    let room = Room::new();
    room.put("sheets.yaml", include_str!("data/arms_between.yaml"));
    let run = room.run(&["make", "sheets.yaml", "-o", "out", "--spacing", "25"]);
    run.ends(3).says(&["still open by", "the last state is in"]);
    assert_eq!(room.names("out"), ["garment.png", "sewn.obj"]);
    let obj = String::from_utf8(room.bytes("out/sewn.obj")).expect("text");
    // The pieces have no vertex in common.
    let [front, back] = ["front", "back"].map(|piece| vertices_of(&obj, piece));
    assert!(!front.is_empty() && !back.is_empty());
    assert!(front.is_disjoint(&back));
}

/// Pieces that were placed across one another, or in one place, are named, and where.
#[test]
fn pieces_stuck_in_one_another_are_named_with_their_place() {
    let room = Room::new();
    let one = include_str!("data/across.yaml");
    let across = "back: {like: front, place: {at: [0, 1000, 320], turn: [20, 0, 0]}}";
    room.put("one.yaml", one);
    room.put("across.yaml", &one.replace("back: {like: front, place: {at: [30, 1000, 300]}}", across));
    let run = room.run(&["make", "one.yaml", "-o", "one", "--spacing", "25"]);
    run.ends(3).says(&["'front' and 'back' started in one place near (", ", 300) mm", "still open by"]);
    let run = room.run(&["make", "across.yaml", "-o", "across", "--spacing", "25"]);
    run.ends(3).says(&["'back' and 'front' pass through one another near (", "place them neither across"]);
}

/// Two skirts on one layer: nothing leads one out of the other.
#[test]
fn check_names_pieces_that_start_in_one_place() {
    let room = Room::new();
    let twice = "  front_2: {like: front}\n  back_2: {like: back}\nseams:\n  left_2: {sew: front_2.right, to: \
                 back_2.left}\n  right_2: {sew: front_2.left, to: back_2.right}\n";
    let skirt = skirt_with("seams:\n", twice).replace("openings: 2", "openings: 4");
    room.put("twice.yaml", &skirt);
    let run = room.run(&["check", "twice.yaml", "--spacing", "25"]);
    run.ends(0).says(&[
        "'front' and 'front_2' start in one place",
        "'back' and 'back_2'",
        "give 'front_2' another place",
    ]);
    room.put(
        "over.yaml",
        &skirt.replace("{like: front}", "{like: front, layer: 1}").replace("{like: back}", "{like: back, layer: 1}"),
    );
    let run = room.run(&["check", "over.yaml", "--spacing", "25"]);
    run.ends(0);
    assert!(!run.err.contains("one place"), "{}", run.err);
    // Halves that widen lie over one another at the hem to begin with, and are led apart.
    let half = "{place: skirt, cut: 2, grain: [[0, 300], [0, 700]], outline: {start: -204.5 204.5, \
                waist: A 289.2 289.2 0 0 0 204.5 204.5, right: L 600 600, hem: A 848.5 848.5 0 0 1 -600 600, \
                left: L -204.5 204.5}}";
    let circle = format!(
        "garment: 1\nbody: woman_92\nfabrics: {{shell: gabardine}}\npieces:\n  skirt: {half}\nseams:\n  r: {{sew: \
         skirt.1.right, to: skirt.2.left, open: {{from: hem, length: 300}}}}\n  l: {{sew: skirt.2.right, to: \
         skirt.1.left}}\nfree: [skirt.waist, skirt.hem]\n"
    );
    room.put("circle.yaml", &circle);
    let run = room.run(&["check", "circle.yaml", "--spacing", "25"]);
    run.ends(0);
    assert!(!run.err.contains("one place"), "{}", run.err);
    room.put("lined.yaml", include_str!("data/lined_top.yaml"));
    let run = room.run(&["check", "lined.yaml", "--spacing", "25"]);
    run.ends(0);
    assert!(!run.err.contains("one place"), "{}", run.err);
}

/// A piece that no contact can lead out.
#[test]
fn a_piece_in_the_body_ends_with_3_and_leaves_the_pieces_as_placed() {
    let room = Room::new();
    room.put("squares.yaml", IN_THE_BODY);
    room.put("out/garment.obj", "of an earlier run");
    for command in ["make", "sew"] {
        let run = room.run(&[command, "squares.yaml", "-o", "out", "--spacing", COARSE]);
        run.ends(3).says(&["piece 'lost'", "inside the body", "move its place", "placed.obj"]);
        assert!(!run.err.contains("--spacing"), "{}", run.err);
    }
    assert_eq!(room.names("out"), ["garment.obj", "garment.png", "placed.obj"]);
    assert_eq!(room.bytes("out/garment.obj"), b"of an earlier run");
    let obj = String::from_utf8(room.bytes("out/placed.obj")).expect("text");
    // Partners are apart: as many vertices as particles, 1300 mm up as the file says.
    let vertices: Vec<&str> = obj.lines().filter(|l| l.starts_with("v ")).collect();
    assert_eq!(vertices.len(), obj.lines().filter(|l| l.starts_with("vt ")).count());
    assert!(vertices.iter().any(|v| v.contains(" 1300.000000 ")), "{obj}");
    assert!(room.bytes("out/garment.png").starts_with(b"\x89PNG"));
    // Quiet is not silent, and the worst of several garments is what counts.
    let run = room.run(&["test", "skirt.yaml", "squares.yaml", "-q", "--spacing", COARSE, "--junit", "all.xml"]);
    run.ends(3).says(&["squares.yaml: not made: piece 'lost'"]);
    assert!(String::from_utf8_lossy(&room.bytes("all.xml")).contains("errors=\"1\""));
}

#[test]
fn json_has_the_keys_of_the_contract_and_is_the_report() {
    let room = Room::new();
    let run = room.make("skirt.yaml", &["--json"]);
    let report = run.ends(0).json();
    assert_eq!(run.out.as_bytes(), room.bytes("out/report.json"));
    let has = |value: &Value, keys: &[&str]| keys.iter().for_each(|k| assert!(value.get(k).is_some(), "{k}: {value}"));
    let top = ["toile", "garment", "mannequin", "fabric", "spacing", "pieces", "seams", "contact", "worn", "stages"];
    has(&report, &top);
    let four = ["sew", "drape", "flatten", "round_trip"];
    let piece = &report["pieces"][0];
    has(piece, &["name", "particles", "triangles", "area_flat", "area_sewn", "area_draped", "area_flattened"]);
    has(piece, &["boundary_flat", "boundary_sewn", "boundary_draped", "boundary_flattened", "stretched"]);
    assert_eq!((&piece["overlaps"], &report["total"]["overlaps"]), (&Value::from(0), &Value::from(0)));
    [&piece["area_error"], &piece["boundary_error"]].iter().for_each(|e| has(e, &four));
    has(&piece["strain"], &["mean", "p95", "p99", "max"]);
    has(&report["seams"][0], &["name", "length_a", "length_b", "gap_mean", "gap_max"]);
    has(&report["contact"], &["inside_body", "deepest", "cloth_body_intersections", "cloth_cloth_intersections"]);
    has(&report["worn"][0], &["opening", "body_part"]);
    let stages: Vec<&str> =
        report["stages"].as_array().expect("a list").iter().filter_map(|s| s["name"].as_str()).collect();
    assert_eq!(stages, ["mesh", "sew", "drape", "flatten"]);
    has(&report["stages"][2], &["seconds", "iterations", "converged", "energy", "drift"]);
    has(&report["stages"][2]["contact_seconds"], &["body", "features", "cloth", "follow", "of"]);
    assert_eq!(report["spacing"], 40.0);
}

/// Fine enough that every pass is split: the longest chunk that one thread keeps to itself has
/// [`toile::parallel::LIGHT`] items, and the factor of so many particles has several subtrees.
const FINE: &str = "12";

#[test]
fn make_says_its_verdict_in_a_few_lines() {
    let room = Room::new();
    let run = room.make("skirt.yaml", &[]);
    let lines: Vec<&str> = run.ends(0).out.lines().collect();
    assert!(lines.len() <= 8 && lines.iter().all(|line| line.chars().count() <= 100), "{}", run.out);
    let starts = ["skirt on woman_92, cotton_poplin: within its bounds", "sewn", "worn", "fit", "rest", "flat", "look"];
    let found = starts.iter().zip(&lines).all(|(start, line)| line.starts_with(start));
    assert!(found && lines.len() == starts.len(), "{}", run.out);
    for words in ["2 seams, largest gap", "round the", "tightest at the ", "at rest", "out/report.html"] {
        assert!(run.out.contains(words), "'{words}' is missing in: {}", run.out);
    }
    let tables = room.make("skirt.yaml", &["--table"]);
    for head in ["piece", "seam", "opening", "girth", "stage"] {
        let has = tables.ends(0).out.lines().any(|line| line.trim_start().starts_with(&format!("{head} ")));
        assert!(has, "{head}: {}", tables.out);
    }
    // The verdict has the bad news, and standard error tells it.
    room.put("skirt.yaml", &skirt_with("below: 1 mm", "below: 0.000001 mm"));
    let run = room.make("skirt.yaml", &[]);
    assert!(run.ends(1).says(&["out of bounds: gap all"]).out.contains("OUT OF BOUNDS in one place"), "{}", run.out);
    let report: Value = serde_json::from_slice(&room.bytes("out/report.json")).expect("JSON");
    let problem = report["problems"][0].as_str().expect("a problem");
    assert!(problem.starts_with("out of bounds: gap all"), "{problem}");
    let page = String::from_utf8(room.bytes("out/report.html")).expect("text");
    assert!(page.contains("out of bounds: gap all") && page.len() < 2_000_000, "{}", page.len());
}

/// The verdict in the README is that of the garment in the README, but for its figures.
#[test]
fn the_readme_shows_what_make_prints() {
    let readme = include_str!("../README.md");
    let block = |start: &str| {
        let from = readme.find(start).unwrap_or_else(|| panic!("no {start}")) + start.len();
        readme[from..].split_once("```").expect("an end").0
    };
    let room = Room::new();
    room.put(
        "skirt.yaml",
        &format!("garment: 1\nname: Short skirt{}", block("```yaml\ngarment: 1\nname: Short skirt")),
    );
    let run = room.run(&["make", "skirt.yaml", "--spacing", "40"]);
    let shape = |text: &str| {
        let mut out = String::new();
        for c in text.chars().map(|c| if c.is_ascii_digit() { '#' } else { c }) {
            if c != '#' || !out.ends_with('#') {
                out.push(c);
            }
        }
        out
    };
    assert_eq!(shape(&run.ends(0).out), shape(block("```text\n$ toile make skirt.yaml --spacing 40\n")));
}

/// The page can be written again from the folder, and is the same.
#[test]
fn the_page_is_made_again_from_its_folder() {
    let room = Room::new();
    room.make("skirt.yaml", &["-q"]).ends(0);
    let page = room.bytes("out/report.html");
    room.put("out/report.html", "old");
    room.run(&["report", "out"]).ends(0);
    assert!(room.bytes("out/report.html") == page, "another page");
    room.run(&["report", "out", "--body", "nobody.obj"]).ends(2).says(&["nobody.obj"]);
    room.run(&["report", "nowhere"]).ends(2).says(&["nowhere", "toile make"]);
}

#[test]
fn pressure_bands_are_the_makers_own() {
    let room = Room::new();
    let run = room.make("skirt.yaml", &["--json", "--pressure-bands", "0.001,0.002"]);
    let bands = &run.ends(0).json()["fit"]["bands"];
    assert_eq!((&bands["tight"], &bands["too_tight"]), (&Value::from(0.001), &Value::from(0.002)), "{bands}");
    room.make("skirt.yaml", &["--pressure-bands", "5,2"]).ends(2).says(&["two rising pressures in kPa"]);
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let room = Room::new();
    let files = |threads: &str| {
        room.run(&["make", "skirt.yaml", "-o", "out", "--spacing", FINE, "-q", "--threads", threads]).ends(0);
        ["sewn.obj", "garment.obj", "garment.glb", "pattern.svg", "garment.png"]
            .map(|name| room.bytes(&format!("out/{name}")))
    };
    let one = files("1");
    for threads in ["2", "3", "4", "8"] {
        assert!(files(threads) == one, "{threads} threads give other bytes");
    }
    let report: Value = serde_json::from_slice(&room.bytes("out/report.json")).expect("JSON");
    let particles = report["pieces"].as_array().expect("a list").iter().map(|p| p["particles"].as_u64());
    assert!(particles.flatten().sum::<u64>() > toile::parallel::LIGHT as u64, "too coarse to be split");
}

#[test]
fn a_garment_can_be_taken_stage_by_stage() {
    let room = Room::new();
    room.make("skirt.yaml", &["-q"]).ends(0);
    let rest = ["--spacing", COARSE, "-o", "steps", "-q"];
    let stage = |args: &[&str]| {
        room.run(&[args, &rest].concat()).ends(0);
    };
    stage(&["sew", "skirt.yaml"]);
    stage(&["drape", "skirt.yaml", "--from", "steps/sewn.obj"]);
    stage(&["flatten", "skirt.yaml", "--from", "steps/garment.obj"]);
    // Laid flat from a form that may have been changed, there is its pattern as well.
    let names: Vec<String> = room.names("steps").into_iter().filter(|name| name != "garment.yaml").collect();
    assert_eq!((names.len() + 1, names), (room.names("steps").len(), room.names("out")));
    assert_eq!(room.bytes("steps/sewn.obj"), room.bytes("out/sewn.obj"));
    let other = ["drape", "skirt.yaml", "--from", "steps/sewn.obj", "-o", "other", "--spacing", "35"];
    room.run(&other).ends(2).says(&["steps/sewn.obj", "--spacing"]);
}

#[test]
fn fabric_and_body_can_be_replaced() {
    let room = Room::new();
    let report = room.make("skirt.yaml", &["--fabric", "denim", "--json"]).json();
    assert_eq!(report["fabric"], "denim");
    room.put("own.yaml", "name: own\nweight: 150 g/m2\nbend: 5 uN.m\n");
    let report = room.make("skirt.yaml", &["--fabric", "own.yaml", "--json"]).json();
    assert_eq!(report["fabric"], "own");
    room.run(&["mannequin", "build", "woman_92", "-o", "anna.obj", "-q"]).ends(0);
    let report = room.make("skirt.yaml", &["--body", "anna.obj", "--json"]).json();
    assert_eq!(report["mannequin"], "anna");
}

/// Words were compared with the names in the report: a bound for a file was never judged, and one for a fabric of the
/// garment's own stopped the test.
#[test]
fn a_bound_may_be_for_a_fabric_of_ones_own() {
    let room = Room::new();
    room.put("all/own.yaml", "name: my cloth\nweight: 150 g/m2\nbend: 5 uN.m\n");
    let bounds = |fabric: &str| {
        let bound = format!("below: 1 mm}}\n  - {{gap: all, below: 0.000001 mm, fabric: {fabric}}}");
        skirt_with("below: 1 mm}", &bound)
    };
    let test = |fabric: &str| {
        room.put("all/skirt.yaml", &bounds(fabric));
        room.run(&["test", "all/skirt.yaml", "--spacing", COARSE])
    };
    let run = test("own.yaml");
    run.ends(1).says(&["all/skirt.yaml in own.yaml: out of bounds: gap all"]);
    assert!(run.out.contains("1 of 2 garments"), "{}", run.out);
    let run = test("shell");
    run.ends(1).says(&["all/skirt.yaml: out of bounds: gap all"]);
    assert!(run.out.contains("0 of 1 garments"), "{}", run.out);
    test("none.yaml").ends(2).says(&["all/skirt.yaml:", "none.yaml: No such file"]);
    room.run(&["check", "all/skirt.yaml"]).ends(2).says(&["none.yaml"]);
}

#[test]
fn strain_can_be_shown() {
    let room = Room::new();
    room.make("skirt.yaml", &["-q"]).ends(0);
    let by_piece = room.bytes("out/garment.png");
    room.make("skirt.yaml", &["-q", "--color", "strain"]).ends(0);
    assert!(room.bytes("out/garment.png") != by_piece);
}

#[test]
fn check_draws_the_start_into_a_png_and_no_other_file() {
    let room = Room::new();
    let run = room.run(&["check", "skirt.yaml", "--picture", "start.png", "--json"]);
    let start = run.ends(0).json()["start"].clone();
    assert!(room.bytes("start.png").starts_with(b"\x89PNG"));
    assert_eq!((&start["picture"], &start["clear"]), (&"start.png".into(), &true.into()), "{start}");
    let mut through: Vec<&str> =
        start["openings"].as_array().expect("a list").iter().filter_map(|o| o["through"].as_str()).collect();
    through.sort_unstable();
    assert_eq!(through, ["head + left arm + right arm", "left leg + right leg"]);
    assert!(start["margin"].as_f64().is_some_and(|margin| margin > 0.7), "{start}");
    room.run(&["check", "skirt.yaml", "--picture", "start.jpg"]).ends(2).says(&["start.jpg", "PNG"]);
    assert!(!room.dir.path().join("start.jpg").exists());
    room.run(&["check", "skirt.yaml", "--picture", "skirt.yaml/start.png"]).ends(2).says(&["skirt.yaml"]);
}

#[test]
fn check_walks_the_seams() {
    let room = Room::new();
    let run = room.run(&["check", "skirt.yaml"]);
    run.ends(0);
    assert!(run.out.contains("front.right – back.left") && run.out.contains("313.2"), "{}", run.out);
    let summary = room.run(&["check", "skirt.yaml", "--json"]).json();
    assert_eq!(summary["seams"][0]["name"], "left");
    assert_eq!(summary["openings"].as_array().map(Vec::len), Some(2));
    // Of edges that are sewn in part the stretch is said.
    room.put("part.yaml", &skirt_with("to: back.left}", "to: back.left@0%..100%}"));
    let run = room.run(&["check", "part.yaml"]);
    assert!(run.ends(0).out.lines().any(|line| line.ends_with("front.right – back.left")), "{}", run.out);
    let half = skirt_with("{sew: front.right, to: back.left}", "{sew: front.right@10..90, to: back.left@10..90}");
    room.put("half.yaml", &half.replace("free: [", "free: [front.right, back.left, "));
    let run = room.run(&["check", "half.yaml"]);
    assert!(run.ends(0).out.contains("front.right@10..90 – back.left@10..90"), "{}", run.out);
    room.put("wrong.yaml", &skirt_with("back.left}", "back.lefd}"));
    let refusal = room.run(&["check", "wrong.yaml", "--json"]);
    assert_eq!(refusal.ends(2).json()["diagnostics"][0]["severity"], "error");
}

#[test]
fn test_compares_garments_with_their_own_bounds() {
    let room = Room::new();
    let spacing = ["--spacing", COARSE];
    let run = room.run(&[&["test", "skirt.yaml"], &spacing[..]].concat());
    run.ends(0);
    assert!(run.out.contains("1 of 1 garments within their bounds"), "{}", run.out);
    fs::create_dir(room.dir.path().join("all")).expect("made");
    room.put("all/b.yaml", &skirt_with("below: 1 mm", "below: 0.000001 mm"));
    room.put("all/a.yaml", SKIRT);
    let run = room.run(&[&["test", "all", "--json", "--junit", "all.xml"], &spacing[..]].concat());
    let outcomes = run.ends(1).says(&["b.yaml: out of bounds: gap all"]).json();
    let garments = outcomes.as_array().expect("a list").iter().map(|o| o["garment"].as_str());
    assert_eq!(garments.collect::<Vec<_>>(), [Some("a"), Some("b")]);
    assert!(String::from_utf8_lossy(&room.bytes("all.xml")).contains("failures=\"1\""));
    room.put("all/c.yaml", "garment: 1\n");
    room.run(&[&["test", "all", "-q"], &spacing[..]].concat()).ends(2).says(&["c.yaml: not made"]);
    fs::create_dir(room.dir.path().join("empty")).expect("made");
    room.run(&["test", "empty"]).ends(2).says(&["no garment"]);
}

#[test]
fn readings_become_a_fabric() {
    let room = Room::new();
    let rows = |k: usize| format!("{k}, {}, {}, {}\n", 1500 + 7 * k, 620 + k, 20 + k);
    let table: String = (1..=20).map(rows).collect();
    room.put("readings.csv", &format!("repeat, recovery, stretch, bend\ninitial, 1840, 610,\n{table}"));
    let run = room.run(&["fabric", "measure", "readings.csv", "-o", "mine.yaml"]);
    assert!(run.ends(0).out.contains("bending length by"), "{}", run.out);
    // No colon before nothing, no head over nothing.
    assert!(run.out.starts_with("mine\n\n  source: measured, readings.csv\n"), "{}", run.out);
    let shown = room.run(&["fabric", "show", "mine.yaml", "--json"]).json();
    assert_eq!(shown["liu"]["spread"].as_array().map(Vec::len), Some(3));
    let mean = shown["liu"]["means"][2].as_f64().expect("a number");
    assert!((mean - 30.5 / 40.0).abs() < 1e-6, "{mean}");
    room.run(&["fabric", "measure", "readings.csv", "-o", "readings.csv"]).ends(2).says(&["it is an input"]);
    room.run(&["fabric", "measure", "readings.csv", "-o", "denim"]).ends(2).says(&["named denim.yaml"]);
    room.put("flex.csv", "strain %, load gf/cm\n1, 50\n2.5, 500\n");
    room.put("flex.yaml", "weight: 115 g/m2\nbend: 1 uN.m\ntensile: {warp: flex.csv}\n");
    let over = ["fabric", "test", "flex.yaml", "--only", "drape", "-o", "flex.csv"];
    room.run(&over).ends(2).says(&["it is an input"]);
    room.put("few.csv", "repeat, recovery, stretch, bend\ninitial, 1840, 610,\n1, 1500, 620, 30\n");
    room.run(&["fabric", "measure", "few.csv", "-o", "few.yaml"])
        .ends(2)
        .says(&["recovery: 1 readings; the test has 20"]);
    assert!(!room.dir.path().join("few.yaml").exists());
}

#[test]
fn a_fabric_is_tested_beside_known_answers() {
    let room = Room::new();
    let run = |more: &[&str]| room.run(&[&["fabric", "test", "cotton_poplin"], more].concat());
    let found = run(&["--only", "catenary", "--json"]).ends(0).json();
    let figures = found["figures"].as_array().expect("figures");
    assert_eq!(figures.len(), 6);
    assert!(figures.iter().all(|f| f["holds"] == true && f["error"].as_f64().expect("error").abs() < 0.02));
    assert!(run(&["--only", "catenary"]).ends(0).out.contains("level pull over weight"));
    run(&["--only", "drape", "-o", "shadow.png", "--quiet"]).ends(0);
    let picture = fs::read(room.dir.path().join("shadow.png")).expect("a picture");
    assert!(picture.starts_with(b"\x89PNG"));
    run(&["--only", "catenary", "-o", "other.png"]).ends(2).says(&["--only drape"]);
    run(&["--only", "hope"]).ends(2).says(&["catenary"]);
    room.run(&["fabric", "test", "denin"]).ends(2).says(&["did you mean 'denim'"]);
}

#[test]
fn libraries_are_listed_and_shown() {
    let room = Room::new();
    assert!(room.run(&["fabric", "list"]).ends(0).out.contains("cotton_poplin"));
    assert!(room.run(&["fabric", "show", "denim"]).ends(0).out.contains("weight"));
    assert_eq!(room.run(&["fabric", "show", "denim", "--json"]).json()["name"], "denim");
    room.run(&["fabric", "show", "denin"]).ends(2).says(&["did you mean 'denim'"]);
    assert!(room.run(&["mannequin", "list"]).ends(0).out.contains("child_110"));
    let girths = room.run(&["mannequin", "show", "woman_92", "--json"]).ends(0).json();
    let waist = girths["sections"].as_array().and_then(|all| all.iter().find(|s| s["name"] == "waist"));
    assert_eq!(waist.map(|w| (w["girth"].as_f64(), w["height"].as_f64())), Some((Some(735.0), Some(1030.0))));
    room.run(&["mannequin", "build", "nobody", "-o", "a.obj"]).ends(2).says(&["nobody", "woman_92"]);
}

#[test]
fn any_surface_can_be_laid_flat() {
    let room = Room::new();
    // Half a cylinder of one metre, as quads in two groups, in centimetres.
    let mut text = String::new();
    for row in 0..5 {
        for column in 0..=8 {
            let angle = f64::from(column) * std::f64::consts::PI / 8.0;
            text.push_str(&format!("v {} {} {}\n", 50.0 * angle.cos(), 10 * row, 50.0 * angle.sin()));
        }
    }
    for (name, rows) in [("low", 0..2), ("high", 2..4)] {
        text.push_str(&format!("g {name}\n"));
        for row in rows {
            for column in 0..8 {
                let a = 9 * row + column + 1;
                text.push_str(&format!("f {a} {} {} {}\n", a + 9, a + 10, a + 1));
            }
        }
    }
    room.put("tube.obj", &text);
    let report = room.run(&["flatten", "tube.obj", "--units", "cm", "-o", "flat", "--json"]).ends(0).json();
    assert_eq!(
        room.names("flat"),
        ["flat.obj", "flat.png", "form.obj", "garment.yaml", "outline.svg", "pattern.svg", "report.json"]
    );
    assert_eq!(report["pieces"][1]["name"], "high");
    // The edges run between the corners, and know what is on the other side.
    let edges = |piece: usize| report["pieces"][piece]["edges"].as_array().expect("a list").clone();
    let sewn =
        |piece: usize| edges(piece).iter().filter_map(|e| e["sewn_to"].as_str().map(str::to_owned)).collect::<Vec<_>>();
    assert_eq!((edges(0).len(), edges(1).len()), (4, 4));
    assert_eq!([sewn(0).len(), sewn(1).len()], [1, 1]);
    let partner = edges(1).iter().position(|e| e["sewn_to"] != Value::Null).expect("one");
    assert_eq!(sewn(0), [format!("high.{}", edges(1)[partner]["name"].as_str().expect("a name"))]);
    let length = edges(1)[partner]["length_flattened"].as_f64().expect("a number");
    assert!((length - 8.0 * 2.0 * 500.0 * (std::f64::consts::PI / 16.0).sin()).abs() < 0.01, "{length}");
    let outline = String::from_utf8(room.bytes("flat/outline.svg")).expect("text");
    assert_eq!(outline.matches("class=\"edge\"").count(), 8);
    assert_eq!(outline.matches(" C").count(), 8, "straight edges are one curve each");
    let pattern = String::from_utf8(room.bytes("flat/pattern.svg")).expect("text");
    assert_eq!(pattern.matches("class=\"notch\"").count(), 2, "one in the middle on either side");
    let width = 8.0 * 2.0 * 500.0 * (std::f64::consts::PI / 16.0).sin();
    let area = report["pieces"][0]["area_flattened"].as_f64().expect("a number");
    assert!((area - 200.0 * width).abs() < 1e-3 * area, "{area}");
    let flat = String::from_utf8(room.bytes("flat/flat.obj")).expect("text");
    let lines = |text: &str, key: &str| -> Vec<String> {
        text.lines().filter(|l| l.starts_with(key)).map(str::to_owned).collect()
    };
    assert_eq!(lines(&flat, "v "), lines(&text, "v "));
    let bare = |l: &String| l.split(' ').map(|w| w.split('/').next().unwrap_or("").to_owned()).collect::<Vec<_>>();
    let faces: Vec<_> = lines(&flat, "f ").iter().map(bare).collect();
    assert_eq!(faces, lines(&text, "f ").iter().map(bare).collect::<Vec<_>>());
    // Faces that share no vertices fall apart, which is said, and are joined when asked.
    let mut soup = String::new();
    for (count, face) in lines(&text, "f ").iter().enumerate() {
        for word in face.split(' ').skip(1) {
            let place = lines(&text, "v ")[word.parse::<usize>().expect("a number") - 1].clone();
            soup += &format!("{place}\n");
        }
        soup += &format!("f{}\n", (1..=4).map(|k| format!(" {}", 4 * count + k)).collect::<String>());
    }
    room.put("soup.obj", &soup);
    room.run(&["flatten", "soup.obj", "--units", "cm", "-o", "soup"]).ends(0).says(&["--weld"]);
    let joined = room.run(&["flatten", "soup.obj", "--units", "cm", "--weld", "-o", "soup", "--json"]).ends(0).json();
    assert_eq!(joined["pieces"].as_array().map(Vec::len), Some(1));
    assert_eq!(joined["pieces"][0]["particles"], 45);
    // Any of the vertices that are joined may name where to cut, in the second and in the third face alike.
    let cut = |ends: &str, out: &str| {
        room.run(&["flatten", "soup.obj", "--units", "cm", "--weld", "--cut", ends, "-o", out, "--json"])
    };
    let joined_at = (0..4).flat_map(|a| (4..8).map(move |b| (a, b))).filter(|(a, b)| {
        let place = |k: usize| soup.lines().filter(|l| l.starts_with("v ")).nth(k).expect("a vertex").to_owned();
        place(*a) == place(*b)
    });
    for (a, b) in joined_at {
        cut(&format!("{},{}", a + 1, b + 1), "no").ends(2).says(&["are welded to one", "nothing to cut"]);
    }
    // The unit of a body may be another than the mesh's.
    room.put("tent.obj", "v -0.5 1 0\nv 0.5 1 0\nv 0 1 0.5\nv 0 2 0.5\nf 1 2 3\nf 2 1 4\nf 3 2 4\nf 1 3 4\n");
    room.put("sheet.obj", "v 0 1500 -900\nv 900 1500 900\nv -900 1500 900\nf 1 2 3\n");
    let on_tent = ["check", "--mesh", "sheet.obj", "--body", "tent.obj"];
    let run = room.run(&[&on_tent[..], &["--body-units", "m"]].concat());
    assert!(
        run.ends(1).out.contains("cloth through body ") && !run.out.contains("cloth through body 0"),
        "{}",
        run.out
    );
    // What is no disk is refused with what it is.
    room.put("closed.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    room.run(&["flatten", "closed.obj", "-o", "no"]).ends(2).says(&["closed.obj", "cut it first"]);
    assert!(room.names("no").is_empty());
}

/// A tube of 24 × 6 quads, 20 cm round and 10 cm high, in metres; with `seam` its texture is cut open along one side.
fn tube(seam: bool) -> String {
    let mut text = String::new();
    for row in 0..=6 {
        for column in 0..24 {
            let angle = f64::from(column) * std::f64::consts::TAU / 24.0;
            text += &format!("v {} {} {}\n", 0.0318 * angle.cos(), f64::from(row) / 60.0, 0.0318 * angle.sin());
        }
    }
    for (row, column) in (0..7).flat_map(|row| (0..=24).map(move |column| (row, column))) {
        text += &format!("vt {} {}\n", f64::from(if seam { column } else { column % 24 }) / 24.0, f64::from(row) / 6.0);
    }
    for (row, column) in (0..6).flat_map(|row| (0..24).map(move |column| (row, column))) {
        let corner = |r: i32, c: i32| format!(" {}/{}", 24 * r + c % 24 + 1, 25 * r + c + 1);
        let corners = [(row, column), (row + 1, column), (row + 1, column + 1), (row, column + 1)];
        text += &format!("f{}\n", corners.map(|(r, c)| corner(r, c)).concat());
    }
    text
}

#[test]
fn what_is_no_disk_is_cut_where_asked_or_where_it_must_be() {
    let room = Room::new();
    room.put("tube.obj", &tube(false));
    room.put("seam.obj", &tube(true));
    // No flat ring has both its rims, so that it is cut by itself, where `auto` cuts it too.
    room.run(&["flatten", "tube.obj", "-o", "flat"]).ends(0).says(&["cut 'tube' from", "(100.0 mm)"]);
    let area = 24.0 * 2.0 * 31.8 * (std::f64::consts::PI / 24.0).sin() * 100.0;
    let laid = |args: &[&str]| {
        let report = room.run(&[&["flatten", "-o", "flat", "--json"], args].concat()).ends(0).json();
        assert_eq!(report["pieces"].as_array().map(Vec::len), Some(1), "{args:?}");
        assert_eq!(report["units"], "m");
        let found = report["pieces"][0]["area_flattened"].as_f64().expect("a number");
        assert!((found / area - 1.0).abs() < 1e-6, "{args:?}: {found} {area}");
        report
    };
    let auto = laid(&["tube.obj", "--cut", "auto"]);
    assert_eq!(auto["cuts"][0].as_array().map(Vec::len), Some(7));
    assert_eq!(auto["pieces"][0]["particles"], 25 * 7);
    let made = &auto["cuts_made"][0];
    assert_eq!((made["piece"].as_str(), made["why"].as_str()), (Some("tube"), Some("auto")));
    assert!(made["length"].as_f64().is_some_and(|l| (l - 100.0).abs() < 1e-6), "{made}");
    room.run(&["flatten", "tube.obj", "--cut", "auto", "-o", "flat"]).ends(0).says(&["cut 'tube' from", "100.0 mm"]);
    assert_eq!(laid(&["tube.obj", "--cut", "5,149"])["cuts"][0][6], 149);
    laid(&["seam.obj"]);
    // Cut apart across, and each half open by itself. That the halves meet where they were cut is no news.
    let ring = |row: usize| format!("{},{},{},{}", 24 * row + 1, 24 * row + 9, 24 * row + 17, 24 * row + 1);
    let run = room.run(&["flatten", "tube.obj", "--cut", "auto", "--cut", &ring(3), "-o", "halves", "--json"]);
    let why: Vec<Value> =
        run.ends(0).json()["cuts_made"].as_array().expect("rows").iter().map(|c| c["why"].clone()).collect();
    assert_eq!(why, ["asked", "auto", "auto"]);
    assert!(!run.err.contains("--weld"), "{}", run.err);
    // Every corner of the file has a place of its own on the flat piece, in the file's order.
    let flat = String::from_utf8(room.bytes("flat/flat.obj")).expect("text");
    assert_eq!(flat.lines().filter(|l| l.starts_with("vt ")).count(), 25 * 7);
    room.run(&["flatten", "seam.obj", "--no-texture-seams", "-o", "flat"]).ends(0).says(&["cut 'seam' from"]);
    room.run(&["flatten", "tube.obj", "--cut", "1,999", "-o", "no"]).ends(2).says(&["999", "1 to 168"]);
    room.run(&["flatten", "tube.obj", "--cut", "5,5", "-o", "no"])
        .ends(2)
        .says(&["vertex 5 follows itself", "another"]);
    room.run(&["flatten", "tube.obj", "--cut", "1;2", "-o", "no"]).ends(2).says(&["--cut 1;2"]);
    // Round the rim, and from one vertex inside to the next: neither opens anything.
    room.run(&["flatten", "tube.obj", "--cut", "1,3", "-o", "no"]).ends(2).says(&["--cut 1,3", "runs along the rim"]);
    room.run(&["flatten", "tube.obj", "--cut", "30,31", "-o", "no"]).ends(2).says(&[
        "--cut 30,31",
        "single edge",
        "further on",
    ]);
    // Where a single edge goes on from another cut it opens.
    assert_eq!(laid(&["tube.obj", "--cut", "5,149", "--cut", "77,78"])["pieces"][0]["particles"], 25 * 7 + 1);
    assert!(room.names("no").is_empty());
}

/// Of a file whose faces share no vertices every triangle is a part: what to do about it must not be buried.
#[test]
fn of_many_parts_the_first_are_shown() {
    let room = Room::new();
    let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    let faces = |k: usize| {
        format!("f {} {} {}\nf {} {} {}\n", 6 * k + 1, 6 * k + 2, 6 * k + 3, 6 * k + 4, 6 * k + 5, 6 * k + 6)
    };
    let text: String = (0..30).map(|k| corners.replace(" 0\n", &format!(" {k}\n")) + &faces(k)).collect();
    room.put("soup.obj", &text);
    let run = room.run(&["flatten", "soup.obj", "-o", "flat", "--units", "cm", "--weld", "0", "--table"]);
    run.ends(0).says(&["--weld"]);
    assert!(run.out.contains("and 20 more, which report.json has") && run.out.lines().count() < 50, "{}", run.out);
    let pieces = |weld: &[&str]| {
        let all = room.run(&[&["flatten", "soup.obj", "-o", "flat", "--units", "cm", "--json"], weld].concat()).json();
        all["pieces"].as_array().map(Vec::len)
    };
    assert_eq!((pieces(&["--weld", "0"]), pieces(&[])), (Some(60), Some(30)));
}

/// Triangles that have no vertices in common do not say which of four that meet on a line are one surface.
#[test]
fn a_soup_of_triangles_is_told_what_is_not_seen() {
    let room = Room::new();
    let squares = [[[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0]], [[9, 0, 0], [18, 0, 0], [18, 9, 0], [9, 9, 0]]];
    let upright = [[[9, 0, -9], [9, 9, -9], [9, 9, 0], [9, 0, 0]], [[9, 0, 0], [9, 9, 0], [9, 9, 9], [9, 0, 9]]];
    let soup = |squares: &[[[i32; 3]; 4]]| {
        let corner = |[x, y, z]: [i32; 3]| format!("v {x} {y} {z}\n");
        let vertices: String = squares.iter().flatten().map(|p| corner(*p)).collect();
        let faces = (0..squares.len()).map(|k| format!("f {} {} {} {}\n", 4 * k + 1, 4 * k + 2, 4 * k + 3, 4 * k + 4));
        vertices + &faces.collect::<String>()
    };
    room.put("flat.obj", &soup(&squares));
    let run = room.run(&["check", "--mesh", "flat.obj", "--units", "mm"]);
    run.ends(0);
    assert!(!run.err.contains("common vertices"), "{}", run.err);
    room.put("through.obj", &soup(&[squares, upright].concat()));
    let run = room.run(&["check", "--mesh", "through.obj", "--units", "mm"]);
    run.says(&["edges of triangles that lie on two or more others without common vertices: 1", "merge"]);
}

#[test]
fn faces_that_run_against_the_others_are_turned_and_one_sided_surfaces_are_named() {
    let room = Room::new();
    // Two faces the other way round.
    let turned = |line: &str| {
        let words: Vec<&str> = line.split(' ').collect();
        [words[0], words[4], words[3], words[2], words[1]].join(" ")
    };
    let mut faces = 0;
    let spoilt = tube(true).lines().fold(String::new(), |mut text, line| {
        faces += usize::from(line.starts_with('f'));
        text += &if line.starts_with('f') && [7, 40].contains(&faces) { turned(line) } else { line.to_owned() };
        text + "\n"
    });
    room.put("tube.obj", &spoilt);
    let said = ["2 of its 144 faces", "face 7"];
    let report = room.run(&["flatten", "tube.obj", "-o", "flat", "--json"]).ends(0).says(&said).json();
    assert_eq!(report["pieces"][0]["flips"], 0);
    // A strip of paper with half a turn.
    let mut strip = String::new();
    for k in 0..40 {
        let angle = f64::from(k) * std::f64::consts::TAU / 40.0;
        for side in [-20.0, 20.0] {
            let (out, up) = (100.0 + side * (angle / 2.0).cos(), side * (angle / 2.0).sin());
            strip += &format!("v {} {up} {}\n", out * angle.cos(), out * angle.sin());
        }
    }
    for k in 0..39 {
        let a = 2 * k + 1;
        strip += &format!("f {a} {} {} {}\n", a + 1, a + 3, a + 2);
    }
    strip += "f 79 80 1 2\n";
    room.put("strip.obj", &strip);
    let said = ["a Möbius strip", "one side only", "--cut auto would cut from vertex"];
    room.run(&["flatten", "strip.obj", "--units", "mm", "-o", "no"]).ends(2).says(&said);
    let flat = room.run(&["flatten", "strip.obj", "--units", "mm", "--cut", "auto", "-o", "flat", "--json"]).json();
    assert_eq!(flat["pieces"][0]["particles"], 82);
}

/// Domes over squares of 20 cm, so many mm high, side by side in an OBJ, a group each.
fn domes(heights: &[(&str, f64)]) -> String {
    let mut text = String::new();
    for (k, (name, height)) in (0..).zip(heights) {
        text += &format!("g {name}\n");
        for (row, column) in (0..=24).flat_map(|row| (0..=24).map(move |column| (row, column))) {
            let [x, y] = [row, column].map(|k| f64::from(k) / 12.0 - 1.0);
            let up = height * (1.0 - x * x) * (1.0 - y * y);
            text += &format!("v {} {} {up}\n", 100.0 * x + 300.0 * f64::from(k), 100.0 * y);
        }
        for (row, column) in (0..24).flat_map(|row| (0..24).map(move |column| (row, column))) {
            let a = 625 * k + 25 * row + column + 1;
            text += &format!("f {a} {} {} {}\n", a + 25, a + 26, a + 1);
        }
    }
    text
}

#[test]
fn a_dart_is_proposed_where_cloth_would_be_strained_and_cut_when_asked() {
    let room = Room::new();
    room.put("dome.obj", &domes(&[("dome", 60.0)]));
    let run =
        |more: &[&str]| room.run(&[&["flatten", "dome.obj", "-o", "flat", "--json", "--units", "mm"], more].concat());
    let whole = run(&[]).ends(0).says(&["--dart auto"]).json();
    let strain = |report: &Value| report["pieces"][0]["strain"]["p99"].as_f64().expect("a number");
    assert!(strain(&whole) > 0.1, "{}", strain(&whole));
    assert_eq!(whole["pieces"][0]["dart"]["tip"], 25 * 12 + 12 + 1, "the summit");
    // What a fabric gives is less than ten per cent for poplin and more for a rib.
    run(&["--fabric", "cotton_poplin"]).ends(1).says(&["cotton_poplin gives", "--dart auto"]);
    assert_eq!(run(&["--fabric", "rib", "--mode", "woven"]).ends(0).json()["pieces"][0]["dart"], Value::Null);
    let poplin = run(&["--fabric", "cotton_poplin"]);
    poplin.says(&["out of bounds: 'dome' cannot be laid flat in cotton_poplin without a cut or dart", "full load"]);
    assert_eq!((&poplin.json()["pieces"][0]["layable"], &whole["pieces"][0]["layable"]), (&false.into(), &true.into()));
    run(&["--fabric", "rib", "--limit", "5"]).ends(2).says(&["--limit", "--fabric"]);
    run(&["--spacing", "5"]).ends(2).says(&["--spacing", "garment file"]);
    let darted = run(&["--dart", "auto"]).ends(0).json();
    assert!(strain(&darted) < 0.8 * strain(&whole), "{} {}", strain(&darted), strain(&whole));
    assert!(darted["cuts"].as_array().is_some_and(|c| !c.is_empty()));
    assert_eq!(darted["pieces"][0]["flips"], 0);
    run(&["--dart", "0"]).ends(2).says(&["--dart", "'auto' or a number"]);
}

#[test]
fn the_next_dart_goes_into_the_part_that_is_strained_most() {
    let room = Room::new();
    room.put("two.obj", &domes(&[("shallow", 25.0), ("steep", 90.0)]));
    let run = |dart: &str, limit: &str| {
        let args = ["flatten", "two.obj", "-o", "flat", "--json", "--units", "mm", "--dart", dart, "--limit", limit];
        room.run(&args)
    };
    let darts = |report: &Value| [0, 1].map(|k| report["pieces"][k]["darts"].as_u64().expect("a count"));
    let stopped = |report: &Value| [0, 1].map(|k| report["pieces"][k]["darts_stopped"].clone());
    // Both are beyond the limit; with a dart the steep one still needs the second more than the shallow one its first.
    let two = run("2", "3").ends(0).says(&["'steep'", "has 2 darts", "'shallow'", "--dart allows 2"]).json();
    assert_eq!(darts(&two), [0, 2]);
    assert_eq!(stopped(&two), ["none_left", "none_left"]);
    assert_eq!(two["cuts"].as_array().map(Vec::len), Some(2));
    // No more are cut than are needed.
    let enough = run("auto", "10").ends(0).json();
    assert_eq!(stopped(&enough), [Value::Null, Value::Null]);
    let [shallow, steep] = darts(&enough);
    assert!(shallow == 0 && (2..8).contains(&steep), "{shallow} {steep}");
    assert!(enough["pieces"][1]["strain"]["p99"].as_f64().is_some_and(|s| s <= 0.1));
}

#[test]
fn darts_end_where_there_is_no_place_and_never_make_a_piece_lie_on_itself() {
    let room = Room::new();
    room.put("deep.obj", &domes(&[("deep", 300.0), ("steep", 90.0)]));
    let args = ["flatten", "deep.obj", "-o", "flat", "--json", "--units", "mm", "--dart", "60", "--limit", "5"];
    let report = room.run(&args).ends(0).says(&["'deep'", "no place for a dart", "--cut"]).json();
    let [deep, steep] = [0, 1].map(|k| &report["pieces"][k]);
    assert_eq!((&deep["overlaps"], &deep["darts_stopped"]), (&Value::from(0), &Value::from("no_place")));
    // The other gets what it needs all the same.
    assert_eq!(steep["darts_stopped"], Value::Null);
    let cut = [deep, steep].map(|piece| piece["darts"].as_u64().expect("a count"));
    assert!(cut[0] > 0 && cut[1] > 0 && cut[0] + cut[1] < 60, "{cut:?}");
    assert_eq!(report["cuts"].as_array().map(Vec::len), Some((cut[0] + cut[1]) as usize));
}

/// Every one of these must end with 2, say this, and write nothing.
#[test]
fn mistakes_in_garment_files() {
    let room = Room::new();
    let bomb: String = (1..40).map(|k| format!("a{k}: &a{k} [*a{p}, *a{p}, *a{p}, *a{p}]\n", p = k - 1)).collect();
    let cases: &[(String, &[&str])] = &[
        (skirt_with("left: L -200 0\n", "left: L -150 0\n"), &["front", "mm"]),
        (skirt_with("right: L 290 300\n      hem: L -290 300", "right: L -290 300\n      hem: L 290 300"), &["cross"]),
        (skirt_with("to: back.left", "to: back.lefd"), &["wrong.yaml:19:", "lefd", "left"]),
        (skirt_with("to: back.left", "to: bakc.left"), &["wrong.yaml:19:", "bakc", "back"]),
        (skirt_with("sew: front.right,", "sew: front.waist,"), &["mm"]),
        (skirt_with("free: [\"*.waist\", \"*.hem\"]", "free: [\"*.waist\"]"), &["hem"]),
        (skirt_with("free:", "  again: {sew: front.right, to: back.right}\nfree:"), &["right"]),
        (skirt_with("cotton_poplin", "coton_poplin"), &["wrong.yaml", "coton_poplin", "cotton_poplin"]),
        (skirt_with("woman_92", "woman_29"), &["woman_29", "woman_92"]),
        (skirt_with("body: woman_92\n", ""), &["wrong.yaml", "--body"]),
        (format!("{bomb}{SKIRT}"), &["wrong.yaml"]),
        ("\u{0}\u{1}".into(), &["wrong.yaml"]),
        (String::new(), &["wrong.yaml"]),
    ];
    for (text, words) in cases {
        room.put("wrong.yaml", text);
        room.make("wrong.yaml", &[]).ends(2).says(words);
        assert!(room.names("out").is_empty(), "{words:?}: {:?}", room.names("out"));
    }
}

#[test]
fn mistakes_in_arguments() {
    let room = Room::new();
    let wrong = |args: &[&str], words: &[&str]| {
        room.run(args).ends(2).says(words);
        assert!(room.names("out").is_empty(), "{args:?}");
    };
    wrong(&["make", "nowhere.yaml"], &["nowhere.yaml"]);
    wrong(&["make", "skirt.yaml", "--spacing", "-3"], &["--spacing"]);
    wrong(&["make", "skirt.yaml", "--spacing", "nan"], &["--spacing"]);
    wrong(&["make", "skirt.yaml", "--spacing", "10 %"], &["--spacing"]);
    wrong(&["make", "skirt.yaml", "--spacing", "40cm"], &["400 mm", "mm or less"]);
    wrong(&["make", "skirt.yaml", "--spacing", "400"], &["400 mm", "mm or less"]);
    wrong(&["make", "skirt.yaml", "--spacing", "0.01"], &["use >="]);
    wrong(&["make", "skirt.yaml", "--fabric", "denin"], &["denin", "did you mean 'denim'"]);
    wrong(&["make", "skirt.yaml", "--fabric", "no.yaml"], &["no.yaml"]);
    wrong(&["make", "skirt.yaml", "--body", "no.obj"], &["no.obj"]);
    wrong(&["make", "skirt.yaml", "--threads", "0"], &["--threads", "a whole number from 1 on"]);
    wrong(&["batch", "skirt.yaml", "-o", "store", "-j", "-1"], &["--jobs", "a whole number from 1 on"]);
    wrong(&["flatten", "a.obj", "--from", "b.obj"], &["--from"]);
    wrong(&["flatten", "a.yaml", "--cut", "auto"], &["--cut", "surface"]);
    wrong(&["flatten", "a.obj", "--up", "0,0,0"], &["--up", "X,Y,Z"]);
    wrong(&["flatten", "a.obj", "--corners", "-1"], &["0 to 1000"]);
    wrong(&["sow", "skirt.yaml"], &["sow", "sew"]);
    room.run(&["--help"]).ends(0);
    assert!(room.run(&["--version"]).ends(0).out.contains(env!("CARGO_PKG_VERSION")));
}

/// A file of a gigabyte is told to be too large before it is read.
#[test]
fn files_of_a_gigabyte() {
    let room = Room::new();
    for name in ["big.yaml", "big.obj"] {
        let file = File::create(room.dir.path().join(name)).expect("made");
        file.set_len(1 << 30).expect("a sparse file");
    }
    for args in [
        &["make", "big.yaml"][..],
        &["make", "skirt.yaml", "--body", "big.obj"],
        &["make", "skirt.yaml", "--body", "big.yaml"],
        &["make", "skirt.yaml", "--fabric", "big.yaml"],
        &["flatten", "big.obj"],
    ] {
        let run = room.run(args);
        run.ends(2).says(&["big."]);
        assert!(run.err.contains("MiB") || run.err.contains("1073741824 bytes"), "{}", run.err);
    }
    assert!(room.names("out").is_empty());
}

/// The mannequin's surface after something was done to it.
fn body_obj(spoil: impl Fn(&mut Mannequin)) -> String {
    let mut body = load("woman_92").expect("a mannequin");
    spoil(&mut body);
    mannequin_obj(&body)
}

#[test]
fn bodies_that_are_no_solids() {
    let room = Room::new();
    let cases: [(String, &[&str]); 5] = [
        (body_obj(|b| b.mesh.triangles.truncate(b.mesh.triangles.len() - 1)), &["body.obj", "open", "close its holes"]),
        (body_obj(|b| b.mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2))), &["body.obj", "inside out", "flip"]),
        (body_obj(|b| b.mesh.vertices[7] = Vec3::repeat(f64::NAN)), &["body.obj:", "NaN"]),
        (
            body_obj(|b| b.mesh.vertices.iter_mut().filter(|p| p.x.abs() > 0.18).for_each(|p| p.x *= 0.3)),
            &["body.obj", "crosses itself"],
        ),
        ("v 0 0 0\nv 1 0 0\nf 1 2 3\n".into(), &["body.obj:3:", "vertex 3"]),
    ];
    for (text, words) in &cases {
        room.put("body.obj", text);
        room.make("skirt.yaml", &["--body", "body.obj"]).ends(2).says(words);
        assert!(room.names("out").is_empty(), "{words:?}");
    }
}

#[test]
fn folders_that_cannot_be_written_are_told_at_once() {
    let room = Room::new();
    room.put("file", "");
    // Half a million particles would take minutes.
    let run = room.run(&["make", "skirt.yaml", "-o", "file/deeper/still", "--spacing", "1"]);
    run.ends(2).says(&["file/deeper/still", "with -o"]);
    assert_eq!(room.names("."), ["file", "skirt.yaml"]);
}

#[test]
fn an_input_is_never_overwritten() {
    let room = Room::new();
    room.run(&["mannequin", "build", "woman_92", "-o", "garment.obj", "-q"]).ends(0);
    let before = room.bytes("garment.obj");
    let onto = ["make", "skirt.yaml", "--body", "garment.obj", "-o", ".", "--spacing", COARSE];
    room.run(&onto).ends(2).says(&["garment.obj", "is an input", "-o"]);
    room.put("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    room.run(&["flatten", "flat.obj", "-o", "."]).ends(2).says(&["flat.obj", "is an input"]);
    assert!(room.bytes("garment.obj") == before);
    // What the garment file names counts as much as what the user does; JSON is YAML, too.
    room.put("report.json", "{\"weight\": \"120 g/m2\", \"bend\": \"5e-6 N m\"}");
    room.put("coat.yaml", &skirt_with("cotton_poplin", "report.json"));
    let onto = ["make", "coat.yaml", "-o", ".", "--spacing", COARSE];
    room.run(&onto).ends(2).says(&["report.json", "is an input"]);
    for onto in ["export svg coat.yaml -o report.json", "test coat.yaml --junit report.json"] {
        let words: Vec<&str> = onto.split(' ').collect();
        room.run(&words).ends(2).says(&["report.json", "is an input"]);
    }
    assert_eq!(room.names("."), ["coat.yaml", "flat.obj", "garment.obj", "report.json", "skirt.yaml"]);
}

#[test]
fn quiet_says_nothing_and_bars_are_for_terminals() {
    let room = Room::new();
    let run = room.make("skirt.yaml", &["--json"]);
    run.ends(0);
    assert!(!run.err.contains('█') && !run.err.contains('\r'), "{}", run.err);
    let quiet = room.make("skirt.yaml", &["-q"]);
    assert_eq!((quiet.out.as_str(), quiet.err.as_str()), ("", ""));
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    let room = Room::new();
    let mut child =
        room.command(&["check", "skirt.yaml"]).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().expect("started");
    drop(child.stdout.take());
    assert_eq!(child.wait().expect("ended").code(), Some(0));
}

/// Makes the skirt on a fine mesh and interrupts it as soon as `ready` is so.
#[cfg(unix)]
fn interrupted(room: &Room, ready: impl Fn() -> bool) {
    let mut child = room
        .command(&["make", "skirt.yaml", "--spacing", "4", "-o", "out"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("started");
    while !ready() && child.try_wait().expect("a child").is_none() {
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(kill.expect("a kill command").success());
    assert_eq!(child.wait().expect("ended").code(), Some(130));
}

#[cfg(unix)]
#[test]
fn an_interrupt_ends_with_130_and_leaves_nothing() {
    let room = Room::new();
    // Once before anything is shown, once when the first look is.
    let begun = std::time::Instant::now();
    interrupted(&room, || begun.elapsed().as_millis() > 200);
    assert_eq!(room.names("."), ["skirt.yaml"]);
    interrupted(&room, || room.names("out").contains(&"garment.png".to_owned()));
    assert_eq!(room.names("."), ["skirt.yaml"]);
}

#[cfg(unix)]
#[test]
fn an_interrupt_leaves_earlier_results() {
    let room = Room::new();
    room.make("skirt.yaml", &[]).ends(0);
    let (names, earlier) = (room.names("out"), room.bytes("out/garment.png"));
    interrupted(&room, || room.bytes("out/garment.png") != earlier);
    assert_eq!(room.names("out"), names);
    assert!(room.bytes("out/garment.png") == earlier, "the picture is not the earlier one");
}

/// Every garment that is shipped passes its check.
#[test]
fn shipped_garments_are_right() {
    let room = Room::new();
    let patterns = Path::new(env!("CARGO_MANIFEST_DIR")).join("patterns");
    for entry in fs::read_dir(patterns).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|e| e == "yaml") {
            room.run(&["check", "-q", &path.display().to_string()]).ends(0);
        }
    }
}

/// Devices and pipes have no length and perhaps no end.
#[cfg(target_os = "linux")]
#[test]
fn endless_files() {
    let room = Room::new();
    for name in ["zero.yaml", "zero.obj"] {
        std::os::unix::fs::symlink("/dev/zero", room.dir.path().join(name)).expect("a link");
    }
    for name in ["pipe.yaml", "pipe.obj"] {
        let made = Command::new("mkfifo").arg(room.dir.path().join(name)).status();
        assert!(made.expect("mkfifo").success());
    }
    for ends in ["zero", "pipe"] {
        let (yaml, obj) = (format!("{ends}.yaml"), format!("{ends}.obj"));
        for args in [
            &["make", &yaml][..],
            &["check", &yaml],
            &["make", "skirt.yaml", "--body", &obj],
            &["make", "skirt.yaml", "--body", &yaml],
            &["make", "skirt.yaml", "--fabric", &yaml],
            &["drape", "skirt.yaml", "--from", &obj, "--spacing", COARSE],
            &["flatten", &obj],
        ] {
            room.run(args).ends(2).says(&[ends]);
        }
    }
    room.run(&["check", "/dev/zero"]).ends(2).says(&["/dev/zero", "bytes or more"]);
    assert!(room.names("out").is_empty());
}

/// A surface given for a garment is told in a few lines, wherever it is read.
#[test]
fn surfaces_that_are_no_garments() {
    let room = Room::new();
    room.run(&["mannequin", "build", "child_110", "-o", "child.obj", "-q"]).ends(0);
    let bytes: Vec<u8> = (0..100_000u32).map(|k| (k % 251) as u8 & 0x7f).collect();
    room.put("binary.yaml", &String::from_utf8(bytes).expect("ASCII"));
    for args in
        [&["make", "child.obj"][..], &["make", "binary.yaml"], &["make", "skirt.yaml", "--fabric", "binary.yaml"]]
    {
        let run = room.run(args);
        run.ends(2);
        assert!(run.err.len() < 3000, "{} bytes: {}", run.err.len(), run.err);
        assert!(!run.err.contains(|c: char| c.is_control() && !"\n\t".contains(c)), "{:?}", run.err);
    }
}

/// What a garment is made of stands in its file, and so do the mistakes in it.
#[test]
fn materials_are_blamed_on_their_line() {
    let room = Room::new();
    let cases: &[(String, &[&str])] = &[
        (skirt_with("woman_92", "woman_29"), &["w.yaml:3:7: error", "woman_29", "did you mean 'woman_92'"]),
        (skirt_with("woman_92", "anna.obj"), &["w.yaml:3:7: error", "anna.obj"]),
        (skirt_with("cotton_poplin", "coton_poplin"), &["w.yaml:4:18: error", "did you mean 'cotton_poplin'"]),
        (skirt_with("cotton_poplin", "shell"), &["w.yaml:4:18: error", "'shell' is based on itself"]),
        (
            skirt_with("cotton_poplin", "{base: shell, weight: 2}"),
            &["w.yaml:4:25: error", "'shell' is based on itself"],
        ),
        (skirt_with("cotton_poplin", "{base: denim, weight: 70 N}"), &["w.yaml:4:40: error", "weight '70 N'", "g/m2"]),
        (
            skirt_with("cotton_poplin", "{base: denim, tensile: {warp: {EMT: 5 kg}}}"),
            &["w.yaml:4:54: error", "'5 kg'", "%"],
        ),
        (skirt_with("cotton_poplin", "{base: denim, wieght: 70 g/m2}"), &["w.yaml:4:40: error", "no value 'wieght'"]),
        (skirt_with("cotton_poplin", "{weight: 70 g/m2}"), &["w.yaml:4:11: error", "no bend value"]),
        (skirt_with("cotton_poplin", "no.yaml"), &["w.yaml:4:18: error", "no.yaml"]),
    ];
    for (text, words) in cases {
        room.put("w.yaml", text);
        room.run(&["check", "w.yaml"]).ends(2).says(words);
        let json = room.run(&["check", "w.yaml", "--json"]);
        assert_eq!(json.ends(2).json()["ok"], false);
    }
    // What the command line asks for stands in no file.
    let run = room.run(&["make", "skirt.yaml", "--body", "woman_29"]);
    run.ends(2).says(&["woman_29", "did you mean 'woman_92'"]);
    assert!(!run.err.contains("skirt.yaml:3"), "{}", run.err);
    let run = room.run(&["make", "skirt.yaml", "--fabric", "denin"]);
    assert!(!run.ends(2).err.contains("skirt.yaml:4"), "{}", run.err);
}

/// What only the mesh finds is blamed on its line, too.
#[test]
fn what_cannot_be_meshed_is_blamed_on_its_line() {
    let room = Room::new();
    let free = "free: [\"*.waist\",";
    let short = skirt_with("      hem: L -290 300", "      h0: L 289.999 300\n      hem: L -290 300");
    room.put("w.yaml", &short.replace(free, "free: [\"*.waist\", \"*.h0\","));
    room.make("w.yaml", &[]).ends(2).says(&["w.yaml:14:7: error", "edge 'front.h0' is only 1.0e-3 mm long"]);
    let lines = "    lines: {a: {path: M -200 100 L 200 100, fold: 90}, b: {path: M -200 100 L 200 100, fold: 90}}\n";
    room.put("w.yaml", &skirt_with("    place: hip front\n", &format!("    place: hip front\n{lines}")));
    room.make("w.yaml", &[]).ends(2).says(&["w.yaml:7:3: error", "line 'b' and line 'a' cross"]);
}

/// The command line's unit before the garment file's; what is wrong is told in it.
#[test]
fn the_unit_of_a_body_is_what_its_user_says() {
    let room = Room::new();
    let open_in_inches = |b: &mut Mannequin| {
        b.mesh.vertices.iter_mut().for_each(|p| *p /= 25.4);
        b.mesh.triangles.truncate(b.mesh.triangles.len() - 1);
    };
    room.put("anna.obj", &body_obj(open_in_inches));
    room.put("said.yaml", &skirt_with("body: woman_92\n", "body: anna.obj\nbody_units: in\n"));
    let says = |garment: &str, more: &[&str], word: &str| {
        room.make(garment, more).ends(2).says(&["anna.obj: the surface is open", word]);
    };
    says("skirt.yaml", &["--body", "anna.obj", "--body-units", "in"], ") in; close its holes");
    says("skirt.yaml", &["--body", "anna.obj", "--body-units", "mm"], ") mm; close its holes");
    says("said.yaml", &[], ") in; close its holes");
    says("said.yaml", &["--body-units", "m"], ") m; close its holes");
    room.make("skirt.yaml", &["--body-units", "cm"]).ends(2).says(&["woman_92", "only .obj files come without one"]);
    room.make("said.yaml", &["--body-units", "ft"]).ends(2).says(&["mm", "cm", "in", "--body-units"]);
}

/// A hundred-and-fifty-metre body, a flat one, and a folder that is a file.
#[test]
fn sizes_and_places_that_make_no_sense() {
    let room = Room::new();
    room.put("body.obj", &body_obj(|b| b.mesh.vertices.iter_mut().for_each(|p| *p *= 100.0)));
    room.make("skirt.yaml", &["--body", "body.obj"]).ends(2).says(&["body.obj", "millimetres", "scale"]);
    room.put("body.obj", &body_obj(|b| b.mesh.vertices.iter_mut().for_each(|p| p.z = 0.0)));
    room.make("skirt.yaml", &["--body", "body.obj"]).ends(2).says(&["body.obj", "flat"]);
    room.put("file", "");
    room.run(&["make", "skirt.yaml", "-o", "file"]).ends(2).says(&["file is a file, not a folder", "with -o"]);
    let run = room.run(&["make", "skirt.yaml", "--spacing=1e-308"]);
    run.ends(2).says(&["1.0e-308 mm is too small", "particles (limit 2000000)", "use >= 0."]);
    assert!(room.run(&["make", "skirt.yaml", "--spacing=1e308"]).ends(2).err.len() < 300);
}

#[test]
fn garments_worn_over_one_another_need_one_body() {
    let room = Room::new();
    room.put("over.yaml", &SKIRT.replace("woman_92", "man_100"));
    let json = room.run(&["check", "skirt.yaml", "over.yaml", "--json", "-q"]).ends(0).json();
    assert_eq!(json["garment"], Value::from("skirt+over"));
    let pieces: Vec<&str> =
        json["pieces"].as_array().expect("pieces").iter().filter_map(|p| p["name"].as_str()).collect();
    assert!(
        pieces.iter().any(|p| p.starts_with("skirt/")) && pieces.iter().any(|p| p.starts_with("over/")),
        "{pieces:?}"
    );
    room.run(&["make", "skirt.yaml", "over.yaml", "-o", "both"]).ends(2).says(&["over.yaml", "man_100", "--body"]);
    let given = ["make", "skirt.yaml", "over.yaml", "-o", "both", "--fabric", "denim", "--body", "woman_92"];
    room.run(&given).ends(2).says(&["--fabric"]);
}
