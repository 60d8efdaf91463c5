//! A frame that repeats the previous one allocates a fixed, small number of lists.

#[path = "api/support/mod.rs"]
mod support;

use estampe::shader::{FragmentIn, FragmentOut, VertexIn, VertexOut};
use estampe::state::{CullMode, PrimitiveState, VertexBufferLayout};
use estampe::{
    BufferSlice, ColorAttachment, Device, Draw, IndexFormat, Level, RenderPass, RenderPipeline,
    RenderPipelineDescriptor, TextureFormat, Vec3, Vec4, VertexFormat, bytes_of,
};
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use support::{Images, device_with};

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
fn grid(side: u32) -> (Vec<f32>, Vec<u32>) {
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
    (vertices.collect(), cells.flat_map(corners).collect())
}

struct Scene {
    device: Device,
    images: Images,
    pipelines: [RenderPipeline; 2],
    vertices: BufferSlice,
    indices: BufferSlice,
}

impl Scene {
    fn new(threads: usize, samples: u32) -> Self {
        let device = device_with(threads, Level::best());
        let pipeline = |cull_mode| {
            let mut descriptor = RenderPipelineDescriptor::new(Colored);
            descriptor.multisample.count = samples;
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
        let buffer = |bytes: &[u8]| {
            let buffer = device.create_buffer_with_contents(bytes);
            buffer.expect("it is small").slice(..)
        };
        Self {
            images: Images::with(&device, [300, 200], TextureFormat::Rgba8Unorm, samples),
            pipelines: [pipeline(CullMode::None), pipeline(CullMode::Back)],
            vertices: buffer(bytes_of(&vertices)),
            indices: buffer(bytes_of(&indices)),
            device,
        }
    }

    /// The number of allocations of each of four frames, after frames that are not counted.
    fn allocations(&self, draws: usize) -> [usize; 4] {
        let elements = 80 * 80 * 6;
        let draws = (0..draws).map(|number| Draw {
            vertex_buffers: std::slice::from_ref(&self.vertices),
            index_buffer: Some((&self.indices, IndexFormat::Uint32)),
            ..Draw::new(&self.pipelines[number % 2], 0..elements)
        });
        let draws: Vec<_> = draws.collect();
        let color = ColorAttachment::clear(&self.images.color.view(), [0.0; 4]);
        let pass = RenderPass {
            color_attachments: &[Some(color)],
            depth_stencil_attachment: Some(self.images.cleared_depth()),
            draws: &draws,
            ..RenderPass::default()
        };
        for _ in 0..3 {
            let statistics = self.device.render(&pass).unwrap();
            assert!(statistics.primitives_clipped > 0 && statistics.fragments_shaded > 0);
        }
        std::array::from_fn(|_| {
            let before = ALLOCATIONS.load(Ordering::Relaxed);
            self.device.render(&pass).unwrap();
            ALLOCATIONS.load(Ordering::Relaxed) - before
        })
    }
}

fn turn() -> std::sync::MutexGuard<'static, ()> {
    TURN.lock()
        .unwrap_or_else(std::sync::PoisonError::into_inner)
}

/// The lists of a pass (attachments, textures, buffers, draws), a place in each texture, and four
/// lists with an entry for each layer: its attachments, their images, the target, and which order
/// of its depths is newer. Geometry and tiles allocate nothing, and so does each further draw.
const LISTS: usize = 16;

#[test]
fn one_thread_allocates_the_lists_of_a_pass() {
    let _turn = turn();
    for samples in [1, 4] {
        for draws in [3, 40] {
            let allocations = Scene::new(1, samples).allocations(draws);
            assert_eq!(allocations, [LISTS; 4], "{samples} samples, {draws} draws");
        }
    }
}

/// Rayon allocates a job for each helper that it wakes: once when the pass begins, and twice for
/// each of its phases (too few indices to be shared; then vertices, primitives, tiles), the second
/// time to wait for the next one; and now and then a block of its queue. The assignment of tiles to
/// workers differs from frame to frame, so that a worker's scratch may still grow in a later frame;
/// the minimum over frames is what a frame needs.
#[test]
fn two_threads_add_only_rayons_jobs() {
    let _turn = turn();
    let least = Scene::new(2, 1).allocations(3).into_iter().min();
    assert!(
        least.is_some_and(|least| least <= LISTS + 8),
        "{least:?} allocations"
    );
}
