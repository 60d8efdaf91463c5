//! The reflectance of a thin film, as the appendix of KHR_materials_iridescence writes it, in the
//! units of the paper (metres and radians per metre).

use std::f64::consts::PI;

/// The index of refraction of a dielectric with this reflectance in air.
#[must_use]
pub fn ior_of_f0(f0: f64) -> f64 {
    let root = f0.clamp(0.0, 0.9999).sqrt();
    (1.0 + root) / (1.0 - root)
}

/// The reflectance of film and base for light at an angle with the cosine `cos_1`, by channel.
///
/// `base_f0` is the base's reflectance in air; outside of the film is air.
#[must_use]
pub fn reflectance(ior: f64, thickness_nm: f64, base_f0: [f64; 3], cos_1: f64) -> [f64; 3] {
    let schlick = |r0: f64, cosine: f64| r0 + (1.0 - r0) * (1.0 - cosine).powi(5);
    let normal = |into: f64, from: f64| ((into - from) / (into + from)).powi(2);
    let sine2 = (1.0 - cos_1 * cos_1) / (ior * ior);
    let cos_2 = (1.0 - sine2).sqrt();
    let r12 = schlick(normal(ior, 1.0), cos_1);
    let t121 = 1.0 - r12;
    let path_m = 2.0 * ior * thickness_nm * 1e-9 * cos_2;
    let base_ior = base_f0.map(ior_of_f0);
    let phase = base_ior.map(|base| PI + if base < ior { PI } else { 0.0 });
    let r23 = base_ior.map(|base| schlick(normal(base, ior), cos_2));
    let s1 = sensitivity(path_m, phase);
    let s2 = sensitivity(2.0 * path_m, phase.map(|shift| 2.0 * shift));
    std::array::from_fn(|c| {
        let both = (r12 * r23[c]).clamp(1e-5, 0.9999);
        let rest = t121 * t121 * r23[c] / (1.0 - both);
        let wave = rest - t121;
        let sum = r12 + rest + wave * both.sqrt() * 2.0 * s1[c] + wave * both * 2.0 * s2[c];
        sum.clamp(0.0, 1.0)
    })
}

/// The Fourier transform of the sensitivities, as linear sRGB.
fn sensitivity(path_m: f64, shift: [f64; 3]) -> [f64; 3] {
    let phase = 2.0 * PI * path_m;
    let gaussian = |value: f64, position: f64, variance: f64, shift: f64| {
        value
            * (2.0 * PI * variance).sqrt()
            * (position * phase + shift).cos()
            * (-phase * phase * variance).exp()
            / 1.0685e-7
    };
    let x = gaussian(5.4856e-13, 1.6810e6, 4.3278e9, shift[0])
        + gaussian(9.7470e-14, 2.2399e6, 4.5282e9, shift[0]);
    let y = gaussian(4.4201e-13, 1.7953e6, 9.3046e9, shift[1]);
    let z = gaussian(5.2481e-13, 2.2084e6, 6.6121e9, shift[2]);
    [
        3.2404542 * x - 1.5371385 * y - 0.4985314 * z,
        -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
        0.0556434 * x - 0.2040259 * y + 1.0572252 * z,
    ]
}
