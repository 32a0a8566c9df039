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
    /// Held against what they are: in this pass so far, and in the last one.
    counting: usize,
    held: usize,
}

impl Latch {
    pub(super) fn new(cells: usize) -> Self {
        Latch {
            passes: 0,
            had_access: vec![false; cells],
            changes: vec![0; cells],
            with_access: vec![0.0; cells],
            counting: 0,
            held: 0,
        }
    }

    pub(super) fn clear(&mut self) {
        self.passes = 0;
        self.changes.fill(0);
        (self.counting, self.held) = (0, 0);
    }

    /// b of a cell in this pass \[Pa\]: what it is, or what it was with access, if the cell is held. Where both are the same but for
    /// `small`, holding it changes nothing.
    pub(super) fn hold(&mut self, cell: usize, has_access: bool, b: f64, small: f64) -> f64 {
        let changes = &mut self.changes[cell];
        if self.passes > 0 && has_access != self.had_access[cell] {
            *changes = changes.saturating_add(1);
        }
        self.had_access[cell] = has_access;
        if has_access {
            self.with_access[cell] = b;
        }
        if !(self.passes >= FIRST && *changes >= CHANGES) {
            return b;
        }
        let held = self.with_access[cell];
        self.counting += usize::from((held - b).abs() > small);
        held
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

    /// Cells that were held in the last pass against what they are.
    pub(super) fn held(&self) -> usize {
        self.held
    }
}
