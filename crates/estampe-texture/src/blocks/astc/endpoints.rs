//! The two colours of a partition from their codes (section 23.14).

/// Two colours, 16 bits a channel.
pub(super) type Ends = [[u32; 4]; 2];

/// The colours of a mode; `None` for HDR modes.
pub(super) fn ends_of(mode: u32, v: [i32; 8], is_srgb: bool) -> Option<Ends> {
    let gray = |l: i32, a: i32| [l, l, l, a];
    let scaled = |a: i32| {
        [
            (v[0] * v[3]) >> 8,
            (v[1] * v[3]) >> 8,
            (v[2] * v[3]) >> 8,
            a,
        ]
    };
    let even = |a: i32| [v[0], v[2], v[4], a];
    let odd = |a: i32| [v[1], v[3], v[5], a];
    let ends = match mode {
        0 => [gray(v[0], 255), gray(v[1], 255)],
        1 => {
            let low = v[0] >> 2 | v[1] & 0xC0;
            [gray(low, 255), gray(low + (v[1] & 0x3F), 255)]
        }
        4 => [gray(v[0], v[2]), gray(v[1], v[3])],
        5 => {
            let ([l, dl], [a, da]) = (base_and_offset(v[0], v[1]), base_and_offset(v[2], v[3]));
            [gray(l, a), gray(l + dl, a + da)]
        }
        6 => [scaled(255), [v[0], v[1], v[2], 255]],
        10 => [scaled(v[4]), [v[0], v[1], v[2], v[5]]],
        8 | 12 => {
            let (a, b) = if mode == 8 { (255, 255) } else { (v[6], v[7]) };
            if v[1] + v[3] + v[5] >= v[0] + v[2] + v[4] {
                [even(a), odd(b)]
            } else {
                [contracted(odd(b)), contracted(even(a))]
            }
        }
        9 | 13 => {
            let [r, dr] = base_and_offset(v[0], v[1]);
            let [g, dg] = base_and_offset(v[2], v[3]);
            let [b, db] = base_and_offset(v[4], v[5]);
            let [a, da] = if mode == 9 {
                [255, 0]
            } else {
                base_and_offset(v[6], v[7])
            };
            let (base, moved) = ([r, g, b, a], [r + dr, g + dg, b + db, a + da]);
            if dr + dg + db >= 0 {
                [base, moved]
            } else {
                [contracted(moved), contracted(base)]
            }
        }
        _ => return None,
    };
    Some(ends.map(|end| {
        std::array::from_fn(|k| {
            let code = end[k].clamp(0, 255).cast_unsigned();
            // sRGB takes the upper half of the mixture, which this centres.
            let low = if is_srgb && k < 3 { 0x80 } else { code };
            code << 8 | low
        })
    }))
}

/// A base of eight bits and a signed offset of six, from two codes: a bit of the offset's belongs
/// to the base.
fn base_and_offset(base: i32, offset: i32) -> [i32; 2] {
    let six = offset >> 1 & 0x3F;
    [base >> 1 | offset & 0x80, (six ^ 0x20) - 0x20]
}

/// Red and green halfway to blue.
fn contracted([r, g, b, a]: [i32; 4]) -> [i32; 4] {
    [(r + b) >> 1, (g + b) >> 1, b, a]
}
