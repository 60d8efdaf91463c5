//! A worker: draws batches, and looks for samples that a mesh does not hit once.

use super::batch::{Batch, around};
use crate::Random;
use crate::fast_path;
use crate::target::Target;
use estampe::{
    BufferSlice, ColorAttachment, Device, DeviceDescriptor, Draw, Level, RenderPass,
    RenderPipeline, RenderPipelineDescriptor,
};
use estampe_types::shader::VertexOut;
use estampe_types::state::{BlendState, ColorTargetState, MultisampleState, VertexBufferLayout};
use estampe_types::{FragmentIn, FragmentOut, TextureFormat, Vec4, VertexFormat, VertexIn};

/// Adds one 8-bit code to every covered sample.
#[derive(Debug, Clone, Copy)]
struct Hit;

estampe_types::shader! {
    impl Shader for Hit {
        type Attributes<R: Real> = Vec4<R>;
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            position: Vec4<R>,
        ) -> VertexOut<R, ()> {
            VertexOut::new(position, ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, _nothing: ()) -> FragmentOut<R> {
            let unit = input.real(1.0 / 255.0);
            FragmentOut::color(Vec4::new(unit, unit, unit, unit))
        }
    }
}

/// A worker's devices, and their pipelines and targets, which take longer to create than to use.
pub(super) struct Fuzzer {
    /// The scalar SIMD level first.
    devices: Vec<Device>,
    kept: Vec<Kept>,
}

struct Kept {
    device: usize,
    size: [u32; 2],
    samples: u32,
    target: Target,
    pipeline: RenderPipeline,
}

impl Fuzzer {
    pub(super) fn new() -> Self {
        let device = |level| {
            Device::new(&DeviceDescriptor {
                threads: 1,
                level,
                ..DeviceDescriptor::default()
            })
            .expect("a device without threads of its own")
        };
        Self {
            devices: Level::all_available().into_iter().map(device).collect(),
            kept: Vec::new(),
        }
    }

    /// The device that draws the batch of a seed: the scalar, slowest one for every sixteenth seed.
    fn device_of(&self, seed: u64) -> usize {
        let others = self.devices.len() as u64 - 1;
        if others == 0 || seed.is_multiple_of(16) {
            0
        } else {
            1 + usize::try_from(seed % others).expect("few levels")
        }
    }

    /// Draws the batch of a seed and returns its number of triangles.
    pub(super) fn batch(&mut self, seed: u64) -> Result<u64, String> {
        let mut random = Random::new("fuzz/raster", seed);
        let batch = Batch::random(&mut random);
        let at = self.device_of(seed);
        let kept = self.kept(at, batch.size, batch.samples);
        let (device, kept) = (&self.devices[at], &mut self.kept[kept]);
        let meshes: Vec<usize> = (0..batch.meshes.len()).collect();
        let Some(first) = wrong_sample(device, kept, &batch, &meshes) else {
            let counts = batch
                .meshes
                .iter()
                .map(|(_, triangles)| triangles.len() as u64);
            return Ok(counts.sum());
        };
        // Find out which of the meshes is wrong, if one is wrong on its own.
        let alone = meshes.iter().find_map(|&number| {
            let wrong = wrong_sample(device, kept, &batch, &[number])?;
            Some((number, wrong))
        });
        let (size, samples) = (batch.size, batch.samples);
        let place = format!(
            "seed {seed}, {}, target {size:?} of {samples} samples",
            fast_path::name(device)
        );
        let again = format!("again: cargo xtask fuzz raster --seconds 0 --seed {seed}");
        Err(match alone {
            Some((number, wrong)) => {
                let (kind, triangles) = &batch.meshes[number];
                let near = around(triangles, wrong.pixel);
                format!(
                    "{place}, mesh {number} ({kind:?}, {} triangles, w {}): {wrong:?}\n\
                     triangles there, in 1/256 pixel: {near:?}\n{again}",
                    triangles.len(),
                    batch.ws[number],
                )
            }
            None => format!(
                "{place}, {} meshes, none wrong alone: {first:?}\n{again}",
                meshes.len()
            ),
        })
    }

    /// The index in `kept` of the target and pipeline of this size; they are created if necessary.
    fn kept(&mut self, device: usize, size: [u32; 2], samples: u32) -> usize {
        let is_it =
            |kept: &Kept| kept.device == device && kept.size == size && kept.samples == samples;
        self.kept.iter().position(is_it).unwrap_or_else(|| {
            let kept = Kept::new(&self.devices[device], device, size, samples);
            self.kept.push(kept);
            self.kept.len() - 1
        })
    }
}

impl Kept {
    fn new(device: &Device, number: usize, size: [u32; 2], samples: u32) -> Self {
        let pipeline = device
            .create_render_pipeline(&RenderPipelineDescriptor {
                vertex_buffers: vec![VertexBufferLayout::packed(&[VertexFormat::Float32x4])],
                depth_stencil: None,
                multisample: MultisampleState::new(samples),
                targets: vec![Some(ColorTargetState {
                    blend: Some(BlendState::ADDITIVE),
                    ..TextureFormat::Rgba8Unorm.into()
                })],
                ..RenderPipelineDescriptor::new(Hit)
            })
            .expect("a valid pipeline");
        Self {
            device: number,
            size,
            samples,
            target: Target::new(device, size, samples, &[TextureFormat::Rgba8Unorm], None),
            pipeline,
        }
    }
}

/// A sample with a wrong number of hits.
#[derive(Debug, Clone, Copy)]
struct Wrong {
    pixel: [u32; 2],
    #[expect(dead_code, reason = "only the Debug output reads it")]
    sample: u32,
    #[expect(dead_code, reason = "only the Debug output reads it")]
    hits: u8,
    #[expect(dead_code, reason = "only the Debug output reads it")]
    wanted: u8,
}

/// Draws some meshes and looks for a sample that they do not hit once each.
fn wrong_sample(device: &Device, kept: &Kept, batch: &Batch, meshes: &[usize]) -> Option<Wrong> {
    let width = batch.size[0];
    let positions = device.create_buffer_of_words(batch.positions(meshes));
    let buffers = [BufferSlice::from(&positions.expect("a small buffer"))];
    let count = buffers[0].size / 16;
    let draws = [Draw {
        vertex_buffers: &buffers,
        ..Draw::new(
            &kept.pipeline,
            0..u32::try_from(count).expect("few triangles"),
        )
    }];
    let color = &kept.target.colors[0];
    let pass = RenderPass {
        color_attachments: &[Some(ColorAttachment::clear(color, [0.0; 4]))],
        draws: &draws,
        ..RenderPass::default()
    };
    device
        .render(&pass)
        .expect("the pipeline is made for the target");
    let wanted = batch.wanted(meshes);
    (0..batch.samples).find_map(|sample| {
        let read = device.read_sample(color, sample);
        let texels = read.expect("a sample that there is");
        let hits = texels.iter().step_by(4).zip(&wanted);
        (0u32..).zip(hits).find_map(|(at, (&hits, &wanted))| {
            let wanted = wanted.filter(|&wanted| wanted != hits)?;
            Some(Wrong {
                pixel: [at % width, at / width],
                sample,
                hits,
                wanted,
            })
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shared_edges::{Corner, Kind, mesh};

    /// A grid mesh over a small target with this many samples.
    fn grid(samples: u32) -> Batch {
        let mut random = Random::new("fuzz/self", 3);
        let size = [16, 16];
        Batch {
            size,
            samples,
            meshes: vec![(Kind::Grid, mesh(&mut random, Kind::Grid, size))],
            ws: vec![1.0],
        }
    }

    fn is_found(batch: &Batch) -> bool {
        let mut fuzzer = Fuzzer::new();
        let at = fuzzer.kept(0, batch.size, batch.samples);
        wrong_sample(&fuzzer.devices[0], &fuzzer.kept[at], batch, &[0]).is_some()
    }

    #[test]
    fn a_hole_and_a_sample_hit_twice_are_found() {
        for samples in [1, 4, 16] {
            let whole = grid(samples);
            assert!(!is_found(&whole), "{samples} samples");
            let triangles = &whole.meshes[0].1;
            let is_seen =
                |triangle: &[Corner; 3]| triangle.iter().flatten().all(|at| (0..4096).contains(at));
            let inner = triangles.iter().position(is_seen).expect("one inside");

            let mut holed = grid(samples);
            holed.meshes[0].1.remove(inner);
            assert!(is_found(&holed), "{samples} samples: a hole");

            let mut doubled = grid(samples);
            doubled.meshes[0].1.push(triangles[inner]);
            assert!(
                is_found(&doubled),
                "{samples} samples: a triangle drawn twice"
            );
        }
        // One triangle's copy of a shared vertex is moved by 1/4 pixel.
        let mut torn = grid(4);
        for triangle in &mut torn.meshes[0].1 {
            triangle[0][0] += 64;
        }
        assert!(is_found(&torn), "a seam");
    }
}
