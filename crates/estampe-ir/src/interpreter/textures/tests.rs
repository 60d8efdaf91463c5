//! Tests of what accesses have in common, and of taking one after the other.

use super::{Common, TextureAccesses};
use crate::Value;
use crate::op::{LevelOfDetail, TextureOp, TextureQuery};
use estampe_simd::{LANES, Level, Packet};

fn sample(texture: u32, at: [u32; 2], level: LevelOfDetail) -> TextureOp {
    TextureOp {
        query: TextureQuery::Sample,
        texture,
        sampler: Some(0),
        coordinates: at.map(Value).to_vec(),
        layer: None,
        offset: [0; 3],
        level,
        reference: None,
        sample: None,
        stored: Vec::new(),
        mask: Value(0),
    }
}

#[test]
fn accesses_share_coordinates_a_reference_or_a_texture() {
    use LevelOfDetail::{Explicit, Implicit, Zero};
    let of = |ops: &[TextureOp]| Common::of(ops);
    let (here, there) = ([1, 2], [3, 4]);
    let taps = [sample(0, here, Zero), sample(0, there, Zero)];
    assert_eq!(of(&taps), Common::Texture);
    let by_quads = [sample(0, here, Implicit), sample(0, there, Implicit)];
    assert_eq!(of(&by_quads), Common::Texture);
    let maps = [sample(0, here, Implicit), sample(1, here, Implicit)];
    assert_eq!(of(&maps), Common::Coordinates);
    let levels = [sample(0, here, Zero), sample(0, there, Implicit)];
    assert_eq!(of(&levels), Common::Nothing);
    let computed = [sample(0, here, Explicit(Value(5))), sample(0, there, Zero)];
    assert_eq!(of(&computed), Common::Nothing);
    // An access alone has all in common with itself.
    assert_eq!(of(&taps[..1]), Common::Texture);
    assert_eq!(of(&maps[..1]), Common::Coordinates);
    assert_eq!(of(&computed[..1]), Common::Nothing);
    let others = [sample(0, here, Zero), sample(1, there, Zero)];
    assert_eq!(of(&others), Common::Nothing);
    let mut compared = [taps.to_vec(), levels.to_vec()].concat();
    compared[3].level = gradient(7);
    for op in &mut compared {
        op.query = TextureQuery::SampleCompare;
        op.reference = Some(Value(6));
    }
    assert_eq!(of(&compared), Common::Reference);
}

fn gradient(x: u32) -> LevelOfDetail {
    LevelOfDetail::Gradient {
        x: [x, 8].map(Value).to_vec(),
        y: [9, 10].map(Value).to_vec(),
    }
}

#[test]
fn accesses_share_coordinates_with_their_gradients() {
    let at = |texture: u32, at: [u32; 2], x: u32| sample(texture, at, gradient(x));
    let maps = [at(0, [1, 2], 7), at(1, [1, 2], 7), at(0, [1, 2], 7)];
    assert_eq!(Common::of(&maps), Common::Coordinates);
    let by_quads = sample(1, [1, 2], LevelOfDetail::Implicit);
    for other in [
        at(1, [1, 2], 6),
        at(1, [1, 3], 7),
        at(0, [1, 3], 7),
        by_quads,
    ] {
        let ops = [maps[0].clone(), other];
        assert_eq!(Common::of(&ops), Common::Nothing, "{ops:?}");
    }
}

#[test]
fn loads_share_coordinates_and_a_level() {
    let load = |texture: u32, at: [u32; 2], level: u32| TextureOp {
        query: TextureQuery::Load,
        sampler: None,
        ..sample(texture, at, LevelOfDetail::Explicit(Value(level)))
    };
    let texels = [load(0, [1, 2], 3), load(1, [1, 2], 3), load(0, [1, 2], 3)];
    assert_eq!(Common::of(&texels), Common::Texels);
    let mut of_sample = load(1, [1, 2], 3);
    of_sample.sample = Some(Value(4));
    let mut beside = load(1, [1, 2], 3);
    beside.offset[0] = 1;
    let others = [load(1, [1, 3], 3), load(1, [1, 2], 4), of_sample, beside];
    for other in others {
        let ops = [texels[0].clone(), other];
        assert_eq!(Common::of(&ops), Common::Nothing, "{ops:?}");
    }
}

/// Operands that are the same ones are there once, and each access has them.
#[test]
fn accesses_are_taken_one_after_the_other() {
    let words = |from: u32, count: usize| -> Vec<Packet<u32>> {
        (from..)
            .take(count)
            .map(|word| Packet([word; LANES]))
            .collect()
    };
    let same = [0, 1].map(|texture| sample(texture, [1, 2], gradient(7)));
    let taps = [3, 5].map(|v| sample(0, [1, v], LevelOfDetail::Zero));
    for (ops, operands) in [(same, [1..7, 1..7]), (taps, [1..3, 3..5])] {
        let common = Common::of(&ops);
        let given = words(1, 6);
        let mut results = words(0, 8);
        let context = (Level::best(), &[0xFFFF]);
        let mut all = TextureAccesses::new((&ops, common), context, &given, &mut results);
        for (number, expected) in (0_u32..).zip(operands) {
            let mut access = all.next().expect("there are two");
            let found = access.operands().iter().map(|packet| packet.0[0]);
            assert_eq!(found.collect::<Vec<_>>(), expected.collect::<Vec<_>>());
            access.result_mut(3)[0] = Packet([100 + number; LANES]);
        }
        assert!(all.next().is_none());
        assert_eq!([3, 7].map(|at: usize| results[at].0[0]), [100, 101]);
    }
}
