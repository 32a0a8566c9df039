//! Pictures and pages, in one program.

mod browser;
mod friction;
mod paper;
