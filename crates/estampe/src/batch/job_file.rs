//! Job files: pictures with options of their own, as TOML or JSON.

use super::look::{JobOptions, Look, first_line};
use super::option_table::OptionTable;
use crate::failure::Failure;
use crate::input::read_file;
use crate::values::shown;
use clap::Parser;
use estampe_assets::Limits;
use serde::Deserialize;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct JobFile {
    /// Options of all jobs; those of a job replace them one by one.
    #[serde(default)]
    options: OptionTable,
    jobs: Vec<Entry>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    input: PathBuf,
    output: String,
    #[serde(default)]
    options: OptionTable,
}

/// A job of a file.
pub(super) struct FileJob {
    pub(super) input: PathBuf,
    /// A template.
    pub(super) output: String,
    pub(super) look: Arc<Look>,
}

/// The jobs of a file in their order; their options replace those of the preset.
pub(super) fn read(path: &Path, preset: &OptionTable) -> Result<Vec<FileJob>, Failure> {
    let name = shown(path);
    let bytes = read_file(path, &Limits::default())?;
    let text = std::str::from_utf8(&bytes)
        .map_err(|error| Failure::Usage(format!("{name}: {error}; write the job file as UTF-8")))?;
    let is_json = path
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("json"));
    let file: JobFile = if is_json {
        serde_json::from_str(text).map_err(|error| Failure::Usage(format!("{name}: {error}")))?
    } else {
        toml::from_str(text).map_err(|error| {
            let start = error.span().map_or(0, |span| span.start);
            let before = text.as_bytes().get(..start).unwrap_or_default();
            let line = 1 + before.iter().filter(|byte| **byte == b'\n').count();
            Failure::Usage(format!("{name}, line {line}: {}", error.message()))
        })?
    };
    let JobFile { options, jobs } = file;
    let options = preset.overridden_by(&options);
    let jobs = jobs.into_iter().enumerate();
    jobs.map(|(at, entry)| {
        let options = options.overridden_by(&entry.options);
        let parsed = JobOptions::try_parse_from(options.words()).map_err(|error| {
            let (number, input) = (at + 1, shown(&entry.input));
            let problem = first_line(&error);
            Failure::Usage(format!("{name}, job {number} ({input}): {problem}"))
        })?;
        Ok(FileJob {
            input: entry.input,
            output: entry.output,
            look: Arc::new(Look::new(parsed)?),
        })
    })
    .collect()
}
