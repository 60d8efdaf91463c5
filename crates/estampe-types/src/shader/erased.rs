//! Type erasure: a Rust shader behind the [`Program`] interface.

use super::declaration::{assert_derivatives, assert_fragment, assert_vertex};
use super::packets::{PacketSink, PacketSource, Packets};
use super::{Attributes, DepthOutput, Varyings, interface_of, scalar};
use crate::{
    Bindings, FragmentBatch, FragmentIn, Interface, Pair, Program, Real, Shader, ShaderError, Vec4,
    VertexBatch, VertexIn, derivatives,
};
use estampe_simd::{
    Bytes, LANES, Lanes, Level, Packet, SimdBase, dispatch, f32x16, i32x16, u32x16,
};

/// A [`Shader`] whose type a pipeline need not know.
pub struct ShaderProgram<T> {
    shader: T,
    interface: Interface,
    /// Why no pipeline can be made of the shader, if so.
    error: Option<ShaderError>,
}

impl<T: Shader> ShaderProgram<T> {
    /// Wraps a shader, and finds [its interface](Shader#the-interface), for which the shader is run
    /// a few times. An error is reported when a pipeline is created, by [`Program::validate`].
    #[must_use]
    pub fn new(shader: T) -> Self {
        let (interface, error) = match interface_of(&shader) {
            Ok(interface) => (interface, None),
            Err(error) => (Interface::default(), Some(error)),
        };
        Self {
            shader,
            interface,
            error,
        }
    }

    /// The shader.
    #[must_use]
    pub fn shader(&self) -> &T {
        &self.shader
    }
}

impl<T> std::fmt::Debug for ShaderProgram<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ShaderProgram")
            .field("shader", &std::any::type_name::<T>())
            .field("interface", &self.interface)
            .finish()
    }
}

impl<T: Shader> Program for ShaderProgram<T> {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn validate(&self) -> Result<(), ShaderError> {
        self.error.clone().map_or(Ok(()), Err)
    }

    fn run_vertices(&self, level: Level, bindings: &Bindings, batch: VertexBatch<'_>) {
        dispatch!(@wide level, s => self.vertices(s, bindings, batch),
            scalar => scalar::vertices(&self.shader, &self.interface, bindings, batch));
    }

    fn run_fragments(&self, level: Level, bindings: &Bindings, batch: FragmentBatch<'_>) {
        dispatch!(@wide level, s => self.fragments_of(s, bindings, batch),
            scalar => scalar::fragments(&self.shader, &self.interface, bindings, batch));
    }
}

#[cfg(test)]
impl<T: Shader> ShaderProgram<T> {
    /// Shades packets of fragments two at a time at each level that has packets, or one at a time.
    pub(crate) fn run_fragments_by(
        &self,
        pairs: bool,
        level: Level,
        bindings: &Bindings,
        batch: FragmentBatch<'_>,
    ) {
        dispatch!(@wide level, s => {
            if pairs {
                self.fragments::<_, Pair<f32x16<_>>>(s, bindings, batch);
            } else {
                self.fragments::<_, f32x16<_>>(s, bindings, batch);
            }
        },
            scalar => scalar::fragments(&self.shader, &self.interface, bindings, batch));
    }
}

impl<T: Shader> ShaderProgram<T> {
    #[inline(always)]
    fn vertices<S: Lanes>(&self, simd: S, bindings: &Bindings, batch: VertexBatch<'_>) {
        let interface = &self.interface;
        let attributes = interface.attribute_scalars();
        let varyings = interface.varyings.len();
        let (clips, culls) = (interface.clip_distances, interface.cull_distances);
        for packet in 0..batch.vertex_index.len() {
            let input = VertexIn {
                vertex_index: ints(simd, &batch.vertex_index[packet]),
                instance_index: ints(simd, &batch.instance_index[packet]),
                bindings,
                zero: <f32x16<S> as SimdBase<S>>::splat(simd, 0.0),
            };
            let left = [&batch.attributes[packet * attributes..][..attributes]; 2];
            let loaded = T::Attributes::load(&mut PacketSource::new(simd, left));
            let out = self.shader.vertex(input, loaded);
            assert_vertex::<T, _, _>(interface, &out);
            store_vec4(out.position, [packet * 4; 2], batch.positions);
            let to = &mut batch.varyings[packet * varyings..][..varyings];
            out.varyings.store(&mut PacketSink { left: to });
            if interface.writes_point_size {
                let size = out.point_size.unwrap_or(input.zero.splat(1.0));
                size.store_array(&mut batch.point_sizes[packet].0);
            }
            if clips + culls > 0 {
                let clip = out.clip_distances.iter().take(clips);
                let cull = out.cull_distances.iter().take(culls);
                let first = packet * (clips + culls);
                for (distance, to) in clip.chain(cull).zip(&mut batch.distances[first..]) {
                    distance.unwrap_or(input.zero).store_array(&mut to.0);
                }
            }
        }
    }

    /// Shades two packets at a time where a register holds a packet, so that the operations of one
    /// run while those of the other wait for their operands; else one after the other.
    #[inline(always)]
    fn fragments_of<S: Lanes>(&self, simd: S, bindings: &Bindings, batch: FragmentBatch<'_>) {
        if const { S::IN_ONE_REGISTER } {
            self.fragments::<_, Pair<f32x16<S>>>(simd, bindings, batch);
        } else {
            self.fragments::<_, f32x16<S>>(simd, bindings, batch);
        }
    }

    /// Shades packets one after the other, or two at a time.
    #[inline(always)]
    fn fragments<S: Lanes, R: Packets<S>>(
        &self,
        simd: S,
        bindings: &Bindings,
        batch: FragmentBatch<'_>,
    ) {
        let interface = &self.interface;
        let (varyings, scalars) = (interface.varyings.len(), interface.fragment_scalars());
        let targets = interface.color_targets;
        let outputs = interface.colors();
        let count = batch.coverage.len();
        for packet in (0..count).step_by(R::COUNT) {
            // A last packet without a partner is paired with itself.
            let second = (packet + R::COUNT - 1).min(count - 1);
            let packets = [packet, second];
            let input = input_of::<S, R>(simd, (interface, bindings), &batch, packets);
            let zero = input.zero;
            let black = Vec4::new(zero, zero, zero, zero);
            let of_packets = rows(batch.varyings, packets, scalars);
            derivatives::were_taken();
            let mut source = PacketSource::of_fragments(simd, of_packets, varyings);
            let loaded = T::Varyings::load(&mut source);
            let out = self.shader.fragment(input, loaded);
            assert_derivatives::<T>(interface);
            assert_fragment::<T, _>(interface, &out);
            for index in 0..targets {
                let at = [
                    (packet * outputs + index) * 4,
                    (second * outputs + index) * 4,
                ];
                store_vec4(out.colors[index].unwrap_or(black), at, batch.colors);
            }
            if interface.dual_source {
                let at = [
                    (packet * outputs + targets) * 4,
                    (second * outputs + targets) * 4,
                ];
                store_vec4(out.second.unwrap_or(black), at, batch.colors);
            }
            if interface.writes_sample_mask {
                let kept = out.sample_mask.unwrap_or(zero.splat_int(-1));
                let kept = R::parts_of_ints(kept);
                store_ints(kept[0], &mut batch.sample_masks[packet]);
                if R::COUNT > 1 {
                    store_ints(kept[1], &mut batch.sample_masks[second]);
                }
            }
            if let Some(keep) = out.keep
                && interface.discards
            {
                let keep = R::parts_of_mask(keep);
                batch.coverage[packet] &= simd.bits_of_mask(keep[0]);
                if R::COUNT > 1 {
                    batch.coverage[second] &= simd.bits_of_mask(keep[1]);
                }
            }
            if interface.depth_output != DepthOutput::None {
                match out.depth.map(R::parts) {
                    Some(depth) => {
                        depth[0].store_array(&mut batch.depths[packet].0);
                        if R::COUNT > 1 {
                            depth[1].store_array(&mut batch.depths[second].0);
                        }
                    }
                    // The interpolated depth: window z, which is given to such shaders.
                    None => {
                        for packet in packets {
                            batch.depths[packet] = batch.positions[packet * 4 + 2];
                        }
                    }
                }
            }
        }
    }
}

/// The inputs of fragments beside their varyings. Without closures, and apart from the shader's
/// type: arrays' `map` is five functions for each closure of each shader at each level.
#[inline(always)]
fn input_of<'b, S: Lanes, R: Packets<S>>(
    simd: S,
    (interface, bindings): (&Interface, &'b Bindings),
    batch: &FragmentBatch<'_>,
    packets: [usize; 2],
) -> FragmentIn<'b, R> {
    let [first, second] = packets;
    let zero = R::zero(simd);
    let position = if interface.reads_position {
        let left = rows(batch.positions, packets, 4);
        <Vec4<R> as Varyings<R>>::load(&mut PacketSource::new(simd, left))
    } else {
        Vec4::new(zero, zero, zero, zero)
    };
    let sample_index = if interface.per_sample {
        let of_samples = [batch.sample_index[first], batch.sample_index[second]];
        R::ints_of(simd, [[of_samples[0]; LANES], [of_samples[1]; LANES]])
    } else {
        zero.splat_int(0)
    };
    let coverage = if interface.reads_coverage {
        let (a, b) = (
            &batch.samples_covered[first],
            &batch.samples_covered[second],
        );
        R::ints_of(simd, [a.0, b.0])
    } else {
        zero.splat_int(0)
    };
    let front = [batch.front_facing[first], batch.front_facing[second]];
    let helpers = [!batch.coverage[first], !batch.coverage[second]];
    FragmentIn {
        position,
        front_facing: R::mask_of(simd, front),
        is_helper: R::mask_of(simd, helpers),
        sample_index,
        coverage,
        bindings,
        zero,
    }
}

/// The packets of `each` scalars of two packets of fragments.
#[inline(always)]
fn rows(all: &[Packet<f32>], [first, second]: [usize; 2], each: usize) -> [&[Packet<f32>]; 2] {
    [&all[first * each..][..each], &all[second * each..][..each]]
}

#[inline(always)]
fn ints<S: Lanes>(simd: S, packet: &Packet<u32>) -> i32x16<S> {
    u32x16::load_array_ref(simd, &packet.0).bitcast()
}

#[inline(always)]
fn store_ints<S: Lanes>(value: i32x16<S>, to: &mut Packet<u32>) {
    let bits: u32x16<S> = value.bitcast();
    bits.store_array(&mut to.0);
}

/// Stores the four components of a vector in consecutive packets, from `at[0]` on for the first
/// packet and from `at[1]` on for the second.
#[inline(always)]
fn store_vec4<S: Lanes, R: Packets<S>>(value: Vec4<R>, at: [usize; 2], to: &mut [Packet<f32>]) {
    let Vec4 { x, y, z, w } = value;
    let [x, y, z, w] = [x.parts(), y.parts(), z.parts(), w.parts()];
    store_part([x[0], y[0], z[0], w[0]], &mut to[at[0]..][..4]);
    if R::COUNT > 1 {
        store_part([x[1], y[1], z[1], w[1]], &mut to[at[1]..][..4]);
    }
}

#[inline(always)]
fn store_part<S: Lanes>([x, y, z, w]: [f32x16<S>; 4], to: &mut [Packet<f32>]) {
    if let [first, second, third, fourth] = to {
        x.store_array(&mut first.0);
        y.store_array(&mut second.0);
        z.store_array(&mut third.0);
        w.store_array(&mut fourth.0);
    }
}
