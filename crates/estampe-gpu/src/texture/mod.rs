//! Textures: images of any dimension, format and role, and their views.

mod blocks;
mod contents;
mod copy_texels;
mod error;
mod first_texels;
mod host_access;
mod region;
mod reservation;
mod stores;
mod view;
mod words;

pub(crate) use contents::{Contents, Image, ImageKey, Needs, Newest, words_of};
pub(crate) use copy_texels::{check_copy, copy};
pub use error::TextureError;
pub(crate) use host_access::{check_read, check_write, read, read_sample, read_tight, write, zero};
pub use region::{TexelCopyLayout, TextureCopy};
pub(crate) use reservation::{Reservations, TextureUse};
pub use stores::TextureConflict;
pub(crate) use stores::{StoredTextures, check_texture_conflicts};
pub(crate) use view::sampled_texture;
pub use view::{Sampler, TextureView, TextureViewDescriptor};

use crate::Limits;
use estampe_core::ImageSize;
use estampe_texture::TexelDescriptor;
use estampe_types::{TextureDimension, TextureFormat};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, RwLock};

bitflags::bitflags! {
    /// The uses of a texture: WebGPU's `GPUTextureUsage`.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    pub struct TextureUsages: u32 {
        /// Source of copies, and of reads by the host.
        const COPY_SRC = 1;
        /// Destination of copies, and of writes by the host.
        const COPY_DST = 1 << 1;
        /// Sampled by shaders.
        const TEXTURE_BINDING = 1 << 2;
        /// Stored to by shaders.
        const STORAGE_BINDING = 1 << 3;
        /// Attachment of render passes.
        const RENDER_ATTACHMENT = 1 << 4;
    }
}

/// Width, height, and depth or layers: WebGPU's `GPUExtent3D`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Extent3d {
    /// Width in texels.
    pub width: u32,
    /// Height in texels.
    pub height: u32,
    /// Depth of a 3D texture in texels; otherwise the number of layers, six per cube.
    pub depth_or_array_layers: u32,
}

impl Extent3d {
    /// The extent of one image.
    #[must_use]
    pub fn new_2d(width: u32, height: u32) -> Self {
        Self {
            width,
            height,
            depth_or_array_layers: 1,
        }
    }
}

/// Describes a texture: WebGPU's `GPUTextureDescriptor`.
#[derive(Debug, Clone)]
pub struct TextureDescriptor<'a> {
    /// A name for error messages. Default none.
    pub label: Option<&'a str>,
    /// Width and height in texels, 1 to 16384 (3D: 2048), and depth (3D: to 2048) or layers (to
    /// 256).
    pub size: Extent3d,
    /// Number of mip levels: 1 up to the length of the chain down to one texel. Default 1.
    pub mip_level_count: u32,
    /// Samples per texel: 1, or 2, 4, 8 or 16 for a 2D texture of one level. Default 1.
    pub sample_count: u32,
    /// Number of axes along which the texture is filtered. Default two.
    pub dimension: TextureDimension,
    /// Format of the texels.
    pub format: TextureFormat,
    /// The uses that are allowed. Default all that the format has.
    pub usage: TextureUsages,
}

impl TextureDescriptor<'_> {
    /// One 2D image of one mip level and one sample, for all uses.
    #[must_use]
    pub fn new_2d(width: u32, height: u32, format: TextureFormat) -> Self {
        Self {
            label: None,
            size: Extent3d::new_2d(width, height),
            mip_level_count: 1,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format,
            usage: TextureUsages::all(),
        }
    }

    /// This descriptor with all mip levels down to one texel.
    #[must_use]
    pub fn with_all_levels(self) -> Self {
        let count = self.texels().with_all_levels().mip_level_count;
        Self {
            mip_level_count: count,
            ..self
        }
    }

    fn texels(&self) -> TexelDescriptor {
        TexelDescriptor {
            dimension: self.dimension,
            width: self.size.width,
            height: self.size.height,
            depth_or_layers: self.size.depth_or_array_layers,
            mip_level_count: self.mip_level_count,
            sample_count: self.sample_count,
            format: self.format,
        }
    }
}

/// A texture for every role: sampled, rendered to, copied. Clones are handles to the same texels,
/// which are zeros at first, or compressed blocks of zero bytes.
///
/// ```
/// use estampe::{Device, DeviceDescriptor, TextureDescriptor, TextureFormat};
///
/// let device = Device::new(&DeviceDescriptor::default())?;
/// let checker = TextureDescriptor::new_2d(2, 2, TextureFormat::R8Unorm).with_all_levels();
/// let texture = device.create_texture_with_data(&checker, &[&[0, 255, 255, 0]])?;
/// // The level of one texel was generated: the mean of the four.
/// let level_1 = device.read_sample(&texture.image(1, 0)?, 0)?;
/// assert_eq!(level_1, [128]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// A pass reads what a texture holds when the pass begins. The texels are in tiles while passes
/// render to them and in rows while shaders sample them; the first use in the other role converts
/// those mip levels and layers that changed, on all threads. Of a texture that shaders have sampled
/// before, passes store rows while they draw, and tiles only if a pass has loaded them. Shaders
/// that only compare depths, or load texels at their own pixel, read the tiles.
#[derive(Clone)]
pub struct Texture {
    inner: Arc<Inner>,
}

struct Inner {
    label: Option<String>,
    texels: TexelDescriptor,
    usage: TextureUsages,
    /// Held by the passes or the copy that use the texture: see [`Reservations`].
    reserved: RwLock<()>,
    contents: Mutex<Contents>,
}

/// Checks the sides that only some textures have; those of 2D textures are checked with the rest.
fn check_sides(descriptor: &TextureDescriptor<'_>, limits: &Limits) -> Result<(), TextureError> {
    let size = descriptor.size;
    let layers = size.depth_or_array_layers;
    let (what, value, limit_name, limit) = match descriptor.dimension {
        TextureDimension::D1 => (
            "texels of a 1D texture",
            size.width,
            "max_texture_dimension_1d",
            limits.max_texture_dimension_1d,
        ),
        TextureDimension::D2 => (
            "layers",
            layers,
            "max_texture_array_layers",
            limits.max_texture_array_layers,
        ),
        TextureDimension::D3 => (
            "texels of a 3D texture's side",
            layers.max(size.width).max(size.height),
            "max_texture_dimension_3d",
            limits.max_texture_dimension_3d,
        ),
    };
    if value > limit {
        return Err(TextureError::Limit {
            what,
            value,
            limit_name,
            limit,
        });
    }
    Ok(())
}

impl Texture {
    pub(crate) fn new(
        descriptor: &TextureDescriptor<'_>,
        limits: &Limits,
    ) -> Result<Self, TextureError> {
        let texels = descriptor.texels();
        let label = descriptor.label.map(str::to_owned);
        check_sides(descriptor, limits)?;
        texels.check(limits)?;
        Ok(Self {
            inner: Arc::new(Inner {
                label,
                texels,
                usage: descriptor.usage,
                reserved: RwLock::new(()),
                contents: Mutex::new(Contents::default()),
            }),
        })
    }

    /// A texture of the tight bytes of its first mip levels, and the others generated.
    pub(crate) fn with_data(
        descriptor: &TextureDescriptor<'_>,
        levels: &[&[u8]],
        limits: &Limits,
    ) -> Result<Self, TextureError> {
        let texture = Self::new(descriptor, limits)?;
        texture.fill(levels, limits)?;
        Ok(texture)
    }

    /// Width, height, and depth or layers, in texels.
    #[must_use]
    pub fn size(&self) -> Extent3d {
        let texels = &self.inner.texels;
        Extent3d {
            width: texels.width,
            height: texels.height,
            depth_or_array_layers: texels.depth_or_layers,
        }
    }

    /// Width in texels.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.inner.texels.width
    }

    /// Height in texels.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.inner.texels.height
    }

    /// Number of mip levels.
    #[must_use]
    pub fn mip_level_count(&self) -> u32 {
        self.inner.texels.mip_level_count
    }

    /// Samples per texel.
    #[must_use]
    pub fn sample_count(&self) -> u32 {
        self.inner.texels.sample_count
    }

    /// Number of axes along which the texture is filtered.
    #[must_use]
    pub fn dimension(&self) -> TextureDimension {
        self.inner.texels.dimension
    }

    /// Format of the texels.
    #[must_use]
    pub fn format(&self) -> TextureFormat {
        self.inner.texels.format
    }

    /// The uses that the texture was created for.
    #[must_use]
    pub fn usage(&self) -> TextureUsages {
        self.inner.usage
    }

    /// The label, as messages name the texture.
    pub(crate) fn name(&self) -> String {
        let label = self.inner.label.as_deref();
        label.map_or("a texture".to_owned(), |label| {
            format!("the texture `{label}`")
        })
    }

    /// Width and height of a mip level, and its depth or the layers.
    #[must_use]
    pub fn level_size(&self, level: u32) -> Extent3d {
        let halved = |side: u32| side.checked_shr(level).unwrap_or_default().max(1);
        let size = self.size();
        let is_3d = self.dimension() == TextureDimension::D3;
        let slices = size.depth_or_array_layers;
        Extent3d {
            width: halved(size.width),
            height: halved(size.height),
            depth_or_array_layers: if is_3d { halved(slices) } else { slices },
        }
    }

    pub(crate) fn image_size(&self, level: u32) -> ImageSize {
        let size = self.level_size(level);
        ImageSize {
            width: size.width,
            height: size.height,
            samples: self.sample_count(),
        }
    }

    pub(crate) fn descriptor(&self) -> &TexelDescriptor {
        &self.inner.texels
    }

    pub(crate) fn lock(&self) -> MutexGuard<'_, Contents> {
        let contents = &self.inner.contents;
        contents.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A number that tells textures apart, in the order in which they are locked.
    pub(crate) fn id(&self) -> usize {
        Arc::as_ptr(&self.inner).addr()
    }

    /// Returns true if both are handles to the same texels.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.inner, &other.inner)
    }

    pub(crate) fn require(&self, needed: TextureUsages) -> Result<(), TextureError> {
        if self.inner.usage.contains(needed) {
            return Ok(());
        }
        Err(TextureError::Usage {
            texture: self.name(),
            needed,
        })
    }
}

impl std::fmt::Debug for Texture {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Extent3d {
            width,
            height,
            depth_or_array_layers,
        } = self.size();
        write!(
            f,
            "Texture({}, {width}×{height}×{depth_or_array_layers}, {})",
            self.name(),
            self.format().name()
        )
    }
}
