//! The tree of nodes as indented lines, limited in depth and number.

use super::lines::Lines;
use super::text::named;
use crate::input::Model;
use crate::terminal::one_line;
use serde_json::{Value, json};

/// Lines of the text.
const MAX_LINES: usize = 40;
/// Deeper nodes are counted, not listed, in the text.
const MAX_DEPTH: usize = 8;

/// Writes the tree.
pub(super) fn add(lines: &mut Lines, model: &Model) {
    let contents = &model.contents;
    let nodes = { contents.nodes.iter() }.filter(|node| node.depth <= MAX_DEPTH);
    let mut listed = 0;
    for node in nodes.take(MAX_LINES) {
        listed += 1;
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
        let (indent, name) = ("  ".repeat(node.depth), named(&node.name));
        let colon = if facts.is_empty() { "" } else { ": " };
        lines.add(
            "node",
            &format!("{indent}{name}{colon}{}", facts.join(", ")),
        );
    }
    lines.add_rest(contents.node_count, listed, "nodes");
}

/// The tree as a list, parents before their children.
pub(super) fn json(model: &Model) -> Value {
    let nodes = model.contents.nodes.iter();
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
