//! Pipeline statistics and timestamps of ranges of a pass's draws.

use super::PassErrorKind;
use crate::Statistics;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// Pipeline statistics and timestamps of ranges of a pass's draws (Vulkan's
/// `VK_QUERY_TYPE_PIPELINE_STATISTICS` and `VK_QUERY_TYPE_TIMESTAMP`).
///
/// Where a range begins or ends, the draws before are finished before the next one begins, so that
/// counts and times belong to the range alone. The image does not change; but no draw hides
/// fragments of another one across these places, and a pass with many ranges takes longer.
///
/// ```
/// use estampe::RangeQueries;
///
/// // The opaque draws, the transparent ones, and all of them.
/// let queries = RangeQueries::new([0..40, 40..60, 0..60]);
/// // device.render(&RenderPass { range_queries: Some(&queries), … })?;
/// assert_eq!(queries.result(1), None, "no pass has been drawn yet");
/// ```
#[derive(Debug, Default)]
pub struct RangeQueries {
    ranges: Vec<Range<usize>>,
    results: Mutex<Vec<RangeResult>>,
}

/// The statistics and timestamps of a range of draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RangeResult {
    /// The work of each stage.
    pub statistics: Statistics,
    /// When the first draw began, since the device was created.
    pub begin: Duration,
    /// When the last draw was finished, since the device was created.
    pub end: Duration,
}

impl RangeQueries {
    /// Queries of these ranges of draws, which may overlap. Draws are numbered from 0.
    #[must_use]
    pub fn new(ranges: impl IntoIterator<Item = Range<usize>>) -> Self {
        Self {
            ranges: ranges.into_iter().collect(),
            results: Mutex::default(),
        }
    }

    /// The ranges of draws.
    #[must_use]
    pub fn ranges(&self) -> &[Range<usize>] {
        &self.ranges
    }

    /// The result of a range in the pass drawn last; `None` before the first pass, after one that
    /// was cancelled, and beyond the last range.
    #[must_use]
    pub fn result(&self, range: usize) -> Option<RangeResult> {
        let results = self.results.lock().unwrap_or_else(PoisonError::into_inner);
        results.get(range).copied()
    }

    pub(super) fn check(&self, draws: usize) -> Result<(), PassErrorKind> {
        let fits = |range: &Range<usize>| range.start <= range.end && range.end <= draws;
        match self.ranges.iter().position(|range| !fits(range)) {
            None => Ok(()),
            Some(query) => Err(PassErrorKind::QueryRange {
                query,
                range: self.ranges[query].clone(),
                draws,
            }),
        }
    }

    /// Where ranges begin or end, with the first and the last draw, in ascending order.
    fn cuts(&self, draws: usize) -> Vec<usize> {
        let ends = self
            .ranges
            .iter()
            .flat_map(|range| [range.start, range.end]);
        let mut cuts: Vec<usize> = ends.chain([0, draws]).collect();
        cuts.sort_unstable();
        cuts.dedup();
        cuts
    }

    /// Keeps the results of a pass.
    pub(super) fn set(&self, parts: &Parts) {
        let results = self.ranges.iter().map(|range| {
            let within = |cut: &[usize]| range.start <= cut[0] && cut[1] <= range.end;
            let mut statistics = Statistics::default();
            for (cut, part) in parts.cuts.windows(2).zip(&parts.statistics) {
                if within(cut) {
                    statistics += *part;
                }
            }
            let time = |draw: usize| {
                let at = parts.cuts.iter().position(|cut| *cut == draw);
                at.and_then(|at| parts.times.get(at).copied())
            };
            RangeResult {
                statistics,
                begin: time(range.start).unwrap_or_default(),
                end: time(range.end).unwrap_or_default(),
            }
        });
        let results = results.collect();
        *self.results.lock().unwrap_or_else(PoisonError::into_inner) = results;
    }

    /// Forgets the results of the pass before.
    pub(super) fn reset(&self) {
        let mut results = self.results.lock().unwrap_or_else(PoisonError::into_inner);
        results.clear();
    }
}

/// The parts of a pass that are drawn one after the other.
#[derive(Debug)]
pub(super) struct Parts {
    /// The first draw of each part, and the number of draws.
    pub(super) cuts: Vec<usize>,
    /// The statistics of each part.
    pub(super) statistics: Vec<Statistics>,
    /// When each part began, and when the last one was finished.
    pub(super) times: Vec<Duration>,
}

impl Parts {
    /// The parts between the ranges' ends. A pass without draws has one part, which clears.
    pub(super) fn new(queries: &RangeQueries, draws: usize) -> Self {
        let cuts = if draws == 0 {
            vec![0, 0]
        } else {
            queries.cuts(draws)
        };
        Self {
            statistics: Vec::with_capacity(cuts.len() - 1),
            times: Vec::with_capacity(cuts.len()),
            cuts,
        }
    }
}
