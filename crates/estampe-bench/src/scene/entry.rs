//! The list of scenes.

use super::{
    Detail, Scene, blend, blur_compute, clear, fill, foliage, gbuffer, heavy_fs, histogram_compute,
    instances, mandelbrot_compute, mid_tris, nbody_compute, particles, postfx, quad_draws, shadow,
    skybox, small_tris, stencil, textured, ui, wire,
};
use crate::frame::FrameSize;

/// The scenes that tables show together, with a mean of their own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SceneGroup {
    /// The eleven scenes of one feature each.
    Features,
    /// Their pictures in many draws.
    Draws,
    /// The states of real programs.
    Programs,
    /// Dispatches.
    Compute,
}

impl SceneGroup {
    /// Every group, in the order of tables.
    pub const ALL: [Self; 4] = [Self::Features, Self::Draws, Self::Programs, Self::Compute];

    /// What the mean of the group is a mean of.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::Features => "the eleven scenes",
            Self::Draws => "scenes in many draws",
            Self::Programs => "scenes of real programs",
            Self::Compute => "scenes of compute",
        }
    }
}

/// A scene's name and generator.
#[derive(Debug, Clone, Copy)]
pub struct SceneEntry {
    /// The name on the command line.
    pub name: &'static str,
    /// True if `peerbench` has the scene, so that it can be compared.
    pub is_peers: bool,
    /// True if there are no shaders in Rust, so that the scene is drawn in WGSL alone.
    pub is_wgsl_only: bool,
    /// The scenes that it is shown with.
    pub group: SceneGroup,
    make: fn(Detail, FrameSize) -> Scene,
}

impl SceneEntry {
    /// Generates the scene's data for frames of a size.
    #[must_use]
    pub fn make(&self, detail: Detail, size: FrameSize) -> Scene {
        (self.make)(detail, size)
    }

    /// The scene with this name.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static Self> {
        ALL.iter().find(|entry| entry.name == name)
    }
}

/// Every scene, in the order of reports.
pub const ALL: &[SceneEntry] = &[
    entry("clear", |_, _| clear::scene()),
    entry("fill", |_, _| fill::back_to_front()),
    entry("fill_front", |_, _| fill::front_to_back()),
    entry("blend", |_, _| blend::scene()),
    entry("small_tris", |detail, _| small_tris::scene(detail)),
    entry("mid_tris", |detail, _| mid_tris::single_sampled(detail)),
    entry("textured", |detail, _| textured::scene(detail)),
    entry("heavy_fs", |_, size| heavy_fs::scene(size)),
    entry("shadow", |detail, _| shadow::scene(detail)),
    entry("msaa4", |detail, _| mid_tris::multisampled(detail)),
    entry("instances", |detail, _| instances::scene(detail)),
    in_draws("fill_draws", |_, _| fill::as_draws()),
    in_draws("textured_draws", |detail, _| textured::as_draws(detail)),
    in_draws("many_draws", |detail, _| instances::many_draws(detail)),
    in_wgsl("ui", ui::scene),
    in_wgsl("gbuffer", gbuffer::scene),
    in_wgsl("stencil", stencil::scene),
    in_wgsl("postfx", |_, size| postfx::scene(size)),
    in_wgsl("particles", particles::scene),
    in_wgsl("foliage", foliage::scene),
    in_wgsl("wire", wire::scene),
    in_wgsl("skybox", skybox::scene),
    dispatched("mandelbrot_compute", |_, size| {
        mandelbrot_compute::scene(size)
    }),
    dispatched("blur_compute", blur_compute::scene),
    dispatched("nbody_compute", nbody_compute::scene),
    dispatched("histogram_compute", histogram_compute::scene),
    SceneEntry {
        is_peers: false,
        ..in_draws("quad_draws", |detail, _| quad_draws::scene(detail))
    },
];

const fn entry(name: &'static str, make: fn(Detail, FrameSize) -> Scene) -> SceneEntry {
    SceneEntry {
        name,
        is_peers: true,
        is_wgsl_only: false,
        group: SceneGroup::Features,
        make,
    }
}

/// Another scene's picture in many draws.
const fn in_draws(name: &'static str, make: fn(Detail, FrameSize) -> Scene) -> SceneEntry {
    SceneEntry {
        group: SceneGroup::Draws,
        ..entry(name, make)
    }
}

/// A scene whose frame is [`passes`].
const fn in_wgsl(name: &'static str, make: fn(Detail, FrameSize) -> Scene) -> SceneEntry {
    SceneEntry {
        is_wgsl_only: true,
        group: SceneGroup::Programs,
        ..entry(name, make)
    }
}

/// A scene of dispatches.
const fn dispatched(name: &'static str, make: fn(Detail, FrameSize) -> Scene) -> SceneEntry {
    SceneEntry {
        group: SceneGroup::Compute,
        ..in_wgsl(name, make)
    }
}
