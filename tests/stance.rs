//! Bodies whose limbs nearly touch, and the stance in which garments are sewn on them.

use std::path::Path;

use toile::contact::Collider;
use toile::geometry::Vec3;
use toile::io::body::load_body;
use toile::mannequin::{Mannequin, PartKind, library, load};
use toile::sew::Stance;

/// The body of the scenes, with its legs and arms almost together.
fn close_limbs() -> Mannequin {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes/close_limbs.obj");
    load_body(&file.display().to_string()).expect("a body").mannequin
}

/// How far the skin of the left leg, to the right of its axis, is from the nearest skin further right, metres, at `share`
/// of the way from the crotch to the ankle.
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
        assert!(Stance::of(&load(name).expect(name)).is_none(), "{name}");
    }
}

#[test]
fn limbs_that_almost_touch_are_spread_and_the_parts_with_them() {
    let body = close_limbs();
    let stance = Stance::of(&body).expect("narrow");
    let mut limbs: Vec<PartKind> = stance.limbs().collect();
    limbs.sort_unstable();
    assert_eq!(limbs, [PartKind::LeftArm, PartKind::RightArm, PartKind::LeftLeg, PartKind::RightLeg]);
    for share in [0.2, 0.4] {
        let (own, apart) = (between_legs(&body, share), between_legs(&stance.body, share));
        assert!(own < 0.006, "{own}");
        assert!(apart > 0.04, "{apart}");
    }
    for part in &stance.body.parts {
        let out = part.sections.iter().filter(|s| stance.collider.nearest(s.center, 0.5).expect("near").distance > 0.0);
        assert_eq!(out.count(), 0, "sections of the {} are outside", part.kind.name());
    }
}

#[test]
fn what_is_above_crotch_and_armpits_stays_and_nothing_changes_its_height() {
    let body = close_limbs();
    let stance = Stance::of(&body).expect("narrow");
    let shoulder = body.part(PartKind::Torso).and_then(|torso| torso.sections.last()).expect("a torso").center.y;
    for (own, apart) in body.mesh.vertices.iter().zip(&stance.body.mesh.vertices) {
        assert!(own.y == apart.y && own.z == apart.z);
        assert!(own.y < shoulder || own.x == apart.x, "{own:?}");
    }
}

#[test]
fn an_object_has_no_limbs() {
    let mut body = close_limbs();
    body.parts.clear();
    assert!(Stance::of(&body).is_none());
}
