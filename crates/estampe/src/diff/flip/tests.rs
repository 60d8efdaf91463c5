//! FLIP compared with a direct f64 implementation of the paper's formulas, and with the paper's
//! stated properties.

use std::f64::consts::PI;

use super::*;

/// The paper's 67 pixels per degree.
const PPD: f64 = PIXELS_PER_DEGREE;

mod oracle {
    //! Kernels in two dimensions, direct sums, the published matrix.

    use super::{Image, PI, PPD};

    type V3 = [f64; 3];

    // Linear sRGB to XYZ as the paper's supplement prints it.
    const TO_XYZ: [V3; 3] = [
        [
            10_135_552.0 / 24_577_794.0,
            8_788_810.0 / 24_577_794.0,
            4_435_075.0 / 24_577_794.0,
        ],
        [
            2_613_072.0 / 12_288_897.0,
            8_788_810.0 / 12_288_897.0,
            887_015.0 / 12_288_897.0,
        ],
        [
            1_425_312.0 / 73_733_382.0,
            8_788_810.0 / 73_733_382.0,
            70_074_185.0 / 73_733_382.0,
        ],
    ];

    fn apply(m: [V3; 3], v: V3) -> V3 {
        m.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
    }

    /// Cramer's rule.
    fn solve(m: [V3; 3], v: V3) -> V3 {
        let det = |m: [V3; 3]| {
            m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
                - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
                + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
        };
        [0, 1, 2].map(|column| {
            let mut replaced = m;
            for row in 0..3 {
                replaced[row][column] = v[row];
            }
            det(replaced) / det(m)
        })
    }

    fn white() -> V3 {
        apply(TO_XYZ, [1.0; 3])
    }

    fn linear(v: u8) -> f64 {
        let v = f64::from(v) / 255.0;
        if v <= 0.04045 {
            v / 12.92
        } else {
            libm::pow((v + 0.055) / 1.055, 2.4)
        }
    }

    fn ycxcz(linear_rgb: V3) -> V3 {
        let (v, w) = (apply(TO_XYZ, linear_rgb), white());
        let [x, y, z] = [v[0] / w[0], v[1] / w[1], v[2] / w[2]];
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    fn lab(linear_rgb: V3) -> V3 {
        let (v, w) = (apply(TO_XYZ, linear_rgb), white());
        let f = |t: f64| {
            let delta: f64 = 6.0 / 29.0;
            if t > delta.powi(3) {
                libm::cbrt(t)
            } else {
                t / (3.0 * delta * delta) + 4.0 / 29.0
            }
        };
        let [x, y, z] = [f(v[0] / w[0]), f(v[1] / w[1]), f(v[2] / w[2])];
        let l = 116.0 * y - 16.0;
        [l, 0.01 * l * 500.0 * (x - y), 0.01 * l * 200.0 * (y - z)]
    }

    fn hyab(a: V3, b: V3) -> f64 {
        (a[0] - b[0]).abs() + ((a[1] - b[1]).powi(2) + (a[2] - b[2]).powi(2)).sqrt()
    }

    struct Picture {
        width: i64,
        height: i64,
        ycxcz: Vec<V3>,
    }

    impl Picture {
        fn of(image: &Image) -> Self {
            let ycxcz = image
                .rgba
                .chunks(4)
                .map(|t| ycxcz([0, 1, 2].map(|c| linear(t[c]))))
                .collect();
            Self {
                width: image.width.into(),
                height: image.height.into(),
                ycxcz,
            }
        }

        fn at(&self, x: i64, y: i64) -> V3 {
            let (x, y) = (x.clamp(0, self.width - 1), y.clamp(0, self.height - 1));
            self.ycxcz[(y * self.width + x) as usize]
        }

        /// Σ kernel(i, j) · value(x + i, y + j).
        fn filtered(
            &self,
            (x, y): (i64, i64),
            reach: i64,
            kernel: &dyn Fn(f64, f64) -> f64,
            value: &dyn Fn(V3) -> f64,
        ) -> f64 {
            let mut sum = 0.0;
            for j in -reach..=reach {
                for i in -reach..=reach {
                    sum += kernel(i as f64, j as f64) * value(self.at(x + i, y + j));
                }
            }
            sum
        }
    }

    fn sum_of(reach: i64, f: &dyn Fn(f64, f64) -> f64) -> f64 {
        let line = || (-reach..=reach).map(|v| v as f64);
        line().map(|j| line().map(|i| f(i, j)).sum::<f64>()).sum()
    }

    /// The perceived colour of a pixel: Hunt-adjusted L*a*b* after contrast sensitivity.
    fn seen(picture: &Picture, at: (i64, i64)) -> V3 {
        let reach = (3.0 * (0.04 / (2.0 * PI * PI)).sqrt() * PPD).ceil() as i64;
        let parameters = [
            (1.0, 0.0047, 0.0, 1e-5),
            (1.0, 0.0053, 0.0, 1e-5),
            (34.1, 0.04, 13.5, 0.025),
        ];
        let mut filtered = [0.0; 3];
        for (c, (a1, b1, a2, b2)) in parameters.into_iter().enumerate() {
            let kernel = |i: f64, j: f64| {
                let z = (i * i + j * j) / (PPD * PPD);
                a1 * (PI / b1).sqrt() * libm::exp(-PI * PI * z / b1)
                    + a2 * (PI / b2).sqrt() * libm::exp(-PI * PI * z / b2)
            };
            let total = sum_of(reach, &kernel);
            filtered[c] = picture.filtered(at, reach, &kernel, &|v| v[c]) / total;
        }
        let y = (filtered[0] + 16.0) / 116.0;
        let w = white();
        let xyz = [
            (filtered[1] / 500.0 + y) * w[0],
            y * w[1],
            (y - filtered[2] / 200.0) * w[2],
        ];
        lab(solve(TO_XYZ, xyz).map(|v| v.clamp(0.0, 1.0)))
    }

    /// Strength of edges and points.
    fn features(picture: &Picture, at: (i64, i64)) -> [f64; 2] {
        let sigma = 0.5 * 0.082 * PPD;
        let reach = (3.0 * sigma).ceil() as i64;
        let bell = |i: f64, j: f64| libm::exp(-(i * i + j * j) / (2.0 * sigma * sigma));
        let edge = |i: f64, j: f64| -i * bell(i, j);
        let point = |i: f64, j: f64| (i * i / (sigma * sigma) - 1.0) * bell(i, j);
        let kernels: [&dyn Fn(f64, f64) -> f64; 2] = [&edge, &point];
        kernels.map(|kernel| {
            let positive = sum_of(reach, &|i, j| kernel(i, j).max(0.0));
            let negative = sum_of(reach, &|i, j| -kernel(i, j).min(0.0));
            let balanced = |i: f64, j: f64| {
                let v = kernel(i, j);
                v / if v < 0.0 { negative } else { positive }
            };
            let luminance = |v: V3| (v[0] + 16.0) / 116.0;
            let along_x = picture.filtered(at, reach, &balanced, &luminance);
            let along_y = picture.filtered(at, reach, &|i, j| balanced(j, i), &luminance);
            (along_x * along_x + along_y * along_y).sqrt()
        })
    }

    pub(super) fn flip(a: &Image, b: &Image) -> Vec<f64> {
        let (pa, pb) = (Picture::of(a), Picture::of(b));
        let largest = libm::pow(hyab(lab([0.0, 1.0, 0.0]), lab([0.0, 0.0, 1.0])), 0.7);
        let mut values = Vec::new();
        for y in 0..pa.height {
            for x in 0..pa.width {
                let power = libm::pow(hyab(seen(&pa, (x, y)), seen(&pb, (x, y))), 0.7);
                let knee = 0.4 * largest;
                let color = if power < knee {
                    0.95 / knee * power
                } else {
                    0.95 + (power - knee) / (largest - knee) * 0.05
                };
                let (fa, fb) = (features(&pa, (x, y)), features(&pb, (x, y)));
                let larger = (fa[0] - fb[0]).abs().max((fa[1] - fb[1]).abs());
                let feature = libm::pow(larger / 2.0_f64.sqrt(), 0.5).clamp(0.0, 1.0);
                values.push(libm::pow(color, 1.0 - feature));
            }
        }
        values
    }
}

fn noise(width: u32, height: u32, seed: u64, step: u32) -> Image {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut texel_rgb = [0; 3];
    let mut image = Image::filled(width, height, [0, 0, 0, 255]);
    for (i, texel) in image.rgba.as_chunks_mut::<4>().0.iter_mut().enumerate() {
        if (i as u32).is_multiple_of(step) {
            texel_rgb = [0; 3].map(|_| random.u8(..));
        }
        let [r, g, b] = texel_rgb;
        *texel = [r, g, b, 255];
    }
    image
}

fn plain(rgb: [u8; 3]) -> Image {
    Image::filled(40, 30, [rgb[0], rgb[1], rgb[2], 255])
}

fn mean(a: &Image, b: &Image) -> f64 {
    flip(a, b).mean()
}

#[track_caller]
fn check_oracle(a: &Image, b: &Image) {
    let fast = flip(a, b);
    for (at, (&got, want)) in fast.values.iter().zip(oracle::flip(a, b)).enumerate() {
        let off = (f64::from(got) - want).abs();
        assert!(off < 2e-4, "pixel {at}: {got} instead of {want}");
    }
}

#[test]
fn equals_the_papers_formulas_on_noise() {
    check_oracle(&noise(24, 19, 1, 1), &noise(24, 19, 2, 1));
    check_oracle(&noise(24, 19, 3, 5), &noise(24, 19, 4, 7));
}

#[test]
fn equals_the_papers_formulas_on_lines_and_points() {
    let ground = Image::filled(31, 23, [90, 120, 60, 255]);
    let mut drawn = ground.clone();
    for x in 4..20 {
        let at = (11 * 31 + x) * 4;
        drawn.rgba[at..at + 3].copy_from_slice(&[250, 240, 20]);
    }
    let at = (3 * 31 + 25) * 4;
    drawn.rgba[at..at + 3].copy_from_slice(&[0, 0, 255]);
    check_oracle(&ground, &drawn);
}

#[test]
fn equals_the_papers_formulas_on_the_smallest_pictures() {
    check_oracle(&noise(1, 1, 5, 1), &noise(1, 1, 6, 1));
    check_oracle(&noise(3, 1, 7, 1), &noise(3, 1, 8, 1));
    check_oracle(&noise(1, 4, 9, 1), &noise(1, 4, 10, 1));
}

#[test]
fn identical_pictures_are_zero_everywhere() {
    let image = noise(70, 40, 3, 2);
    assert!(flip(&image, &image).values.iter().all(|&v| v == 0.0));
}

#[test]
fn black_and_white_are_nearly_as_far_as_can_be() {
    // ΔL* = 100 is 0.608 of the furthest pair to the power 0.7: 0.95 + 0.05 · 0.208 / 0.6.
    let value = mean(&plain([0; 3]), &plain([255; 3]));
    assert!((0.967..0.968).contains(&value), "{value}");
    // Green and blue are the furthest pair by definition.
    let value = mean(&plain([0, 255, 0]), &plain([0, 0, 255]));
    assert!((0.9999..=1.0).contains(&value), "{value}");
}

#[test]
fn the_order_of_the_pictures_does_not_matter() {
    let (a, b) = (noise(60, 50, 1, 4), noise(60, 50, 9, 3));
    assert_eq!(flip(&a, &b), flip(&b, &a));
}

#[test]
fn more_difference_is_more_flip() {
    let steps: Vec<f64> = (0..=20)
        .map(|i| mean(&plain([100; 3]), &plain([100 + i * 7; 3])))
        .collect();
    assert!(steps.windows(2).all(|pair| pair[0] < pair[1]), "{steps:?}");

    // The larger the changed area, the larger the mean.
    let ground = plain([100; 3]);
    let areas: Vec<f64> = (0..6)
        .map(|rows| {
            let mut image = ground.clone();
            image.rgba[..rows * 5 * 40 * 4].fill(200);
            for texel in image.rgba.as_chunks_mut::<4>().0 {
                texel[3] = 255;
            }
            mean(&ground, &image)
        })
        .collect();
    assert!(areas.windows(2).all(|pair| pair[0] < pair[1]), "{areas:?}");
}

#[test]
fn the_eye_blurs_fine_dither_away() {
    // A chequerboard of single pixels looks like its mean; one of 8 pixels does not.
    let board = |side: u32| {
        let mut image = plain([0; 3]);
        for (i, texel) in image.rgba.as_chunks_mut::<4>().0.iter_mut().enumerate() {
            let (x, y) = (i as u32 % 40, i as u32 / 40);
            let value = if (x / side + y / side).is_multiple_of(2) {
                90
            } else {
                110
            };
            *texel = [value, value, value, 255];
        }
        image
    };
    let ground = plain([100; 3]);
    let (fine, coarse) = (mean(&ground, &board(1)), mean(&ground, &board(8)));
    assert!(fine < 0.3 * coarse, "{fine} {coarse}");
}

#[test]
fn tiles_leave_no_seams() {
    // Wider and taller than a tile: the far corner equals the same corner of a cropped image.
    let (width, height) = (TILE_WIDTH as u32 + 50, TILE_HEIGHT as u32 + 40);
    let (a, b) = (noise(width, height, 1, 3), noise(width, height, 2, 3));
    let part = |image: &Image, left: u32, top: u32| {
        let rows = top..height;
        let rgba = rows
            .flat_map(|y| (left..width).flat_map(move |x| image.texel(x, y)))
            .collect();
        Image {
            width: width - left,
            height: height - top,
            rgba,
        }
    };
    let (left, top) = (TILE_WIDTH as u32 - 45, TILE_HEIGHT as u32 - 30);
    let whole = flip(&a, &b);
    let corner = flip(&part(&a, left, top), &part(&b, left, top));
    for y in top + 12..height {
        for x in left + 12..width {
            let expected = whole.values[(y * width + x) as usize];
            let got = corner.values[((y - top) * (width - left) + x - left) as usize];
            assert_eq!(got, expected, "({x}, {y})");
        }
    }
}

#[test]
fn alpha_counts_over_the_worse_of_two_grounds() {
    let clear = Image::filled(40, 30, [255, 255, 255, 0]);
    let white = plain([255; 3]);
    // Over white the images are the same; over black they are black and white.
    let value = mean(&clear, &white);
    assert!(
        (value - mean(&plain([0; 3]), &white)).abs() < 1e-6,
        "{value}"
    );
    // A colour with alpha 0 is invisible.
    let other = Image::filled(40, 30, [9, 8, 7, 0]);
    assert_eq!(mean(&clear, &other), 0.0);
}
