//! The tree of nodes as indented lines, limited in depth and number.

use crate::input::Model;
use crate::terminal::one_line;
use serde_json::{Value, json};
use std::fmt::Write as _;

/// Lines of the text.
const MAX_LINES: usize = 40;
/// Deeper nodes are counted, not listed, in the text.
const MAX_DEPTH: usize = 8;
/// Nodes of the JSON object.
const MAX_NODES: usize = 10_000;

/// Writes the tree. Writing into a `String` cannot fail.
pub(super) fn text(out: &mut String, model: &Model) {
    let nodes = &model.contents.nodes;
    let shown = nodes
        .iter()
        .filter(|node| node.depth <= MAX_DEPTH)
        .take(MAX_LINES);
    let mut count = 0;
    for node in shown {
        count += 1;
        let name = match &*node.name {
            "" => "(no name)".to_owned(),
            name => one_line(name).into_owned(),
        };
        let mut facts = Vec::new();
        match node.mesh.as_deref() {
            Some("") => facts.push("mesh".to_owned()),
            Some(mesh) => facts.push(format!("mesh {}", one_line(mesh))),
            None => {}
        }
        if node.instances > 1 {
            facts.push(format!("{} instances", node.instances));
        }
        let kinds = [
            (node.has_skin, "skin"),
            (node.has_camera, "camera"),
            (node.has_light, "light"),
        ];
        let kinds = kinds.into_iter().filter(|(is_there, _)| *is_there);
        facts.extend(kinds.map(|(_, kind)| kind.to_owned()));
        let indent = "  ".repeat(node.depth);
        let facts = match &*facts {
            [] => String::new(),
            facts => format!(": {}", facts.join(", ")),
        };
        let _ = writeln!(out, "  node {indent}{name}{facts}");
    }
    if nodes.len() > count {
        let _ = writeln!(out, "  and {} more nodes", nodes.len() - count);
    }
}

/// The tree as a list, parents before their children.
pub(super) fn json(model: &Model) -> Value {
    let nodes = model.contents.nodes.iter().take(MAX_NODES);
    let nodes = nodes.map(|node| {
        json!({
            "name": node.name,
            "depth": node.depth,
            "mesh": node.mesh,
            "instances": node.instances,
            "skin": node.has_skin,
            "camera": node.has_camera,
            "light": node.has_light,
        })
    });
    Value::Array(nodes.collect())
}
