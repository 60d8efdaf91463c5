//! Products that are rounded together with sums, where the author asks for it.

use super::devices;
use estampe::{
    BindGroupDescriptor, BindingResource, ComputePipelineDescriptor, Device, DeviceDescriptor,
    Dispatch, EntryPointDescriptor, ShaderModuleDescriptor, ShaderSource,
};

/// a·b + c, c − b·b, b·c − a, and a product that is used twice, of three numbers an invocation.
const TEXT: &str = "
@group(0) @binding(0) var<storage, read> numbers: array<vec3f>;
@group(0) @binding(1) var<storage, read_write> results: array<vec4f>;

@compute @workgroup_size(16)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let n = numbers[id.x];
    let twice = n.x * n.z;
    results[id.x] = vec4f(
        n.x * n.y + n.z,
        n.z - n.y * n.y,
        n.y * n.z - n.x,
        (twice + n.y) * twice,
    );
}
";

const INVOCATIONS: usize = 64;

fn numbers() -> Vec<[f32; 3]> {
    let mut random = fastrand::Rng::with_seed(5);
    (0..INVOCATIONS)
        .map(|_| [(); 3].map(|()| random.f32() * 4.0 - 2.0))
        .collect()
}

fn results(device: &Device, strict_math: bool) -> Vec<f32> {
    let module = device.create_shader_module(&ShaderModuleDescriptor {
        strict_math,
        ..ShaderModuleDescriptor::new(ShaderSource::Wgsl(TEXT))
    });
    let module = module.unwrap_or_else(|errors| panic!("{errors}"));
    let program = device.create_compute_program(&EntryPointDescriptor::new(&module));
    let pipeline = device
        .create_compute_pipeline(&ComputePipelineDescriptor {
            label: None,
            ..ComputePipelineDescriptor::new(program.unwrap())
        })
        .unwrap();
    let padded = numbers().into_iter().flat_map(|[x, y, z]| [x, y, z, 0.0]);
    let given = device.create_buffer_of_words(padded.map(f32::to_bits).collect());
    let results = device.create_buffer_of_words(vec![0; INVOCATIONS * 4]);
    let (given, results) = (given.unwrap(), results.unwrap());
    let group = device.create_bind_group(&BindGroupDescriptor {
        label: None,
        layout: &pipeline.bind_group_layouts()[0],
        entries: &[
            (0, BindingResource::Buffer(given.slice(..))),
            (1, BindingResource::Buffer(results.slice(..))),
        ],
    });
    device
        .dispatch(&Dispatch {
            bind_groups: &[group.unwrap()],
            ..Dispatch::new(&pipeline, [4, 1, 1])
        })
        .unwrap();
    let read = results.map_read(0..results.size(), |bytes| {
        let (words, _) = bytes.as_chunks::<4>();
        words.iter().map(|word| f32::from_le_bytes(*word)).collect()
    });
    read.unwrap()
}

/// By the exact fused operation of the standard library, or by two operations.
fn expected(strict_math: bool) -> Vec<f32> {
    let fused = |a: f32, b: f32, c: f32| {
        if strict_math {
            a * b + c
        } else {
            a.mul_add(b, c)
        }
    };
    let of_three = |[x, y, z]: [f32; 3]| {
        let twice = x * z;
        [
            fused(x, y, z),
            fused(-y, y, z),
            fused(y, z, -x),
            (twice + y) * twice,
        ]
    };
    numbers().into_iter().flat_map(of_three).collect()
}

#[test]
fn products_and_sums_are_rounded_once_if_asked_for() {
    assert_ne!(expected(true), expected(false));
    for strict_math in [true, false] {
        let bits =
            |numbers: Vec<f32>| -> Vec<u32> { numbers.into_iter().map(f32::to_bits).collect() };
        let wanted = bits(expected(strict_math));
        for (name, device) in devices() {
            assert_eq!(bits(results(&device, strict_math)), wanted, "{name}");
        }
        let interpreted = Device::new(&DeviceDescriptor {
            interprets_shaders: true,
            ..DeviceDescriptor::default()
        });
        assert_eq!(bits(results(&interpreted.unwrap(), strict_math)), wanted);
    }
}
