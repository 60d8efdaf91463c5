//! The use of buffer views: views of vertices have a stride if they are shared, all others have
//! none.
//!
//! Readers differ where a file breaks these rules: this one applies a stride wherever it stands.
//!
//! Validator: `MESH_PRIMITIVE_ACCESSOR_WITHOUT_BYTESTRIDE`, `MESH_PRIMITIVE_ACCESSOR_UNALIGNED`,
//! `MESH_PRIMITIVE_INDICES_ACCESSOR_WITH_BYTESTRIDE`, `ANIMATION_SAMPLER_ACCESSOR_WITH_BYTESTRIDE`,
//! `SKIN_IBM_ACCESSOR_WITH_BYTESTRIDE`, `IMAGE_BUFFER_VIEW_WITH_BYTESTRIDE`.

use super::super::accessor::Component;
use super::super::document::{Document, Index};
use super::Report;

/// Warns of views with a stride that must not have one, and the other way round.
pub(super) fn check(document: &Document<'_>, report: &mut Report<'_, '_>) {
    let mut usage = Usage::new(document);
    for primitive in document.meshes.iter().flat_map(|mesh| &mesh.primitives) {
        let targets = primitive.targets.iter().flat_map(|target| target.values());
        for &attribute in primitive.attributes.values().chain(targets) {
            usage.add_vertices(attribute);
        }
        if let Some(indices) = primitive.indices {
            usage.add_packed(indices, "indices");
        }
    }
    for skin in &document.skins {
        if let Some(matrices) = skin.inverse_bind_matrices {
            usage.add_packed(matrices, "inverse bind matrices");
        }
    }
    for sampler in document.animations.iter().flat_map(|found| &found.samplers) {
        usage.add_packed(sampler.input, "keyframes");
        usage.add_packed(sampler.output, "keyframes");
    }
    for view in document.images.iter().filter_map(|image| image.buffer_view) {
        usage.add_packed_view(view, "an image");
    }
    usage.report(report);
}

/// The uses of accessors and views.
struct Usage<'a> {
    document: &'a Document<'a>,
    /// By accessor: true if it has vertices.
    is_vertices: Vec<bool>,
    /// By view: what it has, if that must not have a stride.
    packed: Vec<Option<&'static str>>,
}

impl<'a> Usage<'a> {
    fn new(document: &'a Document<'a>) -> Self {
        Self {
            document,
            is_vertices: vec![false; document.accessors.len()],
            packed: vec![None; document.buffer_views.len()],
        }
    }

    fn add_vertices(&mut self, accessor: Index) {
        if let Some(is_vertices) = self.is_vertices.get_mut(accessor.0) {
            *is_vertices = true;
        }
    }

    fn add_packed(&mut self, accessor: Index, what: &'static str) {
        let accessor = self.document.accessors.get(accessor.0);
        if let Some(view) = accessor.and_then(|accessor| accessor.buffer_view) {
            self.add_packed_view(view, what);
        }
    }

    fn add_packed_view(&mut self, view: Index, what: &'static str) {
        if let Some(packed) = self.packed.get_mut(view.0) {
            *packed = Some(what);
        }
    }

    fn report(self, report: &mut Report<'_, '_>) {
        let views = &self.document.buffer_views;
        let mut users = vec![0_u32; views.len()];
        for (at, accessor) in self.document.accessors.iter().enumerate() {
            let Some(index) = accessor.buffer_view.filter(|_| self.is_vertices[at]) else {
                continue;
            };
            let Some(view) = views.get(index.0) else {
                continue;
            };
            users[index.0] += 1;
            let is_compressed = view.extensions.meshopt.is_some();
            if users[index.0] == 2 && view.byte_stride.is_none() && !is_compressed {
                report.warn(
                    || format!("/bufferViews/{index}"),
                    || {
                        "several accessors of vertices share it without a `byteStride`; each is read as \
                         if it were packed"
                            .to_owned()
                    },
                );
            }
            let size = Component::of(accessor.component_type).map_or(4, Component::size);
            let is_aligned = view.byte_stride.map_or_else(
                || packed_size(&accessor.kind, size).is_multiple_of(4) || accessor.count.0 < 2,
                |stride| stride.0.is_multiple_of(4),
            );
            let start = accessor.byte_offset.0 % 4;
            // Misaligned components have a warning of their own.
            if (!is_aligned || start != 0) && size < 4 {
                report.warn(
                    || format!("/accessors/{at}"),
                    || "vertices do not begin at multiples of 4 bytes".to_owned(),
                );
            }
        }
        for (at, (view, packed)) in views.iter().zip(self.packed).enumerate() {
            if let (Some(what), Some(stride)) = (packed, view.byte_stride) {
                report.warn(
                    || format!("/bufferViews/{at}/byteStride"),
                    || format!("a view with {what} has no stride; {stride} is used"),
                );
            }
        }
    }
}

/// Bytes of a packed element.
fn packed_size(kind: &str, component: usize) -> usize {
    let width = match kind {
        "VEC2" => 2,
        "VEC3" => 3,
        "VEC4" => 4,
        _ => 1,
    };
    width * component
}
