//! The vertex shader of a triangle that covers the picture.

use crate::failure::Failure;
use estampe::{
    Device, EntryPointDescriptor, Program, ProgramDescriptor, ScalarType, ShaderModule,
    ShaderModuleDescriptor, ShaderModuleError, ShaderSource, ValueType,
};
use estampe_shader::front::Varying;
use estampe_shader::program::LinkError;
use std::fmt::Write;
use std::sync::Arc;

/// An input of the fragment shader.
struct Input {
    location: u32,
    kind: ValueType,
    /// WGSL's name of the interpolation.
    interpolation: &'static str,
}

/// The program of a fragment shader with a vertex shader that writes its inputs.
pub(super) fn program(
    device: &Device,
    fragment: EntryPointDescriptor<'_>,
    inputs: &[Varying],
) -> Result<Arc<dyn Program>, Failure> {
    let mut inputs: Vec<Input> = inputs.iter().map(Input::new).collect();
    // Each time one input learns its interpolation, which reflection does not tell.
    for _ in 0..=inputs.len() {
        let vertex = vertex_shader(device, &inputs)?;
        let program = device.create_program(&ProgramDescriptor {
            vertex: EntryPointDescriptor::new(&vertex),
            fragment: Some(fragment),
        });
        match program {
            Err(ShaderModuleError::Link(LinkError::Interpolation {
                location, fragment, ..
            })) => {
                let input = inputs.iter_mut().find(|input| input.location == location);
                if let Some(input) = input {
                    input.interpolation = match fragment {
                        estampe::Interpolation::Flat => "flat",
                        estampe::Interpolation::Smooth => "perspective",
                        estampe::Interpolation::NoPerspective => "linear",
                    };
                }
            }
            program => return program.map_err(|error| Failure::Input(error.to_string())),
        }
    }
    Err(Failure::Input(
        "the inputs of the fragment shader cannot be interpolated".to_owned(),
    ))
}

impl Input {
    fn new(varying: &Varying) -> Self {
        Self {
            location: varying.location,
            kind: varying.kind,
            interpolation: if varying.is_flat {
                "flat"
            } else {
                "perspective"
            },
        }
    }

    /// The value from `value`, a vector of four floats.
    fn value(&self) -> String {
        let kind = self.kind;
        let components = |rows: u8| &"xyzw"[..usize::from(rows.min(4))];
        match kind {
            ValueType::Scalar(ScalarType::F32) => "value.x".to_owned(),
            ValueType::Vector(ScalarType::F32, rows) => format!("value.{}", components(rows)),
            _ => format!("{kind}()"),
        }
    }
}

/// The corners are (0, 0), (0, 2) and (2, 0) in the units of the picture, whose first row is at the
/// top: counter-clockwise.
fn vertex_shader(device: &Device, inputs: &[Input]) -> Result<ShaderModule, Failure> {
    let mut members = String::new();
    let mut values = String::new();
    for input in inputs {
        let (at, kind, value) = (input.location, input.kind, input.value());
        let how = input.interpolation;
        // Writing to strings cannot fail.
        let _ = write!(
            members,
            ", @location({at}) @interpolate({how}) i{at}: {kind}"
        );
        let _ = write!(values, " out.i{at} = {value};");
    }
    let text = format!(
        "struct Out {{ @builtin(position) position: vec4f{members} }}
@vertex fn triangle(@builtin(vertex_index) corner: u32) -> Out {{
    let uv = vec2f(f32(corner >> 1u), f32(corner & 1u)) * 2.0;
    let value = vec4f(uv, 0.0, 1.0);
    var out: Out;
    out.position = vec4f(uv.x * 2.0 - 1.0, 1.0 - uv.y * 2.0, 0.0, 1.0);{values}
    return out;
}}"
    );
    let module =
        device.create_shader_module(&ShaderModuleDescriptor::new(ShaderSource::Wgsl(&text)));
    module.map_err(|errors| {
        // Types that WGSL does not have between stages.
        let what = errors.errors.first().map_or("", |error| &error.message);
        Failure::Input(format!("the inputs of the fragment shader: {what}"))
    })
}
