//! Runs `estampe shape`, from arguments to a written model or picture.

use super::arguments::{ShapeArgs, ShapeFormat};
use super::function::Function;
use super::grid::Grid;
use super::mesh::{Form, Meshed, mesh};
use crate::failure::Failure;
use crate::input::Model;
use crate::limits::Clock;
use crate::output;
use crate::progress::Progress;
use crate::render::{
    Report, STAGES, counts, draw, output_name, rounded_milliseconds, write_report,
};
use crate::values::Destination;
use estampe_assets::image::ImageFormat;
use estampe_assets::model::{ModelChoices, ModelContents};
use estampe_assets::{ModelFormat, Warning, encode_model};
use estampe_renderer::ViewDirection;
use estampe_scene::{Material, Mesh, Scene, Surface, UpAxis};
use estampe_shapes::parametric::Seams;
use glam::Vec3;
use serde_json::{Value, json};
use std::time::{Duration, Instant};

/// The name of the shape in messages and reports.
const NAME: &str = "shape";

/// The linear colour of curves in pictures: a blue that stands out from light and dark backgrounds,
/// where thin tubes of a surface's grey would not.
const CURVE_COLOR: Vec3 = Vec3::new(0.02, 0.15, 0.5);

/// A model or a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Output {
    Model(ModelFormat),
    Picture(ImageFormat),
}

/// Runs the command.
pub(crate) fn run(args: &ShapeArgs) -> Result<(), Failure> {
    let clock = Clock::unlimited();
    let function = Function::parse(args)?;
    let grid = Grid::new(&function, &args.range, args.resolution.as_ref())?;
    let output = output_of(args)?;
    check_options(args, &function, output)?;
    output::check(&args.output)?;

    let is_picture = matches!(output, Output::Picture(_));
    let stages = if is_picture { 1 + STAGES } else { 3 };
    let progress = Progress::new(stages, args.report.quiet);
    progress.stage("meshing");
    let seams = if is_picture || args.uvs {
        Seams::Split
    } else {
        Seams::Joined
    };
    let meshed = mesh(&function, &grid, seams)?;
    let shape = json_of(&function, &grid, &meshed);
    let mut model = model(args, &function, meshed, is_picture, &clock);

    match output {
        Output::Picture(format) => {
            let view = if function.is_in_plane() {
                ViewDirection::FRONT
            } else {
                ViewDirection::default()
            };
            let to = (&args.output, format);
            let drawn = draw(&mut model, &args.picture, view, to, &clock, &progress)?;
            drop(progress);
            let report = Report {
                args: &args.picture,
                output: &args.output,
                model: &model,
                drawn: &drawn,
                shape: Some(shape),
            };
            report.write(&args.report)
        }
        Output::Model(format) => {
            progress.stage("encoding");
            let encode_start = Instant::now();
            let bytes = encode_model(&model.scene, format)?;
            let encode = encode_start.elapsed();
            progress.stage("writing");
            let write_start = Instant::now();
            output::write(&args.output, &bytes)?;
            drop(progress);
            let times = [encode, write_start.elapsed(), clock.elapsed()];
            report_model(args, &model, format, bytes.len(), times, shape)
        }
    }
}

/// The format of the output, by its option or its name.
fn output_of(args: &ShapeArgs) -> Result<Output, Failure> {
    if let Some(format) = args.output_format {
        return Ok(match format {
            ShapeFormat::Obj => Output::Model(ModelFormat::Obj),
            ShapeFormat::Stl => Output::Model(ModelFormat::Stl),
            ShapeFormat::Ply => Output::Model(ModelFormat::Ply),
            ShapeFormat::Png => Output::Picture(ImageFormat::Png),
            ShapeFormat::Jpeg => Output::Picture(ImageFormat::Jpeg),
            ShapeFormat::Tga => Output::Picture(ImageFormat::Tga),
            ShapeFormat::Webp => Output::Picture(ImageFormat::Webp),
        });
    }
    let Destination::File(path) = &args.output else {
        return Err(Failure::Usage(
            "standard output has no name that shows the format; add --output-format obj, stl, ply, \
             png, jpeg, tga or webp"
                .to_owned(),
        ));
    };
    let model = ModelFormat::from_extension(path)
        // glTF is read, not written.
        .filter(|&format| format != ModelFormat::Gltf)
        .map(Output::Model);
    let picture = || ImageFormat::from_path(path).map(Output::Picture);
    model.or_else(picture).ok_or_else(|| {
        Failure::Usage(
            "OUT's name shows no format; name it .obj, .stl, .ply, .png, .jpg, .tga or .webp, or add \
             --output-format"
                .to_owned(),
        )
    })
}

/// Refuses options that have no effect on this kind of function.
fn check_options(args: &ShapeArgs, function: &Function, output: Output) -> Result<(), Failure> {
    let has_uvs = matches!(
        function,
        Function::ExplicitSurface(_) | Function::ParametricSurface(_)
    );
    let message = if function.is_curve()
        && output == Output::Model(ModelFormat::Stl)
        && args.tube.is_none()
    {
        "STL holds triangles only, and a curve has none; add --tube RADIUS, or write OBJ or PLY"
    } else if !function.is_curve() && args.tube.is_some() {
        "--tube is for curves, and this is a surface; omit it"
    } else if args.uvs && !has_uvs {
        "--uvs is for explicit and parametric surfaces; omit it"
    } else {
        return Ok(());
    };
    Err(Failure::Usage(message.to_owned()))
}

/// The model of a meshed function.
fn model(
    args: &ShapeArgs,
    function: &Function,
    meshed: Meshed,
    is_picture: bool,
    clock: &Clock,
) -> Model {
    let is_tube = is_picture || args.tube.is_some();
    let form = if is_tube {
        meshed.form.into_tube(args.tube)
    } else {
        meshed.form
    };
    let mut mesh = match form {
        Form::Curve(curve) => {
            let (positions, lines) = curve.lines();
            Mesh {
                positions,
                lines,
                ..Mesh::default()
            }
        }
        Form::Surface(surface) => Mesh {
            positions: surface.positions,
            normals: surface.normals,
            uvs: surface.uvs,
            triangles: surface.triangles,
            ..Mesh::default()
        },
    };
    function.kind().clone_into(&mut mesh.name);
    if !is_picture && !args.uvs {
        mesh.uvs.clear();
    }
    let mut materials = Vec::new();
    if is_picture && function.is_curve() {
        mesh.surfaces.push(Surface {
            material: Some(0),
            triangles: 0..mesh.triangles.len(),
        });
        materials.push(Material {
            base_color: CURVE_COLOR,
            ..Material::default()
        });
    }
    let warnings = warnings(meshed.interruptions);
    Model {
        files: Vec::new(),
        scene: Scene {
            meshes: vec![mesh],
            materials,
            up: if function.is_in_plane() {
                UpAxis::Y
            } else {
                UpAxis::Z
            },
            ..Scene::default()
        },
        name: NAME.to_owned(),
        format: None,
        choices: ModelChoices::default(),
        contents: ModelContents::default(),
        warning_count: warnings.len() as u64,
        warnings,
        counts_of_taken: None,
        read: Duration::ZERO,
        parse: clock.elapsed(),
    }
}

fn warnings(interruptions: u64) -> Vec<Warning> {
    if interruptions == 0 {
        return Vec::new();
    }
    vec![Warning {
        json_pointer: String::new(),
        file: String::new(),
        location: None,
        message: format!(
            "the function jumps, has a pole or is not defined in {interruptions} places where its \
             sign changes; the shape is open there"
        ),
    }]
}

/// The function for reports.
fn json_of(function: &Function, grid: &Grid, meshed: &Meshed) -> Value {
    let values = function.value_name().zip(grid.values.clone());
    let ranges = grid.ranges.iter().cloned().chain(values);
    let ranges: serde_json::Map<String, Value> = ranges
        .map(|(name, range)| (name.to_owned(), json!([range.start, range.end])))
        .collect();
    json!({
        "kind": function.kind(),
        "expressions": function.texts(),
        "ranges": ranges,
        "resolution": grid.cells,
        "interruptions": meshed.interruptions,
    })
}

/// Reports a model that was written: how long encoding, writing and all took.
fn report_model(
    args: &ShapeArgs,
    model: &Model,
    format: ModelFormat,
    bytes: usize,
    [encode, write, total]: [Duration; 3],
    shape: Value,
) -> Result<(), Failure> {
    let name = output_name(&args.output);
    write_report(&args.report, model, &args.output, &name, total, || {
        let meshes = model.scene.meshes.iter();
        let bounds = meshes.fold(estampe_scene::Bounds::EMPTY, |all, mesh| {
            all.union(&mesh.bounds())
        });
        let bounds = (!bounds.is_empty())
            .then(|| json!({ "min": bounds.min.to_array(), "max": bounds.max.to_array() }));
        json!({
            "model": model.name,
            "shape": shape,
            "output": {
                "path": name,
                "format": format.name().to_lowercase(),
                "bytes": bytes,
            },
            "counts": counts(model),
            "bounds": bounds,
            "timings_ms": {
                "mesh": rounded_milliseconds(model.parse),
                "encode": rounded_milliseconds(encode),
                "write": rounded_milliseconds(write),
                "total": rounded_milliseconds(total),
            },
            "warnings": model.warnings.iter().map(ToString::to_string).collect::<Vec<_>>(),
            "warning_count": model.warning_count,
        })
    })
}
