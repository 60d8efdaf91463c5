//! `blend`: 32 full-screen quads blended source-over with straight alpha; depth test *less* without
//! writes at z = ½ against 1, so that every fragment passes.
//!
//! Corner k of quad i has the hash of 2000 + 4·i + k as its colour, interpolated; the quad's alpha
//! byte is 32 plus six bits of the hash of 3000 + i. A vertex has a position (3 floats) and a
//! colour (4 bytes).

use super::{Scene, vertex_layout};
use crate::generate::{LittleEndian, QUAD_CORNERS, hash32, quad_indices};
use estampe::state::{BlendState, ColorTargetState, DepthStencilState};
use estampe::{
    FragmentIn, FragmentOut, RenderPipelineDescriptor, TextureFormat, Vec3, Vec4, VertexFormat,
    VertexIn, VertexOut,
};

const QUADS: u32 = 32;

/// Outputs the interpolated vertex colour.
struct VertexColor;

estampe::shader! {
    impl Shader for VertexColor {
        type Attributes<R: Real> = (Vec3<R>, Vec4<R>); // position, colour
        type Varyings<R: Real> = Vec4<R>;              // colour

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, color): (Vec3<R>, Vec4<R>),
        ) -> VertexOut<R, Vec4<R>> {
            VertexOut::new(position.point(), color)
        }

        fn fragment<R: Real>(&self, _input: FragmentIn<'_, R>, color: Vec4<R>) -> FragmentOut<R> {
            FragmentOut::color(color)
        }
    }
}

pub(super) fn scene() -> Scene {
    let mut vertices = LittleEndian::default();
    for quad in 0..QUADS {
        let [alpha_bits, ..] = hash32(3000 + quad).to_le_bytes();
        let alpha = 32 + (alpha_bits & 63);
        for (corner, [x, y]) in (0..).zip(QUAD_CORNERS) {
            let [red, green, blue, _] = hash32(2000 + 4 * quad + corner).to_le_bytes();
            vertices.reals(&[x, y, 0.5]);
            vertices.raw(&[red, green, blue, alpha]);
        }
    }
    let pipeline = RenderPipelineDescriptor {
        vertex_buffers: vec![vertex_layout(
            16,
            &[(VertexFormat::Float32x3, 0), (VertexFormat::Unorm8x4, 12)],
        )],
        depth_stencil: Some(DepthStencilState::LESS_READ),
        targets: vec![Some(ColorTargetState {
            blend: Some(BlendState::ALPHA_BLENDING),
            ..TextureFormat::Rgba8Unorm.into()
        })],
        ..RenderPipelineDescriptor::new(VertexColor)
    };
    let buffers = vec![vertices.into_bytes(), quad_indices(QUADS)];
    Scene::of_one_draw("blend", buffers, Vec::new(), pipeline)
}
