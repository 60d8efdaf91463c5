//! The properties of every format, written by hand from WebGPU's "Texture Format Capabilities",
//! "Vertex Formats" and "Packed Formats", and the Khronos Data Format Specification.

use super::super::*;

/// The encoding of a channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Unorm,
    Snorm,
    Uint,
    Sint,
    Float,
    UnsignedFloat,
    SharedExponent,
}
use Kind::{Float, SharedExponent, Sint, Snorm, Uint, Unorm, UnsignedFloat};

/// Name, kind, and the number of bits of each channel, R first.
const COLORS: &[(&str, Kind, &[u32])] = &[
    ("r8unorm", Unorm, &[8]),
    ("r8snorm", Snorm, &[8]),
    ("r8uint", Uint, &[8]),
    ("r8sint", Sint, &[8]),
    ("rg8unorm", Unorm, &[8, 8]),
    ("rg8snorm", Snorm, &[8, 8]),
    ("rg8uint", Uint, &[8, 8]),
    ("rg8sint", Sint, &[8, 8]),
    ("rgba8unorm", Unorm, &[8, 8, 8, 8]),
    ("rgba8unorm-srgb", Unorm, &[8, 8, 8, 8]),
    ("bgra8unorm", Unorm, &[8, 8, 8, 8]),
    ("bgra8unorm-srgb", Unorm, &[8, 8, 8, 8]),
    ("rgba8snorm", Snorm, &[8, 8, 8, 8]),
    ("rgba8uint", Uint, &[8, 8, 8, 8]),
    ("rgba8sint", Sint, &[8, 8, 8, 8]),
    ("r16unorm", Unorm, &[16]),
    ("r16snorm", Snorm, &[16]),
    ("r16uint", Uint, &[16]),
    ("r16sint", Sint, &[16]),
    ("r16float", Float, &[16]),
    ("rg16unorm", Unorm, &[16, 16]),
    ("rg16snorm", Snorm, &[16, 16]),
    ("rg16uint", Uint, &[16, 16]),
    ("rg16sint", Sint, &[16, 16]),
    ("rg16float", Float, &[16, 16]),
    ("rgba16unorm", Unorm, &[16, 16, 16, 16]),
    ("rgba16snorm", Snorm, &[16, 16, 16, 16]),
    ("rgba16uint", Uint, &[16, 16, 16, 16]),
    ("rgba16sint", Sint, &[16, 16, 16, 16]),
    ("rgba16float", Float, &[16, 16, 16, 16]),
    ("r32uint", Uint, &[32]),
    ("r32sint", Sint, &[32]),
    ("r32float", Float, &[32]),
    ("rg32uint", Uint, &[32, 32]),
    ("rg32sint", Sint, &[32, 32]),
    ("rg32float", Float, &[32, 32]),
    ("rgba32uint", Uint, &[32, 32, 32, 32]),
    ("rgba32sint", Sint, &[32, 32, 32, 32]),
    ("rgba32float", Float, &[32, 32, 32, 32]),
    ("rgb10a2unorm", Unorm, &[10, 10, 10, 2]),
    ("rgb10a2uint", Uint, &[10, 10, 10, 2]),
    ("rg11b10ufloat", UnsignedFloat, &[11, 11, 10]),
    // Three mantissas; the exponent has 5 bits.
    ("rgb9e5ufloat", SharedExponent, &[9, 9, 9]),
];

/// Name, bits of depth, bits of stencil, bytes of a texel in memory.
const DEPTHS: &[(&str, u32, u32, u32)] = &[
    ("stencil8", 0, 8, 1),
    ("depth16unorm", 16, 0, 2),
    ("depth24plus", 24, 0, 4),
    ("depth24plus-stencil8", 24, 8, 4),
    ("depth32float", 32, 0, 4),
    ("depth32float-stencil8", 32, 8, 8),
];

/// Name, channels and bytes of a block of 4×4 texels; whether an sRGB variant exists.
const BLOCKS: &[(&str, usize, u32, bool)] = &[
    ("bc1-rgba-unorm", 4, 8, true),
    ("bc2-rgba-unorm", 4, 16, true),
    ("bc3-rgba-unorm", 4, 16, true),
    ("bc4-r-unorm", 1, 8, false),
    ("bc4-r-snorm", 1, 8, false),
    ("bc5-rg-unorm", 2, 16, false),
    ("bc5-rg-snorm", 2, 16, false),
    ("bc6h-rgb-ufloat", 3, 16, false),
    ("bc6h-rgb-float", 3, 16, false),
    ("bc7-rgba-unorm", 4, 16, true),
    ("etc2-rgb8unorm", 3, 8, true),
    ("etc2-rgb8a1unorm", 4, 8, true),
    ("etc2-rgba8unorm", 4, 16, true),
    ("eac-r11unorm", 1, 8, false),
    ("eac-r11snorm", 1, 8, false),
    ("eac-rg11unorm", 2, 16, false),
    ("eac-rg11snorm", 2, 16, false),
];

/// The block sizes of ASTC in texels; each block has 16 bytes.
const ASTC: &[[u32; 2]] = &[
    [4, 4],
    [5, 4],
    [5, 5],
    [6, 5],
    [6, 6],
    [8, 5],
    [8, 6],
    [8, 8],
    [10, 5],
    [10, 6],
    [10, 8],
    [10, 10],
    [12, 10],
    [12, 12],
];

fn named(name: &str) -> TextureFormat {
    let found = TextureFormat::ALL
        .iter()
        .find(|format| format.name() == name);
    *found.unwrap_or_else(|| panic!("there is no format {name}"))
}

fn encoding(kind: Kind, bits: &[u32]) -> TexelEncoding {
    use TexelEncoding as E;
    match (kind, bits[0]) {
        (Unorm, 8) => E::Unorm8,
        (Unorm, 10) => E::Unorm10_2,
        (Unorm, 16) => E::Unorm16,
        (Snorm, 8) => E::Snorm8,
        (Snorm, 16) => E::Snorm16,
        (Uint, 8) => E::Uint8,
        (Uint, 10) => E::Uint10_2,
        (Uint, 16) => E::Uint16,
        (Uint, 32) => E::Uint32,
        (Sint, 8) => E::Sint8,
        (Sint, 16) => E::Sint16,
        (Sint, 32) => E::Sint32,
        (Float, 16) => E::Float16,
        (Float, 32) => E::Float32,
        (UnsignedFloat, 11) => E::Ufloat11_10,
        (SharedExponent, 9) => E::SharedExponent,
        other => panic!("no encoding for {other:?}"),
    }
}

/// Rows: F1, O8.
#[test]
fn colour_formats_are_those_of_the_table() {
    for &(name, kind, bits) in COLORS {
        let format = named(name);
        let is_integer = matches!(kind, Uint | Sint);
        let can_be_drawn_into = kind != SharedExponent;
        let exponent = if kind == SharedExponent { 5 } else { 0 };
        assert_eq!(format.encoding(), encoding(kind, bits), "{name}");
        assert_eq!(format.components(), bits.len(), "{name}");
        assert_eq!(
            format.block_bytes() * 8,
            bits.iter().sum::<u32>() + exponent,
            "{name}"
        );
        assert_eq!(format.block_size(), [1, 1], "{name}");
        assert_eq!(format.is_srgb(), name.ends_with("-srgb"), "{name}");
        assert_eq!(format.is_bgra(), name.starts_with("bgra"), "{name}");
        assert!(format.is_color() && !format.is_compressed(), "{name}");
        assert!(!format.has_depth() && !format.has_stencil(), "{name}");
        assert_eq!(format.is_renderable(), can_be_drawn_into, "{name}");
        assert_eq!(
            format.is_blendable(),
            can_be_drawn_into && !is_integer,
            "{name}"
        );
        let sample_type = match kind {
            Uint => SampleType::Uint,
            Sint => SampleType::Sint,
            _ => SampleType::Float,
        };
        assert_eq!(format.sample_type(), sample_type, "{name}");
        // The oracle's channels of this format.
        for (channel, &bits) in crate::channel::channels(format).iter().zip(bits) {
            let expected = if can_be_drawn_into { bits } else { 0 };
            assert_eq!(channel.bits(), expected, "{name}");
        }
    }
}

/// Rows: O3, O4.
#[test]
fn depth_and_stencil_formats_are_those_of_the_table() {
    use TexelEncoding as E;
    for &(name, depth, stencil, bytes) in DEPTHS {
        let format = named(name);
        let encoding = match depth {
            0 => E::Stencil,
            16 => E::Depth16,
            24 => E::Depth24,
            _ => E::Depth32,
        };
        assert_eq!(format.encoding(), encoding, "{name}");
        assert_eq!(format.has_depth(), depth > 0, "{name}");
        assert_eq!(format.has_stencil(), stencil > 0, "{name}");
        assert_eq!(format.block_bytes(), bytes, "{name}");
        assert_eq!(format.block_size(), [1, 1], "{name}");
        assert_eq!(format.components(), 1, "{name}");
        assert!(!format.is_color() && !format.is_renderable(), "{name}");
        assert!(!format.is_blendable() && !format.is_srgb(), "{name}");
        assert!(!format.is_bgra() && !format.is_compressed(), "{name}");
    }
}

/// Rows: F2.
#[test]
fn compressed_formats_are_those_of_the_table() {
    let check = |name: &str, [width, height]: [u32; 2], channels: usize, bytes: u32| {
        let format = named(name);
        assert!(format.is_compressed() && format.is_color(), "{name}");
        assert!(!format.is_renderable() && !format.is_blendable(), "{name}");
        assert!(!format.is_bgra() && !format.has_depth(), "{name}");
        assert_eq!(format.block_size(), [width, height], "{name}");
        assert_eq!(format.block_bytes(), bytes, "{name}");
        assert_eq!(format.components(), channels, "{name}");
        assert_eq!(format.is_srgb(), name.ends_with("-srgb"), "{name}");
        assert_eq!(format.sample_type(), SampleType::Float, "{name}");
    };
    let mut count = 0;
    for &(name, channels, bytes, has_srgb) in BLOCKS {
        check(name, [4, 4], channels, bytes);
        if has_srgb {
            check(&format!("{name}-srgb"), [4, 4], channels, bytes);
        }
        count += 1 + usize::from(has_srgb);
    }
    for &[width, height] in ASTC {
        let name = format!("astc-{width}x{height}-unorm");
        check(&name, [width, height], 4, 16);
        check(&format!("{name}-srgb"), [width, height], 4, 16);
        count += 2;
    }
    // Every format has a row, and none has two.
    assert_eq!(
        TextureFormat::ALL.len(),
        COLORS.len() + DEPTHS.len() + count
    );
    for (index, format) in TextureFormat::ALL.iter().enumerate() {
        assert_eq!(named(format.name()), *format);
        let before = &TextureFormat::ALL[..index];
        assert!(!before.iter().any(|other| other.name() == format.name()));
    }
}

/// Rows: V2.
#[test]
fn vertex_formats_are_those_of_the_table() {
    use VertexEncoding as E;
    let mut rows = vec![
        ("Unorm10_10_10_2".to_owned(), E::Unorm, 4, 4),
        ("Unorm8x4Bgra".to_owned(), E::Unorm, 4, 4),
    ];
    let mut add = |name: &str, encoding: E, bits: usize, counts: &[usize]| {
        for &count in counts {
            let times = match count {
                1 => String::new(),
                count => format!("x{count}"),
            };
            rows.push((
                format!("{name}{bits}{times}"),
                encoding,
                count,
                count * bits / 8,
            ));
        }
    };
    for bits in [8, 16] {
        for (name, encoding) in [
            ("Uint", E::Uint),
            ("Sint", E::Sint),
            ("Unorm", E::Unorm),
            ("Snorm", E::Snorm),
        ] {
            add(name, encoding, bits, &[1, 2, 4]);
        }
    }
    add("Float", E::Float, 16, &[1, 2, 4]);
    for (name, encoding) in [("Float", E::Float), ("Uint", E::Uint), ("Sint", E::Sint)] {
        add(name, encoding, 32, &[1, 2, 3, 4]);
    }
    assert_eq!(VertexFormat::ALL.len(), rows.len());
    for &format in VertexFormat::ALL {
        let name = format!("{format:?}");
        let row = rows.iter().find(|row| row.0 == name);
        let (_, encoding, components, bytes) = row.expect("a row of this name");
        assert_eq!(format.encoding(), *encoding, "{name}");
        assert_eq!(format.components(), *components, "{name}");
        assert_eq!(format.size_bytes(), *bytes, "{name}");
        let is_integer = matches!(encoding, E::Uint | E::Sint);
        let one = if is_integer { 1 } else { 0x3F80_0000 };
        assert_eq!([0, 1, 2, 3].map(|k| format.missing(k)), [0, 0, 0, one]);
    }
    let restarts = [IndexFormat::Uint8, IndexFormat::Uint16, IndexFormat::Uint32];
    assert_eq!(
        restarts.map(IndexFormat::restart),
        [0xFF, 0xFFFF, 0xFFFF_FFFF]
    );
}
