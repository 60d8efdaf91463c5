//! The command line of `estampe-bench`, and its tasks.

use crate::frame::{FrameSize, PreparedScene};
use crate::measure::{Effort, measure};
use crate::models::write_models;
use crate::operations::{self, OperationsArguments};
use crate::picture::{Difference, Picture};
use crate::report::{self, Report, Row};
use crate::scene::{self, Detail, Scene, SceneEntry, ShaderLanguage};
use crate::stages::conversions;
use crate::states::{self, StatesArguments};
use crate::versus::{self, CompareArguments};
use crate::{BenchError, growth, stages};
use clap::{Parser, Subcommand};
use estampe::{Device, DeviceDescriptor, Level};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Times estampe on the scenes of peerbench.
///
/// A frame is recorded, drawn and stored to memory anew each time; nothing of the previous one is
/// reused. Exit codes: 0 done, 1 a picture differs too much from the other renderer's, 2 wrong
/// usage, 3 a file cannot be read or written.
#[derive(Debug, Parser)]
#[command(
    name = "estampe-bench",
    version,
    args_conflicts_with_subcommands = true
)]
pub struct Arguments {
    /// Another task, instead of timing the scenes
    #[command(subcommand)]
    pub task: Option<Task>,
    /// Scenes to draw, separated by commas [default: all]
    #[arg(long, value_delimiter = ',', value_name = "NAME,…")]
    pub scenes: Vec<String>,
    /// Frame sizes, separated by commas
    #[arg(
        long,
        value_delimiter = ',',
        value_name = "WxH,…",
        default_value = "1280x720"
    )]
    pub sizes: Vec<FrameSize>,
    /// The language of the scenes' shaders
    #[arg(long, value_enum, default_value = "rust")]
    pub shaders: ShaderLanguage,
    /// Threads that draw; 0: one per processor
    #[arg(long, default_value_t = 0)]
    pub threads: usize,
    /// SIMD level: auto, scalar, sse2, avx2 or avx512
    #[arg(long, default_value = "auto")]
    pub simd: String,
    /// The least number of frames to measure
    #[arg(long, default_value_t = 15)]
    pub frames: usize,
    /// The least number of seconds to measure
    #[arg(long, default_value_t = 0.6)]
    pub seconds: f64,
    /// Repetitions of a measurement that other processes disturbed
    #[arg(long, default_value_t = 2)]
    pub retries: usize,
    /// Write the results to this file
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// The name of the results
    #[arg(long, default_value = "estampe")]
    pub label: String,
    /// Write each scene's last frame to DIR/SCENE_WxH.png
    #[arg(long, value_name = "DIR")]
    pub images: Option<PathBuf>,
    /// Compare each scene's last frame with DIR/SCENE_WxH.png
    #[arg(long, value_name = "DIR")]
    pub compare: Option<PathBuf>,
    /// Measure each stage on its own, and the conversions between tiles and rows, instead of the
    /// scenes
    #[arg(long)]
    pub stages: bool,
    /// Measure how cost grows with triangles, pixels and cores, instead of the scenes, and write
    /// DIR/GROWTH.md and its plots in DIR/images: two minutes
    #[arg(long, value_name = "DIR", conflicts_with = "stages")]
    pub growth: Option<PathBuf>,
}

/// A task of the command besides timing our own scenes.
#[derive(Debug, Subcommand)]
pub enum Task {
    /// Compares estampe with lavapipe, scene by scene
    Compare(CompareArguments),
    /// Writes the models on which PERFORMANCE.md measures the whole process
    Models {
        /// The folder in which they are written
        #[arg(value_name = "DIR")]
        folder: PathBuf,
    },
    /// Measures the cost of each state of the pipeline
    States(StatesArguments),
    /// Measures the cost of each operation of shaders as text
    Operations(OperationsArguments),
}

/// The result of comparing pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// All compared pictures agree, or none were compared.
    Agreement,
    /// Some pictures differ by more than the gate.
    Difference,
}

impl Outcome {
    fn of(all_agree: bool) -> Self {
        if all_agree {
            Self::Agreement
        } else {
            Self::Difference
        }
    }
}

impl Arguments {
    fn effort(&self) -> Effort {
        Effort {
            frames: self.frames,
            time: Duration::try_from_secs_f64(self.seconds).unwrap_or_default(),
            retries: self.retries,
        }
    }

    /// The requested scenes; for a comparison, only those that `peerbench` has.
    fn scenes(&self) -> Result<Vec<&'static SceneEntry>, BenchError> {
        let (asked, is_offered): (_, fn(&SceneEntry) -> bool) = match &self.task {
            Some(Task::Compare(compare)) => (&compare.scenes, |entry| entry.is_peers),
            _ => (&self.scenes, |_| true),
        };
        let offered: Vec<_> = scene::ALL
            .iter()
            .filter(|entry| is_offered(entry))
            .collect();
        if asked.is_empty() {
            return Ok(offered);
        }
        let find = |name: &String| {
            let found = offered.iter().find(|entry| entry.name == name);
            found.copied().ok_or_else(|| {
                let known: Vec<_> = offered.iter().map(|entry| entry.name).collect();
                BenchError::UnknownScene {
                    name: name.clone(),
                    known: known.join(", "),
                }
            })
        };
        asked.iter().map(find).collect()
    }

    /// The scenes that the language of `--shaders` can draw, and the names of the others.
    fn in_language(
        &self,
        mut scenes: Vec<&'static SceneEntry>,
    ) -> (Vec<&'static SceneEntry>, Vec<&'static str>) {
        let is_drawn =
            |entry: &&SceneEntry| self.shaders != ShaderLanguage::Rust || !entry.is_wgsl_only;
        let others = scenes.iter().filter(|entry| !is_drawn(entry));
        let others = others.map(|entry| entry.name).collect();
        scenes.retain(is_drawn);
        (scenes, others)
    }
}

/// Executes the command line; tables are written to `out`.
///
/// # Errors
/// [`BenchError`]: wrong usage, or a file that cannot be read or written.
pub fn run(arguments: &Arguments, out: &mut impl Write) -> Result<Outcome, BenchError> {
    let scenes = arguments.scenes()?;
    match &arguments.task {
        Some(Task::Compare(compare)) => {
            return versus::run(compare, &scenes, out).map(Outcome::of);
        }
        Some(Task::States(states)) => {
            states::run(states, out)?;
            return Ok(Outcome::Agreement);
        }
        Some(Task::Operations(operations)) => {
            operations::run(operations, out)?;
            return Ok(Outcome::Agreement);
        }
        Some(Task::Models { folder }) => {
            write_models(folder).map_err(|source| BenchError::File {
                path: folder.clone(),
                source,
            })?;
            return Ok(Outcome::Agreement);
        }
        None => {}
    }
    if let Some(folder) = &arguments.growth {
        let section = growth::run(folder, Level::named(&arguments.simd)?)?;
        print(out, &section)?;
        return Ok(Outcome::Agreement);
    }
    let device = Device::new(&DeviceDescriptor {
        threads: arguments.threads,
        level: Level::named(&arguments.simd)?,
        ..DeviceDescriptor::default()
    })?;
    if arguments.stages {
        return run_stages(&device, arguments.effort(), out);
    }
    if let Some(folder) = &arguments.images {
        std::fs::create_dir_all(folder).map_err(|source| BenchError::File {
            path: folder.clone(),
            source,
        })?;
    }

    let (scenes, without_rust) = arguments.in_language(scenes);
    if !without_rust.is_empty() {
        let error = BenchError::WgslOnly {
            scenes: without_rust.join(", "),
        };
        if !arguments.scenes.is_empty() {
            return Err(error);
        }
        print(out, &format!("not drawn: {error}"))?;
    }
    let mut report = Report::new(arguments.label.clone(), &device);
    print(out, &report.driver)?;
    print(out, &report::header())?;
    let mut comparisons = Vec::new();
    for entry in scenes {
        for &size in &arguments.sizes {
            let scene = entry
                .make(Detail::Full, size)
                .in_language(arguments.shaders);
            let (mut row, picture) = run_scene(&device, &scene, size, arguments.effort())?;
            print(out, &row.line())?;
            let file_name = format!("{}_{size}.png", scene.name);
            if let Some(folder) = &arguments.images {
                picture.write_png(&folder.join(&file_name))?;
            }
            if let Some(folder) = &arguments.compare {
                let difference = compare(&picture, &folder.join(&file_name))?;
                row.beyond = Some(difference.share_beyond());
                comparisons.push((file_name, difference));
            }
            report.rows.push(row);
        }
    }
    for (name, difference) in &comparisons {
        print(out, &report::comparison(name, difference))?;
    }
    if let Some(path) = &arguments.json {
        std::fs::write(path, report.to_json()).map_err(|source| BenchError::File {
            path: path.clone(),
            source,
        })?;
    }
    let all_agree = comparisons
        .iter()
        .all(|(_, difference)| difference.passes());
    Ok(Outcome::of(all_agree))
}

fn run_scene(
    device: &Device,
    scene: &Scene,
    size: FrameSize,
    effort: Effort,
) -> Result<(Row, Picture), BenchError> {
    let start = Instant::now();
    let mut prepared = PreparedScene::new(device, scene, size)?;
    let setup_ms = start.elapsed().as_secs_f64() * 1e3;
    let timing = measure(&mut prepared, effort);
    let picture = Picture {
        size,
        rgba: prepared.read_color(),
    };
    Ok((Row::new(scene, size, setup_ms, timing), picture))
}

fn compare(ours: &Picture, path: &Path) -> Result<Difference, BenchError> {
    let theirs = Picture::read_png(path)?;
    Difference::between(ours, &theirs).ok_or_else(|| BenchError::Picture {
        path: path.to_owned(),
        reason: format!("has {} pixels, not {}", theirs.size, ours.size),
    })
}

fn run_stages(
    device: &Device,
    effort: Effort,
    out: &mut impl Write,
) -> Result<Outcome, BenchError> {
    print(out, &Report::new(String::new(), device).driver)?;
    print(out, stages::HEADER)?;
    for load in stages::loads() {
        let timing = load.measure(device, effort)?;
        print(out, &stages::line(load.purpose, &timing))?;
    }
    print(out, conversions::HEADER)?;
    for conversion in conversions::all() {
        let timing = conversion.measure(device, effort)?;
        print(out, &conversion.line(&timing))?;
    }
    Ok(Outcome::Agreement)
}

fn print(out: &mut impl Write, line: &str) -> Result<(), BenchError> {
    writeln!(out, "{line}").map_err(|source| BenchError::File {
        path: "standard output".into(),
        source,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(line: &str) -> Arguments {
        Arguments::try_parse_from(line.split(' ')).unwrap()
    }

    #[test]
    fn lists_are_separated_by_commas() {
        let arguments = parsed("bench --scenes fill,blend --sizes 64x48,1280x720 --threads 2");
        let names: Vec<_> = arguments
            .scenes()
            .unwrap()
            .iter()
            .map(|entry| entry.name)
            .collect();
        assert_eq!(names, ["fill", "blend"]);
        assert_eq!(arguments.sizes.len(), 2);
        assert_eq!(parsed("bench").scenes().unwrap().len(), scene::ALL.len());
    }

    #[test]
    fn a_wrong_name_is_wrong_usage() {
        for line in [
            "bench --scenes fill,teapot",
            "bench --simd mmx",
            "bench compare --quick --scenes teapot",
            "bench compare --quick --scenes quad_draws",
            "bench states --states teapot",
        ] {
            let error = run(&parsed(line), &mut Vec::new()).unwrap_err();
            assert!(error.is_usage(), "{error}");
        }
        assert!(Arguments::try_parse_from(["bench", "--sizes", "12"]).is_err());
    }

    #[test]
    fn a_run_writes_its_picture_and_agrees_with_itself() {
        let folder = std::env::temp_dir().join(format!("estampe-bench-run-{}", std::process::id()));
        let line = format!(
            "bench --scenes clear,fill --sizes 40x30 --threads 1 --frames 1 --seconds 0 --retries 0 \
             --images {0} --json {0}/out.json",
            folder.display()
        );
        run(&parsed(&line), &mut Vec::new()).unwrap();
        let mut table = Vec::new();
        let line = format!("{line} --compare {}", folder.display());
        assert_eq!(run(&parsed(&line), &mut table).unwrap(), Outcome::Agreement);
        assert_eq!(String::from_utf8(table).unwrap().lines().count(), 6);

        let json = std::fs::read_to_string(folder.join("out.json")).unwrap();
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        assert_eq!(json["results"][1]["beyond"], 0.0);

        // The picture of another scene is a difference.
        std::fs::copy(
            folder.join("clear_40x30.png"),
            folder.join("fill_40x30.png"),
        )
        .unwrap();
        let line = line.replace(&format!("--images {}", folder.display()), "");
        let line = line.split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(
            run(&parsed(&line), &mut Vec::new()).unwrap(),
            Outcome::Difference
        );
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
