//! Colours of face numbers: distinct for distinct numbers, and unlike those of neighbours.

/// ⌊2²⁴ ÷ φ⌋, which is odd: multiples of the golden ratio's fraction are far apart (Knuth, "The Art
/// of Computer Programming" 3, section 6.4).
const STEP: usize = 0x9E_3779;

/// The colour of face `number`: the 24 bits of (number + 1)·0x9e3779 mod 2²⁴, red first. The factor
/// is odd, so each of 2²⁴ faces has a colour of its own, and the last of them black.
///
/// 0xb382c9·colour − 1 mod 2²⁴ is the number.
#[must_use]
#[expect(clippy::cast_possible_truncation, reason = "bytes of a number")]
pub fn face_color(number: usize) -> [u8; 3] {
    let code = number.wrapping_add(1).wrapping_mul(STEP);
    [(code >> 16) as u8, (code >> 8) as u8, code as u8]
}

/// The number of faces that have different colours.
pub(crate) const MOST_FACES: usize = 1 << 24;

/// The number of the face with this colour: the inverse of [`face_color`].
pub(crate) fn face_number(color: [u8; 3]) -> usize {
    /// 1 ÷ STEP modulo 2²⁴.
    const INVERSE: usize = 0xB3_82C9;
    let [r, g, b] = color.map(usize::from);
    let code = r << 16 | g << 8 | b;
    (code * INVERSE).wrapping_sub(1) & (MOST_FACES - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows: I3.
    #[test]
    fn numbers_come_back_from_colors() {
        for number in (0..1 << 24).step_by(997).chain([0, 1, 2, (1 << 24) - 1]) {
            assert_eq!(face_number(face_color(number)), number);
        }
    }

    #[test]
    fn neighbours_differ_in_every_channel() {
        for number in 0..5000 {
            let (a, b) = (face_color(number), face_color(number + 1));
            for channel in 0..3 {
                assert!(
                    a[channel].abs_diff(b[channel]) >= 50,
                    "{number}: {a:?} {b:?}"
                );
            }
        }
    }
}
