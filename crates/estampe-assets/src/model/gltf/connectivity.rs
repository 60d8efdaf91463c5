//! How a primitive's vertices are connected: its mode and its indices become points, lines or
//! triangles.
//!
//! ```text
//! line strip  0-1 1-2 2-3        triangle strip  0 1 2, 1 3 2, 2 3 4, …
//! line loop   and 3-0            triangle fan    1 2 0, 2 3 0, 3 4 0, …
//! ```
//!
//! Source: glTF 2.0 specification, §3.7.2.1.

use super::accessor::Accessors;
use super::document::Primitive;
use super::fault::{malformed, warn};
use crate::AssetError;
use crate::model::load::Context;
use estampe_scene::{LineSegment, Triangle};

/// The primitives between vertices.
#[derive(Debug, Default)]
pub(super) struct Connectivity {
    pub(super) points: Vec<u32>,
    pub(super) lines: Vec<LineSegment>,
    pub(super) triangles: Vec<Triangle>,
}

/// The modes, in the order of their numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Mode {
    Points,
    Lines,
    LineLoop,
    LineStrip,
    Triangles,
    TriangleStrip,
    TriangleFan,
}

impl Mode {
    const ALL: [Self; 7] = [
        Self::Points,
        Self::Lines,
        Self::LineLoop,
        Self::LineStrip,
        Self::Triangles,
        Self::TriangleStrip,
        Self::TriangleFan,
    ];

    /// The mode of a primitive; `None` if its number is unknown.
    fn of(primitive: &Primitive) -> Option<Self> {
        let number = primitive.mode.map_or(4, |mode| mode.0);
        Self::ALL.get(number).copied()
    }
}

impl Connectivity {
    /// The number of points, lines or triangles that a primitive has at most, without reading it.
    pub(super) fn element_count(
        primitive: &Primitive,
        vertex_count: usize,
        accessors: &Accessors<'_>,
        pointer: &str,
    ) -> Result<usize, AssetError> {
        let indices = match primitive.indices {
            Some(indices) => accessors.count(indices, || format!("{pointer}/indices"))?,
            None => vertex_count,
        };
        let per_element = match Mode::of(primitive) {
            Some(Mode::Triangles) => 3,
            Some(Mode::Lines) => 2,
            _ => 1,
        };
        Ok(indices.div_ceil(per_element))
    }

    /// True if the primitive's mode is one of glTF's; others are left out.
    pub(super) fn is_known(primitive: &Primitive) -> bool {
        Mode::of(primitive).is_some()
    }

    /// Reads the connectivity of `vertex_count` vertices.
    pub(super) fn read(
        primitive: &Primitive,
        vertex_count: usize,
        accessors: &Accessors<'_>,
        pointer: &str,
        context: &mut Context<'_>,
    ) -> Result<Self, AssetError> {
        let Some(mode) = Mode::of(primitive) else {
            let number = primitive.mode.unwrap_or_default();
            let what = format!("{number} is not a mode; modes are 0 to 6");
            return Err(malformed(format!("{pointer}/mode"), what));
        };
        let indices = match primitive.indices {
            Some(_) => read_indices(primitive, vertex_count, accessors, pointer)?,
            // Limits keep the number of vertices below 2^32.
            None => (0..u32::try_from(vertex_count).unwrap_or(u32::MAX)).collect(),
        };
        let (multiple, least) = match mode {
            Mode::Points => (1, 0),
            Mode::Lines => (2, 0),
            Mode::LineLoop | Mode::LineStrip => (1, 2),
            Mode::Triangles => (3, 0),
            Mode::TriangleStrip | Mode::TriangleFan => (1, 3),
        };
        let count = indices.len();
        if count % multiple != 0 || count > 0 && count < least {
            let what = format!("{count} vertices do not fit the mode; the last ones are left out");
            warn(context, pointer, what);
        }
        Ok(Self::connect(mode, indices))
    }

    fn connect(mode: Mode, indices: Vec<u32>) -> Self {
        let mut all = Self::default();
        match mode {
            Mode::Points => all.points = indices,
            Mode::Lines => all.lines = indices.as_chunks::<2>().0.to_vec(),
            Mode::LineStrip | Mode::LineLoop => {
                all.lines = indices.array_windows::<2>().copied().collect();
                if let (Mode::LineLoop, &[first, .., last]) = (mode, &*indices) {
                    all.lines.push([last, first]);
                }
            }
            Mode::Triangles => all.triangles = indices.as_chunks::<3>().0.to_vec(),
            Mode::TriangleStrip => {
                let windows = indices.array_windows::<3>().enumerate();
                let wound = windows.map(|(at, &[a, b, c])| match at % 2 {
                    0 => [a, b, c],
                    _ => [a, c, b],
                });
                // Strips are joined by triangles without area.
                let has_area = |&[a, b, c]: &Triangle| a != b && b != c && c != a;
                all.triangles = wound.filter(has_area).collect();
            }
            Mode::TriangleFan => {
                if let [first, rest @ ..] = &*indices {
                    let edges = rest.array_windows::<2>();
                    all.triangles = edges.map(|&[b, c]| [b, c, *first]).collect();
                }
            }
        }
        all
    }
}

fn read_indices(
    primitive: &Primitive,
    vertex_count: usize,
    accessors: &Accessors<'_>,
    pointer: &str,
) -> Result<Vec<u32>, AssetError> {
    let place = || format!("{pointer}/indices");
    let elements = accessors.get(primitive.indices.unwrap_or_default(), place)?;
    let indices = elements.integers::<1>()?.into_flattened();
    let largest = indices.iter().copied().max().unwrap_or(0) as usize;
    if largest >= vertex_count && !indices.is_empty() {
        let at = indices
            .iter()
            .position(|&index| index as usize >= vertex_count);
        return Err(malformed(
            elements.pointer(),
            format!(
                "index {} at {} is outside of the {vertex_count} vertices",
                indices[at.unwrap_or_default()],
                at.unwrap_or_default()
            ),
        ));
    }
    Ok(indices)
}
