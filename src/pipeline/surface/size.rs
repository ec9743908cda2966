//! How large a surface is whose file does not say its unit, and which way up it stands.

use nalgebra::Rotation3;

use crate::geometry::{MM, Mat3, Vec3, box_of, triangles_of};
use crate::input::LengthUnit;
use crate::io::obj_read::ObjFaces;

/// A surface below this many units is taken for metres: sails, tents and covers of up to 12 m are laid flat too, and
/// pieces below 12 cm are rarely drawn in centimetres.
const METRES_BELOW: f64 = 12.0;
/// A surface below this many units is taken for centimetres: in millimetres it would be smaller than 10 cm.
const CENTIMETRES_BELOW: f64 = 100.0;
/// A surface from this many units on is taken for millimetres: in centimetres it would be larger than 3 m.
const MILLIMETRES_FROM: f64 = 300.0;
/// Between the two the mesh decides. Cloth of metres is meshed in sides of up to 2.5 cm; sides of more units than this
/// are millimetres.
const CENTIMETRE_SIDE: f64 = 2.5;
/// A sheet that hardly curves is taken for centimetres between these units, however coarse its mesh: in millimetres it
/// would be of 25 to 40 cm, which round a body, a foot or a seat curves more; in centimetres it is a cloak, a curtain
/// or a cover of 2.5 to 4 m.
const LARGE_SHEET: [f64; 2] = [250.0, 400.0];
/// A sheet hardly curves when its faces' normals have a larger mean cosine with its own: bent round a cylinder it turns
/// by less than 49°.
const HARDLY_CURVED: f64 = 0.97;
/// A unit in which the surface would be between 4 cm and 4 m large, as pieces of garments are, leaves a doubt.
const DOUBTFUL: [f64; 2] = [0.04, 4.0];
/// So do metres up to this size: sails and tents.
const LARGEST: f64 = 30.0;
/// An extent below this share of the largest is not said.
const SAID: f64 = 0.02;

/// A surface runs along an axis when its normals have less than this share (mean square) along it.
const ALONG: f64 = 0.02;
/// It does not run along an axis when they have more than this share.
const NOT_ALONG: f64 = 0.25;

/// Where a file's vertices lie in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Space {
    /// Metres per unit of the file.
    pub(super) metres: f64,
    /// Turns the file's upward direction to y.
    turn: Mat3,
}

impl Space {
    /// Of a file in this unit whose upward direction is `up`, or y.
    pub(super) fn new(unit: LengthUnit, up: Option<Vec3>) -> Self {
        let turn = up.map_or_else(Mat3::identity, |up| {
            let shortest = Rotation3::rotation_between(&up, &Vec3::y());
            // Upside down there is no shortest turn: half a turn round z.
            shortest.map_or_else(|| Mat3::from_diagonal(&Vec3::new(-1.0, -1.0, 1.0)), Rotation3::into_inner)
        });
        Self { metres: unit.metres(), turn }
    }

    /// A place of the file in metres, y up.
    pub(super) fn place(&self, p: Vec3) -> Vec3 {
        self.turn * (p * self.metres)
    }
}

/// The unit of a file, guessed from its size and its mesh, and what is to be said of it.
pub(super) fn guessed(faces: &ObjFaces) -> (LengthUnit, String) {
    let extents = extents(faces);
    let size = extents[0];
    let is_fine = || size < MILLIMETRES_FROM && mean_side(faces) < CENTIMETRE_SIDE;
    let is_large_sheet = || (LARGE_SHEET[0]..LARGE_SHEET[1]).contains(&size) && evenness(faces) > HARDLY_CURVED;
    let unit = if size < METRES_BELOW {
        LengthUnit::Metre
    } else if size < CENTIMETRES_BELOW || is_fine() || is_large_sheet() {
        LengthUnit::Centimetre
    } else {
        LengthUnit::Millimetre
    };
    let mut said = format!("{} assumed, from the size of the surface: {}", unit.symbol(), shown(&extents, unit));
    for other in [LengthUnit::Millimetre, LengthUnit::Centimetre, LengthUnit::Metre] {
        let most = if other == LengthUnit::Metre { LARGEST } else { DOUBTFUL[1] };
        if other != unit && (DOUBTFUL[0]..most).contains(&(size * other.metres())) {
            said += &format!(", or {} in {}", shown(&extents, other), other.symbol());
        }
    }
    (unit, said + "; say --units mm, cm, dm, m or in if that is wrong")
}

/// Of the box round all faces, the largest first.
fn extents(faces: &ObjFaces) -> [f64; 3] {
    let [low, high] = box_of(faces.faces.iter().flatten().map(|&v| faces.vertices[v as usize]));
    let mut extents: [f64; 3] = (high - low).into();
    extents.sort_by(|a, b| b.total_cmp(a));
    extents
}

/// Mean length of the faces' sides, in the file's unit.
fn mean_side(faces: &ObjFaces) -> f64 {
    let at = |v: u32| faces.vertices[v as usize];
    let lengths = faces.faces.iter().flat_map(|f| (0..f.len()).map(|k| (at(f[(k + 1) % f.len()]) - at(f[k])).norm()));
    let (sum, count) = lengths.fold((0.0, 0.0), |(sum, count), length| (sum + length, count + 1.0));
    sum / count
}

/// Mean cosine, by area, between the faces' normals and the sheet's own: 1 where all lie in one plane, about a half
/// where they close up. Faces that run against most others count as those do.
fn evenness(faces: &ObjFaces) -> f64 {
    let triangles = || faces.faces.iter().flat_map(|polygon| triangles_of(&faces.vertices, polygon));
    let normal = |[a, b, c]: [u32; 3]| {
        let [p, q, r] = [a, b, c].map(|v| faces.vertices[v as usize]);
        (q - p).cross(&(r - p))
    };
    let sum: Vec3 = triangles().map(normal).sum();
    let all: f64 = triangles().map(|t| normal(t).norm()).sum();
    let aligned: f64 = triangles().map(|t| normal(t).dot(&sum).abs()).sum();
    if sum.norm() > 0.0 { aligned / (sum.norm() * all) } else { 0.0 }
}

/// `238 × 150 mm`, or from a metre on `2.4 × 1.5 m`.
fn shown(extents: &[f64; 3], unit: LengthUnit) -> String {
    let [size, ..] = extents.map(|e| e * unit.metres());
    let large = size >= 1.0;
    let said = extents.iter().filter(|e| **e * unit.metres() >= SAID * size);
    let numbers = said.map(|e| e * unit.metres()).map(|m| match large {
        true => format!("{m:.1}"),
        false if size * MM < 10.0 => format!("{:.1}", m * MM),
        false => format!("{:.0}", m * MM),
    });
    numbers.collect::<Vec<_>>().join(" × ") + if large { " m" } else { " mm" }
}

/// Whether a surface stands along z, as scanners and CAD programs draw it: it runs along z, not along y, and does not
/// lie level.
pub(super) fn stands_along_z(faces: &ObjFaces) -> bool {
    let mut sums = Vec3::zeros();
    let mut all = 0.0;
    for polygon in &faces.faces {
        for [a, b, c] in triangles_of(&faces.vertices, polygon) {
            let [p, q, r] = [a, b, c].map(|v| faces.vertices[v as usize]);
            let normal = (q - p).cross(&(r - p));
            let length = normal.norm();
            if length > 0.0 {
                sums += normal.component_mul(&normal) / length;
                all += length;
            }
        }
    }
    sums.z < ALONG * all && sums.x > ALONG * all && sums.y > NOT_ALONG * all
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Squares of this side in rows, as many as go into the size.
    fn sheet(width: f64, height: f64, side: f64) -> ObjFaces {
        let [columns, rows] = [width, height].map(|x| (x / side).round() as u32);
        let mut faces = ObjFaces { groups: vec![String::new()], ..ObjFaces::default() };
        for (row, column) in (0..=rows).flat_map(|row| (0..=columns).map(move |column| (row, column))) {
            let [x, y] = [column, row].map(|k| side * f64::from(k));
            faces.vertices.push(Vec3::new(x, y, 0.0));
        }
        for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
            let a = row * (columns + 1) + column;
            faces.faces.push(vec![a, a + 1, a + columns + 2, a + columns + 1]);
            faces.group_of_face.push(0);
        }
        faces
    }

    #[test]
    fn the_guess_is_a_makers_and_doubts_are_said() {
        let said = |width, height, side| guessed(&sheet(width, height, side));
        for ((size, height, side), unit, doubt) in [
            // A shoe's upper in millimetres, a dress in centimetres, a sail in metres.
            ((240.0, 150.0, 10.0), LengthUnit::Millimetre, ": 240 × 150 mm, or 2.4 × 1.5 m in cm;"),
            ((120.0, 60.0, 1.5), LengthUnit::Centimetre, ": 1.2 × 0.6 m, or 120 × 60 mm in mm;"),
            ((9.6, 4.2, 0.6), LengthUnit::Metre, ": 9.6 × 4.2 m, or 96 × 42 mm in cm;"),
            // A large sail, or a doll's shoe.
            ((14.0, 6.0, 0.5), LengthUnit::Centimetre, ": 140 × 60 mm, or 14.0 × 6.0 m in m;"),
            // A cloak in a coarse mesh.
            ((310.0, 124.0, 31.0), LengthUnit::Centimetre, ": 3.1 × 1.2 m, or 310 × 124 mm in mm;"),
            // No doubt.
            ((720.0, 600.0, 10.0), LengthUnit::Millimetre, ": 720 × 600 mm;"),
            ((0.7, 0.6, 0.01), LengthUnit::Metre, ": 700 × 600 mm;"),
        ] {
            let (found, said) = said(size, height, side);
            assert_eq!(found, unit, "{said}");
            assert!(said.contains(doubt), "{said}");
        }
    }

    #[test]
    fn a_large_sheet_is_one_that_hardly_curves() {
        // Bent round a cylinder by so many degrees, some of its faces turned over.
        let bent = |degrees: f64| {
            let mut faces = sheet(310.0, 140.0, 10.0);
            let radius = 310.0 / degrees.to_radians();
            for p in &mut faces.vertices {
                *p = Vec3::new((p.x / radius).sin() * radius, p.y, (p.x / radius).cos() * radius);
            }
            faces.faces.iter_mut().step_by(7).for_each(|face| face.reverse());
            guessed(&faces).0
        };
        assert_eq!(bent(30.0), LengthUnit::Centimetre);
        for degrees in [90.0, 180.0, 340.0] {
            assert_eq!(bent(degrees), LengthUnit::Millimetre, "{degrees}");
        }
    }

    #[test]
    fn what_stands_along_z_is_seen() {
        // Half a tube upright in either direction, and a sheet that stands.
        let bent = |p: &Vec3| Vec3::new(p.x.cos(), p.y, p.x.sin());
        let mut tube = sheet(3.0, 2.0, 0.1);
        tube.vertices = tube.vertices.iter().map(bent).collect();
        let upright = |faces: &ObjFaces| stands_along_z(faces);
        assert!(!upright(&tube) && !upright(&sheet(3.0, 2.0, 0.1)));
        tube.vertices.iter_mut().for_each(|p| *p = Vec3::new(p.x, -p.z, p.y));
        assert!(upright(&tube));
        let mut level = sheet(3.0, 2.0, 0.1);
        level.vertices.iter_mut().for_each(|p| p.swap_rows(1, 2));
        assert!(!upright(&level));
    }

    #[test]
    fn every_direction_can_be_up() {
        for up in [Vec3::x(), Vec3::y(), Vec3::z(), -Vec3::y(), Vec3::new(1.0, -2.0, 0.5)] {
            let space = Space::new(LengthUnit::Centimetre, Some(up));
            let placed = space.place(up);
            assert!((placed - Vec3::y() * up.norm() * 0.01).norm() < 1e-12, "{up}");
        }
        let space = Space::new(LengthUnit::Metre, None);
        assert_eq!(space.place(Vec3::new(1.0, 2.0, 3.0)), Vec3::new(1.0, 2.0, 3.0));
    }
}
