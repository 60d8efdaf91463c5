//! A shader's reflection as text.

use crate::shader::source::stage_name;
use estampe::{Reflection, ScalarType, ShaderModule, ShaderStage, UniformMember};
use estampe_shader::front::{
    Binding, BindingKind, Override, OverrideValue, SampleType, Stages, TextureDimension, Varying,
};
use std::fmt::Write;

/// The whole reflection; writing to strings cannot fail.
pub(super) fn text(module: &ShaderModule) -> String {
    let mut text = String::new();
    let inputs = module.reflections().flat_map(|one| &one.inputs);
    let outputs = module.reflections().flat_map(|one| &one.outputs);
    for (entry, (inputs, outputs)) in module.entry_points().zip(inputs.zip(outputs)) {
        let _ = write!(text, "{} `{}`", stage_name(entry.stage), entry.name);
        if entry.stage == ShaderStage::Compute {
            let [x, y, z] = entry.workgroup_size;
            let _ = write!(text, ", work-groups of {x}x{y}x{z}");
        }
        text.push('\n');
        varyings(&mut text, "input", inputs);
        varyings(&mut text, "output", outputs);
    }
    for reflection in module.reflections() {
        for binding in &reflection.bindings {
            bound(&mut text, reflection, binding);
        }
        for pair in &reflection.combined_samplers {
            let [(g, b), (h, c)] = [pair.texture, pair.sampler];
            let name = &pair.name;
            let _ = writeln!(
                text,
                "`{name}`: the texture {g},{b} with the sampler {h},{c}"
            );
        }
        for block in reflection
            .blocks
            .iter()
            .filter(|block| block.slot.is_none())
        {
            let (name, size) = (&block.name, block.size);
            let _ = write!(text, "immediates (push constants)");
            if !name.is_empty() {
                let _ = write!(text, " `{name}`");
            }
            let _ = writeln!(text, ", {size} bytes");
            members(&mut text, &block.members);
        }
        for constant in &reflection.overrides {
            text.push_str(&constant_line(constant));
        }
    }
    text
}

fn varyings(text: &mut String, what: &str, list: &[Varying]) {
    for Varying {
        name,
        location,
        kind,
        is_flat,
        ..
    } in list
    {
        let _ = write!(text, "  {what} {location}: {kind}");
        if !name.is_empty() {
            let _ = write!(text, " `{name}`");
        }
        text.push_str(if *is_flat { ", flat\n" } else { "\n" });
    }
}

fn bound(text: &mut String, reflection: &Reflection, binding: &Binding) {
    let slot = (binding.group, binding.binding);
    let _ = write!(
        text,
        "binding {},{}: {}",
        slot.0,
        slot.1,
        kind(binding.kind)
    );
    if let Some(ty) = type_name(binding.kind) {
        let _ = write!(text, " {ty}");
    }
    if !binding.name.is_empty() {
        let _ = write!(text, " `{}`", binding.name);
    }
    match binding.count {
        Some(0) => text.push_str(", an array"),
        Some(count) => drop(write!(text, ", an array of {count}")),
        None => {}
    }
    if let BindingKind::UniformBuffer { min_size } | BindingKind::StorageBuffer { min_size, .. } =
        binding.kind
    {
        let _ = write!(text, ", {min_size} bytes");
    }
    let stages = names_of(binding.stages);
    if !stages.is_empty() {
        let _ = write!(text, ", {}", stages.join(" and "));
    }
    text.push('\n');
    let block = reflection
        .blocks
        .iter()
        .find(|block| block.slot == Some(slot));
    members(text, block.map_or(&[][..], |block| &block.members));
}

fn members(text: &mut String, members: &[UniformMember]) {
    for member in members {
        let (offset, kind, name) = (member.offset, member.kind, &member.name);
        let _ = write!(text, "  {offset:>5}: {kind} `{name}`");
        match member.array_length {
            Some(0) => drop(write!(text, ", every {} bytes", member.array_stride)),
            Some(length) => {
                let _ = write!(text, ", {length} times every {} bytes", member.array_stride);
            }
            None => {}
        }
        if let Some(words) = &member.initial_value {
            let scalar = member.kind.scalar();
            let numbers: Vec<_> = words.iter().map(|word| number(scalar, *word)).collect();
            let _ = write!(text, " = {}", numbers.join(", "));
        }
        text.push('\n');
    }
}

fn number(scalar: ScalarType, word: u32) -> String {
    match scalar {
        ScalarType::Bool => (word != 0).to_string(),
        ScalarType::F32 => f32::from_bits(word).to_string(),
        ScalarType::I32 => word.cast_signed().to_string(),
        _ => word.to_string(),
    }
}

fn constant_line(constant: &Override) -> String {
    let mut line = "constant".to_owned();
    if let Some(name) = &constant.name {
        let _ = write!(line, " `{name}`");
    }
    if let Some(id) = constant.id {
        let _ = write!(line, ", id {id}");
    }
    let _ = write!(line, ": {}", constant.kind.wgsl_name());
    match constant.default {
        None => line.push_str(", without a default\n"),
        Some(OverrideValue::Number(number)) => drop(writeln!(line, ", default {number}")),
        Some(OverrideValue::Expression) => line.push_str(", default an expression\n"),
    }
    line
}

/// The kind of a binding.
pub(super) fn kind(kind: BindingKind) -> &'static str {
    match kind {
        BindingKind::UniformBuffer { .. } => "uniform buffer",
        BindingKind::StorageBuffer {
            is_read_only: true, ..
        } => "read-only storage buffer",
        BindingKind::StorageBuffer { .. } => "storage buffer",
        BindingKind::Texture {
            is_multisampled: true,
            ..
        } => "multisampled texture",
        BindingKind::Texture { .. } => "texture",
        BindingKind::StorageTexture { .. } => "storage texture",
        BindingKind::Sampler {
            is_comparison: true,
        } => "comparison sampler",
        BindingKind::Sampler { .. } => "sampler",
        _ => "resource",
    }
}

/// The dimension and the texels of a texture.
pub(super) fn type_name(kind: BindingKind) -> Option<String> {
    let dimension = |dimension| match dimension {
        TextureDimension::D1 => "1d",
        TextureDimension::D1Array => "1d_array",
        TextureDimension::D2 => "2d",
        TextureDimension::D2Array => "2d_array",
        TextureDimension::D3 => "3d",
        TextureDimension::Cube => "cube",
        TextureDimension::CubeArray => "cube_array",
    };
    match kind {
        BindingKind::Texture {
            dimension: of,
            sample_type,
            ..
        } => {
            let texels = match sample_type {
                SampleType::Float { .. } => "f32",
                SampleType::Depth => "depth",
                SampleType::Sint => "i32",
                SampleType::Uint => "u32",
            };
            Some(format!("{} {texels}", dimension(of)))
        }
        BindingKind::StorageTexture {
            dimension: of,
            format,
            is_read,
            is_written,
        } => {
            let access = match (is_read, is_written) {
                (true, true) => "read and written",
                (true, false) => "read",
                _ => "written",
            };
            let format = format!("{format:?}").to_lowercase();
            Some(format!("{} {format}, {access}", dimension(of)))
        }
        _ => None,
    }
}

/// The names of stages.
pub(super) fn names_of(stages: Stages) -> Vec<&'static str> {
    let all = [
        (stages.vertex, ShaderStage::Vertex),
        (stages.fragment, ShaderStage::Fragment),
        (stages.compute, ShaderStage::Compute),
    ];
    let used = all.into_iter().filter(|(is_used, _)| *is_used);
    used.map(|(_, stage)| stage_name(stage)).collect()
}
