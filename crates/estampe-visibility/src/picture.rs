//! Pictures of polygons: in the order in which they come, or by depth buffer; and the depth buffer
//! from above.

use crate::DrawError;
use crate::polygon::Corner;
use estampe::state::{CompareFunction, DepthState, VertexBufferLayout};
use estampe::{
    ColorAttachment, DepthStencilAttachment, Device, Draw, FragmentIn, FragmentOut, Mat4,
    RenderPass, RenderPipelineDescriptor, Texture, TextureDescriptor, TextureFormat, Vec3,
    VertexFormat, VertexIn, VertexOut, bytes_of,
};
use estampe_scene::Image;

/// The view of a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Clip space from world space, with reversed depth: 1 at the near plane, 0 at the far plane.
    pub clip_from_world: Mat4,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The colour where there is no polygon, 0 to 1 as the picture stores it.
    pub background: [f32; 3],
}

/// The way in which nearer polygons hide farther ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hiding {
    /// Later polygons hide earlier ones: the painter's algorithm.
    ByOrder,
    /// Nearer fragments hide farther ones, in a depth buffer of 32-bit floats; of equal depths the
    /// later.
    ByDepth,
}

/// A picture with its depth buffer.
#[derive(Debug, Clone, PartialEq)]
pub struct DepthPicture {
    /// The pixels.
    pub image: Image,
    /// The depth of each pixel, 0 where there is no polygon.
    pub depths: Vec<f32>,
}

/// Polygons in world space, each corner with its colour.
struct Colored {
    clip_from_world: Mat4,
}

estampe::attributes! {
    struct ColoredCorner<R> { position: Vec3<R>, color: Vec3<R> }
}

estampe::varyings! {
    struct Color<R> { color: Vec3<R> }
}

estampe::shader! {
    impl Shader for Colored {
        type Attributes<R: Real> = ColoredCorner<R>;
        type Varyings<R: Real> = Color<R>;

        fn vertex<R: Real>(
            &self,
            _: VertexIn<'_, R>,
            a: ColoredCorner<R>,
        ) -> VertexOut<R, Color<R>> {
            let clip = self.clip_from_world.transform_point(a.position);
            VertexOut::new(clip, Color { color: a.color })
        }

        fn fragment<R: Real>(&self, _: FragmentIn<'_, R>, v: Color<R>) -> FragmentOut<R> {
            FragmentOut::color(v.color.point())
        }
    }
}

/// Draws convex polygons, whose three attributes are red, green and blue, 0 to 1 as the picture
/// stores them.
///
/// # Errors
/// [`DrawError`] if the picture or the polygons do not fit the device.
pub fn draw<'p>(
    device: &Device,
    view: &View,
    polygons: impl Iterator<Item = &'p [Corner<3>]>,
    hiding: Hiding,
) -> Result<Image, DrawError> {
    let (color, _) = render(device, view, polygons, hiding)?;
    image(device, &color)
}

/// Draws convex polygons as [`draw`] does, by depth buffer, and reads the buffer too.
///
/// # Errors
/// [`DrawError`] as for [`draw`].
pub fn draw_with_depths<'p>(
    device: &Device,
    view: &View,
    polygons: impl Iterator<Item = &'p [Corner<3>]>,
) -> Result<DepthPicture, DrawError> {
    let (color, depth) = render(device, view, polygons, Hiding::ByDepth)?;
    let depths = match &depth {
        Some(depth) => device.read_texture(depth)?,
        None => Vec::new(),
    };
    let words = depths.as_chunks::<4>().0.iter();
    Ok(DepthPicture {
        image: image(device, &color)?,
        depths: words.map(|word| f32::from_le_bytes(*word)).collect(),
    })
}

fn image(device: &Device, color: &Texture) -> Result<Image, DrawError> {
    Ok(Image {
        width: color.width(),
        height: color.height(),
        rgba: device.read_texture(color)?,
    })
}

/// Draws to textures of colour and of depth, if it is used.
fn render<'p>(
    device: &Device,
    view: &View,
    polygons: impl Iterator<Item = &'p [Corner<3>]>,
    hiding: Hiding,
) -> Result<(Texture, Option<Texture>), DrawError> {
    let mut numbers: Vec<f32> = Vec::new();
    for corners in polygons {
        for k in 2..corners.len() {
            for corner in [&corners[0], &corners[k - 1], &corners[k]] {
                #[expect(
                    clippy::cast_possible_truncation,
                    reason = "rounds to the nearest float"
                )]
                numbers.extend(corner.position.map(|x| x as f32));
                numbers.extend(corner.attributes);
            }
        }
    }
    let count = u32::try_from(numbers.len() / 6).unwrap_or(u32::MAX);
    let [width, height] = view.size;
    let texture = |format| device.create_texture(&TextureDescriptor::new_2d(width, height, format));
    let color = texture(TextureFormat::Rgba8Unorm)?;
    let depth = match hiding {
        Hiding::ByOrder => None,
        Hiding::ByDepth => Some(texture(TextureFormat::Depth32Float)?),
    };
    let depth_state = DepthState {
        write_enabled: true,
        compare: CompareFunction::GreaterEqual,
    };
    let formats = [VertexFormat::Float32x3; 2];
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
        vertex_buffers: vec![VertexBufferLayout::packed(&formats)],
        depth_stencil: depth.is_some().then_some(depth_state.into()),
        ..RenderPipelineDescriptor::new(Colored {
            clip_from_world: view.clip_from_world,
        })
    })?;
    let vertices = device.create_buffer_with_contents(bytes_of(&numbers))?;
    let buffers = [(&vertices).into()];
    let draw = Draw {
        vertex_buffers: &buffers,
        ..Draw::new(&pipeline, 0..count)
    };
    let [r, g, b] = view.background.map(f64::from);
    let cleared = ColorAttachment::clear(&color.view(), [r, g, b, 1.0]);
    device.render(&RenderPass {
        color_attachments: &[Some(cleared)],
        depth_stencil_attachment: depth
            .as_ref()
            .map(|depth| DepthStencilAttachment::clear(&depth.view(), 0.0)),
        draws: &[draw],
        ..RenderPass::default()
    })?;
    Ok((color, depth))
}

impl DepthPicture {
    /// The depth buffer from above: column x has a point for each pixel of the picture's column x,
    /// at the row of the pixel's distance, the nearest at the bottom. `distance` maps depths to 0
    /// (nearest) to 1 (farthest); pixels whose distance is outside, and those without polygon, have
    /// no point. Of points at one place the one of the lowest row of the picture is shown.
    ///
    /// The buffer holds the nearest surface of each pixel, and nothing of those behind it.
    #[must_use]
    pub fn from_above(
        &self,
        rows: u32,
        background: [u8; 3],
        distance: impl Fn(f32) -> f32,
    ) -> Image {
        let [r, g, b] = background;
        let width = self.image.width;
        let mut above = Image::filled(width, rows, [r, g, b, 255]);
        let row_count = rows as f32;
        for (pixel, depth) in self.depths.iter().enumerate() {
            let place = distance(*depth);
            if *depth <= 0.0 || !(0.0..=1.0).contains(&place) || rows == 0 {
                continue;
            }
            #[expect(clippy::cast_possible_truncation, reason = "0 to the number of rows")]
            #[expect(clippy::cast_sign_loss, reason = "not negative")]
            let row = ((1.0 - place) * row_count).min(row_count - 1.0) as usize;
            let column = pixel % width as usize;
            let (from, to) = (pixel * 4, (row * width as usize + column) * 4);
            above.rgba[to..to + 4].copy_from_slice(&self.image.rgba[from..from + 4]);
        }
        above
    }
}

/// Number of pixels in which two pictures of one size differ.
#[must_use]
pub fn differing_pixels(a: &Image, b: &Image) -> usize {
    let (a, b) = (a.rgba.as_chunks::<4>().0, b.rgba.as_chunks::<4>().0);
    let differing = a.iter().zip(b).filter(|(a, b)| a != b).count();
    differing + a.len().abs_diff(b.len())
}
