//! Any pixel explains itself: the history of random pixels of random passes ends with the pixel
//! that is drawn, each record begins where the one before ended, and all kinds of records occur.
//! And any stage can be inspected: what all stages made of a pass agrees with the histories of its
//! pixels, whatever the number of threads.

use estampe_tests::geometry::Style;
use estampe_tests::inspection::{StagesTold, Told, check_pixel, check_stages};
use estampe_tests::mixed_draws::Mixture;
use estampe_tests::{Random, fast_path, oracle};
use estampe_types::TextureFormat as F;
use estampe_types::state::{
    CullMode, LineRasterization, LineState, PolygonMode, PrimitiveTopology as T,
};

/// The number of random pixels of a case.
const PIXELS: usize = 48;

/// The histories of random pixels of some cases, whose devices take turns.
fn check_all(topic: &str, cases: u64, mixture: impl Fn(&mut Random) -> Mixture) -> Told {
    let mut told = Told::default();
    for seed in 0..cases {
        let mut random = Random::new(topic, seed);
        let case = mixture(&mut random).case(&mut random);
        let image = oracle::draw(&case);
        // As many pixels on every machine, whatever levels its processor has.
        let devices = fast_path::some_devices(seed);
        for device in devices.iter().cycle().take(PIXELS) {
            let [width, height] = case.size;
            let pixel = [random.below(width), random.below(height)];
            match check_pixel(device, &case, &image, pixel) {
                Ok(of_pixel) => told += of_pixel,
                Err(how) => panic!("{topic}, seed {seed}, pixel {pixel:?}: {how}"),
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

/// What all stages made of some cases, compared with the histories of random pixels.
fn check_all_stages(
    topic: &str,
    cases: u64,
    mixture: impl Fn(&mut Random) -> Mixture,
) -> StagesTold {
    let mut told = StagesTold::default();
    for seed in 0..cases {
        let mut random = Random::new(topic, seed);
        let mut case = mixture(&mut random).case(&mut random);
        for draw in &mut case.draws {
            let primitive = &mut draw.primitive;
            if random.once_in(4) {
                primitive.topology = random.pick(&[T::LineList, T::LineStrip, T::PointList]);
            } else if random.once_in(5) {
                primitive.polygon_mode = random.pick(&[PolygonMode::Line, PolygonMode::Point]);
            }
            if random.once_in(2) {
                let kinds = [LineRasterization::Bresenham, LineRasterization::Rectangular];
                primitive.line = LineState {
                    width: random.pick(&[1.0, 2.5, 8.0]),
                    rasterization: random.pick(&kinds),
                    stipple: None,
                };
            }
            if random.once_in(4) {
                primitive.cull_mode = random.pick(&[CullMode::Front, CullMode::Back]);
            }
        }
        let [width, height] = case.size;
        let pixels = [0; 10].map(|_| [random.below(width), random.below(height)]);
        let devices = fast_path::all_devices();
        match check_stages(&devices[devices.len() - 3..], &case, &pixels) {
            Ok(of_case) => told += of_case,
            Err(how) => panic!("{topic}, seed {seed}: {how}"),
        }
    }
    told
}

/// Rows: U2.
#[test]
fn stages_agree_with_the_histories_of_pixels_at_every_number_of_threads() {
    let told = check_all_stages("inspection/stages", 60, |random| {
        let samples = random.pick(&[1, 1, 1, 2, 4, 8, 16]);
        let depth = random.pick(&[F::Depth16Unorm, F::Depth24PlusStencil8, F::Depth32Float]);
        let mut mixture = Mixture::new(&[F::Rgba8Unorm, F::R32Float], Some(depth), samples);
        if random.once_in(2) {
            mixture.styles = Style::ALL.to_vec();
        }
        mixture
    });
    assert!(told.clipped.iter().all(|&count| count > 20), "{told:?}");
    assert!(told.new.iter().all(|&count| count > 20), "{told:?}");
    assert!(told.kinds.iter().all(|&count| count > 50), "{told:?}");
    assert!(told.culled > 20 && told.tiles > 100, "{told:?}");
    assert!(told.blocks[0] > 500 && told.blocks[1] > 50, "{told:?}");
    assert!(told.pixels[1] > 100 && told.stored > 200, "{told:?}");
}
