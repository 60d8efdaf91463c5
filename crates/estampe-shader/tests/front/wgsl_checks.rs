//! WGSL that parses and is not valid: the exact messages.

use super::errors;

/// A shader that is wrong, and what is said of it.
const CASES: &[(&str, &str)] = &[
    (
        r#"@vertex fn main() -> @location(0) vec4f { return vec4f(); }
"#,
        r#"shader:1:12: error: vertex shader `main` must return `@builtin(position)`
  @vertex fn main() -> @location(0) vec4f { return vec4f(); }
             ^^^^"#,
    ),
    (
        r#"@fragment fn main(@location(0) a: f32, @location(0) b: f32) -> @location(0) vec4f {
    return vec4f(a + b);
}
"#,
        r#"shader:1:14: error: input `b` of `main`: @location(0) is given twice
  @fragment fn main(@location(0) a: f32, @location(0) b: f32) -> @location(0) vec4f {
               ^^^^"#,
    ),
    (
        r#"@fragment fn main(a: f32) -> @location(0) vec4f {
    return vec4f(a);
}
"#,
        r#"shader:1:14: error: input `a` of `main` has no location
  @fragment fn main(a: f32) -> @location(0) vec4f {
               ^^^^
  help: give it `@location(…)` or `@builtin(…)`"#,
    ),
    (
        r#"@fragment fn main(@location(0) a: i32) -> @location(0) vec4f {
    return vec4f(f32(a));
}
"#,
        r#"shader:1:14: error: input `a` of `main` is an integer, which is not interpolated
  @fragment fn main(@location(0) a: i32) -> @location(0) vec4f {
               ^^^^
  help: add `@interpolate(flat)`"#,
    ),
    (
        r#"struct U { a: vec4f }
var<uniform> u: U;
@fragment fn main() -> @location(0) vec4f {
    return u.a;
}
"#,
        r#"shader:2:1: error: `u` must have a group and a binding if it is a resource, and none if not
  var<uniform> u: U;
  ^^^^^^^^^^^^^^^^^^
  help: buffers, textures and samplers have `@group(…) @binding(…)`"#,
    ),
    (
        r#"@group(0) @binding(0) var<uniform> u: bool;
@fragment fn main() -> @location(0) vec4f {
    return vec4f(f32(u));
}
"#,
        r#"shader:1:23: error: `u` has a type that a buffer or variable of its kind cannot hold
  @group(0) @binding(0) var<uniform> u: bool;
                        ^^^^^^^^^^^^^^^^^^^^^
  help: buffers hold numbers, vectors, matrices, and arrays and structures of them; use an unsigned integer in the place of a `bool`"#,
    ),
    (
        r#"@group(0) @binding(0) var<uniform> u: array<f32, 4>;
@fragment fn main() -> @location(0) vec4f {
    return vec4f(u[0]);
}
"#,
        r#"shader:1:23: error: `u`: the layout of array of 4 `f32` does not fit a uniform buffer: the array stride 4 is not a multiple of the required alignment 16
  @group(0) @binding(0) var<uniform> u: array<f32, 4>;
                        ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"@group(0) @binding(0) var<uniform> a: vec4f;
@group(0) @binding(0) var<uniform> b: vec4f;
@fragment fn main() -> @location(0) vec4f {
    return a + b;
}
"#,
        r#"shader:2:23: error: `b` has the group and binding of another variable: group 0, binding 0
  @group(0) @binding(0) var<uniform> b: vec4f;
                        ^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"@vertex fn main() -> @builtin(position) vec4f {
    return vec4f(dpdx(1.0));
}
"#,
        r#"shader:1:12: error: `main` uses what its stage does not have, such as derivatives or barriers
  @vertex fn main() -> @builtin(position) vec4f {
             ^^^^"#,
    ),
    (
        r#"@group(0) @binding(0) var t: texture_2d<f32>;
@group(0) @binding(1) var s: sampler;
@fragment fn main() -> @location(0) vec4f {
    return textureSample(t, s, 1.0);
}
"#,
        r#"shader:4:12: error: the texture's coordinates must not be `f32`
      return textureSample(t, s, 1.0);
             ^^^^^^^^^^^^^"#,
    ),
    (
        r#"@group(0) @binding(0) var t: texture_2d<f32>;
@group(0) @binding(1) var s: sampler_comparison;
@fragment fn main() -> @location(0) vec4f {
    return textureSample(t, s, vec2f(1.0));
}
"#,
        r#"shader:4:12: error: a comparison takes a depth texture, a comparison sampler and a reference; other sampling takes none of them
      return textureSample(t, s, vec2f(1.0));
             ^^^^^^^^^^^^^"#,
    ),
    (
        r#"fn f(x: f32) -> f32 { return f(x); }
@fragment fn main() -> @location(0) vec4f {
    return vec4f(f(1.0));
}
"#,
        r#"shader:1:4: error: declaration of `f` is recursive
  fn f(x: f32) -> f32 { return f(x); }
     ^
  help: line 1: uses itself here"#,
    ),
    (
        r#"@fragment fn main() -> @location(0) vec4f {
    break;
    return vec4f();
}
"#,
        r#"shader:2:5: error: `break` outside of a loop or `switch`
      break;
      ^^^^^^"#,
    ),
    (
        r#"@fragment fn main(@builtin(frag_pos) p: vec4f) -> @location(0) vec4f {
    return p;
}
"#,
        r#"shader:1:28: error: unknown builtin: `frag_pos`
  @fragment fn main(@builtin(frag_pos) p: vec4f) -> @location(0) vec4f {
                             ^^^^^^^^"#,
    ),
    (
        r#"@fragmnt fn main() -> @location(0) vec4f { return vec4f(); }
"#,
        r#"shader:1:2: error: unknown attribute: `fragmnt`
  @fragmnt fn main() -> @location(0) vec4f { return vec4f(); }
   ^^^^^^^"#,
    ),
    (
        r#"@fragment fn main() -> @location(0) vec4f {
    let i: i32 = 3000000000;
    return vec4f(f32(i));
}
"#,
        r#"shader:2:18: error: the concrete type `i32` cannot represent the abstract value `3000000000` accurately
      let i: i32 = 3000000000;
                   ^^^^^^^^^^"#,
    ),
    (
        r#"/* comment
@fragment fn main() -> @location(0) vec4f {
    return vec4f();
}
"#,
        r#"shader:1:1: error: unterminated block comment
  /* comment
  ^^^^^^^^^^
  help: must be closed with `*/`"#,
    ),
    (
        r#"@fragment fn main() -> @location(0) vec4f {
    let a = 1.0;
    let a = 2.0;
    return vec4f(a);
}
"#,
        r#"shader:3:9: error: redefinition of `a`
      let a = 2.0;
          ^
  help: line 2: previous definition of `a`"#,
    ),
    (
        r#"#version 330 core
void main() {}
"#,
        r##"shader:1:1: error: expected global item (`struct`, `const`, `var`, `alias`, `fn`, `diagnostic`, `enable`, `requires`, `;`) or the end of the file, found "#"
  #version 330 core
  ^
  help: `#version` is of GLSL, and this is read as WGSL"##,
    ),
    (
        r#"@fragment fn main(@builtin(barycentric) b: vec3f) { }
"#,
        r#"shader:1:14: error: input `b` of `main`: barycentric coordinates are not supported
  @fragment fn main(@builtin(barycentric) b: vec3f) { }
               ^^^^"#,
    ),
    (
        r#"@compute @workgroup_size(0) fn main() { }
"#,
        r#"shader:1:32: error: the size of a workgroup is 1 to 16384 invocations in each direction
  @compute @workgroup_size(0) fn main() { }
                                 ^^^^"#,
    ),
    (
        r#"@fragment fn main() -> @location(0) vec4f {
    let x = f64(1.0);
    return vec4f(f32(x));
}
"#,
        r#"shader:2:13: error: 64-bit floating point is not supported
      let x = f64(1.0);
              ^^^^^^^^"#,
    ),
    (
        r#"@group(0) @binding(0) var<storage, read> b: array<f32>;
@compute @workgroup_size(1) fn main() {
    b[0] = 1.0;
}
"#,
        r#"shader:3:5: error: this cannot be assigned to
      b[0] = 1.0;
      ^^^^
  help: assign to `var`s, and to storage buffers that are `read_write`"#,
    ),
    (
        r#"@fragment fn main() -> @location(0) vec4f {
    let x = 1.0 $ 2.0;
    return vec4f(x);
}
"#,
        r#"shader:2:17: error: expected `;`, found "$"
      let x = 1.0 $ 2.0;
                  ^"#,
    ),
    (
        r#"@fragment fn main() -> @location(0) vec4f {
    let x = 1 / 0;
    return vec4f(f32(x));
}
"#,
        r#"shader:2:13: error: division by zero
      let x = 1 / 0;
              ^^^^^"#,
    ),
    (
        r#"@fragment fn main() -> @location(0) vec4f {
    switch 1.0 { default: { } }
    return vec4f();
}
"#,
        r#"shader:2:12: error: invalid `switch` selector
      switch 1.0 { default: { } }
             ^^^
  help: `switch` selector must be a scalar integer"#,
    ),
];

#[test]
fn errors_tell_the_place_and_what_to_do() {
    assert_eq!(errors::wgsl(CASES), 26);
}
