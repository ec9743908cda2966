use super::*;
use crate::io::garment::examine_text;
use crate::mannequin;
use crate::pattern::Value;

const FILE: &str = "\
garment: 1   # a skirt
body: woman_92
pieces:
  front:   # the front
    cut: fold center
    notches: {side: [60]}
    outline: {start: 0 0, waist: L 90 0, side: L 90 60, hem: L 0 60, center: L 0 0}
  back: {like: front}
  band:
    place: waist   # for now
    outline: {start: 0 0, top: L 360 0, right: L 360 8, bottom: L 0 8, left: L 0 0}
seams:
  # closes the band
  close: {sew: band.left, to: band.right}
free: ['front.*', 'back.*', band.top, band.bottom]   # until sewn
tests:
  - {gap: all, below: 1 mm}
";

fn done(act: &Act) -> Result<String, ActError> {
    done_in(FILE, act)
}

fn done_in(text: &str, act: &Act) -> Result<String, ActError> {
    act.done(text, Path::new("skirt.yaml")).map(|done| {
        for comment in ["# a skirt", "# the front", "# until sewn"] {
            assert!(!text.contains(comment) || done.text.contains(comment), "{comment} is lost: {}", done.text);
        }
        done.text
    })
}

fn said(text: &str) -> GarmentFile {
    read_file_only("skirt.yaml", text).expect("a garment")
}

fn names(list: &[Located<String>]) -> Vec<&str> {
    list.iter().map(|item| item.value.as_str()).collect()
}

fn strings(list: &[&str]) -> Vec<String> {
    list.iter().map(|item| (*item).to_owned()).collect()
}

fn sew(sew: &[&str], to: &[&str]) -> Act {
    Act::Sew { sew: strings(sew), to: strings(to) }
}

#[test]
fn two_edges_are_sewn_and_free_no_more() {
    let text = done(&sew(&["front.side"], &["back.side"])).expect("sewn");
    let file = said(&text);
    let seam = file.seams.last().expect("a seam");
    assert_eq!((names(&seam.sew), names(&seam.to)), (vec!["front.side"], vec!["back.side"]));
    assert_eq!(seam.name.value, "front_back");
    // Of the pieces that were free as a whole the rest is, but not the fold.
    let free = ["band.top", "band.bottom", "front.waist", "front.hem", "back.waist", "back.hem"];
    assert_eq!(names(&file.free), free);
    assert!(text.contains("  # closes the band\n  close: {sew: band.left, to: band.right}\n  front_back: {"), "{text}");
    assert_eq!(file, GarmentFile { seams: file.seams.clone(), free: file.free.clone(), ..said(FILE) });
    // A chain, then.
    let chained = done_in(&text, &sew(&["band.bottom"], &["front.waist", "back.waist"])).expect("sewn");
    let file = said(&chained);
    assert_eq!(names(&file.seams[2].to), ["front.waist", "back.waist"]);
    assert_eq!(names(&file.free), ["band.top", "front.hem", "back.hem"]);
}

#[test]
fn what_was_free_in_one_word_is_named() {
    let text = FILE.replace("['front.*', 'back.*', band.top, band.bottom]", "['*.*']");
    let text = done_in(&text, &sew(&["front.side"], &["front.hem"])).expect("sewn");
    assert_eq!(names(&said(&text).free), ["front.waist", "back.*", "band.top", "band.bottom"]);
}

#[test]
fn seams_that_make_no_sense_are_refused() {
    for (a, b, why) in [
        (vec!["front.side"], vec!["front.side"], "chosen twice"),
        (vec!["front.center"], vec!["back.side"], "on the fold"),
        (vec!["band.left"], vec!["back.side"], "in the seam 'close' already"),
        (vec!["front.slide"], vec!["back.side"], "no edge 'front.slide'"),
        (vec!["front"], vec!["back.side"], "is no edge"),
        (vec![], vec!["back.side"], "choose an edge"),
    ] {
        let refused = done(&sew(&a, &b)).expect_err("refused").to_string();
        assert!(refused.contains(why), "{refused}");
    }
}

#[test]
fn an_offer_is_taken_as_it_was_made() {
    let offers = suggestions(&said(FILE));
    let offer = offers.iter().find(|offer| offer.sew == ["front.side"]).expect("an offer");
    let act = Act::Accept { sew: offer.sew.clone(), to: offer.to.clone() };
    let text = done(&act).expect("taken");
    assert_eq!(said(&text).seams.last(), Some(&offer.seam()));
    assert!(matches!(done_in(&text, &act), Err(ActError::Sense(_))), "it is not offered twice");
}

#[test]
fn a_seam_is_unpicked() {
    let text = done(&Act::Unpick { seam: "close".into() }).expect("unpicked");
    assert_eq!(said(&text), GarmentFile { seams: Vec::new(), ..said(FILE) });
    assert!(done(&Act::Unpick { seam: "open".into() }).is_err());
}

#[test]
fn edges_are_set_free_and_back() {
    let free = Act::Free { edges: vec!["band.left".into()] };
    assert!(done(&free).expect_err("sewn").to_string().contains("unpick"));
    let unpicked = done(&Act::Unpick { seam: "close".into() }).expect("unpicked");
    let freed = done_in(&unpicked, &free).expect("free");
    assert_eq!(said(&freed).free.last().map(|f| f.value.clone()), Some("band.left".into()));
    let back = done_in(&freed, &Act::Unfree { edges: vec!["band.left".into()] }).expect("not free");
    assert_eq!(back, unpicked);
    let unfreed = done(&Act::Unfree { edges: vec!["back.hem".into()] }).expect("not free");
    assert_eq!(names(&said(&unfreed).free), ["front.*", "band.top", "band.bottom", "back.waist", "back.side"]);
}

#[test]
fn an_edge_is_named_wherever_it_is_named() {
    let named = |edge: &str, name: &str| done(&Act::Name { edge: edge.into(), name: name.into() });
    let text = named("back.side", "flank").expect("named");
    // The outline is the front's, which the back is like.
    assert_eq!(text, FILE.replace("side", "flank"));
    assert_eq!(
        named("band.left", "end").expect("named"),
        FILE.replace("left: L", "end: L").replace("band.left", "band.end")
    );
    assert_eq!(named("front.center", "middle").expect("named"), FILE.replace("center", "middle"));
    assert_eq!(said(&named("band.top", "upper").expect("named")).free[2].value, "band.upper");
    for name in ["hem", "L", "start", "a b", "", "x: 1", "1", "ä", "<b>"] {
        assert!(named("front.side", name).is_err(), "{name}");
    }
}

#[test]
fn references_keep_their_sides_and_ranges() {
    let more = FILE.replace("seams:\n", "seams:\n  part: {sew: front.L.side@0..20, to: back.side.L@0..20}\n");
    let text = done_in(&more, &Act::Name { edge: "front.side".into(), name: "flank".into() }).expect("named");
    assert!(text.contains("part: {sew: front.L.flank@0..20, to: back.flank.L@0..20}"), "{text}");
}

#[test]
fn a_piece_is_placed() {
    let place = |piece: &str, words: &[&str]| done(&Act::Place { piece: piece.into(), words: strings(words) });
    assert_eq!(place("band", &["hip", "front"]).expect("placed"), FILE.replace("waist   #", "hip front   #"));
    let text = place("back", &["hip", "back"]).expect("placed");
    assert_eq!(text, FILE.replace("{like: front}", "{like: front, place: hip back}"));
    let text = place("front", &["hip", "front"]).expect("placed");
    assert!(text.contains("center: L 0 0}\n    place: hip front\n  back:"), "{text}");
    assert_eq!(place("band", &[]).expect("none"), FILE.replace("    place: waist   # for now\n", ""));
    assert!(place("band", &["moon"]).is_err() && place("sleeve", &["arm"]).is_err());
}

#[test]
fn fabric_and_body_are_chosen() {
    let text = done(&Act::Fabric { name: "shell".into(), cloth: "denim".into() }).expect("chosen");
    assert!(text.ends_with("\n\nfabrics:\n  shell: denim\n"), "{text}");
    let again = done_in(&text, &Act::Fabric { name: "shell".into(), cloth: "silk_charmeuse".into() });
    let cloth = again.map(|text| said(&text).fabrics[0].1.value.clone());
    assert!(cloth.is_err() || cloth == Ok(Value::Text("silk_charmeuse".into())));
    assert!(done(&Act::Fabric { name: "shell".into(), cloth: "../../etc/passwd".into() }).is_err());
    let valued = format!("{FILE}fabrics: {{shell: {{base: denim, bend: 2}}}}\n");
    assert!(done_in(&valued, &Act::Fabric { name: "shell".into(), cloth: "denim".into() }).is_err());
    assert_eq!(
        done(&Act::Body { name: "man_100".into() }).ok(),
        mannequin::library().contains(&"man_100").then(|| FILE.replace("woman_92", "man_100"))
    );
    assert!(done(&Act::Body { name: "/etc/passwd".into() }).is_err());
    let measured = FILE.replace("body: woman_92", "body: {like: child_110, waist: 600}");
    let text = done_in(&measured, &Act::Body { name: "woman_92".into() }).expect("chosen");
    assert!(text.contains("body: {like: woman_92, waist: 600}"), "{text}");
}

#[test]
fn lengths_are_typed() {
    let ease = |value: &str| done(&Act::Ease { seam: "close".into(), value: value.into() });
    assert_eq!(ease(" 1.5 cm ").expect("eased"), FILE.replace("to: band.right}", "to: band.right, ease: 1.5 cm}"));
    assert!(ease("wide").is_err() && ease("5 miles").is_err() && ease("1, tolerance: 900").is_err());
    let text = ease("12").expect("eased");
    let at = strings(&["seams", "close", "ease"]);
    let longer = done_in(&text, &Act::Length { path: at, value: "14".into() }).expect("typed");
    assert_eq!(longer, FILE.replace("to: band.right}", "to: band.right, ease: 14}"));
    assert_eq!(done_in(&longer, &Act::Ease { seam: "close".into(), value: String::new() }), Ok(FILE.into()));
    for at in [vec!["body"], vec!["pieces", "front", "outline", "waist"], vec!["seams", "close"], vec![]] {
        assert!(done(&Act::Length { path: strings(&at), value: "14".into() }).is_err(), "{at:?}");
    }
}

fn alter(alteration: &str) -> Act {
    Act::Alter { alteration: alteration.into() }
}

#[test]
fn alterations_are_added_and_taken_out_in_the_words_of_the_file() {
    let text = done(&alter(r#"{"take_in": "front.hem", "at": {"50 %": "8 mm"}}"#)).expect("altered");
    assert!(text.starts_with(FILE) && text.ends_with("alter:\n  - {take_in: front.hem, at: {50 %: 8 mm}}\n"), "{text}");
    let both = "[{lengthen: [front, back], at: 30, by: 5}, {spread: band.top@50 %, to: band.bottom@50 %, by: 4}]";
    let more = done_in(&text, &alter(both)).expect("altered");
    assert_eq!(said(&more).alter.len(), 3);
    let label = alter(both).done(&text, Path::new("skirt.yaml")).expect("altered").label;
    assert_eq!(
        label,
        "lengthen front and back by 5, at y = 30, slash from band.top@50 % to band.bottom@50 % and open by 4"
    );
    let less = done_in(&more, &Act::Unalter { number: 1 }).expect("taken out");
    assert_eq!((said(&less).alter.len(), &said(&less).alter[0].value), (2, &said(&more).alter[0].value));
    let none = done_in(&text, &Act::Unalter { number: 0 }).expect("taken out");
    assert_eq!(said(&none), said(FILE));
    assert!(done_in(&text, &Act::Unalter { number: 1 }).is_err());
}

#[test]
fn alterations_that_cannot_be_done_are_refused_with_the_reason() {
    for (alteration, why) in [
        ("", "give 1 to 20"),
        ("[]", "give 1 to 20"),
        ("{pleat: front}", "unknown alteration"),
        ("{take_in: side_seam, at: {50 %: 8}}", "side_seam"),
        ("{take_in: front.hem, at: {50 %: eight}}", "eight"),
        ("{lengthen: sleeve, at: 30, by: 5}", "sleeve"),
        // The outline would cross itself.
        ("{take_in: front.hem, at: {50 %: 300}}", "this cannot be done"),
        // The band is closed along its ends, of which one becomes longer.
        ("{move: band.left, at: {0: [0, 4]}}", "close"),
        ("{take_in: front.hem, at: {50 %: 8}}\nbody: man_100", ""),
    ] {
        let refused = done(&alter(alteration)).expect_err(alteration).to_string();
        assert!(refused.contains(why), "{alteration}: {refused}");
    }
    assert!(done(&alter(&"x".repeat(3000))).expect_err("long").to_string().contains("2000"));
}

#[test]
fn the_wearer_is_measured() {
    let measure =
        |text: &str, name: &str, value: &str| done_in(text, &Act::Measure { name: name.into(), value: value.into() });
    let text = measure(FILE, "waist", "81 cm").expect("measured");
    assert_eq!(text, FILE.replace("body: woman_92", "body: {like: woman_92, waist: 81 cm}"));
    let both = measure(&text, "chest", "1000").expect("measured");
    assert!(both.contains("body: {like: woman_92, waist: 81 cm, chest: 1000}"), "{both}");
    assert_eq!(measure(&both, "chest", " "), Ok(text.clone()));
    assert_eq!(measure(&text, "waist", ""), Ok(FILE.into()));
    for (name, value) in [("girth", "900"), ("waist", "9000"), ("waist", "wide"), ("hip: 1, seat", "900")] {
        assert!(measure(FILE, name, value).is_err(), "{name}: {value}");
    }
    let twice = measure(&both, "bust", "1000").expect_err("one measure");
    assert!(twice.to_string().contains("twice"), "{twice}");
    assert!(measure(FILE, "waist", "").is_err(), "there is none");
    let nobody = FILE.replace("body: woman_92\n", "");
    assert!(measure(&nobody, "waist", "810").is_err());
}

#[test]
fn what_is_no_act_is_refused() {
    let read = |text: &str| serde_json::from_str::<Act>(text).is_ok();
    assert!(read(r#"{"do": "undo"}"#) && read(r#"{"do": "free", "edges": ["a.b"]}"#));
    assert!(!read(r#"{"do": "write", "file": "/etc/passwd"}"#));
    assert!(!read(r#"{"do": "free", "edges": ["a.b"], "file": "x"}"#));
    assert!(done_in("garment: 1\npieces: [", &Act::Body { name: "woman_92".into() }).is_err());
}

/// Garment files of the repository, with their texts.
fn shipped() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut out = Vec::new();
    for folder in ["patterns", "tests/data"] {
        for entry in std::fs::read_dir(root.join(folder)).expect("a folder") {
            let path = entry.expect("an entry").path();
            let text = std::fs::read_to_string(&path).unwrap_or_default();
            if path.extension().is_some_and(|e| e == "yaml") && read_file_only("", &text).is_ok() {
                out.push((path.display().to_string(), text));
            }
        }
    }
    assert!(out.len() > 15, "{}", out.len());
    out
}

/// Comments of a text, each with the blanks before it.
fn comments(text: &str) -> Vec<&str> {
    text.lines().filter_map(|line| line.find(" #").map(|at| &line[at..])).collect()
}

#[test]
fn edges_of_every_garment_can_be_named_and_the_garment_stays_as_it_was() {
    for (file, text) in shipped() {
        let check = |text: &str| {
            let examined = examine_text("garment", &file, text);
            examined.findings.errors()
        };
        let before = check(&text);
        let file_said = said(&text);
        for piece in file_said.pieces.iter().filter(|piece| piece.outline.is_some()) {
            let outline = piece.outline.as_ref().expect("an outline");
            for (edge, _) in &outline.edges {
                let full = format!("{}.{}", piece.name.value, edge.value);
                let act = Act::Name { edge: full.clone(), name: "renamed-edge".into() };
                let new = act.done(&text, Path::new(&file)).unwrap_or_else(|e| panic!("{file}, {full}: {e}")).text;
                assert_eq!(check(&new), before, "{file}, {full}: {new}");
                assert_eq!(comments(&new), comments(&text), "{file}, {full}");
                let back = Act::Name { edge: format!("{}.renamed-edge", piece.name.value), name: edge.value.clone() };
                let again = back.done(&new, Path::new(&file)).map(|done| said(&done.text));
                let again = again.map(|back| GarmentFile { free: file_said.free.clone(), ..back });
                assert_eq!(again.as_ref(), Ok(&file_said), "{file}, {full}");
            }
        }
    }
}

#[test]
fn every_garment_can_be_changed_with_all_its_comments() {
    for (file, text) in shipped() {
        let own = said(&text);
        for piece in &own.pieces {
            let act = Act::Place { piece: piece.name.value.clone(), words: strings(&["left", "arm"]) };
            let new = act.done(&text, Path::new(&file)).unwrap_or_else(|e| panic!("{file}: {e}")).text;
            let placed = said(&new).pieces.into_iter().find(|p| p.name == piece.name).and_then(|p| p.place);
            let words = crate::pattern::PlaceFile::Words("left arm".into());
            assert_eq!(placed.map(|place| place.value), Some(words), "{file}");
            assert!(comments(&text).iter().all(|comment| new.contains(comment.trim())), "{file}: {new}");
        }
        for seam in &own.seams {
            let act = Act::Unpick { seam: seam.name.value.clone() };
            let new = act.done(&text, Path::new(&file)).unwrap_or_else(|e| panic!("{file}: {e}")).text;
            let left: Vec<_> = own.seams.iter().filter(|other| other.name != seam.name).cloned().collect();
            assert_eq!(said(&new), GarmentFile { seams: left, ..own.clone() }, "{file}, {}", seam.name.value);
        }
    }
}
