//! The iterations of a contact solver, from the events that it reports by the crate `tracing`.

use std::sync::{Arc, Mutex, PoisonError};

use tracing::field::{Field, Visit};
use tracing::span::{Attributes, Id, Record};
use tracing::{Event, Metadata, Subscriber};

/// One iteration: the state before it, and what it did.
#[derive(Clone, Debug, Default)]
pub struct Iteration {
    pub number: u64,
    pub residual: f64,
    /// Cells in the working set.
    pub working: f64,
    pub step: String,
    /// Convolutions so far.
    pub convolutions: u64,
}

impl Visit for Iteration {
    fn record_u64(&mut self, field: &Field, value: u64) {
        match field.name() {
            "iterations" => self.number = value,
            "convolutions" => self.convolutions = value,
            _ => {}
        }
    }

    fn record_f64(&mut self, field: &Field, value: f64) {
        match field.name() {
            "residual" => self.residual = value,
            "working" => self.working = value,
            _ => {}
        }
    }

    fn record_str(&mut self, field: &Field, value: &str) {
        if field.name() == "step" {
            value.clone_into(&mut self.step);
        }
    }

    fn record_debug(&mut self, field: &Field, value: &dyn std::fmt::Debug) {
        if field.name() == "step" {
            self.step = format!("{value:?}");
        }
    }
}

/// Keeps the iterations of the last solve on this thread.
#[derive(Clone, Default)]
struct Keeper(Arc<Mutex<Vec<Iteration>>>);

impl Subscriber for Keeper {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        metadata.is_event() && metadata.target().starts_with("asperity::contact")
    }

    fn event(&self, event: &Event<'_>) {
        let mut iteration = Iteration::default();
        event.record(&mut iteration);
        if iteration.step.is_empty() {
            return;
        }
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        // A solve that starts on coarser grids counts from the beginning on each: the finest comes last.
        if kept.last().is_some_and(|last| last.number >= iteration.number) {
            kept.clear();
        }
        kept.push(iteration);
    }

    fn new_span(&self, _: &Attributes<'_>) -> Id {
        Id::from_u64(1)
    }

    fn record(&self, _: &Id, _: &Record<'_>) {}

    fn record_follows_from(&self, _: &Id, _: &Id) {}

    fn enter(&self, _: &Id) {}

    fn exit(&self, _: &Id) {}
}

/// What `solve` returns, and its iterations.
pub fn traced<T>(solve: impl FnOnce() -> T) -> (T, Vec<Iteration>) {
    let keeper = Keeper::default();
    let solved = tracing::subscriber::with_default(keeper.clone(), solve);
    let kept = std::mem::take(&mut *keeper.0.lock().unwrap_or_else(PoisonError::into_inner));
    (solved, kept)
}
