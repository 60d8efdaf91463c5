//! Pictures: pixels that a rung sets, or that the device has drawn.
//!
//! Rows run from the top, as in files. The course counts y from the bottom: its rungs set pixels
//! with y up, and end with [`Picture::flipped`].

use crate::LadderError;
use estampe::{Device, Texture};
use estampe_assets::image::{ImageFormat, encode, flip_vertical};
use estampe_reference::bresenham;
use estampe_reference::scan_conversion::bounding_box;
use estampe_scene::Image;
use estampe_shapes::curve::Curve;
use glam::{Vec2, vec2};

/// Red, green and blue, 0 to 255, as the file stores them.
pub type Color = [u8; 3];

/// A picture of opaque pixels.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    image: Image,
}

impl Picture {
    /// Black.
    pub const BLACK: Color = [0, 0, 0];
    /// White.
    pub const WHITE: Color = [255, 255, 255];
    /// Red.
    pub const RED: Color = [255, 0, 0];
    /// Green.
    pub const GREEN: Color = [0, 255, 0];
    /// The space between pictures.
    pub const GAP: Color = [96, 96, 96];

    /// A black picture of `width` times `height` pixels.
    #[must_use]
    pub fn new(width: u32, height: u32) -> Self {
        Self::filled(width, height, Self::BLACK)
    }

    /// A picture of one colour.
    #[must_use]
    pub fn filled(width: u32, height: u32, [r, g, b]: Color) -> Self {
        Self {
            image: Image::filled(width, height, [r, g, b, 255]),
        }
    }

    /// The first mip level of a texture of the format `Rgba8Unorm`, as the device has drawn it.
    ///
    /// # Errors
    /// If the texture cannot be read.
    pub fn of_texture(device: &Device, texture: &Texture) -> Result<Self, LadderError> {
        let mut rgba = device.read_texture(texture)?;
        for pixel in rgba.as_chunks_mut::<4>().0 {
            pixel[3] = 255;
        }
        let (width, height) = (texture.width(), texture.height());
        Ok(Self {
            image: Image {
                width,
                height,
                rgba,
            },
        })
    }

    /// An intensity of 0 to 1 as the byte of a file: ⌊255·x + ½⌋, clamped.
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "it is clamped; NaN becomes 0"
    )]
    #[expect(clippy::cast_sign_loss, reason = "it is clamped; NaN becomes 0")]
    pub fn code(intensity: f32) -> u8 {
        (intensity.clamp(0.0, 1.0) * 255.0 + 0.5) as u8
    }

    /// Width in pixels.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.image.width
    }

    /// Height in pixels.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.image.height
    }

    /// The pixels as an image.
    #[must_use]
    pub fn image(&self) -> &Image {
        &self.image
    }

    /// Sets the pixel in column x and row y; outside of the picture nothing happens.
    pub fn set(&mut self, pixel: [i32; 2], color: Color) {
        if let Some(at) = self.offset(pixel) {
            self.image.rgba[at..at + 3].copy_from_slice(&color);
        }
    }

    /// Sets the pixels of Bresenham's line from one pixel to another, both included.
    pub fn line(&mut self, from: [i32; 2], to: [i32; 2], color: Color) {
        for pixel in bresenham::line(from, to) {
            self.set(pixel, color);
        }
    }

    /// The colour of a pixel; black outside of the picture.
    #[must_use]
    pub fn pixel(&self, pixel: [i32; 2]) -> Color {
        self.offset(pixel).map_or(Self::BLACK, |at| {
            let rgba = &self.image.rgba;
            [rgba[at], rgba[at + 1], rgba[at + 2]]
        })
    }

    /// The pixel of a point of the square −1..1, with y up in both: (⌊(x + 1)·W/2⌋, ⌊(y + 1)·H/2⌋).
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "far points become far pixels"
    )]
    pub fn place(&self, point: Vec2) -> [i32; 2] {
        let half = vec2(self.width() as f32, self.height() as f32) / 2.0;
        let place = ((point + Vec2::ONE) * half).floor();
        [place.x as i32, place.y as i32]
    }

    /// Draws the closed outline of a polygon, whose corners lie in the square −1..1.
    pub fn outline(&mut self, corners: &[Vec2], color: Color) {
        for (k, &from) in corners.iter().enumerate() {
            let to = corners[(k + 1) % corners.len()];
            self.line(self.place(from), self.place(to), color);
        }
    }

    /// Draws x and y of a curve in the square −1..1.
    pub fn curve(&mut self, curve: &Curve, color: Color) {
        let (points, lines) = curve.lines();
        for line in lines {
            let [from, to] = line.map(|at| self.place(points[at as usize].truncate()));
            self.line(from, to, color);
        }
    }

    /// Fills a triangle, whose corners lie in the square −1..1, with its edges.
    pub fn fill(&mut self, corners: [Vec2; 3], color: Color) {
        for pixel in bounding_box::printed(corners.map(|corner| self.place(corner))) {
            self.set(pixel, color);
        }
    }

    /// The place of a pixel's bytes.
    fn offset(&self, [x, y]: [i32; 2]) -> Option<usize> {
        let (x, y) = (u32::try_from(x).ok()?, u32::try_from(y).ok()?);
        let is_inside = x < self.width() && y < self.height();
        is_inside.then(|| (y as usize * self.width() as usize + x as usize) * 4)
    }

    /// The picture upside down: y up becomes y down.
    #[must_use]
    pub fn flipped(&self) -> Self {
        flip_vertical(&self.image).into()
    }

    /// Each pixel as a square of `times` × `times` pixels.
    #[must_use]
    pub fn magnified(&self, times: u32) -> Self {
        self.resampled([self.width() * times, self.height() * times], |[x, y]| {
            self.pixel([x, y].map(|at| at / times.cast_signed()))
        })
    }

    /// The picture at 1/`times` of its size: each pixel is the mean of a square, rounded.
    #[must_use]
    pub fn reduced(&self, times: u32) -> Self {
        let size = [self.width() / times, self.height() / times].map(|side| side.max(1));
        let times = times.cast_signed();
        self.resampled(size, |[left, top]| {
            let mut sums = [0_u32; 3];
            for y in 0..times {
                for x in 0..times {
                    let color = self.pixel([left * times + x, top * times + y]);
                    sums = [0, 1, 2].map(|k: usize| sums[k] + u32::from(color[k]));
                }
            }
            let count = (times * times).cast_unsigned();
            let mean = |sum: u32| u8::try_from((sum + count / 2) / count);
            sums.map(|sum| mean(sum).expect("a mean of bytes"))
        })
    }

    /// The picture as large as a square of `side` pixels allows, at a whole multiple of its size or
    /// a whole part of it.
    #[must_use]
    pub fn fitted(&self, side: u32) -> Self {
        let longest = self.width().max(self.height());
        if longest > side {
            self.reduced(longest.div_ceil(side))
        } else {
            self.magnified((side / longest.max(1)).max(1))
        }
    }

    /// The part of `size` pixels whose top left pixel is `from`.
    #[must_use]
    pub fn cropped(&self, [left, top]: [i32; 2], size: [u32; 2]) -> Self {
        self.resampled(size, |[x, y]| self.pixel([left + x, top + y]))
    }

    fn resampled(&self, [width, height]: [u32; 2], color: impl Fn([i32; 2]) -> Color) -> Self {
        let mut picture = Self::new(width, height);
        for y in 0..height.cast_signed() {
            for x in 0..width.cast_signed() {
                picture.set([x, y], color([x, y]));
            }
        }
        picture
    }

    /// Pictures from left to right, with a gap between them.
    #[must_use]
    pub fn side_by_side(pictures: &[Self]) -> Self {
        Self::in_columns(pictures.len().max(1), pictures)
    }

    /// Pictures in rows of `columns`, with gaps between them; each in a cell of the largest size.
    #[must_use]
    pub fn in_columns(columns: usize, pictures: &[Self]) -> Self {
        const GAP: u32 = 8;
        let columns = columns.max(1);
        let largest = |side: fn(&Self) -> u32| pictures.iter().map(side).max().unwrap_or(1);
        let cell = [largest(Self::width), largest(Self::height)];
        let counts = [
            pictures.len().min(columns),
            pictures.len().div_ceil(columns),
        ];
        let counts = counts.map(|count| u32::try_from(count.max(1)).expect("a few pictures"));
        let side = |axis: usize| counts[axis] * (cell[axis] + GAP) - GAP;
        let mut whole = Self::filled(side(0), side(1), Self::GAP);
        for (number, picture) in (0..).zip(pictures) {
            let place = [number % columns, number / columns];
            let corner = [0, 1].map(|axis: usize| {
                let place = u32::try_from(place[axis]).expect("a few pictures");
                (place * (cell[axis] + GAP)).cast_signed()
            });
            whole.paste(picture, corner);
        }
        whole
    }

    /// Copies a picture into this one, its top left pixel to `corner`.
    pub fn paste(&mut self, picture: &Self, [left, top]: [i32; 2]) {
        for y in 0..picture.height().cast_signed() {
            for x in 0..picture.width().cast_signed() {
                self.set([left + x, top + y], picture.pixel([x, y]));
            }
        }
    }

    /// The picture as the bytes of a file.
    ///
    /// # Errors
    /// If the format cannot store the picture's size.
    pub fn encode(&self, format: ImageFormat) -> Result<Vec<u8>, LadderError> {
        Ok(encode(&self.image, format)?)
    }

    /// A hash of the size and of all pixels: 64-bit FNV-1a over bytes.
    #[must_use]
    pub fn fingerprint(&self) -> u64 {
        let size = [self.width(), self.height()].map(u32::to_le_bytes);
        let bytes = size.iter().flatten().chain(&self.image.rgba);
        bytes.fold(0xCBF2_9CE4_8422_2325, |hash, &byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3)
        })
    }
}

impl From<Image> for Picture {
    fn from(image: Image) -> Self {
        Self { image }
    }
}
