//! Tables that are held in registers.

use super::*;

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
