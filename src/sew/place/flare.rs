//! Sectors of a circle (circle skirts, flounces) are laid out by radius and angle, as the cones they will be.
//!
//! ```text
//!      ╲ waist ╱               ────waist────
//!       ╲╰───╯╱                 ╲         ╱        a cone with its axis upright: what is r from the apex is
//!       ╱     ╲         ─▶       ╲       ╱         r·cos α down and r·φ round
//!      ╱ ╭───╮ ╲                ╱         ╲
//!      ╲╱ hem ╲╱               ─────hem─────
//! ```

use super::fold::Sheet;
use crate::geometry::{Path, Vec2};
use crate::mesh::ClothMesh;
use crate::pattern::{Garment, Piece, Place};

/// A piece that opens by less, radians, hangs well enough as it is drawn; 60°.
const WIDE: f64 = std::f64::consts::FRAC_PI_3;
/// A sector's straight sides reach over this share of its radii.
const SIDE: f64 = 0.6;
/// Waist and hem keep their distance from the apex: they rise or fall by no more than this share of their length.
const ROUND: f64 = 0.35;
/// Particles this far beyond a side, radians, still lie on it.
const BEYOND: f64 = 0.02;
/// The apex is above: cosine between the sector's middle and straight down.
const DOWN: f64 = 0.5;
/// Cloth that opens to more than this share of a full circle lies in waves; its ring is no longer than this.
const FLATTEST: f64 = 0.95;

/// A sector with its apex, in the flat piece.
#[derive(Clone, Copy, Debug)]
struct Sector {
    apex: Vec2,
    /// Angle of its middle from straight down, towards larger x.
    middle: f64,
    /// Half of its opening, radians.
    half: f64,
    /// Smallest and largest distance from the apex.
    radii: [f64; 2],
}

impl Sector {
    fn polar(&self, p: Vec2) -> (f64, f64) {
        let d = p - self.apex;
        (d.norm(), wrapped(d.x.atan2(d.y) - self.middle))
    }
}

/// Lays out every piece that is a sector. Pieces that are folded, pleated or stand free stay as they are.
pub(super) fn lay(garment: &Garment, mesh: &ClothMesh, sheet: &mut Sheet) {
    let sectors: Vec<Option<Sector>> = garment
        .pieces
        .iter()
        .zip(&mesh.pieces)
        .map(|(piece, part)| {
            let plain = part.particles.clone().all(|p| sheet.under[p] == 0.0 && sheet.flat[p] == mesh.flat[p]);
            let bent = !matches!(piece.place, Some(Place::At { .. }));
            let points = &mesh.flat[part.particles.clone()];
            (plain && bent).then(|| sector(piece, points)).flatten()
        })
        .collect();
    let openings = openings(mesh, &sectors);
    for (i, part) in mesh.pieces.iter().enumerate() {
        let Some(sector) = sectors[i] else { continue };
        let turns = openings[i] / std::f64::consts::TAU;
        let fall = (1.0 - turns.min(FLATTEST).powi(2)).sqrt();
        let widening = (FLATTEST / turns).min(1.0);
        for p in part.particles.clone() {
            let (r, angle) = sector.polar(mesh.flat[p]);
            let inner = sector.radii[0];
            sheet.straight[p] = Vec2::new(inner * angle, r);
            sheet.flat[p] = Vec2::new((inner + (r - inner) * widening) * angle, r * fall);
        }
    }
}

/// How far the sectors open together that are sewn to one another, for each.
fn openings(mesh: &ClothMesh, sectors: &[Option<Sector>]) -> Vec<f64> {
    let mut group: Vec<usize> = (0..sectors.len()).collect();
    let piece_of = |p: u32| mesh.pieces.iter().position(|m| m.particles.contains(&(p as usize)));
    let on_side =
        |p: u32, piece: usize| sectors[piece].is_some_and(|s| s.polar(mesh.flat[p as usize]).1.abs() > s.half - BEYOND);
    for seam in &mesh.seams {
        for [a, b] in &seam.pairs {
            let (Some(i), Some(j)) = (piece_of(*a), piece_of(*b)) else { continue };
            if group[i] != group[j] && on_side(*a, i) && on_side(*b, j) {
                let (keep, gone) = (group[i].min(group[j]), group[i].max(group[j]));
                group.iter_mut().filter(|g| **g == gone).for_each(|g| *g = keep);
            }
        }
    }
    let opening = |i: usize| sectors[i].map_or(0.0, |s| 2.0 * s.half);
    let together = |i: usize| (0..sectors.len()).filter(|&j| group[j] == group[i]).map(opening).sum();
    (0..sectors.len()).map(together).collect()
}

/// The sector that a piece is, if it is one and opens wide: two straight sides on lines through one point, and the
/// rest of the rim round that point.
fn sector(piece: &Piece, points: &[Vec2]) -> Option<Sector> {
    let rim = piece.loops.first()?;
    let sides: Vec<&Path> = rim.iter().map(|e| &e.path).filter(|p| p.is_straight()).collect();
    let pairs = (0..sides.len()).flat_map(|i| (i + 1..sides.len()).map(move |j| (i, j)));
    let mut found: Vec<Sector> = pairs
        .filter_map(|(i, j)| between(sides[i], sides[j], points))
        .filter(|s| is_round(s, rim.iter().map(|e| &e.path)))
        .collect();
    // Sides in several straight edges give the same sector several times; the widest has all of the piece.
    found.sort_by(|a, b| a.half.total_cmp(&b.half));
    found.pop()
}

/// The sector between two sides that holds all points.
fn between(one: &Path, other: &Path, points: &[Vec2]) -> Option<Sector> {
    let (a, b) = (one.end() - one.start(), other.end() - other.start());
    let cross = a.perp(&b);
    if cross.abs() < 1e-6 * a.norm() * b.norm() {
        return None;
    }
    let apex = one.start() + a * ((other.start() - one.start()).perp(&b) / cross);
    let outward = |p: &Path| {
        let d = p.point(0.5 * p.length()) - apex;
        d.x.atan2(d.y)
    };
    let ends = [outward(one), outward(other)];
    let radii = points
        .iter()
        .map(|p| (p - apex).norm())
        .fold([f64::INFINITY, 0.0], |r: [f64; 2], d| [r[0].min(d), r[1].max(d)]);
    let long = [one, other].iter().all(|p| p.length() >= SIDE * (radii[1] - radii[0]));
    let near = 0.5 * (ends[0] + ends[1]);
    [near, near + std::f64::consts::PI].into_iter().find_map(|middle| {
        let sector = Sector { apex, middle: wrapped(middle), half: wrapped(ends[0] - middle).abs(), radii };
        let holds = points.iter().all(|p| sector.polar(*p).1.abs() <= sector.half + BEYOND);
        (long && holds && 2.0 * sector.half >= WIDE && sector.middle.cos() >= DOWN && radii[0] > 0.0).then_some(sector)
    })
}

/// Whether what of the rim is no side goes round the apex.
fn is_round<'a>(sector: &Sector, rim: impl Iterator<Item = &'a Path>) -> bool {
    let (mut length, mut rise) = (0.0, 0.0);
    for path in rim {
        let points = path.sampled(1e-3);
        for step in points.windows(2) {
            let [(r0, f0), (r1, f1)] = [sector.polar(step[0]), sector.polar(step[1])];
            if f0.abs().min(f1.abs()) < sector.half - BEYOND {
                length += (step[1] - step[0]).norm();
                rise += (r1 - r0).abs();
            }
        }
    }
    length > 0.0 && rise <= ROUND * length
}

fn wrapped(angle: f64) -> f64 {
    let turned = angle.rem_euclid(std::f64::consts::TAU);
    if turned > std::f64::consts::PI { turned - std::f64::consts::TAU } else { turned }
}
