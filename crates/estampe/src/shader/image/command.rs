//! Runs `estampe shader image`, from arguments to a written picture.

use super::arguments::{ImageArgs, Origin};
use crate::failure::Failure;
use crate::output;
use crate::render::{image_format, output_name};
use crate::shader::resources::{Binder, Bound, FirstRow, flipped};
use crate::shader::source::ShaderFile;
use crate::shader::triangle::{linked, triangle_text};
use crate::shader::uniforms::{Blocks, of_picture};
use estampe::{
    ColorAttachment, Device, Draw, EntryPoint, EntryPointDescriptor, RenderPass,
    RenderPipelineDescriptor, ShaderModule, ShaderStage, TextureDescriptor, TextureFormat,
};
use estampe_assets::image::encode;
use estampe_scene::Image;
use std::io::{self, Write};
use std::time::Instant;

/// Runs the command.
pub(crate) fn run(args: &ImageArgs) -> Result<(), Failure> {
    let start = Instant::now();
    let format = image_format(args.output_format, &args.output)?;
    output::check(&args.output)?;
    let file = ShaderFile::read(&args.file, None, &args.source)?.into_fragment();
    let mut descriptor = args.machine.descriptor();
    descriptor.limits.max_shader_jumps = args.max_jumps;
    let device = Device::new(&descriptor);
    let device =
        device.map_err(|error| Failure::Output(format!("{error}; try fewer --threads")))?;
    let module = file.module(&device)?;
    let rgba = draw(args, &device, &file, &module)?;
    let (width, height) = args.size;
    let image = Image {
        width,
        height,
        rgba,
    };
    let bytes = encode(&image, format).map_err(|error| Failure::Output(error.to_string()))?;
    output::write(&args.output, &bytes)?;
    if !args.quiet {
        let (name, total) = (output_name(&args.output), start.elapsed().as_millis());
        // If standard error is closed, the line is lost.
        let _ = writeln!(io::stderr(), "{name}: {width}x{height}, {total} ms");
    }
    Ok(())
}

/// The rows of the picture from the top.
fn draw(
    args: &ImageArgs,
    device: &Device,
    file: &ShaderFile,
    module: &ShaderModule,
) -> Result<Vec<u8>, Failure> {
    let wrong = |error: &dyn std::fmt::Display| Failure::Input(format!("{}: {error}", file.name));
    let constants = file.constants(module.reflections())?;
    let (number, entry) = entry_point(args, file, module)?;
    let inputs = module.reflections().flat_map(|one| &one.inputs).nth(number);
    let fragment = EntryPointDescriptor {
        module,
        name: Some(&entry.name),
        constants: &constants,
    };
    let inputs = inputs.map_or(&[][..], Vec::as_slice);
    let program = linked(device, fragment, inputs, triangle_text);
    let (program, _) = program.map_err(|failure| wrong(&failure))?;
    let layouts = program.bind_group_layouts().to_vec();
    let format = TextureFormat::Rgba8Unorm;
    let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
        depth_stencil: None,
        targets: vec![Some(format.into())],
        ..RenderPipelineDescriptor::with_program(program)
    });
    let pipeline = pipeline.map_err(|error| wrong(&error))?;

    let origin = args.origin.unwrap_or(if file.is_glsl() {
        Origin::Bottom
    } else {
        Origin::Top
    });
    let (width, height) = args.size;
    let mut blocks = Blocks::new(module);
    blocks.set_common(|name| of_picture(name, args.time, [width, height]));
    let binder = Binder {
        device,
        module,
        args: &args.resources,
        first_row: match origin {
            Origin::Top => FirstRow::Top,
            Origin::Bottom => FirstRow::Bottom,
        },
    };
    let Bound { groups, .. } = binder.bind(&layouts, blocks)?;
    let immediates = args
        .resources
        .immediates(pipeline.descriptor().immediate_size())?;

    let too_large =
        |error: &dyn std::fmt::Display| Failure::Output(format!("{error}; try a smaller --size"));
    let image = device.create_texture(&TextureDescriptor::new_2d(width, height, format));
    let image = image.map_err(|error| too_large(&error))?;
    device
        .render(&RenderPass {
            color_attachments: &[Some(ColorAttachment::clear(&image.view(), [0.0; 4]))],
            draws: &[Draw {
                bind_groups: &groups,
                immediates: &immediates,
                ..Draw::new(&pipeline, 0..3)
            }],
            ..RenderPass::default()
        })
        .map_err(|error| wrong(&error))?;
    let rgba = device.read_texture(&image);
    let rgba = rgba.map_err(|error| too_large(&error))?;
    Ok(match origin {
        Origin::Top => rgba,
        Origin::Bottom => flipped(&rgba, width),
    })
}

/// The fragment shader, with its number among all entry points.
fn entry_point<'a>(
    args: &ImageArgs,
    file: &ShaderFile,
    module: &'a ShaderModule,
) -> Result<(usize, &'a EntryPoint), Failure> {
    let of_stage = |(_, entry): &(usize, &EntryPoint)| entry.stage == ShaderStage::Fragment;
    let entries: Vec<_> = module.entry_points().enumerate().filter(of_stage).collect();
    let names = entries.iter().map(|(_, entry)| format!("`{}`", entry.name));
    let names = names.collect::<Vec<_>>().join(", ");
    let file = &file.name;
    let named = |name: &String| entries.iter().find(|(_, entry)| entry.name == *name);
    match (&args.entry, &entries[..]) {
        (_, []) => Err(Failure::Input(format!(
            "{file}: there is no fragment shader"
        ))),
        (None, [one]) => Ok(*one),
        (None, _) => Err(Failure::Usage(format!(
            "{file}: which fragment shader is meant? There are {names}: name one by --entry"
        ))),
        (Some(name), _) => named(name).copied().ok_or_else(|| {
            Failure::Usage(format!(
                "--entry {name}: no fragment shader of {file} has this name; there are {names}"
            ))
        }),
    }
}
