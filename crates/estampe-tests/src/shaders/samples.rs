//! Shaders that read or write per-sample inputs and outputs: sample index, coverage, sample mask,
//! centroids.

use super::{bytes_of, bytes_of_int};
use crate::Random;
use estampe_types::shader::VertexOut;
use estampe_types::{
    Centroid, Flat, FragmentIn, FragmentOut, NoPerspective, PerSample, Real, Vec2, Vec4, VertexIn,
};

/// The shown value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shown {
    /// The first varying.
    Varying,
    /// Its derivative in x.
    Ddx,
    /// Its derivative in y.
    Ddy,
    /// The second varying: linear in the window, evaluated at the pixel's centre unless shading is
    /// per sample.
    Second,
    /// The coverage, and in shaders that run by sample the index of the sample.
    Samples,
    /// Window x.
    X,
    /// Depth.
    Z,
    /// 1/w.
    InverseW,
}

impl Shown {
    /// A random one.
    pub fn random(random: &mut Random) -> Self {
        random.pick(&[
            Self::Varying,
            Self::Ddx,
            Self::Ddy,
            Self::Second,
            Self::Samples,
            Self::X,
            Self::Z,
            Self::InverseW,
        ])
    }
}

#[inline(always)]
fn show<R: Real>(
    what: Shown,
    is_by_sample: bool,
    input: FragmentIn<'_, R>,
    first: Vec2<R>,
    second: Vec2<R>,
) -> FragmentOut<R> {
    let p = input.position;
    FragmentOut::color(match what {
        Shown::Varying => bytes_of(first.x),
        Shown::Ddx => bytes_of(first.x.ddx()),
        Shown::Ddy => bytes_of(first.y.ddy()),
        Shown::Second => bytes_of(second.y),
        Shown::Samples if is_by_sample => {
            bytes_of_int::<R>(input.coverage | (input.sample_index << 16))
        }
        Shown::Samples => bytes_of_int::<R>(input.coverage),
        Shown::X => bytes_of(p.x),
        Shown::Z => bytes_of(p.z),
        Shown::InverseW => bytes_of(p.w),
    })
}

macro_rules! sampled {
    ($($doc:literal $name:ident $wrapper:ident $per_sample:literal;)*) => {$(
        #[doc = $doc]
        #[derive(Debug, Clone, Copy)]
        pub struct $name(pub Shown);

        estampe_types::shader! {
            impl Shader for $name {
                type Attributes<R: Real> = (Vec4<R>, Vec4<R>);
                type Varyings<R: Real> =
                    ($wrapper<Vec2<R>>, NoPerspective<Vec2<R>>, Flat<[R; 1]>);
                // Not found where another value is shown than the samples.
                const PER_SAMPLE: bool = $per_sample;

                fn vertex<R: Real>(
                    &self,
                    _input: VertexIn<'_, R>,
                    (position, v): (Vec4<R>, Vec4<R>),
                ) -> VertexOut<R, Self::Varyings<R>> {
                    let varyings = (
                        $wrapper(Vec2::new(v.x, v.y)),
                        NoPerspective(Vec2::new(v.z, v.x)),
                        Flat([v.w]),
                    );
                    VertexOut::new(position, varyings)
                }

                fn fragment<R: Real>(
                    &self,
                    input: FragmentIn<'_, R>,
                    ($wrapper(first), NoPerspective(second), Flat([flat])): Self::Varyings<R>,
                ) -> FragmentOut<R> {
                    show(self.0, $per_sample, input, first, Vec2::new(flat, second.y))
                }
            }
        }
    )*};
}
sampled! {
    "A varying where the primitive covers the pixel." AtCentroid Centroid false;
    "A varying at each sample, which makes shading go by sample." AtSample PerSample true;
    "Shaded by sample because it declares so; the varying is declared centroid." BySample Centroid true;
}

/// Writes a sample mask computed from the first value, and shows the coverage; discards some
/// fragments.
#[derive(Debug, Clone, Copy)]
pub struct Masking {
    /// Bits that are added to the mask.
    pub always: u16,
}

estampe_types::shader! {
    impl Shader for Masking {
        type Attributes<R: Real> = (Vec4<R>, Vec4<R>);
        type Varyings<R: Real> = Vec4<R>;

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, color): (Vec4<R>, Vec4<R>),
        ) -> VertexOut<R, Vec4<R>> {
            VertexOut::new(position, color)
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, color: Vec4<R>) -> FragmentOut<R> {
            let mask = (color.x.saturate() * 65535.0).to_int() | input.coverage.splat(self.always.into());
            let kept = color.y.gt(color.x.splat(0.15));
            FragmentOut::color(bytes_of_int::<R>(input.coverage))
                .with_sample_mask(mask)
                .discard_unless(kept)
        }
    }
}
