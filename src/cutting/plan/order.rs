//! The order in which pieces are laid: several by size, and the best of these improved by chance, always the same.

use super::strip::{Item, Strip, StripSpot};
use crate::parallel;

/// Orders that are tried side by side from the best so far, and how often.
const SIDE_BY_SIDE: usize = 8;
const ROUNDS: usize = 100;
/// Weight of the mean lower end of the pieces against the length: of two plans of one length, the one whose pieces lie
/// further up has more room left.
const MEAN: f64 = 0.01;
/// Seed of the changes.
const SEED: u64 = 0x9e37_79b9_7f4a_7c15;

/// Pieces laid: their spots in the order of the items, and the length of cloth.
#[derive(Clone, Debug)]
pub(super) struct LaidOrder {
    pub(super) spots: Vec<StripSpot>,
    pub(super) length: f64,
    order: Vec<usize>,
    rank: f64,
}

/// Lays pieces on cloth of this width: in many orders on coarse columns, and in the best ones on fine ones. `None`
/// where one is wider than the cloth.
pub(super) fn laid(coarse: &[Item], fine: &[Item], width: f64, [wide, narrow]: [f64; 2]) -> Option<LaidOrder> {
    let mut tried: Vec<LaidOrder> =
        starts(coarse).into_iter().map(|order| lay(coarse, width, wide, order)).collect::<Option<_>>()?;
    tried.sort_by(|a, b| a.rank.total_cmp(&b.rank));
    let mut best = tried[0].clone();
    let mut random = Xorshift64(SEED);
    for _ in 0..if coarse.len() > 1 { ROUNDS } else { 0 } {
        let orders: Vec<Vec<usize>> = (0..SIDE_BY_SIDE).map(|_| random.changed(&best.order)).collect();
        let round = parallel::map(SIDE_BY_SIDE, 1, |k| lay(coarse, width, wide, orders[k].clone()));
        let round: Vec<LaidOrder> = round.into_iter().collect::<Option<_>>()?;
        if let Some(better) = round.into_iter().filter(|l| l.rank < best.rank).min_by(|a, b| a.rank.total_cmp(&b.rank))
        {
            tried.push(std::mem::replace(&mut best, better));
        }
    }
    tried.push(best);
    tried.sort_by(|a, b| a.rank.total_cmp(&b.rank));
    tried.truncate(SIDE_BY_SIDE);
    let fine = parallel::map(tried.len(), 1, |k| lay(fine, width, narrow, tried[k].order.clone()));
    fine.into_iter().flatten().min_by(|a, b| a.rank.total_cmp(&b.rank))
}

fn lay(items: &[Item], width: f64, column: f64, order: Vec<usize>) -> Option<LaidOrder> {
    let mut strip = Strip::new(width, column);
    let mut spots = vec![StripSpot::default(); items.len()];
    let mut ends = 0.0;
    for &k in &order {
        spots[k] = strip.lay(&items[k])?;
        ends += spots[k].corner.y + items[k].ways[spots[k].way].size.y;
    }
    let rank = strip.length + MEAN * ends / items.len().max(1) as f64;
    Some(LaidOrder { spots, length: strip.length, order, rank })
}

/// Orders by area of the box, height, width and circumference, the largest first.
fn starts(items: &[Item]) -> Vec<Vec<usize>> {
    let size = |k: usize| items[k].ways[0].size;
    let keys: [&dyn Fn(usize) -> f64; 4] =
        [&|k| size(k).x * size(k).y, &|k| size(k).y, &|k| size(k).x, &|k| size(k).x + size(k).y];
    let by = |key: &dyn Fn(usize) -> f64| {
        let mut order: Vec<usize> = (0..items.len()).collect();
        order.sort_by(|&a, &b| key(b).total_cmp(&key(a)).then(a.cmp(&b)));
        order
    };
    keys.into_iter().map(by).collect()
}

/// A generator of numbers (Marsaglia 2003). Plans that have been made follow from its numbers.
struct Xorshift64(u64);

impl Xorshift64 {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % n as u64) as usize
    }

    /// An order in which two items have changed places, or one stands elsewhere.
    fn changed(&mut self, order: &[usize]) -> Vec<usize> {
        let mut out = order.to_vec();
        let (a, b) = (self.below(out.len()), self.below(out.len()));
        if self.below(2) == 0 {
            out.swap(a, b);
        } else {
            let item = out.remove(a);
            out.insert(b, item);
        }
        out
    }
}
