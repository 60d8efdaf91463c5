//! 3MF, the 3D Manufacturing Format: a package of XML parts and images.
//!
//! ```text
//! bytes -> zip (entries) -> package (parts, the first one) -> xml (elements, places)
//!       -> part: properties, triangles, references -> document
//!       -> textures (images) -> build: shape (one object) -> placed meshes
//! ```
//!
//! Read are the core specification, base materials, colours and textures of the materials
//! extension, and objects in other parts (the production extension). An extension that the file
//! requires and that is not among these is an error. Composite materials and multiple properties
//! have no effect, with a warning; textures are repeated, whatever their tile style.
//!
//! Positions are in millimetres, the unit that 3MF has by default: other units are converted, so
//! that parts with different units fit. Z is up. Colours are sRGB-encoded. There is one mesh for
//! each mesh of each placed object.
//!
//! Sources: 3MF Consortium, "3D Manufacturing Format Core Specification", version 1.3; "Materials
//! and Properties Extension", version 1.2; "Production Extension", version 1.1.

mod build;
mod document;
mod package;
mod part;
mod properties;
mod shape;
mod textures;
mod triangles;
mod xml;
mod zip;

use super::load::{Context, Parsed};
use crate::AssetError;
use build::Build;
use document::{Document, Reference};
use estampe_scene::{Scene, UpAxis};
use package::Package;
use std::collections::HashSet;
use textures::Textures;

pub(super) use package::is_3mf;

/// Reads a 3MF file.
pub(super) fn parse(bytes: &[u8], context: &mut Context<'_>) -> Result<Parsed, AssetError> {
    let mut package = Package::open(bytes, context)?;
    let start = package.start(context)?;
    let mut document = Document::default();
    let mut names = vec![start];
    let mut known: HashSet<String> = names.iter().cloned().collect();
    while let Some(name) = names.pop() {
        let text = package.text(&name, context)?.ok_or_else(|| {
            let what = format!("the package has no part `{name}`");
            AssetError::malformed(what, "export the file again")
        })?;
        let first_object = document.objects.len();
        part::read(&name, &text, &mut document, context)?;
        // Only the items of the first part are built.
        let items = { document.parts.first() }.filter(|_| first_object == 0);
        let items = items.into_iter().flat_map(|part| &part.items);
        let objects = document.objects[first_object..].iter();
        let references = items.chain(objects.flat_map(|object| &object.components));
        for part in references.filter_map(|Reference { part, .. }| part.as_ref()) {
            if known.insert(part.clone()) {
                names.push(part.clone());
            }
        }
    }
    let textures = Textures::read(&mut document, &mut package, context)?;
    let meshes = Build::meshes(&document, &textures, context)?;
    Ok(Parsed {
        scene: Scene {
            meshes,
            materials: document.materials,
            up: UpAxis::Z,
            ..Scene::default()
        },
        ..Parsed::default()
    })
}
