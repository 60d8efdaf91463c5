//! The share of the light of uniform surroundings that a lobe reflects, by n·v and roughness: the
//! second half of the split sum, with the visibility term that shaders use.

use super::sampling::{TurnedPoint, hammersley, visible_half_vector};
use crate::shading::pbr::brdf;
use estampe_scene::Workers;
use glam::Vec3;
use std::f32::consts::TAU;
use std::sync::OnceLock;

/// Entries along each side of the table.
pub(crate) const ALBEDO_SIDE: u16 = 32;
/// Directions of an integral.
const SAMPLES: u16 = 144;

/// The table, row after row: n·v from 0 to 1 along rows, perceptual roughness from 0 to 1 down. Of
/// each entry the first number is multiplied by F0 and the second by F90, and their sum is the
/// reflected share; the third is that of a sheen of the roughness; the fourth is 1.
pub(crate) fn directional_albedos() -> &'static [[f32; 4]] {
    static TABLE: OnceLock<Vec<[f32; 4]>> = OnceLock::new();
    TABLE.get_or_init(|| {
        let last = f32::from(ALBEDO_SIDE - 1);
        let points: Vec<TurnedPoint> = hammersley(SAMPLES).map(TurnedPoint::new).collect();
        let row = |row: u16| {
            let roughness = f32::from(row) / last;
            let entry = |column: u16| {
                let n_dot_v = (f32::from(column) / last).max(1e-3);
                let [scale, bias] = ggx(n_dot_v, roughness, &points);
                [scale, bias, sheen(n_dot_v, roughness, &points), 1.0]
            };
            (0..ALBEDO_SIDE).map(entry).collect::<Vec<_>>()
        };
        Workers::default().map(0..ALBEDO_SIDE, row).concat()
    })
}

/// The view of a normal along +Z.
fn view(n_dot_v: f32) -> Vec3 {
    Vec3::new((1.0 - n_dot_v * n_dot_v).max(0.0).sqrt(), 0.0, n_dot_v)
}

/// The integral of D·V·F·(n·l) in Schlick's form: F = F0·(1 − c) + F90·c with c = (1 − v·h)⁵.
fn ggx(n_dot_v: f32, roughness: f32, points: &[TurnedPoint]) -> [f32; 2] {
    let alpha = brdf::alpha(roughness);
    let squared = alpha * alpha;
    let view = view(n_dot_v);
    // 2(n·v) ÷ the share of facets that the view sees.
    let seen = n_dot_v + (squared + (1.0 - squared) * n_dot_v * n_dot_v).sqrt();
    let mut sums = [0.0; 2];
    for point in points {
        let half = visible_half_vector(point, view, alpha);
        let v_dot_h = view.dot(half).clamp(0.0, 1.0);
        let light = half * (2.0 * v_dot_h) - view;
        if light.z <= 0.0 {
            continue;
        }
        // D is in the density of the samples.
        let weight = brdf::visibility_ggx(light.z, n_dot_v, alpha) * 2.0 * light.z * seen;
        let grazing = brdf::schlick(v_dot_h);
        sums[0] += (1.0 - grazing) * weight;
        sums[1] += grazing * weight;
    }
    sums.map(|sum| sum / f32::from(SAMPLES))
}

/// The integral of a sheen's D·V·(n·l), with directions evenly spread over the hemisphere.
fn sheen(n_dot_v: f32, roughness: f32, points: &[TurnedPoint]) -> f32 {
    let alpha = brdf::sheen_alpha(roughness);
    let view = view(n_dot_v);
    let mut sum = 0.0;
    for &TurnedPoint { first, direction } in points {
        let sin = (1.0 - first * first).max(0.0).sqrt();
        let light = Vec3::new(sin * direction[0], sin * direction[1], first);
        let half = (light + view).normalize_or(Vec3::Z);
        let density = brdf::density_sheen(half.z.clamp(0.0, 1.0), alpha);
        sum += density * brdf::visibility_sheen(first, n_dot_v) * first;
    }
    (sum * TAU / f32::from(SAMPLES)).min(1.0)
}
