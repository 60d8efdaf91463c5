//! The pose of the nodes at a time: what the chosen animation changes.
//!
//! Source: glTF 2.0 specification, §3.11 and appendix C "Animation Sampler Interpolation Modes".

use super::accessor::{Accessors, Elements};
use super::choice::Choice;
use super::document::{AnimationSampler, Document, Index, Node};
use super::fault::{element, malformed};
use super::interpolation::{self, Interpolation, Keys};
use crate::{AssetError, Limits};
use std::collections::HashMap;

/// Changes of nodes.
#[derive(Debug, Default)]
pub(super) struct Pose {
    nodes: HashMap<usize, NodePose>,
}

/// Changes of a node.
#[derive(Debug, Default)]
pub(super) struct NodePose {
    pub(super) translation: Option<[f64; 3]>,
    pub(super) rotation: Option<[f64; 4]>,
    pub(super) scale: Option<[f64; 3]>,
    pub(super) weights: Option<Vec<f32>>,
}

impl NodePose {
    /// True if the node's transform changes.
    pub(super) fn moves(&self) -> bool {
        self.translation.is_some() || self.rotation.is_some() || self.scale.is_some()
    }
}

impl Pose {
    /// The changes of a node, if there are any.
    pub(super) fn of_node(&self, node: usize) -> Option<&NodePose> {
        self.nodes.get(&node)
    }

    /// Samples the chosen animation.
    pub(super) fn sample(
        document: &Document<'_>,
        accessors: &Accessors<'_>,
        choice: &Choice,
        limits: &Limits,
    ) -> Result<Self, AssetError> {
        let mut pose = Self::default();
        let Some(index) = choice.animation else {
            return Ok(pose);
        };
        let animation = &document.animations[index];
        let mut times = Times::new(limits);
        for (at, channel) in animation.channels.iter().enumerate() {
            let pointer = format!("/animations/{index}/channels/{at}");
            // Without a node the target belongs to an extension.
            let Some(node) = channel.target.node else {
                continue;
            };
            let place = || format!("{pointer}/target/node");
            let target = element(&document.nodes, node, "node", place)?;
            let sampler = element(&animation.samplers, channel.sampler, "sampler", || {
                format!("{pointer}/sampler")
            })?;
            let sampler_pointer = format!("/animations/{index}/samplers/{}", channel.sampler);
            let keys = times.of(sampler, choice.time_s, accessors, &sampler_pointer)?;
            let output = accessors.get(sampler.output, || format!("{sampler_pointer}/output"))?;
            let weights = morph_target_count(target, document);
            let cost = output.replaced_count().saturating_add(weights);
            times.charge(cost, &sampler_pointer)?;
            let curve = Curve {
                interpolation: interpolation_of(sampler),
                keys,
                output,
            };
            let changed = pose.nodes.entry(node.0).or_default();
            match &*channel.target.path {
                "translation" => changed.translation = curve.vector()?,
                "scale" => changed.scale = curve.vector()?,
                "rotation" => changed.rotation = curve.rotation()?,
                "weights" => changed.weights = Some(curve.weights(weights)?),
                // `pointer` and others belong to extensions.
                _ => {}
            }
        }
        Ok(pose)
    }
}

/// The number of morph targets of a node's mesh.
fn morph_target_count(node: &Node, document: &Document<'_>) -> usize {
    let mesh = node.mesh.and_then(|mesh| document.meshes.get(mesh.0));
    let primitive = mesh.and_then(|mesh| mesh.primitives.first());
    primitive.map_or(0, |primitive| primitive.targets.len())
}

/// The last time of an animation; 0 if its accessors are not valid.
pub(super) fn duration(document: &Document<'_>, accessors: &Accessors<'_>, index: usize) -> f32 {
    let last = |sampler: &AnimationSampler| {
        let times = accessors.get(sampler.input, String::new).ok()?;
        // Sparse accessors are read whole, which is too much for each of many samplers.
        if times.replaced_count() > 0 {
            return None;
        }
        let last = times.count.checked_sub(1)?;
        let [time] = *times.floats_in::<1>(last..times.count).ok()?.first()?;
        time.is_finite().then_some(time)
    };
    let samplers = &document.animations[index].samplers;
    samplers.iter().filter_map(last).fold(0.0, f32::max)
}

/// The interpolation; LINEAR, the default, for names that are unknown.
fn interpolation_of(sampler: &AnimationSampler) -> Interpolation {
    match sampler.interpolation.as_deref() {
        Some("STEP") => Interpolation::Step,
        Some("CUBICSPLINE") => Interpolation::CubicSpline,
        _ => Interpolation::Linear,
    }
}

/// The keyframes around the time in each list of times, found once.
struct Times {
    known: HashMap<Index, Keys>,
    /// Keyframes that may still be read.
    keyframes_left: u64,
}

impl Times {
    fn new(limits: &Limits) -> Self {
        Self {
            known: HashMap::new(),
            keyframes_left: limits.max_vertices,
        }
    }

    fn of(
        &mut self,
        sampler: &AnimationSampler,
        time_s: f32,
        accessors: &Accessors<'_>,
        pointer: &str,
    ) -> Result<Keys, AssetError> {
        let place = || format!("{pointer}/input");
        if let Some(&known) = self.known.get(&sampler.input) {
            return Ok(known);
        }
        let times = accessors.get(sampler.input, place)?;
        self.charge(times.count.saturating_add(times.replaced_count()), pointer)?;
        let list = times.floats::<1>()?;
        if list.is_empty() {
            return Err(malformed(times.pointer(), "an animation without keyframes"));
        }
        // NaN is not less than its neighbours either.
        let is_less = |[before, after]: &[[f32; 1]; 2]| before[0] < after[0];
        let disorder = list.array_windows().position(|pair| !is_less(pair));
        if let Some(at) = disorder {
            let what = format!(
                "the time of keyframe {} is not after the one before it",
                at + 1
            );
            return Err(malformed(times.pointer(), what));
        }
        let keys = Keys::find(&list, time_s);
        self.known.insert(sampler.input, keys);
        Ok(keys)
    }

    /// Counts keyframes whose reading takes time.
    fn charge(&mut self, count: usize, pointer: &str) -> Result<(), AssetError> {
        Limits::check("keyframes", count as u64, self.keyframes_left)
            .map_err(|error| error.at_json(pointer))?;
        self.keyframes_left -= count as u64;
        Ok(())
    }
}

/// The values of a sampler around a time.
struct Curve<'a> {
    interpolation: Interpolation,
    keys: Keys,
    output: Elements<'a>,
}

impl Curve<'_> {
    fn vector(&self) -> Result<Option<[f64; 3]>, AssetError> {
        let values = self.values::<3>(1)?;
        let wide = |keyframe: usize| values[keyframe].map(f64::from);
        Ok(Some(interpolation::vector(
            self.interpolation,
            &self.keys,
            wide,
        )))
    }

    fn rotation(&self) -> Result<Option<[f64; 4]>, AssetError> {
        let values = self.values::<4>(1)?;
        let wide = |keyframe: usize| values[keyframe].map(f64::from);
        Ok(Some(interpolation::rotation(
            self.interpolation,
            &self.keys,
            wide,
        )))
    }

    /// The weights of `count` morph targets.
    fn weights(&self, count: usize) -> Result<Vec<f32>, AssetError> {
        let values = self.values::<1>(count)?;
        let weight = |target: usize| {
            let wide = |part: usize| values[part * count + target].map(f64::from);
            let [weight] = interpolation::vector(self.interpolation, &self.keys, wide);
            #[expect(clippy::cast_possible_truncation, reason = "weights are kept in f32")]
            {
                weight as f32
            }
        };
        Ok((0..count).map(weight).collect())
    }

    /// The values of the two keyframes around the time, one after the other: `count` elements each,
    /// or in a cubic spline `count` tangents before it, `count` values, `count` tangents after it.
    fn values<const N: usize>(&self, count: usize) -> Result<Vec<[f32; N]>, AssetError> {
        let output = &self.output;
        let per_keyframe = count.saturating_mul(self.interpolation.parts());
        let needed = self.keys.count.saturating_mul(per_keyframe);
        if output.count != needed {
            return Err(malformed(
                format!("{}/count", output.pointer()),
                format!(
                    "{} keyframes need {needed} values, there are {}",
                    self.keys.count, output.count
                ),
            ));
        }
        let mut values = Vec::with_capacity(per_keyframe * 2);
        for keyframe in [self.keys.before, self.keys.after] {
            let first = keyframe * per_keyframe;
            values.extend(output.floats_in::<N>(first..first + per_keyframe)?);
        }
        Ok(values)
    }
}
