//! Cloth that lies folded on itself, three deep, where one layer was sewn: held up by friction, not by the pattern.
//!
//! A line along the normal of a triangle meets the layers that lie on it. Where the middle one of three layers of the
//! same sheet is turned over, the cloth lies in a pressed fold. Folds that stand off, as those of a wide hem do, have
//! more room between their sides.

use std::collections::BTreeMap;

use super::schema::Bunched;
use crate::geometry::{DisjointSets, MM, Vec3};
use crate::mannequin::Mannequin;
use crate::mesh::ClothMesh;
use crate::pattern::{Garment, SeamKind};
use crate::verify::{Layer, Layers, Welded};

/// Largest distance of layers that lie on one another, metres: some thicknesses of a coat. Of 38 draped garments at 12
/// to 25 mm none had more than 16 cm² in one place, apart from cloth held by folds and pleats.
const PRESSED: f64 = 6e-3;
/// Layers that a line meets at a slant (cosine to the normal) do not lie on one another.
const FLAT: f64 = 0.3;
/// Less cloth than this in one place, metres², is the fold of a wrinkle: a wrapped dress at 20 mm had 16 cm², a skirt
/// crumpled between two pockets 162.
const LEAST: f64 = 25e-4;
/// Square millimetres in a square metre.
const MM2: f64 = 1e6;

/// The places where cloth of the draped garment `welded` lies folded on itself, the largest first. Pieces that have a
/// fold or a pleat by their pattern are left out.
pub(super) fn bunched(garment: &Garment, mesh: &ClothMesh, welded: &Welded, body: &Mannequin) -> Vec<Bunched> {
    let cloth = PlacedSheets::new(garment, mesh, welded);
    let mut sets = DisjointSets::new(welded.surface.triangles.len());
    let mut folded: Vec<u32> = Vec::new();
    for triangle in (0..welded.surface.triangles.len() as u32).filter(|&t| cloth.sheet[t as usize].is_some()) {
        let plies = cloth.plies(triangle);
        if !plies.is_empty() {
            folded.push(triangle);
        }
        for ply in plies {
            sets.join(triangle, ply);
        }
    }
    join_neighbours(welded, &folded, &mut sets);
    let mut places: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    folded.iter().for_each(|&t| places.entry(sets.root(t)).or_default().push(t));
    let mut out: Vec<Bunched> = places.values().filter_map(|triangles| cloth.place(triangles, body)).collect();
    out.sort_by(|a, b| b.area.total_cmp(&a.area));
    out
}

/// Joins folded triangles that share a vertex.
fn join_neighbours(welded: &Welded, folded: &[u32], sets: &mut DisjointSets) {
    let mut at_vertex: BTreeMap<u32, u32> = BTreeMap::new();
    for &triangle in folded {
        for vertex in welded.surface.triangles[triangle as usize] {
            let first = *at_vertex.entry(vertex).or_insert(triangle);
            sets.join(first, triangle);
        }
    }
}

/// The garment and its sheets.
struct PlacedSheets<'a> {
    mesh: &'a ClothMesh,
    welded: &'a Welded,
    layers: Layers<'a>,
    /// For every triangle the layer of its piece. None where the piece is folded by its pattern.
    sheet: Vec<Option<i32>>,
}

impl<'a> PlacedSheets<'a> {
    fn new(garment: &Garment, mesh: &'a ClothMesh, welded: &'a Welded) -> Self {
        let mut is_folded = vec![false; mesh.pieces.len()];
        for seam in garment.seams.iter().filter(|seam| matches!(seam.kind, SeamKind::Pleat(_))) {
            seam.a.iter().chain(&seam.b).for_each(|span| is_folded[span.edge.piece] = true);
        }
        let mut sheet = vec![None; mesh.triangles.len()];
        for (number, meshed) in mesh.pieces.iter().enumerate() {
            let piece = garment.pieces.get(number);
            let has_fold = piece.is_some_and(|piece| piece.lines.iter().any(|line| line.kind.hinge().is_some()));
            if !has_fold && !is_folded[number] {
                sheet[meshed.triangles.clone()].fill(Some(piece.map_or(0, |piece| piece.level())));
            }
        }
        Self { mesh, welded, layers: Layers::new(&welded.surface), sheet }
    }

    /// The triangles of its sheet that lie on a triangle in a pressed fold, itself among them. None where it is in no
    /// fold.
    fn plies(&self, triangle: u32) -> Vec<u32> {
        let surface = &self.welded.surface;
        let own = surface.triangles[triangle as usize];
        let Some(way) = surface.double_normal(triangle as usize).try_normalize(0.0) else { return Vec::new() };
        let skip = |other: u32| {
            let corners = surface.triangles[other as usize];
            self.sheet[other as usize] != self.sheet[triangle as usize] || corners.iter().any(|v| own.contains(v))
        };
        let middle = surface.corners(triangle as usize).iter().sum::<Vec3>() / 3.0;
        let mut line = self.layers.near(middle, way, 2.0 * PRESSED, skip);
        line.retain(|layer| layer.facing.abs() >= FLAT);
        line.push(Layer { triangle, at: 0.0, facing: 1.0 });
        line.sort_by(|a, b| a.at.total_cmp(&b.at));
        let is_fold = |plies: &&[Layer]| {
            let turned = plies.windows(2).all(|pair| pair[0].facing * pair[1].facing < 0.0);
            let pressed = plies.windows(2).all(|pair| pair[1].at - pair[0].at <= PRESSED);
            turned && pressed && plies.iter().any(|ply| ply.triangle == triangle)
        };
        line.windows(3).filter(is_fold).flatten().map(|ply| ply.triangle).collect()
    }

    /// Report on folded triangles that lie together. `None` if they are few.
    fn place(&self, triangles: &[u32], body: &Mannequin) -> Option<Bunched> {
        let area = |t: &u32| {
            let [a, b, c] = self.mesh.triangles[*t as usize].map(|p| self.mesh.flat[p as usize]);
            0.5 * (b - a).perp(&(c - a)).abs()
        };
        let whole: f64 = triangles.iter().map(area).sum();
        if whole < LEAST {
            return None;
        }
        let middle = |t: &u32| self.welded.surface.corners(*t as usize).iter().sum::<Vec3>() / 3.0 * area(t);
        let middle = triangles.iter().map(middle).sum::<Vec3>() / whole;
        let piece = |t: &u32| self.mesh.piece_of(self.mesh.triangles[*t as usize][0]);
        let mut pieces: Vec<usize> = triangles.iter().filter_map(piece).collect();
        pieces.sort_unstable();
        pieces.dedup();
        let (part, side) = spot(middle, body).unzip();
        Some(Bunched {
            height: middle.y * MM,
            body_part: part,
            side,
            area: whole * MM2,
            pieces: pieces.into_iter().map(|piece| self.mesh.pieces[piece].name.clone()).collect(),
        })
    }
}

/// The part of the body at a place, and the side of its axis. `None` on a body without parts.
fn spot(at: Vec3, body: &Mannequin) -> Option<(String, String)> {
    let (kind, section) = body.nearest_section(at)?;
    let way = at - section.center;
    // The body faces +z, and its left is at +x.
    let side = match (way.x.abs() > way.z.abs(), way.x > 0.0, way.z > 0.0) {
        (true, true, _) => "left",
        (true, false, _) => "right",
        (false, _, true) => "front",
        (false, _, false) => "back",
    };
    Some((kind.name().into(), side.into()))
}
