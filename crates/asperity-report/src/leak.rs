//! Figures of leakage at one state: where the fluid flows, and what is trapped.

use asperity::leakage::{CellKind, flux};
use asperity_io::answer::{Units, Validity};
use asperity_io::leakage::{Leak, Leakage};
use asperity_io::readable::quantity;
use ndarray::{Array2, ArrayView2, Zip};

use crate::figure::{Colours, Figure, Map, State, typeset};

/// Names and colours of the cells where the seal leaks.
const LEAKING: &[State] = &[
    ("closed", CLOSED),
    ("through passage", [86, 180, 233]),
    ("dead end", [230, 159, 0]),
    ("closed pocket", POCKET),
];
/// And where it is tight.
const TIGHT: &[State] = &[
    ("closed", CLOSED),
    ("open to the inlet", [86, 180, 233]),
    ("open to the outlet", [0, 158, 115]),
    ("closed pocket", POCKET),
];
pub(crate) const CLOSED: [u8; 3] = [110, 110, 108];
pub(crate) const POCKET: [u8; 3] = [213, 94, 0];
/// Decades of the flux that a map shows.
const DECADES: f64 = 4.0;

/// The leak of one state: passages and pockets, and the flow with its critical constriction; where it is tight the open gap.
/// `validity` is what the findings say of it.
pub fn state(
    leak: &Leak,
    found: &Leakage,
    validity: &Validity,
    gap: ArrayView2<'_, f64>,
    size: [f64; 2],
) -> Figure {
    let caption = format!("{}. {}", sentence(&leak.words()), words(found, validity));
    let maps = maps(found, gap, size);
    Figure::new(sentence(&validity.mark(heading(found, &Units::default()))))
        .with_all(maps)
        .panel_size([300.0, 260.0])
        .caption(caption)
}

/// Passages, and the flow; where it is tight, the gap of the cells that are open.
pub(crate) fn maps(found: &Leakage, gap: ArrayView2<'_, f64>, size: [f64; 2]) -> Vec<Map> {
    let number = |kind: &CellKind| match (kind, found.percolates) {
        (CellKind::Closed, _) => 0.0,
        (CellKind::Through, _) | (CellKind::AtInlet, false) => 1.0,
        (CellKind::AtInlet | CellKind::AtOutlet, _) => 2.0,
        (CellKind::Pocket, _) => 3.0,
    };
    let kinds = found.cells.map(number);
    let names = if found.percolates { LEAKING } else { TIGHT };
    let passages = Map::states("", names, kinds.view(), size);
    if found.percolates {
        return vec![passages.marked(found.critical), flow(found, gap, size).marked(found.critical)];
    }
    let open = (found.open_fraction > 0.0).then(|| open_gap(found, gap, size));
    std::iter::once(passages).chain(open).collect()
}

/// The gap of the open cells.
fn open_gap(found: &Leakage, gap: ArrayView2<'_, f64>, size: [f64; 2]) -> Map {
    let mut open = gap.to_owned();
    Zip::from(&mut open).and(&found.cells).for_each(|gap, kind| {
        if *kind == CellKind::Closed {
            *gap = f64::NAN;
        }
    });
    Map::new("Gap of the open cells", ["gap", "m"], Colours::Sequential, open.view(), size)
}

/// The flow per width over its largest value; blank in contact, the lowest colour where the fluid rests.
fn flow(found: &Leakage, gap: ArrayView2<'_, f64>, size: [f64; 2]) -> Map {
    let flux = flux(size, gap, found.pressure.view());
    let largest = flux.iter().copied().filter(|q| q.is_finite()).fold(0.0, f64::max);
    let least = 10f64.powf(-DECADES);
    let mut share = Array2::from_elem(flux.dim(), f64::NAN);
    Zip::from(&mut share).and(&flux).and(&found.cells).for_each(|share, q, kind| {
        if *kind != CellKind::Closed {
            *share = if largest > 0.0 { (q / largest).max(least) } else { least };
        }
    });
    let map = Map::new("Flow", ["flow over its largest", ""], Colours::Sequential, share.view(), size);
    Map { log: true, ..map.between([least, 1.0]) }
}

/// The same with a capital.
pub(crate) fn sentence(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

/// The leak in a few words.
pub(crate) fn heading(found: &Leakage, units: &Units) -> String {
    match found.leak_rate {
        _ if !found.percolates => "Tight".to_owned(),
        Some(leak_rate) => {
            format!("Leak rate {}", typeset(&units.rate(leak_rate, found.leak_rate_standard)))
        }
        None => format!("Hydraulic gap {}", quantity(found.hydraulic_gap, "m")),
    }
}

/// What is open and what is trapped, and of a leak that is not taken back the gaps.
pub(crate) fn words(found: &Leakage, validity: &Validity) -> String {
    let open = format!("{:.1} % of the cells are open", 100.0 * found.open_fraction);
    let trapped = match found.trapped_area {
        0.0 => String::new(),
        area => format!(", {} of them in pockets", quantity(area, "m2")),
    };
    if !validity.is_valid() {
        return format!("{open}{trapped}.");
    }
    if !found.percolates {
        return format!("Inlet and outlet are not connected. {open}{trapped}.");
    }
    format!(
        "Hydraulic gap {}, critical gap {} (circle). {open}{trapped}.",
        quantity(found.hydraulic_gap, "m"),
        quantity(found.critical_gap, "m")
    )
}
