//! Draws cases with the oracle and the fast path, compares the images, and shrinks failing cases.

use crate::Random;
use crate::case::Case;
use crate::expected_paths::ExpectedPaths;
use crate::fast_path::{
    self, Drawn, all_devices, devices_of_seed, devices_with_small_bins, some_devices,
};
use crate::inspection;
use crate::oracle::{self, Image};
use estampe::{Device, Statistics, TilePath};
use estampe_types::state::PrimitiveTopology;

/// The greatest number of attempts to shrink a failing case.
const SHRINK_STEPS: usize = 400;

/// Draws `count` random cases of a topic with the oracle and the fast path.
///
/// # Panics
/// If an image differs; the message has the seed and describes a smaller case that differs too.
pub fn check(topic: &str, count: u64, make: impl Fn(&mut Random) -> Case) {
    check_paths(topic, count, ExpectedPaths::default(), make);
}

/// Draws `count` random cases of a topic with the oracle and the fast path; together they must have
/// taken `paths`. Returns the sum of all statistics.
///
/// # Panics
/// If an image differs, as in [`check`], or if one of the paths was never taken.
pub fn check_paths(
    topic: &str,
    count: u64,
    paths: ExpectedPaths,
    make: impl Fn(&mut Random) -> Case,
) -> Statistics {
    let devices = |seed, is_longer| match is_longer {
        true => all_devices(),
        false => devices_of_seed(seed),
    };
    check_on(topic, count, (paths, devices), make)
}

/// Draws `count` random cases of a topic with the oracle and on devices with hardly any memory for
/// bins. Returns the sum of all statistics.
///
/// # Panics
/// If an image differs, as in [`check`].
pub fn check_with_small_bins(
    topic: &str,
    count: u64,
    make: impl Fn(&mut Random) -> Case,
) -> Statistics {
    let devices = |_, _| devices_with_small_bins();
    check_on(topic, count, (ExpectedPaths::default(), devices), make)
}

/// Draws `count` random cases, or as many times more as the environment asks for, on the devices of
/// each seed; together they must have taken `paths`.
fn check_on(
    topic: &str,
    count: u64,
    (paths, devices_of): (ExpectedPaths, impl Fn(u64, bool) -> Vec<&'static Device>),
    make: impl Fn(&mut Random) -> Case,
) -> Statistics {
    let (mut cases, mut empty) = (0, 0);
    let mut statistics = Statistics::default();
    let number = |name: &str| std::env::var(name).ok()?.parse::<u64>().ok();
    let factor = number("ESTAMPE_TEST_FACTOR");
    let only = number("ESTAMPE_TEST_SEED");
    let seeds = match only {
        Some(seed) => seed..seed + 1,
        None => 0..count * factor.unwrap_or(1),
    };
    for seed in seeds {
        let case = make(&mut Random::new(topic, seed));
        let devices = devices_of(seed, factor.is_some());
        let image = match compare(&case, &devices, &mut statistics) {
            Ok(image) => image,
            Err(first) => {
                let (small, difference) = shrunk(case, &devices, first);
                let words = small.describe();
                panic!("{topic}, seed {seed}: {difference}\n{words}");
            }
        };
        cases += 1;
        empty += u64::from(is_of_one_piece(&image));
    }
    // Two empty images are equal too: a topic must draw something.
    assert!(
        count < FEW || empty * 4 < cases * 3,
        "{topic}: {empty} of {cases} cases show nothing"
    );
    eprintln!("{topic}: {}", described(&statistics));
    // A single seed need not take every path.
    if only.is_none() {
        paths.assert_reached(topic, &statistics);
    }
    statistics
}

/// The numbers of primitives on each tile path, to choose the expected paths of a topic by.
fn described(statistics: &Statistics) -> String {
    let taken = TilePath::ALL
        .into_iter()
        .filter(|path| statistics.paths.of(*path) > 0);
    let words = taken.map(|path| format!("{} {}", statistics.paths.of(path), path.name()));
    words.collect::<Vec<_>>().join("; ")
}

/// With so few cases, all images of a topic may be plain.
const FEW: u64 = 8;

/// Returns true if all pixels of an image are equal; false for a single pixel.
fn is_of_one_piece(image: &Image) -> bool {
    let is_all_one = |values: &Vec<u8>| values.iter().all(|value| *value == values[0]);
    let is_same_stencil = image.stored.stencils.iter().all(is_all_one);
    let is_same_depth = is_same_stencil && image.depth.iter().all(|&depth| depth == image.depth[0]);
    let texels = image.stored.texels.first().unwrap_or(&image.color);
    let count = image.pixels;
    let mut pixels = texels.chunks((texels.len() / count.max(1)).max(1));
    let first = pixels.next();
    count > 1 && is_same_depth && pixels.all(|pixel| Some(pixel) == first)
}

/// Draws one large case with the oracle and with the fast path at every SIMD level.
///
/// # Panics
/// If an image differs.
pub fn check_some(topic: &str, case: &Case) {
    if let Err(difference) = compare(case, &some_devices(1), &mut Statistics::default()) {
        panic!("{topic}: {difference}\n{}", case.describe());
    }
}

/// Draws one case with the oracle, and with the fast path at every SIMD level and number of
/// threads; returns the image.
///
/// # Panics
/// If an image differs.
pub fn check_one(topic: &str, case: &Case) -> Image {
    match compare(case, &all_devices(), &mut Statistics::default()) {
        Ok(image) => image,
        Err(difference) => panic!("{topic}: {difference}\n{}", case.describe()),
    }
}

/// The oracle's image, or a description of how the image of the first device that disagrees differs
/// from it. The devices' counts are added to `statistics`.
fn compare(case: &Case, devices: &[&Device], statistics: &mut Statistics) -> Result<Image, String> {
    let wanted = oracle::draw(case);
    for device in devices {
        let Drawn {
            image,
            statistics: of_device,
        } = fast_path::draw(device, case);
        *statistics += of_device;
        if image != wanted {
            return Err(difference(case, device, &image, &wanted));
        }
    }
    if let Some(device) = devices.first() {
        inspect_one(device, case, &wanted)?;
    }
    Ok(wanted)
}

/// Inspects a pixel: one in the middle, or the first one that is not as the first pixel is.
fn inspect_one(device: &Device, case: &Case, image: &Image) -> Result<(), String> {
    let [width, height] = case.size;
    let texels = image.stored.texels.first().unwrap_or(&image.color);
    let pixels = width as usize * height as usize;
    let each = (texels.len() / pixels.max(1)).max(1);
    let mut colors = texels.chunks(each);
    let first = colors.next();
    let shown = colors.rposition(|color| Some(color) != first);
    let at = shown.map_or(pixels / 2, |at| at + 1);
    let [x, y] = [at % width as usize, at / width as usize];
    let pixel = [x, y].map(|at| u32::try_from(at).unwrap_or(u32::MAX));
    let told = inspection::check_pixel(device, case, image, pixel);
    told.map(drop).map_err(|difference| {
        let device = fast_path::name(device);
        format!("{device}: the history of pixel {pixel:?}: {difference}")
    })
}

fn difference(case: &Case, device: &Device, got: &Image, wanted: &Image) -> String {
    let pixels = case.size[0] as usize * case.size[1] as usize;
    let color = |image: &Image, at: usize| image.color.get(at * 4..at * 4 + 4).map(<[u8]>::to_vec);
    let differs = |at: &usize| {
        color(got, *at) != color(wanted, *at) || got.depth.get(*at) != wanted.depth.get(*at)
    };
    let all: Vec<_> = (0..pixels).filter(differs).collect();
    let device = fast_path::name(device);
    let Some(&at) = all.first() else {
        let stored = got.stored.difference(&wanted.stored, case);
        let counts = format!(
            "{} primitives, oracle {}; counts {:?}, oracle {:?}",
            got.primitives, wanted.primitives, got.counts, wanted.counts
        );
        return format!("{device}: {}", stored.unwrap_or(counts));
    };
    let depth = |image: &Image| image.depth.get(at).map(|&bits| f32::from_bits(bits));
    format!(
        "{device}: {} pixels differ, first ({}, {}): fast path {:?} depth {:?}, oracle {:?} depth {:?}",
        all.len(),
        at % case.size[0] as usize,
        at / case.size[0] as usize,
        color(got, at),
        depth(got),
        color(wanted, at),
        depth(wanted),
    )
}

/// The smallest case found, by repeated [`smaller_cases`], that still fails, and its difference.
fn shrunk(mut case: Case, devices: &[&Device], mut how: String) -> (Case, String) {
    let mut steps = 0;
    'again: loop {
        for smaller in smaller_cases(&case) {
            steps += 1;
            if steps > SHRINK_STEPS {
                return (case, how);
            }
            if let Err(difference) = compare(&smaller, devices, &mut Statistics::default()) {
                (case, how) = (smaller, difference);
                continue 'again;
            }
        }
        return (case, how);
    }
}

/// Cases that are one step simpler.
fn smaller_cases(case: &Case) -> Vec<Case> {
    let mut cases = Vec::new();
    for removed in 0..case.draws.len() {
        let mut smaller = case.clone();
        smaller.draws.remove(removed);
        smaller.second_pass = match case.second_pass {
            usize::MAX => usize::MAX,
            at => at - usize::from(removed < at),
        };
        cases.push(smaller);
    }
    for (number, draw) in case.draws.iter().enumerate() {
        use PrimitiveTopology as T;
        let step = match draw.primitive.topology {
            T::TriangleList => 3,
            T::LineList => 2,
            // Remove two triangles at a time: every other one of a strip has the opposite winding.
            T::TriangleStrip => 2,
            _ => 1,
        };
        let count = (draw.elements.end - draw.elements.start) / step;
        let mut with_elements = |elements| {
            let mut smaller = case.clone();
            smaller.draws[number].elements = elements;
            cases.push(smaller);
        };
        for part in [count / 2, count / 4, 1] {
            if part > 0 && part < count {
                with_elements(draw.elements.start..draw.elements.end - part * step);
                with_elements(draw.elements.start + part * step..draw.elements.end);
            }
        }
        if draw.instances.len() > 1 {
            let mut smaller = case.clone();
            smaller.draws[number].instances.end -= 1;
            cases.push(smaller);
        }
    }
    if case.samples > 1 {
        cases.push(Case {
            samples: 1,
            ..case.clone()
        });
    }
    cases
}
