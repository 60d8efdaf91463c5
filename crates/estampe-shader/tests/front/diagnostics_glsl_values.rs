//! Wrong expressions and calls in GLSL: the exact messages.

use super::errors;
use estampe_ir::interface::Stage;

/// Fragment shaders that are wrong, and what is said of them.
const FRAGMENT: &[(&str, &str)] = &[
    (
        r#"uniform sampler2D maps[2];
out vec4 c;
void main() { c = texture(maps[2], vec2(0.0)); }
"#,
        r#"shader:3:31: error: index 2 is beyond the end of `maps`
  void main() { c = texture(maps[2], vec2(0.0)); }
                                ^^^
  help: use 0 to 1"#,
    ),
    (
        r#"uniform int i;
void main() { gl_FragData[i] = vec4(1.0); }
"#,
        r#"shader:2:15: error: `gl_FragData` needs a constant index
  void main() { gl_FragData[i] = vec4(1.0); }
                ^^^^^^^^^^^
  help: use 0 to 7"#,
    ),
    (
        r#"out vec4 c;
void main() { c = vec4(1.0) * ; }
"#,
        r#"shader:2:31: error: expected a value, found `;`
  void main() { c = vec4(1.0) * ; }
                                ^
  help: write a number, a name, or `(`"#,
    ),
    (
        r#"out vec4 c;
void main() { float x = 1.0 c = vec4(x); }
"#,
        r#"shader:2:29: error: expected `,` or `;`, found `c`
  void main() { float x = 1.0 c = vec4(x); }
                              ^
  help: a `;` or an operator is missing before `c`"#,
    ),
    (
        r#"out vec4 c;
void f() { }
void main() { c = f(); }
"#,
        r#"shader:3:19: error: the function returns nothing
  void main() { c = f(); }
                    ^^^
  help: call it as a statement"#,
    ),
    (
        r#"out vec4 c;
float f(float x) { return x; }
float f(float y) { return y; }
void main() { c = vec4(f(1.0)); }
"#,
        r#"shader:3:7: error: there are two functions with this name and parameters
  float f(float y) { return y; }
        ^
  help: rename one of them"#,
    ),
    (
        r#"out vec4 c;
void main() { c.xx = vec2(1.0); }
"#,
        r#"shader:2:16: error: a component is assigned twice
  void main() { c.xx = vec2(1.0); }
                 ^^^
  help: name each one once"#,
    ),
    (
        r#"out vec4 c;
void main() { float x = 1.0; c = vec4(x.size); }
"#,
        r#"shader:2:40: error: this has no member `size`
  void main() { float x = 1.0; c = vec4(x.size); }
                                         ^^^^^
  help: only structures and vectors have members"#,
    ),
    (
        r#"out vec4 c;
void main() { 1.0 = 2.0; c = vec4(1.0); }
"#,
        r#"shader:2:15: error: this cannot be assigned to
  void main() { 1.0 = 2.0; c = vec4(1.0); }
                ^^^
  help: assign to a variable"#,
    ),
    (
        r#"out vec4 c;
void main() { for (int i = 0; i < 3) { } c = vec4(1.0); }
"#,
        r#"shader:2:36: error: expected `;`, found `)`
  void main() { for (int i = 0; i < 3) { } c = vec4(1.0); }
                                     ^
  help: a `;` or an operator is missing before `)`"#,
    ),
    (
        r#"out vec4 c;
void main() { return 1.0; }
"#,
        r#"shader:2:22: error: this returns a value, but the function returns nothing
  void main() { return 1.0; }
                       ^^^"#,
    ),
    (
        r#"#version 330
out vec4 c;
uniform int i;
void main() { switch (i) { c = vec4(0.0); } }
"#,
        r#"shader:4:28: error: expected `case`, `default` or `}`, found `c`
  void main() { switch (i) { c = vec4(0.0); } }
                             ^"#,
    ),
    (
        r#"out vec4 c;
void f(int a) { } void f(float b) { }
void main() { f(true); c = vec4(1.0); }
"#,
        r#"shader:3:15: error: several functions take these arguments
  void main() { f(true); c = vec4(1.0); }
                ^^^^^^^
  help: convert arguments"#,
    ),
    (
        r#"out vec4 c;
struct S { float a; };
void main() { S s; c = vec4(s.b); }
"#,
        r#"shader:3:30: error: there is no member `b`
  void main() { S s; c = vec4(s.b); }
                               ^^"#,
    ),
    (
        r#"out vec4 c;
void main() { c = sampler2D(1.0); }
"#,
        r#"shader:2:19: error: there is no function `sampler2D`
  void main() { c = sampler2D(1.0); }
                    ^^^^^^^^^^^^^^"#,
    ),
    (
        r#"#version 450
layout(set = 0, binding = 0) uniform texture2D t;
out vec4 c;
void main() { c = vec4(t); }
"#,
        r#"shader:4:19: error: argument 1 of `vec4` must not be texture
  void main() { c = vec4(t); }
                    ^^^^^^^"#,
    ),
    (
        r#"out vec4 c;
const float k = sqrt(-1.0);
const int z = 1 / 0;
void main() { c = vec4(k); }
"#,
        r#"shader: error: sqrt built-in function argument is out of valid range"#,
    ),
    (
        r#"out vec4 c;
void main() { float list[3]; c = vec4(list[-1]); }
"#,
        r#"shader:2:43: error: an index must not be negative
  void main() { float list[3]; c = vec4(list[-1]); }
                                            ^^^^"#,
    ),
    (
        r#"out vec4 c;
uniform vec4 unused
"#,
        r#"shader:2:14: error: expected `;`, found the end of the shader
  uniform vec4 unused
               ^^^^^^"#,
    ),
    (
        r#"out vec4 c;
void main() { int i = 1; c = vec4(i[0]); }
"#,
        r#"shader:2:36: error: this has no elements: only vectors, matrices and arrays have
  void main() { int i = 1; c = vec4(i[0]); }
                                     ^^^"#,
    ),
    (
        r#"out vec4 c;
void main() { float list[2]; c = vec4(list[1.5]); }
"#,
        r#"shader:2:43: error: an index must be an integer, not `float`
  void main() { float list[2]; c = vec4(list[1.5]); }
                                            ^^^^^"#,
    ),
    (
        r#"out vec4 c;
void main() { c = vec4(!1.0); }
"#,
        r#"shader:2:24: error: this operator does not work with a value of this type
  void main() { c = vec4(!1.0); }
                         ^^^^"#,
    ),
    (
        r#"out vec4 c;
void main() { c = sin(vec4(true)); c = vec4(sin(true)); }
"#,
        r#"shader: error: a function is called with a constant of a type that it does not take"#,
    ),
    (
        r#"flat
"#,
        r#"shader:1:1: error: expected a declaration, found the end of the shader
  flat
  ^^^^"#,
    ),
    (
        r#"out vec4 c;
void main() { c = vec4(float(1.0, 2.0)); }
"#,
        r#"shader:2:24: error: the constructor has too many arguments
  void main() { c = vec4(float(1.0, 2.0)); }
                         ^^^^^^^^^^^^^^^
  help: remove some"#,
    ),
    (
        r#"out vec4 c;
void main() { c = vec4(mat2(1.0, 2.0, 3.0, 4.0, 5.0)[0], 1.0, 1.0); }
"#,
        r#"shader:2:24: error: constructor expects 2 components, found 1
  void main() { c = vec4(mat2(1.0, 2.0, 3.0, 4.0, 5.0)[0], 1.0, 1.0); }
                         ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"out vec4 c;
void main() { float list[2] = float[2](1.0, 2.0, 3.0); c = vec4(list[0]); }
"#,
        r#"shader:2:31: error: array of 2 `float` is built from 2 components, but 3 are given
  void main() { float list[2] = float[2](1.0, 2.0, 3.0); c = vec4(list[0]); }
                                ^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"out vec4 c;
struct S { float a; };
void main() { c = vec4(S(1.0)); }
"#,
        r#"shader:3:19: error: constructor must only contain vector or scalar arguments
  void main() { c = vec4(S(1.0)); }
                    ^^^^^^^^^^^^"#,
    ),
    (
        r#"out vec4 c;
void main() { vec4[2] a; c = vec4[2](1.0, 2.0)[0]; }
"#,
        r#"shader:2:30: error: argument 1 of array of 2 `vec4` must not be `float`
  void main() { vec4[2] a; c = vec4[2](1.0, 2.0)[0]; }
                               ^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"out vec4 c;
void main() { struct { float a } s; }
"#,
        r#"shader:2:22: error: expected a name, found `{`
  void main() { struct { float a } s; }
                       ^"#,
    ),
    (
        r#"out vec4 c;
float a[2];
void main() { c = vec4(a + 1.0); }
"#,
        r#"shader:3:24: error: `+` does not work with array of 2 `float` and `float`
  void main() { c = vec4(a + 1.0); }
                         ^^^^^^^"#,
    ),
    (
        r#"out vec4 c;
float a[2];
void main() { if (a == a) { } c = vec4(a > 1.0); }
"#,
        r#"shader:3:40: error: this operator does not work with values of these types
  void main() { if (a == a) { } c = vec4(a > 1.0); }
                                         ^"#,
    ),
    (
        r#"#define ONE(a, b) a
void main() { ONE(1, 2, 3); }
"#,
        r#"shader:2:15: error: the macro `ONE` takes 2 arguments, but 3 are given
  void main() { ONE(1, 2, 3); }
                ^^^^^^^^^^^^"#,
    ),
];

#[test]
fn errors_tell_the_place_and_what_to_do() {
    assert_eq!(errors::in_stage(Stage::Fragment, FRAGMENT), 33);
}
