//! Where the newest texels of an image are, what operations do to it, and classes of formats.

use estampe_types::{TexelEncoding, TextureFormat};

/// Where the newest texels of an image are, as `estampe` is expected to keep them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Newest {
    /// Nowhere: it was never written.
    Zeros,
    /// In rows, after the host, a copy or a clear wrote it.
    Rows,
    /// In tiles, after a pass rendered to it.
    Tiles,
    /// In both, after rendered tiles were read as rows, or rows were tested and not written.
    Both,
    /// Nowhere: a pass discarded it.
    Discarded,
}

impl Newest {
    /// Every place.
    pub const ALL: [Self; 5] = [
        Self::Zeros,
        Self::Rows,
        Self::Tiles,
        Self::Both,
        Self::Discarded,
    ];
}

/// What an operation does to an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Role {
    /// Read by the host.
    Read,
    /// Source of a copy.
    CopiedFrom,
    /// Destination of a copy, or of a write by the host.
    CopiedInto,
    /// Cleared outside of passes.
    Cleared,
    /// The mip level from which the next one is made.
    MipSource,
    /// The mip level that is made.
    MipMade,
    /// Source of a blit.
    BlittedFrom,
    /// Attachment whose contents are kept; destination of a blit.
    Loaded,
    /// Attachment that is cleared.
    ClearedByPass,
    /// Depth-stencil attachment that is read-only.
    ReadOnly,
    /// Resolve target.
    ResolvedInto,
    /// Sampled by a draw.
    Sampled,
    /// Compared by a draw as a shadow map.
    Compared,
    /// Stored to by a shader.
    Stored,
    /// Held as a shader's own texture.
    Held,
}

impl Role {
    /// Every role.
    pub const ALL: [Self; 15] = [
        Self::Read,
        Self::CopiedFrom,
        Self::CopiedInto,
        Self::Cleared,
        Self::MipSource,
        Self::MipMade,
        Self::BlittedFrom,
        Self::Loaded,
        Self::ClearedByPass,
        Self::ReadOnly,
        Self::ResolvedInto,
        Self::Sampled,
        Self::Compared,
        Self::Stored,
        Self::Held,
    ];
}

/// Formats that the pipeline treats alike.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum FormatClass {
    /// 8 bits per channel, linear.
    Unorm8,
    /// sRGB.
    Srgb,
    /// B first.
    Bgra,
    /// 16-bit unorm.
    Unorm16,
    /// 8- and 16-bit snorm.
    Snorm,
    /// Integers.
    Integer,
    /// Floats of 16 and 32 bits.
    Float,
    /// Channels of several sizes in one word.
    Packed,
    /// RGB9E5.
    SharedExponent,
    /// Depth.
    Depth,
    /// Stencil.
    Stencil,
    /// Both.
    DepthStencil,
    /// BC1 to BC7.
    Bc,
    /// ETC2 and EAC.
    Etc,
    /// ASTC.
    Astc,
}

impl FormatClass {
    /// The class of a format.
    #[must_use]
    pub fn of(format: TextureFormat) -> Self {
        use TexelEncoding as E;
        let name = format.name();
        match format.encoding() {
            E::Compressed if name.starts_with("bc") => Self::Bc,
            E::Compressed if name.starts_with("astc") => Self::Astc,
            E::Compressed => Self::Etc,
            _ if format.has_depth() && format.has_stencil() => Self::DepthStencil,
            _ if format.has_depth() => Self::Depth,
            _ if format.has_stencil() => Self::Stencil,
            E::SharedExponent => Self::SharedExponent,
            E::Unorm10_2 | E::Uint10_2 | E::Ufloat11_10 => Self::Packed,
            E::Float16 | E::Float32 => Self::Float,
            E::Unorm16 => Self::Unorm16,
            E::Snorm8 | E::Snorm16 => Self::Snorm,
            E::Unorm8 if format.is_bgra() => Self::Bgra,
            E::Unorm8 if format.is_srgb() => Self::Srgb,
            E::Unorm8 => Self::Unorm8,
            _ => Self::Integer,
        }
    }
}
