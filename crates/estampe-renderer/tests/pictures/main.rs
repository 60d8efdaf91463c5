//! Pictures of scenes, against the oracle and against themselves.

mod bump_maps;
mod cut_outs;
mod edges;
mod guides;
mod hostile_scenes;
mod illumination;
mod inspection_views;
mod light;
mod named_attributes;
mod pbr;
mod sections;
mod shadows;
mod stages;
mod support;
mod surface_points;
mod transmission;
mod transparency;
