//! From a garment to its mesh: the order of the steps.

use rayon::prelude::*;

use super::breaks::Breaks;
use super::chords::SelfSeam;
use super::error::MeshError;
use super::frame::Frame;
use super::grid::Core;
use super::improve::Improver;
use super::lattice::Lattice;
use super::lines::LinePlan;
use super::links::{EdgeTable, Link};
use super::patch::Patch;
use super::sampling::Sampling;
use super::strip::{self, StripError};
use super::{ClothMesh, EdgeParticles, LineParticles, MeshOptions, Method, PieceMesh, Stitches, coons, limits, shape};
use crate::geometry::Vec2;
use crate::pattern::{EdgeId, Garment};

/// Edges that turn by more than this (radians; 15°) between two segments get a particle at the kink: cutting the
/// corner would change the piece's area in the first order of the spacing.
const KINK: f64 = 0.26;
/// Turns are measured this far (metres) on either side of a joint.
const BESIDE: f64 = 1e-7;
/// Rounds of relaxing, parting chords and mending; each undoes what the one before spoilt.
const ROUNDS: usize = 2;

/// A piece's points and triangles.
pub(super) struct Fill {
    /// Rim particles first, as in the frame.
    pub(super) points: Vec<Vec2>,
    /// Positively oriented.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Particles of every planned line.
    pub(super) lines: Vec<Vec<u32>>,
}

/// What is known of the whole garment before its pieces are filled.
struct Layout<'g> {
    garment: &'g Garment,
    edges: EdgeTable,
    plans: Vec<LinePlan<'g>>,
    /// Seams first, in the garment's order.
    links: Vec<Link>,
    breaks: Breaks,
    sampling: Sampling,
    options: MeshOptions,
}

/// Meshes every piece of `garment` with springs of about `spacing` metres; see [`build_with`].
///
/// # Errors
/// As [`build_with`].
pub fn build(garment: &Garment, spacing: f64) -> Result<ClothMesh, MeshError> {
    build_with(garment, &MeshOptions { spacing, method: Method::Auto })
}

/// Meshes every piece of `garment`.
///
/// Rims lie on the drawn edges; both sides of a seam have the same number of particles at matching arc length, and a
/// particle at every mark, span end, edge end and kink of either side, also of edges they are sewn to indirectly. Inside is a
/// regular grid along the grain whose diagonals alternate, with an irregular strip of about one spacing along rims
/// that are not in line with it. The same garment and options give the same bytes, for any number of threads.
///
/// The smallest angle is normally above 25°. Exceptions are corners of the outline sharper than that, strips and
/// gaps narrower than a spacing, and neighbouring springs of very different length where marks lie close together:
/// [`PieceMesh::smallest_angle`] says what was reached.
///
/// # Errors
/// [`MeshError`] when the spacing is no positive length or does not suit the pieces, or when an outline, a line or a
/// seam contradicts itself.
pub fn build_with(garment: &Garment, options: &MeshOptions) -> Result<ClothMesh, MeshError> {
    limits::check(garment, options.spacing)?;
    let layout = Layout::new(garment, *options)?;
    let numbers: Vec<usize> = (0..garment.pieces.len()).collect();
    let fills: Vec<_> = numbers.par_iter().map(|&n| layout.fill(n)).collect::<Result<_, _>>()?;
    Ok(layout.assemble(fills))
}

impl<'g> Layout<'g> {
    fn new(garment: &'g Garment, options: MeshOptions) -> Result<Self, MeshError> {
        let edges = EdgeTable::new(garment);
        let plans: Vec<_> =
            (0..garment.pieces.len()).map(|n| LinePlan::new(garment, n, &edges, options.spacing)).collect();
        let mut links: Vec<Link> =
            garment.seams.iter().map(|s| Link::of_seam(s, garment, &edges)).collect::<Result<_, _>>()?;
        let seams = links.len();
        for (n, piece) in garment.pieces.iter().enumerate().filter(|(_, p)| coons::wanted(p, options.method)) {
            links.extend(coons::links(piece, n, &edges));
        }
        let mut seeds: Vec<_> = plans.iter().flat_map(LinePlan::rim_seeds).collect();
        seeds.extend(kinks(garment, &edges));
        let sample = |links: &[Link]| {
            let breaks = Breaks::close(&edges, links, &seeds, garment)?;
            let sampling = Sampling::new(&edges, links, &breaks, options.spacing)?;
            Ok((breaks, sampling))
        };
        // Straight columns are a wish: if the seams do not allow them, the band becomes a grid.
        let sampled = sample(&links).or_else(|error: MeshError| {
            if links.len() == seams {
                return Err(error);
            }
            links.truncate(seams);
            sample(&links)
        });
        let (breaks, sampling) = sampled?;
        Ok(Self { garment, edges, plans, links, breaks, sampling, options })
    }

    /// Meshes piece `n`.
    fn fill(&self, n: usize) -> Result<(Frame, Fill), MeshError> {
        let piece = &self.garment.pieces[n];
        let mut frame = Frame::of_rim(piece, n, &self.edges, &self.breaks, &self.sampling)?;
        if coons::wanted(piece, self.options.method)
            && let Some(fill) = coons::fill(&frame, &self.plans[n], self.options.method)
        {
            return Ok((frame, fill));
        }
        let rim_edges = frame.edges.clone();
        let first = self.edges.number(EdgeId { piece: n, ring: 0, index: 0 }).unwrap_or(0);
        frame.add_lines(&self.plans[n], |edge, s| {
            let at = self.sampling.particle_of_break(edge, self.breaks.nearest(edge, s));
            rim_edges[edge - first][at]
        });
        let spacing = self.options.spacing;
        let lattice = Lattice::fit(&frame, piece.warp, spacing);
        let core = Core::lay(&frame, &lattice, spacing);
        let strip = strip::triangulate(&frame, &core).map_err(|e| self.strip_error(n, &frame, &core, e))?;
        let triangles: Vec<_> = core.triangles.iter().chain(&strip).copied().collect();
        let mut patch = Patch::new(core.points, frame.points.len(), &triangles, &frame.line_springs);
        let self_seams = self.self_seams(n, &frame, first);
        let mut improver = Improver { patch: &mut patch, rim: frame.rim as u32, spacing };
        for _ in 0..ROUNDS {
            improver.relax();
            improver.part_chords(&self_seams);
            improver.mend();
        }
        improver.relax();
        let (points, triangles) = patch.finish();
        let lines = std::mem::take(&mut frame.lines);
        Ok((frame, Fill { points, triangles, lines }))
    }

    /// Seams with both sides on piece `n`.
    fn self_seams(&self, n: usize, frame: &Frame, first: usize) -> Vec<SelfSeam> {
        let sides = |link: &Link| {
            [0, 1].map(|side| {
                let runs = self.breaks.runs(link, side).into_iter().filter(|r| self.edges.ids[r.edge].piece == n);
                let particles = runs.flat_map(|r| {
                    self.sampling.particles_of_run(&r).into_iter().map(move |p| (r.edge, p)).collect::<Vec<_>>()
                });
                let mut on: Vec<u32> = particles.map(|(edge, p)| frame.edges[edge - first][p]).collect();
                on.sort_unstable();
                on.dedup();
                on
            })
        };
        let seams = self.links[..self.garment.seams.len()].iter().map(sides);
        seams.filter(|[a, b]| !a.is_empty() && !b.is_empty()).map(SelfSeam).collect()
    }

    /// Puts the pieces together and pairs the particles of the seams.
    fn assemble(&self, fills: Vec<(Frame, Fill)>) -> ClothMesh {
        let mut mesh = ClothMesh { spacing: self.options.spacing, ..ClothMesh::default() };
        for ((n, piece), (frame, fill)) in self.garment.pieces.iter().enumerate().zip(fills) {
            let first = mesh.flat.len() as u32;
            let global = |chain: &Vec<u32>| chain.iter().map(|v| v + first).collect::<Vec<_>>();
            let ids = self.edges.ids.iter().filter(|id| id.piece == n);
            let edges = ids.zip(&frame.edges).map(|(&edge, chain)| EdgeParticles {
                edge,
                name: piece.loops[edge.ring][edge.index].name.clone(),
                particles: global(chain),
            });
            let lines = self.plans[n].lines.iter().zip(&fill.lines).map(|(line, chain)| LineParticles {
                name: piece.lines[line.number].name.clone(),
                kind: piece.lines[line.number].kind.clone(),
                particles: global(chain),
            });
            let triangles = mesh.triangles.len()..mesh.triangles.len() + fill.triangles.len();
            mesh.pieces.push(PieceMesh {
                name: piece.name.clone(),
                particles: mesh.flat.len()..mesh.flat.len() + fill.points.len(),
                triangles,
                edges: edges.collect(),
                lines: lines.collect(),
                smallest_angle: shape::smallest_angle(&fill.points, &fill.triangles),
                warp: piece.warp,
            });
            mesh.triangles.extend(fill.triangles.iter().map(|t| t.map(|v| v + first)));
            mesh.flat.extend(fill.points);
        }
        mesh.seams = self.stitches(&mesh);
        mesh
    }

    /// Pairs of every seam; a pair that repeats at a joint is kept once.
    fn stitches(&self, mesh: &ClothMesh) -> Vec<Stitches> {
        let edges: Vec<&EdgeParticles> = mesh.pieces.iter().flat_map(|p| &p.edges).collect();
        let particles = |link: &Link, side: usize| {
            self.breaks.runs(link, side).into_iter().flat_map(|run| {
                let at = self.sampling.particles_of_run(&run);
                at.into_iter().map(|k| edges[run.edge].particles[k]).collect::<Vec<_>>()
            })
        };
        let seams = self.garment.seams.iter().zip(&self.links);
        seams
            .map(|(seam, link)| {
                let mut pairs: Vec<[u32; 2]> = particles(link, 0).zip(particles(link, 1)).map(|(a, b)| [a, b]).collect();
                pairs.dedup();
                Stitches { name: seam.name.clone(), pairs }
            })
            .collect()
    }

    /// Says which edges or lines of piece `n` the triangulation stumbled over.
    fn strip_error(&self, n: usize, frame: &Frame, core: &Core, error: StripError) -> MeshError {
        let piece = &self.garment.pieces[n];
        let on = |v: u32| self.carriers(n, frame, v);
        let crossing = |at: Vec2, mut names: Vec<String>| {
            names.dedup();
            let first = names.first().cloned().unwrap_or_default();
            let second = names.get(1).cloned().unwrap_or_else(|| "itself".to_owned());
            MeshError::Crossing { piece: piece.name.clone(), first, second, at, spacing: self.options.spacing }
        };
        match error {
            StripError::Crossing([a, b]) => {
                let at = 0.5 * (core.points[a as usize] + core.points[b as usize]);
                let own: Vec<String> = on(a).into_iter().filter(|name| on(b).contains(name)).collect();
                let near = (0..frame.points.len() as u32)
                    .filter(|&v| !on(v).iter().any(|name| own.contains(name)))
                    .min_by(|&v, &w| {
                        let d = |v: u32| (frame.points[v as usize] - at).norm_squared();
                        d(v).total_cmp(&d(w))
                    });
                crossing(at, own.into_iter().take(1).chain(near.map(on).into_iter().flatten().take(1)).collect())
            }
            StripError::Double(v) => {
                let at = core.points[v as usize];
                let same = (0..frame.points.len() as u32).filter(|&w| frame.points[w as usize] == at);
                crossing(at, same.flat_map(|w| on(w).into_iter().take(1)).collect())
            }
            StripError::Outside(v) => MeshError::LineOutside {
                piece: piece.name.clone(),
                line: on(v).into_iter().next().unwrap_or_default(),
            },
            StripError::Refused(why) => MeshError::Triangulation { piece: piece.name.clone(), why },
        }
    }

    /// Names of the edges and lines a frame particle lies on.
    fn carriers(&self, n: usize, frame: &Frame, v: u32) -> Vec<String> {
        let piece = &self.garment.pieces[n];
        let edges = piece.loops.iter().flatten().zip(&frame.edges);
        let edges = edges.filter(|(_, c)| c.contains(&v)).map(|(e, _)| format!("edge '{}'", e.name));
        let lines = self.plans[n].lines.iter().zip(&frame.lines);
        let lines = lines.filter(|(_, c)| c.contains(&v)).map(|(l, _)| format!("line '{}'", piece.lines[l.number].name));
        edges.chain(lines).collect()
    }
}

/// Places where an edge turns sharply.
fn kinks(garment: &Garment, edges: &EdgeTable) -> Vec<(usize, f64)> {
    let mut out = Vec::new();
    for (e, id) in edges.ids.iter().enumerate() {
        let path = &garment.pieces[id.piece].loops[id.ring][id.index].path;
        let joints = path.joints();
        let inner = joints.iter().skip(1).take(joints.len().saturating_sub(2));
        out.extend(inner.filter(|&&s| path.tangent(s - BESIDE).angle(&path.tangent(s + BESIDE)) > KINK).map(|&s| (e, s)));
    }
    out
}
