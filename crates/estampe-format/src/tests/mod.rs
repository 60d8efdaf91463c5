//! Every form for sixteen lanes against the form for one value, at every SIMD level; and both
//! against the numbers of the specifications.

mod attachments;
mod families;
mod vertices;

use estampe_simd::LANES;

/// Equal bits, or two NaNs.
fn same(a: f32, b: f32) -> bool {
    a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan()
}

/// Cuts values into packets, repeating the last one to fill them.
fn packets<T: Copy>(values: &[T]) -> impl Iterator<Item = [T; LANES]> + '_ {
    values.chunks(LANES).map(|chunk| {
        let mut packet = [chunk[chunk.len() - 1]; LANES];
        packet[..chunk.len()].copy_from_slice(chunk);
        packet
    })
}

/// Bits that are spread over all 32-bit numbers.
fn spread_bits(count: u32) -> impl Iterator<Item = u32> {
    (0..count).map(|i| {
        let mixed = (i ^ i >> 15).wrapping_mul(0x9E37_79B9);
        (mixed ^ mixed >> 13).wrapping_mul(0x85EB_CA6B)
    })
}

/// Numbers at which encodings change, with their neighbours, and others of every kind.
fn values() -> Vec<f32> {
    let mut edges = vec![
        0.0,
        1.0,
        0.5,
        65_504.0,
        65_520.0,
        65_024.0,
        64_512.0,
        1e9,
        f32::MAX,
    ];
    edges.extend([f32::MIN_POSITIVE, f32::from_bits(1), f32::INFINITY]);
    // Boundaries between the codes of 8 bits, and those of sRGB.
    edges.extend((0..256).map(|code| (code as f32 + 0.5) / 255.0));
    edges.extend((0..128).map(|code| (code as f32 + 0.5) / 127.0));
    edges.extend(crate::srgb::THRESHOLDS.iter());
    // Powers of two, and the ties between small floats next to them.
    for exponent in 90..150 {
        for mantissa in [
            0,
            1 << 12,
            1 << 16,
            1 << 17,
            3 << 12,
            3 << 16,
            3 << 17,
            0x7F_F000,
        ] {
            edges.push(f32::from_bits(exponent << 23 | mantissa));
        }
    }
    let mut values = Vec::new();
    for edge in edges {
        for value in [edge, edge.next_down(), edge.next_up()] {
            values.extend([value, -value]);
        }
    }
    values.extend([f32::NAN, -f32::NAN, f32::from_bits(0x7F80_0001)]);
    values.extend(spread_bits(20_000).map(f32::from_bits));
    // Most colours.
    values.extend(spread_bits(20_000).map(|bits| (bits >> 8) as f32 / 16_777_216.0));
    values
}
