//! Why no code is made.

/// Why no code is made for a kernel. The interpreter runs all kernels.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CompileError {
    /// The processor lacks the instruction set.
    #[error("this processor has no {0}: choose another instruction set, or interpret the kernel")]
    NoIsa(&'static str),
    /// The kernel has an operation for which there is no code.
    #[error("the kernel has an operation that is not compiled: interpret it")]
    Unknown,
    /// The kernel, its arrays or its code are too large.
    #[error("the kernel has too many operations or words of arrays: interpret it")]
    TooLarge,
    /// The kernel is not one that [`estampe_ir::lanes::Kernel::from_tree`] makes.
    #[error("the kernel is not well formed ({0})")]
    Malformed(String),
    /// The system gives no memory, or none that may be executed.
    #[error("there is no executable memory ({0}): interpret the kernel")]
    NoMemory(String),
}
