//! The items that `shader!` accepts.

#![deny(warnings)]

use crate::shader::{FragmentIn, FragmentOut, VertexIn, VertexOut};
use crate::{Interpolation, Program, ShaderProgram, Vec2, Vec3, Vec4};

crate::attributes! {
    struct Corner<R> { position: Vec3<R>, weight: R, uv: Vec2<R> }
}

crate::varyings! {
    struct Surface<R> { #[flat] id: R, normal: Vec3<R>, uv: Vec2<R>, #[sample] weight: R }
}

/// A trait with generic functions, for bounds.
trait Weights {
    fn weight<R: crate::Real>(&self, x: R) -> R;
}

impl Weights for f32 {
    #[inline(always)]
    fn weight<R: crate::Real>(&self, x: R) -> R {
        x * *self
    }
}

struct General<T, U, const N: usize>(T, U);

crate::shader! {
    /// An implementation with everything.
    #[allow(clippy::use_self, reason = "an attribute of the implementation")]
    impl<T: Weights + Send + Sync + 'static, U, const N: usize> Shader for General<T, U, N>
    where
        U: Into<f32> + Copy + Send + Sync + 'static,
        Option<U>: Clone,
    {
        /// The corners.
        type Attributes<R: Real> = Corner<R>;
        type Varyings<R: Real> = Surface<R>;

        /// A constant of the type.
        pub(crate) const HALF: f32 = 0.5;
        /// A constant of the trait.
        const COLOR_TARGETS: usize = N;

        /// The vertex.
        fn vertex<R: Real>(
            &self,
            input: VertexIn<'_, R>,
            corner: Corner<R>,
        ) -> VertexOut<R, Surface<R>> {
            let index = input.vertex_index.to_real();
            VertexOut::new(
                corner.position.point(),
                Surface {
                    id: index,
                    normal: corner.position,
                    uv: corner.uv,
                    weight: corner.weight,
                },
            )
        }

        #[doc(alias = "shade")]
        fn fragment<R: Real>(&self, _: FragmentIn<'_, R>, at: Surface<R>) -> FragmentOut<R> {
            let light = self.scaled(at.weight, Self::HALF) * Self::offset(1);
            FragmentOut::color((at.normal * light + at.uv.x).extend(at.id))
        }

        /// A function with a generic parameter of its own.
        fn scaled<R>(&self, x: R, by: impl Operand<R>) -> R
        where
            R: Real,
        {
            self.0.weight(x) * by.operand(x) * self.1.into()
        }

        pub(crate) const fn offset(count: u8) -> f32 {
            count as f32
        }
    }
}

crate::shader! {
    /// A function outside.
    pub(crate) fn doubled<R: crate::Real>(x: R) -> R { x + halved(x) }

    #[must_use]
    fn halved<R: crate::Real>(x: R) -> R { x * 0.5 }
}

#[test]
fn a_shader_has_functions_constants_and_bounds_of_its_own() {
    let program = ShaderProgram::new(General::<f32, f32, 3>(1.0, 2.0));
    let interface = program.interface();
    assert_eq!(interface.color_targets, 3);
    assert_eq!(interface.attributes, [3, 1, 2]);
    assert!(
        interface.per_sample,
        "a field is interpolated at each sample"
    );
    assert_eq!(doubled(2.0), 3.0);
    assert_eq!(General::<f32, f32, 3>::offset(2), 2.0);
}

#[test]
fn shaders_may_be_local_to_a_function() {
    struct Local<T>(T);
    crate::shader! {
        // The generics end with two brackets in one token.
        impl<T: Into<f32> + Copy + Send + Sync + 'static + AsRef<Vec<f32>>> Shader for Local<T> {
            type Attributes<R: Real> = Vec4<R>;
            type Varyings<R: Real> = R;

            fn vertex<R: Real>(&self, _: VertexIn<'_, R>, at: Vec4<R>) -> VertexOut<R, R> {
                VertexOut::new(at, at.x * self.0.into())
            }

            fn fragment<R: Real>(&self, _: FragmentIn<'_, R>, light: R) -> FragmentOut<R> {
                FragmentOut::color(Vec4::repeat(light))
            }
        }
    }
    #[derive(Clone, Copy)]
    struct Seven;
    impl From<Seven> for f32 {
        fn from(_: Seven) -> Self {
            7.0
        }
    }
    impl AsRef<Vec<f32>> for Seven {
        fn as_ref(&self) -> &Vec<f32> {
            const { &Vec::new() }
        }
    }
    let program = ShaderProgram::new(Local(Seven));
    assert_eq!(program.interface().varyings, [Interpolation::Smooth]);
}
