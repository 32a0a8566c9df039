//! `[[surface]] kind = "self-affine"`: synthetic roughness.

use super::keys::*;

use asperity::Grid;
use asperity::surface::{self, HeightDistribution, Level, Part, Roughness, Synthesis, level};

use crate::topography::{ReadOptions, read};

/// Random roughness.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SelfAffine {
    /// A published roughness by its name; its numbers are the defaults of the other keys.
    preset: Option<Preset>,
    /// Hurst exponent: the spectrum falls as q^(-2 (1 + hurst)), on a line as q^(-1 - 2 hurst). Needed without `preset`.
    hurst: Option<Number<Hurst>>,
    /// Root mean square of the gradient; this or `rms_height`.
    #[schemars(example = 0.05)]
    rms_gradient: Option<Number<Positive>>,
    /// Root mean square of the height; this or `rms_gradient`.
    #[schemars(example = "0.2 um")]
    rms_height: Option<Length<Positive>>,
    /// Longest wavelength of the roughness. Needed without `preset`.
    #[schemars(example = "50 um")]
    pub longest: Option<Length<Positive>>,
    /// Shortest wavelength of the roughness; at least two cells. Needed without `preset`.
    #[schemars(example = "0.8 um")]
    shortest: Option<Length<Positive>>,
    /// Wavelength down to which the spectrum is flat; `longest` if not given.
    #[schemars(example = "50 um")]
    roll_off: Option<Length<Positive>>,
    /// The direction in which the surface was worked; the same in all directions if not given.
    #[schemars(example = serde_json::json!({ "angle": "30 deg", "ratio": 4 }))]
    lay: Option<Lay>,
    /// How the heights are distributed; Gaussian if not given.
    #[schemars(example = serde_json::json!({ "skewness": -1, "kurtosis": 5 }))]
    distribution: Option<Distribution>,
    /// Seed of the random numbers.
    #[schemars(example = 1)]
    pub seed: Whole<0>,
}

/// A published roughness.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Preset {
    /// The Contact Mechanics Challenge (Mueser et al. 2017), 0.1 mm x 0.1 mm: hurst = 0.8, rms_gradient = 1,
    /// longest = "0.1 mm", roll_off = "20 um", shortest = "0.1 um" (which needs 2000 cells a side or more).
    ContactMechanicsChallenge,
}

/// The direction in which a surface was worked. The given wavelengths are those across it.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Lay {
    /// Angle of the lay from the x axis towards the y axis; 0 if not given.
    angle: Option<Angle>,
    /// Length along the lay over length across it, 1 or more.
    #[schemars(example = 4)]
    ratio: Number<Positive>,
}

/// How the heights are distributed: `skewness` and `kurtosis`, or those of a measured surface in a file.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Distribution {
    /// Skewness Ssk, negative for plateaus with valleys; 0 if not given.
    #[schemars(example = -1)]
    skewness: Option<Number>,
    /// Kurtosis Sku; 3 (Gaussian) if not given, from about 1.9 + 1.6 skewness^2 on.
    #[schemars(example = 5)]
    kurtosis: Option<Number<Positive>>,
    /// A topography file whose levelled heights have the distribution wanted; instead of the other two. Its unit
    /// does not matter.
    #[schemars(example = "measured.sur")]
    path: Option<String>,
}

impl SelfAffine {
    /// The part of the gap; checked against the grid, if there is one.
    pub fn part(&self, at: &Place<'_>, grid: Option<&Grid>, line: bool) -> Option<Part> {
        if line && self.lay.is_some() {
            let message = "a profile has no lay: the domain is a line of cells";
            return at.key("lay").fault(message, "roughness without a lay", "leave `lay` out");
        }
        let preset = self.preset.map(|Preset::ContactMechanicsChallenge| {
            surface::SelfAffine::contact_mechanics_challenge(self.seed.get())
        });
        let roughness = match (self.rms_gradient, self.rms_height, preset) {
            (None, None, Some(preset)) => preset.roughness,
            (gradient, height, _) => {
                at.exactly_one(&["rms_gradient", "rms_height"])?;
                let gradient = gradient.map(|gradient| Roughness::RmsGradient(gradient.get()));
                gradient.or(height.map(|height| Roughness::RmsHeight(height.get())))?
            }
        };
        let needed = |key, value: Option<f64>| value.or_else(|| at.missing(key, ""));
        let hurst = needed("hurst", self.hurst.map(Number::get).or(preset.map(|p| p.hurst)));
        let longest = needed("longest", self.longest.map(Length::get).or(preset.map(|p| p.longest)));
        let shortest = needed("shortest", self.shortest.map(Length::get).or(preset.map(|p| p.shortest)));
        let (hurst, longest, shortest) = (hurst?, longest?, shortest?);
        // The preset's roll-off where the band still holds it.
        let roll_off = preset.map_or(longest, |preset| preset.roll_off.clamp(shortest.min(longest), longest));
        let roll_off = self.roll_off.map_or(roll_off, Length::get);
        let seed = self.seed.get();
        let spectrum = surface::SelfAffine { hurst, roughness, longest, shortest, roll_off, seed };
        if let Some(grid) = grid {
            at.core(spectrum.validate(grid))?;
        }
        if self.lay.is_none() && self.distribution.is_none() {
            return Some(Part::SelfAffine(spectrum));
        }
        let lay = self
            .lay
            .as_ref()
            .map(|lay| surface::Lay { angle: lay.angle.map_or(0.0, Angle::get), ratio: lay.ratio.get() });
        let distribution = match &self.distribution {
            None => HeightDistribution::Gaussian,
            Some(distribution) => distribution.of_heights(&at.key("distribution"))?,
        };
        let synthesis = Synthesis { spectrum, lay, distribution };
        at.core(synthesis.validate())?;
        Some(Part::Synthesis(synthesis))
    }
}

impl Distribution {
    fn of_heights(&self, at: &Place<'_>) -> Option<HeightDistribution> {
        match (&self.path, self.skewness, self.kurtosis) {
            (None, None, None) => at.fault(
                "the table has no key",
                "skewness, kurtosis or path",
                "skewness and kurtosis set it, or path names a measured surface that has it",
            ),
            (None, skewness, kurtosis) => Some(HeightDistribution::Moments {
                skewness: skewness.map_or(0.0, Number::get),
                kurtosis: kurtosis.map_or(3.0, Number::get),
            }),
            (Some(path), None, None) => {
                let at = at.key("path");
                let full = at.file(path)?;
                at.note_read(path, &full);
                // Mean and rms come from the roughness: neither unit nor size matters.
                let options =
                    ReadOptions { size: Some([1.0, 1.0]), height_unit: Some(1.0), ..ReadOptions::default() };
                let surface = at.data(read(&full, &options), "a surface with heights")?;
                let heights = at.core(level(surface.heights.view(), Level::Plane))?;
                Some(HeightDistribution::Samples(heights.into_iter().filter(|z| z.is_finite()).collect()))
            }
            (Some(_), ..) => at.fault(
                "`path` cannot be combined with skewness or kurtosis",
                "one of them",
                "leave path out, or skewness and kurtosis",
            ),
        }
    }
}
