//! Compute shaders: the one interface by which all of them run.

use crate::{BindGroupLayout, Bindings};
use estampe_simd::Level;
use std::fmt;
use std::ops::Range;

/// What a compute shader declares.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ComputeInterface {
    /// The invocations of a work-group along x, y and z, each at least 1.
    pub workgroup_size: [u32; 3],
    /// Bytes of memory that the invocations of a work-group share.
    pub workgroup_storage_bytes: u32,
}

/// Whether the results of a dispatch depend on the order in which its work-groups run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WorkgroupOrder {
    /// They do not: work-groups run on all threads.
    Free,
    /// They may: work-groups run one after the other, x fastest, then y, then z.
    InOrder,
}

/// Work-groups of a dispatch.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Workgroups {
    /// The work-groups of the whole dispatch along x, y and z.
    pub count: [u32; 3],
    /// Those to run, by number: work-group (x, y, z) is number (z · `count[1]` + y) · `count[0]` +
    /// x.
    pub range: Range<u64>,
}

impl Workgroups {
    /// The x, y and z of the work-groups to run, in order.
    pub fn ids(&self) -> impl Iterator<Item = [u32; 3]> {
        let [width, height, _] = self.count.map(|side| side.max(1));
        let [of_row, of_slice] = [width, height].map(u64::from);
        let small = |number: u64| u32::try_from(number).unwrap_or(u32::MAX);
        let row = self.range.start / of_row;
        let mut next = [
            small(self.range.start % of_row),
            small(row % of_slice),
            small(row / of_slice),
        ];
        self.range.clone().map(move |_| {
            let id = next;
            next[0] += 1;
            if next[0] == width {
                next = [0, next[1] + 1, next[2]];
            }
            if next[1] == height {
                next = [next[0], 0, next[2].saturating_add(1)];
            }
            id
        })
    }
}

/// Why work-groups were stopped. What they had stored until then stays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ComputeStopped {
    /// A work-group executed more jumps than [`Limits::max_shader_jumps`](crate::Limits).
    Budget,
    /// Memory is short.
    OutOfMemory,
}

impl fmt::Display for ComputeStopped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Budget => {
                "a work-group executed more jumps than the limit max_shader_jumps: does a loop \
                 never end? Divide the work into more work-groups, or raise the limit"
            }
            Self::OutOfMemory => "there is not enough memory for the variables of the shader",
        })
    }
}

impl std::error::Error for ComputeStopped {}

/// A compute shader.
pub trait ComputeProgram: fmt::Debug + Send + Sync {
    /// What it declares.
    fn interface(&self) -> &ComputeInterface;

    /// The layouts of the groups that it binds, by group number; those that a pipeline of it has if
    /// no others are given.
    fn bind_group_layouts(&self) -> &[BindGroupLayout] {
        &[]
    }

    /// The bytes of immediates that it reads: each dispatch must give at least as many.
    fn immediate_size(&self) -> u32 {
        0
    }

    /// Whether the order of the work-groups of a dispatch can be seen, so many along x, y and z.
    fn order(&self, bindings: &Bindings, count: [u32; 3]) -> WorkgroupOrder;

    /// Runs some work-groups of a dispatch, in order. Several threads call this at once, with
    /// different work-groups, if their [order](Self::order) is free.
    ///
    /// # Errors
    /// [`ComputeStopped`] if they cannot go on.
    fn run_workgroups(
        &self,
        level: Level,
        bindings: &Bindings,
        work: &Workgroups,
    ) -> Result<(), ComputeStopped>;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_groups_are_numbered_with_x_fastest() {
        let work = Workgroups {
            count: [3, 2, 2],
            range: 4..8,
        };
        let ids: Vec<_> = work.ids().collect();
        assert_eq!(ids, [[1, 1, 0], [2, 1, 0], [0, 0, 1], [1, 0, 1]]);
    }
}
