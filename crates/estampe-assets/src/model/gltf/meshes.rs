//! The meshes of a scene's nodes: one mesh in world space for each primitive of each node.

use super::accessor::Accessors;
use super::choice::Choice;
use super::connectivity::Connectivity;
use super::document::{Document, Index, Primitive};
use super::fault::{element, shortened, warn};
use super::instances;
use super::placed::Placed;
use super::pose::Pose;
use super::skin::{Joint, Skin, Skins};
use super::vertices::{Vertices, active_targets};
use crate::model::load::Context;
use crate::{AssetError, Limits};
use estampe_scene::{Mesh, Surface};
use glam::{DAffine3, DVec3};

/// What meshes are made from.
pub(super) struct Source<'a> {
    pub(super) document: &'a Document<'a>,
    pub(super) accessors: &'a Accessors<'a>,
    pub(super) choice: &'a Choice,
    pub(super) pose: &'a Pose,
    pub(super) world_from_node: &'a [DAffine3],
}

/// The meshes, and which materials they use.
#[derive(Default)]
pub(super) struct Meshes {
    pub(super) meshes: Vec<Mesh>,
    /// The material of each mesh; `None` is the default material.
    pub(super) materials: Vec<Option<usize>>,
    totals: Totals,
    skins: Skins,
}

/// Numbers of elements so far, which limits bound.
#[derive(Debug, Default)]
struct Totals {
    vertices: u64,
    elements: u64,
    morphed_vertices: u64,
    instances: u64,
    /// Primitives of all nodes, with and without vertices, their morph targets and variants.
    visited: u64,
}

/// A node with a mesh.
struct Place<'a> {
    weights: &'a [f32],
    world_from_node: &'a DAffine3,
    /// The transforms of the instances; one that changes nothing if there are none.
    node_from_instances: Vec<DAffine3>,
    skin: Option<Skin>,
    name: &'a str,
}

impl Place<'_> {
    /// World units in a unit of the mesh: the side of the cube that a unit cube becomes, the mean
    /// of the instances. `None` if nothing is scaled, and for skins, whose vertices differ.
    fn scale(&self) -> Option<f32> {
        if self.skin.is_some() {
            return None;
        }
        let side = |transform: &DAffine3| {
            let linear = self.world_from_node.matrix3 * transform.matrix3;
            libm::cbrt(linear.determinant().abs())
        };
        let count = u32::try_from(self.node_from_instances.len()).unwrap_or(u32::MAX);
        let sum: f64 = self.node_from_instances.iter().map(side).sum();
        let mean = DVec3::splat(sum / f64::from(count.max(1))).as_vec3().x;
        (mean != 1.0 && mean.is_finite()).then_some(mean)
    }
}

impl Meshes {
    /// Makes the meshes of these nodes.
    pub(super) fn of_nodes(
        nodes: &[usize],
        source: &Source<'_>,
        context: &mut Context<'_>,
    ) -> Result<Self, AssetError> {
        let mut meshes = Self::default();
        for &node in nodes {
            if let Some(mesh) = source.document.nodes[node].mesh {
                meshes.add_node(node, mesh, source, context)?;
            }
        }
        Ok(meshes)
    }

    fn add_node(
        &mut self,
        index: usize,
        mesh_index: Index,
        source: &Source<'_>,
        context: &mut Context<'_>,
    ) -> Result<(), AssetError> {
        let document = source.document;
        let node = &document.nodes[index];
        let place = || format!("/nodes/{index}/mesh");
        let mesh = element(&document.meshes, mesh_index, "mesh", place)?;
        let instancing = node.extensions.instancing.as_deref();
        let node_from_instances = match instancing {
            Some(instancing) => {
                let pointer = format!("/nodes/{index}/extensions/EXT_mesh_gpu_instancing");
                let counted = self.totals.instances;
                let accessors = source.accessors;
                instances::transforms(instancing, accessors, counted, context.limits, &pointer)?
            }
            None => vec![DAffine3::IDENTITY],
        };
        if instancing.is_some() {
            self.totals.instances += node_from_instances.len() as u64;
        }
        let skin = node.skin.map(|skin| {
            let place = || format!("/nodes/{index}/skin");
            self.skins.get(skin, source, context.limits, place)
        });
        let animated = source.pose.of_node(index);
        let animated = animated.and_then(|pose| pose.weights.as_deref());
        let own = Some(&*node.weights).filter(|weights| !weights.is_empty());
        let place = Place {
            weights: animated.or(own).unwrap_or(&mesh.weights),
            world_from_node: &source.world_from_node[index],
            node_from_instances,
            skin: skin.transpose()?,
            name: if node.name.is_empty() {
                &mesh.name
            } else {
                &node.name
            },
        };
        for (at, primitive) in mesh.primitives.iter().enumerate() {
            let pointer = format!("/meshes/{mesh_index}/primitives/{at}");
            self.add_primitive(primitive, &place, source, &pointer, context)?;
        }
        Ok(())
    }

    fn add_primitive(
        &mut self,
        primitive: &Primitive,
        place: &Place<'_>,
        source: &Source<'_>,
        pointer: &str,
        context: &mut Context<'_>,
    ) -> Result<(), AssetError> {
        let accessors = source.accessors;
        self.totals
            .add_primitive(primitive, context.limits)
            .map_err(|error| error.at_json(pointer))?;
        let Some(&positions) = primitive.attributes.get("POSITION") else {
            warn(context, pointer, "a primitive without POSITION is left out");
            return Ok(());
        };
        if !Connectivity::is_known(primitive) {
            return Ok(());
        }
        let count = accessors.count(positions, || format!("{pointer}/attributes/POSITION"))?;
        let element_count = Connectivity::element_count(primitive, count, accessors, pointer)?;
        if count == 0 || element_count == 0 || place.node_from_instances.is_empty() {
            return Ok(());
        }
        let instances = place.node_from_instances.len();
        let morphs = active_targets(primitive, place.weights).count();
        self.totals
            .add([count, element_count, morphs], instances, context.limits)
            .map_err(|error| error.at_json(pointer))?;
        let vertices = Vertices::read(primitive, place.weights, count, accessors, pointer)?;
        let connected = Connectivity::read(primitive, count, accessors, pointer, context)?;
        let mut placed = Placed::new(&vertices, &connected, instances);
        match &place.skin {
            Some(skin) if !vertices.influences.is_empty() => {
                let unweighted = Joint::from_affine(place.world_from_node);
                let transforms =
                    skin.transforms(&vertices.influences, count, unweighted, pointer)?;
                placed.append_skinned(&vertices, &connected, &transforms);
            }
            _ => {
                for node_from_instance in &place.node_from_instances {
                    let world_from_object = *place.world_from_node * *node_from_instance;
                    placed.append(&vertices, &connected, &world_from_object);
                }
            }
        }
        let mut mesh = placed.into_mesh();
        mesh.name = shortened(place.name);
        mesh.scale = place.scale();
        mesh.surfaces = vec![Surface {
            material: None,
            triangles: 0..mesh.triangles.len(),
        }];
        self.materials.push(material(primitive, source, pointer)?);
        self.meshes.push(mesh);
        Ok(())
    }
}

impl Totals {
    /// Counts a primitive of a node before it is looked at.
    fn add_primitive(&mut self, primitive: &Primitive, limits: &Limits) -> Result<(), AssetError> {
        let variants = primitive.extensions.variants.as_deref();
        let variants = variants.map_or(0, |variants| variants.mappings.len());
        self.visited += (1 + primitive.targets.len() + variants) as u64;
        // Each has at least one vertex, or is of no use.
        let what = "primitives, morph targets and variants of nodes";
        Limits::check(what, self.visited, limits.max_vertices)
    }

    /// Adds a primitive of `count` vertices, `elements` and `morphs` active targets.
    fn add(
        &mut self,
        [count, elements, morphs]: [usize; 3],
        instances: usize,
        limits: &Limits,
    ) -> Result<(), AssetError> {
        let add = |total: &mut u64, count: usize, times: usize| {
            let more = (count as u64).saturating_mul(times as u64);
            *total = total.saturating_add(more);
            *total
        };
        let vertices = add(&mut self.vertices, count, instances);
        // Indices of vertices are 32 bits wide.
        let max_vertices = limits.max_vertices.min(u64::from(u32::MAX) - 1);
        Limits::check("vertices", vertices, max_vertices)?;
        let elements = add(&mut self.elements, elements, instances);
        Limits::check(
            "triangles, lines and points",
            elements,
            limits.max_triangles,
        )?;
        let morphed = add(&mut self.morphed_vertices, count, morphs);
        Limits::check("vertices of morph targets", morphed, limits.max_vertices)
    }
}

/// The material of a primitive: that of the chosen variant, or its own.
fn material(
    primitive: &Primitive,
    source: &Source<'_>,
    pointer: &str,
) -> Result<Option<usize>, AssetError> {
    let mappings = primitive.extensions.variants.as_deref();
    let mappings = mappings.map_or(&[][..], |variants| &variants.mappings);
    let chosen = source.choice.variant.and_then(|variant| {
        let is_chosen = |index: &Index| index.0 == variant;
        mappings
            .iter()
            .position(|mapping| mapping.variants.iter().any(is_chosen))
    });
    let (index, place) = match (chosen, primitive.material) {
        (Some(at), _) => (
            mappings[at].material,
            format!("{pointer}/extensions/KHR_materials_variants/mappings/{at}/material"),
        ),
        (None, Some(own)) => (own, format!("{pointer}/material")),
        (None, None) => return Ok(None),
    };
    element(&source.document.materials, index, "material", || place)?;
    Ok(Some(index.0))
}
