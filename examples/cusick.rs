//! The drape test (Cusick 1968) of the fifteen fabrics of Liu, Wang & Luo 2015: mean coefficient and folds of six lays
//! of a disc of 30 cm in two grids, beside the band measured of such cloths, and what one lay would have by the
//! published weights alone.
//!
//! `cargo run --release --example cusick [FOLDER]` prints the table, with the disc's own curve of coefficient over
//! bending length below (one lay for each length), and draws `FABRIC.png`, the shadow of the lay nearest to the mean,
//! and `curve.svg`, that curve through the bands. It takes some 40 minutes of one processor: the finer grid has
//! 11,000 particles.

use std::error::Error;
use std::path::PathBuf;
use std::sync::Arc;

use rayon::prelude::*;
use svg::Document;
use svg::node::element::path::Data;
use svg::node::element::{Circle, Line, Path, Text};
use toile::fabric::{Fabric, GRAVITY, library, load, sheet};
use toile::io::files::write_all;
use toile::picture::draw_shadow;
use toile::specimen::{DrapedDisc, LAYS, Sample, Series, SpecimenError, drape};

/// Grid spacings, metres.
const SPACINGS: [f64; 2] = [0.005, 0.0025];
/// Bending lengths of the curve, metres: the first, the last, their step.
const LENGTHS: [f64; 3] = [0.008, 0.034, 0.002];
/// Size of the drawing of the curve, mm, and mm for a millimetre of bending length and a per cent.
const SHEET: [f64; 2] = [200.0, 140.0];
const SCALE: [f64; 2] = [5.0, 1.2];
const ORIGIN: [f64; 2] = [20.0, 130.0];

fn sample(fabric: Fabric) -> Sample {
    Sample { fabric: Arc::new(fabric), drape: None, published: None }
}

/// Coefficient of one lay in the coarser grid.
fn coefficient(fabric: Fabric) -> Result<f64, SpecimenError> {
    Ok(drape(&sample(fabric), SPACINGS[0], &LAYS[0])?.coefficient)
}

/// A fabric's place in the table and in the drawing.
struct Row {
    name: &'static str,
    text: String,
    length: f64,
    series: Series,
    band: Option<[f64; 2]>,
}

/// Mean and standard deviation, per cent, and folds in brackets.
fn shown(series: &Series) -> String {
    format!("{:5.1} ± {:.1} ({})", 100.0 * series.mean(), 100.0 * series.deviation(), series.folds())
}

fn row(name: &'static str) -> Result<Row, Box<dyn Error + Send + Sync>> {
    let (fabric, sheet) = (load(name)?, sheet(name)?);
    let length = fabric.bending_length_mean();
    let [coarse, fine] = SPACINGS.map(|spacing| Series::drape(&sample(fabric.clone()), spacing));
    let (coarse, fine) = (coarse?, fine?);
    let by_weights = match &sheet.liu {
        Some(liu) => {
            let rigidity = liu.fallback_bending_length().powi(3) * fabric.areal_density * GRAVITY;
            let fabric = Fabric { bend_warp: rigidity, bend_weft: rigidity, ..fabric };
            format!("{:6.1} mm {:5.1} %", 1e3 * liu.fallback_bending_length(), 100.0 * coefficient(fabric)?)
        }
        None => String::new(),
    };
    let percent = 100.0 * fine.mean();
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
        "{name:20} {:6.1} {:30} {:30} {:+5.1} {:14} {by_weights}",
        1e3 * length,
        shown(&coarse),
        shown(&fine),
        100.0 * (fine.mean() - coarse.mean()),
        band
    );
    Ok(Row { name, text, length, series: fine, band: sheet.drape_band() })
}

/// Coefficients of a cloth of poplin's weight by its bending length: \[metres, share\].
fn curve() -> Result<Vec<[f64; 2]>, Box<dyn Error + Send + Sync>> {
    let [first, last, step] = LENGTHS;
    let poplin = load("cotton_poplin")?;
    let count = ((last - first) / step).round() as usize;
    let point = |k: usize| {
        let length = first + step * k as f64;
        let rigidity = length.powi(3) * poplin.areal_density * GRAVITY;
        let fabric = Fabric { bend_warp: rigidity, bend_weft: rigidity, ..poplin.clone() };
        Ok([length, coefficient(fabric)?])
    };
    (0..=count).into_par_iter().map(point).collect()
}

/// The curve, the bands as bars and what was found as dots.
fn drawing(curve: &[[f64; 2]], rows: &[Row]) -> String {
    let at = |length: f64, share: f64| (ORIGIN[0] + 1e3 * length * SCALE[0], ORIGIN[1] - 100.0 * share * SCALE[1]);
    let mut data = Data::new();
    for (k, &[length, share]) in curve.iter().enumerate() {
        data = if k == 0 { data.move_to(at(length, share)) } else { data.line_to(at(length, share)) };
    }
    let line = |(x1, y1): (f64, f64), (x2, y2): (f64, f64), color: &str, width: f64| {
        let line = Line::new().set("x1", x1).set("y1", y1).set("x2", x2).set("y2", y2);
        line.set("stroke", color).set("stroke-width", width)
    };
    let words =
        |text: String, (x, y): (f64, f64), size: f64| Text::new(text).set("x", x).set("y", y).set("font-size", size);
    let mut sheet = Document::new()
        .set("width", format!("{}mm", SHEET[0]))
        .set("height", format!("{}mm", SHEET[1]))
        .set("viewBox", (0.0, 0.0, SHEET[0], SHEET[1]))
        .set("font-family", "sans-serif")
        .add(line(at(0.0, 0.0), at(LENGTHS[1], 0.0), "black", 0.3))
        .add(line(at(0.0, 0.0), at(0.0, 1.0), "black", 0.3))
        .add(words("drape coefficient, %, over bending length, mm".to_owned(), (ORIGIN[0], 6.0), 4.0));
    for tick in (0..=100).step_by(20) {
        let (_, y) = at(0.0, f64::from(tick) / 100.0);
        sheet = sheet.add(words(tick.to_string(), (ORIGIN[0] - 10.0, y + 1.0), 3.5));
    }
    for tick in (5..=30).step_by(5) {
        let (x, _) = at(f64::from(tick) * 1e-3, 0.0);
        sheet = sheet.add(words(tick.to_string(), (x - 2.0, ORIGIN[1] + 5.0), 3.5));
    }
    let mut sorted: Vec<&Row> = rows.iter().collect();
    sorted.sort_by(|a, b| a.length.total_cmp(&b.length));
    for (k, row) in sorted.iter().enumerate() {
        let Some([low, high]) = row.band else { continue };
        sheet = sheet.add(line(at(row.length, 0.01 * low), at(row.length, 0.01 * high), "#bcd0e6", 1.6));
        // Names under their bars where these end high enough, of neighbours by turns.
        let under = low >= 35.0 && (k % 2 == 0 || low <= 50.0);
        let (share, anchor) = if under { (low - 1.0, "end") } else { (high + 1.0, "start") };
        let (x, y) = at(row.length, 0.01 * share);
        let name = words(row.name.replace('_', " "), (x + 0.8, y), 2.5).set("text-anchor", anchor);
        sheet = sheet.add(name.set("transform", format!("rotate(-90 {} {y})", x + 0.8)));
    }
    for row in rows {
        let (x, y) = at(row.length, row.series.mean());
        sheet = sheet.add(Circle::new().set("cx", x).set("cy", y).set("r", 0.9));
    }
    sheet
        .add(Path::new().set("d", data).set("fill", "none").set("stroke", "#b03030").set("stroke-width", 0.5))
        .to_string()
}

fn main() -> Result<(), Box<dyn Error + Send + Sync>> {
    let folder = std::env::args().nth(1).map(PathBuf::from);
    println!(
        "{:20} {:>6} {:30} {:30} {:5} {:14} by the published weights, in 5 mm",
        "fabric", "c, mm", "in 5 mm: % (folds)", "in 2.5 mm", "apart", "band"
    );
    let names: Vec<&str> = library().into_iter().take(15).collect();
    let mut rows = Vec::new();
    for (name, found) in names.iter().zip(names.par_iter().map(|name| row(name)).collect::<Vec<_>>()) {
        match found {
            Ok(row) => {
                println!("{}", row.text);
                rows.push(row);
            }
            Err(e) => println!("{name:20} {e}"),
        }
    }
    let curve = curve()?;
    println!("\nthe disc's own curve in 5 mm, cloth of poplin's weight");
    for [length, share] in &curve {
        println!("c = {:4.0} mm {:6.1} %", 1e3 * length, 100.0 * share);
    }
    let Some(folder) = folder else { return Ok(()) };
    let mut files = vec![(folder.join("curve.svg"), drawing(&curve, &rows).into_bytes())];
    for Row { name, series, .. } in &rows {
        let Some(DrapedDisc { shadow, coefficient, folds, .. }) = series.typical() else { continue };
        let words = format!(
            "one lay: {:.0} %, {folds} folds; mean of {}: {:.0} %",
            100.0 * coefficient,
            LAYS.len(),
            100.0 * series.mean()
        );
        let picture = draw_shadow(&shadow.dark, shadow.width, name, &words)?;
        files.push((folder.join(format!("{name}.png")), picture));
    }
    write_all(&files, &[])?;
    Ok(())
}
