//! The shipped fabrics, fabric files and inline fabrics.

use approx::assert_relative_eq;
use std::path::Path;
use toile::fabric::{Context, Fabric, FabricError, FabricSpec, library, load, resolve, sheet};

fn context<'a>(garment: &'a [(String, FabricSpec)], folder: &'a Path) -> Context<'a> {
    Context { name: "shell", folder, garment, given: None }
}

fn spec(base: Option<&str>, values: &[(&str, &str)]) -> FabricSpec {
    FabricSpec {
        base: base.map(str::to_owned),
        values: values.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect(),
    }
}

fn read(base: Option<&str>, values: &[(&str, &str)]) -> Result<Fabric, FabricError> {
    resolve(&spec(base, values), &context(&[], Path::new("")))
}

/// Weight and bending, which have no default.
const LEAST: [(&str, &str); 2] = [("weight", "70 g/m2"), ("bend", "0.03 gf.cm2/cm")];

#[test]
fn every_shipped_fabric_loads_and_names_every_source() {
    assert_eq!(library().len(), 17);
    for name in library() {
        let fabric = load(name).expect(name);
        assert_eq!(fabric.name, name);
        assert!(fabric.defaults.is_empty(), "{name}: {:?}", fabric.defaults);
        assert!((0.25..=0.5).contains(&fabric.friction), "{name}");
        let sheet = sheet(name).expect(name);
        for m in &sheet.measurements {
            assert!(m.source.is_some(), "{name} {}", m.key);
            assert!(m.uncertainty.is_some() || m.key == "drape", "{name} {}", m.key);
        }
    }
}

#[test]
fn bending_lengths_are_those_of_the_table() {
    // Rounded to a millimetre there.
    for (name, c) in [
        ("fine_cotton", 17.0),
        ("denim", 29.0),
        ("canvas", 27.0),
        ("linen", 21.0),
        ("ramie", 23.0),
        ("silk_charmeuse", 16.0),
        ("cotton_poplin", 22.0),
        ("chiffon", 14.0),
        ("nylon_spandex_knit", 29.0),
        ("polyester", 25.0),
        ("nylon_taffeta", 19.0),
        ("gabardine", 18.0),
        ("garment_leather", 26.0),
        ("wool_suiting", 15.0),
        ("velvet", 17.0),
    ] {
        let fabric = load(name).expect(name);
        let mean = fabric.bending_length_mean() * 1e3;
        assert!((mean - c).abs() < 0.75, "{name}: {mean:.2} mm, {c} in the table");
        let (warp, weft) = (fabric.bending_length_warp(), fabric.bending_length_weft());
        assert!(warp.min(weft) <= mean * 1e-3 * 1.000_001 && mean * 1e-3 <= warp.max(weft) * 1.000_001);
    }
}

#[test]
fn lius_published_weights_are_those_of_equation_8() {
    for (i, name) in library().into_iter().take(15).enumerate() {
        let liu = sheet(name).expect(name).liu.expect(name);
        assert_eq!(liu.sample.map(usize::from), Some(i), "{name}");
        let off = match i {
            10 => 0.16,
            11 => 0.59,
            12 => 0.06,
            _ => 0.02,
        };
        for (ours, published) in liu.recomputed_weights().iter().zip(liu.weights) {
            assert!((ours - published).abs() < off, "{name}: {ours} and {published}");
        }
    }
    assert!(sheet("jersey").expect("jersey").liu.is_none());
}

/// Where the published weights and what was measured say different things, the file says both.
#[test]
fn fabrics_whose_weights_and_physics_disagree_say_so() {
    for name in library().into_iter().take(15) {
        let (sheet, fabric) = (sheet(name).expect(name), load(name).expect(name));
        let lengths = [sheet.liu.expect(name).fallback_bending_length(), fabric.bending_length_mean()].map(|c| 1e3 * c);
        let rigidities = (lengths[0] / lengths[1]).powi(3);
        if (0.5..2.0).contains(&rigidities) {
            continue;
        }
        let note = sheet.note.unwrap_or_default();
        for c in lengths {
            let said = [format!(" {c:.0} mm"), format!(" {c:.1} mm")];
            assert!(said.iter().any(|s| note.contains(s.as_str())), "{name}, {c:.2} mm: {note}");
        }
    }
}

#[test]
fn a_jersey_gives_and_a_poplin_does_not() {
    let per_metre_of_hanging = |f: &Fabric| {
        let weight = f.areal_density * 9.81;
        let curve = &f.weft;
        (0..1000).map(|i| f64::from(i) * 1e-4).find(|&e| curve.load(e) > weight).expect("it carries its weight")
    };
    assert!(per_metre_of_hanging(&load("jersey").expect("jersey")) > 0.005);
    assert!(per_metre_of_hanging(&load("cotton_poplin").expect("poplin")) < 0.003);
}

#[test]
fn inline_values_are_read_with_their_units() {
    let nested = "{warp: {EMT: 4 %, LT: 1}, weft: {EMT: 5 %, LT: 0.7}}";
    let values = [LEAST[0], LEAST[1], ("shear", "0.4 gf/cm.deg"), ("tensile", nested)];
    let fabric = read(None, &values).expect("fabric");
    assert_relative_eq!(fabric.areal_density, 0.07);
    assert_relative_eq!(fabric.bend_weft, 2.941995e-6, max_relative = 1e-9);
    assert_relative_eq!(fabric.shear, 22.475, max_relative = 1e-4);
    assert_relative_eq!(fabric.warp.load(0.02), 245.166, max_relative = 1e-4);
    assert_relative_eq!(fabric.weft.load(0.05), 490.3325, max_relative = 1e-6);
    assert_eq!(fabric.defaults, ["thickness", "friction"]);
    // The same, with flat keys.
    let flat = [
        LEAST[0],
        LEAST[1],
        ("shear", "0.4 gf/cm.deg"),
        ("tensile.warp.EMT", "4 %"),
        ("tensile.warp.LT", "1"),
        ("tensile.weft.EMT", "5 %"),
        ("tensile.weft.LT", "0.7"),
    ];
    assert_eq!(read(None, &flat).expect("fabric"), fabric);
}

#[test]
fn what_is_not_measured_is_listed() {
    let fabric = read(None, &LEAST).expect("fabric");
    assert_eq!(fabric.defaults, ["tensile", "thickness", "shear", "friction"]);
    let one = [LEAST[0], ("bend.warp", "3 uN.m"), ("tensile.warp.EMT", "4 %")];
    let fabric = read(None, &one).expect("fabric");
    assert_eq!(fabric.bend_weft, fabric.bend_warp);
    assert_eq!(fabric.weft, fabric.warp);
    assert!(["bend.weft", "tensile.warp.LT", "tensile.weft"].iter().all(|k| fabric.defaults.iter().any(|d| d == k)));
}

#[test]
fn what_is_written_over_an_assumed_value_is_no_longer_listed() {
    let garment = [("base".to_owned(), spec(None, &LEAST))];
    let over = |values: &[(&str, &str)]| {
        let on_base = spec(Some("base"), values);
        resolve(&on_base, &Context { name: "top", ..context(&garment, Path::new("")) }).expect("fabric").defaults
    };
    assert_eq!(over(&[("friction", "0.3")]), ["tensile", "thickness", "shear"]);
    assert_eq!(over(&[("tensile", "{EMT: 4 %, LT: 0.6}")]), ["thickness", "shear", "friction"]);
    let one = ["thickness", "shear", "friction", "tensile.weft"];
    assert_eq!(over(&[("tensile.warp", "{EMT: 4 %, LT: 0.6}")]), one);
}

#[test]
fn fabrics_based_on_one_another_for_ever_are_refused() {
    let next = |k: usize| (format!("f{k}"), spec(Some(&format!("f{}", k + 1)), &[]));
    let chain: Vec<_> = (0..2000).map(next).collect();
    let error = resolve(&chain[0].1, &Context { name: "f0", ..context(&chain, Path::new("")) }).expect_err("deep");
    assert!(matches!(error, FabricError::Deep { .. }) && error.to_string().contains("100 fabrics"), "{error}");
}

#[test]
fn plain_numbers_multiply_the_base() {
    let poplin = load("cotton_poplin").expect("poplin");
    let stiff = read(Some("cotton_poplin"), &[("bend", "2.5"), ("tensile", "2"), ("friction", "0.2")]).expect("stiff");
    assert_relative_eq!(stiff.bend_warp, 2.5 * poplin.bend_warp);
    assert_relative_eq!(stiff.warp.load(0.01), 2.0 * poplin.warp.load(0.01));
    assert_eq!((stiff.areal_density, stiff.friction), (poplin.areal_density, 0.2));
    assert!(stiff.source.starts_with("cotton_poplin, changed"));
    // A base that is another fabric of the garment.
    let garment = [("shell".to_owned(), spec(Some("shell2"), &[])), ("shell2".to_owned(), spec(Some("denim"), &[]))];
    let fuse = spec(Some("shell"), &[("bend", "2")]);
    let fuse = resolve(&fuse, &Context { name: "fuse", ..context(&garment, Path::new("")) }).expect("fuse");
    assert_relative_eq!(fuse.bend_warp, 2.0 * load("denim").expect("denim").bend_warp);
    assert_eq!(fuse.name, "fuse");
}

#[test]
fn a_base_that_leads_back_is_refused() {
    let garment = [("shell".to_owned(), spec(Some("a"), &[])), ("a".to_owned(), spec(Some("b"), &[])), {
        ("b".to_owned(), spec(Some("a"), &[]))
    }];
    let error = resolve(&garment[0].1, &context(&garment, Path::new(""))).expect_err("a cycle");
    assert_eq!(error, FabricError::Cycle { fabric: "a".to_owned() });
}

#[test]
fn files_lie_beside_the_garment() {
    let folder = tempfile::tempdir().expect("folder");
    std::fs::create_dir(folder.path().join("kes")).expect("folder");
    std::fs::write(folder.path().join("kes/warp.csv"), "strain %, load gf/cm\n1, 100\n3, 500\n").expect("file");
    std::fs::write(folder.path().join("kes/falls.csv"), "1, 100\n3, 92\n").expect("file");
    let text = "weight: 100 g/m2\nbend: 5 uN.m\ntensile: {warp: kes/warp.csv}\n";
    std::fs::write(folder.path().join("mine.yaml"), text).expect("file");
    let with = |base: Option<&str>, values: &[(&str, &str)]| resolve(&spec(base, values), &context(&[], folder.path()));
    let fabric = with(Some("mine.yaml"), &[]).expect("mine");
    assert_eq!(fabric.name, "mine");
    assert_relative_eq!(fabric.warp.load(0.03), 490.3325, max_relative = 1e-9);
    let error = with(None, &[LEAST[0], LEAST[1], ("tensile.weft", "kes/falls.csv")]).expect_err("falls").to_string();
    assert!(error.contains("kes/falls.csv, row 2: load falls from 100 to 92; curves must rise"), "{error}");
    let error = with(None, &[LEAST[0], LEAST[1], ("tensile.weft", "kes/none.csv")]).expect_err("no such file");
    assert!(matches!(error, FabricError::Read { .. }));
}

#[test]
fn errors_say_what_was_expected() {
    let said = |base: Option<&str>, values: &[(&str, &str)]| read(base, values).expect_err("wrong").to_string();
    let unknown = said(Some("coton_poplin"), &[]);
    assert!(unknown.contains("did you mean 'cotton_poplin'?") && unknown.contains("velvet, jersey, rib"), "{unknown}");
    assert!(said(Some("poplin"), &[]).contains("did you mean 'cotton_poplin'?"));
    assert!(!said(Some("xyz"), &[]).contains("did you mean"));
    assert_eq!(said(None, &[LEAST[0]]), "fabric 'shell' has no bend value; give bend in gf.cm2/cm, uN.m, mN.mm or N.m");
    assert_eq!(
        said(None, &[("weight", "70"), LEAST[1]]),
        "fabric 'shell': cannot read weight '70'; expected a number in g/m2, kg/m2, mg/cm2 or oz/yd2"
    );
    assert!(said(Some("denim"), &[("bend", "hard")]).contains("or a factor on the base"));
    assert!(said(None, &[LEAST[0], ("bend", "NaN uN.m")]).contains("cannot read bend"));
    assert!(said(None, &[LEAST[0], ("bend", "inf.uN.m")]).contains("cannot read bend"));
    assert!(said(None, &[LEAST[0], ("bend", "1e400 uN.m")]).contains("out of range"));
    assert!(said(None, &[LEAST[0], ("bend", "-3 uN.m")]).contains("out of range"));
    assert!(said(Some("denim"), &[("bend", "nan")]).contains("out of range"));
    assert!(said(None, &[LEAST[0], LEAST[1], ("wieght", "3")]).contains("no value 'wieght'; it may have weight"));
    assert!(said(None, &[LEAST[0], LEAST[1], ("tensile.warp.LT", "0.7")]).contains("has no tensile.warp.EMT"));
    assert!(said(None, &[LEAST[0], LEAST[1], ("tensile", "{warp: [")]).contains("tensile"));
    let both = said(None, &[LEAST[0], LEAST[1], ("tensile", "{warp: {EMT: 5 %, curve: '1:10'}}")]);
    assert!(both.contains("tensile.warp.EMT '5 %' is said in other words too; tensile.warp.curve says"), "{both}");
}

#[test]
fn values_of_no_cloth_are_refused() {
    for (key, text, why) in [
        ("weight", "900 kg/m2", "between 0.001 and 10 kg/m2"),
        ("weight", "1e-9 g/m2", "between 0.001 and 10 kg/m2"),
        ("thickness", "1 m", "between 1e-6 and 0.03 m"),
        ("bend", "900 N.m", "between 1e-9 and 0.1 N.m"),
        ("shear", "1e9 N/m", "between 0.001 and 1e5 N/m"),
        ("friction", "nan", "between 0 and 2"),
        ("friction", "4", "between 0 and 2"),
    ] {
        let error = read(Some("denim"), &[(key, text)]).expect_err(text).to_string();
        assert!(error.contains(why) && error.contains(text), "{error}");
    }
    let own = [("shell".to_owned(), spec(Some("shell"), &[("weight", "70 g/m2")]))];
    let error = resolve(&own[0].1, &context(&own, Path::new("")));
    assert!(matches!(error, Err(FabricError::Cycle { .. })), "{error:?}");
}
