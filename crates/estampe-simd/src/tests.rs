//! Every operation of [`Lanes`], at every SIMD level, compared with scalar code.

#![expect(clippy::cast_possible_truncation, reason = "tests know their numbers")]

use super::*;

const ODD: [f32; 20] = [
    0.0,
    -0.0,
    0.5,
    -0.5,
    1.5,
    -1.5,
    2.5,
    1e-40,
    -1e-40,
    8_388_607.5,
    -8_388_607.5,
    8_388_608.0,
    1e30,
    -1e30,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::NAN,
    0.999_999_94,
    -2.0,
    4_194_303.5,
];

fn packets() -> impl Iterator<Item = ([f32; LANES], [f32; LANES])> {
    (0..ODD.len()).flat_map(|shift| {
        (0..ODD.len()).map(move |stride| {
            let mut pair = ([0.0; LANES], [0.0; LANES]);
            for lane in 0..LANES {
                pair.0[lane] = ODD[(lane + shift) % ODD.len()];
                pair.1[lane] = ODD[(lane * (stride + 1) + shift) % ODD.len()];
            }
            pair
        })
    })
}

/// The payload of a NaN is unspecified.
fn same(got: f32, expected: f32) -> bool {
    got.to_bits() == expected.to_bits() || got.is_nan() && expected.is_nan()
}

#[inline(always)]
fn min_max_floor<S: Lanes>(s: S, a: [f32; LANES], b: [f32; LANES]) -> [[f32; LANES]; 3] {
    let (a, b) = (f32x16::load_array(s, a), f32x16::load_array(s, b));
    [
        s.min_f32(a, b).to_array(),
        s.max_f32(a, b).to_array(),
        s.floor_f32(a).to_array(),
    ]
}

#[test]
fn min_max_and_floor_are_the_scalar_ones() {
    for level in Level::all_available() {
        for (a, b) in packets() {
            let [min, max, floor] = dispatch!(level, s => min_max_floor(s, a, b));
            for lane in 0..LANES {
                let (a, b) = (a[lane], b[lane]);
                assert!(
                    same(min[lane], if a < b { a } else { b }),
                    "{level:?} min({a}, {b})"
                );
                assert!(
                    same(max[lane], if a > b { a } else { b }),
                    "{level:?} max({a}, {b})"
                );
                assert!(same(floor[lane], a.floor()), "{level:?} floor({a})");
            }
        }
    }
}

#[inline(always)]
fn round<S: Lanes>(s: S, a: [f32; LANES]) -> [i32; LANES] {
    s.round_to_i32(f32x16::load_array(s, a)).to_array()
}

#[test]
fn rounding_is_to_nearest_even() {
    let mut values = [0.0; LANES];
    for (lane, value) in values.iter_mut().enumerate() {
        *value = lane as f32 * 0.25 - 2.0;
    }
    values[0] = 4_194_303.5;
    values[1] = -4_194_303.5;
    for level in Level::all_available() {
        let rounded = dispatch!(level, s => round(s, values));
        for (rounded, value) in rounded.into_iter().zip(values) {
            assert_eq!(rounded as f32, value.round_ties_even(), "{level:?} {value}");
        }
    }
}

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
fn looked_up_in_sixteen<S: Lanes>(s: S, table: &[u32; 16], index: [u32; 16]) -> [u32; 16] {
    s.lookup_sixteen(table, u32x16::load_array(s, index))
        .to_array()
}

#[test]
fn every_element_of_sixteen_is_looked_up() {
    let table: [u32; 16] = std::array::from_fn(|at| (at as u32 + 1).wrapping_mul(0x9E37_79B9));
    for level in Level::all_available() {
        for first in 0..16 {
            let index = std::array::from_fn(|lane| (first + lane as u32 * 7) % 16);
            let got = dispatch!(level, s => looked_up_in_sixteen(s, &table, index));
            assert_eq!(got, index.map(|at| table[at as usize]), "{level:?}");
        }
    }
}

#[inline(always)]
fn looked_up<S: Lanes>(s: S, table: &[u32; 256], index: [u32; LANES]) -> [u32; LANES] {
    s.lookup(table, u32x16::load_array(s, index)).to_array()
}

#[test]
fn every_element_is_looked_up() {
    let table: [u32; 256] = std::array::from_fn(|at| (at as u32).wrapping_mul(0x9E37_79B9));
    for level in Level::all_available() {
        for first in 0..256 {
            let index: [u32; LANES] = std::array::from_fn(|lane| (first + lane as u32 * 37) % 256);
            let got = dispatch!(level, s => looked_up(s, &table, index));
            assert_eq!(got, index.map(|at| table[at as usize]), "{level:?}");
        }
    }
}

#[inline(always)]
fn three_looked_up<S: Lanes>(s: S, table: &ByteTable, words: [u32; LANES]) -> [[u32; LANES]; 3] {
    let [a, b, c] = s.lookup_three(table, u32x16::load_array(s, words));
    [a.to_array(), b.to_array(), c.to_array()]
}

#[test]
fn every_element_is_looked_up_by_each_of_three_bytes() {
    let table = ByteTable::new(std::array::from_fn(|at| {
        (at as u32).wrapping_mul(0x9E37_79B9)
    }));
    for level in Level::all_available() {
        for first in 0..256 {
            let words: [u32; LANES] =
                std::array::from_fn(|lane| (first + lane as u32 * 37).wrapping_mul(0x0103_0501));
            let got = dispatch!(level, s => three_looked_up(s, &table, words));
            for (byte, got) in got.into_iter().enumerate() {
                let expected = words.map(|word| table.get(word.to_le_bytes()[byte]));
                assert_eq!(got, expected, "{level:?} byte {byte}");
            }
        }
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

#[inline(always)]
fn permuted<S: Lanes>(s: S, value: [u32; LANES], order: [u32; LANES]) -> [[u32; LANES]; 2] {
    let (value, order) = (u32x16::load_array(s, value), u32x16::load_array(s, order));
    let floats: u32x16<S> = s.permute_f32(value.bitcast(), order).bitcast();
    [s.permute(value, order).to_array(), floats.to_array()]
}

#[test]
fn permutations_take_the_low_four_bits_of_the_order() {
    let mut state = 1u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        state >> 4
    };
    for level in Level::all_available() {
        for _ in 0..200 {
            let (value, order) = ([0; LANES].map(|_| random()), [0; LANES].map(|_| random()));
            let expected = order.map(|at| value[at as usize % LANES]);
            let found = dispatch!(level, s => permuted(s, value, order));
            assert_eq!(found, [expected; 2], "{order:?} at {}", level.name());
        }
    }
}

#[test]
fn bits_are_listed_in_ascending_order() {
    for level in Level::all_available() {
        for bits in 0..=u16::MAX {
            let mut out = [u32::MAX; LANES];
            let count = dispatch!(level, s => s.list_bits(bits, 96, &mut out));
            let expected: Vec<u32> = (0..16).filter(|bit| bits >> bit & 1 == 1).collect();
            let expected: Vec<u32> = expected.into_iter().map(|bit| 96 + bit).collect();
            assert_eq!(out[..count], expected, "{bits:#x} at {}", level.name());
        }
    }
}

#[inline(always)]
fn round_trip<S: Lanes>(s: S, bits: u16) -> u16 {
    s.bits_of_mask(s.mask_from_bits(bits))
}

#[test]
fn masks_keep_their_bits() {
    for level in Level::all_available() {
        for bits in (0..=u16::MAX).step_by(257) {
            assert_eq!(
                dispatch!(level, s => round_trip(s, bits)),
                bits,
                "{level:?}"
            );
        }
    }
}

#[test]
fn lanes_are_in_morton_order() {
    for lane in 0..LANES as u8 {
        let x = (lane & 1) | (lane >> 1 & 2);
        let y = (lane >> 1 & 1) | (lane >> 2 & 2);
        assert_eq!(
            (LANE_X[lane as usize], LANE_Y[lane as usize]),
            (x, y),
            "lane {lane}"
        );
    }
}

#[test]
fn levels_are_found_by_name() {
    let scalar = Level::named("scalar").map(Level::name);
    #[cfg(scalar_level)]
    assert_eq!(scalar, Ok("scalar"));
    #[cfg(not(scalar_level))]
    assert!(matches!(
        scalar,
        Err(LevelError::NotBuiltIn { name: "scalar", .. })
    ));
    assert_eq!(
        Level::named("auto").map(Level::name),
        Ok(Level::best().name())
    );
    assert!(matches!(
        Level::named("avx9000"),
        Err(LevelError::Unknown(_))
    ));
    #[cfg(target_arch = "x86_64")]
    assert!(matches!(
        Level::named("neon"),
        Err(LevelError::Missing { name: "neon", .. })
    ));
}

#[test]
fn a_packet_is_uniform_if_no_lane_differs() {
    assert!(Packet([7_u32; LANES]).is_uniform() && Packet([-7_i32; LANES]).is_uniform());
    for lane in 0..LANES {
        let mut packet = Packet([-1_i32; LANES]);
        packet.0[lane] = i32::MAX;
        assert!(!packet.is_uniform(), "lane {lane}");
    }
}

/// Four rows of four texels, by channel and lane.
#[inline(always)]
fn of_block<S: Lanes>(s: S, rows: &[[f32; LANES]; 4]) -> [[f32; LANES]; 8] {
    let [a, b, c, d] = [
        f32x16::load_array_ref(s, &rows[0]),
        f32x16::load_array_ref(s, &rows[1]),
        f32x16::load_array_ref(s, &rows[2]),
        f32x16::load_array_ref(s, &rows[3]),
    ];
    let [r, g, blue, alpha] = s.channels_of_rows([a, b, c, d]);
    [
        r.to_array(),
        g.to_array(),
        blue.to_array(),
        alpha.to_array(),
        s.first_row(a).to_array(),
        s.first_column(a).to_array(),
        s.spread_columns(a).to_array(),
        s.columns_and_rows(a, b).to_array(),
    ]
}

#[test]
fn blocks_have_columns_rows_and_channels() {
    let rows: [[f32; LANES]; 4] = std::array::from_fn(|row| {
        std::array::from_fn(|at| (row * 100 + at / 4 * 10 + at % 4) as f32)
    });
    let lane_of = |x: usize, y: usize| {
        let is_there = |lane: &usize| [LANE_X[*lane], LANE_Y[*lane]] == [x as u8, y as u8];
        (0..LANES).find(is_there).unwrap()
    };
    for level in Level::all_available() {
        let of_level = dispatch!(level, s => of_block(s, &rows));
        let [channels @ .., row, column, spread, both] = of_level;
        for lane in 0..LANES {
            let (x, y) = (usize::from(LANE_X[lane]), usize::from(LANE_Y[lane]));
            for (channel, of_channel) in channels.iter().enumerate() {
                let expected = (y * 100 + x * 10 + channel) as f32;
                assert_eq!(of_channel[lane], expected, "{level:?} channel {channel}");
            }
            assert_eq!(row[lane], rows[0][lane_of(x, 0)], "{level:?}");
            assert_eq!(column[lane], rows[0][lane_of(0, y)], "{level:?}");
            assert_eq!(spread[lane], rows[0][lane / 4], "{level:?}");
            let expected = match lane % 8 {
                column @ 0..4 => rows[0][lane_of(column, 0)],
                row => rows[1][lane_of(0, row - 4)],
            };
            assert_eq!(both[lane], expected, "{level:?}");
        }
    }
}

/// The texels of a window that belong to columns; `None` as the level says, or for columns outside.
#[inline(always)]
fn of_window<S: Lanes>(
    s: S,
    window: &[u32; 16],
    texels: [i32; LANES],
    first: i32,
) -> Option<[[f32; LANES]; 2]> {
    let columns = Columns::new(s, i32x16::load_array(s, texels), first)?;
    let [left, right] = s.half_texels(window, &columns)?;
    let all = [left.to_array(), right.to_array()];
    if columns.are_among_four() {
        let [left, right] = s.half_texels_of_four(window.first_chunk()?, &columns)?;
        assert_eq!([left.to_array(), right.to_array()], all);
    }
    Some(all)
}

#[test]
fn windows_of_half_floats_are_read_by_columns() {
    // The whole numbers 0 to 31 as half floats.
    let half = |number: u32| match number {
        0 => 0,
        _ => (15 + number.ilog2()) << 10 | (number << (10 - number.ilog2())) & 0x3FF,
    };
    let window: [u32; 16] = std::array::from_fn(|at| {
        let at = at as u32;
        half(2 * at) | half(2 * at + 1) << 16
    });
    for level in Level::all_available() {
        for columns in [
            [0, 1, 2, 3],
            [6, 5, 3, 0],
            [2, 2, 2, 2],
            [0, 0, 1, 2],
            [0, 2, 4, 6],
            [0, 1, 2, 7],
        ] {
            let mut texels = [0; LANES];
            for (texel, column) in texels.iter_mut().zip(columns) {
                *texel = 40 + column;
            }
            let are_among_four: Option<bool> = dispatch!(level, s => {
                let columns = Columns::new(s, i32x16::load_array(s, texels), 40);
                columns.map(|columns| columns.are_among_four())
            });
            let expected = (columns[3] < 7).then(|| columns.iter().all(|&column| column < 3));
            assert_eq!(are_among_four, expected, "{level:?} {columns:?}");
            let got = dispatch!(level, s => of_window(s, &window, texels, 40));
            let has_halves = matches!(level.name(), "avx2" | "avx512");
            assert_eq!(got.is_some(), has_halves && columns[3] < 7, "{level:?}");
            let Some([left, right]) = got else { continue };
            for at in 0..LANES {
                let place = columns[at / 4] as f32 * 4.0 + (at % 4) as f32;
                assert_eq!([left[at], right[at]], [place, place + 4.0], "{level:?}");
            }
        }
        let row: Option<[f32; LANES]> = dispatch!(level, s => {
            s.row_of_halves(window.first_chunk().unwrap()).map(|row| row.to_array())
        });
        if let Some(row) = row {
            assert_eq!(row, std::array::from_fn(|at| at as f32), "{level:?}");
        }
    }
}
