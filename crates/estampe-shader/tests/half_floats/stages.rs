//! 16-bit floats between stages: they are numbers of 32 bits there.

use super::reference::{decoded, encoded};
use super::run::lowered;
use estampe_ir::interface::{Input, Output};
use estampe_ir::op::TextureOp;
use estampe_ir::tree::{Surroundings, Tree, evaluate};

/// An invocation whose inputs are one number.
struct Invocation<'a>(&'a Tree, f32, Vec<u32>);

impl Surroundings for Invocation<'_> {
    fn input(&mut self, at: usize) -> u32 {
        match self.0.interface.inputs[at] {
            Input::Cover => 1,
            Input::Varying(_) | Input::Attribute { .. } => self.1.to_bits(),
            other => panic!("{other:?} is not given"),
        }
    }
    fn buffer(&mut self, _at: usize) -> &mut Vec<u32> {
        &mut self.2
    }
    fn workgroup(&mut self) -> &mut Vec<u32> {
        &mut self.2
    }
    fn texture(&mut self, _op: &TextureOp, _operands: &[u32]) -> Vec<u32> {
        Vec::new()
    }
}

/// The outputs of an entry point whose inputs are one number.
fn outputs(source: &str, input: f32) -> Vec<(Output, f32)> {
    let stage = lowered(source);
    let mut invocation = Invocation(&stage.tree, input, Vec::new());
    let words = evaluate(&stage.tree, &mut invocation, 1000).expect("it ends");
    let outputs = stage.tree.interface.outputs.iter().copied();
    outputs.zip(words.into_iter().map(f32::from_bits)).collect()
}

#[test]
fn inputs_are_rounded_and_outputs_are_exact() {
    let tenth = decoded(encoded(f64::from(0.1_f32)));
    let vertices = outputs(
        "struct Out { @builtin(position) p: vec4f, @location(0) v: vec2h }
         @vertex fn main(@location(0) a: vec3h) -> Out {
             return Out(vec4f(f32(a.x)), a.xy * 2);
         }",
        0.1,
    );
    for (output, number) in vertices {
        let expected = match output {
            Output::Varying(_) => 2.0 * tenth,
            _ => tenth,
        };
        assert_eq!(f64::from(number), expected, "{output:?}");
    }
    let fragments = outputs(
        "@fragment fn main(@location(0) v: vec3h) -> @location(0) vec3h { return v + v; }",
        0.1,
    );
    let colors = fragments
        .iter()
        .filter_map(|(output, number)| match output {
            Output::Color { component, .. } => Some((*component, f64::from(*number))),
            _ => None,
        });
    let expected = [
        (0, 2.0 * tenth),
        (1, 2.0 * tenth),
        (2, 2.0 * tenth),
        (3, 1.0),
    ];
    assert_eq!(colors.collect::<Vec<_>>(), expected);
}
