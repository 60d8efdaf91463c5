//! Combined textures and samplers in uniforms: alone, in arrays and in structures.

use super::Fault;
use super::types::{self, SamplerType, Type};
use super::unit::{Unit, Variable};

/// The most textures of a uniform.
const MOST_TEXTURES: usize = 128;

/// The combined textures and samplers in a uniform, by path: `tex`, `maps[2]`, `material.diffuse`.
pub(super) fn leaves(
    unit: &Unit,
    variable: &Variable,
) -> Result<Vec<(String, SamplerType)>, Fault> {
    let mut found = Vec::new();
    add(unit, &variable.ty, variable.name.to_string(), &mut found).ok_or_else(|| {
        Fault::new(
            format!(
                "the uniform `{}` has more than {MOST_TEXTURES} textures",
                variable.name
            ),
            variable.place,
        )
        .help("use an array texture, such as `sampler2DArray`")
    })?;
    Ok(found)
}

fn add(unit: &Unit, ty: &Type, path: String, found: &mut Vec<(String, SamplerType)>) -> Option<()> {
    if !unit.structures.has_sampler(ty) {
        return Some(());
    }
    if let Some(&size) = ty.dimensions.first() {
        let element = ty.element();
        for index in 0..size {
            add(unit, &element, format!("{path}[{index}]"), found)?;
        }
    } else if let Some(sampler) = types::sampler(&ty.name) {
        found.push((path, sampler));
    } else if let Some(members) = unit.structures.get(&ty.name) {
        for member in members.iter() {
            add(unit, &member.ty, format!("{path}.{}", member.name), found)?;
        }
    }
    (found.len() <= MOST_TEXTURES).then_some(())
}
