//! The pictures of the rungs and of the course's mistakes: all pixels by a fingerprint, and a small
//! copy, byte for byte, in `docs/images/ladder`. Where the pipeline draws, the picture is the same
//! at every SIMD level and on one thread and three.
//!
//! `UPDATE_PICTURES=1 cargo test -p estampe-ladder --test pictures` writes the copies anew: look at
//! each that changed, and copy its fingerprint from the message.

use estampe::{Device, DeviceDescriptor, Level, TextureDescriptor, TextureFormat};
use estampe_ladder::mistakes::{MISTAKES, Mistake};
use estampe_ladder::{Course, LadderError, Model, Picture, RUNGS, Rung, rung};
use std::path::Path;

/// The most bytes of a copy in the documents.
const MOST_BYTES: usize = 60_000;

type Draw = fn(&Course) -> Result<Picture, LadderError>;

/// The picture, drawn by the devices of every SIMD level on one thread and on three.
fn on_all_devices(name: &str, draw: Draw) -> Picture {
    let mut drawn: Option<Picture> = None;
    for level in Level::all_available() {
        for threads in [1, 3] {
            let device = Device::new(&DeviceDescriptor {
                threads,
                level,
                ..DeviceDescriptor::default()
            });
            let device = device.expect("the system starts three threads");
            let course = Course::with(device, Model::builtin());
            let picture = draw(&course).expect("the rung draws");
            match &drawn {
                None => drawn = Some(picture),
                Some(first) => assert!(
                    picture == *first,
                    "{name} differs at {level:?} on {threads} threads"
                ),
            }
        }
    }
    drawn.expect("there is a level")
}

/// The picture, drawn once: no device takes part.
fn without_device(_: &str, draw: Draw) -> Picture {
    draw(&Course::new().expect("the system starts threads")).expect("the rung draws")
}

/// The file of the picture, reduced by the least factor that makes it small.
fn small_copy(picture: &Picture) -> Vec<u8> {
    let device = Device::new(&DeviceDescriptor::default()).expect("the system starts threads");
    let file = |times| {
        let copy = picture.reduced(times);
        let image = copy.image();
        let format = TextureFormat::Rgba8Unorm;
        let descriptor = TextureDescriptor::new_2d(image.width, image.height, format);
        let texture = device.create_texture_with_data(&descriptor, &[&image.rgba]);
        let texture = texture.expect("a texture of some hundred pixels");
        device.encode_png(&texture).expect("it can be encoded")
    };
    let mut files = (1..).map(file);
    let small = files.find(|file| file.len() <= MOST_BYTES);
    small.expect("a picture of one pixel is small")
}

fn check(name: &str, picture: &Picture, fingerprint: u64) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/images/ladder");
    let path = folder.join(format!("{name}.png"));
    let copy = small_copy(picture);
    if std::env::var_os("UPDATE_PICTURES").is_some() {
        std::fs::write(&path, &copy).expect("the picture can be written");
    }
    let found = picture.fingerprint();
    assert!(
        found == fingerprint,
        "{name} has other pixels: its fingerprint is {found:#018x}. If the change is meant, write \
         this number into the test, and the picture by UPDATE_PICTURES=1"
    );
    let expected = std::fs::read(&path).expect("the documents have the picture");
    assert!(copy == expected, "{} is another picture", path.display());
}

fn check_rung(number: u32, picture_by: fn(&str, Draw) -> Picture, fingerprint: u64) {
    let rung = rung(number).expect("the rung exists");
    check(rung.name, &picture_by(rung.name, rung.draw), fingerprint);
}

fn check_mistake(name: &str, fingerprint: u64) {
    let mistake = MISTAKES.iter().find(|mistake| mistake.name == name);
    let draw = mistake.expect("the mistake exists").draw;
    let picture = on_all_devices(name, draw);
    check(&format!("mistakes/{name}"), &picture, fingerprint);
}

/// Rows: L1.
#[test]
fn rung_01_pixel() {
    check_rung(1, without_device, 0x42bb_ac09_f686_a3fa);
}

/// Rows: L1.
#[test]
fn rung_02_lines() {
    check_rung(2, without_device, 0x5434_c854_d098_6016);
}

/// Rows: L1.
#[test]
fn rung_03_wireframe() {
    check_rung(3, without_device, 0x7e9f_be7d_d17d_336d);
}

/// Rows: L1.
#[test]
fn rung_04_triangles() {
    check_rung(4, without_device, 0x9df1_e926_5bf7_9cae);
}

/// Rows: L1.
#[test]
fn rung_05_random_colors() {
    check_rung(5, without_device, 0xaae3_2e21_0330_88f5);
}

/// Rows: L1.
#[test]
fn rung_06_flat_shading() {
    check_rung(6, without_device, 0xfc93_b434_89aa_370d);
}

/// Rows: L1.
#[test]
fn rung_07_z_buffer() {
    check_rung(7, without_device, 0x0f2e_b01d_e887_d291);
}

/// Rows: L1.
#[test]
fn rung_08_diffuse_texture() {
    check_rung(8, on_all_devices, 0x3f4a_d920_ea6f_05f3);
}

/// Rows: L1.
#[test]
fn rung_09_gouraud() {
    check_rung(9, on_all_devices, 0x5ba6_a903_d87e_2da5);
}

/// Rows: L1.
#[test]
fn rung_10_viewport() {
    check_rung(10, on_all_devices, 0x759b_aeea_7cfe_21a8);
}

/// Rows: L1.
#[test]
fn rung_11_projection() {
    check_rung(11, on_all_devices, 0x09b8_d11b_aa09_93c9);
}

/// Rows: L1.
#[test]
fn rung_12_look_at() {
    check_rung(12, on_all_devices, 0xbb81_0c9f_f74b_cac4);
}

/// Rows: L1.
#[test]
fn rung_13_four_shaders() {
    check_rung(13, on_all_devices, 0x3782_aba0_90a7_20f2);
}

/// Rows: L1.
#[test]
fn rung_14_quantised() {
    check_rung(14, on_all_devices, 0xfb18_2eea_2c4d_a639);
}

/// Rows: L1.
#[test]
fn rung_15_phong() {
    check_rung(15, on_all_devices, 0x0328_1beb_1cdc_915a);
}

/// Rows: L1.
#[test]
fn rung_16_near_clipping() {
    check_rung(16, without_device, 0x8965_d9ef_cd99_34e3);
}

/// Rows: L1.
#[test]
fn rung_17_top_left_rule() {
    check_rung(17, without_device, 0xf5eb_8ae7_bec9_1c78);
}

/// Rows: L1.
#[test]
fn rung_18_z_fighting() {
    check_rung(18, on_all_devices, 0xd5d8_120f_9c5d_31ec);
}

/// Rows: L1.
#[test]
fn rung_19_visibility() {
    check_rung(19, without_device, 0xfe36_b768_3ac2_13c0);
}

/// Rows: L1.
#[test]
fn rung_20_transparency() {
    check_rung(20, on_all_devices, 0x5ad9_01c6_43dc_6ea8);
}

/// Rows: L1.
#[test]
fn rung_21_stencil_logic() {
    check_rung(21, on_all_devices, 0x1f6c_2e5b_744f_0072);
}

/// Rows: G1, L1.
#[test]
fn rung_22_glsl() {
    check_rung(22, on_all_devices, 0x3048_314c_0d49_b2cd);
}

/// Rows: L1.
#[test]
fn rung_23_shapes() {
    check_rung(23, on_all_devices, 0x086f_2600_f925_503d);
}

#[test]
fn mistake_bresenham_steps_first() {
    check_mistake("bresenham_steps_first", 0x0e0f_0de8_7aab_c8fa);
}

#[test]
fn mistake_ties() {
    check_mistake("ties", 0xbb41_604e_ebfb_2c70);
}

#[test]
fn mistake_look_at() {
    check_mistake("look_at", 0x9f1b_6cdc_9283_3cd9);
}

#[test]
fn mistake_horizontal_angle() {
    check_mistake("horizontal_angle", 0x62c2_3b0e_545b_29b9);
}

#[test]
fn mistake_window_z() {
    check_mistake("window_z", 0xb853_d1aa_b2f1_0f94);
}

#[test]
fn mistake_normals() {
    check_mistake("normals", 0x5373_37d0_6258_add2);
}

#[test]
fn mistake_clip_loop() {
    check_mistake("clip_loop", 0x9eaa_e9b2_5e8d_a6c9);
}

#[test]
fn mistake_toon() {
    check_mistake("toon", 0x58d8_9d90_a0a1_bc01);
}

#[test]
fn mistake_face_normal() {
    check_mistake("face_normal", 0x295e_2479_c575_99a4);
}

#[test]
fn mistake_texel() {
    check_mistake("texel", 0x19b2_b1c4_c212_7aaa);
}

#[test]
fn mistake_depth_precision() {
    check_mistake("depth_precision", 0xd243_2e87_4533_65ff);
}

#[test]
fn every_rung_has_its_number_name_and_test() {
    let numbers: Vec<u32> = RUNGS.iter().map(|rung| rung.number).collect();
    assert_eq!(numbers, (1..=23).collect::<Vec<_>>());
    let this = include_str!("pictures.rs");
    for rung in RUNGS {
        let (start, end) = rung.name.split_once('_').expect("ladder_NN_name");
        assert_eq!(start, "ladder");
        assert!(end.starts_with(&format!("{:02}_", rung.number)), "{end}");
        assert!(this.contains(&format!("fn rung_{end}()")), "{end}");
    }
    for mistake in MISTAKES {
        let name = mistake.name;
        assert!(this.contains(&format!("fn mistake_{name}()")), "{name}");
    }
}

/// Rows: L1.
#[test]
fn the_pages_show_every_rung_and_every_mistake() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    let page = |name| std::fs::read_to_string(docs.join(name)).expect("the page is there");
    let (ladder, mistakes) = (page("ladder.md"), page("mistakes.md"));
    for Rung { number, name, .. } in RUNGS {
        for part in [
            format!("\n## {number}. "),
            format!("](images/ladder/{name}.png)"),
            format!("`estampe ladder {number} -o ladder`"),
            format!("`cargo run --release --example {name}`"),
            format!("](../crates/estampe-ladder/examples/{name}.rs)"),
        ] {
            assert!(ladder.contains(&part), "docs/ladder.md lacks {part}");
        }
    }
    for Mistake { name, .. } in MISTAKES {
        let part = format!("](images/ladder/mistakes/{name}.png)");
        assert!(mistakes.contains(&part), "docs/mistakes.md lacks {part}");
    }
}

#[test]
fn other_rungs_do_not_exist() {
    for number in [0, 24, u32::MAX] {
        assert!(matches!(rung(number), Err(LadderError::NoSuchRung { .. })));
    }
}
