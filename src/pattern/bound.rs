//! The garment's own regression bounds.

use std::path::Path;

use super::diagnostic::{Findings, Located};
use super::file::{GarmentFile, TestEntry, TestFile};
use super::inherit::unknown_piece;
use super::problem::Problem;
use super::reference::piece_of;
use super::value::{Quantity, Unit};
use super::{Bound, GIRTHS, Garment, OF_TRUNK, SIDES, Test, openings};
use crate::input::nearest;

/// The bounds of the file. `openings` is checked at once, because it needs no simulation. A garment that is not `sound`
/// lacks pieces, seams and closures, so that names are looked up in the file.
pub(super) fn bounds(file: &GarmentFile, garment: &Garment, sound: bool, findings: &mut Findings) -> Vec<Test> {
    let reader = BoundReader { file, garment, sound };
    let test = |entry: &Located<TestEntry>| {
        let fabric = entry.value.fabric.as_ref().map(|f| reader.fabric(f, findings));
        Some(Test { bound: reader.bound(entry, findings)?, fabric, of: None })
    };
    file.tests.iter().filter_map(test).collect()
}

struct BoundReader<'a> {
    file: &'a GarmentFile,
    garment: &'a Garment,
    sound: bool,
}

impl BoundReader<'_> {
    fn bound(&self, test: &Located<TestEntry>, findings: &mut Findings) -> Option<Bound> {
        let value = |q: &Located<Quantity>| q.value.value(self.file.unit());
        Some(match &test.value.test {
            TestFile::Seam(name, limit) => Bound::SeamLength(self.seam(name, findings), value(limit)),
            TestFile::Gap(name, limit) => Bound::Gap(self.seam(name, findings), value(limit)),
            TestFile::Closure(kind, limit) => Bound::Closure(self.closure(kind, findings), value(limit)),
            TestFile::Flatten(name, area, boundary) => Bound::Flatten {
                piece: self.piece(name, findings),
                area: area.as_ref().map(fraction),
                boundary: boundary.as_ref().map(value),
            },
            TestFile::Drape(name, area, boundary) => Bound::Drape {
                piece: self.piece(name, findings),
                area: area.as_ref().map(fraction),
                boundary: boundary.as_ref().map(fraction),
            },
            TestFile::Crossings(most) => Bound::Crossings(*most),
            TestFile::Worn => Bound::Worn,
            TestFile::Ease(girth, from, to) => Bound::Ease {
                girth: known_girth(girth, findings)?,
                from: from.as_ref().map(value),
                to: to.as_ref().map(value),
            },
            TestFile::Pressure(girth, below) => Bound::Pressure(known_girth(girth, findings)?, below.value),
            TestFile::HemLevel(within) => Bound::HemLevel(value(within)),
            TestFile::Openings(expected) => {
                if self.sound {
                    self.count_openings(test, *expected, findings);
                }
                return None;
            }
        })
    }

    /// A shipped fabric, one of the garment's own or a file. The garment cannot be made in any other.
    fn fabric(&self, name: &Located<String>, findings: &mut Findings) -> String {
        let own = self.garment.fabrics.iter().map(|f| f.name.as_str());
        let known: Vec<&str> = own.chain(crate::fabric::library()).collect();
        if !known.contains(&name.value.as_str()) && Path::new(&name.value).extension().is_none() {
            let near = nearest(&name.value, known.iter().copied()).map(str::to_owned);
            let problem = Problem::UnknownFabric { name: name.value.clone(), nearest: near, known: known.join(", ") };
            findings.error(name.at, problem);
        }
        name.value.clone()
    }

    fn seam(&self, name: &Located<String>, findings: &mut Findings) -> Option<String> {
        let names = || self.file.seams.iter().map(|s| s.name.value.as_str());
        let exact = self.garment.seams.iter().any(|s| s.name == name.value) || self.may_be_there(&name.value, names());
        if name.value == "all" {
            return None;
        }
        if !exact && !names().any(|n| n == name.value) {
            let near = nearest(&name.value, names()).map(str::to_owned);
            let known = names().collect::<Vec<_>>().join(", ");
            findings.error(name.at, Problem::UnknownSeam { name: name.value.clone(), nearest: near, known });
        }
        Some(name.value.clone())
    }

    /// A kind of closure, of which one at least has points that can be measured.
    fn closure(&self, kind: &Located<String>, findings: &mut Findings) -> Option<String> {
        let measured = self.garment.closures.iter().filter(|c| !(c.tacks.is_empty() && c.mirrored.is_empty()));
        let mut kinds: Vec<&str> = measured.map(|c| c.kind.as_str()).collect();
        kinds.sort_unstable();
        kinds.dedup();
        let all = kind.value == "all";
        if self.sound && (kinds.is_empty() || !all && !kinds.contains(&kind.value.as_str())) {
            let near = nearest(&kind.value, kinds.iter().copied()).map(str::to_owned);
            let (name, known) = (kind.value.clone(), kinds.join(", "));
            findings.error(kind.at, Problem::UnknownClosure { name, nearest: near, known });
        }
        (!all).then(|| kind.value.clone())
    }

    fn piece(&self, name: &Located<String>, findings: &mut Findings) -> Option<String> {
        if name.value == "all" {
            return None;
        }
        let exact = self.garment.pieces.iter().any(|p| p.name == name.value || p.drawn_as == name.value);
        if !exact && !self.may_be_there(&name.value, std::iter::empty()) {
            findings.error(name.at, unknown_piece(&name.value, self.file.pieces.iter().map(|p| p.name.value.as_str())));
        }
        Some(name.value.clone())
    }

    /// Whether a name may be that of a side, a copy or a dart (`side.L`, `front.dart`) which is missing because of
    /// other mistakes.
    fn may_be_there<'n>(&self, name: &str, mut seams: impl Iterator<Item = &'n str>) -> bool {
        let stem = piece_of(name);
        !self.sound && (seams.any(|s| s == stem) || self.file.pieces.iter().any(|p| p.name.value == stem))
    }

    fn count_openings(&self, test: &Located<TestEntry>, expected: usize, findings: &mut Findings) {
        let found = openings(self.garment);
        if found.len() == expected {
            return;
        }
        let rims: Vec<String> = found.iter().filter_map(|o| self.garment.opening_edges(o).into_iter().next()).collect();
        let rims = format!("at {}", rims.join(", "));
        findings.error(test.at, Problem::Openings { found: found.len(), expected, rims });
    }
}

/// The girth of a test, if there is one of that name.
pub(crate) fn known_girth(girth: &Located<String>, findings: &mut Findings) -> Option<String> {
    let of_limb = SIDES.iter().find_map(|side| girth.value.strip_prefix(side));
    let is_known = GIRTHS.contains(&girth.value.as_str()) || of_limb.is_some_and(|g| GIRTHS[OF_TRUNK..].contains(&g));
    if !is_known {
        let near = nearest(of_limb.unwrap_or(&girth.value), GIRTHS).map(str::to_owned);
        findings.error(girth.at, Problem::UnknownGirth { name: girth.value.clone(), nearest: near });
    }
    is_known.then(|| girth.value.clone())
}

/// A bare number is a fraction, `0.5 %` is 0.005.
fn fraction(q: &Located<Quantity>) -> f64 {
    q.value.number * if q.value.is_percent() { Unit::Percent.factor() } else { 1.0 }
}
