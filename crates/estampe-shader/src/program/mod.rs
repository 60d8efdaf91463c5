//! Text shaders as programs of the pipeline.
//!
//! [`TextProgram`] is to shaders as text what
//! [`ShaderProgram`](estampe_types::ShaderProgram) is to shaders in Rust: a vertex and a fragment
//! stage behind the one interface by which all shaders run. [`TextCompute`] is a compute shader.

mod alpha_test;
mod batch;
mod buffers;
mod comparisons;
mod compute;
mod ends;
mod facts;
mod groups;
mod layouts;
mod link;
mod machine;
mod nondependent;
mod packed;
mod pixel_loads;
mod read_inputs;
mod read_place;
mod samples;
mod stage;
mod taps;
mod texel_accesses;
mod textures;
mod uniforms;
mod workspaces;

pub use compute::{MAX_INVOCATIONS, TextCompute};
pub use link::{LinkError, VaryingSlot};

use batch::{Widths, with_fragments, with_vertices};
use estampe_ir::interface::TextureSlot;
use estampe_ir::tree::{Tree, passes};
use estampe_simd::Level;
use estampe_types::shader::{AlphaTest, AlphaTestRequest, StoppedBatches, TextureReads};
use estampe_types::{
    BindGroupLayout, BindGroupLayoutEntry, Bindings, FragmentBatch, Interface, Program, SampleType,
    VertexBatch,
};
use facts::Facts;
use link::Links;
use nondependent::Fragments;
use stage::Stage;
use uniforms::Sources;

/// A stage that was lowered, with what its tree does not tell.
#[derive(Debug, Clone)]
pub struct StageSource {
    /// The stage.
    pub tree: Tree,
    /// The varyings that it writes or reads.
    pub varyings: Vec<VaryingSlot>,
    /// The type of the numbers that it writes to each colour target, by location; empty but in
    /// fragment shaders.
    pub color_types: Vec<Option<SampleType>>,
    /// The bind groups and entries that it uses.
    pub bindings: Vec<(u32, BindGroupLayoutEntry)>,
    /// The bytes of the immediates up to the last one that it reads.
    pub immediate_size: u32,
}

impl StageSource {
    /// Lets products and sums be rounded once, together.
    pub fn contract(&mut self) {
        passes::contract(&mut self.tree);
        passes::dead_code(&mut self.tree);
    }
}

/// A vertex shader, and a fragment shader if there is one, as a program.
#[derive(Debug)]
pub struct TextProgram {
    interface: Interface,
    layouts: Vec<BindGroupLayout>,
    widths: Widths,
    immediate_size: u32,
    vertex: Stage,
    fragment: Option<Stage>,
    stopped: StoppedBatches,
}

impl TextProgram {
    /// Links the stages and compiles them. A run that executes more than `budget` jumps is
    /// stopped, and with it the pass.
    ///
    /// # Errors
    /// [`LinkError`] if the fragment stage reads what the vertex stage does not write, or the
    /// stages bind different kinds of resources at the same number.
    pub fn new(
        vertex: &StageSource,
        fragment: Option<&StageSource>,
        budget: u64,
    ) -> Result<Self, LinkError> {
        if Facts::of(&vertex.tree).stores {
            return Err(LinkError::VertexStores);
        }
        let layouts = layouts::of_stages(std::iter::once(vertex).chain(fragment))?;
        let mut fragment = fragment.cloned();
        let links = Links::new(vertex, fragment.as_mut())?;
        let interface = link::interface(vertex, fragment.as_ref(), &links);
        let attributes = interface.attributes.iter().scan(0, |next, count| {
            let start = *next;
            *next += count;
            Some(start)
        });
        let attributes: Vec<usize> = attributes.collect();
        let widths = Widths {
            attributes: interface.attribute_scalars(),
            varyings: interface.varyings.len(),
            gradients: interface.gradients.len(),
            colors: interface.colors(),
            targets: interface.color_targets,
            clip_distances: interface.distances(),
        };
        let gradients = &interface.gradients[..];
        let fragment_stage = fragment
            .as_ref()
            .map(|source| Stage::of_fragments(&source.tree, budget, (widths, gradients)));
        Ok(Self {
            widths,
            immediate_size: vertex.immediate_size.max(
                fragment
                    .as_ref()
                    .map_or(0, |fragment| fragment.immediate_size),
            ),
            vertex: Stage::of_vertices(&vertex.tree, budget, (&attributes, links.of_vertex())),
            fragment: fragment_stage,
            layouts,
            interface,
            stopped: StoppedBatches::default(),
        })
    }

    /// The texture reads of the fragment shader that are made for a batch before it runs.
    #[must_use]
    pub fn nondependent_reads(&self) -> usize {
        self.fragment
            .as_ref()
            .map_or(0, |stage| stage.reads().count())
    }

    /// True if the colours of fragments are the texels of a texture read as they are, so that the
    /// read is all that is done for a batch.
    #[must_use]
    pub fn passes_texels(&self) -> bool {
        self.fragment.as_ref().is_some_and(Stage::passes_texels)
    }

    /// The same without machine code: the interpreter runs it at every level.
    #[must_use]
    pub fn interpreted(mut self) -> Self {
        self.vertex.interpret();
        self.fragment.iter_mut().for_each(Stage::interpret);
        self
    }
}

impl Program for TextProgram {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn bind_group_layouts(&self) -> &[BindGroupLayout] {
        &self.layouts
    }

    fn immediate_size(&self) -> u32 {
        self.immediate_size
    }

    fn stopped_batches(&self) -> Option<&StoppedBatches> {
        Some(&self.stopped)
    }

    fn texture_reads(&self, group: u32, binding: u32) -> TextureReads {
        let stages = std::iter::once(&self.vertex).chain(&self.fragment);
        let reads = stages.map(|stage| stage.texture_reads(TextureSlot { group, binding }));
        reads.fold(TextureReads::default(), |all, reads| all | reads)
    }

    fn alpha_test(&self, bindings: &Bindings, request: AlphaTestRequest) -> Option<AlphaTest> {
        let stage = self.fragment.as_ref()?;
        let (buffers, textures) = (stage.buffers(bindings), stage.textures(bindings));
        let sources = Sources {
            textures: &textures,
            buffers: buffers.all(),
            immediates: &bindings.immediates,
        };
        let (read, failing) = stage.alpha_tests()?.failing(sources, request)?;
        let (place, [texture, sampler]) = stage.reads().place_of(read)?;
        let (at, layer, of_quads) = place.of_alpha(self.widths, &self.interface.gradients)?;
        let sampled = textures.sampled(texture, sampler)?;
        Some(AlphaTest {
            failing,
            map: sampled.alpha_map(failing, request.primitives)?,
            at,
            layer,
            of_quads,
        })
    }

    fn run_vertices(&self, level: Level, bindings: &Bindings, batch: VertexBatch<'_>) {
        let stage = &self.vertex;
        if self.stopped.is_stopped() {
            return;
        }
        let (buffers, textures) = (stage.buffers(bindings), stage.textures(bindings));
        let places = (self.widths, &bindings.immediates[..]);
        // A run that is stopped leaves its outputs as they are.
        let run = with_vertices(stage, places, batch, |packets, inputs, outputs| {
            stage.run(
                level,
                (&textures, buffers.all()),
                packets,
                (inputs, outputs),
            )
        });
        if run.is_err() {
            self.stopped.stop();
        }
    }

    fn run_fragments(&self, level: Level, bindings: &Bindings, batch: FragmentBatch<'_>) {
        let Some(stage) = &self.fragment else {
            return;
        };
        if self.stopped.is_stopped() {
            return;
        }
        let (buffers, textures) = (stage.buffers(bindings), stage.textures(bindings));
        let places = (self.widths, &bindings.immediates[..]);
        let fragments = Fragments {
            level,
            scalars: batch.varyings,
            stride: self.widths.fragment_scalars(),
            positions: batch.positions,
            packets: batch.coverage.len(),
        };
        let sources = Sources {
            textures: &textures,
            buffers: buffers.all(),
            immediates: &bindings.immediates,
        };
        if stage.passes_texels() {
            stage.reads().sample_into(sources, fragments, batch.colors);
            return;
        }
        let run = stage.reads().with_texels(sources, fragments, |texels| {
            let batch = (batch, texels);
            with_fragments(stage, places, batch, |packets, inputs, outputs| {
                stage.run(
                    level,
                    (&textures, buffers.all()),
                    packets,
                    (inputs, outputs),
                )
            })
        });
        if run.is_err() {
            self.stopped.stop();
        }
    }
}

impl Facts {
    fn add_to(self, interface: &mut Interface) {
        interface.discards = self.discards;
        interface.color_passthrough = self.passes_color;
        interface.no_derivatives = !self.takes_derivatives;
        interface.stores = self.stores;
        interface.stores_in_any_order = self.stores_in_any_order;
    }
}
