//! Force curves and force volumes of Nanoscope files (.spm, .000, .pfc).
//!
//! A file of curves starts with `\*Force file list` or states the context FOL, one curve, or FVOL: a curve at each point of `force/line` x
//! `Number of lines`. The integers of a curve are its approach and its retraction, both from contact outwards:
//!
//! ```text
//! deflection = n LSB S,   LSB of "\@4:Z scale: V [Sens. DeflSens] (0.000375 V/LSB) 2.5 V",   S of "\@Sens. DeflSens: V 27.39 nm/V"
//! height     = Ramp Size S_z (1 - k/points)        time of a point = Ramp Size/(Forward vel. points)
//! ```
//!
//! The bytes of a number follow from `Data length`: `Bytes/pixel` is 2 where numbers take 4. Holds, blocks of different lengths and captures of
//! PeakForce are not read: their form was not checked with files.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::super::cursor::Cursor;
use super::super::entries::Entries;
use super::super::sample::Order;
use super::super::{Problem, Result, TopographyError};
use super::{Header, Scale};

/// Largest number of points of a curve, and of curves.
const MOST_POINTS: u64 = 1 << 20;
const MOST_CURVES: u64 = 1 << 22;
/// Numbers of a calibration in SI units lie between these.
const PLAUSIBLE: std::ops::Range<f64> = 1e-15..1e9;
/// Largest deflection over the trigger of the ramp: the softest samples known reach 4.3. Beyond, the numbers are shifted by a byte.
const SHIFTED: f64 = 20.0;

/// A force curve of an instrument: its approach, then its retraction.
#[derive(Clone, Debug, PartialEq)]
pub struct InstrumentCurve {
    /// Way of the base of the cantilever towards the sample \[m\].
    pub height: Vec<f64>,
    /// Deflection of the cantilever \[m\].
    pub deflection: Vec<f64>,
    /// Time of each point \[s\], where the file states the velocity.
    pub time: Option<Vec<f64>>,
    /// Number of points of the approach.
    pub approach: usize,
    /// Spring constant \[N/m\], and sensitivity \[m/V\] of the deflection.
    pub spring_constant: f64,
    /// See `spring_constant`.
    pub sensitivity: f64,
    /// Of a volume: place of the curve in its grid, curves along x and y, and sides of the grid \[m\] where they are stated.
    pub place: Option<Place>,
}

impl InstrumentCurve {
    /// Loads \[N\].
    pub fn loads(&self) -> Vec<f64> {
        self.deflection.iter().map(|bent| self.spring_constant * bent).collect()
    }

    /// Depths \[m\]: height less deflection, in the zero of the instrument.
    pub fn depths(&self) -> Vec<f64> {
        self.height.iter().zip(&self.deflection).map(|(height, bent)| height - bent).collect()
    }
}

/// Place of a curve in a grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// From 0 on.
    pub index: [usize; 2],
    /// Number of curves.
    pub shape: [usize; 2],
    /// Sides \[m\].
    pub size: Option<[f64; 2]>,
}

/// What takes the place of numbers of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Calibration {
    /// Spring constant \[N/m\].
    pub spring_constant: Option<f64>,
    /// Sensitivity of the deflection \[m/V\].
    pub sensitivity: Option<f64>,
}

/// Whether the bytes are force curves of a Nanoscope file.
pub fn holds_curves(bytes: &[u8]) -> bool {
    super::is_nanoscope(bytes) && Header::parse(bytes).sections.iter().any(is_curve)
}

fn is_curve(section: &Entries) -> bool {
    section.title.ends_with("force image list")
}

/// The force curves of a file, as [`read_curves`]; `None` of a file of another kind.
///
/// # Errors
/// [`TopographyError`] that names the file.
pub fn read_curve_file(
    path: &Path,
    calibration: Calibration,
) -> Result<Option<Vec<InstrumentCurve>>, TopographyError> {
    let read = || {
        let mut start = vec![];
        File::open(path)?.take(64).read_to_end(&mut start)?;
        if !super::is_nanoscope(&start) {
            return Ok(None);
        }
        let bytes = std::fs::read(path)?;
        let curves = || Blocks::of(&bytes, calibration)?.curves();
        holds_curves(&bytes).then(curves).transpose()
    };
    read().map_err(TopographyError::at(path))
}

/// Reads the force curves of a Nanoscope file.
///
/// # Errors
/// [`TopographyError`] if the file holds none, is truncated, or holds what is not read; or if it states no spring constant or sensitivity and none
/// is given.
pub fn read_curves(bytes: &[u8], calibration: Calibration) -> Result<Vec<InstrumentCurve>, TopographyError> {
    Ok(Blocks::of(bytes, calibration)?.curves()?)
}

/// The block of numbers of all curves.
struct Blocks<'a> {
    data: &'a [u8],
    /// Bytes of a number.
    width: usize,
    /// Numbers of the approach, and of the retraction.
    points: usize,
    /// Curves along x and y.
    shape: [usize; 2],
    volume: bool,
    size: Option<[f64; 2]>,
    /// Volts of 1.
    lsb: f64,
    ramp: f64,
    /// Times of a point of approach and retraction \[s\].
    steps: Option<[f64; 2]>,
    /// Trigger above the baseline \[V\].
    trigger: Option<f64>,
    spring_constant: f64,
    sensitivity: f64,
}

impl<'a> Blocks<'a> {
    fn of(bytes: &'a [u8], calibration: Calibration) -> Result<Self> {
        let header = Header::parse(bytes);
        let deflects =
            |section: &&Entries| is_curve(section) && super::image_names(section).0.contains("Deflection");
        let Some(image) = header.sections.iter().find(deflects) else {
            return Err(Problem::unsupported(
                "a Nanoscope file without force curves",
                "give a file of force curves or a force volume",
            ));
        };
        header.refuse_unchecked()?;
        let samples: Vec<u64> = image
            .get("Samps/line")
            .unwrap_or_default()
            .split_whitespace()
            .filter_map(|n| n.parse().ok())
            .collect();
        let points = match samples[..] {
            [one] | [one, _] if samples.iter().all(|n| *n == one) && (2..=MOST_POINTS).contains(&one) => one,
            _ => {
                return Err(image.wrong("Samps/line", "the same number of points of approach and retraction"));
            }
        };
        let volume = header
            .get("force file list", "Start context")
            .or(header.get("file list", "Start context"))
            .is_some_and(|context| context.eq_ignore_ascii_case("FVOL"));
        let shape = if volume { header.shape()? } else { [1, 1] };
        let count = shape[0].saturating_mul(shape[1]);
        let length = image.whole("Data length")?;
        let numbers = 2 * points * count.clamp(1, MOST_CURVES);
        let width = length / numbers;
        if count > MOST_CURVES || length % numbers != 0 || !matches!(width, 2 | 4) {
            return Err(image.wrong(
                "Data length",
                &format!("2 or 4 bytes for each of the {numbers} points of its curves"),
            ));
        }
        let data = Cursor::at(bytes, image.whole("Data offset")?, Order::Little, "the force curves")?
            .bytes(length, "the force curves")?;
        let (lsb, sensitivity) = header.deflection(image, calibration)?;
        let ramp = header.length(image, "@4:Ramp size")?;
        let velocity = |key: &str| header.get("force list", key)?.parse().ok().filter(|v: &f64| *v > 0.0);
        let of_ramp = Scale::parse(image.get("@4:Ramp size").unwrap_or_default()).map(|scale| scale.value);
        let step = |key: &str| Some(of_ramp? / velocity(key)? / points as f64);
        let steps = step("Forward vel.").zip(step("Reverse vel.")).map(|(a, b)| [a, b]);
        let trigger =
            header.get("force list", "Trigger mode").filter(|mode| mode.eq_ignore_ascii_case("Relative"));
        let trigger =
            trigger.and(header.get("force list", "@4:Trig threshold deflection")).and_then(Scale::parse);
        Ok(Blocks {
            data,
            width: width as usize,
            points: points as usize,
            shape: shape.map(|n| n as usize),
            volume,
            size: header.sides(),
            lsb,
            ramp,
            steps,
            trigger: trigger.map(|scale| scale.value).filter(|volts| *volts > 0.0),
            spring_constant: header.spring_constant(image, calibration)?,
            sensitivity,
        })
    }

    fn curves(&self) -> Result<Vec<InstrumentCurve>> {
        let curves = self.data.chunks_exact(2 * self.points * self.width).enumerate();
        let curves: Vec<InstrumentCurve> = curves.map(|(n, block)| self.curve(n, block)).collect();
        if let (Some(trigger), Some(first)) = (self.trigger, curves.first()) {
            let approach = &first.deflection[..first.approach];
            let baseline =
                approach.iter().take(approach.len() / 4).sum::<f64>() / (approach.len() / 4).max(1) as f64;
            let most = approach.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            if most - baseline > SHIFTED * trigger * self.sensitivity {
                return Err(Problem::malformed(
                    "the deflection of the first curve",
                    format!("{:e} m above its baseline", most - baseline),
                    format!(
                        "near the trigger of {:e} m: its numbers are shifted; take the file as the instrument wrote it",
                        trigger * self.sensitivity
                    ),
                ));
            }
        }
        Ok(curves)
    }

    fn curve(&self, n: usize, block: &[u8]) -> InstrumentCurve {
        let numbers: Vec<Option<f64>> = block.chunks_exact(self.width).map(number).collect();
        let (approach, retraction) = numbers.split_at(self.points);
        let step = self.ramp / self.points as f64;
        let (mut height, mut deflection, mut time) = (vec![], vec![], vec![]);
        let steps = self.steps.unwrap_or_default();
        let mut point = |k: usize, number: f64, at: f64| {
            height.push(self.ramp - step * k as f64);
            deflection.push(number * self.lsb * self.sensitivity);
            time.push(at);
        };
        let last = (self.points - 1) as f64;
        // From contact outwards: the approach is turned round. What was not captured has the smallest number.
        for (k, number) in approach.iter().enumerate().rev() {
            if let Some(number) = number {
                point(k, *number, (last - k as f64) * steps[0]);
            }
        }
        for (k, number) in retraction.iter().enumerate() {
            if let Some(number) = number {
                point(k, *number, last * steps[0] + (k + 1) as f64 * steps[1]);
            }
        }
        let [nx, _] = self.shape;
        InstrumentCurve {
            height,
            deflection,
            time: self.steps.map(|_| time),
            approach: approach.iter().flatten().count(),
            spring_constant: self.spring_constant,
            sensitivity: self.sensitivity,
            place: self.volume.then_some(Place {
                index: [n % nx, n / nx],
                shape: self.shape,
                size: self.size,
            }),
        }
    }
}

/// A number of 2 or 4 bytes; `None` for the smallest one.
fn number(bytes: &[u8]) -> Option<f64> {
    match *bytes {
        [a, b] => Some(i16::from_le_bytes([a, b])).filter(|n| *n != i16::MIN).map(f64::from),
        [a, b, c, d] => Some(i32::from_le_bytes([a, b, c, d])).filter(|n| *n != i32::MIN).map(f64::from),
        _ => None,
    }
}

impl Header {
    /// Refuses what was not checked with files.
    fn refuse_unchecked(&self) -> Result<()> {
        let refuse = |what: &str| {
            let instead = "export the curves as text, with columns of height, deflection and time, from NanoScope Analysis";
            Err(Problem::unsupported(what, instead))
        };
        let positive = |key: &str| {
            self.get("force list", key).and_then(|n| n.parse().ok()).is_some_and(|n: f64| n > 0.0)
        };
        if positive("Hold Samples") || positive("Hold Time") {
            return refuse("a Nanoscope force curve with a hold");
        }
        let captured =
            self.get("scan list", "PeakForce Capture").is_some_and(|word| word.eq_ignore_ascii_case("Allow"));
        if captured && self.get("file list", "Start context").is_some_and(|context| context.starts_with("PF"))
        {
            return refuse("a capture of PeakForce curves");
        }
        Ok(())
    }

    /// Curves along x and y of a volume.
    fn shape(&self) -> Result<[u64; 2]> {
        let wrong = |key: &str| {
            Problem::malformed(format!("{key} of the force volume"), "missing", "a whole number above 0")
        };
        let per_line = self.get("force list", "force/line").and_then(|n| n.parse().ok()).filter(|n| *n > 0);
        let image = self.sections.iter().find(|section| super::is_image(section));
        let lines = image.and_then(|image| image.whole("Number of lines").ok()).filter(|n| *n > 0);
        Ok([per_line.ok_or_else(|| wrong("force/line"))?, lines.ok_or_else(|| wrong("Number of lines"))?])
    }

    /// Volts of 1, and metres of a volt.
    fn deflection(&self, image: &Entries, calibration: Calibration) -> Result<(f64, f64)> {
        let scale = image.get("@4:Z scale").unwrap_or_default();
        let lsb = scale.split_once('(').and_then(|(_, rest)| rest.split_whitespace().next()?.parse().ok());
        let expected = "like \"V [Sens. DeflSens] (0.000375 V/LSB) 2.5 V\"";
        let lsb: f64 = lsb
            .filter(|volts| PLAUSIBLE.contains(volts))
            .ok_or_else(|| image.wrong("@4:Z scale", expected))?;
        let name = Scale::parse(scale).and_then(|scale| scale.sensitivity).unwrap_or("Sens. DeflSens");
        let own = self.sensitivity(name);
        let missing = || Problem::Option {
            what: "sensitivity",
            value: "missing: the file states none".to_owned(),
            expected: "the deflection per volt".to_owned(),
        };
        Ok((lsb, calibration.sensitivity.or(own).ok_or_else(missing)?))
    }

    /// A sensitivity \[m/V\]; in nm/V where its unit is missing.
    fn sensitivity(&self, name: &str) -> Option<f64> {
        let key = format!("@{name}");
        let scale = self
            .sections
            .iter()
            .filter(|section| !is_curve(section))
            .find_map(|section| Scale::parse(section.get(&key)?))?;
        let factor = super::ratio(scale.unit.split('/').next().unwrap_or_default(), "m");
        let metres = scale.value * if scale.unit.is_empty() { 1e-9 } else { factor? };
        PLAUSIBLE.contains(&metres).then_some(metres)
    }

    /// A value in volts of a piezo, as a length.
    fn length(&self, image: &Entries, key: &str) -> Result<f64> {
        let expected = "like \"V [Sens. Zsens] (0.0067 V/LSB) 227.2 V\" with a sensitivity";
        let scale = image.get(key).and_then(Scale::parse).ok_or_else(|| image.wrong(key, expected))?;
        let per_volt = scale.sensitivity.and_then(|name| self.sensitivity(name));
        let length = scale.value * per_volt.ok_or_else(|| image.wrong(key, expected))?;
        if PLAUSIBLE.contains(&length) { Ok(length) } else { Err(image.wrong(key, expected)) }
    }

    fn spring_constant(&self, image: &Entries, calibration: Calibration) -> Result<f64> {
        let own = image.get("Spring Constant").and_then(|n| n.parse().ok()).filter(|k| PLAUSIBLE.contains(k));
        let missing = || Problem::Option {
            what: "spring constant",
            value: "missing: the file states none".to_owned(),
            expected: "that of the cantilever".to_owned(),
        };
        calibration.spring_constant.or(own).ok_or_else(missing)
    }

    /// Sides of the scan \[m\].
    fn sides(&self) -> Option<[f64; 2]> {
        let text = self.get("scan list", "Scan Size")?;
        let (number, unit) = text.trim().rsplit_once(' ')?;
        let side = number.split_whitespace().next()?.parse::<f64>().ok()? * super::ratio(unit, "m")?;
        (side > 0.0).then_some([side; 2])
    }
}
