//! A compute shader as text.

use super::batch::immediate;
use super::machine::has_machine_code;
use super::packed::{PackedBindings, PackedStage};
use super::stage::Stage;
use super::{LinkError, StageSource, layouts};
use crate::order::Accesses;
use estampe_ir::interface::Input;
use estampe_ir::interpreter::{InputData, Stopped};
use estampe_simd::{LANES, Level, Packet};
use estampe_types::shader::{
    ComputeInterface, ComputeProgram, ComputeStopped, WorkgroupOrder, Workgroups,
};
use estampe_types::{BindGroupLayout, Bindings};

/// The most invocations of a work-group, whatever the limits of a device are.
pub const MAX_INVOCATIONS: u32 = 1 << 16;

/// The work-groups of a run: enough that what they share costs little, and few enough that a stage
/// is soon found to run often.
const TOGETHER: usize = 64;

const LANE_NUMBERS: [u32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];
const PACKET: u32 = LANE_NUMBERS[LANES - 1] + 1;

/// A compute shader.
#[derive(Debug)]
pub struct TextCompute {
    interface: ComputeInterface,
    layouts: Vec<BindGroupLayout>,
    immediate_size: u32,
    accesses: Accesses,
    stage: Stage,
    /// For textures whose texels are packed.
    packed: Option<PackedStage>,
    /// x, y and z of each invocation in its work-group, in packets.
    local_ids: [Vec<Packet<u32>>; 3],
    /// The number of each invocation in its work-group.
    local_index: Vec<Packet<u32>>,
    /// The lanes of each packet that are invocations.
    cover: Vec<u16>,
}

impl TextCompute {
    /// Compiles a stage. Its work-groups run in any order where that cannot be seen; those that
    /// execute more than `budget` jumps are stopped.
    ///
    /// # Errors
    /// [`LinkError`] if it has more than [`MAX_INVOCATIONS`] in a work-group, or binds too much.
    pub fn new(source: &StageSource, budget: u64) -> Result<Self, LinkError> {
        let tree = &source.tree;
        let size = tree.interface.workgroup_size;
        let invocations = size.iter().map(|side| u64::from(*side)).product::<u64>();
        let invocations = u32::try_from(invocations).unwrap_or(u32::MAX);
        if invocations > MAX_INVOCATIONS {
            return Err(LinkError::Invocations { size });
        }
        let packets = invocations.div_ceil(PACKET);
        let lanes = |of: &dyn Fn(u32) -> u32| -> Vec<Packet<u32>> {
            let first = (0..packets).map(|packet| packet * PACKET);
            let packet = |first: u32| {
                Packet(LANE_NUMBERS.map(|lane| {
                    // Lanes beyond the last invocation repeat the first one.
                    let index = first + lane;
                    of(if index < invocations { index } else { 0 })
                }))
            };
            first.map(packet).collect()
        };
        let [width, height, _] = size.map(|side| side.max(1));
        Ok(Self {
            interface: ComputeInterface {
                workgroup_size: size,
                workgroup_storage_bytes: tree.interface.workgroup_words.saturating_mul(4),
            },
            accesses: Accesses::of(tree),
            local_ids: [
                lanes(&|index| index % width),
                lanes(&|index| index / width % height),
                lanes(&|index| index / width / height),
            ],
            local_index: lanes(&|index| index),
            cover: (0..packets)
                .map(|packet| {
                    let left = invocations - packet * PACKET;
                    u16::MAX >> (PACKET - left.min(PACKET))
                })
                .collect(),
            layouts: layouts::of_stages(std::iter::once(source))?,
            immediate_size: source.immediate_size,
            stage: Stage::new(tree, budget),
            packed: PackedStage::new(tree, budget),
        })
    }

    /// The same without machine code: the interpreter runs it at every level.
    #[must_use]
    pub fn interpreted(mut self) -> Self {
        self.stage.interpret();
        self.packed = None;
        self
    }

    /// True if machine code accesses the texels of textures with these bindings as words of memory,
    /// without a call for each.
    #[must_use]
    pub fn accesses_words(&self, level: Level, bindings: &Bindings) -> bool {
        self.packed(level, bindings).is_some()
    }

    /// The stage for packed textures, and what it binds, if all are.
    fn packed<'a>(
        &'a self,
        level: Level,
        bindings: &'a Bindings,
    ) -> Option<(&'a Stage, PackedBindings<'a>)> {
        // The interpreter does an access for all packets at once.
        let packed = self.packed.as_ref().filter(|_| has_machine_code(level))?;
        let textures = self.stage.textures(bindings);
        Some((packed.stage(), packed.bind(bindings, &textures)?))
    }

    fn input(
        &self,
        input: Input,
        count: [u32; 3],
        (immediates, packed): (&[u32], Option<&PackedBindings<'_>>),
    ) -> InputData<'_> {
        let part = |axes: [u32; 3], axis: u32| axes.get(axis as usize).copied().unwrap_or(0);
        match input {
            Input::LocalInvocationId(axis) => {
                let ids = self.local_ids.get(axis as usize);
                InputData::words(ids.map_or(&[][..], Vec::as_slice), 0, 1)
            }
            Input::LocalInvocationIndex => InputData::words(&self.local_index, 0, 1),
            // Set for each work-group.
            Input::WorkgroupId(_) => InputData::Uniform(0),
            Input::NumWorkgroups(axis) => InputData::Uniform(part(count, axis)),
            Input::Cover => InputData::Mask(&self.cover),
            Input::PushConstant(at) => immediate(immediates, at),
            Input::TextureSide { texture, axis } => {
                InputData::Uniform(packed.map_or(0, |packed| packed.side(texture, axis)))
            }
            _ => InputData::Uniform(0),
        }
    }
}

impl ComputeProgram for TextCompute {
    fn interface(&self) -> &ComputeInterface {
        &self.interface
    }

    fn bind_group_layouts(&self) -> &[BindGroupLayout] {
        &self.layouts
    }

    fn immediate_size(&self) -> u32 {
        self.immediate_size
    }

    fn order(&self, bindings: &Bindings, count: [u32; 3]) -> WorkgroupOrder {
        self.accesses.order(bindings, count)
    }

    fn run_workgroups(
        &self,
        level: Level,
        bindings: &Bindings,
        work: &Workgroups,
    ) -> Result<(), ComputeStopped> {
        let packed = self.packed(level, bindings);
        let (stage, packed) = match &packed {
            Some((stage, packed)) => (*stage, Some(packed)),
            None => (&self.stage, None),
        };
        let (buffers, textures) = (stage.buffers(bindings), stage.textures(bindings));
        let buffers = packed.map_or(buffers.all(), PackedBindings::buffers);
        let of_dispatch = (&bindings.immediates[..], packed);
        let of_stage = stage.interface().inputs.iter();
        let inputs = of_stage.map(|input| self.input(*input, work.count, of_dispatch));
        let mut inputs: Vec<_> = inputs.collect();
        let packets = self.cover.len();
        let mut ids = work.ids();
        let mut together = Vec::with_capacity(TOGETHER);
        loop {
            together.clear();
            together.extend(ids.by_ref().take(TOGETHER));
            if together.is_empty() {
                break;
            }
            let (bound, groups) = ((&textures, buffers), (packets, &together[..]));
            stage
                .run_workgroups(level, bound, groups, &mut inputs)
                .map_err(|stopped| match stopped {
                    Stopped::Budget => ComputeStopped::Budget,
                    Stopped::Memory => ComputeStopped::OutOfMemory,
                })?;
        }
        Ok(())
    }
}
