//! Binary faces that are all triangles: rows of one length, which several threads read at once.

use super::header::{Element, Kind, Scalar};
use super::values::NO_VERTEX;
use crate::zeros::zeros;
use estampe_scene::Workers;

/// The length 3 as a byte, and three indices.
pub(super) const ROW_BYTES: usize = 13;

/// True if the element is just a list of indices, its length in one byte and its items in four.
pub(super) fn can_be_rows(element: &Element) -> bool {
    let is_index = |item| matches!(item, Scalar::I32 | Scalar::U32);
    match element.properties.as_slice() {
        [property] => matches!(
            property.kind,
            Kind::List { length: Scalar::U8 | Scalar::I8, item } if is_index(item)
        ),
        _ => false,
    }
}

/// The triangles of the first `count` rows, up to the first row that is not a triangle of existing
/// vertices.
///
/// `index` decodes an index. Memory is allocated only for rows that exist.
pub(super) fn read(
    bytes: &[u8],
    count: u64,
    vertex_count: usize,
    index: impl Fn([u8; 4]) -> u32 + Sync,
    workers: Workers,
) -> Vec<[u32; 3]> {
    /// Rows of a piece: some hundred microseconds of work.
    const PIECE: usize = 1 << 14;
    let decode = |row: &[u8; ROW_BYTES]| -> Option<[u32; 3]> {
        let &[3, ref corners @ ..] = row else {
            return None;
        };
        let corners = corners.as_chunks::<4>().0;
        let triangle = [index(corners[0]), index(corners[1]), index(corners[2])];
        // A negative i32 is a u32 beyond all vertices.
        let exists = |&vertex: &u32| (vertex as usize) < vertex_count && vertex != NO_VERTEX;
        triangle.iter().all(exists).then_some(triangle)
    };
    let rows = bytes.as_chunks::<ROW_BYTES>().0;
    let rows = &rows[..rows.len().min(usize::try_from(count).unwrap_or(usize::MAX))];
    if rows.first().is_none_or(|row| decode(row).is_none()) {
        return Vec::new();
    }
    let mut triangles = zeros(rows.len());
    let parts = triangles.chunks_mut(PIECE).zip(rows.chunks(PIECE));
    let good_rows = workers.map(parts, |(triangles, rows)| {
        let mut good = 0;
        for (slot, row) in triangles.iter_mut().zip(rows) {
            let Some(triangle) = decode(row) else { break };
            *slot = triangle;
            good += 1;
        }
        good
    });
    let mut sound = 0;
    for good in good_rows {
        sound += good;
        // Only complete pieces are followed by others.
        if good < PIECE {
            break;
        }
    }
    triangles.truncate(sound);
    triangles
}
