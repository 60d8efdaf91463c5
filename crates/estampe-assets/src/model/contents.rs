//! Facts of a file that its scene does not keep: the tree of nodes, extensions, and which normals
//! are made.

/// The contents of a file besides its scene, for reports.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ModelContents {
    /// The nodes of the scene, parents before their children, in file order, at most
    /// [`MAX_NODES`](Self::MAX_NODES); empty in formats without a hierarchy.
    pub nodes: Vec<ModelNode>,
    /// Number of all nodes of the scene.
    pub node_count: usize,
    /// Names of the extensions that the file says it uses, at most
    /// [`MAX_EXTENSIONS`](Self::MAX_EXTENSIONS).
    pub extensions: Vec<String>,
    /// For each mesh of the scene: true if its normals are made by the reader.
    pub has_made_normals: Vec<bool>,
    /// For each image of the scene: width and height in the file, before the image was reduced.
    pub image_sizes: Vec<(u32, u32)>,
}

impl ModelContents {
    /// The nodes that are kept: a small file can have many that name one long name.
    pub const MAX_NODES: usize = 10_000;
    /// The extensions that are kept.
    pub const MAX_EXTENSIONS: usize = 1000;
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
