//! Geometry of a scene for drawing: a unit space for the model, vertex buffers, and the order of
//! transparent triangles.
//!
//! * [`unit_space`]: the box around the model becomes the cube −1..1, in f64;
//! * [`vertex_data`]: buffers of positions, normals, uv and colours, copied from the mesh's arrays;
//! * [`faces`]: triangles without shared vertices, for flat shading and wireframes;
//! * [`order`]: back-to-front order.

pub(crate) mod face_colors;
pub(crate) mod faces;
pub(crate) mod order;
pub(crate) mod tangents;
pub(crate) mod unit_space;
pub(crate) mod vertex_data;

#[cfg(test)]
mod tangent_tests;
#[cfg(test)]
mod tests;
