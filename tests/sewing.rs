//! Sewing: who is sewn to whom, where the pieces start, closing, and what is done to a newly stitched cloth.

use std::sync::Arc;

use proptest::prelude::*;
use toile::contact::Collider;
use toile::dynamics::{Cloth, Cut, SpringModel};
use toile::fabric::{self, Fabric};
use toile::geometry::{TriMesh, Vec2, Vec3};
use toile::mannequin::{Mannequin, PartKind, load};
use toile::mesh::{ClothMesh, Stitches, build};
use toile::pattern::{Garment, Place, PlaceWord};
use toile::sew::place::{PlaceError, place};
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
        let collider = Collider::new(&body.mesh).expect("closed");
        place(&self.garment, &self.mesh, body, &collider).expect("a place for every piece")
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
fn shipped_garments_start_outside_their_bodies_and_uncrossed() {
    for name in ["child_dress", "gore_skirt", "sheath_dress", "trousers", "tshirt"] {
        let file = format!("{}/patterns/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
        let made = Made::new(&std::fs::read_to_string(file).expect("shipped"), 20.0);
        let body = load(made.garment.body.as_deref().expect("a body")).expect("shipped");
        let collider = Collider::new(&body.mesh).expect("closed");
        let start = made.placed(&body);
        for piece in &made.mesh.pieces {
            let height = |p: usize| collider.nearest(start[p], 1.0).map_or(1.0, |n| n.distance);
            let deepest = piece.particles.clone().map(height).fold(1.0, f64::min);
            let inside = piece.particles.clone().filter(|&p| height(p) < 0.0).count();
            // Under an arm a few points may start in it, by less than sewing pushes out (15 mm).
            let said = format!("{name}: {inside} of {}, the deepest at {} mm", piece.name, deepest / MM);
            assert!(deepest > -10.0 * MM && 100 * inside <= piece.particles.len(), "{said}");
        }
        let cloth = TriMesh { vertices: start, triangles: made.mesh.triangles.clone() };
        assert_eq!(crossings(&cloth).len(), 0, "{name}");
    }
}

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

/// The crease of a leg, between two seams to the other half, and the hem turned up under it.
#[test]
fn a_crease_between_seams_starts_open_and_a_hem_turned_up() {
    let (body, _) = woman();
    let starts = |line: &str| {
        let made = Made::new(
            &format!(
                "garment: 1\nbody: woman_92\nfabrics: {{shell: cotton_poplin}}\npieces:\n  front:\n    \
                 place: skirt front\n    grain: [[10, 10], [10, 90]]\n    \
                 outline: {{start: 0 0, top: L 560 0, right: L 560 300, hem: L 0 300, left: L 0 0}}\n    \
                 lines: {{press: {{path: {line}, fold: 180}}}}\n  back: {{like: front, place: skirt back}}\n\
                 seams:\n  left: {{sew: front.right, to: back.left}}\n  right: {{sew: front.left, to: back.right}}\n\
                 free: ['*.top', '*.hem']\n"
            ),
            20.0,
        );
        let x = made.placed(&body);
        let front = made.mesh.pieces.iter().find(|p| p.name == "front").expect("a piece").particles.clone();
        [0, 1].map(|axis| {
            let along = front.clone().map(|p| x[p][axis]);
            along.clone().fold(f64::NEG_INFINITY, f64::max) - along.fold(f64::INFINITY, f64::min)
        })
    };
    let [open, [_, turned]] = ["M 280 0 L 280 300", "M 0 240 L 560 240"].map(starts);
    assert!(open[0] > 300.0 * MM && open[1] > 290.0 * MM, "folded along its crease: {open:?}");
    assert!((turned - 240.0 * MM).abs() < 10.0 * MM, "{} mm tall", turned / MM);
}

#[test]
fn shoulder_seams_start_over_the_shoulders() {
    for name in ["child_dress", "sheath_dress", "tshirt"] {
        let file = format!("{}/patterns/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
        let made = Made::new(&std::fs::read_to_string(file).expect("shipped"), 20.0);
        let body = load(made.garment.body.as_deref().expect("a body")).expect("shipped");
        let neck =
            body.parts.iter().find(|p| p.kind == PartKind::Neck).and_then(|p| p.sections.first()).expect("a neck");
        let start = made.placed(&body);
        for seam in made.mesh.seams.iter().filter(|s| s.name.starts_with("shoulder")) {
            for [a, b] in seam.pairs.iter().map(|p| p.map(|p| start[p as usize])) {
                // Nearer each other than the chest is deep, one before the other, and as high as shoulders are.
                assert!((a - b).norm() < 130.0 * MM, "{name}: {} mm apart", (a - b).norm() / MM);
                assert!(a.z > b.z, "{name}: front at {a}, back at {b}");
                let low = (neck.center.y - a.y).max(neck.center.y - b.y);
                assert!((-80.0 * MM..80.0 * MM).contains(&low), "{name}: {} mm under the neck", low / MM);
            }
        }
    }
}

/// A skirt of two sectors of `opening` degrees, waist 180 mm and hem 600 mm from their apex.
fn circle_skirt(opening: f64) -> Made {
    let at = |radius: f64, degrees: f64| {
        let angle: f64 = degrees.to_radians();
        format!("{} {}", radius * angle.sin(), radius * angle.cos())
    };
    let half = 0.5 * opening;
    let (a, b, c, d) = (at(180.0, -half), at(180.0, half), at(600.0, half), at(600.0, -half));
    Made::new(
        &format!(
            "garment: 1\nbody: woman_92\nfabrics: {{shell: cotton_poplin}}\npieces:\n  front:\n    \
             place: skirt front\n    grain: [[0, 250], [0, 550]]\n    \
             outline: {{start: {a}, waist: 'A 180 180 0 0 0 {b}', left: L {c}, hem: 'A 600 600 0 0 1 {d}', \
             right: L {a}}}\n  \
             back: {{like: front, place: skirt back}}\n\
             seams:\n  left: {{sew: front.left, to: back.right}}\n  right: {{sew: front.right, to: back.left}}\n\
             free: ['*.waist', '*.hem']\n"
        ),
        20.0,
    )
}

#[test]
fn a_circle_skirt_starts_as_a_cone() {
    let (body, collider) = woman();
    let made = circle_skirt(110.0);
    let x = made.placed(&body);
    let flat = &made.mesh.flat;
    assert!(x.iter().all(|p| collider.nearest(*p, 1.0).is_none_or(|n| n.distance > 0.0)));
    assert_eq!(crossings(&TriMesh { vertices: x.clone(), triangles: made.mesh.triangles.clone() }).len(), 0);
    // What is as far from the apex lies as high: r of 180 to 600 mm falls by 420 mm times cos α, sin α = 220° / 360°.
    let top = (0..x.len()).find(|&p| (flat[p].norm() - 180.0 * MM).abs() < 1e-6).map(|p| x[p].y).expect("a waist");
    let fall = (1.0 - (220.0f64 / 360.0).powi(2)).sqrt();
    for (p, flat) in x.iter().zip(flat) {
        let expected = (flat.norm() - 180.0 * MM) * fall;
        assert!((top - p.y - expected).abs() < 1.0 * MM, "{} mm under the waist, not {expected}", (top - p.y) / MM);
    }
    // Nearly isometric: it falls more steeply where the ring is the body's own, and less so right below.
    let edges = made.mesh.triangles.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]);
    let ratio =
        |[a, b]: [u32; 2]| (x[a as usize] - x[b as usize]).norm() / (flat[a as usize] - flat[b as usize]).norm();
    let strains: Vec<f64> = edges.map(|e| ratio(e) - 1.0).collect();
    let rms = (strains.iter().map(|e| e * e).sum::<f64>() / strains.len() as f64).sqrt();
    let sheared = strains.iter().filter(|e| e.abs() > 0.3).count();
    // But at the ends of the side seams, where the body's ring and the cone part.
    assert!(rms < 0.12 && 100 * sheared < 2 * strains.len(), "{rms}, {sheared} of {}", strains.len());
    // Two seams share what the ring, two centimetres off the hips, is longer than the cloth.
    let gaps = Stitching::new(&made.mesh).gaps(&x);
    assert!(gaps.iter().all(|&g| g < 125.0 * MM), "{:?}", gaps.iter().copied().fold(0.0, f64::max));
}

/// Two sectors of 175 degrees would make a cone that is nearly flat: they start in waves, as long as their cloth.
#[test]
fn a_fuller_circle_skirt_starts_in_waves() {
    let (body, collider) = woman();
    let made = circle_skirt(175.0);
    let (x, flat) = (made.placed(&body), &made.mesh.flat);
    assert!(x.iter().all(|p| collider.nearest(*p, 1.0).is_none_or(|n| n.distance > 0.0)));
    assert_eq!(crossings(&TriMesh { vertices: x.clone(), triangles: made.mesh.triangles.clone() }).len(), 0);
    let radius = |p: usize| flat[p].norm() / MM;
    let top = (0..x.len()).find(|&p| (radius(p) - 180.0).abs() < 1e-3).map(|p| x[p].y).expect("a waist");
    // 420 mm of cloth fall by 336 on the cone; crests fall less, valleys more.
    let falls: Vec<f64> = (0..x.len()).filter(|&p| radius(p) > 599.0).map(|p| (top - x[p].y) / MM).collect();
    let (least, most) = falls.iter().fold((f64::MAX, 0.0f64), |(a, b), f| (a.min(*f), b.max(*f)));
    assert!(least > 230.0 && most < 420.0 && most - least > 30.0, "{least} to {most}");
    let edges = made.mesh.triangles.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]);
    let ratio =
        |[a, b]: [u32; 2]| (x[a as usize] - x[b as usize]).norm() / (flat[a as usize] - flat[b as usize]).norm();
    let strains: Vec<f64> = edges.map(|e| ratio(e) - 1.0).collect();
    let rms = (strains.iter().map(|e| e * e).sum::<f64>() / strains.len() as f64).sqrt();
    assert!(rms < 0.12, "{rms}");
}

/// A waistband drawn level, upright with its sewn side to the left, upright with it to the right: all start alike.
#[test]
fn a_band_drawn_upright_starts_level() {
    let (body, collider) = woman();
    let bands = [
        ("L 760 0", "L 760 40", "L 0 40", "bottom"),
        ("L 0 760", "L -40 760", "L -40 0", "bottom"),
        ("L 0 760", "L 40 760", "L 40 0", "bottom"),
        ("L 0 760", "L 40 760", "L 40 0", "top"),
    ];
    let mut first = None;
    for (top, right, bottom, sewn) in bands {
        let grain = if top == "L 760 0" { "[[10, 20], [90, 20]]" } else { "[[0, 10], [0, 90]]" };
        let free = if sewn == "top" { "bottom" } else { "top" };
        let made = Made::new(
            &format!(
                "garment: 1\nbody: woman_92\nfabrics: {{shell: cotton_poplin}}\npieces:\n  front:\n    \
                 place: skirt front\n    grain: [[10, 10], [10, 390]]\n    \
                 outline: {{start: 0 0, waist: L 380 0, left: L 480 400, hem: L -100 400, right: L 0 0}}\n  \
                 back: {{like: front, place: skirt back}}\n  band:\n    place: waist\n    grain: {grain}\n    \
                 outline: {{start: 0 0, top: {top}, end: {right}, bottom: {bottom}, begin: L 0 0}}\n\
                 seams:\n  left: {{sew: front.left, to: back.right}}\n  right: {{sew: front.right, to: back.left}}\n  \
                 waist: {{sew: [front.waist, back.waist], to: band.{sewn}}}\n  \
                 ends: {{sew: band.begin, to: band.end}}\n\
                 free: ['*.hem', band.{free}]\n"
            ),
            20.0,
        );
        let x = made.placed(&body);
        assert!(x.iter().all(|p| collider.nearest(*p, 1.0).is_none_or(|n| n.distance > 0.0)));
        assert_eq!(crossings(&TriMesh { vertices: x.clone(), triangles: made.mesh.triangles.clone() }).len(), 0);
        let heights = |name: &str| {
            let piece = made.mesh.pieces.iter().find(|p| p.name == name).expect("a piece");
            let ys = piece.particles.clone().map(|p| x[p].y);
            ys.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], y| [low.min(y), high.max(y)])
        };
        let ([band, _], [_, skirt]) = (heights("band"), heights("front"));
        assert!((1.0 * MM..10.0 * MM).contains(&(band - skirt)), "{top}: {} mm above", (band - skirt) / MM);
        let widest = Stitching::new(&made.mesh).gaps(&x).into_iter().fold(0.0, f64::max);
        // The ring two centimetres off the body is so much longer than the waist.
        assert!(*first.get_or_insert(widest) * 1.1 > widest, "{top}, {sewn}: {} mm", widest / MM);
    }
}

/// Front and back meet at the shoulders only, and are so many millimetres long.
fn tabard(length: f64) -> Made {
    Made::new(
        &format!(
            "garment: 1\nbody: woman_92\nfabrics: {{shell: cotton_poplin}}\npieces:\n  front:\n    \
             place: torso front\n    grain: [[0, 250], [0, 550]]\n    \
             outline: {{start: -110 0, neck: 'C -80 110, 80 110, 110 0', left: L 200 25, edge_left: L 215 {length}, \
             hem: L -215 {length}, edge_right: L -200 25, right: L -110 0}}\n  \
             back: {{like: front, place: torso back}}\nseams:\n  left: {{sew: front.left, to: back.right}}\n  \
             right: {{sew: front.right, to: back.left}}\nfree: ['*.neck', '*.hem', '*.edge_left', '*.edge_right']\n",
        ),
        20.0,
    )
}

#[test]
fn what_hangs_to_the_floor_starts_clear_of_the_toes() {
    let (body, _) = woman();
    let floor = body.floor().expect("somebody stands");
    let lowest = |length: f64| {
        let x = tabard(length).placed(&body);
        x.iter().map(|p| p.y - floor).fold(f64::INFINITY, f64::min)
    };
    // As long as hangs freely, from there so many millimetres further.
    let free = lowest(1200.0) / MM;
    assert!((30.0..300.0).contains(&free), "{free} mm off the floor");
    for (longer, off) in [(free - 40.0, 40.0), (free - 10.0, 30.0), (free + 20.0, 10.0)] {
        let low = lowest(1200.0 + longer) / MM;
        assert!((low - off).abs() < 3.0, "{longer} mm longer it starts {low} mm off the floor, not {off}");
    }
}

#[test]
fn a_tabard_starts_over_the_shoulders_open_at_its_sides() {
    let (body, collider) = woman();
    let made = tabard(600.0);
    let x = made.placed(&body);
    assert!(x.iter().all(|p| collider.nearest(*p, 1.0).is_none_or(|n| n.distance > 0.0)));
    assert_eq!(crossings(&TriMesh { vertices: x.clone(), triangles: made.mesh.triangles.clone() }).len(), 0);
    let shoulders = Stitching::new(&made.mesh).gaps(&x).into_iter().fold(0.0, f64::max);
    assert!(shoulders < 120.0 * MM, "{} mm apart at the shoulders", shoulders / MM);
    let mean = |name: &str| {
        let piece = made.mesh.pieces.iter().find(|p| p.name == name).expect("a piece");
        piece.particles.clone().map(|p| x[p]).sum::<Vec3>() / piece.particles.len() as f64
    };
    let (front, back) = (mean("front"), mean("back"));
    assert!((front.y - back.y).abs() < 20.0 * MM && front.z > back.z + 100.0 * MM, "{front} {back}");
}

/// Cuffs that flare so widely that their sides run more across than down.
#[test]
fn a_cuff_that_flares_widely_starts_as_one_ring() {
    let (body, _) = woman();
    let made = Made::new(
        "garment: 1\nbody: woman_92\nfabrics: {shell: cotton_poplin}\npieces:\n  front:\n    \
         place: left arm front\n    \
         grain: [[0, 10], [0, 40]]\n    outline: {start: -110 0, top: L 110 0, over: L 230 54, hem: L -230 54, \
         under: L -110 0}\n  back: {like: front, place: left arm back}\nseams:\n  \
         over: {sew: front.over, to: back.under}\n  \
         under: {sew: front.under, to: back.over}\nfree: ['*.top', '*.hem']\n",
        12.0,
    );
    let x = made.placed(&body);
    assert_eq!(crossings(&TriMesh { vertices: x.clone(), triangles: made.mesh.triangles.clone() }).len(), 0);
    // Side by side: neither lies along the arm above the other.
    let arm = body.parts.iter().find(|p| p.kind == PartKind::LeftArm).expect("an arm");
    let along = |piece: usize| {
        let particles = made.mesh.pieces[piece].particles.clone();
        particles.clone().map(|p| (x[p] - arm.sections[0].center).dot(&arm.sections[0].axis)).sum::<f64>()
            / particles.len() as f64
    };
    assert!((along(0) - along(1)).abs() < 10.0 * MM, "{} and {}", along(0), along(1));
}

/// A shirt without sleeves, open in front, the fronts 20 mm over the middle; and what more its file says.
fn open_shirt(closures: &str) -> Made {
    let text = format!(
        "garment: 1\nbody: woman_92\nfabrics: {{shell: cotton_poplin}}\npieces:\n  back:\n    cut: fold center\n    \
         drawn: R\n    grain: [[60, 100], [60, 400]]\n    place: torso back\n    outline: {{start: 0 20, \
         neck: 'C 40 20, 65 15, 75 0', shoulder: L 195 40, armhole: 'C 180 120, 190 180, 250 200', side: L 255 620, \
         hem: L 0 620, center: L 0 20}}\n  front:\n    cut: pair\n    drawn: L\n    grain: [[60, 100], [60, 400]]\n    \
         place: torso front\n    outline: {{start: -20 70, neck: 'C 35 70, 70 40, 75 0', shoulder: L 195 40, \
         armhole: 'C 170 120, 185 180, 250 200', side: L 255 620, hem: L -20 620, edge: L -20 70}}\n\
         {closures}seams:\n  \
         shoulder_l: {{sew: front.L.shoulder, to: back.shoulder.L}}\n  \
         shoulder_r: {{sew: front.R.shoulder, to: back.shoulder.R}}\n  \
         side_l: {{sew: front.L.side, to: back.side.L}}\n  side_r: {{sew: front.R.side, to: back.side.R}}\n\
         free: [front.neck, front.hem, front.edge, back.neck, back.hem, '*.armhole']\n"
    );
    Made::new(&text, 20.0)
}

#[test]
fn what_is_open_in_front_starts_with_its_fronts_in_front() {
    let (body, collider) = woman();
    let made = open_shirt("");
    let x = made.placed(&body);
    assert!(x.iter().all(|p| collider.nearest(*p, 1.0).is_none_or(|n| n.distance > 0.0)));
    assert_eq!(crossings(&TriMesh { vertices: x.clone(), triangles: made.mesh.triangles.clone() }).len(), 0);
    let middle = |name: &str| {
        let piece = made.mesh.pieces.iter().find(|p| p.name == name).expect("a piece");
        piece.particles.clone().map(|p| x[p]).sum::<Vec3>() / piece.particles.len() as f64
    };
    let [left, right, back] = ["front.L", "front.R", "back"].map(middle);
    assert!(left.z > back.z + 100.0 * MM && right.z > back.z + 100.0 * MM, "{left:?}, {right:?}, {back:?}");
    assert!(left.x > 50.0 * MM && right.x < -50.0 * MM, "{left:?}, {right:?}");
}

#[test]
fn buttoned_fronts_start_one_over_the_other() {
    let (body, collider) = woman();
    let made = open_shirt(
        "closures:\n  - {kind: button, piece: front.L, at: [0, 100], meets: front.R, meets_at: [0, 100], pitch: 90, \
         count: 6}\n",
    );
    let x = made.placed(&body);
    assert!(x.iter().all(|p| collider.nearest(*p, 1.0).is_none_or(|n| n.distance > 0.0)));
    assert_eq!(crossings(&TriMesh { vertices: x.clone(), triangles: made.mesh.triangles.clone() }).len(), 0);
    let tacks: Vec<_> = made.garment.closures.iter().flat_map(|c| &c.tacks).collect();
    assert_eq!(tacks.len(), 6);
    for tack in tacks {
        // Particles are up to a cell's diagonal from the point.
        let [on, meets] = tack.map(|(piece, at)| x[made.mesh.nearest(piece, at).expect("a particle")]);
        assert!((on - meets).norm() < 35.0 * MM, "{on:?} and {meets:?}");
        assert!(meets.z > on.z + 2.0 * MM, "the buttonhole is outside: {on:?} and {meets:?}");
    }
}

/// A piece starts outside the body, and all edges of its mesh together are within a tenth as long as they are cut.
fn starts_as_it_is_cut(made: &Made, piece: usize, x: &[Vec3], body: &Collider) {
    let piece = &made.mesh.pieces[piece];
    for p in piece.particles.clone() {
        assert!(body.nearest(x[p], 1.0).is_none_or(|n| n.distance > 0.0), "{:?} in the body", x[p]);
    }
    let (mut cut, mut starts) = (0.0, 0.0);
    for t in &made.mesh.triangles[piece.triangles.clone()] {
        for [a, b] in [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]].map(|edge| edge.map(|p| p as usize)) {
            cut += (made.mesh.flat[a] - made.mesh.flat[b]).norm();
            starts += (x[a] - x[b]).norm();
        }
    }
    assert!((starts / cut - 1.0).abs() < 0.1, "{} starts {:.2} times as long as it is cut", piece.name, starts / cut);
}

/// A strap that only its ends hold, as an apron's round the neck, is no band that goes round by what is sewn of it.
#[test]
fn a_strap_sewn_at_its_ends_starts_once_round() {
    let (body, collider) = woman();
    let made = Made::new(
        "garment: 1\nbody: woman_92\nfabrics: {shell: cotton_poplin}\npieces:\n  bib:\n    place: torso front\n    \
         grain: [[0, 50], [0, 250]]\n    outline: {start: -130 0, top: L 130 0, left: L 200 300, hem: L -200 300, \
         right: L -130 0}\n  loop:\n    place: neck back\n    grain: [[20, 20], [600, 20]]\n    outline: {start: 0 0, \
         upper: L 620 0, right: L 620 40, lower: L 0 40, left: L 0 0}\nseams:\n  \
         right: {sew: loop.right, to: bib.top@0..40}\n  left: {sew: loop.left, to: bib.top@220..260}\n\
         free: [bib.top, bib.left, bib.right, bib.hem, loop.upper, loop.lower]\n",
        13.0,
    );
    let x = made.placed(&body);
    assert_eq!(crossings(&TriMesh { vertices: x.clone(), triangles: made.mesh.triangles.clone() }).len(), 0);
    starts_as_it_is_cut(&made, 1, &x, &collider);
}

/// Nor is a bib that stands on a waistband in front.
#[test]
fn a_bib_on_a_waistband_starts_as_wide_as_it_is() {
    let (body, collider) = woman();
    let made = Made::new(
        "garment: 1\nbody: woman_92\nfabrics: {shell: cotton_poplin}\npieces:\n  skirt:\n    place: torso front\n    \
         grain: [[0, 50], [0, 250]]\n    outline: {start: -400 0, waist: L 400 0, left: L 400 400, hem: L -400 400, \
         right: L -400 0}\n  bib:\n    place: torso front\n    grain: [[0, 50], [0, 250]]\n    \
         outline: {start: -130 0, top: L 130 0, left: L 130 250, bottom: L -130 250, right: L -130 0}\nseams:\n  \
         back: {sew: skirt.left, to: skirt.right}\n  bib: {sew: bib.bottom, to: skirt.waist@270..530}\n\
         free: [skirt.waist, skirt.hem, bib.top, bib.left, bib.right]\n",
        20.0,
    );
    let x = made.placed(&body);
    assert_eq!(crossings(&TriMesh { vertices: x.clone(), triangles: made.mesh.triangles.clone() }).len(), 0);
    let bib = made.mesh.pieces[1].particles.clone().map(|p| x[p]).collect::<Vec<_>>();
    assert!(bib.iter().all(|p| p.z > 0.0), "it stands in front");
    starts_as_it_is_cut(&made, 1, &x, &collider);
}

/// A skirt with two godets in its front, one by one seam that turns at its point, one by a seam on either side; half of
/// either is `half` wide at the hem, in millimetres, and its sides are 273.1 long as those of the slits are.
fn godets(half: f64) -> Made {
    let height = (273.13_f64.powi(2) - half.powi(2)).sqrt();
    let text = format!(
        "garment: 1\nbody: woman_92\nfabrics: {{shell: cotton_poplin}}\npieces:\n  front:\n    place: skirt front\n    \
         grain: [[300, 50], [300, 250]]\n    outline: {{start: 0 0, waist: L 600 0, left: L 600 600, h1: L 560 600, \
         a1: L 450 350, a2: L 340 600, h2: L 260 600, b1: L 150 350, b2: L 40 600, h3: L 0 600, right: L 0 0}}\n  \
         back: {{place: skirt back, grain: [[300, 50], [300, 250]], outline: {{start: 0 0, waist: L 600 0, \
         right: L 600 600, hem: L 0 600, left: L 0 0}}}}\n  \
         one: {{place: skirt front, grain: [[{half}, 50], [{half}, {height}]], outline: {{start: 0 {height}, \
         l: L {half} 0, r: L {wide} {height}, hem: L 0 {height}}}}}\n  two: {{like: one}}\nseams:\n  \
         left: {{sew: front.left, to: back.left}}\n  \
         right: {{sew: front.right, to: back.right}}\n  one: {{sew: [one.l, one.r], to: [front.a2, front.a1]}}\n  \
         two_l: {{sew: two.l, to: front.b2}}\n  \
         two_r: {{sew: two.r, to: front.b1}}\nfree: ['*.waist', '*.hem', front.h1, front.h2, front.h3]\n",
        wide = 2.0 * half
    );
    Made::new(&text, 20.0)
}

/// The widest gap of the godets' seams at the start, mm; nothing is in the body or crosses anything.
fn widest_gap_of_godets(made: &Made) -> f64 {
    let (body, collider) = woman();
    let x = made.placed(&body);
    assert!(x.iter().all(|p| collider.nearest(*p, 1.0).is_none_or(|n| n.distance > 0.0)));
    assert_eq!(crossings(&TriMesh { vertices: x.clone(), triangles: made.mesh.triangles.clone() }).len(), 0);
    let seams = made.mesh.seams.iter().filter(|s| s.name.starts_with("one") || s.name.starts_with("two"));
    let gaps = seams.flat_map(|s| &s.pairs).map(|[a, b]| (x[*a as usize] - x[*b as usize]).norm());
    gaps.fold(0.0, f64::max) / MM
}

#[test]
fn godets_start_in_their_slits() {
    let made = godets(100.0);
    // The slits are 220 mm wide at the hem, the godets 200: 10 mm on either side, and a little off.
    let widest = widest_gap_of_godets(&made);
    assert!(widest < 25.0, "{widest} mm");
}

/// Godets 400 mm wide overlap where their slits are 300 mm apart, and reach beyond the front. Lying flat one over the
/// other they are up to 90 mm from their slits.
#[test]
fn wide_godets_start_folded_out_of_their_slits() {
    let made = godets(200.0);
    let widest = widest_gap_of_godets(&made);
    // The godet is as much lower than its slit, 250 mm, as it is spread: 64 mm, half of that at either end.
    assert!(widest < 45.0, "{widest} mm");
    // Cloth keeps its width: the way from side to side over the fold at the hem is the hem's.
    let (body, _) = woman();
    let x = made.placed(&body);
    for piece in made.mesh.pieces.iter().filter(|p| ["one", "two"].contains(&p.name.as_str())) {
        let hem = &piece.edges.iter().find(|e| e.name == "hem").expect("a hem").particles;
        let length: f64 = hem.windows(2).map(|w| (x[w[1] as usize] - x[w[0] as usize]).norm()).sum();
        assert!((length - 400.0 * MM).abs() < 20.0 * MM, "{}: {} mm", piece.name, length / MM);
    }
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
    for name in ["tshirt", "trousers", "gore_skirt"] {
        let file = format!("{}/patterns/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
        let made = Made::new(&std::fs::read_to_string(file).expect("shipped"), 25.0);
        let (here, there) = (made.placed(&body), made.placed(&moved));
        let off = here.iter().zip(&there).map(|(a, b)| (b - a - to).norm()).fold(0.0, f64::max);
        assert!(off < 1e-6, "{name}: {} mm off", off / MM);
    }
}

#[test]
fn cuffs_start_round_their_own_legs_and_trousers_round_both() {
    let (body, _) = woman();
    let text = |seams: &str| {
        format!(
            "garment: 1\nbody: woman_92\nfabrics: {{shell: cotton_poplin}}\npieces:\n  front:\n    \
             cut: pair\n    place: leg front\n    grain: [[100, 10], [100, 90]]\n    \
             outline: {{start: 0 0, top: L 250 0, out: L 250 200, hem: L 0 200, in: L 0 0}}\n  \
             back:\n    cut: pair\n    place: leg back\n    grain: [[-100, 10], [-100, 90]]\n    \
             outline: {{start: 0 0, in: L 0 200, hem: L -250 200, out: L -250 0, top: L 0 0}}\n\
             seams: {{outseam: {{sew: front.out, to: back.out}}, {seams}}}\nfree: ['*.top', '*.hem']\n"
        )
    };
    let cuffs = Made::new(&text("inseam: {sew: front.in, to: back.in}"), 20.0);
    let trousers = Made::new(&text("rise: {sew: front.in, to: mirror}, seat: {sew: back.in, to: mirror}"), 20.0);
    let leg = body.parts.iter().find(|p| p.kind == PartKind::LeftLeg).expect("a leg");
    let middle = leg.sections.iter().map(|s| s.center.x).sum::<f64>() / leg.sections.len() as f64;
    let x = cuffs.placed(&body);
    for piece in &cuffs.mesh.pieces {
        let sign = if piece.name.ends_with(".L") { 1.0 } else { -1.0 };
        let mean = piece.particles.clone().map(|p| x[p].x).sum::<f64>() / piece.particles.len() as f64;
        assert!((sign * mean - middle).abs() < 60.0 * MM, "{} is at {} mm", piece.name, mean / MM);
        let forward = piece.particles.clone().map(|p| x[p].z).sum::<f64>() / piece.particles.len() as f64;
        assert!(piece.name.starts_with("front") == (forward > leg.sections[0].center.z), "{}: {forward}", piece.name);
    }
    // Round the trunk the two fronts meet in the middle, and so do the two backs.
    let x = trousers.placed(&body);
    for seam in trousers.mesh.seams.iter().filter(|s| s.name != "outseam.L" && s.name != "outseam.R") {
        for [a, b] in seam.pairs.iter().map(|p| p.map(|p| x[p as usize])) {
            assert!(a.x.abs() < 30.0 * MM && b.x.abs() < 30.0 * MM, "{}: {a} {b}", seam.name);
        }
    }
}

/// The torso's and the legs' sections: (height, middle, half width, half depth).
fn trunk(body: &Mannequin) -> Vec<(f64, Vec3, f64, f64)> {
    let parts = body.parts.iter().filter(|p| p.kind == PartKind::Torso);
    parts.flat_map(|p| &p.sections).map(|s| (s.center.y, s.center, s.half_width, s.half_depth)).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn a_tube_starts_as_a_ring_round_the_body(width in 600.0..900.0f64) {
        let (body, collider) = woman();
        let made = tube(width);
        let x = made.placed(&body);
        let flat = &made.mesh.flat;
        let stitching = Stitching::new(&made.mesh);
        for p in &x {
            // Two centimetres off the body's width and depth, which leaves less at its corners.
            let near = collider.nearest(*p, 1.0).expect("within a metre");
            prop_assert!(near.distance > 8.0 * MM, "{} mm from the body", near.distance / MM);
        }
        // The ring is as long as the cloth and the room at the seams, 4 mm each: its partners start so near.
        for gap in stitching.gaps(&x) {
            prop_assert!((3.5 * MM..4.5 * MM).contains(&gap), "a gap of {} mm", gap / MM);
        }
        for (k, piece) in made.mesh.pieces.iter().enumerate() {
            let middle = piece.particles.clone().map(|p| x[p]).sum::<Vec3>() / piece.particles.len() as f64;
            prop_assert!(if k == 0 { middle.z > 0.05 } else { middle.z < -0.05 }, "{} is at {middle}", piece.name);
            prop_assert!(middle.x.abs() < MM, "{} is off the middle: {middle}", piece.name);
            for p in piece.particles.clone() {
                // Flat y runs down, and a cylinder bends no other way.
                let first = piece.particles.start;
                let fall = (x[first].y - x[p].y) - (flat[p].y - flat[first].y);
                prop_assert!(fall.abs() < 1e-9, "{} mm too low", fall / MM);
            }
        }
        // Seen from the front, what is drawn on the right is on the wearer's left, and that is where x is positive.
        let left = &made.mesh.seams[0].pairs;
        prop_assert!(left.iter().flatten().all(|&p| x[p as usize].x > 0.1));
    }

    #[test]
    fn level_threads_keep_their_lengths_when_a_piece_is_bent(width in 600.0..900.0f64) {
        let (body, _) = woman();
        let made = tube(width);
        let x = made.placed(&body);
        for edge in made.mesh.triangles.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]) {
            let [a, b] = edge.map(|p| p as usize);
            // Level ones only: where the ring's shape changes with height, upright threads are sheared.
            if (made.mesh.flat[a].y - made.mesh.flat[b].y).abs() > 1e-9 {
                continue;
            }
            let (flat, bent) = ((made.mesh.flat[a] - made.mesh.flat[b]).norm(), (x[a] - x[b]).norm());
            // A chord is a little shorter than its arc.
            prop_assert!((0.97..1.001).contains(&(bent / flat)), "{flat} became {bent}");
        }
    }

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
fn a_tube_narrower_than_the_body_starts_clear_of_it() {
    let (body, _) = woman();
    // 300 mm round: nobody's waist. The ring is the body's then, and the seams are what is left open.
    let made = tube(150.0);
    let x = made.placed(&body);
    let sections = trunk(&body);
    let nearest = |y: f64| sections.iter().min_by(|a, b| (a.0 - y).abs().total_cmp(&(b.0 - y).abs())).copied();
    for p in &x {
        let Some((y, center, half_width, half_depth)) = nearest(p.y) else { continue };
        if (y - p.y).abs() > 10.0 * MM {
            continue;
        }
        let d = p - center;
        let share = (d.x / half_width).hypot(d.z / half_depth);
        assert!(share > 1.03, "{p} is {share} of the section at {y}");
    }
    assert!(Stitching::new(&made.mesh).gaps(&x).iter().all(|&g| g > 100.0 * MM));
}

#[test]
fn a_piece_sewn_to_nothing_starts_round_its_part_all_the_same() {
    let made = Made::new(
        "garment: 1\nbody: woman_92\nfabrics: {shell: cotton_poplin}\npieces:\n  pocket:\n    place: hip front\n    \
         grain: [[10, 10], [10, 90]]\n    outline: {start: 0 0, a: L 150 0, b: L 150 160, c: L 0 160, d: L 0 0}\n\
         free: ['*.*']\n",
        20.0,
    );
    let (body, collider) = woman();
    let start = made.placed(&body);
    let far = |p: &Vec3| collider.nearest(*p, 1.0).map_or(f64::INFINITY, |n| n.distance);
    assert!(start.iter().all(|p| (0.0..0.2).contains(&far(p))), "{start:?}");
}

/// A front and a back of the hip, the back a copy of the front, sewn by these seams.
fn copied(words: [&str; 2], seams: &str) -> Result<Vec<Vec3>, PlaceError> {
    let [front, back] = words;
    let made = Made::new(
        &format!(
            "garment: 1\nbody: woman_92\nfabrics: {{shell: cotton_poplin}}\npieces:\n  one:\n    place: {front}\n    \
             grain: [[0, 50], [0, 250]]\n    \
             outline: {{start: -200 0, waist: L 200 0, right: L 290 300, hem: L -290 300, left: L -200 0}}\n  \
             other: {{like: one, place: {back}}}\nseams:\n{seams}free: ['*.waist', '*.hem']\n"
        ),
        20.0,
    );
    let (body, collider) = woman();
    place(&made.garment, &made.mesh, &body, &collider)
}

#[test]
fn seams_that_contradict_each_other_leave_a_piece_no_place() {
    let alike = "  left: {sew: one.right, to: other.right}\n  right: {sew: one.left, to: other.left}\n";
    let refused = copied(["hip", "hip"], alike);
    assert!(matches!(&refused, Err(PlaceError::Nowhere { .. })), "{refused:?}");
}

/// A back drawn as a front: its wearer's left is where the front's is on the drawing.
#[test]
fn pieces_that_meet_right_to_right_are_refused_by_their_seam() {
    let alike = "  side: {sew: one.right, to: other.right}\n  other: {sew: one.left, to: other.left}\n";
    let crossed = "  side: {sew: one.right, to: other.left}\n  other: {sew: one.left, to: other.right}\n";
    assert!(copied(["hip front", "hip back"], crossed).is_ok());
    for seams in [alike, "  side: {sew: one.right, to: other.right}\nfree: ['*.left', '*.waist', '*.hem']\n#"] {
        let Err(PlaceError::Sides { seam, piece, to, side }) = copied(["hip front", "hip back"], seams) else {
            panic!("sewn right to right: {seams}");
        };
        assert_eq!([&seam, &piece, &to, side], ["side", "one", "other", "right"]);
    }
    // A back so narrow that it could be a godet of the front, its sides slanting.
    let made = Made::new(
        "garment: 1\nbody: woman_92\nfabrics: {shell: cotton_poplin}\npieces:\n  front:\n    cut: fold center\n    \
         place: hip front\n    grain: [[60, 50], [60, 250]]\n    \
         outline: {start: 0 0, waist: L 330 0, seam: L 400 300, hem: L 0 300, center: L 0 0}\n  back:\n    \
         cut: fold center\n    place: hip back\n    grain: [[20, 50], [20, 250]]\n    \
         outline: {start: 0 0, waist: L 55 0, seam: L 125 300, hem: L 0 300, center: L 0 0}\nseams:\n  \
         side: {sew: front.seam, to: back.seam}\nfree: ['*.waist', '*.hem']\n",
        20.0,
    );
    let (body, collider) = woman();
    let refused = place(&made.garment, &made.mesh, &body, &collider);
    assert!(matches!(&refused, Err(PlaceError::Sides { .. })), "{refused:?}");
}

/// A panel set into a cut-out of the front meets it right to right of their boxes, but the cloth is on either side.
#[test]
fn a_panel_in_a_cut_out_is_not_refused() {
    let set_in = |right: &str, left: &str| {
        let made = Made::new(
            &format!(
                "garment: 1\nbody: woman_92\nfabrics: {{shell: cotton_poplin}}\npieces:\n  front:\n    \
                 place: hip front\n    grain: [[0, 250], [0, 290]]\n    outline: {{start: -200 0, waist: L 200 0, \
                 right: L 290 300, hem_r: L 170 300, in_r: L 170 60, top: L -170 60, in_l: L -170 300, \
                 hem_l: L -290 300, left: L -200 0}}\n  front_panel:\n    place: hip front\n    \
                 grain: [[0, 80], [0, 290]]\n    outline: {{start: -170 60, top: L 170 60, right: L 170 300, \
                 hem: L -170 300, left: L -170 60}}\n  back:\n    place: hip back\n    grain: [[0, 50], [0, 250]]\n    \
                 outline: {{start: -200 0, waist: L 200 0, right: L 290 300, hem: L -290 300, left: L -200 0}}\n\
                 seams:\n  r: {{sew: front.in_r, to: front_panel.{right}}}\n  \
                 l: {{sew: front.in_l, to: front_panel.{left}}}\n  side_l: {{sew: front.right, to: back.left}}\n  \
                 side_r: {{sew: front.left, to: back.right}}\nfree: ['*.*']\n"
            ),
            20.0,
        );
        let (body, collider) = woman();
        place(&made.garment, &made.mesh, &body, &collider)
    };
    assert!(!matches!(set_in("right", "left"), Err(PlaceError::Sides { .. })));
    assert!(matches!(set_in("left", "right"), Err(PlaceError::Sides { .. })));
}

#[test]
fn a_place_must_name_a_part_that_the_body_has() {
    let (mut body, collider) = woman();
    let text = "garment: 1\nbody: woman_92\nfabrics: {shell: cotton_poplin}\npieces:\n  cuff:\n    place: WHERE\n    \
                grain: [[10, 10], [10, 90]]\n    \
                outline: {start: 0 0, a: L 200 0, b: L 200 100, c: L 0 100, d: L 0 0}\nfree: ['*.*']\n";
    let somewhere = |words: &str| Made::new(&text.replace("WHERE", words), 20.0);
    let mut made = somewhere("left arm");
    // A file cannot say this; a garment built in code can.
    made.garment.pieces[0].place = Some(Place::Around { words: vec![PlaceWord::Left] });
    let refused = place(&made.garment, &made.mesh, &body, &collider);
    assert!(matches!(&refused, Err(PlaceError::Words { piece, .. }) if piece == "cuff"), "{refused:?}");
    let made = somewhere("left arm");
    assert!(place(&made.garment, &made.mesh, &body, &collider).is_ok());
    body.parts.retain(|p| p.kind != PartKind::LeftArm);
    let refused = place(&made.garment, &made.mesh, &body, &collider);
    assert!(matches!(&refused, Err(PlaceError::NoPart { part: "left arm", .. })), "{refused:?}");
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
    assert_eq!(world.x.len(), stitching.classes);
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
    let (steps, tangles) = settle(&mut world, Calm::TO_FALL).expect("settled");
    assert_eq!((steps, tangles), (1, 0));
    let moved = world.x.iter().zip(&nodes).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    assert!(moved < 1e-6, "{moved} m");
}

#[test]
fn springs_pull_a_stretched_sheet_true() {
    let (made, stitching, mut nodes) = sheet();
    let (_, collider) = woman();
    nodes.iter_mut().for_each(|p| p.x *= 1.02);
    let mut world = sewn_world(&made.cut(), &collider, &stitching, nodes).expect("a world");
    let before = world.energy();
    settle(&mut world, Calm::TO_FALL).expect("settled");
    let after = world.energy();
    assert!(after < 0.25 * before, "{before} J became {after} J");
    let width = |k: fn(f64, f64) -> f64, from: f64| world.x.iter().map(|p| p.x).fold(from, k);
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
    assert!(count(&world.x, &world.cloth.triangles) > 0, "nothing to lead out");
    let (steps, tangles) = settle(&mut world, Calm::TO_FALL).expect("settled");
    assert_eq!((tangles, count(&world.x, &world.cloth.triangles)), (0, 0), "after {steps} steps");
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
        let (_, tangles) = settle(&mut world, Calm::TO_FALL).expect("settled");
        let cloth = TriMesh { vertices: world.x.clone(), triangles: world.cloth.triangles.clone() };
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

/// Whatever its place, what nothing held began at the waist.
#[test]
fn a_band_for_the_bust_starts_there() {
    let (body, _) = woman();
    let text = "garment: 1\nbody: woman_92\nfabrics: {shell: jersey}\npieces:\n  front:\n    place: bust front\n    \
         grain: [[0, 50], [0, 150]]\n    \
         outline: {start: -220 0, top: L 220 0, left: L 220 200, hem: L -220 200, right: L -220 0}\n  \
         back: {like: front, place: bust back}\nseams:\n  a: {sew: front.left, to: back.right}\n  \
         b: {sew: front.right, to: back.left}\nfree: ['*.top', '*.hem']\n";
    let x = Made::new(text, 20.0).placed(&body);
    let top = x.iter().map(|p| p.y).fold(f64::MIN, f64::max);
    // Between the bust and the armpits, y: 1179 and 1242 in the mannequin's file.
    assert!((1.2..1.26).contains(&top), "begins at {top}");
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
