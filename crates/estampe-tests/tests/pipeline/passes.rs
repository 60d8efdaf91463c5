//! Several draws with different pipelines in one pass, and passes that load the previous contents.

use estampe_tests::geometry::{Style, triangles};
use estampe_tests::shaders::{
    Colored, Cutout, DepthGiven, FlatColored, GivenDepth, Probe, Scalar, Sized, Uniform,
};
use estampe_tests::{
    Case, CaseDraw, ExpectedPaths, Random, TestShader, check, check_paths, check_some,
};
use estampe_types::state::{
    BlendState, CompareFunction, CullMode, DepthState, PolygonMode, PrimitiveTopology, ScissorRect,
};
use estampe_types::{
    Bindings, BoundGroup, BoundResource, BoundResources, BufferData, IndexFormat,
    MAX_DYNAMIC_OFFSETS, TextureFormat,
};
use std::sync::Arc;

fn shader(random: &mut Random) -> TestShader {
    match random.below(8) {
        0 => Colored.into(),
        1 => FlatColored.into(),
        2 => Uniform.into(),
        3 => Cutout.into(),
        4 => DepthGiven(GivenDepth::Moved).into(),
        5 => Sized(Some(6.0)).into(),
        _ => Probe::random(random).into(),
    }
}

fn colors(random: &mut Random) -> Bindings {
    let buffer = BufferData::from_f32s(&[random.four(0.0, 1.0), random.four(0.0, 1.0)].concat());
    let entry = BoundResource::Buffer {
        buffer,
        offset: random.pick(&[0, 0, 4, 20]),
        size: u32::MAX,
        dynamic_offset: random.once_in(2).then_some(0),
    };
    let group = BoundResources {
        entries: vec![(0, entry)],
    };
    Bindings {
        groups: vec![BoundGroup {
            group: Arc::new(group),
            dynamic_offsets: [random.pick(&[0, 8]); MAX_DYNAMIC_OFFSETS],
        }],
        ..Bindings::default()
    }
}

fn any_draw(random: &mut Random, size: [u32; 2], count: u32) -> CaseDraw {
    let style = random.pick(&Style::ALL);
    let vertices = triangles(random, style, size, count);
    let mut draw = CaseDraw::new(shader(random), &vertices);
    draw.primitive.topology = random.pick(&[
        PrimitiveTopology::TriangleList,
        PrimitiveTopology::TriangleList,
        PrimitiveTopology::TriangleStrip,
        PrimitiveTopology::LineStrip,
        PrimitiveTopology::PointList,
    ]);
    draw.primitive.polygon_mode =
        random.pick(&[PolygonMode::Fill, PolygonMode::Fill, PolygonMode::Line]);
    draw.primitive.cull_mode = random.pick(&[CullMode::None, CullMode::None, CullMode::Front]);
    draw.depth = random.pick(&[
        None,
        Some(DepthState::LESS_WRITE),
        Some(DepthState::LESS_READ),
        Some(DepthState {
            write_enabled: true,
            compare: CompareFunction::GreaterEqual,
        }),
    ]);
    draw.blend = random.pick(&[None, None, Some(BlendState::ALPHA_BLENDING)]);
    draw.bindings = colors(random);
    if random.once_in(4) {
        draw.scissor = Some(ScissorRect {
            x: random.below(size[0]),
            y: random.below(size[1]),
            width: 20,
            height: 30,
        });
    }
    draw
}

/// Rows: O5, U3.
#[test]
fn many_pipelines_in_one_pass_and_in_two() {
    check("passes/pipelines", 40, |random| {
        let mut case = Case::random_target(random);
        case.format =
            Some(random.pick(&[TextureFormat::Rgba8Unorm, TextureFormat::Rgba8UnormSrgb]));
        for _ in 0..5 {
            let draw = any_draw(random, case.size, 4);
            case.draws.push(draw);
        }
        case.second_pass = random.pick(&[usize::MAX, 0, 2, 5]);
        case
    });
}

/// Rows: U3.
#[test]
fn more_primitives_than_a_chunk_holds() {
    // More than the 16,384 primitives of a chunk: several chunks on one thread too, made by several
    // workers where there are some, and read by the tiles in order.
    check("passes/chunks", 2, |random| {
        let mut case = Case::new([70, 66], random.pick(&[1, 4]));
        let vertices = triangles(random, Style::Tiny, case.size, 4000);
        for topology in [
            PrimitiveTopology::TriangleList,
            PrimitiveTopology::TriangleStrip,
            PrimitiveTopology::PointList,
        ] {
            let mut draw = CaseDraw::new(Probe(Scalar::Smooth), &vertices);
            draw.primitive.topology = topology;
            draw.depth = None;
            draw.blend = Some(BlendState::ALPHA_BLENDING);
            if topology == PrimitiveTopology::TriangleStrip {
                // A strip through unrelated triangles has large triangles between them.
                draw.elements = 0..60;
                draw.instances = 0..20;
            }
            case.draws.push(draw);
        }
        case
    });
}

/// Rows: V2, U3.
#[test]
fn geometry_of_a_large_draw_is_done_group_by_group() {
    // A group has 65,536 primitives for each thread. Strips keep their winding across a cut, and
    // small draws may lie in the group in which a large one ends.
    const PRIMITIVES: u32 = 2 * 65_536 + 1001;
    for (topology, elements) in [
        (PrimitiveTopology::TriangleList, PRIMITIVES * 3),
        (PrimitiveTopology::TriangleStrip, PRIMITIVES + 2),
        (PrimitiveTopology::LineStrip, PRIMITIVES + 1),
    ] {
        let topic = format!("passes/groups_{topology:?}");
        let statistics = check_paths(&topic, 1, ExpectedPaths::default(), |random| {
            let mut case = Case::new([3, 2], random.pick(&[1, 4]));
            let vertices = triangles(random, Style::Small, case.size, 7);
            let indices: Vec<u8> = (0..elements).map(|_| random.byte() % 20).collect();
            let mut draw = CaseDraw::new(Colored, &vertices);
            draw.indices = Some((IndexFormat::Uint8, BufferData::from_bytes(&indices)));
            draw.elements = 0..elements;
            draw.primitive.topology = topology;
            draw.primitive.cull_mode = CullMode::Back;
            // The same primitives come again and again: those of the first group are visible.
            draw.depth = Some(DepthState {
                compare: CompareFunction::Less,
                write_enabled: true,
            });
            case.draws.push(draw.clone());
            draw.elements = 0..30;
            case.draws.push(draw);
            case
        });
        let passes = statistics.primitives_in / u64::from(PRIMITIVES);
        assert!(passes > 0, "no pass was drawn");
        // Three on one thread, two on two, else one.
        let groups = statistics.groups_of_geometry;
        assert!(
            (passes + 1..=passes * 3).contains(&groups),
            "{topology:?}: {groups}"
        );
    }
}

/// Rows: V2, U3.
#[test]
fn more_primitives_than_a_sub_draw_or_a_draw_batch_holds() {
    // A sub-draw has 65,536 primitives, a draw batch two million. Strips keep their winding
    // across a cut. All of this takes half a minute, so only longer runs do it.
    if std::env::var_os("ESTAMPE_TEST_FACTOR").is_none() {
        return;
    }
    for topology in [
        PrimitiveTopology::TriangleStrip,
        PrimitiveTopology::TriangleFan,
        PrimitiveTopology::LineList,
    ] {
        let mut random = Random::new("passes/items", 1);
        let mut case = Case::new([2, 1], 1);
        let vertices = triangles(&mut random, Style::Small, case.size, 7);
        let count = 2_200_001;
        let indices: Vec<u8> = (0..count).map(|_| random.byte() % 20).collect();
        let mut draw = CaseDraw::new(FlatColored, &vertices);
        draw.indices = Some((IndexFormat::Uint8, BufferData::from_bytes(&indices)));
        draw.elements = 0..count;
        draw.primitive.topology = topology;
        draw.primitive.cull_mode = CullMode::Back;
        draw.depth = None;
        draw.blend = Some(BlendState::ALPHA_BLENDING);
        case.draws.push(draw.clone());
        // The second draw begins in the draw batch in which the first one ends.
        draw.elements = 0..30;
        draw.instances = 0..50_000;
        case.draws.push(draw);
        check_some("passes/items", &case);
    }
}

/// Rows: O8.
#[test]
fn a_pass_without_draws_clears() {
    check("passes/clear", 6, |random| {
        let mut case = Case::random_target(random);
        case.clear_color = random.four(-0.5, 1.5);
        case.clear_depth = random.pick(&[0.3, 1.0, -0.5, 7.0, f32::NAN, f32::INFINITY]);
        case.format =
            Some(random.pick(&[TextureFormat::Rgba8Unorm, TextureFormat::Rgba8UnormSrgb]));
        case
    });
}

/// Passes of few primitives are drawn in smaller tiles by several threads, although there are
/// enough for them.
///
/// Rows: R1, R3, R6, O8.
#[test]
fn tiles_are_smaller_where_primitives_are_few() {
    let statistics = check_paths(
        "passes/few primitives",
        16,
        ExpectedPaths::default(),
        |random| {
            // Twelve tiles of one sample or four.
            let size = random.pick(&[[200, 150], [256, 190], [130, 240]]);
            let mut case = Case::new(size, random.pick(&[1, 1, 4]));
            case.clear_color = random.four(-0.5, 1.5);
            let style = random.pick(&[Style::Large, Style::Huge, Style::Sliver]);
            let vertices = triangles(random, style, size, 4);
            case.draws.push(CaseDraw::new(Colored, &vertices));
            case.second_pass = random.index(2);
            case
        },
    );
    assert!(statistics.tiles_for_threads > 0, "no tile was smaller");
}

/// Rows: O8.
#[test]
fn tiles_that_no_primitive_reaches_are_only_cleared_or_kept() {
    let statistics = check_paths(
        "passes/empty tiles",
        12,
        ExpectedPaths::default(),
        |random| {
            let mut case = Case::new([200, 130], random.pick(&[1, 1, 2, 4, 8]));
            case.clear_color = random.four(-0.5, 1.5);
            for _ in 0..2 {
                let vertices = triangles(random, Style::Small, case.size, 3);
                case.draws.push(CaseDraw::new(Colored, &vertices));
            }
            case.second_pass = random.index(2);
            case
        },
    );
    assert!(
        statistics.tiles_only_cleared > 0,
        "a primitive reached each tile"
    );
}

/// Several threads draw small targets in smaller tiles.
///
/// Rows: R1, R3, R6, O8.
#[test]
fn tiles_are_smaller_where_they_are_few_for_the_threads() {
    let statistics = check_paths(
        "passes/smaller tiles",
        16,
        ExpectedPaths::default(),
        |random| {
            let size = random.pick(&[[100, 60], [31, 33], [64, 64], [1, 70]]);
            let mut case = Case::new(size, random.pick(&[1, 1, 4, 8]));
            case.clear_color = random.four(-0.5, 1.5);
            for _ in 0..3 {
                case.draws.push(any_draw(random, size, 12));
            }
            case.second_pass = random.index(3);
            case
        },
    );
    assert!(statistics.tiles_for_threads > 0, "no tile was smaller");
}

/// Many threads draw the tiles that most primitives reach first.
///
/// Rows: R2, R6, O8.
#[test]
fn tiles_that_cost_more_are_drawn_first() {
    let statistics = check_paths(
        "passes/dearest first",
        24,
        ExpectedPaths::default(),
        |random| {
            let size = random.pick(&[[200, 150], [256, 190], [130, 240]]);
            let mut case = Case::new(size, random.pick(&[1, 1, 4, 8]));
            case.clear_color = random.four(-0.5, 1.5);
            case.draws.push(any_draw(random, size, 4));
            // Many more in one corner.
            let [width, height] = size.map(|side| side / 2);
            let mut crowd = any_draw(random, [width, height], 40);
            crowd.scissor = Some(ScissorRect {
                x: width / 2,
                y: height / 2,
                width,
                height,
            });
            case.draws.push(crowd);
            case.second_pass = random.index(3);
            case
        },
    );
    assert!(statistics.tiles_by_cost > 0, "tiles stayed in their order");
}
