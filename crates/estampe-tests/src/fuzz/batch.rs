//! Random meshes over one target, and the number of hits that each pixel must get.

use crate::Random;
use crate::geometry::clip_at;
use crate::shared_edges::{Corner, Kind, covered, mesh};

/// The greatest number of meshes in a batch: their hits fit into 8 bits, with room for some double
/// hits.
const MESHES: u32 = 100;

/// The number of triangles at which a batch is closed.
const TRIANGLES: usize = 40_000;

/// Meshes over one target.
#[derive(Debug)]
pub(super) struct Batch {
    pub(super) size: [u32; 2],
    pub(super) samples: u32,
    pub(super) meshes: Vec<(Kind, Vec<[Corner; 3]>)>,
    /// The w of all vertices of each mesh.
    pub(super) ws: Vec<f32>,
}

impl Batch {
    pub(super) fn random(random: &mut Random) -> Self {
        let size = random.pick(&[[64, 64], [32, 32], [16, 16], [61, 35], [130, 20]]);
        let samples = random.pick(&[1, 1, 1, 4, 4, 2, 8, 16]);
        let mut meshes = Vec::new();
        let mut ws = Vec::new();
        let mut triangles = 0;
        while meshes.len() < MESHES as usize && triangles < TRIANGLES {
            let kind = random.pick(&Kind::ALL);
            let made = mesh(random, kind, size);
            triangles += made.len();
            meshes.push((kind, made));
            ws.push(random.pick(&[1.0, 1.0, 0.5, 8.0]));
        }
        Self {
            size,
            samples,
            meshes,
            ws,
        }
    }

    /// Clip-space positions of some meshes' triangles.
    pub(super) fn positions(&self, meshes: &[usize]) -> Vec<u32> {
        let mut scalars = Vec::new();
        for &number in meshes {
            let (w, (_, triangles)) = (self.ws[number], &self.meshes[number]);
            for corner in triangles.iter().flatten() {
                let place = corner.map(|subpixels| subpixels as f32 / 256.0);
                scalars.extend(clip_at(self.size, place, 0.5, w));
            }
        }
        scalars.iter().map(|scalar| scalar.to_bits()).collect()
    }

    /// The expected number of hits of each pixel's samples by some meshes; `None` where a mesh need
    /// not cover the pixel.
    pub(super) fn wanted(&self, meshes: &[usize]) -> Vec<Option<u8>> {
        let [width, height] = self.size;
        let mut wanted = vec![Some(0); width as usize * height as usize];
        for &number in meshes {
            let (kind, triangles) = &self.meshes[number];
            let [columns, rows] = covered(*kind, self.size, triangles);
            for y in 0..height {
                for x in 0..width {
                    let hits = &mut wanted[(y * width + x) as usize];
                    let is_covered = x < columns && y < rows;
                    *hits = hits.filter(|_| is_covered).map(|hits| hits + 1);
                }
            }
        }
        wanted
    }
}

/// Some of the triangles whose boxes touch a pixel.
pub(super) fn around(triangles: &[[Corner; 3]], pixel: [u32; 2]) -> Vec<[Corner; 3]> {
    let touches = |triangle: &&[Corner; 3]| {
        (0..2).all(|axis| {
            let low = i32::try_from(pixel[axis] * 256).unwrap_or(i32::MAX - 256);
            let places = || triangle.iter().map(|corner| corner[axis]);
            places().min() <= Some(low + 256) && places().max() >= Some(low)
        })
    };
    triangles.iter().filter(touches).take(12).copied().collect()
}
