//! YUV4MPEG2: frames without compression, which video encoders read from a pipe.
//!
//! Luma and chroma are those of video: 8 bits in the limited range, 16 to 235 and 16 to 240. With
//! luma weights k,
//!
//! ```text
//!   Y = 16 + 219·(kr·R + kg·G + kb·B)      Cb = 128 + 112·(B − L)/(1 − kb)      (0..1, L: the sum)
//! ```
//!
//! in integers, rounded to nearest. The format has no field for the weights: the command that reads
//! the frames must be told.

use super::{FrameRate, check_frame};
use estampe_scene::Image;
use std::io::{self, Write};

/// The resolution of chroma.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Chroma {
    /// A sample for each 2 × 2 texels, in their middle: the mean of their colours.
    #[default]
    Quarter,
    /// A sample for each texel.
    Full,
}

/// The weights of red, green and blue in luma.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum LumaWeights {
    /// ITU-R BT.601: 0.299, 0.587, 0.114.
    #[default]
    Bt601,
    /// ITU-R BT.709: 0.2126, 0.7152, 0.0722.
    Bt709,
}

impl LumaWeights {
    /// Of red and blue, in ten-thousandths; the rest is green's.
    fn of_red_and_blue(self) -> (i64, i64) {
        match self {
            Self::Bt601 => (2990, 1140),
            Self::Bt709 => (2126, 722),
        }
    }

    /// Luma of a sum of colours, times 10,000.
    fn sum(self, [r, g, b]: [i64; 3]) -> i64 {
        let (red, blue) = self.of_red_and_blue();
        red * r + (UNIT - red - blue) * g + blue * b
    }

    fn luma(self, color: [i64; 3]) -> u8 {
        sample(16, 219 * self.sum(color), UNIT * 255)
    }

    /// Cb and Cr of the mean of `count` colours.
    fn chroma(self, [r, g, b]: [i64; 3], count: i64) -> [u8; 2] {
        let (red, blue) = self.of_red_and_blue();
        let luma = self.sum([r, g, b]);
        [(b, blue), (r, red)].map(|(channel, weight)| {
            let scale = (UNIT - weight) * 255 * count;
            sample(128, 112 * (UNIT * channel - luma), scale)
        })
    }
}

/// The unit of the weights.
const UNIT: i64 = 10_000;

/// `zero` + `value`/`scale`, rounded to nearest.
fn sample(zero: i64, value: i64, scale: i64) -> u8 {
    let rounded = (2 * value + scale).div_euclid(2 * scale);
    u8::try_from(zero + rounded).unwrap_or(u8::MAX)
}

/// Writes frames, each treated as opaque.
#[derive(Debug)]
pub struct Y4mWriter<W> {
    out: W,
    size: (u32, u32),
    chroma: Chroma,
    weights: LumaWeights,
    planes: Vec<u8>,
}

impl<W: Write> Y4mWriter<W> {
    /// Writes the header.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn new(
        mut out: W,
        (width, height): (u32, u32),
        rate: FrameRate,
        (chroma, weights): (Chroma, LumaWeights),
    ) -> io::Result<Self> {
        let (frames, seconds) = (rate.frames(), rate.seconds());
        let sampling = match chroma {
            Chroma::Quarter => "420jpeg",
            Chroma::Full => "444",
        };
        writeln!(
            out,
            "YUV4MPEG2 W{width} H{height} F{frames}:{seconds} Ip A1:1 C{sampling} XCOLORRANGE=LIMITED"
        )?;
        Ok(Self {
            out,
            size: (width, height),
            chroma,
            weights,
            planes: Vec::new(),
        })
    }

    /// Writes a frame.
    ///
    /// # Errors
    /// If the frame has another size, or the output fails.
    pub fn add(&mut self, frame: &Image) -> io::Result<()> {
        check_frame(frame, self.size)?;
        self.planes.clear();
        let texels = frame.rgba.as_chunks::<4>().0;
        let weights = self.weights;
        let colors = texels.iter().map(|&texel| color(texel));
        self.planes.extend(colors.map(|color| weights.luma(color)));
        let step = match self.chroma {
            Chroma::Quarter => 2,
            Chroma::Full => 1,
        };
        let (width, height) = (frame.width as usize, frame.height as usize);
        let mut reds = Vec::new();
        for y in (0..height).step_by(step) {
            for x in (0..width).step_by(step) {
                let (mut sum, mut count) = ([0; 3], 0);
                for row in y..(y + step).min(height) {
                    for texel in &texels[row * width + x..row * width + (x + step).min(width)] {
                        let color = color(*texel);
                        sum = [sum[0] + color[0], sum[1] + color[1], sum[2] + color[2]];
                        count += 1;
                    }
                }
                let [cb, cr] = weights.chroma(sum, count);
                self.planes.push(cb);
                reds.push(cr);
            }
        }
        self.planes.extend_from_slice(&reds);
        self.out.write_all(b"FRAME\n")?;
        self.out.write_all(&self.planes)
    }
}

fn color([r, g, b, _]: [u8; 4]) -> [i64; 3] {
    [r, g, b].map(i64::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(frame: &Image, chroma: Chroma, weights: LumaWeights) -> (String, Vec<u8>) {
        let mut out = Vec::new();
        let rate = FrameRate::new(25, 2).expect("not 0");
        let size = (frame.width, frame.height);
        let mut writer = Y4mWriter::new(&mut out, size, rate, (chroma, weights)).expect("memory");
        writer.add(frame).expect("the frame");
        let end = out.iter().position(|&byte| byte == b'\n').expect("a line");
        let header = String::from_utf8(out[..end].to_vec()).expect("ASCII");
        let frame = out[end + 1..].strip_prefix(b"FRAME\n").expect("a frame");
        (header, frame.to_vec())
    }

    /// The colour bars of BT.601 and BT.709 at full amplitude.
    ///
    /// Rows: I4.
    #[test]
    fn primaries_have_the_codes_of_the_recommendations() {
        for (color, bt601, bt709) in [
            ([255, 255, 255], [235, 128, 128], [235, 128, 128]),
            ([0, 0, 0], [16, 128, 128], [16, 128, 128]),
            ([255, 0, 0], [81, 90, 240], [63, 102, 240]),
            ([0, 255, 0], [145, 54, 34], [173, 42, 26]),
            ([0, 0, 255], [41, 240, 110], [32, 240, 118]),
            ([255, 255, 0], [210, 16, 146], [219, 16, 138]),
        ] {
            let [r, g, b] = color;
            let frame = Image::filled(1, 1, [r, g, b, 255]);
            for (weights, expected) in [(LumaWeights::Bt601, bt601), (LumaWeights::Bt709, bt709)] {
                for chroma in [Chroma::Full, Chroma::Quarter] {
                    let (_, planes) = written(&frame, chroma, weights);
                    assert_eq!(planes, expected, "{color:?} {weights:?}");
                }
            }
        }
    }

    #[test]
    fn planes_have_the_sizes_of_the_header() {
        let mut frame = Image::filled(5, 3, [255, 0, 0, 255]);
        frame.rgba[..4].copy_from_slice(&[0, 0, 255, 255]);
        let (header, planes) = written(&frame, Chroma::Quarter, LumaWeights::Bt601);
        let expected = "YUV4MPEG2 W5 H3 F25:2 Ip A1:1 C420jpeg XCOLORRANGE=LIMITED";
        assert_eq!(header, expected);
        assert_eq!(planes.len(), 15 + 3 * 2 + 3 * 2);
        // A quarter of blue: 90 + (240 − 90)/4, and red where there is no blue.
        assert_eq!((planes[0], planes[1]), (41, 81));
        assert_eq!((planes[15], planes[16]), (128, 90));
        let (header, planes) = written(&frame, Chroma::Full, LumaWeights::Bt709);
        assert!(header.contains(" C444 "), "{header}");
        assert_eq!(planes.len(), 45);
        assert_eq!((planes[15], planes[16]), (240, 102));
    }
}
