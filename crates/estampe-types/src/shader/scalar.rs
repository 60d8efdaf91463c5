//! Scalar execution of a Rust shader: a packet is shaded as four quads of plain scalars.
//!
//! Sixteen emulated lanes would give the same bits, but the compiler took three minutes for one
//! sampled texture that way, and takes two seconds this way.

use super::declaration::{assert_derivatives, assert_fragment, assert_vertex};
use super::{Attributes, DepthOutput, Sink, Source, Varyings};
use crate::{
    Bindings, FragmentBatch, FragmentIn, Interface, Quad, Shader, Vec4, VertexBatch, VertexIn,
    derivatives,
};
use estampe_simd::Packet;

/// Lanes of a quad.
const QUAD: usize = 4;

/// Shades packets of vertices.
pub(super) fn vertices<T: Shader>(
    shader: &T,
    interface: &Interface,
    bindings: &Bindings,
    batch: VertexBatch<'_>,
) {
    let attributes = interface.attribute_scalars();
    let varyings = interface.varyings.len();
    let (clips, culls) = (interface.clip_distances, interface.cull_distances);
    for packet in 0..batch.vertex_index.len() {
        let from = &batch.attributes[packet * attributes..][..attributes];
        let positions = &mut batch.positions[packet * 4..][..4];
        let to = &mut batch.varyings[packet * varyings..][..varyings];
        for lane in (0..16).step_by(QUAD) {
            let input = VertexIn {
                vertex_index: ints(&batch.vertex_index[packet], lane),
                instance_index: ints(&batch.instance_index[packet], lane),
                bindings,
                zero: Quad([0.0; QUAD]),
            };
            let loaded = T::Attributes::load(&mut QuadSource {
                left: from,
                derivatives: [&[]; 2],
                lane,
            });
            let out = shader.vertex(input, loaded);
            assert_vertex::<T, _, _>(interface, &out);
            store_vec4(out.position, positions, lane);
            out.varyings.store(&mut QuadSink {
                left: to,
                next: 0,
                lane,
            });
            if interface.writes_point_size {
                let size = out.point_size.unwrap_or(Quad([1.0; QUAD]));
                store(size, &mut batch.point_sizes[packet], lane);
            }
            let clip = out.clip_distances.iter().take(clips);
            let cull = out.cull_distances.iter().take(culls);
            let first = packet * (clips + culls);
            for (distance, to) in clip.chain(cull).zip(&mut batch.distances[first..]) {
                store(distance.unwrap_or(input.zero), to, lane);
            }
        }
    }
}

/// Shades packets of fragments.
pub(super) fn fragments<T: Shader>(
    shader: &T,
    interface: &Interface,
    bindings: &Bindings,
    batch: FragmentBatch<'_>,
) {
    let (varyings, scalars) = (interface.varyings.len(), interface.fragment_scalars());
    let targets = interface.color_targets;
    let outputs = interface.colors();
    let zero = Quad([0.0; QUAD]);
    let black = Vec4::new(zero, zero, zero, zero);
    for packet in 0..batch.coverage.len() {
        let from = &batch.varyings[packet * scalars..][..scalars];
        let (from, derivatives) = from.split_at(varyings);
        let along = derivatives.split_at(interface.gradients.len());
        let colors = &mut batch.colors[packet * outputs * 4..][..outputs * 4];
        for lane in (0..16).step_by(QUAD) {
            let position = if interface.reads_position {
                let p = &batch.positions[packet * 4..][..4];
                let (x, y) = (load(&p[0], lane), load(&p[1], lane));
                Vec4::new(x, y, load(&p[2], lane), load(&p[3], lane))
            } else {
                black
            };
            let sample_index = batch.sample_index.get(packet).copied().unwrap_or_default();
            let input = FragmentIn {
                position,
                front_facing: mask(batch.front_facing[packet] >> lane),
                is_helper: mask(!batch.coverage[packet] >> lane),
                sample_index: Quad([sample_index.cast_signed(); QUAD]),
                coverage: batch
                    .samples_covered
                    .get(packet)
                    .map_or(Quad([0; QUAD]), |covered| ints(covered, lane)),
                bindings,
                zero,
            };
            let loaded = T::Varyings::load(&mut QuadSource {
                left: from,
                derivatives: [along.0, along.1],
                lane,
            });
            derivatives::were_taken();
            let out = shader.fragment(input, loaded);
            assert_derivatives::<T>(interface);
            assert_fragment::<T, _>(interface, &out);
            let (of_targets, second) = colors.split_at_mut(targets * 4);
            for (color, to) in out.colors.iter().zip(of_targets.chunks_exact_mut(4)) {
                store_vec4(color.unwrap_or(black), to, lane);
            }
            if interface.dual_source {
                store_vec4(out.second.unwrap_or(black), second, lane);
            }
            if interface.writes_sample_mask {
                let Quad(kept) = out.sample_mask.unwrap_or(Quad([-1; QUAD]));
                let to = &mut batch.sample_masks[packet].0[lane..lane + QUAD];
                for (to, kept) in to.iter_mut().zip(kept) {
                    *to = kept.cast_unsigned();
                }
            }
            if let Some(Quad(keep)) = out.keep
                && interface.discards
            {
                for (k, keep) in keep.into_iter().enumerate() {
                    batch.coverage[packet] &= !(u16::from(!keep) << (lane + k));
                }
            }
            if interface.depth_output != DepthOutput::None {
                store(
                    out.depth.unwrap_or(position.z),
                    &mut batch.depths[packet],
                    lane,
                );
            }
        }
    }
}

fn load(packet: &Packet<f32>, lane: usize) -> Quad {
    Quad([
        packet.0[lane],
        packet.0[lane + 1],
        packet.0[lane + 2],
        packet.0[lane + 3],
    ])
}

fn ints(packet: &Packet<u32>, lane: usize) -> Quad<i32> {
    Quad([
        packet.0[lane].cast_signed(),
        packet.0[lane + 1].cast_signed(),
        packet.0[lane + 2].cast_signed(),
        packet.0[lane + 3].cast_signed(),
    ])
}

/// The mask of the lowest four bits.
fn mask(bits: u16) -> Quad<bool> {
    Quad([bits & 1 != 0, bits & 2 != 0, bits & 4 != 0, bits & 8 != 0])
}

fn store(value: Quad, packet: &mut Packet<f32>, lane: usize) {
    packet.0[lane..lane + QUAD].copy_from_slice(&value.0);
}

fn store_vec4(value: Vec4<Quad>, to: &mut [Packet<f32>], lane: usize) {
    for (component, packet) in [value.x, value.y, value.z, value.w].into_iter().zip(to) {
        store(component, packet, lane);
    }
}

/// Scalars of one quad, read in order.
struct QuadSource<'a> {
    left: &'a [Packet<f32>],
    /// Derivatives along x and along y.
    derivatives: [&'a [Packet<f32>]; 2],
    lane: usize,
}

impl Source<Quad> for QuadSource<'_> {
    fn take(&mut self) -> Quad {
        next(&mut self.left, self.lane)
    }

    fn take_derivative(&mut self, axis: usize, _like: Quad) -> Quad {
        next(&mut self.derivatives[axis], self.lane)
    }
}

/// The next scalar of a quad.
fn next(left: &mut &[Packet<f32>], lane: usize) -> Quad {
    // The slice has as many packets as the type has scalars.
    let Some((first, rest)) = left.split_first() else {
        return Quad([0.0; QUAD]);
    };
    *left = rest;
    load(first, lane)
}

/// Scalars of one quad, written in order.
struct QuadSink<'a> {
    left: &'a mut [Packet<f32>],
    next: usize,
    lane: usize,
}

impl Sink<Quad> for QuadSink<'_> {
    fn put(&mut self, value: Quad) {
        if let Some(packet) = self.left.get_mut(self.next) {
            store(value, packet, self.lane);
        }
        self.next += 1;
    }
}
