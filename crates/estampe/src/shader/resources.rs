//! What a shader binds: buffers, textures and uniform blocks of the command line.

use super::uniforms::Blocks;
use super::values::{self, BufferContents, Immediates, Slot, TextureName};
use crate::failure::Failure;
use crate::input;
use crate::values::shown;
use clap::Args;
use estampe::state::CompareFunction;
use estampe::{
    AddressMode, BindGroup, BindGroupDescriptor, BindGroupLayout, BindingResource, BindingType,
    Buffer, BufferBindingType, BufferDescriptor, Device, FilterMode, SampleType, SamplerDescriptor,
    ShaderModule, TextureDescriptor, TextureFormat, TextureView, ViewDimension,
};
use estampe_assets::Limits;
use estampe_assets::image::decode;
use std::path::{Path, PathBuf};

/// What a shader binds.
#[derive(Debug, Clone, Args)]
pub(crate) struct ResourceArgs {
    /// A buffer by group and binding: the bytes of a file, or zeros; repeatable
    #[arg(long, value_name = "G,B=FILE|zeros:BYTES", value_parser = values::buffer)]
    #[arg(help_heading = "Resources")]
    buffer: Vec<(Slot, BufferContents)>,

    /// A texture by name or by group and binding: PNG, JPEG, WebP, TGA, BMP, DDS or KTX2;
    /// repeatable
    #[arg(long, value_name = "NAME=FILE", value_parser = values::texture)]
    #[arg(help_heading = "Resources")]
    texture: Vec<(TextureName, PathBuf)>,

    /// The immediates (push constants): the bytes of a file, or hexadecimal digits
    #[arg(long, value_name = "FILE|hex:DIGITS", value_parser = values::immediates)]
    #[arg(help_heading = "Resources")]
    immediates: Option<Immediates>,

    /// A uniform by name: numbers with commas between; repeatable
    #[arg(long, value_name = "NAME=VALUE", value_parser = values::setting)]
    #[arg(allow_hyphen_values = true, help_heading = "Resources")]
    set: Vec<(String, String)>,
}

impl ResourceArgs {
    /// The bytes of the immediates, of which the shader reads `needed`.
    pub(crate) fn immediates(&self, needed: u32) -> Result<Vec<u8>, Failure> {
        let bytes = match &self.immediates {
            None if needed > 0 => {
                return Err(Failure::Usage(format!(
                    "the shader reads {needed} bytes of immediates (push constants): give them by \
                     --immediates FILE or --immediates hex:DIGITS"
                )));
            }
            None => Vec::new(),
            Some(Immediates::File(path)) => input::read_file(path, &Limits::default())?,
            Some(Immediates::Bytes(bytes)) => bytes.clone(),
        };
        let most = estampe::Limits::default().max_immediate_size;
        let given = bytes.len();
        let rule = if given < needed as usize {
            format!("the shader reads {needed}; give more")
        } else if given > most as usize {
            format!("{most} are possible")
        } else if !given.is_multiple_of(4) {
            "a multiple of 4 is possible".to_owned()
        } else {
            return Ok(bytes);
        };
        Err(Failure::Usage(format!(
            "--immediates: {given} bytes, but {rule}"
        )))
    }

    /// Uniforms, and the texture of each of these bindings.
    pub(crate) fn of_surfaces(set: &[(String, String)], textures: Vec<(Slot, PathBuf)>) -> Self {
        let textures = textures.into_iter();
        Self {
            buffer: Vec::new(),
            texture: textures
                .map(|(slot, path)| (TextureName::Slot(slot), path))
                .collect(),
            immediates: None,
            set: set.to_vec(),
        }
    }
}

/// The first row of textures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FirstRow {
    /// That of the file, as in WebGPU.
    Top,
    /// The last one of the file, as in OpenGL.
    Bottom,
}

/// Makes the bind groups of a program.
pub(crate) struct Binder<'a> {
    pub(crate) device: &'a Device,
    pub(crate) module: &'a ShaderModule,
    pub(crate) args: &'a ResourceArgs,
    pub(crate) first_row: FirstRow,
}

/// The resources of a program.
pub(crate) struct Bound {
    pub(crate) groups: Vec<BindGroup>,
    /// The buffers that were bound.
    pub(crate) buffers: Vec<(Slot, Buffer)>,
}

impl Binder<'_> {
    /// The bind groups of these layouts. `blocks` has what uniforms are, unless options say
    /// otherwise.
    pub(crate) fn bind(
        &self,
        layouts: &[BindGroupLayout],
        mut blocks: Blocks,
    ) -> Result<Bound, Failure> {
        for (name, value) in &self.args.set {
            blocks.set(name, value)?;
        }
        self.check_named(layouts)?;
        let mut bound = Bound {
            groups: Vec::new(),
            buffers: Vec::new(),
        };
        for (group, layout) in layouts.iter().enumerate() {
            let group = u32::try_from(group).unwrap_or(u32::MAX);
            let mut entries = Vec::new();
            for entry in layout.entries() {
                let slot = (group, entry.binding);
                let resource = self.resource(slot, entry.ty, &blocks)?;
                if let BindingResource::Buffer(slice) = &resource {
                    bound.buffers.push((slot, slice.buffer.clone()));
                }
                entries.push((entry.binding, resource));
            }
            let label = format!("group {group}");
            let group = self.device.create_bind_group(&BindGroupDescriptor {
                label: Some(&label),
                layout,
                entries: &entries,
            });
            bound.groups.push(group.map_err(refused)?);
        }
        Ok(bound)
    }

    /// Refuses resources that nothing reads.
    fn check_named(&self, layouts: &[BindGroupLayout]) -> Result<(), Failure> {
        let entry = |(group, binding): Slot| layouts.get(group as usize)?.entry(binding);
        for (slot, _) in &self.args.buffer {
            let is_buffer =
                entry(*slot).is_some_and(|e| matches!(e.ty, BindingType::Buffer { .. }));
            if !is_buffer {
                let is_buffer = |ty: BindingType| matches!(ty, BindingType::Buffer { .. });
                let there_are = self.listed(layouts, is_buffer);
                return Err(Failure::Usage(format!(
                    "--buffer {},{}: the entry point uses no buffer there; {there_are}",
                    slot.0, slot.1
                )));
            }
        }
        for (name, _) in &self.args.texture {
            let slot = self.texture_slot(name);
            if !slot.is_some_and(|slot| entry(slot).is_some_and(|e| is_texture(e.ty))) {
                let there_are = self.listed(layouts, is_texture);
                let name = match name {
                    TextureName::Variable(name) => name.clone(),
                    TextureName::Slot((group, binding)) => format!("{group},{binding}"),
                };
                return Err(Failure::Usage(format!(
                    "--texture {name}: the entry point uses no texture of this name; {there_are}"
                )));
            }
        }
        Ok(())
    }

    /// The bindings of a kind, for messages.
    fn listed(&self, layouts: &[BindGroupLayout], is_kind: impl Fn(BindingType) -> bool) -> String {
        let mut names = Vec::new();
        for (group, layout) in layouts.iter().enumerate() {
            let entries = layout.entries().iter().filter(|entry| is_kind(entry.ty));
            let group = u32::try_from(group).unwrap_or(u32::MAX);
            names.extend(entries.map(|entry| self.shown((group, entry.binding))));
        }
        if names.is_empty() {
            "it uses none".to_owned()
        } else {
            format!("it uses {}", names.join(", "))
        }
    }

    /// A binding for messages: its numbers, and its name if it has one.
    fn shown(&self, slot: Slot) -> String {
        let (group, binding) = slot;
        match self.name(slot) {
            Some(name) => format!("{group},{binding} (`{name}`)"),
            None => format!("{group},{binding}"),
        }
    }

    fn name(&self, slot: Slot) -> Option<&str> {
        let reflections = || self.module.reflections();
        let pairs = reflections().flat_map(|one| &one.combined_samplers);
        let mut pairs = pairs
            .filter(|pair| pair.texture == slot)
            .map(|pair| &*pair.name);
        let bindings = reflections().flat_map(|one| &one.bindings);
        let mut bindings = bindings
            .filter(|one| (one.group, one.binding) == slot && !one.name.is_empty())
            .map(|one| &*one.name);
        pairs.next().or_else(|| bindings.next())
    }

    fn texture_slot(&self, name: &TextureName) -> Option<Slot> {
        let name = match name {
            TextureName::Slot(slot) => return Some(*slot),
            TextureName::Variable(name) => name,
        };
        let reflections = || self.module.reflections();
        let pairs = reflections().flat_map(|one| &one.combined_samplers);
        let mut pairs = pairs
            .filter(|pair| pair.name == *name)
            .map(|pair| pair.texture);
        let bindings = reflections().filter_map(|one| one.binding(name));
        let mut bindings = bindings.map(|one| (one.group, one.binding));
        pairs.next().or_else(|| bindings.next())
    }

    fn resource(
        &self,
        slot: Slot,
        ty: BindingType,
        blocks: &Blocks,
    ) -> Result<BindingResource, Failure> {
        match ty {
            BindingType::Buffer {
                ty,
                min_binding_size,
                ..
            } => {
                let buffer = self.buffer(slot, ty, min_binding_size, blocks)?;
                Ok(BindingResource::Buffer(buffer.slice(..)))
            }
            BindingType::Texture {
                sample_type: SampleType::Float,
                view_dimension: ViewDimension::D2,
                multisampled: false,
            } => self.texture(slot).map(BindingResource::Texture),
            BindingType::Sampler { comparison } => {
                let sampler = self.device.create_sampler(&SamplerDescriptor {
                    address_mode_u: AddressMode::Repeat,
                    address_mode_v: AddressMode::Repeat,
                    address_mode_w: AddressMode::Repeat,
                    mag_filter: FilterMode::Linear,
                    min_filter: FilterMode::Linear,
                    mipmap_filter: FilterMode::Linear,
                    compare: comparison.then_some(CompareFunction::LessEqual),
                    ..SamplerDescriptor::default()
                });
                Ok(BindingResource::Sampler(sampler.map_err(refused)?))
            }
            _ => Err(Failure::Input(format!(
                "binding {} is {ty}, which no option gives: 2D textures of numbers, samplers and \
                 buffers are possible",
                self.shown(slot)
            ))),
        }
    }

    fn buffer(
        &self,
        slot: Slot,
        ty: BufferBindingType,
        least: u64,
        blocks: &Blocks,
    ) -> Result<Buffer, Failure> {
        let zeros = |size: u64| self.device.create_buffer(&BufferDescriptor::new(size));
        let given = self.args.buffer.iter().rfind(|(at, _)| *at == slot);
        let buffer = match given {
            Some((_, BufferContents::Zeros(size))) => zeros(*size),
            Some((_, BufferContents::File(path))) => {
                let bytes = input::read_file(path, &Limits::default())?;
                self.device.create_buffer_with_contents(&bytes)
            }
            None => match (ty, blocks.bytes(slot)) {
                (BufferBindingType::Uniform, Some(bytes)) => {
                    self.device.create_buffer_with_contents(bytes)
                }
                (BufferBindingType::Uniform, None) => zeros(least.max(4)),
                (BufferBindingType::Storage { .. }, _) => {
                    let (group, binding) = slot;
                    return Err(Failure::Usage(format!(
                        "binding {} is a storage buffer of at least {least} bytes: give it by \
                         --buffer {group},{binding}=FILE or --buffer {group},{binding}=zeros:BYTES",
                        self.shown(slot)
                    )));
                }
            },
        };
        let buffer = buffer.map_err(refused)?;
        if buffer.size() < least {
            return Err(Failure::Usage(format!(
                "--buffer {},{}: {} bytes, but the shader needs at least {least}; give more",
                slot.0,
                slot.1,
                buffer.size()
            )));
        }
        Ok(buffer)
    }

    fn texture(&self, slot: Slot) -> Result<TextureView, Failure> {
        let given = self.args.texture.iter();
        let mut given = given.filter(|(name, _)| self.texture_slot(name) == Some(slot));
        let Some((_, path)) = given.next_back() else {
            let name = self
                .name(slot)
                .map_or(format!("{},{}", slot.0, slot.1), str::to_owned);
            return Err(Failure::Usage(format!(
                "binding {} is a texture: give it by --texture {name}=FILE",
                self.shown(slot)
            )));
        };
        self.read_texture(path)
    }

    /// The texture of a file; its codes are numbers from 0 to 1, without sRGB decoding.
    fn read_texture(&self, path: &Path) -> Result<TextureView, Failure> {
        let limits = Limits::default();
        let bytes = input::read_file(path, &limits)?;
        let image = decode(&bytes, &limits).map_err(|error| error.in_file(&shown(path)))?;
        let mut rgba = image.rgba;
        if self.first_row == FirstRow::Bottom {
            rgba = flipped(&rgba, image.width);
        }
        let descriptor =
            TextureDescriptor::new_2d(image.width, image.height, TextureFormat::Rgba8Unorm);
        let texture = self
            .device
            .create_texture_with_data(&descriptor.with_all_levels(), &[&rgba]);
        Ok(texture.map_err(refused)?.view())
    }
}

/// True for textures that are sampled.
pub(crate) fn is_texture(ty: BindingType) -> bool {
    matches!(ty, BindingType::Texture { .. })
}

/// The rows of an image of RGBA in the opposite order.
pub(crate) fn flipped(rgba: &[u8], width: u32) -> Vec<u8> {
    let rows = rgba.chunks_exact((width as usize * 4).max(1));
    rows.rev().flatten().copied().collect()
}

fn refused(error: impl std::fmt::Display) -> Failure {
    Failure::Input(error.to_string())
}
