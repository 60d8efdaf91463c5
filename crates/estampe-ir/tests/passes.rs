//! What the passes make of small trees.

use estampe_ir::Type;
use estampe_ir::interface::{Input, Output, Stage};
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
