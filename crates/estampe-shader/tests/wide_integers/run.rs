//! Compute shaders on buffers of 64-bit integers.

use estampe_ir::tree;
use estampe_shader::front::{Options, Source, load};
use estampe_shader::lower::lower;
use estampe_shader::program::{StageSource, TextCompute};
use estampe_simd::Level;
use estampe_types::bindings::{BoundGroup, BoundResource, BoundResources};
use estampe_types::shader::{ComputeProgram, Workgroups};
use estampe_types::{Bindings, BufferData, StorageBuffer};
use std::sync::Arc;

/// The invocations of a work-group in all of these tests.
pub(crate) const GROUP: usize = 64;

/// Packets of which so many make a program worth better machine code.
const OFTEN: usize = 5000;

fn lowered(source: Source<'_>) -> StageSource {
    let module = load(source, &Options::default()).unwrap_or_else(|error| panic!("{error}"));
    let stage = lower(&module.module, &module.info, 0).unwrap_or_else(|error| panic!("{error}"));
    tree::verify(&stage.tree).unwrap_or_else(|error| panic!("{error}"));
    stage
}

fn words(numbers: &[u64]) -> Vec<u32> {
    let halves = numbers
        .iter()
        .flat_map(|n| [(n & 0xFFFF_FFFF) as u32, (n >> 32) as u32]);
    halves.collect()
}

fn numbers(words: &[u32]) -> Vec<u64> {
    let (pairs, _) = words.as_chunks();
    let whole = pairs.iter();
    whole
        .map(|&[low, high]| u64::from(low) | u64::from(high) << 32)
        .collect()
}

/// What each way of running a shader leaves in `out`, binding 0, of so many numbers. Other
/// bindings, from 1 on, are read. One invocation runs for each number of `out`, or less.
pub(crate) fn run_all(
    source: Source<'_>,
    read: &[&[u64]],
    count: usize,
    invocations: usize,
) -> Vec<(String, Vec<u64>)> {
    let stage = lowered(source);
    let mut results = Vec::new();
    let compile = || TextCompute::new(&stage, 1 << 24).expect("it is small");
    for (name, program) in [
        ("code", compile()),
        ("interpreter", compile().interpreted()),
    ] {
        for level in Level::all_available() {
            let packets = invocations.div_ceil(16);
            // The last run is by the better machine code.
            let is_code = name == "code" && ["avx2", "avx512"].contains(&level.name());
            let times = if is_code { OFTEN / packets + 2 } else { 1 };
            let (mut first, mut last) = (None, None);
            for _ in 0..times {
                let out = once(&program, level, read, count, invocations);
                first.get_or_insert_with(|| out.clone());
                last = Some(out);
            }
            for (out, when) in [(first, "first"), (last, "last")] {
                results.push((
                    format!("{name}, {}, {when} run", level.name()),
                    out.expect("it ran"),
                ));
            }
        }
    }
    results
}

fn once(
    program: &TextCompute,
    level: Level,
    read: &[&[u64]],
    count: usize,
    invocations: usize,
) -> Vec<u64> {
    let out = StorageBuffer::try_from_data(BufferData::from_words(vec![7; count * 2]));
    let out = out.expect("it is small");
    let mut entries = vec![(
        0,
        BoundResource::StorageBuffer {
            buffer: out.clone(),
            offset: 0,
            size: u32::MAX,
            dynamic_offset: None,
        },
    )];
    for (binding, numbers) in (1..).zip(read) {
        let buffer = BoundResource::Buffer {
            buffer: BufferData::from_words(words(numbers)),
            offset: 0,
            size: u32::MAX,
            dynamic_offset: None,
        };
        entries.push((binding, buffer));
    }
    let group = Arc::new(BoundResources { entries });
    let bindings = Bindings {
        groups: vec![BoundGroup {
            group,
            ..BoundGroup::default()
        }],
        ..Bindings::default()
    };
    let groups = invocations.div_ceil(GROUP);
    let count = [u32::try_from(groups).expect("few work-groups"), 1, 1];
    let work = Workgroups {
        count,
        range: 0..groups as u64,
    };
    program
        .run_workgroups(level, &bindings, &work)
        .expect("it ends");
    drop(bindings);
    numbers(out.into_data().words())
}
