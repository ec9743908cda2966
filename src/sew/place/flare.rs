//! Sectors of a circle (circle skirts, flounces) are laid out by radius and angle, as the cones they will be; what
//! opens to nearly a full circle or more lies in waves.
//!
//! ```text
//!      ╲ waist ╱               ────waist────
//!       ╲╰───╯╱                 ╲         ╱        a cone with its axis upright: what is r from the apex is
//!       ╱     ╲         ─▶       ╲       ╱         r·cos α down and r·φ round
//!      ╱ ╭───╮ ╲                ╱         ╲
//!      ╲╱ hem ╲╱               ─────hem─────
//! ```

use std::f64::consts::TAU;

use super::assign::is_skirt;
use super::flute::{self, Flutes};
use super::fold::FoldedPieces;
use crate::geometry::{Path, Vec2};
use crate::mesh::ClothMesh;
use crate::pattern::Garment;

/// A piece that opens by less, radians, hangs well enough as it is drawn; 60°.
const WIDE: f64 = std::f64::consts::FRAC_PI_3;
/// A sector's straight sides reach over this share of its radii.
const SIDE: f64 = 0.6;
/// The two sides of a sector count as equally long if the shorter is at least this share of the longer.
const ALIKE: f64 = 0.9;
/// Share of the radii that equal sides reach over at least, the hem dipping between them. Shoulders of the shortest top
/// reach over less.
const DIPPED: f64 = 0.5;
/// A skirt has no shoulders: short in front and long behind, the sides of about half a circle reach over this share at
/// least.
const SKIRT: f64 = 0.25;
/// It opens by this much at least, radians; 150°. (Slits for godets open by less.)
const HALF_CIRCLE: f64 = 2.6;
/// The waist keeps its distance from the apex: it rises or falls by no more than this share of its length. (The hem may
/// dip as it likes.)
const ROUND: f64 = 0.35;
/// It is looked at in so many directions, at points of the rim so far apart, metres.
const DIRECTIONS: usize = 90;
const SAMPLED: f64 = 1e-3;
/// There is cloth in this share of these directions at least. (The legs of a dart point at an apex metres away. Nearly
/// all round it is the outside of the angle between them: there all of the piece is, in one direction.)
const FILLED: f64 = 0.9;
/// Sides that differ by less from one line, radians, are one: of half a ring, whose apex is in their middle.
const IN_LINE: f64 = 0.01;
/// Particles this far beyond a side, radians, still lie on it.
const BEYOND: f64 = 0.02;
/// The apex is above: cosine between the sector's middle and straight down.
const DOWN: f64 = 0.5;
/// Cloth that opens to more than this share of a full circle lies in waves: a cone would be flatter than cloth hangs.
const WAVY: f64 = 0.65;
/// A piece of another layer that has at least this share of a sector's triangles may lie all over it.
const COVER: f64 = 0.5;
/// Between these shares of its way from the smallest to the largest radius a seam is neither at a sector's waist nor at
/// its hem.
const WAIST: f64 = 0.3;
const HEM: f64 = 0.7;
/// The cone such cloth lies on widens by this share of its side, or by more if the waves would be too steep.
const CONE: f64 = 0.6;
/// A cone never widens by more than this share of its side.
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
pub(super) fn lay(garment: &Garment, mesh: &ClothMesh, sheet: &mut FoldedPieces) {
    let sectors: Vec<Option<Sector>> = garment
        .pieces
        .iter()
        .zip(&mesh.pieces)
        .map(|(piece, part)| {
            let plain = part.particles.clone().all(|p| sheet.under[p] == 0.0 && sheet.flat[p] == mesh.flat[p]);
            let bent = !piece.has_position();
            let points = &mesh.flat[part.particles.clone()];
            let rim: Vec<&Path> = piece.loops.first().into_iter().flatten().map(|e| &e.path).collect();
            (plain && bent).then(|| sector(&rim, points, is_skirt(piece))).flatten()
        })
        .collect();
    let openings = openings(mesh, &sectors);
    for (i, part) in mesh.pieces.iter().enumerate() {
        let Some(sector) = sectors[i] else { continue };
        let cone = Cone::new(&sector, openings[i], is_free(garment, mesh, i, &sector));
        for p in part.particles.clone() {
            let (r, angle) = sector.polar(mesh.flat[p]);
            sheet.straight[p] = Vec2::new(sector.radii[0] * angle, r);
            (sheet.flat[p], sheet.out[p]) = cone.lay(r, angle);
        }
    }
}

/// Whether nothing is in the way of a sector's waves: no piece of a size with it lies over it, which they would stand
/// in, and nothing is sewn into it between waist and hem, which would start off them.
fn is_free(garment: &Garment, mesh: &ClothMesh, i: usize, sector: &Sector) -> bool {
    let size = |piece: usize| mesh.pieces[piece].triangles.len() as f64;
    let covered =
        |other: usize| garment.pieces[other].level() > garment.pieces[i].level() && size(other) > COVER * size(i);
    let [inner, outer] = sector.radii;
    let within = |p: u32| {
        let (r, angle) = sector.polar(mesh.flat[p as usize]);
        let share = (r - inner) / (outer - inner);
        mesh.piece_of(p) == Some(i) && angle.abs() < sector.half - BEYOND && (WAIST..HEM).contains(&share)
    };
    !(0..mesh.pieces.len()).any(covered)
        && !mesh.seams.iter().flat_map(|s| s.pairs.iter().flatten()).any(|p| within(*p))
}

/// The cone that a sector becomes.
struct Cone {
    inner: f64,
    /// How far all its sectors open, radians.
    opening: f64,
    /// By how much of its side it widens.
    slope: f64,
    /// From one side of the sector to the middle.
    half: f64,
    /// Its waves, and how wide one of them is, radians.
    waves: Option<(Flutes, f64)>,
}

impl Cone {
    /// Of a sector that is `free` to lie in waves.
    fn new(sector: &Sector, opening: f64, free: bool) -> Self {
        let turns = opening / TAU;
        let wavy = turns > WAVY && free;
        let slope = if wavy { CONE.max(flute::shortest() * turns) } else { turns };
        let slope = slope.min(FLATTEST);
        let (half, inner) = (sector.half, sector.radii[0]);
        let waves = wavy.then(|| {
            // Whole waves, so that both sides end in crests, as the sectors beside it do.
            let wave = 2.0 * half / flute::waves(2.0 * half);
            (Flutes::new(sector.radii, opening, slope, wave), wave)
        });
        Self { inner, opening, slope, half, waves }
    }

    /// Where a point of the sector lies on its ring, and how far off it.
    fn lay(&self, r: f64, angle: f64) -> (Vec2, f64) {
        let fall = (1.0 - self.slope * self.slope).sqrt();
        let Some((flutes, wave)) = &self.waves else {
            let widening = (self.slope * TAU / self.opening).min(1.0);
            return (Vec2::new((self.inner + (r - self.inner) * widening) * angle, r * fall), 0.0);
        };
        let lies = flutes.at(r, (angle + self.half) / wave);
        // The ring's radius at the waist is that of the cloth's own length.
        let round = self.inner + lies.wider * TAU / self.opening;
        (Vec2::new(round * (angle + lies.ahead * wave), self.inner * fall + lies.down), lies.out)
    }
}

/// How far the sectors open together that are sewn to one another, for each.
fn openings(mesh: &ClothMesh, sectors: &[Option<Sector>]) -> Vec<f64> {
    let mut group: Vec<usize> = (0..sectors.len()).collect();
    let on_side =
        |p: u32, piece: usize| sectors[piece].is_some_and(|s| s.polar(mesh.flat[p as usize]).1.abs() > s.half - BEYOND);
    for seam in &mesh.seams {
        for [a, b] in &seam.pairs {
            let (Some(i), Some(j)) = (mesh.piece_of(*a), mesh.piece_of(*b)) else { continue };
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
fn sector(rim: &[&Path], points: &[Vec2], skirt: bool) -> Option<Sector> {
    let sides: Vec<&Path> = rim.iter().copied().filter(|p| p.is_straight()).collect();
    let pairs = (0..sides.len()).flat_map(|i| (i + 1..sides.len()).map(move |j| (i, j)));
    let mut found: Vec<Sector> = pairs
        .filter_map(|(i, j)| {
            let sector = between(sides[i], sides[j], points, skirt)?;
            is_round(&sector, rim.iter().copied()).then_some(sector)
        })
        .collect();
    // Sides in several straight edges give the same sector several times; the widest has all of the piece.
    found.sort_by(|a, b| a.half.total_cmp(&b.half));
    found.pop()
}

/// The sector between two sides that holds all points.
fn between(one: &Path, other: &Path, points: &[Vec2], skirt: bool) -> Option<Sector> {
    let apex = apex(one, other)?;
    let outward = |p: &Path| {
        let d = p.point(0.5 * p.length()) - apex;
        d.x.atan2(d.y)
    };
    let ends = [outward(one), outward(other)];
    let radii = points
        .iter()
        .map(|p| (p - apex).norm())
        .fold([f64::INFINITY, 0.0], |r: [f64; 2], d| [r[0].min(d), r[1].max(d)]);
    let lengths = [one.length(), other.length()];
    let (least, most) = (lengths[0].min(lengths[1]), lengths[0].max(lengths[1]));
    let near = 0.5 * (ends[0] + ends[1]);
    [near, near + std::f64::consts::PI].into_iter().find_map(|middle| {
        let sector = Sector { apex, middle: wrapped(middle), half: wrapped(ends[0] - middle).abs(), radii };
        let holds = points.iter().all(|p| sector.polar(*p).1.abs() <= sector.half + BEYOND);
        let share = if least < ALIKE * most {
            SIDE
        } else if skirt && 2.0 * sector.half >= HALF_CIRCLE {
            SKIRT
        } else {
            DIPPED
        };
        let long = least >= share * (radii[1] - radii[0]);
        (long && holds && 2.0 * sector.half >= WIDE && sector.middle.cos() >= DOWN && radii[0] > 0.0).then_some(sector)
    })
}

/// Where the lines of two sides meet; for sides on one line, half way between them.
fn apex(one: &Path, other: &Path) -> Option<Vec2> {
    let (a, b) = (one.end() - one.start(), other.end() - other.start());
    let cross = a.perp(&b);
    if cross.abs() > IN_LINE * a.norm() * b.norm() {
        return Some(one.start() + a * ((other.start() - one.start()).perp(&b) / cross));
    }
    let middle = |p: &Path| p.point(0.5 * p.length());
    let between = middle(other) - middle(one);
    if a.perp(&between).abs() > IN_LINE * a.norm() * between.norm() {
        return None;
    }
    let near = |p: &Path, to: Vec2| if (p.start() - to).norm() < (p.end() - to).norm() { p.start() } else { p.end() };
    Some(0.5 * (near(one, middle(other)) + near(other, middle(one))))
}

/// Whether the waist, what of the rim is nearest to the apex in every direction, goes round the apex. (Slits may cut
/// deep into the hem.)
fn is_round<'a>(sector: &Sector, rim: impl Iterator<Item = &'a Path>) -> bool {
    let mut nearest = [f64::INFINITY; DIRECTIONS];
    for path in rim {
        for point in along(&path.sampled(SAMPLED)) {
            let (r, angle) = sector.polar(point);
            if angle.abs() < sector.half - BEYOND {
                let direction = (0.5 * (angle / sector.half + 1.0) * DIRECTIONS as f64) as usize;
                nearest[direction] = nearest[direction].min(r);
            }
        }
    }
    let waist: Vec<f64> = nearest.into_iter().filter(|r| r.is_finite()).collect();
    let turn = 2.0 * sector.half / DIRECTIONS as f64;
    let (mut length, mut rise) = (0.0, 0.0);
    for step in waist.windows(2) {
        let up = (step[1] - step[0]).abs();
        rise += up;
        length += up.hypot(0.5 * (step[0] + step[1]) * turn);
    }
    waist.len() as f64 >= FILLED * DIRECTIONS as f64 && rise <= ROUND * length
}

/// Points along a line of straight pieces, none further apart than [`SAMPLED`].
fn along(line: &[Vec2]) -> impl Iterator<Item = Vec2> + '_ {
    line.windows(2).flat_map(|ends| {
        let count = ((ends[1] - ends[0]).norm() / SAMPLED).ceil().max(1.0);
        (0..=count as usize).map(move |k| ends[0].lerp(&ends[1], k as f64 / count))
    })
}

fn wrapped(angle: f64) -> f64 {
    let turned = angle.rem_euclid(TAU);
    if turned > std::f64::consts::PI { turned - TAU } else { turned }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The sector of an outline in millimetres, begun with `M`, an edge per command.
    fn found(edges: &[&str]) -> Option<Sector> {
        sector_of(edges, false)
    }

    fn sector_of(edges: &[&str], skirt: bool) -> Option<Sector> {
        let mut paths: Vec<Path> = Vec::new();
        for edge in edges {
            let path = match paths.last() {
                None => Path::parse_absolute(edge, 1e-3),
                Some(last) => Path::parse(last.end() * 1e3, edge, 1e-3),
            };
            paths.push(path.expect("a path"));
        }
        let points: Vec<Vec2> = paths.iter().flat_map(|p| p.sampled(1e-4)).collect();
        sector(&paths.iter().collect::<Vec<&Path>>(), &points, skirt)
    }

    #[test]
    fn a_half_ring_has_its_apex_between_its_sides() {
        let half = found(&["M 400 0 L 480 0", "A 480 480 0 0 1 -480 0", "L -400 0", "A 400 400 0 0 0 400 0"]);
        let half = half.expect("a sector");
        assert!(half.apex.norm() < 1e-9 && (2.0 * half.half - std::f64::consts::PI).abs() < 1e-9, "{half:?}");
        assert!((half.radii[0] - 0.4).abs() < 1e-6 && (half.radii[1] - 0.48).abs() < 1e-6);
    }

    #[test]
    fn the_back_of_a_skirt_may_be_longer_than_its_sides_by_far() {
        // Half of an asymmetric circle skirt: sides of 130 mm, 270 mm long in the middle.
        let back = ["M 7 0 L 137 0", "A 300 300 0 1 1 -417 0", "L -287 0", "A 147 147 0 0 0 7 0"];
        let skirt = sector_of(&back, true).expect("a sector");
        assert!((skirt.apex - Vec2::new(-0.14, 0.0)).norm() < 1e-3 && skirt.radii[1] > 0.4, "{skirt:?}");
        assert!(sector_of(&back, false).is_none(), "shoulders may be as long");
    }

    #[test]
    fn the_legs_of_a_dart_are_no_sides() {
        let legs = ["L 59 157", "L 61 0", "L 223 0", "L 225 157", "L 227 0", "L 362 0"];
        let sides = ["Q 384 100 384 196", "Q 384 267 292 444", "L -8 444", "Q -100 267 -100 196", "Q -100 97 -78 0"];
        let front = [&["M -78 0 L 57 0"], &legs[..], &sides].concat();
        assert!(sector_of(&front, true).is_none(), "{:?}", sector_of(&front, true));
    }

    #[test]
    fn a_hem_may_dip_and_a_waist_may_not() {
        let quarter = |hem: &str| found(&["M 100 100 L 300 300", hem, "L -100 100", "A 142 142 0 0 0 100 100"]);
        assert!(quarter("A 425 425 0 0 1 -300 300").is_some());
        let dipped = quarter("C 260 600, -260 600, -300 300").expect("a sector");
        assert!(dipped.apex.norm() < 1e-9 && dipped.radii[1] > 0.5, "{dipped:?}");
        // A slit does not touch the waist.
        let slit =
            ["M 100 100 L 300 300", "A 425 425 0 0 1 10 424", "L 0 160", "L -10 424", "A 425 425 0 0 1 -300 300"];
        assert!(found(&[&slit[..], &["L -100 100", "A 142 142 0 0 0 100 100"]].concat()).is_some());
        // A front's shoulder and middle are no sides of a skirt, though everything is between their lines.
        let front = [
            "M 0 640 L 0 60",
            "C 30 60, 45 40, 54 0",
            "L 142 32",
            "C 125 90, 130 150, 180 160",
            "L 230 640",
            "L 0 640",
        ];
        assert!(found(&front).is_none());
        let waist = found(&["M 100 100 L 300 300", "A 425 425 0 0 1 -300 300", "L -100 100", "L 0 330", "L 100 100"]);
        assert!(waist.is_none(), "{waist:?}");
    }
}
