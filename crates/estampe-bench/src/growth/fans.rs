//! Frames by number of pixels: a fan of sixteen triangles from the centre to the border covers each
//! pixel once, nearer in the centre than at the border. The work per pixel is clearing only,
//! Gouraud shading, or lighting per fragment.

use super::gouraud;
use crate::frame::FrameSize;
use crate::generate::{LittleEndian, hash32};
use crate::scene::{Scene, SceneEntry, vertex_layout};
use estampe::{
    FragmentIn, FragmentOut, RenderPipelineDescriptor, Vec3, Vec4, VertexFormat, VertexIn,
    VertexOut, maths,
};

/// The sides of the measured frames, in pixels: powers of two from 64 to 8192.
pub const SIDES: [u32; 8] = [64, 128, 256, 512, 1024, 2048, 4096, 8192];

/// A square frame.
#[must_use]
pub fn square(side: u32) -> FrameSize {
    FrameSize {
        width: side,
        height: side,
    }
}

/// The work per pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Work {
    /// Colour and depth are cleared.
    Clear,
    /// As `Clear`, and the fan's colours are interpolated.
    Gouraud,
    /// As `Clear`, and the fan is lit per fragment (Blinn 1977).
    BlinnPhong,
}

/// The measured kinds of work.
pub const WORKS: [Work; 3] = [Work::Clear, Work::Gouraud, Work::BlinnPhong];

impl Work {
    /// The name in tables and plots.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Clear => "clear",
            Self::Gouraud => "Gouraud",
            Self::BlinnPhong => "Blinn-Phong",
        }
    }

    /// The scene with this work, for a frame of any size.
    #[must_use]
    pub fn scene(self) -> Scene {
        let pipeline = match self {
            Self::Clear => {
                let clear = SceneEntry::named("clear").expect("the list of scenes has it");
                return clear.make(crate::scene::Detail::Full, square(64));
            }
            Self::Gouraud => gouraud::pipeline(),
            Self::BlinnPhong => RenderPipelineDescriptor {
                vertex_buffers: vec![vertex_layout(
                    16,
                    &[(VertexFormat::Float32x3, 0), (VertexFormat::Unorm8x4, 12)],
                )],
                ..RenderPipelineDescriptor::new(Lit)
            },
        };
        Scene::of_one_draw(self.name(), fan(), Vec::new(), pipeline)
    }
}

/// Blinn-Phong lighting of a surface whose normal and colour both come from the colour attribute.
struct Lit;

estampe::shader! {
    impl Shader for Lit {
        type Attributes<R: Real> = (Vec3<R>, Vec4<R>);          // NDC position, colour
        type Varyings<R: Real> = (Vec3<R>, Vec3<R>, Vec3<R>);   // position, normal, colour

        fn vertex<R: Real>(
            &self,
            input: VertexIn<'_, R>,
            (position, color): (Vec3<R>, Vec4<R>),
        ) -> VertexOut<R, (Vec3<R>, Vec3<R>, Vec3<R>)> {
            // w = 1 + z: the border is farther away than the centre.
            let w = position.z + input.real(1.0);
            let clip = Vec4::new(position.x * w, position.y * w, position.z * w, w);
            let half = Vec3::repeat(input.real(0.5));
            VertexOut::new(clip, (position, color.xyz() - half, color.xyz()))
        }

        fn fragment<R: Real>(
            &self,
            input: FragmentIn<'_, R>,
            (position, normal, albedo): (Vec3<R>, Vec3<R>, Vec3<R>),
        ) -> FragmentOut<R> {
            let towards_light = Vec3::uniform(input.zero, [0.48, 0.6, -0.64]);
            let eye = Vec3::uniform(input.zero, [0.0, 0.0, -2.0]);
            let n = normal.normalize();
            let half = (towards_light + (eye - position).normalize()).normalize();
            let diffuse = n.dot(towards_light).max(input.zero) * 0.85 + 0.15;
            let specular = maths::powi(n.dot(half).max(input.zero), 32) * 0.5;
            FragmentOut::color((albedo * diffuse + Vec3::repeat(specular)).point())
        }
    }
}

/// Vertices and indices of the fan: the centre, then the border, counter-clockwise with y up.
fn fan() -> Vec<Vec<u8>> {
    let mut vertices = LittleEndian::default();
    let mut indices = LittleEndian::default();
    let border = (0..16).map(|step| {
        let along = f64::from(step % 4) * 0.5 - 1.0;
        match step / 4 {
            0 => [along, -1.0],
            1 => [1.0, along],
            2 => [-along, 1.0],
            _ => [-1.0, -along],
        }
    });
    let places = std::iter::once([0.0, 0.0, 0.25]).chain(border.map(|[x, y]| [x, y, 0.75]));
    for (number, place) in (0..).zip(places) {
        let [red, green, blue, _] = hash32(number).to_le_bytes();
        vertices.reals(&place);
        vertices.raw(&[red, green, blue, 255]);
    }
    for step in 0..16 {
        indices.words(&[0, 1 + step, 1 + (step + 1) % 16]);
    }
    vec![vertices.into_bytes(), indices.into_bytes()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::PreparedScene;
    use estampe::{Device, DeviceDescriptor};

    #[test]
    fn a_fan_covers_each_pixel_once() {
        let device = Device::new(&DeviceDescriptor {
            threads: 1,
            ..DeviceDescriptor::default()
        })
        .unwrap();
        for work in [Work::Gouraud, Work::BlinnPhong] {
            let scene = work.scene();
            let mut prepared = PreparedScene::new(&device, &scene, square(64)).unwrap();
            let times = prepared.draw();
            assert_eq!(times.statistics.fragments_shaded, 64 * 64, "{work:?}");
        }
        assert!(Work::Clear.scene().draws.is_empty());
    }
}
