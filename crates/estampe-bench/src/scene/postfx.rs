//! `postfx`: bloom and blur in 15 passes over images of RGBA16F, without depth.
//!
//! A city at night is drawn in one draw of 750 quads. What is brighter than 1 goes into an image of
//! the frame's size, which is halved five times and added back up; the city is blurred by a
//! Gaussian of nine texels along x, then y. The last pass mixes the city with its blur by the
//! distance from the centre, adds the bloom and maps the sum to the picture, BGRA8. Samplers are
//! linear and clamped. A vertex has a position (2 floats) and a colour (4): 24 bytes.

use super::passes::{Binding, ColorTarget, Frame, FrameDraw, FramePipeline, PICTURE, Pass, Step};
use super::{Scene, vertex_layout};
use crate::frame::FrameSize;
use crate::generate::{LittleEndian, Vector, quad_indices, unit_hash};
use estampe::state::BlendState;
use estampe::{TextureFormat, VertexFormat};

const HOUSES: u32 = 48;
const LIGHTS: u32 = 700;
/// The bloom's images, each half as large as the one before.
const BLOOM_LEVELS: usize = 6;

pub(super) fn scene(size: FrameSize) -> Scene {
    let text = include_str!("wgsl/postfx.wgsl");
    let mut frame = Frame::new(size, TextureFormat::Bgra8Unorm, text);
    let [width, height] = [size.width, size.height];
    let format = TextureFormat::Rgba16Float;
    let city = frame.image(format, [width, height]);
    let bloom: [usize; BLOOM_LEVELS] = std::array::from_fn(|level| {
        let halved = |side: u32| (side >> level).max(1);
        frame.image(format, [halved(width), halved(height)])
    });
    let blurred = [0; 2].map(|_| frame.image(format, [width, height]));
    let pipeline = frame.pipeline(FramePipeline {
        vertex: "city_vertex",
        fragment: "city_fragment",
        vertex_buffers: vec![vertex_layout(
            24,
            &[(VertexFormat::Float32x2, 0), (VertexFormat::Float32x4, 8)],
        )],
        ..FramePipeline::default()
    });
    let quads = 2 + HOUSES + LIGHTS;
    frame.steps.push(Step::Pass(Pass {
        colors: vec![ColorTarget::cleared(city, [0.0; 4])],
        depth: None,
        draws: vec![FrameDraw::indexed(pipeline, 0, 1, quads * 6)],
    }));
    let mut effect = |fragment: &'static str, from: &[usize], into: usize| {
        let mut bindings = vec![Binding::trilinear_clamp()];
        bindings.extend(from.iter().map(|&image| Binding::Image(image)));
        let pipeline = frame.pipeline(FramePipeline {
            vertex: "screen_vertex",
            fragment,
            blend: (fragment == "upsample").then_some(BlendState::ADDITIVE),
            bindings,
            ..FramePipeline::default()
        });
        frame.screen_pass(pipeline, into);
    };
    effect("threshold", &[city], bloom[0]);
    for level in 1..BLOOM_LEVELS {
        effect("downsample", &[bloom[level - 1]], bloom[level]);
    }
    for level in (1..BLOOM_LEVELS).rev() {
        effect("upsample", &[bloom[level]], bloom[level - 1]);
    }
    effect("blur_x", &[city], blurred[0]);
    effect("blur_y", &[blurred[0]], blurred[1]);
    effect("combine", &[city, blurred[1], bloom[0]], PICTURE);
    Scene::of_frame(
        "postfx",
        vec![vertices(), quad_indices(quads)],
        Vec::new(),
        frame,
    )
}

/// Sky, street, houses and lights.
fn vertices() -> Vec<u8> {
    let mut bytes = LittleEndian::default();
    let sky = [[0.10, 0.06, 0.12], [0.01, 0.02, 0.06]];
    append_quad(&mut bytes, [-1.0, -0.1, 1.0, 1.0], sky);
    let street = [[0.02, 0.02, 0.03], [0.05, 0.04, 0.05]];
    append_quad(&mut bytes, [-1.0, -1.0, 1.0, -0.1], street);
    for house in 0..HOUSES {
        let random = |k: u32| unit_hash(10_000 + 4 * house + k);
        let left = -1.1 + f64::from(house) * 2.2 / f64::from(HOUSES);
        let right = left + 0.05 + 0.06 * random(0);
        let color = [0.015, 0.015 + 0.02 * random(2), 0.03];
        let top = -0.1 + 0.9 * random(1);
        append_quad(&mut bytes, [left, -0.6, right, top], [color; 2]);
    }
    for light in 0..LIGHTS {
        let random = |k: u32| unit_hash(11_000 + 8 * light + k);
        let (x, y) = (2.0 * random(0) - 1.0, 1.5 * random(1) - 0.9);
        let intensity = 0.3 + 12.0 * random(6) * random(6) * random(6) * random(6);
        let green = (0.5 + 0.5 * random(4)) * intensity;
        let blue = (0.2 + 0.7 * random(5)) * intensity;
        let right = x + 0.006 + 0.008 * random(2);
        let top = y + 0.01 + 0.014 * random(3);
        append_quad(
            &mut bytes,
            [x, y, right, top],
            [[intensity, green, blue]; 2],
        );
    }
    bytes.into_bytes()
}

/// A quad in normalised device coordinates with a colour below and one above.
fn append_quad(
    bytes: &mut LittleEndian,
    [left, bottom, right, top]: [f64; 4],
    [below, above]: [Vector; 2],
) {
    for (x, y, [red, green, blue]) in [
        (left, bottom, below),
        (right, bottom, below),
        (right, top, above),
        (left, top, above),
    ] {
        bytes.reals(&[x, y, red, green, blue, 1.0]);
    }
}
