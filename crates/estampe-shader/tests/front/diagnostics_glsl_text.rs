//! Wrong directives, macros, numbers and characters in GLSL: the exact messages.

use super::errors;
use estampe_ir::interface::Stage;

/// Fragment shaders that are wrong, and what is said of them.
const FRAGMENT: &[(&str, &str)] = &[
    (
        r#"#version
void main() { }
"#,
        r#"shader:1:2: error: #version without a number
  #version
   ^^^^^^^
  help: use 110 to 460, or `100`, `300 es`, `310 es` or `320 es`"#,
    ),
    (
        r#"#version 330 extended
void main() { }
"#,
        r#"shader:1:14: error: there is no profile `extended` of GLSL
  #version 330 extended
               ^^^^^^^^
  help: use `core`, `compatibility` or `es`, or leave it out"#,
    ),
    (
        r#"#define
void main() { }
"#,
        r#"shader:1:2: error: #define without the name of a macro
  #define
   ^^^^^^"#,
    ),
    (
        r#"#undef 7
void main() { }
"#,
        r#"shader:1:8: error: `7` is no name of a macro
  #undef 7
         ^"#,
    ),
    (
        r#"#ifdef
#endif
void main() { }
"#,
        r#"shader:1:2: error: #ifdef without the name of a macro
  #ifdef
   ^^^^^"#,
    ),
    (
        r#"#define defined 1
void main() { }
"#,
        r#"shader:1:9: error: `defined` cannot be a macro
  #define defined 1
          ^^^^^^^"#,
    ),
    (
        r#"#define SUM(a, 2) a
void main() { }
"#,
        r#"shader:1:16: error: the parameters of this macro are not a list of names
  #define SUM(a, 2) a
                 ^
  help: write `#define NAME(a, b) …`"#,
    ),
    (
        r#"#define SUM(a, a) a
void main() { }
"#,
        r#"shader:1:16: error: there are two parameters `a`
  #define SUM(a, a) a
                 ^"#,
    ),
    (
        r#"#if 0
#else
#elif 1
#endif
void main() { }
"#,
        r#"shader:3:2: error: #elif after #else
  #elif 1
   ^^^^
  help: #else is the last branch"#,
    ),
    (
        r#"#if defined
#endif
void main() { }
"#,
        r#"shader:1:5: error: `defined` asks for the name of a macro
  #if defined
      ^^^^^^^
  help: write `defined(NAME)`"#,
    ),
    (
        r#"#if 1 2
#endif
void main() { }
"#,
        r#"shader:1:7: error: `2` does not belong here
  #if 1 2
        ^
  help: the expression ends before it"#,
    ),
    (
        r#"#if 1 / 0
#endif
void main() { }
"#,
        r#"shader:1:7: error: this divides by zero
  #if 1 / 0
        ^"#,
    ),
    (
        r#"#if
#endif
void main() { }
"#,
        r#"shader:1:2: error: an integer expression is missing here
  #if
   ^^
  help: write a number, or numbers with operators"#,
    ),
    (
        r#"#if 1.5
#endif
void main() { }
"#,
        r#"shader:1:5: error: `1.5` is no integer
  #if 1.5
      ^^^"#,
    ),
    (
        r#"#if 2 * *
#endif
void main() { }
"#,
        r#"shader:1:9: error: expected an integer, found `*`
  #if 2 * *
          ^"#,
    ),
    (
        r#"#if (1
#endif
void main() { }
"#,
        r#"shader:1:5: error: this `(` is not closed
  #if (1
      ^
  help: add `)`"#,
    ),
    (
        r#"#define SUM(a, b) a + b
void main() { float x = SUM(1.0, 2.0; }
"#,
        r#"shader:2:25: error: the arguments of the macro `SUM` have no end
  void main() { float x = SUM(1.0, 2.0; }
                          ^^^
  help: close them with `)`"#,
    ),
    (
        r#"out vec4 c;
void main() { c = vec4(1e60); }
"#,
        r#"shader:2:24: error: `1e60` does not fit into 32-bit floating point
  void main() { c = vec4(1e60); }
                         ^^^^
  help: the largest number is about 3.4e38"#,
    ),
    (
        r#"out vec4 c;
void main() { c = vec4(1.0g); }
"#,
        r#"shader:2:24: error: `1.0g` is no number
  void main() { c = vec4(1.0g); }
                         ^^^^
  help: write it like `1.0` or `1e-3`"#,
    ),
    (
        r#"out vec4 c;
void main() { int i = 0xg; }
"#,
        r#"shader:2:23: error: `0xg` is no number
  void main() { int i = 0xg; }
                        ^^^
  help: write it like `1`, `1u` or `0xff`"#,
    ),
    (
        r#"out vec4 c;
void main() { c = vec4(`1.0); }
"#,
        r#"shader:2:24: error: GLSL has no character ```
  void main() { c = vec4(`1.0); }
                         ^
  help: remove it"#,
    ),
    (
        r#"out vec4 c
void main() { c = vec4(1.0); }
"#,
        r#"shader:1:11: error: expected `;`
  out vec4 c
            ^
  help: add `;` after `c`"#,
    ),
    (
        r#"out vec4
"#,
        r#"shader:1:5: error: expected a name, found the end of the shader
  out vec4
      ^^^^"#,
    ),
];

#[test]
fn errors_tell_the_place_and_what_to_do() {
    assert_eq!(errors::in_stage(Stage::Fragment, FRAGMENT), 23);
}
