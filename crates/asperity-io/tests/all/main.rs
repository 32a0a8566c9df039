//! The facts about cases, files and results, in one program.

mod case;
mod changed_data;
mod combinations;
mod common;
mod error_bars;
mod export;
mod findings;
mod golden;
mod leakage;
mod programme;
mod steady_states;
mod store;
mod stress;
mod wording;
