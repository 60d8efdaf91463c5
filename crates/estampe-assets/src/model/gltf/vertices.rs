//! The vertices of a primitive in the space of its node, with its morph targets applied.

use super::accessor::{Accessors, Elements};
use super::document::{Index, Primitive};
use super::fault::malformed;
use crate::AssetError;
use glam::{Vec2, Vec3};
use std::collections::BTreeMap;

/// Vertex arrays: empty, or as long as `positions`.
#[derive(Debug, Default)]
pub(super) struct Vertices {
    pub(super) positions: Vec<Vec3>,
    /// As they are in the file: not necessarily of unit length.
    pub(super) normals: Vec<Vec3>,
    pub(super) tangents: Vec<[f32; 4]>,
    pub(super) uvs: Vec<Vec2>,
    pub(super) uvs1: Vec<[f32; 2]>,
    /// Linear, 0..1.
    pub(super) colors: Vec<[f32; 4]>,
    pub(super) influences: Vec<Influences>,
}

/// The joints that move each vertex: one set, or two.
#[derive(Debug)]
pub(super) struct Influences {
    pub(super) joints: Vec<[u32; 4]>,
    pub(super) weights: Vec<[f32; 4]>,
}

/// The attributes of a primitive.
struct Attributes<'a> {
    map: &'a BTreeMap<String, Index>,
    accessors: &'a Accessors<'a>,
    /// Number of elements of each.
    count: usize,
    pointer: &'a str,
}

impl Attributes<'_> {
    fn get(&self, name: &str) -> Result<Option<Elements<'_>>, AssetError> {
        let Some(&index) = self.map.get(name) else {
            return Ok(None);
        };
        let place = || format!("{}/{name}", self.pointer);
        let elements = self.accessors.get(index, place)?;
        if elements.count != self.count {
            let what = format!("{} elements for {} vertices", elements.count, self.count);
            return Err(malformed(place(), what));
        }
        Ok(Some(elements))
    }

    fn floats<const N: usize>(&self, name: &str) -> Result<Vec<[f32; N]>, AssetError> {
        let elements = self.get(name)?;
        elements.map_or(Ok(Vec::new()), |elements| elements.floats())
    }

    fn vec3s(&self, name: &str) -> Result<Vec<Vec3>, AssetError> {
        // The memory is reused: the elements have the same size and alignment.
        let arrays = self.floats::<3>(name)?;
        Ok(arrays.into_iter().map(Vec3::from_array).collect())
    }

    /// Colours with three or four components.
    fn colors(&self) -> Result<Vec<[f32; 4]>, AssetError> {
        let Some(elements) = self.get("COLOR_0")? else {
            return Ok(Vec::new());
        };
        if elements.width != 3 {
            return elements.floats();
        }
        let opaque = |[r, g, b]: [f32; 3]| [r, g, b, 1.0];
        Ok(elements.floats()?.into_iter().map(opaque).collect())
    }
}

impl Vertices {
    /// Reads the attributes of `count` vertices. `weights` are those of the morph targets.
    pub(super) fn read(
        primitive: &Primitive,
        weights: &[f32],
        count: usize,
        accessors: &Accessors<'_>,
        pointer: &str,
    ) -> Result<Self, AssetError> {
        let attributes_pointer = format!("{pointer}/attributes");
        let attributes = Attributes {
            map: &primitive.attributes,
            accessors,
            count,
            pointer: &attributes_pointer,
        };
        let uvs = attributes.floats::<2>("TEXCOORD_0")?;
        let mut vertices = Self {
            positions: attributes.vec3s("POSITION")?,
            normals: attributes.vec3s("NORMAL")?,
            tangents: attributes.floats("TANGENT")?,
            uvs: uvs.into_iter().map(Vec2::from_array).collect(),
            uvs1: attributes.floats("TEXCOORD_1")?,
            colors: attributes.colors()?,
            influences: Vec::new(),
        };
        for set in 0..2 {
            let weights = attributes.floats(&format!("WEIGHTS_{set}"))?;
            let joints = attributes.get(&format!("JOINTS_{set}"))?;
            if let Some(joints) = joints.filter(|_| !weights.is_empty()) {
                let joints = joints.integers()?;
                vertices.influences.push(Influences { joints, weights });
            }
        }
        for (at, target) in active_targets(primitive, weights) {
            let target_pointer = format!("{pointer}/targets/{at}");
            let target = Attributes {
                map: target,
                pointer: &target_pointer,
                ..attributes
            };
            vertices.add(&target, weights[at])?;
        }
        vertices.make_valid();
        Ok(vertices)
    }

    /// Adds a morph target.
    fn add(&mut self, target: &Attributes<'_>, weight: f32) -> Result<(), AssetError> {
        add_vectors(&mut self.positions, &target.vec3s("POSITION")?, weight);
        add_vectors(&mut self.normals, &target.vec3s("NORMAL")?, weight);
        add_vectors(&mut self.uvs, &vec2s(&target.floats("TEXCOORD_0")?), weight);
        let tangents = target.floats::<3>("TANGENT")?;
        for (tangent, change) in self.tangents.iter_mut().zip(tangents) {
            for (value, change) in tangent.iter_mut().zip(change) {
                *value += weight * change;
            }
        }
        for (uv, change) in self.uvs1.iter_mut().zip(target.floats("TEXCOORD_1")?) {
            let change: [f32; 2] = change;
            *uv = [uv[0] + weight * change[0], uv[1] + weight * change[1]];
        }
        // A change of a colour without alpha leaves alpha as it is.
        if let Some(elements) = target.get("COLOR_0")? {
            let changes: Vec<[f32; 4]> = if elements.width == 3 {
                let without_alpha = |[r, g, b]: [f32; 3]| [r, g, b, 0.0];
                elements.floats()?.into_iter().map(without_alpha).collect()
            } else {
                elements.floats()?
            };
            for (color, change) in self.colors.iter_mut().zip(changes) {
                *color = std::array::from_fn(|i| color[i] + weight * change[i]);
            }
        }
        Ok(())
    }

    /// Colours in 0..1, and finite texture coordinates and tangents.
    fn make_valid(&mut self) {
        for value in self.colors.as_flattened_mut() {
            // `max` turns NaN into 0.
            *value = value.max(0.0).clamp(0.0, 1.0);
        }
        for uv in &mut self.uvs1 {
            if !(uv[0].is_finite() && uv[1].is_finite()) {
                *uv = [0.0; 2];
            }
        }
        for tangent in &mut self.tangents {
            tangent[3] = if tangent[3] < 0.0 { -1.0 } else { 1.0 };
        }
    }
}

/// The morph targets whose weight is not 0.
pub(super) fn active_targets<'a>(
    primitive: &'a Primitive,
    weights: &'a [f32],
) -> impl Iterator<Item = (usize, &'a BTreeMap<String, Index>)> {
    let weighted = primitive.targets.iter().zip(weights).enumerate();
    weighted
        .filter(|(_, (_, weight))| **weight != 0.0)
        .map(|(at, (target, _))| (at, target))
}

fn vec2s(values: &[[f32; 2]]) -> Vec<Vec2> {
    values.iter().copied().map(Vec2::from_array).collect()
}

fn add_vectors<T>(values: &mut [T], changes: &[T], weight: f32)
where
    T: Copy + std::ops::AddAssign + std::ops::Mul<f32, Output = T>,
{
    for (value, &change) in values.iter_mut().zip(changes) {
        *value += change * weight;
    }
}
