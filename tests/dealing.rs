//! Which ends of the body pass through which opening of a garment: told from its own shape, for all kinds of garments,
//! whatever they are called.

use std::path::{Path, PathBuf};

use toile::io::garment::{read_text, write};
use toile::io::garmentcode;
use toile::pattern::Garment;
use toile::pipeline::{Job, Overrides, read};
use toile::sew::start::{Dealing, Ends, Glued, GluedOpening, deal, edges, glue, guess, openings};

/// What passes through an opening, and a piece or an edge on its rim.
type Worn = (&'static str, &'static str);

const SHIRT: [&str; 4] = ["head", "left arm", "right arm", "left leg + right leg"];
const TROUSERS: [&str; 3] = ["head + left arm + right arm", "left leg", "right leg"];
const SKIRT: [&str; 2] = ["head + left arm + right arm", "left leg + right leg"];
const OPEN: [&str; 3] = ["left arm", "right arm", "head + left leg + right leg"];

fn garment(file: &Path, body: Option<&Path>, spacing: f64) -> Job {
    let overrides =
        Overrides { spacing: Some(spacing), body: body.map(|b| b.display().to_string()), ..Overrides::default() };
    let loaded = if file.extension().is_some_and(|e| e == "json") {
        let text = std::fs::read_to_string(file).expect("a file");
        let read = garmentcode::read("imported", &text, garmentcode::Wearer::default()).expect("a specification");
        read_text("imported", "imported.yaml", &write(&read).expect("writable")).expect("a garment")
    } else {
        read(file).expect("a garment")
    };
    Job::new(file, loaded, &overrides).unwrap_or_else(|error| panic!("{}: {error}", file.display()))
}

fn own(file: &str) -> Job {
    garment(&Path::new(env!("CARGO_MANIFEST_DIR")).join(file), None, 0.02)
}

/// The garment file `text` under a name.
fn of_text(name: &str, text: &str) -> Job {
    let file = format!("{name}.yaml");
    let overrides = Overrides { spacing: Some(0.02), ..Overrides::default() };
    let loaded = read_text(name, &file, text).expect("a garment");
    Job::new(Path::new(&file), loaded, &overrides).expect("a job")
}

/// A top with one sleeve, whose halves are each other's mirror images and whose cuff is round: its own mirror image.
const ONE_SLEEVE: &str = "garment: 1
body: woman_92
pieces:
  front:
    grain: [[200, 250], [200, 350]]
    place: torso front
    outline: {start: 60 0, shoulder: L 130 0, neck: 'Q 250 160, 460 230', side_l: L 460 420, hem: L 0 420,
              side_r: L 0 230, armhole: L 60 0}
  back:
    grain: [[200, 250], [200, 350]]
    place: torso back
    outline: {start: 330 0, shoulder: L 400 0, armhole: L 460 230, side_r: L 460 420, hem: L 0 420, side_l: L 0 230,
              neck: 'Q 210 160, 330 0'}
  sleeve_front:
    grain: [[70, 200], [70, 300]]
    place: right arm front
    outline: {start: 0 0, cap: L 160 175.795, under: L 140 420, wrist: L 0 420, over: L 0 0}
  sleeve_back:
    grain: [[-70, 200], [-70, 300]]
    place: right arm back
    outline: {start: 0 0, over: L 0 420, wrist: L -140 420, under: L -160 175.795, cap: L 0 0}
  cuff_front:
    grain: [[70, 10], [70, 50]]
    place: right wrist front
    outline: {start: 0 0, top: L 140 0, under: L 140 60, end: L 0 60, over: L 0 0}
  cuff_back:
    grain: [[70, 10], [70, 50]]
    place: right wrist back
    outline: {start: 0 0, top: L 140 0, over: L 140 60, end: L 0 60, under: L 0 0}
seams:
  shoulder: {sew: front.shoulder, to: back.shoulder}
  side_r: {sew: front.side_r, to: back.side_r}
  side_l: {sew: front.side_l, to: back.side_l}
  armhole_front: {sew: front.armhole, to: sleeve_front.cap}
  armhole_back: {sew: back.armhole, to: sleeve_back.cap}
  over: {sew: sleeve_front.over, to: sleeve_back.over}
  under: {sew: sleeve_front.under, to: sleeve_back.under}
  wrist_front: {sew: sleeve_front.wrist, to: cuff_front.top}
  wrist_back: {sew: sleeve_back.wrist, to: cuff_back.top}
  cuff_over: {sew: cuff_front.over, to: cuff_back.over}
  cuff_under: {sew: cuff_front.under, to: cuff_back.under}
free: ['*.neck', '*.hem', '*.end']
";

#[test]
fn a_sleeve_of_which_there_is_one_has_an_arm_in_it() {
    // Words tell front from back, or else the back's neck, which is less deep.
    let shallow = ONE_SLEEVE.replace("Q 210 160", "Q 210 60");
    let silent = ["right arm front", "right arm back", "right wrist front", "right wrist back"]
        .iter()
        .fold(shallow, |text, place| text.replace(place, if place.contains("arm") { "arm" } else { "wrist" }));
    for text in [ONE_SLEEVE, &silent] {
        let job = of_text("one_sleeve", text);
        let (_, rows) = worn(&job, &job.garment);
        let sleeve = rows.iter().find(|(_, edges)| edges.iter().any(|name| name.starts_with("cuff_front")));
        assert!(sleeve.is_some_and(|(ends, _)| ends.ends_with(" arm")), "{rows:?}");
        assert_eq!(rows.len(), 3, "{rows:?}");
    }
}

/// A swimsuit in two pieces on the fold, without a word of front or back. Its back is cut lower than its front.
const SWIMSUIT: &str = "garment: 1
body: woman_92
fabrics: {shell: nylon_spandex_knit}
pieces:
  a:
    cut: fold center
    drawn: L
    grain: [[40, 250], [40, 500]]
    outline: {start: 0 170, neck: 'C 60 170, 80 100, 85 0', strap: L 115 0, armhole: 'C 110 120, 130 220, 200 240',
              side: 'C 175 380, 175 420, 205 560', leg: 'C 130 590, 60 660, 38 760', crotch: L 0 760, center: L 0 170}
  b:
    place: torso
    cut: fold center
    drawn: R
    grain: [[40, 300], [40, 500]]
    outline: {start: 0 260, neck: 'C 60 260, 80 160, 85 0', strap: L 115 0, armhole: 'C 112 120, 140 225, 200 240',
              side: 'C 175 380, 175 420, 205 560', leg: 'C 180 680, 90 740, 38 800', crotch: L 0 800, center: L 0 260}
seams:
  strap: {sew: a.strap, to: b.strap}
  side: {sew: a.side, to: b.side}
  crotch: {sew: a.crotch, to: b.crotch}
free: ['*.neck', '*.armhole', '*.leg']
";

#[test]
fn halves_of_a_piece_on_the_fold_go_to_their_own_sides() {
    // With the drawn halves exchanged it is worn the other way round: `a` is the back then.
    let turned =
        SWIMSUIT.replace("drawn: L", "drawn: #").replace("drawn: R", "drawn: L").replace("drawn: #", "drawn: R");
    for text in [SWIMSUIT, &turned] {
        let job = of_text("swimsuit", text);
        let own = [("left arm", "a.armhole.L"), ("right arm", "b.armhole.R"), ("left leg", "b.leg.L")];
        check(&job, &["head", "left arm", "right arm", "left leg", "right leg"], &own);
    }
}

/// What passes through every opening of a garment that something passes through, with the edges there.
fn worn(job: &Job, garment: &Garment) -> (Dealing, Vec<(String, Vec<String>)>) {
    let glued = glue(garment, &job.mesh, &[]);
    let found = openings(&glued, &job.mesh);
    let dealing = deal(garment, &job.mesh, &glued, &found, &job.body);
    let dealing = dealing.unwrap_or_else(|error| panic!("{}: {error}", job.file.display()));
    let rows = rows(job, garment, &dealing, &glued, &found);
    (dealing, rows)
}

/// The openings that something passes through, with the edges there.
fn rows(
    job: &Job,
    garment: &Garment,
    dealing: &Dealing,
    glued: &Glued,
    found: &[GluedOpening],
) -> Vec<(String, Vec<String>)> {
    let rows = found.iter().zip(&dealing.ends).filter(|(_, ends)| !ends.is_empty());
    rows.map(|(o, ends)| (ends.to_string(), edges(garment, &job.mesh, glued, o))).collect()
}

/// Checks the openings of a garment and, for some of them, a piece or an edge on their rims.
fn check(job: &Job, openings: &[&str], at: &[Worn]) {
    is_dealt_so(job, &worn(job, &job.garment).1, openings, at);
}

/// Checks the openings that something passes through and, for some of them, a piece or an edge on their rims.
fn is_dealt_so(job: &Job, rows: &[(String, Vec<String>)], openings: &[&str], at: &[Worn]) {
    let mut found: Vec<&str> = rows.iter().map(|r| r.0.as_str()).collect();
    let mut wanted = openings.to_vec();
    found.sort_unstable();
    wanted.sort_unstable();
    assert_eq!(found, wanted, "{}: {rows:?}", job.file.display());
    for (ends, edge) in at {
        let is_there = rows.iter().any(|(e, edges)| e == ends && edges.iter().any(|name| name.starts_with(edge)));
        assert!(is_there, "{}: {ends} at {edge}: {rows:?}", job.file.display());
    }
}

#[test]
fn garments_of_this_project_are_worn_as_anyone_would() {
    let cases: [(&str, &[&str], &[Worn]); 15] = [
        ("patterns/tshirt.yaml", &SHIRT, &[("left arm", "sleeve.L"), ("left leg + right leg", "front.hem")]),
        ("patterns/child_dress.yaml", &SHIRT, &[("right arm", "sleeve.R"), ("head", "front.L.neck")]),
        ("patterns/sheath_dress.yaml", &SHIRT, &[("left arm", "front.armhole.L"), ("head", "front.neck")]),
        ("patterns/trousers.yaml", &TROUSERS, &[("left leg", "front.L.hem"), ("right leg", "front.R.hem")]),
        ("patterns/gore_skirt.yaml", &SKIRT, &[("left leg + right leg", "front.L.hem")]),
        ("tests/data/boxy_shirt.yaml", &SHIRT, &[("left arm", "front.armhole_left"), ("head", "front.neck")]),
        ("tests/data/collar.yaml", &SHIRT, &[("head", "stand"), ("right arm", "front.R.armhole")]),
        ("tests/data/faced_top.yaml", &SHIRT, &[("head", "front.neck")]),
        ("tests/data/lined_top.yaml", &SHIRT, &[("left arm", "front.armhole.L")]),
        ("tests/data/raglan.yaml", &SHIRT, &[("left arm", "sleeve.L.wrist")]),
        ("tests/data/skirt.yaml", &SKIRT, &[("left leg + right leg", "front.hem")]),
        ("tests/data/pleated.yaml", &SKIRT, &[("left leg + right leg", "front.hem")]),
        ("tests/data/box_pleat.yaml", &SKIRT, &[("left leg + right leg", "front.hem")]),
        ("tests/data/overlay.yaml", &SKIRT, &[("left leg + right leg", "front.hem")]),
        ("tests/data/elastic_waist.yaml", &SKIRT, &[("left leg + right leg", "front.hem")]),
    ];
    for (file, openings, at) in cases {
        check(&own(file), openings, at);
    }
}

#[test]
fn what_lies_on_other_cloth_is_no_part_of_the_surface() {
    for (file, wanted) in [
        ("tests/data/lined.yaml", vec!["front_lining", "back_lining"]),
        ("tests/data/faced_top.yaml", vec!["front_facing", "back_facing"]),
        ("tests/data/overlay.yaml", vec!["overlay"]),
        ("tests/data/collar.yaml", vec![]),
    ] {
        let job = own(file);
        let out = glue(&job.garment, &job.mesh, &[]).left_out;
        let mut names: Vec<&str> = out.iter().map(|&piece| job.garment.pieces[piece].name.as_str()).collect();
        let mut wanted = wanted;
        names.sort_unstable();
        wanted.sort_unstable();
        assert_eq!(names, wanted, "{file}");
    }
}

/// Gives pieces, edges and seams names that mean nothing.
fn scrambled(garment: &Garment) -> Garment {
    let mut out = garment.clone();
    let mut drawn: Vec<String> = out.pieces.iter().map(|piece| piece.drawn_as.clone()).collect();
    drawn.sort_unstable();
    drawn.dedup();
    for (i, piece) in out.pieces.iter_mut().enumerate() {
        let number = drawn.iter().position(|name| *name == piece.drawn_as).expect("a drawn piece");
        // The other way round, so that an order by name is another one.
        piece.drawn_as = format!("p{}", drawn.len() - number);
        piece.name = format!("q{}", 1000 - i);
        for edge in piece.loops.iter_mut().flatten() {
            edge.name = "e".into();
        }
    }
    out.seams.iter_mut().enumerate().for_each(|(i, seam)| seam.name = format!("s{i}"));
    out
}

#[test]
fn names_decide_nothing() {
    for file in
        ["patterns/trousers.yaml", "patterns/tshirt.yaml", "tests/data/collar.yaml", "tests/data/lined_top.yaml"]
    {
        let job = own(file);
        let (named, _) = worn(&job, &job.garment);
        let (renamed, _) = worn(&job, &scrambled(&job.garment));
        assert_eq!((named.ends, named.front, named.zips), (renamed.ends, renamed.front, renamed.zips), "{file}");
    }
}

#[test]
fn a_word_that_was_given_changes_nothing_that_is_clear_without_it() {
    for file in
        ["patterns/trousers.yaml", "patterns/child_dress.yaml", "tests/data/collar.yaml", "tests/data/raglan.yaml"]
    {
        let job = own(file);
        let mut bare = job.garment.clone();
        bare.pieces.iter_mut().for_each(|piece| piece.place = None);
        assert_eq!(worn(&job, &job.garment).0.ends, worn(&job, &bare).0.ends, "{file}");
    }
}

/// Data beside the project, if they are there.
fn beside(folder: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared").join(folder);
    if path.is_dir() {
        return Some(path);
    }
    println!("skipped: {} is not there", path.display());
    None
}

#[test]
fn ordinary_garments_drafted_by_hand_are_worn_as_anyone_would() {
    let Some(folder) = beside("cases/sew") else { return };
    // Uncrossed, each strap lies between the head and an arm.
    let dungarees = ["head", "left arm", "left leg", "right arm", "right leg"];
    let halter = ["head", "left arm + right arm", "left leg + right leg"];
    let cases: [(&str, &[&str], &[Worn]); 18] = [
        ("mans_shirt", &SHIRT, &[("left arm", "cuff.L"), ("head", "collar")]),
        ("fs_simon", &SHIRT, &[("left arm", "cuff.L"), ("head", "collar"), ("left leg + right leg", "back.d")]),
        ("fs_simon_placewords", &SHIRT, &[("left arm", "sleeve.L"), ("head", "yoke")]),
        ("batwing", &SHIRT, &[("left arm", "front.cuff.L")]),
        ("blouse", &SHIRT, &[("right arm", "band.R"), ("head", "collar")]),
        ("cardigan", &SHIRT, &[("right arm", "sleeve.R"), ("head", "neckband")]),
        ("fs_aaron_armbinding", &SHIRT, &[("left arm", "armBinding.L"), ("head", "neckBinding")]),
        ("fs_diana", &SHIRT, &[("left arm", "sleeve.L"), ("head", "front.a")]),
        ("fs_hugo_hood", &SHIRT, &[("left arm", "cuff.L"), ("head", "hoodSide")]),
        ("slip_bias", &SHIRT, &[("left arm", "strap.L"), ("left leg + right leg", "front.hem")]),
        ("fs_bruce", &TROUSERS, &[("left leg", "inset.L"), ("right leg", "inset.R")]),
        ("fs_lily", &TROUSERS, &[("left leg", "front.L"), ("head + left arm + right arm", "waistband")]),
        ("leggings", &TROUSERS, &[("left leg", "leg.L"), ("right leg", "leg.R")]),
        ("dungarees", &dungarees, &[("left leg", "front.L.hem"), ("left arm", "bib.side.L")]),
        ("bolero", &OPEN, &[("left arm", "sleeve.L")]),
        ("kimono", &OPEN, &[("right arm", "sleeve.R")]),
        ("poncho_shoulder_seam", &["head", "left arm + right arm + left leg + right leg"], &[("head", "front.neck")]),
        ("bralette", &halter, &[("left leg + right leg", "band.hem")]),
    ];
    for (name, openings, at) in cases {
        let fine = ["slip_bias", "bralette"].contains(&name);
        let job = garment(&folder.join(format!("{name}.yaml")), None, if fine { 0.01 } else { 0.02 });
        check(&job, openings, at);
    }
}

#[test]
fn garments_of_garmentcode_are_worn_as_anyone_would() {
    let Some(folder) = beside("garmentcode") else { return };
    let body = folder.join("mean_all.obj");
    let jumpsuit = ["head", "left arm", "right arm", "left leg", "right leg"];
    let cases: [(&str, &[&str]); 10] = [
        ("dress_pencil", &SHIRT),
        ("fitted_shirt_sleeve_collar", &SHIRT),
        ("hoodie", &SHIRT),
        ("jumpsuit", &jumpsuit),
        ("pants_long", &TROUSERS),
        ("shorts", &TROUSERS),
        ("skirt_circle", &SKIRT),
        ("skirt_pencil", &SKIRT),
        ("tank", &SHIRT),
        ("tshirt", &SHIRT),
    ];
    for (name, openings) in cases {
        let file = folder.join(name).join(format!("{name}_specification.json"));
        check(&garment(&file, Some(&body), 0.02), openings, &[]);
    }
}

#[test]
fn a_top_over_one_shoulder_has_that_arm_in_its_armhole() {
    let text = include_str!("data/one_shoulder.yaml");
    let job = of_text("one_shoulder", text);
    check(&job, &["left arm", "head + right arm", "left leg + right leg"], &[("left arm", "a."), ("left arm", "c.")]);
    // Worn back to front it would be over the right shoulder.
    let turned = text.replace("torso front", "torso x").replace("torso back", "torso front");
    let job = of_text("one_shoulder", &turned.replace("torso x", "torso back"));
    check(&job, &["right arm", "head + left arm", "left leg + right leg"], &[("right arm", "a.")]);
}

/// Garments that words were needed for: their dealing was wrong, and said to be clear.
#[test]
fn garments_without_words_are_worn_as_anyone_would() {
    let cases: [(&str, &[&str], &[Worn]); 7] = [
        // The sides are 57 mm long.
        ("bikini", &TROUSERS, &[("head + left arm + right arm", "front.waist")]),
        // Nothing passes through the mouths: the bags close them.
        ("slash_pockets", &TROUSERS, &[("head + left arm + right arm", "waistband"), ("left leg", "cuff.L")]),
        // Sleeves hang below holes that are as wide.
        ("cold_shoulder", &SHIRT, &[("left arm", "sleeve.L.hem"), ("head", "front.neck")]),
        // One hook at the corner of the neck closes the ring of the neckline.
        ("hooked_cape", &["head", "left arm + right arm + left leg + right leg"], &[("head", "back.neck")]),
        // Below its last button it is open to the hem.
        ("coat", &SHIRT, &[("left leg + right leg", "front.L.hem"), ("head", "front.R.lapel")]),
        // Front and back are mirror images of one another, if roughly.
        (
            "one_shoulder_dress",
            &["left arm", "head + right arm", "left leg + right leg"],
            &[("left arm", "front.armhole")],
        ),
        // A top as wide as a wide neck, and a hem as wide as that of a poncho.
        ("bustier", &SKIRT, &[("head + left arm + right arm", "side_front.L.top")]),
    ];
    for (name, wanted, at) in cases {
        let job = own(&format!("tests/data/{name}.yaml"));
        let glued = glue(&job.garment, &job.mesh, &[]);
        let found = openings(&glued, &job.mesh);
        let dealing = guess(&job.garment, &job.mesh, &glued, &found, &job.body);
        assert!(dealing.margin > 0.4, "{name}: the next dealing costs {} more", dealing.margin);
        is_dealt_so(&job, &rows(&job, &job.garment, &dealing, &glued, &found), wanted, at);
    }
}

/// Below its last button the fronts of a coat are lapped for the start, and its hem is no longer than that of a closed
/// coat.
#[test]
fn the_slit_below_the_last_button_is_closed_for_the_start() {
    let job = own("tests/data/coat.yaml");
    let length = |zips: &[[u32; 2]]| {
        let glued = glue(&job.garment, &job.mesh, zips);
        let found = openings(&glued, &job.mesh);
        let dealing = guess(&job.garment, &job.mesh, &glued, &found, &job.body);
        let hem = dealing.ends.iter().position(|ends| *ends == Ends::LEGS).expect("a hem");
        (found[hem].length, glued.laps[0].pairs.len(), dealing.zips)
    };
    let (open, short, zips) = length(&[]);
    let (closed, long, _) = length(&zips);
    // The slit is 470 mm long, and has two sides.
    assert!(open - closed > 0.9, "{open} m and {closed} m");
    // A front reaches 160 mm over the other one.
    assert!((closed - 1.21).abs() < 0.03, "{closed} m");
    assert!(long > short + 15, "{short} and {long} particles of its rim lie over the other front");
}
