//! Which samples take the gradients of their coordinates.

use super::{entry_points, fragment};
use estampe_ir::interface::{Input, Stage};
use estampe_ir::op::{Axis, LevelOfDetail};
use estampe_ir::tree::{Node, Tree, verify};
use estampe_ir::{Op, Value};
use estampe_shader::front::{Options, Source, load};
use estampe_shader::lower::lower;

/// Where a level of detail comes from.
#[derive(Debug, PartialEq, Eq)]
enum From {
    /// The differences within the quad.
    Quad,
    /// The derivatives of these scalars of the varyings.
    Varyings(Vec<u32>),
    /// What the shader gives.
    Shader,
}

/// Where the levels of detail of a shader's accesses to textures come from, in order.
fn levels(tree: &Tree) -> Vec<From> {
    verify(tree).unwrap_or_else(|error| panic!("{error}"));
    let mut ops = Vec::new();
    each_op(&tree.body, &mut |op, first| ops.push((op.clone(), first)));
    // The scalar and the axis of a derivative.
    let derivative = |value: &Value| {
        let (op, _) = ops.iter().find(|(_, first)| first == value)?;
        match op {
            Op::Input(at) => match tree.interface.inputs[*at as usize] {
                Input::Derivative { scalar, axis } => Some((scalar, axis)),
                _ => None,
            },
            _ => None,
        }
    };
    let level = |level: &LevelOfDetail| match level {
        LevelOfDetail::Implicit => From::Quad,
        LevelOfDetail::Gradient { x, y } => {
            let found: Option<Vec<_>> = x.iter().chain(y).map(derivative).collect();
            let Some(found) = found else {
                return From::Shader;
            };
            let scalars: Vec<u32> = found
                .iter()
                .take(x.len())
                .map(|(scalar, _)| *scalar)
                .collect();
            let along = |axis| scalars.iter().map(move |scalar| (*scalar, axis));
            let expected: Vec<_> = along(Axis::X).chain(along(Axis::Y)).collect();
            assert_eq!(found, expected);
            From::Varyings(scalars)
        }
        _ => From::Shader,
    };
    let accesses = ops.iter().filter_map(|(op, _)| match op {
        Op::Texture(op) => Some(level(&op.level)),
        _ => None,
    });
    accesses.collect()
}

fn each_op<'a>(nodes: &'a [Node], visit: &mut impl FnMut(&'a Op, Value)) {
    for node in nodes {
        match node {
            Node::Op { op, first } => visit(op, *first),
            Node::Branch { .. } => {}
            Node::If { accept, reject, .. } => {
                each_op(accept, visit);
                each_op(reject, visit);
            }
            Node::Block { body, .. } | Node::Loop { body, .. } => each_op(body, visit),
        }
    }
}

/// Each expression samples one texture.
#[track_caller]
fn check(expression: &str, expected: From) {
    let stage = fragment(&format!("return vec4f({expression});"));
    assert_eq!(levels(&stage.tree), [expected], "{expression}");
}

#[test]
fn coordinates_that_are_varyings_give_their_gradients() {
    let of = |scalars: &[u32]| From::Varyings(scalars.to_vec());
    check("textureSample(map, s, in.uv)", of(&[0, 1]));
    check("textureSample(map, s, in.uv, vec2i(1, -1))", of(&[0, 1]));
    check("textureSample(map, s, in.on_screen)", of(&[5, 6]));
    check("textureSample(layers, s, in.uv, in.layer)", of(&[0, 1]));
    check(
        "textureSample(layers, s, in.uv, i32(in.uv.x * 9.0))",
        of(&[0, 1]),
    );
    check("textureSample(sky, s, in.direction)", of(&[2, 3, 4]));
    check("textureSample(volume, s, in.direction)", of(&[2, 3, 4]));
    check("textureSample(line, s, in.uv.y)", of(&[1]));
    check("textureSample(depths, s, in.uv)", of(&[0, 1]));
    check(
        "textureSampleCompare(depths, compared, in.uv, in.direction.z)",
        of(&[0, 1]),
    );
    // The components may be any varyings, in any order.
    check("textureSample(map, s, in.uv.yx)", of(&[1, 0]));
    check(
        "textureSample(map, s, vec2f(in.uv.y, in.direction.x))",
        of(&[1, 2]),
    );
    check("textureSample(map, s, in.uv.xx)", of(&[0, 0]));
}

#[test]
fn computed_coordinates_have_the_level_of_their_quad() {
    check("textureSample(map, s, in.uv * 2.0)", From::Quad);
    check("textureSample(map, s, vec2f(in.uv.x, 0.5))", From::Quad);
    check(
        "textureSample(map, s, vec2f(in.uv.x, -in.uv.y))",
        From::Quad,
    );
    check("textureSample(sky, s, normalize(in.direction))", From::Quad);
    check(
        "textureSampleCompare(depths, compared, in.uv + 0.5, 0.5)",
        From::Quad,
    );
}

/// Each fragment of a quad has its own place at which such varyings are interpolated.
#[test]
fn varyings_beside_the_centre_have_the_level_of_their_quad() {
    check("textureSample(map, s, in.inside)", From::Quad);
    check("textureSample(map, s, in.of_sample)", From::Quad);
    check(
        "textureSample(map, s, vec2f(in.uv.x, in.inside.y))",
        From::Quad,
    );
}

#[test]
fn levels_that_the_shader_gives_stay() {
    check("textureSampleBias(map, s, in.uv, 0.5)", From::Shader);
    check("textureSampleLevel(map, s, in.uv, 1.0)", From::Shader);
    check(
        "textureSampleGrad(map, s, in.uv, in.on_screen, in.uv)",
        From::Shader,
    );
    check("textureGather(2, map, s, in.uv)", From::Shader);
    check("textureLoad(map, vec2i(in.uv), 0)", From::Shader);
}

/// The derivatives are read once, before everything, wherever the texture is sampled.
#[test]
fn samples_in_any_control_flow_share_the_derivatives() {
    let stage = fragment(
        "var color = textureSample(map, s, in.uv);
        var at = in.uv;
        if in.layer > 3 {
            color += textureSample(other, s, at);
        }
        for (var turn = 0; turn < in.layer; turn += 1) {
            color += textureSample(third, s, at);
            if color.x > 3.0 { return textureSample(layers, s, in.uv, turn); }
        }
        return color;",
    );
    let tree = &stage.tree;
    let levels = levels(tree);
    assert_eq!(levels.len(), 4);
    for level in levels {
        assert_eq!(level, From::Varyings(vec![0, 1]));
    }
    let is_derivative = |input: &&Input| matches!(input, Input::Derivative { .. });
    let inputs = &tree.interface.inputs;
    assert_eq!(inputs.iter().filter(is_derivative).count(), 4);
    let reads = tree.body.iter().take(4).map(|node| match node {
        Node::Op {
            op: Op::Input(at), ..
        } => inputs[*at as usize],
        node => panic!("{node:?}"),
    });
    assert!(
        reads
            .collect::<Vec<_>>()
            .iter()
            .all(|input| is_derivative(&input))
    );
}

/// A variable that control flow changes is no varying any more.
#[test]
fn variables_that_branches_change_have_the_level_of_their_quad() {
    let stage = fragment(
        "var at = in.uv;
        if in.layer > 3 { at = in.on_screen; }
        return textureSample(map, s, at);",
    );
    assert_eq!(levels(&stage.tree), [From::Quad]);
}

/// One quad needs all helper invocations, so that the others may as well have theirs.
#[test]
fn samples_stay_if_anything_needs_its_quad() {
    let of = |more: &str| {
        let stage = fragment(&format!("return textureSample(map, s, in.uv) + {more};"));
        levels(&stage.tree)
    };
    let near = || From::Varyings(vec![0, 1]);
    assert_eq!(of("in.direction.xyzz"), [near()]);
    assert_eq!(
        of("textureSample(other, s, in.on_screen)"),
        [near(), From::Varyings(vec![5, 6])]
    );
    assert_eq!(
        of("textureSampleLevel(other, s, in.uv + 0.1, 2.0)"),
        [near(), From::Shader]
    );
    assert_eq!(
        of("textureSample(other, s, in.uv + 0.01)"),
        [From::Quad, From::Quad]
    );
    assert_eq!(
        of("textureSample(other, s, in.inside)"),
        [From::Quad, From::Quad]
    );
    assert_eq!(
        of("textureSampleBias(other, s, in.uv, 1.0)"),
        [From::Quad, From::Shader]
    );
    assert_eq!(of("vec4f(dpdx(in.uv.x))"), [From::Quad]);
    assert_eq!(of("vec4f(fwidthFine(in.direction), 1.0)"), [From::Quad]);
    // What nothing uses needs nothing.
    let stage = fragment(
        "let unused = dpdx(in.uv);
        return textureSample(map, s, in.uv);",
    );
    assert_eq!(levels(&stage.tree), [near()]);
}

#[test]
fn glsl_does_the_same() {
    let text = "#version 450
        layout(set = 0, binding = 0) uniform texture2D map;
        layout(set = 0, binding = 1) uniform sampler s;
        layout(location = 1) in vec2 uv;
        layout(location = 0) out vec4 color;
        vec4 at(vec2 place) { return texture(sampler2D(map, s), place); }
        void main() { color = SUM; }";
    let of = |sum: &str| {
        let (text, stage) = (&*text.replace("SUM", sum), Stage::Fragment);
        let module = load(Source::Glsl { text, stage }, &Options::default());
        let module = module.unwrap_or_else(|errors| panic!("{errors}"));
        let lowered = lower(&module.module, &module.info, 0);
        levels(&lowered.unwrap_or_else(|error| panic!("{error}")).tree)
    };
    assert_eq!(of("at(uv)"), [From::Varyings(vec![0, 1])]);
    assert_eq!(of("at(uv) + at(uv * 0.5)"), [From::Quad, From::Quad]);
    let biased = of("at(uv) + texture(sampler2D(map, s), uv, 1.0)");
    assert_eq!(biased, [From::Quad, From::Shader]);
}

/// Numbers of half the size are rounded, which computes them.
#[test]
fn rounded_varyings_have_the_level_of_their_quad() {
    let text = "enable f16;
        @group(0) @binding(0) var s: sampler;
        @group(0) @binding(1) var map: texture_2d<f32>;
        @fragment fn f(@location(0) uv: vec2h) -> @location(0) vec4f {
            return textureSample(map, s, vec2f(uv));
        }";
    assert_eq!(levels(&entry_points(text)[0].tree), [From::Quad]);
}
