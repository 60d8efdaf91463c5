//! What code asks Rust for: rare operations, stores, atomic operations and textures.

use crate::compile::ResetLocal;
use crate::frame::Frame;
use crate::select::calls::{Kind, Served};
use estampe_ir::interpreter::{Buffer, Common, Run, TextureAccess, TextureAccesses, atomic};
use estampe_ir::op::{Memory, TextureOp};
use estampe_simd::{LANES, Level, Packet};
use std::any::Any;
use std::cell::RefCell;
use std::sync::atomic::AtomicU32;
use std::sync::atomic::Ordering::Relaxed;

/// What calls of a run need to know.
#[derive(Debug)]
pub(crate) struct Context<'a> {
    pub(crate) served: &'a [Served],
    pub(crate) frame: &'a Frame,
    pub(crate) run: &'a Run<'a>,
    pub(crate) level: Level,
    pub(crate) reset_locals: &'a [ResetLocal],
    /// The memory of the work-group.
    pub(crate) workgroup: &'a [AtomicU32],
    /// The packets that have a state.
    pub(crate) states: usize,
    /// A panic in a call, to go on with when the code has returned.
    pub(crate) panic: RefCell<Option<Box<dyn Any + Send>>>,
}

/// A call.
#[derive(Debug)]
pub(crate) struct Call<'a> {
    pub(crate) served: &'a Served,
    /// The operands, then the results.
    pub(crate) arguments: &'a mut [Packet<u32>],
    /// The lanes that act.
    pub(crate) mask: u16,
    pub(crate) mask_result: u16,
}

impl Context<'_> {
    /// True if a call panicked: the run ends as soon as the code returns.
    pub(crate) fn has_panicked(&self) -> bool {
        self.panic.borrow().is_some()
    }

    /// Sets arrays to their words at the start, in all lanes.
    pub(crate) fn reset_locals(&self, locals: &mut [Packet<u32>]) {
        for array in self.reset_locals {
            let words = locals.iter_mut().skip(array.first).take(array.words);
            let init = array.init.iter().copied().chain(std::iter::repeat(0));
            for (packet, word) in words.zip(init) {
                *packet = Packet([word; LANES]);
            }
        }
    }

    /// Does what the code asks for.
    pub(crate) fn serve(&self, call: &mut Call<'_>) {
        let is_set = |lane: usize| call.mask >> lane & 1 == 1;
        let lanes = (0..LANES).filter(|&lane| is_set(lane));
        let (operands, results) = call.arguments.split_at_mut(call.served.operands);
        match (&call.served.kind, operands, results) {
            (Kind::Store { memory }, [offset, value], _) => {
                let memory = self.memory(*memory);
                for lane in lanes {
                    if let Some(word) = memory.at(offset.0[lane]) {
                        word.store(value.0[lane], Relaxed);
                    }
                }
            }
            (Kind::Atomic { kind, memory }, [offset, operand], [result]) => {
                let memory = self.memory(*memory);
                *result = Packet::default();
                for lane in lanes {
                    let word = memory.at(offset.0[lane]);
                    let before = word.map_or(0, |word| atomic(*kind, word, operand.0[lane]));
                    result.0[lane] = before;
                }
            }
            (Kind::CompareExchange { memory }, [offset, expected, value], [result]) => {
                let memory = self.memory(*memory);
                *result = Packet::default();
                for lane in lanes {
                    let Some(word) = memory.at(offset.0[lane]) else {
                        continue;
                    };
                    let (expected, value) = (expected.0[lane], value.0[lane]);
                    let exchanged = word.compare_exchange(expected, value, Relaxed, Relaxed);
                    let (Ok(before) | Err(before)) = exchanged;
                    result.0[lane] = before;
                    call.mask_result |= u16::from(exchanged.is_ok()) << lane;
                }
            }
            _ => debug_assert!(false, "a call has the packets of its kind"),
        }
    }

    /// Accesses textures, as the code asks for.
    #[inline]
    pub(crate) fn access_textures(
        &self,
        (ops, common): (&[TextureOp], Common),
        served: &Served,
        arguments: &mut [Packet<u32>],
        mask: u16,
    ) {
        let masks = [mask];
        let (operands, results) = arguments.split_at_mut(served.operands);
        if let ([op], Common::Nothing) = (ops, common) {
            let access = TextureAccess::new(op, (self.level, &masks), operands, results);
            self.run.textures.access(access);
        } else {
            let ops = (ops, common);
            let accesses = TextureAccesses::new(ops, (self.level, &masks), operands, results);
            self.run.textures.access_all(accesses);
        }
        if served.uniform == 0 {
            return;
        }
        let first = (0..LANES).find(|lane| mask >> lane & 1 == 1);
        for (bit, result) in results.iter_mut().enumerate() {
            if served.uniform >> bit & 1 == 1 {
                *result = Packet([first.map_or(0, |lane| result.0[lane]); LANES]);
            }
        }
    }

    fn memory(&self, memory: Memory) -> Places<'_> {
        match memory {
            Memory::Buffer(at) => {
                let buffer = self.run.buffers.get(at as usize);
                Places::Buffer(buffer.copied().unwrap_or_default())
            }
            Memory::Workgroup => Places::Workgroup(self.workgroup),
        }
    }
}

/// Memory that is stored to.
#[derive(Debug, Clone, Copy)]
enum Places<'a> {
    Buffer(Buffer<'a>),
    Workgroup(&'a [AtomicU32]),
}

impl<'a> Places<'a> {
    /// The word at an offset, as operations count it; `None` outside.
    fn at(&self, offset: u32) -> Option<&'a AtomicU32> {
        match self {
            Self::Buffer(buffer) => buffer.at(offset),
            Self::Workgroup(words) => words.get(offset as usize),
        }
    }
}
