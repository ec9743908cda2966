//! Garments that can be put on and are too tight: their cloth is drawn out further than it gives.

use super::job::Job;
use crate::fabric::Fabric;
use crate::report::{PieceReport, Report};

/// In words, every piece that is too tight.
pub fn tight(job: &Job, report: &Report) -> Vec<String> {
    report.pieces.iter().zip(&job.fabrics).filter_map(|(piece, fabric)| too_tight(piece, fabric)).collect()
}

/// That a hundredth of a piece's threads and more are drawn out further than `fabric` is under a tester's full load,
/// 500 gf/cm. Cloth is not worn so, though it may not tear.
fn too_tight(piece: &PieceReport, fabric: &Fabric) -> Option<String> {
    let gives = fabric.emt();
    let [warp, weft] = gives.map(|strain| 100.0 * strain);
    (piece.strain.p99 > gives[0].max(gives[1])).then(|| {
        format!(
            "'{}' is tight: it is drawn out by {:.1} % where it is drawn out most (99 % of it less), and {} gives \
             {warp:.1} % along its warp and {weft:.1} % along its weft under 500 gf/cm; --color strain shows where; \
             make it wider there, or take a cloth that gives more",
            piece.name,
            100.0 * piece.strain.p99,
            fabric.name
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::Spread;

    #[test]
    fn a_piece_is_tight_in_one_cloth_and_not_in_another() {
        let strain = Spread { p99: 0.094, ..Spread::default() };
        let piece = PieceReport { name: "front".into(), strain, ..PieceReport::default() };
        let said = |name: &str| too_tight(&piece, &crate::fabric::load(name).expect("shipped"));
        let denim = said("denim").expect("denim gives less");
        assert!(denim.contains("'front' is tight") && denim.contains("9.4 %"), "{denim}");
        assert_eq!(said("rib"), None);
    }
}
