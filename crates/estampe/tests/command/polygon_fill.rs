//! The direct fill of polygons on pixels against the pipeline: it covers the pixels of the
//! polygon's triangles.

use estampe::state::{CullMode, VertexBufferLayout};
use estampe::{
    ColorAttachment, Device, Draw, FragmentIn, FragmentOut, RenderPass, RenderPipelineDescriptor,
    TextureDescriptor, TextureFormat, Vec2, Vec4, VertexFormat, VertexIn, VertexOut,
};
use estampe_shapes::parametric::cos_sin_turns;
use estampe_shapes::polygon::{FillRule, fill_spans, triangulate_rings};
use fastrand::Rng;

/// Width and height of the pictures, a power of two: NDC of window coordinates is then exact.
const SIDE: u16 = 64;

struct White;

estampe::shader! {
    impl Shader for White {
        type Attributes<R: Real> = Vec2<R>;
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, ndc: Vec2<R>) -> VertexOut<R, ()> {
            let (zero, one) = (input.real(0.0), input.real(1.0));
            VertexOut::new(Vec4::new(ndc.x, ndc.y, zero, one), ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, _: ()) -> FragmentOut<R> {
            let one = input.real(1.0);
            FragmentOut::color(Vec4::new(one, one, one, one))
        }
    }
}

/// A ring around the middle with corners on 1/256 pixel, or on pixel centres.
fn star(random: &mut Rng, count: usize, radii: [f64; 2], step: f64) -> Vec<glam::Vec2> {
    let mut turns: Vec<f64> = (0..count).map(|_| random.f64()).collect();
    turns.sort_by(f64::total_cmp);
    let mut corner = |turns: f64| {
        let (cos, sin) = cos_sin_turns(turns);
        let radius = radii[0] + (radii[1] - radii[0]) * random.f64();
        let on_grid = |x: f64| libm::rint(x / step) * step;
        let middle = f64::from(SIDE) / 2.0;
        glam::DVec2::new(
            on_grid(middle + radius * cos),
            on_grid(middle + radius * sin),
        )
        .as_vec2()
    };
    turns.into_iter().map(&mut corner).collect()
}

/// Rows: M6.
#[test]
fn spans_are_the_pixels_that_the_pipeline_draws() {
    let device = Device::new(&Default::default()).expect("a device");
    let mut descriptor = RenderPipelineDescriptor::new(White);
    descriptor.vertex_buffers = vec![VertexBufferLayout::packed(&[VertexFormat::Float32x2])];
    descriptor.depth_stencil = None;
    descriptor.primitive.cull_mode = CullMode::None;
    let pipeline = device
        .create_render_pipeline(&descriptor)
        .expect("a pipeline");
    let side = u32::from(SIDE);
    let format = TextureFormat::Rgba8Unorm;
    let image = TextureDescriptor::new_2d(side, side, format);
    let image = device.create_texture(&image).expect("a texture");

    let mut random = Rng::with_seed(5);
    let (mut total, mut pixels) = (0, 0);
    for case in 0..200 {
        let step = if case % 2 == 0 { 1.0 / 256.0 } else { 0.5 };
        let count = random.usize(3..30);
        let outer = star(&mut random, count, [14.0, 40.0], step);
        let count = random.usize(3..12);
        let inner = star(&mut random, count, [1.0, 9.0], step);
        // Corners that are far apart around the middle may cut the ring inside: without the middle
        // in its inside, edges could cross, which gives vertices off the grid.
        let rings: Vec<&[glam::Vec2]> = if case % 3 == 0 {
            vec![&outer]
        } else {
            vec![&outer, &inner]
        };
        let filled = triangulate_rings(&rings, FillRule::EvenOdd).expect("a small polygon");
        if filled.vertices.len() > rings.iter().map(|ring| ring.len()).sum() {
            continue;
        }

        let half = f32::from(SIDE) / 2.0;
        let corners = filled.triangles.as_flattened().iter();
        let ndc: Vec<[f32; 2]> = corners
            .map(|&vertex| filled.vertices[vertex as usize])
            .map(|p| [p.x / half - 1.0, 1.0 - p.y / half])
            .collect();
        let vertices = device
            .create_buffer_with_contents(estampe::bytes_of(&ndc))
            .expect("a buffer");
        let vertex_count = u32::try_from(ndc.len()).expect("a small polygon");
        device
            .render(&RenderPass {
                color_attachments: &[Some(ColorAttachment::clear(&image.view(), [0.0; 4]))],
                draws: &[Draw {
                    vertex_buffers: &[vertices.slice(..)],
                    ..Draw::new(&pipeline, 0..vertex_count)
                }],
                ..Default::default()
            })
            .expect("the pass is drawn");
        let texels = device.read_texture(&image).expect("the image");
        let drawn: Vec<bool> = texels.chunks_exact(4).map(|texel| texel[0] > 0).collect();

        let mut spans = vec![false; drawn.len()];
        fill_spans(&rings, FillRule::EvenOdd, [side; 2], |span| {
            for x in span.x.clone() {
                spans[(span.y * side + x) as usize] = true;
            }
        })
        .expect("coordinates in the window");
        assert!(spans == drawn, "case {case}: {rings:?}");
        total += 1;
        pixels += drawn.iter().filter(|is_drawn| **is_drawn).count();
    }
    assert!(total > 120 && pixels > 100_000, "{total} {pixels}");
}
