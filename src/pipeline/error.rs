//! Why a run ended early, and whose turn it is then.

use std::path::PathBuf;

use super::draft_error::DraftError;
use super::obstacle::{Across, Caught, TooSmall};
use crate::drape::DrapeError;
use crate::fabric::FabricError;
use crate::flatten::FlattenError;
use crate::io::body::BodyError;
use crate::io::garment::{EncodeError, Refused};
use crate::io::obj_read::ObjError;
use crate::io::svg_write::PatternSvgError;
use crate::mesh::MeshError;
use crate::picture::PictureError;
use crate::sew::SewError;
use crate::sew::place::PlaceError;

/// Why there is no result, or only a part of one.
#[derive(Debug, thiserror::Error)]
pub enum PipelineError {
    /// The garment file has mistakes.
    #[error(transparent)]
    Garment(#[from] Refused),
    /// The fabric asked for in place of the garment's own cannot be had. (One of the file's own is [`Self::Garment`].)
    #[error(transparent)]
    Fabric(Box<FabricError>),
    /// Nothing to dress.
    #[error(
        "{}: no body to sew on; write 'body: woman_92' into the file or give --body NAME or --body FILE.obj",
        .0.display()
    )]
    NoBody(PathBuf),
    /// Two garments of an outfit are made for two bodies.
    #[error(
        "{}: made for '{body}', but {} for '{other_body}'; say with --body NAME or --body FILE.obj who wears both",
        file.display(), other.display()
    )]
    Bodies {
        /// A garment file.
        file: PathBuf,
        /// Its body.
        body: String,
        /// The innermost garment's file.
        other: PathBuf,
        /// That one's body.
        other_body: String,
    },
    /// A fabric in place of a garment's own is asked for, and there are several garments.
    #[error("--fabric does not say of which garment; name the fabric in the garment files")]
    WhoseFabric,
    /// The body cannot be used.
    #[error(transparent)]
    Body(#[from] BodyError),
    /// The spacing does not suit the garment.
    #[error("{}: {source}", file.display())]
    Mesh {
        /// The garment file.
        file: PathBuf,
        /// The fault of the mesh.
        source: Box<MeshError>,
    },
    /// A piece has no place on this body.
    #[error("{}: {source}", file.display())]
    Place {
        /// The garment file.
        file: PathBuf,
        /// The piece, and the reason.
        source: Box<PlaceError>,
    },
    /// A surface cannot be cut along a drawn line.
    #[error("{}: line {line}: {why}", file.display())]
    Drawn {
        /// The file of the lines.
        file: PathBuf,
        /// Its number in the file, from 1.
        line: usize,
        /// The reason, and what to do.
        why: String,
    },
    /// Style lines give no pattern.
    #[error(transparent)]
    Draft(Box<DraftError>),
    /// The pieces of a surface cannot be written as a garment file.
    #[error(transparent)]
    Encode(#[from] EncodeError),
    /// No part of a surface can be cut into gores.
    #[error("{}: {why}", file.display())]
    Gores {
        /// The surface's file.
        file: PathBuf,
        /// The reason, and what to do.
        why: String,
    },
    /// A file of an earlier run cannot be read.
    #[error(transparent)]
    Obj(#[from] ObjError),
    /// A file of an earlier run belongs to another garment or spacing.
    #[error("{}: {why}; make it anew with the same garment and --spacing", file.display())]
    Saved {
        /// The file.
        file: PathBuf,
        /// The difference.
        why: String,
    },
    /// A file of an earlier result, from which a garment should go on, is missing or belongs to another.
    #[error("{}: {why}; --from takes a folder that `toile make`, `drape` or `sew` has written", file.display())]
    Earlier {
        /// The file.
        file: PathBuf,
        /// The fault.
        why: String,
    },
    /// A surface cannot be laid flat as it is.
    #[error("{}: {source}", file.display())]
    Surface {
        /// The file.
        file: PathBuf,
        /// The part, and the reason.
        source: FlattenError,
    },
    /// A surface is no disk, and a way to make it one is known.
    #[error("{}: {source}; {advice}", file.display())]
    NoDisk {
        /// The file.
        file: PathBuf,
        /// The part, and the kind of surface that it is.
        source: FlattenError,
        /// Place to cut.
        advice: String,
    },
    /// A cut that cannot be made.
    #[error("{}: --cut {cut}: {why}", file.display())]
    Cut {
        /// The file.
        file: PathBuf,
        /// As given.
        cut: String,
        /// The fault.
        why: String,
    },
    /// A seam cannot close because something is between its edges.
    #[error(transparent)]
    Caught(Box<Caught>),
    /// A seam cannot close, for pieces are stuck in one another.
    #[error(transparent)]
    Across(Box<Across>),
    /// Its seams close, but only if the cloth tears.
    #[error(transparent)]
    TooSmall(Box<TooSmall>),
    /// Sewing failed.
    #[error(transparent)]
    Sew(SewError),
    /// Draping failed.
    #[error(transparent)]
    Drape(#[from] DrapeError),
    /// Flattening failed.
    #[error("flattening stopped: {0}")]
    Flatten(#[from] FlattenError),
    /// The pattern cannot be drawn.
    #[error("cannot draw the pattern: {0}")]
    Svg(#[from] PatternSvgError),
    /// The picture cannot be drawn.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// A report cannot be put into words.
    #[error("cannot write the report: {0}")]
    Json(#[from] serde_json::Error),
}

impl From<DraftError> for PipelineError {
    fn from(error: DraftError) -> Self {
        Self::Draft(Box::new(error))
    }
}

impl PipelineError {
    /// Whether the user must change the input. Otherwise the computation itself failed.
    pub fn is_input(&self) -> bool {
        match self {
            Self::Garment(_)
            | Self::Fabric(_)
            | Self::NoBody(_)
            | Self::Bodies { .. }
            | Self::WhoseFabric
            | Self::Body(_)
            | Self::Mesh { .. }
            | Self::Place { .. }
            | Self::Obj(_)
            | Self::Saved { .. }
            | Self::Earlier { .. }
            | Self::NoDisk { .. }
            | Self::Cut { .. }
            | Self::Drawn { .. }
            | Self::Draft(_)
            | Self::Gores { .. } => true,
            Self::Surface { source, .. } => !is_breakdown(source),
            Self::Caught(_)
            | Self::Across(_)
            | Self::TooSmall(_)
            | Self::Sew(_)
            | Self::Drape(_)
            | Self::Flatten(_)
            | Self::Encode(_)
            | Self::Svg(_)
            | Self::Picture(_)
            | Self::Json(_) => false,
        }
    }

    /// Whether the message itself contains a remedy.
    pub fn has_remedy(&self) -> bool {
        self.is_input()
            || matches!(
                self,
                Self::Caught(_)
                    | Self::Across(_)
                    | Self::TooSmall(_)
                    | Self::Sew(SewError::InsideBody { .. } | SewError::UnderFloor { .. } | SewError::Open { .. })
            )
    }

    /// Sewing's error: a piece that no place suits is a matter of the garment file.
    pub(super) fn sewing(file: &std::path::Path, error: SewError) -> Self {
        match error {
            SewError::Place(source) => Self::Place { file: file.to_owned(), source: Box::new(source) },
            other => Self::Sew(other),
        }
    }
}

/// Whether flattening failed on a surface that it should have managed.
fn is_breakdown(error: &FlattenError) -> bool {
    match error {
        FlattenError::Piece { source, .. } => is_breakdown(source),
        other => matches!(other, FlattenError::Breakdown | FlattenError::FlippedStart(_)),
    }
}
