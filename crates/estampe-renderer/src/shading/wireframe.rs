//! Wireframe with hidden lines removed, alone or over shaded surfaces.
//!
//! Each triangle has separate vertices, with a 1 at one of three corners each: interpolated, the
//! three numbers are the fragment's distances from the edges, as fractions of the triangle's
//! heights. Divided by their gradients they are pixels, so edges have the same width everywhere,
//! smooth borders, and lie exactly on the faces. (Rejected: pipeline lines over filled faces, which
//! have depth-buffer conflicts and are not anti-aliased.)

use super::VertexTransforms;
use super::backdrop::Backdrop;
use estampe::{FragmentIn, FragmentOut, Real, Vec3, Vec4, VertexIn, VertexOut};

/// The shader of hidden-line drawings.
#[derive(Debug, Clone)]
pub struct Wireframe {
    pub transforms: VertexTransforms,
    /// Linear colour and alpha of the edges.
    pub line: [f32; 4],
    /// Linear premultiplied colour and alpha of the faces: those of the background, or nothing over
    /// shaded surfaces.
    pub face: [f32; 4],
    /// The gradient over the background, which faces then have.
    pub backdrop: Option<Backdrop>,
    /// Half of an edge's width, in pixels; each of the two triangles at an edge draws one half.
    pub half_width_px: f32,
}

estampe::shader! {
    impl Shader for Wireframe {
        type Attributes<R: Real> = (Vec3<R>, Vec3<R>); // position, corner
        type Varyings<R: Real> = Vec3<R>;

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, corner): (Vec3<R>, Vec3<R>),
        ) -> VertexOut<R, Vec3<R>> {
            VertexOut::new(self.transforms.clip(position), corner)
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, corner: Vec3<R>) -> FragmentOut<R> {
            let one = corner.x.splat(1.0);
            let rates = Vec3::new(gradient(corner.x), gradient(corner.y), gradient(corner.z));
            // Distance of the nearest edge, in pixels.
            let distances = corner / rates;
            let distance = distances.x.min(distances.y).min(distances.z);
            let coverage = (one * (self.half_width_px + 0.5) - distance).saturate();
            // Edges of triangles of a few pixels would cover everything, so they fade: a dense mesh
            // becomes grey and not solid. |∇a × ∇b| = 1 ÷ 2·area.
            let (a, b) = (corner.x, corner.y);
            let cross = (a.ddx() * b.ddy() - a.ddy() * b.ddx()).abs().max(one * 1e-9);
            let side_px = (one / cross).sqrt();
            let strength = (side_px * (1.0 / 11.0) + 0.18).saturate();
            let alpha = coverage * strength * self.line[3];
            let line = Vec4::uniform(one, [self.line[0], self.line[1], self.line[2], 1.0]);
            let mut face = Vec4::uniform(one, self.face);
            if let Some(backdrop) = &self.backdrop {
                let over = one.out_of_line(
                    #[inline(always)]
                    || backdrop.color(&input),
                );
                face = over + face * (one - over.w);
            }
            FragmentOut::color(face.mix(line, alpha))
        }
    }
}

/// The length of a value's gradient: its greatest change from pixel to pixel.
#[inline(always)]
fn gradient<R: Real>(value: R) -> R {
    let (dx, dy) = (value.ddx(), value.ddy());
    (dx * dx + dy * dy).sqrt().max(value.splat(1e-6))
}
