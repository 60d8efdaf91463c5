//! Trees with packed textures give what accesses to texels give.

use super::{PackedTexture, access_packed, packed_textures};
use crate::interface::{Input, Output, Stage, TextureSlot};
use crate::lanes::{self, Kernel};
use crate::op::{LevelOfDetail, TextureOp, TextureQuery};
use crate::tree::{Builder, Surroundings, Tree, evaluate, verify};
use crate::{Op, Value};

/// Stores what is loaded from one texture, at other coordinates, to another one, and gives the
/// first channel and the size. Of a third one the level is computed.
fn tree() -> Tree {
    let mut b = Builder::new(Stage::Compute);
    let slot = |binding| TextureSlot { group: 0, binding };
    b.interface_mut().textures = (0..3).map(slot).collect();
    let [x, y] = [0, 1].map(|axis| b.input(Input::LocalInvocationId(axis)));
    let [zero, mask] = [b.word(0), b.input(Input::Cover)];
    let op = |query, texture, coordinates: &[Value], level| TextureOp {
        query,
        texture,
        sampler: None,
        coordinates: coordinates.to_vec(),
        layer: None,
        offset: [0; 3],
        level,
        reference: None,
        sample: None,
        stored: Vec::new(),
        mask,
    };
    let load = |texture, level| op(TextureQuery::Load, texture, &[x, y], level);
    let loaded = b.op(Op::Texture(Box::new(load(
        0,
        LevelOfDetail::Explicit(zero),
    ))));
    let other = b.op(Op::Texture(Box::new(load(2, LevelOfDetail::Explicit(x)))));
    let size = op(TextureQuery::Size, 1, &[], LevelOfDetail::Zero);
    let size = b.op(Op::Texture(Box::new(size)));
    let stored = vec![loaded[3], other[0], loaded[1], loaded[0]];
    b.op(Op::Texture(Box::new(TextureOp {
        stored,
        ..op(TextureQuery::Store, 1, &[y, x], LevelOfDetail::Zero)
    })));
    let outputs = [loaded[0], size[0], size[1], size[2]];
    b.finish((0..).map(Output::Varying).zip(outputs).collect())
}

/// Two textures of 5×3 texels.
struct Bound {
    place: [u32; 2],
    words: [Vec<u32>; 2],
    other: f32,
}

const SIDES: [u32; 2] = [5, 3];

impl Surroundings for Bound {
    fn input(&mut self, at: usize) -> u32 {
        // In the order of the interface: the place, the mask, and the sides of both.
        let [x, y] = self.place;
        [x, y, 1, 5, 3, 5, 3][at]
    }

    fn buffer(&mut self, at: usize) -> &mut Vec<u32> {
        &mut self.words[at]
    }

    fn workgroup(&mut self) -> &mut Vec<u32> {
        panic!("there is none")
    }

    fn texture(&mut self, op: &TextureOp, _: &[u32]) -> Vec<u32> {
        assert_eq!((op.query, op.texture), (TextureQuery::Load, 2));
        vec![self.other.to_bits(); 4]
    }
}

#[test]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a code is a byte"
)]
fn texels_are_words() {
    let mut tree = tree();
    let textures = packed_textures(&tree);
    let packed = |texture, is_stored| PackedTexture { texture, is_stored };
    assert_eq!(textures, [packed(0, false), packed(1, true)]);
    access_packed(&mut tree, &textures);
    assert_eq!(verify(&tree), Ok(()));
    assert_eq!(lanes::verify(&Kernel::from_tree(&tree)), Ok(()));
    let mut random = fastrand::Rng::with_seed(6);
    let mut inside = 0;
    for _ in 0..2000 {
        let words = [(); 2].map(|()| (0..15).map(|_| random.u32(..)).collect());
        let place = [(); 2].map(|()| random.u32(0..8).wrapping_sub(2));
        let other = match random.u32(0..4) {
            0 => f32::from_bits(random.u32(..)),
            _ => random.f32() * 1.2 - 0.1,
        };
        let mut bound = Bound {
            place,
            words,
            other,
        };
        let [from, mut expected] = bound.words.clone();
        let at =
            |[x, y]: [u32; 2]| (x < SIDES[0] && y < SIDES[1]).then(|| (y * SIDES[0] + x) as usize);
        let texel = at(place).map_or(0, |at| from[at]);
        let [r, g, _, a] = texel.to_le_bytes();
        if let Some(at) = at([place[1], place[0]]) {
            let code = (other.clamp(0.0, 1.0) * 255.0 + 0.5).floor();
            // Casts give 0 for what is not a number.
            expected[at] = u32::from_le_bytes([a, code as u8, g, r]);
            inside += 1;
        }
        let found = evaluate(&tree, &mut bound, 1000).unwrap();
        let red = f32::from(r) * (1.0 / 255.0);
        assert_eq!(found, [red.to_bits(), SIDES[0], SIDES[1], 1]);
        assert_eq!(bound.words, [from, expected]);
    }
    assert!((300..1700).contains(&inside));
}
