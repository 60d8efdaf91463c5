//! Pictures of reduced textures are those of whole ones, byte for byte.

use super::PictureDetail;
use crate::render::PictureArgs;
use crate::turntable::{Orbit, turned};
use clap::Parser;
use estampe::{Device, DeviceDescriptor, Level};
use estampe_assets::image::{AlphaChannel, ImageFormat, encode, encode_png};
use estampe_assets::model::{FullDetail, ResourceError, Resources, TextureDetail, parse_model_for};
use estampe_assets::{Limits, ModelFormat, ModelInput, ModelOptions};
use estampe_renderer::{RenderOptions, ViewDirection, render};
use estampe_scene::{AlphaMode, Image, Scene};
use std::fmt::Write;

#[derive(Debug, Parser)]
struct Command {
    #[command(flatten)]
    picture: PictureArgs,
}

fn arguments(options: &str) -> PictureArgs {
    let words = std::iter::once("render").chain(options.split_whitespace());
    Command::try_parse_from(words)
        .expect("valid options")
        .picture
}

/// A library of one material, and its texture.
struct Files {
    library: String,
    texture: Vec<u8>,
}

impl Resources for Files {
    fn resolve(&self, name: &str) -> Result<String, ResourceError> {
        Ok(name.to_owned())
    }

    fn read(&self, resolved: &str, _max_bytes: u64) -> Result<Vec<u8>, ResourceError> {
        Ok(match resolved {
            "m.mtl" => self.library.clone().into_bytes(),
            _ => self.texture.clone(),
        })
    }
}

/// A band around the vertical axis, with texture coordinates.
fn band() -> String {
    let mut obj = "mtllib m.mtl\nusemtl m\n".to_owned();
    for i in 0..=24_u8 {
        let turn = f32::from(i) / 24.0;
        let (sin, cos) = libm::sincosf(turn * std::f32::consts::TAU);
        for (y, v) in [(-0.7, 0.0), (0.7, 1.0)] {
            let _ = writeln!(obj, "v {sin} {y} {cos}\nvt {turn} {v}");
        }
    }
    for i in 0..24 {
        let [a, b, c, d] = [1, 3, 4, 2].map(|k| 2 * i + k);
        let _ = writeln!(obj, "f {a}/{a} {b}/{b} {c}/{c} {d}/{d}");
    }
    obj
}

fn noise(side: u32, alphas: &[u8]) -> Image {
    let mut random = fastrand::Rng::with_seed(7);
    let texels = u64::from(side) * u64::from(side);
    let rgba = (0..texels).flat_map(|_| {
        let [r, g, b] = [(); 3].map(|()| random.u8(..));
        [r, g, b, alphas[random.usize(..alphas.len())]]
    });
    Image {
        width: side,
        height: side,
        rgba: rgba.collect(),
    }
}

fn scene(files: &Files, detail: &dyn TextureDetail) -> Scene {
    let obj = band();
    let input = ModelInput {
        bytes: obj.as_bytes(),
        format: ModelFormat::Obj,
        name: "band.obj",
        resources: files,
    };
    let loaded = parse_model_for(&input, &ModelOptions::default(), &Limits::default(), detail);
    let loaded = loaded.expect("a valid model");
    assert_eq!(loaded.warning_count, 0, "{:?}", loaded.warnings);
    loaded.scene
}

#[test]
fn pictures_do_not_change() {
    let cut_out = "newmtl m\nKd 1 1 1\nmap_Kd t.png\nd 0.99999999\nmap_d t.png\n";
    let plain = "newmtl m\nKd 1 1 1\nmap_Kd t.png\n";
    let opaque = noise(1024, &[255]);
    let with_alphas = |alphas| encode_png(&noise(1024, alphas), AlphaChannel::Always);
    // Cut-outs keep the share of the whole image, so they stay whole.
    for (library, texture, mode, widest) in [
        (
            plain,
            encode(&opaque, ImageFormat::Png),
            AlphaMode::Opaque,
            512,
        ),
        (
            plain,
            encode(&opaque, ImageFormat::Tga),
            AlphaMode::Opaque,
            512,
        ),
        (
            plain,
            encode(&opaque, ImageFormat::Jpeg),
            AlphaMode::Opaque,
            512,
        ),
        (plain, with_alphas(&[0, 9, 255]), AlphaMode::Opaque, 512),
        (cut_out, with_alphas(&[0, 9, 255]), AlphaMode::Blend, 512),
        (cut_out, with_alphas(&[0, 255]), AlphaMode::Mask, 1024),
    ] {
        let files = Files {
            library: library.to_owned(),
            texture: texture.expect("a valid image"),
        };
        let args = arguments("--size 80x60 --samples 1");
        let whole = scene(&files, &FullDetail);
        let reduced = scene(&files, &PictureDetail::of(&args));
        assert_eq!(whole.images[0].width, 1024);
        let width = reduced.images[0].width;
        assert!(
            width <= widest && (width == 1024) == (widest == 1024),
            "{width}"
        );
        assert_eq!(reduced.materials, whole.materials);
        assert_eq!(whole.materials[0].alpha_mode, mode);

        let options = args
            .options(ViewDirection::default(), None)
            .expect("valid options");
        for level in Level::all_available() {
            for threads in [1, 2, 7] {
                let device = Device::new(&DeviceDescriptor {
                    level,
                    threads,
                    ..DeviceDescriptor::default()
                });
                let device = device.expect("a device");
                let draw = |scene| render(scene, &options, &device).expect("a picture").image;
                assert!(
                    draw(&whole).rgba == draw(&reduced).rgba,
                    "{level:?}, {threads} threads, {mode:?}"
                );
            }
        }
    }
}

#[test]
fn detail_is_that_of_the_finest_picture() {
    let files = Files {
        library: "newmtl m\nKd 1 1 1\nmap_Kd t.png\n".to_owned(),
        texture: encode(&noise(1024, &[255]), ImageFormat::Png).expect("a valid image"),
    };
    let side = |options: &[&str]| {
        let pictures = options.iter().map(|options| arguments(options));
        scene(
            &files,
            &PictureDetail::of_all(pictures.map(|picture| (picture, None)).collect()),
        )
        .images[0]
            .width
    };
    let (small, medium) = ("--size 40x30", "--size 80x60");
    assert!(side(&[medium]) <= 512);
    // Half of the pixels need half of the texels.
    assert_eq!(side(&[small]) * 2, side(&[medium]));
    assert_eq!(side(&[small, medium]), side(&[medium]));
    assert_eq!(side(&[small, "--size 640x480"]), 1024);
    // From a distance, from nearby, and to a shader.
    assert!(side(&["--size 80x60 --eye 0,0,40"]) <= 64);
    assert_eq!(side(&["--size 80x60 --eye 0,0,1.2"]), 1024);
    assert_eq!(side(&[small, "--size 40x30 --shader any.wgsl"]), 1024);
}

#[test]
fn turns_do_not_change() {
    let files = Files {
        library: "newmtl m\nKd 1 1 1\nmap_Kd t.png\n".to_owned(),
        texture: encode(&noise(1024, &[255]), ImageFormat::Png).expect("a valid image"),
    };
    let args = arguments("--size 60x45 --samples 1");
    let turn = |scene: &Scene, options: RenderOptions| {
        let mut orbit = Orbit::new(scene, &options, ViewDirection::default());
        orbit.include(scene, options.up);
        turned(&orbit, 5, &options)
    };
    let whole = scene(&files, &FullDetail);
    let reduced = scene(&files, &PictureDetail::of_cameras(&args, turn));
    assert!(reduced.images[0].width <= 512);
    let options = args.options(ViewDirection::default(), None);
    let device = Device::new(&DeviceDescriptor::default()).expect("a device");
    for options in turn(&whole, options.expect("valid options")) {
        let draw = |scene| render(scene, &options, &device).expect("a picture").image;
        assert!(
            draw(&whole).rgba == draw(&reduced).rgba,
            "{:?}",
            options.camera
        );
    }
    // More pictures than are looked at.
    let many = |_: &Scene, options| vec![options; PictureDetail::MOST_PICTURES + 1];
    let whole = scene(&files, &PictureDetail::of_cameras(&args, many));
    assert_eq!(whole.images[0].width, 1024);
}
