//! Runs the command in a temporary folder that is removed afterwards.

pub(crate) mod page;
pub(crate) mod picture;
pub(crate) mod shell;

use estampe::Level;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};

/// An OBJ of a tetrahedron with uv.
pub(crate) const TETRAHEDRON: &str = "\
v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\n\
f 1/1 3/3 2/2\nf 1/1 2/2 4/3\nf 1/1 4/2 3/3\nf 2/1 3/2 4/3\n";

/// A folder for one test.
pub(crate) struct Folder(PathBuf);

impl Folder {
    pub(crate) fn new() -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = format!("estampe-command-test-{}-{number}", std::process::id());
        let path = std::env::temp_dir().join(name);
        std::fs::create_dir_all(&path).expect("the temporary folder is writable");
        Self(path)
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    pub(crate) fn with_file(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).expect("the temporary folder is writable");
        }
        std::fs::write(&path, bytes).expect("the temporary folder is writable");
        path
    }

    /// The names in the folder, sorted.
    pub(crate) fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(&self.0).expect("the folder is there");
        let mut names: Vec<String> = entries
            .map(|entry| {
                entry
                    .expect("readable")
                    .file_name()
                    .to_string_lossy()
                    .into_owned()
            })
            .collect();
        names.sort();
        names
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Result of a run of the command.
pub(crate) struct Run {
    pub(crate) code: i32,
    pub(crate) out: Vec<u8>,
    pub(crate) err: String,
}

impl From<Output> for Run {
    fn from(output: Output) -> Self {
        Self {
            code: output.status.code().expect("the command is not killed"),
            out: output.stdout,
            err: String::from_utf8_lossy(&output.stderr).into_owned(),
        }
    }
}

/// Options for every SIMD level that the command has, by 1, 2 and 7 threads in turn, and for 3
/// threads at the best level.
pub(crate) fn machines() -> Vec<String> {
    let levels = Level::all_available().into_iter();
    let of_levels = levels.zip([1, 2, 7].into_iter().cycle());
    let mut machines = vec!["--threads 3".to_owned()];
    machines.extend(of_levels.map(|(level, threads)| {
        let name = level.name();
        format!("--threads {threads} --simd {name}")
    }));
    machines
}

/// Runs the command with these words as its arguments; `{}` stands for the path.
pub(crate) fn estampe(words: &str, paths: &[&Path]) -> Run {
    estampe_fed(words, paths, &[])
}

/// Runs the command with these bytes on standard input.
pub(crate) fn estampe_fed(words: &str, paths: &[&Path], input: &[u8]) -> Run {
    let mut paths = paths.iter();
    let mut command = Command::new(env!("CARGO_BIN_EXE_estampe"));
    for word in words.split_whitespace() {
        match word {
            "{}" => command.arg(paths.next().expect("a path for each {}")),
            word => command.arg(word),
        };
    }
    let mut child = command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command starts");
    // A command that does not read its input closes the pipe, which is no error of the test.
    let _ = child.stdin.take().expect("piped").write_all(input);
    child.wait_with_output().expect("the command ends").into()
}

/// The subcommands that the help lists: of `command`, or of the program if it is empty.
pub(crate) fn subcommands(command: &str) -> Vec<String> {
    let help = String::from_utf8(estampe(&format!("{command} --help"), &[]).out).expect("UTF-8");
    let listed = help
        .lines()
        .skip_while(|line| *line != "Commands:")
        .skip(1)
        .take_while(|line| !line.is_empty())
        // A continued description is indented further.
        .filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    let names = listed.filter_map(|line| line.split_whitespace().next());
    let names: Vec<String> = names.map(str::to_owned).collect();
    names.into_iter().filter(|name| name != "help").collect()
}
