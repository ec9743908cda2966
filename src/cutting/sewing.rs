//! The order in which a garment's seams are sewn.

use crate::geometry::{MM, Vec2};
use crate::pattern::{Garment, Give, Seam, SeamKind, Side, Span};

/// Ends of edges nearer than this (metres) are one point of a piece.
const SAME: f64 = 1e-6;

/// A seam, or the two of a pair, to be sewn.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SewingStep {
    /// The seam's name, without its side.
    pub name: String,
    /// One of its two sides: `front.shoulder`, or the edges of a chain.
    pub sew: Vec<String>,
    /// The other.
    pub to: Vec<String>,
    /// Whether left and right are sewn alike.
    pub both: bool,
    /// How unequal lengths are meant.
    pub give: String,
}

impl SewingStep {
    /// `shoulder, left and right: front.shoulder to back.shoulder`
    pub fn words(&self) -> String {
        let both = if self.both { ", left and right" } else { "" };
        format!("{}{both}: {} to {}{}", self.name, self.sew.join(" + "), self.to.join(" + "), self.give)
    }
}

/// The seams of a garment in an order in which they can be sewn: by stages, in each of them darts and pleats before
/// seams. A seam along several edges comes after those that bring these together, whatever their stage. All
/// others keep the order of the file.
pub fn sewing_order(garment: &Garment) -> Vec<SewingStep> {
    let groups = groups(garment);
    let mut left: Vec<usize> = (0..groups.len()).collect();
    left.sort_by_key(|&g| {
        let seam = &garment.seams[groups[g][0]];
        (seam.stage, seam.kind == SeamKind::Written, g)
    });
    let needs: Vec<Vec<usize>> = (0..groups.len()).map(|g| needs(garment, &groups, g)).collect();
    let mut steps = Vec::new();
    while !left.is_empty() {
        // Where seams wait for each other the first is sewn: the others of its chain are closed with it.
        let ready = left.iter().position(|&g| needs[g].iter().all(|need| !left.contains(need))).unwrap_or(0);
        steps.push(step(garment, &groups[left.remove(ready)]));
    }
    steps
}

/// Indices of seams, those of both sides and the layers of one pleat together.
fn groups(garment: &Garment) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (k, seam) in garment.seams.iter().enumerate() {
        let name = Side::split(&seam.name).0;
        let own = groups.iter_mut().find(|g| {
            let first = &garment.seams[g[0]];
            Side::split(&first.name).0 == name && first.stage == seam.stage
        });
        match own {
            Some(group) => group.push(k),
            None => groups.push(vec![k]),
        }
    }
    groups
}

/// The groups that must be sewn before `group`: those that close a joint of one of its chains.
fn needs(garment: &Garment, groups: &[Vec<usize>], group: usize) -> Vec<usize> {
    let joints: Vec<[SeamPoint; 2]> = groups[group].iter().flat_map(|&k| joints(garment, &garment.seams[k])).collect();
    let closes = |other: &usize| {
        let ends = groups[*other].iter().flat_map(|&k| ends(garment, &garment.seams[k]));
        ends.into_iter().any(|[a, b]| joints.iter().any(|[c, d]| a.is(c) && b.is(d) || a.is(d) && b.is(c)))
    };
    (0..groups.len()).filter(|other| *other != group).filter(closes).collect()
}

/// A point on the rim of a piece.
#[derive(Clone, Copy, Debug)]
struct SeamPoint {
    piece: usize,
    at: Vec2,
}

impl SeamPoint {
    /// Where the walk along a span begins (or, `at_end`, ends).
    fn new(garment: &Garment, span: &Span, at_end: bool) -> Self {
        let edge = &garment.pieces[span.edge.piece].loops[span.edge.ring][span.edge.index];
        Self { piece: span.edge.piece, at: edge.path.point(if at_end { span.to } else { span.from }) }
    }

    fn is(&self, other: &Self) -> bool {
        self.piece == other.piece && (self.at - other.at).norm() < SAME
    }
}

/// Where the edges of a seam's chains follow one another, the last one by the first if the chain is a ring.
fn joints(garment: &Garment, seam: &Seam) -> Vec<[SeamPoint; 2]> {
    let of_chain = |chain: &[Span]| {
        let next = chain.iter().cycle().skip(1);
        let pairs =
            chain.iter().zip(next).map(|(a, b)| [SeamPoint::new(garment, a, true), SeamPoint::new(garment, b, false)]);
        pairs.filter(|[a, b]| !a.is(b)).collect::<Vec<_>>()
    };
    [of_chain(&seam.a), of_chain(&seam.b)].concat()
}

/// The points that a seam brings together at its ends.
fn ends(garment: &Garment, seam: &Seam) -> Vec<[SeamPoint; 2]> {
    let (Some(a), Some(b)) = (seam.a.first(), seam.b.first()) else { return Vec::new() };
    let (Some(last_a), Some(last_b)) = (seam.a.last(), seam.b.last()) else { return Vec::new() };
    let start = [a, b].map(|span| SeamPoint::new(garment, span, false));
    let end = [last_a, last_b].map(|span| SeamPoint::new(garment, span, true));
    vec![start, end]
}

fn step(garment: &Garment, group: &[usize]) -> SewingStep {
    let seam = &garment.seams[group[0]];
    let has = |side: Side| group.iter().any(|&k| Side::split(&garment.seams[k].name).1 == Some(side));
    let both = has(Side::Left) && has(Side::Right);
    let named = |chain: &[Span]| {
        let mut names: Vec<String> = Vec::new();
        for span in chain {
            let piece = &garment.pieces[span.edge.piece];
            let edge = &piece.loops[span.edge.ring][span.edge.index].name;
            // Of a piece on the fold the edges of each half have its side in their names.
            let edge = if both { Side::split(edge).0 } else { edge };
            let name = format!("{}.{edge}", piece.drawn_as);
            if !names.contains(&name) {
                names.push(name);
            }
        }
        names
    };
    let name = Side::split(&seam.name).0.to_owned();
    let give = give(seam.give);
    SewingStep { give, name, sew: named(&seam.a), to: named(&seam.b), both }
}

fn give(give: Give) -> String {
    match give {
        Give::Even => String::new(),
        Give::Ease(more) => format!(", {:.0} mm eased in", more.abs() * MM),
        Give::Gather(ratio) => format!(", the first gathered {ratio:.2} to 1"),
        Give::Stretch(ratio) => format!(", the second stretched {ratio:.2} times"),
    }
}
