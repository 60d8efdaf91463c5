//! Filters: what decoded attributes stand for.
//!
//! | filter      | stored                                                 | becomes                   |
//! |-------------|--------------------------------------------------------|---------------------------|
//! | octahedral  | x, y of an octahedron · its size · anything            | unit vector · the same    |
//! | quaternion  | three components, less the largest · size, which it is | unit quaternion           |
//! | exponential | 24 bits of mantissa · 8 bits of exponent               | f32: mantissa · 2^exponent |
//!
//! Components are signed, of 8 or 16 bits (exponential: 32). Invalid input gives some numbers.

/// A filter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Filter {
    None,
    Octahedral,
    Quaternion,
    Exponential,
}

impl Filter {
    pub(super) fn of_name(name: &str) -> Option<Self> {
        Some(match name {
            "NONE" => Self::None,
            "OCTAHEDRAL" => Self::Octahedral,
            "QUATERNION" => Self::Quaternion,
            "EXPONENTIAL" => Self::Exponential,
            _ => return None,
        })
    }

    /// True if elements may have so many bytes.
    pub(super) fn accepts(self, stride: usize) -> bool {
        let is_valid = stride.is_multiple_of(4) && (4..=256).contains(&stride);
        match self {
            Self::None | Self::Exponential => is_valid,
            Self::Octahedral => stride == 4 || stride == 8,
            Self::Quaternion => stride == 8,
        }
    }

    /// Replaces all elements by what they stand for.
    pub(super) fn apply(self, bytes: &mut [u8], stride: usize) {
        match self {
            Self::None => {}
            Self::Octahedral if stride == 4 => {
                for element in bytes.as_chunks_mut::<4>().0 {
                    let stored = element.map(|byte| f32::from(byte.cast_signed()));
                    let [x, y, z] = octahedral(stored).map(|value| signed(value, 127.0));
                    let narrow = |value: i16| value.to_le_bytes()[0];
                    *element = [narrow(x), narrow(y), narrow(z), element[3]];
                }
            }
            Self::Octahedral => {
                for element in bytes.as_chunks_mut::<8>().0 {
                    let stored = words(element);
                    let [x, y, z] = octahedral(stored.map(f32::from));
                    let [x, y, z] = [x, y, z].map(|value| signed(value, 32767.0));
                    store(element, [x, y, z, stored[3]]);
                }
            }
            Self::Quaternion => {
                for element in bytes.as_chunks_mut::<8>().0 {
                    store(element, quaternion(words(element)));
                }
            }
            Self::Exponential => {
                for element in bytes.as_chunks_mut::<4>().0 {
                    *element = exponential(i32::from_le_bytes(*element)).to_le_bytes();
                }
            }
        }
    }
}

/// The unit vector of a point on an octahedron that is unfolded to a square.
fn octahedral([x, y, one, _]: [f32; 4]) -> [f32; 3] {
    let (x, y) = (x / one, y / one);
    let z = 1.0 - x.abs() - y.abs();
    // The corners of the square are the lower half.
    let fold = z.min(0.0);
    let (x, y) = (x - fold.copysign(x), y - fold.copysign(y));
    let length = libm::sqrtf(x * x + y * y + z * z);
    [x, y, z].map(|value| value / length)
}

/// The four components, of which the largest follows from the others.
fn quaternion(stored: [i16; 4]) -> [i16; 4] {
    let one = f32::from(stored[3] | 3);
    let scale = std::f32::consts::FRAC_1_SQRT_2 / one;
    let [x, y, z] = [stored[0], stored[1], stored[2]].map(|value| f32::from(value) * scale);
    let largest = libm::sqrtf((1.0 - x * x - y * y - z * z).max(0.0));
    let [w, x, y, z] = [largest, x, y, z].map(|value| signed(value, 32767.0));
    match stored[3] & 3 {
        0 => [w, x, y, z],
        1 => [z, w, x, y],
        2 => [y, z, w, x],
        _ => [x, y, z, w],
    }
}

fn exponential(stored: i32) -> f32 {
    let exponent = stored >> 24;
    let mantissa = (stored << 8) >> 8;
    // Exact: the mantissa has 24 bits. Exponents beyond ±100 are not allowed, and do no harm.
    libm::ldexpf(mantissa as f32, exponent)
}

/// The nearest integer of −max..=max.
fn signed(value: f32, max: f32) -> i16 {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "casts saturate, and NaN is 0"
    )]
    {
        libm::roundf(value * max) as i16
    }
}

fn words(bytes: &[u8; 8]) -> [i16; 4] {
    let (pairs, _) = bytes.as_chunks::<2>();
    std::array::from_fn(|at| i16::from_le_bytes(pairs[at]))
}

fn store(bytes: &mut [u8; 8], words: [i16; 4]) {
    for (pair, word) in bytes.as_chunks_mut::<2>().0.iter_mut().zip(words) {
        *pair = word.to_le_bytes();
    }
}
