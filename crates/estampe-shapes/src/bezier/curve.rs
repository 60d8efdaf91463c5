//! Bézier curves of any degree, by de Casteljau's scheme.

use glam::DVec3;

use crate::curve::{Curve, Strand};

/// A Bézier curve over any number of control points; its degree is one less.
#[derive(Clone, Debug, PartialEq)]
pub struct BezierCurve {
    /// The control points. The curve begins at the first and ends at the last.
    pub control: Vec<DVec3>,
}

/// The most subdivisions of a curve on the way to a polyline: 2¹⁶ segments.
const MAX_DEPTH: u32 = 16;

impl BezierCurve {
    /// The point C(t); NaN without control points.
    ///
    /// ```text
    ///        p₁──q₁──p₂        each pair of neighbours is interpolated at t:
    ///       ╱  r₀─•─r₁ ╲       p -> q -> r -> the point, and the first and last
    ///      q₀╱         ╲q₂     points of each step are the control points of
    ///     ╱               ╲    the two parts into which t divides the curve
    ///    p₀                p₃
    /// ```
    #[must_use]
    pub fn point(&self, t: f64) -> DVec3 {
        let mut points = self.control.clone();
        while points.len() > 1 {
            interpolate(&mut points, t);
        }
        points.first().copied().unwrap_or(DVec3::NAN)
    }

    /// The curve of the derivatives dC/dt, of one degree less; a single zero for a point.
    #[must_use]
    pub fn derivative(&self) -> Self {
        let degree = self.control.len().saturating_sub(1) as f64;
        let pairs = self.control.windows(2);
        let mut control: Vec<DVec3> = pairs.map(|pair| (pair[1] - pair[0]) * degree).collect();
        if control.is_empty() {
            control.push(DVec3::ZERO);
        }
        Self { control }
    }

    /// The parts over [0, t] and [t, 1], as curves over [0, 1].
    #[must_use]
    pub fn split(&self, t: f64) -> [Self; 2] {
        let mut points = self.control.clone();
        let (mut first, mut last) = (Vec::new(), Vec::new());
        while let (Some(&start), Some(&end)) = (points.first(), points.last()) {
            first.push(start);
            last.push(end);
            interpolate(&mut points, t);
        }
        last.reverse();
        [first, last].map(|control| Self { control })
    }

    /// The polyline that deviates from the curve by at most `tolerance`, by subdivision in halves
    /// until the control points are as near to the chord, inside whose hull with them the curve
    /// stays; at most 2¹⁶ segments.
    #[must_use]
    pub fn flatten(&self, tolerance: f64) -> Curve {
        let (Some(&start), Some(&end)) = (self.control.first(), self.control.last()) else {
            return Curve::default();
        };
        let mut points = vec![start];
        let mut waiting = vec![(self.clone(), 0)];
        while let Some((part, depth)) = waiting.pop() {
            if depth < MAX_DEPTH && part.deviation() > tolerance {
                let [first, last] = part.split(0.5);
                waiting.extend([(last, depth + 1), (first, depth + 1)]);
            } else {
                points.extend(part.control.last());
            }
        }
        points.dedup();
        let is_closed = points.len() > 3 && start == end;
        if is_closed {
            points.pop();
        }
        if points.len() < 2 || points.iter().any(|point| !point.is_finite()) {
            return Curve::default();
        }
        Curve {
            strands: vec![Strand { points, is_closed }],
        }
    }

    /// The largest distance of a control point from the segment between the first and last one.
    fn deviation(&self) -> f64 {
        let (Some(&start), Some(&end)) = (self.control.first(), self.control.last()) else {
            return 0.0;
        };
        let chord = end - start;
        let distance = |point: &DVec3| {
            let along = (*point - start).dot(chord) / chord.length_squared();
            // A chord without length has no direction.
            let along = if along.is_nan() {
                0.0
            } else {
                along.clamp(0.0, 1.0)
            };
            point.distance(start + chord * along)
        };
        self.control.iter().map(distance).fold(0.0, f64::max)
    }
}

/// One step of de Casteljau's scheme: interpolates neighbours, which leaves one point less.
fn interpolate(points: &mut Vec<DVec3>, t: f64) {
    for i in 1..points.len() {
        points[i - 1] = points[i - 1] * (1.0 - t) + points[i] * t;
    }
    points.pop();
}

/// The parts of a cubic curve over [0, t] and [t, 1].
pub(super) fn split_cubic([p0, p1, p2, p3]: [DVec3; 4], t: f64) -> [[DVec3; 4]; 2] {
    let mix = |a: DVec3, b: DVec3| a * (1.0 - t) + b * t;
    let [q0, q1, q2] = [mix(p0, p1), mix(p1, p2), mix(p2, p3)];
    let [r0, r1] = [mix(q0, q1), mix(q1, q2)];
    let middle = mix(r0, r1);
    [[p0, q0, r0, middle], [middle, r1, q2, p3]]
}
