//! The frame: the memory that code and its callers share, laid out when code is made.
//!
//! `rbx` points to it while code runs, and `r12` to where its first byte would be if the *state* of
//! the packet that runs were the first one. It holds, in this order:
//!
//! | part | has |
//! |---|---|
//! | head | the budget, and what calls need |
//! | table | values that are the same in all lanes of a run, one word each (AVX2: one vector) |
//! | buffers | the address and lengths of each, and of the memory of a work-group |
//! | still | for each input a packet that does not move: zeros, or a uniform word |
//! | sink | a packet for outputs that go nowhere |
//! | arguments | operands and results of calls |
//! | state | where the packet goes on; this part and those below are there for each packet of a work-group, one after the other |
//! | pointers | where each input is read and each output written, for each packet of a pass |
//! | steps | what is added to each pointer after a pass |
//! | locals | the arrays of the lanes, a packet for each word |
//! | spills | registers that did not fit |

use estampe_ir::lanes::Kernel;
use std::ops::Range;

/// Offsets in the head, in bytes.
pub(crate) const BUDGET: i32 = 0;
pub(crate) const CONTEXT: i32 = 8;
pub(crate) const SERVE: i32 = 16;
/// The mask that a call is given, and the one that it gives: 16 bits, the rest is 0.
pub(crate) const MASK_ARGUMENT: i32 = 24;
pub(crate) const MASK_RESULT: i32 = 28;
/// A word for sequences of instructions.
pub(crate) const TEMPORARY: i32 = 32;
/// A word that stays 0.
const ZERO: u32 = 36;
/// The passes that are left, this one included: eight bytes.
pub(crate) const LEFT: i32 = 40;
/// Where the state is of the packet that runs, as `r12` has it.
pub(crate) const STATE: i32 = 48;
/// The budget of a pass, or of a work-group.
pub(crate) const PASS_BUDGET: i32 = 56;
/// The packets of a work-group, and those that have not ended: eight bytes each.
pub(crate) const PACKETS: i32 = 64;
pub(crate) const LIVE: i32 = 72;
/// The mask of the second packet of a call that serves two.
pub(crate) const SECOND_MASK_ARGUMENT: i32 = 80;
const HEAD: u32 = 128;

/// The number of the call that sets arrays to their words at the start.
pub(crate) const RESET_LOCALS: u32 = u32::MAX;

/// The bytes of a packet of words.
pub(crate) const PACKET: u32 = 64;

/// The bytes of a frame beyond which a kernel is refused.
pub(crate) const MAX_BYTES: u32 = 1 << 26;

/// The bytes of a frame with the states of all packets of a work-group, beyond which a run is
/// refused.
const MAX_STATES_BYTES: usize = 1 << 30;

/// The words of all tables of constants beyond which a kernel is refused.
const MAX_TABLE_WORDS: u32 = 1 << 20;

/// Where the parts of a frame begin, in bytes from its start.
#[derive(Debug, Clone)]
pub(crate) struct Frame {
    /// The bytes of a value of the table.
    pub(crate) slot_bytes: u32,
    pub(crate) buffers: u32,
    pub(crate) pointers: u32,
    pub(crate) steps: u32,
    inputs: u32,
    /// The bytes of the pointers of a packet: whole lines.
    packet_pointers: u32,
    /// The first byte of the state of the first packet.
    state: u32,
    /// The buffer that is the memory of the work-group.
    pub(crate) workgroup: u32,
    pub(crate) still: u32,
    pub(crate) sink: u32,
    pub(crate) arguments: u32,
    /// The first packet of each array that is stored to; tables have none.
    pub(crate) locals: Vec<u32>,
    pub(crate) spills: u32,
    /// All bytes, with one state; known when registers were allocated.
    pub(crate) bytes: u32,
}

impl Frame {
    /// The layout for a kernel with arrays of which some are stored to, so many values in the
    /// table, calls with so many packets of operands and results, and so many packets that a pass
    /// runs. `None` if it is too large.
    pub(crate) fn new(
        kernel: &Kernel,
        is_stored: impl Fn(u32) -> bool,
        (slots, slot_bytes): (u32, u32),
        (argument_packets, packets_of_pass): (u32, usize),
    ) -> Option<Self> {
        let interface = &kernel.interface;
        let is_workgroup = kernel.runs_workgroups();
        let mut end = HEAD;
        let mut part = |count: usize, bytes: u32| {
            let start = end;
            let size = u32::try_from(count).ok()?.checked_mul(bytes)?;
            end = start.checked_add(size)?.checked_next_multiple_of(PACKET)?;
            (end <= MAX_BYTES).then_some(start)
        };
        part(slots as usize, slot_bytes)?;
        let (inputs, outputs) = (interface.inputs.len(), interface.outputs.len());
        let buffers = part(interface.buffers.len() + usize::from(is_workgroup), 32)?;
        let still = part(inputs, PACKET)?;
        let sink = part(1, PACKET)?;
        let arguments = part(argument_packets as usize, PACKET)?;
        let state = part(usize::from(is_workgroup), PACKET)?;
        // Those of each packet of a pass begin a line.
        let of_packet = (inputs + outputs).checked_next_multiple_of(PACKET as usize / 8)?;
        let moving = of_packet.checked_mul(packets_of_pass)?;
        let pointers = part(moving, 8)?;
        let steps = part(moving, 8)?;
        let mut locals = Vec::new();
        let mut table_words = 0_u32;
        for (at, array) in (0..).zip(&interface.locals) {
            // Tables stand behind the code, once for all lanes.
            let is_stored = is_stored(at);
            locals.push(part(
                if is_stored { array.words as usize } else { 0 },
                PACKET,
            )?);
            if !is_stored {
                table_words = table_words.checked_add(array.words)?;
            }
        }
        if table_words > MAX_TABLE_WORDS {
            return None;
        }
        let spills = part(0, 0)?;
        Some(Self {
            slot_bytes,
            buffers,
            pointers,
            steps,
            inputs: u32::try_from(inputs).ok()?,
            packet_pointers: u32::try_from(of_packet).ok()?.checked_mul(8)?,
            state,
            workgroup: u32::try_from(interface.buffers.len()).ok()?,
            still,
            sink,
            arguments,
            locals,
            spills,
            bytes: spills,
        })
    }

    /// Adds room for spilled registers: so many units of eight bytes.
    pub(crate) fn reserve_spills(&mut self, units: usize) -> Option<()> {
        let bytes = u32::try_from(units).ok()?.checked_mul(8)?;
        let end = self.spills.checked_add(bytes)?;
        let end = end.checked_next_multiple_of(PACKET)?;
        self.bytes = self.bytes.max(end);
        (self.bytes <= MAX_BYTES).then_some(())
    }

    /// The bytes of the state of a packet.
    pub(crate) fn state_bytes(&self) -> u32 {
        self.bytes - self.state
    }

    /// The lines of a frame with so many states. `None` if there are too many.
    pub(crate) fn lines(&self, states: usize) -> Option<usize> {
        let more = states
            .checked_sub(1)?
            .checked_mul(self.state_bytes() as usize)?;
        let bytes = more.checked_add(self.bytes as usize)?;
        (bytes <= MAX_STATES_BYTES).then_some(bytes / PACKET as usize)
    }

    /// Where a packet goes on: the place is in its state.
    pub(crate) fn resume(&self) -> i32 {
        displacement(self.state)
    }

    /// True if a place is in the state of a packet.
    pub(crate) fn is_in_state(&self, offset: i32) -> bool {
        offset >= displacement(self.state)
    }

    /// A word that stays 0.
    #[expect(clippy::unused_self, reason = "a place of the frame like others")]
    pub(crate) fn zero(&self) -> u32 {
        ZERO
    }

    /// A value of the table.
    pub(crate) fn slot(&self, slot: u32) -> u32 {
        HEAD + slot * self.slot_bytes
    }

    /// The pointer to an input of a packet of the pass.
    pub(crate) fn input(&self, at: u32, packet: u32) -> u32 {
        self.pointers + packet * self.packet_pointers + at * 8
    }

    /// The pointer to an output of a packet of the pass.
    pub(crate) fn output(&self, at: u32, packet: u32) -> u32 {
        self.input(self.inputs + at, packet)
    }

    /// The lines of the pointers of a packet.
    pub(crate) fn packet_lines(&self) -> usize {
        (self.packet_pointers / PACKET) as usize
    }

    /// The bytes of the pointers, and of the steps: whole lines.
    pub(crate) fn pointer_bytes(&self) -> u32 {
        self.steps - self.pointers
    }

    /// The lines of the pointers and the steps of all packets of a pass.
    pub(crate) fn pointer_lines(&self) -> Range<usize> {
        let [start, end] = [self.pointers, self.steps + self.pointer_bytes()];
        (start / PACKET) as usize..(end / PACKET) as usize
    }

    /// The address of a buffer; its lengths follow.
    pub(crate) fn buffer(&self, at: u32) -> u32 {
        self.buffers + at * 32
    }
}

/// The number of words of a buffer, from where its address stands: eight bytes, the upper half 0.
pub(crate) const BUFFER_WORDS: u32 = 8;
/// The number of words of a buffer that may be stored to, from where its address stands: none of a
/// buffer that is only read.
pub(crate) const BUFFER_STORED_WORDS: u32 = 16;
/// The number of bytes of a buffer, from where its address stands.
pub(crate) const BUFFER_BYTES: u32 = 20;

/// An offset as a displacement: frames are far smaller than 2 GiB.
pub(crate) fn displacement(offset: u32) -> i32 {
    offset.cast_signed()
}
