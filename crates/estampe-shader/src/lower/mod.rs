//! An entry point of a module to a tree: calls inlined, aggregates taken apart, variables as values.
