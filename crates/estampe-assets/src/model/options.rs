//! Choice of what is read from files that have several scenes, animations or variants, and how.

use estampe_scene::AlphaMode;

/// What is read from a model's file, and how. Only glTF files have scenes, animations and variants.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ModelOptions {
    /// Index of the scene; `None`, the default, is the file's own choice.
    pub scene: Option<usize>,
    /// The animation whose pose is read; `None`, the default, is the pose without animation.
    pub animation: Option<AnimationName>,
    /// The time within the animation, in seconds; default 0. Outside of its keyframes the first or
    /// last one is used.
    pub time_s: f32,
    /// Name of the material variant; `None`, the default, is the materials of the primitives
    /// themselves.
    pub variant: Option<String>,
    /// Use of the alpha of colour textures in OBJ's MTL.
    pub alpha: TextureAlpha,
    /// If set, the first warning is an error. Default not.
    pub is_strict: bool,
}

impl ModelOptions {
    /// The choice of something that only glTF files have, if there is one: a sentence's subject.
    pub(super) fn of_gltf_alone(&self) -> Option<String> {
        let animation = match &self.animation {
            Some(AnimationName::Index(index)) => Some(format!("animation {index}")),
            Some(AnimationName::Name(name)) => Some(format!("the animation \"{name}\"")),
            Some(AnimationName::First) | None => None,
        };
        let variant = self.variant.as_ref();
        self.scene
            .map(|scene| format!("scene {scene}"))
            .or(animation)
            .or_else(|| variant.map(|name| format!("the variant \"{name}\"")))
    }
}

/// Use of the alpha of colour textures in OBJ's MTL, which does not state it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum TextureAlpha {
    /// By the material: it is opaque unless its `d` is below 1, its `Tr` is above 0, or it has a
    /// `map_d`.
    #[default]
    Auto,
    /// Every material is opaque.
    Opaque,
    /// Texels with alpha below ½ are cut out.
    Mask,
    /// Textures with alpha are blended.
    Blend,
}

impl TextureAlpha {
    /// The mode of a texture whose alpha suggests `found`.
    pub(super) fn or(self, found: AlphaMode) -> AlphaMode {
        match (self, found) {
            (Self::Opaque, _) | (_, AlphaMode::Opaque) => AlphaMode::Opaque,
            (Self::Auto, _) => found,
            (Self::Mask, _) => AlphaMode::Mask,
            (Self::Blend, _) => AlphaMode::Blend,
        }
    }
}

/// An animation of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum AnimationName {
    /// The first one, if the file has any.
    First,
    /// By its place in the file, from 0.
    Index(usize),
    /// By its name; of several, the first.
    Name(String),
}

/// The choices that a file offers.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ModelChoices {
    /// Names of the scenes; may be empty.
    pub scenes: Vec<String>,
    /// The animations.
    pub animations: Vec<AnimationClip>,
    /// Names of the material variants.
    pub variants: Vec<String>,
}

/// An animation that a file has.
#[derive(Debug, Clone, PartialEq)]
pub struct AnimationClip {
    /// Name in the file; may be empty.
    pub name: String,
    /// Time of the last keyframe.
    pub duration_s: f32,
}
