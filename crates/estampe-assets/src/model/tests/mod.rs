//! Tests of the parts that the readers share.

mod normals;
mod numbers;
mod resources;
