//! The spring-mass model of Fan et al. 1999: forces (F3, F5–F7) and the explicit scheme (F2, F8, F9).

use std::sync::Arc;

use toile::contact::{Contact, Under};
use toile::dynamics::explicit::{Explicit, ExplicitError, Rest, Start, StepControl, explicit_cloth, law_of};
use toile::dynamics::{
    Cloth, ContactLaw, Cut, Elements, Forces, Hardening, Membrane, Pull, Spring, SpringModel, Stepper, Stretch,
    StretchLaw, identity_nodes,
};
use toile::fabric::{self, GRAVITY};
use toile::geometry::{Path, Vec2, Vec3};
use toile::io::garment::read_text;
use toile::mesh::{ClothMesh, build};
use toile::pattern::{Closure, Edge, Garment, Piece};

const MM: f64 = 1e-3;
const LAW: ContactLaw =
    ContactLaw { stiffness: 50.0, hardening: Hardening::Slow, body_clearance: 1e-3, cloth_gap: None };
const NOTHING: Forces = Forces { gravity: 0.0, contacts: &[], law: LAW, pulls: &[], friction: None };

/// A rectangular piece of poplin and its mesh, millimetres.
fn rectangle(width: f64, height: f64, spacing: f64) -> (Garment, ClothMesh) {
    let corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)];
    let at = |k: usize| Vec2::new(corners[k % 4].0, corners[k % 4].1) * MM;
    let outline =
        (0..4).map(|k| Edge { name: format!("e{k}"), path: Path::line(at(k), at(k + 1)), against: false }).collect();
    let piece = Piece {
        name: "panel".into(),
        drawn_as: "panel".into(),
        side: None,
        fold: None,
        fabric: "shell".into(),
        layer: 0,
        beneath: 0,
        warp: Vec2::new(0.0, 1.0),
        loops: vec![outline],
        lines: Vec::new(),
        notches: Vec::new(),
        place: None,
    };
    let garment = Garment {
        name: "test".into(),
        title: "Test".into(),
        body: None,
        pieces: vec![piece],
        seams: Vec::new(),
        fabrics: Vec::new(),
        closures: Vec::new(),
        worn: Vec::new(),
        tests: Vec::new(),
    };
    let mesh = build(&garment, spacing * MM).expect("mesh");
    (garment, mesh)
}

/// A panel and where it hangs: the flat piece upright in the plane z = 0.
fn panel(width: f64, height: f64, spacing: f64, model: SpringModel) -> (Cloth, Vec<Vec3>) {
    let (garment, mesh) = rectangle(width, height, spacing);
    let poplin = Arc::new(fabric::load("cotton_poplin").expect("shipped"));
    let cloth = Cloth::new(&Cut { garment: &garment, mesh: &mesh, fabrics: &[poplin] }, identity_nodes(&mesh), model);
    let x = mesh.flat.iter().map(|p| Vec3::new(p.x, -p.y, 0.0)).collect();
    (cloth, x)
}

/// A cloth with other springs and no shear.
fn with_springs(cloth: &Cloth, springs: Vec<Spring>, laws: Vec<StretchLaw>) -> Cloth {
    let mut out = cloth.clone();
    out.elastic.membrane = Membrane::new(cloth.mass.len(), Elements { springs, ..Elements::default() }, laws);
    out
}

/// A small sheet without springs and shear.
fn slack() -> (Cloth, Vec<Vec3>) {
    let (cloth, x) = panel(20.0, 20.0, 6.0, SpringModel::Soft { stiffness: 1.0, bias: 1.0 });
    (with_springs(&cloth, Vec::new(), Vec::new()), x)
}

/// What `forces`, springs and shear of `cloth` add to the forces of its bending.
fn added(cloth: &Cloth, forces: Forces, x: &[Vec3]) -> Vec<Vec3> {
    let bare = with_springs(cloth, Vec::new(), Vec::new());
    let (all, bending) = (law_of(cloth, forces)(x), law_of(&bare, NOTHING)(x));
    all.iter().zip(&bending).map(|(a, b)| a - b).collect()
}

fn noise(count: usize) -> Vec<f64> {
    let mut state = 99u64;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) as f64 / f64::from(1u32 << 30) - 1.0
    };
    (0..count).map(|_| next()).collect()
}

fn body_contact(node: u32, normal: Vec3, offset: f64) -> Contact<'static> {
    let weights = [1.0, 0.0, 0.0, 0.0];
    Contact { nodes: [node, 0, 0, 0], weights, count: 1, normal, offset, under: Under::Plane, above: 1, share: 1.0 }
}

/// Six contacts that press on a node from all sides: a spring to `at` that both integrators know.
fn pin(cloth: &Cloth, node: u32, at: Vec3) -> Vec<Contact<'static>> {
    let kept = cloth.half_thickness[node as usize] + LAW.body_clearance;
    let pressed = 2e-4;
    let axes = [Vec3::x(), Vec3::y(), Vec3::z()];
    axes.iter().flat_map(|a| [*a, -a]).map(|n| body_contact(node, n, n.dot(&at) - kept + pressed)).collect()
}

// ---- forces ----

#[test]
fn weight_is_density_times_area_times_gravity() {
    let (cloth, x) = panel(300.0, 200.0, 10.0, SpringModel::Measured);
    let law = law_of(&cloth, Forces { gravity: 1.0, ..NOTHING });
    let total = law(&x).iter().sum::<Vec3>();
    let density = fabric::load("cotton_poplin").expect("shipped").areal_density;
    let expected = density * 0.3 * 0.2 * GRAVITY;
    assert!((total.y / -expected - 1.0).abs() < 1e-12, "{total}");
    assert!(total.x.abs() < 1e-12 * expected && total.z.abs() < 1e-12 * expected);
}

#[test]
fn a_hooke_spring_pulls_in_proportion() {
    let (unsprung, mut x) = slack();
    // 1 N/mm: stiffness · width / rest length.
    let rest = (x[1] - x[0]).norm();
    let spring = Spring { ends: [0, 1], stretch: Stretch { rest, width: 0.01, law: 0 } };
    let cloth = with_springs(&unsprung, vec![spring], vec![StretchLaw::linear(1000.0 * rest / 0.01)]);
    let (along, at_rest) = ((x[1] - x[0]).normalize(), x[1]);
    for stretch in [-2e-3, 0.0, 1e-3, 5e-3] {
        x[1] = at_rest + along * stretch;
        let force = added(&cloth, NOTHING, &x);
        assert!((force[0] - along * (1000.0 * stretch)).norm() < 1e-9);
        assert!((force[0] + force[1]).norm() < 1e-9);
        // The force is the energy's slope only with ½ c d²; the paper's (2) lacks the ½ that its (3) needs.
        let energy = cloth.elastic_energy(&x) - unsprung.elastic_energy(&x);
        assert!((energy - 500.0 * stretch * stretch).abs() < 1e-12);
    }
}

/// The patch test: even strain is even load, also in triangles that no thread runs along a side of. Springs on all
/// sides of these gave as the bias does, and what a tight skirt gave gathered in them.
#[test]
fn cloth_that_is_strained_evenly_is_in_balance_up_to_its_rim() {
    let text = "garment: 1\npieces: {panel: {grain: [[50, 50], [50, 150]], outline: {start: 0 0, top: L 150 0, \
                side: 'C 165 60, 190 140, 200 200', hem: L 0 200, left: L 0 0}}}\nfree: ['*.*']\n";
    let garment = read_text("panel", "panel.yaml", text).expect("a garment").garment;
    let mesh = build(&garment, 12.0 * MM).expect("a mesh");
    let fabrics = [Arc::new(fabric::load("denim").expect("shipped"))];
    let cut = Cut { garment: &garment, mesh: &mesh, fabrics: &fabrics };
    let cloth = Cloth::new(&cut, identity_nodes(&mesh), SpringModel::Measured);
    let threads = cloth.elastic.membrane.elements().threads.len();
    assert!(threads > 20, "{threads} threads off the grid");
    for [across, along, sheared] in [[1.02, 1.0, 0.0], [1.0, 1.01, 0.0], [1.0, 1.0, 0.03]] {
        let strained = |p: &Vec2| Vec3::new(across * p.x + sheared * p.y, -along * p.y, 0.0);
        let forces = added(&cloth, NOTHING, &mesh.flat.iter().map(strained).collect::<Vec<_>>());
        let mut on_rim = vec![false; mesh.flat.len()];
        mesh.pieces[0].edges.iter().flat_map(|e| &e.particles).for_each(|p| on_rim[*p as usize] = true);
        let largest = |rim: bool| {
            let of = forces.iter().zip(&on_rim).filter(|(_, on)| **on == rim);
            of.map(|(f, _)| f.norm()).fold(0.0, f64::max)
        };
        // Lines of the grid may leave the thread by 0.3° (sine 5e-3), and their springs pull along them.
        assert!(largest(false) < 2e-3 * largest(true), "{} N off balance of {}", largest(false), largest(true));
    }
}

#[test]
fn a_closure_ties_what_it_joins_with_a_short_thread() {
    let (mut garment, mesh) = rectangle(100.0, 60.0, 10.0);
    let ends = [Vec2::new(0.012, 0.031), Vec2::new(0.078, 0.049)];
    garment.closures =
        vec![Closure { kind: "hook".into(), tacks: vec![[(0, ends[0]), (0, ends[1])]], ..Closure::default() }];
    let fabrics = vec![Arc::new(fabric::load("cotton_poplin").expect("fabric"))];
    let cut = Cut { garment: &garment, mesh: &mesh, fabrics: &fabrics };
    // Far shorter than the grid's own.
    let short = |model| -> Vec<Spring> {
        let cloth = Cloth::new(&cut, identity_nodes(&mesh), model);
        let springs = &cloth.elastic.membrane.elements().springs;
        springs.iter().filter(|s| s.stretch.rest <= 2.0 * MM).copied().collect()
    };
    // While the seams close nothing is fastened.
    assert!(short(SpringModel::Soft { stiffness: 50.0, bias: 0.3 }).is_empty());
    let fastened = short(SpringModel::Measured);
    let [thread] = &fastened[..] else { panic!("{fastened:?}") };
    for (node, end) in thread.ends.iter().zip(ends) {
        assert!((mesh.flat[*node as usize] - end).norm() < 8.0 * MM);
    }
}

#[test]
fn sewing_pulls_in_proportion_and_then_no_harder() {
    let (cloth, mut x) = slack();
    let pulls = [Pull { ends: [0, 2], stiffness: 40.0, cap: 0.05 }];
    let direction = Vec3::new(2.0, -1.0, 2.0) / 3.0;
    for (gap, expected) in [(0.0, 0.0), (0.01, 0.4), (0.02, 0.8), (0.05, 2.0), (0.3, 2.0)] {
        x[2] = x[0] + direction * gap;
        let force = added(&cloth, Forces { pulls: &pulls, ..NOTHING }, &x);
        assert!((force[0] - direction * expected).norm() < 1e-9, "{gap}");
        assert!((force[0] + force[2]).norm() < 1e-9);
    }
}

#[test]
fn contact_pushes_within_its_distance_only() {
    let (cloth, mut x) = slack();
    let contacts = [body_contact(0, Vec3::z(), 0.0)];
    let kept = cloth.half_thickness[0] + LAW.body_clearance;
    // d · kept / gap: ever harder as the gap closes, and in proportion below a five-thousandth of the distance kept.
    let inside = |gap: f64| 4999.0 + 2500.0 * (2e-4 - gap);
    let deep = [-1.0, 0.0].map(|height| (height, inside(height)));
    let shallow = [(2e-4, 4999.0), (1e-3, 999.0), (0.02, 49.0), (0.1, 9.0), (0.2, 4.0), (0.5, 1.0), (1.1, 0.0)];
    for (height, load) in deep.into_iter().chain(shallow) {
        x[0].z = height * kept;
        let force = added(&cloth, Forces { contacts: &contacts, ..NOTHING }, &x);
        assert!((force[0] - Vec3::z() * (load * LAW.stiffness * kept)).norm() < 1e-9, "{height}");
        // Next to the end of an edge a contact is only part of what pushes.
        let third = [Contact { share: 1.0 / 3.0, ..contacts[0] }];
        let part = added(&cloth, Forces { contacts: &third, ..NOTHING }, &x);
        assert!((part[0] - force[0] / 3.0).norm() < 1e-9, "{height}");
    }
}

/// Gaps of a tenth of a micrometre ask for a stiffness of 1e9 N/m,
/// beside which the springs are lost in single precision.
#[test]
fn a_step_can_be_made_where_contacts_press_hard() {
    let (cloth, x) = panel(70.0, 60.0, 10.0, SpringModel::Measured);
    let kept = cloth.half_thickness[0] + LAW.body_clearance;
    let noise = noise(3 * 24);
    let contacts: Vec<Contact> = noise
        .chunks_exact(3)
        .zip(20u32..)
        .map(|(d, node)| {
            let normal = Vec3::from_column_slice(d).normalize();
            let weights = [0.4, 0.6, -0.5, -0.5];
            let nodes = [node, node + 1, node + 8, node + 9];
            let at: Vec3 = nodes.iter().zip(weights).map(|(&n, w)| x[n as usize] * w).sum();
            let offset = normal.dot(&at) - 2e-4 * kept;
            Contact { nodes, weights, count: 4, normal, offset, under: Under::Cloth, above: 2, share: 1.0 }
        })
        .collect();
    let touching: Vec<[u32; 2]> = contacts
        .iter()
        .flat_map(|c| (0..4).flat_map(move |i| (i + 1..4).map(move |j| [c.nodes[i], c.nodes[j]])))
        .collect();
    let mut stepper = Stepper::new(&cloth, &[], &touching).expect("a system");
    let still = vec![Vec3::zeros(); x.len()];
    let step = stepper.solve(&cloth, &x, &still, 1.0, &Forces { contacts: &contacts, ..NOTHING }, 1).expect("a step");
    let longest = step.iter().map(Vec3::norm).fold(0.0, f64::max);
    assert!(longest > 1e-6 && longest < 0.1, "{longest}");
}

#[test]
fn forces_are_the_slope_of_the_energy() {
    for model in [SpringModel::Measured, SpringModel::Soft { stiffness: 50.0, bias: 0.3 }] {
        let (cloth, flat) = panel(70.0, 60.0, 10.0, model);
        let noise = noise(3 * flat.len());
        let x: Vec<Vec3> =
            flat.iter().zip(noise.chunks_exact(3)).map(|(v, d)| v + Vec3::from_column_slice(d) * 5e-4).collect();
        let mut contacts = pin(&cloth, 5, x[5] + Vec3::new(1e-5, 2e-5, 0.0));
        let normal = Vec3::new(0.6, 0.0, 0.8);
        contacts.push(Contact {
            nodes: [20, 21, 22, 30],
            weights: [0.2, 0.3, 0.5, -1.0],
            count: 4,
            normal,
            offset: normal.dot(&(x[20] * 0.2 + x[21] * 0.3 + x[22] * 0.5 - x[30])) - 1e-4,
            under: Under::Cloth,
            above: 3,
            share: 1.0,
        });
        let pulls =
            [Pull { ends: [0, 40], stiffness: 3.0, cap: 0.01 }, Pull { ends: [2, 3], stiffness: 3.0, cap: 0.05 }];
        let forces = Forces { gravity: 1.0, contacts: &contacts, law: LAW, pulls: &pulls, friction: None };
        let found = law_of(&cloth, forces)(&x);
        let scale = found.iter().map(Vec3::norm).fold(0.0, f64::max);
        // Small against the strain between two corners of a measured curve.
        let h = 1e-8;
        let worst = (0..3 * x.len())
            .map(|k| {
                let at = |d: f64| {
                    let mut moved = x.clone();
                    moved[k / 3][k % 3] += d;
                    energy(&cloth, &moved, &forces)
                };
                ((at(-h) - at(h)) / (2.0 * h) - found[k / 3][k % 3]).abs() / scale
            })
            .fold(0.0, f64::max);
        println!("{model:?}: worst relative error {worst:.1e}");
        assert!(worst < 1e-6);
    }
}

/// Energy of everything that [`law_of`] has forces for.
fn energy(cloth: &Cloth, x: &[Vec3], forces: &Forces) -> f64 {
    let weight: f64 = cloth.mass.iter().zip(x).map(|(m, v)| m * GRAVITY * forces.gravity * v.y).sum();
    let contact: f64 = forces.contacts.iter().map(|c| contact_energy(cloth, x, c)).sum();
    let sewing = forces.pulls.iter().map(|p| {
        let gap = (x[p.ends[1] as usize] - x[p.ends[0] as usize]).norm();
        let drawn = gap.min(p.cap);
        p.stiffness * (0.5 * drawn * drawn + p.cap * (gap - drawn))
    });
    cloth.elastic_energy(x) + weight + contact + sewing.sum::<f64>()
}

/// Work against k · (kept − gap) · kept / gap.
fn contact_energy(cloth: &Cloth, x: &[Vec3], contact: &Contact) -> f64 {
    let half = |k: usize| cloth.half_thickness[contact.nodes[k] as usize];
    let gap = contact.gap(x);
    let beyond = if contact.is_on_body() { LAW.body_clearance } else { half(contact.count as usize - 1) };
    let (k, kept) = (LAW.stiffness, half(0) + beyond);
    if gap >= kept { 0.0 } else { k * kept * (kept * (kept / gap).ln() - kept + gap) }
}

// ---- the explicit scheme ----

const MASS: f64 = 0.2;
const STIFFNESS: f64 = 80.0;

fn spring(x: &[Vec3]) -> Vec<Vec3> {
    x.iter().map(|v| v * -STIFFNESS).collect()
}

/// Closed form of μ ẍ + γ ẋ + k x = 0 from rest at 1.
fn oscillator(damping: f64, t: f64) -> f64 {
    let (decay, square) = (damping / (2.0 * MASS), STIFFNESS / MASS);
    let rest = square - decay * decay;
    let shape = if rest.abs() < 1e-9 * square {
        1.0 + decay * t
    } else if rest > 0.0 {
        let w = rest.sqrt();
        (w * t).cos() + decay / w * (w * t).sin()
    } else {
        let w = (-rest).sqrt();
        (w * t).cosh() + decay / w * (w * t).sinh()
    };
    (-decay * t).exp() * shape
}

type Law = fn(&[Vec3]) -> Vec<Vec3>;

fn swing(damping: f64, step: f64, start: Start, law: Law) -> Explicit<Law> {
    let control = StepControl::Fixed { step, most: 1.0 };
    Explicit::new(vec![Vec3::x()], &[MASS], damping, start, control, law).expect("usable")
}

/// Largest error over one second.
fn error_of(damping: f64, step: f64, start: Start) -> f64 {
    let mut run = swing(damping, step, start, spring);
    let mut worst = 0.0f64;
    for _ in 0..(1.0 / step).round() as usize {
        run.advance().expect("stable");
        worst = worst.max((run.positions()[0].x - oscillator(damping, run.time())).abs());
    }
    worst
}

#[test]
fn a_damped_oscillator_follows_its_closed_form() {
    let critical = 2.0 * (STIFFNESS * MASS).sqrt();
    for damping in [0.0, 0.1 * critical, critical, 4.0 * critical] {
        let error = error_of(damping, 1e-4, Start::Centred);
        println!("damping {damping}: error {error:.1e}");
        assert!(error < 2e-5);
    }
}

#[test]
fn the_scheme_is_of_second_order_and_its_published_start_of_first() {
    for damping in [0.0, 1.0, 30.0] {
        for (start, expected) in [(Start::Centred, 2.0), (Start::Published, 1.0)] {
            let errors = [1e-3, 5e-4, 2.5e-4].map(|step| error_of(damping, step, start));
            let orders = [(errors[0] / errors[1]).log2(), (errors[1] / errors[2]).log2()];
            println!("damping {damping} {start:?}: errors {errors:?}, orders {orders:.3?}");
            assert!(orders.iter().all(|o| (o - expected).abs() < 0.1));
        }
    }
}

#[test]
fn steps_are_those_of_equation_14() {
    let (damping, step) = (1.5, 2e-3);
    let mut run = swing(damping, step, Start::Published, spring);
    let half = 0.5 * damping * step;
    let (mut before, mut now) = (1.0, 1.0);
    for _ in 0..500 {
        let next = (step * step * -STIFFNESS * now + 2.0 * MASS * now - (MASS - half) * before) / (MASS + half);
        (before, now) = (now, next);
        run.advance().expect("stable");
        assert!((run.positions()[0].x - now).abs() < 1e-12);
    }
}

/// A floor: free fall above zero, very stiff below.
fn floor(x: &[Vec3]) -> Vec<Vec3> {
    x.iter().map(|v| Vec3::y() * (-MASS * GRAVITY + 2e6 * (-v.y).max(0.0))).collect()
}

/// Steps that the adaptive runs below need at most (they take 2,200 and 1,300). One whose step collapsed would not end.
const MAX_STEPS: usize = 3_000;

#[test]
fn the_step_grows_in_the_air_and_shrinks_on_the_floor() {
    let control = StepControl::Adaptive { first: 1e-5, smallest: 1e-9, largest: 5e-3, most: 0.1 };
    let start = vec![Vec3::y() * 0.5];
    let mut run = Explicit::new(start, &[MASS], 0.05, Start::Published, control, floor).expect("usable");
    let (mut longest, mut after_landing, mut highest) = (0.0f64, f64::INFINITY, 0.0f64);
    let (mut landed, mut steps) = (false, 0);
    while run.time() < 4.0 {
        let step = run.advance().expect("never diverges");
        steps += 1;
        assert!(steps <= 2 * MAX_STEPS, "only {} s after {steps} steps", run.time());
        let height = run.positions()[0].y;
        landed |= height < 0.0;
        if landed {
            after_landing = after_landing.min(step);
            highest = highest.max(height);
        } else {
            longest = longest.max(step);
        }
    }
    println!(
        "longest {longest:.1e}, shortest on the floor {after_landing:.1e}, undone {}, bounced to {highest}",
        run.undone()
    );
    assert!(longest > 1e-3 && after_landing < 0.2 * longest && run.undone() > 0);
    // s ≤ 1 on the floor: at most ω Δt = 1 of its frequency.
    assert!(highest < 0.5 && after_landing <= (MASS / 2e6f64).sqrt());
}

#[test]
fn the_adaptive_step_finds_the_limit_of_stability() {
    // Two springs of very different frequency: the stiff one decides, though the soft one moves.
    let law = |x: &[Vec3]| vec![x[0] * -STIFFNESS, x[1] * (-1e4 * STIFFNESS)];
    let x = vec![Vec3::x(), Vec3::x() * 1e-9];
    let control = StepControl::Adaptive { first: 1e-6, smallest: 1e-9, largest: 1.0, most: 1.0 };
    let mut run = Explicit::new(x, &[MASS, MASS], 0.3, Start::Published, control, law).expect("usable");
    let (mut longest, mut steps) = (0.0f64, 0);
    while run.time() < 0.5 {
        steps += 1;
        assert!(steps <= 2 * MAX_STEPS, "only {} s after {steps} steps", run.time());
        longest = longest.max(run.advance().expect("never diverges"));
        assert!(run.positions()[0].norm() < 1.1 && run.positions()[1].norm() < 0.1);
    }
    let limit = 2.0 / (1e4 * STIFFNESS / MASS).sqrt();
    println!("longest step {:.2} of the limit, undone {}", longest / limit, run.undone());
    assert!(longest > 0.4 * limit);
}

#[test]
fn an_absurd_step_ends_in_an_error() {
    let mut run = swing(0.0, 1.0, Start::Published, spring);
    let failure = (0..1000).find_map(|_| run.advance().err()).expect("must diverge");
    assert!(matches!(failure, ExplicitError::Diverged { particle: 0, .. }), "{failure}");
    assert!(run.positions()[0].iter().all(|c| c.is_finite()));
    println!("{failure}");
    // Without any bound on the motion numbers overflow, and that is an error too.
    let boundless = StepControl::Fixed { step: 1e3, most: f64::INFINITY };
    let mut run = Explicit::new(vec![Vec3::x()], &[MASS], 0.0, Start::Published, boundless, spring).expect("usable");
    let failure = (0..1000).find_map(|_| run.advance().err()).expect("must diverge");
    assert!(matches!(failure, ExplicitError::Diverged { .. }));
    assert!(run.positions()[0].iter().all(|c| c.is_finite()));
    // An adaptive step saves the first, unless it may not become short enough.
    let control = |smallest| StepControl::Adaptive { first: 1.0, smallest, largest: 1.0, most: 0.5 };
    let make = |smallest| Explicit::new(vec![Vec3::x()], &[MASS], 0.0, Start::Published, control(smallest), spring);
    assert!(make(1e-6).expect("usable").run_until(1.0).is_ok());
    assert!(matches!(make(0.5).expect("usable").advance(), Err(ExplicitError::Diverged { .. })));
}

#[test]
fn what_cannot_move_is_an_error() {
    let fixed = StepControl::Fixed { step: 1e-3, most: 1.0 };
    let make = |masses: &[f64], damping, control| {
        Explicit::new(vec![Vec3::x()], masses, damping, Start::Published, control, spring).err()
    };
    assert!(matches!(make(&[], 0.0, fixed), Some(ExplicitError::Count { what: "masses", .. })));
    assert!(matches!(make(&[0.0], 0.0, fixed), Some(ExplicitError::Mass { particle: 0, .. })));
    assert!(matches!(make(&[f64::NAN], 0.0, fixed), Some(ExplicitError::Mass { .. })));
    assert!(matches!(make(&[1.0], -1.0, fixed), Some(ExplicitError::Damping(_))));
    let backwards = StepControl::Fixed { step: -1.0, most: 1.0 };
    assert!(matches!(make(&[1.0], 0.0, backwards), Some(ExplicitError::Control(_))));
    let undefined = Explicit::new(vec![Vec3::repeat(f64::NAN)], &[1.0], 0.0, Start::Published, fixed, spring);
    assert!(matches!(undefined.err(), Some(ExplicitError::BadStart { particle: 0 })));
    let (cloth, x) = slack();
    let held = explicit_cloth(&cloth, NOTHING, x, &[77], 0.0, fixed);
    assert!(matches!(held.err(), Some(ExplicitError::Count { found: 77, .. })));
}

#[test]
fn held_nodes_stay_and_the_last_step_ends_in_time() {
    let (cloth, x) = panel(60.0, 40.0, 10.0, SpringModel::Soft { stiffness: 50.0, bias: 0.3 });
    let control = StepControl::Adaptive { first: 1e-5, smallest: 1e-9, largest: 1e-2, most: 1e-3 };
    let forces = Forces { gravity: 1.0, ..NOTHING };
    let mut run = explicit_cloth(&cloth, forces, x.clone(), &[0, 3], 1e-5, control).expect("usable");
    run.run_until(0.05).expect("stable");
    assert!((run.time() - 0.05).abs() < 1e-12);
    assert!(run.positions()[0] == x[0] && run.positions()[3] == x[3]);
    assert!(run.positions().iter().zip(&x).any(|(a, b)| (a - b).norm() > 1e-4));
}

#[test]
fn explicit_and_implicit_steps_reach_the_same_equilibrium() {
    let (cloth, flat) = panel(60.0, 80.0, 10.0, SpringModel::Soft { stiffness: 20.0, bias: 0.3 });
    // Hung along its upper rim: taut everywhere, so that there is one equilibrium only.
    let rim: Vec<u32> = (0u32..).zip(&flat).filter(|(_, v)| v.y == 0.0).map(|(n, _)| n).collect();
    assert_eq!(rim.len(), 7);
    let contacts: Vec<Contact> = rim.iter().flat_map(|&n| pin(&cloth, n, flat[n as usize])).collect();
    let forces = Forces { gravity: 1.0, contacts: &contacts, ..NOTHING };
    let start: Vec<Vec3> = flat.iter().map(|v| v + Vec3::z() * (2e-3 * (60.0 * v.y).sin())).collect();

    let mut implicit = start.clone();
    let mut stepper = Stepper::new(&cloth, &[], &[]).expect("system");
    let still = vec![Vec3::zeros(); implicit.len()];
    let mut steps = 0;
    loop {
        let d = stepper.solve(&cloth, &implicit, &still, 0.05, &forces, 1).expect("step");
        implicit.iter_mut().zip(&d).for_each(|(x, d)| *x += d);
        steps += 1;
        if d.iter().map(Vec3::norm).fold(0.0, f64::max) < 1e-9 || steps == 20_000 {
            break;
        }
    }

    let control = StepControl::Adaptive { first: 1e-5, smallest: 1e-9, largest: 1e-2, most: 1e-3 };
    let mut explicit = explicit_cloth(&cloth, forces, start.clone(), &[], 1e-4, control).expect("usable");
    let settled = explicit.settle(Rest { force: 1e-9, speed: 1e-7 }, 400_000).expect("stable");
    let apart = explicit.positions().iter().zip(&implicit).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    let sag = implicit.iter().zip(&flat).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    println!(
        "{steps} implicit steps; explicit {settled:?}, {} undone, {:.2} s; {apart:.1e} m apart, sag {sag:.1e} m",
        explicit.undone(),
        explicit.time()
    );
    assert!(settled.converged && steps < 20_000);
    assert!(apart < 1e-5 && sag > 1e-4);
    let [a, b] = [explicit.positions(), &implicit].map(|x| energy(&cloth, x, &forces));
    assert!((a - b).abs() < 1e-6 * (energy(&cloth, &start, &forces) - b).abs());
}
