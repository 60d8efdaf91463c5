//! The contents of uniform blocks: values that are set by name, on the command line or by
//! themselves.

use super::values::{AnyValue, Slot, components, words};
use crate::failure::Failure;
use estampe::{Mat4, ScalarType, ShaderModule, UniformMember, Uniforms, ValueType};
use estampe_shader::front::BindingKind;

/// The uniform blocks of a module.
#[derive(Debug, Clone, Default)]
pub(crate) struct Blocks {
    blocks: Vec<(Slot, Uniforms)>,
}

impl Blocks {
    /// The blocks, all zeros.
    pub(crate) fn new(module: &ShaderModule) -> Self {
        let mut blocks: Vec<(Slot, Uniforms)> = Vec::new();
        for reflection in module.reflections() {
            for block in &reflection.blocks {
                let Some(slot) = block.slot else { continue };
                let is_uniform = reflection.bindings.iter().any(|binding| {
                    let is_uniform = matches!(binding.kind, BindingKind::UniformBuffer { .. });
                    is_uniform && (binding.group, binding.binding) == slot
                });
                let is_new = !blocks.iter().any(|(other, _)| *other == slot);
                // Blocks without names in SPIR-V may be others of the same name.
                let uniforms = module.uniforms(&block.name).ok();
                let uniforms = uniforms.filter(|found| found.block().slot == Some(slot));
                if let (true, true, Some(uniforms)) = (is_uniform, is_new, uniforms) {
                    blocks.push((slot, uniforms));
                }
            }
        }
        Self { blocks }
    }

    /// The bytes of the block at a binding.
    pub(crate) fn bytes(&self, slot: Slot) -> Option<&[u8]> {
        let found = self.blocks.iter().find(|(at, _)| *at == slot);
        found.map(|(_, uniforms)| uniforms.bytes())
    }

    /// These blocks, and those of another module.
    pub(crate) fn and(mut self, others: Self) -> Self {
        self.blocks.extend(others.blocks);
        self
    }

    /// Sets the uniforms of common names: `value` gives the value of a name in snake case without
    /// prefix.
    pub(crate) fn set_common(&mut self, value: impl Fn(&str) -> Option<Common>) {
        for (_, uniforms) in &mut self.blocks {
            for member in uniforms.block().members.clone() {
                let last = member.name.rsplit('.').next().unwrap_or_default();
                let value = value(&common(last)).filter(|_| member.array_length.is_none());
                if let Some(words) = value.and_then(|value| value.words(member.kind)) {
                    // The value has the type of the member.
                    let _ = uniforms.set(&member.name, AnyValue::new(member.kind, words));
                }
            }
        }
    }

    /// Sets a uniform by its name, in any block.
    pub(crate) fn set(&mut self, name: &str, text: &str) -> Result<(), Failure> {
        let usage = |message: String| Failure::Usage(format!("--set {name}: {message}"));
        let Some((at, member, element)) = self.find(name) else {
            let names = self.names();
            let there_are = if names.is_empty() {
                "it has none".to_owned()
            } else {
                format!("it has {}", names.join(", "))
            };
            let message = format!("the shader has no uniform `{name}`; {there_are}");
            return Err(usage(message));
        };
        let (scalar, count) = components(member.kind);
        let numbers_given: Option<Vec<Vec<u32>>> =
            text.split(',').map(|text| words(scalar, text)).collect();
        let elements = match member.array_length {
            Some(length) if !element => length as usize,
            _ => 1,
        };
        let numbers_given = numbers_given.filter(|given| given.len() == count * elements);
        let numbers_given = numbers_given.ok_or_else(|| {
            let kind = member.kind;
            let times = if elements > 1 {
                format!("{elements} times ")
            } else {
                String::new()
            };
            usage(format!(
                "`{text}` is no value of `{name}`, which is {times}{kind}: write {} with commas \
                 between",
                numbers(scalar, count * elements)
            ))
        })?;
        let uniforms = &mut self.blocks[at].1;
        for (index, numbers) in numbers_given.chunks(count).enumerate() {
            let path = if member.array_length.is_some() && !element {
                format!("{}[{index}]", member.name)
            } else {
                element_path(name, &member)
            };
            let value = AnyValue::new(member.kind, numbers.concat());
            uniforms
                .set(&path, value)
                .map_err(|error| usage(error.to_string()))?;
        }
        Ok(())
    }

    /// The block of a uniform, its member, and whether the name is that of an element of it.
    fn find(&self, name: &str) -> Option<(usize, UniformMember, bool)> {
        let element = name
            .strip_suffix(']')
            .and_then(|name| name.rsplit_once('['));
        for (at, (_, uniforms)) in self.blocks.iter().enumerate() {
            let block = uniforms.block();
            for member in &block.members {
                let full = format!("{}.{}", block.name, member.name);
                let is_named = |name: &str| name == member.name || name == full;
                if is_named(name) {
                    return Some((at, member.clone(), false));
                }
                let is_element = element.is_some_and(|(array, _)| is_named(array));
                if is_element && member.array_length.is_some() {
                    return Some((at, member.clone(), true));
                }
            }
        }
        None
    }

    fn names(&self) -> Vec<String> {
        let members = self.blocks.iter().flat_map(|(_, one)| &one.block().members);
        members.map(|member| format!("`{}`", member.name)).collect()
    }
}

/// The name of an element of a member, or of the member, without its block.
fn element_path(name: &str, member: &UniformMember) -> String {
    match name.rsplit_once('[') {
        Some((_, index)) if member.array_length.is_some() => format!("{}[{index}", member.name),
        _ => member.name.clone(),
    }
}

/// The value of a uniform that has one by itself.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Common {
    /// A number, or the first components of a vector.
    Numbers([f32; 4]),
    /// A matrix, or the upper left part of it.
    Matrix(Mat4),
}

impl Common {
    /// The words of the value as this type; `None` if it is another kind of value.
    fn words(self, kind: ValueType) -> Option<Vec<u32>> {
        let numbers = match (self, kind) {
            (Self::Numbers([first, ..]), ValueType::Scalar(ScalarType::F32 | ScalarType::F16)) => {
                vec![first]
            }
            (
                Self::Numbers(numbers),
                ValueType::Vector(ScalarType::F32 | ScalarType::F16, rows),
            ) => numbers[..usize::from(rows).min(4)].to_vec(),
            (
                Self::Matrix(matrix),
                ValueType::Matrix {
                    scalar: ScalarType::F32 | ScalarType::F16,
                    columns,
                    rows,
                },
            ) => {
                let columns = matrix.0.iter().take(usize::from(columns));
                columns
                    .flat_map(|column| column.iter().take(usize::from(rows)).copied())
                    .collect()
            }
            _ => return None,
        };
        Some(numbers.into_iter().map(f32::to_bits).collect())
    }
}

/// The value of a uniform that all pictures have.
#[expect(
    clippy::cast_precision_loss,
    reason = "the sides of a picture are at most 16384"
)]
pub(crate) fn of_picture(name: &str, time: f32, [width, height]: [u32; 2]) -> Option<Common> {
    let numbers = match name {
        "time" | "global_time" => [time, 0.0, 0.0, 0.0],
        "time_delta" => [1.0 / 60.0, 0.0, 0.0, 0.0],
        "frame_rate" => [60.0, 0.0, 0.0, 0.0],
        "resolution" => [width as f32, height as f32, 1.0, 1.0],
        "mouse" => [0.0; 4],
        _ => return None,
    };
    Some(Common::Numbers(numbers))
}

/// A name in snake case without the prefixes of shader toys and courses: `time` of `iTime`,
/// `u_time` and `uTime`, `model_view` of `modelView`.
fn common(name: &str) -> String {
    let rest = name.strip_prefix("u_").unwrap_or(name);
    let rest = rest
        .strip_prefix(['i', 'u'])
        .filter(|rest| rest.starts_with(char::is_uppercase))
        .unwrap_or(rest);
    let mut snake = String::new();
    for character in rest.chars() {
        if character.is_uppercase() && !snake.is_empty() && !snake.ends_with('_') {
            snake.push('_');
        }
        snake.extend(character.to_lowercase());
    }
    snake
}

/// `3 numbers`, in the words of the type.
fn numbers(scalar: ScalarType, count: usize) -> String {
    let plural = if count == 1 { "" } else { "s" };
    match scalar {
        ScalarType::Bool => format!("{count} of true and false"),
        ScalarType::I32 | ScalarType::I64 => format!("{count} integer{plural}"),
        ScalarType::U32 | ScalarType::U64 => format!("{count} integer{plural} of at least 0"),
        _ => format!("{count} number{plural}"),
    }
}

#[cfg(test)]
mod tests {
    use super::common;

    #[test]
    fn common_names_have_no_prefix() {
        for name in ["time", "u_time", "uTime", "iTime"] {
            assert_eq!(common(name), "time");
        }
        assert_eq!(common("iResolution"), "resolution");
        assert_eq!(common("uModelView_Matrix"), "model_view_matrix");
        assert_eq!(common("index"), "index");
        assert_eq!(common("u_"), "");
    }
}
