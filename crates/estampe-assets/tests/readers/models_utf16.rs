//! Text in UTF-16 is read as the same text in UTF-8.

use estampe_assets::model::{ResourceError, Resources};
use estampe_assets::{Limits, Loaded, ModelFormat, parse_model};

const OBJ: &str = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\no é\nusemtl grün\nf 1 2 3\n";
const MTL: &str = "newmtl grün\nKd 0 1 0\n";
const STL: &str = "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n\
                   vertex 0 1 0\nendloop\nendfacet\nendsolid s\n";
const OFF: &str = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
                   property float z\nelement face 1\nproperty list uchar int vertex_indices\n\
                   end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

/// The library of materials.
struct Library(Vec<u8>);

impl Resources for Library {
    fn resolve(&self, name: &str) -> Result<String, ResourceError> {
        Ok(name.to_owned())
    }

    fn read(&self, _: &str, _: u64) -> Result<Vec<u8>, ResourceError> {
        Ok(self.0.clone())
    }
}

fn utf16(text: &str, to_bytes: fn(u16) -> [u8; 2]) -> Vec<u8> {
    let marked = format!("\u{feff}{text}");
    marked.encode_utf16().flat_map(to_bytes).collect()
}

fn read(bytes: &[u8], format: ModelFormat, library: Vec<u8>) -> Loaded {
    let loaded = parse_model(bytes, format, "m", &Library(library), &Limits::default());
    loaded.unwrap_or_else(|error| panic!("{format:?}: {error}"))
}

#[test]
fn text_in_utf16_is_read() {
    for (text, format) in [
        (OBJ, ModelFormat::Obj),
        (STL, ModelFormat::Stl),
        (OFF, ModelFormat::Off),
        (PLY, ModelFormat::Ply),
    ] {
        let expected = read(text.as_bytes(), format, MTL.into());
        assert_eq!(expected.scene.meshes[0].triangles.len(), 1, "{format:?}");
        for to_bytes in [u16::to_le_bytes, u16::to_be_bytes] {
            let found = read(&utf16(text, to_bytes), format, utf16(MTL, to_bytes));
            let content = |of: &Loaded| format!("{:?} {:?}", of.scene.meshes, of.scene.materials);
            assert_eq!(content(&found), content(&expected), "{format:?}");
            assert_eq!(found.warning_count, expected.warning_count, "{format:?}");
        }
    }
}

/// The first 80 bytes of a binary STL may be anything.
#[test]
fn binary_stl_is_not_taken_for_text() {
    let mut bytes = vec![0xff, 0xfe];
    bytes.resize(80, 0);
    bytes.extend(1_u32.to_le_bytes());
    for number in [
        0.0_f32, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0,
    ] {
        bytes.extend(number.to_le_bytes());
    }
    bytes.extend([0, 0]);
    let loaded = read(&bytes, ModelFormat::Stl, Vec::new());
    assert_eq!(loaded.scene.meshes[0].triangles.len(), 1);
}
