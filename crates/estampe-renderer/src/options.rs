//! What a picture is to look like.

use crate::camera::CameraOptions;
use estampe::state::CullMode;
use estampe_scene::{Image, Light, UpAxis};
use glam::DVec3;

/// Everything that can be asked of a picture. The default is a picture that a person would keep.
#[derive(Debug, Clone, PartialEq)]
pub struct RenderOptions {
    /// Width in pixels, 1..=16384. Default 1024.
    pub width: u32,
    /// Height in pixels, 1..=16384. Default 768.
    pub height: u32,
    /// Samples per pixel, 1 or 4. Default 4.
    pub samples: u32,
    /// Where the picture is taken from.
    pub camera: CameraOptions,
    /// What points up. Default what the scene says.
    pub up: Up,
    /// How surfaces look. Default [`Shading::Phong`].
    pub shading: Shading,
    /// Lights in world space, in place of those that go with the camera. Default none.
    pub lights: Vec<Light>,
    /// Ambient light, times the base colour. `None` (default) is 0.18.
    pub ambient: Option<f32>,
    /// A base-colour texture, sRGB, in place of the materials' own colours and textures.
    pub texture: Option<Image>,
    /// The background, sRGB, or `None` for a transparent one. Default #f2f2f2.
    pub background: Option<[u8; 3]>,
    /// Which faces are left out. Default none.
    pub cull: CullMode,
}

impl RenderOptions {
    /// The background where nothing else is asked for.
    pub const DEFAULT_BACKGROUND: [u8; 3] = [0xf2; 3];
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
            lights: Vec::new(),
            ambient: None,
            texture: None,
            background: Some(Self::DEFAULT_BACKGROUND),
            cull: CullMode::None,
        }
    }
}

/// How surfaces look.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Shading {
    /// One light for each face.
    Flat,
    /// Light at the vertices, interpolated.
    Gouraud,
    /// Light at every pixel.
    #[default]
    Phong,
    /// Light at every pixel, in four steps.
    Toon,
    /// The base colour without light.
    Unlit,
    /// Edges; faces hide what lies behind them.
    Wireframe,
    /// Normals in view space as colours: red to the right, green up, blue towards the eye.
    Normals,
    /// White at the model's nearest point, black at its furthest.
    Depth,
    /// Texture coordinates as colours: u red, v green.
    Uv,
}

impl Shading {
    /// Whether the picture holds numbers, which are stored as they are, instead of light, which is
    /// stored by the sRGB curve.
    #[must_use]
    pub fn holds_numbers(self) -> bool {
        matches!(self, Self::Normals | Self::Depth | Self::Uv)
    }
}

/// What points up.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Up {
    /// What the scene says: a Z-up model is turned, (x, y, z) → (x, z, −y).
    #[default]
    FromScene,
    /// This axis of the file, whatever the scene says; Z turns the model as above.
    Axis(UpAxis),
    /// This direction; the model is not turned, so the world is the file's space.
    Direction(DVec3),
}
