//! Rung 18: z-fighting of two planes 2 cm apart, far = 100 m, and its cures, 240×240 each.
//!
//! `cargo run --release --example ladder_18_z_fighting`

use estampe::state::{CompareFunction, DepthState, PrimitiveTopology, VertexBufferLayout};
use estampe::{
    ColorAttachment, DepthStencilAttachment, Draw, FragmentIn, FragmentOut, Mat4, RenderPass,
    RenderPipelineDescriptor, TextureDescriptor, TextureFormat, Vec3, VertexFormat, VertexIn,
    VertexOut, bytes_of,
};
use estampe_ladder::{Course, LadderError, Picture};

const SIZE: u32 = 240;
const FAR: f32 = 100.0;

/// A horizontal plane at a height, with stripes every five metres.
struct Plane {
    clip_from_world: Mat4,
    height: f32,
    color: [f32; 3],
}

estampe::shader! {
    impl Shader for Plane {
        type Attributes<R: Real> = Vec3<R>;
        type Varyings<R: Real> = R; // distance

        fn vertex<R: Real>(&self, _: VertexIn<'_, R>, at: Vec3<R>) -> VertexOut<R, R> {
            let at = Vec3::new(at.x, at.y + self.height, at.z);
            VertexOut::new(self.clip_from_world.transform_point(at), at.z)
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, z: R) -> FragmentOut<R> {
            let is_bright = (z * 0.1).fract().lt(0.5);
            let light = R::select(is_bright, input.real(1.0), input.real(0.8));
            FragmentOut::color((Vec3::from(self.color) * light).point())
        }
    }
}

/// A scene: the distance of the planes and of the near plane, the format, and the mapping.
struct Scene {
    gap: f32,
    near: f32,
    format: TextureFormat,
    is_reversed: bool,
}

const fn scene(gap: f32, near: f32, format: TextureFormat, is_reversed: bool) -> Scene {
    Scene {
        gap,
        near,
        format,
        is_reversed,
    }
}

use TextureFormat::{Depth16Unorm, Depth24Plus, Depth32Float};

/// Depth is d = far·(z − near) / (z·(far − near)) at the distance z. Steps of 2⁻ᵇ in d are steps of
///
/// ```text
///   Δz ≈ z² / (near · 2ᵇ)       24 bits, z = 50: near = 0.01 → 1.5 cm, 10⁻⁴ → 1.5 m, 10⁻⁵ → 15 m
/// ```
///
/// so nearly all precision lies next to the near plane, and moving that plane away is the cheapest
/// cure. A float has its finest steps at 0; with z reversed they are where 1/z is coarse.
const SCENES: [Scene; 8] = [
    scene(0.02, 1e-2, Depth24Plus, false),
    scene(0.02, 1e-4, Depth24Plus, false),
    scene(0.02, 1e-5, Depth24Plus, false),
    scene(0.02, 1e-2, Depth16Unorm, false),
    scene(1.0, 1e-4, Depth24Plus, false),
    scene(0.02, 1.0, Depth24Plus, false),
    scene(0.02, 1e-4, Depth32Float, false),
    scene(0.02, 1e-4, Depth32Float, true),
];

fn panel(course: &Course, scene: &Scene) -> Result<Picture, LadderError> {
    let device = &course.device;
    let projection = if scene.is_reversed {
        Mat4::perspective_reversed(0.8, 1.0, scene.near, FAR)
    } else {
        Mat4::perspective(0.8, 1.0, scene.near, FAR)
    };
    let view_from_world = Mat4::look_at([0.0, 8.0, 0.0], [0.0, 0.0, -22.0], Course::UP);
    let clip_from_world = projection * view_from_world;
    let (compare, farthest) = if scene.is_reversed {
        (CompareFunction::Greater, 0.0)
    } else {
        (CompareFunction::Less, 1.0)
    };
    // A square around (0, 0, −34), and the same turned by 45 degrees: with the same corners, both
    // planes would have the same rounding.
    let (side, diagonal) = (24.0, 30.0);
    let corners: [[f32; 3]; 8] = [
        [-side, 0.0, side],
        [side, 0.0, side],
        [-side, 0.0, -side],
        [side, 0.0, -side],
        [0.0, 0.0, diagonal],
        [diagonal, 0.0, 0.0],
        [-diagonal, 0.0, 0.0],
        [0.0, 0.0, -diagonal],
    ]
    .map(|[x, y, z]| [x, y, z - 34.0]);
    let vertices = [(&device.create_buffer_with_contents(bytes_of(&corners))?).into()];
    // The lower plane, in red, is drawn first: it stays where both depths are equal.
    let mut pipelines = Vec::new();
    for (height, color) in [(0.0, [0.9, 0.15, 0.1]), (scene.gap, [0.2, 0.45, 0.9])] {
        let mut descriptor = RenderPipelineDescriptor::new(Plane {
            clip_from_world,
            height,
            color,
        });
        descriptor.vertex_buffers = vec![VertexBufferLayout::packed(&[VertexFormat::Float32x3])];
        descriptor.primitive.topology = PrimitiveTopology::TriangleStrip;
        let write_enabled = true;
        let depth = DepthState {
            write_enabled,
            compare,
        };
        descriptor.depth_stencil = Some(depth.into());
        pipelines.push(device.create_render_pipeline(&descriptor)?);
    }
    let texture = |format| device.create_texture(&TextureDescriptor::new_2d(SIZE, SIZE, format));
    let (color, depth) = (texture(TextureFormat::Rgba8Unorm)?, texture(scene.format)?);
    let draws = pipelines
        .iter()
        .zip([0..4, 4..8])
        .map(|(pipeline, square)| Draw {
            vertex_buffers: &vertices,
            ..Draw::new(pipeline, square)
        });
    device.render(&RenderPass {
        color_attachments: &[Some(ColorAttachment::clear(
            &color.view(),
            [0.0, 0.0, 0.0, 1.0],
        ))],
        depth_stencil_attachment: Some(DepthStencilAttachment::clear(&depth.view(), farthest)),
        draws: &draws.collect::<Vec<_>>(),
        ..RenderPass::default()
    })?;
    Picture::of_texture(device, &color)
}

/// Above: near = 10⁻², 10⁻⁴ and 10⁻⁵ with 24 bits, and 10⁻² with 16 bits. Below, the cures of the
/// second: planes 1 m apart; near = 1; a 32-bit float, which alone gains little; the float with
/// reversed z.
///
/// # Errors
/// If the textures do not fit the device.
pub fn draw(course: &Course) -> Result<Picture, LadderError> {
    let panels: Result<Vec<_>, _> = SCENES.iter().map(|scene| panel(course, scene)).collect();
    Ok(Picture::in_columns(4, &panels?))
}

fn main() -> std::process::ExitCode {
    estampe_ladder::run(18, draw)
}
