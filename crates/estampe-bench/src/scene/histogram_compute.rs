//! `histogram_compute`: 256 bins over 2048 × 2048 integers, their running sums, and a picture of
//! both, by four dispatches. All numbers are integers, so the picture is exact.
//!
//! The bins are cleared; 1,024 work-groups of 256 count 16 integers an invocation into the memory
//! of the work-group, by atomic operations, and add what they have to the bins; one work-group
//! makes the running sums, in eight steps with barriers, and finds the largest bin; and the picture
//! is painted, a storage texture. An integer's bin is its upper byte.

use super::passes::{Binding, ComputeStep, Frame, PICTURE, Step};
use super::{Detail, Scene};
use crate::frame::FrameSize;
use crate::generate::{LittleEndian, hash32};
use estampe::TextureFormat;

/// The integers that a work-group counts.
const OF_WORKGROUP: u32 = 256 * 16;
/// The words of the bins, their sums and the largest bin.
const RESULT_WORDS: usize = 256 + 256 + 1;

pub(super) fn scene(detail: Detail, size: FrameSize) -> Scene {
    let count = detail.of(2048 * 2048, OF_WORKGROUP * 8);
    let text = include_str!("wgsl/histogram_compute.wgsl");
    let mut frame = Frame::new(size, TextureFormat::Rgba8Unorm, text);
    let step = |entry_point, first, workgroups| {
        Step::Dispatch(ComputeStep {
            entry_point,
            bindings: vec![first, Binding::Storage(1)],
            workgroups,
        })
    };
    let values = Binding::StorageRead(0);
    let of_picture = [size.width.div_ceil(8), size.height.div_ceil(8), 1];
    frame.steps = vec![
        step("clear", values, [1; 3]),
        step("count", values, [count / OF_WORKGROUP, 1, 1]),
        step("sum", values, [1; 3]),
        step("paint", Binding::StorageImage(PICTURE), of_picture),
    ];
    let buffers = vec![integers(count), vec![0; RESULT_WORDS * 4]];
    Scene::of_frame("histogram_compute", buffers, Vec::new(), frame)
}

/// The upper byte is the mean of the three below, so that the middle bins have most.
fn integers(count: u32) -> Vec<u8> {
    let mut bytes = LittleEndian::with_capacity(count as usize * 4);
    for at in 0..count {
        let random = hash32(at + 18_000);
        let mean = ((random & 255) + (random >> 8 & 255) + (random >> 16 & 255)) / 3;
        bytes.words(&[mean << 24 | random & 0xFF_FFFF]);
    }
    bytes.into_bytes()
}
