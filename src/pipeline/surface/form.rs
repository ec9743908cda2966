//! The surface as the form that its garment is sewn on: its rims closed, and every piece placed beside it.

use nalgebra::Rotation3;

use super::FlatSurface;
use super::mend::{AT_ONE_PLACE, Weld};
use crate::geometry::{MM, Mat3, TriMesh, Vec3, rim_loops};
use crate::io::obj_text::ObjText;
use crate::pattern::PlaceFile;

/// A closed surface is a form where it has this share of a ball's volume, squared, as 36π V² / S³: a flat panel closed
/// over its rim has next to none, and a tube twenty times as long as it is thick a fifth.
const SOLID: f64 = 0.02;
/// Clearance of a piece at its start from what it is of, metres.
const BESIDE: f64 = 5e-3;
/// Decimals of a millimetre, and of a degree.
const DECIMALS: f64 = 1e4;

/// A surface as a body.
pub(in crate::pipeline) struct ClosedForm {
    /// Outward.
    pub(super) mesh: TriMesh,
    /// Whether the file's faces show inward.
    pub(super) inward: bool,
}

impl FlatSurface {
    /// The whole surface without its cuts, its rims closed by triangles round their centres. `None` where it is of
    /// several pieces, has one side, or has hardly an inside.
    pub(super) fn form(&self) -> Option<ClosedForm> {
        let mut whole = self.sheet.read_as(false, self.sheet.welded_within(Weld::Within(AT_ONE_PLACE)));
        whole.join_groups();
        let mut parts = whole.parts();
        if parts.len() != 1 {
            return None;
        }
        let part = parts.swap_remove(0);
        part.turned.as_ref()?;
        let mut form = part.surface;
        for rim in rim_loops(&form.triangles) {
            form.fill(&rim);
        }
        let volume = form.signed_volume();
        if volume < 0.0 {
            form.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        let ball = 36.0 * std::f64::consts::PI * volume * volume;
        // Parts run the other way round than the file's faces, to be drawn with y down as they are seen.
        (ball > SOLID * form.area().powi(3)).then_some(ClosedForm { mesh: form, inward: volume > 0.0 })
    }

    /// The place of a piece: flat, turned as lies nearest to what it is of, and outside of it, which is behind its
    /// faces where these show `inward`.
    pub(super) fn place_of(&self, piece: usize, inward: bool) -> PlaceFile {
        let of = &self.laid[piece].part.surface.vertices;
        let drawn: Vec<Vec3> =
            (0..of.len() as u32).map(|v| self.place(piece, v) / MM).map(|p| Vec3::new(p.x, -p.y, 0.0)).collect();
        let turn = nearest_turn(&drawn, of);
        let at = middle(of) - turn * middle(&drawn);
        let outward = turn * if inward { -Vec3::z() } else { Vec3::z() };
        let above = of.iter().zip(&drawn).map(|(p, q)| outward.dot(&(p - at - turn * q)));
        let at = at + outward * (above.fold(0.0, f64::max) + BESIDE);
        let (x, y, z) = turn.euler_angles();
        let rounded = |x: f64| (x * DECIMALS).round() / DECIMALS;
        PlaceFile::At {
            at: (at * MM).map(rounded).into(),
            turn: Some([x, y, z].map(|angle| rounded(angle.to_degrees()))),
        }
    }
}

fn middle(places: &[Vec3]) -> Vec3 {
    places.iter().sum::<Vec3>() / places.len() as f64
}

/// The turn that brings places nearest to others (least squares: Kabsch 1976).
fn nearest_turn(from: &[Vec3], to: &[Vec3]) -> Rotation3<f64> {
    let (a, b) = (middle(from), middle(to));
    let spread = from.iter().zip(to).fold(Mat3::zeros(), |sum, (p, q)| sum + (q - b) * (p - a).transpose());
    let svd = spread.svd(true, true);
    let (Some(u), Some(v)) = (svd.u, svd.v_t) else { return Rotation3::identity() };
    let mirrored = (u * v).determinant() < 0.0;
    let kept = Mat3::from_diagonal(&Vec3::new(1.0, 1.0, if mirrored { -1.0 } else { 1.0 }));
    Rotation3::from_matrix_unchecked(u * kept * v)
}

/// A form as a file, millimetres.
pub(super) fn form_obj(form: &TriMesh) -> String {
    let mut obj = ObjText::exact();
    obj.comment(format_args!("toile {}: the surface with its rims closed, millimetres", env!("CARGO_PKG_VERSION")));
    form.vertices.iter().for_each(|p| obj.vertex(&(p * MM)));
    form.triangles.iter().for_each(|t| obj.face(*t));
    obj.into_text()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_is_found_again() {
        let flat: Vec<Vec3> =
            [(0.0, 0.0), (3.0, 0.0), (2.0, 2.0), (0.0, 1.0)].map(|(x, y)| Vec3::new(x, y, 0.0)).into();
        for [x, y, z] in [[0.0, 0.0, 0.0], [0.3, -1.1, 2.0], [3.0, 1.5, -2.0]] {
            let turn = Rotation3::from_euler_angles(x, y, z);
            let there: Vec<Vec3> = flat.iter().map(|p| turn * p + Vec3::new(1.0, 2.0, 3.0)).collect();
            assert!((nearest_turn(&flat, &there).matrix() - turn.matrix()).norm() < 1e-12);
        }
    }
}
