//! The loads: geometry, shading and blending with which the states are measured.

use clap::ValueEnum;
use serde::Serialize;

/// A load with which states are measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, ValueEnum, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Load {
    /// Eight full-screen opaque quads in smooth colours, back to front: every fragment passes the
    /// depth test.
    Fill,
    /// Eight full-screen quads in smooth colours, back to front, blended by their alpha; depth is
    /// tested and not written.
    Blend,
    /// Opaque triangles of 8 pixels in smooth colours, beside each other.
    Tris8,
    /// One full-screen opaque quad: a texture, bilinear at about one texel per pixel, times the
    /// vertex colour.
    Textured,
    /// Quads of 10×14 pixels beside each other, each with a glyph of a texture times the vertex
    /// colour, blended as premultiplied alpha; depth is tested and not written.
    Text,
}

impl Load {
    /// Every load, in the order of reports.
    pub const ALL: [Self; 5] = [
        Self::Fill,
        Self::Blend,
        Self::Tris8,
        Self::Textured,
        Self::Text,
    ];

    /// The name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Fill => "fill",
            Self::Blend => "blend",
            Self::Tris8 => "tris8",
            Self::Textured => "textured",
            Self::Text => "text",
        }
    }

    /// Returns true if fragments are blended with the stored colour.
    #[must_use]
    pub const fn is_blended(self) -> bool {
        matches!(self, Self::Blend | Self::Text)
    }

    /// Returns true if fragments sample a texture.
    #[must_use]
    pub const fn is_textured(self) -> bool {
        matches!(self, Self::Textured | Self::Text)
    }
}

#[cfg(test)]
mod tests {
    use super::Load;
    use clap::ValueEnum;

    #[test]
    fn a_load_has_one_name_everywhere() {
        assert_eq!(Load::ALL, Load::value_variants());
        for load in Load::ALL {
            let possible = load.to_possible_value().unwrap();
            assert_eq!(possible.get_name(), load.name());
            assert_eq!(serde_json::to_value(load).unwrap(), load.name());
        }
    }
}
