//! The contact pressure across a seal, p0(x), x from 0 at the inlet to its width at the outlet.
//!
//! A seal that the fluid presses on carries `energising` times the inlet pressure more at every place.

use crate::error::{Error, Result};

/// Contact pressure over the place across the seal.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// Without the inlet pressure, or as a table over it.
    pub shape: Shape,
    /// Share of the inlet pressure that is added to the contact pressure, from 0 to 1.
    pub energising: f64,
}

/// The shape of a profile.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// p0 = peak.
    Uniform {
        /// Largest pressure \[Pa\].
        peak: f64,
        /// Width of the contact \[m\].
        width: f64,
    },
    /// p0 = peak sqrt(1 - u^2), u from -1 to 1 across the width.
    Hertz {
        /// Largest pressure \[Pa\].
        peak: f64,
        /// Width of the contact \[m\].
        width: f64,
    },
    /// p0 = peak (1 - u^2).
    Parabola {
        /// Largest pressure \[Pa\].
        peak: f64,
        /// Width of the contact \[m\].
        width: f64,
    },
    /// Straight between points, for one inlet pressure or several.
    Table(Vec<Table>),
}

/// Points of a profile at an inlet pressure.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Inlet pressure \[Pa\].
    pub inlet: f64,
    /// Place \[m\] and contact pressure \[Pa\].
    pub points: Vec<(f64, f64)>,
}

impl Profile {
    /// Checks the numbers.
    ///
    /// # Errors
    /// [`Error::Invalid`] with the name of the argument.
    pub fn validate(&self) -> Result<()> {
        if !(0.0..=1.0).contains(&self.energising) {
            return Err(Error::invalid("the energising factor", self.energising, "a number from 0 to 1")
                .of("energising"));
        }
        let positive = |what: &str, of: &str, value: f64| match value.is_finite() && value > 0.0 {
            true => Ok(()),
            false => Err(Error::invalid(what, value, "a number above 0").of(of)),
        };
        match &self.shape {
            Shape::Uniform { peak, width }
            | Shape::Hertz { peak, width }
            | Shape::Parabola { peak, width } => {
                positive("the largest contact pressure", "peak", *peak)?;
                positive("the width of the seal", "width", *width)
            }
            Shape::Table(tables) if tables.len() > 1 && self.energising > 0.0 => {
                let expected = "0: the profile over the inlet pressure has what the inlet pressure adds";
                Err(Error::invalid("the energising factor", self.energising, expected).of("energising"))
            }
            Shape::Table(tables) => check(tables),
        }
    }

    /// Width of the contact \[m\].
    pub fn width(&self) -> f64 {
        match &self.shape {
            Shape::Uniform { width, .. } | Shape::Hertz { width, .. } | Shape::Parabola { width, .. } => {
                *width
            }
            Shape::Table(tables) => {
                let points = tables.first().map_or(&[][..], |table| &table.points);
                points.last().map_or(0.0, |last| last.0) - points.first().map_or(0.0, |first| first.0)
            }
        }
    }

    /// p0 in the middles of so many cells across the width, at an inlet pressure \[Pa\]; `None` where no table reaches it.
    pub fn pressures(&self, cells: usize, inlet: f64) -> Option<Vec<f64>> {
        let places = (0..cells).map(|n| (n as f64 + 0.5) / cells as f64);
        let added = self.energising * inlet;
        Some(match &self.shape {
            Shape::Uniform { peak, .. } => vec![peak + added; cells],
            Shape::Hertz { peak, .. } => {
                places.map(|x| peak * (1.0 - (2.0 * x - 1.0).powi(2)).sqrt() + added).collect()
            }
            Shape::Parabola { peak, .. } => {
                places.map(|x| peak * (1.0 - (2.0 * x - 1.0).powi(2)) + added).collect()
            }
            Shape::Table(tables) => {
                let table = Between::of(tables, inlet)?;
                let start = tables[0].points[0].0;
                places.map(|x| table.at(start + x * self.width()) + added).collect()
            }
        })
    }

    /// The largest p0 \[Pa\] at an inlet pressure; `None` where no table reaches it.
    pub fn largest(&self, inlet: f64) -> Option<f64> {
        let largest = match &self.shape {
            Shape::Uniform { peak, .. } | Shape::Hertz { peak, .. } | Shape::Parabola { peak, .. } => *peak,
            // A straight line is largest at an end.
            Shape::Table(tables) => {
                let table = Between::of(tables, inlet)?;
                table.places().map(|x| table.at(x)).fold(0.0, f64::max)
            }
        };
        Some(largest + self.energising * inlet)
    }

    /// The largest p0 less the inlet pressure \[Pa\]: what keeps the seal closed.
    pub fn pressed(&self, inlet: f64) -> Option<f64> {
        self.largest(inlet).map(|largest| largest - inlet)
    }

    /// The inlet pressures of several tables; `None` where the contact pressure is known for all of them.
    pub fn inlets_of_tables(&self) -> Option<Vec<f64>> {
        match &self.shape {
            Shape::Table(tables) if tables.len() > 1 => {
                Some(tables.iter().map(|table| table.inlet).collect())
            }
            _ => None,
        }
    }

    /// The inlet pressures \[Pa\] that the profile is known for; `None` for all.
    pub fn inlets(&self) -> Option<[f64; 2]> {
        let inlets = self.inlets_of_tables()?;
        Some([*inlets.first()?, *inlets.last()?])
    }
}

/// A profile between two tables.
struct Between<'a> {
    tables: [&'a Table; 2],
    /// How far from the first table to the second one.
    share: f64,
}

impl<'a> Between<'a> {
    /// At an inlet pressure; `None` where the tables do not reach it.
    fn of(tables: &'a [Table], inlet: f64) -> Option<Self> {
        let after = tables.partition_point(|table| table.inlet < inlet);
        let [a, b] = match tables.len() {
            1 => [&tables[0]; 2],
            _ if tables.get(after)?.inlet == inlet => [&tables[after]; 2],
            _ => [tables.get(after.checked_sub(1)?)?, &tables[after]],
        };
        let share = if a.inlet == b.inlet { 0.0 } else { (inlet - a.inlet) / (b.inlet - a.inlet) };
        Some(Between { tables: [a, b], share })
    }

    fn at(&self, x: f64) -> f64 {
        let [a, b] = self.tables.map(|table| table.at(x));
        (1.0 - self.share) * a + self.share * b
    }

    /// Places between which it is straight.
    fn places(&self) -> impl Iterator<Item = f64> + '_ {
        self.tables.into_iter().flat_map(|table| table.points.iter().map(|point| point.0))
    }
}

impl Table {
    fn at(&self, x: f64) -> f64 {
        let after = self.points.partition_point(|point| point.0 <= x).clamp(1, self.points.len() - 1);
        let [a, b] = [self.points[after - 1], self.points[after]];
        a.1 + (b.1 - a.1) * (x - a.0) / (b.0 - a.0)
    }
}

fn check(tables: &[Table]) -> Result<()> {
    let wrong =
        |what: &str, value: f64, expected: String| Err(Error::invalid(what, value, expected).of("profile"));
    if tables.is_empty() || tables.iter().any(|table| table.points.len() < 2) {
        return wrong("the number of points of the profile", 0.0, "two places or more".into());
    }
    let ends = |table: &Table| [table.points[0].0, table.points[table.points.len() - 1].0];
    for (n, table) in tables.iter().enumerate() {
        if !(table.inlet.is_finite() && (n == 0 || table.inlet > tables[n - 1].inlet)) {
            return wrong(
                "the inlet pressure of the profile",
                table.inlet,
                "inlet pressures that increase".into(),
            );
        }
        if ends(table) != ends(&tables[0]) {
            let [from, to] = ends(&tables[0]);
            return wrong(
                "the first place of the profile",
                ends(table)[0],
                format!("places from {from} m to {to} m at every inlet pressure"),
            );
        }
        if let Some(pair) =
            table.points.windows(2).find(|pair| !(pair[1].0 > pair[0].0 && pair[1].0.is_finite()))
        {
            return wrong(
                "the place in the profile",
                pair[1].0,
                format!("a place beyond {} m: sort the rows by x", pair[0].0),
            );
        }
        if let Some(point) = table.points.iter().find(|point| !(point.1.is_finite() && point.1 >= 0.0)) {
            return wrong(
                "the contact pressure in the profile",
                point.1,
                format!("a pressure of 0 or more at x = {} m", point.0),
            );
        }
    }
    match tables.iter().find(|table| table.points.iter().all(|point| point.1 == 0.0)) {
        Some(_) => wrong("the largest contact pressure of the profile", 0.0, "a pressure above 0".into()),
        None => Ok(()),
    }
}
