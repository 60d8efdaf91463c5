//! The image of the surroundings convolved with GGX lobes, one roughness a level, seen along the
//! normal (the approximation n = v of the split sum).
//!
//! Few samples are enough because each reads the mip level whose texels cover its share of the
//! lobe (J. Křivánek, M. Colbert, "Real-time Shading with Filtered Importance Sampling", 2008).

use super::cube::{CubeImage, side_f32, whole};
use super::sampling::{ggx_density, ggx_half_vector, hammersley};
use estampe_scene::Workers;
use glam::Vec3;
use std::f32::consts::PI;

/// The least side of a level: that of roughness 1.
const LEAST_SIDE: usize = 4;

/// A direction of a lobe around +Z.
struct LobeSample {
    direction: Vec3,
    /// n·l.
    weight: f32,
    /// Level of the image, the finest being 0.
    level: usize,
}

/// The convolved levels, each half as large as the one before. The first one is the image itself,
/// the last one has roughness 1, and between the two roughness rises evenly.
pub(super) fn convolved(levels: Vec<CubeImage>, workers: Workers) -> Vec<CubeImage> {
    let wanted = levels.iter().filter(|level| level.side() >= LEAST_SIDE);
    let count = u16::try_from(wanted.count()).unwrap_or(1).max(1);
    let mut convolved = Vec::with_capacity(levels.len());
    for (index, level) in (1..count).zip(levels.iter().skip(1)) {
        let roughness = f32::from(index) / f32::from(count - 1);
        // Wide lobes have few texels to fill, and need more samples.
        let samples = 16 << index.min(4);
        let lobe = lobe(roughness * roughness, samples, &levels);
        let total: f32 = lobe.iter().map(|sample| sample.weight).sum();
        let radiance = |normal: Vec3| {
            let (tangent, bitangent) = normal.any_orthonormal_pair();
            let mut sum = Vec3::ZERO;
            for sample in &lobe {
                let d = sample.direction;
                let direction = tangent * d.x + bitangent * d.y + normal * d.z;
                sum += levels[sample.level].sample(direction) * sample.weight;
            }
            sum / total
        };
        convolved.push(CubeImage::new(level.side(), radiance, workers));
    }
    convolved.splice(0..0, levels.into_iter().next());
    convolved
}

/// The directions in which a lobe of this α sees, for a normal and a view along +Z.
fn lobe(alpha: f32, samples: u16, levels: &[CubeImage]) -> Vec<LobeSample> {
    let side = side_f32(levels[0].side());
    let texel = 4.0 * PI / (6.0 * side * side);
    let samples_f32 = f32::from(samples);
    let sample = |point| {
        let half = ggx_half_vector(point, alpha);
        let direction = half * (2.0 * half.z) - Vec3::Z;
        // The density of l is D·(n·h) ÷ 4(v·h), and n·h = v·h.
        let density = ggx_density(half.z, alpha) * 0.25;
        let share = 1.0 / (samples_f32 * density);
        // A texel of level k covers 4ᵏ texels; one level more hides the samples' pattern.
        let level = 0.5 * libm::log2f(share / texel) + 1.0;
        LobeSample {
            direction,
            weight: direction.z,
            level: whole(libm::roundf(level.max(0.0))).min(levels.len() - 1),
        }
    };
    let samples = hammersley(samples).map(sample);
    samples.filter(|sample| sample.weight > 0.0).collect()
}
