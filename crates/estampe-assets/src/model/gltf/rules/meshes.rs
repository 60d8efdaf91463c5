//! Meshes: formats of attributes, sets of attributes, morph targets, variants.
//!
//! Validator: `MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT`,
//! `MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_UNSIGNED_INT`, `MESH_PRIMITIVE_INVALID_ATTRIBUTE`,
//! `MESH_PRIMITIVE_INDEXED_SEMANTIC_CONTINUITY`, `MESH_PRIMITIVE_JOINTS_WEIGHTS_MISMATCH`,
//! `MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT`, `MESH_PRIMITIVE_MORPH_TARGET_NO_BASE_ACCESSOR`,
//! `MESH_PRIMITIVE_MORPH_TARGET_INVALID_ATTRIBUTE_COUNT`,
//! `MESH_PRIMITIVE_INDICES_ACCESSOR_INVALID_FORMAT`, `MESH_PRIMITIVES_UNEQUAL_TARGETS_COUNT`,
//! `MESH_INVALID_WEIGHTS_COUNT`, `KHR_MATERIALS_VARIANTS_NON_UNIQUE_VARIANT`.

use super::super::accessor::Component;
use super::super::document::{Accessor, Document, Index, Mesh, Primitive};
use super::Report;
use std::collections::HashSet;

/// Warns of meshes that are drawn, or that no node has, and break a rule.
pub(super) fn check(document: &Document<'_>, report: &mut Report<'_, '_>) {
    let is_quantized = document
        .extensions_used
        .iter()
        .any(|name| name == "KHR_mesh_quantization");
    for (at, mesh) in document.meshes.iter().enumerate() {
        check_targets(mesh, at, report);
        for (i, primitive) in mesh.primitives.iter().enumerate() {
            let mut primitive = Checked {
                pointer: || format!("/meshes/{at}/primitives/{i}"),
                primitive,
                document,
                is_quantized,
                report,
            };
            primitive.check_attributes();
            primitive.check_sets();
            primitive.check_targets();
            primitive.check_indices();
            primitive.check_variants();
        }
    }
}

/// The numbers of morph targets and of weights of a whole mesh.
fn check_targets(mesh: &Mesh, at: usize, report: &mut Report<'_, '_>) {
    let mut counts = mesh
        .primitives
        .iter()
        .map(|primitive| primitive.targets.len());
    let Some(count) = counts.next() else {
        return;
    };
    if counts.any(|other| other != count) {
        report.warn(
            || format!("/meshes/{at}/primitives"),
            || "the primitives have different numbers of morph targets".to_owned(),
        );
    }
    let weights = mesh.weights.len();
    if weights != 0 && weights != count {
        report.warn(
            || format!("/meshes/{at}/weights"),
            || format!("{weights} weights for {count} morph targets"),
        );
    }
}

/// A primitive that is being checked.
struct Checked<'a, 'r, 'c, 'x, P> {
    pointer: P,
    primitive: &'a Primitive,
    document: &'a Document<'a>,
    is_quantized: bool,
    report: &'r mut Report<'c, 'x>,
}

impl<'a, P: Fn() -> String> Checked<'a, '_, '_, '_, P> {
    fn accessor(&self, index: Index) -> Option<&'a Accessor> {
        self.document.accessors.get(index.0)
    }

    fn check_attributes(&mut self) {
        let positions = self.primitive.attributes.get("POSITION");
        let count = positions.and_then(|&index| self.accessor(index));
        let count = count.map(|accessor| accessor.count);
        for (name, &index) in &self.primitive.attributes {
            let Some(accessor) = self.accessor(index) else {
                continue;
            };
            let pointer = || format!("{}/attributes/{name}", (self.pointer)());
            match format_of(name, accessor, self.is_quantized) {
                Format::Allowed => {}
                Format::Other => self.report.warn(pointer, || {
                    "the specification has no such format for this attribute".to_owned()
                }),
                Format::UnknownName => self.report.warn(pointer, || {
                    "the specification has no such attribute; names of others begin with `_`"
                        .to_owned()
                }),
            }
            if count.is_some_and(|count| count != accessor.count) {
                self.report.warn(pointer, || {
                    format!(
                        "{} elements, and another number of positions",
                        accessor.count
                    )
                });
            }
        }
    }

    /// Sets are numbered from 0, and joints have weights.
    fn check_sets(&mut self) {
        let count = |prefix: &str| {
            let names = self.primitive.attributes.keys();
            names.filter(|name| name.starts_with(prefix)).count()
        };
        let attributes = || format!("{}/attributes", (self.pointer)());
        for prefix in ["TEXCOORD_", "COLOR_", "JOINTS_", "WEIGHTS_"] {
            let sets = count(prefix);
            let has = |set: &usize| {
                let name = format!("{prefix}{set}");
                self.primitive.attributes.contains_key(&name)
            };
            if let Some(missing) = (0..sets).find(|set| !has(set)) {
                self.report.warn(attributes, || {
                    format!("{prefix}{missing} is missing; sets are numbered from 0")
                });
            }
        }
        if count("JOINTS_") != count("WEIGHTS_") {
            self.report.warn(attributes, || {
                "the numbers of sets of joints and of weights differ".to_owned()
            });
        }
    }

    fn check_targets(&mut self) {
        for (target, attributes) in self.primitive.targets.iter().enumerate() {
            for (name, &index) in attributes {
                let pointer = || format!("{}/targets/{target}/{name}", (self.pointer)());
                let Some(&base) = self.primitive.attributes.get(name) else {
                    self.report.warn(pointer, || {
                        "the primitive has no such attribute; the target's is not used".to_owned()
                    });
                    continue;
                };
                let accessors = [base, index].map(|index| self.accessor(index));
                if let Some(own) = accessors[1]
                    && !is_format_of_target(name, own)
                {
                    self.report.warn(pointer, || {
                        "the specification has no such format for this attribute".to_owned()
                    });
                }
                let counts = accessors.map(|found| found.map(|found| found.count));
                if let [Some(base), Some(own)] = counts
                    && base != own
                {
                    self.report
                        .warn(pointer, || format!("{own} elements for {base} vertices"));
                }
            }
        }
    }

    fn check_indices(&mut self) {
        if let Some(mode) = self.primitive.mode
            && mode.0 > 6
        {
            self.report.warn(
                || format!("{}/mode", (self.pointer)()),
                || format!("{mode} is not a mode, which are 0 to 6; the primitive is left out"),
            );
        }
        let Some(accessor) = self
            .primitive
            .indices
            .and_then(|index| self.accessor(index))
        else {
            return;
        };
        let component = Component::of(accessor.component_type);
        let is_unsigned = matches!(
            component,
            Some(Component::U8 | Component::U16 | Component::U32)
        );
        if !is_unsigned || accessor.kind != "SCALAR" || accessor.normalized {
            let pointer = || format!("{}/indices", (self.pointer)());
            self.report.warn(pointer, || {
                "indices are SCALAR, of unsigned integers that are not normalized".to_owned()
            });
        }
    }

    fn check_variants(&mut self) {
        let mappings = self.primitive.extensions.variants.as_deref();
        let mut known = HashSet::new();
        let variants = mappings.map_or(&[][..], |found| &found.mappings).iter();
        let mut variants = variants.flat_map(|mapping| &mapping.variants);
        if let Some(variant) = variants.find(|variant| !known.insert(**variant)) {
            self.report.warn(
                || format!("{}/extensions/KHR_materials_variants", (self.pointer)()),
                || format!("variant {variant} has two materials; the first is used"),
            );
        }
    }
}

/// An attribute's name and format, as the specification sees them.
enum Format {
    Allowed,
    Other,
    UnknownName,
}

/// Formats of changes: tangents have no sign, and KHR_mesh_quantization adds small integers.
fn is_format_of_target(name: &str, accessor: &Accessor) -> bool {
    let kinds: &[&str] = match name {
        "POSITION" | "NORMAL" | "TANGENT" => &["VEC3"],
        name if name.starts_with("TEXCOORD_") => &["VEC2"],
        name if name.starts_with("COLOR_") => &["VEC3", "VEC4"],
        _ => return true,
    };
    let component = Component::of(accessor.component_type);
    kinds.contains(&&*accessor.kind) && component.is_some_and(|found| found != Component::U32)
}

/// Formats of §3.7.2.1, and of KHR_mesh_quantization.
fn format_of(name: &str, accessor: &Accessor, is_quantized: bool) -> Format {
    use Component::{F32, I8, I16, U8, U16, U32};
    let Some(component) = Component::of(accessor.component_type) else {
        return Format::Other;
    };
    let (kind, is_normalized) = (&*accessor.kind, accessor.normalized);
    let is_float = component == F32 && !is_normalized;
    let is_unsigned_part = is_normalized && matches!(component, U8 | U16);
    let is_signed_part = is_normalized && matches!(component, I8 | I16);
    let is_small = matches!(component, I8 | U8 | I16 | U16);
    let (family, set) = match name.rsplit_once('_') {
        Some((family, set)) if set.bytes().all(|byte| byte.is_ascii_digit()) && !set.is_empty() => {
            (family, Some(set))
        }
        _ => (name, None),
    };
    let is_allowed = match (family, set) {
        ("POSITION", None) => kind == "VEC3" && (is_float || is_quantized && is_small),
        ("NORMAL", None) => kind == "VEC3" && (is_float || is_quantized && is_signed_part),
        ("TANGENT", None) => kind == "VEC4" && (is_float || is_quantized && is_signed_part),
        ("TEXCOORD", Some(_)) => {
            kind == "VEC2" && (is_float || is_unsigned_part || is_quantized && is_small)
        }
        ("COLOR", Some(_)) => matches!(kind, "VEC3" | "VEC4") && (is_float || is_unsigned_part),
        ("JOINTS", Some(_)) => kind == "VEC4" && !is_normalized && matches!(component, U8 | U16),
        ("WEIGHTS", Some(_)) => kind == "VEC4" && (is_float || is_unsigned_part),
        // Attributes of applications are free but for one type.
        _ if name.starts_with('_') => component != U32,
        _ => return Format::UnknownName,
    };
    if is_allowed {
        Format::Allowed
    } else {
        Format::Other
    }
}
