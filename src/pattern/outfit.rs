//! Garments worn over one another, as one.

use super::{Bound, Closure, EdgeId, Garment, Seam, Span, Test};

/// Separator between the name of an outfit's garment and that of its piece, seam or fabric.
const OF: char = '/';

/// Makes one garment of several, given from the skin outwards. A single one stays as it is.
///
/// Pieces, seams and fabrics are named `garment/piece`. If two garments have one name, the second becomes `shirt.2`.
/// Every layer of a garment lies outside all layers of those before it. Tests apply to their own garment. The body is
/// that of the first garment.
pub fn outfit(mut garments: Vec<Garment>) -> Garment {
    if garments.len() == 1 {
        return garments.remove(0);
    }
    let labels = labels(&garments);
    let title = garments.iter().map(|g| g.title.clone()).collect::<Vec<String>>().join(" + ");
    let mut whole = Garment {
        name: labels.join("+"),
        title,
        body: garments.first().and_then(|g| g.body.clone()),
        pieces: Vec::new(),
        seams: Vec::new(),
        fabrics: Vec::new(),
        closures: Vec::new(),
        worn: labels.clone(),
        tests: Vec::new(),
    };
    for (garment, label) in garments.into_iter().zip(&labels) {
        whole.put_on(garment, label);
    }
    whole
}

/// Whether `name` belongs to the garment of an outfit that is called `label`.
pub fn belongs_to(name: &str, label: &str) -> bool {
    name.strip_prefix(label).is_some_and(|rest| rest.starts_with(OF))
}

/// A name without the garment's before it: that says nothing of where a piece goes.
pub(super) fn own_name(name: &str) -> &str {
    name.rsplit(OF).next().unwrap_or(name)
}

/// The garments' names. One that is taken has a number behind it.
fn labels(garments: &[Garment]) -> Vec<String> {
    let mut labels: Vec<String> = Vec::new();
    for garment in garments {
        let numbered = (2..).map(|n| format!("{}.{n}", garment.name));
        let free = std::iter::once(garment.name.clone()).chain(numbered).find(|name| !labels.contains(name));
        labels.extend(free);
    }
    labels
}

impl Garment {
    /// Adds a garment that is worn over the present ones.
    fn put_on(&mut self, garment: Garment, label: &str) {
        let named = |name: &str| format!("{label}{OF}{name}");
        let first = self.pieces.len();
        let lowest = garment.pieces.iter().map(|p| p.layer).min().unwrap_or(0);
        let outermost = self.pieces.iter().map(|p| p.level()).max();
        let beneath = outermost.map_or(0, |most| most.saturating_add(1).saturating_sub(lowest));
        for mut piece in garment.pieces {
            piece.name = named(&piece.name);
            piece.drawn_as = named(&piece.drawn_as);
            piece.fabric = named(&piece.fabric);
            piece.beneath = beneath;
            piece.notches.iter_mut().for_each(|notch| notch.edge = later(notch.edge, first));
            self.pieces.push(piece);
        }
        self.seams.extend(garment.seams.into_iter().map(|seam| Seam {
            name: named(&seam.name),
            a: moved(&seam.a, first),
            b: moved(&seam.b, first),
            ..seam
        }));
        self.fabrics.extend(garment.fabrics.into_iter().map(|mut fabric| {
            fabric.name = named(&fabric.name);
            fabric
        }));
        let points = |all: Vec<[(usize, crate::geometry::Vec2); 2]>| {
            all.into_iter().map(|pair| pair.map(|(piece, at)| (piece + first, at))).collect()
        };
        self.closures.extend(garment.closures.into_iter().map(|closure| Closure {
            on: closure.on.as_deref().map(named),
            meets: closure.meets.as_deref().map(named),
            tacks: points(closure.tacks),
            mirrored: points(closure.mirrored),
            ..closure
        }));
        self.tests.extend(garment.tests.into_iter().map(|test| Test {
            bound: bound(test.bound, named),
            fabric: test.fabric,
            of: Some(label.to_owned()),
        }));
    }
}

/// The edge with its piece's index increased by `first`.
fn later(edge: EdgeId, first: usize) -> EdgeId {
    EdgeId { piece: edge.piece + first, ..edge }
}

fn moved(chain: &[Span], first: usize) -> Vec<Span> {
    chain.iter().map(|span| Span { edge: later(span.edge, first), ..*span }).collect()
}

/// The same bound, with new names.
fn bound(bound: Bound, named: impl Fn(&str) -> String) -> Bound {
    let full = |name: Option<String>| name.as_deref().map(&named);
    match bound {
        Bound::SeamLength(seam, limit) => Bound::SeamLength(full(seam), limit),
        Bound::Gap(seam, limit) => Bound::Gap(full(seam), limit),
        Bound::Flatten { piece, area, boundary } => Bound::Flatten { piece: full(piece), area, boundary },
        Bound::Drape { piece, area, boundary } => Bound::Drape { piece: full(piece), area, boundary },
        // Kinds of closures have one name in all garments. Crossings are those of the whole.
        Bound::Closure(..)
        | Bound::Crossings(_)
        | Bound::Worn
        | Bound::Ease { .. }
        | Bound::Pressure(..)
        | Bound::HemLevel(_) => bound,
    }
}
