//! Control flow that is not uniform: lanes run one side after the other, and wait at labels.
//!
//! * A branch to a divergent label: the running lanes wait there, and none runs on.
//! * The end of a divergent block: the lanes that wait run again.
//! * The end of the body of a divergent loop: if lanes wait, they begin the next iteration.
//! * An `if`: the lanes that chose a side run through it. It is skipped if there are none, and if
//!   it costs more than a branch.

use super::flow::Incoming;
use super::leaving::{WORTH_A_BRANCH, cost};
use super::{Around, Carried, Lowering, RUNNING, State, Way};
use crate::Value;
use crate::lanes::{Jump, Terminator, ValueInfo};
use crate::op::MaskBinary;
use crate::tree::{Label, Node};

impl<'a> Lowering<'a> {
    pub(super) fn varying_if(&mut self, node: &Node, mask: Value, sides: [&'a [Node]; 2]) {
        let running = self.state[RUNNING];
        let masks = [
            self.mask_binary(MaskBinary::And, running, mask),
            self.mask_binary(MaskBinary::AndNot, running, mask),
        ];
        let mut after = self.constants.none;
        for (side, mask) in sides.into_iter().zip(masks) {
            self.state[RUNNING] = mask;
            if !side.is_empty() {
                self.side(side);
            }
            if self.current.is_none() {
                return;
            }
            after = self.mask_binary(MaskBinary::Or, after, self.state[RUNNING]);
        }
        let all_stay = self.leaving.of(node).is_empty();
        self.state[RUNNING] = if all_stay { running } else { after };
    }

    /// One side of an `if`, for the running lanes.
    pub(super) fn side(&mut self, body: &'a [Node]) {
        let (Some(fork), mask) = (self.current, self.state[RUNNING]) else {
            return;
        };
        if cost(body) < WORTH_A_BRANCH {
            self.body(body);
            return;
        }
        let mut skipped = self.state.clone();
        skipped[RUNNING] = self.constants.none;
        let side = self.new_block();
        self.set_terminator(
            fork,
            Terminator::Branch {
                mask,
                any: Jump::to(side),
                none: Jump::unknown(),
            },
        );
        self.current = Some(side);
        let not_empty = std::mem::replace(&mut self.not_empty, mask);
        self.body(body);
        self.not_empty = not_empty;
        let ran = self.incoming(Vec::new());
        let skipped = Incoming::if_none(fork, skipped);
        self.join(ran.into_iter().chain([skipped]).collect(), &[]);
    }

    pub(super) fn divergent_block(
        &mut self,
        node: &Node,
        label: Label,
        results: &[Value],
        body: &'a [Node],
    ) {
        let before = self.state[RUNNING];
        let none_brought = self.nothing(results);
        let slot = self.wait_at(label, none_brought);
        self.body(body);
        self.around.pop();
        let waiting = self.state[slot];
        for (result, brought) in results.iter().zip(self.state.drain(slot..).skip(1)) {
            self.map[result.index()] = brought;
        }
        if self.current.is_none() {
            return;
        }
        let running = self.state[RUNNING];
        let after = self.mask_binary(MaskBinary::Or, running, waiting);
        let all_stay = self.leaving.of(node).is_empty();
        self.state[RUNNING] = if all_stay { before } else { after };
    }

    pub(super) fn divergent_loop(
        &mut self,
        node: &Node,
        label: Label,
        (parameters, initial): Carried<'_>,
        body: &'a [Node],
    ) {
        // The lanes that reached the end of the body, and so left the loop.
        let left = self.state.len();
        self.state.push(self.constants.none);
        let changed = self.changed_in(node, left);
        let carried = |state: &State| -> Vec<_> { changed.iter().map(|&at| state[at]).collect() };
        let mut arguments = self.mapped(initial);
        arguments.extend(carried(&self.state));
        let header = self.start_header(arguments);
        self.define_parameters(header, parameters);
        for &at in &changed {
            let kind = self.kernel.values[self.state[at].index()].kind;
            self.state[at] = self.parameter(
                header,
                ValueInfo {
                    kind,
                    is_uniform: false,
                },
            );
        }
        let not_empty = std::mem::replace(&mut self.not_empty, self.state[RUNNING]);
        let brought = self.mapped(parameters);
        let slot = self.wait_at(label, brought);
        self.body(body);
        self.around.pop();
        self.not_empty = not_empty;
        let Some(end) = self.current else {
            self.state.truncate(left);
            return;
        };
        let (waiting, running) = (self.state[slot], self.state[RUNNING]);
        let has_left = self.mask_binary(MaskBinary::Or, self.state[left], running);
        self.state[left] = has_left;
        self.state[RUNNING] = waiting;
        let mut arguments = self.state[slot + 1..].to_vec();
        arguments.extend(carried(&self.state));
        let exit = self.new_block();
        self.set_terminator(
            end,
            Terminator::Branch {
                mask: waiting,
                any: Jump {
                    to: header,
                    arguments,
                },
                none: Jump::to(exit),
            },
        );
        self.current = Some(exit);
        self.state[RUNNING] = has_left;
        self.state.truncate(left);
    }

    /// The parts of the state that the body of a divergent loop may change.
    fn changed_in(&self, node: &Node, left: usize) -> Vec<usize> {
        let targets = self.leaving.of(node);
        let mut changed = vec![RUNNING, left];
        for around in &self.around {
            if let Way::Waiting { slot, values } = around.way
                && targets.contains(&around.label)
            {
                changed.extend(slot..=slot + values);
            }
        }
        changed
    }

    /// The running lanes wait at a label.
    pub(super) fn wait(&mut self, slot: usize, brought: &[Value]) {
        let (waiting, running) = (self.state[slot], self.state[RUNNING]);
        for (offset, &new) in brought.iter().enumerate() {
            let at = slot + 1 + offset;
            let old = self.state[at];
            self.state[at] = if waiting == self.constants.none {
                new
            } else {
                self.select(running, new, old)
            };
        }
        self.state[slot] = self.mask_binary(MaskBinary::Or, waiting, running);
        self.state[RUNNING] = self.constants.none;
    }

    /// Begins to collect the lanes that wait at a label, and the values that they bring. Returns
    /// the place of their mask in the state.
    fn wait_at(&mut self, label: Label, brought: Vec<Value>) -> usize {
        let slot = self.state.len();
        self.around.push(Around {
            label,
            way: Way::Waiting {
                slot,
                values: brought.len(),
            },
        });
        self.state.push(self.constants.none);
        self.state.extend(brought);
        slot
    }
}
