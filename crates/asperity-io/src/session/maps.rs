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

    /// All fields of the case. Those of a contact that has moved are in its frame: beyond the ends of a free track nothing is known but
    /// that there is no pressure.
    pub(super) fn of<'b>(&'b mut self, step: &Step<'b>) -> Vec<Field<'b>> {
        let output = &self.case.output;
        let keeps = |field| output.fields.contains(&field);
        let (shift, boundary) = (step.frame_shift(), step.simulation().boundary);
        let has_moved = shift != [0; 2];
        let follow = |field: &mut Array2<f64>| {
            if has_moved {
                *field = in_contact_frame(field.view(), boundary, shift, f64::NAN);
            }
        };
        if keeps(FieldKind::Pressure) && has_moved {
            self.pressure = in_contact_frame(step.pressure(), boundary, shift, 0.0);
        }
        if keeps(FieldKind::Gap) {
            step.gap_into(&mut self.gap);
            follow(&mut self.gap);
        }
        if keeps(FieldKind::Displacement) {
            step.displacement_into(&mut self.displacement);
            follow(&mut self.displacement);
        }
        if keeps(FieldKind::Contact) {
            step.contact_into(&mut self.contact);
            if has_moved {
                self.contact = in_contact_frame(self.contact.view(), boundary, shift, 0);
            }
        }
        if keeps(FieldKind::Flattening) {
            step.flattening_into(&mut self.flattening);
        }
        let pressure = if has_moved { self.pressure.view() } else { step.pressure() };
        let all = [
            Field::Real(FieldKind::Pressure, pressure),
            Field::Real(FieldKind::Gap, self.gap.view()),
            Field::Real(FieldKind::Displacement, self.displacement.view()),
            Field::Contact(self.contact.view()),
            Field::Real(FieldKind::Flattening, self.flattening.view()),
        ];
        all.into_iter().filter(|field| keeps(field.kind())).collect()
    }
}
