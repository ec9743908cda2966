//! Godets: pieces in slits of others, which start where they will be, a little over the edges of the slit.

use super::assign::Assigned;
use super::fold::Sheet;
use super::rows::{Link, Member};
use crate::geometry::Vec2;
use crate::mesh::ClothMesh;
use crate::pattern::Garment;

/// Slits that are cut without width have sides at one u; rounding must not make a tube of them.
const IN_SLIT: f64 = 0.1;

/// A piece in a slit of another one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Insert {
    pub(super) own: Member,
    /// Number of the member it lies in.
    pub(super) host: usize,
    /// How many layers it lies over the host: of neighbours wider than the room between their slits, each on its own.
    pub(super) over: usize,
}

/// Where a piece lies in a slit of another one: the host, and the shift against it. It is sewn to nothing else, along both
/// its sides, and its left to the left side of the slit. (Of two pieces that make a tube the left of one meets the right
/// of the other.)
pub(super) fn slit(
    links: &[Link],
    sheet: &Sheet,
    assigned: &[Assigned],
    garment: &Garment,
    piece: usize,
) -> Option<(usize, Vec2)> {
    let own: Vec<&Link> = links.iter().filter(|l| !l.through && l.pieces.contains(&piece)).collect();
    let side = |l: &Link| usize::from(l.pieces[1] == piece);
    let host = own.first().map(|l| l.pieces[1 - side(l)])?;
    let together = |p: usize| (assigned[p].part, garment.pieces[p].layer);
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

/// Whether links run down one side of a piece and up the other: one that turns, or one on either side.
fn goes_round(own: &[&Link], sheet: &Sheet, side: impl Fn(&Link) -> usize) -> bool {
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
            let all = || a.iter().chain(&b).copied();
            let width = all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min);
            (mean(&a) - mean(&b)).abs() > 0.25 * width
        }
        _ => false,
    }
}

/// The pieces in slits of these members, each put into its slit.
pub(super) fn inserts(
    mesh: &ClothMesh,
    sheet: &Sheet,
    members: &[Member],
    hosts: &[Option<(usize, Vec2)>],
) -> Vec<Insert> {
    let lies = |(piece, host): (usize, &Option<(usize, Vec2)>)| {
        let (in_piece, shift) = (*host)?;
        let host = members.iter().position(|m| m.piece == in_piece)?;
        Some(Insert { own: Member { piece, shift: members[host].shift + shift }, host, over: 1 })
    };
    let mut all: Vec<Insert> = hosts.iter().enumerate().filter_map(lies).collect();
    let span = |insert: &Insert| {
        let us = mesh.pieces[insert.own.piece].particles.clone().map(|p| sheet.flat[p].x + insert.own.shift.x);
        us.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], u| [low.min(u), high.max(u)])
    };
    for k in 1..all.len() {
        let own = span(&all[k]);
        let meets = |other: &&Insert| {
            let [low, high] = span(other);
            other.host == all[k].host && low < own[1] && own[0] < high
        };
        let taken: Vec<usize> = all[..k].iter().filter(meets).map(|other| other.over).collect();
        all[k].over = (1..).find(|over| !taken.contains(over)).unwrap_or(1);
    }
    all
}
