//! Chooses the shader, vertex streams and fixed-function state of each surface.

use crate::geometry::vertex_data::{MeshStreams, VertexStream};
use crate::options::Shading;
use crate::shading::VertexTransforms;
use crate::shading::base_color::{Alpha, BaseColor, Painted, Plain};
use crate::shading::bump::BumpMap;
use crate::shading::inspection::{DepthGrey, Normals, UvColors};
use crate::shading::interpolation::{AtFragments, AtVertices, Interpolation, Viewer};
use crate::shading::lighting::{Gloss, Lights};
use crate::shading::output::{Fog, Output};
use crate::shading::points_and_lines::PointsAndLines;
use crate::shading::surface::Surface;
use crate::shading::terms::{Reflectance, Terms};
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
    /// The levels of the options: steps of toon shading, else levels of colours.
    pub(crate) levels: Option<u16>,
    pub(crate) fog: Option<Fog>,
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
    pub(crate) bump: Option<BumpMap>,
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

/// Number of light steps in toon shading, unless the options say another one.
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
        self.shading.is_flat() || self.shading == Shading::Wireframe
    }

    /// True if flat light differs between the vertices of a face, unless it is computed at the
    /// face's middle.
    pub(crate) fn needs_face_centers(&self) -> bool {
        self.shading.is_flat() && !self.lights.positional.is_empty()
    }

    fn material_program(&self, surface: &SurfaceStyle) -> MaterialProgram {
        use VertexStream::{Corner, Normal, Position, Uv};
        let transforms = self.transforms;
        let toon = Terms::Toon(self.levels.unwrap_or(TOON_LEVELS));
        match self.shading {
            Shading::Phong => self.at_fragments(surface, Terms::All),
            Shading::Toon => self.at_fragments(surface, toon),
            Shading::ToonFlat => self.at_vertices(surface, toon, Viewer::Infinity),
            Shading::ToonGouraud => self.at_vertices(surface, toon, Viewer::Eye),
            Shading::Gouraud => self.at_vertices(surface, Terms::All, Viewer::Eye),
            Shading::Flat => self.at_vertices(surface, Terms::All, Viewer::Infinity),
            Shading::Unlit => self.at_vertices(surface, Terms::Unlit, Viewer::Infinity),
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

    fn at_fragments(&self, surface: &SurfaceStyle, terms: Terms) -> MaterialProgram {
        let interpolation = AtFragments {
            transforms: self.transforms,
            reflectance: self.reflectance(surface, terms),
        };
        self.painted_or_plain(surface, interpolation, &[VertexStream::Normal])
    }

    fn at_vertices(&self, surface: &SurfaceStyle, terms: Terms, viewer: Viewer) -> MaterialProgram {
        let interpolation = AtVertices {
            transforms: self.transforms,
            reflectance: self.reflectance(surface, terms),
            viewer,
        };
        let streams = [VertexStream::Normal, VertexStream::LitAt];
        self.painted_or_plain(surface, interpolation, &streams)
    }

    fn reflectance(&self, surface: &SurfaceStyle, terms: Terms) -> Reflectance {
        Reflectance {
            lights: Arc::clone(&self.lights),
            gloss: surface.gloss,
            terms,
        }
    }

    fn painted_or_plain(
        &self,
        surface: &SurfaceStyle,
        interpolation: impl Interpolation,
        streams: &[VertexStream],
    ) -> MaterialProgram {
        let (factor, texture, bump) = (surface.base, surface.texture.clone(), surface.bump.clone());
        let alpha = match surface.transparency {
            Transparency::Opaque => Alpha::Ignored,
            Transparency::Masked => Alpha::CutsOut,
            Transparency::Blended => Alpha::Kept,
        };
        let has_colors = texture.is_some() || surface.has_vertex_colors;
        if has_colors || bump.is_some() || alpha == Alpha::CutsOut {
            let painted = Painted {
                factor,
                texture,
                bump,
                alpha,
            };
            let of_color = [VertexStream::Uv, VertexStream::Color];
            return self.composed(painted, interpolation, &[streams, &of_color].concat());
        }
        let [r, g, b, opacity] = factor;
        let opacity = if alpha == Alpha::Ignored {
            1.0
        } else {
            opacity
        };
        self.composed(Plain([r, g, b, opacity]), interpolation, streams)
    }

    /// The surface of these parts, which read these streams after the position.
    fn composed(
        &self,
        base_color: impl BaseColor,
        interpolation: impl Interpolation,
        streams: &[VertexStream],
    ) -> MaterialProgram {
        let output = Output {
            levels: self.levels.filter(|_| !self.shading.is_toon()),
            fog: self.fog,
        };
        let surface = Surface {
            base_color,
            interpolation,
            output,
        };
        MaterialProgram::new(surface, &[&[VertexStream::Position], streams].concat())
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
