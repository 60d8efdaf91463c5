//! Wrong GLSL, found by the tokens and the preprocessor: the exact messages.

use super::errors;

/// A shader that is wrong, and what is said of it.
const CASES: &[(&str, &str)] = &[
    (
        r#"#version 330 core
out vec4 color;
void main() {
    color = vec4(1.0);
"#,
        r#"shader:3:13: error: this `{` is not closed
  void main() {
              ^
  help: close it, or look for a bracket that is missing after it"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
void main() {
    color = vec4((1.0);
}
"#,
        r#"shader:5:1: error: `(` is not closed before this `}`
  }
  ^
  help: close the `(` first"#,
    ),
    (
        r#"#version 300
void main() {}
"#,
        r#"shader:1:10: error: there is no version 300 of GLSL
  #version 300
           ^^^
  help: write `#version 300 es`"#,
    ),
    (
        r#"#version 335 core
void main() {}
"#,
        r#"shader:1:10: error: there is no version 335 of GLSL
  #version 335 core
           ^^^
  help: use 110 to 460, or `100`, `300 es`, `310 es` or `320 es`"#,
    ),
    (
        r#"out vec4 c;
#version 330
void main() {}
"#,
        r#"shader:2:1: error: #version is not the first line
  #version 330
  ^^^^^^^^
  help: move it to the top: only comments may stand before it"#,
    ),
    (
        r#"#version 330 core
#ifdef X
void main() {}
"#,
        r#"shader:2:2: error: this condition has no end
  #ifdef X
   ^^^^^
  help: end it with `#endif`"#,
    ),
    (
        r#"#version 330 core
void main() {}
#endif
"#,
        r#"shader:3:2: error: #endif without #if
  #endif
   ^^^^^
  help: remove it, or begin the condition with `#if`, `#ifdef` or `#ifndef`"#,
    ),
    (
        r#"#version 330 core
#if QUALITY > 2
#endif
void main() {}
"#,
        r#"shader:2:5: error: the macro `QUALITY` is not defined
  #if QUALITY > 2
      ^^^^^^^
  help: define it, or ask with `defined(…)` or `#ifdef`"#,
    ),
    (
        r#"#version 330 core
#include "light.glsl"
void main() {}
"#,
        r#"shader:2:1: error: GLSL has no #include
  #include "light.glsl"
  ^^^^^^^^
  help: put the text of the file here before the shader is loaded"#,
    ),
    (
        r#"#version 330 core
#defien X 1
void main() {}
"#,
        r#"shader:2:1: error: there is no directive `#defien`
  #defien X 1
  ^^^^^^^
  help: did you mean `#define`?"#,
    ),
    (
        r#"#version 330 core
#error this shader needs X
void main() {}
"#,
        r#"shader:2:2: error: #error this shader needs X
  #error this shader needs X
   ^^^^^^^^^^^^^^^^^^^^^^^^^
  help: the shader stops here on purpose: see the conditions around it"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
#define SQ(x) ((x)*(x))
void main() {
    color = vec4(SQ(1.0, 2.0));
}
"#,
        r#"shader:5:18: error: the macro `SQ` takes 1 argument, but 2 are given
      color = vec4(SQ(1.0, 2.0));
                   ^^^^^^^^^^^^"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
#define SQ(x) ((x)*(x))
void main() {
    color = vec4(SQ(y));
}
"#,
        r#"shader:5:21: error: `y` is not declared
      color = vec4(SQ(y));
                      ^
  help: declare it before it is used"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
void main() {
    color = "red";
}
"#,
        r#"shader:4:13: error: GLSL has no strings and no `"`
      color = "red";
              ^
  help: remove it"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
void main() {
    int i = 09;
    color = vec4(i);
}
"#,
        r#"shader:4:13: error: `09` begins with 0, so it is octal, but 8 and 9 are no octal digits
      int i = 09;
              ^^
  help: remove the leading 0"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
void main() {
    int i = 9999999999;
    color = vec4(i);
}
"#,
        r#"shader:4:13: error: `9999999999` does not fit into 32 bits
      int i = 9999999999;
              ^^^^^^^^^^
  help: use a smaller number"#,
    ),
    (
        r#"#version 330 core
out vec4 color;
void main() {
    float π = 3.14;
    color = vec4(π);
}
"#,
        r#"shader:4:11: error: GLSL has no character `π` (\u{3c0}) outside of comments
      float π = 3.14;
            ^
  help: remove it"#,
    ),
    (
        r#"#version 330 core
/* never closed
void main() {}
"#,
        r#"shader:2:1: error: this comment has no end
  /* never closed
  ^^
  help: close it with `*/`"#,
    ),
];

/// Rows: G1
#[test]
fn errors_tell_the_place_and_what_to_do() {
    assert_eq!(errors::glsl(CASES), 18);
}
