//! Memory that holds machine code: written first, then executable, never both.
//!
//! This module has `unsafe` code: it maps pages, fills them, and unmaps them.

use crate::CompileError;

/// Pages with machine code, which are executable and not writable.
#[derive(Debug)]
pub(crate) struct Executable {
    pages: std::ptr::NonNull<u8>,
    len: usize,
}

// SAFETY: nothing writes to the pages after `new`, so threads may share them and read, that is
// execute, them at once; unmapping needs ownership, and no thread in particular.
unsafe impl Send for Executable {}

// SAFETY: as for `Send`.
unsafe impl Sync for Executable {}

impl Executable {
    /// Copies machine code to new pages and makes them executable.
    ///
    /// # Errors
    /// [`CompileError::NoMemory`] if the system gives no memory, or none that may be executed.
    #[cfg(all(unix, target_pointer_width = "64"))]
    pub(crate) fn new(bytes: &[u8]) -> Result<Self, CompileError> {
        use rustix::mm::{MapFlags, MprotectFlags, ProtFlags};
        let len = bytes.len().max(1);
        // SAFETY: without an address the system chooses one where nothing is mapped.
        let mapped = unsafe {
            rustix::mm::mmap_anonymous(
                std::ptr::null_mut(),
                len,
                ProtFlags::READ | ProtFlags::WRITE,
                MapFlags::PRIVATE,
            )
        };
        let mapped = mapped.map_err(|error| refused(&error))?;
        let pages = std::ptr::NonNull::new(mapped.cast::<u8>());
        let pages = pages.ok_or_else(|| CompileError::NoMemory("it has no address".to_owned()))?;
        // From here on, dropping unmaps the pages.
        let executable = Self { pages, len };
        // SAFETY: the pages were just mapped, are writable, and have at least as many bytes;
        // nothing else points to them.
        unsafe { std::ptr::copy_nonoverlapping(bytes.as_ptr(), pages.as_ptr(), bytes.len()) };
        // SAFETY: the pages are this mapping's, and nothing writes to them any more.
        let protected = unsafe {
            rustix::mm::mprotect(
                pages.as_ptr().cast(),
                len,
                MprotectFlags::READ | MprotectFlags::EXEC,
            )
        };
        protected.map_err(|error| refused(&error))?;
        Ok(executable)
    }

    /// Other systems: not yet.
    ///
    /// # Errors
    /// Always.
    #[cfg(not(all(unix, target_pointer_width = "64")))]
    pub(crate) fn new(_: &[u8]) -> Result<Self, CompileError> {
        let why = "this system's functions for it are not called yet";
        Err(CompileError::NoMemory(why.to_owned()))
    }

    /// Where the code begins.
    pub(crate) fn start(&self) -> *const u8 {
        self.pages.as_ptr()
    }

    /// The bytes of the pages.
    pub(crate) fn bytes(&self) -> &[u8] {
        // SAFETY: the pages have `len` bytes that were written or are zero, stay mapped and
        // unchanged as long as `self` lives.
        unsafe { std::slice::from_raw_parts(self.pages.as_ptr(), self.len) }
    }
}

#[cfg(all(unix, target_pointer_width = "64"))]
fn refused(error: &rustix::io::Errno) -> CompileError {
    CompileError::NoMemory(error.to_string())
}

impl Drop for Executable {
    #[cfg(all(unix, target_pointer_width = "64"))]
    fn drop(&mut self) {
        // SAFETY: the pages were mapped by `new` with this length; whoever drops `self` is its only
        // owner, so no thread executes them.
        let unmapped = unsafe { rustix::mm::munmap(self.pages.as_ptr().cast(), self.len) };
        debug_assert!(unmapped.is_ok(), "a whole mapping can be unmapped");
    }

    #[cfg(not(all(unix, target_pointer_width = "64")))]
    fn drop(&mut self) {}
}
