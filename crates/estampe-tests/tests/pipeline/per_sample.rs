//! Per-sample operations with random state (O2–O10, R6, R8, D1), each on its own and all together.

use estampe_tests::geometry::{Style, triangles};
use estampe_tests::shaders::{Colored, Cutout, DepthGiven, FlatColored, GivenDepth};
use estampe_tests::{Case, CaseDraw, Random, TestShader, check};
use estampe_types::TextureFormat;
use estampe_types::state::{
    BlendComponent, BlendFactor, BlendOperation, BlendState, ColorWrites, CompareFunction,
    ConservativeMode, DepthBiasState, DepthState, LineRasterization, LineState, LineStipple,
    LogicOperation, PrimitiveTopology, StencilFaceState, StencilOperation, StencilState,
};

const FUNCTIONS: [CompareFunction; 8] = [
    CompareFunction::Never,
    CompareFunction::Less,
    CompareFunction::Equal,
    CompareFunction::LessEqual,
    CompareFunction::Greater,
    CompareFunction::NotEqual,
    CompareFunction::GreaterEqual,
    CompareFunction::Always,
];

const OPERATIONS: [StencilOperation; 8] = [
    StencilOperation::Keep,
    StencilOperation::Zero,
    StencilOperation::Replace,
    StencilOperation::Invert,
    StencilOperation::IncrementClamp,
    StencilOperation::DecrementClamp,
    StencilOperation::IncrementWrap,
    StencilOperation::DecrementWrap,
];

/// The factors without a second source colour.
const FACTORS: [BlendFactor; 15] = [
    BlendFactor::Zero,
    BlendFactor::One,
    BlendFactor::Src,
    BlendFactor::OneMinusSrc,
    BlendFactor::SrcAlpha,
    BlendFactor::OneMinusSrcAlpha,
    BlendFactor::Dst,
    BlendFactor::OneMinusDst,
    BlendFactor::DstAlpha,
    BlendFactor::OneMinusDstAlpha,
    BlendFactor::SrcAlphaSaturated,
    BlendFactor::Constant,
    BlendFactor::OneMinusConstant,
    BlendFactor::ConstantAlpha,
    BlendFactor::OneMinusConstantAlpha,
];

const DEPTH_STENCIL: [TextureFormat; 3] = [
    TextureFormat::Depth24PlusStencil8,
    TextureFormat::Depth32FloatStencil8,
    TextureFormat::Stencil8,
];

fn renderable() -> Vec<TextureFormat> {
    let all = TextureFormat::ALL.iter().copied();
    all.filter(|format| format.is_renderable()).collect()
}

fn component(random: &mut Random) -> BlendComponent {
    BlendComponent {
        operation: random.pick(&[
            BlendOperation::Add,
            BlendOperation::Subtract,
            BlendOperation::ReverseSubtract,
            BlendOperation::Min,
            BlendOperation::Max,
        ]),
        src_factor: random.pick(&FACTORS),
        dst_factor: random.pick(&FACTORS),
    }
}

fn blend(random: &mut Random) -> BlendState {
    BlendState {
        color: component(random),
        alpha: component(random),
    }
}

fn depth(random: &mut Random) -> Option<DepthState> {
    let state = DepthState {
        compare: random.pick(&FUNCTIONS),
        write_enabled: !random.once_in(3),
    };
    (!random.once_in(5)).then_some(state)
}

fn face(random: &mut Random) -> StencilFaceState {
    StencilFaceState {
        compare: random.pick(&FUNCTIONS),
        fail_op: random.pick(&OPERATIONS),
        depth_fail_op: random.pick(&OPERATIONS),
        pass_op: random.pick(&OPERATIONS),
        read_mask: random.pick(&[0xFF, 0xFF, 0x0F, 0x01, 0]),
        write_mask: random.pick(&[0xFF, 0xFF, 0xF0, 0x03, 0]),
    }
}

fn stencil(random: &mut Random, case: &mut Case, draw: &mut CaseDraw) {
    if case.draws.is_empty() {
        case.depth_stencil = Some(random.pick(&DEPTH_STENCIL));
        case.clear_stencil = random.pick(&[0, 0, 1, 0x80, 0xFF]);
    }
    draw.stencil = Some(StencilState {
        front: face(random),
        back: face(random),
    });
    draw.stencil_reference = [random.pick(&[0, 1, 2, 0x7F, 0xFF]), random.byte()];
    if case.depth_stencil == Some(TextureFormat::Stencil8) {
        draw.depth = None;
    }
}

/// Overlapping triangles, large and small, of both windings; sometimes lines or points.
fn draw(random: &mut Random, case: &Case, shader: impl Into<TestShader>) -> CaseDraw {
    let mut vertices = Vec::new();
    for _ in 0..4 {
        let styles = [
            Style::Large,
            Style::Small,
            Style::OnGrid,
            Style::AcrossDepths,
        ];
        vertices.extend(triangles(
            random,
            random.clone().pick(&styles),
            case.size,
            1,
        ));
    }
    let mut draw = CaseDraw::new(shader, &vertices);
    draw.depth = depth(random);
    draw.primitive.topology = random.pick(&[
        PrimitiveTopology::TriangleList,
        PrimitiveTopology::TriangleList,
        PrimitiveTopology::TriangleStrip,
        PrimitiveTopology::TriangleStrip,
        PrimitiveTopology::LineStrip,
        PrimitiveTopology::PointList,
    ]);
    draw
}

fn shader(random: &mut Random) -> TestShader {
    match random.below(4) {
        0 => FlatColored.into(),
        1 => Cutout.into(),
        2 => DepthGiven(random.pick(&[GivenDepth::Value, GivenDepth::Moved])).into(),
        _ => Colored.into(),
    }
}

/// Checks cases of four draws, each modified by `set`.
fn cases(topic: &str, count: u64, set: impl Fn(&mut Random, &mut Case, &mut CaseDraw)) {
    check(topic, count, |random| {
        let mut case = Case::random_target(random);
        case.clear_depth = random.pick(&[1.0, 0.5, 0.0]);
        case.clear_color = random.four(-0.5, 1.5);
        for _ in 0..4 {
            let shader = shader(random);
            let mut draw = draw(random, &case, shader);
            set(random, &mut case, &mut draw);
            case.draws.push(draw);
        }
        case
    });
}

/// Rows: O3.
#[test]
fn stencil_states() {
    cases("per_sample/stencil", 60, stencil);
}

/// Rows: O4, D1.
#[test]
fn depth_formats() {
    cases("per_sample/depth formats", 40, |random, case, _draw| {
        if case.draws.is_empty() {
            case.depth_stencil = Some(random.pick(&[
                TextureFormat::Depth16Unorm,
                TextureFormat::Depth24Plus,
                TextureFormat::Depth24PlusStencil8,
                TextureFormat::Depth32FloatStencil8,
            ]));
        }
    });
}

/// Rows: O4.
#[test]
fn depth_bounds() {
    cases("per_sample/depth bounds", 30, |random, _case, draw| {
        let ends = [random.unit(), random.unit()];
        draw.depth_bounds = Some(random.pick(&[ends, [0.0, 0.5], [0.2, 1.0], [0.0, 1.0]]));
    });
}

/// Rows: F1, O5, O7, O8, O9.
#[test]
fn formats_blended_and_masked() {
    let formats = renderable();
    cases("per_sample/formats", 120, |random, case, draw| {
        if case.draws.is_empty() {
            case.format = Some(random.pick(&formats));
        }
        if case.format.is_some_and(TextureFormat::is_blendable) && !random.once_in(3) {
            draw.blend = Some(blend(random));
            draw.blend_constant = random.four(-0.5, 1.5);
        }
        if random.once_in(2) {
            draw.write_mask = ColorWrites(random.byte() & 0xF);
        }
    });
}

/// Rows: O6.
#[test]
fn logic_operations() {
    let formats = renderable();
    cases("per_sample/logic", 80, |random, case, draw| {
        if case.draws.is_empty() {
            case.format = Some(random.pick(&formats));
        }
        draw.logic_operation = Some(random.pick(&LogicOperation::ALL));
        if case.format.is_some_and(TextureFormat::is_blendable) && random.once_in(3) {
            draw.blend = Some(blend(random));
        }
        if random.once_in(3) {
            draw.write_mask = ColorWrites(random.byte() & 0xF);
        }
    });
}

/// Rows: R6.
#[test]
fn sample_counts_and_masks() {
    cases("per_sample/samples", 80, |random, case, draw| {
        if case.draws.is_empty() {
            case.samples = random.pick(&[2, 4, 8, 16]);
        }
        if random.once_in(2) {
            draw.sample_mask = random.bits();
        }
        draw.alpha_to_coverage = random.once_in(3);
        draw.sample_shading = random.once_in(3);
        if random.once_in(4) {
            draw.blend = Some(BlendState::ALPHA_BLENDING);
        }
    });
}

/// Rows: R8.
#[test]
fn conservative_coverage() {
    check("per_sample/conservative", 60, |random| {
        let mut case = Case::random_target(random);
        if random.once_in(2) {
            case.samples = random.pick(&[1, 2, 4]);
        }
        for _ in 0..3 {
            let mut vertices = Vec::new();
            for _ in 0..4 {
                let style = random.pick(&Style::ALL);
                vertices.extend(triangles(random, style, case.size, 1));
            }
            let mut draw = CaseDraw::new(Colored, &vertices);
            draw.primitive.conservative = random.pick(&[
                ConservativeMode::Overestimate,
                ConservativeMode::Underestimate,
                ConservativeMode::Disabled,
            ]);
            case.draws.push(draw);
        }
        case
    });
}

/// Rows: F1, O10.
#[test]
fn everything_together() {
    let formats = renderable();
    cases("per_sample/everything", 150, |random, case, draw| {
        let is_first = case.draws.is_empty();
        if is_first {
            case.samples = random.pick(&[1, 1, 2, 4, 8]);
            case.format = Some(random.pick(&formats));
            case.depth_stencil = Some(random.pick(&DEPTH_STENCIL));
        }
        if random.once_in(2) {
            stencil(random, case, draw);
        }
        if case.depth_stencil == Some(TextureFormat::Stencil8) {
            draw.depth = None;
        }
        if case.format.is_some_and(TextureFormat::is_blendable) && random.once_in(2) {
            draw.blend = Some(blend(random));
            draw.blend_constant = random.four(0.0, 1.0);
        }
        if random.once_in(4) {
            draw.logic_operation = Some(random.pick(&LogicOperation::ALL));
        }
        if random.once_in(4) {
            draw.depth_bounds = Some([0.1, 0.8]);
        }
        if random.once_in(3) {
            draw.depth_bias = DepthBiasState {
                constant: random.pick(&[0.0, 3.0, -1000.0]),
                slope_scale: random.pick(&[0.0, 1.5, -0.25]),
                clamp: random.pick(&[0.0, 0.01, -0.1]),
            };
        }
        draw.primitive.line = LineState {
            width: random.pick(&[1.0, 2.5, 5.0]),
            rasterization: random.pick(&[
                LineRasterization::Bresenham,
                LineRasterization::Rectangular,
                LineRasterization::RectangularSmooth,
            ]),
            stipple: random.once_in(3).then_some(LineStipple {
                factor: 2,
                pattern: 0x5E37,
            }),
        };
        draw.primitive.round_points = random.once_in(2);
        draw.is_counted = random.once_in(2);
        draw.alpha_to_coverage = random.once_in(5);
        draw.sample_shading = random.once_in(4);
    });
}
