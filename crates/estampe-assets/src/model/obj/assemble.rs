//! Assembly of an OBJ file's contents to meshes.

use super::elements::{ABSENT, Corner, Elements};
use super::parts::{Part, Parts};
use super::reader::Contents;
use crate::model::load::{Context, Parsed};
use crate::model::mtl::{self, MaterialUse};
use crate::model::srgb::linear_from_srgb;
use crate::model::textures::text_of_name;
use crate::model::vertex_copies::VertexCopies;
use estampe_scene::{Mesh, Scene, Surface, UpAxis, Workers};
use glam::{Vec2, Vec3};
use std::ops::Range;

/// Builds the meshes and loads the materials.
pub(super) fn assemble(mut contents: Contents, context: &mut Context<'_>) -> Parsed {
    convert_attributes(&mut contents, context.workers);
    let uses: Vec<MaterialUse<'_>> = contents
        .parts
        .materials
        .list
        .iter()
        .zip(&contents.material_uses)
        .map(|(name, &location)| MaterialUse { name, location })
        .collect();
    let libraries = contents.libraries.iter();
    let libraries: Vec<_> = libraries.map(|(names, at)| (&**names, *at)).collect();
    let library = mtl::load(&libraries, &uses, context);
    drop((libraries, uses));

    let is_cloud = contents.elements.triangles.is_empty()
        && contents.elements.lines.is_empty()
        && contents.elements.points.is_empty();
    if is_cloud && !contents.positions.is_empty() {
        context.warnings.add(context.name, None, || {
            "the file has vertices and no elements; the vertices are drawn as points".to_owned()
        });
    }
    let parameter_points = std::mem::take(&mut contents.parameter_points);
    let (meshes, smoothing_groups) = if is_cloud {
        (vec![point_cloud(contents)], Vec::new())
    } else if is_plain(&contents) {
        let groups = std::mem::take(&mut contents.elements.smoothing_groups);
        let groups = if groups.is_empty() {
            Vec::new()
        } else {
            vec![groups]
        };
        (vec![plain_mesh(contents, &library.of_use)], groups)
    } else {
        Assembly::new(&contents, &library.of_use).meshes()
    };
    let scene = Scene {
        meshes,
        materials: library.materials,
        up: UpAxis::Y,
        ..Scene::default()
    };
    Parsed {
        scene,
        smoothing_groups,
        parameter_points,
        ..Parsed::default()
    }
}

/// Converts colours, texture coordinates and normals from the file's conventions to the scene's.
fn convert_attributes(contents: &mut Contents, workers: Workers) {
    /// Vertices of a piece: some hundred microseconds of work.
    const PIECE: usize = 1 << 14;
    // Some exporters write 0..255.
    let largest = contents
        .colors
        .iter()
        .fold(0.0_f32, |most, color| most.max(color.max_element()));
    let scale = if largest > 1.0 { 1.0 / 255.0 } else { 1.0 };
    workers.map(contents.colors.chunks_mut(PIECE), |colors| {
        for color in colors {
            *color = (*color * scale).map(|value| linear_from_srgb(value.clamp(0.0, 1.0)));
        }
    });
    for uv in &mut contents.uvs {
        uv.y = 1.0 - uv.y;
    }
    workers.map(contents.normals.chunks_mut(PIECE), |normals| {
        for normal in normals {
            *normal = crate::model::normals::unit_or_zero(*normal);
        }
    });
}

fn opaque(color: Vec3) -> [f32; 4] {
    [color.x, color.y, color.z, 1.0]
}

fn point_cloud(contents: Contents) -> Mesh {
    // Limits keep the number of vertices below 2^32.
    let count = u32::try_from(contents.positions.len()).unwrap_or(u32::MAX);
    Mesh {
        colors: contents.colors.into_iter().map(opaque).collect(),
        positions: contents.positions,
        points: (0..count).collect(),
        ..Mesh::default()
    }
}

/// True if the positions can be used as vertices unchanged, in one mesh with one surface.
fn is_plain(contents: &Contents) -> bool {
    let Contents {
        elements, parts, ..
    } = contents;
    elements.triangle_uvs.is_empty()
        && elements.triangle_normals.is_empty()
        && elements.lines.is_empty()
        && elements.points.is_empty()
        && parts.list.len() == 1
}

fn plain_mesh(contents: Contents, material_of_use: &[Option<usize>]) -> Mesh {
    let part = contents.parts.list[0];
    let triangles = contents.elements.triangles;
    let material = material_of_use[part.material as usize];
    Mesh {
        name: text_of_name(mesh_name(&contents.parts, part)),
        positions: contents.positions,
        colors: contents.colors.into_iter().map(opaque).collect(),
        surfaces: vec![Surface {
            material,
            triangles: 0..triangles.len(),
        }],
        triangles,
        ..Mesh::default()
    }
}

/// The name of the object, or of the group in files without objects.
fn mesh_name(parts: &Parts, part: Part) -> &[u8] {
    if parts.objects.list.len() > 1 {
        &parts.objects.list[part.object as usize]
    } else {
        &parts.groups.list[part.group as usize]
    }
}

/// Builds one mesh after the other.
struct Assembly<'a> {
    contents: &'a Contents,
    material_of_use: &'a [Option<usize>],
    /// Vertices of the current mesh; the sources are the file's positions.
    copies: VertexCopies,
    /// Texture coordinate and normal of each vertex of the current mesh.
    attributes: Vec<[u32; 2]>,
    mesh: Mesh,
    smoothing_groups: Vec<u32>,
    /// Finished meshes, and their triangles' smoothing groups.
    done: Vec<Mesh>,
    done_groups: Vec<Vec<u32>>,
}

/// A run of elements that belongs to one mesh.
#[derive(Debug, Clone)]
struct Run {
    part: u32,
    elements: Range<usize>,
}

impl<'a> Assembly<'a> {
    fn new(contents: &'a Contents, material_of_use: &'a [Option<usize>]) -> Self {
        Self {
            contents,
            material_of_use,
            copies: VertexCopies::new(contents.positions.len()),
            attributes: Vec::new(),
            mesh: Mesh::default(),
            smoothing_groups: Vec::new(),
            done: Vec::new(),
            done_groups: Vec::new(),
        }
    }

    fn meshes(mut self) -> (Vec<Mesh>, Vec<Vec<u32>>) {
        let elements = &self.contents.elements;
        // Meshes, and the materials inside them, are in the order of their first element; parts are
        // already numbered in that order.
        let parts = &self.contents.parts.list;
        let mesh_keys: Vec<u32> = parts.iter().map(|&part| self.mesh_key(part)).collect();
        let rank = first_appearance(&mesh_keys);
        let material_rank: Vec<u32> =
            first_appearance(&parts.iter().map(|part| part.material).collect::<Vec<_>>());
        let key = |run: &Run| {
            let part = run.part as usize;
            (rank[part], material_rank[part])
        };
        let mut triangles = triangle_runs(elements);
        triangles.sort_by_key(key);
        let mut lines = element_runs(elements.lines.iter().map(|&(part, _)| part));
        lines.sort_by_key(|run| rank[run.part as usize]);
        let mut points = element_runs(elements.points.iter().map(|&(part, _)| part));
        points.sort_by_key(|run| rank[run.part as usize]);

        let mut triangles = triangles.as_slice();
        let mut lines = lines.as_slice();
        let mut points = points.as_slice();
        let mut order: Vec<usize> = (0..parts.len()).collect();
        order.sort_by_key(|&part| rank[part]);
        order.dedup_by_key(|&mut part| rank[part]);
        for first_part in order {
            let is_here = |run: &Run| rank[run.part as usize] == rank[first_part];
            for run in take_while(&mut triangles, is_here) {
                self.add_triangles(run);
            }
            for run in take_while(&mut lines, is_here) {
                self.add_lines(run);
            }
            for run in take_while(&mut points, is_here) {
                self.add_points(run);
            }
            self.finish_mesh(parts[first_part]);
        }
        (self.done, self.done_groups)
    }

    fn mesh_key(&self, part: Part) -> u32 {
        if self.contents.parts.objects.list.len() > 1 {
            part.object
        } else {
            part.group
        }
    }

    fn add_triangles(&mut self, run: &Run) {
        let elements = &self.contents.elements;
        let first = self.mesh.triangles.len();
        for index in run.elements.clone() {
            let positions = elements.triangles[index];
            let uvs = elements
                .triangle_uvs
                .get(index)
                .copied()
                .unwrap_or([ABSENT; 3]);
            let normals = elements
                .triangle_normals
                .get(index)
                .copied()
                .unwrap_or([ABSENT; 3]);
            let mut triangle = [0; 3];
            for corner in 0..3 {
                triangle[corner] = self.vertex(Corner {
                    position: positions[corner],
                    uv: uvs[corner],
                    normal: normals[corner],
                });
            }
            self.mesh.triangles.push(triangle);
        }
        if !elements.smoothing_groups.is_empty() {
            self.smoothing_groups
                .extend(&elements.smoothing_groups[run.elements.clone()]);
        }
        let last = self.mesh.triangles.len();
        let part = self.contents.parts.list[run.part as usize];
        let material = self.material_of_use[part.material as usize];
        match self.mesh.surfaces.last_mut() {
            Some(surface) if surface.material == material => surface.triangles.end = last,
            _ => self.mesh.surfaces.push(Surface {
                material,
                triangles: first..last,
            }),
        }
    }

    fn add_lines(&mut self, run: &Run) {
        for &(_, [start, end]) in &self.contents.elements.lines[run.elements.clone()] {
            let segment = [self.vertex(start), self.vertex(end)];
            self.mesh.lines.push(segment);
        }
    }

    fn add_points(&mut self, run: &Run) {
        for &(_, corner) in &self.contents.elements.points[run.elements.clone()] {
            let point = self.vertex(corner);
            self.mesh.points.push(point);
        }
    }

    /// The vertex of the current mesh with these attributes.
    #[inline]
    fn vertex(&mut self, corner: Corner) -> u32 {
        let wanted = [corner.uv, corner.normal];
        let attributes = &self.attributes;
        let is_same = |vertex: usize| attributes[vertex] == wanted;
        let (vertex, is_new) = self.copies.find_or_add(corner.position, is_same);
        if is_new {
            self.attributes.push(wanted);
        }
        vertex
    }

    /// Gathers the attributes of the current mesh's vertices, and starts the next mesh.
    fn finish_mesh(&mut self, part: Part) {
        let contents = self.contents;
        let mut mesh = std::mem::take(&mut self.mesh);
        mesh.name = text_of_name(mesh_name(&contents.parts, part));
        let sources = self.copies.sources();
        mesh.positions = sources
            .iter()
            .map(|&source| contents.positions[source as usize])
            .collect();
        if !contents.colors.is_empty() {
            let colors = sources
                .iter()
                .map(|&source| opaque(contents.colors[source as usize]));
            mesh.colors = colors.collect();
        }
        if self.attributes.iter().any(|&[uv, _]| uv != ABSENT) {
            let uvs = self.attributes.iter();
            mesh.uvs = uvs
                .map(|&[uv, _]| contents.uvs.get(uv as usize).copied().unwrap_or(Vec2::ZERO))
                .collect();
        }
        if self.attributes.iter().any(|&[_, normal]| normal != ABSENT) {
            let normals = self.attributes.iter();
            mesh.normals = normals
                .map(|&[_, index]| {
                    contents
                        .normals
                        .get(index as usize)
                        .copied()
                        .unwrap_or(Vec3::ZERO)
                })
                .collect();
        }
        self.copies.clear();
        self.attributes.clear();
        self.done.push(mesh);
        if !contents.elements.smoothing_groups.is_empty() {
            self.done_groups
                .push(std::mem::take(&mut self.smoothing_groups));
        }
    }
}

/// For each key, the rank of its first appearance.
fn first_appearance(keys: &[u32]) -> Vec<u32> {
    let mut places = std::collections::HashMap::new();
    let places = keys.iter().map(|&key| {
        let next = u32::try_from(places.len()).expect("there are fewer keys than lines");
        *places.entry(key).or_insert(next)
    });
    places.collect()
}

fn triangle_runs(elements: &Elements) -> Vec<Run> {
    let ends = elements.runs.iter().skip(1).map(|&(first, _)| first);
    let ends = ends.chain([elements.triangles.len()]);
    elements
        .runs
        .iter()
        .zip(ends)
        .map(|(&(first, part), end)| Run {
            part,
            elements: first..end,
        })
        .collect()
}

fn element_runs(parts: impl Iterator<Item = u32>) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for (index, part) in parts.enumerate() {
        match runs.last_mut() {
            Some(run) if run.part == part => run.elements.end = index + 1,
            _ => runs.push(Run {
                part,
                elements: index..index + 1,
            }),
        }
    }
    runs
}

/// Splits off the leading runs that satisfy `holds`.
fn take_while<'a>(runs: &mut &'a [Run], holds: impl Fn(&Run) -> bool) -> &'a [Run] {
    let count = runs.iter().take_while(|run| holds(run)).count();
    let (taken, rest) = runs.split_at(count);
    *runs = rest;
    taken
}
