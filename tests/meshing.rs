//! Meshes of garments built by hand: every promise of `mesh::build` on every kind of piece and seam.

use std::collections::HashSet;

use proptest::prelude::*;
use toile::geometry::{Path, Topology, Vec2, Vec3};
use toile::mesh::{
    ClothMesh, MeshError, MeshMethod, MeshOptions, PieceMesh, SeamFault, SpringClass, Transfer, build, build_with,
    check,
};
use toile::pattern::{Edge, EdgeId, Garment, Give, Line, LineKind, Piece, Seam, SeamKind, Span};

const MM: f64 = 1e-3;

fn mm(x: f64, y: f64) -> Vec2 {
    Vec2::new(x, y) * MM
}

/// A closed ring of straight edges through corners in millimetres, named `e0`, `e1`, ….
fn polygon(corners: &[(f64, f64)]) -> Vec<Edge> {
    let n = corners.len();
    let at = |k: usize| mm(corners[k % n].0, corners[k % n].1);
    (0..n).map(|k| Edge { name: format!("e{k}"), path: Path::line(at(k), at(k + 1)), against: false }).collect()
}

/// A circle in two half edges, clockwise on screen, or the other way as a hole.
fn circle(x: f64, y: f64, r: f64, hole: bool) -> Vec<Edge> {
    let sweep = i32::from(!hole);
    let half = |from: f64, to: f64| {
        Path::parse(Vec2::new(from, y), &format!("A {r} {r} 0 0 {sweep} {to} {y}"), MM).expect("arc")
    };
    vec![
        Edge { name: "upper".into(), path: half(x - r, x + r), against: false },
        Edge { name: "lower".into(), path: half(x + r, x - r), against: false },
    ]
}

fn piece(name: &str, loops: Vec<Vec<Edge>>) -> Piece {
    Piece {
        name: name.into(),
        drawn_as: name.into(),
        side: None,
        fold: None,
        fabric: "shell".into(),
        layer: 0,
        beneath: 0,
        warp: Vec2::new(0.0, 1.0),
        loops,
        lines: Vec::new(),
        notches: Vec::new(),
        place: None,
    }
}

fn rectangle(name: &str, width: f64, height: f64) -> Piece {
    piece(name, vec![polygon(&[(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)])])
}

fn garment(pieces: Vec<Piece>, seams: Vec<Seam>) -> Garment {
    Garment {
        name: "test".into(),
        title: "Test".into(),
        body: None,
        pieces,
        seams,
        fabrics: Vec::new(),
        closures: Vec::new(),
        worn: Vec::new(),
        tests: Vec::new(),
    }
}

/// A span of edge `index` of a ring of `piece`, millimetres.
fn span(piece: usize, ring: usize, index: usize, from: f64, to: f64) -> Span {
    Span { edge: EdgeId { piece, ring, index }, from: from * MM, to: to * MM }
}

fn seam(name: &str, a: Vec<Span>, b: Vec<Span>) -> Seam {
    let length = |c: &[Span]| c.iter().map(Span::length).sum::<f64>();
    let marks = vec![(0.0, 0.0), (length(&a), length(&b))];
    Seam { name: name.into(), a, b, marks, give: Give::Even, stage: 0, kind: SeamKind::Written, closure: None }
}

/// Builds and checks; returns the mesh and its smallest angle in degrees.
fn meshed(garment: &Garment, spacing_mm: f64) -> (ClothMesh, f64) {
    let mesh = build(garment, spacing_mm * MM).expect("mesh");
    check(&mesh, garment).expect("promises kept");
    let smallest = mesh.pieces.iter().map(|p| p.smallest_angle.to_degrees()).fold(180.0, f64::min);
    (mesh, smallest)
}

/// Lengths of an edge's springs, millimetres.
fn springs(mesh: &ClothMesh, piece: usize, edge: usize) -> Vec<f64> {
    let particles = &mesh.pieces[piece].edges[edge].particles;
    particles.windows(2).map(|w| (mesh.flat[w[1] as usize] - mesh.flat[w[0] as usize]).norm() / MM).collect()
}

/// The ends of every spring, and which threads it pulls on.
fn classed(mesh: &ClothMesh) -> Vec<([u32; 2], SpringClass)> {
    let of_piece = |piece: &PieceMesh| {
        let warp = piece.warp;
        Topology::new(&mesh.triangles[piece.triangles.clone()]).edges.into_iter().map(move |edge| {
            let [a, b] = edge.ends.map(|v| mesh.flat[v as usize]);
            (edge.ends, SpringClass::of(b - a, warp))
        })
    };
    mesh.pieces.iter().flat_map(of_piece).collect()
}

/// Whether an edge has a particle at this many millimetres from its start.
fn has_particle_at(mesh: &ClothMesh, garment: &Garment, id: EdgeId, at: f64) -> bool {
    let path = &garment.pieces[id.piece].loops[id.ring][id.index].path;
    let edge = mesh.pieces[id.piece].edges.iter().find(|e| e.edge == id).expect("edge");
    edge.particles.iter().any(|&v| (mesh.flat[v as usize] - path.point(at * MM)).norm() < 1e-9)
}

#[test]
fn a_rectangle_is_a_perfect_grid() {
    let garment = garment(vec![rectangle("panel", 300.0, 204.0)], vec![]);
    let (mesh, smallest) = meshed(&garment, 10.0);
    assert_eq!(mesh.flat.len(), 31 * 21);
    assert_eq!(mesh.triangles.len(), 2 * 30 * 20);
    assert!(smallest > 44.0, "{smallest}");
    let springs = classed(&mesh);
    let count = |class| springs.iter().filter(|s| s.1 == class).count();
    assert_eq!((count(SpringClass::Warp), count(SpringClass::Weft), count(SpringClass::Bias)), (31 * 20, 30 * 21, 600));
    // Alternating diagonals: away from the rim a particle has four or eight springs.
    let mut valence = vec![0; mesh.flat.len()];
    springs.iter().flat_map(|s| s.0).for_each(|v| valence[v as usize] += 1);
    let inner = |p: &Vec2| p.x > 0.015 && p.x < 0.285 && p.y > 0.015 && p.y < 0.189;
    assert!(mesh.flat.iter().zip(&valence).all(|(p, &n)| !inner(p) || n == 4 || n == 8));
}

#[test]
fn the_grid_follows_the_grain() {
    let mut panel = rectangle("panel", 300.0, 300.0);
    panel.warp = Vec2::new(0.6, 0.8);
    let (mesh, smallest) = meshed(&garment(vec![panel], vec![]), 10.0);
    assert!(smallest > 28.0, "{smallest}");
    let springs = classed(&mesh);
    let share = |class| springs.iter().filter(|s| s.1 == class).count() as f64 / springs.len() as f64;
    assert!(share(SpringClass::Warp) > 0.28 && share(SpringClass::Weft) > 0.28);
}

#[test]
fn a_circle_with_a_hole_keeps_both_rims() {
    let ring = piece("skirt", vec![circle(0.0, 0.0, 200.0, false), circle(10.0, 0.0, 50.0, true)]);
    let (mesh, smallest) = meshed(&garment(vec![ring], vec![]), 10.0);
    assert!(smallest > 28.0, "{smallest}");
    assert_eq!(mesh.pieces[0].edges.len(), 4);
}

#[test]
fn inner_corners_mesh_well() {
    let bar = [(0.0, 0.0), (300.0, 0.0), (300.0, 85.0), (190.0, 85.0)];
    let stem = [(180.0, 300.0), (110.0, 300.0), (110.0, 85.0), (0.0, 85.0)];
    let (_, smallest) = meshed(&garment(vec![piece("t", vec![polygon(&[bar, stem].concat())])], vec![]), 10.0);
    assert!(smallest > 28.0, "{smallest}");
}

/// A panel with a dart 27 mm wide and 130 mm deep in its side; its legs are edges 2 and 3.
fn darted() -> Piece {
    let upper = [(0.0, 0.0), (255.0, 0.0), (245.0, 150.0), (115.0, 164.0)];
    let lower = [(240.0, 177.0), (225.0, 330.0), (0.0, 330.0)];
    piece("front", vec![polygon(&[&upper[..], &lower[..]].concat())])
}

#[test]
fn a_dart_is_stitched_to_its_tip() {
    let front = darted();
    let [upper, lower] = [2, 3].map(|k| front.loops[0][k].path.length() / MM);
    let legs = seam("dart", vec![span(0, 0, 2, 0.0, upper)], vec![span(0, 0, 3, lower, 0.0)]);
    let (mesh, smallest) = meshed(&garment(vec![front], vec![legs]), 10.0);
    assert!(smallest > 28.0, "{smallest}");
    let pairs = &mesh.seams[0].pairs;
    let tip = pairs[pairs.len() - 1];
    assert_eq!(tip[0], tip[1]);
    assert!((mesh.flat[tip[0] as usize] - mm(115.0, 164.0)).norm() < 1e-12);
    assert!(pairs[..pairs.len() - 1].iter().all(|[a, b]| a != b));
}

#[test]
fn a_fish_eye_dart_is_a_hole_with_two_tips() {
    let mut back = rectangle("back", 240.0, 400.0);
    back.loops.push(polygon(&[(100.0, 80.0), (90.0, 200.0), (100.0, 320.0), (110.0, 200.0)]));
    let leg = back.loops[1][0].path.length() / MM;
    let upper = seam("upper", vec![span(0, 1, 0, 0.0, leg)], vec![span(0, 1, 3, leg, 0.0)]);
    let lower = seam("lower", vec![span(0, 1, 1, 0.0, leg)], vec![span(0, 1, 2, leg, 0.0)]);
    let (mesh, smallest) = meshed(&garment(vec![back], vec![upper, lower]), 10.0);
    assert!(smallest > 28.0, "{smallest}");
    assert_eq!(mesh.seams[0].pairs[0][0], mesh.seams[0].pairs[0][1]);
    assert_eq!(mesh.seams[0].pairs.last(), mesh.seams[1].pairs.first());
}

#[test]
fn a_wedge_sewn_to_itself_has_no_spring_between_stitched_particles() {
    // A cone: both straight sides are one seam, 25° apart at the apex.
    let (x, y) = (400.0 * 12.5_f64.to_radians().sin(), 400.0 * 12.5_f64.to_radians().cos());
    let cone = piece("cone", vec![polygon(&[(0.0, 0.0), (x, y), (-x, y)])]);
    let legs = seam("side", vec![span(0, 0, 0, 0.0, 400.0)], vec![span(0, 0, 2, 400.0, 0.0)]);
    // `check` refuses inner springs between stitched particles.
    let (mesh, _) = meshed(&garment(vec![cone], vec![legs]), 10.0);
    assert_eq!(mesh.seams[0].pairs.len(), 41);
}

#[test]
fn a_gathered_seam_has_equal_counts() {
    let pieces = vec![rectangle("skirt", 600.0, 200.0), rectangle("yoke", 400.0, 150.0)];
    let gathers = seam("waist", vec![span(0, 0, 0, 0.0, 600.0)], vec![span(1, 0, 2, 400.0, 0.0)]);
    let (mesh, smallest) = meshed(&garment(pieces, vec![gathers]), 10.0);
    assert!(smallest > 26.0, "{smallest}");
    assert_eq!(mesh.seams[0].pairs.len(), 51);
    let (long, short) = (springs(&mesh, 0, 0), springs(&mesh, 1, 2));
    assert!(long.iter().all(|l| (l - 12.0).abs() < 1e-6) && short.iter().all(|l| (l - 8.0).abs() < 1e-6));
}

#[test]
fn marks_and_joints_travel_through_seams() {
    // Two panels sewn to a band that overlaps by 30 mm; the second panel also to a lining half as long.
    let pieces = vec![
        rectangle("left", 203.0, 300.0),
        rectangle("right", 262.0, 300.0),
        rectangle("band", 495.0, 60.0),
        rectangle("lining", 131.0, 300.0),
    ];
    let panels = vec![span(0, 0, 0, 0.0, 203.0), span(1, 0, 0, 0.0, 262.0)];
    let mut waist = seam("waist", panels, vec![span(2, 0, 2, 465.0, 0.0)]);
    waist.marks.insert(1, (303.0 * MM, 303.0 * MM));
    let lining = seam("lining", vec![span(3, 0, 0, 0.0, 131.0)], vec![span(1, 0, 0, 262.0, 0.0)]);
    let garment = garment(pieces, vec![waist, lining]);
    let (mesh, smallest) = meshed(&garment, 10.0);
    assert!(smallest > 25.0, "{smallest}");
    let band = EdgeId { piece: 2, ring: 0, index: 2 };
    for at in [465.0, 262.0, 162.0] {
        assert!(has_particle_at(&mesh, &garment, band, at), "band at {at}");
    }
    // The mark, 100 mm along the right panel, is 162 mm from its other end: 81 mm along the lining.
    assert!(has_particle_at(&mesh, &garment, EdgeId { piece: 3, ring: 0, index: 0 }, 81.0));
    // Both panels end on the same band particle: two pairs there.
    let pairs = &mesh.seams[0].pairs;
    assert_eq!(pairs.windows(2).filter(|w| w[0][1] == w[1][1]).count(), 1);
    // The band is meshed in columns: its free side has the particles of the sewn one.
    assert_eq!(mesh.pieces[2].edges[0].particles.len(), mesh.pieces[2].edges[2].particles.len());
}

/// Rectangles 90 mm high of these widths.
fn strips(widths: &[f64]) -> Vec<Piece> {
    widths.iter().enumerate().map(|(k, &w)| rectangle(&format!("p{k}"), w, 90.0)).collect()
}

#[test]
fn breakpoints_that_almost_coincide_are_one() {
    // The joints of the two chains are 4 micrometres apart.
    let widths = [100.0, 100.0, 100.004, 99.996];
    let top = |p: usize| span(p, 0, 0, 0.0, widths[p]);
    let side = seam("side", vec![top(0), top(1)], vec![top(2), top(3)]);
    let (mesh, smallest) = meshed(&garment(strips(&widths), vec![side]), 10.0);
    assert!(smallest > 40.0, "{smallest}");
    assert_eq!(mesh.seams[0].pairs.len(), 22);
}

#[test]
fn a_short_interval_makes_no_sliver() {
    // Two chains on the same edge; their joints lie 1.5 mm apart, far from its corners.
    let widths = [101.5, 98.5, 200.0, 100.0, 100.0];
    let top = |p: usize| span(p, 0, 0, 0.0, widths[p]);
    let whole = || vec![span(2, 0, 0, 200.0, 0.0)];
    let seams = vec![seam("one", vec![top(0), top(1)], whole()), seam("other", vec![top(3), top(4)], whole())];
    let (mesh, smallest) = meshed(&garment(strips(&widths), seams), 10.0);
    assert!(smallest > 20.0, "{smallest}");
    assert!(springs(&mesh, 2, 0).iter().any(|l| (l - 1.5).abs() < 1e-6));
}

#[test]
fn a_seam_may_join_an_edge_to_a_shifted_part_of_itself() {
    let layer = seam("layer", vec![span(0, 0, 0, 0.0, 300.0)], vec![span(0, 0, 0, 100.0, 400.0)]);
    let (mesh, _) = meshed(&garment(vec![rectangle("wrap", 400.0, 200.0)], vec![layer]), 10.0);
    assert_eq!(mesh.seams[0].pairs.len(), 31);
}

#[test]
fn an_endless_match_is_named() {
    // The edge is sewn round to itself, a tenth of a millimetre further with every turn.
    let a = vec![span(0, 0, 0, 0.0, 299.9), span(0, 0, 0, 299.9, 300.0)];
    let b = vec![span(0, 0, 0, 0.1, 300.0), span(0, 0, 0, 0.0, 0.1)];
    match build(&garment(vec![rectangle("ring", 300.0, 100.0)], vec![seam("twist", a, b)]), 0.01) {
        Err(MeshError::Endless { piece, edge, .. }) => assert_eq!((piece.as_str(), edge.as_str()), ("ring", "e0")),
        other => panic!("{:?}", other.err()),
    }
}

fn fold(name: &str, a: Vec2, b: Vec2) -> Line {
    Line { name: name.into(), path: Path::line(a, b), kind: LineKind::Fold(1.5) }
}

#[test]
fn fold_lines_are_chains_of_springs() {
    let mut panel = rectangle("panel", 300.0, 240.0);
    let stitch = Path::line(mm(5.0, 5.0), mm(90.0, 9.0));
    panel.lines = vec![
        fold("hem", mm(0.0, 203.0), mm(300.0, 203.0)),
        // Ends 0.4 mm short of the rim, and crosses the hem.
        fold("crease", mm(137.0, 0.4), mm(151.0, 239.6)),
        // Ends on the crease.
        fold("pleat", mm(40.0, 90.0), mm(142.3, 90.0)),
        Line { name: "stitch".into(), path: stitch, kind: LineKind::Mark("stitch".into()) },
    ];
    let (mesh, smallest) = meshed(&garment(vec![panel], vec![]), 10.0);
    assert!(smallest > 25.0, "{smallest}");
    let lines = &mesh.pieces[0].lines;
    assert_eq!(lines.len(), 3);
    let shared = |a: usize, b: usize| lines[a].particles.iter().filter(|v| lines[b].particles.contains(v)).count();
    assert_eq!((shared(0, 1), shared(1, 2), shared(0, 2)), (1, 1, 0));
    let rim: Vec<u32> = mesh.pieces[0].edges.iter().flat_map(|e| e.particles.clone()).collect();
    for line in &lines[..2] {
        let ends = [line.particles[0], line.particles[line.particles.len() - 1]];
        assert!(ends.iter().all(|v| rim.contains(v)), "{}", line.name);
    }
}

/// Elastic through these points, in millimetres.
fn elastic(points: &[(f64, f64)]) -> Line {
    let path = Path::polyline(&points.iter().map(|p| mm(p.0, p.1)).collect::<Vec<_>>());
    Line { name: "tape".into(), path, kind: LineKind::Elastic(0.7) }
}

/// Names of the parts of the lines of the first piece and their flat lengths, millimetres.
fn parts(mesh: &ClothMesh) -> Vec<(&str, f64)> {
    let length = |at: &[u32]| at.windows(2).map(|w| (mesh.flat[w[1] as usize] - mesh.flat[w[0] as usize]).norm()).sum();
    let round = |metres: f64| (metres * 1e4).round() / 10.0;
    mesh.pieces[0].lines.iter().map(|l| (l.name.as_str(), round(length(&l.particles)))).collect()
}

#[test]
fn a_line_along_edges_shares_their_particles() {
    let mut panel = rectangle("panel", 300.0, 240.0);
    // Up the right side against the edge, round the corner, back along the top and down into the piece.
    panel.lines = vec![elastic(&[(300.0, 120.0), (300.0, 0.3), (100.0, 0.3), (100.0, 150.0)])];
    let (mesh, _) = meshed(&garment(vec![panel], vec![]), 10.0);
    assert_eq!(parts(&mesh), [("tape.1", 320.0), ("tape.2", 150.0)]);
    let [along, across] = [0, 1].map(|k| mesh.pieces[0].lines[k].particles.as_slice());
    let rim: HashSet<u32> = mesh.pieces[0].edges.iter().flat_map(|e| e.particles.clone()).collect();
    assert!(along.iter().all(|v| rim.contains(v)) && across[1..].iter().all(|v| !rim.contains(v)));
    assert_eq!(along[along.len() - 1], across[0]);
    // All round a hole, from a place that is no corner of it.
    let mut ring = rectangle("ring", 300.0, 300.0);
    ring.loops.push(circle(150.0, 150.0, 60.0, true));
    let all_round = "M 150 90 A 60 60 0 0 0 150 210 A 60 60 0 0 0 150 90";
    let path = Path::parse_absolute(all_round, MM).expect("a circle");
    ring.lines = vec![Line { path, ..elastic(&[(0.0, 0.0), (1.0, 0.0)]) }];
    let (mesh, _) = meshed(&garment(vec![ring], vec![]), 10.0);
    let [line] = mesh.pieces[0].lines.as_slice() else { panic!("{:?}", mesh.pieces[0].lines) };
    let hole: HashSet<u32> =
        mesh.pieces[0].edges.iter().filter(|e| e.edge.ring == 1).flat_map(|e| e.particles.clone()).collect();
    assert_eq!(line.particles.iter().copied().collect::<HashSet<u32>>(), hole);
    assert_eq!(line.particles.len(), hole.len() + 1);
}

#[test]
fn a_line_goes_on_beyond_a_dart() {
    let dart = [(0.0, 0.0), (140.0, 0.0), (150.0, 80.0), (160.0, 0.0), (300.0, 0.0), (300.0, 240.0), (0.0, 240.0)];
    let cut_in_two = |y: f64| {
        let mut panel = piece("panel", vec![polygon(&dart)]);
        panel.lines = vec![elastic(&[(0.0, y), (300.0, y)])];
        let (mesh, _) = meshed(&garment(vec![panel], vec![]), 10.0);
        parts(&mesh).into_iter().map(|(name, length)| (name.to_owned(), length)).collect::<Vec<_>>()
    };
    // On the edge that the dart opens, and a quarter of the way to its tip.
    assert_eq!(cut_in_two(0.0), [("tape.1".to_owned(), 140.0), ("tape.2".to_owned(), 140.0)]);
    assert_eq!(cut_in_two(20.0), [("tape.1".to_owned(), 142.5), ("tape.2".to_owned(), 142.5)]);
}

#[test]
fn what_is_sewn_to_an_edge_with_elastic_is_drawn_in_with_it() {
    let mut skirt = rectangle("skirt", 300.0, 240.0);
    skirt.lines = vec![elastic(&[(0.0, 0.0), (300.0, 0.0)])];
    let band = rectangle("band", 300.0, 60.0);
    let waist = seam("waist", vec![span(0, 0, 0, 0.0, 300.0)], vec![span(1, 0, 2, 300.0, 0.0)]);
    let (mesh, _) = meshed(&garment(vec![skirt, band], vec![waist]), 10.0);
    let drawn = mesh.drawn_in();
    let along = |piece: usize, edge: usize| {
        let ends = mesh.pieces[piece].edges[edge].particles.windows(2).map(|w| [w[0].min(w[1]), w[0].max(w[1])]);
        ends.map(|ends| drawn.get(&ends).map(|d| (d.ratio, d.band))).collect::<Vec<_>>()
    };
    assert_eq!(along(0, 0), vec![Some((0.7, true)); 30]);
    assert_eq!(along(1, 2), vec![Some((0.7, false)); 30]);
    assert_eq!(drawn.len(), 60);
}

#[test]
fn a_line_outside_or_across_the_rim_is_named() {
    let with_line = |a: Vec2, b: Vec2| {
        let mut panel = rectangle("panel", 200.0, 200.0);
        panel.lines = vec![fold("fold", a, b)];
        build(&garment(vec![panel], vec![]), 0.01).map(|_| ()).expect_err("bad line").to_string()
    };
    assert_eq!(with_line(mm(250.0, 20.0), mm(250.0, 90.0)), "line 'fold' lies outside piece 'panel'");
    let across = with_line(mm(100.0, 100.0), mm(253.0, 111.0));
    assert!(across.contains("edge 'e1'") && across.contains("line 'fold'"), "{across}");
}

#[test]
fn a_band_has_straight_columns_and_its_fold_in_a_row() {
    let mut band = rectangle("waistband", 795.0, 70.0);
    band.warp = Vec2::new(1.0, 0.0);
    band.lines = vec![fold("fold", mm(0.0, 35.0), mm(795.0, 35.0))];
    let ring = seam("ring", vec![span(0, 0, 1, 0.0, 70.0)], vec![span(0, 0, 3, 70.0, 0.0)]);
    let waist = seam("waist", vec![span(1, 0, 0, 0.0, 700.0)], vec![span(0, 0, 2, 765.0, 0.0)]);
    let (mesh, smallest) = meshed(&garment(vec![band, rectangle("skirt", 700.0, 300.0)], vec![ring, waist]), 10.0);
    assert!(smallest > 35.0, "{smallest}");
    let (top, bottom) = (&mesh.pieces[0].edges[0].particles, &mesh.pieces[0].edges[2].particles);
    for (a, b) in top.iter().zip(bottom.iter().rev()) {
        assert!((mesh.flat[*a as usize].x - mesh.flat[*b as usize].x).abs() < 1e-9);
    }
    let fold = &mesh.pieces[0].lines[0].particles;
    assert_eq!(fold.len(), top.len());
    assert!(fold.iter().all(|&v| (mesh.flat[v as usize].y - 0.035).abs() < 1e-9));
}

#[test]
fn four_curved_sides_can_be_meshed_by_coons_interpolation() {
    let side = |name: &str, x: f64, y: f64, text: &str| Edge {
        name: name.into(),
        path: Path::parse(Vec2::new(x, y), text, MM).expect("path"),
        against: false,
    };
    let sides = vec![
        side("top", 0.0, 0.0, "C 60 30, 120 30, 200 0"),
        side("right", 200.0, 0.0, "C 230 60, 230 100, 260 180"),
        side("bottom", 260.0, 180.0, "C 180 200, 60 200, -30 170"),
        side("left", -30.0, 170.0, "L 0 0"),
    ];
    let garment = garment(vec![piece("gore", vec![sides])], vec![]);
    let mesh = build_with(&garment, &MeshOptions { spacing: 0.01, method: MeshMethod::Coons }).expect("mesh");
    check(&mesh, &garment).expect("promises kept");
    let edges = &mesh.pieces[0].edges;
    assert_eq!(edges[0].particles.len(), edges[2].particles.len());
    assert_eq!(mesh.flat.len(), edges[0].particles.len() * edges[1].particles.len());
    assert!(mesh.pieces[0].smallest_angle.to_degrees() > 30.0);
}

#[test]
fn corners_have_no_triangle_with_three_rim_particles() {
    let (mesh, _) = meshed(&garment(vec![rectangle("panel", 100.0, 80.0), darted()], vec![]), 10.0);
    let rim: Vec<u32> = mesh.pieces.iter().flat_map(|p| &p.edges).flat_map(|e| e.particles.clone()).collect();
    assert!(mesh.triangles.iter().all(|t| !t.iter().all(|v| rim.contains(v))));
}

#[test]
fn pieces_as_narrow_as_a_spring_is_long_mesh_well_and_can_bend() {
    for width in [16.0, 18.0, 20.0, 22.0] {
        let band = rectangle("band", 303.0, width);
        // Not one that is meshed in columns.
        let split = [(0.0, 0.0), (130.0, 0.0), (303.0, 0.0), (303.0, width), (90.0, width), (0.0, width)];
        let inner = 150.0 - width;
        let bent = [(0.0, 0.0), (150.0, 0.0), (150.0, 150.0), (inner, 150.0), (inner, width), (0.0, width)];
        for piece in [band, piece("split", vec![polygon(&split)]), piece("bent", vec![polygon(&bent)])] {
            let name = piece.name.clone();
            let (mesh, smallest) = meshed(&garment(vec![piece], vec![]), 16.0);
            assert!(smallest > 25.0, "{name} {width} mm wide: {smallest}");
            let mut on_rim: Vec<u32> = mesh.pieces[0].edges.iter().flat_map(|e| e.particles.clone()).collect();
            on_rim.sort_unstable();
            on_rim.dedup();
            assert!(mesh.flat.len() > on_rim.len(), "{name} {width} mm wide has no inner particle to bend round");
        }
    }
}

#[test]
fn a_narrow_piece_askew_to_the_grain_takes_no_more_than_its_cloth() {
    // The lattice of the box around it would have five thousand million points.
    let askew = |along: f64, across: f64| (0.5_f64.sqrt() * (along - across), 0.5_f64.sqrt() * (along + across));
    let corners = [(0.0, 0.0), (4e3, 0.0), (1e4, 0.0), (1e4, 0.3), (3e3, 0.3), (0.0, 0.3)];
    let strip = piece("strip", vec![polygon(&corners.map(|(along, across)| askew(along, across)))]);
    let cloth = garment(vec![strip], vec![]);
    let mesh = build_with(&cloth, &MeshOptions { spacing: 1e-4, method: MeshMethod::Grid }).expect("mesh");
    assert!((300_000..700_000).contains(&mesh.flat.len()), "{}", mesh.flat.len());
}

#[test]
fn a_piece_narrower_than_the_spacing_has_one_row_of_cells() {
    for (width, along) in [(18.0, 20.0), (7.0, 20.0), (3.0, 9.0)] {
        let mesh = build(&garment(vec![rectangle("binding", 600.0, width)], vec![]), 0.02).expect("mesh");
        let narrow = mesh.pieces[0].narrow.expect("a narrow piece");
        assert!((narrow.width * 1e3 - width).abs() < 1e-6 && (narrow.along * 1e3 - along).abs() < 1e-6, "{narrow:?}");
        let columns = (600.0 / along).round() as usize;
        assert_eq!((mesh.flat.len(), mesh.triangles.len()), (2 * (columns + 1), 2 * columns), "{width}");
    }
    let wide = build(&garment(vec![rectangle("band", 600.0, 20.0)], vec![]), 0.02).expect("mesh");
    assert_eq!(wide.pieces[0].narrow, None);
}

#[test]
fn what_is_sewn_to_a_narrow_piece_is_finer_along_that_seam_alone() {
    let (panel, tape) = (rectangle("panel", 300.0, 300.0), rectangle("tape", 300.0, 3.0));
    let alone = build(&garment(vec![panel.clone()], vec![]), 0.02).expect("mesh");
    let joined = seam("join", vec![span(0, 0, 0, 0.0, 300.0)], vec![span(1, 0, 0, 0.0, 300.0)]);
    let mesh = build(&garment(vec![panel, tape], vec![joined]), 0.02).expect("mesh");
    assert_eq!(mesh.seams[0].pairs.len(), 34, "300 mm in springs of 9 mm");
    let more = mesh.pieces[0].particles.len() as f64 / alone.flat.len() as f64;
    assert!(more < 1.2, "{more}");
    assert!(mesh.pieces[0].smallest_angle.to_degrees() > 20.0, "{}", mesh.pieces[0].smallest_angle.to_degrees());
}

#[test]
fn a_spacing_that_does_not_suit_is_explained() {
    let message = |p: Piece, spacing: f64| {
        build(&garment(vec![p], vec![]), spacing).map(|_| ()).expect_err("spacing").to_string()
    };
    assert_eq!(
        message(rectangle("patch", 60.0, 18.0), 0.02),
        "mesh size 20 mm is too large: even 'patch' is only 18 mm wide and 60 mm long; use 18 mm or less (6 mm for \
         three springs across), or check the file's units"
    );
    build(&garment(vec![rectangle("patch", 60.0, 18.0)], vec![]), 0.018).expect("the spacing that is named");
    let beside = garment(vec![rectangle("patch", 60.0, 18.0), rectangle("panel", 100.0, 20.0)], vec![]);
    assert!(build(&beside, 0.02).expect("mesh").pieces[0].narrow.is_some());
    for spacing in [0.0, -0.01, f64::NAN, f64::INFINITY] {
        assert!(message(rectangle("panel", 100.0, 100.0), spacing).starts_with("mesh size must be a positive length"));
    }
    let many = message(rectangle("panel", 1000.0, 1000.0), 1e-5);
    assert!(many.contains("limit 2000000") && many.contains("use >= 0.8 mm"), "{many}");
}

#[test]
fn bad_seams_are_explained() {
    let fault = |s: Seam| match build(&garment(vec![rectangle("panel", 100.0, 100.0)], vec![s]), 0.01) {
        Err(MeshError::Seam { fault, .. }) => fault,
        other => panic!("{:?}", other.err()),
    };
    let side = |to: f64| vec![span(0, 0, 1, 0.0, to)];
    let other = || vec![span(0, 0, 3, 0.0, 100.0)];
    let nowhere = fault(seam("s", side(100.0), vec![span(1, 0, 0, 0.0, 9.0)]));
    assert_eq!(nowhere, SeamFault::NoSuchEdge { piece: 1, ring: 0, index: 0 });
    assert!(matches!(fault(seam("s", side(120.0), other())), SeamFault::PastTheEnd { .. }));
    assert_eq!(fault(seam("s", side(0.0), other())), SeamFault::NoLength);
    let mut falling = seam("s", side(100.0), other());
    falling.marks.insert(1, (0.05, -0.01));
    assert!(matches!(fault(falling), SeamFault::Marks(..)));
}

#[test]
fn bad_outlines_are_explained() {
    let outline = |corners: &[(f64, f64)]| build(&garment(vec![piece("p", vec![polygon(corners)])], vec![]), 0.01);
    let counter = outline(&[(0.0, 0.0), (0.0, 100.0), (100.0, 100.0), (100.0, 0.0)]);
    assert!(matches!(counter, Err(MeshError::InsideOut { .. })), "{:?}", counter.err());
    let bow = outline(&[(0.0, 0.0), (200.0, 0.0), (40.0, 103.0), (200.0, 300.0), (0.0, 300.0), (97.0, 100.0)]);
    assert!(matches!(bow, Err(MeshError::Crossing { .. })), "{:?}", bow.err());
    let mut biased = rectangle("p", 100.0, 100.0);
    biased.warp = Vec2::zeros();
    assert!(matches!(build(&garment(vec![biased], vec![]), 0.01), Err(MeshError::Grain { .. })));
    let mut open = rectangle("p", 100.0, 100.0);
    open.loops[0][2].path = Path::line(mm(100.0, 100.0), mm(0.0, 99.0));
    assert!(matches!(build(&garment(vec![open], vec![]), 0.01), Err(MeshError::Open { .. })));
    assert!(matches!(build(&garment(vec![piece("p", vec![])], vec![]), 0.01), Err(MeshError::NoOutline { .. })));
}

#[test]
fn the_checker_sees_broken_meshes() {
    let front = darted();
    let [upper, lower] = [2, 3].map(|k| front.loops[0][k].path.length() / MM);
    let legs = seam("dart", vec![span(0, 0, 2, 0.0, upper)], vec![span(0, 0, 3, lower, 0.0)]);
    let garment = garment(vec![front], vec![legs]);
    let (good, _) = meshed(&garment, 10.0);
    let rim = good.pieces[0].edges[0].particles[3] as usize;
    let seen = |what: &str, spoil: &dyn Fn(&mut ClothMesh)| {
        let mut mesh = good.clone();
        spoil(&mut mesh);
        let message = check(&mesh, &garment).err().map(|e| e.to_string()).unwrap_or_default();
        assert!(message.contains(what), "{what}: {message}");
    };
    seen("not finite", &|m| m.flat[5].x = f64::NAN);
    seen("turned over", &|m| m.triangles[7].swap(0, 1));
    seen("off it", &|m| m.flat[rim].y -= 1e-7);
    seen("belongs to no triangle", &|m| {
        m.flat.push(Vec2::zeros());
        m.pieces[0].particles.end += 1;
    });
    seen("Euler", &|m| {
        m.triangles.remove(300);
        m.pieces[0].triangles.end -= 1;
    });
    seen("rims", &|m| m.pieces[0].edges[0].particles.swap(2, 3));
    seen("stitches", &|m| m.seams[0].pairs.truncate(9));
    seen("twice", &|m| {
        let pair = m.seams[0].pairs[4];
        m.seams[0].pairs.insert(4, pair);
    });
    seen("seams", &|m| m.seams.clear());
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let ring = piece("ring", vec![circle(0.0, 0.0, 120.0, false), circle(9.0, 4.0, 40.0, true)]);
    let garment = garment(vec![darted(), ring, rectangle("panel", 123.0, 145.0), darted()], vec![]);
    let bytes = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| format!("{:?}", build(&garment, 0.008).expect("mesh")))
    };
    let once = bytes(1);
    assert!(once == bytes(1) && once == bytes(4));
}

/// A closed smooth outline round the origin through points at these distances, as cubic Bézier curves (Catmull–Rom),
/// cut into edges.
fn smooth_outline(radii: &[f64], edges: usize) -> Vec<Edge> {
    let n = radii.len();
    let at = |k: usize| {
        let angle = std::f64::consts::TAU * (k % n) as f64 / n as f64;
        radii[k % n] * Vec2::new(angle.cos(), angle.sin())
    };
    let segment = |k: usize| {
        let handle = |k: usize| (at(k + 1) - at(k + n - 1)) / 6.0;
        let (c, d, e) = (at(k) + handle(k), at(k + 1) - handle(k + 1), at(k + 1));
        format!("C {} {} {} {} {} {} ", c.x, c.y, d.x, d.y, e.x, e.y)
    };
    let cuts: Vec<usize> = (0..=edges).map(|e| e * n / edges).collect();
    let edge = |(e, w): (usize, &[usize])| {
        let text: String = (w[0]..w[1]).map(segment).collect();
        Edge { name: format!("e{e}"), path: Path::parse(at(w[0]), &text, MM).expect("path"), against: false }
    };
    cuts.windows(2).enumerate().map(edge).collect()
}

/// Area inside the polygon of the first piece's rim.
fn polygon_area(mesh: &ClothMesh) -> f64 {
    let sides = mesh.pieces[0].edges.iter().flat_map(|e| e.particles.windows(2));
    0.5 * sides.map(|w| mesh.flat[w[0] as usize].perp(&mesh.flat[w[1] as usize])).sum::<f64>()
}

/// Panels over a yoke that a mark divides, the yoke's ends sewn to each other, a fold across it and a tuck in the first
/// panel. `shares` are in order: the yoke's height, both ends of the fold, the mark on both sides, the tuck.
fn tucked(widths: &[f64], shares: &[f64], gathered: f64) -> Garment {
    let total: f64 = widths.iter().sum();
    let (length, height) = (total / gathered, 60.0 + 90.0 * shares[0]);
    let mut pieces: Vec<Piece> = strips(widths);
    let yoke = pieces.len();
    pieces.push(rectangle("yoke", length, height));
    let ends = [mm(length * shares[1], 0.0), mm(length * shares[2], height)];
    pieces[yoke].lines = vec![fold("pleat", ends[0], ends[1])];
    let panels: Vec<Span> = widths.iter().enumerate().map(|(p, &w)| span(p, 0, 0, 0.0, w)).collect();
    let mut waist = seam("waist", panels, vec![span(yoke, 0, 2, length, 0.0)]);
    waist.marks.insert(1, (total * shares[3] * MM, length * (0.5 * shares[3] + 0.5 * shares[4]) * MM));
    let ring = seam("ring", vec![span(yoke, 0, 1, 0.0, height)], vec![span(yoke, 0, 3, height, 0.0)]);
    let part = widths[0] * shares[5];
    let tuck = seam("tuck", vec![span(0, 0, 1, 0.0, 90.0)], vec![span(0, 0, 0, 0.0, part)]);
    garment(pieces, vec![waist, ring, tuck])
}

#[test]
fn close_marks_stay_apart() {
    let widths = [61.431407578742586, 208.52853041183653, 248.0307994044857, 118.87191156000206];
    let shares = [0.03, 0.24994363243117232, 0.03, 0.17024978784148223, 0.8620921032165425, 0.8544532008468426];
    meshed(&tucked(&widths, &shares, 1.0), 6.0);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, ..ProptestConfig::default() })]

    #[test]
    fn smooth_outlines_mesh_well(
        radii in prop::collection::vec(90.0..160.0_f64, 8..14),
        edges in 1_usize..4,
        spacing in 5.0..18.0_f64,
        grain in 0.0..3.1_f64,
        hole in any::<bool>(),
    ) {
        let mut loops = vec![smooth_outline(&radii, edges)];
        if hole {
            loops.push(circle(5.0, -8.0, 30.0, true));
        }
        let mut p = piece("blob", loops);
        p.warp = Vec2::new(grain.cos(), grain.sin());
        let (_, smallest) = meshed(&garment(vec![p], vec![]), spacing);
        prop_assert!(smallest >= 20.0, "{smallest}");
    }

    #[test]
    fn cornered_outlines_mesh_well(
        apex in (-40.0..240.0_f64, -220.0..-90.0_f64),
        foot in (150.0..260.0_f64, 120.0..220.0_f64),
        spacing in 6.0..16.0_f64,
        grain in 0.0..3.1_f64,
    ) {
        let corners = [(0.0, 0.0), apex, (200.0, 0.0), foot, (20.0, 160.0)];
        let at = |k: usize| Vec2::new(corners[k % 5].0, corners[k % 5].1);
        let corner = |k: usize| (at(k + 1) - at(k)).angle(&(at(k + 4) - at(k))).to_degrees();
        prop_assume!((0..5).all(|k| corner(k) >= 30.0));
        let mut p = piece("kite", vec![polygon(&corners)]);
        p.warp = Vec2::new(grain.cos(), grain.sin());
        let (_, smallest) = meshed(&garment(vec![p], vec![]), spacing);
        prop_assert!(smallest >= 20.0, "{smallest}");
    }

    #[test]
    fn the_polygon_s_area_converges_in_the_second_order(radii in prop::collection::vec(100.0..150.0_f64, 8..12)) {
        let g = garment(vec![piece("blob", vec![smooth_outline(&radii, 2)])], vec![]);
        let area = 0.5 * g.pieces[0].loops[0].iter().map(|e| e.path.double_area()).sum::<f64>();
        let perimeter: f64 = g.pieces[0].loops[0].iter().map(|e| e.path.length()).sum();
        for spacing in [0.016, 0.008, 0.004] {
            let (mesh, _) = meshed(&g, spacing / MM);
            let error = (polygon_area(&mesh) - area).abs();
            // A chord h of a curve of radius r cuts off h³/12r; on average these bend with a radius above 25 mm.
            prop_assert!(error < perimeter * spacing * spacing / (12.0 * 0.025), "{error} at {spacing}");
        }
    }

    #[test]
    fn random_seams_and_folds_keep_every_promise(
        widths in prop::collection::vec(60.0..260.0_f64, 3..6),
        shares in prop::collection::vec(0.03..0.97_f64, 6),
        gathered in 1.0..1.6_f64,
        spacing in 6.0..15.0_f64,
    ) {
        let length = widths.iter().sum::<f64>() / gathered;
        let lean = length * (shares[1] - shares[2]) * MM;
        prop_assume!(lean.abs() < 0.15);
        meshed(&tucked(&widths, &shares, gathered), spacing);
    }
}

/// Pieces are filled side by side; of several that cannot be, the garment's first is named, however long it takes.
#[test]
fn of_several_mistakes_the_first_piece_is_named() {
    let lines = "lines: {a: {path: M 5 50 L 95 50, fold: 9}, b: {path: M 5 50 L 95 50, fold: 9}}";
    let small = "outline: {start: 0 0, t: L 100 0, r: L 100 100, b: L 0 100, l: L 0 0}";
    let mut text = String::from("garment: 1\nfree: [\"*\"]\npieces:\n");
    for k in 0..12 {
        let outline =
            if k == 0 { small.replace("100 100", "100 4000").replace("0 100,", "0 4000,") } else { small.into() };
        text += &format!("  p{k}: {{grain: [[0, 0], [0, 9]], {outline}, {lines}}}\n");
    }
    let garment = toile::io::garment::read_text("many", "many.yaml", &text).expect("a garment").garment;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(4).build().expect("threads");
    for _ in 0..20 {
        let error = pool.install(|| build(&garment, 0.004)).expect_err("lines on one another");
        assert!(matches!(&error, MeshError::Crossing { piece, .. } if piece == "p0"), "{error}");
    }
}

/// A linear map of the plane into space is carried over exactly, but for what coarse rims cut off of curves; rims stay
/// rims, and pieces apart.
#[test]
fn positions_are_carried_between_coarse_and_fine() {
    let disk = piece("disk", vec![circle(0.0, 0.0, 100.0, false), circle(20.0, 10.0, 30.0, true)]);
    let strip = piece("strip", vec![polygon(&[(0.0, 0.0), (300.0, 0.0), (300.0, 60.0), (0.0, 60.0)])]);
    let garment = garment(vec![disk, strip], vec![]);
    let (coarse, _) = meshed(&garment, 24.0);
    let (fine, _) = meshed(&garment, 9.0);
    let plane = |p: &Vec2| Vec3::new(p.x + 0.2 * p.y, 0.3 * p.x - p.y, 0.1 + 0.5 * p.x + 0.7 * p.y);
    for (from, to) in [(&coarse, &fine), (&fine, &coarse)] {
        let transfer = Transfer::new(from, to);
        let x: Vec<Vec3> = from.flat.iter().map(plane).collect();
        let rim: HashSet<u32> = to.pieces[0].edges.iter().flat_map(|e| e.particles.iter().copied()).collect();
        for (n, (got, p)) in transfer.apply(&x).iter().zip(&to.flat).enumerate() {
            // The sagitta of the hole's longest chord, as steep as the plane.
            let cut_off = if rim.contains(&(n as u32)) { 1.4 * 0.024_f64.powi(2) / (8.0 * 0.03) } else { 1e-12 };
            assert!((got - plane(p)).norm() <= cut_off, "particle {n}: {got} is not {}", plane(p));
        }
        // The pieces apart in space: none is mixed with the other.
        let apart: Vec<Vec3> = (0..from.flat.len())
            .map(|n| {
                Vec3::new(from.flat[n].x, from.flat[n].y, if from.pieces[1].particles.contains(&n) { 9.0 } else { 0.0 })
            })
            .collect();
        for (n, got) in transfer.apply(&apart).iter().enumerate() {
            let level = if to.pieces[1].particles.contains(&n) { 9.0 } else { 0.0 };
            assert!((got.z - level).abs() < 1e-12, "particle {n} is carried to another piece");
        }
    }
}
