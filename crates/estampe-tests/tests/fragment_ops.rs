//! Blending, write mask, depth and stencil of one sample: 2,000 cases with the results of the reference fragment processor
//! of KhronosGroup/VK-GL-CTS, where the file is there, and a small file of our oracle's, always.

use estampe::Device;
use estampe_reference::Target;
use estampe_tests::fast_path::{self, some_devices};
use estampe_tests::fragment_ops::{FragmentOp, Stored};
use estampe_tests::{Random, oracle};
use estampe_types::TextureFormat;
use std::path::{Path, PathBuf};

/// How many of them the oracle's own file has.
const OWN: u64 = 200;

fn lines(path: &Path) -> Option<Vec<FragmentOp>> {
    let text = std::fs::read_to_string(path).ok()?;
    let parsed = text.lines().enumerate().map(|(number, line)| {
        let place = format!("{}:{}", path.display(), number + 1);
        FragmentOp::parse(line).unwrap_or_else(|| panic!("{place}: not a case: {line}"))
    });
    Some(parsed.collect())
}

fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn own_file() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data/fragment-ops.jsonl")
}

/// The 2,000 cases of others; `None` with a message where they are missing.
fn cases_of_others() -> Option<Vec<FragmentOp>> {
    let path = workspace().join("../shared/data/fragment-ops-2000.jsonl");
    let cases = lines(&path);
    if cases.is_none() {
        eprintln!("skipped: there is no {}", path.display());
    }
    cases
}

/// The oracle's result.
fn oracle_of(case: &FragmentOp) -> Stored {
    let target: Target = oracle::target(&case.case());
    let format = TextureFormat::Rgba8Unorm;
    let bytes = estampe_reference::color::bytes(format, target.color[0]);
    Stored {
        color: bytes.try_into().expect("four bytes"),
        depth: target.depth[0],
        stencil: target.stencil[0],
    }
}

fn check(cases: &[FragmentOp], result: impl Fn(&FragmentOp) -> Stored) {
    let is_wrong = |case: &&FragmentOp| !case.accepts(result(case));
    let wrong: Vec<_> = cases.iter().filter(is_wrong).collect();
    if let Some(first) = wrong.first() {
        panic!(
            "{} of {} are wrong, first {}\nwhich gives {:?}",
            wrong.len(),
            cases.len(),
            first.line(),
            result(first)
        );
    }
}

/// Rows: O3, O4, O5, O7.
#[test]
fn the_oracle_agrees_with_the_reference_processor_of_others() {
    if let Some(cases) = cases_of_others() {
        assert_eq!(cases.len(), 2000);
        check(&cases, oracle_of);
    }
}

/// The fast path's result on one device.
fn fast_path_of(device: &Device, case: &FragmentOp) -> Stored {
    let image = fast_path::draw(device, &case.case(), &None);
    Stored {
        color: image.color.try_into().expect("four bytes"),
        depth: f32::from_bits(image.depth[0]),
        stencil: image.stored.stencils[0][0],
    }
}

/// Rows: O3, O4, O5, O7, U3.
#[test]
fn every_level_agrees_with_the_reference_processor_of_others() {
    let Some(cases) = cases_of_others() else {
        return;
    };
    for device in some_devices(0) {
        check(&cases, |case| fast_path_of(device, case));
    }
}

/// Rows: O3, O4, O5, O7, U3.
#[test]
fn every_level_agrees_with_the_oracles_own_cases() {
    let cases = lines(&own_file()).expect("data/fragment-ops.jsonl is part of the project");
    for device in some_devices(1) {
        for case in &cases {
            assert_eq!(fast_path_of(device, case), case.result, "{}", case.line());
        }
    }
}

/// Rows: O3, O4, O5, O7.
#[test]
fn the_oracles_own_cases_are_what_it_computes() {
    let computed: Vec<_> = (0..OWN)
        .map(|seed| {
            let mut case = FragmentOp::random(&mut Random::new("fragment-ops", seed));
            case.result = oracle_of(&case);
            case
        })
        .collect();
    if std::env::var_os("ESTAMPE_WRITE_DATA").is_some() {
        let text: String = computed.iter().map(|case| case.line() + "\n").collect();
        std::fs::create_dir_all(own_file().parent().expect("it has a folder")).expect("a folder");
        std::fs::write(own_file(), text).expect("a file that can be written");
    }
    let stored = lines(&own_file()).expect("data/fragment-ops.jsonl is part of the project");
    assert_eq!(stored.len(), computed.len());
    for (stored, computed) in stored.iter().zip(&computed) {
        assert_eq!(stored.line(), computed.line());
        assert_eq!(oracle_of(stored), stored.result);
    }
}
