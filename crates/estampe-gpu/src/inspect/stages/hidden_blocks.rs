//! What hierarchical z rejects, from the stored depths of a band at the moment a triangle is drawn.

use super::pass_stages::BlockCounts;
use estampe_reference::channel::quantised_depth;
use estampe_reference::fragment::Surface;
use estampe_reference::raster::sample_positions;
use estampe_reference::{PixelBounds, State, Target};
use estampe_types::shader::DepthOutput;
use estampe_types::state::{CompareFunction, StencilOperation};
use estampe_types::{Interface, TextureFormat};

/// Side of a block in pixels.
const SIDE: u32 = 16;

/// The stored depths of a band, and their range in each block.
pub(super) struct HiddenBlocks {
    bounds: PixelBounds,
    samples: u32,
    format: Option<TextureFormat>,
    pub(super) depths: Vec<f32>,
    pub(super) counts: Vec<BlockCounts>,
    ranges: Vec<BlockRange>,
}

/// The range of the stored depths of a block.
#[derive(Clone, Copy)]
struct BlockRange {
    least: f32,
    greatest: f32,
    is_stale: bool,
    /// The number of the last piece that was tested.
    piece: u32,
}

/// The comparison by which a draw's triangles are rejected.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Rejection(CompareFunction);

impl Rejection {
    /// `None` if the draw's triangles pass hierarchical z.
    pub(super) fn of_draw(state: &State, interface: &Interface) -> Option<Self> {
        let compare = state.depth?.compare;
        let keeps = state.stencil.is_none_or(|test| {
            let keep = StencilOperation::Keep;
            [test.front, test.back]
                .iter()
                .all(|face| face.fail_op == keep && face.depth_fail_op == keep)
        });
        let is_early = interface.depth_output == DepthOutput::None && !interface.stores;
        let may_reject = !matches!(
            compare,
            CompareFunction::Equal | CompareFunction::NotEqual | CompareFunction::Always
        );
        (keeps && is_early && may_reject).then_some(Self(compare))
    }

    /// Returns true if no depth in the first range passes against any in the second.
    fn rejects(self, [least, greatest]: [f32; 2], stored: &BlockRange) -> bool {
        match self.0 {
            CompareFunction::Never => true,
            CompareFunction::Less => least >= stored.greatest,
            CompareFunction::LessEqual => least > stored.greatest,
            CompareFunction::Greater => greatest <= stored.least,
            CompareFunction::GreaterEqual => greatest < stored.least,
            _ => false,
        }
    }
}

impl HiddenBlocks {
    /// Takes the depths of a band at the beginning of a pass.
    pub(super) fn new(target: &Target) -> Self {
        let bounds = target.stored().clone();
        let blocks =
            bounds.x.len().div_ceil(SIDE as usize) * bounds.y.len().div_ceil(SIDE as usize);
        let stale = BlockRange {
            least: 0.0,
            greatest: 1.0,
            is_stale: true,
            piece: 0,
        };
        Self {
            bounds,
            samples: target.samples,
            format: target.depth_stencil,
            depths: target.depth.clone(),
            counts: vec![BlockCounts::default(); blocks],
            ranges: vec![stale; blocks],
        }
    }

    /// Tests a triangle in the block of a pixel that it covers, once for each number of a piece.
    /// Numbers rise from 1.
    pub(super) fn test(
        &mut self,
        (piece, pixel): (u32, [u32; 2]),
        rejection: Option<Rejection>,
        surface: &dyn Surface,
        clamp_depth: &dyn Fn(f32) -> f32,
    ) {
        let at = self.block(pixel);
        if self.ranges[at].piece == piece || self.depths.is_empty() {
            return;
        }
        self.ranges[at].piece = piece;
        self.counts[at].tested += 1;
        if let Some(rejection) = rejection {
            self.refresh(at, pixel);
            let depths = self.plane_range(pixel, surface, clamp_depth);
            self.counts[at].rejected += u32::from(rejection.rejects(depths, &self.ranges[at]));
        }
    }

    /// Notes the depth of a sample.
    pub(super) fn store(&mut self, pixel: [u32; 2], sample: u32, depth: f32) {
        let at = self.index(pixel) + sample as usize;
        if self.depths[at].to_bits() != depth.to_bits() {
            self.depths[at] = depth;
            let block = self.block(pixel);
            self.ranges[block].is_stale = true;
        }
    }

    /// The least and the greatest depth of a plane over the samples of the block of a pixel. A
    /// plane is monotone in x and y, so both lie at samples of its corners.
    fn plane_range(
        &self,
        pixel: [u32; 2],
        surface: &dyn Surface,
        clamp_depth: &dyn Fn(f32) -> f32,
    ) -> [f32; 2] {
        let first = pixel.map(|at| at - at % SIDE);
        let positions = sample_positions(self.samples);
        let offset = |axis: usize, is_last: bool| {
            let offsets = positions.iter().map(|position| position[axis]);
            let offset = if is_last {
                offsets.max()
            } else {
                offsets.min()
            };
            offset.unwrap_or(8)
        };
        let corners = [(false, false), (true, false), (false, true), (true, true)];
        let depths = corners.map(|(right, bottom)| {
            let last = |is_last: bool| if is_last { SIDE - 1 } else { 0 };
            let pixel = [first[0] + last(right), first[1] + last(bottom)];
            let depth = clamp_depth(surface.depth(pixel, [offset(0, right), offset(1, bottom)]));
            self.format
                .map_or(depth, |format| quantised_depth(format, depth))
        });
        let least = depths.into_iter().fold(f32::INFINITY, f32::min);
        let greatest = depths.into_iter().fold(f32::NEG_INFINITY, f32::max);
        [least, greatest]
    }

    /// Scans a block that was written.
    fn refresh(&mut self, block: usize, pixel: [u32; 2]) {
        if !self.ranges[block].is_stale {
            return;
        }
        let [left, top] = pixel.map(|at| at - at % SIDE);
        let right = (left + SIDE).min(self.bounds.x.end);
        let bottom = (top + SIDE).min(self.bounds.y.end);
        let (mut least, mut greatest) = (f32::INFINITY, f32::NEG_INFINITY);
        for y in top..bottom {
            let from = self.index([left, y]);
            let row = &self.depths[from..from + (right - left) as usize * self.samples as usize];
            for &depth in row {
                least = least.min(depth);
                greatest = greatest.max(depth);
            }
        }
        let range = &mut self.ranges[block];
        (range.least, range.greatest, range.is_stale) = (least, greatest, false);
    }

    /// The position of a pixel's first sample in the depths.
    fn index(&self, [x, y]: [u32; 2]) -> usize {
        let (column, row) = (x - self.bounds.x.start, y - self.bounds.y.start);
        let pixel = row as usize * self.bounds.x.len() + column as usize;
        pixel * self.samples as usize
    }

    /// The position of a pixel's block. Bands begin at rows of tiles, so no block is in two.
    fn block(&self, [x, y]: [u32; 2]) -> usize {
        let columns = self.bounds.x.len().div_ceil(SIDE as usize);
        ((y - self.bounds.y.start) / SIDE) as usize * columns + (x / SIDE) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use estampe_types::state::{DepthState, StencilState};

    /// A plane depth = value + x·dx + y·dy, in pixels from the corner of the window.
    struct Slope([f32; 3]);

    impl Surface for Slope {
        fn depth(&self, pixel: [u32; 2], sample: [u8; 2]) -> f32 {
            let [x, y] = [0, 1].map(|axis| pixel[axis] as f32 + f32::from(sample[axis]) / 16.0);
            let [value, dx, dy] = self.0;
            value + x * dx + y * dy
        }

        fn inverse_w(&self, _pixel: [u32; 2]) -> f32 {
            1.0
        }

        fn varyings(&self, _pixel: [u32; 2]) -> Vec<f32> {
            Vec::new()
        }

        fn derivatives_at(&self, _: [u32; 2], _: [u8; 2]) -> Vec<[f32; 2]> {
            Vec::new()
        }
    }

    fn target(samples: u32) -> Target {
        let format = Some(TextureFormat::Depth32Float);
        Target::with_attachments([40, 35], samples, &[], format)
    }

    /// A block is rejected only if all samples of the piece in it fail, and if the slope is within
    /// the block's corners, whenever they do.
    #[test]
    fn blocks_are_rejected_exactly_if_every_depth_of_the_plane_fails() {
        let mut random = fastrand::Rng::with_seed(3);
        let compares = [
            CompareFunction::Less,
            CompareFunction::LessEqual,
            CompareFunction::Greater,
            CompareFunction::GreaterEqual,
        ];
        let (mut rejected, mut kept) = (0, 0);
        for turn in 0..400 {
            let samples = [1, 4][turn % 2];
            let target = target(samples);
            let mut blocks = HiddenBlocks::new(&target);
            let [x, y] = [random.u32(0..2) * 16, random.u32(0..2) * 16];
            let inside =
                |x: u32, y: u32| (x..x + 16).flat_map(move |x| (y..y + 16).map(move |y| [x, y]));
            let around = random.f32();
            for pixel in inside(x, y) {
                for sample in 0..samples {
                    blocks.store(pixel, sample, around + random.f32() * 0.05);
                }
            }
            let slope = Slope([random.f32(), random.f32() * 0.01 - 0.005, 0.0]);
            let compare = compares[turn / 2 % 4];
            blocks.test(
                (1, [x + 3, y + 5]),
                Some(Rejection(compare)),
                &slope,
                &|depth| depth,
            );
            // Once for each piece.
            blocks.test(
                (1, [x + 4, y + 5]),
                Some(Rejection(compare)),
                &slope,
                &|depth| depth,
            );
            let stored: Vec<f32> = inside(x, y)
                .flat_map(|pixel| (0..samples).map(move |sample| (pixel, sample)))
                .map(|(pixel, sample)| blocks.depths[blocks.index(pixel) + sample as usize])
                .collect();
            let passes = |depth: f32, stored: f32| match compare {
                CompareFunction::Less => depth < stored,
                CompareFunction::LessEqual => depth <= stored,
                CompareFunction::Greater => depth > stored,
                _ => depth >= stored,
            };
            let positions = sample_positions(samples);
            let all_fail = inside(x, y).all(|pixel| {
                positions.iter().all(|&position| {
                    let depth = slope.depth(pixel, position);
                    stored.iter().all(|&stored| !passes(depth, stored))
                })
            });
            let counts: u32 = blocks.counts.iter().map(|block| block.tested).sum();
            assert_eq!(counts, 1);
            let at = blocks.block([x, y]);
            // At several samples the corners of the block have no sample, and the test is for them.
            let is_rejected = blocks.counts[at].rejected == 1;
            assert!(all_fail || !is_rejected, "{compare:?}");
            if samples == 1 {
                assert_eq!(is_rejected, all_fail, "{compare:?}");
            }
            rejected += u32::from(is_rejected);
            kept += u32::from(!is_rejected);
        }
        assert!(
            rejected > 80 && kept > 80,
            "{rejected} rejected, {kept} kept"
        );
    }

    #[test]
    fn draws_that_write_depth_or_stencil_on_failure_are_never_rejected() {
        let mut state = State::new(8, 8);
        let mut interface = Interface::default();
        assert_eq!(Rejection::of_draw(&state, &interface), None);
        state.depth = Some(DepthState::LESS_WRITE);
        let less = Some(Rejection(CompareFunction::Less));
        assert_eq!(Rejection::of_draw(&state, &interface), less);
        interface.depth_output = DepthOutput::Any;
        assert_eq!(Rejection::of_draw(&state, &interface), None);
        interface.depth_output = DepthOutput::None;
        interface.stores = true;
        assert_eq!(Rejection::of_draw(&state, &interface), None);
        interface.stores = false;
        let mut stencil = StencilState::default();
        state.stencil = Some(stencil);
        assert_eq!(Rejection::of_draw(&state, &interface), less);
        stencil.back.depth_fail_op = StencilOperation::Zero;
        state.stencil = Some(stencil);
        assert_eq!(Rejection::of_draw(&state, &interface), None);
    }
}
