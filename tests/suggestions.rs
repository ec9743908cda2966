//! Seams that are offered for a drawing: which edges belong together, and what is not sewn though it is as long.

use std::path::{Path as FilePath, PathBuf};

use toile::digitize::{Digitized, ImportedNotch, Suggestion, Traced, garment_file};
use toile::geometry::{Path, Vec2};
use toile::io::garment::read;
use toile::io::garmentcode::{Wearer, read as read_garmentcode};
use toile::pattern::{CutKind, DrawnPiece, GarmentFile, PlaceFile, Side, drawings};

/// A piece of closed path commands, millimetres, its notches (single or double) and how it is cut.
struct Drawn<'a> {
    name: &'a str,
    path: &'a str,
    notches: &'a [([f64; 2], bool)],
    cut: Option<CutKind>,
    fold: Option<[[f64; 2]; 2]>,
}

impl<'a> Drawn<'a> {
    fn pair(name: &'a str, path: &'a str) -> Self {
        Self { name, path, notches: &[], cut: Some(CutKind::Pair), fold: None }
    }
}

fn point([x, y]: [f64; 2]) -> Vec2 {
    Vec2::new(x, y) * 1e-3
}

/// A double notch as drawings have it: two marks.
fn marks(at: Vec2, double: bool) -> Vec<ImportedNotch> {
    let off = if double { 3e-3 } else { 0.0 };
    let marks = [at - Vec2::new(off, 0.0), at + Vec2::new(off, 0.0)];
    marks.into_iter().take(1 + usize::from(double)).map(|at| ImportedNotch { at, told: None }).collect()
}

fn made(pieces: &[Drawn]) -> Digitized {
    let traced = |piece: &Drawn| Traced {
        name: piece.name.to_owned(),
        sew: vec![(None, Path::parse_absolute(piece.path, 1e-3).expect("a path"))],
        grain: Some([point([50.0, 50.0]), point([50.0, 150.0])]),
        notches: piece.notches.iter().flat_map(|(at, double)| marks(point(*at), *double)).collect(),
        mirror: piece.fold.map(|ends| ends.map(point)),
        cut_how: piece.cut.clone(),
        ..Traced::default()
    };
    garment_file("drawing", &pieces.iter().map(traced).collect::<Vec<Traced>>())
}

fn offered(made: &Digitized) -> Vec<(String, String)> {
    made.suggestions.iter().map(|s| (s.sew.join(" "), s.to.join(" "))).collect()
}

#[test]
fn a_single_notch_is_never_sewn_to_a_double_one() {
    let side = |double: bool| {
        let front =
            Drawn { notches: &[([208.0, 120.0], false)], ..Drawn::pair("front", "M 0 0 H 200 L 220 300 H 0 Z") };
        let path = "M 0 0 H 180 L 200 300 H 0 Z";
        let notches: &[([f64; 2], bool)] = if double { &[([188.0, 120.0], true)] } else { &[([188.0, 120.0], false)] };
        offered(&made(&[front, Drawn { notches, ..Drawn::pair("back", path) }]))
    };
    assert!(side(false).contains(&("front.b front.c".to_owned(), "back.b back.c".to_owned())), "{:?}", side(false));
    assert!(side(true).iter().all(|(sew, to)| !(sew.contains("front") && to.contains("back"))), "{:?}", side(true));
}

/// The pieces of a garment as other programs draw them: no names of edges, notches as marks.
fn stripped(drawings: &[DrawnPiece]) -> Vec<Traced> {
    let piece = |drawing: &DrawnPiece| {
        let ring = &drawing.rings[0];
        let whole = ring.iter().map(|e| e.path.clone()).reduce(|line, next| line.joined(&next)).expect("edges");
        let fold = drawing.fold.map(|k| [ring[k].path.start(), ring[k].path.end()]);
        let notch = |n: &toile::pattern::DrawnNotch| marks(drawing.edge(n.edge).path.point(n.at), n.double);
        Traced {
            name: drawing.name.clone(),
            sew: vec![(None, whole)],
            grain: drawing.grain,
            notches: drawing.notches.iter().filter(|n| n.edge.0 == 0).flat_map(notch).collect(),
            mirror: fold,
            cut_how: Some(drawing.cut.clone()).filter(|cut| !matches!(cut, CutKind::Fold(_))),
            ..Traced::default()
        }
    };
    drawings.iter().map(piece).collect()
}

/// `front.neck` of `front.L.neck`, `front.neck.2` or `front.neck@0..30`.
fn base(drawings: &[DrawnPiece], written: &str) -> String {
    let plain = written.split('@').next().unwrap_or_default();
    let (piece, rest) = plain.split_once('.').unwrap_or((plain, ""));
    let edge = rest.split('.').find(|word| !["L", "R"].contains(word) && word.parse::<usize>().is_err());
    assert!(drawings.iter().any(|d| d.name == piece), "{written}");
    format!("{piece}.{}", edge.unwrap_or_default())
}

/// What a garment's seams sew, by whole edges: two sides each, the second `mirror` for halves of a pair.
fn truth(file: &GarmentFile, drawings: &[DrawnPiece]) -> Vec<[Vec<String>; 2]> {
    let side = |edges: &[toile::pattern::Located<String>]| {
        let all = edges.iter().map(|e| if e.value == "mirror" { e.value.clone() } else { base(drawings, &e.value) });
        sorted(all.collect())
    };
    let written = file.seams.iter().map(|seam| [side(&seam.sew), side(&seam.to)]);
    let legs = drawings.iter().flat_map(|d| {
        let name = |k: usize| vec![format!("{}.{}", d.name, d.rings[0][k].name)];
        d.darts.iter().map(move |dart| dart.legs.map(name))
    });
    written.chain(legs).collect()
}

fn sorted(mut all: Vec<String>) -> Vec<String> {
    all.sort();
    all.dedup();
    all
}

/// Places along an edge at which the garment's own edge there is looked up.
const LOOKS: u32 = 40;

/// The garment's own edges that edges of a suggestion run along.
fn along(made: &Digitized, drawings: &[DrawnPiece], edges: &[String]) -> Vec<String> {
    let own = |written: &String| -> Vec<String> {
        if written == "mirror" {
            return vec![written.clone()];
        }
        let words: Vec<&str> = written.split('@').next().unwrap_or_default().split('.').collect();
        let (piece, edge) = (words[0], words[words.len() - 1]);
        let k = drawings.iter().position(|d| d.name == piece).expect("a piece");
        let file = &made.file.pieces[k];
        let outline = file.outline.as_ref().expect("an outline");
        let mut at = Vec2::from(outline.start.value);
        let mut path = None;
        let ring = &drawings[k].rings[0];
        let low = ring.iter().flat_map(|e| e.path.sampled(1e-6)).fold(ring[0].path.start(), |low, p| low.inf(&p));
        for (name, commands) in &outline.edges {
            let course = Path::parse(at, &commands.value, 1e-3).expect("a path");
            at = course.end() * 1e3;
            if name.value == edge {
                path = Some(course);
            }
        }
        let path = path.expect("an edge");
        let nearest = |share: f64| {
            let p = path.point(path.length() * share) + low;
            let off = |e: &&toile::pattern::DrawnEdge| e.path.nearest(p).1;
            let edge = ring.iter().min_by(|a, b| off(a).total_cmp(&off(b))).expect("edges");
            let is_leg = drawings[k].darts.iter().any(|d| d.legs.iter().any(|leg| ring[*leg].name == edge.name));
            let full = format!("{piece}.{}", edge.name);
            if is_leg { full } else { base(drawings, &full) }
        };
        (0..LOOKS).map(|k| nearest((f64::from(k) + 0.5) / f64::from(LOOKS))).collect()
    };
    sorted(edges.iter().flat_map(own).collect())
}

/// How many of the offered seams are the garment's own (or a part of one), how many are offered, how many of its own
/// are among them, and how many it has.
fn judged(file: &GarmentFile, drawings: &[DrawnPiece]) -> ([usize; 4], String) {
    let made = garment_file("garment", &stripped(drawings));
    let truth = truth(file, drawings);
    let mut found = vec![false; truth.len()];
    let mut said = String::new();
    let mut right = 0;
    for own in &made.suggestions {
        let sides = [along(&made, drawings, &own.sew), along(&made, drawings, &own.to)];
        let within = |part: &[String], whole: &[String]| part.iter().all(|edge| whole.contains(edge));
        let is = |[a, b]: &[Vec<String>; 2]| {
            (within(&sides[0], a) && within(&sides[1], b)) || (within(&sides[0], b) && within(&sides[1], a))
        };
        let parts = |[a, b]: &[Vec<String>; 2]| {
            (within(a, &sides[0]) && within(b, &sides[1])) || (within(b, &sides[0]) && within(a, &sides[1]))
        };
        // A part of one seam, or several that go on into each other.
        let mut hit: Vec<usize> = (0..truth.len()).filter(|&k| is(&truth[k])).collect();
        if hit.is_empty() {
            let several: Vec<usize> = (0..truth.len()).filter(|&k| parts(&truth[k])).collect();
            let all = several.iter().flat_map(|&k| truth[k].iter().flatten().cloned()).collect();
            let whole = sorted(all) == sorted(sides.iter().flatten().cloned().collect());
            hit = several.into_iter().filter(|_| whole).collect();
        }
        hit.iter().for_each(|&k| found[k] = true);
        right += usize::from(!hit.is_empty());
        said.push_str(&format!("{} {}\n", if hit.is_empty() { "WRONG" } else { "right" }, shown(own, &sides)));
    }
    for (k, _) in found.iter().enumerate().filter(|(_, found)| !**found) {
        said.push_str(&format!("missed {:?}\n", truth[k]));
    }
    ([right, made.suggestions.len(), found.iter().filter(|found| **found).count(), truth.len()], said)
}

fn shown(own: &Suggestion, sides: &[Vec<String>; 2]) -> String {
    format!(
        "{:.2} {:?} {:?} {:?} {:?}",
        own.score,
        sides[0],
        sides[1],
        own.lengths.map(|l| (1e4 * l).round() / 10.0),
        own.reasons
    )
}

fn of_garments(garments: &[(String, GarmentFile, Vec<DrawnPiece>)]) -> [usize; 4] {
    let mut sum = [0; 4];
    for (name, file, drawings) in garments {
        let (counts, said) = judged(file, drawings);
        println!("{name} {counts:?}\n{said}");
        (0..4).for_each(|k| sum[k] += counts[k]);
    }
    println!("right, offered, found, seams: {sum:?}");
    sum
}

/// Of the shipped patterns, stripped of names: what is offered is right, and most of what they sew is offered.
#[test]
fn the_seams_of_shipped_patterns_are_offered() {
    let mut garments = Vec::new();
    for name in ["child_dress", "gore_skirt", "sheath_dress", "trousers", "tshirt"] {
        let loaded = read(&FilePath::new("patterns").join(format!("{name}.yaml"))).expect("a pattern");
        let drawn = drawings(&loaded.file, &loaded.garment);
        garments.push((name.to_owned(), loaded.file, drawn));
    }
    let [right, offered, found, seams] = of_garments(&garments);
    assert!(right * 100 >= offered * 85 && found * 100 >= seams * 70, "{right} of {offered}, {found} of {seams}");
}

/// Of designs as makers' programs draw them (hoodie, skirt with a waistband, dress with darts, bodice with princess
/// seams, coat with a two-part sleeve, trousers), stripped likewise.
#[test]
fn the_seams_of_makers_designs_are_offered() {
    let mut names: Vec<PathBuf> =
        std::fs::read_dir("tests/designs").expect("designs").map(|e| e.expect("a design").path()).collect();
    names.sort();
    let mut garments = Vec::new();
    for path in names {
        let loaded = read(&path).unwrap_or_else(|e| panic!("{e}"));
        let drawn = drawings(&loaded.file, &loaded.garment);
        garments.push((path.display().to_string(), loaded.file, drawn));
    }
    assert_eq!(garments.len(), 6);
    let [right, offered, found, seams] = of_garments(&garments);
    assert!(right * 100 >= offered * 85 && found * 100 >= seams * 70, "{right} of {offered}, {found} of {seams}");
}

/// The straight upper and lower edges of a panel with one bulging side are no sides of a sleeve.
#[test]
fn edges_across_the_grain_are_no_sides_of_a_sleeve() {
    let path = "M 0 0 H 200 C 260 60 260 240 200 300 H 0 Z";
    let offered = offered(&made(&[Drawn { cut: None, ..Drawn::pair("panel", path) }]));
    assert_eq!(offered, []);
}

#[test]
fn the_seams_of_garmentcodes_patterns_are_offered() {
    let folder = PathBuf::from("../shared/garmentcode");
    let Ok(entries) = std::fs::read_dir(&folder) else {
        println!("skipped: {} is absent", folder.display());
        return;
    };
    let mut folders: Vec<PathBuf> = entries.filter_map(|e| Some(e.ok()?.path())).filter(|p| p.is_dir()).collect();
    folders.sort();
    let mut garments = Vec::new();
    for folder in folders {
        let name = folder.file_name().expect("a name").to_string_lossy().into_owned();
        let text = std::fs::read_to_string(folder.join(format!("{name}_specification.json"))).expect("a specification");
        let file = read_garmentcode(&name, &text, Wearer { body: None, floor: 0.0 }).expect("a garment");
        let yaml = toile::io::garment::write(&file).expect("YAML");
        let loaded = toile::io::garment::read_text(&name, "spec.yaml", &yaml).expect("a garment");
        let drawn = drawings(&loaded.file, &loaded.garment);
        garments.push((name, loaded.file, drawn));
    }
    let [right, offered, found, seams] = of_garments(&garments);
    assert!(right * 100 >= offered * 85 && found * 100 >= seams * 70, "{right} of {offered}, {found} of {seams}");
}

/// Two panels alike, of which the drawing tells no grain: their sides are sewn, not their waists and hems.
#[test]
fn panels_alike_are_sewn_at_their_sides() {
    let panel = |name: &str| Traced {
        name: name.to_owned(),
        sew: vec![(None, Path::parse_absolute("M 20 0 H 220 L 240 500 H 0 Z", 1e-3).expect("a path"))],
        ..Traced::default()
    };
    let mut offered = offered(&garment_file("skirt", &[panel("front"), panel("back")]));
    offered.sort();
    let seam = |a: &str, b: &str| (a.to_owned(), b.to_owned());
    assert_eq!(offered, [seam("front.b", "back.d"), seam("front.d", "back.b")]);
}

/// A pair of fronts is sewn to both sides of a back that is drawn whole.
#[test]
fn left_and_right_are_sewn_to_both_sides_of_a_whole_piece() {
    let whole = Drawn { cut: None, ..Drawn::pair("back", "M 100 20 L 130 0 L 210 30 L 230 400 H 0 L 20 30 L 100 0 Z") };
    let path = "M 40 90 L 70 0 L 150 30 L 170 400 H 20 L 40 90 Z";
    let front = Drawn::pair("front", path);
    let back = "M 80 0 L 115 10 L 150 0 L 230 30 L 250 400.0547 H -20 L 0 30 Z";
    let made = made(&[front, Drawn { path: back, ..whole }]);
    let sides: Vec<&Suggestion> = made.suggestions.iter().filter(|own| own.lengths[0] > 0.3).collect();
    assert_eq!(sides.len(), 2, "{:?}", made.suggestions);
    let pieces = |own: &Suggestion| {
        let all = own.sew.iter().chain(&own.to);
        let (front, back): (Vec<&String>, Vec<&String>) = all.partition(|edge| edge.starts_with("front"));
        (front[0].clone(), back[0].clone())
    };
    let [one, other] = [pieces(sides[0]), pieces(sides[1])];
    assert!(one.0.starts_with("front.L.") && other.0.starts_with("front.R."), "{one:?} {other:?}");
    assert_ne!(one.1, other.1);
}

/// What is offered makes a garment when it is taken over as it stands, also bands that lap and cuffs that close.
#[test]
fn what_is_offered_for_makers_designs_can_be_sewn() {
    for name in [
        "tests/designs/skirt.yaml",
        "tests/designs/hoodie.yaml",
        "tests/designs/dress.yaml",
        "patterns/gore_skirt.yaml",
        "patterns/tshirt.yaml",
    ] {
        let loaded = read(FilePath::new(name)).unwrap_or_else(|e| panic!("{e}"));
        let made = garment_file("garment", &stripped(&drawings(&loaded.file, &loaded.garment)));
        let sewn = toile::digitize::sewn(&made.file, &made.suggestions);
        let yaml = toile::io::garment::write(&sewn).expect("YAML");
        toile::io::garment::read_text("garment", name, &yaml).unwrap_or_else(|e| panic!("{e}\n{yaml}"));
    }
}

/// Half of a bodice on the fold: neckline, shoulder, armhole, side and hem. `bend` moves the armhole, which has its
/// notch this far from the side.
fn bodice(name: &str, neck: f64, bend: f64, notch: (f64, bool)) -> Traced {
    let armhole = Path::parse_absolute(&format!("M 210 30 C {bend} 90 215 170 270 190"), 1e-3).expect("a path");
    let path = format!("M 0 {neck} C 40 {neck} 80 30 88 0 L 210 30 C {bend} 90 215 170 270 190 V 560 H 0 Z");
    let at = armhole.point(armhole.length() - notch.0 * 1e-3);
    Traced {
        name: name.to_owned(),
        sew: vec![(None, Path::parse_absolute(&path, 1e-3).expect("a path"))],
        grain: Some([point([50.0, 150.0]), point([50.0, 400.0])]),
        notches: marks(at, notch.1),
        mirror: Some([point([0.0, 560.0]), point([0.0, neck])]),
        ..Traced::default()
    }
}

/// A sleeve, the back of its cap to the left, with the cap as long as said.
fn sleeve(long: f64, front: f64, back: f64) -> Traced {
    let cap = |scale: f64| {
        let text = "M -165 0 C -120 -10 -90 -140 0 -140 C 90 -140 120 -10 165 0";
        Path::parse_absolute(text, 1e-3).expect("a path").mapped(nalgebra::Matrix2::identity() * scale, Vec2::zeros())
    };
    let scale = long / cap(1.0).length();
    let cap = cap(scale);
    let (wide, deep) = (130.0 * scale * 1e-3, 0.4);
    let rest = [cap.end(), Vec2::new(wide, deep), Vec2::new(-wide, deep), cap.start()];
    let mut notches = marks(cap.point(back * 1e-3), true);
    notches.extend(marks(cap.point(long - front * 1e-3), false));
    Traced {
        name: "arm_part".to_owned(),
        sew: vec![(None, cap.joined(&Path::polyline(&rest)))],
        grain: Some([point([0.0, 300.0]), point([0.0, 0.0])]),
        notches,
        cut_how: Some(CutKind::Pair),
        ..Traced::default()
    }
}

/// Front and back go into the cap together, as their notches say, whichever of them that puts first; and the sleeve is
/// placed round an arm, the back behind.
#[test]
fn armholes_are_chained_into_a_cap() {
    let (front, back) = (bodice("one", 80.0, 192.0, (60.0, false)), bodice("other", 40.0, 200.0, (75.0, true)));
    let armhole = |bend: f64| {
        let text = format!("M 210 30 C {bend} 90 215 170 270 190");
        Path::parse_absolute(&text, 1e-3).expect("a path").length()
    };
    let long = armhole(192.0) + armhole(200.0) + 8e-3;
    let made = garment_file("shirt", &[front, back, sleeve(long, 60.0, 75.0)]);
    let found = made.suggestions.iter().find(|s| s.sew[0].starts_with("o") && s.to[0].starts_with("arm_part"));
    let found = found.unwrap_or_else(|| panic!("{:?}", made.suggestions));
    let pieces =
        |edges: &[String]| sorted(edges.iter().map(|e| e.split('.').next().unwrap_or("").to_owned()).collect());
    assert_eq!(pieces(&found.sew), ["one", "other"], "{found:?}");
    assert!((found.ease.expect("ease") - 8e-3).abs() < 1e-4, "{found:?}");
    assert!(found.reasons.iter().any(|reason| reason == "notches match"), "{found:?}");
    // Sides, shoulders and the sleeve's own seam; no hem, no neckline.
    assert_eq!(made.suggestions.len(), 4, "{:?}", made.suggestions);
    let piece = |name: &str| made.file.pieces.iter().find(|p| p.name.value == name).expect("a piece");
    let place = |name: &str| match piece(name).place.as_ref().map(|p| &p.value) {
        Some(PlaceFile::Words(words)) => words.clone(),
        other => format!("{other:?}"),
    };
    assert_eq!([place("one"), place("other"), place("arm_part")], ["torso front", "torso back", "arm"]);
    let drawn = |name: &str| piece(name).drawn.as_ref().map(|side| side.value);
    assert_eq!([drawn("one"), drawn("other"), drawn("arm_part")], [None, Some(Side::Right), Some(Side::Right)]);
    // Taken over as they are they make a garment.
    let sewn = toile::digitize::sewn(&made.file, &made.suggestions);
    let yaml = toile::io::garment::write(&sewn).expect("YAML");
    toile::io::garment::read_text("shirt", "shirt.yaml", &yaml).unwrap_or_else(|e| panic!("{e}\n{yaml}"));
}

/// Where the notches of an armhole say the other way round, it is sewn into no such cap.
#[test]
fn chains_never_sew_a_single_notch_to_a_double_one() {
    let (front, back) = (bodice("one", 80.0, 192.0, (60.0, true)), bodice("other", 40.0, 200.0, (60.0, true)));
    let long = 0.3596;
    let made = garment_file("shirt", &[front, back, sleeve(long, 60.0, 60.0)]);
    assert!(
        made.suggestions.iter().all(|s| s.sew.len() < 3 || !s.to[0].starts_with("arm_part")),
        "{:?}",
        made.suggestions
    );
}

/// Offered seams stand in the file as remarks, which a reader does not see and whoever takes the `#` away has.
#[test]
fn offered_seams_are_remarks_of_the_file() {
    let (front, back) = (bodice("one", 80.0, 192.0, (60.0, false)), bodice("other", 40.0, 200.0, (75.0, true)));
    let made = garment_file("shirt", &[front, back]);
    let offers: Vec<_> = made.suggestions.iter().map(|s| (s.seam(), s.reason())).collect();
    let yaml = toile::io::garment::write_with_offers(&made.file, &offers).expect("YAML");
    let read =
        |text: &str| toile::io::garment::read_file_only("shirt.yaml", text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    assert!(read(&yaml).seams.is_empty() && !offers.is_empty());
    let taken: String = yaml
        .lines()
        .map(|line| {
            let is_seam = line.starts_with("# seams:") || line.starts_with("#   ");
            format!("{}\n", if is_seam { &line[2..] } else { line })
        })
        .collect();
    assert_eq!(read(&taken).seams.len(), offers.len(), "{taken}");
}

/// Hems are as long as each other, and wide allowances tell them.
#[test]
fn hems_are_told_by_their_allowance() {
    let skirt = |name: &str| {
        let sew = Path::parse_absolute("M 0 0 H 150 L 200 500 H 0 Z", 1e-3).expect("a path");
        let cut = Path::parse_absolute("M -10 -10 H 160 L 213 540 H -10 Z", 1e-3).expect("a path");
        let grain = Some([point([50.0, 100.0]), point([50.0, 300.0])]);
        let how = Some(CutKind::Pair);
        Traced {
            name: name.to_owned(),
            sew: vec![(None, sew)],
            cut: Some(cut),
            grain,
            cut_how: how,
            ..Traced::default()
        }
    };
    let made = garment_file("skirt", &[skirt("front"), skirt("back")]);
    let hem = |edge: &String| edge.ends_with(".c");
    assert!(made.suggestions.iter().all(|s| !s.sew.iter().chain(&s.to).any(hem)), "{:?}", made.suggestions);
    assert!(offered(&made).contains(&("front.b".to_owned(), "back.b".to_owned())), "{:?}", made.suggestions);
}

/// Sizes that an import wrote beside each other are not sewn to each other in the studio either.
#[test]
fn a_garment_file_of_several_sizes_is_offered_seams_within_each() {
    let size = |size: usize, name: &str, more: f64| {
        let path = format!("M 0 0 H {} L {} {} H 0 Z", 200.0 + more, 220.0 + more, 300.0 + more);
        Traced {
            name: format!("{name}_{}", 38 + 2 * size),
            sew: vec![(None, Path::parse_absolute(&path, 1e-3).expect("a path"))],
            grain: Some([point([50.0, 50.0]), point([50.0, 150.0])]),
            cut_how: Some(CutKind::Pair),
            size: Some(size),
            size_name: Some((38 + 2 * size).to_string()),
            ..Traced::default()
        }
    };
    let pieces = [size(0, "front", 0.0), size(0, "back", 0.0), size(1, "front", 0.5), size(1, "back", 0.5)];
    let made = garment_file("skirt", &pieces);
    let offered = toile::digitize::suggestions(&made.file);
    assert!(!offered.is_empty());
    let sizes = |edges: &[String]| -> Vec<String> {
        edges
            .iter()
            .filter(|edge| *edge != "mirror")
            .map(|edge| edge.chars().skip_while(|c| *c != '_').take(3).collect())
            .collect()
    };
    for own in &offered {
        let of_both = sorted([sizes(&own.sew), sizes(&own.to)].concat());
        assert_eq!(of_both.len(), 1, "{own:?}");
    }
}

/// The studio offers the same seams for an imported file as the import did, and fewer once some are sewn.
#[test]
fn a_garment_file_is_offered_what_its_drawing_was() {
    let made = made(&[
        Drawn::pair("front", "M 0 0 H 200 L 220 300 H 0 Z"),
        Drawn::pair("back", "M 0 0 H 180 L 200 300 H 0 Z"),
    ]);
    let sides = |list: &[Suggestion]| -> Vec<_> { list.iter().map(|s| (s.sew.clone(), s.to.clone())).collect() };
    let offered = toile::digitize::suggestions(&made.file);
    assert!(!offered.is_empty());
    assert_eq!(sides(&offered), sides(&made.suggestions));
    let mut file = made.file.clone();
    file.seams.push(offered[0].seam());
    let left = toile::digitize::suggestions(&file);
    assert!(left.iter().all(|own| own.sew != offered[0].sew && own.name != offered[0].name), "{left:?}");
}
