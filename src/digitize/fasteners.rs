//! Buttons and buttonholes of a drawing as closures.

use super::stated::{at_no_place, file_point};
use super::{Fastener, FastenerKind};
use crate::geometry::Vec2;
use crate::pattern::{ClosureFile, CutKind, PieceFile};

/// Buttons and buttonholes no farther apart than this (metres) are in one place.
const ONE_PLACE: f64 = 1e-3;
/// The words of a closure that is buttoned, and of one that is snapped.
const KINDS: [&str; 2] = ["button", "snap"];

/// A piece with its fasteners, in the places that its file has.
pub(super) struct Fastened {
    name: String,
    pair: bool,
    /// Places of buttons, buttonholes, studs and sockets, down the drawing.
    at: [Vec<Vec2>; 4],
}

impl Fastened {
    pub(super) fn new(piece: &PieceFile, fasteners: &[Fastener]) -> Self {
        let pair = piece.cut.as_ref().is_some_and(|cut| cut.value == CutKind::Pair);
        let at = [FastenerKind::Button, FastenerKind::Buttonhole, FastenerKind::Stud, FastenerKind::Socket];
        let places = |kind: FastenerKind| {
            let own = fasteners.iter().filter(|fastener| fastener.kind == kind);
            let mut places: Vec<Vec2> = own.map(|fastener| fastener.at).collect();
            places.sort_by(|a, b| a.y.total_cmp(&b.y).then(a.x.total_cmp(&b.x)));
            places
        };
        Self { name: piece.name.value.clone(), pair, at: at.map(places) }
    }

    /// The buttons of a kind of closure, and its buttonholes.
    fn both(&self, kind: usize) -> [&[Vec2]; 2] {
        [&self.at[2 * kind], &self.at[2 * kind + 1]]
    }
}

/// The closures of all pieces, and notes on those of which the drawing does not tell what they close.
pub(super) fn closures(pieces: &[Fastened], notes: &mut Vec<String>) -> Vec<ClosureFile> {
    let mut all = Vec::new();
    for (kind, word) in KINDS.into_iter().enumerate() {
        let mut met: Vec<&str> = Vec::new();
        for piece in pieces.iter().filter(|piece| !piece.both(kind)[0].is_empty()) {
            let [buttons, holes] = piece.both(kind);
            let other = partner(piece, pieces, kind);
            match other {
                _ if buttons.len() == holes.len() => all.extend(on_itself(piece, kind, word)),
                Some(other) => {
                    met.push(&other.name);
                    all.push(closure(word, [&piece.name, &other.name], [buttons, other.both(kind)[1]]));
                }
                None => {
                    all.push(alone(word, &piece.name, buttons));
                    notes.push(format!(
                        "the drawing does not tell what the {word}s on '{}' close: write 'meets', and 'meets_at' with \
                         as many points",
                        piece.name
                    ));
                }
            }
        }
        let unmet = |piece: &&Fastened| {
            let [buttons, holes] = piece.both(kind);
            !holes.is_empty() && buttons.len() != holes.len() && !met.contains(&piece.name.as_str())
        };
        let opposite = ["buttonhole", "socket"][kind];
        all.extend(pieces.iter().filter(unmet).map(|piece| alone(opposite, &piece.name, piece.both(kind)[1])));
    }
    all
}

/// The only other piece with as many buttonholes as a piece has buttons, and no buttons of its own.
fn partner<'p>(piece: &Fastened, pieces: &'p [Fastened], kind: usize) -> Option<&'p Fastened> {
    let fits =
        |other: &&Fastened| other.both(kind)[0].is_empty() && other.both(kind)[1].len() == piece.both(kind)[0].len();
    let mut fitting = pieces.iter().filter(fits);
    fitting.next().filter(|_| fitting.next().is_none())
}

/// A piece that has both: its two ends meet, as of a cuff; or its two halves, if they are in the same places.
fn on_itself(piece: &Fastened, kind: usize, word: &str) -> Vec<ClosureFile> {
    let [buttons, holes] = piece.both(kind);
    let name = &piece.name;
    if !piece.pair {
        return vec![closure(word, [name, name], [buttons, holes])];
    }
    if buttons.iter().zip(holes).all(|(a, b)| (a - b).norm() <= ONE_PLACE) {
        return vec![ClosureFile { meets: Some(at_no_place(name.clone())), ..alone(word, name, buttons) }];
    }
    let of_side = |side: &str| {
        let half = format!("{name}.{side}");
        closure(word, [&half, &half], [buttons, holes])
    };
    vec![of_side("L"), of_side("R")]
}

fn closure(kind: &str, [on, meets]: [&str; 2], [at, meets_at]: [&[Vec2]; 2]) -> ClosureFile {
    let meets_at = meets_at.iter().map(|p| at_no_place(file_point(*p))).collect();
    ClosureFile { meets: Some(at_no_place(meets.to_owned())), meets_at, ..alone(kind, on, at) }
}

/// Marks that close nothing yet.
fn alone(kind: &str, on: &str, at: &[Vec2]) -> ClosureFile {
    ClosureFile {
        kind: at_no_place(kind.to_owned()),
        on: Some(at_no_place(on.to_owned())),
        at: at.iter().map(|p| at_no_place(file_point(*p))).collect(),
        meets: None,
        meets_at: Vec::new(),
        pitch: None,
        count: None,
        hardware: Vec::new(),
    }
}
