//! Gathers and scatters: bounds, and lanes that name the same element.

use super::*;

#[inline(always)]
fn gathered<S: Lanes>(s: S, table: &[u32], index: [u32; LANES]) -> [u32; LANES] {
    s.gather(table, u32x16::load_array(s, index)).to_array()
}

#[test]
fn gather_clamps_every_index() {
    let table: Vec<u32> = (0..37).map(|i| i * 3 + 1).collect();
    let index = [
        0,
        1,
        36,
        37,
        38,
        1 << 30,
        1 << 31,
        u32::MAX,
        5,
        9,
        12,
        7,
        35,
        20,
        2,
        3,
    ];
    for level in Level::all_available() {
        let got = dispatch!(level, s => gathered(s, &table, index));
        for (value, at) in got.into_iter().zip(index) {
            assert_eq!(value, table[(at as usize).min(36)], "{level:?} index {at}");
        }
        let empty = dispatch!(level, s => gathered(s, &[], index));
        assert_eq!(empty, [0; LANES], "{level:?}");
    }
}

#[inline(always)]
fn scatter<S: Lanes>(s: S, table: &mut [u32], index: [u32; LANES], lanes: u16) {
    let values = u32x16::load_array(s, [100; LANES]) + u32x16::load_array(s, NUMBERS);
    s.scatter(table, u32x16::load_array(s, index), values, lanes);
}

const NUMBERS: [u32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];

#[test]
fn lanes_that_repeat_an_earlier_one_are_found() {
    let mut values = NUMBERS;
    [values[3], values[7], values[15], values[12]] = [u32::MAX; 4];
    for level in Level::all_available() {
        for lanes in [u16::MAX, 0, !(1 << 3), !(1 << 7), 1 << 15 | 1 << 12] {
            let mut expected = 0u16;
            for lane in 0..LANES {
                let earlier =
                    (0..lane).any(|at| lanes >> at & 1 == 1 && values[at] == values[lane]);
                expected |= u16::from(earlier && lanes >> lane & 1 == 1) << lane;
            }
            let found = dispatch!(level, s => s.repeats(u32x16::load_array(s, values), lanes));
            assert_eq!(found.unwrap_or(expected), expected, "{level:?} {lanes:#x}");
        }
    }
}

#[test]
fn scatter_stores_the_last_of_equal_indices_and_leaves_out_those_beyond() {
    let index = [
        0,
        1,
        36,
        37,
        38,
        1 << 30,
        1 << 31,
        u32::MAX,
        5,
        9,
        5,
        7,
        35,
        9,
        5,
        3,
    ];
    for level in Level::all_available() {
        for lanes in [u16::MAX, 0, 0xA5C3, 0x0410, 1 << 8] {
            let mut expected = [7; 37];
            for (lane, at) in index.into_iter().enumerate() {
                if let (1, Some(to)) = (lanes >> lane & 1, expected.get_mut(at as usize)) {
                    *to = 100 + NUMBERS[lane];
                }
            }
            let mut table = [7; 37];
            dispatch!(level, s => scatter(s, &mut table, index, lanes));
            assert_eq!(table, expected, "{level:?} {lanes:#x}");
        }
        dispatch!(level, s => scatter(s, &mut [], index, u16::MAX));
    }
}

#[inline(always)]
fn scatter_to_four_lines<S: Lanes>(s: S, table: &mut [u32], index: [u32; LANES], lanes: [u16; 4]) {
    let index = u32x16::load_array(s, index);
    s.scatter_to_four_lines(table, index, u32x16::load_array(s, NUMBERS) + 100, lanes);
}

#[test]
fn words_go_to_the_lines_that_have_their_lane() {
    // Two packets of four lines each. Some places come twice; the last lanes' lines are not all in
    // the table.
    let index = [0, 1, 15, 64, 7, 79, 70, 3, 9, 2, 12, 7, 5, 79, 80, u32::MAX];
    for level in Level::all_available() {
        for lanes in [
            [u16::MAX; 4],
            [0; 4],
            [0xA5C3, 0x0410, 0, 0x8001],
            [0, 0x3FFF, 0x2000, 0x00FF],
            [1 << 15, 0, 0, 1 << 8],
        ] {
            let mut expected = [7; 128];
            for (lane, at) in index.into_iter().enumerate().take(14) {
                for line in 0..4 {
                    if lanes[line] >> lane & 1 == 1 {
                        expected[at as usize + line * LANES] = 100 + NUMBERS[lane];
                    }
                }
            }
            let mut table = [7; 128];
            dispatch!(level, s => scatter_to_four_lines(s, &mut table, index, lanes));
            assert_eq!(table, expected, "{level:?} {lanes:x?}");
        }
        dispatch!(level, s => scatter_to_four_lines(s, &mut [], index, [u16::MAX; 4]));
        dispatch!(level, s => scatter_to_four_lines(s, &mut [0; 48], index, [u16::MAX; 4]));
    }
}

/// Words of `N` lines of each lane.
#[inline(always)]
fn of_lines<S: Lanes, const N: usize>(
    s: S,
    table: &mut [u32],
    index: [u32; LANES],
    stored: Option<u16>,
) -> [[u32; LANES]; N] {
    let index = u32x16::load_array(s, index);
    let words = s.gather_lines::<N>(table, index);
    if let Some(lanes) = stored {
        let mut new = words;
        for (new, line) in new.iter_mut().zip(1..) {
            *new = u32x16::load_array(s, NUMBERS) + line * 100;
        }
        s.scatter_lines(table, index, new, lanes);
    }
    let mut out = [[0; LANES]; N];
    for (out, words) in out.iter_mut().zip(words) {
        *out = words.to_array();
    }
    out
}

#[expect(clippy::cast_possible_truncation, reason = "small numbers")]
fn check_lines<const N: usize>(level: Level) {
    // As in an attachment: packets of N lines each.
    let places = [0, 1, 15, 16, 7, 31, 30, 3, 9, 2, 12, 7, 5, 31, 4, 7];
    let index = places.map(|place| (place - place % 16) * N as u32 + place % 16);
    let before: Vec<u32> = (1000..).take(2 * N * LANES).collect();
    let mut table = before.clone();
    let words = dispatch!(level, s => of_lines::<_, N>(s, &mut table, index, None));
    for (line, words) in words.iter().enumerate() {
        let expected = index.map(|at| before[at as usize + line * LANES]);
        assert_eq!(words, &expected, "{level:?}, line {line} of {N}");
    }
    for lanes in [u16::MAX, 0, 0xA5C3, 0x0410, 1 << 8] {
        let (mut table, mut expected) = (before.clone(), before.clone());
        dispatch!(level, s => of_lines::<_, N>(s, &mut table, index, Some(lanes)));
        for line in 0..N {
            for (lane, at) in index.into_iter().enumerate() {
                if lanes >> lane & 1 == 1 {
                    expected[at as usize + line * LANES] = NUMBERS[lane] + 100 * (line as u32 + 1);
                }
            }
        }
        assert_eq!(table, expected, "{level:?}, {N} lines of {lanes:#x}");
    }
    let beyond = [u32::MAX; LANES];
    let mut short = vec![1; LANES * N];
    let words = dispatch!(level, s => of_lines::<_, N>(s, &mut short, beyond, Some(u16::MAX)));
    assert_eq!(
        words, [[1; LANES]; N],
        "{level:?}, an index beyond {N} lines"
    );
    assert_eq!(
        short,
        vec![1; LANES * N],
        "{level:?}, nothing is stored beyond {N} lines"
    );
}

#[test]
fn lines_are_as_many_gathers_and_scatters() {
    for level in Level::all_available() {
        check_lines::<1>(level);
        check_lines::<2>(level);
        check_lines::<4>(level);
    }
}

#[inline(always)]
fn fours<S: Lanes>(s: S, table: &[u32], index: [u32; LANES]) -> [[u32; LANES]; 4] {
    let [a, b, c, d] = s.gather_four(table, u32x16::load_array(s, index));
    [a.to_array(), b.to_array(), c.to_array(), d.to_array()]
}

#[test]
fn four_neighbours_stay_inside_the_table() {
    let index = [
        0,
        1,
        2,
        3,
        4,
        5,
        31,
        32,
        33,
        34,
        1 << 30,
        1 << 31,
        u32::MAX,
        u32::MAX - 3,
        12,
        7,
    ];
    for len in [0, 1, 3, 4, 5, 8, 37] {
        let table: Box<[u32]> = (0..len).map(|i| i * 3 + 1).collect();
        for level in Level::all_available() {
            let got = dispatch!(level, s => fours(s, &table, index));
            for (lane, at) in index.into_iter().enumerate() {
                let expected = match table.len().checked_sub(4) {
                    Some(last) => {
                        let at = (at as usize).min(last);
                        [table[at], table[at + 1], table[at + 2], table[at + 3]]
                    }
                    None => [0; 4],
                };
                let got = got.map(|word| word[lane]);
                assert_eq!(got, expected, "{level:?} {at} of {len}");
            }
        }
    }
}

#[inline(always)]
fn pairs<S: Lanes>(s: S, table: &[u32], index: [u32; LANES]) -> [[u32; LANES]; 2] {
    let [a, b] = s.gather_pair(table, u32x16::load_array(s, index));
    [a.to_array(), b.to_array()]
}

#[test]
fn two_neighbours_stay_inside_the_table() {
    let index = [
        0,
        1,
        2,
        3,
        4,
        5,
        31,
        32,
        33,
        34,
        1 << 30,
        1 << 31,
        u32::MAX,
        u32::MAX - 3,
        12,
        7,
    ];
    for len in [0, 1, 2, 3, 8, 37] {
        let table: Box<[u32]> = (0..len).map(|i| i * 3 + 1).collect();
        for level in Level::all_available() {
            let got = dispatch!(level, s => pairs(s, &table, index));
            for (lane, at) in index.into_iter().enumerate() {
                let expected = match table.len().checked_sub(2) {
                    Some(last) => {
                        let at = (at as usize).min(last);
                        [table[at], table[at + 1]]
                    }
                    None => [0; 2],
                };
                let got = got.map(|word| word[lane]);
                assert_eq!(got, expected, "{level:?} {at} of {len}");
            }
        }
    }
}

#[inline(always)]
fn squares<S: Lanes>(s: S, table: &[u32], index: [u32; LANES], stride: u32) -> [[u32; LANES]; 4] {
    let [a, b, c, d] = s.gather_square(table, u32x16::load_array(s, index), stride);
    [a.to_array(), b.to_array(), c.to_array(), d.to_array()]
}

/// Every level, once for each way in which it loads squares. The levels are set to the ways while
/// this is iterated.
fn every_way_to_load_squares() -> impl Iterator<Item = Level> {
    let levels = Level::all_available().into_iter();
    #[cfg(target_arch = "x86_64")]
    let levels = levels.flat_map(|level| {
        let ways = [SquareLoads::Gathers, SquareLoads::Loads];
        ways.into_iter().filter_map(move |way| {
            level.set_square_loads(way);
            (level.square_loads() == way).then_some(level)
        })
    });
    levels
}

#[test]
fn squares_stay_inside_the_table() {
    let index = [
        0,
        1,
        30,
        31,
        32,
        33,
        1 << 30,
        1 << 31,
        u32::MAX,
        u32::MAX - 7,
        12,
        7,
        29,
        20,
        2,
        3,
    ];
    let levels = Level::all_available();
    let has_gathers = |level: &&Level| ["avx2", "avx512"].contains(&level.name());
    let ways = levels.len() + levels.iter().filter(has_gathers).count();
    assert_eq!(every_way_to_load_squares().count(), ways);
    // Tables are as long as their allocation, so that a memory checker would see a read beyond the
    // end.
    for len in [0, 1, 2, 6, 7, 8, 37] {
        let table: Box<[u32]> = (0..len).map(|i| i * 3 + 1).collect();
        for stride in [0, 1, 5, 35, 36, u32::MAX] {
            for level in every_way_to_load_squares() {
                let got = dispatch!(level, s => squares(s, &table, index, stride));
                let last = u64::from(len).checked_sub(u64::from(stride) + 2);
                for (lane, at) in index.into_iter().enumerate() {
                    let expected = match last {
                        Some(last) => {
                            let at = u64::from(at).min(last) as usize;
                            let below = at + stride as usize;
                            [table[at], table[at + 1], table[below], table[below + 1]]
                        }
                        None => [0; 4],
                    };
                    let got = got.map(|corner| corner[lane]);
                    assert_eq!(got, expected, "{level:?} {at} of {len}, stride {stride}");
                }
            }
        }
    }
}
