//! Shaders of the fast path that read, compare and store the texture of group 0, binding 0.

use estampe_texture::{Coordinates, TextureBindings, sample_compare_level, storage_store};
use estampe_types::shader::VertexOut;
use estampe_types::{FragmentIn, FragmentOut, Int, Real, Vec2, Vec4, VertexIn};

/// [`Textured`](super::Textured) with the bound texture.
#[derive(Debug, Clone, Copy)]
pub struct BoundTexture;

estampe_types::shader! {
    impl Shader for BoundTexture {
        type Attributes<R: Real> = (Vec4<R>, Vec4<R>);
        type Varyings<R: Real> = Vec2<R>;

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, values): (Vec4<R>, Vec4<R>),
        ) -> VertexOut<R, Vec2<R>> {
            VertexOut::new(position, Vec2::new(values.x, values.y))
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, uv: Vec2<R>) -> FragmentOut<R> {
            let texture = input.bindings.sampled_texture(0, 0);
            FragmentOut::color(texture.sample(Coordinates::d2(uv)))
        }
    }
}

/// The share of the texels of the bound shadow map that are at or beyond a depth.
#[derive(Debug, Clone, Copy)]
pub struct BoundDepth(pub f32);

estampe_types::shader! {
    impl Shader for BoundDepth {
        type Attributes<R: Real> = (Vec4<R>, Vec4<R>);
        type Varyings<R: Real> = Vec2<R>;

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, values): (Vec4<R>, Vec4<R>),
        ) -> VertexOut<R, Vec2<R>> {
            VertexOut::new(position, Vec2::new(values.x, values.y))
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, uv: Vec2<R>) -> FragmentOut<R> {
            let reference = input.real(self.0);
            let share = match input.bindings.shadow_map(0, 0) {
                Some(map) => sample_compare_level(map, uv, reference),
                None => input.real(-1.0),
            };
            FragmentOut::color(Vec4::new(share, share * 0.5, input.real(0.25), input.real(1.0)))
        }
    }
}

/// Stores [`value_at`] to each texel of a slice of the bound storage texture; it has no colour. The
/// target is as large as the texture.
#[derive(Debug, Clone, Copy)]
pub struct StoresPlaces {
    /// The layer, or the depth of a 3D texture.
    pub slice: i32,
    /// True if the format has integers.
    pub is_integer: bool,
}

/// The value that is stored to a texel, whose centre is (x, y): numbers, or the bits of integers.
#[inline(always)]
pub fn value_at<R: Real>(x: R, y: R, is_integer: bool) -> Vec4<R> {
    let value = Vec4::new(
        x * 0.125 - 0.5,
        y * 0.0625,
        x * y * 0.03,
        y * 0.5 - x * 0.25,
    );
    if !is_integer {
        return value;
    }
    let whole = |number: R| (number * 40.0).to_int().to_real_bits();
    Vec4::new(
        whole(value.x),
        whole(value.y),
        whole(value.z),
        whole(value.w),
    )
}

estampe_types::shader! {
    impl Shader for StoresPlaces {
        type Attributes<R: Real> = (Vec4<R>, Vec4<R>);
        type Varyings<R: Real> = ();
        const STORES: bool = true;

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, _values): (Vec4<R>, Vec4<R>),
        ) -> VertexOut<R, ()> {
            VertexOut::new(position, ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, _nothing: ()) -> FragmentOut<R> {
            let (x, y) = (input.position.x, input.position.y);
            let at = [x.floor().to_int(), y.floor().to_int()];
            let slice = at[0].splat(self.slice);
            if let Some(texture) = input.bindings.storage_texture(0, 0) {
                let value = value_at(x, y, self.is_integer);
                storage_store(texture, !input.is_helper, [at[0], at[1], slice], value);
            }
            FragmentOut::none()
        }
    }
}
