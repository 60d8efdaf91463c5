//! The light that a material reflects, by random directions: a third of them by the cosine, a third
//! by the facets of GGX, a third by those of the clear coat, weighted by the balance heuristic (E.
//! Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, chapter 9).

use super::{Direction, Layered, density_ggx, dot};
use std::f64::consts::PI;

/// An estimate, by channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The mean of the samples.
    pub mean: [f64; 3],
    /// The standard deviation of the mean.
    pub deviation: [f64; 3],
}

/// The light that a material reflects towards a view, given the radiance of each direction.
///
/// `random` gives numbers that are evenly spread in 0..1.
pub fn reflected(
    material: &Layered,
    view: Direction,
    count: u32,
    random: &mut dyn FnMut() -> f64,
    radiance: &dyn Fn(Direction) -> [f64; 3],
) -> Estimate {
    let seen = material.seen(view);
    let (alphas, axes) = material.axes();
    let coat_alpha = material.coat.map_or(alphas[0], |coat| coat.alpha);
    let flat = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let facets = [(alphas, axes), ([coat_alpha; 2], flat)];
    let (mut sums, mut squares) = ([0.0; 3], [0.0; 3]);
    for number in 0..count {
        let (u, turn) = (random(), random() * 2.0 * PI);
        let light = match number % 3 {
            0 => {
                let sine = u.sqrt();
                [sine * turn.cos(), sine * turn.sin(), (1.0 - u).sqrt()]
            }
            kind => mirrored(view, facet(facets[kind as usize - 1], u, turn)),
        };
        if light[2] <= 0.0 {
            continue;
        }
        let density = (light[2] / PI
            + facets
                .iter()
                .map(|&facets| facet_density(facets, view, light))
                .sum::<f64>())
            / 3.0;
        let (value, arriving) = (material.value(&seen, view, light), radiance(light));
        for c in 0..3 {
            let sample = value[c] * arriving[c] / density;
            sums[c] += sample;
            squares[c] += sample * sample;
        }
    }
    let n = f64::from(count);
    let mean = sums.map(|sum| sum / n);
    Estimate {
        mean,
        deviation: std::array::from_fn(|c| {
            ((squares[c] / n - mean[c] * mean[c]).max(0.0) / n).sqrt()
        }),
    }
}

/// A facet of GGX: its slopes are those of α = 1, stretched.
fn facet(([at, ab], [t, b]): ([f64; 2], [Direction; 2]), u: f64, turn: f64) -> Direction {
    let slope = (u / (1.0 - u)).sqrt();
    let (along, across) = (at * slope * turn.cos(), ab * slope * turn.sin());
    let facet = [0, 1, 2].map(|axis| t[axis] * along + b[axis] * across);
    super::normalised([facet[0], facet[1], 1.0])
}

/// The density of the directions in which such facets mirror a view: D·(n·h) ÷ 4(v·h).
fn facet_density(
    ([at, ab], [t, b]): ([f64; 2], [Direction; 2]),
    view: Direction,
    light: Direction,
) -> f64 {
    let half = super::normalised([0, 1, 2].map(|axis| view[axis] + light[axis]));
    let density = if at == ab {
        density_ggx(half[2], at)
    } else {
        let stretched = (dot(t, half) / at).powi(2) + (dot(b, half) / ab).powi(2);
        1.0 / (PI * at * ab * (stretched + half[2] * half[2]).powi(2))
    };
    density * half[2] / (4.0 * dot(view, half))
}

fn mirrored(view: Direction, half: Direction) -> Direction {
    let v_dot_h = dot(view, half);
    [0, 1, 2].map(|axis| 2.0 * v_dot_h * half[axis] - view[axis])
}
