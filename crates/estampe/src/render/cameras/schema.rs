//! The JSON Schema of files of cameras.

use crate::values::MAX_SIDE;
use serde_json::{Value, json};

/// The schema.
pub(crate) fn schema() -> Value {
    let side = json!({ "type": "integer", "minimum": 1, "maximum": MAX_SIDE });
    let three = |items: Value, what: &str| {
        json!({
            "type": "array", "items": items, "minItems": 3, "maxItems": 3, "description": what,
        })
    };
    let vector = |what: &str| three(json!({ "type": "number" }), what);
    let k = "Intrinsics in pixels: [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]";
    let r = "Rotation: the rows are the directions right, down and forward in world space";
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Cameras of estampe render --cameras",
        "type": "array",
        "minItems": 1,
        "items": {
            "type": "object",
            "required": ["K", "R", "t"],
            "additionalProperties": false,
            "dependentRequired": { "width": ["height"], "height": ["width"] },
            "properties": {
                "name": { "type": "string", "description": "Part of the output's name, in place of {camera}" },
                "width": side,
                "height": side,
                "K": three(vector("A row"), k),
                "R": three(vector("A row"), r),
                "t": vector("Translation: a point p of the world is at R p + t before the camera"),
            },
        },
    })
}
