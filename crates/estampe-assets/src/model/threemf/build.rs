//! The build: objects and their components, placed.
//!
//! An object may be used by many others, so a small file can describe any number of triangles. They
//! are counted before a mesh is made: each object once, from the objects within it.

use super::document::{Document, Reference};
use super::shape;
use super::textures::Textures;
use crate::model::{joined, load::Context};
use crate::{AssetError, Limits};
use estampe_scene::Mesh;
use glam::{DAffine3, Vec3};
use std::collections::HashMap;

/// Objects within objects; deeper ones are an error.
const MAX_DEPTH: u32 = 64;

/// What an object has with all its components.
#[derive(Debug, Clone, Copy, Default)]
struct Size {
    vertices: u64,
    triangles: u64,
    /// Placed objects, itself among them.
    objects: u64,
    /// Objects within objects, 1 for an object without components.
    depth: u32,
}

/// State of the count of an object.
#[derive(Debug, Clone, Copy)]
enum Counted {
    No,
    /// Its components are being counted.
    Begun,
    Done(Size),
}

/// The objects that are to be placed.
pub(super) struct Build<'d> {
    document: &'d Document,
    textures: &'d Textures,
    /// Index of each part by its name.
    parts: HashMap<&'d str, usize>,
    counted: Vec<Counted>,
    /// The mesh of each object that was placed before, in its own space.
    shapes: Vec<Option<Mesh>>,
    meshes: Vec<Mesh>,
}

impl<'d> Build<'d> {
    /// Places the build items of the first part.
    pub(super) fn meshes(
        document: &'d Document,
        textures: &'d Textures,
        context: &Context<'_>,
    ) -> Result<Vec<Mesh>, AssetError> {
        let parts = document.parts.iter().enumerate();
        let count = document.objects.len();
        let mut build = Self {
            document,
            textures,
            parts: parts.map(|(at, part)| (part.name.as_str(), at)).collect(),
            counted: vec![Counted::No; count],
            shapes: (0..count).map(|_| None).collect(),
            meshes: Vec::new(),
        };
        let Some(start) = document.parts.first() else {
            return Ok(Vec::new());
        };
        let mut items = Vec::with_capacity(start.items.len());
        let mut all = Size::default();
        for item in &start.items {
            let object = build.object(item, 0)?;
            let size = build.count(object, 1)?;
            all.add(size);
            items.push((object, &item.outer_from_object));
        }
        let limits = context.limits;
        Limits::check("vertices", all.vertices, limits.max_vertices)?;
        Limits::check("triangles", all.triangles, limits.max_triangles)?;
        Limits::check("placed objects", all.objects, limits.max_triangles)?;
        for (object, world_from_object) in items {
            build.place(object, world_from_object, limits)?;
        }
        Ok(build.meshes)
    }

    /// The object of a reference in the part `from`.
    fn object(&self, reference: &Reference, from: usize) -> Result<usize, AssetError> {
        let Reference { part, id, .. } = reference;
        let found = match part {
            Some(part) => self.parts.get(part.as_str()).copied(),
            None => Some(from),
        };
        let object = found.and_then(|part| self.document.parts[part].objects.get(id));
        object.copied().ok_or_else(|| {
            let what = format!("the object {id} does not exist");
            AssetError::malformed(what, "export the file again")
                .at(reference.location)
                .in_file(&self.document.parts[from].place)
        })
    }

    /// Counts an object with its components, which is within `depth - 1` others.
    fn count(&mut self, object: usize, depth: u32) -> Result<Size, AssetError> {
        let document = self.document;
        let own = &document.objects[object];
        let fault = |error: AssetError| {
            error
                .at(own.location)
                .in_file(&document.parts[own.part].place)
        };
        let too_deep = || {
            fault(AssetError::limit_exceeded(
                format!("there are objects within more than {MAX_DEPTH} others"),
                "join the innermost ones",
            ))
        };
        match self.counted[object] {
            Counted::Done(size) => return Ok(size),
            Counted::Begun => {
                let what = "the object is a component of itself";
                return Err(fault(AssetError::malformed(what, "remove the component")));
            }
            Counted::No if depth > MAX_DEPTH => return Err(too_deep()),
            Counted::No => {}
        }
        self.counted[object] = Counted::Begun;
        let mut size = Size::default();
        for component in &own.components {
            let inner = self.object(component, own.part)?;
            let inner = self.count(inner, depth + 1)?;
            size.add(inner);
        }
        size.depth += 1;
        if size.depth > MAX_DEPTH {
            return Err(too_deep());
        }
        size.add(Size {
            vertices: own.triangles.positions.len() as u64,
            triangles: own.triangles.triangles.len() as u64,
            objects: 1,
            depth: 0,
        });
        self.counted[object] = Counted::Done(size);
        Ok(size)
    }

    /// Adds the meshes of an object and its components.
    fn place(
        &mut self,
        object: usize,
        world_from_object: &DAffine3,
        limits: &Limits,
    ) -> Result<(), AssetError> {
        let document = self.document;
        let own = &document.objects[object];
        if !own.triangles.triangles.is_empty() {
            let shape = self.shapes[object]
                .get_or_insert_with(|| shape::mesh(own, document, self.textures));
            let mesh = placed(shape.clone(), world_from_object);
            joined::push_within(&mut self.meshes, mesh, limits.max_meshes);
        }
        for component in &own.components {
            let inner = self.object(component, own.part)?;
            let world_from_inner = *world_from_object * component.outer_from_object;
            self.place(inner, &world_from_inner, limits)?;
        }
        Ok(())
    }
}

impl Size {
    /// Adds what is beside or within it.
    fn add(&mut self, other: Self) {
        self.vertices = self.vertices.saturating_add(other.vertices);
        self.triangles = self.triangles.saturating_add(other.triangles);
        self.objects = self.objects.saturating_add(other.objects);
        self.depth = self.depth.max(other.depth);
    }
}

/// The mesh after a transform. A mirroring one turns triangles inside out, so their winding
/// changes.
fn placed(mut mesh: Mesh, world_from_object: &DAffine3) -> Mesh {
    if *world_from_object == DAffine3::IDENTITY {
        return mesh;
    }
    let place = |p: &Vec3| world_from_object.transform_point3(p.as_dvec3()).as_vec3();
    for position in &mut mesh.positions {
        *position = place(position);
    }
    if world_from_object.matrix3.determinant() < 0.0 {
        for [_, b, c] in &mut mesh.triangles {
            std::mem::swap(b, c);
        }
    }
    mesh
}
