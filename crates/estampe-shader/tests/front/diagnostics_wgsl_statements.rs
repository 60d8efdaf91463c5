//! Wrong declarations and statements in WGSL: the exact messages.

use super::errors;

/// A shader that is wrong, and what is said of it.
const CASES: &[(&str, &str)] = &[
    (
        r#"fn g(p: ptr<function, f32>) { }
fn f() { var x = vec2f(); g(&x.x); }
"#,
        r#"shader:2:30: error: cannot take the address of a vector component
  fn f() { var x = vec2f(); g(&x.x); }
                               ^^^
  help: invalid operand for address-of"#,
    ),
    (
        r#"fn f() { var x = 1i; let y = x[0]; }
"#,
        r#"shader: error: this has no such element or member: only vectors, matrices, arrays and structures have"#,
    ),
    (
        r#"fn f() { let x = 1.0 }
"#,
        r#"shader:1:22: error: expected `;`, found "}"
  fn f() { let x = 1.0 }
                       ^"#,
    ),
    (
        r#"fn f() { x = }
"#,
        r#"shader:1:14: error: expected expression, found "}"
  fn f() { x = }
               ^"#,
    ),
    (
        r#"fn f() { loop { continuing { return; } } }
"#,
        r#"shader:1:30: error: the `return` is called within a `continuing` block
  fn f() { loop { continuing { return; } } }
                               ^^^^^^^"#,
    ),
    (
        r#"fn f(x: i32) { switch x { case 1: { } } }
"#,
        r#"shader:1:16: error: the `switch` is missing a `default` case
  fn f(x: i32) { switch x { case 1: { } } }
                 ^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"fn f(x: i32) { switch x { default: { } default: { } } }
"#,
        r#"shader:1:1: error: multiple `default` cases are present
  fn f(x: i32) { switch x { default: { } default: { } } }
  ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"struct S { @size(2) a: f32 }
"#,
        r#"shader:1:18: error: struct member size must be at least 4
  struct S { @size(2) a: f32 }
                   ^"#,
    ),
    (
        r#"struct S { @align(3) a: f32 }
"#,
        r#"shader:1:19: error: struct member alignment must be a power of 2
  struct S { @align(3) a: f32 }
                    ^"#,
    ),
    (
        r#"@group(0) @binding(0) var<storage, read_write> a: array<u32>;
@compute @workgroup_size(1) fn main() { let p = &a; let n = arrayLength(a); }
"#,
        r#"shader:2:73: error: this cannot be loaded as a value
  @compute @workgroup_size(1) fn main() { let p = &a; let n = arrayLength(a); }
                                                                          ^"#,
    ),
    (
        r#"@group(0) @binding(0) var t: texture_2d<f32>;
@fragment fn main() -> @location(0) vec4f { return textureLoad(t, vec2i(), 1.5f); }
"#,
        r#"shader:2:52: error: the layer, mip level or sample is not an integer
  @fragment fn main() -> @location(0) vec4f { return textureLoad(t, vec2i(), 1.5f); }
                                                     ^^^^^^^^^^^"#,
    ),
    (
        r#"fn f(a: f32) { }
fn g() { let x = f(1.0); }
"#,
        r#"shader:2:18: error: function does not return any value
  fn g() { let x = f(1.0); }
                   ^^^^^^
  help: perhaps you meant to call the function in a separate statement?"#,
    ),
    (
        r#"@must_use fn f() -> f32 { return 1.0; }
fn g() { f(); }
"#,
        r#"shader:2:10: error: unused return value from function annotated with @must_use
  fn g() { f(); }
           ^
  help: function 'f' is declared with `@must_use` attribute; use a phony assignment or declare a value using the function call as the initializer"#,
    ),
    (
        r#"fn f() { continue; }
"#,
        r#"shader:1:10: error: `continue` outside of a loop
  fn f() { continue; }
           ^^^^^^^^^"#,
    ),
    (
        r#"fn g(x: ptr<storage, f32>) { }
"#,
        r#"shader:1:1: error: parameter `x` is a pointer to memory of another kind than `function`, `private` and `workgroup`
  fn g(x: ptr<storage, f32>) { }
  ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"fn f() { let x = 1.0
"#,
        r#"shader:2:1: error: expected `;`, found the end of the file
  
  ^"#,
    ),
    (
        r#"fn f() {
    let x = y;
    let z = unknwn(1.0);
}
"#,
        r#"shader:2:13: error: no definition in scope for identifier: `y`
      let x = y;
              ^"#,
    ),
    (
        r#"const_assert 1 > 2;
"#,
        r#"shader:1:14: error: `const_assert` failure
  const_assert 1 > 2;
               ^^^^^
  help: evaluates to `false`"#,
    ),
    (
        r#"@fragment fn main(@location(0) @interpolate(flat) v: u64) { }
"#,
        r#"shader:1:14: error: @location(0) of `main` is `u64`, but numbers of 64 bits are neither inputs nor outputs
  @fragment fn main(@location(0) @interpolate(flat) v: u64) { }
               ^^^^
  help: pass the low and the high 32 bits apart"#,
    ),
    (
        r#"fn f() { let p = &1.0; }
"#,
        r#"shader:1:18: error: the operand of the `&` operator must be a reference
  fn f() { let p = &1.0; }
                   ^^^^
  help: expression is not a reference"#,
    ),
    (
        r#"fn f() { let x = textureSample(1.0, 2.0, 3.0); }
"#,
        r#"shader:1:32: error: expected an image, but found `1.0` which is not an image
  fn f() { let x = textureSample(1.0, 2.0, 3.0); }
                                 ^^^"#,
    ),
    (
        r#"fn f() { let x = arrayLength(1.0); }
"#,
        r#"shader:1:18: error: constants don't support array length expressions
  fn f() { let x = arrayLength(1.0); }
                   ^^^^^^^^^^^"#,
    ),
    (
        r#"@group(0) @binding(0) var<storage, read_write> a: u32;
fn f() { atomicAdd(&a, 1u); }
"#,
        r#"shader:2:20: error: atomic operation is done on a pointer to a non-atomic
  fn f() { atomicAdd(&a, 1u); }
                     ^^
  help: atomic pointer is invalid"#,
    ),
];

#[test]
fn errors_tell_the_place_and_what_to_do() {
    assert_eq!(errors::wgsl(CASES), 23);
}
