//! Source text to a checked module.
