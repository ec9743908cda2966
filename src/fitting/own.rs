//! Knobs that are found from the garment: seams that pass a girth, from where they are worn, and pieces that end at an
//! opening, from their grain.

use super::figure::Figure;
use super::knob::{Knob, Origin, alterations, here, length, rounded, taken};
use super::seams::{GirthPlane, Passing, is_plain, passing};
use crate::geometry::{MM, Vec2, Vec3, range_of};
use crate::io::garment::Loaded;
use crate::pattern::{AlterationFile, Garment, Piece, Unit, WantFile, is_girth, walk, written_edge};
use crate::pipeline::Job;
use crate::report::Report;

/// How far a seam is taken in or let out, mm.
const SEAM: [f64; 2] = [-40.0, 40.0];
/// How far a piece is shortened or lengthened, mm.
const LENGTH: [f64; 2] = [-120.0, 150.0];
/// A knob with less room than this to either side is none, mm.
const LEAST: f64 = 3.0;
/// A change with which it is tried whether a pattern stays a garment, mm.
const TRIED: f64 = 5.0;
/// Steps to which the room of a knob is found, mm.
const ROOM: f64 = 1.0;
/// Stations of a seam nearer to each other than this share of its length are one.
const ONE: f64 = 0.12;
/// Least |cosine| of a seam against the side of the trunk.
const AT_SIDE: f64 = 0.6;
/// Share of what a change makes of the lengths of other seams that may be left when a second seam makes up for it.
const LEFT: f64 = 0.3;
/// A second seam is moved at most so many times as far.
const FARTHEST: f64 = 2.0;
/// Longest stretch of a piece, before its hem, that is made longer or shorter, metres.
const STRETCH: f64 = 0.15;
/// Least |cosine| between the grain and an axis of the drawing along which a piece is lengthened.
const UPRIGHT: f64 = 0.95;
/// Positions in drawings are written to this, mm.
const TENTH: f64 = 0.1;

/// The garment as it was first draped.
pub(super) struct FirstDrape<'a> {
    pub(super) loaded: &'a Loaded,
    pub(super) job: &'a Job,
    /// Positions of the particles.
    pub(super) at: &'a [Vec3],
    pub(super) report: &'a Report,
}

impl FirstDrape<'_> {
    /// Knobs for figures, each once.
    pub(super) fn knobs(&self, figures: &[&Figure]) -> Vec<Knob> {
        let mut out: Vec<Knob> = Vec::new();
        for figure in figures {
            let found = match &figure.want {
                WantFile::Ease(girth, _) | WantFile::Pressure(girth, _) => self.at_girth(girth, &out),
                WantFile::Strain(_) => self.tightest().and_then(|girth| self.at_girth(&girth, &out)),
                WantFile::HemHeight(_) => self.length("floor", "hem"),
                WantFile::SleeveEnd(_) => self.length("wrist", "sleeves"),
                WantFile::LegEnd(_) => self.length("ankle", "legs"),
                WantFile::HemLevel(_) => None,
            };
            out.extend(
                found.filter(|knob| out.iter().all(|own| own.name != knob.name)).into_iter().collect::<Vec<_>>(),
            );
        }
        out
    }

    fn unit(&self) -> Unit {
        self.loaded.file.unit()
    }

    /// The girth at which threads are drawn out most.
    fn tightest(&self) -> Option<String> {
        let girths = &self.report.fit.as_ref()?.girths;
        girths.iter().max_by(|a, b| a.cloth.total_cmp(&b.cloth)).map(|girth| girth.name.clone())
    }

    /// A knob for the seams at the sides of a girth.
    fn at_girth(&self, wanted: &str, known: &[Knob]) -> Option<Knob> {
        let girths = &self.report.fit.as_ref()?.girths;
        let rows = girths.iter().filter(|girth| is_girth(wanted, &girth.name));
        let mut seams: Vec<Passing> = Vec::new();
        for plane in rows.filter_map(|row| GirthPlane::new(row, &self.job.body)) {
            // A limb's seam is the other limb's as well where the file has one for both.
            let found = chosen(passing(&plane, &self.loaded.file, self.job, self.at));
            seams.extend(found.into_iter().filter(|p| seams.iter().all(|s| s.seam != p.seam)).collect::<Vec<_>>());
        }
        let is_known = |own: &Passing| known.iter().any(|knob| self.has_station(knob, own));
        if seams.is_empty() || seams.iter().any(is_known) {
            return None;
        }
        let names: Vec<String> = seams.iter().map(|s| s.seam.clone()).collect();
        let parts = |share: &dyn Fn(&Passing) -> f64| -> Vec<[AlterationFile; 2]> {
            seams.iter().map(|s| SEAM.map(|mm| taken(&s.seam, share(s), mm, self.unit()))).collect()
        };
        let name = format!("{} at the {wanted}", names.join(" and "));
        let origin = Origin::Seams { seams: names, girth: wanted.to_owned() };
        let knob = Knob { name, parts: parts(&|s| s.share), range: SEAM, origin };
        self.with_room(self.made_up_for(knob))
    }

    /// Whether a knob has a station of a seam next to this one.
    fn has_station(&self, knob: &Knob, own: &Passing) -> bool {
        knob.parts.iter().any(|part| match &part[0] {
            AlterationFile::Take { seam, at, .. } if seam.value == own.seam => {
                at.iter().any(|(place, _)| (place.value.number / 100.0 - own.share).abs() < ONE)
            }
            _ => false,
        })
    }

    /// A knob with a second seam that keeps the lengths of others, where the first changes them too far: a sleeve's
    /// with that of an armhole.
    fn made_up_for(&self, knob: Knob) -> Knob {
        let alone = |knob: &Knob, mm: f64| self.loaded.altered(&alterations(std::slice::from_ref(knob), &[mm])).ok();
        if alone(&knob, TRIED).is_some() && alone(&knob, -TRIED).is_some() {
            return knob;
        }
        // Small enough that the pattern is still one.
        const SMALL: f64 = 0.25;
        let Some(moved) = alone(&knob, SMALL).map(|new| self.differences(&new.garment)) else { return knob };
        let largest = moved.iter().fold(0.0f64, |a, b| a.max(b.abs()));
        let Origin::Seams { seams, .. } = &knob.origin else { return knob };
        let others = self.loaded.file.seams.iter().filter(|s| is_plain(s) && !seams.contains(&s.name.value));
        let ends = others.flat_map(|s| [0.0, 1.0].map(|share| (s.name.value.clone(), share)));
        let best = ends.filter_map(|(seam, share)| {
            let by = |mm: f64| taken(&seam, share, mm, self.unit());
            let second = self.loaded.altered(&[by(SMALL)]).ok()?;
            let second = self.differences(&second.garment);
            let square: f64 = second.iter().map(|d| d * d).sum();
            let times = -moved.iter().zip(&second).map(|(a, b)| a * b).sum::<f64>() / square.max(f64::MIN_POSITIVE);
            let left = moved.iter().zip(&second).map(|(a, b)| (a + times * b).abs()).fold(0.0, f64::max);
            let suits = left < LEFT * largest && times.abs() <= FARTHEST;
            suits.then(|| (left, SEAM.map(|mm| by(times * mm))))
        });
        let best = best.min_by(|a, b| a.0.total_cmp(&b.0));
        let mut out = knob;
        out.parts.extend(best.map(|(_, part)| part));
        out
    }

    /// How the differences of the two sides of all seams change with a pattern, metres.
    fn differences(&self, new: &Garment) -> Vec<f64> {
        let difference = |garment: &Garment| walk(garment).into_iter().map(|s| s.difference).collect::<Vec<f64>>();
        difference(new).iter().zip(difference(&self.loaded.garment)).map(|(a, b)| a - b).collect()
    }

    /// A knob within the amounts with which the pattern stays a garment. `None` where these are too few.
    fn with_room(&self, knob: Knob) -> Option<Knob> {
        let is_garment = |mm: f64| self.loaded.altered(&alterations(std::slice::from_ref(&knob), &[mm])).is_ok();
        let room = |end: f64| {
            if is_garment(end) {
                return end;
            }
            let (mut good, mut bad) = (0.0f64, end);
            while (bad - good).abs() > ROOM {
                let middle = 0.5 * (good + bad);
                if is_garment(middle) { good = middle } else { bad = middle }
            }
            good.trunc()
        };
        let range = knob.range.map(room);
        let origin = knob.origin.clone();
        let scaled = knob.parts.iter().map(|ends| scaled(ends, knob.range, range)).collect();
        (range[1].max(-range[0]) >= LEAST).then_some(Knob { name: knob.name, parts: scaled, range, origin })
    }

    /// A knob for the length of the pieces round the openings that are measured against this end.
    fn length(&self, against: &str, end: &'static str) -> Option<Knob> {
        let lengths = self.report.fit.as_ref()?.lengths.iter().filter(|l| l.against.ends_with(against));
        let openings: Vec<&str> = lengths.map(|l| l.name.as_str()).collect();
        let rows = self.report.worn.iter().filter(|w| openings.contains(&w.opening.as_str()));
        let edges: Vec<&String> = rows.flat_map(|w| &w.edges).collect();
        let mut ends: Vec<PieceEnd> = Vec::new();
        for piece in &self.job.garment.pieces {
            let is_hem = |name: &str| {
                let own = format!("{}.{}", piece.name, written_edge(name));
                edges.iter().any(|edge| **edge == own || plain(edge) == plain(&own))
            };
            if ends.iter().all(|e| e.piece != piece.drawn_as) {
                ends.extend(PieceEnd::of(piece, is_hem));
            }
        }
        let stretch = ends.iter().map(|e| e.room).fold(STRETCH, f64::min);
        if ends.is_empty() || stretch * MM < LEAST {
            return None;
        }
        let pieces: Vec<String> = ends.iter().map(|e| e.piece.clone()).collect();
        let longer = |ends: Vec<&PieceEnd>| LENGTH.map(|mm| lengthened(&ends, mm, stretch, self.unit()));
        let parts = together(&ends).into_iter().map(longer).collect();
        let name = format!("length of {}", pieces.join(", "));
        let knob = Knob { name, parts, range: LENGTH, origin: Origin::Length { pieces, end } };
        self.with_room(knob)
    }
}

/// The same alteration with the amounts of another range.
fn scaled(ends: &[AlterationFile; 2], from: [f64; 2], to: [f64; 2]) -> [AlterationFile; 2] {
    let amount = |x: f64, end: usize| x * to[end] / from[end];
    [0, 1].map(|k| {
        let mut out = ends[k].clone();
        match &mut out {
            AlterationFile::Take { at, .. } => {
                at.iter_mut().for_each(|s| s.1.value.number = amount(s.1.value.number, k));
            }
            AlterationFile::Lengthen { by, .. } => by.value.number = amount(by.value.number, k),
            _ => {}
        }
        out
    })
}

/// `piece.edge` without its sides.
fn plain(name: &str) -> String {
    name.split('.').filter(|word| !matches!(*word, "L" | "R")).collect::<Vec<_>>().join(".")
}

/// Of the seams that pass a girth the one at both sides, or else one at each: those that lie most squarely at the side.
fn chosen(found: Vec<Passing>) -> Vec<Passing> {
    let best = |keep: &dyn Fn(&Passing) -> bool| {
        let fit = found.iter().filter(|p| p.sideways >= AT_SIDE && keep(p));
        fit.max_by(|a, b| a.sideways.total_cmp(&b.sideways)).cloned()
    };
    if let Some(both) = best(&|p| p.sides == [true; 2]) {
        return vec![both];
    }
    [best(&|p| p.sides[0]), best(&|p| p.sides[1])].into_iter().flatten().collect()
}

/// A piece that ends at an opening.
struct PieceEnd {
    /// As drawn.
    piece: String,
    /// Whether x is the coordinate that runs along the grain.
    across: bool,
    /// Where its edge round the opening begins, coming from within the piece, metres.
    from: f64,
    /// Whether coordinates fall towards the opening.
    falling: bool,
    /// How far from there its neighbouring edges go on, metres.
    room: f64,
}

impl PieceEnd {
    fn of(piece: &Piece, is_hem: impl Fn(&str) -> bool) -> Option<Self> {
        let ring = &piece.loops[0];
        let across = piece.warp.x.abs() > piece.warp.y.abs();
        let axis = if across { Vec2::x() } else { Vec2::y() };
        // A mirrored piece has the drawn one's x with the other sign; none of these is lengthened along x.
        if axis.dot(&piece.warp).abs() < UPRIGHT || (across && ring.iter().any(|edge| edge.against)) {
            return None;
        }
        let along = |path: &crate::geometry::Path| range_of(path.sampled(1e-4).iter().map(|p| axis.dot(p)));
        let hems: Vec<usize> = (0..ring.len()).filter(|&k| is_hem(&ring[k].name)).collect();
        let [low, high] = range_of(hems.iter().flat_map(|&k| along(&ring[k].path)));
        let [least, most] = range_of(ring.iter().flat_map(|edge| along(&edge.path)));
        let falling = low + high < least + most;
        let next = |k: usize| [(k + ring.len() - 1) % ring.len(), (k + 1) % ring.len()];
        let beside = hems.iter().flat_map(|&k| next(k)).filter(|k| !hems.contains(k));
        let from = if falling { high } else { low };
        let room = |k: usize| {
            let [a, b] = along(&ring[k].path);
            if falling { b - from } else { from - a }
        };
        let room = beside.map(room).reduce(f64::min)?;
        (room > 0.0).then(|| Self { piece: piece.drawn_as.clone(), across, from, falling, room })
    }
}

/// Pieces that end at one line of their drawings are lengthened in one: they may be like one another.
fn together(ends: &[PieceEnd]) -> Vec<Vec<&PieceEnd>> {
    let mut out: Vec<Vec<&PieceEnd>> = Vec::new();
    for end in ends {
        let is_same = |other: &PieceEnd| {
            (other.across, other.falling) == (end.across, end.falling) && (other.from - end.from).abs() * MM < TENTH
        };
        match out.iter_mut().find(|group| is_same(group[0])) {
            Some(group) => group.push(end),
            None => out.push(vec![end]),
        }
    }
    out
}

/// Pieces made longer before their opening, over a stretch in metres.
fn lengthened(ends: &[&PieceEnd], mm: f64, stretch: f64, unit: Unit) -> AlterationFile {
    let first = ends[0];
    let at = if first.falling { first.from } else { first.from - stretch };
    let tenths = |x: f64| (x * MM / TENTH).round() * TENTH;
    AlterationFile::Lengthen {
        pieces: ends.iter().map(|end| here(end.piece.clone())).collect(),
        at: length(rounded(tenths(at)), unit),
        by: length(mm, unit),
        // Within the piece, whatever was rounded.
        over: Some(length(rounded((tenths(stretch) - TENTH).max(TENTH)), unit)),
        across: first.across.then(|| here(true)),
        shorter: false,
    }
}
