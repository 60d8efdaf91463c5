//! Buffers that shaders write, as atomic words.

use super::{Buffer, BufferError};
use crate::{BindGroup, BindingResource, BindingType, BufferBindingType};
use estampe_types::{BufferData, StorageBuffer};
use std::sync::MutexGuard;

/// The buffers that the shaders of a pass or dispatch write. Others wait for them until it ends.
#[derive(Debug)]
pub(crate) struct StoredBuffers<'a> {
    stored: Vec<Stored<'a>>,
}

#[derive(Debug)]
struct Stored<'a> {
    buffer: &'a Buffer,
    words: StorageBuffer,
    /// Where the words go in the end; `None` if they are a copy, which is dropped.
    home: Option<MutexGuard<'a, BufferData>>,
}

impl<'a> StoredBuffers<'a> {
    /// The buffers among the resources of groups, whose words change.
    pub(crate) fn in_place(groups: &[&'a BindGroup]) -> Result<Self, BufferError> {
        Self::of(groups, |buffer| {
            let mut home = buffer.lock();
            match StorageBuffer::try_from_data(std::mem::take(&mut *home)) {
                Ok(words) => Ok((words, Some(home))),
                Err(data) => {
                    *home = data;
                    Err(buffer.out_of_memory())
                }
            }
        })
    }

    /// Copies of the buffers, which stay as they are.
    pub(crate) fn copies(groups: &[&'a BindGroup]) -> Result<Self, BufferError> {
        Self::of(groups, |buffer| {
            let words = StorageBuffer::try_from_data(buffer.data());
            let words = words.map_err(|_| buffer.out_of_memory())?;
            Ok((words, None))
        })
    }

    fn of(
        groups: &[&'a BindGroup],
        take: impl Fn(
            &'a Buffer,
        )
            -> Result<(StorageBuffer, Option<MutexGuard<'a, BufferData>>), BufferError>,
    ) -> Result<Self, BufferError> {
        let mut buffers: Vec<&Buffer> = groups.iter().flat_map(|group| written(group)).collect();
        // In one order everywhere, so that no two passes wait for each other.
        buffers.sort_by_key(|buffer| buffer.id());
        buffers.dedup_by_key(|buffer| buffer.id());
        let mut stored = Vec::with_capacity(buffers.len());
        for buffer in buffers {
            let (words, home) = take(buffer)?;
            stored.push(Stored {
                buffer,
                words,
                home,
            });
        }
        Ok(Self { stored })
    }

    /// The words of a buffer, if shaders write it.
    pub(crate) fn get(&self, buffer: &Buffer) -> Option<&StorageBuffer> {
        let found = self.stored.iter().find(|one| one.buffer.is_same(buffer));
        found.map(|one| &one.words)
    }
}

impl Drop for Stored<'_> {
    fn drop(&mut self) {
        if let Some(home) = &mut self.home {
            **home = std::mem::take(&mut self.words).into_data();
        }
    }
}

/// The buffers of a group that shaders write.
fn written(group: &BindGroup) -> impl Iterator<Item = &Buffer> {
    let bound = buffers(group).filter(|(_, _, is_written)| *is_written);
    bound.map(|(_, buffer, _)| buffer)
}

/// The buffers of a group: binding, buffer, and whether shaders write it.
fn buffers(group: &BindGroup) -> impl Iterator<Item = (u32, &Buffer, bool)> {
    group.entries().iter().filter_map(|(binding, resource)| {
        let is_written = matches!(
            group.layout().entry(*binding)?.ty,
            BindingType::Buffer {
                ty: BufferBindingType::Storage { read_only: false },
                ..
            }
        );
        match resource {
            BindingResource::Buffer(slice) => Some((*binding, &slice.buffer, is_written)),
            _ => None,
        }
    })
}

/// A buffer that shaders write and that is used otherwise in the same pass or dispatch.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "{buffer} is written as {written} and used as {other}: give one of them another buffer, or \
     use them one after the other"
)]
pub struct BufferConflict {
    /// The buffer.
    pub buffer: String,
    /// The binding by which shaders write it.
    pub written: String,
    /// The other use.
    pub other: String,
}

/// Checks that the buffers which shaders write are used in no other way: neither as buffers that
/// groups read, nor as `others`, which come with their names.
pub(crate) fn check_conflicts<'a, N: Fn() -> String>(
    groups: &[&'a BindGroup],
    others: impl Iterator<Item = (&'a Buffer, N)>,
) -> Result<(), BufferConflict> {
    if groups.iter().all(|group| written(group).next().is_none()) {
        return Ok(());
    }
    let name = |group: &BindGroup, binding: u32| format!("binding {binding} of {}", group.name());
    let conflict = |buffer: &Buffer, other: &dyn Fn() -> String| {
        for group in groups {
            for (binding, candidate, is_written) in buffers(group) {
                if is_written && candidate.is_same(buffer) {
                    return Err(BufferConflict {
                        buffer: buffer.name(),
                        written: name(group, binding),
                        other: other(),
                    });
                }
            }
        }
        Ok(())
    };
    for group in groups {
        for (binding, buffer, is_written) in buffers(group) {
            if !is_written {
                conflict(buffer, &|| name(group, binding))?;
            }
        }
    }
    for (buffer, name) in others {
        conflict(buffer, &name)?;
    }
    Ok(())
}
