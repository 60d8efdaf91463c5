//! Textures that are rendered to, sampled in the next pass, and rendered to again: the same bytes
//! at every SIMD level and with any number of threads.

mod support;

use estampe::shader::{FragmentIn, FragmentOut, VertexIn, VertexOut};
use estampe::state::ScissorRect;
use estampe::{
    AspectOperations, BindGroup, BindGroupDescriptor, BindGroupLayout, BindGroupLayoutEntry,
    BindingResource, BindingType, ColorAttachment, Coordinates, DepthStencilAttachment, Device,
    Draw, Extent3d, LoadOp, Lod, RenderPass, RenderPipeline, RenderPipelineDescriptor, SampleType,
    SamplerDescriptor, StoreOp, TexelCopyLayout, Texture, TextureBindings, TextureCopy,
    TextureDescriptor, TextureDimension, TextureFormat, TextureView, TextureViewDescriptor, Vec2,
    Vec3, Vec4, ViewDimension, srgb,
};
use support::{Fill, Images, clear, covering, device, devices, f32s, noise, texture};

/// Samples binding 0 from right to left, and turns the channels round: the green becomes the red.
struct Turned;

estampe::shader! {
    impl Shader for Turned {
        type Attributes<R: Real> = ();
        type Varyings<R: Real> = Vec2<R>;
        const NO_DERIVATIVES: bool = true;

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, (): ()) -> VertexOut<R, Vec2<R>> {
            let at: Vec2<R> = covering(&input);
            let uv = Vec2::new(at.x * -0.5 + 0.5, at.y * -0.5 + 0.5);
            VertexOut::new(Vec4::new(at.x, at.y, input.zero, input.real(1.0)), uv)
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, uv: Vec2<R>) -> FragmentOut<R> {
            let texture = input.bindings.sampled_texture(0, 0);
            let color = texture.sample_with(Coordinates::d2(uv), Lod::Level(input.zero), [0; 3]);
            FragmentOut::color(Vec4::new(color.y, color.z, color.x, color.w))
        }
    }
}

/// A pipeline of a shader that reads one texture with its sampler, for colours of a format.
fn pipeline_of(
    device: &Device,
    shader: impl estampe::Shader,
    [sample_type, view_dimension]: [Kind; 2],
    format: TextureFormat,
) -> (BindGroupLayout, RenderPipeline) {
    let (Kind::Sample(sample_type), Kind::View(view_dimension)) = (sample_type, view_dimension)
    else {
        unreachable!("a sample type and a dimension")
    };
    let layout = device
        .create_bind_group_layout(&[BindGroupLayoutEntry {
            binding: 0,
            ty: BindingType::SampledTexture {
                sample_type,
                view_dimension,
            },
        }])
        .unwrap();
    let pipeline = device
        .create_render_pipeline(&RenderPipelineDescriptor {
            bind_group_layouts: vec![layout.clone()],
            depth_stencil: None,
            targets: vec![format.into()],
            ..RenderPipelineDescriptor::new(shader)
        })
        .unwrap();
    (layout, pipeline)
}

#[derive(Clone, Copy)]
enum Kind {
    Sample(SampleType),
    View(ViewDimension),
}

const FLAT: [Kind; 2] = [
    Kind::Sample(SampleType::Float),
    Kind::View(ViewDimension::D2),
];

/// A bind group of a view with the default sampler.
fn bound(device: &Device, layout: &BindGroupLayout, view: &TextureView) -> BindGroup {
    let sampler = device
        .create_sampler(&SamplerDescriptor::default())
        .unwrap();
    device
        .create_bind_group(&BindGroupDescriptor {
            label: None,
            layout,
            entries: &[(0, BindingResource::SampledTexture(view.clone(), sampler))],
        })
        .unwrap()
}

/// Draws a triangle over a view, which reads another one.
fn draw(device: &Device, pipeline: &RenderPipeline, group: &BindGroup, into: &TextureView) {
    device
        .render(&RenderPass {
            color_attachments: &[Some(ColorAttachment::load(into))],
            draws: &[Draw {
                bind_groups: std::slice::from_ref(group),
                ..Draw::new(pipeline, 0..3)
            }],
            ..RenderPass::default()
        })
        .unwrap();
}

/// The result of [`Turned`] for RGBA or BGRA bytes, in the size of another image.
fn turned(bytes: &[u8], from: [u32; 2], into: [u32; 2], is_bgra: bool) -> Vec<u8> {
    let [width, height] = into;
    let mut turned = Vec::new();
    for y in 0..height {
        for x in 0..width {
            // Pixel centres, from the right.
            let column = (2 * (width - x) - 1) * from[0] / (2 * width);
            let row = (2 * y + 1) * from[1] / (2 * height);
            let at = (row * from[0] + column) as usize * 4;
            let mut texel: [u8; 4] = bytes[at..at + 4].try_into().unwrap();
            if is_bgra {
                texel.swap(0, 2);
            }
            texel[..3].rotate_left(1);
            if is_bgra {
                texel.swap(0, 2);
            }
            turned.extend(texel);
        }
    }
    turned
}

fn write(device: &Device, texture: &Texture, bytes: &[u8]) {
    let layout = TexelCopyLayout::default();
    device
        .write_texture(texture, bytes, &layout, texture.size())
        .unwrap();
}

/// The bytes of one level of one layer or slice.
fn read(device: &Device, texture: &Texture, level: u32, layer: u32) -> Vec<u8> {
    let size = texture.level_size(level);
    let size = Extent3d::new_2d(size.width, size.height);
    let each = texture.format().block_bytes();
    let mut bytes = vec![0; (size.width * size.height * each) as usize];
    let from = TextureCopy {
        mip_level: level,
        origin: [0, 0, layer],
        ..texture.into()
    };
    let layout = TexelCopyLayout::default();
    device
        .read_texture_into(from, &mut bytes, &layout, size)
        .unwrap();
    bytes
}

/// The host writes A; passes draw A into B, B into A and A into B; between them the host reads, and
/// changes a part.
#[test]
fn pictures_are_sampled_and_rendered_to_in_turn() {
    let size = [70, 45];
    for format in [TextureFormat::Rgba8Unorm, TextureFormat::Bgra8Unorm] {
        for (name, device) in devices() {
            let (layout, pipeline) = pipeline_of(&device, Turned, FLAT, format);
            let [a, b] = [0, 1].map(|_| texture(&device, size, format));
            let [from_a, from_b] = [&a, &b].map(|from| bound(&device, &layout, &from.view()));
            let once_more = |bytes: &[u8]| turned(bytes, size, size, format.is_bgra());

            let first = noise(70 * 45 * 4, 7);
            write(&device, &a, &first);
            draw(&device, &pipeline, &from_a, &b.view());
            draw(&device, &pipeline, &from_b, &a.view());
            let twice = once_more(&once_more(&first));
            assert!(
                device.read_texture(&a).unwrap() == twice,
                "{format:?}, {name}"
            );
            assert!(
                device.read_texture(&b).unwrap() == once_more(&first),
                "{format:?}, {name}"
            );

            // The host's texel is in what the next pass samples.
            let one = Extent3d::new_2d(1, 1);
            device
                .write_texture(&a, &[1, 2, 3, 4], &TexelCopyLayout::default(), one)
                .unwrap();
            let mut changed = twice.clone();
            changed[..4].copy_from_slice(&[1, 2, 3, 4]);
            draw(&device, &pipeline, &from_a, &b.view());
            assert!(
                device.read_texture(&b).unwrap() == once_more(&changed),
                "{format:?}, {name}"
            );
            // And in what the next pass draws over.
            device
                .render(&RenderPass {
                    color_attachments: &[Some(ColorAttachment::load(&a.view()))],
                    draws: &[Draw {
                        bind_groups: std::slice::from_ref(&from_b),
                        scissor: Some(ScissorRect {
                            x: 30,
                            y: 0,
                            width: 40,
                            height: 45,
                        }),
                        ..Draw::new(&pipeline, 0..3)
                    }],
                    ..RenderPass::default()
                })
                .unwrap();
            let over = once_more(&once_more(&changed));
            for (at, code) in device.read_texture(&a).unwrap().iter().enumerate() {
                let is_drawn = at / 4 % 70 >= 30;
                let expected = if is_drawn { &over } else { &changed };
                assert_eq!(*code, expected[at], "byte {at}, {format:?}, {name}");
            }
        }
    }
}

/// Linear texels that are written and read as sRGB.
#[test]
fn an_srgb_view_of_a_linear_texture_encodes_and_decodes() {
    for format in [TextureFormat::Rgba8Unorm, TextureFormat::Bgra8Unorm] {
        let encoded = format.with_srgb(true);
        for (name, device) in devices() {
            let image = texture(&device, [9, 5], format);
            let srgb_view = image
                .create_view(&TextureViewDescriptor {
                    format: Some(encoded),
                    ..TextureViewDescriptor::default()
                })
                .unwrap();
            assert_eq!((srgb_view.format(), image.format()), (encoded, format));
            clear(&device, &srgb_view, [0.5; 4]);
            let texel = [188, 188, 188, 128];
            assert_eq!(read(&device, &image, 0, 0), texel.repeat(45), "{name}");
            let draws = device
                .create_render_pipeline(&RenderPipelineDescriptor {
                    depth_stencil: None,
                    targets: vec![encoded.into()],
                    ..RenderPipelineDescriptor::new(Fill {
                        color: [0.0, 0.5, 1.0, 0.5],
                        depth: 0.0,
                    })
                })
                .unwrap();
            device
                .render(&RenderPass {
                    color_attachments: &[Some(ColorAttachment::load(&srgb_view))],
                    draws: &[Draw::new(&draws, 0..3)],
                    ..RenderPass::default()
                })
                .unwrap();
            let mut texel = [0, 188, 255, 128];
            if format.is_bgra() {
                texel.swap(0, 2);
            }
            assert_eq!(read(&device, &image, 0, 0), texel.repeat(45), "{name}");

            // Sampled as they are, and decoded. `Turned` makes green the red.
            let target = texture(&device, [9, 5], TextureFormat::Rgba8Unorm);
            let (layout, pipeline) = pipeline_of(&device, Turned, FLAT, TextureFormat::Rgba8Unorm);
            draw(
                &device,
                &pipeline,
                &bound(&device, &layout, &image.view()),
                &target.view(),
            );
            let plain = device.read_texture(&target).unwrap();
            assert_eq!(plain, [188, 255, 0, 128].repeat(45), "{name}");
            draw(
                &device,
                &pipeline,
                &bound(&device, &layout, &srgb_view),
                &target.view(),
            );
            assert_eq!((srgb::decode(188) * 255.0 + 0.5).floor(), 128.0);
            let seen = device.read_texture(&target).unwrap();
            assert_eq!(seen, [128, 255, 0, 128].repeat(45), "{name}");
        }
    }
}

/// Each level is drawn from the one above, of the same texture.
#[test]
fn a_mip_level_is_rendered_from_another_one() {
    for (name, device) in devices() {
        let descriptor =
            TextureDescriptor::new_2d(64, 32, TextureFormat::Rgba8Unorm).with_all_levels();
        let image = device.create_texture(&descriptor).unwrap();
        assert_eq!(image.mip_level_count(), 7);
        let (layout, pipeline) = pipeline_of(&device, Turned, FLAT, image.format());
        let mut above = noise(64 * 32 * 4, 3);
        let full = Extent3d::new_2d(64, 32);
        device
            .write_texture(&image, &above, &TexelCopyLayout::default(), full)
            .unwrap();
        let mut all = vec![above.clone()];
        for level in 1..7 {
            let [from, into] = [level - 1, level].map(|level| image.image(level, 0).unwrap());
            draw(&device, &pipeline, &bound(&device, &layout, &from), &into);
            above = turned(&above, from.size(), into.size(), false);
            all.push(above.clone());
        }
        for (level, expected) in (0..).zip(&all) {
            assert!(
                read(&device, &image, level, 0) == *expected,
                "level {level}, {name}"
            );
        }
    }
}

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
            let kind = [Kind::Sample(SampleType::Float), Kind::View(dimension)];
            let target = texture(&device, [20, 17], TextureFormat::Rgba8Unorm);
            for layer in 0..4 {
                let texel = codes(layer).map(|code| u8::try_from(code).unwrap());
                let texel = if layer == 2 { [0; 4] } else { texel };
                let expected = texel.repeat(20 * 17);
                let what = format!("{dimension:?}, layer {layer}, {name}");
                assert!(read(&device, &image, 0, layer) == expected, "{what}");
                let shader = Fetch {
                    slice: layer.cast_signed(),
                };
                let (layout, pipeline) = pipeline_of(&device, shader, kind, target.format());
                let group = bound(&device, &layout, &image.view());
                draw(&device, &pipeline, &group, &target.view());
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
        let kind = [
            Kind::Sample(SampleType::Float),
            Kind::View(ViewDimension::Cube),
        ];
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
                pipeline_of(&device, Towards(direction), kind, target.format());
            let group = bound(&device, &layout, &cube);
            draw(&device, &pipeline, &group, &target.view());
            let seen = device.read_texture(&target).unwrap();
            assert_eq!(seen, [face * 51, 255, 0, 255], "face {face}, {name}");
        }
    }
}

/// The depths that binding 0 holds, as grey.
struct Grey {
    depth: f32,
}

estampe::shader! {
    impl Shader for Grey {
        type Attributes<R: Real> = ();
        type Varyings<R: Real> = ();
        const READS_POSITION: bool = true;

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, (): ()) -> VertexOut<R, ()> {
            let at: Vec2<R> = covering(&input);
            VertexOut::new(Vec4::new(at.x, at.y, input.real(self.depth), input.real(1.0)), ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
            let [x, y] = [input.position.x, input.position.y].map(|at| at.floor().to_int());
            let zero = x.splat(0);
            let depth = input.bindings.sampled_texture(0, 0).view().fetch([x, y, zero], zero, zero).x;
            FragmentOut::color(Vec4::new(depth, depth, depth, input.real(1.0)))
        }
    }
}

const LEFT: ScissorRect = ScissorRect {
    x: 0,
    y: 0,
    width: 20,
    height: 30,
};

/// A pipeline that writes one depth, and no colours.
fn depth_writer(device: &Device, depth: f32, format: TextureFormat) -> RenderPipeline {
    let fill = Fill {
        depth,
        ..Fill::WHITE
    };
    device
        .create_render_pipeline(&RenderPipelineDescriptor {
            targets: vec![format.into()],
            ..RenderPipelineDescriptor::new(fill)
        })
        .unwrap()
}

#[test]
fn depth_is_sampled_while_it_is_tested_read_only() {
    for (name, device) in devices() {
        let images = Images::new(&device, 50, 30);
        let half = depth_writer(&device, 0.5, TextureFormat::Rgba8Unorm);
        let draw = Draw {
            scissor: Some(LEFT),
            ..Draw::new(&half, 0..3)
        };
        images.draw(&device, &[draw]);

        let kind = [
            Kind::Sample(SampleType::Depth),
            Kind::View(ViewDimension::D2),
        ];
        let draw_grey = |depth: f32| {
            let (layout, pipeline) =
                pipeline_of(&device, Grey { depth }, kind, TextureFormat::Rgba8Unorm);
            let mut descriptor = pipeline.descriptor().clone();
            descriptor.depth_stencil = Some(
                estampe::state::DepthState {
                    compare: estampe::state::CompareFunction::Less,
                    write_enabled: false,
                }
                .into(),
            );
            let pipeline = device.create_render_pipeline(&descriptor).unwrap();
            let group = bound(&device, &layout, &images.depth.view());
            let view = images.color.view();
            device
                .render(&RenderPass {
                    color_attachments: &[Some(ColorAttachment::clear(&view, [0.0; 4]))],
                    depth_stencil_attachment: Some(DepthStencilAttachment::read_only(
                        &images.depth.view(),
                    )),
                    draws: &[Draw {
                        bind_groups: std::slice::from_ref(&group),
                        ..Draw::new(&pipeline, 0..3)
                    }],
                    ..RenderPass::default()
                })
                .unwrap();
            images.pixels(&device)
        };
        let expected =
            |left: [u8; 4], right: [u8; 4]| [left.repeat(20), right.repeat(30)].concat().repeat(30);
        // Behind the left half, in front of all.
        assert!(draw_grey(0.75) == expected([0; 4], [255; 4]), "{name}");
        let grey = [128, 128, 128, 255];
        assert!(draw_grey(0.25) == expected(grey, [255; 4]), "{name}");
        let depths = images.depths(&device);
        assert!(
            depths
                .chunks(50)
                .all(|row| row[..20] == [0.5; 20] && row[20..] == [1.0; 30])
        );
    }
}

/// A pass that only tests depth leaves it as new as it was.
#[test]
fn a_read_only_pass_keeps_the_newest_depths() {
    let device = device();
    let images = Images::new(&device, 50, 30);
    let [half, quarter] =
        [0.5, 0.25].map(|depth| depth_writer(&device, depth, TextureFormat::Rgba8Unorm));
    images.draw(&device, &[Draw::new(&half, 0..3)]);
    assert!(images.depths(&device) == [0.5; 1500]);
    images.draw(&device, &[Draw::new(&quarter, 0..3)]);
    device
        .render(&RenderPass {
            depth_stencil_attachment: Some(DepthStencilAttachment::read_only(&images.depth.view())),
            ..RenderPass::default()
        })
        .unwrap();
    assert!(images.depths(&device) == [0.25; 1500]);
}

#[test]
fn discarded_colors_are_zeros_wherever_they_are_read() {
    let white = [1.0; 4];
    for (name, device) in devices() {
        let format = TextureFormat::Rgba8Unorm;
        let image = texture(&device, [40, 21], format);
        let discard = || {
            let attachment = ColorAttachment {
                store: StoreOp::Discard,
                ..ColorAttachment::clear(&image.view(), white)
            };
            device
                .render(&RenderPass {
                    color_attachments: &[Some(attachment)],
                    ..RenderPass::default()
                })
                .unwrap();
        };
        let is_zero = |bytes: &[u8]| bytes.iter().all(|byte| *byte == 0);
        // By the host, at first and after it was white.
        discard();
        assert!(is_zero(&read(&device, &image, 0, 0)), "{name}");
        clear(&device, &image.view(), white);
        assert!(!is_zero(&read(&device, &image, 0, 0)), "{name}");
        discard();
        assert!(is_zero(&read(&device, &image, 0, 0)), "{name}");
        // By a shader.
        clear(&device, &image.view(), white);
        discard();
        let target = texture(&device, [40, 21], format);
        clear(&device, &target.view(), white);
        let (layout, pipeline) = pipeline_of(&device, Turned, FLAT, format);
        draw(
            &device,
            &pipeline,
            &bound(&device, &layout, &image.view()),
            &target.view(),
        );
        assert!(is_zero(&read(&device, &target, 0, 0)), "{name}");
        // By a pass that loads.
        clear(&device, &image.view(), white);
        discard();
        device
            .render(&RenderPass {
                color_attachments: &[Some(ColorAttachment::load(&image.view()))],
                ..RenderPass::default()
            })
            .unwrap();
        assert!(is_zero(&read(&device, &image, 0, 0)), "{name}");
    }
}

#[test]
fn depth_and_stencil_are_discarded_one_by_one() {
    let device = device();
    let format = TextureFormat::Depth32FloatStencil8;
    let image = texture(&device, [40, 21], format);
    let render = |depth: [StoreOp; 2]| {
        let [depth, stencil] = depth;
        device
            .render(&RenderPass {
                depth_stencil_attachment: Some(DepthStencilAttachment {
                    depth: AspectOperations::Write {
                        load: LoadOp::Clear(0.5),
                        store: depth,
                    },
                    stencil: AspectOperations::Write {
                        load: LoadOp::Clear(77),
                        store: stencil,
                    },
                    ..DepthStencilAttachment::load(&image.view())
                }),
                ..RenderPass::default()
            })
            .unwrap();
        let texels = read(&device, &image, 0, 0);
        let texels = texels.as_chunks::<8>().0;
        assert!(texels.iter().all(|texel| *texel == texels[0]));
        (f32s(&texels[0][..4])[0], texels[0][4])
    };
    use StoreOp::{Discard, Store};
    assert_eq!(render([Store, Store]), (0.5, 77));
    assert_eq!(render([Discard, Store]), (0.0, 77));
    assert_eq!(render([Store, Discard]), (0.5, 0));
    assert_eq!(render([Discard, Discard]), (0.0, 0));
}
