//! `fill`, `fill_front` and `fill_draws`: 32 full-screen opaque quads in flat colours, depth test
//! *less* with writes, in one draw; `fill_draws` is `fill` with one draw per quad.
//!
//! Quad i is at z = (i + 1)/33; its colour is the hash of 1000 + i. In `fill`, drawn from the
//! farthest on, every fragment passes; in `fill_front`, drawn from the nearest on, only those of
//! the first quad. A vertex has a position (3 floats) and a colour (4 bytes).

use super::{Scene, vertex_layout};
use crate::generate::{LittleEndian, QUAD_CORNERS, hash32, quad_indices};
use estampe::{
    Flat, FragmentIn, FragmentOut, RenderPipelineDescriptor, Vec3, Vec4, VertexFormat, VertexIn,
    VertexOut,
};

const QUADS: u32 = 32;

/// Outputs the provoking vertex's colour.
struct FlatColor;

estampe::shader! {
    impl Shader for FlatColor {
        type Attributes<R: Real> = (Vec3<R>, Vec4<R>); // position, colour
        type Varyings<R: Real> = Flat<Vec4<R>>;        // colour

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, color): (Vec3<R>, Vec4<R>),
        ) -> VertexOut<R, Flat<Vec4<R>>> {
            VertexOut::new(position.point(), Flat(color))
        }

        fn fragment<R: Real>(
            &self,
            _input: FragmentIn<'_, R>,
            Flat(color): Flat<Vec4<R>>,
        ) -> FragmentOut<R> {
            FragmentOut::color(color)
        }
    }
}

pub(super) fn back_to_front() -> Scene {
    scene("fill", (0..QUADS).rev())
}

pub(super) fn front_to_back() -> Scene {
    scene("fill_front", 0..QUADS)
}

pub(super) fn as_draws() -> Scene {
    scene("fill_draws", (0..QUADS).rev()).cut_into(QUADS)
}

fn scene(name: &'static str, order: impl Iterator<Item = u32>) -> Scene {
    let mut vertices = LittleEndian::default();
    for quad in order {
        let z = f64::from(quad + 1) / 33.0;
        let [red, green, blue, _] = hash32(1000 + quad).to_le_bytes();
        for [x, y] in QUAD_CORNERS {
            vertices.reals(&[x, y, z]);
            vertices.raw(&[red, green, blue, 255]);
        }
    }
    let pipeline = RenderPipelineDescriptor {
        vertex_buffers: vec![vertex_layout(
            16,
            &[(VertexFormat::Float32x3, 0), (VertexFormat::Unorm8x4, 12)],
        )],
        ..RenderPipelineDescriptor::new(FlatColor)
    };
    let buffers = vec![vertices.into_bytes(), quad_indices(QUADS)];
    Scene::of_one_draw(name, buffers, Vec::new(), pipeline)
}
