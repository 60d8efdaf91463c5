#![forbid(unsafe_code)]
//! Rendering of scenes to images, with the device of `estampe`.
//!
//! ```text
//! Scene ─┬─ section         what planes cut away, and caps
//!        ├─ scene_view      unit space, fitted camera, lights
//!        ├─ environment     light from all around; pbr_lighting puts it into view space
//!        ├─ shadows         maps of what the lights see
//!        ├─ ground          the shadow on what the model stands on
//!        ├─ backdrop        the gradient behind everything
//!        ├─ behind          what is seen through surfaces that transmit light
//!        ├─ materials       surface styles and textures
//!        ├─ alpha_levels    mip levels of colours with alpha
//!        ├─ pbr_materials   what physically based materials add
//!        ├─ geometry        vertex buffers, unshared faces, back-to-front order
//!        ├─ surface_program     a program of the caller's, in place of those of `shading`
//!        ├─ material_programs   the shader of each surface, and what it reads
//!        ├─ surface_pipelines   material programs × vertex streams -> pipelines
//!        ├─ frame_style     what all draws of a frame have in common
//!        ├─ attachments     the images that a frame is drawn to
//!        ├─ draw_plan       the draws, in order
//!        ├─ frame_passes    the passes: one, or those of order-independent transparency
//!        ├─ frame           render: all of it, and reading back the pixels
//!        ├─ feature_edges   sharp edges, borders and silhouettes
//!        ├─ guides          grid, axes, and the model's box with its sizes
//!        ├─ light           frames of light, in place of codes for a screen
//!        ├─ strokes         lines of a width, which the model hides
//!        ├─ texture_detail  the mip levels of textures that a picture can sample
//!        ├─ surface_points  positions, normals and other numbers of what is seen
//!        └─ text            labels on the image
//! ```
//!
//! [`render`] draws a [`Scene`](estampe_scene::Scene) with [`RenderOptions`]. The defaults suit a
//! presentable image: a three-quarter view from the front, fitted to the projected vertices, with
//! key, fill and ambient light, Phong shading and anti-aliasing, on a light background. Models of
//! any size are drawn in a unit space of their own, so 10³⁰ and 10⁻³⁰ look like 1.
//!
//! The crate depends on neither files nor windows.
//! Row numbers in the documentation are those of `docs/PIPELINE.md`.

pub mod camera;

mod alpha;
mod alpha_levels;
mod attachments;
mod backdrop;
mod behind;
mod canvas;
mod draw_plan;
mod environment;
mod feature_edges;
mod frame;
mod frame_passes;
mod frame_style;
mod geometry;
mod gradient;
mod ground;
mod guides;
mod light;
mod material_programs;
mod materials;
mod options;
mod pbr_lighting;
mod pbr_materials;
mod pixel_history;
mod render_error;
mod scene_view;
mod section;
#[doc(hidden)]
pub mod shading;
mod shadows;
mod strokes;
mod surface_pipelines;
mod surface_points;
mod surface_program;
mod text;
mod texture_detail;

/// The README's snippet, compiled and run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

pub use alpha::composite_over;
pub use camera::{CameraOptions, Eye, Intrinsics, Pinhole, ProjectionKind, ViewDirection};
pub use environment::{EnvironmentError, EnvironmentMap};
pub use estampe::state::CullMode;
pub use estampe::transforms;
pub use feature_edges::FeatureEdges;
pub use frame::{Frame, FrameStage, FrameTimings, TransparentLayers};
pub use frame::{render, render_light, render_spent, render_watched};
pub use geometry::face_colors::face_color;
pub use gradient::{Gradient, GradientShape};
pub use guides::BoundingBox;
pub use light::LightImage;
pub use options::{
    Environment, Fog, Ground, RenderOptions, Shading, Specular, SpecularModel, Transparency, Up,
};
pub use pixel_history::{FramePixel, FrameStages, VertexSpaces, inspect, inspect_stages};
pub use render_error::RenderError;
pub use section::{Section, SectionPlane};
pub use shading::pbr::tone_map::ToneMap;
pub use surface_points::{SurfacePoint, SurfacePoints, surface_points};
pub use surface_program::{SurfaceBindings, SurfaceProgram, SurfaceValues};
pub use text::{TextHeight, TextStyle, character_width_px, draw_text, text_width_px};
pub use texture_detail::{first_level_of_texture, first_levels};

/// Version of the images. It rises whenever the same scene and options give other bytes than
/// before; CHANGELOG lists the changes.
pub const PICTURE_VERSION: u32 = 2;
