//! Images that the command wrote.

use std::io::Cursor;
use std::path::Path;

/// An image that the command wrote.
#[derive(PartialEq)]
pub(crate) struct Picture {
    pub(crate) width: usize,
    pub(crate) height: usize,
    rgba: Vec<u8>,
}

impl Picture {
    pub(crate) fn read(bytes: &[u8]) -> Self {
        let image = estampe_assets::image::decode(bytes, &estampe_assets::Limits::default())
            .expect("a picture that can be read");
        let (width, height) = (image.width as usize, image.height as usize);
        Self {
            width,
            height,
            rgba: image.rgba,
        }
    }

    pub(crate) fn open(path: &Path) -> Self {
        Self::read(&std::fs::read(path).expect("the picture was written"))
    }

    /// A WebP with alpha.
    pub(crate) fn open_webp(path: &Path) -> Self {
        let bytes = std::fs::read(path).expect("the picture was written");
        let mut decoder = image_webp::WebPDecoder::new(Cursor::new(bytes)).expect("a WebP");
        assert!(decoder.has_alpha() && !decoder.is_lossy());
        let (width, height) = decoder.dimensions();
        let mut rgba = vec![0; decoder.output_buffer_size().expect("small")];
        decoder.read_image(&mut rgba).expect("a whole WebP");
        Self {
            width: width as usize,
            height: height as usize,
            rgba,
        }
    }

    /// All texels, row by row from the top.
    pub(crate) fn rgba(&self) -> Vec<u8> {
        self.rgba.clone()
    }

    pub(crate) fn pixel(&self, x: usize, y: usize) -> [u8; 4] {
        let at = (y * self.width + x) * 4;
        [
            self.rgba[at],
            self.rgba[at + 1],
            self.rgba[at + 2],
            self.rgba[at + 3],
        ]
    }

    /// Left, top, right and bottom of the pixels that differ from the top left pixel; right and
    /// bottom are exclusive.
    pub(crate) fn extent(&self) -> [usize; 4] {
        let background = self.pixel(0, 0);
        let mut extent = [self.width, self.height, 0, 0];
        for y in 0..self.height {
            for x in 0..self.width {
                if self.pixel(x, y) != background {
                    extent = [
                        extent[0].min(x),
                        extent[1].min(y),
                        extent[2].max(x + 1),
                        extent[3].max(y + 1),
                    ];
                }
            }
        }
        extent
    }

    /// Number of different colours.
    pub(crate) fn color_count(&self) -> usize {
        let mut colors: Vec<&[u8]> = self.rgba.chunks_exact(4).collect();
        colors.sort_unstable();
        colors.dedup();
        colors.len()
    }
}
