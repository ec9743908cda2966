//! A specimen in its clamps: a sheet cut from one fabric, with the mesh, springs, bending and steps of a garment.

use std::f64::consts::PI;
use std::sync::Arc;

use super::SpecimenError;
use crate::contact::Collider;
use crate::dynamics::{Cloth, Cut, SpringModel, StepError, World, identity_nodes};
use crate::fabric::Fabric;
use crate::geometry::{Path, TriMesh, Vec2, Vec3};
use crate::mesh::{ClothMesh, build};
use crate::pattern::{Edge, Garment, Piece};
use crate::sew::{CLEARANCE, draping_world};

/// Step length, s: so long that inertia does not hide how far there still is to go.
const STEP: f64 = 10.0;
/// Trust region of a step: the largest change of an edge at first, at least and at most, in grid spacings.
const TRUST: [f64; 3] = [0.15, 1e-3, 0.5];
/// Steps between two looks at how far the specimen still moves.
const STRETCH: usize = 10;
/// Stretches after which a specimen that is not at rest is given up.
const MOST: usize = 300;

/// A flat sheet of one fabric, not yet held by anything.
pub(super) struct SpecimenSheet {
    /// Flat positions and triangles.
    pub(super) mesh: ClothMesh,
    /// Its fabric.
    pub(super) fabric: Arc<Fabric>,
    garment: Garment,
}

/// Angle between a strip's length and the warp, radians, for strips cut along the warp.
pub(super) const ALONG_WARP: f64 = 0.0;
/// See [`ALONG_WARP`].
pub(super) const ALONG_WEFT: f64 = 0.5 * PI;

/// Directions of strips, with their names.
pub(super) const WAYS: [(f64, &str); 2] = [(ALONG_WARP, "warp"), (ALONG_WEFT, "weft")];

/// Height of the middle of a cloth above its support, metres.
pub(super) fn lift(fabric: &Fabric) -> f64 {
    0.5 * fabric.thickness + CLEARANCE
}

impl SpecimenSheet {
    /// A rectangle `width` × `length` metres, its corner at the origin, its length along y and at `angle` (radians) to
    /// the warp.
    pub(super) fn strip(
        fabric: &Arc<Fabric>,
        [width, length]: [f64; 2],
        angle: f64,
        spacing: f64,
    ) -> Result<Self, SpecimenError> {
        let corners = [(0.0, 0.0), (width, 0.0), (width, length), (0.0, length)].map(|(x, y)| Vec2::new(x, y));
        let sides = (0..4).map(|k| Path::line(corners[k], corners[(k + 1) % 4])).collect();
        Self::cut(fabric, sides, Vec2::new(angle.sin(), angle.cos()), spacing)
    }

    /// A disc of `radius` metres round the origin, its warp along y.
    pub(super) fn disc(fabric: &Arc<Fabric>, radius: f64, spacing: f64) -> Result<Self, SpecimenError> {
        // Chords so short that they leave the circle by less than a hundredth of a spacing.
        let count = (PI / (0.02 * spacing / radius).sqrt()).ceil() as usize * 4;
        let at = |k: usize| {
            let a = 2.0 * PI * (k % count) as f64 / count as f64;
            Vec2::new(radius * a.cos(), radius * a.sin())
        };
        let quarter = count / 4;
        let sides =
            (0..4).map(|q| Path::polyline(&(q * quarter..=(q + 1) * quarter).map(at).collect::<Vec<_>>())).collect();
        Self::cut(fabric, sides, Vec2::y(), spacing)
    }

    fn cut(fabric: &Arc<Fabric>, sides: Vec<Path>, warp: Vec2, spacing: f64) -> Result<Self, SpecimenError> {
        let edge = |(k, path): (usize, Path)| Edge { name: format!("side{k}"), path, against: false };
        let piece = Piece {
            name: "specimen".into(),
            drawn_as: "specimen".into(),
            side: None,
            fold: None,
            fabric: fabric.name.clone(),
            layer: 0,
            beneath: 0,
            warp,
            loops: vec![sides.into_iter().enumerate().map(edge).collect()],
            lines: Vec::new(),
            notches: Vec::new(),
            place: None,
        };
        let garment = Garment {
            name: "specimen".into(),
            title: "Specimen".into(),
            body: None,
            pieces: vec![piece],
            seams: Vec::new(),
            fabrics: Vec::new(),
            closures: Vec::new(),
            worn: Vec::new(),
            tests: Vec::new(),
        };
        let mesh = build(&garment, spacing)?;
        Ok(Self { mesh, fabric: fabric.clone(), garment })
    }

    /// Its physical model, held by the particles for which `held` says so of their flat position.
    pub(super) fn cloth(&self, held: impl Fn(&Vec2) -> bool) -> Cloth {
        let fabrics = [self.fabric.clone()];
        let cut = Cut { garment: &self.garment, mesh: &self.mesh, fabrics: &fabrics };
        let mut cloth = Cloth::new(&cut, identity_nodes(&self.mesh), SpringModel::Raw);
        cloth.held = self.particles(held);
        cloth
    }

    /// Particles whose flat position is as `wanted`.
    pub(super) fn particles(&self, wanted: impl Fn(&Vec2) -> bool) -> Vec<u32> {
        (0u32..).zip(&self.mesh.flat).filter(|(_, p)| wanted(p)).map(|(n, _)| n).collect()
    }

    /// Every particle where `place` puts its flat position.
    pub(super) fn placed(&self, place: impl Fn(&Vec2) -> Vec3) -> Vec<Vec3> {
        self.mesh.flat.iter().map(place).collect()
    }

    /// The specimen at `x` under its own weight, beside `body`.
    pub(super) fn hang<'a>(&self, cloth: Cloth, x: Vec<Vec3>, body: &'a Collider) -> Result<World<'a>, StepError> {
        let mut world = draping_world(cloth, x, self.mesh.spacing, body)?;
        world.gravity = 1.0;
        Ok(world)
    }
}

/// A bench so far below that no specimen touches it.
pub(super) fn nothing() -> Result<Collider, SpecimenError> {
    block([-1.0, -101.0, -1.0], [1.0, -100.0, 1.0])
}

/// A block from its lowest corner to its highest, metres.
pub(super) fn block(low: [f64; 3], high: [f64; 3]) -> Result<Collider, SpecimenError> {
    let corner = |i: usize| Vec3::from_fn(|k, _| if i >> k & 1 == 0 { low[k] } else { high[k] });
    let sides = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = sides.iter().flat_map(|s: &[u32; 4]| [[s[0], s[1], s[2]], [s[0], s[2], s[3]]]).collect();
    Collider::new(&TriMesh { vertices: (0..8).map(corner).collect(), triangles }).ok_or(SpecimenError::Bench)
}

/// Sum of the forces with which some nodes hold the cloth, N.
pub(super) fn held_with(world: &World, nodes: &[u32]) -> Vec3 {
    let forces = world.unbalanced();
    -nodes.iter().map(|&n| forces[n as usize]).sum::<Vec3>()
}

/// A strip of `length` metres at rest whose two ends are drawn apart by `strain` of it, without weight. At rest as
/// [`settle`] has it.
///
/// # Errors
/// As [`settle`].
pub(super) fn drawn_out<'a>(
    sheet: &SpecimenSheet,
    length: f64,
    strain: f64,
    bench: &'a Collider,
    still: f64,
) -> Result<World<'a>, SpecimenError> {
    let spacing = sheet.mesh.spacing;
    let cloth = sheet.cloth(|p| p.y < 0.5 * spacing || p.y > length - 0.5 * spacing);
    let x = sheet.placed(|p| Vec3::new(p.x, p.y * (1.0 + strain), 0.0));
    let mut world = sheet.hang(cloth, x, bench)?;
    world.gravity = 0.0;
    settle(&mut world, spacing, still)?;
    Ok(world)
}

/// Steps `world` until ten of them move no node further than `still` metres.
///
/// # Errors
/// [`SpecimenError::Unrest`] if it does not come to that.
pub(super) fn settle(world: &mut World, spacing: f64, still: f64) -> Result<usize, SpecimenError> {
    let [mut trust, least, most] = TRUST.map(|t| t * spacing);
    let mut moved = f64::INFINITY;
    for step in 0..MOST {
        let before = world.x().to_vec();
        for _ in 0..STRETCH {
            trust = world.newton(STEP, trust)?.trust(trust).clamp(least, most);
        }
        moved = before.iter().zip(world.x()).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        if moved <= still {
            return Ok((step + 1) * STRETCH);
        }
    }
    Err(SpecimenError::Unrest { steps: MOST * STRETCH, moved })
}
