//! Reading qualifiers and parameters.

use super::super::suggest;
use super::Fault;
use super::declare::Reader;
use super::token::Token;
use super::types::Type;
use super::unit::{LayoutWord, Parameter, Qualifiers, Storage};
use estampe_ir::interface::Stage;

/// The words of `layout(…)` that are read, and those that change nothing.
const LAYOUT_WORDS: &[&str] = &[
    "location",
    "component",
    "index",
    "binding",
    "set",
    "offset",
    "align",
    "std140",
    "std430",
    "shared",
    "packed",
    "column_major",
    "row_major",
    "push_constant",
    "constant_id",
    "local_size_x",
    "local_size_y",
    "local_size_z",
    "early_fragment_tests",
    "origin_upper_left",
    "pixel_center_integer",
    "depth_any",
    "depth_greater",
    "depth_less",
    "depth_unchanged",
    "rgba32f",
    "rgba16f",
    "rg32f",
    "rg16f",
    "r11f_g11f_b10f",
    "r32f",
    "r16f",
    "rgba16",
    "rgb10_a2",
    "rgba8",
    "rg16",
    "rg8",
    "r16",
    "r8",
    "rgba16_snorm",
    "rgba8_snorm",
    "rg16_snorm",
    "rg8_snorm",
    "r16_snorm",
    "r8_snorm",
    "rgba32i",
    "rgba16i",
    "rgba8i",
    "rg32i",
    "rg16i",
    "rg8i",
    "r32i",
    "r16i",
    "r8i",
    "rgba32ui",
    "rgba16ui",
    "rgb10_a2ui",
    "rgba8ui",
    "rg32ui",
    "rg16ui",
    "rg8ui",
    "r32ui",
    "r16ui",
    "r8ui",
];

impl<'a> Reader<'a> {
    /// The qualifiers before a declaration.
    pub(super) fn qualifiers(&mut self) -> Result<Qualifiers, Fault> {
        let mut found = Qualifiers::default();
        while let Some(token) = self.peek(0) {
            let storage = match &*token.text {
                "layout" => {
                    found.place.get_or_insert(token.place);
                    self.at += 1;
                    self.layout(&mut found)?;
                    continue;
                }
                "in" | "attribute" => Some(Storage::In),
                "out" => Some(Storage::Out),
                "varying" if self.unit.stage == Stage::Vertex => Some(Storage::Out),
                "varying" => Some(Storage::In),
                "uniform" => Some(Storage::Uniform),
                "const" => Some(Storage::Const),
                "shared" => Some(Storage::Shared),
                "buffer" if !self.is_name() => Some(Storage::Buffer),
                "flat" | "smooth" | "noperspective" | "centroid" => {
                    found.interpolation.push(token.text.clone());
                    None
                }
                "sample" if !self.is_name() => {
                    found.interpolation.push(token.text.clone());
                    None
                }
                "readonly" | "writeonly" if !self.is_name() => {
                    found.memory.push(token.text.clone());
                    None
                }
                "lowp" | "mediump" | "highp" | "invariant" => None,
                "precise" | "restrict" | "volatile" | "coherent" if !self.is_name() => None,
                "patch" | "subroutine" if !self.is_name() => {
                    return Err(Fault::new(
                        format!("`{}` is not supported", token.text),
                        token.place,
                    )
                    .help("use vertex, fragment and compute shaders without it"));
                }
                _ => break,
            };
            found.place.get_or_insert(token.place);
            self.at += 1;
            let Some(storage) = storage else {
                continue;
            };
            if found.storage.is_some_and(|(first, _)| first != storage) {
                let message = format!("`{}` does not go with the qualifier before", token.text);
                return Err(Fault::new(message, token.place).help("remove one of them"));
            }
            found.storage = Some((storage, token.place));
        }
        Ok(found)
    }

    /// True if the next word, a keyword of later versions, is used as a name.
    fn is_name(&self) -> bool {
        self.peek(1).is_some_and(|next| !next.is_word())
    }

    fn layout(&mut self, found: &mut Qualifiers) -> Result<(), Fault> {
        self.expect("(")?;
        loop {
            let Some(name) = self.peek(0).filter(|name| name.is_word()) else {
                return Err(self.expected("a word of `layout`"));
            };
            self.at += 1;
            if !LAYOUT_WORDS.contains(&&*name.text) {
                let message = format!("`layout` has no word `{}`", name.text);
                let fault = Fault::new(message, name.place);
                return Err(
                    match suggest::nearest(&name.text, LAYOUT_WORDS.iter().copied()) {
                        Some(near) => fault.help(format!("did you mean `{near}`?")),
                        None => fault.help("remove it"),
                    },
                );
            }
            let mut value = None;
            if self.skip("=") {
                let start = self.at;
                let inside = self.argument();
                let number = self.constant(inside, name.place)?;
                if !(0..=i64::from(u16::MAX)).contains(&number) {
                    let place = self
                        .tokens
                        .get(start)
                        .map_or(name.place, |first| first.place);
                    return Err(
                        Fault::new(format!("`{}` cannot be {number}", name.text), place)
                            .help("use 0 to 65535"),
                    );
                }
                value = Some(number);
            }
            found.layout.push(LayoutWord {
                name: name.text.clone(),
                value,
                place: name.place,
            });
            if !self.skip(",") {
                break;
            }
        }
        self.expect(")")?;
        Ok(())
    }

    /// The tokens up to a comma or the end of the brackets.
    fn argument(&mut self) -> &'a [Token] {
        let start = self.at;
        let mut depth = 0_usize;
        while let Some(token) = self.peek(0) {
            match &*token.text {
                "," | ")" if depth == 0 => break,
                "(" => depth += 1,
                ")" => depth -= 1,
                _ => {}
            }
            self.at += 1;
        }
        &self.tokens[start..self.at]
    }

    /// The parameters of a function, with the brackets.
    pub(super) fn parameters(&mut self) -> Result<Vec<Parameter>, Fault> {
        let open = self.expect("(")?.place;
        let mut parameters = Vec::new();
        if self.is_next("void") && self.peek(1).is_some_and(|close| close.is(")")) {
            self.at += 1;
        }
        if self.skip(")") {
            return Ok(parameters);
        }
        loop {
            let start = self.peek(0).map_or(open, |token| token.place);
            let mut direction = "";
            while let Some(token) = self.peek(0) {
                match &*token.text {
                    "const" => direction = "const",
                    "in" if direction.is_empty() => direction = "in",
                    "in" => {}
                    "out" => direction = "out",
                    "inout" => direction = "inout",
                    "lowp" | "mediump" | "highp" | "precise" | "restrict" | "volatile"
                    | "coherent" | "readonly" | "writeonly" => {}
                    _ => break,
                }
                self.at += 1;
            }
            let mut ty = self.ty()?;
            let mut name = None;
            let mut place = start;
            if !self.is_next(",") && !self.is_next(")") {
                let found = self.name()?;
                let mut dimensions = Vec::new();
                self.dimensions(&mut dimensions)?;
                dimensions.extend_from_slice(&ty.dimensions);
                ty = Type {
                    name: ty.name,
                    dimensions,
                };
                name = Some(found.text.clone());
                place = found.place;
            }
            parameters.push(Parameter {
                direction,
                ty,
                name,
                place,
            });
            if !self.skip(",") {
                break;
            }
        }
        self.expect(")")?;
        Ok(parameters)
    }
}
