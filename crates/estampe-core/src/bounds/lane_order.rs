//! Orders in which fragments take the values of their primitives, which are the lanes of a packet.

use estampe_simd::{Bytes, LANES, Lanes, Packet, SimdBase, Window, f32x16, floats_of, u32x16};
use std::slice;

/// An order in which lanes take the values of their primitives.
pub(crate) trait LaneOrder<S: Lanes>: Copy {
    fn permuted(self, s: S, values: &[f32; LANES]) -> f32x16<S>;

    #[inline(always)]
    fn permuted_words(self, s: S, values: &Packet<u32>) -> u32x16<S> {
        let [values] = floats_of(slice::from_ref(values)) else {
            unreachable!("one packet");
        };
        self.permuted(s, &values.0).bitcast()
    }
}

impl<S: Lanes> LaneOrder<S> for u32x16<S> {
    #[inline(always)]
    fn permuted(self, s: S, values: &[f32; LANES]) -> f32x16<S> {
        s.permute_f32(f32x16::load_array_ref(s, values), self)
    }

    #[inline(always)]
    fn permuted_words(self, s: S, values: &Packet<u32>) -> Self {
        s.permute(Self::load_array_ref(s, &values.0), self)
    }
}

impl<S: Lanes> LaneOrder<S> for Window<S> {
    #[inline(always)]
    fn permuted(self, s: S, values: &[f32; LANES]) -> f32x16<S> {
        self.permute_f32(s, values)
    }
}

/// Any order, and its window if it has one. Each permutation asks which it is, so code that
/// permutes by it is compiled once.
#[derive(Debug, Clone, Copy)]
pub(crate) enum AnyOrder<S: Lanes> {
    Window(Window<S>),
    Lanes(u32x16<S>),
}

impl<S: Lanes> AnyOrder<S> {
    #[inline(always)]
    pub(crate) fn new(s: S, order: u32x16<S>) -> Self {
        if const { S::HAS_WINDOWS }
            && let Some(window) = Window::new(s, order)
        {
            return Self::Window(window);
        }
        Self::Lanes(order)
    }
}

impl<S: Lanes> LaneOrder<S> for AnyOrder<S> {
    #[inline(always)]
    fn permuted(self, s: S, values: &[f32; LANES]) -> f32x16<S> {
        match self {
            Self::Window(window) => window.permuted(s, values),
            Self::Lanes(order) => order.permuted(s, values),
        }
    }
}
