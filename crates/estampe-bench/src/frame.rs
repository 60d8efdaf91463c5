//! One frame of a scene: record the draws, render, resolve, and colour and depth lie in memory.

use crate::BenchError;
use crate::scene::{CLEAR_COLOR, Scene, SceneDraw};
use estampe::{
    BindGroup, Binding, Bindings, Buffer, Device, Draw, IndexFormat, RenderPass, RenderPipeline,
    RenderTarget, RenderTargetDescriptor, Statistics,
};
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

    /// Reads `WxH`.
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

/// A scene on a device: everything that is made once.
#[derive(Debug)]
pub struct PreparedScene<'d> {
    device: &'d Device,
    pipelines: Vec<RenderPipeline>,
    buffers: Vec<Buffer>,
    /// Group 0 of the draws that have uniforms.
    bind_group: Option<Arc<BindGroup>>,
    draws: Vec<PreparedDraw>,
    target: RenderTarget,
    /// What the samples are resolved to, if there are several.
    resolved: Option<RenderTarget>,
}

#[derive(Debug)]
struct PreparedDraw {
    draw: SceneDraw,
    index_count: u32,
}

/// What one frame took.
#[derive(Debug, Clone, Copy)]
pub struct FrameTimes {
    /// Recording the draws.
    pub recording: Duration,
    /// What the pass did.
    pub statistics: Statistics,
}

impl<'d> PreparedScene<'d> {
    /// Makes the scene's pipelines, buffers and a target of that size.
    ///
    /// # Errors
    /// [`BenchError`] when the size is beyond the device's limits.
    pub fn new(device: &'d Device, scene: &Scene, size: FrameSize) -> Result<Self, BenchError> {
        let pipelines = scene.pipelines.iter();
        let buffers = scene.buffers.iter();
        let buffers: Vec<Buffer> = buffers.map(|bytes| Buffer::from_bytes(bytes)).collect();
        let bind_group = scene.uniforms.map(|index| uniform_group(&buffers[index]));
        let draws = scene.draws.iter().map(|draw| PreparedDraw {
            draw: *draw,
            index_count: scene.index_count(draw),
        });
        let image = RenderTargetDescriptor::new(size.width, size.height);
        let resolved = RenderTargetDescriptor {
            depth: false,
            ..image.clone()
        };
        Ok(Self {
            device,
            pipelines: pipelines
                .map(|descriptor| device.create_render_pipeline(descriptor))
                .collect::<Result<_, _>>()?,
            buffers,
            bind_group,
            draws: draws.collect(),
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

    /// Draws a frame anew: nothing of the one before is used.
    pub fn draw(&mut self) -> FrameTimes {
        let start = Instant::now();
        let bindings = self.draws.iter().map(|PreparedDraw { draw, .. }| Bindings {
            groups: (self.bind_group.iter())
                .map(|group| (Arc::clone(group), draw.dynamic_offset))
                .collect(),
        });
        let bindings: Vec<Bindings> = bindings.collect();
        let draws = self.draws.iter().zip(&bindings);
        let recorded: Vec<Draw<'_>> = draws
            .map(|(PreparedDraw { draw, index_count }, bindings)| Draw {
                vertex_buffers: std::slice::from_ref(&self.buffers[draw.vertices]),
                indices: Some((&self.buffers[draw.indices], IndexFormat::Uint32)),
                instances: 0..draw.instances,
                bindings: Some(bindings),
                ..Draw::new(&self.pipelines[draw.pipeline], 0..*index_count)
            })
            .collect();
        let pass = RenderPass {
            clear_colors: Some(vec![CLEAR_COLOR]),
            clear_depth: Some(1.0),
            draws: &recorded,
        };
        let recording = start.elapsed();
        let statistics = self.device.render(&mut self.target, &pass);
        if let Some(resolved) = &mut self.resolved {
            self.device.resolve(&self.target, resolved);
        }
        FrameTimes {
            recording,
            statistics,
        }
    }

    /// The last frame's colours: RGBA8, row by row from the top.
    #[must_use]
    pub fn read_color(&self) -> Vec<u8> {
        self.resolved.as_ref().unwrap_or(&self.target).read_color(0)
    }

    /// The last frame's depths, row by row from the top.
    #[must_use]
    pub fn read_depth(&self) -> Vec<f32> {
        self.target.read_depth()
    }
}

/// The group of one uniform buffer that draws bind at their dynamic offset.
fn uniform_group(buffer: &Buffer) -> Arc<BindGroup> {
    let uniforms = Binding::Buffer {
        buffer: buffer.clone(),
        offset: 0,
        has_dynamic_offset: true,
    };
    Arc::new(BindGroup {
        entries: vec![(0, uniforms)],
    })
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
