//! Which dispatches may run in any order, and that those that may give the same in every order.

use estampe_shader::lower::lower;
use estampe_shader::program::TextCompute;
use estampe_simd::Level;
use estampe_types::bindings::{BoundGroup, BoundResource, BoundResources};
use estampe_types::shader::{ComputeProgram, WorkgroupOrder, Workgroups};
use estampe_types::{Bindings, BufferData, StorageBuffer};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::fmt::Write;
use std::sync::Arc;

const WORDS: usize = 700;

fn compiled(source: &str) -> TextCompute {
    let module = naga::front::wgsl::parse_str(source)
        .unwrap_or_else(|error| panic!("{}", error.emit_to_string(source)));
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::IMMEDIATES);
    let info = validator.validate(&module).expect("a valid module");
    let stage = lower(&module, &info, 0).expect("a shader that is supported");
    TextCompute::new(&stage, 1 << 20).expect("it is small")
}

/// A shader with a uniform `width`, buffers `out`, `data` and `sums`, and indices by short names.
fn shader(body: &str) -> String {
    format!(
        "@group(0) @binding(0) var<uniform> width: u32;\n\
         struct Pushed {{ other: u32, width: u32, list: array<u32, 2> }}\n\
         var<immediate> pushed: Pushed;\n\
         @group(0) @binding(1) var<storage, read_write> out: array<u32>;\n\
         @group(0) @binding(2) var<storage, read> data: array<u32>;\n\
         @group(0) @binding(3) var<storage, read_write> sums: array<atomic<u32>>;\n\
         @compute @workgroup_size(4, 2)\n\
         fn main(@builtin(global_invocation_id) id: vec3u, @builtin(workgroup_id) group: vec3u,\n\
         @builtin(local_invocation_id) local: vec3u, @builtin(local_invocation_index) i: u32,\n\
         @builtin(num_workgroups) groups: vec3u) {{\n{body}\n}}"
    )
}

/// The order of a dispatch, and the words of `out` and `sums` after all work-groups ran forwards,
/// and backwards.
fn run(program: &TextCompute, width: u32, count: [u32; 3]) -> (WorkgroupOrder, [Vec<u32>; 2]) {
    let mut order = None;
    let words = [false, true].map(|is_backwards| {
        let stored = |first: u32| {
            let words: Vec<u32> = (0..WORDS).map(|_| first).collect();
            StorageBuffer::try_from_data(BufferData::from_words(words)).expect("it is small")
        };
        let (out, sums) = (stored(7), stored(0));
        let data: Vec<u32> = (0..97).map(|n| n * 37 % 101).collect();
        let read = |words: &[u32]| BoundResource::Buffer {
            buffer: BufferData::from_words(words.to_vec()),
            offset: 0,
            size: u32::MAX,
            dynamic_offset: None,
        };
        let written = |buffer: &StorageBuffer| BoundResource::StorageBuffer {
            buffer: buffer.clone(),
            offset: 0,
            size: u32::MAX,
            dynamic_offset: None,
        };
        let entries = vec![
            (0, read(&[width])),
            (1, written(&out)),
            (2, read(&data)),
            (3, written(&sums)),
        ];
        let group = Arc::new(BoundResources { entries });
        let bindings = Bindings {
            groups: vec![BoundGroup {
                group,
                ..BoundGroup::default()
            }],
            immediates: vec![7, width],
            ..Bindings::default()
        };
        order = Some(program.order(&bindings, count));
        let total = count.iter().map(|side| u64::from(*side)).product::<u64>();
        let run = |at: u64| {
            let range = at..at + 1;
            let work = Workgroups { count, range };
            program
                .run_workgroups(Level::best(), &bindings, &work)
                .expect("it ends");
        };
        if is_backwards {
            (0..total).rev().for_each(run);
        } else {
            (0..total).for_each(run);
        }
        drop(bindings);
        [out, sums]
            .map(|buffer| buffer.into_data().words().to_vec())
            .concat()
    });
    (order.expect("two runs"), words)
}

#[test]
#[expect(clippy::too_many_lines, reason = "one list of shaders")]
fn the_order_is_free_where_no_two_work_groups_meet() {
    use WorkgroupOrder::{Free, InOrder};
    let wide = [5, 3, 1];
    for (body, width, count, expected) in [
        ("out[id.x] = id.x;", 0, [9, 1, 1], Free),
        // Rows of work-groups write the same words.
        ("out[id.x] = id.y;", 0, wide, InOrder),
        ("out[id.y * width + id.x] = id.x;", 20, wide, Free),
        // Wider than the picture: the last column of one row is the first of the next.
        ("out[id.y * width + id.x] = id.x;", 18, wide, InOrder),
        ("out[id.y * pushed.width + id.x] = id.x;", 20, wide, Free),
        ("out[id.y * pushed.width + id.x] = id.x;", 18, wide, InOrder),
        (
            "if id.x < pushed.width { out[id.y * pushed.width + id.x] = 1u; }",
            18,
            wide,
            Free,
        ),
        // A number that is not seen to be one in the whole dispatch.
        (
            "out[id.y * pushed.list[width % 2u] + id.x] = id.x;",
            20,
            wide,
            InOrder,
        ),
        (
            "if id.x >= width { return; } out[id.y * width + id.x] = 1u;",
            18,
            wide,
            Free,
        ),
        (
            "if id.x >= width || id.y >= 5u { return; } out[id.y * width + id.x] = i;",
            18,
            wide,
            Free,
        ),
        (
            "if id.x < width && id.y < 5u { out[id.x + width * id.y] = i; }",
            18,
            wide,
            Free,
        ),
        (
            "if id.y < width { out[id.x * width + id.y] = i; }",
            5,
            wide,
            Free,
        ),
        (
            "if id.x >= 18u { return; } out[id.y * width + id.x] = 1u;",
            17,
            wide,
            InOrder,
        ),
        // Several words for each invocation, and words that it reads.
        (
            "out[id.x * 3u] = i; out[id.x * 3u + 2u] = out[id.x * 3u + 1u];",
            0,
            [9, 1, 1],
            Free,
        ),
        (
            "out[id.x * 2u] = i; out[id.x * 2u + 2u] = i;",
            0,
            [9, 1, 1],
            InOrder,
        ),
        ("out[id.x] = out[id.x + 1u] + id.x;", 0, [9, 1, 1], InOrder),
        ("out[id.x + 1u] = data[id.x];", 0, [9, 1, 1], Free),
        ("out[data[id.x]] = id.x;", 0, [9, 1, 1], InOrder),
        // Loops inside of a work-group.
        (
            "for (var k = i; k < 50u; k += 8u) { out[group.x * 50u + k] = k; }",
            0,
            [9, 1, 1],
            Free,
        ),
        (
            "for (var k = i; k < 50u; k += 8u) { out[group.x * 49u + k] = group.x; }",
            0,
            [9, 1, 1],
            InOrder,
        ),
        ("out[i] = group.x;", 0, [2, 1, 1], InOrder),
        ("out[i] = group.x;", 0, [1, 1, 1], Free),
        // Sums of which nobody sees the terms.
        (
            "atomicAdd(&sums[data[id.x] % 7u], id.x);",
            0,
            [9, 2, 1],
            Free,
        ),
        ("atomicMax(&sums[0], id.x);", 0, [9, 2, 1], Free),
        (
            "atomicAdd(&sums[0], id.x); atomicMax(&sums[0], id.y);",
            0,
            [9, 2, 1],
            InOrder,
        ),
        (
            "out[id.x] = atomicAdd(&sums[0], 1u);",
            0,
            [9, 1, 1],
            InOrder,
        ),
        ("atomicStore(&sums[0], id.x);", 0, [9, 1, 1], InOrder),
        (
            "atomicStore(&sums[id.x], atomicLoad(&sums[id.x]) + 1u);",
            0,
            [9, 1, 1],
            Free,
        ),
        // Sums that wrap around meet.
        ("out[id.x * 0x10000000u] = id.x;", 0, [9, 1, 1], InOrder),
        (
            "out[(groups.x - 1u - group.x) * 8u + i] = id.x;",
            0,
            [9, 1, 1],
            Free,
        ),
        ("out[100u - id.x] = id.x;", 0, [9, 1, 1], Free),
        ("out[id.x / 2u] = id.x;", 0, [9, 1, 1], InOrder),
        (
            "out[group.x * arrayLength(&data) + i] = id.x;",
            0,
            [5, 1, 1],
            Free,
        ),
    ] {
        let program = compiled(&shader(body));
        let (order, [forwards, backwards]) = run(&program, width, count);
        assert_eq!(order, expected, "{body}");
        assert!(order == InOrder || forwards == backwards, "{body}");
        assert!(
            forwards.iter().any(|word| *word != 7),
            "{body}: something is stored"
        );
    }
}

/// An index of small numbers, variables and operators.
fn index(random: &mut fastrand::Rng, depth: u32, text: &mut String) {
    let leaves = [
        "id.x", "id.y", "group.x", "group.y", "local.x", "local.y", "i", "width", "groups.x", "1u",
        "2u", "3u", "4u", "8u", "20u", "64u",
    ];
    if depth == 0 || random.u32(0..5) == 0 {
        text.push_str(leaves[random.usize(0..leaves.len())]);
        return;
    }
    let operators = ["+", "+", "+", "*", "*", "-", "%", "&", "<<", ">>", "/"];
    let operator = operators[random.usize(0..operators.len())];
    text.push('(');
    index(random, depth - 1, text);
    if ["%", "&", "/", "<<", ">>"].contains(&operator) {
        let number = [1, 2, 3, 4, 7, 16][random.usize(0..6)];
        write!(text, " {operator} {number}u").expect("text grows");
    } else {
        write!(text, " {operator} ").expect("text grows");
        index(random, depth - 1, text);
    }
    text.push(')');
}

#[test]
fn random_dispatches_that_are_free_give_the_same_backwards() {
    let (mut free, mut in_order, mut different) = (0, 0, 0);
    for seed in 0..1500 {
        let mut random = fastrand::Rng::with_seed(seed);
        let mut body = String::new();
        for _ in 0..random.u32(0..3) {
            let axis = ["id.x", "id.y", "i"][random.usize(0..3)];
            let limit = ["width", "6u", "17u"][random.usize(0..3)];
            let guard = match random.u32(0..3) {
                0 => format!("if {axis} >= {limit} {{ return; }}\n"),
                1 => format!("if {axis} > {limit} || id.y > 4u {{ return; }}\n"),
                _ => format!("if !({axis} < {limit} && id.x < 19u) {{ return; }}\n"),
            };
            body.push_str(&guard);
        }
        let is_looped = random.bool();
        if is_looped {
            body.push_str("for (var k = i; k < 16u; k += 5u) {\n");
        }
        let mut place = String::new();
        index(&mut random, 3, &mut place);
        if is_looped {
            place = format!("{place} * 16u + k");
        }
        match random.u32(0..3) {
            0 => writeln!(body, "out[({place}) % 700u] = id.x + id.y * 100u;"),
            1 => writeln!(body, "out[{place}] = id.x + id.y * 100u;"),
            _ => writeln!(body, "let at = {place}; out[at] = out[at] * 3u + id.x;"),
        }
        .expect("text grows");
        if is_looped {
            body.push('}');
        }
        let program = compiled(&shader(&body));
        let count = [random.u32(1..6), random.u32(1..5), random.u32(1..2)];
        let width = random.u32(0..30);
        let (order, [forwards, backwards]) = run(&program, width, count);
        if order == WorkgroupOrder::Free {
            free += 1;
            assert_eq!(
                forwards, backwards,
                "seed {seed}, width {width}, {count:?}:\n{body}"
            );
        } else {
            in_order += 1;
            different += u32::from(forwards != backwards);
        }
    }
    // Both answers are given, and order matters where it says so.
    assert!(free > 80, "{free}");
    assert!(in_order > 200 && different > 100, "{in_order} {different}");
}
