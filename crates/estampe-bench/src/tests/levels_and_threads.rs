//! The bytes of a frame depend neither on the SIMD level nor on the number of threads.

use crate::frame::{FrameSize, PreparedScene};
use crate::scene::{ALL, CLEAR_COLOR, Detail, Scene, SceneEntry};
use estampe::{Device, DeviceDescriptor, Level};

/// Neither side is a multiple of a tile's.
const SIZE: FrameSize = FrameSize {
    width: 160,
    height: 90,
};

/// Rows: U3.
#[test]
fn every_level_and_thread_count_gives_the_same_bytes() {
    let scenes: Vec<Scene> = ALL
        .iter()
        .map(|entry| entry.make(Detail::Reduced, SIZE))
        .collect();
    let mut expected: Vec<(Vec<u8>, Vec<u32>)> = Vec::new();
    for level in Level::all_available() {
        for threads in [1, 2] {
            let device = Device::new(&DeviceDescriptor {
                threads,
                level,
                ..DeviceDescriptor::default()
            })
            .unwrap();
            for (index, scene) in scenes.iter().enumerate() {
                let frame = draw(&device, scene);
                if expected.len() == index {
                    expected.push(frame);
                    continue;
                }
                let place = format!("{} at {} on {threads}", scene.name, level.name());
                assert!(frame.0 == expected[index].0, "colours of {place}");
                assert!(frame.1 == expected[index].1, "depths of {place}");
            }
        }
    }
}

#[test]
fn scenes_draw_pixels() {
    let device = Device::new(&DeviceDescriptor::default()).unwrap();
    let background = CLEAR_COLOR.map(|channel| (channel * 255.0).round().to_bits());
    for entry in ALL {
        let (colors, _) = draw(&device, &entry.make(Detail::Reduced, SIZE));
        let pixels = colors.as_chunks::<4>().0;
        let is_background =
            |pixel: &&[u8; 4]| pixel.map(|channel| f32::from(channel).to_bits()) == background;
        let seen = pixels.iter().filter(|pixel| !is_background(pixel)).count();
        // The covered share of the frame of each scene: full-screen quads, a sphere, a torus, many
        // quads.
        let expected = match entry.name {
            "clear" => 0..=0,
            "fill" | "fill_front" | "fill_draws" | "blend" | "heavy_fs" => {
                pixels.len()..=pixels.len()
            }
            _ => pixels.len() / 4..=pixels.len(),
        };
        assert!(
            expected.contains(&seen),
            "{}: {seen} of {}",
            entry.name,
            pixels.len()
        );
    }
}

#[test]
fn a_scene_in_more_draws_is_the_same_picture() {
    let device = Device::new(&DeviceDescriptor::default()).unwrap();
    for (one, many, count) in [
        ("fill", "fill_draws", 32),
        ("textured", "textured_draws", 16),
        ("instances", "many_draws", 80 * 5),
    ] {
        let [whole, cut] =
            [one, many].map(|name| SceneEntry::named(name).unwrap().make(Detail::Reduced, SIZE));
        assert_eq!(
            (cut.draws.len(), cut.triangles()),
            (count, whole.triangles())
        );
        assert!(draw(&device, &cut) == draw(&device, &whole), "{many}");
    }
}

#[test]
fn a_frame_does_not_depend_on_the_previous_one() {
    let device = Device::new(&DeviceDescriptor::default()).unwrap();
    for entry in ALL {
        let scene = entry.make(Detail::Reduced, SIZE);
        let mut prepared = PreparedScene::new(&device, &scene, SIZE).unwrap();
        prepared.draw();
        let first = prepared.read_color();
        prepared.draw();
        assert!(prepared.read_color() == first, "{}", entry.name);
    }
}

fn draw(device: &Device, scene: &Scene) -> (Vec<u8>, Vec<u32>) {
    let mut prepared = PreparedScene::new(device, scene, SIZE).unwrap();
    prepared.draw();
    let depths = prepared
        .read_depth()
        .iter()
        .map(|depth| depth.to_bits())
        .collect();
    (prepared.read_color(), depths)
}
