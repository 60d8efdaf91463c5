//! A draw: every primitive goes through all stages before the next one begins.

use crate::assembly::{Primitive, primitives, runs, turned};
use crate::clip::{clip_line, clip_triangle, is_distant, keeps_point};
use crate::conservative;
use crate::cull::{Face, face, is_culled};
use crate::fragment::{Invocation, Surface, TriangleSurface, sample_depth, shade_quad};
use crate::line::{LinePath, LineSurface};
use crate::observer::{Assembled, FragmentEvent, Observer, SampleEvent};
use crate::per_sample::Outcome;
use crate::point::{self, PointSurface};
use crate::program::{RustShaders, Shaders};
use crate::raster::{self, QuadCoverage, all_samples, sample_positions};
use crate::rectangle::{LineRectangle, RectangleSurface};
use crate::setup::SortedTriangle;
use crate::shading::shade_vertex;
use crate::viewport::{PixelBounds, ViewportSamples, ViewportTransform, is_drawable};
use crate::{ClipVertex, Target, WindowVertex, depth_bias, fetch, per_sample};
use estampe_types::shader::Shader;
use estampe_types::state::{
    BlendState, ColorWrites, ConservativeMode, DepthBiasState, DepthState, LineRasterization,
    LineStipple, LogicOperation, PolygonMode, PrimitiveState, PrimitiveTopology, ProvokingVertex,
    ScissorRect, StencilState, VertexBufferLayout, Viewport,
};
use estampe_types::{Bindings, BufferData, IndexFormat, Interface};
use std::ops::Range;

/// The fixed-function state of a draw.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// Topology, facing, culling, polygon mode.
    pub primitive: PrimitiveState,
    /// The depth test; `None` neither tests nor writes depth.
    pub depth: Option<DepthState>,
    /// Depth bias of triangles.
    pub depth_bias: DepthBiasState,
    /// The unit of the bias constant: 2⁻ⁿ for a fixed-point depth attachment of n bits; `None` for
    /// a float attachment.
    pub depth_bias_unit: Option<f32>,
    /// The stencil test; `None` neither tests nor writes stencil.
    pub stencil: Option<StencilState>,
    /// The stencil references of front and back.
    pub stencil_reference: [u8; 2],
    /// The depth-bounds test: the least and the greatest stored depth at which samples pass; `None`
    /// disables it.
    pub depth_bounds: Option<[f32; 2]>,
    /// The sample mask: bit s enables sample s.
    pub sample_mask: u32,
    /// If set, alpha to coverage is enabled.
    pub alpha_to_coverage: bool,
    /// If set, shading is per sample, even if the shader does not require it.
    pub sample_shading: bool,
    /// A logic operation, in place of blending.
    pub logic_operation: Option<LogicOperation>,
    /// Blending and write masks, by target; targets beyond the list are replaced.
    pub targets: Vec<TargetState>,
    /// The constant of [`BlendFactor::Constant`](estampe_types::state::BlendFactor::Constant).
    pub blend_constant: [f32; 4],
    /// The viewport, in pixels of the target.
    pub viewport: Viewport,
    /// The scissor rectangle, in pixels of the target.
    pub scissor: ScissorRect,
}

/// The blending and the write mask of a target. The default replaces all channels.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TargetState {
    /// Blending; `None` replaces the stored colour.
    pub blend: Option<BlendState>,
    /// The channels that are written.
    pub write_mask: ColorWrites,
}

impl State {
    /// State for filled triangles over a whole target: no culling, no depth test, no blending.
    #[must_use]
    pub fn new(width: u32, height: u32) -> Self {
        Self {
            primitive: PrimitiveState::default(),
            depth: None,
            depth_bias: DepthBiasState::default(),
            depth_bias_unit: None,
            stencil: None,
            stencil_reference: [0; 2],
            depth_bounds: None,
            sample_mask: u32::MAX,
            alpha_to_coverage: false,
            sample_shading: false,
            logic_operation: None,
            targets: Vec::new(),
            blend_constant: [0.0; 4],
            viewport: Viewport {
                x: 0.0,
                y: 0.0,
                width: width as f32,
                height: height as f32,
                min_depth: 0.0,
                max_depth: 1.0,
            },
            scissor: ScissorRect {
                x: 0,
                y: 0,
                width,
                height,
            },
        }
    }
}

/// The parameters and buffers of a draw.
#[derive(Debug, Clone)]
pub struct Draw<'a> {
    /// Vertex buffers with their layouts.
    pub buffers: &'a [(VertexBufferLayout, BufferData)],
    /// The index buffer, if the draw has one.
    pub indices: Option<(IndexFormat, &'a BufferData)>,
    /// The range of vertices, or of elements of the index buffer.
    pub vertices: Range<u32>,
    /// The range of instances, drawn one after the other.
    pub instances: Range<u32>,
    /// Added to each index; without an index buffer it has no effect.
    pub base_vertex: i32,
    /// The shader's uniforms, textures and storage textures.
    pub bindings: &'a Bindings,
}

impl Draw<'_> {
    /// The index of the vertex at a position in the range, counted from the range's start.
    #[must_use]
    pub fn vertex_index(&self, position: u32) -> u32 {
        let element = self.vertices.start.wrapping_add(position);
        match self.indices {
            Some((format, buffer)) => fetch::index(format, buffer, element, self.base_vertex),
            None => element,
        }
    }

    /// Returns true if the index at a position in the range restarts primitives: it is the greatest
    /// of its format.
    #[must_use]
    pub fn is_restart(&self, position: u32) -> bool {
        let element = self.vertices.start.wrapping_add(position);
        self.indices.is_some_and(|(format, buffer)| {
            let greatest = match format {
                IndexFormat::Uint8 => u32::from(u8::MAX),
                IndexFormat::Uint16 => u32::from(u16::MAX),
                IndexFormat::Uint32 => u32::MAX,
            };
            fetch::raw_index(format, buffer, element) == greatest
        })
    }
}

/// Statistics of a draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counts {
    /// Assembled primitives.
    pub primitives: u64,
    /// Points, lines and triangles that reached the rasterizer, after clipping and culling. In
    /// polygon modes line and point, the lines and points.
    pub rasterized: u64,
    /// Fragment shader invocations, per pixel or per sample, without helper invocations.
    pub fragments: u64,
    /// Covered samples.
    pub samples_covered: u64,
    /// Samples that passed every test.
    pub samples_passed: u64,
}

/// Draws into a target.
///
/// A draw whose viewport, scissor and target have no pixel in common does nothing: none of it is
/// counted.
///
/// It cannot fail: indices out of range and short buffers read as zeros, and NaN and infinity are
/// dropped or stored as NUMERICS.md says; a shader of which no pipeline can be made draws nothing.
/// Its time is proportional to the vertex and instance
/// ranges, however large.
pub fn draw<S: Shader>(target: &mut Target, shader: &S, state: &State, draw: &Draw<'_>) -> Counts {
    match RustShaders::new(shader) {
        Ok(shaders) => draw_observed(target, &shaders, state, draw, &mut ()),
        Err(_) => Counts::default(),
    }
}

/// Draws with any shaders into the stored pixels of a target, and tells an observer what happens:
/// of each primitive its pieces, whether they have stored pixels or not.
pub fn draw_observed(
    target: &mut Target,
    shaders: &dyn Shaders,
    state: &State,
    draw: &Draw<'_>,
    observer: &mut dyn Observer,
) -> Counts {
    let Some(mut pass) = Pass::new(target, shaders, state, draw.bindings, observer) else {
        return Counts::default();
    };
    for instance in draw.instances.clone() {
        for run in draw_runs(state, draw) {
            let shade = |at: u32| shade_vertex(shaders, draw, at, instance);
            pass.run(&run, instance, shade);
        }
    }
    pass.counts
}

/// The runs of a draw's positions without a restart between them.
pub(crate) fn draw_runs(state: &State, draw: &Draw<'_>) -> Vec<Range<u32>> {
    let count = draw.vertices.end.saturating_sub(draw.vertices.start);
    match draw.indices {
        Some(_) if state.primitive.primitive_restart => runs(count, |at| draw.is_restart(at)),
        _ => std::iter::once(0..count).collect(),
    }
}

/// Draws vertices that tessellation or a geometry shader made, a list of the points, lines or
/// triangles of the state's topology, with the fragment shader of `shader`.
pub fn draw_vertices<S: Shader>(
    target: &mut Target,
    shader: &S,
    state: &State,
    bindings: &Bindings,
    vertices: &[ClipVertex],
) -> Counts {
    let Ok(shaders) = RustShaders::new(shader) else {
        return Counts::default();
    };
    draw_vertices_observed(target, &shaders, state, bindings, vertices, &mut ())
}

/// Draws as [`draw_vertices`] does, with any shaders, and tells an observer what happens. The
/// positions of a primitive are those in the list.
pub fn draw_vertices_observed(
    target: &mut Target,
    shaders: &dyn Shaders,
    state: &State,
    bindings: &Bindings,
    vertices: &[ClipVertex],
    observer: &mut dyn Observer,
) -> Counts {
    let Some(mut pass) = Pass::new(target, shaders, state, bindings, observer) else {
        return Counts::default();
    };
    let count = u32::try_from(vertices.len()).unwrap_or(u32::MAX);
    pass.run(&(0..count), 0, |at| vertices[at as usize].clone());
    pass.counts
}

/// The state that all primitives of a draw share.
struct Pass<'a> {
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
    counts: Counts,
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
    fn new(
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
    fn run(&mut self, run: &Range<u32>, instance: u32, shade: impl Fn(u32) -> ClipVertex) {
        let PrimitiveState {
            topology,
            provoking_vertex: mode,
            ..
        } = self.state.primitive;
        let shade = |at: u32| shade(run.start + at);
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
                    let ends = at.map(&shade);
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
                    let corners = at.map(&shade);
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

    fn line(&mut self, ends: &[ClipVertex; 2], parent: Option<Parent<'_>>) {
        let Some(kept) = clip_line(ends, &self.viewport) else {
            return;
        };
        let [start, end] = kept
            .each_ref()
            .map(|vertex| moved(self.viewport.place(vertex), parent));
        self.counts.rasterized += 1;
        self.observer
            .piece(&[start.clone(), end.clone()], face_of(parent));
        let provoking = match self.state.primitive.provoking_vertex {
            ProvokingVertex::First => &ends[0],
            ProvokingVertex::Last => &ends[1],
        };
        let flat = parent.map_or(&provoking.varyings[..], |parent| parent.flat);
        if self.state.primitive.line.rasterization == LineRasterization::Bresenham {
            self.columns([&start, &end], flat, face_of(parent));
        } else {
            self.rectangle([&start, &end], flat, face_of(parent));
        }
    }

    /// Draws a Bresenham line: columns of pixels.
    fn columns(&mut self, ends: [&WindowVertex; 2], flat: &[f32], face: Face) {
        let [start, end] = ends.map(|end| end.snapped);
        let path = LinePath::new(start, end);
        let line = self.state.primitive.line;
        let width = whole_width(line.width);
        // A line covers all samples of its pixels.
        let all_samples = all_samples(self.target.samples);
        let stipple = self.stipple;
        let quads: Vec<_> = path
            .widened(width)
            .wide_pixels(width, &self.bounds)
            .into_iter()
            .filter(|(column, _)| shows(line.stipple, stipple + u64::from(*column)))
            .map(|(_, [x, y])| {
                let mut samples = [0; 4];
                samples[(x % 2 + 2 * (y % 2)) as usize] = all_samples;
                QuadCoverage {
                    origin: [x - x % 2, y - y % 2],
                    samples,
                }
            })
            .collect();
        self.stipple += u64::from(path.length());
        let interface = self.interface;
        let surface = LineSurface {
            path,
            ends,
            modes: &interface.varyings,
            flat,
        };
        self.fragments(&quads, &surface, face);
    }

    /// Draws a rectangular line.
    fn rectangle(&mut self, ends: [&WindowVertex; 2], flat: &[f32], face: Face) {
        let [start, end] = ends.map(|end| end.snapped);
        let line = self.state.primitive.line;
        let rectangle = LineRectangle::new(start, end, line.width);
        let is_smooth = line.rasterization == LineRasterization::RectangularSmooth;
        let samples = self.target.samples;
        let mut quads = if is_smooth {
            rectangle.cover_smooth(&self.bounds, samples)
        } else {
            rectangle.cover(&self.bounds, samples)
        };
        for quad in &mut quads {
            for lane in 0..4 {
                let along = rectangle.distance_65536(QuadCoverage::pixel(quad.origin, lane));
                if !shows(line.stipple, (self.stipple + along) / 65_536) {
                    quad.samples[lane] = 0;
                }
            }
        }
        self.stipple += rectangle.length_65536();
        let interface = self.interface;
        let surface = RectangleSurface {
            rectangle,
            ends,
            modes: &interface.varyings,
            flat,
            is_smooth,
        };
        self.fragments(&quads, &surface, face);
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

    /// Shades quads, per pixel or per sample.
    fn fragments(&mut self, quads: &[QuadCoverage], surface: &dyn Surface, face: Face) {
        let samples = self.target.samples;
        let inside = self.viewport_samples.clone();
        let kept = |pixel: [u32; 2], covered: u16| {
            let mut kept = 0;
            for (s, &position) in sample_positions(samples).iter().enumerate() {
                let at = raster::sample_subpixel(pixel.map(i64::from), position);
                let is_masked = self.state.sample_mask >> s & 1 == 1;
                kept |= u16::from(is_masked && inside.contains(at)) << s;
            }
            covered & kept
        };
        let kept = |quad: &QuadCoverage| {
            [0, 1, 2, 3]
                .map(|lane| kept(QuadCoverage::pixel(quad.origin, lane), quad.samples[lane]))
        };
        let coverages: Vec<[u16; 4]> = quads.iter().map(kept).collect();
        for (quad, coverage) in quads.iter().zip(coverages) {
            let whole = Invocation {
                origin: quad.origin,
                coverage,
                samples,
                sample: None,
                front_facing: face == Face::Front,
            };
            if self.is_by_sample {
                for sample in 0..samples {
                    let sample = Some(sample);
                    self.shade(&Invocation { sample, ..whole }, surface, face);
                }
            } else {
                self.shade(&whole, surface, face);
            }
        }
    }

    /// Runs the fragment shader once on a quad, unless no sample of it is covered, and passes the
    /// results to the per-sample operations.
    fn shade(&mut self, invocation: &Invocation, surface: &dyn Surface, face: Face) {
        let kept = [0, 1, 2, 3].map(|lane| invocation.samples_of(lane));
        if kept == [0; 4] {
            return;
        }
        let viewport = self.viewport;
        let clamp_depth = |depth| viewport.clamp_depth(depth);
        let (shaders, interface) = (self.shaders, self.interface);
        let shaded = shade_quad(shaders, self.bindings, surface, invocation, clamp_depth);
        for (lane, mut fragment) in shaded.into_iter().enumerate() {
            let pixel = QuadCoverage::pixel(invocation.origin, lane);
            if let Some(factor) = surface.alpha(pixel) {
                for [_, _, _, alpha] in &mut fragment.colors {
                    *alpha *= factor;
                }
            }
            let fragment = &fragment;
            let covered = kept[lane];
            self.counts.fragments += u64::from(covered != 0);
            self.counts.samples_covered += u64::from(covered.count_ones());
            let stored = if fragment.is_discarded {
                0
            } else {
                covered & per_sample::kept_samples(fragment, self.state, self.target)
            };
            if covered != 0 {
                self.observer.fragment(&FragmentEvent {
                    pixel,
                    lane,
                    invocation,
                    covered,
                    stored,
                    surface,
                    bindings: self.bindings,
                    clamp_depth: &clamp_depth,
                    fragment,
                });
            }
            for (s, &sample) in (0u32..).zip(sample_positions(invocation.samples)) {
                if stored >> s & 1 == 0 {
                    continue;
                }
                let interpolated = clamp_depth(surface.depth(pixel, sample));
                let depth = sample_depth(interface.depth_output, fragment.depth, interpolated);
                let index = self.target.index(pixel, s);
                let before = self
                    .observer
                    .wants(pixel)
                    .then(|| self.target.sample(index));
                let outcome =
                    per_sample::store_sample(self.target, index, self.state, face, depth, fragment);
                if let Some(before) = before {
                    self.observer.sample(SampleEvent {
                        sample: s,
                        depth: self.target.quantised(depth),
                        outcome,
                        before,
                        after: self.target.sample(index),
                    });
                }
                self.counts.samples_passed += u64::from(outcome == Outcome::Passed);
            }
        }
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

/// The number of pixels in a column of a line of this width: ⌊w + ½⌋, at least 1.
fn whole_width(width: f32) -> i64 {
    let halves = f64::from(width) * 2.0;
    // ⌊w + ½⌋ is the greatest n with 2n − 1 ≤ 2w.
    (1..=64)
        .rev()
        .find(|&n: &i32| f64::from(2 * n - 1) <= halves)
        .unwrap_or(1)
        .into()
}

/// Returns true if a stipple pattern draws fragment `number` of the line.
fn shows(stipple: Option<LineStipple>, number: u64) -> bool {
    stipple.is_none_or(|LineStipple { factor, pattern }| {
        let bit = number / u64::from(factor) % 16;
        pattern & 1 << bit != 0
    })
}
