//! Wrong compute shaders, buffers and images in GLSL: the exact messages.

use super::errors;
use estampe_ir::interface::Stage;

/// Compute shaders that are wrong, and what is said of them.
const COMPUTE: &[(&str, &str)] = &[
    (
        r#"layout(std430, binding = 0) buffer Block { vec4 a; layout(offset = 8) vec4 b; };
layout(local_size_x = 1) in;
void main() { a = b; }
"#,
        r#"shader:1:76: error: `b` begins at byte 16, not at byte 8
  layout(std430, binding = 0) buffer Block { vec4 a; layout(offset = 8) vec4 b; };
                                                                             ^
  help: leave `offset` out, and declare members for the gap"#,
    ),
    (
        r#"#version 450
layout(local_size_x = 1) in;
layout(rgba8, binding = 0) writeonly uniform image2D picture;
void main() { vec4 c = imageLoad(picture, ivec2(0)); }
"#,
        r#"shader:4:24: error: `imageLoad` does not go with the image's declaration
  void main() { vec4 c = imageLoad(picture, ivec2(0)); }
                         ^^^^^^^^^^^^^^^^^^^^^^^^^^^^
  help: `writeonly` images are not read, and `readonly` ones are not written"#,
    ),
    (
        r#"#version 450
layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer A { float x[]; float y; };
void main() { y = 1.0; }
"#,
        r#"shader:3:36: error: type `A`: `x` has no size and is not the last member
  layout(std430, binding = 0) buffer A { float x[]; float y; };
                                     ^
  help: give it a size, or move it to the end"#,
    ),
    (
        r#"#version 450
layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer B { double d; };
void main() { d = 1.0; }
"#,
        r#"shader:3:47: error: 64-bit floating point is not supported
  layout(std430, binding = 0) buffer B { double d; };
                                                ^"#,
    ),
];

#[test]
fn errors_tell_the_place_and_what_to_do() {
    assert_eq!(errors::in_stage(Stage::Compute, COMPUTE), 4);
}
