//! Wrong statements and expressions in GLSL: the exact messages.

use super::errors;
use estampe_ir::interface::Stage;

/// Vertex shaders that are wrong, and what is said of them.
const VERTEX: &[(&str, &str)] = &[
    (
        r#"void main() { gl_Position = gl_ModelViewProjectionMatrix * vec4(1.0); }
"#,
        r#"shader:1:29: error: `gl_ModelViewProjectionMatrix` is not supported
  void main() { gl_Position = gl_ModelViewProjectionMatrix * vec4(1.0); }
                              ^^^^^^^^^^^^^^^^^^^^^^^^^^^^
  help: declare a uniform, such as `uniform mat4 model;`"#,
    ),
    (
        r#"void main() { gl_FrontColor = vec4(1.0); gl_Position = vec4(1.0); }
"#,
        r#"shader:1:15: error: `gl_FrontColor` is not supported
  void main() { gl_FrontColor = vec4(1.0); gl_Position = vec4(1.0); }
                ^^^^^^^^^^^^^
  help: declare an output, such as `out vec4 color;`"#,
    ),
    (
        r#"layout(location = 0) flat out int v;
out int w;
void main() { gl_Position = vec4(1.0); w = 1; }
"#,
        r#"shader:3:6: error: output of `main` is an integer, which is not interpolated
  void main() { gl_Position = vec4(1.0); w = 1; }
       ^^^^
  help: add `flat`"#,
    ),
];

/// Fragment shaders that are wrong, and what is said of them.
const FRAGMENT: &[(&str, &str)] = &[
    (
        r#"uniform sampler2D maps[2];
out vec4 c;
void main() { c = texture(maps, vec2(0.0)); }
"#,
        r#"shader:3:27: error: `maps` is an array of samplers
  void main() { c = texture(maps, vec2(0.0)); }
                            ^^^^
  help: use one of its elements, or an array texture (`sampler2DArray`)"#,
    ),
    (
        r#"out vec4 c;
void main() { c = vec4(gl_PrimitiveID); }
"#,
        r#"shader:2:24: error: `gl_PrimitiveID` is not supported
  void main() { c = vec4(gl_PrimitiveID); }
                         ^^^^^^^^^^^^^^
  help: hand the number to the shader as an input or uniform"#,
    ),
    (
        r#"out vec4 c;
void main() { c = vec4(void(1.0)); }
"#,
        r#"shader:2:24: error: type can't be void
  void main() { c = vec4(void(1.0)); }
                         ^^^^"#,
    ),
    (
        r#"out vec4 c;
void main() { float list[0]; c = vec4(1.0); }
"#,
        r#"shader:2:26: error: an array needs at least one element
  void main() { float list[0]; c = vec4(1.0); }
                           ^
  help: use a larger size"#,
    ),
    (
        r#"out vec4 c;
void main() { switch (1) { case 1.5: break; } c = vec4(1.0); }
"#,
        r#"shader:2:15: error: GLSL has `switch` since version 1.30, not in 110
  void main() { switch (1) { case 1.5: break; } c = vec4(1.0); }
                ^^^^^^
  help: begin the shader with `#version 330` or `#version 300 es`"#,
    ),
    (
        r#"out vec4 c;
void main() { continue; }
"#,
        r#"shader:2:15: error: `continue` outside of a loop
  void main() { continue; }
                ^^^^^^^^"#,
    ),
    (
        r#"out vec4 c;
void main() { c = vec4(1.0); c = vec4(c.length()); }
"#,
        r#"shader:2:40: error: only arrays have a `length()` that is known
  void main() { c = vec4(1.0); c = vec4(c.length()); }
                                         ^^^^^^^^^"#,
    ),
    (
        r#"out vec4 c;
uniform double d;
void main() { c = vec4(float(d)); }
"#,
        r#"shader:2:16: error: 64-bit floating point is not supported
  uniform double d;
                 ^"#,
    ),
    (
        r#"#version 330
out vec4 c;
void main() { switch (1) { case 1.5: c = vec4(1.0); break; default: c = vec4(0.0); } }
"#,
        r#"shader:3:33: error: case values can only be integers
  void main() { switch (1) { case 1.5: c = vec4(1.0); break; default: c = vec4(0.0); } }
                                  ^^^"#,
    ),
    (
        r#"#version 330
out vec4 c;
void main() { switch (1.5) { case 1: c = vec4(1.0); break; default: c = vec4(0.0); } }
"#,
        r#"shader:3:23: error: `switch` takes an integer, not `float`
  void main() { switch (1.5) { case 1: c = vec4(1.0); break; default: c = vec4(0.0); } }
                        ^^^"#,
    ),
    (
        r#"#version 330
out vec4 c;
uniform int i;
void main() { switch (i) { case 1: c = vec4(1.0); break; case 1: c = vec4(0.0); } }
"#,
        r#"shader:4:70: error: `switch` has the case 1 more than once
  void main() { switch (i) { case 1: c = vec4(1.0); break; case 1: c = vec4(0.0); } }
                                                                       ^^^^^^^^^"#,
    ),
    (
        r#"#version 450
layout(set = 0, binding = 0) uniform texture2D t;
out vec4 c;
void main() { c = texelFetch(t, ivec2(0), true); }
"#,
        r#"shader:4:6: error: the layer, mip level or sample is not an integer
  void main() { c = texelFetch(t, ivec2(0), true); }
       ^^^^"#,
    ),
    (
        r#"#version 430
layout(constant_id = 1) const vec2 gain = vec2(1.0);
out vec4 c;
void main() { c = vec4(gain, gain); }
"#,
        r#"shader:2:36: error: specialization constant `gain`: the type is not a scalar
  layout(constant_id = 1) const vec2 gain = vec2(1.0);
                                     ^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"#version 430
layout(constant_id = 1) const int one = 1;
layout(constant_id = 1) const int two = 2;
out vec4 c;
void main() { c = vec4(one, two, one, two); }
"#,
        r#"shader:3:35: error: specialization constant `two`: override ID must be unique
  layout(constant_id = 1) const int two = 2;
                                    ^^^^^^^"#,
    ),
    (
        r#"#version 430
layout(location = 0) flat in double d;
out vec4 c;
void main() { c = vec4(1.0); }
"#,
        r#"shader:2:37: error: 64-bit floating point is not supported
  layout(location = 0) flat in double d;
                                      ^"#,
    ),
    (
        r#"out vec4 c;
const int n = 3;
void main() { float list[n - 4]; c = vec4(1.0); }
"#,
        r#"shader:3:26: error: int constant overflows
  void main() { float list[n - 4]; c = vec4(1.0); }
                           ^^^^^"#,
    ),
    (
        r#"#version 430
shared float w[4];
out vec4 c;
void main() { c = vec4(w[0]); }
"#,
        r#"shader:2:14: error: `w` is memory of a work-group, and `main` has none
  shared float w[4];
               ^
  help: only compute shaders have work-groups"#,
    ),
    (
        r#"out vec4 c;
void main() { double d = 1.0; c = vec4(float(d)); }
"#,
        r#"shader:2:15: error: 64-bit floating point is not supported
  void main() { double d = 1.0; c = vec4(float(d)); }
                ^^^^^^"#,
    ),
    (
        r#"uniform sampler2D maps[200];
out vec4 c;
void main() { c = texture(maps[0], vec2(0.0)); }
"#,
        r#"shader:1:19: error: the uniform `maps` has more than 128 textures
  uniform sampler2D maps[200];
                    ^^^^
  help: use an array texture, such as `sampler2DArray`"#,
    ),
    (
        r#"layout(push_constant) uniform Block { vec4 a; layout(offset = 8) vec4 b; };
out vec4 c;
void main() { c = a + b; }
"#,
        r#"shader:1:71: error: `b` cannot begin at byte 8
  layout(push_constant) uniform Block { vec4 a; layout(offset = 8) vec4 b; };
                                                                        ^
  help: the member before it ends at byte 16, and its offset is a multiple of 16 and at most 65536"#,
    ),
    (
        r#"#foo
void main() { }
"#,
        r#"shader:1:1: error: there is no directive `#foo`
  #foo
  ^^^^"#,
    ),
    (
        r#"layout(location = ) out vec4 c;
void main() { }
"#,
        r#"shader:1:8: error: an integer expression is missing here
  layout(location = ) out vec4 c;
         ^^^^^^^^
  help: use constant integers: numbers, macros, `const int`"#,
    ),
    (
        r#"uniform sampler2D t;
out vec4 c;
void main() { ivec2 o = ivec2(1); c = textureOffset(t, vec2(0.0), o); }
"#,
        r#"shader:3:39: error: sample offset must be a const-expression
  void main() { ivec2 o = ivec2(1); c = textureOffset(t, vec2(0.0), o); }
                                        ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"out vec4 c;
struct S { float a; };
void main() { S s; s++; c = vec4(1.0); }
"#,
        r#"shader:3:21: error: `++` and `--` need a number
  void main() { S s; s++; c = vec4(1.0); }
                      ^^
  help: use a variable"#,
    ),
    (
        r#"out vec4 c;
float f(float x) { return g(x); }
float g(float x) { return f(x); }
void main() { c = vec4(f(1.0)); }
"#,
        r#"shader:3:27: error: `f` calls itself by way of `g`
  float g(float x) { return f(x); }
                            ^^^^
  help: functions of GLSL cannot call themselves: use a loop"#,
    ),
    (
        r#"#version 430
out vec4 c;
uniform image2D i;
void main() { c = imageLoad(c, ivec2(0)); }
"#,
        r#"shader:3:17: error: image types require a format layout qualifier
  uniform image2D i;
                  ^
shader:4:19: error: `imageLoad` does not take these arguments
  void main() { c = imageLoad(c, ivec2(0)); }
                    ^^^^^^^^^^^^^^^^^^^^^^
  help: compare the number of the arguments and their types with the language's"#,
    ),
    (
        r#"out vec4 c;
void main() { goto x; }
"#,
        r#"shader:2:15: error: there is no type `goto`
  void main() { goto x; }
                ^^^^"#,
    ),
    (
        r#"out vec4 c;
void main() { c = vec4(1.0); } }
"#,
        r#"shader:2:32: error: nothing is open that this `}` closes
  void main() { c = vec4(1.0); } }
                                 ^
  help: remove it, or look for a bracket that is closed too early before it"#,
    ),
];

#[test]
fn errors_tell_the_place_and_what_to_do() {
    assert_eq!(errors::in_stage(Stage::Vertex, VERTEX), 3);
    assert_eq!(errors::in_stage(Stage::Fragment, FRAGMENT), 28);
}
