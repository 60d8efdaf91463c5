//! Chooses the shader, vertex streams and fixed-function state of each surface.

use crate::geometry::vertex_data::{MeshStreams, VertexStream};
use crate::options::Shading;
use crate::shading::VertexTransforms;
use crate::shading::inspection::{DepthGrey, Normals, UvColors};
use crate::shading::lighting::{Gloss, Lights};
use crate::shading::phong::{PhongLight, ShadingMode};
use crate::shading::points_and_lines::PointsAndLines;
use crate::shading::surfaces::{Alpha, Painted, PlainPhong, PlainVertexLit, SurfaceLight};
use crate::shading::vertex_lit::{VertexLight, VertexShadingMode};
use crate::shading::wireframe::Wireframe;
use estampe::state::{
    BlendState, ColorTargetState, ColorWrites, CullMode, DepthState, MultisampleState,
    PrimitiveState, PrimitiveTopology,
};
use estampe::{
    Device, PipelineError, Program, RenderPipeline, RenderPipelineDescriptor, SampledTexture,
    Shader, ShaderProgram, TextureFormat,
};
use std::sync::Arc;

/// Options that all surfaces of a frame share.
#[derive(Debug, Clone)]
pub(crate) struct FrameStyle {
    pub(crate) shading: Shading,
    pub(crate) transforms: VertexTransforms,
    pub(crate) lights: Arc<Lights>,
    pub(crate) wireframe: Wireframe,
    /// Distances of the model's nearest and furthest point.
    pub(crate) depth_range: (f32, f32),
    pub(crate) cull: CullMode,
    pub(crate) samples: u32,
    pub(crate) format: TextureFormat,
}

/// A surface's material, prepared for shaders.
#[derive(Debug, Clone)]
pub(crate) struct SurfaceStyle {
    pub(crate) gloss: Gloss,
    /// Linear RGBA.
    pub(crate) base: [f32; 4],
    pub(crate) texture: Option<SampledTexture>,
    pub(crate) has_vertex_colors: bool,
    pub(crate) transparency: Transparency,
}

/// Treatment of a surface's alpha.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Transparency {
    /// Alpha is ignored.
    Opaque,
    /// Fragments below ½ are discarded.
    Masked,
    /// Blended, without writing depth.
    Blended,
}

/// Number of light steps in toon shading.
const TOON_LEVELS: u16 = 4;

/// A program with the vertex streams that it reads, by location.
struct MaterialProgram {
    program: Arc<dyn Program>,
    streams: Vec<VertexStream>,
}

impl MaterialProgram {
    fn new(shader: impl Shader, streams: &[VertexStream]) -> Self {
        Self {
            program: Arc::new(ShaderProgram::new(shader)),
            streams: streams.to_vec(),
        }
    }
}

/// A pipeline with the vertex streams of its draws, by location.
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
        let material = self.material_program(surface);
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
            material,
            mesh,
            PipelineState {
                primitive,
                depth,
                blend,
            },
        )
    }

    /// The pipeline of points or lines.
    pub(crate) fn points_and_lines(
        &self,
        device: &Device,
        shader: PointsAndLines,
        topology: PrimitiveTopology,
        mesh: &MeshStreams,
    ) -> Result<StreamPipeline, PipelineError> {
        let material = MaterialProgram::new(shader, &[VertexStream::Position, VertexStream::Color]);
        let primitive = PrimitiveState {
            topology,
            ..PrimitiveState::default()
        };
        let state = PipelineState {
            primitive,
            depth: DepthState::LESS_WRITE,
            blend: None,
        };
        self.pipeline(device, material, mesh, state)
    }

    /// True if surfaces behind a transparent surface are visible.
    pub(crate) fn shows_transparency(&self) -> bool {
        !self.shading.holds_numbers() && self.shading != Shading::Wireframe
    }

    /// True if each triangle needs separate vertices.
    pub(crate) fn needs_unshared_vertices(&self) -> bool {
        matches!(self.shading, Shading::Flat | Shading::Wireframe)
    }

    fn material_program(&self, surface: &SurfaceStyle) -> MaterialProgram {
        use VertexStream::{Corner, Normal, Position, Uv};
        let transforms = self.transforms;
        match self.shading {
            Shading::Phong => {
                self.painted_or_plain(surface, self.phong(surface, ShadingMode::Smooth))
            }
            Shading::Toon => {
                self.painted_or_plain(surface, self.phong(surface, ShadingMode::Toon(TOON_LEVELS)))
            }
            Shading::Gouraud => self.painted_or_plain(
                surface,
                self.vertex_lit(surface, VertexShadingMode::Gouraud),
            ),
            Shading::Flat => {
                self.painted_or_plain(surface, self.vertex_lit(surface, VertexShadingMode::Flat))
            }
            Shading::Unlit => {
                self.painted_or_plain(surface, self.vertex_lit(surface, VertexShadingMode::Unlit))
            }
            Shading::Wireframe => MaterialProgram::new(self.wireframe.clone(), &[Position, Corner]),
            Shading::Normals => MaterialProgram::new(Normals { transforms }, &[Position, Normal]),
            Shading::Depth => {
                let (nearest, furthest) = self.depth_range;
                MaterialProgram::new(
                    DepthGrey {
                        transforms,
                        nearest,
                        furthest,
                    },
                    &[Position],
                )
            }
            Shading::Uv => MaterialProgram::new(UvColors { transforms }, &[Position, Uv]),
        }
    }

    fn phong(&self, surface: &SurfaceStyle, mode: ShadingMode) -> SurfaceLight {
        let (transforms, gloss) = (self.transforms, surface.gloss);
        SurfaceLight::Fragments(PhongLight {
            transforms,
            lights: Arc::clone(&self.lights),
            gloss,
            mode,
        })
    }

    fn vertex_lit(&self, surface: &SurfaceStyle, mode: VertexShadingMode) -> SurfaceLight {
        let (transforms, gloss) = (self.transforms, surface.gloss);
        SurfaceLight::Vertices(VertexLight {
            transforms,
            lights: Arc::clone(&self.lights),
            gloss,
            mode,
        })
    }

    fn painted_or_plain(&self, surface: &SurfaceStyle, light: SurfaceLight) -> MaterialProgram {
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
            return MaterialProgram::new(shader, &[Position, Normal, Uv, Color]);
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
                MaterialProgram::new(PlainPhong { light, color }, &[Position, Normal])
            }
            SurfaceLight::Vertices(light) => {
                MaterialProgram::new(PlainVertexLit { light, color }, &[Position, Normal])
            }
        }
    }

    fn pipeline(
        &self,
        device: &Device,
        material: MaterialProgram,
        mesh: &MeshStreams,
        state: PipelineState,
    ) -> Result<StreamPipeline, PipelineError> {
        let layouts = material.streams.iter().enumerate();
        let layouts = layouts.map(|(location, &stream)| mesh.get(stream).layout(stream, location));
        let target = ColorTargetState {
            format: self.format,
            blend: state.blend,
            write_mask: ColorWrites::ALL,
        };
        let descriptor = RenderPipelineDescriptor {
            vertex_buffers: layouts.collect(),
            primitive: state.primitive,
            depth_stencil: Some(state.depth.into()),
            multisample: MultisampleState::new(self.samples),
            targets: vec![Some(target)],
            ..RenderPipelineDescriptor::with_program(material.program)
        };
        let pipeline = device.create_render_pipeline(&descriptor)?;
        Ok(StreamPipeline {
            pipeline,
            streams: material.streams,
        })
    }
}

/// The fixed-function state of a pipeline.
struct PipelineState {
    primitive: PrimitiveState,
    depth: DepthState,
    blend: Option<BlendState>,
}
