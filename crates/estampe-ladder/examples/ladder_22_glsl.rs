//! Rung 22: shaders in GLSL, as courses of OpenGL write them, 400×400 each.
//!
//! Change a line of the fragment shader, `ladder_22_glsl.frag`, and run the rung again: a mistake
//! is answered with its line and a caret. The four pictures differ in uniforms alone.
//!
//! `cargo run --release --example ladder_22_glsl -- --model head.obj`

use estampe::state::VertexBufferLayout;
use estampe::{
    BindGroup, BindGroupDescriptor, BindingResource, BufferSlice, Draw, IndexFormat, Mat4,
    RenderPipelineDescriptor, ShaderModuleDescriptor, ShaderSource, TextureFormat, VertexFormat,
    bytes_of,
};
use estampe_ladder::{Course, LadderError, Picture, Screen};

const VERTEX: &str = include_str!("ladder_22_glsl.vert");
const FRAGMENT: &str = include_str!("ladder_22_glsl.frag");

/// Rung 12's projection as OpenGL has it: the camera is at the origin and looks along −z, and the
/// square −1..1 around the centre, at distance d = ‖eye − centre‖, fills the picture. The near
/// plane shows the part near/d of it.
fn projection() -> Mat4 {
    let [x, y, z] = Course::EYE;
    let d = (x * x + y * y + z * z).sqrt();
    let (near, far) = (d - 1.75, d + 1.75);
    let half = near / d;
    Mat4::frustum_gl(-half, half, -half, half, near, far)
}

/// The vertices as the shader reads them: position, normal and colour. The colour is (p + 1)/2: red
/// grows with x, green with y, blue with z.
fn vertices(course: &Course) -> Vec<f32> {
    let model = &course.model;
    let vertices = model.positions.iter().zip(&model.normals);
    let numbers = vertices.flat_map(|(position, normal)| {
        let color = position.map(|coordinate| (coordinate + 1.0) / 2.0);
        [*position, *normal, color].into_iter().flatten()
    });
    numbers.collect()
}

/// Above: ambient light; and diffuse light. Below: and highlights; the same on a squashed model,
/// whose normals the inverse transpose keeps right.
///
/// # Errors
/// If the shaders have mistakes, or the model does not fit the device.
pub fn draw(course: &Course) -> Result<Picture, LadderError> {
    let device = &course.device;
    let module = device.create_shader_module(&ShaderModuleDescriptor {
        label: Some("ladder_22_glsl"),
        ..ShaderModuleDescriptor::new(ShaderSource::Glsl {
            vertex: VERTEX,
            fragment: FRAGMENT,
        })
    })?;
    let program = device.create_program(&module.program())?;
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
        vertex_buffers: vec![VertexBufferLayout::packed(&[VertexFormat::Float32x3; 3])],
        ..RenderPipelineDescriptor::with_program(program)
    })?;

    // glUniform: values by name, which go to the shaders as one buffer.
    let uniforms = |model: Mat4, [ambient, diffuse, specular]: [f32; 3]| {
        let mut uniforms = module.uniforms("")?;
        uniforms.set("model", model)?;
        uniforms.set(
            "view",
            Mat4::look_at(Course::EYE, Course::CENTRE, Course::UP),
        )?;
        uniforms.set("projection", projection())?;
        uniforms.set("eye_position", Course::EYE)?;
        uniforms.set("light_position", [-1.0_f32, 2.0, 4.0])?;
        uniforms.set("light_color", [1.0_f32; 3])?;
        uniforms.set("a_ambient", ambient)?;
        uniforms.set("a_diffuse", diffuse)?;
        uniforms.set("a_specular", specular)?;
        let buffer = device.create_buffer_with_contents(uniforms.bytes())?;
        Ok::<BindGroup, LadderError>(device.create_bind_group(&BindGroupDescriptor {
            label: None,
            layout: &pipeline.descriptor().bind_group_layouts[0],
            entries: &[(0, BindingResource::Buffer(buffer.slice(..)))],
        })?)
    };

    let indices = course.model.faces.as_flattened();
    let buffer = |bytes: &[u8]| -> Result<BufferSlice, LadderError> {
        Ok((&device.create_buffer_with_contents(bytes)?).into())
    };
    let (vertices, index_buffer) = (
        buffer(bytes_of(&vertices(course)))?,
        buffer(bytes_of(indices))?,
    );
    // OpenGL's depth: the nearest is 0, the farthest 1.
    let screen = Screen::with_depth(course, [400, 400], TextureFormat::Depth32Float, 1.0)?;
    let panel = |model, light| {
        screen.draw(&[Draw {
            vertex_buffers: std::slice::from_ref(&vertices),
            index_buffer: Some((&index_buffer, IndexFormat::Uint32)),
            bind_groups: &[uniforms(model, light)?],
            ..Draw::new(
                &pipeline,
                0..u32::try_from(indices.len()).unwrap_or(u32::MAX),
            )
        }])
    };
    let squashed = Mat4::scale([1.0, 0.5, 1.0]);
    let panels = [
        panel(Mat4::IDENTITY, [0.25, 0.0, 0.0])?,
        panel(Mat4::IDENTITY, [0.25, 0.7, 0.0])?,
        panel(Mat4::IDENTITY, [0.25, 0.7, 0.5])?,
        panel(squashed, [0.25, 0.7, 0.5])?,
    ];
    Ok(Picture::in_columns(2, &panels))
}

fn main() -> std::process::ExitCode {
    estampe_ladder::run(22, draw)
}
