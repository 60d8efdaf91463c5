//! Draws a scene in every way that must give the same bytes.

use estampe::{Device, DeviceDescriptor, Level};
use estampe_renderer::{Frame, RenderOptions, render, render_spent};
use estampe_scene::Scene;
use std::sync::LazyLock;

/// A device of each SIMD level, by one and by three threads in turn; the last level by both.
pub(crate) static DEVICES: LazyLock<Vec<Device>> = LazyLock::new(|| {
    let levels = Level::all_available();
    let threads = [1, 3].into_iter().cycle();
    let mut kinds: Vec<_> = levels.iter().copied().zip(threads).collect();
    let of_best = [1, 3].map(|threads| (Level::best(), threads));
    kinds.extend(of_best.into_iter().find(|kind| !kinds.contains(kind)));
    let device = |(level, threads)| {
        let descriptor = DeviceDescriptor {
            level,
            threads,
            ..DeviceDescriptor::default()
        };
        Device::new(&descriptor).expect("a few threads can be started")
    };
    kinds.into_iter().map(device).collect()
});

/// The picture, which has the same bytes on every device, and if the scene is used up.
pub(crate) fn drawn_alike(scene: &Scene, options: &RenderOptions) -> Frame {
    let draw = |device| render(scene, options, device).expect("a small picture");
    let frame = draw(&DEVICES[0]);
    let last = &DEVICES[DEVICES.len() - 1];
    let spent = render_spent(scene.clone(), options, last, &|_| {}).expect("a small picture");
    assert!(
        spent.image == frame.image,
        "the buffers of a scene that is used up give another picture"
    );
    for device in &DEVICES[1..] {
        assert!(
            draw(device).image == frame.image,
            "{:?} by {} threads gives another picture",
            device.level(),
            device.threads()
        );
    }
    frame
}
