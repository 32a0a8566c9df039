//! Case files: TOML text with units to the objects of the solver.
