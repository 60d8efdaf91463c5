//! The model that the rungs draw.

use crate::LadderError;
use estampe_assets::{Limits, load_model};
use estampe_renderer::transforms::round_to_f32;
use estampe_scene::{Bounds, Image, Mesh, Scene};
use estampe_shapes::ShapeMesh;
use estampe_shapes::teapot::teapot;
use glam::{DVec3, Vec2, Vec3};
use std::path::Path;

/// A triangle mesh in the cube −1..1, y up.
#[derive(Debug, Clone)]
pub struct Model {
    /// The positions of the vertices.
    pub positions: Vec<[f32; 3]>,
    /// The unit normal of each vertex.
    pub normals: Vec<[f32; 3]>,
    /// The texture coordinates of each vertex, v down; zeros if the file has none.
    pub uvs: Vec<[f32; 2]>,
    /// Three vertices for each face, counter-clockwise seen from outside.
    pub faces: Vec<[u32; 3]>,
    /// The diffuse texture.
    pub texture: Image,
}

impl Model {
    /// No faces, and the built-in texture.
    #[must_use]
    pub fn empty() -> Self {
        Self {
            positions: Vec::new(),
            normals: Vec::new(),
            uvs: Vec::new(),
            faces: Vec::new(),
            texture: tiles(),
        }
    }

    /// The built-in model: the Utah teapot in 2,000 triangles, its spout a little towards the
    /// viewer.
    #[must_use]
    pub fn builtin() -> Self {
        /// Cells along each side of the teapot's 32 patches.
        const CELLS: u32 = 6;
        /// cos and sin of the turn about the y axis.
        const TURN: [f32; 2] = [15.0 / 17.0, 8.0 / 17.0];
        let mut teapot = teapot(CELLS);
        let [c, s] = TURN;
        for vector in teapot.positions.iter_mut().chain(&mut teapot.normals) {
            let Vec3 { x, y, z } = *vector;
            *vector = Vec3::new(c * x - s * z, y, s * x + c * z);
        }
        Self::of_shape(teapot)
    }

    /// A shape, moved and scaled as [`Model::of_scene`] does.
    #[must_use]
    pub fn of_shape(shape: ShapeMesh) -> Self {
        let mut model = Self::empty();
        model.append(&Mesh {
            positions: shape.positions,
            normals: shape.normals,
            uvs: shape.uvs,
            triangles: shape.triangles,
            ..Mesh::default()
        });
        model.place();
        model
    }

    /// The surface y = f(x, z) over −1..1, as a grid of cells of two triangles, lit from above.
    #[must_use]
    pub fn explicit(cells: u32, f: impl Fn(f32, f32) -> f32) -> Self {
        let mut model = Self::empty();
        for row in 0..=cells {
            for column in 0..=cells {
                let [u, v] = [column, row].map(|at| at as f32 / cells as f32);
                let (x, z) = (u * 2.0 - 1.0, v * 2.0 - 1.0);
                model.positions.push([x, f(x, z), z]);
                model.normals.push([0.0, 1.0, 0.0]);
                model.uvs.push([u, v]);
                if row < cells && column < cells {
                    let a = row * (cells + 1) + column;
                    let b = a + cells + 1;
                    model.faces.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
                }
            }
        }
        model
    }

    /// The triangles of a file: glTF, OBJ, STL, PLY, OFF or 3MF; see [`Model::of_scene`].
    ///
    /// # Errors
    /// If the file cannot be read, or has no triangles.
    pub fn read(path: &Path) -> Result<Self, LadderError> {
        let scene = load_model(path, None, &Limits::default())?.scene;
        Self::of_scene(&scene).ok_or_else(|| LadderError::NoTriangles {
            name: path.display().to_string(),
        })
    }

    /// The triangles of all meshes, or `None` if there are none. Triangles with a corner that is
    /// not finite are dropped.
    ///
    /// A model inside the cube −1..1 stays as it is; any other is moved to the middle and scaled to
    /// nine tenths of the cube. The texture is that of the first material with one, or else the
    /// built-in one.
    #[must_use]
    pub fn of_scene(scene: &Scene) -> Option<Self> {
        let mut model = Self::empty();
        for mesh in &scene.meshes {
            model.append(mesh);
        }
        model.place();
        let mut textures = scene.materials.iter().filter_map(|m| m.base_color_texture);
        if let Some(texture) = textures.next() {
            model.texture = scene.images[texture].clone();
        }
        (!model.faces.is_empty()).then_some(model)
    }

    /// Appends the triangles of a mesh whose corners are finite.
    fn append(&mut self, mesh: &Mesh) {
        let first = u32::try_from(self.positions.len()).expect("readers limit the vertices");
        let count = self.positions.len() + mesh.positions.len();
        self.positions
            .extend(mesh.positions.iter().map(Vec3::to_array));
        self.normals.extend(mesh.normals.iter().map(Vec3::to_array));
        self.normals.resize(count, [0.0, 0.0, 1.0]);
        self.uvs.extend(mesh.uvs.iter().map(Vec2::to_array));
        self.uvs.resize(count, [0.0; 2]);
        let is_finite = |index: &u32| mesh.positions[*index as usize].is_finite();
        let triangles = mesh.triangles.iter();
        let finite = triangles.filter(|triangle| triangle.iter().all(is_finite));
        self.faces
            .extend(finite.map(|triangle| triangle.map(|index| index + first)));
    }

    /// Moves and scales the positions into the cube −1..1 if they are not all inside.
    fn place(&mut self) {
        let used = self.triangles().flatten().map(Vec3::from);
        let Bounds { min, max } = Bounds::of(used);
        if min.cmpge(Vec3::NEG_ONE).all() && max.cmple(Vec3::ONE).all() {
            return;
        }
        // In f64, where no difference overflows.
        let (min, max) = (min.as_dvec3(), max.as_dvec3());
        let half = (max - min).max_element() / 2.0;
        let scale = if half > 0.0 { 0.9 / half } else { 1.0 };
        for position in &mut self.positions {
            let placed = (DVec3::from(position.map(f64::from)) - (min + max) / 2.0) * scale;
            *position = placed.to_array().map(round_to_f32);
        }
    }

    /// The positions of the corners of each face.
    pub fn triangles(&self) -> impl Iterator<Item = [[f32; 3]; 3]> {
        let corners = |face: &[u32; 3]| face.map(|index| self.positions[index as usize]);
        self.faces.iter().map(corners)
    }

    /// The unit normal of a face, (b − a) × (c − a), which points outside; zero if the face has no
    /// area.
    #[must_use]
    pub fn face_normal(corners: [[f32; 3]; 3]) -> [f32; 3] {
        let [a, b, c] = corners.map(Vec3::from);
        (b - a).cross(c - a).normalize_or_zero().to_array()
    }
}

/// The built-in texture: 256×256 texels, eight by eight tiles. Red grows with u, green with v, so
/// that a place on the model shows where its texel comes from.
fn tiles() -> Image {
    let mut image = Image::filled(256, 256, [40, 36, 34, 255]);
    for v in 0..=255_u8 {
        for u in 0..=255_u8 {
            let is_joint = u % 32 == 0 || v % 32 == 0;
            let is_bright = (u / 32 + v / 32) % 2 == 0;
            if !is_joint {
                let tint = [64 + u / 2, 64 + v / 2, 96];
                let color = tint.map(|code| if is_bright { code / 2 + 120 } else { code });
                let at = (usize::from(v) * 256 + usize::from(u)) * 4;
                image.rgba[at..at + 3].copy_from_slice(&color);
            }
        }
    }
    image
}
