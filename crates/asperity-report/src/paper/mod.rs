//! The figures of Spinu & Cerlinca, Modelling and Simulation in Engineering 2017, 2521903 ("SC17"), computed
//! again: each with an independent curve drawn over it and the difference as a number.
//!
//! | figure | shows | independent |
//! |---|---|---|
//! | 1 | pressure under a sphere on a Zener solid, step load | the paper's closed form (eq. 21, its misprints corrected) |
//! | 2 | pressure under a sphere with a cut-off | axisymmetric solution ([`CappedHertz`](asperity::reference::CappedHertz)) |
//! | 3 | creep compliance of PMMA | numerical solution of the convolution of creep and relaxation |
//! | 4 | load over depth, triangular load | Ting's solution |
//! | 5 | undeformed gap of the rough sphere | what was asked of the roughness |
//! | 6, 7 | contact at 0 and 500 s | SC17's method: full hereditary sum, Polonsky and Keer |
//! | 8 | contact area and approach over time | the same, and elastic solutions at both ends of time |

mod creep;
mod rough;
mod sphere;

use std::path::{Path, PathBuf};

use asperity_io::case::{Case, CaseErrors};
use asperity_io::session::{RunError, RunOptions, run};
use asperity_io::store::{Reader, StoreError};

use crate::figure::Figure;
use crate::result::PlotError;

/// The figures that there are.
pub const FIGURES: [u8; 8] = [1, 2, 3, 4, 5, 6, 7, 8];

/// One figure of the paper, computed again.
#[derive(Clone, Debug, PartialEq)]
pub struct Reproduction {
    /// Its number in the paper.
    pub number: u8,
    /// What it shows.
    pub title: String,
    /// The figure, with the independent curve and the differences in its caption.
    pub figure: Figure,
    /// How far the two are apart.
    pub differences: Vec<Difference>,
}

/// A difference between a figure and what is independent of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// The quantity, and what it is compared with.
    pub quantity: String,
    /// The difference.
    pub value: f64,
    /// What it is a share of.
    pub of: &'static str,
}

/// How the figures are computed.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Directory of the results that the figures are drawn from; results there are replaced.
    pub results: PathBuf,
    /// Cells along a side of each case; `None` as in the case files.
    pub cells: Option<usize>,
}

/// Why a figure was not computed.
#[derive(Debug, thiserror::Error)]
pub enum PaperError {
    /// The case does not fit.
    #[error(transparent)]
    Case(#[from] CaseErrors),
    /// A step was not solved, or the result not stored.
    #[error(transparent)]
    Run(#[from] RunError),
    /// A result cannot be read.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// A figure of a result cannot be drawn.
    #[error(transparent)]
    Plot(#[from] PlotError),
    /// A closed form refused its numbers.
    #[error(transparent)]
    Reference(#[from] asperity::Error),
}

type Result<T> = std::result::Result<T, PaperError>;

/// Computes figures of the paper, each named in [`FIGURES`], in that order.
///
/// # Errors
/// [`PaperError`] where a case cannot be run, for example as the disk is full.
pub fn reproduce(numbers: &[u8], options: &Options) -> Result<Vec<Reproduction>> {
    let wanted = |number: u8| numbers.contains(&number);
    let mut done = Vec::new();
    if wanted(1) {
        done.push(sphere::zener_step(options)?);
    }
    if wanted(2) {
        done.push(sphere::capped(options)?);
    }
    if wanted(3) {
        done.push(creep::pmma()?);
    }
    if wanted(4) {
        done.push(sphere::triangle(options)?);
    }
    if (5..=8).any(wanted) {
        let all = rough::figures(options, (6..=8).any(wanted))?;
        done.extend(all.into_iter().filter(|figure| wanted(figure.number)));
    }
    Ok(done)
}

impl Options {
    /// Runs a case with some of its keys set and opens its result.
    fn run(&self, name: &str, text: &str, keys: &[String]) -> Result<(Case, Reader)> {
        let mut keys = keys.to_vec();
        if let Some(cells) = self.cells {
            keys.push(format!("domain.cells=[{cells}, {cells}]"));
        }
        let case = Case::parse(text, Path::new("."), &keys)?;
        let path = self.results.join(format!("{name}.zarr"));
        run(&case, &RunOptions { output: Some(path.clone()), force: true, ..RunOptions::default() }, |_| {})?;
        Ok((case, Reader::open(&path)?))
    }
}

impl Difference {
    fn new(quantity: impl Into<String>, value: f64, of: &'static str) -> Difference {
        Difference { quantity: quantity.into(), value, of }
    }

    /// "Largest difference of the pressure: 1.2e-3 of the first peak".
    pub fn words(&self) -> String {
        match self.value {
            0.0 => format!("{}: none", self.quantity),
            value => format!("{}: {value:.1e} of {}", self.quantity, self.of),
        }
    }
}

impl Reproduction {
    fn new(
        number: u8,
        title: &str,
        figure: Figure,
        differences: Vec<Difference>,
        more: &str,
    ) -> Reproduction {
        let words: Vec<_> = differences.iter().map(Difference::words).collect();
        let caption = words.join(". ") + ". ";
        let figure = Figure { title: format!("Figure {number}: {title}"), caption: caption + more, ..figure };
        Reproduction { number, title: title.into(), figure, differences }
    }
}
