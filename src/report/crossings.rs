//! The findings of the independent checks on a surface in space: where it is inside a body, crosses it, or crosses
//! itself.

use super::schema::{ContactReport, Crossing};
use crate::geometry::{MM, TriMesh, Vec3};
use crate::verify::{crossings, crossings_between, inside};

/// The figures, and every crossing with its place.
#[derive(Clone, Debug, Default)]
pub struct CrossingsSeen {
    /// The figures.
    pub contact: ContactReport,
    /// One row for every two parts that cross, the busiest first.
    pub crossings: Vec<Crossing>,
}

/// Examines `cloth`, metres, and the closed `body` under it, if there is one. `part_of` names the part of every
/// triangle of the cloth. `written` maps a point to its coordinates in messages.
pub fn look<'a>(
    cloth: &TriMesh,
    body: Option<&TriMesh>,
    part_of: impl Fn(u32) -> &'a str,
    written: impl Fn(Vec3) -> Vec3,
) -> CrossingsSeen {
    let within = body.map(|body| inside(&cloth.vertices, body)).unwrap_or_default();
    let through_body = body.map(|body| crossings_between(cloth, body).cloth_triangles).unwrap_or_default();
    let through_cloth = crossings(cloth);
    let contact = ContactReport {
        inside_body: within.count(),
        deepest: within.deepest * MM,
        cloth_body_intersections: through_body.len(),
        cloth_cloth_intersections: through_cloth.len(),
    };
    let middle = |t: u32| written(cloth.corners(t as usize).iter().sum::<Vec3>() / 3.0);
    let mut rows = Vec::new();
    for t in through_body {
        add(&mut rows, part_of(t), None, middle(t));
    }
    for [t, u] in through_cloth {
        let (one, other) = (part_of(t).min(part_of(u)), part_of(t).max(part_of(u)));
        add(&mut rows, one, Some(other), middle(t));
    }
    rows.sort_by_key(|r: &Crossing| std::cmp::Reverse(r.pairs));
    CrossingsSeen { contact, crossings: rows }
}

/// Counts a crossing of `piece` with the piece `through`, or with the body. The first says where.
fn add(rows: &mut Vec<Crossing>, piece: &str, through: Option<&str>, at: Vec3) {
    match rows.iter_mut().find(|r| r.piece == piece && r.through.as_deref() == through) {
        Some(row) => row.pairs += 1,
        None => rows.push(Crossing {
            piece: piece.to_owned(),
            through: through.map(str::to_owned),
            pairs: 1,
            near: (at * MM).into(),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crossings_are_counted_by_the_parts_that_cross() {
        // Two upright triangles through one lying triangle, one of them of the same part.
        let upright = |x: f64| [Vec3::new(x, -1.0, 0.3), Vec3::new(x, 1.0, 0.3), Vec3::new(x, 0.0, 0.6)];
        let lying = [Vec3::new(-5.0, 0.0, -5.0), Vec3::new(5.0, 0.0, -5.0), Vec3::new(0.0, 0.0, 9.0)];
        let vertices = [lying, upright(0.1), upright(0.5)].concat();
        let cloth = TriMesh { vertices, triangles: vec![[0, 1, 2], [3, 4, 5], [6, 7, 8]] };
        let seen = look(&cloth, None, |t| if t == 2 { "sleeve" } else { "front" }, |p| p);
        assert_eq!(seen.contact.cloth_cloth_intersections, 2);
        let found: Vec<(&str, Option<&str>)> =
            seen.crossings.iter().map(|c| (c.piece.as_str(), c.through.as_deref())).collect();
        assert_eq!(found, [("front", Some("front")), ("front", Some("sleeve"))]);
    }
}
