//! A guard around naga, which recurses over what it parses and has assertions of its own.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::{ShaderError, ShaderErrors};

/// The stack of the thread that parses and checks, in bytes. naga's limits on nesting are made
/// for release builds and 8 MiB; unoptimised frames are several times as large. The system commits
/// only the pages that are touched.
const STACK_BYTES: usize = 64 << 20;

/// Runs `work` on a large stack, and turns a panic into an error.
pub(super) fn run<T: Send>(
    work: impl FnOnce() -> Result<T, ShaderErrors> + Send,
) -> Result<T, ShaderErrors> {
    let mut work = Some(work);
    let mut on_thread = || {
        let work = work.take().expect("run once");
        catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|_| Err(panicked()))
    };
    // Targets without threads run it on the stack that there is.
    if cfg!(target_family = "wasm") {
        return on_thread();
    }
    std::thread::scope(|scope| {
        std::thread::Builder::new()
            .name("shader".to_owned())
            .stack_size(STACK_BYTES)
            .spawn_scoped(scope, on_thread)
            .map_err(|_| no_thread())
            .and_then(|thread| thread.join().unwrap_or_else(|_| Err(panicked())))
    })
}

fn panicked() -> ShaderErrors {
    ShaderError::new("the shader compiler cannot handle this shader: an assertion of it failed")
        .help("this is an error of the compiler; please report the shader")
        .into()
}

fn no_thread() -> ShaderErrors {
    ShaderError::new("the system gave no thread to compile the shader on").into()
}
