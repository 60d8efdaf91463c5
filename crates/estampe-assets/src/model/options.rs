//! Choice of what is read from files that have several scenes, animations or variants.

/// What is read from a model's file. Only glTF files have a choice.
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
