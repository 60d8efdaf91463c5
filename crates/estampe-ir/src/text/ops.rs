//! Operations from text.

use super::read::{Read, Reader};
use super::write_ops::QUERIES;
use crate::op::{
    Atomic, Axis, Binary, Compare, LevelOfDetail, MaskBinary, Math, Math2, Memory, Precision,
    TextureOp, TextureQuery, Unary,
};
use crate::{Op, Value};

/// The kind with a name.
macro_rules! named {
    ($kind:ident, $name:expr) => {
        $kind::ALL.iter().copied().find(|kind| kind.name() == $name)
    };
}

impl Reader<'_> {
    pub(super) fn op(&mut self) -> Read<Op> {
        let name = self.next()?;
        if let Some(kind) = named!(Unary, name) {
            return Ok(Op::Unary(kind, self.value()?));
        }
        if let Some(kind) = named!(Binary, name) {
            return Ok(Op::Binary(kind, self.list()?));
        }
        if let Some(kind) = named!(Compare, name) {
            return Ok(Op::Compare(kind, self.list()?));
        }
        if let Some(kind) = named!(MaskBinary, name) {
            return Ok(Op::MaskBinary(kind, self.list()?));
        }
        if let Some(function) = named!(Math, name) {
            return Ok(Op::Math(function, self.value()?));
        }
        if let Some(function) = named!(Math2, name) {
            return Ok(Op::Math2(function, self.list()?));
        }
        Ok(match name {
            "const" => Op::Constant(self.word()?),
            "mask" => match self.next()? {
                "true" => Op::MaskConstant(true),
                "false" => Op::MaskConstant(false),
                other => return self.error(format!("expected true or false, found `{other}`")),
            },
            "input" => Op::Input(self.number()?),
            "input_mask" => Op::InputMask(self.number()?),
            "fma" => Op::Fma(self.list()?),
            "mnot" => Op::MaskNot(self.value()?),
            "select" => {
                let [mask, yes, no] = self.list()?;
                Op::Select { mask, yes, no }
            }
            "derivative" => self.derivative()?,
            "quad_lane" => {
                let number = self.number()?;
                let lane = u8::try_from(number).ok().filter(|lane| *lane < 4);
                let Some(lane) = lane else {
                    return self.error(format!("a quad has no lane {number}"));
                };
                let [value, mask] = self.list()?;
                Op::QuadLane { lane, value, mask }
            }
            "quad_any" => Op::QuadAny(self.value()?),
            "any" => Op::Any(self.value()?),
            "barrier" => Op::Barrier,
            "texture" => Op::Texture(Box::new(self.texture()?)),
            _ => self.memory(name)?,
        })
    }

    fn derivative(&mut self) -> Read<Op> {
        let (axis, precision) = (self.next()?, self.next()?);
        let (Some(axis), Some(precision)) = (named!(Axis, axis), named!(Precision, precision))
        else {
            return self.error("expected `x` or `y`, and `fine` or `coarse`");
        };
        let [value, mask] = self.list()?;
        Ok(Op::Derivative {
            axis,
            precision,
            value,
            mask,
        })
    }

    fn memory(&mut self, name: &str) -> Read<Op> {
        Ok(match name {
            "load_local" => Op::LoadLocal {
                array: self.number()?,
                index: self.place()?,
            },
            "store_local" => {
                let (array, index) = (self.number()?, self.place()?);
                let [value, mask] = self.more()?;
                Op::StoreLocal {
                    array,
                    index,
                    value,
                    mask,
                }
            }
            "load_buffer" => Op::LoadBuffer {
                buffer: self.number()?,
                offset: self.place()?,
            },
            "store_buffer" => {
                let (buffer, offset) = (self.number()?, self.place()?);
                let [value, mask] = self.more()?;
                Op::StoreBuffer {
                    buffer,
                    offset,
                    value,
                    mask,
                }
            }
            "buffer_bytes" => Op::BufferBytes(self.number()?),
            "load_workgroup" => Op::LoadWorkgroup(self.place()?),
            "store_workgroup" => {
                let index = self.place()?;
                let [value, mask] = self.more()?;
                Op::StoreWorkgroup { index, value, mask }
            }
            "atomic" => {
                let kind = self.next()?;
                let Some(kind) = named!(Atomic, kind) else {
                    return self.error(format!("`{kind}` is no atomic operation"));
                };
                let (memory, offset) = (self.named_memory()?, self.place()?);
                let [value, mask] = self.more()?;
                Op::Atomic {
                    kind,
                    memory,
                    offset,
                    value,
                    mask,
                }
            }
            "compare_exchange" => {
                let (memory, offset) = (self.named_memory()?, self.place()?);
                let [expected, value, mask] = self.more()?;
                Op::CompareExchange {
                    memory,
                    offset,
                    expected,
                    value,
                    mask,
                }
            }
            _ => return self.error(format!("`{name}` is no operation")),
        })
    }

    fn named_memory(&mut self) -> Read<Memory> {
        match self.next()? {
            "workgroup" => Ok(Memory::Workgroup),
            "buffer" => Ok(Memory::Buffer(self.number()?)),
            other => self.error(format!("expected `buffer` or `workgroup`, found `{other}`")),
        }
    }

    fn texture(&mut self) -> Read<TextureOp> {
        let name = self.next()?;
        let query = if name == "gather" {
            let component = self.number()?;
            match u8::try_from(component) {
                Ok(component @ 0..4) => TextureQuery::Gather(component),
                _ => return self.error("a component is 0 to 3"),
            }
        } else {
            match QUERIES.iter().find(|(known, _)| *known == name) {
                Some((_, query)) => *query,
                None => return self.error(format!("`{name}` is nothing to ask of a texture")),
            }
        };
        self.expect("of")?;
        let mut op = TextureOp {
            query,
            texture: self.number()?,
            sampler: None,
            coordinates: Vec::new(),
            layer: None,
            offset: [0; 3],
            level: LevelOfDetail::Zero,
            reference: None,
            sample: None,
            stored: Vec::new(),
            mask: Value(0),
        };
        loop {
            match self.next()? {
                "sampler" => op.sampler = Some(self.number()?),
                "at" => op.coordinates = self.bracketed()?,
                "layer" => op.layer = Some(self.value()?),
                "bias" => op.level = LevelOfDetail::Bias(self.value()?),
                "level" => op.level = LevelOfDetail::Explicit(self.value()?),
                "implicit" => op.level = LevelOfDetail::Implicit,
                "gradient" => {
                    op.level = LevelOfDetail::Gradient {
                        x: self.bracketed()?,
                        y: self.bracketed()?,
                    };
                }
                "reference" => op.reference = Some(self.value()?),
                "index" => op.sample = Some(self.value()?),
                "offset" => {
                    for (at, texels) in op.offset.iter_mut().enumerate() {
                        self.expect(if at == 0 { "(" } else { "," })?;
                        *texels = self.signed()?;
                    }
                    self.expect(")")?;
                }
                "stored" => op.stored = self.bracketed()?,
                "in" => {
                    op.mask = self.value()?;
                    return Ok(op);
                }
                other => return self.error(format!("`{other}` is no part of a texture access")),
            }
        }
    }

    /// So many values between commas.
    fn list<const N: usize>(&mut self) -> Read<[Value; N]> {
        let mut values = [Value(0); N];
        for (at, value) in values.iter_mut().enumerate() {
            if at > 0 {
                self.expect(",")?;
            }
            *value = self.value()?;
        }
        Ok(values)
    }

    /// So many values, each after a comma.
    fn more<const N: usize>(&mut self) -> Read<[Value; N]> {
        self.expect(",")?;
        self.list()
    }

    /// A value in square brackets.
    fn place(&mut self) -> Read<Value> {
        self.expect("[")?;
        let value = self.value()?;
        self.expect("]")?;
        Ok(value)
    }
}
