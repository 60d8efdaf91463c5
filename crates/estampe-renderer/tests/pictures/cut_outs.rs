//! Surfaces that are cut out by the alpha of a texture.

use crate::support::drawn_alike;
use estampe::srgb;
use estampe_renderer::{CameraOptions, Eye, ProjectionKind, RenderOptions, Shading};
use estampe_scene::{AlphaMode, Image, Material, Mesh, PbrMaterial, Scene, Surface, TextureRef};
use glam::{DVec3, Vec2, Vec3};

/// A square from −1 to 1 with a texture, repeated so often, which is not lit.
fn square(image: Image, repeats: f32, alpha_mode: AlphaMode) -> Scene {
    let corners = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]].map(Vec2::from);
    let position = |uv: Vec2| Vec3::new(uv.x * 2.0 - 1.0, 1.0 - uv.y * 2.0, 0.0);
    let mesh = Mesh {
        positions: corners.map(position).to_vec(),
        normals: vec![Vec3::Z; 4],
        uvs: corners.map(|uv| uv * repeats).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        surfaces: vec![Surface {
            material: Some(0),
            triangles: 0..2,
        }],
        ..Mesh::default()
    };
    let pbr = PbrMaterial {
        base_color_texture: Some(TextureRef::new(0)),
        is_unlit: true,
        ..PbrMaterial::default()
    };
    Scene {
        meshes: vec![mesh],
        materials: vec![Material {
            base_color: Vec3::ONE,
            base_color_texture: Some(0),
            alpha_mode,
            pbr: Some(Box::new(pbr)),
            ..Material::default()
        }],
        images: vec![image],
        ..Scene::default()
    }
}

fn options(samples: u32) -> RenderOptions {
    RenderOptions {
        width: 48,
        height: 48,
        samples,
        camera: CameraOptions {
            eye: Eye::At(DVec3::new(0.0, 0.0, 4.0)),
            target_world: Some(DVec3::ZERO),
            projection: ProjectionKind::Orthographic {
                half_height: Some(1.0),
            },
            ..CameraOptions::default()
        },
        background: Some([255; 3]),
        ..RenderOptions::default()
    }
}

fn image(side: u32, texel: impl Fn(u32, u32) -> [u8; 4]) -> Image {
    let texels = (0..side).flat_map(|y| (0..side).map(move |x| (x, y)));
    Image {
        width: side,
        height: side,
        rgba: texels.flat_map(|(x, y)| texel(x, y)).collect(),
    }
}

const GREEN: [u8; 3] = [30, 180, 60];

/// Linear colours of a picture.
fn pixels(rgba: &[u8]) -> Vec<[f32; 3]> {
    let pixels = rgba.chunks(4);
    pixels
        .map(|p| [0, 1, 2].map(|c| srgb::decode(p[c])))
        .collect()
}

/// An oblique edge of a magnified texture: with four samples it has pixels between, and covers the
/// area that it has; with one sample it has none. Physically based and by Phong's model.
///
/// Rows: F4.
#[test]
fn edges_of_cut_outs_are_smooth() {
    let half = image(16, |x, y| {
        // The line x + 2y = 23, blurred over a few texels.
        let distance = 23 - i32::try_from(x + 2 * y).expect("small");
        let alpha = u8::try_from((128 + distance * 32).clamp(0, 255)).expect("clamped");
        let [r, g, b] = GREEN;
        [r, g, b, alpha]
    });
    for shading in [Shading::Pbr, Shading::Unlit] {
        let drawn = |samples| {
            let options = RenderOptions {
                shading,
                ..options(samples)
            };
            let frame = drawn_alike(&square(half.clone(), 1.0, AlphaMode::Mask), &options);
            pixels(&frame.image.rgba)
        };
        let share = |pixel: &[f32; 3]| (1.0 - pixel[2]) / (1.0 - srgb::decode(GREEN[2]));
        let between = |pixels: &[[f32; 3]]| {
            let shares = pixels.iter().map(share);
            shares.filter(|share| (0.1..0.9).contains(share)).count()
        };
        let (smooth, hard) = (drawn(4), drawn(1));
        assert_eq!(between(&hard), 0);
        assert!(between(&smooth) > 30, "{shading:?}: {}", between(&smooth));
        let area = |pixels: &[[f32; 3]]| pixels.iter().map(share).sum::<f32>() / 48.0 / 48.0;
        assert!((area(&smooth) - area(&hard)).abs() < 0.01);
    }
}

/// What is kept is opaque, whatever its alpha.
#[test]
fn what_is_kept_is_opaque() {
    for samples in [1, 4] {
        let options = RenderOptions {
            background: None,
            ..options(samples)
        };
        let [r, g, b] = GREEN;
        let veil = Image::filled(4, 4, [r, g, b, 180]);
        let frame = drawn_alike(&square(veil, 1.0, AlphaMode::Mask), &options);
        for pixel in frame.image.rgba.chunks(4) {
            assert_eq!(pixel, [r, g, b, 255]);
        }
    }
}

/// Green discs on invisible black, far away: each pixel is a mixture of green and the background,
/// with cut-outs and with blending; and cut-outs keep the discs' area, which the plain mean of
/// alpha would lose or fill.
///
/// Rows: F4.
#[test]
fn distant_leaves_have_no_dark_fringes_and_stay() {
    let leaves = image(32, |x, y| {
        let (dx, dy) = (f64::from(x) - 15.5, f64::from(y) - 15.5);
        let [r, g, b] = GREEN;
        if dx * dx + dy * dy < 100.0 {
            [r, g, b, 255]
        } else {
            [0; 4]
        }
    });
    // π·100 ÷ 32².
    let area = 0.307;
    for (mode, repeats) in [
        (AlphaMode::Blend, 3.0),
        (AlphaMode::Blend, 13.0),
        (AlphaMode::Mask, 3.0),
        (AlphaMode::Mask, 5.0),
    ] {
        let frame = drawn_alike(&square(leaves.clone(), repeats, mode), &options(4));
        let green = GREEN.map(srgb::decode);
        let mut sum = 0.0;
        for pixel in pixels(&frame.image.rgba) {
            let shares = [0, 1, 2].map(|c| (1.0 - pixel[c]) / (1.0 - green[c]));
            let spread = shares
                .iter()
                .fold(0.0_f32, |most, s| most.max((s - shares[0]).abs()));
            assert!(spread < 0.03, "{mode:?}, {repeats}: {pixel:?}");
            sum += shares[0];
        }
        let share = sum / 48.0 / 48.0;
        assert!((share - area).abs() < 0.08, "{mode:?}, {repeats}: {share}");
    }
}
