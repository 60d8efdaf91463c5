//! What a run is given, and what it leaves.

use super::generate::{OUTPUTS, UNIFORMS, VARYINGS};
use estampe_ir::interface::{Input, Stage};
use estampe_ir::interpreter::{
    Buffer, InputData, OutputData, Run, Stopped, TextureAccess, Textures, cells,
};
use estampe_ir::lanes::Kernel;
use estampe_simd::{LANES, Packet};
use fastrand::Rng;
use std::cell::Cell;
use std::sync::atomic::{AtomicU32, Ordering};

/// Jumps of a run; kernels that need more are left out.
const BUDGET: u64 = 1 << 16;

/// What a run is given.
#[derive(Debug)]
pub(super) struct Case {
    packets: usize,
    /// In quads the lanes run together.
    has_quads: bool,
    inputs: Vec<Input>,
    varyings: Vec<Packet<u32>>,
    /// Packets of the varyings that are there.
    given_varyings: usize,
    uniforms: Vec<u32>,
    /// The number of each lane.
    index: Vec<Packet<u32>>,
    /// A varying that is the same in all lanes.
    flat: Option<u32>,
    cover: Vec<u16>,
    facing: Vec<u16>,
    is_cover_shared: bool,
    /// The bytes of each buffer.
    bytes: [usize; 2],
    read: Vec<u32>,
    is_read_shared: bool,
    /// The inputs, outputs and buffers that are given; the rest is missing.
    given: [usize; 3],
    /// The packets of each output that are there.
    given_outputs: [usize; OUTPUTS as usize],
}

/// What a run leaves.
#[derive(Debug, PartialEq)]
pub(super) struct Left {
    pub(super) result: Result<(), Stopped>,
    outputs: Vec<Vec<Packet<u32>>>,
    cover: Vec<u16>,
    written: Vec<u32>,
    /// What was stored to textures, in order.
    stored: u64,
}

/// Textures whose texels are functions of what is asked.
#[derive(Debug, Default)]
struct Told {
    stored: Cell<u64>,
}

fn mix(a: u32, b: u32) -> u32 {
    (a ^ b).wrapping_mul(0x9E37_79B1).rotate_left(13)
}

impl Textures for Told {
    fn access(&self, mut access: TextureAccess<'_>) {
        let op = access.op;
        let mut operands: Vec<&[Packet<u32>]> = (0..op.coordinates.len())
            .map(|at| access.coordinate(at))
            .collect();
        let others = [
            access.layer(),
            access.level_of_detail(),
            access.gradient(0, 0),
            access.gradient(1, 1),
            access.reference(),
            access.sample(),
        ];
        operands.extend(others.into_iter().flatten());
        operands.extend((0..op.stored.len()).map(|at| access.stored(at)));
        for packet in 0..access.packets {
            let mask = access.mask[packet];
            for lane in (0..LANES).filter(|lane| mask >> lane & 1 == 1) {
                let words = operands.iter().map(|words| words[packet].0[lane]);
                let texel = words.fold(1, mix);
                if op.stored.is_empty() {
                    for (at, salt) in (0..access.results()).zip(0..) {
                        access.result_mut(at)[packet].0[lane] = mix(texel, salt);
                    }
                } else {
                    let before = self.stored.get().rotate_left(5);
                    self.stored.set(before.wrapping_mul(3) ^ u64::from(texel));
                }
            }
        }
    }
}

/// The numbers of the lanes of a packet.
fn numbers(packet: usize) -> Packet<u32> {
    let number = |lane| u32::try_from(packet * LANES + lane).unwrap_or(0);
    Packet(std::array::from_fn(number))
}

fn word(random: &mut Rng) -> u32 {
    match random.u32(0..5) {
        0 | 1 => random.u32(0..9),
        2 | 3 => (random.f32() * 8.0 - 4.0).to_bits(),
        // No NaN with a payload: operations on words may see it.
        _ => random.u32(..) & !(1 << 23),
    }
}

impl Case {
    pub(super) fn new(random: &mut Rng, kernel: &Kernel) -> Self {
        let packets = random.usize(1..5);
        let masks = |random: &mut Rng| {
            let mask = |random: &mut Rng| match random.u32(0..4) {
                0 | 1 => u16::MAX,
                2 => 0,
                _ => random.u16(..),
            };
            (0..packets).map(|_| mask(random)).collect::<Vec<u16>>()
        };
        let some = |random: &mut Rng, all: usize| match random.u32(0..8) {
            0 => random.usize(0..=all),
            _ => all,
        };
        let all_inputs = kernel.interface.inputs.len();
        let varyings = packets * VARYINGS as usize;
        Self {
            packets,
            has_quads: kernel.stage == Stage::Fragment,
            inputs: kernel.interface.inputs.clone(),
            varyings: (0..varyings)
                .map(|_| Packet([(); LANES].map(|()| word(random))))
                .collect(),
            given_varyings: some(random, varyings),
            index: (0..packets).map(numbers).collect(),
            uniforms: (0..UNIFORMS).map(|_| word(random)).collect(),
            flat: random.bool().then(|| word(random)),
            cover: masks(random),
            facing: masks(random),
            is_cover_shared: random.bool(),
            bytes: [0; 2].map(|_| some(random, 96)),
            read: (0..24).map(|_| word(random)).collect(),
            is_read_shared: random.bool(),
            given: [all_inputs, OUTPUTS as usize + 1, 2].map(|all| some(random, all)),
            given_outputs: [0; OUTPUTS as usize].map(|_| some(random, packets)),
        }
    }

    /// Runs the case.
    pub(super) fn run(&self, go: &mut dyn FnMut(&Run<'_>) -> Result<(), Stopped>) -> Left {
        let mut cover = self.cover.clone();
        let cover = cells(&mut cover);
        let varyings = &self.varyings[..self.given_varyings];
        let input = |input: &Input| match *input {
            Input::Varying(0) if self.flat.is_some() => {
                InputData::Uniform(self.flat.unwrap_or_default())
            }
            Input::Varying(at) => InputData::words(varyings, at as usize, VARYINGS as usize),
            Input::PushConstant(at) => InputData::Uniform(self.uniforms[at as usize]),
            Input::LocalInvocationIndex => InputData::words(&self.index, 0, 1),
            Input::Cover if self.is_cover_shared => InputData::SharedMask(cover),
            Input::Cover => InputData::Mask(&self.cover),
            _ => InputData::Mask(&self.facing),
        };
        let inputs: Vec<InputData<'_>> = self.inputs.iter().map(input).collect();
        let written: Vec<AtomicU32> = (0..24).map(AtomicU32::new).collect();
        let read: Vec<AtomicU32> = self.read.iter().copied().map(AtomicU32::new).collect();
        let textures = Told::default();
        let mut outputs: Vec<Vec<Packet<u32>>> = self
            .given_outputs
            .map(|packets| vec![Packet([5; LANES]); packets])
            .to_vec();
        let result = {
            let words = outputs.iter_mut().map(|words| cells(words));
            let mut data: Vec<OutputData<'_>> =
                words.map(|words| OutputData::words(words, 0, 1)).collect();
            data.push(OutputData::Mask(cover));
            let [inputs_given, outputs_given, buffers_given] = self.given;
            let read_only = if self.is_read_shared {
                Buffer::shared(&read, self.bytes[0])
            } else {
                Buffer::read_only(&self.read, self.bytes[0])
            };
            let buffers = [read_only, Buffer::shared(&written, self.bytes[1])];
            go(&Run {
                inputs: &inputs[..inputs_given],
                outputs: &data[..outputs_given],
                buffers: &buffers[..buffers_given],
                textures: &textures,
                budget: BUDGET,
                ..Run::new(self.packets)
            })
        };
        Left {
            result,
            outputs,
            cover: cover.iter().map(Cell::get).collect(),
            written: written
                .iter()
                .map(|word| word.load(Ordering::Relaxed))
                .collect(),
            stored: textures.stored.get(),
        }
    }

    /// The lanes of a packet that run.
    fn running(&self, packet: usize) -> u16 {
        let at = self.inputs.iter().position(|input| *input == Input::Cover);
        if at.is_none_or(|at| at >= self.given[0]) {
            return 0;
        }
        let cover = self.cover[packet];
        if !self.has_quads {
            return cover;
        }
        (0..4).fold(0, |running, quad| match cover >> (quad * 4) & 15 {
            0 => running,
            _ => running | 15 << (quad * 4),
        })
    }

    /// What differs between two runs where it counts.
    pub(super) fn difference(&self, wanted: &Left, got: &Left) -> Option<String> {
        if wanted.result != got.result {
            return Some(format!("{:?}, not {:?}", got.result, wanted.result));
        }
        if wanted.written != got.written {
            let (got, wanted) = (&got.written, &wanted.written);
            return Some(format!("memory {got:x?}, not {wanted:x?}"));
        }
        if wanted.stored != got.stored {
            return Some("stores to textures".to_owned());
        }
        for packet in 0..self.packets {
            let running = self.running(packet);
            let [left, right] = [wanted, got].map(|left| left.cover[packet] & running);
            if left != right {
                return Some(format!("cover {right:x}, not {left:x} of packet {packet}"));
            }
            for (at, (wanted, got)) in wanted.outputs.iter().zip(&got.outputs).enumerate() {
                let both = wanted.get(packet).zip(got.get(packet));
                let Some((wanted, got)) = both else { continue };
                for lane in (0..LANES).filter(|lane| running >> lane & 1 == 1) {
                    let (wanted, got) = (wanted.0[lane], got.0[lane]);
                    if wanted != got {
                        return Some(format!(
                            "output {at} of packet {packet}, lane {lane}: {got:x}, not {wanted:x}"
                        ));
                    }
                }
            }
        }
        None
    }
}
