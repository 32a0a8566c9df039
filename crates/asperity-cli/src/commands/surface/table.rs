//! What is printed of a surface: a table, a JSON object, a picture.

use std::path::Path;

use asperity::finding::{self, Finding};
use asperity::surface::Surface as Map;
use asperity::surface::statistics::{
    BearingCurve, Extent, HeightStatistics, SelfAffineFit, SlopeStatistics, Summary,
};
use asperity::surface::{Level, Operation};
use asperity_io::topography::Topography;
use asperity_report::surface::picture;
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::format::quantity;

/// Levels of the bearing curve.
const LEVELS: usize = 1000;
/// Shares of the surface whose heights are told.
const SHARES: [f64; 5] = [0.01, 0.1, 0.5, 0.9, 0.99];

/// A surface and its statistics.
pub struct SurfaceSummary<'a> {
    name: &'a str,
    topography: &'a Topography,
    map: Map,
    extent: Extent,
    summary: Summary,
    /// Heights and slopes without the plane of the surface; a periodic surface has none.
    levelled: Option<(HeightStatistics, Option<SlopeStatistics>)>,
    bearing: BearingCurve,
    /// What is known beside the heights.
    told: Vec<Finding>,
}

impl<'a> SurfaceSummary<'a> {
    /// Takes the statistics; `name` is what the surface is called.
    pub fn of(name: &'a str, topography: &'a Topography, extent: Extent) -> Result<Self, Failure> {
        let map = super::map(name, topography)?;
        let failed = Failure::about(name);
        let summary = Summary::of(&map, extent).map_err(&failed)?;
        let levelled = match extent {
            Extent::Periodic => None,
            Extent::Finite => {
                let level = Operation::Level(Level::Plane).apply(&map).map_err(&failed)?;
                Some((HeightStatistics::of(&level).map_err(&failed)?, SlopeStatistics::of(&level).ok()))
            }
        };
        let bearing = BearingCurve::of(&map, LEVELS).map_err(failed)?;
        Ok(SurfaceSummary { name, topography, map, extent, summary, levelled, bearing, told: vec![] })
    }

    /// With findings that the heights alone do not show.
    pub fn told(self, told: Vec<Finding>) -> Self {
        SurfaceSummary { told, ..self }
    }

    /// Fits the Hurst exponent to the waves between two lengths \[m\] only; no fit where there are too few.
    pub fn fitted(mut self, longest: f64, shortest: f64) -> Self {
        if let Some(waves) = &mut self.summary.waves {
            waves.fit = SelfAffineFit::of(&waves.spectrum, longest, shortest).ok();
        }
        self
    }

    /// The same for a range that the user gives: too few waves are an error.
    pub fn fitted_as_asked(self, longest: f64, shortest: f64) -> Result<Self, Failure> {
        if let Some(waves) = &self.summary.waves {
            SelfAffineFit::of(&waves.spectrum, longest, shortest).map_err(Failure::about(self.name))?;
        }
        Ok(self.fitted(longest, shortest))
    }

    /// Prints the table or the object, and draws the picture where one is asked for.
    pub fn print(&self, json: bool, plot: Option<&Path>, force: bool) -> Result<(), Failure> {
        if let Some(plot) = plot {
            let title =
                Path::new(self.name).file_name().map_or(self.name.into(), |name| name.to_string_lossy());
            let figure = picture(&title, &self.map, self.extent, &self.summary, &self.bearing);
            crate::commands::picture::write(&figure, plot, force)?;
        }
        match json {
            true => crate::print(&format!("{}\n", self.object())),
            false => crate::print(&self.table()),
        }
    }

    fn object(&self) -> Value {
        let SurfaceSummary { topography, summary, .. } = self;
        let (nx, ny) = topography.heights.dim();
        let at = |i: usize, j: usize| topography.heights.get((i, j)).copied().filter(|h| h.is_finite());
        let (h, slopes) = (&summary.heights, summary.slopes);
        let waves = summary.waves.as_ref();
        let heights: Vec<_> = SHARES.iter().map(|share| self.bearing.height_at(*share).ok()).collect();
        let mut object = statistics(h, slopes.as_ref());
        let more = json!({
            "levelled": self.levelled.map(|(heights, slopes)| statistics(&heights, slopes.as_ref())),
            "format": topography.format.name(),
            "shape": [nx, ny],
            "size": topography.size,
            "undefined": topography.undefined(),
            "h00": at(0, 0),
            "h10": at(1, 0),
            "h01": at(0, 1),
            "moments": waves.map(|w| json!({
                "m0": w.moments.m0,
                "m2": w.moments.m2,
                "m4": w.moments.m4,
                "bandwidth": w.moments.bandwidth(),
            })),
            "lay": waves.map(|w| json!({
                "clear": w.lay.is_clear(),
                "ratio": w.lay.ratio,
                "angle": w.lay.angle,
            })),
            "fit": waves.and_then(|w| w.fit).map(|fit| json!({
                "hurst": fit.hurst,
                "error": fit.error,
                "roll_off": fit.roll_off,
                "plateau": fit.plateau,
                "misfit": fit.misfit,
            })),
            "findings": asperity_io::finding::list(&self.findings()),
            "bearing": { "share": SHARES, "height": heights },
            "channel": topography.channel,
            "channels": topography.channels,
            "history": topography.history().collect::<Vec<_>>(),
        });
        if let (Value::Object(object), Value::Object(more)) = (&mut object, more) {
            object.extend(more);
        }
        object
    }

    /// What was found about the heights and the fit, and what is known beside them.
    fn findings(&self) -> Vec<Finding> {
        let fit = self.summary.waves.as_ref().and_then(|waves| waves.fit.as_ref());
        let of_fit = fit.and_then(finding::hurst);
        finding::of_heights("the surface", &self.map)
            .into_iter()
            .chain(of_fit)
            .chain(self.told.iter().cloned())
            .collect()
    }

    fn table(&self) -> String {
        let SurfaceSummary { topography, summary, .. } = self;
        let mut text = String::new();
        let mut line = |name: &str, value: String, words: &str| {
            let gap = if words.is_empty() { String::new() } else { format!("  {words}") };
            text += format!("{name:<11}{value:<16}{gap}").trim_end();
            text.push('\n');
        };
        let (nx, ny) = topography.heights.dim();
        let [lx, ly] = topography.size;
        let metres = |value: f64| quantity(value, "m");
        line("format", topography.format.to_string(), "");
        line("points", format!("{nx} x {ny}, {} undefined", topography.undefined()), "");
        line("size", format!("{} x {}", metres(lx), metres(ly)), "");
        if let Some(channel) = &topography.channel {
            line("channel", channel.clone(), "");
        }
        if topography.channels.len() > 1 {
            let channels = topography.channels.iter().enumerate().map(|(n, name)| format!("{n}: {name}"));
            line("channels", channels.collect::<Vec<_>>().join(", "), "");
        }
        let range = |h: &HeightStatistics| {
            // A mean of rounding errors is none.
            let mean = if h.mean.abs() < 1e-12 * h.sq { 0.0 } else { h.mean };
            format!("{} to {}, mean {}", metres(h.min), metres(h.max), metres(mean))
        };
        let h = &summary.heights;
        line("heights", range(h), "");
        if let Some((level, _)) = &self.levelled {
            line("", range(level), "without the plane of the surface");
            line("", "as stored".into(), "levelled");
        }
        // A row of both: of the heights as stored and of the levelled ones.
        let mut row = |name: &str, of: &dyn Fn(&HeightStatistics) -> String, words: &str| match &self.levelled
        {
            Some((level, _)) => line(name, of(h), &format!("{:<16}{words}", of(level))),
            None => line(name, of(h), words),
        };
        row("Sa", &|h| metres(h.sa), "mean deviation from the mean height");
        row("Sq", &|h| metres(h.sq), "rms deviation from the mean height");
        row("Sz", &|h| metres(h.sz), "highest peak to deepest pit");
        row("Ssk", &|h| format!("{:.3}", h.ssk), "skewness, negative for plateaus with valleys");
        row("Sku", &|h| format!("{:.3}", h.sku), "kurtosis, 3 for a Gaussian surface");
        if let Some(slopes) = &summary.slopes {
            let level = self.levelled.and_then(|(_, slopes)| slopes);
            let mut row = |name: &str, of: &dyn Fn(&SlopeStatistics) -> String, words: &str| match &level {
                Some(level) => line(name, of(slopes), &format!("{:<16}{words}", of(level))),
                None => line(name, of(slopes), words),
            };
            row("Sdq", &|s| format!("{:.4}", s.sdq), "rms gradient");
            let words = "developed area over projected area, minus 1";
            row("Sdr", &|s| format!("{:.4} %", 100.0 * s.sdr), words);
        }
        if let Some(waves) = &summary.waves {
            let m = &waves.moments;
            let of = match self.extent {
                Extent::Periodic => "spectral moment: mean square height",
                Extent::Finite => {
                    "spectral moment: mean square height under a window, as m2, m4, alpha (--periodic: without)"
                }
            };
            line("m0", format!("{:.4e} m\u{b2}", m.m0), of);
            line("m2", format!("{:.4e}", m.m2), "mean square slope of a profile");
            line("m4", format!("{:.4e} 1/m\u{b2}", m.m4), "mean square curvature of a profile");
            line("alpha", format!("{:.2}", m.bandwidth()), "m0 m4/m2\u{b2}, Nayak's bandwidth");
            if waves.lay.is_clear() {
                let words = format!(
                    "at {:.0}\u{b0} from x: the slope across it is so many times that along it; roll-off and H are those across \
                     it, and m2, m4 and alpha mean little",
                    waves.lay.angle.to_degrees()
                );
                line("lay", format!("{:.2}", waves.lay.ratio), &words);
            }
            if let Some(fit) = &waves.fit {
                let words = format!(
                    "Hurst exponent fitted to the spectrum, roll-off {}, rms misfit {:.2} of ln C",
                    metres(fit.roll_off),
                    fit.misfit
                );
                line("H", format!("{:.3} \u{b1} {:.3}", fit.hurst, fit.error), &words);
            }
        } else {
            line("spectrum", "none".into(), "more than a quarter of the points are undefined");
        }
        let shares: Vec<String> = SHARES
            .iter()
            .filter_map(|share| {
                Some(format!("{} % {}", 100.0 * share, metres(self.bearing.height_at(*share).ok()?)))
            })
            .collect();
        line("bearing", shares.join(", "), "");
        for finding in self.findings() {
            line(finding.severity.as_str(), format!("{} [{}]", finding.text, finding.code), "");
        }
        for (n, step) in topography.history().enumerate() {
            line(if n == 0 { "history" } else { "" }, step.to_owned(), "");
        }
        text
    }
}

/// The parameters of ISO 25178-2 of heights and slopes, under their keys.
fn statistics(h: &HeightStatistics, slopes: Option<&SlopeStatistics>) -> Value {
    json!({
        "min": h.min,
        "max": h.max,
        "mean": h.mean,
        "sq": h.sq,
        "sdq": slopes.map(|s| s.sdq),
        "sa": h.sa,
        "ssk": h.ssk,
        "sku": h.sku,
        "sp": h.sp,
        "sv": h.sv,
        "sz": h.sz,
        "sdr": slopes.map(|s| s.sdr),
    })
}
