//! Bump maps: normals bent as if the surface were raised by a texture's heights (Blinn 1978).
//!
//! Nothing but derivatives in the window is needed, no tangents: M. Mikkelsen, "Bump Mapping
//! Unparametrized Surfaces on the GPU", 2010. With the derivatives σx, σy of the position, those of
//! the height, and the unit normal n:
//!
//! ```text
//!   r₁ = σy × n,  r₂ = n × σx,  det = σx · r₁
//!   n' ∥ n − (∂h/∂x·r₁ + ∂h/∂y·r₂) ÷ det
//! ```
//!
//! Heights are in units of the texture's size on the surface, so that the result depends neither on
//! the model's unit nor on how often the texture is repeated: the size is √(area ÷ area in uv).

use estampe::{Real, SampledTexture, Vec2, Vec3};

/// A texture of heights.
#[derive(Debug, Clone)]
pub struct BumpMap {
    /// Linear; the height is the mean of red, green and blue.
    pub texture: SampledTexture,
    /// Height of white above black, relative to the size of the texture on the surface.
    pub height: f32,
}

impl BumpMap {
    /// Height of white above black if the material's multiplier is 1, relative to the texture's
    /// size on the surface. (MTL does not define a unit.)
    pub const UNIT_HEIGHT: f32 = 0.02;

    /// The unit shading `normal` at a view-space position, bent; negated normals of back faces
    /// belong to the same heights, seen from below.
    #[inline(always)]
    pub fn perturb<R: Real>(
        &self,
        normal: Vec3<R>,
        view: Vec3<R>,
        uv: Vec2<R>,
        front_facing: R::SelectMask,
    ) -> Vec3<R> {
        let zero = normal.x.splat(0.0);
        let (uv_x, uv_y) = (
            Vec2::new(uv.x.ddx(), uv.y.ddx()),
            Vec2::new(uv.x.ddy(), uv.y.ddy()),
        );
        // Forward differences over a pixel: differences of neighbouring fragments are the same for
        // two of them, and show as blocks.
        let here = self.raised(uv, uv_x, uv_y);
        let rise_x = self.raised(uv + uv_x, uv_x, uv_y) - here;
        let rise_y = self.raised(uv + uv_y, uv_x, uv_y) - here;

        let step_x = Vec3::new(view.x.ddx(), view.y.ddx(), view.z.ddx());
        let step_y = Vec3::new(view.x.ddy(), view.y.ddy(), view.z.ddy());
        let (r1, r2) = (step_y.cross(normal), normal.cross(step_x));
        let det = step_x.dot(r1);
        let area_uv = (uv_x.x * uv_y.y - uv_x.y * uv_y.x).abs();
        // The texture's size ÷ the area of the fragment; two roots, because products of areas may
        // underflow.
        let per_area = 1.0 / (det.abs().sqrt() * area_uv.sqrt());
        let above = per_area * self.height;
        let height = R::select(front_facing, above, -above);
        let signed = R::select(det.lt(zero), -height, height);
        let bent = normal - (r1 * rise_x + r2 * rise_y) * signed;
        let length = bent.length();
        // Without an area, on the surface or in the texture, there is no slope.
        let is_bent = length.gt(zero) & length.lt(f32::INFINITY);
        Vec3::select(is_bent, bent / length, normal)
    }

    /// The height at a texture coordinate with these derivatives, 0 to 1.
    #[inline(always)]
    fn raised<R: Real>(&self, uv: Vec2<R>, uv_x: Vec2<R>, uv_y: Vec2<R>) -> R {
        let (uv_x, uv_y) = (uv_x.extend(0.0), uv_y.extend(0.0));
        let texel = self.texture.sample_grad(uv, uv_x, uv_y);
        (texel.x + texel.y + texel.z) * (1.0 / 3.0)
    }
}
