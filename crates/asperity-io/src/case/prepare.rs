//! The steps that prepare a measured surface: `process = [...]`, and the same steps as keys of a `[[surface]]`.

use std::collections::BTreeSet;

use asperity::surface::process::{self, Axis, Band, Edge, Resampling};
use asperity::surface::{self, Fill, Level};

use super::keys::*;
use super::surface::File;
use crate::preparation::{self, Step, check_border};

/// Largest share of a surface that is filled by default; more would be invention, not measurement.
const FILL_SHARE: f64 = 0.25;
/// Share of the length over which Tukey's window rises and falls.
const TUKEY_SHARE: f64 = 0.1;

/// One processing step of a measured surface.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(tag = "op")]
pub enum Operation {
    /// Subtract a form, fitted by least squares to the defined points.
    Level {
        /// What is subtracted; "plane" if not given.
        form: Option<Level>,
    },
    /// Fill the undefined points.
    Fill {
        /// How; "harmonic" if not given.
        method: Option<Fill>,
        /// Largest share of undefined points that is filled; 0.25 if not given.
        share: Option<Number<Share>>,
    },
    /// Keep a rectangle.
    Crop(Crop),
    /// Resample the same rectangle to another number of cells.
    Resample {
        /// How; "band-limited" if not given.
        method: Option<Resampling>,
        /// Number of cells along x and y; those of the domain if not given.
        #[schemars(example = (512, 512))]
        cells: Option<Two<Whole<1>>>,
    },
    /// Keep the wavelengths of a band; the surface is treated as periodic.
    Filter(Filter),
    /// Mirror along an axis.
    Flip {
        /// The axis along which the surface is mirrored.
        axis: Axis,
    },
    /// Rotate by quarter turns from x towards y.
    Rotate {
        /// Quarter turns from x towards y; 1 if not given, negative ones turn back.
        #[schemars(example = 1)]
        quarter_turns: Option<Signed>,
    },
    /// Change the sign of the heights.
    Invert {},
    /// Multiply by a window that decreases to zero towards the edges.
    Window(Window),
    /// Continue beyond the border, so that opposite borders match on a periodic domain.
    Border {
        /// How the surface goes on beyond its border.
        method: Continuation,
    },
    /// Make spikes undefined.
    Outliers(Outliers),
    /// Subtract a circle from a profile, fitted by least squares.
    Circle(Circle),
}

/// A circle to subtract from a profile.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Circle {
    /// Its radius; the one that fits best if not given.
    #[schemars(example = "10 mm")]
    pub radius: Option<Length<Positive>>,
}

/// A rectangle to keep: `cells` (counts) or `size` (lengths) or `defined = true`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Crop {
    /// Number of cells kept along x and y; this, `size` or `defined`.
    #[schemars(example = (512, 512))]
    pub cells: Option<Two<Whole<1>>>,
    /// First cell kept along x and y, from 0; with `cells`. If not given, the middle of the surface is kept.
    #[schemars(example = (0, 0))]
    pub from: Option<Two<Whole<0>>>,
    /// Lengths kept along x and y, rounded to whole cells; this, `cells` or `defined`.
    #[schemars(example = ("0.2 mm", "0.2 mm"))]
    pub size: Option<Two<Length<Positive>>>,
    /// Corner of the part kept, from the surface's corner; with `size`. If not given, the middle is kept.
    #[schemars(example = ("0 mm", "0.1 mm"))]
    pub corner: Option<Two<Length>>,
    /// true: the smallest rectangle that holds all defined points.
    #[schemars(example = true)]
    pub defined: Option<bool>,
}

/// The wavelengths that are kept; give `longest`, `shortest` or both.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Filter {
    /// Longest wavelength kept (high-pass); without it all long waves and the mean are kept.
    #[schemars(example = "80 um")]
    pub longest: Option<Length<Positive>>,
    /// Shortest wavelength kept (low-pass); without it all short waves are kept.
    #[schemars(example = "2.5 um")]
    pub shortest: Option<Length<Positive>>,
    /// How the band ends; "sharp" if not given.
    pub edge: Option<Edge>,
}

/// A window along each axis, from 1 in the middle to 0 at the edges.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Window {
    /// "tukey" or "hann"; "tukey" if not given.
    #[serde(default)]
    pub shape: WindowShape,
    /// Share of the length over which Tukey's window rises and falls; 0.1 if not given.
    #[schemars(example = 0.1)]
    pub share: Option<Number<Share>>,
}

/// A window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum WindowShape {
    /// (1 - cos(2 pi x/L))/2.
    Hann,
    /// Hann's flanks over a share of the length, flat in between.
    #[default]
    Tukey,
}

/// How a surface goes on beyond its border.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Continuation {
    /// By its reflections: a surface of twice the length and width, four times the cells, that repeats without a seam.
    Mirror,
}

/// Spikes: points far from the lines through their neighbours in every direction.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Outliers {
    /// Robust standard deviations from the lines through the neighbours; 6 if not given.
    #[schemars(example = 6)]
    pub threshold: Option<Number<Positive>>,
    /// Distance of the neighbours in cells, 1 to 10: spikes up to one cell wider are removed; 2 if not given.
    #[schemars(example = 2)]
    pub radius: Option<Whole<1>>,
}

/// The steps in the order in which they are done.
///
/// Without `process`: crop, flip, rotate, invert, level, outliers (and level again without them), fill, circle, border, filter,
/// window, resample. A filter treats the surface as periodic, so the reflections come before it.
pub fn steps(at: &Place<'_>, file: &File) -> Option<Vec<Step>> {
    let operations = operations(file);
    let Some(process) = &file.process else {
        let given =
            operations.iter().filter_map(|(key, operation)| Some(operation.as_ref()?.step(&at.key(key))));
        let steps: Vec<Step> = given.collect::<Option<_>>()?;
        return at.key("border").core(check_border(&steps)).map(|()| steps);
    };
    let keys: BTreeSet<&str> = operations.iter().map(|(key, _)| *key).chain(["fill_share"]).collect();
    let alone = at.without(
        &Vec::from_iter(keys),
        "cannot be combined with `process`, which lists all steps",
        "either `process` or single keys",
        "add it to `process` as a step, in the order wanted",
    );
    let list = at.key("process");
    // All of them are looked at, also after one that is wrong.
    let steps: Vec<_> = process.iter().enumerate().map(|(n, step)| step.step(&list.item(n))).collect();
    let steps: Vec<Step> = alone.and(steps.into_iter().collect())?;
    list.core(check_border(&steps)).map(|()| steps)
}

/// The operations of the single keys, in their order.
fn operations(file: &File) -> [(&'static str, Option<Operation>); 13] {
    let level = || (file.level != Some(Level::None)).then_some(Operation::Level { form: file.level });
    [
        ("crop", file.crop.clone().map(Operation::Crop)),
        ("flip", file.flip.map(|axis| Operation::Flip { axis })),
        ("rotate", file.rotate.map(|turns| Operation::Rotate { quarter_turns: Some(turns) })),
        ("invert", (file.invert == Some(true)).then_some(Operation::Invert {})),
        ("level", level()),
        ("outliers", file.outliers.clone().map(Operation::Outliers)),
        // Spikes tilt the form; without them it is fitted anew.
        ("level", file.outliers.as_ref().and_then(|_| level())),
        ("fill", Some(Operation::Fill { method: file.fill, share: file.fill_share })),
        ("circle", file.circle.clone().map(Operation::Circle)),
        ("border", file.border.map(|method| Operation::Border { method })),
        ("filter", file.filter.clone().map(Operation::Filter)),
        ("window", file.window.clone().map(Operation::Window)),
        ("resample", file.resample.map(|method| Operation::Resample { method: Some(method), cells: None })),
    ]
}

impl Operation {
    /// The step of the preparation.
    pub fn step(&self, at: &Place<'_>) -> Option<Step> {
        let operation = match self {
            Operation::Level { form } => surface::Operation::Level(form.unwrap_or(Level::Plane)),
            Operation::Fill { method, share } => surface::Operation::Fill {
                method: method.unwrap_or_default(),
                largest_share: share.map_or(FILL_SHARE, Number::get),
            },
            Operation::Flip { axis } => surface::Operation::Flip(*axis),
            Operation::Rotate { quarter_turns } => {
                surface::Operation::Rotate { quarter_turns: quarter_turns.map_or(1, Signed::get) }
            }
            Operation::Invert {} => surface::Operation::Invert,
            Operation::Outliers(outliers) => surface::Operation::RemoveOutliers(outliers.or_default()),
            Operation::Resample { method, cells } => {
                let cells = cells.map(|cells| cells.map(Whole::count));
                return Some(Step::Resample { cells, method: method.unwrap_or_default() });
            }
            Operation::Crop(crop) => return crop.step(at),
            Operation::Filter(filter) => surface::Operation::Filter(filter.band(at)?),
            Operation::Window(window) => surface::Operation::Window(window.window(at)?),
            Operation::Border { method: Continuation::Mirror } => surface::Operation::Mirror,
            Operation::Circle(circle) => {
                return Some(Step::Circle { radius: circle.radius.map(Length::get) });
            }
        };
        Some(Step::Operation(operation))
    }
}

impl Crop {
    fn step(&self, at: &Place<'_>) -> Option<Step> {
        let given = [
            self.cells.map(|_| "cells"),
            self.size.map(|_| "size"),
            self.defined.filter(|defined| *defined).map(|_| "defined"),
        ];
        let given: Vec<&str> = given.into_iter().flatten().collect();
        at.only_one(&["cells", "size", "defined"], &given)?;
        let stray = [
            ("from", self.from.is_some() && self.cells.is_none(), "cells"),
            ("corner", self.corner.is_some() && self.size.is_none(), "size"),
        ];
        if let Some((key, _, partner)) = stray.iter().find(|stray| stray.1) {
            return at.fault(
                format!("`{key}` belongs to `{partner}`, which is not given"),
                "cells and from, or size and corner",
                "`cells` with `from` counts cells, `size` with `corner` measures lengths",
            );
        }
        Some(Step::Crop(match (self.cells, self.size) {
            (Some(cells), _) => preparation::Crop::Cells {
                cells: cells.map(Whole::count),
                from: self.from.map(|from| from.map(Whole::count)),
            },
            (None, Some(size)) => preparation::Crop::Lengths {
                size: size.map(Length::get),
                corner: self.corner.map(|corner| corner.map(Length::get)),
            },
            (None, None) => preparation::Crop::Defined,
        }))
    }
}

impl Filter {
    fn band(&self, at: &Place<'_>) -> Option<Band> {
        let [longest, shortest] = [self.longest, self.shortest].map(|length| length.map(Length::get));
        if longest.or(shortest).is_none() {
            let help = "longest drops long waves (high-pass), shortest drops short ones (low-pass)";
            return at.fault("needs `longest` or `shortest`", "a wavelength", help);
        }
        if let (Some(longest), Some(shortest)) = (longest, shortest)
            && longest < shortest
        {
            let message = format!("longest is {longest:e} m, shorter than shortest, {shortest:e} m");
            return at.fault(message, "longest >= shortest", "exchange the two");
        }
        Some(Band { longest, shortest, edge: self.edge.unwrap_or_default() })
    }
}

impl Window {
    fn window(&self, at: &Place<'_>) -> Option<process::Window> {
        match (self.shape, self.share.map(Number::get)) {
            (WindowShape::Hann, None) => Some(process::Window::Hann),
            (WindowShape::Hann, Some(_)) => {
                let help = "write shape = \"tukey\", or leave share out";
                at.fault("`share` belongs to Tukey's window", "no share", help)
            }
            (WindowShape::Tukey, share) => {
                Some(process::Window::Tukey { share: share.unwrap_or(TUKEY_SHARE) })
            }
        }
    }
}

impl Outliers {
    fn or_default(&self) -> process::Outliers {
        let default = process::Outliers::default();
        process::Outliers {
            threshold: self.threshold.map_or(default.threshold, Number::get),
            radius: self.radius.map_or(default.radius, Whole::count),
        }
    }
}
