//! The bandwidth of the conversions between a texture's tiles and its rows, against memcpy.
//!
//! Through the public API a texture is converted when its role changes. To rows: a pass renders to
//! the texture, then it is sampled. To tiles: the host writes one texel, then a pass without draws
//! keeps the contents; the time of the same pass when nothing is converted is subtracted.

use crate::BenchError;
use crate::frame::FrameSize;
use crate::measure::Effort;
use estampe::{
    ColorAttachment, DepthStencilAttachment, Device, Extent3d, RenderPass, Sampler,
    SamplerDescriptor, TexelCopyLayout, Texture, TextureDescriptor, TextureFormat, ThreadPool,
    ThreadPoolBuilder,
};
use std::hint::black_box;
use std::time::{Duration, Instant};

/// The direction of a conversion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// From tiles to rows.
    ToRows,
    /// From rows to tiles.
    ToTiles,
}

/// A conversion to measure.
#[derive(Debug, Clone, Copy)]
pub struct Conversion {
    /// The direction.
    pub direction: Direction,
    /// The format, of four bytes a texel.
    pub format: TextureFormat,
    /// The size of the image.
    pub size: FrameSize,
}

/// Times of a conversion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConversionTiming {
    /// The conversion in milliseconds, median.
    pub ms: f64,
    /// A copy of as many bytes on as many threads in milliseconds, median.
    pub copy_ms: f64,
}

/// Every conversion of RGBA8, float depth, and depth of 24 bits with stencil, at two sizes.
pub fn all() -> impl Iterator<Item = Conversion> {
    let sizes = [[1280, 720], [1920, 1080]];
    let formats = [
        TextureFormat::Rgba8Unorm,
        TextureFormat::Depth32Float,
        TextureFormat::Depth24PlusStencil8,
    ];
    sizes.into_iter().flat_map(move |[width, height]| {
        formats.into_iter().flat_map(move |format| {
            let directions = [Direction::ToRows, Direction::ToTiles];
            directions.into_iter().map(move |direction| Conversion {
                direction,
                format,
                size: FrameSize { width, height },
            })
        })
    })
}

impl Conversion {
    /// Measures the conversion, and in turn with it memcpy.
    ///
    /// # Errors
    /// [`BenchError`] if the device refuses the texture, or the system the threads.
    pub fn measure(&self, device: &Device, effort: Effort) -> Result<ConversionTiming, BenchError> {
        let image = Image::new(device, self)?;
        let mut copy = Copy::new(self.len_bytes(), device.threads());
        let (mut times, mut copies) = (Vec::new(), Vec::new());
        let start = Instant::now();
        // The first rounds allocate.
        let warm_up = 3;
        while times.len() < effort.frames + warm_up || start.elapsed() < effort.time {
            times.push(match self.direction {
                Direction::ToRows => image.to_rows()?,
                Direction::ToTiles => image.to_tiles()?,
            });
            copies.push(copy.run());
        }
        Ok(ConversionTiming {
            ms: median_ms(&mut times[warm_up..]),
            copy_ms: median_ms(&mut copies[warm_up..]),
        })
    }

    /// The line of the table.
    #[must_use]
    pub fn line(&self, timing: &ConversionTiming) -> String {
        let name = format!(
            "{}, {}, {}",
            match self.direction {
                Direction::ToRows => "tiles to rows",
                Direction::ToTiles => "rows to tiles",
            },
            self.format.name(),
            self.size
        );
        let rate = |ms: f64| self.len_bytes() as f64 / (ms * 1e6);
        format!(
            "{name:<46}{:>8.3}{:>8.1}{:>12.3}{:>8.1}{:>10.0} %",
            timing.ms,
            rate(timing.ms),
            timing.copy_ms,
            rate(timing.copy_ms),
            timing.copy_ms / timing.ms * 100.0
        )
    }

    fn len_bytes(&self) -> usize {
        self.size.width as usize * self.size.height as usize * 4
    }
}

/// The header of the table. GB/s count the bytes of the image once.
pub const HEADER: &str = "conversion                                          ms    GB/s   memcpy ms    GB/s   of memcpy";

/// A texture that changes its role.
struct Image<'d> {
    device: &'d Device,
    texture: Texture,
    sampler: Sampler,
}

impl<'d> Image<'d> {
    fn new(device: &'d Device, conversion: &Conversion) -> Result<Self, BenchError> {
        let FrameSize { width, height } = conversion.size;
        let descriptor = TextureDescriptor::new_2d(width, height, conversion.format);
        // As floats, these bytes are numbers in 0..1.
        let bytes: Vec<u8> = (0..conversion.len_bytes())
            .map(|at| [at.to_le_bytes()[1], 17, at.to_le_bytes()[2], 63][at % 4])
            .collect();
        Ok(Self {
            device,
            texture: device.create_texture_with_data(&descriptor, &[&bytes])?,
            sampler: device.create_sampler(&SamplerDescriptor::default())?,
        })
    }

    fn to_rows(&self) -> Result<Duration, BenchError> {
        self.render()?;
        let start = Instant::now();
        let view = self
            .device
            .sampled_texture(&self.texture.view(), &self.sampler)?;
        let time = start.elapsed();
        drop(black_box(view));
        Ok(time)
    }

    fn to_tiles(&self) -> Result<Duration, BenchError> {
        let one = Extent3d::new_2d(1, 1);
        let layout = TexelCopyLayout::default();
        self.device
            .write_texture(&self.texture, &[0; 4], &layout, one)?;
        let with_conversion = self.render()?;
        let alone = self.render()?;
        Ok(with_conversion.saturating_sub(alone))
    }

    /// A pass without draws that keeps the contents.
    fn render(&self) -> Result<Duration, BenchError> {
        let view = self.texture.view();
        let is_color = self.texture.format().is_color();
        let color = [is_color.then(|| ColorAttachment::load(&view))];
        let start = Instant::now();
        self.device.render(&RenderPass {
            color_attachments: &color,
            depth_stencil_attachment: (!is_color).then(|| DepthStencilAttachment::load(&view)),
            ..RenderPass::default()
        })?;
        Ok(start.elapsed())
    }
}

/// A copy of bytes on several threads.
struct Copy {
    from: Vec<u8>,
    into: Vec<u8>,
    /// None for one thread.
    pool: Option<(ThreadPool, usize)>,
}

impl Copy {
    fn new(len: usize, threads: usize) -> Self {
        let pool = (threads > 1).then(|| ThreadPoolBuilder::new().num_threads(threads).build());
        Self {
            from: (0..len).map(|at| at.to_le_bytes()[0]).collect(),
            into: vec![1; len],
            // Without threads the copy is one thread's.
            pool: pool.and_then(Result::ok).map(|pool| (pool, threads)),
        }
    }

    fn run(&mut self) -> Duration {
        let start = Instant::now();
        match &self.pool {
            None => self.into.copy_from_slice(&self.from),
            Some((pool, threads)) => {
                let part = self.from.len().div_ceil(*threads);
                let parts = self.into.chunks_mut(part).zip(self.from.chunks(part));
                pool.scope(|scope| {
                    for (into, from) in parts {
                        scope.spawn(move |_| into.copy_from_slice(from));
                    }
                });
            }
        }
        let time = start.elapsed();
        black_box(&mut self.into);
        time
    }
}

fn median_ms(times: &mut [Duration]) -> f64 {
    times.sort_unstable();
    times[times.len() / 2].as_secs_f64() * 1e3
}

#[cfg(test)]
mod tests {
    use super::*;
    use estampe::DeviceDescriptor;

    #[test]
    fn each_conversion_takes_time_and_has_a_line() {
        let effort = Effort {
            frames: 1,
            time: Duration::ZERO,
            retries: 0,
        };
        let device = Device::new(&DeviceDescriptor::default()).unwrap();
        let mut count = 0;
        for conversion in all() {
            let small = Conversion {
                size: FrameSize {
                    width: 300,
                    height: 200,
                },
                ..conversion
            };
            let timing = small.measure(&device, effort).unwrap();
            assert!(timing.copy_ms > 0.0);
            assert_eq!(conversion.line(&timing).len(), HEADER.len());
            count += 1;
        }
        assert_eq!(count, 12);
    }
}
