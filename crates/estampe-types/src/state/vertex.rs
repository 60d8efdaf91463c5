//! Layout of vertex buffers.

use crate::format::VertexFormat;

/// Index by which a vertex buffer advances.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum VertexStepMode {
    /// The vertex index.
    #[default]
    Vertex,
    /// The instance index.
    Instance,
}

/// One attribute of a vertex buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct VertexAttribute {
    /// Format in the buffer.
    pub format: VertexFormat,
    /// Bytes from the start of an element.
    pub offset: u32,
    /// Location of the shader's attribute.
    pub shader_location: u32,
}

/// Layout of the elements of a vertex buffer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct VertexBufferLayout {
    /// Stride: bytes from one element to the next, not necessarily aligned. With 0, every vertex
    /// reads the same element. Default 0.
    pub array_stride: u32,
    /// Index by which the buffer advances. Default the vertex index.
    pub step_mode: VertexStepMode,
    /// Number of consecutive instances that share an element, for [`VertexStepMode::Instance`]:
    /// instance i of a draw whose first instance is f reads element f + (i − f) / rate, rounded
    /// down. With 0 all instances read element f. Default 1. (Vulkan's
    /// `VK_EXT_vertex_attribute_divisor`.)
    pub instance_step_rate: u32,
    /// Attributes of an element.
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
    /// Attributes stored one after the other without gaps, for locations 0, 1, …, by vertex index.
    #[must_use]
    pub fn packed(formats: &[VertexFormat]) -> Self {
        Self::packed_from(0, formats)
    }

    /// Attributes stored one after the other without gaps, for the locations from `first` on, by
    /// vertex index.
    #[must_use]
    pub fn packed_from(first: u32, formats: &[VertexFormat]) -> Self {
        let mut layout = Self::default();
        for (shader_location, &format) in (first..).zip(formats) {
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
