//! Laying cloth flat: from a surface in space to the pattern piece that makes it (F12, F13).
//!
//! ```text
//! surface ─▶ topology ─▶ start ─▶ relax ─▶ align ─▶ measure
//!            a disk?     no flip   energy   onto the  area, boundary,
//!                                  down     drawing   flips, overlaps
//! ```
//!
//! The published method relaxes springs in the plane from a start unrolled triangle by triangle. Springs see a triangle
//! that is turned over as a good one and a start with flips keeps them, so here the start never has any (boundary-first
//! flattening, Tutte's circle, or the drawn piece), the energy is infinite at a flip, and no step reaches one.
//!
//! Flat positions have triangles with a positive cross product (b − a) × (c − a) of their raw coordinates: the
//! convention of drawn pieces, clockwise on a screen with y down.

mod align;
mod barrier;
mod chains;
mod coarse;
mod cut;
mod distortion;
mod element;
mod energy;
mod error;
mod garment;
mod halve;
mod harmonic;
mod holes;
mod inverse;
mod law;
pub mod line;
mod measure;
mod orient;
mod overlap;
mod relax;
pub mod round;
mod spring;
mod start;
mod topology;
mod woven;
mod zone;

pub use cut::{Solid, dart, disk_cuts, shortest_path, slit_from_rim};
pub use error::FlattenError;
pub use garment::{FlatGarment, FlatPiece, flatten_garment};
pub use halve::halving;
pub use measure::{FlatReport, Threads, triangle_strain};
pub use orient::{one_sided, orient};
use overlap::Legs;
pub use overlap::rim_crossings;

use std::collections::{HashMap, HashSet};
use std::f64::consts::TAU;
use std::sync::Arc;

use crate::geometry::{Topology, TriMesh, Vec2, sorted_pair};
use barrier::Barrier;
use distortion::TermWeights;
use element::FlatElement;
use energy::FlatEnergy;
use law::Law;
use relax::{EnergyDescent, Goal};
use spring::{Elastic, LengthSpring, Springs};
use zone::Zone;

/// Stiffness of rim edges in the modes that keep the boundary, for a piece one metre square. This alone brings the rim
/// of a bodice without darts to 0.05 %; the forces that hold it do the rest.
const RIM_WEIGHT: f64 = 30.0;
/// Weight of a brace against that of a rim edge. On a bodice the largest change of a corner falls from 28° without
/// braces to 15°, and to 10° with ten times as much; but then the forces that hold the edges take
/// twice as long to find.
const BRACE: f64 = 0.1;
/// A brace spans two rim edges whose ends are further apart than this share of their lengths.
const BRACED: f64 = 0.1;
/// Weight of (det J − 1)² in the balanced mode: brings the area of a bodice's triangles from 6 % to 1.1 % (RMS), at
/// the price of more shear (the stretches' root mean square rises from 7 to 11 %), which cloth gives easily.
const AREA_WEIGHT: f64 = 7.0;
/// In the woven mode this share of the distortion energy stays, as the wall before a flip.
const WOVEN_WALL: f64 = 1e-4;
/// Stiffness of rim edges in the woven mode against that in the others: there the cloth gives so easily that a stiffer
/// rim only takes longer to find.
const WOVEN_RIM: f64 = 0.1;
/// In the isometric and spring modes this share of the distortion energy is there as the wall before a flip. It moves
/// the minimum so little that the strain is within 10⁻⁵ of the least.
const WALL: f64 = 1e-3;

/// A piece that is kept from lying on itself may miss its rim by this share in the mean, which is said; with more its
/// seams would not fit, and it is better cut in two.
const RIM_OF_A_PIECE_APART: f64 = 1e-3;

/// The property that a flat piece keeps where it cannot keep all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// Rim lengths first, then the area of every triangle; shear gives. For sewing.
    #[default]
    Balanced,
    /// Distances, evenly in the whole piece.
    Isometric,
    /// Rim lengths first, then distances.
    Boundary,
    /// Rim lengths, edge by edge or as whole chains ([`flatten_between`]), and the lengths of warp and weft threads;
    /// the angle between them gives, by 30° at most where that is enough. The warp is the piece's own, or upright
    /// (space's y) where there is no drawn piece. Where the rim is too short for the area (L² < 4πS) only the threads
    /// count: cloth whose threads keep their lengths is flat at least as large as in space.
    Woven,
    /// The lengths of all mesh edges: the published springs (F13).
    Spring,
}

impl Mode {
    /// Whether rim edges, or chains of them ([`flatten_between`]), get exactly the lengths they should have; in the
    /// woven mode where the rim is long enough.
    pub fn keeps_rim(self) -> bool {
        matches!(self, Self::Balanced | Self::Boundary | Self::Woven)
    }
}

/// How to flatten.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlattenOptions {
    /// The property to keep.
    pub mode: Mode,
    /// Converged when the next step would lower the energy by less than this share of it.
    pub tolerance: f64,
    /// Steps after which to stop anyway.
    pub max_iterations: usize,
    /// How much corners and curves of the rim resist being turned, against the mode's own measure; 1 is usual, with 10
    /// the largest change of a corner is about a third smaller and the rest of the piece pays.
    pub corners: f64,
}

impl Default for FlattenOptions {
    fn default() -> Self {
        Self { mode: Mode::default(), tolerance: 1e-5, max_iterations: 1000, corners: 1.0 }
    }
}

/// A surface laid flat.
#[derive(Clone, Debug, PartialEq)]
pub struct Flattened {
    /// Flat position of every vertex, metres.
    pub positions: Vec<Vec2>,
    /// Logarithm of the scale at every vertex of the conformal map that keeps the rim's lengths: where a cut helps most
    /// ([`dart`]). Empty where no such map was computed.
    pub log_scale: Vec<f64>,
    /// The errors it leaves in the cloth.
    pub report: FlatReport,
}

/// Lays a surface flat, its holes open, its centre at the origin and space's y (up) along −y (up on a screen), as far
/// as the surface has an upright direction.
///
/// Never flips a triangle. A developable surface keeps all its lengths to rounding (a mesh of one as far as the mesh
/// is developable). A piece that would lie on itself is kept from it, at the price of strain, where that leaves its
/// rim; elsewhere [`FlatReport::overlaps`] says so. A surface whose triangles run counter-clockwise seen from outside
/// is, drawn with y down, seen from its inside. A surface with holes keeps every rim; where no flat piece has them all
/// ([`FlatReport::strain_p99`] says so), as in a tube, it must be cut first ([`disk_cuts`]).
///
/// # Errors
/// A closed surface or one with handles, with what it is instead; degenerate triangles; coordinates that are not
/// finite.
pub fn flatten(surface: &TriMesh, options: &FlattenOptions) -> Result<Flattened, FlattenError> {
    flatten_surface(surface, None, options)
}

/// As [`flatten`], but of the rim the woven mode holds only the lengths between one of `breaks` (vertices of the rim)
/// and the next, each exactly; in between single edges may differ, as little as they can. Without breaks the rim's
/// whole length is held. Other modes keep what they keep.
///
/// # Errors
/// As [`flatten`].
pub fn flatten_between(surface: &TriMesh, breaks: &[u32], options: &FlattenOptions) -> Result<Flattened, FlattenError> {
    flatten_surface(surface, Some(breaks), options)
}

fn flatten_surface(
    surface: &TriMesh,
    breaks: Option<&[u32]>,
    options: &FlattenOptions,
) -> Result<Flattened, FlattenError> {
    let (topology, rims) = topology::check(surface)?;
    let (mut start, log_scale) = holes::start(surface, &topology, &rims)?;
    align::upright(&mut start, surface);
    let mut sheet = TargetSurface::as_it_is(surface, topology, rims);
    sheet.breaks = breaks.map(|breaks| breaks.iter().copied().collect());
    let mut flattened = relax_sheet(&sheet, start.clone(), options, Itself::MayMeet)?;
    if flattened.report.overlaps > 0 && rim_crossings(&start, &sheet.rims) == 0 {
        let apart = relax_sheet(&sheet, start, options, Itself::KeptApart)?;
        if apart.report.rim_missed.is_none_or(|missed| missed < RIM_OF_A_PIECE_APART) {
            flattened = apart;
        }
    }
    // Not turned again: the woven mode's grain is the plane's.
    align::centre(&mut flattened.positions);
    flattened.log_scale = log_scale;
    Ok(flattened)
}

/// Relaxes a surface, which may have holes, from a given flat start; the result stays near the start's place.
///
/// # Errors
/// As [`flatten`]; a start of the wrong length or with flipped triangles.
pub fn flatten_from(surface: &TriMesh, start: &[Vec2], options: &FlattenOptions) -> Result<Flattened, FlattenError> {
    let (topology, rims) = topology::check(surface)?;
    check_start(surface, start)?;
    let mut flattened =
        relax_sheet(&TargetSurface::as_it_is(surface, topology, rims), start.to_vec(), options, Itself::MayMeet)?;
    align::onto(&mut flattened.positions, start);
    Ok(flattened)
}

fn check_start(surface: &TriMesh, start: &[Vec2]) -> Result<(), FlattenError> {
    if start.len() != surface.vertices.len() {
        return Err(FlattenError::StartLength { expected: surface.vertices.len(), found: start.len() });
    }
    match start::first_flipped(&surface.triangles, start) {
        Some(t) => Err(FlattenError::FlippedStart(t)),
        None => Ok(()),
    }
}

/// A surface with the flat shape every part of it should have.
struct TargetSurface<'a> {
    surface: &'a TriMesh,
    topology: Topology,
    rims: Vec<Vec<u32>>,
    elements: Arc<[FlatElement]>,
    /// Wanted lengths of `topology.rim_edges()`, in that order.
    rim_targets: Vec<f64>,
    /// By how much the triangles' angles at a vertex should be wider than in the surface.
    wider: Vec<(u32, f64)>,
    /// Direction of the warp in the flat piece (unit).
    warp: Vec2,
    /// Where on the rim the chains end of which the woven mode holds the whole lengths; `None` where it holds every
    /// edge.
    breaks: Option<HashSet<u32>>,
    /// Of the darts that are sewn in it.
    legs: Legs,
}

impl<'a> TargetSurface<'a> {
    /// Every part should keep the shape it has.
    fn as_it_is(surface: &'a TriMesh, topology: Topology, rims: Vec<Vec<u32>>) -> Self {
        let elements =
            surface.triangles.iter().enumerate().map(|(t, &c)| FlatElement::new(c, surface.corners(t))).collect();
        let rim_targets = topology.rim_edges().map(|e| measure::length(surface, e.ends)).collect();
        let (wider, warp, breaks, legs) = (Vec::new(), -Vec2::y(), None, Legs::new());
        Self { surface, topology, rims, elements, rim_targets, wider, warp, breaks, legs }
    }

    /// Whether a mode can hold the rim's lengths.
    fn holds_rim(&self, mode: Mode) -> bool {
        let rim: f64 = self.rim_targets.iter().sum();
        mode.keeps_rim() && (mode != Mode::Woven || rim * rim >= 2.0 * TAU * self.surface.area())
    }

    fn energy(&self, options: &FlattenOptions) -> FlatEnergy {
        let rim_springs = |stiffness: f64| self.rim_springs(stiffness, options.corners);
        let law = |weights: TermWeights| Law { weights, warp: None };
        let (springs, law) = match options.mode {
            Mode::Balanced => {
                (rim_springs(RIM_WEIGHT), law(TermWeights { dirichlet: 1.0, area: AREA_WEIGHT, strain: 0.0 }))
            }
            Mode::Isometric => (Springs::default(), law(TermWeights { dirichlet: WALL, strain: 1.0, area: 0.0 })),
            Mode::Boundary => (rim_springs(RIM_WEIGHT), law(TermWeights { dirichlet: 1.0, ..TermWeights::default() })),
            Mode::Woven => {
                let weights = TermWeights { dirichlet: WOVEN_WALL, ..TermWeights::default() };
                let rim =
                    if self.holds_rim(Mode::Woven) { rim_springs(WOVEN_RIM * RIM_WEIGHT) } else { Springs::default() };
                (rim, Law { warp: Some(self.warp), weights })
            }
            Mode::Spring => (self.edge_springs(), law(TermWeights { dirichlet: WALL, ..TermWeights::default() })),
        };
        FlatEnergy::new(self.surface.vertices.len(), self.elements.clone(), springs, law)
    }

    /// Wanted sums of the triangles' angles at every vertex.
    fn angles(&self) -> Vec<f64> {
        let mut sums = start::angle_sums(self.surface);
        self.wider.iter().for_each(|(v, by)| sums[*v as usize] += by);
        sums
    }

    /// Rim edges, weighted by length: the weight of a rim does not change with the mesh. Braces over two edges each
    /// keep a rim that is longer than its surroundings want from taking the length up in kinks: they do not feel a rim
    /// that bends a little in every vertex.
    fn rim_springs(&self, stiffness: f64, corners: f64) -> Springs {
        let angles = self.angles();
        let size = self.elements.iter().map(|e| e.area).sum::<f64>().sqrt();
        let spring = |ends, target| LengthSpring::between(ends, target, stiffness * size * target);
        let edges = self.topology.rim_edges().map(|e| e.ends);
        let targets: Vec<([u32; 2], f64)> = edges.zip(self.rim_targets.iter().copied()).collect();
        let of_edge: HashMap<[u32; 2], f64> = targets.iter().copied().collect();
        let length = |a: u32, b: u32| of_edge.get(&sorted_pair([a, b])).copied().unwrap_or(0.0);
        let mut free = Vec::new();
        for rim in &self.rims {
            for k in 0..rim.len() {
                let [a, b, c] = [0, 1, 2].map(|i| rim[(k + i) % rim.len()]);
                let (before, after) = (length(a, b), length(b, c));
                let square = before * before + after * after - 2.0 * before * after * angles[b as usize].cos();
                // Where the rim turns back on itself there is nothing to span.
                if a != c && square > (BRACED * (before + after)).powi(2) {
                    let brace = spring(sorted_pair([a, c]), square.sqrt());
                    let weight = BRACE * corners * brace.elastic.weight;
                    free.push(LengthSpring { elastic: Elastic { weight, ..brace.elastic }, ..brace });
                }
            }
        }
        let held = targets.into_iter().map(|(ends, target)| spring(ends, target)).collect();
        Springs { held, free, chains: Vec::new() }
    }

    /// All edges, weighted by a third of the area beside them.
    fn edge_springs(&self) -> Springs {
        let mut rim_targets = self.rim_targets.iter();
        let springs = self.topology.edges.iter().map(|e| {
            let area: f64 = e.triangles.iter().flatten().map(|&t| self.elements[t as usize].area).sum();
            let target = match e.triangles[1] {
                Some(_) => None,
                None => rim_targets.next().copied(),
            };
            let target = target.unwrap_or_else(|| measure::length(self.surface, e.ends));
            LengthSpring::between(e.ends, target, area / 3.0)
        });
        Springs { free: springs.collect(), ..Springs::default() }
    }
}

/// Whether a piece may come to lie on itself on the way down.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Itself {
    /// It may, and comes nearest to what the mode keeps.
    MayMeet,
    /// It never does: for a piece that would, from a start that does not. The way ends where it would have to.
    KeptApart,
}

fn relax_sheet(
    sheet: &TargetSurface<'_>,
    start: Vec<Vec2>,
    options: &FlattenOptions,
    itself: Itself,
) -> Result<Flattened, FlattenError> {
    let mut positions = start;
    let mut energy = sheet.energy(options);
    let mut zone = None;
    let held = sheet.holds_rim(options.mode);
    if let Some(breaks) = sheet.breaks.as_ref().filter(|_| held && options.mode == Mode::Woven) {
        energy = energy.with_chains(&sheet.rims, breaks);
    }
    if held && itself == Itself::MayMeet {
        coarse::approach(&energy, &mut positions);
        // The steps of a weave are few: a zone would take as many again.
        zone = Some(options.mode).filter(|mode| *mode != Mode::Woven).and_then(|_| Zone::new(&energy, &positions));
    }
    let goal = Goal::of(options, held);
    if itself == Itself::KeptApart {
        energy.barrier = Barrier::new(&sheet.rims, &positions);
    }
    let mut descent = EnergyDescent::new(&energy)?;
    if itself == Itself::KeptApart && energy.barrier.is_none() {
        descent = descent.keeping_apart(&sheet.rims);
    }
    let outcome = descent.down(&mut energy, &mut positions, &goal, zone.as_mut())?;
    let slack = energy.slack(&positions);
    let rim_missed = (held && slack > goal.exact).then_some(slack);
    let report = FlatReport { rim_missed, ..measure::report(sheet, &positions, &outcome) };
    Ok(Flattened { positions, log_scale: Vec::new(), report })
}
