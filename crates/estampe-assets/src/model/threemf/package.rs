//! Packages: an archive whose parts refer to each other by name.
//!
//! `_rels/.rels` lists the relationships of the package itself; the one of the type `3dmodel` names
//! the part that the model starts with.
//!
//! Source: ECMA-376, Part 2, "Open Packaging Conventions", 2021.

use super::xml::Xml;
use super::zip::{self, Archive};
use crate::model::encoding::utf8_from_utf16;
use crate::model::gltf::percent_decoded;
use crate::model::load::Context;
use crate::{AssetError, Location};

const CONTENT_TYPES: &str = "[Content_Types].xml";
const RELATIONSHIPS: &str = "_rels/.rels";

/// A 3MF file.
pub(super) struct Package<'a> {
    archive: Archive<'a>,
}

/// True if the bytes are an archive with the parts of a package or of a 3D model.
pub(in crate::model) fn is_3mf(bytes: &[u8]) -> bool {
    if !bytes.starts_with(zip::SIGNATURE) {
        return false;
    }
    match Archive::open(bytes, 0) {
        Ok(archive) => { archive.names() }.any(|name| name == CONTENT_TYPES || is_model(name)),
        // A damaged archive: the error of its reader says how.
        Err(_) => {
            let name = bytes.get(30..).unwrap_or_default();
            [CONTENT_TYPES, RELATIONSHIPS, "3D/"]
                .iter()
                .any(|part| name.starts_with(part.as_bytes()))
        }
    }
}

/// True if a part has the usual name of a model.
fn is_model(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    name.starts_with("3d/") && name.ends_with(".model")
}

impl<'a> Package<'a> {
    /// Opens the package.
    pub(super) fn open(bytes: &'a [u8], context: &Context<'_>) -> Result<Self, AssetError> {
        if !bytes.starts_with(b"PK") {
            let advice = "check that the file is 3MF";
            return Err(
                AssetError::malformed("the file is no ZIP archive", advice).at(Location::Byte(0))
            );
        }
        let archive = Archive::open(bytes, context.limits.max_file_bytes)?;
        Ok(Self { archive })
    }

    /// The bytes of a part; `None` if there is none of this name.
    pub(super) fn bytes(&mut self, part: &str) -> Result<Option<Vec<u8>>, AssetError> {
        self.archive.read(part)
    }

    /// The text of a part, UTF-8 or UTF-16; `None` if there is none of this name.
    pub(super) fn text(
        &mut self,
        part: &str,
        context: &Context<'_>,
    ) -> Result<Option<String>, AssetError> {
        let Some(bytes) = self.bytes(part)? else {
            return Ok(None);
        };
        let bytes = match utf8_from_utf16(&bytes) {
            Some(text) => text,
            None => bytes,
        };
        String::from_utf8(bytes).map(Some).map_err(|error| {
            let at = error.utf8_error().valid_up_to() as u64;
            AssetError::malformed("the text is not UTF-8", "export the file again")
                .at(Location::Byte(at))
                .in_file(&format!("{}, {part}", context.name))
        })
    }

    /// The name of the part that the model starts with.
    pub(super) fn start(&mut self, context: &mut Context<'_>) -> Result<String, AssetError> {
        if let Some(text) = self.text(RELATIONSHIPS, context)? {
            let mut xml = Xml::new(&text, RELATIONSHIPS, context);
            if let Some(part) = start_of_relationships(&mut xml)? {
                return Ok(part);
            }
        }
        let mut models = self.archive.names().filter(|name| is_model(name));
        if let (Some(model), None) = (models.next(), models.next()) {
            context.warnings.add(context.name, None, || {
                format!("the package does not name its model; `{model}` is read")
            });
            return Ok(model.to_owned());
        }
        Err(AssetError::malformed(
            "the package does not name the part with its 3D model",
            "check that the file is 3MF and no other kind of package",
        ))
    }
}

/// The target of the relationship to the model.
fn start_of_relationships(xml: &mut Xml<'_>) -> Result<Option<String>, AssetError> {
    const START: &str = "/3dmodel";
    let mut start = None;
    if xml.child()?.is_none() {
        return Ok(None);
    }
    while let Some(tag) = xml.child()? {
        let (mut kind, mut target) = (None, None);
        for attribute in xml.attributes(&tag) {
            match attribute? {
                ("Type", value) => kind = Some(value),
                ("Target", value) => target = Some(value),
                _ => {}
            }
        }
        if kind.is_some_and(|kind| kind.ends_with(START)) && start.is_none() {
            let target = target.ok_or_else(|| xml.missing("Target"))?;
            start = Some(part_name(&xml.unescaped(&target)?, "", xml)?);
        }
        xml.skip()?;
    }
    Ok(start)
}

/// The name of the part that `target` refers to, from the part `from`.
pub(super) fn part_name(target: &str, from: &str, xml: &Xml<'_>) -> Result<String, AssetError> {
    let decoded = percent_decoded(target);
    let target = String::from_utf8_lossy(&decoded);
    let (mut parts, target) = match target.strip_prefix('/') {
        Some(target) => (Vec::new(), target),
        None => {
            let mut folders: Vec<&str> = from.split('/').collect();
            folders.pop();
            (folders, &*target)
        }
    };
    for part in target.split('/') {
        match part {
            "." => {}
            ".." => {
                if parts.pop().is_none() {
                    return Err(xml.malformed(format!("`{target}` is outside of the package")));
                }
            }
            part => parts.push(part),
        }
    }
    Ok(parts.join("/"))
}
