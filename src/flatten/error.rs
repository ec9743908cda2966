//! Faults of a surface that is to be laid flat.

/// Why a surface could not be flattened.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FlattenError {
    /// No triangles.
    #[error("the surface has no triangles")]
    Empty,
    /// A triangle names a vertex that is not there.
    #[error("triangle {triangle} names vertex {vertex}, but there are only {vertices}")]
    MissingVertex {
        /// Triangle index.
        triangle: usize,
        /// Named vertex.
        vertex: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// A vertex that no triangle uses.
    #[error("vertex {0} belongs to no triangle")]
    LooseVertex(usize),
    /// A coordinate is infinite or not a number.
    #[error("vertex {0} has a coordinate that is not finite")]
    NotFinite(usize),
    /// A triangle without area.
    #[error("triangle {0} has no area: it cannot say how the cloth around it lies")]
    Degenerate(usize),
    /// More than two triangles on an edge.
    #[error("more than two triangles meet in the edge of vertices {0} and {1}")]
    NonManifoldEdge(u32, u32),
    /// Parts of the surface that touch in one vertex only.
    #[error("the surface touches itself in vertex {0} only")]
    NonManifoldVertex(usize),
    /// Neighbouring triangles that run against each other.
    #[error("triangles {0} and {1} run against each other: turn one of them round")]
    Misoriented(u32, u32),
    /// A surface with one side only.
    #[error("the surface is {0}: it has one side only, and cloth has two; cut it first, across the twist")]
    OneSided(&'static str),
    /// Several unconnected parts.
    #[error("the surface has {0} unconnected parts: flatten them one by one")]
    Components(usize),
    /// No rim at all.
    #[error("the surface is closed: cut it first")]
    Closed,
    /// Handles.
    #[error("the surface has {0} handle(s), like a cup: cut it first")]
    Handles(usize),
    /// A given start with another number of positions than vertices.
    #[error("the start has {found} positions for {expected} vertices")]
    StartLength {
        /// Vertices.
        expected: usize,
        /// Positions.
        found: usize,
    },
    /// No start without flipped triangles was found.
    #[error("triangle {0} is turned over or without area in the flat start")]
    FlippedStart(usize),
    /// The linear system of a step could not be solved.
    #[error("the flattening broke down numerically: the surface may have extremely thin triangles")]
    Breakdown,
    /// Any of these, in a piece of a garment.
    #[error("piece '{piece}': {source}")]
    Piece {
        /// The piece's name.
        piece: String,
        /// Its fault.
        source: Box<FlattenError>,
    },
}

impl FlattenError {
    /// The same with other numbers for vertices and triangles: those of the file a surface was read from.
    pub fn renumbered(self, vertex: &dyn Fn(usize) -> usize, triangle: &dyn Fn(usize) -> usize) -> Self {
        let vertex32 = |v: u32| vertex(v as usize) as u32;
        match self {
            Self::LooseVertex(v) => Self::LooseVertex(vertex(v)),
            Self::NotFinite(v) => Self::NotFinite(vertex(v)),
            Self::Degenerate(t) => Self::Degenerate(triangle(t)),
            Self::NonManifoldEdge(a, b) => Self::NonManifoldEdge(vertex32(a), vertex32(b)),
            Self::NonManifoldVertex(v) => Self::NonManifoldVertex(vertex(v)),
            Self::Misoriented(s, t) => Self::Misoriented(triangle(s as usize) as u32, triangle(t as usize) as u32),
            Self::FlippedStart(t) => Self::FlippedStart(triangle(t)),
            other => other,
        }
    }
}
