//! Runs `estampe compute`, from arguments to written buffers.

use super::arguments::ComputeArgs;
use crate::failure::Failure;
use crate::output;
use crate::render::output_name;
use crate::shader::resources::{Binder, FirstRow};
use crate::shader::source::ShaderFile;
use crate::shader::uniforms::Blocks;
use crate::shader::values::Slot;
use estampe::{
    Buffer, ComputePipelineDescriptor, Device, Dispatch, DispatchError, DispatchErrorKind,
    EntryPointDescriptor, ShaderModuleError, ShaderStage,
};
use std::io::{self, Write};
use std::time::Instant;

/// Runs the command.
pub(crate) fn run(args: &ComputeArgs) -> Result<(), Failure> {
    for (_, destination) in &args.write {
        output::check(destination)?;
    }
    let file = ShaderFile::read(&args.file, None, &args.source)?;
    let file = file.with_stage(ShaderStage::Compute);
    let device = Device::new(&args.machine.descriptor());
    let device =
        device.map_err(|error| Failure::Output(format!("{error}; try fewer --threads")))?;
    let module = file.module(&device)?;
    let constants = file.constants(module.reflections())?;
    let wrong = |error: &dyn std::fmt::Display| Failure::Input(format!("{}: {error}", file.name));
    let program = device.create_compute_program(&EntryPointDescriptor {
        module: &module,
        name: args.entry.as_deref(),
        constants: &constants,
    });
    let program = program.map_err(|error| of_program(&file, args, &error))?;
    let pipeline = device.create_compute_pipeline(&ComputePipelineDescriptor::new(program));
    let pipeline = pipeline.map_err(|error| wrong(&error))?;
    let binder = Binder {
        device: &device,
        module: &module,
        args: &args.resources,
        first_row: FirstRow::Top,
    };
    let bound = binder.bind(pipeline.bind_group_layouts(), Blocks::new(&module))?;
    let needed = pipeline.program().immediate_size();
    let immediates = args.resources.immediates(needed)?;
    let written: Result<Vec<_>, Failure> = args
        .write
        .iter()
        .map(|(slot, destination)| Ok((find(*slot, &bound.buffers)?, destination)))
        .collect();
    let written = written?;

    let start = Instant::now();
    let dispatch = Dispatch {
        bind_groups: &bound.groups,
        immediates: &immediates,
        ..Dispatch::new(&pipeline, args.groups)
    };
    let done = device.dispatch(&dispatch);
    done.map_err(|error| of_dispatch(&file, &error))?;
    let time = start.elapsed().as_secs_f64() * 1e3;

    let mut names = Vec::new();
    for (buffer, destination) in written {
        let mut bytes = vec![0; usize::try_from(buffer.size()).unwrap_or(0)];
        let read = buffer.read(0, &mut bytes);
        read.map_err(|error| Failure::Output(error.to_string()))?;
        output::write(destination, &bytes)?;
        names.push(format!(
            "{}: {} bytes",
            output_name(destination),
            bytes.len()
        ));
    }
    if !args.quiet {
        let [x, y, z] = args.groups;
        names.push(format!("{x}x{y}x{z} work-groups in {time:.1} ms"));
        // If standard error is closed, the line is lost.
        let _ = writeln!(io::stderr(), "{}", names.join(", "));
    }
    Ok(())
}

/// The buffer of a binding.
fn find(slot: Slot, buffers: &[(Slot, Buffer)]) -> Result<&Buffer, Failure> {
    let found = buffers.iter().find(|(at, _)| *at == slot);
    found.map(|(_, buffer)| buffer).ok_or_else(|| {
        let names = buffers
            .iter()
            .map(|((group, binding), _)| format!("{group},{binding}"));
        let names: Vec<String> = names.collect();
        Failure::Usage(format!(
            "--write {},{}: the entry point uses no buffer there; it uses {}",
            slot.0,
            slot.1,
            if names.is_empty() {
                "none".to_owned()
            } else {
                names.join(" and ")
            }
        ))
    })
}

fn of_program(file: &ShaderFile, args: &ComputeArgs, error: &ShaderModuleError) -> Failure {
    let message = format!("{}: {error}", file.name);
    match error {
        ShaderModuleError::NoEntryPoint { .. } => Failure::Usage(message),
        ShaderModuleError::WhichEntryPoint { there_are, .. } if !there_are.is_empty() => {
            Failure::Usage(format!("{message} by --entry"))
        }
        ShaderModuleError::WhichEntryPoint { .. } if args.entry.is_none() => {
            Failure::Input(format!("{}: there is no compute shader", file.name))
        }
        ShaderModuleError::Source(errors) => Failure::Input(errors.to_string()),
        _ => Failure::Input(message),
    }
}

fn of_dispatch(file: &ShaderFile, error: &DispatchError) -> Failure {
    match error.kind {
        DispatchErrorKind::TooManyWorkgroups { .. } => {
            Failure::Usage(format!("{}; choose fewer --groups", error.kind))
        }
        _ => Failure::Input(format!("{}: {}", file.name, error.kind)),
    }
}
