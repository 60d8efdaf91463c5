//! The front end: modules that load, their values, and errors.

mod diagnostics_complete;
mod diagnostics_glsl_buffers;
mod diagnostics_glsl_declare;
mod diagnostics_glsl_text;
mod diagnostics_glsl_use;
mod diagnostics_glsl_values;
mod diagnostics_limits;
mod diagnostics_link;
mod diagnostics_options;
mod diagnostics_spirv;
mod diagnostics_wgsl_interface;
mod diagnostics_wgsl_statements;
mod diagnostics_wgsl_support;
mod diagnostics_wgsl_types;
mod errors;
mod glsl_link;
mod glsl_text_errors;
mod glsl_type_errors;
mod glsl_use_errors;
mod glsl_values;
mod hostile;
mod wgsl_checks;
mod wgsl_errors;
