//! The limits of every device: WebGPU's guaranteed numbers of attributes, varyings and layers are
//! supported, and one more is an error.

use crate::support::{Images, device, device_with};
use estampe::shader::{FragmentIn, FragmentOut, VertexIn, VertexOut};
use estampe::state::{PrimitiveTopology, VertexBufferLayout};
use estampe::{
    Device, DeviceDescriptor, Draw, Extent3d, Level, Limits, PipelineError, Real,
    RenderPipelineDescriptor, TextureDescriptor, TextureFormat, Vec4, VertexFormat, bytes_of,
};

type Four<R> = (Vec4<R>, Vec4<R>, Vec4<R>, Vec4<R>);
type Sixteen<R> = (Four<R>, Four<R>, Four<R>, Four<R>);

/// Sixteen attributes of four numbers become sixteen varyings of four, whose weighted sum is the
/// colour.
struct Full;

#[inline(always)]
fn mixed<R: Real>((a, b, c, d): Four<R>) -> Vec4<R> {
    let half = |first: Vec4<R>, second: Vec4<R>| {
        Vec4::new(
            first.x + second.x * 0.5,
            first.y + second.y * 0.5,
            first.z + second.z * 0.5,
            first.w + second.w * 0.5,
        )
    };
    half(half(a, b), half(c, d))
}

estampe::shader! {
    impl Shader for Full {
        type Attributes<R: Real> = Sixteen<R>;
        type Varyings<R: Real> = Sixteen<R>;

        fn vertex<R: Real>(
            &self,
            input: VertexIn<'_, R>,
            attributes: Sixteen<R>,
        ) -> VertexOut<R, Sixteen<R>> {
            // A triangle that covers the target, from the vertex indices.
            let index = input.vertex_index;
            let is = |number: i32| Int::eq(index, index.splat(number));
            let (low, high) = (input.real(-1.0), input.real(3.0));
            let x = R::select(is(1), high, low);
            let y = R::select(is(2), high, low);
            VertexOut::new(Vec4::new(x, y, input.real(0.5), input.real(1.0)), attributes)
        }

        fn fragment<R: Real>(
            &self,
            _input: FragmentIn<'_, R>,
            (a, b, c, d): Sixteen<R>,
        ) -> FragmentOut<R> {
            FragmentOut::color(mixed((mixed(a), mixed(b), mixed(c), mixed(d))))
        }
    }
}

fn descriptor() -> RenderPipelineDescriptor {
    let mut descriptor = RenderPipelineDescriptor::new(Full);
    descriptor.primitive.topology = PrimitiveTopology::TriangleList;
    // Two buffers of eight.
    let eight = VertexBufferLayout::packed(&[VertexFormat::Float32x4; 8]);
    let mut others = eight.clone();
    for attribute in &mut others.attributes {
        attribute.shader_location += 8;
    }
    descriptor.vertex_buffers = vec![eight, others];
    descriptor
}

/// Rows: N1, V2.
#[test]
fn sixteen_attributes_and_sixteen_varyings() {
    // Attribute k of every vertex is 2⁻⁸ · 2^(k mod 4) in its channel k / 4, so every one changes
    // the colour.
    let value = |attribute: usize, channel: usize| {
        if attribute / 4 == channel {
            (1 << (attribute % 4)) as f32 / 256.0
        } else {
            0.0
        }
    };
    let numbers = |first: usize| -> Vec<f32> {
        let element: Vec<f32> = (first..first + 8)
            .flat_map(|attribute| [0, 1, 2, 3].map(|channel| value(attribute, channel)))
            .collect();
        element.repeat(3)
    };
    // `mixed` has the weights 1, ½, ½, ¼, repeated.
    let weights = [1.0, 0.5, 0.5, 0.25];
    let expected = [0, 1, 2, 3].map(|channel: usize| {
        let sum: f32 = (0..4)
            .map(|k| value(channel * 4 + k, channel) * weights[k] * weights[channel])
            .sum();
        (sum * 255.0 + 0.5).floor()
    });
    for level in Level::all_available() {
        let device = device_with(0, level);
        let buffers = [0, 8].map(|first| {
            let buffer = device.create_buffer_with_contents(bytes_of(&numbers(first)));
            buffer.expect("it is small").slice(..)
        });
        let pipeline = device
            .create_render_pipeline(&descriptor())
            .expect("within the limits");
        let images = Images::new(&device, 5, 3);
        let draws = [Draw {
            vertex_buffers: &buffers,
            ..Draw::new(&pipeline, 0..3)
        }];
        images.draw(&device, &draws);
        for pixel in images.pixels(&device).as_chunks::<4>().0 {
            assert_eq!(pixel.map(f32::from), expected, "{}", level.name());
        }
    }
}

/// Rows: N1.
#[test]
fn one_more_is_an_error_that_names_the_limit() {
    let refused = |limits: Limits| {
        let device = Device::new(&DeviceDescriptor {
            limits,
            ..DeviceDescriptor::default()
        });
        let device = device.expect("the system starts threads");
        let refused = device.create_render_pipeline(&descriptor());
        refused.expect_err("beyond the limits")
    };
    let attributes = refused(Limits {
        max_vertex_attributes: 15,
        ..Limits::default()
    });
    assert_eq!(
        attributes,
        PipelineError::TooManyAttributes {
            count: 16,
            limit: 15
        }
    );
    let varyings = refused(Limits {
        max_inter_stage_scalars: 63,
        ..Limits::default()
    });
    assert!(
        varyings.to_string().contains("max_inter_stage_scalars"),
        "{varyings}"
    );
    let least = Limits::default();
    assert!(least.max_vertex_attributes >= 16 && least.max_inter_stage_scalars >= 64);
    assert!(least.max_color_attachments >= 8 && least.max_texture_dimension_2d >= 8192);
}

/// Rows: N1, F2.
#[test]
fn textures_have_256_layers_and_no_more() {
    let create = |depth_or_array_layers: u32| {
        device().create_texture(&TextureDescriptor {
            size: Extent3d {
                depth_or_array_layers,
                ..Extent3d::new_2d(3, 2)
            },
            ..TextureDescriptor::new_2d(3, 2, TextureFormat::R8Unorm)
        })
    };
    assert!(create(256).is_ok());
    let message = create(257).expect_err("one layer too many").to_string();
    assert!(
        message.contains("256") && message.contains("257"),
        "{message}"
    );
}
