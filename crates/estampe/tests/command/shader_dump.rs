//! `estampe shader dump` end to end.

use crate::support::Folder;
use crate::support::shell::run;

const WGSL: &str = "\
override gain: f32;
@group(0) @binding(0) var<storage, read_write> sums: array<f32>;
@compute @workgroup_size(16) fn add(@builtin(global_invocation_id) id: vec3u) { sums[id.x] += gain * 3.0; }
@fragment fn red() -> @location(0) vec4f { return vec4f(1.0, 0.0, 0.0, 1.0); }
";

/// The form of the IR is one that its own parser reads back.
/// Rows: G2.
#[test]
fn each_stage_of_the_compiler_is_written() {
    let folder = Folder::new();
    folder.with_file("a.wgsl", WGSL);
    let dump = |stage: &str| {
        let line = format!("estampe shader dump a.wgsl --entry add -D gain=0.5 --stage {stage}");
        let done = run(&line, &folder);
        assert_eq!((done.code, &*done.err), (0, ""), "{stage}");
        String::from_utf8(done.out).expect("text")
    };
    let ir = dump("ir");
    assert!(ir.starts_with("kernel compute\n"), "{ir}");
    let kernel = estampe_ir::text::kernel(&ir).expect("the text is that of a kernel");
    assert_eq!(kernel.to_string(), ir);
    let tree = estampe_ir::text::tree(&dump("tree")).expect("the text is that of a tree");
    assert_eq!(estampe_ir::lanes::Kernel::from_tree(&tree).to_string(), ir);
    let bytecode = dump("bytecode");
    assert!(
        bytecode.contains("StoreBuffer(0") && bytecode.contains("(1.5)"),
        "{bytecode}"
    );
    for isa in estampe_x86::Isa::ALL
        .into_iter()
        .filter(|isa| isa.is_available())
    {
        let asm = dump(&format!("asm --via {}", isa.name()));
        assert!(
            asm.contains("  000000  53 ") && asm.contains(" ret\n"),
            "{asm}"
        );
        assert!(dump(&format!("asm --optimised --via {}", isa.name())).contains(" ret\n"));
    }
}

#[test]
fn mistakes_say_what_to_do() {
    let folder = Folder::new();
    folder.with_file("a.wgsl", WGSL);
    folder.with_file("b.wgsl", "@fragment fn f() { oops }");
    folder.with_file("c.wgsl", "const x = 3;");
    for (words, code, said) in [
        ("a.wgsl", 2, "--stage"),
        ("a.wgsl --stage ptx", 2, "--stage"),
        ("a.wgsl --stage ir", 2, "`add`, fragment `red`"),
        ("a.wgsl --stage ir --entry nix", 2, "`add`, fragment `red`"),
        (
            "a.wgsl --stage ir --entry red --optimised",
            2,
            "--stage asm",
        ),
        (
            "a.wgsl --stage asm --entry red --via interpreter",
            2,
            "avx2",
        ),
        ("a.wgsl --stage ir --entry add", 1, "`gain`"),
        ("b.wgsl --stage ir", 1, "b.wgsl:1:"),
        ("c.wgsl --stage ir", 1, "no entry point"),
    ] {
        let done = run(&format!("estampe shader dump {words}"), &folder);
        assert_eq!(done.code, code, "{words}: {}", done.err);
        assert!(done.err.contains(said), "{words}: {}", done.err);
        assert!(done.out.is_empty(), "{words}");
    }
}
