//! Fig. 7: 2,601 vertices over a ball, drawn along the diagonal, and in wrinkles.

use std::error::Error;
use std::f64::consts::{PI, TAU};

use toile::drape::geometric::{Control, Weights};
use toile::geometry::{TriMesh, Vec3};

use super::figure::{Bar, Figure, Picture, row};
use super::measure::{Ring, apart, strain};
use super::{Diagonals, Experiment, HEIGHT, MEMBRANE, Solved, WIDTH, fifteen, grid_lines, sheet, weights};

/// Vertices along each side.
const SIDE: u32 = 51;
const MIDDLE: [f64; 2] = [0.5 * WIDTH, 0.5 * HEIGHT];
/// Radius of the ball, metres. It lies on a table, and the cloth touches it up to this angle from its top, radians.
const BALL: f64 = 0.08;
const COVERED: f64 = 75.0 / 180.0 * PI;
/// The folds round the ball are measured this far from the middle of the cloth, metres.
const RING: f64 = 0.16;
/// How far two opposite corners are drawn apart, and how far up, metres.
const DRAWN: f64 = 0.03;
const RAISED: f64 = 0.06;
/// How much nearer the sides are brought, and the height of the arch from which wrinkles start, metres.
const NEARER: f64 = 0.04;
const ARCH: f64 = 0.012;
/// How far the start is shaken to see that the shape does not depend on it, metres.
const SHAKEN: f64 = 1e-3;

/// The cloth laid on a ball that lies on a table: the part that touches it are controls, and the corners are fixed on
/// the table, as far out as the cloth between reaches. The ball's top is in the plane z = 0.
pub(crate) fn ball() -> Experiment {
    let mesh = sheet(WIDTH, HEIGHT, SIDE, SIDE, Diagonals::OneWay);
    let laid = |(v, p): (u32, &Vec3)| {
        let out = p.xy() - nalgebra::Vector2::from(MIDDLE);
        let angle = out.norm() / BALL;
        let across = if out.norm() > 0.0 { out.normalize() * (BALL * angle.sin()) } else { out };
        let target = Vec3::new(MIDDLE[0] + across.x, MIDDLE[1] + across.y, BALL * (angle.cos() - 1.0));
        (angle <= COVERED).then(|| Control::vertex(v, target))
    };
    let controls = (0u32..).zip(&mesh.vertices).filter_map(laid).collect();
    let mut start = mesh.vertices.clone();
    let held = vec![0, SIDE - 1, SIDE * (SIDE - 1), SIDE * SIDE - 1];
    for &corner in &held {
        start[corner as usize] = on_the_table(&mesh.vertices[corner as usize]);
    }
    Experiment { name: "ball", curved: false, held, controls, start, mesh }
}

/// Where a corner reaches the table: over the ball to the edge of the part that touches it, and straight on.
fn on_the_table(corner: &Vec3) -> Vec3 {
    let out = corner.xy() - nalgebra::Vector2::from(MIDDLE);
    let (sin, cos) = COVERED.sin_cos();
    let (length, down) = (out.norm() - BALL * COVERED, BALL * (1.0 + cos));
    let reach = BALL * sin + (length * length - down * down).sqrt();
    let at = nalgebra::Vector2::from(MIDDLE) + out.normalize() * reach;
    Vec3::new(at.x, at.y, -2.0 * BALL)
}

/// Two opposite corners drawn apart and up, the other two fixed.
pub(crate) fn pull() -> Experiment {
    let mesh = sheet(WIDTH, HEIGHT, SIDE, SIDE, Diagonals::OneWay);
    let along = Vec3::new(WIDTH, HEIGHT, 0.0).normalize() * (0.5 * DRAWN);
    let drawn = |v: u32, by: Vec3| Control::vertex(v, mesh.vertices[v as usize] + by + Vec3::z() * RAISED);
    let controls = vec![drawn(0, -along), drawn(SIDE * SIDE - 1, along)];
    let held = vec![SIDE - 1, SIDE * (SIDE - 1)];
    Experiment { name: "diagonal", curved: false, held, controls, start: mesh.vertices.clone(), mesh }
}

/// Two sides fixed nearer to each other, the rest in a low arch between them.
pub(crate) fn wrinkles() -> Experiment {
    let mesh = sheet(WIDTH, HEIGHT, SIDE, SIDE, Diagonals::OneWay);
    let arch = |v: &Vec3| {
        let share = v.y / HEIGHT;
        Vec3::new(v.x, 0.5 * NEARER + (HEIGHT - NEARER) * share, ARCH * (PI * share).sin())
    };
    let start = mesh.vertices.iter().map(arch).collect();
    let held = (0..SIDE).chain(SIDE * (SIDE - 1)..SIDE * SIDE).collect();
    Experiment { name: "wrinkles", curved: false, held, controls: vec![], start, mesh }
}

/// The ball in all fifteen fabrics.
pub(crate) fn balls() -> Result<Figure, Box<dyn Error>> {
    let ball = ball();
    let ring = Ring::new(&ball.mesh, MIDDLE, RING);
    let mut out = Figure::with_head(&["fabric", "iterations", "depth of folds mm", "folds", "miss mm"]);
    let solved = solve_all(&ball, 15.0, &mut out, |shape| {
        let (depth, folds) = (1e3 * ring.depth(&shape.x), ring.folds(&shape.x));
        vec![(depth, 1), (folds as f64, 0), (1e3 * ball.miss(&shape.x), 2)]
    })?;
    let find = |name: &str| solved.iter().find(|s| s.0 == name).map(|s| &s.1).ok_or(format!("no {name}"));
    let depth = |name: &str| find(name).map(|shape| 1e3 * ring.depth(&shape.x));
    for (deeper, name, least) in
        [("denim", "wool_suiting", 8.0), ("wool_suiting", "canvas", 15.0), ("canvas", "silk_charmeuse", 8.0)]
    {
        let difference = depth(deeper)? - depth(name)?;
        out.bars.push(Bar::at_least(least, format!("{deeper} folds deeper than {name} by, mm"), difference));
    }
    for name in ["denim", "ramie", "cotton_poplin", "wool_suiting", "linen"] {
        let off = ring.folds(&find(name)?.x).abs_diff(4);
        out.bars.push(Bar::at_most(0.0, format!("{name}: folds more or fewer than four"), off as f64));
    }
    let shaken = 1e3 * shaken_apart(weights("wool_suiting")?, SHAKEN)?;
    out.bars.push(Bar::at_most(0.1, "wool from a start shaken by 1 mm, largest distance, mm", shaken));
    out.pictures.push(Picture {
        file: "fig7_ball",
        title: "Fig. 7, ball",
        subtitle: "2,601 vertices over a ball of 80 mm radius, corners fixed on the table",
        shapes: shapes(&ball, &solved),
        lines: grid_lines(SIDE, SIDE, 5),
        body: sphere(),
    });
    Ok(out)
}

/// The diagonal pull in all fifteen fabrics.
pub(crate) fn pulls() -> Result<Figure, Box<dyn Error>> {
    let pull = pull();
    let mut out = Figure::with_head(&["fabric", "iterations", "longest edge %", "miss mm"]);
    let solved = solve_all(&pull, 5.0, &mut out, |shape| {
        vec![(100.0 * strain(&pull.mesh, &shape.x).longest, 1), (1e3 * pull.miss(&shape.x), 2)]
    })?;
    out.pictures.push(Picture {
        file: "fig7_diagonal",
        title: "Fig. 7, diagonal",
        subtitle: "two opposite corners drawn apart by 30 mm and up by 60 mm, the other two fixed",
        shapes: shapes(&pull, &solved),
        lines: grid_lines(SIDE, SIDE, 5),
        ..Picture::default()
    });
    Ok(out)
}

/// Wrinkles in all fifteen fabrics.
pub(crate) fn wrinkled() -> Result<Figure, Box<dyn Error>> {
    let wrinkles = wrinkles();
    let mut out = Figure::with_head(&["fabric", "iterations", "depth mm"]);
    let solved = solve_all(&wrinkles, 15.0, &mut out, |shape| vec![(1e3 * depth(shape), 1)])?;
    for (name, shape) in &solved {
        let (what, depth) = (format!("{name}: depth, mm"), 1e3 * depth(shape));
        out.bars.push(match name.as_str() {
            "silk_charmeuse" | "nylon_spandex_knit" => Bar::at_most(1.0, what, depth),
            "nylon_taffeta" => Bar::at_most(35.0, what, depth),
            _ => Bar::at_least(65.0, what, depth),
        });
    }
    out.pictures.push(Picture {
        file: "fig7_wrinkles",
        title: "Fig. 7, wrinkles",
        subtitle: "two sides fixed, 40 mm nearer to each other than in the flat sheet",
        shapes: shapes(&wrinkles, &solved),
        lines: grid_lines(SIDE, SIDE, 5),
        ..Picture::default()
    });
    Ok(out)
}

/// Solves an experiment in all fabrics. Adds a row of `numbers` and a bar of `most` iterations for each; the membrane
/// has no bar.
fn solve_all(
    experiment: &Experiment,
    most: f64,
    out: &mut Figure,
    numbers: impl Fn(&Solved) -> Vec<(f64, usize)>,
) -> Result<Vec<(String, Solved)>, Box<dyn Error>> {
    let mut solved = Vec::new();
    for (name, weights) in fifteen()? {
        let shape = experiment.solve(weights)?;
        let iterations = shape.settled as f64;
        out.table.push(row(&name, &[vec![(iterations, 0)], numbers(&shape)].concat()));
        if name != MEMBRANE {
            out.bars.push(Bar::at_most(most, format!("{name}: iterations"), iterations));
        }
        solved.push((name, shape));
    }
    Ok(solved)
}

fn shapes(experiment: &Experiment, solved: &[(String, Solved)]) -> Vec<(String, TriMesh)> {
    solved.iter().map(|(name, s)| (name.clone(), experiment.shape(s))).collect()
}

/// The highest point over the lowest, metres.
fn depth(shape: &Solved) -> f64 {
    let heights = || shape.x.iter().map(|v| v.z);
    heights().fold(f64::NEG_INFINITY, f64::max) - heights().fold(f64::INFINITY, f64::min)
}

/// The largest distance between the shapes of one fabric on the ball from two starts: as it is, and shaken by up to
/// `by` metres.
fn shaken_apart(weights: Weights, by: f64) -> Result<f64, Box<dyn Error>> {
    let (ball, mut shaken) = (ball(), ball());
    let number = |k: usize| (43_758.5 * (78.233 * k as f64).sin()).fract();
    for (k, v) in shaken.start.iter_mut().enumerate().filter(|(k, _)| !ball.held.contains(&(*k as u32))) {
        *v += Vec3::new(number(3 * k), number(3 * k + 1), number(3 * k + 2)) * by;
    }
    Ok(apart(&ball.solve(weights)?, &shaken.solve(weights)?)[1])
}

/// The ball, a little smaller than the cloth lies on it, so that the cloth hides it.
fn sphere() -> TriMesh {
    const AROUND: u32 = 64;
    const DOWN: u32 = 32;
    let radius = BALL - 1e-3;
    let at = |k: u32| {
        let (turn, tilt) =
            (TAU * f64::from(k % AROUND) / f64::from(AROUND), PI * f64::from(k / AROUND) / f64::from(DOWN));
        let across = Vec3::new(turn.cos(), turn.sin(), 0.0) * tilt.sin();
        Vec3::new(MIDDLE[0], MIDDLE[1], -BALL) + (across + Vec3::z() * tilt.cos()) * radius
    };
    let vertices = (0..AROUND * (DOWN + 1)).map(at).collect();
    let cell = |k: u32| {
        let [a, b] = [k, k / AROUND * AROUND + (k + 1) % AROUND];
        [[a, a + AROUND, b + AROUND], [a, b + AROUND, b]]
    };
    TriMesh { vertices, triangles: (0..AROUND * DOWN).flat_map(cell).collect() }
}
