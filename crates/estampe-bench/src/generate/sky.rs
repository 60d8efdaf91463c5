//! A cube map of a sky with clouds and a sun, in integers.

use super::MipChain;
use super::hash32;

/// Points of the cube have coordinates from −`HALF` to `HALF`; texels have odd ones.
const HALF: i32 = 512;
const HORIZON: [i32; 3] = [158, 178, 204];
const GROUND: [i32; 3] = [96, 84, 70];
const ZENITH: [i32; 3] = [40, 90, 190];
const CLOUD: [i32; 3] = [244, 244, 246];
const SUN: [i32; 3] = [255, 250, 225];

/// The six faces +x, −x, +y, −y, +z, −z as layers, 512² RGBA8 each, with all mip levels. The sun is
/// towards (2, 3, −6).
#[must_use]
pub fn sky_cube() -> MipChain {
    let side = HALF.unsigned_abs();
    let faces: Vec<MipChain> = (0..6)
        .map(|face| {
            MipChain::below(side, |x, y| {
                let [x, y] = [x, y].map(u32::cast_signed);
                let (across, up) = (2 * x + 1 - HALF, HALF - 2 * y - 1);
                color(match face {
                    0 => [HALF, up, -across],
                    1 => [-HALF, up, across],
                    2 => [across, HALF, -up],
                    3 => [across, -HALF, up],
                    4 => [across, up, HALF],
                    _ => [-across, up, -HALF],
                })
            })
        })
        .collect();
    MipChain::of_layers(&faces)
}

/// RGBA8 towards a point of the cube.
fn color(point: [i32; 3]) -> [u8; 4] {
    let from_corner = point.map(|coordinate| (coordinate + HALF).unsigned_abs());
    let octaves = noise(from_corner, 256, 16_001) * 4
        + noise(from_corner, 128, 16_002) * 2
        + noise(from_corner, 64, 16_003);
    let noise = octaves.cast_signed() / 7;
    let [x, y, z] = point.map(i64::from);
    let length_squared = x * x + y * y + z * z;
    // The sine of the elevation, −256..=256.
    let elevation = narrowed(y * 256 / length_squared.isqrt());
    let mut color = if elevation < 0 {
        mixed(HORIZON, GROUND, -elevation * 2 + (noise - 128) / 4)
    } else {
        mixed(HORIZON, ZENITH, elevation + elevation / 2)
    };
    if elevation > 0 {
        let cover = ((noise - 116) * 3).clamp(0, 256) * (elevation * 6).min(256) / 256;
        color = mixed(color, CLOUD, cover);
    }
    // The cosine of the angle to the sun, in 4096ths; the length in 64ths.
    let length = (length_squared * 4096).isqrt();
    let cosine = (2 * x + 3 * y - 6 * z) * 64 * 4096 / (7 * length);
    color = mixed(color, SUN, narrowed(cosine - 4030) * 6);
    let [red, green, blue] =
        color.map(|channel| u8::try_from(channel).expect("mixtures of bytes are bytes"));
    [red, green, blue, 255]
}

fn narrowed(value: i64) -> i32 {
    i32::try_from(value).expect("a small number")
}

/// From `a` at weight 0 to `b` at weight 256.
fn mixed(a: [i32; 3], b: [i32; 3], weight: i32) -> [i32; 3] {
    let weight = weight.clamp(0, 256);
    [0, 1, 2].map(|k| a[k] + (b[k] - a[k]) * weight / 256)
}

/// Random bytes at the corners of cubic cells, interpolated trilinearly in 256ths.
fn noise(point: [u32; 3], cell: u32, seed: u32) -> u32 {
    let [column, row, slice] = point.map(|coordinate| coordinate / cell);
    let [right, up, back] = point.map(|coordinate| coordinate % cell * 256 / cell);
    let corner = |i: u32, j: u32, k: u32| {
        hash32(seed ^ (column + i + 64 * (row + j) + 4096 * (slice + k))) & 255
    };
    let between = |a: u32, b: u32, weight: u32| (a * (256 - weight) + b * weight) / 256;
    let along = |j: u32, k: u32| between(corner(0, j, k), corner(1, j, k), right);
    let plane = |k: u32| between(along(0, k), along(1, k), up);
    between(plane(0), plane(1), back)
}
