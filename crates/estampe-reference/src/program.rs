//! The shaders of a draw as the oracle runs them: one vertex, or one quad of fragments, at a time.
//!
//! In · Out: scalars · scalars. [`RustShaders`] runs a [`Shader`] with `R = f32` and `R = Quad`;
//! [`ProgramShaders`] runs any [`Program`], in packets of which one vertex or one quad counts.

use crate::ClipVertex;
use estampe_types::shader::{
    Attributes, DepthOutput, FragmentBatch, FragmentIn, LANES, Level, Packet, Shader, ShaderError,
    Source, Varyings, VertexBatch, VertexIn, interface_of,
};
use estampe_types::{Bindings, Interface, Program, Quad, Real, Vec4};

/// Runs the shaders of a draw.
pub trait Shaders {
    /// The inputs and outputs.
    fn interface(&self) -> &Interface;
    /// Shades a vertex, given the scalars of its attributes.
    fn vertex(&self, input: &VertexInput<'_>, attributes: &[f32]) -> ClipVertex;
    /// Shades the four fragments of a quad.
    fn quad(&self, input: &QuadInput<'_>) -> [ShadedFragment; 4];
}

/// The built-in inputs of a vertex.
#[derive(Debug, Clone, Copy)]
pub struct VertexInput<'a> {
    /// Index of the vertex.
    pub vertex_index: u32,
    /// Index of the instance.
    pub instance_index: u32,
    /// The resources of the draw.
    pub bindings: &'a Bindings,
}

/// The inputs of a quad's fragments, by lane.
#[derive(Debug, Clone)]
pub struct QuadInput<'a> {
    /// Window x, y, z and 1/w.
    pub positions: [[f32; 4]; 4],
    /// True if the primitive is front facing.
    pub front_facing: bool,
    /// True if a fragment only completes the quad.
    pub is_helper: [bool; 4],
    /// The sample that is shaded; 0 if shading is per pixel.
    pub sample_index: u32,
    /// The covered samples.
    pub coverage: [u16; 4],
    /// The interpolated scalars of the varyings, then the derivatives along x, and along y, of
    /// those that the interface lists in `gradients`.
    pub varyings: [Vec<f32>; 4],
    /// The resources of the draw.
    pub bindings: &'a Bindings,
}

/// A fragment as the shader leaves it.
#[derive(Debug, Clone, PartialEq)]
pub struct ShadedFragment {
    /// One colour for each target that the shader writes.
    pub colors: Vec<[f32; 4]>,
    /// The second colour of dual-source blending; zeros if the shader writes none.
    pub second: [f32; 4],
    /// The depth that the shader writes; `None` if it declares no depth output.
    pub depth: Option<f32>,
    /// The shader's sample mask; all ones if it writes none.
    pub sample_mask: u16,
    /// True if the shader discarded the fragment.
    pub is_discarded: bool,
}

/// A shader in Rust.
#[derive(Debug)]
pub struct RustShaders<'a, S> {
    shader: &'a S,
    interface: Interface,
}

impl<'a, S: Shader> RustShaders<'a, S> {
    /// Finds the interface of a shader.
    ///
    /// # Errors
    /// [`ShaderError`] if no pipeline can be made of the shader.
    pub fn new(shader: &'a S) -> Result<Self, ShaderError> {
        let interface = interface_of(shader)?;
        Ok(Self { shader, interface })
    }
}

impl<S: Shader> Shaders for RustShaders<'_, S> {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn vertex(&self, input: &VertexInput<'_>, attributes: &[f32]) -> ClipVertex {
        let mut scalars = Scalars(attributes.iter());
        let attributes = S::Attributes::load(&mut scalars);
        let input = VertexIn {
            vertex_index: input.vertex_index.cast_signed(),
            instance_index: input.instance_index.cast_signed(),
            bindings: input.bindings,
            zero: 0.0_f32,
        };
        let output = self.shader.vertex(input, attributes);
        let distances = [self.interface.clip_distances, self.interface.cull_distances];
        ClipVertex::of(output, distances)
    }

    fn quad(&self, input: &QuadInput<'_>) -> [ShadedFragment; 4] {
        let read = |component: usize| Quad(input.positions.map(|p| p[component]));
        let fragment = FragmentIn {
            position: Vec4::new(read(0), read(1), read(2), read(3)),
            front_facing: Quad([input.front_facing; 4]),
            is_helper: Quad(input.is_helper),
            sample_index: Quad([input.sample_index.cast_signed(); 4]),
            coverage: Quad(input.coverage.map(i32::from)),
            bindings: input.bindings,
            zero: Quad([0.0; 4]),
        };
        let of_lanes = |from: usize, count: usize| {
            let lanes = input.varyings.each_ref();
            lanes.map(|scalars| scalars[from..][..count].iter())
        };
        let (values, each) = (
            self.interface.varyings.len(),
            self.interface.gradients.len(),
        );
        let mut varyings = QuadScalars {
            lanes: of_lanes(0, values),
            derivatives: [of_lanes(values, each), of_lanes(values + each, each)],
        };
        let output = self
            .shader
            .fragment(fragment, S::Varyings::load(&mut varyings));

        // Split the shader's output into lanes.
        let color_at = |color: Option<Vec4<Quad>>, lane: usize| match color {
            Some(c) => [c.x, c.y, c.z, c.w].map(|channel| channel.lane(lane)),
            None => [0.0; 4],
        };
        [0, 1, 2, 3].map(|lane| ShadedFragment {
            colors: (0..self.interface.color_targets)
                .map(|target| color_at(output.color_of(target), lane))
                .collect(),
            second: color_at(output.second_color(), lane),
            depth: match self.interface.depth_output {
                DepthOutput::None => None,
                _ => {
                    let depth = output.depth().unwrap_or(fragment.position.z);
                    Some(depth.lane(lane))
                }
            },
            sample_mask: match output.sample_mask() {
                Some(mask) => low_bits(mask.0[lane]),
                None => u16::MAX,
            },
            is_discarded: output.kept().is_some_and(|kept| !kept.0[lane]),
        })
    }
}

/// Any program, run in packets.
#[derive(Debug, Clone, Copy)]
pub struct ProgramShaders<'a> {
    program: &'a dyn Program,
    level: Level,
}

impl<'a> ProgramShaders<'a> {
    /// Runs a program at a SIMD level.
    #[must_use]
    pub fn new(program: &'a dyn Program, level: Level) -> Self {
        Self { program, level }
    }
}

/// Packets of zeros: on the stack as far as they fit, as memory that is aligned to packets takes
/// longer to get than the work on it.
struct Memory {
    stack: [Packet<f32>; 32],
    heap: Vec<Packet<f32>>,
}

impl Memory {
    fn new() -> Self {
        Self {
            stack: [splat(0.0); 32],
            heap: Vec::new(),
        }
    }

    /// So many packets of each of four kinds.
    fn split(&mut self, counts: [usize; 4]) -> [&mut [Packet<f32>]; 4] {
        let count = counts.iter().sum();
        let all = if count <= self.stack.len() {
            &mut self.stack[..count]
        } else {
            self.heap.resize(count, splat(0.0));
            &mut self.heap
        };
        let (first, rest) = all.split_at_mut(counts[0]);
        let (second, rest) = rest.split_at_mut(counts[1]);
        let (third, fourth) = rest.split_at_mut(counts[2]);
        [first, second, third, fourth]
    }
}

/// A packet with a value in every lane.
fn splat(value: f32) -> Packet<f32> {
    Packet([value; LANES])
}

/// A packet of quads that are all alike.
fn quads<T: Copy>(quad: [T; 4]) -> Packet<T> {
    Packet(std::array::from_fn(|lane| quad[lane % 4]))
}

impl Shaders for ProgramShaders<'_> {
    fn interface(&self) -> &Interface {
        self.program.interface()
    }

    fn vertex(&self, input: &VertexInput<'_>, attributes: &[f32]) -> ClipVertex {
        let interface = self.program.interface();
        let mut positions = [splat(0.0); 4];
        let mut memory = Memory::new();
        let [inputs, varyings, point_sizes, distances] = memory.split([
            attributes.len(),
            interface.varyings.len(),
            usize::from(interface.writes_point_size),
            interface.distances(),
        ]);
        for (input, &scalar) in inputs.iter_mut().zip(attributes) {
            *input = splat(scalar);
        }
        point_sizes.fill(splat(1.0));
        self.program.run_vertices(
            self.level,
            input.bindings,
            VertexBatch {
                attributes: inputs,
                vertex_index: &[Packet([input.vertex_index; LANES])],
                instance_index: &[Packet([input.instance_index; LANES])],
                positions: &mut positions,
                varyings,
                point_sizes,
                distances,
            },
        );
        let first = |packets: &[Packet<f32>]| packets.iter().map(|packet| packet.0[0]).collect();
        let (clip, cull) = distances.split_at(interface.clip_distances);
        ClipVertex {
            position: positions.map(|packet| packet.0[0]),
            varyings: first(varyings),
            point_size: point_sizes.first().map_or(1.0, |packet| packet.0[0]),
            clip_distances: first(clip),
            cull_distances: first(cull),
        }
    }

    fn quad(&self, input: &QuadInput<'_>) -> [ShadedFragment; 4] {
        let interface = self.program.interface();
        let mut memory = Memory::new();
        let [varyings, colors, depths, _] = memory.split([
            interface.fragment_scalars(),
            interface.colors() * 4,
            usize::from(interface.depth_output != DepthOutput::None),
            0,
        ]);
        for (k, varying) in varyings.iter_mut().enumerate() {
            *varying = quads(input.varyings.each_ref().map(|lane| lane[k]));
        }
        let positions = [0, 1, 2, 3].map(|k: usize| quads(input.positions.map(|p| p[k])));
        // The quads beyond the first only fill the packet.
        let coverage = (0..4).filter(|&lane| !input.is_helper[lane]);
        let coverage = coverage.fold(0_u16, |bits, lane| bits | 1 << lane);
        let mut kept = [coverage];
        let mut masks = [Packet([u32::MAX; LANES])];
        let masks = &mut masks[..usize::from(interface.writes_sample_mask)];
        self.program.run_fragments(
            self.level,
            input.bindings,
            FragmentBatch {
                varyings,
                positions: &positions,
                front_facing: &[if input.front_facing { u16::MAX } else { 0 }],
                sample_index: &[input.sample_index],
                samples_covered: &[quads(input.coverage.map(u32::from))],
                coverage: &mut kept,
                colors,
                depths,
                sample_masks: masks,
            },
        );
        let color = |index: usize, lane: usize| -> [f32; 4] {
            std::array::from_fn(|channel| colors[index * 4 + channel].0[lane])
        };
        let targets = interface.color_targets;
        [0, 1, 2, 3].map(|lane| ShadedFragment {
            colors: (0..targets).map(|target| color(target, lane)).collect(),
            second: if interface.dual_source {
                color(targets, lane)
            } else {
                [0.0; 4]
            },
            depth: depths.first().map(|packet| packet.0[lane]),
            sample_mask: masks
                .first()
                .map_or(u16::MAX, |mask| low_bits(mask.0[lane].cast_signed())),
            is_discarded: coverage >> lane & 1 == 1 && kept[0] >> lane & 1 == 0,
        })
    }
}

/// The low 16 bits: pixels have at most 16 samples.
fn low_bits(mask: i32) -> u16 {
    let [low, high, ..] = mask.to_le_bytes();
    u16::from_le_bytes([low, high])
}

/// A source of scalars for a shader, in order; zeros after the last.
struct Scalars<'a>(std::slice::Iter<'a, f32>);

impl Source<f32> for Scalars<'_> {
    fn take(&mut self) -> f32 {
        self.0.next().copied().unwrap_or_default()
    }
}

/// The scalars of four lanes as a source of quads.
struct QuadScalars<'a> {
    lanes: Lanes<'a>,
    /// Derivatives along x and along y.
    derivatives: [Lanes<'a>; 2],
}

type Lanes<'a> = [std::slice::Iter<'a, f32>; 4];

impl Source<Quad> for QuadScalars<'_> {
    fn take(&mut self) -> Quad {
        next(&mut self.lanes)
    }

    fn take_derivative(&mut self, axis: usize, _like: Quad) -> Quad {
        next(&mut self.derivatives[axis])
    }
}

fn next(lanes: &mut Lanes<'_>) -> Quad {
    let next = |lane: &mut std::slice::Iter<'_, f32>| lane.next().copied().unwrap_or_default();
    Quad(lanes.each_mut().map(next))
}
