//! The models of a sheet, in order, and their names.

use super::arguments::SheetArgs;
use crate::batch::inputs::{list, matches, pattern};
use crate::failure::Failure;
use crate::values::{Source, shown};
use std::path::Path;

/// The models of the arguments in their order; those of a glob are sorted.
pub(super) fn models(args: &SheetArgs) -> Result<Vec<Source>, Failure> {
    let mut models = Vec::new();
    for argument in &args.inputs {
        if argument == "-" {
            models.extend(list()?.into_iter().map(Source::File));
            continue;
        }
        let source = Source::from(argument.clone());
        match pattern(argument).filter(|_| matches!(source, Source::File(_))) {
            Some(pattern) => models.extend(matches(pattern)?.into_iter().map(Source::File)),
            None => models.push(source),
        }
    }
    if models.is_empty() {
        return Err(Failure::Input(
            "standard input: the list has no model; check the program that writes it".to_owned(),
        ));
    }
    Ok(models)
}

/// The file's name, or that of the built-in model.
pub(super) fn name(model: &Source) -> String {
    part(model, Path::file_name)
}

/// The name without its extension.
pub(super) fn stem(model: &Source) -> String {
    part(model, Path::file_stem)
}

fn part(model: &Source, of: fn(&Path) -> Option<&std::ffi::OsStr>) -> String {
    match model {
        Source::File(path) => shown(of(path).map_or(path.as_path(), Path::new)),
        Source::Builtin(name) => name.clone(),
        Source::StandardInput => model.name(),
    }
}
