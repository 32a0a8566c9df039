//! Measured topographies: one reader per format.
