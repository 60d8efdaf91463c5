//! Wrong WGSL: the exact messages.

use super::errors;

/// A shader that is wrong, and what is said of it.
const CASES: &[(&str, &str)] = &[
    (
        r#"@fragment fn main() -> @location(0) vec4f {
    let x = 1.0
    return vec4f(x);
}
"#,
        r#"shader:3:5: error: expected `;`, found "return"
      return vec4f(x);
      ^^^^^^"#,
    ),
    (
        r#"@fragment fn main() -> @location(0) vec4f {
    let colour = vec4f(1.0);
    return colur;
}
"#,
        r#"shader:3:12: error: no definition in scope for identifier: `colur`
      return colur;
             ^^^^^
  help: did you mean `colour`?"#,
    ),
    (
        r#"@fragment fn main() -> @location(0) vec4f {
    return vec4f(sine(1.0));
}
"#,
        r#"shader:2:18: error: no definition in scope for identifier: `sine`
      return vec4f(sine(1.0));
                   ^^^^
  help: did you mean `sin`?"#,
    ),
    (
        r#"@fragment fn main() -> @location(0) vec4f {
    return vec4f(normalise(vec3f(1.0)), 1.0);
}
"#,
        r#"shader:2:18: error: no definition in scope for identifier: `normalise`
      return vec4f(normalise(vec3f(1.0)), 1.0);
                   ^^^^^^^^^
  help: did you mean `normalize`?"#,
    ),
    (
        r#"var<private> a: vec3ff;
@fragment fn main() -> @location(0) vec4f {
    return vec4f();
}
"#,
        r#"shader:1:17: error: no definition in scope for identifier: `vec3ff`
  var<private> a: vec3ff;
                  ^^^^^^
  help: did you mean `vec3f`?"#,
    ),
    (
        r#"@fragment fn main() -> @location(0) vec4f {
    let x: f32 = vec2f(1.0);
    return vec4f(x);
}
"#,
        r#"shader:2:9: error: the type of `x` is expected to be `f32`, but got `vec2<f32>`
      let x: f32 = vec2f(1.0);
          ^"#,
    ),
    (
        r#"@fragment fn main() -> @location(0) vec4f {
    return vec3f(1.0);
}
"#,
        r#"shader:2:12: error: this returns `vec3<f32>`, but the function returns `vec4<f32>`
      return vec3f(1.0);
             ^^^^^^^^^^"#,
    ),
    (
        r#"@fragment fn main() -> @location(0) vec4f {
    let i = 1i;
    return vec4f(1.0) * i;
}
"#,
        r#"shader:3:12: error: `*` does not work with `vec4<f32>` and `i32`
      return vec4f(1.0) * i;
             ^^^^^^^^^^^^^^"#,
    ),
    (
        r#"@fragment fn main() -> @location(0) vec4f {
    let a = vec3f(1.0);
    let b = vec2f(1.0);
    return vec4f(a + b, 1.0);
}
"#,
        r#"shader:4:18: error: `+` does not work with `vec3<f32>` and `vec2<f32>`
      return vec4f(a + b, 1.0);
                   ^^^^^"#,
    ),
    (
        r#"@fragment fn main() -> @location(0) vec4f {
    if (1.0) { return vec4f(); }
    return vec4f(1.0);
}
"#,
        r#"shader:2:9: error: the condition is `f32`, not `bool`
      if (1.0) { return vec4f(); }
          ^^^"#,
    ),
    (
        r#"@fragment fn main() -> @location(0) vec4f {
    let x = 1.0;
    x = 2.0;
    return vec4f(x);
}
"#,
        r#"shader:3:5: error: invalid left-hand side of assignment
      x = 2.0;
      ^
  help: line 2: this is an immutable binding; consider declaring `x` with `var` instead of `let`"#,
    ),
    (
        r#"fn f(x: f32) -> f32 {
    if (x > 0.0) { return 1.0; }
}
@fragment fn main() -> @location(0) vec4f {
    return vec4f(f(1.0));
}
"#,
        r#"shader:1:1: error: function `f` must return `f32` on every path
  fn f(x: f32) -> f32 {
  ^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"fn f(x: f32) -> f32 { return x; }
@fragment fn main() -> @location(0) vec4f {
    return vec4f(f(1.0, 2.0));
}
"#,
        r#"shader:3:18: error: `f` takes 1 argument, but 2 are given
      return vec4f(f(1.0, 2.0));
                   ^^^^^^^^^^^"#,
    ),
    (
        r#"fn f(x: f32) -> f32 { return x; }
@fragment fn main() -> @location(0) vec4f {
    return vec4f(f(vec2f(1.0)));
}
"#,
        r#"shader:3:18: error: argument `x` of `f` is `f32`, but `vec2<f32>` is given
      return vec4f(f(vec2f(1.0)));
                   ^^^^^^^^^^^^^"#,
    ),
    (
        r#"@fragment fn main() -> @location(0) vec4f {
    let v = vec2f(1.0);
    return vec4f(v.z);
}
"#,
        r#"shader:3:20: error: invalid field accessor `z`
      return vec4f(v.z);
                     ^"#,
    ),
    (
        r#"struct S { a: f32 }
@fragment fn main() -> @location(0) vec4f {
    var s: S;
    return vec4f(s.b);
}
"#,
        r#"shader:4:20: error: invalid field accessor `b`
      return vec4f(s.b);
                     ^"#,
    ),
    (
        r#"@fragment fn main() -> @location(0) vec4f {
    var a = array<f32, 3>(1.0, 2.0, 3.0);
    return vec4f(a[5]);
}
"#,
        r#"shader:3:18: error: index 5 is beyond the end of array of 3 `f32`
      return vec4f(a[5]);
                   ^^^^"#,
    ),
    (
        r#"#import noise::fbm
@fragment fn main() -> @location(0) vec4f { return vec4f(1.0); }
"#,
        r##"shader:1:1: error: expected global item (`struct`, `const`, `var`, `alias`, `fn`, `diagnostic`, `enable`, `requires`, `;`) or the end of the file, found "#"
  #import noise::fbm
  ^
  help: `#import` is of a preprocessor, and WGSL has none: give the text that the preprocessor makes of it"##,
    ),
    (
        r#"import noise::fbm;
@fragment fn main() -> @location(0) vec4f { return vec4f(1.0); }
"#,
        r##"shader:1:1: error: expected global item (`struct`, `const`, `var`, `alias`, `fn`, `diagnostic`, `enable`, `requires`, `;`) or the end of the file, found "import"
  import noise::fbm;
  ^^^^^^
  help: `import` is of a preprocessor, and WGSL has none: give the text that the preprocessor makes of it"##,
    ),
    (
        r#"@if(FOG) const density = 0.5;
@fragment fn main() -> @location(0) vec4f { return vec4f(1.0); }
"#,
        r##"shader:1:2: error: unknown attribute: `if`
  @if(FOG) const density = 0.5;
   ^^
  help: `if` is of a preprocessor, and WGSL has none: give the text that the preprocessor makes of it"##,
    ),
    (
        r#"[[group(0), binding(0)]] var<uniform> tint: vec4<f32>;
"#,
        r##"shader:1:1: error: expected global item (`struct`, `const`, `var`, `alias`, `fn`, `diagnostic`, `enable`, `requires`, `;`) or the end of the file, found "["
  [[group(0), binding(0)]] var<uniform> tint: vec4<f32>;
  ^
  help: write attributes as in `@location(0)`"##,
    ),
];

/// Rows: G2
#[test]
fn errors_tell_the_place_and_what_to_do() {
    assert_eq!(errors::wgsl(CASES), 21);
}
