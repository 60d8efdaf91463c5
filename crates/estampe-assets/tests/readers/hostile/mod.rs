//! Damaged and hostile files of all formats: every prefix and thousands of random mutations give a
//! valid scene or an error that names its place, soon, and in bounded memory.

mod allocator;
mod fixtures;
mod gltf;
mod mutate;
mod scene_check;
mod stated_sizes;

pub(crate) use allocator::peak_bytes;
use estampe_assets::model::{AnimationName, NoResources, ResourceError, Resources};
use estampe_assets::{Limits, Location, ModelFormat, ModelInput, ModelOptions};
use estampe_assets::{parse_model, parse_model_with};
use fastrand::Rng;
use fixtures::{Fixture, fixtures};
use mutate::{MUTATIONS, mutate};
use scene_check::check;
use std::ops::AddAssign;
use std::path::Path;
use std::time::{Duration, Instant};

/// The longest that any case may take. They take microseconds.
const MAX_TIME: Duration = Duration::from_secs(10);

/// The most memory that any case may hold. The files have some kilobytes, and the most of 2.6
/// million cases is half of it.
const MAX_BYTES: usize = 1 << 20;

/// Small where a few bytes may ask for much: images, glTF accessors without bytes, and ZIP
/// archives. The other limits are the defaults, so that memory for elements that a header states
/// and the file does not have is more than [`MAX_BYTES`].
fn limits(format: ModelFormat) -> Limits {
    let default = Limits::default();
    let is_gltf = format == ModelFormat::Gltf;
    let max_elements = |limit: u64| if is_gltf { 1 << 12 } else { limit };
    Limits {
        max_file_bytes: 1 << 20,
        max_vertices: max_elements(default.max_vertices),
        max_triangles: max_elements(default.max_triangles),
        max_image_pixels: 1 << 14,
        max_total_image_pixels: 1 << 16,
        // The allocator counts for each thread.
        threads: 1,
        ..default
    }
}

struct Files(Vec<(&'static str, Vec<u8>)>);

impl Resources for Files {
    fn resolve(&self, name: &str) -> Result<String, ResourceError> {
        let found = self.0.iter().any(|(file, _)| *file == name);
        found
            .then(|| name.to_owned())
            .ok_or(ResourceError::NotFound)
    }

    fn read(&self, resolved: &str, max_bytes: u64) -> Result<Vec<u8>, ResourceError> {
        let mut files = self.0.iter();
        let (_, bytes) = files
            .find(|(file, _)| *file == resolved)
            .expect("it was resolved");
        if bytes.len() as u64 > max_bytes {
            return Err(ResourceError::TooLarge(max_bytes));
        }
        Ok(bytes.clone())
    }
}

/// Results of many cases.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
struct Outcomes {
    models: usize,
    /// Errors with a line, a byte or a JSON Pointer.
    located_errors: usize,
    /// Errors of the whole file.
    other_errors: usize,
    /// Models with a warning that has such a place.
    located_warnings: usize,
    peak_bytes: usize,
    longest: Duration,
}

impl AddAssign for Outcomes {
    fn add_assign(&mut self, other: Self) {
        self.models += other.models;
        self.located_errors += other.located_errors;
        self.other_errors += other.other_errors;
        self.located_warnings += other.located_warnings;
        self.peak_bytes = self.peak_bytes.max(other.peak_bytes);
        self.longest = self.longest.max(other.longest);
    }
}

/// Reads a fixture's file with other bytes, and checks the result, the time and the memory.
fn read(fixture: &Fixture, bytes: &[u8]) -> Outcomes {
    let (model, files) = (fixture.model(bytes), Files(fixture.side_files(bytes)));
    let is_posed = fixture.has_animation();
    let options = ModelOptions {
        animation: is_posed.then_some(AnimationName::Index(0)),
        time_s: 0.25,
        ..ModelOptions::default()
    };
    let input = ModelInput {
        bytes: &model,
        format: fixture.format,
        name: fixture.name,
        resources: &files,
    };
    let limits = limits(fixture.format);
    let start = Instant::now();
    let (result, peak_bytes) = peak_bytes(|| parse_model_with(&input, &options, &limits));
    let mut outcome = Outcomes {
        peak_bytes,
        longest: start.elapsed(),
        ..Outcomes::default()
    };
    match result {
        Ok(loaded) => {
            check(&loaded.scene);
            assert!(loaded.warnings.len() as u64 <= loaded.warning_count);
            outcome.models = 1;
            let mut warnings = loaded.warnings.iter();
            let is_located = warnings.any(|found| is_place(found.location, &found.json_pointer));
            outcome.located_warnings = usize::from(is_located);
        }
        Err(error) => {
            let fault = error.fault();
            assert!(!fault.what.is_empty() && !fault.file.is_empty(), "{error}");
            let is_located = is_place(fault.location, &fault.json_pointer);
            outcome.located_errors = usize::from(is_located);
            outcome.other_errors = usize::from(!is_located);
        }
    }
    // The bytes are written to a file by hand to look at the case.
    assert!(
        outcome.longest < MAX_TIME,
        "{}: {:?}",
        fixture.name,
        outcome.longest
    );
    assert!(
        peak_bytes < MAX_BYTES,
        "{}: {peak_bytes} bytes",
        fixture.name
    );
    outcome
}

fn is_place(location: Option<Location>, json_pointer: &str) -> bool {
    location.is_some() || !json_pointer.is_empty()
}

/// `count` cases of each mutation of each fixture.
fn mutate_all(count: usize) {
    for (seed, fixture) in (1..).zip(fixtures()) {
        let mut random = Rng::with_seed(seed);
        let mut outcomes = Outcomes::default();
        for mutation in MUTATIONS {
            for round in 0..count {
                let mut bytes = fixture.bytes.clone();
                // Mostly one mutation, which gets past the first checks; sometimes many.
                for _ in 0..=(round % 8) / 2 * random.usize(..3) {
                    mutate(&mut bytes, mutation, &mut random);
                }
                outcomes += read(&fixture, &bytes);
            }
        }
        let name = fixture.name;
        eprintln!("{name}: {outcomes:?}");
        assert!(outcomes.models > 0, "some mutations of {name} are harmless");
        let located = match fixture.format {
            // Its damaged statements are omitted.
            ModelFormat::Obj => outcomes.located_warnings,
            _ => outcomes.located_errors,
        };
        assert!(located > 0, "some mutations of {name} are wrong at a place");
    }
}

#[test]
fn the_files_themselves_are_read() {
    for fixture in fixtures() {
        assert_eq!(read(&fixture, &fixture.bytes).models, 1, "{}", fixture.name);
    }
    let gltf = crate::gltf::builder::load(&gltf::fixture().glb());
    assert_eq!(gltf.scene.meshes.len(), 6);
}

/// Rows: M7.
#[test]
fn every_prefix_ends_well() {
    for fixture in fixtures() {
        for length in 0..fixture.bytes.len() {
            read(&fixture, &fixture.bytes[..length]);
        }
    }
}

/// Rows: M7.
#[test]
fn mutations_end_well() {
    mutate_all(300);
}

/// Rows: M7.
#[test]
#[ignore = "takes a minute: 120,000 mutations of each of 22 files"]
fn many_mutations_end_well() {
    mutate_all(10_000);
}

/// Every prefix of real files under 64 KB.
#[test]
#[ignore = "needs ../shared/data/models, and minutes in release"]
fn every_prefix_of_real_files_ends_well() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/models");
    let files = [
        "suzanne.obj",
        "odd-obj/cornell_box.obj",
        "odd-obj/usemtl-issue-68.obj",
        "odd-obj/issue-138.obj",
        "odd-obj/skin-weight.obj",
        "stl/20mm-xyz-cube.stl",
        "stl/multibody.stl",
        "stl/two_objects_mixed_case_names.stl",
        "stl/teapot.stl",
        "ply/cube_blender_uv.ply",
        "ply/sphere.ply",
        "ply/points_ascii_with_lists.ply",
    ];
    for name in files {
        let path = folder.join(name);
        let bytes = std::fs::read(&path).unwrap_or_else(|error| panic!("{name}: {error}"));
        let format = ModelFormat::from_extension(&path).unwrap();
        for length in 0..bytes.len() {
            let bytes = &bytes[..length];
            if let Ok(loaded) = parse_model(bytes, format, name, &NoResources, &limits(format)) {
                check(&loaded.scene);
            }
        }
    }
}
