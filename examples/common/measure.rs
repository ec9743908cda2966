//! How shapes are measured and compared.

use toile::geometry::{Topology, TriMesh, Vec3};

use super::Solved;

/// A summit of a ring counts as a fold when the ring falls by this much on both sides of it, metres.
const FOLD: f64 = 2e-3;
/// Points of a ring.
const ROUND: usize = 720;

/// How much longer edges are than in the initial mesh, as shares of their length.
pub(crate) struct Strain {
    pub(crate) longest: f64,
    /// 99 % of the edges are longer or shorter by no more.
    pub(crate) p99: f64,
    pub(crate) rms: f64,
}

pub(crate) fn strain(mesh: &TriMesh, x: &[Vec3]) -> Strain {
    let length = |x: &[Vec3], [a, b]: [u32; 2]| (x[a as usize] - x[b as usize]).norm();
    let edges = Topology::new(&mesh.triangles).edges;
    let strains: Vec<f64> = edges.iter().map(|e| length(x, e.ends) / length(&mesh.vertices, e.ends) - 1.0).collect();
    let mut sizes: Vec<f64> = strains.iter().map(|s| s.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    Strain {
        longest: strains.iter().copied().fold(0.0, f64::max),
        p99: sizes[99 * (sizes.len() - 1) / 100],
        rms: (strains.iter().map(|s| s * s).sum::<f64>() / strains.len() as f64).sqrt(),
    }
}

/// Root mean square of the angle between neighbouring triangles, radians.
pub(crate) fn fold_rms(mesh: &TriMesh, x: &[Vec3]) -> f64 {
    let shape = TriMesh { vertices: x.to_vec(), triangles: mesh.triangles.clone() };
    let pairs =
        Topology::new(&mesh.triangles).edges.into_iter().filter_map(|e| Some([e.triangles[0]?, e.triangles[1]?]));
    let angles: Vec<f64> =
        pairs.map(|[s, t]| shape.double_normal(s as usize).angle(&shape.double_normal(t as usize))).collect();
    (angles.iter().map(|a| a * a).sum::<f64>() / angles.len() as f64).sqrt()
}

/// Mean height of the neighbours of lifted vertices over the lifted vertices' own: near 1 for a smooth hill, near 0
/// for a spike.
pub(crate) fn neighbours(mesh: &TriMesh, x: &[Vec3], lifted: &[u32]) -> f64 {
    let beside = |v: u32| {
        let touching = mesh.triangles.iter().filter(move |t| t.contains(&v));
        touching.flatten().filter(move |&&n| n != v).map(move |&n| x[n as usize].z / x[v as usize].z)
    };
    let mean = |v: u32| {
        let heights: Vec<f64> = beside(v).collect();
        heights.iter().sum::<f64>() / heights.len() as f64
    };
    lifted.iter().map(|&v| mean(v)).sum::<f64>() / lifted.len() as f64
}

/// Mean and largest distance between the vertices of two shapes of one mesh, metres.
pub(crate) fn apart(a: &Solved, b: &Solved) -> [f64; 2] {
    let distances = || a.x.iter().zip(&b.x).map(|(a, b)| (a - b).norm());
    [distances().sum::<f64>() / a.x.len() as f64, distances().fold(0.0, f64::max)]
}

/// A place in the triangle of a flat mesh: the triangle's corners, and the shares of the place.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    pub(crate) corners: [u32; 3],
    pub(crate) shares: [f64; 3],
}

impl Place {
    /// Where the point (`x`, `y`) of a flat sheet is in its mesh: in the triangle that it is deepest in.
    pub(crate) fn new(mesh: &TriMesh, x: f64, y: f64) -> Self {
        let at = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| mesh.vertices[v as usize].xy());
            let p = nalgebra::Vector2::new(x, y);
            let area = (b - a).perp(&(c - a));
            let shares = [(b - p).perp(&(c - p)) / area, (c - p).perp(&(a - p)) / area, (a - p).perp(&(b - p)) / area];
            Self { corners: *t, shares }
        };
        let depth = |p: &Self| p.shares.into_iter().fold(f64::INFINITY, f64::min);
        let deepest = mesh.triangles.iter().map(at).max_by(|a, b| depth(a).total_cmp(&depth(b)));
        deepest.unwrap_or(Self { corners: [0; 3], shares: [1.0, 0.0, 0.0] })
    }

    fn point(&self, x: &[Vec3]) -> Vec3 {
        self.corners.iter().zip(self.shares).map(|(&v, share)| x[v as usize] * share).sum()
    }
}

/// Points of the cloth round a place of the flat sheet.
pub(crate) struct Ring(Vec<Place>);

impl Ring {
    /// All points of the flat sheet that are `radius` metres from its point (`x`, `y`).
    pub(crate) fn new(mesh: &TriMesh, [x, y]: [f64; 2], radius: f64) -> Self {
        let angle = |k: usize| std::f64::consts::TAU * k as f64 / ROUND as f64;
        let place = |k| Place::new(mesh, x + radius * f64::cos(angle(k)), y + radius * f64::sin(angle(k)));
        Self((0..ROUND).map(place).collect())
    }

    fn heights(&self, x: &[Vec3]) -> Vec<f64> {
        self.0.iter().map(|place| place.point(x).z).collect()
    }

    /// The height of its highest point over its lowest, metres.
    pub(crate) fn depth(&self, x: &[Vec3]) -> f64 {
        let heights = self.heights(x);
        let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
        heights.iter().copied().fold(f64::NEG_INFINITY, f64::max) - lowest
    }

    /// How many folds rise from it.
    pub(crate) fn folds(&self, x: &[Vec3]) -> usize {
        folds(&self.heights(x))
    }
}

/// How often a closed line of heights rises to a summit from which it falls by [`FOLD`] on both sides.
pub(crate) fn folds(heights: &[f64]) -> usize {
    let lowest = (0..heights.len()).min_by(|&a, &b| heights[a].total_cmp(&heights[b])).unwrap_or(0);
    let (mut count, mut rising, mut turn) = (0, true, heights[lowest]);
    for k in 1..=heights.len() {
        let height = heights[(lowest + k) % heights.len()];
        let goes_on = if rising { height > turn } else { height < turn };
        if goes_on {
            turn = height;
        } else if (height - turn).abs() > FOLD {
            count += usize::from(rising);
            (rising, turn) = (!rising, height);
        }
    }
    count
}
