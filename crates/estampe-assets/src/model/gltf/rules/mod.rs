//! Rules of the specification whose violation does not hinder the picture: they become warnings.
//!
//! The reader itself refuses files in which it needs something that it cannot interpret. This pass
//! looks at the whole document, also at parts that no chosen scene, animation or variant reaches,
//! and agrees there with Khronos's glTF validator. It takes time linear in the document and reads
//! no bytes of buffers. `docs/gltf-rules.md` lists the rules by the validator's codes, and those
//! that are not checked.

mod accessors;
mod animations;
mod declared;
mod materials;
mod meshes;
mod nodes;
mod references;
mod usage;

use super::document::Document;
use crate::model::load::Context;

/// Adds a warning for each violation.
pub(super) fn check(document: &Document<'_>, context: &mut Context<'_>) {
    let mut report = Report { context };
    references::check(document, &mut report);
    accessors::check(document, &mut report);
    usage::check(document, &mut report);
    meshes::check(document, &mut report);
    materials::check(document, &mut report);
    nodes::check(document, &mut report);
    animations::check(document, &mut report);
    declared::check(document, &mut report);
}

/// Collects the warnings. Texts are made for those alone that are kept.
struct Report<'c, 'a> {
    context: &'c mut Context<'a>,
}

impl Report<'_, '_> {
    fn warn(&mut self, pointer: impl FnOnce() -> String, what: impl FnOnce() -> String) {
        let name = self.context.name;
        let warnings = &mut self.context.warnings;
        warnings.add_at_json(name, || (pointer(), what()));
    }
}
