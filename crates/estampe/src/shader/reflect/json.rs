//! A shader's reflection as JSON.

use super::text::{kind, names_of, type_name};
use crate::shader::source::stage_name;
use estampe::{Reflection, ScalarType, ShaderModule, ShaderStage, UniformMember};
use estampe_shader::front::{Binding, BindingKind, Override, OverrideValue, Varying};
use serde_json::{Value, json};

/// The whole reflection as one object.
pub(super) fn object(file: &str, module: &ShaderModule) -> Value {
    let all = |list: fn(&Reflection) -> Vec<Value>| -> Vec<Value> {
        module.reflections().flat_map(list).collect()
    };
    let varyings = |list: &[Varying]| list.iter().map(varying).collect::<Vec<_>>();
    let inputs = module.reflections().flat_map(|one| &one.inputs);
    let outputs = module.reflections().flat_map(|one| &one.outputs);
    let entries = module.entry_points().zip(inputs.zip(outputs));
    let entries = entries.map(|(entry, (inputs, outputs))| {
        json!({
            "name": entry.name,
            "stage": stage_name(entry.stage),
            "workgroup_size": (entry.stage == ShaderStage::Compute).then_some(entry.workgroup_size),
            "inputs": varyings(inputs),
            "outputs": varyings(outputs),
        })
    });
    let push = |one: &Reflection| {
        let block = one.blocks.iter().find(|block| block.slot.is_none())?;
        let members = block.members.iter().map(member).collect::<Vec<_>>();
        Some(json!({"name": block.name, "size": block.size, "members": members}))
    };
    json!({
        "shader": file,
        "entry_points": entries.collect::<Vec<_>>(),
        "bindings": all(|one| one.bindings.iter().map(|it| binding(one, it)).collect()),
        "samplers": all(|one| {
            let pairs = one.combined_samplers.iter();
            pairs.map(|pair| json!({
                "name": pair.name,
                "texture": [pair.texture.0, pair.texture.1],
                "sampler": [pair.sampler.0, pair.sampler.1],
            })).collect()
        }),
        "push_constants": module.reflections().find_map(push),
        "constants": all(|one| one.overrides.iter().map(constant).collect()),
    })
}

fn varying(varying: &Varying) -> Value {
    json!({
        "name": varying.name,
        "location": varying.location,
        "type": varying.kind.to_string(),
        "flat": varying.is_flat,
    })
}

fn binding(reflection: &Reflection, binding: &Binding) -> Value {
    let slot = (binding.group, binding.binding);
    let block = reflection
        .blocks
        .iter()
        .find(|block| block.slot == Some(slot));
    let members = block.map_or(&[][..], |block| &block.members);
    let (size, read_only) = match binding.kind {
        BindingKind::UniformBuffer { min_size } => (Some(min_size), Some(true)),
        BindingKind::StorageBuffer {
            is_read_only,
            min_size,
        } => (Some(min_size), Some(is_read_only)),
        _ => (None, None),
    };
    json!({
        "group": binding.group,
        "binding": binding.binding,
        "name": binding.name,
        "kind": kind(binding.kind),
        "type": type_name(binding.kind),
        "count": binding.count,
        "size": size,
        "read_only": read_only,
        "stages": names_of(binding.stages),
        "members": members.iter().map(member).collect::<Vec<_>>(),
    })
}

fn member(member: &UniformMember) -> Value {
    json!({
        "name": member.name,
        "type": member.kind.to_string(),
        "offset": member.offset,
        "array_length": member.array_length,
        "array_stride": member.array_stride,
        "matrix_stride": member.matrix_stride,
        "initial_value": member.initial_value.as_ref().map(|words| {
            let scalar = member.kind.scalar();
            words.iter().map(|word| number(scalar, *word)).collect::<Vec<_>>()
        }),
    })
}

fn number(scalar: ScalarType, word: u32) -> Value {
    match scalar {
        ScalarType::Bool => json!(word != 0),
        ScalarType::F32 => json!(f32::from_bits(word)),
        ScalarType::I32 => json!(word.cast_signed()),
        _ => json!(word),
    }
}

fn constant(constant: &Override) -> Value {
    json!({
        "name": constant.name,
        "id": constant.id,
        "type": constant.kind.wgsl_name(),
        "default": match constant.default {
            None => Value::Null,
            Some(OverrideValue::Number(number)) => json!(number),
            Some(OverrideValue::Expression) => json!("expression"),
        },
    })
}
