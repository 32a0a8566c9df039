//! What can be known of a simulation to be wrong before its first solve.

use super::{Plasticity, Scheme, Simulation};
use crate::error::{Error, Result, require};
use crate::grid::Boundary;
use crate::load::{Control, Course, Event, History, of_stage};
use crate::material::Creep;
use crate::quantities::Quantity;
use crate::time::SAME;

/// Fewer steps than this to the period of a sine miss its course.
const LEAST_PER_PERIOD: f64 = 20.0;

/// Layers on a rigid base under a periodic domain may be so many times as thick as the domain is wide: the tolerance is relative
/// to displacements that include their uniform compression.
const DEEPEST: f64 = 1000.0;

impl Simulation {
    /// Checks all that can be known before the first solve.
    ///
    /// # Errors
    /// [`Error::Invalid`], [`Error::Infeasible`].
    pub fn validate(&self) -> Result<()> {
        self.validate_gap()?;
        self.validate_kernel()?;
        self.parts().try_for_each(Creep::validate)?;
        let yields = self.parts().any(|creep| creep.value(f64::MAX.sqrt()) > 0.0);
        require(yields, "contact creep compliance", 0, "greater than 0 (both bodies are rigid)")?;
        require(self.hardness > 0.0, "hardness", format!("{} Pa", self.hardness), "greater than 0")?;
        self.validate_hardness_map()?;
        self.validate_line()?;
        require(
            self.plasticity == Plasticity::Cap || self.hardness.is_finite() || self.hardness_map.is_some(),
            "hardness",
            "infinite",
            "finite where flattening stays (plasticity \"accumulate\"): nothing is flattened without",
        )?;
        self.columns()?;
        self.validate_energy()?;
        self.validate_layers()?;
        self.loading.validate()?;
        self.times.validate()?;
        require(
            self.scheme == Scheme::Linear || !self.is_adaptive(),
            "scheme of a run with adaptive steps",
            format!("{:?}", self.scheme).to_lowercase(),
            "linear (the error estimate belongs to it)",
        )?;
        self.solver.validate()?;
        self.motion.iter().try_for_each(|motion| motion.validate(self))?;
        self.validate_histories()?;
        self.validate_steps()?;
        self.validate_load()?;
        self.validate_jumps()
    }

    fn validate_gap(&self) -> Result<()> {
        let gap = &self.gap;
        let [nx, ny] = self.grid.cells();
        let expected = format!("that of the grid, ({nx}, {ny})");
        require(gap.dim() == self.grid.shape(), "shape of the gap", format!("{:?}", gap.dim()), expected)?;
        require(gap.is_standard_layout(), "memory order of the gap", "not C-order", "C-order")?;
        if let Some(((i, j), h)) = gap.indexed_iter().find(|(_, h)| h.is_nan() || **h == f64::NEG_INFINITY) {
            let expected = "a number (infinite where the cell cannot touch)";
            return Err(Error::invalid(format!("gap at cell ({i}, {j})"), h, expected));
        }
        let touches = gap.iter().any(|h| h.is_finite());
        require(touches, "gap", "infinite everywhere", "finite in one cell at least")
    }

    fn validate_kernel(&self) -> Result<()> {
        if self.boundary == Boundary::Free {
            return self.kernel.check(self.grid.longest_cell());
        }
        let (depth, widest) = (self.kernel.depth().unwrap_or(0.0), self.grid.longest_side());
        require(
            depth <= DEEPEST * widest,
            "thickness of the layers on their rigid base",
            format!("{depth:e} m"),
            format!(
                "at most {DEEPEST} times the periodic domain, {widest:e} m: no wave reaches the base, but its compression would swamp \
                 the displacements; describe the body as a half-space"
            ),
        )
    }

    fn validate_hardness_map(&self) -> Result<()> {
        let Some(map) = &self.hardness_map else { return Ok(()) };
        let expected = format!("{:?}, one for each cell", self.grid.shape());
        let shape = format!("{:?}", map.dim());
        require(map.dim() == self.grid.shape(), "shape of the hardness of the cells", shape, expected)?;
        match map.indexed_iter().find(|(_, h)| !(h.is_finite() && **h > 0.0)) {
            Some(((i, j), h)) => {
                let what = format!("hardness of cell ({i}, {j})");
                Err(Error::invalid(what, format!("{h} Pa"), "finite and greater than 0"))
            }
            None => Ok(()),
        }
    }

    fn validate_energy(&self) -> Result<()> {
        let energies = self.quantities.list.iter().filter(|quantity| quantity.is_energy());
        let names: Vec<_> = energies.map(|quantity| quantity.name()).collect();
        let names = names.join(", ");
        let expected = format!(
            "linear or constant where {names} is asked for: the full hereditary sum knows no springs and dashpots"
        );
        require(names.is_empty() || self.scheme != Scheme::Direct, "scheme", "direct", expected)
    }

    /// What goes with layers that creep differently.
    fn validate_layers(&self) -> Result<()> {
        if self.layers.is_none() {
            return Ok(());
        }
        let require = |holds: bool, what: &str, value: String, expected: &str| {
            require(holds, format!("{what} of layers that creep differently"), value, expected)
        };
        let scheme = format!("{:?}", self.scheme).to_lowercase();
        require(self.scheme == Scheme::Linear, "scheme", scheme, "linear")?;
        require(self.thermal.is_empty(), "temperature", "not constant".into(), "a constant one")?;
        let expected = "none: the contact stays in its place";
        require(self.motion.is_none(), "motion", "given".into(), expected)?;
        let unknown = |q: &&Quantity| q.is_energy() || **q == Quantity::ContactStiffness;
        let unknown = self.quantities.list.iter().find(unknown).map_or("", |quantity| quantity.name());
        require(unknown.is_empty(), "quantity", unknown.into(), "another one")
    }

    /// Where displacements are known up to a constant.
    fn validate_line(&self) -> Result<()> {
        if !self.is_up_to_a_constant() {
            return Ok(());
        }
        require(self.grid.len() > 1, "number of cells of a free line contact", 1, "2 at least")?;
        for (n, stage) in self.loading.stages.iter().enumerate() {
            let expected = "a load or a pressure: under a load on a line a half-space moves endlessly, so the approach is known up \
                            to a constant that depends on the domain; a periodic domain (boundary = \"periodic\") has no such limit, \
                            nor have layers on a rigid base";
            let event = matches!(stage.until, Some(Event::Approach(_)));
            self.of_stage(n, require(!event, "event of a free line contact", "an approach", expected))?;
            let control = stage.control != Control::Approach;
            self.of_stage(n, require(control, "control of a free line contact", "approach", expected))?;
        }
        let moves = self.motion.is_some();
        let depends = |q: &&Quantity| q.is_of_time() || **q == Quantity::DissipatedPower && moves;
        let depends = self.quantities.list.iter().find(depends).map_or("", |quantity| quantity.name());
        require(
            depends.is_empty(),
            "quantity of a free line contact",
            depends,
            "one that does not depend on displacements, which are known up to a constant; a periodic domain has no such limit",
        )
    }

    /// An error says which stage it is of, where there are several.
    fn of_stage(&self, n: usize, checked: Result<()>) -> Result<()> {
        checked.map_err(|error| if self.loading.stages.len() > 1 { of_stage(error, n) } else { error })
    }

    /// Times of a history must be apart.
    fn validate_histories(&self) -> Result<()> {
        let end = self.times.end();
        for (n, stage) in self.loading.stages.iter().enumerate() {
            let Course::Given(history) = &stage.course else { continue };
            let close = |pair: &&[f64]| pair[1] > pair[0] && pair[1] - pair[0] <= SAME * end;
            let times: Vec<f64> = std::iter::once(0.0).chain(history.breaks(end)).collect();
            let Some(pair) = times.windows(2).find(close) else { continue };
            let apart = SAME * end;
            let expected =
                format!("at least {apart:e} s apart, {SAME:e} of the run: rounding joins closer ones");
            let pair = format!("{} s and {} s", pair[0], pair[1]);
            self.of_stage(n, Err(Error::invalid("times of the history", pair, expected)))?;
        }
        Ok(())
    }

    /// Steps must follow a sine.
    fn validate_steps(&self) -> Result<()> {
        let end = self.times.end();
        let mut longest = vec![0.0_f64; self.loading.stages.len()];
        for instant in self.plan().instants {
            longest[instant.stage] = longest[instant.stage].max(instant.dt);
        }
        for (n, (stage, longest)) in self.loading.stages.iter().zip(longest).enumerate() {
            let Course::Given(History::Sine { amplitude, frequency, .. }) = stage.course else { continue };
            let grid = stage.times.as_ref().unwrap_or(&self.times);
            let follows =
                amplitude == 0.0 || grid.is_adaptive() || longest * frequency <= 1.001 / LEAST_PER_PERIOD;
            let lasts = stage.duration.unwrap_or(end).min(grid.end());
            let expected = format!(
                "at most {} s, {LEAST_PER_PERIOD} steps to a period: {} uniform steps at least, or adaptive ones",
                1.0 / (LEAST_PER_PERIOD * frequency),
                (LEAST_PER_PERIOD * frequency * lasts).ceil(),
            );
            let longest = format!("{longest} s");
            self.of_stage(n, require(follows, "longest time step under a sine", longest, expected))?;
        }
        Ok(())
    }

    fn validate_load(&self) -> Result<()> {
        let end = self.times.end();
        for (n, stage) in self.loading.stages.iter().enumerate() {
            let (factor, what, unit) = match stage.control {
                Control::Approach => continue,
                Control::Load => (1.0, "smallest load", "N"),
                Control::Pressure => (self.grid.area(), "smallest mean pressure", "Pa"),
            };
            let lasts = stage.duration.unwrap_or(end).min(end);
            let [least, most] = match &stage.course {
                Course::Given(history) => history.range(lasts),
                Course::Hold => continue,
                Course::RampTo { value, .. } => [*value; 2],
            };
            let presses = least >= 0.0 || least.is_nan() || self.traction.is_some();
            let least = format!("{least} {unit}");
            self.of_stage(n, require(presses, what, least, "not negative (bodies only press)"))?;
            let max = self.most() * self.grid.cell_area();
            if most * factor > max * (1.0 + 1e-12) {
                return Err(Error::Infeasible { load: most * factor, max });
            }
        }
        Ok(())
    }

    /// Sum of the cut-off over the cells that can touch \[Pa\].
    fn most(&self) -> f64 {
        let touchable = |h: &f64| h.is_finite();
        match self.hardness_of_cells() {
            Some(cells) => {
                self.gap.iter().zip(cells).filter(|(h, _)| touchable(h)).map(|(_, cell)| cell).sum()
            }
            None => self.hardness * self.gap.iter().filter(|h| touchable(h)).count() as f64,
        }
    }

    /// Without instantaneous compliance nothing follows a jump.
    fn validate_jumps(&self) -> Result<()> {
        if self.instantaneous() > 0.0 {
            return Ok(());
        }
        let (mut last, mut stage) = (0.0, 0);
        for instant in self.plan().instants {
            // What a stage starts from may be known only as the run goes; the march looks then.
            require(
                !instant.jump || instant.stage != stage || instant.value == last,
                format!("jump of the history at t = {} s", instant.time),
                format!("{last:e} to {:e}", instant.value),
                "a ramp: the material has no instantaneous compliance, so no contact follows a jump",
            )?;
            (last, stage) = (instant.value, instant.stage);
        }
        Ok(())
    }
}
