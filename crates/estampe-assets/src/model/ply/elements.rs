//! Faces, triangle strips and edges.

use super::header::{Element, Header, Kind, Scalar};
use super::triangle_rows;
use super::values::{Fault, NO_VERTEX, Values, vertex_index};
use super::vertices::{color, narrow};
use crate::model::corner_split;
use crate::model::load::Context;
use crate::model::polygons::{Polygons, SPENT};
use crate::{AssetError, Limits};
use estampe_scene::Mesh;
use glam::{Vec2, Vec3};

/// Role of a property of a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Role {
    Vertices,
    Uvs,
    Texture,
    /// Red, green or blue.
    Color(usize),
    Unknown,
}

/// The elements that connect vertices.
#[derive(Debug)]
pub(super) struct Elements {
    triangles: Vec<[u32; 3]>,
    lines: Vec<[u32; 2]>,
    /// Texture coordinates of each triangle's corners; empty if the faces have none.
    corner_uvs: Vec<[Vec2; 3]>,
    /// Linear colour of each triangle; empty if the faces have none.
    colors: Vec<[f32; 4]>,
    /// Texture of each triangle; empty if the faces have none.
    textures: Vec<u32>,
    texture_count: usize,
    polygons: Polygons,
    face: Face,
}

/// The face that is being read.
#[derive(Debug, Default)]
struct Face {
    vertices: Vec<u32>,
    uvs: Vec<f32>,
    color: [f64; 3],
    texture: u32,
    corners: Vec<Vec3>,
    /// The reason why it is omitted, if it is.
    fault: Option<&'static str>,
}

impl Elements {
    pub(super) fn new(header: &Header) -> Self {
        Self {
            triangles: Vec::new(),
            lines: Vec::new(),
            corner_uvs: Vec::new(),
            colors: Vec::new(),
            textures: Vec::new(),
            texture_count: header.texture_files.len(),
            polygons: Polygons::default(),
            face: Face::default(),
        }
    }

    /// Reads the faces; `false` if the file ends among them.
    pub(super) fn read_faces<V: Values>(
        &mut self,
        values: &mut V,
        element: &Element,
        positions: &[Vec3],
        context: &mut Context<'_>,
    ) -> Result<bool, AssetError> {
        let steps: Vec<(Kind, Role)> = element
            .properties
            .iter()
            .map(|property| (property.kind, role(&property.name, property.kind)))
            .collect();
        let has = |role: Role| steps.iter().any(|&(_, own)| own == role);
        if !has(Role::Vertices) {
            return values.skip_element(element);
        }
        let has_uvs = has(Role::Uvs);
        let has_textures = has(Role::Texture) && self.texture_count > 1;
        let color_type = color_type(&steps);
        Limits::check("faces", element.count, context.limits.max_triangles)?;
        if self.triangles.is_empty()
            && triangle_rows::can_be_rows(element)
            && context.limits.max_polygon_corners >= 3
        {
            self.triangles = values.take_triangles(element.count, positions.len(), context.workers);
        }
        let read = self.triangles.len() as u64;
        if read < element.count {
            self.triangles
                .reserve_exact(values.plausible_count(element));
        }
        for _ in read..element.count {
            let before = self.triangles.len();
            match self
                .face
                .read(values, &steps, positions.len(), context.limits)
            {
                Ok(()) => values.end_row(),
                Err(fault) => return values.ends_here(fault),
            }
            self.keep_face(values, positions, context);
            let added = before..self.triangles.len();
            let count = added.end as u64;
            Limits::check("triangles", count, context.limits.max_triangles)?;
            if has_textures {
                self.textures.resize(before, 0);
                self.textures.resize(added.end, self.face.texture);
            }
            if let Some(scalar) = color_type {
                self.colors.resize(before, [1.0; 4]);
                self.colors
                    .resize(added.end, color(self.face.color, scalar, 1.0));
            }
            if !has_uvs && !self.corner_uvs.is_empty() {
                self.corner_uvs.resize(added.end, [Vec2::ZERO; 3]);
            }
        }
        Ok(true)
    }

    /// Splits the current face into triangles.
    #[inline]
    fn keep_face<V: Values>(&mut self, values: &V, positions: &[Vec3], context: &mut Context<'_>) {
        let face = &mut self.face;
        if let Some(fault) = face.fault {
            context.warnings.add(context.name, values.location(), || {
                format!("the face before here {fault}; it is omitted")
            });
            return;
        }
        let before = self.triangles.len();
        if let &[a, b, c] = face.vertices.as_slice() {
            self.triangles.push([a, b, c]);
            if !face.uvs.is_empty() {
                self.corner_uvs.resize(before, [Vec2::ZERO; 3]);
                self.corner_uvs
                    .push([0, 1, 2].map(|corner| face.uv(corner)));
            }
            return;
        }
        face.corners.clear();
        face.corners.extend(
            face.vertices
                .iter()
                .map(|&vertex| positions[vertex as usize]),
        );
        let (triangles, is_spent) = self.polygons.split(&face.corners);
        if is_spent {
            context
                .warnings
                .add(context.name, values.location(), || SPENT.to_owned());
        }
        let vertices = |corner: u32| face.vertices[corner as usize];
        self.triangles
            .extend(triangles.iter().map(|triangle| triangle.map(vertices)));
        if !face.uvs.is_empty() {
            self.corner_uvs.resize(before, [Vec2::ZERO; 3]);
            let uvs = triangles
                .iter()
                .map(|triangle| triangle.map(|corner| face.uv(corner as usize)));
            self.corner_uvs.extend(uvs);
        }
    }

    /// Reads triangle strips: every vertex makes a triangle with the two before; −1 starts a new
    /// strip.
    pub(super) fn read_strips<V: Values>(
        &mut self,
        values: &mut V,
        element: &Element,
        positions: &[Vec3],
        context: &mut Context<'_>,
    ) -> Result<bool, AssetError> {
        let list = element.position(&["vertex_indices", "vertex_index"]);
        for _ in 0..element.count {
            if element.properties.is_empty() {
                break;
            }
            for (index, property) in element.properties.iter().enumerate() {
                let read = match property.kind {
                    Kind::List { length, item } if Some(index) == list => {
                        self.read_strip(values, (length, item), positions.len(), context)?
                    }
                    kind => values.skip_property(kind),
                };
                if let Err(fault) = read {
                    return values.ends_here(fault);
                }
            }
            values.end_row();
        }
        Ok(true)
    }

    fn read_strip<V: Values>(
        &mut self,
        values: &mut V,
        (length, item): (Scalar, Scalar),
        vertex_count: usize,
        context: &mut Context<'_>,
    ) -> Result<Result<(), Fault>, AssetError> {
        let length = match values.next_length(length) {
            Ok(length) => length,
            Err(fault) => return Ok(Err(fault)),
        };
        let mut last = [NO_VERTEX; 2];
        let mut is_flipped = false;
        for _ in 0..length {
            let index = match values.next(item) {
                Ok(index) => index,
                Err(fault) => return Ok(Err(fault)),
            };
            let Some(vertex) = vertex_index(index, vertex_count) else {
                if index != -1.0 {
                    context.warnings.add(context.name, values.location(), || {
                        "a strip refers to a vertex that does not exist; a new strip starts"
                            .to_owned()
                    });
                }
                last = [NO_VERTEX; 2];
                is_flipped = false;
                continue;
            };
            if last[0] != NO_VERTEX {
                let [a, b] = if is_flipped { [last[1], last[0]] } else { last };
                self.triangles.push([a, b, vertex]);
                is_flipped = !is_flipped;
                let count = self.triangles.len() as u64;
                Limits::check("triangles", count, context.limits.max_triangles)?;
            }
            last = [last[1], vertex];
        }
        Ok(Ok(()))
    }

    /// Reads edges; `false` if the file ends among them.
    pub(super) fn read_edges<V: Values>(
        &mut self,
        values: &mut V,
        element: &Element,
        positions: &[Vec3],
        context: &mut Context<'_>,
    ) -> Result<bool, AssetError> {
        let ends = [
            element.position(&["vertex1"]),
            element.position(&["vertex2"]),
        ];
        if ends.contains(&None) {
            return values.skip_element(element);
        }
        Limits::check("edges", element.count, context.limits.max_triangles)?;
        for _ in 0..element.count {
            let mut segment = [f64::NAN; 2];
            for (index, property) in element.properties.iter().enumerate() {
                let end = ends.iter().position(|&end| end == Some(index));
                let read = match (property.kind, end) {
                    (Kind::One(scalar), Some(end)) => {
                        values.next(scalar).map(|value| segment[end] = value)
                    }
                    (kind, _) => values.skip_property(kind),
                };
                if let Err(fault) = read {
                    return values.ends_here(fault);
                }
            }
            values.end_row();
            match segment.map(|index| vertex_index(index, positions.len())) {
                [Some(start), Some(end)] => self.lines.push([start, end]),
                _ => context.warnings.add(context.name, values.location(), || {
                    "the edge before here refers to a vertex that does not exist; it is omitted"
                        .to_owned()
                }),
            }
        }
        Ok(true)
    }

    /// Moves everything into the mesh with the vertices.
    pub(super) fn into_mesh(mut self, mesh: &mut Mesh) {
        mesh.triangles = self.triangles;
        mesh.lines = self.lines;
        // Strips that follow faces have no attributes of their own.
        let count = mesh.triangles.len();
        if !self.corner_uvs.is_empty() {
            self.corner_uvs.resize(count, [Vec2::ZERO; 3]);
        }
        if !self.colors.is_empty() {
            self.colors.resize(count, [1.0; 4]);
        }
        if !self.textures.is_empty() {
            self.textures.resize(count, 0);
        }
        let corners = corner_split::Corners {
            uvs: self.corner_uvs,
            colors: self.colors,
        };
        corner_split::split(mesh, corners, &self.textures, self.texture_count);
    }
}

impl Face {
    /// Reads one face. Its lists are read to their end even if it is omitted.
    #[inline]
    fn read<V: Values>(
        &mut self,
        values: &mut V,
        steps: &[(Kind, Role)],
        vertex_count: usize,
        limits: &Limits,
    ) -> Result<(), Fault> {
        self.vertices.clear();
        self.uvs.clear();
        self.fault = None;
        for &(kind, role) in steps {
            match (kind, role) {
                (Kind::List { length, item }, Role::Vertices) => {
                    let length = values.next_length(length)?;
                    if length > limits.max_polygon_corners {
                        self.fault = Some("has more corners than the limit");
                        values.skip(length, item)?;
                        continue;
                    }
                    values.next_indices(item, length, vertex_count, &mut self.vertices)?;
                    if self.vertices.contains(&NO_VERTEX) {
                        self.fault = Some("refers to a vertex that does not exist");
                    }
                    if length < 3 {
                        self.fault = Some("has fewer than three corners");
                    }
                }
                (Kind::List { length, item }, Role::Uvs) => {
                    let length = values.next_length(length)?;
                    if length > 2 * limits.max_polygon_corners {
                        values.skip(length, item)?;
                        continue;
                    }
                    for _ in 0..length {
                        let value = values.next(item)?;
                        self.uvs.push(narrow(value));
                    }
                }
                (Kind::One(scalar), Role::Color(component)) => {
                    self.color[component] = values.next(scalar)?;
                }
                (Kind::One(scalar), Role::Texture) => {
                    let number = values.next(scalar)?;
                    self.texture = vertex_index(number, usize::MAX).unwrap_or(0);
                }
                _ => values.skip_property(kind)?,
            }
        }
        Ok(())
    }

    /// The texture coordinate of a corner, v down; zero where the list is too short.
    fn uv(&self, corner: usize) -> Vec2 {
        match self.uvs.get(corner * 2..corner * 2 + 2) {
            Some(&[u, v]) => Vec2::new(u, 1.0 - v),
            _ => Vec2::ZERO,
        }
    }
}

fn role(name: &str, kind: Kind) -> Role {
    match (name, kind) {
        ("vertex_indices" | "vertex_index", Kind::List { .. }) => Role::Vertices,
        ("texcoord", Kind::List { .. }) => Role::Uvs,
        ("texnumber", Kind::One(_)) => Role::Texture,
        ("red" | "diffuse_red", Kind::One(_)) => Role::Color(0),
        ("green" | "diffuse_green", Kind::One(_)) => Role::Color(1),
        ("blue" | "diffuse_blue", Kind::One(_)) => Role::Color(2),
        _ => Role::Unknown,
    }
}

/// The type of the faces' colours, if all three components are there.
fn color_type(steps: &[(Kind, Role)]) -> Option<Scalar> {
    let of = |component| {
        steps.iter().find_map(|&(kind, role)| match kind {
            Kind::One(scalar) if role == Role::Color(component) => Some(scalar),
            _ => None,
        })
    };
    of(1).and(of(2)).and(of(0))
}
