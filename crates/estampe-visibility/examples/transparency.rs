//! Transparent polygons that cross each other, blended in three ways.
//!
//! ```text
//! cargo run --release -p estampe-visibility --example transparency [OUT.png]
//! ```
//!
//! Three panes of glass that cross along one line, and a pane behind them, before an opaque bar.
//! From left to right: sorted by the panes' centres, exact by depth peeling, weighted blended.

#![expect(clippy::print_stdout, reason = "examples print their results")]

use estampe::{Device, DeviceDescriptor, Mat4};
use estampe_assets::image::{AlphaChannel, encode_png};
use estampe_scene::Image;
use estampe_visibility::DrawError;
use estampe_visibility::eye::Eye;
use estampe_visibility::picture::{View, differing_pixels};
use estampe_visibility::polygon::{Polygon, PolygonError};
use estampe_visibility::transparency::{Transparency, draw};
use std::error::Error;

const SIDE: u32 = 200;
const EYE: [f32; 3] = [0.5, 1.6, 3.2];
const METHODS: [Transparency; 3] = [
    Transparency::Sorted,
    Transparency::Exact,
    Transparency::Weighted,
];

/// An upright pane through two points of the ground, from the ground to a height.
fn pane<const N: usize>(
    [from, to]: [[f32; 2]; 2],
    height: f32,
    color: [f32; N],
) -> Result<Polygon<N>, PolygonError> {
    let corner = |[x, z]: [f32; 2], y: f32| ([x, y, z], color);
    Polygon::new(&[
        corner(from, -0.6),
        corner(to, -0.6),
        corner(to, height),
        corner(from, height),
    ])
}

fn pictures(device: &Device) -> Result<[Image; 3], Box<dyn Error>> {
    let view = View {
        clip_from_world: Mat4::perspective_reversed(0.55, 1.0, 1.0, 10.0)
            * Mat4::look_at(EYE, [0.0; 3], [0.0, 1.0, 0.0]),
        size: [SIDE; 2],
        background: [0.95, 0.95, 0.93],
    };
    let opaque = [pane(
        [[-0.9, -0.45], [0.9, -0.45]],
        -0.2,
        [0.25, 0.25, 0.3],
    )?];
    // Thirds of a turn about the y axis.
    let transparent = [
        pane([[-0.8, 0.0], [0.8, 0.0]], 0.6, [0.85, 0.15, 0.1, 0.6])?,
        pane([[-0.4, -0.693], [0.4, 0.693]], 0.6, [0.1, 0.6, 0.2, 0.6])?,
        pane([[-0.4, 0.693], [0.4, -0.693]], 0.6, [0.1, 0.25, 0.85, 0.6])?,
        pane([[-0.7, -0.8], [0.7, -0.8]], 0.75, [0.9, 0.75, 0.1, 0.5])?,
    ];
    let eye = Eye::Point(EYE.map(f64::from));
    let picture = |method| draw(device, (&view, eye), &opaque, &transparent, method);
    let drawn: Result<Vec<Image>, DrawError> = METHODS.into_iter().map(picture).collect();
    Ok(<[Image; 3]>::try_from(drawn?).expect("there are three methods"))
}

fn side_by_side(images: &[Image; 3]) -> Image {
    const SPACE: usize = 4;
    let side = SIDE as usize;
    let whole = side * 3 + SPACE * 2;
    let mut rgba = [128, 128, 128, 255].repeat(whole * side);
    for (number, image) in images.iter().enumerate() {
        for (y, row) in image.rgba.chunks_exact(side * 4).enumerate() {
            let at = (y * whole + number * (side + SPACE)) * 4;
            rgba[at..at + row.len()].copy_from_slice(row);
        }
    }
    Image {
        width: u32::try_from(whole).expect("small"),
        height: SIDE,
        rgba,
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1);
    let path = path.unwrap_or_else(|| "transparency.png".to_owned());
    let device = Device::new(&DeviceDescriptor::default())?;
    let images = pictures(&device)?;
    for (method, image) in METHODS.iter().zip(&images) {
        let wrong = differing_pixels(image, &images[1]);
        println!("{method:?}: {wrong} pixels differ from the exact picture");
    }
    std::fs::write(
        &path,
        encode_png(&side_by_side(&images), AlphaChannel::Never)?,
    )?;
    println!("wrote {path}");
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    /// The picture of the page.
    #[test]
    fn sorted_panes_are_wrong_where_they_cross() {
        let device = Device::new(&DeviceDescriptor::default()).expect("the system starts threads");
        let images = pictures(&device).expect("small");
        assert!(differing_pixels(&images[0], &images[1]) > 1000);
        let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
        let expected = encode_png(&side_by_side(&images), AlphaChannel::Never).expect("small");
        let picture = std::fs::read(docs.join("images/depth/transparency.png"));
        assert!(picture.is_ok_and(|bytes| bytes == expected));
    }
}
