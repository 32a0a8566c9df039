//! The fields of a row that are stored.

use asperity::step::Step;

use asperity::process::in_contact_frame;
use ndarray::Array2;

use crate::case::Case;
use crate::store::{Field, FieldKind};

/// The fields of the rows that keep them, in memory of their own.
pub(super) struct Maps<'a> {
    case: &'a Case,
    pressure: Array2<f64>,
    gap: Array2<f64>,
    displacement: Array2<f64>,
    flattening: Array2<f64>,
    contact: Array2<u8>,
}

impl<'a> Maps<'a> {
    pub(super) fn new(case: &'a Case, shape: (usize, usize)) -> Self {
        let keeps = |field| case.output.fields.contains(&field);
        let map = |kept: bool| Array2::zeros(if kept { shape } else { (0, 0) });
        Maps {
            case,
            pressure: map(false),
            gap: map(keeps(FieldKind::Gap)),
            displacement: map(keeps(FieldKind::Displacement)),
            flattening: map(keeps(FieldKind::Flattening)),
            contact: Array2::zeros(if keeps(FieldKind::Contact) { shape } else { (0, 0) }),
        }
    }

    /// All fields of the case.
    pub(super) fn of<'b>(&'b mut self, step: &Step<'b>) -> Vec<Field<'b>> {
        let output = &self.case.output;
        let keeps = |field| output.fields.contains(&field);
        let mut fields = vec![];
        if step.frame_shift() != [0; 2] {
            return self.in_contact_frame(step);
        }
        if keeps(FieldKind::Pressure) {
            fields.push(Field::Pressure(step.pressure()));
        }
        if keeps(FieldKind::Gap) {
            step.gap_into(&mut self.gap);
            fields.push(Field::Gap(self.gap.view()));
        }
        if keeps(FieldKind::Displacement) {
            step.displacement_into(&mut self.displacement);
            fields.push(Field::Displacement(self.displacement.view()));
        }
        if keeps(FieldKind::Contact) {
            step.contact_into(&mut self.contact);
            fields.push(Field::Contact(self.contact.view()));
        }
        if keeps(FieldKind::Flattening) {
            step.flattening_into(&mut self.flattening);
            fields.push(Field::Flattening(self.flattening.view()));
        }
        fields
    }

    /// The fields of a contact that has moved, in its frame. Beyond the ends of a free track nothing is known but that there is no
    /// pressure.
    fn in_contact_frame<'b>(&'b mut self, step: &Step<'b>) -> Vec<Field<'b>> {
        let (shift, boundary) = (step.frame_shift(), step.simulation().boundary);
        let keeps = |field| self.case.output.fields.contains(&field);
        let moved = |field: &Array2<f64>, beyond| in_contact_frame(field.view(), boundary, shift, beyond);
        let (pressure, gap) = (keeps(FieldKind::Pressure), keeps(FieldKind::Gap));
        let (displacement, contact) = (keeps(FieldKind::Displacement), keeps(FieldKind::Contact));
        if pressure {
            self.pressure = in_contact_frame(step.pressure(), boundary, shift, 0.0);
        }
        if gap {
            step.gap_into(&mut self.gap);
            self.gap = moved(&self.gap, f64::NAN);
        }
        if displacement {
            step.displacement_into(&mut self.displacement);
            self.displacement = moved(&self.displacement, f64::NAN);
        }
        if contact {
            step.contact_into(&mut self.contact);
            self.contact = in_contact_frame(self.contact.view(), boundary, shift, 0);
        }
        let all = [
            (pressure, Field::Pressure(self.pressure.view())),
            (gap, Field::Gap(self.gap.view())),
            (displacement, Field::Displacement(self.displacement.view())),
            (contact, Field::Contact(self.contact.view())),
        ];
        all.into_iter().filter_map(|(kept, field)| kept.then_some(field)).collect()
    }
}
