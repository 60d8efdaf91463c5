//! Bind groups: every kind of resource in one group, several groups, and textures that a shader
//! stores to and that the next pass samples.

use crate::support::{covering, device, devices, noise, texture};
use estampe::{
    BindGroup, BindGroupDescriptor, BindGroupLayout, BindGroupLayoutEntry, BindingResource,
    BindingType, BufferBindingType, ColorAttachment, Coordinates, Device, Draw, Extent3d,
    FragmentIn, FragmentOut, Lod, RenderPass, RenderPipelineDescriptor, SampleType,
    SamplerDescriptor, TexelCopyLayout, TextureBindings, TextureCopy, TextureDescriptor,
    TextureFormat, TextureUsages, TextureViewDescriptor, Vec2, Vec4, VertexIn, VertexOut,
    ViewDimension, bytes_of,
};
use estampe::{storage_load, storage_store};

fn layout(device: &Device, entries: &[(u32, BindingType)]) -> BindGroupLayout {
    let entries = entries
        .iter()
        .map(|&(binding, ty)| BindGroupLayoutEntry { binding, ty });
    device
        .create_bind_group_layout(&entries.collect::<Vec<_>>())
        .unwrap()
}

fn group(
    device: &Device,
    layout: &BindGroupLayout,
    entries: &[(u32, BindingResource)],
) -> BindGroup {
    let descriptor = BindGroupDescriptor {
        label: None,
        layout,
        entries,
    };
    device.create_bind_group(&descriptor).unwrap()
}

const UNIFORM: BindingType = BindingType::Buffer {
    ty: BufferBindingType::Uniform,
    has_dynamic_offset: false,
    min_binding_size: 4,
};

/// Red from a uniform of group 1, green from a texture of group 0, blue from a texture with its
/// sampler of group 3, alpha from a storage texture of group 1.
struct Gathered;

estampe::shader! {
    impl Shader for Gathered {
        type Attributes<R: Real> = ();
        type Varyings<R: Real> = ();
        // A storage texture is bound, though it is only read.
        const STORES: bool = true;

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, (): ()) -> VertexOut<R, ()> {
            let at: Vec2<R> = covering(&input);
            VertexOut::new(Vec4::new(at.x, at.y, input.zero, input.real(1.0)), ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
            let bindings = input.bindings;
            let [red] = bindings.f32s::<1>(1, 2, 0);
            let zero = input.zero.to_int();
            let green = bindings.texture(0, 7).fetch([zero; 3], zero, zero).y;
            let at = Coordinates::d2(Vec2::new(input.real(0.5), input.real(0.5)));
            let blue = bindings.sampled_texture(3, 0);
            let blue = blue.sample_with(at, Lod::Level(input.zero), [0; 3]).z;
            let alpha = match bindings.storage_texture(1, 9) {
                Some(texture) => storage_load(texture, [zero; 3]).w,
                None => input.zero,
            };
            FragmentOut::color(Vec4::new(input.real(red), green, blue, alpha))
        }
    }
}

#[test]
#[expect(clippy::too_many_lines, reason = "a list of cases")]
fn groups_and_bindings_are_found_by_number() {
    let format = TextureFormat::Rgba8Unorm;
    let (float, flat) = (SampleType::Float, ViewDimension::D2);
    for (name, device) in devices() {
        let texels = [[0, 51, 0, 0], [0, 0, 102, 0], [0, 0, 0, 153]];
        let [plain, sampled, stored] = texels.map(|texel| {
            let image = texture(&device, [1, 1], format);
            let layout = TexelCopyLayout::default();
            device
                .write_texture(&image, &texel, &layout, image.size())
                .unwrap();
            image.view()
        });
        let sampler = device
            .create_sampler(&SamplerDescriptor::default())
            .unwrap();
        let numbers = device
            .create_buffer_with_contents(bytes_of(&[0.0, 0.0, 0.8]))
            .unwrap();
        let layouts = [
            layout(
                &device,
                &[(
                    7,
                    BindingType::Texture {
                        sample_type: float,
                        view_dimension: flat,
                        multisampled: false,
                    },
                )],
            ),
            layout(
                &device,
                &[
                    (
                        9,
                        BindingType::StorageTexture {
                            format,
                            view_dimension: flat,
                        },
                    ),
                    (2, UNIFORM),
                ],
            ),
            layout(&device, &[]),
            layout(
                &device,
                &[(
                    0,
                    BindingType::SampledTexture {
                        sample_type: float,
                        view_dimension: flat,
                    },
                )],
            ),
        ];
        let groups = [
            group(
                &device,
                &layouts[0],
                &[(7, BindingResource::Texture(plain))],
            ),
            group(
                &device,
                &layouts[1],
                &[
                    (2, BindingResource::Buffer(numbers.slice(8..))),
                    (9, BindingResource::Texture(stored)),
                ],
            ),
            group(&device, &layouts[2], &[]),
            group(
                &device,
                &layouts[3],
                &[(0, BindingResource::SampledTexture(sampled, sampler))],
            ),
        ];
        let pipeline = |layouts: &[BindGroupLayout]| {
            let descriptor = RenderPipelineDescriptor {
                bind_group_layouts: layouts.to_vec(),
                depth_stencil: None,
                ..RenderPipelineDescriptor::new(Gathered)
            };
            device.create_render_pipeline(&descriptor).unwrap()
        };
        let target = texture(&device, [18, 5], format);
        let seen = |pipeline, groups: &[BindGroup]| {
            device
                .render(&RenderPass {
                    color_attachments: &[Some(ColorAttachment::clear(&target.view(), [1.0; 4]))],
                    draws: &[Draw {
                        bind_groups: groups,
                        ..Draw::new(pipeline, 0..3)
                    }],
                    ..RenderPass::default()
                })
                .unwrap();
            device.read_texture(&target).unwrap()
        };
        let all = pipeline(&layouts);
        assert_eq!(
            seen(&all, &groups),
            [204, 51, 102, 153].repeat(90),
            "{name}"
        );
        // Layouts with the same entries are compatible.
        let again = layout(
            &device,
            layouts[0]
                .entries()
                .iter()
                .map(|e| (e.binding, e.ty))
                .collect::<Vec<_>>()
                .as_slice(),
        );
        assert_eq!(again, layouts[0]);
        // Groups that the pipeline does not need may be bound; what is not bound is zeros.
        let none = pipeline(&[]);
        assert_eq!(
            seen(&none, &groups[..2]),
            [204, 51, 0, 153].repeat(90),
            "{name}"
        );
        assert_eq!(seen(&none, &[]), [0; 4].repeat(90), "{name}");
    }
}

/// Adds 1 to every texel of binding 0, and writes the old texel to the attachment.
struct Increment;

estampe::shader! {
    impl Shader for Increment {
        type Attributes<R: Real> = ();
        type Varyings<R: Real> = ();
        const READS_POSITION: bool = true;
        const STORES: bool = true;

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, (): ()) -> VertexOut<R, ()> {
            let at: Vec2<R> = covering(&input);
            VertexOut::new(Vec4::new(at.x, at.y, input.zero, input.real(1.0)), ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
            let [x, y] = [input.position.x, input.position.y].map(|at| at.floor().to_int());
            let at = [x, y, x.splat(1)];
            let Some(texture) = input.bindings.storage_texture(0, 0) else {
                return FragmentOut::color(Vec4::repeat(input.zero));
            };
            let old = storage_load(texture, at);
            let one = input.real(1.0 / 255.0);
            let new = Vec4::new(old.x + one, old.y + one, old.z + one, old.w + one);
            storage_store(texture, !input.is_helper, at, new);
            FragmentOut::color(old)
        }
    }
}

/// Level 1 of two layers is stored to; the other layer and the other levels stay.
#[test]
fn a_storage_texture_is_one_level_that_the_next_pass_reads() {
    for format in [TextureFormat::Rgba8Unorm, TextureFormat::Bgra8Unorm] {
        for (name, device) in devices() {
            let size = Extent3d {
                width: 40,
                height: 26,
                depth_or_array_layers: 2,
            };
            let image = device
                .create_texture(&TextureDescriptor {
                    size,
                    mip_level_count: 3,
                    ..TextureDescriptor::new_2d(1, 1, format)
                })
                .unwrap();
            let tight = TexelCopyLayout::default();
            let level = |mip_level| TextureCopy {
                mip_level,
                ..(&image).into()
            };
            let mut levels = Vec::new();
            for at in 0..3 {
                let size = image.level_size(at);
                let bytes: Vec<u8> = noise((size.width * size.height * 8) as usize, at)
                    .into_iter()
                    .map(|byte| byte / 2)
                    .collect();
                device
                    .write_texture(level(at), &bytes, &tight, size)
                    .unwrap();
                levels.push(bytes);
            }
            let view = image
                .create_view(&TextureViewDescriptor {
                    base_mip_level: 1,
                    mip_level_count: Some(1),
                    ..TextureViewDescriptor::default()
                })
                .unwrap();
            let ty = BindingType::StorageTexture {
                format,
                view_dimension: ViewDimension::D2Array,
            };
            let layout = layout(&device, &[(0, ty)]);
            let group = group(&device, &layout, &[(0, BindingResource::Texture(view))]);
            let pipeline = device
                .create_render_pipeline(&RenderPipelineDescriptor {
                    bind_group_layouts: vec![layout],
                    depth_stencil: None,
                    targets: vec![format.into()],
                    ..RenderPipelineDescriptor::new(Increment)
                })
                .unwrap();
            let target = texture(&device, [20, 13], format);
            for pass in 0..2 {
                device
                    .render(&RenderPass {
                        color_attachments: &[Some(ColorAttachment::clear(
                            &target.view(),
                            [0.0; 4],
                        ))],
                        draws: &[Draw {
                            bind_groups: std::slice::from_ref(&group),
                            ..Draw::new(&pipeline, 0..3)
                        }],
                        ..RenderPass::default()
                    })
                    .unwrap();
                let layer = levels[1].len() / 2;
                let seen = device.read_texture(&target).unwrap();
                assert!(
                    seen == levels[1][layer..],
                    "pass {pass}, {format:?}, {name}"
                );
                levels[1][layer..].iter_mut().for_each(|byte| *byte += 1);
                for at in 0..3 {
                    let mut bytes = vec![0; levels[at as usize].len()];
                    let size = image.level_size(at);
                    device
                        .read_texture_into(level(at), &mut bytes, &tight, size)
                        .unwrap();
                    assert!(
                        bytes == levels[at as usize],
                        "level {at}, {format:?}, {name}"
                    );
                }
            }
        }
    }
}

/// A bind group keeps what it names alive, and sees later writes.
#[test]
fn a_group_outlives_the_handles_of_its_resources() {
    let device = device();
    let layout = layout(&device, &[(2, UNIFORM)]);
    let buffer = device
        .create_buffer_with_contents(bytes_of(&[0.2]))
        .unwrap();
    let one = group(
        &device,
        &layout,
        &[(2, BindingResource::Buffer((&buffer).into()))],
    );
    let empty = self::layout(&device, &[]);
    let first = group(&device, &empty, &[]);
    let pipeline = device
        .create_render_pipeline(&RenderPipelineDescriptor {
            bind_group_layouts: vec![empty, layout],
            depth_stencil: None,
            ..RenderPipelineDescriptor::new(Gathered)
        })
        .unwrap();
    let target = device
        .create_texture(&TextureDescriptor {
            usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC,
            ..TextureDescriptor::new_2d(1, 1, TextureFormat::Rgba8Unorm)
        })
        .unwrap();
    let seen = || {
        device
            .render(&RenderPass {
                color_attachments: &[Some(ColorAttachment::clear(&target.view(), [1.0; 4]))],
                draws: &[Draw {
                    bind_groups: &[first.clone(), one.clone()],
                    ..Draw::new(&pipeline, 0..3)
                }],
                ..RenderPass::default()
            })
            .unwrap();
        device.read_texture(&target).unwrap()[0]
    };
    assert_eq!(seen(), 51);
    buffer.write(0, bytes_of(&[0.4])).unwrap();
    drop(buffer);
    assert_eq!(seen(), 102);
}
