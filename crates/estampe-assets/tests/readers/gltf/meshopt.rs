//! EXT_meshopt_compression. The compressed data was made by meshoptimizer 1.3 (`encodeGltfBuffer`,
//! version 0) from the numbers that the tests compute.

use super::builder::{U16, U32};
use super::{Builder, error, load, mesh};
use glam::Vec3;
use serde_json::{Value, json};

/// A grid of 5×5 squares, two triangles each.
const GRID: &str = "e1fe1e100e100e100e100efe1e190e180e170e160eff1e160e160e160e160eff1e160e160e160e160eff1e16\
    0e160e160e160e0f0c9f025f090c5f090c5f090c007687566778a9866589689801690000";
/// 30 indices (7919 i²) mod 100003.
const JUMPS_AS_TRIANGLES: &str = "e1feffffffffffffffffffffde7b9af302ffd6ea04b3b805ced908ffbbc901802e89f509fff89c04b49406d5\
    8e04ff999702dd1fded701ff9acf03efd30692be07fff7e402bb6d808a01ffbc8103cda107b4f006ffd5b203\
    99bb01a23cffdeb302abef07d6a206007687566778a9866589689801690000";
const JUMPS: &str = "d100bdf701f0dd07e1bb0fba9b01b5c206a4a00ef7b602928e13a3b00bd8e214bd8b04decb0cefed0480f002\
    f1cd0aaa8906c5d401b4b209e7a4078839f99608a2c008b362bcfb06dfdb09eefd0181e0059af70aab990300\
    000000";
/// 20 indices: 0, 100, 1, 101, 2, …
const STRIP: &str = "d100910304050405040504050405040504050405040500000000";
/// 40 rows of four u16: i, ⌊i² ÷ 4⌋, 40503 i, 7.
const ROWS: &str = "a0152aaaaaaaaaaaaaaaaaaa0000001e0022446688aaccee101012121414161618181a1a1c1c1e1effff0000\
    202022222424262610800000001f006e6e6e6e6e6e6e6e6e6e6e6e6e6e6e6e6e6e6e6e6e6e6e6e6e6e6e6e6e\
    6e6effff00006e6e6e6e6e6e6e6e1f00c3c3c3c3c1c3c3c3c3c1c3c3c3c1c3c3c3c3c1c3c3c3c3c1c3c3c3c1\
    c3c3c3ffff0000c3c1c3c3c3c3c1c30000000000000000000000000000000000000000000000000000000000\
    0000000700";
/// Twelve directions, with −1 and 1 in turn: in 8 bits, and in 12 of 16 bits.
const OCTAHEDRAL_8: &str = "a0013fffff00d73db87c469819a53d956b013fffff0020ad3787ed30b2142f2f7b0002034343434343000000\
    0000000000000000000000000000000000000000000000000000007f007f81";
const OCTAHEDRAL_16: &str = "a0013fffff0072046b535c756a815c92c5020b3cf680bf770000191c013fffff000efa7643f1fbdbbffbe834\
    0202b3fd2c013700001800000203434343434300000119999900000000000000000000000000000000000000\
    000000000000ff070000ff070180";
/// Twelve rotations in 12 of 16 bits.
const QUATERNIONS: &str = "a0013fffff00199cec1efd0c4ee93d95460202df92371887000018013fffff000abd6a6772adee2e1ccd0f02\
    0ebb2e4d7cc90000013fffff00a09b22214fa348807be2220204551a008ff90000171601285d470006060000\
    0000000000000000000000000000000000000000000000000000000000fc07";
/// Twelve rows 1.5^(i − 3), −i ÷ 7, 1000 i in 15 bits.
const EXPONENTIAL: &str = "a0013f3fff0098e2a9ff80c020cfc82c010aafff0004080a0e18220000013fffff00dcdadcdcdcdadcdcdadc\
    dc020997979799790000011000000000013fffff002f2f2f2f2f2f2f2f2f2f2f020688888888860000000000\
    00000000000000000000000000000000000000980000f7000000f300000000";

fn bytes(hex: &str) -> Vec<u8> {
    let digit = |at: usize| u8::from_str_radix(&hex[at..at + 2], 16).expect("hexadecimal digits");
    (0..hex.len()).step_by(2).map(digit).collect()
}

/// A file whose accessor 0 is a compressed view of `count` elements of `stride` bytes.
fn compressed(
    data: &[u8],
    [count, stride]: [usize; 2],
    mode: &str,
    filter: Option<&str>,
) -> Builder {
    let mut file = Builder::new();
    let mut extension = json!({ "buffer": 0, "byteLength": data.len(), "byteStride": stride,
                                "count": count, "mode": mode });
    if let Some(filter) = filter {
        extension["filter"] = json!(filter);
    }
    file.bin = data.to_vec();
    // The uncompressed buffer does not exist.
    let view = json!({ "buffer": 1, "byteLength": count * stride,
                       "extensions": { "EXT_meshopt_compression": extension } });
    file.set("/bufferViews", json!([view]));
    let buffers = json!([{ "byteLength": data.len() }, { "byteLength": count * stride }]);
    file.set("/buffers", buffers);
    file.set("/extensionsRequired", json!(["EXT_meshopt_compression"]));
    file
}

/// A file of twelve compressed points.
pub(crate) fn compressed_points() -> Builder {
    let accessor = json!({ "bufferView": 0, "componentType": 5126, "count": 12, "type": "VEC3" });
    points(&bytes(EXPONENTIAL), [12, 12], Some("EXPONENTIAL"), accessor)
}

/// A file that draws the compressed elements as points.
fn points(data: &[u8], size: [usize; 2], filter: Option<&str>, accessor: Value) -> Builder {
    let mut file = compressed(data, size, "ATTRIBUTES", filter);
    file.set("/accessors", json!([accessor]));
    file.set(
        "/meshes",
        json!([{ "primitives": [{ "attributes": { "POSITION": 0 }, "mode": 0 }] }]),
    );
    file.set("/nodes/0/mesh", json!(0));
    file
}

/// The indices of a compressed view, as they are read: those of a line strip.
fn indices(data: &[u8], count: usize, stride: usize, mode: &str) -> Vec<u32> {
    let mut file = compressed(data, [count, stride], mode, None);
    let component = if stride == 2 { U16 } else { U32 };
    file.set(
        "/accessors",
        json!([
            { "bufferView": 0, "componentType": component, "count": count, "type": "SCALAR" },
            { "componentType": 5126, "count": 100_003, "type": "VEC3" },
        ]),
    );
    let primitive = json!({ "attributes": { "POSITION": 1 }, "indices": 0, "mode": 0 });
    file.set("/meshes", json!([{ "primitives": [primitive] }]));
    file.set("/nodes/0/mesh", json!(0));
    mesh(&file).points
}

/// The triangle with its least index first, its winding unchanged.
fn turned(&[a, b, c]: &[u32; 3]) -> [u32; 3] {
    [[a, b, c], [b, c, a], [c, a, b]]
        .into_iter()
        .min()
        .expect("three of them")
}

#[test]
fn triangles_are_decoded() {
    let mut expected = Vec::new();
    for corner in (0..5).flat_map(|y| (0..5).map(move |x| y * 6 + x)) {
        expected.push([corner, corner + 1, corner + 6]);
        expected.push([corner + 1, corner + 7, corner + 6]);
    }
    let decoded = indices(&bytes(GRID), 150, 2, "TRIANGLES");
    let decoded: Vec<[u32; 3]> = decoded.as_chunks::<3>().0.iter().map(turned).collect();
    assert_eq!(decoded, expected);
    let jumps: Vec<u32> = (0..30).map(|i| i * i * 7919 % 100_003).collect();
    let decoded = indices(&bytes(JUMPS_AS_TRIANGLES), 30, 4, "TRIANGLES");
    let turned_all = |all: &[u32]| {
        all.as_chunks::<3>()
            .0
            .iter()
            .map(turned)
            .collect::<Vec<_>>()
    };
    assert_eq!(turned_all(&decoded), turned_all(&jumps));
}

#[test]
fn indices_are_decoded() {
    let jumps: Vec<u32> = (0..30).map(|i| i * i * 7919 % 100_003).collect();
    assert_eq!(indices(&bytes(JUMPS), 30, 4, "INDICES"), jumps);
    let strip: Vec<u32> = (0..20).map(|i| i % 2 * 100 + i / 2).collect();
    assert_eq!(indices(&bytes(STRIP), 20, 2, "INDICES"), strip);
}

#[test]
fn attributes_are_decoded() {
    let accessor = json!({ "bufferView": 0, "componentType": U16, "count": 40, "type": "VEC3" });
    let decoded = mesh(&points(&bytes(ROWS), [40, 8], None, accessor)).positions;
    let expected = (0..40_u32).map(|i| {
        let hash = (i * 40503) & 0xffff;
        Vec3::new(i as f32, (i * i / 4) as f32, hash as f32)
    });
    assert_eq!(decoded, expected.collect::<Vec<_>>());
}

/// cos a cos b, sin a cos b, sin b.
fn direction(i: usize) -> Vec3 {
    let (a, b) = (i as f32 * 0.7, i as f32 * 1.3);
    Vec3::new(
        libm::cosf(a) * libm::cosf(b),
        libm::sinf(a) * libm::cosf(b),
        libm::sinf(b),
    )
}

#[test]
fn octahedral_directions_are_unfolded() {
    for (data, stride, component, tolerance) in [
        (OCTAHEDRAL_8, 4, 5120, 0.02),
        (OCTAHEDRAL_16, 8, 5122, 0.001),
    ] {
        let accessor = json!({ "bufferView": 0, "componentType": component, "count": 12, "type": "VEC3",
                               "normalized": true });
        let file = points(&bytes(data), [12, stride], Some("OCTAHEDRAL"), accessor);
        for (i, decoded) in mesh(&file).positions.iter().enumerate() {
            assert!(
                (*decoded - direction(i)).length() < tolerance,
                "{i}: {decoded}"
            );
        }
        // The fourth component stays: as a size below, −127 and 127 or −32768 and 32767.
        let fourth = json!({ "bufferView": 0, "componentType": component, "count": 12, "type": "VEC3",
                             "byteOffset": stride / 4, "normalized": true });
        let file = points(&bytes(data), [12, stride], Some("OCTAHEDRAL"), fourth);
        for (i, decoded) in mesh(&file).positions.iter().enumerate() {
            assert_eq!(decoded.z, if i % 2 == 0 { -1.0 } else { 1.0 });
        }
    }
}

#[test]
fn quaternions_get_their_largest_component() {
    let accessor = json!({ "bufferView": 0, "componentType": 5122, "count": 12, "type": "VEC3",
                           "normalized": true });
    for offset in [0, 2] {
        let mut accessor = accessor.clone();
        accessor["byteOffset"] = json!(offset);
        let file = points(&bytes(QUATERNIONS), [12, 8], Some("QUATERNION"), accessor);
        for (i, decoded) in mesh(&file).positions.iter().enumerate() {
            let (a, b) = (i as f32 * 0.7, i as f32 * 1.3);
            let (sa, ca, sb, cb) = (libm::sinf(a), libm::cosf(a), libm::sinf(b), libm::cosf(b));
            let all = [ca * cb, ca * sb, sa * cb, sa * sb];
            let expected = Vec3::from_slice(&all[offset / 2..]);
            // A quaternion and its negative are the same rotation.
            let distance = (*decoded - expected)
                .length()
                .min((*decoded + expected).length());
            assert!(distance < 0.002, "{i}: {decoded} for {expected}");
        }
    }
}

#[test]
fn exponents_become_floats() {
    let accessor = json!({ "bufferView": 0, "componentType": 5126, "count": 12, "type": "VEC3" });
    let file = points(&bytes(EXPONENTIAL), [12, 12], Some("EXPONENTIAL"), accessor);
    for (i, decoded) in mesh(&file).positions.iter().enumerate() {
        let x = libm::powf(1.5, i as f32 - 3.0);
        let expected = Vec3::new(x, i as f32 / -7.0, i as f32 * 1000.0);
        // Each column shares an exponent, so its error is a part of its largest number.
        let error = (*decoded - expected).abs();
        assert!(
            error.x < 0.002 && error.y < 1e-4 && error.z < 1.0,
            "{i}: {decoded}"
        );
    }
}

#[test]
fn damaged_data_is_refused() {
    let accessor = json!({ "bufferView": 0, "componentType": U16, "count": 40, "type": "VEC3" });
    let rows = bytes(ROWS);
    let check = |data: &[u8], message: &str| {
        let error = error(&points(data, [40, 8], None, accessor.clone()));
        let place =
            "/bufferViews/0/extensions/EXT_meshopt_compression: the compressed data is damaged: ";
        assert!(error.contains(&format!("{place}{message}")), "{error}");
    };
    check(&[], "it ends too early");
    check(&rows[..30], "it ends too early");
    check(&rows[..rows.len() - 40], "it ends too early");
    check(&[&rows[..50], &[0], &rows[50..]].concat(), "");
    check(
        &[&[0xe1], &rows[1..]].concat(),
        "its first byte is not that of the mode",
    );
    let zeros = [&[0xa0][..], &[0; 24], &[0; 33]].concat();
    check(&zeros, "bytes are left at its end");

    let indices =
        |data: &str, count: usize, stride: usize, mode: &str, change: fn(&mut Vec<u8>)| {
            let mut data = bytes(data);
            change(&mut data);
            let mut file = compressed(&data, [count, stride], mode, None);
            let kind =
                json!({ "bufferView": 0, "componentType": U16, "count": count, "type": "SCALAR" });
            let zeros = json!({ "componentType": 5126, "count": 36, "type": "VEC3" });
            file.set("/accessors", json!([kind, zeros]));
            let primitive = json!({ "attributes": { "POSITION": 1 }, "indices": 0 });
            file.set("/meshes", json!([{ "primitives": [primitive] }]));
            file.set("/nodes/0/mesh", json!(0));
            error(&file)
        };
    for (data, count, stride, mode) in [
        (GRID, 150, 2, "TRIANGLES"),
        (STRIP, 20, 2, "INDICES"),
        (JUMPS, 30, 4, "INDICES"),
    ] {
        let short = indices(data, count, stride, mode, |data| data.truncate(15));
        assert!(short.contains("it ends too early"), "{short}");
        let long = indices(data, count, stride, mode, |data| {
            data.insert(data.len() - 16, 1)
        });
        assert!(long.contains("bytes are left at its end"), "{mode}: {long}");
        let other = indices(data, count, stride, mode, |data| data[0] = 0);
        assert!(other.contains("its first byte is not"), "{other}");
    }
}

#[test]
fn wrong_descriptions_are_refused() {
    let place = "/bufferViews/0/extensions/EXT_meshopt_compression";
    let accessor = json!({ "bufferView": 0, "componentType": U16, "count": 40, "type": "VEC3" });
    let file = points(&bytes(ROWS), [40, 8], None, accessor);
    for (property, value, message) in [
        (
            "mode",
            json!("STRIPS"),
            "/mode: the mode `STRIPS` with the filter None is not defined",
        ),
        ("filter", json!("COLOR"), "/filter: `COLOR` is not a filter"),
        (
            "byteStride",
            json!(6),
            "/byteStride: elements of 6 bytes do not fit",
        ),
        (
            "byteStride",
            json!(0),
            "/byteStride: elements of 0 bytes do not fit",
        ),
        (
            "byteStride",
            json!(260),
            "/byteStride: elements of 260 bytes do not fit",
        ),
        (
            "count",
            json!(41),
            "/count: 41 elements of 8 bytes are not the 320 bytes",
        ),
        (
            "count",
            json!(u64::MAX),
            "/count: 18446744073709551615 elements",
        ),
        ("buffer", json!(7), "/buffer: buffer 7 does not exist"),
        (
            "byteLength",
            json!(9999),
            ": bytes 0 to 9999 are outside of buffer 0",
        ),
    ] {
        let error = error(&file.clone().with(&format!("{place}/{property}"), value));
        assert!(error.contains(&format!("{place}{message}")), "{error}");
    }
    let filtered = |filter: &str, stride: usize| {
        let accessor =
            json!({ "bufferView": 0, "componentType": U16, "count": 40, "type": "VEC3" });
        error(&points(&bytes(ROWS), [40, stride], Some(filter), accessor))
    };
    assert!(filtered("OCTAHEDRAL", 12).contains("elements of 12 bytes do not fit"));
    assert!(filtered("QUATERNION", 4).contains("elements of 4 bytes do not fit"));
    let mut triangles = compressed(&bytes(STRIP), [20, 2], "TRIANGLES", None);
    triangles.set(
        "/accessors",
        json!([{ "bufferView": 0, "componentType": U16, "count": 20, "type": "VEC3" }]),
    );
    triangles.set(
        "/meshes",
        json!([{ "primitives": [{ "attributes": { "POSITION": 0 } }] }]),
    );
    triangles.set("/nodes/0/mesh", json!(0));
    assert!(error(&triangles).contains("/count: 20 is not a multiple of 3"));
}

#[test]
fn a_small_file_cannot_ask_for_much_memory() {
    const COUNT: usize = 4_000_000_000;
    for (mode, stride, header) in [
        ("ATTRIBUTES", 256, 0xa0),
        ("TRIANGLES", 4, 0xe1),
        ("INDICES", 4, 0xd1),
    ] {
        let count = COUNT / stride / 3 * 3;
        let mut data = vec![0; 400];
        data[0] = header;
        let mut file = compressed(&data, [count, stride], mode, None);
        file.set(
            "/accessors",
            json!([{ "bufferView": 0, "componentType": U16, "count": 1, "type": "VEC3" }]),
        );
        file.set(
            "/meshes",
            json!([{ "primitives": [{ "attributes": { "POSITION": 0 } }] }]),
        );
        file.set("/nodes/0/mesh", json!(0));
        let error = error(&file);
        assert!(error.contains("need more than 1073741824 bytes"), "{error}");
        // Half a gigabyte is within the limit, and not in 400 bytes.
        let count = count / 8 / 3 * 3;
        file.set(
            "/bufferViews/0/extensions/EXT_meshopt_compression/count",
            json!(count),
        );
        file.set("/bufferViews/0/byteLength", json!(count * stride));
        let error = super::error(&file);
        assert!(error.contains("it ends too early"), "{error}");
    }
}

#[test]
fn mutations_of_compressed_data_end_well() {
    let mut random = fastrand::Rng::with_seed(7);
    for (data, size, mode, filter) in [
        (ROWS, [40, 8], "ATTRIBUTES", None),
        (OCTAHEDRAL_16, [12, 8], "ATTRIBUTES", Some("OCTAHEDRAL")),
        (OCTAHEDRAL_8, [12, 4], "ATTRIBUTES", Some("OCTAHEDRAL")),
        (QUATERNIONS, [12, 8], "ATTRIBUTES", Some("QUATERNION")),
        (EXPONENTIAL, [12, 12], "ATTRIBUTES", Some("EXPONENTIAL")),
        (GRID, [150, 2], "TRIANGLES", None),
        (JUMPS_AS_TRIANGLES, [30, 4], "TRIANGLES", None),
        (JUMPS, [30, 4], "INDICES", None),
    ] {
        let original = bytes(data);
        let mut survivors = 0;
        for _ in 0..500 {
            let mut data = original.clone();
            for _ in 0..=random.usize(..3) {
                let at = random.usize(..data.len());
                data[at] = random.u8(..);
            }
            let mut file = compressed(&data, size, mode, filter);
            // Nothing draws the view, so errors have no effect, but it is decoded.
            file.set(
                "/accessors",
                json!([{ "bufferView": 0, "componentType": 5121, "count": 1, "type": "VEC3" }]),
            );
            file.set(
                "/meshes",
                json!([{ "primitives": [{ "attributes": { "POSITION": 0 }, "mode": 0 }] }]),
            );
            file.set("/nodes/0/mesh", json!(0));
            let read = file.try_load_with(&estampe_assets::ModelOptions::default());
            survivors += usize::from(read.is_ok());
        }
        assert!(
            survivors > 0,
            "some mutations of {mode} {filter:?} are harmless"
        );
    }
}

#[test]
fn undecoded_views_are_no_error_until_they_are_needed() {
    let mut file = Builder::triangle();
    let view = file.view(&[1, 2, 3, 4]);
    let extension =
        json!({ "buffer": 0, "byteLength": 4, "byteStride": 4, "count": 1, "mode": "INDICES" });
    let pointer = format!("/bufferViews/{view}/extensions");
    file.set(&pointer, json!({ "EXT_meshopt_compression": extension }));
    assert_eq!(load(&file.glb()).scene.meshes[0].triangles.len(), 1);
}
