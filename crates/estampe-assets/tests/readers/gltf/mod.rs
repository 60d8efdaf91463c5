//! Reader of glTF 2.0. The files are made here, by a small builder.

mod amplification;
pub(super) mod builder;
mod containers;
mod geometry;
mod ktx2;
mod material_extensions;
mod materials;
pub(super) mod meshopt;
mod nodes;
mod poses;
mod rules;
mod textures;
mod validator;

use builder::{Builder, error, load, mesh};
