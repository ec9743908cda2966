//! Fig. 4: the three terms of the energy, added one after the other.

use std::error::Error;

use toile::drape::geometric::Weights;

use super::figure::{Bar, Figure, Picture, row};
use super::measure::{fold_rms, strain};
use super::{MEMBRANE, fifteen, fig5, grid_lines, weights};

pub(crate) fn figure() -> Result<Figure, Box<dyn Error>> {
    let sheet = fig5::diagonal("Fig. 4", 31, 31);
    let all = weights("cotton_poplin")?;
    let steps = [
        ("a: E_P", Weights { stretch: 0.0, bend: 0.0, ..all }),
        ("b: E_P + E_L", Weights { bend: 0.0, ..all }),
        ("c: E_P + E_L + E_A", all),
    ];
    let mut out =
        Figure::with_head(&["terms", "iterations", "longest edge %", "fold RMS °", "E_P m²", "E_L m²", "E_A m²"]);
    let (mut shapes, mut longest, mut folds) = (vec![], vec![], vec![]);
    for (name, weights) in steps {
        let solved = sheet.solve(weights)?;
        let energy = solved.report.energy;
        longest.push(100.0 * strain(&sheet.mesh, &solved.x).longest);
        folds.push(fold_rms(&sheet.mesh, &solved.x).to_degrees());
        let numbers = [(solved.settled as f64, 0), (longest[shapes.len()], 1), (folds[shapes.len()], 2)];
        let energies = [energy.recovery, energy.stretch, energy.bend].map(|e| format!("{e:.2e}"));
        out.table.push([row(name, &numbers), energies.to_vec()].concat());
        shapes.push((name.to_owned(), sheet.shape(&solved)));
    }
    for (name, weights) in fifteen()?.into_iter().filter(|(name, _)| name != MEMBRANE) {
        let iterations = sheet.solve(weights)?.settled as f64;
        out.bars.push(Bar::at_most(7.0, format!("{name}, all terms: iterations"), iterations));
    }
    out.bars.extend([
        Bar::at_least(300.0, "a: longest edge, %", longest[0]),
        Bar::at_most(20.0, "b: longest edge, %", longest[1]),
        Bar::at_most(20.0, "c: longest edge, %", longest[2]),
        Bar::at_most(0.5, "folds of c over those of b", folds[2] / folds[1]),
    ]);
    out.pictures.push(Picture {
        file: "fig4",
        title: "Fig. 4",
        subtitle: "961 vertices, poplin: the terms of the energy added one after the other",
        shapes,
        lines: grid_lines(31, 31, 3),
        ..Picture::default()
    });
    Ok(out)
}
