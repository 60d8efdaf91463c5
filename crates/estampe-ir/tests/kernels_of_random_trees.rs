//! Kernels of random trees against the trees, executed one invocation at a time.

#[path = "random_trees/generate.rs"]
mod generate;

use estampe_ir::interface::Input;
use estampe_ir::interpreter::{Buffer, Code, InputData, OutputData, Run, Scratch, Stopped, cells};
use estampe_ir::lanes::Kernel;
use estampe_ir::op::TextureOp;
use estampe_ir::tree::{Node, Surroundings, Tree, evaluate, passes, verify};
use estampe_simd::{Level, Packet};
use fastrand::Rng;
use generate::{Made, OWN_WORDS, READ, tree};
use std::sync::atomic::{AtomicU32, Ordering};

const PACKETS: usize = 3;
const LANES: usize = 16;
const INVOCATIONS: usize = PACKETS * LANES;

/// The number of an invocation as a word.
fn number(invocation: usize) -> u32 {
    u32::try_from(invocation).expect("a few packets")
}

/// One invocation of a work-group.
struct Invocation<'a> {
    tree: &'a Tree,
    index: u32,
    uniforms: [u32; 3],
    is_covered: bool,
    read: Vec<u32>,
    written: Vec<u32>,
    workgroup: Vec<u32>,
}

impl Surroundings for Invocation<'_> {
    fn input(&mut self, at: usize) -> u32 {
        match self.tree.interface.inputs[at] {
            Input::LocalInvocationIndex => self.index,
            Input::PushConstant(at) => self.uniforms[at as usize],
            Input::Cover => u32::from(self.is_covered),
            other => panic!("the trees have no input {other:?}"),
        }
    }

    fn buffer(&mut self, at: usize) -> &mut Vec<u32> {
        if at == READ as usize {
            &mut self.read
        } else {
            &mut self.written
        }
    }

    fn workgroup(&mut self) -> &mut Vec<u32> {
        &mut self.workgroup
    }

    fn texture(&mut self, _op: &TextureOp, _operands: &[u32]) -> Vec<u32> {
        Vec::new()
    }
}

/// What a run is given, and what it leaves.
struct Case {
    uniforms: [u32; 3],
    cover: [u16; PACKETS],
    read: Vec<u32>,
}

impl Case {
    fn new(random: &mut Rng) -> Self {
        let word = |random: &mut Rng| match random.u32(0..3) {
            0 => random.u32(0..5),
            1 => (random.f32() * 8.0 - 4.0).to_bits(),
            _ => random.u32(..),
        };
        Self {
            uniforms: [0; 3].map(|_| word(random)),
            cover: [0; PACKETS].map(|_| {
                if random.bool() {
                    u16::MAX
                } else {
                    random.u16(..)
                }
            }),
            read: (0..9).map(|_| word(random)).collect(),
        }
    }

    fn is_covered(&self, invocation: usize) -> bool {
        self.cover[invocation / LANES] >> (invocation % LANES) & 1 == 1
    }

    /// Outputs by invocation, and the memory, one invocation after the other.
    fn one_by_one(&self, tree: &Tree) -> (Vec<Vec<u32>>, Vec<u32>) {
        let mut written = vec![0; INVOCATIONS * OWN_WORDS as usize];
        let outputs = (0..INVOCATIONS).map(|at| {
            let mut invocation = Invocation {
                tree,
                index: number(at),
                uniforms: self.uniforms,
                is_covered: self.is_covered(at),
                read: self.read.clone(),
                written: std::mem::take(&mut written),
                workgroup: Vec::new(),
            };
            let outputs = evaluate(tree, &mut invocation, 1 << 22).expect("they all end");
            written = invocation.written;
            outputs
        });
        (outputs.collect(), written)
    }

    /// The same on lanes.
    fn on_lanes(&self, tree: &Tree, level: Level) -> (Vec<Vec<u32>>, Vec<u32>) {
        let kernel = Kernel::from_tree(tree);
        let code = Code::new(&kernel);
        let indices: Vec<Packet<u32>> = (0..PACKETS)
            .map(|packet| Packet(std::array::from_fn(|lane| number(packet * LANES + lane))))
            .collect();
        let inputs = kernel.interface.inputs.iter().map(|input| match *input {
            Input::LocalInvocationIndex => InputData::words(&indices, 0, 1),
            Input::PushConstant(at) => InputData::Uniform(self.uniforms[at as usize]),
            Input::Cover => InputData::Mask(&self.cover),
            other => panic!("the trees have no input {other:?}"),
        });
        let inputs: Vec<_> = inputs.collect();
        let count = kernel.interface.outputs.len();
        let mut results = vec![Packet([0; LANES]); count * PACKETS];
        let outputs = cells(&mut results);
        let outputs: Vec<_> = (0..count)
            .map(|at| OutputData::words(outputs, at, count))
            .collect();
        let zero = || AtomicU32::new(0);
        let written: Vec<_> = std::iter::repeat_with(zero)
            .take(INVOCATIONS * OWN_WORDS as usize)
            .collect();
        let buffers = [
            Buffer::read_only(&self.read, self.read.len() * 4),
            Buffer::shared(&written, written.len() * 4),
        ];
        let run = Run {
            inputs: &inputs,
            outputs: &outputs,
            buffers: &buffers,
            ..Run::new(PACKETS)
        };
        let ended: Result<(), Stopped> = code.run(level, &run, &mut Scratch::default());
        ended.expect("they all end");
        let of_lane = |at: usize| {
            let outputs =
                (0..count).map(|output| results[at / LANES * count + output].0[at % LANES]);
            outputs.collect()
        };
        let outputs = (0..INVOCATIONS).map(of_lane).collect();
        let written = written
            .iter()
            .map(|word| word.load(Ordering::Relaxed))
            .collect();
        (outputs, written)
    }
}

fn size(nodes: &[Node]) -> usize {
    let of_node = |node: &Node| match node {
        Node::Op { .. } | Node::Branch { .. } => 1,
        Node::If { accept, reject, .. } => 1 + size(accept) + size(reject),
        Node::Block { body, .. } | Node::Loop { body, .. } => 1 + size(body),
    };
    nodes.iter().map(of_node).sum()
}

fn loops(nodes: &[Node]) -> usize {
    let of_node = |node: &Node| match node {
        Node::Op { .. } | Node::Branch { .. } => 0,
        Node::If { accept, reject, .. } => loops(accept) + loops(reject),
        Node::Block { body, .. } => loops(body),
        Node::Loop { body, .. } => 1 + loops(body),
    };
    nodes.iter().map(of_node).sum()
}

/// The passes change no result, and leave a tree that is one. Returns its sizes, and true if loops
/// were unrolled.
fn check_passes(seed: u64) -> ([usize; 2], bool) {
    let random = &mut Rng::with_seed(seed);
    let (mut tree, _) = tree(random);
    let case = Case::new(random);
    let wanted = case.one_by_one(&tree);
    let before = size(&tree.body);
    let passes: [fn(&mut Tree); 8] = [
        passes::straight_blocks,
        passes::redundant_parameters,
        passes::loop_invariants,
        passes::unroll_loops,
        passes::dead_code,
        passes::unused_inputs,
        passes::redundant_parameters,
        passes::optimise,
    ];
    let mut unrolls = false;
    for (number, pass) in passes.iter().enumerate() {
        let loops_before = loops(&tree.body);
        pass(&mut tree);
        unrolls |= number == 3 && loops(&tree.body) < loops_before;
        verify(&tree).unwrap_or_else(|error| panic!("seed {seed}, after pass {number}: {error}"));
        assert_eq!(
            wanted,
            case.one_by_one(&tree),
            "seed {seed}, after pass {number}"
        );
    }
    ([before, size(&tree.body)], unrolls)
}

#[test]
fn passes_change_no_result() {
    let mut sizes = [0; 2];
    let mut unrolled = 0;
    for seed in 0..600 {
        let (of_tree, unrolls) = check_passes(seed);
        unrolled += usize::from(unrolls);
        sizes = [0, 1].map(|at: usize| sizes[at] + of_tree[at]);
    }
    let [before, after] = sizes;
    assert!(after < before * 9 / 10, "{before} nodes became {after}");
    assert!(
        unrolled > 50,
        "{unrolled} trees with loops that are unrolled"
    );
}

fn check(seed: u64) -> Made {
    let random = &mut Rng::with_seed(seed);
    let (mut tree, made) = tree(random);
    verify(&tree).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
    let case = Case::new(random);
    let wanted = case.one_by_one(&tree);
    if random.bool() {
        passes::optimise(&mut tree);
    }
    for level in Level::all_available() {
        let got = case.on_lanes(&tree, level);
        assert_eq!(wanted.1, got.1, "seed {seed}, {level:?}: memory");
        for (at, (wanted, got)) in wanted.0.iter().zip(&got.0).enumerate() {
            if case.is_covered(at) {
                assert_eq!(wanted, got, "seed {seed}, {level:?}: invocation {at}");
            }
        }
    }
    made
}

#[test]
fn lanes_do_what_each_invocation_does_alone() {
    let mut all = Made::default();
    // The last one leaves a uniform block to a label at which lanes wait.
    for seed in (0..600).chain([12_365 << 20]) {
        let made = check(seed);
        all.ifs += made.ifs;
        all.loops += made.loops;
        all.early_branches += made.early_branches;
        all.stores += made.stores;
    }
    assert!(all.ifs > 500 && all.loops > 300, "{all:?}");
    assert!(all.early_branches > 100 && all.stores > 300, "{all:?}");
}

#[test]
#[ignore = "takes minutes: a hundred thousand trees"]
fn lanes_do_what_each_invocation_does_alone_at_length() {
    for seed in 0..100_000 {
        check(seed << 20);
    }
}
