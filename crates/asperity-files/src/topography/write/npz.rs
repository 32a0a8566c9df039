//! NPZ: the arrays `heights` (nx, ny), `size` (Lx, Ly), the text `unit` = "m" of both, and the text `history` if the
//! surface has one, for `numpy.load`.

use std::io::Cursor;

use crate::npz::Npz;
use crate::topography::{Result, Topography};

pub(in crate::topography) fn encode(topography: &Topography) -> Result<Vec<u8>> {
    let (nx, ny) = topography.heights.dim();
    let mut npz = Npz::new(Cursor::new(Vec::with_capacity(8 * nx * ny + 1024)));
    npz.reals("heights", &[nx, ny], &topography.heights)?;
    npz.reals("size", &[2], &topography.size)?;
    npz.text("unit", "m")?;
    if let Some(history) = topography.history_line() {
        npz.text("history", &history)?;
    }
    Ok(npz.finish()?.into_inner())
}
