//! Mode ATTRIBUTES: the differences of each byte from that of the element before.
//!
//! ```text
//! 0xa0 | block | block | … | tail: padding, first baseline element
//! block       up to 256 elements: for each byte of an element a row of groups
//! row         2 bits per group of 16 elements, four groups a byte, lowest first | groups
//! group       0: all differences are 0
//!             1: sixteen codes of 2 bits, highest first; 3 is followed by a byte after the codes
//!             2: sixteen codes of 4 bits, likewise; 15 is followed by a byte
//!             3: sixteen bytes
//! ```
//!
//! Differences are zigzag codes and wrap around.

use super::{Damage, TOO_LONG, TOO_SHORT, WRONG_HEADER, next_byte};

const HEADER: u8 = 0xa0;
const GROUP: usize = 16;
const MAX_BLOCK: usize = 256;
const MAX_BLOCK_BYTES: usize = 8192;
const MIN_TAIL_BYTES: usize = 32;

/// Decodes `count` elements of `stride` bytes: a multiple of 4, at most 256.
pub(super) fn decode(mut data: &[u8], count: usize, stride: usize) -> Result<Vec<u8>, Damage> {
    if next_byte(&mut data)? != HEADER {
        return Err(WRONG_HEADER);
    }
    let tail = stride.max(MIN_TAIL_BYTES);
    let body = data.len().checked_sub(tail).ok_or(TOO_SHORT)?;
    // Each row has at least two bits for every 16 elements.
    if count.div_ceil(4 * GROUP).saturating_mul(stride) > body {
        return Err(TOO_SHORT);
    }
    let (mut body, tail) = data.split_at(body);
    let mut baseline = tail[tail.len() - stride..].to_vec();
    let mut elements = vec![0; count * stride];
    let block = MAX_BLOCK.min((MAX_BLOCK_BYTES / stride) & !(GROUP - 1));
    for block in elements.chunks_mut(block * stride) {
        let mut codes = [0; MAX_BLOCK];
        let codes = &mut codes[..(block.len() / stride).next_multiple_of(GROUP)];
        for (byte, value) in baseline.iter_mut().enumerate() {
            read_row(&mut body, codes)?;
            let column = block[byte..].iter_mut().step_by(stride);
            for (slot, &code) in column.zip(&*codes) {
                *value = value.wrapping_add((code >> 1) ^ (code & 1).wrapping_neg());
                *slot = *value;
            }
        }
    }
    if body.is_empty() {
        Ok(elements)
    } else {
        Err(TOO_LONG)
    }
}

/// Reads the codes of one byte of a block's elements.
fn read_row(data: &mut &[u8], codes: &mut [u8]) -> Result<(), Damage> {
    let groups = codes.len() / GROUP;
    let (kinds, rest) = data.split_at_checked(groups.div_ceil(4)).ok_or(TOO_SHORT)?;
    *data = rest;
    let (codes, _) = codes.as_chunks_mut::<GROUP>();
    for (at, group) in codes.iter_mut().enumerate() {
        match (kinds[at / 4] >> (at % 4 * 2)) & 3 {
            0 => *group = [0; GROUP],
            1 => read_group::<2>(data, group)?,
            2 => read_group::<4>(data, group)?,
            _ => {
                let (bytes, rest) = data.split_first_chunk::<GROUP>().ok_or(TOO_SHORT)?;
                *group = *bytes;
                *data = rest;
            }
        }
    }
    Ok(())
}

/// Reads sixteen codes of some bits, of which the largest stands for a byte that follows.
fn read_group<const BITS: usize>(data: &mut &[u8], group: &mut [u8; GROUP]) -> Result<(), Damage> {
    let (packed, rest) = data.split_at_checked(GROUP * BITS / 8).ok_or(TOO_SHORT)?;
    *data = rest;
    let escape = (1 << BITS) - 1;
    for (at, code) in group.iter_mut().enumerate() {
        let bit = at * BITS;
        *code = (packed[bit / 8] >> (8 - BITS - bit % 8)) & escape;
        if *code == escape {
            *code = next_byte(data)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::read_group;

    #[test]
    fn a_group_is_decoded_as_the_specification_shows() {
        let mut data = &[0x17, 0x5f, 0xf0, 0xbc, 0x77, 0xa9, 0x21, 0x00, 0x34, 0xb5][..];
        let mut codes = [0; 16];
        assert_eq!(read_group::<4>(&mut data, &mut codes), Ok(()));
        assert!(data.is_empty());
        let deltas = codes.map(|code| ((code >> 1) ^ (code & 1).wrapping_neg()).cast_signed());
        let expected = [-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0];
        assert_eq!(deltas, expected);
        assert!(read_group::<4>(&mut &[0xff; 8][..], &mut codes).is_err());
        assert!(read_group::<2>(&mut &[0; 3][..], &mut codes).is_err());
    }
}
