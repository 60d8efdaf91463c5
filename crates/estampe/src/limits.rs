//! The limits of a model, and what happens beyond them.

use crate::failure::Failure;
use crate::input::Model;
use crate::interrupt;
use crate::render::PictureArgs;
use crate::terminal;
use clap::Args;
use estampe_assets::Limits;
use std::io::Write;
use std::time::{Duration, Instant};

/// Limits of one model.
#[derive(Debug, Clone, Args)]
pub(crate) struct LimitArgs {
    /// A model with more triangles is not drawn
    #[arg(long, value_name = "N", default_value_t = 100_000_000)]
    #[arg(help_heading = "Limits")]
    max_triangles: u64,

    /// A model with textures of more pixels in all is not drawn
    #[arg(long, value_name = "N", default_value_t = 536_870_912)]
    #[arg(help_heading = "Limits")]
    max_pixels: u64,

    /// Textures with more texels on a side, 1 to 16384, are halved until they fit
    #[arg(
        long,
        value_name = "N",
        default_value_t = 16_384,
        help_heading = "Limits"
    )]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=16_384))]
    max_texture_size: u32,

    /// A model whose file, or a file that it names, has more bytes is not drawn
    #[arg(long, value_name = "N", default_value_t = 1 << 30, help_heading = "Limits")]
    max_bytes: u64,

    /// A model that needs more bytes, by an estimate of scene, textures and picture, is not drawn
    #[arg(long, value_name = "BYTES", help_heading = "Limits")]
    max_memory: Option<u64>,

    /// A model that is not read and drawn after this time is given up [default: none]
    #[arg(long, value_name = "SECONDS", value_parser = seconds, help_heading = "Limits")]
    pub(crate) timeout: Option<Duration>,
}

/// A time above 0.
fn seconds(text: &str) -> Result<Duration, String> {
    let time = text.trim().parse().ok();
    let time = time.and_then(|time| Duration::try_from_secs_f64(time).ok());
    time.filter(|time| !time.is_zero())
        .ok_or_else(|| "write seconds above 0, as in 30 or 0.5".to_owned())
}

impl LimitArgs {
    /// The limits of the reader.
    pub(crate) fn of_reader(&self, threads: usize) -> Limits {
        // The least bytes of a pixel, and of a triangle.
        let memory = self.max_memory.unwrap_or(u64::MAX);
        let (pixels, triangles) = (memory / 4, memory / 12);
        let default = Limits::default();
        Limits {
            max_triangles: self.max_triangles.min(triangles),
            max_vertices: default.max_vertices.min(memory / 12),
            max_total_image_pixels: self.max_pixels.min(pixels),
            max_image_pixels: default.max_image_pixels.min(self.max_pixels).min(pixels),
            max_file_bytes: self.max_bytes.min(memory),
            max_texture_side: self.max_texture_size,
            threads,
            ..default
        }
    }

    /// Refuses a model that needs more memory than the limit, before it is drawn as codes, or as
    /// light.
    pub(crate) fn check_memory(
        &self,
        model: &Model,
        picture: &PictureArgs,
        holds_light: bool,
    ) -> Result<(), Failure> {
        let Some(limit) = self.max_memory else {
            return Ok(());
        };
        let meshes = model.scene.meshes.iter().map(|mesh| {
            let corners = 3 * mesh.triangles.len() + 2 * mesh.lines.len() + mesh.points.len();
            12 * (mesh.positions.len() + mesh.normals.len())
                + 8 * mesh.uvs.len()
                + 16 * mesh.colors.len()
                + 4 * corners
        });
        let images = model.scene.images.iter().map(|image| image.rgba.len());
        let scene = meshes.chain(images).sum::<usize>() as u64;
        // A model that is cut is a copy.
        let copies = if picture.section.is_cut() { 2 } else { 1 };
        let mut needed = scene.saturating_mul(copies);
        needed = needed.saturating_add(picture.bytes(holds_light));
        let materials = model.scene.materials.iter();
        let mut descriptions = materials.filter_map(|material| material.pbr.as_ref());
        if descriptions.any(|pbr| pbr.transmission.is_some()) {
            // The picture of what is behind surfaces is one more.
            needed = needed.saturating_add(picture.bytes_behind());
        }
        if needed <= limit {
            return Ok(());
        }
        Err(Failure::Limit(format!(
            "{}: it needs about {needed} bytes, more than the limit of {limit}; raise --max-memory, or \
             choose a smaller --size",
            model.name
        )))
    }

    /// Ends the process with exit code 1 if it runs for longer than the limit.
    pub(crate) fn watch(&self, command: &'static str, name: &str) -> Clock {
        let start = Instant::now();
        let Some(timeout) = self.timeout else {
            return Clock { start, late: None };
        };
        let message = timeout_message(name, timeout);
        let late = start.checked_add(timeout);
        let late = late.map(|late| (late, message.clone()));
        let watcher = std::thread::Builder::new().name("timeout".to_owned());
        // Without the thread the command takes the time that it takes, and is late at its end.
        let _ = watcher.spawn(move || {
            std::thread::sleep(timeout);
            let message = terminal::lines(&message).into_owned();
            interrupt::end_process(|| {
                let _ = writeln!(std::io::stderr(), "estampe {command}: {message}");
                std::process::exit(i32::from(Failure::Limit(message).exit_code()));
            });
        });
        Clock { start, late }
    }
}

/// When a command began, and when it is late.
#[derive(Debug)]
pub(crate) struct Clock {
    start: Instant,
    late: Option<(Instant, String)>,
}

impl Clock {
    /// The clock of a command without a limit, which begins.
    pub(crate) fn unlimited() -> Self {
        Self {
            start: Instant::now(),
            late: None,
        }
    }

    /// The time since the command began.
    pub(crate) fn elapsed(&self) -> Duration {
        self.start.elapsed()
    }

    /// Refuses to go on with a command that is late, whose watcher may not have been woken yet.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        match &self.late {
            Some((late, message)) if Instant::now() >= *late => {
                Err(Failure::Limit(message.clone()))
            }
            _ => Ok(()),
        }
    }
}

/// The error of a model that is given up.
pub(crate) fn timeout_message(name: &str, timeout: Duration) -> String {
    format!(
        "{name}: not drawn within the limit of {} s; raise --timeout, or simplify the model",
        timeout.as_secs_f64()
    )
}
