//! The clip stage: primitives inside, clipped and dropped, in the window and around it, and in clip
//! space seen from above.

use super::heat::Rgb;
use super::sheet::{self, Legend, Panel, Sheet, line};
use super::totals::Totals;
use crate::failure::Failure;
use estampe::{ClipOutcome, Device, PassStages, PolygonVertex, StagePrimitive};
use estampe_visibility::plot::Stroke;

const INSIDE: Rgb = [186, 196, 210];
const CLIPPED: Rgb = [40, 100, 200];
const DROPPED: Rgb = [236, 190, 190];
const NEW: Rgb = [216, 30, 30];
const VOLUME: Rgb = [20, 130, 80];

/// The sheet and the totals.
pub(super) fn sheet(stages: &PassStages, device: &Device) -> Result<(Sheet, Totals), Failure> {
    let count = |outcome: ClipOutcome| {
        let primitives = stages.primitives.iter();
        primitives.filter(|one| one.clipped == outcome).count() as u64
    };
    let polygons = || stages.primitives.iter().flat_map(|one| &one.polygon);
    let culled = stages.pieces.iter().filter(|piece| piece.is_culled);
    let totals = Totals::default()
        .count("inside", "inside", count(ClipOutcome::Inside))
        .count("clipped", "clipped", count(ClipOutcome::Clipped))
        .count("dropped", "dropped", count(ClipOutcome::Dropped))
        .count("pieces", "pieces", stages.pieces.len() as u64)
        .count("culled", "culled", culled.count() as u64)
        .count("new_vertices", "new vertices", {
            polygons().filter(|vertex| vertex.is_new).count() as u64
        })
        .count("new_edges", "new edges", {
            polygons().filter(|vertex| vertex.is_cut).count() as u64
        });
    let sheet = Sheet {
        title: format!("clip: {}", totals.text()),
        columns: 2,
        panels: vec![window(stages, device)?, from_above(stages, device)?],
        legend: Legend::Names(vec![
            (INSIDE, "inside"),
            (CLIPPED, "clipped"),
            (DROPPED, "dropped"),
            (NEW, "new edge or vertex"),
            (VOLUME, "limit of the view volume"),
        ]),
    };
    Ok((sheet, totals))
}

/// The positions of a primitive and of its polygon in a panel.
trait View {
    /// The place of a position in clip space, if it has one.
    fn of_clip(&self, clip: [f64; 4]) -> Option<[f32; 2]>;

    /// The size of the picture in pixels.
    fn size(&self) -> [f64; 2];

    /// The place of a vertex that was clipped.
    fn of_window(&self, vertex: &PolygonVertex) -> Option<[f32; 2]> {
        let [x, y] = vertex.window.position.map(f64::from);
        let [width, height] = self.size();
        let w = 1.0 / f64::from(vertex.window.inverse_w);
        let (ndc_x, ndc_y) = (x / width * 2.0 - 1.0, 1.0 - y / height * 2.0);
        self.of_clip([ndc_x * w, ndc_y * w, f64::from(vertex.window.depth) * w, w])
    }
}

/// The picture in half of its size, with what is around it.
struct Window([f64; 2]);

impl View for Window {
    fn of_clip(&self, [x, y, _, w]: [f64; 4]) -> Option<[f32; 2]> {
        let place = [
            (x / w * 0.5 + 1.0) * 0.5 * self.0[0],
            (1.0 - y / w * 0.5) * 0.5 * self.0[1],
        ];
        (w > 0.0).then(|| sheet::place(place))
    }

    fn size(&self) -> [f64; 2] {
        self.0
    }
}

/// Clip space from above: x to the right, z up, in a rectangle.
struct FromAbove {
    picture: [f64; 2],
    panel: [f64; 2],
    /// The middle x, and the least z.
    origin: [f64; 2],
    scale: [f64; 2],
}

impl View for FromAbove {
    fn of_clip(&self, [x, _, z, _]: [f64; 4]) -> Option<[f32; 2]> {
        let place = [
            self.panel[0] * 0.5 + (x - self.origin[0]) * self.scale[0],
            self.panel[1] - 8.0 - (z - self.origin[1]) * self.scale[1],
        ];
        let is_finite = place.iter().all(|along| along.is_finite());
        is_finite.then(|| sheet::place(place))
    }

    fn size(&self) -> [f64; 2] {
        self.picture
    }
}

fn blank(caption: &str, stages: &PassStages) -> Panel {
    let size = stages.size.map(|side| side.max(150));
    Panel::blank(caption.to_owned(), size, [250, 251, 253])
}

fn window(stages: &PassStages, device: &Device) -> Result<Panel, Failure> {
    let mut panel = blank("the window and what is around it", stages);
    let view = Window([f64::from(panel.image.width), f64::from(panel.image.height)]);
    primitives(&mut panel, stages, &view, device)?;
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let corners = corners.map(|[x, y]| view.of_clip([x, y, 0.0, 1.0]));
    let sides =
        (0..4).filter_map(|k| Some(line([corners[k]?, corners[(k + 1) % 4]?], VOLUME, 1.5)));
    panel.draw(device, sides)?;
    Ok(panel)
}

fn from_above(stages: &PassStages, device: &Device) -> Result<Panel, Failure> {
    let mut panel = blank("clip space from above: x to the right, z up", stages);
    let clip = || {
        stages
            .vertices
            .iter()
            .map(|vertex| vertex.clip.map(f64::from))
    };
    let finite = || clip().filter(|clip| clip.iter().all(|along| along.is_finite()));
    let least = |axis: usize| finite().map(|at| at[axis]).fold(0.0, f64::min);
    let greatest = |axis: usize| finite().map(|at| at[axis]).fold(0.0, f64::max);
    let size = [f64::from(panel.image.width), f64::from(panel.image.height)];
    let (left, right) = (least(0), greatest(0));
    let (bottom, top) = (least(2), greatest(2));
    let volume = Volume::of(finite());
    let view = FromAbove {
        picture: stages.size.map(f64::from),
        panel: size,
        origin: [(left + right) * 0.5, bottom],
        scale: [
            (size[0] - 16.0) / (right - left).max(1e-300),
            (size[1] - 16.0) / (top - bottom).max(1e-300),
        ],
    };
    primitives(&mut panel, stages, &view, device)?;
    if let Some(Volume { near_w, far_w }) = volume {
        let corner = |x: f64, z: f64| view.of_clip([x, 0.0, z, 1.0]);
        let corners = [
            corner(-near_w, 0.0),
            corner(near_w, 0.0),
            corner(far_w, far_w),
            corner(-far_w, far_w),
        ];
        let sides =
            (0..4).filter_map(|k| Some(line([corners[k]?, corners[(k + 1) % 4]?], VOLUME, 1.5)));
        panel.draw(device, sides)?;
    }
    Ok(panel)
}

/// w at the near and the far plane, which the vertices of a projection show: z is a linear function
/// of w.
struct Volume {
    near_w: f64,
    far_w: f64,
}

impl Volume {
    fn of(clip: impl Iterator<Item = [f64; 4]>) -> Option<Self> {
        let (mut low, mut high) = (None::<[f64; 4]>, None::<[f64; 4]>);
        for at in clip {
            if low.is_none_or(|low| at[3] < low[3]) {
                low = Some(at);
            }
            if high.is_none_or(|high| at[3] > high[3]) {
                high = Some(at);
            }
        }
        let ([_, _, low_z, low_w], [_, _, high_z, high_w]) = (low?, high?);
        if low_w == high_w {
            // A parallel projection: w is 1.
            return Some(Self {
                near_w: 1.0,
                far_w: 1.0,
            });
        }
        let slope = (high_z - low_z) / (high_w - low_w);
        let offset = low_z - slope * low_w;
        let (near_w, far_w) = (-offset / slope, offset / (1.0 - slope));
        (near_w.is_finite() && far_w.is_finite()).then_some(Self { near_w, far_w })
    }
}

/// Draws dropped primitives, then those inside, then what is left of the clipped ones.
fn primitives(
    panel: &mut Panel,
    stages: &PassStages,
    view: &dyn View,
    device: &Device,
) -> Result<(), Failure> {
    let of = |outcome: ClipOutcome| {
        let primitives = stages.primitives.iter();
        primitives.filter(move |one| one.clipped == outcome)
    };
    let outline = |one: &StagePrimitive, color: Rgb| -> Vec<Stroke> {
        let vertices = one.vertices();
        let count = vertices.len();
        let sides = (0..count).filter_map(|k| {
            let vertex = |at: u32| view.of_clip(stages.vertices[at as usize].clip.map(f64::from));
            let (a, b) = (vertex(vertices[k])?, vertex(vertices[(k + 1) % count])?);
            (count > 1).then(|| line([a, b], color, 1.0))
        });
        sides.collect()
    };
    for (outcome, color) in [
        (ClipOutcome::Dropped, DROPPED),
        (ClipOutcome::Inside, INSIDE),
    ] {
        panel.draw(device, of(outcome).flat_map(|one| outline(one, color)))?;
    }
    // Of lines, and of triangles that are drawn as lines, nothing is told but the whole.
    let whole = of(ClipOutcome::Clipped).filter(|one| one.polygon.is_empty());
    panel.draw(device, whole.flat_map(|one| outline(one, CLIPPED)))?;
    for is_cut in [false, true] {
        let sides = of(ClipOutcome::Clipped).flat_map(|one| {
            let next = one.polygon.iter().cycle().skip(1);
            let pairs = one.polygon.iter().zip(next);
            pairs.filter(move |(from, _)| from.is_cut == is_cut)
        });
        let strokes = sides.filter_map(|(from, to)| {
            let ends = [view.of_window(from)?, view.of_window(to)?];
            let (color, width) = if is_cut { (NEW, 1.6) } else { (CLIPPED, 1.0) };
            Some(line(ends, color, width))
        });
        panel.draw(device, strokes)?;
    }
    let new = of(ClipOutcome::Clipped).flat_map(|one| &one.polygon);
    for vertex in new.filter(|vertex| vertex.is_new) {
        if let Some(at) = view.of_window(vertex) {
            panel.dot(at, 3, NEW);
        }
    }
    Ok(())
}
