//! Accesses to textures: what code asks, alone and together.

use super::{Given, PACKETS, Runner, compare, finish, words_of};
use estampe_ir::interface::{Input, Stage, TextureSlot};
use estampe_ir::interpreter::{Common, TextureAccess, TextureAccesses, Textures};
use estampe_ir::lanes::Kernel;
use estampe_ir::op::{Binary, LevelOfDetail, TextureOp, TextureQuery};
use estampe_ir::tree::Builder;
use estampe_ir::{Op, Value};
use estampe_simd::{LANES, Level, Packet};
use estampe_x86::{Code, Isa, Scratch, Tier};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;

/// Texels that say what was asked.
#[derive(Debug, Default)]
struct Told {
    panics: bool,
    /// The accesses that were asked for together, by what they have in common.
    together: Mutex<Vec<(Common, usize)>>,
}

impl Textures for Told {
    fn access(&self, mut access: TextureAccess<'_>) {
        assert!(!self.panics, "a texture that cannot be read");
        // The interpreter asks for many packets at once, machine code for one.
        for packet in 0..access.packets {
            let [x, y] = [0, 1].map(|at| access.coordinate(at)[packet]);
            let more = access.level_of_detail().or(access.reference());
            let more = more.or(access.gradient(1, 0));
            let level = more.map_or(Packet([access.op.texture; LANES]), |more| more[packet]);
            let mask = access.mask[packet];
            for at in 0..access.results() {
                let result = &mut access.result_mut(at)[packet].0;
                for (lane, to) in result.iter_mut().enumerate() {
                    if mask >> lane & 1 == 1 {
                        let sum = x.0[lane].wrapping_add(y.0[lane].rotate_left(9));
                        *to = sum.wrapping_add(level.0[lane]) ^ u32::try_from(at).unwrap();
                    }
                }
            }
        }
    }

    fn access_all(&self, mut accesses: TextureAccesses<'_>) {
        let asked = (accesses.common, accesses.ops.len());
        self.together.lock().unwrap().push(asked);
        while let Some(access) = accesses.next() {
            self.access(access);
        }
    }
}

fn sampling() -> Kernel {
    let mut b = Builder::new(Stage::Fragment);
    let slot = TextureSlot {
        group: 0,
        binding: 0,
    };
    b.interface_mut().textures.push(slot);
    b.interface_mut().samplers.push(slot);
    let coordinates = vec![b.input(Input::Varying(0)), b.input(Input::Varying(1))];
    let level = b.input(Input::Varying(2));
    let mask = b.input(Input::FrontFacing);
    let mut results = Vec::new();
    for level in [LevelOfDetail::Zero, LevelOfDetail::Explicit(level)] {
        let texels = b.op(Op::Texture(Box::new(TextureOp {
            query: TextureQuery::Sample,
            texture: 0,
            sampler: Some(0),
            coordinates: coordinates.clone(),
            layer: None,
            offset: [0; 3],
            level,
            reference: None,
            sample: None,
            stored: Vec::new(),
            mask,
        })));
        // Results are those of the lanes in the mask.
        for texel in texels {
            let nothing = b.word(0);
            results.push(b.select(mask, texel, nothing));
        }
    }
    finish(b, &results)
}

#[test]
fn textures_are_asked() {
    let kernel = sampling();
    let given = Given::new(5, &mut |random| random.u32(..));
    compare(&kernel, &mut |go| {
        words_of(&kernel, &given, &[], &Told::default(), go)
    });
}

#[test]
fn panics_of_textures_leave_the_code() {
    let kernel = sampling();
    let given = Given::new(5, &mut |random| random.u32(..));
    let panics = Told {
        panics: true,
        ..Told::default()
    };
    for isa in Isa::ALL.into_iter().filter(|isa| isa.is_available()) {
        let code = Code::compile(&kernel, isa, Tier::Fast).unwrap();
        let mut scratch = Scratch::default();
        let left = catch_unwind(AssertUnwindSafe(|| {
            let go: Runner<'_> = &mut |run| code.run(Level::best(), run, &mut scratch);
            words_of(&kernel, &given, &[], &panics, go)
        }));
        let panic = left.expect_err("the texture panics");
        assert_eq!(panic.downcast_ref(), Some(&"a texture that cannot be read"));
        let go: Runner<'_> = &mut |run| code.run(Level::best(), run, &mut scratch);
        words_of(&kernel, &given, &[], &Told::default(), go);
    }
}

/// Accesses of several kinds in any order, one of which needs another's result.
fn sampling_together() -> Kernel {
    let mut b = Builder::new(Stage::Fragment);
    for binding in 0..3 {
        let slot = TextureSlot { group: 0, binding };
        b.interface_mut().textures.push(slot);
        b.interface_mut().samplers.push(slot);
    }
    let [u, v, depth] = [0, 1, 2].map(|at| b.input(Input::Varying(at)));
    let mask = b.input(Input::FrontFacing);
    let access = |b: &mut Builder, (query, texture): (TextureQuery, u32), at: [Value; 2], level| {
        let compares = query == TextureQuery::SampleCompare;
        b.op(Op::Texture(Box::new(TextureOp {
            query,
            texture,
            sampler: (query != TextureQuery::Load).then_some(texture),
            coordinates: at.to_vec(),
            layer: None,
            offset: [0; 3],
            level,
            reference: compares.then_some(depth),
            sample: None,
            stored: Vec::new(),
            mask,
        })))
    };
    let (sample, compare) = (TextureQuery::Sample, TextureQuery::SampleCompare);
    let by_quads = LevelOfDetail::Implicit;
    let gradient = LevelOfDetail::Gradient {
        x: vec![depth, u],
        y: vec![v, depth],
    };
    let mut texels = Vec::new();
    for texture in 0..3 {
        let asked = (sample, texture);
        texels.extend(access(&mut b, asked, [u, v], by_quads.clone()));
        let beside = b.binary(Binary::Add, u, texels[0]);
        let step = b.word(texture);
        let at = b.binary(Binary::Add, v, step);
        texels.extend(access(&mut b, (compare, 1), [u, at], LevelOfDetail::Zero));
        texels.extend(access(&mut b, asked, [beside, v], by_quads.clone()));
        texels.extend(access(&mut b, asked, [u, v], gradient.clone()));
        let load = (TextureQuery::Load, texture);
        texels.extend(access(&mut b, load, [u, v], LevelOfDetail::Explicit(depth)));
    }
    let nothing = b.word(0);
    let select = |texel: &Value| b.select(mask, *texel, nothing);
    let results: Vec<Value> = texels.iter().map(select).collect();
    finish(b, &results)
}

#[test]
fn accesses_that_have_something_in_common_are_asked_together() {
    let kernel = sampling_together();
    let given = Given::new(6, &mut |random| random.u32(..));
    let told = Told::default();
    compare(&kernel, &mut |go| words_of(&kernel, &given, &[], &told, go));
    let together = told.together.into_inner().unwrap();
    if Isa::best().is_some() {
        // By quads, and by gradients.
        for (asked, calls) in [
            ((Common::Coordinates, 3), 2),
            ((Common::Reference, 3), 1),
            ((Common::Texels, 3), 1),
        ] {
            let count = together.iter().filter(|found| **found == asked).count();
            assert!(count >= calls * PACKETS, "{asked:?}: {together:?}");
        }
        assert!(
            together
                .iter()
                .all(|(common, _)| *common != Common::Nothing)
        );
    }
}
