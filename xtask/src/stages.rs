//! Stage order: inside `estampe-core` a stage names no later stage.
//!
//! Data flows one way, so a stage may import what an earlier one puts out and never the other way
//! round. The check reads `crate::`, `super::` and `self::` paths, so that it also sees code inside
//! macros; a stage must name a type by its owner's path, because a re-export at the crate's root
//! would hide whose it is. Tests are free to name anything.

use std::path::Path;

use crate::repository::TextFile;
use crate::rust_source::{PathUse, code_only, relative_paths, tokens, without_test_items};
use crate::{Finding, Repository};

/// The part that a module of the core plays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Role {
    /// Words that every stage uses; names no stage itself.
    Foundation,
    /// The stage with this place in the order.
    Stage(usize),
    /// Calls the stages, so it may name them all; no stage may name it.
    Conductor,
}

/// Which module of a crate plays which part. Paths are modules below the crate's root.
#[derive(Debug)]
struct Order {
    /// The folder of the sources.
    sources: &'static str,
    /// See [`Role::Foundation`].
    foundations: &'static [&'static str],
    /// See [`Role::Stage`]; in pipeline order. A folder's own `mod.rs` counts as its last stage.
    stages: &'static [&'static str],
    /// See [`Role::Conductor`].
    conductors: &'static [&'static str],
}

const CORE: Order = Order {
    sources: "crates/estampe-core/src",
    // `tiles` is the one boundary between the two sides: both import it.
    foundations: &[
        "commands",
        "layout",
        "pipeline",
        "recording",
        "statistics",
        "tiles",
    ],
    stages: &[
        "geometry::viewport",
        "geometry::rows",
        "geometry::fetch",
        "geometry::shading",
        "geometry::positions",
        "geometry::assembly",
        "geometry::restart",
        "geometry::cull",
        "geometry::between",
        "geometry::clip",
        "geometry::line_style",
        "geometry::binning",
        "geometry::depth_bias",
        "geometry::setup",
        "geometry::chunk",
        "raster",
        "fragment",
        "per_sample",
        "attachment",
    ],
    conductors: &["draw", "schedule", "tile_pass", "wave"],
};

/// The one module of the core that may name rayon.
const RAYON_HOME: &str = "schedule";

/// Checks that no stage of `estampe-core` names a later one, and that only its scheduler knows of
/// threads.
#[must_use]
pub fn check_stages(repository: &Repository) -> Vec<Finding> {
    repository
        .rust_files()
        .filter(|file| file.path.starts_with(CORE.sources) && !file.is_test())
        .flat_map(|file| CORE.check_file(file))
        .collect()
}

impl Order {
    fn check_file(&self, file: &TextFile) -> Vec<Finding> {
        let module = self.module_of(&file.path);
        let module: Vec<&str> = module.iter().map(String::as_str).collect();
        if module.is_empty() {
            return Vec::new();
        }
        let Some(own_role) = self.role(&module) else {
            return vec![Finding::error(
                &file.path,
                0,
                format!(
                    "module `{}` has no place in the stage order: give it one in xtask/src/stages.rs",
                    module.join("::")
                ),
            )];
        };

        let code = code_only(&file.text);
        let tokens = tokens(&code);
        let tokens = without_test_items(&tokens);
        let mut findings: Vec<Finding> = relative_paths(&tokens)
            .iter()
            .filter_map(|path| {
                let message = self.objection(own_role, &module, path)?;
                Some(Finding::error(&file.path, path.line, message))
            })
            .collect();
        if module[0] != RAYON_HOME {
            findings.extend(
                tokens
                    .iter()
                    .filter(|token| token.text == "rayon")
                    .map(|token| {
                        Finding::error(
                            &file.path,
                            token.line,
                            format!(
                                "only `{RAYON_HOME}` knows of threads: hand it the work instead"
                            ),
                        )
                    }),
            );
        }
        findings
    }

    /// Why a module with `own_role` may not use `path`, if it may not.
    fn objection(&self, own_role: Role, module: &[&str], path: &PathUse<'_>) -> Option<String> {
        let named = resolve(module, &path.segments);
        if own_role == Role::Conductor || named.is_empty() || named == ["self"] {
            return None;
        }
        let shown = named.join("::");
        let Some(role) = self.role(&named) else {
            return Some(format!(
                "`{shown}` hides whose it is: name it by the path of the module that owns it"
            ));
        };
        match (own_role, role) {
            (_, Role::Foundation) => None,
            (Role::Stage(own), Role::Stage(other)) if other <= own => None,
            (Role::Stage(own), Role::Stage(other)) => Some(format!(
                "stage `{}` names the later stage `{}` (`{shown}`): data flows one way",
                self.stages[own], self.stages[other]
            )),
            (Role::Stage(_) | Role::Foundation, Role::Conductor) => Some(format!(
                "`{shown}` calls the stages: none of them may name it"
            )),
            (Role::Foundation, Role::Stage(_)) => Some(format!(
                "`{shown}` is a stage: what all stages use may name none"
            )),
            (Role::Conductor, _) => None,
        }
    }

    /// The role of the longest known module at the head of `path`.
    fn role(&self, path: &[&str]) -> Option<Role> {
        (1..=path.len()).rev().find_map(|len| {
            let module = path[..len].join("::");
            if let Some(stage) = self.stages.iter().position(|name| *name == module) {
                Some(Role::Stage(stage))
            } else if self.foundations.contains(&module.as_str()) {
                Some(Role::Foundation)
            } else if self.conductors.contains(&module.as_str()) {
                Some(Role::Conductor)
            } else {
                self.role_of_folder(&module, path.get(len))
            }
        })
    }

    /// A folder of stages is as late as the last of them. A module in it that the table does not know
    /// has no role.
    fn role_of_folder(&self, folder: &str, child: Option<&&str>) -> Option<Role> {
        let is_module = child.is_some_and(|name| name.starts_with(char::is_lowercase));
        let prefix = format!("{folder}::");
        let last = self
            .stages
            .iter()
            .rposition(|name| name.starts_with(&prefix))?;
        (!is_module).then_some(Role::Stage(last))
    }

    /// The module that a source file is, below the crate's root; empty for the root itself.
    fn module_of(&self, path: &Path) -> Vec<String> {
        let below = path
            .strip_prefix(self.sources)
            .expect("only files of the crate are checked");
        let mut module: Vec<String> = below
            .with_extension("")
            .iter()
            .map(|part| part.to_string_lossy().into_owned())
            .collect();
        if matches!(
            module.last().map(String::as_str),
            Some("mod" | "lib" | "main")
        ) {
            module.pop();
        }
        module
    }
}

/// The path below the crate's root that `segments`, written in `module`, names.
fn resolve<'a>(module: &[&'a str], segments: &[&'a str]) -> Vec<&'a str> {
    let mut named = match segments.first() {
        Some(&"crate") | None => Vec::new(),
        Some(_) => module.to_vec(),
    };
    for &segment in segments {
        match segment {
            "crate" | "self" => {}
            "super" => {
                named.pop();
            }
            _ => named.push(segment),
        }
    }
    named
}

#[cfg(test)]
mod tests;
