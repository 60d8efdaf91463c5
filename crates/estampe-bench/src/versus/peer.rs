//! Runs of estampe and of `peerbench` on lavapipe, on the same cores.

use super::limits::Limits;
use super::results::RunResults;
use crate::BenchError;
use crate::frame::FrameSize;
use crate::process::run;
use crate::provenance::repository;
use crate::scene::ShaderLanguage;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The folder in which Vulkan's loader looks for drivers.
const DRIVERS: &str = "/usr/share/vulkan/icd.d";

/// The length of each run. A run that other processes disturb is not repeated: the fastest frame of
/// several rounds counts.
#[derive(Debug, Clone, Copy)]
pub struct Effort {
    frames: u32,
    seconds: f64,
}

impl Effort {
    /// For published tables.
    pub const THOROUGH: Self = Self {
        frames: 4,
        seconds: 0.2,
    };
    /// For a quick look.
    pub const QUICK: Self = Self {
        frames: 3,
        seconds: 0.1,
    };
}

/// The paths that a comparison needs.
#[derive(Debug)]
pub struct Session {
    peerbench: PathBuf,
    /// Lavapipe's driver file.
    lavapipe: PathBuf,
    /// The folder of results and pictures.
    folder: PathBuf,
}

impl Session {
    /// Finds the requirements, and builds `peerbench` if no build is given.
    ///
    /// # Errors
    /// [`BenchError::Missing`] with the package to install.
    pub fn new(peerbench: Option<&Path>) -> Result<Self, BenchError> {
        let root = repository();
        let missing = |what: String, remedy: &str| BenchError::Missing {
            what,
            remedy: remedy.to_owned(),
        };
        let lavapipe = lavapipe_driver(Path::new(DRIVERS)).ok_or_else(|| {
            missing(
                format!("no driver lvp_icd.*.json in {DRIVERS}"),
                "install Debian's mesa-vulkan-drivers and libvulkan1",
            )
        })?;
        if run(Command::new("taskset").arg("--version")).is_err() {
            let remedy = "it pins a run to its cores: install Debian's util-linux";
            return Err(missing("no command taskset".to_owned(), remedy));
        }
        let folder = root.join("target/compare");
        create_folder(&folder)?;
        let peerbench = match peerbench {
            Some(path) if path.is_file() => path.to_owned(),
            Some(path) => {
                let what = format!("no program {}", path.display());
                return Err(missing(what, "leave --peerbench out to have it built"));
            }
            None => build_peerbench(&root)?,
        };
        Ok(Self {
            peerbench,
            lavapipe,
            folder,
        })
    }

    /// Draws a scene with estampe, its shaders in a language.
    ///
    /// # Errors
    /// If the run fails.
    pub fn run_ours(
        &self,
        (scene, language): (&str, ShaderLanguage),
        sizes: &[FrameSize],
        cores: usize,
        effort: Effort,
    ) -> Result<RunResults, BenchError> {
        let program = std::env::current_exe().map_err(|error| BenchError::Command {
            command: "estampe-bench".to_owned(),
            reason: error.to_string(),
        })?;
        let json = self.folder.join("estampe.json");
        let mut command = pinned(&program, cores, scene, sizes, effort);
        command.args(["--threads", &cores.to_string()]);
        command.args(["--shaders", language.name()]);
        command.arg("--json").arg(&json);
        command
            .arg("--images")
            .arg(self.folder.join(language.name()));
        run(&mut command)?;
        RunResults::read(&json)
    }

    /// Draws a scene with lavapipe.
    ///
    /// # Errors
    /// If the run fails.
    pub fn run_peer(
        &self,
        scene: &str,
        sizes: &[FrameSize],
        cores: usize,
        effort: Effort,
    ) -> Result<RunResults, BenchError> {
        let mut command = pinned(&self.peerbench, cores, scene, sizes, effort);
        command.arg("--out").arg(&self.folder);
        command.args(["--label", "lavapipe"]);
        command.env("VK_DRIVER_FILES", &self.lavapipe);
        command.env("VK_ICD_FILENAMES", &self.lavapipe);
        command.env("LP_NUM_THREADS", cores.to_string());
        // No shader cache, so first frames include compilation, and no layers.
        command.env("MESA_SHADER_CACHE_DISABLE", "true");
        command.env("NODEVICE_SELECT", "1");
        command.env("XDG_RUNTIME_DIR", &self.folder);
        run(&mut command)?;
        RunResults::read(&self.folder.join("lavapipe.json"))
    }

    /// The path of estampe's picture of a scene in a language.
    #[must_use]
    pub fn our_picture(&self, scene: &str, language: ShaderLanguage, size: FrameSize) -> PathBuf {
        self.picture(language.name(), scene, size)
    }

    /// The path of lavapipe's picture of a scene.
    #[must_use]
    pub fn peer_picture(&self, scene: &str, size: FrameSize) -> PathBuf {
        self.picture("lavapipe", scene, size)
    }

    fn picture(&self, who: &str, scene: &str, size: FrameSize) -> PathBuf {
        self.folder.join(who).join(format!("{scene}_{size}.png"))
    }

    /// Measures the limits of the machine.
    ///
    /// # Errors
    /// If the run fails.
    pub fn limits(&self) -> Result<Limits, BenchError> {
        let json = self.folder.join("limits.json");
        let program = self.peerbench.with_file_name("limits");
        run(Command::new(program).arg("--out").arg(&json))?;
        Limits::read(&json)
    }
}

/// The first lavapipe driver file in a folder.
fn lavapipe_driver(folder: &Path) -> Option<PathBuf> {
    let files = std::fs::read_dir(folder).ok()?.flatten();
    let mut drivers: Vec<PathBuf> = files
        .filter(|file| file.file_name().to_string_lossy().starts_with("lvp_icd."))
        .map(|file| file.path())
        .collect();
    drivers.sort();
    drivers.into_iter().next()
}

/// Builds `peerbench` from a copy of its sources, which are read-only; cargo writes a lock file.
fn build_peerbench(root: &Path) -> Result<PathBuf, BenchError> {
    let sources = root.join("../shared/peerbench");
    if !sources.join("Cargo.toml").is_file() {
        return Err(BenchError::Missing {
            what: format!("no sources in {}", sources.display()),
            remedy: "put peerbench there, or name a built one with --peerbench".to_owned(),
        });
    }
    let (copy, target) = (
        root.join("target/peerbench/source"),
        root.join("target/peerbench"),
    );
    copy_folder(&sources, &copy)?;
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.args(["build", "--release"]).current_dir(&copy);
    cargo.env(
        "CARGO_TARGET_DIR",
        target.canonicalize().unwrap_or(target.clone()),
    );
    cargo.stderr(Stdio::inherit());
    run(&mut cargo)?;
    Ok(target.join("release/peerbench"))
}

fn copy_folder(from: &Path, to: &Path) -> Result<(), BenchError> {
    create_folder(to)?;
    let fault = |path: &Path| {
        let path = path.to_owned();
        move |source| BenchError::File { path, source }
    };
    for entry in std::fs::read_dir(from).map_err(fault(from))?.flatten() {
        let (path, name) = (entry.path(), entry.file_name());
        if path.is_dir() {
            copy_folder(&path, &to.join(name))?;
        } else {
            // Not `copy`, which would keep the sources' write protection.
            let bytes = std::fs::read(&path).map_err(fault(&path))?;
            std::fs::write(to.join(name), bytes).map_err(fault(to))?;
        }
    }
    Ok(())
}

fn create_folder(path: &Path) -> Result<(), BenchError> {
    std::fs::create_dir_all(path).map_err(|source| BenchError::File {
        path: path.to_owned(),
        source,
    })
}

/// A program pinned to the first cores, with the options that both programs understand.
fn pinned(
    program: &Path,
    cores: usize,
    scene: &str,
    sizes: &[FrameSize],
    effort: Effort,
) -> Command {
    let mut command = Command::new("taskset");
    command.arg("-c").arg(format!("0-{}", cores.max(1) - 1));
    command.arg(program);
    let sizes: Vec<String> = sizes.iter().map(ToString::to_string).collect();
    command.args(["--scenes", scene, "--sizes", &sizes.join(",")]);
    command.args(["--frames", &effort.frames.to_string()]);
    command.args(["--seconds", &effort.seconds.to_string()]);
    command.args(["--retries", "0"]);
    command
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ffi::OsStr;

    #[test]
    fn a_missing_client_is_an_error() {
        let error = Session::new(Some(Path::new("/no/peerbench"))).unwrap_err();
        assert!(matches!(error, BenchError::Missing { .. }), "{error}");
    }

    #[test]
    fn lavapipe_is_found_by_name() {
        let folder = std::env::temp_dir().join(format!("estampe-icd-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        assert_eq!(lavapipe_driver(&folder), None);
        for name in ["lvp_icd.x86_64.json", "intel_icd.x86_64.json"] {
            std::fs::write(folder.join(name), "{}").unwrap();
        }
        assert_eq!(
            lavapipe_driver(&folder),
            Some(folder.join("lvp_icd.x86_64.json"))
        );
        std::fs::remove_dir_all(&folder).unwrap();
        assert_eq!(lavapipe_driver(&folder), None);
    }

    #[test]
    fn both_run_on_the_same_cores() {
        let size = FrameSize {
            width: 64,
            height: 48,
        };
        let command = pinned(Path::new("p"), 2, "fill", &[size, size], Effort::QUICK);
        let arguments: Vec<_> = command.get_args().map(OsStr::to_string_lossy).collect();
        let expected =
            "-c 0-1 p --scenes fill --sizes 64x48,64x48 --frames 3 --seconds 0.1 --retries 0";
        assert_eq!(arguments.join(" "), expected);
    }
}
