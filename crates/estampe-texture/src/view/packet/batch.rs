//! Many packets of a texture of bytes: the code of the SIMD level is entered once for all of them.
//!
//! One by one, what a packet costs beside its texels was as much as these in `ui`.

use super::{LevelTable, Packet, PacketFormat};
use crate::view::coordinates::{Answers, answer};
use crate::view::packet_texel::{R8, RGBA8, RGBA8_SRGB};
use crate::view::{PacketRequest, SampledTexture};
use estampe_simd::{LANES, dispatch};

impl SampledTexture {
    /// Samples requests with linear filtering; the answers of each are `step` after those of the
    /// one before. `false`, with nothing stored, if there is no such code for all of them.
    pub(crate) fn sample_packets(
        &self,
        requests: &[PacketRequest<'_>],
        answers: &mut [Answers],
        step: usize,
    ) -> bool {
        let (Some(format), Some(table)) = (self.packets, self.level_table.as_deref()) else {
            return false;
        };
        let is_common =
            |request: &PacketRequest<'_>| request.count == LANES && request.offset == [0; 3];
        if self.sampler.max_anisotropy > 1 || !requests.iter().all(is_common) {
            return false;
        }
        let of = (format, table);
        match format.kind() {
            R8 => self.enter_packets::<R8>(of, requests, (answers, step)),
            RGBA8 => self.enter_packets::<RGBA8>(of, requests, (answers, step)),
            RGBA8_SRGB => self.enter_packets::<RGBA8_SRGB>(of, requests, (answers, step)),
            _ => unreachable!("only formats of bytes have a table"),
        }
    }

    fn enter_packets<const KIND: u8>(
        &self,
        (format, table): (PacketFormat, &LevelTable),
        requests: &[PacketRequest<'_>],
        (answers, step): (&mut [Answers], usize),
    ) -> bool {
        dispatch!(@specialized self.level, s => {
            for (lanes, answers) in requests.iter().zip(answers.iter_mut().step_by(step)) {
                let packet = Packet {
                    of: self,
                    format,
                    lanes,
                    compares: None,
                    is_simple: self.is_simple,
                };
                match packet.sample_bytes::<_, KIND>(s, table, answers) {
                    Some(0) => {}
                    again => self.sample_again(lanes, again.unwrap_or(u32::MAX), answers),
                }
            }
            true
        }, others => false)
    }

    /// Samples some lanes one by one.
    #[cold]
    fn sample_again(&self, lanes: &PacketRequest<'_>, again: u32, answers: &mut Answers) {
        for lane in (0..LANES).filter(|lane| again >> lane & 1 == 1) {
            answer(answers, lane, self.sample_lane(lanes, lane));
        }
    }
}
