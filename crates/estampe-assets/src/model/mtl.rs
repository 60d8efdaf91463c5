//! MTL: the material libraries of OBJ.
//!
//! Read: `Kd`, `Ks`, `Ke` (one value means grey), `Ns`, `d`, `Tr`, `illum`, `map_Kd`, `map_d`,
//! `map_Bump` or `bump` with its multiplier `-bm`.
//! Colours are treated as sRGB-encoded, as modelling programs display them, and become linear. `Ka`
//! is known and ignored, because ambient light belongs to the scene. One warning reports the other
//! maps, which are not drawn.
//!
//! If both are present, `d` overrides `Tr`. `Tr 1` alone would make the material invisible; old
//! exporters use it for opaque materials, so it is read as opaque, with a warning. A texture whose
//! `Kd` is missing or black is drawn as if `Kd` were white, because black would hide the texture,
//! which nobody intends.
//!
//! The alpha of `map_Kd` counts only in a material that `d`, `Tr` or `map_d` makes transparent
//! ([`TextureAlpha`] overrides this): many textures have an alpha that means something else.
//! `Ns` below 1, which exporters write for "no highlight", would spread the highlight over the
//! whole surface; it removes the highlight.
//!
//! Source: "MTL material format (Lightwave, OBJ)", Wavefront 1995; P. Bourke's copy.

use super::deferred::AlphaRule;
use super::encoding::utf8_from_utf16;
use super::load::Context;
use super::options::TextureAlpha;
use super::srgb::linear_from_srgb;
use super::statements::Statements;
use super::textures::{TextureName, Textures, text_of_name};
use crate::Location;
use estampe_scene::{AlphaMode, Material};
use glam::Vec3;
use std::collections::HashMap;

/// A material's name in the model, and the location of its first use.
#[derive(Debug, Clone, Copy)]
pub(super) struct MaterialUse<'a> {
    pub(super) name: &'a [u8],
    pub(super) location: Location,
}

/// The materials that the model can use.
#[derive(Debug, Default)]
pub(super) struct Library {
    pub(super) materials: Vec<Material>,
    /// The material index of each use.
    pub(super) of_use: Vec<Option<usize>>,
}

/// A material with the names of its textures.
#[derive(Debug, Default)]
struct Draft {
    material: Material,
    has_base_color: bool,
    dissolve: Option<f32>,
    transparency: Option<f32>,
    /// Number of the illumination model.
    illumination: Option<f32>,
    /// `Ns` is below 1.
    has_no_highlight: bool,
    base_color_map: Option<TextureName>,
    opacity_map: Option<TextureName>,
    bump_map: Option<Map>,
}

/// A texture of a material with the options that are read.
#[derive(Debug)]
struct Map {
    name: TextureName,
    /// `-bm`: the factor of a bump map's heights.
    bump_multiplier: Option<f32>,
}

/// An opened library file.
struct Source<'a> {
    /// The name as spelled in the model.
    name: &'a str,
    bytes: &'a [u8],
}

/// Reads the libraries, in order, and the textures of the materials that are used. `uses[0]` means
/// "no material".
pub(super) fn load(
    libraries: &[(&[u8], Location)],
    uses: &[MaterialUse<'_>],
    context: &mut Context<'_>,
) -> Library {
    let mut drafts = Vec::new();
    let mut by_name = HashMap::new();
    let mut opened = Vec::new();
    for &(names, location) in libraries {
        for (name, resolved) in find_libraries(names, location, context) {
            if opened.contains(&resolved) {
                continue;
            }
            match context.read_side_file(&resolved) {
                Ok(bytes) => {
                    let bytes = utf8_from_utf16(&bytes).unwrap_or(bytes);
                    let source = Source {
                        name: &name,
                        bytes: &bytes,
                    };
                    parse_library(&source, &mut drafts, &mut by_name, context);
                }
                Err(error) => warn_library(&name, &error.to_string(), location, context),
            }
            opened.push(resolved);
        }
    }
    let of_use: Vec<Option<usize>> = uses
        .iter()
        .map(|one| by_name.get(one.name).copied())
        .collect();
    for (one, found) in uses.iter().zip(&of_use).skip(1) {
        if found.is_none() {
            context.warnings.add(context.name, one.location, || {
                let name = text_of_name(one.name);
                format!("no library defines the material `{name}`; the default is used")
            });
        }
    }
    let mut is_used = vec![false; drafts.len()];
    for &index in of_use.iter().flatten() {
        is_used[index] = true;
    }
    let mut textures = Textures::default();
    let drafts = drafts.into_iter().zip(is_used).enumerate();
    let materials = drafts
        .map(|(at, (draft, is_used))| draft.finish(at, is_used, &mut textures, context))
        .collect();
    Library { materials, of_use }
}

/// The files named by `mtllib`: one name with blanks, or several names.
fn find_libraries(
    names: &[u8],
    location: Location,
    context: &mut Context<'_>,
) -> Vec<(String, String)> {
    let whole = text_of_name(names);
    if let Ok(resolved) = context.find_side_file(unquoted(&whole)) {
        return vec![(whole, resolved)];
    }
    let mut found = Vec::new();
    for name in whole.split_ascii_whitespace() {
        match context.find_side_file(unquoted(name)) {
            Ok(resolved) => found.push((name.to_owned(), resolved)),
            Err(error) => warn_library(name, &error.to_string(), location, context),
        }
    }
    found
}

fn warn_library(name: &str, reason: &str, location: Location, context: &mut Context<'_>) {
    context.warnings.add(context.name, location, || {
        format!("the material library `{name}` is omitted: {reason}")
    });
}

fn unquoted(name: &str) -> &str {
    name.strip_prefix('"')
        .and_then(|rest| rest.strip_suffix('"'))
        .unwrap_or(name)
}

/// Appends the materials of one library; a later definition replaces an earlier one.
fn parse_library(
    source: &Source<'_>,
    drafts: &mut Vec<Draft>,
    by_name: &mut HashMap<Vec<u8>, usize>,
    context: &mut Context<'_>,
) {
    let mut statements = Statements::new(source.bytes);
    let mut current = None;
    while let Some(keyword) = statements.next_keyword() {
        if keyword.eq_ignore_ascii_case(b"newmtl") {
            if drafts.len() as u64 >= context.limits.max_materials {
                context
                    .warnings
                    .add(source.name, statements.location(), || {
                        "more materials than the limit; the rest is omitted".to_owned()
                    });
                return;
            }
            let name = statements.rest();
            by_name.insert(name.to_vec(), drafts.len());
            let name = text_of_name(name);
            drafts.push(Draft {
                material: Material {
                    name,
                    ..Material::default()
                },
                ..Draft::default()
            });
            current = drafts.last_mut();
        } else if let Some(draft) = &mut current {
            draft.read_statement(keyword, &mut statements, source, context);
        } else {
            context
                .warnings
                .add(source.name, statements.location(), || {
                    "a statement before the first `newmtl` is skipped".to_owned()
                });
        }
        statements.skip_statement();
    }
}

impl Draft {
    fn read_statement(
        &mut self,
        keyword: &[u8],
        statements: &mut Statements<'_>,
        source: &Source<'_>,
        context: &mut Context<'_>,
    ) {
        let location = statements.location();
        let mut warn = |message: &str| {
            context
                .warnings
                .add(source.name, location, || message.to_owned());
        };
        match keyword.to_ascii_lowercase().as_slice() {
            b"kd" => match read_color(statements) {
                Some(color) => (self.material.base_color, self.has_base_color) = (color, true),
                None => warn("this form of colour is not read; the default is used"),
            },
            b"ks" => match read_color(statements) {
                Some(color) => self.material.specular = color,
                None => warn("this form of colour is not read; the default is used"),
            },
            b"ke" => match read_color(statements) {
                Some(color) => self.material.emissive = color,
                None => warn("this form of colour is not read; the default is used"),
            },
            b"ns" => match read_number(statements) {
                Some(exponent) => {
                    self.has_no_highlight = exponent < 1.0;
                    self.material.shininess = exponent.clamp(0.0, 10_000.0);
                }
                None => warn("a number was expected"),
            },
            b"d" => {
                // `-halo` makes the opacity depend on the angle of view, which is not drawn.
                if statements.remaining_starts_with(b"-halo") {
                    statements.word();
                }
                match read_number(statements) {
                    Some(dissolve) => self.dissolve = Some(dissolve),
                    None => warn("a number was expected"),
                }
            }
            b"tr" => match read_number(statements) {
                Some(transparency) => self.transparency = Some(transparency),
                None => warn("a number was expected"),
            },
            b"illum" => self.illumination = read_number(statements),
            b"map_kd" => self.base_color_map = read_map(statements, source).map(|map| map.name),
            b"map_d" | b"map_tr" => {
                self.opacity_map = read_map(statements, source).map(|map| map.name);
            }
            b"map_bump" | b"bump" => self.bump_map = read_map(statements, source),
            b"map_ks" | b"map_ns" | b"map_ke" | b"norm" | b"disp" | b"decal" | b"refl" => {
                warn("this kind of texture is not drawn");
            }
            _ => {}
        }
    }

    /// The material at index `at`; its textures are found if it `is_used`.
    fn finish(
        self,
        at: usize,
        is_used: bool,
        textures: &mut Textures,
        context: &mut Context<'_>,
    ) -> Material {
        let Self {
            mut material,
            base_color_map,
            opacity_map,
            bump_map,
            ..
        } = self;
        material.opacity = match (self.dissolve, self.transparency) {
            (Some(dissolve), _) => dissolve.clamp(0.0, 1.0),
            (None, Some(transparency)) if transparency >= 1.0 => {
                context.warnings.add(context.name, None, || {
                    let name = &material.name;
                    format!("`Tr 1` would hide the material `{name}`; it is read as opaque")
                });
                1.0
            }
            (None, Some(transparency)) => (1.0 - transparency).clamp(0.0, 1.0),
            (None, None) => 1.0,
        };
        // Models 0 and 1 have no highlight.
        if self.has_no_highlight || self.illumination.is_some_and(|model| model < 2.0) {
            material.specular = Vec3::ZERO;
        }
        if base_color_map.is_some() && (!self.has_base_color || material.base_color == Vec3::ZERO) {
            material.base_color = Vec3::ONE;
        }
        let is_transparent = material.opacity < 1.0 || opacity_map.is_some();
        let chosen = context.options.alpha;
        if is_used
            && let Some(image) =
                textures.load(base_color_map.as_ref(), opacity_map.as_ref(), context)
        {
            material.base_color_texture = Some(image);
            let is_opaque = chosen == TextureAlpha::Auto && !is_transparent;
            material.alpha_mode = match chosen.or(AlphaMode::Blend) {
                _ if is_opaque => AlphaMode::Opaque,
                mode => mode,
            };
            // The contents of the texture decide, unless the material is transparent itself.
            if material.alpha_mode != AlphaMode::Opaque && material.opacity >= 1.0 {
                context.images.add_alpha_rule(AlphaRule {
                    material: at,
                    chosen,
                    color_without: None,
                });
            }
        }
        if is_used && let Some(map) = bump_map {
            material.bump_texture = textures.load(Some(&map.name), None, context);
            material.bump_scale = map.bump_multiplier.unwrap_or(1.0);
        }
        if chosen == TextureAlpha::Opaque {
            material.opacity = 1.0;
        } else if material.opacity < 1.0 {
            material.alpha_mode = AlphaMode::Blend;
        }
        material
    }
}

/// A finite number.
fn read_number(statements: &mut Statements<'_>) -> Option<f32> {
    statements
        .number()
        .flatten()
        .filter(|number| number.is_finite())
}

/// A linear colour; `None` for the spectral and XYZ forms, and for invalid colours.
fn read_color(statements: &mut Statements<'_>) -> Option<Vec3> {
    // Emitted light may exceed white.
    const BRIGHTEST: Vec3 = Vec3::splat(100.0);
    let red = read_number(statements)?;
    let green = read_number(statements).unwrap_or(red);
    let blue = read_number(statements).unwrap_or(red);
    let encoded = Vec3::new(red, green, blue).clamp(Vec3::ZERO, BRIGHTEST);
    Some(encoded.map(linear_from_srgb))
}

/// The file name after the options, of which the bump multiplier is read.
fn read_map(statements: &mut Statements<'_>, source: &Source<'_>) -> Option<Map> {
    let location = statements.location();
    let rest = statements.rest();
    let (name, bump_multiplier) = after_options(rest);
    let name = text_of_name(name);
    let name = unquoted(name.trim()).to_owned();
    let separator = source.name.rfind(['/', '\\']);
    let folder = separator.map_or("", |at| &source.name[..=at]).to_owned();
    let named_in = source.name.to_owned();
    let name = TextureName {
        name,
        folder,
        named_in,
        location,
    };
    (!name.name.is_empty()).then_some(Map {
        name,
        bump_multiplier,
    })
}

/// The text after the options `-name argument…`, and the argument of `-bm`. The last word is never
/// an argument.
fn after_options(mut text: &[u8]) -> (&[u8], Option<f32>) {
    // Beyond, the slopes of all but the flattest maps are vertical.
    const STEEPEST: f32 = 1000.0;
    let mut bump_multiplier = None;
    loop {
        let (word, rest) = split_word(text);
        if rest.is_empty() {
            return (text, bump_multiplier);
        }
        let number = |word: &[u8]| {
            let parsed = crate::model::number::parse_f32(word);
            parsed.and_then(|(number, length)| (length == word.len()).then_some(number))
        };
        let (least, most) = match word.to_ascii_lowercase().as_slice() {
            b"-o" | b"-s" | b"-t" => (1, 3),
            b"-mm" => (2, 2),
            b"-blendu" | b"-blendv" | b"-boost" | b"-texres" | b"-clamp" | b"-bm" | b"-imfchan"
            | b"-type" | b"-cc" | b"-colorspace" => (1, 1),
            _ => return (text, bump_multiplier),
        };
        text = rest;
        for taken in 0..most {
            let (argument, rest) = split_word(text);
            if rest.is_empty() || taken >= least && number(argument).is_none() {
                break;
            }
            if word.eq_ignore_ascii_case(b"-bm") {
                let number = number(argument).filter(|number| number.is_finite());
                bump_multiplier = number.map(|number| number.clamp(-STEEPEST, STEEPEST));
            }
            text = rest;
        }
    }
}

/// The first word, and the text after the following blanks.
fn split_word(text: &[u8]) -> (&[u8], &[u8]) {
    let length = text
        .iter()
        .position(u8::is_ascii_whitespace)
        .unwrap_or(text.len());
    (&text[..length], text[length..].trim_ascii_start())
}
