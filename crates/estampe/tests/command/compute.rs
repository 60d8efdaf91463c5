//! `estampe compute` end to end: buffers from and to files, mistakes.

use crate::support::Folder;
use crate::support::shell::run;

const SQUARES: &str = "\
override factor: u32 = 1u;
@group(0) @binding(0) var<storage, read_write> squares: array<u32>;
@group(0) @binding(2) var<uniform> offset: u32;
@compute @workgroup_size(64) fn square(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&squares) { squares[id.x] += id.x * id.x * factor + offset; }
}
@compute @workgroup_size(8) fn fill(@builtin(local_invocation_index) i: u32) { squares[i] = i; }
";

const SUM: &str = "\
#version 430
layout(local_size_x = 32) in;
layout(std430, binding = 0) buffer Numbers { uint numbers[]; };
layout(std430, binding = 1) buffer Sums { uint sums[]; };
shared uint part[32];
void main() {
    uint i = gl_LocalInvocationID.x;
    part[i] = numbers[gl_GlobalInvocationID.x];
    barrier();
    for (uint step = 16u; step > 0u; step /= 2u) {
        if (i < step) part[i] += part[i + step];
        barrier();
    }
    if (i == 0u) sums[gl_WorkGroupID.x] = part[0];
}
";

fn words(bytes: &[u8]) -> Vec<u32> {
    let (words, _) = bytes.as_chunks::<4>();
    words.iter().map(|word| u32::from_le_bytes(*word)).collect()
}

/// Rows: G2, G5.
#[test]
fn buffers_go_from_file_to_file() {
    let folder = Folder::new();
    folder.with_file("s.wgsl", SQUARES);
    folder.with_file(
        "ones.bin",
        [1_u32; 100].map(u32::to_le_bytes).as_flattened(),
    );
    let line = "estampe compute s.wgsl --entry square --groups 2 --buffer 0,0=ones.bin \
                -D factor=3 --set offset=10 --write 0,0=out.bin";
    let expected: Vec<u32> = (0..100).map(|i| 1 + i * i * 3 + 10).collect();
    for machine in ["", "--threads 1", "--threads 2", "--via interpreter"] {
        let done = run(&format!("{line} {machine}"), &folder);
        assert_eq!(done.code, 0, "{}", done.err);
        assert!(
            done.err
                .starts_with("out.bin: 400 bytes, 2x1x1 work-groups"),
            "{}",
            done.err
        );
        let bytes = std::fs::read(folder.path("out.bin")).expect("written");
        assert_eq!(words(&bytes), expected, "{machine}");
    }
    let line =
        "estampe compute s.wgsl --entry fill --groups 1 --buffer 0,0=zeros:32 -q --write 0,0=-";
    let done = run(line, &folder);
    assert_eq!((done.code, &*done.err), (0, ""));
    assert_eq!(words(&done.out), [0, 1, 2, 3, 4, 5, 6, 7]);
}

/// Rows: G1, G5.
#[test]
fn glsl_shares_memory_and_waits() {
    let folder = Folder::new();
    folder.with_file("sum.comp", SUM);
    let numbers: Vec<u8> = (0..96_u32).flat_map(u32::to_le_bytes).collect();
    folder.with_file("numbers.bin", numbers);
    let line = "estampe compute sum.comp --groups 3 --buffer 0,0=numbers.bin \
                --buffer 0,1=zeros:12 --write 0,1=- -q";
    let done = run(line, &folder);
    assert_eq!(done.code, 0, "{}", done.err);
    assert_eq!(words(&done.out), [496, 1520, 2544]);
}

#[test]
fn mistakes_say_what_to_do() {
    let folder = Folder::new();
    folder.with_file("s.wgsl", SQUARES);
    folder.with_file("f.wgsl", "@fragment fn f() {}");
    folder.with_file(
        "endless.wgsl",
        "@group(0) @binding(0) var<storage, read_write> n: atomic<u32>;\n\
         @compute @workgroup_size(1) fn f() { loop { atomicAdd(&n, 1u); } }\n",
    );
    let square = "s.wgsl --entry square";
    for (words, code, said) in [
        ("s.wgsl --groups 1", 2, "--entry"),
        ("s.wgsl --groups 1 --entry nix", 2, "`square`, `fill`"),
        ("f.wgsl --groups 1", 1, "no compute shader"),
        ("s.wgsl --entry square", 2, "--groups"),
        ("s.wgsl --groups 1,2,3,4", 2, "16,16,1"),
        (
            &*format!("{square} --groups 1"),
            2,
            "--buffer 0,0=zeros:BYTES",
        ),
        (
            &*format!("{square} --groups 70000 --buffer 0,0=zeros:4"),
            2,
            "65535",
        ),
        (
            &*format!("{square} --groups 1 --buffer 0,0=zeros:0"),
            2,
            "at least 4",
        ),
        (
            &*format!("{square} --groups 1 --buffer 0,7=zeros:4"),
            2,
            "`squares`",
        ),
        (
            &*format!("{square} --groups 1 --buffer 0,0=zeros:4 --write 0,7=o.bin"),
            2,
            "0,0",
        ),
        (
            &*format!("{square} --groups 1 --buffer 0,0=zeros:4 --write 0,0=no/o.bin"),
            3,
            "folder",
        ),
        (
            &*format!("{square} --groups 1 --buffer 0,0=zeros:4 -D nix=3"),
            2,
            "`factor`",
        ),
        ("endless.wgsl --groups 1 --buffer 0,0=zeros:4", 1, "loop"),
        ("missing.comp --groups 1", 1, "no such file"),
    ] {
        let done = run(&format!("estampe compute {words}"), &folder);
        assert_eq!(done.code, code, "{words}: {}", done.err);
        assert!(done.err.contains(said), "{words}: {}", done.err);
        assert!(
            done.out.is_empty() && !folder.path("o.bin").exists(),
            "{words}"
        );
    }
}

/// Rows: G1, G5.
#[test]
fn immediates_are_a_file_or_digits() {
    let folder = Folder::new();
    folder.with_file(
        "scale.comp",
        "#version 450\nlayout(local_size_x = 4) in;\n\
         layout(push_constant) uniform P { uint first; uint list[4]; } p;\n\
         layout(std430, set = 0, binding = 0) buffer Out { uint words[]; };\n\
         void main() { uint i = gl_LocalInvocationID.x; words[i] = p.first + p.list[i]; }\n",
    );
    let numbers: Vec<u8> = [100_u32, 1, 2, 3, 4]
        .iter()
        .flat_map(|n| n.to_le_bytes())
        .collect();
    folder.with_file("p.bin", &numbers);
    folder.with_file("short.bin", &numbers[..16]);
    let line = "estampe compute scale.comp --groups 1 -q --buffer 0,0=zeros:16 --write 0,0=-";
    let digits: String = numbers.iter().map(|byte| format!("{byte:02x}")).collect();
    for given in ["p.bin".to_owned(), format!("hex:{digits}")] {
        for machine in ["", "--via interpreter"] {
            let done = run(&format!("{line} --immediates {given} {machine}"), &folder);
            assert_eq!((done.code, &*done.err), (0, ""));
            assert_eq!(words(&done.out), [101, 102, 103, 104], "{given} {machine}");
        }
    }
    for (given, expected) in [
        (
            "",
            "the shader reads 20 bytes of immediates (push constants): give them by --immediates FILE",
        ),
        (
            "--immediates short.bin",
            "--immediates: 16 bytes, but the shader reads 20; give more",
        ),
        (
            "--immediates hex:0",
            "write FILE or hex: and two digits for each byte",
        ),
    ] {
        let done = run(&format!("{line} {given}"), &folder);
        assert_eq!(done.code, 2, "{given}: {}", done.err);
        assert!(done.err.contains(expected), "{}", done.err);
    }
    let long = format!("--immediates hex:{}", "00".repeat(132));
    let done = run(&format!("{line} {long}"), &folder);
    assert!(
        done.err.contains("132 bytes, but 128 are possible"),
        "{}",
        done.err
    );
}
