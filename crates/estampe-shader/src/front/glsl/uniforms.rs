//! Writing uniforms: the block of loose ones, textures and samplers, the author's blocks.

use std::rc::Rc;

use super::Fault;
use super::body::Scopes;
use super::host::{self, Held, sizes};
use super::opaque;
use super::token::Place;
use super::types::{self, Type};
use super::unit::{Block, Storage, Variable};
use super::write::{Pair, Writer, spell};

impl<'a> Writer<'a> {
    /// The block of the loose uniforms of all shaders up to this one.
    pub(super) fn loose_uniforms(&mut self) -> Result<(), Fault> {
        let resources = self.resources;
        let own = |name: &Rc<str>| {
            let mut variables = self.unit.variables();
            variables.find(|variable| {
                variable.name == *name && variable.qualifiers.storage() == Storage::Uniform
            })
        };
        let has_own = resources
            .loose
            .iter()
            .any(|loose| own(&loose.name).is_some());
        if !has_own {
            return Ok(());
        }
        // Later members are of the shaders after this one.
        let members = resources
            .loose
            .iter()
            .filter(|loose| loose.unit <= self.index);
        let members: Vec<_> = members.map(|loose| (loose, own(&loose.name))).collect();
        let mut text = Vec::new();
        let mut end = 0;
        for (loose, own) in members {
            let ty = own.map_or(&loose.ty, |variable| &variable.ty);
            let is_own = own.is_some() || loose.unit == self.index;
            let host = if is_own {
                &mut self.own
            } else {
                &mut self.foreign
            };
            let is_same = host::is_same(host.structures, ty);
            let invented = match own {
                Some(_) if is_same => spell(self.unit, &mut self.names, &loose.name),
                _ => format!("{}u_{}", self.unit.prefix, loose.name),
            };
            let place = own.map(|variable| variable.place);
            if own.is_some_and(|variable| !variable.init.is_empty()) {
                let constant = format!("{}initial_{}", self.unit.prefix, loose.name);
                self.names.add_initial(&invented, &constant);
            }
            let held = Held {
                name: &loose.name,
                invented: invented.clone(),
                ty,
                place,
            };
            text.extend(host.member_at(&held, &mut end, &mut self.output, &mut self.names));
            if let Some(variable) = own.filter(|_| !is_same) {
                let mut copies = Vec::new();
                let to = format!("{} {} {}", ty.name, variable.name, sizes(&ty.dimensions));
                self.output.put(&format!("{to} ;"), place);
                host.copy(&variable.name, &invented, ty, &mut copies)
                    .ok_or_else(|| too_large(&variable.name, variable.place))?;
                self.before
                    .extend(copies.into_iter().map(|copy| (copy, place)));
            }
        }
        let (group, binding) = resources.loose_slot;
        let block = format!("{}Uniforms", self.unit.prefix);
        self.names.add(&block, "");
        let open =
            format!("layout ( std140 , set = {group} , binding = {binding} ) uniform {block} {{");
        self.output.put(&open, None);
        for (member, place) in text {
            self.output.put(&member, place);
        }
        self.output.put("} ;", None);
        Ok(())
    }

    /// The value that a loose uniform begins with, as a constant that reflection reads.
    pub(super) fn initial_value(&mut self, variable: &'a Variable) -> Result<(), Fault> {
        if variable.init.is_empty() {
            return Ok(());
        }
        let place = Some(variable.place);
        let ty = &variable.ty;
        let name = format!("{}initial_{}", self.unit.prefix, variable.name);
        self.names.add(&name, &variable.name);
        let declared = format!("const {} {name} {} =", ty.name, sizes(&ty.dimensions));
        self.output.put(&declared, place);
        self.rewrite(&variable.init, &mut Scopes::default())?;
        self.output.put(";", place);
        Ok(())
    }

    /// A uniform that is not loose: textures, samplers, images.
    pub(super) fn uniform(&mut self, variable: &'a Variable) -> Result<(), Fault> {
        let place = Some(variable.place);
        let unit = self.unit;
        let ty = &variable.ty;
        if types::is_image(&ty.name) || types::is_separate(&ty.name) {
            let slot = self.resources.slots.get(&*variable.name);
            let (set, binding) = slot.copied().unwrap_or_default();
            let words = variable.qualifiers.layout.iter();
            let format = words
                .filter(|word| word.value.is_none())
                .fold(String::new(), |all, word| format!("{all} , {}", word.name));
            let memory = variable.qualifiers.memory.join(" ");
            let name = self.spell(&variable.name);
            let text = format!(
                "layout ( set = {set} , binding = {binding}{format} ) uniform {memory} {} {name} ;",
                ty.name
            );
            self.output.put(&text, place);
            return Ok(());
        }
        let leaves = opaque::leaves(unit, variable)?;
        if leaves.is_empty() {
            return Ok(());
        }
        for (path, sampler) in leaves {
            let Some(slots) = self.resources.combined.get(&path) else {
                continue;
            };
            let (texture, own) = (self.invent("texture"), self.invent("sampler"));
            let both = [
                (slots.texture, sampler.texture.as_str(), &texture),
                (slots.sampler, sampler.sampler(), &own),
            ];
            for ((set, binding), ty, name) in both {
                let text =
                    format!("layout ( set = {set} , binding = {binding} ) uniform {ty} {name} ;");
                self.output.put(&text, place);
                self.names.add(name, &path);
            }
            let pair = Pair {
                texture,
                sampler: own,
                ty: sampler,
            };
            self.pairs.insert(path, pair);
        }
        self.roots.insert(variable.name.clone(), ty.clone());
        Ok(())
    }

    /// A uniform or storage buffer.
    pub(super) fn block(&mut self, block: &'a Block) -> Result<(), Fault> {
        let place = Some(block.place);
        let is_pushed = block.qualifiers.has("push_constant");
        // Push constants are laid out as storage buffers, unless the text says otherwise.
        let is_std430 = is_pushed && !block.qualifiers.has("std140");
        let is_uniform = block.qualifiers.storage() == Storage::Uniform;
        let is_std140 = is_uniform && !is_std430;
        let slot = self
            .resources
            .slots
            .get(&*block.name)
            .copied()
            .unwrap_or_default();
        let layout = match (is_pushed, is_uniform) {
            (true, _) if is_std430 => "push_constant , std430".to_owned(),
            (true, _) => "push_constant , std140".to_owned(),
            (_, true) => format!("std140 , set = {} , binding = {}", slot.0, slot.1),
            _ => {
                let rules = if block.qualifiers.has("std140") {
                    "std140"
                } else {
                    "std430"
                };
                format!("{rules} , set = {} , binding = {}", slot.0, slot.1)
            }
        };
        let storage = if is_uniform { "uniform" } else { "buffer" };
        // naga has buffers that are read, and those that are written too.
        let memory = block.qualifiers.memory.iter();
        let memory = memory.filter(|word| &***word != "writeonly").cloned();
        let memory = memory.collect::<Vec<_>>().join(" ");
        let open = format!("layout ( {layout} ) {memory} {storage} {} {{", block.name);
        let structures = &self.unit.structures;
        let as_declared = |ty: &Type| match (is_std140, is_std430) {
            (true, _) => host::is_same(structures, ty),
            (_, true) => !host::is_bool(ty),
            _ => true,
        };
        if let Some(opaque) = block
            .members
            .iter()
            .find(|member| structures.has_sampler(&member.ty))
        {
            return Err(Fault::new("a block cannot hold samplers", opaque.place)
                .help("declare the sampler as a uniform outside of the block"));
        }
        let is_whole = block.members.iter().all(|member| as_declared(&member.ty));
        // Of an instance naga loads all members to read one, which a buffer's last one may forbid.
        let is_apart = !is_whole || !is_uniform;
        let copied = block.instance.clone().filter(|_| is_apart);
        let mut text = Vec::new();
        let (mut end, mut declared_end) = (0, 0);
        let mut copies = Vec::new();
        for member in &block.members {
            let is_same = as_declared(&member.ty);
            // What the author's functions see.
            let seen = match &copied {
                Some(instance) => {
                    let seen = format!("{}m_{}_{}", self.unit.prefix, block.name, member.name);
                    let path = (instance.clone(), member.name.clone());
                    self.members.insert(path, seen.clone());
                    seen
                }
                None => self.spell(&member.name),
            };
            let invented = match is_same {
                true => seen.clone(),
                false => format!("{}b_{}_{}", self.unit.prefix, block.name, member.name),
            };
            if !is_std430 {
                let is_std140 = is_std140 || block.qualifiers.has("std140");
                self.own
                    .check_offset(member, is_std140, &mut declared_end)?;
            }
            if is_std430
                && let Some(pad) = self.own.pad_to_offset(member, &mut end, &mut self.names)?
            {
                text.push((pad, None));
            }
            if is_std140 {
                let held = Held {
                    name: &member.name,
                    invented: invented.clone(),
                    ty: &member.ty,
                    place: Some(member.place),
                };
                text.extend(
                    self.own
                        .member_at(&held, &mut end, &mut self.output, &mut self.names),
                );
            } else {
                if copied.is_some() || !is_same {
                    self.names.add(&invented, &member.name);
                }
                let declared = if is_same {
                    let sizes = sizes(&member.ty.dimensions);
                    format!("{} {invented} {sizes}", member.ty.name)
                } else {
                    let (output, names) = (&mut self.output, &mut self.names);
                    self.own.ty(&member.ty, &invented, output, names)
                };
                text.push((format!("{declared} ;"), Some(member.place)));
            }
            if !is_same {
                let sizes = sizes(&member.ty.dimensions);
                let declared = format!("{} {seen} {sizes} ;", member.ty.name);
                self.output.put(&declared, Some(member.place));
                self.own
                    .copy(&seen, &invented, &member.ty, &mut copies)
                    .ok_or_else(|| too_large(&member.name, member.place))?;
            }
        }
        self.before
            .extend(copies.into_iter().map(|copy| (copy, place)));
        self.output.put(&open, place);
        for (member, place) in text {
            self.output.put(&member, place);
        }
        let instance = block.instance.as_deref().filter(|_| copied.is_none());
        let instance = instance.map(|name| self.spell(name)).unwrap_or_default();
        if !instance.is_empty() {
            self.names.add(&instance, &block.name);
        }
        self.output.put(&format!("}} {instance} ;"), place);
        Ok(())
    }
}

fn too_large(name: &str, place: Place) -> Fault {
    Fault::new(
        format!("`{name}` is too large to be copied from its buffer"),
        place,
    )
    .help("use `vec4` and `uint` in the place of `mat2` and `bool`")
}
