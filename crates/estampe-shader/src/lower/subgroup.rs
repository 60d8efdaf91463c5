//! Subgroups: quads of four invocations.
//!
//! In fragment shaders they are the quads of derivatives, whose helper invocations take part; in
//! compute shaders four invocations with consecutive local indices. Everything is made of one
//! operation, which shows a lane's word to its quad ([`Op::QuadLane`]). Reductions and scans go
//! from lane 0 to lane 3 and leave out the lanes that do not run, so that their bits depend on
//! nothing else.

use super::half::is_half;
use super::types::is_wide;
use super::{Frame, LowerError, Lowered, Lowering, Operand};
use estampe_ir::interface::{Input, Stage};
use estampe_ir::op::{Binary, Compare, MaskBinary};
use estampe_ir::{Op, Value};
use naga::{
    BuiltIn, CollectiveOperation, Direction, Expression, GatherMode, Handle, ScalarKind, Statement,
    SubgroupOperation,
};

/// The invocations of a subgroup.
pub(super) const SIZE: u32 = 4;

const LANES: [u8; SIZE as usize] = [0, 1, 2, 3];

impl<'a> Lowering<'a> {
    /// A built-in input about subgroups.
    pub(super) fn subgroup_input(&mut self, built_in: BuiltIn) -> Lowered<Value> {
        let [x, y, z] = self.builder.interface().workgroup_size;
        let invocations = x.saturating_mul(y).saturating_mul(z);
        Ok(match built_in {
            BuiltIn::SubgroupSize => self.builder.word(SIZE),
            BuiltIn::NumSubgroups => self.builder.word(invocations.div_ceil(SIZE)),
            BuiltIn::SubgroupInvocationId => self.lane_id(),
            BuiltIn::SubgroupId => {
                let index = self.builder.input(Input::LocalInvocationIndex);
                let shift = self.builder.word(SIZE.ilog2());
                self.builder.binary(Binary::UShr, index, shift)
            }
            _ => return Err(LowerError::Unsupported("built-in inputs of this kind")),
        })
    }

    /// Lowers a statement about subgroups, and notes its result.
    pub(super) fn subgroup(&mut self, frame: &mut Frame<'a>, statement: &Statement) -> Lowered<()> {
        let (result, values) = match *statement {
            Statement::SubgroupBallot { result, predicate } => {
                let predicate = match predicate {
                    Some(predicate) => self.value(frame, predicate)?,
                    None => self.builder.mask(true),
                };
                (result, self.ballot(predicate))
            }
            Statement::SubgroupGather {
                mode,
                argument,
                result,
            } => {
                let values = self.values(frame, argument)?;
                (result, self.gathered(frame, mode, &values)?)
            }
            Statement::SubgroupCollectiveOperation {
                op,
                collective_op,
                argument,
                result,
            } => {
                let scalar = self.scalar(frame, argument)?;
                if is_wide(scalar) {
                    return Err(LowerError::Unsupported(
                        "sums of 64-bit integers in subgroups",
                    ));
                }
                let values = self.values(frame, argument)?;
                let collected = values
                    .into_iter()
                    .map(|value| self.collected((op, scalar.kind), collective_op, value));
                let mut collected = collected.collect::<Lowered<Vec<_>>>()?;
                if is_half(scalar) {
                    // The sum is that of binary32.
                    collected = self.rounded_to_half(collected);
                }
                (result, collected)
            }
            _ => return Err(LowerError::Unsupported("statements of this kind")),
        };
        frame.done.insert(result, Operand::Scalars(values));
        Ok(())
    }

    /// The invocation's place in its quad.
    fn lane_id(&mut self) -> Value {
        let one = self.builder.word(1);
        match self.builder.stage() {
            Stage::Fragment => {
                let [x, y] = [0, 1].map(|axis| {
                    let position = self.builder.input(Input::Position(axis));
                    let whole = self
                        .builder
                        .unary(estampe_ir::op::Unary::U32FromF32, position);
                    self.builder.binary(Binary::And, whole, one)
                });
                let row = self.builder.binary(Binary::Shl, y, one);
                self.builder.binary(Binary::Or, x, row)
            }
            Stage::Vertex | Stage::Compute => {
                let index = self.builder.input(Input::LocalInvocationIndex);
                let last = self.builder.word(SIZE - 1);
                self.builder.binary(Binary::And, index, last)
            }
        }
    }

    /// The word of a lane, 0 if it does not run.
    fn of_lane(&mut self, lane: u8, value: Value) -> Value {
        // The last packet of a work-group has lanes without an invocation; fragments' helpers run.
        let mask = match self.builder.stage() {
            Stage::Compute => self.slots[self.cover],
            Stage::Vertex | Stage::Fragment => self.builder.mask(true),
        };
        self.builder.op1(Op::QuadLane { lane, value, mask })
    }

    /// The words of the lanes.
    fn of_lanes(&mut self, value: Value) -> [Value; SIZE as usize] {
        LANES.map(|lane| self.of_lane(lane, value))
    }

    /// Which lanes run.
    fn running(&mut self) -> [Value; SIZE as usize] {
        let (one, zero) = (self.builder.word(1), self.builder.word(0));
        let ones = self.of_lanes(one);
        ones.map(|word| self.builder.compare(Compare::Ne, word, zero))
    }

    /// Four words, whose first has a bit for each lane.
    fn ballot(&mut self, predicate: Value) -> Vec<Value> {
        let word = self.word_of_mask(predicate, 1);
        let mut bits = self.builder.word(0);
        for (lane, vote) in LANES.into_iter().zip(self.of_lanes(word)) {
            let shift = self.builder.word(u32::from(lane));
            let bit = self.builder.binary(Binary::Shl, vote, shift);
            bits = self.builder.binary(Binary::Or, bits, bit);
        }
        let zero = self.builder.word(0);
        vec![bits, zero, zero, zero]
    }

    /// What another lane has: that lane's number, computed by each lane, is below 4, or the result
    /// is 0, as it is if that lane does not run.
    fn gathered(
        &mut self,
        frame: &mut Frame<'a>,
        mode: GatherMode,
        values: &[Value],
    ) -> Lowered<Vec<Value>> {
        let from = match mode {
            GatherMode::BroadcastFirst => {
                let running = self.running();
                let first = |lowering: &mut Self, value: Value| {
                    let words = lowering.of_lanes(value);
                    let others = running.iter().zip(words).rev();
                    others.fold(words[0], |later, (runs, word)| {
                        lowering.builder.select(*runs, word, later)
                    })
                };
                return self.each_word(values, first);
            }
            GatherMode::Broadcast(index)
            | GatherMode::Shuffle(index)
            | GatherMode::QuadBroadcast(index) => self.value(frame, index)?,
            GatherMode::ShuffleDown(delta) => self.beside(frame, Binary::Add, delta)?,
            GatherMode::ShuffleUp(delta) => self.beside(frame, Binary::Sub, delta)?,
            GatherMode::ShuffleXor(bits) => self.beside(frame, Binary::Xor, bits)?,
            GatherMode::QuadSwap(direction) => {
                let bits = match direction {
                    Direction::X => 1,
                    Direction::Y => 2,
                    Direction::Diagonal => 3,
                };
                let (lane, bits) = (self.lane_id(), self.builder.word(bits));
                self.builder.binary(Binary::Xor, lane, bits)
            }
        };
        if let Some(lane) = self.builder.constant_of(from) {
            let lane = u8::try_from(lane).ok().filter(|lane| LANES.contains(lane));
            return self.each_word(values, |lowering, value| match lane {
                Some(lane) => lowering.of_lane(lane, value),
                None => lowering.builder.word(0),
            });
        }
        let is_lane = LANES.map(|lane| {
            let lane = self.builder.word(u32::from(lane));
            self.builder.compare(Compare::Eq, from, lane)
        });
        self.each_word(values, |lowering, value| {
            let words = lowering.of_lanes(value);
            let zero = lowering.builder.word(0);
            let choices = is_lane.iter().zip(words);
            choices.fold(zero, |other, (is_it, word)| {
                lowering.builder.select(*is_it, word, other)
            })
        })
    }

    /// The number of this lane and another one, combined.
    fn beside(
        &mut self,
        frame: &mut Frame<'a>,
        kind: Binary,
        other: Handle<Expression>,
    ) -> Lowered<Value> {
        let (lane, other) = (self.lane_id(), self.value(frame, other)?);
        Ok(self.builder.binary(kind, lane, other))
    }

    /// Values whose words are exchanged; those that are masks are words on the way.
    fn each_word(
        &mut self,
        values: &[Value],
        mut exchange: impl FnMut(&mut Self, Value) -> Value,
    ) -> Lowered<Vec<Value>> {
        let mut exchanged = Vec::with_capacity(values.len());
        for &value in values {
            let is_mask = self.builder.kind(value) == estampe_ir::Type::Mask;
            if !is_mask {
                exchanged.push(exchange(self, value));
                continue;
            }
            let word = self.word_of_mask(value, 1);
            let word = exchange(self, word);
            let zero = self.builder.word(0);
            exchanged.push(self.builder.compare(Compare::Ne, word, zero));
        }
        Ok(exchanged)
    }

    /// A reduction over the lanes that run, or over those up to this one.
    fn collected(
        &mut self,
        (operation, kind): (SubgroupOperation, ScalarKind),
        over: CollectiveOperation,
        value: Value,
    ) -> Lowered<Value> {
        if matches!(operation, SubgroupOperation::All | SubgroupOperation::Any) {
            return Ok(self.vote(operation, value));
        }
        let (combine, identity) = combination(operation, kind)?;
        let running = self.running();
        let words = self.of_lanes(value);
        let lane = self.lane_id_if(over != CollectiveOperation::Reduce);
        let mut sum = self.builder.word(identity);
        for (from, (runs, word)) in (0..).zip(running.into_iter().zip(words)) {
            let mut counts = runs;
            if let Some(lane) = lane {
                let from = self.builder.word(from);
                let before = match over {
                    CollectiveOperation::ExclusiveScan => Compare::ULt,
                    _ => Compare::ULe,
                };
                let is_before = self.builder.compare(before, from, lane);
                counts = self.builder.mask_binary(MaskBinary::And, runs, is_before);
            }
            let with = self.builder.binary(combine, sum, word);
            sum = self.builder.select(counts, with, sum);
        }
        Ok(sum)
    }

    fn lane_id_if(&mut self, is_needed: bool) -> Option<Value> {
        is_needed.then(|| self.lane_id())
    }

    /// True if all lanes that run say so, or if any does.
    fn vote(&mut self, operation: SubgroupOperation, value: Value) -> Value {
        let is_all = operation == SubgroupOperation::All;
        // All say so if none says no, and a lane that does not run says neither.
        let vote = if is_all {
            self.builder.mask_not(value)
        } else {
            value
        };
        let word = self.word_of_mask(vote, 1);
        let [a, b, c, d] = self.of_lanes(word);
        let [ab, cd] = [[a, b], [c, d]].map(|[x, y]| self.builder.binary(Binary::Or, x, y));
        let any = self.builder.binary(Binary::Or, ab, cd);
        let zero = self.builder.word(0);
        let compare = if is_all { Compare::Eq } else { Compare::Ne };
        self.builder.compare(compare, any, zero)
    }
}

/// How two lanes are combined, and the word of no lane.
fn combination(operation: SubgroupOperation, kind: ScalarKind) -> Lowered<(Binary, u32)> {
    use ScalarKind::{Float, Sint, Uint};
    use SubgroupOperation as S;
    Ok(match (operation, kind) {
        (S::Add, Float) => (Binary::FAdd, 0),
        (S::Add, Sint | Uint) => (Binary::Add, 0),
        (S::Mul, Float) => (Binary::FMul, 1.0_f32.to_bits()),
        (S::Mul, Sint | Uint) => (Binary::Mul, 1),
        (S::Min, Float) => (Binary::FMin, f32::INFINITY.to_bits()),
        (S::Min, Sint) => (Binary::SMin, i32::MAX.cast_unsigned()),
        (S::Min, Uint) => (Binary::UMin, u32::MAX),
        (S::Max, Float) => (Binary::FMax, f32::NEG_INFINITY.to_bits()),
        (S::Max, Sint) => (Binary::SMax, i32::MIN.cast_unsigned()),
        (S::Max, Uint) => (Binary::UMax, 0),
        (S::And, _) => (Binary::And, u32::MAX),
        (S::Or, _) => (Binary::Or, 0),
        (S::Xor, _) => (Binary::Xor, 0),
        _ => return Err(LowerError::Unsupported("subgroup operations of this kind")),
    })
}
