//! Compute pipelines and dispatches.

mod check;
mod error;
mod run;

pub use error::{ComputePipelineError, DispatchError, DispatchErrorKind};
pub(crate) use {check::check, run::dispatch};

use crate::{BindGroup, BindGroupLayout, Buffer, Limits};
use estampe_types::shader::ComputeProgram;
use std::sync::Arc;

/// Describes a compute pipeline: WebGPU's `GPUComputePipelineDescriptor`.
#[derive(Debug, Clone)]
pub struct ComputePipelineDescriptor<'a> {
    /// A name for error messages. Default none.
    pub label: Option<&'a str>,
    /// The shader.
    pub program: Arc<dyn ComputeProgram>,
    /// The bind groups that it reads and writes, by group number. Default those that the program
    /// declares.
    pub bind_group_layouts: Vec<BindGroupLayout>,
}

impl ComputePipelineDescriptor<'_> {
    /// The defaults, for a program.
    #[must_use]
    pub fn new(program: Arc<dyn ComputeProgram>) -> Self {
        Self {
            label: None,
            bind_group_layouts: program.bind_group_layouts().to_vec(),
            program,
        }
    }
}

/// A compute shader with the layouts of what it binds. Cheap to clone.
#[derive(Debug, Clone)]
pub struct ComputePipeline {
    inner: Arc<Inner>,
}

#[derive(Debug)]
struct Inner {
    label: Option<String>,
    program: Arc<dyn ComputeProgram>,
    bind_group_layouts: Vec<BindGroupLayout>,
}

impl ComputePipeline {
    pub(crate) fn new(
        descriptor: &ComputePipelineDescriptor<'_>,
        limits: &Limits,
    ) -> Result<Self, ComputePipelineError> {
        estampe_core::check_bind_group_layouts(&descriptor.bind_group_layouts, limits)?;
        estampe_core::check_declared(
            descriptor.program.bind_group_layouts(),
            &descriptor.bind_group_layouts,
        )?;
        estampe_core::check_immediates(descriptor.program.immediate_size(), limits)?;
        check::check_interface(descriptor.program.interface(), limits)?;
        Ok(Self {
            inner: Arc::new(Inner {
                label: descriptor.label.map(str::to_owned),
                program: Arc::clone(&descriptor.program),
                bind_group_layouts: descriptor.bind_group_layouts.clone(),
            }),
        })
    }

    /// The shader.
    #[must_use]
    pub fn program(&self) -> &Arc<dyn ComputeProgram> {
        &self.inner.program
    }

    /// The layouts of the bind groups, by group number.
    #[must_use]
    pub fn bind_group_layouts(&self) -> &[BindGroupLayout] {
        &self.inner.bind_group_layouts
    }

    fn label(&self) -> Option<&str> {
        self.inner.label.as_deref()
    }
}

/// The number of work-groups of a dispatch.
#[derive(Debug, Clone, Copy)]
pub enum DispatchSize<'a> {
    /// Along x, y and z.
    Workgroups([u32; 3]),
    /// Three 32-bit integers of a buffer, from this byte on: the numbers when the dispatch runs.
    Indirect(&'a Buffer, u64),
}

impl From<[u32; 3]> for DispatchSize<'_> {
    fn from(count: [u32; 3]) -> Self {
        Self::Workgroups(count)
    }
}

/// Work-groups of a compute shader, with what they read and write.
#[derive(Debug, Clone)]
pub struct Dispatch<'a> {
    /// The shader.
    pub pipeline: &'a ComputePipeline,
    /// The bind groups, by group number. Default none.
    pub bind_groups: &'a [BindGroup],
    /// The dynamic offsets in bytes: those of the first group in the order of its binding numbers,
    /// then those of the next. Default none.
    pub dynamic_offsets: &'a [u32],
    /// The immediates, as those of a [draw](crate::Draw::immediates). Default none.
    pub immediates: &'a [u8],
    /// The number of work-groups.
    pub size: DispatchSize<'a>,
}

impl<'a> Dispatch<'a> {
    /// A dispatch without bind groups.
    #[must_use]
    pub fn new(pipeline: &'a ComputePipeline, size: impl Into<DispatchSize<'a>>) -> Self {
        Self {
            pipeline,
            bind_groups: &[],
            dynamic_offsets: &[],
            immediates: &[],
            size: size.into(),
        }
    }
}
