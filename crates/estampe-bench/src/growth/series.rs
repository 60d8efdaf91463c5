//! Series of measurements: the same kind of frame with more and more in it.

use super::fit::Line;
use crate::clock::process_cpu_time;
use crate::frame::PreparedScene;
use crate::measure::median;
use std::ops::RangeBounds;
use std::time::{Duration, Instant};

/// What a frame takes, in milliseconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cost {
    /// How many triangles or pixels.
    pub count: f64,
    /// Wall time, median.
    pub wall_ms: f64,
    /// CPU time of all threads, median.
    pub cpu_ms: f64,
}

/// Frames of one kind, drawn by so many threads.
#[derive(Debug, Clone)]
pub struct Series {
    /// What kind.
    pub name: &'static str,
    /// How many threads.
    pub threads: usize,
    /// What they took, by count.
    pub costs: Vec<Cost>,
}

/// How many frames are drawn to take a median: for so long, between so many.
const TIME: Duration = Duration::from_millis(250);
const FEWEST: usize = 5;
const MOST: usize = 400;
/// Frames of this length and longer are drawn three times, after one to warm up.
const LONG: Duration = Duration::from_millis(400);
/// Frames of this length and longer are drawn once, after one to warm up: so long a time is a mean by itself.
const VERY_LONG: Duration = Duration::from_secs(2);

impl Cost {
    /// Measures a frame that has `count` of something.
    pub fn measure(scene: &mut PreparedScene<'_>, count: f64) -> Self {
        // The first frame allocates, and the second still finds cold caches.
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
    /// (count, ms) of the counts in a range.
    #[must_use]
    pub fn points(&self, counts: &impl RangeBounds<f64>, ms: fn(&Cost) -> f64) -> Vec<[f64; 2]> {
        let costs = self.costs.iter();
        let costs = costs.filter(|cost| counts.contains(&cost.count));
        costs.map(|cost| [cost.count, ms(cost)]).collect()
    }

    /// The line through the counts in a range, and how far the farthest is from it.
    #[must_use]
    pub fn fit(&self, counts: &impl RangeBounds<f64>, ms: fn(&Cost) -> f64) -> Option<(Line, f64)> {
        let points = self.points(counts, ms);
        let line = Line::through(&points)?;
        Some((line, line.deviation(&points)))
    }
}
