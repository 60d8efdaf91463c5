//! The report of `estampe sheet`: a line of text, or a JSON object.

use super::arguments::SheetArgs;
use super::job::{Done, Status};
use super::layout::Layout;
use crate::failure::Failure;
use crate::render;
use crate::values::Source;
use estampe_assets::image::ImageFormat;
use serde_json::{Value, json};
use std::io::Write;
use std::time::Duration;

/// A sheet that was written.
pub(super) struct Report<'a> {
    pub(super) args: &'a SheetArgs,
    pub(super) layout: Layout,
    pub(super) models: &'a [Source],
    /// Of the views of a model.
    pub(super) views: &'a [Option<String>],
    pub(super) done: &'a [Done],
    pub(super) format: ImageFormat,
    pub(super) bytes: usize,
    pub(super) time: Duration,
}

/// Numbers of cells.
#[derive(Debug, Clone, Copy, Default)]
struct Counts {
    drawn: usize,
    failed: usize,
    limit: usize,
}

impl Report<'_> {
    /// True if every cell was drawn.
    pub(super) fn is_complete(&self) -> bool {
        let counts = self.counts();
        counts.failed + counts.limit == 0
    }

    fn counts(&self) -> Counts {
        let mut counts = Counts::default();
        for status in self.done.iter().flat_map(|one| &one.statuses) {
            *match status {
                Status::Drawn => &mut counts.drawn,
                Status::Failed(_) => &mut counts.failed,
                Status::Limit(_) => &mut counts.limit,
            } += 1;
        }
        counts
    }

    /// Writes the object, or the line of text, as the options say.
    pub(super) fn write(&self) -> Result<(), Failure> {
        if self.args.report.json {
            return render::write_json(&self.json(), &self.args.output);
        }
        if !self.args.report.quiet {
            // If standard error is closed, the line is lost.
            let _ = writeln!(std::io::stderr(), "{}", self.line());
        }
        Ok(())
    }

    fn line(&self) -> String {
        let counts = self.counts();
        let mut parts = vec![format!("{} drawn", counts.drawn)];
        for (count, what) in [(counts.failed, "failed"), (counts.limit, "over a limit")] {
            if count > 0 {
                parts.push(format!("{count} {what}"));
            }
        }
        let [width, height] = self.layout.size();
        format!(
            "{}: {width}x{height}, {} in {:.1} s",
            render::output_name(&self.args.output),
            parts.join(", "),
            self.time.as_secs_f64()
        )
    }

    fn json(&self) -> Value {
        let [width, height] = self.layout.size();
        let Counts {
            drawn,
            failed,
            limit,
        } = self.counts();
        json!({
            "output": {
                "path": render::output_path(&self.args.output),
                "format": format!("{:?}", self.format).to_lowercase(),
                "width": width,
                "height": height,
                "columns": self.layout.columns,
                "rows": self.layout.rows,
                "bytes": self.bytes,
            },
            "cells": self.cells(),
            "counts": { "drawn": drawn, "failed": failed, "limit": limit },
            "milliseconds": render::rounded_milliseconds(self.time),
        })
    }

    fn cells(&self) -> Vec<Value> {
        let [width, height] = self.layout.picture;
        let mut cells = Vec::new();
        for (model, done) in self.models.iter().zip(self.done) {
            for (view, status) in self.views.iter().zip(&done.statuses) {
                let [x, y] = self.layout.corner(cells.len());
                cells.push(json!({
                    "model": model.name(),
                    "view": view,
                    "x": x,
                    "y": y,
                    "width": width,
                    "height": height,
                    "status": match status {
                        Status::Drawn => "drawn",
                        Status::Failed(_) => "failed",
                        Status::Limit(_) => "limit",
                    },
                    "error": status.problem(),
                    "warnings": done.warnings,
                }));
            }
        }
        cells
    }
}
