//! The result: one Zarr v3 group.
