//! Frames as indices into a palette, by error diffusion (Floyd and Steinberg 1976).
//!
//! A texel that is as it was in the frame before keeps its index, and a texel whose colour is in
//! the palette has its index: neither takes errors nor passes them on. So errors stay
//! on the surfaces that move, and a background has no noise.

use super::oklab::{Oklab, from_srgb};
use super::palette::{CELLS, cell_of, nearest};
use estampe_scene::Image;
use std::collections::BTreeMap;

/// The least alpha of a texel that is shown.
pub(super) const OPAQUE: u8 = 128;

/// Chooses indices.
pub(super) struct Ditherer<'p> {
    palette: &'p [[u8; 3]],
    labs: Vec<Oklab>,
    exact: BTreeMap<[u8; 3], u8>,
    /// The nearest colours of cells, found when they are needed.
    of_cell: Vec<Option<u8>>,
    before: Option<(Image, Vec<u8>)>,
}

impl<'p> Ditherer<'p> {
    /// For at most 255 colours; the index after the last one is transparent.
    pub(super) fn new(palette: &'p [[u8; 3]]) -> Self {
        let exact = palette.iter().zip(0_u8..);
        Self {
            palette,
            labs: palette.iter().map(|&color| from_srgb(color)).collect(),
            exact: exact.map(|(&color, index)| (color, index)).collect(),
            of_cell: vec![None; CELLS],
            before: None,
        }
    }

    /// The index of transparent texels.
    pub(super) fn transparent(&self) -> u8 {
        u8::try_from(self.palette.len()).unwrap_or(u8::MAX)
    }

    /// The indices of the next frame.
    pub(super) fn indices(&mut self, frame: &Image) -> Vec<u8> {
        let before = self.before.take();
        let width = frame.width as usize;
        let texels = frame.rgba.as_chunks::<4>().0;
        let mut indices = Vec::with_capacity(texels.len());
        // Sixteenths of codes, for the texels to come: of this row, and of the next.
        let mut here = vec![[0_i32; 3]; width + 2];
        let mut below = here.clone();
        for (y, row) in texels.chunks_exact(width.max(1)).enumerate() {
            for (x, &texel) in row.iter().enumerate() {
                let at = y * width + x;
                let kept = before.as_ref().and_then(|(image, indices)| {
                    let old = image.rgba.as_chunks::<4>().0.get(at)?;
                    (*old == texel).then(|| indices.get(at).copied()).flatten()
                });
                let [r, g, b, alpha] = texel;
                let exact = || self.exact.get(&[r, g, b]).copied();
                let index = if alpha < OPAQUE {
                    self.transparent()
                } else if let Some(index) = kept.or_else(exact) {
                    index
                } else {
                    // Errors of column x are at x + 1.
                    let error = here[x + 1];
                    let wanted = [r, g, b].map(i32::from);
                    let wanted = [0, 1, 2].map(|c| (wanted[c] + (error[c] + 8) / 16).clamp(0, 255));
                    let index = self.nearest(wanted);
                    let got = self.palette[usize::from(index)].map(i32::from);
                    for c in 0..3 {
                        let error = wanted[c] - got[c];
                        here[x + 2][c] += 7 * error;
                        below[x][c] += 3 * error;
                        below[x + 1][c] += 5 * error;
                        below[x + 2][c] += error;
                    }
                    index
                };
                indices.push(index);
            }
            here.fill([0; 3]);
            std::mem::swap(&mut here, &mut below);
        }
        self.before = Some((frame.clone(), indices.clone()));
        indices
    }

    /// The nearest colour of the cell's middle.
    fn nearest(&mut self, color: [i32; 3]) -> u8 {
        let color = color.map(|code| u8::try_from(code).unwrap_or(u8::MAX));
        let cell = &mut self.of_cell[cell_of(color)];
        *cell.get_or_insert_with(|| {
            let middle = color.map(|code| (code & !3) | 2);
            u8::try_from(nearest(&self.labs, from_srgb(middle))).unwrap_or(u8::MAX)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::samples::disc;

    #[test]
    fn errors_cancel_over_a_surface() {
        // A grey between black and white.
        let frame = Image::filled(64, 64, [100, 100, 100, 255]);
        let palette = [[0; 3], [255; 3]];
        let indices = Ditherer::new(&palette).indices(&frame);
        let white = indices.iter().filter(|&&index| index == 1).count();
        let mean = white as f64 * 255.0 / 4096.0;
        assert!((mean - 100.0).abs() < 3.0, "{mean}");
    }

    #[test]
    fn what_stands_still_keeps_its_indices() {
        let first = disc(40, 40);
        let mut second = first.clone();
        // Above, everything changes.
        for texel in second.rgba.as_chunks_mut::<4>().0.iter_mut().take(40 * 20) {
            texel[0] ^= 0x15;
        }
        let palette = [[0, 0, 0], [90, 80, 60], [0xf2; 3], [200, 150, 90]];
        let mut ditherer = Ditherer::new(&palette);
        let before = ditherer.indices(&first);
        let after = ditherer.indices(&second);
        assert_eq!(before[40 * 20..], after[40 * 20..]);
        assert_ne!(before[..40 * 20], after[..40 * 20]);
        let background = before.iter().zip(first.rgba.as_chunks::<4>().0);
        for (index, texel) in background {
            assert!(*index == 2 || texel[..3] != [0xf2; 3]);
        }
    }

    #[test]
    fn transparent_texels_have_the_index_after_the_palette() {
        let mut frame = Image::filled(2, 1, [7, 7, 7, 127]);
        frame.rgba[7] = 128;
        let palette = [[7; 3]];
        let mut ditherer = Ditherer::new(&palette);
        assert_eq!(ditherer.indices(&frame), [1, 0]);
        assert_eq!(Ditherer::new(&[]).transparent(), 0);
    }
}
