//! Integer lines (Bresenham 1965): the classic scan conversion, for overlays and for teaching.
//!
//! Both end pixels are drawn. The loop plots, then steps; on a tie (the line passes exactly between
//! two pixels) the minor coordinate stays. Ties are decided as seen from the end with the lesser
//! major coordinate, so that a line and its reverse cover the same pixels.
//!
//! ```text
//!   e = 2·(k·Δminor − m·Δmajor): twice the distance of the line from pixel (k, m), times Δmajor
//!   after each step along the major axis:  e += 2·Δminor;  if e > Δmajor { m += 1; e −= 2·Δmajor }
//! ```
//!
//! Pipeline lines, which are half-open and have sub-pixel ends, are in [`line`](mod@crate::line).

/// An iterator over the pixels of a line, from its start to its end.
#[derive(Debug, Clone)]
pub struct Line {
    next: Option<[i64; 2]>,
    left: u64,
    /// 0 where |Δx| ≥ |Δy|, else 1.
    major: usize,
    /// |Δ| along the major and along the minor axis.
    length: [i64; 2],
    /// The step along x and along y: −1 or 1.
    step: [i64; 2],
    /// True if a tie steps along the minor axis: the line runs from the greater to the lesser major
    /// coordinate.
    tie_steps: bool,
    error: i64,
}

/// The line from one pixel to another. Any two pixels are allowed: the arithmetic is in 64 bits and
/// cannot overflow.
#[must_use]
pub fn line(from: [i32; 2], to: [i32; 2]) -> Line {
    let delta = [0, 1].map(|axis| i64::from(to[axis]) - i64::from(from[axis]));
    let major = usize::from(delta[0].abs() < delta[1].abs());
    Line {
        next: Some(from.map(i64::from)),
        left: delta[major].unsigned_abs(),
        major,
        length: [delta[major].abs(), delta[1 - major].abs()],
        step: delta.map(i64::signum),
        tie_steps: delta[major] < 0,
        error: 0,
    }
}

impl Iterator for Line {
    type Item = [i32; 2];

    fn next(&mut self) -> Option<[i32; 2]> {
        // Plot.
        let here = self.next?;
        let plotted = here.map(|at| i32::try_from(at).expect("between the line's ends"));

        // Then step.
        self.next = None;
        if self.left > 0 {
            self.left -= 1;
            let mut there = here;
            let [major_length, minor_length] = self.length;
            there[self.major] += self.step[self.major];
            self.error += 2 * minor_length;
            let is_beyond = self.error > major_length;
            let is_tie = self.error == major_length;
            if is_beyond || is_tie && self.tie_steps {
                there[1 - self.major] += self.step[1 - self.major];
                self.error -= 2 * major_length;
            }
            self.next = Some(there);
        }
        Some(plotted)
    }
}
