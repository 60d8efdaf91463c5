//! Series of measurements: frames of one kind with growing numbers of elements.

use super::fit::Line;
use crate::clock::process_cpu_time;
use crate::frame::PreparedScene;
use crate::measure::median;
use std::ops::RangeBounds;
use std::time::{Duration, Instant};

/// The cost of a frame, in milliseconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cost {
    /// The number of triangles or pixels.
    pub count: f64,
    /// Wall time, median.
    pub wall_ms: f64,
    /// CPU time of all threads, median.
    pub cpu_ms: f64,
}

/// The costs of frames of one kind, on one number of threads.
#[derive(Debug, Clone)]
pub struct Series {
    /// The name of the kind.
    pub name: &'static str,
    /// The number of threads.
    pub threads: usize,
    /// The costs, by count.
    pub costs: Vec<Cost>,
}

/// The time for which frames are drawn to take a median, within limits of their number.
const TIME: Duration = Duration::from_millis(250);
const FEWEST: usize = 5;
const MOST: usize = 400;
/// Frames that take this long are drawn three times, after one to warm up.
const LONG: Duration = Duration::from_millis(400);
/// Frames that take this long are drawn once, after one to warm up: over such a time disturbances
/// average out.
const VERY_LONG: Duration = Duration::from_secs(2);

impl Cost {
    /// Measures a frame with `count` elements.
    pub fn measure(scene: &mut PreparedScene<'_>, count: f64) -> Self {
        // The first frame allocates, and the second still has cold caches.
        let start = Instant::now();
        scene.draw();
        let first = start.elapsed();
        let fewest = if first >= VERY_LONG {
            1
        } else if first >= LONG {
            3
        } else {
            scene.draw();
            FEWEST
        };
        let (mut wall, mut cpu) = (Vec::new(), Vec::new());
        let start = Instant::now();
        while wall.len() < fewest || (start.elapsed() < TIME && wall.len() < MOST) {
            let (frame, frame_cpu) = (Instant::now(), process_cpu_time());
            scene.draw();
            wall.push(frame.elapsed().as_secs_f64() * 1e3);
            let spent = process_cpu_time().saturating_sub(frame_cpu);
            cpu.push(spent.as_secs_f64() * 1e3);
        }
        Self {
            count,
            wall_ms: median(wall),
            cpu_ms: median(cpu),
        }
    }
}

impl Series {
    /// (count, ms) for the counts in a range.
    #[must_use]
    pub fn points(&self, counts: &impl RangeBounds<f64>, ms: fn(&Cost) -> f64) -> Vec<[f64; 2]> {
        let costs = self.costs.iter();
        let costs = costs.filter(|cost| counts.contains(&cost.count));
        costs.map(|cost| [cost.count, ms(cost)]).collect()
    }

    /// The line through the counts in a range, and its largest relative error.
    #[must_use]
    pub fn fit(&self, counts: &impl RangeBounds<f64>, ms: fn(&Cost) -> f64) -> Option<(Line, f64)> {
        let points = self.points(counts, ms);
        let line = Line::through(&points)?;
        Some((line, line.deviation(&points)))
    }
}
