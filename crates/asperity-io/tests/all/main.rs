//! The facts about cases, files and results, in one program.

mod case;
mod changed_data;
mod common;
mod curve_files;
mod curve_hostile;
mod error_bars;
mod export;
mod findings;
mod golden;
mod leakage;
mod programme;
mod samples;
mod store;
mod stress;
mod topography_formats;
mod topography_hostile;
mod topography_instruments;
mod topography_round_trip;
mod topography_text;
mod wording;
