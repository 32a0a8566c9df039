//! `[seal]`: a whole seal, of which the case is a patch. `asperity seal` computes it; a single run checks the section and ignores it.

use asperity::Control;
use asperity::seal::{Profile, Shape, Table};

use super::keys::*;
use super::load::Load;
use super::small_table::{of_key, rows};
use super::surface::Surface;
use super::words::number;
use crate::leakage::{Leak, LeakDirection};
use crate::seal::{Rough, SealPlan};

/// A whole seal of which the case is a patch: `asperity seal` runs the case at several mean pressures, and computes how the fluid opens the
/// seal and how much it leaks. The fluid is that of `[leakage]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Seal")]
pub struct SealKeys {
    /// Contact pressure across the seal: "uniform", "hertz" or "parabola", with `peak` and `width`; or a file with the columns x and
    /// pressure, and, where the pressure depends on it, the inlet pressure as a third one.
    #[schemars(example = &"hertz", example = &"contact-pressure.csv")]
    profile: Label,
    /// Largest contact pressure.
    #[schemars(example = "2 MPa")]
    peak: Option<Pressure<Positive>>,
    /// Width of the contact, from the inlet to the outlet.
    #[schemars(example = "1.2 mm")]
    width: Option<Length<Positive>>,
    /// Length of the seal across the flow: its circumference.
    #[schemars(example = "0.4 m")]
    length: Length<Positive>,
    /// Share of the inlet pressure that is added to the contact pressure, from 0 to 1: near 1 for an O-ring in a groove; 0 if not given.
    #[schemars(example = 0.9)]
    energising: Option<Number<Finite>>,
    /// Pressure at the outlet above that which surrounds the seal when its contact pressure is stated; 0 if not given.
    #[schemars(example = "0 bar")]
    outlet: Option<Pressure<Finite>>,
    /// Mean pressures at which the patch is computed, from 8 on; 16 if not given.
    #[schemars(example = 16)]
    pressures: Option<Whole<8>>,
    /// Seeds of the roughness at which each is computed, for the scatter; 3 if not given, or 1 of a measured surface.
    #[schemars(example = 3)]
    seeds: Option<Whole<1>>,
}

/// The most runs of a sweep along one key.
const MOST: usize = 1000;
const SHAPES: [&str; 3] = ["uniform", "hertz", "parabola"];

impl SealKeys {
    /// The section, checked.
    pub(super) fn plan(
        &self,
        at: &Place<'_>,
        load: &Load,
        surfaces: &[Surface],
        leak: Option<&Leak>,
    ) -> Option<SealPlan> {
        let profile =
            Profile { shape: self.shape(at)?, energising: self.energising.map_or(0.0, Number::get) };
        at.core(profile.validate())?;
        let Some(leak) = leak else {
            let message = "a seal needs a fluid, but the case has no [leakage]";
            return at.fault(message, "[leakage] with pressure_drop and viscosity", "add the section");
        };
        let Some(fluid) = leak.fluid else {
            let help = "give [leakage] pressure_drop and viscosity, or gas, inlet and outlet";
            let message = "a seal needs a fluid, but [leakage] has none";
            return at.sibling("leakage").fault(message, "a fluid", help);
        };
        if load.control != Some(Control::Pressure) || !at.sibling("load").has("history.value") {
            let help = "set load.control = \"pressure\" and load.history = { kind = \"step\", value = \"...\" }; the value is that of a single run";
            let message = "a seal is computed from runs at several mean pressures";
            let expected = "load.control = \"pressure\" and a history with a `value`";
            return at.sibling("load").fault(message, expected, help);
        }
        let rough = surfaces.iter().enumerate().find_map(|(n, surface)| surface.rough(n));
        let seeds = match (self.seeds.map(Whole::count), &rough) {
            (None, Some(_)) => 3,
            (None, None) => 1,
            (Some(seeds), None) if seeds > 1 => {
                let help = "leave `seeds` out: a measured surface is one; compute other measurements in their own folders";
                let message = "no surface of the case has a seed";
                return at.key("seeds").fault(message, "a surface of the kind self-affine", help);
            }
            (Some(seeds), _) if seeds > MOST => return at.key("seeds").wrong(format!("{MOST} at most"), ""),
            (Some(seeds), _) => seeds,
        };
        let pressures = self.pressures.map_or(16, Whole::count);
        if pressures > MOST {
            return at.key("pressures").wrong(format!("a number from 8 to {MOST}"), "");
        }
        let outlet = self.outlet.map_or(0.0, Pressure::get);
        let inlet = outlet + fluid.pressure_drop();
        if profile.largest(inlet).is_none() {
            let [from, to] = profile.inlets().unwrap_or_default().map(number);
            let message = format!(
                "the pressure at the inlet is {} Pa, but the file has pressures from {from} Pa to {to} Pa only",
                number(inlet)
            );
            let expected = "a profile at this inlet pressure";
            return at.key("profile").fault(message, expected, "add rows to the file");
        }
        let patch = match leak.direction {
            LeakDirection::Y => 1,
            LeakDirection::X | LeakDirection::Both => 0,
        };
        let (length, ends, leak) = (self.length.get(), [inlet, outlet], leak.clone());
        Some(SealPlan { profile, length, pressures, seeds, rough, patch, ends, leak, windowed: vec![] })
    }

    fn shape(&self, at: &Place<'_>) -> Option<Shape> {
        let name = self.profile.get();
        if !SHAPES.contains(&name) {
            if !name.contains('.') {
                return at
                    .key("profile")
                    .wrong("\"uniform\", \"hertz\", \"parabola\", or a file such as \"pressure.csv\"", "");
            }
            let why = "belongs to a profile of a known shape, but the profile is a file";
            at.without(&["peak", "width"], why, "the file alone", "leave it out")?;
            let columns =
                "a file of the columns x, contact pressure and, if there are several, inlet pressure";
            return of_key(&at.key("profile"), name, columns, parse).map(Shape::Table);
        }
        let (Some(peak), Some(width)) = (self.peak, self.width) else {
            let key = if self.peak.is_none() { "peak" } else { "width" };
            return at.missing(key, &format!(" for the profile \"{name}\""));
        };
        let (peak, width) = (peak.get(), width.get());
        Some(match name {
            "uniform" => Shape::Uniform { peak, width },
            "hertz" => Shape::Hertz { peak, width },
            _ => Shape::Parabola { peak, width },
        })
    }
}

impl Surface {
    /// The seed and the longest wave of a random roughness, the n-th surface.
    fn rough(&self, n: usize) -> Option<Rough> {
        match &self.kind {
            super::surface::Kind::SelfAffine(roughness) => Some(Rough {
                key: format!("surface.{n}.seed"),
                seed: roughness.seed.get(),
                longest: roughness.longest.map(Length::get),
            }),
            _ => None,
        }
    }
}

/// The profile in a file, for each of its inlet pressures.
fn parse(text: &str) -> Result<Vec<Table>, String> {
    let mut tables: Vec<Table> = vec![];
    let mut columns: Option<usize> = None;
    let alike = |cells: &[&str]| {
        let count = cells.len();
        if (2..=3).contains(&count) && *columns.get_or_insert(count) == count {
            return Ok(());
        }
        let expected = columns.map_or("2 or 3".to_owned(), |columns| columns.to_string());
        Err(format!("there are {count} columns, but {expected} are expected, as in \"0.1 mm, 2 MPa\""))
    };
    rows(text, alike, |row| {
        let x: Length<Finite> = row.quantity(0, "place", Prescribed::resolve)?;
        let x = x.get();
        let pressure = |column: usize, what: &str| -> Result<f64, String> {
            let read: Pressure<Finite> = row.quantity(column, what, Prescribed::resolve)?;
            Ok(read.get())
        };
        let p0 = pressure(1, "contact pressure")?;
        if p0 < 0.0 {
            return Err(format!("the contact pressure is {} Pa, but must be 0 or more", number(p0)));
        }
        let inlet = if row.cells.len() == 3 { pressure(2, "inlet pressure")? } else { 0.0 };
        match tables.last_mut() {
            Some(table) if table.inlet == inlet => {
                if table.points.last().is_some_and(|last| last.0 >= x) {
                    return Err(format!(
                        "the place {} m does not lie beyond the one before it; sort the rows by inlet pressure, then by x",
                        number(x)
                    ));
                }
                table.points.push((x, p0));
            }
            Some(table) if table.inlet > inlet => {
                return Err(format!(
                    "the inlet pressure {} Pa comes after {} Pa; sort the rows by inlet pressure",
                    number(inlet),
                    number(table.inlet)
                ));
            }
            _ => tables.push(Table { inlet, points: vec![(x, p0)] }),
        }
        Ok(())
    })?;
    if tables.is_empty() { Err("there is no row in the file".to_owned()) } else { Ok(tables) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn profiles_have_two_columns_or_three() {
        let two = parse("# FE\nx [mm], p [MPa]\n0, 0\n1, 2\n2, 0").unwrap();
        assert_eq!(two, [Table { inlet: 0.0, points: vec![(0.0, 0.0), (1e-3, 2e6), (2e-3, 0.0)] }]);
        let three =
            parse("0 mm\t1 MPa\t1 bar\n1 mm\t2 MPa\t1 bar\n0 mm\t2 MPa\t2 bar\n1 mm\t3 MPa\t2 bar").unwrap();
        assert_eq!(three.iter().map(|table| table.inlet).collect::<Vec<_>>(), [1e5, 2e5]);
        for (text, words) in [
            ("", "no row"),
            ("0 mm, -1 MPa", "line 1: the contact pressure is"),
            ("0 mm, 1 MPa\n0 mm, 2 MPa", "line 2: the place 0 m does not lie beyond"),
            ("0 mm, 1 MPa, 2 bar\n0 mm, 2 MPa, 1 bar", "line 2: the inlet pressure"),
            ("0 mm, 1 MPa\n1mm", "line 2: there are 1 columns"),
            ("0 mm, 1 mm", "the contact pressure is \"1 mm\""),
        ] {
            let message = parse(text).unwrap_err();
            assert!(message.contains(words), "{text:?}: {message}");
        }
    }
}
