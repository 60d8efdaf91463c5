//! The history of a pixel as JSON.

use super::text::outcome;
use estampe::{FragmentRecord, PrimitiveRecord, SampleValues};
use estampe_renderer::{FramePixel, RenderOptions, VertexSpaces};
use serde_json::{Value, json};

/// The whole history as one object.
pub(super) fn history(model: &str, options: &RenderOptions, told: &FramePixel) -> Value {
    let history = &told.history;
    let records = history.primitives.iter().zip(&told.spaces);
    json!({
        "model": model,
        "pixel": history.pixel,
        "size": [options.width, options.height],
        "samples": options.samples,
        "initial": values_of_all(&history.initial),
        "history": records.map(|(record, spaces)| primitive(record, spaces)).collect::<Vec<_>>(),
        "last": values_of_all(&history.last),
        "final_rgba8": told.final_rgba8,
    })
}

fn primitive(record: &PrimitiveRecord, spaces: &[VertexSpaces]) -> Value {
    let vertices = record.vertices.iter().zip(spaces).map(|(vertex, spaces)| {
        json!({
            "index": vertex.index,
            "object": spaces.object.to_array(),
            "world": spaces.world.to_array(),
            "eye": spaces.eye.to_array(),
            "clip": vertex.clip,
            "ndc": vertex.ndc(),
            "varyings": vertex.varyings,
        })
    });
    let window = record.piece.iter().map(|vertex| {
        let [x, y] = vertex.position;
        json!({"x": x, "y": y, "depth": vertex.depth, "inverse_w": vertex.inverse_w})
    });
    json!({
        "draw": record.draw,
        "primitive": record.primitive,
        "instance": record.instance,
        "kind": record.kind.name(),
        "front_facing": record.front_facing,
        "culled": record.is_culled,
        "clipped": record.is_clipped,
        "vertices": vertices.collect::<Vec<_>>(),
        "window": window.collect::<Vec<_>>(),
        "edges": record.edges,
        "barycentrics": record.barycentrics,
        "fragments": record.fragments.iter().map(fragment).collect::<Vec<_>>(),
    })
}

fn fragment(record: &FragmentRecord) -> Value {
    let samples = record.samples.iter().map(|sample| {
        json!({
            "sample": sample.sample,
            "depth": sample.depth,
            "outcome": outcome(sample.outcome),
            "before": values(&sample.before),
            "after": values(&sample.after),
        })
    });
    json!({
        "sample": record.sample,
        "covered": bits(record.covered),
        "position": record.position,
        "varyings": record.varyings,
        "colors": record.colors,
        "depth": record.depth,
        "discarded": record.is_discarded,
        "kept": bits(record.kept),
        "samples": samples.collect::<Vec<_>>(),
    })
}

/// The numbers of the samples in a mask.
fn bits(mask: u16) -> Vec<u32> {
    (0..16).filter(|sample| mask >> sample & 1 == 1).collect()
}

fn values_of_all(samples: &[SampleValues]) -> Vec<Value> {
    samples.iter().map(values).collect()
}

fn values(values: &SampleValues) -> Value {
    json!({"colors": values.colors, "depth": values.depth, "stencil": values.stencil})
}
