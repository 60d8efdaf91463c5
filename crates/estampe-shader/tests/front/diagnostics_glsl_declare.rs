//! Wrong declarations in GLSL: the exact messages.

use super::errors;
use estampe_ir::interface::Stage;

/// Vertex shaders that are wrong, and what is said of them.
const VERTEX: &[(&str, &str)] = &[(
    r#"out struct { float a; };
void main() { }
"#,
    r#"shader:2:6: error: the vertex shader must write `gl_Position`
  void main() { }
       ^^^^"#,
)];

/// Fragment shaders that are wrong, and what is said of them.
const FRAGMENT: &[(&str, &str)] = &[
    (
        r#"out vec4 c;
Light { vec4 a; } light;
void main() { }
"#,
        r#"shader:2:1: error: what is `Light` for?
  Light { vec4 a; } light;
  ^^^^^
  help: write `struct`, `uniform`, `buffer`, `in` or `out` before it"#,
    ),
    (
        r#"uniform Light { vec4 a; } light[2];
void main() { }
"#,
        r#"shader:1:32: error: arrays of blocks are not supported
  uniform Light { vec4 a; } light[2];
                                 ^
  help: make one block with an array of structures"#,
    ),
    (
        r#"void v;
void main() { }
"#,
        r#"shader:1:6: error: the variable `v` cannot be `void`
  void v;
       ^
  help: give it a type such as `float`"#,
    ),
    (
        r#"void main()
int x;
"#,
        r#"shader:2:1: error: expected `{` or `;`, found `int`
  int x;
  ^^^"#,
    ),
    (
        r#"struct Empty { };
void main() { }
"#,
        r#"shader:1:1: error: `Empty` has no members, or too many
  struct Empty { };
  ^^^^^^
  help: a structure or block needs at least one member"#,
    ),
    (
        r#"struct Light { vec4 at; vec4 at; };
void main() { }
"#,
        r#"shader:1:30: error: there are two members `at`
  struct Light { vec4 at; vec4 at; };
                               ^^
  help: rename one of them"#,
    ),
    (
        r#"layout(row_major) uniform Block { mat4 m; };
void main() { }
"#,
        r#"shader:1:8: error: `row_major` is not supported
  layout(row_major) uniform Block { mat4 m; };
         ^^^^^^^^^
  help: leave it out, and transpose the matrices in the program or the shader"#,
    ),
    (
        r#"uniform samplerBuffer lights;
void main() { }
"#,
        r#"shader:1:9: error: `samplerBuffer` is not supported
  uniform samplerBuffer lights;
          ^^^^^^^^^^^^^
  help: use `sampler2D` and `texelFetch`, or a buffer"#,
    ),
    (
        r#"uniform Lamp lamp;
void main() { }
"#,
        r#"shader:1:9: error: there is no type `Lamp`
  uniform Lamp lamp;
          ^^^^
  help: declare structures before they are used"#,
    ),
    (
        r#"float list[0];
void main() { }
"#,
        r#"shader:1:11: error: an array cannot have 0 elements
  float list[0];
            ^^^
  help: use 1 to 16777216 elements"#,
    ),
    (
        r#"layout(location = 0) patch in vec4 c;
void main() { }
"#,
        r#"shader:1:22: error: `patch` is not supported
  layout(location = 0) patch in vec4 c;
                       ^^^^^
  help: use vertex, fragment and compute shaders without it"#,
    ),
    (
        r#"in uniform vec4 c;
void main() { }
"#,
        r#"shader:1:4: error: `uniform` does not go with the qualifier before
  in uniform vec4 c;
     ^^^^^^^
  help: remove one of them"#,
    ),
    (
        r#"layout(3) out vec4 c;
void main() { }
"#,
        r#"shader:1:8: error: expected a word of `layout`, found `3`
  layout(3) out vec4 c;
         ^"#,
    ),
    (
        r#"layout(location = 70000) out vec4 c;
void main() { }
"#,
        r#"shader:1:19: error: `location` cannot be 70000
  layout(location = 70000) out vec4 c;
                    ^^^^^
  help: use 0 to 65535"#,
    ),
    (
        r#"buffer vec4 data;
void main() { data = vec4(1.0); }
"#,
        r#"shader:1:13: error: the buffer `data` is no block
  buffer vec4 data;
              ^^^^
  help: write `buffer Name { … };`"#,
    ),
    (
        r#"layout(location = 1) out vec4 a;
layout(location = 1) out vec4 b;
void main() { a = vec4(1.0); b = a; }
"#,
        r#"shader:2:31: error: location 1 of `b` is taken
  layout(location = 1) out vec4 b;
                                ^
  help: give it another number, or leave `layout(location = …)` out"#,
    ),
    (
        r#"uniform Block { sampler2D map; vec4 tint; };
out vec4 c;
void main() { c = tint; }
"#,
        r#"shader:1:27: error: a block cannot hold samplers
  uniform Block { sampler2D map; vec4 tint; };
                            ^^^
  help: declare the sampler as a uniform outside of the block"#,
    ),
    (
        r#"uniform texture2D maps[4];
uniform sampler s;
out vec4 c;
void main() { c = texture(sampler2D(maps[0], s), vec2(0.0)); }
"#,
        r#"shader:1:19: error: an array of 4 textures is not supported
  uniform texture2D maps[4];
                    ^^^^
  help: use an array texture, such as `sampler2DArray`"#,
    ),
    (
        r#"in float v[300];
out vec4 c;
void main() { c = vec4(v[0]); }
"#,
        r#"shader:1:10: error: `v` cannot be handed from stage to stage
  in float v[300];
           ^
  help: use at most 256 numbers, vectors and matrices"#,
    ),
    (
        r#"layout(std140) uniform Block { mat2 m[100000]; };
out vec4 c;
void main() { c = vec4(m[3][0], 0.0, 1.0); }
"#,
        r#"shader:1:37: error: `m` is too large to be copied from its buffer
  layout(std140) uniform Block { mat2 m[100000]; };
                                      ^
  help: use `vec4` and `uint` in the place of `mat2` and `bool`"#,
    ),
];

#[test]
fn errors_tell_the_place_and_what_to_do() {
    assert_eq!(errors::in_stage(Stage::Vertex, VERTEX), 1);
    assert_eq!(errors::in_stage(Stage::Fragment, FRAGMENT), 20);
}
