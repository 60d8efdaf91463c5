//! The accesses of a shader to memory that it writes.

mod conditions;
mod words;

use super::bytes::Bytes;
use super::form::Form;
use conditions::{Mask, always_leaves, choice, count_branches, mask_of, way_to};
use estampe_ir::op::{Atomic, Memory, TextureQuery};
use estampe_ir::tree::{Node, Tree};
use estampe_ir::{Op, Value};
use std::collections::{HashMap, HashSet};
use words::Float;

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
}

fn is_commutative(kind: Atomic) -> bool {
    !matches!(
        kind,
        Atomic::Exchange | Atomic::Load | Atomic::Store | Atomic::StoreHalf
    )
}
