//! The pipelines of each surface: its shader, vertex streams and fixed-function state.

use crate::behind::{BehindPicture, LIGHT};
use crate::geometry::vertex_data::{MeshStreams, VertexStream};
use crate::ground::ColumnMaps;
use crate::light::FrameOutput;
use crate::material_programs::MaterialProgram;
use crate::options::Shading;
use crate::render_error::RenderError;
use crate::shading::VertexTransforms;
use crate::shading::backdrop::Backdrop;
use crate::shading::bump::BumpMap;
use crate::shading::lighting::{Gloss, Lights};
use crate::shading::output::{Fog, Presentation};
use crate::shading::pbr::parameters::PbrParameters;
use crate::shading::pbr::surface::PbrLighting;
use crate::shading::points_and_lines::PointsAndLines;
use crate::shading::surface::DEPTH_ORDER;
use crate::shading::wireframe::Wireframe;
use crate::shadows::ShadowMaps;
use crate::surface_program::{SurfaceProgram, SurfaceValues};
use estampe::state::{
    BlendState, ColorTargetState, ColorWrites, CompareFunction, CullMode, DepthState,
    DepthStencilState, LineRasterization, MultisampleState, PrimitiveState, PrimitiveTopology,
};
use estampe::{
    BindGroup, BindGroupLayout, Device, PipelineError, RenderPipeline, RenderPipelineDescriptor,
    SampledTexture, TextureFormat,
};
use estampe_transparency::{Finder, TransparencyError, layer_state, weighted_targets};
use std::sync::Arc;

/// Options that all surfaces of a frame share.
#[derive(Debug, Clone)]
pub(crate) struct FrameStyle {
    pub(crate) shading: Shading,
    /// The program of surfaces, in place of the shading's, and what it may want to know.
    pub(crate) program: Option<(SurfaceProgram, SurfaceValues)>,
    pub(crate) transforms: VertexTransforms,
    pub(crate) lights: Arc<Lights>,
    /// The light of physically based surfaces.
    pub(crate) pbr: Option<Arc<PbrLighting>>,
    /// The levels of the options: steps of toon shading, else levels of colours.
    pub(crate) levels: Option<u16>,
    /// The gradient behind everything.
    pub(crate) backdrop: Option<Backdrop>,
    pub(crate) fog: Option<Fog>,
    /// What the default lights add to lit colours.
    pub(crate) presentation: Option<Presentation>,
    pub(crate) wireframe: Wireframe,
    /// The edges over shaded surfaces, if they are drawn.
    pub(crate) overlay: Option<Wireframe>,
    /// Distances of the model's nearest and furthest point.
    pub(crate) depth_range: (f32, f32),
    pub(crate) cull: CullMode,
    pub(crate) samples: u32,
    pub(crate) format: TextureFormat,
    /// What the picture's pixels hold.
    pub(crate) frame_output: FrameOutput,
    /// The maps by which surfaces are in shadow.
    pub(crate) shadows: Option<ShadowMaps>,
    /// What is seen through surfaces, if light passes through some.
    pub(crate) behind: Option<BehindPicture>,
    /// The heights of the model above the ground, if it stands on one.
    pub(crate) columns: Option<ColumnMaps>,
    /// Makes the pipelines that find layers of transparent surfaces.
    pub(crate) finder: Finder,
}

/// The pass that a surface is drawn in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Role {
    /// Replaces colours and writes depths.
    Opaque,
    /// Blended in the order of the draws.
    Blended,
    /// Blended where it is the layer that was found.
    Layer,
    /// Added to weighted sums.
    Weighted,
    /// As opaque, in the picture of what is behind surfaces that transmit light.
    Behind,
    /// Depths in the map of this slot: those of lights, then those of the ground.
    Caster(usize),
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
    pub(crate) alpha: SurfaceAlpha,
    /// The parameters of a physically based surface, if it is drawn as one.
    pub(crate) pbr: Option<Arc<PbrParameters>>,
    /// Back faces are not drawn.
    pub(crate) is_single_sided: bool,
}

impl SurfaceStyle {
    /// True if light passes through the surface.
    pub(crate) fn transmits(&self) -> bool {
        let parameters = self.pbr.as_ref();
        parameters.is_some_and(|parameters| parameters.transmission.is_some())
    }
}

/// Treatment of a surface's alpha.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum SurfaceAlpha {
    /// Alpha is ignored.
    Opaque,
    /// Fragments below a cutoff are cut out.
    Masked,
    /// Blended, without writing depth.
    Blended,
}

/// A pipeline with the vertex streams of its draws, by location.
#[derive(Debug)]
pub(crate) struct StreamPipeline {
    pub(crate) pipeline: RenderPipeline,
    pub(crate) streams: Vec<VertexStream>,
    /// What the program binds, by group number.
    pub(crate) bind_groups: Vec<BindGroup>,
}

impl FrameStyle {
    /// The pipeline of a surface.
    pub(crate) fn surface(
        &self,
        device: &Device,
        surface: &SurfaceStyle,
        mesh: &MeshStreams,
        role: Role,
    ) -> Result<StreamPipeline, RenderError> {
        if let Some((program, values)) = &self.program {
            return self.surface_of_program(device, (program, values), surface, mesh);
        }
        if let Role::Caster(slot) = role {
            let clip_from_unit = self.clip_of_caster(slot);
            return Ok(self.caster(device, surface, mesh, clip_from_unit)?);
        }
        let material = self.material_program(surface, role);
        let over = || self.targets(Some(BlendState::ALPHA_BLENDING));
        let (depth_stencil, targets) = match role {
            Role::Opaque | Role::Caster(_) => self.opaque(),
            Role::Blended => (DEPTH_ORDER.nearer().into(), over()),
            Role::Layer => (layer_state(), over()),
            Role::Weighted => (DEPTH_ORDER.nearer().into(), weighted_targets()),
            Role::Behind => (DepthState::LESS_WRITE.into(), light_target(None)),
        };
        let state = PipelineState {
            primitive: self.triangles_of(surface),
            depth_stencil,
            targets,
            samples: self.samples,
            shadows: self.shadows.as_ref(),
            behind: self.behind.as_ref().filter(|_| surface.transmits()),
        };
        Ok(self.pipeline(device, material, mesh, state)?)
    }

    /// The pipeline of a surface that the caller's program draws.
    fn surface_of_program(
        &self,
        device: &Device,
        (program, values): (&SurfaceProgram, &SurfaceValues),
        surface: &SurfaceStyle,
        mesh: &MeshStreams,
    ) -> Result<StreamPipeline, RenderError> {
        use VertexStream::{Color, Normal, Position, Uv};
        let read = program.program.interface().attributes.len();
        let streams = [Position, Normal, Uv, Color];
        let material = MaterialProgram {
            program: Arc::clone(&program.program),
            streams: streams[..read.min(streams.len())].to_vec(),
        };
        let (depth_stencil, targets) = self.opaque();
        let state = PipelineState {
            primitive: self.triangles(),
            depth_stencil,
            targets,
            samples: self.samples,
            shadows: None,
            behind: None,
        };
        let values = SurfaceValues {
            base_color: surface.base,
            ..*values
        };
        let bind_groups = program.bindings.bind_groups(device, &values);
        Ok(StreamPipeline {
            bind_groups: bind_groups.map_err(RenderError::Bindings)?,
            ..self.pipeline(device, material, mesh, state)?
        })
    }

    /// The pipeline that finds layers of a surface.
    pub(crate) fn finding(
        &self,
        device: &Device,
        mesh: &MeshStreams,
    ) -> Result<StreamPipeline, TransparencyError> {
        let layout = mesh.positions.layout(VertexStream::Position, 0);
        let pipeline = self.finder.pipeline(
            device,
            self.transforms.clip_from_unit,
            vec![layout],
            self.triangles(),
        )?;
        Ok(StreamPipeline {
            pipeline,
            streams: vec![VertexStream::Position],
            bind_groups: Vec::new(),
        })
    }

    /// The pipeline of edges over surfaces: their depths are those of the surfaces, bit by bit.
    pub(crate) fn edges(
        &self,
        device: &Device,
        edges: &Wireframe,
        mesh: &MeshStreams,
    ) -> Result<StreamPipeline, PipelineError> {
        let streams = [VertexStream::Position, VertexStream::Corner];
        let material = MaterialProgram::new(edges.clone(), &streams);
        let depth = DepthState {
            write_enabled: false,
            compare: CompareFunction::LessEqual,
        };
        let state = PipelineState {
            primitive: self.triangles(),
            depth_stencil: depth.into(),
            targets: self.targets(Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING)),
            samples: self.samples,
            shadows: None,
            behind: None,
        };
        self.pipeline(device, material, mesh, state)
    }

    /// State and targets of what hides what is behind it; fragments that are counted hide nothing.
    fn opaque(&self) -> (DepthStencilState, Vec<Option<ColorTargetState>>) {
        if self.shading == Shading::Overdraw {
            let sum = self.targets(Some(BlendState::ADDITIVE));
            return (DepthStencilState::default(), sum);
        }
        (DepthState::LESS_WRITE.into(), self.targets(None))
    }

    /// The triangles of a surface, whose back faces may be invisible.
    fn triangles_of(&self, surface: &SurfaceStyle) -> PrimitiveState {
        let triangles = self.triangles();
        PrimitiveState {
            cull_mode: match self.cull {
                CullMode::None if surface.is_single_sided => CullMode::Back,
                chosen => chosen,
            },
            ..triangles
        }
    }

    fn triangles(&self) -> PrimitiveState {
        PrimitiveState {
            cull_mode: self.cull,
            ..PrimitiveState::default()
        }
    }

    /// The target of the picture.
    pub(crate) fn targets(&self, blend: Option<BlendState>) -> Vec<Option<ColorTargetState>> {
        vec![Some(ColorTargetState {
            format: self.format,
            blend,
            write_mask: ColorWrites::ALL,
        })]
    }

    /// The pipeline of points or lines.
    pub(crate) fn points_and_lines(
        &self,
        device: &Device,
        shader: PointsAndLines,
        (primitive, role): (PrimitiveState, Role),
        mesh: &MeshStreams,
    ) -> Result<StreamPipeline, PipelineError> {
        let material = MaterialProgram::new(shader, &[VertexStream::Position, VertexStream::Color]);
        let blend = is_smooth(&primitive).then_some(BlendState::ALPHA_BLENDING);
        let (depth_stencil, targets) = match (role, blend) {
            (Role::Behind, _) => (DepthState::LESS_WRITE.into(), light_target(blend)),
            (_, Some(_)) => (self.opaque().0, self.targets(blend)),
            _ => self.opaque(),
        };
        let state = PipelineState {
            primitive,
            depth_stencil,
            targets,
            samples: self.samples,
            shadows: None,
            behind: None,
        };
        self.pipeline(device, material, mesh, state)
    }

    /// True if surfaces behind a transparent surface are visible.
    pub(crate) fn shows_transparency(&self) -> bool {
        let is_solid = self.shading.holds_numbers() || self.shading == Shading::Wireframe;
        self.program.is_none() && !is_solid
    }

    /// True if each triangle needs separate vertices.
    pub(crate) fn needs_unshared_vertices(&self) -> bool {
        matches!(
            self.shading,
            Shading::Flat
                | Shading::ToonFlat
                | Shading::Wireframe
                | Shading::FaceId
                | Shading::Barycentric
        )
    }

    /// True if flat light differs between the vertices of a face, unless it is computed at the
    /// face's middle.
    pub(crate) fn needs_face_centers(&self) -> bool {
        self.shading.is_flat() && !self.lights.positional.is_empty()
    }

    pub(crate) fn pipeline(
        &self,
        device: &Device,
        material: MaterialProgram,
        mesh: &MeshStreams,
        state: PipelineState<'_>,
    ) -> Result<StreamPipeline, PipelineError> {
        let layouts = material.streams.iter().enumerate();
        let layouts = layouts.map(|(location, &stream)| mesh.get(stream).layout(stream, location));
        let mut descriptor = RenderPipelineDescriptor {
            vertex_buffers: layouts.collect(),
            primitive: state.primitive,
            depth_stencil: Some(state.depth_stencil),
            multisample: MultisampleState::new(state.samples),
            targets: state.targets.clone(),
            ..RenderPipelineDescriptor::with_program(material.program)
        };
        let groups = state.groups();
        let layouts = groups.iter().map(|(layout, _)| (*layout).clone());
        if !groups.is_empty() {
            descriptor.bind_group_layouts = layouts.collect();
        }
        let pipeline = device.create_render_pipeline(&descriptor)?;
        Ok(StreamPipeline {
            pipeline,
            streams: material.streams,
            bind_groups: groups.iter().map(|(_, group)| (*group).clone()).collect(),
        })
    }
}

/// The state of a pipeline.
pub(crate) struct PipelineState<'a> {
    pub(crate) primitive: PrimitiveState,
    pub(crate) depth_stencil: DepthStencilState,
    pub(crate) targets: Vec<Option<ColorTargetState>>,
    pub(crate) samples: u32,
    /// The maps that its shader looks up.
    pub(crate) shadows: Option<&'a ShadowMaps>,
    /// The picture that its shader looks up, if light passes through the surface.
    pub(crate) behind: Option<&'a BehindPicture>,
}

impl PipelineState<'_> {
    /// The bind groups with their layouts, by number.
    fn groups(&self) -> Vec<(&BindGroupLayout, &BindGroup)> {
        let maps = self.shadows.map(|maps| (&maps.layout, &maps.group));
        match self.behind {
            Some(behind) => vec![
                maps.unwrap_or((&behind.empty.0, &behind.empty.1)),
                (&behind.layout, &behind.group),
            ],
            None => maps.into_iter().collect(),
        }
    }
}

/// The target of the picture of what is behind surfaces.
pub(crate) fn light_target(blend: Option<BlendState>) -> Vec<Option<ColorTargetState>> {
    vec![Some(ColorTargetState {
        blend,
        ..LIGHT.into()
    })]
}

/// True if primitives are lines with smooth borders, which are blended.
pub(crate) fn is_smooth(primitive: &PrimitiveState) -> bool {
    primitive.topology == PrimitiveTopology::LineList
        && primitive.line.rasterization == LineRasterization::RectangularSmooth
}
