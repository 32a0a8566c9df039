//! Sealed pockets: what is in a pocket stays in it, and its pressure follows from its volume V.
//!
//! ```text
//! liquid   p = p_c + B ln(V_c/V), not below 0: where it has more room than it fills, the rest is vapour
//! gas      p V = p_c V_c
//! ```
//!
//! A pocket is sealed in the first row in which no reservoir reaches it, with the pressure that it had before: p_c and V_c are of that
//! row. Before the first row the gap is full of fluid at the reference. A pocket that opens inside the contact is empty: a void, at the reference.
//! Pockets that become one add their masses; parts of one have one pressure in the first row in which they are apart. A pocket of which a reservoir
//! reaches a part has the pressure there.
//!
//! Given the rest, the volume grows with the pressure, by S = dV/dp >= 0, and the volume of the fluid falls with it. So each pass sets the
//! pressure p' of
//!
//! ```text
//! V + S (p' - p) = V_fluid(p')
//! ```
//!
//! which is Newton's step with the S of the pocket alone, well behaved for stiff fluids and for soft ones. What a pocket does to its neighbours
//! is less than what it does to itself, and left to the loop. S begins as that of a crack with the area A and the perimeter of the pocket,
//! 8/(3 pi) c A (2 A/perimeter), exact for a circle and within 8 % for a long strip; then it is that of the last two passes. A pocket that
//! a pass closes altogether is pressed open again, from p + the mean of the contact pressure over its cells.

use super::beside::Beside;
use crate::spots::Forest;

/// Contents of cells: that a reservoir reached them, or that no fluid was there.
const REACHED: f64 = -1.0;
const DRY: f64 = -2.0;
/// S over that of the pass before, at least and at most.
const CHANGE: [f64; 2] = [0.3, 10.0];
/// Changes of a volume below this share of it tell nothing of S.
const NOISE: f64 = 1e-6;
/// Share of the volume of all pockets that may be missing in the end.
const MISSING: f64 = 1e-4;

/// How the volume of a fluid falls with its pressure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Fluid {
    Liquid { bulk_modulus: f64 },
    Gas,
}

/// An amount of fluid: its volume at a pressure \[Pa, absolute\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Amount {
    pressure: f64,
    volume: f64,
}

impl Fluid {
    /// The volume of an amount at another pressure.
    fn volume(self, of: Amount, pressure: f64) -> f64 {
        match self {
            _ if of.volume == 0.0 || of.pressure == pressure => of.volume,
            Fluid::Liquid { bulk_modulus } => of.volume * libm::exp((of.pressure - pressure) / bulk_modulus),
            Fluid::Gas => of.volume * of.pressure / pressure,
        }
    }

    /// Two amounts together, at the larger pressure.
    fn add(self, a: Amount, b: Amount) -> Amount {
        let pressure = a.pressure.max(b.pressure);
        Amount { pressure, volume: self.volume(a, pressure) + self.volume(b, pressure) }
    }

    /// The pressure p' >= 0 at which an amount fills `room` + `yields` (p' - p); 0 where it does not.
    fn pressure(self, of: Amount, room: f64, yields: f64, p: f64) -> f64 {
        let lacks = |pressure: f64| room + yields * (pressure - p) - self.volume(of, pressure);
        let (mut low, mut high) = (0.0, of.pressure.max(p).max(p + (of.volume - room) / yields));
        if lacks(low) >= 0.0 {
            return low;
        }
        loop {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                return high;
            }
            if lacks(middle) < 0.0 { low = middle } else { high = middle }
        }
    }
}

/// A mean.
#[derive(Clone, Copy, Debug, Default)]
struct Mean {
    sum: f64,
    count: f64,
}

impl Mean {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.count += 1.0;
    }

    fn join(&mut self, other: Mean) {
        self.sum += other.sum;
        self.count += other.count;
    }

    fn get(self) -> Option<f64> {
        (self.count > 0.0).then(|| self.sum / self.count)
    }
}

/// A pocket of the last row.
#[derive(Clone, Copy, Debug, Default)]
struct Former {
    holds: Amount,
    cells: usize,
    /// Length of its edges.
    edges: f64,
    /// One of its cells that is in a pocket still.
    open: Option<usize>,
    /// The pressure of those that a reservoir reaches.
    vented: Mean,
    /// The pressure of all of them, with that of the contact.
    pressed: Mean,
}

/// A pocket of a pass: connected cells, or parts of the same former pocket.
#[derive(Clone, Copy, Debug, Default)]
struct Group {
    cells: usize,
    edges: f64,
    /// Volume.
    room: f64,
    /// The pressure with which it was found.
    found_with: Mean,
    /// What its cells had in the last row; and whether a reservoir reached one of them.
    had: Mean,
    is_new: bool,
    vented: Mean,
    holds: Amount,
    /// Former pockets in it, and the first of them.
    formers: usize,
    first: usize,
}

/// A pocket in the pass before.
#[derive(Clone, Copy, Debug)]
struct Seen {
    formers: usize,
    pressure: f64,
    room: f64,
    yields: f64,
}

/// What a pass found: which cells are pockets, those that a reservoir reaches, the pressure of those that lost it again and again \[Pa\],
/// gap \[m\], contact pressure and traction \[Pa\].
pub(super) struct Found<'a> {
    pub(super) is_pocket: &'a [bool],
    pub(super) reached: &'a [bool],
    pub(super) vented: &'a dyn Fn(usize) -> Option<f64>,
    pub(super) gap: &'a [f64],
    pub(super) contact: &'a [f64],
    pub(super) traction: &'a [f64],
}

/// The contents of sealed pockets.
pub(super) struct Sealed {
    fluid: Fluid,
    reference: f64,
    cell_area: f64,
    /// Of the last row: gap that the fluid of a cell fills at its pressure \[m\], or [`REACHED`] or [`DRY`].
    pub(super) contents: Vec<f64>,
    /// Number of the former pocket of each cell.
    numbers: Vec<Option<usize>>,
    formers: Vec<Former>,
    /// By the number of the first former pocket.
    seen: Vec<Option<Seen>>,
    compliance: f64,
    /// Of the last pass: contents, pressure \[Pa\] and gap \[m\] of the cells.
    next: Vec<f64>,
    pressure: Vec<f64>,
    gap: Vec<f64>,
    /// Volumes of all pockets, what they miss, and their vapour \[m³\].
    volume: f64,
    missing: f64,
    pub(super) vapour: f64,
}

impl Sealed {
    pub(super) fn new(fluid: Fluid, reference: f64, cell_area: f64, cells: usize) -> Self {
        Sealed {
            fluid,
            reference,
            cell_area,
            contents: vec![REACHED; cells],
            numbers: vec![None; cells],
            formers: vec![],
            seen: vec![],
            compliance: 0.0,
            next: vec![REACHED; cells],
            pressure: vec![f64::NAN; cells],
            gap: vec![0.0; cells],
            volume: 0.0,
            missing: 0.0,
            vapour: 0.0,
        }
    }

    pub(super) fn is_settled(&self) -> bool {
        self.missing <= MISSING * self.volume
    }

    /// dV/dp of a crack with this area and perimeter in cells.
    fn yields(&self, cells: usize, edges: f64) -> f64 {
        let area = cells as f64 * self.cell_area;
        8.0 / (3.0 * std::f64::consts::PI) * self.compliance * area * 2.0 * area / edges
    }

    /// Takes over the pockets of the last row, with the pressures `last`; the mean pressure rises, and theirs with it as far as they do not yield.
    pub(super) fn begin(
        &mut self,
        beside: &Beside,
        last: &[f64],
        compliance: f64,
        rise: f64,
        traction: &mut [f64],
    ) {
        self.compliance = compliance;
        self.formers.clear();
        let is_pocket: Vec<bool> = self.contents.iter().map(|content| *content >= 0.0).collect();
        let mut forest = beside.joined(&is_pocket);
        for cell in 0..is_pocket.len() {
            self.numbers[cell] = is_pocket[cell].then(|| {
                let root = forest.root(cell);
                // The root is the first cell of its pocket.
                if root == cell { self.formers.len() } else { self.numbers[root].unwrap_or_default() }
            });
            let Some(number) = self.numbers[cell] else { continue };
            if number == self.formers.len() {
                self.formers.push(Former::default());
            }
            let former = &mut self.formers[number];
            former.cells += 1;
            former.edges += beside.edges(cell, &is_pocket, self.cell_area);
            let volume = self.contents[cell] * self.cell_area;
            former.holds = self.fluid.add(former.holds, Amount { pressure: last[cell], volume });
        }
        let predicted: Vec<f64> = self
            .formers
            .iter()
            .map(|former| {
                let Amount { pressure, volume } = former.holds;
                let yields = self.yields(former.cells, former.edges);
                self.fluid.pressure(former.holds, volume, yields, pressure + rise)
            })
            .collect();
        for (b, number) in traction.iter_mut().zip(&self.numbers) {
            if let Some(number) = number.filter(|number| self.formers[*number].holds.volume > 0.0) {
                *b = predicted[number] - self.reference;
            }
        }
        self.begin_loop();
    }

    pub(super) fn begin_loop(&mut self) {
        self.seen.clear();
        self.seen.resize(self.formers.len(), None);
    }

    /// Writes the pressure of the cells in pockets, and of those that a pass has closed, over that of the cells that reservoirs reach.
    pub(super) fn fill(&mut self, beside: &Beside, last: &[f64], found: &Found<'_>, pressure: &mut [f64]) {
        (self.volume, self.missing, self.vapour) = (0.0, 0.0, 0.0);
        self.see_formers(found, pressure);
        let mut forest = beside.joined(found.is_pocket);
        let pockets = || (0..found.is_pocket.len()).filter(|cell| found.is_pocket[*cell]);
        for cell in pockets() {
            if let Some(other) = self.numbers[cell].and_then(|number| self.formers[number].open) {
                forest.join(cell, other);
            }
        }
        let (groups, numbers) = self.groups(beside, last, found, &mut forest);
        let filled: Vec<[f64; 2]> = groups.iter().map(|group| self.fill_group(group)).collect();
        self.next.fill(DRY);
        self.pressure.fill(f64::NAN);
        self.gap.copy_from_slice(found.gap);
        for (cell, number) in numbers.iter().enumerate() {
            if found.reached[cell] {
                self.next[cell] = REACHED;
            } else if let Some(number) = number {
                let [p, share] = filled[*number];
                (self.next[cell], self.pressure[cell]) = (share * found.gap[cell], p);
            }
        }
        self.press_open();
        for (to, p) in pressure.iter_mut().zip(&self.pressure).filter(|(_, p)| !p.is_nan()) {
            *to = *p;
        }
    }

    /// What has become of the pockets of the last row.
    fn see_formers(&mut self, found: &Found<'_>, pressure: &[f64]) {
        for former in &mut self.formers {
            (former.open, former.vented, former.pressed) = (None, Mean::default(), Mean::default());
        }
        for (cell, number) in self.numbers.iter().enumerate() {
            let Some(number) = number else { continue };
            let former = &mut self.formers[*number];
            former.pressed.add(found.traction[cell] + self.reference + found.contact[cell]);
            if found.is_pocket[cell] {
                former.open = former.open.or(Some(cell));
            } else if found.reached[cell] {
                former.vented.add(pressure[cell]);
            }
        }
    }

    /// The pockets, and their number at each cell.
    fn groups(
        &self,
        beside: &Beside,
        last: &[f64],
        found: &Found<'_>,
        forest: &mut Forest,
    ) -> (Vec<Group>, Vec<Option<usize>>) {
        let mut groups: Vec<Group> = vec![];
        let mut numbers = vec![None; found.is_pocket.len()];
        for cell in (0..numbers.len()).filter(|cell| found.is_pocket[*cell]) {
            let root = forest.root(cell);
            let number = *numbers[root].get_or_insert(groups.len());
            numbers[cell] = Some(number);
            if number == groups.len() {
                groups.push(Group::default());
            }
            let group = &mut groups[number];
            group.cells += 1;
            group.edges += beside.edges(cell, found.is_pocket, self.cell_area);
            group.room += found.gap[cell] * self.cell_area;
            group.found_with.add(found.traction[cell] + self.reference);
            if last[cell] >= 0.0 {
                group.had.add(last[cell]);
            }
            group.is_new |= self.contents[cell] == REACHED;
            if let Some(p) = (found.vented)(cell) {
                group.vented.add(p);
            }
        }
        for (number, former) in self.formers.iter().enumerate() {
            let Some(group) = former.open.and_then(|cell| numbers[cell]).map(|group| &mut groups[group])
            else {
                continue;
            };
            group.vented.join(former.vented);
            group.holds = self.fluid.add(group.holds, former.holds);
            group.first = if group.formers == 0 { number } else { group.first };
            group.formers += 1;
        }
        (groups, numbers)
    }

    /// The pressure of a pocket, and the share of it that its fluid fills.
    fn fill_group(&mut self, group: &Group) -> [f64; 2] {
        let (room, holds) = (group.room, group.holds);
        if let Some(p) = group.vented.get().or(group.had.get().filter(|_| group.is_new)) {
            return [p, 1.0];
        }
        let Some(p) = group.found_with.get().filter(|_| holds.volume > 0.0) else {
            return [self.reference, 0.0];
        };
        let seen = self.seen[group.first].filter(|seen| seen.formers == group.formers);
        let yields = seen.map_or_else(
            || self.yields(group.cells, group.edges),
            |seen| {
                let measured = (room - seen.room) / (p - seen.pressure);
                let tells = (room - seen.room).abs() > NOISE * room && measured > 0.0;
                let [least, most] = CHANGE.map(|change| change * seen.yields);
                if tells { measured.clamp(least, most) } else { seen.yields }
            },
        );
        self.seen[group.first] = Some(Seen { formers: group.formers, pressure: p, room, yields });
        let next = self.fluid.pressure(holds, room, yields, p);
        let volume = self.fluid.volume(holds, next);
        if next == 0.0 {
            self.vapour += room - volume;
        } else {
            self.missing += (room - self.fluid.volume(holds, p)).abs();
        }
        self.volume += room;
        [next, volume / room]
    }

    /// Pockets that the pass has closed: the pressure that opens them.
    fn press_open(&mut self) {
        let pressed: Vec<Option<[f64; 2]>> = self
            .formers
            .iter()
            .map(|former| {
                let is_closed = former.open.is_none() && former.vented.get().is_none();
                let p = former.pressed.get().filter(|_| is_closed && former.holds.volume > 0.0)?;
                let p = self.fluid.pressure(former.holds, 0.0, self.yields(former.cells, former.edges), p);
                let area = former.cells as f64 * self.cell_area;
                Some([p, self.fluid.volume(former.holds, p) / area])
            })
            .collect();
        for (cell, number) in self.numbers.iter().enumerate() {
            if let Some([p, content]) = number.and_then(|number| pressed[number]) {
                (self.next[cell], self.pressure[cell]) = (content, p);
            }
        }
    }

    /// The step stands, with the pressures that acted on the open cells; writes those that are remembered.
    pub(super) fn commit(&mut self, acting: &[f64], last: &mut [f64]) {
        for (cell, (p, content)) in self.pressure.iter().zip(&mut self.next).enumerate() {
            if *content < 0.0 {
                continue;
            }
            // What is held at another pressure is sealed anew.
            let is_held = (acting[cell] - p).abs() > NOISE * p.abs();
            if is_held {
                *content = self.gap[cell];
            } else {
                last[cell] = *p;
            }
        }
        self.contents.copy_from_slice(&self.next);
    }
}
