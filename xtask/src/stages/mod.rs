//! Stage order: inside `estampe-core` a module names no later stage.
//!
//! Data flows one way: a stage may import what an earlier one puts out, never the other way round.
//! The check reads the paths that start at `crate`, `super` and `self`, inside macros too. A module
//! must name a type by the path of the module that defines it, because a re-export at the crate's
//! root would hide which stage that is. Tests may name anything.

use std::path::Path;

use crate::repository::TextFile;
use crate::rust_source::{RelativePath, RustSource};
use crate::{Finding, Repository};

/// The folder of the checked sources.
const SOURCES: &str = "crates/estampe-core/src";

/// The modules of the core in layers: a module may name those of its own layer and of the layers
/// above it in this table. A module inside a folder belongs to the folder's layer unless it has a
/// row of its own.
const LAYERS: &[&[&str]] = &[
    // Plain data and state, which both sides of the pipeline name.
    &[
        "bounds",
        "commands",
        "depth_format",
        "layout",
        "pipeline",
        "profile",
        "recycle",
        "segments",
        "statistics",
        "tile_path",
    ],
    // The stages of geometry.
    &[
        "geometry::ahead",
        "geometry::viewport",
        "geometry::facing",
        "geometry::depth_bias",
        "geometry::line_style",
        "geometry::assembly",
    ],
    &["geometry::plan", "geometry::shaded_vertices"],
    &["geometry::fetch"],
    &["geometry::shading"],
    &["geometry::groups", "geometry::run", "geometry::restart"],
    &["geometry::cull", "geometry::cull_uncovered"],
    &[
        "geometry::vertex_order",
        "geometry::tile_edges",
        "geometry::waiting",
        "geometry::rectangles",
    ],
    &["geometry::setup", "geometry::binning"],
    &["geometry::clip", "geometry::clip_positions"],
    &["geometry"],
    // The stages of a tile.
    &["raster"],
    &["fragment"],
    &["per_sample"],
    &["attachment"],
    // The modules that call the stages.
    &["plan", "schedule"],
    &["amplification"],
    &["draw", "amplified_pass", "tile_pass"],
    &["transfer"],
];

/// The one module of the core that may name rayon.
const THREADS: &str = "schedule";

/// Checks that no module of `estampe-core` names a later layer, and that only its scheduler names
/// rayon.
#[must_use]
pub fn check_stages(repository: &Repository) -> Vec<Finding> {
    repository
        .rust_files()
        .filter(|file| file.path.starts_with(SOURCES) && !file.is_test())
        .flat_map(check_file)
        .collect()
}

fn check_file(file: &TextFile) -> Vec<Finding> {
    let module = module_of(&file.path);
    // The crate's root re-exports from all layers. The check of files reports what is not Rust.
    let (false, Ok(source)) = (module.is_empty(), RustSource::parse(&file.text)) else {
        return Vec::new();
    };
    let Some(layer) = layer_of(&module) else {
        let message = format!(
            "module `{}` has no layer: give it one in {}",
            module.join("::"),
            file!()
        );
        return vec![Finding::error(&file.path, 0, message)];
    };
    let source = source.without_test_items();
    let mut findings: Vec<Finding> = source
        .relative_paths()
        .iter()
        .filter_map(|path| {
            let message = objection(&module, layer, path)?;
            Some(Finding::error(&file.path, path.line, message))
        })
        .collect();
    if module[0] != THREADS {
        let identifiers = source.identifiers();
        let named = identifiers.iter().filter(|found| found.name == "rayon");
        findings.extend(named.map(|found| {
            let message = format!("only `{THREADS}` may start threads: pass the work to it");
            Finding::error(&file.path, found.line, message)
        }));
    }
    findings
}

/// Why `module`, in `layer`, may not use `path`, if it may not.
fn objection(module: &[String], layer: usize, path: &RelativePath) -> Option<String> {
    let named = resolve(module, &path.segments);
    let shown = named.join("::");
    // The last layer calls the stages and may name the crate's root.
    if named.is_empty() || layer == LAYERS.len() - 1 {
        return None;
    }
    match layer_of(&named) {
        None => Some(format!(
            "`{shown}` hides its stage: name it by the path of the module that defines it"
        )),
        Some(other) if other > layer => Some(format!(
            "`{}` names `{shown}` of a later layer: data flows one way, see {}",
            module.join("::"),
            file!()
        )),
        Some(_) => None,
    }
}

/// The layer of the longest row at the head of `path`.
fn layer_of(path: &[String]) -> Option<usize> {
    (1..=path.len()).rev().find_map(|len| {
        let module = path[..len].join("::");
        LAYERS
            .iter()
            .position(|layer| layer.contains(&module.as_str()))
    })
}

/// The module that a source file is, below the crate's root; empty for the root itself.
fn module_of(path: &Path) -> Vec<String> {
    let below = path
        .strip_prefix(SOURCES)
        .expect("only files of the crate are checked");
    let below = below.with_extension("");
    let parts = below.iter().map(|part| part.to_string_lossy().into_owned());
    parts
        .filter(|part| part != "mod" && part != "lib")
        .collect()
}

/// The path below the crate's root that `segments`, written in `module`, names.
fn resolve(module: &[String], segments: &[String]) -> Vec<String> {
    let is_absolute = segments.first().is_some_and(|first| first == "crate");
    let mut named = if is_absolute {
        Vec::new()
    } else {
        module.to_vec()
    };
    for segment in segments {
        match segment.as_str() {
            "crate" | "self" => {}
            "super" => {
                named.pop();
            }
            _ => named.push(segment.clone()),
        }
    }
    named
}

#[cfg(test)]
mod tests;
