//! The maps of a page: which instants, how fine, packed.

use asperity_io::store::{At, FieldKind, Reader, StoreError};
use ndarray::Array2;

use super::Options;
use super::blob::packed;
use crate::figure::{means, states};

/// The maps of a result, ready for the page.
pub(super) struct Maps {
    /// Name and bytes of each.
    pub(super) blobs: Vec<(String, Vec<u8>)>,
    /// The fields that are shown.
    pub(super) fields: Vec<FieldKind>,
    /// Indices of the instants among those of the result.
    pub(super) instants: Vec<usize>,
    /// Cells of a side of the blocks that became one.
    pub(super) block: usize,
    /// What is said of the undeformed surface; null for a smooth one.
    pub(super) surface: serde_json::Value,
}

impl Maps {
    pub(super) fn of(reader: &Reader, options: &Options) -> Result<Maps, StoreError> {
        let kinds = kinds(reader);
        let all = reader.field_times().len();
        let kept = if kinds.is_empty() { 0 } else { all.min(options.instants.max(1)) };
        let instants: Vec<usize> = (0..kept).map(|k| k * (all - 1) / (kept - 1).max(1)).collect();
        // Half of the 16 bits remain, and base64 adds a third; then as it turns out.
        let cells = reader.header().grid.len() as f64;
        let maps = (kinds.len() * instants.len() + 2) as f64;
        let mut block = (cells * maps * 1.4 / options.bytes.max(1) as f64).sqrt().floor().max(1.0) as usize;
        loop {
            let maps = Maps::reduced(reader, &kinds, &instants, block)?;
            let size: usize = maps.blobs.iter().map(|(_, bytes)| bytes.len() / 3 * 4).sum();
            let longest = reader.header().grid.cells().into_iter().max().unwrap_or(1);
            if size <= options.bytes || longest / block < 16 {
                return Ok(maps);
            }
            block += 1 + block / 4;
        }
    }

    /// Those of a page that asks for its maps one by one, at all instants.
    pub(super) fn live(reader: &Reader, with_surface: bool) -> Result<Maps, StoreError> {
        let surface = if with_surface { super::surface::surface(reader)? } else { None };
        Ok(Maps {
            blobs: Vec::new(),
            fields: kinds(reader),
            instants: (0..reader.field_times().len()).collect(),
            block: 1,
            surface: surface.map_or(serde_json::Value::Null, |(_, words)| words),
        })
    }

    fn reduced(
        reader: &Reader,
        kinds: &[FieldKind],
        instants: &[usize],
        block: usize,
    ) -> Result<Maps, StoreError> {
        let mut blobs =
            vec![("initial".to_owned(), packed(means(reader.initial_gap()?.view(), block).view()))];
        let mut surface = serde_json::Value::Null;
        if let Some((heights, words)) = super::surface::surface(reader)? {
            blobs.push(("surface".to_owned(), packed(means(heights.view(), block).view())));
            surface = words;
        }
        for kind in kinds {
            for (n, index) in instants.iter().enumerate() {
                let map = one(reader, *kind, At::Index(*index), block)?;
                blobs.push((format!("{}-{n}", kind.name()), packed(map.view())));
            }
        }
        Ok(Maps { blobs, fields: kinds.to_vec(), instants: instants.to_vec(), block, surface })
    }
}

/// One map, reduced.
pub(super) fn one(reader: &Reader, kind: FieldKind, at: At, block: usize) -> Result<Array2<f64>, StoreError> {
    if kind == FieldKind::Contact {
        return Ok(states(reader.contact_states(at)?.mapv(f64::from).view(), block));
    }
    Ok(means(reader.field(kind, at)?.view(), block))
}

/// The fields to show: those kept, and the contact, which any but displacement, flattening, attraction, traction and slip tells.
fn kinds(reader: &Reader) -> Vec<FieldKind> {
    let kept = &reader.header().fields;
    let tells = kept.iter().any(|kind| kind.tells_contact());
    let shown = |kind: &FieldKind| if *kind == FieldKind::Contact { tells } else { kept.contains(kind) };
    let mut kinds: Vec<FieldKind> = FieldKind::ALL.into_iter().filter(shown).collect();
    kinds.sort_by_key(|kind| kind.place());
    kinds
}
