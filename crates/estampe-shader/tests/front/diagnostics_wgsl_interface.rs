//! Wrong entry points, variables and types in WGSL: the exact messages.

use super::errors;

/// A shader that is wrong, and what is said of it.
const CASES: &[(&str, &str)] = &[
    (
        r#"enable dual_source_blending;
struct Out { @location(0) @blend_src(0) a: vec4f, @location(1) @blend_src(1) b: vec4f }
@fragment fn main() -> Out { return Out(); }
"#,
        r#"shader:2:1: error: type `Out`: invalid `@blend_src` structure: `@blend_src` can only be used at location 0, indices 0 and 1. Found `@location(1) @blend_src(1)`
  struct Out { @location(0) @blend_src(0) a: vec4f, @location(1) @blend_src(1) b: vec4f }
  ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"@group(0) @binding(0) var<storage, write> s: f32;
"#,
        r#"shader:1:23: error: variable `s`: storage address space doesn't support write-only access
  @group(0) @binding(0) var<storage, write> s: f32;
                        ^^^^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"var<workgroup> w: f32 = 1.0;
"#,
        r#"shader:1:1: error: variable `w`: initializer can't be used with address space WorkGroup
  var<workgroup> w: f32 = 1.0;
  ^^^^^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) i: vec2u) { }
"#,
        r#"shader:1:32: error: input `i` of `main`: the built-in `global_invocation_id` has another type
  @compute @workgroup_size(1) fn main(@builtin(global_invocation_id) i: vec2u) { }
                                 ^^^^"#,
    ),
    (
        r#"@vertex fn main() -> @builtin(position) vec3f { return vec3f(); }
"#,
        r#"shader:1:12: error: output of `main`: the built-in `position` has another type
  @vertex fn main() -> @builtin(position) vec3f { return vec3f(); }
             ^^^^"#,
    ),
    (
        r#"@fragment fn main(@builtin(position) a: vec4f, @builtin(position) b: vec4f) { }
"#,
        r#"shader:1:14: error: input `b` of `main`: the built-in `position` is given twice
  @fragment fn main(@builtin(position) a: vec4f, @builtin(position) b: vec4f) { }
               ^^^^"#,
    ),
    (
        r#"fn f(x: i32) { switch x { case 1: { } case 1: { } default: { } } }
"#,
        r#"shader:1:1: error: `switch` has the case 1 more than once
  fn f(x: i32) { switch x { case 1: { } case 1: { } default: { } } }
  ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"var<immediate> a: f32;
var<immediate> b: f32;
@fragment fn main() -> @location(0) vec4f { return vec4f(a + b); }
"#,
        r#"shader:2:1: error: entry point `main`: more than 1 immediate data variable is used
  var<immediate> b: f32;
  ^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"@group(0) @binding(0) var<uniform> u: array<vec4f, 1000000000>;
"#,
        r#"shader:1:23: error: array of 1000000000 `vec4<f32>` is too large: error laying out type: Size exceeds limit of 2147483647 bytes
  @group(0) @binding(0) var<uniform> u: array<vec4f, 1000000000>;
                        ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"enable f16;
var<immediate> i: f16;
"#,
        r#"shader:2:1: error: `i` has a type that immediates cannot hold
  var<immediate> i: f16;
  ^^^^^^^^^^^^^^^^^^^^^^
  help: immediates hold 32-bit and 64-bit numbers"#,
    ),
    (
        r#"@vertex fn main() -> @invariant @location(0) vec4f { return vec4f(); }
"#,
        r#"shader:1:22: error: input/output binding is not consistent
  @vertex fn main() -> @invariant @location(0) vec4f { return vec4f(); }
                       ^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"@group(0) @binding(0) var<storage> a: atomic<u32>;
@compute @workgroup_size(1) fn main() { atomicAdd(&a, 1u); }
"#,
        r#"shader:1:23: error: `a` is written in `main`, which its declaration does not allow
  @group(0) @binding(0) var<storage> a: atomic<u32>;
                        ^^^^^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"fn f() { let x = select(1i, 1u, true); }
"#,
        r#"shader:1:25: error: type mismatch for reject and accept values in `select` call
  fn f() { let x = select(1i, 1u, true); }
                          ^^
  help: reject value of type `i32`; line 1: accept value of type `u32`"#,
    ),
    (
        r#"fn f() { let x = array<f32, 2>(1.0); }
"#,
        r#"shader:1:18: error: array of 2 `f32` is built from 2 components, but 1 is given
  fn f() { let x = array<f32, 2>(1.0); }
                   ^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"struct S { a: f32, b: f32 }
fn f() { let x = S(1.0); }
"#,
        r#"shader:2:18: error: `S` is built from 2 components, but 1 is given
  fn f() { let x = S(1.0); }
                   ^^^^^^"#,
    ),
    (
        r#"fn f() { let x = sampler(1.0); }
"#,
        r#"shader:1:18: error: type `sampler` is not constructible
  fn f() { let x = sampler(1.0); }
                   ^^^^^^^"#,
    ),
    (
        r#"var<private> a: array<f32, 0>;
"#,
        r#"shader:1:28: error: array element count must be positive (> 0)
  var<private> a: array<f32, 0>;
                             ^"#,
    ),
    (
        r#"var<private> a: array<f32>;
"#,
        r#"shader:1:1: error: `a` has a type that a buffer or variable of its kind cannot hold
  var<private> a: array<f32>;
  ^^^^^^^^^^^^^^^^^^^^^^^^^^^
  help: only a storage buffer may end with an array without a size"#,
    ),
    (
        r#"struct S { a: array<f32>, b: f32 }
@group(0) @binding(0) var<storage> s: S;
"#,
        r#"shader:1:1: error: type `S`: `a` has no size and is not the last member
  struct S { a: array<f32>, b: f32 }
  ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
  help: give it a size, or move it to the end"#,
    ),
    (
        r#"struct S { }
"#,
        r#"shader:1:1: error: type `S`: structure types must have at least one member
  struct S { }
  ^^^^^^^^^^^^"#,
    ),
    (
        r#"override o: vec2f;
"#,
        r#"shader:1:1: error: override `o`: the type is not a scalar
  override o: vec2f;
  ^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"@id(1) override a = 1.0;
@id(1) override b = 1.0;
"#,
        r#"shader:2:8: error: override `b`: override ID must be unique
  @id(1) override b = 1.0;
         ^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"struct Out { a: vec4f, @location(1) b: vec4f }
@fragment fn main() -> Out { return Out(); }
"#,
        r#"shader:1:1: error: output of `main`: member 1 has no location
  struct Out { a: vec4f, @location(1) b: vec4f }
  ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
  help: give each member `@location(…)` or `@builtin(…)`"#,
    ),
    (
        r#"@fragment fn main(@location(0) m: mat2x2f) { }
"#,
        r#"shader:1:14: error: input `m` of `main` is `mat2x2<f32>`, but only numbers and vectors of them pass between stages
  @fragment fn main(@location(0) m: mat2x2f) { }
               ^^^^"#,
    ),
    (
        r#"@fragment fn main(@builtin(vertex_index) i: u32) { }
"#,
        r#"shader:1:14: error: input `i` of `main`: its stage has no built-in `vertex_index` there
  @fragment fn main(@builtin(vertex_index) i: u32) { }
               ^^^^"#,
    ),
    (
        r#"@vertex fn main() -> @location(0) i32 { return 1; }
"#,
        r#"shader:1:12: error: output of `main` is an integer, which is not interpolated
  @vertex fn main() -> @location(0) i32 { return 1; }
             ^^^^
  help: add `@interpolate(flat)`"#,
    ),
    (
        r#"struct Out { @builtin(position) p: vec4f, @location(0) i: f32, @location(0) k: f32 }
@vertex fn main() -> Out { return Out(); }
"#,
        r#"shader:1:1: error: output of `main`: @location(0) is given twice
  struct Out { @builtin(position) p: vec4f, @location(0) i: f32, @location(0) k: f32 }
  ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"@compute fn main() { }
"#,
        r#"shader:1:2: error: workgroup size is missing on compute shader entry point
  @compute fn main() { }
   ^^^^^^^
  help: must be paired with a `@workgroup_size` attribute"#,
    ),
    (
        r#"@group(0) @binding(0) var t: texture_storage_2d<rgba8unorm, write>;
@fragment fn main() -> @location(0) vec4f { return textureLoad(t, vec2i()); }
"#,
        r#"shader:1:23: error: `t` is read in `main`, which its declaration does not allow
  @group(0) @binding(0) var t: texture_storage_2d<rgba8unorm, write>;
                        ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
];

#[test]
fn errors_tell_the_place_and_what_to_do() {
    assert_eq!(errors::wgsl(CASES), 29);
}
