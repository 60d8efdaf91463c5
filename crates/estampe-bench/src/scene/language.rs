//! The languages in which scenes are drawn.

use clap::ValueEnum;

/// The language of the scenes' shaders.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ShaderLanguage {
    /// Rust.
    Rust,
    /// WGSL, compiled as the scene is prepared.
    Wgsl,
    /// WGSL in which a product is rounded together with the sum that it is a part of, once:
    /// `ShaderModuleDescriptor::strict_math` is off.
    WgslContracted,
}

impl ShaderLanguage {
    /// Every language, in the order of tables.
    pub const ALL: [Self; 3] = [Self::Rust, Self::Wgsl, Self::WgslContracted];

    /// The name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Rust => "rust",
            Self::Wgsl => "wgsl",
            Self::WgslContracted => "wgsl-contracted",
        }
    }

    /// Returns true if each operation of the shaders is rounded.
    #[must_use]
    pub fn is_strict(self) -> bool {
        self != Self::WgslContracted
    }
}
