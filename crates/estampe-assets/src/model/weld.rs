//! Finds positions that are equal to the bit.

use glam::Vec3;

/// Numbers different positions; `-0.0` equals `0.0`, and a NaN equals a NaN of the same bits.
///
/// A hash table with open addressing that never looks further than [`Self::MAX_PROBES`] places: positions
/// chosen to collide are then simply not found to be equal, and the time stays linear without a secret
/// seed, so the result is the same in every run.
#[derive(Debug)]
pub(super) struct Welder {
    /// Number of a position plus one; 0 is free. At most half full.
    table: Vec<u32>,
    /// 64 less the bits of a place.
    shift: u32,
    keys: Vec<[u32; 4]>,
}

impl Default for Welder {
    fn default() -> Self {
        Self::with_room(0)
    }
}

impl Welder {
    const MAX_PROBES: usize = 128;
    const LEAST_BITS: u32 = 10;

    /// No positions yet, and room for `count` different ones.
    pub(super) fn with_room(count: usize) -> Self {
        let bits = (count.saturating_mul(2) | 1).ilog2() + 1;
        let bits = bits.clamp(Self::LEAST_BITS, 32);
        Self {
            table: vec![0; 1 << bits],
            shift: 64 - bits,
            keys: Vec::with_capacity(count),
        }
    }

    /// How many different positions there are.
    pub(super) fn len(&self) -> usize {
        self.keys.len()
    }

    /// The number of `position`; `tag` keeps apart what must not be one. New numbers count up from 0.
    #[inline]
    pub(super) fn number(&mut self, position: Vec3, tag: u32) -> u32 {
        // Adding zero turns -0.0 into 0.0 and changes nothing else.
        let key = [
            (position.x + 0.0).to_bits(),
            (position.y + 0.0).to_bits(),
            (position.z + 0.0).to_bits(),
            tag,
        ];
        if self.keys.len() * 2 >= self.table.len() {
            self.grow();
        }
        let mask = self.table.len() - 1;
        let mut place = self.place(key);
        let next = u32::try_from(self.keys.len()).expect("limits keep vertices below 2^32");
        for _ in 0..Self::MAX_PROBES {
            match self.table[place] {
                0 => {
                    self.table[place] = next + 1;
                    break;
                }
                occupant if self.keys[occupant as usize - 1] == key => return occupant - 1,
                _ => place = (place + 1) & mask,
            }
        }
        self.keys.push(key);
        next
    }

    /// Four times the table: growing is then a third of the work at most.
    #[cold]
    fn grow(&mut self) {
        self.shift -= 2;
        let size = self.table.len() * 4;
        self.table.clear();
        self.table.resize(size, 0);
        let mask = size - 1;
        for (number, &key) in (1..).zip(&self.keys) {
            let mut place = self.place(key);
            for _ in 0..Self::MAX_PROBES {
                if self.table[place] == 0 {
                    self.table[place] = number;
                    break;
                }
                place = (place + 1) & mask;
            }
        }
    }

    /// Two multiplications, each folded onto itself, as in the family of wyhash.
    #[inline]
    fn place(&self, key: [u32; 4]) -> usize {
        let low = u64::from(key[0]) | u64::from(key[1]) << 32;
        let high = u64::from(key[2]) | u64::from(key[3]) << 32;
        let mixed = fold(low ^ 0x9e37_79b9_7f4a_7c15, high ^ 0xe703_7ed1_a0b4_28db);
        let hash = fold(mixed, 0x8ebc_6af0_9c88_c6e3);
        usize::try_from(hash >> self.shift).expect("a place is below the table's length")
    }
}

/// Both halves of the product, xored.
#[inline]
fn fold(a: u64, b: u64) -> u64 {
    let product = u128::from(a) * u128::from(b);
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the two halves are what is wanted"
    )]
    {
        product as u64 ^ (product >> 64) as u64
    }
}
