//! How vertex buffers lie.

use crate::format::VertexFormat;

/// Whether a vertex buffer advances by vertex or by instance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum VertexStepMode {
    /// By vertex index.
    #[default]
    Vertex,
    /// By instance index.
    Instance,
}

/// One attribute of a vertex buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct VertexAttribute {
    /// How it is stored.
    pub format: VertexFormat,
    /// Bytes from the start of an element.
    pub offset: u32,
    /// Which of the shader's attributes it feeds.
    pub shader_location: u32,
}

/// How the elements of a vertex buffer lie.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct VertexBufferLayout {
    /// Bytes from one element to the next, any number; 0 gives every vertex the same element. Default 0.
    pub array_stride: u32,
    /// By vertex or by instance. Default by vertex.
    pub step_mode: VertexStepMode,
    /// How many instances share an element, where it is by instance: instance i of a draw whose first one is f
    /// reads element f + (i − f) / rate, rounded down; 0: all read element f. Default 1. (Vulkan's
    /// `VK_EXT_vertex_attribute_divisor`.)
    pub instance_step_rate: u32,
    /// What an element holds.
    pub attributes: Vec<VertexAttribute>,
}

impl Default for VertexBufferLayout {
    fn default() -> Self {
        Self {
            array_stride: 0,
            step_mode: VertexStepMode::default(),
            instance_step_rate: 1,
            attributes: Vec::new(),
        }
    }
}

impl VertexBufferLayout {
    /// Attributes one after the other without gaps, feeding locations 0, 1, … by vertex.
    #[must_use]
    pub fn packed(formats: &[VertexFormat]) -> Self {
        let mut layout = Self::default();
        for (shader_location, &format) in (0u32..).zip(formats) {
            let offset = layout.array_stride;
            layout.attributes.push(VertexAttribute {
                format,
                offset,
                shader_location,
            });
            // A format has at most 16 bytes.
            layout.array_stride =
                offset.saturating_add(u32::try_from(format.size_bytes()).unwrap_or(16));
        }
        layout
    }
}
