//! Several work-groups of a dispatch in a call: what they share is looked for once.

use crate::Code;
use crate::enter::{Line, enter};
use crate::frame::{self, PACKET};
use crate::run::{LINE, clear, find_data, set_head, splat};
use crate::scratch::Scratch;
use crate::serve::Context;
use estampe_ir::interpreter::{Run, Stopped};
use estampe_simd::Level;
use std::cell::RefCell;

/// How to run the packets of another work-group, as those of the first one.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Again {
    /// Where the function begins.
    pub(crate) function: usize,
    pub(crate) passes: usize,
}

impl Code {
    /// Executes the kernel for work-groups with these ids, one after the other: each as
    /// [`run`](Self::run) does with its own `Input::WorkgroupId`, all else being the same, which is
    /// looked for once. Without ids, one run with the inputs as they are.
    ///
    /// # Errors
    /// [`Stopped`] as for one run; the work-groups after it are not run.
    ///
    /// # Panics
    /// Where an access to a texture panics.
    pub fn run_workgroups(
        &self,
        level: Level,
        run: &Run<'_>,
        ids: &[[u32; 3]],
        scratch: &mut Scratch,
    ) -> Result<(), Stopped> {
        if run.packets == 0 {
            return Ok(());
        }
        let states = self.workgroup_words.map_or(1, |_| run.packets);
        self.make_room(states, scratch)?;
        self.set_table(run, &mut scratch.lines);
        self.set_buffers(run, scratch);
        let Scratch {
            lines,
            workgroup,
            tracks,
            pointers,
            begin,
            ..
        } = scratch;
        find_data(run, tracks);
        set_head(lines, frame::PASS_BUDGET, run.budget);
        let mut before = None;
        for number in 0..ids.len().max(1) {
            if number > 0 {
                clear(workgroup);
            }
            if let Some(id) = ids.get(number) {
                self.set_workgroup_id(*id, lines);
            }
            let context = Context {
                served: &self.served,
                frame: &self.frame,
                run,
                level,
                reset_locals: &self.reset_locals,
                workgroup,
                states,
                panic: RefCell::new(None),
            };
            if let Some(prepare) = self.prepare {
                enter(&self.executable, prepare, lines, &context);
            }
            let stopped = match before {
                Some(before) => self.run_again(before, (pointers, lines), &context),
                None if self.workgroup_words.is_some() => {
                    self.run_workgroup(run, (tracks, lines), &context)
                }
                None => self.run_packets(run, (tracks, lines), (begin, pointers), &context),
            };
            if let Some(panic) = context.panic.take() {
                std::panic::resume_unwind(panic);
            }
            before = stopped?;
        }
        Ok(())
    }

    /// Runs another work-group as the one before, if need be with the pointers that it found.
    fn run_again(
        &self,
        before: Again,
        (pointers, lines): (&[Line], &mut [Line]),
        context: &Context<'_>,
    ) -> Result<Option<Again>, Stopped> {
        if self.workgroup_words.is_none() {
            lines[self.frame.pointer_lines()].copy_from_slice(pointers);
        }
        set_head(lines, frame::LEFT, before.passes as u64);
        self.enter(before.function, lines, context)?;
        Ok(Some(before))
    }

    /// True if the kernel asks for the id of its work-group, as those of dispatches do.
    pub(crate) fn has_workgroup_ids(&self) -> bool {
        !self.workgroup_ids.is_empty()
    }

    /// Sets the inputs that are the id of a work-group.
    fn set_workgroup_id(&self, id: [u32; 3], lines: &mut [Line]) {
        for &(at, axis) in &self.workgroup_ids {
            let word = id.get(axis as usize).copied().unwrap_or_default();
            for &(_, slot) in self.table_inputs.iter().filter(|(input, _)| *input == at) {
                self.set_slot(slot, word, lines);
            }
            let still = self.frame.still + at * PACKET;
            lines[(still / LINE) as usize] = splat(word);
        }
    }
}
