//! Pieces side by side in rows, rows one over the other.

use super::assign::{Assigned, Facing};
use super::fold::FoldedPieces;
use super::insert::{Insert, hosted, inserts, slit};
use super::lap::{RowLap, laps};
use super::lay::{self, Laid};
use crate::geometry::{Vec2, box_of, range_of};
use crate::mannequin::PartKind;
use crate::mesh::ClothMesh;
use crate::pattern::Garment;

/// Room left between two rows, and between two pieces of a row, metres.
pub(super) const ROOM: f64 = 0.004;

/// A side seam reaches over at least this share of its pieces' heights; cuffs and peplums that flare widely have sides
/// that run more across than down.
const FLANK: f64 = 0.8;

/// Heights of rows are compared in whole parts of a metre, so many of them: rounding must not tell rows apart.
const HEIGHTS: f64 = 1e6;

/// The stitches between two pieces.
#[derive(Clone, Debug)]
pub(super) struct Link {
    /// Number of the seam.
    pub(super) seam: usize,
    pub(super) pieces: [usize; 2],
    /// Particles, in the order of `pieces`.
    pub(super) pairs: Vec<[u32; 2]>,
    /// Whether it runs up and down.
    pub(super) upright: bool,
    /// Mean of its two lengths, metres.
    pub(super) length: f64,
    /// Whether it leads through a piece that lies between the two, which themselves are not sewn together.
    pub(super) through: bool,
}

/// A piece in its row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Member {
    pub(super) piece: usize,
    /// Flat position + shift = row position (u to the right seen from outside, v down).
    pub(super) shift: Vec2,
}

/// The front middle of a row, as a u.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Middle {
    /// On a piece, or where a piece would be.
    On(f64),
    /// At the left side of this piece, where another one joins it.
    LeftOf(usize),
    /// Half way round the ring from the back middle, at this u.
    Opposite(f64),
}

/// Pieces that stand side by side round a part.
#[derive(Clone, Debug)]
pub(super) struct Row {
    pub(super) part: PartKind,
    /// The pieces' layer, see [`crate::pattern::Piece::layer`].
    pub(super) layer: i32,
    /// From right to left of the wearer at the front: u rises.
    pub(super) members: Vec<Member>,
    /// Godets and the like, which lie in a slit of a member.
    pub(super) inserts: Vec<Insert>,
    /// Where closures hold members one over the other.
    pub(super) laps: Vec<RowLap>,
    /// Where the front middle is, if the row knows.
    pub(super) front: Option<Middle>,
    /// Lowest and highest v.
    pub(super) v: [f64; 2],
    /// Whether it hangs from the shoulders.
    pub(super) hangs: bool,
}

impl Row {
    /// Moves all of it down.
    fn lower(&mut self, dv: f64) {
        self.v = self.v.map(|v| v + dv);
        for m in self.members.iter_mut().chain(self.inserts.iter_mut().map(|i| &mut i.own)) {
            m.shift.y += dv;
        }
        self.laps.iter_mut().for_each(|lap| lap.v = lap.v.map(|v| v + dv));
    }
}

/// All rows of a garment.
pub(super) struct Rows {
    pub(super) rows: Vec<Row>,
    pub(super) links: Vec<Link>,
    /// How pieces lie on others; those of rows lie on none.
    pub(super) laid: Vec<Option<Laid>>,
    /// Rows in the order they are placed, with the row they stand next to and the link between them.
    pub(super) order: Vec<(usize, Option<usize>)>,
}

/// Lays the pieces out. Pieces with a rigid place of their own are left out, and those that lie on others.
pub(super) fn rows(garment: &Garment, mesh: &ClothMesh, sheet: &FoldedPieces, assigned: &[Assigned]) -> Rows {
    let links = links(mesh, sheet);
    let laid = lay::laid(garment, mesh, sheet, assigned, &links);
    let links = lay::through(links, mesh, &laid);
    let elsewhere: Vec<bool> =
        garment.pieces.iter().zip(&laid).map(|(p, laid)| p.has_position() || laid.is_some()).collect();
    let area = |p: usize| mesh.pieces[p].triangles.len();
    let slits: Vec<Option<(usize, Vec2)>> = (0..mesh.pieces.len())
        .map(|p| slit(&links, sheet, assigned, garment, p).filter(|s| !elsewhere[p] && !elsewhere[s.0]))
        .collect();
    let slits = hosted(slits, area);
    let mut row_of = vec![usize::MAX; mesh.pieces.len()];
    let mut rows: Vec<Row> = Vec::new();
    // Larger pieces first, those that face front before the others: a row's first piece fixes its middle.
    let mut seeds: Vec<usize> = (0..mesh.pieces.len()).filter(|&p| !elsewhere[p] && slits[p].is_none()).collect();
    seeds.sort_by_key(|&p| (assigned[p].facing != Some(Facing::Front), std::cmp::Reverse(area(p)), p));
    for seed in seeds {
        if row_of[seed] != usize::MAX {
            continue;
        }
        let index = rows.len();
        row_of[seed] = index;
        let mut members = vec![Member { piece: seed, shift: Vec2::zeros() }];
        let layer = garment.pieces[seed].level();
        // Layers lie one over another, not side by side.
        let apart: Vec<bool> = (0..mesh.pieces.len())
            .map(|p| elsewhere[p] || slits[p].is_some() || garment.pieces[p].level() != layer)
            .collect();
        loop {
            let joins = |from: usize, to: usize| {
                let part = assigned[from].part;
                row_of[from] == index && row_of[to] == usize::MAX && assigned[to].part == part && !apart[to]
            };
            let next = widest_next(&links, sheet, &joins)
                .or_else(|| over_the_shoulder(&links, assigned, mesh, sheet, &members, &joins));
            let Some((from, to, shift)) = next else { break };
            let base = members.iter().find(|m| m.piece == from).map_or(Vec2::zeros(), |m| m.shift);
            row_of[to] = index;
            members.push(Member { piece: to, shift: base + shift });
        }
        let mut row = finish_row(mesh, sheet, assigned, layer, members);
        row.inserts = inserts(mesh, sheet, &links, &row.members, &slits);
        row.laps = laps(&garment.closures, mesh, sheet, &row.members);
        row.inserts.iter().for_each(|insert| row_of[insert.own.piece] = index);
        rows.push(row);
    }
    let hanging = hanging(&rows, &links, sheet, assigned);
    rows.iter_mut().zip(hanging).for_each(|(row, hangs)| row.hangs = hangs);
    let order = stack(&mut rows, &links, &row_of, sheet);
    Rows { rows, links, laid, order }
}

/// A piece that comes into a row: from which member, itself, and its shift against that one.
type Joining = (usize, usize, Vec2);

/// The longest upright link from a member of the row to a piece that `joins` it there.
fn widest_next(links: &[Link], sheet: &FoldedPieces, joins: &impl Fn(usize, usize) -> bool) -> Option<Joining> {
    let mut best: Option<(f64, Joining)> = None;
    for link in links.iter().filter(|l| l.upright) {
        for k in 0..2 {
            let (from, to) = (link.pieces[k], link.pieces[1 - k]);
            if joins(from, to) && best.as_ref().is_none_or(|b| link.length > b.0) {
                let at = |p: u32| sheet.flat[p as usize];
                let sum = link.pairs.iter().fold(Vec2::zeros(), |sum, pair| sum + at(pair[k]) - at(pair[1 - k]));
                best = Some((link.length, (from, to, sum / link.pairs.len() as f64)));
            }
        }
    }
    best.map(|b| b.1)
}

/// A back that hangs from the top of the row's front, or the other way round, and has no side seam with it, as in a
/// tabard: it stands beside the row.
fn over_the_shoulder(
    links: &[Link],
    assigned: &[Assigned],
    mesh: &ClothMesh,
    sheet: &FoldedPieces,
    members: &[Member],
    joins: &impl Fn(usize, usize) -> bool,
) -> Option<Joining> {
    links.iter().filter(|l| !l.upright).find_map(|link| {
        let k = (0..2).find(|&k| joins(link.pieces[k], link.pieces[1 - k]))?;
        let [from, to] = [link.pieces[k], link.pieces[1 - k]];
        let opposite = matches!(
            (assigned[from].facing, assigned[to].facing),
            (Some(Facing::Front), Some(Facing::Back)) | (Some(Facing::Back), Some(Facing::Front))
        );
        let hangs = |piece: usize, k: usize| {
            let [low, high] = extent(mesh, sheet, piece);
            stitched(link, sheet, k).y < 0.5 * (low.y + high.y)
        };
        if !(opposite && hangs(from, k) && hangs(to, 1 - k)) {
            return None;
        }
        let base = members.iter().find(|m| m.piece == from)?.shift;
        let right = members.iter().map(|m| extent(mesh, sheet, m.piece)[1].x + m.shift.x).fold(f64::MIN, f64::max);
        let down = stitched(link, sheet, k).y - stitched(link, sheet, 1 - k).y;
        Some((from, to, Vec2::new(right + ROOM - extent(mesh, sheet, to)[0].x - base.x, down)))
    })
}

/// The mean place of a link's stitches on its piece number `k`, as the piece is drawn.
pub(super) fn stitched(link: &Link, sheet: &FoldedPieces, k: usize) -> Vec2 {
    link.pairs.iter().map(|pair| sheet.flat[pair[k] as usize]).sum::<Vec2>() / link.pairs.len() as f64
}

/// The corners of the box round a piece.
pub(super) fn extent(mesh: &ClothMesh, sheet: &FoldedPieces, piece: usize) -> [Vec2; 2] {
    box_of(mesh.pieces[piece].particles.clone().map(|p| sheet.flat[p]))
}

/// A row of these members, put in order, without inserts.
fn finish_row(
    mesh: &ClothMesh,
    sheet: &FoldedPieces,
    assigned: &[Assigned],
    layer: i32,
    mut members: Vec<Member>,
) -> Row {
    let part = assigned[members[0].piece].part;
    let size = |m: &Member| extent(mesh, sheet, m.piece).map(|corner| corner + m.shift);
    members.sort_by(|a, b| center(&size(a)).total_cmp(&center(&size(b))));
    let boxes: Vec<[Vec2; 2]> = members.iter().map(size).collect();
    let v = range_of(boxes.iter().flatten().map(|corner| corner.y));
    let front = front_middle(assigned, &members, &boxes);
    Row { part, layer, members, inserts: Vec::new(), laps: Vec::new(), front, v, hangs: false }
}

/// The u of the middle of a box.
fn center([low, high]: &[Vec2; 2]) -> f64 {
    0.5 * (low.x + high.x)
}

/// The front middle: the middle one of the front pieces and what stands between them, or where the two in the middle
/// meet, sewn or open; failing that, opposite the back's. The members stand side by side, and the last beside the
/// first.
fn front_middle(assigned: &[Assigned], members: &[Member], boxes: &[[Vec2; 2]]) -> Option<Middle> {
    let is = |facing: Facing| move |&i: &usize| assigned[members[i].piece].facing == Some(facing);
    let fronts: Vec<usize> = (0..members.len()).filter(is(Facing::Front)).collect();
    let n = members.len();
    let backs: Vec<usize> = (0..n).filter(is(Facing::Back)).collect();
    // From right to left of the wearer: from the first front after the most that is back to the last one before it.
    let turned = |i: usize, from: usize| (i + n - from) % n;
    let behind = |k: usize| {
        let (last, next) = (fronts[k], fronts[(k + 1) % fronts.len()]);
        let between = (turned(next, last) + n - 1) % n;
        (backs.iter().filter(|&&i| (1..=between).contains(&turned(i, last))).count(), between)
    };
    if let Some(k) = (0..fronts.len()).max_by_key(|&k| behind(k)) {
        let (last, first) = (fronts[k], fronts[(k + 1) % fronts.len()]);
        let count = turned(last, first) + 1;
        let at = (first + count / 2) % n;
        return Some(if count % 2 == 1 { Middle::On(center(&boxes[at])) } else { Middle::LeftOf(members[at].piece) });
    }
    let [low, high] = range_of(backs.iter().flat_map(|&i| boxes[i]).map(|corner| corner.x));
    (!backs.is_empty()).then_some(Middle::Opposite(0.5 * (low + high)))
}

/// Seams cut into links between pairs of pieces.
pub(super) fn links(mesh: &ClothMesh, sheet: &FoldedPieces) -> Vec<Link> {
    let joined = |pair: &[u32; 2]| pair.map(|p| mesh.piece_of(p));
    let mut out = Vec::new();
    for (seam, stitches) in mesh.seams.iter().enumerate() {
        for run in stitches.pairs.chunk_by(|a, b| joined(a) == joined(b)) {
            let [Some(one), Some(other)] = joined(&run[0]) else { continue };
            if one == other {
                continue;
            }
            let pieces = [one, other];
            let mut extent = Vec2::zeros();
            let mut length = 0.0;
            for w in run.windows(2) {
                for (from, to) in w[0].iter().zip(&w[1]) {
                    extent += (sheet.straight[*to as usize] - sheet.straight[*from as usize]).abs();
                    length += 0.5 * (sheet.flat[*to as usize] - sheet.flat[*from as usize]).norm();
                }
            }
            let flanks = (0..2).all(|k| is_flank(mesh, sheet, pieces[k], run.iter().map(|pair| pair[k])));
            out.push(Link {
                seam,
                pieces,
                pairs: run.to_vec(),
                upright: extent.y > extent.x || flanks,
                length,
                through: false,
            });
        }
    }
    out
}

/// Whether stitches run all the way down one side of a piece, however far it flares: from its top to its hem within
/// half of its width. (Shoulders end far above the hem, waists go from side to side.)
fn is_flank(mesh: &ClothMesh, sheet: &FoldedPieces, piece: usize, stitches: impl Iterator<Item = u32>) -> bool {
    let size = |particles: &mut dyn Iterator<Item = usize>| {
        let [low, high] = box_of(particles.map(|p| sheet.straight[p]));
        high - low
    };
    let whole = size(&mut mesh.pieces[piece].particles.clone());
    let seam = size(&mut stitches.map(|p| p as usize));
    seam.y >= FLANK * whole.y && seam.x <= 0.5 * whole.x
}

/// Which rows hang from the shoulders: those with shoulder seams, or, where the garment has none, those of the trunk
/// that raglan sleeves carry.
fn hanging(rows: &[Row], links: &[Link], sheet: &FoldedPieces, assigned: &[Assigned]) -> Vec<bool> {
    let shoulders: Vec<bool> = rows.iter().map(|row| has_shoulders(row, links, sheet)).collect();
    let of_trunk = |row: &Row| row.part == PartKind::Torso;
    if rows.iter().zip(&shoulders).any(|(row, has)| *has && of_trunk(row)) {
        return shoulders;
    }
    let raglan = |row: &Row| of_trunk(row) && is_carried_by_sleeves(row, links, sheet, assigned);
    rows.iter().zip(shoulders).map(|(row, has)| has || raglan(row)).collect()
}

/// Whether level seams join pieces of the row in its upper half: shoulders.
fn has_shoulders(row: &Row, links: &[Link], sheet: &FoldedPieces) -> bool {
    let inside = |piece: usize| row.members.iter().any(|m| m.piece == piece);
    links.iter().any(|l| !l.upright && inside(l.pieces[1]) && is_high(row, l, sheet, 0))
}

/// Whether pieces round the arms are sewn to the row in its upper half.
fn is_carried_by_sleeves(row: &Row, links: &[Link], sheet: &FoldedPieces, assigned: &[Assigned]) -> bool {
    let sleeve = |piece: usize| assigned[piece].part.is_arm();
    links.iter().any(|l| (0..2).any(|k| sleeve(l.pieces[1 - k]) && is_high(row, l, sheet, k)))
}

/// Whether piece number `k` of a link is in the row, and sewn to the other in the row's upper half.
fn is_high(row: &Row, link: &Link, sheet: &FoldedPieces, k: usize) -> bool {
    let member = row.members.iter().find(|m| m.piece == link.pieces[k]);
    member.is_some_and(|m| stitched(link, sheet, k).y + m.shift.y < 0.5 * (row.v[0] + row.v[1]))
}

/// Puts rows of one part over each other and says in which order to place them: rows of the trunk first.
fn stack(rows: &mut [Row], links: &[Link], row_of: &[usize], sheet: &FoldedPieces) -> Vec<(usize, Option<usize>)> {
    let mut order: Vec<(usize, Option<usize>)> = Vec::new();
    let mut done = vec![false; rows.len()];
    let mut roots: Vec<usize> = (0..rows.len()).collect();
    // What hangs from the shoulders begins there, what goes round a limb where it is sewn to the trunk; everything else
    // hangs from its longest row.
    let parts: Vec<PartKind> = rows.iter().map(|r| r.part).collect();
    let joins_trunk = |r: usize| {
        parts[r] != PartKind::Torso
            && links.iter().any(|link| {
                let [a, b] = link.pieces.map(|p| row_of[p]);
                let other = if a == r { b } else { a };
                (a == r || b == r) && parts.get(other) == Some(&PartKind::Torso)
            })
    };
    roots.sort_by_key(|&r| {
        let height = (HEIGHTS * (rows[r].v[1] - rows[r].v[0])) as i64;
        (rows[r].part, !rows[r].hangs, !joins_trunk(r), std::cmp::Reverse(height), r)
    });
    for root in roots {
        if done[root] {
            continue;
        }
        done[root] = true;
        let first = order.len();
        order.push((root, None));
        let mut next = first;
        while next < order.len() {
            let at = order[next].0;
            next += 1;
            let waits = |other: usize| other != usize::MAX && !done[other] && rows[other].part == rows[at].part;
            for other in rows_beside(links, row_of, at, waits) {
                done[other] = true;
                put_beside(rows, links, row_of, sheet, at, other);
                order.push((other, Some(at)));
            }
        }
    }
    order
}

/// The rows sewn to row `at` that still `wait` for their place, that with the longest seams first.
fn rows_beside(links: &[Link], row_of: &[usize], at: usize, waits: impl Fn(usize) -> bool) -> Vec<usize> {
    let mut near: Vec<(usize, f64)> = Vec::new();
    for link in links {
        let [a, b] = link.pieces.map(|p| row_of[p]);
        let other = if a == at { b } else { a };
        if (a != at && b != at) || other == at || !waits(other) {
            continue;
        }
        match near.iter_mut().find(|n| n.0 == other) {
            Some(n) => n.1 += link.length,
            None => near.push((other, link.length)),
        }
    }
    near.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    near.into_iter().map(|n| n.0).collect()
}

/// Shifts row `other` up or down so that its seam with row `at` meets, without overlap; another layer lies over it.
fn put_beside(rows: &mut [Row], links: &[Link], row_of: &[usize], sheet: &FoldedPieces, at: usize, other: usize) {
    let level = |rows: &[Row], row: usize, p: u32, piece: usize| {
        let shift = rows[row].members.iter().find(|m| m.piece == piece).map_or(0.0, |m| m.shift.y);
        sheet.flat[p as usize].y + shift
    };
    let (mut on_at, mut on_other) = (Vec::new(), Vec::new());
    for link in links {
        for k in 0..2 {
            if row_of[link.pieces[k]] != at || row_of[link.pieces[1 - k]] != other {
                continue;
            }
            for pair in &link.pairs {
                on_at.push(level(rows, at, pair[k], link.pieces[k]));
                on_other.push(level(rows, other, pair[1 - k], link.pieces[1 - k]));
            }
        }
    }
    let (of_at, of_other) = (range_of(on_at), range_of(on_other));
    let middle = |v: [f64; 2]| 0.5 * (v[0] + v[1]);
    let above = middle(of_at) < middle(rows[at].v);
    let dv = if rows[at].layer != rows[other].layer {
        middle(of_at) - middle(of_other)
    } else if above {
        of_at[0] - ROOM - of_other[1]
    } else {
        of_at[1] + ROOM - of_other[0]
    };
    rows[other].lower(dv);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Members side by side, 0.2 m each: `f` faces front, `b` back, `-` says nothing.
    fn middle(facing: &str) -> Option<Middle> {
        let said = |c: char| match c {
            'f' => Some(Facing::Front),
            'b' => Some(Facing::Back),
            _ => None,
        };
        let assigned: Vec<Assigned> =
            facing.chars().map(|c| Assigned { part: PartKind::Torso, facing: said(c) }).collect();
        let members: Vec<Member> = (0..assigned.len()).map(|piece| Member { piece, shift: Vec2::zeros() }).collect();
        let boxes: Vec<[Vec2; 2]> =
            (0..assigned.len()).map(|k| [0.2 * k as f64, 0.2 * (k + 1) as f64].map(|u| Vec2::new(u, 0.0))).collect();
        front_middle(&assigned, &members, &boxes)
    }

    fn on(member: usize) -> Option<Middle> {
        let [low, high] = [0.2 * member as f64, 0.2 * (member + 1) as f64];
        Some(Middle::On(0.5 * (low + high)))
    }

    #[test]
    fn the_front_middle_is_among_the_fronts_wherever_the_row_begins() {
        assert_eq!(middle("fb"), on(0));
        assert_eq!(middle("ffb"), Some(Middle::LeftOf(1)));
        assert_eq!(middle("fffb"), on(1));
        // Open in front: round the ring the first stands beside the last.
        assert_eq!(middle("fbf"), Some(Middle::LeftOf(0)));
        assert_eq!(middle("f-b-f"), Some(Middle::LeftOf(0)));
        // Godets between panels are on the side that their neighbours are on.
        assert_eq!(middle("f-f-f-b-b-b-"), on(2));
        assert_eq!(middle("b-f-f-f-b-b-"), on(4));
        assert_eq!(middle("f-b-b-b-f-f-"), on(10));
        assert_eq!(middle("ff"), Some(Middle::LeftOf(1)));
        assert_eq!(middle("--"), None);
        assert_eq!(middle("b-"), Some(Middle::Opposite(0.1)));
        assert_eq!(middle("-bb"), Some(Middle::Opposite(0.4)));
    }

    #[test]
    fn a_row_is_moved_with_all_that_is_in_it() {
        let members = vec![Member { piece: 0, shift: Vec2::zeros() }];
        let mut row = Row {
            part: PartKind::Torso,
            layer: 0,
            members,
            inserts: Vec::new(),
            laps: vec![RowLap::default()],
            front: None,
            v: [0.0, 1.0],
            hangs: false,
        };
        row.lower(0.5);
        assert_eq!((row.v, row.members[0].shift.y, row.laps[0].v), ([0.5, 1.5], 0.5, [0.5, 0.5]));
    }
}
