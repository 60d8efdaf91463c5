//! A Markdown table for each frame size and number of cores.

use super::results::Measured;
use crate::frame::FrameSize;
use crate::picture::Difference;
use crate::scene::{SceneGroup, ShaderLanguage};
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

/// What estampe measured with shaders in a language.
#[derive(Debug, Clone)]
pub struct Ours {
    /// The language of the shaders.
    pub language: ShaderLanguage,
    /// The measurement.
    pub measured: Measured,
}

/// A scene, drawn by both renderers.
#[derive(Debug, Clone)]
pub struct Line {
    /// The scene's name.
    pub scene: &'static str,
    /// The scenes that it is shown with.
    pub group: SceneGroup,
    /// The measurements of estampe, in the order of languages; at least one.
    pub ours: Vec<Ours>,
    /// The measurement of the peer.
    pub theirs: Measured,
    /// The difference of the pictures; of several languages, the largest.
    pub difference: Difference,
    /// The least time that the machine allows, in milliseconds, if the scene has a single bound.
    pub limit: Option<f64>,
}

impl Line {
    /// The peer's time divided by ours in a language; `None` if the scene is not drawn in it.
    #[must_use]
    pub fn ratio(&self, language: ShaderLanguage) -> Option<f64> {
        Some(self.theirs.min_ms / self.of(language)?.min_ms)
    }

    fn of(&self, language: ShaderLanguage) -> Option<&Measured> {
        let ours = self.ours.iter().find(|ours| ours.language == language);
        Some(&ours?.measured)
    }

    fn markdown(&self) -> String {
        let Self {
            ours,
            theirs,
            difference,
            limit,
            ..
        } = self;
        let Some(Ours { measured: ours, .. }) = ours.first() else {
            return String::new();
        };
        let share = limit.map_or(String::new(), |limit| {
            format!("{:.0} %", limit / ours.min_ms * 100.0)
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
        let mut text = format!("| {}{data} | {} |", self.scene, milliseconds(theirs.min_ms));
        for language in ShaderLanguage::ALL {
            let cells = self.of(language).zip(self.ratio(language));
            let cells = cells.map_or_else(
                || "  |  ".to_owned(),
                |(ours, ratio)| format!("{} | {ratio:.2}", milliseconds(ours.min_ms)),
            );
            let _ = write!(text, " {cells} |");
        }
        let _ = write!(
            text,
            " {share} | {} ({}) | {off}{verdict} | {dropped} |",
            milliseconds(ours.readback_ms),
            milliseconds(ours.copy_ms),
        );
        text
    }
}

/// The columns of a table.
const HEADER: &str = "| scene | lavapipe ms | Rust ms | ratio | WGSL ms | ratio | contracted ms | ratio | \
                      of the limit | to rows ms (copy) | pixels off | hidden work dropped |\n\
                      |---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n";

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

    /// The geometric mean of the ratios of a group, or of all scenes, in a language; `None` if no
    /// scene is drawn in it.
    #[must_use]
    pub fn mean_ratio(&self, group: Option<SceneGroup>, language: ShaderLanguage) -> Option<f64> {
        let lines = self.lines.iter();
        let lines = lines.filter(|line| group.is_none_or(|group| line.group == group));
        let ratios: Vec<f64> = lines.filter_map(|line| line.ratio(language)).collect();
        // The n-th root of the product by bisection: no logarithm is needed.
        (!ratios.is_empty()).then(|| root(ratios.iter().product(), ratios.len()))
    }

    /// The table as Markdown, with a heading.
    #[must_use]
    pub fn markdown(&self) -> String {
        let cores = if self.cores == 1 { "core" } else { "cores" };
        let mut text = format!("#### {}, {} {cores}\n\n{HEADER}", self.size, self.cores);
        for group in SceneGroup::ALL {
            let lines: Vec<&Line> = (self.lines.iter())
                .filter(|line| line.group == group)
                .collect();
            for line in &lines {
                let _ = writeln!(text, "{}", line.markdown());
            }
            if !lines.is_empty() {
                text += &self.mean_line(Some(group), group.title());
            }
        }
        text += &self.mean_line(None, "all");
        text
    }

    fn mean_line(&self, group: Option<SceneGroup>, title: &str) -> String {
        let mut text = format!("| *mean of {title}* | |");
        for language in ShaderLanguage::ALL {
            let mean = self.mean_ratio(group, language);
            let mean = mean.map_or(String::new(), |mean| format!("**{mean:.2}**"));
            let _ = write!(text, " | {mean} |");
        }
        text += " | | | |\n";
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
    use crate::scene::SceneEntry;

    pub(crate) fn line(scene: &'static str, theirs_ms: f64, ours_ms: f64) -> Line {
        let measured = |min_ms: f64| Measured {
            scene: scene.to_owned(),
            w: 64,
            h: 48,
            fingerprint: "0f".to_owned(),
            min_ms,
            readback_ms: 0.25,
            copy_ms: 0.125,
            fragments: 0,
            visibility_runs: 0,
        };
        let ours = [
            (ShaderLanguage::Rust, ours_ms),
            (ShaderLanguage::Wgsl, ours_ms * 2.0),
        ];
        Line {
            scene,
            group: SceneEntry::named(scene).unwrap().group,
            ours: ours
                .map(|(language, ms)| Ours {
                    language,
                    measured: measured(ms),
                })
                .to_vec(),
            theirs: measured(theirs_ms),
            difference: Difference {
                pixels: 10_000,
                beyond: 7,
                ..Difference::default()
            },
            limit: Some(ours_ms * 0.5),
        }
    }

    fn table(cores: usize) -> Table {
        let size = FrameSize {
            width: 64,
            height: 48,
        };
        Table::new(size, cores)
    }

    #[test]
    fn a_line_says_what_was_measured() {
        let mut line = line("fill", 20.0, 4.0);
        let expected = "| fill | 20.0 | 4.00 | 5.00 | 8.00 | 2.50 |   |   | 50 % | 0.250 (0.125) | 0.0700 % | no |";
        assert_eq!(line.markdown(), expected);
        line.ours[0].measured.fingerprint = "1f".to_owned();
        line.ours[0].measured.visibility_runs = 9;
        line.limit = None;
        line.difference.beyond = 51;
        let text = line.markdown();
        assert!(text.contains("(other data!)") && text.contains("too many"));
        assert!(text.contains("|  | 0.250 (0.125) |") && text.ends_with("| yes |"));
    }

    #[test]
    fn means_are_geometric_and_by_group() {
        let mut table = table(2);
        assert_eq!(table.mean_ratio(None, ShaderLanguage::Rust), None);
        table.lines = vec![
            line("fill", 8.0, 1.0),
            line("blend", 1.0, 2.0),
            line("wire", 128.0, 1.0),
        ];
        let mean = |group, language| table.mean_ratio(group, language).unwrap();
        let features = Some(SceneGroup::Features);
        assert!((mean(features, ShaderLanguage::Rust) - 2.0).abs() < 1e-9);
        assert!((mean(features, ShaderLanguage::Wgsl) - 1.0).abs() < 1e-9);
        assert!((mean(None, ShaderLanguage::Rust) - 8.0).abs() < 1e-9);
        let text = table.markdown();
        assert!(text.starts_with("#### 64x48, 2 cores\n\n| scene |"));
        assert!(text.contains("| *mean of the eleven scenes* | | | **2.00** | | **1.00** | |  |"));
        assert!(text.ends_with("| *mean of all* | | | **8.00** | | **4.00** | |  | | | | |\n"));
        // Every row has as many cells as the header.
        let cells = |line: &str| line.matches('|').count();
        assert!(text.lines().skip(2).all(|line| cells(line) == 13), "{text}");
        assert!((root(0.001, 3) - 0.1).abs() < 1e-9);
    }
}
