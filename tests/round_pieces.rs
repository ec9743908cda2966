//! Pieces whose outline is one edge that comes back to its start: read, meshed, and sewn all round.

use std::f64::consts::{PI, TAU};

use toile::io::garment::{Refused, read_text};
use toile::mesh::{build, check};
use toile::pattern::{Garment, openings};

/// A disc of 300 mm about (300, 300), whose edge ends at `end`, and a window of 50 mm in a square that it could close.
fn disc(end: &str) -> String {
    format!(
        "garment: 1
pieces:
  disc:
    grain: [[300, 100], [300, 500]]
    outline: {{start: 0 300, rim: A 300 300 0 0 1 600 300 A 300 300 0 0 1 {end}}}
    notches: {{rim: [25%]}}
  patch:
    grain: [[50, 10], [50, 90]]
    outline: {{start: 0 50, rim: A 50 50 0 0 1 100 50 A 50 50 0 0 1 0 50}}
  square:
    grain: [[0, 0], [0, 9]]
    outline: {{start: 0 0, a: L 200 0, b: L 200 200, c: L 0 200, d: L 0 0}}
    holes: {{window: M 50 100 A 50 50 0 1 0 150 100 A 50 50 0 1 0 50 100 Z}}
seams:
  window: {{sew: patch.rim, to: square.window}}
free: [disc.rim, square.a, square.b, square.c, square.d]
"
    )
}

fn garment(text: &str) -> Garment {
    read_text("round", "round.yaml", text).unwrap_or_else(|e| panic!("{e}\n{text}")).garment
}

/// A disc of one edge, by arcs, by curves, and by numbers that miss its start by as much as is let pass.
#[test]
fn one_edge_may_go_all_the_way_round() {
    let measured = |rim: &str| {
        let text = format!(
            "garment: 1\nbody: woman_92\nfabrics: {{shell: cotton_poplin}}\npieces:\n  disc:\n    \
             place: {{at: [0, 1900, 0]}}\n    grain: [[0, -50], [0, 50]]\n    \
             outline: {{start: -100 0, rim: '{rim}'}}\nfree: ['*.*']\n"
        );
        let garment = garment(&text);
        let path = &garment.pieces[0].loops[0][0].path;
        assert_eq!(garment.pieces[0].loops[0].len(), 1);
        assert!((path.start() - path.end()).norm() < 1e-12, "{rim}");
        (path.length() * 1e3, path.double_area() * 0.5e6)
    };
    let [round, full] = [200.0 * PI, 1e4 * PI];
    for rim in [
        "A 100 100 0 0 1 100 0 A 100 100 0 0 1 -100 0",
        "A 100 100 0 0 1 100 0 A 100 100 0 0 1 -100 0.04",
        "C -100 -55.2285 -55.2285 -100 0 -100 C 55.2285 -100 100 -55.2285 100 0 C 100 55.2285 55.2285 100 0 100 \
         C -55.2285 100 -100 55.2285 -100 0",
        "C -100 -55.2285 -55.2285 -100 0 -100 C 55.2285 -100 100 -55.2285 100 0 C 100 55.2285 55.2285 100 0 100 \
         C -55.2285 100 -100 55.2285 -99.97 0.02",
    ] {
        let (length, area) = measured(rim);
        assert!(
            (length / round - 1.0).abs() < 1e-3 && (area / full - 1.0).abs() < 1e-3,
            "{rim}: {length} mm, {area} mm2"
        );
    }
    // One curve that comes back to where it began.
    let (length, area) = measured("C 100 -200 100 200 -100 0");
    assert!(length > 300.0 && area > 1e4, "{length} mm, {area} mm2");
}

/// Its chord has no direction: turning the edge about its start to close it made a point of it.
#[test]
fn an_edge_that_all_but_closes_stays_what_it_is() {
    for end in ["0 300", "0 300.000004", "-0.00001 300", "-0.04 300.02", "0 300.049"] {
        let garment = garment(&disc(end));
        let [edge] = garment.pieces[0].loops[0].as_slice() else { panic!("{end}: one edge") };
        assert!((edge.path.length() - 0.3 * TAU).abs() < 1e-4, "{end}: {}", edge.path.length());
        assert!((edge.path.double_area() / 2.0 - 0.09 * PI).abs() < 1e-4, "{end}: {}", edge.path.double_area());
        assert!((edge.path.end() - edge.path.start()).norm() < 1e-12, "{end}: {:?}", edge.path.end());
        let off = edge.path.sampled(1e-5).iter().map(|p| (p.x - 0.3).hypot(p.y - 0.3) - 0.3).fold(0.0, f64::max);
        assert!(off < 1e-4, "{end}: {off}");
    }
}

/// A keyhole of 5 mm in an edge of 300: turned and scaled as a whole to close 0.05 mm, its far end went 1.5 mm.
#[test]
fn an_edge_whose_ends_are_near_keeps_its_far_end() {
    let text = "garment: 1\npieces:\n  tag:\n    grain: [[0, 50], [0, 90]]\n    \
                outline: {start: 0 0, neck: L 5 0, \
                rim: L 5 20 L 40 20 L 40 140 L -35 140 L -35 20 L 0 20 L 0.03 0.03}\n\
                free: [tag.neck, tag.rim]\n";
    let garment = garment(text);
    let rim = &garment.pieces[0].loops[0][1].path;
    let far = rim.sampled(1e-5).iter().map(|p| p.y).fold(0.0, f64::max);
    assert!((far - 0.14).abs() < 1e-4, "{far}");
    assert!(rim.end().norm() < 1e-12);
}

/// A path may end a rounding off its start; the mesh wants rings that are closed.
#[test]
fn a_hole_that_all_but_closes_is_closed() {
    let text = disc("0 300").replace("0 50 100 Z}", "0 49.97 100.02}");
    assert!(text.contains("49.97"));
    let garment = garment(&text);
    let [edge] = garment.pieces[2].loops[1].as_slice() else { panic!("one edge") };
    assert!((edge.path.end() - edge.path.start()).norm() < 1e-12, "{:?}", edge.path.end());
    build(&garment, 0.01).expect("a mesh");
}

#[test]
fn a_round_piece_is_sampled_and_meshed_like_any_other() {
    let garment = garment(&disc("0 300.000004"));
    for spacing in [0.04, 0.01] {
        let mesh = build(&garment, spacing).expect("a mesh");
        check(&mesh, &garment).expect("promises kept");
        let rim = &mesh.pieces[0].edges[0].particles;
        assert_eq!(rim.first(), rim.last(), "the rim is closed");
        assert_eq!(rim.len() - 1, (0.3 * TAU / spacing).round() as usize);
        for w in rim.windows(2) {
            let [a, b] = [w[0], w[1]].map(|p| mesh.flat[p as usize]);
            assert!(((a - b).norm() / spacing - 1.0).abs() < 0.05, "springs of the rim are even");
        }
        let seam = garment.seams.iter().position(|s| s.name == "window").expect("a seam");
        assert!(!mesh.seams[seam].pairs.is_empty());
    }
    let mut rims: Vec<f64> = openings(&garment).iter().map(|o| o.length).collect();
    rims.sort_by(f64::total_cmp);
    assert_eq!(rims.len(), 2, "the square's own rim and the disc's: {rims:?}");
    assert!((rims[0] - 0.8).abs() < 1e-6 && (rims[1] - 0.3 * TAU).abs() < 1e-6, "{rims:?}");
}

#[test]
fn what_is_no_round_edge_is_refused_with_a_remedy() {
    let says = |from: &str, to: &str| {
        let text = disc("0 300").replace(from, to);
        let Err(Refused { diagnostics }) = read_text("round", "round.yaml", &text) else { panic!("accepted: {to}") };
        diagnostics.iter().map(|d| d.message.clone()).collect::<Vec<_>>().join("\n")
    };
    let one_arc = says("A 300 300 0 0 1 600 300 A 300 300 0 0 1 0 300}", "A 300 300 0 1 1 0 300}");
    assert!(one_arc.contains("an arc ends elsewhere than it starts, a circle takes two"), "{one_arc}");
    let open = says("0 0 1 0 300}", "0 0 1 3 300}");
    assert!(open.contains("outline of 'disc' does not close") && open.contains("3.0 mm from start"), "{open}");
    let folded = says("    notches: {rim: [25%]}", "    cut: fold rim");
    assert!(folded.contains("fold edge 'rim' is curved"), "{folded}");
}
