//! Mode INDICES: differences from one of two earlier indices.
//!
//! ```text
//! 0xd1 | numbers | 4 bytes of 0
//! number      bit 0: which of the two · the other bits: zigzag code of the difference
//! ```

use super::{Damage, TOO_LONG, TOO_SHORT, WRONG_HEADER, next_byte, next_varint, unzigzag};

const HEADER: u8 = 0xd1;
const TAIL_BYTES: usize = 4;

/// Decodes `count` indices.
pub(super) fn decode(mut data: &[u8], count: usize) -> Result<Vec<u32>, Damage> {
    if next_byte(&mut data)? != HEADER {
        return Err(WRONG_HEADER);
    }
    let (mut data, _) = data.split_last_chunk::<TAIL_BYTES>().ok_or(TOO_SHORT)?;
    // Each index has at least one byte.
    if count > data.len() {
        return Err(TOO_SHORT);
    }
    let mut baselines = [0_u32; 2];
    let mut indices = Vec::with_capacity(count);
    for _ in 0..count {
        let number = next_varint(&mut data)?;
        let baseline = &mut baselines[usize::from(number & 1 == 1)];
        *baseline = baseline.wrapping_add(unzigzag(number >> 1));
        indices.push(*baseline);
    }
    if data.is_empty() {
        Ok(indices)
    } else {
        Err(TOO_LONG)
    }
}
