//! Loads at the pixel itself, `textureLoad(map, vec2i(position.xy), 0)`, made before a shader runs.
//!
//! In · Out: a tree of the fragment stage · the loads that can be made before it runs; positions of
//! fragments · the texels.
//!
//! Passes over a whole picture load so: deferred lighting, tone mapping. A packet's texels are rows
//! of neighbours in memory, and where they are does not depend on what the shader computes.

use super::facts::Facts;
use super::nondependent::TOGETHER;
use super::samples::MOST;
use super::textures::BoundTextures;
use estampe_ir::interface::Input;
use estampe_ir::op::{Binary, LevelOfDetail, TextureOp, TextureQuery, Unary};
use estampe_ir::tree::{Node, Tree};
use estampe_ir::{Op, Value};
use estampe_simd::{LANES, Lanes, Level, Packet, SimdBase, dispatch, i32x16};
use estampe_texture::{TexelView, TextureBindings, TiledTexels};
use std::collections::HashMap;

/// More than any position in the window.
const LARGE: f32 = 65_536.0;

/// A load that is made before.
pub(super) struct Load {
    /// Its first result.
    pub(super) first: Value,
    /// The position in the interface of its texture.
    pub(super) texture: u32,
}

/// The loads of a tree that are made before, so many at most: those in the outermost body and in
/// its blocks, where an early return may come before them, but not those in one arm of a branch or
/// in a loop. A shader that stores may store what it loads, so its loads stay in the code.
pub(super) fn found(tree: &Tree, most: usize) -> Vec<Load> {
    if Facts::of(tree).stores {
        return Vec::new();
    }
    let mut finder = Finder {
        tree,
        definitions: HashMap::new(),
        loads: Vec::new(),
    };
    finder.walk(&tree.body);
    finder.loads.truncate(most);
    finder.loads
}

struct Finder<'a> {
    tree: &'a Tree,
    /// The operations that give values.
    definitions: HashMap<Value, &'a Op>,
    loads: Vec<Load>,
}

impl<'a> Finder<'a> {
    fn walk(&mut self, nodes: &'a [Node]) {
        for node in nodes {
            match node {
                Node::Op { op, first } => {
                    self.definitions.insert(*first, op);
                    if let Op::Texture(op) = op
                        && self.is_at_pixel(op)
                    {
                        self.loads.push(Load {
                            first: *first,
                            texture: op.texture,
                        });
                    }
                }
                Node::Block { body, .. } => self.walk(body),
                Node::If { .. } | Node::Loop { .. } | Node::Branch { .. } => {}
            }
        }
    }

    /// True if the finest level of a two-dimensional texture is loaded from at the pixel.
    fn is_at_pixel(&self, op: &TextureOp) -> bool {
        let is_finest = match op.level {
            LevelOfDetail::Zero => true,
            LevelOfDetail::Explicit(level) => {
                self.definitions.get(&level) == Some(&&Op::Constant(0))
            }
            _ => false,
        };
        let is_plain = op.layer.is_none() && op.sample.is_none() && op.offset == [0; 3];
        op.query == TextureQuery::Load
            && is_finest
            && is_plain
            && op.coordinates.len() == 2
            && (op.coordinates.iter().zip(0..)).all(|(at, axis)| self.is_of_pixel(*at, axis))
    }

    /// True if a value is the number of the pixel's column (axis 0) or row (1). Positions in the
    /// window are not negative, so it does not matter which kind of integer they become.
    fn is_of_pixel(&self, value: Value, axis: u32) -> bool {
        let operation = |value: &Value| self.definitions.get(value).copied();
        let Some(Op::Unary(Unary::S32FromF32 | Unary::U32FromF32, position)) = operation(&value)
        else {
            return false;
        };
        let position = match operation(position) {
            // What holds floats to those that an integer can be.
            Some(Op::Binary(Binary::FMin, [a, b])) => match (operation(a), operation(b)) {
                (Some(Op::Constant(most)), other) | (other, Some(Op::Constant(most)))
                    if f32::from_bits(*most) >= LARGE =>
                {
                    other
                }
                _ => None,
            },
            other => other,
        };
        match position {
            Some(Op::Input(at)) => {
                self.tree.interface.inputs.get(*at as usize) == Some(&Input::Position(axis))
            }
            _ => false,
        }
    }
}

impl BoundTextures<'_> {
    /// Loads the texels of several textures at the pixels of fragments, given by their positions in
    /// the window; of each packet there are as many texels as textures.
    pub(super) fn load_at_pixels(
        &self,
        level: Level,
        textures: &[u32],
        positions: &[[Packet<f32>; 4]],
        texels: &mut [[Packet<f32>; 4]],
    ) {
        let each = textures.len().clamp(1, MOST);
        let (mut tiled, mut views) = ([None; MOST], [None; MOST]);
        let mut are_all_viewed = true;
        for ((tiled, view), texture) in tiled.iter_mut().zip(&mut views).zip(textures) {
            let (group, binding) = self.slot_of(*texture);
            *tiled = self.bindings.tiled_texels(group, binding);
            if tiled.is_none() {
                *view = self.loaded(*texture);
                are_all_viewed &= view.is_some();
            }
        }
        let (tiled, views) = (&tiled[..each], &views[..each]);
        if tiled.iter().any(Option::is_some) {
            TiledTexels::fetch_at_pixels(tiled, level, positions, texels);
        }
        if tiled.iter().all(Option::is_some) {
            return;
        }
        let batches = positions.chunks(TOGETHER);
        for (positions, texels) in batches.zip(texels.chunks_mut(TOGETHER * each)) {
            let mut left = match are_all_viewed {
                true => TexelView::fetch_at_pixels(views, level, positions, texels),
                // Shaders store to one of them.
                false => u32::MAX,
            };
            let packets = positions.iter().zip(texels.chunks_mut(each));
            for ([x, y, ..], texels) in packets {
                if left & 1 == 1 {
                    let loads = textures.iter().zip(texels).zip(tiled);
                    let of_views = loads.filter(|(_, tiled)| tiled.is_none());
                    for ((texture, texels), _) in of_views {
                        dispatch!(level, s => self.load_at(s, *texture, [x, y], texels));
                    }
                }
                left >>= 1;
            }
        }
    }

    /// Loads the texels of a texture at the pixels of one packet.
    #[inline(always)]
    fn load_at<S: Lanes>(
        &self,
        s: S,
        texture: u32,
        at: [&Packet<f32>; 2],
        texels: &mut [Packet<f32>; 4],
    ) {
        let mut places = [[0; LANES]; 2];
        for (places, at) in places.iter_mut().zip(at) {
            for (place, at) in places.iter_mut().zip(at.0) {
                *place = Unary::S32FromF32.evaluate(at.to_bits()).cast_signed();
            }
        }
        let zero = <i32x16<S> as SimdBase<S>>::splat(s, 0);
        let [x, y] = &places;
        let at = [
            i32x16::load_array_ref(s, x),
            i32x16::load_array_ref(s, y),
            zero,
        ];
        let texel = self.fetch(texture, at, zero, zero);
        let [r, g, b, a] = texels;
        texel.x.store_array(&mut r.0);
        texel.y.store_array(&mut g.0);
        texel.z.store_array(&mut b.0);
        texel.w.store_array(&mut a.0);
    }
}
