//! A Markdown table for each frame size and number of cores.

use super::results::Measured;
use crate::frame::FrameSize;
use crate::picture::Difference;
use std::fmt::Write as _;

/// The scenes at one size on one number of cores.
#[derive(Debug, Clone)]
pub struct Table {
    /// The frame's size.
    pub size: FrameSize,
    /// The number of cores.
    pub cores: usize,
    /// A line per scene.
    pub lines: Vec<Line>,
}

/// A scene, drawn by both renderers.
#[derive(Debug, Clone)]
pub struct Line {
    /// The measurement of estampe.
    pub ours: Measured,
    /// The measurement of the peer.
    pub theirs: Measured,
    /// The difference of the pictures.
    pub difference: Difference,
    /// The least time that the machine allows, in milliseconds, if the scene has a single bound.
    pub limit: Option<f64>,
}

impl Line {
    /// The peer's time divided by ours.
    #[must_use]
    pub fn ratio(&self) -> f64 {
        self.theirs.median_ms / self.ours.median_ms
    }

    fn markdown(&self) -> String {
        let Self {
            ours,
            theirs,
            difference,
            limit,
        } = self;
        let share = limit.map_or(String::new(), |limit| {
            format!("{:.0} %", limit / ours.median_ms * 100.0)
        });
        let off = match difference.beyond {
            0 => "0".to_owned(),
            _ => format!("{:.4} %", difference.share_beyond() * 100.0),
        };
        let verdict = if difference.passes() {
            ""
        } else {
            " **too many**"
        };
        let data = if ours.fingerprint == theirs.fingerprint {
            ""
        } else {
            " (other data!)"
        };
        let dropped = if ours.visibility_runs > 0 {
            "yes"
        } else {
            "no"
        };
        format!(
            "| {}{data} | {} | {} | {} | {} | {:.2} | {share} | {} ({}) | {off}{verdict} | {dropped} |",
            ours.scene,
            milliseconds(theirs.median_ms),
            milliseconds(theirs.cpu_ms),
            milliseconds(ours.median_ms),
            milliseconds(ours.cpu_ms),
            self.ratio(),
            milliseconds(ours.readback_ms),
            milliseconds(ours.copy_ms),
        )
    }
}

impl Table {
    /// An empty table.
    #[must_use]
    pub fn new(size: FrameSize, cores: usize) -> Self {
        Self {
            size,
            cores,
            lines: Vec::new(),
        }
    }

    /// The geometric mean of the ratios; 1 if there are none.
    #[must_use]
    pub fn mean_ratio(&self) -> f64 {
        // The n-th root of the product by bisection: no logarithm is needed.
        let product: f64 = self.lines.iter().map(Line::ratio).product();
        root(product, self.lines.len())
    }

    /// The table as Markdown, with a heading.
    #[must_use]
    pub fn markdown(&self) -> String {
        let cores = if self.cores == 1 { "core" } else { "cores" };
        let mut text = format!("### {}, {} {cores}\n\n", self.size, self.cores);
        text += "| scene | lavapipe ms | CPU ms | estampe ms | CPU ms | ratio | of the limit | to rows ms (copy) | \
                 pixels off | hidden work dropped |\n|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n";
        for line in &self.lines {
            let _ = writeln!(text, "{}", line.markdown());
        }
        let mean = self.mean_ratio();
        let _ = writeln!(text, "| geometric mean | | | | | **{mean:.2}** | | | | |");
        text
    }
}

/// The positive n-th root.
fn root(value: f64, n: usize) -> f64 {
    let Ok(power) = i32::try_from(n) else {
        return 1.0;
    };
    if power == 0 || !value.is_finite() || value <= 0.0 {
        return 1.0;
    }
    // The root lies between 1 and the value; bisection is precise enough for a table.
    let (mut low, mut high) = (value.min(1.0), value.max(1.0));
    for _ in 0..100 {
        let middle = (low + high) * 0.5;
        if middle.powi(power) < value {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// A time in milliseconds with about three digits.
fn milliseconds(value: f64) -> String {
    let decimals = match value {
        v if v < 1.0 => 3,
        v if v < 10.0 => 2,
        _ => 1,
    };
    format!("{value:.decimals$}")
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    pub(crate) fn line(scene: &str, theirs_ms: f64, ours_ms: f64) -> Line {
        let measured = |median_ms: f64| Measured {
            scene: scene.to_owned(),
            w: 64,
            h: 48,
            fingerprint: "0f".to_owned(),
            median_ms,
            cpu_ms: median_ms * 2.0,
            other_cores: 0.0,
            readback_ms: 0.25,
            copy_ms: 0.125,
            fragments: 0,
            visibility_runs: 0,
        };
        Line {
            ours: measured(ours_ms),
            theirs: measured(theirs_ms),
            difference: Difference {
                pixels: 10_000,
                beyond: 7,
                ..Difference::default()
            },
            limit: Some(ours_ms * 0.5),
        }
    }

    #[test]
    fn a_line_says_what_was_measured() {
        let mut line = line("fill", 20.0, 4.0);
        let expected =
            "| fill | 20.0 | 40.0 | 4.00 | 8.00 | 5.00 | 50 % | 0.250 (0.125) | 0.0700 % | no |";
        assert_eq!(line.markdown(), expected);
        line.ours.fingerprint = "1f".to_owned();
        line.ours.visibility_runs = 9;
        line.limit = None;
        line.difference.beyond = 51;
        let text = line.markdown();
        assert!(text.contains("(other data!)") && text.contains("too many"));
        assert!(text.contains("| 5.00 |  | 0.250 (0.125) |") && text.ends_with("| yes |"));
    }

    #[test]
    fn the_mean_is_geometric() {
        let mut table = Table::new(
            FrameSize {
                width: 64,
                height: 48,
            },
            2,
        );
        assert_eq!(table.mean_ratio(), 1.0);
        table.lines = vec![
            line("a", 8.0, 1.0),
            line("b", 1.0, 2.0),
            line("c", 16.0, 1.0),
        ];
        assert!((table.mean_ratio() - 4.0).abs() < 1e-9);
        let text = table.markdown();
        assert!(text.starts_with("### 64x48, 2 cores\n\n| scene |"));
        assert!(text.ends_with("| geometric mean | | | | | **4.00** | | | | |\n"));
        // Every row has as many cells as the header.
        let cells = |line: &str| line.matches('|').count();
        assert!(text.lines().skip(2).all(|line| cells(line) == 11));
        assert!((root(0.001, 3) - 0.1).abs() < 1e-9);
    }
}
