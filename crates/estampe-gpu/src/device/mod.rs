//! The device: threads, a SIMD level and limits. It creates all objects, and draws.

mod commands;
mod create;

use crate::pass::DrawMemory;
use crate::{Level, Limits};
use estampe_core::Context;
use estampe_core::ThreadPool;
use estampe_core::profile::JobTimings;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Threads, SIMD level and limits of a device.
#[derive(Debug, Clone, Default)]
pub struct DeviceDescriptor {
    /// Number of threads that draw. Default 0: one for each processor. The image does not depend on
    /// it.
    pub threads: usize,
    /// A pool whose threads draw, beside the caller; several devices may share it. Default none:
    /// the device starts [`threads`](Self::threads) of its own.
    pub pool: Option<Arc<ThreadPool>>,
    /// SIMD level of the kernels. Default the widest that the processor supports. The image does
    /// not depend on it.
    pub level: Level,
    /// The largest sizes of resources and pipelines.
    pub limits: Limits,
    /// If set, shaders as text are interpreted and no machine code is made, as on processors for
    /// which there is none. Default false. The image does not depend on it.
    pub interprets_shaders: bool,
}

/// Errors of [`Device::new`].
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DeviceError {
    /// More than 1024 threads were requested.
    #[error("{0} threads: at most 1024 are possible")]
    TooManyThreads(usize),
    /// The system could not start the threads.
    #[error("the system gives no threads: {0}")]
    Threads(String),
}

/// Creates all objects, and draws. A call is done when it returns: there is nothing to wait for.
/// [`Device::submit`] takes a list of commands, and checks all of it first.
///
/// ```
/// use estampe::{Device, DeviceDescriptor, Level};
///
/// // Every processor, the widest SIMD level; neither changes an image.
/// let device = Device::new(&DeviceDescriptor::default())?;
/// assert_eq!(device.level(), Level::best());
/// # Ok::<(), estampe::DeviceError>(())
/// ```
///
/// It is `Send + Sync`: share it by reference. Passes of several
/// threads are drawn side by side; those that use the same texture wait for each other,
/// unless all of them only read it.
#[derive(Debug)]
pub struct Device {
    context: Context,
    limits: Limits,
    #[cfg(feature = "shader-text")]
    interprets_shaders: bool,
    created: Instant,
    /// Memory of draws that no pass uses now: one for each pass that was drawn beside others.
    draw_memory: Mutex<Vec<DrawMemory>>,
}

impl Device {
    /// Creates a device.
    ///
    /// # Errors
    /// [`DeviceError`] if too many threads are requested, or the system cannot start them.
    pub fn new(descriptor: &DeviceDescriptor) -> Result<Self, DeviceError> {
        if descriptor.threads > 1024 {
            return Err(DeviceError::TooManyThreads(descriptor.threads));
        }
        let context = match &descriptor.pool {
            Some(pool) => Context::on_pool(Arc::clone(pool), descriptor.level),
            None => Context::new(descriptor.threads, descriptor.level)
                .map_err(|error| DeviceError::Threads(error.to_string()))?,
        };
        Ok(Self {
            context,
            limits: descriptor.limits.clone(),
            #[cfg(feature = "shader-text")]
            interprets_shaders: descriptor.interprets_shaders,
            created: Instant::now(),
            draw_memory: Mutex::default(),
        })
    }

    /// A device for profiling: it draws on the calling thread alone and measures the time of each
    /// job. The jobs are those of a device of this many threads, at least one.
    #[must_use]
    pub fn profiling(threads: usize, level: Level) -> Self {
        Self {
            context: Context::profiling(threads, level),
            limits: Limits::default(),
            #[cfg(feature = "shader-text")]
            interprets_shaders: false,
            created: Instant::now(),
            draw_memory: Mutex::default(),
        }
    }

    /// The device with so little memory for the bins of its passes that small pictures meet its
    /// limits: for tests.
    #[doc(hidden)]
    #[must_use]
    pub fn with_small_bins(self) -> Self {
        Self {
            context: self.context.with_small_bins(),
            ..self
        }
    }

    /// The times of all jobs since the last call. Empty unless the device was created by
    /// [`Device::profiling`].
    #[must_use]
    pub fn take_timings(&self) -> Vec<JobTimings> {
        self.context.take_timings()
    }

    /// The SIMD level of the kernels.
    #[must_use]
    pub fn level(&self) -> Level {
        self.context.level()
    }

    /// The number of threads that draw.
    #[must_use]
    pub fn threads(&self) -> usize {
        self.context.threads()
    }

    /// The time since the device was created: the clock of
    /// [timestamps](crate::RangeResult::begin).
    #[must_use]
    pub fn age(&self) -> Duration {
        self.created.elapsed()
    }

    /// Memory for the draws of a pass.
    pub(crate) fn take_draw_memory(&self) -> DrawMemory {
        self.draw_memories().pop().unwrap_or_default()
    }

    /// Keeps memory for the draws of another pass.
    pub(crate) fn keep_draw_memory(&self, memory: DrawMemory) {
        self.draw_memories().push(memory);
    }

    fn draw_memories(&self) -> MutexGuard<'_, Vec<DrawMemory>> {
        let kept = self.draw_memory.lock();
        kept.unwrap_or_else(PoisonError::into_inner)
    }

    pub(crate) fn context(&self) -> &Context {
        &self.context
    }

    /// The largest sizes of resources and pipelines.
    #[must_use]
    pub fn limits(&self) -> &Limits {
        &self.limits
    }
}
