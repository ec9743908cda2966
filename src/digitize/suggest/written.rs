//! Suggested seams as a garment file has them.

use super::Outline;
use super::chains::{ChainMatch, RunChain};
use super::guess::Guess;
use super::matches::Match;
use super::run::EdgeRun;
use crate::geometry::MM;
use crate::pattern::{CutKind, DEFAULT_TOLERANCE, GarmentFile, Located, PieceFile, Quantity, SeamFile, Side, Spot};

/// A longer side is eased in up to this share, and gathered beyond it.
const EASED: f64 = 0.08;

/// Edges that may be sewn together.
#[derive(Clone, Debug, PartialEq)]
pub struct Suggestion {
    /// A name for the seam that no other has.
    pub name: String,
    /// One side, `front.a`, or several edges that go on into each other.
    pub sew: Vec<String>,
    /// The other, or `mirror`.
    pub to: Vec<String>,
    /// Their lengths, metres.
    pub lengths: [f64; 2],
    /// How much the second is longer (metres), where that is eased in.
    pub ease: Option<f64>,
    /// How many times as long the first is, where that is gathered.
    pub gather: Option<f64>,
    /// How much speaks for it: points, comparable within one drawing.
    pub score: f64,
    /// The reasons for it.
    pub reasons: Vec<String>,
}

fn at_no_place<T>(value: T) -> Located<T> {
    Located::new(value, Spot::default())
}

impl Suggestion {
    /// As a garment file has it.
    pub fn seam(&self) -> SeamFile {
        let side = |edges: &[String]| edges.iter().cloned().map(at_no_place).collect();
        let tenths = |metres: f64| (metres * MM * 10.0).round() / 10.0;
        let ease = self.ease.map(|ease| at_no_place(Quantity { number: tenths(ease), unit: None }));
        // A garment file takes more only if that is said.
        let apart = (self.lengths[1] - self.lengths[0]).abs();
        let number = (apart * MM).ceil();
        let gather = self.gather.map(|ratio| at_no_place((ratio * 1e3).round() / 1e3));
        let told = ease.is_some() || gather.is_some();
        let tolerance = (!told && apart > DEFAULT_TOLERANCE).then(|| at_no_place(Quantity { number, unit: None }));
        SeamFile {
            ease,
            gather,
            tolerance,
            ..SeamFile::new(at_no_place(self.name.clone()), side(&self.sew), side(&self.to))
        }
    }

    /// Itself with this length (metres) of a second side of one edge sewn from its start.
    fn lapped(mut self, length: f64) -> Self {
        if let [edge] = &mut self.to[..] {
            *edge = format!("{edge}@0..{}", (length * MM * 1e3).round() / 1e3);
            self.lengths[1] = length;
        }
        self
    }

    /// Itself with the longer side eased in, or gathered where that is much.
    fn eased(mut self) -> Self {
        let [sew, to] = self.lengths;
        let gathered = sew.max(to) > (1.0 + EASED) * sew.min(to);
        // What is gathered stands first, what is eased in second.
        if gathered != (sew > to) {
            (self.sew, self.to) = (self.to, self.sew);
            self.lengths = [to, sew];
        }
        let [sew, to] = self.lengths;
        let apart = (to - sew).abs() > DEFAULT_TOLERANCE;
        self.gather = gathered.then_some(sew / to);
        self.ease = (!gathered && apart).then_some(to - sew);
        self
    }

    /// Its lengths and what speaks for it.
    pub fn reason(&self) -> String {
        let [sew, to] = self.lengths.map(|metres| metres * MM);
        format!("{sew:.1} and {to:.1} mm; {}", self.reasons.join(", "))
    }
}

/// A garment file of which nothing is sewn, with all that is suggested as its seams and the rest of its edges free.
pub fn sewn(file: &GarmentFile, suggestions: &[Suggestion]) -> GarmentFile {
    let sewn: Vec<String> = suggestions.iter().flat_map(|s| s.sew.iter().chain(&s.to)).map(|e| whole(e)).collect();
    let mut free = Vec::new();
    for piece in &file.pieces {
        let name = &piece.name.value;
        let edges = piece.outline.iter().flat_map(|outline| &outline.edges);
        let full: Vec<String> = edges.map(|(edge, _)| format!("{name}.{}", edge.value)).collect();
        let left: Vec<&String> = full.iter().filter(|edge| !sewn.contains(edge)).collect();
        if left.len() == full.len() {
            free.push(format!("{name}.*"));
        } else {
            free.extend(left.into_iter().filter(|edge| !lies_on_fold(piece, edge)).cloned());
        }
    }
    GarmentFile {
        seams: suggestions.iter().map(Suggestion::seam).collect(),
        free: free.into_iter().map(at_no_place).collect(),
        ..file.clone()
    }
}

/// `front.neck` of `front.L.neck`.
fn whole(edge: &str) -> String {
    let words: Vec<&str> = edge.split('.').filter(|word| !["L", "R"].contains(word)).collect();
    words.join(".")
}

fn lies_on_fold(piece: &PieceFile, edge: &str) -> bool {
    let on = piece.cut.as_ref().and_then(|cut| if let CutKind::Fold(on) = &cut.value { Some(on) } else { None });
    on.is_some_and(|on| format!("{}.{on}", piece.name.value) == edge)
}

/// All that was found, those that most speaks for first.
pub(super) fn written(
    outlines: &[Outline],
    sides: &Sides,
    runs: &[EdgeRun],
    matches: &[Match],
    chained: &[ChainMatch],
    mirrored: &[(EdgeRun, f64, String)],
) -> Vec<Suggestion> {
    let pieces = |runs: &[&EdgeRun]| -> Vec<usize> { runs.iter().map(|run| run.piece).collect() };
    let mut found: Vec<(Vec<usize>, Suggestion, Option<Side>)> = Vec::new();
    for own in matches {
        let lists = [(&own.a, false), (&own.b, own.opposed)];
        let [sew, to] = lists.map(|(run, backward)| edges(outlines, run, backward, None));
        let lengths = [own.a.length(), own.b.length()];
        let made = suggestion(sew, to, lengths, own.score, &own.reasons);
        let side = sides.of(outlines, [&[(own.a.piece, true)], &[(own.b.piece, !own.opposed)]]);
        found.push((pieces(&[&own.a, &own.b]), if own.eased { made.eased() } else { made }, side));
    }
    for own in chained {
        let of = |chain: &RunChain| chain.runs.iter().map(|(run, _)| runs[*run].piece).collect::<Vec<usize>>();
        let to = walked(outlines, runs, &own.b, true, None);
        let sew =
            if own.doubled { both_halves(outlines, runs, &own.a) } else { walked(outlines, runs, &own.a, true, None) };
        let lengths = [own.a.length * if own.doubled { 2.0 } else { 1.0 }, own.b.length];
        let made = suggestion(sew, to, lengths, own.score, &own.reasons);
        let made = match own.lapped {
            Some(length) => made.lapped(length),
            None if own.eased => made.eased(),
            None => made,
        };
        let ways = |chain: &RunChain| -> Vec<(usize, bool)> {
            chain.runs.iter().map(|&(run, forward)| (runs[run].piece, forward)).collect()
        };
        let side = sides.of(outlines, [&ways(&own.a), &ways(&own.b)]);
        found.push((of(&own.b).into_iter().chain(of(&own.a)).collect(), made, side));
    }
    for (run, score, reason) in mirrored {
        let to = vec!["mirror".to_owned()];
        let sew = edges(outlines, run, false, None);
        let made = suggestion(sew, to, [run.length(); 2], *score, std::slice::from_ref(reason));
        found.push((vec![run.piece], made, None));
    }
    found.sort_by(|a, b| b.1.score.total_cmp(&a.1.score));
    let both = |(pieces, own, side): (Vec<usize>, Suggestion, Option<Side>)| {
        sides.both(own, side).into_iter().map(move |own| (pieces.clone(), own))
    };
    let found = found.into_iter().flat_map(both);
    named(outlines, found.collect())
}

/// Edges of pieces of which there is a left and a right, and of whole pieces that they are sewn to.
pub(super) struct Sides {
    /// Names of pieces with a left and a right.
    mirrored: Vec<String>,
    /// Which of a left and a right is drawn, of each piece.
    drawn: Vec<Side>,
    /// Names of edges of whole pieces, each with that of its mirror image.
    images: Vec<(String, String)>,
}

impl Sides {
    pub(super) fn new(outlines: &[Outline], images: impl Fn(usize) -> Vec<(usize, usize)>, guesses: &[Guess]) -> Self {
        let full =
            |piece: usize, edge: usize| format!("{}.{}", outlines[piece].piece, outlines[piece].edges[edge].name);
        let of =
            |piece: usize| images(piece).into_iter().map(move |(edge, image)| (full(piece, edge), full(piece, image)));
        Self {
            mirrored: outlines.iter().filter(|outline| outline.mirrored).map(|outline| outline.piece.clone()).collect(),
            drawn: guesses.iter().map(|guess| guess.drawn.unwrap_or(Side::Left)).collect(),
            images: (0..outlines.len()).flat_map(of).collect(),
        }
    }

    /// The side of the wearer on which a seam is that sews a whole piece to one with a left and a right. `walked` are
    /// the pieces of its two lists, each with whether it is walked clockwise.
    fn of(&self, outlines: &[Outline], walked: [&[(usize, bool)]; 2]) -> Option<Side> {
        let all = || [0, 1].into_iter().flat_map(|list| walked[list].iter().map(move |own| (list, own.0, own.1)));
        let whole = all().find(|(_, piece, _)| !outlines[*piece].mirrored)?;
        let half = all().find(|(_, piece, _)| outlines[*piece].mirrored)?;
        // What is drawn as it is on that side goes round the same way in one list, and the other way in the other.
        let alike = (whole.2 == half.2) == (whole.0 == half.0);
        let drawn = self.drawn[half.1];
        Some(if alike { drawn } else { drawn.other() })
    }

    /// A seam of a piece with a left and a right to one side of a whole piece as two seams, one for each side.
    fn both(&self, own: Suggestion, side: Option<Side>) -> Vec<Suggestion> {
        let edges: Vec<&String> = own.sew.iter().chain(&own.to).collect();
        let is_told = |edge: &String| edge == "mirror" || edge.contains('@') || edge.matches('.').count() > 1;
        let image = |edge: &str| self.images.iter().find(|(own, _)| own == edge).map(|(_, image)| image.clone());
        let is_half =
            |edge: &str| edge.split_once('.').is_some_and(|(piece, _)| self.mirrored.iter().any(|name| name == piece));
        let aside = |edge: &&String| image(edge).is_some_and(|image| image != ***edge);
        let has_both = edges.iter().any(|edge| is_half(edge)) && edges.iter().any(aside);
        let Some(first) = side.filter(|_| has_both && !edges.iter().any(|edge| is_told(edge))) else {
            return vec![own];
        };
        let on = |side: Side| {
            let edge = |edge: &String| match image(edge) {
                _ if is_half(edge) => edge.replacen('.', &format!(".{}.", side.letter()), 1),
                Some(image) if side != first => image,
                _ => edge.clone(),
            };
            let [sew, to] = [&own.sew, &own.to].map(|edges| edges.iter().map(edge).collect());
            Suggestion { sew, to, ..own.clone() }
        };
        vec![on(first), on(first.other())]
    }
}

fn suggestion(sew: Vec<String>, to: Vec<String>, lengths: [f64; 2], score: f64, reasons: &[String]) -> Suggestion {
    Suggestion { name: String::new(), sew, to, lengths, ease: None, gather: None, score, reasons: reasons.to_vec() }
}

/// A half and its mirror image, from side to side over the middle of the wearer, or from fold to fold and back.
fn both_halves(outlines: &[Outline], runs: &[EdgeRun], half: &RunChain) -> Vec<String> {
    let begins_in_middle = half.middles == [true, false];
    let [first, second] = if begins_in_middle { ["R", "L"] } else { ["L", "R"] };
    let one = walked(outlines, runs, half, !begins_in_middle, Some(first));
    one.into_iter().chain(walked(outlines, runs, half, begins_in_middle, Some(second))).collect()
}

/// `front.a`, `front.b`: the edges of a run as they are walked, of one side if that is said.
fn edges(outlines: &[Outline], run: &EdgeRun, backward: bool, side: Option<&str>) -> Vec<String> {
    let outline = &outlines[run.piece];
    let piece = side.map_or_else(|| outline.piece.clone(), |side| format!("{}.{side}", outline.piece));
    let mut names: Vec<String> = run.edges.iter().map(|&k| format!("{piece}.{}", outline.edges[k].name)).collect();
    if backward {
        names.reverse();
    }
    names
}

fn walked(outlines: &[Outline], runs: &[EdgeRun], chain: &RunChain, onward: bool, side: Option<&str>) -> Vec<String> {
    let of = |&(run, forward): &(usize, bool)| edges(outlines, &runs[run], forward != onward, side);
    if onward { chain.runs.iter().flat_map(of).collect() } else { chain.runs.iter().rev().flat_map(of).collect() }
}

/// Names after the pieces: `front_back`, `front_back_2`.
fn named(outlines: &[Outline], found: Vec<(Vec<usize>, Suggestion)>) -> Vec<Suggestion> {
    let mut taken: Vec<String> = Vec::new();
    let name = |(mut pieces, own): (Vec<usize>, Suggestion)| {
        pieces.dedup();
        let words: Vec<&str> = pieces.iter().take(3).map(|&k| outlines[k].piece.as_str()).collect();
        let stem = words.join("_");
        let mut name = stem.clone();
        let mut again = 2;
        while taken.contains(&name) {
            name = format!("{stem}_{again}");
            again += 1;
        }
        taken.push(name.clone());
        Suggestion { name, ..own }
    };
    found.into_iter().map(name).collect()
}
