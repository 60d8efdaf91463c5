//! What a program reads and writes: all that the pipeline must know about it.

/// How a varying is carried from the vertices to a fragment.
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

/// Where in a pixel a varying is interpolated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Sampling {
    /// At the centre, which may lie outside the primitive when there are several samples.
    #[default]
    Center,
    /// At the centre if every sample is covered, else at the first covered sample: never outside the primitive.
    Centroid,
    /// At each sample: the fragment is shaded once for every sample.
    Sample,
}

/// Whether a fragment shader writes its depth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum DepthOutput {
    /// It does not: depth is interpolated, and tests run before the shader.
    #[default]
    None,
    /// It may write any depth: tests run after the shader.
    Any,
    /// It writes depths not below the interpolated one (Vulkan's `DepthGreater`): a fragment that is in front only
    /// of farther things is tested before the shader, too. A depth below is raised to the interpolated one.
    Greater,
    /// It writes depths not above the interpolated one (`DepthLess`); one above is lowered to it.
    Less,
}

/// What goes into a program and comes out.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Interface {
    /// How many numbers each vertex attribute has (1 to 4), by location.
    pub attributes: Vec<usize>,
    /// How each scalar of the varyings is interpolated.
    pub varyings: Vec<Interpolation>,
    /// Where each scalar of the varyings is interpolated; those beyond the list's end at the centre.
    pub sampling: Vec<Sampling>,
    /// How many colour targets the fragments write.
    pub color_targets: usize,
    /// Whether fragments may be discarded.
    pub discards: bool,
    /// Whether fragments write depth.
    pub depth_output: DepthOutput,
    /// Whether fragments read their position.
    pub reads_position: bool,
    /// Whether the fragments' one colour is the varyings' first four scalars as they are.
    pub passes_color: bool,
    /// Whether a fragment's colours depend on its own inputs alone: no derivatives, and so no textures whose
    /// level of detail comes from them.
    pub independent_fragments: bool,
    /// Whether fragments are shaded once for each sample: they read the sample's number, or a varying at each
    /// sample.
    pub per_sample: bool,
    /// Whether fragments read which samples are covered.
    pub reads_coverage: bool,
    /// Whether fragments write which samples are kept.
    pub writes_sample_mask: bool,
    /// Whether fragments store where others can see it, so that they must be shaded before they are tested.
    pub stores: bool,
    /// Whether fragments give a second colour for blending target 0, the only one.
    pub dual_source: bool,
    /// Whether vertices set a point size.
    pub writes_point_size: bool,
    /// How many clip distances vertices give, at most 8.
    pub clip_distances: usize,
    /// How many cull distances vertices give, at most 8.
    pub cull_distances: usize,
}

impl Interface {
    /// Scalars of all attributes together.
    #[must_use]
    pub fn attribute_scalars(&self) -> usize {
        self.attributes.iter().sum()
    }

    /// Clip and cull distances of a vertex.
    #[must_use]
    pub fn distances(&self) -> usize {
        self.clip_distances + self.cull_distances
    }

    /// How many colours a fragment gives: one for each target, and the second one of dual-source blending.
    #[must_use]
    pub fn colors(&self) -> usize {
        self.color_targets + usize::from(self.dual_source)
    }
}
