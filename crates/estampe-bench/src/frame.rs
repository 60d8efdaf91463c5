//! One frame of a scene: record the passes, render them, resolve; colour and depth are then in
//! memory.

use crate::BenchError;
use crate::resources::Resources;
use crate::scene::passes::PreparedFrame;
use crate::scene::{CLEAR_COLOR, Scene, SceneDraw};
use crate::target::{Target, TargetDescriptor};
use estampe::{
    BindGroup, Device, Draw, Extent3d, IndexFormat, RenderPass, Statistics, TexelCopyLayout,
    Texture,
};
use std::ops::Range;
use std::time::{Duration, Instant};

/// A frame's size in pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FrameSize {
    /// Width.
    pub width: u32,
    /// Height.
    pub height: u32,
}

impl std::fmt::Display for FrameSize {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}x{}", self.width, self.height)
    }
}

impl std::str::FromStr for FrameSize {
    type Err = String;

    /// Parses `WxH`.
    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text
            .split_once('x')
            .map(|(width, height)| (width.parse(), height.parse()));
        match numbers {
            Some((Ok(width), Ok(height))) if width > 0 && height > 0 => Ok(Self { width, height }),
            _ => Err(format!("'{text}' is not a size: write it as 1280x720")),
        }
    }
}

/// A scene with its resources on a device, created once for many frames.
#[derive(Debug)]
pub struct PreparedScene<'d> {
    device: &'d Device,
    work: Work<'d>,
}

#[derive(Debug)]
enum Work<'d> {
    /// One pass, and perhaps a depth map before it.
    Draws(Box<PreparedDraws<'d>>),
    /// Any passes and dispatches.
    Frame(PreparedFrame<'d>),
}

/// A scene of one pass, and perhaps a depth map before it.
#[derive(Debug)]
struct PreparedDraws<'d> {
    device: &'d Device,
    resources: Resources,
    /// The depth-map pass before the frame's pass, if the scene has one.
    depth_map: Option<(Target, Vec<PreparedDraw>)>,
    draws: Vec<PreparedDraw>,
    target: Target,
    /// The image of the resolve, if the scene is multisampled.
    resolved: Option<Texture>,
}

#[derive(Debug)]
struct PreparedDraw {
    draw: SceneDraw,
    elements: Range<u32>,
}

/// Times of one frame.
#[derive(Debug, Clone, Copy)]
pub struct FrameTimes {
    /// Time to record the draws.
    pub recording: Duration,
    /// Statistics of all passes.
    pub statistics: Statistics,
}

impl<'d> PreparedScene<'d> {
    /// Creates the scene's pipelines, buffers and targets for frames of this size.
    ///
    /// # Errors
    /// [`BenchError`] if the size exceeds the device's limits.
    pub fn new(device: &'d Device, scene: &Scene, size: FrameSize) -> Result<Self, BenchError> {
        let work = match &scene.frame {
            Some(frame) => Work::Frame(PreparedFrame::new(device, scene, frame)?),
            None => Work::Draws(Box::new(PreparedDraws::new(device, scene, size)?)),
        };
        Ok(Self { device, work })
    }

    /// Records and draws a frame; nothing of the previous frame is reused.
    pub fn draw(&mut self) -> FrameTimes {
        match &mut self.work {
            Work::Draws(draws) => draws.draw(),
            Work::Frame(frame) => frame.draw(),
        }
    }

    /// The last frame's colours: RGBA8, row by row from the top; of sRGB formats as stored.
    #[must_use]
    pub fn read_color(&self) -> Vec<u8> {
        let picture = self.picture();
        let read = self.device.read_texture(picture);
        let mut bytes = read.expect("a texture of one sample for all uses");
        if picture.format().is_bgra() {
            for pixel in bytes.as_chunks_mut::<4>().0 {
                pixel.swap(0, 2);
            }
        }
        bytes
    }

    /// The number of bytes of [`Self::read_color`].
    #[must_use]
    pub fn color_len_bytes(&self) -> usize {
        let picture = self.picture();
        picture.width() as usize * picture.height() as usize * 4
    }

    /// The bytes of the last frame's colours in the order of their format, into memory of
    /// [`Self::color_len_bytes`], on the device's threads.
    pub fn read_color_into(&self, image: &mut [u8]) {
        let picture = self.picture();
        let size = Extent3d::new_2d(picture.width(), picture.height());
        let layout = TexelCopyLayout::default();
        let read = self.device.read_texture_into(picture, image, &layout, size);
        debug_assert_eq!(read, Ok(()), "memory of color_len_bytes");
    }

    /// The image that holds the frame with one sample per pixel.
    fn picture(&self) -> &Texture {
        match &self.work {
            Work::Draws(draws) => draws.picture(),
            Work::Frame(frame) => frame.picture(),
        }
    }

    /// The last frame's depths, row by row from the top; nothing if they have several samples, or
    /// the frame has several steps.
    #[must_use]
    pub fn read_depth(&self) -> Vec<f32> {
        let Work::Draws(draws) = &self.work else {
            return Vec::new();
        };
        let depth = draws.target.depth_stencil.as_ref();
        let bytes = depth.and_then(|depth| self.device.read_texture(depth).ok());
        let bytes = bytes.unwrap_or_default();
        let words = bytes.as_chunks().0.iter();
        words.map(|bytes| f32::from_le_bytes(*bytes)).collect()
    }
}

impl<'d> PreparedDraws<'d> {
    fn new(device: &'d Device, scene: &Scene, size: FrameSize) -> Result<Self, BenchError> {
        let prepared = |draws: &[SceneDraw]| -> Vec<PreparedDraw> {
            let draws = draws.iter().map(|draw| PreparedDraw {
                draw: *draw,
                elements: scene.elements(draw),
            });
            draws.collect()
        };
        let depth_map = match &scene.depth_map {
            Some(map) => {
                let size = FrameSize {
                    width: map.size,
                    height: map.size,
                };
                let target = Target::new(
                    device,
                    &TargetDescriptor {
                        color_formats: Vec::new(),
                        ..TargetDescriptor::new(size)
                    },
                )?;
                Some((target, prepared(&map.draws)))
            }
            None => None,
        };
        let target = TargetDescriptor {
            samples: scene.samples,
            ..TargetDescriptor::new(size)
        };
        let resolved = TargetDescriptor {
            depth_stencil: None,
            ..TargetDescriptor::new(size)
        };
        let resolved = if scene.samples > 1 {
            Target::new(device, &resolved)?.colors.pop()
        } else {
            None
        };
        let map = depth_map.as_ref();
        let map = map.and_then(|(target, _)| target.depth_stencil.as_ref());
        Ok(Self {
            device,
            resources: Resources::new(device, scene, map)?,
            depth_map,
            draws: prepared(&scene.draws),
            target: Target::new(device, &target)?,
            resolved,
        })
    }

    fn draw(&self) -> FrameTimes {
        let (device, resources) = (self.device, &self.resources);
        let mut times = FrameTimes {
            recording: Duration::ZERO,
            statistics: Statistics::default(),
        };
        let uniforms = resources.group_0.as_ref();
        if let Some((target, draws)) = &self.depth_map {
            let groups = [uniforms, None];
            render(device, resources, groups, draws, (target, None), &mut times);
        }
        let groups = [uniforms, resources.group_1.as_ref()];
        let target = (&self.target, self.resolved.as_ref());
        render(device, resources, groups, &self.draws, target, &mut times);
        times
    }

    /// The image that holds the frame with one sample per pixel.
    fn picture(&self) -> &Texture {
        self.resolved.as_ref().unwrap_or(&self.target.colors[0])
    }
}

/// Records a pass that clears its target, and draws it.
fn render(
    device: &Device,
    resources: &Resources,
    [uniforms, depth_map]: [Option<&BindGroup>; 2],
    draws: &[PreparedDraw],
    (target, resolved): (&Target, Option<&Texture>),
    times: &mut FrameTimes,
) {
    let start = Instant::now();
    let groups: Vec<BindGroup> = [uniforms, depth_map]
        .into_iter()
        .flatten()
        .cloned()
        .collect();
    let offsets = usize::from(uniforms.is_some());
    let recorded: Vec<Draw<'_>> = (draws.iter())
        .map(|PreparedDraw { draw, elements }| Draw {
            vertex_buffers: std::slice::from_ref(&resources.buffers[draw.vertices]),
            index_buffer: Some((&resources.buffers[draw.indices], IndexFormat::Uint32)),
            instances: 0..draw.instances,
            bind_groups: &groups,
            dynamic_offsets: &std::slice::from_ref(&draw.dynamic_offset)[..offsets],
            ..Draw::new(&resources.pipelines[draw.pipeline], elements.clone())
        })
        .collect();
    let mut colors = target.colors(CLEAR_COLOR.map(f64::from));
    if let (Some(Some(color)), Some(resolved)) = (colors.first_mut(), resolved) {
        color.resolve_target = Some(resolved.view());
    }
    let pass = RenderPass {
        color_attachments: &colors,
        depth_stencil_attachment: target.depth_stencil(),
        draws: &recorded,
        ..RenderPass::default()
    };
    times.recording += start.elapsed();
    times.statistics += device
        .render(&pass)
        .expect("the pipelines are made for the target");
}

#[cfg(test)]
mod tests {
    use super::FrameSize;

    #[test]
    fn sizes_are_read_and_written() {
        let size = FrameSize {
            width: 1280,
            height: 720,
        };
        assert_eq!("1280x720".parse(), Ok(size));
        assert_eq!(size.to_string(), "1280x720");
        for wrong in [
            "",
            "x",
            "12",
            "0x5",
            "5x0",
            "-1x5",
            "1x2x3",
            "99999999999x1",
        ] {
            assert!(wrong.parse::<FrameSize>().is_err(), "{wrong}");
        }
    }
}
