//! The report against a garment small enough to check by hand, and against the definitions of DESIGN section 4.

use approx::assert_relative_eq;
use toile::geometry::{Vec2, Vec3};
use toile::io::obj_write::garment_obj;
use toile::mannequin::Mannequin;
use toile::mesh::{ClothMesh, EdgeParticles, PieceMesh, Stitches};
use toile::pattern::{Bound, EdgeId, Garment, Give, Seam, SeamKind, Span, Test};
use toile::picture::{Dressed, PictureLayout, Scale, draw};
use toile::report::{
    Bands, Measured, Quartet, Report, Stage, Stretched, Verdict, measure, opening_names, table, verdicts, vertex_strain,
};

/// A grid of `cells` squares each way, `width` by `height`, its upper left corner at the origin; four named edges.
fn add_piece(mesh: &mut ClothMesh, name: &str, width: f64, height: f64, cells: u32) {
    let (first, first_triangle) = (mesh.flat.len(), mesh.triangles.len());
    let n = cells + 1;
    let share = |k: u32| f64::from(k) / f64::from(cells);
    for row in 0..n {
        mesh.flat.extend((0..n).map(|column| Vec2::new(width * share(column), height * share(row))));
    }
    let at = |row: u32, column: u32| first as u32 + row * n + column;
    for row in 0..cells {
        for column in 0..cells {
            let [a, b] = [at(row, column), at(row, column + 1)];
            let [c, d] = [at(row + 1, column), at(row + 1, column + 1)];
            mesh.triangles.extend([[a, b, d], [a, d, c]]);
        }
    }
    let edge = |index: usize, name: &str, particles: Vec<u32>| EdgeParticles {
        edge: EdgeId { piece: mesh.pieces.len(), ring: 0, index },
        name: name.into(),
        particles,
    };
    let edges = vec![
        edge(0, "top", (0..n).map(|k| at(0, k)).collect()),
        edge(1, "right", (0..n).map(|k| at(k, cells)).collect()),
        edge(2, "bottom", (0..n).rev().map(|k| at(cells, k)).collect()),
        edge(3, "left", (0..n).rev().map(|k| at(k, 0)).collect()),
    ];
    mesh.pieces.push(PieceMesh {
        name: name.into(),
        particles: first..mesh.flat.len(),
        triangles: first_triangle..mesh.triangles.len(),
        edges,
        lines: vec![],
        smallest_angle: 45f64.to_radians(),
        warp: Vec2::new(0.0, -1.0),
        narrow: None,
    });
}

/// The right edge of the first piece sewn to the left edge of the second.
struct Fixture {
    mesh: ClothMesh,
    weld: Vec<u32>,
    garment: Garment,
    body: Mannequin,
}

fn fixture(second_height: f64) -> Fixture {
    let mut mesh = ClothMesh { spacing: 0.01, ..ClothMesh::default() };
    add_piece(&mut mesh, "front.L", 0.1, 0.1, 10);
    add_piece(&mut mesh, "back.L", 0.1, second_height, 10);
    let right = mesh.pieces[0].edges[1].particles.clone();
    let left: Vec<u32> = mesh.pieces[1].edges[3].particles.iter().rev().copied().collect();
    let pairs: Vec<[u32; 2]> = right.iter().zip(&left).map(|(&a, &b)| [a, b]).collect();
    let mut weld: Vec<u32> = (0..mesh.flat.len() as u32).collect();
    pairs.iter().for_each(|&[a, b]| weld[b as usize] = a);
    mesh.seams.push(Stitches { name: "side".into(), stage: 1, pairs });
    let garment = Garment {
        name: "patch".into(),
        title: "Patch".into(),
        body: None,
        pieces: vec![],
        seams: vec![],
        fabrics: vec![],
        closures: vec![],
        worn: vec![],
        tests: vec![],
    };
    let body = Mannequin { name: "nobody".into(), mesh: Default::default(), parts: vec![], frame: Default::default() };
    Fixture { mesh, weld, garment, body }
}

/// Both pieces in the plane z = 0, right side towards +z: the first scaled by `scale`, the second beside it with the
/// same height.
fn laid_out(f: &Fixture, scale: f64) -> Vec<Vec3> {
    let tall = f.mesh.flat[f.mesh.pieces[1].particles.clone()].iter().map(|p| p.y).fold(0.0, f64::max);
    let place = |(k, p): (usize, &Vec2)| {
        if f.mesh.pieces[0].particles.contains(&k) {
            Vec3::new(p.x * scale, -p.y * scale, 0.0)
        } else {
            Vec3::new(0.1 * scale + p.x, -p.y / tall * 0.1 * scale, 0.0)
        }
    };
    f.mesh.flat.iter().enumerate().map(place).collect()
}

fn report(f: &Fixture, sewn: &[Vec3], draped: &[Vec3], flattened: &[Vec2]) -> Report {
    let (name, seconds) = ("sew".into(), 1.5);
    let stage = Stage { name, seconds, iterations: 3, converged: true, ..Stage::default() };
    measure(&Measured { draped: Some(draped), flattened: Some(flattened), stages: &[stage], ..run(f, sewn) })
}

#[test]
fn a_square_scaled_by_a_hundredth() {
    let f = fixture(0.1);
    let at = laid_out(&f, 1.01);
    let r = report(&f, &at, &at, &f.mesh.flat);
    let front = &r.pieces[0];
    assert_eq!((front.particles, front.triangles), (121, 200));
    assert_relative_eq!(front.sizes.area_flat, 10_000.0, epsilon = 1e-6);
    assert_relative_eq!(front.sizes.area_draped.unwrap_or(0.0), 10_201.0, epsilon = 1e-6);
    assert_relative_eq!(front.area_error.drape.unwrap_or(0.0), 0.0201, epsilon = 1e-9);
    assert_relative_eq!(front.boundary_error.drape.unwrap_or(0.0), 0.01, epsilon = 1e-9);
    assert_relative_eq!(front.area_error.flatten.unwrap_or(0.0), 1.0 - 1.0 / 1.0201, epsilon = 1e-9);
    assert_eq!(front.area_error.round_trip, Some(0.0));
    assert_eq!(front.boundary_error.round_trip, Some(0.0));
    let s = front.strain;
    [s.mean, s.p95, s.p99, s.max, front.largest_edge_error]
        .iter()
        .for_each(|x| assert_relative_eq!(*x, 0.01, epsilon = 1e-9));
    assert_relative_eq!(front.shear.max, 0.0, epsilon = 1e-6);
    assert!(r.pieces.iter().all(|p| p.stretched.is_none()));
    assert_relative_eq!(r.total.sizes.area_flat, 20_000.0, epsilon = 1e-6);
}

#[test]
fn a_gathered_seam_is_right_anywhere_between_its_two_lengths() {
    // 100 mm sewn to 120 mm; sewn length 100 mm.
    let f = fixture(0.12);
    let at = laid_out(&f, 1.0);
    let r = report(&f, &at, &at, &f.mesh.flat);
    let back = &r.pieces[1];
    // Free: top and bottom 100 mm each as drawn, right side 120 drawn in to 100: 20 of 440 mm.
    assert_relative_eq!(back.boundary_error.drape.unwrap_or(0.0), 20.0 / 440.0, epsilon = 1e-9);
    assert_relative_eq!(back.boundary_error_raw.drape.unwrap_or(0.0), 40.0 / 440.0, epsilon = 1e-9);
    // Flattening gave the seam back its drawn ratio: right; the free side grew by 20 of 400 mm.
    assert_relative_eq!(back.boundary_error.flatten.unwrap_or(0.0), 20.0 / 400.0, epsilon = 1e-9);
    assert_eq!(back.boundary_error.round_trip, Some(0.0));
    assert_relative_eq!(back.area_error_raw.drape.unwrap_or(0.0), 1.0 - 100.0 / 120.0, epsilon = 1e-9);
    let front = &r.pieces[0];
    assert_eq!(front.boundary_error.drape, Some(0.0));
    assert!(front.stretched.is_none());
}

#[test]
fn triangles_beside_an_uneven_seam_do_not_count() {
    // Only the row of triangles at the gathered seam is off.
    let f = fixture(0.12);
    let mut at = laid_out(&f, 1.0);
    for k in f.mesh.pieces[1].particles.clone() {
        let p = f.mesh.flat[k];
        let pull = if p.x < 1e-9 { 100.0 / 120.0 } else { 1.0 };
        at[k].y = -p.y * pull;
    }
    for &[a, b] in &f.mesh.seams[0].pairs {
        assert!((at[a as usize] - at[b as usize]).norm() < 1e-12);
    }
    let r = report(&f, &at, &at, &f.mesh.flat);
    assert_relative_eq!(r.pieces[1].area_error.drape.unwrap_or(1.0), 0.0, epsilon = 1e-9);
    assert!(r.pieces[1].area_error_raw.drape.unwrap_or(0.0) > 0.005);
}

#[test]
fn a_band_drawn_out_by_a_seam_is_named() {
    // 100 mm sewn to 80 mm, sewn length 100: the second piece stretches by a quarter along the seam.
    let f = fixture(0.08);
    let at = laid_out(&f, 1.0);
    let r = report(&f, &at, &at, &f.mesh.flat);
    let stretched = r.pieces[1].stretched.clone().map(|s| (s.why, (s.by * 1000.0).round()));
    assert_eq!(stretched, Some(("seam side".into(), 250.0)));
    assert!(r.pieces[0].stretched.is_none());
    let text = table(&r);
    assert!(text.contains("stretched 25.0 % by seam side"), "{text}");
}

#[test]
fn a_piece_smaller_than_the_body_is_named() {
    let f = fixture(0.1);
    let at = laid_out(&f, 1.08);
    let r = report(&f, &at, &at, &f.mesh.flat);
    assert_eq!(r.pieces[0].stretched.as_ref().map(|s| s.why.as_str()), Some("body"));
}

#[test]
fn shear_is_the_change_of_the_angle() {
    let f = fixture(0.1);
    let at: Vec<Vec3> = laid_out(&f, 1.0).iter().map(|p| Vec3::new(p.x + 0.1 * p.y, p.y, 0.0)).collect();
    let r = report(&f, &at, &at, &f.mesh.flat);
    let expected = 0.1f64.atan().to_degrees();
    let s = r.pieces[0].shear;
    [s.mean, s.p99, s.max].iter().for_each(|x| assert_relative_eq!(*x, expected, epsilon = 1e-9));
}

#[test]
fn seam_gaps_and_lengths() {
    let f = fixture(0.1);
    let at = laid_out(&f, 1.0);
    let mut gaps: Vec<Vec<f64>> = f.mesh.seams.iter().map(|s| vec![0.0; s.pairs.len()]).collect();
    gaps[0][3] = 0.0022;
    let r = measure(&Measured { gaps: Some(&gaps), ..run(&f, &at) });
    let seam = &r.seams[0];
    assert_relative_eq!(seam.length_a, 100.0, epsilon = 1e-9);
    assert_relative_eq!(seam.gap_max, 2.2, epsilon = 1e-9);
    assert_relative_eq!(seam.gap_mean, 0.2, epsilon = 1e-9);
    // The stages that did not run are null.
    assert_eq!(r.pieces[0].area_error, Quartet { sew: r.pieces[0].area_error.sew, ..Quartet::default() });
}

#[test]
fn a_piece_that_lies_on_itself_is_out_of_bounds() {
    let f = fixture(0.1);
    let at = laid_out(&f, 1.0);
    let judged = |overlaps: &[usize]| {
        let r = measure(&Measured { overlaps: Some(overlaps), ..run(&f, &at) });
        assert_eq!(r.total.overlaps, Some(overlaps.iter().sum()));
        let on_itself = verdicts(&f.garment, &r).into_iter().filter(|v| v.bound.contains("on itself"));
        on_itself.map(|v| (v.ok, v.to_string())).collect::<Vec<_>>()
    };
    assert_eq!(judged(&[0, 0]), []);
    let said = "'back.L' lies on itself when flat; cut it in two; crossings of its rim: 3 (limit 0) at back.L";
    assert_eq!(judged(&[0, 3]), [(false, said.to_owned())]);
}

fn run<'a>(f: &'a Fixture, sewn: &'a [Vec3]) -> Measured<'a> {
    Measured {
        garment: &f.garment,
        mesh: &f.mesh,
        weld: &f.weld,
        uncrossed: None,
        body: &f.body,
        fabric: "muslin",
        gaps: None,
        placed: None,
        sewn: Some(sewn),
        draped: None,
        flattened: None,
        overlaps: None,
        pressed: None,
        gives: &[],
        bands: Bands::default(),
        stages: &[],
    }
}

/// The fixture hanging down, folded back and down again over 30 mm, its three layers so far apart, metres.
fn pleated_over(f: &Fixture, apart: f64) -> Vec<Vec3> {
    let hang = |p: &Vec3| {
        let down = -p.y;
        let [y, layer] = match down {
            d if d < 0.045 => [-d, 0.0],
            d if d < 0.075 => [-0.04 + (d - 0.04), 1.0],
            d => [-0.01 - (d - 0.07), 2.0],
        };
        Vec3::new(p.x, y, layer * apart)
    };
    laid_out(f, 1.0).iter().map(hang).collect()
}

#[test]
fn cloth_pressed_on_itself_is_named_with_its_area_and_folds_that_stand_off_are_not() {
    let f = fixture(0.1);
    let folded = |apart: f64| {
        let at = pleated_over(&f, apart);
        report(&f, &laid_out(&f, 1.0), &at, &f.mesh.flat).bunched
    };
    let found = folded(0.004);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0].pieces, ["front.L", "back.L"]);
    // Three layers of 30 mm by 200 mm, less the triangles at the folds.
    assert!((9_000.0..=18_000.0).contains(&found[0].area), "{found:?}");
    assert!((-50.0..=0.0).contains(&found[0].height), "{found:?}");
    assert!(found[0].to_string().contains("of front.L, back.L"), "{}", found[0]);
    assert_eq!(folded(0.02), []);
    assert_eq!(folded(0.004).first(), found.first(), "the same again");
    // Nothing is said of a garment that has only been sewn.
    assert_eq!(measure(&run(&f, &pleated_over(&f, 0.004))).bunched, []);
}

#[test]
fn the_keys_other_programs_rely_on() {
    let f = fixture(0.08);
    let at = laid_out(&f, 1.0);
    let json = serde_json::to_value(report(&f, &at, &at, &f.mesh.flat)).expect("a report is plain data");
    let has = |value: &serde_json::Value, keys: &[&str]| {
        keys.iter().for_each(|k| assert!(value.get(k).is_some(), "{k} missing"));
    };
    let head = ["toile", "garment", "mannequin", "fabric", "spacing", "pieces", "seams", "contact", "worn", "stages"];
    has(&json, &head);
    has(&json, &["bunched"]);
    let piece = &json["pieces"][1];
    has(piece, &["name", "particles", "triangles", "area_flat", "area_sewn", "area_draped", "area_flattened"]);
    has(piece, &["boundary_flat", "boundary_sewn", "boundary_draped", "boundary_flattened", "stretched"]);
    for errors in ["area_error", "boundary_error", "area_error_raw", "boundary_error_raw"] {
        has(&piece[errors], &["sew", "drape", "flatten", "round_trip"]);
    }
    has(&piece["strain"], &["mean", "p95", "p99", "max"]);
    has(&piece["stretched"], &["by", "why"]);
    has(&json["seams"][0], &["name", "length_a", "length_b", "gap_mean", "gap_max"]);
    let contact = ["inside_body", "deepest", "cloth_body_intersections", "cloth_cloth_intersections"];
    has(&json["contact"], &contact);
    has(&json["worn"][0], &["opening", "body_part"]);
    has(&json["stages"][0], &["name", "seconds", "iterations", "converged", "energy", "drift"]);
}

#[test]
fn openings_have_readable_names() {
    let named = |sets: &[&[(&str, &str)]]| {
        let owned: Vec<Vec<(String, String)>> =
            sets.iter().map(|s| s.iter().map(|(p, e)| (p.to_string(), e.to_string())).collect()).collect();
        opening_names(&owned)
    };
    assert_eq!(named(&[&[("front.L", "neck"), ("front.R", "neck"), ("back", "neck.2")]]), ["neck"]);
    assert_eq!(named(&[&[("sleeve.L", "hem")]]), ["sleeve.L.hem"]);
    assert_eq!(
        named(&[&[("front.L", "hem"), ("back.L", "hem")], &[("front.R", "hem"), ("back.R", "hem")]]),
        ["hem.L", "hem.R"]
    );
    assert_eq!(
        named(&[&[("front", "hem"), ("back", "hem")], &[("lining", "top"), ("a", "hem")], &[]]),
        ["hem", "top + hem", "rim"]
    );
    // The parts of an edge with a dart on either half of a folded back; a pocket on one half.
    let halves: Vec<(&str, &str)> = ["waist.L", "waist.2.L", "waist.2.R", "waist.R"].map(|e| ("back", e)).into();
    assert_eq!(named(&[&halves, &[("front", "pocket.R"), ("front", "pocket.2.R")]]), ["back.waist", "front.R.pocket"]);
    assert_eq!(named(&[&[("front", "hem.R"), ("back.R", "hem")]]), ["hem.R"]);
    assert_eq!(named(&[&[("a", "hem"), ("b", "hem")], &[("c", "hem"), ("d", "hem")]]), ["hem", "hem (2)"]);
    let halves = halves.iter().copied().chain([("front", "pocket.2.R"), ("front.L", "hem"), ("back", "dart.a.L")]);
    assert_eq!(toile::pattern::written_names(halves), ["back.waist", "front.R.pocket", "front.L.hem", "back.L.dart.a"]);
}

#[test]
fn a_garment_can_be_drawn_by_strain() {
    let f = fixture(0.1);
    let at = laid_out(&f, 1.01);
    let strain = vertex_strain(&f.mesh, &at);
    let dressed = Dressed::new(&f.mesh, &f.weld, &at, Some((&strain, Scale::Strain)));
    let scene = dressed.scene(&f.body.mesh, "patch", "nobody · muslin");
    assert_eq!((scene.seams.len(), scene.rims.len(), scene.piece_of_triangle[399]), (1, 1, 1));
    assert_eq!(scene.values.map(|(values, _)| values.len()), Some(231));
    assert!(draw(&scene, &PictureLayout::default()).is_ok_and(|png| png.starts_with(b"\x89PNG")));
}

#[test]
fn strain_for_the_picture_keeps_its_sign() {
    let f = fixture(0.1);
    let strain = vertex_strain(&f.mesh, &laid_out(&f, 0.98));
    assert!(strain[..121].iter().all(|s| (s + 0.02).abs() < 1e-9));
}

#[test]
fn the_obj_shares_seam_vertices_and_keeps_every_flat_position() {
    let f = fixture(0.1);
    let text = garment_obj("patch", &f.mesh, &f.weld, &laid_out(&f, 1.0));
    let count = |start: &str| text.lines().filter(|l| l.starts_with(start)).count();
    assert_eq!((count("v "), count("vt "), count("vn "), count("f ")), (231, 242, 231, 400));
    let groups: Vec<&str> = text.lines().filter(|l| l.starts_with("g ")).collect();
    assert_eq!(groups, ["g front.L", "g back.L"]);
    // Right side towards +z: faces and normals too.
    assert!(text.lines().filter(|l| l.starts_with("vn ")).all(|l| l == "vn 0.000000 0.000000 1.000000"));
    assert!(text.contains("\nvt 100.000000 -100.000000\n"));
    let face: Vec<&str> =
        text.lines().find(|l| l.starts_with("f ")).into_iter().flat_map(str::split_whitespace).collect();
    assert_eq!(face, ["f", "1/1/1", "13/13/13", "2/2/2"]);
}

#[test]
fn a_seam_as_drawn_is_longer_than_its_chords() {
    let mut f = fixture(0.1);
    let span = |piece: usize, to: f64| Span { edge: EdgeId { piece, ring: 0, index: 1 }, from: 0.0, to };
    f.garment.seams.push(Seam {
        name: "side".into(),
        a: vec![span(0, 0.06), span(0, 0.041)],
        b: vec![span(1, 0.1005)],
        marks: vec![],
        give: Give::Even,
        stage: 0,
        kind: SeamKind::Written,
        closure: None,
    });
    let r = measure(&run(&f, &laid_out(&f, 1.0)));
    assert_relative_eq!(r.seams[0].length_a, 101.0, epsilon = 1e-9);
    assert_relative_eq!(r.seams[0].length_b, 100.5, epsilon = 1e-9);
}

/// A fixture garment with these bounds, and its report when everything is as drawn.
fn judged(tests: Vec<Bound>, spoil: impl Fn(&mut Report)) -> Vec<Verdict> {
    let mut f = fixture(0.1);
    let at = laid_out(&f, 1.0);
    f.garment.tests = tests.into_iter().map(|bound| Test { bound, fabric: None, of: None }).collect();
    let mut r = report(&f, &at, &at, &f.mesh.flat);
    spoil(&mut r);
    verdicts(&f.garment, &r)
}

#[test]
fn a_bound_for_one_fabric_holds_in_that_fabric_only() {
    let mut f = fixture(0.1);
    let at = laid_out(&f, 1.0);
    let strict =
        |fabric: Option<&str>| Test { bound: Bound::Crossings(0), fabric: fabric.map(str::to_owned), of: None };
    f.garment.tests = vec![strict(None), strict(Some("denim")), strict(Some("silk"))];
    let mut r = report(&f, &at, &at, &f.mesh.flat);
    r.contact.cloth_cloth_intersections = 1;
    for (fabric, expected) in [("denim", 2), ("rib + silk", 2), ("wool", 1), ("silken", 1)] {
        r.fabric = fabric.to_owned();
        assert_eq!(verdicts(&f.garment, &r).iter().filter(|v| !v.ok).count(), expected, "{fabric}");
    }
    // Where no bound holds, those of a garment without any do.
    f.garment.tests = vec![strict(Some("denim"))];
    assert!(verdicts(&f.garment, &r).iter().any(|v| v.bound == "gap all"));
}

#[test]
fn bounds_take_the_worst_and_leave_out_what_had_to_stretch() {
    let drape = || vec![Bound::Drape { piece: None, area: Some(0.005), boundary: None }];
    let spoil = |r: &mut Report| r.pieces[0].area_error.drape = Some(0.02);
    let verdict = &judged(drape(), spoil)[0];
    assert_eq!((verdict.bound.as_str(), verdict.ok), ("drape all area", false));
    assert_eq!((verdict.measured, verdict.limit, verdict.unit), (2.0, 0.5, "%"));
    assert!(verdict.to_string().contains("2.000 % (limit 0.5 %) at "), "{verdict}");
    let stretched = |r: &mut Report| {
        spoil(r);
        r.pieces[0].stretched = Some(Stretched { by: 0.1, why: "body".into() });
    };
    assert!(judged(drape(), stretched)[0].ok);
    // A stage that did not run is not judged.
    assert!(judged(drape(), |r| r.pieces.iter_mut().for_each(|p| p.area_error.drape = None)).is_empty());
    assert!(!judged(drape(), |r| r.pieces[0].area_error.drape = Some(f64::NAN))[0].ok);
}

#[test]
fn a_garment_without_tests_must_be_closed_and_free_of_crossings() {
    let good = judged(Vec::new(), |_| {});
    assert_eq!(good.iter().map(|v| v.bound.as_str()).collect::<Vec<_>>(), ["gap all", "crossings"]);
    let open = judged(Vec::new(), |r| r.seams[0].gap_max = 1.5);
    assert!(!open[0].ok && open[0].limit == 1.0);
    let inside = judged(Vec::new(), |r| r.contact.inside_body = 3);
    assert_eq!((inside[1].ok, inside[1].at.as_deref()), (false, Some("3 points in the body")));
}
