//! From shapes and heights to the undeformed gap.
