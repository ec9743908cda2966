//! Wishes of the page.

use crate::pattern::GarmentFile;

/// Spacings of the mesh that the page may ask for, mm.
pub const SPACINGS: [f64; 6] = [8.0, 10.0, 12.0, 15.0, 20.0, 25.0];

/// Wishes of the page that the file does not say.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Wanted {
    /// Spacing of the mesh, mm.
    pub(super) spacing: f64,
    /// A size of the garment, for as long as the file has it.
    pub(super) size: Option<String>,
}

impl Wanted {
    /// The same of a file: without a size that it does not have.
    pub(super) fn of(&self, said: Option<&GarmentFile>) -> Self {
        let has = |size: &String| said.is_some_and(|said| said.sizes.iter().any(|own| own.name.value == *size));
        Self { size: self.size.clone().filter(has), ..self.clone() }
    }
}
