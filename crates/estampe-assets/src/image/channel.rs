//! Channels of texels that bit masks describe (BMP, DDS), and premultiplied alpha.

/// A run of bits within a texel of up to 32 bits. Zero bits are an absent channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Channel {
    /// The lowest bit.
    shift: u32,
    /// The largest value: 2^bits − 1.
    max: u32,
}

impl Channel {
    /// The channel of a mask. `None` if the bits of the mask are not adjacent.
    pub(super) fn of_mask(mask: u32) -> Option<Self> {
        let shift = if mask == 0 { 0 } else { mask.trailing_zeros() };
        let max = mask >> shift;
        // 2^n − 1 and its successor have no bit in common.
        (u64::from(max) & (u64::from(max) + 1) == 0).then_some(Self { shift, max })
    }

    /// True if the channel has no bits.
    pub(super) fn is_absent(self) -> bool {
        self.max == 0
    }

    /// The channel of `texel` as 8 bits: round(v · 255 / max); 0 if it is absent.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "v is at most max, so the quotient is at most 255"
    )]
    pub(super) fn unorm8(self, texel: u32) -> u8 {
        let (value, max) = (texel >> self.shift & self.max, u64::from(self.max));
        let scaled = u64::from(value) * 255 + max / 2;
        scaled.checked_div(max).unwrap_or(0) as u8
    }
}

/// `color` ÷ `alpha`, rounded. Colours brighter than their alpha saturate; alpha 0 gives black.
pub(super) fn unmultiplied(color: u8, alpha: u8) -> u8 {
    let (color, alpha) = (u32::from(color), u32::from(alpha));
    let quotient = (color * 255 + alpha / 2).checked_div(alpha).unwrap_or(0);
    u8::try_from(quotient).unwrap_or(255)
}

#[cfg(test)]
mod tests {
    use super::{Channel, unmultiplied};

    #[test]
    fn every_width_covers_the_range_of_bytes() {
        for bits in 1..=32_u32 {
            for shift in 0..=32 - bits {
                let max = u32::MAX >> (32 - bits);
                let channel = Channel::of_mask(max << shift).expect("adjacent bits");
                let noise = !(max << shift);
                assert_eq!(channel.unorm8(noise), 0, "{bits} bits at {shift}");
                assert_eq!(channel.unorm8(u32::MAX), 255, "{bits} bits at {shift}");
                let half = f64::from(max / 2) / f64::from(max) * 255.0;
                let read = channel.unorm8((max / 2) << shift | noise);
                assert!(
                    (f64::from(read) - half).abs() <= 0.5,
                    "{read} is not {half}"
                );
            }
        }
    }

    #[test]
    fn masks_with_gaps_are_refused_and_empty_ones_are_absent() {
        for mask in [0b101, 0x8000_0001, 0xff00_00ff] {
            assert_eq!(Channel::of_mask(mask), None, "{mask:#x}");
        }
        let absent = Channel::of_mask(0).expect("no bits");
        assert!(absent.is_absent() && absent.unorm8(u32::MAX) == 0);
    }

    #[test]
    fn alpha_is_divided_out() {
        assert_eq!(unmultiplied(64, 128), 128);
        assert_eq!(unmultiplied(200, 100), 255);
        assert_eq!(unmultiplied(9, 0), 0);
        assert!((0..=255).map(|c| unmultiplied(c, 255)).eq(0..=255));
    }
}
