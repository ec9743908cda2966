//! Everything put together as a garment file.

use super::drawing::number;
use super::edges::{Partner, Subject};
use super::error::ImportError;
use super::pieces::{FilePiece, PanelFacts, part, pieces};
use super::role::{PanelFacing, PanelRole, unique};
use super::seams::{Joined, StitchedEdge, StitchedEdges};
use super::short::KEPT;
use super::spec::{PanelEdge, Specification};
use crate::geometry::Path;
use crate::pattern::{
    CutKind, DEFAULT_CLOTH, GarmentFile, Located, OutlineFile, PieceFile, PlaceFile, PlaceWord, Quantity, SeamFile,
    Side, Spot, TestEntry, TestFile, Unit, Value,
};

/// The garment file of a specification.
pub(super) fn garment(name: &str, spec: &Specification, body: Option<&str>) -> Result<GarmentFile, ImportError> {
    let parts = spec.panels.iter().enumerate().map(|(i, panel)| {
        part(spec, i).ok_or_else(|| ImportError::Panel { panel: panel.name.clone(), reason: "encloses no area".into() })
    });
    let parts = parts.collect::<Result<Vec<PanelFacts>, ImportError>>()?;
    let pieces = pieces(spec, &parts);
    let lengths: Vec<Vec<f64>> =
        pieces.iter().map(|p| parts[p.panel].drawing.edges.iter().map(PanelEdge::length).collect()).collect();
    let sides: Vec<Option<Side>> = parts.iter().map(|p| p.side).collect();
    let table = StitchedEdges { spec, pieces: &pieces, sides: &sides, lengths: &lengths };
    let names: Vec<Vec<String>> = pieces.iter().map(|p| edge_names(&table, &parts, p)).collect();
    let writer = Writer { table: &table, parts: &parts, names: &names };
    let seams = table.seams();
    let at = Spot::default();
    Ok(GarmentFile {
        alter: Vec::new(),
        sizes: Vec::new(),
        version: Located::new(1, at),
        name: Some(here(name.replace('_', " "))),
        about: vec![(here("source".to_owned()), here(Value::Text("GarmentCode pattern specification".to_owned())))],
        units: None,
        body: body.map(|b| here(b.to_owned())),
        body_measures: Vec::new(),
        body_units: None,
        allowance: None,
        fabrics: vec![(here("shell".to_owned()), here(Value::Text(DEFAULT_CLOTH.to_owned())))],
        pieces: pieces.iter().enumerate().map(|(i, p)| writer.piece(p, &names[i])).collect(),
        free: writer.free(&seams),
        seams: writer.seams(&seams),
        closures: Vec::new(),
        tests: [
            TestFile::Gap(here("all".to_owned()), here(millimetres(1.0, Some(Unit::Millimetre)))),
            TestFile::Crossings(0),
            TestFile::Worn,
        ]
        .map(|test| here(TestEntry { test, fabric: None }))
        .into(),
    })
}

fn here<T>(value: T) -> Located<T> {
    Located::new(value, Spot::default())
}

fn millimetres(number: f64, unit: Option<Unit>) -> Quantity {
    Quantity { number, unit }
}

/// Names of the edges of a piece's drawing.
fn edge_names(table: &StitchedEdges, parts: &[PanelFacts], piece: &FilePiece) -> Vec<String> {
    let own = &parts[piece.panel];
    let count = own.drawing.edges.len();
    let mut partners: Vec<Option<Partner>> = vec![None; count];
    for stitch in &table.spec.stitches {
        for [here, there] in [stitch.ends, [stitch.ends[1], stitch.ends[0]]] {
            if here.0 == piece.panel {
                let other = &parts[there.0];
                partners[count - 1 - here.1] = Some(Partner {
                    role: other.role,
                    facing: other.facing,
                    own: there.0 == here.0,
                    across: other.side.is_some() && own.side.is_some() && other.side != own.side,
                });
            }
        }
    }
    let pair = piece.twin.is_some();
    Subject { drawing: &own.drawing, role: own.role, facing: own.facing, pair, partners: &partners }.names()
}

/// Decimals tried.
const DECIMALS: std::ops::RangeInclusive<usize> = 3..=8;

/// An outline in as few decimals as keep its lengths.
fn outline(edges: &[PanelEdge], names: &[String]) -> OutlineFile {
    let written = |decimals: usize| edges.iter().map(|e| e.commands(decimals)).collect::<Vec<String>>();
    let round = |x: f64, decimals: usize| number(x, decimals).parse().unwrap_or(x);
    let kept = |decimals: &usize| {
        edges.iter().zip(written(*decimals)).all(|(edge, text)| {
            let start = edge.start.map(|x| round(x, *decimals));
            Path::parse(start, &text, 1.0).is_ok_and(|p| (p.length() - edge.length()).abs() < KEPT)
        })
    };
    let decimals = DECIMALS.into_iter().find(kept).unwrap_or(*DECIMALS.end());
    let start = edges.first().map_or([0.0; 2], |e| [e.start.x, e.start.y].map(|x| round(x, decimals)));
    let edges = names.iter().cloned().map(here).zip(written(decimals).into_iter().map(here)).collect();
    OutlineFile { start: here(start), edges }
}

/// A panel whose right side looks up or down by less (cosine) stands upright.
const UPRIGHT: f64 = 0.5;

struct Writer<'a> {
    table: &'a StitchedEdges<'a>,
    parts: &'a [PanelFacts],
    names: &'a [Vec<String>],
}

impl Writer<'_> {
    fn piece(&self, piece: &FilePiece, names: &[String]) -> PieceFile {
        let part = &self.parts[piece.panel];
        let drawn = part.side.filter(|_| piece.twin.is_some());
        let middle = part.drawing.middle();
        let round = |x: f64| x.round();
        PieceFile {
            cut: piece.twin.map(|_| here(CutKind::Pair)),
            drawn: drawn.map(here),
            layer: Some(piece.layer).filter(|&l| l != 0).map(here),
            grain: Some(here([[round(middle.x), round(middle.y - GRAIN)], [round(middle.x), round(middle.y + GRAIN)]])),
            place: Some(here(self.place(piece))),
            outline: Some(outline(&part.drawing.edges, names)),
            ..PieceFile::named(here(piece.name.clone()))
        }
    }

    /// In words where there are words for it.
    fn place(&self, piece: &FilePiece) -> PlaceFile {
        let part = &self.parts[piece.panel];
        // A panel at the side of a skirt looks neither forward nor back, and goes round the body with the others.
        let beside = part.role.round_trunk() && part.drawing.normal.y.abs() < UPRIGHT;
        let words = part.role.body_part().filter(|_| part.facing.is_some() || beside).map(|body| {
            let side = part.side.filter(|_| part.role.round_arm() && piece.twin.is_none()).map(|s| match s {
                Side::Left => PlaceWord::Left,
                Side::Right => PlaceWord::Right,
            });
            let words = [side, Some(body), part.facing.map(PanelFacing::word)].into_iter().flatten();
            words.map(PlaceWord::name).collect::<Vec<&str>>().join(" ")
        });
        words.map_or_else(
            || {
                let round = |x: f64| (10.0 * x).round() / 10.0 + 0.0;
                let (at, turn) = (part.drawing.at.map(round), part.drawing.turn.map(round));
                PlaceFile::At { at: at.into(), turn: Some(turn.into()) }
            },
            PlaceFile::Words,
        )
    }

    fn reference(&self, place: StitchedEdge, both_sides: bool) -> Located<String> {
        let piece = &self.table.pieces[place.piece].name;
        let side = place.side.filter(|_| !both_sides).map_or("", Side::suffix);
        here(format!("{piece}{side}.{}", self.names[place.piece][place.edge]))
    }

    fn seams(&self, seams: &[Joined]) -> Vec<SeamFile> {
        let mut names: Vec<String> = Vec::new();
        let wanted: Vec<String> = seams.iter().map(|s| self.seam_name(s)).collect();
        let mut out = Vec::new();
        for (seam, name) in seams.iter().zip(&wanted) {
            // Of several seams of a name, each says what it is on.
            let several = wanted.iter().filter(|w| *w == name).count() > 1;
            let name = if several { self.longer_name(seam, name) } else { name.clone() };
            let name = unique(&name, &names);
            names.push(name.clone());
            out.push(self.seam(seam, name));
        }
        out
    }

    fn seam(&self, seam: &Joined, name: String) -> SeamFile {
        let (mut a, mut b) = (&seam.a, &seam.b);
        // The longer one is gathered or has the ease.
        let (mut la, mut lb) = (self.table.length(a), self.table.length(b));
        let unequal = (la - lb).abs() > EVEN;
        let gathered = unequal && (la - lb).abs() > LARGEST_EASE * la.min(lb);
        if unequal && gathered != (la > lb) {
            (a, b) = (b, a);
            (la, lb) = (lb, la);
        }
        let own_mirror = seam.both_sides && a.iter().zip(b).all(|(a, b)| a.piece == b.piece && a.edge == b.edge);
        let chain = |places: &[StitchedEdge]| places.iter().map(|&p| self.reference(p, seam.both_sides)).collect();
        let to = if own_mirror { vec![here("mirror".to_owned())] } else { chain(b) };
        SeamFile {
            ease: (unequal && !gathered).then(|| here(millimetres((10.0 * (lb - la)).round() / 10.0, None))),
            gather: gathered.then(|| here((1e3 * la / lb).round() / 1e3)),
            face_same: seam.face_same.then(|| here(true)),
            ..SeamFile::new(here(name), chain(a), to)
        }
    }

    fn edge_name(&self, place: StitchedEdge) -> &str {
        let name = &self.names[place.piece][place.edge];
        name.rsplit_once('_').map_or(name, |(base, _)| base)
    }

    /// The name of the seam among those who sew.
    fn seam_name(&self, seam: &Joined) -> String {
        let [a, b] = [seam.a[0], seam.b[0]];
        let [one, other] = [a, b].map(|p| self.edge_name(p));
        let role = |p: StitchedEdge| self.parts[self.table.pieces[p.piece].panel].role;
        let sleeve = |p: StitchedEdge| matches!(role(p), PanelRole::Sleeve | PanelRole::Cuff);
        match (one, other) {
            ("armhole", _) | (_, "armhole") => "armhole".to_owned(),
            ("waist", _) | (_, "waist") => "waist".to_owned(),
            ("wrist", _) | (_, "wrist") => "wrist".to_owned(),
            ("ankle", _) | (_, "ankle") => "ankle".to_owned(),
            ("over" | "under", _) if sleeve(a) => {
                let piece = if role(a) == PanelRole::Cuff { "cuff" } else { "sleeve" };
                format!("{piece}_{one}")
            }
            (one, other) if one == other => one.to_owned(),
            (one, other) => format!("{one}_{other}"),
        }
    }

    /// With the piece it is on and the side of the wearer.
    fn longer_name(&self, seam: &Joined, name: &str) -> String {
        let ends = [seam.a[0], seam.b[0]];
        let part = |p: StitchedEdge| &self.parts[self.table.pieces[p.piece].panel];
        // A waistband or a sleeve is sewn to several pieces; what it is sewn to tells the seams apart.
        let shared = |p: &StitchedEdge| matches!(part(*p).role, PanelRole::Waistband | PanelRole::Sleeve);
        let own = ends.iter().find(|p| !shared(p)).unwrap_or(&ends[0]);
        let piece = self.table.pieces[own.piece].name.as_str();
        let without_facing = ["front", "back"].iter().find_map(|f| piece.strip_suffix(f)).unwrap_or(piece);
        let on = if name == "side" { without_facing.trim_end_matches('_') } else { piece };
        let side = ends.iter().find_map(|p| p.side).or_else(|| self.side_of(*own)).filter(|_| !seam.both_sides);
        let side = side.map(|s| if s == Side::Left { "left" } else { "right" });
        let words = [Some(on).filter(|on| !on.is_empty()), Some(name), side];
        words.into_iter().flatten().collect::<Vec<&str>>().join("_")
    }

    /// On which side of its piece an edge is.
    fn side_of(&self, place: StitchedEdge) -> Option<Side> {
        let drawing = &self.parts[self.table.pieces[place.piece].panel].drawing;
        let path = drawing.edges[place.edge].path()?;
        let x = drawing.space(path.point(0.5 * path.length())).x;
        (x.abs() > CENTRAL).then_some(if x > 0.0 { Side::Left } else { Side::Right })
    }

    /// Edges in no seam; `*.hem` where every piece's is.
    fn free(&self, seams: &[Joined]) -> Vec<Located<String>> {
        let sewn = |piece: usize, edge: usize| {
            seams.iter().any(|s| s.a.iter().chain(&s.b).any(|p| p.piece == piece && p.edge == edge))
        };
        let all = || (0..self.names.len()).flat_map(|p| (0..self.names[p].len()).map(move |e| (p, e)));
        let mut out: Vec<String> = Vec::new();
        for (piece, edge) in all().filter(|&(p, e)| !sewn(p, e)) {
            let name = &self.names[piece][edge];
            let same: Vec<(usize, usize)> = all().filter(|&(p, e)| &self.names[p][e] == name).collect();
            let everywhere = same.len() > 1 && same.iter().all(|&(p, e)| !sewn(p, e));
            let piece_name = &self.table.pieces[piece].name;
            let text = if everywhere { format!("*.{name}") } else { format!("{piece_name}.{name}") };
            if !out.contains(&text) {
                out.push(text);
            }
        }
        out.into_iter().map(here).collect()
    }
}

/// An edge whose middle is nearer the middle of the body, mm, is on neither side.
const CENTRAL: f64 = 10.0;
/// Half the length of a grain arrow, mm.
const GRAIN: f64 = 100.0;
/// Lengths that differ by less are equal, mm: below the 2 mm that a garment file lets pass.
const EVEN: f64 = 1.9;
/// More than this share of the length is gathered, not eased; a garment file says so beyond 8 %.
const LARGEST_EASE: f64 = 0.075;
