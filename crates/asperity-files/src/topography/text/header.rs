//! The header lines of text files: names, sizes and units.
//!
//! Understood are the headers of Gwyddion ("# Width: 10.00 µm", in any language), SPIP and Attocube ("x-length =
//! 1000"), Nova ("Scale X = 0.1"), Wyko ("Pixel_size 7 4 0.0016"), of interferometers ("pixel size=3.7e-7 m"), and
//! rows of column names with units ("x [mm]; y [mm]; z [µm]"). Other lines are kept as metadata.

use super::encoding;
use super::labels::in_english;
use crate::topography::finish::{Lateral, Unit, unit_of};
use crate::topography::unit::{LoneA, metres};

/// Most comments of one header that are kept for the order of Gwyddion's lines.
const MOST_UNEXPLAINED: usize = 200;

/// A length as the file writes it.
#[derive(Clone, Debug, PartialEq)]
struct Length {
    value: f64,
    /// Text after the number.
    unit: String,
}

/// A column named in a row above the numbers.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Column {
    pub(super) name: String,
    pub(super) unit: Option<String>,
}

/// What the header lines so far say.
#[derive(Clone, Debug, Default)]
pub(super) struct Header {
    pub(super) channel: Option<String>,
    /// Points along x and y, for a check.
    pub(super) points: [Option<u64>; 2],
    length: [Option<Length>; 2],
    spacing: [Option<Length>; 2],
    lateral_unit: [Option<String>; 2],
    value_unit: Option<String>,
    /// Value per number of the file.
    scale: Option<f64>,
    /// The last two lines before the numbers: names of the columns, or names and units.
    above: [String; 2],
    /// "label: value" comments that no known label explains, for the order of Gwyddion's lines.
    unexplained: Vec<(String, String)>,
    spip: bool,
    wyko: Option<Wyko>,
}

/// Numbers in Wyko's header: heights in wavelengths, lengths in millimetres.
#[derive(Clone, Debug, Default)]
struct Wyko {
    real_units: bool,
    pixel_size: Option<f64>,
    aspect: Option<f64>,
    wavelength: Option<f64>,
    mult: Option<f64>,
}

impl Header {
    /// Whether the header can only belong to a matrix.
    pub(super) fn says_matrix(&self) -> bool {
        self.wyko.is_some()
            || self.length.iter().chain(&self.spacing).any(Option::is_some)
            || self.points.iter().any(Option::is_some)
            || self.gwyddion_sizes().is_some()
    }

    /// Forgets what belongs to one block only.
    pub(super) fn next_block(&mut self) {
        self.unexplained.clear();
        self.above = Default::default();
    }

    /// Takes the names above the numbers, and what [`next_block`](Self::next_block) forgets, from the header before them.
    pub(super) fn keep_names_of(&mut self, before: &mut Header) {
        self.above = std::mem::take(&mut before.above);
        if self.unexplained.is_empty() {
            self.unexplained = std::mem::take(&mut before.unexplained);
        }
    }

    /// Reads one header line; returns it as key and value for the metadata.
    pub(super) fn line(&mut self, line: &[u8]) -> Option<(String, String)> {
        // Longer lines are no header of any program.
        let line = encoding::label(&line[..line.len().min(4096)]);
        let is_comment = line.trim_start().starts_with(['#', '%']);
        let text = line.trim().trim_start_matches(['#', '%', '/', ';', ' ', '\t']).trim();
        if text.is_empty() {
            return None;
        }
        self.above.swap(0, 1);
        self.above[1] = text.to_owned();
        if let Some(flags) = text.strip_prefix("Wyko ASCII Data File Format") {
            // Three flags; the second is 1 where heights are in nanometres instead of wavelengths.
            let real_units = flags.split_whitespace().nth(1).is_some_and(|f| f != "0");
            self.wyko = Some(Wyko { real_units, ..Wyko::default() });
        } else if self.wyko.is_some() {
            self.wyko_line(text);
        } else if let Some((key, value)) = split(text) {
            self.entry(is_comment, key, value);
        }
        let (key, value) = split(text).unwrap_or(("", text));
        Some((key.to_owned(), value.to_owned()))
    }

    /// The columns named above the numbers.
    pub(super) fn columns(&self) -> Vec<Column> {
        let [names, last] = &self.above;
        columns(last, &columns(names, &[]))
    }

    fn entry(&mut self, is_comment: bool, key: &str, value: &str) {
        let unit = || Some(value.to_owned());
        match in_english(key).as_str() {
            "channel" => self.channel = Some(value.to_owned()),
            // "h=305 w=75"
            "h" => {
                let (height, rest) = value.split_once(char::is_whitespace).unwrap_or((value, ""));
                self.points[1] = height.parse().ok();
                if let Some(width) = rest.trim().strip_prefix("w=") {
                    self.points[0] = width.trim().parse().ok();
                }
            }
            "w" | "x-pixels" | "nx" => self.points[0] = value.parse().ok(),
            "y-pixels" | "ny" => self.points[1] = value.parse().ok(),
            "width" | "x-length" => self.length[0] = length(value),
            "height" | "y-length" => self.length[1] = length(value),
            "scale x" => self.spacing[0] = length(value),
            "scale y" => self.spacing[1] = length(value),
            "pixel size" => self.spacing = [length(value), length(value)],
            "x-unit" => self.lateral_unit[0] = unit(),
            "y-unit" | "unit y" => self.lateral_unit[1] = unit(),
            "lateral units" | "unit x" => self.lateral_unit = [unit(), unit()],
            "value units" | "z-unit" | "unit data" => self.value_unit = unit(),
            "bit2nm" if self.value_unit.is_none() => {
                self.scale = leading_number(value).map(|(bits, _)| bits);
                self.value_unit = Some("nm".to_owned());
            }
            "file format" => self.spip |= value.eq_ignore_ascii_case("ascii"),
            key if key.starts_with("height conversion factor") => {
                // "height conversion factor (-> m)=2.9e-8"
                let unit = key.split_once("->").map(|(_, unit)| unit.trim_end_matches(')').trim());
                self.value_unit = unit.map(str::to_owned);
                self.scale = leading_number(value).map(|(factor, _)| factor);
            }
            _ if is_comment && self.unexplained.len() < MOST_UNEXPLAINED => {
                self.unexplained.push((key.to_owned(), value.to_owned()));
            }
            _ => {}
        }
    }

    /// "Pixel_size 7 4 0.0016": name, type, length, value.
    fn wyko_line(&mut self, text: &str) {
        let words: Vec<&str> = text.split_whitespace().collect();
        let Some(wyko) = &mut self.wyko else { return };
        let value = words.get(3).and_then(|w| w.parse().ok());
        match words.as_slice() {
            // A line of the file is one position along "X": the values along it are those of "Y".
            ["X", "Size", lines] => self.points[1] = lines.parse().ok(),
            ["Y", "Size", values] => self.points[0] = values.parse().ok(),
            ["Pixel_size", ..] => wyko.pixel_size = value,
            ["Aspect", ..] => wyko.aspect = value,
            ["Wavelength", ..] => wyko.wavelength = value,
            ["Mult", ..] => wyko.mult = value,
            [name, "3", ..] => self.channel = Some((*name).to_owned()),
            _ => {}
        }
    }

    /// Gwyddion's lines in a language without known labels: channel, width, height, unit of the values.
    fn gwyddion_sizes(&self) -> Option<([Length; 2], Option<&str>, Option<&str>)> {
        let with_unit =
            |entry: &(String, String)| length(&entry.1).filter(|l| metres(&l.unit, LoneA::Ampere).is_some());
        let at = self.unexplained.windows(2).position(|pair| pair.iter().all(|e| with_unit(e).is_some()))?;
        let sizes = [with_unit(&self.unexplained[at])?, with_unit(&self.unexplained[at + 1])?];
        let value = |index: Option<usize>| index.and_then(|i| self.unexplained.get(i)).map(|e| e.1.as_str());
        Some((sizes, value(at.checked_sub(1)), value(Some(at + 2))))
    }

    /// The channel, the lengths, the unit of the heights and the height per number, for nx x ny numbers.
    pub(super) fn scales(&self, points: [usize; 2]) -> (Option<String>, Lateral, Unit, f64) {
        if let Some(wyko) = &self.wyko {
            return self.wyko_scales(wyko, points);
        }
        let mut length = self.length.clone();
        let mut channel = self.channel.clone();
        let mut value_unit = self.value_unit.as_deref();
        if length == [None, None]
            && let Some(([x, y], name, unit)) = self.gwyddion_sizes()
        {
            length = [Some(x), Some(y)];
            channel = channel.or(name.map(str::to_owned));
            value_unit = value_unit.or(unit);
        }
        for axis in 0..2 {
            // One pixel size stands for both axes.
            let spacing = self.spacing[axis].clone().or(self.spacing[1 - axis].clone());
            if length[axis].is_none() {
                length[axis] = spacing.map(|s| Length { value: s.value * points[axis] as f64, ..s });
            }
        }
        (channel, self.lateral(length), named(value_unit), self.scale.unwrap_or(1.0))
    }

    fn lateral(&self, length: [Option<Length>; 2]) -> Lateral {
        let [Some(x), Some(y)] = length else { return Lateral::Unstated(String::new()) };
        let unit = |length: &Length, axis: usize| {
            let stated = self.lateral_unit[axis].as_ref().or(self.lateral_unit[0].as_ref());
            match (length.unit.as_str(), stated) {
                // SPIP writes lengths in nanometres.
                ("", None) if self.spip => Unit::Metres(1e-9),
                ("", stated) => named(stated.map(String::as_str)),
                (label, _) => named(Some(label)),
            }
        };
        Lateral::of([x.value, y.value], [unit(&x, 0), unit(&y, 1)])
    }

    fn wyko_scales(&self, wyko: &Wyko, points: [usize; 2]) -> (Option<String>, Lateral, Unit, f64) {
        const MM: f64 = 1e-3;
        const NM: f64 = 1e-9;
        let lateral = match wyko.pixel_size {
            Some(pixel) => {
                let aspect = wyko.aspect.unwrap_or(1.0);
                Lateral::Metres([pixel * aspect * points[0] as f64 * MM, pixel * points[1] as f64 * MM])
            }
            None => Lateral::Unstated(String::new()),
        };
        let scale = match (wyko.real_units, wyko.wavelength, wyko.mult) {
            (false, Some(wavelength), Some(mult)) if mult != 0.0 => wavelength / mult,
            _ => 1.0,
        };
        (self.channel.clone(), lateral, Unit::Metres(NM), scale)
    }

    /// Units of the x, y and height columns of points, from column names or Gwyddion's XYZ header.
    pub(super) fn point_units(&self, [x, y, z]: [usize; 3]) -> ([Option<String>; 2], Unit) {
        let columns = self.columns();
        let of_column = |i: usize| columns.get(i).and_then(|c| c.unit.clone());
        let mut lateral =
            [of_column(x).or(self.lateral_unit[0].clone()), of_column(y).or(self.lateral_unit[1].clone())];
        let mut value = of_column(z).or(self.value_unit.clone());
        if lateral == [None, None] {
            // "# <lateral units>: µm", "# <value units>: nm" in a language without known labels.
            let mut units = self.unexplained.iter().filter(|e| metres(&e.1, LoneA::Ampere).is_some());
            if let (Some((_, first)), second) = (units.next(), units.next()) {
                match (second, &value) {
                    (Some((_, second)), None) => {
                        lateral = [Some(first.clone()), Some(first.clone())];
                        value = Some(second.clone());
                    }
                    (None, Some(_)) => lateral = [Some(first.clone()), Some(first.clone())],
                    _ => {}
                }
            }
        }
        (lateral, named(value.as_deref()))
    }
}

/// The unit of that name.
fn named(label: Option<&str>) -> Unit {
    unit_of(label.unwrap_or_default(), LoneA::Ampere)
}

/// "key: value", "key = value", with the wide colon of Japanese and Chinese too.
fn split(text: &str) -> Option<(&str, &str)> {
    let at = text.find([':', '=', '\u{ff1a}'])?;
    // The arrow in "height conversion factor (-> m)" has no "=", and "(-> m)=" comes first.
    let (key, rest) = text.split_at(at);
    let value = rest.trim_start_matches([':', '=', '\u{ff1a}']);
    (!key.trim().is_empty()).then_some((key.trim(), value.trim()))
}

/// The number at the start of a text, with a decimal point or comma, and the rest.
pub(crate) fn leading_number(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    let end = text
        .char_indices()
        .find(|(at, c)| {
            let exponent = matches!(c, 'e' | 'E')
                && text[at + 1..].trim_start_matches(['+', '-']).starts_with(|c: char| c.is_ascii_digit());
            !(c.is_ascii_digit() || matches!(c, '+' | '-' | '.' | ',') || exponent)
        })
        .map_or(text.len(), |(at, _)| at);
    let (digits, rest) = text.split_at(end);
    let value: f64 = digits.replace(',', ".").parse().ok()?;
    value.is_finite().then_some((value, rest.trim()))
}

fn length(text: &str) -> Option<Length> {
    let (value, unit) = leading_number(text)?;
    Some(Length { value, unit: unit.trim_matches(['[', ']', '(', ')']).to_owned() })
}

/// Name and unit of "x in mm", "x/mm", "x_mm", "x, mm" or "x mm".
fn unbracketed(field: &str) -> (&str, Option<String>) {
    let Some((name, unit)) = field.rsplit_once([' ', '/', '_', ',']) else { return (field, None) };
    let name = name.trim_end_matches([' ', '/', '_', ',']);
    let name = name.strip_suffix(" in").or(name.strip_suffix("_in")).unwrap_or(name).trim();
    match !name.is_empty() && metres(unit, LoneA::Ampere).is_some() {
        true => (name, Some(unit.to_owned())),
        false => (field, None),
    }
}

/// Names of columns ("x [mm]; y [mm]; z [µm]"), with a following row of units ("mm; mm; µm").
fn columns(text: &str, before: &[Column]) -> Vec<Column> {
    let separator = [';', '\t', ','].into_iter().find(|s| text.contains(*s)).unwrap_or(' ');
    let fields: Vec<&str> =
        text.split(separator).map(|f| f.trim().trim_matches('"')).filter(|f| !f.is_empty()).collect();
    let bare = |field: &str| field.trim_matches(['[', ']', '(', ')']).to_owned();
    if fields.len() == before.len() && fields.iter().all(|f| metres(&bare(f), LoneA::Angstrom).is_some()) {
        let units = fields.iter().map(|f| Some(bare(f)));
        return before.iter().zip(units).map(|(c, unit)| Column { name: c.name.clone(), unit }).collect();
    }
    let blanks = separator == ' ' && !text.contains([':', '=']);
    // "x and y in mm": a sentence, not the names of three columns.
    let is_sentence = |field: &&str| {
        matches!(*field, "and" | "are" | "is" | "of" | "und" | "sind" | "ist" | "et" | "sont" | "est")
    };
    if blanks && fields.iter().any(is_sentence) {
        return vec![];
    }
    let mut columns: Vec<Column> = vec![];
    for field in fields.into_iter().take(1000) {
        let (name, unit) = match field.split_once(['[', '(']) {
            Some((name, unit)) => (name.trim(), Some(unit.trim_end_matches([']', ')']).trim().to_owned())),
            None => unbracketed(field),
        };
        match columns.last_mut() {
            // "x in mm y in mm"
            Some(_) if blanks && field == "in" => {}
            Some(last) if blanks && last.unit.is_none() && metres(field, LoneA::Ampere).is_some() => {
                last.unit = Some(field.to_owned());
            }
            // "[DATA]": a section.
            None if name.is_empty()
                && unit.as_deref().is_none_or(|unit| metres(unit, LoneA::Angstrom).is_none()) => {}
            // Blanks separate the names of columns, and a name from its unit.
            Some(last) if name.is_empty() && last.unit.is_none() => last.unit = unit,
            _ => columns.push(Column { name: name.to_owned(), unit }),
        }
    }
    columns
}
