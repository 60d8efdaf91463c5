//! The colour of a gradient at a fragment, and the shader that draws it behind everything.

use crate::alpha::Encoding;
use crate::gradient::{Gradient, GradientShape, LINEAR, ROOTS, oklab};
use estampe::{FragmentIn, FragmentOut, Real, Vec3, Vec4, VertexIn, VertexOut};

/// A gradient over the window.
///
/// With n + 1 colours c₀ … cₙ, the colour at t in 0..=1 is c₀ + Σ (cᵢ₊₁ − cᵢ)·sat(n·t − i).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Backdrop {
    place: Place,
    /// As [`oklab`] makes it.
    first: [f32; 4],
    /// From each colour to the next.
    steps: [[f32; 4]; Gradient::MOST_COLORS - 1],
    /// Number of steps.
    count: usize,
    /// How colours are mixed.
    encoding: Encoding,
    is_opaque: bool,
}

/// How the place in the gradient is found, times the number of steps.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Place {
    /// Per pixel downwards.
    Rows(f32),
    /// Per pixel from this point.
    Circles([f32; 2], f32),
}

impl Backdrop {
    /// The gradient over a window of this size.
    pub(crate) fn new(gradient: &Gradient, size_px: [u32; 2], encoding: Encoding) -> Self {
        let colors = gradient.colors();
        let count = colors.len() - 1;
        let mut steps = [[0.0; 4]; Gradient::MOST_COLORS - 1];
        for (step, pair) in steps.iter_mut().zip(colors.windows(2)) {
            let [from, to] = [pair[0], pair[1]].map(|color| oklab(color, encoding));
            *step = [0, 1, 2, 3].map(|i| to[i] - from[i]);
        }
        let [width, height] = size_px.map(|side| side as f32);
        let (x, y) = (width / 2.0, height / 2.0);
        Self {
            place: match gradient.shape() {
                GradientShape::Linear => Place::Rows(count as f32 / height),
                GradientShape::Radial => {
                    Place::Circles([x, y], count as f32 / (x * x + y * y).sqrt())
                }
            },
            first: oklab(colors[0], encoding),
            steps,
            count,
            encoding,
            is_opaque: gradient.is_opaque(),
        }
    }

    /// True if every colour is opaque.
    #[inline(always)]
    pub fn is_opaque(&self) -> bool {
        self.is_opaque
    }

    /// The colour: linear, or codes of pictures of numbers, multiplied by alpha; and alpha.
    #[inline(always)]
    pub fn color<R: Real>(&self, input: &FragmentIn<'_, R>) -> Vec4<R> {
        let at = input.position;
        let place = match self.place {
            Place::Rows(per_pixel) => at.y * per_pixel,
            Place::Circles([x, y], per_pixel) => {
                let (dx, dy) = (at.x - x, at.y - y);
                (dx * dx + dy * dy).sqrt() * per_pixel
            }
        };
        let mut color = Vec4::uniform(input.zero, self.first);
        let mut before = 0.0_f32;
        for step in &self.steps[..self.count] {
            color += Vec4::uniform(input.zero, *step) * (place - before).saturate();
            before += 1.0;
        }
        match self.encoding {
            Encoding::Linear => color,
            Encoding::Srgb => {
                let alpha = color.w;
                let lab = color.xyz() / alpha.max(input.real(1e-6));
                let roots = product(&ROOTS, lab);
                let cubes = roots * roots * roots;
                let rgb = product(&LINEAR, cubes);
                let rgb = Vec3::new(rgb.x.saturate(), rgb.y.saturate(), rgb.z.saturate());
                (rgb * alpha).extend(alpha)
            }
        }
    }
}

/// The product of a matrix, row by row, and a vector.
#[inline(always)]
fn product<R: Real>([x, y, z]: &[[f32; 3]; 3], v: Vec3<R>) -> Vec3<R> {
    Vec3::new(
        v.dot(Vec3::uniform(v.x, *x)),
        v.dot(Vec3::uniform(v.x, *y)),
        v.dot(Vec3::uniform(v.x, *z)),
    )
}

/// The shader of the backdrop, on a triangle in clip space.
#[derive(Debug, Clone)]
pub struct BackdropSurface(pub(crate) Backdrop);

estampe::shader! {
    impl Shader for BackdropSurface {
        type Attributes<R: Real> = Vec3<R>;
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(
            &self,
            input: VertexIn<'_, R>,
            position: Vec3<R>,
        ) -> VertexOut<R, ()> {
            VertexOut::new(position.extend(input.real(1.0)), ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
            FragmentOut::color(self.0.color(&input))
        }
    }
}
