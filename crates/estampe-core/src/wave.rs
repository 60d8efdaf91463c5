//! Waves: runs of draws that are processed together, and the items they are made of.
//!
//! A draw (or a part of one, where it is large) is an [`Item`]: a dense range of vertices that is shaded
//! once, and the primitives between them. A wave holds items up to a budget of vertices and primitives,
//! so that memory is bounded whatever is drawn; most passes are one wave.

use crate::attachment::RenderTarget;
use crate::commands::Draw;
use crate::geometry::assembly::{PrimitiveKind, kind_of, primitive_count, vertex_index};
use crate::geometry::chunk::ItemVertices;
use crate::geometry::cull::Facing;
use crate::geometry::depth_bias::DepthBias;
use crate::geometry::restart::{RestartCursor, RestartSource};
use crate::geometry::shading::{ShadedSlice, ShadedVertices, VertexSource};
use crate::geometry::viewport::{PixelRect, ViewportTransform};
use crate::per_sample::color::ColorTarget;
use crate::per_sample::general::DepthFormat;
use crate::schedule::Executor;
use crate::tile_pass::{MAX_TARGETS, TileItem};
use estampe_types::state::{PolygonMode, PrimitiveTopology, Viewport};
use estampe_types::{Bindings, Interpolation};
use std::ops::Range;

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

/// A draw's elements, if its indices may restart primitives.
fn restart_source<'a>(draw: &Draw<'a>) -> Option<RestartSource<'a>> {
    let state = &draw.pipeline.descriptor().primitive;
    let (buffer, format) = draw.indices.filter(|_| state.primitive_restart)?;
    let count = draw.elements.end.saturating_sub(draw.elements.start);
    Some(RestartSource {
        topology: state.topology,
        provoking: state.provoking_vertex,
        buffer,
        format,
        base_vertex: draw.base_vertex,
        elements: [draw.elements.start, count],
    })
}

/// Numbers the vertices of listed primitives: as a range that holds all of them, from its first one on, or one by
/// one where that range is sparse.
fn list_vertices(corners: &mut [[u32; 3]]) -> (u32, u32, Option<Vec<u32>>) {
    let all = corners.as_flattened_mut();
    let (Some(&least), Some(&greatest)) = (all.iter().min(), all.iter().max()) else {
        return (0, 0, None);
    };
    let count = all.len() as u64;
    let span = u64::from(greatest - least) + 1;
    if span <= count * SPARSE_FACTOR {
        all.iter_mut().for_each(|vertex| *vertex -= least);
        return (least, u32::try_from(span).unwrap_or(u32::MAX), None);
    }
    let sparse: Vec<u32> = all.to_vec();
    for (number, vertex) in (0..).zip(all) {
        *vertex = number;
    }
    let count = u32::try_from(sparse.len()).unwrap_or(u32::MAX);
    (0, count, Some(sparse))
}

/// How many elements a draw has. Fans, loops and stippled strips cannot be cut into items, so that they end at
/// [`MAX_WHOLE_ELEMENTS`].
fn element_count(draw: &Draw<'_>) -> u32 {
    let count = draw.elements.end.saturating_sub(draw.elements.start);
    if is_splittable(draw) {
        count
    } else {
        count.min(MAX_WHOLE_ELEMENTS)
    }
}

/// Whether a run of a draw's primitives is a run of elements of the same topology, drawn like any other.
fn is_splittable(draw: &Draw<'_>) -> bool {
    let topology = draw.pipeline.descriptor().primitive.topology;
    !matches!(
        topology,
        PrimitiveTopology::TriangleFan | PrimitiveTopology::LineLoop
    ) && !is_stippled_strip(draw)
}

/// Whether each line of a topology goes on where the one before ended.
pub(crate) fn is_line_strip(topology: PrimitiveTopology) -> bool {
    matches!(
        topology,
        PrimitiveTopology::LineStrip
            | PrimitiveTopology::LineLoop
            | PrimitiveTopology::LineStripAdjacency
    )
}

fn is_stippled_strip(draw: &Draw<'_>) -> bool {
    let state = &draw.pipeline.descriptor().primitive;
    state.line.stipple.is_some() && is_line_strip(state.topology)
}

/// The elements (first, count) of `count` primitives from `first` on. `ITEM_PRIMITIVES` is even, so a
/// strip's parts begin on triangles that are not turned.
fn part_of(topology: PrimitiveTopology, first: u32, count: u32, whole: u32) -> [u32; 2] {
    use PrimitiveTopology as T;
    let [each, more] = match topology {
        T::PointList => [1, 0],
        T::LineList => [2, 0],
        T::LineStrip => [1, 1],
        T::TriangleList => [3, 0],
        T::TriangleStrip => [1, 2],
        T::LineListAdjacency => [4, 0],
        T::LineStripAdjacency => [1, 3],
        T::TriangleListAdjacency => [6, 0],
        T::TriangleStripAdjacency => [2, 4],
        T::LineLoop | T::TriangleFan => return [0, whole],
    };
    [first * each, count * each + more]
}

/// The range of vertices that elements name (first, count), or a list of them if the range is sparse.
fn vertex_range(
    executor: &Executor,
    draw: &Draw<'_>,
    first: u32,
    count: u32,
) -> (u32, u32, Option<Vec<u32>>) {
    let Some((buffer, format)) = draw.indices else {
        return (first, count, None);
    };
    let index = |element: u32| {
        let at = first as usize + element as usize;
        vertex_index(buffer, format, at, draw.base_vertex)
    };
    let (from, to) = (first as usize, first as usize + count as usize);
    let words = buffer.words().get(from..to);
    let words = words.filter(|_| format == estampe_types::IndexFormat::Uint32);
    // The common case in a form that becomes SIMD code.
    let of_words = words.and_then(|words| {
        let (least, greatest) = extremes(executor, words)?;
        let base = draw.base_vertex;
        Some((
            least.checked_add_signed(base)?,
            greatest.checked_add_signed(base)?,
        ))
    });
    let (least, greatest) = of_words.unwrap_or_else(|| {
        let wider =
            |(least, greatest): (u32, u32), index: u32| (least.min(index), greatest.max(index));
        (0..count).map(index).fold((u32::MAX, 0), wider)
    });
    if count == 0 {
        return (0, 0, None);
    }
    let span = u64::from(greatest - least) + 1;
    if span <= u64::from(count) * SPARSE_FACTOR {
        return (least, u32::try_from(span).unwrap_or(u32::MAX), None);
    }
    (0, count, Some((0..count).map(index).collect()))
}

/// Indices that one worker looks through at a time.
const INDEX_CHUNK: usize = 1 << 16;

/// The least and the greatest of some indices. A million triangles have 12 MB of them, which one thread
/// alone reads no faster than memory gives them to it.
fn extremes(executor: &Executor, words: &[u32]) -> Option<(u32, u32)> {
    let of_part = |words: &[u32]| {
        let (mut least, mut greatest) = (u32::MAX, 0);
        for &word in words {
            least = least.min(word);
            greatest = greatest.max(word);
        }
        (least, greatest)
    };
    if words.is_empty() {
        return None;
    }
    if words.len() <= INDEX_CHUNK {
        return Some(of_part(words));
    }
    let mut parts: [(&[u32], (u32, u32)); 64] = [(&[], (u32::MAX, 0)); 64];
    let each = words.len().div_ceil(parts.len());
    let mut used = 0;
    for (part, words) in parts.iter_mut().zip(words.chunks(each)) {
        part.0 = words;
        used += 1;
    }
    executor.for_each_alone(&mut parts[..used], |(words, found)| *found = of_part(words));
    let wider = |a: (u32, u32), b: (u32, u32)| (a.0.min(b.0), a.1.max(b.1));
    parts.iter().map(|part| part.1).reduce(wider)
}

/// A run of an item's vertices for one worker.
#[derive(Debug)]
pub(crate) struct VertexJob<'a> {
    pub(crate) item: usize,
    /// The first of them, counted in the item.
    pub(crate) first: u32,
    pub(crate) out: ShadedSlice<'a>,
}

impl ShadedVertices {
    /// Makes room for the vertices of a wave.
    pub(crate) fn resize_for(&mut self, items: &[Item<'_>]) {
        let vertices: usize = items.iter().map(|item| item.total_vertices()).sum();
        let varyings = items
            .iter()
            .map(|item| item.total_vertices() * item.varying_scalars)
            .sum();
        let has_sizes = |item: &Item<'_>| item.draw.pipeline.interface().writes_point_size;
        let sizes = if items.iter().any(has_sizes) {
            vertices
        } else {
            0
        };
        grow(&mut self.window, vertices, [0; 4]);
        if items.iter().any(Item::keeps_positions) {
            grow(&mut self.clip, vertices, [0; 4]);
        }
        grow(&mut self.varyings, varyings, 0.0);
        self.point_size.resize(sizes, 0.0);
    }

    /// Cuts the wave's vertices into jobs of at most `size`.
    pub(crate) fn split<'a>(
        &'a mut self,
        items: &[Item<'_>],
        size: usize,
        jobs: &mut Vec<VertexJob<'a>>,
    ) {
        let has_sizes = !self.point_size.is_empty();
        let has_positions = items.iter().any(Item::keeps_positions);
        let mut rest = ShadedSlice {
            window: &mut self.window,
            clip: &mut self.clip,
            varyings: &mut self.varyings,
            point_size: &mut self.point_size,
        };
        for (number, item) in items.iter().enumerate() {
            let interface = item.draw.pipeline.interface();
            let total = item.total_vertices();
            for first in (0..total).step_by(size) {
                let count = size.min(total - first);
                let sizes = if has_sizes { count } else { 0 };
                let mut out = ShadedSlice {
                    window: take(&mut rest.window, count),
                    clip: take(&mut rest.clip, if has_positions { count } else { 0 }),
                    varyings: take(&mut rest.varyings, count * item.varying_scalars),
                    point_size: take(&mut rest.point_size, sizes),
                };
                if !item.keeps_positions() {
                    out.clip = &mut [];
                }
                if !interface.writes_point_size {
                    // Another item of the wave has sizes; this one's points are one pixel.
                    out.point_size.fill(1.0);
                    out.point_size = &mut [];
                }
                let first = u32::try_from(first).unwrap_or(u32::MAX);
                jobs.push(VertexJob {
                    item: number,
                    first,
                    out,
                });
            }
        }
    }

    /// The vertices of one item.
    pub(crate) fn of_item(&self, item: &Item<'_>) -> ItemVertices<'_> {
        let (from, count) = (item.vertex_base, item.total_vertices());
        let scalars = item.varying_scalars;
        ItemVertices {
            window: &self.window[from..][..count],
            clip: if item.keeps_positions() {
                &self.clip[from..][..count]
            } else {
                &[]
            },
            varyings: &self.varyings[item.varying_base..][..count * scalars],
            varying_scalars: scalars,
            point_size: if self.point_size.is_empty() {
                &[]
            } else {
                &self.point_size[from..][..count]
            },
        }
    }

    /// An item as its fragments need it.
    pub(crate) fn tile_item<'a>(
        &'a self,
        item: &'a Item<'_>,
        target: &RenderTarget,
        has_queries: bool,
    ) -> TileItem<'a> {
        let draw = item.draw;
        let key = draw.pipeline.key();
        let depth_format = target.depth_format();
        let is_general = key.is_general
            || draw.depth_bounds.is_some()
            || has_queries && draw.occlusion_query.is_some()
            || key.depth.is_some() && depth_format != DepthFormat::Float;
        let modes = &item.draw.pipeline.interface().varyings;
        TileItem {
            pipeline: item.draw.pipeline,
            bindings: item.bindings,
            varyings: self.of_item(item).varyings,
            rect: item.rect,
            depth_range: item.transform.depth_range,
            targets: item.targets,
            draw,
            depth_format,
            is_general,
            all_smooth: modes.iter().all(|mode| *mode == Interpolation::Smooth),
        }
    }
}

/// Makes a list at least so long; what it held is overwritten. It never shrinks, because zeroing it anew for
/// each wave would cost as much as writing it. Fresh memory is asked for as zeros, which the system has: the
/// threads that shade are then the first to touch it, not this one.
fn grow<T: Clone>(list: &mut Vec<T>, len: usize, zero: T) {
    if list.capacity() < len {
        *list = Vec::new();
        *list = vec![zero; len];
    } else if list.len() < len {
        list.resize(len, zero);
    }
}

/// Takes the first `count` elements off a slice.
fn take<'a, T>(rest: &mut &'a mut [T], count: usize) -> &'a mut [T] {
    let (first, others) = std::mem::take(rest).split_at_mut(count);
    *rest = others;
    first
}
