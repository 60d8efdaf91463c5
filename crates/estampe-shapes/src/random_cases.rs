//! Properties that hold for random input: tests run them on streams of random numbers that repeat.

use fastrand::Rng;

/// How many streams there are.
const CASES: u64 = 256;

/// Runs a test on the streams of many seeds. Where it fails, the seed is printed.
pub(crate) fn random_cases(test: impl Fn(&mut Rng)) {
    for seed in 0..CASES {
        let _printed = SeedOfPanic(seed);
        test(&mut Rng::with_seed(seed));
    }
}

/// Prints its seed when it is dropped by a panic.
struct SeedOfPanic(u64);

impl Drop for SeedOfPanic {
    fn drop(&mut self) {
        if std::thread::panicking() {
            eprintln!("the case of seed {}", self.0);
        }
    }
}
