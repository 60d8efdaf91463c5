//! Bind group layout entries, and the stages that see them.

use estampe_ir::interface::Stage;
use naga::valid::ModuleInfo;
use naga::{AddressSpace, GlobalVariable, Handle, ImageClass, StorageAccess, TypeInner};

use super::{Names, Scalar};

/// A bind group layout entry.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Binding {
    /// The bind group.
    pub group: u32,
    /// The binding in the group.
    pub binding: u32,
    /// The name of the variable; in GLSL that of the block, empty for loose uniforms.
    pub name: String,
    /// The kind of resource.
    pub kind: BindingKind,
    /// The number of resources in a binding array: `None` if it is none, `Some(0)` if unbounded.
    pub count: Option<u32>,
    /// The stages with an entry point that uses it.
    pub stages: Stages,
}

/// A set of stages.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Stages {
    /// Vertex shaders.
    pub vertex: bool,
    /// Fragment shaders.
    pub fragment: bool,
    /// Compute shaders.
    pub compute: bool,
}

impl Stages {
    fn insert(&mut self, stage: Stage) {
        match stage {
            Stage::Vertex => self.vertex = true,
            Stage::Fragment => self.fragment = true,
            Stage::Compute => self.compute = true,
        }
    }
}

/// The kind of resource that a binding takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum BindingKind {
    /// A uniform buffer.
    UniformBuffer {
        /// The least bytes of the buffer's binding.
        min_size: u32,
    },
    /// A storage buffer.
    StorageBuffer {
        /// True if the shader only reads it.
        is_read_only: bool,
        /// The least bytes of the buffer's binding. A run-time sized array counts as one element.
        min_size: u32,
    },
    /// A sampled texture.
    Texture {
        /// The dimension of the view.
        dimension: TextureDimension,
        /// What reading it gives.
        sample_type: SampleType,
        /// True if it has several samples a texel.
        is_multisampled: bool,
    },
    /// A storage texture.
    StorageTexture {
        /// The dimension of the view.
        dimension: TextureDimension,
        /// The format of its texels.
        format: naga::StorageFormat,
        /// True if the shader loads from it.
        is_read: bool,
        /// True if the shader stores to it.
        is_written: bool,
    },
    /// A sampler.
    Sampler {
        /// True if it compares with a reference value.
        is_comparison: bool,
    },
}

/// The dimension of a texture's view.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TextureDimension {
    /// A line of texels.
    D1,
    /// An array of lines.
    D1Array,
    /// A plane.
    D2,
    /// An array of planes.
    D2Array,
    /// A volume.
    D3,
    /// The six faces of a cube.
    Cube,
    /// An array of cubes.
    CubeArray,
}

/// What reading a texture gives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SampleType {
    /// Floating-point values. `is_filtered` if some entry point samples it with a sampler.
    Float {
        /// True if a sampler may filter it, so that the format must allow it.
        is_filtered: bool,
    },
    /// Depths.
    Depth,
    /// Signed integers.
    Sint,
    /// Unsigned integers.
    Uint,
}

/// A texture and a sampler that GLSL joins in one variable.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CombinedSampler {
    /// The name in the shader: `tex`, `material.diffuse`, `maps[2]`.
    pub name: String,
    /// The group and binding of the texture.
    pub texture: (u32, u32),
    /// The group and binding of the sampler.
    pub sampler: (u32, u32),
    /// The texture unit of OpenGL, if the shader names one with `layout(binding = …)`.
    pub unit: Option<u32>,
}

/// The bind group layout entries of a module, by group and binding.
pub(super) fn find(module: &naga::Module, info: &ModuleInfo, names: &Names) -> Vec<Binding> {
    let mut bindings = Vec::new();
    for (handle, variable) in module.global_variables.iter() {
        let Some(slot) = &variable.binding else {
            continue;
        };
        let (ty, count) = match module.types[variable.ty].inner {
            TypeInner::BindingArray { base, size } => {
                let count = match size {
                    naga::ArraySize::Constant(count) => count.get(),
                    _ => 0,
                };
                (base, Some(count))
            }
            _ => (variable.ty, None),
        };
        let kind = &module.types[ty];
        let Some(resource) = resource(module, info, handle, variable, &kind.inner) else {
            continue;
        };
        let mut stages = Stages::default();
        for (index, entry) in module.entry_points.iter().enumerate() {
            if !info.get_entry_point(index)[handle].is_empty()
                && let Some(stage) = super::super::module::stage(entry.stage)
            {
                stages.insert(stage);
            }
        }
        let name = variable.name.as_deref().or(kind.name.as_deref());
        bindings.push(Binding {
            group: slot.group,
            binding: slot.binding,
            name: names.name(name),
            kind: resource,
            count,
            stages,
        });
    }
    bindings.sort_by_key(|binding| (binding.group, binding.binding));
    bindings
}

fn resource(
    module: &naga::Module,
    info: &ModuleInfo,
    handle: Handle<GlobalVariable>,
    variable: &GlobalVariable,
    inner: &TypeInner,
) -> Option<BindingKind> {
    let min_size = inner.size(module.to_ctx());
    Some(match (variable.space, inner) {
        (AddressSpace::Uniform, _) => BindingKind::UniformBuffer { min_size },
        (AddressSpace::Storage { access }, _) => BindingKind::StorageBuffer {
            is_read_only: !access.contains(StorageAccess::STORE),
            min_size,
        },
        (_, &TypeInner::Sampler { comparison }) => BindingKind::Sampler {
            is_comparison: comparison,
        },
        (
            _,
            &TypeInner::Image {
                dim,
                arrayed,
                class,
            },
        ) => {
            let dimension = dimension(dim, arrayed);
            match class {
                ImageClass::Sampled { kind, multi } => BindingKind::Texture {
                    dimension,
                    sample_type: match Scalar::of(naga::Scalar { kind, width: 4 }) {
                        Scalar::I32 => SampleType::Sint,
                        Scalar::U32 => SampleType::Uint,
                        _ => SampleType::Float {
                            is_filtered: is_sampled(module, info, handle),
                        },
                    },
                    is_multisampled: multi,
                },
                ImageClass::Depth { multi } => BindingKind::Texture {
                    dimension,
                    sample_type: SampleType::Depth,
                    is_multisampled: multi,
                },
                ImageClass::Storage { format, access } => BindingKind::StorageTexture {
                    dimension,
                    format,
                    is_read: access.contains(StorageAccess::LOAD),
                    is_written: access.contains(StorageAccess::STORE),
                },
                ImageClass::External => return None,
            }
        }
        _ => return None,
    })
}

/// True if an entry point samples the texture with a sampler.
fn is_sampled(module: &naga::Module, info: &ModuleInfo, image: Handle<GlobalVariable>) -> bool {
    (0..module.entry_points.len()).any(|index| {
        let pairs = &info.get_entry_point(index).sampling_set;
        pairs.iter().any(|pair| pair.image == image)
    })
}

fn dimension(dimension: naga::ImageDimension, is_array: bool) -> TextureDimension {
    match (dimension, is_array) {
        (naga::ImageDimension::D1, false) => TextureDimension::D1,
        (naga::ImageDimension::D1, true) => TextureDimension::D1Array,
        (naga::ImageDimension::D2, false) => TextureDimension::D2,
        (naga::ImageDimension::D2, true) => TextureDimension::D2Array,
        (naga::ImageDimension::D3, _) => TextureDimension::D3,
        (naga::ImageDimension::Cube, false) => TextureDimension::Cube,
        (naga::ImageDimension::Cube, true) => TextureDimension::CubeArray,
    }
}
