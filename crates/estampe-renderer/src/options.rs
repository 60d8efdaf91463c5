//! Options of a rendered image.

use crate::camera::CameraOptions;
use crate::environment::EnvironmentMap;
use crate::feature_edges::FeatureEdges;
use crate::gradient::Gradient;
use crate::guides::BoundingBox;
use crate::section::Section;
use crate::shading::pbr::tone_map::ToneMap;
use crate::surface_program::SurfaceProgram;
use estampe::state::CullMode;
use estampe_scene::{Image, Light, Scene, UpAxis};
use glam::DVec3;
use std::sync::Arc;

/// Options of a rendered image. The defaults give a presentable image of any model.
#[derive(Debug, Clone, PartialEq)]
pub struct RenderOptions {
    /// Width in pixels, 1..=16384. Default 1024.
    pub width: u32,
    /// Height in pixels, 1..=16384. Default 768.
    pub height: u32,
    /// Samples per pixel: 1, 2, 4, 8 or 16. Default 4.
    pub samples: u32,
    /// Position, target and projection of the camera.
    pub camera: CameraOptions,
    /// The up direction. Default: the scene's.
    pub up: Up,
    /// Shading of surfaces. Default [`Shading::Automatic`].
    pub shading: Shading,
    /// Light from all around, for [`Shading::Pbr`]. Default: the studio.
    pub environment: Environment,
    /// If set, the scene's own lights shine too, on [`Shading::Pbr`]. Default not: their units are
    /// absolute, and without an exposure to match most of them burn a picture.
    pub scene_lights: bool,
    /// If set, lights cast shadows on surfaces that are lit at their fragments: [`Shading::Pbr`],
    /// [`Shading::Phong`] and [`Shading::Toon`]. Of the default lights it is the key light, of an
    /// environment its brightest side; of own lights the first four, unless they are within the
    /// model's box. Transparent surfaces, lines and points cast none. Default not.
    pub shadows: bool,
    /// What the model stands on. Default nothing.
    pub ground: Ground,
    /// Brightness of [`Shading::Pbr`] in stops: light is multiplied by 2 to this power. Default 0.
    pub exposure_ev: f32,
    /// How the light of [`Shading::Pbr`] is shown. Default [`ToneMap::Neutral`].
    pub tone_map: ToneMap,
    /// A program that draws all surfaces, in place of [`Self::shading`], which says no more than
    /// which vertices faces share. Default none.
    pub program: Option<SurfaceProgram>,
    /// Lights in world space, which replace the default lights. Default none.
    pub lights: Vec<Light>,
    /// Ambient light, times the base colour. `None` (default) is 0.18.
    pub ambient: Option<f32>,
    /// Highlights. Default: those of the materials, by the reflected light.
    pub specular: Specular,
    /// Specular exponent of all materials, 1..=10,000. `None` (default) is that of the materials.
    pub shininess: Option<u32>,
    /// Levels of lit colours, at least 2: each channel of the linear colour becomes
    /// min(⌊I·N⌋, N − 1)/(N − 1). With toon shading the steps of light, by default 4. `None`
    /// (default) is smooth.
    pub levels: Option<u16>,
    /// Fog over surfaces, lines and points, if their colours are light. Default none.
    pub fog: Option<Fog>,
    /// A base-colour texture, sRGB, which replaces the materials' colours and textures.
    pub texture: Option<Image>,
    /// The background, sRGB, or `None` for a transparent one. Default #f2f2f2.
    pub background: Option<[u8; 3]>,
    /// A gradient over the background, behind everything. The background is then the colour of
    /// fog and that with which lines contrast. Default none; without effect on
    /// [`Shading::Overdraw`].
    pub gradient: Option<Gradient>,
    /// The base colour of everything, sRGB and alpha, in place of the colours and textures of
    /// materials and vertices; [`Self::texture`] is multiplied by it. Below an alpha of 255
    /// surfaces are transparent. `None` (default) is the model's.
    pub color: Option<[u8; 4]>,
    /// Roughness of all surfaces of [`Shading::Pbr`], 0..=1. `None` (default) is the materials'.
    pub roughness: Option<f32>,
    /// Metallic share of all surfaces of [`Shading::Pbr`], 0..=1. `None` (default) is the
    /// materials'.
    pub metallic: Option<f32>,
    /// Width of points in pixels, above 0. `None` (default): by their number and the image's size.
    pub point_size_px: Option<f32>,
    /// Width of lines and of the edges of wireframes in pixels, above 0 and at most 64. `None`
    /// (default): lines of one pixel, and edges in proportion to the image.
    pub line_width_px: Option<f32>,
    /// Faces that are culled. Default none.
    pub cull: CullMode,
    /// The method by which transparent surfaces are blended. Default [`Transparency::Sorted`].
    pub transparency: Transparency,
    /// Sharp edges, borders and silhouettes over the surfaces, where no opaque surface hides them.
    /// Default none.
    pub edges: Option<FeatureEdges>,
    /// If set, a picture that would be one colour gets edges of its own: one in which nearly all
    /// faces have one direction, in the default light, without textures, of at most 200,000
    /// triangles. Default not.
    pub edges_of_flat_views: bool,
    /// If set, a grid lies on the ground at the model's lowest point, in the units of the file.
    /// Default not.
    pub grid: bool,
    /// If set, a cross in the lower left corner shows the directions of the file's axes. Default
    /// not.
    pub axes: bool,
    /// The model's box with its sizes, to which the picture is fitted then. Default none.
    pub bounding_box: Option<BoundingBox>,
    /// Planes that cut the model away on one side. Default none.
    pub section: Section,
    /// If set, the edges of all triangles are drawn over the surfaces, where no opaque surface
    /// hides them. Default not; without effect on [`Shading::Wireframe`].
    pub wireframe: bool,
}

impl RenderOptions {
    /// The default background.
    pub const DEFAULT_BACKGROUND: [u8; 3] = [0xf2; 3];

    /// The options without lines over the model or around it.
    #[must_use]
    pub fn without_overlays(self) -> Self {
        Self {
            wireframe: false,
            edges: None,
            edges_of_flat_views: false,
            grid: false,
            axes: false,
            bounding_box: None,
            ..self
        }
    }
}

impl Default for RenderOptions {
    fn default() -> Self {
        Self {
            width: 1024,
            height: 768,
            samples: 4,
            camera: CameraOptions::default(),
            up: Up::default(),
            shading: Shading::default(),
            environment: Environment::default(),
            scene_lights: false,
            shadows: false,
            ground: Ground::None,
            exposure_ev: 0.0,
            tone_map: ToneMap::default(),
            program: None,
            lights: Vec::new(),
            ambient: None,
            specular: Specular::default(),
            shininess: None,
            levels: None,
            fog: None,
            texture: None,
            background: Some(Self::DEFAULT_BACKGROUND),
            gradient: None,
            color: None,
            roughness: None,
            metallic: None,
            point_size_px: None,
            line_width_px: None,
            cull: CullMode::None,
            transparency: Transparency::default(),
            edges: None,
            edges_of_flat_views: false,
            grid: false,
            axes: false,
            bounding_box: None,
            section: Section::default(),
            wireframe: false,
        }
    }
}

/// Light from all around.
#[derive(Debug, Clone, PartialEq)]
pub struct Environment {
    /// The surroundings. `None` (default) is the [studio](EnvironmentMap::studio), which turns with
    /// the camera; with [`RenderOptions::lights`] it is the ambient light alone.
    pub map: Option<Arc<EnvironmentMap>>,
    /// Rotation of the surroundings around the up direction, counter-clockwise from above, in
    /// degrees.
    pub rotation_deg: f64,
    /// Factor of the light, at least 0.
    pub intensity: f32,
}

impl Default for Environment {
    fn default() -> Self {
        Self {
            map: None,
            rotation_deg: 0.0,
            intensity: 1.0,
        }
    }
}

/// What a model stands on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Ground {
    /// Nothing.
    #[default]
    None,
    /// A level ground at the model's lowest point, which shows nothing but the model's soft shadow:
    /// the share that it hides of the light from above, which is that of
    /// [`RenderOptions::environment`] and of parallel [`RenderOptions::lights`]. On a transparent
    /// background it is black, with this share as alpha. From below the ground is invisible.
    /// Shadings that show numbers, and wireframes, have no ground; transparent surfaces, lines and
    /// points leave no shadow.
    Shadow,
}

/// Highlights of surfaces.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Specular {
    /// The model.
    pub model: SpecularModel,
    /// Specular colour of all materials, grey, linear. `None` (default) is that of the materials.
    pub strength: Option<f32>,
}

/// The specular term, of a shininess e.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum SpecularModel {
    /// No highlights.
    None,
    /// max(r·v, 0)ᵉ with the reflected light r (Phong 1975).
    #[default]
    Phong,
    /// max(n·h, 0)ᵉ with the half vector h (Blinn 1977): about four times the exponent gives a
    /// highlight of the same size.
    Blinn,
}

/// Fog that becomes denser with the distance from the eye; with a parallel projection, from the
/// plane of the camera's eye.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fog {
    /// Distance up to which there is no fog, in world units.
    pub start_world: f64,
    /// Distance at which there is nothing but fog, in world units.
    pub end_world: f64,
    /// Colour, sRGB. `None` is the background's, or the default background's if it is transparent.
    pub color: Option<[u8; 3]>,
}

/// The method by which transparent surfaces are blended, in front of the opaque ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Transparency {
    /// Triangles from the one with the farthest centre on: wrong where triangles cross, or overlap
    /// in cycles.
    #[default]
    Sorted,
    /// The fragments of each sample from the farthest on, by depth peeling: two passes for each
    /// layer, of which there are at most [`Self::MOST_LAYERS`]. Fragments of one depth are blended
    /// in the order of the scene.
    Exact,
    /// Weighted sums of all fragments (McGuire and Bavoil 2013): an approximation whose time does
    /// not grow with the layers.
    Weighted,
}

impl Transparency {
    /// The most layers that are peeled. Fragments in front of them are sorted by triangles.
    pub const MOST_LAYERS: u32 = 128;
}

/// Shading of surfaces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Shading {
    /// [`Self::Pbr`] if a material of the scene has a physically based description, else
    /// [`Self::Phong`].
    #[default]
    Automatic,
    /// Physically based: metals and dielectrics of any roughness, lit from all around, as glTF 2.0
    /// describes them. Materials without such a description are dielectrics.
    Pbr,
    /// Lighting once per face.
    Flat,
    /// Lighting at the vertices, interpolated.
    Gouraud,
    /// Lighting at every fragment.
    Phong,
    /// Lighting at every fragment, in four steps.
    Toon,
    /// Lighting once per face, in four steps.
    ToonFlat,
    /// Lighting at the vertices, interpolated, in four steps.
    ToonGouraud,
    /// The base colour without lighting.
    Unlit,
    /// Edges; faces hide the edges behind them.
    Wireframe,
    /// Normals in view space as colours: red to the right, green up, blue towards the eye.
    Normals,
    /// White at the model's nearest point, black at its furthest.
    Depth,
    /// Texture coordinates as colours: u red, v green.
    Uv,
    /// A colour for each triangle, by its number in the scene: [`face_color`](crate::face_color).
    /// With one sample per pixel the colours are exact.
    FaceId,
    /// Barycentric coordinates as colours: 1 at the first corner of a triangle is red, at the
    /// second green, at the third blue.
    Barycentric,
    /// The number n of fragments that cover each sample, hidden ones too: the codes 32·n, 8·n and
    /// n, at most 255, on black. The background's colour is not used.
    Overdraw,
}

impl Shading {
    /// The shading of a scene, which is not [`Self::Automatic`].
    #[must_use]
    pub fn of_scene(self, scene: &Scene) -> Self {
        match self {
            Self::Automatic if scene.materials.iter().any(|m| m.pbr.is_some()) => Self::Pbr,
            Self::Automatic => Self::Phong,
            chosen => chosen,
        }
    }

    /// True if light is in steps.
    #[must_use]
    pub fn is_toon(self) -> bool {
        matches!(self, Self::Toon | Self::ToonFlat | Self::ToonGouraud)
    }

    /// True if surfaces have their colours, lit or not.
    pub(crate) fn is_shaded(self) -> bool {
        !self.holds_numbers() && self != Self::Wireframe
    }

    /// True if light is computed once per face.
    #[must_use]
    pub fn is_flat(self) -> bool {
        matches!(self, Self::Flat | Self::ToonFlat)
    }

    /// True if the image shows numbers, which are stored unchanged, not light, which is
    /// sRGB-encoded.
    #[must_use]
    pub fn holds_numbers(self) -> bool {
        match self {
            Self::Normals
            | Self::Depth
            | Self::Uv
            | Self::FaceId
            | Self::Barycentric
            | Self::Overdraw => true,
            Self::Automatic
            | Self::Pbr
            | Self::Flat
            | Self::Gouraud
            | Self::Phong
            | Self::Toon
            | Self::ToonFlat
            | Self::ToonGouraud
            | Self::Unlit
            | Self::Wireframe => false,
        }
    }
}

/// The up direction of a model.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Up {
    /// The scene's up axis. A Z-up model is rotated: (x, y, z) → (x, z, −y).
    #[default]
    FromScene,
    /// This axis of the file, in place of the scene's; Z rotates the model as above.
    Axis(UpAxis),
    /// This direction. The model is not rotated, so world space is the file's space.
    Direction(DVec3),
}
