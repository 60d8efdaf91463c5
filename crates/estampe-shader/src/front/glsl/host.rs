//! Types of uniforms as buffers hold them, where naga cannot lay them out as std140 asks.
//!
//! | declared | in the buffer |
//! |---|---|
//! | `bool`, `bvec3` | `uint`, `uvec3` |
//! | `mat3x2` | three `vec2`, each in the room of a `vec4` |
//! | a structure of these, or one with an alignment below 16 bytes | another structure, padded |
//!
//! The author's variable is then one of the invocation, to which the buffer is copied when `main`
//! begins. Offsets are those of std140 (OpenGL 4.6, section 7.6.2.2).

use std::collections::HashMap;
use std::rc::Rc;

use super::super::reflect::{Names, Scalar, ValueType};
use super::Fault;
use super::output::Output;
use super::token::Place;
use super::types::{Member, Structures, Type, value_type};

/// The bytes of the vector to which std140 aligns arrays and structures.
const VEC4: u32 = 16;

/// The bytes of a number, to which std430 aligns them at least.
const NUMBER: u32 = 4;

/// The largest offset of a member, so that no text makes a block of gigabytes.
const MOST_OFFSET: u32 = 1 << 16;

/// True if the buffer holds the type as the author declares it.
pub(super) fn is_same(structures: &Structures, ty: &Type) -> bool {
    match (structures.get(&ty.name), value_type(&ty.name)) {
        (Some(members), _) => {
            let mut held = members
                .iter()
                .filter(|member| structures.has_value(&member.ty));
            natural_align(structures, &bare(&ty.name)) >= VEC4
                && held.all(|member| is_same(structures, &member.ty))
        }
        (None, Some(ValueType::Scalar(scalar) | ValueType::Vector(scalar, _))) => {
            scalar != Scalar::Bool
        }
        (None, Some(ValueType::Matrix { rows, .. })) => rows != 2,
        (None, None) => true,
    }
}

/// True for truth values, vectors of them, and arrays of these.
pub(super) fn is_bool(ty: &Type) -> bool {
    matches!(
        value_type(&ty.name),
        Some(ValueType::Scalar(Scalar::Bool) | ValueType::Vector(Scalar::Bool, _))
    )
}

/// The type of a structure alone.
fn bare(name: &Rc<str>) -> Type {
    Type {
        name: name.clone(),
        dimensions: Vec::new(),
    }
}

/// The alignment that naga gives: that of the members, without rounding up for structures.
fn natural_align(structures: &Structures, ty: &Type) -> u32 {
    if !ty.dimensions.is_empty() {
        return VEC4;
    }
    match structures.get(&ty.name) {
        Some(members) => {
            let aligns = members
                .iter()
                .map(|member| natural_align(structures, &member.ty));
            aligns.max().unwrap_or(4)
        }
        None => layout(structures, ty, VEC4).0,
    }
}

/// The alignment and size of a type. Samplers take no room. `least` is the least alignment of
/// arrays, structures and columns: that of a `vec4` in std140, of a number in std430.
fn layout(structures: &Structures, ty: &Type, least: u32) -> (u32, u32) {
    if let Some(&size) = ty.dimensions.first() {
        let (align, element) = layout(structures, &ty.element(), least);
        let align = align.max(least);
        let stride = element.next_multiple_of(align);
        return (align, stride.saturating_mul(size));
    }
    if let Some(members) = structures.get(&ty.name) {
        let mut end = 0_u32;
        let mut align = least;
        for member in members.iter() {
            let (own, size) = layout(structures, &member.ty, least);
            align = align.max(own);
            end = aligned(end, own).saturating_add(size);
        }
        return (align, aligned(end, align));
    }
    match value_type(&ty.name) {
        Some(ValueType::Scalar(_)) => (4, 4),
        Some(ValueType::Vector(_, size)) => {
            let size = u32::from(size);
            (4 * size.next_power_of_two(), 4 * size)
        }
        Some(ValueType::Matrix { columns, rows, .. }) => {
            let column = (4 * u32::from(rows).next_power_of_two()).max(least);
            (column, column * u32::from(columns))
        }
        None => (1, 0),
    }
}

fn aligned(end: u32, align: u32) -> u32 {
    end.checked_next_multiple_of(align).unwrap_or(u32::MAX)
}

/// Writes declarations of what buffers hold.
pub(super) struct Hosts<'a> {
    pub structures: &'a Structures,
    /// What begins invented names.
    pub prefix: String,
    /// True if the structures are those of another shader, and declared nowhere.
    pub is_foreign: bool,
    /// The structures that are written, and their names.
    pub written: HashMap<Rc<str>, String>,
    pub pads: usize,
}

/// A member of a block.
pub(super) struct Held<'a> {
    /// The author's name, and the name in the rewritten text.
    pub name: &'a str,
    pub invented: String,
    pub ty: &'a Type,
    pub place: Option<Place>,
}

impl Hosts<'_> {
    /// A member of a block after `end` bytes, with what pads it. Structures that it needs are
    /// written to `output` before.
    pub(super) fn member_at(
        &mut self,
        member: &Held<'_>,
        end: &mut u32,
        output: &mut Output,
        names: &mut Names,
    ) -> Vec<(String, Option<Place>)> {
        let mut text = Vec::new();
        if !self.structures.has_value(member.ty) {
            return text;
        }
        let (align, size) = layout(self.structures, member.ty, VEC4);
        self.pad(
            end,
            align,
            natural_align(self.structures, member.ty),
            &mut text,
            names,
        );
        *end = aligned(*end, align).saturating_add(size);
        if member.invented != member.name {
            names.add(&member.invented, member.name);
        }
        let ty = self.ty(member.ty, &member.invented, output, names);
        text.push((format!("{ty} ;"), member.place));
        text
    }

    /// What brings a member of a block in std430 to the byte that `layout(offset = …)` says;
    /// nothing without. `end` is that of the member before, and becomes that of the member.
    pub(super) fn pad_to_offset(
        &mut self,
        member: &Member,
        end: &mut u32,
        names: &mut Names,
    ) -> Result<Option<String>, Fault> {
        let (align, size) = layout(self.structures, &member.ty, NUMBER);
        let natural = aligned(*end, align);
        let offset = member.offset.unwrap_or(natural);
        if offset < natural || !offset.is_multiple_of(align) || offset > MOST_OFFSET {
            let message = format!("`{}` cannot begin at byte {offset}", member.name);
            return Err(Fault::new(message, member.place).help(format!(
                "the member before it ends at byte {end}, and its offset is a multiple of {align} \
                 and at most {MOST_OFFSET}"
            )));
        }
        let numbers = (offset - *end) / NUMBER;
        *end = offset.saturating_add(size);
        if offset == natural {
            return Ok(None);
        }
        let name = format!("{}pad{}", self.prefix, self.pads);
        self.pads += 1;
        names.hide(&name);
        Ok(Some(format!("float {name} [ {numbers} ] ;")))
    }

    /// Refuses `layout(offset = …)` that leaves a gap: only push constants have such. `end` is
    /// that of the member before, and becomes that of the member.
    pub(super) fn check_offset(
        &self,
        member: &Member,
        is_std140: bool,
        end: &mut u32,
    ) -> Result<(), Fault> {
        let least = if is_std140 { VEC4 } else { NUMBER };
        let (align, size) = layout(self.structures, &member.ty, least);
        let natural = aligned(*end, align);
        *end = natural.saturating_add(size);
        match member.offset {
            Some(offset) if offset != natural => {
                let name = &member.name;
                let message = format!("`{name}` begins at byte {natural}, not at byte {offset}");
                Err(Fault::new(message, member.place)
                    .help("leave `offset` out, and declare members for the gap"))
            }
            _ => Ok(()),
        }
    }

    /// Adds numbers until `end` is a multiple of `align`, if naga aligns to less.
    fn pad(
        &mut self,
        end: &mut u32,
        align: u32,
        natural: u32,
        text: &mut Vec<(String, Option<Place>)>,
        names: &mut Names,
    ) {
        if natural >= align {
            return;
        }
        while !end.is_multiple_of(align) && *end < u32::MAX - VEC4 {
            let name = format!("{}pad{}", self.prefix, self.pads);
            self.pads += 1;
            names.hide(&name);
            text.push((format!("float {name} ;"), None));
            *end += 4;
        }
    }

    /// The declaration of a member: its type, name and sizes.
    pub(super) fn ty(
        &mut self,
        ty: &Type,
        name: &str,
        output: &mut Output,
        names: &mut Names,
    ) -> String {
        let sizes = sizes(&ty.dimensions);
        if self.structures.get(&ty.name).is_some() {
            let structure = self.structure(&ty.name, output, names);
            return format!("{structure} {name} {sizes}");
        }
        let value = value_type(&ty.name);
        let text = match value {
            Some(ValueType::Scalar(Scalar::Bool)) => format!("uint {name} {sizes}"),
            Some(ValueType::Vector(Scalar::Bool, size)) => format!("uvec{size} {name} {sizes}"),
            Some(ValueType::Matrix {
                columns, rows: 2, ..
            }) => {
                format!("vec2 {name} [ {} ]", columns_of(ty, columns))
            }
            _ => return format!("{} {name} {sizes}", ty.name),
        };
        if let Some(value) = value {
            names.add_type(name, value);
        }
        text
    }

    /// The name of a structure in buffers.
    fn structure(&mut self, name: &Rc<str>, output: &mut Output, names: &mut Names) -> String {
        let ty = bare(name);
        if !self.is_foreign && is_same(self.structures, &ty) {
            return name.to_string();
        }
        if let Some(written) = self.written.get(name) {
            return written.clone();
        }
        let members: Rc<[Member]> = self.structures.get(name).cloned().unwrap_or_default();
        let held: Vec<Held<'_>> = members
            .iter()
            .map(|member| Held {
                name: &member.name,
                invented: self.member(name, &member.name),
                ty: &member.ty,
                place: Some(member.place).filter(|_| !self.is_foreign),
            })
            .collect();
        let invented = format!("{}h_{name}", self.prefix);
        self.written.insert(name.clone(), invented.clone());
        let mut text = Vec::new();
        let mut end = 0;
        for member in &held {
            text.extend(self.member_at(member, &mut end, output, names));
        }
        // The size is a multiple of 16 bytes.
        self.pad(
            &mut end,
            VEC4,
            natural_align(self.structures, &ty),
            &mut text,
            names,
        );
        output.put(&format!("struct {invented} {{"), None);
        for (member, place) in text {
            output.put(&member, place);
        }
        output.put("} ;", None);
        names.add(&invented, name);
        invented
    }

    /// The name of a member of a structure in buffers.
    fn member(&self, structure: &str, member: &str) -> String {
        format!("{}h_{structure}_{member}", self.prefix)
    }

    /// Statements that copy from the buffer to the author's variable.
    pub(super) fn copy(
        &self,
        to: &str,
        from: &str,
        ty: &Type,
        text: &mut Vec<String>,
    ) -> Option<()> {
        if text.len() > MOST_COPIES {
            return None;
        }
        let value = value_type(&ty.name);
        if let (
            Some(ValueType::Matrix {
                columns, rows: 2, ..
            }),
            true,
        ) = (value, ty.dimensions.len() <= 1)
        {
            let count = ty.dimensions.first().copied().unwrap_or(1);
            for index in 0..count {
                let first = index.checked_mul(u32::from(columns))?;
                let parts =
                    (0..u32::from(columns)).map(|column| format!("{from} [ {} ]", first + column));
                let parts = parts.collect::<Vec<_>>().join(" , ");
                let to = match ty.dimensions.len() {
                    0 => to.to_owned(),
                    _ => format!("{to} [ {index} ]"),
                };
                text.push(format!("{to} = {} ( {parts} ) ;", ty.name));
                if text.len() > MOST_COPIES {
                    return None;
                }
            }
            return Some(());
        }
        if let Some(&size) = ty.dimensions.first() {
            let element = ty.element();
            for index in 0..size {
                self.copy(
                    &format!("{to} [ {index} ]"),
                    &format!("{from} [ {index} ]"),
                    &element,
                    text,
                )?;
            }
            return Some(());
        }
        let Some(members) = self
            .structures
            .get(&ty.name)
            .filter(|_| !is_same(self.structures, ty))
        else {
            text.push(match value {
                Some(ValueType::Scalar(Scalar::Bool) | ValueType::Vector(Scalar::Bool, _)) => {
                    format!("{to} = {} ( {from} ) ;", ty.name)
                }
                _ => format!("{to} = {from} ;"),
            });
            return Some(());
        };
        for member in members
            .iter()
            .filter(|member| self.structures.has_value(&member.ty))
        {
            let from = format!("{from} . {}", self.member(&ty.name, &member.name));
            self.copy(&format!("{to} . {}", member.name), &from, &member.ty, text)?;
        }
        Some(())
    }
}

/// The most statements that copy a uniform.
const MOST_COPIES: usize = 4096;

/// The vectors of two of a matrix or an array of matrices.
fn columns_of(ty: &Type, columns: u8) -> u32 {
    let elements = ty
        .dimensions
        .iter()
        .fold(1_u32, |all, size| all.saturating_mul(*size));
    elements.saturating_mul(u32::from(columns))
}

/// The sizes of an array as naga reads them: it takes the first as the innermost.
pub(super) fn sizes(dimensions: &[u32]) -> String {
    let sizes = dimensions.iter().rev().map(|size| match size {
        0 => "[ ]".to_owned(),
        size => format!("[ {size} ]"),
    });
    sizes.collect::<Vec<_>>().join(" ")
}
