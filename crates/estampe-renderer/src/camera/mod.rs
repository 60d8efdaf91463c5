//! Where a picture is taken from: view directions, and the distance at which a model fits its frame.
//!
//! * [`direction`]: azimuth, elevation and the named views;
//! * [`cloud`]: the points that it is fitted to;
//! * [`fit`]: the nearest eye that sees every vertex inside the frame less its margin;
//! * [`placement`]: a camera from what the caller asked for, with near and far planes.

pub mod cloud;
pub mod direction;
pub mod fit;
pub mod placement;

pub use cloud::Cloud;
pub use direction::ViewDirection;
pub use placement::{CameraOptions, Eye, PlacedCamera, ProjectionKind};

#[cfg(test)]
mod tests;
