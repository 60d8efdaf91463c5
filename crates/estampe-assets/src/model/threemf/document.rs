//! What the parts of a package say, before it becomes a scene.

use crate::Location;
use estampe_scene::Material;
use glam::{DAffine3, Vec2, Vec3};
use std::collections::HashMap;

/// All parts of a package together.
#[derive(Debug, Default)]
pub(super) struct Document {
    pub(super) parts: Vec<Part>,
    pub(super) objects: Vec<Object>,
    pub(super) groups: Vec<Group>,
    pub(super) textures: Vec<Texture>,
    /// The base materials of all groups.
    pub(super) materials: Vec<Material>,
}

/// A part with objects.
#[derive(Debug)]
pub(super) struct Part {
    /// Its name in the package.
    pub(super) name: String,
    /// The package and the part, for messages.
    pub(super) place: String,
    /// Index of each object by its identifier.
    pub(super) objects: HashMap<u32, usize>,
    /// The build items, which are used in the first part only.
    pub(super) items: Vec<Reference>,
}

/// A component or a build item: an object that is placed.
#[derive(Debug)]
pub(super) struct Reference {
    /// The part of the object; `None` is the part that refers to it.
    pub(super) part: Option<String>,
    pub(super) id: u32,
    /// From millimetres to millimetres.
    pub(super) outer_from_object: DAffine3,
    pub(super) location: Location,
}

#[derive(Debug)]
pub(super) struct Object {
    pub(super) name: String,
    pub(super) part: usize,
    pub(super) triangles: Triangles,
    pub(super) components: Vec<Reference>,
    pub(super) location: Location,
}

/// The mesh of an object.
#[derive(Debug, Default)]
pub(super) struct Triangles {
    /// In millimetres.
    pub(super) positions: Vec<Vec3>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// The property of each triangle, or of those before the first that has none; empty if no
    /// triangle has one.
    pub(super) properties: Vec<Option<Property>>,
}

/// An entry of a group for each corner of a triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Property {
    /// Index into [`Document::groups`].
    pub(super) group: u32,
    pub(super) corners: [u32; 3],
}

/// A group of properties.
#[derive(Debug)]
pub(super) enum Group {
    /// Materials, which are `count` of the document's from `first` on.
    Base { first: usize, count: usize },
    /// Linear colours.
    Colors(Vec<[f32; 4]>),
    /// Texture coordinates of a texture, with v = 0 at its top row.
    Coordinates {
        /// Index into [`Document::textures`].
        texture: Option<usize>,
        coordinates: Vec<Vec2>,
    },
    /// Properties that are not read.
    Other,
}

#[derive(Debug)]
pub(super) struct Texture {
    /// The part with its image.
    pub(super) part: String,
    /// The package and the part that names it, for messages.
    pub(super) place: String,
    pub(super) location: Location,
}

/// A group that is not read has no entries.
impl Group {
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Base { count, .. } => *count,
            Self::Colors(colors) => colors.len(),
            Self::Coordinates { coordinates, .. } => coordinates.len(),
            Self::Other => 0,
        }
    }
}
