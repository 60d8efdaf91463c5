//! From a scene's meshes to what draws read: a space of its own for every model, vertex buffers, and
//! the order in which transparent triangles are drawn.
//!
//! * [`unit_space`]: the box around the model becomes the cube −1..1, in f64;
//! * [`vertex_data`]: buffers of positions, normals, uv and colours, straight from the arrays;
//! * [`faces`]: triangles that share no vertices, for flat shading and wireframes;
//! * [`order`]: back to front.

pub(crate) mod faces;
pub(crate) mod order;
pub(crate) mod unit_space;
pub(crate) mod vertex_data;

#[cfg(test)]
mod tests;
