//! Points of surfaces with their derivatives, and the normals that follow.

use glam::DVec3;

/// A point of a surface S(s, t) with its first and second derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceJet {
    /// The point.
    pub position: DVec3,
    /// ∂S/∂s.
    pub s: DVec3,
    /// ∂S/∂t.
    pub t: DVec3,
    /// ∂²S/∂s².
    pub ss: DVec3,
    /// ∂²S/∂s∂t.
    pub st: DVec3,
    /// ∂²S/∂t².
    pub tt: DVec3,
}

impl SurfaceJet {
    /// The unit normal ∂S/∂s × ∂S/∂t; `None` where the derivatives do not tell it.
    ///
    /// At a pole, where the product vanishes, the normal is the limit on the way from the point
    /// into the direction `towards`. There n = ∂S/∂s × ∂S/∂t begins as its first derivative: for
    /// the direction (a, b)
    ///
    /// ```text
    ///   n′ = (a S_ss + b S_st) × S_t + S_s × (a S_st + b S_tt)
    /// ```
    ///
    /// ```text
    ///           ─── pole ───           t      rows of constant t shrink to a point;
    ///          ╱  ↓  ↓  ↓   ╲          ↑      from the pole, towards = (0, −1)
    ///         ╱  towards     ╲         └─▶ s  leads into the surface
    /// ```
    ///
    /// `towards` is measured in the parameters' units, of which a step changes the surface about as
    /// much in s as in t; lengths below 1e-12 of the others count as zero.
    #[must_use]
    pub fn normal(&self, towards: [f64; 2]) -> Option<DVec3> {
        // The largest of the derivatives; rounding errors of others are proportional to it.
        let vectors = [self.s, self.t, self.ss, self.st, self.tt];
        let scale = vectors.map(|v| v.abs().max_element()).into_iter();
        let scale = scale.fold(0.0, f64::max);
        if !(scale > 0.0 && vectors.iter().all(|v| v.is_finite())) {
            return unit(self.s.cross(self.t));
        }
        let [s, t, ss, st, tt] = vectors.map(|v| v / scale);
        let first = s.cross(t);
        if first.length() > 1e-12 {
            return unit(first);
        }
        let [a, b] = towards;
        let second = (ss * a + st * b).cross(t) + s.cross(st * a + tt * b);
        if second.length() > 1e-10 {
            return unit(second);
        }
        None
    }

    /// The same point, with derivatives by parameters of which a step of 1 is one of `s` and `t`.
    pub(crate) fn per_step(self, s: f64, t: f64) -> Self {
        Self {
            position: self.position,
            s: self.s * s,
            t: self.t * t,
            ss: self.ss * (s * s),
            st: self.st * (s * t),
            tt: self.tt * (t * t),
        }
    }
}

/// The direction of a vector, of any length that is not zero.
fn unit(vector: DVec3) -> Option<DVec3> {
    let largest = vector.abs().max_element();
    if !(largest > 0.0 && vector.is_finite()) {
        return None;
    }
    Some((vector / largest).normalize())
}

/// The point and derivatives of a function by central differences, for functions whose derivatives
/// are not known.
///
/// `steps` are the differences in s and t: about 1e-4 of the parameters' ranges gives normals that
/// are right to about 1e-7. The function is called nine times, on both sides of (s, t).
#[must_use]
pub fn numeric_jet(point: impl Fn(f64, f64) -> DVec3, at: [f64; 2], steps: [f64; 2]) -> SurfaceJet {
    let ([s, t], [ds, dt]) = (at, steps);
    let near = |i: f64, j: f64| point(s + i * ds, t + j * dt);
    let (here, left, right) = (near(0.0, 0.0), near(-1.0, 0.0), near(1.0, 0.0));
    let (below, above) = (near(0.0, -1.0), near(0.0, 1.0));
    let mixed = (near(1.0, 1.0) - near(-1.0, 1.0)) - (near(1.0, -1.0) - near(-1.0, -1.0));
    SurfaceJet {
        position: here,
        s: (right - left) / (2.0 * ds),
        t: (above - below) / (2.0 * dt),
        ss: ((right - here) - (here - left)) / (ds * ds),
        st: mixed / (4.0 * ds * dt),
        tt: ((above - here) - (here - below)) / (dt * dt),
    }
}
