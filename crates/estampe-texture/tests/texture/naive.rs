//! A naive implementation of sampling as docs/NUMERICS.md defines it, one fragment and one texel at
//! a time, without code of the crate; and textbook sampling in f64, to bound the error.

#![expect(
    clippy::cast_possible_truncation,
    reason = "texels and levels are whole numbers within range; NaN does not reach a cast"
)]

use estampe_format::srgb::LINEAR_FROM_SRGB;
use estampe_texture::{AddressMode, FilterMode, MipLevel, Rgba8Texture};

fn max(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

fn min(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// λ of a quad from its first lane's derivatives.
pub(super) fn lod_of_quad(sampled: &Rgba8Texture, u: [f32; 3], v: [f32; 3]) -> f32 {
    let base = sampled.texture().levels[0];
    let (w, h) = (base.width as f32, base.height as f32);
    let rho2 = |other: usize| {
        let (x, y) = ((u[other] - u[0]) * w, (v[other] - v[0]) * h);
        x * x + y * y
    };
    let bits = max(max(rho2(1), rho2(2)), 0.0).to_bits();
    let e = (bits >> 23) as f32 - 127.0;
    let t = (bits & 0x7F_FFFF) as f32 / 8_388_608.0;
    let [a0, a1, a2, a3] = [1.438_725_7_f32, -0.677_783_9, 0.321_188_8, -0.082_130_6];
    0.5 * (((((a3 * t + a2) * t + a1) * t + a0) * t) + e)
}

/// The texel in filtering units: encoded values, or linear values for sRGB's R, G and B.
fn texel(sampled: &Rgba8Texture, level: MipLevel, x: u32, y: u32) -> [f32; 4] {
    let texture = sampled.texture();
    let word = texture.texels[(level.offset + y * level.width + x) as usize];
    let [r, g, b, a] = word.to_le_bytes();
    if texture.format.is_srgb() {
        let decode = |code: u8| LINEAR_FROM_SRGB[usize::from(code)];
        [decode(r), decode(g), decode(b), f32::from(a)]
    } else {
        [r, g, b, a].map(f32::from)
    }
}

/// The two texels of one axis and the fraction between them.
fn axis(u: f32, size: u32, mode: AddressMode, filter: FilterMode) -> ([u32; 2], f32) {
    let length = size as f32;
    let s = match mode {
        AddressMode::Repeat => max(u - u.floor(), 0.0),
        AddressMode::MirrorRepeat => 1.0 - ((u - 2.0 * (u * 0.5).floor()) - 1.0).abs(),
        _ => u,
    };
    let mut q = s * length;
    if filter == FilterMode::Linear {
        q -= 0.5;
    }
    if mode != AddressMode::Repeat {
        q = min(max(q, 0.0), length - 1.0);
    }
    let first = q.floor();
    let wrapped = |at: f32| {
        if mode == AddressMode::Repeat {
            (at as i64).rem_euclid(i64::from(size)) as u32
        } else {
            (at as u32).min(size - 1)
        }
    };
    ([wrapped(first), wrapped(first + 1.0)], q - first)
}

fn sample_one(
    sampled: &Rgba8Texture,
    level: usize,
    u: f32,
    v: f32,
    filter: FilterMode,
) -> [f32; 4] {
    let sampler = sampled.sampler();
    let levels = &sampled.texture().levels;
    let level = levels[level.min(levels.len() - 1)];
    let ([x0, x1], fx) = axis(u, level.width, sampler.address_mode_u, filter);
    let ([y0, y1], fy) = axis(v, level.height, sampler.address_mode_v, filter);
    let c = |x, y| texel(sampled, level, x, y);
    if filter == FilterMode::Nearest {
        return c(x0, y0);
    }
    let (c00, c10, c01, c11) = (c(x0, y0), c(x1, y0), c(x0, y1), c(x1, y1));
    std::array::from_fn(|i| {
        let top = c00[i] + (c10[i] - c00[i]) * fx;
        let bottom = c01[i] + (c11[i] - c01[i]) * fx;
        top + (bottom - top) * fy
    })
}

pub(super) fn sample(sampled: &Rgba8Texture, u: f32, v: f32, lod: f32) -> [f32; 4] {
    let sampler = sampled.sampler();
    let lod = min(max(lod, sampler.lod_min_clamp), sampler.lod_max_clamp);
    let filter = if lod <= 0.0 {
        sampler.mag_filter
    } else {
        sampler.min_filter
    };
    let lod = min(max(lod, 0.0), (sampled.texture().levels.len() - 1) as f32);
    let color = if sampler.mipmap_filter == FilterMode::Nearest {
        sample_one(sampled, (lod + 0.5).floor() as usize, u, v, filter)
    } else {
        let level = lod.floor();
        let a = sample_one(sampled, level as usize, u, v, filter);
        let b = sample_one(sampled, level as usize + 1, u, v, filter);
        std::array::from_fn(|i| a[i] + (b[i] - a[i]) * (lod - level))
    };
    let is_srgb = sampled.texture().format.is_srgb();
    std::array::from_fn(|i| {
        if is_srgb && i < 3 {
            color[i]
        } else {
            color[i] * (1.0 / 255.0)
        }
    })
}

/// The trilinear, tiled sample of textbooks in f64; λ = log₂ of the longer derivative in texels.
pub(super) fn trilinear_f64(sampled: &Rgba8Texture, uv: [f64; 2], rho: f64) -> [f64; 4] {
    let levels = &sampled.texture().levels;
    let lod = libm::log2(rho).clamp(0.0, (levels.len() - 1) as f64);
    let of_level = |level: usize| {
        let level = levels[level.min(levels.len() - 1)];
        let at = [
            uv[0] * f64::from(level.width) - 0.5,
            uv[1] * f64::from(level.height) - 0.5,
        ];
        let mut sum = [0.0; 4];
        for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let near = |at: f64, step: i64, size: u32| {
                let weight = at - at.floor();
                let texel = (at.floor() as i64 + step).rem_euclid(i64::from(size)) as u32;
                (texel, if step == 1 { weight } else { 1.0 - weight })
            };
            let (x, wx) = near(at[0], dx, level.width);
            let (y, wy) = near(at[1], dy, level.height);
            for (sum, c) in sum.iter_mut().zip(texel(sampled, level, x, y)) {
                *sum += f64::from(c) * wx * wy / 255.0;
            }
        }
        sum
    };
    let (a, b) = (
        of_level(lod.floor() as usize),
        of_level(lod.floor() as usize + 1),
    );
    std::array::from_fn(|i| a[i] + (b[i] - a[i]) * (lod - lod.floor()))
}
