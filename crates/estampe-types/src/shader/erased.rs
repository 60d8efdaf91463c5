//! A Rust shader behind the [`Program`] interface.

use super::fragment::MAX_COLORS;
use super::pass_through::passes_color;
use super::{Attributes, Sink, Source, Varyings, scalar};
use crate::{
    Bindings, FragmentBatch, FragmentIn, Interface, Program, Real, Shader, Vec4, VertexBatch,
    VertexIn,
};
use estampe_simd::{Bytes, Lanes, Level, Packet, SimdBase, dispatch, f32x16, i32x16, u32x16};

/// A [`Shader`] whose type is erased: what a pipeline holds.
pub struct ShaderProgram<T> {
    shader: T,
    interface: Interface,
}

impl<T: Shader> ShaderProgram<T> {
    /// Wraps a shader.
    #[must_use]
    pub fn new(shader: T) -> Self {
        let mut interface = Interface {
            color_targets: T::COLOR_TARGETS.min(MAX_COLORS),
            discards: T::DISCARDS,
            depth_output: T::DEPTH_OUTPUT,
            reads_position: T::READS_POSITION,
            writes_point_size: T::WRITES_POINT_SIZE,
            independent_fragments: T::INDEPENDENT_FRAGMENTS,
            ..Interface::default()
        };
        T::Attributes::<f32>::components(&mut interface.attributes);
        T::Varyings::<f32>::modes(&mut interface.varyings);
        interface.passes_color = passes_color(&shader, &interface);
        Self { shader, interface }
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

    fn run_vertices(&self, level: Level, bindings: &Bindings, batch: VertexBatch<'_>) {
        dispatch!(@wide level, s => self.vertices(s, bindings, batch),
            scalar => scalar::vertices(&self.shader, &self.interface, bindings, batch));
    }

    fn run_fragments(&self, level: Level, bindings: &Bindings, batch: FragmentBatch<'_>) {
        dispatch!(@wide level, s => self.fragments(s, bindings, batch),
            scalar => scalar::fragments(&self.shader, &self.interface, bindings, batch));
    }
}

impl<T: Shader> ShaderProgram<T> {
    #[inline(always)]
    fn vertices<S: Lanes>(&self, simd: S, bindings: &Bindings, batch: VertexBatch<'_>) {
        let attributes = self.interface.attribute_scalars();
        let varyings = self.interface.varyings.len();
        for packet in 0..batch.vertex_index.len() {
            let input = VertexIn {
                vertex_index: ints(simd, &batch.vertex_index[packet]),
                instance_index: ints(simd, &batch.instance_index[packet]),
                bindings,
                zero: <f32x16<S> as SimdBase<S>>::splat(simd, 0.0),
            };
            let from = &batch.attributes[packet * attributes..][..attributes];
            let loaded = T::Attributes::load(&mut PacketSource { simd, left: from });
            let out = self.shader.vertex(input, loaded);
            let position = &mut batch.positions[packet * 4..][..4];
            store_vec4(out.position, position);
            let to = &mut batch.varyings[packet * varyings..][..varyings];
            out.varyings.store(&mut PacketSink { left: to });
            if T::WRITES_POINT_SIZE {
                let size = out.point_size.unwrap_or(input.zero.splat(1.0));
                size.store_array(&mut batch.point_sizes[packet].0);
            }
        }
    }

    #[inline(always)]
    fn fragments<S: Lanes>(&self, simd: S, bindings: &Bindings, batch: FragmentBatch<'_>) {
        let varyings = self.interface.varyings.len();
        let targets = self.interface.color_targets;
        for packet in 0..batch.coverage.len() {
            let zero = <f32x16<S> as SimdBase<S>>::splat(simd, 0.0);
            let position = if T::READS_POSITION {
                let p = &batch.positions[packet * 4..][..4];
                let [x, y, z, w] = [&p[0], &p[1], &p[2], &p[3]];
                Vec4::new(load(simd, x), load(simd, y), load(simd, z), load(simd, w))
            } else {
                Vec4::new(zero, zero, zero, zero)
            };
            let front_facing = simd.mask_from_bits(batch.front_facing[packet]);
            let input = FragmentIn {
                position,
                front_facing,
                bindings,
                zero,
            };
            let from = &batch.varyings[packet * varyings..][..varyings];
            let loaded = T::Varyings::load(&mut PacketSource { simd, left: from });
            let out = self.shader.fragment(input, loaded);
            for (index, to) in batch.colors[packet * targets * 4..][..targets * 4]
                .chunks_exact_mut(4)
                .enumerate()
            {
                let color = out.colors[index].unwrap_or(Vec4::new(zero, zero, zero, zero));
                store_vec4(color, to);
            }
            if T::DISCARDS
                && let Some(keep) = out.keep
            {
                batch.coverage[packet] &= simd.bits_of_mask(keep);
            }
            if !matches!(T::DEPTH_OUTPUT, super::DepthOutput::None) {
                out.depth
                    .unwrap_or(position.z)
                    .store_array(&mut batch.depths[packet].0);
            }
        }
    }
}

#[inline(always)]
fn load<S: Lanes>(simd: S, packet: &Packet<f32>) -> f32x16<S> {
    f32x16::load_array_ref(simd, &packet.0)
}

#[inline(always)]
fn ints<S: Lanes>(simd: S, packet: &Packet<u32>) -> i32x16<S> {
    u32x16::load_array_ref(simd, &packet.0).bitcast()
}

#[inline(always)]
fn store_vec4<S: Lanes>(value: Vec4<f32x16<S>>, to: &mut [Packet<f32>]) {
    if let [x, y, z, w] = to {
        value.x.store_array(&mut x.0);
        value.y.store_array(&mut y.0);
        value.z.store_array(&mut z.0);
        value.w.store_array(&mut w.0);
    }
}

/// Scalars of one packet, read in order.
struct PacketSource<'a, S> {
    simd: S,
    left: &'a [Packet<f32>],
}

impl<S: Lanes> Source<f32x16<S>> for PacketSource<'_, S> {
    #[inline(always)]
    fn take(&mut self) -> f32x16<S> {
        match self.left.split_first() {
            Some((first, rest)) => {
                self.left = rest;
                load(self.simd, first)
            }
            // Never: the slice has as many packets as the type has scalars.
            None => SimdBase::splat(self.simd, 0.0),
        }
    }
}

/// Scalars of one packet, written in order.
struct PacketSink<'a> {
    left: &'a mut [Packet<f32>],
}

impl<S: Lanes> Sink<f32x16<S>> for PacketSink<'_> {
    #[inline(always)]
    fn put(&mut self, value: f32x16<S>) {
        if let Some((first, rest)) = std::mem::take(&mut self.left).split_first_mut() {
            value.store_array(&mut first.0);
            self.left = rest;
        }
    }
}
