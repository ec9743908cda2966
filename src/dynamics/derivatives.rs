//! One test of every energy: its forces against finite differences of its energy, its stiffness against those of its
//! forces, and its bound against its stiffness.

use nalgebra::DMatrix;

use super::bending::{Bending, Stencil};
use super::contact_law::{ContactLaw, Hardening};
use super::crease::Crease;
use super::elasticity::Elasticity;
use super::elements::Elements;
use super::energy::{Bound, Elastic, Energy, Exerted, Stiffness, fill, on_nodes};
use super::force::{Forces, push};
use super::friction::{Friction, Grip};
use super::membrane::Membrane;
use super::model::Cloth;
use super::pull::Pull;
use super::scattered::Scattered;
use super::shear::Shear;
use super::spring::Spring;
use super::stretch::{Stretch, StretchLaw};
use super::thread::Thread;
use super::touching::{Pushing, Touching, presses};
use super::weight::Weight;
use crate::contact::{Contact, Under};
use crate::geometry::Vec3;
use crate::linear::{SymmetricMatrix, SymmetricPattern};

/// Way of a coordinate by which energies are differenced, metres. Elements here are a centimetre large.
const OF_ENERGY: f64 = 1e-7;
/// Way of a coordinate by which forces are differenced, metres.
const OF_FORCES: f64 = 1e-8;
/// Largest error of a difference, in the largest entry.
const ERROR: f64 = 1e-5;
/// Rounding of a bound, which has single precision, in its largest entry.
const SINGLE: f64 = 1e-6;

fn forces(energy: &impl Energy, x: &[Vec3]) -> Vec<Vec3> {
    on_nodes(x.len(), |_| Vec3::zeros(), &energy.forces(x))
}

/// The difference of a value that a coordinate's way makes, per way.
fn slope<T: std::ops::Sub<Output = T> + std::ops::Div<f64, Output = T>>(
    x: &[Vec3],
    coordinate: usize,
    way: f64,
    value: impl Fn(&[Vec3]) -> T,
) -> T {
    let at = |way: f64| {
        let mut to = x.to_vec();
        to[coordinate / 3][coordinate % 3] += way;
        value(&to)
    };
    (at(way) - at(-way)) / (2.0 * way)
}

/// Three numbers of every node as one column.
fn column(vectors: &[Vec3]) -> DMatrix<f64> {
    DMatrix::from_fn(3 * vectors.len(), 1, |row, _| vectors[row / 3][row % 3])
}

/// A matrix from its products with the unit vectors.
fn matrix(nodes: usize, times: impl Fn(&[Vec3]) -> DMatrix<f64>) -> DMatrix<f64> {
    let columns = (0..3 * nodes).map(|k| {
        let mut unit = vec![Vec3::zeros(); nodes];
        unit[k / 3][k % 3] = 1.0;
        times(&unit)
    });
    DMatrix::from_columns(&columns.map(|c| c.column(0).into_owned()).collect::<Vec<_>>())
}

fn stiffness(energy: &impl Energy, x: &[Vec3]) -> DMatrix<f64> {
    let stiffness = energy.stiffness(x);
    matrix(x.len(), |unit| column(&on_nodes(x.len(), |_| Vec3::zeros(), &stiffness.times(unit))))
}

fn bound(energy: &impl Energy, x: &[Vec3]) -> DMatrix<f64> {
    let pairs = energy.pairs().map(|[a, b]| (a as usize, b as usize));
    let pattern = SymmetricPattern::blocks(x.len(), pairs).expect("a pattern");
    let mut filled = SymmetricMatrix::zeros(pattern.into());
    fill(&mut filled, |_| 0.0, &energy.bound(x));
    matrix(x.len(), |unit| {
        let mut out = vec![0.0; 3 * x.len()];
        filled.multiply(column(unit).as_slice(), &mut out);
        DMatrix::from_vec(out.len(), 1, out)
    })
}

fn forces_are_the_slope_of_the_energy(name: &str, energy: &impl Energy, x: &[Vec3]) {
    let found = column(&forces(energy, x));
    let expected = DMatrix::from_fn(found.len(), 1, |k, _| -slope(x, k, OF_ENERGY, |x| energy.energy(x)));
    assert!(found.amax() > 0.0, "{name}: no force");
    assert!((&found - &expected).amax() < ERROR * found.amax(), "{name}: {found} and not {expected}");
}

fn the_stiffness_is_the_slope_of_the_forces(name: &str, energy: &impl Energy, x: &[Vec3]) {
    let found = stiffness(energy, x);
    let column_of = |k: usize| (slope(x, k, OF_FORCES, |x| column(&forces(energy, x))) * -1.0).column(0).into_owned();
    let expected = DMatrix::from_columns(&(0..3 * x.len()).map(column_of).collect::<Vec<_>>());
    assert!((&found - &found.transpose()).amax() <= 1e-9 * found.amax(), "{name}: {found} is not symmetric");
    assert!((&found - &expected).amax() <= ERROR * found.amax(), "{name}: {found} and not {expected}");
}

/// The stiffness of steps resists every motion, and at least as much as the cloth does.
fn the_bound_is_positive_and_above_the_stiffness(name: &str, energy: &impl Energy, x: &[Vec3]) {
    let (bound, stiffness) = (bound(energy, x), stiffness(energy, x));
    let least = -SINGLE * bound.amax();
    assert!(bound.clone().symmetric_eigenvalues().min() >= least, "{name}: {bound} is not positive");
    assert!((&bound - &stiffness).symmetric_eigenvalues().min() >= least, "{name}: {bound} is not above {stiffness}");
}

fn check(name: &str, energy: &impl Energy, x: &[Vec3]) {
    forces_are_the_slope_of_the_energy(name, energy, x);
    the_stiffness_is_the_slope_of_the_forces(name, energy, x);
    the_bound_is_positive_and_above_the_stiffness(name, energy, x);
}

/// Four nodes a centimetre apart, where nothing is small or square.
fn askew() -> Vec<Vec3> {
    [[0.0, 0.0, 0.0], [0.011, 0.001, 0.0], [0.002, 0.012, 0.003], [-0.004, 0.002, -0.009]].map(Vec3::from).to_vec()
}

/// A triangle whose sides from the first node are drawn out and turned towards each other, and a fourth node.
fn sheared(angle: f64) -> Vec<Vec3> {
    let (one, other) = (Vec3::new(2.0, 1.0, -2.0) / 3.0, Vec3::new(1.0, 2.0, 2.0) / 3.0);
    let corner = Vec3::new(0.3, 1.0, -0.2);
    vec![corner, corner + one * 0.013, corner + (one * angle.sin() + other * angle.cos()) * 0.0072, Vec3::zeros()]
}

/// Two triangles folded by `angle` along the side between the first two nodes.
fn folded(angle: f64) -> Vec<Vec3> {
    let (s, c) = (0.5 * angle).sin_cos();
    let corners = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.7 * c + 0.05, 0.28, -0.7 * s], [-0.4 * c, 0.8, -0.4 * s]];
    corners.map(|p| Vec3::from(p) * 0.01).to_vec()
}

/// An example of every family of elements: springs that are drawn out and that are pressed, a thread, and shears along
/// and askew to the sides of their triangle.
fn elements() -> Elements {
    let stretch = |rest: f64| Stretch { rest, width: 0.01, law: 0 };
    let spring = |ends, rest| Spring { ends, stretch: stretch(rest) };
    let (nodes, weights) = ([0, 1, 2], [0.9, 0.3]);
    let shear = |legs, rest| Shear { nodes, legs, rest, stiffness: 2e-3 };
    Elements {
        springs: vec![spring([3, 0], 0.009), spring([1, 2], 0.02)],
        threads: vec![Thread { nodes, weights, stretch: stretch(0.0112) }],
        shears: vec![shear([weights, [-0.2, 1.1]], 0.1), shear([[1.0, 0.0], [0.0, 1.0]], 0.004)],
    }
}

fn membrane(elements: Elements) -> Membrane {
    Membrane::new(4, elements, vec![StretchLaw::linear(500.0)])
}

fn bending() -> Bending {
    let stencil = |flows: [(u32, u32, f64); 3]| Stencil { flows: flows.to_vec(), weight: 2e-7 };
    Bending::new(
        4,
        &[stencil([(0, 1, 90.0), (1, 2, -70.0), (3, 1, 40.0)]), stencil([(0, 2, 50.0), (2, 3, 60.0), (1, 3, -20.0)])],
    )
}

#[test]
fn families_of_elements() {
    // A new family must have an example here.
    let Elements { springs, threads, shears } = elements();
    let alone = [
        ("springs", Elements { springs, ..Elements::default() }),
        ("threads", Elements { threads, ..Elements::default() }),
        ("shears", Elements { shears, ..Elements::default() }),
        ("all families", elements()),
    ];
    for (name, elements) in alone {
        assert!(elements.len() > 0, "{name}: no example");
        let mut membrane = membrane(elements);
        for x in std::iter::once(askew()).chain([-1.2, -0.4, 0.0, 0.3, 0.9].map(sheared)) {
            check(name, &membrane, &x);
        }
        // With loads as a step predicts them the stiffness is the slope of nothing, but is bounded still.
        for load in [-2e-3, 0.0, 5e-3, 40.0] {
            membrane.follow(&askew(), vec![load; membrane.elements().len()]);
            the_bound_is_positive_and_above_the_stiffness(name, &membrane, &askew());
        }
    }
}

#[test]
fn energies_of_the_cloth() {
    let creases = |rest: f64| Scattered(vec![Crease::new([0, 1, 2, 3], rest, 0.3)].into());
    check("bending", &bending(), &askew());
    for (rest, angle) in [(1.0, 0.3), (-0.8, 0.5), (3.1, 2.9), (3.1, 3.3), (0.5, -1.9)] {
        let (energy, x) = (creases(rest), folded(angle));
        forces_are_the_slope_of_the_energy("a crease", &energy, &x);
        the_bound_is_positive_and_above_the_stiffness("a crease", &energy, &x);
        // Its stiffness lacks what the moment adds, so that it is the slope of the forces where there is none.
        let at_rest = creases(energy.0[0].angle(&x));
        the_stiffness_is_the_slope_of_the_forces("a crease at rest", &at_rest, &x);
    }
    // All together. A new energy must have an example here.
    let x = askew();
    let turned = creases(0.0).0[0].angle(&x);
    let all = Elasticity { bending: bending(), creases: creases(turned), membrane: membrane(elements()) };
    check("elasticity", &all, &x);
}

#[test]
fn weight_and_stitches() {
    let mass = [1e-3, 2e-3, 0.5e-3, 1e-3];
    check("weight", &Weight { mass: &mass, share: 0.7 }, &askew());
    for (name, cap) in [("a stitch within its cap", 0.05), ("a stitch beyond its cap", 0.004)] {
        let pulls = [Pull { ends: [0, 2], stiffness: 40.0, cap }, Pull { ends: [3, 1], stiffness: 40.0, cap }];
        check(name, &Scattered((&pulls[..]).into()), &askew());
    }
}

/// Contacts that all push, with friction at the normal forces `loads`: what a round of a step takes for granted.
struct Contacts<'a> {
    cloth: &'a Cloth,
    forces: Forces<'a>,
    loads: Vec<f64>,
    touching: Touching,
}

fn grips(cloth: &Cloth, forces: &Forces, loads: &[f64], x: &[Vec3]) -> Vec<Option<Grip>> {
    loads.iter().enumerate().map(|(k, load)| Some(forces.hold(cloth, x, k, *load)?.grip())).collect()
}

impl<'a> Contacts<'a> {
    fn new(cloth: &'a Cloth, forces: Forces<'a>, x: &[Vec3]) -> Self {
        let loads = forces.loads(cloth, x);
        assert!(loads.iter().all(|load| *load > 0.0), "{loads:?}: they do not all push");
        let (presses, grips) = (presses(cloth, x, &forces), grips(cloth, &forces, &loads, x));
        let active = vec![true; presses.len()];
        let pushing = Pushing { presses: &presses, active: &active, grips: &grips };
        Self { cloth, loads, touching: Touching::new(forces.contacts, &pushing, x.len()), forces }
    }
}

/// Forces of contacts on every node.
struct ContactForces(Vec<Vec3>);

impl Exerted for ContactForces {
    fn gather(&self, node: usize, sum: Vec3) -> Vec3 {
        sum + self.0[node]
    }
}

impl Energy for Contacts<'_> {
    fn energy(&self, x: &[Vec3]) -> f64 {
        self.forces.energy_with(self.cloth, x, &self.loads, 0.0)
    }

    fn forces<'a>(&'a self, x: &'a [Vec3]) -> impl Exerted + 'a {
        let mut out = vec![Vec3::zeros(); x.len()];
        for (contact, grip) in self.forces.contacts.iter().zip(grips(self.cloth, &self.forces, &self.loads, x)) {
            push(&mut out, contact, self.forces.load(self.cloth, x, contact), grip);
        }
        ContactForces(out)
    }

    fn stiffness<'a>(&'a self, _x: &'a [Vec3]) -> impl Stiffness + 'a {
        &self.touching
    }

    fn bound<'a>(&'a self, _x: &'a [Vec3]) -> impl Bound + 'a {
        self.touching.bound(|_| false, |_, _| true)
    }

    fn pairs(&self) -> impl Iterator<Item = [u32; 2]> {
        (1..4).flat_map(|a| (0..a).map(move |b| [a, b]))
    }
}

/// A node on the body and one on an edge of another layer, both pressed to half of their distance.
#[test]
fn contacts_that_push_and_hold_or_slide() {
    let cloth = Cloth {
        mass: vec![1e-3; 4],
        half_thickness: vec![0.2e-3; 4],
        friction: vec![0.5; 4],
        elastic: Elasticity { bending: Bending::new(4, &[]), ..Elasticity::default() },
        ..Cloth::default()
    };
    let x = askew();
    let normal = Vec3::new(2.0, 1.0, -2.0) / 3.0;
    let body = Contact::on_body(0, normal, x[0] - normal * 0.3e-3);
    let weights = [1.0, -0.4, -0.6, 0.0];
    let layers = Contact { nodes: [1, 2, 3, 0], weights, count: 3, above: 1, under: Under::Cloth, share: 0.8, ..body };
    let layers = Contact { offset: 0.0, ..layers };
    let layers = Contact { offset: layers.gap(&x) - 0.2e-3, ..layers };
    let contacts = [body, layers];
    for hardening in [Hardening::Slow, Hardening::Fast] {
        let law = ContactLaw { stiffness: 60.0, hardening, body_clearance: 0.4e-3, cloth_gap: None };
        let loose = Forces { gravity: 0.0, contacts: &contacts, law, pulls: &[], friction: None };
        check("contacts without friction", &Contacts::new(&cloth, loose, &x), &x);
        // Dragged from there by a micrometre, and by more than any friction holds.
        for (name, way) in [("contacts that hold", 1e-6), ("contacts that slide", 2e-3)] {
            let drag = |(k, x): (usize, &Vec3)| x - Vec3::new(1.0, 0.4 * k as f64, 1.0) * (way * (1.0 + k as f64));
            let from: Vec<Vec3> = x.iter().enumerate().map(drag).collect();
            let friction = Friction::new(&from, &contacts, 200.0);
            let held = Contacts::new(&cloth, Forces { friction: Some(&friction), ..loose }, &x);
            let slides = grips(&cloth, &held.forces, &held.loads, &x).iter().flatten().filter(|g| g.slides).count();
            assert_eq!(slides, if way > 1e-3 { 2 } else { 0 }, "{name}");
            check(name, &held, &x);
        }
    }
}
