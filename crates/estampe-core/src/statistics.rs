//! The statistics of a pass: counts of each stage and the time that they took.

use crate::tile_path::PathCounts;
use std::time::Duration;

/// Counts and times of one render pass. Counts do not depend on the SIMD level, but for those of
/// fragments and runs, and not on threads, but for those of tiles and of what is done in each tile,
/// as several threads draw small targets in smaller tiles; times depend on both.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Vertices that went through the vertex shader.
    pub vertices_shaded: u64,
    /// Patches whose control points were made.
    pub patches: u64,
    /// Vertices that tessellation evaluated.
    pub evaluations: u64,
    /// Invocations of geometry shaders.
    pub geometry_invocations: u64,
    /// Primitives that geometry shaders emitted.
    pub geometry_primitives: u64,
    /// Primitives that the draws name; of draws with tessellation or a geometry shader, those that
    /// the last of these stages made.
    pub primitives_in: u64,
    /// Primitives that were cut, or dropped whole, by the view volume's planes.
    pub primitives_clipped: u64,
    /// Triangles dropped for facing away, having no area or covering no sample.
    pub primitives_culled: u64,
    /// Primitives that were set up and binned, clipping's pieces counted one by one.
    pub primitives_binned: u64,
    /// Tiles that several threads drew the dearest first.
    #[doc(hidden)]
    pub tiles_by_cost: u64,
    /// Bands of tiles that were drawn one after the other, as the bins of all tiles would have
    /// taken much memory.
    #[doc(hidden)]
    pub bands_of_tiles: u64,
    /// Triangles whose positions were gathered in pairs of words, where the processor is fast at
    /// it. They depend on the SIMD level.
    #[doc(hidden)]
    pub triangles_gathered_in_pairs: u64,
    /// Lines that were set up and binned sixteen at a time.
    #[doc(hidden)]
    pub lines_in_packets: u64,
    /// Fragments that went through the fragment shader, helper lanes not counted.
    pub fragments_shaded: u64,
    /// Of these, those that took the colours that the shader gave for other pixels of the same
    /// primitive, or of another with the same varyings, over which nothing varies.
    pub fragments_of_shared_colors: u64,
    /// Fragments that share packets with those of other small triangles; and these packets. They
    /// depend on the SIMD level.
    #[doc(hidden)]
    pub fragments_across_triangles: [u64; 2],
    /// Fragments of visible triangles that filled packets pixel by pixel. They depend on the SIMD
    /// level.
    #[doc(hidden)]
    pub fragments_by_pixels: u64,
    /// Of these, those that were found triangle by triangle, in the packets that each had touched.
    /// They depend on the SIMD level.
    #[doc(hidden)]
    pub fragments_by_triangle: u64,
    /// Quads that were shaded in packets together with those of other triangles of a run. They
    /// depend on the SIMD level.
    #[doc(hidden)]
    pub quads_across_triangles: u64,
    /// Covered samples of small triangles that were tested as lists. They depend on the SIMD level.
    #[doc(hidden)]
    pub small_triangle_pixels: u64,
    /// Fragments of small triangles that were drawn in order as lists; and the packets that these
    /// began. They depend on the SIMD level.
    #[doc(hidden)]
    pub fragments_listed_in_order: [u64; 2],
    /// Fragments that were not shaded, because no alpha that their texture has there keeps them or
    /// covers a sample; with them helper invocations. They depend on the SIMD level.
    #[doc(hidden)]
    pub fragments_failing_alpha: u64,
    /// Packets of which shading left few fragments, and the packets that these were moved to before
    /// they were tested and written. They depend on the SIMD level.
    #[doc(hidden)]
    pub packets_of_survivors: [u64; 2],
    /// Fragments of lines that became visible among the triangles of a run, to be stored when it
    /// ends. They depend on the SIMD level.
    #[doc(hidden)]
    pub line_fragments_shown: u64,
    /// Triangles that were drawn alone, in order, whose planes had been made together with those of
    /// others, once for each tile. They depend on the SIMD level.
    #[doc(hidden)]
    pub planes_in_lanes: u64,
    /// Rectangles of two triangles that were drawn in order as one box, once for each tile. They
    /// depend on the SIMD level.
    #[doc(hidden)]
    pub rectangles_in_order: u64,
    /// Those of them that were not listed with others, but covered alone. They depend on the SIMD
    /// level.
    #[doc(hidden)]
    pub boxes_in_order: u64,
    /// Packets of one colour for which the program was not run, because it had been for the same
    /// varyings.
    #[doc(hidden)]
    pub colors_kept: u64,
    /// Fragments of one colour whose new codes were lines through the stored ones. They depend on
    /// the SIMD level.
    #[doc(hidden)]
    pub fragments_blended_by_lines: u64,
    /// Runs that are drawn in order whose fragments shared the queue with those of the run before.
    #[doc(hidden)]
    pub queues_kept: u64,
    /// Large triangles whose edges were set up sixteen at a time, once for each tile. They depend
    /// on the SIMD level.
    #[doc(hidden)]
    pub triangles_set_up_in_lanes: u64,
    /// Triangles that were covered together with those of other packets, once for each tile.
    #[doc(hidden)]
    pub triangles_gathered_in_tiles: u64,
    /// Packets that were blended from planes; their layers; and of these, those that were no
    /// estimates. They depend on the SIMD level.
    #[doc(hidden)]
    pub layers_blended: [u64; 3],
    /// Packets of triangles that change stencil values, in which all of the triangle was known to
    /// fail the depth test. They depend on the SIMD level.
    #[doc(hidden)]
    pub packets_failing_depth: u64,
    /// Triangles whose pixels were written together with those of another one before, which had the
    /// same colour everywhere, counted once for each tile that they touch.
    pub triangles_gathered: u64,
    /// Triangles of one colour that shared sides and were covered as one polygon, once for each
    /// tile. They depend on the SIMD level.
    #[doc(hidden)]
    pub triangles_in_fans: u64,
    /// Runs of opaque triangles, tile by tile, whose visible samples were shaded at the run's end:
    /// hidden fragments are not shaded. None at the scalar level.
    pub visibility_runs: u64,
    /// Primitives by the path that drew them, once for each tile that they touch; two triangles
    /// that are drawn as one box are one. They depend on the SIMD level.
    pub paths: PathCounts,
    /// Groups of sub-draws whose geometry was done together.
    #[doc(hidden)]
    pub groups_of_geometry: u64,
    /// Times that tiles were drawn: after all draws, and whenever a batch was full.
    #[doc(hidden)]
    pub batches: u64,
    /// Colour attachments of tiles that were resolved when the tile was drawn.
    #[doc(hidden)]
    pub tiles_resolved: u64,
    /// Tiles that are smaller than others of as many samples, as these were few for the threads.
    #[doc(hidden)]
    pub tiles_for_threads: u64,
    /// Tiles that no primitive reached.
    #[doc(hidden)]
    pub tiles_only_cleared: u64,
    /// Colour attachments of tiles that were stored to images in row order when the tile was drawn.
    #[doc(hidden)]
    pub tiles_to_rows: u64,
    /// Tiles whose depth bounds, for comparisons with them, were found when the tile was drawn.
    #[doc(hidden)]
    pub tiles_bounded: u64,
    /// Tiles of which some attachment was in the memory of a worker alone.
    #[doc(hidden)]
    pub tiles_in_workers: u64,
    /// Tiles of several samples that were drawn in a worker's memory and then stored.
    #[doc(hidden)]
    pub tiles_streamed: u64,
    /// Attachments that had no memory, of which the pass needed more than one tile in a worker.
    #[doc(hidden)]
    pub images_given_memory: u64,
    /// Packets of tiles of which colours were not cleared, as triangles were shown everywhere. They
    /// depend on the SIMD level.
    #[doc(hidden)]
    pub packets_shown_uncleared: u64,
    /// Blocks of 16×16 pixels that show one triangle, whose packets were queued at once. They
    /// depend on the SIMD level.
    #[doc(hidden)]
    pub blocks_queued: u64,
    /// Blocks of 16×16 pixels that were not cleared, as one triangle was shown in all of each. They
    /// depend on the SIMD level.
    #[doc(hidden)]
    pub blocks_uncleared: u64,
    /// Blocks that got the depths of a triangle parallel to the screen, which are equal.
    #[doc(hidden)]
    pub blocks_of_one_depth: u64,
    /// Time of the geometry side.
    pub geometry: Duration,
    /// Time of the tile side.
    pub raster: Duration,
}

impl std::ops::AddAssign for Statistics {
    fn add_assign(&mut self, other: Self) {
        self.vertices_shaded += other.vertices_shaded;
        self.patches += other.patches;
        self.evaluations += other.evaluations;
        self.geometry_invocations += other.geometry_invocations;
        self.geometry_primitives += other.geometry_primitives;
        self.primitives_in += other.primitives_in;
        self.primitives_clipped += other.primitives_clipped;
        self.primitives_culled += other.primitives_culled;
        self.primitives_binned += other.primitives_binned;
        self.tiles_by_cost += other.tiles_by_cost;
        self.bands_of_tiles += other.bands_of_tiles;
        self.triangles_gathered_in_pairs += other.triangles_gathered_in_pairs;
        self.lines_in_packets += other.lines_in_packets;
        self.fragments_shaded += other.fragments_shaded;
        self.fragments_of_shared_colors += other.fragments_of_shared_colors;
        self.line_fragments_shown += other.line_fragments_shown;
        for (counts, others) in [
            (
                &mut self.fragments_across_triangles,
                other.fragments_across_triangles,
            ),
            (
                &mut self.fragments_listed_in_order,
                other.fragments_listed_in_order,
            ),
            (&mut self.packets_of_survivors, other.packets_of_survivors),
        ] {
            for (count, other) in counts.iter_mut().zip(others) {
                *count += other;
            }
        }
        for (count, other) in self.layers_blended.iter_mut().zip(other.layers_blended) {
            *count += other;
        }
        self.small_triangle_pixels += other.small_triangle_pixels;
        self.fragments_failing_alpha += other.fragments_failing_alpha;
        self.rectangles_in_order += other.rectangles_in_order;
        self.planes_in_lanes += other.planes_in_lanes;
        self.boxes_in_order += other.boxes_in_order;
        self.colors_kept += other.colors_kept;
        self.fragments_blended_by_lines += other.fragments_blended_by_lines;
        self.queues_kept += other.queues_kept;
        self.triangles_gathered_in_tiles += other.triangles_gathered_in_tiles;
        self.packets_failing_depth += other.packets_failing_depth;
        self.triangles_set_up_in_lanes += other.triangles_set_up_in_lanes;
        self.triangles_gathered += other.triangles_gathered;
        self.triangles_in_fans += other.triangles_in_fans;
        self.fragments_by_pixels += other.fragments_by_pixels;
        self.fragments_by_triangle += other.fragments_by_triangle;
        self.quads_across_triangles += other.quads_across_triangles;
        self.visibility_runs += other.visibility_runs;
        self.paths += other.paths;
        self.groups_of_geometry += other.groups_of_geometry;
        self.batches += other.batches;
        self.tiles_resolved += other.tiles_resolved;
        self.tiles_for_threads += other.tiles_for_threads;
        self.tiles_only_cleared += other.tiles_only_cleared;
        self.tiles_to_rows += other.tiles_to_rows;
        self.tiles_bounded += other.tiles_bounded;
        self.tiles_in_workers += other.tiles_in_workers;
        self.tiles_streamed += other.tiles_streamed;
        self.images_given_memory += other.images_given_memory;
        self.blocks_uncleared += other.blocks_uncleared;
        self.blocks_of_one_depth += other.blocks_of_one_depth;
        self.packets_shown_uncleared += other.packets_shown_uncleared;
        self.blocks_queued += other.blocks_queued;
        self.geometry += other.geometry;
        self.raster += other.raster;
    }
}
