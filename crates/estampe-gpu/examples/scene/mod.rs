//! Shared by the examples: solids, a camera, a screen of four samples, and the picture's file.

#![expect(dead_code, reason = "each example uses a part")]

pub(crate) mod bezier;
#[cfg(test)]
pub(crate) mod kept;
pub(crate) mod page;

use estampe::state::{BlendState, ColorTargetState, MultisampleState, VertexBufferLayout};
use estampe::{
    BindGroup, BindGroupDescriptor, BindGroupLayout, BindGroupLayoutEntry, BindingResource,
    BindingType, BufferBindingType, BufferSlice, ColorAttachment, DepthStencilAttachment, Device,
    Draw, FragmentIn, FragmentOut, IndexFormat, Int, Mat4, Operand, Real, RenderPass,
    RenderPipeline, RenderPipelineDescriptor, SampleType, Sampler, Shader, Texture,
    TextureDescriptor, TextureFormat, TextureView, Vec2, Vec3, Vec4, VertexFormat, VertexIn,
    VertexOut, maths, vec4,
};
use std::error::Error;

/// A result whose errors are all kinds.
pub(crate) type Outcome<T> = Result<T, Box<dyn Error>>;

/// Width and height of the pictures in pixels.
pub(crate) const SIZE: [u32; 2] = [320, 240];

/// The direction of the sun.
pub(crate) const TOWARDS_SUN: [f32; 3] = [-0.6, 0.68, 0.42];

/// Draws the picture of an example and writes it to the path on the command line, or to
/// `NAME.png`.
pub(crate) fn write(name: &str, picture: fn(&Device) -> Outcome<Texture>) -> Outcome<()> {
    let device = Device::new(&estampe::DeviceDescriptor::default())?;
    let path = std::env::args().nth(1).unwrap_or(format!("{name}.png"));
    Ok(device.write_png(&picture(&device)?, path)?)
}

/// Clip space from world space: a camera in the picture's proportions, at `eye`.
pub(crate) fn camera(eye: [f32; 3], target: [f32; 3]) -> Mat4 {
    let [width, height] = SIZE.map(|side| side as f32);
    Mat4::perspective(0.8, width / height, 0.1, 50.0) * Mat4::look_at(eye, target, [0.0, 1.0, 0.0])
}

/// Clip space of a face of the cube map at `eye`. Faces are seen from inside and stored as from
/// outside, hence the mirrored x.
pub(crate) fn clip_from_cube_face(eye: [f32; 3], face: usize) -> Mat4 {
    let mut forward = [0.0; 3];
    forward[face / 2] = if face.is_multiple_of(2) { 1.0 } else { -1.0 };
    let up = if face / 2 == 1 {
        [0.0, 0.0, -forward[1]]
    } else {
        [0.0, 1.0, 0.0]
    };
    Mat4::scale([-1.0, 1.0, 1.0])
        * Mat4::perspective(std::f32::consts::FRAC_PI_2, 1.0, 0.1, 100.0)
        * Mat4::look_along(eye, forward, up)
}

/// A uniform buffer, as a bind group layout names it.
pub(crate) const UNIFORMS: BindingType = BindingType::Buffer {
    ty: BufferBindingType::Uniform,
    has_dynamic_offset: false,
    min_binding_size: 0,
};

/// A bind group of these resources, and its layout: binding 0, 1, …
pub(crate) fn bind(
    device: &Device,
    resources: &[(BindingType, BindingResource)],
) -> Outcome<(BindGroupLayout, BindGroup)> {
    let numbered = || (0..).zip(resources);
    let entries = numbered().map(|(binding, (ty, _))| BindGroupLayoutEntry { binding, ty: *ty });
    let layout = device.create_bind_group_layout(&entries.collect::<Vec<_>>())?;
    let entries = numbered().map(|(binding, (_, resource))| (binding, resource.clone()));
    let group = device.create_bind_group(&BindGroupDescriptor {
        label: None,
        layout: &layout,
        entries: &entries.collect::<Vec<_>>(),
    })?;
    Ok((layout, group))
}

/// A bind group of one uniform buffer, and its layout.
pub(crate) fn bind_numbers(
    device: &Device,
    numbers: &[f32],
) -> Outcome<(BindGroupLayout, BindGroup)> {
    let buffer = device.create_buffer_with_contents(estampe::bytes_of(numbers))?;
    bind(
        device,
        &[(UNIFORMS, BindingResource::Buffer((&buffer).into()))],
    )
}

/// A view with its sampler, for [`bind`].
pub(crate) fn sampled(view: &TextureView, sampler: &Sampler) -> (BindingType, BindingResource) {
    let kind = BindingType::SampledTexture {
        sample_type: SampleType::Float,
        view_dimension: view.dimension(),
    };
    let resource = BindingResource::SampledTexture(view.clone(), sampler.clone());
    (kind, resource)
}

/// Runs the fragment shader for every pixel of an attachment. The vertices are [`covering`].
pub(crate) fn fill(
    device: &Device,
    shader: impl Shader,
    bound: &[&(BindGroupLayout, BindGroup)],
    into: ColorAttachment,
    blend: Option<BlendState>,
) -> Outcome<()> {
    let target = ColorTargetState {
        blend,
        ..into.view.format().into()
    };
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
        bind_group_layouts: bound.iter().map(|(layout, _)| layout.clone()).collect(),
        depth_stencil: None,
        targets: vec![Some(target)],
        ..RenderPipelineDescriptor::new(shader)
    })?;
    let groups: Vec<_> = bound.iter().map(|(_, group)| group.clone()).collect();
    device.render(&RenderPass {
        color_attachments: &[Some(into)],
        draws: &[Draw {
            bind_groups: &groups,
            ..Draw::new(&pipeline, 0..3)
        }],
        ..RenderPass::default()
    })?;
    Ok(())
}

/// A texture of the pictures' size.
pub(crate) fn target(
    device: &Device,
    format: TextureFormat,
    sample_count: u32,
) -> Outcome<Texture> {
    Ok(device.create_texture(&TextureDescriptor {
        sample_count,
        ..TextureDescriptor::new_2d(SIZE[0], SIZE[1], format)
    })?)
}

estampe::shader! {
    /// The position of vertex 0, 1 or 2 of a triangle that covers the picture.
    pub(crate) fn covering<R: Real>(input: VertexIn<'_, R>) -> Vec4<R> {
        let index = input.vertex_index;
        let x = (index & index.splat(1)).to_real() * 4.0 - 1.0;
        let y = (index >> 1).to_real() * 4.0 - 1.0;
        vec4(x, y, 0.0, 1.0)
    }

    /// The light of a sun and of the sky on a surface whose unit normal this is.
    pub(crate) fn daylight<R: Real>(normal: Vec3<R>, lit: impl Operand<R>) -> Vec3<R> {
        let sun = normal.dot_uniform(TOWARDS_SUN).saturate() * lit.operand(normal.x);
        let sky = normal.y * 0.1 + 0.14;
        sun * Vec3::new(1.0, 0.93, 0.8) + sky * Vec3::new(0.7, 0.85, 1.0)
    }
}

/// Attachments with four samples per pixel, and the picture into which a pass resolves them.
pub(crate) struct Screen {
    pub(crate) picture: Texture,
    colors: TextureView,
    depths: TextureView,
}

impl Screen {
    pub(crate) fn new(device: &Device) -> Outcome<Self> {
        Self::of_format(device, TextureFormat::Rgba8UnormSrgb)
    }

    pub(crate) fn of_format(device: &Device, format: TextureFormat) -> Outcome<Self> {
        Ok(Self {
            picture: target(device, format, 1)?,
            colors: target(device, format, 4)?.view(),
            depths: target(device, TextureFormat::Depth32Float, 4)?.view(),
        })
    }

    /// The colour attachment, cleared to a linear colour.
    pub(crate) fn colors(&self, [r, g, b]: [f64; 3]) -> [Option<ColorAttachment>; 1] {
        [Some(ColorAttachment {
            resolve_target: Some(self.picture.view()),
            ..ColorAttachment::clear(&self.colors, [r, g, b, 1.0])
        })]
    }

    /// The depth attachment, cleared to the far plane.
    pub(crate) fn depths(&self) -> Option<DepthStencilAttachment> {
        Some(DepthStencilAttachment::clear(&self.depths, 1.0))
    }

    /// A pipeline for [`Solid`]s on the screen.
    pub(crate) fn pipeline(&self, shader: impl Shader) -> RenderPipelineDescriptor {
        RenderPipelineDescriptor {
            vertex_buffers: vec![Solid::layout()],
            multisample: MultisampleState::new(4),
            targets: vec![Some(self.colors.format().into())],
            ..RenderPipelineDescriptor::new(shader)
        }
    }
}

estampe::attributes! {
    /// A vertex of a [`Solid`].
    pub(crate) struct Corner<R> {
        pub(crate) position: Vec3<R>,
        pub(crate) normal: Vec3<R>,
        pub(crate) uv: Vec2<R>,
    }
}

/// A triangle mesh on the device: position, normal and texture coordinates of each vertex.
pub(crate) struct Solid {
    vertices: [BufferSlice; 1],
    indices: BufferSlice,
    count: u32,
}

type Vertex = [f32; 8];

impl Solid {
    /// The layout of the vertices, as a pipeline describes it.
    pub(crate) fn layout() -> VertexBufferLayout {
        use VertexFormat::{Float32x2, Float32x3};
        VertexBufferLayout::packed(&[Float32x3, Float32x3, Float32x2])
    }

    /// A draw of the solid.
    pub(crate) fn draw<'a>(&'a self, pipeline: &'a RenderPipeline) -> Draw<'a> {
        Draw {
            vertex_buffers: &self.vertices,
            index_buffer: Some((&self.indices, IndexFormat::Uint32)),
            ..Draw::new(pipeline, 0..self.count)
        }
    }

    /// The cube −1..1, each side with the texture coordinates 0..1.
    pub(crate) fn cube(device: &Device) -> Outcome<Self> {
        let (x, y, z) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
        let back = |[x, y, z]: [f32; 3]| [-x, -y, -z];
        let (mut vertices, mut indices) = (Vec::new(), Vec::new());
        for (normal, right, up) in [
            (x, back(z), y),
            (back(x), z, y),
            (y, x, back(z)),
            (back(y), x, z),
            (z, x, y),
            (back(z), back(x), y),
        ] {
            grid(&mut vertices, &mut indices, [1, 1], |u, v| {
                let (a, b) = (u * 2.0 - 1.0, 1.0 - v * 2.0);
                let at = [0, 1, 2].map(|k| normal[k] + right[k] * a + up[k] * b);
                vertex(at, normal, [u, v])
            });
        }
        Self::new(device, &vertices, indices)
    }

    /// The sphere of radius 1, with the poles on the y axis.
    pub(crate) fn sphere(device: &Device) -> Outcome<Self> {
        let (mut vertices, mut indices) = (Vec::new(), Vec::new());
        let (turn, half) = (std::f32::consts::TAU, std::f32::consts::PI);
        grid(&mut vertices, &mut indices, [64, 32], |u, v| {
            let radius = maths::sin(v * half);
            let (x, z) = (maths::sin(u * turn) * radius, maths::cos(u * turn) * radius);
            let at = [x, maths::cos(v * half), z];
            vertex(at, at, [u, v])
        });
        Self::new(device, &vertices, indices)
    }

    /// The square −side..side at y = 0, seen from above, with the texture coordinates 0..side.
    pub(crate) fn plane(device: &Device, side: f32) -> Outcome<Self> {
        let (mut vertices, mut indices) = (Vec::new(), Vec::new());
        grid(&mut vertices, &mut indices, [1, 1], |u, v| {
            let at = [(u * 2.0 - 1.0) * side, 0.0, (v * 2.0 - 1.0) * side];
            vertex(at, [0.0, 1.0, 0.0], [u * side, v * side])
        });
        Self::new(device, &vertices, indices)
    }

    /// A mesh of any numbers for each vertex.
    pub(crate) fn new<const N: usize>(
        device: &Device,
        vertices: &[[f32; N]],
        indices: Vec<u32>,
    ) -> Outcome<Self> {
        let vertices = estampe::bytes_of(vertices.as_flattened());
        let vertices = device.create_buffer_with_contents(vertices)?;
        let count = u32::try_from(indices.len())?;
        Ok(Self {
            vertices: [(&vertices).into()],
            indices: (&device.create_buffer_of_words(indices)?).into(),
            count,
        })
    }
}

fn vertex([x, y, z]: [f32; 3], [nx, ny, nz]: [f32; 3], [u, v]: [f32; 2]) -> Vertex {
    [x, y, z, nx, ny, nz, u, v]
}

/// Solids, each with a bind group: its matrix at byte 0, its colour at byte 64.
pub(crate) struct Objects<'s> {
    pub(crate) layout: BindGroupLayout,
    solids: Vec<&'s Solid>,
    groups: Vec<Vec<BindGroup>>,
}

impl<'s> Objects<'s> {
    pub(crate) fn new(device: &Device, list: &[(&'s Solid, Mat4, [f32; 4])]) -> Outcome<Self> {
        let bind = |(_, matrix, color): &(_, Mat4, [f32; 4])| {
            bind_numbers(device, &[matrix.0.as_flattened(), color].concat())
        };
        let bound = list.iter().map(bind).collect::<Outcome<Vec<_>>>()?;
        Ok(Self {
            layout: bound[0].0.clone(),
            solids: list.iter().map(|(solid, ..)| *solid).collect(),
            groups: bound.into_iter().map(|(_, group)| vec![group]).collect(),
        })
    }

    /// Binds a group as group 1 of every draw.
    pub(crate) fn bind(mut self, group: &BindGroup) -> Self {
        for groups in &mut self.groups {
            groups.push(group.clone());
        }
        self
    }

    /// A draw of each object.
    pub(crate) fn draws<'a>(&'a self, pipeline: &'a RenderPipeline) -> Vec<Draw<'a>> {
        let objects = self.solids.iter().zip(&self.groups);
        let draws = objects.map(|(solid, bind_groups)| Draw {
            bind_groups,
            ..solid.draw(pipeline)
        });
        draws.collect()
    }
}

/// Draws [`Objects`] in daylight. The fourth number of a colour is light that the object gives off.
pub(crate) struct Lit {
    pub(crate) clip_from_world: Mat4,
}

estampe::shader! {
    impl Shader for Lit {
        type Attributes<R: Real> = Corner<R>;
        type Varyings<R: Real> = Vec3<R>; // normal

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, a: Corner<R>) -> VertexOut<R, Vec3<R>> {
            let world_from_object = input.bindings.mat4(0, 0, 0);
            let position_world = world_from_object.transform_point(a.position);
            let normal = world_from_object.transform_vector(a.normal);
            VertexOut::new(self.clip_from_world * position_world, normal)
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, normal: Vec3<R>) -> FragmentOut<R> {
            let [r, g, b, glow] = input.bindings.f32s(0, 0, 64);
            let light = daylight(normal.normalize(), 1.0) + glow;
            FragmentOut::color((light * Vec3::new(r, g, b)).point())
        }
    }
}

/// Adds the vertices at (u, v) in 0..1, and two triangles for each cell: counter-clockwise where u
/// goes right and v goes down.
fn grid(
    vertices: &mut Vec<Vertex>,
    indices: &mut Vec<u32>,
    [columns, rows]: [u16; 2],
    vertex: impl Fn(f32, f32) -> Vertex,
) {
    let first = u32::try_from(vertices.len()).expect("small solids");
    for row in 0..=rows {
        for column in 0..=columns {
            let part = |at: u16, of: u16| f32::from(at) / f32::from(of);
            vertices.push(vertex(part(column, columns), part(row, rows)));
        }
    }
    let stride = u32::from(columns) + 1;
    for row in 0..u32::from(rows) {
        for column in 0..u32::from(columns) {
            let corner = first + row * stride + column;
            let below = corner + stride;
            indices.extend([corner, below, corner + 1, corner + 1, below, below + 1]);
        }
    }
}
