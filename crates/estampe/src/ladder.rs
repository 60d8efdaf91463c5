//! `estampe ladder`: draws the pictures of the ladder, and a sheet of all of them.

use crate::choice::ChoiceArgs;
use crate::failure::Failure;
use crate::input::{self, Model, Reading};
use crate::output;
use crate::progress::Progress;
use crate::values::{self, Destination, Source, shown};
use clap::Args;
use estampe::{Device, DeviceDescriptor, Level};
use estampe_assets::image::{ImageFormat, decode};
use estampe_assets::model::FullDetail;
use estampe_assets::{Limits, ModelOptions};
use estampe_ladder::{Course, Picture, RUNGS, Rung, Sheet, rung};
use std::path::{Path, PathBuf};

/// Draws the rungs of the ladder: the pipeline, from one pixel to shapes.
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Examples:
  estampe ladder 7 -o ladder
  estampe ladder all -o ladder
  estampe ladder 12 --model head.obj --texture head_diffuse.tga -o ladder

The pictures are DIR/ladder_01_pixel.png to DIR/ladder_23_shapes.png; all also writes DIR/sheet.png with all of \
them. Each is the picture of an example of the crate estampe-ladder.

Exit codes: 0 success, 1 the model is missing or invalid, 2 wrong usage, 3 a picture cannot be written.")]
pub(crate) struct LadderArgs {
    /// The number of a rung, 1 to 23, or all
    #[arg(value_name = "RUNG", value_parser = rungs)]
    pub(crate) rungs: Rungs,

    /// The folder of the pictures; it is created if it does not exist
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,

    /// The model, in place of the built-in one: a file or builtin:NAME
    #[arg(long, value_name = "MODEL")]
    pub(crate) model: Option<Source>,

    /// The texture of the model (PNG, JPEG, WebP, TGA, BMP, DDS, KTX2), in place of its own or the
    /// built-in one
    #[arg(long, value_name = "FILE")]
    pub(crate) texture: Option<PathBuf>,

    /// Number of threads, 1 to 1024; the pictures do not depend on it [default: one per processor]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    #[arg(help_heading = "Machine")]
    pub(crate) threads: Option<u16>,

    /// SIMD level: auto, scalar, sse2, avx2 or avx512; the pictures do not depend on it
    #[arg(long, value_name = "LEVEL", default_value = "auto", value_parser = values::simd)]
    #[arg(help_heading = "Machine")]
    pub(crate) simd: Level,

    /// Write no warnings and no progress
    #[arg(short, long, help_heading = "Report")]
    pub(crate) quiet: bool,
}

/// The rungs to draw.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Rungs {
    All,
    One(u32),
}

fn rungs(text: &str) -> Result<Rungs, String> {
    if text == "all" {
        return Ok(Rungs::All);
    }
    let number = text.parse().ok().filter(|number| (1..=23).contains(number));
    number
        .map(Rungs::One)
        .ok_or_else(|| "write the number of a rung, 1 to 23, or all".to_owned())
}

/// Runs the command.
pub(crate) fn run(args: &LadderArgs) -> Result<(), Failure> {
    let rungs = match args.rungs {
        Rungs::All => RUNGS,
        Rungs::One(number) => std::slice::from_ref(rung(number)?),
    };
    create_folder(&args.output)?;
    let stages = u64::try_from(rungs.len()).expect("a few rungs") + 1;
    let progress = Progress::new(stages, args.quiet);
    progress.stage("reading the model");
    let course = course(args)?;
    let mut sheet = Sheet::default();
    for Rung {
        number, name, draw, ..
    } in rungs
    {
        progress.stage(name);
        let picture = draw(&course)?;
        write(&args.output, name, &picture)?;
        sheet.add(*number, &picture);
    }
    if matches!(args.rungs, Rungs::All) {
        write(&args.output, "sheet", &sheet.picture())?;
    }
    Ok(())
}

fn create_folder(folder: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(folder).map_err(|error| {
        let name = shown(folder);
        Failure::Output(format!(
            "{name}: {error}; name a folder, and check its permissions"
        ))
    })
}

fn course(args: &LadderArgs) -> Result<Course, Failure> {
    let device = Device::new(&DeviceDescriptor {
        threads: args.threads.map_or(0, usize::from),
        level: args.simd,
        ..DeviceDescriptor::default()
    });
    let device =
        device.map_err(|error| Failure::Output(format!("{error}; try fewer --threads")))?;
    let mut model = match &args.model {
        None => estampe_ladder::Model::builtin(),
        Some(source) => read_model(source, args.quiet)?,
    };
    if let Some(path) = &args.texture {
        let limits = Limits::default();
        let bytes = input::read_file(path, &limits)?;
        model.texture = decode(&bytes, &limits).map_err(|error| error.in_file(&shown(path)))?;
    }
    Ok(Course::with(device, model))
}

fn read_model(source: &Source, is_quiet: bool) -> Result<estampe_ladder::Model, Failure> {
    if matches!(source, Source::StandardInput) {
        let advice = "name a file or builtin:NAME";
        return Err(Failure::Usage(format!(
            "the ladder reads no model from standard input; {advice}"
        )));
    }
    let folder = ChoiceArgs::default().folder_of(source)?;
    let model = Model::read(
        (source, &folder),
        None,
        Reading {
            options: &ModelOptions::default(),
            limits: &Limits::default(),
            detail: &FullDetail,
        },
        |_| {},
    )?;
    if !is_quiet {
        model.print_warnings();
    }
    estampe_ladder::Model::of_scene(&model.scene).ok_or_else(|| {
        let name = &model.name;
        Failure::Input(format!(
            "{name}: the model has no triangles to draw; take another model"
        ))
    })
}

fn write(folder: &Path, name: &str, picture: &Picture) -> Result<(), Failure> {
    let path = folder.join(format!("{name}.png"));
    output::write(&Destination::File(path), &picture.encode(ImageFormat::Png)?)
}
