//! The interface of a program: everything that the pipeline must know about its inputs and outputs.

use crate::SampleType;

/// The interpolation of a varying over its primitive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Interpolation {
    /// Perspective-correct.
    #[default]
    Smooth,
    /// Linear in window space.
    NoPerspective,
    /// The provoking vertex's value.
    Flat,
}

/// The position in a pixel at which a varying is interpolated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Sampling {
    /// At the pixel centre, which may lie outside the primitive if there are several samples.
    #[default]
    Center,
    /// At the centre if every sample is covered, else at the first covered sample; never outside
    /// the primitive.
    Centroid,
    /// At each sample: the fragment shader runs once per sample.
    Sample,
}

/// Depth output of a fragment shader.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum DepthOutput {
    /// No output: depth is interpolated, and tests run before the shader.
    #[default]
    None,
    /// Any depth: tests run after the shader.
    Any,
    /// Depths that are not below the interpolated one (Vulkan's `DepthGreater`). Fragments that
    /// already fail a *less* test with the interpolated depth are rejected before the shader. A
    /// depth below the interpolated one is raised to it.
    Greater,
    /// Depths that are not above the interpolated one (`DepthLess`). A depth above it is lowered to
    /// it.
    Less,
}

/// Inputs and outputs of a program.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Interface {
    /// Number of components (1 to 4) of each vertex attribute, by location.
    pub attributes: Vec<usize>,
    /// Interpolation of each scalar of the varyings.
    pub varyings: Vec<Interpolation>,
    /// Sampling position of each scalar of the varyings; scalars beyond the end of the list are
    /// interpolated at the centre.
    pub sampling: Vec<Sampling>,
    /// The scalars of the varyings, in ascending order, whose derivatives in the window fragments
    /// read.
    pub gradients: Vec<usize>,
    /// Number of colour targets that fragments write.
    pub color_targets: usize,
    /// Type of the numbers that fragments write to each colour target: a target's format must have
    /// the same. `None`, and targets beyond the end of the list, fit every format: no colour is
    /// written there, or by a shader in Rust, whose integers are the bits of floats.
    pub color_types: Vec<Option<SampleType>>,
    /// True if fragments may be discarded.
    pub discards: bool,
    /// Depth that fragments write.
    pub depth_output: DepthOutput,
    /// True if fragments read their window position.
    pub reads_position: bool,
    /// True if the only colour of fragments is the first four scalars of the varyings, unchanged.
    pub color_passthrough: bool,
    /// True if fragments take no derivatives, and sample no textures whose level of detail comes
    /// from derivatives.
    pub no_derivatives: bool,
    /// True if fragments are shaded once per sample: they read the sample index, or a varying is
    /// interpolated at each sample.
    pub per_sample: bool,
    /// True if fragments read the mask of covered samples.
    pub reads_coverage: bool,
    /// True if fragments write a sample mask.
    pub writes_sample_mask: bool,
    /// True if fragments store to memory that other invocations or draws can see. They are then
    /// shaded before the tests.
    pub stores: bool,
    /// True if what fragments store does not depend on the order in which different pixels are
    /// shaded. Otherwise a pass in which fragments store is drawn by one thread.
    pub stores_in_any_order: bool,
    /// True if fragments write a second colour for blending target 0, which is then the only
    /// target.
    pub dual_source: bool,
    /// True if vertices write a point size.
    pub writes_point_size: bool,
    /// Number of clip distances that vertices write, at most 8.
    pub clip_distances: usize,
    /// Number of cull distances that vertices write, at most 8.
    pub cull_distances: usize,
}

impl Interface {
    /// Number of scalars of all attributes together.
    #[must_use]
    pub fn attribute_scalars(&self) -> usize {
        self.attributes.iter().sum()
    }

    /// Number of scalars of a fragment: its varyings, and the derivatives of some of them along x,
    /// then along y.
    #[must_use]
    pub fn fragment_scalars(&self) -> usize {
        self.varyings.len() + 2 * self.gradients.len()
    }

    /// Number of clip and cull distances of a vertex.
    #[must_use]
    pub fn distances(&self) -> usize {
        self.clip_distances + self.cull_distances
    }

    /// Number of colours of a fragment: one per target, and the second one of dual-source blending.
    #[must_use]
    pub fn colors(&self) -> usize {
        self.color_targets + usize::from(self.dual_source)
    }
}
