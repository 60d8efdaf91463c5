//! The functions of `estampe-types` that both the core and the oracle use, against numbers of the
//! specifications. Comparing the core with the oracle cannot find a fault there. The list is in
//! this crate's documentation.

mod formats;
mod layouts;
mod numbers;
mod points;
mod vectors;
