//! Costs of the jobs of a frame, and the frame time on a given number of cores that follows from
//! them.

use super::simulation::{WakeUp, makespan_ns};
use crate::BenchError;
use crate::frame::{FrameSize, PreparedScene};
use crate::scene::Scene;
use estampe::{Device, JobTimings, Level};
use std::time::{Duration, Instant};

/// The kind of the jobs of a phase.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum JobKind {
    /// Shading of runs of vertices.
    Vertices,
    /// Assembly, culling, set-up and binning of chunks of primitives.
    Chunks,
    /// Drawing of tiles.
    Tiles,
    /// All others: the data of draws, extremes of indices, resolving, depth min/max.
    Others,
}

impl JobKind {
    /// The kinds in the order of a frame.
    pub const ALL: [Self; 4] = [Self::Vertices, Self::Chunks, Self::Tiles, Self::Others];

    /// The kind that the job's Rust type in the core stands for.
    fn of(job_type: &str) -> Self {
        let name = job_type.split('<').next().unwrap_or_default();
        match name.rsplit("::").next().unwrap_or_default() {
            "VertexJobs" => Self::Vertices,
            "ChunkJob" => Self::Chunks,
            "TileJob" => Self::Tiles,
            _ => Self::Others,
        }
    }

    /// The name of the kind, in the plural.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Vertices => "runs of vertices",
            Self::Chunks => "chunks of primitives",
            Self::Tiles => "tiles",
            Self::Others => "other jobs",
        }
    }

    /// The name of a single job of the kind.
    #[must_use]
    pub fn name_of_one(self) -> &'static str {
        match self {
            Self::Vertices => "one run of vertices",
            Self::Chunks => "one chunk of primitives",
            Self::Tiles => "one tile",
            Self::Others => "one other job",
        }
    }
}

/// The costs of a phase: a list of independent jobs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PhaseCosts {
    /// The kind of its jobs.
    pub kind: JobKind,
    /// The time of each job on one core, in nanoseconds.
    pub jobs_ns: Vec<u64>,
}

/// The costs of the parts of a frame on one core.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FrameCosts {
    /// The parallel phases, in order.
    pub phases: Vec<PhaseCosts>,
    /// The time of the serial parts in nanoseconds: recording, and the parts between the phases.
    pub serial_ns: u64,
}

/// The parts of the frame time on a number of cores that are not parallel work, each as a share of
/// the time.
#[derive(Debug, Clone, PartialEq)]
pub struct Limits {
    /// The serial parts.
    pub serial: f64,
    /// Waking helpers.
    pub wake_up: f64,
    /// Idle time of cores that wait for the last job, by kind.
    pub waiting: Vec<(JobKind, f64)>,
}

/// The number of recorded frames. The least time of each job and of each serial part counts: what
/// the machine's other programs take is part of no frame, and a serial part is short enough to fall
/// into one of their turns whole.
const FRAMES: usize = 15;

/// A frame as it was recorded.
#[derive(Debug, Clone)]
struct RecordedFrame {
    phases: Vec<PhaseCosts>,
    /// The serial parts: before each phase, and after the last.
    serial_ns: Vec<u64>,
}

impl RecordedFrame {
    /// The frame between two times, given the timings of its phases.
    fn new([mut at, end]: [Instant; 2], timings: &[JobTimings]) -> Self {
        let (mut phases, mut serial_ns) = (Vec::new(), Vec::new());
        for phase in timings {
            serial_ns.push(nanoseconds(&phase.start.saturating_duration_since(at)));
            at = phase.start + phase.jobs.iter().sum::<Duration>();
            phases.push(PhaseCosts {
                kind: JobKind::of(phase.job_type),
                jobs_ns: phase.jobs.iter().map(nanoseconds).collect(),
            });
        }
        serial_ns.push(nanoseconds(&end.saturating_duration_since(at)));
        Self { phases, serial_ns }
    }
}

impl FrameCosts {
    /// Records a scene's frames on one thread, in the jobs of so many cores.
    ///
    /// # Errors
    /// [`BenchError`] if the device refuses the frame's size.
    pub fn record(
        (cores, level): (usize, Level),
        scene: &Scene,
        size: FrameSize,
    ) -> Result<Self, BenchError> {
        let device = Device::profiling(cores, level);
        let mut prepared = PreparedScene::new(&device, scene, size)?;
        prepared.draw();
        prepared.draw();
        drop(device.take_timings());
        let frames: Vec<RecordedFrame> = (0..FRAMES)
            .map(|_| {
                let start = Instant::now();
                prepared.draw();
                RecordedFrame::new([start, Instant::now()], &device.take_timings())
            })
            .collect();
        Ok(Self::least_of(&frames))
    }

    /// The least time of each job and of each serial part over frames with equal jobs.
    fn least_of(frames: &[RecordedFrame]) -> Self {
        let Some(first) = frames.first() else {
            return Self {
                phases: Vec::new(),
                serial_ns: 0,
            };
        };
        let mut costs = first.clone();
        for (number, phase) in costs.phases.iter_mut().enumerate() {
            for (job, cost_ns) in phase.jobs_ns.iter_mut().enumerate() {
                let of_frame =
                    |frame: &RecordedFrame| frame.phases.get(number)?.jobs_ns.get(job).copied();
                *cost_ns = frames.iter().filter_map(of_frame).min().unwrap_or(*cost_ns);
            }
        }
        for (number, cost_ns) in costs.serial_ns.iter_mut().enumerate() {
            let of_frame = |frame: &RecordedFrame| frame.serial_ns.get(number).copied();
            *cost_ns = frames.iter().filter_map(of_frame).min().unwrap_or(*cost_ns);
        }
        Self {
            phases: costs.phases,
            serial_ns: costs.serial_ns.iter().sum(),
        }
    }

    /// The frame time on this many cores, in nanoseconds.
    #[must_use]
    pub fn on_cores_ns(&self, cores: usize, wake_up: WakeUp) -> u64 {
        let phases = self.phases.iter();
        let shared = phases.map(|phase| makespan_ns(&phase.jobs_ns, cores, wake_up));
        self.serial_ns + shared.sum::<u64>()
    }

    /// The ratio of the frame times on one core and on this many, of the same jobs: the machine's
    /// speed while they were recorded does not count.
    #[must_use]
    pub fn speed_up(&self, cores: usize, wake_up: WakeUp) -> f64 {
        let alone = self.on_cores_ns(1, wake_up) as f64;
        alone / self.on_cores_ns(cores, wake_up).max(1) as f64
    }

    /// The parts of the frame time on this many cores that are not parallel work.
    #[must_use]
    pub fn limits(&self, cores: usize, wake_up: WakeUp) -> Limits {
        let total = self.on_cores_ns(cores, wake_up).max(1) as f64;
        let free = self.on_cores_ns(cores, WakeUp::default());
        let waiting = JobKind::ALL.map(|kind| {
            let phases = self.phases.iter().filter(|phase| phase.kind == kind);
            let waits = phases.map(|phase| {
                let shared = phase.jobs_ns.iter().sum::<u64>() as f64 / cores as f64;
                makespan_ns(&phase.jobs_ns, cores, WakeUp::default()) as f64 - shared
            });
            (kind, waits.sum::<f64>() / total)
        });
        Limits {
            serial: self.serial_ns as f64 / total,
            wake_up: (total - free as f64) / total,
            waiting: waiting.to_vec(),
        }
    }

    /// The number of jobs of a kind, and the largest job's share of their total cost.
    #[must_use]
    pub fn largest(&self, kind: JobKind) -> (usize, f64) {
        let phases = self.phases.iter().filter(|phase| phase.kind == kind);
        let jobs: Vec<u64> = phases.flat_map(|phase| phase.jobs_ns.clone()).collect();
        let largest = jobs.iter().max().copied().unwrap_or_default();
        let all = jobs.iter().sum::<u64>().max(1);
        (jobs.len(), largest as f64 / all as f64)
    }
}

/// The costs of a frame in the jobs of one core, and in those of more.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CostsByCores {
    /// In the jobs of one core.
    pub alone: FrameCosts,
    /// Numbers of cores, with the costs in their jobs. Groups of geometry grow with the cores.
    pub of_cores: Vec<(usize, FrameCosts)>,
}

impl CostsByCores {
    /// Records a scene's frames for one core and for these numbers of cores.
    ///
    /// # Errors
    /// As [`FrameCosts::record`].
    pub fn record(
        level: Level,
        scene: &Scene,
        size: FrameSize,
        cores: &[usize],
    ) -> Result<Self, BenchError> {
        let of = |&cores: &usize| {
            let costs = FrameCosts::record((cores, level), scene, size)?;
            Ok((cores, costs))
        };
        Ok(Self {
            alone: FrameCosts::record((1, level), scene, size)?,
            of_cores: cores.iter().map(of).collect::<Result<_, BenchError>>()?,
        })
    }
}

impl WakeUp {
    /// Measures the time to wake a sleeping thread on this machine: the median of many calls.
    #[must_use]
    pub fn measure() -> Self {
        const CALLS: usize = 201;
        let (to_helper, calls) = std::sync::mpsc::sync_channel::<Instant>(1);
        let (from_helper, answers) = std::sync::mpsc::sync_channel::<Duration>(1);
        let helper = std::thread::spawn(move || {
            // Ends when the caller has dropped its sender.
            while let Ok(called) = calls.recv() {
                if from_helper.send(called.elapsed()).is_err() {
                    break;
                }
            }
        });
        let (mut call, mut arrival) = (Vec::new(), Vec::new());
        for _ in 0..CALLS {
            // Long enough for the helper to fall asleep.
            std::thread::sleep(Duration::from_micros(200));
            let start = Instant::now();
            if to_helper.send(start).is_err() {
                break;
            }
            call.push(nanoseconds(&start.elapsed()));
            if let Ok(after) = answers.recv() {
                arrival.push(nanoseconds(&after));
            }
        }
        drop(to_helper);
        // The thread has no result, and its panic was printed already.
        let _ = helper.join();
        Self {
            call_ns: median(call),
            arrival_ns: median(arrival),
        }
    }
}

fn nanoseconds(time: &Duration) -> u64 {
    u64::try_from(time.as_nanos()).unwrap_or(u64::MAX)
}

/// The upper median; 0 if there are no values.
fn median(mut values: Vec<u64>) -> u64 {
    values.sort_unstable();
    values.get(values.len() / 2).copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Detail, SceneEntry};

    const FREE: WakeUp = WakeUp {
        call_ns: 0,
        arrival_ns: 0,
    };

    fn costs(serial_ns: u64, phases: &[(JobKind, Vec<u64>)]) -> FrameCosts {
        let phase = |(kind, jobs_ns): &(JobKind, Vec<u64>)| PhaseCosts {
            kind: *kind,
            jobs_ns: jobs_ns.clone(),
        };
        FrameCosts {
            phases: phases.iter().map(phase).collect(),
            serial_ns,
        }
    }

    #[test]
    fn amdahls_law_holds() {
        let frame = costs(100, &[(JobKind::Tiles, vec![1; 900])]);
        assert!((frame.speed_up(9, FREE) - 5.0).abs() < 1e-9);
        let limits = frame.limits(9, FREE);
        assert!((limits.serial - 0.5).abs() < 1e-9);
        assert!(limits.waiting.iter().all(|(_, share)| share.abs() < 1e-9));
    }

    #[test]
    fn the_least_time_of_each_part_counts() {
        let begin = Instant::now();
        let after = |ns| begin + Duration::from_nanos(ns);
        let record = |from: u64, jobs: &[u64], to: u64| {
            let timings = JobTimings {
                job_type: "core::TileJob<'_>",
                start: after(from),
                jobs: jobs.iter().copied().map(Duration::from_nanos).collect(),
            };
            RecordedFrame::new([begin, after(to)], &[timings])
        };
        // Serial parts of 30 and 5, 20 and 9, 25 and 4.
        let frames = [
            record(30, &[5, 10, 8], 58),
            record(20, &[6, 9, 7], 51),
            record(25, &[7, 12, 9], 57),
        ];
        let least = costs(20 + 4, &[(JobKind::Tiles, vec![5, 9, 7])]);
        assert_eq!(FrameCosts::least_of(&frames), least);
    }

    #[test]
    fn a_large_tile_is_waited_for() {
        let frame = costs(0, &[(JobKind::Tiles, vec![100, 10, 10, 10, 10])]);
        let limits = frame.limits(5, FREE);
        assert_eq!(frame.on_cores_ns(5, FREE), 100);
        // 140 ns of work on 5 cores are 28 ns of these 100.
        assert!((limits.waiting[2].1 - 0.72).abs() < 1e-9, "{limits:?}");
        assert_eq!(frame.largest(JobKind::Tiles), (5, 100.0 / 140.0));
    }

    #[test]
    fn a_recorded_frame_has_the_pipelines_phases() {
        let size = FrameSize {
            width: 200,
            height: 100,
        };
        let scene = SceneEntry::named("small_tris").unwrap();
        let scene = scene.make(Detail::Reduced, size);
        let record = |threads| FrameCosts::record((threads, Level::default()), &scene, size);
        let frame = record(64).unwrap();
        let kinds = frame.phases.iter().map(|phase| phase.kind);
        // Its one draw is checked and becomes plain data before, and is let go of afterwards.
        let (others, drawing): (Vec<_>, Vec<_>) = kinds.partition(|kind| *kind == JobKind::Others);
        assert_eq!(others.len(), 4);
        assert_eq!(
            drawing,
            [JobKind::Vertices, JobKind::Chunks, JobKind::Tiles]
        );
        // Tiles of 64×64 pixels are too few for as many threads.
        assert_eq!(frame.largest(JobKind::Tiles).0, 4 * 2 * 4);
        assert!(frame.serial_ns > 0);
        assert_eq!(record(4).unwrap().largest(JobKind::Tiles).0, 4 * 2);
    }

    #[test]
    fn waking_a_thread_takes_time() {
        let wake_up = WakeUp::measure();
        assert!(wake_up.call_ns > 0 && wake_up.arrival_ns > 0);
    }
}
