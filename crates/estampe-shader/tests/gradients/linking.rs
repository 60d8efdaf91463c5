//! What the interface of a program says of gradients.

use super::{VERTEX, entry_points, program};
use estampe_shader::program::TextProgram;
use estampe_types::{Interface, Program};

fn interface(statements: &str) -> Interface {
    program(statements).interface().clone()
}

#[test]
fn samples_at_varyings_need_no_quads() {
    let interface =
        interface("return textureSample(map, s, in.uv) + textureSample(sky, s, in.direction);");
    assert!(interface.no_derivatives);
    assert_eq!(interface.varyings.len(), 5);
    assert_eq!(interface.gradients, [0, 1, 2, 3, 4]);
    assert_eq!(interface.fragment_scalars(), 15);
}

/// Where one thing needs its quad, all do with theirs.
#[test]
fn other_derivatives_need_quads() {
    for statements in [
        "return textureSample(map, s, in.uv) + textureSample(map, s, in.uv * 2.0);",
        "return textureSample(map, s, in.uv) + textureSampleBias(map, s, in.uv, 1.0);",
        "return textureSample(map, s, in.uv) + dpdx(in.direction.x);",
        "return textureSample(map, s, in.uv) + quadSwapX(in.direction.x);",
    ] {
        let interface = interface(statements);
        assert!(!interface.no_derivatives, "{statements}");
        assert_eq!(interface.gradients, [0; 0], "{statements}");
        assert_eq!(interface.fragment_scalars(), interface.varyings.len());
    }
    let interface = interface("return textureSampleBias(map, s, in.uv, 1.0);");
    assert!(!interface.no_derivatives && interface.gradients.is_empty());
    assert_eq!(interface.fragment_scalars(), 2);
}

/// Scalars that nothing reads are dropped, and the others, with their derivatives, numbered anew.
#[test]
fn scalars_are_numbered_as_they_are_linked() {
    // Read: uv.y, direction.y and on_screen.
    let interface = interface(
        "return textureSample(map, s, in.on_screen) * in.direction.y
            + textureSample(line, s, in.uv.y);",
    );
    assert_eq!(interface.varyings.len(), 4);
    assert_eq!(interface.gradients, [0, 2, 3]);
    // Sampled in another order than that of the varyings.
    let interface = self::interface(
        "return textureSample(map, s, vec2f(in.direction.z, in.uv.x)) * in.on_screen.x;",
    );
    assert_eq!(interface.varyings.len(), 3);
    assert_eq!(interface.gradients, [0, 1]);
}

/// The fragment shader declares its varyings in another order than the vertex shader.
#[test]
fn stages_may_list_their_varyings_in_any_order() {
    let text = "@group(0) @binding(0) var s: sampler;
        @group(0) @binding(1) var sky: texture_cube<f32>;
        @fragment fn f(
            @location(3) @interpolate(flat) layer: i32,
            @location(1) direction: vec3f,
            @location(0) uv: vec2f,
        ) -> @location(0) vec4f {
            return textureSample(sky, s, direction) * f32(layer) + uv.y;
        }";
    let (vertex, fragment) = (entry_points(VERTEX).remove(0), entry_points(text).remove(0));
    let program = TextProgram::new(&vertex, Some(&fragment), 1 << 20);
    let program = program.unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(program.interface().varyings.len(), 5);
    assert_eq!(program.interface().gradients, [1, 2, 3]);
}

#[test]
fn a_program_without_fragments_has_no_gradients() {
    let program = TextProgram::new(&entry_points(VERTEX)[0], None, 1 << 20);
    let program = program.unwrap_or_else(|error| panic!("{error}"));
    assert!(program.interface().gradients.is_empty());
    assert_eq!(program.interface().fragment_scalars(), 0);
}
