//! The start of a garment, drawn without sewing it.

use std::path::{Path, PathBuf};

use serde::Serialize;

use super::error::PipelineError;
use super::material::Checked;
use super::settling::{WordShown, settling};
use crate::dynamics::identity_nodes;
use crate::geometry::{MM, TriMesh, Vec3};
use crate::mannequin::{BodyPart, Mannequin};
use crate::mesh::{self, ClothMesh};
use crate::pattern::{Garment, outfit};
use crate::picture::{Dressed, StartMarks, draw_start, opening_color, pixels_of};
use crate::sew::place::{PlaceError, positioned};
use crate::sew::start::{CLEAR, SPACING, Sketch, SketchedOpening, sketch};
use crate::sew::{Stance, Stitching};

/// A picture of a garment's start, with its legend.
#[derive(Clone, Debug)]
pub struct StartPicture {
    /// The bytes of a PNG file.
    pub png: Vec<u8>,
    /// Content of the legend.
    pub shown: StartShown,
    /// Place of every opening's rim in the picture.
    pub rims: Vec<RimShown>,
}

/// Place of an opening's rim in a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RimShown {
    /// Its colour: red, green, blue.
    pub color: [u8; 3],
    /// Columns and rows of its points in all views. Cloth in front of a point may hide it.
    pub pixels: Vec<[usize; 2]>,
}

/// Content of the picture of a start.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StartShown {
    /// Why the pieces are drawn where their positions put them, if they are: no start from the topology is tried.
    pub placed: Option<String>,
    /// The openings of the glued garment, its open fronts closed.
    pub openings: Vec<OpeningShown>,
    /// By how much the next dealing of the body's ends costs more. `None` where there is no other.
    pub margin: Option<f64>,
    /// Whether the dealing is clear.
    pub clear: bool,
    /// The openings that the two best dealings give to different parts of the body, where the dealing is in doubt.
    pub doubts: Vec<DoubtShown>,
    /// The words of `place` that would settle the dealing.
    pub words: Vec<WordShown>,
}

/// An opening and the ends of the body that pass through it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OpeningShown {
    /// Edges of its rim as `piece.edge`, those with most of it first.
    pub edges: Vec<String>,
    /// Length of its rim, mm.
    pub length: f64,
    /// The ends of the body, `left leg + right leg`. `nothing` for a slit.
    pub through: String,
}

/// An opening that the two best dealings give to different parts of the body.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DoubtShown {
    /// Edges of its rim as `piece.edge`, those with most of it first.
    pub edges: Vec<String>,
    /// Length of its rim, mm.
    pub length: f64,
    /// The ends that pass through it in the better dealing.
    pub first: String,
    /// And in the other.
    pub second: String,
}

/// Draws the start of a garment, or of an outfit from the skin outwards, on the body that its first file names: joined
/// at its seams, round the body's axes, before it is inflated. Pieces with positions of their own are drawn there.
///
/// # Errors
/// Files without a body, a garment that cannot be meshed, or one that has neither start.
pub fn start_picture(worn: &[Checked]) -> Result<StartPicture, PipelineError> {
    let first = worn.first().ok_or(PipelineError::NoBody(PathBuf::new()))?;
    let body = first.body.as_ref().ok_or_else(|| PipelineError::NoBody(first.file.clone()))?;
    let garment = outfit(worn.iter().map(|w| w.loaded.garment.clone()).collect());
    let mesh = mesh::build(&garment, SPACING);
    let mesh = mesh.map_err(|source| PipelineError::Mesh { file: first.file.clone(), source: Box::new(source) })?;
    // An outfit may need more room than the first of its garments.
    let own = (worn.len() > 1).then(|| Stance::of(body, &garment)).flatten();
    let on = WornOn { file: &first.file, body, stance: own.as_ref().or(first.stance.as_ref()) };
    let sketch = sketch(&garment, &mesh, on.apart());
    let start = on.start(&garment, &mesh, &sketch)?;
    let shown = StartShown::new(&sketch, start.why);
    let marks: Vec<(Vec<Vec<Vec3>>, String)> =
        sketch.openings.iter().zip(&shown.openings).map(|(o, said)| (rim(o, &start.at), said.text())).collect();
    let axes = |part: &BodyPart| part.sections.iter().map(|s| s.center).collect();
    let axes: Vec<Vec<Vec3>> = on.apart().parts.iter().map(axes).collect();
    let dressed = Dressed::new(&mesh, &start.weld, &start.at, None);
    let nobody = TriMesh::default();
    let subtitle = format!("how it starts on {}, {} mm mesh", body.name, MM * SPACING);
    let scene = dressed.scene(&nobody, &garment.title, &subtitle);
    let png = draw_start(&scene, &StartMarks { axes: &axes, openings: &marks, notes: &shown.notes() })?;
    let pixels = |rim: &[Vec<Vec3>]| rim.iter().flatten().flat_map(|p| pixels_of(&scene, p)).collect();
    let rims = marks.iter().enumerate().map(|(k, o)| RimShown { color: opening_color(k), pixels: pixels(&o.0) });
    Ok(StartPicture { png, rims: rims.collect(), shown })
}

/// The body of a garment that is read from a file.
struct WornOn<'a> {
    file: &'a Path,
    body: &'a Mannequin,
    stance: Option<&'a Stance>,
}

/// Start positions of a garment.
struct StartPositions {
    at: Vec<Vec3>,
    /// One label per particle, the same for those that are joined.
    weld: Vec<u32>,
    /// Why it is no start from the topology, if it is none.
    why: Option<String>,
}

impl WornOn<'_> {
    /// The body as the garment is sewn on.
    fn apart(&self) -> &Mannequin {
        self.stance.map_or(self.body, |stance| &stance.body)
    }

    /// As the file positions the pieces, or else as sketched.
    fn start(&self, garment: &Garment, mesh: &ClothMesh, sketch: &Sketch) -> Result<StartPositions, PipelineError> {
        if let Some(at) = positioned(garment, mesh) {
            // Every particle stands alone: partners are still apart.
            return Ok(StartPositions { at, weld: identity_nodes(mesh), why: Some(POSITIONED.into()) });
        }
        let failed = |error: PlaceError| PipelineError::sewing(self.file, error.into());
        let at = sketch.at.clone().map_err(failed)?;
        Ok(StartPositions { at, weld: Stitching::new(mesh).class, why: None })
    }
}

/// Reason for drawing pieces where a file positions them.
const POSITIONED: &str = "pieces have positions of their own, so that no start from the topology is tried";

/// The rim of an opening, side by side: where pieces are apart they are no ring.
fn rim(opening: &SketchedOpening, at: &[Vec3]) -> Vec<Vec<Vec3>> {
    opening.sides.iter().map(|side| side.map(|p| at[p as usize]).to_vec()).collect()
}

impl StartShown {
    fn new(sketch: &Sketch, placed: Option<String>) -> Self {
        let opening = |o: &SketchedOpening| OpeningShown {
            edges: o.edges.clone(),
            length: MM * o.length,
            through: o.ends.to_string(),
        };
        let doubt = sketch.doubt.iter().flat_map(|doubt| &doubt.openings);
        let doubts = doubt.map(|o| DoubtShown {
            edges: o.edges.clone(),
            length: o.length_mm,
            first: o.ways[0].to_string(),
            second: o.ways[1].to_string(),
        });
        Self {
            placed,
            openings: sketch.openings.iter().map(opening).collect(),
            margin: Some(sketch.margin).filter(|margin| margin.is_finite()),
            clear: sketch.doubt.is_none(),
            doubts: doubts.collect(),
            words: sketch.words.iter().map(WordShown::new).collect(),
        }
    }

    /// Notes below the openings: whether the dealing is clear, and otherwise the words that settle it.
    fn notes(&self) -> Vec<String> {
        let margin = self.margin.map_or("no other dealing fits".to_owned(), |m| format!("the next costs {m:.1} more"));
        let mut out: Vec<String> = self.placed.iter().map(|why| format!("as the pieces are placed: {why}")).collect();
        if self.clear {
            out.push(format!("the dealing is clear: {margin} ({CLEAR} is clear)"));
            return out;
        }
        out.push(format!("the dealing is in doubt: {margin} ({CLEAR} is clear); drawn is the first"));
        out.extend(self.doubts.iter().map(|o| {
            format!("  {:.0} mm at {}: first {}; second {}", o.length, o.edges.join(", "), o.first, o.second)
        }));
        out.extend(settling(&self.words).iter().map(|line| format!("  {line}")));
        out
    }

    /// The openings and notes as text.
    pub fn text(&self) -> String {
        let openings = self.openings.iter().map(OpeningShown::text);
        openings.chain(self.notes()).map(|line| format!("  {line}\n")).collect()
    }
}

impl OpeningShown {
    fn text(&self) -> String {
        format!("{}: {:.0} mm at {}", self.through, self.length, self.edges.join(", "))
    }
}
