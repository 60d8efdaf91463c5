//! Reading variables, blocks and functions, and making variables of the blocks between stages.

use std::rc::Rc;

use super::Fault;
use super::declare::{Reader, row_major};
use super::token::{Place, Token};
use super::types::Type;
use super::unit::{Block, Function, Item, Qualifiers, Storage, Unit, Variable};

impl Reader<'_> {
    pub(super) fn block(&mut self, qualifiers: Qualifiers) -> Result<(), Fault> {
        let name = self.name()?;
        if !matches!(
            qualifiers.storage(),
            Storage::In | Storage::Out | Storage::Uniform | Storage::Buffer
        ) {
            return Err(
                Fault::new(format!("what is `{}` for?", name.text), name.place)
                    .help("write `struct`, `uniform`, `buffer`, `in` or `out` before it"),
            );
        }
        if let Some(word) = qualifiers.layout_word("row_major") {
            return Err(row_major(word.place));
        }
        let members = self.members()?;
        let mut instance = None;
        if !self.is_next(";") {
            instance = Some(self.name()?.text.clone());
            if let Some(open) = self.peek(0).filter(|open| open.is("[")) {
                let fault = Fault::new("arrays of blocks are not supported", open.place);
                return Err(fault.help("make one block with an array of structures"));
            }
        }
        self.expect(";")?;
        if name.text.starts_with("gl_") {
            return Ok(());
        }
        self.unit.items.push(Item::Block(Block {
            name: name.text.clone(),
            place: name.place,
            members,
            instance,
            qualifiers: Rc::new(qualifiers),
        }));
        Ok(())
    }

    pub(super) fn variables(&mut self, ty: Type, qualifiers: Qualifiers) -> Result<(), Fault> {
        let qualifiers = Rc::new(qualifiers);
        loop {
            let name = self.name()?;
            let mut dimensions = Vec::new();
            self.dimensions(&mut dimensions)?;
            dimensions.extend_from_slice(&ty.dimensions);
            let mut init = Vec::new();
            if self.skip("=") {
                init = self.until(&[",", ";"]).to_vec();
                if init.is_empty() {
                    return Err(self.expected("a value"));
                }
                self.note_uses(&init);
            }
            if let Some(size @ 0) = dimensions.first_mut() {
                *size = count_elements(&init).unwrap_or(0);
            }
            let variable = Variable {
                name: name.text.clone(),
                place: name.place,
                ty: Type {
                    name: ty.name.clone(),
                    dimensions,
                },
                qualifiers: Rc::clone(&qualifiers),
                init,
                link_name: name.text.to_string(),
            };
            self.check_variable(&variable)?;
            if name.text.starts_with("gl_") {
                if name.is("gl_ClipDistance") {
                    let size = variable.ty.dimensions.first().copied();
                    self.unit.clip_distances = size.unwrap_or(0);
                }
            } else {
                self.unit.items.push(Item::Variable(variable));
            }
            if !self.skip(",") {
                break;
            }
        }
        self.expect(";")?;
        Ok(())
    }

    /// Notes a constant integer, and refuses what cannot be.
    pub(super) fn check_variable(&mut self, variable: &Variable) -> Result<(), Fault> {
        let name = &variable.name;
        if &*variable.ty.name == "void" {
            return Err(Fault::new(
                format!("the variable `{name}` cannot be `void`"),
                variable.place,
            )
            .help("give it a type such as `float`"));
        }
        match variable.qualifiers.storage() {
            Storage::Const if !variable.qualifiers.has("constant_id") => {
                if variable.init.is_empty() {
                    return Err(Fault::new(
                        format!("the constant `{name}` has no value"),
                        variable.place,
                    )
                    .help("add `= …`"));
                }
                if matches!(&*variable.ty.name, "int" | "uint")
                    && variable.ty.dimensions.is_empty()
                    && let Ok(value) = self.constant(&variable.init, variable.place)
                {
                    self.unit.constants.insert(name.clone(), value);
                }
            }
            Storage::Uniform
                if !variable.init.is_empty() && self.unit.structures.has_sampler(&variable.ty) =>
            {
                return Err(Fault::new(
                    format!("the uniform `{name}` holds a texture, which cannot have a value"),
                    variable.place,
                )
                .help("remove `= …`, and bind the texture in the program"));
            }
            _ => {}
        }
        Ok(())
    }

    pub(super) fn function(&mut self, result: Type) -> Result<(), Fault> {
        let name = self.name()?;
        let parameters = self.parameters()?;
        let mut body = Vec::new();
        if !self.skip(";") {
            if !self.is_next("{") {
                return Err(self.expected("`{` or `;`"));
            }
            let start = self.at;
            self.at += 1;
            self.until(&["}"]);
            self.expect("}")?;
            body = self.tokens[start..self.at].to_vec();
            self.note_uses(&body);
        }
        self.unit.items.push(Item::Function(Function {
            name: name.text.clone(),
            place: name.place,
            result,
            parameters,
            body,
        }));
        Ok(())
    }

    pub(super) fn note_uses(&mut self, tokens: &[Token]) {
        let words = tokens.iter().filter(|token| token.is_word());
        self.unit.used.extend(words.map(|word| word.text.clone()));
    }
}

/// The elements of an initial value: of `{ … }`, or of the constructor of an array.
pub(super) fn count_elements(init: &[Token]) -> Option<u32> {
    let open = init
        .iter()
        .position(|token| token.is("{") || token.is("("))?;
    let mut depth = 0_u32;
    let mut count = 1_u32;
    let mut is_empty = true;
    for token in &init[open..] {
        match &*token.text {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => {
                depth = depth.saturating_sub(1);
                if depth == 0 {
                    break;
                }
            }
            "," if depth == 1 => {
                count += 1;
                is_empty = true;
                continue;
            }
            _ => {}
        }
        if !(depth == 1 && token.is("(")) {
            is_empty = false;
        }
    }
    // A comma may end a list in braces.
    Some(if is_empty { count - 1 } else { count })
}

/// Makes variables of the blocks between stages: of each member, or of the instance.
pub(super) fn flatten(mut unit: Unit) -> Result<Unit, Fault> {
    let items = core::mem::take(&mut unit.items);
    for item in items {
        let block = match item {
            Item::Block(block) => block,
            other => {
                unit.items.push(other);
                continue;
            }
        };
        let storage = block.qualifiers.storage();
        if !matches!(storage, Storage::In | Storage::Out) {
            unit.items.push(Item::Block(block));
            continue;
        }
        let variable = |name: &Rc<str>, place, ty, link_name| {
            Item::Variable(Variable {
                name: name.clone(),
                place,
                ty,
                qualifiers: Rc::clone(&block.qualifiers),
                init: Vec::new(),
                link_name,
            })
        };
        if let Some(instance) = &block.instance {
            let direction = if storage == Storage::In { "In" } else { "Out" };
            let name: Rc<str> = format!("{}{direction}{}", unit.prefix, block.name).into();
            let ty = Type {
                name: name.clone(),
                dimensions: Vec::new(),
            };
            let link_name = block.name.to_string();
            unit.items
                .push(variable(instance, block.place, ty, link_name));
            if !unit.structures.insert(name, block.place, block.members) {
                return Err(bad_structure(&block.name, block.place));
            }
        } else {
            for member in &block.members {
                let link_name = format!("{}.{}", block.name, member.name);
                let ty = member.ty.clone();
                unit.items
                    .push(variable(&member.name, member.place, ty, link_name));
            }
        }
    }
    Ok(unit)
}

pub(super) fn bad_structure(name: &str, place: Place) -> Fault {
    Fault::new(format!("`{name}` has no members, or too many"), place)
        .help("a structure or block needs at least one member")
}
