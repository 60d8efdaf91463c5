//! Every error of bind groups and their layouts: its message names what does not fit, and both
//! sides.

use crate::support::binding::{DYNAMIC, SAMPLED, UNIFORM, entry, material};
use crate::support::{labelled, limited, samples, texture};
use estampe::{
    BindGroupError, BindingResource, BindingType, BufferDescriptor, Limits, SampleType,
    SamplerDescriptor, TextureFormat, TextureUsages, ViewDimension,
};

/// Checks an error's variant and its message.
macro_rules! refused {
    ($result:expr, $variant:pat, $message:expr) => {{
        let error = $result.err().expect("it is refused");
        assert!(matches!(error, $variant), "{error:?}");
        assert_eq!(error.to_string(), $message);
    }};
}

#[test]
fn bind_group_layouts() {
    let device = limited(Limits {
        max_bindings_per_bind_group: 4,
        max_dynamic_offsets_per_bind_group: 2,
        ..Limits::default()
    });
    refused!(
        device.create_bind_group_layout(&[entry(3, UNIFORM), entry(3, SAMPLED)]),
        BindGroupError::BindingTwice,
        "two entries of a bind group layout have the same binding number"
    );
    let many = |ty, count: u32| (0..count).map(|at| entry(at, ty)).collect::<Vec<_>>();
    refused!(
        device.create_bind_group_layout(&many(UNIFORM, 5)),
        BindGroupError::TooMany { .. },
        "5 bindings exceed the limit max_bindings_per_bind_group = 4"
    );
    refused!(
        device.create_bind_group_layout(&many(DYNAMIC, 3)),
        BindGroupError::TooMany { .. },
        "3 dynamic offsets exceed the limit max_dynamic_offsets_per_bind_group = 2"
    );
}

#[test]
#[expect(clippy::too_many_lines, reason = "a list of cases")]
fn bind_groups() {
    let device = limited(Limits {
        max_uniform_buffer_binding_size: 64,
        min_uniform_buffer_offset_alignment: 16,
        ..Limits::default()
    });
    let buffer = device.create_buffer(&BufferDescriptor::new(256)).unwrap();
    let image = labelled(&device, "grass", TextureUsages::all());
    let sampler = device
        .create_sampler(&SamplerDescriptor::default())
        .unwrap();
    let of_buffer = |range: std::ops::Range<u64>| BindingResource::Buffer(buffer.slice(range));
    refused!(
        material(&device, UNIFORM, &[]),
        BindGroupError::Missing { .. },
        "binding 3 of the bind group `material` is a uniform buffer, and there is no resource for it"
    );
    let unexpected = |binding: u32| {
        format!(
            "binding {binding} of the bind group `material` is given twice, or is not in the layout"
        )
    };
    refused!(
        material(
            &device,
            UNIFORM,
            &[(3, of_buffer(0..16)), (4, of_buffer(0..16))]
        ),
        BindGroupError::Unexpected { .. },
        unexpected(4)
    );
    refused!(
        material(
            &device,
            UNIFORM,
            &[(3, of_buffer(0..16)), (3, of_buffer(0..16))]
        ),
        BindGroupError::Unexpected { .. },
        unexpected(3)
    );
    for (ty, resource, expected, actual) in [
        (
            UNIFORM,
            BindingResource::Texture(image.view()),
            "a uniform buffer",
            "a D2 view of Float (rgba8unorm)",
        ),
        (
            SAMPLED,
            of_buffer(0..16),
            "a D2 texture of Float with its sampler",
            "a buffer",
        ),
        (
            SAMPLED,
            BindingResource::SampledTexture(
                texture(&device, [8, 4], TextureFormat::R8Uint).view(),
                sampler.clone(),
            ),
            "a D2 texture of Float with its sampler",
            "a D2 view of Uint (r8uint) with its sampler",
        ),
        (
            BindingType::Texture {
                sample_type: SampleType::Float,
                view_dimension: ViewDimension::D2Array,
                multisampled: false,
            },
            BindingResource::Texture(image.view()),
            "a D2Array texture of Float",
            "a D2 view of Float (rgba8unorm)",
        ),
        (
            BindingType::Texture {
                sample_type: SampleType::Float,
                view_dimension: ViewDimension::D2,
                multisampled: false,
            },
            BindingResource::Texture(samples(&device, TextureFormat::R8Unorm).view()),
            "a D2 texture of Float",
            "a multisampled D2 view of Float (r8unorm)",
        ),
        (
            BindingType::Sampler { comparison: true },
            BindingResource::Sampler(sampler.clone()),
            "a comparison sampler",
            "a sampler",
        ),
        (
            BindingType::StorageTexture {
                format: TextureFormat::R32Uint,
                view_dimension: ViewDimension::D2,
            },
            BindingResource::Texture(image.view()),
            "a D2 storage texture of r32uint",
            "a D2 view of Float (rgba8unorm)",
        ),
    ] {
        refused!(
            material(&device, ty, &[(3, resource)]),
            BindGroupError::Kind { .. },
            format!(
                "binding 3 of the bind group `material` is {expected}, and the resource is {actual}"
            )
        );
    }
    for range in [0..12, 0..68, 8..24] {
        refused!(
            material(&device, UNIFORM, &[(3, of_buffer(range.clone()))]),
            BindGroupError::BufferRange { .. },
            format!(
                "binding 3 of the bind group `material` is {} bytes at offset {} of a buffer: the \
                 offset must be a multiple of 16, the size 16 to 64 bytes",
                range.end - range.start,
                range.start
            )
        );
    }
    refused!(
        material(&device, UNIFORM, &[(3, of_buffer(240..272))]),
        BindGroupError::Buffer { .. },
        "binding 3 of the bind group `material`: bytes 240..272 of a buffer, which has 256: use a \
         range inside the buffer"
    );
    let unbound = labelled(&device, "grass", TextureUsages::COPY_DST);
    refused!(
        material(
            &device,
            SAMPLED,
            &[(3, BindingResource::SampledTexture(unbound.view(), sampler))]
        ),
        BindGroupError::Texture { .. },
        "binding 3 of the bind group `material`: the texture `grass` was created without \
         TextureUsages::TEXTURE_BINDING: add it to its usage"
    );
}
