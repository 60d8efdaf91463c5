//! What the rungs share: the device that draws, the model, and the course's numbers.

use crate::{LadderError, Model};
use estampe::{Device, DeviceDescriptor};

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
