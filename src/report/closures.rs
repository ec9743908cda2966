//! Gaps of closures at their points, and how far they gape between them.

use super::schema::ClosureReport;
use super::statistics::{largest, mean};
use crate::geometry::{Locator, MM, Vec2, Vec3};
use crate::mesh::ClothMesh;
use crate::pattern::{Closure, Fastening, Garment, fastenings};

/// Points further apart than this (metres) did not come together: about the length of a buttonhole.
pub(super) const APART: f64 = 0.02;

/// Between two points the sides are compared at so many places: ends and seven between, a centimetre apart for buttons
/// a hand's breadth apart.
const PLACES: usize = 8;

/// The closures' rows, and the fastenings that hold.
#[derive(Debug, Default)]
pub(super) struct Closures {
    pub(super) rows: Vec<ClosureReport>,
    pub(super) closed: Vec<Fastening>,
}

impl Closures {
    /// Measures every closure of a garment whose particles are `at`.
    pub(super) fn new(garment: &Garment, mesh: &ClothMesh, at: &[Vec3]) -> Self {
        if garment.closures.is_empty() {
            return Self::default();
        }
        let fastened = fastenings(garment);
        let cloth = PlacedGarment { mesh, at };
        let row = |(i, closure): (usize, &Closure)| {
            let own: Vec<&Fastening> = fastened.iter().filter(|f| f.tack[0] == i).collect();
            cloth.row(closure, &own)
        };
        let rows = garment.closures.iter().enumerate().map(row).collect();
        let held = |f: &Fastening| cloth.gap(&garment.closures[f.tack[0]].tacks[f.tack[1]]).is_some_and(|g| g <= APART);
        Self { rows, closed: fastened.iter().filter(|f| held(f)).cloned().collect() }
    }
}

/// The garment where it was left.
struct PlacedGarment<'a> {
    mesh: &'a ClothMesh,
    at: &'a [Vec3],
}

impl PlacedGarment<'_> {
    fn row(&self, closure: &Closure, fastened: &[&Fastening]) -> ClosureReport {
        let assumed = closure.tacks.is_empty() && !closure.mirrored.is_empty();
        let pairs = if assumed { &closure.mirrored } else { &closure.tacks };
        let gaps: Vec<f64> = pairs.iter().filter_map(|pair| self.gap(pair)).collect();
        let met = pairs.first().and_then(|pair| self.mesh.pieces.get(pair[1].0)).map(|p| p.name.clone());
        let measured = !gaps.is_empty();
        let neighbours = fastened.windows(2).filter(|w| w[0].row == w[1].row);
        let between = neighbours.flat_map(|w| self.between([w[0], w[1]].map(|f| &closure.tacks[f.tack[1]])));
        ClosureReport {
            kind: closure.kind.clone(),
            on: closure.on.clone(),
            meets: closure.meets.clone().or(met),
            points: pairs.len(),
            gap_mean: measured.then(|| mean(&gaps) * MM),
            gap_max: measured.then(|| largest(&gaps) * MM),
            gape: between.reduce(f64::max).map(|x| x * MM),
            closed: measured && !assumed && gaps.iter().all(|&g| g <= APART),
            note: note(closure, assumed),
            turned: None,
        }
    }

    /// Distance of the particles that a tack ties.
    fn gap(&self, pair: &[(usize, Vec2); 2]) -> Option<f64> {
        let [a, b] = pair.map(|(piece, p)| self.mesh.nearest(piece, p).and_then(|p| self.at.get(p)));
        Some((a? - b?).norm())
    }

    /// Distances of the lines from one point to the next on both sides.
    fn between(&self, ends: [&[(usize, Vec2); 2]; 2]) -> Vec<f64> {
        let side = |side: usize| -> Option<Vec<Vec3>> {
            let [(piece, from), (_, to)] = ends.map(|tack| tack[side]);
            let triangles = &self.mesh.triangles[self.mesh.pieces.get(piece)?.triangles.clone()];
            let locator = Locator::new(&self.mesh.flat, triangles, self.mesh.spacing);
            let place = |k: usize| {
                let (corners, shares) = locator.place(from + (to - from) * (k as f64 / PLACES as f64));
                corners.iter().zip(shares).map(|(&c, share)| self.at[c as usize] * share).sum()
            };
            Some((0..=PLACES).map(place).collect())
        };
        let Some((a, b)) = side(0).zip(side(1)) else { return Vec::new() };
        a.iter().zip(&b).map(|(a, b)| (a - b).norm()).collect()
    }
}

impl ClosureReport {
    /// `button on front.L`.
    pub fn title(&self) -> String {
        let on = self.on.as_ref().map(|piece| format!(" on {piece}"));
        self.kind.clone() + &on.unwrap_or_default()
    }

    /// Message that its points did not come together, with a remedy. `None` if they did, or if it has none.
    pub fn unclosed(&self) -> Option<String> {
        let (far, most) = (self.gap_max?, APART * MM);
        if far <= most {
            return None;
        }
        let meets = self.meets.as_deref().unwrap_or("what it meets");
        let apart = format!("its points are up to {far:.1} mm from those of {meets} (closed: {most} mm or less)");
        let remedy = self.note.clone().unwrap_or_else(|| {
            "check that 'at' and 'meets_at' lie opposite each other, and that the garment is wide enough there"
                .to_owned()
        });
        Some(format!("the {} does not close: {apart}; {remedy}", self.title()))
    }
}

/// Why a closure does not say all it should.
fn note(closure: &Closure, assumed: bool) -> Option<String> {
    let text = if assumed {
        "'meets' is not given: measured to the other half, not tied"
    } else if closure.on.is_none() {
        "neither 'piece', 'edge' nor 'on' is given: nothing is tied"
    } else if closure.meets.is_none() {
        "'meets' is not given, and it is not clear what it meets: nothing is tied"
    } else if closure.tacks.is_empty() {
        "no points are given ('at'): nothing is tied"
    } else {
        return None;
    };
    Some(text.to_owned())
}
