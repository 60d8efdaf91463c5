//! A mesh's attributes, also those of the caller's own, reach a shader by their names.

use estampe::state::{PrimitiveTopology, VertexBufferLayout};
use estampe::{
    ColorAttachment, Device, Draw, FragmentIn, FragmentOut, IndexFormat, RenderPass,
    RenderPipelineDescriptor, TextureDescriptor, TextureFormat, Vec2, Vec3, Vec4, VertexFormat,
    VertexIn, VertexOut,
};
use estampe_scene::{Mesh, MeshAttribute};

estampe::attributes! {
    struct Vertex<R> {
        position: Vec3<R>,
        normal: Vec3<R>,
        uv: Vec2<R>,
        color: Vec4<R>,
        tangent: Vec4<R>,
        temperature: R,
    }
}

struct Sums;

estampe::shader! {
    impl Shader for Sums {
        type Attributes<R: Real> = Vertex<R>;
        type Varyings<R: Real> = Vec4<R>;

        fn vertex<R: Real>(&self, _: VertexIn<'_, R>, v: Vertex<R>) -> VertexOut<R, Vec4<R>> {
            let sums = Vec4::new(
                v.normal.z + v.uv.x * 10.0,
                v.color.y + v.color.w * 10.0,
                v.tangent.x + v.tangent.w * 10.0,
                v.temperature,
            );
            VertexOut::new(v.position.point(), sums)
        }

        fn fragment<R: Real>(&self, _: FragmentIn<'_, R>, sums: Vec4<R>) -> FragmentOut<R> {
            FragmentOut::color(sums)
        }
    }
}

/// A square whose temperature grows from the left to the right.
fn square() -> Mesh {
    let positions = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    Mesh {
        positions: positions.map(|[x, y]| [x, y, 0.5].into()).to_vec(),
        normals: vec![[0.0, 0.0, 1.0].into(); 4],
        uvs: vec![[0.25, 0.0].into(); 4],
        colors: vec![[0.0, 0.5, 0.0, 1.0]; 4],
        attributes: vec![
            MeshAttribute {
                name: "tangent".to_owned(),
                components: 4,
                values: [1.0, 0.0, 0.0, -1.0].repeat(4),
            },
            MeshAttribute {
                name: "temperature".to_owned(),
                components: 1,
                values: vec![0.0, 80.0, 80.0, 0.0],
            },
        ],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    }
}

/// Rows: M1.
#[test]
fn the_attributes_of_a_mesh_reach_a_shader_by_name() {
    let mesh = square();
    let own = |name| &mesh.attribute(name).expect("it is there").values;
    let device = Device::new(&Default::default()).unwrap();
    let buffer = |numbers: &[f32]| {
        let bytes = estampe::bytes_of(numbers);
        device.create_buffer_with_contents(bytes).unwrap()
    };
    let flat =
        |rows: &[glam::Vec3]| -> Vec<f32> { rows.iter().flat_map(|v| v.to_array()).collect() };
    let uvs: Vec<f32> = mesh.uvs.iter().flat_map(|v| v.to_array()).collect();
    let streams = [
        (VertexFormat::Float32x3, buffer(&flat(&mesh.positions))),
        (VertexFormat::Float32x3, buffer(&flat(&mesh.normals))),
        (VertexFormat::Float32x2, buffer(&uvs)),
        (VertexFormat::Float32x4, buffer(&mesh.colors.concat())),
        (VertexFormat::Float32x4, buffer(own("tangent"))),
        (VertexFormat::Float32, buffer(own("temperature"))),
    ];
    let layouts = (0..).zip(&streams);
    let layouts = layouts.map(|(at, (format, _))| VertexBufferLayout::packed_from(at, &[*format]));
    let mut descriptor = RenderPipelineDescriptor::new(Sums);
    descriptor.vertex_buffers = layouts.collect();
    descriptor.primitive.topology = PrimitiveTopology::TriangleList;
    descriptor.depth_stencil = None;
    descriptor.targets = vec![Some(TextureFormat::Rgba32Float.into())];
    let pipeline = device.create_render_pipeline(&descriptor).unwrap();
    let image = TextureDescriptor::new_2d(8, 2, TextureFormat::Rgba32Float);
    let image = device.create_texture(&image).unwrap();
    let indices = device
        .create_buffer_with_contents(estampe::bytes_of(&mesh.triangles))
        .unwrap();
    let vertex_buffers: Vec<_> = streams.iter().map(|(_, buffer)| buffer.slice(..)).collect();
    device
        .render(&RenderPass {
            color_attachments: &[Some(ColorAttachment::clear(&image.view(), [0.0; 4]))],
            draws: &[Draw {
                vertex_buffers: &vertex_buffers,
                index_buffer: Some((&indices.slice(..), IndexFormat::Uint32)),
                ..Draw::new(&pipeline, 0..6)
            }],
            ..RenderPass::default()
        })
        .unwrap();
    let bytes = device.read_texture(&image).unwrap();
    let numbers: Vec<f32> = bytes
        .as_chunks::<4>()
        .0
        .iter()
        .map(|word| f32::from_le_bytes(*word))
        .collect();
    for (at, texel) in numbers.as_chunks::<4>().0.iter().enumerate() {
        let column = f32::from(u8::try_from(at % 8).unwrap());
        assert_eq!(texel[..3], [3.5, 10.5, -9.0], "pixel {at}");
        let temperature = 10.0 * (column + 0.5);
        assert!((texel[3] - temperature).abs() < 1e-4, "{texel:?}");
    }
}

/// Rows: M1.
#[test]
fn attributes_of_the_wrong_length_are_not_found() {
    let mut mesh = square();
    assert!(mesh.attribute("tangent").is_some());
    assert_eq!(mesh.attribute("bitangent"), None);
    mesh.attributes[1].values.pop();
    assert_eq!(mesh.attribute("temperature"), None);
    for components in [0, 3, 5, usize::MAX] {
        mesh.attributes[0].components = components;
        assert_eq!(mesh.attribute("tangent"), None, "{components}");
    }
}
