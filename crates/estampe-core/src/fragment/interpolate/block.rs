//! A triangle's varyings at a block of 16×16 pixels: columns and rows of packets share the products
//! of planes, and how a scalar varies is asked once.
//!
//! The arithmetic of each pixel is that of `triangle.rs`, in the same order, so the bits are the
//! same.

use super::planes::PlaneBlock;
use super::triangle::TriangleInterpolant;
use crate::bounds::plane::Plane;
use estampe_simd::{LANES, Lanes, Packet, SimdBase, f32x16};
use estampe_types::Interpolation;

impl TriangleInterpolant<'_> {
    /// [`varyings`](super::Interpolant::varyings) of all sixteen packets of the block that begins at
    /// the target's pixel (x, y), so many scalars of each.
    #[inline(always)]
    pub(crate) fn varyings_of_block<S: Lanes>(
        &self,
        s: S,
        pixel: [i32; 2],
        (out, scalars): (&mut [Packet<f32>], usize),
    ) {
        if scalars == 0 {
            return;
        }
        let n = scalars.min(self.planes.len());
        let mut w = [Packet([1.0; LANES]); LANES];
        if !self.equal_w {
            let one = <f32x16<S> as SimdBase<S>>::splat(s, 1.0);
            let iw = self.block_of(s, &self.iw, pixel);
            for (packet, w) in w.iter_mut().enumerate() {
                (one / iw.at(packet)).store_array(&mut w.0);
            }
        }
        for k in 0..n {
            let mode = self.mode(k);
            let of_packets = out.chunks_exact_mut(scalars);
            if mode == Interpolation::Flat {
                for out in of_packets {
                    out[k].0 = [self.planes.of(k).origin; LANES];
                }
                continue;
            }
            let plane = self.block_of(s, &self.planes.of(k), pixel);
            if self.equal_w || mode != Interpolation::Smooth {
                for (packet, out) in of_packets.enumerate() {
                    plane.at(packet).store_array(&mut out[k].0);
                }
            } else {
                for (packet, (out, w)) in of_packets.zip(&w).enumerate() {
                    let value = plane.at(packet) * f32x16::load_array_ref(s, &w.0);
                    value.store_array(&mut out[k].0);
                }
            }
        }
        if !self.gradients.is_empty() {
            for (out, w) in out.chunks_exact_mut(scalars).zip(&w) {
                let (values, derivatives) = out.split_at_mut(n);
                let w = f32x16::load_array_ref(s, &w.0);
                self.derivatives(s, (values, derivatives), w);
            }
        }
    }

    /// A plane of the triangle at the centres of a block's pixels.
    #[inline(always)]
    pub(crate) fn block_of<S: Lanes>(&self, s: S, plane: &Plane, pixel: [i32; 2]) -> PlaneBlock<S> {
        PlaneBlock::new(s, &self.origin, plane, pixel, [0.5; 2])
    }
}
