//! Wrong types in WGSL: the exact messages.

use super::errors;

/// A shader that is wrong, and what is said of it.
const CASES: &[(&str, &str)] = &[
    (
        r#"fn f(p: ptr<function, f32>) { f2(p); }
fn f2(p: ptr<private, f32>) { }
"#,
        r#"shader:1:31: error: argument `p` of `f2` points to memory of another kind
  fn f(p: ptr<function, f32>) { f2(p); }
                                ^^^^^"#,
    ),
    (
        r#"fn f() { var b = vec2<bool>(); if any(1) { } }
"#,
        r#"shader:1:35: error: cannot apply relational function to type
  fn f() { var b = vec2<bool>(); if any(1) { } }
                                    ^^^"#,
    ),
    (
        r#"fn f() { let x = cross(vec2f(), vec2f()); }
"#,
        r#"shader:1:18: error: wrong type passed as argument #1 to `cross`
  fn f() { let x = cross(vec2f(), vec2f()); }
                   ^^^^^
  help: line 1: argument #1 has type `vec2<f32>`; `cross` accepts the following types for argument #1: vec3<f32>, vec3<f16>"#,
    ),
    (
        r#"fn f() { let x = transpose(1.0f); }
"#,
        r#"shader:1:18: error: wrong type passed as argument #1 to `transpose`
  fn f() { let x = transpose(1.0f); }
                   ^^^^^^^^^
  help: line 1: argument #1 has type `f32`; `transpose` accepts the following types for argument #1: mat2x2<f32>, mat2x2<f16>, mat2x3<f32>, mat2x3<f16>, mat2x4<f32>, mat2x4<f16>, mat3x2<f32>, mat3x2<f16>, mat3x3<f32>, mat3x3<f16>, mat3x4<f32>, mat3x4<f16>, mat4x2<f32>, mat4x2<f16>, mat4x3<f32>, mat4x3<f16>, mat4x4<f32>, mat4x4<f16>"#,
    ),
    (
        r#"@group(0) @binding(0) var t: texture_multisampled_2d<f32>;
@group(0) @binding(1) var s: sampler;
@fragment fn main() -> @location(0) vec4f { return textureSample(t, s, vec2f()); }
"#,
        r#"shader:3:52: error: the function does not take textures of this kind
  @fragment fn main() -> @location(0) vec4f { return textureSample(t, s, vec2f()); }
                                                     ^^^^^^^^^^^^^"#,
    ),
    (
        r#"@group(0) @binding(0) var t: texture_2d_array<f32>;
@group(0) @binding(1) var s: sampler;
@fragment fn main() -> @location(0) vec4f { return textureSample(t, s, vec2f()); }
"#,
        r#"shader:3:52: error: wrong number of arguments: expected 3, found 3
  @fragment fn main() -> @location(0) vec4f { return textureSample(t, s, vec2f()); }
                                                     ^^^^^^^^^^^^^"#,
    ),
    (
        r#"@group(0) @binding(0) var t: texture_2d<f32>;
@group(0) @binding(1) var s: sampler;
@fragment fn main() -> @location(0) vec4f { return textureGather(7, t, s, vec2f()); }
"#,
        r#"shader:3:66: error: textureGather component `7` doesn't exist, must be 0, 1, 2, or 3
  @fragment fn main() -> @location(0) vec4f { return textureGather(7, t, s, vec2f()); }
                                                                   ^
  help: invalid component"#,
    ),
    (
        r#"fn f(@location(0) x: i32) { }
"#,
        r#"shader:1:1: error: functions that are not entry points cannot have `@location` or `@builtin` attributes on their arguments: "x" has attributes
  fn f(@location(0) x: i32) { }
  ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"fn f() -> @location(0) i32 { return 1; }
"#,
        r#"shader:1:1: error: functions that are not entry points cannot have `@location` or `@builtin` attributes on their return value types
  fn f() -> @location(0) i32 { return 1; }
  ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"fn f() { var v = vec3f(); let i = 7; let x = v[9]; }
"#,
        r#"shader: error: index 9 is out of bounds"#,
    ),
    (
        r#"@group(0) @binding(0) var t: texture_2d<f32>;
fn f() { let y = -t; }
"#,
        r#"shader:2:18: error: `-` does not work with texture
  fn f() { let y = -t; }
                   ^^"#,
    ),
    (
        r#"fn f() { return 1.0; }
"#,
        r#"shader:1:17: error: abstract types may only appear in constant expressions
  fn f() { return 1.0; }
                  ^^^"#,
    ),
    (
        r#"fn f() { let x = select(1.0, vec2f(1.0), true); }
"#,
        r#"shader:1:18: error: expected reject and accept args. to be scalars of vectors of the same type, got something else
  fn f() { let x = select(1.0, vec2f(1.0), true); }
                   ^^^^^^"#,
    ),
    (
        r#"fn f() { let x = select(1.0, 2.0, 1.0); }
"#,
        r#"shader:1:18: error: expected boolean expression for condition argument of `select`, got something else
  fn f() { let x = select(1.0, 2.0, 1.0); }
                   ^^^^^^"#,
    ),
    (
        r#"fn f() { var a = array<f32, 3>(); let i = 1.0f; let x = a[i]; }
"#,
        r#"shader:1:57: error: an index must be an integer, not `f32`
  fn f() { var a = array<f32, 3>(); let i = 1.0f; let x = a[i]; }
                                                          ^^^^"#,
    ),
    (
        r#"fn f() { var a = array<f32, 3>(); let x = a[-1]; }
"#,
        r#"shader:1:43: error: an index must not be negative
  fn f() { var a = array<f32, 3>(); let x = a[-1]; }
                                            ^^^^^"#,
    ),
    (
        r#"fn f() { let x = sin(1i); }
"#,
        r#"shader:1:18: error: wrong type passed as argument #1 to `sin`
  fn f() { let x = sin(1i); }
                   ^^^
  help: line 1: argument #1 has type `i32`; `sin` accepts the following types for argument #1: f32, f16, vec2<f32>, vec2<f16>, vec3<f32>, vec3<f16>, vec4<f32>, vec4<f16>"#,
    ),
    (
        r#"fn f() { let x = dot(vec2f(), vec3f()); }
"#,
        r#"shader:1:18: error: inconsistent type passed as argument #2 to `dot`
  fn f() { let x = dot(vec2f(), vec3f()); }
                   ^^^
  help: line 1: argument #2 has type vec3<f32>; line 1: this argument has type vec2<f32>, which constrains subsequent arguments; Because argument #1 has type vec2<f32>, only the following types; (or types that automatically convert to them) are accepted for argument #2: vec2<f32>"#,
    ),
    (
        r#"@fragment fn main() { let i = 1i; let x = dpdx(i); }
"#,
        r#"shader:1:43: error: derivatives are taken of floating-point scalars and vectors only
  @fragment fn main() { let i = 1i; let x = dpdx(i); }
                                            ^^^^"#,
    ),
    (
        r#"fn f() { let x = vec3f(1.0, 2.0); }
"#,
        r#"shader:1:18: error: constructor expects 3 components, found 2
  fn f() { let x = vec3f(1.0, 2.0); }
                   ^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"fn f() { let a = 1i; let x = vec3f(1.0, 2.0, a); }
"#,
        r#"shader:1:30: error: argument 3 of `vec3<f32>` must not be `i32`
  fn f() { let a = 1i; let x = vec3f(1.0, 2.0, a); }
                               ^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"fn f() { let x = -true; }
"#,
        r#"shader:1:18: error: this operator does not work with a value of this type
  fn f() { let x = -true; }
                   ^^^^^"#,
    ),
    (
        r#"fn f() { let b = true; let x = -b; }
"#,
        r#"shader:1:32: error: `-` does not work with `bool`
  fn f() { let b = true; let x = -b; }
                                 ^^"#,
    ),
    (
        r#"fn f() { var b = 1.5f; b = 1i; }
"#,
        r#"shader:1:24: error: automatic conversions cannot convert elements of `i32` to `f32`
  fn f() { var b = 1.5f; b = 1i; }
                         ^
  help: a value with elements of type f32 is required here; line 1: this expression has type i32"#,
    ),
    (
        r#"fn f() { g(1.0); }
fn g(x: texture_2d<f32>) { }
"#,
        r#"shader:1:12: error: automatic conversions cannot convert `{AbstractFloat}` to `texture_2d<f32>`
  fn f() { g(1.0); }
             ^^^
  help: a value of type texture_2d<f32> is required here; line 1: this expression has type {AbstractFloat}"#,
    ),
    (
        r#"fn g(x: atomic<u32>) { }
"#,
        r#"shader:1:1: error: parameter `x` has a type that functions do not take
  fn g(x: atomic<u32>) { }
  ^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"fn g() -> sampler { }
"#,
        r#"shader:1:1: error: the function's given return type cannot be returned from functions
  fn g() -> sampler { }
  ^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"fn f() { let x = 4294967296u; }
"#,
        r#"shader:1:18: error: numeric literal not representable by target type: `4294967296u`
  fn f() { let x = 4294967296u; }
                   ^^^^^^^^^^^"#,
    ),
    (
        r#"@group(0) @binding(0) var t: texture_storage_2d<rgba8unorm, write>;
@fragment fn main() { textureStore(t, vec2i(), vec4i()); }
"#,
        r#"shader:2:48: error: automatic conversions cannot convert elements of `vec4<i32>` to `f32`
  @fragment fn main() { textureStore(t, vec2i(), vec4i()); }
                                                 ^^^^^^^
  help: this expression has type vec4<i32>"#,
    ),
    (
        r#"@group(0) @binding(0) var<storage, read_write> a: atomic<u32>;
fn f() { atomicAdd(&a, 1i); }
"#,
        r#"shader:2:24: error: automatic conversions cannot convert elements of `i32` to `u32`
  fn f() { atomicAdd(&a, 1i); }
                         ^^
  help: this expression has type i32"#,
    ),
    (
        r#"@group(0) @binding(0) var t: texture_storage_2d<rgba8unorm, write>;
fn f() { let y = !t; }
"#,
        r#"shader:2:18: error: `!` does not work with write-only storage texture
  fn f() { let y = !t; }
                   ^^"#,
    ),
    (
        r#"@group(0) @binding(0) var t: texture_storage_2d<rgba8unorm, read>;
fn f() { let y = ~t; }
"#,
        r#"shader:2:18: error: `~` does not work with storage texture
  fn f() { let y = ~t; }
                   ^^"#,
    ),
];

#[test]
fn errors_tell_the_place_and_what_to_do() {
    assert_eq!(errors::wgsl(CASES), 32);
}
