//! Facts of a file that its scene does not keep: the tree of nodes, extensions, and which normals
//! are made.

/// What a file has besides its scene, for reports.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ModelContents {
    /// The nodes of the scene, parents before their children, in file order; empty in formats
    /// without a hierarchy.
    pub nodes: Vec<ModelNode>,
    /// Names of the extensions that the file says it uses.
    pub extensions: Vec<String>,
    /// For each mesh of the scene: true if its normals are made by the reader.
    pub has_made_normals: Vec<bool>,
    /// For each image of the scene: width and height in the file, before the image was reduced.
    pub image_sizes: Vec<(u32, u32)>,
}

/// A node of the hierarchy.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ModelNode {
    /// Name in the file; may be empty.
    pub name: String,
    /// Number of ancestors: 0 is a root.
    pub depth: usize,
    /// Name of its mesh, which may be empty; `None` if it has none.
    pub mesh: Option<String>,
    /// Number of places of its mesh.
    pub instances: usize,
    /// True if joints move its mesh.
    pub has_skin: bool,
    /// True if a camera is at the node.
    pub has_camera: bool,
    /// True if a light is at the node.
    pub has_light: bool,
}
