//! Gouraud shading (1971): vertex colours, interpolated. Opaque, depth test *less* with writes.

use crate::scene::vertex_layout;
use estampe::{
    FragmentIn, FragmentOut, RenderPipelineDescriptor, Vec3, Vec4, VertexFormat, VertexIn,
    VertexOut,
};

/// The vertex's colour.
struct Gouraud;

estampe::shader! {
    impl Shader for Gouraud {
        type Attributes<R: Real> = (Vec3<R>, Vec4<R>); // NDC position, colour
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

/// A pipeline for vertices of 16 bytes: NDC position (3 floats), colour (4 bytes).
pub(super) fn pipeline() -> RenderPipelineDescriptor {
    RenderPipelineDescriptor {
        vertex_buffers: vec![vertex_layout(
            16,
            &[(VertexFormat::Float32x3, 0), (VertexFormat::Unorm8x4, 12)],
        )],
        ..RenderPipelineDescriptor::new(Gouraud)
    }
}
