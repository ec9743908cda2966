//! Garments bent round a body by hand: where they are worn, and where they are said not to be.

use std::f64::consts::TAU;

use toile::geometry::{Vec2, Vec3};
use toile::io::garment::read_text;
use toile::mannequin::{Mannequin, PartKind, load};
use toile::mesh::{ClothMesh, build};
use toile::pattern::Garment;
use toile::report::{Bands, Fault, FaultKind, Measured, Report, measure, verdicts};
use toile::sew::Stitching;

/// A garment without tests, and its mesh.
struct Made {
    garment: Garment,
    mesh: ClothMesh,
    body: Mannequin,
}

impl Made {
    fn new(text: &str) -> Self {
        let text = format!("garment: 1\n{text}");
        let garment = read_text("made", "made.yaml", &text).unwrap_or_else(|e| panic!("{e}\n{text}")).garment;
        let mesh = build(&garment, 0.02).expect("a mesh");
        Self { garment, mesh, body: load("woman_92").expect("shipped") }
    }

    /// A tube of this circumference and height (mm), with something more said of its piece.
    fn tube(round: f64, tall: f64, more: &str) -> Self {
        let sides = format!("start: 0 0, top: L {round} 0, right: L {round} {tall}, hem: L 0 {tall}, left: L 0 0");
        Self::new(&format!(
            "pieces:\n  tube:\n    grain: [[9, 9], [9, 30]]\n    outline: {{{sides}}}\n{more}\
             seams: {{side: {{sew: tube.left, to: tube.right}}}}\nfree: [\"tube.*\"]\n"
        ))
    }

    fn positions(&self, at: impl Fn(&str, Vec2) -> Vec3) -> Vec<Vec3> {
        let piece = |p: usize| self.mesh.pieces.iter().find(|piece| piece.particles.contains(&p)).expect("a piece");
        self.mesh.flat.iter().enumerate().map(|(p, &flat)| at(&piece(p).name, flat)).collect()
    }

    /// Upright round `middle`, the top of it at that height.
    fn upright(&self, round: f64, middle: Vec3) -> Vec<Vec3> {
        let radius = 1e-3 * round / TAU;
        self.positions(|_, flat| {
            let turn = flat.x / radius;
            middle + Vec3::new(radius * turn.sin(), -flat.y, radius * turn.cos())
        })
    }

    fn report(&self, placed: Option<&[Vec3]>, sewn: Option<&[Vec3]>, draped: &[Vec3]) -> Report {
        let weld = Stitching::new(&self.mesh).class;
        measure(&Measured {
            garment: &self.garment,
            mesh: &self.mesh,
            weld: &weld,
            uncrossed: None,
            body: &self.body,
            fabric: "muslin",
            gaps: None,
            placed,
            sewn,
            draped: Some(draped),
            flattened: None,
            overlaps: None,
            pressed: None,
            gives: &[],
            bands: Bands::default(),
            stages: &[],
        })
    }

    /// Whether the garment, left so, is out of the bounds of one that says nothing.
    fn is_misworn(&self, report: &Report) -> bool {
        verdicts(&self.garment, report).iter().any(|v| !v.ok && v.bound == "openings not worn")
    }
}

/// The faults of a report, opening by opening.
fn kinds(report: &Report) -> Vec<Option<FaultKind>> {
    report.worn.iter().map(|w| w.fault.as_ref().map(|fault| fault.kind)).collect()
}

fn faults(report: &Report) -> Vec<Fault> {
    report.worn.iter().filter_map(|w| w.fault.clone()).collect()
}

/// Middle of the trunk at a height in metres, for a tube that goes up to there.
fn trunk(height: f64) -> Vec3 {
    Vec3::new(0.0, height, 0.01)
}

/// Middle of the left or the right leg at the knee.
fn knee(body: &Mannequin, kind: PartKind) -> Vec3 {
    let leg = body.part(kind).expect("a leg");
    leg.landmarks.iter().find(|(name, _)| name == "knee").expect("a knee").1
}

#[test]
fn a_tube_beside_a_leg_is_round_nothing() {
    let made = Made::tube(420.0, 120.0, "");
    let leg = knee(&made.body, PartKind::LeftLeg);
    let on = made.report(None, None, &made.upright(420.0, leg));
    assert!(kinds(&on) == [None, None] && !made.is_misworn(&on), "{:?}", on.worn);
    let beside = made.report(None, None, &made.upright(420.0, leg + Vec3::x() * 0.3));
    assert_eq!(kinds(&beside), [Some(FaultKind::Empty); 2]);
    assert!(made.is_misworn(&beside));
}

#[test]
fn a_slit_and_the_rim_of_an_open_piece_are_no_faults() {
    let slit = Made::tube(1100.0, 300.0, "    holes: {slit: M 300 80 L 302 80 L 302 240 L 300 240 Z}\n");
    let report = slit.report(None, None, &slit.upright(1100.0, trunk(1.0)));
    let empty: Vec<&str> = report.worn.iter().filter(|w| w.body_part.is_none()).map(|w| w.opening.as_str()).collect();
    assert!(empty == ["tube.slit"] && faults(&report).is_empty(), "{:?}", report.worn);
    let cape = Made::new(
        "pieces:\n  cape:\n    grain: [[9, 9], [9, 30]]\n    outline: {start: 0 0, top: L 600 0, right: L 600 400, \
         hem: L 0 400, left: L 0 0}\nseams: {}\nfree: [\"cape.*\"]\n",
    );
    let report = cape.report(None, None, &cape.upright(1000.0, trunk(1.3)));
    assert!(report.worn.len() == 1 && faults(&report).is_empty(), "{:?}", report.worn);
}

/// A sheet with two holes, one leg in one of them.
#[test]
fn an_empty_opening_whose_pair_is_worn_is_a_fault() {
    let hole = |x: f64| format!("M {} 100 L {} 100 L {} 300 L {} 300 Z", x, x + 200.0, x + 200.0, x);
    let made = Made::new(&format!(
        "pieces:\n  sheet:\n    grain: [[9, 9], [9, 30]]\n    outline: {{start: 0 0, top: L 700 0, right: L 700 400, \
         hem: L 0 400, left: L 0 0}}\n    holes: {{one: {}, other: {}}}\nseams: {{}}\nfree: [\"sheet.*\"]\n",
        hole(100.0),
        hole(400.0)
    ));
    let leg = knee(&made.body, PartKind::LeftLeg);
    // The sheet lies level, its hole `one` round the left leg, the other on the far side of it.
    let at = made.positions(|_, flat| leg + Vec3::new(flat.x - 0.2, 0.0, flat.y - 0.2));
    let report = made.report(None, None, &at);
    let [fault] = &faults(&report)[..] else { panic!("one fault: {:?}", report.worn) };
    assert!(fault.kind == FaultKind::Empty && fault.text.contains("the left leg through 'sheet.one'"), "{fault:?}");
}

#[test]
fn a_garment_that_goes_down_while_it_drapes_is_said_to_slide() {
    let made = Made::tube(1100.0, 200.0, "");
    let sewn = made.upright(1100.0, trunk(1.05));
    let fallen = |by: f64| made.report(None, Some(&sewn), &made.upright(1100.0, trunk(1.05 - by)));
    assert_eq!(kinds(&fallen(0.05)), [None, None]);
    let slid = fallen(0.12);
    let [fault] = &faults(&slid)[..] else { panic!("one fault: {:?}", slid.worn) };
    assert!(fault.kind == FaultKind::Slid && fault.text.contains("by 120 mm"), "{fault:?}");
    // Round the legs, below the crotch.
    let down = made.report(None, None, &made.upright(1100.0, trunk(0.6)));
    assert_eq!(kinds(&down), [Some(FaultKind::Slid); 2]);
}

#[test]
fn a_garment_that_ends_round_another_part_than_it_was_put_on_is_lost() {
    let made = Made::tube(1300.0, 100.0, "");
    let neck = made.upright(1300.0, Vec3::new(0.0, 1.45, 0.0));
    let hips = made.upright(1300.0, trunk(0.95));
    for report in [made.report(Some(&neck), None, &hips), made.report(None, Some(&neck), &hips)] {
        assert_eq!(kinds(&report), [Some(FaultKind::Lost); 2]);
        let fault = &faults(&report)[0];
        assert!(fault.text.contains("was round the neck") && fault.text.contains("is round the torso"), "{fault:?}");
    }
    assert!(faults(&made.report(Some(&hips), Some(&hips), &hips)).is_empty());
}

/// A band of two halves, of a pair, round one arm: a halter that hangs on a shoulder.
#[test]
fn one_arm_in_an_opening_that_is_the_same_on_both_sides_is_askew() {
    let made = Made::new(
        "pieces:\n  half:\n    cut: pair\n    drawn: R\n    grain: [[9, 9], [9, 30]]\n    outline: {start: 0 0, \
         top: L 300 0, side: L 300 60, hem: L 0 60, center: L 0 0}\nseams: {center: {sew: half.center, to: mirror}, \
         side: {sew: half.side, to: mirror}}\nfree: [half.top, half.hem]\n",
    );
    let round = |middle: Vec3| {
        made.positions(|name, flat| {
            let side = if name.ends_with('L') { 1.0 } else { -1.0 };
            let low = made.mesh.flat.iter().map(|p| p.x.abs()).fold(f64::INFINITY, f64::min);
            let turn = side * (flat.x.abs() - low) / (0.6 / TAU);
            middle + 0.6 / TAU * Vec3::new(turn.sin(), 0.0, turn.cos()) - Vec3::y() * flat.y
        })
    };
    let arm = made.body.part(PartKind::LeftArm).expect("an arm").sections[8].center;
    let on = made.report(None, None, &round(arm));
    assert_eq!(kinds(&on), [Some(FaultKind::Askew); 2], "{:?}", on.worn);
    let neck = made.report(None, None, &round(Vec3::new(0.0, 1.45, 0.0)));
    assert!(faults(&neck).is_empty(), "{:?}", neck.worn);
}

#[test]
fn what_is_placed_by_the_waist_or_the_hips_lies_there() {
    let at = |words: &str, height: f64| {
        let made = Made::tube(1100.0, 60.0, &format!("    place: {words}\n"));
        let report = made.report(None, None, &made.upright(1100.0, trunk(height)));
        faults(&report).into_iter().map(|fault| (fault.kind, fault.text)).collect::<Vec<_>>()
    };
    assert!(at("waist", 1.06).is_empty() && at("hip", 0.95).is_empty() && at("torso", 1.28).is_empty());
    let below = at("waist", 0.94);
    assert!(below.len() == 1 && below[0].0 == FaultKind::Level && below[0].1.contains("90 mm below it"), "{below:?}");
    let fallen = at("torso", 1.04);
    assert!(fallen.len() == 1 && fallen[0].1.contains("up to 10 mm above the waist"), "{fallen:?}");
    let above = at("hip", 1.2);
    assert!(above.len() == 1 && above[0].1.contains("170 mm above the waist"), "{above:?}");
}

/// What hangs from the neck may have a band that says waist at any height below it.
#[test]
fn a_band_of_what_hangs_from_the_neck_may_be_low() {
    let (round, tall) = (1100.0, 520.0);
    let tube = |name: &str, place: &str, tall: f64| {
        let sides = format!("start: 0 0, top: L {round} 0, right: L {round} {tall}, hem: L 0 {tall}, left: L 0 0");
        format!("  {name}:\n    grain: [[9, 9], [9, 30]]\n    place: {place}\n    outline: {{{sides}}}\n")
    };
    let made = Made::new(&format!(
        "pieces:\n{}{}seams:\n  side: {{sew: tube.left, to: tube.right}}\n  end: {{sew: band.left, to: band.right}}\n  \
         waist: {{sew: tube.hem, to: band.top}}\nfree: [tube.top, band.hem]\n",
        tube("tube", "torso", tall),
        tube("band", "waist", 60.0)
    ));
    let from = |top: f64| {
        let radius = 1e-3 * round / TAU;
        let x = made.positions(|name, flat| {
            let turn = flat.x / radius;
            let down = if name == "band" { 1e-3 * tall } else { 0.0 } + flat.y;
            trunk(top) + Vec3::new(radius * turn.sin(), -down, radius * turn.cos())
        });
        faults(&made.report(None, None, &x))
    };
    assert!(from(1.46).is_empty(), "{:?}", from(1.46));
    let round_the_trunk = from(1.2);
    assert!(round_the_trunk.len() == 1 && round_the_trunk[0].kind == FaultKind::Level, "{round_the_trunk:?}");
}

/// Shorts of one piece: a tube whose hem is sewn together in the middle, front to back.
#[test]
fn shorts_below_the_crotch_are_not_drawn_up() {
    let (round, tall) = (1100.0, 150.0);
    let made = Made::new(
        "pieces:\n  shorts:\n    grain: [[9, 9], [9, 30]]\n    outline: {start: 0 0, top: L 1100 0, right: L 1100 150, \
         front_right: L 1070 150, leg_right: L 580 150, back: L 550 150, middle: L 520 150, leg_left: L 30 150, \
         front_left: L 0 150, left: L 0 0}\n\
         seams:\n  front: {sew: shorts.left, to: shorts.right}\n  \
         crotch: {sew: [shorts.front_right, shorts.front_left], to: [shorts.back, shorts.middle]}\n\
         free: [shorts.top, shorts.leg_right, shorts.leg_left]\n",
    );
    let at = |top: f64| {
        let radius = 1e-3 * round / TAU;
        let x = made.positions(|_, flat| {
            let turn = flat.x / radius;
            let side = radius * turn.sin();
            // Towards the hem the middles of front and back come together.
            let pinched = 1.0 - flat.y / (1e-3 * tall) * (-(side / 0.03).powi(2)).exp();
            trunk(top) + Vec3::new(side, -flat.y, radius * turn.cos() * pinched)
        });
        made.report(None, None, &x)
    };
    let crotch = made.body.part(PartKind::Torso).expect("a torso").sections[0].center.y;
    let on = at(crotch + 0.06);
    assert!(faults(&on).is_empty() && !made.is_misworn(&on), "{:?}", on.worn);
    let below = at(crotch - 0.1);
    let [fault] = &faults(&below)[..] else { panic!("{:?}", below.worn) };
    assert!(fault.kind == FaultKind::Slid && fault.text.contains("not drawn up to the trunk"), "{fault:?}");
    assert!(made.is_misworn(&below));
}
