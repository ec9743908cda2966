//! The draft as a garment file.

use serde::Serialize;

use super::super::error::PipelineError;
use super::super::surface::FlatSurface;
use super::Drafted;
use super::file::LinesFile;
use super::shell::ShellEase;
use crate::geometry::{MM, Vec3};
use crate::io::garment::write;
use crate::mannequin::{Mannequin, PartKind};
use crate::pattern::{Located, PlaceFile, Quantity, Spot, TestEntry, TestFile, Unit, Value};

/// Angle from the front or the back up to which a panel is at the front or the back alone, radians.
const ASIDE: f64 = 0.35;
/// How far the pieces of an object's cover stand off it before they are sewn, metres.
const OFF: f64 = 0.06;

/// A girth is tested where the garment reaches this far beyond it, metres.
const INSIDE: f64 = 0.02;
/// Ease that a draped garment may have more or less than was asked for, mm.
const NEAR: f64 = 5.0;

/// A piece of a draft.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DraftedPiece {
    /// Its name.
    pub name: String,
    /// 99 % of it are strained by less than this share.
    pub strain: f64,
    /// Darts in it.
    pub darts: usize,
}

/// The ease of a draft at a girth.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DraftedEase {
    /// The girth.
    pub girth: String,
    /// As asked for, mm.
    pub asked: f64,
    /// As drafted, mm.
    pub drafted: f64,
}

/// All that a garment file says besides its pieces.
pub(super) struct GarmentStatements<'a> {
    pub(super) file: &'a LinesFile,
    /// As the user named it.
    pub(super) body: &'a str,
    pub(super) given: &'a Mannequin,
    pub(super) ease: &'a ShellEase,
    pub(super) fabric: &'a str,
    /// A point in every panel.
    pub(super) places: &'a [(String, Vec3)],
    /// Lowest and highest point of the panels, metres.
    pub(super) reach: [f64; 2],
}

fn here<T>(value: T) -> Located<T> {
    Located::new(value, Spot::default())
}

pub(super) fn written(
    flat: &FlatSurface,
    about: &GarmentStatements,
    formed: &Mannequin,
) -> Result<Drafted, PipelineError> {
    let mut file = flat.garment_file(true, None);
    file.name = Some(here(about.file.name.clone().unwrap_or_else(|| flat.report.surface.clone())));
    file.body = Some(here(about.body.to_owned()));
    file.fabrics = vec![(here("shell".to_owned()), here(Value::Text(about.fabric.to_owned())))];
    file.tests = tests(about).into_iter().map(|test| here(TestEntry { test, fabric: None })).collect();
    for (piece, report) in file.pieces.iter_mut().zip(&flat.report.pieces) {
        let own = about.places.iter().find(|(name, _)| *name == report.name);
        piece.place = own.map(|(_, at)| here(placed(about.given, formed, *at)));
    }
    let ease = about.ease.stations.iter().filter_map(|(girth, _, asked)| {
        let drafted = super::grown(about.given, formed, girth)?;
        Some(DraftedEase { girth: girth.clone(), asked: asked * MM, drafted: drafted * MM })
    });
    let darts = flat.darts();
    let pieces = flat.report.pieces.iter().zip(&darts).map(|(p, darts)| DraftedPiece {
        name: p.name.clone(),
        strain: p.strain.p99,
        darts: *darts,
    });
    Ok(Drafted {
        text: write(&file).map_err(PipelineError::Encode)?,
        pieces: pieces.collect(),
        ease: ease.collect(),
        darts: darts.iter().sum(),
        notes: Vec::new(),
    })
}

/// Bounds that the garment keeps when it is made: closed seams, no crossing and, on a body, the ease asked for.
fn tests(about: &GarmentStatements) -> Vec<TestFile> {
    let mm = |number: f64| here(Quantity { number, unit: Some(Unit::Millimetre) });
    let mut out = vec![TestFile::Gap(here("all".to_owned()), mm(1.0)), TestFile::Crossings(0)];
    if about.given.parts.is_empty() {
        return out;
    }
    out.push(TestFile::Worn);
    let [low, high] = about.reach;
    let within = about.ease.stations.iter().filter(|(_, y, _)| (low + INSIDE..high - INSIDE).contains(y));
    out.extend(within.map(|(girth, _, ease)| {
        let from = (ease * MM - NEAR).max(0.0);
        TestFile::Ease(here(girth.clone()), Some(mm(from)), Some(mm(ease * MM + NEAR)))
    }));
    out
}

/// Where a panel starts: in words on a body, as a position before an object.
fn placed(body: &Mannequin, formed: &Mannequin, at: Vec3) -> PlaceFile {
    match body.nearest_section(at) {
        Some((kind, section)) => PlaceFile::Words(words(kind, at - section.center, at.y, body)),
        None => before(formed, at),
    }
}

fn words(kind: PartKind, away: Vec3, y: f64, body: &Mannequin) -> String {
    let waist = body.parts.iter().flat_map(|p| &p.landmarks).find(|l| l.0 == "waist").map_or(0.0, |l| l.1.y);
    let part = match kind {
        kind if super::is_trunk(kind) => if y > waist { "bodice" } else { "hip" }.to_owned(),
        kind => kind.name().to_owned(),
    };
    let angle = away.x.atan2(away.z);
    let side = if angle.abs() <= std::f64::consts::FRAC_PI_2 { "front" } else { "back" };
    let aside = angle.sin().abs() > ASIDE && super::is_trunk(kind);
    let hand = if away.x > 0.0 { "left " } else { "right " };
    format!("{part} {}{side}", if aside { hand } else { "" })
}

/// Before the surface, facing away from it.
fn before(formed: &Mannequin, at: Vec3) -> PlaceFile {
    let near = formed.mesh.vertices.iter().zip(formed.mesh.vertex_normals());
    let nearest = near.min_by(|a, b| (a.0 - at).norm_squared().total_cmp(&(b.0 - at).norm_squared()));
    let normal = nearest.map_or_else(Vec3::z, |n| n.1);
    let off = (at + normal * OFF) * MM;
    let (pitch, yaw) = ((-normal.y).clamp(-1.0, 1.0).asin(), normal.x.atan2(normal.z));
    let round = |x: f64| x.round();
    let turn = [round(pitch.to_degrees()), round(yaw.to_degrees()), 0.0];
    PlaceFile::At { at: [off.x, off.y, off.z].map(round), turn: Some(turn) }
}
