//! What the passes make of small trees.

use estampe_ir::Type;
use estampe_ir::interface::{Input, Output, Stage};
use estampe_ir::lanes::{Kernel, Terminator};
use estampe_ir::text;
use estampe_ir::tree::verify;
use estampe_ir::tree::{Builder, passes};

fn optimised(source: &str) -> String {
    let mut tree = text::tree(source).unwrap_or_else(|error| panic!("{error}"));
    verify(&tree).unwrap_or_else(|error| panic!("{error}"));
    passes::optimise(&mut tree);
    verify(&tree).unwrap_or_else(|error| panic!("{error}"));
    tree.to_string()
}

#[test]
fn blocks_that_end_at_their_end_go_and_inputs_that_are_not_read() {
    let text = "tree fragment
input cover
input position(0)
input varying(0)
output color(0, 0)
output color(0, 1)
v0 = input 2
block l0 (v1, v2) {
  block l1 (v3) {
    v4 = const 1.0
    branch l1(v4)
  }
  branch l0(v3, v0)
}
outputs v1, v2
";
    let expected = "tree fragment
input varying(0)
output color(0, 0)
output color(0, 1)
undefined v1, v2, v3
v0 = input 0
v4 = const 1.0
outputs v4, v0
";
    assert_eq!(optimised(text), expected);
}

#[test]
fn blocks_that_are_left_early_stay() {
    let text = "tree fragment
input cover
output color(0, 0)
m0 = input_mask 0
v1 = const 1.0
v2 = const 2.0
block l0 (v3) {
  if m0 {
    branch l0(v1)
  }
  branch l0(v2)
}
outputs v3
";
    assert_eq!(optimised(text), text);
}

/// Lanes that left a block early do not run the rest of it: where none is left, it is skipped, if
/// it is long.
#[test]
fn the_rest_of_a_block_is_skipped_where_all_lanes_left_it() {
    let kernel = |divisions: usize| {
        let rest: String = (2..2 + divisions)
            .map(|at| format!("  v{} = fdiv v{at}, v1\n", at + 1))
            .collect();
        let last = 2 + divisions;
        let source = format!(
            "tree fragment
input cover
input varying(0)
output color(0, 0)
m0 = input_mask 0
v1 = input 1
v2 = const 2.0
block l0 (v{}) {{
  if m0 {{
    branch l0(v1)
  }}
{rest}  branch l0(v{last})
}}
outputs v{}
",
            last + 1,
            last + 1
        );
        let tree = text::tree(&source).unwrap_or_else(|error| panic!("{error}"));
        verify(&tree).unwrap_or_else(|error| panic!("{error}"));
        Kernel::from_tree(&tree)
    };
    let branches = |kernel: &Kernel| {
        let blocks = kernel.blocks.iter();
        blocks
            .filter(|block| matches!(block.terminator, Terminator::Branch { .. }))
            .count()
    };
    assert_eq!(branches(&kernel(2)), 0);
    assert_eq!(branches(&kernel(4)), 1);
}

#[test]
fn an_if_ends_where_both_sides_end_in_ifs() {
    let mut b = Builder::new(Stage::Fragment);
    let cover = b.input(Input::Cover);
    let (one, two) = (b.float(1.0), b.float(2.0));
    let label = b.block_of(&[Type::Word]);
    b.start_if(cover);
    b.start_if(cover);
    b.branch(label, &[one]);
    b.start_else();
    b.branch(label, &[two]);
    b.end_if();
    b.start_else();
    b.branch(label, &[two]);
    b.end_if();
    assert!(b.has_ended());
    let result = b.end_block()[0];
    let color = Output::Color {
        target: 0,
        component: 0,
    };
    let mut tree = b.finish(vec![(color, result)]);
    verify(&tree).unwrap_or_else(|error| panic!("{error}"));
    passes::optimise(&mut tree);
    verify(&tree).unwrap_or_else(|error| panic!("{error}"));
}

/// Sums up the numbers below a limit, with an input that leaves early.
fn sum_below(limit: u32) -> String {
    let text = format!(
        "tree fragment
input cover
input varying(0)
output color(0, 0)
m0 = input_mask 0
v1 = input 1
v2 = const 0
v3 = const 1
v4 = const {limit}
block l0 (v5) {{
  loop l1 (v6 = v2, v7 = v1) {{
    m8 = ult v6, v4
    if m8 {{
    }} else {{
      branch l0(v7)
    }}
    v9 = f32_from_u32 v6
    v10 = fadd v7, v9
    v11 = add v6, v3
    branch l1(v11, v10)
  }}
}}
outputs v5
"
    );
    optimised(&text)
}

#[test]
fn short_loops_are_unrolled() {
    let short = sum_below(3);
    assert!(
        !short.contains("loop") && !short.contains("block"),
        "{short}"
    );
    // The first iteration adds 0, which changes −0.
    assert_eq!(short.matches("fadd").count(), 3, "{short}");
    assert_eq!(short.matches("f32_from_u32").count(), 0, "{short}");
    let long = sum_below(500);
    assert!(long.contains("loop"), "{long}");
    assert!(sum_below(0).ends_with("outputs v1\n"), "{}", sum_below(0));
}

#[test]
fn the_opposite_of_a_mask_is_known_in_no_other_tree() {
    // The iterations of the outer loop make the new tree longer than this one. In each, `m13` is
    // known to be the opposite of `m12`, whose new number soon names no value here.
    let text = "tree fragment
input cover
input varying(0)
output color(0, 0)
m0 = input_mask 0
v1 = input 1
v2 = const 0
v3 = const 1
v4 = const 12
v5 = const 2
block l0 (v6) {
  loop l1 (v7 = v2, v8 = v1) {
    m9 = ult v7, v4
    if m9 {
    } else {
      branch l0(v8)
    }
    v10 = fadd v8, v7
    m11 = ule v7, v4
    m12 = flt v10, v1
    m13 = mxor m12, m11
    block l2 (v14) {
      loop l3 (v15 = v2, v16 = v10) {
        m17 = ult v15, v5
        if m17 {
        } else {
          branch l2(v16)
        }
        block l4 (v18) {
          m19 = eq v15, v2
          if m19 {
            m20 = mnot m13
            v21 = select m20, v1, v16
            branch l4(v21)
          }
          branch l4(v16)
        }
        v22 = fmul v16, v18
        v23 = add v15, v3
        branch l3(v23, v22)
      }
    }
    v24 = add v7, v3
    branch l1(v24, v14)
  }
}
outputs v6
";
    let straight = optimised(text);
    assert!(!straight.contains("loop"), "{straight}");
    assert_eq!(straight.matches("fmul").count(), 24, "{straight}");
}

/// Each function that is inlined brings its own constants; accesses in the same mask are done
/// together.
#[test]
fn constant_masks_are_one_value_of_a_kernel() {
    let source = "tree fragment
input varying(0)
output color(0, 0)
texture_at 0.1
sampler_at 0.0
v0 = input 0
m1 = mask true
v2, v3, v4, v5 = texture sample of 0 sampler 0 at (v0, v0) in m1
m6 = mask true
v7, v8, v9, v10 = texture sample of 0 sampler 0 at (v0, v2) in m6
v11 = fadd v2, v7
outputs v11
";
    let tree = text::tree(source).unwrap_or_else(|error| panic!("{error}"));
    let kernel = Kernel::from_tree(&tree).to_string();
    let accesses = kernel
        .lines()
        .filter(|line| line.contains("texture sample"));
    let masks = accesses.filter_map(|line| line.rsplit_once(" in ").map(|(_, mask)| mask));
    let masks: Vec<&str> = masks.collect();
    assert_eq!(masks.len(), 2, "{kernel}");
    assert_eq!(masks[0], masks[1], "{kernel}");
}

/// A product with a varying is fused; one of uniform factors, a shift of a filter's tap, is not.
#[test]
fn products_of_uniform_factors_are_not_contracted() {
    let source = "tree fragment
input varying(0)
output color(0, 0)
output color(0, 1)
buffer 0.0
texture_at 0.1
v0 = input 0
v1 = const 0
v2 = load_buffer 0 [v1]
m3 = mask true
v4, v5, v6 = texture size of 0 at () in m3
v7 = f32_from_u32 v4
v8 = fmul v2, v7
v9 = fadd v0, v8
v10 = fmul v0, v2
v11 = fadd v10, v7
outputs v9, v11
";
    let mut tree = text::tree(source).unwrap_or_else(|error| panic!("{error}"));
    verify(&tree).unwrap_or_else(|error| panic!("{error}"));
    passes::contract(&mut tree);
    passes::dead_code(&mut tree);
    verify(&tree).unwrap_or_else(|error| panic!("{error}"));
    let contracted = tree.to_string();
    assert!(contracted.contains("v9 = fadd v0, v8\n"), "{contracted}");
    assert!(
        contracted.contains("v11 = fma v0, v2, v7\n"),
        "{contracted}"
    );
}
