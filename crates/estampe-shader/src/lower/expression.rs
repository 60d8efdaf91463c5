//! Expressions: places, parts, and values that are put together.

use super::pointer::{Base, Pointer};
use super::types::{is_wide, kinds, part, scalars, words};
use super::wide::{self, Wide};
use super::{Frame, LowerError, Lowered, Lowering, Operand};
use estampe_ir::op::{Binary, Compare, MaskBinary, Unary};
use estampe_ir::{Op, Type, Value};
use naga::{Expression, Handle, Literal, TypeInner};

/// The number of parts up to which a computed index is a chain of choices, not memory.
const FEW_PARTS: u32 = 8;

impl<'a> Lowering<'a> {
    /// The scalars of an expression.
    pub(super) fn values(
        &mut self,
        frame: &mut Frame<'a>,
        handle: Handle<Expression>,
    ) -> Lowered<Vec<Value>> {
        match self.operand(frame, handle)? {
            Operand::Scalars(values) => Ok(values),
            Operand::Pointer(_) | Operand::Resource(_) => {
                Err(LowerError::Unsupported("pointers as values"))
            }
        }
    }

    /// The values of an expression. A 64-bit integer is the nearest one of 32 bits.
    pub(super) fn narrow_values(
        &mut self,
        frame: &mut Frame<'a>,
        handle: Handle<Expression>,
    ) -> Lowered<Vec<Value>> {
        let values = self.values(frame, handle)?;
        Ok(match self.inner(frame, handle).scalar() {
            Some(scalar) if is_wide(scalar) => {
                wide::nearest_words(&mut self.builder, &values, scalar.kind)
            }
            _ => values,
        })
    }

    /// The only scalar of an expression. A 64-bit integer is the nearest one of 32 bits: indices
    /// and mip levels that are too large stay so.
    pub(super) fn value(
        &mut self,
        frame: &mut Frame<'a>,
        handle: Handle<Expression>,
    ) -> Lowered<Value> {
        let values = self.narrow_values(frame, handle)?;
        values
            .first()
            .copied()
            .ok_or(LowerError::Unsupported("empty values"))
    }

    /// The place that an expression names.
    pub(super) fn pointer(
        &mut self,
        frame: &mut Frame<'a>,
        handle: Handle<Expression>,
    ) -> Lowered<Pointer> {
        match self.operand(frame, handle)? {
            Operand::Pointer(pointer) => Ok(pointer),
            Operand::Scalars(_) | Operand::Resource(_) => {
                Err(LowerError::Unsupported("values as pointers"))
            }
        }
    }

    /// The value of an expression, which was evaluated before, or may be anywhere.
    pub(super) fn operand(
        &mut self,
        frame: &mut Frame<'a>,
        handle: Handle<Expression>,
    ) -> Lowered<Operand> {
        match frame.done.get(&handle) {
            Some(operand) => Ok(operand.clone()),
            None => self.evaluate(frame, handle),
        }
    }

    /// The type of an expression.
    pub(super) fn inner(&self, frame: &Frame<'a>, handle: Handle<Expression>) -> &'a TypeInner {
        let module: &'a naga::Module = self.module;
        let info: &'a naga::valid::FunctionInfo = frame.info;
        info[handle].ty.inner_with(&module.types)
    }

    /// Evaluates an expression.
    pub(super) fn evaluate(
        &mut self,
        frame: &mut Frame<'a>,
        handle: Handle<Expression>,
    ) -> Lowered<Operand> {
        let function = frame.function;
        let scalars = match function.expressions[handle] {
            Expression::Literal(literal) => self.literal(literal)?,
            Expression::Constant(constant) => {
                self.constant(self.module.constants[constant].init)?
            }
            Expression::ZeroValue(ty) => {
                let types = kinds(self.module, ty)?;
                self.zeros(&types)
            }
            Expression::Compose { ref components, .. } => {
                let mut values = Vec::new();
                for component in components {
                    values.extend(self.values(frame, *component)?);
                }
                values
            }
            Expression::Access { base, index } => {
                let index = self.value(frame, index)?;
                return self.indexed(frame, base, index);
            }
            Expression::AccessIndex { base, index } => match self.operand(frame, base)? {
                Operand::Pointer(pointer) => {
                    return Ok(Operand::Pointer(self.access(&pointer, Ok(index))?));
                }
                Operand::Scalars(values) => self.part_of(frame, (base, &values), index)?,
                Operand::Resource(_) => {
                    return Err(LowerError::Unsupported("arrays of textures"));
                }
            },
            Expression::Splat { size, value } => {
                let value = self.values(frame, value)?;
                value.repeat(size as usize)
            }
            Expression::Swizzle {
                size,
                vector,
                pattern,
            } => {
                let values = self.values(frame, vector)?;
                let scalar = self.inner(frame, vector).scalar();
                let width = scalar.map_or(1, words) as usize;
                let chosen = pattern.iter().take(size as usize);
                chosen
                    .flat_map(|component| &values[*component as usize * width..][..width])
                    .copied()
                    .collect()
            }
            Expression::FunctionArgument(at) => {
                let argument = frame.arguments.get(at as usize).cloned();
                return argument.ok_or(LowerError::Unsupported("missing arguments"));
            }
            Expression::GlobalVariable(global) => {
                let operand = self.globals.get(&global).cloned();
                return operand.ok_or(LowerError::Unsupported("variables of this kind"));
            }
            Expression::LocalVariable(local) => {
                let pointer = frame.locals.get(&local).cloned();
                let pointer = pointer.ok_or(LowerError::Unsupported("stray variables"))?;
                return Ok(Operand::Pointer(pointer));
            }
            Expression::Load { pointer } => {
                let pointer = self.pointer(frame, pointer)?;
                self.load(&pointer)?
            }
            Expression::ArrayLength(pointer) => {
                let pointer = self.pointer(frame, pointer)?;
                vec![self.array_length(&pointer)?]
            }
            Expression::ImageSample { .. }
            | Expression::ImageLoad { .. }
            | Expression::ImageQuery { .. } => self.image(frame, handle)?,
            _ => {
                let values = self.computed(frame, handle)?;
                self.rounded(frame, handle, values)
            }
        };
        Ok(Operand::Scalars(scalars))
    }

    /// The part of a value at a constant index.
    fn part_of(
        &mut self,
        frame: &Frame<'a>,
        (base, values): (Handle<Expression>, &[Value]),
        index: u32,
    ) -> Lowered<Vec<Value>> {
        let part = part(self.module, self.inner(frame, base), Some(index))?;
        let count = scalars(self.module, &part.inner)?.len();
        let [start, step] = part.scalars;
        let first = (start + step * index.min(part.count.unwrap_or(1).saturating_sub(1))) as usize;
        let values = values.get(first..first + count);
        values
            .map(<[_]>::to_vec)
            .ok_or(LowerError::Unsupported("indices beyond the end"))
    }

    /// The part of a place or a value at an index that is computed.
    fn indexed(
        &mut self,
        frame: &mut Frame<'a>,
        base: Handle<Expression>,
        index: Value,
    ) -> Lowered<Operand> {
        let known = self.builder.constant_of(index);
        let values = match self.operand(frame, base)? {
            Operand::Pointer(pointer) => {
                let is_slots = matches!(pointer.base, Base::Slots(_));
                let index = known.filter(|_| is_slots).ok_or(index);
                return Ok(Operand::Pointer(self.access(&pointer, index)?));
            }
            Operand::Scalars(values) => values,
            Operand::Resource(_) => return Err(LowerError::Unsupported("arrays of textures")),
        };
        if let Some(index) = known {
            return Ok(Operand::Scalars(self.part_of(
                frame,
                (base, &values),
                index,
            )?));
        }
        let inner = self.inner(frame, base);
        let part = part(self.module, inner, None)?;
        let count = part.count.unwrap_or(1);
        let width = scalars(self.module, &part.inner)?.len();
        if count > FEW_PARTS {
            // In memory, every scalar is a word.
            let inner = inner.clone();
            let whole = if let Some(base) = self.table(&values) {
                Pointer { base, inner }
            } else {
                let words = u32::try_from(values.len()).unwrap_or(u32::MAX);
                let base = self.array(words);
                let whole = Pointer { base, inner };
                self.store(&whole, &values)?;
                whole
            };
            let place = self.access(&whole, Err(index))?;
            return Ok(Operand::Scalars(self.load(&place)?));
        }
        let mut chosen = values[..width].to_vec();
        for at in 1..count {
            let number = self.builder.word(at);
            // The last part is that of all indices beyond it.
            let kind = if at + 1 == count {
                Compare::ULe
            } else {
                Compare::Eq
            };
            let is_it = self.builder.compare(kind, number, index);
            let part = &values[at as usize * width..][..width];
            for (chosen, &value) in chosen.iter_mut().zip(part) {
                *chosen = self.builder.select(is_it, value, *chosen);
            }
        }
        Ok(Operand::Scalars(chosen))
    }

    pub(super) fn literal(&mut self, literal: Literal) -> Lowered<Vec<Value>> {
        Ok(match literal {
            Literal::F32(number) => vec![self.builder.float(number)],
            Literal::F16(number) => vec![self.builder.float(f32::from(number))],
            Literal::U32(number) => vec![self.builder.word(number)],
            Literal::I32(number) => vec![self.builder.word(number.cast_unsigned())],
            Literal::U64(number) => Wide::constant(&mut self.builder, number).to_vec(),
            Literal::I64(number) => {
                Wide::constant(&mut self.builder, number.cast_unsigned()).to_vec()
            }
            Literal::Bool(mask) => vec![self.builder.mask(mask)],
            Literal::F64(_) => return Err(LowerError::Unsupported("64-bit floats")),
            _ => return Err(LowerError::Unsupported("numbers of this width")),
        })
    }

    /// A constant expression of the module.
    pub(super) fn constant(&mut self, handle: Handle<Expression>) -> Lowered<Vec<Value>> {
        let module: &'a naga::Module = self.module;
        Ok(match module.global_expressions[handle] {
            Expression::Literal(literal) => self.literal(literal)?,
            Expression::Constant(constant) => self.constant(module.constants[constant].init)?,
            Expression::ZeroValue(ty) => {
                let types = kinds(module, ty)?;
                self.zeros(&types)
            }
            Expression::Compose { ref components, .. } => {
                let mut values = Vec::new();
                for component in components {
                    values.extend(self.constant(*component)?);
                }
                values
            }
            Expression::Splat { size, value } => {
                let value = self.constant(value)?;
                value.repeat(size as usize)
            }
            _ => return Err(LowerError::Unsupported("constants of this kind")),
        })
    }

    /// The number of elements of an array at the end of a buffer.
    fn array_length(&mut self, pointer: &Pointer) -> Lowered<Value> {
        let (
            Base::Buffer {
                buffer,
                byte,
                place,
            },
            TypeInner::Array { stride, .. },
        ) = (pointer.base, &pointer.inner)
        else {
            return Err(LowerError::Unsupported("lengths of this memory"));
        };
        let byte = self.first_byte(byte, place);
        let bytes = self.builder.op1(Op::BufferBytes(buffer));
        let left = self.builder.binary(Binary::Sub, bytes, byte);
        let stride = self.builder.word((*stride).max(1));
        let whole = self.builder.binary(Binary::UDiv, left, stride);
        // A buffer that ends before the array has no element.
        let is_before = self.builder.compare(Compare::ULt, bytes, byte);
        let zero = self.builder.word(0);
        Ok(self.builder.select(is_before, zero, whole))
    }

    /// A mask of values that are all set, or of which one is.
    pub(super) fn combined(&mut self, kind: MaskBinary, masks: &[Value]) -> Value {
        let mut masks = masks.iter();
        let Some(&first) = masks.next() else {
            return self.builder.mask(kind == MaskBinary::And);
        };
        masks.fold(first, |all, &mask| {
            self.builder.mask_binary(kind, all, mask)
        })
    }

    /// A word of a mask or a word: 1 or 0, as a number of the kind.
    pub(super) fn word_of_mask(&mut self, mask: Value, one: u32) -> Value {
        let (one, zero) = (self.builder.word(one), self.builder.word(0));
        self.builder.select(mask, one, zero)
    }

    /// The bits of a float, of which NaN has one form.
    pub(super) fn bits(&mut self, value: Value, is_float: bool) -> Value {
        if is_float && self.builder.kind(value) == Type::Word {
            self.builder.unary(Unary::Canonical, value)
        } else {
            value
        }
    }
}
