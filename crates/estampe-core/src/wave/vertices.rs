//! The vertices of a wave: one list for all items, filled by workers in runs.

use super::Item;
use crate::attachment::RenderTarget;
use crate::geometry::chunk::ItemVertices;
use crate::geometry::shading::{ShadedSlice, ShadedVertices};
use crate::per_sample::general::DepthFormat;
use crate::tile_pass::TileItem;
use estampe_types::Interpolation;

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
