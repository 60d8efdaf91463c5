//! Which operations the kernels had.

use estampe_ir::Op;
use estampe_ir::lanes::{Kernel, Terminator};
use estampe_ir::op::{
    Atomic, Axis, Binary, Compare, LevelOfDetail, MaskBinary, Math, Math2, Memory, Precision,
    TextureQuery, Unary,
};
use estampe_x86::{Code, Isa};
use std::collections::BTreeMap;

/// Kinds of kernels of which a pass runs two packets. With AVX2 all of them loop.
const PAIRS: [(Isa, &str); 5] = [
    (Isa::Avx512, "pairs"),
    (Isa::Avx512, "pairs that loop"),
    (Isa::Avx512, "pairs with an effect"),
    (Isa::Avx512, "pairs with textures"),
    (Isa::Avx2, "pairs that loop"),
];

fn pairs_of(isa: Isa, name: &str) -> String {
    format!("{} {name}", isa.name())
}

/// How often each operation occurred.
#[derive(Debug, Default)]
pub(crate) struct Hits {
    counts: BTreeMap<String, u64>,
}

impl Hits {
    /// Counts the operations of a kernel.
    pub(crate) fn count(&mut self, kernel: &Kernel) {
        for (at, block) in kernel.blocks.iter().enumerate() {
            for (op, _) in &block.ops {
                let name = name(op);
                if let Some(count) = self.counts.get_mut(&name) {
                    *count += 1;
                } else {
                    self.counts.insert(name, 1);
                }
            }
            if matches!(block.terminator, Terminator::Branch { .. }) {
                *self.counts.entry("branch".to_owned()).or_default() += 1;
            }
            if block.terminator.jumps().any(|jump| jump.to.index() <= at) {
                *self.counts.entry("loop".to_owned()).or_default() += 1;
            }
        }
    }

    /// Counts code that runs pairs of packets.
    pub(crate) fn count_pairs(&mut self, kernel: &Kernel, code: &Code) {
        if !code.runs_pairs() {
            return;
        }
        let mut blocks = kernel.blocks.iter().enumerate();
        let has_loop = blocks.any(|(at, block)| {
            let mut jumps = block.terminator.jumps();
            jumps.any(|jump| jump.to.index() <= at)
        });
        let ops = || kernel.blocks.iter().flat_map(|block| &block.ops);
        let has_effect = ops().any(|(op, _)| op.has_effect());
        let has_texture = ops().any(|(op, _)| matches!(op, Op::Texture(_)));
        for (isa, name) in PAIRS.into_iter().filter(|(isa, _)| *isa == code.isa()) {
            let occurs = match name {
                "pairs that loop" => has_loop,
                "pairs with an effect" => has_effect,
                "pairs with textures" => has_texture,
                _ => true,
            };
            *self.counts.entry(pairs_of(isa, name)).or_default() += u64::from(occurs);
        }
    }

    /// What can be compiled and did not occur.
    pub(crate) fn missing(&self) -> Vec<String> {
        let pairs = PAIRS.into_iter().filter(|(isa, _)| isa.is_available());
        let all = pairs.map(|(isa, name)| pairs_of(isa, name));
        let all = all.chain(expected());
        let is_missing = |name: &String| self.counts.get(name).is_none_or(|&count| count == 0);
        all.filter(is_missing).collect()
    }

    /// The number of operations.
    pub(crate) fn total(&self) -> u64 {
        self.counts.values().sum()
    }
}

fn name(op: &Op) -> String {
    let name = match op {
        Op::Unary(kind, _) => kind.name(),
        Op::Binary(kind, _) => kind.name(),
        Op::Compare(kind, _) => kind.name(),
        Op::MaskBinary(kind, _) => kind.name(),
        Op::Math(kind, _) => kind.name(),
        Op::Math2(kind, _) => kind.name(),
        Op::Derivative {
            axis, precision, ..
        } => return format!("derivative {} {}", axis.name(), precision.name()),
        Op::Atomic { kind, memory, .. } => {
            return format!("atomic {}{}", kind.name(), suffix(*memory));
        }
        Op::CompareExchange { memory, .. } => {
            return format!("compare exchange{}", suffix(*memory));
        }
        Op::Texture(op) => return texture_name(op.query, &op.level),
        Op::Constant(_) => "constant",
        Op::MaskConstant(_) => "mask constant",
        Op::Input(_) => "input",
        Op::InputMask(_) => "input mask",
        Op::Fma(_) => "fma",
        Op::MaskNot(_) => "mask not",
        Op::Select { .. } => "select",
        Op::QuadLane { .. } => "quad lane",
        Op::QuadAny(_) => "quad any",
        Op::Any(_) => "any",
        Op::LoadLocal { .. } => "load local",
        Op::StoreLocal { .. } => "store local",
        Op::LoadBuffer { .. } => "load buffer",
        Op::StoreBuffer { .. } => "store buffer",
        Op::BufferBytes(_) => "buffer bytes",
        Op::Barrier => "barrier",
        Op::LoadWorkgroup(_) => "load of the work-group",
        Op::StoreWorkgroup { .. } => "store of the work-group",
    };
    name.to_owned()
}

fn suffix(memory: Memory) -> &'static str {
    match memory {
        Memory::Buffer(_) => "",
        Memory::Workgroup => " of the work-group",
    }
}

fn texture_name(query: TextureQuery, level: &LevelOfDetail) -> String {
    let query = match query {
        TextureQuery::Gather(_) => "Gather".to_owned(),
        query => format!("{query:?}"),
    };
    let level = match level {
        LevelOfDetail::Zero => "zero",
        LevelOfDetail::Implicit => "implicit",
        LevelOfDetail::Bias(_) => "bias",
        LevelOfDetail::Explicit(_) => "explicit",
        LevelOfDetail::Gradient { .. } => "gradient",
    };
    match query.as_str() {
        "Sample" => format!("Sample {level}"),
        _ => query,
    }
}

/// Everything that can be compiled, but for [`Op::Any`], which few kernels have.
fn expected() -> Vec<String> {
    let simple = [
        "constant",
        "mask constant",
        "input",
        "input mask",
        "fma",
        "mask not",
        "select",
        "quad any",
        "load local",
        "store local",
        "load buffer",
        "store buffer",
        "buffer bytes",
        "compare exchange",
        "compare exchange of the work-group",
        "barrier",
        "load of the work-group",
        "store of the work-group",
        "branch",
        "loop",
        "Sample zero",
        "Sample implicit",
        "Sample bias",
        "Sample explicit",
        "Sample gradient",
        "SampleCompare",
        "Gather",
        "GatherCompare",
        "Load",
        "Store",
        "Size",
        "Levels",
        "Layers",
        "Samples",
    ];
    let mut all: Vec<String> = simple.map(str::to_owned).to_vec();
    all.extend(Unary::ALL.iter().map(|kind| kind.name().to_owned()));
    all.extend(Binary::ALL.iter().map(|kind| kind.name().to_owned()));
    all.extend(Compare::ALL.iter().map(|kind| kind.name().to_owned()));
    all.extend(MaskBinary::ALL.iter().map(|kind| kind.name().to_owned()));
    all.extend(Math::ALL.iter().map(|kind| kind.name().to_owned()));
    all.extend(Math2::ALL.iter().map(|kind| kind.name().to_owned()));
    for suffix in ["", suffix(Memory::Workgroup)] {
        let atomics = Atomic::ALL.iter();
        all.extend(atomics.map(|kind| format!("atomic {}{suffix}", kind.name())));
    }
    for axis in Axis::ALL {
        let of_axis =
            |precision: &Precision| format!("derivative {} {}", axis.name(), precision.name());
        all.extend(Precision::ALL.iter().map(of_axis));
    }
    all
}
