//! Round forms: the axis of a surface, and the lines along which it is cut into even gores.

use std::f64::consts::TAU;

use nalgebra::SymmetricEigen;

use super::line::{SurfacePoint, Web, plane_section};
use crate::geometry::{Mat3, TriMesh, Vec3, rim_loops};

/// Moments of inertia that differ by less than this share are alike: a ball has no axis of its own.
const ALIKE: f64 = 0.02;

/// A surface round an axis that it meets in a pole: a dome, a cap, a closed tube, or a ball.
#[derive(Clone, Debug)]
pub struct Round {
    /// A point of the axis.
    centre: Vec3,
    /// Its direction, a unit vector that points to the pole.
    axis: Vec3,
    /// Where the axis meets the surface: the pole and, of a closed surface, the opposite one.
    pub poles: Vec<SurfacePoint>,
    /// Smallest distance of the rim from the axis, as a share of its largest: 1 for a circle. Of a closed surface 1.
    pub evenness: f64,
    /// The point of the rim from which gores are counted; none on a closed surface.
    first: Option<Vec3>,
}

impl Round {
    /// Of a surface with one rim or none; `None` of any other, and where the axis misses it.
    pub fn of(surface: &TriMesh, web: &Web) -> Option<Self> {
        let rims = rim_loops(&surface.triangles);
        match &rims[..] {
            [] => Self::closed(surface, web),
            [rim] => Self::open(surface, web, rim),
            _ => None,
        }
    }

    /// The axis goes through the middle of the rim, upright on it.
    fn open(surface: &TriMesh, web: &Web, rim: &[u32]) -> Option<Self> {
        let at = |k: usize| surface.vertices[rim[k % rim.len()] as usize];
        let sides: Vec<(Vec3, f64)> =
            (0..rim.len()).map(|k| ((at(k) + at(k + 1)) / 2.0, (at(k + 1) - at(k)).norm())).collect();
        let length: f64 = sides.iter().map(|side| side.1).sum();
        let centre = sides.iter().map(|(middle, length)| middle * *length).sum::<Vec3>() / length;
        let turn: Vec3 = (0..surface.triangles.len()).map(|t| surface.double_normal(t)).sum();
        let axis = turn.try_normalize(f64::EPSILON * surface.area())?;
        let (_, pole) = met(surface, web, centre, axis).into_iter().max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()))?;
        let away = |p: Vec3| (p - centre) - axis * axis.dot(&(p - centre));
        let far = |v: &u32| away(surface.vertices[*v as usize]).norm();
        let largest = rim.iter().map(far).fold(0.0, f64::max);
        let smallest = rim.iter().map(far).fold(f64::INFINITY, f64::min);
        let first = first_of(surface, rim, far, smallest);
        let poles = vec![pole];
        Some(Self { centre, axis, poles, evenness: smallest / largest, first: Some(first) })
    }

    /// The axis is the principal one that differs most from the two others; upright where there is none.
    fn closed(surface: &TriMesh, web: &Web) -> Option<Self> {
        let weights: Vec<f64> = (0..surface.triangles.len()).map(|t| surface.double_normal(t).norm()).collect();
        let middle = |t: usize| surface.corners(t).iter().sum::<Vec3>() / 3.0;
        let total: f64 = weights.iter().sum();
        let centre = weights.iter().enumerate().map(|(t, w)| middle(t) * *w).sum::<Vec3>() / total;
        let spread = weights.iter().enumerate().fold(Mat3::zeros(), |sum, (t, w)| {
            let off = middle(t) - centre;
            sum + off * off.transpose() * (*w / total)
        });
        let own = SymmetricEigen::new(spread);
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| own.eigenvalues[a].total_cmp(&own.eigenvalues[b]));
        let [low, mid, high] = order.map(|k| own.eigenvalues[k]);
        let k = if mid - low > high - mid { order[0] } else { order[2] };
        let axis = if high - low < ALIKE * high { Vec3::y() } else { own.eigenvectors.column(k).normalize() };
        let axis = if axis.y < 0.0 { -axis } else { axis };
        let mut met = met(surface, web, centre, axis);
        met.sort_by(|a, b| b.0.total_cmp(&a.0));
        let poles = vec![met.first()?.1, met.last()?.1];
        (poles[0] != poles[1]).then_some(Self { centre, axis, poles, evenness: 1.0, first: None })
    }

    /// The line of constant direction number `k` of `count` even ones, from the vertex at the pole to the rim, or to
    /// the vertex at the opposite pole. `None` where it ends elsewhere.
    pub fn meridian(
        &self,
        surface: &TriMesh,
        web: &Web,
        poles: &[u32],
        k: usize,
        count: usize,
    ) -> Option<Vec<SurfacePoint>> {
        let from = *poles.first()?;
        let outward = self.first.map_or_else(|| any_across(self.axis), |p| p - self.centre);
        let outward = (outward - self.axis * self.axis.dot(&outward)).normalize();
        let (sine, cosine) = (TAU * k as f64 / count as f64).sin_cos();
        let toward = outward * cosine + self.axis.cross(&outward) * sine;
        plane_section(surface, web, self.axis.cross(&toward), from, toward, poles.get(1).copied())
    }
}

/// A direction across an axis: z as far as it is across, else x.
fn any_across(axis: Vec3) -> Vec3 {
    /// Cosine above which a direction is along the axis.
    const ALONG: f64 = 0.9;
    if axis.z.abs() < ALONG { Vec3::z() } else { Vec3::x() }
}

/// From which vertex of a rim gores are counted: the lowest of those that are nearest to the axis, and of several at
/// the back.
fn first_of(surface: &TriMesh, rim: &[u32], far: impl Fn(&u32) -> f64, smallest: f64) -> Vec3 {
    /// Distances that differ by less than this share are alike.
    const ROUND: f64 = 0.02;
    let near = rim.iter().filter(|v| far(v) <= smallest * (1.0 + ROUND));
    let lowest = near.map(|&v| surface.vertices[v as usize]).min_by(|a, b| {
        let key = |p: &Vec3| [p.y, p.z, p.x];
        let ([ay, az, ax], [by, bz, bx]) = (key(a), key(b));
        let size = smallest * ROUND;
        let coarse = |x: f64| (x / size).round();
        coarse(ay).total_cmp(&coarse(by)).then(coarse(az).total_cmp(&coarse(bz))).then(ax.total_cmp(&bx))
    });
    lowest.unwrap_or_else(Vec3::zeros)
}

/// Where a line meets the surface: how far along it, and the spot.
fn met(surface: &TriMesh, web: &Web, through: Vec3, direction: Vec3) -> Vec<(f64, SurfacePoint)> {
    let mut met = Vec::new();
    for t in 0..surface.triangles.len() {
        let [a, b, c] = surface.corners(t).map(|p| p - through);
        // Signed volumes of the line with the sides; each weight belongs to the corner opposite.
        let volumes = [(b, c), (c, a), (a, b)].map(|(p, q)| direction.dot(&p.cross(&q)));
        let sum: f64 = volumes.iter().sum();
        if sum != 0.0 && volumes.iter().all(|v| v / sum >= -1e-9) {
            let weights = volumes.map(|v| (v / sum).clamp(0.0, 1.0));
            let spot = web.on_side(surface, t as u32, weights);
            met.push((direction.dot(&(spot.place(surface) - through)), spot));
        }
    }
    met
}
