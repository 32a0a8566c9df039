//! The facts about measured files, in one program.

mod curve_alternatives;
mod curve_ends;
mod curve_exports;
mod curve_files;
mod curve_hostile;
mod curve_spellings;
mod samples;
mod topography_formats;
mod topography_hostile;
mod topography_instruments;
mod topography_round_trip;
mod topography_text;
