//! Search for positions that are equal to the bit.
//!
//! Keys are distributed by three bits of their hash, in order, to eight small tables, which threads
//! fill at once. The first of equal keys depends on neither the tables nor the threads.

use crate::zeros::zeros;
use estampe_scene::{Workers, pieces};
use glam::Vec3;
use std::sync::atomic::{AtomicU32, Ordering};

/// The compared values: the bits of a position, and a tag that keeps different vertices apart.
pub(super) type Key = [u32; 4];

/// The key of a position; `-0.0` equals `0.0`, and a NaN equals a NaN of the same bits.
#[inline]
pub(super) fn key(position: Vec3, tag: u32) -> Key {
    // Adding zero turns -0.0 into 0.0 and changes nothing else.
    [
        (position.x + 0.0).to_bits(),
        (position.y + 0.0).to_bits(),
        (position.z + 0.0).to_bits(),
        tag,
    ]
}

/// For each of `count` keys the index of the first equal key; about `expected` are different.
pub(super) fn first_equals(
    count: usize,
    expected: usize,
    key: impl Fn(usize) -> Key + Sync,
    workers: Workers,
) -> Vec<u32> {
    const TABLES: usize = 8;
    /// Keys of a piece: some hundred microseconds of work.
    const PIECE: usize = 1 << 15;
    let number = |index: usize| u32::try_from(index).expect("limits keep corners below 2^32");
    let tables = if count <= PIECE { 1 } else { TABLES };
    let dealt = workers.map(pieces(count, PIECE), |range| {
        let mut lists = vec![Vec::with_capacity(range.len() * 5 / (4 * tables)); tables];
        for index in range {
            // The low bits select the table, the high ones the slot in it.
            let table = usize::try_from(hash(key(index)) % 8).unwrap_or(0) % tables;
            lists[table].push(number(index));
        }
        lists
    });
    let firsts: Vec<AtomicU32> = (0..number(count)).map(AtomicU32::new).collect();
    workers.map(0..tables, |table| {
        let mut firsts_here = Table::with_room(expected / tables, &key);
        for &index in dealt.iter().flat_map(|lists| &lists[table]) {
            let first = firsts_here.first(index);
            if first != index {
                firsts[index as usize].store(first, Ordering::Relaxed);
            }
        }
    });
    firsts.into_iter().map(AtomicU32::into_inner).collect()
}

/// The first of each set of equal keys.
///
/// A hash table with open addressing that probes at most [`Self::MAX_PROBES`] slots. Positions
/// chosen to collide are then not recognised as equal, and the time stays linear without a secret
/// seed, so the result is the same in every run.
struct Table<'a, K> {
    /// Index of a key plus one; 0 is free. At most half full.
    slots: Vec<u32>,
    /// 64 minus the bits of a slot index.
    shift: u32,
    /// Number of different keys.
    len: usize,
    key: &'a K,
}

impl<'a, K: Fn(usize) -> Key> Table<'a, K> {
    const MAX_PROBES: usize = 128;
    const LEAST_BITS: u32 = 6;

    /// An empty table with space for `count` different keys.
    fn with_room(count: usize, key: &'a K) -> Self {
        let bits = (count.saturating_mul(2) | 1).ilog2() + 1;
        let bits = bits.clamp(Self::LEAST_BITS, 32);
        Self {
            slots: zeros(1 << bits),
            shift: 64 - bits,
            len: 0,
            key,
        }
    }

    /// The first key that equals key `number`, which is `number` itself if there is none before.
    #[inline]
    fn first(&mut self, number: u32) -> u32 {
        if self.len * 2 >= self.slots.len() {
            self.grow();
        }
        let own = (self.key)(number as usize);
        let mask = self.slots.len() - 1;
        let mut place = self.place(own);
        for _ in 0..Self::MAX_PROBES {
            match self.slots[place] {
                0 => {
                    self.slots[place] = number + 1;
                    self.len += 1;
                    break;
                }
                occupant if (self.key)(occupant as usize - 1) == own => return occupant - 1,
                _ => place = (place + 1) & mask,
            }
        }
        number
    }

    /// Quadruples the table, so that growing is at most a third of the work.
    #[cold]
    fn grow(&mut self) {
        self.shift -= 2;
        let size = self.slots.len() * 4;
        let occupants = std::mem::replace(&mut self.slots, zeros(size));
        for occupant in occupants.into_iter().filter(|&occupant| occupant != 0) {
            let mut place = self.place((self.key)(occupant as usize - 1));
            for _ in 0..Self::MAX_PROBES {
                if self.slots[place] == 0 {
                    self.slots[place] = occupant;
                    break;
                }
                place = (place + 1) & (size - 1);
            }
        }
    }

    #[inline]
    fn place(&self, key: Key) -> usize {
        usize::try_from(hash(key) >> self.shift).expect("a place is below the table's length")
    }
}

/// Two multiplications, each folded onto itself, as in the family of wyhash.
#[inline]
fn hash(key: Key) -> u64 {
    let low = u64::from(key[0]) | u64::from(key[1]) << 32;
    let high = u64::from(key[2]) | u64::from(key[3]) << 32;
    let mixed = fold(low ^ 0x9e37_79b9_7f4a_7c15, high ^ 0xe703_7ed1_a0b4_28db);
    fold(mixed, 0x8ebc_6af0_9c88_c6e3)
}

/// Both halves of the product, combined by XOR.
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
