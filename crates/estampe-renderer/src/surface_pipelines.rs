//! Which shader and state a surface is drawn with: the one place that puts looks, base colours and
//! vertex streams together.

use crate::geometry::vertex_data::{MeshStreams, VertexStream};
use crate::options::Shading;
use crate::shading::VertexTransforms;
use crate::shading::base_color::{BaseColor, OneColor, Painted};
use crate::shading::inspection::{DepthGrey, Normals, UvColors};
use crate::shading::lighting::{Gloss, LightRig};
use crate::shading::marks::Marks;
use crate::shading::phong::{Phong, Tone};
use crate::shading::unlit::Unlit;
use crate::shading::vertex_lit::{FlatFaces, Gouraud, VertexLighting};
use crate::shading::wireframe::Wireframe;
use estampe::state::{
    BlendState, ColorTargetState, ColorWrites, CullMode, DepthState, PrimitiveState,
    PrimitiveTopology,
};
use estampe::texture::Sampled;
use estampe::{
    Device, PipelineError, Program, RenderPipeline, RenderPipelineDescriptor, Shader,
    ShaderProgram, TextureFormat,
};
use std::sync::Arc;

/// What is the same for all surfaces of a frame.
#[derive(Debug, Clone)]
pub(crate) struct FrameStyle {
    pub(crate) shading: Shading,
    pub(crate) transforms: VertexTransforms,
    pub(crate) rig: Arc<LightRig>,
    pub(crate) wireframe: Wireframe,
    /// Distances of the nearest and the furthest point.
    pub(crate) depth_range: (f32, f32),
    pub(crate) cull: CullMode,
    pub(crate) samples: u32,
    pub(crate) format: TextureFormat,
}

/// A surface's material, ready for shaders.
#[derive(Debug, Clone)]
pub(crate) struct SurfaceStyle {
    pub(crate) gloss: Gloss,
    /// Linear RGBA.
    pub(crate) base: [f32; 4],
    pub(crate) texture: Option<Sampled>,
    pub(crate) has_vertex_colors: bool,
    pub(crate) transparency: Transparency,
}

/// What becomes of alpha.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Transparency {
    /// Nothing.
    Opaque,
    /// Fragments below ½ are discarded.
    Masked,
    /// It is blended, without writing depth.
    Blended,
}

/// A program, and the streams that it reads, by location.
struct Look {
    program: Arc<dyn Program>,
    streams: Vec<VertexStream>,
}

impl Look {
    fn new(shader: impl Shader, own: &[VertexStream], base: &[VertexStream]) -> Self {
        Self { program: Arc::new(ShaderProgram::new(shader)), streams: [own, base].concat() }
    }
}

/// A pipeline, and the streams that its draws bring, in order.
#[derive(Debug)]
pub(crate) struct StreamPipeline {
    pub(crate) pipeline: RenderPipeline,
    pub(crate) streams: Vec<VertexStream>,
}

impl FrameStyle {
    /// The pipeline of a surface.
    pub(crate) fn surface(
        &self,
        device: &Device,
        surface: &SurfaceStyle,
        mesh: &MeshStreams,
    ) -> Result<StreamPipeline, PipelineError> {
        let look = self.look(surface);
        let is_blended = surface.transparency == Transparency::Blended && self.shows_transparency();
        let primitive = PrimitiveState { cull_mode: self.cull, ..PrimitiveState::default() };
        let (depth, blend) = if is_blended {
            (DepthState::LESS_READ, Some(BlendState::ALPHA_BLENDING))
        } else {
            (DepthState::LESS_WRITE, None)
        };
        self.pipeline(device, look, mesh, PipelineState { primitive, depth, blend })
    }

    /// The pipeline of points or lines.
    pub(crate) fn marks(
        &self,
        device: &Device,
        marks: Marks,
        topology: PrimitiveTopology,
        mesh: &MeshStreams,
    ) -> Result<StreamPipeline, PipelineError> {
        let look = Look::new(marks, &[VertexStream::Position, VertexStream::Color], &[]);
        let primitive = PrimitiveState { topology, ..PrimitiveState::default() };
        let state = PipelineState { primitive, depth: DepthState::LESS_WRITE, blend: None };
        self.pipeline(device, look, mesh, state)
    }

    /// Whether transparent surfaces let through what lies behind them.
    pub(crate) fn shows_transparency(&self) -> bool {
        !self.shading.holds_numbers() && self.shading != Shading::Wireframe
    }

    /// Whether each triangle has vertices of its own.
    pub(crate) fn needs_unshared_vertices(&self) -> bool {
        matches!(self.shading, Shading::Flat | Shading::Wireframe)
    }

    fn look(&self, surface: &SurfaceStyle) -> Look {
        let (factor, texture) = (surface.base, surface.texture.clone());
        let is_opaque = surface.transparency == Transparency::Opaque;
        match surface.transparency {
            Transparency::Masked => {
                let base = Painted::<true> { factor, texture, is_opaque: false };
                self.look_over(surface.gloss, base)
            }
            _ if texture.is_some() || surface.has_vertex_colors => {
                self.look_over(surface.gloss, Painted::<false> { factor, texture, is_opaque })
            }
            _ => {
                let alpha = if is_opaque { 1.0 } else { factor[3] };
                let [r, g, b, _] = factor;
                self.look_over(surface.gloss, OneColor([r, g, b, alpha]))
            }
        }
    }

    fn look_over<B: BaseColor>(&self, gloss: Gloss, base: B) -> Look {
        use VertexStream::{Corner, Normal, Position, Uv};
        let transforms = self.transforms;
        let rig = Arc::clone(&self.rig);
        let lighting = || VertexLighting { transforms, rig: Arc::clone(&self.rig), gloss };
        let lit = &[Position, Normal];
        match self.shading {
            Shading::Phong => {
                let tone = Tone::Smooth;
                Look::new(Phong { transforms, rig, gloss, tone, base }, lit, B::STREAMS)
            }
            Shading::Toon => {
                const LEVELS: u16 = 4;
                let tone = Tone::Toon(LEVELS);
                Look::new(Phong { transforms, rig, gloss, tone, base }, lit, B::STREAMS)
            }
            Shading::Gouraud => Look::new(Gouraud { lighting: lighting(), base }, lit, B::STREAMS),
            Shading::Flat => Look::new(FlatFaces { lighting: lighting(), base }, lit, B::STREAMS),
            Shading::Unlit => {
                let emissive = gloss.emissive;
                Look::new(Unlit { transforms, emissive, base }, &[Position], B::STREAMS)
            }
            Shading::Wireframe => Look::new(self.wireframe.clone(), &[Position, Corner], &[]),
            Shading::Normals => Look::new(Normals { transforms }, lit, &[]),
            Shading::Depth => {
                let (nearest, furthest) = self.depth_range;
                Look::new(DepthGrey { transforms, nearest, furthest }, &[Position], &[])
            }
            Shading::Uv => Look::new(UvColors { transforms }, &[Position, Uv], &[]),
        }
    }

    fn pipeline(
        &self,
        device: &Device,
        look: Look,
        mesh: &MeshStreams,
        state: PipelineState,
    ) -> Result<StreamPipeline, PipelineError> {
        let layouts = look.streams.iter().enumerate();
        let layouts = layouts.map(|(location, &stream)| mesh.get(stream).layout(stream, location));
        let target = ColorTargetState {
            format: self.format,
            blend: state.blend,
            write_mask: ColorWrites::ALL,
        };
        let descriptor = RenderPipelineDescriptor {
            program: look.program,
            vertex_buffers: layouts.collect(),
            primitive: state.primitive,
            depth: Some(state.depth),
            samples: self.samples,
            targets: vec![target],
        };
        let pipeline = device.create_render_pipeline(&descriptor)?;
        Ok(StreamPipeline { pipeline, streams: look.streams })
    }
}

/// The fixed-function state of a pipeline.
struct PipelineState {
    primitive: PrimitiveState,
    depth: DepthState,
    blend: Option<BlendState>,
}
