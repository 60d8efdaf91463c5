//! What WGSL has and estampe has not: the exact messages.

use super::errors;

/// A shader that is wrong, and what is said of it.
const CASES: &[(&str, &str)] = &[
    (
        r#"struct Out { @location(0) a: vec4f, @location(0) @blend_src(1) b: vec4f }
@fragment fn main() -> Out { return Out(); }
"#,
        r#"shader:1:51: error: this needs the extension `dual_source_blending`, which is not enabled
  struct Out { @location(0) a: vec4f, @location(0) @blend_src(1) b: vec4f }
                                                    ^^^^^^^^^
  help: add `enable dual_source_blending;` before all declarations"#,
    ),
    (
        r#"@group(0) @binding(0) var t: texture_storage_2d<r32uint, atomic>;
@fragment fn main() { textureAtomicAdd(t, vec2i(), 1u); }
"#,
        r#"shader:2:23: error: atomic operations on textures are not supported
  @fragment fn main() { textureAtomicAdd(t, vec2i(), 1u); }
                        ^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"struct S { a: S2 }
struct S2 { b: array<f64, 2> }
"#,
        r#"shader:2:1: error: 64-bit floating point is not supported
  struct S2 { b: array<f64, 2> }
  ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"alias D = f64;
// f64 in a comment
const d: D = 1.0lf;
"#,
        r#"shader:3:1: error: 64-bit floating point is not supported
  const d: D = 1.0lf;
  ^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"@group(0) @binding(0) var t: texture_2d<f32>;
@group(0) @binding(1) var s: sampler;
@fragment fn main() -> @location(0) vec4f { var o = vec2i(1); return textureSample(t, s, vec2f(), o); }
"#,
        r#"shader:3:99: error: this operation is not supported in a const context
  @fragment fn main() -> @location(0) vec4f { var o = vec2i(1); return textureSample(t, s, vec2f(), o); }
                                                                                                    ^
  help: operation not supported here"#,
    ),
    (
        r#"fn f(a: array<f64, 2>) { }
"#,
        r#"shader:1:1: error: 64-bit floating point is not supported
  fn f(a: array<f64, 2>) { }
  ^^^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"fn f() { var x: array<vec2<f64>, 2>; }
"#,
        r#"shader:1:10: error: 64-bit floating point is not supported
  fn f() { var x: array<vec2<f64>, 2>; }
           ^^^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"@group(0) @binding(0) var<storage, read_write> sum: atomic<u64>;
"#,
        r#"shader:1:23: error: atomic operations on 64-bit integers are not supported
  @group(0) @binding(0) var<storage, read_write> sum: atomic<u64>;
                        ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"@group(0) @binding(0) var<storage, read_write> sum: array<atomic<u64>, 4>;
"#,
        r#"shader:1:23: error: atomic operations on 64-bit integers are not supported
  @group(0) @binding(0) var<storage, read_write> sum: array<atomic<u64>, 4>;
                        ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"struct Sums { low: atomic<u64>, high: atomic<u64> }
@group(0) @binding(0) var<storage, read_write> sums: Sums;
"#,
        r#"shader:1:1: error: atomic operations on 64-bit integers are not supported
  struct Sums { low: atomic<u64>, high: atomic<u64> }
  ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"var<workgroup> sum: atomic<i64>;
"#,
        r#"shader:1:1: error: atomic operations on 64-bit integers are not supported
  var<workgroup> sum: atomic<i64>;
  ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"@group(0) @binding(0) var<storage, read_write> sum: atomic<f32>;
"#,
        r#"shader:1:23: error: atomic operations on floats are not supported
  @group(0) @binding(0) var<storage, read_write> sum: atomic<f32>;
                        ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"var<private> sum: f64;
"#,
        r#"shader:1:1: error: 64-bit floating point is not supported
  var<private> sum: f64;
  ^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"fn f() { let a: f64 = 1.0; }
"#,
        r#"shader:1:23: error: 64-bit floating point is not supported
  fn f() { let a: f64 = 1.0; }
                        ^^^"#,
    ),
    (
        r#"fn f() { let a = f64(1.0); }
"#,
        r#"shader:1:18: error: 64-bit floating point is not supported
  fn f() { let a = f64(1.0); }
                   ^^^^^^^^"#,
    ),
    (
        r#"struct S { a: f32, b: vec2<f64> }
"#,
        r#"shader:1:1: error: 64-bit floating point is not supported
  struct S { a: f32, b: vec2<f64> }
  ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"var<private> m: mat2x2<f64>;
"#,
        r#"shader:1:1: error: 64-bit floating point is not supported
  var<private> m: mat2x2<f64>;
  ^^^^^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"fn f(a: f64) -> f32 { return 1.0; }
"#,
        r#"shader:1:1: error: 64-bit floating point is not supported
  fn f(a: f64) -> f32 { return 1.0; }
  ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"var<private> sum: i16;
"#,
        r#"shader:1:19: error: this needs the extension `wgpu_int16`, which is not supported
  var<private> sum: i16;
                    ^^^"#,
    ),
    (
        r#"@group(0) @binding(0) var t: texture_external;
"#,
        r#"shader:1:23: error: external textures are not supported
  @group(0) @binding(0) var t: texture_external;
                        ^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"enable wgpu_binding_array;
@group(0) @binding(0) var t: binding_array<texture_2d<f32>, 4>;
"#,
        r#"shader:1:8: error: the extension `wgpu_binding_array` is not supported
  enable wgpu_binding_array;
         ^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"@fragment fn main(@builtin(view_index) i: u32) { }
"#,
        r#"shader:1:14: error: input `i` of `main`: multiview is not supported
  @fragment fn main(@builtin(view_index) i: u32) { }
               ^^^^"#,
    ),
    (
        r#"enable f17;
"#,
        r#"shader:1:8: error: unknown enable-extension `f17`
  enable f17;
         ^^^
  help: See available extensions at <https://www.w3.org/TR/WGSL/#enable-extension>"#,
    ),
    (
        r#"enable subgroups;
@compute @workgroup_size(64) fn main() { let x = subgroupAdd(1lu); }
"#,
        r#"shader:2:50: error: sums of 64-bit integers in subgroups are not supported
  @compute @workgroup_size(64) fn main() { let x = subgroupAdd(1lu); }
                                                   ^^^^^^^^^^^"#,
    ),
    (
        r#"var<workgroup> w: array<f32, 4>;
@fragment fn main() -> @location(0) f32 { return w[0]; }
"#,
        r#"shader:1:1: error: `w` is memory of a work-group, and `main` has none
  var<workgroup> w: array<f32, 4>;
  ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
  help: only compute shaders have work-groups"#,
    ),
];

#[test]
fn errors_tell_the_place_and_what_to_do() {
    assert_eq!(errors::wgsl(CASES), 25);
}
