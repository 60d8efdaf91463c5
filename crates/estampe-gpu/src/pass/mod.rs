//! Render passes: attachments, what happens to their contents, and draws.

mod attachments;
mod check;
mod draw;
mod draw_data;
mod error;
mod images;
mod layers;
mod queries;
mod run;
mod side_by_side;
mod survey;

pub(crate) use attachments::{Attachments, Use};
pub use draw::Draw;
pub(crate) use draw_data::DrawMemory;
pub use error::{PassErrorKind, RenderPassError};
pub use queries::{RangeQueries, RangeResult};
pub(crate) use run::{check, core_pass, prepared, render};
pub(crate) use side_by_side::SideBySide;

use crate::texture::TextureView;
use estampe_core::{LoadOp, OcclusionQueries, PassControl, ResolveMode};

/// Draws into attachments: WebGPU's `GPURenderPassDescriptor` with the draws of the pass.
///
/// ```
/// use estampe::{ColorAttachment, Device, DeviceDescriptor, RenderPass};
/// use estampe::{TextureDescriptor, TextureFormat};
///
/// let device = Device::new(&DeviceDescriptor::default())?;
/// let descriptor = TextureDescriptor::new_2d(4, 4, TextureFormat::Rgba8Unorm);
/// let image = device.create_texture(&descriptor)?;
/// device.render(&RenderPass {
///     color_attachments: &[Some(ColorAttachment::clear(&image.view(), [1.0, 0.5, 0.0, 1.0]))],
///     ..RenderPass::default()
/// })?;
/// assert_eq!(device.read_texture(&image)?[..4], [255, 128, 0, 255]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct RenderPass<'a> {
    /// A name for error messages. Default none.
    pub label: Option<&'a str>,
    /// The colour attachments, by the number of the shader's colour; `None` is a hole, whose colour
    /// is dropped. Default none.
    pub color_attachments: &'a [Option<ColorAttachment>],
    /// The depth and stencil attachment. Default none.
    pub depth_stencil_attachment: Option<DepthStencilAttachment>,
    /// Width and height in pixels and the samples per pixel of a pass without attachments; of
    /// others they are the attachments'. Default none.
    pub extent: Option<PassExtent>,
    /// The counters of samples that pass all tests. Default none.
    pub occlusion_queries: Option<&'a OcclusionQueries>,
    /// Statistics and timestamps of ranges of the draws. Default none.
    pub range_queries: Option<&'a RangeQueries>,
    /// Cancelling the pass, and watching its progress. Default neither.
    pub control: PassControl<'a>,
    /// The draws, in order. Default none.
    pub draws: &'a [Draw<'a>],
}

/// The size of a pass without attachments.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct PassExtent {
    /// Width in pixels, 1 to 16384.
    pub width: u32,
    /// Height in pixels, 1 to 16384.
    pub height: u32,
    /// Samples per pixel: 1, 2, 4, 8 or 16.
    pub samples: u32,
}

/// Operation on an attachment's contents at the end of a pass: WebGPU's `GPUStoreOp`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum StoreOp {
    /// They are kept.
    #[default]
    Store,
    /// They become zeros where they are read next.
    ///
    /// Of an attachment that is cleared at the beginning nothing is written to memory then, unless
    /// the pass has more than about two million vertices or primitives: each thread keeps one tile
    /// of it, and the texture has no memory. So are the depths of most passes, and samples that are
    /// resolved: four times as many bytes as the picture has.
    Discard,
}

/// A colour attachment: WebGPU's `GPURenderPassColorAttachment`.
#[derive(Debug, Clone)]
pub struct ColorAttachment {
    /// The image that is rendered to: one level of one layer, or of as many layers as the views of
    /// all attachments of the pass have. Draws go to the first layer, but for primitives whose
    /// geometry shader [selects](crate::EmittedVertex::with_layer) another one.
    pub view: TextureView,
    /// The slice of a 3D texture that is rendered to; of others `None`.
    pub depth_slice: Option<u32>,
    /// The image of one sample to which the mean of each pixel's samples is written at the end.
    /// Default none.
    pub resolve_target: Option<TextureView>,
    /// The contents at the beginning: as they are, or this colour. Linear RGBA, which the format
    /// stores as it stores a fragment's colour; of integer formats the integers.
    pub load: LoadOp<[f64; 4]>,
    /// The contents at the end. Default stored.
    pub store: StoreOp,
}

impl ColorAttachment {
    /// An attachment that is cleared to a colour.
    #[must_use]
    pub fn clear(view: &TextureView, color: [f64; 4]) -> Self {
        Self {
            view: view.clone(),
            depth_slice: None,
            resolve_target: None,
            load: LoadOp::Clear(color),
            store: StoreOp::Store,
        }
    }

    /// An attachment whose contents are kept.
    #[must_use]
    pub fn load(view: &TextureView) -> Self {
        Self {
            load: LoadOp::Load,
            ..Self::clear(view, [0.0; 4])
        }
    }
}

/// The operations of a pass on one aspect of a depth and stencil attachment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AspectOperations<T> {
    /// Draws test it and do not write it; the texture can be sampled meanwhile.
    ReadOnly,
    /// Draws test it and write it.
    Write {
        /// The contents at the beginning.
        load: LoadOp<T>,
        /// The contents at the end.
        store: StoreOp,
    },
}

impl<T> AspectOperations<T> {
    /// Cleared at the beginning, stored at the end.
    pub fn clear(value: T) -> Self {
        Self::Write {
            load: LoadOp::Clear(value),
            store: StoreOp::Store,
        }
    }

    /// Kept at the beginning, stored at the end.
    #[must_use]
    pub fn load() -> Self {
        Self::Write {
            load: LoadOp::Load,
            store: StoreOp::Store,
        }
    }
}

/// A depth and stencil attachment: WebGPU's `GPURenderPassDepthStencilAttachment`.
#[derive(Debug, Clone)]
pub struct DepthStencilAttachment {
    /// The image that is tested and written: one level of one layer, or of as many as the colour
    /// attachments have.
    pub view: TextureView,
    /// Of depth, a number in 0..=1; without effect if the format has none.
    pub depth: AspectOperations<f32>,
    /// Of stencil; without effect if the format has none.
    pub stencil: AspectOperations<u8>,
    /// The image of one sample to which depth and stencil are written at the end, each by its mode
    /// if there is one. Default none.
    pub resolve: Option<DepthStencilResolve>,
}

impl DepthStencilAttachment {
    /// An attachment whose depth is cleared to a number in 0..=1, and whose stencil to 0.
    #[must_use]
    pub fn clear(view: &TextureView, depth: f32) -> Self {
        Self {
            view: view.clone(),
            depth: AspectOperations::clear(depth),
            stencil: AspectOperations::clear(0),
            resolve: None,
        }
    }

    /// An attachment whose contents are kept.
    #[must_use]
    pub fn load(view: &TextureView) -> Self {
        Self {
            depth: AspectOperations::load(),
            stencil: AspectOperations::load(),
            ..Self::clear(view, 1.0)
        }
    }

    /// An attachment that draws test and do not write.
    #[must_use]
    pub fn read_only(view: &TextureView) -> Self {
        Self {
            depth: AspectOperations::ReadOnly,
            stencil: AspectOperations::ReadOnly,
            ..Self::clear(view, 1.0)
        }
    }
}

/// How the samples of depth and stencil become one value.
#[derive(Debug, Clone)]
pub struct DepthStencilResolve {
    /// The image of one sample that is written.
    pub target: TextureView,
    /// The mode of depth; `None` leaves the target's depth as it is.
    pub depth: Option<ResolveMode>,
    /// The mode of stencil, not [`ResolveMode::Average`]; `None` leaves the target's stencil as it
    /// is.
    pub stencil: Option<ResolveMode>,
}
