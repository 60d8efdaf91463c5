//! Images in memory.

/// An image of 8-bit RGBA texels, row by row from the top, straight alpha.
///
/// Colour images hold sRGB-encoded values. Other images, such as normals or depths, hold the values
/// that their producer documents.
#[derive(Clone, PartialEq, Eq)]
pub struct Image {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// `width * height` texels, 4 bytes each: R, G, B, A.
    pub rgba: Vec<u8>,
}

impl Image {
    /// An image of one colour.
    ///
    /// # Panics
    /// When `width * height * 4` does not fit `usize`.
    #[must_use]
    pub fn filled(width: u32, height: u32, rgba: [u8; 4]) -> Self {
        let texels = (width as usize)
            .checked_mul(height as usize)
            .and_then(|n| n.checked_mul(4))
            .expect("the caller keeps images below the address space");
        let mut bytes = Vec::with_capacity(texels);
        while bytes.len() < texels {
            bytes.extend_from_slice(&rgba);
        }
        Self {
            width,
            height,
            rgba: bytes,
        }
    }

    /// The texel at column `x`, row `y` from the top.
    ///
    /// # Panics
    /// When the texel lies outside the image.
    #[must_use]
    pub fn texel(&self, x: u32, y: u32) -> [u8; 4] {
        assert!(
            x < self.width && y < self.height,
            "texel ({x}, {y}) outside {self:?}"
        );
        let at = (y as usize * self.width as usize + x as usize) * 4;
        [
            self.rgba[at],
            self.rgba[at + 1],
            self.rgba[at + 2],
            self.rgba[at + 3],
        ]
    }
}

impl std::fmt::Debug for Image {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Image({}x{})", self.width, self.height)
    }
}
