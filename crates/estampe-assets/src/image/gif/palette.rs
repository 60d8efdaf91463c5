//! One palette for all frames.
//!
//! If the frames have few colours, those. Else colours are counted in cells of 4 × 4 × 4 codes, the
//! cells are cut into boxes, each time the box of the greatest variance at its mean (median cut, in
//! the variant of Wu 1991), and the boxes' means are improved by k-means. All of it is in Oklab,
//! where the mean of colours looks like their mean.

use super::oklab::{Oklab, distance, from_srgb, to_srgb};
use estampe_scene::Image;

/// Bits of a channel that tell cells apart.
const CELL_BITS: u32 = 6;
/// Rounds of k-means: more change nothing that one can see.
const ROUNDS: usize = 6;

/// At most `most` colours for the opaque texels of the frames.
pub(super) fn palette(frames: &[Image], most: usize) -> Vec<[u8; 3]> {
    if let Some(colors) = exact(frames, most) {
        return colors;
    }
    let cells = cells(frames);
    let mut centers = cut(&cells, most);
    for _ in 0..ROUNDS {
        if !improve(&cells, &mut centers) {
            break;
        }
    }
    let mut colors: Vec<[u8; 3]> = centers.into_iter().map(to_srgb).collect();
    // A background is in the palette as it is, so that it is one colour without noise.
    let background = most_frequent(frames, &cells);
    let lab = from_srgb(background);
    let nearest = colors.iter_mut().min_by(|a, b| {
        let (a, b) = (from_srgb(**a), from_srgb(**b));
        distance(a, lab).total_cmp(&distance(b, lab))
    });
    if let Some(nearest) = nearest {
        *nearest = background;
    }
    colors.sort_unstable();
    colors.dedup();
    colors
}

/// The opaque texels; the others have no colour.
fn opaque(frames: &[Image]) -> impl Iterator<Item = [u8; 3]> {
    let texels = frames
        .iter()
        .flat_map(|frame| frame.rgba.as_chunks::<4>().0);
    let texels = texels.filter(|texel| texel[3] >= super::dither::OPAQUE);
    texels.map(|&[r, g, b, _]| [r, g, b])
}

/// All colours in order, if there are at most so many.
fn exact(frames: &[Image], most: usize) -> Option<Vec<[u8; 3]>> {
    let mut seen = vec![0_u64; 1 << 18];
    let mut colors = Vec::new();
    let mut last = None;
    for color in opaque(frames) {
        if last == Some(color) {
            continue;
        }
        last = Some(color);
        let [r, g, b] = color.map(usize::from);
        let number = r << 16 | g << 8 | b;
        let (word, bit) = (&mut seen[number / 64], 1 << (number % 64));
        if *word & bit == 0 {
            if colors.len() == most {
                return None;
            }
            *word |= bit;
            colors.push(color);
        }
    }
    colors.sort_unstable();
    Some(colors)
}

/// The texels whose colours are in one cell.
struct Cell {
    number: usize,
    mean: Oklab,
    count: f64,
}

/// The cell of a colour.
pub(super) fn cell_of([r, g, b]: [u8; 3]) -> usize {
    let high = |code: u8| usize::from(code >> (8 - CELL_BITS));
    (high(r) << (2 * CELL_BITS)) | (high(g) << CELL_BITS) | high(b)
}

/// The number of cells.
pub(super) const CELLS: usize = 1 << (3 * CELL_BITS);

/// The cells that have texels, in the order of their numbers.
fn cells(frames: &[Image]) -> Vec<Cell> {
    let mut sums = vec![[0_u64; 4]; CELLS];
    for color in opaque(frames) {
        let sum = &mut sums[cell_of(color)];
        for (sum, code) in sum.iter_mut().zip(color) {
            *sum += u64::from(code);
        }
        sum[3] += 1;
    }
    let used = sums.into_iter().enumerate().filter(|(_, sum)| sum[3] > 0);
    used.map(|(number, [r, g, b, count])| {
        let mean = |sum: u64| u8::try_from((sum + count / 2) / count).unwrap_or(u8::MAX);
        Cell {
            number,
            mean: from_srgb([mean(r), mean(g), mean(b)]),
            count: count as f64,
        }
    })
    .collect()
}

/// Cells in a box, with the axis of their greatest variance and its sum.
struct Part<'c> {
    cells: Vec<&'c Cell>,
    axis: usize,
    spread: f64,
    mean: Oklab,
}

impl<'c> Part<'c> {
    fn new(cells: Vec<&'c Cell>) -> Self {
        let count: f64 = cells.iter().map(|cell| cell.count).sum();
        let sum = |of: &dyn Fn(&Cell) -> f64| -> f64 {
            cells.iter().map(|cell| cell.count * of(cell)).sum()
        };
        let mean = [0, 1, 2].map(|axis| sum(&|cell| cell.mean[axis]) / count);
        let spreads = [0, 1, 2].map(|axis| {
            sum(&|cell| {
                let away = cell.mean[axis] - mean[axis];
                away * away
            })
        });
        let axis = if spreads[0] >= spreads[1].max(spreads[2]) {
            0
        } else if spreads[1] >= spreads[2] {
            1
        } else {
            2
        };
        Self {
            cells,
            axis,
            spread: spreads[axis],
            mean,
        }
    }

    /// Both sides of the mean; neither is empty where the spread is not 0.
    fn halves(self) -> [Self; 2] {
        let (axis, middle) = (self.axis, self.mean[self.axis]);
        let cells = self.cells.into_iter();
        let (low, high) = cells.partition(|cell| cell.mean[axis] < middle);
        [Self::new(low), Self::new(high)]
    }
}

/// The means of at most `most` boxes.
fn cut(cells: &[Cell], most: usize) -> Vec<Oklab> {
    let mut parts = vec![Part::new(cells.iter().collect())];
    while parts.len() < most {
        let widest = parts.iter().enumerate();
        let widest = widest.max_by(|(_, a), (_, b)| a.spread.total_cmp(&b.spread));
        let Some((at, _)) = widest.filter(|(_, part)| part.cells.len() > 1) else {
            break;
        };
        let [low, high] = parts.swap_remove(at).halves();
        // Means of cells that differ by less than rounding.
        if low.cells.is_empty() || high.cells.is_empty() {
            let mut rest = if low.cells.is_empty() { high } else { low };
            rest.spread = 0.0;
            parts.push(rest);
            if parts.iter().all(|part| part.spread == 0.0) {
                break;
            }
            continue;
        }
        parts.extend([low, high]);
    }
    parts.into_iter().map(|part| part.mean).collect()
}

/// Moves each centre to the mean of the cells that are nearest to it; false if none moves.
fn improve(cells: &[Cell], centers: &mut [Oklab]) -> bool {
    let mut sums = vec![([0.0; 3], 0.0); centers.len()];
    for cell in cells {
        let (sum, count) = &mut sums[nearest(centers, cell.mean)];
        for (sum, value) in sum.iter_mut().zip(cell.mean) {
            *sum += cell.count * value;
        }
        *count += cell.count;
    }
    let mut has_moved = false;
    for (center, (sum, count)) in centers.iter_mut().zip(sums) {
        if count > 0.0 {
            let mean = sum.map(|sum| sum / count);
            has_moved |= distance(mean, *center) > 1e-10;
            *center = mean;
        }
    }
    has_moved
}

/// The place of the nearest colour, of equal ones the first.
pub(super) fn nearest(colors: &[Oklab], to: Oklab) -> usize {
    let (mut best, mut least) = (0, f64::INFINITY);
    for (at, &color) in colors.iter().enumerate() {
        let distance = distance(color, to);
        if distance < least {
            (best, least) = (at, distance);
        }
    }
    best
}

/// The most frequent colour of the fullest cell.
fn most_frequent(frames: &[Image], cells: &[Cell]) -> [u8; 3] {
    let fullest = cells.iter().max_by(|a, b| a.count.total_cmp(&b.count));
    let number = fullest.map_or(0, |cell| cell.number);
    const SIDE: usize = 1 << (8 - CELL_BITS);
    let mut counts = [([0; 3], 0_u64); SIDE * SIDE * SIDE];
    for color in opaque(frames).filter(|&color| cell_of(color) == number) {
        let [r, g, b] = color.map(|code| usize::from(code) % SIDE);
        let (known, count) = &mut counts[(r * SIDE + g) * SIDE + b];
        *known = color;
        *count += 1;
    }
    let most = counts.into_iter().max_by_key(|&(_, count)| count);
    most.map_or([0; 3], |(color, _)| color)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::samples::{disc, noise};

    #[test]
    fn few_colours_are_kept_exactly() {
        let mut frame = Image::filled(3, 1, [9, 8, 7, 255]);
        frame.rgba[4..8].copy_from_slice(&[1, 2, 3, 255]);
        // A transparent texel has no colour.
        frame.rgba[8..].copy_from_slice(&[200, 2, 3, 0]);
        let colors = palette(&[frame.clone(), frame], 2);
        assert_eq!(colors, [[1, 2, 3], [9, 8, 7]]);
        assert!(palette(&[Image::filled(1, 1, [0; 4])], 255).is_empty());
    }

    #[test]
    fn palettes_are_near_to_all_colours() {
        let frame = disc(200, 200);
        let colors = palette(std::slice::from_ref(&frame), 64);
        assert!(colors.len() <= 64 && colors.len() > 48, "{}", colors.len());
        assert!(colors.contains(&[0xf2; 3]), "the background is exact");
        let labs: Vec<Oklab> = colors.iter().map(|&color| from_srgb(color)).collect();
        let away = opaque(std::slice::from_ref(&frame)).map(|color| {
            let lab = from_srgb(color);
            distance(labs[nearest(&labs, lab)], lab).sqrt()
        });
        let away: Vec<f64> = away.collect();
        // The disc is a ramp of lightness from 0 to 1: 64 colours are a 64th apart. Black is
        // further away from the mean of its cell, because lightness is steep there.
        let worst = away.iter().copied().fold(0.0, f64::max);
        let mean = away.iter().sum::<f64>() / away.len() as f64;
        assert!(worst < 0.08 && mean < 0.006, "{worst}, {mean}");
    }

    #[test]
    fn noise_has_a_palette_of_the_size() {
        let frames = [noise(64, 64, 1), noise(64, 64, 2)];
        let colors = palette(&frames, 255);
        assert!(
            colors.len() <= 255 && colors.len() > 200,
            "{}",
            colors.len()
        );
        assert_eq!(palette(&frames, 1).len(), 1);
    }
}
