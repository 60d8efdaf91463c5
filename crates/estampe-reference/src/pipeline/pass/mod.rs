//! A pass: the primitives of a draw, one after the other, through clipping, culling and the
//! rasterizer.

mod fragments;
mod lines;

use super::{Counts, State};
use crate::assembly::{Primitive, primitives, turned};
use crate::clip::{clip_triangle, is_distant, keeps_point};
use crate::conservative;
use crate::cull::{Face, face, is_culled};
use crate::fragment::TriangleSurface;
use crate::observer::{Assembled, Observer};
use crate::point::{self, PointSurface};
use crate::program::Shaders;
use crate::raster;
use crate::setup::SortedTriangle;
use crate::viewport::{PixelBounds, ViewportSamples, ViewportTransform, is_drawable};
use crate::{ClipVertex, Target, WindowVertex, depth_bias};
use estampe_types::state::{ConservativeMode, PolygonMode, PrimitiveState, PrimitiveTopology};
use estampe_types::{Bindings, Interface};
use std::ops::Range;

/// The state that all primitives of a draw share.
pub(super) struct Pass<'a> {
    target: &'a mut Target,
    shaders: &'a dyn Shaders,
    state: &'a State,
    bindings: &'a Bindings,
    viewport: ViewportTransform,
    bounds: PixelBounds,
    viewport_samples: ViewportSamples,
    interface: &'a Interface,
    is_by_sample: bool,
    /// The length of the stipple pattern that the preceding lines of the strip have used: in
    /// columns for Bresenham lines, in 1/65536 pixel for rectangular ones.
    stipple: u64,
    pub(super) counts: Counts,
    observer: &'a mut dyn Observer,
}

/// In polygon modes line and point, the triangle to which a line or point belongs.
#[derive(Clone, Copy)]
struct Parent<'a> {
    face: Face,
    flat: &'a [f32],
    /// The depth bias.
    bias: Option<f32>,
}

impl<'a> Pass<'a> {
    /// The pass of a draw; `None` if it draws nothing.
    pub(super) fn new(
        target: &'a mut Target,
        shaders: &'a dyn Shaders,
        state: &'a State,
        bindings: &'a Bindings,
        observer: &'a mut dyn Observer,
    ) -> Option<Self> {
        if !is_drawable(&state.viewport) {
            return None;
        }
        let size = [target.width, target.height];
        let bounds = PixelBounds::new(&state.viewport, &state.scissor, size, target.samples);
        if bounds.x.is_empty() || bounds.y.is_empty() {
            return None;
        }
        let bounds = bounds.intersection(target.stored());
        let interface = shaders.interface();
        Some(Self {
            target,
            shaders,
            state,
            bindings,
            viewport: ViewportTransform::new(&state.viewport)
                .with_unclipped_depth(state.primitive.unclipped_depth),
            bounds,
            viewport_samples: ViewportSamples::new(&state.viewport),
            is_by_sample: state.sample_shading || interface.per_sample,
            interface,
            stipple: 0,
            counts: Counts::default(),
            observer,
        })
    }
}

impl Pass<'_> {
    /// Draws the primitives of a run of consecutive vertices without a restart between them.
    /// `shade` gives the vertex at a position in the draw's range.
    pub(super) fn run(
        &mut self,
        run: &Range<u32>,
        instance: u32,
        mut shade: impl FnMut(u32) -> ClipVertex,
    ) {
        let PrimitiveState {
            topology,
            provoking_vertex: mode,
            ..
        } = self.state.primitive;
        let mut shade = |at: u32| shade(run.start + at);
        for (index, primitive) in primitives(topology, run.end - run.start).enumerate() {
            let number = self.counts.primitives;
            self.counts.primitives += 1;
            let mut observe = |positions: &[u32], vertices: &[ClipVertex]| {
                let positions: Vec<u32> = positions.iter().map(|at| run.start + at).collect();
                self.observer.primitive(&Assembled {
                    number,
                    instance,
                    positions: &positions,
                    vertices,
                });
            };
            match primitive {
                Primitive::Point(at) => {
                    let vertex = shade(at);
                    observe(&[at], std::slice::from_ref(&vertex));
                    if !is_distant(std::slice::from_ref(&vertex)) {
                        self.point(&vertex, None);
                    }
                }
                Primitive::Line(at) => {
                    let ends = at.map(&mut shade);
                    observe(&at, &ends);
                    if index == 0 || !is_line_strip(topology) {
                        self.stipple = 0;
                    }
                    if !is_distant(&ends) {
                        self.line(&ends, None);
                    }
                }
                Primitive::Triangle(at) => {
                    let at = turned(topology, mode, index, at);
                    let corners = at.map(&mut shade);
                    observe(&at, &corners);
                    if !is_distant(&corners) {
                        self.triangle(&corners);
                    }
                }
            }
        }
    }

    fn triangle(&mut self, vertices: &[ClipVertex; 3]) {
        let flat = vertices[0].varyings.clone();
        let mode = self.state.primitive.polygon_mode;
        for piece in clip_triangle(vertices, &self.viewport) {
            let placed = piece.each_ref().map(|vertex| self.viewport.place(vertex));
            let corners = placed.each_ref().map(|vertex| vertex.snapped);
            let Some(face) = face(corners, self.state.primitive.front_face) else {
                continue;
            };
            let is_culled = is_culled(face, self.state.primitive.cull_mode);
            match mode {
                PolygonMode::Fill if is_culled => self.observer.culled(&placed, face),
                PolygonMode::Fill => self.filled(placed, face, &flat),
                // The first piece with an area gives the facing of the whole triangle; its edges
                // and vertices are then clipped separately.
                PolygonMode::Line | PolygonMode::Point => {
                    if !is_culled {
                        let bias = SortedTriangle::new(placed).and_then(|piece| self.bias(&piece));
                        let flat = &flat;
                        self.stipple = 0;
                        self.outline(vertices, Parent { face, flat, bias });
                    }
                    return;
                }
            }
        }
    }

    /// The depth bias of a triangle; `None` if the state has none.
    fn bias(&self, triangle: &SortedTriangle) -> Option<f32> {
        let state = &self.state.depth_bias;
        let offset = || depth_bias::offset(state, self.state.depth_bias_unit, triangle);
        (state.constant != 0.0 || state.slope_scale != 0.0).then(offset)
    }

    /// Draws one piece of a clipped triangle.
    fn filled(&mut self, vertices: [WindowVertex; 3], face: Face, flat: &[f32]) {
        let vertices_given = vertices.clone();
        let Some(sorted) = SortedTriangle::new(vertices) else {
            return;
        };
        self.counts.rasterized += 1;
        let mut surface = TriangleSurface::new(&sorted, &self.interface.varyings, flat);
        if let Some(bias) = self.bias(&sorted) {
            surface.depth.value += bias;
        }
        self.observer.piece(&vertices_given, face);
        let (corners, samples) = (sorted.corners(), self.target.samples);
        let quads = match self.state.primitive.conservative {
            ConservativeMode::Disabled => raster::triangle(corners, &self.bounds, samples),
            mode => conservative::triangle(corners, mode, &self.bounds, samples),
        };
        self.fragments(&quads, &surface, face);
    }

    /// Draws the edges or the vertices of a triangle.
    fn outline(&mut self, vertices: &[ClipVertex; 3], parent: Parent<'_>) {
        let [a, b, c] = vertices;
        if self.state.primitive.polygon_mode == PolygonMode::Point {
            for vertex in vertices {
                self.point(vertex, Some(parent));
            }
        } else {
            for [start, end] in [[a, b], [b, c], [c, a]] {
                self.line(&[start.clone(), end.clone()], Some(parent));
            }
        }
    }
    fn point(&mut self, vertex: &ClipVertex, parent: Option<Parent<'_>>) {
        if !keeps_point(vertex, &self.viewport) {
            return;
        }
        self.counts.rasterized += 1;
        let placed = moved(self.viewport.place(vertex), parent);
        self.observer
            .piece(std::slice::from_ref(&placed), face_of(parent));
        let samples = self.target.samples;
        let cover = if self.state.primitive.round_points {
            point::cover_round
        } else {
            point::cover
        };
        let quads = cover(placed.snapped, vertex.point_size, &self.bounds, samples);
        let interface = self.interface;
        let surface = PointSurface {
            vertex: &placed,
            flat: parent.map_or(&vertex.varyings, |parent| parent.flat),
            modes: &interface.varyings,
        };
        self.fragments(&quads, &surface, face_of(parent));
    }
}

/// The facing of a line or point: front, or that of its parent triangle.
fn face_of(parent: Option<Parent<'_>>) -> Face {
    parent.map_or(Face::Front, |parent| parent.face)
}

/// A vertex with the parent triangle's depth bias added.
fn moved(vertex: WindowVertex, parent: Option<Parent<'_>>) -> WindowVertex {
    match parent.and_then(|parent| parent.bias) {
        Some(bias) => WindowVertex {
            z: vertex.z + bias,
            ..vertex
        },
        None => vertex,
    }
}

/// Returns true if each line of a topology begins at the end of the previous one.
fn is_line_strip(topology: PrimitiveTopology) -> bool {
    use PrimitiveTopology as T;
    matches!(topology, T::LineStrip | T::LineLoop | T::LineStripAdjacency)
}
