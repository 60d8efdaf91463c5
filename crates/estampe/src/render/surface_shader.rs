//! Surfaces that a shader of the user draws: `--shader`.

use crate::failure::Failure;
use crate::shader::resources::{Binder, FirstRow, ResourceArgs, is_texture};
use crate::shader::source::{ShaderFile, SourceArgs};
use crate::shader::triangle::{Input, linked, value_as, written_type};
use crate::shader::uniforms::{Blocks, Common, of_picture};
use crate::shader::values::{self, Via};
use crate::values::shown;
use clap::Args;
use estampe::{
    BindGroup, BindGroupLayout, Device, EntryPointDescriptor, Mat4, ProgramDescriptor,
    ShaderModule, ShaderStage,
};
use estampe_renderer::{RenderError, SurfaceBindings, SurfaceProgram, SurfaceValues};
use estampe_shader::front::Varying;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A shader of the user.
#[derive(Debug, Clone, Args)]
pub(crate) struct SurfaceShaderArgs {
    /// A shader for all surfaces: WGSL, GLSL or SPIR-V (see --help, `estampe shader template`)
    ///
    /// A fragment shader, whose inputs and uniforms have values by their names; or, in WGSL and
    /// SPIR-V, a vertex shader too. docs/shader.md lists the names.
    #[arg(
        long,
        value_name = "FILE",
        conflicts_with = "shading",
        help_heading = "Shader"
    )]
    shader: Option<PathBuf>,

    /// A macro of GLSL, or the value of a constant of the shader; repeatable
    #[arg(short = 'D', value_name = "NAME=VALUE", value_parser = crate::shader::source::define)]
    #[arg(requires = "shader", help_heading = "Shader")]
    defines: Vec<(String, String)>,

    /// A uniform of the shader by name: numbers with commas between; repeatable
    #[arg(long, value_name = "NAME=VALUE", value_parser = values::setting)]
    #[arg(
        requires = "shader",
        allow_hyphen_values = true,
        help_heading = "Shader"
    )]
    set: Vec<(String, String)>,

    /// The time in seconds: in the model's animation, and of uniforms named time [default: 0]
    #[arg(long, value_name = "S", value_parser = values::seconds)]
    #[arg(allow_hyphen_values = true, help_heading = "Contents")]
    pub(crate) time: Option<f32>,

    /// What runs the shader: auto, interpreter, avx2 or avx512; the image does not depend on it
    #[arg(long, value_name = "MACHINE", value_parser = values::via)]
    #[arg(requires = "shader", conflicts_with = "simd", help_heading = "Machine")]
    pub(super) via: Option<Via>,
}

impl SurfaceShaderArgs {
    /// The shader's file.
    pub(crate) fn file(&self) -> Option<&Path> {
        self.shader.as_deref()
    }

    /// The program of the shader, if there is one; it samples this texture.
    pub(super) fn program(
        &self,
        device: &Device,
        texture: Option<&Path>,
    ) -> Result<Option<SurfaceProgram>, Failure> {
        let Some(path) = &self.shader else {
            return Ok(None);
        };
        let source = SourceArgs {
            defines: self.defines.clone(),
            language: None,
        };
        let file = ShaderFile::read(path, None, &source)?.with_stage(ShaderStage::Fragment);
        let module = file.module(device)?;
        let constants = file.constants(module.reflections())?;
        let wrong =
            |error: &dyn std::fmt::Display| Failure::Input(format!("{}: {error}", file.name));
        let has_vertex = module
            .entry_points()
            .any(|entry| entry.stage == ShaderStage::Vertex);
        let descriptor = EntryPointDescriptor {
            module: &module,
            name: None,
            constants: &constants,
        };
        let (program, vertex) = if has_vertex {
            let program = device.create_program(&ProgramDescriptor {
                vertex: descriptor,
                fragment: Some(descriptor),
            });
            (program.map_err(|error| wrong(&error))?, None)
        } else {
            let entries = module
                .entry_points()
                .zip(module.reflections().flat_map(|one| &one.inputs));
            let mut fragments = entries.filter(|(entry, _)| entry.stage == ShaderStage::Fragment);
            let inputs = fragments.next().map_or(&[][..], |(_, inputs)| inputs);
            let group = unused_group(&module);
            let linked = linked(device, descriptor, inputs, |inputs| {
                vertex_text(inputs, group)
            });
            let (program, vertex) = linked.map_err(|failure| wrong(&failure))?;
            (program, Some(vertex))
        };
        let attributes = program.interface().attributes.len();
        if attributes > ATTRIBUTES {
            let last = attributes - 1;
            return Err(wrong(&format!(
                "the vertex shader reads location {last}; there are 0 (position), 1 (normal), \
                 2 (uv) and 3 (colour)"
            )));
        }
        if program.immediate_size() > 0 {
            return Err(wrong(
                &"it reads immediates (push constants), which surfaces do not have: use uniforms",
            ));
        }
        let layouts = program.bind_group_layouts().to_vec();
        let bindings = Bindings {
            resources: self.resources(&layouts, texture),
            layouts,
            vertex,
            module,
            time: self.time.unwrap_or(0.0),
        };
        // Mistakes in the options are found before anything is drawn.
        bindings.bind(device, &NOTHING)?;
        Ok(Some(SurfaceProgram {
            program,
            bindings: Arc::new(bindings),
        }))
    }

    /// An error of the renderer; if it is that the pipeline of the shader is refused, one of the
    /// shader.
    pub(super) fn failure(&self, error: RenderError) -> Failure {
        match (&self.shader, &error) {
            (Some(path), RenderError::Pipeline(_)) => {
                Failure::Input(format!("{}: {error}", shown(path)))
            }
            _ => error.into(),
        }
    }

    /// The uniforms of the options; every texture of the shader is the given one.
    fn resources(&self, layouts: &[BindGroupLayout], texture: Option<&Path>) -> ResourceArgs {
        let mut textures = Vec::new();
        for (group, layout) in layouts.iter().enumerate() {
            let group = u32::try_from(group).unwrap_or(u32::MAX);
            let entries = layout.entries().iter().filter(|entry| is_texture(entry.ty));
            let slots = entries.map(|entry| (group, entry.binding));
            textures.extend(slots.filter_map(|slot| Some((slot, texture?.to_owned()))));
        }
        ResourceArgs::of_surfaces(&self.set, textures)
    }
}

/// The attributes of vertices.
const ATTRIBUTES: usize = 4;

/// Values before those of a picture are known.
const NOTHING: SurfaceValues = SurfaceValues {
    clip_from_model: Mat4::IDENTITY,
    view_from_model: Mat4::IDENTITY,
    clip_from_view: Mat4::IDENTITY,
    view_from_normal: Mat4::IDENTITY,
    light_view: [0.0; 3],
    eye_model: [0.0; 3],
    base_color: [1.0; 4],
    size_px: [1; 2],
};

/// What the shader binds.
#[derive(Debug)]
struct Bindings {
    module: ShaderModule,
    /// The vertex shader, if it is not in the module.
    vertex: Option<ShaderModule>,
    layouts: Vec<BindGroupLayout>,
    resources: ResourceArgs,
    time: f32,
}

impl Bindings {
    fn bind(&self, device: &Device, values: &SurfaceValues) -> Result<Vec<BindGroup>, Failure> {
        let vertex = self.vertex.as_ref().map(Blocks::new).unwrap_or_default();
        let mut blocks = Blocks::new(&self.module).and(vertex);
        blocks.set_common(|name| {
            of_surface(name, values).or_else(|| of_picture(name, self.time, values.size_px))
        });
        let binder = Binder {
            device,
            module: &self.module,
            args: &self.resources,
            first_row: FirstRow::Top,
        };
        Ok(binder.bind(&self.layouts, blocks)?.groups)
    }
}

impl SurfaceBindings for Bindings {
    fn bind_groups(
        &self,
        device: &Device,
        values: &SurfaceValues,
    ) -> Result<Vec<BindGroup>, String> {
        self.bind(device, values)
            .map_err(|failure| failure.to_string())
    }
}

/// The value of a uniform of surfaces, by its name in snake case.
fn of_surface(name: &str, values: &SurfaceValues) -> Option<Common> {
    let name = name.strip_suffix("_matrix").unwrap_or(name);
    let direction = |[x, y, z]: [f32; 3]| Common::Numbers([x, y, z, 0.0]);
    let point = |[x, y, z]: [f32; 3]| Common::Numbers([x, y, z, 1.0]);
    Some(match name {
        "clip_from_model" | "mvp" | "model_view_projection" => {
            Common::Matrix(values.clip_from_model)
        }
        "view_from_model" | "model_view" | "view" => Common::Matrix(values.view_from_model),
        "clip_from_view" | "projection" => Common::Matrix(values.clip_from_view),
        "view_from_normal" | "normal" => Common::Matrix(values.view_from_normal),
        "model" => Common::Matrix(Mat4::IDENTITY),
        "light" | "light_direction" => direction(values.light_view),
        "eye" | "camera" | "camera_position" => point(values.eye_model),
        "base_color" => Common::Numbers(values.base_color),
        _ => return None,
    })
}

/// The first group in which the module binds nothing.
fn unused_group(module: &ShaderModule) -> u32 {
    let is_used = |group: u32| {
        let mut bindings = module.reflections().flat_map(|one| &one.bindings);
        bindings.any(|binding| binding.group == group)
    };
    (0..).find(|group| !is_used(*group)).unwrap_or(0)
}

/// The input of a fragment shader as an expression of the vertex shader, four floats.
fn value_of(input: &Varying) -> &'static str {
    const VALUES: [&str; 5] = [
        "vec4f(position, 1.0)",
        "(surface.view_from_normal * vec4f(normal, 0.0))",
        "vec4f(uv, 0.0, 1.0)",
        "(color * surface.base_color)",
        "(surface.view_from_model * vec4f(position, 1.0))",
    ];
    let name = input.name.to_ascii_lowercase();
    let name = name
        .trim_start_matches("frag")
        .trim_start_matches("v_")
        .trim_start_matches("f_");
    let is_named = |names: &[&str]| {
        names
            .iter()
            .any(|one| name == *one || name.strip_prefix(['v', 'f', '_']) == Some(one))
    };
    let by_name = [
        &["position", "pos", "model_position"][..],
        &["normal", "n"],
        &["uv", "texcoord", "tex_coord", "texcoords"],
        &["color", "colour"],
        &["view_position", "viewposition"],
    ];
    let at = by_name.iter().position(|names| is_named(names));
    let at = at.or_else(|| usize::try_from(input.location).ok());
    at.and_then(|at| VALUES.get(at))
        .copied()
        .unwrap_or("vec4f()")
}

/// The vertex shader that writes these inputs of the fragment shader.
fn vertex_text(inputs: &[Input<'_>], group: u32) -> String {
    let (mut members, mut values) = (String::new(), String::new());
    for Input {
        varying,
        interpolation,
    } in inputs
    {
        let (at, kind) = (varying.location, written_type(varying.kind));
        let value = value_as(kind, value_of(varying));
        // Writing to strings cannot fail.
        let _ = write!(
            members,
            ", @location({at}) @interpolate({interpolation}) i{at}: {kind}"
        );
        let _ = write!(values, " out.i{at} = {value};");
    }
    format!(
        "struct Surface {{ clip_from_model: mat4x4f, view_from_model: mat4x4f, view_from_normal: mat4x4f, base_color: vec4f }}
@group({group}) @binding(0) var<uniform> surface: Surface;
struct Out {{ @builtin(position) clip: vec4f{members} }}
@vertex fn surface_vertex(
    @location(0) position: vec3f, @location(1) normal: vec3f, @location(2) uv: vec2f, @location(3) color: vec4f,
) -> Out {{
    var out: Out;
    out.clip = surface.clip_from_model * vec4f(position, 1.0);{values}
    return out;
}}"
    )
}
