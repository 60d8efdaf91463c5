//! PLY, the Stanford polygon format: ASCII, and binary in both byte orders.
//!
//! ```text
//! header   (elements: name, count, properties)
//! values   (the body as a stream of scalars, in the stated encoding)
//!       -> vertices -> faces, triangle strips, edges -> corner_split -> mesh
//! ```
//!
//! Known: `vertex` (`x y z`, `nx ny nz`, `s t | u v | texture_u texture_v`, `red green blue
//! alpha`), `face` (`vertex_indices | vertex_index`, `texcoord`, `texnumber`, colours),
//! `tristrips`, `edge`, and `comment TextureFile`. Other elements and properties are skipped. A
//! file of vertices only is a cloud of points.
//!
//! Damage: truncated vertices are an error, because faces would have no meaning; truncated faces
//! leave the faces before, with a warning. Faces with indices that do not exist are omitted with a
//! warning.
//!
//! Source: G. Turk, "The PLY Polygon File Format", 1994; the elements' names as MeshLab and Blender
//! write them.

mod elements;
mod header;
mod triangle_rows;
mod values;
mod vertices;

use super::deferred::AlphaRule;
use super::load::{Context, Parsed};
use super::options::TextureAlpha;
use super::textures::{TextureName, Textures};
use crate::{AssetError, Limits};
use elements::Elements;
use estampe_scene::{AlphaMode, Material, Mesh, Scene, UpAxis};
use glam::Vec3;
use header::{Encoding, Header};
use values::{Ascii, Binary, Values};

/// Reads a PLY file.
pub(super) fn parse(bytes: &[u8], context: &mut Context<'_>) -> Result<Parsed, AssetError> {
    let header = Header::read(bytes, context)?;
    let mesh = match header.encoding {
        Encoding::Ascii => read_body(&mut Ascii::new(bytes, &header), &header, context),
        Encoding::Little => read_body(&mut Binary::<false>::new(bytes, &header), &header, context),
        Encoding::Big => read_body(&mut Binary::<true>::new(bytes, &header), &header, context),
    }?;
    let mut scene = Scene {
        up: UpAxis::Y,
        ..Scene::default()
    };
    load_textures(&header, &mut scene, context);
    scene.meshes.push(mesh);
    Ok(Parsed {
        scene,
        ..Parsed::default()
    })
}

/// Reads the elements in file order.
fn read_body<V: Values>(
    values: &mut V,
    header: &Header,
    context: &mut Context<'_>,
) -> Result<Mesh, AssetError> {
    let mut mesh = Mesh::default();
    let mut has_vertices = false;
    let mut elements = Elements::new(header);
    for element in &header.elements {
        let is_whole = match element.name.as_str() {
            "vertex" if !has_vertices => {
                has_vertices = true;
                Limits::check("vertices", element.count, context.limits.max_vertices)
                    .and_then(|()| vertices::read(values, element, &mut mesh, context.workers))
                    .map(|()| true)
            }
            "face" | "faces" => elements.read_faces(values, element, &mesh.positions, context),
            "tristrips" => elements.read_strips(values, element, &mesh.positions, context),
            "edge" => elements.read_edges(values, element, &mesh.positions, context),
            _ => values.skip_element(element),
        };
        // What the header states of an element is wrong at its line there.
        let is_whole = is_whole.map_err(|error| match error.fault().location {
            None => error.at(element.line),
            Some(_) => error,
        })?;
        if !is_whole {
            context.warnings.add(context.name, values.location(), || {
                format!(
                    "the file ends within its `{}` elements; complete ones are kept",
                    element.name
                )
            });
            break;
        }
    }
    if !has_vertices {
        return Err(AssetError::malformed(
            "it has no `vertex` element",
            "check that the file has a mesh or a point cloud",
        ));
    }
    elements.into_mesh(&mut mesh);
    if mesh.triangles.is_empty() && mesh.lines.is_empty() {
        // Limits keep the number of vertices below 2^32.
        mesh.points = (0..u32::try_from(mesh.positions.len()).unwrap_or(u32::MAX)).collect();
    }
    Ok(mesh)
}

/// One material for each `comment TextureFile`.
fn load_textures(header: &Header, scene: &mut Scene, context: &mut Context<'_>) {
    let mut textures = Textures::default();
    for (name, location) in &header.texture_files {
        let name = TextureName {
            name: name.clone(),
            folder: String::new(),
            named_in: context.name.to_owned(),
            location: *location,
        };
        let mut material = Material {
            name: name.name.clone(),
            base_color: Vec3::ONE,
            ..Material::default()
        };
        if let Some(image) = textures.load(Some(&name), None, context) {
            material.base_color_texture = Some(image);
            material.alpha_mode = AlphaMode::Blend;
            context.images.add_alpha_rule(AlphaRule {
                material: scene.materials.len(),
                chosen: TextureAlpha::Auto,
                color_without: None,
            });
        }
        scene.materials.push(material);
    }
}
