//! Archives for tests: entries that are stored or deflated.

use flate2::Compression;
use flate2::write::DeflateEncoder;
use std::io::Write;

/// Writes the entries one after the other, then their records and the end.
pub(crate) fn zip(entries: &[(&str, &[u8])], is_deflated: bool) -> Vec<u8> {
    let (mut bytes, mut records) = (Vec::new(), Vec::new());
    for &(name, content) in entries {
        let mut crc = flate2::Crc::new();
        crc.update(content);
        let packed = if is_deflated {
            let mut encoder = DeflateEncoder::new(Vec::new(), Compression::default());
            encoder.write_all(content).unwrap();
            encoder.finish().unwrap()
        } else {
            content.to_vec()
        };
        let offset = u32::try_from(bytes.len()).unwrap();
        let method = if is_deflated { 8_u16 } else { 0 };
        // From the version that is needed up to the length of the further fields.
        let mut common = Vec::new();
        for number in [20, 0x800, method, 0, 0] {
            common.extend(number.to_le_bytes());
        }
        let lens = [packed.len(), content.len()].map(|len| u32::try_from(len).unwrap());
        for number in [crc.sum(), lens[0], lens[1]] {
            common.extend(number.to_le_bytes());
        }
        common.extend(u16::try_from(name.len()).unwrap().to_le_bytes());
        common.extend([0; 2]);
        bytes.extend(b"PK\x03\x04");
        bytes.extend(&common);
        bytes.extend(name.bytes());
        bytes.extend(packed);
        records.extend(b"PK\x01\x02\x14\0");
        records.extend(common);
        records.extend([0; 10]);
        records.extend(offset.to_le_bytes());
        records.extend(name.bytes());
    }
    let start = u32::try_from(bytes.len()).unwrap();
    let len = u32::try_from(records.len()).unwrap();
    let count = u16::try_from(entries.len()).unwrap().to_le_bytes();
    bytes.extend(records);
    bytes.extend(b"PK\x05\x06\0\0\0\0");
    bytes.extend([count, count].concat());
    bytes.extend(len.to_le_bytes());
    bytes.extend(start.to_le_bytes());
    bytes.extend([0; 2]);
    bytes
}

pub(crate) const RELATIONSHIPS: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
 <Relationship Target="/3D/3dmodel.model" Id="rel0"
  Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>"#;

/// A package with a model and further parts.
pub(crate) fn package(model: &[u8], parts: &[(&str, &[u8])], is_deflated: bool) -> Vec<u8> {
    let mut entries: Vec<(&str, &[u8])> = vec![
        ("[Content_Types].xml", b"<Types/>"),
        ("_rels/.rels", RELATIONSHIPS.as_bytes()),
        ("3D/3dmodel.model", model),
    ];
    entries.extend(parts);
    zip(&entries, is_deflated)
}

/// A model of these attributes, resources and build items.
pub(crate) fn model(attributes: &str, resources: &str, build: &str) -> String {
    format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<model xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
 xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02"
 xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06" {attributes}>
<resources>
{resources}
</resources>
<build>{build}</build>
</model>"#
    )
}

/// A mesh of two triangles, a unit square, whose triangles have these attributes.
pub(crate) fn square([first, second]: [&str; 2]) -> String {
    format!(
        r#"<mesh><vertices>
<vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/>
<vertex x="1" y="1" z="0"/><vertex x="0" y="1" z="0"></vertex>
</vertices><triangles>
<triangle v1="0" v2="1" v3="2" {first}/>
<triangle v1="0" v2="2" v3="3" {second}/>
</triangles></mesh>"#
    )
}

/// A model with everything that is read.
pub(crate) fn full() -> String {
    let resources = format!(
        r##"<!-- all kinds --><basematerials id="1"><base name="a&amp;b" displaycolor="#FF0000"/>
<base name="glass" displaycolor="#00ff0080"/></basematerials>
<m:colorgroup id="2"><m:color color="#0000FF"/><m:color color="#FFFFFF80"/></m:colorgroup>
<m:texture2d id="3" path="/3D/Textures/t.png" contenttype="image/png"/>
<m:texture2dgroup id="4" texid="3"><m:tex2coord u="0" v="0"/><m:tex2coord u="1" v="0.25"/></m:texture2dgroup>
<object id="5" name="first" pid="1" pindex="0">{}</object>
<object id="6" name="second">{}</object>
<object id="7"><components><component objectid="5"/>
<component objectid="6" transform="1 0 0 0 1 0 0 0 1 0 0 2"/></components></object>"##,
        square(["", r#"p1="1""#]),
        square([
            r#"pid="2" p1="0" p2="1" p3="0""#,
            r#"pid="4" p1="0" p2="1" p3="0""#
        ]),
    );
    let build = r#"<item objectid="7"/><item objectid="6" transform="-1 0 0 0 1 0 0 0 1 5 0 0"/>"#;
    model(
        r#"unit="centimeter" requiredextensions="m p""#,
        &resources,
        build,
    )
}
