//! Compute shaders at every level, by machine code and by the interpreter.

use estampe_shader::front::{Options, Source, load};
use estampe_shader::lower::lower;
use estampe_shader::program::{StageSource, TextCompute};
use estampe_simd::Level;
use estampe_types::bindings::{BoundGroup, BoundResource, BoundResources};
use estampe_types::shader::{ComputeProgram, WorkgroupOrder, Workgroups};
use estampe_types::{Bindings, BufferData, StorageBuffer};
use std::sync::Arc;

/// The words of a buffer.
#[derive(Debug, Clone)]
pub(crate) enum Contents {
    Read(Vec<u32>),
    Written(Vec<u32>),
}

/// The first entry point of a text that begins with `enable f16;`.
pub(crate) fn lowered(source: &str) -> StageSource {
    lowered_from(Source::Wgsl(&format!("enable f16;\n{source}")))
}

pub(crate) fn lowered_from(source: Source<'_>) -> StageSource {
    let module = load(source, &Options::default());
    let module = module.unwrap_or_else(|errors| panic!("{errors}"));
    // Overrides get their defaults.
    let module = module.specialize(None, &[]);
    let module = module.unwrap_or_else(|errors| panic!("{errors}"));
    lower(&module.module, &module.info, 0).unwrap_or_else(|error| panic!("{error}"))
}

pub(crate) fn run(
    source: &str,
    buffers: &[Contents],
    groups: u32,
) -> (WorkgroupOrder, Vec<Vec<u32>>) {
    run_stage(&lowered(source), buffers, groups)
}

/// Runs work-groups along x, by the interpreter and by machine code at every level, and where their
/// order is free, backwards too. The order, and the words of each buffer that is written, which are
/// the same every time. Binding numbers are positions in the list.
pub(crate) fn run_stage(
    stage: &StageSource,
    buffers: &[Contents],
    groups: u32,
) -> (WorkgroupOrder, Vec<Vec<u32>>) {
    let compiled = || TextCompute::new(stage, 1 << 20).expect("it is small");
    let programs = [compiled().interpreted(), compiled()];
    let mut found: Option<(WorkgroupOrder, Vec<Vec<u32>>)> = None;
    for (level, (program, is_backwards)) in Level::all_available()
        .into_iter()
        .flat_map(|level| programs.iter().map(move |program| (level, program)))
        .flat_map(|(level, program)| [false, true].map(|is| (level, (program, is))))
    {
        let (bindings, written) = bound(buffers);
        let count = [groups, 1, 1];
        let order = program.order(&bindings, count);
        let mut ids: Vec<u64> = (0..u64::from(groups)).collect();
        if is_backwards && order == WorkgroupOrder::Free {
            ids.reverse();
        }
        for id in ids {
            let range = id..id + 1;
            let work = Workgroups { count, range };
            let run = program.run_workgroups(level, &bindings, &work);
            run.expect("it ends");
        }
        drop(bindings);
        let words = written.into_iter();
        let words = words.map(|buffer| buffer.into_data().words().to_vec());
        let words = (order, words.collect());
        match &found {
            None => found = Some(words),
            Some(found) => assert_eq!(*found, words, "{}", level.name()),
        }
    }
    found.expect("there is a level")
}

fn bound(buffers: &[Contents]) -> (Bindings, Vec<StorageBuffer>) {
    let mut written = Vec::new();
    let entries = buffers.iter().map(|contents| match contents {
        Contents::Read(words) => BoundResource::Buffer {
            buffer: BufferData::from_words(words.clone()),
            offset: 0,
            size: u32::MAX,
            dynamic_offset: None,
        },
        Contents::Written(words) => {
            let data = BufferData::from_words(words.clone());
            let buffer = StorageBuffer::try_from_data(data).expect("it is small");
            written.push(buffer.clone());
            BoundResource::StorageBuffer {
                buffer,
                offset: 0,
                size: u32::MAX,
                dynamic_offset: None,
            }
        }
    });
    let group = Arc::new(BoundResources {
        entries: (0..).zip(entries).collect(),
    });
    let bindings = Bindings {
        groups: vec![BoundGroup {
            group,
            ..BoundGroup::default()
        }],
        ..Bindings::default()
    };
    (bindings, written)
}

/// Codes side by side, the first in the low half of a word.
pub(crate) fn packed(codes: &[u16]) -> Vec<u32> {
    let pair = |pair: &[u16]| {
        let high = pair.get(1).copied().unwrap_or(0);
        u32::from(pair[0]) | u32::from(high) << 16
    };
    codes.chunks(2).map(pair).collect()
}

/// The codes of words.
pub(crate) fn unpacked(words: &[u32]) -> Vec<u16> {
    let half = |word: u32| u16::try_from(word & 0xFFFF).expect("16 bits");
    let both = |word: &u32| [half(*word), half(word >> 16)];
    words.iter().flat_map(both).collect()
}
