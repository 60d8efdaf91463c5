//! Packets that hold a block of texels, or a window of half floats.

use super::*;

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
    let rows = [s.paired(a), s.paired(b), s.paired(c), s.paired(d)];
    let of_paired = s.channels_of_paired(rows);
    for (paired, channel) in of_paired.iter().zip([r, g, blue, alpha]) {
        assert_eq!(paired.to_array(), channel.to_array(), "channels of pairs");
    }
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
