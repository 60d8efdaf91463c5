//! Temporary files, removed if the process is interrupted.
//!
//! SIGINT and SIGTERM are handled by a thread, not in a signal handler, so it may lock and remove
//! files. It holds the lock until the process has ended: no temporary file is created after the
//! others are removed. Then the process ends by the same signal, as if it had not been handled.
//! SIGKILL cannot be handled; [`remove_abandoned`](crate::output::remove_abandoned) recognises the
//! files that it leaves by their names.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// The temporary files that exist.
static PARTS: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// A temporary file, which an interrupt removes.
#[derive(Debug)]
pub(crate) struct Part {
    path: PathBuf,
}

impl Part {
    /// Creates a temporary file with `create`.
    pub(crate) fn create(
        path: PathBuf,
        create: impl FnOnce(&Path) -> io::Result<File>,
    ) -> io::Result<(Self, File)> {
        handle_signals();
        let mut parts = PARTS.lock().unwrap_or_else(PoisonError::into_inner);
        let file = create(&path)?;
        parts.push(path.clone());
        Ok((Self { path }, file))
    }

    /// The file's path.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }
}

/// The file is no longer temporary: it was renamed or removed.
impl Drop for Part {
    fn drop(&mut self) {
        let mut parts = PARTS.lock().unwrap_or_else(PoisonError::into_inner);
        parts.retain(|part| *part != self.path);
    }
}

/// Removes the temporary files, then ends the process with `end`.
pub(crate) fn end_process(end: impl FnOnce()) {
    let parts = PARTS.lock().unwrap_or_else(PoisonError::into_inner);
    for part in parts.iter() {
        // The process ends: a file that cannot be removed stays.
        let _ = std::fs::remove_file(part);
    }
    end();
}

/// Starts the thread that handles signals, once.
#[cfg(unix)]
fn handle_signals() {
    use signal_hook::consts::{SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;
    use std::sync::Once;

    static START: Once = Once::new();
    START.call_once(|| {
        // Without the thread an interrupt leaves temporary files, which the next run recognises.
        let Ok(mut signals) = Signals::new([SIGINT, SIGTERM]) else {
            return;
        };
        let handle = signals.handle();
        let thread = std::thread::Builder::new().name("signals".to_owned());
        let started = thread.spawn(move || {
            let Some(signal) = signals.forever().next() else {
                return;
            };
            end_process(|| {
                let _ = emulate_default_handler(signal);
            });
        });
        if started.is_err() {
            handle.close();
        }
    });
}

/// Other systems end the process, and may leave a temporary file.
#[cfg(not(unix))]
fn handle_signals() {}
