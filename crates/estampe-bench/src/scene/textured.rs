//! `textured`: 16 tilted quads over each other, the farthest first, with one texture of 2048²,
//! trilinear and repeated; depth test *less*, no culling.
//!
//! Each quad is 8 × 8 units, with random tilt and position, at a distance from 12 to 5. Positions
//! are rounded to binary32 in view space; the uniform is the projection. A vertex has a position (3
//! floats) and a texture coordinate (2), which runs from 0 to 3.
//!
//! `textured_draws` is `textured` with one draw per quad.

use super::{ASPECT, Detail, Scene, uniforms, upload, vertex_layout};
use crate::generate::{
    LittleEndian, Matrix, QUAD_CORNERS, diffuse_texture, perspective, quad_indices, unit_hash,
};
use estampe::SampledTexture;
use estampe::{
    FragmentIn, FragmentOut, Mat4, RenderPipelineDescriptor, Vec2, Vec3, VertexFormat, VertexIn,
    VertexOut, WithGradient,
};

const QUADS: u32 = 16;

/// Outputs the texture.
struct Textured {
    clip_from_view: Mat4,
    texture: SampledTexture,
}

estampe::shader! {
    impl Shader for Textured {
        type Attributes<R: Real> = (Vec3<R>, Vec2<R>); // position, texture coordinate
        type Varyings<R: Real> = WithGradient<Vec2<R>>; // texture coordinate

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, uv): (Vec3<R>, Vec2<R>),
        ) -> VertexOut<R, WithGradient<Vec2<R>>> {
            VertexOut::new(self.clip_from_view.transform_point(position), uv.into())
        }

        fn fragment<R: Real>(
            &self,
            _input: FragmentIn<'_, R>,
            uv: WithGradient<Vec2<R>>,
        ) -> FragmentOut<R> {
            FragmentOut::color(self.texture.sample(uv))
        }
    }
}

pub(super) fn scene(detail: Detail) -> Scene {
    of_name("textured", detail)
}

pub(super) fn as_draws(detail: Detail) -> Scene {
    of_name("textured_draws", detail).cut_into(QUADS)
}

fn of_name(name: &'static str, detail: Detail) -> Scene {
    let mut vertices = LittleEndian::default();
    for quad in 0..QUADS {
        let view_from_object = view_from_object(quad).columns;
        for [x, y] in QUAD_CORNERS.map(|corner| corner.map(|component| component * 4.0)) {
            let [right, up, _, place] = view_from_object;
            vertices.reals(&[0, 1, 2].map(|k| right[k] * x + up[k] * y + place[k]));
            vertices.reals(&[(x + 4.0) * 0.375, (y + 4.0) * 0.375]);
        }
    }
    let mut uniform_bytes = LittleEndian::default();
    uniform_bytes.matrix(&perspective(1.0 / 6.0, ASPECT, 0.1, 40.0));
    let uniform_bytes = uniform_bytes.into_bytes();
    let texture = diffuse_texture(detail.of(2048, 256), 23);
    let shader = Textured {
        clip_from_view: uniforms::matrix(&uniform_bytes, 0),
        texture: upload::trilinear(&texture),
    };
    let pipeline = RenderPipelineDescriptor {
        vertex_buffers: vec![vertex_layout(
            20,
            &[(VertexFormat::Float32x3, 0), (VertexFormat::Float32x2, 12)],
        )],
        ..RenderPipelineDescriptor::new(shader)
    };
    let buffers = vec![vertices.into_bytes(), quad_indices(QUADS), uniform_bytes];
    Scene::of_one_draw(name, buffers, vec![texture], pipeline)
}

/// A quad's position and tilt in front of the camera.
fn view_from_object(quad: u32) -> Matrix {
    let centred = |k: u32| unit_hash(4000 + 4 * quad + k) - 0.5;
    let distance = 12.0 - 7.0 * f64::from(quad) / 15.0;
    let tilt = Matrix::rotation_y(centred(2) * 0.3).times(&Matrix::rotation_x(centred(3) * 0.3));
    Matrix::translation([centred(0) * 3.0, centred(1) * 2.0, -distance]).times(&tilt)
}
