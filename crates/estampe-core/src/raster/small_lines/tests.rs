//! Small lines are covered as lines are that are drawn alone.

use super::*;
use crate::bounds::lines::LinePrimitive;
use crate::bounds::primitives::WindowVertex;
use crate::geometry::line_style::LineStyle;
use crate::raster::pixel_list::{PixelList, Pixels, lane_of};
use crate::raster::{CoverageList, line};
use estampe_simd::{Lane, Level, dispatch, u32x16};

const TILE: TileShape = TileShape {
    x: 192,
    y: 128,
    log2: 6,
};

/// By lane and sample, the covered pixels: packet·16 + lane, in ascending order.
type Pixelwise = Vec<Vec<Vec<u32>>>;

/// Covers each line as it is covered alone.
fn alone<const N: usize>(lines: &[LinePrimitive], shape: LineShape, rect: &PixelRect) -> Pixelwise {
    let style = LineStyle {
        shape,
        stipple: None,
    };
    let of_line = |line: &LinePrimitive| {
        let mut list = CoverageList::<N>::default();
        list.set_samples(SampleSet::new(N));
        match style.plain_rectangle() {
            Some(width) => {
                let level = Level::best();
                dispatch!(level, s => line::cover_rectangle(s, (line, width), TILE, rect, &mut list));
                list.clip(rect);
            }
            None => line::cover(line, &style, TILE, rect, &mut list),
        }
        let mut pixels = vec![Vec::new(); N];
        for item in list.items() {
            for (pixels, mask) in pixels.iter_mut().zip(item.masks) {
                let lanes = (0..16).filter(|lane| mask >> lane & 1 == 1);
                pixels.extend(lanes.map(|lane| u32::from(item.packet) * 16 + lane));
            }
        }
        for pixels in &mut pixels {
            pixels.sort_unstable();
        }
        pixels
    };
    lines.iter().map(of_line).collect()
}

/// The lanes that a line takes, which are the same at every level; 0 if it is drawn alone.
fn lanes_of<const N: usize>(line: &LinePrimitive, shape: LineShape, quads: bool) -> usize {
    let mut packet = LinePacket::default();
    packet.set(Lane::new(0), line);
    let of_level = |level| {
        let sizes = dispatch!(@wide level, s => LineSizes::new::<_, N>(s, &packet, shape, quads),
            scalar => unreachable!("it draws line by line"));
        usize::from(sizes.one & 1) + 2 * usize::from(sizes.two & 1)
    };
    let levels = Level::all_available().into_iter();
    let mut sizes = levels.filter(|level| !level.is_scalar()).map(of_level);
    let size = sizes.next().unwrap_or(0);
    assert!(sizes.all(|of_level| of_level == size), "{line:?}");
    size
}

/// Covers the lines of a packet together.
fn together<const N: usize>(
    level: Level,
    lines: (&LinePacket, u16, LineHalves),
    (shape, quads): (LineShape, bool),
    rect: &PixelRect,
) -> (u16, Pixelwise) {
    let mut small = SmallBoxes::<N>::default();
    let mut found = vec![vec![Vec::new(); N]; LANES];
    let samples = SampleSet::new(N);
    let covered = dispatch!(@wide level, s => {
        let tile = (TILE, rect);
        let covered = small.cover_lines(s, lines, (shape, quads), (tile, samples));
        let mut list = PixelList::default();
        for (sample, number) in (0..N).zip(0..) {
            small.list(s, sample, covered, &mut list);
            for at in (0..list.len()).step_by(LANES) {
                let Pixels(pixels) = list.sixteen(s, at);
                let places = small.pixels_in_tile(s, Pixels(pixels), pixels >> 6).to_array();
                let pixels = u32x16::to_array(pixels);
                for (pixel, place) in pixels.into_iter().zip(places).take(list.len() - at) {
                    found[lane_of(pixel)][number].push(place);
                }
            }
        }
        covered
    }, scalar => 0);
    for pixels in found.iter_mut().flatten() {
        pixels.sort_unstable();
    }
    (covered, found)
}

fn check<const N: usize>() {
    let mut state = 11u32;
    let mut random = |below: i32| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        i32::try_from(state >> 8).unwrap() % below
    };
    let (mut whole, mut halves) = (0, 0);
    for turn in 0..600 {
        let shape = match turn % 6 {
            0 => LineShape::Columns { width: 1 },
            1 => LineShape::Columns { width: 3 },
            at => LineShape::Rectangle {
                width: [0.4, 1.0, 1.0, 2.3][at - 2],
                smooth: false,
            },
        };
        let quads = random(2) == 0;
        let rect = match random(3) {
            0 => PixelRect {
                x0: 3,
                y0: 5,
                x1: 50,
                y1: 41,
            },
            _ => PixelRect {
                x0: 0,
                y0: 0,
                x1: 64,
                y1: 64,
            },
        };
        let (mut lines, mut packet, mut lane) = (Vec::new(), LinePacket::default(), 0);
        let mut of_packet = LineHalves::default();
        let mut lanes_of_lines = Vec::new();
        while lane < LANES - 1 {
            let mut a = [TILE.x, TILE.y].map(|at| at * 256 - 1024 + random(72 * 256));
            let reach = [300, 1500, 2000, 3000][turn / 6 % 4];
            let mut way = [0; 2].map(|_| random(2 * reach) - reach);
            match random(8) {
                0 => way[0] = 0,
                1 => way[1] = 0,
                2 => way[1] = -way[0],
                3 => way = way.map(|way| way & !0x7F),
                _ => {}
            }
            if random(4) == 0 {
                a = a.map(|at| at & !0x7F);
            }
            let end = |[x, y]: [i32; 2]| WindowVertex {
                x,
                y,
                ..WindowVertex::default()
            };
            let line = LinePrimitive {
                ends: [end(a), end([a[0] + way[0], a[1] + way[1]])],
                provoking: Default::default(),
                front: true,
                stipple: 0,
            };
            let count = lanes_of::<N>(&line, shape, quads);
            for half in 0..count {
                packet.set(Lane::new(lane + half), &line);
                of_packet.any |= u16::from(count > 1) << (lane + half);
                of_packet.seconds |= u16::from(half == 1) << (lane + half);
            }
            if count > 0 {
                lines.push(line);
                lanes_of_lines.push(lane..lane + count);
            }
            lane += count;
        }
        let lanes = u16::MAX >> (LANES - lane);
        let expected = alone::<N>(&lines, shape, &rect);
        for level in Level::all_available()
            .into_iter()
            .filter(|level| !level.is_scalar())
        {
            let of_packet = (&packet, lanes, of_packet);
            let (covered, found) = together::<N>(level, of_packet, (shape, quads), &rect);
            for ((lanes, line), expected) in lanes_of_lines.iter().zip(&lines).zip(&expected) {
                let is_covered = lanes.clone().map(|lane| covered >> lane & 1 == 1);
                let is_covered: Vec<_> = is_covered.collect();
                assert!(is_covered.iter().all(|is| *is == is_covered[0]), "{line:?}");
                if !is_covered[0] {
                    continue;
                }
                let mut pixels = found[lanes.start].clone();
                if lanes.len() == 2 {
                    for (pixels, more) in pixels.iter_mut().zip(&found[lanes.start + 1]) {
                        pixels.extend(more);
                        pixels.sort_unstable();
                    }
                    halves += 1;
                } else {
                    whole += 1;
                }
                assert_eq!(&pixels, expected, "{level:?} {shape:?} {rect:?} {line:?}");
            }
        }
    }
    assert!(whole > 3000, "{whole} lines");
    assert!(halves > 300 || N > 1, "{halves} lines in halves");
}

#[test]
fn lines_are_covered_together_as_alone() {
    check::<1>();
}

#[test]
fn samples_of_lines_are_covered_together_as_alone() {
    check::<4>();
}
