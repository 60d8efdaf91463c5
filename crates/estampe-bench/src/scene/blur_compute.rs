//! `blur_compute`: a separable blur with a radius of 15 texels, by two dispatches.
//!
//! A work-group of 64 invocations loads a tile of 256 × 1 texels (rows), or 8 × 32 (columns), and
//! the 15 on either side, clamped to the picture, into its memory, waits at a barrier, and writes
//! four texels an invocation. Weight k, of 0 to 15, is (256 − k²)² over the sum of all 31; the
//! uniform has the 16 of them.

use super::passes::{Binding, ComputeStep, Frame, PICTURE, Step};
use super::{Detail, Scene};
use crate::frame::FrameSize;
use crate::generate::{LittleEndian, diffuse_texture};
use estampe::{TextureFormat, ViewDimension};

/// The texels on either side that count.
const RADIUS: i32 = 15;

pub(super) fn scene(detail: Detail, size: FrameSize) -> Scene {
    let text = include_str!("wgsl/blur_compute.wgsl");
    let mut frame = Frame::new(size, TextureFormat::Rgba8Unorm, text);
    frame.textures = vec![(TextureFormat::Rgba8Unorm, ViewDimension::D2)];
    let [width, height] = [size.width, size.height];
    let rows = frame.image(TextureFormat::Rgba8Unorm, [width, height]);
    let step = |entry_point, from, to, workgroups| {
        Step::Dispatch(ComputeStep {
            entry_point,
            bindings: vec![Binding::Uniform(0), from, Binding::StorageImage(to)],
            workgroups,
        })
    };
    let of_rows = [width.div_ceil(256), height, 1];
    let of_columns = [width.div_ceil(8), height.div_ceil(32), 1];
    frame.steps = vec![
        step("blur_rows", Binding::Texture(0), rows, of_rows),
        step("blur_columns", Binding::Image(rows), PICTURE, of_columns),
    ];
    let mut texture = diffuse_texture(detail.of(2048, 256), 23);
    texture.levels.truncate(1);
    Scene::of_frame("blur_compute", vec![weights()], vec![texture], frame)
}

fn weights() -> Vec<u8> {
    let weight = |k: i32| f64::from((256 - k * k) * (256 - k * k));
    let sum: f64 = (-RADIUS..=RADIUS).map(weight).sum();
    let mut bytes = LittleEndian::default();
    for k in 0..=RADIUS {
        bytes.reals(&[weight(k) / sum]);
    }
    bytes.into_bytes()
}
