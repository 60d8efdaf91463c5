//! Tests of the text form.

use super::{kernel, tree};
use crate::interface::{Input, Output, Stage};
use crate::lanes::Kernel;
use crate::op::{Binary, Compare, MaskBinary, Math, Math2, Unary};
use crate::tree::Builder;

/// All entries of the interface, all operations that have a form of their own, and all terminators.
const KERNEL: &str = "kernel compute
input attribute(1, 2)
input varying(3)
input position(0)
input local_invocation_id(2)
input workgroup_id(0)
input cover
input derivative_x(3)
input derivative_y(4)
input texture_read(1, 2)
output color(0, 3)
output second_color(1)
output clip_distance(7)
output cover
buffer 0.1
buffer 2.3 written
buffer immediates
texture_at 0.2
sampler_at 0.4
local 16 [1, 2.5, 0xffffffff]
local 4
workgroup 64 (8, 8, 1)
undefined v40, um41
b0:
  v0 = input 0
  m1 = input_mask 5
  uv2 = const 7
  uv3 = const 1.5
  um4 = mask true
  v5 = fneg v0
  v6 = fadd v5, uv3
  v7 = fma v0, v5, v6
  m8 = flt v7, uv3
  m9 = mnot m8
  m10 = mandnot m9, m1
  v11 = select m10, v0, uv2
  v12 = sin v11
  v13 = pow v12, uv3
  v14 = derivative x fine v13, m1
  m15 = quad_any m1
  um16 = any m15
  v17 = load_local 0 [v0]
  store_local 1 [v0], v17, m1
  v18 = load_buffer 0 [v17]
  store_buffer 1 [v17], v18, m1
  uv19 = buffer_bytes 1
  v20 = load_workgroup [v18]
  store_workgroup [v18], v20, m1
  v21 = atomic add buffer 1 [v20], v18, m1
  v22 = atomic smin workgroup [v20], v18, m1
  v23, m24 = compare_exchange buffer 1 [v22], v21, v20, m1
  barrier
  v25, v26, v27, v28 = texture sample of 0 sampler 0 at (v0, v5) layer uv2 bias v6 offset (1, -2, 0) in m1
  v29 = texture sample_compare of 0 sampler 0 at (v0, v5) level uv3 reference v6 in m1
  v30, v31, v32, v33 = texture gather 3 of 0 sampler 0 at (v0, v5) implicit in m1
  v34, v35, v36, v37 = texture sample of 0 sampler 0 at (v0, v5) gradient (v6, v7) (v0, v5) in m1
  texture store of 0 at (v17, v18) index uv2 stored (v34, v35, v36, v37) in m1
  jump b1(uv3, m24)
b1(v38, m39):
  branch m39 ? b1(v38, um4) : b2
b2:
  return v38, v38, v0, m39
";

const TREE: &str = "tree vertex
input vertex_index
output varying(0)
v0 = input 0
block l0 (v1) {
  loop l1 (v2 = v0) {
    m3 = ult v2, v0
    if m3 {
      branch l0(v2)
    } else {
      m4 = mnot m3
      if m4 {
      }
    }
    branch l1(v2)
  }
}
block l5 {
}
outputs v1
";

#[test]
fn texts_are_read_and_written_back() {
    assert_eq!(kernel(KERNEL).unwrap().to_string(), KERNEL);
    assert_eq!(tree(TREE).unwrap().to_string(), TREE);
    let parsed = tree(TREE).unwrap();
    assert_eq!(tree(&parsed.to_string()).unwrap(), parsed);
    crate::tree::verify(&parsed).unwrap();
}

#[test]
fn numbers_have_the_forms_of_words() {
    let text = |word: &str| format!("kernel vertex b0: uv0 = const {word} return");
    for (word, bits) in [
        ("0", 0),
        ("-1", u32::MAX),
        ("4294967295", u32::MAX),
        ("0xDEADbeef", 0xDEAD_BEEF),
        ("1.0", 0x3F80_0000),
        ("-2.5", 0xC020_0000),
        ("1e-3", 1e-3_f32.to_bits()),
    ] {
        let read = kernel(&text(word)).unwrap();
        assert_eq!(read.blocks[0].ops[0].0, crate::Op::Constant(bits), "{word}");
    }
    let mut random = fastrand::Rng::with_seed(3);
    for _ in 0..2000 {
        let bits = random.u32(..) >> random.u32(0..32);
        let read = kernel(&text(&super::write_ops::word(bits))).unwrap();
        assert_eq!(read.blocks[0].ops[0].0, crate::Op::Constant(bits));
    }
}

#[test]
fn errors_say_where_and_what() {
    for (text, error) in [
        ("", "1:1: the text ends too early"),
        ("kernel mesh", "1:8: `mesh` is no stage"),
        (
            "kernel vertex\ninput varying",
            "2:7: `varying` is no input, with these numbers",
        ),
        (
            "kernel vertex\nb0:\n  v0 = frob v1",
            "3:8: `frob` is no operation",
        ),
        (
            "kernel vertex\nb0:\n  v0 = fadd v1 v2",
            "3:16: expected `,`, found `v2`",
        ),
        (
            "kernel vertex\nb0:\n  v0 = fneg x1",
            "3:13: expected a value such as `v0`, found `x1`",
        ),
        (
            "kernel vertex\nb0:\n  v0 = fneg m0",
            "3:13: value 0 has another type elsewhere",
        ),
        ("kernel vertex\nb1:", "2:1: expected block 0"),
        (
            "kernel vertex // ⟶ b1:\nb0: v9 = const 1 return",
            "2:18: value 0 is not named, but greater numbers are",
        ),
        (
            "kernel vertex b0: v0, v2 = const 1 return",
            "1:34: results are as many as the operation has, with consecutive numbers",
        ),
        (
            "kernel vertex b0: v99999999 = const 1 return",
            "1:19: the number of a value is at most 4194303",
        ),
        (
            "kernel vertex b0: v0 = const 1x",
            "1:30: expected a word, found `1x`",
        ),
    ] {
        assert_eq!(kernel(text).unwrap_err().to_string(), error);
    }
    let deep = format!("tree vertex {}", "block l0 { ".repeat(10_000));
    let error = tree(&deep).unwrap_err();
    assert_eq!(error.what, "bodies are nested too deep");
}

/// Texts with parts left out, doubled or exchanged are read or refused, and what is read is written
/// as a text of the same.
#[test]
fn broken_texts_are_refused() {
    let mut random = fastrand::Rng::with_seed(11);
    let (mut read, mut refused) = (0, 0);
    for turn in 0..3000 {
        let text = if turn % 2 == 0 { KERNEL } else { TREE };
        let mut parts: Vec<&str> = text.split_inclusive([' ', '\n', ',']).collect();
        for _ in 0..random.u32(1..4) {
            let (a, b) = (random.usize(0..parts.len()), random.usize(0..parts.len()));
            match random.u32(0..3) {
                0 => drop(parts.remove(a)),
                1 => parts.insert(a, parts[b]),
                _ => parts.swap(a, b),
            }
        }
        let broken = parts.concat();
        let again = if turn % 2 == 0 {
            kernel(&broken).map(|one| {
                let written = one.to_string();
                (kernel(&written).unwrap().to_string(), written)
            })
        } else {
            tree(&broken).map(|one| {
                let written = one.to_string();
                (tree(&written).unwrap().to_string(), written)
            })
        };
        match again {
            Ok((second, first)) => {
                assert_eq!(second, first);
                read += 1;
            }
            Err(_) => refused += 1,
        }
    }
    assert!(read > 100 && refused > 1000, "{read} {refused}");
}

/// Every kind of operation has a name of its own.
#[test]
fn all_kinds_are_read_back() {
    let mut b = Builder::new(Stage::Fragment);
    let mut last = b.input(Input::Varying(0));
    let mut mask = b.input(Input::Cover);
    for &kind in Unary::ALL {
        last = b.unary(kind, last);
    }
    for &kind in Binary::ALL {
        last = b.binary(kind, last, last);
    }
    for &kind in Math::ALL {
        last = b.math(kind, last);
    }
    for &kind in Math2::ALL {
        last = b.op1(crate::Op::Math2(kind, [last, last]));
    }
    for &kind in Compare::ALL {
        let compared = b.compare(kind, last, last);
        for &kind in MaskBinary::ALL {
            mask = b.mask_binary(kind, mask, compared);
        }
    }
    let written = b.finish(vec![(Output::Varying(0), last), (Output::Cover, mask)]);
    assert_eq!(tree(&written.to_string()).unwrap(), written);
    let written = Kernel::from_tree(&written);
    assert_eq!(kernel(&written.to_string()).unwrap(), written);
}
