//! The mip levels of a scene's textures that a picture can sample, from geometry and camera.
//!
//! A sample's level of detail is λ = log₂ ρ, where ρ is the longer of the two vectors by which the
//! texel coordinates change from a pixel to its neighbours. With the Jacobian J of texel
//! coordinates by pixels, ρ² ≥ |det J|, the area of texels that a pixel covers. Within a triangle
//! in perspective that area is least at the corner nearest to the eye, of clip coordinates (x, y,
//! w):
//!
//! ```text
//!             area of the triangle in texels       w_min³
//!   |det J| ≥ ────────────────────────────── · ────────────────
//!             area of the triangle in pixels     w₀ · w₁ · w₂
//!
//!   area in pixels = |det (x y w)| · width · height ÷ (8 · w₀ · w₁ · w₂)
//! ```
//!
//! A triangle needs its texture from level ⌊½ log₂ |det J|⌋ − 1 on: the step down is a safety
//! factor of two, because derivatives are differences between neighbouring pixels. The whole
//! texture needs the least level of its triangles, without those that together cover less than a
//! pixel: files have slivers whose texture coordinates mean nothing. A mean over all triangles was
//! not chosen: a face in the foreground would lose what the background does not need.
//!
//! A model that is cut by planes has the triangles and the camera that are left. Textures of at
//! most [`WHOLE_BELOW`] texels for each pixel of the picture stay whole, and so do those of
//! programs, and those that cut out or blend in pictures with shadows, as shadow maps have their
//! own resolution.

use crate::materials::Texels;
use crate::options::{Ground, RenderOptions};
use crate::pbr_materials::textures_of;
use crate::scene_view::SceneView;
use estampe_scene::{AlphaMode, Material, Mesh, Scene, TextureRef, Workers};
use glam::{DMat4, DVec2, DVec3, Vec2};

/// Texels for each pixel of the picture up to which a texture is needed whole.
const WHOLE_BELOW: u64 = 4;

/// Levels of the greatest texture, and more.
const LEVELS: usize = 32;

/// The first mip level of each image of the scene that a picture with these options can sample: 0
/// is the whole image, `u32::MAX` means that no triangle shows it.
///
/// Images need no texels, only their sizes. The result is the same for every number of threads.
#[must_use]
pub fn first_levels(scene: &Scene, options: &RenderOptions, workers: Workers) -> Vec<u32> {
    let sizes = scene.images.iter().map(|image| (image.width, image.height));
    let mut needs: Vec<Need> = sizes.map(|size| Need::new(size, options)).collect();
    if options.program.is_none() && needs.iter().any(|need| !need.is_whole) {
        // A section that leaves nothing is an error later.
        let cut = options.cut(scene, workers).ok().flatten();
        let scene = cut.as_ref().map_or(scene, |cut| &cut.scene);
        let view = PictureView::new(scene, options, workers);
        let has_own_resolution = options.shadows || options.ground == Ground::Shadow;
        for (material, surface) in surfaces(scene) {
            let Some(material) = material else { continue };
            view.add_surface(&surface, &uses(material), &mut needs);
            if material.alpha_mode != AlphaMode::Opaque && has_own_resolution {
                for texture in uses(material) {
                    if let Some(need) = needs.get_mut(texture.image) {
                        need.is_whole = true;
                    }
                }
            }
        }
    }
    needs.iter().map(Need::level).collect()
}

/// [`first_levels`] of a texture of this size that replaces those of the scene, as
/// [`RenderOptions::texture`] does.
#[must_use]
pub fn first_level_of_texture(
    size: (u32, u32),
    scene: &Scene,
    options: &RenderOptions,
    workers: Workers,
) -> u32 {
    let mut needs = [Need::new(size, options)];
    if options.program.is_none() && !needs[0].is_whole {
        let cut = options.cut(scene, workers).ok().flatten();
        let scene = cut.as_ref().map_or(scene, |cut| &cut.scene);
        let view = PictureView::new(scene, options, workers);
        for (_, surface) in surfaces(scene) {
            view.add_surface(&surface, &[TextureRef::new(0)], &mut needs);
        }
    }
    needs[0].level()
}

/// The pixels that need an image from each level on.
struct Need {
    texels: f64,
    is_whole: bool,
    area_px: [f64; LEVELS],
}

impl Need {
    fn new((width, height): (u32, u32), options: &RenderOptions) -> Self {
        let texels = u64::from(width) * u64::from(height);
        let pixels = u64::from(options.width) * u64::from(options.height);
        Self {
            texels: texels as f64,
            is_whole: options.program.is_some() || texels <= WHOLE_BELOW * pixels,
            area_px: [0.0; LEVELS],
        }
    }

    fn level(&self) -> u32 {
        if self.is_whole {
            return 0;
        }
        let mut covered = 0.0;
        for (level, area) in (0..).zip(self.area_px) {
            covered += area;
            if covered >= 1.0 {
                return level;
            }
        }
        u32::MAX
    }
}

/// Triangles of a mesh with one material.
struct Piece<'s> {
    mesh: &'s Mesh,
    triangles: &'s [[u32; 3]],
}

/// The surfaces of all meshes with their materials.
fn surfaces(scene: &Scene) -> impl Iterator<Item = (Option<&Material>, Piece<'_>)> {
    scene.meshes.iter().flat_map(|mesh| {
        let whole = mesh
            .surfaces
            .is_empty()
            .then_some((None, &mesh.triangles[..]));
        let parts = mesh.surfaces.iter().map(|surface| {
            let material = surface.material.and_then(|at| scene.materials.get(at));
            let triangles = mesh.triangles.get(surface.triangles.clone());
            (material, triangles.unwrap_or_default())
        });
        let pieces = whole.into_iter().chain(parts);
        pieces.map(move |(material, triangles)| (material, Piece { mesh, triangles }))
    })
}

/// All textures of a material, for every shading.
fn uses(material: &Material) -> Vec<TextureRef> {
    let plain = [material.base_color_texture, material.bump_texture];
    let plain = plain.into_iter().flatten().map(TextureRef::new);
    let pbr = material
        .pbr
        .iter()
        .flat_map(|pbr| textures_of(pbr, Texels::Colors));
    plain.chain(pbr.map(|(texture, _)| texture)).collect()
}

/// The camera of a picture.
struct PictureView {
    clip_from_object: DMat4,
    /// The least w of what is visible.
    near: f64,
    /// The picture's pixels.
    pixels: f64,
}

impl PictureView {
    fn new(scene: &Scene, options: &RenderOptions, workers: Workers) -> Self {
        let view = SceneView::new(scene, options, workers);
        Self {
            clip_from_object: view.clip_from_unit() * view.space.unit_from_object_matrix(),
            near: view.least_w(),
            pixels: f64::from(options.width) * f64::from(options.height),
        }
    }

    /// Adds the needs of the triangles, which have these textures.
    fn add_surface(&self, piece: &Piece<'_>, textures: &[TextureRef], needs: &mut [Need]) {
        let second = piece.mesh.attribute(Mesh::UV1).map(|uvs| &uvs.values[..]);
        let second: Vec<Vec2> = match second {
            Some(values) if textures.iter().any(|texture| texture.uv_set == 1) => {
                let (pairs, _) = values.as_chunks();
                pairs.iter().map(|&uv| Vec2::from_array(uv)).collect()
            }
            _ => Vec::new(),
        };
        for (set, uvs) in [(0, &piece.mesh.uvs), (1, &second)] {
            let used = textures.iter().filter(|texture| texture.uv_set == set);
            // Each image, and the texels of a unit of texture coordinates; often the same for all.
            let mut units: Vec<(f64, Vec<usize>)> = Vec::new();
            for texture in used {
                let Some(need) = needs.get(texture.image).filter(|need| !need.is_whole) else {
                    continue;
                };
                let scale = texture.transform.scale.as_dvec2();
                let texels = need.texels * (scale.x * scale.y).abs();
                match units.iter_mut().find(|(known, _)| *known == texels) {
                    Some((_, images)) if images.contains(&texture.image) => {}
                    Some((_, images)) => images.push(texture.image),
                    None => units.push((texels, vec![texture.image])),
                }
            }
            if units.is_empty() || uvs.is_empty() {
                continue;
            }
            let mut of_units = vec![[0.0; LEVELS]; units.len()];
            for &triangle in piece.triangles {
                let Some((uv_per_px, area_px)) = self.seen(piece.mesh, uvs, triangle) else {
                    continue;
                };
                for ((texels, _), area) in units.iter().zip(&mut of_units) {
                    area[level(uv_per_px * texels)] += area_px;
                }
            }
            for ((_, images), area) in units.iter().zip(of_units) {
                for &image in images {
                    for (sum, area) in needs[image].area_px.iter_mut().zip(area) {
                        *sum += area;
                    }
                }
            }
        }
    }

    /// The least area in texture coordinates of a pixel in the triangle, and the triangle's area in
    /// pixels; `None` if it is invisible.
    fn seen(&self, mesh: &Mesh, uvs: &[Vec2], triangle: [u32; 3]) -> Option<(f64, f64)> {
        let corners = triangle.map(|vertex| {
            let position = mesh.positions[vertex as usize].as_dvec3();
            let clip = self.clip_from_object * position.extend(1.0);
            DVec3::new(clip.x, clip.y, clip.w)
        });
        let [a, b, c] = corners;
        let det = a.dot(b.cross(c)).abs();
        let (least, most) = (a.z.min(b.z).min(c.z), a.z.max(b.z).max(c.z));
        // NaN is invisible, too.
        let is_visible = most >= self.near && det > 0.0 && det.is_finite();
        if !is_visible {
            return None;
        }
        let [p, q, r] = triangle.map(|vertex| {
            let uv = uvs.get(vertex as usize).copied().unwrap_or_default();
            DVec2::new(f64::from(uv.x), f64::from(uv.y))
        });
        let area_uv = (q - p).perp_dot(r - p).abs() / 2.0;
        let nearest = least.max(self.near);
        let uv_per_px = area_uv * 8.0 * (nearest * nearest * nearest) / (det * self.pixels);
        let area_px = if least < self.near {
            self.pixels
        } else {
            det * self.pixels / (8.0 * a.z * b.z * c.z)
        };
        Some((uv_per_px, area_px))
    }
}

/// The first level that is needed where a pixel covers this area in texels, at least.
fn level(texels_per_px: f64) -> usize {
    let mut level = 0;
    let mut bound = 16.0;
    // NaN needs everything.
    while level + 1 < LEVELS && texels_per_px >= bound {
        level += 1;
        bound *= 4.0;
    }
    level
}

#[cfg(test)]
mod tests;
