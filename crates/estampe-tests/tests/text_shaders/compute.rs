//! Compute shaders on the objects of the device.

use super::{devices, module};
use estampe::{
    BindGroup, BindGroupDescriptor, BindingResource, Buffer, ComputePipeline,
    ComputePipelineDescriptor, ComputeProgram, Device, Dispatch, DispatchErrorKind, DispatchSize,
    EntryPointDescriptor, Limits, ShaderSource, bytes_of,
};
use std::sync::Arc;

pub(super) fn compiled(device: &Device, source: &str) -> ComputePipeline {
    let pipeline = device.create_compute_pipeline(&ComputePipelineDescriptor {
        label: Some("test"),
        ..ComputePipelineDescriptor::new(program(device, source))
    });
    pipeline.unwrap_or_else(|error| panic!("{error}"))
}

fn program(device: &Device, source: &str) -> Arc<dyn ComputeProgram> {
    let module = module(device, ShaderSource::Wgsl(source));
    let program = device.create_compute_program(&EntryPointDescriptor::new(&module));
    program.unwrap_or_else(|error| panic!("{error}"))
}

pub(super) fn group(device: &Device, pipeline: &ComputePipeline, buffers: &[&Buffer]) -> BindGroup {
    let entries: Vec<_> = (0..)
        .zip(buffers)
        .map(|(binding, buffer)| (binding, BindingResource::Buffer(buffer.slice(..))))
        .collect();
    let group = device.create_bind_group(&BindGroupDescriptor {
        label: None,
        layout: &pipeline.bind_group_layouts()[0],
        entries: &entries,
    });
    group.unwrap_or_else(|error| panic!("{error}"))
}

pub(super) fn buffer(device: &Device, words: &[u32]) -> Buffer {
    device
        .create_buffer_of_words(words.to_vec())
        .expect("a small buffer")
}

pub(super) fn words(buffer: &Buffer) -> Vec<u32> {
    let read = buffer.map_read(0..buffer.size(), |bytes| {
        let words = bytes.chunks_exact(4);
        words
            .map(|word| u32::from_le_bytes(word.try_into().expect("four")))
            .collect()
    });
    read.expect("a readable buffer")
}

pub(super) fn run(
    device: &Device,
    pipeline: &ComputePipeline,
    groups: &[BindGroup],
    count: [u32; 3],
) {
    let dispatch = Dispatch {
        bind_groups: groups,
        ..Dispatch::new(pipeline, count)
    };
    device
        .dispatch(&dispatch)
        .unwrap_or_else(|error| panic!("{error}"));
}

const SQUARES: &str = "
@group(0) @binding(0) var<storage, read> numbers: array<u32>;
@group(0) @binding(1) var<storage, read_write> squares: array<u32>;
@compute @workgroup_size(24) fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= arrayLength(&numbers) { return; }
    let n = numbers[id.x];
    squares[id.x] = n * n;
    squares[id.x + 1000000u] = 7u;
}
";

/// Rows: G5
#[test]
fn invocations_write_buffers_and_what_is_beyond_them_is_dropped() {
    let numbers: Vec<u32> = (0..1000).map(|n| n * 3 + 1).collect();
    for (name, device) in devices() {
        let pipeline = compiled(&device, SQUARES);
        let [from, into] = [&numbers, &vec![0; 1000]].map(|words| buffer(&device, words));
        let groups = [group(&device, &pipeline, &[&from, &into])];
        run(&device, &pipeline, &groups, [42, 1, 1]);
        let squares: Vec<u32> = numbers.iter().map(|n| n * n).collect();
        assert_eq!(words(&into), squares, "{name}");
        assert_eq!(words(&from), numbers, "{name}");
    }
}

const PREFIX_SUM: &str = "
@group(0) @binding(0) var<storage, read_write> numbers: array<u32>;
var<workgroup> shared_sums: array<u32, 64>;
@compute @workgroup_size(8, 4, 2)
fn main(
    @builtin(local_invocation_index) at: u32,
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    let number = (group.z * groups.y + group.y) * groups.x + group.x;
    let first = number * 64u;
    shared_sums[at] = numbers[first + local.x + local.y * 8u + local.z * 32u];
    workgroupBarrier();
    for (var step = 1u; step < 64u; step *= 2u) {
        var before = 0u;
        if at >= step { before = shared_sums[at - step]; }
        workgroupBarrier();
        shared_sums[at] += before;
        workgroupBarrier();
    }
    numbers[first + at] = shared_sums[at];
}
";

/// Rows: G5
#[test]
fn barriers_order_the_memory_of_a_work_group() {
    let count = [3, 2, 2];
    let numbers: Vec<u32> = (0..64 * 12).map(|n| n * 7 % 31).collect();
    let sums: Vec<u32> = numbers
        .chunks(64)
        .flat_map(|group| {
            group.iter().scan(0, |sum, n| {
                *sum += n;
                Some(*sum)
            })
        })
        .collect();
    for (name, device) in devices() {
        let pipeline = compiled(&device, PREFIX_SUM);
        let data = buffer(&device, &numbers);
        run(
            &device,
            &pipeline,
            &[group(&device, &pipeline, &[&data])],
            count,
        );
        assert_eq!(words(&data), sums, "{name}");
    }
}

const APPEND: &str = "
struct List { count: atomic<u32>, items: array<u32> }
@group(0) @binding(0) var<storage, read_write> list: List;
@group(0) @binding(1) var<storage, read_write> histogram: array<atomic<u32>, 4>;
@compute @workgroup_size(8) fn main(@builtin(global_invocation_id) id: vec3u) {
    atomicAdd(&histogram[id.x % 4u], id.x);
    if id.x % 3u == 0u { list.items[atomicAdd(&list.count, 1u)] = id.x; }
}
";

/// Rows: G5
#[test]
fn atomics_whose_order_can_be_seen_run_in_order() {
    for (name, device) in devices() {
        let pipeline = compiled(&device, APPEND);
        let list = buffer(&device, &[0; 1 + 400]);
        let histogram = buffer(&device, &[0; 4]);
        let groups = [group(&device, &pipeline, &[&list, &histogram])];
        run(&device, &pipeline, &groups, [150, 1, 1]);
        let list = words(&list);
        let multiples: Vec<u32> = (0..400).map(|n| n * 3).collect();
        assert_eq!((list[0], &list[1..]), (400, &multiples[..]), "{name}");
        let sums: Vec<u32> = (0..4).map(|k| (0..300).map(|n| n * 4 + k).sum()).collect();
        assert_eq!(words(&histogram), sums, "{name}");
    }
}

#[test]
fn a_buffer_gives_the_number_of_work_groups() {
    let device = Device::new(&Default::default()).expect("threads");
    let pipeline = compiled(&device, SQUARES);
    let [from, into] = [[2; 100], [0; 100]].map(|words| buffer(&device, &words));
    let groups = [group(&device, &pipeline, &[&from, &into])];
    let count = buffer(&device, &[9, 2, 1, 1, 70_000]);
    let dispatch = |offset| Dispatch {
        bind_groups: &groups,
        ..Dispatch::new(&pipeline, DispatchSize::Indirect(&count, offset))
    };
    device
        .dispatch(&dispatch(4))
        .unwrap_or_else(|error| panic!("{error}"));
    let expected: Vec<u32> = (0..100).map(|at| if at < 48 { 4 } else { 0 }).collect();
    assert_eq!(words(&into), expected);
    let refused = |offset| device.dispatch(&dispatch(offset)).unwrap_err().to_string();
    assert_eq!(
        refused(8),
        "the dispatch of `test`: 1x1x70000 work-groups; the limit \
         max_compute_workgroups_per_dimension is 65535"
    );
    assert_eq!(
        refused(6),
        "the dispatch of `test`: the numbers of work-groups begin at byte 6, which is not a \
         multiple of 4"
    );
    assert_eq!(
        refused(12),
        "the dispatch of `test`: bytes 12..24 of a buffer, which has 20: use a range inside the \
         buffer"
    );
}

#[test]
fn what_does_not_fit_is_refused() {
    let limits = Limits {
        max_compute_workgroup_size_x: 20,
        ..Limits::default()
    };
    let descriptor = estampe::DeviceDescriptor {
        limits,
        ..Default::default()
    };
    let small = Device::new(&descriptor).expect("threads");
    let program = program(&small, SQUARES);
    let error = small.create_compute_pipeline(&ComputePipelineDescriptor::new(program.clone()));
    assert_eq!(
        error.unwrap_err().to_string(),
        "work-groups of 24x1x1 invocations: each number is at least 1; the limit \
         max_compute_workgroup_size_x is 20"
    );
    let device = Device::new(&Default::default()).expect("threads");
    let error = device.create_compute_pipeline(&ComputePipelineDescriptor {
        bind_group_layouts: Vec::new(),
        ..ComputePipelineDescriptor::new(program)
    });
    assert_eq!(
        error.unwrap_err().to_string(),
        "the shader uses a read-only storage buffer at group 0, binding 0, where the bind group \
         layouts of the pipeline have nothing"
    );
    let pipeline = compiled(&device, SQUARES);
    let one = buffer(&device, &[1; 50]);
    let both = [group(&device, &pipeline, &[&one, &one])];
    let refused = |bind_groups: &[BindGroup]| {
        let dispatch = Dispatch {
            bind_groups,
            ..Dispatch::new(&pipeline, [1, 1, 1])
        };
        device.dispatch(&dispatch).unwrap_err().to_string()
    };
    assert_eq!(
        refused(&both),
        "the dispatch of `test`: a buffer is written as binding 1 of a bind group and used as \
         binding 0 of a bind group: give one of them another buffer, or use them one after the \
         other"
    );
    let two = compiled(
        &device,
        "@group(0) @binding(0) var<storage, read_write> a: array<u32>;
         @group(0) @binding(1) var<storage, read_write> b: array<u32>;
         @compute @workgroup_size(1) fn main() { a[0] = 1u; b[0] = 2u; }",
    );
    let groups = [group(&device, &two, &[&one, &one])];
    let error = device.dispatch(&Dispatch {
        bind_groups: &groups,
        ..Dispatch::new(&two, [1, 1, 1])
    });
    assert_eq!(
        error.unwrap_err().to_string(),
        "the dispatch of `test`: bind group 0: binding 1 of a bind group and binding 0 of a bind \
         group are the same memory, which the shader may write by both: bind parts that do not \
         overlap"
    );
    assert_eq!(
        refused(&[]),
        "the dispatch of `test`: bind group 0: the pipeline needs it, and none is bound"
    );
}

#[test]
fn loops_without_end_are_stopped() {
    let source = "
        @group(0) @binding(0) var<storage, read_write> count: array<u32>;
        @compute @workgroup_size(1) fn main() {
            loop { count[0] += 1u; if count[0] == 0u { break; } }
        }";
    for level in estampe::Level::all_available() {
        let name = format!("{level:?}");
        let limits = Limits {
            max_shader_jumps: 1000,
            ..Limits::default()
        };
        let descriptor = estampe::DeviceDescriptor {
            level,
            limits,
            ..Default::default()
        };
        let device = Device::new(&descriptor).expect("threads");
        let descriptor = ComputePipelineDescriptor::new(program(&device, source));
        let pipeline = device
            .create_compute_pipeline(&descriptor)
            .expect("it fits");
        let count = buffer(&device, &[0]);
        let groups = [group(&device, &pipeline, &[&count])];
        let error = device.dispatch(&Dispatch {
            bind_groups: &groups,
            ..Dispatch::new(&pipeline, [1, 1, 1])
        });
        let kind = error.unwrap_err().kind;
        assert!(
            matches!(kind, DispatchErrorKind::Stopped(_)),
            "{name}: {kind}"
        );
        // What was stored until then stays, and the buffer is there again.
        assert!((1..=1001).contains(&words(&count)[0]), "{name}");
        count
            .write(0, bytes_of(&[5_u32]))
            .expect("it can be written");
        assert_eq!(words(&count), [5], "{name}");
    }
}
