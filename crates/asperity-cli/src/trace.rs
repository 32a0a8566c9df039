//! Diagnostics on stderr: warnings always, and with `-vv` the iterations of every solve as a table.

use std::fmt::Write as _;
use std::sync::atomic::{AtomicBool, Ordering};

use tracing::field::{Field, Visit};
use tracing::span::{Attributes, Id, Record};
use tracing::{Event, Level, Metadata, Subscriber};

/// Where the contact solver's events come from.
const SOLVER: &str = "asperity::contact";
/// The columns of the table: a field of the event, its heading, and its width.
const COLUMNS: [(&str, &str, usize); 5] = [
    ("iterations", "iteration", 9),
    ("residual", "residual", 10),
    ("working", "working cells", 13),
    ("step", "step", 8),
    ("convolutions", "convolutions", 12),
];

/// Listens to the library; `verbose` is how often `-v` was given.
pub fn listen(verbose: u8) {
    // Fails only where another part of the process listens already.
    let _ = tracing::subscriber::set_global_default(Listener {
        with_table: verbose >= 2,
        headed: AtomicBool::new(false),
    });
}

/// Prints warnings, and one line for every iteration of the contact solver.
struct Listener {
    with_table: bool,
    headed: AtomicBool,
}

impl Subscriber for Listener {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        *metadata.level() <= Level::WARN || self.with_table && metadata.target().starts_with(SOLVER)
    }

    fn event(&self, event: &Event<'_>) {
        if *event.metadata().level() <= Level::WARN {
            let mut message = Message::default();
            event.record(&mut message);
            return crate::messages::message!("warning: {}", message.0);
        }
        let mut line = Line::default();
        event.record(&mut line);
        if line.is_first() || !self.headed.swap(true, Ordering::Relaxed) {
            let headings = COLUMNS.map(|(_, heading, width)| format!("{heading:>width$}"));
            crate::messages::message!("{}", headings.join("  "));
        }
        crate::messages::message!("{}", line.print());
    }

    // The library has events only.
    fn new_span(&self, _: &Attributes<'_>) -> Id {
        Id::from_u64(1)
    }

    fn record(&self, _: &Id, _: &Record<'_>) {}

    fn record_follows_from(&self, _: &Id, _: &Id) {}

    fn enter(&self, _: &Id) {}

    fn exit(&self, _: &Id) {}
}

/// The text of a warning.
#[derive(Default)]
struct Message(String);

impl Visit for Message {
    fn record_debug(&mut self, field: &Field, value: &dyn std::fmt::Debug) {
        if field.name() == "message" {
            self.0 = format!("{value:?}");
        }
    }
}

/// The values of one event, column by column.
#[derive(Default)]
struct Line([String; COLUMNS.len()]);

impl Line {
    /// Whether a solve begins.
    fn is_first(&self) -> bool {
        self.0[0] == "0"
    }

    fn print(&self) -> String {
        let mut line = String::new();
        for (n, (cell, (_, _, width))) in self.0.iter().zip(COLUMNS).enumerate() {
            let gap = if n > 0 { "  " } else { "" };
            let _ = write!(line, "{gap}{cell:>width$}");
        }
        line
    }

    fn set(&mut self, field: &Field, value: String) {
        if let Some(column) = COLUMNS.iter().position(|(name, ..)| *name == field.name()) {
            self.0[column] = value;
        }
    }
}

impl Visit for Line {
    fn record_f64(&mut self, field: &Field, value: f64) {
        let whole = field.name() != "residual";
        self.set(field, if whole { format!("{value:.0}") } else { format!("{value:.2e}") });
    }

    fn record_u64(&mut self, field: &Field, value: u64) {
        self.set(field, value.to_string());
    }

    fn record_debug(&mut self, field: &Field, value: &dyn std::fmt::Debug) {
        self.set(field, format!("{value:?}"));
    }
}
