//! The draws of a frame in their order: opaque surfaces, lines and points in scene order, then
//! lines around the model, transparent surfaces, and edges over all.
//!
//! | transparency | draws of transparent surfaces |
//! |---|---|
//! | sorted | triangles back to front |
//! | exact | surfaces in scene order, to find layers and to blend them; the same as sorted, for what is left after the most layers |
//! | weighted | surfaces in scene order |

mod drawing;
mod overlays;
mod planner;
mod points_and_lines;
mod surfaces;

pub(crate) use drawing::DrawPlan;
pub(crate) use planner::Planner;
pub(crate) use points_and_lines::is_dark;
