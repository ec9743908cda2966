//! Puts filled pieces together and pairs the particles of the seams.

use super::build::Fill;
use super::frame::Frame;
use super::layout::Layout;
use super::{ClothMesh, EdgeParticles, LineParticles, PieceMesh, Stitches, shape};

impl Layout<'_> {
    /// The mesh of all pieces, in the garment's order.
    pub(super) fn assemble(&self, fills: Vec<(Frame, Fill)>) -> ClothMesh {
        let mut mesh = ClothMesh { spacing: self.options.spacing, ..ClothMesh::default() };
        for (n, (frame, fill)) in fills.into_iter().enumerate() {
            let piece = self.piece_mesh(n, &frame, &fill, mesh.flat.len(), mesh.triangles.len());
            let first = mesh.flat.len() as u32;
            mesh.triangles.extend(fill.triangles.iter().map(|t| t.map(|v| v + first)));
            mesh.flat.extend(fill.points);
            mesh.pieces.push(piece);
        }
        mesh.seams = self.stitches(&mesh);
        mesh
    }

    /// Describes piece `n`, whose particles and triangles will be numbered from `first` and `first_triangle`.
    fn piece_mesh(&self, n: usize, frame: &Frame, fill: &Fill, first: usize, first_triangle: usize) -> PieceMesh {
        let piece = &self.garment.pieces[n];
        let global = |chain: &[u32]| chain.iter().map(|v| v + first as u32).collect::<Vec<_>>();
        let ids = &self.edges.ids[self.first_edge(n)..];
        let edges = ids.iter().zip(&frame.edges).map(|(&edge, chain)| EdgeParticles {
            edge,
            name: piece.loops[edge.ring][edge.index].name.clone(),
            particles: global(chain),
        });
        let drawn = self.plans[n].lines.iter().map(|planned| &piece.lines[planned.number]);
        let lines = drawn.zip(&fill.lines).map(|(line, chain)| LineParticles {
            name: line.name.clone(),
            kind: line.kind.clone(),
            particles: global(chain),
        });
        PieceMesh {
            name: piece.name.clone(),
            particles: first..first + fill.points.len(),
            triangles: first_triangle..first_triangle + fill.triangles.len(),
            edges: edges.collect(),
            lines: lines.collect(),
            smallest_angle: shape::smallest_angle(&fill.points, &fill.triangles),
            warp: piece.warp,
        }
    }

    /// Pairs of every seam; a pair that repeats at a joint is kept once.
    fn stitches(&self, mesh: &ClothMesh) -> Vec<Stitches> {
        let edges: Vec<&EdgeParticles> = mesh.pieces.iter().flat_map(|p| &p.edges).collect();
        let seams = self.garment.seams.iter().zip(self.seam_links());
        let stitch = seams.map(|(seam, link)| {
            let chains = self.chain(link, 0).into_iter().zip(self.chain(link, 1));
            let particle = |(edge, k): (usize, usize)| edges[edge].particles[k];
            let mut pairs: Vec<[u32; 2]> = chains.map(|(a, b)| [particle(a), particle(b)]).collect();
            pairs.dedup();
            Stitches { name: seam.name.clone(), stage: seam.stage, pairs }
        });
        stitch.collect()
    }
}
