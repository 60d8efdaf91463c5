//! Accesses to textures.

use super::{Frame, LowerError, Lowered, Lowering, Operand};
use estampe_ir::interface::TextureSlot;
use estampe_ir::op::{Binary, LevelOfDetail, TextureOp, TextureQuery, Unary};
use estampe_ir::{Op, Value};
use naga::{
    Expression, GlobalVariable, Handle, ImageClass, ImageDimension, ImageQuery, SampleLevel,
    TypeInner,
};

impl<'a> Lowering<'a> {
    pub(super) fn image(
        &mut self,
        frame: &mut Frame<'a>,
        handle: Handle<Expression>,
    ) -> Lowered<Vec<Value>> {
        match frame.function.expressions[handle] {
            Expression::ImageSample {
                image,
                sampler,
                gather,
                coordinate,
                array_index,
                offset,
                level,
                depth_ref,
                clamp_to_edge,
            } => {
                let mut op = self.texture_op(frame, image, TextureQuery::Sample)?;
                let sampler = self.resource(frame, sampler)?;
                op.sampler = Some(self.sampler_slot(sampler)?);
                op.query = match (gather, depth_ref.is_some()) {
                    (None, false) => TextureQuery::Sample,
                    (None, true) => TextureQuery::SampleCompare,
                    (Some(_), true) => TextureQuery::GatherCompare,
                    (Some(component), false) => TextureQuery::Gather(component as u8),
                };
                op.coordinates = self.narrow_values(frame, coordinate)?;
                if clamp_to_edge {
                    op.coordinates = self.half_a_texel_inside(frame, image, &op.coordinates)?;
                }
                op.layer = self.optional(frame, array_index)?;
                op.reference = self.optional(frame, depth_ref)?;
                op.offset = self.offset(frame, offset)?;
                op.level = self.level(frame, level)?;
                let is_depth = self.is_depth(frame, image)?;
                let sampled = self.builder.op(Op::Texture(Box::new(op)));
                // A depth texture has one number.
                let is_one = is_depth && gather.is_none();
                Ok(if is_one {
                    sampled[..1].to_vec()
                } else {
                    sampled
                })
            }
            Expression::ImageLoad {
                image,
                coordinate,
                array_index,
                sample,
                level,
            } => {
                let mut op = self.texture_op(frame, image, TextureQuery::Load)?;
                op.coordinates = self.narrow_values(frame, coordinate)?;
                op.layer = self.optional(frame, array_index)?;
                op.sample = self.optional(frame, sample)?;
                if let Some(level) = self.optional(frame, level)? {
                    op.level = LevelOfDetail::Explicit(level);
                }
                let is_depth = self.is_depth(frame, image)?;
                let loaded = self.builder.op(Op::Texture(Box::new(op)));
                Ok(if is_depth {
                    loaded[..1].to_vec()
                } else {
                    loaded
                })
            }
            Expression::ImageQuery { image, query } => self.image_query(frame, image, query),
            _ => Err(LowerError::Unsupported("accesses of this kind")),
        }
    }

    /// Coordinates that are clamped to the centres of the outermost texels of level 0, as WGSL
    /// defines for `textureSampleBaseClampToEdge`.
    fn half_a_texel_inside(
        &mut self,
        frame: &mut Frame<'a>,
        image: Handle<Expression>,
        coordinates: &[Value],
    ) -> Lowered<Vec<Value>> {
        let sides = self.image_query(frame, image, ImageQuery::Size { level: None })?;
        let b = &mut self.builder;
        let (one, half) = (b.float(1.0), b.float(0.5));
        let pairs = coordinates.iter().zip(sides);
        let clamped = pairs.map(|(&coordinate, side)| {
            let side = b.unary(Unary::F32FromU32, side);
            let low = b.binary(Binary::FDiv, half, side);
            let high = b.binary(Binary::FSub, one, low);
            let raised = b.binary(Binary::FMax, coordinate, low);
            b.binary(Binary::FMin, raised, high)
        });
        Ok(clamped.collect())
    }

    pub(super) fn image_store(
        &mut self,
        frame: &mut Frame<'a>,
        image: Handle<Expression>,
        (coordinate, layer): (Handle<Expression>, Option<Handle<Expression>>),
        value: Handle<Expression>,
    ) -> Lowered<()> {
        let mut op = self.texture_op(frame, image, TextureQuery::Store)?;
        op.coordinates = self.narrow_values(frame, coordinate)?;
        op.layer = self.optional(frame, layer)?;
        op.stored = self.narrow_values(frame, value)?;
        op.mask = self.slots[self.cover];
        self.builder.op(Op::Texture(Box::new(op)));
        Ok(())
    }

    fn image_query(
        &mut self,
        frame: &mut Frame<'a>,
        image: Handle<Expression>,
        query: ImageQuery,
    ) -> Lowered<Vec<Value>> {
        let (kind, level) = match query {
            ImageQuery::Size { level } => (TextureQuery::Size, level),
            ImageQuery::NumLevels => (TextureQuery::Levels, None),
            ImageQuery::NumLayers => (TextureQuery::Layers, None),
            ImageQuery::NumSamples => (TextureQuery::Samples, None),
        };
        let mut op = self.texture_op(frame, image, kind)?;
        if let Some(level) = self.optional(frame, level)? {
            op.level = LevelOfDetail::Explicit(level);
        }
        let mut words = self.builder.op(Op::Texture(Box::new(op)));
        if kind == TextureQuery::Size {
            let sides = match self.dimension(frame, image)? {
                ImageDimension::D1 => 1,
                ImageDimension::D2 | ImageDimension::Cube => 2,
                ImageDimension::D3 => 3,
            };
            words.truncate(sides);
        }
        Ok(words)
    }

    fn texture_op(
        &mut self,
        frame: &mut Frame<'a>,
        image: Handle<Expression>,
        query: TextureQuery,
    ) -> Lowered<TextureOp> {
        let image = self.resource(frame, image)?;
        Ok(TextureOp {
            query,
            texture: self.texture_slot(image)?,
            sampler: None,
            coordinates: Vec::new(),
            layer: None,
            offset: [0; 3],
            level: LevelOfDetail::Zero,
            reference: None,
            sample: None,
            stored: Vec::new(),
            mask: self.builder.mask(true),
        })
    }

    fn resource(
        &mut self,
        frame: &mut Frame<'a>,
        handle: Handle<Expression>,
    ) -> Lowered<Handle<GlobalVariable>> {
        match self.operand(frame, handle)? {
            Operand::Resource(global) => Ok(global),
            _ => Err(LowerError::Unsupported("textures in arrays")),
        }
    }

    fn slot(&self, global: Handle<GlobalVariable>) -> Lowered<TextureSlot> {
        let binding = self.module.global_variables[global].binding;
        let binding = binding.ok_or(LowerError::Unsupported("textures without a binding"))?;
        Ok(TextureSlot {
            group: binding.group,
            binding: binding.binding,
        })
    }

    fn texture_slot(&mut self, global: Handle<GlobalVariable>) -> Lowered<u32> {
        let slot = self.slot(global)?;
        Ok(position(&mut self.builder.interface_mut().textures, slot))
    }

    fn sampler_slot(&mut self, global: Handle<GlobalVariable>) -> Lowered<u32> {
        let slot = self.slot(global)?;
        Ok(position(&mut self.builder.interface_mut().samplers, slot))
    }

    fn optional(
        &mut self,
        frame: &mut Frame<'a>,
        handle: Option<Handle<Expression>>,
    ) -> Lowered<Option<Value>> {
        handle.map(|handle| self.value(frame, handle)).transpose()
    }

    fn offset(
        &mut self,
        frame: &mut Frame<'a>,
        handle: Option<Handle<Expression>>,
    ) -> Lowered<[i32; 3]> {
        let mut offset = [0; 3];
        let values = match handle {
            // Offsets are constants of the module or of the function.
            Some(handle) => self.narrow_values(frame, handle)?,
            None => Vec::new(),
        };
        for (to, value) in offset.iter_mut().zip(values) {
            let word = self.builder.constant_of(value);
            *to = word
                .ok_or(LowerError::Unsupported("computed offsets"))?
                .cast_signed();
        }
        Ok(offset)
    }

    fn level(&mut self, frame: &mut Frame<'a>, level: SampleLevel) -> Lowered<LevelOfDetail> {
        Ok(match level {
            SampleLevel::Auto => LevelOfDetail::Implicit,
            SampleLevel::Zero => LevelOfDetail::Zero,
            SampleLevel::Exact(level) => {
                let level = self.float_level(frame, level)?;
                match self.builder.constant_of(level).map(f32::from_bits) {
                    Some(0.0) => LevelOfDetail::Zero,
                    _ => LevelOfDetail::Explicit(level),
                }
            }
            SampleLevel::Bias(bias) => LevelOfDetail::Bias(self.value(frame, bias)?),
            SampleLevel::Gradient { x, y } => LevelOfDetail::Gradient {
                x: self.values(frame, x)?,
                y: self.values(frame, y)?,
            },
        })
    }

    /// Levels of depth textures are integers.
    fn float_level(&mut self, frame: &mut Frame<'a>, level: Handle<Expression>) -> Lowered<Value> {
        let value = self.value(frame, level)?;
        let to_float = match self.scalar_kind(frame, level)? {
            naga::ScalarKind::Sint => estampe_ir::op::Unary::F32FromS32,
            naga::ScalarKind::Uint => estampe_ir::op::Unary::F32FromU32,
            _ => return Ok(value),
        };
        Ok(self.builder.unary(to_float, value))
    }

    fn is_depth(&self, frame: &Frame<'a>, image: Handle<Expression>) -> Lowered<bool> {
        match self.inner(frame, image) {
            TypeInner::Image { class, .. } => Ok(matches!(class, ImageClass::Depth { .. })),
            _ => Err(LowerError::Unsupported("textures of this type")),
        }
    }

    fn dimension(&self, frame: &Frame<'a>, image: Handle<Expression>) -> Lowered<ImageDimension> {
        match self.inner(frame, image) {
            TypeInner::Image { dim, .. } => Ok(*dim),
            _ => Err(LowerError::Unsupported("textures of this type")),
        }
    }
}

/// The position of a slot in a list, to which it is added where it is missing.
fn position(slots: &mut Vec<TextureSlot>, slot: TextureSlot) -> u32 {
    let at = slots.iter().position(|one| *one == slot);
    let at = at.unwrap_or_else(|| {
        slots.push(slot);
        slots.len() - 1
    });
    u32::try_from(at).expect("few textures")
}
