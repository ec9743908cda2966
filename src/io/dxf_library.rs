//! The blocks of a DXF file, with what is inserted in them.

use nalgebra::Matrix2;

use super::dxf_block::Block;
use super::dxf_error::{DxfError, SHOWN};
use super::dxf_left_out::LeftOutEntities;
use super::dxf_text::Entity;
use crate::geometry::Vec2;
use crate::input::shown;

/// More lines in a block than this cannot be looked at one against the other.
const MOST_LINES: usize = 5_000;
/// Blocks within blocks are followed so deep.
const MOST_DEEP: usize = 4;

/// Where what is drawn in a block lies: turned, stretched and moved. Metres, y down.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placed {
    pub(super) linear: Matrix2<f64>,
    pub(super) shift: Vec2,
}

impl Placed {
    /// As an INSERT says; its shift counts only within another block.
    pub(super) fn new(insert: &Entity, unit: f64) -> Option<Self> {
        let number = |code: i32| insert.value(code).map_or(Some(None), |v| v.parse::<f64>().ok().map(Some));
        let scale = [number(41)?.unwrap_or(1.0), number(42)?.unwrap_or(1.0)];
        let turn = number(50)?.unwrap_or(0.0).to_radians();
        let usable = scale.iter().all(|s| s.is_finite() && *s != 0.0 && s.abs() <= 1e4) && turn.is_finite();
        let (sine, cosine) = turn.sin_cos();
        // With y down a turn goes the other way.
        let linear = Matrix2::new(cosine, sine, -sine, cosine) * Matrix2::new(scale[0], 0.0, 0.0, scale[1]);
        let shift = insert.points(10, unit).ok()?.first().copied().unwrap_or_else(Vec2::zeros);
        usable.then_some(Self { linear, shift })
    }

    pub(super) fn point(&self, p: Vec2) -> Vec2 {
        self.linear * p + self.shift
    }
}

/// The blocks of a file by their names.
pub(super) struct Library<'e, 'a> {
    blocks: &'e [&'e [Entity<'a>]],
    unit: f64,
}

impl<'e, 'a> Library<'e, 'a> {
    pub(super) fn new(blocks: &'e [&'e [Entity<'a>]], unit: f64) -> Self {
        Self { blocks, unit }
    }

    fn named(&self, name: &str) -> Option<&'e [Entity<'a>]> {
        self.blocks.iter().find(|b| b.first().and_then(|e| e.value(2)) == Some(name)).copied()
    }

    /// How the file's own INSERT of a block turns and stretches it; where it puts it is nobody's business.
    pub(super) fn placed(&self, entities: &[Entity], block: &str) -> Option<Placed> {
        let mut inside = false;
        let own = entities.iter().find(|e| {
            inside = match e.kind {
                "BLOCK" => true,
                "ENDBLK" => false,
                _ => inside,
            };
            !inside && e.kind == "INSERT" && e.value(2) == Some(block)
        });
        own.and_then(|insert| Placed::new(insert, self.unit)).map(|p| Placed { shift: Vec2::zeros(), ..p })
    }

    /// The entities of a block.
    pub(super) fn block(
        &self,
        entities: &'e [Entity<'a>],
        left_out: &mut LeftOutEntities<'a>,
    ) -> Result<Block<'a>, DxfError> {
        self.block_in(entities, left_out, 0)
    }

    /// The entities in no block, without inserted ones.
    pub(super) fn loose(
        &self,
        entities: &'e [Entity<'a>],
        left_out: &mut LeftOutEntities<'a>,
    ) -> Result<Block<'a>, DxfError> {
        let mut block = Block::named("");
        let mut within = false;
        let mut rest = entities.iter();
        while let Some(entity) = rest.next() {
            match entity.kind {
                "BLOCK" => within = true,
                "ENDBLK" => within = false,
                _ if !within => block.read(entity, &mut rest, self.unit, left_out)?,
                _ => {}
            }
            if block.lines.len() > MOST_LINES {
                return Err(DxfError::TooMany { block: String::new(), most: MOST_LINES });
            }
        }
        Ok(block)
    }

    fn block_in(
        &self,
        entities: &'e [Entity<'a>],
        left_out: &mut LeftOutEntities<'a>,
        depth: usize,
    ) -> Result<Block<'a>, DxfError> {
        let mut block = Block::named(entities.first().and_then(|e| e.value(2)).unwrap_or(""));
        if depth > MOST_DEEP {
            return Err(DxfError::TooDeep { block: shown(block.name, SHOWN), most: MOST_DEEP });
        }
        let mut rest = entities.iter().skip(1);
        while let Some(entity) = rest.next() {
            let inserted = entity.value(2).filter(|_| entity.kind == "INSERT");
            match inserted.and_then(|name| Some((self.named(name)?, Placed::new(entity, self.unit)?))) {
                Some((inner, placed)) => block.take(self.block_in(inner, left_out, depth + 1)?.mapped(Some(placed))),
                None => block.read(entity, &mut rest, self.unit, left_out)?,
            }
            if block.lines.len() > MOST_LINES {
                return Err(DxfError::TooMany { block: shown(block.name, SHOWN), most: MOST_LINES });
            }
        }
        Ok(block)
    }
}
