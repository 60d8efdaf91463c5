//! The observer that writes down vertices, primitives and pieces.

use super::cut::cut;
use super::pass_stages::{ClipOutcome, PolygonVertex, StagePiece, StagePrimitive, StageVertex};
use crate::inspect::oracle_draw::OracleDraw;
use crate::inspect::{PieceVertex, PrimitiveKind};
use estampe_reference::clip::{clip_line, clip_triangle, is_distant, keeps_point};
use estampe_reference::cull::Face;
use estampe_reference::observer::{Assembled, Observer};
use estampe_reference::point::half_width_subpixel;
use estampe_reference::shading::fetch_attributes;
use estampe_reference::viewport::ViewportTransform;
use estampe_reference::{ClipVertex, WindowVertex};
use estampe_types::state::PolygonMode;
use std::collections::HashMap;

/// What is written down of the geometry of a pass, up to a number of bytes.
#[derive(Debug)]
pub(super) struct Geometry {
    pub(super) vertices: Vec<StageVertex>,
    pub(super) primitives: Vec<StagePrimitive>,
    pub(super) pieces: Vec<StagePiece>,
    /// The bytes of the lists; if they are more than the limit, of those that were to be written.
    pub(super) bytes: u64,
    limit: u64,
}

impl Geometry {
    pub(super) fn new(limit: u64) -> Self {
        Self {
            vertices: Vec::new(),
            primitives: Vec::new(),
            pieces: Vec::new(),
            bytes: 0,
            limit,
        }
    }

    /// True if there was too much to write down.
    pub(super) fn is_full(&self) -> bool {
        self.bytes > self.limit
    }

    /// Counts an element; returns false if it does not fit.
    fn has_space_for<T>(&mut self, count: usize) -> bool {
        self.bytes += (count * size_of::<T>()) as u64;
        !self.is_full()
    }
}

/// Writes down the geometry of one draw.
pub(super) struct GeometryRecorder<'a> {
    geometry: &'a mut Geometry,
    number: u32,
    oracle: &'a OracleDraw<'a>,
    viewport: ViewportTransform,
    /// The instance at hand, and where the vertices of its indices were written.
    instance: u32,
    written: HashMap<u32, u32>,
    /// The vertices of the primitive at hand: place in the window, and half width of a point.
    points: Vec<([i32; 2], f32)>,
}

impl<'a> GeometryRecorder<'a> {
    pub(super) fn new(geometry: &'a mut Geometry, number: u32, oracle: &'a OracleDraw<'a>) -> Self {
        let state = oracle.state;
        Self {
            geometry,
            number,
            oracle,
            viewport: ViewportTransform::new(&state.viewport)
                .with_unclipped_depth(state.primitive.unclipped_depth),
            instance: 0,
            written: HashMap::new(),
            points: Vec::new(),
        }
    }

    /// The position of a vertex in the list, written if it is new; `None` if there is no space.
    fn vertex(&mut self, instance: u32, position: u32, vertex: &ClipVertex) -> Option<u32> {
        let (shaders, draw) = (self.oracle.shaders, self.oracle.draw);
        if self.instance != instance {
            self.instance = instance;
            self.written.clear();
        }
        let index = draw.vertex_index(position);
        if let Some(&at) = self.written.get(&index) {
            return Some(at);
        }
        // Twice, for the map.
        if !self.geometry.has_space_for::<StageVertex>(2) {
            return None;
        }
        let fetched = fetch_attributes(shaders, draw, position, instance);
        let mut attribute = [0.0; 4];
        for (component, value) in attribute
            .iter_mut()
            .zip(fetched.first().into_iter().flatten())
        {
            *component = *value;
        }
        let at = u32::try_from(self.geometry.vertices.len()).ok()?;
        self.written.insert(index, at);
        self.geometry.vertices.push(StageVertex {
            draw: self.number,
            instance,
            index,
            attribute,
            clip: vertex.position,
        });
        Some(at)
    }

    /// What clipping does to a primitive, and the polygon that it leaves.
    fn clipped(&self, vertices: &[ClipVertex]) -> (ClipOutcome, Vec<PolygonVertex>) {
        let viewport = &self.viewport;
        let dropped = (ClipOutcome::Dropped, Vec::new());
        if is_distant(vertices) {
            return dropped;
        }
        let outcome = |is_kept: bool, is_whole: bool| match (is_kept, is_whole) {
            (false, _) => ClipOutcome::Dropped,
            (true, true) => ClipOutcome::Inside,
            (true, false) => ClipOutcome::Clipped,
        };
        match vertices {
            [vertex] => (outcome(keeps_point(vertex, viewport), true), Vec::new()),
            [a, b] => {
                let ends = [a.clone(), b.clone()];
                let kept = clip_line(&ends, viewport);
                (outcome(kept.is_some(), kept == Some(ends)), Vec::new())
            }
            [a, b, c] => {
                let corners = [a.clone(), b.clone(), c.clone()];
                let Some(polygon) = cut(&corners, viewport) else {
                    return (ClipOutcome::Inside, Vec::new());
                };
                if clip_triangle(&corners, viewport).is_empty() {
                    return dropped;
                }
                if self.oracle.state.primitive.polygon_mode != PolygonMode::Fill {
                    return (ClipOutcome::Clipped, Vec::new());
                }
                let is_divisible = |w: f32| w > 0.0 && (1.0 / w).is_finite();
                let vertices = polygon.iter();
                let placed = vertices
                    .filter(|one| is_divisible(one.vertex.position[3]))
                    .map(|one| PolygonVertex {
                        window: piece_vertex(&viewport.place(&one.vertex)),
                        is_new: one.is_new,
                        is_cut: one.is_cut,
                    });
                (ClipOutcome::Clipped, placed.collect())
            }
            _ => dropped,
        }
    }

    fn push_piece(&mut self, vertices: &[WindowVertex], face: Face, is_culled: bool) {
        let geometry = &mut *self.geometry;
        let (Some(first), true) = (vertices.first(), geometry.has_space_for::<StagePiece>(1))
        else {
            return;
        };
        let kind = kind_of(vertices.len());
        let corner = |at: usize| piece_vertex(vertices.get(at).unwrap_or(first));
        let margin = match kind {
            PrimitiveKind::Triangle => 0.0,
            // Columns of pixels begin up to a pixel from the line, corners of rectangles are
            // rounded.
            PrimitiveKind::Line => self.oracle.state.primitive.line.width * 0.5 + 1.0,
            PrimitiveKind::Point => {
                let here = self.points.iter().filter(|(at, _)| *at == first.snapped);
                here.map(|(_, half)| *half).fold(0.5, f32::max)
            }
        };
        let Some(primitive) = geometry.primitives.len().checked_sub(1) else {
            return;
        };
        geometry.primitives[primitive].pieces.end += 1;
        geometry.pieces.push(StagePiece {
            primitive: u32::try_from(primitive).unwrap_or(u32::MAX),
            kind,
            vertices: [0, 1, 2].map(corner),
            front_facing: face == Face::Front,
            is_culled,
            margin,
        });
    }
}

impl Observer for GeometryRecorder<'_> {
    fn primitive(&mut self, assembled: &Assembled<'_>) {
        let mut vertices = [0; 3];
        let corners = assembled.positions.iter().zip(assembled.vertices);
        for (at, (&position, vertex)) in vertices.iter_mut().zip(corners) {
            let Some(written) = self.vertex(assembled.instance, position, vertex) else {
                return;
            };
            *at = written;
        }
        let (clipped, polygon) = self.clipped(assembled.vertices);
        self.points.clear();
        self.points.extend(assembled.vertices.iter().map(|vertex| {
            let half = half_width_subpixel(vertex.point_size) as f32 / 256.0;
            (self.viewport.place(vertex).snapped, half)
        }));
        let geometry = &mut *self.geometry;
        geometry.has_space_for::<PolygonVertex>(polygon.len());
        if !geometry.has_space_for::<StagePrimitive>(1) {
            return;
        }
        let first = u32::try_from(geometry.pieces.len()).unwrap_or(u32::MAX);
        geometry.primitives.push(StagePrimitive {
            draw: self.number,
            number: assembled.number,
            kind: kind_of(assembled.vertices.len()),
            vertices,
            clipped,
            polygon,
            pieces: first..first,
        });
    }

    fn piece(&mut self, vertices: &[WindowVertex], face: Face) {
        self.push_piece(vertices, face, false);
    }

    fn culled(&mut self, vertices: &[WindowVertex], face: Face) {
        self.push_piece(vertices, face, true);
    }
}

fn kind_of(corners: usize) -> PrimitiveKind {
    match corners {
        1 => PrimitiveKind::Point,
        2 => PrimitiveKind::Line,
        _ => PrimitiveKind::Triangle,
    }
}

fn piece_vertex(vertex: &WindowVertex) -> PieceVertex {
    PieceVertex {
        position: vertex.snapped.map(|subpixels| subpixels as f32 / 256.0),
        depth: vertex.z,
        inverse_w: vertex.inverse_w,
    }
}
