//! Which shader and state a surface is drawn with: the one place that puts looks, base colours and
//! vertex streams together.

use crate::geometry::vertex_data::{MeshStreams, VertexStream};
use crate::options::Shading;
use crate::shading::VertexTransforms;
use crate::shading::inspection::{DepthGrey, Normals, UvColors};
use crate::shading::lighting::{Gloss, LightRig};
use crate::shading::marks::Marks;
use crate::shading::phong::{PhongLight, Tone};
use crate::shading::surfaces::{Alpha, Painted, PlainPhong, PlainVertexLit, SurfaceLight};
use crate::shading::vertex_lit::{VertexLight, VertexTone};
use crate::shading::wireframe::Wireframe;
use estampe::shader::{FragmentBatch, Interface, VertexBatch};
use estampe::state::{
    BlendState, ColorTargetState, ColorWrites, CullMode, DepthState, PrimitiveState,
    PrimitiveTopology,
};
use estampe::texture::Sampled;
use estampe::{
    Bindings, Device, Level, PipelineError, Program, RenderPipeline, RenderPipelineDescriptor,
    Shader, ShaderProgram, TextureFormat,
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

/// Steps of light in toon shading (row F3).
const TOON_LEVELS: u16 = 4;

/// A program, and the streams that it reads, by location.
struct Look {
    program: Arc<dyn Program>,
    streams: Vec<VertexStream>,
}

impl Look {
    fn new(shader: impl Shader, streams: &[VertexStream]) -> Self {
        Self {
            program: Arc::new(ShaderProgram::new(shader)),
            streams: streams.to_vec(),
        }
    }
}

impl Look {
    /// The same for a shader that discards nothing with these uniforms, so that depth can be tested
    /// before it runs.
    fn without_discarding(self) -> Self {
        let interface = Interface {
            discards: false,
            ..self.program.interface().clone()
        };
        let program = Arc::new(NotDiscarding {
            program: self.program,
            interface,
        });
        Self { program, ..self }
    }
}

/// A program that keeps every fragment, whatever its type says.
#[derive(Debug)]
struct NotDiscarding {
    program: Arc<dyn Program>,
    interface: Interface,
}

impl Program for NotDiscarding {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn run_vertices(&self, level: Level, bindings: &Bindings, batch: VertexBatch<'_>) {
        self.program.run_vertices(level, bindings, batch);
    }

    fn run_fragments(&self, level: Level, bindings: &Bindings, batch: FragmentBatch<'_>) {
        self.program.run_fragments(level, bindings, batch);
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
        let primitive = PrimitiveState {
            cull_mode: self.cull,
            ..PrimitiveState::default()
        };
        let (depth, blend) = if is_blended {
            (DepthState::LESS_READ, Some(BlendState::ALPHA_BLENDING))
        } else {
            (DepthState::LESS_WRITE, None)
        };
        self.pipeline(
            device,
            look,
            mesh,
            PipelineState {
                primitive,
                depth,
                blend,
            },
        )
    }

    /// The pipeline of points or lines.
    pub(crate) fn marks(
        &self,
        device: &Device,
        marks: Marks,
        topology: PrimitiveTopology,
        mesh: &MeshStreams,
    ) -> Result<StreamPipeline, PipelineError> {
        let look = Look::new(marks, &[VertexStream::Position, VertexStream::Color]);
        let primitive = PrimitiveState {
            topology,
            ..PrimitiveState::default()
        };
        let state = PipelineState {
            primitive,
            depth: DepthState::LESS_WRITE,
            blend: None,
        };
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
        use VertexStream::{Corner, Normal, Position, Uv};
        let transforms = self.transforms;
        match self.shading {
            Shading::Phong => self.painted_or_plain(surface, self.phong(surface, Tone::Smooth)),
            Shading::Toon => {
                self.painted_or_plain(surface, self.phong(surface, Tone::Toon(TOON_LEVELS)))
            }
            Shading::Gouraud => {
                self.painted_or_plain(surface, self.vertex_lit(surface, VertexTone::Gouraud))
            }
            Shading::Flat => {
                self.painted_or_plain(surface, self.vertex_lit(surface, VertexTone::Flat))
            }
            Shading::Unlit => {
                self.painted_or_plain(surface, self.vertex_lit(surface, VertexTone::Unlit))
            }
            Shading::Wireframe => Look::new(self.wireframe.clone(), &[Position, Corner]),
            Shading::Normals => Look::new(Normals { transforms }, &[Position, Normal]),
            Shading::Depth => {
                let (nearest, furthest) = self.depth_range;
                Look::new(
                    DepthGrey {
                        transforms,
                        nearest,
                        furthest,
                    },
                    &[Position],
                )
            }
            Shading::Uv => Look::new(UvColors { transforms }, &[Position, Uv]),
        }
    }

    fn phong(&self, surface: &SurfaceStyle, tone: Tone) -> SurfaceLight {
        let (transforms, gloss) = (self.transforms, surface.gloss);
        SurfaceLight::Fragments(PhongLight {
            transforms,
            rig: Arc::clone(&self.rig),
            gloss,
            tone,
        })
    }

    fn vertex_lit(&self, surface: &SurfaceStyle, tone: VertexTone) -> SurfaceLight {
        let (transforms, gloss) = (self.transforms, surface.gloss);
        SurfaceLight::Vertices(VertexLight {
            transforms,
            rig: Arc::clone(&self.rig),
            gloss,
            tone,
        })
    }

    fn painted_or_plain(&self, surface: &SurfaceStyle, light: SurfaceLight) -> Look {
        use VertexStream::{Color, Normal, Position, Uv};
        let (factor, texture) = (surface.base, surface.texture.clone());
        let alpha = match surface.transparency {
            Transparency::Opaque => Alpha::Ignored,
            Transparency::Masked => Alpha::CutsOut,
            Transparency::Blended => Alpha::Kept,
        };
        if texture.is_some() || surface.has_vertex_colors || alpha == Alpha::CutsOut {
            let shader = Painted {
                light,
                factor,
                texture,
                alpha,
            };
            let look = Look::new(shader, &[Position, Normal, Uv, Color]);
            return if alpha == Alpha::CutsOut {
                look
            } else {
                look.without_discarding()
            };
        }
        let [r, g, b, opacity] = factor;
        let color = [
            r,
            g,
            b,
            if alpha == Alpha::Ignored {
                1.0
            } else {
                opacity
            },
        ];
        match light {
            SurfaceLight::Fragments(light) => {
                Look::new(PlainPhong { light, color }, &[Position, Normal])
            }
            SurfaceLight::Vertices(light) => {
                Look::new(PlainVertexLit { light, color }, &[Position, Normal])
            }
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
            vertex_buffers: layouts.collect(),
            primitive: state.primitive,
            depth: Some(state.depth),
            samples: self.samples,
            targets: vec![target],
            ..RenderPipelineDescriptor::with_program(look.program)
        };
        let pipeline = device.create_render_pipeline(&descriptor)?;
        Ok(StreamPipeline {
            pipeline,
            streams: look.streams,
        })
    }
}

/// The fixed-function state of a pipeline.
struct PipelineState {
    primitive: PrimitiveState,
    depth: DepthState,
    blend: Option<BlendState>,
}
