//! Sampling inside the pipeline: derivatives across quads, helper invocations, every filter and
//! address mode.

use estampe_tests::geometry::{Style, triangles};
use estampe_tests::shaders::TexturedShader;
use estampe_tests::{Case, CaseDraw, Random, check};
use estampe_texture::{LevelData, MipGeneration, TexelDescriptor, create_texture};
use estampe_types::state::{PolygonMode, PrimitiveTopology};
use estampe_types::{
    AddressMode, BorderColor, FilterMode, Limits, SampleType, SamplerDescriptor, TexelData,
    TextureFormat,
};
use std::sync::Arc;

fn texture(random: &mut Random) -> Arc<TexelData> {
    let sides = [1, 2, 3, 8, 17, 32];
    let (width, height) = (random.pick(&sides), random.pick(&sides));
    let texels: Vec<u8> = (0..width * height * 4).map(|_| random.byte()).collect();
    let format = random.pick(&[TextureFormat::Rgba8Unorm, TextureFormat::Rgba8UnormSrgb]);
    let mips = random.pick(&[
        MipGeneration::None,
        MipGeneration::Full,
        MipGeneration::Full,
    ]);
    let limits = Limits::default();
    let made = create_texture(width, height, format, &texels, mips, &limits);
    Arc::new(made.expect("a valid texture"))
}

fn sampler(random: &mut Random) -> SamplerDescriptor {
    let modes = [
        AddressMode::ClampToEdge,
        AddressMode::Repeat,
        AddressMode::MirrorRepeat,
    ];
    let filters = [FilterMode::Nearest, FilterMode::Linear];
    SamplerDescriptor {
        address_mode_u: random.pick(&modes),
        address_mode_v: random.pick(&modes),
        mag_filter: random.pick(&filters),
        min_filter: random.pick(&filters),
        mipmap_filter: random.pick(&filters),
        lod_min_clamp: random.pick(&[0.0, 0.0, 0.5, 2.0]),
        lod_max_clamp: random.pick(&[32.0, 32.0, 1.3]),
        ..SamplerDescriptor::default()
    }
}

fn textured_case(random: &mut Random, style: Style, scales: &[f32]) -> Case {
    let mut case = Case::random_target(random);
    let mut vertices = triangles(random, style, case.size, 5);
    let scale = random.pick(scales);
    for vertex in &mut vertices {
        for value in &mut vertex.values[..2] {
            *value = (*value - 0.3) * scale;
        }
    }
    let shader = TexturedShader {
        texture: texture(random),
        sampler: sampler(random),
        channel: random.pick(&[None, Some(0), Some(1), Some(2), Some(3)]),
        is_view: false,
    };
    case.draws.push(CaseDraw::new(shader, &vertices));
    case
}

/// A texture of any float or normalised format, and a random sampler.
fn any_texture(random: &mut Random) -> (Arc<TexelData>, SamplerDescriptor) {
    let all = TextureFormat::ALL.iter().copied();
    let formats: Vec<_> = all
        .filter(|format| format.sample_type() == SampleType::Float)
        .collect();
    let format = random.pick(&formats);
    let sides = [1_u32, 2, 3, 8, 17, 32];
    let (width, height) = (random.pick(&sides), random.pick(&sides));
    let [block_width, block_height] = format.block_size();
    let blocks = width.div_ceil(block_width) * height.div_ceil(block_height);
    let bytes: Vec<u8> = (0..blocks * format.block_bytes())
        .map(|_| random.byte())
        .collect();
    let descriptor = TexelDescriptor::new_2d(width, height, format).with_all_levels();
    let data = [LevelData::tight(&bytes)];
    let made = descriptor.create(&data, MipGeneration::Full, &Limits::default());
    let linear = [FilterMode::Linear; 3];
    let sampler = sampler(random);
    let filters = [
        sampler.mag_filter,
        sampler.min_filter,
        sampler.mipmap_filter,
    ];
    let modes = [
        AddressMode::MirrorOnce,
        AddressMode::ClampToBorder,
        AddressMode::Repeat,
    ];
    let sampler = SamplerDescriptor {
        address_mode_u: random.pick(&modes),
        max_anisotropy: if filters == linear { 8 } else { 1 },
        lod_bias: random.pick(&[0.0, -0.6, 1.4]),
        lod_max_clamp: 32.0,
        border_color: random.pick(&[BorderColor::OpaqueWhite, BorderColor::TransparentBlack]),
        ..sampler
    };
    (Arc::new(made.expect("a valid texture")), sampler)
}

/// Rows: F2.
#[test]
fn views_of_every_format_of_numbers() {
    check("textures/views", 60, |random| {
        let style = random.pick(&[Style::Large, Style::Small, Style::AroundEye]);
        let mut case = textured_case(random, style, &[0.3, 1.0, 4.0, 30.0]);
        let (texture, sampler) = any_texture(random);
        let shader = TexturedShader {
            texture,
            sampler,
            channel: random.pick(&[None, Some(0), Some(1), Some(3)]),
            is_view: true,
        };
        case.draws[0].shader = shader.into();
        case
    });
}

/// Rows: F2, R7.
#[test]
fn magnified_and_minified() {
    check("textures/scales", 70, |random| {
        textured_case(random, Style::Large, &[0.3, 1.0, 4.0, 30.0, 1000.0])
    });
}

/// Rows: F2, R7.
#[test]
fn small_triangles_across_quads() {
    check("textures/small", 30, |random| {
        textured_case(random, Style::Small, &[0.3, 1.0, 4.0, 30.0])
    });
}

/// Rows: F2.
#[test]
fn perspective_towards_the_horizon() {
    check("textures/perspective", 30, |random| {
        textured_case(random, Style::AroundEye, &[1.0, 4.0, 60.0])
    });
}

/// Rows: F2.
#[test]
fn nan_infinite_and_huge_coordinates() {
    check("textures/odd", 30, |random| {
        let mut case = textured_case(random, Style::Large, &[1.0, 1e6, 1e20, 1e38]);
        let mut vertices = triangles(random, Style::Large, case.size, 5);
        for vertex in &mut vertices {
            if random.once_in(2) {
                vertex.values[random.below(2) as usize] = random.odd_number();
            }
        }
        case.draws[0].buffers[0].1 = estampe_tests::geometry::vertex_buffer(&vertices);
        case
    });
}

/// Rows: F2, R7.
#[test]
fn on_lines_and_points() {
    check("textures/lines", 24, |random| {
        let mut case = textured_case(random, Style::Large, &[1.0, 4.0, 30.0]);
        case.draws[0].primitive.topology = random.pick(&[
            PrimitiveTopology::LineList,
            PrimitiveTopology::PointList,
            PrimitiveTopology::TriangleList,
        ]);
        case.draws[0].primitive.polygon_mode = PolygonMode::Line;
        case
    });
}
