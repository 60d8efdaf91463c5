//! Layers of quads or grids over each other, in a flat or an interpolated colour.

use estampe::{Flat, FragmentIn, FragmentOut, Vec2, Vec3, Vec4, VertexIn, VertexOut};

/// Layers over each other: instance i is at z = first + i·step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Layers {
    pub(super) count: u32,
    first: f32,
    step: f32,
}

impl Layers {
    /// One layer.
    pub(super) const ONE: Self = Self {
        count: 1,
        first: 0.5,
        step: 0.0,
    };
    /// Every fragment passes *less*.
    pub(super) const BACK_TO_FRONT: Self = Self {
        count: 32,
        first: 0.97,
        step: -0.03,
    };
    /// Only the first layer's fragments pass *less*.
    pub(super) const FRONT_TO_BACK: Self = Self {
        count: 32,
        first: 0.03,
        step: 0.03,
    };
}

/// A flat colour per primitive.
pub(super) struct FlatLayers(pub(super) Layers);
/// An interpolated colour.
pub(super) struct SmoothLayers(pub(super) Layers);

/// The clip-space position of an instance's vertex.
macro_rules! layer_position {
    ($input:ident, $layers:expr, $position:ident) => {{
        let z = $input.instance_index.to_real() * $layers.step + $layers.first;
        Vec4::new($position.x, $position.y, z, $input.real(1.0))
    }};
}

estampe::shader! {
    impl Shader for FlatLayers {
        type Attributes<R: Real> = (Vec2<R>, Vec4<R>); // NDC position, colour
        type Varyings<R: Real> = Flat<Vec3<R>>;        // colour

        fn vertex<R: Real>(
            &self,
            input: VertexIn<'_, R>,
            (position, color): (Vec2<R>, Vec4<R>),
        ) -> VertexOut<R, Flat<Vec3<R>>> {
            VertexOut::new(layer_position!(input, self.0, position), Flat(color.xyz()))
        }

        fn fragment<R: Real>(
            &self,
            _input: FragmentIn<'_, R>,
            Flat(color): Flat<Vec3<R>>,
        ) -> FragmentOut<R> {
            FragmentOut::color(color.point())
        }
    }
}

estampe::shader! {
    impl Shader for SmoothLayers {
        type Attributes<R: Real> = (Vec2<R>, Vec4<R>); // NDC position, colour
        type Varyings<R: Real> = Vec4<R>;              // colour

        fn vertex<R: Real>(
            &self,
            input: VertexIn<'_, R>,
            (position, color): (Vec2<R>, Vec4<R>),
        ) -> VertexOut<R, Vec4<R>> {
            VertexOut::new(layer_position!(input, self.0, position), color)
        }

        fn fragment<R: Real>(&self, _input: FragmentIn<'_, R>, color: Vec4<R>) -> FragmentOut<R> {
            FragmentOut::color(color)
        }
    }
}
