//! Indices of things that do not exist, in parts that are not read.
//!
//! Validator: `UNRESOLVED_REFERENCE`.

use super::super::document::{Animation, Document, Index, Primitive};
use super::{Report, materials};

/// Warns of each index without an element.
pub(super) fn check(document: &Document<'_>, report: &mut Report<'_, '_>) {
    storage(document, report);
    for (at, scene) in document.scenes.iter().enumerate() {
        for (i, &node) in scene.nodes.iter().enumerate() {
            let place = || format!("/scenes/{at}/nodes/{i}");
            exists(report, document.nodes.len(), node, "node", place);
        }
    }
    nodes(document, report);
    for (at, mesh) in document.meshes.iter().enumerate() {
        for (i, primitive) in mesh.primitives.iter().enumerate() {
            let pointer = || format!("/meshes/{at}/primitives/{i}");
            check_primitive(primitive, document, report, pointer);
        }
    }
    for (at, skin) in document.skins.iter().enumerate() {
        for (i, &joint) in skin.joints.iter().enumerate() {
            let place = || format!("/skins/{at}/joints/{i}");
            exists(report, document.nodes.len(), joint, "node", place);
        }
        if let Some(matrices) = skin.inverse_bind_matrices {
            let place = || format!("/skins/{at}/inverseBindMatrices");
            exists(
                report,
                document.accessors.len(),
                matrices,
                "accessor",
                place,
            );
        }
    }
    for (at, animation) in document.animations.iter().enumerate() {
        check_animation(animation, at, document, report);
    }
    images(document, report);
    for (at, material) in document.materials.iter().enumerate() {
        materials::for_each_texture(material, |property, texture| {
            let place = || format!("/materials/{at}/{property}/index");
            let count = document.textures.len();
            exists(report, count, texture.index, "texture", place);
        });
    }
}

/// Warns unless the index is below `count`.
fn exists(
    report: &mut Report<'_, '_>,
    count: usize,
    index: Index,
    what: &str,
    pointer: impl FnOnce() -> String,
) {
    if index.0 >= count {
        let text = || format!("{what} {index} does not exist; the file has {count}");
        report.warn(pointer, text);
    }
}

fn storage(document: &Document<'_>, report: &mut Report<'_, '_>) {
    let views = document.buffer_views.len();
    for (at, accessor) in document.accessors.iter().enumerate() {
        let sparse = accessor.sparse.as_deref();
        for (view, property) in [
            (accessor.buffer_view, "bufferView"),
            (
                sparse.map(|sparse| sparse.indices.buffer_view),
                "sparse/indices/bufferView",
            ),
            (
                sparse.map(|sparse| sparse.values.buffer_view),
                "sparse/values/bufferView",
            ),
        ] {
            if let Some(view) = view {
                let place = || format!("/accessors/{at}/{property}");
                exists(report, views, view, "buffer view", place);
            }
        }
    }
    for (at, view) in document.buffer_views.iter().enumerate() {
        let buffers = document.buffers.len();
        let place = || format!("/bufferViews/{at}/buffer");
        exists(report, buffers, view.buffer, "buffer", place);
        if let Some(meshopt) = &view.extensions.meshopt {
            let place = || format!("/bufferViews/{at}/extensions/EXT_meshopt_compression/buffer");
            exists(report, buffers, meshopt.buffer, "buffer", place);
        }
    }
}

fn nodes(document: &Document<'_>, report: &mut Report<'_, '_>) {
    let lights = document.extensions.lights().len();
    for (at, node) in document.nodes.iter().enumerate() {
        let light = node.extensions.light.as_ref().map(|used| used.light);
        for (index, count, what, property) in [
            (node.mesh, document.meshes.len(), "mesh", "mesh"),
            (node.skin, document.skins.len(), "skin", "skin"),
            (node.camera, document.cameras.len(), "camera", "camera"),
            (
                light,
                lights,
                "light",
                "extensions/KHR_lights_punctual/light",
            ),
        ] {
            if let Some(index) = index {
                exists(report, count, index, what, || {
                    format!("/nodes/{at}/{property}")
                });
            }
        }
        let instancing = node.extensions.instancing.as_deref();
        for (name, &index) in instancing.iter().flat_map(|found| &found.attributes) {
            let place =
                || format!("/nodes/{at}/extensions/EXT_mesh_gpu_instancing/attributes/{name}");
            exists(report, document.accessors.len(), index, "accessor", place);
        }
    }
}

fn check_primitive(
    primitive: &Primitive,
    document: &Document<'_>,
    report: &mut Report<'_, '_>,
    pointer: impl Fn() -> String,
) {
    let accessors = document.accessors.len();
    for (name, &index) in &primitive.attributes {
        let place = || format!("{}/attributes/{name}", pointer());
        exists(report, accessors, index, "accessor", place);
    }
    if let Some(indices) = primitive.indices {
        let place = || format!("{}/indices", pointer());
        exists(report, accessors, indices, "accessor", place);
    }
    for (target, attributes) in primitive.targets.iter().enumerate() {
        for (name, &index) in attributes {
            let place = || format!("{}/targets/{target}/{name}", pointer());
            exists(report, accessors, index, "accessor", place);
        }
    }
    let materials = document.materials.len();
    if let Some(material) = primitive.material {
        let place = || format!("{}/material", pointer());
        exists(report, materials, material, "material", place);
    }
    let mappings = primitive.extensions.variants.as_deref();
    let mappings = mappings.map_or(&[][..], |found| &found.mappings);
    let variants = document.extensions.variants().len();
    for (at, mapping) in mappings.iter().enumerate() {
        let place = || {
            let pointer = pointer();
            format!("{pointer}/extensions/KHR_materials_variants/mappings/{at}")
        };
        exists(report, materials, mapping.material, "material", || {
            format!("{}/material", place())
        });
        for (i, &variant) in mapping.variants.iter().enumerate() {
            exists(report, variants, variant, "variant", || {
                format!("{}/variants/{i}", place())
            });
        }
    }
}

fn check_animation(
    animation: &Animation,
    at: usize,
    document: &Document<'_>,
    report: &mut Report<'_, '_>,
) {
    for (i, sampler) in animation.samplers.iter().enumerate() {
        for (index, property) in [(sampler.input, "input"), (sampler.output, "output")] {
            let place = || format!("/animations/{at}/samplers/{i}/{property}");
            exists(report, document.accessors.len(), index, "accessor", place);
        }
    }
    for (i, channel) in animation.channels.iter().enumerate() {
        let samplers = animation.samplers.len();
        let place = || format!("/animations/{at}/channels/{i}/sampler");
        exists(report, samplers, channel.sampler, "sampler", place);
        if let Some(node) = channel.target.node {
            let place = || format!("/animations/{at}/channels/{i}/target/node");
            exists(report, document.nodes.len(), node, "node", place);
        }
    }
}

fn images(document: &Document<'_>, report: &mut Report<'_, '_>) {
    for (at, texture) in document.textures.iter().enumerate() {
        if let Some(sampler) = texture.sampler {
            let place = || format!("/textures/{at}/sampler");
            exists(report, document.samplers.len(), sampler, "sampler", place);
        }
        let of = |extension: &Option<super::super::document::TextureSource>| {
            extension.as_ref().and_then(|found| found.source)
        };
        for (source, property) in [
            (texture.source, "source"),
            (
                of(&texture.extensions.webp),
                "extensions/EXT_texture_webp/source",
            ),
            (
                of(&texture.extensions.dds),
                "extensions/MSFT_texture_dds/source",
            ),
        ] {
            if let Some(source) = source {
                let place = || format!("/textures/{at}/{property}");
                exists(report, document.images.len(), source, "image", place);
            }
        }
    }
    for (at, image) in document.images.iter().enumerate() {
        if let Some(view) = image.buffer_view {
            let place = || format!("/images/{at}/bufferView");
            exists(
                report,
                document.buffer_views.len(),
                view,
                "buffer view",
                place,
            );
        }
    }
}
