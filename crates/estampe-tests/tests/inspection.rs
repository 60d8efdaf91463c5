//! Any pixel explains itself: the history of random pixels of random passes ends with the pixel
//! that is drawn, each record begins where the one before ended, and all kinds of records occur.

use estampe_tests::geometry::Style;
use estampe_tests::inspection::{Told, check_pixel};
use estampe_tests::mixed_draws::Mixture;
use estampe_tests::{Random, fast_path, oracle};
use estampe_types::TextureFormat as F;

/// The histories of every pixel of some cases.
fn check_all(topic: &str, cases: u64, mixture: impl Fn(&mut Random) -> Mixture) -> Told {
    let mut told = Told::default();
    for seed in 0..cases {
        let mut random = Random::new(topic, seed);
        let case = mixture(&mut random).case(&mut random);
        let image = oracle::draw(&case);
        for (number, device) in (0..).zip(fast_path::some_devices(seed)) {
            for pixel in 0..12 {
                let [width, height] = case.size;
                let pixel = [
                    random.below(width).min(width - 1),
                    (random.below(height) + pixel + number) % height,
                ];
                match check_pixel(device, &case, &image, pixel) {
                    Ok(of_pixel) => told += of_pixel,
                    Err(how) => panic!("{topic}, seed {seed}, pixel {pixel:?}: {how}"),
                }
            }
        }
    }
    told
}

/// Rows: U1.
#[test]
fn histories_end_with_the_pixel_that_is_drawn() {
    let told = check_all("inspection/one sample", 40, |random| {
        let format = random.pick(&[
            F::Rgba8Unorm,
            F::Bgra8UnormSrgb,
            F::Rgba16Float,
            F::Rg8Unorm,
        ]);
        let depth = random.pick(&[F::Depth24PlusStencil8, F::Depth32FloatStencil8]);
        Mixture::new(&[format], Some(depth), 1)
    });
    assert!(told.primitives > 1000, "{told:?}");
    assert!(
        told.passed > 500 && told.discarded > 0 && told.culled > 0,
        "{told:?}"
    );
    assert!(told.failed[0] > 0 && told.failed[1] > 0, "{told:?}");
}

/// Rows: U1.
#[test]
fn histories_of_several_samples_and_targets() {
    let told = check_all("inspection/samples", 25, |random| {
        let samples = random.pick(&[2, 4, 8, 16]);
        let mut mixture = Mixture::new(
            &[F::Rgba8Unorm, F::R32Float],
            Some(F::Depth16Unorm),
            samples,
        );
        mixture.styles = Style::ALL.to_vec();
        mixture
    });
    assert!(told.primitives > 500 && told.passed > 500, "{told:?}");
    assert!(told.failed[0] > 0, "{told:?}");
}
