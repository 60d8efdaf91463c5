//! A walk through a tree that evaluates it with what is known of its inputs.

use super::super::uniforms::Sources;
use super::range::{Known, Range};
use estampe_ir::interface::Input;
use estampe_ir::interpreter::Words;
use estampe_ir::tree::{Label, Node, Tree};
use estampe_ir::{Op, Value};

/// The place of a uniform word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Uniform {
    /// A word of the immediates, by its number.
    Immediate(u32),
    /// A word of a buffer, by its position in the interface and the offset in bytes.
    Buffer(u32, u32),
}

impl Uniform {
    /// The word; `None` in a buffer that others may store to.
    pub(super) fn load(self, sources: Sources<'_>) -> Option<u32> {
        match self {
            Self::Immediate(at) => {
                let word = sources.immediates.get(at as usize);
                Some(word.copied().unwrap_or(0))
            }
            Self::Buffer(at, offset) => {
                let buffer = sources.buffers.get(at as usize)?;
                matches!(buffer.words(), Words::ReadOnly(_)).then(|| buffer.load(offset))
            }
        }
    }
}

/// Walks through a tree without loops.
pub(super) struct Walk<'a, 's> {
    tree: &'a Tree,
    sources: Sources<'s>,
    /// A texture read, and its alpha.
    alpha: (u32, Range),
    known: Vec<Known>,
    /// The uniform words that were read, each once.
    pub(super) uniforms: Vec<(Uniform, Option<u32>)>,
}

impl<'a, 's> Walk<'a, 's> {
    pub(super) fn new(tree: &'a Tree, sources: Sources<'s>) -> Self {
        Self {
            tree,
            sources,
            alpha: (0, Range::new(0.0, 0.0)),
            known: Vec::new(),
            uniforms: Vec::new(),
        }
    }

    /// Walks with the alpha of a read, and tells what is known of the first output.
    pub(super) fn output(&mut self, alpha: (u32, Range)) -> Known {
        let tree = self.tree;
        self.alpha = alpha;
        self.known.clear();
        self.known.resize(tree.len(), Known::Nothing);
        self.body(&tree.body, &mut Vec::new());
        tree.outputs
            .first()
            .map_or(Known::Nothing, |at| self.of(*at))
    }

    fn of(&self, value: Value) -> Known {
        self.known
            .get(value.index())
            .copied()
            .unwrap_or(Known::Nothing)
    }

    /// Walks through a body. `left` collects what branches to the blocks around it give. Returns
    /// true if the end of the body may be reached.
    fn body(&mut self, nodes: &'a [Node], left: &mut Vec<(Label, Vec<Known>)>) -> bool {
        for node in nodes {
            let goes_on = match node {
                Node::Op { op, first } => {
                    let known = self.op(op);
                    if let Some(to) = self.known.get_mut(first.index())
                        && !op.results().is_empty()
                    {
                        *to = known;
                    }
                    true
                }
                Node::If {
                    condition,
                    accept,
                    reject,
                } => match self.of(*condition).mask() {
                    Some(true) => self.body(accept, left),
                    Some(false) => self.body(reject, left),
                    None => {
                        let accepts = self.body(accept, left);
                        self.body(reject, left) || accepts
                    }
                },
                Node::Block {
                    label,
                    results,
                    body,
                } => self.block((*label, results), body, left),
                Node::Branch { label, arguments } => {
                    let arguments = arguments.iter().map(|value| self.of(*value));
                    left.push((*label, arguments.collect()));
                    false
                }
                // Trees with loops are not walked through.
                Node::Loop { .. } => false,
            };
            if !goes_on {
                return false;
            }
        }
        true
    }

    fn block(
        &mut self,
        (label, results): (Label, &[Value]),
        body: &'a [Node],
        left: &mut Vec<(Label, Vec<Known>)>,
    ) -> bool {
        let mut inside = Vec::new();
        let mut goes_on = self.body(body, &mut inside);
        let mut joined: Option<Vec<Known>> = None;
        for (to, arguments) in inside {
            if to != label {
                left.push((to, arguments));
                continue;
            }
            goes_on = true;
            joined = Some(match joined {
                None => arguments,
                Some(before) => {
                    let pairs = before.into_iter().zip(arguments);
                    pairs.map(|(a, b)| a.join(b)).collect()
                }
            });
        }
        for (result, known) in results.iter().zip(joined.into_iter().flatten()) {
            if let Some(to) = self.known.get_mut(result.index()) {
                *to = known;
            }
        }
        goes_on
    }

    /// What is known of the first result of an operation; of others nothing is.
    fn op(&mut self, op: &Op) -> Known {
        let of = |value: &Value| self.of(*value);
        match op {
            Op::Constant(word) => Known::Word(*word),
            Op::MaskConstant(mask) => Known::Mask(*mask),
            Op::Input(at) => self.input(*at),
            Op::Unary(kind, a) => of(a).unary(*kind),
            Op::Binary(kind, [a, b]) => of(a).binary(*kind, of(b)),
            Op::Fma(all) => Known::fma(all.map(|value| self.of(value))),
            Op::Compare(kind, [a, b]) => of(a).compare(*kind, of(b)),
            Op::MaskNot(a) => of(a).mask_not(),
            Op::MaskBinary(kind, [a, b]) => of(a).mask_binary(*kind, of(b)),
            Op::Select { mask, yes, no } => match of(mask).mask() {
                Some(true) => of(yes),
                Some(false) => of(no),
                None => of(yes).join(of(no)),
            },
            Op::Derivative { value, .. } => of(value).difference(),
            // Others of the quad may have other masks.
            Op::QuadAny(a) if of(a) == Known::Mask(true) => Known::Mask(true),
            Op::LoadBuffer { buffer, offset } => match of(offset) {
                Known::Word(offset) => self.uniform(Uniform::Buffer(*buffer, offset)),
                _ => Known::Nothing,
            },
            _ => Known::Nothing,
        }
    }

    fn input(&mut self, at: u32) -> Known {
        let (read, alpha) = self.alpha;
        match self.tree.interface.inputs.get(at as usize) {
            Some(Input::TextureRead {
                read: of,
                component: 3,
            }) if *of == read => Known::Range(alpha),
            Some(Input::PushConstant(at)) => self.uniform(Uniform::Immediate(*at)),
            _ => Known::Nothing,
        }
    }

    fn uniform(&mut self, at: Uniform) -> Known {
        let word = at.load(self.sources);
        if !self.uniforms.contains(&(at, word)) {
            self.uniforms.push((at, word));
        }
        word.map_or(Known::Nothing, Known::Word)
    }
}
