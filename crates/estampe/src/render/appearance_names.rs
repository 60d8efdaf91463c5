//! Names of shadings and other values of the options of a picture's appearance.

use estampe_renderer::{CullMode, Shading, Transparency};

/// Names of shadings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum ShadingName {
    /// pbr if the model has physically based materials, else phong
    Auto,
    /// Physically based: metals and dielectrics, lit from all around
    Pbr,
    /// Lighting once per face
    Flat,
    /// Lighting at the vertices, interpolated
    Gouraud,
    /// Lighting at every pixel
    Phong,
    /// Lighting at every pixel, in four steps
    Toon,
    /// Lighting once per face, in four steps
    ToonFlat,
    /// Lighting at the vertices, interpolated, in four steps
    ToonGouraud,
    /// Colours and textures without lighting
    Unlit,
    /// Edges; faces hide the edges behind them
    Wireframe,
    /// Normals as colours: red right, green up, blue towards the eye
    Normals,
    /// White near, black far
    Depth,
    /// Texture coordinates: u red, v green
    Uv,
    /// A colour for each triangle, by its number
    FaceId,
    /// Barycentric coordinates: red, green and blue at the corners of each triangle
    Barycentric,
    /// The number of fragments of each pixel, hidden ones too
    Overdraw,
}

impl From<ShadingName> for Shading {
    fn from(name: ShadingName) -> Self {
        match name {
            ShadingName::Auto => Self::Automatic,
            ShadingName::Pbr => Self::Pbr,
            ShadingName::Flat => Self::Flat,
            ShadingName::Gouraud => Self::Gouraud,
            ShadingName::Phong => Self::Phong,
            ShadingName::Toon => Self::Toon,
            ShadingName::ToonFlat => Self::ToonFlat,
            ShadingName::ToonGouraud => Self::ToonGouraud,
            ShadingName::Unlit => Self::Unlit,
            ShadingName::Wireframe => Self::Wireframe,
            ShadingName::Normals => Self::Normals,
            ShadingName::Depth => Self::Depth,
            ShadingName::Uv => Self::Uv,
            ShadingName::FaceId => Self::FaceId,
            ShadingName::Barycentric => Self::Barycentric,
            ShadingName::Overdraw => Self::Overdraw,
        }
    }
}

/// Names of cull modes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum CullName {
    /// None: both sides of every face are drawn
    None,
    /// Faces that face away
    Back,
    /// Faces that face the viewer
    Front,
}

impl From<CullName> for CullMode {
    fn from(name: CullName) -> Self {
        match name {
            CullName::None => Self::None,
            CullName::Back => Self::Back,
            CullName::Front => Self::Front,
        }
    }
}

/// Names of the methods of transparency.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum TransparencyName {
    /// Triangles from the farthest on
    Sorted,
    /// Fragments of each sample from the farthest on, by depth peeling
    Exact,
    /// Weighted sums of all fragments
    Weighted,
}

impl From<TransparencyName> for Transparency {
    fn from(name: TransparencyName) -> Self {
        match name {
            TransparencyName::Sorted => Self::Sorted,
            TransparencyName::Exact => Self::Exact,
            TransparencyName::Weighted => Self::Weighted,
        }
    }
}
