//! The names of stages, inputs and outputs.

use crate::interface::{Input, Output, Stage};
use crate::op::Axis;

pub(super) const STAGES: [(&str, Stage); 3] = [
    ("vertex", Stage::Vertex),
    ("fragment", Stage::Fragment),
    ("compute", Stage::Compute),
];

/// A name with numbers in brackets.
pub(super) fn called(name: &str, numbers: &[u32]) -> String {
    if numbers.is_empty() {
        return name.to_owned();
    }
    let numbers: Vec<_> = numbers.iter().map(u32::to_string).collect();
    format!("{name}({})", numbers.join(", "))
}

pub(super) fn of_input(input: Input) -> String {
    match input {
        Input::Attribute {
            location,
            component,
        } => called("attribute", &[location, component]),
        Input::Varying(at) => called("varying", &[at]),
        Input::Derivative { scalar, axis } => match axis {
            Axis::X => called("derivative_x", &[scalar]),
            Axis::Y => called("derivative_y", &[scalar]),
        },
        Input::TextureRead { read, component } => called("texture_read", &[read, component]),
        Input::VertexIndex => called("vertex_index", &[]),
        Input::InstanceIndex => called("instance_index", &[]),
        Input::Position(at) => called("position", &[at]),
        Input::FrontFacing => called("front_facing", &[]),
        Input::SampleIndex => called("sample_index", &[]),
        Input::SampleMask => called("sample_mask", &[]),
        Input::Cover => called("cover", &[]),
        Input::LocalInvocationId(at) => called("local_invocation_id", &[at]),
        Input::LocalInvocationIndex => called("local_invocation_index", &[]),
        Input::WorkgroupId(at) => called("workgroup_id", &[at]),
        Input::NumWorkgroups(at) => called("num_workgroups", &[at]),
        Input::PushConstant(at) => called("push_constant", &[at]),
        Input::TextureSide { texture, axis } => called("texture_side", &[texture, axis]),
    }
}

pub(super) fn input(name: &str, numbers: &[u32]) -> Option<Input> {
    Some(match (name, numbers) {
        ("attribute", &[location, component]) => Input::Attribute {
            location,
            component,
        },
        ("varying", &[at]) => Input::Varying(at),
        ("derivative_x", &[scalar]) => {
            let axis = Axis::X;
            Input::Derivative { scalar, axis }
        }
        ("derivative_y", &[scalar]) => {
            let axis = Axis::Y;
            Input::Derivative { scalar, axis }
        }
        ("texture_read", &[read, component]) => Input::TextureRead { read, component },
        ("vertex_index", []) => Input::VertexIndex,
        ("instance_index", []) => Input::InstanceIndex,
        ("position", &[at]) => Input::Position(at),
        ("front_facing", []) => Input::FrontFacing,
        ("sample_index", []) => Input::SampleIndex,
        ("sample_mask", []) => Input::SampleMask,
        ("cover", []) => Input::Cover,
        ("local_invocation_id", &[at]) => Input::LocalInvocationId(at),
        ("local_invocation_index", []) => Input::LocalInvocationIndex,
        ("workgroup_id", &[at]) => Input::WorkgroupId(at),
        ("num_workgroups", &[at]) => Input::NumWorkgroups(at),
        ("push_constant", &[at]) => Input::PushConstant(at),
        ("texture_side", &[texture, axis]) => Input::TextureSide { texture, axis },
        _ => return None,
    })
}

pub(super) fn of_output(output: Output) -> String {
    match output {
        Output::Position(at) => called("position", &[at]),
        Output::Varying(at) => called("varying", &[at]),
        Output::PointSize => called("point_size", &[]),
        Output::ClipDistance(at) => called("clip_distance", &[at]),
        Output::Color { target, component } => called("color", &[target, component]),
        Output::SecondColor(at) => called("second_color", &[at]),
        Output::Depth => called("depth", &[]),
        Output::SampleMask => called("sample_mask", &[]),
        Output::Cover => called("cover", &[]),
    }
}

pub(super) fn output(name: &str, numbers: &[u32]) -> Option<Output> {
    Some(match (name, numbers) {
        ("position", &[at]) => Output::Position(at),
        ("varying", &[at]) => Output::Varying(at),
        ("point_size", []) => Output::PointSize,
        ("clip_distance", &[at]) => Output::ClipDistance(at),
        ("color", &[target, component]) => Output::Color { target, component },
        ("second_color", &[at]) => Output::SecondColor(at),
        ("depth", []) => Output::Depth,
        ("sample_mask", []) => Output::SampleMask,
        ("cover", []) => Output::Cover,
        _ => return None,
    })
}
