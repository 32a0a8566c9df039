//! Progress on stderr: a live line in a terminal, plain lines now and then elsewhere.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use asperity_io::session::Progress;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::{terminal, words};

/// Time between two plain lines.
const PAUSE: Duration = Duration::from_secs(5);

/// Letters of the line of the contact area.
const SPARKS: usize = 16;

/// Who tells the progress.
pub enum Teller {
    /// A live line, and the contact area of the rows so far.
    Bar(ProgressBar, Vec<f64>),
    /// Plain lines.
    Lines {
        /// Start of the run, and the last line told.
        started: Instant,
        told: Option<Instant>,
    },
    /// Nobody.
    Silent,
}

impl Teller {
    /// A live line where stderr is a terminal, plain lines elsewhere.
    pub fn new(quiet: bool) -> Self {
        if quiet {
            return Teller::Silent;
        }
        if !std::io::stderr().is_terminal() {
            return Teller::Lines { started: Instant::now(), told: None };
        }
        let bar = ProgressBar::with_draw_target(Some(1), ProgressDrawTarget::stderr());
        let template = "{bar:20.cyan/dim} {pos}/{len} rows  {msg}  {elapsed} ({eta} left)";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style.progress_chars("━╸ "));
        }
        bar.enable_steady_tick(Duration::from_millis(250));
        Teller::Bar(bar, Vec::new())
    }

    /// One row more.
    pub fn tell(&mut self, progress: &Progress) {
        let row = progress.row;
        let state = format!(
            "t = {}, contact {:.2} %, {} iterations",
            words::quantity(row.time, "s", 1),
            100.0 * row.contact_fraction,
            row.iterations
        );
        match self {
            Teller::Bar(bar, areas) => {
                areas.push(row.contact_fraction);
                if bar.position() == 0 {
                    bar.set_length(progress.total as u64);
                    bar.set_position(progress.resumed as u64);
                    bar.reset_eta();
                }
                bar.set_position(progress.done as u64);
                bar.set_message(format!("area {}  {state}", terminal::sparkline(areas, SPARKS)));
            }
            Teller::Lines { started, told } => {
                let due = told.is_none_or(|told| told.elapsed() > PAUSE);
                if due || progress.done == progress.total {
                    let done = (progress.done - progress.resumed) as f64;
                    let rest = (progress.total - progress.done) as f64;
                    let left = started.elapsed().as_secs_f64() * rest / done.max(1.0);
                    let left = words::duration(left);
                    eprintln!("row {}/{}: {state}, {left} left", progress.done, progress.total);
                    *told = Some(Instant::now());
                }
            }
            Teller::Silent => {}
        }
    }

    /// Clears the line.
    pub fn end(&self) {
        if let Teller::Bar(bar, _) = self {
            bar.finish_and_clear();
        }
    }
}
