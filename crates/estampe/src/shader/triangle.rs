//! Vertex shaders that write what a fragment shader reads, among them that of a triangle that
//! covers the picture.

use crate::failure::Failure;
use estampe::{
    Device, EntryPointDescriptor, Interpolation, Program, ProgramDescriptor, ScalarType,
    ShaderModule, ShaderModuleDescriptor, ShaderModuleError, ShaderSource, ValueType,
};
use estampe_shader::front::Varying;
use estampe_shader::program::LinkError;
use std::fmt::Write;
use std::sync::Arc;

/// An input of a fragment shader.
#[derive(Debug)]
pub(crate) struct Input<'a> {
    pub(crate) varying: &'a Varying,
    /// WGSL's name of the interpolation.
    pub(crate) interpolation: &'static str,
}

/// The program of a fragment shader with the vertex shader in WGSL that `vertex_text` writes for
/// its inputs.
pub(crate) fn linked(
    device: &Device,
    fragment: EntryPointDescriptor<'_>,
    inputs: &[Varying],
    vertex_text: impl Fn(&[Input<'_>]) -> String,
) -> Result<(Arc<dyn Program>, ShaderModule), Failure> {
    let inputs = inputs.iter().map(|varying| Input {
        varying,
        interpolation: if varying.is_flat {
            "flat"
        } else {
            "perspective"
        },
    });
    let mut inputs: Vec<Input<'_>> = inputs.collect();
    // Each time one input learns its interpolation, which reflection does not tell.
    for _ in 0..=inputs.len() {
        let text = vertex_text(&inputs);
        let vertex = ShaderModuleDescriptor::new(ShaderSource::Wgsl(&text));
        let vertex = device.create_shader_module(&vertex).map_err(|errors| {
            // Types that WGSL does not have between stages.
            let what = errors.errors.first().map_or("", |error| &error.message);
            Failure::Input(format!("the inputs of the fragment shader: {what}"))
        })?;
        let program = device.create_program(&ProgramDescriptor {
            vertex: EntryPointDescriptor::new(&vertex),
            fragment: Some(fragment),
        });
        match program {
            Ok(program) => return Ok((program, vertex)),
            Err(ShaderModuleError::Link(LinkError::Interpolation {
                location, fragment, ..
            })) => {
                let mut inputs = inputs.iter_mut();
                if let Some(input) = inputs.find(|input| input.varying.location == location) {
                    input.interpolation = match fragment {
                        Interpolation::Flat => "flat",
                        Interpolation::Smooth => "perspective",
                        Interpolation::NoPerspective => "linear",
                    };
                }
            }
            Err(error) => return Err(Failure::Input(error.to_string())),
        }
    }
    Err(Failure::Input(
        "the inputs of the fragment shader cannot be interpolated".to_owned(),
    ))
}

/// The type that is written for an input of this type: between stages, 16-bit floats are those of
/// 32 bits.
pub(crate) fn written_type(kind: ValueType) -> ValueType {
    match kind {
        ValueType::Scalar(ScalarType::F16) => ValueType::Scalar(ScalarType::F32),
        ValueType::Vector(ScalarType::F16, rows) => ValueType::Vector(ScalarType::F32, rows),
        other => other,
    }
}

/// The value of an output of this type from `value`, an expression of four floats.
pub(crate) fn value_as(kind: ValueType, value: &str) -> String {
    match kind {
        ValueType::Scalar(ScalarType::F32) => format!("{value}.x"),
        ValueType::Vector(ScalarType::F32, rows) => {
            format!("{value}.{}", &"xyzw"[..usize::from(rows.min(4))])
        }
        _ => format!("{kind}()"),
    }
}

/// The corners are (0, 0), (0, 2) and (2, 0) in the units of the picture, whose first row is at the
/// top: counter-clockwise.
pub(crate) fn triangle_text(inputs: &[Input<'_>]) -> String {
    let mut members = String::new();
    let mut values = String::new();
    for Input {
        varying,
        interpolation,
    } in inputs
    {
        let (at, kind) = (varying.location, written_type(varying.kind));
        let value = value_as(kind, "value");
        // Writing to strings cannot fail.
        let _ = write!(
            members,
            ", @location({at}) @interpolate({interpolation}) i{at}: {kind}"
        );
        let _ = write!(values, " out.i{at} = {value};");
    }
    format!(
        "struct Out {{ @builtin(position) position: vec4f{members} }}
@vertex fn triangle(@builtin(vertex_index) corner: u32) -> Out {{
    let uv = vec2f(f32(corner >> 1u), f32(corner & 1u)) * 2.0;
    let value = vec4f(uv, 0.0, 1.0);
    var out: Out;
    out.position = vec4f(uv.x * 2.0 - 1.0, 1.0 - uv.y * 2.0, 0.0, 1.0);{values}
    return out;
}}"
    )
}
