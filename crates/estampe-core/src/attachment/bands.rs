//! An image in row order cut into bands, to which workers store side by side.
//!
//! Tiles beside each other share rows. Cut into slices of each tile, an image of 1280×720 is 14,400
//! of them, which the caller makes while all other threads wait; bands are few, and a worker has
//! one for a small part of the time that it stores a tile.

use std::sync::{Mutex, MutexGuard, PoisonError};

/// The bands of an image, from the top.
#[derive(Debug)]
pub(super) struct Bands<'a> {
    bands: Vec<Mutex<&'a mut [u32]>>,
}

impl<'a> Bands<'a> {
    /// Bands of so many words, but for the last.
    pub(super) fn of(image: &'a mut [u32], words: usize) -> Self {
        Self {
            bands: image.chunks_mut(words).map(Mutex::new).collect(),
        }
    }

    /// Waits for a band; `None` beyond the end. After a panic elsewhere a band is as good as
    /// before: it is plain data.
    pub(super) fn lock(&self, number: usize) -> Option<MutexGuard<'_, &'a mut [u32]>> {
        let band = self.bands.get(number)?;
        Some(band.lock().unwrap_or_else(PoisonError::into_inner))
    }
}
