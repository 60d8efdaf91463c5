//! `mandelbrot_compute`: the Mandelbrot set by a dispatch that writes the picture as a storage
//! texture, in work-groups of 8 × 8, with at most 256 iterations a pixel. The set lies between
//! −2.25 and 1 along the width.

use super::Scene;
use super::passes::{Binding, ComputeStep, Frame, PICTURE, Step};
use crate::frame::FrameSize;
use estampe::TextureFormat;

pub(super) fn scene(size: FrameSize) -> Scene {
    let text = include_str!("wgsl/mandelbrot_compute.wgsl");
    let mut frame = Frame::new(size, TextureFormat::Rgba8Unorm, text);
    frame.steps.push(Step::Dispatch(ComputeStep {
        entry_point: "iterate",
        bindings: vec![Binding::StorageImage(PICTURE)],
        workgroups: [size.width.div_ceil(8), size.height.div_ceil(8), 1],
    }));
    Scene::of_frame("mandelbrot_compute", Vec::new(), Vec::new(), frame)
}
