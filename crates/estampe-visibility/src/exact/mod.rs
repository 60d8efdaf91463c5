//! Sides of planes without error, so that no two of them contradict each other.

mod expansion;
mod plane;
#[cfg(test)]
mod tests;

pub(crate) use plane::Plane;
