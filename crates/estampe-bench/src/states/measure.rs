//! Timing of a state against its baseline: frames of both in turn, so that disturbances by other
//! processes affect both equally.

use super::case::Case;
use crate::clock;
use crate::measure::median;
use std::time::{Duration, Instant};

/// The length of the measurement of a state with a load.
#[derive(Debug, Clone, Copy)]
pub(super) struct Effort {
    /// The least number of pairs of frames.
    pairs: usize,
    /// The least time.
    time: Duration,
}

impl Effort {
    /// For published tables.
    pub(super) const THOROUGH: Self = Self {
        pairs: 7,
        time: Duration::from_millis(250),
    };
    /// For a quick look.
    pub(super) const QUICK: Self = Self {
        pairs: 3,
        time: Duration::from_millis(10),
    };
}

/// The greatest number of pairs, even if the frames are short.
const MAX_PAIRS: usize = 101;

/// The cost of a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cost {
    /// CPU time of a frame in nanoseconds, median.
    pub(super) frame_ns: f64,
    /// The median, over pairs of frames, of the state's CPU time divided by the baseline's. It is
    /// per fragment if the numbers of fragments differ.
    pub(super) ratio: f64,
}

/// Measures a state and its baseline in turn.
pub(super) fn measure(baseline: &mut Case<'_>, state: &mut Case<'_>, effort: Effort) -> Cost {
    // The first frames take memory from the system.
    baseline.draw();
    state.draw();
    let start = Instant::now();
    let mut pairs = Vec::new();
    while pairs.len() < effort.pairs || (start.elapsed() < effort.time && pairs.len() < MAX_PAIRS) {
        pairs.push([frame_ns(baseline), frame_ns(state)]);
    }
    let fragments = |case: &Case<'_>| case.fragments().max(1) as f64;
    cost(&pairs, fragments(baseline) / fragments(state))
}

/// The cost from pairs of times [baseline, state]; the ratio is multiplied by `scale`.
fn cost(pairs: &[[f64; 2]], scale: f64) -> Cost {
    let ratios = pairs
        .iter()
        .map(|[baseline, state]| state / baseline.max(1.0) * scale);
    Cost {
        frame_ns: median(pairs.iter().map(|pair| pair[1]).collect()),
        ratio: median(ratios.collect()),
    }
}

fn frame_ns(case: &mut Case<'_>) -> f64 {
    let before = clock::process_cpu_time();
    case.draw();
    clock::process_cpu_time()
        .saturating_sub(before)
        .as_secs_f64()
        * 1e9
}

#[cfg(test)]
mod tests {
    use super::{Cost, cost};

    #[test]
    fn a_disturbance_of_both_frames_leaves_the_ratio() {
        let pairs = [[10.0, 30.0], [40.0, 120.0], [10.0, 31.0]];
        let expected = Cost {
            frame_ns: 31.0,
            ratio: 3.0,
        };
        assert_eq!(cost(&pairs, 1.0), expected);
        assert_eq!(cost(&pairs, 2.0).ratio, 6.0);
    }
}
