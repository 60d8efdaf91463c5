//! Waves: runs of draws that are processed together, and the items they are made of.
//!
//! A draw (or a part of one, where it is large) is an [`Item`]: a dense range of vertices that is shaded
//! once, and the primitives between them. A wave holds items up to a budget of vertices and primitives,
//! so that memory is bounded whatever is drawn; most passes are one wave.

mod elements;
mod vertices;

use crate::attachment::RenderTarget;
use crate::commands::Draw;
use crate::geometry::assembly::{PrimitiveKind, kind_of, primitive_count};
use crate::geometry::cull::Facing;
use crate::geometry::depth_bias::DepthBias;
use crate::geometry::restart::{RestartCursor, RestartSource};
use crate::geometry::shading::VertexSource;
use crate::geometry::viewport::{PixelRect, ViewportTransform};
use crate::per_sample::color::ColorTarget;
use crate::schedule::Executor;
use crate::tile_pass::MAX_TARGETS;
use elements::{
    element_count, is_splittable, is_stippled_strip, list_vertices, part_of, restart_source,
    vertex_range,
};
use estampe_types::Bindings;
use estampe_types::state::{PolygonMode, Viewport};
use std::ops::Range;

pub(crate) use elements::is_line_strip;
pub(crate) use vertices::VertexJob;

/// Vertices or primitives that a wave holds before it is drawn.
const WAVE_BUDGET: usize = 2_000_000;

/// Primitives of one item at most: a larger draw becomes several items.
const ITEM_PRIMITIVES: u32 = 1_000_000;

/// Primitives of a chunk.
const PRIMITIVE_CHUNK: u32 = 4096;

/// Elements of a fan, loop or stippled strip at most: what is beyond is not drawn. Memory for a draw is bounded by it.
const MAX_WHOLE_ELEMENTS: u32 = 1 << 24;

/// How much larger than its number of elements a draw's range of indices may be; beyond, vertices are
/// shaded once for each element.
const SPARSE_FACTOR: u64 = 4;

/// Bindings of draws that have none.
static NO_BINDINGS: Bindings = Bindings { groups: Vec::new() };

/// A draw, or part of one: what is the same for all of its primitives.
#[derive(Debug, Clone)]
pub(crate) struct Item<'a> {
    pub(crate) draw: &'a Draw<'a>,
    pub(crate) bindings: &'a Bindings,
    pub(crate) transform: ViewportTransform,
    pub(crate) rect: PixelRect,
    pub(crate) facing: Facing,
    pub(crate) targets: [Option<ColorTarget>; MAX_TARGETS],
    /// Elements of one instance: first, and how many.
    pub(crate) elements: [u32; 2],
    pub(crate) first_instance: u32,
    pub(crate) instances: u32,
    /// Vertices of one instance: first index, and how many.
    pub(crate) first_vertex: u32,
    pub(crate) vertices: u32,
    /// The vertex index of each element, where the range of indices is sparse.
    pub(crate) sparse: Option<Vec<u32>>,
    /// The item's vertices of each primitive of an instance, where indices may restart primitives.
    pub(crate) restarted: Option<Vec<[u32; 3]>>,
    /// Those of them that begin a strip of stippled lines, ascending.
    pub(crate) line_restarts: Vec<u32>,
    pub(crate) depth_bias: Option<DepthBias>,
    /// Primitives of one instance.
    pub(crate) primitives: u32,
    /// Scalars of a vertex's varyings.
    pub(crate) varying_scalars: usize,
    /// Where its vertices begin in the wave's.
    pub(crate) vertex_base: usize,
    /// Where its varyings begin in the wave's.
    pub(crate) varying_base: usize,
}

impl Item<'_> {
    /// Whether clip-space positions of its vertices are kept: all but filled triangles look at them.
    fn keeps_positions(&self) -> bool {
        let state = &self.draw.pipeline.descriptor().primitive;
        kind_of(state.topology) != PrimitiveKind::Triangles
            || state.polygon_mode != PolygonMode::Fill
    }

    /// Primitives of a chunk. Stippled strips are not cut, because each line's pattern goes on where that of the one
    /// before ended.
    pub(crate) fn chunk_primitives(&self) -> u32 {
        if is_stippled_strip(self.draw) {
            self.primitives.max(1)
        } else {
            PRIMITIVE_CHUNK
        }
    }

    /// Where its vertices come from.
    pub(crate) fn vertex_source(&self) -> VertexSource<'_> {
        VertexSource {
            buffers: self.draw.vertex_buffers,
            bindings: self.bindings,
            first_vertex: self.first_vertex,
            count: self.vertices,
            first_instance: self.first_instance,
            base_instance: self.draw.instances.start,
            instances: self.instances,
            sparse: self.sparse.as_deref(),
        }
    }

    /// The same of fewer instances, if all of them had more vertices than a wave should: a triangle can have a dozen,
    /// in each of a million instances.
    fn within_budget(mut self) -> Self {
        let most = WAVE_BUDGET / (self.vertices as usize).max(1);
        let most = u32::try_from(most).unwrap_or(u32::MAX).max(1);
        self.instances = self.instances.min(most);
        self
    }

    pub(crate) fn total_vertices(&self) -> usize {
        (self.vertices as usize).saturating_mul(self.instances as usize)
    }

    pub(crate) fn total_primitives(&self) -> usize {
        (self.primitives as usize).saturating_mul(self.instances as usize)
    }
}

/// Cuts draws into waves of items.
#[derive(Debug)]
pub(crate) struct Waves<'a> {
    draws: std::slice::Iter<'a, Draw<'a>>,
    /// The draw being cut, and which of its primitives and instances are left.
    current: Option<Remainder<'a>>,
}

#[derive(Debug)]
struct Remainder<'a> {
    draw: &'a Draw<'a>,
    rect: PixelRect,
    viewport: Viewport,
    primitives: Range<u32>,
    instances: Range<u32>,
    depth_bias: Option<DepthBias>,
    /// Where indices may restart primitives: how far these were looked for in the instance at hand.
    restart: RestartCursor,
}

impl<'a> Waves<'a> {
    pub(crate) fn new(draws: &'a [Draw<'a>]) -> Self {
        Self {
            draws: draws.iter(),
            current: None,
        }
    }

    /// The next wave's items, into `items`; false when there are no more.
    pub(crate) fn next_wave(
        &mut self,
        executor: &Executor,
        target: &RenderTarget,
        items: &mut Vec<Item<'a>>,
    ) -> bool {
        items.clear();
        let (mut vertices, mut primitives, mut varyings) = (0, 0, 0);
        while vertices < WAVE_BUDGET && primitives < WAVE_BUDGET {
            let Some(mut remainder) = self.current.take().or_else(|| self.next_draw(target)) else {
                break;
            };
            let mut item = remainder.take_item(executor);
            item.vertex_base = vertices;
            item.varying_base = varyings;
            let (item_vertices, item_primitives) = (item.total_vertices(), item.total_primitives());
            if item_primitives > 0 {
                vertices += item_vertices;
                primitives += item_primitives;
                varyings += item_vertices * item.varying_scalars;
                items.push(item);
            }
            if !remainder.is_done() {
                self.current = Some(remainder);
            }
        }
        !items.is_empty()
    }

    /// The next draw that can show anything.
    fn next_draw(&mut self, target: &RenderTarget) -> Option<Remainder<'a>> {
        loop {
            let draw = self.draws.next()?;
            if !fits(target, draw) {
                continue;
            }
            let (width, height) = (target.width(), target.height());
            let viewport = draw.viewport.unwrap_or(Viewport {
                x: 0.0,
                y: 0.0,
                width: width as f32,
                height: height as f32,
                min_depth: 0.0,
                max_depth: 1.0,
            });
            if !is_valid(&viewport) {
                continue;
            }
            let rect = PixelRect::new(&viewport, draw.scissor, width, height);
            let topology = draw.pipeline.descriptor().primitive.topology;
            let elements = element_count(draw);
            let primitives = 0..primitive_count(topology, elements);
            if rect.is_empty() || primitives.is_empty() || draw.instances.is_empty() {
                continue;
            }
            let instances = draw.instances.clone();
            return Some(Remainder {
                draw,
                rect,
                viewport,
                primitives,
                instances,
                depth_bias: DepthBias::new(
                    &draw.pipeline.descriptor().depth_bias,
                    target.depth_stencil_format(),
                ),
                restart: RestartCursor::default(),
            });
        }
    }
}

/// Whether a draw's pipeline is made for such a target.
fn fits(target: &RenderTarget, draw: &Draw<'_>) -> bool {
    let descriptor = draw.pipeline.descriptor();
    let formats = descriptor.targets.iter().map(|target| target.format);
    let depth_fits = target.has_depth() || draw.pipeline.key().depth.is_none();
    let stencil_fits = target.has_stencil() || descriptor.stencil.is_none();
    descriptor.samples == target.samples()
        && formats.eq(target.color_formats().iter().copied())
        && depth_fits
        && stencil_fits
}

/// A viewport that the arithmetic can stand: finite, with area, its depths in 0..=1.
fn is_valid(viewport: &Viewport) -> bool {
    let Viewport {
        x,
        y,
        width,
        height,
        min_depth,
        max_depth,
    } = *viewport;
    let range = -32_768.0..=32_767.0;
    range.contains(&x)
        && range.contains(&y)
        && width > 0.0
        && height > 0.0
        && width <= 32_768.0
        && height <= 32_768.0
        && (0.0..=1.0).contains(&min_depth)
        && (0.0..=1.0).contains(&max_depth)
}

impl<'a> Remainder<'a> {
    fn is_done(&self) -> bool {
        self.instances.is_empty()
    }

    /// Takes the next item off: many instances of a small draw, or part of one instance of a large one.
    fn take_item(&mut self, executor: &Executor) -> Item<'a> {
        let draw = self.draw;
        if let Some(source) = restart_source(draw) {
            return self.take_restarted(&source);
        }
        let descriptor = draw.pipeline.descriptor();
        let topology = descriptor.primitive.topology;
        let whole = element_count(draw);
        let all = primitive_count(topology, whole);
        let splittable = is_splittable(draw);
        let (elements, instances);
        if all > ITEM_PRIMITIVES && splittable {
            let count = (self.primitives.end - self.primitives.start).min(ITEM_PRIMITIVES);
            let first = self.primitives.start;
            elements = part_of(topology, first, count, whole);
            instances = 1;
            self.primitives.start += count;
            if self.primitives.is_empty() {
                self.primitives.start = 0;
            } else {
                return self.item(executor, elements, instances);
            }
        } else {
            elements = [0, whole];
            let left = self.instances.end - self.instances.start;
            instances = (ITEM_PRIMITIVES / all.max(1)).clamp(1, left);
        }
        let item = self.item(executor, elements, instances).within_budget();
        self.instances.start += item.instances;
        item
    }

    /// The same where indices may restart primitives.
    fn take_restarted(&mut self, source: &RestartSource<'_>) -> Item<'a> {
        let is_first = self.restart.is_at_start();
        let is_whole = is_stippled_strip(self.draw);
        let mut begins = Vec::new();
        let limit = if is_whole {
            MAX_WHOLE_ELEMENTS
        } else {
            ITEM_PRIMITIVES
        };
        let mut corners = self.restart.take(source, limit, &mut begins);
        if !is_whole {
            begins.clear();
        }
        let is_done = self.restart.is_done(source);
        let primitives = u32::try_from(corners.len()).unwrap_or(u32::MAX);
        let instances = if is_first && is_done {
            let left = self.instances.end - self.instances.start;
            (ITEM_PRIMITIVES / primitives.max(1)).clamp(1, left)
        } else {
            1
        };
        let vertices = list_vertices(&mut corners);
        let item = Item {
            primitives,
            restarted: Some(corners),
            line_restarts: begins,
            ..self.item_of([0, 0], instances, vertices)
        };
        let item = item.within_budget();
        if is_done {
            self.restart = RestartCursor::default();
            self.instances.start += item.instances;
        }
        item
    }

    fn item(&self, executor: &Executor, [first, count]: [u32; 2], instances: u32) -> Item<'a> {
        let first = self.draw.elements.start.saturating_add(first);
        let vertices = vertex_range(executor, self.draw, first, count);
        self.item_of([first, count], instances, vertices)
    }

    fn item_of(
        &self,
        [first_element, count]: [u32; 2],
        instances: u32,
        (first_vertex, vertices, sparse): (u32, u32, Option<Vec<u32>>),
    ) -> Item<'a> {
        let draw = self.draw;
        let descriptor = draw.pipeline.descriptor();
        let mut targets = [None; MAX_TARGETS];
        for (target, state) in targets.iter_mut().zip(&descriptor.targets) {
            *target = Some(ColorTarget::new(state, draw.blend_constant));
        }
        Item {
            draw,
            bindings: draw.bindings.unwrap_or(&NO_BINDINGS),
            transform: ViewportTransform::new(&self.viewport, descriptor.primitive.unclipped_depth),
            rect: self.rect,
            facing: Facing::new(&descriptor.primitive),
            targets,
            elements: [first_element, count],
            first_instance: self.instances.start,
            instances,
            first_vertex,
            vertices,
            sparse,
            restarted: None,
            line_restarts: Vec::new(),
            depth_bias: self.depth_bias,
            primitives: primitive_count(descriptor.primitive.topology, count),
            varying_scalars: draw.pipeline.interface().varyings.len(),
            vertex_base: 0,
            varying_base: 0,
        }
    }
}
