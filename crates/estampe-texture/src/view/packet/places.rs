//! Texel coordinates in the packet code: faces and layers, then the one or two texels along each
//! axis of a level.

use super::Packet;
use super::face::Face;
use super::wrapped::wrapped;
use crate::view::axis::FAR;
use crate::view::coordinates::load;
use crate::view::plane::Plane;
use crate::wrap::{place, tile, wrap};
use estampe_simd::floats_of;
use estampe_types::{AddressMode, FilterMode, Int, Real, ViewDimension};

/// Coordinates of all lanes, in the form that is independent of the mip level.
pub(super) struct Spots<R: Real> {
    /// Wrapped into the first tile; for cubes, within the face.
    pub(super) at: [R; 3],
    /// The coordinates before that: of cubes, the direction.
    pub(super) direction: [R; 3],
    /// The texture's layer.
    pub(super) slice: R::Int,
}

/// The texels along one axis and the position between their centres.
pub(super) struct Places<R: Real> {
    pub(super) texels: [R::Int; 2],
    pub(super) fraction: R,
}

impl<R: Real> Places<R> {
    /// One texel, along an axis that is not filtered.
    #[inline(always)]
    pub(super) fn fixed(texel: R::Int, like: R) -> Self {
        Self {
            texels: [texel; 2],
            fraction: like,
        }
    }
}

impl Packet<'_> {
    /// Finds the layer and the face of coordinates, and wraps them.
    #[inline(always)]
    pub(super) fn spots<R: Real>(&self, at: [R; 3]) -> Spots<R> {
        let view = &self.of.view;
        if view.dimension == ViewDimension::D2 {
            return Spots {
                at: [self.tiled(at[0], 0), self.tiled(at[1], 1), at[2]],
                direction: at,
                slice: at[0].to_bits().splat(view.base_layer.cast_signed()),
            };
        }
        let [layers] = floats_of(std::slice::from_ref(self.lanes.layer)) else {
            unreachable!("as many packets as were given")
        };
        let layer = load(at[0], layers, 0).to_bits();
        let layer = layer.max(layer.splat(0)).min(layer.splat(view.layers - 1));
        let base = layer.splat(view.base_layer.cast_signed());
        if view.is_cube() {
            let face = Face::of(at);
            let [sc, tc, rc] = face.turned(at);
            let length = rc.abs();
            let s = sc / length * 0.5 + 0.5;
            let t = tc / length * 0.5 + 0.5;
            return Spots {
                at: [s, t, s],
                direction: at,
                slice: base + layer * layer.splat(6) + face.index,
            };
        }
        Spots {
            at: [
                self.tiled(at[0], 0),
                self.tiled(at[1], 1),
                self.tiled(at[2], 2),
            ],
            direction: at,
            slice: base + layer,
        }
    }

    /// The address mode of an axis; cubes do not use it.
    #[inline(always)]
    pub(super) fn mode(&self, axis: usize) -> AddressMode {
        let sampler = &self.of.sampler;
        match axis {
            0 => sampler.address_mode_u,
            1 => sampler.address_mode_v,
            _ => sampler.address_mode_w,
        }
    }

    /// Returns true if wrapping the coordinate is enough to find all texels along an axis.
    #[inline(always)]
    fn is_plain(&self, axis: usize) -> bool {
        self.lanes.offset[axis] == 0 && self.mode(axis).is_plain()
    }

    /// A coordinate wrapped into the first tile, if that is enough.
    #[inline(always)]
    fn tiled<R: Real>(&self, u: R, axis: usize) -> R {
        if self.is_plain(axis) {
            wrap(u, self.mode(axis))
        } else {
            u
        }
    }

    /// The texels along one axis of a level.
    #[inline(always)]
    pub(super) fn places<R: Real>(
        &self,
        plane: &Plane,
        spots: &Spots<R>,
        axis: usize,
        filter: FilterMode,
        outside: &mut u64,
    ) -> Places<R> {
        let (count, length) = (plane.sides[axis], plane.size[axis]);
        let is_linear = filter == FilterMode::Linear;
        let at = spots.at[axis];
        if self.of.view.is_cube() {
            let (low, high) = if is_linear {
                (-0.5, length - 0.5)
            } else {
                (0.0, length - 1.0)
            };
            let at = at * length;
            let at = if is_linear {
                (at - 0.5).clamp(low, high)
            } else {
                at.floor().clamp(low, high)
            };
            let border = AddressMode::ClampToBorder;
            return in_integers(at, 0, (count, border), is_linear, outside);
        }
        if self.is_plain(axis) {
            self.plain_places(plane, at, axis, filter)
        } else {
            self.moved_places(plane, at, axis, is_linear, outside)
        }
    }

    /// The texels along an axis of a coordinate that is [wrapped](wrap) already, where that is
    /// enough.
    #[inline(always)]
    pub(super) fn plain_places<R: Real>(
        &self,
        plane: &Plane,
        at: R,
        axis: usize,
        filter: FilterMode,
    ) -> Places<R> {
        let (count, length) = (plane.sides[axis], plane.size[axis]);
        let mode = self.mode(axis);
        let place = place(at, length, mode, filter);
        let next = place.texel + place.texel.splat(1);
        let texels = if mode == AddressMode::Repeat {
            [tile(place.texel, count), tile(next, count)]
        } else {
            [place.texel, next.min(next.splat(count - 1))]
        };
        Places {
            texels,
            fraction: place.fraction,
        }
    }

    /// The texels along an axis of a coordinate, moved by the offset and each wrapped by itself;
    /// lanes with a border texel are added to `outside`.
    #[inline(always)]
    pub(super) fn moved_places<R: Real>(
        &self,
        plane: &Plane,
        u: R,
        axis: usize,
        is_linear: bool,
        outside: &mut u64,
    ) -> Places<R> {
        let at = u * plane.size[axis];
        let at = if is_linear { at - 0.5 } else { at };
        let offset = self.lanes.offset[axis].clamp(-1024, 1024);
        let side = (plane.sides[axis], self.mode(axis));
        in_integers(at.clamp(-FAR, FAR), offset, side, is_linear, outside)
    }
}

/// The texels of a texel coordinate: its integer part and the next one are moved by the offset,
/// then wrapped. With [`AddressMode::ClampToBorder`] they are clamped to the level instead, and
/// lanes with a texel outside are added to `outside`.
#[inline(always)]
fn in_integers<R: Real>(
    at: R,
    offset: i32,
    (count, mode): (i32, AddressMode),
    is_linear: bool,
    outside: &mut u64,
) -> Places<R> {
    let whole = at.floor();
    let first = whole.to_int_within_range();
    let first = first + first.splat(offset);
    let texels = if mode == AddressMode::ClampToBorder {
        let room = if is_linear { count - 1 } else { count };
        *outside |= R::mask_bits(first.is_outside(room));
        let (zero, last) = (first.splat(0), first.splat(count - 1));
        let next = first + first.splat(1);
        [first.max(zero).min(last), next.max(zero).min(last)]
    } else {
        wrapped(at, first, count, mode)
    };
    Places {
        texels,
        fraction: at - whole,
    }
}
