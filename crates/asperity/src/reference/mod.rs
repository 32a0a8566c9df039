//! Closed forms and one-dimensional solutions to check against.
