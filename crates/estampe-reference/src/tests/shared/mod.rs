//! What the core and the oracle share of `estampe-types`, against numbers of the specifications: comparing the two
//! cannot find a fault there. The list is in this crate's documentation.

mod formats;
mod layouts;
mod numbers;
mod vectors;
