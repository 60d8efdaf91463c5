//! What an entry point binds, as entries of bind group layouts.

use super::{LowerError, Lowered};
use estampe_types::{
    BindGroupLayoutEntry, BindingType, BufferBindingType, SampleType, TextureFormat, ViewDimension,
};
use naga::valid::FunctionInfo;
use naga::{
    AddressSpace, ImageClass, ImageDimension, Module, ScalarKind, StorageAccess, StorageFormat,
    TypeInner,
};

/// The groups and entries of the resources that an entry point uses, as WebGPU's *default pipeline
/// layout* has them: buffers are at least as large as their type, without dynamic offsets.
pub(super) fn bindings(
    module: &Module,
    info: &FunctionInfo,
) -> Lowered<Vec<(u32, BindGroupLayoutEntry)>> {
    let mut bindings = Vec::new();
    for (handle, global) in module.global_variables.iter() {
        let Some(place) = global.binding.filter(|_| !info[handle].is_empty()) else {
            continue;
        };
        let inner = &module.types[global.ty].inner;
        let buffer = |ty| BindingType::Buffer {
            ty,
            has_dynamic_offset: false,
            // In whole words, of which the last may have one 16-bit float.
            min_binding_size: u64::from(inner.size(module.to_ctx()).next_multiple_of(4)),
        };
        let ty = match global.space {
            AddressSpace::Uniform => buffer(BufferBindingType::Uniform),
            AddressSpace::Storage { access } => buffer(BufferBindingType::Storage {
                read_only: !access.contains(StorageAccess::STORE),
            }),
            AddressSpace::Handle => resource(inner)?,
            _ => continue,
        };
        let binding = place.binding;
        bindings.push((place.group, BindGroupLayoutEntry { binding, ty }));
    }
    Ok(bindings)
}

/// A texture or sampler.
fn resource(inner: &TypeInner) -> Lowered<BindingType> {
    let (dim, arrayed, class) = match *inner {
        TypeInner::Sampler { comparison } => return Ok(BindingType::Sampler { comparison }),
        TypeInner::Image {
            dim,
            arrayed,
            class,
        } => (dim, arrayed, class),
        _ => return Err(LowerError::Unsupported("resources of this type")),
    };
    let view_dimension = match (dim, arrayed) {
        (ImageDimension::D1, false) => ViewDimension::D1,
        (ImageDimension::D2, false) => ViewDimension::D2,
        (ImageDimension::D2, true) => ViewDimension::D2Array,
        (ImageDimension::D3, false) => ViewDimension::D3,
        (ImageDimension::Cube, false) => ViewDimension::Cube,
        (ImageDimension::Cube, true) => ViewDimension::CubeArray,
        _ => return Err(LowerError::Unsupported("arrays of 1D or 3D textures")),
    };
    let texture = |sample_type, multisampled| BindingType::Texture {
        sample_type,
        view_dimension,
        multisampled,
    };
    Ok(match class {
        ImageClass::Sampled { kind, multi } => match kind {
            ScalarKind::Sint => texture(SampleType::Sint, multi),
            ScalarKind::Uint => texture(SampleType::Uint, multi),
            _ => texture(SampleType::Float, multi),
        },
        ImageClass::Depth { multi } => texture(SampleType::Depth, multi),
        ImageClass::Storage { format, .. } => BindingType::StorageTexture {
            format: storage_format(format)?,
            view_dimension,
        },
        ImageClass::External => return Err(LowerError::Unsupported("external textures")),
    })
}

macro_rules! same_names {
    ($format:expr, $($name:ident),* $(,)?) => {
        match $format {
            $(StorageFormat::$name => Ok(TextureFormat::$name),)*
            #[allow(unreachable_patterns, reason = "until every format has a counterpart")]
            _ => Err(LowerError::Unsupported("storage textures of this format")),
        }
    };
}

fn storage_format(format: StorageFormat) -> Lowered<TextureFormat> {
    same_names!(
        format,
        R8Unorm,
        R8Snorm,
        R8Uint,
        R8Sint,
        R16Uint,
        R16Sint,
        R16Float,
        Rg8Unorm,
        Rg8Snorm,
        Rg8Uint,
        Rg8Sint,
        R32Uint,
        R32Sint,
        R32Float,
        Rg16Uint,
        Rg16Sint,
        Rg16Float,
        Rgba8Unorm,
        Rgba8Snorm,
        Rgba8Uint,
        Rgba8Sint,
        Bgra8Unorm,
        Rgb10a2Uint,
        Rgb10a2Unorm,
        Rg11b10Ufloat,
        Rg32Uint,
        Rg32Sint,
        Rg32Float,
        Rgba16Uint,
        Rgba16Sint,
        Rgba16Float,
        Rgba32Uint,
        Rgba32Sint,
        Rgba32Float,
        R16Unorm,
        R16Snorm,
        Rg16Unorm,
        Rg16Snorm,
        Rgba16Unorm,
        Rgba16Snorm
    )
}
