//! Resolving depth and stencil: the samples of each pixel become one value (Vulkan's
//! `VkResolveModeFlagBits`).

use super::texels::DepthStencilTexels;
use crate::depth_format::DepthFormat;
use estampe_simd::LANES;

/// The value of a pixel's samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ResolveMode {
    /// The first sample's.
    #[default]
    SampleZero,
    /// The mean: the sum of the samples in order, divided by their number, in f32, rounded to the
    /// format. Not of stencil.
    Average,
    /// The least.
    Min,
    /// The greatest.
    Max,
}

/// A run of packets for one worker.
#[derive(Debug)]
pub(crate) struct ResolveDepthJob<'a> {
    from: &'a [[f32; LANES]],
    into: &'a mut [[f32; LANES]],
    from_stencil: &'a [[u8; LANES]],
    into_stencil: &'a mut [[u8; LANES]],
    samples: usize,
    format: DepthFormat,
    modes: [Option<ResolveMode>; 2],
}

/// Packets of one job: a 64×64 block.
const JOB_PACKETS: usize = 256;

impl<'a> ResolveDepthJob<'a> {
    /// Cuts the resolving of an image into jobs: of depth and of stencil, each by its mode, or not
    /// at all. The images have the same width, height and format, and the destination has one
    /// sample.
    pub(crate) fn all(
        from: &'a DepthStencilTexels,
        into: &'a mut DepthStencilTexels,
        modes: [Option<ResolveMode>; 2],
    ) -> Vec<Self> {
        let (samples, format) = (from.size.samples as usize, from.depth_format());
        let count = from.size.stored_samples() / samples / LANES / JOB_PACKETS;
        let mut depth = from.depth.as_chunks().0.chunks(JOB_PACKETS * samples);
        let mut stencil = from.stencil.as_chunks().0.chunks(JOB_PACKETS * samples);
        let (to_depth, to_stencil, _) = into.tiles_mut(None);
        let mut to_depth = to_depth.as_chunks_mut().0.chunks_mut(JOB_PACKETS);
        let mut to_stencil = to_stencil.as_chunks_mut().0.chunks_mut(JOB_PACKETS);
        let jobs = (0..count).map(|_| Self {
            from: depth.next().unwrap_or_default(),
            into: to_depth.next().unwrap_or_default(),
            from_stencil: stencil.next().unwrap_or_default(),
            into_stencil: to_stencil.next().unwrap_or_default(),
            samples,
            format,
            modes,
        });
        jobs.collect()
    }

    /// Resolves the job's packets.
    pub(crate) fn run(&mut self) {
        let [depth, stencil] = self.modes;
        if let Some(mode) = depth {
            let packets = self.from.chunks_exact(self.samples);
            for (samples, to) in packets.zip(&mut *self.into) {
                *to = match mode {
                    ResolveMode::SampleZero => samples[0],
                    ResolveMode::Min => fold(samples, f32::min),
                    ResolveMode::Max => fold(samples, f32::max),
                    ResolveMode::Average => {
                        let sum = fold(samples, |a, b| a + b);
                        sum.map(|sum| self.format.stored(sum / self.samples as f32))
                    }
                };
            }
        }
        if let Some(mode) = stencil {
            let packets = self.from_stencil.chunks_exact(self.samples);
            for (samples, to) in packets.zip(&mut *self.into_stencil) {
                *to = match mode {
                    ResolveMode::SampleZero | ResolveMode::Average => samples[0],
                    ResolveMode::Min => fold(samples, u8::min),
                    ResolveMode::Max => fold(samples, u8::max),
                };
            }
        }
    }
}

/// Combines the samples of each lane, in order.
fn fold<T: Copy>(samples: &[[T; LANES]], with: impl Fn(T, T) -> T) -> [T; LANES] {
    let mut all = samples[0];
    for sample in &samples[1..] {
        for (all, value) in all.iter_mut().zip(sample) {
            *all = with(*all, *value);
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::attachment::{ImageSize, row_order_words};
    use estampe_format::depth::FixedDepth;
    use estampe_simd::Level;
    use estampe_types::TextureFormat;

    /// The words of an image in row order: a code of 24 bits below the stencil.
    fn words_of(texels: &DepthStencilTexels) -> Vec<u32> {
        let mut rows = vec![0; row_order_words(texels.format, texels.size)];
        let jobs = texels.row_jobs(&mut rows);
        jobs.for_each(|mut job| job.run(Level::best()));
        rows
    }

    #[test]
    fn each_mode_combines_a_pixels_samples() {
        let format = TextureFormat::Depth24PlusStencil8;
        let size = |samples| ImageSize {
            width: 3,
            height: 2,
            samples,
        };
        let mut from = DepthStencilTexels::zeros(format, size(4)).unwrap();
        let fixed = from.depth_format();
        let depths = [0.5, 0.25, 1.0, 0.75].map(|depth| fixed.stored(depth));
        let (stored, stencils, _) = from.tiles_mut(None);
        for (packet, stencil) in stencils.chunks_exact_mut(LANES * 4).enumerate() {
            let depth = &mut stored[packet * LANES * 4..][..LANES * 4];
            for sample in 0..4 {
                depth[sample * LANES..][..LANES].fill(depths[sample]);
                stencil[sample * LANES..][..LANES].fill([7, 9, 3, 5][sample]);
            }
        }
        let mean = fixed.stored((depths[0] + depths[1] + depths[2] + depths[3]) / 4.0);
        for (modes, depth, stencil) in [
            ([ResolveMode::SampleZero; 2], depths[0], 7),
            ([ResolveMode::Min; 2], depths[1], 3),
            ([ResolveMode::Max; 2], depths[2], 9),
            ([ResolveMode::Average, ResolveMode::Max], mean, 9),
        ] {
            let mut into = DepthStencilTexels::zeros(format, size(1)).unwrap();
            let mut jobs = ResolveDepthJob::all(&from, &mut into, modes.map(Some));
            jobs.iter_mut().for_each(ResolveDepthJob::run);
            let word = FixedDepth::new(format).unwrap().code(depth) | stencil << 24;
            assert_eq!(words_of(&into), [word; 6], "{modes:?}");
        }
        let mut into = DepthStencilTexels::zeros(format, size(1)).unwrap();
        let mut jobs = ResolveDepthJob::all(&from, &mut into, [None, Some(ResolveMode::Min)]);
        jobs.iter_mut().for_each(ResolveDepthJob::run);
        assert_eq!(words_of(&into), [3 << 24; 6]);
    }
}
