//! The fields of a row that are stored.

use asperity::process::in_contact_frame;
use asperity::step::Step;
use ndarray::Array2;

use crate::case::Case;
use crate::store::{Field, FieldKind};

/// The fields of the rows that keep them, in memory of their own; a contact that has not moved lends its pressure.
pub(super) struct Maps {
    real: Vec<(FieldKind, Array2<f64>)>,
    contact: Option<Array2<u8>>,
}

impl Maps {
    pub(super) fn new(case: &Case, shape: (usize, usize)) -> Self {
        let fields = case.output.fields.iter().copied();
        let shape_of = |kind| if kind == FieldKind::Pressure { (0, 0) } else { shape };
        Maps {
            contact: case.output.fields.contains(&FieldKind::Contact).then(|| Array2::zeros(shape)),
            real: fields
                .filter(|kind| *kind != FieldKind::Contact)
                .map(|kind| (kind, Array2::zeros(shape_of(kind))))
                .collect(),
        }
    }

    /// All fields of the case, each in its frame.
    pub(super) fn of<'b>(&'b mut self, step: &Step<'b>) -> Vec<Field<'b>> {
        let boundary = step.simulation().boundary;
        let has_moved = step.frame_shift() != [0; 2];
        for (kind, field) in &mut self.real {
            // The pressure is that of the step, where nothing has moved.
            if *kind != FieldKind::Pressure {
                kind.of_step(step, field);
            }
            let shift = kind.shift(step);
            if shift != [0; 2] {
                let still = if *kind == FieldKind::Pressure { step.pressure() } else { field.view() };
                *field = in_contact_frame(still, boundary, shift, kind.beyond());
            }
        }
        if let Some(contact) = &mut self.contact {
            step.contact_into(contact);
            if has_moved {
                *contact = in_contact_frame(contact.view(), boundary, step.frame_shift(), 0);
            }
        }
        let lent = |kind: FieldKind| kind == FieldKind::Pressure && !has_moved;
        let real = self.real.iter().map(|(kind, field)| (*kind, field.view()));
        let real = real.map(|(kind, own)| Field::Real(kind, if lent(kind) { step.pressure() } else { own }));
        real.chain(self.contact.iter().map(|contact| Field::Contact(contact.view()))).collect()
    }
}
