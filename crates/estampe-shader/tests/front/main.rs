//! The front end: modules that load, their values, and errors.

mod errors;
mod glsl_link;
mod glsl_text_errors;
mod glsl_type_errors;
mod glsl_use_errors;
mod glsl_values;
mod hostile;
mod wgsl_checks;
mod wgsl_errors;
