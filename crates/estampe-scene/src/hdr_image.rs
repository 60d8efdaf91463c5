//! Images of light: no upper bound, linear.

/// An image of linear 32-bit floats, row by row from the top: radiance, or what its producer
/// documents.
#[derive(Clone, PartialEq)]
pub struct HdrImage {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// `width * height` texels, 3 numbers each: R, G, B.
    pub rgb: Vec<f32>,
}

impl std::fmt::Debug for HdrImage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "HdrImage({}x{})", self.width, self.height)
    }
}
