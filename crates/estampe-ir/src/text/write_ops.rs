//! Operations to text.

use super::write::Names;
use crate::op::{LevelOfDetail, Memory, TextureOp, TextureQuery};
use crate::{Op, Value};

/// A word: a small integer, a float if it looks like one, else hexadecimal.
pub(super) fn word(word: u32) -> String {
    let float = f32::from_bits(word);
    if word < 1 << 16 {
        word.to_string()
    } else if (1e-6..1e9).contains(&float.abs()) {
        format!("{float:?}")
    } else {
        format!("{word:#010x}")
    }
}

pub(super) fn op<N: Names + ?Sized>(op: &Op, names: &N) -> String {
    let list = |values: &[Value]| names.list(values);
    let name = |value: Value| names.name(value);
    let with = |first: &str, values: &[Value]| format!("{first} {}", list(values));
    let place = |memory: Memory, offset: Value| match memory {
        Memory::Buffer(buffer) => format!("buffer {buffer} [{}]", name(offset)),
        Memory::Workgroup => format!("workgroup [{}]", name(offset)),
    };
    match op {
        Op::Constant(constant) => format!("const {}", word(*constant)),
        Op::MaskConstant(mask) => format!("mask {mask}"),
        Op::Input(at) => format!("input {at}"),
        Op::InputMask(at) => format!("input_mask {at}"),
        Op::Unary(kind, a) => with(kind.name(), &[*a]),
        Op::Binary(kind, pair) => with(kind.name(), pair),
        Op::Fma(three) => with("fma", three),
        Op::Compare(kind, pair) => with(kind.name(), pair),
        Op::MaskNot(a) => with("mnot", &[*a]),
        Op::MaskBinary(kind, pair) => with(kind.name(), pair),
        Op::Select { mask, yes, no } => with("select", &[*mask, *yes, *no]),
        Op::Math(function, x) => with(function.name(), &[*x]),
        Op::Math2(function, pair) => with(function.name(), pair),
        Op::Derivative {
            axis,
            precision,
            value,
            mask,
        } => {
            let way = format!("derivative {} {}", axis.name(), precision.name());
            with(&way, &[*value, *mask])
        }
        Op::QuadLane { lane, value, mask } => with(&format!("quad_lane {lane}"), &[*value, *mask]),
        Op::QuadAny(a) => with("quad_any", &[*a]),
        Op::Any(a) => with("any", &[*a]),
        Op::LoadLocal { array, index } => format!("load_local {array} [{}]", name(*index)),
        Op::StoreLocal {
            array,
            index,
            value,
            mask,
        } => format!(
            "store_local {array} [{}], {}",
            name(*index),
            list(&[*value, *mask])
        ),
        Op::LoadBuffer { buffer, offset } => format!("load_buffer {buffer} [{}]", name(*offset)),
        Op::StoreBuffer {
            buffer,
            offset,
            value,
            mask,
        } => format!(
            "store_buffer {buffer} [{}], {}",
            name(*offset),
            list(&[*value, *mask])
        ),
        Op::BufferBytes(buffer) => format!("buffer_bytes {buffer}"),
        Op::LoadWorkgroup(index) => format!("load_workgroup [{}]", name(*index)),
        Op::StoreWorkgroup { index, value, mask } => {
            format!(
                "store_workgroup [{}], {}",
                name(*index),
                list(&[*value, *mask])
            )
        }
        Op::Atomic {
            kind,
            memory,
            offset,
            value,
            mask,
        } => format!(
            "atomic {} {}, {}",
            kind.name(),
            place(*memory, *offset),
            list(&[*value, *mask])
        ),
        Op::CompareExchange {
            memory,
            offset,
            expected,
            value,
            mask,
        } => format!(
            "compare_exchange {}, {}",
            place(*memory, *offset),
            list(&[*expected, *value, *mask])
        ),
        Op::Barrier => "barrier".to_owned(),
        Op::Texture(op) => texture(op, names),
    }
}

/// The names of what is asked, but for gathers, which have a component.
pub(super) const QUERIES: [(&str, TextureQuery); 9] = [
    ("sample", TextureQuery::Sample),
    ("sample_compare", TextureQuery::SampleCompare),
    ("gather_compare", TextureQuery::GatherCompare),
    ("load", TextureQuery::Load),
    ("store", TextureQuery::Store),
    ("size", TextureQuery::Size),
    ("levels", TextureQuery::Levels),
    ("layers", TextureQuery::Layers),
    ("samples", TextureQuery::Samples),
];

fn texture<N: Names + ?Sized>(op: &TextureOp, names: &N) -> String {
    let query = match op.query {
        TextureQuery::Gather(component) => format!("gather {component}"),
        query => {
            let named = QUERIES.iter().find(|(_, of_name)| *of_name == query);
            named.map_or("", |(name, _)| name).to_owned()
        }
    };
    let mut parts = vec![format!("texture {query} of {}", op.texture)];
    if let Some(sampler) = op.sampler {
        parts.push(format!("sampler {sampler}"));
    }
    parts.push(format!("at ({})", names.list(&op.coordinates)));
    let mut value = |name: &str, value: Option<Value>| {
        parts.extend(value.map(|value| format!("{name} {}", names.name(value))));
    };
    value("layer", op.layer);
    match &op.level {
        LevelOfDetail::Zero | LevelOfDetail::Implicit | LevelOfDetail::Gradient { .. } => {}
        LevelOfDetail::Bias(bias) => value("bias", Some(*bias)),
        LevelOfDetail::Explicit(level) => value("level", Some(*level)),
    }
    value("reference", op.reference);
    value("index", op.sample);
    match &op.level {
        LevelOfDetail::Implicit => parts.push("implicit".to_owned()),
        LevelOfDetail::Gradient { x, y } => {
            parts.push(format!("gradient ({}) ({})", names.list(x), names.list(y)));
        }
        _ => {}
    }
    if op.offset != [0; 3] {
        let [x, y, z] = op.offset;
        parts.push(format!("offset ({x}, {y}, {z})"));
    }
    if !op.stored.is_empty() {
        parts.push(format!("stored ({})", names.list(&op.stored)));
    }
    parts.push(format!("in {}", names.name(op.mask)));
    parts.join(" ")
}
