//! Leakage in words: the settings, the leak rate, and the times at which the seal is tight.

use super::{Coupling, Fluid, GasKind, Leak, LeakDirection, ROOM};
use crate::answer::Units;
use crate::choice;
use crate::readable::quantity;
use asperity::History;
use asperity::drive::Coordinate;
use asperity::traction::Action;

/// 0 degC \[K\].
const ICE: f64 = 273.15;

impl Leak {
    /// The fluid and its pressures: "air at 20 °C from 300 kPa to 100 kPa".
    pub fn fluid_words(&self) -> String {
        let acts = self.coupling.as_ref().map_or("", |coupling| match coupling.action {
            Action::Everywhere => ", which presses the surfaces apart everywhere",
            Action::Gaps(_) => ", which presses the surfaces apart",
        });
        self.bare_words() + acts
    }

    fn bare_words(&self) -> String {
        let changes = |coupling: &Coupling| !matches!(coupling.inlet, History::Step { .. });
        let up_to = if self.coupling.as_ref().is_some_and(changes) { "up to " } else { "" };
        match self.fluid {
            None => "no fluid, the gap alone".to_owned(),
            Some(Fluid::Liquid { pressure_drop, viscosity, .. }) => format!(
                "liquid of {}, pressure drop {up_to}{}",
                quantity(viscosity, "Pa s"),
                quantity(pressure_drop, "Pa")
            ),
            Some(Fluid::Gas { kind, temperature, inlet, outlet, .. }) => {
                let name = match kind {
                    GasKind::Known(species) => species.name(),
                    GasKind::Other { .. } => "gas",
                };
                let at = match temperature {
                    None if !self.temperatures.is_empty() => "the temperature of the run".to_owned(),
                    kelvin => format!("{} °C", (1e3 * (kelvin.unwrap_or(ROOM) - ICE)).round() / 1e3),
                };
                format!("{name} at {at} from {up_to}{} to {}", quantity(inlet, "Pa"), quantity(outlet, "Pa"))
            }
        }
    }

    /// All that decides a leak: the fluid, its pressures, the direction, the sides and what is closed.
    pub fn words(&self) -> String {
        let mut words = self.fluid_words();
        words += match self.direction {
            LeakDirection::X => ", along x",
            LeakDirection::Y => ", along y",
            LeakDirection::Both => ", along x (conductance in both directions)",
        };
        words += &format!(", {} sides", choice::word(&self.sides));
        if let Some(Fluid::Gas { rarefaction, .. }) = &self.fluid {
            words += &format!(", rarefaction: {}", choice::word(rarefaction));
        }
        if self.smallest_gap > 0.0 {
            words += &format!(", gaps below {} closed", quantity(self.smallest_gap, "m"));
        }
        words
    }
}

/// When the seal is tight, in a sentence without its full stop; empty if it leaks at all times. Between two of the times nothing is
/// known, so the sentence names both.
pub fn tight(moments: &[Coordinate], percolates: &[f64], units: &Units) -> String {
    let is_tight: Vec<bool> = percolates.iter().map(|open| *open == 0.0).collect();
    if is_tight.iter().all(|tight| !tight) {
        return String::new();
    }
    if is_tight.iter().all(|tight| *tight) {
        let all = match moments {
            [] | [_] => "tight".to_owned(),
            [first, ..] => format!("tight at all {}", first.axis().plural()),
        };
        return all;
    }
    let changes = (1..is_tight.len()).filter(|n| is_tight[*n] != is_tight[n - 1]).map(|n| {
        let (before, after) = (units.moment(moments[n - 1]), units.coordinate(moments[n]));
        format!("{} between {before} and {after}", if is_tight[n] { "closes" } else { "opens" })
    });
    let start = is_tight[0].then(|| format!("tight at {}", units.moment(moments[0])));
    start.into_iter().chain(changes).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::{Coordinate, Units};

    fn tight(times: &[f64], percolates: &[f64]) -> String {
        let moments: Vec<_> = times.iter().map(|time| Coordinate::Time(*time)).collect();
        super::tight(&moments, percolates, &Units::default())
    }

    #[test]
    fn times_between_which_the_seal_closes_are_named() {
        let times = [0.0, 1.0, 2.0, 3.0, 4.0];
        assert_eq!(tight(&times, &[1.0; 5]), "");
        assert_eq!(tight(&times, &[0.0; 5]), "tight at all times");
        assert_eq!(tight(&times, &[1.0, 1.0, 0.0, 0.0, 0.0]), "closes between t = 1 s and 2 s");
        assert_eq!(
            tight(&times, &[0.0, 1.0, 0.0, 1.0, 1.0]),
            "tight at t = 0 s, opens between t = 0 s and 1 s, closes between t = 1 s and 2 s, opens between t = 2 s and 3 s"
        );
        assert_eq!(
            tight(&times, &[1.0, 0.0, 0.0, 1.0, 1.0]),
            "closes between t = 0 s and 1 s, opens between t = 2 s and 3 s"
        );
    }
}
