//! Damaged and hostile model files: every truncation and thousands of random mutations give a valid
//! scene or an error.
//!
//! There are 2,000 mutations of each kind for each file, or `ESTAMPE_MUTATIONS` if it is set.

use crate::threemf::archive;
use estampe_assets::model::{NoResources, ResourceError, Resources};
use estampe_assets::{Limits, ModelFormat, parse_model};
use estampe_scene::{Mesh, Scene};
use fastrand::Rng;
use std::collections::HashMap;
use std::path::Path;

/// A small file of each format; OBJ files come with their material libraries.
struct Fixture {
    name: &'static str,
    format: ModelFormat,
    bytes: Vec<u8>,
    /// The side file that is mutated in place of the model, if any.
    side_file: Option<&'static str>,
}

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

fn fixtures() -> Vec<Fixture> {
    let fixture = |name, format, bytes: Vec<u8>| Fixture {
        name,
        format,
        bytes,
        side_file: None,
    };
    let concave =
        "v 0 0 0\nv 4 0 0\nv 4 3 0\nv 3 1 0\nv 2 3 0\nv 1 1 0\nv 0 3 0\nf 1 2 3 4 5 6 7\n";
    vec![
        fixture("obj", ModelFormat::Obj, OBJ.into()),
        fixture("concave obj", ModelFormat::Obj, concave.into()),
        fixture("CR obj", ModelFormat::Obj, OBJ.replace('\n', "\r").into()),
        Fixture {
            side_file: Some("a.mtl"),
            ..fixture("mtl", ModelFormat::Obj, MTL.into())
        },
        Fixture {
            side_file: Some("t.tga"),
            ..fixture("texture", ModelFormat::Obj, tga())
        },
        fixture("ascii stl", ModelFormat::Stl, STL.into()),
        fixture("binary stl", ModelFormat::Stl, binary_stl(b"")),
        fixture(
            "coloured stl",
            ModelFormat::Stl,
            binary_stl(b"solid COLOR=\x80\x80\x80\xff"),
        ),
        fixture("off", ModelFormat::Off, OFF.into()),
        fixture("coloured off", ModelFormat::Off, COLORED_OFF.into()),
        fixture("3mf", ModelFormat::ThreeMf, three_mf(MODEL_3MF.as_bytes())),
        fixture("3mf model", ModelFormat::ThreeMf, MODEL_3MF.into()),
        fixture("ascii ply", ModelFormat::Ply, ascii_ply()),
        fixture("little-endian ply", ModelFormat::Ply, binary_ply(false)),
        fixture("big-endian ply", ModelFormat::Ply, binary_ply(true)),
    ]
}

struct Files(HashMap<&'static str, Vec<u8>>);

impl Resources for Files {
    fn resolve(&self, name: &str) -> Result<String, ResourceError> {
        if self.0.contains_key(name) {
            Ok(name.to_owned())
        } else {
            Err(ResourceError::NotFound)
        }
    }

    fn read(&self, resolved: &str, max_bytes: u64) -> Result<Vec<u8>, ResourceError> {
        let bytes = &self.0[resolved];
        if bytes.len() as u64 > max_bytes {
            return Err(ResourceError::TooLarge(max_bytes));
        }
        Ok(bytes.clone())
    }
}

/// Small limits, so that a mutation cannot require much memory.
fn limits() -> Limits {
    Limits {
        max_image_pixels: 1 << 16,
        max_total_image_pixels: 1 << 18,
        ..Limits::default()
    }
}

/// Reads `bytes` in place of the fixture's file and checks the scene. Returns true if there was
/// one.
fn read(fixture: &Fixture, bytes: &[u8]) -> bool {
    let mut files = Files(HashMap::from([
        ("a.mtl", MTL.as_bytes().to_vec()),
        ("t.tga", tga()),
        ("m.tga", tga()),
    ]));
    let packed;
    let model = match fixture.side_file {
        Some(name) => {
            files.0.insert(name, bytes.to_vec());
            OBJ.as_bytes()
        }
        // Else the checksum would find every mutation.
        None if fixture.name == "3mf model" => {
            packed = three_mf(bytes);
            &packed
        }
        None => bytes,
    };
    match parse_model(model, fixture.format, fixture.name, &files, &limits()) {
        Ok(loaded) => {
            check(&loaded.scene);
            assert!(loaded.warnings.len() as u64 <= loaded.warning_count);
            true
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            false
        }
    }
}

/// Checks the properties that every scene has.
pub(super) fn check(scene: &Scene) {
    for mesh in &scene.meshes {
        check_mesh(mesh, scene.materials.len());
    }
    for material in &scene.materials {
        assert!(material.base_color.is_finite() && material.specular.is_finite());
        assert!((0.0..=1.0).contains(&material.opacity));
        assert!(
            material
                .base_color_texture
                .is_none_or(|image| image < scene.images.len())
        );
    }
    for image in &scene.images {
        assert_eq!(
            image.rgba.len(),
            image.width as usize * image.height as usize * 4
        );
    }
}

fn check_mesh(mesh: &Mesh, material_count: usize) {
    let count = mesh.positions.len();
    let is_empty_or_full = |len: usize| len == 0 || len == count;
    assert!(is_empty_or_full(mesh.normals.len()), "normals");
    assert!(is_empty_or_full(mesh.uvs.len()), "uvs");
    assert!(is_empty_or_full(mesh.colors.len()), "colors");
    assert!(mesh.triangles.is_empty() || !mesh.normals.is_empty());
    let used = mesh.triangles.iter().flatten();
    let used = used.chain(mesh.lines.iter().flatten()).chain(&mesh.points);
    for &vertex in used {
        assert!(
            mesh.positions[vertex as usize].is_finite(),
            "elements have finite corners"
        );
    }
    for normal in &mesh.normals {
        let length = normal.length();
        assert!(length == 0.0 || (length - 1.0).abs() < 1e-5, "{normal}");
    }
    assert!(mesh.uvs.iter().all(|uv| uv.is_finite()));
    assert!(
        mesh.colors
            .iter()
            .flatten()
            .all(|value| (0.0..=1.0).contains(value))
    );
    let mut next = 0;
    for surface in &mesh.surfaces {
        assert_eq!(surface.triangles.start, next, "surfaces have no gaps");
        next = surface.triangles.end;
        assert!(
            surface
                .material
                .is_none_or(|material| material < material_count)
        );
    }
    assert!(mesh.surfaces.is_empty() || next == mesh.triangles.len());
}

#[derive(Debug, Clone, Copy)]
enum Mutation {
    FlipBit,
    SetByte,
    /// Sets a byte to a character with a meaning in text formats.
    SetMeaningful,
    /// Sets four bytes to a special number.
    SetWord,
    Remove,
    Insert,
    Repeat,
    /// Repeats digits many times.
    Enlarge,
}

const MUTATIONS: [Mutation; 8] = [
    Mutation::FlipBit,
    Mutation::SetByte,
    Mutation::SetMeaningful,
    Mutation::SetWord,
    Mutation::Remove,
    Mutation::Insert,
    Mutation::Repeat,
    Mutation::Enlarge,
];

fn mutate(bytes: &mut Vec<u8>, mutation: Mutation, random: &mut Rng) {
    let at = random.usize(..bytes.len());
    let end = (at + random.usize(..20)).min(bytes.len());
    match mutation {
        Mutation::FlipBit => bytes[at] ^= 1 << random.usize(..8),
        Mutation::SetByte => bytes[at] = random.u8(..),
        Mutation::SetMeaningful => {
            let meaningful = b" \t\n\r\\/#-+.0123456789einfvtpsolmgx\0\xff";
            bytes[at] = meaningful[random.usize(..meaningful.len())];
        }
        Mutation::SetWord => {
            let words = [
                u32::MAX,
                0,
                1 << 31,
                0x7f80_0000,
                0x7fc0_0000,
                0x7f7f_ffff,
                1,
                1 << 24,
            ];
            let word = words[random.usize(..words.len())].to_le_bytes();
            let end = (at + 4).min(bytes.len());
            bytes[at..end].copy_from_slice(&word[..end - at]);
        }
        Mutation::Remove => drop(bytes.drain(at..end)),
        Mutation::Insert => {
            let inserted: Vec<u8> = (0..random.usize(..12)).map(|_| random.u8(..)).collect();
            bytes.splice(at..at, inserted);
        }
        Mutation::Repeat => {
            let part = bytes[at..end].to_vec();
            bytes.splice(at..at, part.repeat(1 + random.usize(..30)));
        }
        Mutation::Enlarge => {
            if let Some(digit) = bytes[at..].iter().position(u8::is_ascii_digit) {
                bytes.splice(at + digit..at + digit, vec![b'9'; random.usize(..25)]);
            }
        }
    }
    if bytes.is_empty() {
        bytes.push(0);
    }
}

#[test]
fn the_files_themselves_are_read() {
    for fixture in fixtures() {
        assert!(read(&fixture, &fixture.bytes), "{}", fixture.name);
        // The others need what `read` gives them.
        if fixture.side_file.is_none() && fixture.name != "3mf model" {
            let (bytes, limits) = (&fixture.bytes, limits());
            let loaded = parse_model(bytes, fixture.format, "", &NoResources, &limits);
            assert!(loaded.is_ok(), "{}", fixture.name);
        }
    }
}

/// Rows: M7.
#[test]
fn every_prefix_ends_well() {
    for fixture in fixtures() {
        for length in 0..fixture.bytes.len() {
            read(&fixture, &fixture.bytes[..length]);
        }
    }
}

/// Rows: M7.
#[test]
fn every_mutation_ends_well() {
    let count = std::env::var("ESTAMPE_MUTATIONS")
        .ok()
        .and_then(|text| text.parse().ok());
    let count = count.unwrap_or(2000);
    for (seed, fixture) in (1..).zip(fixtures()) {
        let mut random = Rng::with_seed(seed);
        let mut survivors = 0;
        for mutation in MUTATIONS {
            for round in 0..count {
                let mut bytes = fixture.bytes.clone();
                // Mostly one mutation, which gets past the first checks; sometimes many.
                for _ in 0..=(round % 8) / 2 * random.usize(..3) {
                    mutate(&mut bytes, mutation, &mut random);
                }
                survivors += usize::from(read(&fixture, &bytes));
            }
        }
        assert!(
            survivors > 0,
            "some mutations of {} are harmless",
            fixture.name
        );
    }
}

/// Every prefix of real files under 64 KB.
#[test]
#[ignore = "needs ../shared/data/models, and minutes in release"]
fn every_prefix_of_real_files_ends_well() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/models");
    let files = [
        "suzanne.obj",
        "odd-obj/cornell_box.obj",
        "odd-obj/usemtl-issue-68.obj",
        "odd-obj/issue-138.obj",
        "odd-obj/skin-weight.obj",
        "stl/20mm-xyz-cube.stl",
        "stl/multibody.stl",
        "stl/two_objects_mixed_case_names.stl",
        "stl/teapot.stl",
        "ply/cube_blender_uv.ply",
        "ply/sphere.ply",
        "ply/points_ascii_with_lists.ply",
    ];
    for name in files {
        let path = folder.join(name);
        let bytes = std::fs::read(&path).unwrap_or_else(|error| panic!("{name}: {error}"));
        let format = ModelFormat::from_extension(&path).unwrap();
        for length in 0..bytes.len() {
            let bytes = &bytes[..length];
            if let Ok(loaded) = parse_model(bytes, format, name, &NoResources, &limits()) {
                check(&loaded.scene);
            }
        }
    }
}
