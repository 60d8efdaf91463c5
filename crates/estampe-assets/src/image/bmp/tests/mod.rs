//! BMP: fixtures written by hand, and damaged files.

mod hostile;
mod read;

/// A bitmap file assembled field by field; each test changes the fields that it tests.
#[derive(Debug, Clone)]
struct Fixture {
    /// Length of the second header.
    header_len: u32,
    width: i32,
    height: i32,
    bits: u16,
    compression: u32,
    colors: u32,
    /// Masks, in the header or behind it.
    masks: Vec<u32>,
    /// B, G, R and a byte that is not used; without the last one for a header of 12 bytes.
    palette: Vec<u8>,
    texels: Vec<u8>,
}

impl Fixture {
    /// A file of two colours or without a palette, whose first row is the topmost.
    fn new(bits: u16, (width, height): (i32, i32), texels: &[u8]) -> Self {
        Self {
            header_len: 40,
            width,
            height: -height,
            bits,
            compression: 0,
            colors: 0,
            masks: Vec::new(),
            palette: Vec::new(),
            texels: texels.to_vec(),
        }
    }

    fn with_palette(mut self, bgr: &[[u8; 3]]) -> Self {
        self.colors = u32::try_from(bgr.len()).expect("few colours");
        self.palette = bgr.iter().flat_map(|&[b, g, r]| [b, g, r, 7]).collect();
        self
    }

    fn bytes(&self) -> Vec<u8> {
        let mut header = self.header_len.to_le_bytes().to_vec();
        if self.header_len == 12 {
            for field in [self.width, self.height] {
                header.extend(field.to_le_bytes()[..2].iter());
            }
            header.extend([1, 0]);
            header.extend(self.bits.to_le_bytes());
        } else {
            header.extend(self.width.to_le_bytes());
            header.extend(self.height.to_le_bytes());
            header.extend([1, 0]);
            header.extend(self.bits.to_le_bytes());
            header.extend(self.compression.to_le_bytes());
            // Length of the texels and resolutions: not used, so they must have no effect.
            header.extend([1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]);
            header.extend(self.colors.to_le_bytes());
            header.extend([0; 4]);
            header.extend(self.masks.iter().flat_map(|mask| mask.to_le_bytes()));
            if header.len() < self.header_len as usize {
                header.resize(self.header_len as usize, 0);
            }
        }
        header.extend(&self.palette);
        let texels_start = u32::try_from(14 + header.len()).expect("a small file");
        let mut out = b"BM".to_vec();
        out.extend([0xff; 8]);
        out.extend(texels_start.to_le_bytes());
        out.extend(header);
        out.extend(&self.texels);
        out
    }
}
