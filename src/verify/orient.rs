//! Exact decision on which side of a plane a point lies.
//!
//! Most answers come from plain arithmetic with a proven error bound. Where rounding could decide, the determinant is
//! added up again without any rounding, as a sum of non-overlapping floating-point numbers (an *expansion*, after
//! Shewchuk, "Adaptive Precision Floating-Point Arithmetic", 1997).

use crate::geometry::Vec3;

/// Half a unit in the last place of 1.0.
const ROUNDING: f64 = f64::EPSILON / 2.0;

/// Relative error of the plain determinant against the sum of its absolute products (Shewchuk's bound for `orient3d`).
const PLAIN_ERROR: f64 = (7.0 + 56.0 * ROUNDING) * ROUNDING;

/// The side of the plane through `a`, `b`, `c` on which `d` lies: `1` where the three run clockwise seen from `d`,
/// `-1` on the other side, `0` exactly in the plane. Exact unless a product of coordinates over- or underflows.
pub(super) fn orient(a: &Vec3, b: &Vec3, c: &Vec3, d: &Vec3) -> i8 {
    let (ad, bd, cd) = (a - d, b - d, c - d);
    let minors = [(bd.x, cd.y, cd.x, bd.y), (cd.x, ad.y, ad.x, cd.y), (ad.x, bd.y, bd.x, ad.y)];
    let heights = [ad.z, bd.z, cd.z];
    let (mut det, mut size) = (0.0, 0.0);
    for ((p, q, r, s), z) in minors.into_iter().zip(heights) {
        det += z * (p * q - r * s);
        size += z.abs() * ((p * q).abs() + (r * s).abs());
    }
    if det.abs() > PLAIN_ERROR * size { sign(det) } else { orient_exactly(a, b, c, d) }
}

/// The same sign without rounding.
#[cold]
fn orient_exactly(a: &Vec3, b: &Vec3, c: &Vec3, d: &Vec3) -> i8 {
    let difference = |p: &Vec3, k: usize| Expansion::difference(p[k], d[k]);
    let [ax, ay, az] = [0, 1, 2].map(|k| difference(a, k));
    let [bx, by, bz] = [0, 1, 2].map(|k| difference(b, k));
    let [cx, cy, cz] = [0, 1, 2].map(|k| difference(c, k));
    let minor = |p: &Expansion, q: &Expansion, r: &Expansion, s: &Expansion| p.times(q).minus(&r.times(s));
    let mut det = az.times(&minor(&bx, &cy, &cx, &by));
    det.add(&bz.times(&minor(&cx, &ay, &ax, &cy)));
    det.add(&cz.times(&minor(&ax, &by, &bx, &ay)));
    det.sign()
}

fn sign(x: f64) -> i8 {
    i8::from(x > 0.0) - i8::from(x < 0.0)
}

/// A number as the exact sum of floating-point terms, smallest first, none zero, no two overlapping.
#[derive(Clone, Debug, Default)]
struct Expansion(Vec<f64>);

impl Expansion {
    /// `a - b`.
    fn difference(a: f64, b: f64) -> Self {
        let mut out = Self::default();
        out.add_term(a);
        out.add_term(-b);
        out
    }

    fn add_term(&mut self, term: f64) {
        let mut carried = term;
        let mut kept = 0;
        for k in 0..self.0.len() {
            let (sum, rest) = exact_sum(carried, self.0[k]);
            if rest != 0.0 {
                self.0[kept] = rest;
                kept += 1;
            }
            carried = sum;
        }
        self.0.truncate(kept);
        if carried != 0.0 {
            self.0.push(carried);
        }
    }

    fn add(&mut self, other: &Self) {
        for &term in &other.0 {
            self.add_term(term);
        }
    }

    fn minus(mut self, other: &Self) -> Self {
        for &term in &other.0 {
            self.add_term(-term);
        }
        self
    }

    fn times(&self, other: &Self) -> Self {
        let mut out = Self::default();
        for &x in &self.0 {
            for &y in &other.0 {
                let (product, rest) = exact_product(x, y);
                out.add_term(rest);
                out.add_term(product);
            }
        }
        out
    }

    /// The largest term outweighs all others together.
    fn sign(&self) -> i8 {
        self.0.last().map_or(0, |&x| sign(x))
    }
}

/// The rounded sum and what rounding took away.
fn exact_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_seen = sum - a;
    (sum, (a - (sum - b_seen)) + (b - b_seen))
}

/// The rounded product and what rounding took away.
fn exact_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    (product, a.mul_add(b, -product))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_three_sides() {
        let [a, b, c] = [Vec3::new(0.0, 0.0, 0.0), Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0)];
        assert_eq!(orient(&a, &b, &c, &Vec3::new(0.2, 0.2, -1.0)), 1);
        assert_eq!(orient(&a, &b, &c, &Vec3::new(0.2, 0.2, 1.0)), -1);
        assert_eq!(orient(&a, &b, &c, &Vec3::new(7.0, -3.0, 0.0)), 0);
    }

    /// Four whole points all but on one line, so that the plain determinant is wrong about many of them, against whole
    /// numbers.
    #[test]
    fn rounding_never_decides() {
        let mut state = 1u64;
        let mut random = |size: i128| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            i128::from(state >> 33) % (2 * size + 1) - size
        };
        let mut signs = [0; 3];
        for _ in 0..20_000 {
            let (from, way) = ([0; 3].map(|_: i128| random(1 << 30)), [0; 3].map(|_: i128| random(1 << 30)));
            let points: Vec<[i128; 3]> =
                (0..4).map(|step| [0, 1, 2].map(|k| from[k] + step * way[k] + random(1))).collect();
            let [a, b, c, d] = [0, 1, 2, 3].map(|i| Vec3::from(points[i].map(|x| x as f64)));
            let to = |i: usize| [0, 1, 2].map(|k| points[i][k] - points[3][k]);
            let ([ax, ay, az], [bx, by, bz], [cx, cy, cz]) = (to(0), to(1), to(2));
            let det = az * (bx * cy - cx * by) + bz * (cx * ay - ax * cy) + cz * (ax * by - bx * ay);
            assert_eq!(i128::from(orient(&a, &b, &c, &d)), det.signum(), "{points:?}");
            signs[(det.signum() + 1) as usize] += 1;
        }
        assert!(signs.iter().all(|&count| count > 100), "{signs:?}");
    }
}
