//! Garments that can be put on and are too tight: their cloth is drawn out further than it gives.

use super::job::Job;
use crate::fabric::Fabric;
use crate::report::{PieceReport, Report};

/// A text that lists the pieces that are too tight, fabric by fabric, with a remedy. `None` if there are none.
pub(super) fn tight(job: &Job, report: &Report) -> Option<String> {
    told(report.pieces.iter().zip(job.fabrics.iter().map(AsRef::as_ref)))
}

fn told<'a>(pieces: impl Iterator<Item = (&'a PieceReport, &'a Fabric)>) -> Option<String> {
    let mut cloths: Vec<(&Fabric, Vec<String>)> = Vec::new();
    for (piece, fabric) in pieces.filter(|(piece, fabric)| is_tight(piece, fabric)) {
        let drawn_out = format!("'{}' (by {:.1} %)", piece.name, 100.0 * piece.drawn_out);
        match cloths.iter_mut().find(|(cloth, _)| cloth.name == fabric.name) {
            Some((_, pieces)) => pieces.push(drawn_out),
            None => cloths.push((fabric, vec![drawn_out])),
        }
    }
    let cloths: Vec<String> = cloths.iter().map(|(cloth, pieces)| of_cloth(cloth, pieces)).collect();
    (!cloths.is_empty()).then(|| {
        format!(
            "the garment is tight: {}; that is where a piece is drawn out most (99 % of it less), and --color strain \
             shows where; make it wider there, or take a cloth that gives more",
            cloths.join("; ")
        )
    })
}

fn of_cloth(cloth: &Fabric, pieces: &[String]) -> String {
    let [warp, weft] = cloth.emt().map(|strain| 100.0 * strain);
    format!(
        "{} gives {warp:.1} % along its warp and {weft:.1} % along its weft under 500 gf/cm, and drawn out further: {}",
        cloth.name,
        pieces.join(", ")
    )
}

/// Whether a hundredth of a piece's threads and more are drawn out further than `fabric` is under a tester's full load,
/// 500 gf/cm. Cloth is not worn so, though it may not tear.
fn is_tight(piece: &PieceReport, fabric: &Fabric) -> bool {
    let [warp, weft] = fabric.emt();
    piece.drawn_out > warp.max(weft)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::Spread;

    fn piece(name: &str) -> PieceReport {
        PieceReport { name: name.into(), drawn_out: 0.094, ..PieceReport::default() }
    }

    #[test]
    fn what_helps_is_said_once_for_all_pieces_that_are_tight() {
        let [denim, poplin, rib] =
            ["denim", "cotton_poplin", "rib"].map(|name| crate::fabric::load(name).expect("shipped"));
        let [front, back, band, yoke] = ["front", "back", "band", "yoke"].map(piece);
        let said = told([(&front, &denim), (&band, &rib), (&yoke, &poplin), (&back, &denim)].into_iter());
        let said = said.expect("denim and poplin give less");
        assert!(
            said.contains("'front' (by 9.4 %), 'back' (by 9.4 %); ") && said.contains("'yoke' (by 9.4 %)"),
            "{said}"
        );
        assert!(!said.contains("'band'") && said.matches("make it wider there").count() == 1, "{said}");
        assert_eq!(told([(&band, &rib)].into_iter()), None);
        // Pushed together as far, as gathered cloth is.
        let strain = Spread { p99: 0.094, ..Spread::default() };
        let gathered = PieceReport { drawn_out: 0.0, strain, ..front.clone() };
        assert_eq!(told([(&gathered, &denim)].into_iter()), None);
    }
}
