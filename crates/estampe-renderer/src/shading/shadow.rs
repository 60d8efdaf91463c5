//! Shadows: the share of a light that reaches a point, from the depths that the light sees (L.
//! Williams, "Casting curved shadows on curved surfaces", 1978), with soft edges by comparing with
//! several texels (W. Reeves, D. Salesin, R. Cook, "Rendering antialiased shadows with depth maps",
//! 1987).
//!
//! A point is moved along its normal before it is compared, the more the flatter the light falls,
//! so that a surface does not shade itself: each texel holds the depth of its middle, and over the
//! width of the filter the surface's own depth changes.

use estampe::{FragmentIn, Mat4, Real, Vec2, Vec3, sample_compare_sum};

/// The most lights of a frame that cast shadows.
pub const MAX_SHADOW_MAPS: usize = 4;

/// The group at which the maps are bound, by number.
pub const SHADOW_GROUP: u32 = 0;

/// Half of the filter's width, in texels, with the half texel that a comparison reaches.
pub const FILTER_RADIUS: f32 = 2.5;

/// A map of what a light sees, as shaders look it up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShadowMapView {
    /// The number of the map.
    pub binding: u32,
    /// Its width and height in texels.
    pub side: u32,
    /// From unit space to the map's clip space.
    pub clip_from_unit: Mat4,
    /// From view space to the map's clip space.
    pub clip_from_view: Mat4,
    /// The map's axis: the unit direction in view space from the model's middle towards the light.
    pub axis: [f32; 3],
    /// 1 ÷ the side of the map.
    pub texel: f32,
    /// The length by which a point is moved along its normal if light grazes it, for w = 1.
    pub normal_offset: f32,
}

/// The shares of each map's light that reach a point, by the maps' number.
#[derive(Debug, Clone, Copy)]
pub struct Visibilities<R>(pub(crate) [R; MAX_SHADOW_MAPS]);

impl<R: Real> Visibilities<R> {
    /// All light.
    #[inline(always)]
    pub fn all(one: R) -> Self {
        Self([one; MAX_SHADOW_MAPS])
    }

    /// Of the light at a point in view space, with the unit normal of the side that is seen.
    #[inline(always)]
    pub fn at(
        maps: &[ShadowMapView],
        input: &FragmentIn<'_, R>,
        position: Vec3<R>,
        normal: Vec3<R>,
    ) -> Self {
        let mut all = Self::all(input.real(1.0));
        for (map, visibility) in maps.iter().zip(&mut all.0) {
            *visibility = position.x.out_of_line(
                #[inline(always)]
                || map.visibility(input, position, normal),
            );
        }
        all
    }

    /// Of the light with this map; all if it has none.
    #[inline(always)]
    pub fn of(&self, map: Option<usize>) -> Option<R> {
        map.and_then(|number| self.0.get(number).copied())
    }
}

impl ShadowMapView {
    /// The share of the light that reaches a point.
    #[inline(always)]
    fn visibility<R: Real>(
        &self,
        input: &FragmentIn<'_, R>,
        position: Vec3<R>,
        normal: Vec3<R>,
    ) -> R {
        let one = input.real(1.0);
        let Some(map) = input.bindings.shadow_map(SHADOW_GROUP, self.binding) else {
            return one;
        };
        // A texel away, a plane's depth changes by the tangent of its angle to the map; to move a
        // point by the sine along the normal gives it as much, in perspective too.
        let cosine = normal.dot_uniform(self.axis).saturate();
        let sine = (one - cosine * cosine).max(0.0).sqrt();
        let w = self.clip_from_view.transform_point(position).w;
        let moved = position + normal * (sine * w * self.normal_offset);
        let clip = self.clip_from_view.transform_point(moved);
        let (x, y, depth) = (clip.x / clip.w, clip.y / clip.w, clip.z / clip.w);
        let uv = Vec2::new(x * 0.5 + 0.5, y * -0.5 + 0.5);
        let offsets = self.offsets();
        let sum = sample_compare_sum(map, uv, &offsets, depth);
        // Beyond the map nothing is in the way.
        let beyond = x.abs().max(y.abs()).max(depth).ge(1.0);
        // Divided, so that all light is exactly 1.
        R::select(beyond, one, sum / 25.0)
    }

    /// Five by five comparisons, one texel apart.
    #[inline(always)]
    fn offsets(&self) -> [[f32; 2]; 25] {
        const STEPS: [f32; 5] = [-2.0, -1.0, 0.0, 1.0, 2.0];
        let mut offsets = [[0.0; 2]; 25];
        for (k, offset) in offsets.iter_mut().enumerate() {
            *offset = [STEPS[k % 5] * self.texel, STEPS[k / 5] * self.texel];
        }
        offsets
    }
}
