//! Bloom: bright lights in a float format, halved by blits, blurred along both axes at each size,
//! added again, and brought into the range of a screen.
//!
//! `cargo run --release -p estampe-gpu --features png --example bloom [OUT.png]`

mod scene;

use estampe::state::BlendState;
use estampe::{
    ColorAttachment, Device, FilterMode, FragmentIn, FragmentOut, Mat4, RenderPass,
    RenderPipelineDescriptor, SamplerDescriptor, Texture, TextureBindings, TextureDescriptor,
    TextureFormat, Vec2, VertexIn, VertexOut, maths,
};
use scene::{Lit, Objects, Outcome, SIZE, Screen, Solid};

const HDR: TextureFormat = TextureFormat::Rgba16Float;

/// The sum of up to nine texels along `step`, each times its weight.
#[derive(Clone, Copy)]
struct Filter {
    /// From texel to texel, in texture coordinates.
    step: [f32; 2],
    weights: [f32; 5],
    /// Subtracted from the sum.
    threshold: f32,
    /// If set, brightness is compressed into 0..1.
    maps_tone: bool,
}

/// Adds this share of a texture.
fn share(share: f32) -> Filter {
    Filter {
        step: [0.0; 2],
        weights: [share, 0.0, 0.0, 0.0, 0.0],
        threshold: 0.0,
        maps_tone: false,
    }
}

fn blur(step: [f32; 2]) -> Filter {
    Filter {
        step,
        weights: [0.227, 0.194, 0.121, 0.054, 0.016],
        ..share(0.0)
    }
}

estampe::shader! {
    impl Shader for Filter {
        type Attributes<R: Real> = ();
        type Varyings<R: Real> = Vec2<R>; // texture coordinates

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, (): ()) -> VertexOut<R, Vec2<R>> {
            let at = scene::covering(input);
            VertexOut::new(at, at.xy() * Vec2::new(0.5, -0.5) + 0.5)
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, uv: Vec2<R>) -> FragmentOut<R> {
            let source = input.bindings.sampled_texture(0, 0);
            let texel = |offset: f32| {
                source.sample(uv + Vec2::from(self.step) * offset).rgb()
            };
            let mut sum = texel(0.0) * self.weights[0] - self.threshold;
            for (k, weight) in self.weights.into_iter().enumerate().skip(1) {
                if weight > 0.0 {
                    sum += (texel(k as f32) + texel(-(k as f32))) * weight;
                }
            }
            let color = if self.maps_tone { 1.0 - (-sum).exp() } else { sum.max(0.0) };
            FragmentOut::color(color.point())
        }
    }
}

/// Tubes of light in a circle, blocks beside them, and a ball in the middle.
fn lights(device: &Device) -> Outcome<Texture> {
    let (floor, cube) = (Solid::plane(device, 60.0)?, Solid::cube(device)?);
    let ball = Solid::sphere(device)?;
    let middle = Mat4::translation([0.0, 0.8, 0.0]) * Mat4::scale([0.8; 3]);
    let mut list = vec![(&floor, Mat4::IDENTITY, [0.008, 0.008, 0.016, 0.0])];
    list.push((&ball, middle, [0.2, 0.22, 0.3, 0.0]));
    for k in 0..9_u8 {
        let turn = f32::from(k) / 9.0 * std::f32::consts::TAU;
        let hue = |shift: f32| 0.52 + 0.48 * maths::cos(turn + shift);
        let color = [hue(0.0), hue(2.1), hue(4.2), 7.0];
        let place = Mat4::rotation_y(turn + 0.2) * Mat4::translation([0.0, 0.0, 2.4]);
        let tube = Mat4::translation([0.0, 1.0, 0.0]) * Mat4::scale([0.035, 1.0, 0.035]);
        let block = Mat4::translation([0.7, 0.3, 0.3]) * Mat4::scale([0.3; 3]);
        list.push((&cube, place * tube, color));
        list.push((&cube, place * block, [0.32, 0.26, 0.42, 0.0]));
    }
    let screen = Screen::of_format(device, HDR)?;
    let objects = Objects::new(device, &list)?;
    let clip_from_world = scene::camera([0.0, 3.0, 7.0], [0.0, 0.7, 0.0]);
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
        bind_group_layouts: vec![objects.layout.clone()],
        ..screen.pipeline(Lit { clip_from_world })
    })?;
    device.render(&RenderPass {
        color_attachments: &screen.colors([0.0; 3]),
        depth_stencil_attachment: screen.depths(),
        draws: &objects.draws(&pipeline),
        ..RenderPass::default()
    })?;
    Ok(screen.picture)
}

fn picture(device: &Device) -> Outcome<Texture> {
    let sampler = device.create_sampler(&SamplerDescriptor::linear())?;
    let run = |filter: Filter, from: &Texture, into: ColorAttachment, blend| {
        let bound = scene::bind(device, &[scene::sampled(&from.view(), &sampler)])?;
        scene::fill(device, filter, &[&bound], into, blend)
    };
    let clear = |into: &Texture| ColorAttachment::clear(&into.view(), [0.0; 4]);
    let image = |level: u32| {
        let [width, height] = SIZE.map(|side| side >> level);
        device.create_texture(&TextureDescriptor::new_2d(width, height, HDR))
    };

    let (sum, mut larger) = (lights(device)?, image(0)?);
    let mut bright = share(1.0);
    bright.threshold = 1.0;
    run(bright, &sum, clear(&larger), None)?;
    for level in 1..5 {
        let (smaller, between) = (image(level)?, image(level)?);
        let (from, into) = (larger.view(), smaller.view());
        device.blit(&from, &into, FilterMode::Linear)?;
        let [width, height] = into.size().map(|side| side as f32);
        run(blur([1.0 / width, 0.0]), &smaller, clear(&between), None)?;
        run(blur([0.0, 1.0 / height]), &between, clear(&smaller), None)?;
        let add = ColorAttachment::load(&sum.view());
        run(share(0.25), &smaller, add, Some(BlendState::ADDITIVE))?;
        larger = smaller;
    }
    let picture = scene::target(device, TextureFormat::Rgba8UnormSrgb, 1)?;
    let mut last = share(1.0);
    last.maps_tone = true;
    run(last, &sum, clear(&picture), None)?;
    Ok(picture)
}

fn main() -> Outcome<()> {
    scene::write("bloom", picture)
}

#[test]
fn bloom_draws_its_picture() {
    scene::kept::check("bloom", picture);
}
