//! Accesses to textures.

use estampe::TextureFormat;

/// An access to a texture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Access {
    /// The statement, of the texture t, the sampler s, coordinates uv and texel coordinates at,
    /// which adds to the vector of four floats `sum`.
    pub(super) statement: &'static str,
    /// The type of the texture in WGSL.
    pub(super) kind: &'static str,
    pub(super) format: TextureFormat,
    pub(super) shape: Shape,
    pub(super) sampler: Sampling,
}

/// The shape of a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shape {
    /// One image, with so many mip levels.
    Flat(u32),
    /// Four images.
    Array,
    /// Six images.
    Cube,
    /// A quarter of a side in all directions.
    Volume,
}

/// The sampler.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sampling {
    None,
    Nearest,
    Linear,
    Compare,
}

const FLOATS: &str = "texture_2d<f32>";
const DEPTH: &str = "texture_depth_2d";
const WORDS: &str = "texture_2d<u32>";

/// Of one image with four floats.
const fn flat(statement: &'static str, format: TextureFormat, sampler: Sampling) -> Access {
    Access {
        statement,
        kind: FLOATS,
        format,
        shape: Shape::Flat(1),
        sampler,
    }
}

const fn of_kind(mut access: Access, kind: &'static str) -> Access {
    access.kind = kind;
    access
}

const fn of_shape(mut access: Access, shape: Shape) -> Access {
    access.shape = shape;
    access
}

use Sampling::{Compare, Linear, Nearest, None as Unsampled};
use TextureFormat as F;

const LEVEL: &str = "sum += textureSampleLevel(t, s, uv, 0.0);";
const BETWEEN: &str = "sum += textureSampleLevel(t, s, uv, 1.3);";
const MOVED: &str = "sum += textureSampleLevel(t, s, uv, 0.0, vec2i(1, 1));";
const GRADIENTS: &str = "sum += textureSampleGrad(t, s, uv, vec2f(0.004, 0.0), vec2f(0.0, 0.004));";
const GATHER: &str = "sum += textureGather(0, t, s, uv);";
const LAYER: &str = "sum += textureSampleLevel(t, s, uv, at.x & 3, 0.0);";
const SPACE: &str = "sum += textureSampleLevel(t, s, vec3f(uv, uv.x), 0.0);";
const DIRECTION: &str = "sum += textureSampleLevel(t, s, vec3f(uv - 0.5, 0.7), 0.0);";
const OF_DEPTH: &str = "sum += vec4f(textureSampleLevel(t, s, uv, 0));";
const COMPARE: &str = "sum += vec4f(textureSampleCompareLevel(t, s, uv, 0.5));";
const GATHER_COMPARE: &str = "sum += textureGatherCompare(t, s, uv, 0.5);";
const LOAD: &str = "sum += vec4f(textureLoad(t, at, 0));";
const STORE: &str = "textureStore(t, at, vec4f(uv, uv)); sum += vec4f(uv, uv);";
const STORE_WORDS: &str = "textureStore(t, at, vec4u(vec2u(at), 7, 9)); sum += vec4f(uv, uv);";
const SIZE: &str = "sum += vec4f(vec2f(textureDimensions(t)), uv);";

/// Samples.
pub(super) const SAMPLES: &[(&str, Access)] = &[
    ("rgba8unorm-nearest", flat(LEVEL, F::Rgba8Unorm, Nearest)),
    ("rgba8unorm-linear", flat(LEVEL, F::Rgba8Unorm, Linear)),
    (
        "rgba8unorm-trilinear",
        of_shape(flat(BETWEEN, F::Rgba8Unorm, Linear), Shape::Flat(9)),
    ),
    (
        "rgba8unorm-gradients",
        of_shape(flat(GRADIENTS, F::Rgba8Unorm, Linear), Shape::Flat(9)),
    ),
    ("rgba8unorm-offset", flat(MOVED, F::Rgba8Unorm, Linear)),
    ("rgba8unorm-gather", flat(GATHER, F::Rgba8Unorm, Linear)),
    (
        "rgba8unorm-srgb-linear",
        flat(LEVEL, F::Rgba8UnormSrgb, Linear),
    ),
    ("bgra8unorm-linear", flat(LEVEL, F::Bgra8Unorm, Linear)),
    ("rgba8snorm-linear", flat(LEVEL, F::Rgba8Snorm, Linear)),
    ("r8unorm-linear", flat(LEVEL, F::R8Unorm, Linear)),
    ("rg8unorm-linear", flat(LEVEL, F::Rg8Unorm, Linear)),
    ("rgb10a2unorm-linear", flat(LEVEL, F::Rgb10a2Unorm, Linear)),
    (
        "rg11b10ufloat-linear",
        flat(LEVEL, F::Rg11b10Ufloat, Linear),
    ),
    ("rgb9e5ufloat-linear", flat(LEVEL, F::Rgb9e5Ufloat, Linear)),
    ("rg16float-linear", flat(LEVEL, F::Rg16Float, Linear)),
    ("rgba16float-nearest", flat(LEVEL, F::Rgba16Float, Nearest)),
    ("rgba16float-linear", flat(LEVEL, F::Rgba16Float, Linear)),
    ("rgba16unorm-linear", flat(LEVEL, F::Rgba16Unorm, Linear)),
    ("r32float-nearest", flat(LEVEL, F::R32Float, Nearest)),
    ("rgba32float-nearest", flat(LEVEL, F::Rgba32Float, Nearest)),
    ("rgba32float-linear", flat(LEVEL, F::Rgba32Float, Linear)),
    (
        "bc1-rgba-unorm-linear",
        flat(LEVEL, F::Bc1RgbaUnorm, Linear),
    ),
    (
        "bc7-rgba-unorm-linear",
        flat(LEVEL, F::Bc7RgbaUnorm, Linear),
    ),
    (
        "layers-linear",
        of_shape(
            of_kind(flat(LAYER, F::Rgba8Unorm, Linear), "texture_2d_array<f32>"),
            Shape::Array,
        ),
    ),
    (
        "cube-linear",
        of_shape(
            of_kind(flat(DIRECTION, F::Rgba8Unorm, Linear), "texture_cube<f32>"),
            Shape::Cube,
        ),
    ),
    (
        "3d-linear",
        of_shape(
            of_kind(flat(SPACE, F::Rgba8Unorm, Linear), "texture_3d<f32>"),
            Shape::Volume,
        ),
    ),
    (
        "depth32float-nearest",
        of_kind(flat(OF_DEPTH, F::Depth32Float, Nearest), DEPTH),
    ),
    (
        "depth32float-compare",
        of_kind(flat(COMPARE, F::Depth32Float, Compare), DEPTH),
    ),
    (
        "depth32float-gather-compare",
        of_kind(flat(GATHER_COMPARE, F::Depth32Float, Compare), DEPTH),
    ),
];

/// Loads and stores.
pub(super) const TEXELS: &[(&str, Access)] = &[
    ("rgba8unorm-load", flat(LOAD, F::Rgba8Unorm, Unsampled)),
    (
        "rgba8unorm-srgb-load",
        flat(LOAD, F::Rgba8UnormSrgb, Unsampled),
    ),
    ("rgba16float-load", flat(LOAD, F::Rgba16Float, Unsampled)),
    ("r32float-load", flat(LOAD, F::R32Float, Unsampled)),
    ("rgba32float-load", flat(LOAD, F::Rgba32Float, Unsampled)),
    (
        "depth32float-load",
        of_kind(flat(LOAD, F::Depth32Float, Unsampled), DEPTH),
    ),
    (
        "rgba8uint-load",
        of_kind(flat(LOAD, F::Rgba8Uint, Unsampled), WORDS),
    ),
    (
        "r32uint-load",
        of_kind(flat(LOAD, F::R32Uint, Unsampled), WORDS),
    ),
    (
        "rgba32uint-load",
        of_kind(flat(LOAD, F::Rgba32Uint, Unsampled), WORDS),
    ),
    (
        "rgba8unorm-store",
        of_kind(
            flat(STORE, F::Rgba8Unorm, Unsampled),
            "texture_storage_2d<rgba8unorm, write>",
        ),
    ),
    (
        "rgba8snorm-store",
        of_kind(
            flat(STORE, F::Rgba8Snorm, Unsampled),
            "texture_storage_2d<rgba8snorm, write>",
        ),
    ),
    (
        "rgba16float-store",
        of_kind(
            flat(STORE, F::Rgba16Float, Unsampled),
            "texture_storage_2d<rgba16float, write>",
        ),
    ),
    (
        "r32float-store",
        of_kind(
            flat(STORE, F::R32Float, Unsampled),
            "texture_storage_2d<r32float, write>",
        ),
    ),
    (
        "rgba32float-store",
        of_kind(
            flat(STORE, F::Rgba32Float, Unsampled),
            "texture_storage_2d<rgba32float, write>",
        ),
    ),
    (
        "r32uint-store",
        of_kind(
            flat(STORE_WORDS, F::R32Uint, Unsampled),
            "texture_storage_2d<r32uint, write>",
        ),
    ),
    ("textureDimensions", flat(SIZE, F::Rgba8Unorm, Unsampled)),
];
