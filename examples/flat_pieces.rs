//! Surfaces laid flat, with pictures: the cap of a sphere, a cone, half a bodice without a dart and with darts,
//! a sleeve.
//!
//! `cargo run --release --example flat_pieces` writes each surface to `out/flat_pieces/NAME.obj` and its flat piece to
//! the folder of that name (`flat.png` is strain, `pattern.svg` and `outline.svg` the pattern),
//! and prints what it cost.

use std::error::Error;
use std::f64::consts::{FRAC_PI_3, PI};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use toile::flatten::{FlattenOptions, Mode};
use toile::input::LengthUnit;
use toile::io::files::write_all;
use toile::pipeline::{Darts, SurfaceOptions, flatten_surface};

/// Vertices along each side of a surface.
const SIDE: u32 = 60;

/// A surface over parameters from 0 to 1 each, and how it is flattened.
struct Case {
    name: &'static str,
    at: fn(f64, f64) -> [f64; 3],
    mode: Mode,
    darts: bool,
}

const CASES: [Case; 8] = [
    Case { name: "cap", at: cap, mode: Mode::Balanced, darts: false },
    Case { name: "cap_isometric", at: cap, mode: Mode::Isometric, darts: false },
    Case { name: "cone", at: cone, mode: Mode::Balanced, darts: false },
    Case { name: "bodice", at: bodice, mode: Mode::Balanced, darts: false },
    Case { name: "bodice_with_darts", at: bodice, mode: Mode::Balanced, darts: true },
    Case { name: "bodice_woven", at: bodice, mode: Mode::Woven, darts: false },
    Case { name: "sleeve", at: sleeve, mode: Mode::Balanced, darts: false },
    Case { name: "sleeve_woven", at: sleeve, mode: Mode::Woven, darts: false },
];

fn main() -> Result<(), Box<dyn Error>> {
    println!(
        "{:18} {:>8} {:>8} {:>8} {:>10} {:>8} {:>6}",
        "per cent", "rim", "area", "strain", "threads", "shear °", "cuts"
    );
    for case in &CASES {
        let folder = Path::new("out/flat_pieces");
        let file = folder.join(format!("{}.obj", case.name));
        write_all(&[(file.clone(), obj(case.at).into_bytes())], &[])?;
        let options = SurfaceOptions {
            unit: Some(LengthUnit::Metre),
            darts: case.darts.then_some(Darts::Auto),
            flatten: FlattenOptions { mode: case.mode, ..FlattenOptions::default() },
            ..SurfaceOptions::default()
        };
        let flat = flatten_surface(&file, &options)?;
        let files: Vec<(PathBuf, Vec<u8>)> =
            flat.results()?.into_iter().map(|(name, bytes)| (folder.join(case.name).join(name), bytes)).collect();
        write_all(&files, &[&file])?;
        for piece in &flat.report.pieces {
            println!(
                "{:18} {:8.4} {:8.3} {:8.3} {:5.2}{:5.2} {:8.1} {:6}",
                case.name,
                100.0 * piece.largest_rim_error,
                100.0 * piece.area_distortion,
                100.0 * piece.distortion,
                100.0 * piece.threads.warp,
                100.0 * piece.threads.weft,
                piece.threads.shear_max,
                flat.report.cuts.len()
            );
        }
    }
    Ok(())
}

/// The surface as a regular grid, in metres.
fn obj(at: fn(f64, f64) -> [f64; 3]) -> String {
    let share = |k: u32| f64::from(k) / f64::from(SIDE - 1);
    let mut text = String::new();
    for (row, column) in (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| (row, column))) {
        let [x, y, z] = at(share(column), share(row));
        let _ = writeln!(text, "v {x} {y} {z}");
    }
    for (row, column) in (1..SIDE).flat_map(|row| (1..SIDE).map(move |column| (row, column))) {
        let last = row * SIDE + column + 1;
        let [a, b, c] = [last - SIDE - 1, last - SIDE, last - 1];
        // Diagonals alternate, so that the mesh favours no direction.
        let _ = if (row + column) % 2 == 0 {
            writeln!(text, "f {a} {b} {last}\nf {a} {last} {c}")
        } else {
            writeln!(text, "f {a} {b} {c}\nf {b} {last} {c}")
        };
    }
    text
}

/// The cap of 60° of a ball of 15 cm: a square squeezed into a disk.
fn cap(u: f64, v: f64) -> [f64; 3] {
    let (x, y) = (2.0 * u - 1.0, 2.0 * v - 1.0);
    let (x, y) = (x * (1.0 - y * y / 2.0).sqrt(), y * (1.0 - x * x / 2.0).sqrt());
    let (polar, azimuth) = (x.hypot(y).min(1.0) * FRAC_PI_3, y.atan2(x));
    [polar.sin() * azimuth.cos(), polar.sin() * azimuth.sin(), polar.cos()].map(|x| 0.15 * x)
}

/// A third of a turn short of a whole cone between 10 and 50 cm from its tip: developable.
fn cone(u: f64, v: f64) -> [f64; 3] {
    let (slant, turn) = (0.1 + 0.4 * v, 4.0 * PI / 3.0 * u);
    [0.5 * slant * turn.cos(), -0.75f64.sqrt() * slant, -0.5 * slant * turn.sin()]
}

/// Half a front on a cylinder of 15 cm with a bust of 5 cm; the armhole cuts into its upper corner.
fn bodice(u: f64, v: f64) -> [f64; 3] {
    // The side runs up to the armhole and on along it to the shoulder.
    let narrowed = 1.0 - 0.3 * (3.0 * (v - 0.55)).clamp(0.0, 1.0).powi(2);
    let (x, y) = (0.25 * u * narrowed, 0.4 * v);
    let bust = 0.05 * (-((x - 0.1).powi(2) + (y - 0.22).powi(2)) / 0.005).exp();
    let (sine, cosine) = (x / 0.15).sin_cos();
    [(0.15 + bust) * sine, y, (0.15 + bust) * cosine]
}

/// A sleeve, open below the arm, whose cap is drawn in over the shoulder.
fn sleeve(u: f64, v: f64) -> [f64; 3] {
    let turn = PI * (2.0 * u - 1.0);
    let top = 0.12 + 0.13 * 0.5 * (1.0 + turn.cos());
    let y = top * v;
    let over = (y - 0.12).max(0.0) / 0.13;
    let radius = (0.05 + 0.02 * v) * (1.0 - 0.45 * over * over);
    [radius * (0.97 * turn).sin(), y, radius * (0.97 * turn).cos() - 0.03 * over * over]
}
