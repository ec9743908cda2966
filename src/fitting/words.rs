//! Changes as a fitter would say them.

use super::knob::{Knob, NONE, Origin, alterations};
use crate::pattern::{AlterationFile, Located, Quantity};

/// An amount of a knob with its direction: `12 mm taken in`.
pub(super) fn amount_of(knob: &Knob, amount: f64) -> String {
    let far = mm(amount);
    match &knob.origin {
        Origin::Given => format!("{} mm", shown(amount)),
        Origin::Seams { .. } => format!("{far} {}", if amount < 0.0 { "let out" } else { "taken in" }),
        Origin::Length { .. } => format!("{far} {}", if amount < 0.0 { "shorter" } else { "longer" }),
    }
}

/// A knob set to an amount, as an order: `take in seam 'side' by 8 mm on each edge at the waist`. `None` where nothing
/// is to be done.
pub(super) fn order(knob: &Knob, amount: f64) -> Option<String> {
    if amount.abs() < NONE {
        return None;
    }
    let far = mm(amount);
    Some(match &knob.origin {
        Origin::Seams { seams, girth } => {
            let word = if amount < 0.0 { "let out" } else { "take in" };
            let (s, names) = (if seams.len() > 1 { "s" } else { "" }, quoted(seams));
            format!("{word} seam{s} {names} by {far} on each edge at the {girth}{}", also(knob, amount))
        }
        Origin::Length { pieces, end } => {
            let word = if amount < 0.0 { "shorten" } else { "lengthen" };
            format!("{word} {} by {far} at the {end}", quoted(pieces))
        }
        Origin::Given => {
            let all = alterations(std::slice::from_ref(knob), &[amount]);
            format!("{}: {}", knob.name, all.iter().map(plain).collect::<Vec<_>>().join(", "))
        }
    })
}

/// The second seam that makes up for the first.
fn also(knob: &Knob, amount: f64) -> String {
    let Origin::Seams { seams, .. } = &knob.origin else { return String::new() };
    let all = alterations(std::slice::from_ref(knob), &[amount]);
    let second = all.iter().filter(|a| matches!(a, AlterationFile::Take { seam, .. } if !seams.contains(&seam.value)));
    second.map(|a| format!(", and {}", plain(a))).collect()
}

fn mm(amount: f64) -> String {
    format!("{} mm", shown(amount.abs()))
}

/// To a tenth of a millimetre.
fn shown(x: f64) -> String {
    let tenths = (10.0 * x).round() / 10.0;
    format!("{}", if tenths == 0.0 { 0.0 } else { tenths })
}

fn quoted(names: &[String]) -> String {
    names.iter().map(|name| format!("'{name}'")).collect::<Vec<_>>().join(" and ")
}

fn quantity(q: &Located<Quantity>) -> String {
    let unit = q.value.unit.map_or("", |unit| unit.symbol());
    let number = (1e3 * q.value.number).round() / 1e3;
    if unit.is_empty() { format!("{number}") } else { format!("{number} {unit}") }
}

/// An alteration in words, its bare numbers in the file's units.
fn plain(alteration: &AlterationFile) -> String {
    match alteration {
        AlterationFile::Take { seam, at, out } => {
            let each: Vec<String> =
                at.iter().map(|(at, by)| format!("by {} at {}", quantity(by), quantity(at))).collect();
            format!("{} '{}' {}", if *out { "let out" } else { "take in" }, seam.value, each.join(", "))
        }
        AlterationFile::Lengthen { pieces, by, shorter, across, .. } => {
            let word = if *shorter { "shorten" } else { "lengthen" };
            let wide = if across.as_ref().is_some_and(|a| a.value) { " across" } else { "" };
            let names: Vec<String> = pieces.iter().map(|p| p.value.clone()).collect();
            format!("{word} {}{wide} by {}", quoted(&names), quantity(by))
        }
        AlterationFile::Pivot { dart, to, share, .. } => {
            let part = share.as_ref().map_or_else(|| "all".to_owned(), quantity);
            format!("turn {part} of '{}' to '{}'", dart.value, to.value)
        }
        AlterationFile::Spread { from, by, .. } => format!("spread '{}' by {}", from.value, quantity(by)),
        AlterationFile::Fullness { edge, by, .. } => format!("add fullness of {} at '{}'", quantity(by), edge.value),
        AlterationFile::Join { seam } => format!("join the pieces of '{}'", seam.value),
        AlterationFile::Cut { from, to, name, .. } => {
            format!("cut '{}' off from '{}' to '{}'", name.value, from.value, to.value)
        }
        AlterationFile::Move { edge, at } => {
            let shift = |by: &[f64; 2]| format!("[{}, {}]", by[0], by[1]);
            let each: Vec<String> =
                at.iter().map(|(at, by)| format!("by {} at {}", shift(&by.value), quantity(at))).collect();
            format!("move '{}' {}", edge.value, each.join(", "))
        }
    }
}
