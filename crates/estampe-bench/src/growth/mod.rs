//! Growth of cost: frame time by triangles and by pixels, and the speed-up by more cores.
//!
//! * [`meshes`] makes frames by number and size of triangles; [`fans`] makes frames by number of
//!   pixels;
//! * [`series`] measures them, [`fit`] fits lines to them, [`plot`] draws them;
//! * [`memory`] measures the memory of a triangle and of a pixel;
//! * [`jobs`] records the costs of a scene's jobs, [`simulation`] schedules them on more cores;
//! * [`mod@section`] writes the results as Markdown.

pub mod fans;
pub mod fit;
pub mod jobs;
pub mod memory;
pub mod meshes;
pub mod plot;
pub mod section;
pub mod series;
pub mod simulation;

mod gouraud;

use crate::BenchError;
use crate::frame::{FrameSize, PreparedScene};
use crate::scene::{ALL, Detail, Scene};
use crate::stages::SIZE;
use estampe::{Device, DeviceDescriptor, Level};
use indicatif::{ProgressBar, ProgressStyle};
use jobs::CostsByCores;
use memory::Memory;
use plot::{Curve, Plot};
use section::{Results, section};
use series::{Cost, Series};
use simulation::WakeUp;
use std::path::Path;

/// Colours of the curves, in order: distinct in hue and in lightness.
const COLORS: [&str; 3] = ["#1b6ca8", "#d1495b", "#2e8b57"];

/// Measures everything, and writes the section to `folder/GROWTH.md` and its plots to
/// `folder/images`.
///
/// # Errors
/// [`BenchError`]: no device can be created, or a file cannot be written.
pub fn run(folder: &Path, level: Level) -> Result<String, BenchError> {
    let progress = Progress::new();
    // First, while the process has no free memory that it could reuse.
    progress.step("memory");
    let memory = Memory::measure(level)?;
    let devices = devices(level)?;
    let all = devices.last().map_or(1, Device::threads);
    let triangles = triangle_series(&devices, &progress)?;
    let pixels = pixel_series(&devices, &progress)?;
    let mut scenes = Vec::new();
    for entry in ALL {
        progress.step(entry.name);
        let scene = entry.make(Detail::Full, SIZE);
        let by_cores = CostsByCores::record(level, &scene, SIZE, &section::CORES)?;
        let costs = costs_of(&devices, &scene, SIZE, 1.0)?;
        let ends = costs.first().zip(costs.last());
        let measured = ends.map_or(1.0, |(one, all)| one.wall_ms / all.wall_ms);
        scenes.push((entry.name, by_cores, measured));
    }
    let results = Results {
        driver: format!("{}, SIMD level {}", processor(), level.name()),
        memory,
        scenes,
        wake_up: WakeUp::measure(),
        threads: all,
        triangles,
        pixels,
    };
    let text = section(&results);
    write(&folder.join("GROWTH.md"), &text)?;
    let images = folder.join("images");
    let plots = [
        ("growth_triangles.svg", triangle_plot(&results)),
        ("growth_pixels.svg", pixel_plot(&results)),
    ];
    for (name, plot) in plots {
        write(&images.join(name), &plot.to_svg())?;
    }
    Ok(text)
}

/// A device of one thread, and one with a thread per processor.
fn devices(level: Level) -> Result<Vec<Device>, BenchError> {
    let device = |threads| {
        Device::new(&DeviceDescriptor {
            threads,
            level,
            ..DeviceDescriptor::default()
        })
    };
    let (one, all) = (device(1)?, device(0)?);
    Ok(if all.threads() > 1 {
        vec![one, all]
    } else {
        vec![one]
    })
}

/// The cost of a frame on each of the devices.
fn costs_of(
    devices: &[Device],
    scene: &Scene,
    size: FrameSize,
    count: f64,
) -> Result<Vec<Cost>, BenchError> {
    let cost = |device| {
        let mut prepared = PreparedScene::new(device, scene, size)?;
        Ok(Cost::measure(&mut prepared, count))
    };
    devices.iter().map(cost).collect()
}

/// An empty series for each device.
fn empty_series(devices: &[Device], name: &'static str) -> Vec<Series> {
    let series = devices.iter().map(|device| Series {
        name,
        threads: device.threads(),
        costs: Vec::new(),
    });
    series.collect()
}

fn triangle_series(devices: &[Device], progress: &Progress) -> Result<Vec<Series>, BenchError> {
    let mut all = Vec::new();
    for class in meshes::CLASSES {
        let mut series = empty_series(devices, class.name);
        for count in meshes::COUNTS {
            progress.step(class.name);
            let scene = meshes::mesh(class, count);
            let costs = costs_of(devices, &scene, SIZE, f64::from(count))?;
            for (one, cost) in series.iter_mut().zip(costs) {
                one.costs.push(cost);
            }
        }
        all.extend(series);
    }
    Ok(all)
}

fn pixel_series(devices: &[Device], progress: &Progress) -> Result<Vec<Series>, BenchError> {
    let mut all = Vec::new();
    for work in fans::WORKS {
        let mut series = empty_series(devices, work.name());
        for side in fans::SIDES {
            progress.step(work.name());
            let pixels = f64::from(side) * f64::from(side);
            let costs = costs_of(devices, &work.scene(), fans::square(side), pixels)?;
            for (one, cost) in series.iter_mut().zip(costs) {
                one.costs.push(cost);
            }
        }
        all.extend(series);
    }
    Ok(all)
}

fn triangle_plot(results: &Results) -> Plot {
    let decades = meshes::COUNTS.iter().step_by(2).map(|count| {
        let count = f64::from(*count);
        (count, section::superscript(count))
    });
    Plot {
        title: "Frame time against triangles, 1280×720".to_owned(),
        x_label: "triangles".to_owned(),
        y_label: "wall time of a frame, ms".to_owned(),
        x_ticks: decades.collect(),
        curves: curves(&results.triangles),
    }
}

fn pixel_plot(results: &Results) -> Plot {
    let sides = fans::SIDES.iter().map(|side| {
        let pixels = f64::from(*side) * f64::from(*side);
        (pixels, format!("{side}²"))
    });
    Plot {
        title: "Frame time against pixels, each covered once".to_owned(),
        x_label: "pixels of a square frame".to_owned(),
        y_label: "wall time of a frame, ms".to_owned(),
        x_ticks: sides.collect(),
        curves: curves(&results.pixels),
    }
}

/// Curves with a colour for each name, dashed for more than one thread.
fn curves(series: &[Series]) -> Vec<Curve> {
    let mut names: Vec<&str> = Vec::new();
    let curve = |one: &Series| {
        if !names.contains(&one.name) {
            names.push(one.name);
        }
        let plural = if one.threads == 1 { "" } else { "s" };
        Curve {
            name: format!("{}, {} thread{plural}", one.name, one.threads),
            color: COLORS[(names.len() - 1) % COLORS.len()],
            is_dashed: one.threads > 1,
            points: one.points(&.., |cost| cost.wall_ms),
        }
    };
    series.iter().map(curve).collect()
}

/// The system's name of the processor.
fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = text
        .lines()
        .find_map(|line| line.strip_prefix("model name"));
    let name = name.map(|name| name.trim_start_matches([' ', '\t', ':']).trim());
    name.unwrap_or("an unnamed processor").to_owned()
}

fn write(path: &Path, text: &str) -> Result<(), BenchError> {
    let file = |source| BenchError::File {
        path: path.to_owned(),
        source,
    };
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(file)?;
    }
    std::fs::write(path, text).map_err(file)
}

/// A progress bar on a terminal: the measurement takes a minute or two.
struct Progress {
    bar: ProgressBar,
}

impl Progress {
    fn new() -> Self {
        let steps = 1
            + meshes::CLASSES.len() * meshes::COUNTS.len()
            + fans::WORKS.len() * fans::SIDES.len()
            + ALL.len();
        let bar = ProgressBar::new(steps as u64);
        if let Ok(style) = ProgressStyle::with_template("[{bar:40}] {msg} ({elapsed})") {
            bar.set_style(style);
        }
        Self { bar }
    }

    /// Starts the next step.
    fn step(&self, name: &'static str) {
        self.bar.inc(1);
        self.bar.set_message(name);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
