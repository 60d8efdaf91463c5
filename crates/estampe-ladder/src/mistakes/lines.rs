//! Mistakes of Bresenham's line.

use crate::{Color, Course, LadderError, Picture};
use estampe_reference::bresenham;

const MAGNIFIED: u32 = 24;
const GRAY: Color = [60, 60, 60];

/// A picture of eight by eight pixels, y up, magnified, on a grid that shows the pixels.
fn magnified(width: u32, height: u32, pixels: &[([i32; 2], Color)]) -> Picture {
    let mut picture = Picture::new(width, height);
    for &(pixel, color) in pixels {
        picture.set(pixel, color);
    }
    let mut picture = picture.flipped().magnified(MAGNIFIED);
    let [right, bottom] = [picture.width(), picture.height()].map(u32::cast_signed);
    let step = MAGNIFIED as usize;
    for x in (0..right).step_by(step) {
        picture.line([x, 0], [x, bottom], GRAY);
    }
    for y in (0..bottom).step_by(step) {
        picture.line([0, y], [right, y], GRAY);
    }
    picture
}

/// The line (0, 0)–(5, 5): a loop that steps before it plots draws (0, 1) … (5, 6), and neither
/// end.
pub(super) fn stepping_first(_: &Course) -> Result<Picture, LadderError> {
    let (dx, dy) = (5, 5);
    let mut wrong = Vec::new();
    let (mut y, mut error) = (0, 0);
    for x in 0..=dx {
        error += 2 * dy;
        if error > dx {
            y += 1;
            error -= 2 * dx;
        }
        wrong.push(([x, y], Picture::WHITE));
    }
    let right: Vec<_> = bresenham::line([0, 0], [5, 5])
        .map(|pixel| (pixel, Picture::WHITE))
        .collect();
    // The ends in red, where no pixel covers them.
    let ends = [([0, 0], Picture::RED), ([5, 5], Picture::RED)];
    Ok(Picture::side_by_side(&[
        magnified(8, 8, &[&ends[..], &wrong].concat()),
        magnified(8, 8, &[&ends[..], &right].concat()),
    ]))
}

/// The line (1, 1)–(13, 4) passes exactly between two pixels three times. If a tie stays where the
/// line was, seen from its start, the line back covers other pixels: they are red.
pub(super) fn ties(_: &Course) -> Result<Picture, LadderError> {
    let (a, b) = ([1, 1], [13, 4]);
    let stays = |from: [i32; 2], to: [i32; 2]| {
        let [dx, dy] = [0, 1].map(|axis: usize| (to[axis] - from[axis]).abs());
        let [step_x, step_y] = [0, 1].map(|axis: usize| (to[axis] - from[axis]).signum());
        let (mut y, mut error) = (from[1], 0);
        (0..=dx)
            .map(|k| {
                let pixel = [from[0] + k * step_x, y];
                error += 2 * dy;
                if error > dx {
                    y += step_y;
                    error -= 2 * dx;
                }
                pixel
            })
            .collect::<Vec<_>>()
    };
    let both = |line: &dyn Fn([i32; 2], [i32; 2]) -> Vec<[i32; 2]>| {
        let backward = line(b, a).into_iter().map(|pixel| (pixel, Picture::RED));
        let forward = line(a, b).into_iter().map(|pixel| (pixel, Picture::WHITE));
        magnified(15, 6, &backward.chain(forward).collect::<Vec<_>>())
    };
    Ok(Picture::side_by_side(&[
        both(&stays),
        both(&|from, to| bresenham::line(from, to).collect()),
    ]))
}
