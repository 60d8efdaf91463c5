//! The command, end to end: its subcommands, errors and pages.

mod batch;
mod book;
mod completions;
mod compute;
mod depth;
mod depth_page;
mod errors;
mod gltf;
mod inspect;
mod inspect_page;
mod ladder;
mod man;
mod output;
mod passes;
mod picture_options;
mod polygon_fill;
mod presets;
mod render;
mod render_page;
mod render_shader;
mod shader_check;
mod shader_dump;
mod shader_image;
mod shader_page;
mod shader_reflect;
mod shape;
mod shapes_page;
mod support;
mod system_libraries;
mod thumbnailer;
mod transparency;
mod turntable;
mod turntable_page;
#[cfg(unix)]
mod watch;
