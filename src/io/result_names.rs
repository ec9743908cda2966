//! Names of the files that a result consists of, in the folder of its own that it has.

/// The draped garment.
pub const GARMENT_OBJ: &str = "garment.obj";
/// The draped garment for 3D programs.
pub const GARMENT_GLB: &str = "garment.glb";
/// The pattern of a surface, or of a changed form, as a garment file.
pub const GARMENT_YAML: &str = "garment.yaml";
/// The sewn garment, before it was draped.
pub const SEWN_OBJ: &str = "sewn.obj";
/// The pieces as they were placed, not sewn yet: written when sewing them fails.
pub const PLACED_OBJ: &str = "placed.obj";
/// The flattened pieces.
pub const PATTERN_SVG: &str = "pattern.svg";
/// The figures.
pub const REPORT_JSON: &str = "report.json";
/// The page.
pub const REPORT_HTML: &str = "report.html";
/// The picture.
pub const GARMENT_PNG: &str = "garment.png";
/// The surface as read, with flat texture coordinates.
pub const FLAT_OBJ: &str = "flat.obj";
/// The flat pieces of a surface, coloured by strain.
pub const FLAT_PNG: &str = "flat.png";
/// The outlines of a surface's flat pieces as smooth curves.
pub const OUTLINE_SVG: &str = "outline.svg";
/// A surface with its rims closed.
pub const FORM_OBJ: &str = "form.obj";
