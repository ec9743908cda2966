//! Lines across triangles: straight cuts, even darts, gores, drawn lines; and what else is asked of a surface.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may fail so")]

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::path::Path;

use toile::flatten::line::{SurfacePoint, Web, length, plane_section, straightened};
use toile::flatten::{Solid, disk_cuts, shortest_path};
use toile::geometry::{TriMesh, Vec3};
use toile::input::LengthUnit;
use toile::io::obj_read::ObjFaces;
use toile::pipeline::{Cuts, Darts, Ease, FlatSurface, Limit, SurfaceOptions, flatten_faces};

/// Radius of the hemisphere, mm.
const RADIUS: f64 = 140.0;

/// A number between −1 and 1 that looks random.
fn jitter(k: u32) -> f64 {
    f64::from(k.wrapping_mul(2_654_435_761) >> 8) / f64::from(1u32 << 23) - 1.0
}

/// A grid of `n` × `m` quads, each two triangles, over the unit square, its inner points moved by up to `off` of a
/// cell and lifted.
fn grid(n: u32, m: u32, off: f64, lift: impl Fn(f64, f64) -> Vec3) -> TriMesh {
    let mut mesh = TriMesh::default();
    for (j, i) in (0..=m).flat_map(|j| (0..=n).map(move |i| (j, i))) {
        let k = 2 * mesh.vertices.len() as u32;
        let inside = i > 0 && i < n && j > 0 && j < m;
        let by = |k: u32| if inside { off * jitter(k) } else { 0.0 };
        mesh.vertices.push(lift((f64::from(i) + by(k)) / f64::from(n), (f64::from(j) + by(k + 1)) / f64::from(m)));
    }
    for (j, i) in (0..m).flat_map(|j| (0..n).map(move |i| (j, i))) {
        let a = j * (n + 1) + i;
        mesh.triangles.extend([[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]);
    }
    mesh
}

/// A hemisphere of [`RADIUS`] mm, its pole up: rings of `columns` vertices, turned by a bit from ring to ring where it
/// is `twisted`, so that no meridian runs along edges.
fn hemisphere(rows: u32, columns: u32, twisted: bool) -> TriMesh {
    let mut mesh = TriMesh { vertices: vec![Vec3::new(0.0, RADIUS, 0.0)], triangles: Vec::new() };
    let turn = |row: u32| if twisted { 0.37 * f64::from(row) } else { 0.0 };
    for row in 1..=rows {
        let down = FRAC_PI_2 * f64::from(row) / f64::from(rows);
        for column in 0..columns {
            let round = TAU * (f64::from(column) + turn(row)) / f64::from(columns);
            let [x, z] = [round.sin(), round.cos()].map(|c| RADIUS * down.sin() * c);
            mesh.vertices.push(Vec3::new(x, RADIUS * down.cos(), z));
        }
    }
    let at = |row: u32, column: u32| 1 + (row - 1) * columns + column % columns;
    for column in 0..columns {
        mesh.triangles.push([0, at(1, column), at(1, column + 1)]);
        for row in 1..rows {
            let [a, b, c, d] = [at(row, column), at(row + 1, column), at(row + 1, column + 1), at(row, column + 1)];
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh
}

fn faces(mesh: &TriMesh) -> ObjFaces {
    let count = mesh.triangles.len();
    ObjFaces {
        vertices: mesh.vertices.clone(),
        faces: mesh.triangles.iter().map(|t| t.to_vec()).collect(),
        texture: Vec::new(),
        texture_of_face: vec![Vec::new(); count],
        groups: vec!["cloth".to_owned()],
        group_of_face: vec![0; count],
    }
}

fn options() -> SurfaceOptions {
    SurfaceOptions { unit: Some(LengthUnit::Millimetre), up: Some(Vec3::y()), ..SurfaceOptions::default() }
}

fn laid(mesh: &TriMesh, options: &SurfaceOptions) -> FlatSurface {
    flatten_faces(Path::new("cloth"), faces(mesh), options).expect("laid flat")
}

fn text(flat: &FlatSurface, file: &str) -> String {
    let files = flat.results().expect("files");
    String::from_utf8(files.into_iter().find(|f| f.0 == file).expect("a file").1).expect("text")
}

/// The vertices of `flat.obj`.
fn places(flat: &FlatSurface) -> Vec<Vec3> {
    let text = text(flat, "flat.obj");
    let numbers = |line: &str| line.split(' ').map(|n| n.parse::<f64>().expect("a number")).collect::<Vec<_>>();
    text.lines().filter_map(|l| l.strip_prefix("v ")).map(|l| Vec3::from_vec(numbers(l))).collect()
}

#[test]
fn a_straight_line_on_what_unrolls_is_that_of_the_plane() {
    // A sheet of 300 × 200 mm, bent to the edges of a prism, which unrolls exactly.
    let prism = |u: f64, v: f64| {
        let (sides, radius) = (10.0, 300.0 / (2.0 * 10.0 * (PI / 20.0).sin()));
        let (side, share) = ((u * sides).floor().min(sides - 1.0), u * sides - (u * sides).floor().min(sides - 1.0));
        let corner = |k: f64| Vec3::new(radius * (PI * k / sides).cos(), 0.0, radius * (PI * k / sides).sin());
        corner(side).lerp(&corner(side + 1.0), share) + Vec3::y() * (200.0 * v)
    };
    // Its columns lie on the edges of the prism; along them the points are moved.
    let mesh = grid(20, 15, 0.0, prism);
    let web = Web::new(&mesh);
    for (from, to, across) in [(0, 16 * 21 - 1, [300.0f64, 200.0]), (5, 14 * 21 + 18, [195.0, 200.0 * 14.0 / 15.0])] {
        let chain = shortest_path(&mesh, &Solid::new(), from, to).expect("a way");
        let line = straightened(&mesh, &web, &chain);
        let expected = across[0].hypot(across[1]);
        let found = length(&mesh, &line);
        assert!((found - expected).abs() < 1e-9 * expected, "{found} {expected}");
    }
    // Cut along it, the sheet is two pieces of exactly these areas, with straight legs of exactly this length.
    let cut = Cuts { paths: vec![vec![1, 16 * 21]], ..Cuts::default() };
    let flat = laid(&mesh, &SurfaceOptions { cuts: cut, ..options() });
    assert_eq!(flat.report.pieces.len(), 2);
    for piece in &flat.report.pieces {
        assert!((piece.area_flattened - 30_000.0).abs() < 1e-2, "{}", piece.area_flattened);
        let leg = piece.edges.iter().find(|e| e.sewn_to.is_some()).expect("a leg");
        assert!((leg.length_flattened - 300f64.hypot(200.0)).abs() < 1e-4, "{}", leg.length_flattened);
    }
}

#[test]
fn a_plane_cuts_a_sphere_in_a_great_circle() {
    let mesh = hemisphere(20, 60, true);
    let web = Web::new(&mesh);
    for k in 0..7 {
        let toward = Vec3::new((0.9 * f64::from(k)).cos(), 0.0, (0.9 * f64::from(k)).sin());
        let normal = toward.cross(&Vec3::y());
        let line = plane_section(&mesh, &web, normal, 0, toward, None).expect("a line");
        let off = line.iter().map(|spot| spot.place(&mesh).dot(&normal).abs()).fold(0.0, f64::max);
        assert!(off <= 0.25, "{off} mm beside the plane");
        let quarter = length(&mesh, &line) / (FRAC_PI_2 * RADIUS);
        assert!((0.998..1.0).contains(&quarter), "{quarter}");
        assert!(line.iter().filter(|spot| matches!(spot, SurfacePoint::Edge { .. })).count() > 20);
    }
}

/// The cuts of a flat hemisphere: how far beside their meridians they run at most, and their lengths, mm.
fn meridians(flat: &FlatSurface) -> (f64, Vec<f64>) {
    let places = places(flat);
    let mut off: f64 = 0.0;
    for chain in &flat.report.cuts {
        let at = |k: u32| places[k as usize - 1];
        let end = if at(chain[0]).y < 1.0 { at(chain[0]) } else { at(*chain.last().expect("an end")) };
        let normal = Vec3::y().cross(&end).normalize();
        off = chain.iter().map(|&k| at(k).dot(&normal).abs()).fold(off, f64::max);
    }
    (off, flat.report.cuts_made.iter().map(|made| made.length).collect())
}

fn spread(lengths: &[f64]) -> f64 {
    lengths.iter().fold(0.0, |most: f64, l| most.max(*l))
        - lengths.iter().fold(f64::INFINITY, |least: f64, l| least.min(*l))
}

/// The strain with which a gore of a ball, one of `count`, can be laid flat. A line parallel to its middle in distance
/// t is cos(t/R) times as long as that, and t is πR/count at the equator. The map that keeps all distances from the
/// middle and along it stretches by 1/cos(π/count) − 1 there and nowhere more.
fn strain_of_gores(count: usize) -> f64 {
    1.0 / (PI / count as f64).cos() - 1.0
}

#[test]
fn a_hemisphere_is_cut_into_even_gores() {
    for twisted in [false, true] {
        let mesh = hemisphere(20, 48, twisted);
        let mut of_fewer = f64::INFINITY;
        for count in [4, 6, 8] {
            let flat = laid(&mesh, &SurfaceOptions { gores: Some(count), ..options() });
            assert_eq!(flat.report.pieces.len(), count);
            let (off, lengths) = meridians(&flat);
            assert!(off <= 0.26, "{off} mm beside the meridian");
            assert!(lengths.len() == count && spread(&lengths) < 0.3, "{lengths:?}");
            let strain = flat.report.pieces.iter().map(|p| p.strain.p99).fold(0.0, f64::max);
            let most = strain_of_gores(count).min(of_fewer);
            assert!(strain > 0.0 && strain < most, "{count}: {strain} of {most}");
            of_fewer = strain;
            for edge in flat.report.pieces.iter().flat_map(|p| &p.edges).filter(|e| e.sewn_to.is_some()) {
                assert!((edge.length_flattened - edge.length_draped).abs() < 0.01, "{edge:?}");
            }
        }
    }
}

#[test]
fn a_hemisphere_gets_even_darts_that_point_at_its_pole() {
    for twisted in [false, true] {
        let mesh = hemisphere(16, 48, twisted);
        for (count, most) in [(4, 0.2), (6, 0.1), (8, 0.065)] {
            let flat = laid(&mesh, &SurfaceOptions { darts: Some(Darts::Count(count)), ..options() });
            let piece = &flat.report.pieces[0];
            assert_eq!((flat.report.pieces.len(), piece.darts, piece.overlaps, piece.flips), (1, count, 0, 0));
            assert!(piece.strain.p99 < most, "{count} darts: {}", piece.strain.p99);
            let (off, lengths) = meridians(&flat);
            assert!(off <= 0.26 && lengths.len() == count, "{off} mm beside the meridian");
            assert!(spread(&lengths) < 1.0, "{lengths:?}");
            let first = flat.report.cuts_made[0].strain.expect("what it bought");
            assert!(first[1] < first[0] && (first[1] - piece.strain.p99).abs() < 1e-12);
        }
    }
}

#[test]
fn a_ball_and_a_tube_are_cut_into_panels() {
    let half = hemisphere(12, 24, false);
    let mut ball = half.clone();
    let rim = 1 + 11 * 24;
    let below: Vec<u32> =
        (0..half.vertices.len() as u32).map(|v| if v < rim { v + half.vertices.len() as u32 } else { v }).collect();
    ball.vertices.extend(half.vertices[..rim as usize].iter().map(|p| Vec3::new(p.x, -p.y, p.z)));
    ball.triangles.extend(half.triangles.iter().map(|&[a, b, c]| [a, c, b].map(|v| below[v as usize])));
    let flat = laid(&ball, &SurfaceOptions { gores: Some(6), ..options() });
    assert_eq!(flat.report.pieces.len(), 6);
    let areas: Vec<f64> = flat.report.pieces.iter().map(|p| p.area_flattened).collect();
    assert!(spread(&areas) < 1e-3 * areas[0], "{areas:?}");
    // A tube of 30 sides, cut where no edge of the mesh lies.
    let tube = grid(30, 10, 0.0, |u, v| {
        let round = TAU * u;
        Vec3::new(80.0 * round.cos(), 300.0 * v, 80.0 * round.sin())
    });
    let flat = laid(&tube, &SurfaceOptions { gores: Some(4), weld: toile::pipeline::Weld::Within(1e-6), ..options() });
    assert_eq!(flat.report.pieces.len(), 4);
    let round = 30.0 * 2.0 * 80.0 * (PI / 30.0).sin();
    for piece in &flat.report.pieces {
        assert!((piece.area_flattened - round * 300.0 / 4.0).abs() < 0.05, "{}", piece.area_flattened);
    }
}

#[test]
fn what_lies_flat_as_it_is_gets_no_gores() {
    // A round hat: a hemisphere, and round its rim a brim 60 mm wide, level, in one mesh.
    let (columns, brim) = (48, 3);
    let mut hat = hemisphere(16, columns, false);
    let rim = hat.vertices.len() as u32 - columns;
    for row in 1..=brim {
        for column in 0..columns {
            let out = 1.0 + 20.0 * f64::from(row) / RADIUS;
            let p = hat.vertices[(rim + column) as usize];
            hat.vertices.push(Vec3::new(p.x * out, p.y, p.z * out));
        }
    }
    let at = |row: u32, column: u32| rim + row * columns + column % columns;
    for (row, column) in (0..brim).flat_map(|row| (0..columns).map(move |column| (row, column))) {
        let [a, b, c, d] = [at(row, column), at(row + 1, column), at(row + 1, column + 1), at(row, column + 1)];
        hat.triangles.extend([[a, b, c], [a, c, d]]);
    }
    let flat = laid(&hat, &SurfaceOptions { gores: Some(6), ..options() });
    assert_eq!(flat.report.pieces.len(), 7);
    let largest = flat.report.pieces.iter().max_by(|a, b| a.area_flattened.total_cmp(&b.area_flattened)).unwrap();
    let inside = |radius: f64| 0.5 * f64::from(columns) * radius * radius * (TAU / f64::from(columns)).sin();
    let ring = inside(RADIUS + 60.0) - inside(RADIUS);
    assert!((largest.area_flattened / ring - 1.0).abs() < 1e-6 && largest.strain.p99 < 1e-6, "{largest:?}");
    assert!(flat.notes.iter().any(|note| note.contains("lies flat as it is")), "{:?}", flat.notes);
    // A level disk alone stays one piece.
    let disk = grid(8, 8, 0.0, |u, v| Vec3::new(200.0 * u, 200.0 * v, 0.0));
    assert_eq!(laid(&disk, &SurfaceOptions { gores: Some(6), ..options() }).report.pieces.len(), 1);
}

#[test]
fn of_equally_short_cuts_the_same_is_chosen_every_time() {
    // A torus: round it every way is as short as the next.
    let (n, m) = (24, 12);
    let at = |i: u32, j: u32| i % n * m + j % m;
    let place = |i: u32, j: u32| {
        let [round, tube] = [f64::from(i) / f64::from(n), f64::from(j) / f64::from(m)].map(|share| TAU * share);
        let out = 0.3 + 0.1 * tube.cos();
        Vec3::new(out * round.cos(), 0.1 * tube.sin(), out * round.sin())
    };
    let cells = || (0..n).flat_map(|i| (0..m).map(move |j| (i, j)));
    let vertices = cells().map(|(i, j)| place(i, j)).collect();
    let halves = |(i, j): (u32, u32)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    let torus = TriMesh { vertices, triangles: cells().flat_map(halves).collect() };
    let first = disk_cuts(&torus, &Solid::new());
    assert!((0..10).all(|_| disk_cuts(&torus, &Solid::new()) == first));
}

#[test]
fn a_drawn_line_is_cut() {
    let folder = tempfile::tempdir().expect("a folder");
    let mesh = grid(13, 11, 0.3, |u, v| Vec3::new(200.0 * u, 150.0 * v, 0.0));
    let cut = |name: &str, text: &str| {
        let file = folder.path().join(name);
        std::fs::write(&file, text).expect("written");
        laid(&mesh, &SurfaceOptions { cuts: Cuts { files: vec![file], ..Cuts::default() }, ..options() })
    };
    // Drawn 3 mm above the sheet and beyond its rim, with a corner inside.
    let flat = cut("line.obj", "v 40 -5 3\nv 40 80 3\nv 205 80 3\nl 1 2 3\n");
    let mut areas: Vec<f64> = flat.report.pieces.iter().map(|p| p.area_flattened).collect();
    areas.sort_by(f64::total_cmp);
    assert!(areas.len() == 2 && (areas[0] - 160.0 * 80.0).abs() < 160.0 * 0.5, "{areas:?}");
    assert!((areas.iter().sum::<f64>() - 30_000.0).abs() < 1e-3);
    let flat = cut("points.txt", "60 0 0\n60 100 0\n");
    assert_eq!(flat.report.pieces.len(), 1);
    assert!((flat.report.cuts_made[0].length - 100.0).abs() < 0.01, "{:?}", flat.report.cuts_made);
}

#[test]
fn pieces_are_cut_with_ease() {
    let mesh = grid(4, 4, 0.0, |u, v| Vec3::new(100.0 * u, 200.0 * v, 0.0));
    let flat = laid(&mesh, &SurfaceOptions { ease: Ease { warp: -0.1, weft: -0.2 }, ..options() });
    let (piece, ease) = (&flat.report.pieces[0], flat.report.ease.expect("ease"));
    assert!((piece.area_flattened - 20_000.0).abs() < 1e-3 && (piece.area_cut - 14_400.0).abs() < 1e-3);
    assert!((piece.boundary_cut - 2.0 * (80.0 + 180.0)).abs() < 1e-4, "{}", piece.boundary_cut);
    assert!((ease.stretch_warp - 1.0 / 9.0).abs() < 1e-12 && (ease.stretch_weft - 0.25).abs() < 1e-12);
    assert!(piece.strain.p99 < 1e-6);
}

#[test]
fn a_fine_mesh_is_simplified_within_its_bound() {
    let mesh = hemisphere(60, 160, true);
    let fine = laid(&mesh, &options());
    let flat = laid(&mesh, &SurfaceOptions { simplify: Some(5e-4), ..options() });
    let (few, many) = (flat.report.pieces[0].triangles, fine.report.pieces[0].triangles);
    assert!(few < many / 5, "{few} of {many}");
    let said = flat.notes.iter().find(|note| note.contains("simplified")).expect("a note");
    let error: f64 =
        said.split("further than ").nth(1).and_then(|t| t.split(' ').next()).expect("mm").parse().expect("mm");
    assert!(error > 0.0 && error <= 0.5, "{said}");
    let area = |flat: &FlatSurface| flat.report.pieces[0].area_draped;
    assert!((area(&flat) / area(&fine) - 1.0).abs() < 0.01);
}

#[test]
fn the_pieces_are_a_garment_file() {
    let flat = laid(&hemisphere(12, 24, false), &SurfaceOptions { gores: Some(4), ..options() });
    let yaml = text(&flat, "garment.yaml");
    let loaded = toile::io::garment::read_text("cloth", "garment.yaml", &yaml).expect("a garment");
    assert_eq!(loaded.file.pieces.len(), 4);
    assert_eq!(loaded.file.seams.len(), 4);
    assert_eq!(loaded.file.free.len(), 4, "the rim of every gore");
}

/// A ring of `turns` turns that rises, 80 mm wide round a hole of 60 mm.
fn ramp(turns: f64) -> TriMesh {
    grid((40.0 * turns) as u32, 4, 0.0, |u, v| {
        let (round, far) = (TAU * turns * u, 60.0 + 80.0 * v);
        Vec3::new(far * round.cos(), 40.0 * turns * u, far * round.sin())
    })
}

#[test]
fn what_would_lie_on_itself_is_cut_in_two() {
    let flat = laid(&ramp(1.25), &options());
    assert_eq!(flat.report.pieces.iter().map(|p| p.overlaps).collect::<Vec<_>>(), [0, 0]);
    assert_eq!(flat.report.cuts_made.len(), 1);
    // Across the ring, not along it, and said.
    let cut = &flat.report.cuts_made[0];
    assert!((cut.length - 80.0).abs() < 4.0, "{cut:?}");
    assert!(flat.notes.iter().any(|note| note.contains("cut apart")), "{:?}", flat.notes);
    let legs: Vec<f64> = sewn(&flat).map(|e| e.length_flattened).collect();
    assert!(legs.len() == 2 && spread(&legs) < 0.01, "{legs:?}");
    // Three quarters of a turn lie side by side.
    let whole = laid(&ramp(0.75), &options());
    assert!(whole.report.pieces.len() == 1 && whole.report.cuts_made.is_empty());
}

fn sewn(flat: &FlatSurface) -> impl Iterator<Item = &toile::pipeline::EdgeReport> {
    flat.report.pieces.iter().flat_map(|p| &p.edges).filter(|e| e.sewn_to.is_some())
}

#[test]
fn a_strain_that_must_be_reached_is_by_darts_or_by_cuts_where_darts_cannot() {
    let reached = |mesh: &TriMesh, most: f64| {
        let limit = Limit::Strain(most);
        let flat = laid(mesh, &SurfaceOptions { darts: Some(Darts::Enough), limit, ..options() });
        for piece in &flat.report.pieces {
            assert!(piece.strain.p99 <= most && piece.overlaps == 0, "{}: {:?}", piece.name, piece.strain);
        }
        flat
    };
    let dome = hemisphere(12, 36, false);
    assert!(reached(&dome, 0.1).report.pieces[0].darts > 0);
    // A saddle has too little cloth, of which no dart takes any away.
    let saddle = grid(12, 12, 0.0, |u, v| {
        let [x, z] = [u, v].map(|c| 400.0 * c - 200.0);
        Vec3::new(x, (x * x - z * z) / 400.0, z)
    });
    let flat = reached(&saddle, 0.06);
    assert!(flat.report.pieces.len() > 1 && flat.report.pieces.iter().all(|p| p.darts == 0));
}

#[test]
fn a_deep_form_is_cut_to_its_far_end() {
    // A bag of 60 mm radius, 500 mm deep, its end round.
    let depth = 500.0;
    let bag = hemisphere(16, 32, false);
    let bag = TriMesh {
        vertices: bag
            .vertices
            .iter()
            .map(|p| Vec3::new(p.x * 60.0 / RADIUS, p.y * depth / RADIUS, p.z * 60.0 / RADIUS))
            .collect(),
        ..bag
    };
    let flat = laid(&bag, &options());
    assert_eq!(flat.report.cuts_made.len(), 1, "{:?}", flat.report.cuts_made);
    assert!(flat.report.cuts_made[0].length > depth && flat.report.pieces[0].area_change > -0.2);
}

#[test]
fn the_pieces_have_a_form_to_be_sewn_on() {
    let flat = laid(&hemisphere(12, 24, false), &SurfaceOptions { gores: Some(4), ..options() });
    let yaml = text(&flat, "garment.yaml");
    assert!(yaml.contains("body: form.obj") && yaml.matches("place: {at:").count() == 4, "{yaml}");
    let form = text(&flat, "form.obj");
    let vertices = form.lines().filter(|l| l.starts_with("v ")).count();
    let faces = form.lines().filter(|l| l.starts_with("f ")).count();
    // Closed, of no handle: Euler's F = 2 V - 4.
    assert_eq!(faces, 2 * vertices - 4);
    // Faces that show inward change nothing: all pieces start outside.
    let mut inward = hemisphere(12, 24, false);
    inward.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    for mesh in [hemisphere(12, 24, false), inward] {
        let flat = laid(&mesh, &SurfaceOptions { gores: Some(4), ..options() });
        let yaml = text(&flat, "garment.yaml");
        let places: Vec<Vec<f64>> = yaml
            .split("place: {at: [")
            .skip(1)
            .map(|rest| rest.split(']').next().unwrap_or_default().split(", ").filter_map(|x| x.parse().ok()).collect())
            .collect();
        let far = |at: &Vec<f64>| at.iter().map(|x| x * x).sum::<f64>().sqrt();
        let radius = mesh.vertices.iter().map(|p| p.norm()).fold(0.0, f64::max);
        assert!(places.len() == 4 && places.iter().all(|at| far(at) > 0.7 * radius), "{radius} {places:?}");
    }
    // A flat panel has no inside.
    let panel = laid(&grid(4, 4, 0.0, |u, v| Vec3::new(100.0 * u, 200.0 * v, 0.0)), &options());
    assert!(panel.results().expect("files").iter().all(|file| file.0 != "form.obj"));
}

#[test]
fn a_block_is_cut_along_its_sharp_edges() {
    // 600 × 90 × 400 mm, of cells, its sides slightly tapered.
    let corner = |k: u32| {
        let [x, y, z] = [k & 1, k >> 1 & 1, k >> 2].map(f64::from);
        Vec3::new(600.0 * x * (1.0 - 0.1 * z), 90.0 * y, 400.0 * z)
    };
    let mut mesh = TriMesh::default();
    for [a, b, c, d] in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3]] {
        let [a, b, c, d] = [a, b, c, d].map(corner);
        let side = grid(6, 6, 0.0, |u, v| (a * (1.0 - u) + b * u) * (1.0 - v) + (d * (1.0 - u) + c * u) * v);
        let first = mesh.vertices.len() as u32;
        mesh.vertices.extend(side.vertices);
        mesh.triangles.extend(side.triangles.iter().map(|t| t.map(|v| v + first)));
    }
    let cuts = Cuts { sharp: true, ..Cuts::default() };
    let flat = laid(&mesh, &SurfaceOptions { cuts, ..options() });
    let report = &flat.report;
    assert_eq!((report.pieces.len(), report.failed.len(), report.cuts_made.len()), (6, 0, 12));
    assert!(report.pieces.iter().all(|p| p.area_change.abs() < 1e-6 && p.edges.len() == 4), "{report:?}");
    assert!(report.pieces.iter().flat_map(|p| &p.edges).all(|e| e.sewn_to.is_some()));
}

#[test]
fn darts_that_bring_nothing_are_closed_again() {
    // Half a front with a bust. One by one, three darts are cut into it, of which the first brings all.
    let front = grid(24, 24, 0.0, |u, v| {
        let (x, y) = (250.0 * u, 400.0 * v);
        let bust = 50.0 * (-((x - 100.0).powi(2) + (y - 220.0).powi(2)) / 5000.0).exp();
        let (sine, cosine) = (x / 150.0).sin_cos();
        Vec3::new(sine, 0.0, cosine) * (150.0 + bust) + Vec3::y() * y
    });
    let strain = |darts: Option<Darts>| {
        let flat = laid(&front, &SurfaceOptions { darts, limit: Limit::Strain(0.03), ..options() });
        let piece = &flat.report.pieces[0];
        assert_eq!(flat.report.cuts_made.len(), piece.darts);
        assert_eq!(sewn(&flat).count(), 2 * piece.darts, "the legs of those that are left, and no others");
        (piece.darts, piece.strain.p99)
    };
    let (most, one) = (strain(Some(Darts::Auto)), strain(Some(Darts::Count(1))));
    assert!(most.0 < 3 && most.1 < 1.001 * one.1 && one.1 < 0.6 * strain(None).1, "{most:?} {one:?}");
}

#[test]
fn a_slit_of_one_edge_goes_the_long_way_and_numbers_are_as_wanted() {
    // On so few faces the straight line between the ends of the slit is an edge, along which a cut opens nothing.
    let corners = [[0.0, 0.0, 0.0], [100.0, 0.0, 0.0], [0.0, 100.0, 0.0], [0.0, 0.0, 100.0]].map(Vec3::from);
    let ball = TriMesh { vertices: corners.to_vec(), triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]] };
    let cuts = |first_number| {
        let cuts = Cuts { auto: true, ..Cuts::default() };
        let flat = laid(&ball, &SurfaceOptions { cuts, first_number, ..options() });
        assert_eq!((flat.report.pieces.len(), flat.report.failed.len()), (1, 0));
        flat.report.cuts
    };
    let (from_one, from_zero) = (cuts(1), cuts(0));
    assert!(from_one[0].len() > 2, "{from_one:?}");
    let less = |chain: &Vec<u32>| chain.iter().map(|v| v - 1).collect::<Vec<_>>();
    assert_eq!(from_zero, from_one.iter().map(less).collect::<Vec<_>>());
}
