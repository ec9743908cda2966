//! Which ends of the body pass through which opening: the dealing that fits best.
//!
//! Each opening of a connected surface parts the body's skin, so a way of wearing it deals the five ends out to its
//! openings. All dealings are tried.

use super::cloth::Distances;
use super::cost::{Unlike, beyond, girth_cost, prior, uneven, unlike};
use super::deal_error::DealError;
use super::ends::{End, Ends};
use super::girths::Sizes;
use super::glue::Glued;
use super::marks::{self, Mirror, RimStretch};
use super::openings::GluedOpening;
use super::sides;
use super::slit;
use super::zip;
use crate::mannequin::Mannequin;
use crate::mesh::ClothMesh;
use crate::pattern::{Garment, PlaceMeaning, PlaceWord};

/// A dealing is clear when every other one costs this much more. Of 58 garments that these costs were not chosen on
/// every wrong one had a smaller margin, and no right one was refused by much less.
pub const CLEAR: f64 = 0.7;
/// Most openings of a part that are dealt to: the longest. Others are slits.
const MOST: usize = 8;

/// A hole within one piece: what it costs less if nothing passes through it, and more if something does.
const CUT_OUT: f64 = 1.0;
/// Two openings on pieces of one side for ends of different sides, or the other way round; an arm that is nearer to the
/// other side's leg by more than so much, metres.
const CROSSED: f64 = 2.0;
const NEARER: f64 = 0.005;
/// A word of a piece on the rim that says otherwise, and one that no opening answers to.
const WORD: f64 = 3.0;
const UNHEARD: f64 = 2.0;
/// Pieces of the trunk are drawn upright: what an opening costs at the wrong end of its drawing, and where that begins.
const UPRIGHT: f64 = 1.5;
const MIDDLE: f64 = 0.3;

/// How a garment is worn.
#[derive(Clone, Debug)]
pub struct Dealing {
    /// The ends that pass through every opening; none for slits and keyholes.
    pub ends: Vec<Ends>,
    /// For every opening that the trunk or the neck passes through the node of its rim at the front middle, if known.
    pub front: Vec<Option<u32>>,
    /// Pairs of particles that close open fronts and slits.
    pub zips: Vec<[u32; 2]>,
    /// By how much the next dealing costs more; the least of all connected parts.
    pub margin: f64,
    /// The next best dealing, of the part with the least margin.
    pub runner_up: Option<Vec<Ends>>,
}

/// Deals the body's ends out to the openings of every connected part.
///
/// # Errors
/// [`DealError`] where two dealings cost about the same, or a part has no opening.
pub fn deal(
    garment: &Garment,
    mesh: &ClothMesh,
    glued: &Glued,
    openings: &[GluedOpening],
    body: &Mannequin,
) -> Result<Dealing, DealError> {
    let dealing = guess(garment, mesh, glued, openings, body);
    dealing.doubt(garment, mesh, glued, openings).map_or(Ok(dealing), Err)
}

impl Dealing {
    /// The next dealing where it costs about the same. `None` where this one is clear.
    pub(super) fn doubt(
        &self,
        garment: &Garment,
        mesh: &ClothMesh,
        glued: &Glued,
        openings: &[GluedOpening],
    ) -> Option<DealError> {
        let next = self.runner_up.as_ref().filter(|_| self.margin < CLEAR)?;
        Some(DealError::new(garment, mesh, glued, openings, &self.ends, next, self.margin))
    }
}

/// The best dealing, be it clear or not.
pub fn guess(
    garment: &Garment,
    mesh: &ClothMesh,
    glued: &Glued,
    openings: &[GluedOpening],
    body: &Mannequin,
) -> Dealing {
    let cloth = Distances::new(glued, mesh);
    let table = DealCosts::new(garment, mesh, glued, openings, &cloth, &Sizes::of(body));
    let mut dealing = Dealing {
        ends: vec![Ends::NONE; openings.len()],
        front: vec![None; openings.len()],
        zips: Vec::new(),
        margin: f64::INFINITY,
        runner_up: None,
    };
    let parts = openings.iter().map(|o| o.part).max().map_or(0, |last| last + 1);
    for part in 0..parts {
        let mut own: Vec<usize> =
            (0..openings.len()).filter(|&i| openings[i].part == part && !openings[i].is_backed).collect();
        own.sort_by(|&a, &b| openings[b].girth.total_cmp(&openings[a].girth));
        own.truncate(MOST);
        own.sort_unstable();
        let Some([best, next]) = table.best(&own) else { continue };
        own.iter().zip(&best.1).for_each(|(&i, &ends)| dealing.ends[i] = ends);
        if next.0 - best.0 < dealing.margin {
            dealing.margin = next.0 - best.0;
            let mut other = dealing.ends.clone();
            own.iter().zip(&next.1).for_each(|(&i, &ends)| other[i] = ends);
            dealing.runner_up = Some(other);
        }
        sides::settle(&table.wearing(), &own, &mut dealing.ends, &mut dealing.front);
    }
    dealing.zips = zip::zips(&table.wearing(), &dealing.ends);
    let is_hem = |ends: &Ends| ends.touches(Ends::LEGS) && !ends.has(Ends::HEAD);
    let hems = openings.iter().zip(&dealing.ends).filter(|(_, ends)| is_hem(ends));
    let slits = |(hem, ends): (_, &Ends)| slit::slits(glued, mesh, &cloth, hem, table.sizes.range(*ends).least);
    dealing.zips.extend(hems.flat_map(slits));
    dealing
}

/// The evidence that a garment is dealt by.
pub(super) struct Wearing<'a> {
    pub(super) garment: &'a Garment,
    pub(super) mesh: &'a ClothMesh,
    pub(super) glued: &'a Glued,
    pub(super) openings: &'a [GluedOpening],
    /// Distance of every node from every opening.
    pub(super) far: &'a [Vec<f64>],
    pub(super) stretches: &'a [Vec<RimStretch>],
    pub(super) sizes: &'a Sizes,
    pub(super) cloth: &'a Distances<'a>,
}

/// Costs that do not depend on the other openings, and what tells of pairs of them.
struct DealCosts<'a> {
    cloth: &'a Distances<'a>,
    garment: &'a Garment,
    mesh: &'a ClothMesh,
    glued: &'a Glued,
    openings: &'a [GluedOpening],
    sizes: Sizes,
    far: Vec<Vec<f64>>,
    stretches: Vec<Vec<RimStretch>>,
    /// Cost of every set of ends at every opening.
    cost: Vec<[f64; Ends::COUNT]>,
    /// How much of every opening is on the left: from 1 to −1.
    sided: Vec<f64>,
    /// Least distance between two openings.
    apart: Vec<Vec<f64>>,
    /// The cost of two openings whose ends are no mirror images; on the diagonal, of one that is not its own.
    unlike: Unlike,
}

/// A dealing and what it costs.
type Costed = (f64, Vec<Ends>);

impl<'a> DealCosts<'a> {
    fn new(
        garment: &'a Garment,
        mesh: &'a ClothMesh,
        glued: &'a Glued,
        openings: &'a [GluedOpening],
        cloth: &'a Distances<'a>,
        sizes: &Sizes,
    ) -> Self {
        let stretches = marks::stretches(garment, mesh, glued, openings);
        let far: Vec<Vec<f64>> = openings.iter().map(|o| cloth.from(&o.rim)).collect();
        let near =
            |i: usize, j: usize| openings[j].rim.iter().map(|&n| far[i][n as usize]).fold(f64::INFINITY, f64::min);
        let all = 0..openings.len();
        let apart = all.clone().map(|i| all.clone().map(|j| near(i, j)).collect()).collect();
        let sided = stretches.iter().map(|on| marks::sidedness(on)).collect();
        let unlike = unlike(&Mirror::new(garment, mesh, glued), openings, &stretches, mesh.spacing);
        let mut out = Self {
            cloth,
            garment,
            mesh,
            glued,
            openings,
            sizes: *sizes,
            far,
            stretches,
            cost: Vec::new(),
            sided,
            apart,
            unlike,
        };
        out.cost = all.map(|i| out.costs(i)).collect();
        out
    }

    fn wearing(&self) -> Wearing<'_> {
        Wearing {
            garment: self.garment,
            mesh: self.mesh,
            glued: self.glued,
            openings: self.openings,
            far: &self.far,
            stretches: &self.stretches,
            sizes: &self.sizes,
            cloth: self.cloth,
        }
    }

    /// Costs of every set of ends at opening `i`.
    fn costs(&self, i: usize) -> [f64; Ends::COUNT] {
        let mut out = [0.0; Ends::COUNT];
        let cut_out = marks::is_cut_out(self.mesh, &self.openings[i]);
        for ends in Ends::every() {
            let girth = girth_cost(&self.openings[i], ends, self.sizes.range(ends));
            let said = if ends.is_empty() { 0.0 } else { self.word_cost(i, ends) + self.upright_cost(i, ends) };
            let hole = if !cut_out {
                0.0
            } else if ends.is_empty() {
                -CUT_OUT
            } else {
                CUT_OUT
            };
            out[ends.index()] = girth + said + hole;
        }
        out
    }

    /// Words of pieces on the rim that say otherwise.
    fn word_cost(&self, i: usize, ends: Ends) -> f64 {
        let trunk = ends.touches(Ends::LEGS) || ends.has(Ends::TOP);
        let fails = |piece: usize| {
            let mut said = marks::words(self.garment, piece);
            said.any(|word| match word.meaning() {
                PlaceMeaning::Arm => !ends.touches(Ends::ARMS),
                PlaceMeaning::Leg => !trunk,
                PlaceMeaning::Neck => !ends.has(Ends::HEAD),
                PlaceMeaning::Trunk => marks::is_low(word) && !trunk,
                _ => false,
            })
        };
        WORD * marks::share(&self.stretches[i], fails)
    }

    /// At which end of its drawing an opening lies.
    fn upright_cost(&self, i: usize, ends: Ends) -> f64 {
        let cost: fn(f64) -> f64 = if ends.has(Ends::HEAD) && !ends.touches(Ends::LEGS) {
            |height| (height + MIDDLE).max(0.0)
        } else if ends.touches(Ends::LEGS) && !ends.has(Ends::HEAD) {
            |height| (MIDDLE - height).max(0.0)
        } else {
            |_| 0.0
        };
        UPRIGHT * marks::by_height(&self.stretches[i], cost)
    }

    /// The best dealing to these openings and the next that is not its mirror image.
    fn best(&self, own: &[usize]) -> Option<[Costed; 2]> {
        let (mut best, mut next): (Option<Costed>, Option<Costed>) = (None, None);
        let mirrored = |a: &[Ends], b: &[Ends]| a.iter().zip(b).all(|(a, b)| a.mirrored() == *b);
        for number in 0..own.len().pow(End::ALL.len() as u32) {
            let ends = dealt(number, own.len());
            let cost = self.total(own, &ends);
            if best.as_ref().is_none_or(|b| cost < b.0) {
                let beaten = best.replace((cost, ends.clone()));
                next = beaten.filter(|b| !mirrored(&b.1, &ends)).or(next.filter(|n| !mirrored(&n.1, &ends)));
            } else if next.as_ref().is_none_or(|n| cost < n.0) && !best.as_ref().is_some_and(|b| mirrored(&b.1, &ends))
            {
                next = Some((cost, ends));
            }
        }
        let best = best?;
        Some([best.clone(), next.unwrap_or((f64::INFINITY, best.1))])
    }

    /// The cost of a dealing.
    fn total(&self, own: &[usize], ends: &[Ends]) -> f64 {
        let mut cost = prior(ends) + self.unheard(own, ends) + self.crossed(own, ends);
        for (a, &i) in own.iter().enumerate() {
            cost += self.cost[i][ends[a].index()];
            if ends[a].mirrored() != ends[a] {
                cost += self.unlike.pairs[i][i];
            }
            if ends[a] == Ends::ARMS {
                cost += self.unlike.arms[i];
            }
            for (b, &j) in own.iter().enumerate().skip(a + 1) {
                if ends[a].mirrored() != ends[b] {
                    cost += self.unlike.pairs[i][j];
                }
                let same = self.sided[i] * self.sided[j] * side(ends[a]) * side(ends[b]);
                cost += CROSSED * (-same).max(0.0);
                if ends[a].len() == 1 && ends[a].mirrored() == ends[b] {
                    cost += uneven([i, j].map(|k| self.openings[k].girth));
                }
                if let Some(range) = self.sizes.apart(ends[a], ends[b]) {
                    cost += beyond(self.apart[i][j], range);
                }
            }
        }
        cost
    }

    /// Arms that are nearer to the leg of the other side.
    fn crossed(&self, own: &[usize], ends: &[Ends]) -> f64 {
        let at = |wanted: Ends| ends.iter().position(|e| *e == wanted).map(|k| own[k]);
        let legs = at(Ends::LEFT_LEG).zip(at(Ends::RIGHT_LEG));
        let far = |arm: Option<usize>, [near, other]: [usize; 2]| {
            arm.is_some_and(|arm| self.apart[arm][near] > self.apart[arm][other] + NEARER)
        };
        let Some((left, right)) = legs else { return 0.0 };
        let arms = [far(at(Ends::LEFT_ARM), [left, right]), far(at(Ends::RIGHT_ARM), [right, left])];
        CROSSED * arms.iter().filter(|far| **far).count() as f64
    }

    /// The words of the pieces at these openings that no opening answers to.
    fn unheard(&self, own: &[usize], ends: &[Ends]) -> f64 {
        let pieces = || own.iter().flat_map(|&i| &self.stretches[i]).map(|s| s.piece);
        let said = |test: fn(PlaceWord) -> bool| pieces().any(|p| marks::words(self.garment, p).any(test));
        let arms = said(|word| word.meaning() == PlaceMeaning::Arm);
        let from_shoulders = said(|word| matches!(word.meaning(), PlaceMeaning::Arm | PlaceMeaning::Neck));
        let high = said(marks::is_high);
        let low = said(|word| word.meaning() == PlaceMeaning::Leg || marks::is_low(word));
        let is_arm = |e: &Ends| !e.is_empty() && Ends::ARMS.has(*e);
        let mut cost = 0.0;
        cost += if arms && !ends.iter().any(is_arm) { UNHEARD } else { 0.0 };
        cost += if low && !high && ends.contains(&Ends::HEAD) { WORD } else { 0.0 };
        cost + if from_shoulders && !low && ends.contains(&Ends::TOP) { 0.5 * UNHEARD } else { 0.0 }
    }
}

/// 1 for ends of the left alone, −1 for those of the right alone, else 0.
fn side(ends: Ends) -> f64 {
    let left = ends.touches(Ends::LEFT_ARM.with(Ends::LEFT_LEG));
    let right = ends.touches(Ends::RIGHT_ARM.with(Ends::RIGHT_LEG));
    f64::from(left) - f64::from(right)
}

/// The sets of ends that the `number`th way deals to so many openings.
fn dealt(mut number: usize, openings: usize) -> Vec<Ends> {
    let mut ends = vec![Ends::NONE; openings];
    for end in End::ALL {
        let to = number % openings;
        ends[to] = ends[to].with(Ends::of(end));
        number /= openings;
    }
    ends
}
