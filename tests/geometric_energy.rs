//! The published energy of Liu, Wang & Luo 2015 (L7–L11): its terms, its gradients, and the two solvers.

#[path = "../examples/common/mod.rs"]
mod common;

use common::fig5::diagonal;
use common::{Diagonals, HEIGHT, WIDTH, fig7, fig9, weights};
use toile::drape::geometric::{
    Alternating, Control, GeometricCloth, GeometricError, LeastSquares, PUBLISHED_CELL, Recovery, SolveOptions,
    Weighting, Weights,
};
use toile::geometry::{TriMesh, Vec3};

const EXACT: SolveOptions = SolveOptions { max_iterations: 20_000, tolerance: 1e-10 };

fn poplin() -> Weights {
    weights("cotton_poplin").expect("shipped")
}

fn sheet(width: f64, height: f64, columns: u32, rows: u32) -> TriMesh {
    common::sheet(width, height, columns, rows, Diagonals::OneWay)
}

/// Numbers in −1 … 1, the same every time.
fn noise(count: usize) -> Vec<f64> {
    let mut state = 12345u64;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) as f64 / f64::from(1u32 << 30) - 1.0
    };
    (0..count).map(|_| next()).collect()
}

fn shaken(x: &[Vec3], by: f64) -> Vec<Vec3> {
    let noise = noise(3 * x.len());
    x.iter().zip(noise.chunks_exact(3)).map(|(v, d)| v + Vec3::from_column_slice(d) * by).collect()
}

fn largest(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}

#[test]
fn the_published_cell_is_that_of_the_specimen() {
    assert!((PUBLISHED_CELL - (WIDTH * HEIGHT / 2000.0).sqrt()).abs() < 1e-15);
}

#[test]
fn gradients_are_those_of_the_energy() {
    let flat = sheet(0.08, 0.07, 9, 8);
    let rolled = rolled(&flat, 0.05);
    let controls = vec![
        Control::vertex(20, Vec3::new(0.01, 0.02, 0.05)),
        Control::in_triangle(flat.triangles[31], [0.2, 0.3, 0.5], Vec3::new(0.05, 0.01, -0.03)),
    ];
    let recoveries = [
        Recovery::Controls(controls),
        Recovery::AllVertices(flat.vertices.clone()),
        Recovery::Falling(Vec3::new(0.0, -2e-3, 1e-3)),
    ];
    for weights in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.5, 0.3, 0.2]] {
        let [recovery, stretch, bend] = weights;
        let weights = Weights { recovery, stretch, bend };
        for weighting in [Weighting::Plain, Weighting::PerArea] {
            let cloths =
                [GeometricCloth::new(&flat, weights, weighting), GeometricCloth::curved(&rolled, weights, weighting)];
            for (cloth, recovery) in cloths.iter().flat_map(|c| recoveries.iter().map(move |r| (c, r))) {
                let cloth = cloth.as_ref().expect("cloth");
                let error = gradient_error(cloth, recovery, &shaken(&flat.vertices, 3e-3));
                assert!(error < 1e-6, "{weights:?} {weighting:?} {recovery:?}: {error:.1e}");
            }
        }
    }
}

/// The largest difference between the gradient and differences of the energy, as a share of the largest gradient.
fn gradient_error(cloth: &GeometricCloth, recovery: &Recovery, x: &[Vec3]) -> f64 {
    let gradient = cloth.gradient(x, recovery);
    let scale = gradient.iter().map(Vec3::norm).fold(0.0, f64::max);
    let h = 1e-6;
    let slope = |k: usize| {
        let at = |d: f64| {
            let mut moved = x.to_vec();
            moved[k / 3][k % 3] += d;
            cloth.energy(&moved, recovery).total
        };
        (at(h) - at(-h)) / (2.0 * h)
    };
    (0..3 * x.len()).map(|k| (slope(k) - gradient[k / 3][k % 3]).abs() / scale).fold(0.0, f64::max)
}

/// A sheet rolled about an axis along y.
fn rolled(flat: &TriMesh, radius: f64) -> TriMesh {
    let roll = |v: &Vec3| Vec3::new(radius * (v.x / radius).sin(), v.y, radius * (1.0 - (v.x / radius).cos()));
    TriMesh { vertices: flat.vertices.iter().map(roll).collect(), triangles: flat.triangles.clone() }
}

#[test]
fn recovery_counts_the_controls_only() {
    let mesh = sheet(WIDTH, HEIGHT, 12, 10);
    let alone = Weights { recovery: 1.0, stretch: 0.0, bend: 0.0 };
    let cloth = GeometricCloth::new(&mesh, alone, Weighting::PerArea).expect("cloth");
    let corners = mesh.triangles[60];
    let [a, b, c] = corners.map(|v| mesh.vertices[v as usize]);
    // One control stands where it is drawn to, the other 3 mm off, inside a triangle.
    let point = a * 0.5 + b * 0.3 + c * 0.2;
    let controls = vec![
        Control::vertex(40, mesh.vertices[40]),
        Control::in_triangle(corners, [0.5, 0.3, 0.2], point + Vec3::z() * 3e-3),
    ];
    let recovery = Recovery::Controls(controls);
    // The specimen has the area of 2,000 published cells, however many vertices it is made of.
    assert!((cloth.energy(&mesh.vertices, &recovery).recovery / (2000.0 * 9e-6) - 1.0).abs() < 1e-9);
    let gradient = cloth.gradient(&mesh.vertices, &recovery);
    for (v, g) in (0u32..).zip(&gradient) {
        let share = corners.iter().position(|&n| n == v).map_or(0.0, |k| [0.5, 0.3, 0.2][k]);
        assert!((g - Vec3::z() * (-2.0 * 2000.0 * 3e-3 * share)).norm() < 1e-9, "vertex {v}: {g:?}");
    }
}

#[test]
fn each_term_measures_what_it_should() {
    let mesh = sheet(WIDTH, HEIGHT, 12, 10);
    let recovery = Recovery::AllVertices(mesh.vertices.clone());
    let cloth = GeometricCloth::new(&mesh, poplin(), Weighting::Plain).expect("cloth");
    // Moved by 3 mm: one squared distance per vertex. Turned: no stretch, no bend.
    let moved: Vec<Vec3> = mesh.vertices.iter().map(|v| v + Vec3::new(0.0, 3e-3, 0.0)).collect();
    assert!((cloth.energy(&moved, &recovery).recovery - 120.0 * 9e-6).abs() < 1e-15);
    let turn = nalgebra::Rotation3::from_euler_angles(0.4, 1.1, -2.0);
    let turned: Vec<Vec3> = mesh.vertices.iter().map(|v| turn * v + Vec3::new(5.0, -3.0, 2.0)).collect();
    let energy = cloth.energy(&turned, &recovery);
    assert!(energy.bend < 1e-26 && energy.stretch < 1e-26, "{energy:?}");
    // All edges 1 % longer.
    let larger: Vec<Vec3> = mesh.vertices.iter().map(|v| v * 1.01).collect();
    let squares: f64 = {
        let (dx, dy) = (WIDTH / 11.0, HEIGHT / 9.0);
        110.0 * dx * dx + 108.0 * dy * dy + 99.0 * (dx * dx + dy * dy)
    };
    assert!((cloth.energy(&larger, &recovery).stretch / (1e-4 * squares) - 1.0).abs() < 1e-9);
    assert_eq!(cloth.edges(), 110 + 108 + 99);
}

#[test]
fn a_cloth_is_flat_at_rest_or_curved_as_its_initial_mesh() {
    let flat = sheet(0.2, 0.1, 9, 5);
    let nothing = Recovery::Controls(vec![]);
    // The same sheet handed in as a roof: its rest shape is the flat sheet.
    let roof = |v: &Vec3| if v.x > 0.1 { Vec3::new(0.1, v.y, v.x - 0.1) } else { *v };
    let mesh = TriMesh { vertices: flat.vertices.iter().map(roof).collect(), triangles: flat.triangles.clone() };
    let cloth = GeometricCloth::new(&mesh, poplin(), Weighting::PerArea).expect("cloth");
    assert!(cloth.energy(&flat.vertices, &nothing).total < 1e-25);
    assert!(cloth.energy(&mesh.vertices, &nothing).bend > 1e-5);
    // A cone that is curved at rest: no energy and no force there, however it is turned; but as a flat cloth.
    let cone = fig9::skirt().mesh;
    let turn = nalgebra::Rotation3::from_euler_angles(0.4, 1.1, -2.0);
    let turned: Vec<Vec3> = cone.vertices.iter().map(|v| turn * v + Vec3::new(0.3, -0.2, 0.1)).collect();
    let [curved, flat] = [GeometricCloth::curved, GeometricCloth::new]
        .map(|made| made(&cone, poplin(), Weighting::PerArea).expect("cloth"));
    let force = |cloth: &GeometricCloth| cloth.gradient(&turned, &nothing).iter().map(Vec3::norm).fold(0.0, f64::max);
    assert!(curved.energy(&turned, &nothing).total < 1e-20, "{:?}", curved.energy(&turned, &nothing));
    assert!(force(&curved) < 1e-9 * force(&flat), "{} of {}", force(&curved), force(&flat));
}

#[test]
fn both_weightings_agree_on_the_specimen() {
    // 2,000 square cells of the specimen's area, stretched, rolled up and moved.
    let (columns, rows) = (47, 43);
    let mesh = sheet(46.0 * PUBLISHED_CELL, 42.0 * PUBLISHED_CELL, columns, rows);
    let recovery = Recovery::AllVertices(mesh.vertices.clone());
    let radius = 0.3;
    let x: Vec<Vec3> = mesh
        .vertices
        .iter()
        .map(|v| Vec3::new(radius * (v.x / radius).sin(), 1.02 * v.y + 0.01, radius * (1.0 - (v.x / radius).cos())))
        .collect();
    let [plain, per_area] = [Weighting::Plain, Weighting::PerArea]
        .map(|w| GeometricCloth::new(&mesh, poplin(), w).expect("cloth").energy(&x, &recovery));
    println!("plain {plain:?}\nper area {per_area:?}");
    // Rims have whole vertices and edges but half cells, and there the sheet has moved furthest.
    for (a, b) in [(plain.recovery, per_area.recovery), (plain.stretch, per_area.stretch), (plain.bend, per_area.bend)]
    {
        assert!((a / b - 1.0).abs() < 0.08, "{a} {b}");
    }
}

#[test]
fn plain_sums_depend_on_the_mesh_and_weighted_ones_do_not() {
    let shape = |v: &Vec3| {
        let r = 0.2;
        Vec3::new(1.01 * r * (v.x / r).sin(), v.y + 0.01 * v.x * v.y, r * (1.0 - (v.x / r).cos()))
    };
    let energies = |weighting, side: u32| {
        let mesh = sheet(WIDTH, HEIGHT, side, side);
        let x: Vec<Vec3> = mesh.vertices.iter().map(shape).collect();
        let cloth = GeometricCloth::new(&mesh, poplin(), weighting).expect("cloth");
        cloth.energy(&x, &Recovery::AllVertices(mesh.vertices.clone()))
    };
    let (coarse, fine) = (energies(Weighting::Plain, 51), energies(Weighting::Plain, 101));
    let ratios = [fine.recovery / coarse.recovery, fine.stretch / coarse.stretch, fine.bend / coarse.bend];
    for (ratio, expected) in ratios.iter().zip([4.0, 1.0, 0.25]) {
        assert!((ratio / expected - 1.0).abs() < 0.05, "{ratios:?}");
    }
    let (coarse, fine) = (energies(Weighting::PerArea, 51), energies(Weighting::PerArea, 101));
    for (a, b) in [(coarse.recovery, fine.recovery), (coarse.stretch, fine.stretch), (coarse.bend, fine.bend)] {
        assert!((a / b - 1.0).abs() < 0.03, "{a} {b}");
    }
}

#[test]
fn one_bump_has_one_energy_in_every_mesh() {
    // L10: stretch within 1 %, bend within 3 %.
    let bump = |v: &Vec3| {
        let wave = |t: f64| (std::f64::consts::PI * t).sin();
        Vec3::new(1.01 * v.x, v.y, 0.04 * wave(v.x / WIDTH) * wave(v.y / HEIGHT))
    };
    let [coarse, fine] = [21, 41].map(|side| {
        let mesh = common::sheet(WIDTH, HEIGHT, side, side, Diagonals::Alternating);
        let x: Vec<Vec3> = mesh.vertices.iter().map(bump).collect();
        let cloth = GeometricCloth::new(&mesh, poplin(), Weighting::PerArea).expect("cloth");
        cloth.energy(&x, &Recovery::Controls(vec![]))
    });
    let ratios = [coarse.stretch / fine.stretch, coarse.bend / fine.bend];
    println!("441 against 1,681 vertices: {ratios:?}");
    assert!((ratios[0] - 1.0).abs() < 0.01 && (ratios[1] - 1.0).abs() < 0.03, "{ratios:?}");
}

#[test]
fn the_minimum_converges_under_refinement() {
    // Two opposite rims held, one of them lifted and brought nearer: the sheet bends into an S.
    let minimum = |columns: u32, rows: u32| {
        let mesh = sheet(WIDTH, HEIGHT, columns, rows);
        let cloth = GeometricCloth::new(&mesh, poplin(), Weighting::PerArea).expect("cloth");
        let mut x = mesh.vertices.clone();
        let mut held = Vec::new();
        for k in (0..columns * rows).filter(|k| k % columns == 0 || k % columns == columns - 1) {
            held.push(k);
            if k % columns != 0 {
                x[k as usize] += Vec3::new(-0.02, 0.0, 0.08);
            }
        }
        let report = LeastSquares::new(&cloth, &held, Recovery::Controls(vec![]))
            .expect("system")
            .solve(&mut x, SolveOptions::default())
            .expect("solved");
        assert!(report.converged);
        report.energy.total
    };
    let e: Vec<f64> = [(12, 11), (24, 21), (47, 41), (93, 81)].map(|(c, r)| minimum(c, r)).into();
    println!("energies under refinement: {e:?}");
    let steps: Vec<f64> = e.windows(2).map(|w| (w[1] - w[0]).abs()).collect();
    assert!(steps[1] < 0.7 * steps[0] && steps[2] < 0.7 * steps[1], "{steps:?}");
    assert!(steps[2] < 0.02 * e[3], "{steps:?}");
}

#[test]
fn both_solvers_reach_the_same_minimum() {
    let fig4 = || diagonal("Fig. 4", 31, 31);
    let mut runs: Vec<_> =
        ["cotton_poplin", "denim", "canvas", "ramie", "linen"].map(|name| (fig4(), name, false)).into();
    runs.extend([(fig7::pull(), "wool_suiting", false), (fig9::skirt(), "wool_suiting", false)]);
    runs.extend(["cotton_poplin", "linen"].map(|name| (fig4(), name, true)));
    let options = SolveOptions { tolerance: 1e-8, ..EXACT };
    for (experiment, fabric, all_vertices) in runs {
        let cloth = experiment.cloth(weights(fabric).expect("shipped")).expect("cloth");
        let recovery = || if all_vertices { every_vertex(&experiment) } else { experiment.recovery() };
        let (held, start) = (&experiment.held, &experiment.start);
        let (mut a, mut b) = (start.clone(), start.clone());
        let one_factor =
            Alternating::new(&cloth, held, recovery()).expect("system").solve(&mut a, options).expect("solved");
        let squares =
            LeastSquares::new(&cloth, held, recovery()).expect("system").solve(&mut b, options).expect("solved");
        let energy = (one_factor.energy.total / squares.energy.total - 1.0).abs();
        let (n, m, apart, name) = (one_factor.iterations, squares.iterations, largest(&a, &b), experiment.name);
        println!("{name} {fabric} {all_vertices}: {n} and {m} iterations, apart {energy:.1e}, {apart:.1e} m");
        assert!(one_factor.converged && squares.converged);
        assert!(energy < 1e-6 && apart < 1e-4);
        for report in [one_factor, squares] {
            assert!(report.history.windows(2).all(|w| w[1] <= w[0]), "the energy rose");
        }
        assert!(held.iter().all(|&v| a[v as usize] == start[v as usize] && b[v as usize] == start[v as usize]));
    }
}

/// E_P over every vertex of an experiment: the controls' targets, and the initial mesh for the others.
fn every_vertex(experiment: &common::Experiment) -> Recovery {
    let mut targets = experiment.mesh.vertices.clone();
    for control in &experiment.controls {
        control.vertices().for_each(|v| targets[v as usize] = control.target());
    }
    Recovery::AllVertices(targets)
}

#[test]
fn recovery_of_every_vertex_makes_spikes() {
    // The reading that does not reproduce the figures, as its documentation says: the lifted places are held.
    let mut sheet = diagonal("Fig. 5", 50, 40);
    for control in &sheet.controls {
        for v in control.vertices() {
            sheet.held.push(v);
            sheet.start[v as usize] = control.target();
        }
    }
    let cloth = sheet.cloth(weights("silk_charmeuse").expect("shipped")).expect("cloth");
    let mut x = sheet.start.clone();
    let recovery = Recovery::AllVertices(sheet.mesh.vertices.clone());
    let mut solver = LeastSquares::new(&cloth, &sheet.held, recovery).expect("system");
    assert!(solver.solve(&mut x, SolveOptions::default()).expect("solved").converged);
    let longest = common::measure::strain(&sheet.mesh, &x).longest;
    println!("longest edge + {:.0} %", 100.0 * longest);
    assert!(longest > 3.0);
}

#[test]
fn the_papers_own_loop_ends_near_the_minimum() {
    // L11: fifteen plain steps while dragging, Fig. 5.
    let sheet = diagonal("Fig. 5", 50, 40);
    for name in ["denim", "wool_suiting", "silk_charmeuse", "canvas", "ramie", "cotton_poplin"] {
        let cloth = sheet.cloth(weights(name).expect("shipped")).expect("cloth");
        let (mut dragged, mut least) = (sheet.mesh.vertices.clone(), sheet.mesh.vertices.clone());
        let mut solver = LeastSquares::new(&cloth, &sheet.held, sheet.recovery()).expect("system");
        solver.drag(&mut dragged, 15).expect("dragged");
        let least = solver.solve(&mut least, SolveOptions::default()).expect("solved").energy.total;
        let over = cloth.energy(&dragged, &sheet.recovery()).total / least - 1.0;
        println!("{name}: {:.2} % over the minimum", 100.0 * over);
        assert!(over < 0.01, "{name}: {over}");
    }
}

#[test]
fn gravity_ends_in_balance() {
    let mesh = sheet(0.2, 0.3, 9, 13);
    let weights = Weights { recovery: 1.0, stretch: 40.0, bend: 1.0 };
    let cloth = GeometricCloth::new(&mesh, weights, Weighting::PerArea).expect("cloth");
    let held: Vec<u32> = (12 * 9..13 * 9).collect();
    let falling = Recovery::Falling(GeometricCloth::drop_for_bending_length(0.022));
    let start = shaken(&mesh.vertices, 1e-4);
    let (mut a, mut b) = (start.clone(), start);
    for v in &held {
        a[*v as usize] = mesh.vertices[*v as usize];
        b[*v as usize] = mesh.vertices[*v as usize];
    }
    let report =
        Alternating::new(&cloth, &held, falling.clone()).expect("system").solve(&mut a, EXACT).expect("solved");
    let squares =
        LeastSquares::new(&cloth, &held, falling.clone()).expect("system").solve(&mut b, EXACT).expect("solved");
    println!("{} and {} iterations, {:.1e} m apart", report.iterations, squares.iterations, largest(&a, &b));
    assert!(report.converged && squares.converged);
    assert!(largest(&a, &b) < 1e-5);
    // At rest only held vertices feel an unbalanced force, and together they carry the weight 2 ω_R s drop · area.
    let gradient = cloth.gradient(&a, &falling);
    let weight =
        -2.0 * weights.recovery * 0.2 * 0.3 / PUBLISHED_CELL.powi(2) * GeometricCloth::drop_for_bending_length(0.022).y;
    let free = (0..12 * 9).map(|v: usize| gradient[v].norm()).fold(0.0, f64::max);
    assert!(free < 1e-6 * weight, "{free} of {weight}");
    let pins: f64 = held.iter().map(|&v| gradient[v as usize].y).sum();
    assert!((pins / weight - 1.0).abs() < 1e-6, "{pins} {weight}");
}

#[test]
fn what_cannot_be_solved_is_an_error() {
    let mesh = sheet(0.1, 0.1, 3, 3);
    let bad = |recovery| Weights { recovery, stretch: 0.0, bend: 0.0 };
    for weights in [bad(0.0), bad(-1.0), bad(f64::NAN)] {
        let made = GeometricCloth::new(&mesh, weights, Weighting::Plain);
        assert!(matches!(made, Err(GeometricError::Weights(_))));
    }
    let made = |change: fn(&mut TriMesh)| {
        let mut mesh = mesh.clone();
        change(&mut mesh);
        GeometricCloth::new(&mesh, poplin(), Weighting::Plain).err()
    };
    assert_eq!(made(|m| m.triangles[1] = [0, 1, 99]), Some(GeometricError::Index { triangle: 1, vertices: 9 }));
    assert_eq!(made(|m| m.vertices[1] = m.vertices[0]), Some(GeometricError::Degenerate(0)));
    assert_eq!(made(|m| m.vertices[0].x = f64::NAN), Some(GeometricError::Degenerate(0)));
    // A third triangle at the first diagonal.
    assert_eq!(made(|m| m.triangles.push([0, 4, 2])), Some(GeometricError::NonManifold([0, 4])));

    let cloth = GeometricCloth::new(&mesh, poplin(), Weighting::Plain).expect("cloth");
    let none = || Recovery::Controls(vec![]);
    let no_vertex = Some(GeometricError::Handle { vertex: 9, vertices: 9 });
    assert_eq!(Alternating::new(&cloth, &[9], none()).err(), no_vertex);
    let refused = |recovery| LeastSquares::new(&cloth, &[0], recovery).err();
    let drawn = |control| refused(Recovery::Controls(vec![Control::vertex(1, Vec3::zeros()), control]));
    assert_eq!(drawn(Control::vertex(9, Vec3::zeros())), no_vertex);
    let wrong = Some(GeometricError::Control(1));
    assert_eq!(drawn(Control::vertex(2, Vec3::new(0.0, f64::NAN, 0.0))), wrong);
    assert_eq!(drawn(Control::in_triangle([0, 1, 4], [f64::INFINITY, 0.0, 1.0], Vec3::zeros())), wrong);
    assert_eq!(drawn(Control::in_triangle([0, 1, 1], [0.4, 0.3, 0.3], Vec3::zeros())), wrong);
    assert_eq!(refused(Recovery::Falling(Vec3::new(0.0, f64::NAN, 0.0))), Some(GeometricError::Drop));
    let short = |what| Some(GeometricError::Count { what, found: 3, expected: 9 });
    assert_eq!(refused(Recovery::AllVertices(vec![Vec3::zeros(); 3])), short("targets"));

    let solver = Alternating::new(&cloth, &[0], none()).expect("system");
    let solved = |mut x: Vec<Vec3>| solver.solve(&mut x, SolveOptions::default()).err();
    assert_eq!(solved(vec![Vec3::zeros(); 3]), short("positions"));
    let with_height = |z| {
        let mut x = mesh.vertices.clone();
        x[4].z = z;
        x
    };
    assert_eq!(solved(with_height(f64::NAN)), Some(GeometricError::NotFinite(4)));
    assert_eq!(solved(with_height(1e200)), Some(GeometricError::Overflow));
}
