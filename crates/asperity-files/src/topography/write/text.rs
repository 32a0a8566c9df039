//! Text matrix with the header of Gwyddion's text export.

use rayon::prelude::*;

use super::title;
use crate::topography::{Result, Topography};

/// The shortest decimal numbers that give the same heights back.
pub(in crate::topography) fn encode(topography: &Topography) -> Result<Vec<u8>> {
    let [lx, ly] = topography.size;
    // A line break in the name would end the line.
    let title = title(topography).replace(['\n', '\r'], " ");
    let mut bytes =
        format!("# Channel: {title}\n# Width: {lx:e} m\n# Height: {ly:e} m\n# Value units: m\n").into_bytes();
    if let Some(history) = topography.history_line() {
        bytes.extend(format!("# History: {history}\n").bytes());
    }
    let lines: Vec<String> = topography
        .heights
        .columns()
        .into_iter()
        .collect::<Vec<_>>()
        .into_par_iter()
        .map(|line| {
            let mut text = String::with_capacity(24 * line.len());
            for (i, height) in line.iter().enumerate() {
                if i > 0 {
                    text.push('\t');
                }
                if height.is_nan() {
                    text.push_str("nan");
                } else {
                    text.push_str(&format!("{height:e}"));
                }
            }
            text.push('\n');
            text
        })
        .collect();
    bytes.extend(lines.iter().flat_map(|l| l.bytes()));
    Ok(bytes)
}
