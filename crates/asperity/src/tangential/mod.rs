//! Tangential loads: friction and partial slip.

mod discs;
mod freedom;
mod operator;
mod solver;
#[cfg(test)]
mod tests;
mod vector;

pub(crate) use solver::{Given, Slip, SlipOutcome, SlipProblem, SlipSolver};
