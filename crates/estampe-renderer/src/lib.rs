#![forbid(unsafe_code)]
//! From a scene to frames, through the device of `estampe`.
//!
//! ```text
//! Scene ─┬─ scene_view      its unit space, the fitted camera, the lights
//!        ├─ materials       styles and textures
//!        ├─ geometry        vertex buffers, unshared faces, back-to-front order
//!        ├─ surface_pipelines   look × base colour × streams -> pipelines
//!        ├─ draw_plan       the draws, in order
//!        └─ frame           render: all of it, and the pixels back
//! ```
//!
//! [`render`] draws a [`Scene`](estampe_scene::Scene) as [`RenderOptions`] say, whose defaults are a
//! picture that a person would keep: three quarters from the front, fitted to the projected vertices,
//! key, fill and ambient light, smooth shading, anti-aliased, on a light background. Models of any
//! size are drawn in a unit space of their own, so 10³⁰ and 10⁻³⁰ look like 1.
//!
//! It knows neither files nor windows. Row numbers in the documentation are those of PIPELINE.md.

pub mod camera;
pub mod transforms;

mod alpha;
mod draw_plan;
mod frame;
mod geometry;
mod materials;
mod options;
mod scene_view;
mod shading;
mod surface_pipelines;

pub use alpha::composite_over;
pub use camera::{CameraOptions, Eye, ProjectionKind, ViewDirection};
pub use estampe::state::CullMode;
pub use frame::{Frame, FrameTimings, RenderError, render};
pub use options::{RenderOptions, Shading, Up};

/// Number of the pictures' generation: it grows whenever the same scene and options give other bytes
/// than before. CHANGELOG says which.
pub const PICTURE_VERSION: u32 = 1;
