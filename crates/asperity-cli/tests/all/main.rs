//! The command as a user meets it, in one program.

mod answers;
mod cli;
mod findings;
mod indentation;
mod leak;
mod line;
mod material;
mod new;
mod peers;
mod plot;
mod stress;
mod study;
mod surface;
