//! What rows follow one another in.

/// The axis of the rows of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Axis {
    /// Each row is a time.
    Time,
    /// Each row is a steady state of motion, at its velocity.
    Velocity,
    /// One elastic contact, at no time.
    None,
}

/// Where a row stands on its axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Coordinate {
    /// t \[s\].
    Time(f64),
    /// v \[m/s\].
    Velocity(f64),
    /// Of one elastic contact.
    #[default]
    None,
}

impl Axis {
    /// The row at `value` on this axis.
    pub fn at(self, value: f64) -> Coordinate {
        match self {
            Axis::Time => Coordinate::Time(value),
            Axis::Velocity => Coordinate::Velocity(value),
            Axis::None => Coordinate::None,
        }
    }

    /// Name, the same of several rows, unit, symbol.
    fn words(self) -> [&'static str; 4] {
        match self {
            Axis::Time => ["time", "times", "s", "t"],
            Axis::Velocity => ["velocity", "velocities", "m/s", "v"],
            Axis::None => ["", "", "1", ""],
        }
    }

    /// Name of the coordinate in results; empty without one.
    pub fn name(self) -> &'static str {
        self.words()[0]
    }

    /// Its name for several rows.
    pub fn plural(self) -> &'static str {
        self.words()[1]
    }

    /// Its unit.
    pub fn unit(self) -> &'static str {
        self.words()[2]
    }

    /// Its symbol.
    pub fn symbol(self) -> &'static str {
        self.words()[3]
    }
}

impl Coordinate {
    /// Its axis.
    pub fn axis(self) -> Axis {
        match self {
            Coordinate::Time(_) => Axis::Time,
            Coordinate::Velocity(_) => Axis::Velocity,
            Coordinate::None => Axis::None,
        }
    }

    /// Time \[s\] or velocity \[m/s\]; 0 without either.
    pub fn value(self) -> f64 {
        match self {
            Coordinate::Time(value) | Coordinate::Velocity(value) => value,
            Coordinate::None => 0.0,
        }
    }

    /// The velocity \[m/s\]; `None` of a row that is no steady state of motion.
    pub fn velocity(self) -> Option<f64> {
        match self {
            Coordinate::Velocity(v) => Some(v),
            _ => None,
        }
    }
}
