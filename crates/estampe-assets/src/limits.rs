//! Limits on the resources that a file may require.

use crate::AssetError;

/// Upper bounds on all sizes that a file can state, checked before memory is allocated.
///
/// The defaults are generous: a file that exceeds them is far more likely an accident or an attack
/// than a model.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Limits {
    /// Bytes of one file (1 GiB).
    pub max_file_bytes: u64,
    /// Vertices of one model (50 million).
    pub max_vertices: u64,
    /// Triangles of one model after polygons are split; also its lines, and its points (100
    /// million).
    pub max_triangles: u64,
    /// Corners of one polygon (16384). A larger polygon is omitted with a warning.
    pub max_polygon_corners: u64,
    /// Objects of one model (65536). Further objects are joined to the last one.
    pub max_meshes: u64,
    /// Materials of one model (65536).
    pub max_materials: u64,
    /// Side files (material libraries, textures) that one model may request (1024).
    pub max_side_files: u64,
    /// Pixels of one image (16384²).
    pub max_image_pixels: u64,
    /// Pixels of all images of one model together (2 · 16384²).
    pub max_total_image_pixels: u64,
    /// Texels of a texture's longer side (16384, the device's limit). A larger texture of a model
    /// is halved while it is decoded, until it is within the limit.
    pub max_texture_side: u32,
    /// Warnings that are kept as text; further ones are only counted (100).
    pub max_warnings: usize,
    /// Threads that read one file; 0, the default, is one per processor. Results do not depend on
    /// it.
    pub threads: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            max_file_bytes: 1 << 30,
            max_vertices: 50_000_000,
            max_triangles: 100_000_000,
            max_polygon_corners: 16_384,
            max_meshes: 65_536,
            max_materials: 65_536,
            max_side_files: 1024,
            max_image_pixels: 16_384 * 16_384,
            max_total_image_pixels: 2 * 16_384 * 16_384,
            max_texture_side: 16_384,
            max_warnings: 100,
            threads: 0,
        }
    }
}

impl Limits {
    /// The first mip level of a texture whose sides are within the limit.
    pub(crate) fn least_level(&self, (width, height): (u32, u32)) -> u32 {
        let longest = width.max(height);
        let most = self.max_texture_side.max(1);
        { 0..u32::BITS }
            .find(|&level| longest >> level <= most)
            .unwrap_or(0)
    }

    /// Checks that `count` of `what` is at most `limit`.
    ///
    /// # Errors
    /// `LimitExceeded` with both numbers.
    pub(crate) fn check(what: &str, count: u64, limit: u64) -> Result<(), AssetError> {
        if count <= limit {
            return Ok(());
        }
        Err(AssetError::limit_exceeded(
            format!("{count} {what} are more than the limit of {limit}"),
            "split the file, or raise the limit if you trust it",
        ))
    }
}
