//! Alpha tests: fragments that have no effect while the alpha of one texture is small.
//!
//! In · Out: a tree of the fragment stage, out of which reads were taken · its parts that decide
//! whether a fragment has an effect; with the bindings of a draw, the greatest alpha for which it
//! has none.
//!
//! A fragment has no effect if it is discarded, or if its alpha, which becomes coverage, covers no
//! sample. Both are decided by evaluating the tree with [ranges](range) in place of numbers: if the
//! alpha of a texture read is in 0..=a, is the fragment discarded whatever everything else is?
//! Uniforms are what the draw binds.

mod range;
mod walk;

use super::nondependent::Reads;
use super::uniforms::Sources;
use estampe_ir::interface::{Input, Output};
use estampe_ir::tree::{Node, Tree, passes};
use estampe_types::shader::AlphaTestRequest;
use range::Range;
use std::sync::{Mutex, PoisonError};
use walk::{Uniform, Walk};

/// The most nodes of a tree that is evaluated for a draw.
const MOST_NODES: usize = 256;

/// The most answers that are kept: materials that are drawn in turns differ in few thresholds.
const MOST_ANSWERS: usize = 8;

/// Alphas up to this cover none of four samples or fewer: ⌊4·alpha + ½⌋ is 0. A little less than
/// ⅛, at which the sum would be rounded up.
const COVERS_NOTHING: f32 = 0.12;

/// The decisions of a fragment stage.
#[derive(Debug)]
pub(super) struct AlphaTests {
    /// What decides whether a fragment is discarded.
    discard: Option<Decision>,
    /// What decides about the alpha of the first colour.
    coverage: Option<Decision>,
}

/// A tree with one output, which is decided by the alpha of a read.
#[derive(Debug)]
struct Decision {
    tree: Tree,
    read: u32,
    /// What was found for uniforms of draws before.
    answers: Mutex<Vec<Answer>>,
}

/// The greatest code that fails with some uniforms, which are all that were read to find it.
#[derive(Debug)]
struct Answer {
    uniforms: Vec<(Uniform, Option<u32>)>,
    failing: Option<u8>,
}

impl AlphaTests {
    /// The decisions of a tree that depend on the alpha of one read.
    pub(super) fn of(tree: &Tree, reads: &Reads) -> Self {
        let decision = |output: Output| Decision::of(tree, output, reads);
        Self {
            discard: decision(Output::Cover),
            coverage: decision(Output::Color {
                target: 0,
                component: 3,
            }),
        }
    }

    /// The read that decides, and the code of the greatest alpha for which fragments have no
    /// effect, if the read's alpha is at most 1/256 above it.
    pub(super) fn failing(
        &self,
        sources: Sources<'_>,
        request: AlphaTestRequest,
    ) -> Option<(u32, u8)> {
        let coverage = self.coverage.as_ref().filter(|_| request.to_coverage);
        let decisions = self.discard.iter().chain(coverage);
        let failing = decisions.filter_map(|decision| {
            let code = decision.failing(sources)?;
            Some((decision.read, code))
        });
        failing.max_by_key(|(_, code)| *code)
    }
}

impl Decision {
    fn of(tree: &Tree, output: Output, reads: &Reads) -> Option<Self> {
        let at = tree
            .interface
            .outputs
            .iter()
            .position(|one| *one == output)?;
        let mut part = tree.clone();
        part.interface.outputs = vec![output];
        part.outputs = vec![tree.outputs[at]];
        passes::dead_code(&mut part);
        passes::unused_inputs(&mut part);
        let mut count = 0;
        if !is_walkable(&part.body, &mut count) || count > MOST_NODES {
            return None;
        }
        // One read decides: of several, none would be known to be small.
        let mut alphas = part
            .interface
            .inputs
            .iter()
            .filter_map(|input| match input {
                Input::TextureRead { read, component: 3 } => Some(*read),
                _ => None,
            });
        let read = alphas.next()?;
        (alphas.next().is_none() && reads.place_of(read).is_some()).then_some(Self {
            tree: part,
            read,
            answers: Mutex::default(),
        })
    }

    /// The greatest code that fails, as it was found before if the uniforms are the same.
    fn failing(&self, sources: Sources<'_>) -> Option<u8> {
        let mut answers = self.answers.lock().unwrap_or_else(PoisonError::into_inner);
        let is_same = |answer: &Answer| {
            let mut uniforms = answer.uniforms.iter();
            uniforms.all(|(uniform, word)| uniform.load(sources) == *word)
        };
        if let Some(answer) = answers.iter().find(|answer| is_same(answer)) {
            return answer.failing;
        }
        let answer = self.answer(sources);
        if answers.len() == MOST_ANSWERS {
            answers.remove(0);
        }
        let failing = answer.failing;
        answers.push(answer);
        failing
    }

    fn answer(&self, sources: Sources<'_>) -> Answer {
        let mut walk = Walk::new(&self.tree, sources);
        let mut fails = |code: u8| {
            let alpha = Range::new(0.0, f32::from(code) / 255.0 + 1.0 / 256.0);
            let result = walk.output((self.read, alpha));
            match self.tree.interface.outputs.first() {
                Some(Output::Cover) => result.mask() == Some(false),
                _ => result
                    .range()
                    .is_some_and(|alpha| alpha.most <= COVERS_NOTHING),
            }
        };
        // What fails up to an alpha fails up to smaller ones.
        let failing = fails(0).then(|| {
            let (mut failing, mut end) = (0, u8::MAX);
            while end - failing > 1 {
                let middle = failing + (end - failing) / 2;
                if fails(middle) {
                    failing = middle;
                } else {
                    end = middle;
                }
            }
            failing
        });
        Answer {
            uniforms: walk.uniforms,
            failing,
        }
    }
}

/// Counts nodes; false if there is a loop.
fn is_walkable(nodes: &[Node], count: &mut usize) -> bool {
    *count += nodes.len();
    nodes.iter().all(|node| match node {
        Node::Op { .. } | Node::Branch { .. } => true,
        Node::If { accept, reject, .. } => is_walkable(accept, count) && is_walkable(reject, count),
        Node::Block { body, .. } => is_walkable(body, count),
        Node::Loop { .. } => false,
    })
}
