//! GLSL with wrong names, types and functions: the exact messages.

use super::errors;

/// A shader that is wrong, and what is said of it.
const CASES: &[(&str, &str)] = &[
    (
        r#"#version 330 core
out vec4 color;
void main() {
    float x = 1.0
    color = vec4(x);
}
"#,
        r#"shader:5:5: error: expected `,` or `;`, found `color`
      color = vec4(x);
      ^^^^^
  help: a `;` is missing at the end of the line before"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
void main() {
    vec3 light = vec3(1.0);
    color = vec4(ligth, 1.0);
}
"#,
        r#"shader:5:18: error: `ligth` is not declared
      color = vec4(ligth, 1.0);
                   ^^^^^
  help: did you mean `light`?"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
void main() {
    color = vec4(normalise(vec3(1.0)), 1.0);
}
"#,
        r#"shader:4:18: error: there is no function `normalise`
      color = vec4(normalise(vec3(1.0)), 1.0);
                   ^^^^^^^^^^^^^^^^^^^^
  help: did you mean `normalize`?"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
uniform vec5 tint;
void main() {
    color = tint;
}
"#,
        r#"shader:3:9: error: there is no type `vec5`
  uniform vec5 tint;
          ^^^^
  help: did you mean `vec2`?"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
void main() {
    vec5 x = vec4(1.0);
    color = x;
}
"#,
        r#"shader:4:5: error: there is no type `vec5`
      vec5 x = vec4(1.0);
      ^^^^
  help: did you mean `vec2`?"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
void main() {
    vec3 n = vec4(1.0);
    color = vec4(n, 1.0);
}
"#,
        r#"shader:4:5: error: the value given to `n` has another type than the variable
      vec3 n = vec4(1.0);
      ^^^^"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
void main() {
    color = vec4(vec3(1.0) + vec2(1.0), 1.0);
}
"#,
        r#"shader:4:18: error: `+` does not work with `vec3` and `vec2`
      color = vec4(vec3(1.0) + vec2(1.0), 1.0);
                   ^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
void main() {
    if (1.0) color = vec4(1.0);
}
"#,
        r#"shader:4:9: error: the condition is `float`, not `bool`
      if (1.0) color = vec4(1.0);
          ^^^"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
uniform vec4 tint;
void main() {
    tint = vec4(1.0);
    color = tint;
}
"#,
        r#"shader:5:5: error: the uniform `tint` cannot be assigned to
      tint = vec4(1.0);
      ^^^^
  help: inputs, uniforms and constants are read only: copy them to a variable"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
in vec3 n;
void main() {
    n = vec3(1.0);
    color = vec4(n, 1.0);
}
"#,
        r#"shader:5:5: error: this cannot be assigned to
      n = vec3(1.0);
      ^
  help: inputs, uniforms and constants are read only: copy them to a variable"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
void main() {
    vec2 v = vec2(1.0);
    color = vec4(v.z);
}
"#,
        r#"shader:5:19: error: the vector has no components `z`
      color = vec4(v.z);
                    ^^
  help: use x, y, z, w or r, g, b, a, as many as the vector has"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
struct Light { vec3 colour; };
void main() {
    Light l;
    color = vec4(l.color, 1.0);
}
"#,
        r#"shader:6:19: error: there is no member `color`
      color = vec4(l.color, 1.0);
                    ^^^^^^
  help: did you mean `colour`?"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
float f(float x) { return x; }
void main() {
    color = vec4(f(1.0, 2.0));
}
"#,
        r#"shader:5:18: error: no function `f` takes these arguments
      color = vec4(f(1.0, 2.0));
                   ^^^^^^^^^^^
  help: compare the number of the arguments and their types with its parameters"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
float f(float x) { return vec2(x); }
void main() {
    color = vec4(f(1.0));
}
"#,
        r#"shader:3:27: error: this returns `vec2`, but the function returns `float`
  float f(float x) { return vec2(x); }
                            ^^^^^^^"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
float f(float x) { if (x > 0.0) return 1.0; }
void main() {
    color = vec4(f(1.0));
}
"#,
        r#"shader:3:7: error: function `f` must return `float` on every path
  float f(float x) { if (x > 0.0) return 1.0; }
        ^"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
void man() { color = vec4(1.0); }
"#,
        r#"shader: error: the shader has no `main`
  help: add `void main() { … }`"#,
    ),
];

#[test]
fn errors_tell_the_place_and_what_to_do() {
    assert_eq!(errors::glsl(CASES), 16);
}
