//! Three answers to what hides what, and the depth buffer from above.
//!
//! ```text
//! cargo run --release -p estampe-visibility --example visibility [OUT.png]
//! ```
//!
//! Three beams, each over the next in a cycle, and two squares that cross, from the front. From
//! left to right: painter's algorithm, sorted by the polygons' centres; the BSP tree; the depth
//! buffer; the depth buffer from above, the eye below.

#![expect(clippy::print_stdout, reason = "examples print their results")]

use estampe::{Device, DeviceDescriptor, Mat4};
use estampe_assets::image::{AlphaChannel, encode_png};
use estampe_scene::Image;
use estampe_visibility::DrawError;
use estampe_visibility::bsp::{BspOptions, BspTree};
use estampe_visibility::eye::Eye;
use estampe_visibility::painter::{by_centre, by_pairs};
use estampe_visibility::picture::{Hiding, View, differing_pixels, draw, draw_with_depths};
use estampe_visibility::polygon::{Corner, Polygon, PolygonError};
use std::error::Error;

const SIDE: u32 = 200;
const EYE: Eye = Eye::Direction([0.0, 0.0, 1.0]);

fn scene() -> Result<Vec<Polygon<3>>, PolygonError> {
    let mut polygons = Vec::new();
    let mut push = |corners: [[f32; 3]; 4], middle: [f32; 3], color: [f32; 3]| {
        let moved = corners.map(|p| [0, 1, 2].map(|k: usize| p[k] + middle[k]));
        polygons.push(Polygon::new(&moved.map(|p| (p, color)))?);
        Ok(())
    };
    // A third of a turn: cos = −½, sin = √3/2.
    let turn = |[x, y, z]: [f32; 3]| [-0.5 * x - 0.866 * y, 0.866 * x - 0.5 * y, z];
    let ends = [(-0.5, -0.3), (0.5, -0.3), (0.5, -0.14), (-0.5, -0.14)];
    let mut beam = ends.map(|(x, y)| [x, y, x / 2.0]);
    for color in [[0.86, 0.24, 0.2], [0.24, 0.7, 0.32], [0.28, 0.43, 0.9]] {
        push(beam, [-0.42, 0.35, 0.3], color)?;
        beam = beam.map(turn);
    }
    let square = [(-0.45, -0.3), (0.45, -0.3), (0.45, 0.3), (-0.45, 0.3)];
    let slanted = |slope: f32, height: f32| square.map(|(x, y)| [x, y * height, x * slope]);
    push(slanted(0.6, 1.2), [0.45, -0.45, -0.4], [0.94, 0.78, 0.24])?;
    push(slanted(-0.6, 0.7), [0.45, -0.45, -0.4], [0.63, 0.35, 0.78])?;
    Ok(polygons)
}

/// The pictures of the methods, and the number of pixels in which painter and BSP tree differ from
/// the depth buffer.
fn panels(
    device: &Device,
    polygons: &[Polygon<3>],
    tree: &BspTree<3>,
) -> Result<([Image; 4], [usize; 2]), DrawError> {
    let view = View {
        clip_from_world: Mat4::orthographic_reversed(-1.0, 1.0, -1.0, 1.0, -1.0, 1.0),
        size: [SIDE; 2],
        background: [1.0; 3],
    };
    let picture =
        |corners: &[&[Corner<3>]], hiding| draw(device, &view, corners.iter().copied(), hiding);
    let all: Vec<&[Corner<3>]> = polygons.iter().map(Polygon::corners).collect();
    let sorted = by_centre(polygons, EYE);
    let sorted: Vec<_> = sorted.iter().map(|number| all[*number as usize]).collect();
    let mut ordered: Vec<&[Corner<3>]> = Vec::new();
    tree.back_to_front(EYE, |piece| ordered.push(&piece.corners));
    let painter = picture(&sorted, Hiding::ByOrder)?;
    let bsp = picture(&ordered, Hiding::ByOrder)?;
    let depth = draw_with_depths(device, &view, all.iter().copied())?;
    let above = depth.from_above(SIDE, [255; 3], |depth| 1.0 - depth);
    let wrong = [&painter, &bsp].map(|image| differing_pixels(image, &depth.image));
    Ok(([painter, bsp, depth.image, above], wrong))
}

fn side_by_side(images: &[Image; 4]) -> Image {
    const SPACE: usize = 4;
    let side = SIDE as usize;
    let whole = side * 4 + SPACE * 3;
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
    let path = path.unwrap_or_else(|| "visibility.png".to_owned());
    let device = Device::new(&DeviceDescriptor::default())?;
    let polygons = scene()?;
    let tree = BspTree::new(&polygons, BspOptions::default())?;
    let (images, [painter, bsp]) = panels(&device, &polygons, &tree)?;
    let pairs = by_pairs(&polygons, EYE)?;
    println!(
        "pairs that cross: {:?}, polygons in a cycle: {:?}",
        pairs.crossing, pairs.cyclic
    );
    println!(
        "pixels unlike the depth buffer: painter {painter}, BSP tree {bsp} with {} pieces",
        tree.pieces().len()
    );
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

    /// The picture of the page; painter's algorithm fails, the other two agree.
    /// Rows: D3, D4, D5.
    #[test]
    fn the_painter_fails_and_the_others_agree() {
        let device = Device::new(&DeviceDescriptor::default()).expect("the system starts threads");
        let polygons = scene().expect("they are flat");
        let tree = BspTree::new(&polygons, BspOptions::default()).expect("few");
        let (images, [painter, bsp]) = panels(&device, &polygons, &tree).expect("small");
        assert!(painter > 1000 && bsp < 10, "{painter} {bsp}");
        let picture =
            Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/images/depth/visibility.png");
        let expected = encode_png(&side_by_side(&images), AlphaChannel::Never).expect("small");
        assert!(std::fs::read(picture).is_ok_and(|bytes| bytes == expected));
    }
}
