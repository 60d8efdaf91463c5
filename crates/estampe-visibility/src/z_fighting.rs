//! Z-fighting: two planes one above the other, whose depths a buffer does or does not tell apart.
//!
//! ```text
//!   eye, 8 above
//!    ●
//!      ╲ ╲       a ray meets the upper plane at z·(1 − gap/8) and the lower at z:
//!        ╲ ╲     they are z·gap/8 apart along the view axis
//!   ═══════╲═╲═══════ upper, blue
//!   ─────────╲─╲───── lower, red, drawn first
//! ```
//!
//! With a separation s = z²/(n·2ᵇ) that is told apart, the planes fight beyond z = n·2ᵇ·gap/8, and
//! nowhere if n > 8·z/(gap·2ᵇ) at their far end: in real numbers. The scene measures it.

use crate::DrawError;
use crate::precision::DepthMethod;
use estampe::state::{CompareFunction, DepthState, PrimitiveTopology, VertexBufferLayout};
use estampe::{
    ColorAttachment, DepthStencilAttachment, Device, Draw, FragmentIn, FragmentOut, Mat4,
    RenderPass, RenderPipelineDescriptor, TextureDescriptor, TextureFormat, Vec3, VertexFormat,
    VertexIn, VertexOut, bytes_of,
};
use estampe_scene::Image;

/// The height of the eye above the lower plane.
pub const EYE_HEIGHT: f32 = 8.0;
/// The distance along the view axis of the planes' far end, about.
pub const FAR_END: f32 = 58.0;

/// The size of a picture in pixels.
const SIZE: [u32; 2] = [240, 240];
const EYE: [f32; 3] = [4.0, EYE_HEIGHT, 0.0];
const TARGET: [f32; 3] = [-2.0, 0.0, -22.0];
/// Half of a plane's side, and the z of its middle.
const HALF: f32 = 28.0;
const MIDDLE: f32 = -32.0;

/// The picture of the scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fight {
    /// The pixels.
    pub image: Image,
    /// Pixels that show the lower plane where the upper one covers it.
    pub wrong: usize,
    /// Pixels that the upper plane covers.
    pub upper: usize,
}

/// A plane with stripes. Its depth is the projection's.
struct Plane {
    clip_from_world: Mat4,
    height: f32,
    color: [f32; 3],
}

/// A [`Plane`] with the depth of a method's logarithm.
struct LogarithmicPlane(Plane, DepthMethod);

estampe::varyings! {
    struct Ground<R> { z: R, w: R }
}

estampe::shader! {
    impl Shader for Plane {
        type Attributes<R: Real> = Vec3<R>; // x, 0, z
        type Varyings<R: Real> = Ground<R>;

        fn vertex<R: Real>(&self, _: VertexIn<'_, R>, a: Vec3<R>) -> VertexOut<R, Ground<R>> {
            let at = Vec3::new(a.x, a.y + self.height, a.z);
            let clip = self.clip_from_world.transform_point(at);
            let w = clip.w;
            VertexOut::new(clip, Ground { z: a.z, w })
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, v: Ground<R>) -> FragmentOut<R> {
            let is_bright = (v.z * 0.1).fract().lt(0.5);
            let light = R::select(is_bright, input.real(1.0), input.real(0.8));
            FragmentOut::color((Vec3::from(self.color) * light).point())
        }
    }
}

estampe::shader! {
    impl Shader for LogarithmicPlane {
        type Attributes<R: Real> = Vec3<R>;
        type Varyings<R: Real> = Ground<R>;

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, a: Vec3<R>) -> VertexOut<R, Ground<R>> {
            self.0.vertex(input, a)
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, v: Ground<R>) -> FragmentOut<R> {
            let depth = self.1.logarithmic_depth(v.w);
            self.0.fragment(input, v).with_depth(depth)
        }
    }
}

/// Draws two planes of 56×56, `gap` apart, by a depth method, and counts the wrong pixels.
///
/// The upper plane hides the lower one wherever both are in the picture, so the right picture is
/// drawn without depth: the upper after the lower.
///
/// # Errors
/// [`DrawError`] if the device has no memory for the picture.
pub fn draw(device: &Device, method: &DepthMethod, gap: f32) -> Result<Fight, DrawError> {
    let fight = picture(device, method, gap, true)?;
    let right = picture(device, method, gap, false)?;
    let [shown, expected] = [&fight, &right].map(|image| image.rgba.as_chunks::<4>().0);
    let wrong = shown.iter().zip(expected).filter(|(a, b)| a != b).count();
    let upper = expected.iter().filter(|[r, _, b, _]| b > r).count();
    Ok(Fight {
        image: fight,
        wrong,
        upper,
    })
}

/// The largest near plane with wrong pixels, found by halving the interval of its logarithm between
/// 10⁻⁷ and 4, the beginning of the planes; `None` if there are none at 10⁻⁷. `method` makes the
/// method of a near plane.
///
/// # Errors
/// [`DrawError`] as for [`draw`].
pub fn onset(
    device: &Device,
    gap: f32,
    method: impl Fn(f32) -> Option<DepthMethod>,
) -> Result<Option<f32>, DrawError> {
    let is_wrong = |near: f32| -> Result<bool, DrawError> {
        match method(near) {
            Some(method) => Ok(draw(device, &method, gap)?.wrong > 0),
            None => Ok(false),
        }
    };
    let (mut wrong, mut right) = (1e-7_f32, 4.0_f32);
    if !is_wrong(wrong)? {
        return Ok(None);
    }
    if is_wrong(right)? {
        return Ok(Some(right));
    }
    for _ in 0..16 {
        let middle = (wrong * right).sqrt();
        if is_wrong(middle)? {
            wrong = middle;
        } else {
            right = middle;
        }
    }
    Ok(Some(wrong))
}

/// The picture, with the depth test or without.
fn picture(
    device: &Device,
    method: &DepthMethod,
    gap: f32,
    has_depth: bool,
) -> Result<Image, DrawError> {
    let view_from_world = Mat4::look_at(EYE, TARGET, [0.0, 1.0, 0.0]);
    let plane = |height: f32, color: [f32; 3]| Plane {
        clip_from_world: method.clip_from_view(0.8, 1.0) * view_from_world,
        height,
        color,
    };
    let pipeline = |plane: Plane| {
        let mut descriptor = if method.mapping().is_logarithmic {
            RenderPipelineDescriptor::new(LogarithmicPlane(plane, *method))
        } else {
            RenderPipelineDescriptor::new(plane)
        };
        descriptor.vertex_buffers = vec![VertexBufferLayout::packed(&[VertexFormat::Float32x3])];
        descriptor.primitive.topology = PrimitiveTopology::TriangleList;
        let depth = DepthState {
            write_enabled: true,
            compare: if method.mapping().is_reversed {
                CompareFunction::Greater
            } else {
                CompareFunction::Less
            },
        };
        descriptor.depth_stencil = has_depth.then_some(depth.into());
        device.create_render_pipeline(&descriptor)
    };
    // The lower plane is drawn first: it stays where both depths are equal. The planes are grids of
    // different cells: with the same vertices they would round alike.
    let planes = [(0.0, [0.9, 0.15, 0.1], 9), (gap, [0.2, 0.45, 0.9], 14)];
    let mut prepared = Vec::new();
    for (height, color, cells) in planes {
        let numbers = grid(cells);
        let vertices = device.create_buffer_with_contents(bytes_of(&numbers))?;
        let count = u32::try_from(numbers.len() / 3).unwrap_or(u32::MAX);
        let pipeline = pipeline(plane(height, color))?;
        prepared.push((pipeline, [(&vertices).into()], count));
    }
    let draws: Vec<Draw<'_>> = prepared
        .iter()
        .map(|(pipeline, buffers, count)| Draw {
            vertex_buffers: buffers,
            ..Draw::new(pipeline, 0..*count)
        })
        .collect();

    let [width, height] = SIZE;
    let texture = |format| device.create_texture(&TextureDescriptor::new_2d(width, height, format));
    let color = texture(TextureFormat::Rgba8Unorm)?;
    let depth = texture(method.format().texture_format())?;
    let depth = DepthStencilAttachment::clear(&depth.view(), method.farthest_depth());
    let cleared = ColorAttachment::clear(&color.view(), [1.0; 4]);
    device.render(&RenderPass {
        color_attachments: &[Some(cleared)],
        depth_stencil_attachment: has_depth.then_some(depth),
        draws: &draws,
        ..RenderPass::default()
    })?;
    Ok(Image {
        width,
        height,
        rgba: device.read_texture(&color)?,
    })
}

/// A plane of `cells` × `cells` squares as triangles: x, 0, z.
fn grid(cells: u8) -> Vec<f32> {
    let at = |cell: u8| f32::from(cell) / f32::from(cells) * 2.0 - 1.0;
    let mut numbers = Vec::new();
    for i in 0..cells {
        for j in 0..cells {
            let (left, right, near, far) = (at(i), at(i + 1), at(j), at(j + 1));
            let corners = [
                (left, near),
                (right, near),
                (left, far),
                (right, near),
                (right, far),
                (left, far),
            ];
            numbers.extend(
                corners
                    .iter()
                    .flat_map(|(x, z)| [x * HALF, 0.0, z * HALF + MIDDLE]),
            );
        }
    }
    numbers
}
