//! The report of `estampe diff`, as sentences and as JSON.

use std::io::{self, Write};
use std::path::Path;

use estampe_scene::Image;
use serde_json::{Value, json};

use super::DiffArgs;
use super::compare::Comparison;
use super::flip::FlipMap;

/// The results of a comparison.
#[derive(Debug)]
pub(crate) struct Report<'a> {
    /// The command line.
    pub(crate) args: &'a DiffArgs,
    pub(crate) a: &'a Image,
    pub(crate) b: &'a Image,
    /// `None` if the sizes differ.
    pub(crate) comparison: Option<Comparison>,
    /// `None` if the sizes differ.
    pub(crate) flip: Option<&'a FlipMap>,
    /// The path of the heat map, if one was written.
    pub(crate) heatmap: Option<&'a Path>,
}

impl Report<'_> {
    /// True if no channel of any pixel differs by more than the limit.
    pub(crate) fn is_same(&self) -> bool {
        self.comparison
            .is_some_and(|comparison| comparison.pixels_over_limit == 0)
    }
}

/// Writes sentences and a small table.
pub(crate) fn write_text(report: &Report<'_>, out: &mut dyn Write) -> io::Result<()> {
    let (a, b) = (report.args.a.display(), report.args.b.display());
    let (Some(comparison), Some(flip)) = (report.comparison, report.flip) else {
        return writeln!(
            out,
            "{a} is {} × {} pixels and {b} is {} × {}: images of different sizes are not the same.",
            report.a.width, report.a.height, report.b.width, report.b.height
        );
    };
    if comparison.is_identical() {
        writeln!(out, "{a} and {b} are identical.")?;
    } else {
        let limit = report.args.max;
        match (report.is_same(), limit) {
            (true, _) => writeln!(out, "{a} and {b} are the same within {limit} of 255.")?,
            (false, 0) => writeln!(out, "{a} and {b} differ.")?,
            (false, _) => writeln!(
                out,
                "{a} and {b} differ: {} pixels by more than {limit} of 255.",
                comparison.pixels_over_limit
            )?,
        }
        let share = 100.0 * comparison.differing_pixels as f64 / comparison.pixels as f64;
        writeln!(
            out,
            "  pixels   {} of {} differ ({share:.2} %)",
            comparison.differing_pixels, comparison.pixels
        )?;
        let [r, g, b, alpha] = comparison.max;
        writeln!(out, "  maximum  R {r}  G {g}  B {b}  A {alpha}  (of 255)")?;
        let [r, g, b, alpha] = comparison.mean;
        writeln!(out, "  mean     R {r:.3}  G {g:.3}  B {b:.3}  A {alpha:.3}")?;
        writeln!(
            out,
            "  FLIP     {:.4} mean, {:.4} at most (0: no perceived difference, 1: the greatest)",
            flip.mean(),
            flip.max()
        )?;
    }
    match report.heatmap {
        Some(path) => writeln!(out, "  heat map {}", path.display()),
        None => Ok(()),
    }
}

/// Writes one JSON object on one line; the command's help lists the fields.
pub(crate) fn write_json(report: &Report<'_>, out: &mut dyn Write) -> io::Result<()> {
    let picture = |path: &Path, image: &Image| json!({ "path": path.to_string_lossy(), "width": image.width, "height": image.height });
    let channels = |[r, g, b, a]: [Value; 4], all: Value| json!({ "r": r, "g": g, "b": b, "a": a, "all": all });
    let of = |f: &dyn Fn(&Comparison) -> Value| report.comparison.as_ref().map_or(Value::Null, f);
    let object = json!({
        "a": picture(&report.args.a, report.a),
        "b": picture(&report.args.b, report.b),
        "same": report.is_same(),
        "identical": report.comparison.is_some_and(|comparison| comparison.is_identical()),
        "limit": report.args.max,
        "pixels": of(&|c| c.pixels.into()),
        "differing_pixels": of(&|c| c.differing_pixels.into()),
        "pixels_over_limit": of(&|c| c.pixels_over_limit.into()),
        "max": of(&|c| channels(c.max.map(Value::from), c.max_of_all().into())),
        "mean": of(&|c| channels(c.mean.map(Value::from), c.mean_of_all().into())),
        "flip": report.flip.map(|flip| json!({ "mean": flip.mean(), "max": flip.max() })),
        "heatmap": report.heatmap.map(|path| path.to_string_lossy()),
    });
    writeln!(out, "{object}")
}
