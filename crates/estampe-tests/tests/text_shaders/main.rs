//! Shaders as text on the objects of the device: drawing and compute.

mod alpha_tests;
mod byte_squares;
mod clamped_sampling;
mod compute;
mod contraction;
mod drawing;
mod endless;
mod glsl;
mod glsl_functions;
mod immediates;
mod immediates_compute;
mod integer_targets;
mod peers;
mod picture;
mod pixel_loads;
mod shadow_maps;
mod spirv;
mod stored_colors;
mod subgroups;

use estampe::{
    Device, DeviceDescriptor, EntryPointDescriptor, Level, Program, ProgramDescriptor,
    ShaderModule, ShaderModuleDescriptor, ShaderSource,
};
use std::sync::Arc;

/// A device for every SIMD level, with 1 and 3 threads, and one that interprets shaders.
fn devices() -> impl Iterator<Item = (String, Device)> {
    let compiled = Level::all_available().into_iter().flat_map(|level| {
        [1, 3].map(|threads| DeviceDescriptor {
            threads,
            level,
            ..DeviceDescriptor::default()
        })
    });
    let interpreted = DeviceDescriptor {
        threads: 2,
        level: Level::best(),
        interprets_shaders: true,
        ..DeviceDescriptor::default()
    };
    compiled.chain([interpreted]).map(|descriptor| {
        let (level, threads) = (descriptor.level, descriptor.threads);
        let way = match descriptor.interprets_shaders {
            true => ", interpreted",
            false => "",
        };
        let device = Device::new(&descriptor).expect("a few threads");
        (format!("{level:?}, {threads} threads{way}"), device)
    })
}

fn module(device: &Device, source: ShaderSource<'_>) -> ShaderModule {
    let module = device.create_shader_module(&ShaderModuleDescriptor::new(source));
    module.unwrap_or_else(|errors| panic!("{errors}"))
}

/// The program of a module's vertex shader and of the fragment shader of a name.
fn program(device: &Device, module: &ShaderModule, fragment: &str) -> Arc<dyn Program> {
    let program = device.create_program(&ProgramDescriptor {
        fragment: Some(EntryPointDescriptor {
            name: Some(fragment),
            ..EntryPointDescriptor::new(module)
        }),
        ..module.program()
    });
    program.unwrap_or_else(|error| panic!("{error}"))
}
