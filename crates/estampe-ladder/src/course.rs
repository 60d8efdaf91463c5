//! What the rungs share: the device that draws, the model, and the course's numbers.

use crate::{LadderError, Model, Screen};
use estampe::state::Viewport;
use estampe::{
    AddressMode, Device, DeviceDescriptor, Mat4, SampledTexture, SamplerDescriptor,
    TextureDescriptor, TextureFormat,
};
use estampe_renderer::transforms::view::CameraFrame;
use estampe_renderer::transforms::{projection, to_f32};
use estampe_scene::Image;
use glam::DVec3;

/// The device and the model of all rungs, and the course's numbers.
///
/// The course puts a model into the cube −1..1 of world space, x to the right, y up, and z towards
/// the viewer.
#[derive(Debug)]
pub struct Course {
    /// The device that draws.
    pub device: Device,
    /// The model.
    pub model: Model,
}

impl Course {
    /// Width and height of the pictures of a model, in pixels.
    pub const SIZE: u32 = 800;

    /// The unit direction towards the light: the light comes from the viewer.
    pub const TOWARDS_LIGHT: [f32; 3] = [0.0, 0.0, 1.0];

    /// The eye from rung 12 on.
    pub const EYE: [f32; 3] = [1.0, 1.0, 2.0];

    /// The point that the eye looks at.
    pub const CENTRE: [f32; 3] = [0.0, 0.0, 0.0];

    /// The direction that is up in the picture.
    pub const UP: [f32; 3] = [0.0, 1.0, 0.0];

    /// The course with the built-in model, on a device with the machine's SIMD level and threads.
    ///
    /// # Errors
    /// If the system starts no threads.
    pub fn new() -> Result<Self, LadderError> {
        let device = Device::new(&DeviceDescriptor::default())?;
        Ok(Self::with(device, Model::builtin()))
    }

    /// The course with any model, on any device.
    #[must_use]
    pub fn with(device: Device, model: Model) -> Self {
        Self { device, model }
    }

    /// Clip space of the camera of rung 12: from [`Course::EYE`] to [`Course::CENTRE`], by the
    /// central projection, with the nearest depth 1. The corners of the cube −1..1 are √3 from the
    /// origin, and so the planes at ±1.75 enclose it.
    #[must_use]
    pub fn camera() -> Mat4 {
        let [eye, centre, up] =
            [Self::EYE, Self::CENTRE, Self::UP].map(|v| DVec3::from(v.map(f64::from)));
        let view_from_world = CameraFrame::look_at(eye, centre, up).centred_view_from_world(centre);
        let clip_from_view = projection::central(eye.distance(centre), 1.75, -1.75);
        to_f32(&(Screen::REVERSED * clip_from_view * view_from_world)).into()
    }

    /// The window that pictures before the viewport matrix have in the pipeline: half a pixel to
    /// the right and up, because the course's (x + 1)·W/2 names a pixel by its centre.
    pub const VIEWPORT: Viewport = Viewport {
        x: 0.5,
        y: -0.5,
        ..Viewport::of_target(Self::SIZE, Self::SIZE)
    };

    /// The model's texture with the course's sampling: the texel (⌊u·W⌋, ⌊v·H⌋), repeated.
    ///
    /// # Errors
    /// If the texture does not fit the device's limits.
    pub fn texture(&self) -> Result<SampledTexture, LadderError> {
        let Image {
            width,
            height,
            rgba,
        } = &self.model.texture;
        let descriptor = TextureDescriptor::new_2d(*width, *height, TextureFormat::Rgba8Unorm);
        let texture = self.device.create_texture_with_data(&descriptor, &[rgba])?;
        let sampler = self.device.create_sampler(&SamplerDescriptor {
            address_mode_u: AddressMode::Repeat,
            address_mode_v: AddressMode::Repeat,
            ..SamplerDescriptor::default()
        })?;
        Ok(self.device.sampled_texture(&texture.view(), &sampler)?)
    }

    /// The pixel of a point of the cube −1..1 in a picture of [`Course::SIZE`], x to the right and
    /// y up: ⌊(x + 1)·W/2⌋, ⌊(y + 1)·H/2⌋, as the rungs before the viewport matrix have it.
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "points of the cube have small pixels"
    )]
    pub fn pixel([x, y, _]: [f32; 3]) -> [i32; 2] {
        let half = Self::SIZE as f32 / 2.0;
        [x, y].map(|coordinate| ((coordinate + 1.0) * half) as i32)
    }
}
