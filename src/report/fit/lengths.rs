//! Lengths as worn: hems above the floor, sleeves against wrists, the crotch.

use super::{WornLength, mm};
use crate::geometry::Vec3;
use crate::mannequin::{Mannequin, PartKind};
use crate::report::schema::Worn;
use crate::verify::Welded;

/// Parts that a hem may be round, in the order in which they decide: of a skirt's two openings the one round the legs
/// is the hem.
const HEMS: [&str; 4] = ["legs", "left leg", "right leg", "torso"];

/// Where the openings are: hems above the floor, those of sleeves and legs also against wrists and ankles.
pub(super) fn openings(worn: &[Worn], body: &Mannequin) -> Vec<WornLength> {
    let hems = hems(worn);
    let mut out = Vec::new();
    for (k, opening) in worn.iter().enumerate() {
        let name = opening.opening.clone();
        if hems.contains(&k) && body.floor().is_some() {
            let (against, level) = ("floor".into(), Some(opening.level));
            out.push(WornLength { name: name.clone(), value: opening.height, against, level });
        }
        if let (Some(past), Some(part)) = (opening.past_end, &opening.body_part) {
            let end = |limb: &str, end: &str| part.strip_suffix(limb).map(|side| format!("{side}{end}"));
            let against = end("arm", "wrist").or_else(|| end("leg", "ankle")).unwrap_or_else(|| part.clone());
            out.push(WornLength { name, value: past, against, level: None });
        }
    }
    out
}

/// Which of the openings are hems: those round the legs, else the lowest round the trunk.
pub(in crate::report) fn hems(worn: &[Worn]) -> Vec<usize> {
    let round = |part: &str| -> Vec<usize> {
        (0..worn.len()).filter(|&k| worn[k].body_part.as_deref() == Some(part)).collect()
    };
    let [legs, left, right, torso] = HEMS.map(round);
    let lower = [legs, left, right].concat();
    if lower.is_empty() {
        return torso.into_iter().min_by(|&a, &b| worn[a].height.total_cmp(&worn[b].height)).into_iter().collect();
    }
    lower
}

/// How far the crotch of a garment with two legs is above that of the body: both where the plane through the middle of
/// the body cuts them lowest.
pub(super) fn crotch(welded: &Welded, worn: &[Worn], body: &Mannequin) -> Option<WornLength> {
    let has = |part: &str| worn.iter().any(|w| w.body_part.as_deref() == Some(part));
    let torso = body.part(PartKind::Torso).filter(|_| has("left leg") && has("right leg"))?;
    let middle = torso.landmarks.iter().find(|(name, _)| name == "crotch")?.1;
    let low = |surface: &crate::geometry::TriMesh| {
        let edges = surface.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let cut = edges.filter_map(|ends| {
            let [p, q]: [Vec3; 2] = ends.map(|v| surface.vertices[v as usize]);
            let (s, t) = (p.x - middle.x, q.x - middle.x);
            ((s < 0.0) != (t < 0.0)).then(|| p.lerp(&q, s / (s - t)).y)
        });
        cut.reduce(f64::min)
    };
    let value = mm(low(&welded.surface)? - low(&body.mesh)?);
    Some(WornLength { name: "crotch".into(), value, against: "crotch".into(), level: None })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn opening(part: &str, height: f64) -> Worn {
        Worn { opening: part.into(), body_part: Some(part.into()), height, ..Worn::default() }
    }

    #[test]
    fn a_hem_is_round_the_legs_or_else_lowest_round_the_trunk() {
        let skirt = [opening("torso", 1000.0), opening("legs", 400.0)];
        assert_eq!(hems(&skirt), [1]);
        let shirt = [opening("neck", 1400.0), opening("torso", 700.0), opening("left arm", 1000.0)];
        assert_eq!(hems(&shirt), [1]);
        let trousers = [opening("torso", 1000.0), opening("left leg", 90.0), opening("right leg", 90.0)];
        assert_eq!(hems(&trousers), [1, 2]);
        assert_eq!(hems(&[opening("torso", 900.0), opening("torso", 600.0)]), [1]);
        assert_eq!(hems(&[opening("neck", 900.0)]), [0; 0]);
    }
}
