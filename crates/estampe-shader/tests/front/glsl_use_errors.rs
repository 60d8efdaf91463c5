//! GLSL that does not use the language as it is: the exact messages, at the author's places.

use super::errors;

/// A shader that is wrong, and what is said of it.
const CASES: &[(&str, &str)] = &[
    (
        r#"#version 330 core
out vec4 color;
uniform sampler2D tex;
void main() {
    vec4 c = tex;
    color = c;
}
"#,
        r#"shader:5:14: error: the sampler `tex` can only be handed to a function
      vec4 c = tex;
               ^^^
  help: read it with `texture(tex, …)` or `texelFetch(tex, …)`"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
uniform sampler2D maps[2];
vec4 middle(sampler2D map) { return texture(map, vec2(0.5)); }
void main() {
    color = vec4(0.0);
    for (int i = 0; i < 2; i++) color += middle(maps[i]);
}
"#,
        r#"shader:7:53: error: samplers need a constant index
      for (int i = 0; i < 2; i++) color += middle(maps[i]);
                                                      ^^^
  help: use an array texture, such as `sampler2DArray`, or `switch`"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
uniform sampler2D tex;
void main() {
    color = texture(tex, 0.5);
}
"#,
        r#"shader:5:13: error: `texture` does not take these arguments
      color = texture(tex, 0.5);
              ^^^^^^^^^^^^^^^^^
  help: compare the number of the arguments and their types with the language's"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
void main() {
    color = gl_FragCoords;
}
"#,
        r#"shader:4:13: error: a fragment shader has no variable `gl_FragCoords`
      color = gl_FragCoords;
              ^^^^^^^^^^^^^
  help: did you mean `gl_FragCoord`?"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
void main() {
    color = gl_Color;
}
"#,
        r#"shader:4:13: error: `gl_Color` is not supported
      color = gl_Color;
              ^^^^^^^^
  help: declare an input, such as `in vec3 position;`"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
uniform int n;
float a[n];
void main() {
    color = vec4(a[0]);
}
"#,
        r#"shader:4:9: error: `n` has no integer value here
  float a[n];
          ^
  help: use constant integers: numbers, macros, `const int`"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
void main() {
    float a[3];
    color = vec4(a[5]);
}
"#,
        r#"shader:5:19: error: index 5 is beyond the end of array of 3 `float`
      color = vec4(a[5]);
                    ^^^"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
uniform sampler2D x = 1;
void main() {
    color = texture(x, vec2(0));
}
"#,
        r#"shader:3:19: error: the uniform `x` holds a texture, which cannot have a value
  uniform sampler2D x = 1;
                    ^
  help: remove `= …`, and bind the texture in the program"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
void main() {
    double d = 1.0lf;
    color = vec4(d);
}
"#,
        r#"shader:4:16: error: 64-bit floating point is not supported
      double d = 1.0lf;
                 ^^^^^
  help: remove the suffix `lf`"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
layout(locatoin = 0) in vec3 n;
void main() {
    color = vec4(1.0);
}
"#,
        r#"shader:3:8: error: `layout` has no word `locatoin`
  layout(locatoin = 0) in vec3 n;
         ^^^^^^^^
  help: did you mean `location`?"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
void main() {
    float x = 1.0;
    float x = 2.0;
    color = vec4(x);
}
"#,
        r#"shader:5:11: error: `x` is declared twice
      float x = 2.0;
            ^^^^^^^
  help: rename one of them"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
const float N;
void main() {
    color = vec4(N);
}
"#,
        r#"shader:3:13: error: the constant `N` has no value
  const float N;
              ^
  help: add `= …`"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
const float N = 1.0;
void main() {
    N = 2.0;
    color = vec4(N);
}
"#,
        r#"shader:5:5: error: this cannot be assigned to
      N = 2.0;
      ^
  help: inputs, uniforms and constants are read only: copy them to a variable"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
struct A { float x; };
struct A { float y; };
void main() {
    color = vec4(1.0);
}
"#,
        r#"shader:4:1: error: there are two structures `A`
  struct A { float y; };
  ^^^^^^
  help: rename one of them"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
color = vec4(1.0);
void main() { }
"#,
        r#"shader:3:1: error: a statement outside of a function
  color = vec4(1.0);
  ^^^^^
  help: move it into a function, such as `void main() { … }`"#,
    ),
    (
        r#"#version 330 core
fn main() -> vec4f { return vec4f(); }
"#,
        r#"shader:2:1: error: there is no type `fn`
  fn main() -> vec4f { return vec4f(); }
  ^^
  help: this looks like WGSL: load it as WGSL"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
void main() {
    float in = 1.0;
    color = vec4(in);
}
"#,
        r#"shader:4:11: error: `in` is a word of the language
      float in = 1.0;
            ^^
  help: choose another name"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
uniform sampler2D tex;
void main() {
    color = textureGather(tex, vec2(0.5), 4);
}
"#,
        r#"shader:5:13: error: the arguments of `textureGather` are not known
      color = textureGather(tex, vec2(0.5), 4);
              ^^^^^^^^^^^^^
  help: the component is a constant, 0 to 3, and so is the offset, an `ivec2`"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
in vec4 tint;
void main() {
    color = interpolateAtCentroid(tint);
}
"#,
        r#"shader:5:13: error: `interpolateAtCentroid` is not supported
      color = interpolateAtCentroid(tint);
              ^^^^^^^^^^^^^^^^^^^^^^^^^^^
  help: do without it"#,
    ),
    (
        r#"#version 430
layout(local_size_x = 1) in;
void main() {
    uint count = 0u;
    atomicAdd(count, 1u);
}
"#,
        r#"shader:5:5: error: the first argument of an atomic function is a number of a buffer or of shared memory
      atomicAdd(count, 1u);
      ^^^^^^^^^
  help: give a member of a buffer that is an `int` or `uint`, an element of an array of them, or a `shared` variable"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
uniform sampler2D maps[2];
uniform int i;
void main() {
    color = texture(maps[i], texture(maps[i], vec2(0.5)).xy);
}
"#,
        r#"shader:6:43: error: this index of samplers is not simple enough
      color = texture(maps[i], texture(maps[i], vec2(0.5)).xy);
                                            ^
  help: compute it before, and read one texture after the other"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
struct S { mat2 m; float x; };
void main() {
    S s;
    color = vec4(s.x);
}
"#,
        r#"shader:3:17: error: a structure cannot hold a matrix of 2 columns and 2 rows
  struct S { mat2 m; float x; };
                  ^
  help: hold its columns, each as a `vec2`, and build the matrix where it is used"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
struct M { sampler2D t; float k; };
uniform M m;
vec4 f(M q) { return vec4(q.k); }
void main() {
    color = f(m);
}
"#,
        r#"shader:5:10: error: `M` holds samplers, which a parameter cannot
  vec4 f(M q) { return vec4(q.k); }
           ^
  help: hand over each sampler as a parameter of its own"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
void main() {
    break;
}
"#,
        r#"shader:4:5: error: `break` outside of a loop or `switch`
      break;
      ^^^^^"#,
    ),
    (
        r#"#version 330 core
out bool b;
void main() { b = true; }
"#,
        r#"shader:2:10: error: `b` cannot be handed from stage to stage
  out bool b;
           ^
  help: use an `int` in the place of a `bool`, and give arrays a size"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
void main() {
    color = true ? vec4(1.0) : vec3(1.0);
}
"#,
        r#"shader:4:13: error: `vec3` cannot be assigned to `vec4`
      color = true ? vec4(1.0) : vec3(1.0);
              ^^^^^^^^^^^^^^^^^^^^^^^^^^^^"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
float f(float x) { return f(x - 1.0); }
void main() {
    color = vec4(f(1.0));
}
"#,
        r#"shader:3:27: error: `f` calls itself, or is called with other arguments than it takes
  float f(float x) { return f(x - 1.0); }
                            ^^^^^^^^^^
  help: functions of GLSL cannot call themselves: use a loop"#,
    ),
];

#[test]
fn errors_tell_the_place_and_what_to_do() {
    assert_eq!(errors::glsl(CASES), 27);
}
