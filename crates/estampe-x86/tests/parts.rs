//! Inputs and outputs that are parts of a run's data: as if each were given by itself, in machine
//! code and in the interpreter.
#![cfg(target_arch = "x86_64")]

use estampe_ir::interpreter::{self, InputData, OutputData, Part, Run, cells};
use estampe_ir::text;
use estampe_simd::{LANES, Level, Packet};
use estampe_x86::{Code, Isa, Scratch, Tier};

const KERNEL: &str = "
kernel fragment
input varying(0)
input varying(1)
input push_constant(0)
input cover
input varying(2)
output color(0, 0)
output color(0, 1)
output depth
output cover
b0:
  v0 = input 0
  v1 = input 1
  uv2 = input 2
  m3 = input_mask 3
  v4 = input 4
  v5 = add v0, uv2
  v6 = xor v1, v5
  v7 = mul v4, v0
  uv8 = const 100
  m9 = ult v0, uv8
  m10 = mand m3, m9
  return v5, v6, v7, m10
";

/// The results of a run: the words of two outputs and of a third, and masks.
type Left = ([Vec<Packet<u32>>; 2], Vec<u16>);

/// The parts of three scalars of a packet, of two words, and of a mask.
const INPUTS: [Part; 5] = [
    Part { data: 0, first: 2 },
    Part { data: 0, first: 0 },
    Part { data: 1, first: 1 },
    Part { data: 2, first: 0 },
    Part { data: 0, first: 1 },
];
const OUTPUTS: [Part; 4] = [
    Part { data: 0, first: 1 },
    Part { data: 0, first: 0 },
    Part::NONE,
    Part { data: 2, first: 0 },
];

/// Runs so many packets with slices of these lengths; by parts, or each input and output by itself.
fn left(
    packets: usize,
    [given, room]: [usize; 2],
    by_parts: bool,
    go: &mut dyn FnMut(&Run<'_>),
) -> Left {
    let mut random = fastrand::Rng::with_seed(7);
    let mut scalars = vec![Packet([0; LANES]); given];
    for packet in &mut scalars {
        packet.0.fill_with(|| random.u32(..200));
    }
    let covers: Vec<u16> = (0..packets).map(|_| random.u16(..)).collect();
    let mut words = [room, room].map(|len| vec![Packet([7; LANES]); len]);
    let mut masks = vec![0x5555; packets];
    let [first, second] = &mut words;
    let (first, second, mask) = (cells(first), cells(second), cells(&mut masks));
    let outputs = [
        OutputData::words(first, 0, 2),
        OutputData::words(second, 0, 1),
        OutputData::Mask(mask),
    ];
    let inputs = [
        InputData::words(&scalars, 0, 3),
        InputData::UniformWords(&[3, 1 << 31, 9]),
        InputData::Mask(&covers),
    ];
    if by_parts {
        go(&Run {
            inputs: &inputs,
            input_parts: &INPUTS,
            outputs: &outputs,
            output_parts: &OUTPUTS,
            ..Run::new(packets)
        });
    } else {
        go(&Run {
            inputs: &[
                InputData::words(&scalars, 2, 3),
                InputData::words(&scalars, 0, 3),
                InputData::Uniform(1 << 31),
                InputData::Mask(&covers),
                InputData::words(&scalars, 1, 3),
            ],
            outputs: &[
                OutputData::words(first, 1, 2),
                OutputData::words(first, 0, 2),
                OutputData::Dropped,
                OutputData::Mask(mask),
            ],
            ..Run::new(packets)
        });
    }
    (words, masks)
}

#[test]
fn parts_are_what_slices_of_their_own_would_be() {
    let kernel = text::kernel(KERNEL).unwrap();
    let definition = interpreter::Code::new(&kernel);
    let available = Isa::ALL.into_iter().filter(|isa| isa.is_available());
    let tiers = |isa| [Tier::Fast, Tier::Optimised].map(|tier| (isa, tier));
    let codes = available.flat_map(tiers);
    let codes: Vec<Code> = codes
        .map(|(isa, tier)| Code::compile(&kernel, isa, tier).unwrap())
        .collect();
    for packets in [1, 2, 5, 16] {
        // All packets have a place, or the last ones of some parts have none, or all of a part.
        for given in [packets * 3, packets * 3 - 1, packets * 2, 2, 1, 0] {
            for room in [packets * 2, packets * 2 - 1, packets, 1, 0] {
                let lens = [given, room];
                let mut interpret = |run: &Run<'_>| {
                    let mut registers = interpreter::Scratch::default();
                    definition.run(Level::best(), run, &mut registers).unwrap();
                };
                let wanted = left(packets, lens, false, &mut interpret);
                assert_eq!(
                    left(packets, lens, true, &mut interpret),
                    wanted,
                    "{lens:?}"
                );
                for code in &codes {
                    let mut scratch = Scratch::default();
                    for by_parts in [false, true] {
                        let found = left(packets, lens, by_parts, &mut |run| {
                            code.run(Level::best(), run, &mut scratch).unwrap();
                        });
                        assert_eq!(found, wanted, "{:?} {packets} {lens:?}", code.isa());
                    }
                }
            }
        }
    }
}

const ALL_IN_MEMORY: &str = "
kernel fragment
input varying(0)
input varying(1)
input cover
output color(0, 0)
output depth
output cover
b0:
  v0 = input 0
  v1 = input 1
  m2 = input_mask 2
  v3 = mul v0, v0
  v4 = add v3, v1
  uv5 = const 3000
  m6 = ult v4, uv5
  m7 = mand m2, m6
  return v4, v1, m7
";

/// Runs one after the other whose data are in the same memory, or elsewhere, or other parts of
/// them, with other numbers of packets, some without a place, with another code between them.
#[test]
fn runs_in_the_same_memory_give_their_own_results() {
    let kernel = text::kernel(ALL_IN_MEMORY).unwrap();
    let definition = interpreter::Code::new(&kernel);
    let mut random = fastrand::Rng::with_seed(8);
    for isa in Isa::ALL.into_iter().filter(|isa| isa.is_available()) {
        for tier in [Tier::Fast, Tier::Optimised] {
            let codes = [(); 2].map(|()| Code::compile(&kernel, isa, tier).unwrap());
            let mut scratch = Scratch::default();
            let mut memories = [(); 2].map(|()| vec![Packet([0; LANES]); 16 * 2]);
            let mut results = [(); 2].map(|()| vec![Packet([0; LANES]); 16]);
            let mut masks = [[0; 16]; 2];
            // A random number below `of` is 0 as often as not, so that runs follow like ones.
            let turn = |random: &mut fastrand::Rng, of: usize| random.usize(..2 * of).min(of) % of;
            for round in 0..400 {
                let packets = 16 - turn(&mut random, 16);
                let scalars = &mut memories[turn(&mut random, 2)];
                for packet in &mut *scalars {
                    packet.0.fill_with(|| random.u32(..100));
                }
                masks[0].fill_with(|| random.u16(..));
                masks[1] = masks[0];
                // Of every twentieth run the last packets have no place.
                let missing = if random.u8(..20) == 0 {
                    random.usize(..=packets * 2)
                } else {
                    0
                };
                let scalars = &scalars[..packets * 2 - missing];
                let parts = [[0, 1], [1, 0]][turn(&mut random, 2)];
                let part = |data, first| Part { data, first };
                let parts = [part(0, parts[0]), part(0, parts[1]), part(1, 0)];
                let code = &codes[turn(&mut random, 4) / 3];
                let [of_code, of_definition] = &mut masks;
                let [found, wanted] = &mut results;
                let mut go = |to: &mut Vec<Packet<u32>>, mask: &mut [u16], is_code: bool| {
                    let mask = cells(&mut mask[..packets]);
                    let run = Run {
                        inputs: &[InputData::words(scalars, 0, 2), InputData::SharedMask(mask)],
                        input_parts: &parts,
                        outputs: &[
                            OutputData::words(cells(to), 0, 1),
                            OutputData::Dropped,
                            OutputData::Mask(mask),
                        ],
                        ..Run::new(packets)
                    };
                    if is_code {
                        code.run(Level::best(), &run, &mut scratch).unwrap();
                    } else {
                        let mut registers = interpreter::Scratch::default();
                        definition.run(Level::best(), &run, &mut registers).unwrap();
                    }
                };
                go(found, of_code, true);
                go(wanted, of_definition, false);
                assert_eq!(found[..packets], wanted[..packets], "{isa:?} {round}");
                assert_eq!(masks[0], masks[1], "{isa:?} {round}");
            }
        }
    }
}
