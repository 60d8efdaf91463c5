//! The vertex stage: all vertices in every space, over the edges of the primitives.

use super::heat::Rgb;
use super::sheet::{self, Legend, Panel, Sheet, line};
use super::totals::Totals;
use crate::failure::Failure;
use estampe::{Device, PassStages};
use estampe_renderer::FrameStages;
use serde_json::{Map, Value};

const EDGE: Rgb = [176, 190, 212];
const POINT: Rgb = [24, 64, 160];
const VOLUME: Rgb = [214, 96, 30];

/// A space: its name, the position of each vertex, and a frame.
struct Space {
    name: &'static str,
    /// None of what has no place in the space.
    positions: Vec<Option<[f64; 3]>>,
    /// True if y runs downwards.
    is_down: bool,
    /// The rectangle of what is visible, x and y from the least to the greatest.
    frame: Option<[[f64; 2]; 2]>,
}

/// The sheet and the totals.
pub(super) fn sheet(frame: &FrameStages, device: &Device) -> Result<(Sheet, Totals), Failure> {
    let stages = &frame.stages;
    let spaces = spaces(frame);
    let edges = edges(stages);
    let [width, height] = stages.size;
    let panel_width = (width / 2).clamp(220, 2048);
    let panel_height = u64::from(panel_width) * u64::from(height) / u64::from(width.max(1));
    let panel_height = u32::try_from(panel_height).unwrap_or(u32::MAX);
    let size = [panel_width, panel_height.clamp(60, 2048)];
    let mut panels = Vec::new();
    for space in &spaces {
        panels.push(panel(space, &edges, size, device)?);
    }
    let behind = stages
        .vertices
        .iter()
        .filter(|vertex| vertex.clip[3] <= 0.0);
    let totals = Totals::default()
        .count("vertices", "vertices", stages.vertices.len() as u64)
        .count("primitives", "primitives", stages.primitives.len() as u64)
        .count("behind_eye", "behind the eye", behind.count() as u64)
        .value("ranges", ranges(&spaces));
    let sheet = Sheet {
        title: format!("vertex: {}", totals.text()),
        columns: 3,
        panels,
        legend: Legend::Names(vec![
            (POINT, "vertex"),
            (EDGE, "edge"),
            (VOLUME, "limit of the picture"),
        ]),
    };
    Ok((sheet, totals))
}

fn spaces(frame: &FrameStages) -> [Space; 6] {
    let stages = &frame.stages;
    let [width, height] = stages.size.map(f64::from);
    let space = |name, positions: Vec<Option<[f64; 3]>>| Space {
        name,
        positions: positions
            .into_iter()
            .map(|at| at.filter(|at| at.iter().all(|along| along.is_finite())))
            .collect(),
        is_down: false,
        frame: None,
    };
    let early = |of: fn(&estampe_renderer::VertexSpaces) -> [f64; 3]| {
        frame.spaces.iter().map(|spaces| Some(of(spaces))).collect()
    };
    let clip = || {
        stages
            .vertices
            .iter()
            .map(|vertex| vertex.clip.map(f64::from))
    };
    let ndc = |[x, y, z, w]: [f64; 4]| (w > 0.0).then(|| [x / w, y / w, z / w]);
    let window = |[x, y, z]: [f64; 3]| {
        let [x, y] = [(x + 1.0) * 0.5 * width, (1.0 - y) * 0.5 * height];
        [x, y, z]
    };
    [
        space("object", early(|spaces| spaces.object.to_array())),
        space("world", early(|spaces| spaces.world.to_array())),
        space("eye", early(|spaces| spaces.eye.to_array())),
        space("clip", clip().map(|[x, y, z, _]| Some([x, y, z])).collect()),
        Space {
            frame: Some([[-1.0, 1.0]; 2]),
            ..space("ndc", clip().map(ndc).collect())
        },
        Space {
            is_down: true,
            frame: Some([[0.0, width], [0.0, height]]),
            ..space("window", clip().map(|at| ndc(at).map(window)).collect())
        },
    ]
}

/// The edges of all primitives, each once.
fn edges(stages: &PassStages) -> Vec<[u32; 2]> {
    let mut edges = Vec::new();
    for primitive in &stages.primitives {
        match *primitive.vertices() {
            [a, b] => edges.push([a.min(b), a.max(b)]),
            [a, b, c] => {
                edges.extend([[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)]));
            }
            _ => {}
        }
    }
    edges.sort_unstable();
    edges.dedup();
    edges
}

/// The least and the greatest x, y and z; `None` without vertices.
fn range(space: &Space) -> Option<[[f64; 2]; 3]> {
    let places = || space.positions.iter().flatten();
    places().next()?;
    Some([0, 1, 2].map(|axis: usize| {
        let along = || places().map(|at| at[axis]);
        let least = along().fold(f64::INFINITY, f64::min);
        [least, along().fold(f64::NEG_INFINITY, f64::max)]
    }))
}

fn ranges(spaces: &[Space]) -> Value {
    let named = spaces.iter().map(|space| {
        let range = range(space);
        (space.name.to_owned(), serde_json::json!(range))
    });
    Value::Object(named.collect::<Map<_, _>>())
}

/// A range with as many digits as tell its ends apart.
fn span([least, greatest]: [f64; 2]) -> String {
    let steps = [(100.0, 0), (10.0, 1), (1.0, 2), (0.1, 3), (0.01, 4)];
    let extent = greatest - least;
    let digits = steps.iter().find(|(from, _)| extent >= *from);
    let digits = digits.map_or(5, |&(_, digits)| digits);
    let number = |value: f64| {
        let text = format!("{value:.digits$}");
        let is_whole = !text.contains('.');
        let short = text.trim_end_matches('0').trim_end_matches('.');
        match short {
            _ if is_whole => text,
            "-0" => "0".to_owned(),
            _ => short.to_owned(),
        }
    };
    format!("{}..{}", number(least), number(greatest))
}

/// A space seen along z: x to the right.
fn panel(
    space: &Space,
    edges: &[[u32; 2]],
    size: [u32; 2],
    device: &Device,
) -> Result<Panel, Failure> {
    let found = range(space);
    let [x, y, z] = found.unwrap_or([[0.0; 2]; 3]);
    let caption = match found {
        Some(_) => format!(
            "{}  x {}  y {}  z {}",
            space.name,
            span(x),
            span(y),
            span(z)
        ),
        None => format!("{}  no vertices", space.name),
    };
    let mut panel = Panel::blank(caption, size, [250, 251, 253]);

    // Fit what is shown into the panel: the frame, or the vertices.
    let [shown_x, shown_y] = space.frame.unwrap_or([x, y]);
    let inner = size.map(|side| f64::from(side) - 16.0);
    let lengths = [shown_x, shown_y].map(|[least, greatest]| (greatest - least).max(1e-300));
    let scale = if space.name == "ndc" {
        [inner[0] / lengths[0], inner[1] / lengths[1]]
    } else {
        [(inner[0] / lengths[0]).min(inner[1] / lengths[1]); 2]
    };
    let middle = [shown_x, shown_y].map(|[least, greatest]| (least + greatest) * 0.5);
    let up = if space.is_down { 1.0 } else { -1.0 };
    let place = |[x, y]: [f64; 2]| {
        sheet::place([
            (x - middle[0]) * scale[0] + f64::from(size[0]) * 0.5,
            (y - middle[1]) * scale[1] * up + f64::from(size[1]) * 0.5,
        ])
    };
    let vertex = |at: u32| space.positions[at as usize].map(|[x, y, _]| place([x, y]));
    let strokes = edges.iter().filter_map(|&[a, b]| {
        let (a, b) = (vertex(a)?, vertex(b)?);
        Some(line([a, b], EDGE, 1.0))
    });
    panel.draw(device, strokes)?;
    if let Some([[left, right], [top, bottom]]) = space.frame {
        let corners = [[left, top], [right, top], [right, bottom], [left, bottom]].map(place);
        let sides = (0..4).map(|k| line([corners[k], corners[(k + 1) % 4]], VOLUME, 1.5));
        panel.draw(device, sides)?;
    }
    let side = if space.positions.len() > 600 { 1 } else { 3 };
    for [x, y, _] in space.positions.iter().flatten() {
        panel.dot(place([*x, *y]), side, POINT);
    }
    Ok(panel)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spans_have_the_digits_that_tell_their_ends_apart() {
        assert_eq!(span([-1.0, 1.0]), "-1..1");
        assert_eq!(span([0.99971, 1.0]), "0.99971..1");
        assert_eq!(span([-2166.67, 366.771]), "-2167..367");
        assert_eq!(span([-0.001, 3.4301]), "0..3.43");
        assert_eq!(span([100.0, 300.0]), "100..300");
    }
}
