//! Materials: moduli that suggest a wrong unit, and the quality and coverage of fits of measured data.

use super::plausible::{MODULI, SOFTEST_DATA, TEMPERATURES, TRANSITION, exceeded};
use super::words::{digits, si};
use super::{
    AT_REFERENCE_TEMPERATURE, BEYOND_MATERIAL_DATA, DATA_SCATTER, Finding, MATERIAL_MISFIT, MODULUS_KIND,
    POINTS_LEFT_OUT, SHIFT_UNCERTAIN, TOO_FEW_POINTS, UNLIKELY_UNIT,
};
use crate::error::significant;
use crate::material::{Misfit, Modulus, Reversal};
use crate::simulation::Simulation;

/// Largest rms misfit of a fit, its largest ratio to the scatter of the data, and the misfit that is told whatever the scatter is.
const MISFIT: f64 = 0.05;
const SCATTER: f64 = 2.0;
const LARGE: f64 = 0.1;
/// Largest standard deviation of an estimated shift factor: a factor of two in time \[decades\].
const FACTOR: f64 = 0.3;

/// A modulus \[Pa\] that no body has; `name` is the name of the modulus.
pub fn unlikely_modulus(name: &str, modulus: f64) -> Option<Finding> {
    let limit = exceeded(MODULI, modulus).filter(|_| modulus.is_finite() && modulus > 0.0)?;
    let [least, most] = MODULI.map(|modulus| si(modulus, "Pa"));
    let text = format!(
        "The {name} is {}; solids have {least} to {most}. Check its unit (Pa, kPa, MPa, GPa; m is milli, M is mega).",
        si(modulus, "Pa")
    );
    Some(Finding::warning(UNLIKELY_UNIT, modulus, limit, text))
}

/// Measured moduli from the least to the largest \[Pa\] that are those of a polymer in another unit; `unnamed` if the file names no unit.
pub fn unlikely_data(name: &str, [least, most]: [f64; 2], unnamed: bool) -> Option<Finding> {
    let unlikely = most < SOFTEST_DATA && (unnamed || most > TRANSITION * least);
    unlikely.then(|| {
        let text = format!(
            "The largest modulus in the data of {name} is {}{}. Check its unit (Pa, kPa, MPa, GPa): curves of polymers reach MPa to \
             GPa.",
            si(most, "Pa"),
            if unnamed { ", because the file names no unit and its numbers are taken in Pa" } else { "" }
        );
        Finding::warning(UNLIKELY_UNIT, most, SOFTEST_DATA, text)
    })
}

/// What a temperature \[K\] may be that is too low for a polymer: degrees Celsius without their unit.
pub fn celsius_meant(kelvin: f64) -> Option<String> {
    let number = significant(kelvin, 6);
    (kelvin < TEMPERATURES[0])
        .then(|| format!("a bare number is in kelvin: write \"{number} °C\" if degrees Celsius are meant"))
}

/// A temperature \[K\] at which no polymer is used; `name` is the body.
pub fn unlikely_temperature(name: &str, kelvin: f64) -> Option<Finding> {
    let limit = exceeded(TEMPERATURES, kelvin).filter(|_| kelvin.is_finite())?;
    let [least, most] = TEMPERATURES;
    let help = celsius_meant(kelvin).map_or(String::new(), |help| format!(" ({help})"));
    let text = format!(
        "The material of {name} has a temperature of {} K, which is {} °C; polymers are used from {least} K to {most} K. Check its \
         unit{help}.",
        digits(kelvin),
        digits(kelvin - 273.15)
    );
    Some(Finding::warning(UNLIKELY_UNIT, kelvin, limit, text))
}

/// The material of `name` has a shift with this reference temperature \[K\], and the run has no temperature.
pub fn at_reference(name: &str, reference: f64) -> Finding {
    let text = format!(
        "The material of {name} depends on temperature, and the case gives none: the run is at its reference temperature, {} °C. \
         Give another one as [temperature] history = {{ kind = \"constant\", value = \"... °C\" }}, or `temperature` of the material.",
        digits(reference - 273.15)
    );
    Finding::warning(AT_REFERENCE_TEMPERATURE, reference, f64::NAN, text).as_note()
}

/// The moduli of the pair.
pub(super) fn of_pair(simulation: &Simulation) -> Option<Finding> {
    let instantaneous = simulation.instantaneous();
    let long = std::iter::once(&simulation.creep).chain(simulation.thermal.iter().map(|body| &body.creep));
    let compliance =
        if instantaneous > 0.0 { instantaneous } else { long.map(|creep| creep.long_time()).sum() };
    unlikely_modulus("contact modulus E*", 1.0 / compliance)
}

/// A fit with this rms and largest relative misfit to data of this relative scatter; `name` states what was fitted.
pub fn misfit(name: &str, rms: f64, largest: f64, scatter: f64) -> Option<Finding> {
    let limit = (SCATTER * scatter).clamp(MISFIT, LARGE);
    (rms.is_nan() || rms > limit).then(|| {
        let text = format!(
            "The material of {name} deviates from its data by {} % rms and {} % at most: contact area and approach have errors \
             of that order. Fit a narrower window, use more terms, or look at the data (asperity material fit --plot).",
            digits(100.0 * rms),
            digits(100.0 * largest)
        );
        Finding::warning(MATERIAL_MISFIT, rms, limit, text)
    })
}

/// A fit of storage and loss modulus together, with the misfit of each, to data of this relative scatter. `together` is the rms over
/// both.
pub fn misfit_of_both(
    name: &str,
    together: f64,
    [storage, loss]: [Misfit; 2],
    scatter: f64,
) -> Option<Finding> {
    let limit = (SCATTER * scatter).clamp(MISFIT, LARGE);
    (together.is_nan() || together > limit).then(|| {
        let words = |misfit: Misfit| {
            let place = digits(misfit.worst);
            format!("{} % rms and {} % at most (at {place} rad/s)", digits(100.0 * misfit.rms), digits(100.0 * misfit.max))
        };
        let text = format!(
            "The material of {name} lies between its storage and loss modulus: it deviates from the storage modulus by {} and from the \
             loss modulus by {}. No linear viscoelastic material has both (Kramers-Kronig), or the points scatter; contact area, approach \
             and friction have errors of that order. If the storage modulus is the one to rely on, fit it alone (moduli = \"storage\", \
             --fit storage)",
            words(storage),
            words(loss)
        );
        Finding::warning(MATERIAL_MISFIT, together, limit, text)
    })
}

/// A fit of one modulus of a DMA whose relative rms deviation from the other modulus, `column`, is this value.
pub fn contradiction(name: &str, column: &str, rms: f64) -> Option<Finding> {
    (rms.is_nan() || rms > MISFIT).then(|| {
        let text = format!(
            "The material of {name} is fitted to one of the measured moduli, and its {column} modulus deviates from the data by \
             {} % rms: the two measured moduli contradict each other (Kramers-Kronig). Results that depend on the {column} \
             modulus are uncertain by that much.",
            digits(100.0 * rms)
        );
        Finding::warning(MATERIAL_MISFIT, rms, MISFIT, text)
    })
}

/// A curve that changes in the wrong direction, and the rms and largest relative misfit of the fit through it.
pub fn reversal(name: &str, found: Reversal, rms: f64, largest: f64) -> Finding {
    let text = format!(
        "The {} of {name} changes by {} % in the direction in which that of a passive material does not: points scatter, or sweeps at \
         different temperatures do not continue each other. The fit runs through them with a misfit of {} % rms and {} % at most, and \
         results that depend on the modulus are uncertain by that much. Check the shift factors and the points (asperity material \
         fit --plot).",
        found.quantity,
        digits(100.0 * found.share),
        digits(100.0 * rms),
        digits(100.0 * largest)
    );
    Finding::warning(DATA_SCATTER, found.share, found.allowed, text)
}

/// Estimated shift factors, each as temperature \[K\], log10 a_T and standard deviation \[decades\].
pub fn shift_uncertain(name: &str, factors: &[[f64; 3]]) -> Option<Finding> {
    let [kelvin, _, decades] = factors.iter().max_by(|a, b| a[2].total_cmp(&b[2]))?;
    (decades.is_nan() || *decades > FACTOR).then(|| {
        let text = format!(
            "The shift factors of {name} were estimated from its sweeps; that of {} °C is uncertain by {} decades (a factor of {} in \
             time). At temperatures and times that depend on it, results are uncertain by the same factor in time. Give the shift \
             where it is known, or measure sweeps that overlap more.",
            digits(kelvin - 273.15),
            digits(*decades),
            digits(10f64.powf(*decades))
        );
        Finding::warning(SHIFT_UNCERTAIN, *decades, FACTOR, text)
    })
}

/// A file whose header names another modulus than the one that its numbers are taken as.
pub fn modulus_kind(name: &str, named: Modulus, taken: Modulus) -> Option<Finding> {
    let words = |measure| match measure {
        Modulus::Young => "Young's moduli (E)",
        Modulus::Shear => "shear moduli (G)",
    };
    (named != taken).then(|| {
        let text = format!(
            "The header of the data of {name} names {}, but the numbers are taken as {}, as the case or the command says: these \
             differ by the factor 2 (1 + Poisson's ratio), about 3 for a rubber. Correct the kind of modulus, or the header.",
            words(named),
            words(taken)
        );
        Finding::warning(MODULUS_KIND, f64::NAN, f64::NAN, text)
    })
}

/// Points of a measurement that lack a number and were left out of a fit, and the number of all points.
pub fn points_left_out(name: &str, left_out: usize, of: usize) -> Option<Finding> {
    (left_out > 0).then(|| {
        let points =
            if left_out == 1 { "points lacks a number and is" } else { "points lack a number and are" };
        let text = format!("{name}: {left_out} of {of} measured {points} left out of the fit.");
        Finding::warning(POINTS_LEFT_OUT, left_out as f64, 0.0, text).as_note()
    })
}

/// A fit of `unknowns` moduli (or compliances) and times to `numbers` measured ones that leaves none over: its misfit is near 0
/// whatever the data are.
pub fn too_few_points(name: &str, unknowns: usize, numbers: usize) -> Option<Finding> {
    (unknowns >= numbers).then(|| {
        let text = format!(
            "The material of {name} has {unknowns} unknowns (moduli and times), fitted to {numbers} measured values: the misfit is near 0 \
             whatever the values are, and does not show how well the material is known. Measure more points, or use fewer terms."
        );
        Finding::warning(TOO_FEW_POINTS, numbers as f64, unknowns as f64 + 1.0, text)
    })
}

/// A run that needs the material of `name` from the first to the last time \[s\], but it is known only over `window` \[s\]; `words`
/// describe the data.
pub fn beyond_data(name: &str, [first, last]: [f64; 2], window: [f64; 2], words: &str) -> Finding {
    let text = format!("{name}: {words}. Measure these times too, or regard the run as an estimate there.");
    // The end that is exceeded by more decades.
    let (short, long) = (window[0] / first, last / window[1]);
    let (value, limit) = if short > long { (first, window[0]) } else { (last, window[1]) };
    Finding::warning(BEYOND_MATERIAL_DATA, value, limit, text)
}
