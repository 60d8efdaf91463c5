//! A frame that repeats the previous one allocates nothing.

use estampe::shader::{FragmentIn, FragmentOut, VertexIn, VertexOut};
use estampe::state::{CullMode, PrimitiveState, VertexBufferLayout};
use estampe::{
    Buffer, Device, DeviceDescriptor, Draw, IndexFormat, RenderPass, RenderPipeline,
    RenderPipelineDescriptor, RenderTarget, RenderTargetDescriptor, Vec3, Vec4, VertexFormat,
};
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Allocations of all threads since the start of the program.
static ALLOCATIONS: AtomicUsize = AtomicUsize::new(0);

/// The counter belongs to the whole process, so the tests take turns.
static TURN: Mutex<()> = Mutex::new(());

struct Counting;

// SAFETY: every call is passed on to the system's allocator unchanged.
#[expect(unsafe_code, reason = "a global allocator is an unsafe trait")]
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        // SAFETY: the caller guarantees the system allocator's conditions.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(memory, layout) }
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        // SAFETY: as above.
        unsafe { System.realloc(memory, layout, size) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// A colour at a position in clip space, outside the near plane where z is negative.
struct Colored;

estampe::shader! {
    impl Shader for Colored {
        type Attributes<R: Real> = Vec3<R>;
        type Varyings<R: Real> = Vec3<R>;

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, at: Vec3<R>) -> VertexOut<R, Vec3<R>> {
            let one = input.real(1.0);
            VertexOut::new(Vec4::new(at.x, at.y, at.z, one), at)
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, at: Vec3<R>) -> FragmentOut<R> {
            let one = input.real(1.0);
            FragmentOut::color(Vec4::new(at.x, at.y, at.z, one))
        }
    }
}

/// A grid of `side` by `side` cells over the frame, sloped so that a part of it is clipped.
fn grid(side: u32) -> (Buffer, Buffer) {
    let across = |at: u32| at as f32 / side as f32 * 2.0 - 1.0;
    let vertex = |row: u32, column: u32| {
        let (x, y) = (across(column), across(row));
        [x, y, 0.4 + 0.3 * x + 0.2 * y]
    };
    let rows = 0..=side;
    let vertices = rows.flat_map(|row| (0..=side).flat_map(move |column| vertex(row, column)));
    let cells = (0..side).flat_map(|row| (0..side).map(move |column| row * (side + 1) + column));
    let corners = |at: u32| {
        [
            at,
            at + 1,
            at + side + 1,
            at + side + 1,
            at + 1,
            at + side + 2,
        ]
    };
    let indices = cells.flat_map(corners).flat_map(u32::to_le_bytes);
    (
        Buffer::from_f32s(&vertices.collect::<Vec<f32>>()),
        Buffer::from_bytes(&indices.collect::<Vec<u8>>()),
    )
}

struct Scene {
    device: Device,
    target: RenderTarget,
    pipelines: [RenderPipeline; 2],
    vertices: Buffer,
    indices: Buffer,
}

impl Scene {
    fn new(threads: usize, samples: u32) -> Self {
        let device = Device::new(&DeviceDescriptor {
            threads,
            ..DeviceDescriptor::default()
        })
        .expect("the system starts two threads");
        let pipeline = |cull_mode| {
            let mut descriptor = RenderPipelineDescriptor::new(Colored);
            descriptor.samples = samples;
            descriptor.vertex_buffers =
                vec![VertexBufferLayout::packed(&[VertexFormat::Float32x3])];
            descriptor.primitive = PrimitiveState {
                cull_mode,
                ..PrimitiveState::default()
            };
            device
                .create_render_pipeline(&descriptor)
                .expect("a valid pipeline")
        };
        let (vertices, indices) = grid(80);
        Self {
            target: device
                .create_render_target(&RenderTargetDescriptor {
                    samples,
                    ..RenderTargetDescriptor::new(300, 200)
                })
                .expect("a valid target"),
            pipelines: [pipeline(CullMode::None), pipeline(CullMode::Back)],
            device,
            vertices,
            indices,
        }
    }

    /// The number of allocations of each of four frames, after frames that are not counted.
    fn allocations(&mut self) -> [usize; 4] {
        let elements = 80 * 80 * 6;
        let draws = [0, 1, 0].map(|pipeline: usize| Draw {
            vertex_buffers: std::slice::from_ref(&self.vertices),
            indices: Some((&self.indices, IndexFormat::Uint32)),
            ..Draw::new(&self.pipelines[pipeline], 0..elements)
        });
        let pass = RenderPass {
            draws: &draws,
            ..RenderPass::default()
        };
        for _ in 0..3 {
            let statistics = self.device.render(&mut self.target, &pass).unwrap();
            assert!(statistics.primitives_clipped > 0 && statistics.fragments_shaded > 0);
        }
        std::array::from_fn(|_| {
            let before = ALLOCATIONS.load(Ordering::Relaxed);
            self.device.render(&mut self.target, &pass).unwrap();
            ALLOCATIONS.load(Ordering::Relaxed) - before
        })
    }
}

fn turn() -> std::sync::MutexGuard<'static, ()> {
    TURN.lock()
        .unwrap_or_else(std::sync::PoisonError::into_inner)
}

#[test]
fn one_thread_allocates_nothing() {
    let _turn = turn();
    for samples in [1, 4] {
        assert_eq!(
            Scene::new(1, samples).allocations(),
            [0; 4],
            "{samples} samples"
        );
    }
}

/// Rayon allocates a job for each helper that it wakes, once for each of a pass's phases (too few
/// indices to be shared; then vertices, primitives, tiles), and now and then a block of its queue.
/// The assignment of tiles to workers differs from frame to frame, so that a worker's scratch may
/// still grow in a later frame; the minimum over frames is what a frame needs.
#[test]
fn two_threads_allocate_only_rayons_jobs() {
    let _turn = turn();
    let least = Scene::new(2, 1).allocations().into_iter().min();
    assert!(
        least.is_some_and(|least| least <= 4),
        "{least:?} allocations"
    );
}
