//! What the stages made of a pass, as plain data.

use super::bins::Binning;
use crate::inspect::{PieceVertex, PrimitiveKind};
use std::ops::Range;

/// What each stage of the pipeline made of a pass.
#[derive(Debug, Clone, PartialEq)]
pub struct PassStages {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples per pixel.
    pub samples: u32,
    /// The vertices that primitives name, each once for each draw and instance, in the order of the
    /// primitives.
    pub vertices: Vec<StageVertex>,
    /// The primitives, in the order of drawing.
    pub primitives: Vec<StagePrimitive>,
    /// What clipping leaves of the primitives, in the order of drawing.
    pub pieces: Vec<StagePiece>,
    /// Side of a tile in pixels: 64, or 32 with several samples.
    pub tile_side: u32,
    /// For each tile, row by row, the number of pieces that are binned to it.
    pub tiles: Vec<u32>,
    /// Counts of each pixel, row by row.
    pub pixels: Vec<PixelCounts>,
    /// What hierarchical z does with each block of 16×16 pixels, row by row.
    pub blocks: Vec<BlockCounts>,
    /// The stored depths after the last draw, 0..=1: all samples of the first pixel, then of the
    /// next, row by row. Empty without a depth attachment.
    pub depths: Vec<f32>,
    /// How the pieces of each draw are binned.
    pub(super) binnings: Vec<Binning>,
}

/// A vertex of a pass, after the vertex shader.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StageVertex {
    /// The number of the draw in the pass.
    pub draw: u32,
    /// The index of the instance.
    pub instance: u32,
    /// The index of the vertex.
    pub index: u32,
    /// The first attribute as it was fetched, usually the position; components that it lacks are 0.
    pub attribute: [f32; 4],
    /// x, y, z, w in clip space.
    pub clip: [f32; 4],
}

/// A primitive as it was assembled, and what clipping did to it.
#[derive(Debug, Clone, PartialEq)]
pub struct StagePrimitive {
    /// The number of the draw in the pass.
    pub draw: u32,
    /// The number of the primitive in the draw, over all instances.
    pub number: u64,
    /// A point, line or triangle.
    pub kind: PrimitiveKind,
    /// The positions of its vertices in [`PassStages::vertices`], as many as the kind has; of a
    /// triangle the provoking one first. The others are 0.
    pub vertices: [u32; 3],
    /// What clipping did.
    pub clipped: ClipOutcome,
    /// Of a filled triangle that was clipped, the polygon that is left.
    pub polygon: Vec<PolygonVertex>,
    /// Its pieces in [`PassStages::pieces`]. Triangles without area have none.
    pub pieces: Range<u32>,
}

impl StagePrimitive {
    /// The positions of its vertices in [`PassStages::vertices`].
    #[must_use]
    pub fn vertices(&self) -> &[u32] {
        &self.vertices[..self.kind.corners()]
    }
}

/// What clipping does to a primitive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ClipOutcome {
    /// It is drawn as it is: it lies between the depth planes and inside the guard band.
    Inside,
    /// A part of it is left.
    Clipped,
    /// Nothing is left: it lies outside of a plane, its cull distances are negative, or its numbers
    /// are not finite.
    Dropped,
}

/// A vertex of a clipped polygon.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PolygonVertex {
    /// The vertex in the window.
    pub window: PieceVertex,
    /// True if clipping made the vertex.
    pub is_new: bool,
    /// True if the edge from here to the next vertex runs along a clip plane: clipping made it.
    pub is_cut: bool,
}

/// A point, line or triangle that reaches the rasterizer, or is culled before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StagePiece {
    /// The position of its primitive in [`PassStages::primitives`].
    pub primitive: u32,
    /// Its kind: lines and points of triangles that are drawn as such are those.
    pub kind: PrimitiveKind,
    /// Its vertices in the window, as many as the kind has; the others are the first one again.
    pub vertices: [PieceVertex; 3],
    /// True if it is front facing; lines and points are.
    pub front_facing: bool,
    /// True if its facing is culled.
    pub is_culled: bool,
    /// How far it reaches beyond its vertices, in pixels: half the width of a line or point, and at
    /// most a pixel more; 0 of triangles.
    pub margin: f32,
}

impl StagePiece {
    /// Its vertices in the window.
    #[must_use]
    pub fn vertices(&self) -> &[PieceVertex] {
        &self.vertices[..self.kind.corners()]
    }
}

impl PrimitiveKind {
    /// The number of its vertices.
    #[must_use]
    pub fn corners(self) -> usize {
        match self {
            Self::Point => 1,
            Self::Line => 2,
            Self::Triangle => 3,
        }
    }
}

/// What happened at a pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PixelCounts {
    /// Pieces that cover a sample: the depth complexity, or overdraw.
    pub covered: u32,
    /// Runs of the fragment shader: one for each piece, or for each sample of it.
    pub shaded: u32,
    /// Runs that the shader discarded.
    pub discarded: u32,
    /// Samples that failed the depth-bounds test.
    pub failed_depth_bounds: u32,
    /// Samples that failed the stencil test.
    pub failed_stencil: u32,
    /// Samples that failed the depth test.
    pub failed_depth: u32,
    /// Samples that passed every test.
    pub passed: u32,
    /// Pieces whose colour was stored or blended to a sample: of draws that write a channel of a
    /// colour attachment.
    pub stored: u32,
    /// The last piece of which a sample passed every test, as its position in
    /// [`PassStages::pieces`].
    pub visible: Option<u32>,
}

/// What hierarchical z does with the pieces that cover a block of 16×16 pixels.
///
/// This is the rule of the fast pipeline, not a count of its work: a triangle is rejected in a
/// block if its depth nearest to the eye there (its plane at the samples of the block's corners,
/// clamped and rounded as stored depths are) fails against all depths that are stored in the block
/// when it is drawn. The comparison is less, less or equal, greater, greater or equal, or never;
/// the shader writes no depth and stores nothing, and the failing stencil operations keep. The fast
/// pipeline draws large triangles nearest first and tests small ones by their pixels alone, so it
/// may reject other blocks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct BlockCounts {
    /// Triangles that cover a sample of the block and have a depth test.
    pub tested: u32,
    /// Those of them that are rejected.
    pub rejected: u32,
}

impl PassStages {
    /// The number of columns and rows of tiles.
    #[must_use]
    pub fn tile_columns_rows(&self) -> [u32; 2] {
        self.size.map(|side| side.div_ceil(self.tile_side))
    }

    /// The number of columns and rows of blocks of 16×16 pixels.
    #[must_use]
    pub fn block_columns_rows(&self) -> [u32; 2] {
        self.size.map(|side| side.div_ceil(16))
    }

    /// The counts of a pixel, column and row from the top left; `None` outside.
    #[must_use]
    pub fn pixel(&self, [x, y]: [u32; 2]) -> Option<&PixelCounts> {
        let [width, height] = self.size;
        let at = y as usize * width as usize + x as usize;
        (x < width && y < height).then(|| &self.pixels[at])
    }

    /// Fills [`PassStages::tiles`].
    pub(super) fn count_tiles(&mut self) {
        let [columns, rows] = self.tile_columns_rows();
        let mut tiles = vec![0; columns as usize * rows as usize];
        for piece in &self.pieces {
            let draw = self.primitives[piece.primitive as usize].draw;
            self.binnings[draw as usize].each_tile(piece, |tile| tiles[tile as usize] += 1);
        }
        self.tiles = tiles;
    }

    /// The tiles that a piece is binned to, as positions in [`tiles`](Self::tiles); none if it is
    /// culled.
    ///
    /// This is the rule of the fast pipeline: the tiles in which the piece's box holds a sample,
    /// without those that lie outside of one edge of a triangle. (It also omits triangles that
    /// cover no sample at all.)
    #[must_use]
    pub fn tiles_of(&self, piece: &StagePiece) -> Vec<u32> {
        let draw = self.primitives[piece.primitive as usize].draw;
        let mut tiles = Vec::new();
        self.binnings[draw as usize].each_tile(piece, |tile| tiles.push(tile));
        tiles
    }

    /// The barycentric coordinates of a pixel's centre in the visible piece, in the order of its
    /// vertices in the window (without perspective): they sum to 1, and at edges one may be
    /// negative where a sample beside the centre is covered. `None` if nothing is visible, or it is
    /// no triangle.
    #[must_use]
    pub fn barycentrics(&self, pixel: [u32; 2]) -> Option<[f64; 3]> {
        let piece = &self.pieces[self.pixel(pixel)?.visible? as usize];
        if piece.kind != PrimitiveKind::Triangle {
            return None;
        }
        let [x, y] = pixel.map(|at| f64::from(at) + 0.5);
        let corners = piece.vertices.map(|vertex| vertex.position.map(f64::from));
        let twice_area =
            |a: [f64; 2], b: [f64; 2]| (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
        let [a, b, c] = corners;
        // Exact: positions are multiples of 1/256 below 2¹⁵.
        let areas = [twice_area(b, c), twice_area(c, a), twice_area(a, b)];
        let sum: f64 = areas.iter().sum();
        Some(areas.map(|area| area / sum))
    }
}
