//! Sewing: who is sewn to whom, where the pieces start, closing, and what is done to a newly stitched cloth.

use std::sync::Arc;

use proptest::prelude::*;
use toile::contact::Collider;
use toile::dynamics::{Cloth, Cut, SpringModel};
use toile::fabric::{self, Fabric};
use toile::geometry::{TriMesh, Vec2, Vec3};
use toile::mannequin::{Mannequin, PartKind, load};
use toile::mesh::{ClothMesh, Stitches, build};
use toile::pattern::Garment;
use toile::sew::place::{PlaceError, positioned, same_sides};
use toile::sew::start::start;
use toile::sew::{Calm, SewError, SewOptions, Sewn, Stitching, settle, sew, sewn_world};
use toile::verify::{crossings, crossings_between};

/// Metres.
const MM: f64 = 1e-3;

/// A garment, its mesh and its fabrics.
struct Made {
    garment: Garment,
    mesh: ClothMesh,
    fabrics: Vec<Arc<Fabric>>,
}

impl Made {
    fn new(text: &str, spacing: f64) -> Self {
        let loaded = toile::io::garment::read_text("test", "test.yaml", text).map_err(|e| e.to_string());
        let garment = loaded.expect("a garment").garment;
        let mesh = build(&garment, spacing * MM).expect("a mesh");
        let poplin = Arc::new(fabric::load("cotton_poplin").expect("shipped"));
        let fabrics = vec![poplin; garment.pieces.len()];
        Self { garment, mesh, fabrics }
    }

    fn cut(&self) -> Cut<'_> {
        Cut { garment: &self.garment, mesh: &self.mesh, fabrics: &self.fabrics }
    }

    fn placed(&self, body: &Mannequin) -> Vec<Vec3> {
        self.starts(body).expect("a start for every piece")
    }

    fn starts(&self, body: &Mannequin) -> Result<Vec<Vec3>, PlaceError> {
        let collider = Collider::new(&body.mesh).expect("closed");
        let given = positioned(&self.garment, &self.mesh);
        given.map_or_else(|| start(&self.garment, &self.mesh, body, &collider), Ok)
    }
}

fn woman() -> (Mannequin, Collider) {
    let body = load("woman_92").expect("shipped");
    let collider = Collider::new(&body.mesh).expect("closed");
    (body, collider)
}

/// Two squares of 120 mm with one seam, a metre before the body, `apart` mm of air between the edges to be sewn.
fn squares(apart: f64) -> Made {
    let x = 120.0 + apart;
    Made::new(
        &format!(
            "garment: 1\nbody: woman_92\nfabrics: {{shell: cotton_poplin}}\npieces:\n  one:\n    \
             place: {{at: [0, 1000, 1000]}}\n    grain: [[10, 10], [10, 90]]\n    \
             outline: {{start: 0 0, top: L 120 0, right: L 120 120, hem: L 0 120, left: L 0 0}}\n  \
             two: {{like: one, place: {{at: [{x}, 1000, 1000]}}}}\n\
             seams:\n  side: {{sew: one.right, to: two.left}}\n\
             free: [one.left, two.right, '*.top', '*.hem']\n"
        ),
        15.0,
    )
}

/// Three squares as those of [`squares`] in a row; the seam of the first two belongs to stage 2.
fn three_squares() -> Made {
    Made::new(
        "garment: 1\nbody: woman_92\nfabrics: {shell: cotton_poplin}\npieces:\n  one:\n    \
         place: {at: [0, 1000, 1000]}\n    grain: [[10, 10], [10, 90]]\n    \
         outline: {start: 0 0, top: L 120 0, right: L 120 120, hem: L 0 120, left: L 0 0}\n  \
         two: {like: one, place: {at: [130, 1000, 1000]}}\n  three: {like: one, place: {at: [260, 1000, 1000]}}\n\
         seams:\n  later: {sew: one.right, to: two.left, stage: 2}\n  first: {sew: two.right, to: three.left}\n\
         free: [one.left, three.right, '*.top', '*.hem']\n",
        15.0,
    )
}

/// A tube of two rectangles `width` mm wide and 300 mm long.
fn tube(width: f64) -> Made {
    Made::new(
        &format!(
            "garment: 1\nbody: woman_92\nfabrics: {{shell: cotton_poplin}}\npieces:\n  front:\n    \
             place: hip front\n    grain: [[10, 10], [10, 90]]\n    \
             outline: {{start: 0 0, top: L {width} 0, right: L {width} 300, hem: L 0 300, left: L 0 0}}\n  \
             back: {{like: front, place: hip back}}\n\
             seams:\n  left: {{sew: front.right, to: back.left}}\n  right: {{sew: front.left, to: back.right}}\n\
             free: ['*.top', '*.hem']\n"
        ),
        20.0,
    )
}

// Who is sewn to whom.

/// A mesh of `n` particles and nothing but seams.
fn seams_only(n: usize, seams: Vec<Vec<[u32; 2]>>) -> ClothMesh {
    let seams =
        seams.into_iter().enumerate().map(|(k, pairs)| Stitches { name: k.to_string(), stage: 1, pairs }).collect();
    ClothMesh { spacing: 0.01, flat: vec![Vec2::zeros(); n], triangles: Vec::new(), pieces: Vec::new(), seams }
}

/// The smallest particle that each can be reached from along stitches, by walking until nothing changes.
fn leaders(n: usize, pairs: impl Iterator<Item = [u32; 2]> + Clone) -> Vec<u32> {
    let mut leader: Vec<u32> = (0..n as u32).collect();
    loop {
        let before = leader.clone();
        for [a, b] in pairs.clone().map(|p| p.map(|p| p as usize)) {
            let least = leader[a].min(leader[b]);
            (leader[a], leader[b]) = (least, least);
        }
        if leader == before {
            return leader;
        }
    }
}

proptest! {
    #[test]
    fn classes_are_what_stitches_connect(
        seams in prop::collection::vec(prop::collection::vec([0u32..24, 0u32..24], 0..8), 0..5),
    ) {
        let all = seams.concat();
        let stitching = Stitching::new(&seams_only(24, seams));
        let leader = leaders(24, all.iter().copied());
        let mut first: Vec<u32> = leader.clone();
        first.sort_unstable();
        first.dedup();
        prop_assert_eq!(stitching.classes, first.len());
        for p in 0..24 {
            // Classes are numbered by their first particles.
            prop_assert_eq!(first[stitching.class[p] as usize], leader[p]);
        }
        let count = |c: u32| stitching.class.iter().filter(|&&k| k == c).count() as u32;
        prop_assert!((0..stitching.classes as u32).all(|c| stitching.size[c as usize] == count(c)));
        // Every pair once, whichever way round and however often it was sewn, and none with itself.
        let sorted = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
        let mut distinct: Vec<[u32; 2]> = all.iter().filter(|p| p[0] != p[1]).map(|&p| sorted(p)).collect();
        distinct.sort_unstable();
        distinct.dedup();
        prop_assert_eq!(stitching.pairs.iter().map(|p| sorted(p.0)).collect::<Vec<_>>(), distinct);
    }

    #[test]
    fn what_is_stitched_lies_in_the_middle(
        pairs in prop::collection::vec([0u32..12, 0u32..12], 0..10),
        at in prop::collection::vec([-1.0..1.0f64, -1.0..1.0, -1.0..1.0], 12),
    ) {
        let x: Vec<Vec3> = at.into_iter().map(Vec3::from).collect();
        let stitching = Stitching::new(&seams_only(12, vec![pairs]));
        let welded = stitching.welded(&x);
        prop_assert_eq!(welded.len(), stitching.classes);
        for (c, node) in welded.iter().enumerate() {
            let members: Vec<Vec3> = (0..12).filter(|&p| stitching.class[p] as usize == c).map(|p| x[p]).collect();
            let mean = members.iter().sum::<Vec3>() / members.len() as f64;
            prop_assert!((node - mean).norm() < 1e-14);
        }
        for (gap, (ends, _)) in stitching.gaps(&x).iter().zip(&stitching.pairs) {
            prop_assert_eq!(*gap, (x[ends[0] as usize] - x[ends[1] as usize]).norm());
        }
    }
}

#[test]
fn a_seam_of_n_stitches_makes_n_particles_one() {
    let made = tube(500.0);
    let stitching = Stitching::new(&made.mesh);
    let stitches: usize = made.mesh.seams.iter().map(|s| s.pairs.len()).sum();
    // 300 mm at 20 mm: 16 stitches a seam, and the two seams share no particle.
    assert_eq!(stitches, 2 * 16);
    assert_eq!(stitching.classes, made.mesh.flat.len() - stitches);
    assert_eq!(stitching.pairs.len(), stitches);
    assert_eq!(stitching.size.iter().filter(|&&s| s == 2).count(), stitches);
    assert!(stitching.size.iter().all(|&s| s <= 2));
}

#[test]
fn seams_that_meet_make_one_particle_of_four() {
    let made = Made::new(include_str!("../patterns/trousers.yaml"), 20.0);
    let stitching = Stitching::new(&made.mesh);
    let name = |p: usize| made.mesh.piece_of(p as u32).map_or("", |i| made.mesh.pieces[i].name.as_str());
    let members = |c: usize| -> Vec<&str> {
        let mut names: Vec<&str> =
            (0..made.mesh.flat.len()).filter(|&p| stitching.class[p] as usize == c).map(name).collect();
        names.sort_unstable();
        names
    };
    let mut fours: Vec<Vec<&str>> = (0..stitching.classes).filter(|&c| stitching.size[c] == 4).map(members).collect();
    fours.sort_unstable();
    // The crotch, where inseams and rise cross, and the top of the fly between the ends of the band.
    let crotch = vec!["back.L", "back.R", "front.L", "front.R"];
    assert_eq!(fours, [crotch, vec!["front.L", "front.R", "waistband", "waistband"]]);
    assert!(stitching.size.iter().all(|&s| s <= 4));
    // A class of n particles needs n − 1 stitches, and these say how many classes are left.
    let needed: u32 = stitching.size.iter().map(|s| s - 1).sum();
    assert_eq!(stitching.classes, made.mesh.flat.len() - needed as usize);
}

// Where the pieces start.

#[test]
fn a_fold_starts_on_the_side_its_sign_says() {
    let (body, collider) = woman();
    let farther = |fold: f64| {
        let made = Made::new(
            &format!(
                "garment: 1\nbody: woman_92\nfabrics: {{shell: cotton_poplin}}\npieces:\n  front:\n    \
                 place: hip front\n    grain: [[10, 10], [10, 90]]\n    \
                 outline: {{start: 0 0, top: L 560 0, right: L 560 300, hem: L 0 300, left: L 0 0}}\n    \
                 lines: {{turn: {{path: M 0 240 L 560 240, fold: {fold}}}}}\n  \
                 back: {{like: front, place: hip back}}\n\
                 seams:\n  left: {{sew: front.right, to: back.left}}\n  right: {{sew: front.left, to: back.right}}\n\
                 free: ['*.top', '*.hem']\n"
            ),
            20.0,
        );
        let start = made.placed(&body);
        // The hem comes to lie on the row as far above the fold as it is drawn below it.
        let from_body = |row: f64| {
            let on = |p: &usize| (made.mesh.flat[*p].y - row * MM).abs() < 1e-6;
            let all: Vec<f64> =
                (0..start.len()).filter(on).filter_map(|p| Some(collider.nearest(start[p], 1.0)?.distance)).collect();
            all.iter().sum::<f64>() / all.len() as f64
        };
        from_body(300.0) - from_body(180.0)
    };
    let (under, up) = (farther(180.0), farther(-180.0));
    assert!(under < -1e-3, "wrong sides meet: the hem lies inside, {under} m");
    assert!(up > 1e-3, "right sides meet: the hem lies outside, {up} m");
}

/// Nothing starts where the origin is: garments start on a body that stands somewhere else as they
/// do on one in the middle.
#[test]
fn a_garment_starts_on_its_body_wherever_that_stands() {
    let (body, _) = woman();
    let to = Vec3::new(0.7, 0.0, -0.4);
    let mut moved = body.clone();
    moved.mesh.vertices.iter_mut().for_each(|v| *v += to);
    for part in &mut moved.parts {
        part.sections.iter_mut().for_each(|s| s.center += to);
        part.landmarks.iter_mut().for_each(|l| l.1 += to);
    }
    // Long hems would not do: what the numbers are rounded to grows in their folds while they are inflated.
    let file = format!("{}/patterns/tshirt.yaml", env!("CARGO_MANIFEST_DIR"));
    let made = Made::new(&std::fs::read_to_string(file).expect("shipped"), 25.0);
    let (here, there) = (made.placed(&body), made.placed(&moved));
    let off = here.iter().zip(&there).map(|(a, b)| (b - a - to).norm()).fold(0.0, f64::max);
    assert!(off < 0.1 * MM, "{} mm off", off / MM);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn a_piece_with_a_place_of_its_own_is_only_moved(
        at in [-500.0..500.0f64, 0.0..2000.0, -500.0..500.0],
        turn in [-180.0..180.0f64, -89.0..89.0, -180.0..180.0],
    ) {
        let [x, y, z] = at;
        let [rx, ry, rz] = turn;
        let made = Made::new(
            &format!(
                "garment: 1\nbody: woman_92\nfabrics: {{shell: cotton_poplin}}\npieces:\n  flag:\n    \
                 place: {{at: [{x}, {y}, {z}], turn: [{rx}, {ry}, {rz}]}}\n    grain: [[10, 10], [10, 90]]\n    \
                 outline: {{start: 0 0, a: L 100 0, b: L 100 100, c: L 0 100, d: L 0 0}}\nfree: ['*.*']\n"
            ),
            20.0,
        );
        let (body, _) = woman();
        let placed = made.placed(&body);
        let origin = Vec3::new(x, y, z) * MM;
        for (p, flat) in placed.iter().zip(&made.mesh.flat) {
            prop_assert!(((p - origin).norm() - flat.norm()).abs() < 1e-12);
        }
        // Turned about x, then y, then z; the flat y runs down.
        let axes = nalgebra::Rotation3::from_axis_angle(&Vec3::z_axis(), rz.to_radians())
            * nalgebra::Rotation3::from_axis_angle(&Vec3::y_axis(), ry.to_radians())
            * nalgebra::Rotation3::from_axis_angle(&Vec3::x_axis(), rx.to_radians());
        for (p, flat) in placed.iter().zip(&made.mesh.flat) {
            prop_assert!((p - origin - axes * Vec3::new(flat.x, -flat.y, 0.0)).norm() < 1e-12);
        }
    }
}

#[test]
fn a_piece_that_nothing_passes_through_has_no_start() {
    let text = "garment: 1\nbody: woman_92\nfabrics: {shell: cotton_poplin}\npieces:\n  pocket:\n    \
                place: hip front\n    grain: [[10, 10], [10, 90]]\n    \
                outline: {start: 0 0, a: L 150 0, b: L 150 160, c: L 0 160, d: L 0 0}\nfree: ['*.*']\n";
    let made = Made::new(text, 20.0);
    let (mut body, _) = woman();
    let refused = made.starts(&body);
    assert!(matches!(&refused, Err(PlaceError::Unworn { piece, .. }) if piece == "pocket"), "{refused:?}");
    body.parts.clear();
    let refused = made.starts(&body);
    assert!(matches!(&refused, Err(PlaceError::NoParts { piece, .. }) if piece == "pocket"), "{refused:?}");
    let made = Made::new(&text.replace("hip front", "{at: [0, 900, 300]}"), 20.0);
    assert!(made.starts(&body).is_ok());
}

/// The sides at which seams join a front and a back of the hip, the back a copy of the front.
fn copied(words: [&str; 2], seams: &str) -> Vec<(String, &'static str)> {
    let [front, back] = words;
    alike_sides(&format!(
        "garment: 1\nbody: woman_92\nfabrics: {{shell: cotton_poplin}}\npieces:\n  one:\n    \
         place: {front}\n    grain: [[0, 50], [0, 250]]\n    \
         outline: {{start: -200 0, waist: L 200 0, right: L 290 300, hem: L -290 300, left: L -200 0}}\n  \
         other: {{like: one, place: {back}}}\nseams:\n{seams}free: ['*.waist', '*.hem']\n"
    ))
}

/// Seams of a garment that join the same side of two pieces, and which.
fn alike_sides(text: &str) -> Vec<(String, &'static str)> {
    let made = Made::new(text, 20.0);
    let found = same_sides(&made.garment, &made.mesh);
    found.into_iter().map(|same| (made.garment.seams[same.seam].name.clone(), same.side)).collect()
}

/// A back drawn as a front: its wearer's left is where the front's is on the drawing.
#[test]
fn pieces_that_meet_right_to_right_are_told_by_their_seam() {
    let alike = "  side: {sew: one.right, to: other.right}\n  other: {sew: one.left, to: other.left}\n";
    let crossed = "  side: {sew: one.right, to: other.left}\n  other: {sew: one.left, to: other.right}\n";
    assert_eq!(copied(["hip front", "hip back"], crossed), []);
    let told = |sides: &[(&str, &'static str)]| {
        sides.iter().map(|(seam, side)| ((*seam).to_owned(), *side)).collect::<Vec<_>>()
    };
    assert_eq!(copied(["hip front", "hip back"], alike), told(&[("side", "right"), ("other", "left")]));
    let one = "  side: {sew: one.right, to: other.right}\nfree: ['*.left', '*.waist', '*.hem']\n#";
    assert_eq!(copied(["hip front", "hip back"], one), told(&[("side", "right")]));
    // Of pieces that do not say where they are, nothing is known.
    assert_eq!(copied(["hip", "hip"], alike), []);
}

/// Shoulders meet left to left, steep ones too.
#[test]
fn shoulders_are_no_sides() {
    let text = |drawn: &str| {
        format!(
            "garment: 1\nbody: man_100\nfabrics: {{shell: wool_suiting}}\npieces:\n  front:\n    cut: pair\n    \
             drawn: L\n    place: torso front\n    grain: [[130, 100], [130, 300]]\n    \
             outline: {{start: 75 0, shoulder: L 185 45, armhole: L 255 225, side: L 250 360, hem: L 60 360, \
             edge: L 75 0}}\n  back:\n    cut: fold center\n    drawn: {drawn}\n    place: torso back\n    \
             grain: [[60, 100], [60, 300]]\n    outline: {{start: 0 25, neck: L 75 0, shoulder: L 185 45, \
             armhole: L 255 225, side: L 250 360, hem: L 0 360, center: L 0 25}}\nseams:\n  \
             shoulder: {{sew: front.shoulder, to: back.shoulder}}\n  side: {{sew: front.side, to: back.side}}\n\
             free: ['*.neck', '*.hem', '*.edge', '*.armhole']\n"
        )
    };
    assert_eq!(alike_sides(&text("R")), []);
    let wrong = alike_sides(&text("L"));
    assert!(wrong.len() == 2 && wrong.iter().all(|(seam, _)| seam.starts_with("side")), "{wrong:?}");
}

// Drawing the seams shut.

fn sewn(made: &Made, options: &SewOptions) -> Result<Sewn, SewError> {
    let (body, collider) = woman();
    sew(&made.cut(), &collider, made.placed(&body), options, &mut |_| {})
}

#[test]
fn two_squares_are_sewn_together() {
    let made = squares(30.0);
    let options = SewOptions::default();
    let mut told = Vec::new();
    let (body, collider) = woman();
    let start = made.placed(&body);
    let sewn = sew(&made.cut(), &collider, start.clone(), &options, &mut |share| told.push(share)).expect("sewn");
    sewn.closed(&made.mesh, options.tolerance).expect("closed");
    assert!(sewn.gaps.iter().all(|&g| g <= options.tolerance));
    assert_eq!(sewn.gaps.len(), made.mesh.seams[0].pairs.len());
    assert_eq!((sewn.nodes.len(), sewn.tangles), (sewn.stitching.classes, 0));
    assert!(!told.is_empty() && told.iter().all(|s| (0.0..=1.0).contains(s)), "{told:?}");
    // Nothing but the seam pulls, and it pulls on both alike: the middle of the cloth stays where it was.
    let middle =
        |x: &[Vec3], mass: &[f64]| x.iter().zip(mass).map(|(x, m)| x * *m).sum::<Vec3>() / mass.iter().sum::<f64>();
    let alone = Cloth::new(&made.cut(), toile::dynamics::identity_nodes(&made.mesh), SpringModel::Measured);
    let joined = Cloth::new(&made.cut(), sewn.stitching.class.clone(), SpringModel::Measured);
    let moved = middle(&sewn.nodes, &joined.mass) - middle(&start, &alone.mass);
    assert!(moved.norm() < 0.5 * MM, "the middle went {moved}");
    // The cloth is as long as it was drawn: 240 mm from one free edge to the other.
    let [left, right] = [0, 1].map(|k| {
        let x: Vec<f64> =
            made.mesh.pieces[k].particles.clone().map(|p| sewn.nodes[sewn.stitching.class[p] as usize].x).collect();
        x.into_iter()
            .fold(if k == 0 { f64::INFINITY } else { f64::NEG_INFINITY }, if k == 0 { f64::min } else { f64::max })
    });
    assert!((right - left - 240.0 * MM).abs() < 1.0 * MM, "{}", right - left);
}

#[test]
fn a_seam_of_a_later_stage_waits_until_those_before_have_closed() {
    let made = three_squares();
    let (body, collider) = woman();
    let widest = |sewn: &Sewn| {
        let gaps = sewn.gaps_of_seams(&made.mesh);
        ["later", "first"].map(|name| {
            let of = made.mesh.seams.iter().position(|seam| seam.name == name).expect(name);
            gaps[of].iter().copied().fold(0.0, f64::max)
        })
    };
    let sewn = |max_steps: usize| {
        let options = SewOptions { max_steps, ..SewOptions::default() };
        sew(&made.cut(), &collider, made.placed(&body), &options, &mut |_| {}).expect("sewn")
    };
    let [later, first] = widest(&sewn(1));
    assert!(first < 1.0 * MM, "nothing holds these pieces back, and the first seam is open by {first}");
    assert!(later > 10.0 * MM, "the later one has not waited: {later}");
    sewn(400).closed(&made.mesh, 1.0 * MM).expect("closed");
}

#[test]
fn a_seam_without_time_to_close_is_named_with_its_gap_and_pieces() {
    let made = squares(30.0);
    let options = SewOptions { max_steps: 0, ..SewOptions::default() };
    let sewn = sewn(&made, &options).expect("stitched as it was");
    assert!(sewn.gaps.iter().all(|g| (g - 30.0 * MM).abs() < 1e-12), "{:?}", sewn.gaps);
    let refused = sewn.closed(&made.mesh, options.tolerance);
    let Err(SewError::Open { seam, gap_mm, limit_mm, piece_a, piece_b, .. }) = &refused else {
        panic!("{refused:?}");
    };
    assert_eq!((seam.as_str(), piece_a.as_str(), piece_b.as_str()), ("side", "one", "two"));
    assert!((gap_mm - 30.0).abs() < 1e-9 && *limit_mm == 1.0);
    assert!(sewn.closed(&made.mesh, 31.0 * MM).is_ok());
}

#[test]
fn the_widest_of_all_gaps_is_the_one_that_is_named() {
    let made = tube(500.0);
    let stitching = Stitching::new(&made.mesh);
    let mut gaps = vec![0.0; stitching.pairs.len()];
    let right = stitching.pairs.iter().position(|p| p.1 == 1).expect("a stitch of the second seam");
    gaps[right] = 5.0 * MM;
    let nodes = vec![Vec3::zeros(); stitching.classes];
    let sewn = Sewn { stitching, nodes, gaps, steps: 7, tangles: 0, is_cut: false, open: None };
    let said = sewn.closed(&made.mesh, 1.0 * MM).map_err(|e| e.to_string());
    assert!(said.as_ref().is_err_and(|e| e.contains("'right'") && e.contains("5.0 mm after 7 steps")), "{said:?}");
    assert!(sewn.closed(&made.mesh, 5.0 * MM).is_ok());
}

#[test]
fn a_piece_that_starts_in_the_body_is_refused_before_anything_moves() {
    let made = squares(30.0);
    let (body, collider) = woman();
    let mut start = made.placed(&body);
    let waist = body.parts.iter().find(|p| p.kind == PartKind::Torso).and_then(|p| p.sections.last()).expect("a torso");
    let two = made.mesh.pieces[1].particles.clone();
    let shift = waist.center - Vec3::y() * 0.2 - start[two.start];
    two.for_each(|p| start[p] += shift);
    let refused = sew(&made.cut(), &collider, start, &SewOptions::default(), &mut |_| {});
    let Err(SewError::InsideBody { piece, depth_mm }) = &refused else { panic!("{:?}", refused.map(|s| s.steps)) };
    assert!(piece == "two" && *depth_mm > 15.0, "{piece} by {depth_mm}");
}

#[test]
fn a_piece_that_starts_under_the_floor_is_refused_as_too_low() {
    let made = squares(30.0);
    let (body, collider) = woman();
    let collider = collider.on_floor(body.floor());
    let mut start = made.placed(&body);
    let two = made.mesh.pieces[1].particles.clone();
    let lowest = start[two.clone()].iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
    two.for_each(|p| start[p].y -= lowest + 0.3);
    let refused = sew(&made.cut(), &collider, start, &SewOptions::default(), &mut |_| {});
    let Err(SewError::UnderFloor { piece, depth_mm }) = &refused else { panic!("{:?}", refused.map(|s| s.steps)) };
    assert!(piece == "two" && (*depth_mm - 300.0).abs() < 1e-6, "{piece} by {depth_mm}");
}

// The moment after stitching.

#[test]
fn stitching_keeps_the_weight() {
    let made = tube(500.0);
    let (_, collider) = woman();
    let stitching = Stitching::new(&made.mesh);
    let nodes: Vec<Vec3> = (0..stitching.classes).map(|k| Vec3::new(0.01 * k as f64, 5.0, 0.0)).collect();
    let world = sewn_world(&made.cut(), &collider, &stitching, nodes).expect("a world");
    let area = 2.0 * 0.5 * 0.3;
    let weight = made.fabrics[0].areal_density * area;
    let mass: f64 = world.cloth.mass.iter().sum();
    assert!((mass - weight).abs() < 1e-9 * weight, "{mass} kg and not {weight}");
    assert_eq!(world.x().len(), stitching.classes);
}

/// The two squares as one sheet, stitched where they lie, and where its nodes are when flat: a metre before the body.
fn sheet() -> (Made, Stitching, Vec<Vec3>) {
    let made = squares(0.0);
    let stitching = Stitching::new(&made.mesh);
    let (body, _) = woman();
    let nodes = stitching.welded(&made.placed(&body));
    (made, stitching, nodes)
}

#[test]
fn a_sheet_without_a_strain_stays_as_it_is() {
    let (made, stitching, nodes) = sheet();
    let (_, collider) = woman();
    let mut world = sewn_world(&made.cut(), &collider, &stitching, nodes.clone()).expect("a world");
    let mut told = 0;
    let (steps, tangles) = settle(&mut world, Calm::TO_FALL, &mut || told += 1).expect("settled");
    assert_eq!((steps, tangles, told), (1, 0, 1));
    let moved = world.x().iter().zip(&nodes).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    assert!(moved < 1e-6, "{moved} m");
}

#[test]
fn springs_pull_a_stretched_sheet_true() {
    let (made, stitching, mut nodes) = sheet();
    let (_, collider) = woman();
    nodes.iter_mut().for_each(|p| p.x *= 1.02);
    let mut world = sewn_world(&made.cut(), &collider, &stitching, nodes).expect("a world");
    let before = world.energy();
    settle(&mut world, Calm::TO_FALL, &mut || {}).expect("settled");
    let after = world.energy();
    assert!(after < 0.25 * before, "{before} J became {after} J");
    let width = |k: fn(f64, f64) -> f64, from: f64| world.x().iter().map(|p| p.x).fold(from, k);
    let width = width(f64::max, f64::NEG_INFINITY) - width(f64::min, f64::INFINITY);
    assert!((width - 240.0 * MM).abs() < 0.24 * MM, "{width}");
}

#[test]
fn a_corner_that_went_through_is_led_out() {
    let (made, stitching, flat) = sheet();
    let (_, collider) = woman();
    // Folded at the seam like a book of two leaves 12 mm apart, a few nodes of one leaf pushed through the other.
    let hinge = flat[stitching.class[made.mesh.seams[0].pairs[0][0] as usize] as usize];
    let leaf = |p: &Vec3| {
        let u = p.x - hinge.x;
        let open = (u.abs() * 0.5).min(6.0 * MM) * u.signum();
        Vec3::new(hinge.x + u.abs(), p.y, p.z + open)
    };
    let mut nodes: Vec<Vec3> = flat.iter().map(leaf).collect();
    let through = |p: &Vec3, u: f64| u > 0.0 && (p.x - hinge.x - 60.0 * MM).hypot(p.y - 0.94) < 16.0 * MM;
    let pushed: Vec<usize> = (0..nodes.len()).filter(|&k| through(&nodes[k], flat[k].x - hinge.x)).collect();
    assert!(!pushed.is_empty());
    // Aside as well: the leaves lie node over node, and edges that only meet cross nothing.
    pushed.iter().for_each(|&k| nodes[k] -= Vec3::new(3.0, 2.0, 18.0) * MM);
    let mut world = sewn_world(&made.cut(), &collider, &stitching, nodes).expect("a world");
    let count = |x: &[Vec3], triangles: &[[u32; 3]]| {
        crossings(&TriMesh { vertices: x.to_vec(), triangles: triangles.to_vec() }).len()
    };
    assert!(count(world.x(), &world.cloth.triangles) > 0, "nothing to lead out");
    let (steps, tangles) = settle(&mut world, Calm::TO_FALL, &mut || {}).expect("settled");
    assert_eq!((tangles, count(world.x(), &world.cloth.triangles)), (0, 0), "after {steps} steps");
}

/// The rim of an ear between the particles of a hood stayed there: each of them was outside.
#[test]
fn what_a_thin_part_of_the_body_pokes_through_comes_off_it() {
    let (made, stitching, nodes) = sheet();
    let mesh = TriMesh { vertices: nodes.clone(), triangles: made.mesh.triangles.clone() };
    let centre = mesh.vertices.iter().sum::<Vec3>() / mesh.vertices.len() as f64;
    let spacing = made.mesh.spacing;
    // Through the middle of an edge, and through a triangle beside it.
    for aside in [0.0, 0.2 * spacing] {
        let nearest = nodes.iter().min_by(|a, b| (*a - centre).norm().total_cmp(&(*b - centre).norm())).expect("nodes");
        let tip = nearest + Vec3::new(0.5 * spacing, aside, 6.0 * MM);
        let corner = |x: f64, y: f64| tip + Vec3::new(x, y, -40.0) * MM;
        let vertices = vec![corner(-8.0, -8.0), corner(8.0, -8.0), corner(8.0, 8.0), corner(-8.0, 8.0), tip];
        let triangles = vec![[0, 2, 1], [0, 3, 2], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
        let spike = TriMesh { vertices, triangles };
        let collider = Collider::new(&spike).expect("closed");
        assert!(nodes.iter().all(|p| collider.nearest(*p, 1.0).is_none_or(|n| n.distance > 0.0)), "only cut");
        let mut world = sewn_world(&made.cut(), &collider, &stitching, nodes.clone()).expect("a world");
        assert!(world.is_cut());
        let (_, tangles) = settle(&mut world, Calm::TO_FALL, &mut || {}).expect("settled");
        let cloth = TriMesh { vertices: world.x().to_vec(), triangles: world.cloth.triangles.clone() };
        let between = crossings_between(&cloth, &spike);
        assert_eq!((tangles, between.pairs.len(), world.is_cut()), (0, 0, false), "{aside} m");
    }
}

/// Without shoulder seams its body was hung from the waist, as a skirt is, and the neck band slipped off the shoulders.
#[test]
fn a_raglan_starts_at_its_shoulders_and_its_pair_of_sleeves_on_both_arms() {
    let body = load("child_110").expect("shipped");
    let made = Made::new(include_str!("data/raglan.yaml"), 18.0);
    let x = made.placed(&body);
    let collider = Collider::new(&body.mesh).expect("closed");
    assert!(sew(&made.cut(), &collider, x.clone(), &SewOptions::default(), &mut |_| {}).expect("sewn").open.is_none());
    let neck = body.part(PartKind::Neck).expect("a neck").sections[0].center.y;
    for (piece, side) in made.mesh.pieces.iter().zip([0.0, 0.0, 1.0, -1.0]) {
        let top = piece.particles.clone().map(|p| x[p].y).fold(f64::MIN, f64::max);
        let middle = piece.particles.clone().map(|p| x[p].x).sum::<f64>() / piece.particles.len() as f64;
        if side == 0.0 {
            assert!((top - neck).abs() < 60.0 * MM, "{} begins at {top}, the neck at {neck}", piece.name);
        } else {
            assert!(side * middle > 150.0 * MM, "{} is at {middle}", piece.name);
        }
    }
}

/// Its ring went round the arms as well, and the side seams could not close.
#[test]
fn what_is_wider_than_the_room_between_the_arms_starts_deep_instead() {
    let (body, collider) = woman();
    let made = Made::new(include_str!("data/boxy_shirt.yaml"), 20.0);
    let x = made.placed(&body);
    // Under the arms its sides are between them.
    let waist =
        body.part(PartKind::Torso).expect("a trunk").landmarks.iter().find(|l| l.0 == "waist").expect("a waist").1;
    let arms = body.part(PartKind::LeftArm).expect("an arm").sections.iter();
    let inner = arms.filter(|s| s.center.y > waist.y).map(|s| s.center.x).fold(f64::MIN, f64::max);
    let widest = x.iter().filter(|p| (p.y - waist.y).abs() < 0.01).map(|p| p.x.abs()).fold(0.0, f64::max);
    assert!(widest < inner, "{widest} m wide at the waist, where the arm is {inner} m out");
    let sewn = sew(&made.cut(), &collider, x, &SewOptions::default(), &mut |_| {}).expect("a step");
    assert!(sewn.open.is_none(), "{:?}", sewn.closed(&made.mesh, 1e-3));
}
