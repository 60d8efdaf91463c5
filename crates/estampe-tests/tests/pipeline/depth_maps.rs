//! Depth comparison of `ShadowMap` at every SIMD level against the oracle, bit for bit.

use estampe_reference::depth_map::DepthMap;
use estampe_simd::{LANES, Lanes, Level, SimdBase, dispatch, f32x16};
use estampe_tests::Random;
use estampe_texture::{ShadowMap, sample_compare_level, sample_compare_sum};
use estampe_types::{Quad, Vec2};

const TAPS: usize = 9;

/// Sixteen fragments: u, v, reference depth.
type Packet = [[f32; LANES]; 3];

#[inline(always)]
fn wide<S: Lanes>(
    s: S,
    map: &ShadowMap,
    packet: &Packet,
    taps: &[[f32; 2]; TAPS],
) -> [[f32; LANES]; 2] {
    let [u, v, reference] = packet;
    let uv = Vec2::new(f32x16::load_array(s, *u), f32x16::load_array(s, *v));
    let reference = f32x16::load_array(s, *reference);
    [
        sample_compare_level(map, uv, reference).to_array(),
        sample_compare_sum(map, uv, taps, reference).to_array(),
    ]
}

/// The comparison with quads and with single fragments.
fn narrow(map: &ShadowMap, [u, v, reference]: &Packet, taps: &[[f32; 2]; TAPS]) {
    for first in (0..LANES).step_by(4) {
        let quad =
            |of: &[f32; LANES]| Quad([of[first], of[first + 1], of[first + 2], of[first + 3]]);
        let sum = sample_compare_sum(map, Vec2::new(quad(u), quad(v)), taps, quad(reference));
        for lane in first..first + 4 {
            let uv = Vec2::new(u[lane], v[lane]);
            let single = sample_compare_sum(map, uv, taps, reference[lane]);
            assert_eq!(single.to_bits(), sum.0[lane - first].to_bits());
        }
    }
}

fn check(image: &DepthMap, packet: &Packet, taps: &[[f32; 2]; TAPS]) {
    let map = ShadowMap::from_rows(image.width, image.height, &image.rows);
    let [u, v, reference] = packet;
    let mut expected = [[0.0_f32; LANES]; 2];
    for lane in 0..LANES {
        let at = |[x, y]: [f32; 2]| {
            image.sample_compare_level([u[lane] + x, v[lane] + y], reference[lane])
        };
        expected[0][lane] = at([0.0; 2]);
        for tap in taps {
            expected[1][lane] += at(*tap);
        }
    }
    for level in Level::all_available() {
        let got = dispatch!(level, s => wide(s, &map, packet, taps));
        assert_eq!(
            got.map(|lanes| lanes.map(f32::to_bits)),
            expected.map(|lanes| lanes.map(f32::to_bits)),
            "{}: {packet:?} of {}x{}",
            level.name(),
            image.width,
            image.height
        );
    }
    narrow(&map, packet, taps);
}

/// The offsets of 3×3 samples, this many texels apart.
fn taps(image: &DepthMap, apart: f32) -> [[f32; 2]; TAPS] {
    std::array::from_fn(|index| {
        let step = |k: usize, size: u32| (k as f32 - 1.0) * apart / size.max(1) as f32;
        [step(index % 3, image.width), step(index / 3, image.height)]
    })
}

fn image(random: &mut Random, rough: f32) -> DepthMap {
    let sides = [1, 2, 5, 63, 64, 65, 130];
    let (width, height) = (random.pick(&sides), random.pick(&sides));
    let slope = random.four(-0.004, 0.004);
    let depth = |index: u32, noise: f32| {
        let (x, y) = (index % width, index / width);
        (0.5 + slope[0] * x as f32 + slope[1] * y as f32 + noise).clamp(0.0, 1.0)
    };
    DepthMap {
        width,
        height,
        rows: (0..width * height)
            .map(|index| depth(index, rough * (random.unit() - 0.5)))
            .collect(),
    }
}

/// Rows: F2.
#[test]
fn random_places_of_rough_and_smooth_images() {
    for seed in 0..300 {
        let mut random = Random::new("depth maps", seed);
        let rough = random.pick(&[0.0, 0.01, 1.0]);
        let image = image(&mut random, rough);
        let apart = random.pick(&[1.0, 1.0, 0.3, 7.0]);
        let taps = taps(&image, apart);
        let spread = random.pick(&[0.02, 0.2, 1.5]);
        let [u, v] = [random.range(-0.1, 1.0), random.range(-0.1, 1.0)];
        let near = random.pick(&[0.004, 0.05, 0.6]);
        let packet = std::array::from_fn(|axis| {
            std::array::from_fn(|_| match axis {
                0 => u + random.unit() * spread,
                1 => v + random.unit() * spread,
                // A depth of the image, exactly or nearly.
                _ => {
                    let exact = image.rows[random.index(image.rows.len())];
                    exact
                        + if random.once_in(4) {
                            0.0
                        } else {
                            random.range(-near, near)
                        }
                }
            })
        });
        check(&image, &packet, &taps);
    }
}

#[test]
fn nan_infinite_and_huge_coordinates_and_references() {
    for seed in 0..100 {
        let mut random = Random::new("odd depth maps", seed);
        let image = image(&mut random, 0.1);
        let packet = std::array::from_fn(|_| {
            std::array::from_fn(|_| match random.once_in(2) {
                true => random.odd_number(),
                false => random.unit(),
            })
        });
        check(&image, &packet, &taps(&image, 1.0));
    }
}

#[test]
fn an_image_without_texels_reads_as_depth_zero() {
    let none = DepthMap {
        width: 0,
        height: 0,
        rows: Vec::new(),
    };
    let mut packet = [[0.25; LANES]; 3];
    packet[2] = std::array::from_fn(|lane| lane as f32 - 8.0);
    check(&none, &packet, &taps(&none, 0.1));
    let map = ShadowMap::from_rows(3, 3, &[0.5; 8]);
    assert_eq!((map.width(), map.texel(0, 0)), (0, 0.0));
    let map = ShadowMap::from_rows(u32::MAX, 0, &[]);
    assert_eq!(map.depths().len(), 0);
}
