//! Pipeline lines (R3): Vulkan's Bresenham rule, one pixel wide.
//!
//! ```text
//!     x-major:  in every column whose centre lies between the ends (the start's included, the end's
//!     not), the pixel whose row holds the line's y at that centre; y-major lines likewise
//! ```
//!
//! *Precision* exact 64-bit integers · *Spec* Vulkan §Bresenham Line Segment Rasterization.

use super::{CoverageList, TileShape};
use crate::geometry::viewport::PixelRect;
use crate::tiles::LinePrimitive;

/// A line along its major axis, in 1/256 pixel.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LineAxis {
    /// Whether x is the major axis.
    pub(crate) x_major: bool,
    /// The start on the major and the minor axis.
    pub(crate) start: [i64; 2],
    /// The way to the end on both.
    pub(crate) delta: [i64; 2],
}

impl LineAxis {
    pub(crate) fn new(line: &LinePrimitive) -> Self {
        let [a, b] = &line.ends;
        let (dx, dy) = (i64::from(b.x - a.x), i64::from(b.y - a.y));
        let x_major = dx.abs() >= dy.abs();
        let start = [i64::from(a.x), i64::from(a.y)];
        let (start, delta) = if x_major {
            (start, [dx, dy])
        } else {
            ([start[1], start[0]], [dy, dx])
        };
        Self {
            x_major,
            start,
            delta,
        }
    }

    /// The first and last unit of the major axis that the line covers; empty when first > last.
    fn span(&self) -> [i64; 2] {
        let [from, to] = [self.start[0], self.start[0] + self.delta[0]];
        // Centres 256·i + 128 with from ≤ centre < to, or to < centre ≤ from.
        if self.delta[0] >= 0 {
            [(from + 127) >> 8, (to - 129) >> 8]
        } else {
            [(to + 128) >> 8, (from - 128) >> 8]
        }
    }

    /// The pixel on the minor axis at a unit of the major axis: ⌊minor(centre) / 256⌋ exactly.
    fn minor_at(&self, unit: i64) -> i64 {
        let along = unit * 256 + 128 - self.start[0];
        // minor = start + along·Δminor/Δmajor; products are below 2⁴⁹.
        let numerator = self.start[1] * self.delta[0] + along * self.delta[1];
        let denominator = 256 * self.delta[0];
        numerator.div_euclid(denominator)
            - i64::from(denominator < 0 && numerator.rem_euclid(denominator) != 0)
    }
}

/// Lists the packets that a line covers, all samples of a pixel alike; `rect` is in the tile's own pixels.
pub(crate) fn cover<const N: usize>(
    line: &LinePrimitive,
    tile: TileShape,
    rect: &PixelRect,
    out: &mut CoverageList<N>,
) {
    let axis = LineAxis::new(line);
    if axis.delta[0] == 0 {
        return;
    }
    let origin = [i64::from(tile.x), i64::from(tile.y)];
    let (low, high) = ([rect.x0, rect.y0], [rect.x1, rect.y1]);
    let [major, minor] = if axis.x_major { [0, 1] } else { [1, 0] };
    let [first, last] = axis.span();
    let first = first.max(origin[major] + i64::from(low[major]));
    let last = last.min(origin[major] + i64::from(high[major]) - 1);
    let minor_range = i64::from(low[minor])..i64::from(high[minor]);
    // A monotone line leaves a packet for good, so only the newest one can get another pixel.
    let mut current: Option<(u32, u16)> = None;
    for unit in first..=last {
        let across = axis.minor_at(unit) - origin[minor];
        if !minor_range.contains(&across) {
            continue;
        }
        let along = unit - origin[major];
        let (x, y) = if axis.x_major {
            (along, across)
        } else {
            (across, along)
        };
        let (packet, bit) = lane_of(x, y);
        match &mut current {
            Some((at, mask)) if *at == packet => *mask |= bit,
            _ => {
                if let Some((at, mask)) = current {
                    out.push(at, [mask; N]);
                }
                current = Some((packet, bit));
            }
        }
    }
    if let Some((at, mask)) = current {
        out.push(at, [mask; N]);
    }
}

/// The packet of a tile's pixel and the pixel's bit in it.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "0..64"
)]
fn lane_of(x: i64, y: i64) -> (u32, u16) {
    let (x, y) = (x as u32, y as u32);
    let packet = crate::layout::morton(x / 4, y / 4);
    (packet, 1 << crate::layout::morton(x % 4, y % 4))
}
