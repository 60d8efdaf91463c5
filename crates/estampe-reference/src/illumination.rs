//! Illumination in f64: ambient, diffuse and specular light, attenuation, fog, quantised light.
//!
//! Written from the formulas, one light and one channel at a time, with std's powers: it shares no
//! code with the shaders of `estampe-renderer`, whose tests compare with it. All vectors are in one
//! space; colours are linear. Row F3.

/// Where light comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Source {
    /// The unit direction towards the light.
    Direction([f64; 3]),
    /// A point, and the distance at which its light ends; infinite if it never does.
    Position([f64; 3], f64),
}

/// A light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Light {
    /// Where the light comes from.
    pub source: Source,
    /// Colour times intensity; negative channels are taken as 0.
    pub color: [f64; 3],
}

/// The cosine of the specular term.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Specular {
    /// r·v with r = 2(n·l)n − l.
    Reflection,
    /// n·h with h = (l + v)/‖l + v‖.
    HalfVector,
}

/// A material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Base colour.
    pub base: [f64; 3],
    /// Ambient light on it.
    pub ambient: f64,
    /// Specular colour.
    pub specular: [f64; 3],
    /// Specular exponent.
    pub shininess: i32,
    /// The cosine of the specular term.
    pub model: Specular,
    /// Emitted light.
    pub emissive: [f64; 3],
}

/// A point of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePoint {
    /// Its position.
    pub position: [f64; 3],
    /// Unit normal on the side that is seen.
    pub normal: [f64; 3],
    /// Unit direction to the eye.
    pub to_eye: [f64; 3],
}

/// The light that leaves a point towards the eye.
#[must_use]
pub fn illuminated(material: &Material, lights: &[Light], point: &SurfacePoint) -> [f64; 3] {
    std::array::from_fn(|channel| {
        let base = material.base[channel];
        let mut sum = material.emissive[channel] + material.ambient * base;
        for light in lights {
            let intensity = light.color[channel].max(0.0) * attenuation(light, point);
            let highlight = specular(material.model, material.shininess, light, point);
            sum += intensity * diffuse(light, point) * base;
            sum += intensity * highlight * material.specular[channel];
        }
        sum
    })
}

/// max(n·l, 0).
#[must_use]
pub fn diffuse(light: &Light, point: &SurfacePoint) -> f64 {
    dot(point.normal, towards(light, point)).max(0.0)
}

/// The cosine of the model to the power of the exponent, where n·l > 0; else 0.
#[must_use]
pub fn specular(model: Specular, exponent: i32, light: &Light, point: &SurfacePoint) -> f64 {
    let (n, l, v) = (point.normal, towards(light, point), point.to_eye);
    let n_l = dot(n, l);
    if n_l <= 0.0 {
        return 0.0;
    }
    let cosine = match model {
        Specular::Reflection => dot(sum(scaled(n, 2.0 * n_l), scaled(l, -1.0)), v),
        Specular::HalfVector => {
            let half = sum(l, v);
            let length = length(half);
            if length > 0.0 {
                dot(n, half) / length
            } else {
                0.0
            }
        }
    };
    cosine.max(0.0).powi(exponent)
}

/// The share of the light that arrives: 1 − min(d ÷ reach, 1) at the distance d; 1 for directions.
#[must_use]
pub fn attenuation(light: &Light, point: &SurfacePoint) -> f64 {
    match light.source {
        Source::Direction(_) => 1.0,
        Source::Position(position, reach) => {
            let distance = length(sum(position, scaled(point.position, -1.0)));
            1.0 - (distance / reach).min(1.0)
        }
    }
}

/// The luminance (Rec. 709) of the diffuse light on a point, at most 1.
#[must_use]
pub fn lit_fraction(lights: &[Light], point: &SurfacePoint) -> f64 {
    let mut sum = 0.0;
    for light in lights {
        let [r, g, b] = light.color.map(|channel| channel.max(0.0));
        let luminance = 0.2126 * r + 0.7152 * g + 0.0722 * b;
        sum += luminance * diffuse(light, point) * attenuation(light, point);
    }
    sum.min(1.0)
}

/// The base colour in toon shading: between 0.3 of it and all, in steps of the light.
#[must_use]
pub fn toon(material: &Material, lit_fraction: f64, levels: u16) -> [f64; 3] {
    let share = 0.3 + 0.7 * quantised(lit_fraction, levels);
    sum(scaled(material.base, share), material.emissive)
}

/// min(⌊I·N⌋, N − 1) ÷ (N − 1) of an intensity; 0 if it is negative.
#[must_use]
pub fn quantised(intensity: f64, levels: u16) -> f64 {
    let n = f64::from(levels);
    (intensity.max(0.0) * n).floor().min(n - 1.0) / (n - 1.0)
}

/// (1 − γ)·C + γ·C_fog with γ = (distance − start) ÷ (end − start), in 0..=1.
#[must_use]
pub fn fogged(color: [f64; 3], fog: [f64; 3], range: [f64; 2], distance: f64) -> [f64; 3] {
    let [start, end] = range;
    let share = ((distance - start) / (end - start)).clamp(0.0, 1.0);
    sum(scaled(color, 1.0 - share), scaled(fog, share))
}

/// Unit direction from the point towards the light; zero at the light itself.
fn towards(light: &Light, point: &SurfacePoint) -> [f64; 3] {
    match light.source {
        Source::Direction(towards) => towards,
        Source::Position(position, _) => {
            let way = sum(position, scaled(point.position, -1.0));
            let distance = length(way);
            if distance > 0.0 {
                scaled(way, 1.0 / distance)
            } else {
                [0.0; 3]
            }
        }
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

fn sum(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn scaled(a: [f64; 3], by: f64) -> [f64; 3] {
    a.map(|x| x * by)
}
