//! Textures that are sampled at varyings: where their level of detail comes from.

mod alpha;
mod comparisons;
mod filters;
mod linking;
mod nondependent;
mod pixel_loads;
mod rewriting;
mod running;

use estampe_shader::front::{Options, Source, load};
use estampe_shader::lower::lower;
use estampe_shader::program::{StageSource, TextProgram};

/// Textures of every dimension, and varyings of every kind, which a fragment shader reads.
const FRAGMENT: &str = "
@group(0) @binding(0) var s: sampler;
@group(0) @binding(1) var map: texture_2d<f32>;
@group(0) @binding(2) var other: texture_2d<f32>;
@group(0) @binding(3) var third: texture_2d<f32>;
@group(0) @binding(4) var layers: texture_2d_array<f32>;
@group(0) @binding(5) var sky: texture_cube<f32>;
@group(0) @binding(6) var volume: texture_3d<f32>;
@group(0) @binding(7) var line: texture_1d<f32>;
@group(0) @binding(8) var depths: texture_depth_2d;
@group(0) @binding(9) var compared: sampler_comparison;
@group(0) @binding(10) var halves: texture_2d<f32>;
@group(0) @binding(11) var<uniform> numbers: vec4f;
struct Varyings {
    @location(0) uv: vec2f,
    @location(1) direction: vec3f,
    @location(2) @interpolate(linear) on_screen: vec2f,
    @location(3) @interpolate(flat) layer: i32,
    @location(4) @interpolate(perspective, centroid) inside: vec2f,
    @location(5) @interpolate(perspective, sample) of_sample: vec2f,
}
";

/// The vertex shader that writes those varyings: zeros.
const VERTEX: &str = "
struct Out {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
    @location(1) direction: vec3f,
    @location(2) @interpolate(linear) on_screen: vec2f,
    @location(3) @interpolate(flat) layer: i32,
    @location(4) @interpolate(perspective, centroid) inside: vec2f,
    @location(5) @interpolate(perspective, sample) of_sample: vec2f,
}
@vertex fn v() -> Out { return Out(); }
";

/// The entry points of a text in WGSL, in order.
fn entry_points(text: &str) -> Vec<StageSource> {
    let module = load(Source::Wgsl(text), &Options::default());
    let module = module.unwrap_or_else(|errors| panic!("{errors}"));
    let lowered = |at| lower(&module.module, &module.info, at);
    (0..module.entry_points.len())
        .map(|at| lowered(at).unwrap_or_else(|error| panic!("{error}")))
        .collect()
}

/// A fragment shader of these statements, which read `in` and return a colour.
fn fragment(statements: &str) -> StageSource {
    let text =
        format!("{FRAGMENT}@fragment fn f(in: Varyings) -> @location(0) vec4f {{ {statements} }}");
    entry_points(&text).remove(0)
}

/// The program of a fragment shader of these statements.
fn program(statements: &str) -> TextProgram {
    program_of(&fragment(statements))
}

/// The program of a fragment shader.
fn program_of(fragment: &StageSource) -> TextProgram {
    let vertex = entry_points(VERTEX).remove(0);
    let made = TextProgram::new(&vertex, Some(fragment), 1 << 20);
    made.unwrap_or_else(|error| panic!("{error}"))
}
