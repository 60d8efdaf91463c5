//! Lines on a finished image.

use crate::canvas::Canvas;
use crate::transforms::round_to_f32;
use glam::DVec2;

/// Draws a line with round ends, smooth borders and a width in pixels; places are in pixels from
/// the image's upper left corner.
pub(super) fn line(image: &mut impl Canvas, ends: [DVec2; 2], width_px: f64, color: [u8; 3]) {
    let half = width_px / 2.0;
    let reach = DVec2::splat(half + 1.0);
    let [width, height] = image.size();
    let size = DVec2::new(width.into(), height.into());
    let low = (ends[0].min(ends[1]) - reach).clamp(DVec2::ZERO, size);
    let high = (ends[0].max(ends[1]) + reach).clamp(DVec2::ZERO, size);
    let way = ends[1] - ends[0];
    // The first pixel from a place on.
    let from = |at: f64, side: u32| (0..side).find(|&x| f64::from(x) >= at).unwrap_or(side);
    for y in from(low.y, height)..from(high.y, height) {
        for x in from(low.x, width)..from(high.x, width) {
            let center = DVec2::new(x.into(), y.into()) + 0.5 - ends[0];
            let share = center.dot(way) / way.length_squared().max(f64::MIN_POSITIVE);
            let distance = (center - way * share.clamp(0.0, 1.0)).length();
            let coverage = (half + 0.5 - distance).clamp(0.0, 1.0);
            if coverage > 0.0 {
                image.blend([x, y], color, round_to_f32(coverage));
            }
        }
    }
}
