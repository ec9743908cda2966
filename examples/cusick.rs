//! The drape test (Cusick 1968) of the fifteen fabrics of Liu, Wang & Luo 2015: coefficient and folds of a disc of 30 cm
//! in two grids, beside the band measured of such cloths, and what the published weights alone would give.
//!
//! `cargo run --release --example cusick [FOLDER]` prints the table and draws `FABRIC.png`, the shadows.

use std::error::Error;
use std::path::PathBuf;
use std::sync::Arc;

use rayon::prelude::*;
use toile::fabric::{Fabric, library, load, sheet};
use toile::io::files::write_all;
use toile::picture::draw_shadow;
use toile::specimen::{Draped, Sample, SpecimenError, drape};

/// Grid spacings, metres.
const SPACINGS: [f64; 2] = [0.01, 0.005];
const GRAVITY: f64 = toile::dynamics::GRAVITY;

fn coefficient(fabric: Fabric, spacing: f64) -> Result<Draped, SpecimenError> {
    drape(&Sample { fabric: Arc::new(fabric), drape: None, published: None }, spacing)
}

fn row(name: &str) -> Result<(String, Draped), Box<dyn Error + Send + Sync>> {
    let (fabric, sheet) = (load(name)?, sheet(name)?);
    let length = fabric.bending_length_mean();
    let coarse = coefficient(fabric.clone(), SPACINGS[0])?;
    let fine = coefficient(fabric.clone(), SPACINGS[1])?;
    let by_weights = match &sheet.liu {
        Some(liu) => {
            let rigidity = liu.bending_length().powi(3) * fabric.areal_density * GRAVITY;
            let fabric = Fabric { bend_warp: rigidity, bend_weft: rigidity, ..fabric };
            format!(
                "{:6.1} mm {:5.1} %",
                1e3 * liu.bending_length(),
                100.0 * coefficient(fabric, SPACINGS[0])?.coefficient
            )
        }
        None => String::new(),
    };
    let percent = 100.0 * fine.coefficient;
    let band = sheet.drape_band().map_or_else(String::new, |[low, high]| {
        let place = if percent < low {
            "below"
        } else if percent > high {
            "above"
        } else {
            "within"
        };
        format!("{low:.0}-{high:.0} {place}")
    });
    let text = format!(
        "{name:20} {:6.1} {:9.1} {:8.1} {:6} {:14} {by_weights}",
        1e3 * length,
        100.0 * coarse.coefficient,
        percent,
        fine.folds,
        band
    );
    Ok((text, fine))
}

fn main() -> Result<(), Box<dyn Error + Send + Sync>> {
    let folder = std::env::args().nth(1).map(PathBuf::from);
    println!("fabric               c, mm   in 10 mm in 5 mm  folds  band           by the published weights, in 10 mm");
    let names: Vec<&str> = library().into_iter().take(15).collect();
    let rows: Vec<_> = names.par_iter().map(|name| row(name)).collect();
    for (name, found) in names.iter().zip(rows) {
        match found {
            Ok((text, draped)) => {
                println!("{text}");
                if let Some(folder) = &folder {
                    let words = format!("{:.0} %, {} folds", 100.0 * draped.coefficient, draped.folds);
                    let picture = draw_shadow(&draped.shadow.dark, draped.shadow.width, name, &words)?;
                    write_all(&[(folder.join(format!("{name}.png")), picture)], &[])?;
                }
            }
            Err(e) => println!("{name:20} {e}"),
        }
    }
    Ok(())
}
