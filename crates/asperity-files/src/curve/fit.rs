//! From measured curves to a material: one temperature as it is, several through a master curve.

use std::f64::consts::LN_10;

use asperity::finding::{self, Finding};
use asperity::material::{
    Creep, Fit, FitOptions, Isotherm, MasterCurve, Material, Misfit, Moduli, Modulus, ModulusChange,
    Relaxation, Reversal, Shift, ShiftFit, VerticalShift, estimate_shift, fit_arrhenius, fit_creep, fit_dma,
    fit_relaxation, fit_wlf, master_curve,
};

use super::clean::cleaned;
use super::error::{CurveError, Remedy, fault};
use super::isotherms::{abscissa, at_isotherm, held, isotherms, point, shifted_by, snap};
use super::sweeps::is_ramp;
use super::vertical::{self, VerticalRequest};
use super::{Curves, Kind, Sweep};

/// How times depend on temperature.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum ShiftRequest {
    /// Not known; the file holds one temperature.
    #[default]
    None,
    /// As given; the result holds at its reference temperature.
    Given(Shift),
    /// From the overlap of the sweeps; the result holds at this temperature \[K\].
    Estimate(f64),
}

/// How curves are fitted.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// What the moduli measure.
    pub measure: Modulus,
    /// How times depend on temperature.
    pub shift: ShiftRequest,
    /// How moduli depend on temperature besides.
    pub vertical: VerticalRequest,
    /// The part of the (reduced) curve that is fitted: times \[s\] or angular frequencies \[rad/s\].
    pub window: Option<[f64; 2]>,
    /// Grid, margins, terms.
    pub options: FitOptions,
}

impl Default for Request {
    fn default() -> Self {
        Request {
            measure: Modulus::Young,
            shift: ShiftRequest::None,
            vertical: VerticalRequest::None,
            window: None,
            options: FitOptions::default(),
        }
    }
}

/// The fitted function: creep data give a creep function, all others a relaxation function.
#[derive(Clone, Debug, PartialEq)]
pub enum Series {
    /// E(t) or G(t).
    Relaxation(Relaxation),
    /// D(t) or J(t).
    Creep(Creep),
}

/// A material fitted to curves, and how well.
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted {
    /// The material, at the reference temperature of the shift.
    pub material: Material,
    /// The function that was fitted.
    pub series: Series,
    /// Distance between the data that were fitted and the function.
    pub misfit: Misfit,
    /// The moduli of a DMA that were fitted.
    pub moduli: Moduli,
    /// The misfit of each column, fitted or not, behind its name.
    pub columns: Vec<(&'static str, Misfit)>,
    /// Scatter of the data (standard deviation, relative).
    pub noise: f64,
    /// Relative standard deviations of modulus (or compliance) and time of each term.
    pub uncertainty: Vec<[f64; 2]>,
    /// First and last (reduced) time that the data cover \[s\].
    pub window: [f64; 2],
    /// The points that were fitted: reduced abscissa and curves, in SI.
    pub data: MasterCurve,
    /// The shift, given or estimated.
    pub shift: Option<Shift>,
    /// Distance of the estimated law from the shift factors found [decades of a_T].
    pub shift_rms: Option<f64>,
    /// Temperature \[K\], log10 a_T and standard deviation \[decades\] of the shift factors that were estimated.
    pub factors: Vec<[f64; 3]>,
    /// How moduli depend on temperature besides, where that was asked for.
    pub vertical: Option<VerticalShift>,
    /// Temperature \[K\], b_T and its relative standard deviation (0 where it is given) of the sweeps.
    pub vertical_factors: Vec<[f64; 3]>,
    /// Temperatures of the sweeps \[K\], where the file holds them.
    pub temperatures: Vec<f64>,
    /// What the header of the data calls the moduli.
    pub named: Option<Modulus>,
    /// Whether the moduli or compliances of the file have no unit.
    pub unnamed: bool,
    /// The largest change of the data in a direction that no passive material has.
    pub reversal: Option<Reversal>,
    /// Most terms that it was allowed.
    pub max_terms: usize,
    /// Points of the file that lack a number and were left out.
    pub left_out: usize,
    /// What was assumed.
    pub notes: Vec<String>,
}

impl Fitted {
    /// Number of terms of the fitted function.
    pub fn terms(&self) -> usize {
        match &self.series {
            Series::Relaxation(relaxation) => relaxation.terms.len(),
            Series::Creep(creep) => creep.terms.len(),
        }
    }

    /// Number of moduli (or compliances) and times that were fitted, and number of measured values that they were fitted to.
    pub fn unknowns(&self) -> [usize; 2] {
        let ends = match &self.series {
            Series::Relaxation(relaxation) => usize::from(relaxation.equilibrium > 0.0),
            Series::Creep(creep) => 1 + usize::from(creep.fluidity > 0.0),
        };
        let fitted = if self.moduli == Moduli::Both { self.data.curves.len() } else { 1 };
        [2 * self.terms() + ends, fitted * self.data.x.len()]
    }

    /// The shift factor a_T of a sweep at this temperature \[K\]: of shift factors in a list that of its temperature. `None` without
    /// a shift, or where it says nothing of that temperature.
    pub fn shift_factor(&self, mut kelvin: f64) -> Option<f64> {
        let shift = self.shift.as_ref()?;
        if let Shift::Table { points } = shift {
            snap(&mut kelvin, points, is_ramp(self.temperatures.iter().copied()));
        }
        shift.factor(kelvin).ok()
    }

    /// The factor of the values of a sweep at this temperature \[K\] that brings them to the reference temperature: b_T of
    /// moduli, one over it of compliances; 1 without vertical shifts.
    pub fn value_factor(&self, kind: Kind, kelvin: f64) -> f64 {
        let found = self.vertical_factors.iter().find(|[known, ..]| *known == kelvin);
        vertical::of_values(kind, found.map_or(1.0, |[_, factor, _]| *factor))
    }

    /// The modulus of a DMA that was not fitted, and its misfit.
    pub fn other(&self) -> Option<(&'static str, Misfit)> {
        match (self.moduli, self.columns.as_slice()) {
            (Moduli::Storage, [_, loss]) => Some(*loss),
            (Moduli::Loss, [storage, _]) => Some(*storage),
            _ => None,
        }
    }

    /// Whether the fit is far from its data; of a fit of both moduli, how far from each, unless more terms may come closer.
    fn misfit_found(&self, name: &str) -> Option<Finding> {
        let Misfit { rms, max, .. } = self.misfit;
        match (self.moduli, self.columns.as_slice()) {
            (Moduli::Both, [(_, storage), (_, loss)]) if self.terms() < self.max_terms => {
                let found = finding::misfit_of_both(name, rms, [*storage, *loss], self.noise)?;
                Some(Finding { text: unsure(found.text, &self.factors), ..found })
            }
            _ => finding::misfit(name, rms, max, self.noise),
        }
    }

    /// What is found about the fit and its data; `name` is the file or the body.
    pub fn findings(&self, name: &str) -> Vec<Finding> {
        let Misfit { rms, max, .. } = self.misfit;
        let other =
            self.other().and_then(|(column, misfit)| finding::contradiction(name, column, misfit.rms));
        let kind = self.named.and_then(|named| finding::modulus_kind(name, named, self.material.measure()));
        let measured = self.data.x.len() + self.left_out;
        let [unknowns, numbers] = self.unknowns();
        let values = self.data.curves.first().into_iter().flatten().map(|value| match self.series {
            Series::Relaxation(_) => *value,
            Series::Creep(_) => 1.0 / value,
        });
        let ends =
            values.fold([f64::INFINITY, 0.0], |[least, most]: [f64; 2], v| [least.min(v), most.max(v)]);
        let all = [
            finding::unlikely_data(name, ends, self.unnamed),
            self.misfit_found(name),
            self.reversal.map(|found| finding::reversal(name, found, rms, max)),
            other,
            finding::shift_uncertain(name, &self.factors),
            kind,
            finding::points_left_out(name, self.left_out, measured),
            finding::too_few_points(name, unknowns, numbers),
        ];
        all.into_iter().flatten().collect()
    }
}

/// What the contradiction of both moduli may also come from.
const UNSURE: &str = "wrong shift factors do the same: they were estimated from these sweeps, so give the shift where it is known";

/// A sentence about moduli that contradict each other, with what else that may come from if their shift factors were estimated.
fn unsure(text: String, factors: &[[f64; 3]]) -> String {
    match factors {
        [] => text,
        _ => format!("{text}; {UNSURE}"),
    }
}

/// A law replaces estimated shift factors where it meets them within this (rms) and twice the standard deviation of each
/// \[decades\].
const LAW: f64 = 0.1;

/// No factor is taken to be known better \[decades\]: on the steepest slopes of a modulus this is 2 % of it.
const FACTOR: f64 = 0.01;

/// The function of a fit, and the rest of the fit.
fn taken<F>(fit: Fit<F>, series: fn(F) -> Series) -> (Series, Fit<()>) {
    let Fit { function, misfit, columns, window, noise, uncertainty, reversal } = fit;
    (series(function), Fit { function: (), misfit, columns, window, noise, uncertainty, reversal })
}

impl Request {
    /// Fits the curves.
    ///
    /// # Errors
    /// [`CurveError`], with the line where one point is to blame: several temperatures without a shift, points out
    /// of order or twice, values that no passive material has, too few points in the window.
    pub fn fit(&self, curves: &Curves) -> Result<Fitted, CurveError> {
        self.fitted(curves).map_err(|fault| fault.of(&curves.path))
    }

    fn fitted(&self, curves: &Curves) -> Result<Fitted, CurveError> {
        let (curves, left_out_here) = cleaned(curves, self)?;
        let curves = &curves;
        let mut notes = curves.notes.clone();
        notes.extend(left_out_here);
        let temperatures: Vec<f64> = curves.sweeps.iter().filter_map(|sweep| sweep.temperature).collect();
        let reference = self.reference(curves);
        let corrected = vertical::corrected(curves, &self.vertical, reference)?;
        let Found { shift, rms: shift_rms, factors } =
            self.shift_of(corrected.as_ref().map_or(curves, |corrected| &corrected.curves), &mut notes)?;
        let corrected = match (&self.vertical, &shift) {
            (VerticalRequest::Free, shift) => Some(vertical::free(curves, shift.as_ref(), &factors)?),
            _ => corrected,
        };
        let (data, lines) =
            master(corrected.as_ref().map_or(curves, |corrected| &corrected.curves), shift.as_ref())?;
        let (vertical, vertical_factors) =
            corrected.map_or((None, Vec::new()), |corrected| (Some(corrected.vertical), corrected.factors));
        let (data, lines) = self.inside(data, lines)?;
        let located = |error: asperity::Error| {
            let message = error.to_string();
            if message.contains("Kramers-Kronig") {
                return fault(unsure(message, &factors)).remedy(Remedy::Moduli);
            }
            let line = point(&message).and_then(|n| lines.get(n.checked_sub(1)?).copied());
            let part =
                message.contains("in a passive material").then(|| self.part(curves.kind, &data)).flatten();
            CurveError { remedy: part, ..fault(message).at(line) }
        };
        let (options, none) = (&self.options, Vec::new());
        let curve = |n: usize| data.curves.get(n).unwrap_or(&none).as_slice();
        let (series, fit) = match curves.kind {
            Kind::Creep => taken(fit_creep(&data.x, curve(0), options).map_err(located)?, Series::Creep),
            Kind::Dma if data.curves.len() == 1 => {
                // The loss modulus is not fitted: any does, and its misfit means nothing.
                let fit = fit_dma(&data.x, curve(0), &vec![0.0; data.x.len()], options);
                let fit = fit.map_err(located)?;
                taken(Fit { columns: fit.columns[..1].to_vec(), ..fit }, Series::Relaxation)
            }
            Kind::Dma => {
                let fit = fit_dma(&data.x, curve(0), curve(1), options);
                taken(fit.map_err(located)?, Series::Relaxation)
            }
            Kind::Relaxation => {
                taken(fit_relaxation(&data.x, curve(0), options).map_err(located)?, Series::Relaxation)
            }
        };
        let Fit { misfit, columns, noise, window, uncertainty, reversal, .. } = fit;
        let material = match &series {
            Series::Relaxation(relaxation) => Material::prony(self.measure, relaxation.clone()),
            Series::Creep(creep) => Material::generalised_kelvin(self.measure, creep.clone()),
        };
        let material = material.map_err(|error| fault(error.to_string()))?;
        let columns: Vec<(&str, Misfit)> = curves.kind.columns().iter().copied().zip(columns).collect();
        notes.extend(left_out(self.options.moduli, &columns).map(|note| unsure(note, &factors)));
        Ok(Fitted {
            material,
            max_terms: self.options.max_terms,
            series,
            misfit,
            moduli: self.options.moduli,
            columns,
            noise,
            uncertainty,
            window,
            data,
            shift,
            shift_rms,
            factors,
            vertical,
            vertical_factors,
            temperatures,
            named: curves.measure,
            unnamed: curves.columns.iter().any(|place| !place.named && place.role.is_modulus()),
            reversal,
            left_out: curves.left_out,
            notes,
        })
    }

    /// The half of the data with the larger values, as a part to fit: noise and slip are in the other one.
    fn part(&self, kind: Kind, data: &MasterCurve) -> Option<Remedy> {
        let half = data.x.len() / 2;
        let (first, last) = (*data.x.first()?, *data.x.get(half)?);
        let ends = kind == Kind::Relaxation && self.window.is_none() && first > 0.0 && last > first;
        ends.then(|| Remedy::Window(format!("{first:.3e} s"), format!("{last:.3e} s")))
    }

    /// The shift of the material.
    fn shift_of(&self, curves: &Curves, notes: &mut Vec<String>) -> Result<Found, CurveError> {
        let known = |shift: Option<Shift>| Found { shift, rms: None, factors: Vec::new() };
        if let (ShiftRequest::None, None, Some(why)) = (&self.shift, &curves.held.list, &curves.held.refused)
        {
            let message = format!("the list of shift factors in the file: {why}");
            return Err(fault(message).remedy(Remedy::KnownShift));
        }
        match (&self.shift, curves.held.shift()) {
            (ShiftRequest::None, Some(shift)) => {
                notes.extend(told_of_held(curves, shift));
                Ok(known(Some(shift.clone())))
            }
            (ShiftRequest::None, None) if curves.is_over_temperature() => Err(fault(format!(
                "the temperature changes from row to row, a ramp ({}): each row needs its shift factor",
                curves.temperatures()
            ))
            .remedy(Remedy::KnownShift)),
            (ShiftRequest::None, None) if curves.sweeps.len() > 1 => {
                let known: Vec<String> = curves.sweeps.iter().take(20).filter_map(Sweep::celsius).collect();
                let message =
                    format!("the file holds {} temperatures ({})", curves.sweeps.len(), known.join(", "));
                Err(fault(message).remedy(Remedy::Shift))
            }
            (ShiftRequest::None, None) => Ok(known(None)),
            (ShiftRequest::Given(shift), _) => {
                shift.validate().map_err(|error| fault(error.to_string()))?;
                Ok(known(Some(shift.clone())))
            }
            (ShiftRequest::Estimate(reference), _) => {
                let moduli = match &self.vertical {
                    VerticalRequest::None => ModulusChange::Neglected,
                    VerticalRequest::Density { .. } | VerticalRequest::Given(_) => ModulusChange::Corrected,
                    VerticalRequest::Free => ModulusChange::Free,
                };
                estimated(curves, *reference, moduli, notes)
            }
        }
    }

    /// The reference temperature of the shift \[K\]; `None` without a shift.
    fn reference(&self, curves: &Curves) -> Option<f64> {
        match &self.shift {
            ShiftRequest::Given(shift) => shift.reference(),
            ShiftRequest::Estimate(reference) => Some(*reference),
            ShiftRequest::None => curves.held.shift().and_then(Shift::reference),
        }
    }

    /// The points inside the window.
    fn inside(&self, data: MasterCurve, lines: Vec<usize>) -> Result<(MasterCurve, Vec<usize>), CurveError> {
        let Some([first, last]) = self.window else { return Ok((data, lines)) };
        // A point at the end of the window is inside it, even if the conversion of units rounds one of the two.
        let inside = |x: &f64| *x >= first * (1.0 - 1e-9) && *x <= last * (1.0 + 1e-9);
        let kept: Vec<usize> = (0..data.x.len()).filter(|n| inside(&data.x[*n])).collect();
        if kept.len() < 2 {
            let (least, most) = (data.x.first().unwrap_or(&0.0), data.x.last().unwrap_or(&0.0));
            return Err(fault(format!(
                "{} in the window of the fit, {first:e} to {last:e} (in s, or rad/s of a dma); the data run from {least:e} to {most:e}",
                if kept.len() == 1 { "1 point lies" } else { "0 points lie" }
            )));
        }
        let pick = |values: &Vec<f64>| kept.iter().map(|n| values[*n]).collect::<Vec<f64>>();
        let lines = kept.iter().filter_map(|n| lines.get(*n).copied()).collect();
        Ok((MasterCurve { x: pick(&data.x), curves: data.curves.iter().map(pick).collect() }, lines))
    }
}

/// The curve at the reference temperature, and the lines of its points if it is one sweep.
fn master(curves: &Curves, shift: Option<&Shift>) -> Result<(MasterCurve, Vec<usize>), CurveError> {
    if let ([sweep], None) | ([sweep @ Sweep { temperature: None, .. }], _) =
        (curves.sweeps.as_slice(), shift)
    {
        return Ok((MasterCurve { x: sweep.x.clone(), curves: sweep.curves.clone() }, sweep.lines.clone()));
    }
    let Some(shift) = shift else { return Err(fault("several temperatures need a shift")) };
    let master = master_curve(&shifted_by(curves, shift), abscissa(curves.kind), shift);
    let lines = match curves.sweeps.as_slice() {
        [sweep] => sweep.lines.clone(),
        _ => Vec::new(),
    };
    master.map(|master| (master, lines)).map_err(|error| at_isotherm(curves, &error))
}

/// A shift, the distance of an estimated law from its factors, and these.
struct Found {
    shift: Option<Shift>,
    rms: Option<f64>,
    factors: Vec<[f64; 3]>,
}

/// The shift about `reference` from the sweeps themselves: the WLF or the Arrhenius law where one describes the factors, else
/// the factors.
fn estimated(
    curves: &Curves,
    reference: f64,
    moduli: ModulusChange,
    notes: &mut Vec<String>,
) -> Result<Found, CurveError> {
    held(curves, "a shift")?;
    let isotherms = isotherms(curves);
    if isotherms.len() < 2 {
        return Err(fault("a shift can be estimated from sweeps at two temperatures or more")
            .remedy(Remedy::Column(super::Role::Temperature)));
    }
    let distance = |isotherm: &Isotherm| (isotherm.temperature - reference).abs();
    let nearest = isotherms.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
    let Some(anchor) = nearest.map(|isotherm| isotherm.temperature) else {
        return Err(fault("there are no sweeps"));
    };
    let estimate = estimate_shift(&isotherms, abscissa(curves.kind), anchor, moduli)
        .map_err(|error| at_isotherm(curves, &error).remedy(Remedy::KnownShift))?;
    let table = estimate.shift;
    let Shift::Table { points } = &table else {
        return Ok(Found { shift: Some(table), rms: None, factors: Vec::new() });
    };
    let about_anchor: Vec<[f64; 3]> =
        points.iter().zip(&estimate.uncertainty).map(|((kelvin, ln), u)| [*kelvin, ln / LN_10, *u]).collect();
    let laws = [fit_wlf(points, anchor), fit_arrhenius(points, anchor)];
    let holds = |law: &ShiftFit| {
        let near = |[kelvin, log, deviation]: &[f64; 3]| {
            let of_law = law.shift.ln_factor(*kelvin).map(|ln| ln / LN_10);
            of_law.is_ok_and(|found| (found - log).abs() <= 2.0 * deviation.max(FACTOR))
        };
        law.rms <= LAW && about_anchor.iter().all(near)
    };
    let best = laws.into_iter().flatten().filter(holds).min_by(|a, b| a.rms.total_cmp(&b.rms));
    let (shift, rms) = match best {
        Some(law) => (law.shift, Some(law.rms)),
        None => {
            notes.push(format!(
                "neither the WLF nor the Arrhenius law describes the shift factors, to within {LAW} decades and twice the \
                 standard deviation of each; the factors themselves are used, between the temperatures measured"
            ));
            (table, None)
        }
    };
    let moved = shift.about(reference).map_err(|error| fault(error.to_string()))?;
    // The reference may lie between sweeps.
    let zero = shift.ln_factor(reference).map_err(|error| fault(error.to_string()))? / LN_10;
    let factors = about_anchor.into_iter().map(|[kelvin, log, u]| [kelvin, log - zero, u]).collect();
    Ok(Found { shift: Some(moved), rms, factors })
}

/// Says that the shift of the file is used, and how far its law is from its list.
fn told_of_held(curves: &Curves, shift: &Shift) -> Option<String> {
    let source = match (&curves.held.list, &curves.held.wlf) {
        (Some(Shift::Table { points }), Some(wlf)) => {
            let apart: Option<Vec<f64>> =
                points.iter().map(|(kelvin, ln)| Some((wlf.ln_factor(*kelvin).ok()? - ln) / LN_10)).collect();
            let rms = apart.map(|apart| {
                let mean = apart.iter().sum::<f64>() / apart.len() as f64;
                (apart.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / apart.len() as f64).sqrt()
            });
            let apart = rms.map_or("not defined at all of its temperatures".to_owned(), |rms| {
                format!("{rms:.2} decades away from it (rms)")
            });
            format!("list of {} shift factors; its WLF constants are {apart}", points.len())
        }
        (Some(Shift::Table { points }), _) => format!("list of {} shift factors", points.len()),
        _ => "WLF constants".to_owned(),
    };
    shift.validate().ok().map(|()| format!("the shift is the file's {source}"))
}

/// Says what the fit of one modulus of a DMA does to the other.
fn left_out(moduli: Moduli, columns: &[(&'static str, Misfit)]) -> Option<String> {
    let (fitted, other) = match (moduli, columns) {
        (Moduli::Storage, [storage, loss]) => (storage, loss),
        (Moduli::Loss, [storage, loss]) => (loss, storage),
        _ => return None,
    };
    Some(format!(
        "only the {} modulus is fitted, to {:.1} % rms; the {} modulus is off by {:.1} % rms: measured moduli that contradict \
         each other more than they scatter belong to no linear viscoelastic material (Kramers-Kronig)",
        fitted.0,
        100.0 * fitted.1.rms,
        other.0,
        100.0 * other.1.rms
    ))
}
