//! The facts about contacts, in one program.

mod adaptive;
mod capped;
mod conditions;
mod contact;
mod dents;
mod friction;
mod friction_error;
mod held_approach;
mod hurst;
mod indentation;
mod layers;
mod layers_creep;
mod layers_line;
mod leakage;
mod line;
mod march;
mod material;
mod mdr;
mod motion;
mod operator;
mod quantities;
mod sliding;
mod stages;
mod temperature;
mod thin_sample;
mod time_error;
