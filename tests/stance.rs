//! Bodies whose limbs nearly touch, and the stance in which garments are sewn on them.

use std::path::Path;

use toile::contact::Collider;
use toile::geometry::Vec3;
use toile::mannequin::{Mannequin, PartKind, library};
use toile::pipeline::{Job, Overrides, read};
use toile::sew::Stance;

/// Trousers over legs, and a shirt under arms, that almost touch.
const LEGS: &str = "tests/scenes/close_legs.yaml";
const ARMS: &str = "tests/scenes/close_arms.yaml";

/// A garment, on another body if one is asked for.
fn job(garment: &str, body: Option<&str>) -> Job {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let file = root.join(garment);
    // A name is one of the library's.
    let body = body.map(|b| if b.contains('.') { root.join(b).display().to_string() } else { b.to_owned() });
    let overrides = Overrides { spacing: Some(0.04), body, ..Overrides::default() };
    Job::new(&file, read(&file).expect(garment), &overrides).expect(garment)
}

/// The limbs that are spread for a job, in the order of their kinds.
fn limbs(job: &Job) -> Vec<PartKind> {
    let mut limbs: Vec<PartKind> = job.stance.iter().flat_map(Stance::limbs).collect();
    limbs.sort_unstable();
    limbs
}

/// How far the skin of the left leg, to the right of its axis, is from the nearest skin further right, metres, at
/// `share` of the way from the crotch to the ankle.
fn between_legs(body: &Mannequin, share: f64) -> f64 {
    let leg = body.part(PartKind::LeftLeg).expect("a leg");
    let inside = leg.sections[(share * (leg.sections.len() - 1) as f64) as usize].center;
    let collider = Collider::new(&body.mesh).expect("collider");
    let is_in = |x: f64| collider.nearest(Vec3::new(x, inside.y, inside.z), 0.5).is_some_and(|n| n.distance < 0.0);
    assert!(is_in(inside.x), "the leg's axis is in it");
    let steps = (0..).map(|k| inside.x - 1e-4 * f64::from(k));
    let skin = steps.clone().find(|x| !is_in(*x)).expect("an inner side");
    let other = steps.skip_while(|x| *x >= skin).find(|x| is_in(*x)).expect("the other leg");
    skin - other
}

#[test]
fn mannequins_that_stand_with_room_between_their_limbs_are_sewn_on_as_they_stand() {
    for name in library() {
        for garment in [LEGS, ARMS] {
            assert!(job(garment, Some(name)).stance.is_none(), "{garment} on {name}");
        }
    }
}

#[test]
fn limbs_that_almost_touch_are_spread_and_it_is_said() {
    let all = [PartKind::LeftArm, PartKind::RightArm, PartKind::LeftLeg, PartKind::RightLeg];
    let trousers = job(LEGS, None);
    assert_eq!(limbs(&trousers), all);
    assert!(trousers.notes.iter().any(|n| n.contains("left leg") && n.contains("apart")), "{:?}", trousers.notes);
}

#[test]
fn legs_are_spread_only_for_what_goes_between_them() {
    assert_eq!(limbs(&job(ARMS, None)), [PartKind::LeftArm, PartKind::RightArm]);
    let on = |garment: &str| limbs(&job(garment, Some("tests/scenes/close_limbs.obj")));
    assert_eq!(on("patterns/gore_skirt.yaml"), [PartKind::LeftArm, PartKind::RightArm]);
    // Its pieces go round the hip.
    assert!(on("patterns/trousers.yaml").contains(&PartKind::LeftLeg));
}

/// A tail of hair, 320 mm long, down the back of the head.
#[test]
fn what_hangs_down_and_is_no_limb_stays_and_takes_no_part_along() {
    let Job { mut body, garment, stance, .. } = job(ARMS, None);
    let without = stance.expect("narrow");
    let top = body.mesh.vertices.iter().map(|p| p.y).fold(0.0, f64::max);
    let root = body.mesh.triangles.iter().position(|t| {
        let [a, b, c] = t.map(|v| body.mesh.vertices[v as usize]);
        let middle = (a + b + c) / 3.0;
        middle.y > top - 0.1 && (b - a).cross(&(c - a)).z < 0.0
    });
    let [a, b, c] = body.mesh.triangles.swap_remove(root.expect("a back of the head"));
    let first = body.mesh.vertices.len() as u32;
    let [p, q, r] = [a, b, c].map(|v| body.mesh.vertices[v as usize]);
    // Out, and then down, as a tube of three sides with a lid.
    for down in [0.0, 0.32] {
        let along = Vec3::new(0.0, -down, -0.1);
        body.mesh.vertices.extend([p + along, q + along, r + along]);
    }
    let mut ring = [a, b, c];
    for k in 0..2 {
        let next = [0, 1, 2].map(|i| first + 3 * k + i);
        for i in 0..3 {
            let (j, [s, t]) = ((i + 1) % 3, [ring[i], next[i]]);
            body.mesh.triangles.extend([[s, ring[j], next[j]], [s, next[j], t]]);
        }
        ring = next;
    }
    body.mesh.triangles.push(ring);
    let with = Stance::of(&body, &garment).expect("narrow");
    assert_eq!(with.limbs().collect::<Vec<_>>(), without.limbs().collect::<Vec<_>>());
    assert_eq!(with.body.mesh.vertices[first as usize..], body.mesh.vertices[first as usize..]);
    for (with, without) in with.body.parts.iter().zip(&without.body.parts) {
        assert!(with.sections.iter().zip(&without.sections).all(|(a, b)| a.center == b.center));
    }
}

#[test]
fn spread_limbs_have_room_and_their_parts_are_in_them() {
    let trousers = job(LEGS, None);
    let stance = trousers.stance.as_ref().expect("narrow");
    for share in [0.2, 0.4] {
        let (own, apart) = (between_legs(&trousers.body, share), between_legs(&stance.body, share));
        // The 4 mm that a body is read with at its narrowest place, and what the legs part below it.
        assert!(own < 0.0065, "{own}");
        assert!(apart > 0.04, "{apart}");
    }
    for part in &stance.body.parts {
        let out = part.sections.iter().filter(|s| stance.collider.nearest(s.center, 0.5).expect("near").distance > 0.0);
        assert_eq!(out.count(), 0, "sections of the {} are outside", part.kind.name());
    }
}

#[test]
fn what_is_above_crotch_and_armpits_stays_and_nothing_changes_its_height() {
    let Job { body, stance, .. } = job(LEGS, None);
    let stance = stance.expect("narrow");
    let crotch = body.part(PartKind::Torso).and_then(|torso| torso.sections.first()).expect("a torso").center.y;
    for (own, apart) in body.mesh.vertices.iter().zip(&stance.body.mesh.vertices) {
        assert!(own.y == apart.y && own.z == apart.z);
        // No arm is so near to the middle.
        assert!(own.y < crotch || own.x.abs() > 0.1 || own.x == apart.x, "{own:?}");
    }
}

#[test]
fn an_object_has_no_limbs() {
    let Job { mut body, garment, .. } = job(LEGS, None);
    body.parts.clear();
    assert!(Stance::of(&body, &garment).is_none());
}
