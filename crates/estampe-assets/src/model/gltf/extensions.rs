//! The extensions that a file names.

use super::document::Document;
use super::fault::warn;
use crate::AssetError;
use crate::model::load::Context;

/// The extensions that are read.
const READ: [&str; 23] = [
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    // Images of Basis Universal are replaced by others, left out, or refused.
    "KHR_texture_basisu",
    "KHR_texture_transform",
    // Names in other files' metadata, without influence on a picture.
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "MSFT_texture_dds",
];

/// Common extensions that are not read: what to do if a file requires them, and what is used
/// instead if it does not.
const NOT_READ: [(&str, &str, &str); 1] = [(
    "KHR_draco_mesh_compression",
    "export the file again without Draco compression",
    "the uncompressed geometry is used",
)];

/// Refuses files that need what is not read, and warns of what a file has besides.
pub(super) fn check(document: &Document<'_>, context: &mut Context<'_>) -> Result<(), AssetError> {
    for (at, name) in document.extensions_required.iter().enumerate() {
        if READ.contains(&&**name) {
            continue;
        }
        let known = NOT_READ.iter().find(|(known, ..)| known == name);
        let advice = known.map_or("export the file again without it", |(_, advice, _)| advice);
        return Err(AssetError::unsupported(
            format!("the file requires the extension `{name}`, which is not read"),
            advice,
        )
        .at_json(format!("/extensionsRequired/{at}")));
    }
    for (at, name) in document.extensions_used.iter().enumerate() {
        if READ.contains(&&**name) {
            continue;
        }
        let known = NOT_READ.iter().find(|(known, ..)| known == name);
        let instead = known.map_or("what it adds is left out", |(.., instead)| instead);
        warn(
            context,
            format!("/extensionsUsed/{at}"),
            format!("the extension `{name}` is not read; {instead}"),
        );
    }
    Ok(())
}
