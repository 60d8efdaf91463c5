//! Random operations. Results of float operations become canonical, because payloads of NaNs are
//! unspecified.

use super::generate::{ARRAY, ARRAYS, Generator, READ, UNIFORMS, WRITTEN};
use estampe_ir::op::{
    Atomic, Axis, Binary, LevelOfDetail, MaskBinary, Math, Math2, Memory, Precision, TextureOp,
    TextureQuery, Unary,
};
use estampe_ir::{Op, Value};

impl Generator<'_> {
    fn one_of<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.random.usize(..all.len())]
    }

    /// A statement that is one operation, or a few.
    pub(super) fn operation(&mut self) {
        let (a, b) = (self.word(), self.word());
        let value = match self.random.u32(0..32) {
            0..=2 => {
                let mut kind = self.one_of(Unary::ALL);
                // A call.
                if self.is_free && kind == Unary::ReverseBits {
                    kind = Unary::FSqrt;
                }
                let result = self.builder.unary(kind, a);
                let is_integer = matches!(
                    kind,
                    Unary::F16FromF32
                        | Unary::S32FromF32
                        | Unary::U32FromF32
                        | Unary::Not
                        | Unary::CountOnes
                        | Unary::ReverseBits
                        | Unary::LeadingZeros
                        | Unary::TrailingZeros
                );
                if is_integer {
                    result
                } else {
                    self.canonical(result)
                }
            }
            3 => {
                let x = self.builder.unary(Unary::F32FromS32, a);
                let function = self.one_of(Math::ALL);
                let result = self.builder.math(function, x);
                self.canonical(result)
            }
            4 => {
                let function = self.one_of(Math2::ALL);
                let result = self.builder.op1(Op::Math2(function, [a, b]));
                self.canonical(result)
            }
            5 => {
                let c = self.word();
                let result = self.builder.op1(Op::Fma([a, b, c]));
                self.canonical(result)
            }
            6 | 7 => {
                let mask = self.mask();
                self.builder.select(mask, a, b)
            }
            8 => {
                let (a, b) = (self.mask(), self.mask());
                let kind = self.one_of(MaskBinary::ALL);
                self.builder.mask_binary(kind, a, b)
            }
            9 => {
                let mask = self.mask();
                self.builder.mask_not(mask)
            }
            10 => {
                let mask = self.mask();
                self.builder.op1(Op::QuadAny(mask))
            }
            11 => {
                let axis = self.one_of(Axis::ALL);
                let precision = self.one_of(Precision::ALL);
                let whole = self.builder.mask(true);
                let mask = if self.random.bool() {
                    whole
                } else {
                    self.mask()
                };
                if self.random.bool() {
                    let lane = self.random.u8(0..4);
                    let value = a;
                    self.builder.op1(Op::QuadLane { lane, value, mask })
                } else {
                    // Finite: the difference of a uniform infinity is NaN, yet 0 in quads that are
                    // not whole, and kernels call it uniform.
                    let value = self.builder.unary(Unary::F32FromS32, a);
                    let difference = self.builder.op1(Op::Derivative {
                        axis,
                        precision,
                        value,
                        mask,
                    });
                    self.canonical(difference)
                }
            }
            12 if self.is_free => {
                let (offset, buffer) = (self.offset(a), READ);
                self.builder.op1(Op::LoadBuffer { buffer, offset })
            }
            13 if self.is_free => {
                let array = self.random.u32(ARRAY + 1..ARRAYS);
                self.builder.op1(Op::LoadLocal { array, index: a })
            }
            20 if self.index.is_some() => return self.vectors(),
            12 | 16..=19 if self.has_workgroup => return self.workgroup([a, b]),
            12 | 13 if !self.is_free => return self.memory([a, b]),
            14 if !self.is_free => return self.local([a, b]),
            15 if !self.is_free => return self.texture([a, b]),
            _ => {
                let mut kind = self.one_of(Binary::ALL);
                let is_call = matches!(
                    kind,
                    Binary::SDiv | Binary::SRem | Binary::UDiv | Binary::URem
                );
                if self.is_free && is_call {
                    kind = Binary::FDiv;
                }
                let result = self.builder.binary(kind, a, b);
                if kind.name().starts_with('f') {
                    self.canonical(result)
                } else {
                    result
                }
            }
        };
        self.add(&[value]);
    }

    fn canonical(&mut self, result: Value) -> Value {
        self.builder.unary(Unary::Canonical, result)
    }

    /// A byte offset, mostly one that is in a buffer.
    fn offset(&mut self, of: Value) -> Value {
        if let Some(place) = self.strided(4) {
            return place;
        }
        if self.random.u32(0..4) == 0 {
            return of;
        }
        let limit = self.builder.word(127);
        self.builder.binary(Binary::And, of, limit)
    }

    /// A number that grows by the same number from invocation to invocation, a multiple of this one
    /// mostly.
    fn strided(&mut self, unit: u32) -> Option<Value> {
        let index = self.index.filter(|_| self.random.bool())?;
        let stride = self.builder.word(unit * self.random.u32(0..6));
        let product = self.builder.binary(Binary::Mul, index, stride);
        let first = match self.random.u32(0..4) {
            0 => self
                .builder
                .word(0_u32.wrapping_sub(self.random.u32(0..400))),
            1 => self.words[self.random.usize(..UNIFORMS as usize)],
            _ => self.builder.word(unit * self.random.u32(0..8)),
        };
        Some(self.builder.binary(Binary::Add, first, product))
    }

    /// Components of vectors that lie side by side.
    fn vectors(&mut self) {
        let of_buffer = !self.has_workgroup || self.random.bool();
        let unit = if of_buffer { 4 } else { 1 };
        let Some(mut place) = self.strided(unit * 4) else {
            return;
        };
        if self.random.bool() {
            let last = self.builder.word(self.random.u32(0..100));
            place = self.builder.binary(Binary::UMin, place, last);
        }
        for component in 0..4 {
            let added = self.builder.word(component * unit);
            let at = self.builder.binary(Binary::Add, place, added);
            if self.random.u32(0..4) == 0 {
                continue;
            }
            let loaded = if of_buffer {
                let buffer = self.one_of(&[READ, WRITTEN]);
                self.builder.op(Op::LoadBuffer { buffer, offset: at })
            } else {
                self.builder.op(Op::LoadWorkgroup(at))
            };
            self.add(&loaded);
        }
    }

    fn memory(&mut self, [at, value]: [Value; 2]) {
        let offset = self.offset(at);
        let buffer = self.one_of(&[READ, WRITTEN]);
        let mask = self.mask();
        let mask = self.builder.mask_binary(MaskBinary::And, mask, self.cover);
        let results = match self.random.u32(0..8) {
            0..=2 => self.builder.op(Op::LoadBuffer { buffer, offset }),
            3 => self.builder.op(Op::BufferBytes(buffer)),
            4 | 5 => self.builder.op(Op::StoreBuffer {
                buffer: WRITTEN,
                offset,
                value,
                mask,
            }),
            _ => self.atomic(Memory::Buffer(WRITTEN), [offset, value], mask),
        };
        self.add(&results);
    }

    /// A barrier, or an access to the memory of the work-group.
    fn workgroup(&mut self, [at, value]: [Value; 2]) {
        let few = self.builder.word(31);
        let few = self.builder.binary(Binary::And, at, few);
        let index = if self.random.u32(0..4) == 0 { at } else { few };
        let index = self.strided(1).unwrap_or(index);
        let mask = self.mask();
        let mask = self.builder.mask_binary(MaskBinary::And, mask, self.cover);
        let results = match self.random.u32(0..8) {
            0 | 1 => self.builder.op(Op::Barrier),
            2 | 3 => self.builder.op(Op::LoadWorkgroup(index)),
            4 => self.builder.op(Op::StoreWorkgroup { index, value, mask }),
            _ => self.atomic(Memory::Workgroup, [index, value], mask),
        };
        self.add(&results);
    }

    fn atomic(&mut self, memory: Memory, [offset, value]: [Value; 2], mask: Value) -> Vec<Value> {
        if self.random.u32(0..6) == 0 {
            let expected = self.word();
            return self.builder.op(Op::CompareExchange {
                memory,
                offset,
                expected,
                value,
                mask,
            });
        }
        let kind = self.one_of(Atomic::ALL);
        let result = self.builder.op(Op::Atomic {
            kind,
            memory,
            offset,
            value,
            mask,
        });
        // The result of a store is not used, and that of a half need not be.
        if kind == Atomic::Store || kind == Atomic::StoreHalf && self.random.bool() {
            Vec::new()
        } else {
            result
        }
    }

    fn local(&mut self, [at, value]: [Value; 2]) {
        let seven = self.builder.word(7);
        let few = self.builder.binary(Binary::And, at, seven);
        let index = if self.random.u32(0..4) == 0 { at } else { few };
        if self.random.bool() {
            let array = self.random.u32(0..ARRAYS);
            let loaded = self.builder.op(Op::LoadLocal { array, index });
            self.add(&loaded);
        } else {
            let mask = self.mask();
            self.builder.op(Op::StoreLocal {
                array: ARRAY,
                index,
                value,
                mask,
            });
        }
    }

    fn texture(&mut self, [x, y]: [Value; 2]) {
        use TextureQuery as Query;
        let query = self.one_of(&[
            Query::Sample,
            Query::Sample,
            Query::Sample,
            Query::Sample,
            Query::SampleCompare,
            Query::Gather(1),
            Query::GatherCompare,
            Query::Load,
            Query::Store,
            Query::Size,
            Query::Levels,
            Query::Layers,
            Query::Samples,
        ]);
        let is_sampled = matches!(
            query,
            Query::Sample | Query::SampleCompare | Query::Gather(_) | Query::GatherCompare
        );
        let is_compared = matches!(query, Query::SampleCompare | Query::GatherCompare);
        let level = self.word();
        let level = match (query, self.random.u32(0..5)) {
            (Query::Sample, 1) => LevelOfDetail::Implicit,
            (Query::Sample, 2) => LevelOfDetail::Bias(level),
            (Query::Sample, 3) => LevelOfDetail::Gradient {
                x: vec![level, x],
                y: vec![y, level],
            },
            (Query::Sample | Query::Load | Query::Size, 4) => LevelOfDetail::Explicit(level),
            _ => LevelOfDetail::Zero,
        };
        let is_located = is_sampled || matches!(query, Query::Load | Query::Store);
        let always = self.builder.mask(true);
        let stored = [self.word(), x, y, self.word()];
        let operation = TextureOp {
            query,
            texture: 0,
            sampler: is_sampled.then_some(0),
            coordinates: if is_located { vec![x, y] } else { Vec::new() },
            layer: (is_located && self.random.bool()).then_some(y),
            offset: [0; 3],
            level,
            reference: is_compared.then_some(x),
            sample: (query == Query::Load && self.random.bool()).then_some(x),
            stored: if query == Query::Store {
                stored.to_vec()
            } else {
                Vec::new()
            },
            mask: if query == Query::Store {
                self.cover
            } else {
                always
            },
        };
        let results = self.builder.op(Op::Texture(Box::new(operation)));
        self.add(&results);
    }
}
