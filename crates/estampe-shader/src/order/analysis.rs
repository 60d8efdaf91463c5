//! The accesses of a shader to memory that it writes.

use super::bytes::Bytes;
use super::form::{Coefficient, Form, Symbol, Variable};
use estampe_ir::interface::{BufferSlot, Input};
use estampe_ir::op::{Atomic, Binary, Compare, Memory, TextureQuery, Unary};
use estampe_ir::tree::{Label, Node, Tree};
use estampe_ir::{Op, Value};
use std::collections::{HashMap, HashSet};

/// The places that a compute shader reads and writes in the buffers and textures that it writes.
#[derive(Debug, Clone, Default)]
pub struct Accesses {
    /// The invocations of a work-group along x, y and z.
    pub(super) size: [u32; 3],
    /// By position in the interface.
    pub(super) buffers: Vec<OfBuffer>,
    /// By position in the interface.
    pub(super) textures: Vec<OfTexture>,
}

/// The accesses to a buffer.
#[derive(Debug, Clone, Default)]
pub(super) struct OfBuffer {
    /// The group and binding.
    pub(super) place: (u32, u32),
    /// The bytes that are used.
    pub(super) forms: Vec<Form>,
    pub(super) is_stored: bool,
    /// The kinds of atomic operations whose results are not used.
    pub(super) atomics: HashSet<Atomic>,
    /// There are accesses of other kinds.
    pub(super) others: bool,
}

/// The accesses to a texture.
#[derive(Debug, Clone, Default)]
pub(super) struct OfTexture {
    pub(super) place: (u32, u32),
    /// Coordinates and layers.
    pub(super) forms: Vec<Vec<Form>>,
    pub(super) is_stored: bool,
}

impl Accesses {
    /// Those of a compute shader.
    #[must_use]
    pub fn of(tree: &Tree) -> Self {
        let interface = &tree.interface;
        let buffers = interface.buffers.iter().map(|slot| OfBuffer {
            place: (slot.group, slot.binding),
            ..OfBuffer::default()
        });
        let textures = interface.textures.iter().map(|slot| OfTexture {
            place: (slot.group, slot.binding),
            ..OfTexture::default()
        });
        let accesses = Self {
            size: interface.workgroup_size,
            buffers: buffers.collect(),
            textures: textures.collect(),
        };
        let mut analysis = Analysis {
            tree,
            accesses,
            forms: HashMap::new(),
            masks: HashMap::new(),
            floats: HashMap::new(),
            used: HashSet::new(),
            bytes: Bytes::of(tree),
        };
        analysis.find_uses(&tree.body);
        analysis.body(&tree.body);
        analysis.accesses
    }
}

/// What a mask is made of.
#[derive(Debug, Clone, Copy)]
enum Mask {
    Constant(bool),
    Below(Value, Value),
    AtMost(Value, Value),
    Not(Value),
    And(Value, Value),
    Or(Value, Value),
    /// The second where the first is set, else the third.
    Choice(Value, Value, Value),
}

/// A float that is known.
#[derive(Debug, Clone, Copy)]
enum Float {
    /// The centre of the fragment's pixel along an axis, or a place in that pixel.
    Position(usize),
    /// At least as much as positions can be.
    Large,
}

struct Analysis<'a> {
    tree: &'a Tree,
    accesses: Accesses,
    /// The words that are known, refined by the conditions on the way here.
    forms: HashMap<Value, Form>,
    masks: HashMap<Value, Mask>,
    /// The positions of fragments, and constants.
    floats: HashMap<Value, Float>,
    used: HashSet<Value>,
    bytes: Bytes<'a>,
}

impl Analysis<'_> {
    fn find_uses(&mut self, nodes: &[Node]) {
        for node in nodes {
            match node {
                Node::Op { op, .. } => op.each_operand(|value, _| {
                    self.used.insert(value);
                }),
                Node::If {
                    condition,
                    accept,
                    reject,
                } => {
                    self.used.insert(*condition);
                    self.find_uses(accept);
                    self.find_uses(reject);
                }
                Node::Block { body, .. } => self.find_uses(body),
                Node::Loop { initial, body, .. } => {
                    self.used.extend(initial);
                    self.find_uses(body);
                }
                Node::Branch { arguments, .. } => self.used.extend(arguments),
            }
        }
    }

    /// Goes through a body; what conditions tell holds until its end.
    fn body(&mut self, nodes: &[Node]) {
        let mut refined = Vec::new();
        for node in nodes {
            match node {
                Node::Op { op, first } => self.op(op, *first),
                Node::If {
                    condition,
                    accept,
                    reject,
                } => {
                    self.under(*condition, true, accept);
                    self.under(*condition, false, reject);
                    // After an arm that leaves, the other one was taken.
                    if always_leaves(accept) {
                        self.assume(*condition, false, &mut refined);
                    } else if always_leaves(reject) {
                        self.assume(*condition, true, &mut refined);
                    }
                }
                Node::Block {
                    label,
                    results,
                    body,
                } => {
                    self.body(body);
                    // After a block with one way out, what led there holds.
                    if count_branches(*label, body) == 1 && always_leaves(body) {
                        let mut conditions = Vec::new();
                        way_to(*label, body, &mut conditions);
                        for (condition, truth) in conditions {
                            self.assume(condition, truth, &mut refined);
                        }
                    }
                    if let Some(choice) = choice(*label, body) {
                        self.masks
                            .extend(results.first().map(|result| (*result, choice)));
                    }
                }
                Node::Loop { body, .. } => self.body(body),
                Node::Branch { .. } => {}
            }
        }
        self.forget(refined);
    }

    fn under(&mut self, condition: Value, truth: bool, body: &[Node]) {
        let mut refined = Vec::new();
        self.assume(condition, truth, &mut refined);
        self.body(body);
        self.forget(refined);
    }

    fn forget(&mut self, refined: Vec<(Value, Form)>) {
        // The first change of a value is undone last.
        for (value, before) in refined.into_iter().rev() {
            self.forms.insert(value, before);
        }
    }

    /// Refines forms by a mask that is set, or is not.
    fn assume(&mut self, mask: Value, truth: bool, refined: &mut Vec<(Value, Form)>) {
        match (self.masks.get(&mask).copied(), truth) {
            (Some(Mask::Not(other)), _) => self.assume(other, !truth, refined),
            (Some(Mask::And(a, b)), true) | (Some(Mask::Or(a, b)), false) => {
                self.assume(a, truth, refined);
                self.assume(b, truth, refined);
            }
            (Some(Mask::Choice(condition, yes, no)), _) => {
                let is_not = |value: &Value| matches!(self.masks.get(value), Some(Mask::Constant(is)) if *is != truth);
                if is_not(&yes) {
                    self.assume(condition, false, refined);
                    self.assume(no, truth, refined);
                } else if is_not(&no) {
                    self.assume(condition, true, refined);
                    self.assume(yes, truth, refined);
                }
            }
            (Some(Mask::Below(a, b)), true) => self.is_below(a, b, 0, refined),
            (Some(Mask::AtMost(a, b)), true) => self.is_below(a, b, 1, refined),
            // Not a < b: b ≤ a.
            (Some(Mask::Below(a, b)), false) => self.is_below(b, a, 1, refined),
            (Some(Mask::AtMost(a, b)), false) => self.is_below(b, a, 0, refined),
            _ => {}
        }
    }

    /// a < b + more.
    fn is_below(&mut self, a: Value, b: Value, more: i64, refined: &mut Vec<(Value, Form)>) {
        let Some(limit) = self.form(b).coefficient() else {
            return;
        };
        let before = self.form(a);
        let mut form = before.clone();
        if let Some(axis) = before.global_axis() {
            // A symbol and one more is no coefficient.
            if limit.symbol.is_none() || more == 0 {
                let limit = Coefficient {
                    factor: limit.factor + if limit.symbol.is_none() { more } else { 0 },
                    ..limit
                };
                form.bounds[axis] = Some(limit);
            }
        } else if before.words().is_some() && limit.symbol.is_none() && limit.factor >= 0 {
            form.high = form.high.min(limit.factor + more - 1).max(form.low);
        } else {
            return;
        }
        refined.push((a, before));
        self.forms.insert(a, form);
    }

    fn form(&self, value: Value) -> Form {
        self.forms
            .get(&value)
            .cloned()
            .unwrap_or_else(Form::unknown)
    }

    fn op(&mut self, op: &Op, first: Value) {
        if let Some(mask) = mask_of(op) {
            self.masks.insert(first, mask);
        }
        if let Some(float) = self.float_of(op) {
            self.floats.insert(first, float);
        }
        if let Some(form) = self.form_of(op) {
            self.forms.insert(first, form);
        }
        match op {
            Op::LoadBuffer { buffer, offset } if self.tree.is_written(*buffer) => {
                let form = self.bytes_at(*offset, (op, first));
                self.buffer(*buffer, |accesses| {
                    accesses.forms.push(form);
                    accesses.others = true;
                });
            }
            Op::StoreBuffer { buffer, offset, .. } => {
                let form = self.bytes_at(*offset, (op, first));
                self.buffer(*buffer, |accesses| {
                    accesses.forms.push(form);
                    accesses.is_stored = true;
                    accesses.others = true;
                });
            }
            Op::Atomic {
                kind,
                memory: Memory::Buffer(buffer),
                offset,
                ..
            } => {
                let form = self.bytes_at(*offset, (op, first));
                let is_used = self.used.contains(&first);
                let kind = *kind;
                self.buffer(*buffer, |accesses| {
                    accesses.forms.push(form);
                    accesses.is_stored |= kind != Atomic::Load;
                    accesses.others |= is_used || !is_commutative(kind);
                    accesses.atomics.insert(kind);
                });
            }
            Op::CompareExchange {
                memory: Memory::Buffer(buffer),
                offset,
                ..
            } => {
                let form = self.bytes_at(*offset, (op, first));
                self.buffer(*buffer, |accesses| {
                    accesses.forms.push(form);
                    accesses.is_stored = true;
                    accesses.others = true;
                });
            }
            Op::Texture(op) => {
                let is_store = op.query == TextureQuery::Store;
                // Textures that are sampled are not stored to in the same dispatch.
                if is_store || op.query == TextureQuery::Load {
                    let places = op.coordinates.iter().chain(&op.layer);
                    let forms = places.map(|value| self.form(*value)).collect();
                    if let Some(of) = self.accesses.textures.get_mut(op.texture as usize) {
                        of.forms.push(forms);
                        of.is_stored |= is_store;
                    }
                }
            }
            _ => {}
        }
    }

    /// The bytes that an operation uses.
    fn bytes_at(&self, offset: Value, op: (&Op, Value)) -> Form {
        let form = self.form(offset);
        self.bytes.used(op, (offset, &form), self.accesses.size)
    }

    fn buffer(&mut self, buffer: u32, change: impl FnOnce(&mut OfBuffer)) {
        if let Some(accesses) = self.accesses.buffers.get_mut(buffer as usize) {
            change(accesses);
        }
    }

    fn float_of(&self, op: &Op) -> Option<Float> {
        match *op {
            Op::Input(at) => match self.tree.interface.inputs.get(at as usize)? {
                Input::Position(axis @ 0..2) => Some(Float::Position(*axis as usize)),
                _ => None,
            },
            Op::Constant(word) if f32::from_bits(word) >= 65_536.0 => Some(Float::Large),
            Op::Unary(Unary::FFloor | Unary::FTrunc, a) => self.floats.get(&a).copied(),
            // What holds floats to those that an integer can be.
            Op::Binary(Binary::FMin, [a, b]) => {
                match (self.floats.get(&a)?, self.floats.get(&b)?) {
                    (Float::Large, other) | (other, Float::Large) => Some(*other),
                    (Float::Position(_), Float::Position(_)) => None,
                }
            }
            _ => None,
        }
    }

    /// The word that an operation gives, if it is known.
    fn form_of(&self, op: &Op) -> Option<Form> {
        let size = self.accesses.size;
        let number = |value: u32| Form::interval(i64::from(value), i64::from(value));
        match op {
            Op::Constant(word) => Some(number(*word)),
            Op::Input(at) => match *self.tree.interface.inputs.get(*at as usize)? {
                Input::WorkgroupId(axis) if axis < 3 => {
                    Some(Form::variable(Variable::Group(axis as usize)))
                }
                Input::LocalInvocationId(axis) if axis < 3 => {
                    Some(Form::variable(Variable::Local(axis as usize)))
                }
                Input::LocalInvocationIndex => {
                    let [x, y, z] = [0, 1, 2].map(|axis| Form::variable(Variable::Local(axis)));
                    let of = |factor: u32| Coefficient::number(i64::from(factor));
                    let rows = y.product(of(size[0]))?;
                    let slices = z.product(of(size[0].checked_mul(size[1])?))?;
                    x.sum(&rows, size)?.sum(&slices, size)
                }
                Input::NumWorkgroups(axis) if axis < 3 => {
                    Some(Form::symbol(Symbol::Workgroups(axis as usize)))
                }
                Input::PushConstant(at) => Some(Form::symbol(Symbol::Immediate(at))),
                _ => None,
            },
            Op::LoadBuffer { buffer, offset } if !self.tree.is_written(*buffer) => {
                let offset = self.form(*offset).only_interval()?;
                let offset = u32::try_from(offset[0])
                    .ok()
                    .filter(|_| offset[0] == offset[1])?;
                let (buffer, offset) = (*buffer, offset & !3);
                Some(Form::symbol(
                    match self.tree.interface.buffers.get(buffer as usize) {
                        Some(&BufferSlot::IMMEDIATES) => Symbol::Immediate(offset / 4),
                        _ => Symbol::Word { buffer, offset },
                    },
                ))
            }
            Op::BufferBytes(buffer) => Some(Form::symbol(Symbol::Elements {
                buffer: *buffer,
                bytes: 1,
            })),
            Op::Select { yes, no, .. } => {
                let (yes, no) = (self.form(*yes), self.form(*no));
                let [low, high] = [yes.low.min(no.low), yes.high.max(no.high)];
                let is_same = yes.terms == no.terms && yes.constants == no.constants;
                let conditions = [&yes.conditions[..], &no.conditions[..]].concat();
                is_same.then_some(Form {
                    low,
                    high,
                    conditions,
                    ..yes
                })
            }
            Op::Binary(kind, [a, b]) => self.binary(*kind, &self.form(*a), &self.form(*b)),
            Op::Unary(Unary::S32FromF32 | Unary::U32FromF32, a) => match self.floats.get(a)? {
                Float::Position(axis) => Some(Form::variable(Variable::Pixel(*axis))),
                Float::Large => None,
            },
            _ => None,
        }
    }

    fn binary(&self, kind: Binary, a: &Form, b: &Form) -> Option<Form> {
        let size = self.accesses.size;
        let constant = |form: &Form| {
            let coefficient = form.coefficient()?;
            let is_word = coefficient.symbol.is_none() && u32::try_from(coefficient.factor).is_ok();
            is_word.then_some(coefficient)
        };
        match kind {
            Binary::Add => a.sum(b, size),
            Binary::Sub => a.sum(&b.product(Coefficient::number(-1))?, size),
            Binary::Mul => match (a.coefficient(), b.coefficient()) {
                (_, Some(factor)) => a.product(factor),
                (Some(factor), None) => b.product(factor),
                (None, None) => None,
            },
            Binary::Shl => {
                let bits = constant(b)?.factor;
                a.product(Coefficient::number(1 << u32::try_from(bits).ok()?.min(31)))
            }
            Binary::And => {
                let [a, b] = [constant(a), constant(b)];
                let most = a.or(b)?.factor;
                Some(Form::interval(0, most))
            }
            Binary::URem => {
                let divisor = constant(b)?.factor;
                Some(Form::interval(0, (divisor - 1).max(0)))
            }
            Binary::UDiv => {
                let divisor = constant(b)?.factor.max(1);
                if let Some(length) = a.divided_length(divisor) {
                    return Some(length);
                }
                let [low, high] = a.words()?;
                Some(Form::interval(low / divisor, high / divisor))
            }
            Binary::UShr => {
                let bits = constant(b)?.factor & 31;
                if let Some(length) = a.divided_length(1 << bits) {
                    return Some(length);
                }
                let [low, high] = a.words()?;
                Some(Form::interval(low >> bits, high >> bits))
            }
            Binary::UMin => {
                let (form, most) = match (constant(a), constant(b)) {
                    (_, Some(most)) => (a, most),
                    (Some(most), None) => (b, most),
                    (None, None) => return None,
                };
                Some(form.at_most(u32::try_from(most.factor).ok()?))
            }
            _ => None,
        }
    }
}

fn is_commutative(kind: Atomic) -> bool {
    !matches!(
        kind,
        Atomic::Exchange | Atomic::Load | Atomic::Store | Atomic::StoreHalf
    )
}

fn mask_of(op: &Op) -> Option<Mask> {
    match *op {
        Op::MaskConstant(is) => Some(Mask::Constant(is)),
        Op::Compare(Compare::ULt, [a, b]) => Some(Mask::Below(a, b)),
        Op::Compare(Compare::ULe, [a, b]) => Some(Mask::AtMost(a, b)),
        Op::MaskNot(a) => Some(Mask::Not(a)),
        Op::MaskBinary(estampe_ir::op::MaskBinary::And, [a, b]) => Some(Mask::And(a, b)),
        Op::MaskBinary(estampe_ir::op::MaskBinary::Or, [a, b]) => Some(Mask::Or(a, b)),
        _ => None,
    }
}

/// True if a body ends with a branch on every way.
fn always_leaves(body: &[Node]) -> bool {
    match body.last() {
        Some(Node::Branch { .. }) => true,
        Some(Node::If { accept, reject, .. }) => always_leaves(accept) && always_leaves(reject),
        Some(Node::Block { label, body, .. }) => {
            count_branches(*label, body) == 0 && always_leaves(body)
        }
        _ => false,
    }
}

/// The conditions on the way to the one branch to a label, as far as they are seen.
fn way_to(label: Label, body: &[Node], conditions: &mut Vec<(Value, bool)>) {
    for node in body {
        let Node::If {
            condition,
            accept,
            reject,
        } = node
        else {
            continue;
        };
        if count_branches(label, accept) > 0 {
            conditions.push((*condition, true));
            return way_to(label, accept, conditions);
        }
        if count_branches(label, reject) > 0 {
            conditions.push((*condition, false));
            return way_to(label, reject, conditions);
        }
        if always_leaves(accept) {
            conditions.push((*condition, false));
        } else if always_leaves(reject) {
            conditions.push((*condition, true));
        }
    }
}

/// The result of a block that ends with a choice: `a || b` that evaluates b only if it must.
fn choice(label: Label, body: &[Node]) -> Option<Mask> {
    let argument = |body: &[Node]| match body.last()? {
        Node::Branch {
            label: to,
            arguments,
        } if *to == label => match arguments[..] {
            [one] => Some(one),
            _ => None,
        },
        _ => None,
    };
    let Node::If {
        condition,
        accept,
        reject,
    } = body.last()?
    else {
        return None;
    };
    // No other branch goes to the block.
    let count = count_branches(label, body);
    (count == 2).then_some(())?;
    Some(Mask::Choice(
        *condition,
        argument(accept)?,
        argument(reject)?,
    ))
}

fn count_branches(label: Label, body: &[Node]) -> usize {
    let of = |node: &Node| match node {
        Node::Op { .. } => 0,
        Node::If { accept, reject, .. } => {
            count_branches(label, accept) + count_branches(label, reject)
        }
        Node::Block { body, .. } | Node::Loop { body, .. } => count_branches(label, body),
        Node::Branch { label: to, .. } => usize::from(*to == label),
    };
    body.iter().map(of).sum()
}
