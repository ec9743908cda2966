//! A [`GarmentFile`] as YAML again.

use serde_yaml::{Mapping, Value as Yaml};

use super::decode_test::LEVEL;
use super::layout::{self, EncodeError};
use crate::pattern::{
    AllowanceFile, AllowanceWidth, AlterationFile, ClosureFile, CutKind, DartFile, DartShape, GarmentFile, LineFile,
    Located, OpenFile, PieceFile, PlaceFile, PleatFile, PleatKind, Quantity, SeamFile, SizeFile, StationFile,
    TestEntry, TestFile, Value,
};

/// Writes the file as YAML that reads as the same [`GarmentFile`].
///
/// # Errors
/// Values that the YAML writer cannot represent. Nothing that was read from a file is one.
pub fn write(file: &GarmentFile) -> Result<String, EncodeError> {
    layout::document(&document(file), &[])
}

/// As [`write()`], with these seams as remarks where seams stand, each after the seam with what is said of it: whoever
/// takes the `#` from a line has the seam.
///
/// # Errors
/// As [`write()`].
pub fn write_with_offers(file: &GarmentFile, offers: &[(SeamFile, String)]) -> Result<String, EncodeError> {
    let line = |(seam, said): &(SeamFile, String)| Ok(format!("  {}   # {said}", seam_line(seam)?));
    let lines: Vec<String> = offers.iter().map(line).collect::<Result<_, EncodeError>>()?;
    let head = ["Seams that may be meant, best first. Take the '#' from 'seams:' and from those that are:", "seams:"];
    let remarks =
        if lines.is_empty() { Vec::new() } else { head.map(str::to_owned).into_iter().chain(lines).collect() };
    layout::document(&document(file), &remarks)
}

/// A seam as one line of a file: `side: {sew: front.side, to: back.side}`.
///
/// # Errors
/// As [`write()`].
pub fn seam_line(own: &SeamFile) -> Result<String, EncodeError> {
    Ok(format!("{}: {}", own.name.value, layout::flow(&seam(own))?))
}

/// An alteration as one line of a file: `{take_in: side, at: {50 %: 8}}`.
///
/// # Errors
/// As [`write()`].
pub fn alteration_line(own: &AlterationFile) -> Result<String, EncodeError> {
    layout::flow(&alteration(own))
}

fn document(file: &GarmentFile) -> Yaml {
    let mut map = YamlMap::default();
    map.put("garment", file.version.value);
    map.text("name", &file.name);
    map.nodes(&file.about);
    map.some("units", file.units.as_ref().map(|u| u.value.symbol()));
    if file.body_measures.is_empty() {
        map.text("body", &file.body);
    } else {
        let mut body = YamlMap::default();
        body.text("like", &file.body);
        file.body_measures.iter().for_each(|(name, q)| body.quantity(&name.value, &Some(*q)));
        map.put("body", body);
    }
    map.some("body_units", file.body_units.as_ref().map(|u| u.value.symbol()));
    map.quantity("allowance", &file.allowance);
    map.filled("fabrics", nodes(&file.fabrics));
    map.filled("pieces", named(&file.pieces, |p| (&p.name, piece(p))));
    map.filled("seams", named(&file.seams, |s| (&s.name, seam(s))));
    map.list("closures", &file.closures, closure);
    map.list("free", &file.free, |f| f.value.as_str().into());
    map.list("tests", &file.tests, |t| test_entry(&t.value));
    map.list("alter", &file.alter, |a| alteration(&a.value));
    map.filled("sizes", named(&file.sizes, |s| (&s.name, size(s))));
    map.into()
}

/// A YAML mapping under construction; absent things leave no key.
#[derive(Default)]
struct YamlMap(Mapping);

impl YamlMap {
    fn put(&mut self, key: &str, value: impl Into<Yaml>) {
        self.0.insert(key.into(), value.into());
    }

    fn some(&mut self, key: &str, value: Option<impl Into<Yaml>>) {
        if let Some(value) = value {
            self.put(key, value);
        }
    }

    fn text(&mut self, key: &str, value: &Option<Located<String>>) {
        self.some(key, value.as_ref().map(|v| v.value.as_str()));
    }

    fn quantity(&mut self, key: &str, value: &Option<Located<Quantity>>) {
        self.some(key, value.as_ref().map(|q| quantity(q.value)));
    }

    fn number(&mut self, key: &str, value: &Option<Located<f64>>) {
        self.some(key, value.as_ref().map(|n| number(n.value)));
    }

    fn list<T>(&mut self, key: &str, items: &[T], item: impl Fn(&T) -> Yaml) {
        if !items.is_empty() {
            self.put(key, Yaml::Sequence(items.iter().map(item).collect()));
        }
    }

    fn filled(&mut self, key: &str, map: Self) {
        if !map.0.is_empty() {
            self.put(key, Yaml::Mapping(map.0));
        }
    }

    fn nodes(&mut self, entries: &[(Located<String>, Located<Value>)]) {
        self.0.extend(nodes(entries).0);
    }
}

impl From<YamlMap> for Yaml {
    fn from(map: YamlMap) -> Self {
        Self::Mapping(map.0)
    }
}

fn nodes(entries: &[(Located<String>, Located<Value>)]) -> YamlMap {
    named(entries, |(k, v)| (k, node(&v.value)))
}

fn named<T>(items: &[T], entry: impl Fn(&T) -> (&Located<String>, Yaml)) -> YamlMap {
    let mut map = YamlMap::default();
    for item in items {
        let (key, value) = entry(item);
        map.put(&key.value, value);
    }
    map
}

fn node(value: &Value) -> Yaml {
    match value {
        Value::Text(text) => text.as_str().into(),
        Value::List(items) => Yaml::Sequence(items.iter().map(|i| node(&i.value)).collect()),
        Value::Map(entries) => nodes(entries).into(),
    }
}

/// Whole numbers without a decimal point, as people write them.
fn number(n: f64) -> Yaml {
    if n.fract() == 0.0 && n.abs() < 1e15 { (n as i64).into() } else { n.into() }
}

fn numbers(list: &[f64]) -> Yaml {
    Yaml::Sequence(list.iter().map(|&n| number(n)).collect())
}

fn quantity(q: Quantity) -> Yaml {
    q.unit.map_or_else(|| number(q.number), |u| format!("{} {}", q.number, u.symbol()).into())
}

fn allowance(of: AllowanceWidth) -> Yaml {
    match of.corner {
        None => quantity(of.width),
        Some(corner) => {
            let unit = of.width.unit.map_or_else(String::new, |u| format!(" {}", u.symbol()));
            format!("{}{unit} {}", of.width.number, corner.word()).into()
        }
    }
}

fn piece(piece: &PieceFile) -> Yaml {
    let mut map = YamlMap::default();
    map.text("like", &piece.like);
    map.text("fabric", &piece.fabric);
    map.some("cut", piece.cut.as_ref().map(|c| cut(&c.value)));
    map.some("drawn", piece.drawn.as_ref().map(|d| d.value.letter()));
    map.some("layer", piece.layer.as_ref().map(|l| l.value));
    match &piece.allowance {
        Some(AllowanceFile::All(q)) => map.put("allowance", allowance(q.value)),
        Some(AllowanceFile::Edges(edges)) => {
            map.put("allowance", named(edges, |(k, q)| (k, allowance(q.value))));
        }
        None => {}
    }
    map.some("grain", piece.grain.as_ref().map(|g| Yaml::Sequence(g.value.iter().map(|p| numbers(p)).collect())));
    map.some("place", piece.place.as_ref().map(|p| place(&p.value)));
    if let Some(outline) = &piece.outline {
        let mut edges = YamlMap::default();
        let [x, y] = outline.start.value;
        edges.put("start", format!("{x} {y}"));
        edges.0.extend(named(&outline.edges, |(k, v)| (k, v.value.as_str().into())).0);
        map.put("outline", edges);
    }
    map.filled(
        "notches",
        named(&piece.notches, |(k, list)| {
            let mark = |n: &Located<crate::pattern::NotchFile>| match (n.value.double, n.value.at.unit) {
                (false, _) => quantity(n.value.at),
                (true, None) => format!("{} double", n.value.at.number).into(),
                (true, Some(unit)) => format!("{} {} double", n.value.at.number, unit.symbol()).into(),
            };
            (k, Yaml::Sequence(list.iter().map(mark).collect()))
        }),
    );
    map.list("darts", &piece.darts, dart);
    map.list("pleats", &piece.pleats, pleat);
    map.filled("holes", named(&piece.holes, |(k, v)| (k, v.value.as_str().into())));
    map.filled("lines", named(&piece.lines, |l| (&l.name, line(l))));
    map.text("note", &piece.note);
    map.into()
}

fn cut(cut: &CutKind) -> Yaml {
    match cut {
        CutKind::One => "one".into(),
        CutKind::Pair => "pair".into(),
        CutKind::Fold(edge) => format!("fold {edge}").into(),
        CutKind::Count(n) => (*n as u64).into(),
    }
}

fn place(place: &PlaceFile) -> Yaml {
    match place {
        PlaceFile::Words(words) => words.as_str().into(),
        PlaceFile::At { at, turn } => {
            let mut map = YamlMap::default();
            map.put("at", numbers(at));
            map.some("turn", turn.as_ref().map(|t| numbers(t)));
            map.into()
        }
    }
}

fn dart(dart: &DartFile) -> Yaml {
    let mut map = YamlMap::default();
    map.text("name", &dart.name);
    map.put("intake", quantity(dart.intake.value));
    match &dart.shape {
        DartShape::Edge { edge, at, length, tip } => {
            map.put("edge", edge.value.as_str());
            map.put("at", quantity(at.value));
            map.quantity("length", length);
            map.some("tip", tip.as_ref().map(|t| numbers(&t.value)));
        }
        DartShape::FishEye { at, up, down } => {
            map.put("at", numbers(&at.value));
            map.put("up", quantity(up.value));
            map.put("down", quantity(down.value));
        }
    }
    map.into()
}

fn pleat(pleat: &PleatFile) -> Yaml {
    let mut map = YamlMap::default();
    map.put("edge", pleat.edge.value.as_str());
    map.list("at", &pleat.at, |q| quantity(q.value));
    map.put("depth", quantity(pleat.depth.value));
    let kind = |k: PleatKind| match k {
        PleatKind::Knife => "knife",
        PleatKind::Box => "box",
        PleatKind::Inverted => "inverted",
    };
    map.some("kind", pleat.kind.as_ref().map(|k| kind(k.value)));
    map.text("toward", &pleat.toward);
    map.quantity("sewn", &pleat.sewn);
    map.into()
}

fn line(line: &LineFile) -> Yaml {
    let mut map = YamlMap::default();
    map.put("path", line.path.value.as_str());
    map.number("fold", &line.fold);
    map.text("kind", &line.kind);
    map.number("ratio", &line.ratio);
    map.into()
}

/// One edge alone, several as a list.
fn chain(edges: &[Located<String>]) -> Yaml {
    match edges {
        [one] => one.value.as_str().into(),
        many => Yaml::Sequence(many.iter().map(|e| e.value.as_str().into()).collect()),
    }
}

fn seam(seam: &SeamFile) -> Yaml {
    let mut map = YamlMap::default();
    map.put("sew", chain(&seam.sew));
    map.put("to", chain(&seam.to));
    map.quantity("ease", &seam.ease);
    map.number("gather", &seam.gather);
    map.number("stretch", &seam.stretch);
    map.quantity("tolerance", &seam.tolerance);
    match seam.open.as_slice() {
        [] => {}
        [one] => map.put("open", open(one)),
        many => map.list("open", many, open),
    }
    map.text("closure", &seam.closure);
    map.some("face", seam.face_same.as_ref().map(|f| if f.value { "same" } else { "opposite" }));
    map.some("match", seam.match_notches.as_ref().map(|m| if m.value { "notches" } else { "length" }));
    map.some("stage", seam.stage.as_ref().map(|s| s.value));
    map.some("layers", seam.layers.as_ref().map(|l| Yaml::Sequence(l.value.iter().map(|&n| n.into()).collect())));
    map.quantity("allowance", &seam.allowance);
    map.text("note", &seam.note);
    map.into()
}

fn open(open: &OpenFile) -> Yaml {
    let mut map = YamlMap::default();
    map.put("from", open.from.value.as_str());
    map.put("length", quantity(open.length.value));
    map.text("closure", &open.closure);
    map.into()
}

fn closure(closure: &ClosureFile) -> Yaml {
    let mut map = YamlMap::default();
    map.put("kind", closure.kind.value.as_str());
    map.text("piece", &closure.on);
    map.list("at", &closure.at, |p| numbers(&p.value));
    map.text("meets", &closure.meets);
    map.list("meets_at", &closure.meets_at, |p| numbers(&p.value));
    map.quantity("pitch", &closure.pitch);
    map.some("count", closure.count.as_ref().map(|c| c.value as u64));
    map.nodes(&closure.hardware);
    map.into()
}

fn size(size: &SizeFile) -> Yaml {
    Yaml::Sequence(size.alter.iter().map(|a| alteration(&a.value)).collect())
}

fn alteration(of: &AlterationFile) -> Yaml {
    let mut map = YamlMap::default();
    match of {
        AlterationFile::Take { seam, at, out } => {
            map.put(if *out { "let_out" } else { "take_in" }, seam.value.as_str());
            map.put("at", stations(at, |amount| quantity(*amount)));
        }
        AlterationFile::Lengthen { pieces, at, by, over, across, shorter } => {
            map.put(if *shorter { "shorten" } else { "lengthen" }, chain(pieces));
            map.put("at", quantity(at.value));
            map.put("by", quantity(by.value));
            map.quantity("over", over);
            map.some("along", across.as_ref().map(|a| if a.value { "x" } else { "y" }));
        }
        AlterationFile::Pivot { dart, to, share, name } => {
            map.put("pivot", dart.value.as_str());
            map.put("to", to.value.as_str());
            map.quantity("share", share);
            map.text("name", name);
        }
        AlterationFile::Spread { from, to, by, to_by } => {
            map.put("spread", from.value.as_str());
            map.put("to", to.value.as_str());
            map.put("by", quantity(by.value));
            map.quantity("to_by", to_by);
        }
        AlterationFile::Fullness { edge, to, by, to_by, slashes } => {
            map.put("fullness", edge.value.as_str());
            map.put("to", to.value.as_str());
            map.put("by", quantity(by.value));
            map.quantity("to_by", to_by);
            map.some("slashes", slashes.as_ref().map(|n| n.value as u64));
        }
        AlterationFile::Join { seam } => map.put("join", seam.value.as_str()),
        AlterationFile::Cut { from, to, via, name, seam } => {
            map.put("cut", from.value.as_str());
            map.put("to", to.value.as_str());
            map.list("via", via, |p| numbers(&p.value));
            map.put("name", name.value.as_str());
            map.text("seam", seam);
        }
        AlterationFile::Move { edge, at } => {
            map.put("move", edge.value.as_str());
            map.put("at", stations(at, |by| numbers(by)));
        }
    }
    map.into()
}

fn stations<T>(at: &[StationFile<T>], amount: impl Fn(&T) -> Yaml) -> Yaml {
    let entry = |(at, by): &StationFile<T>| (quantity(at.value), amount(&by.value));
    Yaml::Mapping(at.iter().map(entry).collect())
}

fn test_entry(entry: &TestEntry) -> Yaml {
    let mut map = test(&entry.test);
    map.text("fabric", &entry.fabric);
    map.into()
}

fn test(test: &TestFile) -> YamlMap {
    let mut map = YamlMap::default();
    match test {
        TestFile::Seam(name, limit) => {
            map.put("seam", name.value.as_str());
            map.put("length", quantity(limit.value));
        }
        TestFile::Gap(name, limit) => {
            map.put("gap", name.value.as_str());
            map.put("below", quantity(limit.value));
        }
        TestFile::Closure(kind, limit) => {
            map.put("closure", kind.value.as_str());
            map.put("below", quantity(limit.value));
        }
        TestFile::Flatten(name, area, boundary) | TestFile::Drape(name, area, boundary) => {
            map.put(if matches!(test, TestFile::Drape(..)) { "drape" } else { "flatten" }, name.value.as_str());
            map.quantity("area", area);
            map.quantity("boundary", boundary);
        }
        TestFile::Crossings(most) => map.put("crossings", *most as u64),
        TestFile::Openings(expected) => map.put("openings", *expected as u64),
        TestFile::Worn => map.put("worn", true),
        TestFile::Ease(girth, from, to) => {
            map.put("ease", girth.value.as_str());
            map.quantity("from", from);
            map.quantity("to", to);
        }
        TestFile::Pressure(girth, below) => {
            map.put("pressure", girth.value.as_str());
            map.put("below", format!("{} kPa", below.value));
        }
        TestFile::HemLevel(within) => {
            let Quantity { number, unit } = within.value;
            let unit = unit.map_or_else(String::new, |unit| format!(" {}", unit.symbol()));
            map.put("hem", format!("{LEVEL} {number}{unit}"));
        }
    }
    map
}
