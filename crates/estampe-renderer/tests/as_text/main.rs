//! The materials as text: each in WGSL and in GLSL gives the bytes of its form in Rust.
//!
//! ```text
//! material ─┬─ in Rust ───────────────┬─ scene ─▶ colours (f32) and depths, compared bit by bit
//!           └─ in WGSL, in GLSL ──────┘            at every level, by machine code and interpreted
//! ```
//!
//! | module | contents |
//! |---|---|
//! | [`surfaces`] | the composed shader of surfaces, part by part |
//! | [`physical`] | physically based surfaces |
//! | [`views`] | inspection, wireframes, points and lines |
//! | [`uniforms`] | the numbers that Rust has in fields, by their names in the texts |
//! | [`scene`] | the teapot, a textured square, and a cloud of triangles |
//! | [`drawing`] | pipelines, bind groups and pictures |
//!
//! The texts are written as people write them, with `normalize`, `reflect`, `mix`, `pow` and the
//! other functions of the languages, not with those of the renderer taken apart. Choices that Rust
//! has in fields are pipeline-overridable constants in WGSL and macros in GLSL.

mod drawing;
mod physical;
mod scene;
mod surfaces;
mod uniforms;
mod views;

use drawing::{Stage, drawn, in_glsl, in_wgsl};
use estampe::state::{ColorTargetState, PrimitiveTopology};
use estampe::{Device, DeviceDescriptor, Level, Program};
use std::sync::Arc;
use uniforms::Numbers;

use estampe_renderer::shading::VertexStream;

/// Makes a program for the textures of a device.
type InRust = Box<dyn Fn(&drawing::Textures) -> Arc<dyn Program>>;

/// A material in Rust and as text.
struct Material {
    name: &'static str,
    in_rust: InRust,
    /// What the vertex shader reads, by location.
    streams: Vec<VertexStream>,
    wgsl: Wgsl,
    glsl: Glsl,
    numbers: Numbers,
    targets: Vec<Option<ColorTargetState>>,
    topology: PrimitiveTopology,
    /// The fewest different colours that show that something is drawn.
    least_colors: usize,
    /// The pixels of the first target and of the others that WGSL draws otherwise than Rust, and
    /// those of GLSL.
    differing: [[usize; 2]; 2],
}

struct Wgsl {
    text: String,
    vertex: &'static str,
    fragment: &'static str,
    constants: Vec<(&'static str, f64)>,
}

struct Glsl {
    vertex: String,
    fragment: String,
    defines: Vec<(&'static str, String)>,
}

/// Devices of every level, by 1 and 3 threads, with machine code and without.
fn devices() -> impl Iterator<Item = (String, Device)> {
    let kinds = Level::all_available().into_iter().flat_map(|level| {
        // There is no machine code for the scalar level, and it takes as long as the others
        // together.
        let kinds = [(1, false), (3, true)].into_iter();
        let kinds = kinds.filter(move |(_, interprets)| *interprets || !level.is_scalar());
        kinds.map(move |(threads, interprets_shaders)| (level, threads, interprets_shaders))
    });
    let best = [(Level::best(), 3, false), (Level::best(), 1, true)];
    kinds
        .chain(best)
        .map(|(level, threads, interprets_shaders)| {
            let device = Device::new(&DeviceDescriptor {
                threads,
                level,
                interprets_shaders,
                ..DeviceDescriptor::default()
            });
            let name = format!("{level:?}, {threads} threads, interpreted: {interprets_shaders}");
            (name, device.expect("a few threads"))
        })
}

/// Draws a material in its three forms on every device.
#[track_caller]
fn check(material: &Material) {
    let mut expected: Option<Vec<Vec<u8>>> = None;
    for (device_name, device) in devices() {
        let stage = Stage::new(&device);
        let in_rust = drawn(&stage, material, stage.rust(material), &stage.rust_groups());
        let (program, groups) = in_wgsl(&stage, material);
        let of_wgsl = drawn(&stage, material, program, &groups);
        let (program, groups) = in_glsl(&stage, material);
        let of_glsl = drawn(&stage, material, program, &groups);
        let expected = expected.get_or_insert_with(|| {
            let colors: std::collections::BTreeSet<_> = in_rust[0].chunks(16).collect();
            let (least, name) = (material.least_colors, material.name);
            assert!(colors.len() >= least, "{name}: {} colours", colors.len());
            in_rust.clone()
        });
        for (form, pictures) in [("Rust", in_rust), ("WGSL", of_wgsl), ("GLSL", of_glsl)] {
            for (target, (picture, expected)) in pictures.iter().zip(&*expected).enumerate() {
                let pixel = expected.len() / (drawing::WIDTH * drawing::HEIGHT) as usize;
                let pixels = picture.chunks(pixel).zip(expected.chunks(pixel));
                let different: Vec<_> = pixels.enumerate().filter(|(_, (a, b))| a != b).collect();
                let stated = match form {
                    "WGSL" => material.differing[0][target.min(1)],
                    "GLSL" => material.differing[1][target.min(1)],
                    _ => 0,
                };
                let first = different.first();
                let first = first.map(|(at, (a, b))| (at, drawing::floats(a), drawing::floats(b)));
                assert_eq!(
                    different.len(),
                    stated,
                    "{}: pixels of target {target} differ in {form}, {device_name}; {first:?}",
                    material.name,
                );
            }
        }
    }
}

/// Phong and Blinn-Phong light at fragments, with every kind of base colour and output.
///
/// Rows: G1, G2
#[test]
fn lit_fragments_as_text() {
    surfaces::at_fragments().iter().for_each(check);
}

/// Gouraud and flat light, and light in no way.
///
/// Rows: G1, G2
#[test]
fn lit_vertices_as_text() {
    surfaces::at_vertices().iter().for_each(check);
}

/// Rows: G1, G2
#[test]
fn toon_shading_as_text() {
    surfaces::toon().iter().for_each(check);
}

/// Rows: G1, G2
#[test]
fn physically_based_surfaces_as_text() {
    physical::surfaces().iter().for_each(check);
}

/// Rows: G1, G2
#[test]
fn views_as_text() {
    views::inspection().iter().for_each(check);
}

/// Rows: G1, G2
#[test]
fn wireframes_points_and_lines_as_text() {
    views::wireframes().iter().for_each(check);
    views::points_and_lines().iter().for_each(check);
}
