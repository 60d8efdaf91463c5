//! 64 bits that are not supported, and the words that say so.

use estampe_shader::front::{Options, Source, load};
use estampe_shader::lower::lower;
use naga::valid::{Capabilities, ValidationFlags, Validator};

/// Why a module is not lowered.
#[track_caller]
fn refusal(source: &str) -> String {
    let module = naga::front::wgsl::parse_str(source);
    let module = module.unwrap_or_else(|error| panic!("{}", error.emit_to_string(source)));
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::all());
    let info = validator.validate(&module).expect("a valid module");
    let refused = lower(&module, &info, 0);
    refused.expect_err("it is not supported").to_string()
}

#[test]
fn atomics_floats_and_varyings() {
    assert_eq!(
        refusal(
            "@group(0) @binding(0) var<storage, read_write> sum: atomic<u64>;
            @compute @workgroup_size(1) fn main() { atomicAdd(&sum, 1lu); }"
        ),
        "64-bit atomics are not supported yet"
    );
    assert_eq!(
        refusal(
            "@group(0) @binding(0) var<storage, read_write> sum: f64;
            @compute @workgroup_size(1) fn main() { sum = sum * sum; }"
        ),
        "64-bit floats are not supported yet"
    );
    assert_eq!(
        refusal(
            "@fragment fn main(@location(0) @interpolate(flat) v: vec2<u64>) -> @location(0) vec4f
            { return vec4f(f32(v.x)); }"
        ),
        "64-bit inputs and outputs are not supported yet"
    );
    assert_eq!(
        refusal("@fragment fn main() -> @location(0) u64 { return 1lu; }"),
        "64-bit inputs and outputs are not supported yet"
    );
}

#[test]
fn errors_show_the_place() {
    let said = |source: &str| {
        let refused = load(Source::Wgsl(source), &Options::default());
        refused.expect_err("it is not supported").to_string()
    };
    assert_eq!(
        said("@group(0) @binding(0) var<storage, read_write> sum: atomic<u64>;"),
        "shader:1:23: error: atomic operations on 64-bit integers are not supported
  @group(0) @binding(0) var<storage, read_write> sum: atomic<u64>;
                        ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^"
    );
    assert_eq!(
        said("var<private> sum: f64;"),
        "shader:1:1: error: 64-bit floating point is not supported
  var<private> sum: f64;
  ^^^^^^^^^^^^^^^^^^^^^^"
    );
    assert_eq!(
        said(
            "@compute @workgroup_size(1) fn main() {
    var at = 1lu;
    switch at { case 1: {} default: {} }
}"
        ),
        "shader:3:12: error: invalid `switch` selector
      switch at { case 1: {} default: {} }
             ^^
  help: `switch` selector must be a scalar integer"
    );
}

#[test]
fn reflection_names_the_types() {
    let source = "struct Block { count: u64, steps: vec3<i64>, sums: array<vec2<u64>, 3> }
        @group(0) @binding(0) var<uniform> block: Block;";
    let module = load(Source::Wgsl(source), &Options::default()).expect("a module");
    let block = &module.reflection.blocks[0];
    let members: Vec<_> = block
        .members
        .iter()
        .map(|member| (member.offset, member.kind.to_string(), member.array_stride))
        .collect();
    let named = |offset, kind: &str, stride| (offset, kind.to_owned(), stride);
    assert_eq!(
        members,
        [
            named(0, "u64", 0),
            named(32, "vec3<i64>", 0),
            named(64, "vec2<u64>", 16)
        ]
    );
    assert_eq!(block.size, 128);
}
