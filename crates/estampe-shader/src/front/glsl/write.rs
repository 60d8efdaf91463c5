//! Writing a shader as the GLSL of Vulkan that naga reads.
//!
//! Order: structures · the block of loose uniforms · variables in the author's order · functions ·
//! `main`. The author's `main` gets another name; the new one copies what naga cannot take as it is
//! from inputs and uniforms, sets global variables, calls the author's, and copies to the outputs.

use std::collections::HashMap;
use std::rc::Rc;

use estampe_ir::interface::Stage;

use super::super::reflect::Names;
use super::super::source::ClipSpace;
use super::Fault;
use super::atomics;
use super::body::Scopes;
use super::builtins;
use super::flow;
use super::gather::Gather;
use super::host::{Hosts, sizes};
use super::link::Locations;
use super::order;
use super::output::Output;
use super::prelude;
use super::resources::Resources;
use super::token::Place;
use super::types::{self, SamplerType, Type};
use super::unit::{Function, Item, Qualifiers, Storage, Unit, Variable};

/// The texture and sampler of a path, and their type.
#[derive(Debug, Clone)]
pub(super) struct Pair {
    pub texture: String,
    pub sampler: String,
    pub ty: SamplerType,
}

impl Pair {
    /// The texture with its sampler, as functions of the language take it.
    pub(super) fn combined(&self) -> String {
        let kind = self.ty.texture.replace("texture", "sampler");
        let shadow = if self.ty.is_shadow { "Shadow" } else { "" };
        format!("{kind}{shadow} ( {} , {} )", self.texture, self.sampler)
    }
}

/// A shader that is being written.
pub(super) struct Writer<'a> {
    pub index: usize,
    pub unit: &'a Unit,
    pub resources: &'a Resources,
    pub locations: &'a Locations,
    pub clip_space: ClipSpace,
    pub output: Output,
    pub names: Names,
    /// Combined textures and samplers by path.
    pub pairs: HashMap<String, Pair>,
    /// Uniforms that hold samplers, by name.
    pub roots: HashMap<Rc<str>, Type>,
    /// Members of blocks that are written without the block's instance, by both names.
    pub members: HashMap<(Rc<str>, Rc<str>), String>,
    /// What `main` does before and after the author's.
    pub before: Vec<(String, Option<Place>)>,
    after: Vec<(String, Option<Place>)>,
    pub invented: usize,
    /// The tokens of calls with samplers at computed indices.
    pub chosen_tokens: usize,
    /// What is gathered from textures.
    pub gathers: Vec<Gather>,
    /// What buffers hold of this shader's types, and of those of the shader before.
    pub own: Hosts<'a>,
    pub foreign: Hosts<'a>,
}

impl<'a> Writer<'a> {
    pub(super) fn new(
        units: &'a [Unit],
        index: usize,
        resources: &'a Resources,
        locations: &'a Locations,
        clip_space: ClipSpace,
    ) -> Self {
        let prefix = &units[index].prefix;
        let hosts = |structures, prefix, is_foreign| Hosts {
            structures,
            prefix,
            is_foreign,
            written: HashMap::new(),
            pads: 0,
        };
        Self {
            own: hosts(&units[index].structures, prefix.clone(), false),
            foreign: hosts(&units[0].structures, format!("{prefix}f_"), true),
            index,
            unit: &units[index],
            resources,
            locations,
            clip_space,
            output: Output::default(),
            names: Names::default(),
            pairs: HashMap::new(),
            roots: HashMap::new(),
            members: HashMap::new(),
            before: Vec::new(),
            after: Vec::new(),
            invented: 0,
            chosen_tokens: 0,
            gathers: Vec::new(),
        }
    }

    /// Writes the shader.
    pub(super) fn write(mut self) -> Result<(Output, Names), Fault> {
        let unit = self.unit;
        self.output.text.push_str("#version 450 core\n");
        for (name, place) in &unit.structures.order {
            self.structure(name, *place);
        }
        self.loose_uniforms()?;
        self.built_in_outputs();
        self.layouts();
        self.output.put(&prelude::functions(unit), None);
        self.output.put(&atomics::functions(unit), None);
        for item in &unit.items {
            match item {
                Item::Variable(variable) => self.variable(variable)?,
                Item::Block(block) => self.block(block)?,
                Item::Function(_) => {}
            }
        }
        self.gathers()?;
        for function in order::functions(unit) {
            self.function(function)?;
        }
        self.main()?;
        Ok((self.output, self.names))
    }

    /// A name that the author does not use.
    pub(super) fn invent(&mut self, what: &str) -> String {
        self.invented += 1;
        format!("{}{what}{}", self.unit.prefix, self.invented)
    }

    /// The author's name as naga takes it.
    pub(super) fn spell(&mut self, name: &str) -> String {
        spell(self.unit, &mut self.names, name)
    }

    fn structure(&mut self, name: &Rc<str>, place: Place) {
        let members = self.unit.structures.get(name).cloned().unwrap_or_default();
        self.output.put(&format!("struct {name} {{"), Some(place));
        let mut is_empty = true;
        for member in members.iter() {
            if types::sampler(&member.ty.name).is_some() {
                continue;
            }
            let spelled = self.spell(&member.name);
            let sizes = sizes(&member.ty.dimensions);
            let text = format!("{} {spelled} {sizes} ;", member.ty.name);
            self.output.put(&text, Some(member.place));
            is_empty = false;
        }
        if is_empty {
            self.output
                .put(&format!("float {}none ;", self.unit.prefix), None);
        }
        self.output.put("} ;", Some(place));
    }

    /// `gl_FragColor` and `gl_FragData`.
    fn built_in_outputs(&mut self) {
        let prefix = self.unit.prefix.clone();
        if self.unit.stage == Stage::Fragment && self.unit.used.contains("gl_FragColor") {
            let name = format!("{prefix}Color");
            self.output
                .put(&format!("layout ( location = 0 ) out vec4 {name} ;"), None);
            self.names.add(&name, "gl_FragColor");
        }
        if self.unit.stage == Stage::Fragment && self.unit.used.contains("gl_FragData") {
            let targets = super::indices::color_targets(self.unit);
            let count = targets.iter().next_back().map_or(1, |last| last + 1);
            self.output
                .put(&format!("vec4 {prefix}Colors [ {count} ] ;"), None);
            for target in targets {
                let name = format!("{prefix}Color{target}");
                let text = format!("layout ( location = {target} ) out vec4 {name} ;");
                self.output.put(&text, None);
                self.after
                    .push((format!("{name} = {prefix}Colors [ {target} ] ;"), None));
                self.names.add(&name, &format!("gl_FragData[{target}]"));
            }
        }
    }

    fn layouts(&mut self) {
        if self.unit.stage == Stage::Compute {
            let [x, y, z] = self.unit.workgroup_size;
            let text = format!(
                "layout ( local_size_x = {x} , local_size_y = {y} , local_size_z = {z} ) in ;"
            );
            self.output.put(&text, None);
        }
        if self.unit.has_early_tests {
            self.output
                .put("layout ( early_fragment_tests ) in ;", None);
        }
    }

    fn variable(&mut self, variable: &'a Variable) -> Result<(), Fault> {
        let place = Some(variable.place);
        let ty = &variable.ty;
        let name = self.spell(&variable.name);
        let declared = format!("{} {name} {}", ty.name, sizes(&ty.dimensions));
        match variable.qualifiers.storage() {
            Storage::Uniform => {
                self.initial_value(variable)?;
                self.uniform(variable)
            }
            Storage::In | Storage::Out => {
                self.between_stages(variable, &name, &declared);
                Ok(())
            }
            Storage::Shared => {
                self.output.put(&format!("shared {declared} ;"), place);
                Ok(())
            }
            Storage::Const => {
                let id = variable.qualifiers.value("constant_id");
                let layout = id.map_or(String::new(), |id| {
                    format!("layout ( constant_id = {id} ) ")
                });
                self.output
                    .put(&format!("{layout}const {declared} ="), place);
                self.rewrite(&variable.init, &mut Scopes::default())?;
                self.output.put(";", place);
                Ok(())
            }
            Storage::Private => {
                self.output.put(&format!("{declared} ;"), place);
                Ok(())
            }
            Storage::Buffer => Err(Fault::new(
                format!("the buffer `{}` is no block", variable.name),
                variable.place,
            )
            .help("write `buffer Name { … };`")),
        }
    }

    /// An input or output.
    fn between_stages(&mut self, variable: &Variable, name: &str, declared: &str) {
        let place = Some(variable.place);
        let leaves = self
            .locations
            .get(&variable.name)
            .map_or(&[][..], Vec::as_slice);
        let is_input = variable.qualifiers.storage() == Storage::In;
        let direction = if is_input { "in" } else { "out" };
        let qualifiers = interpolation(&variable.qualifiers);
        let index = match variable.qualifiers.value("index") {
            Some(index) => format!(" , index = {index}"),
            None => String::new(),
        };
        // A number or vector is declared as it is.
        if let [leaf] = leaves
            && let (Some(location), "") = (leaf.location, leaf.path.as_str())
        {
            let text = format!(
                "layout ( location = {location}{index} ) {qualifiers}{direction} {declared} ;"
            );
            self.output.put(&text, place);
            return;
        }
        self.output.put(&format!("{declared} ;"), place);
        for leaf in leaves {
            let Some(location) = leaf.location else {
                continue;
            };
            let invented = self.invent(direction);
            let ty = leaf.ty.glsl_name();
            let text = format!(
                "layout ( location = {location}{index} ) {qualifiers}{direction} {ty} {invented} ;"
            );
            self.output.put(&text, place);
            self.names
                .add(&invented, &format!("{}{}", variable.link_name, leaf.path));
            let path = leaf.path.replace('.', " . ");
            match is_input {
                true => self
                    .before
                    .push((format!("{name}{path} = {invented} ;"), place)),
                false => self
                    .after
                    .push((format!("{invented} = {name}{path} ;"), place)),
            }
        }
    }

    fn function(&mut self, function: &'a Function) -> Result<(), Fault> {
        let place = Some(function.place);
        let result = &function.result;
        let name = self.function_name(&function.name);
        let result = format!("{} {}", result.name, sizes(&result.dimensions));
        self.output.put(&format!("{result} {name} ("), place);
        let mut scopes = Scopes::default();
        scopes.open();
        for (index, parameter) in function.parameters.iter().enumerate() {
            let comma = if index > 0 { "," } else { "" };
            let ty = &parameter.ty;
            let place = Some(parameter.place);
            if let Some(sampler) = types::sampler(&ty.name).filter(|_| ty.dimensions.is_empty()) {
                let given = parameter.name.as_deref().unwrap_or("unnamed");
                let texture = format!("{}t{index}_{given}", self.unit.prefix);
                let own = format!("{}s{index}_{given}", self.unit.prefix);
                let text = format!(
                    "{comma} {} {texture} , {} {own}",
                    sampler.texture,
                    sampler.sampler()
                );
                self.output.put(&text, place);
                self.names.add(&texture, given);
                self.names.add(&own, given);
                let pair = Pair {
                    texture,
                    sampler: own,
                    ty: sampler,
                };
                scopes.add_sampler(given, pair);
                continue;
            }
            if self.unit.structures.has_sampler(ty) {
                let message = format!("`{}` holds samplers, which a parameter cannot", ty.shown());
                return Err(Fault::new(message, parameter.place)
                    .help("hand over each sampler as a parameter of its own"));
            }
            let spelled = match &parameter.name {
                Some(name) => {
                    scopes.add(name);
                    self.spell(name)
                }
                None => String::new(),
            };
            let direction = parameter.direction;
            let sizes = sizes(&ty.dimensions);
            let text = format!("{comma} {direction} {} {spelled} {sizes}", ty.name);
            self.output.put(&text, place);
        }
        if function.body.is_empty() {
            self.output.put(") ;", place);
            return Ok(());
        }
        self.output.put(")", place);
        let unit = self.unit;
        let body = flow::rewrite(unit, &function.body, &mut |what| self.invent(what));
        self.rewrite(&body, &mut scopes)
    }

    /// The name of a function: the author's `main` gets another one.
    pub(super) fn function_name(&mut self, name: &str) -> String {
        match name {
            "main" => {
                let name = format!("{}main", self.unit.prefix);
                self.names.add(&name, "main");
                name
            }
            name => self.spell(name),
        }
    }

    fn main(&mut self) -> Result<(), Fault> {
        let unit = self.unit;
        let has_main = unit.functions().any(|function| {
            &*function.name == "main" && function.parameters.is_empty() && !function.body.is_empty()
        });
        if !has_main {
            return Err(Fault::at("the shader has no `main`", None).help("add `void main() { … }`"));
        }
        self.output.put("void main ( ) {", None);
        for (text, place) in core::mem::take(&mut self.before) {
            self.output.put(&text, place);
        }
        for variable in unit.variables() {
            let is_private = variable.qualifiers.storage() == Storage::Private;
            if !is_private || variable.init.is_empty() {
                continue;
            }
            let place = Some(variable.place);
            let name = self.spell(&variable.name);
            let is_list = variable.init.first().is_some_and(|open| open.is("{"));
            let target = if is_list {
                self.invent("value")
            } else {
                name.clone()
            };
            if is_list {
                let sizes = sizes(&variable.ty.dimensions);
                self.output
                    .put(&format!("{} {target} {sizes}", variable.ty.name), place);
            } else {
                self.output.put(&target, place);
            }
            self.output.put("=", place);
            self.rewrite(&variable.init, &mut Scopes::default())?;
            self.output.put(";", place);
            if is_list {
                self.output.put(&format!("{name} = {target} ;"), place);
            }
        }
        self.output.put(&format!("{}main ( ) ;", unit.prefix), None);
        for (text, place) in core::mem::take(&mut self.after) {
            self.output.put(&text, place);
        }
        let writes_position = unit.stage == Stage::Vertex && unit.used.contains("gl_Position");
        if writes_position && self.clip_space == ClipSpace::OpenGl {
            let text = "gl_Position . z = ( gl_Position . z + gl_Position . w ) * 0.5 ;";
            self.output.put(text, None);
        }
        self.output.put("}", None);
        Ok(())
    }
}

/// The author's name as naga takes it.
pub(super) fn spell(unit: &Unit, names: &mut Names, name: &str) -> String {
    if !builtins::is_naga_word(unit, name) {
        return name.to_owned();
    }
    let spelled = format!("{}n_{name}", unit.prefix);
    names.add(&spelled, name);
    spelled
}

fn interpolation(qualifiers: &Qualifiers) -> String {
    qualifiers
        .interpolation
        .iter()
        .fold(String::new(), |all, word| format!("{all}{word} "))
}
