//! Files of some hundred bytes that state millions of elements: memory is for what there is.

use super::peak_bytes;
use crate::gltf::builder::Builder;
use crate::threemf::archive;
use estampe_assets::model::NoResources;
use estampe_assets::{Limits, ModelFormat, parse_model};
use serde_json::json;

/// Over the file's own bytes.
const MAX_BYTES: usize = 1 << 20;

#[test]
fn memory_is_for_the_elements_that_a_file_has() {
    let ply = |format: &str, vertices: u32, faces: u32| {
        format!(
            "ply\nformat {format} 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\n\
             property float z\nelement face {faces}\nproperty list uint int vertex_indices\n\
             end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
        )
        .into_bytes()
    };
    let mut stl = vec![0; 80 + 4 + 50];
    stl[80..84].copy_from_slice(&99_999_999_u32.to_le_bytes());
    let mut gltf = Builder::triangle();
    gltf.set("/accessors/0/count", json!(49_999_999));
    let mut zip = archive::package(b"<model/>", &[], false);
    let record = { zip.windows(4) }.rposition(|window| window == b"PK\x01\x02");
    let length = record.expect("a record") + 24;
    zip[length..length + 4].copy_from_slice(&(1_u32 << 28).to_le_bytes());
    let mut glb = Builder::triangle().glb();
    glb[8..12].copy_from_slice(&(1_u32 << 30).to_le_bytes());
    let mut many_faces = ply("ascii", 3, 99_999_999);
    many_faces.extend(b"4000000000 1 2 3\n");
    let cases = [
        (
            "off",
            ModelFormat::Off,
            b"OFF 49999999 99999999 0\n0 0 0\n".to_vec(),
        ),
        (
            "off faces",
            ModelFormat::Off,
            b"OFF 1 99999999 0\n0 0 0\n3 0 0 0\n".to_vec(),
        ),
        (
            "off corners",
            ModelFormat::Off,
            b"OFF 1 1 0\n0 0 0\n4000000000 0 0\n".to_vec(),
        ),
        ("ascii ply", ModelFormat::Ply, ply("ascii", 49_999_999, 1)),
        ("ascii ply faces", ModelFormat::Ply, many_faces),
        (
            "binary ply",
            ModelFormat::Ply,
            ply("binary_little_endian", 49_999_999, 1),
        ),
        (
            "binary ply faces",
            ModelFormat::Ply,
            ply("binary_big_endian", 1, 99_999_999),
        ),
        ("stl", ModelFormat::Stl, stl),
        ("3mf", ModelFormat::ThreeMf, zip),
        ("gltf", ModelFormat::Gltf, gltf.gltf()),
        ("glb", ModelFormat::Gltf, glb),
    ];
    // The allocator counts for each thread.
    let limits = Limits {
        threads: 1,
        ..Limits::default()
    };
    for (name, format, bytes) in cases {
        let read = || {
            parse_model(&bytes, format, name, &NoResources, &limits).map(|loaded| loaded.warnings)
        };
        let (result, peak) = peak_bytes(read);
        eprintln!("{name}: {peak} bytes, {result:?}");
        assert!(peak < MAX_BYTES, "{name}: {peak} bytes");
        let said = match result {
            Ok(warnings) => warnings.first().map(ToString::to_string),
            Err(error) => Some(error.to_string()),
        };
        let said = said.expect("an error or a warning");
        assert!(said.starts_with(&format!("{name}, ")), "{said}: no place");
    }
}
