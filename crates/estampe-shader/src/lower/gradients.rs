//! Textures that are sampled at varyings as they are take their level of detail from the varyings'
//! derivatives.
//!
//! In · Out: an optimised tree of the fragment stage · the same tree, of which some implicit levels
//! of detail have become gradients. Precision: `docs/NUMERICS.md`.
//!
//! An implicit level of detail comes from the differences within a quad of 2×2 fragments. So the
//! fragments of the quad that the primitive does not cover must be shaded, too. But the pipeline
//! has the plane of each varying, and knows the varying's derivatives at each fragment. Where each
//! coordinate of each sample is a varying as it is, the derivatives become inputs of the stage, and
//! the gradients of the samples, in any control flow. The shader then needs no helper invocations.
//!
//! All samples stay as they are if one of them, or anything else, needs its quad: one is as dear as
//! all. Such are
//!
//! * samples at coordinates that the shader computes;
//! * samples at varyings that are interpolated beside the centre, each fragment at its own place;
//! * samples with a bias;
//! * derivatives, and what invocations of a quad exchange.

use crate::program::VaryingSlot;
use estampe_ir::interface::{Input, Stage};
use estampe_ir::op::{Axis, LevelOfDetail, TextureOp, TextureQuery};
use estampe_ir::tree::{Node, Tree};
use estampe_ir::{Op, Type, Value};
use estampe_types::shader::Sampling;
use std::collections::HashMap;

/// Gives samples with an implicit level of detail the gradients of their coordinates, if these are
/// varyings as they are and nothing else needs quads; in the fragment stage only.
pub(super) fn take_gradients(tree: &mut Tree, varyings: &[VaryingSlot]) {
    if tree.stage != Stage::Fragment {
        return;
    }
    let at_centre = varyings
        .iter()
        .filter(|slot| slot.sampling == Sampling::Center);
    let at_centre: Vec<u32> = at_centre
        .flat_map(|slot| slot.first..slot.first + slot.components)
        .collect();
    let mut body = std::mem::take(&mut tree.body);
    let mut gradients = Gradients {
        scalar_of: HashMap::new(),
        derivatives: HashMap::new(),
        reads: Vec::new(),
        tree,
    };
    each_op(&mut body, &mut |op, first| {
        let input = match op {
            Op::Input(at) => gradients.tree.interface.inputs.get(*at as usize),
            _ => None,
        };
        if let Some(Input::Varying(scalar)) = input
            && at_centre.contains(scalar)
        {
            gradients.scalar_of.insert(first, *scalar);
        }
    });
    let mut needs_quads = false;
    each_op(&mut body, &mut |op, _| {
        needs_quads |= gradients.needs_quads(op)
    });
    if !needs_quads {
        each_op(&mut body, &mut |op, _| {
            if let Op::Texture(op) = op {
                gradients.rewrite(op);
            }
        });
    }
    body.splice(..0, gradients.reads);
    tree.body = body;
}

struct Gradients<'a> {
    /// The tree, without its body.
    tree: &'a mut Tree,
    /// The values that are varyings at the centre, each with its scalar.
    scalar_of: HashMap<Value, u32>,
    /// The derivatives that were asked for.
    derivatives: HashMap<Input, Value>,
    /// The operations that read them.
    reads: Vec<Node>,
}

impl Gradients<'_> {
    /// True if an operation looks at other invocations of its quad, whatever becomes of it here.
    fn needs_quads(&self, op: &Op) -> bool {
        match op {
            Op::Derivative { .. } | Op::QuadLane { .. } => true,
            Op::Texture(op) if op.sampler.is_some() => match op.level {
                LevelOfDetail::Implicit => self.scalars(op).is_none(),
                LevelOfDetail::Bias(_) => true,
                _ => false,
            },
            _ => false,
        }
    }

    /// The scalars of the varyings that are the coordinates of a sample.
    fn scalars(&self, op: &TextureOp) -> Option<Vec<u32>> {
        let samples = matches!(op.query, TextureQuery::Sample | TextureQuery::SampleCompare);
        let scalars = op.coordinates.iter();
        let scalars = scalars.map(|at| self.scalar_of.get(at).copied());
        scalars.collect::<Option<_>>().filter(|_| samples)
    }

    fn rewrite(&mut self, op: &mut TextureOp) {
        if op.sampler.is_none() || op.level != LevelOfDetail::Implicit {
            return;
        }
        let Some(scalars) = self.scalars(op) else {
            return;
        };
        let mut along = |axis| {
            let of = |&scalar| self.derivative(Input::Derivative { scalar, axis });
            scalars.iter().map(of).collect()
        };
        op.level = LevelOfDetail::Gradient {
            x: along(Axis::X),
            y: along(Axis::Y),
        };
    }

    /// The value of a derivative, which is read once.
    fn derivative(&mut self, input: Input) -> Value {
        *self.derivatives.entry(input).or_insert_with(|| {
            let of = |count: usize| u32::try_from(count).expect("a tree of fewer than 2^32 values");
            let inputs = &mut self.tree.interface.inputs;
            let op = Op::Input(of(inputs.len()));
            inputs.push(input);
            let first = Value(of(self.tree.types.len()));
            self.tree.types.push(Type::Word);
            self.reads.push(Node::Op { op, first });
            first
        })
    }
}

/// Calls `visit` with each operation and its first result.
fn each_op(nodes: &mut [Node], visit: &mut impl FnMut(&mut Op, Value)) {
    for node in nodes {
        match node {
            Node::Op { op, first } => visit(op, *first),
            Node::Branch { .. } => {}
            Node::If { accept, reject, .. } => {
                each_op(accept, visit);
                each_op(reject, visit);
            }
            Node::Block { body, .. } | Node::Loop { body, .. } => each_op(body, visit),
        }
    }
}
