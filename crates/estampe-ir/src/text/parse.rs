//! Trees and kernels from text.

use super::ParseError;
use super::interface::{STAGES, input, output};
use super::read::{Read, Reader};
use crate::interface::{BufferSlot, Interface, LocalArray, Stage, TextureSlot};
use crate::lanes::{BasicBlock, BlockId, Jump, Kernel, Terminator, ValueInfo};
use crate::tree::{Label, Node, Tree};
use crate::{Op, Value};

/// How deep the bodies of a tree may be nested.
const MAX_DEPTH: u32 = 200;

/// The kernel that a text describes. It may be one that [`verify`](crate::lanes::verify) refuses.
///
/// # Errors
/// Where the text is no kernel, and why.
pub fn kernel(text: &str) -> Result<Kernel, ParseError> {
    let mut reader = Reader::new(text);
    let (stage, interface) = reader.header("kernel")?;
    let mut blocks = Vec::new();
    while !reader.peek().is_empty() {
        let number = reader.numbered('b', "a block")?;
        if number as usize != blocks.len() {
            return reader.error(format!("expected block {}", blocks.len()));
        }
        blocks.push(reader.block()?);
    }
    let values = reader.known()?.into_iter();
    Ok(Kernel {
        stage,
        interface,
        values: values
            .map(|(kind, is_uniform)| ValueInfo { kind, is_uniform })
            .collect(),
        blocks,
    })
}

/// The tree that a text describes. It may be one that [`verify`](crate::tree::verify) refuses.
///
/// # Errors
/// Where the text is no tree, and why.
pub fn tree(text: &str) -> Result<Tree, ParseError> {
    let mut reader = Reader::new(text);
    let (stage, interface) = reader.header("tree")?;
    let mut body = Vec::new();
    while !reader.eat("outputs") {
        body.push(reader.node(0)?);
    }
    let outputs = reader.values()?;
    if !reader.peek().is_empty() {
        let found = reader.next()?;
        return reader.error(format!("expected the end, found `{found}`"));
    }
    if reader.names_uniform() {
        return reader.error("values of a tree are not called uniform");
    }
    Ok(Tree {
        stage,
        interface,
        types: reader.known()?.into_iter().map(|(kind, _)| kind).collect(),
        body,
        outputs,
    })
}

impl Reader<'_> {
    fn header(&mut self, kind: &str) -> Read<(Stage, Interface)> {
        self.expect(kind)?;
        let stage = self.next()?;
        let Some((_, stage)) = STAGES.iter().find(|(name, _)| *name == stage) else {
            return self.error(format!("`{stage}` is no stage"));
        };
        let mut interface = Interface::default();
        while self.entry(&mut interface)? {}
        Ok((*stage, interface))
    }

    /// Reads an entry of the interface; false if there is none.
    fn entry(&mut self, to: &mut Interface) -> Read<bool> {
        match self.peek() {
            "input" => {
                self.next()?;
                let name = self.next()?;
                match input(name, &self.numbers()?) {
                    Some(input) => to.inputs.push(input),
                    None => return self.error(format!("`{name}` is no input, with these numbers")),
                }
            }
            "output" => {
                self.next()?;
                let name = self.next()?;
                match output(name, &self.numbers()?) {
                    Some(output) => to.outputs.push(output),
                    None => {
                        return self.error(format!("`{name}` is no output, with these numbers"));
                    }
                }
            }
            "buffer" => {
                self.next()?;
                if self.eat("immediates") {
                    to.buffers.push(BufferSlot::IMMEDIATES);
                    return Ok(true);
                }
                let (group, binding) = self.slot()?;
                to.buffers.push(BufferSlot {
                    group,
                    binding,
                    is_written: self.eat("written"),
                });
            }
            "texture_at" => {
                self.next()?;
                let (group, binding) = self.slot()?;
                to.textures.push(TextureSlot { group, binding });
            }
            "sampler_at" => {
                self.next()?;
                let (group, binding) = self.slot()?;
                to.samplers.push(TextureSlot { group, binding });
            }
            "local" => {
                self.next()?;
                let words = self.number()?;
                let mut init = Vec::new();
                if self.eat("[") {
                    while !self.eat("]") {
                        if !init.is_empty() {
                            self.expect(",")?;
                        }
                        init.push(self.word()?);
                    }
                }
                to.locals.push(LocalArray { words, init });
            }
            "workgroup" => {
                self.next()?;
                to.workgroup_words = self.number()?;
                match self.numbers()?[..] {
                    [x, y, z] => to.workgroup_size = [x, y, z],
                    _ => return self.error("expected three numbers: the size of a work-group"),
                }
            }
            "undefined" => {
                self.next()?;
                self.values()?;
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// `group.binding`.
    fn slot(&mut self) -> Read<(u32, u32)> {
        let text = self.next()?;
        let numbers = text.split_once('.').and_then(|(group, binding)| {
            let group = group.parse().ok()?;
            Some((group, binding.parse().ok()?))
        });
        numbers.map_or_else(
            || self.error(format!("expected `group.binding`, found `{text}`")),
            Ok,
        )
    }

    fn block(&mut self) -> Read<BasicBlock> {
        let parameters = self.bracketed()?;
        self.expect(":")?;
        let mut ops = Vec::new();
        loop {
            let terminator = match self.peek() {
                "jump" => {
                    self.next()?;
                    Terminator::Jump(self.jump()?)
                }
                "branch" => {
                    self.next()?;
                    let mask = self.value()?;
                    self.expect("?")?;
                    let any = self.jump()?;
                    self.expect(":")?;
                    let none = self.jump()?;
                    Terminator::Branch { mask, any, none }
                }
                "return" => {
                    self.next()?;
                    Terminator::Return(self.values()?)
                }
                _ => {
                    ops.push(self.statement()?);
                    continue;
                }
            };
            return Ok(BasicBlock {
                parameters,
                ops,
                terminator,
            });
        }
    }

    fn jump(&mut self) -> Read<Jump> {
        let to = BlockId(self.numbered('b', "a block")?);
        let arguments = self.bracketed()?;
        Ok(Jump { to, arguments })
    }

    /// An operation with its first result. Where it has none, the value is 0.
    fn statement(&mut self) -> Read<(Op, Value)> {
        let results = self.values()?;
        if !results.is_empty() {
            self.expect("=")?;
        }
        let op = self.op()?;
        let first = results.first().copied().unwrap_or(Value(0));
        if results != first.and_next(op.results().len()) {
            return self
                .error("results are as many as the operation has, with consecutive numbers");
        }
        Ok((op, first))
    }

    fn node(&mut self, depth: u32) -> Read<Node> {
        if depth > MAX_DEPTH {
            return self.error("bodies are nested too deep");
        }
        match self.peek() {
            "if" => {
                self.next()?;
                let condition = self.value()?;
                let accept = self.body(depth)?;
                let reject = if self.eat("else") {
                    self.body(depth)?
                } else {
                    Vec::new()
                };
                Ok(Node::If {
                    condition,
                    accept,
                    reject,
                })
            }
            "block" => {
                self.next()?;
                let label = Label(self.numbered('l', "a label")?);
                let results = self.bracketed()?;
                let body = self.body(depth)?;
                Ok(Node::Block {
                    label,
                    results,
                    body,
                })
            }
            "loop" => self.loop_node(depth),
            "branch" => {
                self.next()?;
                let label = Label(self.numbered('l', "a label")?);
                let arguments = self.bracketed()?;
                Ok(Node::Branch { label, arguments })
            }
            _ => {
                let (op, first) = self.statement()?;
                Ok(Node::Op { op, first })
            }
        }
    }

    fn loop_node(&mut self, depth: u32) -> Read<Node> {
        self.next()?;
        let label = Label(self.numbered('l', "a label")?);
        let (mut parameters, mut initial) = (Vec::new(), Vec::new());
        if self.eat("(") {
            while !self.eat(")") {
                if !parameters.is_empty() {
                    self.expect(",")?;
                }
                parameters.push(self.value()?);
                self.expect("=")?;
                initial.push(self.value()?);
            }
        }
        let body = self.body(depth)?;
        Ok(Node::Loop {
            label,
            parameters,
            initial,
            body,
        })
    }

    fn body(&mut self, depth: u32) -> Read<Vec<Node>> {
        self.expect("{")?;
        let mut nodes = Vec::new();
        while !self.eat("}") {
            nodes.push(self.node(depth + 1)?);
        }
        Ok(nodes)
    }
}
