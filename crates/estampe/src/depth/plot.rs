//! The plot of least separations.

use super::table::{ENDLESS, name};
use estampe_visibility::plot::{Curve, Plot};
use estampe_visibility::precision::{DepthFormat, DepthMethod};

/// Distances along the x axis.
const POINTS: u32 = 120;

/// The plot of a method, with the other formats for comparison.
pub(super) fn plot(method: &DepthMethod, (width, height): (u32, u32)) -> Plot {
    let mut curves = Vec::new();
    for (format, color) in DepthFormat::ALL.into_iter().zip(GREYS) {
        if format == method.format() {
            continue;
        }
        let other = DepthMethod::new(method.planes(), format, method.mapping());
        curves.extend(other.ok().map(|other| Curve {
            name: format.name().to_owned(),
            color,
            width: 1.5,
            is_dashed: false,
            points: points(&other, |z| other.least_separation(z)),
        }));
    }
    curves.push(Curve {
        name: format!("{} measured", method.format().name()),
        color: [25, 90, 200],
        width: 2.5,
        is_dashed: false,
        points: points(method, |z| method.least_separation(z)),
    });
    curves.push(Curve {
        name: format!("{} formula", method.format().name()),
        color: [220, 90, 20],
        width: 1.5,
        is_dashed: true,
        points: points(method, |z| method.formula(z)),
    });
    Plot {
        size: [width, height],
        title: name(method),
        x_name: "distance".to_owned(),
        y_name: "least separation that is told apart".to_owned(),
        curves,
    }
}

/// The colours of the formats that are not asked for.
const GREYS: [[u8; 3]; 3] = [[190, 190, 190], [150, 150, 150], [110, 110, 110]];

/// Separations at distances evenly spread along the logarithmic axis; 0 interrupts a curve.
fn points(method: &DepthMethod, separation: impl Fn(f64) -> Option<f64>) -> Vec<[f64; 2]> {
    let [near, far] = method.planes().map(f64::from);
    let ratio = (far / near).min(ENDLESS);
    let distance = |i: u32| near * libm::pow(ratio, f64::from(i) / f64::from(POINTS));
    (0..=POINTS)
        .map(distance)
        .map(|z| [z, separation(z).unwrap_or(0.0)])
        .collect()
}
