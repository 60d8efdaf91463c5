//! The results of operators, conversions and functions against those that WGSL accepts: the cases
//! of WebGPU's conformance tests.
//!
//! A list of cases with the same types becomes a compute shader, one invocation a case.

mod accepted;
mod types;

use accepted::is_accepted;
use estampe_shader::lower::lower;
use estampe_shader::program::TextCompute;
use estampe_simd::Level;
use estampe_types::bindings::{BoundGroup, BoundResource, BoundResources};
use estampe_types::shader::{ComputeProgram, Workgroups};
use estampe_types::{Bindings, BufferData, StorageBuffer};
use flate2::read::GzDecoder;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use serde_json::Value;
use std::collections::BTreeMap;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::sync::Arc;
use types::{Scalar, Type};

/// Words of the largest result.
const RESULT_WORDS: usize = 16;

/// What a file and list compute, of `a`, `b` and `c`; `None` if it is evaluated by naga alone, or
/// of numbers that are not supported.
fn expression(file: &str, list: &str, inputs: &[Type]) -> Option<String> {
    if inputs.iter().any(|ty| ty.scalar == Scalar::Other) {
        return None;
    }
    let operator = |name: &str| {
        Some(match name {
            "addition" => "+",
            "subtraction" => "-",
            "multiplication" => "*",
            "division" => "/",
            "remainder" => "%",
            "equals" => "==",
            "not_equals" => "!=",
            "less_than" => "<",
            "less_equals" => "<=",
            "greater_than" => ">",
            "greater_equals" => ">=",
            _ => return None,
        })
    };
    if let Some(function) = file.strip_prefix("call__builtin__") {
        let function = if function == "inversesqrt" {
            "inverseSqrt"
        } else {
            function
        };
        let arguments = ["a", "b", "c"][..inputs.len()].join(", ");
        return Some(format!("{function}({arguments})"));
    }
    if let Some(of) = file.strip_prefix("binary__") {
        // The operator is the last word of the file's name, or begins that of the list.
        let last = of.rsplit('_').next().and_then(operator);
        let list = list.trim_end_matches("_non_const");
        let of_list = [
            "not_equals",
            "less_than",
            "less_equals",
            "greater_than",
            "greater_equals",
        ];
        let first = of_list
            .iter()
            .find(|name| list.starts_with(**name))
            .copied();
        let first = first.or(list.split('_').next()).and_then(operator);
        return Some(format!("a {} b", last.or(first)?));
    }
    let of = file.strip_prefix("unary__")?;
    if of.ends_with("_arithmetic") {
        return (list == "negation").then(|| "-a".to_owned());
    }
    let to = of.strip_suffix("_conversion")?;
    Some(match inputs[0].columns {
        1 => format!("{to}(a)"),
        _ => format!("{}(a)", inputs[0].name()),
    })
}

fn run(source: &str, count: usize, data: Vec<u32>) -> Vec<u32> {
    let module = naga::front::wgsl::parse_str(source)
        .unwrap_or_else(|error| panic!("{}", error.emit_to_string(source)));
    let capabilities = Capabilities::default() | Capabilities::SHADER_FLOAT16;
    let mut validator = Validator::new(ValidationFlags::all(), capabilities);
    let info = validator.validate(&module).expect("a valid module");
    let stage = lower(&module, &info, 0).unwrap_or_else(|error| panic!("{error}: {source}"));
    let program = TextCompute::new(&stage, 1 << 20).expect("it is small");
    let results = BufferData::zeros(count * RESULT_WORDS * 4).expect("it is small");
    let results = StorageBuffer::try_from_data(results).expect("it is small");
    let entries = vec![
        (
            0,
            BoundResource::Buffer {
                buffer: BufferData::from_words(data),
                offset: 0,
                size: u32::MAX,
                dynamic_offset: None,
            },
        ),
        (
            1,
            BoundResource::StorageBuffer {
                buffer: results.clone(),
                offset: 0,
                size: u32::MAX,
                dynamic_offset: None,
            },
        ),
    ];
    let bindings = Bindings {
        groups: vec![BoundGroup {
            group: Arc::new(BoundResources { entries }),
            ..BoundGroup::default()
        }],
        ..Bindings::default()
    };
    let groups = count.div_ceil(64);
    let work = Workgroups {
        count: [u32::try_from(groups).expect("few cases"), 1, 1],
        range: 0..groups as u64,
    };
    program
        .run_workgroups(Level::best(), &bindings, &work)
        .expect("there are no loops");
    drop(bindings);
    results.into_data().words().to_vec()
}

/// The cases of a list: their inputs, and what is accepted.
type Cases = Vec<(Vec<Value>, Value)>;

/// Runs the cases of a list; the number that were run, and the first one that is not accepted.
fn check(file: &str, list: &str, names: &[String], cases: &Cases) -> (usize, Option<String>) {
    let inputs: Vec<Type> = names.iter().map(|name| Type::named(name)).collect();
    let Some(expression) = expression(file, list, &inputs) else {
        return (0, None);
    };
    let width: usize = inputs.iter().map(Type::words).sum();
    let mut first = 0;
    let mut values = String::new();
    for (name, ty) in ["a", "b", "c"].iter().zip(&inputs) {
        values += &format!("let {name} = {};\n", ty.loaded(first));
        first += ty.words();
    }
    let stored = types::stored(&cases[0].1);
    let source = format!(
        "enable f16;\n\
         @group(0) @binding(0) var<storage, read> data: array<u32>;\n\
         @group(0) @binding(1) var<storage, read_write> results: array<u32>;\n\
         @compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) {{\n\
         let first = id.x * {width}u; let to = id.x * {RESULT_WORDS}u;\n\
         if first >= arrayLength(&data) {{ return; }}\n\
         {values}let r = {expression};\n{stored}}}"
    );
    let data = cases.iter().flat_map(|(values, _)| {
        values
            .iter()
            .zip(&inputs)
            .flat_map(|(value, ty)| types::words(value, ty.scalar))
    });
    let results = run(&source, cases.len(), data.collect());
    let results = results.chunks(RESULT_WORDS);
    let wrong = cases
        .iter()
        .zip(results)
        .find_map(|((inputs, accepted), words)| {
            let is_right = is_accepted(accepted, words);
            let message = || format!("{file} {list}: {inputs:?} gave {words:08x?}, not {accepted}");
            (!is_right).then(message)
        });
    (cases.len(), wrong)
}

/// Tests of data that is not part of the project: `cargo test -- --ignored shared_data::`.
mod shared_data {
    use super::*;

    #[test]
    #[ignore = "needs ../shared/data/wgsl-cases"]
    fn results_are_those_that_wgsl_accepts() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/wgsl-cases");
        let (mut run, mut wrong) = (0, Vec::new());
        for entry in std::fs::read_dir(root).expect("the folder of cases") {
            let path = entry.expect("an entry").path();
            let file = path
                .file_name()
                .expect("a file")
                .to_string_lossy()
                .into_owned();
            let Some(file) = file.strip_suffix(".jsonl.gz") else {
                continue;
            };
            let lines = BufReader::new(GzDecoder::new(
                std::fs::File::open(&path).expect("it opens"),
            ));
            let mut lists: BTreeMap<(String, Vec<String>), Cases> = BTreeMap::new();
            for line in lines.lines() {
                let case: Value = serde_json::from_str(&line.expect("text")).expect("JSON");
                let inputs = case["i"].as_array().expect("inputs");
                let text = |value: &Value| value.as_str().expect("text").to_owned();
                let types = inputs.iter().map(|input| text(&input["t"])).collect();
                let values = inputs.iter().map(|input| input["v"].clone()).collect();
                let list = lists.entry((text(&case["l"]), types)).or_default();
                list.push((values, case["e"].clone()));
            }
            for ((list, types), cases) in &lists {
                let (count, first) = check(file, list, types, cases);
                run += count;
                wrong.extend(first);
            }
        }
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
        assert!(run > 50_000, "{run}");
    }
}
