//! The packet code: filtering of sixteen lanes at once.
//!
//! It gives the same results as the scalar code in `sample.rs`, for the formats of [`PacketFormat`]
//! in every dimension, with every filter. Requests are packets in memory, and the code dispatches
//! to its SIMD level itself, so it is compiled once, in this crate, and not into every shader.
//!
//! Linear filtering of formats of bytes is in `bytes.rs`, the common case of a packet of other
//! formats in `inside.rs`; everything else takes the general code in `general.rs`. Gathers are in
//! `gather.rs`.
//!
//! If the texels of a lane are not all within its level, and that needs more than a wrapped index
//! (a border, a cube's edge), the scalar code samples the lane again: there are few such lanes.

mod ahead;
mod batch;
mod block;
mod bytes;
mod each_level;
mod face;
mod filter;
mod footprint;
mod gather;
mod general;
mod inside;
mod places;
mod planes;
mod shifts;
mod square;
mod taps;
mod wrapped;

pub(crate) use super::packet_texel::PacketFormat;
pub(crate) use each_level::LevelTable;
pub use shifts::TapShifts;
pub(super) use taps::MOST_TAPS;

use super::coordinates::{Answers, answer, load};
use super::packet_texel::{OTHERS, R8, RGBA8, RGBA8_SRGB, RGBA16F};
use super::{PacketRequest, SampledTexture};
use estampe_simd::{LANES, Packet as Values, dispatch};
use estampe_types::Real;
use estampe_types::state::CompareFunction;

impl SampledTexture {
    /// Samples or compares sixteen lanes. Returns the lanes that the scalar code sampled; `None`,
    /// with nothing stored, if packet code cannot do it.
    #[inline(always)]
    pub(crate) fn sample_packet(
        &self,
        lanes: &PacketRequest<'_>,
        answers: &mut Answers,
        compares: bool,
    ) -> Option<u32> {
        let format = self.packets?;
        if lanes.count != LANES {
            return None;
        }
        let compares = compares.then(|| self.sampler.compare.unwrap_or(CompareFunction::Never));
        let packet = Packet {
            of: self,
            format,
            lanes,
            compares,
            is_simple: self.is_simple && compares.is_none() && lanes.offset == [0; 3],
        };
        // Comparisons need one channel only, and many formats have only one.
        let again = if compares.is_some() {
            packet.enter::<1>(answers)
        } else {
            packet.enter_kind(answers)
        }?;
        for lane in 0..LANES {
            if again >> lane & 1 == 1 {
                let channels = if compares.is_some() {
                    self.compare_lane(lanes, lane)
                } else {
                    self.sample_lane(lanes, lane)
                };
                answer(answers, lane, channels);
            }
        }
        Some(again)
    }
}

/// A request for sixteen lanes.
struct Packet<'a> {
    of: &'a SampledTexture,
    format: PacketFormat,
    lanes: &'a PacketRequest<'a>,
    compares: Option<CompareFunction>,
    /// True if view, sampler and request allow the common case.
    is_simple: bool,
}

impl Packet<'_> {
    /// Samples the packet with the code for the kind of its format; returns the lanes that the
    /// scalar code must sample again.
    fn enter_kind(&self, answers: &mut Answers) -> Option<u32> {
        if self.lanes.offset == [0; 3]
            && let Some(table) = self.of.level_table.as_deref()
        {
            return match self.format.kind() {
                R8 => self.enter_bytes::<R8>(table, answers),
                RGBA8 => self.enter_bytes::<RGBA8>(table, answers),
                RGBA8_SRGB => self.enter_bytes::<RGBA8_SRGB>(table, answers),
                _ => unreachable!("only formats of bytes have a table"),
            };
        }
        match self.format.kind() {
            R8 => self.enter_special::<1, R8>(answers),
            RGBA8 => self.enter_special::<4, RGBA8>(answers),
            RGBA8_SRGB => self.enter_special::<4, RGBA8_SRGB>(answers),
            RGBA16F => self.enter_special::<4, RGBA16F>(answers),
            _ => self.enter_any(answers),
        }
    }

    /// Samples the packet with code for one kind of format, where the SIMD level has some.
    fn enter_special<const C: usize, const KIND: u8>(&self, answers: &mut Answers) -> Option<u32> {
        dispatch!(@specialized_move self.of.level, s => {
            Some(self.sample::<_, C, KIND>(s, answers))
        }, others => self.enter_any(answers))
    }

    /// Samples the packet with the code for all formats.
    fn enter_any(&self, answers: &mut Answers) -> Option<u32> {
        if self.format.components == 1 {
            self.enter::<1>(answers)
        } else {
            self.enter::<4>(answers)
        }
    }

    /// Samples the packet with the code for all formats of up to `C` channels; returns the lanes
    /// that the scalar code must sample again. The scalar SIMD level has no packet code.
    fn enter<const C: usize>(&self, answers: &mut Answers) -> Option<u32> {
        dispatch!(@wide_move self.of.level, s => {
            Some(self.sample::<_, C, OTHERS>(s, answers))
        }, scalar => None)
    }

    /// The coordinates of the lanes.
    #[inline(always)]
    fn coordinates<R: Real>(&self, like: R) -> [R; 3] {
        [
            load(like, self.lanes.at[0], 0),
            load(like, self.lanes.at[1], 0),
            load(like, self.lanes.at[2], 0),
        ]
    }
}

/// Sets the channels that a format of one component does not store.
#[inline(always)]
pub(super) fn only_red([_, green, blue, alpha]: &mut Answers) {
    (*green, *blue) = (Values::default(), Values::default());
    alpha.0 = [1.0; LANES];
}
