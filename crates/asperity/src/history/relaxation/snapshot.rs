//! What a history of branches is resumed from.

use super::{Relaxation, UnderWay};
use crate::error::Result;
use crate::material::Dual;
use crate::step::{Loader, Saver};

impl UnderWay {
    pub(crate) fn save(self, to: &mut Saver<'_>) {
        let number = match self {
            UnderWay::Nothing => 0.0,
            UnderWay::Contact => 1.0,
            UnderWay::Apart => 2.0,
        };
        to.number("under_way", number);
    }

    pub(crate) fn load(from: &mut Loader<'_>) -> Result<Self> {
        Ok(match from.number("under_way")? {
            0.0 => UnderWay::Nothing,
            1.0 => UnderWay::Contact,
            _ => UnderWay::Apart,
        })
    }
}

impl Relaxation {
    pub(super) fn save_to<'a>(&'a self, to: &mut Saver<'a>) {
        self.under_way.save(to);
        to.number("since_kink", self.since_kink);
        to.numbers("load", vec![self.end.load, self.end.driver]);
        to.numbers("load_states", self.end.states.clone());
        to.numbers("rates", self.rates.clone());
        to.numbers("gone", self.gone.clone());
        to.numbers("elapsed", self.elapsed.clone());
        to.numbers("rules", self.rules.save());
        if let Some(products) = &self.products {
            to.numbers("energy_products", products.save());
        }
        for (k, states) in self.states.save().into_iter().enumerate() {
            to.owned_field(&format!("state_{k}"), states);
        }
        if !self.is_elastic() {
            to.field("displacement", &self.displacement);
        }
    }

    pub(super) fn load_from(&mut self, from: &mut Loader<'_>) -> Result<()> {
        self.under_way = UnderWay::load(from)?;
        self.since_kink = from.number("since_kink")?;
        let [load, driver] = from.array("load")?;
        (self.end.load, self.end.driver) = (load, driver);
        from.numbers_into("load_states", &mut self.end.states)?;
        from.numbers_into("rates", &mut self.rates)?;
        from.numbers_into("gone", &mut self.gone)?;
        from.numbers_into("elapsed", &mut self.elapsed)?;
        self.dual = Dual::of(self.pair.creep(&self.rates))?;
        from.check("rules", |numbers| self.rules.load(numbers))?;
        if let Some(products) = &mut self.products {
            let (rates, dual) = (&self.rates, &self.dual);
            from.check("energy_products", |numbers| products.restore(rates, dual, numbers))?;
        }
        let states = (0..self.dual.states()).map(|k| from.field(&format!("state_{k}")));
        let states = states.collect::<Result<Vec<_>>>()?;
        if !self.states.load(&states) {
            return Err(from.foreign("states of another material"));
        }
        if !self.is_elastic() {
            from.field_into("displacement", &mut self.displacement)?;
        }
        Ok(())
    }
}
