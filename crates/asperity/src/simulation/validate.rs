//! What can be known of a simulation to be wrong before its first solve.

use super::{Plasticity, Scheme, Simulation};
use crate::error::{Error, Of, Result, require};
use crate::grid::Boundary;
use crate::load::{Control, Course, Event, History, Programme, Stage, of_stage};
use crate::material::Creep;
use crate::quantities::{Quantity, RowNumber};
use crate::time::{Instant, SAME};

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
        self.validate_numbers()?;
        self.columns().of("output")?;
        self.validate_kernel()?;
        self.motion.iter().try_for_each(|motion| motion.validate(self).of("motion"))?;
        self.wear.iter().try_for_each(|wear| wear.validate_sliding(self))?;
        self.quantities.list.iter().try_for_each(|quantity| self.allows(*quantity))?;
        self.awaited()?;
        self.faults().into_iter().next().map_or(Ok(()), Err)
    }

    /// Whether rows have what the stages wait for, as far as the motion tells.
    ///
    /// # Errors
    /// [`Error::Invalid`] with what stands against it.
    pub fn awaited(&self) -> Result<()> {
        let mut stages = self.loading.stages.iter().enumerate();
        stages.try_for_each(|(n, stage)| self.of_stage(n, self.validate_awaited(stage)))
    }

    /// Everything that is wrong apart from the gap and what depends on it, the motion for one; the gap may still be empty. The parameters of the errors
    /// are keys of case files ("time.scheme", "load.stages\[1\].history").
    pub fn faults(&self) -> Vec<Error> {
        // The other checks rely on numbers that are valid by themselves.
        if let Err(error) = self.validate_numbers() {
            return vec![error];
        }
        let instants = self.plan().instants;
        let mut checks = vec![
            self.validate_line(),
            self.quantities.validate(self.is_capped()).of("output"),
            self.validate_plasticity(),
            self.validate_scheme(),
            self.validate_layers(),
            self.flash.iter().try_for_each(|flash| flash.validate(self)).of("flash"),
            self.validate_traction(),
            self.tangential.iter().try_for_each(|tangential| tangential.validate(self)),
            self.wear.iter().try_for_each(|wear| wear.validate(self)),
            self.validate_jumps(&instants),
        ];
        let stages = 0..self.loading.stages.len();
        checks.extend(stages.flat_map(|n| {
            let stage = &self.loading.stages[n];
            let own = instants.iter().filter(|instant| instant.stage == n);
            let checks = [
                self.validate_history(stage),
                self.validate_steps(stage, own),
                self.validate_load(stage),
                self.validate_event(stage),
            ];
            checks.map(|checked| self.of_stage(n, checked))
        }));
        checks.into_iter().filter_map(Result::err).collect()
    }

    /// Checks a stage that is prescribed between two rows, by the rules of the stages of the run.
    ///
    /// # Errors
    /// As [`validate`](Self::validate), for this stage.
    pub(crate) fn validate_prescribed(&self, stage: &Stage) -> Result<()> {
        stage.validate(true)?;
        self.validate_control(stage)?;
        self.validate_event(stage)?;
        self.validate_awaited(stage)?;
        if let Some(quantity) = stage.awaited() {
            let expected = "one that the run computes. Ask for it in the quantities of the run";
            require(self.takes(quantity), "quantity of the event", quantity, expected).of("until")?;
        }
        self.validate_history(stage)?;
        let instants = Programme::new(vec![stage.clone()]).plan(&self.times, &[]).instants;
        self.validate_steps(stage, instants.iter())?;
        self.validate_load(stage)?;
        let jumps = instants.iter().any(|instant| instant.jump && instant.time > 0.0);
        let expected =
            "a course without jumps: the bodies have no instantaneous compliance, so no contact follows one";
        require(!jumps || self.instantaneous() > 0.0, "history", "with a jump", expected)
    }

    /// Whether rows can have this quantity.
    ///
    /// # Errors
    /// [`Error::Invalid`] with what stands against it.
    pub fn allows(&self, quantity: Quantity) -> Result<()> {
        let is_energy = quantity.is_energy();
        let moves = self.motion.is_some();
        let of_displacements = quantity.is_of_time() || quantity == Quantity::DissipatedPower && moves;
        let expected = if self.is_up_to_a_constant() && of_displacements {
            "one that does not depend on displacements. A line contact on a free domain knows them only up to a constant; a \
             periodic domain (boundary = \"periodic\") has no such limit"
        } else if self.scheme == Scheme::Direct && is_energy {
            "one that is no energy. Energies need the springs and dashpots of the material, which scheme = \"direct\" does not \
             use; set time.scheme to \"linear\" or \"constant\""
        } else if self.tangential.as_ref().is_some_and(|law| law.is_coupled()) && is_energy {
            "one that is no energy where pressure and tangential tractions act on each other: the account of the bodies leaves \
             that out. Take slip_work, the work of friction, or friction.coupling = \"neglect\""
        } else if self.layers.is_some() && (of_displacements || quantity == Quantity::ContactStiffness) {
            "one that is solved for layers that creep differently. Leave it out, or give all layers and bodies the same relative \
             creep"
        } else if quantity == Quantity::ContactStiffness && self.traction.is_some() {
            "one that an adhesive contact, or one that a fluid acts on, has: its stiffness includes theirs and is infinite where cells snap"
        } else if quantity == Quantity::PlasticVolume && self.plasticity == Plasticity::Cap {
            "one that the rows have. Flattening disappears with plasticity = \"cap\"; set solver.plasticity to \"accumulate\""
        } else if quantity.is_of_wear() && self.wear.is_none() {
            "one that the rows have. Only surfaces that wear have this one: add [wear]"
        } else if quantity.is_tangential() && self.tangential.is_none() {
            "one that the rows have. Only a contact with a load along its surfaces has this one: add [friction] and [tangential]"
        } else if quantity.is_of_flash() && self.flash.is_none() {
            "one that the rows have. Only a contact whose friction warms the surfaces has this one: add [flash]"
        } else if quantity == Quantity::MaterialTemperature
            && self.flash.as_ref().is_some_and(|flash| flash.feedback.is_none())
        {
            "one that the rows have. This one needs flash.feedback = \"mean\""
        } else if quantity.is_of_traction() && !self.has_traction_with(quantity) {
            match Quantity::of_adhesion().any(|own| own == quantity) {
                true => "one that the rows have. Only an adhesive contact has this one: add [adhesion]",
                false => {
                    "one that the rows have. Only a contact that a fluid acts on has this one: set leakage.coupling to \"two-way\""
                }
            }
        } else if is_energy
            && quantity != Quantity::ElasticEnergy
            && self.traction.as_ref().is_some_and(|law| law.as_fluid().is_some())
        {
            "one that does not need the work of the fluid, which is not known. The elastic energy does not"
        } else {
            return Ok(());
        };
        Err(Error::invalid("quantity", quantity, expected).of("output.quantities"))
    }

    /// Numbers that are wrong by themselves.
    fn validate_numbers(&self) -> Result<()> {
        self.parts().try_for_each(Creep::validate)?;
        let yields = self.parts().any(|creep| creep.value(f64::MAX.sqrt()) > 0.0);
        require(yields, "contact creep compliance", 0, "greater than 0 (both bodies are rigid)")?;
        require(self.hardness > 0.0, "hardness", format!("{} Pa", self.hardness), "greater than 0")?;
        self.validate_hardness_map()?;
        self.loading.validate()?;
        self.times.validate()?;
        self.solver.validate()
    }

    /// Whether a hardness limits the pressure.
    pub(crate) fn is_capped(&self) -> bool {
        self.hardness.is_finite() || self.hardness_map.is_some()
    }

    fn validate_plasticity(&self) -> Result<()> {
        require(
            self.plasticity == Plasticity::Cap || self.is_capped(),
            "hardness",
            "infinite",
            "finite where flattening stays (plasticity \"accumulate\"). No body has one; give a body its `hardness`",
        )
        .of("solver.plasticity")
    }

    fn validate_scheme(&self) -> Result<()> {
        require(
            self.scheme == Scheme::Linear || !self.is_adaptive(),
            "scheme of a run with adaptive steps",
            format!("{:?}", self.scheme).to_lowercase(),
            "linear. The error estimate of adaptive steps is derived for it; omit `scheme`, or use spacing = \"log\" with `steps`",
        )
        .of("time.scheme")
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

    /// What goes with layers that creep differently.
    fn validate_layers(&self) -> Result<()> {
        if self.layers.is_none() {
            return Ok(());
        }
        let require = |holds: bool, parameter: &str, what: &str, value: String, expected: &str| {
            let what = format!("{what} of layers that creep differently");
            require(holds, what, value, expected).of(parameter)
        };
        let scheme = format!("{:?}", self.scheme).to_lowercase();
        require(self.scheme == Scheme::Linear, "time.scheme", "scheme", scheme, "linear")?;
        let expected = "constant. Hold it constant, or give all layers the same relative creep";
        require(self.thermal.is_empty(), "temperature", "temperature", "not constant".into(), expected)
    }

    fn has_traction_with(&self, quantity: Quantity) -> bool {
        self.traction.as_ref().is_some_and(|law| law.quantities().contains(&quantity))
    }

    /// What goes with a traction besides the contact.
    fn validate_traction(&self) -> Result<()> {
        self.traction.iter().try_for_each(|traction| traction.check(self))
    }

    /// Where displacements are known up to a constant.
    fn validate_line(&self) -> Result<()> {
        if !self.is_up_to_a_constant() {
            return Ok(());
        }
        require(self.grid.len() > 1, "number of cells of a free line contact", 1, "2 at least")
            .of("domain.cells")?;
        (0..self.loading.stages.len())
            .try_for_each(|n| self.of_stage(n, self.validate_control(&self.loading.stages[n])))
    }

    /// Where displacements are known up to a constant, no approach can be prescribed or waited for.
    fn validate_control(&self, stage: &Stage) -> Result<()> {
        if !self.is_up_to_a_constant() {
            return Ok(());
        }
        let expected = "a load or a pressure. Under a load on a line a half-space moves endlessly, so the approach is known up \
                        to a constant that depends on the domain; a periodic domain (boundary = \"periodic\") has no such limit, \
                        nor have layers on a rigid base";
        let of_approach = [
            ("until", "event", matches!(stage.until, Some(Event::Approach(_)))),
            ("control", "control", stage.control == Control::Approach),
        ];
        of_approach.into_iter().try_for_each(|(key, what, found)| {
            require(!found, format!("{what} of a free line contact"), "approach", expected).of(key)
        })
    }

    /// The error names the stage, if there are several.
    fn of_stage(&self, n: usize, checked: Result<()>) -> Result<()> {
        let named = |error| if self.loading.stages.len() > 1 { of_stage(error, n) } else { error };
        checked.map_err(|error| named(error).of(&format!("load.stages[{n}]")))
    }

    /// Rows can reach what a stage waits for.
    fn validate_event(&self, stage: &Stage) -> Result<()> {
        let (key, number, value) = match stage.until {
            None | Some(Event::ContactLost | Event::Approach(_)) => return Ok(()),
            Some(Event::Load(value)) => ("load", "load", value),
            Some(Event::Pressure(value)) => ("pressure", "mean_pressure", value),
            Some(Event::Number(number, value)) => (number.name(), number.name(), value),
        };
        let Some(number) = RowNumber::from_name(number) else { return Ok(()) };
        let heaviest = self.most() * self.grid.cell_area();
        let [_, hardest] = self.hardness_range();
        let [least, most] = number.range(&self.grid, heaviest, hardest, self.traction.is_some());
        let unit = match number.units_on(&self.grid) {
            "1" => String::new(),
            unit => format!(" {unit}"),
        };
        let expected = match (least.is_finite(), most.is_finite()) {
            (true, true) => format!("between {least} and {most}{unit}, the values that it can have"),
            (true, false) => format!("{least}{unit} or more, the values that it can have"),
            _ => format!("{most}{unit} or less, the values that it can have"),
        };
        // Equality within rounding is the limit itself, which can be reached.
        let reaches = value >= least && value <= most * (1.0 + 1e-12);
        require(reaches, format!("{key} of the event"), format!("{value}{unit}"), expected)
            .of(&format!("until.{key}"))
    }

    /// Rows must have what a stage waits for.
    fn validate_awaited(&self, stage: &Stage) -> Result<()> {
        let Some(quantity) = stage.awaited() else { return Ok(()) };
        let rubs = self.motion.as_ref().is_some_and(|motion| motion.shear_stress.is_some())
            || self.flash.as_ref().is_some_and(|flash| flash.friction > 0.0);
        let expected = if quantity.is_of_motion() && self.motion.is_none() {
            "one that the rows have. Only a contact in motion has this one: add [motion] (in Python use slide)"
        } else if quantity == Quantity::FrictionCoefficientTotal && !rubs {
            "one that the rows have. This one needs the friction of the surfaces: give motion.shear_stress or flash.friction"
        } else {
            return self.allows(quantity).map_err(|error| match error {
                Error::Invalid { what, value, expected, .. } => {
                    Error::invalid(what, value, expected).of("until")
                }
                other => other,
            });
        };
        Err(Error::invalid("quantity of the event", quantity, expected).of("until"))
    }

    /// Whether the run computes a quantity: it is asked for, or a stage waits for it.
    pub(crate) fn takes(&self, quantity: Quantity) -> bool {
        self.quantities.has(quantity)
            || self.loading.stages.iter().any(|stage| stage.awaited() == Some(quantity))
    }

    /// Times of a history must be apart.
    fn validate_history(&self, stage: &Stage) -> Result<()> {
        let Course::Given(history) = &stage.course else { return Ok(()) };
        let end = self.times.end();
        let close = |pair: &&[f64]| pair[1] > pair[0] && pair[1] - pair[0] <= SAME * end;
        let times: Vec<f64> = std::iter::once(0.0).chain(history.breaks(end)).collect();
        let Some(pair) = times.windows(2).find(close) else { return Ok(()) };
        let apart = SAME * end;
        let expected = format!("at least {apart:e} s apart, {SAME:e} of the run. Rounding joins closer ones");
        let pair = format!("{} s and {} s", pair[0], pair[1]);
        Err(Error::invalid("times of the history", pair, expected).of("history"))
    }

    /// Steps must follow a sine.
    fn validate_steps<'a>(&self, stage: &Stage, instants: impl Iterator<Item = &'a Instant>) -> Result<()> {
        let Course::Given(History::Sine { amplitude, frequency, .. }) = stage.course else { return Ok(()) };
        let longest = instants.map(|instant| instant.dt).fold(0.0, f64::max);
        let grid = stage.times.as_ref().unwrap_or(&self.times);
        let follows =
            amplitude == 0.0 || grid.is_adaptive() || longest * frequency <= 1.001 / LEAST_PER_PERIOD;
        let lasts = stage.duration.unwrap_or(self.times.end()).min(grid.end());
        let expected = format!(
            "at most {} s, {LEAST_PER_PERIOD} steps to a period. Take {} uniform steps at least, or adaptive ones",
            1.0 / (LEAST_PER_PERIOD * frequency),
            (LEAST_PER_PERIOD * frequency * lasts).ceil(),
        );
        require(follows, "longest time step under a sine", format!("{longest} s"), expected).of("history")
    }

    fn validate_load(&self, stage: &Stage) -> Result<()> {
        let end = self.times.end();
        let (factor, what, unit) = match stage.control {
            Control::Approach => return Ok(()),
            Control::Load => (1.0, "smallest load", "N"),
            Control::Pressure => (self.grid.area(), "smallest mean pressure", "Pa"),
        };
        let lasts = stage.duration.unwrap_or(end).min(end);
        let ([least, most], largest) = match &stage.course {
            Course::Given(history) => (history.range(lasts), history.largest_value()),
            Course::Hold => return Ok(()),
            Course::RampTo { value, .. } => ([*value; 2], "value".to_owned()),
        };
        let presses = least >= 0.0 || least.is_nan() || self.traction.is_some();
        let least = format!("{least} {unit}");
        let low = match &stage.course {
            Course::Given(History::Sine { .. }) => "history.amplitude",
            _ => "history",
        };
        require(
            presses,
            what,
            least,
            "not negative. Bodies only press; prescribe the approach to pull them apart",
        )
        .of(low)?;
        let max = self.most() * self.grid.cell_area();
        // Equality within rounding is the limit itself, which has a solution.
        if most * factor > max * (1.0 + 1e-12) {
            let parameter = format!("history.{largest}");
            return Err(Error::Infeasible { parameter, load: most * factor, max });
        }
        Ok(())
    }

    /// Sum of the cut-off over the cells that can touch \[Pa\]; over all cells as long as there is no gap.
    fn most(&self) -> f64 {
        let gap = self.gap_cells();
        let cells = (0..self.grid.len()).filter(|cell| gap.get(*cell).is_none_or(|h| h.is_finite()));
        match self.hardness_of_cells() {
            Some(hardness) => cells.map(|cell| hardness[cell]).sum(),
            None => self.hardness * cells.count() as f64,
        }
    }

    /// Without instantaneous compliance nothing follows a jump.
    fn validate_jumps(&self, instants: &[Instant]) -> Result<()> {
        if self.instantaneous() > 0.0 {
            return Ok(());
        }
        let (mut last, mut stage) = (0.0, 0);
        for instant in instants {
            // What a stage starts from may be known only as the run goes; the march looks then.
            let checked = require(
                !instant.jump || instant.stage != stage || instant.value == last,
                format!("jump of the history at t = {} s", instant.time),
                format!("{last} to {}", instant.value),
                "a ramp. The bodies have no instantaneous compliance (Kelvin-Voigt), so no contact follows a jump; use a ramp, or a \
                 material with an instantaneous modulus (zener, prony)",
            );
            self.of_stage(instant.stage, checked.of("history"))?;
            (last, stage) = (instant.value, instant.stage);
        }
        Ok(())
    }
}
