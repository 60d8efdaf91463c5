//! Vertex buffers copied from a mesh's arrays.

use super::faces::normals_oppose_winding;
use super::unit_space::UnitSpace;
use estampe::state::{VertexAttribute, VertexBufferLayout, VertexStepMode};
use estampe::{BufferError, BufferSlice, Device, VertexFormat};
use estampe_scene::{Mesh, Workers};
use glam::Vec3;

/// The attributes that surface shaders may read, in this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VertexStream {
    /// Three floats, unit space.
    Position,
    /// Three floats, object space.
    Normal,
    /// Two floats.
    Uv,
    /// Two floats: the second set.
    Uv1,
    /// Four floats: direction in object space, and the sign of the bitangent.
    Tangent,
    /// Four floats, linear.
    Color,
    /// Three floats, unit space: where light at the vertices is computed.
    LitAt,
    /// Three floats: 1 at one corner of a triangle, 0 at the others.
    Corner,
    /// Three floats: the colour of a triangle's number.
    Face,
}

impl VertexStream {
    const fn format(self) -> VertexFormat {
        match self {
            Self::Position | Self::Normal | Self::LitAt | Self::Corner | Self::Face => {
                VertexFormat::Float32x3
            }
            Self::Uv | Self::Uv1 => VertexFormat::Float32x2,
            Self::Color | Self::Tangent => VertexFormat::Float32x4,
        }
    }
}

/// One stream of a mesh: an element per vertex, or one element for all.
#[derive(Debug, Clone)]
pub(crate) struct StreamData {
    buffer: BufferSlice,
    is_constant: bool,
}

impl StreamData {
    /// A stream with an element per vertex; each has the stream's number of floats.
    pub(crate) fn per_vertex<const N: usize>(
        device: &Device,
        elements: impl Iterator<Item = [f32; N]>,
    ) -> Result<Self, BufferError> {
        let mut words = Vec::with_capacity(elements.size_hint().0.saturating_mul(N));
        for element in elements {
            words.extend(element.map(f32::to_bits));
        }
        Ok(Self {
            buffer: BufferSlice::from(&device.create_buffer_of_words(words)?),
            is_constant: false,
        })
    }

    /// A stream with an element per value, computed by several threads.
    fn of_each<T: Copy + Sync, const N: usize>(
        device: &Device,
        values: &[T],
        element: impl Fn(T) -> [f32; N] + Sync,
        workers: Workers,
    ) -> Result<Self, BufferError> {
        /// Vertices of a piece: some hundred microseconds of work, because touching new memory
        /// costs more than the writes themselves.
        const PIECE: usize = 1 << 14;
        let mut words = vec![0; values.len() * N];
        let parts = words.chunks_mut(PIECE * N).zip(values.chunks(PIECE));
        workers.map(parts, |(words, values)| {
            for (words, &value) in words.as_chunks_mut::<N>().0.iter_mut().zip(values) {
                *words = element(value).map(f32::to_bits);
            }
        });
        Ok(Self {
            buffer: BufferSlice::from(&device.create_buffer_of_words(words)?),
            is_constant: false,
        })
    }

    /// A stream with an element per value, computed by several threads in the values' own memory.
    fn of_spent(
        device: &Device,
        values: Vec<Vec3>,
        element: impl Fn(Vec3) -> Vec3 + Sync,
        workers: Workers,
    ) -> Result<Self, BufferError> {
        /// Vertices of a piece: some hundred microseconds of work.
        const PIECE: usize = 1 << 15;
        // The standard library collects in the memory of the values, whose size is the same.
        let bits = |value: Vec3| value.to_array().map(f32::to_bits);
        let mut words: Vec<[u32; 3]> = values.into_iter().map(bits).collect();
        workers.map(words.chunks_mut(PIECE), |words| {
            for words in words {
                *words = bits(element(Vec3::from_array(words.map(f32::from_bits))));
            }
        });
        Ok(Self {
            buffer: BufferSlice::from(&device.create_buffer_of_words(words.into_flattened())?),
            is_constant: false,
        })
    }

    /// A stream with one element for all vertices.
    pub(crate) fn constant(device: &Device, element: &[f32]) -> Result<Self, BufferError> {
        let words = element.iter().map(|value| value.to_bits()).collect();
        Ok(Self {
            buffer: BufferSlice::from(&device.create_buffer_of_words(words)?),
            is_constant: true,
        })
    }

    /// The buffer; cloning shares it.
    pub(crate) fn buffer(&self) -> BufferSlice {
        self.buffer.clone()
    }

    /// The layout of the buffer when it feeds `location`.
    pub(crate) fn layout(&self, stream: VertexStream, location: usize) -> VertexBufferLayout {
        let format = stream.format();
        let element_bytes =
            u32::try_from(format.size_bytes()).expect("formats are at most 16 bytes");
        VertexBufferLayout {
            array_stride: if self.is_constant { 0 } else { element_bytes },
            step_mode: VertexStepMode::Vertex,
            attributes: vec![VertexAttribute {
                format,
                offset: 0,
                shader_location: u32::try_from(location).expect("a handful of streams"),
            }],
            ..VertexBufferLayout::default()
        }
    }
}

/// The streams of one mesh.
#[derive(Debug, Clone)]
pub(crate) struct MeshStreams {
    pub(crate) positions: StreamData,
    pub(crate) normals: StreamData,
    pub(crate) uvs: StreamData,
    pub(crate) uvs_1: StreamData,
    pub(crate) tangents: StreamData,
    pub(crate) colors: StreamData,
    pub(crate) lit_at: StreamData,
    pub(crate) corners: StreamData,
    pub(crate) faces: StreamData,
}

/// −1 for normals that point against the winding.
fn sign_of_normals(mesh: &Mesh) -> f32 {
    if normals_oppose_winding(mesh) {
        -1.0
    } else {
        1.0
    }
}

/// The values of a named attribute of N numbers; none if the mesh has no such attribute.
pub(crate) fn attribute<'a, const N: usize>(mesh: &'a Mesh, name: &str) -> &'a [[f32; N]] {
    let named = mesh.attribute(name).filter(|found| found.components == N);
    named.map_or(&[], |found| found.values.as_chunks().0)
}

impl MeshStreams {
    /// The streams of a mesh with the scene's shared vertices. Missing attributes are constant: no
    /// normal, uv (0, 0), white.
    pub(crate) fn shared(
        mesh: &Mesh,
        space: &UnitSpace,
        device: &Device,
        workers: Workers,
    ) -> Result<Self, BufferError> {
        let sign = sign_of_normals(mesh);
        let position = |p| space.unit_from_object(p).to_array();
        let positions = StreamData::of_each(device, &mesh.positions, position, workers)?;
        let normals = if mesh.normals.is_empty() {
            StreamData::constant(device, &[0.0; 3])?
        } else {
            StreamData::of_each(device, &mesh.normals, |n| (n * sign).to_array(), workers)?
        };
        Self::with_other_attributes([positions, normals], mesh, sign, (device, workers))
    }

    /// [`Self::shared`] of a mesh with normals, in the memory of its positions and normals, which
    /// it has no longer.
    pub(crate) fn spent(
        mesh: &mut Mesh,
        space: &UnitSpace,
        device: &Device,
        workers: Workers,
    ) -> Result<Self, BufferError> {
        let sign = sign_of_normals(mesh);
        let positions = std::mem::take(&mut mesh.positions);
        let normals = std::mem::take(&mut mesh.normals);
        let unit = |position| space.unit_from_object(position);
        let positions = StreamData::of_spent(device, positions, unit, workers)?;
        let normals = StreamData::of_spent(device, normals, |normal| normal * sign, workers)?;
        Self::with_other_attributes([positions, normals], mesh, sign, (device, workers))
    }

    fn with_other_attributes(
        [positions, normals]: [StreamData; 2],
        mesh: &Mesh,
        sign: f32,
        (device, workers): (&Device, Workers),
    ) -> Result<Self, BufferError> {
        let uvs_1 = attribute::<2>(mesh, Mesh::UV1);
        let tangents = attribute::<4>(mesh, Mesh::TANGENT);
        Ok(Self {
            lit_at: positions.clone(),
            positions,
            normals,
            uvs: if mesh.uvs.is_empty() {
                StreamData::constant(device, &[0.0; 2])?
            } else {
                StreamData::of_each(device, &mesh.uvs, |uv| uv.to_array(), workers)?
            },
            uvs_1: if uvs_1.is_empty() {
                StreamData::constant(device, &[0.0; 2])?
            } else {
                StreamData::of_each(device, uvs_1, |uv| uv, workers)?
            },
            tangents: if tangents.is_empty() {
                StreamData::constant(device, &[0.0; 4])?
            } else {
                let turned = |[x, y, z, w]: [f32; 4]| [x, y, z, w * sign];
                StreamData::of_each(device, tangents, turned, workers)?
            },
            colors: if mesh.colors.is_empty() {
                StreamData::constant(device, &[1.0; 4])?
            } else {
                StreamData::of_each(device, &mesh.colors, |color| color, workers)?
            },
            corners: StreamData::constant(device, &[0.0; 3])?,
            faces: StreamData::constant(device, &[0.0; 3])?,
        })
    }

    /// The data of a stream.
    pub(crate) fn get(&self, stream: VertexStream) -> &StreamData {
        match stream {
            VertexStream::Position => &self.positions,
            VertexStream::Normal => &self.normals,
            VertexStream::Uv => &self.uvs,
            VertexStream::Uv1 => &self.uvs_1,
            VertexStream::Tangent => &self.tangents,
            VertexStream::Color => &self.colors,
            VertexStream::LitAt => &self.lit_at,
            VertexStream::Corner => &self.corners,
            VertexStream::Face => &self.faces,
        }
    }
}
