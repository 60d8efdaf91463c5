//! Type erasure: a Rust shader behind the [`Program`] interface.

use super::declaration::{assert_derivatives, assert_fragment, assert_vertex};
use super::dry_run::{Examined, examine};
use super::packets::{PacketSink, PacketSource, Packets};
use super::{Attributes, DepthOutput, Varyings, scalar};
use crate::{
    Bindings, FragmentBatch, FragmentIn, Interface, Pair, Program, Real, Shader, ShaderError, Vec4,
    VertexBatch, VertexIn, derivatives,
};
use estampe_simd::{
    Bytes, LANES, Lanes, Level, Packet, SimdBase, dispatch, f32x16, i32x16, u32x16,
};
use std::ops::Range;

/// A [`Shader`] whose type a pipeline need not know.
pub struct ShaderProgram<T> {
    shader: T,
    interface: Interface,
    /// Fragments have long loops, as far as is known.
    loops_long: bool,
    /// Why no pipeline can be made of the shader, if so.
    error: Option<ShaderError>,
}

impl<T: Shader> ShaderProgram<T> {
    /// Wraps a shader, and finds [its interface](Shader#the-interface), for which the shader is run
    /// a few times. An error is reported when a pipeline is created, by [`Program::validate`].
    #[must_use]
    pub fn new(shader: T) -> Self {
        let (examined, error) = match examine(&shader) {
            Ok(examined) => (examined, None),
            Err(error) => (Examined::default(), Some(error)),
        };
        Self {
            shader,
            interface: examined.interface,
            loops_long: examined.loops_long,
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

    fn run_fragments(&self, level: Level, bindings: &Bindings, mut batch: FragmentBatch<'_>) {
        let mut rest = 0..batch.coverage.len();
        if self.loops_long {
            // In a function of its own: the time of a compiler grows faster than functions do.
            let all = (reborrowed(&mut batch), rest.clone());
            rest.start = dispatch!(@wide level, s => self.in_long_loops(s, bindings, all),
                scalar => 0);
        }
        dispatch!(@wide level, s => self.fragments_of(s, bindings, (batch, rest)),
            scalar => scalar::fragments(&self.shader, &self.interface, bindings, batch));
    }
}

/// How many packets of fragments are shaded at a time.
#[cfg(test)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum AtATime {
    One,
    Two,
    Four,
}

#[cfg(test)]
impl<T: Shader> ShaderProgram<T> {
    /// Shades packets of fragments so many at a time at each level that has packets.
    pub(crate) fn run_fragments_by(
        &self,
        packets: AtATime,
        level: Level,
        bindings: &Bindings,
        batch: FragmentBatch<'_>,
    ) {
        dispatch!(@wide level, s => {
            let all = 0..batch.coverage.len();
            let of = (batch, all);
            match packets {
                AtATime::One => self.fragments::<_, f32x16<_>, 1>(s, bindings, of),
                AtATime::Two => self.fragments::<_, Pair<f32x16<_>>, 2>(s, bindings, of),
                AtATime::Four => self.fragments::<_, Pair<Pair<f32x16<_>>>, 4>(s, bindings, of),
            }
        },
            scalar => scalar::fragments(&self.shader, &self.interface, bindings, batch));
    }

    /// True if fragments were found to have long loops.
    pub(crate) fn loops_long(&self) -> bool {
        self.loops_long
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
            let left = [&batch.attributes[packet * attributes..][..attributes]];
            let loaded = T::Attributes::load(&mut PacketSource::new(simd, left));
            let out = self.shader.vertex(input, loaded);
            assert_vertex::<T, _, _>(interface, &out);
            store_vec4(out.position, [packet * 4], batch.positions);
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
    fn fragments_of<S: Lanes>(&self, simd: S, bindings: &Bindings, of: Part<'_>) {
        if const { S::REGISTERS == 1 } {
            self.fragments::<_, Pair<f32x16<S>>, 2>(simd, bindings, of);
        } else {
            self.fragments::<_, f32x16<S>, 1>(simd, bindings, of);
        }
    }

    /// Shades the first packets twice as many at a time, where a packet has one register or two;
    /// returns how many are done.
    ///
    /// An iteration of a long loop waits for the one before, and has more operations than the
    /// processor looks ahead: two registers of each value leave half of its units idle. Only of
    /// shaders with few varyings, as are those over a whole picture: of every shader another copy
    /// at this width took the compiler four times as long for physically based surfaces.
    #[inline(always)]
    fn in_long_loops<S: Lanes>(&self, simd: S, bindings: &Bindings, of: Part<'_>) -> usize {
        let (batch, all) = of;
        if const { !LONG_LOOPS_APART || size_of::<T::Varyings<f32>>() > FEW_VARYINGS } {
            return 0;
        }
        if const { S::REGISTERS == 1 } {
            let some = 0..all.end / 4 * 4;
            let end = some.end;
            self.fragments::<_, Pair<Pair<f32x16<S>>>, 4>(simd, bindings, (batch, some));
            end
        } else if const { S::REGISTERS == 2 } {
            let some = 0..all.end / 2 * 2;
            let end = some.end;
            self.fragments::<_, Pair<f32x16<S>>, 2>(simd, bindings, (batch, some));
            end
        } else {
            0
        }
    }

    /// Shades some packets of a batch, `N` at a time.
    #[inline(always)]
    fn fragments<S: Lanes, R: Packets<S, N>, const N: usize>(
        &self,
        simd: S,
        bindings: &Bindings,
        (batch, some): Part<'_>,
    ) {
        let interface = &self.interface;
        let (varyings, scalars) = (interface.varyings.len(), interface.fragment_scalars());
        let targets = interface.color_targets;
        let outputs = interface.colors();
        let end = some.end;
        for first in some.step_by(N) {
            // Where packets are missing, the last one takes their place.
            let mut packets = [first; N];
            for (at, packet) in packets.iter_mut().enumerate() {
                *packet = (first + at).min(end - 1);
            }
            let input = input_of::<S, R, N>(simd, (interface, bindings), &batch, packets);
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
                let mut at = packets;
                for at in &mut at {
                    *at = (*at * outputs + index) * 4;
                }
                store_vec4(out.colors[index].unwrap_or(black), at, batch.colors);
            }
            if interface.dual_source {
                let mut at = packets;
                for at in &mut at {
                    *at = (*at * outputs + targets) * 4;
                }
                store_vec4(out.second.unwrap_or(black), at, batch.colors);
            }
            if interface.writes_sample_mask {
                let kept = out.sample_mask.unwrap_or(zero.splat_int(-1));
                let kept = R::parts_of_ints(kept);
                for (kept, packet) in kept.into_iter().zip(packets) {
                    store_ints(kept, &mut batch.sample_masks[packet]);
                }
            }
            if let Some(keep) = out.keep
                && interface.discards
            {
                for (keep, packet) in R::parts_of_mask(keep).into_iter().zip(packets) {
                    batch.coverage[packet] &= simd.bits_of_mask(keep);
                }
            }
            if interface.depth_output != DepthOutput::None {
                match out.depth.map(R::parts) {
                    Some(depths) => {
                        for (depth, packet) in depths.into_iter().zip(packets) {
                            depth.store_array(&mut batch.depths[packet].0);
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

/// Dev builds are not for speed: there the copies would only take time to compile. This crate's
/// tests have them.
const LONG_LOOPS_APART: bool = !cfg!(debug_assertions) || cfg!(test);

/// The bytes of two scalars, a place in the picture.
const FEW_VARYINGS: usize = 2 * size_of::<f32>();

/// A batch, and which of its packets are shaded.
type Part<'a> = (FragmentBatch<'a>, Range<usize>);

/// The same batch, to shade a part of it. (References to a batch would be read anew for each
/// packet.)
fn reborrowed<'a>(batch: &'a mut FragmentBatch<'_>) -> FragmentBatch<'a> {
    FragmentBatch {
        varyings: batch.varyings,
        positions: batch.positions,
        front_facing: batch.front_facing,
        sample_index: batch.sample_index,
        samples_covered: batch.samples_covered,
        coverage: batch.coverage,
        colors: batch.colors,
        depths: batch.depths,
        sample_masks: batch.sample_masks,
    }
}

/// The inputs of fragments beside their varyings. Without closures, and apart from the shader's
/// type: arrays' `map` is five functions for each closure of each shader at each level.
#[inline(always)]
fn input_of<'b, S: Lanes, R: Packets<S, N>, const N: usize>(
    simd: S,
    (interface, bindings): (&Interface, &'b Bindings),
    batch: &FragmentBatch<'_>,
    packets: [usize; N],
) -> FragmentIn<'b, R> {
    let zero = R::zero(simd);
    let position = if interface.reads_position {
        let left = rows(batch.positions, packets, 4);
        <Vec4<R> as Varyings<R>>::load(&mut PacketSource::new(simd, left))
    } else {
        Vec4::new(zero, zero, zero, zero)
    };
    let sample_index = if interface.per_sample {
        let mut of_lanes = [[0; LANES]; N];
        for (lanes, packet) in of_lanes.iter_mut().zip(packets) {
            *lanes = [batch.sample_index[packet]; LANES];
        }
        R::ints_of(simd, of_lanes.each_ref())
    } else {
        zero.splat_int(0)
    };
    let coverage = if interface.reads_coverage {
        let mut of_lanes = [&[0; LANES]; N];
        for (lanes, packet) in of_lanes.iter_mut().zip(packets) {
            *lanes = &batch.samples_covered[packet].0;
        }
        R::ints_of(simd, of_lanes)
    } else {
        zero.splat_int(0)
    };
    let (mut front, mut helpers) = ([0; N], [0; N]);
    for (at, packet) in packets.into_iter().enumerate() {
        front[at] = batch.front_facing[packet];
        helpers[at] = !batch.coverage[packet];
    }
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

/// The packets of `each` scalars of some packets of fragments.
#[inline(always)]
fn rows<const N: usize>(
    all: &[Packet<f32>],
    packets: [usize; N],
    each: usize,
) -> [&[Packet<f32>]; N] {
    let mut rows = [&all[..0]; N];
    for (row, packet) in rows.iter_mut().zip(packets) {
        *row = &all[packet * each..][..each];
    }
    rows
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

/// Stores the four components of a vector in consecutive packets, from `at` on for each packet of
/// fragments.
#[inline(always)]
fn store_vec4<S: Lanes, R: Packets<S, N>, const N: usize>(
    value: Vec4<R>,
    at: [usize; N],
    to: &mut [Packet<f32>],
) {
    let Vec4 { x, y, z, w } = value;
    let [x, y, z, w] = [x.parts(), y.parts(), z.parts(), w.parts()];
    for (part, at) in at.into_iter().enumerate() {
        store_part([x[part], y[part], z[part], w[part]], &mut to[at..][..4]);
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
