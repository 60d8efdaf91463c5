//! Accesses to packed texels as operations on words.
//!
//! In · Out: a tree that loads or stores texels one by one · one that does the same where those
//! textures are *packed*: two-dimensional, each texel a word of four unorm bytes, as
//! `pack4x8unorm` makes it, row by row. Their words are buffers, so a back end needs no call for a
//! texel, and saves no registers around it. Whether textures are packed is known when they are
//! bound: the front end keeps both trees.

use crate::interface::{BufferSlot, Input};
use crate::op::{Binary, Compare, LevelOfDetail, MaskBinary, TextureOp, TextureQuery, Unary};
use crate::tree::{Node, Tree};
use crate::{Op, Type, Value};
use std::collections::{BTreeMap, HashSet};

/// A texture whose texels a tree loads, or stores, at two coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PackedTexture {
    /// The position in the interface.
    pub texture: u32,
    /// True if texels are stored, and none is loaded; false if they are loaded, and none is stored.
    pub is_stored: bool,
}

/// The textures that [`access_packed`] can make buffers of, by their position in the interface.
#[must_use]
pub fn packed_textures(tree: &Tree) -> Vec<PackedTexture> {
    let zeros = zeros(tree);
    // What is done with each: loads, stores, stores that cannot be made.
    let mut found: BTreeMap<u32, [bool; 3]> = BTreeMap::new();
    each_op(&tree.body, &mut |op, _| {
        let Op::Texture(op) = op else { return };
        let [loads, stores, others] = found.entry(op.texture).or_default();
        match (op.query, is_plain(op, &zeros)) {
            (TextureQuery::Load, is_plain) => *loads |= is_plain,
            (TextureQuery::Store, true) => *stores = true,
            (TextureQuery::Store, false) => *others = true,
            _ => {}
        }
    });
    let packed = |(texture, [loads, stores, others]): (u32, [bool; 3])| {
        let is_one = loads != stores && !others;
        let is_stored = stores;
        is_one.then_some(PackedTexture { texture, is_stored })
    };
    found.into_iter().filter_map(packed).collect()
}

/// Makes accesses to these textures operations on buffers, which are added to the interface in the
/// same order, and adds their sides to the inputs.
pub fn access_packed(tree: &mut Tree, textures: &[PackedTexture]) {
    let zeros = zeros(tree);
    let interface = &mut tree.interface;
    let mut stores = false;
    each_op(&tree.body, &mut |op, _| {
        stores |= matches!(
            op,
            Op::StoreBuffer { .. } | Op::Atomic { .. } | Op::CompareExchange { .. }
        );
    });
    if !stores {
        // No texture is the memory of a buffer.
        for buffer in &mut interface.buffers {
            buffer.is_written = false;
        }
    }
    let mut packed = BTreeMap::new();
    for &PackedTexture { texture, is_stored } in textures {
        let Some(&slot) = interface.textures.get(texture as usize) else {
            continue;
        };
        let sides = [0, 1].map(|axis| {
            let input = Input::TextureSide { texture, axis };
            push(&mut interface.inputs, input)
        });
        let buffer = BufferSlot {
            group: slot.group,
            binding: slot.binding,
            is_written: is_stored,
        };
        let buffer = push(&mut interface.buffers, buffer);
        packed.insert(texture, Packed { buffer, sides });
    }
    let body = std::mem::take(&mut tree.body);
    let mut packer = Packer {
        types: &mut tree.types,
        packed,
        zeros,
    };
    tree.body = packer.body(body);
}

/// Adds an entry, and returns its position.
fn push<T>(entries: &mut Vec<T>, entry: T) -> u32 {
    entries.push(entry);
    position(entries.len() - 1)
}

fn position(at: usize) -> u32 {
    u32::try_from(at).expect("a tree of fewer than 2^32 values")
}

/// The values that are the constant 0.
fn zeros(tree: &Tree) -> HashSet<Value> {
    let mut zeros = HashSet::new();
    each_op(&tree.body, &mut |op, first| {
        if *op == Op::Constant(0) {
            zeros.insert(first);
        }
    });
    zeros
}

/// True if an access is to texels at two coordinates of the finest level, or to that level's size.
fn is_plain(op: &TextureOp, zeros: &HashSet<Value>) -> bool {
    let is_finest = match op.level {
        LevelOfDetail::Zero => true,
        LevelOfDetail::Explicit(level) => zeros.contains(&level),
        _ => false,
    };
    let at = op.coordinates.len();
    let has_place = match op.query {
        TextureQuery::Load | TextureQuery::Store => at == 2 && op.sample.is_none(),
        TextureQuery::Size => true,
        _ => false,
    };
    is_finest && has_place && op.layer.is_none() && op.offset == [0; 3]
}

/// Calls `visit` with each operation and its first result.
fn each_op(nodes: &[Node], visit: &mut impl FnMut(&Op, Value)) {
    for node in nodes {
        match node {
            Node::Op { op, first } => visit(op, *first),
            Node::If { accept, reject, .. } => {
                each_op(accept, visit);
                each_op(reject, visit);
            }
            Node::Block { body, .. } | Node::Loop { body, .. } => each_op(body, visit),
            Node::Branch { .. } => {}
        }
    }
}

/// Where a packed texture is in the interface.
#[derive(Debug, Clone, Copy)]
struct Packed {
    buffer: u32,
    /// The inputs that are its width and height.
    sides: [u32; 2],
}

struct Packer<'a> {
    types: &'a mut Vec<Type>,
    packed: BTreeMap<u32, Packed>,
    zeros: HashSet<Value>,
}

impl Packer<'_> {
    fn body(&mut self, nodes: Vec<Node>) -> Vec<Node> {
        let mut done = Vec::with_capacity(nodes.len());
        for mut node in nodes {
            match &mut node {
                Node::Op {
                    op: Op::Texture(op),
                    first,
                } => {
                    let packed = self.packed.get(&op.texture);
                    if let Some(&packed) = packed.filter(|_| is_plain(op, &self.zeros)) {
                        let mut writer = Writer {
                            types: self.types,
                            nodes: &mut done,
                        };
                        writer.access(packed, op, *first);
                        continue;
                    }
                }
                Node::If { accept, reject, .. } => {
                    for part in [accept, reject] {
                        *part = self.body(std::mem::take(part));
                    }
                }
                Node::Block { body, .. } | Node::Loop { body, .. } => {
                    *body = self.body(std::mem::take(body));
                }
                Node::Op { .. } | Node::Branch { .. } => {}
            }
            done.push(node);
        }
        done
    }
}

/// Writes operations in place of an access.
struct Writer<'a> {
    types: &'a mut Vec<Type>,
    nodes: &'a mut Vec<Node>,
}

impl Writer<'_> {
    fn access(&mut self, packed: Packed, op: &TextureOp, first: Value) {
        match (op.query, &op.coordinates[..], &op.stored[..]) {
            (TextureQuery::Load, &[x, y], _) => self.load(packed, [x, y], first),
            (TextureQuery::Store, &[x, y], &[r, g, b, a]) => {
                self.store(packed, ([x, y], op.mask), [r, g, b, a]);
            }
            _ => {
                let [width, height] = packed.sides.map(Op::Input);
                let sides = [width, height, Op::Constant(1)];
                for (side, first) in sides.into_iter().zip(first.and_next(3)) {
                    self.nodes.push(Node::Op { op: side, first });
                }
            }
        }
    }

    fn load(&mut self, packed: Packed, at: [Value; 2], first: Value) {
        let (inside, offset) = self.place(packed, at);
        // Beyond the end of the words, which read as zeros there.
        let outside = self.word(u32::MAX);
        let offset = self.op(Op::Select {
            mask: inside,
            yes: offset,
            no: outside,
        });
        let buffer = packed.buffer;
        let texel = self.op(Op::LoadBuffer { buffer, offset });
        let last = self.word(255);
        let unit = self.word((1.0_f32 / 255.0).to_bits());
        for (channel, result) in (0..).zip(first.and_next(4)) {
            let bits = self.word(channel * 8);
            let code = self.binary(Binary::UShr, texel, bits);
            let code = self.binary(Binary::And, code, last);
            let code = self.op(Op::Unary(Unary::F32FromS32, code));
            let op = Op::Binary(Binary::FMul, [code, unit]);
            self.nodes.push(Node::Op { op, first: result });
        }
    }

    fn store(&mut self, packed: Packed, (at, mask): ([Value; 2], Value), channels: [Value; 4]) {
        let (inside, offset) = self.place(packed, at);
        let mask = self.op(Op::MaskBinary(MaskBinary::And, [mask, inside]));
        let mut texel = None;
        for (at, number) in (0..).zip(channels) {
            let code = self.code(number);
            let bits = self.word(at * 8);
            texel = Some(match texel {
                None => {
                    let last = self.word(255);
                    self.binary(Binary::And, code, last)
                }
                Some(others) => {
                    let code = self.binary(Binary::Shl, code, bits);
                    self.binary(Binary::Or, others, code)
                }
            });
        }
        if let Some(value) = texel {
            let buffer = packed.buffer;
            self.nodes.push(Node::Op {
                op: Op::StoreBuffer {
                    buffer,
                    offset,
                    value,
                    mask,
                },
                first: Value(0),
            });
        }
    }

    /// The lanes whose texels are inside, and the byte at which each begins.
    fn place(&mut self, packed: Packed, [x, y]: [Value; 2]) -> (Value, Value) {
        let [width, height] = packed.sides.map(|side| self.op(Op::Input(side)));
        // A negative coordinate is beyond every side.
        let [of_row, of_column] =
            [[x, width], [y, height]].map(|pair| self.op(Op::Compare(Compare::ULt, pair)));
        let inside = self.op(Op::MaskBinary(MaskBinary::And, [of_row, of_column]));
        let row = self.binary(Binary::Mul, y, width);
        let texel = self.binary(Binary::Add, row, x);
        let two = self.word(2);
        (inside, self.binary(Binary::Shl, texel, two))
    }

    /// ⌊255 · x + ½⌋ in the lowest byte, x from 0 to 1, and 0 for what is not a number; other bits
    /// above: those of 2²³.
    fn code(&mut self, number: Value) -> Value {
        let [zero, one, most, half, whole] =
            [0.0, 1.0, 255.0, 0.5, 8_388_608.0].map(|number: f32| self.word(number.to_bits()));
        let number = self.binary(Binary::FMax, number, zero);
        let number = self.binary(Binary::FMin, number, one);
        let number = self.binary(Binary::FMul, number, most);
        let number = self.binary(Binary::FAdd, number, half);
        let number = self.op(Op::Unary(Unary::FFloor, number));
        // The sum is exact, and a whole number below 2²⁴: its last bits are the number.
        self.binary(Binary::FAdd, number, whole)
    }

    fn word(&mut self, word: u32) -> Value {
        self.op(Op::Constant(word))
    }

    fn binary(&mut self, kind: Binary, a: Value, b: Value) -> Value {
        self.op(Op::Binary(kind, [a, b]))
    }

    /// Adds an operation with one result.
    fn op(&mut self, op: Op) -> Value {
        let first = Value(position(self.types.len()));
        self.types.extend(op.results());
        self.nodes.push(Node::Op { op, first });
        first
    }
}

#[cfg(test)]
mod tests;
