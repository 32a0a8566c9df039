//! Diagnostics on stderr: warnings always, and with `-vv` the iterations of every solve as a table.

use std::fmt::Write as _;
use std::sync::atomic::{AtomicBool, Ordering};

use tracing::field::{Field, Visit};
use tracing::{Event, Level, Subscriber};
use tracing_subscriber::Layer;
use tracing_subscriber::layer::{Context, SubscriberExt};
use tracing_subscriber::util::SubscriberInitExt;

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
    let warnings = tracing_subscriber::fmt::layer()
        .with_writer(std::io::stderr)
        .with_ansi(std::io::IsTerminal::is_terminal(&std::io::stderr()))
        .with_target(false)
        .without_time()
        .log_internal_errors(false)
        .with_filter(tracing_subscriber::filter::LevelFilter::WARN);
    let table = (verbose >= 2).then(Table::default);
    // Fails only where another part of the process listens already.
    let _ = tracing_subscriber::registry().with(warnings).with(table).try_init();
}

/// Prints one line for every iteration of the contact solver.
#[derive(Default)]
struct Table {
    headed: AtomicBool,
}

impl<S: Subscriber> Layer<S> for Table {
    fn enabled(&self, metadata: &tracing::Metadata<'_>, _: Context<'_, S>) -> bool {
        *metadata.level() <= Level::WARN || metadata.target().starts_with(SOLVER)
    }

    fn on_event(&self, event: &Event<'_>, _: Context<'_, S>) {
        if !event.metadata().target().starts_with(SOLVER) {
            return;
        }
        let mut line = Line::default();
        event.record(&mut line);
        if line.is_first() || !self.headed.swap(true, Ordering::Relaxed) {
            let headings = COLUMNS.map(|(_, heading, width)| format!("{heading:>width$}"));
            crate::messages::message!("{}", headings.join("  "));
        }
        crate::messages::message!("{}", line.print());
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
