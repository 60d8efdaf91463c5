//! Transposition of sixteen records between memory order (array of structures) and lanes (structure
//! of arrays).
//!
//! Vertices lie in memory one after the other; lanes need component by component. Four words of a
//! vertex are one load of 128 bits, and eight shuffles transpose sixteen of them. A gather would
//! take an address for each word: on Zen 4 the four gathers of a position and a colour took longer
//! than the rest of vertex fetch.

use estampe_simd::{Bytes, LANES, Lanes, Packet, Select, SimdBase, f32x16, u32x16};

/// The four words of one record: 128 bits of a vector.
type Record<S> = <u32x16<S> as SimdBase<S>>::Block;

/// Transposes sixteen records of four words: vector `c` holds word `c` of every record.
#[inline(always)]
pub(crate) fn components_of<S: Lanes>(s: S, rows: &[&[u32; 4]; LANES]) -> [u32x16<S>; 4] {
    let a = four_records(s, [rows[0], rows[1], rows[2], rows[3]]);
    let b = four_records(s, [rows[4], rows[5], rows[6], rows[7]]);
    let c = four_records(s, [rows[8], rows[9], rows[10], rows[11]]);
    let d = four_records(s, [rows[12], rows[13], rows[14], rows[15]]);
    let (xz_low, yw_low) = s.deinterleave_u32x16(a, b);
    let (xz_high, yw_high) = s.deinterleave_u32x16(c, d);
    let (x, z) = s.deinterleave_u32x16(xz_low, xz_high);
    let (y, w) = s.deinterleave_u32x16(yw_low, yw_high);
    [x, y, z, w]
}

/// Transposes sixteen records of three words.
#[inline(always)]
pub(crate) fn components_of_three<S: Lanes>(s: S, records: &[[u32; 3]; LANES]) -> [u32x16<S>; 3] {
    // Loads of single words would be as many as the words; and vectors that are made of them have
    // to wait for one another.
    if const { S::REGISTERS == 1 } {
        return [
            component_of_three::<S, 0>(s, records),
            component_of_three::<S, 1>(s, records),
            component_of_three::<S, 2>(s, records),
        ];
    }
    let mut components = [<u32x16<S> as SimdBase<S>>::splat(s, 0); 3];
    for (component, to) in components.iter_mut().enumerate() {
        let mut lanes = [0; LANES];
        for (lane, record) in lanes.iter_mut().zip(records) {
            *lane = record[component];
        }
        *to = u32x16::load_array(s, lanes);
    }
    components
}

/// One word of sixteen records of three, by permutations of the three vectors that hold them.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "48 words")]
fn component_of_three<S: Lanes, const C: usize>(s: S, records: &[[u32; 3]; LANES]) -> u32x16<S> {
    // Where each lane's word is, modulo sixteen; and the lanes whose words are in each vector.
    const fn places(component: usize) -> ([u32; LANES], [u16; 3]) {
        let (mut order, mut lanes) = ([0; LANES], [0; 3]);
        let mut lane = 0;
        while lane < LANES {
            let word = lane * 3 + component;
            order[lane] = (word % LANES) as u32;
            lanes[word / LANES] |= 1 << lane;
            lane += 1;
        }
        (order, lanes)
    }
    let (order, [_, of_second, of_third]) = const { places(C) };
    let order = u32x16::load_array(s, order);
    let (vectors, _) = records.as_flattened().as_chunks::<LANES>();
    let vector = |at: usize| s.permute(u32x16::load_array_ref(s, &vectors[at]), order);
    let first_two = s.mask_from_bits(of_second).select(vector(1), vector(0));
    s.mask_from_bits(of_third).select(vector(2), first_two)
}

/// Transposes sixteen records of four floats.
#[inline(always)]
pub(crate) fn components_of_f32<S: Lanes>(s: S, rows: &[&[f32; 4]; LANES]) -> [f32x16<S>; 4] {
    let four = |first: usize| {
        let row =
            |at: usize| <f32x16<S> as SimdBase<S>>::Block::load_array_ref(s, rows[first + at]);
        s.combine_f32x8(
            s.combine_f32x4(row(0), row(1)),
            s.combine_f32x4(row(2), row(3)),
        )
    };
    let (xz_low, yw_low) = s.deinterleave_f32x16(four(0), four(4));
    let (xz_high, yw_high) = s.deinterleave_f32x16(four(8), four(12));
    let (x, z) = s.deinterleave_f32x16(xz_low, xz_high);
    let (y, w) = s.deinterleave_f32x16(yw_low, yw_high);
    [x, y, z, w]
}

#[inline(always)]
fn four_records<S: Lanes>(s: S, [a, b, c, d]: [&[u32; 4]; 4]) -> u32x16<S> {
    let (a, b) = (
        Record::<S>::load_array_ref(s, a),
        Record::<S>::load_array_ref(s, b),
    );
    let (c, d) = (
        Record::<S>::load_array_ref(s, c),
        Record::<S>::load_array_ref(s, d),
    );
    s.combine_u32x8(s.combine_u32x4(a, b), s.combine_u32x4(c, d))
}

/// Transposes four vectors to sixteen records of four words, four records in each vector.
#[inline(always)]
pub(crate) fn records_of<S: Lanes>(s: S, [x, y, z, w]: [u32x16<S>; 4]) -> [u32x16<S>; 4] {
    let (xz_low, xz_high) = s.interleave_u32x16(x, z);
    let (yw_low, yw_high) = s.interleave_u32x16(y, w);
    let (a, b) = s.interleave_u32x16(xz_low, yw_low);
    let (c, d) = s.interleave_u32x16(xz_high, yw_high);
    [a, b, c, d]
}

/// Transposes four vectors and writes the first records, as many as `out` holds, at most sixteen.
#[inline(always)]
pub(crate) fn store_records<S: Lanes>(s: S, columns: [u32x16<S>; 4], out: &mut [[u32; 4]]) {
    let rows = records_of(s, columns);
    let mut whole = [[0; 4]; LANES];
    let to = match out.first_chunk_mut::<LANES>() {
        Some(out) => out,
        None => &mut whole,
    };
    let (parts, _) = to.as_flattened_mut().as_chunks_mut::<LANES>();
    for (part, row) in parts.iter_mut().zip(rows) {
        row.store_array(part);
    }
    if out.len() < LANES {
        out.copy_from_slice(&whole[..out.len()]);
    }
}

/// Writes the first lanes of any number of components as records, one after the other.
#[inline(always)]
pub(crate) fn store_components<S: Lanes>(s: S, columns: &[Packet<f32>], out: &mut [f32]) {
    let stride = columns.len();
    let column = |at: usize| f32x16::load_array_ref(s, &columns[at].0);
    match stride {
        0 => {}
        1 if out.len() == LANES => out.copy_from_slice(&columns[0].0),
        2 if out.len() == 2 * LANES => {
            let (low, high) = s.interleave_f32x16(column(0), column(1));
            low.store_slice(&mut out[..LANES]);
            high.store_slice(&mut out[LANES..]);
        }
        4.. if out.len() == stride * LANES => {
            let mut first = 0;
            while first < stride {
                // The last four columns overlap those before them.
                let at = first.min(stride - 4);
                let four = [column(at), column(at + 1), column(at + 2), column(at + 3)];
                store_four(s, four, stride, &mut out[at..]);
                first += 4;
            }
        }
        _ => {
            for (lane, vertex) in out.chunks_exact_mut(stride).enumerate() {
                for (scalar, value) in vertex.iter_mut().zip(columns) {
                    *scalar = value.0[lane];
                }
            }
        }
    }
}

/// Writes four components of sixteen records that begin `stride` floats apart.
#[inline(always)]
fn store_four<S: Lanes>(s: S, [x, y, z, w]: [f32x16<S>; 4], stride: usize, out: &mut [f32]) {
    let columns = [x.bitcast(), y.bitcast(), z.bitcast(), w.bitcast()];
    for (rows, four) in records_of(s, columns).into_iter().zip(0..) {
        let rows: f32x16<S> = rows.bitcast();
        let (low, high) = s.split_f32x16(rows);
        let ((a, b), (c, d)) = (s.split_f32x8(low), s.split_f32x8(high));
        let first = four * 4 * stride;
        a.store_slice(&mut out[first..][..4]);
        b.store_slice(&mut out[first + stride..][..4]);
        c.store_slice(&mut out[first + 2 * stride..][..4]);
        d.store_slice(&mut out[first + 3 * stride..][..4]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use estampe_simd::{Level, dispatch};

    #[test]
    fn records_of_three_words_are_transposed() {
        let mut records = [[0; 3]; LANES];
        for (word, number) in records.as_flattened_mut().iter_mut().zip(1..) {
            *word = number;
        }
        for level in Level::all_available() {
            let found = dispatch!(level, s => {
                let [a, b, c] = components_of_three(s, &records);
                [a.to_array(), b.to_array(), c.to_array()]
            });
            for (component, found) in found.iter().enumerate() {
                assert_eq!(*found, records.map(|record| record[component]), "{level:?}");
            }
        }
    }
}
