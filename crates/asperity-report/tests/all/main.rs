//! Pictures and pages, in one program.

mod browser;
mod paper;
