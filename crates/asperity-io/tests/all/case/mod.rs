//! Case files: the starter cases hold, and what is wrong is named with key, line and words.

mod cost;
mod errors;
mod examples;
mod fluid;
mod hostile;
mod layers;
mod line;
mod materials;
mod measured;
mod motion;
mod values;
