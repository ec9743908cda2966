//! Rows bent into rings round their body part.

use super::PlaceError;
use super::arms::Arms;
use super::assign::is_at_bust;
use super::fold::FoldedPieces;
use super::lay::beneath;
use super::levels::{LEVEL, Level, SMOOTHING, levels};
use super::ring::{LAYER, Ring};
use super::rows::{ROOM, Row, Rows};
use super::stations::Stations;
use crate::contact::Collider;
use crate::geometry::Vec3;
use crate::mannequin::{Mannequin, PartKind};
use crate::mesh::ClothMesh;
use crate::pattern::Garment;

/// A row that would begin lower is lifted until it is so far off the floor, metres: clear of the toes.
const TOES: f64 = 0.03;
/// Largest height above the waist that a row is lifted to, metres. The rest of a train has to be pushed up.
const HIGHEST: f64 = 0.05;
/// A layer's ring is so much wider than the one it is worn over, metres: room for the folds of that.
const LAYERS_APART: f64 = 5.0 * LAYER;
/// Step by which a row that stands alone round the trunk slips down from the waist, metres. It stops where the body
/// holds its top.
const SLIP: f64 = 0.005;
/// Largest distance that it slips, metres.
const LOWEST: f64 = 0.15;
/// Room all round with which the body holds the top of a row, metres.
const TOP_ROOM: f64 = 0.003;
/// Levels below the end of a row's outline at which its top is measured: the ends may be points.
const TOP_LEVEL: usize = 2;
/// A row at the bust begins so far above it, metres, under the arms; a narrow one has the bust in its middle.
const ABOVE_BUST: f64 = 0.07;
/// A row that stands alone round the neck or a limb begins so far from where that does, metres.
const FROM_END: f64 = 0.015;

/// Start positions; pieces in no row stay at the origin (they have a place of their own, or lie on others).
pub(super) fn wrap(
    garment: &Garment,
    mesh: &ClothMesh,
    body: &Mannequin,
    collider: &Collider,
    sheet: &FoldedPieces,
    rows: &Rows,
) -> Result<Vec<Vec3>, PlaceError> {
    let arms = Arms::of(body);
    let mut rings: Vec<(usize, Ring)> = Vec::with_capacity(rows.rows.len());
    for &(index, beside) in &rows.order {
        let row = &rows.rows[index];
        let stations = Stations::new(body, row.part).ok_or_else(|| PlaceError::NoPart {
            piece: garment.pieces[row.members[0].piece].name.clone(),
            part: row.part.name(),
            mannequin: body.name.clone(),
        })?;
        let levels = levels(mesh, sheet, row, &rows.links);
        let anchored = beside.and_then(|other| rings.iter().find(|r| r.0 == other)).map(|r| r.1.anchor);
        let anchored = anchored.or_else(|| hung(&stations, row, &rings));
        let at_bust = row.members.iter().any(|m| is_at_bust(&garment.pieces[m.piece]));
        let anchor = anchored.unwrap_or_else(|| anchor(body, &stations, row, &levels, at_bust));
        let links = &rows.links;
        let mut ring = Ring { links, mesh, sheet, row, levels, stations, anchor, leans: Vec::new(), between: None };
        if row.part == PartKind::Torso && row.hangs {
            let pieces: Vec<usize> = row.members.iter().map(|m| m.piece).collect();
            ring.hang_from_shoulders(body, collider, anchored.is_none(), beneath(&rows.laid, &pieces));
        }
        rings.push((index, ring));
    }
    clear_toes(body, &mut rings);
    for (_, ring) in rings.iter_mut().filter(|r| r.1.row.part == PartKind::Torso) {
        ring.keep_between(&arms, collider);
    }
    let axes = nested(&rings);
    let mut x = vec![Vec3::zeros(); mesh.flat.len()];
    let mut placed = vec![false; mesh.pieces.len()];
    for ((_, ring), axes) in rings.iter_mut().zip(axes) {
        ring.bend(axes, &placed, &mut x);
        for m in &ring.row.members {
            placed[m.piece] = true;
        }
    }
    Ok(x)
}

/// Lifts what goes round the trunk, and what hangs from that round the legs, until it is clear of the toes, or by their
/// height: a rim that is drawn inward beside them goes under them, and stays there.
fn clear_toes(body: &Mannequin, rings: &mut [(usize, Ring)]) {
    let Some(floor) = body.floor() else { return };
    let lowest = rings.iter().map(|r| &r.1).filter(|ring| ring.row.part == PartKind::Torso);
    let lowest = lowest.map(|ring| ring.anchor + ring.row.v[1]).fold(f64::NEG_INFINITY, f64::max);
    let lift = (lowest + floor + TOES).clamp(0.0, TOES);
    let hanging = rings.iter_mut().filter(|r| r.1.row.part == PartKind::Torso || r.1.row.part.is_leg());
    hanging.for_each(|r| r.1.anchor -= lift);
}

/// Station of v = 0 for a row round a leg that hangs from rows round the trunk: just under what it is sewn to.
fn hung(stations: &Stations, row: &Row, rings: &[(usize, Ring)]) -> Option<f64> {
    if !row.part.is_leg() {
        return None;
    }
    let trunk = || rings.iter().map(|r| &r.1).filter(|r| r.row.part == PartKind::Torso);
    let of = |row: &Row, piece: usize| row.members.iter().find(|m| m.piece == piece).map(|m| m.shift.y);
    let mut sum = [0.0; 2];
    for ring in trunk() {
        for link in ring.links {
            for k in 0..2 {
                let (Some(own), Some(upper)) = (of(row, link.pieces[k]), of(ring.row, link.pieces[1 - k])) else {
                    continue;
                };
                for pair in &link.pairs {
                    let height = -(ring.anchor + ring.sheet.flat[pair[1 - k] as usize].y + upper);
                    sum[0] += stations.at_height(height) - ring.sheet.flat[pair[k] as usize].y - own;
                    sum[1] += 1.0;
                }
            }
        }
    }
    (sum[1] > 0.0).then(|| sum[0] / sum[1] + ROOM)
}

/// Half axes of every ring at each of its levels, those of outer layers clear of the inner ones, and those of collars
/// that are turned down clear of what they fall over.
fn nested(rings: &[(usize, Ring)]) -> Vec<Vec<[f64; 2]>> {
    let mut axes: Vec<Vec<[f64; 2]>> = rings.iter().map(|r| r.1.axes()).collect();
    let mut inside_out: Vec<usize> = (0..rings.len()).collect();
    let lies: Vec<(i32, bool)> = rings.iter().map(|r| (r.1.row.layer, r.1.turns_down())).collect();
    inside_out.sort_by_key(|&k| lies[k]);
    for (nth, &k) in inside_out.iter().enumerate() {
        let ring = &rings[k].1;
        for &other in &inside_out[..nth] {
            let inner = &rings[other].1;
            if inner.row.part != ring.row.part || lies[other] == lies[k] {
                continue;
            }
            for level in 0..axes[k].len() {
                // The inner ring's levels a little above and below count too: the cloth runs straight between rings.
                let at = (ring.anchor + ring.row.v[0] - inner.anchor - inner.row.v[0]) / LEVEL + level as f64;
                let near = axes[other].iter().enumerate().filter(|(l, _)| (*l as f64 - at).abs() <= SMOOTHING as f64);
                let widest = near.fold([0.0f64; 2], |w, (_, ab)| [w[0].max(ab[0]), w[1].max(ab[1])]);
                for (own, inner) in axes[k][level].iter_mut().zip(widest) {
                    *own = own.max(inner + LAYERS_APART);
                }
            }
        }
    }
    axes
}

/// Station (metres along the part) of v = 0 for a row that stands alone.
fn anchor(body: &Mannequin, stations: &Stations, row: &Row, levels: &[Level], at_bust: bool) -> f64 {
    let bust = stations.landmark(&["bust", "chest"]).filter(|_| at_bust);
    match (row.part, bust) {
        (PartKind::Torso, Some(bust)) => {
            let above = (0.5 * (row.v[1] - row.v[0])).min(ABOVE_BUST);
            above_floor(body, bust - above - row.v[0], row)
        }
        (PartKind::Torso, None) => {
            // As low below the waist as the body lets the row's top slip.
            let girth = levels.get(TOP_LEVEL).or(levels.first()).map_or(0.0, |l| l.length);
            let waist = stations.landmark(&["natural waist", "waist", "omphalion"]).unwrap_or_else(|| stations.low());
            let mut at = waist;
            while at < waist + LOWEST && stations.at(at).perimeter(TOP_ROOM) < girth {
                at += SLIP;
            }
            above_floor(body, at - row.v[0], row).max(waist - HIGHEST - row.v[0])
        }
        (PartKind::Neck, _) => stations.low() - FROM_END - row.v[1],
        _ => stations.low() + FROM_END - row.v[0],
    }
}

/// `anchor`, or as much nearer the head as keeps the row off the floor: cloth that is pushed up from under it crumples,
/// and crumpled rims do not find each other.
fn above_floor(body: &Mannequin, anchor: f64, row: &Row) -> f64 {
    body.floor().map_or(anchor, |floor| anchor.min(-(floor + TOES) - row.v[1]))
}
