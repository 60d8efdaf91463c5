//! Where Rust calls machine code, and machine code calls Rust.
//!
//! This module has `unsafe` code. What holds on both sides is written in `frame`: code reads and
//! writes its frame alone, apart from reads of the inputs and buffers and writes of the outputs
//! whose addresses the frame has, each of which was checked when it was put there.

use crate::executable::Executable;
use crate::frame::{self, Frame};
use crate::select::calls::Kind;
use crate::serve::{Call, Context};
use estampe_simd::Packet;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// A cache line of a frame.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C, align(64))]
pub(crate) struct Line(pub(crate) [u64; 8]);

/// The type of the code's functions and of the one that it calls, whatever the system's own
/// convention is.
type Entry = unsafe extern "sysv64" fn(frame: *mut Line) -> u32;

/// The address that code calls for what it does not do itself.
pub(crate) fn serve_address() -> u64 {
    let serve: unsafe extern "sysv64" fn(*mut Line, u32) = serve;
    serve as usize as u64
}

/// Calls a function of the code. Returns what it returns: 0, or 1 if the budget was used up.
///
/// `lines` is a frame as the code lays it out. Its head has the address of `context`, whose layout
/// is the same one.
pub(crate) fn enter(
    executable: &Executable,
    offset: usize,
    lines: &mut [Line],
    context: &Context<'_>,
) -> u32 {
    let needed = context.frame.lines(context.states);
    assert!(
        needed.is_some_and(|needed| needed <= lines.len()),
        "the frame is as large as its layout"
    );
    let state = lines.as_mut_ptr().expose_provenance() as u64;
    let head = &mut lines[0].0;
    head[frame::CONTEXT as usize / 8] = std::ptr::from_ref(context).expose_provenance() as u64;
    head[frame::SERVE as usize / 8] = serve_address();
    head[frame::STATE as usize / 8] = state;
    let start = executable.start().wrapping_add(offset);
    // SAFETY: `offset` is where `compile` put a function of this type; the pages are executable.
    let entry = unsafe { std::mem::transmute::<*const u8, Entry>(start) };
    // SAFETY: the code was made for this layout of frames, which `lines` is large enough for, and
    // for instructions that the processor has: `compile` checks that. The addresses in the frame
    // are those of `context.run`, which is borrowed as long as `context`.
    unsafe { entry(lines.as_mut_ptr()) }
}

/// What code calls for what it does not do itself.
///
/// # Safety
/// `frame` is a frame that [`enter`] was given, and the code that it entered is running.
unsafe extern "sysv64" fn serve(frame: *mut Line, call: u32) {
    let context = frame.cast::<u8>().wrapping_add(frame::CONTEXT as usize);
    // SAFETY: the place is in the head, aligned to its eight bytes.
    let context = unsafe { *context.cast::<u64>() };
    let context = usize::try_from(context).expect("addresses have 64 bits");
    let context = std::ptr::with_exposed_provenance(context);
    // SAFETY: `enter` put the address there of what it borrows while the code runs.
    let context: &Context<'_> = unsafe { &*context };
    // Until the code returns there are no more calls after a panic.
    if context.has_panicked() {
        return;
    }
    let layout: &Frame = context.frame;
    if call == frame::RESET_LOCALS {
        // SAFETY: as for this function.
        context.reset_locals(unsafe { locals(frame, context) });
        return;
    }
    let Some(served) = context.served.get(call as usize) else {
        return;
    };
    let packets = (served.operands + served.results) * served.lanes;
    let arguments = frame.cast::<u8>().wrapping_add(layout.arguments as usize);
    // SAFETY: the frame has room for the operands and results of each call of the kernel from
    // `arguments` on, aligned to lines and before the arrays; all words are initialised, and the
    // code waits.
    let arguments =
        unsafe { std::slice::from_raw_parts_mut(arguments.cast::<Packet<u32>>(), packets) };
    let masks = [frame::MASK_ARGUMENT, frame::SECOND_MASK_ARGUMENT].map(|place| {
        let place = frame.cast::<u8>().wrapping_add(place as usize);
        // SAFETY: the places are in the head, aligned to their two bytes.
        unsafe { *place.cast::<u16>() }
    });
    let mut mask_result = 0;
    // A panic, of a caller's texture, must not go through machine code: it goes on in `Code::run`.
    let done = catch_unwind(AssertUnwindSafe(|| {
        let of_packet = served.operands + served.results;
        let mut left = arguments;
        for mask in masks.into_iter().take(served.lanes) {
            let (arguments, others) = left.split_at_mut(of_packet);
            left = others;
            if let Kind::Textures(ops, common) = &served.kind {
                context.access_textures((ops, *common), served, arguments, mask);
                continue;
            }
            let mut call = Call {
                served,
                arguments,
                mask,
                mask_result: 0,
            };
            context.serve(&mut call);
            mask_result = call.mask_result;
        }
    }));
    if let Err(panic) = done {
        *context.panic.borrow_mut() = Some(panic);
        // The code soon returns: loops end at their next jump backwards, and this pass is the last.
        for (place, value) in [(frame::BUDGET, 0), (frame::LEFT, 1)] {
            let place = frame.cast::<u8>().wrapping_add(place as usize);
            // SAFETY: the place is in the head, aligned to its eight bytes.
            unsafe { *place.cast::<u64>() = value };
        }
    }
    let place = frame.cast::<u8>().wrapping_add(frame::MASK_RESULT as usize);
    // SAFETY: the place is in the head, aligned to its two bytes; the code reads it when this
    // function returns.
    unsafe { *place.cast::<u16>() = mask_result };
}

/// The words of all arrays of the packet that runs.
///
/// # Safety
/// `frame` is the frame that [`enter`] was given with this context, and the code that it entered
/// waits for a call. There is no other reference to the words.
unsafe fn locals<'a>(frame: *mut Line, context: &Context<'_>) -> &'a mut [Packet<u32>] {
    let layout: &Frame = context.frame;
    let locals = layout.locals.first().copied().unwrap_or(layout.spills);
    let local_packets = (layout.spills - locals) / frame::PACKET;
    let state = frame.cast::<u8>().wrapping_add(frame::STATE as usize);
    // SAFETY: the place is in the head, aligned to its eight bytes.
    let state = unsafe { *state.cast::<u64>() };
    let first = frame.expose_provenance() as u64;
    let state = usize::try_from(state.wrapping_sub(first)).expect("addresses have 64 bits");
    let last = (context.states - 1) * layout.state_bytes() as usize;
    let is_state = state <= last && state.is_multiple_of(size_of::<Line>());
    assert!(is_state, "code is in the state of one of its packets");
    let locals = frame.cast::<u8>().wrapping_add(state + locals as usize);
    // SAFETY: the arrays lie between the pointers and the spilled registers of a state, aligned to
    // lines; the words are initialised, and the code waits.
    unsafe { std::slice::from_raw_parts_mut(locals.cast::<Packet<u32>>(), local_packets as usize) }
}
