//! Cube faces in the packet code.
//!
//! *Spec* Vulkan §Cube Map Face Selection; ties as `docs/NUMERICS.md` says.

use estampe_types::{Int, Real};

/// The faces of a cube that directions meet.
pub(super) struct Face<R: Real> {
    pub(super) index: R::Int,
    is_x: R::SelectMask,
    is_z: R::SelectMask,
    is_negative: R::SelectMask,
}

impl<R: Real> Face<R> {
    #[inline(always)]
    pub(super) fn of([x, y, z]: [R; 3]) -> Self {
        let (ax, ay, az) = (x.abs(), y.abs(), z.abs());
        let is_z = az.ge(ay) & az.ge(ax);
        let is_x = !is_z & !ay.ge(ax);
        let major = R::select(is_z, z, R::select(is_x, x, y));
        let is_negative = major.lt(x.splat(0.0));
        let int = |value: i32| x.splat_int(value);
        let axis = R::Int::select(is_z, int(4), R::Int::select(is_x, int(0), int(2)));
        let sign = R::Int::select(is_negative, int(1), int(0));
        Self {
            index: axis + sign,
            is_x,
            is_z,
            is_negative,
        }
    }

    /// (sc, tc, the major component times its sign) of vectors.
    #[inline(always)]
    pub(super) fn turned(&self, [x, y, z]: [R; 3]) -> [R; 3] {
        let negated = |value: R| R::select(self.is_negative, -value, value);
        // +x: −z, −y; −x: z, −y; +y: x, z; −y: x, −z; +z: x, −y; −z: −x, −y.
        let s_of_x = R::select(self.is_negative, z, -z);
        let sc = R::select(self.is_x, s_of_x, R::select(self.is_z, negated(x), x));
        let tc = R::select(self.is_x | self.is_z, -y, negated(z));
        let major = R::select(self.is_z, z, R::select(self.is_x, x, y));
        [sc, tc, negated(major)]
    }

    /// The vector whose [`turned`](Self::turned) form has these components.
    #[inline(always)]
    pub(super) fn point(&self, [sc, tc, rc]: [R; 3]) -> [R; 3] {
        let negated = |value: R| R::select(self.is_negative, -value, value);
        let major = negated(rc);
        let x_of_y_or_z = R::select(self.is_z, negated(sc), sc);
        let x = R::select(self.is_x, major, x_of_y_or_z);
        let y = R::select(self.is_x | self.is_z, -tc, major);
        let z_of_x_or_y = R::select(self.is_x, -negated(sc), negated(tc));
        let z = R::select(self.is_z, major, z_of_x_or_y);
        [x, y, z]
    }
}
