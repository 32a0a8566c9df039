//! Cells whose tractions change again and again from pass to pass are held.
//!
//! A pocket whose throat opens when it is full and closes when it is empty has no fixed point, nor has a part of the gap between two throats
//! that open and close. Held cells make one: after finitely many of them the map of a pass is continuous. The state is then a solution for one
//! history of access that is possible. First cells are held that gain and lose the access to a reservoir, at what they had with it; later
//! cells whose traction goes up and down, the largest changes first, at its middle.

/// Pass from which on cells are held that gain and lose access, and changes after which they are.
const FIRST: usize = 40;
const CHANGES: u8 = 4;
/// Changes of its access after which a pocket has lost what it had before this row.
const VENTED: u8 = 6;
/// Pass from which on cells are held whose traction goes up and down.
const LATER: usize = 60;
/// Change of such a traction, over the largest one; a tenth of it every [`DECADE`] passes.
const SHARE: f64 = 1e-2;
const DECADE: f64 = 20.0;

/// What the cells did over the passes of a loop.
pub(super) struct Latch {
    passes: usize,
    cells: Vec<Cell>,
    /// Held against what they are: in this pass so far, and in the last one.
    counting: usize,
    pub(super) held: usize,
}

#[derive(Clone, Copy, Default)]
struct Cell {
    had_access: bool,
    accesses: u8,
    /// b of the last pass, and with access to the fluid of a reservoir \[Pa\].
    last: f64,
    with_access: f64,
    /// Whether b rose, and how often it turned.
    rose: bool,
    turns: u8,
    /// What b is held at.
    held_at: Option<f64>,
}

impl Latch {
    pub(super) fn new(cells: usize) -> Self {
        Latch { passes: 0, cells: vec![Cell::default(); cells], counting: 0, held: 0 }
    }

    pub(super) fn clear(&mut self) {
        self.passes = 0;
        self.cells.fill(Cell::default());
        (self.counting, self.held) = (0, 0);
    }

    /// b of a cell in this pass \[Pa\], held where it changes again and again. Changes below `small` are none; `largest` is that of all
    /// pressures.
    pub(super) fn hold(
        &mut self,
        number: usize,
        has_access: bool,
        b: f64,
        [small, largest]: [f64; 2],
    ) -> f64 {
        let cell = &mut self.cells[number];
        let change = b - cell.last;
        if self.passes > 0 {
            cell.accesses = cell.accesses.saturating_add(u8::from(has_access != cell.had_access));
            let is_turn = change.abs() > small && (change > 0.0) != cell.rose;
            cell.turns = cell.turns.saturating_add(u8::from(is_turn));
        }
        if change.abs() > small {
            cell.rose = change > 0.0;
        }
        let before = std::mem::replace(&mut cell.last, b);
        cell.had_access = has_access;
        if has_access {
            cell.with_access = b;
        }
        if cell.held_at.is_none() && self.passes >= LATER && cell.turns >= CHANGES {
            let least = SHARE * largest * libm::pow(0.1, (self.passes - LATER) as f64 / DECADE);
            cell.held_at = (change.abs() > least).then_some(0.5 * (b + before));
        }
        let gains_and_loses = self.passes >= FIRST && cell.accesses >= CHANGES;
        let held = cell.held_at.or(gains_and_loses.then_some(cell.with_access)).unwrap_or(b);
        self.counting += usize::from((held - b).abs() > small);
        held
    }

    /// b that a cell had when it last had access \[Pa\], if it has lost that again and again.
    pub(super) fn vented(&self, number: usize) -> Option<f64> {
        let cell = &self.cells[number];
        (cell.accesses >= VENTED).then_some(cell.with_access)
    }

    /// A pass is done.
    pub(super) fn pass(&mut self) {
        self.passes += 1;
        self.held = std::mem::take(&mut self.counting);
    }

    /// Whether cells may be held in this pass.
    pub(super) fn may_hold(&self) -> bool {
        self.passes >= FIRST
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_held_that_go_up_and_down_and_no_others() {
        let mut latch = Latch::new(3);
        let limits = [1e-6, 1.0];
        let mut last = [0.0; 3];
        for pass in 0..90 {
            let up = f64::from(pass % 2);
            // One gains and loses access, one goes up and down, one settles.
            last[0] = latch.hold(0, pass % 2 == 1, 0.5 * up, limits);
            last[1] = latch.hold(1, true, 0.3 * up, limits);
            last[2] = latch.hold(2, true, 0.9 + libm::pow(-0.5, f64::from(pass)), limits);
            latch.pass();
            // Its access changes in each pass after the first.
            assert_eq!(latch.vented(0), (pass >= 6).then_some(0.5), "{pass}");
            assert_eq!(latch.vented(1), None);
            if pass == 50 {
                assert_eq!((last[0], last[1], latch.held), (0.5, 0.0, 1));
            }
        }
        // After the last pass, an odd one.
        assert!((last[1] - 0.15).abs() < 1e-12 && (last[2] - 0.9).abs() < 1e-6, "{last:?}");
        latch.clear();
        assert_eq!(latch.hold(1, true, 0.3, limits), 0.3);
    }
}
