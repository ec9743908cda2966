//! From positions to a report.

use super::bunched::bunched;
use super::closures::Closures;
use super::crossings::{CrossingsSeen, look};
use super::errors::{ComparedStates, area, area_error, boundary_error};
use super::fit::fit;
use super::laps::turned_laps;
use super::measured::Measured;
use super::openings::{SewnRim, openings};
use super::rim::{RimEdge, beside_elastic, outline_distance, rims};
use super::schema::{NarrowReport, PieceEdge, PieceReport, PieceSizes, Quartet, Report, SeamReport};
use super::statistics::{largest, mean};
use super::strain::{PieceStrain, piece_strain};
use super::stretched::stretched;
use super::tight::Tight;
use super::worn::worn_rows;
use crate::geometry::{MM, Vec2, Vec3};
use crate::mesh::{EdgeParticles, Stitches, UncrossedStraps};
use crate::pattern::{Fastening, Garment, fastenings};
use crate::verify::Welded;

/// Square millimetres in a square metre.
const MM2: f64 = 1e6;

/// Measures everything the report holds. Strain, contact and openings are those of the last stage in space (draped,
/// else sewn). Without one they are empty.
///
/// # Panics
/// When a slice is shorter than the mesh has particles: a mistake of the caller.
pub fn measure(run: &Measured) -> Report {
    let shapes = Shapes::new(run);
    let last = run.draped.or(run.sewn);
    let mut closures = last.map_or_else(Closures::default, |at| Closures::new(run.garment, run.mesh, at));
    let space = last.map(|at| InSpace::new(run, at, &closures));
    if let Some(space) = &space {
        let mut turned = turned_laps(run.garment, run.mesh, &space.welded, &closures.closed);
        closures.rows.iter_mut().enumerate().for_each(|(k, row)| row.turned = turned.remove(&k));
    }
    let (seen, worn) = space
        .as_ref()
        .map_or_else(Default::default, |space| (space.seen(run), worn_rows(run, space.rims(), &space.openings)));
    let draped = space.as_ref().filter(|_| run.draped.is_some());
    let bunched = draped.map_or_else(Vec::new, |space| bunched(run.garment, run.mesh, &space.welded, run.body));
    let fit = draped.map(|space| fit(run, space.at, space.rims(), &space.openings, &worn));
    let (pieces, total) = pieces(run, &shapes, space.as_ref());
    Report {
        toile: env!("CARGO_PKG_VERSION").into(),
        garment: run.garment.name.clone(),
        mannequin: run.body.name.clone(),
        fabric: run.fabric.into(),
        // To a nanometre: 18 was made 0.018 m, which is 18.000000000000004 mm.
        spacing: (run.mesh.spacing * MM * MM * MM).round() / (MM * MM),
        problems: Vec::new(),
        pieces,
        total,
        seams: run.mesh.seams.iter().enumerate().map(|(k, s)| seam(run, k, s)).collect(),
        closures: closures.rows,
        contact: seen.contact,
        crossings: seen.crossings,
        worn,
        bunched,
        fit,
        from: None,
        form: None,
        stages: run.stages.to_vec(),
    }
}

/// The garment's positions after every stage, all in space.
struct Shapes {
    flat: Vec<Vec3>,
    sewn: Option<Vec<Vec3>>,
    draped: Option<Vec<Vec3>>,
    flattened: Option<Vec<Vec3>>,
}

impl Shapes {
    fn new(run: &Measured) -> Self {
        let lifted = |plane: &[Vec2]| plane.iter().map(|p| Vec3::new(p.x, p.y, 0.0)).collect();
        Self {
            flat: lifted(&run.mesh.flat),
            sewn: run.sewn.map(<[Vec3]>::to_vec),
            draped: run.draped.map(<[Vec3]>::to_vec),
            flattened: run.flattened.map(lifted),
        }
    }

    /// `of(before, after, way)` for each way there are positions for.
    fn each_way<T>(&self, of: impl Fn(&[Vec3], &[Vec3], ComparedStates) -> T) -> [Option<T>; 4] {
        let from_flat =
            |after: &Option<Vec<Vec3>>| after.as_ref().map(|a| of(&self.flat, a, ComparedStates::FromDrawn));
        let from_draped = self.draped.as_ref().zip(self.flattened.as_ref());
        [
            from_flat(&self.sewn),
            from_flat(&self.draped),
            from_draped.map(|(before, after)| of(before, after, ComparedStates::FromDraped)),
            from_flat(&self.flattened),
        ]
    }
}

/// The part of the mesh that one row of the table is about.
struct MeshPart<'a> {
    name: &'a str,
    particles: usize,
    smallest_angle: f64,
    triangles: Vec<(u32, [u32; 3])>,
    rim: Vec<RimEdge>,
    /// Triangles that elastic gathers.
    gathered: Vec<u32>,
    strain: PieceStrain,
}

fn pieces(run: &Measured, shapes: &Shapes, space: Option<&InSpace>) -> (Vec<PieceReport>, PieceReport) {
    let mesh = run.mesh;
    let mut total = MeshPart {
        name: "total",
        particles: mesh.flat.len(),
        smallest_angle: mesh.pieces.iter().map(|p| p.smallest_angle).reduce(f64::min).unwrap_or(0.0),
        triangles: Vec::new(),
        rim: Vec::new(),
        gathered: Vec::new(),
        strain: PieceStrain::default(),
    };
    let mut reports = Vec::new();
    let elastic = mesh.on_elastic();
    let rims = rims(mesh, run.weld);
    let tight = space.map(|space| Tight::new(space.rims(), &space.openings, &rims, run.body));
    let given = space.map(|space| space.at).zip(tight.as_ref());
    for (index, (piece, rim)) in mesh.pieces.iter().zip(rims).enumerate() {
        let part = MeshPart {
            name: &piece.name,
            particles: piece.particles.len(),
            smallest_angle: piece.smallest_angle,
            triangles: piece.triangles.clone().map(|t| (t as u32, mesh.triangles[t])).collect(),
            rim,
            gathered: beside_elastic(mesh, piece, &elastic),
            strain: space.map_or_else(Default::default, |space| piece_strain(mesh, piece, &elastic, space.at)),
        };
        let mut report = row(&part, shapes);
        report.narrow = piece.narrow.map(|n| NarrowReport { width: n.width * MM, along: n.along * MM });
        report.outline_distance =
            shapes.flattened.as_deref().map(|at| outline_distance(&part.rim, &shapes.flat, at) * MM);
        report.overlaps = run.overlaps.and_then(|overlaps| overlaps.get(index).copied());
        report.edges = piece.edges.iter().map(edge).collect();
        report.stretched = given.and_then(|(at, tight)| stretched(mesh, &part.rim, part.strain.extension, tight, at));
        reports.push(report);
        total.triangles.extend(&part.triangles);
        total.rim.extend(&part.rim);
        total.gathered.extend(&part.gathered);
        total.strain.extend(&part.strain);
    }
    let mut whole = row(&total, shapes);
    // Outlines of different pieces have nothing to do with each other.
    whole.outline_distance = reports.iter().filter_map(|r| r.outline_distance).reduce(f64::max);
    whole.overlaps = run.overlaps.map(|overlaps| overlaps.iter().sum());
    (reports, whole)
}

fn edge(edge: &EdgeParticles) -> PieceEdge {
    PieceEdge { name: edge.name.clone(), points: edge.particles.iter().map(|&n| n as usize + 1).collect() }
}

/// Figures that a piece shares with the total. Those of a piece alone are left open.
fn row(part: &MeshPart, shapes: &Shapes) -> PieceReport {
    let uneven = part.rim.iter().filter(|e| e.uneven()).map(|e| e.triangle);
    let mut drawn_in: Vec<u32> = uneven.chain(part.gathered.iter().copied()).collect();
    drawn_in.sort_unstable();
    let left_out = |t: u32| drawn_in.binary_search(&t).is_ok();
    let area = shapes.each_way(|before, after, _| area_error(&part.triangles, before, after, left_out));
    let boundary = shapes.each_way(|before, after, way| boundary_error(&part.rim, before, after, way));
    PieceReport {
        name: part.name.into(),
        particles: part.particles,
        triangles: part.triangles.len(),
        smallest_angle: part.smallest_angle.to_degrees(),
        narrow: None,
        sizes: sizes(part, shapes),
        area_error: quartet(area.map(|e| e.map(|e| e.error))),
        boundary_error: quartet(boundary.map(|e| e.map(|e| e.error))),
        area_error_raw: quartet(area.map(|e| e.map(|e| e.raw))),
        boundary_error_raw: quartet(boundary.map(|e| e.map(|e| e.raw))),
        strain: part.strain.strain(),
        drawn_out: part.strain.drawn_out(),
        shear: part.strain.shear(),
        largest_edge_error: part.strain.largest,
        outline_distance: None,
        overlaps: None,
        edges: Vec::new(),
        stretched: None,
    }
}

fn quartet([sew, drape, flatten, round_trip]: [Option<f64>; 4]) -> Quartet {
    Quartet { sew, drape, flatten, round_trip }
}

fn sizes(part: &MeshPart, shapes: &Shapes) -> PieceSizes {
    let total_area = |at: &[Vec3]| part.triangles.iter().map(|(_, t)| area(t, at)).sum::<f64>() * MM2;
    let rim_length = |at: &[Vec3]| part.rim.iter().map(|e| e.length(at)).sum::<f64>() * MM;
    let area_of = |at: &Option<Vec<Vec3>>| at.as_deref().map(total_area);
    let length_of = |at: &Option<Vec<Vec3>>| at.as_deref().map(rim_length);
    PieceSizes {
        area_flat: total_area(&shapes.flat),
        area_sewn: area_of(&shapes.sewn),
        area_draped: area_of(&shapes.draped),
        area_flattened: area_of(&shapes.flattened),
        boundary_flat: rim_length(&shapes.flat),
        boundary_sewn: length_of(&shapes.sewn),
        boundary_draped: length_of(&shapes.draped),
        boundary_flattened: length_of(&shapes.flattened),
    }
}

/// Lengths as drawn where the garment has the seam (a mesh's chords are a little shorter), else as meshed.
fn seam(run: &Measured, index: usize, stitches: &Stitches) -> SeamReport {
    let drawn = run.garment.seams.iter().find(|s| s.name == stitches.name);
    let meshed = |side: usize| -> f64 {
        let at = |pair: &[u32; 2]| run.mesh.flat[pair[side] as usize];
        stitches.pairs.windows(2).map(|w| (at(&w[1]) - at(&w[0])).norm()).sum()
    };
    let as_sewn = || {
        let at = run.sewn.unwrap_or_default();
        stitches.pairs.iter().filter_map(|&[a, b]| Some((at.get(a as usize)? - at.get(b as usize)?).norm())).collect()
    };
    let gaps: Vec<f64> = run.gaps.and_then(|g| g.get(index)).cloned().unwrap_or_else(as_sewn);
    SeamReport {
        name: stitches.name.clone(),
        length_a: drawn.map_or_else(|| meshed(0), |s| s.length_a()) * MM,
        length_b: drawn.map_or_else(|| meshed(1), |s| s.length_b()) * MM,
        gap_mean: mean(&gaps) * MM,
        gap_max: largest(&gaps) * MM,
    }
}

/// The garment at the end of the last stage in space.
struct InSpace<'a> {
    at: &'a [Vec3],
    welded: Welded,
    /// The same with crossed straps uncrossed, where it has any.
    uncrossed: Option<Welded>,
    /// Openings of the garment with its straps uncrossed.
    openings: Vec<SewnRim>,
}

impl<'a> InSpace<'a> {
    fn new(run: &Measured, at: &'a [Vec3], closures: &Closures) -> Self {
        let welded = Welded::new(run.mesh, run.weld, at);
        let Some(UncrossedStraps { weld, closures: exchanged }) = run.uncrossed else {
            let openings = openings(run.garment, run.mesh, &welded, &closures.closed);
            return Self { at, welded, uncrossed: None, openings };
        };
        let is_closed = |f: &Fastening| closures.closed.iter().any(|closed| closed.tack == f.tack);
        let garment = Garment { closures: exchanged.clone(), ..run.garment.clone() };
        let closed: Vec<Fastening> = fastenings(&garment).into_iter().filter(is_closed).collect();
        let uncrossed = Welded::new(run.mesh, weld, at);
        let openings = openings(&garment, run.mesh, &uncrossed, &closed);
        Self { at, welded, uncrossed: Some(uncrossed), openings }
    }

    /// The surface that the openings are the rims of.
    fn rims(&self) -> &Welded {
        self.uncrossed.as_ref().unwrap_or(&self.welded)
    }

    /// Findings of the independent checks.
    fn seen(&self, run: &Measured) -> CrossingsSeen {
        let piece = |t: u32| {
            let first = run.mesh.triangles[t as usize][0];
            run.mesh.piece_of(first).map_or("", |i| run.mesh.pieces[i].name.as_str())
        };
        look(&self.welded.surface, Some(&run.body.mesh), piece, |p| run.body.frame.to_file(p))
    }
}
