//! `asperity material show CASE --layers`: how bodies of layers answer waves of pressure.

use asperity_io::case::{Case, WaveReport};
use asperity_report::material as pictures;
use serde_json::json;

use crate::args::Show;
use crate::failure::{Failure, refuse};
use crate::format::quantity;

/// Shortest wave over the thinnest layer, and longest wave over all layers together.
const RANGE: [f64; 2] = [0.2, 200.0];

/// Prints, and draws, q C(q) over the length of the wave.
pub fn show(args: &Show) -> Result<(), Failure> {
    let case = Case::read(&args.file, &args.set)?;
    let Some(layers) = &case.layers else {
        let path = args.file.display();
        refuse!("{path} has no [[body.layer]]: --layers is for bodies of layers");
    };
    let all = || layers.stacks().iter().flat_map(|stack| stack.layers()).map(|layer| layer.thickness);
    let [first, last] =
        [RANGE[0] * all().fold(f64::INFINITY, f64::min), RANGE[1] * all().fold(0.0, |sum, d| sum + d)];
    let per_decade = f64::from(args.per_decade.max(2));
    let steps = ((last / first).log10() * per_decade).ceil() as usize;
    let waves: Vec<WaveReport> =
        (0..=steps).filter_map(|k| case.wave(first * 10f64.powf(k as f64 / per_decade))).collect();
    if let Some(path) = &args.plot {
        let title = case.title.as_deref().unwrap_or(&case.name);
        let fine: Vec<WaveReport> =
            (0..=200).filter_map(|k| case.wave(first * (last / first).powf(f64::from(k) / 200.0))).collect();
        crate::commands::picture::write(&pictures::layers(title, &fine), path, args.force)?;
    }
    if args.json {
        return crate::print(&format!("{}\n", json!(waves)));
    }
    let mut text = String::new();
    text += "A wave of pressure of wave number q displaces the surface by C(q) times its amplitude;\n";
    text += "2/(q C) is the contact modulus of the equivalent half-space\n\n";
    let at_once = waves.iter().any(|wave| wave.instantaneous_modulus != Some(wave.relaxed_modulus));
    let of_modulus = |length: f64, modulus: f64| {
        let q = std::f64::consts::TAU / length;
        format!("{:>14.5e}{:>14.5e}{:>14}", 2.0 / (q * modulus), 2.0 / modulus, quantity(modulus, "Pa"))
    };
    let columns = format!("{:>14}{:>14}{:>14}", "C [m/Pa]", "q C [1/Pa]", "2/(q C)");
    if at_once {
        text += &format!("{:>12}{:>14}{:^42}{:^42}\n", "", "", "instantaneous", "relaxed");
    }
    let more = if at_once { columns.as_str() } else { "" };
    text += &format!("{:>12}{:>14}{columns}{more}\n", "wave length", "q [1/m]");
    for wave in &waves {
        text += &format!("{:>12}{:>14.5e}", quantity(wave.length, "m"), std::f64::consts::TAU / wave.length);
        if at_once {
            let instantaneous = wave.instantaneous_modulus.map(|modulus| of_modulus(wave.length, modulus));
            text += &format!("{:>42}", instantaneous.unwrap_or_else(|| "rigid".into()));
        }
        text += &format!("{}\n", of_modulus(wave.length, wave.relaxed_modulus));
    }
    crate::print(&text)
}
