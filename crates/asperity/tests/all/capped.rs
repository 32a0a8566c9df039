//! Contacts that yield, up to nearly all of the domain: both methods solve them, and find the same pressure.

use asperity::operator::half_space;
use asperity::reference::Dense;
use asperity::surface::{Roughness, SelfAffine};
use asperity::{
    Boundary, ContactState, Grid, Method, Outcome, Prescribed, Problem, Result, Solver, SolverOptions,
};

use crate::conditions::{apart, violation};

/// Gap over a unit domain.
fn gap(grid: &Grid, surface: usize) -> Vec<f64> {
    let ny = grid.cells()[1];
    let rough = SelfAffine {
        hurst: 0.7,
        roughness: Roughness::RmsGradient(0.2),
        longest: 0.5,
        shortest: 0.1,
        roll_off: 0.5,
        seed: 3,
    };
    let heights = rough.heights(grid).unwrap();
    let cell = |n: usize| {
        let [x, y] = [grid.x(n / ny) - 0.5, grid.y(n % ny) - 0.5];
        let sphere = 0.5 * (x * x + y * y);
        let height = heights[(n / ny, n % ny)];
        [sphere, sphere + 0.3 * height, height][surface]
    };
    (0..grid.len()).map(cell).collect()
}

struct Contact {
    grid: Grid,
    boundary: Boundary,
    gap: Vec<f64>,
    hardness: f64,
    prescribed: Prescribed,
    name: String,
}

impl Contact {
    fn problem(&self) -> Problem<'_> {
        let (gap, hardness) = (&self.gap[..], self.hardness.into());
        Problem { gap, compliance: 1.0, hardness, prescribed: self.prescribed }
    }

    fn solve(&self, method: Method, tolerance: f64) -> Result<(ContactState, Outcome)> {
        let mut operator = half_space(self.grid, self.boundary);
        let mut state = ContactState::new(self.grid.len());
        let options = SolverOptions { method, tolerance, ..SolverOptions::default() };
        let outcome = Solver::new(method, &*operator).solve(
            &mut *operator,
            &self.problem(),
            &options,
            &mut state,
            None,
        )?;
        Ok((state, outcome))
    }
}

/// Sphere, rough sphere and self-affine surface; free and periodic; load, and the approach that it gives; all `hardnesses`
/// (from one that nearly everything exceeds to one that little does) and `shares` of the largest load H times area.
fn contacts(cells: [usize; 2], hardnesses: &[f64], shares: &[f64]) -> Vec<Contact> {
    let grid = Grid::new(cells, [1.0, 1.0]).unwrap();
    let mut contacts = vec![];
    for surface in 0..3 {
        for boundary in [Boundary::Free, Boundary::Periodic] {
            for &hardness in hardnesses {
                for &share in shares {
                    let of = |prescribed| Contact {
                        grid,
                        boundary,
                        gap: gap(&grid, surface),
                        hardness,
                        prescribed,
                        name: format!(
                            "surface {surface}, {boundary:?}, H = {hardness}, {share} of the load, {prescribed:?}"
                        ),
                    };
                    let loaded = of(Prescribed::Load(share * hardness));
                    let (state, _) = loaded.solve(Method::ProjectedCg, 1e-10).unwrap();
                    contacts.push(loaded);
                    contacts.push(of(Prescribed::Approach(state.approach)));
                }
            }
        }
    }
    contacts
}

#[test]
fn contacts_that_yield_are_solved_by_both_methods() {
    let contacts = contacts([20, 24], &[0.03, 0.3], &[0.5, 0.95, 0.999]);
    assert_eq!(contacts.len(), 72);
    for contact in contacts {
        let mut dense = Dense::new(contact.grid, contact.boundary);
        for method in [Method::ProjectedCg, Method::PolonskyKeer] {
            let (state, outcome) =
                contact.solve(method, 1e-8).unwrap_or_else(|e| panic!("{method:?}, {}: {e}", contact.name));
            violation(&mut dense, &contact.problem(), 1e-8, &state, &outcome)
                .unwrap_or_else(|e| panic!("{method:?}, {}: {e}", contact.name));
        }
    }
}

/// 360 contacts; Polonsky and Keer without gradient steps fails in 68 of them.
#[test]
#[ignore = "slow: half a minute"]
fn every_contact_of_a_study_is_solved_by_polonsky_keer() {
    let contacts = contacts([64, 64], &[0.01, 0.03, 0.1, 0.3, 1.0], &[0.2, 0.5, 0.8, 0.95, 0.99, 0.999]);
    assert_eq!(contacts.len(), 360);
    let (mut failed, mut counts) = (vec![], vec![]);
    for contact in &contacts {
        let (exact, other) = contact.solve(Method::ProjectedCg, 1e-6).unwrap();
        match contact.solve(Method::PolonskyKeer, 1e-6) {
            Ok((state, outcome)) => {
                counts.push(outcome.convolutions);
                // Each is within its certificate of the solution. An even pressure on a periodic domain displaces nothing, so
                // that rounding of p, 1e-16 of it, can be 1e-12 of its energy norm.
                let off =
                    apart(&mut *half_space(contact.grid, contact.boundary), &exact.pressure, &state.pressure);
                let most = outcome.certificate + other.certificate + 1e-11;
                assert!(off <= most, "{}: {off} {most}", contact.name);
            }
            Err(e) => failed.push(format!("{}: {e}", contact.name)),
        }
    }
    counts.sort_unstable();
    println!("convolutions: median {:?}, largest {:?}", counts.get(counts.len() / 2), counts.last());
    assert!(failed.is_empty(), "{} fail: {failed:#?}", failed.len());
}
