//! The history of a pixel as text.

use estampe::{FragmentRecord, PrimitiveRecord, SampleValues, TestOutcome};
use estampe_renderer::{FramePixel, RenderOptions, VertexSpaces};
use std::fmt::Write as _;

/// The whole history.
pub(super) fn history(model: &str, options: &RenderOptions, told: &FramePixel) -> String {
    let history = &told.history;
    let [x, y] = history.pixel;
    let (width, height, samples) = (options.width, options.height, options.samples);
    let mut text = format!(
        "{model}, {width}x{height}, {}\n",
        counted(samples, "sample")
    );
    let last = told.final_rgba8;
    let count = history.primitives.len();
    line(
        &mut text,
        0,
        &format!("pixel {x},{y}: {} covered it", counted(count, "primitive")),
    );
    line(
        &mut text,
        0,
        &format!("cleared to {}", values(&history.initial[0])),
    );
    let records = history.primitives.iter().zip(&told.spaces);
    for (number, (record, spaces)) in records.enumerate() {
        primitive(&mut text, number + 1, record, spaces);
    }
    for (sample, stored) in history.last.iter().enumerate().filter(|_| samples > 1) {
        line(
            &mut text,
            0,
            &format!("sample {sample} ends with {}", values(stored)),
        );
    }
    line(&mut text, 0, &format!("final RGBA {}", list(&last)));
    text
}

fn primitive(text: &mut String, number: usize, record: &PrimitiveRecord, spaces: &[VertexSpaces]) {
    let facing = if record.front_facing {
        "front facing"
    } else {
        "back facing"
    };
    let clipped = if record.is_clipped {
        ", a piece that clipping left"
    } else {
        ""
    };
    let culled = if record.is_culled {
        ", culled by its facing"
    } else {
        ""
    };
    line(
        text,
        0,
        &format!(
            "\n{number}. {} {} of draw {}, {facing}{clipped}{culled}",
            record.kind.name(),
            record.primitive,
            record.draw,
        ),
    );
    for (vertex, spaces) in record.vertices.iter().zip(spaces) {
        line(text, 1, &format!("vertex {}", vertex.index));
        let ndc = vertex.ndc();
        let ndc = ndc.map_or("behind the eye".to_owned(), |ndc| list(&ndc));
        let rows = [
            ("object", list(&spaces.object.as_vec3().to_array())),
            ("world", list(&spaces.world.as_vec3().to_array())),
            ("eye", list(&spaces.eye.as_vec3().to_array())),
            ("clip", list(&vertex.clip)),
            ("NDC", ndc),
            ("varyings", list(&vertex.varyings)),
        ];
        for (space, numbers) in rows.iter().filter(|(_, numbers)| !numbers.is_empty()) {
            line(text, 2, &format!("{space:<9}{numbers}"));
        }
    }
    for vertex in &record.piece {
        let [x, y] = vertex.position;
        let (depth, inverse_w) = (vertex.depth, vertex.inverse_w);
        line(
            text,
            1,
            &format!("window   {x}, {y}  depth {depth}  1/w {inverse_w}"),
        );
    }
    if let (Some(edges), Some(barycentrics)) = (record.edges, record.barycentrics) {
        line(
            text,
            1,
            &format!("edge functions at the centre  {} px\u{b2}", list(&edges)),
        );
        line(
            text,
            1,
            &format!("barycentric coordinates       {}", rounded(&barycentrics)),
        );
    }
    for record in &record.fragments {
        fragment(text, record);
    }
}

fn fragment(text: &mut String, record: &FragmentRecord) {
    let run = match record.sample {
        Some(sample) => format!("fragment of sample {sample}"),
        None => "fragment".to_owned(),
    };
    let [x, y, depth, inverse_w] = record.position;
    let covered = mask(record.covered);
    line(
        text,
        1,
        &format!("{run} at {x}, {y}, covers samples {covered}"),
    );
    line(text, 2, &format!("depth {depth}  1/w {inverse_w}"));
    if !record.varyings.is_empty() {
        line(text, 2, &format!("varyings {}", list(&record.varyings)));
    }
    for color in &record.colors {
        line(text, 2, &format!("shader's colour {}", list(color)));
    }
    if let Some(depth) = record.depth {
        line(text, 2, &format!("shader's depth {depth}"));
    }
    if record.is_discarded {
        line(text, 2, "discarded by the shader");
    } else if record.kept != record.covered {
        let kept = mask(record.kept);
        line(
            text,
            2,
            &format!("sample mask and alpha keep samples {kept}"),
        );
    }
    for sample in &record.samples {
        let number = sample.sample;
        let depth = sample.depth;
        let change = match sample.outcome {
            TestOutcome::Passed => {
                format!(
                    "passed: {} \u{2192} {}",
                    values(&sample.before),
                    values(&sample.after)
                )
            }
            TestOutcome::Depth => match sample.before.depth {
                Some(stored) => format!("failed the depth test against {stored}"),
                None => "failed the depth test".to_owned(),
            },
            TestOutcome::Stencil => "failed the stencil test".to_owned(),
            TestOutcome::DepthBounds => "outside of the depth bounds".to_owned(),
        };
        line(
            text,
            2,
            &format!("sample {number}, depth {depth}: {change}"),
        );
    }
}

/// The outcome as a word.
pub(super) fn outcome(outcome: TestOutcome) -> &'static str {
    match outcome {
        TestOutcome::Passed => "passed",
        TestOutcome::Depth => "depth",
        TestOutcome::Stencil => "stencil",
        TestOutcome::DepthBounds => "depth-bounds",
    }
}

fn values(values: &SampleValues) -> String {
    let colors = values
        .colors
        .iter()
        .flatten()
        .map(|color| format!("({})", rounded(color)));
    let depth = values.depth.map(|depth| format!("depth {depth}"));
    let stencil = values.stencil.map(|stencil| format!("stencil {stencil}"));
    let parts: Vec<String> = colors.chain(depth).chain(stencil).collect();
    parts.join(" ")
}

fn line(text: &mut String, depth: usize, words: &str) {
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{:1$}{words}", "", depth * 3);
}

fn counted(count: impl TryInto<u64>, what: &str) -> String {
    match count.try_into() {
        Ok(1) => format!("1 {what}"),
        Ok(count) => format!("{count} {what}s"),
        Err(_) => format!("many {what}s"),
    }
}

fn mask(mask: u16) -> String {
    let samples = (0..16).filter(|sample| mask >> sample & 1 == 1);
    list(&samples.collect::<Vec<u32>>())
}

/// Numbers as they are: f32 in as many digits as tell them apart.
fn list<T: ToString>(numbers: &[T]) -> String {
    numbers
        .iter()
        .map(ToString::to_string)
        .collect::<Vec<_>>()
        .join(", ")
}

/// Numbers with six digits.
fn rounded(numbers: &[f64]) -> String {
    let numbers = numbers.iter().map(|number| format!("{number:.6}"));
    numbers.collect::<Vec<_>>().join(", ")
}
