//! Pseudo-random numbers, reproducible from a topic and a seed.

/// The random numbers of a topic and a seed.
#[derive(Debug, Clone)]
pub struct Random(fastrand::Rng);

impl Random {
    /// The sequence of a topic and a seed.
    #[must_use]
    pub fn new(topic: &str, seed: u64) -> Self {
        // FNV-1a, so that two topics do not draw the same cases.
        let hash = topic.bytes().fold(0xCBF2_9CE4_8422_2325, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01B3)
        });
        let of_seed = hash ^ seed.wrapping_mul(0x9E37_79B9_7F4A_7C15);
        Self(fastrand::Rng::with_seed(of_seed))
    }

    /// 32 bits.
    pub fn bits(&mut self) -> u32 {
        self.0.u32(..)
    }

    /// A number in 0..1.
    pub fn unit(&mut self) -> f32 {
        self.0.f32()
    }

    /// A number in low..high.
    pub fn range(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }

    /// An integer below `n`.
    pub fn below(&mut self, n: u32) -> u32 {
        self.0.u32(..n)
    }

    /// An index below `n`.
    pub fn index(&mut self, n: usize) -> usize {
        self.0.usize(..n)
    }

    /// A byte.
    pub fn byte(&mut self) -> u8 {
        self.0.u8(..)
    }

    /// True once in `n` times.
    pub fn once_in(&mut self, n: u32) -> bool {
        self.below(n) == 0
    }

    /// One of some values.
    pub fn pick<T: Clone>(&mut self, from: &[T]) -> T {
        from[self.index(from.len())].clone()
    }

    /// Four numbers in low..high.
    pub fn four(&mut self, low: f32, high: f32) -> [f32; 4] {
        std::array::from_fn(|_| self.range(low, high))
    }

    /// A number that programs often treat wrongly: NaN, ±∞, huge, denormal, ±0, or an ordinary one.
    pub fn odd_number(&mut self) -> f32 {
        self.pick(&[
            f32::NAN,
            f32::INFINITY,
            f32::NEG_INFINITY,
            f32::MAX,
            -1e30,
            1e20,
            1e-45,
            -1e-40,
            3e-39,
            0.0,
            -0.0,
            0.5,
            1.0,
            -1.0,
            2.0,
            300.0,
        ])
    }
}
