//! Groups of properties: base materials, colours, and coordinates of textures.

use super::document::{Group, Texture};
use super::package::part_name;
use super::part::{Reading, identifier, shortened};
use super::xml::{Tag, Xml};
use crate::model::load::Context;
use crate::model::srgb::linear_from_srgb8;
use crate::{AssetError, Limits};
use estampe_scene::{AlphaMode, Material};
use glam::{Vec2, Vec3};

/// Reads the open `basematerials`, whose start is `tag`.
pub(super) fn base_materials(
    tag: &Tag<'_>,
    xml: &mut Xml<'_>,
    reading: &mut Reading<'_>,
    context: &mut Context<'_>,
) -> Result<(), AssetError> {
    let id = identifier(tag, xml)?;
    let first = reading.document.materials.len();
    while let Some(tag) = xml.child()? {
        if tag.local_name().into_inner() == "base" {
            let (mut name, mut color) = (String::new(), None);
            for attribute in xml.attributes(&tag) {
                match attribute? {
                    ("name", value) => name = shortened(&xml.unescaped(&value)?),
                    ("displaycolor", value) => color = linear_color(&value),
                    _ => {}
                }
            }
            let [r, g, b, opacity] = color.unwrap_or_else(|| {
                xml.warn(context, || {
                    format!("the material `{name}` has no colour #RRGGBB; it is white")
                });
                [1.0; 4]
            });
            let alpha_mode = if opacity < 1.0 {
                AlphaMode::Blend
            } else {
                AlphaMode::Opaque
            };
            reading.document.materials.push(Material {
                name,
                base_color: Vec3::new(r, g, b),
                opacity,
                alpha_mode,
                ..Material::default()
            });
            let count = reading.document.materials.len() as u64;
            Limits::check("materials", count, context.limits.max_materials)
                .map_err(|error| xml.located(error))?;
        }
        xml.skip()?;
    }
    let count = reading.document.materials.len() - first;
    reading.add(id, Group::Base { first, count }, xml)
}

/// Reads the open `colorgroup`, whose start is `tag`.
pub(super) fn colors(
    tag: &Tag<'_>,
    xml: &mut Xml<'_>,
    reading: &mut Reading<'_>,
    context: &mut Context<'_>,
) -> Result<(), AssetError> {
    let id = identifier(tag, xml)?;
    let mut colors = Vec::new();
    while let Some(tag) = xml.child()? {
        if tag.local_name().into_inner() == "color" {
            let mut color = None;
            for attribute in xml.attributes(&tag) {
                if let ("color", value) = attribute? {
                    color = linear_color(&value);
                }
            }
            colors.push(color.unwrap_or_else(|| {
                xml.warn(context, || {
                    "this is no colour #RRGGBB; it is white".to_owned()
                });
                [1.0; 4]
            }));
        }
        xml.skip()?;
    }
    reading.add(id, Group::Colors(colors), xml)
}

/// Reads the open `texture2d`, whose start is `tag`.
pub(super) fn texture(
    tag: &Tag<'_>,
    xml: &mut Xml<'_>,
    reading: &mut Reading<'_>,
) -> Result<(), AssetError> {
    let id = identifier(tag, xml)?;
    let mut part = None;
    for attribute in xml.attributes(tag) {
        if let ("path", value) = attribute? {
            part = Some(part_name(&xml.unescaped(&value)?, &reading.part.name, xml)?);
        }
    }
    let index = reading.document.textures.len();
    reading.document.textures.push(Texture {
        part: part.ok_or_else(|| xml.missing("path"))?,
        place: xml.place().to_owned(),
        location: xml.location(),
    });
    if reading.textures.insert(id, index).is_some() {
        return Err(xml.malformed(format!("two textures have the identifier {id}")));
    }
    xml.skip()
}

/// Reads the open `texture2dgroup`, whose start is `tag`.
pub(super) fn coordinates(
    tag: &Tag<'_>,
    xml: &mut Xml<'_>,
    reading: &mut Reading<'_>,
    context: &mut Context<'_>,
) -> Result<(), AssetError> {
    let id = identifier(tag, xml)?;
    let mut texture = None;
    for attribute in xml.attributes(tag) {
        if let ("texid", value) = attribute? {
            let texture_id = xml.index("texid", &value)?;
            texture = reading.textures.get(&texture_id).copied();
        }
    }
    if texture.is_none() {
        xml.warn(context, || {
            "the texture of these coordinates does not exist; they have no effect".to_owned()
        });
    }
    let mut coordinates = Vec::new();
    while let Some(tag) = xml.child()? {
        if tag.local_name().into_inner() == "tex2coord" {
            let (mut u, mut v) = (None, None);
            for attribute in xml.attributes(&tag) {
                let (name, value) = attribute?;
                match name {
                    "u" => u = Some(xml.number(name, &value)?),
                    "v" => v = Some(xml.number(name, &value)?),
                    _ => {}
                }
            }
            let (Some(u), Some(v)) = (u, v) else {
                return Err(xml.malformed("the coordinates lack one of `u` and `v`"));
            };
            // 3MF's v points up, the scene's down.
            coordinates.push(Vec2::new(u, 1.0 - v));
        }
        xml.skip()?;
    }
    let group = Group::Coordinates {
        texture,
        coordinates,
    };
    reading.add(id, group, xml)
}

/// Skips the open group of properties, whose start is `tag`.
pub(super) fn other(
    tag: &Tag<'_>,
    xml: &mut Xml<'_>,
    reading: &mut Reading<'_>,
) -> Result<(), AssetError> {
    let id = identifier(tag, xml)?;
    reading.add(id, Group::Other, xml)?;
    xml.skip()
}

impl Reading<'_> {
    fn add(&mut self, id: u32, group: Group, xml: &Xml<'_>) -> Result<(), AssetError> {
        let index = self.document.groups.len();
        self.document.groups.push(group);
        match self.groups.insert(id, index) {
            None => Ok(()),
            Some(_) => {
                let what = format!("two groups of properties have the identifier {id}");
                Err(xml.malformed(what))
            }
        }
    }
}

/// The linear colour of `#RRGGBB` or `#RRGGBBAA`, which are sRGB-encoded but for alpha.
fn linear_color(text: &str) -> Option<[f32; 4]> {
    let digits = text.trim_ascii().strip_prefix('#')?.as_bytes();
    if !matches!(digits.len(), 6 | 8) {
        return None;
    }
    let mut codes = [255; 4];
    for (code, pair) in codes.iter_mut().zip(digits.as_chunks::<2>().0) {
        let [high, low] = pair.map(|digit| char::from(digit).to_digit(16));
        *code = u8::try_from(high? * 16 + low?).ok()?;
    }
    let [r, g, b, alpha] = codes;
    let [r, g, b] = [r, g, b].map(linear_from_srgb8);
    Some([r, g, b, f32::from(alpha) / 255.0])
}
