//! A kernel that does one operation many times, and its resources.

use super::memory::DECLARATIONS;
use super::operation::{Body, Operation};
use super::textures::{Access, Sampling, Shape};
use crate::BenchError;
use estampe::state::CompareFunction;
use estampe::{
    AddressMode, BindGroup, BindGroupDescriptor, BindingResource, Buffer, BufferDescriptor,
    ComputePipeline, ComputePipelineDescriptor, Device, Dispatch, EntryPointDescriptor, Extent3d,
    FilterMode, SamplerDescriptor, ShaderModuleDescriptor, ShaderSource, TextureDescriptor,
    TextureDimension, TextureView, TextureViewDescriptor, ViewDimension,
};

/// How large a dispatch is.
#[derive(Debug, Clone, Copy)]
pub(super) struct Size {
    /// The work-groups of 64 invocations along an axis, squared; a texture has eight texels for
    /// each along its sides.
    groups: u32,
    /// The times that the operation is done.
    rounds: u32,
}

impl Size {
    /// For measurements: a texture of 128×128 texels.
    pub(super) const MEASURED: Self = Self {
        groups: 16,
        rounds: 16,
    };
    /// For tests of the results.
    #[cfg(test)]
    pub(super) const TESTED: Self = Self {
        groups: 2,
        rounds: 3,
    };
}

/// The invocations of a work-group.
const GROUP: u32 = 64;

/// The values of an invocation on which numbers' operations are done, in turn.
const VALUES: u32 = 4;

/// An operation, ready to be dispatched.
pub(super) struct Kernel<'a> {
    device: &'a Device,
    pipeline: ComputePipeline,
    group: BindGroup,
    #[cfg(test)]
    words: Buffer,
    size: Size,
    /// The operations of each invocation.
    operations: u32,
}

impl<'a> Kernel<'a> {
    pub(super) fn new(
        device: &'a Device,
        operation: &Operation,
        size: Size,
    ) -> Result<Self, BenchError> {
        let text = source(&operation.body, size);
        let module = device.create_shader_module(&ShaderModuleDescriptor {
            label: Some(operation.name),
            ..ShaderModuleDescriptor::new(ShaderSource::Wgsl(&text))
        })?;
        let program = device.create_compute_program(&EntryPointDescriptor::new(&module))?;
        let pipeline = device.create_compute_pipeline(&ComputePipelineDescriptor::new(program))?;
        let count = size.groups * size.groups * GROUP;
        // The second half is for stores.
        let words = filled(device, 2 * count)?;
        let whole = |buffer: &Buffer| BindingResource::Buffer(buffer.slice(..));
        let mut entries = vec![(0, whole(&words))];
        match &operation.body {
            Body::Float(_) | Body::Word(_) => {
                let counters = device.create_buffer(&BufferDescriptor::new(4 * 1024))?;
                let settings = device.create_buffer(&BufferDescriptor::new(16))?;
                let of_settings = [7, count, 0, 0].map(u32::to_le_bytes).concat();
                settings.write(0, &of_settings)?;
                entries.extend([(1, whole(&counters)), (2, whole(&settings))]);
            }
            Body::Texture(access) => {
                let view = texture(device, access, 8 * size.groups)?;
                entries.push((1, BindingResource::Texture(view)));
                if let Some(descriptor) = sampler(access.sampler) {
                    let sampler = device.create_sampler(&descriptor)?;
                    entries.push((2, BindingResource::Sampler(sampler)));
                }
            }
        }
        let group = device.create_bind_group(&BindGroupDescriptor {
            label: Some(operation.name),
            layout: &pipeline.bind_group_layouts()[0],
            entries: &entries,
        })?;
        let values = match operation.body {
            Body::Texture(_) => 1,
            Body::Float(_) | Body::Word(_) => VALUES,
        };
        Ok(Self {
            device,
            pipeline,
            group,
            #[cfg(test)]
            words,
            size,
            operations: size.rounds * values,
        })
    }

    pub(super) fn dispatch(&self) -> Result<(), BenchError> {
        let Size { groups, .. } = self.size;
        let bind_groups = [self.group.clone()];
        let dispatch = Dispatch {
            bind_groups: &bind_groups,
            ..Dispatch::new(&self.pipeline, [groups, groups, 1])
        };
        Ok(self.device.dispatch(&dispatch)?)
    }

    /// The operations of a dispatch, sixteen invocations' as one.
    pub(super) fn packets(&self) -> f64 {
        let invocations = self.size.groups * self.size.groups * GROUP;
        f64::from(invocations / 16 * self.operations)
    }

    /// The words that the invocations left.
    #[cfg(test)]
    pub(super) fn words(&self) -> Vec<u8> {
        let count = usize::try_from(self.words.size()).unwrap();
        let mut bytes = vec![0; count];
        self.words.read(0, &mut bytes).unwrap();
        bytes
    }
}

/// The text of a kernel.
fn source(body: &Body, size: Size) -> String {
    let (rounds, side) = (size.rounds, 8 * size.groups);
    let (kind, first, last, expression) = match *body {
        Body::Float(expression) => (
            "f32",
            "bitcast<f32>(0x3f000000u | (word & 0x7fffu))",
            "bitcast<u32>(a + b + c + d)",
            expression,
        ),
        Body::Word(expression) => ("u32", "word", "a + b + c + d", expression),
        Body::Texture(access) => return source_of_access(&access, rounds, side),
    };
    let enable = if expression.contains("subgroup") {
        "enable subgroups;"
    } else {
        ""
    };
    // What no invocation does keeps all bindings and variables in use.
    format!(
        "{enable}{DECLARATIONS}
fn operation(x: {kind}, i: u32) -> {kind} {{ return {expression}; }}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) i: u32) {{
    invocation = id.x + id.y * {side}u;
    let word = words[invocation];
    if settings.x == 0u {{
        tile[i] = word;
        atomicStore(&sums[i], primes[word & 7u]);
        atomicStore(&counters[i], word);
    }}
    var a: {kind} = {first};
    var b = a + {kind}(1);
    var c = a + {kind}(2);
    var d = a + {kind}(3);
    for (var round = 0u; round < {rounds}u; round++) {{
        a = operation(a, i);
        b = operation(b, i);
        c = operation(c, i);
        d = operation(d, i);
    }}
    words[invocation] = {last};
}}
"
    )
}

fn source_of_access(access: &Access, rounds: u32, side: u32) -> String {
    let Access {
        statement, kind, ..
    } = access;
    let sampler = match access.sampler {
        Sampling::None => "",
        Sampling::Nearest | Sampling::Linear => "@group(0) @binding(2) var s: sampler;",
        Sampling::Compare => "@group(0) @binding(2) var s: sampler_comparison;",
    };
    format!(
        "
@group(0) @binding(0) var<storage, read_write> words: array<u32>;
@group(0) @binding(1) var t: {kind};
{sampler}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {{
    var sum = vec4f(0.0);
    for (var round = 0; round < {rounds}; round++) {{
        let at = vec2i((i32(id.x) + round) & {last}, i32(id.y));
        let uv = (vec2f(id.xy) + 0.37) / {side}.0 + f32(round) * 0.013;
        {statement}
    }}
    words[id.x + id.y * {side}u] = bitcast<u32>(sum.x + sum.y + sum.z + sum.w);
}}
",
        last = side - 1,
    )
}

/// Words whose bits all differ between neighbours.
fn filled(device: &Device, count: u32) -> Result<Buffer, BenchError> {
    let buffer = device.create_buffer(&BufferDescriptor::new(u64::from(count) * 4))?;
    let word = |at: u32| at.wrapping_mul(747_796_405) ^ 0x9E37;
    let bytes: Vec<u8> = (0..count).flat_map(|at| word(at).to_le_bytes()).collect();
    buffer.write(0, &bytes)?;
    Ok(buffer)
}

/// A texture of zeros, as it is accessed.
fn texture(device: &Device, access: &Access, side: u32) -> Result<TextureView, BenchError> {
    let (sides, layers, levels, dimension) = match access.shape {
        Shape::Flat(levels) => (side, 1, levels, ViewDimension::D2),
        Shape::Array => (side, 4, 1, ViewDimension::D2Array),
        Shape::Cube => (side, 6, 1, ViewDimension::Cube),
        Shape::Volume => (side / 4, side / 4, 1, ViewDimension::D3),
    };
    let most_levels = sides.ilog2() + 1;
    let texture = device.create_texture(&TextureDescriptor {
        size: Extent3d {
            width: sides,
            height: sides,
            depth_or_array_layers: layers,
        },
        mip_level_count: levels.min(most_levels),
        dimension: match access.shape {
            Shape::Volume => TextureDimension::D3,
            Shape::Flat(_) | Shape::Array | Shape::Cube => TextureDimension::D2,
        },
        ..TextureDescriptor::new_2d(sides, sides, access.format)
    })?;
    Ok(texture.create_view(&TextureViewDescriptor {
        dimension: Some(dimension),
        ..TextureViewDescriptor::default()
    })?)
}

/// The sampler of an access: coordinates repeat.
fn sampler(sampling: Sampling) -> Option<SamplerDescriptor> {
    let filter = match sampling {
        Sampling::None => return None,
        Sampling::Nearest => FilterMode::Nearest,
        Sampling::Linear | Sampling::Compare => FilterMode::Linear,
    };
    Some(SamplerDescriptor {
        address_mode_u: AddressMode::Repeat,
        address_mode_v: AddressMode::Repeat,
        address_mode_w: AddressMode::Repeat,
        mag_filter: filter,
        min_filter: filter,
        mipmap_filter: filter,
        compare: (sampling == Sampling::Compare).then_some(CompareFunction::Less),
        ..SamplerDescriptor::default()
    })
}
