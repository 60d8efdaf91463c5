//! A model part: its unit, its resources and its build items.

use super::document::{Document, Object, Part, Reference};
use super::package::part_name;
use super::properties;
use super::triangles;
use super::xml::{Tag, Xml};
use crate::AssetError;
use crate::model::load::Context;
use glam::{DAffine3, DVec3};
use std::collections::HashMap;

/// Extensions that are read, or that have no influence on a picture.
const EXTENSIONS: [&str; 4] = [
    "http://schemas.microsoft.com/3dmanufacturing/core/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/material/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06",
    "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07",
];

/// What is known while a part is read.
pub(super) struct Reading<'d> {
    pub(super) document: &'d mut Document,
    pub(super) part: Part,
    /// Millimetres in a unit of the part.
    pub(super) unit_mm: f64,
    /// Index of each group of properties by its identifier.
    pub(super) groups: HashMap<u32, usize>,
    /// Index of each texture by its identifier.
    pub(super) textures: HashMap<u32, usize>,
}

/// Reads the part `name` and adds its contents to the document.
pub(super) fn read(
    name: &str,
    text: &str,
    document: &mut Document,
    context: &mut Context<'_>,
) -> Result<(), AssetError> {
    let mut xml = Xml::new(text, name, context);
    let root = xml.child()?;
    let Some(root) = root.filter(|tag| tag.local_name().into_inner() == "model") else {
        return Err(xml.malformed("the part is no 3D model"));
    };
    let unit_mm = header(&root, &xml)?;
    let part = Part {
        name: name.to_owned(),
        place: xml.place().to_owned(),
        objects: HashMap::new(),
        items: Vec::new(),
    };
    let mut reading = Reading {
        document,
        part,
        unit_mm,
        groups: HashMap::new(),
        textures: HashMap::new(),
    };
    while let Some(tag) = xml.child()? {
        match tag.local_name().into_inner() {
            "resources" => resources(&mut xml, &mut reading, context)?,
            "build" => {
                while let Some(tag) = xml.child()? {
                    if tag.local_name().into_inner() == "item" {
                        let item = reading.reference(&tag, &xml)?;
                        reading.part.items.push(item);
                    }
                    xml.skip()?;
                }
            }
            _ => xml.skip()?,
        }
    }
    let part = reading.part;
    document.parts.push(part);
    Ok(())
}

/// Checks the required extensions, and returns the unit in millimetres.
fn header(root: &Tag<'_>, xml: &Xml<'_>) -> Result<f64, AssetError> {
    let mut unit_mm = 1.0;
    let mut required = None;
    let mut namespaces = HashMap::new();
    for attribute in root.attributes().with_checks(false).flatten() {
        if let Some(prefix) = attribute.key.into_inner().strip_prefix("xmlns:") {
            namespaces.insert(prefix, xml.unescaped(&attribute.value)?);
        }
    }
    for attribute in xml.attributes(root) {
        match attribute? {
            ("unit", value) => unit_mm = millimetres(&value, xml)?,
            ("requiredextensions", value) => required = Some(value),
            _ => {}
        }
    }
    let required = required.unwrap_or_default();
    let unknown: Vec<String> = { required.split_ascii_whitespace() }
        .filter_map(|prefix| match namespaces.get(prefix) {
            Some(namespace) if EXTENSIONS.contains(&namespace.as_str()) => None,
            Some(namespace) => Some(format!("`{prefix}` ({namespace})")),
            None => Some(format!("`{prefix}`")),
        })
        .collect();
    if unknown.is_empty() {
        return Ok(unit_mm);
    }
    let what = format!(
        "the model requires extensions of 3MF that are not read: {}",
        unknown.join(", ")
    );
    let advice = "export it without them: triangles, materials and components are read";
    Err(xml.located(AssetError::unsupported(what, advice)))
}

fn millimetres(unit: &str, xml: &Xml<'_>) -> Result<f64, AssetError> {
    Ok(match unit {
        "micron" => 0.001,
        "millimeter" => 1.0,
        "centimeter" => 10.0,
        "inch" => 25.4,
        "foot" => 304.8,
        "meter" => 1000.0,
        unit => return Err(xml.malformed(format!("`{unit}` is no unit of 3MF"))),
    })
}

fn resources(
    xml: &mut Xml<'_>,
    reading: &mut Reading<'_>,
    context: &mut Context<'_>,
) -> Result<(), AssetError> {
    while let Some(tag) = xml.child()? {
        match tag.local_name().into_inner() {
            "object" => object(&tag, xml, reading, context)?,
            "basematerials" => properties::base_materials(&tag, xml, reading, context)?,
            "colorgroup" => properties::colors(&tag, xml, reading, context)?,
            "texture2d" => properties::texture(&tag, xml, reading)?,
            "texture2dgroup" => properties::coordinates(&tag, xml, reading, context)?,
            name @ ("compositematerials" | "multiproperties") => {
                xml.warn(context, || {
                    format!("`{name}` is not read; it has no effect")
                });
                properties::other(&tag, xml, reading)?;
            }
            _ => xml.skip()?,
        }
    }
    Ok(())
}

/// The identifier of a resource.
pub(super) fn identifier(tag: &Tag<'_>, xml: &Xml<'_>) -> Result<u32, AssetError> {
    for attribute in xml.attributes(tag) {
        if let ("id", value) = attribute? {
            return xml.index("id", &value);
        }
    }
    Err(xml.missing("id"))
}

/// Names in files can be long, and many meshes may have the name of one object.
pub(super) fn shortened(name: &str) -> String {
    const MAX_CHARACTERS: usize = 256;
    name.chars().take(MAX_CHARACTERS).collect()
}

fn object(
    tag: &Tag<'_>,
    xml: &mut Xml<'_>,
    reading: &mut Reading<'_>,
    context: &mut Context<'_>,
) -> Result<(), AssetError> {
    let id = identifier(tag, xml)?;
    let location = xml.location();
    let mut name = String::new();
    let (mut group, mut index) = (None, 0);
    for attribute in xml.attributes(tag) {
        match attribute? {
            ("name", value) => name = shortened(&xml.unescaped(&value)?),
            ("pid", value) => group = Some(xml.index("pid", &value)?),
            ("pindex", value) => index = xml.index("pindex", &value)?,
            _ => {}
        }
    }
    let at = reading.document.objects.len();
    if reading.part.objects.insert(id, at).is_some() {
        return Err(xml.malformed(format!("two objects have the identifier {id}")));
    }
    let mut object = Object {
        name,
        part: reading.document.parts.len(),
        triangles: triangles::Triangles::default(),
        components: Vec::new(),
        location,
    };
    while let Some(tag) = xml.child()? {
        match tag.local_name().into_inner() {
            "mesh" => {
                let of_object = group.map(|group| (group, index));
                triangles::read(&mut object.triangles, of_object, xml, reading, context)?;
            }
            "components" => {
                while let Some(tag) = xml.child()? {
                    if tag.local_name().into_inner() == "component" {
                        object.components.push(reading.reference(&tag, xml)?);
                    }
                    xml.skip()?;
                }
            }
            _ => xml.skip()?,
        }
    }
    reading.document.objects.push(object);
    Ok(())
}

impl Reading<'_> {
    /// Reads a component or a build item.
    fn reference(&self, tag: &Tag<'_>, xml: &Xml<'_>) -> Result<Reference, AssetError> {
        let mut part = None;
        let mut id = None;
        let mut outer_from_object = DAffine3::IDENTITY;
        for attribute in xml.attributes(tag) {
            match attribute? {
                ("objectid", value) => id = Some(xml.index("objectid", &value)?),
                ("path", value) => {
                    part = Some(part_name(&xml.unescaped(&value)?, &self.part.name, xml)?);
                }
                ("transform", value) => outer_from_object = self.transform(&value, xml)?,
                _ => {}
            }
        }
        Ok(Reference {
            part,
            id: id.ok_or_else(|| xml.missing("objectid"))?,
            outer_from_object,
            location: xml.location(),
        })
    }

    /// Four rows of three numbers: vectors are rows, so these are the columns here.
    fn transform(&self, value: &str, xml: &Xml<'_>) -> Result<DAffine3, AssetError> {
        let mut numbers = [0.0; 12];
        let mut words = value.split_ascii_whitespace();
        for number in &mut numbers {
            let word = words.next().unwrap_or_default();
            *number = f64::from(xml.number("transform", word)?);
        }
        let is_finite = numbers.iter().all(|number| number.is_finite());
        if words.next().is_some() || !is_finite {
            return Err(xml.malformed("`transform` is not 12 finite numbers"));
        }
        let [x, y, z, w] = [0, 3, 6, 9].map(|at| DVec3::from_slice(&numbers[at..at + 3]));
        Ok(DAffine3::from_cols(x, y, z, w * self.unit_mm))
    }
}
