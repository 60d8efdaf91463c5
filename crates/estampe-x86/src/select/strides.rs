//! Values that grow by the same number from lane to lane: places of arrays, mostly.
//!
//! A value has the *stride* s if in every lane of a packet, whether it runs or not, it is s more
//! than in the lane before, modulo 2³². What is the same in all lanes has the stride 0. Loads at
//! places with a small stride read whole vectors, where gathers would read word after word.
//!
//! A value that is confined by a minimum or maximum has a stride *perhaps*: code finds out. Indices
//! of arrays and coordinates of texels are such values. So are those of which another value takes
//! the place in some lanes, as where a texel is outside.
//!
//! Everything may have a stride at first; what has none, or two, spreads along edges.

use super::plan::Plan;
use estampe_ir::interface::{Input, Interface};
use estampe_ir::lanes::Kernel;
use estampe_ir::op::Binary;
use estampe_ir::{Op, Value};
use estampe_simd::LANES;

/// How much a value grows from lane to lane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Stride {
    pub(super) words: u32,
    /// False if code must find out.
    pub(super) is_certain: bool,
}

impl Stride {
    /// True if the value is the same in all lanes.
    pub(super) fn is_none(self) -> bool {
        self.is_certain && self.words == 0
    }
}

/// What is known of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Known {
    /// Nothing yet.
    Any,
    Stride(Stride),
    None,
}

impl Known {
    fn certain(words: u32) -> Self {
        let is_certain = true;
        Self::Stride(Stride { words, is_certain })
    }
}

/// The stride of each value that has one.
#[derive(Debug)]
pub(super) struct Strides(Vec<Known>);

impl Strides {
    /// The stride of a value, if it has one, perhaps.
    pub(super) fn of(&self, value: Value) -> Option<Stride> {
        match self.0[value.index()] {
            Known::Stride(stride) => Some(stride),
            Known::Any | Known::None => None,
        }
    }

    pub(super) fn new(kernel: &Kernel, plan: &Plan) -> Self {
        let mut strides = Self(vec![Known::Any; kernel.values.len()]);
        // A value changes three times at most, so this ends; most kernels need two rounds.
        let mut changes = true;
        while changes {
            changes = false;
            for (at, block) in kernel.blocks.iter().enumerate() {
                if !plan.is_reached[at] {
                    continue;
                }
                for (op, first) in &block.ops {
                    for value in first.and_next(op.results().len()) {
                        let known = strides.result(&kernel.interface, plan, (op, value));
                        changes |= strides.meet(value, known);
                    }
                }
                for jump in block.terminator.jumps() {
                    let parameters = &kernel.blocks[jump.to.index()].parameters;
                    for (&parameter, argument) in parameters.iter().zip(&jump.arguments) {
                        let known = strides.0[argument.index()];
                        changes |= strides.meet(parameter, known);
                    }
                }
            }
        }
        strides
    }

    /// Combines what is known of a value with what comes on another way; true if it changed.
    fn meet(&mut self, value: Value, known: Known) -> bool {
        let to = &mut self.0[value.index()];
        let met = match (*to, known) {
            (Known::Any, known) => known,
            (before, Known::Any) => before,
            (Known::Stride(before), Known::Stride(known)) if before.words == known.words => {
                Known::Stride(Stride {
                    words: known.words,
                    is_certain: before.is_certain && known.is_certain,
                })
            }
            _ => Known::None,
        };
        std::mem::replace(to, met) != met
    }

    fn result(&self, interface: &Interface, plan: &Plan, (op, value): (&Op, Value)) -> Known {
        if plan.is_splat(value) {
            return Known::certain(0);
        }
        match op {
            Op::Input(at) => of_input(interface, *at),
            Op::Binary(kind, pair) => self.binary(plan, *kind, *pair),
            Op::Select { yes, no, .. } => self.confined([*yes, *no]),
            _ => Known::None,
        }
    }

    fn binary(&self, plan: &Plan, kind: Binary, [a, b]: [Value; 2]) -> Known {
        let [of_a, of_b] = [a, b].map(|value| self.0[value.index()]);
        let both = |combine| both([of_a, of_b], combine);
        let times = |of: Known, factor: Option<u32>| match (of, factor) {
            (Known::Stride(stride), Some(factor)) => Known::Stride(Stride {
                words: stride.words.wrapping_mul(factor),
                ..stride
            }),
            (Known::Any, Some(_)) => Known::Any,
            _ => Known::None,
        };
        match kind {
            Binary::Add => both(u32::wrapping_add),
            Binary::Sub => both(u32::wrapping_sub),
            Binary::Mul if plan.constant(a).is_some() => times(of_b, plan.constant(a)),
            Binary::Mul => times(of_a, plan.constant(b)),
            Binary::Shl => {
                let bits = plan.constant(b).filter(|bits| *bits < u32::BITS);
                times(of_a, bits.map(|bits| 1 << bits))
            }
            Binary::UMin | Binary::SMin | Binary::SMax => self.confined([a, b]),
            _ => Known::None,
        }
    }

    /// One of two values in each lane: mostly it is the one that grows.
    fn confined(&self, pair: [Value; 2]) -> Known {
        let of = pair.map(|value| self.0[value.index()]);
        match both(of, |a, b| if b == 0 { a } else { b }) {
            Known::Stride(stride) => Known::Stride(Stride {
                is_certain: false,
                ..stride
            }),
            known => known,
        }
    }
}

/// What is known of a value that has a stride if two have.
fn both(of: [Known; 2], combine: fn(u32, u32) -> u32) -> Known {
    match of {
        [Known::None, _] | [_, Known::None] => Known::None,
        [Known::Stride(a), Known::Stride(b)] => Known::Stride(Stride {
            words: combine(a.words, b.words),
            is_certain: a.is_certain && b.is_certain,
        }),
        _ => Known::Any,
    }
}

/// The invocations of a work-group are in order in its packets, if the last packet is full.
fn of_input(interface: &Interface, at: u32) -> Known {
    let [width, height, depth] = interface.workgroup_size.map(|side| side as usize);
    let invocations = width.saturating_mul(height).saturating_mul(depth);
    let rows = width.is_multiple_of(LANES) && width > 0;
    match interface.inputs.get(at as usize) {
        Some(Input::LocalInvocationIndex) if invocations.is_multiple_of(LANES) => Known::certain(1),
        Some(Input::LocalInvocationId(0)) if rows => Known::certain(1),
        Some(Input::LocalInvocationId(_)) if rows => Known::certain(0),
        _ => Known::None,
    }
}
