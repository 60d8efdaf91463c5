//! A small file of each format, with most of what the format has.

use super::gltf;
use crate::gltf::{builder, meshopt};
use crate::threemf::archive;
use estampe_assets::ModelFormat;

/// A file whose bytes are mutated.
pub(super) struct Fixture {
    pub(super) name: &'static str,
    pub(super) format: ModelFormat,
    pub(super) bytes: Vec<u8>,
    pub(super) place: Place,
}

/// The place of the bytes.
pub(super) enum Place {
    /// They are the model.
    Model,
    /// They are a side file of [`OBJ`].
    SideFile(&'static str),
    /// They are the model within a 3MF package, else its checksum would find every mutation.
    PackagedModel,
    /// They are the JSON of a GLB file with this binary chunk, whose lengths stay right.
    GlbJson(Vec<u8>),
}

impl Fixture {
    /// The model's file with other bytes in place of the fixture's.
    pub(super) fn model(&self, bytes: &[u8]) -> Vec<u8> {
        match &self.place {
            Place::Model => bytes.to_vec(),
            Place::SideFile(_) => OBJ.into(),
            Place::PackagedModel => three_mf(bytes),
            Place::GlbJson(bin) => builder::glb(bytes, bin),
        }
    }

    /// True if it has an animation, which poses it then.
    pub(super) fn has_animation(&self) -> bool {
        matches!(self.name, "gltf" | "glb" | "glb json")
    }

    /// The side files with other bytes in place of the fixture's.
    pub(super) fn side_files(&self, bytes: &[u8]) -> Vec<(&'static str, Vec<u8>)> {
        let files = [("a.mtl", MTL.into()), ("t.tga", tga()), ("m.tga", tga())];
        let file = |(name, own)| match self.place {
            Place::SideFile(mutated) if mutated == name => (name, bytes.to_vec()),
            _ => (name, own),
        };
        files.into_iter().map(file).collect()
    }
}

/// With material libraries and all kinds of elements.
const OBJ: &str = "\u{feff}# a comment \\\nmtllib a.mtl b c.mtl\no cube\nv 0 0 0\nv 1 0 0 1\nv 1 1 0 1 0.5 0\n\
v 0 1 0\nv 0 0 1\nv 1 0 1\nv 1e0 +1. .1e1\nv -0 1 1\nvt 0\nvt 0 1 0\nvt 1 1\nvn 0 0 -2\nvn 0 1e-3 0\n\
vp 1 2\ns 1\nusemtl red\nf 4/1/1 3/2/1 2/3/1 1//1\nf 5 6 7 8\ng top\ns off\nusemtl shiny one\n\
f -1 -2 \\\n -6 -5\nf 1/1 5/2 8/3 4/1\nusemtl red\no rest\nf 2 3 7 6\nf 1 2 6 5\nf 1 2 3 7 4\n\
l 1 2 3/1\np 1 2 3\nf 9 1 2\nf 20 21 22\ncurv 0 1 1 2\r\nbogus\r\n";
const MTL: &str = "newmtl red\nKa 0 0 0\nKd 1 0 0\nKs 0.5\nNs 20\nKe 0 0 0\nd 0.5\nillum 2\nmap_Kd \
-s 1 1 1 -o 0.5 -mm 0 1 -bm 1 t.tga\nnewmtl shiny one\nKd xyz 1 1 1\nTr 0.25\nmap_Kd t.tga\nmap_d \
-clamp on m.tga\nbump -bm 2 missing.png\nnewmtl c\nTr 1\n";
const STL: &str = "solid one\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   \
vertex 0 1 0\n  endloop\n endfacet\nendsolid one\nSOLID\nFACET NORMAL 0 0 nan\nOUTER LOOP\nVERTEX 0 0 0\n\
VERTEX 1 0 0\nVERTEX 1 1 0\nVERTEX 0 1 0\nENDLOOP\nENDFACET\n";
const OFF: &str = "OFF # a square\n4 5 0\n0 0 0\n1 0 0\n1e0 +1. 0\n0 1 0\n4 0 1 2 3 255 0 0\n3 0 1 2\n\
2 0 3 0.5 0.5 0.5 1\n1 2 7\n5 0 1 2 3 9\n";
const COLORED_OFF: &str = "STCNOFF 3 1 0\n0 0 0 0 0 1 255 0 0 9 0 0\n1 0 0 0 0 2 0 255 0 9 1 0\n\
0 1 0 0 nan 1 0 0 255 0 1\n3 0 1 2\n";
const PLY_HEADER: &str = "comment TextureFile t.tga\nelement vertex 4\nproperty float x\nproperty float y\n\
property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nproperty float s\n\
property float t\nproperty list uchar int odd\nelement face 2\nproperty list uchar int vertex_indices\n\
property list uchar float texcoord\nelement tristrips 1\nproperty list int int vertex_indices\n\
element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n";

fn tga() -> Vec<u8> {
    let mut bytes = vec![0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 1, 0, 32, 0x28];
    bytes.extend([1, 2, 3, 255, 4, 5, 6, 100]);
    bytes
}

fn binary_stl(header: &[u8]) -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes[..header.len()].copy_from_slice(header);
    bytes.extend(5_u32.to_le_bytes());
    for i in 0..5_u8 {
        let corners = (0..12).map(|k| f32::from((i + 1) * (k + 3) % 5));
        bytes.extend(corners.flat_map(f32::to_le_bytes));
        bytes.extend((u16::from(i) << 10 | 1 << 15).to_le_bytes());
    }
    bytes
}

const MODEL_3MF: &str = r##"<model unit="inch" xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02"
 requiredextensions="m"><resources><basematerials id="1"><base name="&amp;" displaycolor="#FF0000"/>
</basematerials><m:colorgroup id="2"><m:color color="#0000FF"/><m:color color="#FFFFFF80"/></m:colorgroup>
<m:texture2d id="3" path="/t.tga"/><m:texture2dgroup id="4" texid="3"><m:tex2coord u="0" v="0"/>
</m:texture2dgroup><object id="5" pid="1" pindex="0"><mesh><vertices><vertex x="0" y="0" z="0"/>
<vertex x="1" y="0" z="0"/><vertex x="1" y="1e0" z="0"/><vertex x="0" y="1" z="0"/></vertices>
<triangles><triangle v1="0" v2="1" v3="2"/><triangle v1="0" v2="2" v3="3" pid="2" p1="0" p2="1" p3="0"/>
<triangle v1="1" v2="2" v3="3" pid="4" p1="0"/></triangles></mesh></object><object id="6"><components>
<component objectid="5" transform="1 0 0 0 1 0 0 0 -1 0 0 2"/><component objectid="5"/></components></object>
</resources><build><item objectid="6"/><item objectid="5"/></build></model>"##;

fn three_mf(model: &[u8]) -> Vec<u8> {
    archive::package(model, &[("t.tga", &tga())], false)
}

fn ascii_ply() -> Vec<u8> {
    let rows = "0 0 0 255 0 0 0 0 1 7\n1 0 0 0 255 0 1 0 0\n1 1 0 0 0 255 1 1 2 1 2\n0 1 0 1 2 3 0 1 0\n\
                4 0 1 2 3 8 0 0 1 0 1 1 0 1\n3 0 2 3 0\n6 0 1 2 -1 3 2\n0 2\n";
    format!("ply\nformat ascii 1.0\n{PLY_HEADER}{rows}").into_bytes()
}

fn binary_ply(big: bool) -> Vec<u8> {
    let name = if big {
        "binary_big_endian"
    } else {
        "binary_little_endian"
    };
    let mut out = format!("ply\nformat {name} 1.0\n{PLY_HEADER}").into_bytes();
    let float = |value: f32| {
        if big {
            value.to_be_bytes()
        } else {
            value.to_le_bytes()
        }
    };
    let int = |value: i32| {
        if big {
            value.to_be_bytes()
        } else {
            value.to_le_bytes()
        }
    };
    for [x, y] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0_f32]] {
        out.extend([x, y, 0.0].into_iter().flat_map(float));
        out.extend([255, 128, 0]);
        out.extend([x, y].into_iter().flat_map(float));
        out.push(1);
        out.extend(int(7));
    }
    out.push(4);
    out.extend([0, 1, 2, 3].into_iter().flat_map(int));
    out.push(8);
    out.extend(
        [0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0]
            .into_iter()
            .flat_map(float),
    );
    out.push(3);
    out.extend([0, 2, 3].into_iter().flat_map(int));
    out.push(0);
    out.extend([6, 0, 1, 2, -1, 3, 2].into_iter().flat_map(int));
    out.extend([0, 2].into_iter().flat_map(int));
    out
}

/// One table for all kinds of files.
pub(super) fn fixtures() -> Vec<Fixture> {
    let concave =
        "v 0 0 0\nv 4 0 0\nv 4 3 0\nv 3 1 0\nv 2 3 0\nv 1 1 0\nv 0 3 0\nf 1 2 3 4 5 6 7\n";
    let coloured_stl = binary_stl(b"solid COLOR=\x80\x80\x80\xff");
    let package = three_mf(MODEL_3MF.as_bytes());
    let deflated = archive::package(MODEL_3MF.as_bytes(), &[("t.tga", &tga())], true);
    let (gltf, small) = (gltf::fixture(), builder::Builder::triangle());
    let json = Place::GlbJson(gltf.bin.clone());
    let models: [(_, _, Vec<u8>); 18] = [
        ("obj", ModelFormat::Obj, OBJ.into()),
        ("concave obj", ModelFormat::Obj, concave.into()),
        ("CR obj", ModelFormat::Obj, OBJ.replace('\n', "\r").into()),
        ("ascii stl", ModelFormat::Stl, STL.into()),
        ("binary stl", ModelFormat::Stl, binary_stl(b"")),
        ("coloured stl", ModelFormat::Stl, coloured_stl),
        ("off", ModelFormat::Off, OFF.into()),
        ("coloured off", ModelFormat::Off, COLORED_OFF.into()),
        ("3mf", ModelFormat::ThreeMf, package),
        ("deflated 3mf", ModelFormat::ThreeMf, deflated),
        ("ascii ply", ModelFormat::Ply, ascii_ply()),
        ("little-endian ply", ModelFormat::Ply, binary_ply(false)),
        ("big-endian ply", ModelFormat::Ply, binary_ply(true)),
        ("gltf", ModelFormat::Gltf, gltf.gltf()),
        ("small gltf", ModelFormat::Gltf, small.gltf()),
        ("glb", ModelFormat::Gltf, gltf.glb()),
        ("small glb", ModelFormat::Gltf, small.glb()),
        (
            "meshopt glb",
            ModelFormat::Gltf,
            meshopt::compressed_points().glb(),
        ),
    ];
    let parts: [(_, _, Vec<u8>, _); 4] = [
        (
            "mtl",
            ModelFormat::Obj,
            MTL.into(),
            Place::SideFile("a.mtl"),
        ),
        ("texture", ModelFormat::Obj, tga(), Place::SideFile("t.tga")),
        (
            "3mf model",
            ModelFormat::ThreeMf,
            MODEL_3MF.into(),
            Place::PackagedModel,
        ),
        ("glb json", ModelFormat::Gltf, gltf.json_of_glb(), json),
    ];
    let models = models.map(|(name, format, bytes)| (name, format, bytes, Place::Model));
    let all = models.into_iter().chain(parts);
    let fixture = |(name, format, bytes, place)| Fixture {
        name,
        format,
        bytes,
        place,
    };
    all.map(fixture).collect()
}
