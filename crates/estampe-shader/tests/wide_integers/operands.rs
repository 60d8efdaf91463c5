//! Pairs of operands: edges with edges, and random ones of every size.

/// Two operands, and a word: a shift, a range of bits, the bits of a float.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Operands {
    pub(crate) a: u64,
    pub(crate) b: u64,
    pub(crate) n: u32,
}

fn edges() -> Vec<u64> {
    let mut edges = vec![3, 5, 6, 7, 10, 641, 1_000_000_007];
    for bit in [0, 1, 8, 16, 23, 24, 25, 31, 32, 33, 40, 47, 48, 53, 62, 63] {
        let power = 1_u64 << bit;
        edges.extend([power - 1, power, power + 1]);
    }
    let negative: Vec<_> = edges.iter().map(|edge| edge.wrapping_neg()).collect();
    edges.extend(negative);
    // Digits of 16 and of 32 bits for which an estimated digit of a quotient is too large.
    edges.extend([
        0x8000_0000_0000_FFFF,
        0x7FFF_FFFF_8000_0000,
        0x0000_FFFF_FFFE_0000,
        0x8000_FFFF_0000_0000,
        0x0000_8000_FFFF_FFFE,
    ]);
    edges.sort_unstable();
    edges.dedup();
    edges
}

/// Words of which some are small, some bits of floats near the ends of the types.
fn word(random: &mut fastrand::Rng) -> u32 {
    let floats = [
        0.0_f32,
        -0.0,
        0.99,
        -0.99,
        1.0e-40,
        16_777_217.0,
        2_147_483_648.0,
        4_294_967_296.0,
        9.223_371e18,
        9.223_372e18,
        1.844_674_3e19,
        1.844_674_5e19,
        f32::MAX,
        f32::INFINITY,
        f32::NAN,
    ];
    match random.u32(0..6) {
        0 => random.u32(0..65),
        1 => random.u32(..),
        2 => {
            let float = floats[random.usize(0..floats.len())];
            (if random.bool() { float } else { -float }).to_bits()
        }
        // From 2⁻² to 2⁷⁰.
        3 => (random.u32(125..198) << 23 | random.u32(0..1 << 23)) | random.u32(0..2) << 31,
        _ => random.u32(0..128),
    }
}

/// A random number of a random size, perhaps negative.
fn number(random: &mut fastrand::Rng) -> u64 {
    let number = random.u64(..) >> random.u32(0..64);
    match random.u32(0..4) {
        0 => number.wrapping_neg(),
        // Half-way between two floats, or beside that.
        1 => {
            let half = random.u64(1 << 23..1 << 24) * 2 + 1;
            let moved = half << random.u32(0..40);
            let beside = moved.wrapping_add(random.u64(0..3)).wrapping_sub(1);
            if random.bool() {
                beside
            } else {
                beside.wrapping_neg()
            }
        }
        _ => number,
    }
}

/// A multiple of 64 pairs.
pub(crate) fn pairs() -> Vec<Operands> {
    let mut random = fastrand::Rng::with_seed(64);
    let edges = edges();
    let mut pairs = Vec::new();
    for &a in &edges {
        for &b in &edges {
            let n = word(&mut random);
            pairs.push(Operands { a, b, n });
        }
    }
    while pairs.len() < 16_000 || !pairs.len().is_multiple_of(super::run::GROUP) {
        let (b, n) = (number(&mut random), word(&mut random));
        let a = if random.bool() {
            // Beside a multiple of the other.
            let quotient = number(&mut random);
            let near = random.u64(0..3).wrapping_sub(1);
            quotient.wrapping_mul(b).wrapping_add(near)
        } else {
            number(&mut random)
        };
        pairs.push(Operands { a, b, n });
    }
    pairs
}
