//! Integer sequences: numbers of a few levels, packed as bits with trits or quints above them
//! (section 23.12).

#![expect(
    clippy::cast_possible_truncation,
    reason = "a sequence has at most 64 numbers, of which each has at most 8 bits"
)]

/// The possible numbers of levels, each finer than the one before.
pub(super) const LEVELS: [u32; 21] = [
    2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 24, 32, 40, 48, 64, 80, 96, 128, 160, 192, 256,
];

/// The digit above the bits of a number.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Above {
    Nothing,
    Trit,
    Quint,
}

/// The packing of the numbers of a sequence.
#[derive(Clone, Copy)]
pub(super) struct Range {
    bits: u32,
    above: Above,
}

impl Range {
    /// The packing of a number of levels: 2ⁿ, 3·2ⁿ or 5·2ⁿ.
    pub(super) fn of(levels: u32) -> Self {
        let (above, rest) = if levels.is_multiple_of(3) {
            (Above::Trit, levels / 3)
        } else if levels.is_multiple_of(5) {
            (Above::Quint, levels / 5)
        } else {
            (Above::Nothing, levels)
        };
        Self {
            bits: rest.trailing_zeros(),
            above,
        }
    }

    pub(super) fn levels(self) -> u32 {
        let above = match self.above {
            Above::Nothing => 1,
            Above::Trit => 3,
            Above::Quint => 5,
        };
        above << self.bits
    }

    /// Bits of a sequence of `count` numbers.
    pub(super) fn bits_of(self, count: usize) -> u32 {
        // At most 128 numbers.
        let count = count as u32;
        count * self.bits
            + match self.above {
                Above::Nothing => 0,
                Above::Trit => (8 * count).div_ceil(5),
                Above::Quint => (7 * count).div_ceil(3),
            }
    }

    /// Reads a sequence that fills all of the bits; missing bits of its last group are 0.
    pub(super) fn read(self, sequence: u128, to: &mut [u32]) {
        let mut left = sequence;
        let mut take = |count: u32| {
            let value = (left & ((1 << count) - 1)) as u32;
            left >>= count;
            value
        };
        // The count of numbers that share a group, and of its bits that follow each of them.
        let (group, parts): (usize, &[u32]) = match self.above {
            Above::Nothing => (1, &[0]),
            Above::Trit => (5, &[2, 2, 1, 2, 1]),
            Above::Quint => (3, &[3, 2, 2]),
        };
        for numbers in to.chunks_mut(group) {
            let mut lower = [0; 5];
            let (mut packed, mut at) = (0, 0);
            for (lower, part) in lower.iter_mut().zip(parts) {
                *lower = take(self.bits);
                packed |= take(*part) << at;
                at += part;
            }
            let upper = match self.above {
                Above::Nothing => [0; 5],
                Above::Trit => trits(packed),
                Above::Quint => quints(packed),
            };
            for (k, number) in numbers.iter_mut().enumerate() {
                *number = upper[k] << self.bits | lower[k];
            }
        }
    }

    /// A number as a colour, 0 to 255.
    pub(super) fn color_of(self, number: u32) -> u32 {
        let (upper, lower) = (number >> self.bits, number & ((1 << self.bits) - 1));
        let Some([factor, spread]) = self.color_spread(lower >> 1) else {
            return repeated(lower, self.bits, 8);
        };
        let a = (lower & 1) * 0x1FF;
        let mixed = (upper * factor + spread) ^ a;
        a & 0x80 | mixed >> 2
    }

    /// Table 121: what trits or quints are multiplied by, and the bits above the lowest, spread
    /// over nine.
    fn color_spread(self, high: u32) -> Option<[u32; 2]> {
        Some(match (self.above, self.bits) {
            (Above::Trit, 1) => [204, 0],
            // b000b0bb0
            (Above::Trit, 2) => [93, high * 0b1_0001_0110],
            // cb000cbcb
            (Above::Trit, 3) => [44, high << 7 | high << 2 | high],
            // dcb000dcb
            (Above::Trit, 4) => [22, high << 6 | high],
            // edcb000ed
            (Above::Trit, 5) => [11, high << 5 | high >> 2],
            // fedcb000f
            (Above::Trit, _) => [5, high << 4 | high >> 4],
            (Above::Quint, 1) => [113, 0],
            // b0000bb00
            (Above::Quint, 2) => [54, high * 0b1_0000_1100],
            // cb0000cbc
            (Above::Quint, 3) => [26, high << 7 | high << 1 | high >> 1],
            // dcb0000dc
            (Above::Quint, 4) => [13, high << 6 | high >> 1],
            // edcb0000e
            (Above::Quint, _) => [6, high << 5 | high >> 3],
            (Above::Nothing, _) => return None,
        })
    }

    /// A number as a weight, 0 to 64.
    pub(super) fn weight_of(self, number: u32) -> u32 {
        let (upper, lower) = (number >> self.bits, number & ((1 << self.bits) - 1));
        let high = lower >> 1;
        let spread = match (self.above, self.bits) {
            (Above::Nothing, _) => None,
            (Above::Trit, 0) => return [0, 32, 64][number as usize % 3],
            (Above::Quint, 0) => return [0, 16, 32, 48, 64][number as usize % 5],
            (Above::Trit, 1) => Some([50, 0]),
            // b000b0b
            (Above::Trit, 2) => Some([23, high * 0b100_0101]),
            // cb000cb
            (Above::Trit, _) => Some([11, high << 5 | high]),
            (Above::Quint, 1) => Some([28, 0]),
            // b0000b0
            (Above::Quint, _) => Some([13, high * 0b100_0010]),
        };
        let weight = match spread {
            None => repeated(lower, self.bits, 6),
            Some([factor, spread]) => {
                let a = (lower & 1) * 0x7F;
                let mixed = (upper * factor + spread) ^ a;
                a & 0x20 | mixed >> 2
            }
        };
        weight + u32::from(weight > 32)
    }
}

/// `from` bits, repeated from the top down to fill `to` bits.
fn repeated(value: u32, from: u32, to: u32) -> u32 {
    let (mut all, mut count) = (0, 0);
    while count < to {
        all = all << from | value;
        count += from;
    }
    all >> (count - to)
}

/// Five trits of eight bits.
fn trits(t: u32) -> [u32; 5] {
    let bit = |k: u32| t >> k & 1;
    let (c, t3, t4);
    if t >> 2 & 7 == 7 {
        c = (t >> 5) << 2 | t & 3;
        (t3, t4) = (2, 2);
    } else {
        c = t & 31;
        (t3, t4) = if t >> 5 & 3 == 3 {
            (bit(7), 2)
        } else {
            (t >> 5 & 3, bit(7))
        };
    }
    let c_bit = |k: u32| c >> k & 1;
    let [t0, t1, t2] = if c & 3 == 3 {
        [c_bit(3) << 1 | c_bit(2) & !c_bit(3), c_bit(4), 2]
    } else if c >> 2 & 3 == 3 {
        [c & 3, 2, 2]
    } else {
        [c_bit(1) << 1 | c_bit(0) & !c_bit(1), c >> 2 & 3, c_bit(4)]
    };
    [t0, t1, t2, t3, t4]
}

/// Three quints of seven bits.
fn quints(q: u32) -> [u32; 5] {
    let bit = |k: u32| q >> k & 1;
    if q >> 1 & 3 == 3 && q >> 5 & 3 == 0 {
        let last = bit(0) << 2 | (bit(4) & !bit(0)) << 1 | bit(3) & !bit(0);
        return [4, 4, last, 0, 0];
    }
    let (c, last) = if q >> 1 & 3 == 3 {
        ((q >> 3 & 3) << 3 | (!q >> 5 & 3) << 1 | bit(0), 4)
    } else {
        (q & 31, q >> 5 & 3)
    };
    if c & 7 == 5 {
        [c >> 3, 4, last, 0, 0]
    } else {
        [c & 7, c >> 3, last, 0, 0]
    }
}
