//! The screen of the rungs that use the pipeline: a picture, its depth buffer, the model's faces.

use crate::{Color, Course, LadderError, Model, Picture};
use estampe::state::{CompareFunction, DepthState, VertexBufferLayout};
use estampe::{
    BufferSlice, ColorAttachment, DepthStencilAttachment, Device, Draw, RenderPass, RenderPipeline,
    RenderPipelineDescriptor, Shader, Texture, TextureDescriptor, TextureFormat, Vec2, Vec3,
    VertexFormat, bytes_of,
};
use glam::{DMat4, DVec4};

estampe::attributes! {
    /// A corner of a face, as a vertex shader reads it.
    pub struct Corner<R> {
        /// The position in object space.
        pub position: Vec3<R>,
        /// The unit normal of the vertex.
        pub normal: Vec3<R>,
        /// The unit normal of the face, the same at its three corners.
        pub face_normal: Vec3<R>,
        /// The texture coordinates, v down.
        pub uv: Vec2<R>,
    }
}

/// Faces in a vertex buffer, three [`Corner`]s each.
#[derive(Debug, Clone)]
pub struct Faces {
    vertices: [BufferSlice; 1],
    count: u32,
}

impl Faces {
    /// The faces of a model.
    ///
    /// # Errors
    /// If they do not fit into a buffer.
    pub fn new(device: &Device, model: &Model) -> Result<Self, LadderError> {
        let mut numbers = Vec::with_capacity(model.faces.len() * 33);
        for (face, corners) in model.faces.iter().zip(model.triangles()) {
            let face_normal = Model::face_normal(corners);
            for (index, position) in face.iter().zip(corners) {
                let index = *index as usize;
                numbers.extend(position);
                numbers.extend(model.normals[index]);
                numbers.extend(face_normal);
                numbers.extend(model.uvs[index]);
            }
        }
        let vertices = device.create_buffer_with_contents(bytes_of(&numbers))?;
        let count = u32::try_from(model.faces.len() * 3).unwrap_or(u32::MAX);
        Ok(Self {
            vertices: [(&vertices).into()],
            count,
        })
    }

    /// A draw of all faces.
    #[must_use]
    pub fn draw<'a>(&'a self, pipeline: &'a RenderPipeline) -> Draw<'a> {
        Draw {
            vertex_buffers: &self.vertices,
            ..Draw::new(pipeline, 0..self.count)
        }
    }
}

/// A picture with its depth buffer.
///
/// By default the nearest depth is 1 and the farthest 0, as the course's z grows towards the eye:
/// draws compare *greater*, and the buffer is cleared to 0, its least value. A stencil of 0 comes
/// with it.
#[derive(Debug)]
pub struct Screen<'c> {
    device: &'c Device,
    color: Texture,
    depth: Texture,
    /// The depth that the buffer is cleared to: 0, or 1 where lesser depths are nearer.
    farthest: f32,
}

impl<'c> Screen<'c> {
    /// A screen of `width` times `height` pixels.
    ///
    /// # Errors
    /// If the textures do not fit the device's limits.
    pub fn new(course: &'c Course, width: u32, height: u32) -> Result<Self, LadderError> {
        Self::with_depth(
            course,
            [width, height],
            TextureFormat::Depth32FloatStencil8,
            0.0,
        )
    }

    /// A screen with a depth format, whose farthest depth is 0 (nearer is greater) or 1 (nearer is
    /// less).
    ///
    /// # Errors
    /// If the textures do not fit the device's limits, or the format is none of depth.
    pub fn with_depth(
        course: &'c Course,
        [width, height]: [u32; 2],
        format: TextureFormat,
        farthest: f32,
    ) -> Result<Self, LadderError> {
        let device = &course.device;
        let texture = |format| {
            let descriptor = TextureDescriptor::new_2d(width, height, format);
            device.create_texture(&descriptor)
        };
        Ok(Self {
            device,
            color: texture(TextureFormat::Rgba8Unorm)?,
            depth: texture(format)?,
            farthest,
        })
    }

    /// A pipeline for [`Faces`] on the screen, with the depth test.
    #[must_use]
    pub fn pipeline(&self, shader: impl Shader) -> RenderPipelineDescriptor {
        use VertexFormat::{Float32x2, Float32x3};
        let formats = [Float32x3, Float32x3, Float32x3, Float32x2];
        let depth = DepthState {
            write_enabled: true,
            compare: if self.farthest > 0.0 {
                CompareFunction::Less
            } else {
                CompareFunction::Greater
            },
        };
        RenderPipelineDescriptor {
            vertex_buffers: vec![VertexBufferLayout::packed(&formats)],
            depth_stencil: Some(depth.into()),
            ..RenderPipelineDescriptor::new(shader)
        }
    }

    /// Clip space with the near plane at depth 1 and the far plane at 0, from clip space with 0 and
    /// 1: z becomes w − z.
    pub const REVERSED: DMat4 = DMat4::from_cols(
        DVec4::X,
        DVec4::Y,
        DVec4::new(0.0, 0.0, -1.0, 0.0),
        DVec4::new(0.0, 0.0, 1.0, 1.0),
    );

    /// Clears the screen to black, and draws faces by a shader.
    ///
    /// # Errors
    /// If the shader does not fit the pipeline.
    pub fn show(&self, shader: impl Shader, faces: &Faces) -> Result<Picture, LadderError> {
        let pipeline = self.device.create_render_pipeline(&self.pipeline(shader))?;
        self.draw(&[faces.draw(&pipeline)])
    }

    /// Clears the screen to black, and draws.
    ///
    /// # Errors
    /// If a draw does not fit the screen or its pipeline.
    pub fn draw(&self, draws: &[Draw<'_>]) -> Result<Picture, LadderError> {
        self.draw_over(Picture::BLACK, draws)
    }

    /// Clears the screen to a colour, and draws.
    ///
    /// # Errors
    /// If a draw does not fit the screen or its pipeline.
    pub fn draw_over(&self, background: Color, draws: &[Draw<'_>]) -> Result<Picture, LadderError> {
        let [r, g, b] = background.map(|code| f64::from(code) / 255.0);
        let cleared = ColorAttachment::clear(&self.color.view(), [r, g, b, 1.0]);
        let depth = DepthStencilAttachment::clear(&self.depth.view(), self.farthest);
        self.device.render(&RenderPass {
            color_attachments: &[Some(cleared)],
            depth_stencil_attachment: Some(depth),
            draws,
            ..RenderPass::default()
        })?;
        Picture::of_texture(self.device, &self.color)
    }
}
