//! The fit of garments against fits that are known in advance.

use std::f64::consts::TAU;
use std::sync::Arc;

use toile::contact::Collider;
use toile::drape::{DrapeOptions, Draped, drape};
use toile::dynamics::Cut;
use toile::fabric::{Fabric, load};
use toile::geometry::{TriMesh, Vec3};
use toile::io::garment::read_text;
use toile::mannequin::{BodyPart, Mannequin, PartKind, Section};
use toile::mesh::{ClothMesh, build};
use toile::pattern::{Bound, Garment, Test};
use toile::report::{Bands, Fit, Measured, Report, measure, verdicts};
use toile::sew::Stitching;

/// Radius of the cylinder and height of the band's middle, metres.
const RADIUS: f64 = 0.1;
const MIDDLE: f64 = 0.5;
/// Width of the band, metres.
const WIDTH: f64 = 0.12;

/// An upright cylinder that counts as a trunk, with a waist at half its height.
fn cylinder() -> Mannequin {
    const SIDES: u32 = 360;
    let (low, high) = (0.0, 2.0 * MIDDLE);
    let mut mesh = TriMesh::default();
    for k in 0..SIDES {
        let (sine, cosine) = (TAU * f64::from(k) / f64::from(SIDES)).sin_cos();
        mesh.vertices.extend([low, high].map(|y| Vec3::new(RADIUS * sine, y, RADIUS * cosine)));
    }
    mesh.vertices.extend([low, high].map(|y| Vec3::new(0.0, y, 0.0)));
    for k in 0..SIDES {
        let (a, b) = (2 * k, 2 * ((k + 1) % SIDES));
        mesh.triangles.extend([[a, b, b + 1], [a, b + 1, a + 1], [2 * SIDES, b, a], [2 * SIDES + 1, a + 1, b + 1]]);
    }
    let section = |y: f64| Section {
        center: Vec3::new(0.0, y, 0.0),
        axis: Vec3::y(),
        half_width: RADIUS,
        half_depth: RADIUS,
        girth: TAU * RADIUS,
    };
    let torso = BodyPart {
        kind: PartKind::Torso,
        sections: [low, MIDDLE, high].map(section).to_vec(),
        landmarks: vec![("waist".into(), section(MIDDLE).center)],
    };
    // Two ends, so that an opening between them is worn.
    let end = |kind: PartKind, y: f64| BodyPart { kind, sections: vec![section(y)], landmarks: Vec::new() };
    let parts = vec![torso, end(PartKind::Neck, high + 0.05), end(PartKind::LeftLeg, low - 0.05)];
    Mannequin { name: "cylinder".into(), mesh, parts, frame: Default::default() }
}

/// A band in one piece, sewn to a tube, and what is needed to drape it.
struct Band {
    garment: Garment,
    mesh: ClothMesh,
    fabrics: Vec<Arc<Fabric>>,
    stitching: Stitching,
    body: Mannequin,
}

impl Band {
    /// A band that is `stretch` times as long on the cylinder as it was cut.
    fn new(fabric: &str, stretch: f64) -> Self {
        let (length, width) = (1e3 * TAU * RADIUS / stretch, 1e3 * WIDTH);
        let text = format!(
            "garment: 1\nname: Band\nfabrics: {{cloth: {fabric}}}\npieces:\n  band:\n    \
             grain: [[50, 20], [50, 100]]\n    \
             outline: {{start: 0 0, top: L {length} 0, right: L {length} {width}, bottom: L 0 {width}, left: L 0 0}}\n\
             seams:\n  back: {{sew: band.right, to: band.left}}\nfree: ['*.top', '*.bottom']\n"
        );
        let garment = read_text("band", "band.yaml", &text).unwrap_or_else(|e| panic!("{e}")).garment;
        let mesh = build(&garment, 0.005).expect("meshed");
        let stitching = Stitching::new(&mesh);
        let fabrics = vec![Arc::new(load(fabric).expect("shipped"))];
        Self { garment, mesh, fabrics, stitching, body: cylinder() }
    }

    /// Puts the band round the cylinder, half a millimetre off, and lets it come to rest.
    fn draped(&self) -> Draped {
        let length = self.mesh.flat.iter().map(|p| p.x).fold(0.0, f64::max);
        let place = |p: &toile::geometry::Vec2| {
            let (sine, cosine) = (TAU * p.x / length).sin_cos();
            let radius = RADIUS + 0.5e-3;
            Vec3::new(radius * sine, MIDDLE + 0.5 * WIDTH - p.y, radius * cosine)
        };
        let at: Vec<Vec3> = self.mesh.flat.iter().map(place).collect();
        let cut = Cut { garment: &self.garment, mesh: &self.mesh, fabrics: &self.fabrics };
        let collider = Collider::new(&self.body.mesh).expect("a surface");
        let nodes = self.stitching.welded(&at);
        let draped = drape(&cut, &collider, &self.stitching, nodes, &DrapeOptions::default(), &mut |_| {});
        let draped = draped.expect("draped");
        assert!(draped.converged);
        draped
    }

    fn report(&self, draped: &Draped) -> Report {
        let at = self.stitching.spread(&draped.nodes);
        measure(&Measured {
            garment: &self.garment,
            mesh: &self.mesh,
            weld: &self.stitching.class,
            uncrossed: None,
            body: &self.body,
            fabric: "cloth",
            gaps: None,
            placed: None,
            sewn: Some(&at),
            draped: Some(&at),
            flattened: None,
            overlaps: None,
            pressed: Some(&draped.body_forces[0]),
            gives: &[self.fabrics[0].emt()],
            bands: Bands::default(),
            stages: &[],
        })
    }

    fn fit(&self, draped: &Draped) -> Fit {
        self.report(draped).fit.expect("draped")
    }
}

#[test]
fn a_band_presses_with_its_tension_over_the_radius() {
    for (fabric, stretch) in [("jersey", 1.12), ("cotton_poplin", 1.012)] {
        let band = Band::new(fabric, stretch);
        let draped = band.draped();
        let fit = band.fit(&draped);
        let [waist] = &fit.girths[..] else { panic!("{:?}", fit.girths) };
        // The weft runs round the cylinder.
        let tension = band.fabrics[0].weft.load(waist.garment / waist.flat - 1.0);
        let radius = 1e-3 * waist.garment / TAU;
        let expected = 1e-3 * tension / radius;
        let found = waist.pressure.expect("draped");
        assert!((found.mean / expected - 1.0).abs() < 0.02, "{fabric}: {} kPa, T/R is {expected}", found.mean);
        assert!((found.max / expected - 1.0).abs() < 0.05, "{fabric}: at most {} kPa, T/R is {expected}", found.max);
        assert_eq!(waist.name, "waist");
        assert!((waist.ease - (waist.garment - waist.body)).abs() < 1e-3, "{waist:?}");
        // A tape round the cylinder and round the cloth, which lies less than a millimetre above it.
        assert!((waist.body - 1e3 * TAU * RADIUS).abs() < 1.0 && (0.0..6.3).contains(&waist.ease), "{waist:?}");
        assert!((waist.flat - 1e3 * TAU * RADIUS / stretch).abs() < 1.0, "{waist:?}");
    }
}

/// The band hangs by friction: all forces of the body together carry its weight. Those of one half balance the tension
/// where the halves meet, whose cloth is counted edge by edge.
#[test]
fn contact_forces_are_weight_and_tension() {
    let band = Band::new("jersey", 1.12);
    let draped = band.draped();
    let [normal, friction] = &draped.body_forces;
    let total: Vec3 = normal.iter().chain(friction).sum();
    let area: f64 = band.mesh.triangles.iter().map(|t| flat_area(&band.mesh, t)).sum();
    let weight = band.fabrics[0].areal_density * area * 9.806_65;
    assert!((total.y / weight - 1.0).abs() < 0.01, "{} N carry {weight} N", total.y);
    assert!(total.x.abs().max(total.z.abs()) < 0.01 * weight.max(1.0), "{total:?}");
    let outward: f64 =
        normal.iter().zip(&draped.nodes).map(|(f, p)| f.dot(&Vec3::new(p.x, 0.0, p.z).normalize())).sum();
    let waist = &band.fit(&draped).girths[0];
    let strain = waist.garment / waist.flat - 1.0;
    // Both rims have a hem of 10 mm: a second layer whose warp runs along the rim.
    let tension = band.fabrics[0].weft.load(strain) * WIDTH + band.fabrics[0].warp.load(strain) * 0.02;
    assert!((outward / (TAU * tension) - 1.0).abs() < 0.01, "{outward} N, {} N of tension", TAU * tension);
}

fn flat_area(mesh: &ClothMesh, triangle: &[u32; 3]) -> f64 {
    let [a, b, c] = triangle.map(|p| mesh.flat[p as usize]);
    0.5 * (b - a).perp(&(c - a)).abs()
}

#[test]
fn tests_of_a_garment_bound_its_fit() {
    let mut band = Band::new("jersey", 1.12);
    let report = band.report(&band.draped());
    let mut judged = |bound: Bound| -> Vec<(bool, String)> {
        band.garment.tests = vec![Test { bound, fabric: None, of: None }];
        let verdicts = verdicts(&band.garment, &report).into_iter().filter(|v| !v.bound.starts_with("openings"));
        verdicts.map(|verdict| (verdict.ok, verdict.to_string())).collect()
    };
    let mut ease = |girth: &str, from: Option<f64>, to: Option<f64>| {
        let verdicts = judged(Bound::Ease { girth: girth.into(), from, to });
        verdicts.into_iter().map(|(ok, _)| ok).collect::<Vec<bool>>()
    };
    assert_eq!(ease("waist", Some(0.0), Some(0.0063)), [true, true]);
    assert_eq!(ease("waist", Some(0.01), None), [false]);
    assert_eq!(ease("waist", None, Some(-0.01)), [false]);
    assert_eq!(ease("bust", Some(0.0), Some(1.0)), [false, false], "no cloth goes round a bust");
    assert!(judged(Bound::Pressure("waist".into(), 4.7)).iter().all(|(ok, _)| *ok));
    let pressed = judged(Bound::Pressure("waist".into(), 0.01));
    assert!(matches!(&pressed[..], [(false, text)] if text.contains("kPa (limit 0.01 kPa) at waist")), "{pressed:?}");
    assert_eq!(judged(Bound::HemLevel(0.005)).len(), 1);
    assert!(judged(Bound::HemLevel(0.005))[0].0);
    assert!(!judged(Bound::HemLevel(0.0))[0].0);
}
