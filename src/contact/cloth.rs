//! Pairs of cloth primitives near each other.

use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::partitioning::{Bvh, BvhWorkspace};

use super::Contact;
use super::cloth_search::{ClothSearch, PatchPrimitives, PatchShape, Primitive};
use super::narrow::apart;
use super::neighbourhood::Neighbourhood;
use super::patches::{ClothPatch, patches};
use crate::geometry::{Vec2, Vec3};
use crate::parallel::{self, HEAVY, LIGHT, MEDIUM};

/// Largest angle between the normals of patches that count as one smooth sheet, radians. Nothing within such a sheet
/// meets before the next search.
const SMOOTH_CONE: f64 = 1.2;
/// Length of an edge, as a share of its drawn length, below which its patch is never part of a smooth sheet. Cloth that
/// is compressed in its own plane can pass through itself without turning a normal.
const SHRUNK: f64 = 0.8;

/// Finds near pairs in one garment. Triangles are grouped into patches once, in the flat pieces. The tree over the
/// patches is refitted for every search.
pub struct ClothDetector {
    triangles: Vec<[u32; 3]>,
    /// Flat corners of every triangle.
    flat: Vec<[Vec2; 3]>,
    patches: Vec<ClothPatch>,
    bvh: Bvh,
    workspace: BvhWorkspace,
    hood: Neighbourhood,
    /// Shape of every patch at the last search.
    shapes: Vec<PatchShape>,
    /// Pairs of patches near each other at the last search, without smooth sheets, sorted.
    open: Vec<(u32, u32)>,
}

impl ClothDetector {
    /// Prepares `triangles` over nodes. `flat[t]` are the flat corners of triangle t and `piece[t]` its piece.
    pub fn new(triangles: &[[u32; 3]], flat: &[[Vec2; 3]], piece: &[u32], hood: Neighbourhood) -> Self {
        Self {
            triangles: triangles.to_vec(),
            flat: flat.to_vec(),
            patches: patches(triangles, flat, piece),
            bvh: Bvh::new(),
            workspace: BvhWorkspace::default(),
            hood,
            shapes: Vec::new(),
            open: Vec::new(),
        }
    }

    /// Changes which nodes may pass through one another.
    pub fn set_passing(&mut self, passing: Vec<bool>) {
        self.hood.passing = passing;
    }

    /// Every vertex–triangle and edge–edge pair closer than `reach` at positions `x`, in an order that depends on
    /// nothing but the input.
    pub fn detect(&mut self, x: &[Vec3], reach: f64) -> Vec<Contact<'static>> {
        let mut all = vec![true; x.len()];
        self.look(x, reach, &mut all);
        self.detect_at(x, reach, &all)
    }

    /// Prepares a search at positions `x` within `reach` for the `stale` nodes. Nodes of sheets that were smooth at the
    /// last search, and no longer are, become stale as well.
    pub fn look(&mut self, x: &[Vec3], reach: f64, stale: &mut [bool]) {
        let normals = self.normals(x);
        let (mut pairs, shapes) = self.patch_pairs(x, &normals, reach);
        let smooth = parallel::map(pairs.len(), MEDIUM, |k| {
            let (a, b) = pairs[k];
            self.smooth(a as usize, b as usize, &shapes)
        });
        let mut smooth = smooth.into_iter();
        pairs.retain(|_| smooth.next() == Some(false));
        for pair @ &(a, b) in &pairs {
            let folded = self.patches[a as usize].beside.binary_search(&b).is_ok();
            if folded && self.open.binary_search(pair).is_err() {
                let both = [a, b].map(|p| &self.patches[p as usize].triangles).into_iter().flatten();
                both.flat_map(|&t| self.triangles[t as usize]).for_each(|n| stale[n as usize] = true);
            }
        }
        (self.open, self.shapes) = (pairs, shapes);
    }

    /// The pairs of [`ClothDetector::detect`] that have a `stale` node. Call [`ClothDetector::look`] first with the
    /// same arguments.
    pub fn detect_at(&self, x: &[Vec3], reach: f64, stale: &[bool]) -> Vec<Contact<'static>> {
        let find = ClothSearch { hood: &self.hood, shapes: &self.shapes, x, reach, parts: self.parts(x, stale) };
        let mut pairs = self.open.clone();
        pairs.retain(|&(a, b)| [a, b].iter().any(|p| find.parts[*p as usize].triangles.iter().any(|t| t.stale)));
        let found = parallel::map(pairs.len(), HEAVY, |k| find.pair(pairs[k].0 as usize, pairs[k].1 as usize));
        found.concat()
    }

    /// The primitives of every patch at positions `x`. Those with a `stale` node are searched.
    fn parts(&self, x: &[Vec3], stale: &[bool]) -> Vec<PatchPrimitives> {
        let part = |patch: &ClothPatch| PatchPrimitives {
            vertices: patch.nodes.iter().map(|&n| Primitive::new([n], x, stale)).collect(),
            edges: patch.edges.iter().map(|&e| Primitive::new(e, x, stale)).collect(),
            triangles: (patch.triangles.iter().map(|&t| Primitive::new(self.triangles[t as usize], x, stale)))
                .collect(),
        };
        parallel::map(self.patches.len(), HEAVY, |k| part(&self.patches[k]))
    }

    fn normals(&self, x: &[Vec3]) -> Vec<Vec3> {
        let normal = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|n| x[n as usize]);
            (b - a).cross(&(c - a)).try_normalize(1e-300).unwrap_or_default()
        };
        parallel::map(self.triangles.len(), LIGHT, |k| normal(&self.triangles[k]))
    }

    /// Pairs of patches whose boxes come within `reach`, every patch with itself, sorted.
    fn patch_pairs(&mut self, x: &[Vec3], normals: &[Vec3], reach: f64) -> (Vec<(u32, u32)>, Vec<PatchShape>) {
        let shapes = parallel::map(self.patches.len(), HEAVY, |k| self.measure(&self.patches[k], x, normals));
        let half = 0.5 * reach;
        for (i, PatchShape { low, high, .. }) in shapes.iter().enumerate() {
            let aabb = Aabb::new(low.add_scalar(-half).into(), high.add_scalar(half).into());
            self.bvh.insert_or_update_partially(aabb, i as u32, 0.0);
        }
        self.bvh.refit(&mut self.workspace);
        let mut pairs: Vec<(u32, u32)> = (0..self.patches.len() as u32).map(|i| (i, i)).collect();
        self.bvh.traverse_bvtt_single_tree::<false>(&mut self.workspace, &mut |a, b| {
            pairs.push((a.min(b), a.max(b)));
        });
        pairs.sort_unstable();
        (pairs, shapes)
    }

    /// Edges and triangles whose patches' boxes overlap and that share no node.
    pub(super) fn touching(&mut self, x: &[Vec3]) -> Vec<([u32; 2], [u32; 3])> {
        let normals = self.normals(x);
        let (pairs, _) = self.patch_pairs(x, &normals, 0.0);
        let parts = self.parts(x, &vec![true; x.len()]);
        let near = |p: &PatchPrimitives, q: &PatchPrimitives| {
            let mut out = Vec::new();
            for e in &p.edges {
                for t in &q.triangles {
                    let shared = e.nodes.iter().any(|n| t.nodes.contains(n));
                    if !shared && !apart(e.low, e.high, t.low, t.high) {
                        out.push((e.nodes, t.nodes));
                    }
                }
            }
            out
        };
        let both = |&(a, b): &(u32, u32)| {
            let (p, q) = (&parts[a as usize], &parts[b as usize]);
            let mut out = near(p, q);
            if a != b {
                out.extend(near(q, p));
            }
            out
        };
        parallel::map(pairs.len(), HEAVY, |k| both(&pairs[k])).concat()
    }

    fn measure(&self, patch: &ClothPatch, x: &[Vec3], normals: &[Vec3]) -> PatchShape {
        let mut low = Vec3::repeat(f64::INFINITY);
        let mut high = -low;
        let mut axis = Vec3::zeros();
        let mut shrunk = false;
        for &t in &patch.triangles {
            let at = self.triangles[t as usize].map(|n| x[n as usize]);
            for (corner, next) in [(0, 1), (1, 2), (2, 0)] {
                low = low.inf(&at[corner]);
                high = high.sup(&at[corner]);
                let flat = self.flat[t as usize];
                let drawn = (flat[corner] - flat[next]).norm_squared();
                shrunk |= (at[corner] - at[next]).norm_squared() < SHRUNK * SHRUNK * drawn;
            }
            axis += normals[t as usize];
        }
        let axis = axis.try_normalize(1e-9).unwrap_or_default();
        let cosine = patch.triangles.iter().map(|&t| axis.dot(&normals[t as usize])).fold(1.0, f64::min);
        PatchShape { low, high, axis, spread: cosine.clamp(-1.0, 1.0).acos(), shrunk }
    }

    /// Whether two patches are one smooth sheet: they touch, their normals are alike, and neither is compressed.
    fn smooth(&self, a: usize, b: usize, shapes: &[PatchShape]) -> bool {
        let (p, q) = (&self.patches[a], &self.patches[b]);
        if p.piece != q.piece {
            return false;
        }
        let (sa, sb) = (&shapes[a], &shapes[b]);
        if sa.shrunk || sb.shrunk || p.slit || q.slit {
            return false;
        }
        let between = sa.axis.dot(&sb.axis).clamp(-1.0, 1.0).acos();
        if between + sa.spread + sb.spread > SMOOTH_CONE {
            return false;
        }
        // Both sides of a dart are near each other in the flat piece, and may slide over each other.
        p.beside.binary_search(&(b as u32)).is_ok()
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::*;
    use crate::contact::closest_on_triangle;

    /// Two parallel square sheets of n×n cells, `gap` apart, as two pieces.
    type Sheets = (Vec<Vec3>, Vec<[u32; 3]>, Vec<[Vec2; 3]>, Vec<u32>);

    fn sheets(n: u32, h: f64, gap: f64) -> Sheets {
        let (mut x, mut triangles, mut flat, mut piece) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for sheet in 0..2u32 {
            let base = x.len() as u32;
            for j in 0..=n {
                for i in 0..=n {
                    x.push(Vec3::new(f64::from(i) * h + 0.001, f64::from(sheet) * gap, f64::from(j) * h));
                }
            }
            for j in 0..n {
                for i in 0..n {
                    let a = base + j * (n + 1) + i;
                    for tri in [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]] {
                        triangles.push(tri);
                        flat.push(tri.map(|v| Vec2::new(x[v as usize].x, x[v as usize].z)));
                        piece.push(sheet);
                    }
                }
            }
        }
        (x, triangles, flat, piece)
    }

    fn detector(x: &[Vec3], t: &[[u32; 3]], f: &[[Vec2; 3]], p: &[u32]) -> ClothDetector {
        let hood = Neighbourhood { class: (0..x.len() as u32).collect(), passing: Vec::new() };
        ClothDetector::new(t, f, p, hood)
    }

    #[test]
    fn a_flat_sheet_has_no_contact_with_itself_and_two_near_sheets_have() {
        let (x, t, f, p) = sheets(12, 0.01, 0.1);
        // As far as the triangles are high: what lies further apart may be no neighbour.
        assert!(detector(&x, &t, &f, &p).detect(&x, 0.007).is_empty());
        let (x, t, f, p) = sheets(12, 0.01, 0.005);
        let contacts = detector(&x, &t, &f, &p).detect(&x, 0.008);
        // Every vertex of one sheet sees the triangle straight above it.
        for v in 0..169u32 {
            assert!(contacts.iter().any(|c| c.nodes[0] == v && c.weights[0] == 1.0), "vertex {v}");
        }
        assert!(contacts.iter().all(|c| (c.gap(&x) - 0.005).abs() < 0.0031));
    }

    #[test]
    fn the_outer_layers_of_a_fold_in_three_touch_though_their_normals_agree() {
        // One strip of 3 × 12 cells, folded back and forth after every row of cells, 1 mm from layer to layer.
        let (h, gap) = (0.01, 0.001);
        let (mut x, mut flat_at) = (Vec::new(), Vec::new());
        for j in 0..4u32 {
            for i in 0..=12u32 {
                let there = f64::from(j % 2) * h;
                x.push(Vec3::new(f64::from(i) * h, f64::from(j) * gap, there + 0.001 * f64::from(i % 3)));
                flat_at.push(Vec2::new(f64::from(i), f64::from(j)) * h);
            }
        }
        let mut t = Vec::new();
        for j in 0..3u32 {
            for i in 0..12u32 {
                let a = j * 13 + i;
                t.extend([[a, a + 1, a + 14], [a, a + 14, a + 13]]);
            }
        }
        let f: Vec<[Vec2; 3]> = t.iter().map(|t| t.map(|v| flat_at[v as usize])).collect();
        let contacts = detector(&x, &t, &f, &vec![0; t.len()]).detect(&x, 0.008);
        // Row 1 of the first layer lies under rows 2 and 3 of the third.
        for v in 14..25u32 {
            let third = |c: &&Contact| c.nodes[0] == v && c.above == 1 && c.nodes[1..].iter().all(|&n| n >= 26);
            assert!(contacts.iter().any(|c| third(&c)), "vertex {v}");
        }
    }

    #[test]
    fn the_ends_of_a_band_sewn_together_at_one_corner_touch_like_two_pieces() {
        // Within reach of each other are only the two sheets: a triangle is higher.
        let reach = 0.0069;
        let (x, t, f, p) = sheets(12, 0.01, 0.005);
        let corner = [0, 169];
        let pairs = |contacts: Vec<Contact>| {
            let others = contacts.into_iter().filter(|c| corner.iter().all(|n| !c.nodes.contains(n)));
            let mut pairs: Vec<([u32; 4], u8)> = others.map(|c| (c.nodes, c.above)).collect();
            pairs.sort_unstable();
            pairs
        };
        let apart = pairs(detector(&x, &t, &f, &p).detect(&x, reach));
        // As ends of one band, a metre from each other in the flat, whose corners are one node.
        let (mut ends, mut drawn) = (t, f);
        for (t, f) in ends.iter_mut().zip(&mut drawn).skip(288) {
            f.iter_mut().for_each(|at| at.x += 1.0);
            t.iter_mut().filter(|n| **n == corner[1]).for_each(|n| *n = corner[0]);
        }
        let band = pairs(detector(&x, &ends, &drawn, &vec![0; p.len()]).detect(&x, reach));
        assert!(apart.len() > 300);
        assert_eq!(apart, band);
    }

    #[test]
    fn the_sides_of_a_slit_touch_up_to_its_end() {
        let (n, h) = (12u32, 0.01);
        let (mut x, mut t, mut f, mut p) = sheets(n, h, 0.1);
        let middle = |v: u32| v % (n + 1) == n / 2 && v / (n + 1) <= n / 2 && v < (n + 1) * (n + 1);
        // The first sheet is slit along its middle from one rim to its centre, and what lies beyond moved over 1 mm.
        let tip = (n / 2) * (n + 1) + n / 2;
        let mut twin: HashMap<u32, u32> = HashMap::new();
        for tri in &mut t {
            let beyond = tri.iter().all(|v| v % (n + 1) >= n / 2);
            for v in tri.iter_mut().filter(|v| beyond && middle(**v) && **v != tip) {
                let next = x.len() as u32;
                let at = x[*v as usize];
                *v = *twin.entry(*v).or_insert(next);
                if *v == next {
                    x.push(at + Vec3::x() * 1e-3);
                }
            }
        }
        f.iter_mut().zip(&t).for_each(|(f, t)| *f = t.map(|v| Vec2::new(x[v as usize].x, x[v as usize].z)));
        p.truncate(t.len());
        let contacts = detector(&x, &t, &f, &p).detect(&x, 0.003);
        for (left, right) in twin.iter().filter(|(left, _)| tip - **left > n + 1) {
            let meets = |c: &Contact| c.nodes.contains(left) && c.nodes.contains(right);
            assert!(contacts.iter().any(meets), "{left} does not meet {right}");
        }
        assert_eq!(twin.len(), n as usize / 2);
    }

    #[test]
    fn a_search_at_some_nodes_finds_all_their_pairs_and_no_others() {
        let (x, t, f, p) = sheets(12, 0.01, 0.005);
        let reach = 0.008;
        let mut detector = detector(&x, &t, &f, &p);
        let all = detector.detect(&x, reach);
        let mut stale: Vec<bool> = (0..x.len()).map(|n| n % 17 == 3 || (40..60).contains(&n)).collect();
        let asked = stale.clone();
        detector.look(&x, reach, &mut stale);
        assert_eq!(stale, asked, "nothing has turned");
        let keys = |contacts: &[Contact]| {
            let mut keys: Vec<([u32; 4], u8)> = contacts.iter().map(|c| (c.nodes, c.above)).collect();
            keys.sort_unstable();
            keys
        };
        let expected: Vec<Contact> =
            all.iter().filter(|c| c.nodes.iter().any(|&n| stale[n as usize])).copied().collect();
        assert!(expected.len() > 300 && expected.len() < all.len());
        assert_eq!(keys(&detector.detect_at(&x, reach, &stale)), keys(&expected));
    }

    #[test]
    fn a_sheet_that_folds_is_searched_though_no_node_of_it_was_to_be() {
        let (mut x, t, f, p) = sheets(12, 0.01, 0.1);
        let mut detector = detector(&x, &t, &f, &p);
        assert!(detector.detect(&x, 0.007).is_empty());
        // The first sheet is bent along its middle, until its halves lie on one another.
        for v in x.iter_mut().take(169).filter(|v| v.x > 0.061) {
            *v = Vec3::new(0.122 - v.x, 0.004, v.z);
        }
        let mut stale = vec![false; x.len()];
        detector.look(&x, 0.007, &mut stale);
        assert!(stale[..169].iter().any(|s| *s) && stale[169..].iter().all(|s| !s));
        let found = detector.detect_at(&x, 0.007, &stale);
        assert!(found.iter().any(|c| c.above == 1 && (c.gap(&x) - 0.004).abs() < 1e-9));
    }

    #[test]
    fn every_pair_within_reach_is_found_whatever_the_grouping() {
        let (mut x, t, f, p) = sheets(9, 0.01, 0.006);
        for (i, v) in x.iter_mut().enumerate() {
            v.y += 0.002 * ((i * 7919 % 101) as f64 / 101.0 - 0.5);
        }
        let contacts = detector(&x, &t, &f, &p).detect(&x, 0.008);
        let mut expected = 0;
        for v in 0..x.len() as u32 {
            for (k, tri) in t.iter().enumerate() {
                if p[k] == u32::from(v >= 100) {
                    continue;
                }
                let [a, b, c] = tri.map(|n| x[n as usize]);
                let w = closest_on_triangle(x[v as usize], a, b, c);
                expected += usize::from((x[v as usize] - a * w[0] - b * w[1] - c * w[2]).norm() < 0.008);
            }
        }
        // Within a sheet neighbours are near each other, too.
        let between = |c: &&Contact| c.above == 1 && (c.nodes[0] < 100) != (c.nodes[1] < 100);
        assert_eq!(contacts.iter().filter(between).count(), expected);
    }
}
