//! The shader that a command reads: its language and stage, and the module of it.

use super::toy::{self, Wrapping};
use crate::failure::Failure;
use crate::input;
use crate::values::shown;
use clap::Args;
use estampe::{
    Device, Reflection, ShaderErrors, ShaderModule, ShaderModuleDescriptor, ShaderSource,
    ShaderStage,
};
use estampe_assets::{Limits, read_stream};
use estampe_shader::front::{Module, Options, Source, load};
use std::io;
use std::path::Path;

/// How a shader is read.
#[derive(Debug, Clone, Args)]
pub(crate) struct SourceArgs {
    /// A macro of GLSL, or the value of a constant (override) of WGSL or SPIR-V; repeatable
    #[arg(short = 'D', value_name = "NAME=VALUE", value_parser = define)]
    pub(crate) defines: Vec<(String, String)>,

    /// The language: wgsl, glsl or spirv [default: by FILE's name, else by its content]
    #[arg(long, value_name = "LANGUAGE", value_enum, hide_possible_values = true)]
    pub(crate) language: Option<Language>,
}

/// Languages of shaders.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Language {
    /// The WebGPU Shading Language
    Wgsl,
    /// The OpenGL Shading Language, one stage
    Glsl,
    /// SPIR-V, binary
    #[value(alias = "spv")]
    Spirv,
}

/// Names of stages.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum StageName {
    /// Vertex shaders
    #[value(alias = "vert")]
    Vertex,
    /// Fragment shaders
    #[value(alias = "frag")]
    Fragment,
    /// Compute shaders
    #[value(alias = "comp")]
    Compute,
}

impl From<StageName> for ShaderStage {
    fn from(name: StageName) -> Self {
        match name {
            StageName::Vertex => Self::Vertex,
            StageName::Fragment => Self::Fragment,
            StageName::Compute => Self::Compute,
        }
    }
}

/// The stage in messages.
pub(crate) fn stage_name(stage: ShaderStage) -> &'static str {
    match stage {
        ShaderStage::Vertex => "vertex",
        ShaderStage::Fragment => "fragment",
        ShaderStage::Compute => "compute",
    }
}

/// `NAME` or `NAME=VALUE`; a name alone is 1, as in C compilers.
pub(crate) fn define(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').unwrap_or((text, "1"));
    if name.trim().is_empty() {
        return Err("write NAME=VALUE, as in LIGHTS=3".to_owned());
    }
    Ok((name.trim().to_owned(), value.to_owned()))
}

/// A shader that was read.
#[derive(Debug, Clone)]
pub(crate) struct ShaderFile {
    /// The name for messages.
    pub(crate) name: String,
    pub(crate) contents: Contents,
    defines: Vec<(String, String)>,
    /// The lines that were added to a shader toy.
    wrapping: Option<Wrapping>,
}

/// The contents of a shader's file.
#[derive(Debug, Clone)]
pub(crate) enum Contents {
    Wgsl(String),
    Glsl { stage: ShaderStage, text: String },
    SpirV(Vec<u8>),
}

impl ShaderFile {
    /// Reads a file, or standard input if the path is `-`. `stage` is that of GLSL, if it was
    /// named.
    pub(crate) fn read(
        path: &Path,
        stage: Option<ShaderStage>,
        args: &SourceArgs,
    ) -> Result<Self, Failure> {
        let limits = Limits::default();
        let (name, bytes) = if path.as_os_str() == "-" {
            let bytes = read_stream(io::stdin().lock(), &limits).map_err(|error| {
                let advice = "check the program that writes it";
                Failure::Input(format!("standard input: {error}; {advice}"))
            })?;
            ("standard input".to_owned(), bytes)
        } else {
            (shown(path), input::read_file(path, &limits)?)
        };
        let language = args
            .language
            .or_else(|| language_of_name(&name))
            .or_else(|| language_of_content(&bytes))
            .ok_or_else(|| {
                Failure::Usage(format!(
                    "{name}: neither name nor content shows the language; add --language wgsl, \
                     glsl or spirv"
                ))
            })?;
        if stage.is_some() && language != Language::Glsl {
            return Err(Failure::Usage(format!(
                "{name}: --stage is for GLSL; other languages say the stages themselves: omit it"
            )));
        }
        let contents = match language {
            Language::Spirv => Contents::SpirV(bytes),
            Language::Wgsl => Contents::Wgsl(text(&name, bytes)?),
            Language::Glsl => {
                let text = text(&name, bytes)?;
                let stage = stage
                    .or_else(|| stage_of_name(&name))
                    .unwrap_or_else(|| stage_of_text(&text));
                Contents::Glsl { stage, text }
            }
        };
        Ok(Self {
            name,
            contents,
            defines: args.defines.clone(),
            wrapping: None,
        })
    }

    /// The shader, or its errors as those of the input.
    pub(crate) fn module(&self, device: &Device) -> Result<ShaderModule, Failure> {
        let module = self.load(device);
        module.map_err(|errors| Failure::Input(errors.to_string()))
    }

    /// The same with this stage, if it is GLSL.
    pub(crate) fn with_stage(self, stage: ShaderStage) -> Self {
        match self.contents {
            Contents::Glsl { text, .. } => Self {
                contents: Contents::Glsl { stage, text },
                ..self
            },
            _ => self,
        }
    }

    /// The text; `None` for SPIR-V.
    pub(crate) fn text(&self) -> Option<&str> {
        match &self.contents {
            Contents::Wgsl(text) | Contents::Glsl { text, .. } => Some(text),
            Contents::SpirV(_) => None,
        }
    }

    /// True for GLSL.
    pub(crate) fn is_glsl(&self) -> bool {
        matches!(self.contents, Contents::Glsl { .. })
    }

    /// Checks the shader.
    pub(crate) fn load(&self, device: &Device) -> Result<ShaderModule, ShaderErrors> {
        let source = match &self.contents {
            Contents::Wgsl(text) => ShaderSource::Wgsl(text),
            Contents::Glsl { stage, text } => ShaderSource::GlslStage {
                stage: *stage,
                text,
            },
            Contents::SpirV(bytes) => ShaderSource::SpirVBytes(bytes),
        };
        let module = device.create_shader_module(&ShaderModuleDescriptor {
            label: Some(&self.name),
            defines: &self.macros(),
            ..ShaderModuleDescriptor::new(source)
        });
        module.map_err(|errors| match &self.wrapping {
            Some(wrapping) => wrapping.in_authors_lines(errors),
            None => errors,
        })
    }

    /// A fragment shader; a shader toy of GLSL gets its `main`.
    pub(crate) fn into_fragment(self) -> Self {
        let Contents::Glsl { text, .. } = &self.contents else {
            return self;
        };
        let wrapped = toy::wrap(text);
        let (text, wrapping) = match wrapped {
            Some((text, wrapping)) => (text, Some(wrapping)),
            None => (text.clone(), None),
        };
        let stage = ShaderStage::Fragment;
        Self {
            contents: Contents::Glsl { stage, text },
            wrapping,
            ..self
        }
    }

    /// A fragment shader if it is a shader toy, else as it is.
    pub(crate) fn with_main(self) -> Self {
        match &self.contents {
            Contents::Glsl { text, .. } if toy::wrap(text).is_some() => self.into_fragment(),
            _ => self,
        }
    }

    /// The module as the compiler reads it.
    pub(crate) fn front(&self) -> Result<Module, ShaderErrors> {
        let source = match &self.contents {
            Contents::Wgsl(text) => Source::Wgsl(text),
            Contents::Glsl { stage, text } => Source::Glsl {
                stage: *stage,
                text,
            },
            Contents::SpirV(bytes) => Source::SpirVBytes(bytes),
        };
        let owned = |(name, value): (&str, &str)| (name.to_owned(), value.to_owned());
        let options = Options {
            file: Some(self.name.clone()),
            defines: self.macros().into_iter().map(owned).collect(),
            ..Options::default()
        };
        load(source, &options)
    }

    /// The macros of GLSL.
    pub(crate) fn macros(&self) -> Vec<(&str, &str)> {
        let defines = self.defines.iter().filter(|_| self.is_glsl());
        defines.map(|(name, value)| (&**name, &**value)).collect()
    }

    /// The values of constants, by name or by the digits of their id, of modules with these
    /// reflections.
    pub(crate) fn constants<'r>(
        &self,
        reflections: impl IntoIterator<Item = &'r Reflection>,
    ) -> Result<Vec<(&str, f64)>, Failure> {
        let reflections: Vec<&Reflection> = reflections.into_iter().collect();
        let overrides = || reflections.iter().flat_map(|one| &one.overrides);
        let defines = self.defines.iter().filter(|_| !self.is_glsl());
        let constants = defines.map(|(name, value)| {
            let is_key = |id: &u16| name.parse() == Ok(*id);
            let is_there = overrides().any(|constant| {
                constant.name.as_deref() == Some(name) || constant.id.as_ref().is_some_and(is_key)
            });
            if !is_there {
                let file = &self.name;
                let names: Vec<String> = reflections
                    .iter()
                    .copied()
                    .flat_map(constant_names)
                    .collect();
                let there_are = if names.is_empty() {
                    "it has none".to_owned()
                } else {
                    format!("it has {}", names.join(", "))
                };
                return Err(Failure::Usage(format!(
                    "-D {name}: {file} has no constant `{name}`; {there_are}"
                )));
            }
            let number = match value.trim() {
                "true" => Some(1.0),
                "false" => Some(0.0),
                number => number.parse().ok(),
            };
            let number = number.filter(|number: &f64| number.is_finite());
            let number = number.ok_or_else(|| {
                Failure::Usage(format!("-D {name}={value}: write a number, as in {name}=3"))
            })?;
            Ok((&**name, number))
        });
        constants.collect()
    }
}

/// The constants of a module as messages name them.
fn constant_names(reflection: &Reflection) -> impl Iterator<Item = String> {
    reflection.overrides.iter().map(|constant| {
        let id = || constant.id.map(|id| id.to_string());
        let name = constant.name.clone().or_else(id).unwrap_or_default();
        format!("`{name}`")
    })
}

/// The text of a file.
fn text(name: &str, bytes: Vec<u8>) -> Result<String, Failure> {
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        Failure::Input(format!(
            "{name}: byte {at} is not UTF-8; save the shader as UTF-8 text"
        ))
    })
}

/// The last parts of a file's name, in lower case: `frag` and `glsl` of `sky.frag.glsl`.
fn extensions(name: &str) -> impl Iterator<Item = String> {
    let file = name.rsplit(['/', '\\']).next().unwrap_or(name);
    let parts = file.split('.').skip(1).map(str::to_ascii_lowercase);
    parts.collect::<Vec<_>>().into_iter().rev()
}

fn language_of_name(name: &str) -> Option<Language> {
    match &*extensions(name).next()? {
        "wgsl" => Some(Language::Wgsl),
        "spv" | "spirv" => Some(Language::Spirv),
        "glsl" => Some(Language::Glsl),
        extension => stage_of_extension(extension).map(|_| Language::Glsl),
    }
}

fn stage_of_extension(extension: &str) -> Option<ShaderStage> {
    match extension {
        "vert" | "vs" | "vsh" => Some(ShaderStage::Vertex),
        "frag" | "fs" | "fsh" => Some(ShaderStage::Fragment),
        "comp" | "cs" => Some(ShaderStage::Compute),
        _ => None,
    }
}

fn stage_of_name(name: &str) -> Option<ShaderStage> {
    let mut last = extensions(name).take(2);
    last.find_map(|extension| stage_of_extension(&extension))
}

/// The stage that a text of GLSL is for, by the variables that only one stage has.
fn stage_of_text(text: &str) -> ShaderStage {
    if text.contains("gl_Position") {
        ShaderStage::Vertex
    } else if text.contains("local_size_") || text.contains("gl_GlobalInvocationID") {
        ShaderStage::Compute
    } else {
        ShaderStage::Fragment
    }
}

fn language_of_content(bytes: &[u8]) -> Option<Language> {
    /// The first word of SPIR-V (SPIR-V 1.6, section 3.1), in either byte order.
    const MAGIC: [[u8; 4]; 2] = [[0x03, 0x02, 0x23, 0x07], [0x07, 0x23, 0x02, 0x03]];
    if MAGIC.iter().any(|magic| bytes.starts_with(magic)) {
        return Some(Language::Spirv);
    }
    let text = std::str::from_utf8(bytes).ok()?;
    let has = |words: &[&str]| words.iter().any(|word| text.contains(word));
    if has(&["#version", "void main", "gl_FragCoord", "mainImage"]) {
        Some(Language::Glsl)
    } else if has(&["@fragment", "@vertex", "@compute", "fn "]) {
        Some(Language::Wgsl)
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn languages_and_stages_are_found() {
        assert_eq!(language_of_name("a/b.c/sky.WGSL"), Some(Language::Wgsl));
        assert_eq!(language_of_name("sky.frag"), Some(Language::Glsl));
        assert_eq!(language_of_name("a.b/sky"), None);
        let stages = [
            ("a.vert", Some(ShaderStage::Vertex)),
            ("a.fs", Some(ShaderStage::Fragment)),
            ("a.comp.glsl", Some(ShaderStage::Compute)),
            ("a.glsl", None),
            ("vert.d/a.glsl", None),
        ];
        for (name, stage) in stages {
            assert_eq!(stage_of_name(name), stage, "{name}");
        }
        let content = language_of_content(b"#version 330\nvoid main() {}");
        assert_eq!(content, Some(Language::Glsl));
        assert_eq!(language_of_content(b"hello"), None);
        let content = language_of_content(&[3, 2, 0x23, 7, 0]);
        assert_eq!(content, Some(Language::Spirv));
    }

    #[test]
    fn definitions_have_names() {
        assert_eq!(define("A"), Ok(("A".to_owned(), "1".to_owned())));
        assert_eq!(define("A=b=c"), Ok(("A".to_owned(), "b=c".to_owned())));
        assert!(define("=3").is_err());
    }
}
