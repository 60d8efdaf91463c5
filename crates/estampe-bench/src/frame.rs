//! One frame of a scene: record the passes, render them, resolve; colour and depth are then in
//! memory.

use crate::BenchError;
use crate::scene::{CLEAR_COLOR, Scene, SceneDraw, shadow};
use estampe::{
    BindGroup, Binding, Bindings, Buffer, DepthTexture, Device, Draw, IndexFormat, LoadOp,
    RenderPass, RenderPipeline, RenderTarget, RenderTargetDescriptor, Statistics,
};
use std::ops::Range;
use std::sync::Arc;
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
    resources: Resources,
    /// The depth-map pass before the frame's pass, if the scene has one.
    depth_map: Option<(RenderTarget, Vec<PreparedDraw>)>,
    draws: Vec<PreparedDraw>,
    target: RenderTarget,
    /// The target of the resolve, if the scene is multisampled.
    resolved: Option<RenderTarget>,
}

/// The buffers and bindings to which draws refer.
#[derive(Debug)]
struct Resources {
    pipelines: Vec<RenderPipeline>,
    buffers: Vec<Buffer>,
    /// The index of the buffer that is bound at each draw's dynamic offset.
    uniforms: Option<usize>,
    /// Group 0, if it is the same in every frame.
    bind_group: Arc<BindGroup>,
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
        let prepared = |draws: &[SceneDraw]| -> Vec<PreparedDraw> {
            let draws = draws.iter().map(|draw| PreparedDraw {
                draw: *draw,
                elements: scene.elements(draw),
            });
            draws.collect()
        };
        let image = RenderTargetDescriptor::new(size.width, size.height);
        let resolved = RenderTargetDescriptor {
            depth_stencil: None,
            ..image.clone()
        };
        let depth_map = match &scene.depth_map {
            Some(map) => {
                let target = device.create_render_target(&RenderTargetDescriptor {
                    color_formats: Vec::new(),
                    ..RenderTargetDescriptor::new(map.size, map.size)
                })?;
                Some((target, prepared(&map.draws)))
            }
            None => None,
        };
        Ok(Self {
            device,
            resources: Resources::new(device, scene)?,
            depth_map,
            draws: prepared(&scene.draws),
            target: device.create_render_target(&RenderTargetDescriptor {
                samples: scene.samples,
                ..image
            })?,
            resolved: if scene.samples > 1 {
                Some(device.create_render_target(&resolved)?)
            } else {
                None
            },
        })
    }

    /// Records and draws a frame; nothing of the previous frame is reused.
    pub fn draw(&mut self) -> FrameTimes {
        let (device, resources) = (self.device, &self.resources);
        let mut times = FrameTimes {
            recording: Duration::ZERO,
            statistics: Statistics::default(),
        };
        let mut map_group = None;
        if let Some((target, draws)) = &mut self.depth_map {
            render(
                device,
                resources,
                &resources.bind_group,
                draws,
                target,
                &mut times,
            );
            let texture = device.depth_texture(target);
            map_group = texture.map(|texture| resources.group(Some(texture)));
        }
        let group = map_group.as_ref().unwrap_or(&resources.bind_group);
        render(
            device,
            resources,
            group,
            &self.draws,
            &mut self.target,
            &mut times,
        );
        if let Some(resolved) = &mut self.resolved {
            device
                .resolve(&self.target, resolved)
                .expect("the targets fit together");
        }
        times
    }

    /// The last frame's colours: RGBA8, row by row from the top.
    #[must_use]
    pub fn read_color(&self) -> Vec<u8> {
        self.device.read_color(self.picture(), 0)
    }

    /// The number of bytes of [`Self::read_color`].
    #[must_use]
    pub fn color_len_bytes(&self) -> usize {
        self.picture().color_len_bytes(0)
    }

    /// [`Self::read_color`] into memory of [`Self::color_len_bytes`], on the device's threads.
    pub fn read_color_into(&self, image: &mut [u8]) {
        let read = self.device.read_color_into(self.picture(), 0, image);
        debug_assert_eq!(read, Ok(()), "memory of color_len_bytes");
    }

    /// The target that holds the frame with one sample per pixel.
    fn picture(&self) -> &RenderTarget {
        self.resolved.as_ref().unwrap_or(&self.target)
    }

    /// The last frame's depths, row by row from the top.
    #[must_use]
    pub fn read_depth(&self) -> Vec<f32> {
        self.target.read_depth()
    }
}

impl Resources {
    fn new(device: &Device, scene: &Scene) -> Result<Self, BenchError> {
        let pipelines = scene.pipelines.iter();
        let buffers = scene.buffers.iter();
        let mut resources = Self {
            pipelines: pipelines
                .map(|descriptor| device.create_render_pipeline(descriptor))
                .collect::<Result<_, _>>()?,
            buffers: buffers.map(|bytes| Buffer::from_bytes(bytes)).collect(),
            uniforms: scene.uniforms,
            bind_group: Arc::default(),
        };
        resources.bind_group = resources.group(None);
        Ok(resources)
    }

    /// Group 0: the uniforms, and the depth map if there is one.
    fn group(&self, depth_map: Option<DepthTexture>) -> Arc<BindGroup> {
        let uniforms = self.uniforms.map(|index| Binding::Buffer {
            buffer: self.buffers[index].clone(),
            offset: 0,
            has_dynamic_offset: true,
        });
        let uniforms = uniforms.map(|binding| (0, binding));
        let depth_map = depth_map.map(|map| (shadow::DEPTH_MAP, Binding::DepthTexture(map)));
        Arc::new(BindGroup {
            entries: uniforms.into_iter().chain(depth_map).collect(),
        })
    }
}

/// Records a pass that clears its target, and draws it.
fn render(
    device: &Device,
    resources: &Resources,
    group: &Arc<BindGroup>,
    draws: &[PreparedDraw],
    target: &mut RenderTarget,
    times: &mut FrameTimes,
) {
    let start = Instant::now();
    let bindings = draws.iter().map(|PreparedDraw { draw, .. }| Bindings {
        groups: vec![(Arc::clone(group), draw.dynamic_offset)],
    });
    let bindings: Vec<Bindings> = bindings.collect();
    let recorded: Vec<Draw<'_>> = (draws.iter().zip(&bindings))
        .map(|(PreparedDraw { draw, elements }, bindings)| Draw {
            vertex_buffers: std::slice::from_ref(&resources.buffers[draw.vertices]),
            indices: Some((&resources.buffers[draw.indices], IndexFormat::Uint32)),
            instances: 0..draw.instances,
            bindings: Some(bindings),
            ..Draw::new(&resources.pipelines[draw.pipeline], elements.clone())
        })
        .collect();
    let pass = RenderPass {
        load_colors: vec![LoadOp::Clear(CLEAR_COLOR.map(f64::from)); target.color_formats().len()],
        draws: &recorded,
        ..RenderPass::default()
    };
    times.recording += start.elapsed();
    times.statistics += device
        .render(target, &pass)
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
