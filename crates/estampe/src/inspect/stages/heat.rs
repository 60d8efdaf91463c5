//! Colours of numbers: light yellow for one, through orange and red, to nearly black.

/// An RGB colour, 0 to 255 as the file stores it.
pub(super) type Rgb = [u8; 3];

/// The colour of zero and of what is empty.
pub(super) const NOTHING: Rgb = [234, 237, 242];

/// The colours of even steps from 1 to the greatest number.
const STOPS: [Rgb; 6] = [
    [255, 241, 178],
    [254, 204, 92],
    [253, 141, 60],
    [227, 48, 30],
    [139, 0, 50],
    [38, 4, 36],
];

/// The colour of a count from 0 to the greatest one.
pub(super) fn heat(count: u32, greatest: u32) -> Rgb {
    match count {
        0 => NOTHING,
        _ if greatest <= 1 => STOPS[2],
        _ => share(f64::from(count - 1) / f64::from(greatest - 1)),
    }
}

/// The colour of a number from 0 to 1.
pub(super) fn share(share: f64) -> Rgb {
    let at = share.clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    let from = (0..STOPS.len() - 1)
        .rev()
        .find(|&stop| stop as f64 <= at)
        .unwrap_or(0);
    mix(STOPS[from], STOPS[from + 1], at - from as f64)
}

/// The mean of two colours; 0 is the first.
pub(super) fn mix(from: Rgb, to: Rgb, share: f64) -> Rgb {
    [0, 1, 2].map(|channel: usize| {
        let (a, b) = (f64::from(from[channel]), f64::from(to[channel]));
        code(a + (b - a) * share)
    })
}

/// The nearest code.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "`as` saturates"
)]
pub(super) fn code(value: f64) -> u8 {
    (value + 0.5) as u8
}

/// Black or white, whichever is read on a colour.
pub(super) fn ink_on([r, g, b]: Rgb) -> Rgb {
    let light = 3 * u32::from(r) + 6 * u32::from(g) + u32::from(b);
    if light > 1300 { [20, 24, 32] } else { [255; 3] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_run_through_all_stops() {
        assert_eq!(heat(0, 9), NOTHING);
        assert_eq!((heat(1, 6), heat(6, 6)), (STOPS[0], STOPS[5]));
        assert_eq!((heat(3, 6), heat(1, 1)), (STOPS[2], STOPS[2]));
        assert_eq!(share(-1.0), STOPS[0]);
        assert_eq!(mix([0, 10, 100], [10, 10, 0], 0.5), [5, 10, 50]);
    }
}
