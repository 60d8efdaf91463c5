//! Array layers, slices and cube faces: rendered to one by one, and sampled as a whole.

use crate::support::sampling::{draw_over, sampled_group, sampling_pipeline};
use crate::support::{clear, covering, devices, read_layer, texture};
use estampe::shader::{FragmentIn, FragmentOut, VertexIn, VertexOut};
use estampe::{
    ColorAttachment, Coordinates, Extent3d, Lod, RenderPass, SampleType, TextureBindings,
    TextureDescriptor, TextureDimension, TextureFormat, TextureViewDescriptor, Vec2, Vec3, Vec4,
    ViewDimension,
};

/// Texels of a layer or slice.
struct Fetch {
    slice: i32,
}

estampe::shader! {
    impl Shader for Fetch {
        type Attributes<R: Real> = ();
        type Varyings<R: Real> = ();
        const READS_POSITION: bool = true;

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, (): ()) -> VertexOut<R, ()> {
            let at: Vec2<R> = covering(&input);
            VertexOut::new(Vec4::new(at.x, at.y, input.zero, input.real(1.0)), ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
            let [x, y] = [input.position.x, input.position.y].map(|at| at.floor().to_int());
            let (zero, slice) = (x.splat(0), x.splat(self.slice));
            let view = input.bindings.sampled_texture(0, 0).view();
            FragmentOut::color(view.fetch([x, y, slice], zero, zero))
        }
    }
}

#[test]
fn array_layers_and_slices_are_rendered_and_sampled() {
    for dimension in [TextureDimension::D2, TextureDimension::D3] {
        for (name, device) in devices() {
            let image = device
                .create_texture(&TextureDescriptor {
                    dimension,
                    size: Extent3d {
                        width: 20,
                        height: 17,
                        depth_or_array_layers: 4,
                    },
                    ..TextureDescriptor::new_2d(20, 17, TextureFormat::Rgba8Unorm)
                })
                .unwrap();
            let is_3d = dimension == TextureDimension::D3;
            let attachment = |layer: u32, color| {
                if is_3d {
                    ColorAttachment {
                        depth_slice: Some(layer),
                        ..ColorAttachment::clear(&image.view(), color)
                    }
                } else {
                    ColorAttachment::clear(&image.image(0, layer).unwrap(), color)
                }
            };
            let codes = |layer: u32| [10 * layer, 3, 255 - layer, 200];
            let color = |layer| codes(layer).map(|code| f64::from(code) / 255.0);
            // Two layers in one pass, then the others; layer 2 is left out.
            device
                .render(&RenderPass {
                    color_attachments: &[
                        Some(attachment(3, color(3))),
                        Some(attachment(1, color(1))),
                    ],
                    ..RenderPass::default()
                })
                .unwrap();
            device
                .render(&RenderPass {
                    color_attachments: &[Some(attachment(0, color(0)))],
                    ..RenderPass::default()
                })
                .unwrap();
            let dimension = image.view().dimension();
            let kind = (SampleType::Float, dimension);
            let target = texture(&device, [20, 17], TextureFormat::Rgba8Unorm);
            for layer in 0..4 {
                let texel = codes(layer).map(|code| u8::try_from(code).unwrap());
                let texel = if layer == 2 { [0; 4] } else { texel };
                let expected = texel.repeat(20 * 17);
                let what = format!("{dimension:?}, layer {layer}, {name}");
                assert!(read_layer(&device, &image, 0, layer) == expected, "{what}");
                let shader = Fetch {
                    slice: layer.cast_signed(),
                };
                let (layout, pipeline) = sampling_pipeline(&device, shader, kind, target.format());
                let group = sampled_group(&device, &layout, &image.view());
                draw_over(&device, &pipeline, &group, &target.view());
                assert!(device.read_texture(&target).unwrap() == expected, "{what}");
            }
        }
    }
}

/// A cube, sampled in one direction.
struct Towards([f32; 3]);

estampe::shader! {
    impl Shader for Towards {
        type Attributes<R: Real> = ();
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, (): ()) -> VertexOut<R, ()> {
            let at: Vec2<R> = covering(&input);
            VertexOut::new(Vec4::new(at.x, at.y, input.zero, input.real(1.0)), ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
            let [x, y, z] = self.0.map(|axis| input.real(axis));
            let at = Coordinates::cube(Vec3::new(x, y, z));
            let texture = input.bindings.sampled_texture(0, 0);
            FragmentOut::color(texture.sample_with(at, Lod::Level(input.zero), [0; 3]))
        }
    }
}

#[test]
fn cube_faces_are_rendered_and_sampled() {
    for (name, device) in devices() {
        let size = Extent3d {
            width: 8,
            height: 8,
            depth_or_array_layers: 6,
        };
        let descriptor = TextureDescriptor {
            size,
            ..TextureDescriptor::new_2d(8, 8, TextureFormat::Rgba8Unorm)
        };
        let image = device.create_texture(&descriptor).unwrap();
        let cube = image
            .create_view(&TextureViewDescriptor {
                dimension: Some(ViewDimension::Cube),
                ..TextureViewDescriptor::default()
            })
            .unwrap();
        for face in 0..6 {
            let color = [f64::from(face) / 5.0, 1.0, 0.0, 1.0];
            clear(&device, &image.image(0, face).unwrap(), color);
        }
        let target = texture(&device, [1, 1], TextureFormat::Rgba8Unorm);
        let kind = (SampleType::Float, ViewDimension::Cube);
        let directions = [
            [1.0, 0.0, 0.0],
            [-1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, -1.0, 0.0],
            [0.0, 0.0, 1.0],
            [0.0, 0.0, -1.0],
        ];
        for (face, direction) in (0_u8..).zip(directions) {
            let (layout, pipeline) =
                sampling_pipeline(&device, Towards(direction), kind, target.format());
            let group = sampled_group(&device, &layout, &cube);
            draw_over(&device, &pipeline, &group, &target.view());
            let seen = device.read_texture(&target).unwrap();
            assert_eq!(seen, [face * 51, 255, 0, 255], "face {face}, {name}");
        }
    }
}
