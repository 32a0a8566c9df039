//! Figures 5 to 8: the rough sphere on PMMA.

use asperity::drive::Elastic;
use asperity::material::Creep;
use asperity::surface::statistics::rms_gradient;
use asperity::{Control, Drive, Method, Simulation, SolverOptions};
use asperity_examples::paper::FIGURES_5_TO_8 as CASE;
use asperity_io::case::Case;
use asperity_io::readable::quantity;
use asperity_io::store::{At, FieldKind, Reader};

use super::{Difference, Options, Reproduction, Result};
use crate::figure::{Axis, Curves, Figure, Series, Style};
use crate::result::{Options as Show, Plot, figure};

/// Radius of the sphere in the case \[m\].
const RADIUS: f64 = 0.5e-3;
/// Side of the domain and shortest wavelength in the case \[m\].
const SIZE: f64 = 1e-4;
const SHORTEST: f64 = 0.8e-6;

/// All four; without the runs only figure 5, which needs none but the geometry.
pub(super) fn figures(options: &Options, run: bool) -> Result<Vec<Reproduction>> {
    // A coarse grid cannot hold the shortest waves.
    let coarse = options.cells.filter(|cells| (*cells as f64) < 2.0 * SIZE / SHORTEST);
    let waves = coarse.map(|cells| format!("surface.1.shortest=\"{} m\"", 2.5 * SIZE / cells as f64));
    let keys = |more: &[&str]| -> Vec<String> {
        more.iter().map(|key| (*key).to_owned()).chain(waves.clone()).collect()
    };
    // The geometry alone is the same run of one step.
    let short: &[&str] = if run { &[] } else { &["time.steps=1", "output.every=1"] };
    let (case, reader) = options.run("fig5-8-rough", CASE, &keys(short))?;
    let mut done = vec![geometry(&case, &reader)?];
    if !run {
        return Ok(done);
    }
    // SC17's way: piecewise-constant pressure, whose recursion is its hereditary sum, and its solver.
    let theirs = keys(&["time.scheme=\"constant\"", "solver.method=\"polonsky-keer\""]);
    let (_, theirs) = options.run("fig5-8-rough-sc17", CASE, &theirs)?;
    done.push(contact(&reader, &theirs, 6, At::Index(0))?);
    done.push(contact(&reader, &theirs, 7, At::Last)?);
    done.push(evolution(&case, &reader, &theirs)?);
    Ok(done)
}

/// Figure 5.
fn geometry(case: &Case, reader: &Reader) -> Result<Reproduction> {
    let drawn = figure(reader, Plot::InitialGap, &Show::default())?;
    let gap = reader.initial_gap()?;
    // What is left of the gap without the sphere is the roughness, upside down.
    let grid = &case.conditions.grid;
    let [lx, ly] = grid.size();
    let sphere = |(i, j): (usize, usize)| (grid.x(i) - 0.5 * lx).powi(2) + (grid.y(j) - 0.5 * ly).powi(2);
    let rough = ndarray::Array2::from_shape_fn(gap.dim(), |at| gap[at] - sphere(at) / (2.0 * RADIUS));
    let slope = rms_gradient(grid, rough.view())?;
    let differences = vec![Difference::new(
        "Difference of the roughness's rms gradient from the 0.05 asked for",
        (slope / 0.05 - 1.0).abs(),
        "it",
    )];
    let more = "Sphere of 0.5 mm and self-affine roughness. The paper's topography is not published.";
    Ok(Reproduction::new(5, "undeformed gap", drawn, differences, more))
}

/// Figures 6 and 7.
fn contact(ours: &Reader, theirs: &Reader, number: u8, at: At) -> Result<Reproduction> {
    let drawn = figure(ours, Plot::Map(FieldKind::Contact), &Show { at, ..Show::default() })?;
    let [a, b] = [ours.field(FieldKind::Contact, at)?, theirs.field(FieldKind::Contact, at)?];
    let cells = a.iter().filter(|state| **state > 0.0).count().max(1) as f64;
    let apart = a.iter().zip(&b).filter(|(a, b)| (**a > 0.0) != (**b > 0.0)).count() as f64;
    let caption = drawn.caption.clone();
    let differences = vec![Difference::new(
        "Cells that touch here or with SC17's method, but not in both",
        apart / cells,
        "the contact",
    )];
    let when = if number == 6 { "contact at once" } else { "contact after 500 s" };
    Ok(Reproduction::new(number, when, drawn, differences, &caption))
}

/// Figure 8.
fn evolution(case: &Case, ours: &Reader, theirs: &Reader) -> Result<Reproduction> {
    let time = ours.series("time")?;
    let ends = [case.conditions.creep.value(0.0), case.conditions.creep.long_time()];
    let [fresh, relaxed] = [elastic(case, ours, ends[0])?, elastic(case, ours, ends[1])?];
    let mut figure = Figure::new("");
    let mut differences = Vec::new();
    let quantities = [("contact area", "contact_area", "m2", 0), ("approach", "approach", "m", 1)];
    for (label, name, unit, column) in quantities {
        let [a, b] = [ours.series(name)?, theirs.series(name)?];
        let apart = a.iter().zip(&b).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
        let every = (0..time.len()).step_by(5).map(|n| [time[n], b[n]]);
        // Two level lines; what lies between is left out.
        let [low, high] = [fresh[column], relaxed[column]];
        let ends = [0.0, 500.0, f64::NAN, 0.0, 500.0];
        let panel = Curves::new("", Axis::linear("time", "s"), Axis::linear(label, unit))
            .with(Series::new("computed", Style::Line, &time, &a))
            .with(Series::through("SC17's method", Style::Points, every))
            .with(Series::new(
                "elastic, C(0) and C(∞)",
                Style::Dashed,
                ends,
                [low, low, f64::NAN, high, high],
            ));
        figure = figure.with(panel);
        differences.push(Difference::new(
            format!("Largest difference of the {label} from SC17's method"),
            apart,
            "it",
        ));
        let first = (a.first().copied().unwrap_or(f64::NAN) / fresh[column] - 1.0).abs();
        differences.push(Difference::new(
            format!("Difference of the first {label} from the elastic solution"),
            first,
            "it",
        ));
    }
    let sizes = ours.series("contact_fraction")?;
    let more = format!(
        "From {:.2} % to {:.2} % of the nominal area; SC17's method is of first order in time. Load {}, limit 300 MPa.",
        100.0 * sizes.first().copied().unwrap_or(f64::NAN),
        100.0 * sizes.last().copied().unwrap_or(f64::NAN),
        quantity(0.5, "N")
    );
    Ok(Reproduction::new(8, "contact area and approach over time", figure, differences, &more))
}

/// Contact area and approach of an elastic body of that compliance under the same load and limit, by Polonsky and
/// Keer's method.
fn elastic(case: &Case, reader: &Reader, compliance: f64) -> Result<[f64; 2]> {
    let simulation = Simulation {
        boundary: case.conditions.boundary,
        creep: Creep::elastic(compliance),
        hardness: case.conditions.hardness,
        solver: SolverOptions { method: Method::PolonskyKeer, ..case.conditions.solver },
        ..Simulation::new(case.conditions.grid, reader.initial_gap()?)
    };
    let mut contact = Elastic::new(simulation, [(Control::Load, 0.5)])?;
    let row = contact.advance()?.map(|step| step.row()).unwrap_or_default();
    Ok([row.contact_area, row.approach])
}
