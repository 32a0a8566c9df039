//! Cells whose access to the fluid changes again and again from pass to pass are held at what they had with it.
//!
//! A pocket whose throat opens when it is full and closes when it is empty has no fixed point. Held cells make one: after finitely many
//! of them the map of a pass is continuous. The state is then a solution for one history of access that is possible.

/// Pass from which on cells are held.
const FIRST: usize = 15;
/// Changes of a cell after which it is held.
const CHANGES: u8 = 4;

/// The access of each cell over the passes of a loop.
pub(super) struct Latch {
    passes: usize,
    had_access: Vec<bool>,
    changes: Vec<u8>,
    /// b with access to the fluid of a reservoir \[Pa\].
    with_access: Vec<f64>,
    held: usize,
}

impl Latch {
    pub(super) fn new(cells: usize) -> Self {
        Latch {
            passes: 0,
            had_access: vec![false; cells],
            changes: vec![0; cells],
            with_access: vec![0.0; cells],
            held: 0,
        }
    }

    pub(super) fn clear(&mut self) {
        self.passes = 0;
        self.changes.fill(0);
        self.held = 0;
    }

    /// b of a cell in this pass \[Pa\]: what it is, or what it was with access, if the cell is held.
    pub(super) fn hold(&mut self, cell: usize, has_access: bool, b: f64) -> f64 {
        let changes = &mut self.changes[cell];
        if self.passes == 0 {
            self.held = 0;
        } else if has_access != self.had_access[cell] {
            *changes = changes.saturating_add(1);
        }
        self.had_access[cell] = has_access;
        if has_access {
            self.with_access[cell] = b;
        }
        match self.passes >= FIRST && *changes >= CHANGES {
            true => self.with_access[cell],
            false => b,
        }
    }

    /// A pass is done.
    pub(super) fn pass(&mut self) {
        self.passes += 1;
        let is_held = |changes: &&u8| **changes >= CHANGES;
        self.held = if self.passes > FIRST { self.changes.iter().filter(is_held).count() } else { 0 };
    }

    /// Whether cells may be held in this pass.
    pub(super) fn may_hold(&self) -> bool {
        self.passes >= FIRST
    }

    /// Cells held in the last pass.
    pub(super) fn held(&self) -> usize {
        self.held
    }
}
