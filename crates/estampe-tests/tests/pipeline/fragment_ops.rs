//! Blending, write mask, depth and stencil of one sample, against the results of the reference
//! fragment processor of KhronosGroup/VK-GL-CTS: 200 cases always, all 2,000 if the file exists
//! (`cargo test -- --ignored`).

use estampe::Device;
use estampe_reference::Target;
use estampe_tests::fast_path::{self, some_devices};
use estampe_tests::fragment_ops::{EQUATIONS, FACTORS, FUNCTIONS, FragmentOp, OPERATIONS, Stored};
use estampe_tests::{Random, oracle};
use estampe_types::TextureFormat;
use std::path::{Path, PathBuf};

/// The number of cases in the oracle's own file.
const OWN: u64 = 200;

fn lines(path: &Path) -> Vec<FragmentOp> {
    let text = std::fs::read_to_string(path);
    let text = text.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let parsed = text.lines().enumerate().map(|(number, line)| {
        let place = format!("{}:{}", path.display(), number + 1);
        FragmentOp::parse(line).unwrap_or_else(|| panic!("{place}: not a case: {line}"))
    });
    parsed.collect()
}

/// The path of a file in this crate's data.
fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("data")
        .join(name)
}

/// The sample of VK-GL-CTS's cases that is part of the repository.
fn sample() -> Vec<FragmentOp> {
    lines(&data("cts-fragment-ops-sample.jsonl"))
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
fn the_oracle_agrees_with_vk_gl_cts() {
    check(&sample(), oracle_of);
}

/// The fast path's result on one device.
fn fast_path_of(device: &Device, case: &FragmentOp) -> Stored {
    let image = fast_path::draw(device, &case.case()).image;
    Stored {
        color: image.color.try_into().expect("four bytes"),
        depth: f32::from_bits(image.depth[0]),
        stencil: image.stored.stencils[0][0],
    }
}

/// Rows: O3, O4, O5, O7, U3.
#[test]
fn every_simd_level_agrees_with_vk_gl_cts() {
    for device in some_devices(0) {
        check(&sample(), |case| fast_path_of(device, case));
    }
}

#[test]
fn the_sample_has_every_value() {
    use estampe_types::state::{BlendComponent, DepthState, StencilFaceState};
    let cases = sample();
    let lacks = |name: &str, count: usize, is_value: &dyn Fn(&FragmentOp, usize) -> bool| {
        for number in 0..count {
            let found = cases.iter().any(|case| is_value(case, number));
            assert!(found, "no case has number {number} of the {name}");
        }
    };
    type Side = fn(&FragmentOp) -> Option<BlendComponent>;
    let sides: [Side; 2] = [
        |case| Some(case.blend?.color),
        |case| Some(case.blend?.alpha),
    ];
    for side in sides {
        let has =
            |case: &FragmentOp, is: &dyn Fn(BlendComponent) -> bool| side(case).is_some_and(is);
        lacks("equations", EQUATIONS.len(), &|case, k| {
            has(case, &|blend| blend.operation == EQUATIONS[k])
        });
        lacks("source factors", FACTORS.len(), &|case, k| {
            has(case, &|blend| blend.src_factor == FACTORS[k])
        });
        lacks("destination factors", FACTORS.len(), &|case, k| {
            has(case, &|blend| blend.dst_factor == FACTORS[k])
        });
    }
    lacks("depth functions", FUNCTIONS.len(), &|case, k| {
        let is = |depth: DepthState| depth.compare == FUNCTIONS[k];
        case.depth.is_some_and(is)
    });
    let has =
        |case: &FragmentOp, is: &dyn Fn(StencilFaceState) -> bool| case.stencil.is_some_and(is);
    lacks("stencil functions", FUNCTIONS.len(), &|case, k| {
        has(case, &|face| face.compare == FUNCTIONS[k])
    });
    lacks(
        "operations on stencil fail",
        OPERATIONS.len(),
        &|case, k| has(case, &|face| face.fail_op == OPERATIONS[k]),
    );
    lacks("operations on depth fail", OPERATIONS.len(), &|case, k| {
        has(case, &|face| face.depth_fail_op == OPERATIONS[k])
    });
    lacks("operations on pass", OPERATIONS.len(), &|case, k| {
        has(case, &|face| face.pass_op == OPERATIONS[k])
    });
    lacks("bits of the colour mask", 4, &|case, k| {
        case.write_mask.0 >> k & 1 == 0 && case.write_mask.0 != 0
    });
}

/// Detects changes and proves nothing: the oracle itself computed the expected results. If it
/// fails, the oracle's arithmetic has changed; if that was intended, `ESTAMPE_WRITE_DATA` writes
/// the file again.
#[test]
fn the_oracle_reproduces_its_recorded_results() {
    let path = data("oracle-fragment-ops.jsonl");
    let computed: Vec<_> = (0..OWN)
        .map(|seed| {
            let mut case = FragmentOp::random(&mut Random::new("fragment-ops", seed));
            case.result = oracle_of(&case);
            case
        })
        .collect();
    if std::env::var_os("ESTAMPE_WRITE_DATA").is_some() {
        let text: String = computed.iter().map(|case| case.line() + "\n").collect();
        std::fs::write(&path, text).expect("a file that can be written");
    }
    let stored = lines(&path);
    assert_eq!(stored.len(), computed.len());
    for (stored, computed) in stored.iter().zip(&computed) {
        assert_eq!(stored.line(), computed.line());
        assert_eq!(oracle_of(stored), stored.result);
    }
}

/// Tests of data that is not part of the project: `cargo test -- --ignored shared_data::`.
mod shared_data {
    use super::*;

    /// All of VK-GL-CTS's cases.
    #[test]
    #[ignore = "needs ../shared/data/fragment-ops-2000.jsonl"]
    fn all_cases_of_vk_gl_cts_agree() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
        let cases = lines(&root.join("shared/data/fragment-ops-2000.jsonl"));
        assert_eq!(cases.len(), 2000);
        check(&cases, oracle_of);
        for device in some_devices(0) {
            check(&cases, |case| fast_path_of(device, case));
        }
    }
}
