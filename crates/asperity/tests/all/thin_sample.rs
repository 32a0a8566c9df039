//! The material of a thin sample: fits of records that the three-dimensional march has computed.

use asperity::Drive;
use std::sync::Arc;

use asperity::indentation::{IndentationOptions, IndentationRecord, SampleLayer, fit_indentation};
use asperity::layer::{BodyLayer, Interface, LayeredBody, response};
use asperity::material::{Body, Lateral, Material, Modulus};
use asperity::reference::MdrProfile;
use asperity::simulation::Simulation;
use asperity::surface::{Part, Shape, undeformed_gap};
use asperity::{Control, Grid, History, Loading, March, SolverOptions, TimeGrid};

/// Times, loads and depths of a sphere of radius 1 that is pressed in, held, and taken away.
fn record(thickness: f64, poisson: f64, interface: Interface) -> [Vec<f64>; 3] {
    // G = 1 at once, 0.4 at last, relaxation time 2: J = 1 + 1.5 (1 - exp(-t/5)).
    let material = Material::zener(Modulus::Shear, 1.0, 1.0 / 1.5, 5.0).unwrap();
    let body = Body { name: "gel".into(), material, lateral: Lateral::Poisson(poisson), hardness: None };
    let layer = BodyLayer { thickness, interface, material: body };
    let response = response(&[LayeredBody { layers: vec![layer], base: None }]).unwrap();
    assert!(response.waves.is_none());
    let grid = Grid::new([61, 61], [0.3, 0.3]).unwrap();
    let part = Part::Shape { shape: Shape::Sphere { radius: 1.0 }, center: [0.0, 0.0] };
    let history = History::Trapezoid { peak: 0.01, rise: 1.0, hold: 8.0, fall: 2.0 };
    let mut march = March::new(Simulation {
        kernel: Arc::new(response.kernel),
        creep: response.creep,
        loading: Loading { control: Control::Approach, history }.into(),
        times: TimeGrid::Uniform { end: 11.0, steps: 110 },
        solver: SolverOptions { tolerance: 1e-7, ..SolverOptions::default() },
        ..Simulation::new(grid, undeformed_gap(&grid, &[part]).unwrap())
    })
    .unwrap();
    let mut rows = [vec![], vec![], vec![]];
    while let Some(step) = march.advance().unwrap() {
        let row = step.row();
        for (column, value) in rows.iter_mut().zip([row.time(), row.load, row.approach]) {
            column.push(value);
        }
    }
    rows
}

#[test]
fn the_modulus_of_a_thin_sample_comes_back() {
    let profile = MdrProfile::Paraboloid { radius: 1.0 };
    for (thickness, poisson, interface) in
        [(0.1, 0.5, Interface::Bonded), (0.03, 0.3, Interface::Bonded), (0.05, 0.5, Interface::Slip)]
    {
        let [times, loads, depths] = record(thickness, poisson, interface);
        let record = IndentationRecord { times: &times, loads: &loads, depths: &depths };
        let layer = Some(SampleLayer { thickness, poisson, interface });
        let options = IndentationOptions { terms: Some(1), layer, ..IndentationOptions::default() };
        let fit = fit_indentation(profile, &record, &options).unwrap();
        // E* = 2 G/(1 - ν).
        let unit = 2.0 / (1.0 - poisson);
        // Unloading is part of the record; the contact is 20 to 30 cells wide.
        let found =
            [fit.instantaneous.value / unit, fit.equilibrium.value / unit / 0.4, fit.terms[0][1].value / 2.0];
        assert!(found.iter().all(|ratio| (ratio - 1.0).abs() < 1e-2), "{thickness} {poisson}: {found:?}");
        assert!(fit.relative_rms < 5e-3, "{thickness}: {}", fit.relative_rms);
        // The half-space is far off.
        let options = IndentationOptions { limit: 1.0, layer: None, ..options };
        let wrong = fit_indentation(profile, &record, &options).unwrap();
        assert!(wrong.instantaneous.value / unit > 1.1, "{}", wrong.instantaneous.value / unit);
    }
}

#[test]
fn stated_uncertainties_of_radius_and_thickness_widen_the_intervals() {
    let [times, loads, depths] = record(0.05, 0.5, Interface::Bonded);
    let record = IndentationRecord { times: &times, loads: &loads, depths: &depths };
    let fit = |radius: f64, thickness: f64, [radius_uncertainty, thickness_uncertainty]: [f64; 2]| {
        let layer = Some(SampleLayer { thickness, poisson: 0.5, interface: Interface::Bonded });
        let options = IndentationOptions {
            terms: Some(1),
            layer,
            radius_uncertainty,
            thickness_uncertainty,
            ..IndentationOptions::default()
        };
        fit_indentation(MdrProfile::Paraboloid { radius }, &record, &options).unwrap().instantaneous
    };
    let plain = fit(1.0, 0.05, [0.0; 2]);
    let variance = |x: asperity::indentation::Interval| ((x.high / x.value).ln() / 1.959_964).powi(2);
    for (lengths, stated) in [([1.02, 0.05], [0.02, 0.0]), ([1.0, 0.05 * 1.02], [0.0, 0.02])] {
        let moved = fit(lengths[0], lengths[1], [0.0; 2]).value;
        let by = (moved / plain.value).ln().abs();
        let told = (variance(fit(1.0, 0.05, stated)) - variance(plain)).sqrt();
        // The effect is that at the largest depth; shallow rows have a little less of it, and 2 % are not nothing.
        assert!((told / by - 1.0).abs() < 0.15, "{told} {by}");
    }
    let options = IndentationOptions { thickness_uncertainty: 0.1, ..IndentationOptions::default() };
    assert!(fit_indentation(MdrProfile::Paraboloid { radius: 1.0 }, &record, &options).is_err());
}
