//! Godets: pieces in slits of others, which start where they will be, a little over the edges of the slit. Those that
//! are wider than the room for them, and would lie over one another, start folded in half and stand out like fins.
//!
//! ```text
//!    ─┐    ╭────────╮    ┌─              │╲ ╱│    fold
//!     │slit│ godet  │slit│     ─▶        │ V │    outward
//!    ─┘    ╰────────╯    └─      ────────┘   └────────  host
//! ```

use super::assign::Assigned;
use super::fold::FoldedPieces;
use super::ring::LAYER;
use super::rows::{Link, Member, ROOM, extent};
use crate::geometry::{Vec2, Vec3, range_of};
use crate::mesh::ClothMesh;
use crate::pattern::Garment;

/// Slits that are cut without width have sides at one u; rounding must not make a tube of them.
const IN_SLIT: f64 = 0.1;

/// A godet has less than this share of its host's triangles where nothing else says which of the two it is.
const GODET: f64 = 0.5;
/// Two links run down opposite sides of a piece where their means are apart by more than this share of its width.
const SIDES_APART: f64 = 0.25;

/// A piece in a slit of another one.
#[derive(Clone, Debug)]
pub(super) struct Insert {
    pub(super) own: Member,
    /// Number of the member it lies in.
    pub(super) host: usize,
    /// How it stands out, if it has no room to lie flat.
    fin: Option<Fin>,
}

impl Insert {
    /// Where a point of the piece starts, given in row positions; `on` puts such a point on the ring, so far off it.
    pub(super) fn start(&self, at: Vec2, on: impl Fn(Vec2, f64) -> Vec3) -> Vec3 {
        let shift = self.own.shift;
        match &self.fin {
            None => on(at, LAYER),
            Some(fin) => fin.folded(at - shift, |at, off| on(at + shift, off + LAYER)),
        }
    }
}

/// A godet folded in half along its middle.
#[derive(Clone, Debug)]
struct Fin {
    /// Its middle, u of the flat piece.
    middle: f64,
    /// Its left and its right side, downward.
    sides: [Vec<Rib>; 2],
}

/// A fin at one height.
#[derive(Clone, Copy, Debug)]
struct Rib {
    /// The v of the flat piece.
    v: f64,
    /// From the middle to the side, metres.
    wide: f64,
    /// From the middle of the slit to its edge, metres.
    open: f64,
}

impl Fin {
    /// The fin that a piece makes, sewn by these pairs: its own particle's flat position, and its partner's, moved so
    /// that the slit is where the piece is. Without pairs on both sides there is none.
    fn new(pairs: &[[Vec2; 2]]) -> Option<Self> {
        let [low, high] = range_of(pairs.iter().map(|p| p[0].x));
        let middle = 0.5 * (low + high);
        let side = |sign: f64| {
            let own = pairs.iter().filter(|[own, _]| (own.x - middle) * sign > 0.0);
            let rib = |[own, host]: &[Vec2; 2]| {
                let open = (sign * (host.x - middle)).max(0.0);
                Rib { v: own.y, wide: sign * (own.x - middle), open }
            };
            let mut ribs: Vec<Rib> = own.map(rib).collect();
            ribs.sort_by(|a, b| a.v.total_cmp(&b.v));
            ribs
        };
        let sides = [side(-1.0), side(1.0)];
        sides.iter().all(|side| !side.is_empty()).then_some(Self { middle, sides })
    }

    /// Where a point of the flat piece starts: at every height the piece is a V whose arms are as long as the cloth is
    /// wide and end at the edges of the slit; `on` puts points of the flat piece on the ring, so far off it.
    fn folded(&self, at: Vec2, on: impl Fn(Vec2, f64) -> Vec3) -> Vec3 {
        let u = at.x - self.middle;
        let ribs = [0, 1].map(|side| rib_at(&self.sides[side], at.y));
        // Edges of a slit without width start a little apart, as neighbours do.
        let open = ribs.map(|rib| rib.open.max(0.5 * ROOM).min(rib.wide));
        let edges = [-open[0], open[1]].map(|u| on(Vec2::new(self.middle + u, at.y), 0.0));
        let middle = |off: f64| on(Vec2::new(self.middle, at.y), off);
        let outward = middle(1.0) - middle(0.0);
        let (chord, wide) = (0.5 * (edges[1] - edges[0]).norm(), 0.5 * (ribs[0].wide + ribs[1].wide));
        let fold = 0.5 * (edges[0] + edges[1]) + outward * (wide.powi(2) - chord.powi(2)).max(0.0).sqrt();
        // A ring may be further out than the straight way between the edges.
        let fold = if (fold - middle(0.0)).dot(&outward) > 0.0 { fold } else { middle(0.0) };
        let side = usize::from(u > 0.0);
        let share = if ribs[side].wide > 0.0 { (u.abs() / ribs[side].wide).min(1.0) } else { 1.0 };
        fold.lerp(&edges[side], share)
    }
}

/// A side between its ribs, and beyond the last of them as there.
fn rib_at(ribs: &[Rib], v: f64) -> Rib {
    let next = ribs.partition_point(|rib| rib.v < v);
    match (next.checked_sub(1).map(|k| ribs[k]), ribs.get(next)) {
        (Some(a), Some(&b)) if b.v > a.v => {
            let t = (v - a.v) / (b.v - a.v);
            let mix = |a: f64, b: f64| a + t * (b - a);
            Rib { v, wide: mix(a.wide, b.wide), open: mix(a.open, b.open) }
        }
        (Some(rib), _) => rib,
        (None, Some(&rib)) => rib,
        (None, None) => Rib { v, wide: 0.0, open: 0.0 },
    }
}

/// Where a piece lies in a slit of another one: the host, and the shift against it. It is sewn to nothing else, along
/// both its sides, and its left to the left side of the slit. (Of two pieces that make a tube the left of one meets the
/// right of the other.)
pub(super) fn slit(
    links: &[Link],
    sheet: &FoldedPieces,
    assigned: &[Assigned],
    garment: &Garment,
    piece: usize,
) -> Option<(usize, Vec2)> {
    let own: Vec<&Link> = links.iter().filter(|l| !l.through && l.pieces.contains(&piece)).collect();
    let side = |l: &Link| usize::from(l.pieces[1] == piece);
    let host = own.first().map(|l| l.pieces[1 - side(l)])?;
    let together = |p: usize| (assigned[p].part, garment.pieces[p].level());
    let upright = own.iter().all(|l| l.upright && l.pieces.contains(&host));
    if !upright || together(host) != together(piece) || !goes_round(&own, sheet, side) {
        return None;
    }
    let pairs: Vec<[Vec2; 2]> = own
        .iter()
        .flat_map(|l| l.pairs.iter().map(|pair| [side(l), 1 - side(l)].map(|k| sheet.flat[pair[k] as usize])))
        .collect();
    let mean = |k: usize| pairs.iter().map(|pair| pair[k]).sum::<Vec2>() / pairs.len() as f64;
    let means = [mean(0), mean(1)];
    let [spread, common] =
        [0, 1].map(|k| pairs.iter().map(|p| (p[0].x - means[0].x) * (p[k].x - means[k].x)).sum::<f64>());
    (common > -IN_SLIT * spread).then_some((host, means[1] - means[0]))
}

/// Pieces in slits with their hosts. A piece that is sewn to nothing but its godet could as well lie in that: the much
/// smaller of the two is the godet. (Of two panels sewn right to right neither is, and they find no place.) What lies
/// in a godet stands beside it instead.
pub(super) fn hosted(
    mut slits: Vec<Option<(usize, Vec2)>>,
    area: impl Fn(usize) -> usize,
) -> Vec<Option<(usize, Vec2)>> {
    let host = |slits: &[Option<(usize, Vec2)>], p: usize| slits[p].map(|slit| slit.0);
    for p in 0..slits.len() {
        if let Some(other) = host(&slits, p)
            && host(&slits, other) == Some(p)
        {
            let [own, others] = [p, other].map(|p| area(p) as f64);
            if own < GODET * others {
                slits[other] = None;
            } else if others < GODET * own {
                slits[p] = None;
            }
        }
    }
    let hosts = slits.clone();
    let mutual = |p: usize, other: usize| host(&hosts, other) == Some(p);
    for (p, slit) in slits.iter_mut().enumerate() {
        *slit = slit.filter(|s| hosts[s.0].is_none() || mutual(p, s.0));
    }
    slits
}

/// Whether links run down one side of a piece and up the other: one that turns, or one on either side.
fn goes_round(own: &[&Link], sheet: &FoldedPieces, side: impl Fn(&Link) -> usize) -> bool {
    let at = |l: &Link, n: usize| sheet.flat[l.pairs[n][side(l)] as usize];
    match own {
        [one] => {
            let [first, middle, last] = [0, one.pairs.len() / 2, one.pairs.len() - 1].map(|n| at(one, n).y);
            (first - last).abs() < 0.5 * (0.5 * (first + last) - middle).abs()
        }
        [one, other] => {
            let xs = |l: &Link| (0..l.pairs.len()).map(|n| at(l, n).x).collect::<Vec<f64>>();
            let (a, b) = (xs(one), xs(other));
            let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
            let [low, high] = range_of(a.iter().chain(&b).copied());
            (mean(&a) - mean(&b)).abs() > SIDES_APART * (high - low)
        }
        _ => false,
    }
}

/// The pieces in slits of these members, each put into its slit: flat, or folded if it would lie over another one or
/// beyond its host.
pub(super) fn inserts(
    mesh: &ClothMesh,
    sheet: &FoldedPieces,
    links: &[Link],
    members: &[Member],
    hosts: &[Option<(usize, Vec2)>],
) -> Vec<Insert> {
    let lies = |(piece, host): (usize, &Option<(usize, Vec2)>)| {
        let (in_piece, shift) = (*host)?;
        let host = members.iter().position(|m| m.piece == in_piece)?;
        Some(Insert { own: Member { piece, shift: members[host].shift + shift }, host, fin: None })
    };
    let mut all: Vec<Insert> = hosts.iter().enumerate().filter_map(lies).collect();
    let span = |m: &Member| extent(mesh, sheet, m.piece).map(|corner| corner.x + m.shift.x);
    let spans: Vec<[f64; 2]> = all.iter().map(|insert| span(&insert.own)).collect();
    let crowded = |k: usize| {
        let ([low, high], host) = (spans[k], span(&members[all[k].host]));
        let meets = |l: usize| l != k && all[l].host == all[k].host && spans[l][0] < high && low < spans[l][1];
        low < host[0] || host[1] < high || (0..all.len()).any(meets)
    };
    let folded: Vec<usize> = (0..all.len()).filter(|&k| crowded(k)).collect();
    for k in folded {
        let (own, host) = (all[k].own, members[all[k].host]);
        let shift = host.shift - own.shift;
        let sewn = links.iter().filter(|l| !l.through && l.pieces.contains(&own.piece)).flat_map(|l| {
            let side = usize::from(l.pieces[1] == own.piece);
            l.pairs
                .iter()
                .map(move |pair| [sheet.flat[pair[side] as usize], sheet.flat[pair[1 - side] as usize] + shift])
        });
        all[k].fin = Fin::new(&sewn.collect::<Vec<[Vec2; 2]>>());
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// A godet 200 mm high, 60 mm wide at its foot, round u = 1; its slit is 20 mm wide there.
    fn fin() -> Fin {
        let pair = |sign: f64, share: f64| [0.03, 0.01].map(|half| Vec2::new(1.0 + sign * share * half, 0.2 * share));
        let pairs: Vec<[Vec2; 2]> =
            [-1.0, 1.0].iter().flat_map(|&s| [0.1, 0.5, 1.0].map(|share| pair(s, share))).collect();
        Fin::new(&pairs).expect("a fin")
    }

    #[test]
    fn a_fin_keeps_the_width_of_its_cloth_and_ends_at_the_slit() {
        // On a ring of radius 0.2 m round the y axis.
        let on = |at: Vec2, off: f64| {
            let angle = (at.x - 1.0) / 0.2;
            Vec3::new(angle.sin(), 0.0, angle.cos()) * (0.2 + off) - Vec3::y() * at.y
        };
        let fin = fin();
        let at = |u: f64, v: f64| fin.folded(Vec2::new(u, v), on);
        let (left, fold, right) = (at(0.97, 0.2), at(1.0, 0.2), at(1.03, 0.2));
        assert_relative_eq!(left, on(Vec2::new(0.99, 0.2), 0.0), epsilon = 1e-12);
        assert_relative_eq!(right, on(Vec2::new(1.01, 0.2), 0.0), epsilon = 1e-12);
        assert_relative_eq!((fold - left).norm(), 0.03, epsilon = 1e-12);
        assert_relative_eq!((fold - right).norm(), 0.03, epsilon = 1e-12);
        assert!(fold.z > 0.2, "it stands out: {fold:?}");
        // Half way up it is half as wide; beyond the ends it is as there.
        assert_relative_eq!((at(1.0, 0.1) - at(0.985, 0.1)).norm(), 0.015, epsilon = 1e-12);
        assert_relative_eq!(at(1.0, 0.3) + Vec3::y() * 0.1, fold, epsilon = 1e-12);
    }

    #[test]
    fn a_fin_needs_two_sides() {
        let one_side = [0.1, 0.2].map(|v| [Vec2::new(0.0, v), Vec2::new(0.0, v)]);
        assert!(Fin::new(&one_side).is_none());
    }

    #[test]
    fn of_two_that_could_lie_in_each_other_the_smaller_one_does() {
        let area = |p: usize| [900, 90, 10][p];
        let in_slit = |host: usize| Some((host, Vec2::zeros()));
        let kept = |slits: Vec<Option<(usize, Vec2)>>| {
            hosted(slits, area).iter().map(|s| s.map(|s| s.0)).collect::<Vec<Option<usize>>>()
        };
        assert_eq!(kept(vec![in_slit(1), in_slit(0), None]), [None, Some(0), None]);
        assert_eq!(kept(vec![None, in_slit(0), in_slit(0)]), [None, Some(0), Some(0)]);
        // A godet in a godet stands beside it.
        assert_eq!(kept(vec![None, in_slit(0), in_slit(1)]), [None, Some(0), None]);
        // Two of a size contradict each other.
        assert_eq!(hosted(vec![in_slit(1), in_slit(0)], |_| 900), [in_slit(1), in_slit(0)]);
    }
}
