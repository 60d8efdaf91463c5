//! Random sequences of copies, clears, mip levels, blits and small render passes: the public
//! interface against the oracle's plain textures, byte for byte.
//!
//! A texture of `estampe` keeps its texels in tiles and in rows, and converts between them when it
//! changes its role; the oracle has rows alone. A [`Sequence`] changes the roles of a few textures
//! in a random order, at random levels, layers and depths. After it, every byte of every texture,
//! buffer and held view is compared.
//!
//! ```text
//!   seed ─▶ random_textures ─▶ random_operations ─┬▶ on_model ──┐
//!                              random_passes      │             ├▶ equal, or a shorter sequence
//!                                                 └▶ on_device ─┘
//!                                                       reached: what the sequences had
//! ```

mod held;
pub mod on_device;
pub mod on_model;
mod random_operations;
mod random_passes;
mod random_textures;
pub mod reached;
pub mod roles;
pub mod sequence;

use crate::Random;
use crate::fast_path::{self, all_devices, devices_of_seed};
use estampe::Device;
use estampe_reference::transfer::copy::read_sample;
use estampe_types::TextureAspect;
use held::compare_held;
use on_device::Objects;
use on_model::{Model, Outcome};
use reached::Reached;
use sequence::Sequence;
use std::fmt::Write;

/// Executes `count` random sequences of a topic on the oracle and on devices of every SIMD level
/// with 1, 2 and 7 threads. Returns what they reached.
///
/// # Panics
/// If a byte or an outcome differs; the message has the seed and a shorter sequence that differs
/// too.
#[must_use]
pub fn check(topic: &str, count: u64) -> Reached {
    let number = |name: &str| std::env::var(name).ok()?.parse::<u64>().ok();
    let factor = number("ESTAMPE_TEST_FACTOR");
    let seeds = match number("ESTAMPE_TEST_SEED") {
        Some(seed) => seed..seed + 1,
        None => 0..count * factor.unwrap_or(1),
    };
    let mut reached = Reached::default();
    for seed in seeds {
        let sequence = Sequence::random(&mut Random::new(topic, seed), seed);
        let expected = Expected::of(&sequence);
        let devices = match factor {
            Some(_) => all_devices(),
            None => devices_of_seed(seed),
        };
        for device in devices {
            if let Err(difference) = compare(&sequence, &expected, device) {
                let name = fast_path::name(device);
                let (short, difference) = shortened(sequence, device, difference);
                let words = described(&short);
                panic!("{topic}, seed {seed}, {name}: {difference}{words}");
            }
        }
        reached.count(&sequence, &expected.outcomes);
    }
    reached
}

/// The oracle's results of a sequence.
struct Expected {
    outcomes: Vec<Outcome>,
    model: Model,
}

impl Expected {
    fn of(sequence: &Sequence) -> Self {
        let mut model = Model::new(sequence);
        let operations = sequence.operations.iter();
        Self {
            outcomes: operations.map(|operation| model.apply(operation)).collect(),
            model,
        }
    }
}

/// Executes a sequence on a device. An error describes the first difference.
fn compare(sequence: &Sequence, expected: &Expected, device: &Device) -> Result<(), String> {
    let mut objects = Objects::new(device, sequence);
    let operations = sequence.operations.iter().zip(&expected.outcomes);
    for (number, (operation, wanted)) in operations.enumerate() {
        let got = objects.apply(operation);
        if got != *wanted {
            let told = |outcome: &Outcome| match outcome {
                Outcome::Read(bytes) => format!("{} bytes", bytes.len()),
                other => format!("{other:?}"),
            };
            return Err(format!(
                "operation {number}: {}, the oracle {}",
                told(&got),
                told(wanted)
            ));
        }
    }
    compare_held(objects.held(), &expected.model.held)?;
    for (number, texture) in expected.model.textures.iter().enumerate() {
        let mut read = objects.read_texture(number).into_iter();
        for (level, images) in texture.levels.iter().enumerate() {
            for (slice, image) in images.iter().enumerate() {
                for sample in 0..texture.samples {
                    let place = [level, slice].map(|at| u32::try_from(at).expect("a few"));
                    let wanted = match texture.samples {
                        1 => image.rows.concat(),
                        _ => read_sample(texture, place, (TextureAspect::All, sample)),
                    };
                    let got = read.next().expect("every sample is read");
                    if let Some(at) = first_difference(&got, &wanted) {
                        let each = texture.format.block_bytes() as usize;
                        let texel = at / each;
                        let columns = texture.blocks_of(image.size)[0] as usize;
                        let bytes = |bytes: &[u8]| bytes[texel * each..][..each].to_vec();
                        return Err(format!(
                            "texture {number} ({}), level {level}, slice {slice}, sample {sample}, column {}, row {}: \
                             {:02x?}, the oracle {:02x?}",
                            texture.format.name(),
                            texel % columns,
                            texel / columns,
                            bytes(&got),
                            bytes(&wanted),
                        ));
                    }
                }
            }
        }
    }
    for (number, wanted) in expected.model.buffers.iter().enumerate() {
        let got = objects.read_buffer(number);
        if let Some(at) = first_difference(&got, wanted) {
            return Err(format!(
                "buffer {number}, byte {at}: {}, the oracle {}",
                got[at], wanted[at]
            ));
        }
    }
    Ok(())
}

fn first_difference(got: &[u8], wanted: &[u8]) -> Option<usize> {
    assert_eq!(got.len(), wanted.len(), "as many bytes");
    got.iter()
        .zip(wanted)
        .position(|(got, wanted)| got != wanted)
}

/// A sequence as text, one texture or operation a line.
fn described(sequence: &Sequence) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    for (number, texture) in sequence.textures.iter().enumerate() {
        let _ = write!(text, "\n  texture {number}: {texture:?}");
    }
    for (number, operation) in sequence.operations.iter().enumerate() {
        let _ = write!(text, "\n  operation {number}: {operation:?}");
    }
    text
}

/// The shortest sequence found that still differs, by leaving out operations and draws.
fn shortened(mut sequence: Sequence, device: &Device, mut how: String) -> (Sequence, String) {
    'again: loop {
        for shorter in shorter_sequences(&sequence) {
            let expected = Expected::of(&shorter);
            if let Err(difference) = compare(&shorter, &expected, device) {
                (sequence, how) = (shorter, difference);
                continue 'again;
            }
        }
        return (sequence, how);
    }
}

fn shorter_sequences(sequence: &Sequence) -> Vec<Sequence> {
    let mut shorter = Vec::new();
    for removed in (0..sequence.operations.len()).rev() {
        let mut without = sequence.clone();
        let operation = without.operations.remove(removed);
        shorter.push(without);
        let sequence::Operation::Render(pass) = operation else {
            continue;
        };
        let mut with = |pass: sequence::Pass| {
            let mut changed = sequence.clone();
            changed.operations[removed] = sequence::Operation::Render(pass);
            shorter.push(changed);
        };
        if let sequence::Draws::Cases(draws) = &pass.draws {
            for draw in 0..draws.len() {
                let mut fewer = draws.clone();
                fewer.remove(draw);
                with(sequence::Pass {
                    draws: sequence::Draws::Cases(fewer),
                    ..pass.clone()
                });
            }
        }
    }
    shorter
}
