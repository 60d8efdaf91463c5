//! Shaders as text on the objects of the device: drawing and compute.

mod compute;
mod contraction;
mod drawing;
mod endless;
mod glsl;
mod glsl_functions;
mod immediates;
mod immediates_compute;
mod peers;
mod spirv;
mod subgroups;

use estampe::{
    Device, DeviceDescriptor, Level, ShaderModule, ShaderModuleDescriptor, ShaderSource,
};

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

fn module(device: &Device, source: ShaderSource<'_>) -> ShaderModule {
    let module = device.create_shader_module(&ShaderModuleDescriptor::new(source));
    module.unwrap_or_else(|errors| panic!("{errors}"))
}
