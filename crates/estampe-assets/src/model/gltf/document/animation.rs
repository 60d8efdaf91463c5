//! Animations.

use super::Index;
use serde::Deserialize;

/// An animation of nodes.
#[derive(Debug, Deserialize)]
pub(crate) struct Animation {
    #[serde(default)]
    pub(crate) name: String,
    pub(crate) channels: Vec<AnimationChannel>,
    pub(crate) samplers: Vec<AnimationSampler>,
}

/// One animated property.
#[derive(Debug, Deserialize)]
pub(crate) struct AnimationChannel {
    pub(crate) sampler: Index,
    pub(crate) target: AnimationTarget,
}

/// A property of a node.
#[derive(Debug, Deserialize)]
pub(crate) struct AnimationTarget {
    pub(crate) node: Option<Index>,
    pub(crate) path: String,
}

/// A function of time.
#[derive(Debug, Deserialize)]
pub(crate) struct AnimationSampler {
    pub(crate) input: Index,
    pub(crate) output: Index,
    pub(crate) interpolation: Option<String>,
}
