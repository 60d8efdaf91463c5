//! Commands: what a device does, as values, so that a list of them is checked as a whole.

use crate::blit::{self, BlitRegion};
use crate::pass::SideBySide;
use crate::texture::{self, TexelCopyLayout, TextureCopy};
use crate::{
    BlitError, Buffer, BufferError, CopyError, Device, Dispatch, DispatchError, Extent3d,
    FilterMode, RenderPass, RenderPassError, Statistics, Texture, TextureError, TextureView,
    compute, copy, pass,
};

/// One command of a [submission](Device::submit): what the device's function of the same name does.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub enum Command<'a> {
    /// [`Device::render`].
    Render(RenderPass<'a>),
    /// [`Device::dispatch`].
    Dispatch(Dispatch<'a>),
    /// [`Buffer::write`].
    WriteBuffer {
        /// The buffer.
        buffer: &'a Buffer,
        /// The first byte that is written.
        offset: u64,
        /// The bytes.
        bytes: &'a [u8],
    },
    /// [`Device::write_texture`].
    WriteTexture {
        /// The texels.
        into: TextureCopy<'a>,
        /// Their bytes.
        bytes: &'a [u8],
        /// The layout of the bytes.
        layout: TexelCopyLayout,
        /// The size of the region.
        size: Extent3d,
    },
    /// [`Device::copy_buffer_to_buffer`].
    CopyBufferToBuffer {
        /// The source, and its first byte.
        from: (&'a Buffer, u64),
        /// The destination, and its first byte.
        into: (&'a Buffer, u64),
        /// The number of bytes.
        size: u64,
    },
    /// [`Device::copy_buffer_to_texture`].
    CopyBufferToTexture {
        /// The source, and the layout of its bytes.
        from: (&'a Buffer, TexelCopyLayout),
        /// The destination.
        into: TextureCopy<'a>,
        /// The size of the region.
        size: Extent3d,
    },
    /// [`Device::copy_texture_to_buffer`].
    CopyTextureToBuffer {
        /// The source.
        from: TextureCopy<'a>,
        /// The destination, and the layout of its bytes.
        into: (&'a Buffer, TexelCopyLayout),
        /// The size of the region.
        size: Extent3d,
    },
    /// [`Device::copy_texture_to_texture`].
    CopyTextureToTexture {
        /// The source.
        from: TextureCopy<'a>,
        /// The destination.
        into: TextureCopy<'a>,
        /// The size of the region.
        size: Extent3d,
    },
    /// [`Device::clear_buffer`].
    ClearBuffer {
        /// The buffer.
        buffer: &'a Buffer,
        /// The first byte.
        offset: u64,
        /// The number of bytes.
        size: u64,
    },
    /// [`Device::clear_texture`].
    ClearTexture(&'a TextureView),
    /// [`Device::generate_mips`].
    GenerateMips(&'a Texture),
    /// [`Device::blit`].
    Blit {
        /// The source.
        from: BlitRegion<'a>,
        /// The destination.
        into: BlitRegion<'a>,
        /// The filter.
        filter: FilterMode,
    },
}

impl<'a> From<RenderPass<'a>> for Command<'a> {
    fn from(pass: RenderPass<'a>) -> Self {
        Self::Render(pass)
    }
}

impl<'a> From<Dispatch<'a>> for Command<'a> {
    fn from(dispatch: Dispatch<'a>) -> Self {
        Self::Dispatch(dispatch)
    }
}

/// The reason why a submission was refused, or ended early.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("command {command}: {error}")]
pub struct SubmitError {
    /// The index of the command.
    pub command: usize,
    /// The reason.
    pub error: Box<CommandError>,
}

/// The reason why a command was refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CommandError {
    /// A pass.
    #[error(transparent)]
    Pass(#[from] RenderPassError),
    /// A dispatch.
    #[error(transparent)]
    Dispatch(#[from] DispatchError),
    /// A copy, or a clear of a buffer.
    #[error(transparent)]
    Copy(#[from] CopyError),
    /// A blit.
    #[error(transparent)]
    Blit(#[from] BlitError),
    /// A use of a buffer.
    #[error(transparent)]
    Buffer(#[from] BufferError),
    /// A use of a texture.
    #[error(transparent)]
    Texture(#[from] TextureError),
}

/// Checks all commands, then runs them in order. Returns the sum of the passes' statistics.
pub(crate) fn submit(device: &Device, commands: &[Command<'_>]) -> Result<Statistics, SubmitError> {
    let at = |command| {
        move |error| SubmitError {
            command,
            error: Box::new(error),
        }
    };
    for (number, command) in commands.iter().enumerate() {
        command.check(device).map_err(at(number))?;
    }
    let _awake = (commands.len() > 1).then(|| device.context().awake());
    let mut statistics = Statistics::default();
    let mut number = 0;
    while number < commands.len() {
        let together = passes_together(device, &commands[number..]);
        if together.is_worthwhile(device) {
            for drawn in together.render(device) {
                statistics += drawn.map_err(|error| at(number)(error.into()))?;
                number += 1;
            }
            continue;
        }
        for command in &commands[number..][..together.len().max(1)] {
            statistics += command.run(device).map_err(at(number))?;
            number += 1;
        }
    }
    Ok(statistics)
}

/// The first commands, as far as they are passes that can be drawn side by side.
fn passes_together<'a>(device: &Device, commands: &'a [Command<'a>]) -> SideBySide<'a> {
    let mut together = SideBySide::default();
    for command in commands {
        let Command::Render(pass) = command else {
            break;
        };
        if !together.add(device, pass) {
            break;
        }
    }
    together
}

impl Command<'_> {
    /// Checks all that [`run`](Self::run) checks before it changes anything.
    fn check(&self, device: &Device) -> Result<(), CommandError> {
        match self {
            Self::Render(pass) => pass::check(device, pass)?,
            Self::Dispatch(dispatch) => compute::check(device.limits(), dispatch)?,
            Self::WriteBuffer {
                buffer,
                offset,
                bytes,
            } => {
                copy::check_write(buffer, *offset, bytes.len() as u64)?;
            }
            Self::WriteTexture {
                into,
                bytes,
                layout,
                size,
            } => texture::check_write(into, bytes.len() as u64, layout, *size)?,
            Self::CopyBufferToBuffer { from, into, size } => {
                copy::check_buffer_to_buffer(*from, *into, *size)?;
            }
            Self::CopyBufferToTexture { from, into, size } => {
                copy::check_buffer_to_texture((from.0, &from.1), into, *size)?;
            }
            Self::CopyTextureToBuffer { from, into, size } => {
                copy::check_texture_to_buffer(from, (into.0, &into.1), *size)?;
            }
            Self::CopyTextureToTexture { from, into, size } => {
                copy::check_texture_to_texture(from, into, *size)?;
            }
            Self::ClearBuffer {
                buffer,
                offset,
                size,
            } => {
                copy::check_write(buffer, *offset, *size)?;
            }
            Self::ClearTexture(view) => copy::check_clear(view)?,
            Self::GenerateMips(texture) => copy::check_mips(texture)?,
            Self::Blit { from, into, filter } => blit::check(device, from, into, *filter)?,
        }
        Ok(())
    }

    fn run(&self, device: &Device) -> Result<Statistics, CommandError> {
        match self {
            Self::Render(pass) => return Ok(device.render(pass)?),
            Self::Dispatch(dispatch) => device.dispatch(dispatch)?,
            Self::WriteBuffer {
                buffer,
                offset,
                bytes,
            } => buffer.write(*offset, bytes)?,
            Self::WriteTexture {
                into,
                bytes,
                layout,
                size,
            } => device.write_texture(into.clone(), bytes, layout, *size)?,
            Self::CopyBufferToBuffer { from, into, size } => {
                device.copy_buffer_to_buffer(*from, *into, *size)?;
            }
            Self::CopyBufferToTexture { from, into, size } => {
                device.copy_buffer_to_texture((from.0, &from.1), into.clone(), *size)?;
            }
            Self::CopyTextureToBuffer { from, into, size } => {
                device.copy_texture_to_buffer(from.clone(), (into.0, &into.1), *size)?;
            }
            Self::CopyTextureToTexture { from, into, size } => {
                device.copy_texture_to_texture(from.clone(), into.clone(), *size)?;
            }
            Self::ClearBuffer {
                buffer,
                offset,
                size,
            } => device.clear_buffer(buffer, *offset, *size)?,
            Self::ClearTexture(view) => device.clear_texture(view)?,
            Self::GenerateMips(texture) => device.generate_mips(texture)?,
            Self::Blit { from, into, filter } => device.blit(*from, *into, *filter)?,
        }
        Ok(Statistics::default())
    }
}
