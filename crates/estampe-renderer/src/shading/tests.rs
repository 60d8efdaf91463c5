//! Shaders on lone fragments.
