//! Primitive restart and provoking vertices.

use estampe_tests::geometry::{Vertex, clip_at, values};
use estampe_tests::shaders::{FlatColored, Indexed, Probe, Scalar};
use estampe_tests::{Case, CaseDraw, Random, TestShader, check, check_some};
use estampe_types::state::{CullMode, PolygonMode, PrimitiveTopology, ProvokingVertex};
use estampe_types::{BufferData, IndexFormat};

const TOPOLOGIES: [PrimitiveTopology; 11] = [
    PrimitiveTopology::PointList,
    PrimitiveTopology::LineList,
    PrimitiveTopology::LineStrip,
    PrimitiveTopology::LineLoop,
    PrimitiveTopology::TriangleList,
    PrimitiveTopology::TriangleStrip,
    PrimitiveTopology::TriangleFan,
    PrimitiveTopology::LineListAdjacency,
    PrimitiveTopology::LineStripAdjacency,
    PrimitiveTopology::TriangleListAdjacency,
    PrimitiveTopology::TriangleStripAdjacency,
];

fn vertices(random: &mut Random, size: [u32; 2], count: u32) -> Vec<Vertex> {
    let (width, height) = (size[0] as f32, size[1] as f32);
    let vertex = |random: &mut Random| Vertex {
        position: clip_at(
            size,
            [random.range(0.0, width), random.range(0.0, height)],
            random.range(-0.1, 1.1),
            random.pick(&[1.0, 1.0, 2.0]),
        ),
        values: values(random),
    };
    (0..count).map(|_| vertex(random)).collect()
}

fn shader(random: &mut Random) -> TestShader {
    match random.below(4) {
        0 => Probe::random(random).into(),
        1 => Probe(Scalar::FrontFacing).into(),
        _ => FlatColored.into(),
    }
}

fn bytes(format: IndexFormat, indices: &[u32]) -> Vec<u8> {
    let width = match format {
        IndexFormat::Uint8 => 1,
        IndexFormat::Uint16 => 2,
        IndexFormat::Uint32 => 4,
    };
    let bytes = indices.iter().map(|index| index.to_le_bytes());
    bytes.flat_map(|four| four[..width].to_vec()).collect()
}

/// Indices, some of which are the greatest of their format.
fn indexed(random: &mut Random, draw: &mut CaseDraw, count: u32) {
    let format = random.pick(&[IndexFormat::Uint8, IndexFormat::Uint16, IndexFormat::Uint32]);
    let rarity = random.pick(&[2, 5, 9]);
    let far = random.pick(&[0, 0, 0, 90]);
    let mut index = |_| match random.below(rarity) {
        0 => u32::MAX,
        1 => random.below(20) + far,
        _ => random.below(20),
    };
    let indices: Vec<_> = (0..count).map(&mut index).collect();
    draw.indices = Some((format, BufferData::from_bytes(&bytes(format, &indices))));
    draw.elements = random.pick(&[0, 0, 1, 3])..count + random.pick(&[0, 0, 5]);
    draw.base_vertex = random.pick(&[0, 0, 0, 1, -2]);
}

/// Rows: V2, A1.
#[test]
fn every_topology_restarts() {
    check("primitive_restart/topologies", 220, |random| {
        let mut case = Case::random_target(random);
        let vertices = vertices(random, case.size, 20);
        let mut draw = CaseDraw::new(shader(random), &vertices);
        indexed(random, &mut draw, 30);
        draw.primitive.topology = random.pick(&TOPOLOGIES);
        draw.primitive.primitive_restart = !random.once_in(6);
        draw.primitive.provoking_vertex =
            random.pick(&[ProvokingVertex::First, ProvokingVertex::Last]);
        draw.primitive.cull_mode = random.pick(&[CullMode::None, CullMode::None, CullMode::Back]);
        draw.primitive.polygon_mode = random.pick(&[
            PolygonMode::Fill,
            PolygonMode::Fill,
            PolygonMode::Line,
            PolygonMode::Point,
        ]);
        draw.instances = random.pick(&[0..1, 0..1, 3..6]);
        case.draws.push(draw);
        case
    });
}

/// Rows: A1, A5.
#[test]
fn the_provoking_vertex_of_every_topology() {
    check("primitive_restart/provoking", 160, |random| {
        let mut case = Case::random_target(random);
        let vertices = vertices(random, case.size, 24);
        let mut draw = CaseDraw::new(shader(random), &vertices);
        if random.once_in(2) {
            let indices: Vec<_> = (0..48).map(|_| random.below(24)).collect();
            draw.indices = Some((IndexFormat::Uint32, BufferData::from_words(indices)));
            draw.elements = 0..48;
        }
        draw.primitive.topology = random.pick(&TOPOLOGIES);
        draw.primitive.provoking_vertex = ProvokingVertex::Last;
        draw.primitive.polygon_mode = random.pick(&[
            PolygonMode::Fill,
            PolygonMode::Fill,
            PolygonMode::Line,
            PolygonMode::Point,
        ]);
        case.draws.push(draw);
        case
    });
}

/// Rows: V2.
#[test]
fn instances_whose_vertices_are_far_apart() {
    check("primitive_restart/sparse", 8, |random| {
        let mut case = Case::new([30, 30], 1);
        let vertices = vertices(random, case.size, 20);
        let mut draw = CaseDraw::new(Indexed, &vertices);
        draw.buffers.push(draw.buffers[0].clone());
        draw.buffers[1].0.attributes.truncate(1);
        draw.buffers[1].0.attributes[0].shader_location = 2;
        let mut indices: Vec<_> = (0..24).map(|_| random.below(20)).collect();
        indices[7] = u32::MAX;
        indices[11] = u32::MAX - 1;
        indices[15] = 3_000_000_000;
        draw.indices = Some((IndexFormat::Uint32, BufferData::from_words(indices)));
        draw.elements = 0..24;
        draw.primitive.topology = random.pick(&TOPOLOGIES);
        draw.primitive.primitive_restart = true;
        draw.instances = 0..3;
        case.draws.push(draw);
        case
    });
}

/// Rows: V2, A1.
#[test]
fn more_primitives_than_a_sub_draw_holds() {
    // Over a million points, lines and triangles of one strip, fan and loop, with restarts.
    for topology in [
        PrimitiveTopology::TriangleFan,
        PrimitiveTopology::TriangleStrip,
        PrimitiveTopology::LineLoop,
    ] {
        let random = &mut Random::new("primitive_restart/many", 1);
        let mut case = Case::new([2, 2], 1);
        let vertices = vertices(random, case.size, 20);
        let mut draw = CaseDraw::new(FlatColored, &vertices);
        let restarts = [5, 900_000, 1_000_003];
        let index = |at| match restarts.contains(&at) {
            true => u32::MAX,
            // Nearly all of them have no area.
            false => at / 50_000 % 20,
        };
        let indices: Vec<_> = (0..1_050_000).map(index).collect();
        draw.indices = Some((IndexFormat::Uint32, BufferData::from_words(indices)));
        draw.elements = 0..1_050_000;
        draw.primitive.topology = topology;
        draw.primitive.primitive_restart = true;
        case.draws.push(draw);
        check_some("primitive_restart/many", &case);
    }
}
