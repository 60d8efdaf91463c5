//! Shaders as text on the objects of the device: drawing and compute.

mod compute;
mod drawing;

use estampe::{Device, DeviceDescriptor, Level};
use estampe_shader::lower::lower;
use estampe_shader::program::StageSource;
use naga::valid::{Capabilities, ValidationFlags, Validator};

/// A device for every SIMD level, with 1 and 3 threads.
fn devices() -> impl Iterator<Item = (String, Device)> {
    let levels = Level::all_available();
    levels.into_iter().flat_map(|level| {
        [1, 3].map(|threads| {
            let descriptor = DeviceDescriptor {
                threads,
                level,
                ..DeviceDescriptor::default()
            };
            let device = Device::new(&descriptor).expect("a few threads");
            (format!("{level:?}, {threads} threads"), device)
        })
    })
}

/// The entry points of a WGSL module, in its order.
fn stages(source: &str) -> Vec<StageSource> {
    let module = naga::front::wgsl::parse_str(source)
        .unwrap_or_else(|error| panic!("{}", error.emit_to_string(source)));
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::default());
    let info = validator.validate(&module).expect("a valid module");
    (0..module.entry_points.len())
        .map(|entry| lower(&module, &info, entry).expect("a shader that is supported"))
        .collect()
}
