//! Runs `estampe depth`, from arguments to a table and a plot.

use super::arguments::{DepthArgs, PlotFormatName};
use super::plot::plot;
use super::table::{self, Row};
use crate::failure::Failure;
use crate::output;
use crate::render::output_name;
use crate::values::Destination;
use clap::ValueEnum;
use estampe::{Device, DeviceDescriptor};
use estampe_assets::image::{ImageFormat, encode};
use estampe_visibility::precision::{DepthMapping, DepthMethod};
use serde_json::{Value, json};
use std::io::{self, Write};

/// Runs the command.
pub(crate) fn run(args: &DepthArgs) -> Result<(), Failure> {
    let mapping = DepthMapping {
        is_reversed: args.reversed,
        is_logarithmic: args.log,
    };
    let method = DepthMethod::new([args.near, args.far], args.format.into(), mapping);
    let method = method.map_err(|error| Failure::Usage(error.to_string()))?;
    let distances = distances(args, &method)?;
    let target = match &args.output {
        Some(destination) => Some((destination, format_of(args, destination)?)),
        None => None,
    };
    if let Some((destination, _)) = target {
        output::check(destination)?;
    }

    let rows: Vec<Row> = distances.iter().map(|z| Row::new(&method, *z)).collect();
    let mut written = Value::Null;
    if let Some((destination, format)) = target {
        let bytes = draw(&method, args.size, format)?;
        output::write(destination, &bytes)?;
        written = json!({
            "path": output_name(destination),
            "format": format.to_possible_value().map(|value| value.get_name().to_owned()),
            "bytes": bytes.len(),
        });
    }
    let is_on_standard_output = args
        .output
        .as_ref()
        .is_some_and(Destination::is_standard_output);
    if args.json {
        let object = table::json(&method, &rows, &written);
        write(&format!("{object}\n"), is_on_standard_output)
    } else if args.quiet || is_on_standard_output {
        Ok(())
    } else {
        write(&table::text(&method, &rows), false)
    }
}

/// The distances of `--at`, or round ones.
fn distances(args: &DepthArgs, method: &DepthMethod) -> Result<Vec<f32>, Failure> {
    if args.at.is_empty() {
        return Ok(table::distances(method));
    }
    let [near, far] = method.planes();
    if let Some(outside) = args.at.iter().find(|z| !(near..=far).contains(*z)) {
        return Err(Failure::Usage(format!(
            "--at {outside} is not between the planes, {near} and {far}; nothing is drawn there"
        )));
    }
    Ok(args.at.clone())
}

/// The format of the plot, by its option or its name.
fn format_of(args: &DepthArgs, destination: &Destination) -> Result<PlotFormatName, Failure> {
    if let Some(format) = args.output_format {
        return Ok(format);
    }
    let Destination::File(path) = destination else {
        return Err(Failure::Usage(
            "standard output has no name that shows the format; add --output-format svg, png, \
             jpeg, tga or webp"
                .to_owned(),
        ));
    };
    let extension = path.extension().and_then(std::ffi::OsStr::to_str);
    let format = extension.and_then(|extension| PlotFormatName::from_str(extension, true).ok());
    format.ok_or_else(|| {
        Failure::Usage(
            "OUT's name shows no format; name it .svg, .png, .jpg, .tga or .webp, or add \
             --output-format"
                .to_owned(),
        )
    })
}

/// The bytes of the plot's file.
fn draw(
    method: &DepthMethod,
    size: (u32, u32),
    format: PlotFormatName,
) -> Result<Vec<u8>, Failure> {
    let drawing = plot(method, size).drawing();
    let format = match format {
        PlotFormatName::Svg => return Ok(drawing.to_svg().into_bytes()),
        PlotFormatName::Png => ImageFormat::Png,
        PlotFormatName::Jpeg => ImageFormat::Jpeg,
        PlotFormatName::Tga => ImageFormat::Tga,
        PlotFormatName::Webp => ImageFormat::Webp,
    };
    let device = Device::new(&DeviceDescriptor::default());
    let device = device.map_err(|error| Failure::Output(error.to_string()))?;
    let image = drawing.to_image(&device);
    let image = image.map_err(|error| Failure::Output(format!("{error}; try a smaller --size")))?;
    Ok(encode(&image, format)?)
}

/// Writes to standard output, or to standard error.
fn write(text: &str, to_standard_error: bool) -> Result<(), Failure> {
    if !to_standard_error {
        return output::print(text);
    }
    let written = io::stderr().lock().write_all(text.as_bytes());
    written.map_err(|error| {
        Failure::Output(format!(
            "standard error: {error}; check the program that reads it"
        ))
    })
}
