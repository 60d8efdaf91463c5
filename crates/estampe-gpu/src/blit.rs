//! Blits: a rectangle of an image, scaled and converted into a rectangle of another one.

use crate::pass::{self, ColorAttachment, Draw, RenderPass};
use crate::texture::{Sampler, Texture, TextureUsages, TextureView};
use crate::{Coordinates, Lod, Real, SampleType, SampledTexture, ViewDimension};
use crate::{
    Device, FilterMode, FragmentIn, FragmentOut, LoadOp, PipelineError, RenderPassError,
    RenderPipelineDescriptor, SamplerDescriptor, TextureError, Vec2, Vec4, VertexIn, VertexOut,
};
use estampe_types::state::{ColorTargetState, Viewport};

/// One side of a blit: an image, and a rectangle of it in texels.
#[derive(Debug, Clone, Copy)]
pub struct BlitRegion<'a> {
    /// A 2D view of one level of one layer.
    pub view: &'a TextureView,
    /// Column and row of the first texel.
    pub origin: [u32; 2],
    /// Width and height.
    pub size: [u32; 2],
}

impl<'a> From<&'a TextureView> for BlitRegion<'a> {
    /// All of the image.
    fn from(view: &'a TextureView) -> Self {
        Self {
            view,
            origin: [0; 2],
            size: view.size(),
        }
    }
}

/// The reason why nothing was blitted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BlitError {
    /// A rectangle that is empty or not in its image.
    #[error(
        "the {side} of the blit is {}x{} texels at ({}, {}) of an image of {}x{}: it must not be empty, and lie \
         in the image",
        size[0], size[1], origin[0], origin[1], image[0], image[1]
    )]
    Region {
        /// Source or destination.
        side: &'static str,
        /// The first texel.
        origin: [u32; 2],
        /// Width and height.
        size: [u32; 2],
        /// Width and height of the image.
        image: [u32; 2],
    },
    /// A view that is not one 2D image of one sample with colours.
    #[error(
        "the {0} of the blit is not a 2D view of one level of one layer, of one sample and numbers"
    )]
    NotAnImage(&'static str),
    /// The textures are the same.
    #[error("source and destination of the blit are the same texture: copy to another one first")]
    SameTexture,
    /// The source cannot be sampled.
    #[error(transparent)]
    Texture(#[from] TextureError),
    /// The destination's format cannot be rendered to.
    #[error(transparent)]
    Pipeline(#[from] PipelineError),
    /// The destination cannot be rendered to.
    #[error(transparent)]
    Pass(#[from] RenderPassError),
}

/// Samples the source at the place that corresponds to a pixel of the destination.
#[derive(Debug)]
struct Blit {
    source: SampledTexture,
    filter: FilterMode,
    axes: [Axis; 2],
}

/// One axis of a blit, in texels and pixels.
#[derive(Debug, Clone, Copy)]
struct Axis {
    /// First texel and number of texels of the source's rectangle.
    from: [f32; 2],
    /// First pixel and number of pixels of the destination's rectangle.
    into: [f32; 2],
    /// 1 ÷ the side of the source's image.
    inverse_side: f32,
}

impl Axis {
    /// The coordinate at which the source is sampled for a pixel's centre: `docs/NUMERICS.md`,
    /// *Blits*. With the nearest filter the texel is found in units of texels, where the places
    /// between two texels, which all pixels of an image that is halved have, are exact.
    #[inline(always)]
    fn coordinate<R: Real>(&self, filter: FilterMode, position: R) -> R {
        let pixel = position - self.into[0];
        let texels = match filter {
            FilterMode::Nearest => {
                let into = pixel.splat(self.into[1]);
                (pixel * self.from[1] / into).floor() + (self.from[0] + 0.5)
            }
            FilterMode::Linear => pixel * (self.from[1] / self.into[1]) + self.from[0],
        };
        texels * self.inverse_side
    }
}

estampe_types::shader! {
    impl Shader for Blit {
        type Attributes<R: Real> = ();
        type Varyings<R: Real> = ();
        const READS_POSITION: bool = true;

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, (): ()) -> VertexOut<R, ()> {
            // The triangle (−1, 1), (3, 1), (−1, −3) covers the whole viewport.
            let index = input.vertex_index;
            let x = (index & index.splat(1)).to_real() * 4.0 - 1.0;
            let y = 1.0 - (index >> 1).to_real() * 4.0;
            VertexOut::new(Vec4::new(x, y, input.real(0.0), input.real(1.0)), ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
            let at = Vec2::new(
                self.axes[0].coordinate(self.filter, input.position.x),
                self.axes[1].coordinate(self.filter, input.position.y),
            );
            let level = Lod::Level(input.zero);
            FragmentOut::color(self.source.sample_with(Coordinates::d2(at), level, [0; 3]))
        }
    }
}

/// Checks a blit.
pub(crate) fn check(
    device: &Device,
    from: &BlitRegion<'_>,
    into: &BlitRegion<'_>,
    filter: FilterMode,
) -> Result<(), BlitError> {
    check_region("source", from)?;
    check_region("destination", into)?;
    if from.view.texture().is_same(into.view.texture()) {
        return Err(BlitError::SameTexture);
    }
    let usage = TextureUsages::TEXTURE_BINDING;
    from.view.texture().require(usage)?;
    from.view.check_sampler(&sampler(device, filter)?)?;
    Ok(pass::check(
        device,
        &RenderPass {
            label: Some("blit"),
            color_attachments: &[Some(ColorAttachment::load(into.view))],
            ..RenderPass::default()
        },
    )?)
}

fn sampler(device: &Device, filter: FilterMode) -> Result<Sampler, TextureError> {
    device.create_sampler(&SamplerDescriptor {
        mag_filter: filter,
        min_filter: filter,
        ..SamplerDescriptor::default()
    })
}

/// Blits.
pub(crate) fn blit(
    device: &Device,
    from: &BlitRegion<'_>,
    into: &BlitRegion<'_>,
    filter: FilterMode,
) -> Result<(), BlitError> {
    check(device, from, into, filter)?;
    let sampler = sampler(device, filter)?;
    let image = from.view.size();
    let axis = |axis: usize| Axis {
        from: [from.origin[axis] as f32, from.size[axis] as f32],
        into: [into.origin[axis] as f32, into.size[axis] as f32],
        inverse_side: 1.0 / image[axis] as f32,
    };
    let shader = Blit {
        source: device.sampled_texture(from.view, &sampler)?,
        filter,
        axes: [axis(0), axis(1)],
    };
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
        depth_stencil: None,
        targets: vec![Some(ColorTargetState::from(into.view.format()))],
        ..RenderPipelineDescriptor::new(shader)
    })?;
    let [x, y, width, height] = [into.origin[0], into.origin[1], into.size[0], into.size[1]];
    let draw = Draw {
        viewport: Some(Viewport {
            x: x as f32,
            y: y as f32,
            width: width as f32,
            height: height as f32,
            min_depth: 0.0,
            max_depth: 1.0,
        }),
        ..Draw::new(&pipeline, 0..3)
    };
    device.render(&RenderPass {
        label: Some("blit"),
        color_attachments: &[Some(ColorAttachment {
            load: LoadOp::Load,
            ..ColorAttachment::load(into.view)
        })],
        draws: &[draw],
        ..RenderPass::default()
    })?;
    Ok(())
}

fn check_region(side: &'static str, region: &BlitRegion<'_>) -> Result<(), BlitError> {
    let view = region.view;
    let texture: &Texture = view.texture();
    if view.image_key(None).is_none()
        || view.dimension() != ViewDimension::D2
        || texture.sample_count() != 1
        || view.format().sample_type() != SampleType::Float
    {
        return Err(BlitError::NotAnImage(side));
    }
    let image = view.size();
    let fits = |axis: usize| {
        let end = u64::from(region.origin[axis]) + u64::from(region.size[axis]);
        region.size[axis] > 0 && end <= u64::from(image[axis])
    };
    if fits(0) && fits(1) {
        return Ok(());
    }
    Err(BlitError::Region {
        side,
        origin: region.origin,
        size: region.size,
        image,
    })
}
