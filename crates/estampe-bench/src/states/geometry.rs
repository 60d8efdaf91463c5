//! Vertices and indices of the loads, and the layout of a vertex.

use super::Load;
use crate::frame::FrameSize;
use crate::generate::{LittleEndian, QUAD_CORNERS, hash32, quad_indices};
use estampe::VertexFormat;
use estampe::state::{PrimitiveTopology, VertexBufferLayout};

/// The number of quads over each other in the loads `fill` and `blend`.
const LAYERS: u32 = 8;
/// Side in pixels of a cell of two triangles of 8 pixels each.
const CELL_PX: u32 = 4;
/// Width and height of a glyph's quad.
pub(super) const GLYPH_PX: [u32; 2] = [10, 14];
/// Glyphs per row of their texture, and number of rows.
pub(super) const GLYPHS: [u32; 2] = [24, 16];
/// Side of the textures.
pub(super) const TEXTURE_SIDE: u32 = 512;

/// A vertex before encoding.
#[derive(Debug, Clone, Copy)]
struct Vertex {
    /// In NDC.
    position: [f64; 3],
    color: [u8; 4],
    uv: [f64; 2],
}

/// Primitives of one topology.
#[derive(Debug, Clone)]
pub(super) struct Geometry {
    vertices: Vec<Vertex>,
    /// 32 bits each.
    indices: Vec<u8>,
    pub(super) topology: PrimitiveTopology,
}

impl Geometry {
    /// The geometry of a load for a target of this size.
    pub(super) fn of(load: Load, size: FrameSize) -> Self {
        match load {
            Load::Fill | Load::Blend => layers(),
            Load::Tris8 => triangles(size),
            Load::Textured => quads([whole_target()]),
            Load::Text => quads(glyphs(size)),
        }
    }

    /// Lines of eight columns and four rows, in place of the triangles.
    pub(super) fn lines(size: FrameSize) -> Self {
        let grid = Grid::new(size);
        let mut indices = LittleEndian::default();
        for row in 0..grid.rows {
            for column in (0..grid.columns.saturating_sub(1)).step_by(2) {
                indices.words(&[grid.index(column, row), grid.index(column + 2, row + 1)]);
            }
        }
        Self {
            vertices: grid.vertices(size),
            indices: indices.into_bytes(),
            topology: PrimitiveTopology::LineList,
        }
    }

    /// Points at the triangles' corners.
    pub(super) fn points(size: FrameSize) -> Self {
        let grid = Grid::new(size);
        let mut indices = LittleEndian::default();
        for index in 0..=grid.index(grid.columns, grid.rows) {
            indices.words(&[index]);
        }
        Self {
            vertices: grid.vertices(size),
            indices: indices.into_bytes(),
            topology: PrimitiveTopology::PointList,
        }
    }

    pub(super) fn indices(&self) -> &[u8] {
        &self.indices
    }

    pub(super) fn index_count(&self) -> u32 {
        u32::try_from(self.indices.len() / 4).expect("the loads count indices in 32 bits")
    }

    pub(super) fn primitives(&self) -> u32 {
        let each = match self.topology {
            PrimitiveTopology::PointList => 1,
            PrimitiveTopology::LineList => 2,
            _ => 3,
        };
        self.index_count() / each
    }

    /// The vertices' bytes, in the layout of [`layout`].
    pub(super) fn encoded(&self, color: VertexFormat, has_uv: bool) -> Vec<u8> {
        let mut bytes = LittleEndian::default();
        for vertex in &self.vertices {
            bytes.reals(&vertex.position);
            bytes.raw(&encoded_color(vertex.color, color));
            if has_uv {
                bytes.reals(&vertex.uv);
            }
        }
        bytes.into_bytes()
    }
}

/// The layout: position, colour in a format, and for textured loads the texture coordinate.
pub(super) fn layout(color: VertexFormat, has_uv: bool) -> VertexBufferLayout {
    let formats = [VertexFormat::Float32x3, color, VertexFormat::Float32x2];
    VertexBufferLayout::packed(if has_uv { &formats } else { &formats[..2] })
}

/// A colour of 8 bits per channel in one of the vertex formats of the states. 16-bit floats hold
/// c/256, exactly; signed formats have the codes c >> 1 and c << 7, which stand for nearly c/255.
fn encoded_color(color: [u8; 4], format: VertexFormat) -> Vec<u8> {
    let words = color.map(u16::from);
    let of_words = |words: [u16; 4]| words.iter().flat_map(|word| word.to_le_bytes()).collect();
    match format {
        VertexFormat::Float32x4 => {
            let mut bytes = LittleEndian::default();
            bytes.reals(&color.map(|channel| f64::from(channel) / 255.0));
            bytes.into_bytes()
        }
        VertexFormat::Float16x4 => of_words(color.map(half_of_256th)),
        VertexFormat::Snorm8x4 => color.map(|channel| channel >> 1).to_vec(),
        VertexFormat::Unorm16x4 => of_words(words.map(|channel| channel * 257)),
        VertexFormat::Snorm16x4 => of_words(words.map(|channel| channel << 7)),
        VertexFormat::Uint32x4 => {
            let mut bytes = LittleEndian::default();
            bytes.words(&color.map(u32::from));
            bytes.into_bytes()
        }
        VertexFormat::Unorm10_10_10_2 => {
            let [red, green, blue, alpha] = color.map(u32::from);
            let code = red << 2 | green << 12 | blue << 22 | (alpha >> 6) << 30;
            code.to_le_bytes().to_vec()
        }
        VertexFormat::Unorm8x4Bgra => {
            let [red, green, blue, alpha] = color;
            vec![blue, green, red, alpha]
        }
        _ => color.to_vec(),
    }
}

/// The half float of c/256, which is exact: the leading bit gives the exponent, the others the
/// mantissa.
pub(super) fn half_of_256th(code: u8) -> u16 {
    if code == 0 {
        return 0;
    }
    let exponent = code.ilog2();
    let mantissa = (u32::from(code) << (10 - exponent)) & 0x3FF;
    let bits = (exponent + 15 - 8) << 10 | mantissa;
    u16::try_from(bits).expect("an exponent below 16 and ten bits of mantissa")
}

/// A rectangle of the target with its texture coordinates and colours.
struct Quad {
    /// Left, bottom, right, top in NDC.
    bounds: [f64; 4],
    z: f64,
    /// Texture coordinates of the left top and the right bottom corner.
    uv: [[f64; 2]; 2],
    /// Seed of the corners' colours.
    seed: u32,
}

fn quads(quads: impl IntoIterator<Item = Quad>) -> Geometry {
    let mut vertices = Vec::new();
    for quad in quads {
        let [left, bottom, right, top] = quad.bounds;
        let [[u_left, v_top], [u_right, v_bottom]] = quad.uv;
        for (corner, [x, y]) in (0..).zip(QUAD_CORNERS) {
            let (is_right, is_top) = (x > 0.0, y > 0.0);
            vertices.push(Vertex {
                position: [
                    if is_right { right } else { left },
                    if is_top { top } else { bottom },
                    quad.z,
                ],
                color: hash32(quad.seed + corner).to_le_bytes(),
                uv: [
                    if is_right { u_right } else { u_left },
                    if is_top { v_top } else { v_bottom },
                ],
            });
        }
    }
    let count = u32::try_from(vertices.len() / 4).expect("the loads count quads in 32 bits");
    Geometry {
        vertices,
        indices: quad_indices(count),
        topology: PrimitiveTopology::TriangleList,
    }
}

fn whole_target() -> Quad {
    Quad {
        bounds: [-1.0, -1.0, 1.0, 1.0],
        z: 0.5,
        uv: [[0.013, 0.017], [0.991, 0.983]],
        seed: 100,
    }
}

/// The full-screen quads, the farthest first.
fn layers() -> Geometry {
    quads((0..LAYERS).map(|layer| Quad {
        z: 1.0 - f64::from(layer + 1) / f64::from(LAYERS + 1),
        seed: 1000 + layer * 4,
        ..whole_target()
    }))
}

/// Glyphs on whole pixels, one texel per pixel, as text is usually drawn.
fn glyphs(size: FrameSize) -> impl Iterator<Item = Quad> {
    let [width, height] = GLYPH_PX;
    let (columns, rows) = (size.width / width, size.height / height);
    let (frame_width, frame_height) = (f64::from(size.width), f64::from(size.height));
    let places = (0..rows).flat_map(move |row| (0..columns).map(move |column| (column, row)));
    places.map(move |(column, row)| {
        let ndc = |x_px: u32, y_px: u32| {
            let x = f64::from(x_px) / frame_width * 2.0 - 1.0;
            [x, 1.0 - f64::from(y_px) / frame_height * 2.0]
        };
        let [left, top] = ndc(column * width, row * height);
        let [right, bottom] = ndc((column + 1) * width, (row + 1) * height);
        let glyph = hash32(row * columns + column);
        let place = [
            glyph % GLYPHS[0] * width,
            glyph / GLYPHS[0] % GLYPHS[1] * height,
        ];
        let texel = |at: u32| f64::from(at) / f64::from(TEXTURE_SIDE);
        Quad {
            bounds: [left, bottom, right, top],
            z: 0.5,
            uv: [
                place.map(texel),
                [texel(place[0] + width), texel(place[1] + height)],
            ],
            seed: 2000 + row * 4,
        }
    })
}

/// Square cells over the whole target.
struct Grid {
    columns: u32,
    rows: u32,
}

impl Grid {
    fn new(size: FrameSize) -> Self {
        Self {
            columns: size.width / CELL_PX,
            rows: size.height / CELL_PX,
        }
    }

    fn index(&self, column: u32, row: u32) -> u32 {
        row * (self.columns + 1) + column
    }

    /// The corners; inner ones are moved at random by up to a quarter of a cell.
    fn vertices(&self, size: FrameSize) -> Vec<Vertex> {
        let moved = |bits: u8, at: u32, count: u32| {
            let is_inside = at > 0 && at < count;
            f64::from(u8::from(is_inside)) * (f64::from(bits) / 255.0 - 0.5) * 0.5
        };
        let corners = (0..=self.rows).flat_map(|row| (0..=self.columns).map(move |c| (c, row)));
        let vertices = corners.map(|(column, row)| {
            let color = hash32(row * 65_536 + column).to_le_bytes();
            let x = f64::from(column) + moved(color[0], column, self.columns);
            let y = f64::from(row) + moved(color[1], row, self.rows);
            let px = f64::from(CELL_PX);
            Vertex {
                position: [
                    x * px / f64::from(size.width) * 2.0 - 1.0,
                    1.0 - y * px / f64::from(size.height) * 2.0,
                    0.5,
                ],
                color,
                uv: [0.0; 2],
            }
        });
        vertices.collect()
    }
}

fn triangles(size: FrameSize) -> Geometry {
    let grid = Grid::new(size);
    let mut indices = LittleEndian::default();
    for row in 0..grid.rows {
        for column in 0..grid.columns {
            let [upper_left, upper_right] = [0, 1].map(|step| grid.index(column + step, row));
            let [lower_left, lower_right] = [0, 1].map(|step| grid.index(column + step, row + 1));
            indices.words(&[upper_left, lower_left, lower_right]);
            indices.words(&[upper_left, lower_right, upper_right]);
        }
    }
    Geometry {
        vertices: grid.vertices(size),
        indices: indices.into_bytes(),
        topology: PrimitiveTopology::TriangleList,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_of_256ths_are_exact() {
        // 1/256 = 2⁻⁸, 3/256 = 1.5·2⁻⁷, 1/2 = 2⁻¹, 255/256 = 1.9921875·2⁻¹.
        let expected = [
            (0, 0),
            (1, 7 << 10),
            (3, 8 << 10 | 0x200),
            (128, 14 << 10),
            (255, 0x3BF8),
        ];
        for (code, half) in expected {
            assert_eq!(half_of_256th(code), half, "{code}");
        }
    }

    #[test]
    fn a_vertex_is_as_long_as_its_layout_says() {
        let size = FrameSize {
            width: 40,
            height: 28,
        };
        let geometry = Geometry::of(Load::Text, size);
        assert_eq!((geometry.vertices.len(), geometry.primitives()), (32, 16));
        for color in [
            VertexFormat::Unorm8x4,
            VertexFormat::Float32x4,
            VertexFormat::Float16x4,
            VertexFormat::Snorm8x4,
            VertexFormat::Unorm16x4,
            VertexFormat::Snorm16x4,
            VertexFormat::Uint32x4,
            VertexFormat::Unorm10_10_10_2,
            VertexFormat::Unorm8x4Bgra,
        ] {
            for has_uv in [false, true] {
                let stride = layout(color, has_uv).array_stride as usize;
                assert_eq!(
                    geometry.encoded(color, has_uv).len(),
                    stride * 32,
                    "{color:?}"
                );
            }
        }
        assert_eq!(Geometry::of(Load::Tris8, size).primitives(), 140);
        assert_eq!(Geometry::lines(size).primitives(), 35);
        assert_eq!(Geometry::points(size).primitives(), 88);
        assert_eq!(Geometry::of(Load::Fill, size).primitives(), 16);
    }
}
