//! Numbers of bindings: one list for the shaders that are loaded together.

use std::collections::{HashMap, HashSet};

use super::Fault;
use super::opaque;
use super::types::{self, SamplerType, Type};
use super::unit::{Item, Qualifiers, Storage, Unit};

/// A loose uniform: its shader, its name and its type.
#[derive(Debug, Clone)]
pub(super) struct Loose {
    pub unit: usize,
    pub name: std::rc::Rc<str>,
    pub ty: Type,
}

/// What the shaders that are loaded together share.
#[derive(Debug, Default)]
pub(super) struct Resources {
    /// The loose uniforms of all shaders, in the order of the block.
    pub loose: Vec<Loose>,
    /// The group and binding of the block of loose uniforms.
    pub loose_slot: (u32, u32),
    /// The groups and bindings of blocks, images, and separate textures and samplers by name.
    pub slots: HashMap<String, (u32, u32)>,
    /// The groups and bindings of combined textures and samplers by path.
    pub combined: HashMap<String, Combined>,
}

/// The numbers of a combined texture and sampler.
#[derive(Debug, Clone)]
pub(super) struct Combined {
    pub texture: (u32, u32),
    pub sampler: (u32, u32),
    pub unit: Option<u32>,
    ty: SamplerType,
}

/// Numbers the resources of shaders. An error has the index of its shader.
pub(super) fn number(units: &[Unit], group: u32) -> Result<Resources, (usize, Fault)> {
    let mut numbers = Numbers {
        taken: HashSet::new(),
        next: HashMap::new(),
        group,
    };
    for unit in units.iter().filter(|unit| unit.is_vulkan) {
        numbers.take_explicit(unit);
    }
    let mut resources = Resources::default();
    for (index, unit) in units.iter().enumerate() {
        add_loose(units, index, unit, &mut resources).map_err(|fault| (index, fault))?;
    }
    if !resources.loose.is_empty() {
        resources.loose_slot = numbers.free(group);
    }
    for (index, unit) in units.iter().enumerate() {
        for item in &unit.items {
            add(unit, item, &mut numbers, &mut resources).map_err(|fault| (index, fault))?;
        }
    }
    Ok(resources)
}

fn add_loose(
    units: &[Unit],
    index: usize,
    unit: &Unit,
    resources: &mut Resources,
) -> Result<(), Fault> {
    for variable in unit.variables() {
        let is_uniform = variable.qualifiers.storage() == Storage::Uniform;
        if !is_uniform || !unit.structures.has_value(&variable.ty) {
            continue;
        }
        let known = resources
            .loose
            .iter()
            .find(|loose| loose.name == variable.name);
        let Some(known) = known else {
            resources.loose.push(Loose {
                unit: index,
                name: variable.name.clone(),
                ty: variable.ty.clone(),
            });
            continue;
        };
        let others = &units[known.unit].structures;
        if !unit.structures.is_same(&variable.ty, others, &known.ty) {
            return Err(Fault::new(
                format!(
                    "the uniform `{}` is `{}` here, but `{}` in the vertex shader",
                    variable.name,
                    variable.ty.shown(),
                    known.ty.shown()
                ),
                variable.place,
            )
            .help("declare it with one type in both, or rename one of them"));
        }
    }
    Ok(())
}

fn add(
    unit: &Unit,
    item: &Item,
    numbers: &mut Numbers,
    resources: &mut Resources,
) -> Result<(), Fault> {
    match item {
        Item::Block(block) => {
            let name = block.name.to_string();
            if !block.qualifiers.has("push_constant") {
                let slot = || numbers.slot(unit, &block.qualifiers);
                resources.slots.entry(name).or_insert_with(slot);
            }
        }
        Item::Variable(variable) if variable.qualifiers.storage() == Storage::Uniform => {
            if types::is_image(&variable.ty.name) || types::is_separate(&variable.ty.name) {
                if let Some(open) = variable.ty.dimensions.first() {
                    let message = format!("an array of {open} textures is not supported");
                    return Err(Fault::new(message, variable.place)
                        .help("use an array texture, such as `sampler2DArray`"));
                }
                let name = variable.name.to_string();
                let slot = || numbers.slot(unit, &variable.qualifiers);
                resources.slots.entry(name).or_insert_with(slot);
                return Ok(());
            }
            for (path, ty) in opaque::leaves(unit, variable)? {
                if let Some(known) = resources.combined.get(&path) {
                    if known.ty != ty {
                        return Err(Fault::new(
                            format!("the sampler `{path}` has another type in the vertex shader"),
                            variable.place,
                        )
                        .help("declare it with one type in both, or rename one of them"));
                    }
                    continue;
                }
                let texture = numbers.slot(unit, &variable.qualifiers);
                let sampler = numbers.free(texture.0);
                let named = variable
                    .qualifiers
                    .value("binding")
                    .filter(|_| !unit.is_vulkan);
                let combined = Combined {
                    texture,
                    sampler,
                    unit: named,
                    ty,
                };
                resources.combined.insert(path, combined);
            }
        }
        _ => {}
    }
    Ok(())
}

struct Numbers {
    /// Bindings that Vulkan's GLSL names.
    taken: HashSet<(u32, u32)>,
    /// The next binding of each group.
    next: HashMap<u32, u32>,
    group: u32,
}

impl Numbers {
    fn take_explicit(&mut self, unit: &Unit) {
        let of_variables = unit.variables().map(|variable| &variable.qualifiers);
        let of_blocks = unit.items.iter().filter_map(|item| match item {
            Item::Block(block) => Some(&block.qualifiers),
            _ => None,
        });
        for qualifiers in of_variables.chain(of_blocks) {
            if let Some(binding) = qualifiers.value("binding") {
                self.taken
                    .insert((qualifiers.value("set").unwrap_or(0), binding));
            }
        }
    }

    /// The slot that Vulkan's GLSL names, or the next free one.
    fn slot(&mut self, unit: &Unit, qualifiers: &Qualifiers) -> (u32, u32) {
        if !unit.is_vulkan {
            return self.free(self.group);
        }
        let set = qualifiers.value("set").unwrap_or(0);
        match qualifiers.value("binding") {
            Some(binding) => (set, binding),
            None => self.free(set),
        }
    }

    fn free(&mut self, group: u32) -> (u32, u32) {
        let next = self.next.entry(group).or_insert(0);
        while self.taken.contains(&(group, *next)) {
            *next += 1;
        }
        let binding = *next;
        *next += 1;
        (group, binding)
    }
}
