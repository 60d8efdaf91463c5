//! Animations, also those that are not chosen: targets, formats, numbers of keyframes.
//!
//! Validator: `ANIMATION_DUPLICATE_TARGETS`, `ANIMATION_CHANNEL_TARGET_NODE_MATRIX`,
//! `ANIMATION_CHANNEL_TARGET_NODE_WEIGHTS_NO_MORPHS`,
//! `ANIMATION_SAMPLER_INPUT_ACCESSOR_INVALID_FORMAT`,
//! `ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_FORMAT`,
//! `ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_COUNT`, `SKIN_IBM_INVALID_FORMAT`,
//! `INVALID_IBM_ACCESSOR_COUNT`, `VALUE_NOT_IN_LIST`.

use super::super::accessor::Component;
use super::super::document::{Accessor, Animation, AnimationChannel, Document};
use super::Report;
use std::collections::HashSet;

/// Warns of animations and skins that break a rule.
pub(super) fn check(document: &Document<'_>, report: &mut Report<'_, '_>) {
    for (at, animation) in document.animations.iter().enumerate() {
        let mut targets = HashSet::with_capacity(animation.channels.len());
        for (i, channel) in animation.channels.iter().enumerate() {
            let pointer = || format!("/animations/{at}/channels/{i}");
            let target = &channel.target;
            if let Some(node) = target.node
                && !targets.insert((node, &*target.path))
            {
                report.warn(
                    || format!("{}/target", pointer()),
                    || "another channel has the same target; the last one is used".to_owned(),
                );
            }
            check_target(channel, document, report, pointer);
            check_sampler(channel, animation, document, report, at);
        }
    }
    let samplers = document.animations.iter().enumerate();
    let samplers = samplers.flat_map(|(at, found)| {
        (found.samplers.iter().enumerate()).map(move |sampler| (at, sampler))
    });
    for (at, (i, sampler)) in samplers {
        if let Some(name) = sampler.interpolation.as_deref()
            && !matches!(name, "STEP" | "LINEAR" | "CUBICSPLINE")
        {
            report.warn(
                || format!("/animations/{at}/samplers/{i}/interpolation"),
                || format!("`{name}` is not one of STEP, LINEAR and CUBICSPLINE; LINEAR is used"),
            );
        }
    }
    for (at, skin) in document.skins.iter().enumerate() {
        let matrices = skin.inverse_bind_matrices;
        let Some(matrices) = matrices.and_then(|index| document.accessors.get(index.0)) else {
            continue;
        };
        let place = || format!("/skins/{at}/inverseBindMatrices");
        if matrices.kind != "MAT4" || !is_float(matrices) {
            report.warn(place, || "matrices are MAT4 of floats".to_owned());
        } else if matrices.count.0 < skin.joints.len() {
            report.warn(place, || {
                format!(
                    "{} matrices for {} joints",
                    matrices.count,
                    skin.joints.len()
                )
            });
        }
    }
}

fn check_target(
    channel: &AnimationChannel,
    document: &Document<'_>,
    report: &mut Report<'_, '_>,
    pointer: impl Fn() -> String,
) {
    let node = channel.target.node;
    let Some(node) = node.and_then(|node| document.nodes.get(node.0)) else {
        return;
    };
    match &*channel.target.path {
        "weights" => {
            let mesh = node.mesh.and_then(|mesh| document.meshes.get(mesh.0));
            let primitive = mesh.and_then(|mesh| mesh.primitives.first());
            if primitive.is_none_or(|primitive| primitive.targets.is_empty()) {
                report.warn(
                    || format!("{}/target", pointer()),
                    || "the node's mesh has no morph targets".to_owned(),
                );
            }
        }
        "translation" | "rotation" | "scale" => {
            if node.matrix.is_some() {
                report.warn(
                    || format!("{}/target", pointer()),
                    || "the node has a matrix, which the animation replaces".to_owned(),
                );
            }
        }
        path => report.warn(
            || format!("{}/target/path", pointer()),
            || format!("`{path}` is not one of translation, rotation, scale and weights; it is left out"),
        ),
    }
}

fn check_sampler(
    channel: &AnimationChannel,
    animation: &Animation,
    document: &Document<'_>,
    report: &mut Report<'_, '_>,
    at: usize,
) {
    let index = channel.sampler;
    let Some(sampler) = animation.samplers.get(index.0) else {
        return;
    };
    let place = |property: &str| format!("/animations/{at}/samplers/{index}/{property}");
    let input = document.accessors.get(sampler.input.0);
    if let Some(input) = input
        && (input.kind != "SCALAR" || !is_float(input))
    {
        report.warn(
            || place("input"),
            || "times are SCALAR, of floats".to_owned(),
        );
    }
    let Some(output) = document.accessors.get(sampler.output.0) else {
        return;
    };
    let is_part = output.normalized
        && matches!(
            Component::of(output.component_type),
            Some(Component::I8 | Component::U8 | Component::I16 | Component::U16)
        );
    let is_allowed = match &*channel.target.path {
        "translation" | "scale" => output.kind == "VEC3" && is_float(output),
        "rotation" => output.kind == "VEC4" && (is_float(output) || is_part),
        "weights" => output.kind == "SCALAR" && (is_float(output) || is_part),
        _ => true,
    };
    if !is_allowed {
        report.warn(
            || place("output"),
            || "the specification has no such format for this target".to_owned(),
        );
    }
    let parts = match sampler.interpolation.as_deref() {
        Some("CUBICSPLINE") => 3,
        _ => 1,
    };
    // Morph targets multiply the number of weights.
    if let Some(input) = input
        && matches!(&*channel.target.path, "translation" | "rotation" | "scale")
        && output.count.0 != input.count.0.saturating_mul(parts)
    {
        report.warn(
            || place("output"),
            || format!("{} values for {} keyframes", output.count, input.count),
        );
    }
}

fn is_float(accessor: &Accessor) -> bool {
    Component::of(accessor.component_type) == Some(Component::F32) && !accessor.normalized
}
