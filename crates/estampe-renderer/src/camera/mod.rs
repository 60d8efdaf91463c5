//! Camera placement: view directions, and the distance at which a model fits its frame.
//!
//! * [`direction`]: azimuth, elevation and the named views;
//! * [`cloud`]: the points to which a camera is fitted;
//! * [`fit`]: the nearest eye that sees every vertex inside the frame less its margin;
//! * [`pinhole`]: cameras as computer vision writes them, K, R and t;
//! * [`placement`]: a camera from the caller's options, with near and far planes.

mod centred;
pub mod cloud;
pub mod direction;
pub mod fit;
pub mod pinhole;
pub mod placement;

pub use cloud::Cloud;
pub use direction::ViewDirection;
pub use pinhole::{Intrinsics, Pinhole};
pub use placement::{CameraOptions, Eye, PlacedCamera, ProjectionKind};

#[cfg(test)]
mod tests;
