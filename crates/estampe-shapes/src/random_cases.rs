//! Runs a property test on random numbers from many seeds, reproducibly.

use fastrand::Rng;

/// The number of seeds.
const CASES: u64 = 256;

/// Runs a test with the random numbers of many seeds. If it fails, the seed is printed.
pub(crate) fn random_cases(test: impl Fn(&mut Rng)) {
    for seed in 0..CASES {
        let _printed = SeedOfPanic(seed);
        test(&mut Rng::with_seed(seed));
    }
}

/// Prints its seed if it is dropped by a panic.
struct SeedOfPanic(u64);

impl Drop for SeedOfPanic {
    fn drop(&mut self) {
        if std::thread::panicking() {
            eprintln!("the case of seed {}", self.0);
        }
    }
}
