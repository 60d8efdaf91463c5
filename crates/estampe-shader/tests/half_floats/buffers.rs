//! 16-bit floats in buffers, where two share a word, and in variables.

use super::reference::{decoded, encoded};
use super::run::{Contents, lowered, packed, run, unpacked};
use estampe_shader::front::{Options, Source, load};
use estampe_types::shader::WorkgroupOrder::{Free, InOrder};

/// The code of a small whole number.
fn whole(number: usize) -> u16 {
    encoded(f64::from(u32::try_from(number).expect("a small number")))
}

/// A buffer whose k-th half is the number k.
fn numbered(halves: usize) -> Vec<u32> {
    packed(&(0..halves).map(whole).collect::<Vec<_>>())
}

/// Runs invocations that write an array of 16-bit floats, in work-groups of three, which share
/// words with others. Its numbers are those of their places at first.
fn written(body: &str, length: usize, groups: u32) -> (bool, Vec<f64>) {
    let source = format!(
        "struct Item {{ a: f16, b: f16, c: f16 }}\n\
         @group(0) @binding(0) var<storage, read_write> {};\n\
         @compute @workgroup_size(3) fn main(@builtin(global_invocation_id) id: vec3u) {{\n\
         let i = id.x; {body} }}",
        if body.contains("items") {
            "items: array<Item>"
        } else {
            "out: array<f16>"
        }
    );
    let (order, words) = run(&source, &[Contents::Written(numbered(length))], groups);
    let numbers = unpacked(&words[0]).into_iter().map(decoded).collect();
    (order == Free, numbers)
}

#[test]
fn neighbours_keep_their_halves() {
    // What is written, whether the order of work-groups is free, and the places whose number gets
    // another sign.
    type Changed = fn(usize) -> bool;
    let [all, none, second]: [Changed; 3] = [|_| true, |_| false, |k| k % 3 == 1];
    let cases: [(&str, bool, Changed); 7] = [
        ("out[i] = -f16(i);", true, all),
        // Each reads and writes its own half.
        ("out[i] = -out[i];", true, all),
        ("if i % 2 == 1 { out[i] = -out[i]; }", true, |k| k % 2 == 1),
        ("out[i] = out[i] + out[i + 1u] * 0;", false, none),
        // Places that the analysis does not know.
        ("let k = (i * 7u) % 30u; out[k] = -f16(k);", false, all),
        // Items of six bytes.
        ("if i < 10u { items[i].b = -items[i].b; }", true, second),
        (
            "if i < 10u { let item = items[i]; items[i] = Item(item.a, -item.b, item.c); }",
            true,
            second,
        ),
    ];
    for (body, is_free, is_changed) in cases {
        let (free, numbers) = written(body, 30, 10);
        assert_eq!(free, is_free, "{body}");
        let wanted = (0..30).map(|k| {
            let number = decoded(whole(k));
            if is_changed(k) { -number } else { number }
        });
        assert_eq!(numbers, wanted.collect::<Vec<_>>(), "{body}");
    }
}

#[test]
fn orders_of_pairs_and_halves() {
    for (body, expected) in [
        ("out[i] = vec2h(1);", Free),
        ("out[i].y = out[i].x;", Free),
        ("out[i / 2u].x = 1;", InOrder),
        // Work-groups that write the two halves of the same words.
        ("out[i].x = 1; out[i + 3u].y = 2;", InOrder),
        ("out[i + 1u].x = out[i].y;", Free),
        ("out[i + 1u].y = out[i].x;", InOrder),
        ("out[2 * i] = out[2 * i + 1];", Free),
    ] {
        let source = format!(
            "@group(0) @binding(0) var<storage, read_write> out: array<vec2h>;\n\
             @compute @workgroup_size(3) fn main(@builtin(global_invocation_id) id: vec3u) {{\n\
             let i = id.x; {body} }}"
        );
        let (order, _) = run(&source, &[Contents::Written(numbered(80))], 5);
        assert_eq!(order, expected, "{body}");
    }
}

/// Offsets in bytes: 0, 4, 8, 14; 16 and columns of 8; 40 and columns of 4; 48 and columns of 4;
/// 64.
const BLOCK: &str = "struct Block {
    a: f16, b: u32, c: vec3h, d: f16, m: mat3x3h, n: mat2x2h, k: mat4x2h, z: f16,
}";

#[test]
fn members_are_where_wgsl_puts_them() {
    for space in ["uniform", "storage, read", "storage, read_write"] {
        let source = format!(
            "{BLOCK}
             @group(0) @binding(0) var<{space}> block: Block;
             @group(0) @binding(1) var<storage, read_write> out: array<f32>;
             @group(0) @binding(2) var<storage, read> two: u32;
             @compute @workgroup_size(1) fn main() {{
                 let all = block;
                 out[0] = f32(all.a); out[1] = f32(all.b);
                 for (var i = 0u; i < 3; i++) {{
                     out[2 + i] = f32(block.c[i]);
                     for (var j = 0u; j < 3; j++) {{ out[8 + 3 * i + j] = f32(block.m[i][j]); }}
                 }}
                 out[5] = f32(all.c.z); out[6] = f32(all.d); out[7] = f32(block.c[two]);
                 out[17] = f32(all.m[1].z); out[18] = f32(all.n[1].x); out[19] = f32(block.n[0].y);
                 for (var i = 0u; i < 4; i++) {{
                     out[20 + 2 * i] = f32(all.k[i].x); out[21 + 2 * i] = f32(block.k[i].y);
                 }}
                 out[28] = f32(all.z); out[29] = f32(block.z); out[30] = f32(all.m[two][two]);
                 out[31] = f32(block.k[two].y);
             }}"
        );
        let mut block = numbered(36);
        block[1] = 77;
        let contents = match space {
            "storage, read_write" => Contents::Written(block),
            _ => Contents::Read(block),
        };
        let buffers = [
            contents,
            Contents::Written(vec![0; 32]),
            Contents::Read(vec![2]),
        ];
        let (_, mut words) = run(&source, &buffers, 1);
        let found = words.pop().expect("the results");
        let found: Vec<f32> = found.into_iter().map(f32::from_bits).collect();
        let expected: [u8; 32] = [
            0, 77, 4, 5, 6, 6, 7, 6, 8, 9, 10, 12, 13, 14, 16, 17, 18, 14, 22, 21, 24, 25, 26, 27,
            28, 29, 30, 31, 32, 32, 18, 29,
        ];
        assert_eq!(found, expected.map(f32::from), "{space}");
    }
}

#[test]
fn stores_change_nothing_else() {
    let source = format!(
        "{BLOCK}
         @group(0) @binding(0) var<storage, read_write> block: Block;
         @group(0) @binding(1) var<storage, read> two: u32;
         @compute @workgroup_size(1) fn main() {{
             block.c = vec3h(4, 5, 6);
             block.m[two] = vec3h(16, 17, 18);
             block.m[1][two] = 14;
             block.m[0].y = 9;
             block.n = mat2x2h(20, 21, 22, 23);
             block.k[two - 1u].x = 26;
             block.k[two - two].y = 25;
             block.z = 32;
         }}"
    );
    let before = 0xABCD_ABCD;
    let buffers = [Contents::Written(vec![before; 18]), Contents::Read(vec![2])];
    let (_, words) = run(&source, &buffers, 1);
    let stored = [4, 5, 6, 16, 17, 18, 14, 9, 20, 21, 22, 23, 26, 25, 32];
    for (at, code) in unpacked(&words[0]).into_iter().enumerate() {
        let expected = if stored.contains(&at) {
            whole(at)
        } else {
            0xABCD
        };
        assert_eq!(code, expected, "half {at}");
    }
}

#[test]
fn lengths_and_the_ends_of_buffers() {
    let source = "struct List { first: f16, rest: array<f16> }
        @group(0) @binding(0) var<storage, read_write> list: List;
        @group(0) @binding(1) var<storage, read_write> out: array<f32>;
        @compute @workgroup_size(1) fn main() {
            out[0] = f32(arrayLength(&list.rest));
            out[1] = f32(list.rest[6]); out[2] = f32(list.rest[i32(out[0])]);
            out[3] = f32(list.first);
            list.rest[6] = 70;
            list.rest[100000] = 80;
        }";
    let buffers = [
        Contents::Written(numbered(8)),
        Contents::Written(vec![0; 4]),
    ];
    let (_, words) = run(source, &buffers, 1);
    let found: Vec<f32> = words[1].iter().map(|word| f32::from_bits(*word)).collect();
    assert_eq!(found, [7.0, 7.0, 0.0, 0.0]);
    let mut expected = numbered(8);
    expected[3] = u32::from(whole(70)) << 16 | expected[3] & 0xFFFF;
    assert_eq!(words[0], expected);
}

#[test]
fn variables_constants_and_functions() {
    let source = "
        struct Item { weight: f16, parts: array<vec2h, 3> }
        const third = 1h / 3h;
        const table = array<f16, 4>(1, 2.5h, 65504, 6e-8h);
        override scale: f16 = 0.1h;
        var<private> total: f16 = 1.5;
        var<workgroup> shared_parts: array<f16, 16>;
        fn add(to: ptr<function, vec2h>, more: f16) -> f16 { (*to).y += more; total += more; return (*to).x; }
        @group(0) @binding(0) var<storage, read_write> out: array<f32>;
        @compute @workgroup_size(16) fn main(@builtin(local_invocation_index) i: u32) {
            shared_parts[i] = f16(i) * scale;
            workgroupBarrier();
            var item = Item(1, array<vec2h, 3>(vec2h(1, 2), vec2h(3, 4), vec2h(5, 6)));
            item.parts[i % 3u].x = 9;
            var pair = item.parts[1];
            let x = add(&pair, table[i % 4u]);
            out[i * 8u] = f32(shared_parts[15u - i]);
            out[i * 8u + 1u] = f32(pair.y);
            out[i * 8u + 2u] = f32(x);
            out[i * 8u + 3u] = f32(total);
            out[i * 8u + 4u] = f32(third);
            out[i * 8u + 5u] = f32((mat2x3h(1, 2, 3, 4, 5, 6) * vec2h(f16(i), third)).z);
            out[i * 8u + 6u] = f32(bitcast<f16>(scale));
            out[i * 8u + 7u] = f32(select(vec2h(1), vec2h(-0.1h), vec2h(f16(i)) > vec2h(3))[i & 1u]);
        }";
    let (_, words) = run(source, &[Contents::Written(vec![0; 128])], 1);
    let rounded = |number: f64| decoded(encoded(number));
    let third = rounded(1.0 / 3.0);
    let tenth = rounded(0.1);
    for i in 0..16_u32 {
        let table = [1.0, 2.5, 65504.0, rounded(6e-8)][i as usize % 4];
        let expected = [
            rounded(f64::from(15 - i) * tenth),
            rounded(4.0 + table),
            if i % 3 == 1 { 9.0 } else { 3.0 },
            rounded(1.5 + table),
            third,
            rounded(3.0 * f64::from(i) + 6.0 * third),
            tenth,
            if i > 3 { -tenth } else { 1.0 },
        ];
        let found = &words[0][i as usize * 8..][..8];
        let found: Vec<f64> = found
            .iter()
            .map(|word| f32::from_bits(*word).into())
            .collect();
        assert_eq!(found, expected, "{i}");
    }
}

#[test]
fn buffers_have_whole_words() {
    let stage = lowered(
        "@group(0) @binding(0) var<uniform> a: vec3h;
         @group(0) @binding(1) var<storage, read_write> b: array<f16, 3>;
         @compute @workgroup_size(1) fn main() { b[2] = a.z; }",
    );
    let sizes = stage.bindings.iter().map(|(_, entry)| match entry.ty {
        estampe_types::BindingType::Buffer {
            min_binding_size, ..
        } => min_binding_size,
        _ => 0,
    });
    assert_eq!(sizes.collect::<Vec<_>>(), [8, 8]);
}

#[test]
fn reflection_names_types_and_strides() {
    let text = format!(
        "enable f16; {BLOCK} @group(0) @binding(0) var<uniform> block: Block;\n\
         @fragment fn main(@location(0) v: vec2h) -> @location(0) vec4f {{\n\
         return vec4f(f32(block.a + v.x)); }}"
    );
    let module = load(Source::Wgsl(&text), &Options::default());
    let module = module.unwrap_or_else(|errors| panic!("{errors}"));
    let found = ["a", "c", "m", "k"].map(|name| {
        let (_, member) = module.reflection.uniform(name).expect("a member");
        (member.kind.to_string(), member.offset, member.matrix_stride)
    });
    let expected = [
        ("f16", 0, 0),
        ("vec3<f16>", 8, 0),
        ("mat3x3<f16>", 16, 8),
        ("mat4x2<f16>", 48, 4),
    ];
    assert_eq!(
        found,
        expected.map(|(name, at, stride)| (name.to_owned(), at, stride))
    );
}
