//! Puts filled pieces together and pairs the particles of the seams.

use super::fill::Fill;
use super::frame::PieceFrame;
use super::layout::MeshLayout;
use super::{ClothMesh, EdgeParticles, LineParticles, PieceMesh, Stitches, shape};

impl MeshLayout<'_> {
    /// The mesh of all pieces, in the garment's order.
    pub(super) fn assemble(&self, fills: Vec<(PieceFrame, Fill)>) -> ClothMesh {
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
    fn piece_mesh(&self, n: usize, frame: &PieceFrame, fill: &Fill, first: usize, first_triangle: usize) -> PieceMesh {
        let piece = &self.garment.pieces[n];
        let global = |chain: &[u32]| chain.iter().map(|v| v + first as u32).collect::<Vec<_>>();
        let ids = &self.edges.ids[self.first_edge(n)..];
        let edges = ids.iter().zip(&frame.edges).map(|(&edge, chain)| EdgeParticles {
            edge,
            name: piece.loops[edge.ring][edge.index].name.clone(),
            particles: global(chain),
        });
        let lines = self.line_chains(n, frame, fill).into_iter().map(|(number, name, chain)| LineParticles {
            name,
            kind: piece.lines[number].kind.clone(),
            particles: global(&chain),
        });
        PieceMesh {
            name: piece.name.clone(),
            particles: first..first + fill.points.len(),
            triangles: first_triangle..first_triangle + fill.triangles.len(),
            edges: edges.collect(),
            lines: lines.collect(),
            smallest_angle: shape::smallest_angle(&fill.points, &fill.triangles),
            warp: piece.warp,
            narrow: self.fineness[n].narrow,
        }
    }

    /// Number, name and particles of every part of the lines of piece `n`, in the lines' order.
    fn line_chains(&self, n: usize, frame: &PieceFrame, fill: &Fill) -> Vec<(usize, String, Vec<u32>)> {
        let (plan, first) = (&self.plans[n], self.first_edge(n));
        let across = plan.lines.iter().zip(&fill.lines).map(|(line, chain)| (line.number, line.at, chain.clone()));
        let along = plan.rim.iter().map(|line| {
            let places = self.rim_chain(line).into_iter();
            let mut chain: Vec<u32> = places.map(|(edge, k)| frame.edges[edge - first][k]).collect();
            chain.dedup();
            (line.number, line.at, chain)
        });
        let mut parts: Vec<_> = across.chain(along).collect();
        parts.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let numbers: Vec<usize> = parts.iter().map(|part| part.0).collect();
        let name = |k: usize, number: usize| {
            let name = self.garment.pieces[n].lines[number].name.clone();
            let before = numbers[..k].iter().filter(|&&other| other == number).count();
            let alone = numbers.iter().filter(|&&other| other == number).count() == 1;
            if alone { name } else { format!("{name}.{}", before + 1) }
        };
        parts.into_iter().enumerate().map(|(k, (number, _, chain))| (number, name(k, number), chain)).collect()
    }

    /// Pairs of every seam. A pair that repeats at a joint is kept once.
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
