//! Multisampling state.

/// Samples of a pipeline: WebGPU's `GPUMultisampleState`, with Vulkan's sample shading.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct MultisampleState {
    /// Samples per pixel: 1, 2, 4, 8 or 16. Default 1.
    pub count: u32,
    /// The samples that may change, bit by bit. Default all.
    pub mask: u32,
    /// If set, the alpha of target 0 decides how many samples of a fragment are kept. Default not.
    pub alpha_to_coverage_enabled: bool,
    /// If set, fragments are shaded once for each sample, regardless of the shader. Default not.
    pub sample_shading_enabled: bool,
}

impl MultisampleState {
    /// So many samples per pixel, all of which may change.
    #[must_use]
    pub const fn new(count: u32) -> Self {
        Self {
            count,
            mask: u32::MAX,
            alpha_to_coverage_enabled: false,
            sample_shading_enabled: false,
        }
    }
}

impl Default for MultisampleState {
    /// One sample per pixel.
    fn default() -> Self {
        Self::new(1)
    }
}
