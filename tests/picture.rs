//! The picture: the right size, the same bytes every time, and what it shows told apart. The pictures stay in the
//! target's temporary folder for a person to look at.

use std::f64::consts::{PI, TAU};
use std::path::Path;
use std::time::Instant;

use toile::geometry::{Path as Curve, TriMesh, Vec2, Vec3};
use toile::pattern::Problem;
use toile::picture::{
    HEIGHT, PatternEdge, PatternPiece, PictureError, PictureLayout, Scale, Scene, Specimen, Turning, ViewSide, WIDTH,
    draw, draw_pattern, draw_sheet, draw_turning, rim_lines, seam_color,
};
use toile::pipeline::{Checked, StartPicture, check, start_picture};

/// A tube of rings, each given by centre, half width and half depth; closed at both ends on demand.
fn tube(rings: &[(Vec3, f64, f64)], around: u32, closed: bool) -> TriMesh {
    let mut mesh = TriMesh::default();
    for (center, width, depth) in rings {
        mesh.vertices.extend((0..around).map(|k| {
            let (sin, cos) = (TAU * f64::from(k) / f64::from(around)).sin_cos();
            center + Vec3::new(width * sin, 0.0, depth * cos)
        }));
    }
    for row in 0..rings.len() as u32 - 1 {
        for k in 0..around {
            let (a, b) = (row * around + k, row * around + (k + 1) % around);
            mesh.triangles.extend([[a, b, b + around], [a, b + around, a + around]]);
        }
    }
    if closed {
        let last = (rings.len() as u32 - 1) * around;
        for k in 1..around - 1 {
            mesh.triangles.extend([[0, k + 1, k], [last, last + k, last + k + 1]]);
        }
    }
    mesh
}

fn add(mesh: &mut TriMesh, other: TriMesh) {
    let shift = mesh.vertices.len() as u32;
    mesh.vertices.extend(other.vertices);
    mesh.triangles.extend(other.triangles.iter().map(|t| t.map(|v| v + shift)));
}

/// Heights with half widths and depths, between which the outline runs smoothly.
fn profile(stations: &[[f64; 3]], rows: usize, x: f64) -> Vec<(Vec3, f64, f64)> {
    let at = |k: usize| {
        let t = k as f64 / rows as f64 * (stations.len() - 1) as f64;
        let i = (t as usize).min(stations.len() - 2);
        let s = (1.0 - (PI * (t - i as f64)).cos()) / 2.0;
        let [y, w, d] = [0, 1, 2].map(|j| stations[i][j] + s * (stations[i + 1][j] - stations[i][j]));
        (Vec3::new(x, y, 0.0), w, d)
    };
    (0..=rows).map(at).collect()
}

/// A dress form with arms and legs, about 30,000 triangles.
fn body() -> TriMesh {
    let trunk = [
        [0.76, 0.09, 0.08],
        [0.85, 0.17, 0.11],
        [1.05, 0.125, 0.09],
        [1.27, 0.155, 0.115],
        [1.42, 0.11, 0.07],
        [1.47, 0.055, 0.055],
        [1.53, 0.05, 0.05],
        [1.64, 0.075, 0.09],
        [1.76, 0.02, 0.02],
    ];
    let mut mesh = tube(&profile(&trunk, 90, 0.0), 90, true);
    for side in [-1.0, 1.0] {
        let leg =
            [[0.02, 0.04, 0.06], [0.1, 0.035, 0.04], [0.35, 0.055, 0.055], [0.5, 0.055, 0.06], [0.82, 0.08, 0.08]];
        add(&mut mesh, tube(&profile(&leg, 60, side * 0.085), 50, true));
        let mut arm = profile(&[[0.8, 0.02, 0.03], [0.9, 0.03, 0.03], [1.12, 0.04, 0.04], [1.38, 0.05, 0.05]], 40, 0.0);
        arm.iter_mut().for_each(|(c, ..)| c.x = side * (0.165 + 0.5 * (1.38 - c.y) * 0.6));
        add(&mut mesh, tube(&arm, 40, true));
    }
    mesh
}

struct Dress {
    cloth: TriMesh,
    pieces: Vec<u32>,
    seams: Vec<Vec<Vec3>>,
    strain: Vec<f64>,
}

/// A sleeveless dress with a rippling skirt of four pieces and a waist seam; 20,000 triangles.
fn dress() -> Dress {
    let (around, rows) = (100usize, 100usize);
    let stations =
        [[0.42, 0.33, 0.30], [0.75, 0.225, 0.175], [1.05, 0.132, 0.097], [1.27, 0.163, 0.123], [1.37, 0.14, 0.09]];
    let mut cloth = tube(&profile(&stations, rows, 0.0), around as u32, false);
    let waist = 55;
    for (k, p) in cloth.vertices.iter_mut().enumerate() {
        let turn = TAU * (k % around) as f64 / around as f64;
        let depth = ((0.95 - p.y) / 0.5).max(0.0);
        let ripple = 1.0 + 0.13 * depth * (9.0 * turn).cos();
        p.x *= ripple;
        p.z *= ripple;
        p.y -= 0.015 * depth * (9.0 * turn).cos();
    }
    let quarter = around / 4;
    let piece = |t: usize| {
        let (row, column) = (t / (2 * around), t % (2 * around) / 2);
        let front = column < quarter || column >= 3 * quarter;
        u32::from(!front) + 2 * u32::from(row >= waist)
    };
    let pieces = (0..cloth.triangles.len()).map(piece).collect();
    let column = |k: usize| (0..=rows).map(|r| cloth.vertices[r * around + k]).collect();
    let mut seams: Vec<Vec<Vec3>> = vec![column(quarter), column(3 * quarter)];
    seams.push((0..=around).map(|k| cloth.vertices[waist * around + k % around]).collect());
    let strain = cloth.vertices.iter().map(|p| 0.012 * (7.0 * p.y).sin() + 0.006 * (5.0 * p.x).cos()).collect();
    Dress { cloth, pieces, seams, strain }
}

fn draw_dress(strain: bool) -> Vec<u8> {
    let (body, dress) = (body(), dress());
    let rims = rim_lines(&dress.cloth);
    let scene = Scene {
        body: &body,
        cloth: &dress.cloth,
        piece_of_triangle: &dress.pieces,
        seams: &dress.seams,
        rims: &rims,
        title: "gore_skirt",
        subtitle: "woman_92 · cotton_poplin",
        values: strain.then_some((dress.strain.as_slice(), Scale::Strain)),
        groups: &[],
    };
    let start = Instant::now();
    let png = draw(&scene, &PictureLayout::default()).expect("a scene with cloth can be drawn");
    println!("{} + {} triangles in {:?}", body.triangles.len(), dress.cloth.triangles.len(), start.elapsed());
    png
}

fn keep(name: &str, png: &[u8]) {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&path, png).expect("the target's temporary folder can be written");
}

fn decode(png: &[u8]) -> Vec<[u8; 3]> {
    let rgb = pixels(png);
    assert_eq!(rgb.len(), WIDTH * HEIGHT);
    rgb
}

/// Of a picture that may be higher than others.
fn pixels(png: &[u8]) -> Vec<[u8; 3]> {
    let mut reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().expect("a PNG");
    let mut rgb = vec![0; reader.output_buffer_size().expect("of a size")];
    let info = reader.next_frame(&mut rgb).expect("with one frame");
    assert_eq!(info.width as usize, WIDTH);
    rgb.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect()
}

#[test]
fn a_dress_by_pieces_and_by_strain() {
    let by_piece = draw_dress(false);
    let by_strain = draw_dress(true);
    keep("dress.png", &by_piece);
    keep("dress_strain.png", &by_strain);
    let (pieces, strain) = (decode(&by_piece), decode(&by_strain));
    assert_ne!(pieces, strain);
    let paper = pieces[0];
    let drawn = pieces.iter().filter(|p| **p != paper).count();
    assert!(drawn > WIDTH * HEIGHT / 8, "only {drawn} pixels drawn");
    assert!(by_piece.len() < 4_000_000, "{} bytes", by_piece.len());
}

#[test]
fn the_same_bytes_on_one_thread() {
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread");
    assert_eq!(one.install(|| draw_dress(false)), draw_dress(false));
}

/// A flat cloth seen from the front shows its right side, from the back its wrong one, and the side view an edge.
#[test]
fn right_and_wrong_side_differ() {
    let vertices = [[-0.3, 0.0], [0.3, 0.0], [0.3, 0.6], [-0.3, 0.6]].map(|[x, y]| Vec3::new(x, y, 0.0)).to_vec();
    let cloth = TriMesh { vertices, triangles: vec![[0, 1, 2], [0, 2, 3]] };
    let png = draw(&scene(&cloth, None), &PictureLayout::default()).expect("a scene with cloth can be drawn");
    keep("flat.png", &png);
    let pixels = decode(&png);
    let row = &pixels[HEIGHT / 2 * WIDTH..][..WIDTH];
    let brightness = |p: &[u8; 3]| p.iter().map(|&x| u32::from(x)).sum::<u32>();
    let (front, back) = (&row[WIDTH / 5], &row[4 * WIDTH / 5]);
    assert!(brightness(front) > brightness(back) + 60, "{front:?} {back:?}");
}

#[test]
fn a_long_ribbon_lying_flat_still_has_three_views() {
    let vertices = [[-5.0, 0.0], [5.0, 0.0], [5.0, 0.001], [-5.0, 0.001]].map(|[x, z]| Vec3::new(x, 0.0, z)).to_vec();
    let ribbon = TriMesh { vertices, triangles: vec![[0, 1, 2], [0, 2, 3]] };
    assert!(draw(&scene(&ribbon, None), &PictureLayout::default()).is_ok());
    let point = TriMesh { vertices: vec![Vec3::zeros(); 3], triangles: vec![[0, 1, 2]] };
    assert!(draw(&scene(&point, None), &PictureLayout::default()).is_ok());
}

/// A line on a lining half a millimetre behind the shell does not show through it; on the shell itself it does.
#[test]
fn a_piece_hides_the_lines_of_another_right_behind_it() {
    let square = |z: f64| [[0.0, 0.0], [0.1, 0.0], [0.1, 0.2], [0.0, 0.2]].map(|[x, y]| Vec3::new(x, y, z));
    let mut cloth = TriMesh::default();
    for z in [0.0, -5e-4] {
        add(&mut cloth, TriMesh { vertices: square(z).to_vec(), triangles: vec![[0, 1, 2], [0, 2, 3]] });
    }
    let seen_in_front = |line: Option<[u32; 2]>, piece_of_triangle: &[u32]| {
        let seams: Vec<Vec<Vec3>> = line.iter().map(|l| l.map(|v| cloth.vertices[v as usize]).to_vec()).collect();
        let png = draw(&Scene { piece_of_triangle, seams: &seams, ..scene(&cloth, None) }, &PictureLayout::default())
            .expect("a scene");
        // The views stand side by side, front first. Its middle: at the corners a line's round ends stick out.
        let rows = decode(&png).chunks(WIDTH).map(|row| row[..WIDTH / 3].to_vec()).collect::<Vec<_>>();
        rows[2 * HEIGHT / 5..3 * HEIGHT / 5].to_vec()
    };
    // A piece that lies over itself, as a wrapped waistband does, hides its own lines.
    for pieces in [[0, 0, 1, 1], [0; 4]] {
        let without = seen_in_front(None, &pieces);
        assert_eq!(seen_in_front(Some([4, 6]), &pieces), without, "the diagonal of the square behind");
        assert_ne!(seen_in_front(Some([0, 2]), &pieces), without, "the diagonal of the square in front");
    }
}

/// Nor does the rim of a smaller one, however much the cloth is turned away: lines are wider than layers are apart.
#[test]
fn cloth_at_a_slant_hides_the_rim_of_a_facing() {
    for degrees in [30.0f64, 60.0, 75.0, 85.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let square = |half: f64, behind: f64| {
            let corners = [[-half, 0.8 - half], [half, 0.8 - half], [half, 0.8 + half], [-half, 0.8 + half]];
            let at = |[x, y]: [f64; 2]| Vec3::new(x * cos - behind * sin, y, -x * sin - behind * cos);
            TriMesh { vertices: corners.map(at).to_vec(), triangles: vec![[0, 1, 2], [0, 2, 3]] }
        };
        let mut cloth = square(0.8, 0.0);
        add(&mut cloth, square(0.4, 5e-4));
        let rims = rim_lines(&square(0.4, 5e-4));
        let seen_in_front = |rims: &[Vec<Vec3>]| {
            let png = draw(
                &Scene { piece_of_triangle: &[0, 0, 1, 1], rims, ..scene(&cloth, None) },
                &PictureLayout::default(),
            )
            .expect("a scene");
            decode(&png).chunks(WIDTH).map(|row| row[..WIDTH / 3].to_vec()).collect::<Vec<_>>()
        };
        assert_eq!(seen_in_front(&rims), seen_in_front(&[]), "turned by {degrees} degrees");
    }
}

fn scene<'a>(cloth: &'a TriMesh, strain: Option<&'a [f64]>) -> Scene<'a> {
    static NOBODY: TriMesh = TriMesh { vertices: vec![], triangles: vec![] };
    Scene {
        body: &NOBODY,
        cloth,
        piece_of_triangle: &[],
        seams: &[],
        rims: &[],
        title: "",
        subtitle: "",
        values: strain.map(|values| (values, Scale::Strain)),
        groups: &[],
    }
}

#[test]
fn what_cannot_be_drawn_is_said() {
    let nothing = TriMesh::default();
    assert!(matches!(draw(&scene(&nothing, None), &PictureLayout::default()), Err(PictureError::NothingToDraw)));
    let mut cloth = dress().cloth;
    assert!(matches!(
        draw(&scene(&cloth, Some(&[0.1])), &PictureLayout::default()),
        Err(PictureError::ValuesLength { values: 1, .. })
    ));
    cloth.vertices[5].x = f64::NAN;
    assert!(matches!(draw(&scene(&cloth, None), &PictureLayout::default()), Err(PictureError::NothingToDraw)));
}

/// Every specimen of a sheet has a panel of its own, and the same specimen looks the same in each.
#[test]
fn a_sheet_shows_every_specimen() {
    let nobody = TriMesh::default();
    let (low, high) = (pillow(0.01), pillow(0.1));
    let specimen = |cloth| Specimen { name: "cloth", cloth, lines: &[], body: &nobody };
    let png = draw_sheet("sheet", "two flat ones, one raised", &[&low, &low, &high].map(specimen)).expect("drawn");
    keep("sheet.png", &png);
    let mut reader = png::Decoder::new(std::io::Cursor::new(&png)).read_info().expect("a PNG");
    let mut rgb = vec![0; reader.output_buffer_size().expect("of a size")];
    let info = reader.next_frame(&mut rgb).expect("with one frame");
    let (width, height) = (info.width as usize, info.height as usize);
    assert_eq!(width, WIDTH);
    // Below the title and above the names.
    let panel = |k: usize| -> Vec<&[u8]> {
        (height / 5..4 * height / 5)
            .map(|y| &rgb[3 * (y * width + k * width / 3)..3 * (y * width + (k + 1) * width / 3)])
            .collect()
    };
    assert_eq!(panel(0), panel(1));
    assert_ne!(panel(0), panel(2));
    let paper = &rgb[..3];
    let drawn = panel(0).iter().flat_map(|row| row.chunks_exact(3)).filter(|p| *p != paper).count();
    assert!(drawn > width * height / 30, "only {drawn} pixels drawn");
    assert!(matches!(draw_sheet("", "", &[]), Err(PictureError::NothingToDraw)));
    assert!(matches!(draw_sheet("", "", &[specimen(&nobody)]), Err(PictureError::NothingToDraw)));
}

/// A PNG's width and pixels.
fn read(png: &[u8]) -> (usize, Vec<[u8; 3]>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().expect("a PNG");
    let mut rgb = vec![0; reader.output_buffer_size().expect("of a size")];
    let info = reader.next_frame(&mut rgb).expect("with one frame");
    (info.width as usize, rgb.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect())
}

/// The start of a shipped garment, drawn.
fn start_of(garment: &str) -> StartPicture {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(garment);
    let checked = check(&file, Some(0.025)).expect("a garment");
    start_picture(&[checked]).expect("drawn")
}

#[test]
fn a_start_is_drawn_with_the_rim_of_every_opening_in_a_colour_of_its_own() {
    let start = start_of("patterns/tshirt.yaml");
    keep("start.png", &start.png);
    let mut through: Vec<&str> = start.shown.openings.iter().map(|o| o.through.as_str()).collect();
    through.sort_unstable();
    assert_eq!(through, ["head", "left arm", "left leg + right leg", "right arm"]);
    assert!(start.shown.clear && start.shown.placed.is_none(), "{:?}", start.shown);
    let (width, pixels) = read(&start.png);
    for (k, rim) in start.rims.iter().enumerate() {
        // A rim is drawn seven pixels wide; in its middle runs the fine line of every rim of the cloth.
        let near =
            |[x, y]: [usize; 2]| [-2, 2].map(|d: isize| [x.saturating_add_signed(d), y.saturating_add_signed(d)]);
        let is_shown = |at: &[usize; 2]| near(*at).iter().any(|[x, y]| pixels[y * width + x] == rim.color);
        let shown = rim.pixels.iter().filter(|at| is_shown(at)).count();
        assert!(6 * shown > rim.pixels.len(), "opening {k}: {shown} of {} points are seen", rim.pixels.len());
        assert!(start.rims.iter().filter(|other| other.color == rim.color).count() == 1, "opening {k}");
    }
    assert_eq!(start_of("patterns/tshirt.yaml").png, start.png, "the same bytes again");
}

/// A cone that may be a skirt and may be a poncho; `place` is what its front says.
fn start_of_cone(place: &str) -> StartPicture {
    start_picture(&[checked_cone(place)]).expect("drawn")
}

fn checked_cone(place: &str) -> Checked {
    let text = format!(
        "garment: 1\nname: Cone\nbody: woman_92\nfabrics: {{shell: cotton_poplin}}\npieces:\n  one:\n    \
         place: {place}\n    \
         grain: [[0, 50], [0, 250]]\n    \
         outline: {{start: -200 0, top: L 200 0, right: L 500 400, hem: L -500 400, left: L -200 0}}\n  \
         other: {{like: one, place: back torso}}\nseams:\n  left: {{sew: one.right, to: other.left}}\n  \
         right: {{sew: one.left, to: other.right}}\nfree: ['*.top', '*.hem']\n"
    );
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("cone.yaml");
    std::fs::write(&file, text).expect("written");
    check(&file, Some(0.025)).unwrap_or_else(|refused| panic!("{refused}"))
}

#[test]
fn a_dealing_in_doubt_is_drawn_and_both_dealings_are_told_with_the_words_that_settle_it() {
    let start = start_of_cone("front torso");
    keep("doubt.png", &start.png);
    assert!(!start.shown.clear, "{:?}", start.shown);
    let ways: Vec<[&str; 2]> = start.shown.doubts.iter().map(|d| [d.first.as_str(), d.second.as_str()]).collect();
    let all = "left arm + right arm + left leg + right leg";
    assert_eq!(ways, [["head + left arm + right arm", "head"], ["left leg + right leg", all]]);
    let said = &start.shown.words[0];
    assert_eq!((said.piece.as_str(), said.word.as_str(), said.dealing), ("one", "hip", "first"));
    assert!(start.shown.text().contains("the first is settled by 'place: hip' for one"), "{}", start.shown.text());
    let warnings = checked_cone("front torso").loaded.warnings;
    let told: Vec<_> = warnings.iter().filter(|d| matches!(d.problem, Problem::WornInTwoWays { .. })).collect();
    let [told] = told[..] else { panic!("{warnings:?}") };
    assert!(told.message.starts_with("it is not clear how the garment is worn"), "{told}");
    assert!(told.hint.as_deref().is_some_and(|hint| hint.contains("'place: hip' for one")), "{told}");
    let settled = start_of_cone("hip").shown;
    assert!(settled.clear && settled.words.is_empty(), "{settled:?}");
    assert_eq!(settled.openings, start.shown.openings);
}

#[test]
fn where_positions_say_how_pieces_start_these_are_drawn() {
    let start = start_of("tests/data/across.yaml");
    assert!(start.shown.placed.as_deref().is_some_and(|why| why.contains("position")), "{:?}", start.shown);
    assert!(read(&start.png).1.len() > WIDTH * HEIGHT);
    // Two of four pieces with a position leave the start to the topology.
    let some = start_of("tests/data/full_skirt.yaml");
    assert!(some.shown.placed.is_none(), "{:?}", some.shown);
}

/// A lying square of 0.4 m whose middle is this high.
fn pillow(height: f64) -> TriMesh {
    let corners = [[-0.2, -0.2], [0.2, -0.2], [0.2, 0.2], [-0.2, 0.2]].map(|[x, z]| Vec3::new(x, 0.0, z));
    let vertices = [corners.as_slice(), &[Vec3::y() * height]].concat();
    TriMesh { vertices, triangles: vec![[0, 4, 1], [1, 4, 2], [2, 4, 3], [3, 4, 0]] }
}

/// Pieces of a pattern are drawn with their edges, those of a seam in its colour, which the legend below has too.
#[test]
fn a_pattern_shows_its_seams_in_colours() {
    let square = |name: &str, seam: Option<usize>| {
        let corners = [[0.0, 0.0], [0.2, 0.0], [0.2, 0.2], [0.0, 0.2], [0.0, 0.0]].map(|[x, y]| Vec2::new(x, y));
        let edge = |k: usize| PatternEdge {
            name: ["a", "b", "c", "d"][k].to_owned(),
            path: Curve::line(corners[k], corners[k + 1]),
            notches: vec![(0.1, k == 0)],
            seam: seam.filter(|_| k == 1),
            fold: false,
        };
        PatternPiece {
            name: name.to_owned(),
            edges: (0..4).map(edge).collect(),
            lines: Vec::new(),
            points: Vec::new(),
            grain: None,
        }
    };
    let picture = |seam: Option<usize>| {
        let pieces = [square("front", seam), square("back", seam)];
        let png =
            draw_pattern("two squares", &pieces, &["side: {sew: front.b, to: back.b}".to_owned()]).expect("a PNG");
        pixels(&png)
    };
    let colored = |picture: &[[u8; 3]]| picture.iter().filter(|pixel| **pixel == seam_color(0)).count();
    let (plain, sewn) = (picture(None), picture(Some(0)));
    // The square of the legend, and two edges besides that are hundreds of pixels long.
    assert!(colored(&plain) > 300 && colored(&sewn) > colored(&plain) + 2000, "{} {}", colored(&plain), colored(&sewn));
    assert_eq!(plain.len(), sewn.len());
    assert!(draw_pattern("nothing", &[], &[]).is_err());
}

/// A square of cloth, 600 mm wide, that faces forwards.
fn square() -> TriMesh {
    let vertices = [[-0.3, 0.0], [0.3, 0.0], [0.3, 0.6], [-0.3, 0.6]].map(|[x, y]| Vec3::new(x, y, 0.0)).to_vec();
    TriMesh { vertices, triangles: vec![[0, 1, 2], [0, 2, 3]] }
}

#[test]
fn size_and_views_are_those_asked_for() {
    let cloth = square();
    // Columns of the middle row that show its right side, which is blue.
    let seen = |views: Vec<ViewSide>| {
        let png = draw(&scene(&cloth, None), &PictureLayout { size: [900, 600], views }).expect("a scene");
        let (width, pixels) = read(&png);
        assert_eq!((width, pixels.len()), (900, 900 * 600));
        pixels[300 * 900..301 * 900].iter().filter(|p| i32::from(p[2]) - i32::from(p[0]) > 20).count()
    };
    let (one, two) = (seen(vec![ViewSide::Front]), seen(vec![ViewSide::Front, ViewSide::Back, ViewSide::Right]));
    // Both sides are seen, each a little smaller for the room of the others.
    assert!(one > 200 && two > one && two < 2 * one, "{one} and {two} columns");
    assert_eq!(seen(vec![ViewSide::Left, ViewSide::Right]), 0, "from the sides it is an edge");
}

#[test]
fn a_turn_is_an_animation_that_repeats() {
    let cloth = square();
    let apng = draw_turning(&scene(&cloth, None), Turning::Apng).expect("a scene");
    let decoder = png::Decoder::new(std::io::Cursor::new(&apng));
    let reader = decoder.read_info().expect("a PNG");
    let control = reader.info().animation_control().expect("animated");
    assert_eq!((control.num_frames, control.num_plays), (36, 0));
    let gif = draw_turning(&scene(&cloth, None), Turning::Gif).expect("a scene");
    assert!(gif.starts_with(b"GIF89a") && gif.windows(11).any(|w| w == b"NETSCAPE2.0"));
    assert!(gif.len() < 4 << 20, "{} bytes", gif.len());
    assert!(draw_turning(&scene(&TriMesh::default(), None), Turning::Gif).is_err());
}
