//! Maps of the draped garment: values at every particle, for the page and for 3D programs.

use super::run::Run;
use crate::geometry::{KPA, MM, Vec3};
use crate::report::{pressure, thread_strains};
use crate::verify::{Welded, distances};

impl Run<'_> {
    /// Values at every particle of the garment at positions `at`, each with the name of its attribute in glTF: strain
    /// along warp and weft (fractions), shear (degrees), ease (mm), the gaps of seams (mm), and the pressure (kPa)
    /// where the forces are known.
    pub(super) fn maps(&self, at: &[Vec3]) -> Vec<(&'static str, Vec<f64>)> {
        let mesh = &self.job.mesh;
        let strains = thread_strains(mesh, at);
        let strain = |k: usize| strains.iter().map(|values| values[k]).collect::<Vec<f64>>();
        let mut maps = vec![
            ("_STRAIN_WARP", strain(0)),
            ("_STRAIN_WEFT", strain(1)),
            ("_SHEAR", strain(2)),
            ("_EASE", self.ease(at)),
            ("_SEAM_GAP", self.seam_gaps()),
        ];
        maps.extend(self.pressure(at).map(|pressure| ("_PRESSURE", pressure)));
        maps
    }

    /// Distance of every particle to the skin, mm.
    pub(super) fn ease(&self, at: &[Vec3]) -> Vec<f64> {
        distances(at, &self.job.body.mesh).into_iter().map(|far| far * MM).collect()
    }

    /// Pressure at every particle, kPa, where the forces are known.
    pub(super) fn pressure(&self, at: &[Vec3]) -> Option<Vec<f64>> {
        let (forces, class) = (self.pressed.as_ref()?, self.class());
        let welded = Welded::new(&self.job.mesh, &class, at);
        let pressure = pressure(&welded, &class, forces);
        Some(welded.vertex_of.iter().map(|&v| KPA * pressure[v as usize]).collect())
    }

    /// For every particle the largest gap to a partner when its seams had been closed, mm. Zero beside seams.
    fn seam_gaps(&self) -> Vec<f64> {
        let mesh = &self.job.mesh;
        let mut out = vec![0.0f64; mesh.flat.len()];
        for (seam, gaps) in mesh.seams.iter().zip(self.gaps.iter().flatten()) {
            for (pair, gap) in seam.pairs.iter().zip(gaps) {
                for &particle in pair {
                    out[particle as usize] = out[particle as usize].max(gap * MM);
                }
            }
        }
        out
    }
}
