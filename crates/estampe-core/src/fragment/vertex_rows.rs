//! Varyings of the vertices of sixteen triangles or lines, transposed into a row for each scalar.

use super::interpolate::VaryingSource;
use crate::bounds::primitives::VertexRef;
use estampe_simd::{LANES, Lanes, Packet, Select, SimdBase, u32x16};
use estampe_types::Interpolation;

/// Transposes the varyings of the vertices of some lanes into rows.
#[inline(always)]
pub(super) fn fetch_rows<S: Lanes>(
    s: S,
    rows: &mut [Packet<f32>],
    vertices: &[VertexRef; LANES],
    lanes: u16,
    source: &VaryingSource<'_>,
) {
    let n = source.modes.len();
    // Lanes that are not wanted repeat one that is: theirs may be far away, or those of another
    // draw.
    let wanted = s.mask_from_bits(lanes);
    let lane = lanes.trailing_zeros() as usize % LANES;
    let one = <u32x16<S> as SimdBase<S>>::splat(s, vertices[lane].0);
    let all = u32x16::load_array(s, vertices.map(|vertex| vertex.0));
    let vertices = wanted.select(all, one);
    if n < 2 {
        for row in rows {
            for (to, vertex) in row.0.iter_mut().zip(vertices.to_array()) {
                *to = source.of(VertexRef(vertex))[0];
            }
        }
        return;
    }
    let mut first = 0;
    while first < n {
        // The last four columns overlap those before them.
        let at = first.min(n.saturating_sub(4));
        let columns = source.four_of(s, vertices, at);
        for (row, column) in rows[at..].iter_mut().zip(columns) {
            column.store_array(&mut row.0);
        }
        first += 4;
    }
}

/// Flat varyings are the provoking vertex's.
#[inline(never)]
pub(super) fn fetch_flat(
    rows: &mut [Packet<f32>],
    provoking: &[VertexRef; LANES],
    lanes: u16,
    source: &VaryingSource<'_>,
) {
    let mut left = lanes;
    while left != 0 {
        let lane = left.trailing_zeros() as usize % LANES;
        left &= left - 1;
        let values = source.of(provoking[lane]);
        let rows = rows.iter_mut().zip(values);
        for ((row, value), mode) in rows.zip(source.modes) {
            if *mode == Interpolation::Flat {
                row.0[lane] = *value;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use estampe_simd::{Level, dispatch};

    /// Vertices made by clipping, and the last one of a list, are read by themselves.
    #[test]
    fn vertices_are_read_from_both_lists() {
        const CLIPPED: u32 = VertexRef::CLIPPED;
        let lists: [[u32; 4]; 4] = [
            [0, 3, 7, 12],
            [19, 0, 18, 16],
            [5, CLIPPED, 9, CLIPPED | 4],
            [CLIPPED | 2, CLIPPED | 4, CLIPPED, CLIPPED | 1],
        ];
        for scalars in [2_usize, 3, 4, 5, 9] {
            let numbers = |count: usize, first: usize| -> Vec<f32> {
                let all = first..first + count * scalars;
                all.map(|number| number as f32).collect()
            };
            let (shaded, clipped) = (numbers(20, 0), numbers(5, 1000));
            let source = VaryingSource {
                shaded: &shaded,
                clipped: &clipped,
                modes: &vec![Interpolation::Smooth; scalars],
                gradients: &[],
            };
            for of_lanes in lists {
                let mut vertices = [VertexRef(0); LANES];
                for (vertex, of_lane) in vertices.iter_mut().zip(of_lanes.iter().cycle()) {
                    *vertex = VertexRef(*of_lane);
                }
                for level in Level::all_available() {
                    let mut rows = vec![Packet::default(); scalars];
                    dispatch!(@wide level,
                        s => fetch_rows(s, &mut rows, &vertices, u16::MAX, &source),
                        scalar => continue);
                    for (lane, vertex) in vertices.into_iter().enumerate() {
                        let found: Vec<f32> = rows.iter().map(|row| row.0[lane]).collect();
                        assert_eq!(found, source.of(vertex), "{level:?}, {vertex:?}");
                    }
                }
            }
        }
    }
}
