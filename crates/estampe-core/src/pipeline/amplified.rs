//! Pipelines with tessellation or a geometry shader: the two pipelines that they consist of, and
//! the rules between their stages.

use super::{Inner, PipelineError, RenderPipeline, RenderPipelineDescriptor};
use estampe_simd::{Level, Packet};
use estampe_types::shader::{
    GeometryPrimitive, GeometryProgram, GeometryTopology, OutputInterface, TessellationProgram,
};
use estampe_types::state::{
    MAX_PATCH_POINTS, PrimitiveState, PrimitiveTopology, TessellationDomain, TessellationMode,
    VertexAttribute, VertexBufferLayout,
};
use estampe_types::{
    Bindings, FragmentBatch, Interface, Limits, Program, VertexBatch, VertexFormat,
};
use std::sync::Arc;

/// The tessellation stage of a pipeline.
#[derive(Debug, Clone)]
pub struct TessellationState {
    /// The tessellation shader.
    pub program: Arc<dyn TessellationProgram>,
    /// Vertices of a patch, 1 to 32.
    pub patch_points: u32,
    /// Domain, spacing, winding and point mode.
    pub mode: TessellationMode,
}

/// Scalars of a control point, and of the values of a patch, at most.
const MAX_PATCH_SCALARS: usize = 128;

/// The stages of an amplified pipeline.
#[derive(Debug)]
pub(crate) struct Amplified {
    /// Shades the vertices of patches and primitives.
    pub(crate) vertex: RenderPipeline,
    /// Draws the finished vertices.
    pub(crate) rasterized: RenderPipeline,
    input_corners: usize,
}

impl Amplified {
    /// Vertices of a patch or primitive that the first of the stages reads; at least 1.
    pub(crate) fn input_corners(&self) -> usize {
        self.input_corners
    }

    /// Checks the stages of a descriptor, and makes the pipelines; `None` if it has none of them.
    pub(super) fn new(
        descriptor: &RenderPipelineDescriptor,
        limits: &Limits,
    ) -> Result<Option<Self>, PipelineError> {
        let topology = descriptor.primitive.topology;
        let is_patches = topology == PrimitiveTopology::PatchList;
        if is_patches != descriptor.tessellation.is_some() {
            return Err(PipelineError::PatchTopology { topology });
        }
        let first = descriptor.vertex_program.as_ref();
        if descriptor.tessellation.is_none() && descriptor.geometry.is_none() {
            return match first {
                Some(_) => Err(PipelineError::VertexProgramUnused),
                None => Ok(None),
            };
        }
        let first = first.unwrap_or(&descriptor.program);
        first.validate()?;
        super::check_interface(first.interface(), limits)?;
        let mut stage = ("vertex shader", first.interface().varyings.len());
        let mut output = None;
        let mut input_corners = 1;
        let mut kind = Vertices::of_topology(topology);
        if let Some(state) = &descriptor.tessellation {
            check_tessellation(state, stage)?;
            input_corners = state.patch_points as usize;
            let made = &state.program.interface().output;
            stage = ("tessellation shader", made.varyings.len());
            output = Some((made, made.record_words()));
            kind = Vertices::of_tessellation(&state.mode);
        }
        if let Some(program) = descriptor.geometry.as_deref() {
            check_geometry(program, stage, kind, descriptor.tessellation.is_some())?;
            let interface = program.interface();
            if descriptor.tessellation.is_none() {
                input_corners = interface.primitive.vertices();
            }
            stage = ("geometry shader", interface.output.varyings.len());
            output = Some((&interface.output, interface.record_words()));
            kind = Vertices::Exactly(match interface.topology {
                GeometryTopology::PointList => GeometryPrimitive::Points,
                GeometryTopology::LineStrip => GeometryPrimitive::Lines,
                GeometryTopology::TriangleStrip => GeometryPrimitive::Triangles,
            });
        }
        check_scalars(
            stage,
            (
                "fragment shader",
                descriptor.program.interface().varyings.len(),
            ),
        )?;
        let Some((output, words)) = output else {
            return Ok(None);
        };
        Ok(Some(Self {
            vertex: vertex_pipeline(descriptor, first, limits)?,
            rasterized: rasterized_pipeline(descriptor, output, words, kind.list())?,
            input_corners,
        }))
    }
}

/// The primitives that a stage passes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Vertices {
    Exactly(GeometryPrimitive),
    Patches,
}

impl Vertices {
    fn of_topology(topology: PrimitiveTopology) -> Self {
        use PrimitiveTopology as T;
        Self::Exactly(match topology {
            T::PointList => GeometryPrimitive::Points,
            T::LineList | T::LineStrip | T::LineLoop => GeometryPrimitive::Lines,
            T::TriangleList | T::TriangleStrip | T::TriangleFan => GeometryPrimitive::Triangles,
            T::LineListAdjacency | T::LineStripAdjacency => GeometryPrimitive::LinesAdjacency,
            T::TriangleListAdjacency | T::TriangleStripAdjacency => {
                GeometryPrimitive::TrianglesAdjacency
            }
            T::PatchList => return Self::Patches,
        })
    }

    fn of_tessellation(mode: &TessellationMode) -> Self {
        Self::Exactly(match mode.domain {
            _ if mode.point_mode => GeometryPrimitive::Points,
            TessellationDomain::Isolines => GeometryPrimitive::Lines,
            TessellationDomain::Triangles | TessellationDomain::Quads => {
                GeometryPrimitive::Triangles
            }
        })
    }

    /// The topology of a list of them.
    fn list(self) -> PrimitiveTopology {
        match self {
            Self::Exactly(GeometryPrimitive::Points) => PrimitiveTopology::PointList,
            Self::Exactly(GeometryPrimitive::Lines | GeometryPrimitive::LinesAdjacency) => {
                PrimitiveTopology::LineList
            }
            _ => PrimitiveTopology::TriangleList,
        }
    }
}

fn check_scalars(
    (from, gives): (&'static str, usize),
    (to, reads): (&'static str, usize),
) -> Result<(), PipelineError> {
    if gives == reads {
        return Ok(());
    }
    Err(PipelineError::StageScalars {
        from,
        gives,
        to,
        reads,
    })
}

fn check_tessellation(
    state: &TessellationState,
    before: (&'static str, usize),
) -> Result<(), PipelineError> {
    state.program.validate()?;
    let interface = state.program.interface();
    if !(1..=MAX_PATCH_POINTS).contains(&state.patch_points) {
        return Err(PipelineError::PatchPoints(state.patch_points));
    }
    for (what, count) in [
        ("a control point", interface.control),
        ("the values of a patch", interface.patch),
    ] {
        if count > MAX_PATCH_SCALARS {
            let limit = MAX_PATCH_SCALARS;
            return Err(PipelineError::PatchScalars { what, count, limit });
        }
    }
    check_outputs(&interface.output)?;
    check_scalars(before, ("tessellation shader", interface.input))
}

fn check_geometry(
    program: &dyn GeometryProgram,
    before: (&'static str, usize),
    kind: Vertices,
    is_tessellated: bool,
) -> Result<(), PipelineError> {
    program.validate()?;
    let interface = program.interface();
    if kind != Vertices::Exactly(interface.primitive) {
        let made = match kind {
            Vertices::Exactly(made) => made,
            // Tessellation comes between, which makes other primitives.
            Vertices::Patches => GeometryPrimitive::Triangles,
        };
        return Err(PipelineError::GeometryInput {
            from: if is_tessellated {
                "tessellation state"
            } else {
                "topology"
            },
            made,
            reads: interface.primitive,
        });
    }
    check_outputs(&interface.output)?;
    check_scalars(before, ("geometry shader", interface.input))
}

fn check_outputs(output: &OutputInterface) -> Result<(), PipelineError> {
    let count = output.clip_distances.max(output.cull_distances);
    let limit = super::MAX_DISTANCES;
    if count > limit {
        return Err(PipelineError::TooManyDistances { count, limit });
    }
    Ok(())
}

/// The pipeline that shades the vertices of patches and primitives. Nothing is drawn with it.
fn vertex_pipeline(
    descriptor: &RenderPipelineDescriptor,
    program: &Arc<dyn Program>,
    limits: &Limits,
) -> Result<RenderPipeline, PipelineError> {
    let interface = program.interface();
    let attributes = super::attribute_sources(descriptor, interface, limits)?;
    let descriptor = RenderPipelineDescriptor {
        program: Arc::clone(program),
        ..plain(descriptor)
    };
    Ok(RenderPipeline::of(Inner::new(descriptor, attributes)))
}

/// The pipeline that draws finished vertices.
fn rasterized_pipeline(
    descriptor: &RenderPipelineDescriptor,
    output: &OutputInterface,
    words: usize,
    topology: PrimitiveTopology,
) -> Result<RenderPipeline, PipelineError> {
    let program = PassThrough::new(Arc::clone(&descriptor.program), output);
    let mut offset = 0;
    let mut attributes = Vec::new();
    for (location, &count) in (0..).zip(&program.interface.attributes) {
        attributes.push(VertexAttribute {
            format: match count {
                1 => VertexFormat::Float32,
                2 => VertexFormat::Float32x2,
                3 => VertexFormat::Float32x3,
                _ => VertexFormat::Float32x4,
            },
            offset,
            shader_location: location,
        });
        // At most 4.
        offset += 4 * u32::try_from(count).unwrap_or_default();
    }
    // At most 90 words.
    let array_stride = 4 * u32::try_from(words).unwrap_or_default();
    let interface = program.interface.clone();
    let descriptor = RenderPipelineDescriptor {
        program: Arc::new(program),
        vertex_buffers: vec![VertexBufferLayout {
            array_stride,
            attributes,
            ..VertexBufferLayout::default()
        }],
        primitive: PrimitiveState {
            topology,
            primitive_restart: false,
            ..descriptor.primitive
        },
        ..plain(descriptor)
    };
    // Records are ours: the limits of what a caller's shader reads do not count.
    let limits = Limits {
        max_vertex_attributes: u32::MAX,
        max_vertex_buffers: u32::MAX,
        max_vertex_buffer_array_stride: u32::MAX,
        ..Limits::default()
    };
    let attributes = super::attribute_sources(&descriptor, &interface, &limits)?;
    let mut inner = Inner::new(descriptor, attributes);
    inner.has_finished_vertices = true;
    Ok(RenderPipeline::of(inner))
}

/// A descriptor without the stages between vertices and primitives.
fn plain(descriptor: &RenderPipelineDescriptor) -> RenderPipelineDescriptor {
    RenderPipelineDescriptor {
        vertex_program: None,
        tessellation: None,
        geometry: None,
        ..descriptor.clone()
    }
}

/// A program whose vertices are finished: its attributes are the words of a record. Its fragments
/// are those of another program.
#[derive(Debug)]
struct PassThrough {
    fragments: Arc<dyn Program>,
    interface: Interface,
}

impl PassThrough {
    fn new(fragments: Arc<dyn Program>, output: &OutputInterface) -> Self {
        let words = output.record_words();
        let attributes = (0..words).step_by(4).map(|first| (words - first).min(4));
        let interface = Interface {
            attributes: attributes.collect(),
            writes_point_size: output.writes_point_size,
            clip_distances: output.clip_distances,
            cull_distances: output.cull_distances,
            ..fragments.interface().clone()
        };
        Self {
            fragments,
            interface,
        }
    }
}

impl Program for PassThrough {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn run_vertices(&self, _: Level, _: &Bindings, batch: VertexBatch<'_>) {
        let interface = &self.interface;
        let (words, varyings) = (interface.attribute_scalars(), interface.varyings.len());
        let distances = interface.distances();
        for packet in 0..batch.vertex_index.len() {
            let record: &[Packet<f32>] = &batch.attributes[packet * words..][..words];
            let (position, rest) = record.split_at(4);
            let (varying, rest) = rest.split_at(varyings);
            let (distance, rest) = rest.split_at(distances);
            batch.positions[packet * 4..][..4].copy_from_slice(position);
            batch.varyings[packet * varyings..][..varyings].copy_from_slice(varying);
            batch.distances[packet * distances..][..distances].copy_from_slice(distance);
            if let (Some(to), Some(size)) = (batch.point_sizes.get_mut(packet), rest.first()) {
                *to = *size;
            }
        }
    }

    fn run_fragments(&self, level: Level, bindings: &Bindings, batch: FragmentBatch<'_>) {
        self.fragments.run_fragments(level, bindings, batch);
    }
}
