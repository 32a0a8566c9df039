//! What a memory can be restored from.

use super::{Memory, UnderWay};
use crate::material::Dual;

impl Memory {
    /// Numbers and fields.
    pub(in crate::march) fn save(&self) -> (Vec<f64>, Vec<Vec<f64>>) {
        let under_way = match self.under_way {
            UnderWay::Nothing => 0.0,
            UnderWay::Contact => 1.0,
            UnderWay::Apart => 2.0,
        };
        let piece = self.piece.unwrap_or(f64::INFINITY);
        let mut numbers = vec![under_way, piece, self.end.load, self.end.driver];
        numbers.extend(&self.end.states);
        for clocks in [&self.rates, &self.gone, &self.elapsed] {
            numbers.extend(clocks);
        }
        numbers.extend(self.rules.save());
        let mut fields = self.states.save();
        fields.push(self.displacement.clone());
        fields.retain(|field| !field.is_empty());
        (numbers, fields)
    }

    /// Takes back what [`Memory::save`] gave; false where it does not fit.
    pub(in crate::march) fn restore(&mut self, numbers: &[f64], fields: &[Vec<f64>]) -> bool {
        let (states, clocks) = (self.dual.states(), self.rates.len());
        if numbers.len() != 4 + states + 3 * clocks + self.rules.saved() {
            return false;
        }
        let (place, rest) = numbers.split_at(4);
        let (total, rest) = rest.split_at(states);
        let (rates, rest) = rest.split_at(clocks);
        let (gone, rest) = rest.split_at(clocks);
        let (elapsed, rules) = rest.split_at(clocks);
        self.under_way = match place[0] {
            0.0 => UnderWay::Nothing,
            1.0 => UnderWay::Contact,
            _ => UnderWay::Apart,
        };
        self.piece = Some(place[1]).filter(|lasted| lasted.is_finite());
        (self.end.load, self.end.driver) = (place[2], place[3]);
        self.end.states.copy_from_slice(total);
        self.gone.copy_from_slice(gone);
        self.elapsed.copy_from_slice(elapsed);
        self.rates.copy_from_slice(rates);
        match Dual::of(self.clocks.creep(&self.rates)) {
            Ok(dual) => self.dual = dual,
            Err(_) => return false,
        }
        let branches = match fields.split_last() {
            Some((displacement, branches)) if !self.is_elastic() => {
                if displacement.len() != self.displacement.len() {
                    return false;
                }
                self.displacement.copy_from_slice(displacement);
                branches
            }
            _ => fields,
        };
        self.states.load(branches) && self.rules.load(rules)
    }
}
