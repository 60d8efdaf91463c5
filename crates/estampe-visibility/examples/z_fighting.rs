//! Two planes 2 cm apart, far plane at 100 m: z-fighting, each of its remedies, and its onset.
//!
//! ```text
//! cargo run --release -p estampe-visibility --example z_fighting [OUT.png]
//! ```
//!
//! Above: near planes at 10⁻², 10⁻⁴ and 10⁻⁵ with 24 bits, and 10⁻² with 16 bits. Below, remedies
//! of the second: the planes moved apart to 1 m; the near plane moved to 1 m; 32-bit floats, which
//! gain nothing by themselves; floats with reversed depth. Red pixels are wrong; white ones on the
//! planes have the depth of the cleared buffer.

#![expect(clippy::print_stdout, reason = "examples print their results")]

use estampe::{Device, DeviceDescriptor};
use estampe_assets::image::{AlphaChannel, encode_png};
use estampe_scene::Image;
use estampe_visibility::precision::{DepthFormat, DepthMapping, DepthMethod};
use estampe_visibility::z_fighting::{EYE_HEIGHT, FAR_END, Fight, draw, onset};
use std::error::Error;

const FAR: f32 = 100.0;
const GAP: f32 = 0.02;

const PLAIN: DepthMapping = DepthMapping {
    is_reversed: false,
    is_logarithmic: false,
};
const REVERSED: DepthMapping = DepthMapping {
    is_reversed: true,
    is_logarithmic: false,
};
const LOGARITHMIC: DepthMapping = DepthMapping {
    is_reversed: false,
    is_logarithmic: true,
};

/// What is changed, the gap, the near plane, format and mapping.
type Scene = (&'static str, f32, f32, DepthFormat, DepthMapping);

const SCENES: [Scene; 8] = [
    ("near 1e-2, d24", GAP, 1e-2, DepthFormat::Unorm24, PLAIN),
    ("near 1e-4, d24", GAP, 1e-4, DepthFormat::Unorm24, PLAIN),
    ("near 1e-5, d24", GAP, 1e-5, DepthFormat::Unorm24, PLAIN),
    ("near 1e-2, d16", GAP, 1e-2, DepthFormat::Unorm16, PLAIN),
    (
        "near 1e-4, 1 m apart",
        1.0,
        1e-4,
        DepthFormat::Unorm24,
        PLAIN,
    ),
    ("near 1", GAP, 1.0, DepthFormat::Unorm24, PLAIN),
    ("near 1e-4, d32f", GAP, 1e-4, DepthFormat::Float32, PLAIN),
    (
        "near 1e-4, d32f reversed",
        GAP,
        1e-4,
        DepthFormat::Float32,
        REVERSED,
    ),
];

/// The scenes, drawn.
fn fights(device: &Device) -> Result<Vec<Fight>, Box<dyn Error>> {
    let mut fights = Vec::new();
    for (_, gap, near, format, mapping) in SCENES {
        let method = DepthMethod::new([near, FAR], format, mapping)?;
        fights.push(draw(device, &method, gap)?);
    }
    Ok(fights)
}

/// The pictures in two rows of four.
fn sheet(fights: &[Fight]) -> Image {
    const SPACE: usize = 4;
    let [width, height] = [fights[0].image.width, fights[0].image.height].map(|n| n as usize);
    let [whole, lines] = [width * 4 + SPACE * 3, height * 2 + SPACE];
    let mut rgba = vec![128; whole * lines * 4];
    for (number, fight) in fights.iter().enumerate() {
        let (left, top) = (number % 4 * (width + SPACE), number / 4 * (height + SPACE));
        for (y, row) in fight.image.rgba.chunks_exact(width * 4).enumerate() {
            let at = ((top + y) * whole + left) * 4;
            rgba[at..at + row.len()].copy_from_slice(row);
        }
    }
    rgba.as_chunks_mut::<4>()
        .0
        .iter_mut()
        .for_each(|pixel| pixel[3] = 255);
    Image {
        width: u32::try_from(whole).expect("small"),
        height: u32::try_from(lines).expect("small"),
        rgba,
    }
}

/// The ratio far/near at which the first pixel is wrong, for gaps and methods.
const ONSETS: [(&str, DepthFormat, DepthMapping); 5] = [
    ("d16", DepthFormat::Unorm16, PLAIN),
    ("d24", DepthFormat::Unorm24, PLAIN),
    ("d32f", DepthFormat::Float32, PLAIN),
    ("d24 logarithmic", DepthFormat::Unorm24, LOGARITHMIC),
    ("d32f reversed", DepthFormat::Float32, REVERSED),
];

/// The greatest ratio far/near without a wrong pixel; infinite if none is wrong at 10⁹.
fn ratio(
    device: &Device,
    gap: f32,
    (format, mapping): (DepthFormat, DepthMapping),
) -> Result<f32, Box<dyn Error>> {
    let method = |near| DepthMethod::new([near, FAR], format, mapping).ok();
    Ok(onset(device, gap, method)?.map_or(f32::INFINITY, |near| FAR / near))
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1);
    let path = path.unwrap_or_else(|| "z_fighting.png".to_owned());
    let device = Device::new(&DeviceDescriptor::default())?;
    let fights = fights(&device)?;
    println!("| scene | wrong pixels | of |\n|---|---:|---:|");
    for ((name, ..), fight) in SCENES.iter().zip(&fights) {
        println!("| {name} | {} | {} |", fight.wrong, fight.upper);
    }
    std::fs::write(&path, encode_png(&sheet(&fights), AlphaChannel::Never)?)?;

    println!("\nThe ratio far/near at which the first pixel is wrong:\n");
    let names = ONSETS.map(|(name, ..)| format!(" {name} |")).concat();
    println!("| gap | separation at {FAR_END} | d24 in real numbers |{names}");
    println!("|---:|---:|---:|{}", "---:|".repeat(ONSETS.len()));
    for gap in [2.0, 0.5, 0.1, 0.02, 0.005, 0.001] {
        let separation = FAR_END * gap / EYE_HEIGHT;
        let formula = FAR * separation * 16_777_216.0 / (FAR_END * FAR_END);
        let mut line = format!("| {gap} | {separation:.4} | {formula:.0} |");
        for (_, format, mapping) in ONSETS {
            let ratio = ratio(&device, gap, (format, mapping))?;
            line += &format!(" {ratio:.0} |");
        }
        println!("{line}");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use estampe::Level;
    use std::path::Path;

    /// The counts of the page, and its picture; the same at every SIMD level and on any threads.
    /// Rows: D2.
    #[test]
    fn each_remedy_ends_the_fight() {
        let mut sheets = Vec::new();
        for level in Level::all_available() {
            for threads in [1, 3] {
                let descriptor = DeviceDescriptor {
                    level,
                    threads,
                    ..DeviceDescriptor::default()
                };
                let device = Device::new(&descriptor).expect("the system starts threads");
                let fights = fights(&device).expect("they fit");
                let wrong: Vec<usize> = fights.iter().map(|fight| fight.wrong).collect();
                let [near2, near4, near5, d16, apart, moved, float, reversed] = wrong[..] else {
                    unreachable!("there are eight");
                };
                assert!(
                    near2 < near4 && near4 < near5 && near4 > 1000 && d16 > near2,
                    "{wrong:?}"
                );
                assert!(float * 3 > near4, "floats alone gain little: {wrong:?}");
                assert!(apart * 20 < near4, "{wrong:?}");
                assert_eq!([moved, reversed], [0, 0]);
                sheets.push(sheet(&fights));
            }
        }
        assert!(sheets.iter().all(|sheet| *sheet == sheets[0]));
        let picture =
            Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/images/depth/z_fighting.png");
        let expected = encode_png(&sheets[0], AlphaChannel::Never).expect("small");
        assert!(std::fs::read(picture).is_ok_and(|bytes| bytes == expected));
    }

    /// The onset is in inverse proportion to the gap, a few times before that of real numbers; the
    /// rule of thumb far/near < 1000 with 24 bits is right for gaps of a ten-thousandth of the far
    /// plane's distance.
    /// Rows: D2.
    #[test]
    fn the_onset_is_measured() {
        let device = Device::new(&DeviceDescriptor::default()).expect("the system starts threads");
        let of = |gap, name| {
            let (_, format, mapping) = ONSETS
                .into_iter()
                .find(|row| row.0 == name)
                .expect("a row of the table");
            ratio(&device, gap, (format, mapping)).expect("it fits")
        };
        let [wide, narrow] = [0.5, 0.005].map(|gap| of(gap, "d24"));
        assert!((20.0..500.0).contains(&(wide / narrow)), "{wide} {narrow}");
        let formula = FAR * 16_777_216.0 * 0.5 / (FAR_END * EYE_HEIGHT);
        assert!((0.05..1.1).contains(&(wide / formula)), "{wide} {formula}");
        assert!(of(0.5, "d16") * 50.0 < wide);
        assert!(narrow > 1000.0 && of(0.000_5, "d24") < 10_000.0);
        assert!(of(0.02, "d32f reversed").is_infinite());
    }
}
