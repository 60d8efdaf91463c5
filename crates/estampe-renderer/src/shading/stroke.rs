//! The shader of strokes: straight lines of a width in pixels, with round ends and smooth borders.
//!
//! ```text
//!        half ┌┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┐        coverage = half + ½ − distance from the segment,
//!   (       a ●────────────────────● b   )  clamped to 0..=1
//!             └┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┘        x along, z across, both in pixels
//! ```
//!
//! The place in the stroke is interpolated in the window, for its vertices have w = 1.

use estampe::{FragmentIn, FragmentOut, Vec3, Vec4, VertexIn, VertexOut};

/// Strokes of one colour.
#[derive(Debug, Clone)]
pub struct StrokeShader {
    /// Linear colour, not multiplied by alpha.
    pub color: [f32; 3],
}

estampe::shader! {
    impl Shader for StrokeShader {
        // The point in unit space, which is for inspection alone; the position in normalized device
        // coordinates; the way past a, the way left to b and the way across in pixels, and half of
        // the width; alpha.
        type Attributes<R: Real> = (Vec3<R>, Vec3<R>, Vec4<R>, R);
        type Varyings<R: Real> = (Vec4<R>, R);

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (_unit, position, place, alpha): (Vec3<R>, Vec3<R>, Vec4<R>, R),
        ) -> VertexOut<R, (Vec4<R>, R)> {
            VertexOut::new(position.point(), (place, alpha))
        }

        fn fragment<R: Real>(
            &self,
            input: FragmentIn<'_, R>,
            (place, alpha): (Vec4<R>, R),
        ) -> FragmentOut<R> {
            let zero = input.zero;
            let past = (zero - place.x).max(zero - place.y).max(zero);
            let distance = (past * past + place.z * place.z).sqrt();
            let coverage = (place.w + 0.5 - distance).saturate() * alpha;
            FragmentOut::color((Vec3::uniform(zero, self.color) * coverage).extend(coverage))
        }
    }
}
