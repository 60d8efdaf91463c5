//! The results of the growth measurements as Markdown.

use super::fans::SIDES;
use super::jobs::{CostsByCores, FrameCosts, JobKind};
use super::memory::Memory;
use super::meshes::{CLASSES, COUNTS};
use super::series::{Cost, Series};
use super::simulation::WakeUp;
use std::fmt::Write as _;
use std::ops::RangeBounds;

/// All results.
#[derive(Debug, Clone)]
pub struct Results {
    /// SIMD level and processor.
    pub driver: String,
    /// Frame time by number of triangles: for each size class, on one thread and on all.
    pub triangles: Vec<Series>,
    /// Frame time by number of pixels: for each kind of work, on one thread and on all.
    pub pixels: Vec<Series>,
    /// Memory; `None` if the system does not report it.
    pub memory: Option<Memory>,
    /// Each scene's name, costs, and measured speed-up by all threads.
    pub scenes: Vec<(&'static str, CostsByCores, f64)>,
    /// The time to wake a thread.
    pub wake_up: WakeUp,
    /// The number of all threads.
    pub threads: usize,
}

/// A number of pixels whose colours and depths, 8 MiB, fit into most processors' caches.
const IN_CACHE: f64 = 1024.0 * 1024.0;
/// A number of pixels whose colours and depths, 32 MiB, are written to memory by each frame.
const BEYOND_CACHE: f64 = 2048.0 * 2048.0;

/// The simulated numbers of cores.
pub(super) const CORES: [usize; 4] = [2, 8, 16, 64];

/// The section's text.
#[must_use]
pub fn section(results: &Results) -> String {
    let mut out = String::new();
    let _ = write!(
        out,
        "# How cost grows\n\n\
         Written by `cargo run --release -p estampe-bench -- --growth docs`, which repeats all measurements.\n\
         {}. A frame is recorded, cleared, drawn and stored to memory; times are medians.\n",
        results.driver
    );
    triangles(results, &mut out);
    pixels(results, &mut out);
    memory(results, &mut out);
    cores(results, &mut out);
    out
}

fn triangles(results: &Results, out: &mut String) {
    out.push_str(
        "\n## With triangles\n\n\
         ![Frame time against the number of triangles](images/growth_triangles.svg)\n\n\
         A mesh of triangles of one mean area, Gouraud-shaded, opaque, with depth, in a frame of 1280×720. Meshes that\n\
         do not fit into the frame have several layers, the farthest first, so that every triangle passes the depth test.\n\
         A tile first resolves visibility and then shades. In one layer the cost of a triangle includes its shading. In\n\
         many layers it is that of vertices, set-up, coverage and depth test, and the cost of shading is that of one\n\
         layer for any number of layers. So there are two lines *fixed + each · triangles*, fitted by least squares of\n\
         relative errors; *off* is the largest distance of a measurement from its line.\n\n",
    );
    fit_heads("triangle", out);
    for one in &results.triangles {
        let class = CLASSES.iter().find(|class| class.name == one.name);
        let layer = f64::from(class.map_or(0, |class| class.of_one_layer()));
        fit(one, "one layer", &(..=layer), out);
        fit(one, "many layers", &(layer..), out);
    }
    out.push_str("\nMilliseconds of a frame (wall time):\n\n");
    let heads = COUNTS.map(|count| superscript(f64::from(count)));
    costs(&results.triangles, &heads, "triangles", out);
}

fn pixels(results: &Results, out: &mut String) {
    out.push_str(
        "\n## With pixels\n\n\
         ![Frame time against the number of pixels](images/growth_pixels.svg)\n\n\
         A fan of sixteen triangles that covers each pixel of a square frame once. Colour and depth of\n\
         1024² pixels are 8 MiB, which fit the caches; those of 2048² are 32 MiB, which do not. Each case has a line.\n\
         *Clear* is included in the other two.\n\n",
    );
    fit_heads("pixel", out);
    for one in &results.pixels {
        fit(one, "to 1024²", &(..=IN_CACHE), out);
        fit(one, "from 2048²", &(BEYOND_CACHE..), out);
    }
    out.push_str("\nMilliseconds of a frame (wall time):\n\n");
    let heads = SIDES.map(|side| format!("{side}²"));
    costs(&results.pixels, &heads, "pixels", out);
}

fn fit_heads(unit: &str, out: &mut String) {
    let _ = write!(
        out,
        "| | threads | | ns per {unit}, CPU | ns per {unit}, wall | fixed, ms | off |\n\
         |---|---:|---|---:|---:|---:|---:|\n"
    );
}

/// Appends slope, fixed cost and deviation of a series, over the counts in a range.
fn fit(series: &Series, name: &str, counts: &impl RangeBounds<f64>, out: &mut String) {
    let cpu = series.fit(counts, |cost: &Cost| cost.cpu_ms);
    let wall = series.fit(counts, |cost: &Cost| cost.wall_ms);
    if let (Some((cpu, _)), Some((wall, off))) = (cpu, wall) {
        let _ = writeln!(
            out,
            "| {} | {} | {name} | {} | {} | {} | {:.0} % |",
            series.name,
            series.threads,
            significant(cpu.each * 1e6),
            significant(wall.each * 1e6),
            significant(wall.fixed.max(0.0)),
            off * 100.0
        );
    }
}

/// Appends a table with a row per count and a column per series.
fn costs(series: &[Series], heads: &[String], unit: &str, out: &mut String) {
    let _ = write!(out, "| {unit} |");
    for one in series {
        let _ = write!(out, " {}, {} |", one.name, threads(one.threads));
    }
    let _ = write!(out, "\n|---:|{}\n", "---:|".repeat(series.len()));
    for (row, head) in heads.iter().enumerate() {
        let _ = write!(out, "| {head} |");
        for one in series {
            let ms = one.costs.get(row).map(|cost| significant(cost.wall_ms));
            let _ = write!(out, " {} |", ms.unwrap_or_default());
        }
        out.push('\n');
    }
}

fn memory(results: &Results, out: &mut String) {
    out.push_str(
        "\n## Memory\n\n\
         By the data structures, a triangle takes 16 bytes per vertex for the window position and 4 for each scalar of\n\
         the varyings (Gouraud: 16), at half a vertex per triangle of a closed mesh; a sixteenth of a packet of 1,344\n\
         bytes, which is 84; and for each packet and tile that it touches an entry of 12 bytes when binned and 8 when\n\
         sorted, in lists that double when they grow. That is 100 bytes and the entries. Measured memory above that was\n\
         freed by growing lists and kept by the allocator. Draw batches of two million primitives bound all of it: larger\n\
         frames reuse the memory. A pixel takes 4 bytes for each sample of each attachment, in blocks of 64×64; of\n\
         attachments that a pass of one batch clears and discards, as pictures of `estampe render` do, nothing.\n",
    );
    let Some(memory) = &results.memory else {
        return;
    };
    out.push_str(
        "\nMeasured (resident memory of the process; the caller's buffers are not counted):\n\n\
         | | bytes each |\n|---|---:|\n",
    );
    for class in &memory.triangles {
        let _ = writeln!(
            out,
            "| triangle of {} | {:.1} |",
            class.class.name, class.each
        );
    }
    let _ = writeln!(
        out,
        "| pixel, RGBA8 and 32-bit depth | {:.2} |\n\n\
         4 million triangles of 1 px take {:.0} MB, 1 million {:.0} MB.",
        memory.pixel,
        memory.four_millions * 1e-6,
        memory.one_million * 1e-6,
    );
}

fn cores(results: &Results, out: &mut String) {
    let wake_up = results.wake_up;
    let _ = write!(
        out,
        "\n## With cores\n\n\
         Every job of a frame (runs of vertices, chunks of primitives, tiles) was timed on one core, and the schedule was\n\
         simulated with these times: in each phase helpers are woken as a tree, and each idle thread takes jobs from the\n\
         front of the remaining ones, in batches of a fourth of its share. The jobs are those of the number of cores:\n\
         geometry goes in groups that grow with it, and small images have smaller tiles for many. The parts between phases are\n\
         serial. Of each job and of each serial part the least time of 15 frames counts, which no other program\n\
         interrupted. Speed-ups are for helpers that are awake; in brackets for helpers that sleep before each phase, with this machine's times of\n\
         {:.1} µs to call one and {:.1} µs until it runs. The simulation assumes that memory is as fast for many cores as for one.\n\n\
         | scene | ms on 1 | {} measured |",
        wake_up.call_ns as f64 * 1e-3,
        wake_up.arrival_ns as f64 * 1e-3,
        results.threads,
    );
    for cores in CORES {
        let _ = write!(out, " {cores} |");
    }
    out.push_str(
        " limits of 64 (shares of their time) |\n|---|---:|---:|---:|---:|---:|---:|---|\n",
    );
    for (name, frame, measured) in &results.scenes {
        let alone = frame.alone.on_cores_ns(1, wake_up) as f64 * 1e-6;
        let _ = write!(out, "| {name} | {} | {measured:.2} |", significant(alone));
        for (cores, costs) in &frame.of_cores {
            let awake = costs.speed_up(*cores, WakeUp::default());
            let asleep = costs.speed_up(*cores, wake_up);
            let _ = write!(out, " {awake:.1} ({asleep:.1}) |");
        }
        let most = frame.of_cores.last().map(|(_, costs)| obstacles(costs));
        let _ = writeln!(out, " {} |", most.unwrap_or_default());
    }
}

/// The two largest parts of the time on 64 awake cores that are not parallel work, in words.
fn obstacles(frame: &FrameCosts) -> String {
    let limits = frame.limits(64, WakeUp::default());
    let mut shares = vec![(limits.serial, "serial parts".to_owned())];
    for (kind, share) in limits.waiting {
        let (count, largest) = frame.largest(kind);
        let what = match kind {
            JobKind::Tiles => format!(
                "{count} tiles, the largest {:.1} % of them",
                largest * 100.0
            ),
            _ if count == 1 => kind.name_of_one().to_owned(),
            _ => format!("{count} {}", kind.name()),
        };
        shares.push((share, what));
    }
    shares.sort_by(|a, b| b.0.total_cmp(&a.0));
    let said = shares.iter().take(2).filter(|(share, _)| *share >= 0.05);
    let said: Vec<String> = said
        .map(|(share, what)| format!("{what}: {:.0} %", share * 100.0))
        .collect();
    if said.is_empty() {
        "nothing: all but a twentieth is shared".to_owned()
    } else {
        said.join("; ")
    }
}

fn threads(count: usize) -> String {
    format!("{count} thread{}", if count == 1 { "" } else { "s" })
}

/// A number with three significant digits.
fn significant(value: f64) -> String {
    if value >= 100.0 {
        format!("{value:.0}")
    } else if value >= 10.0 {
        format!("{value:.1}")
    } else if value >= 1.0 {
        format!("{value:.2}")
    } else {
        format!("{value:.3}")
    }
}

/// A count as a power of ten, times √10 for half decades.
#[must_use]
pub fn superscript(count: f64) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let log = libm::log10(count);
    let whole = (log + 0.25).floor();
    let is_half = log - whole > 0.25;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the decade of a count"
    )]
    let digit = DIGITS[(whole as usize).min(9)];
    let factor = if is_half { "3.16·" } else { "" };
    format!("{factor}10{digit}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_powers_of_ten() {
        let words = [100.0, 316.0, 1e4, 3_162_278.0, 1e7].map(superscript);
        assert_eq!(words, ["10²", "3.16·10²", "10⁴", "3.16·10⁶", "10⁷"]);
    }

    #[test]
    fn a_section_states_the_slope_in_nanoseconds() {
        let cost = |count: f64| Cost {
            count,
            wall_ms: 0.5 + count * 3e-5,
            cpu_ms: 0.5 + count * 6e-5,
        };
        let one = Series {
            name: "10 px",
            threads: 2,
            costs: COUNTS.map(|count| cost(f64::from(count))).to_vec(),
        };
        let frame = FrameCosts {
            phases: Vec::new(),
            serial_ns: 1000,
        };
        let by_cores = CostsByCores {
            alone: frame.clone(),
            of_cores: vec![(64, frame)],
        };
        let text = section(&Results {
            driver: "d".to_owned(),
            triangles: vec![one],
            pixels: Vec::new(),
            memory: None,
            scenes: vec![("clear", by_cores, 1.0)],
            wake_up: WakeUp::default(),
            threads: 2,
        });
        for layers in ["one layer", "many layers"] {
            let line = format!("| 10 px | 2 | {layers} | 60.0 | 30.0 | 0.500 | 0 % |");
            assert!(text.contains(&line), "{line} in {text}");
        }
        assert!(text.contains("| 10⁷ | 300 |"));
        assert!(text.contains("serial parts: 100 %"));
    }
}
