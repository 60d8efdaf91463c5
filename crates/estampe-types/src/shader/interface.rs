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

/// Whether a fragment shader writes its depth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum DepthOutput {
    /// It does not: depth is interpolated, and tests run before the shader.
    #[default]
    None,
    /// It may write any depth: tests run after the shader.
    Any,
}

/// What goes into a program and comes out.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Interface {
    /// How many numbers each vertex attribute has (1 to 4), by location.
    pub attributes: Vec<usize>,
    /// How each scalar of the varyings is interpolated.
    pub varyings: Vec<Interpolation>,
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
    /// Whether vertices set a point size.
    pub writes_point_size: bool,
}

impl Interface {
    /// Scalars of all attributes together.
    #[must_use]
    pub fn attribute_scalars(&self) -> usize {
        self.attributes.iter().sum()
    }
}
