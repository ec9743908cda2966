//! Fullness: a piece slashed several times from one edge to another, each slash opened alike.

use super::sheet::AlteredPiece;
use super::{Fault, name, open};
use crate::geometry::MM;
use crate::pattern::{GarmentFile, Located, Problem, Quantity, Unit};

/// Distance of the slashes along the edge where their number is not said, metres: wider wedges show as corners.
const APART: f64 = 0.05;
/// Most slashes.
const MOST: usize = 100;

/// Cloth that is added between two edges of a piece.
pub(super) struct Fullness<'f> {
    /// The edge that becomes longer by `by`.
    pub(super) edge: &'f Located<String>,
    /// The edge across, which becomes longer by `to_by`.
    pub(super) to: &'f Located<String>,
    pub(super) by: &'f Located<Quantity>,
    pub(super) to_by: Option<&'f Located<Quantity>>,
    pub(super) slashes: Option<&'f Located<usize>>,
}

impl Fullness<'_> {
    /// Carries it out. Slashes go from equal shares of one edge to those of the other.
    pub(super) fn apply(&self, file: &mut GarmentFile) -> Result<(), Fault> {
        let (index, sheet, edge) = name::edge(file, self.edge, false)?;
        let (other, _, across) = name::edge(file, self.to, false)?;
        if index != other {
            let [one, other] = [index, other].map(|i| file.pieces[i].name.value.clone());
            return Err((self.to.at, Problem::AlterTwoPieces { what: "fullness", one, other }));
        }
        if edge == across {
            let reason = "fullness goes from one edge to another one".to_owned();
            return Err((self.to.at, Problem::AlterShape { piece: sheet.piece, reason }));
        }
        let count = self.count(&sheet, edge)?;
        let unit = sheet.unit;
        let [by, to_by] = [Some(self.by), self.to_by].map(|q| q.map_or(0.0, |q| q.value.value(unit) / count as f64));
        let [long, wide] = [edge, across].map(|e| sheet.edges[e].length());
        let amount = |metres: f64, at| Located::new(millimetres(metres), at);
        // From the far end of the first edge, so that places before a slash stay. On the other edge, which runs the
        // other way, openings push the places behind them on.
        for k in (0..count).rev() {
            let share = (k as f64 + 0.5) / count as f64;
            let pushed = to_by * (count - 1 - k) as f64;
            let [from, to] = [(self.edge, share * long), (self.to, (1.0 - share) * wide + pushed)]
                .map(|(edge, s)| Located::new(format!("{}@{:.7} mm", edge.value, s * MM), edge.at));
            let to_by = self.to_by.map(|q| amount(to_by, q.at));
            open::spread(file, [&from, &to], &amount(by, self.by.at), to_by.as_ref())?;
        }
        Ok(())
    }

    fn count(&self, sheet: &AlteredPiece, edge: usize) -> Result<usize, Fault> {
        let usual = (sheet.edges[edge].length() / APART).round().clamp(1.0, MOST as f64) as usize;
        match self.slashes {
            Some(n) if !(1..=MOST).contains(&n.value) => {
                let (what, expected) = ("slashes".to_owned(), "1 to 100");
                Err((n.at, Problem::OutOfRange { what, expected, found: n.value.to_string() }))
            }
            Some(n) => Ok(n.value),
            None => Ok(usual),
        }
    }
}

fn millimetres(metres: f64) -> Quantity {
    Quantity { number: metres * MM, unit: Some(Unit::Millimetre) }
}
