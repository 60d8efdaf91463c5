//! `estampe shader image`: the picture of a fragment shader.
//!
//! ```text
//! source -> module -> triangle (a vertex shader that writes what the fragment shader reads)
//!        -> resources (uniforms by name, buffers, textures) -> picture -> output
//! ```

mod arguments;
mod command;

pub(crate) use arguments::ImageArgs;
pub(crate) use command::run;
