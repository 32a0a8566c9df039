//! The result store: what is written is what is read, whatever happens in between.

mod damage;
mod killed;
mod march;
mod overwrite;
mod python;
mod resume;
mod round_trip;

pub(crate) use crate::common::*;
