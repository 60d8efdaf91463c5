//! Alignment, strides and ranges of accessors and buffer views.
//!
//! Validator: `ACCESSOR_OFFSET_ALIGNMENT`, `ACCESSOR_TOTAL_OFFSET_ALIGNMENT`,
//! `ACCESSOR_NORMALIZED_INVALID`, `ACCESSOR_TOO_LONG`, `ACCESSOR_SMALL_BYTESTRIDE`,
//! `BUFFER_VIEW_TOO_LONG`, `VALUE_NOT_IN_RANGE` and `VALUE_MULTIPLE_OF` of strides.

use super::super::accessor::Component;
use super::super::document::{Accessor, BufferView, Document, Index};
use super::Report;

/// Warns of accessors and views that the specification forbids and that can be read, or that
/// nothing reads.
pub(super) fn check(document: &Document<'_>, report: &mut Report<'_, '_>) {
    for (at, view) in document.buffer_views.iter().enumerate() {
        check_view(view, at, document, report);
    }
    for (at, accessor) in document.accessors.iter().enumerate() {
        check_accessor(accessor, at, document, report);
    }
}

fn check_view(view: &BufferView, at: usize, document: &Document<'_>, report: &mut Report<'_, '_>) {
    let length = document.buffers.get(view.buffer.0);
    let end = view.byte_offset.0.saturating_add(view.byte_length.0);
    if let Some(length) = length.map(|buffer| buffer.byte_length.0)
        && end > length
        && view.extensions.meshopt.is_none()
    {
        report.warn(
            || format!("/bufferViews/{at}"),
            || format!("it ends at byte {end}, the buffer's `byteLength` is {length}"),
        );
    }
    if let Some(stride) = view.byte_stride {
        let place = || format!("/bufferViews/{at}/byteStride");
        if !stride.0.is_multiple_of(4) || !(4..=252).contains(&stride.0) {
            let what = || format!("the stride {stride} is not a multiple of 4 from 4 to 252");
            report.warn(place, what);
        } else if stride > view.byte_length {
            let what = || format!("the stride {stride} is longer than the view");
            report.warn(place, what);
        }
    }
}

fn check_accessor(
    accessor: &Accessor,
    at: usize,
    document: &Document<'_>,
    report: &mut Report<'_, '_>,
) {
    let view = accessor.buffer_view;
    let view = view.and_then(|view| document.buffer_views.get(view.0));
    let Some(component) = Component::of(accessor.component_type) else {
        report.warn(
            || format!("/accessors/{at}/componentType"),
            || {
                let code = accessor.component_type;
                format!("{code} is not the type of a component")
            },
        );
        return;
    };
    if accessor.normalized && matches!(component, Component::U32 | Component::F32) {
        report.warn(
            || format!("/accessors/{at}/normalized"),
            || "integers of 8 and 16 bits alone are normalized".to_owned(),
        );
    }
    if accessor.count.0 == 0 {
        report.warn(
            || format!("/accessors/{at}/count"),
            || "it has no elements".to_owned(),
        );
    }
    let size = component.size();
    if let Some(view) = view {
        is_aligned(report, view, accessor.byte_offset, size, || {
            format!("/accessors/{at}")
        });
        if let Some(width) = width(&accessor.kind)
            && view.extensions.meshopt.is_none()
        {
            let element = width * size;
            let stride = view.byte_stride.map_or(element, |stride| stride.0);
            let layout = [accessor.count.0, stride, element];
            if stride < element {
                report.warn(
                    || format!("/accessors/{at}"),
                    || format!("elements of {element} bytes overlap, the stride is {stride}"),
                );
            }
            fits(report, view, accessor.byte_offset, layout, || {
                format!("/accessors/{at}")
            });
        }
    }
    if let Some(sparse) = accessor.sparse.as_deref() {
        if sparse.count > accessor.count || sparse.count.0 == 0 {
            let (count, of) = (sparse.count, accessor.count);
            report.warn(
                || format!("/accessors/{at}/sparse/count"),
                || format!("{count} elements replace some of {of}"),
            );
        }
        let indices = &sparse.indices;
        let index = Component::of(indices.component_type).map_or(1, Component::size);
        let element = width(&accessor.kind).unwrap_or(1) * size;
        for (view, offset, size, element, property) in [
            (
                indices.buffer_view,
                indices.byte_offset,
                index,
                index,
                "indices",
            ),
            (
                sparse.values.buffer_view,
                sparse.values.byte_offset,
                size,
                element,
                "values",
            ),
        ] {
            if let Some(view) = document.buffer_views.get(view.0) {
                let place = || format!("/accessors/{at}/sparse/{property}");
                is_aligned(report, view, offset, size, place);
                let layout = [sparse.count.0, element, element];
                fits(report, view, offset, layout, place);
            }
        }
    }
}

/// Warns unless `count` elements, every `stride` bytes, are within the view.
fn fits(
    report: &mut Report<'_, '_>,
    view: &BufferView,
    offset: Index,
    [count, stride, element]: [usize; 3],
    pointer: impl FnOnce() -> String,
) {
    let Some(before) = count.checked_sub(1) else {
        return;
    };
    let length = before.checked_mul(stride).and_then(|last| {
        let length = last.checked_add(element)?;
        length.checked_add(offset.0)
    });
    if length.is_none_or(|length| length > view.byte_length.0) {
        report.warn(pointer, || {
            "its elements do not fit into the buffer view".to_owned()
        });
    }
}

/// Components of a type of elements.
fn width(kind: &str) -> Option<usize> {
    Some(match kind {
        "SCALAR" => 1,
        "VEC2" => 2,
        "VEC3" => 3,
        "VEC4" => 4,
        "MAT4" => 16,
        _ => return None,
    })
}

/// Warns unless the first byte is at a multiple of `size`.
fn is_aligned(
    report: &mut Report<'_, '_>,
    view: &BufferView,
    offset: Index,
    size: usize,
    pointer: impl FnOnce() -> String,
) {
    let start = view.byte_offset.0.wrapping_add(offset.0);
    if !start.is_multiple_of(size) || !offset.0.is_multiple_of(size) {
        report.warn(pointer, || {
            format!("its first byte, {start}, is not a multiple of {size}")
        });
    }
}
