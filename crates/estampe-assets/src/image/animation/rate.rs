//! Frames per second, as a fraction.

/// A constant rate of frames: `frames` in `seconds`, in lowest terms.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FrameRate {
    frames: u16,
    seconds: u16,
}

impl FrameRate {
    /// The rate of `frames` in `seconds`; `None` if one of them is 0.
    #[must_use]
    pub fn new(frames: u16, seconds: u16) -> Option<Self> {
        let (mut a, mut b) = (frames, seconds);
        while b != 0 {
            (a, b) = (b, a % b);
        }
        (frames != 0 && seconds != 0).then(|| Self {
            frames: frames / a,
            seconds: seconds / a,
        })
    }

    /// The numerator of frames per second.
    #[must_use]
    pub fn frames(self) -> u16 {
        self.frames
    }

    /// The denominator of frames per second.
    #[must_use]
    pub fn seconds(self) -> u16 {
        self.seconds
    }

    /// The duration of a frame in whole units, of which a second has `units`. Frames end at rounded
    /// times, so durations differ by one unit where the rate asks for it, and do not drift.
    pub(crate) fn duration(self, frame: u64, units: u64) -> u64 {
        let end = |frame: u64| {
            let (time, per) = (
                frame * units * u64::from(self.seconds),
                u64::from(self.frames),
            );
            (2 * time + per) / (2 * per)
        };
        end(frame + 1) - end(frame)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_in_lowest_terms() {
        let rate = FrameRate::new(12_500, 1000).expect("not 0");
        assert_eq!((rate.frames(), rate.seconds()), (25, 2));
        assert_eq!(FrameRate::new(0, 1), None);
        assert_eq!(FrameRate::new(1, 0), None);
    }

    #[test]
    fn durations_do_not_drift() {
        for (frames, seconds) in [(12, 1), (25, 1), (30, 1), (30_000, 1001), (1, 10)] {
            let rate = FrameRate::new(frames, seconds).expect("not 0");
            let exact = 100.0 * f64::from(seconds) / f64::from(frames);
            let mut sum = 0;
            for frame in 0..1000 {
                let duration = rate.duration(frame, 100);
                assert!((duration as f64 - exact).abs() <= 1.0);
                sum += duration;
                assert!((sum as f64 - exact * (frame + 1) as f64).abs() <= 0.5 + 1e-6);
            }
        }
        let rate = FrameRate::new(12, 1).expect("not 0");
        let first: Vec<u64> = (0..4).map(|frame| rate.duration(frame, 100)).collect();
        assert_eq!(first, [8, 9, 8, 8]);
    }
}
