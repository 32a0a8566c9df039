//! Progress on stderr: a live line in a terminal, plain lines now and then elsewhere.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use asperity_io::session::Progress;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::{format, terminal};

/// Time between two plain lines.
const PAUSE: Duration = Duration::from_secs(5);

/// Letters of the line of the contact area.
const SPARKS: usize = 16;

/// Where the progress of a run is shown.
pub enum ProgressDisplay {
    /// A live line, and coordinates and contact areas of the rows so far.
    Bar(ProgressBar, [Vec<f64>; 2]),
    /// Plain lines.
    Lines {
        /// Start of the run, and the last line.
        started: Instant,
        printed: Option<Instant>,
        /// Time between two lines.
        pause: Duration,
    },
    /// Nowhere.
    Silent,
}

/// Parts of a run whose rows are not known beforehand.
const COURSE: u64 = 1_000_000;

/// Where the run began, is, and ends: in rows where their number is known, else in time.
fn course(progress: &Progress) -> [u64; 3] {
    match progress.total {
        Some(total) => [progress.resumed as u64, progress.done as u64, total as u64],
        None if progress.finished => [0, COURSE, COURSE],
        None => [
            0,
            (COURSE as f64 * (progress.row.coordinate.value() / progress.end).clamp(0.0, 1.0)) as u64,
            COURSE,
        ],
    }
}

/// "12/100", or "12".
fn rows(progress: &Progress) -> String {
    match progress.total {
        Some(total) => format!("{}/{total}", progress.done),
        None => progress.done.to_string(),
    }
}

impl ProgressDisplay {
    /// A live line where stderr is a terminal, plain lines elsewhere; a line for every row where that is asked for.
    pub fn new(quiet: bool, every_row: bool) -> Self {
        if quiet {
            return ProgressDisplay::Silent;
        }
        if every_row || !std::io::stderr().is_terminal() {
            let pause = if every_row { Duration::ZERO } else { PAUSE };
            return ProgressDisplay::Lines { started: Instant::now(), printed: None, pause };
        }
        let bar = ProgressBar::with_draw_target(Some(1), ProgressDrawTarget::stderr());
        let template = "{bar:20.cyan/dim} {prefix} rows  {msg}  {elapsed} ({eta} left)";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style.progress_chars("━╸ "));
        }
        // The clock is a thread of its own; without it the line moves at each row.
        if std::thread::Builder::new().spawn(|| ()).is_ok() {
            bar.enable_steady_tick(Duration::from_millis(250));
        }
        ProgressDisplay::Bar(bar, [vec![], vec![]])
    }

    /// One row more.
    pub fn update(&mut self, progress: &Progress) {
        if let Some([done, all]) = progress.stress {
            return self.update_stress(done, all);
        }
        let row = progress.row;
        let moment = format::coordinate(row.coordinate);
        let friction = progress.friction.map_or(String::new(), |f| format!(", friction {:.4}", f.of_all()));
        let state = format!(
            "{moment}, contact {:.2} %{friction}, {}",
            100.0 * row.contact_fraction,
            format::counted(row.iterations, "iteration")
        );
        match self {
            ProgressDisplay::Bar(bar, [coordinates, areas]) => {
                coordinates.push(row.coordinate.value());
                areas.push(row.contact_fraction);
                let [from, done, all] = course(progress);
                if bar.position() == 0 {
                    bar.set_length(all);
                    bar.set_position(from);
                    bar.reset_eta();
                }
                bar.set_position(done);
                bar.set_prefix(rows(progress));
                let bars = terminal::sparkline(row.coordinate.axis(), coordinates, areas, SPARKS);
                bar.set_message(format!("area {bars}  {state}"));
            }
            ProgressDisplay::Lines { started, printed, pause } => {
                let due = printed.is_none_or(|printed| printed.elapsed() >= *pause);
                if due || progress.finished {
                    let [from, done, all] = course(progress);
                    let rest = all.saturating_sub(done) as f64;
                    let left =
                        started.elapsed().as_secs_f64() * rest / done.saturating_sub(from).max(1) as f64;
                    // Time says little of the rows to come.
                    let left = match progress.total {
                        Some(_) => format::duration(left),
                        None => format!(
                            "{} of the time",
                            format::quantity(rest / COURSE as f64 * progress.end, "s")
                        ),
                    };
                    crate::messages::message!("row {}: {state}, {left} left", rows(progress));
                    *printed = Some(Instant::now());
                }
            }
            ProgressDisplay::Silent => {}
        }
    }

    /// The stress below the surface, after the last row.
    fn update_stress(&mut self, done: usize, all: usize) {
        let state = format!("stress below the surface: {done} of {all} times");
        match self {
            ProgressDisplay::Bar(bar, _) => bar.set_message(state),
            ProgressDisplay::Lines { printed, pause, .. } => {
                if printed.is_none_or(|printed| printed.elapsed() >= *pause) {
                    crate::messages::message!("{state}");
                    *printed = Some(Instant::now());
                }
            }
            ProgressDisplay::Silent => {}
        }
    }

    /// Clears the line.
    pub fn end(&self) {
        if let ProgressDisplay::Bar(bar, _) = self {
            bar.finish_and_clear();
        }
    }
}
