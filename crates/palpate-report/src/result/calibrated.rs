//! What a calibration of a record is shown with.

use palpate::calibrate::{
    CalibrateError, Calibration, CalibrationData, CalibrationRange, Candidate, Material, Misfit, ParameterProfile,
    RateLaw, ResidualCourse,
};
use palpate::contact::Shape;
use palpate::fit::Termination;
use palpate::instrument::{Instrument, InstrumentInput};
use palpate::number::significant;
use palpate::simulate::Separation;
use palpate::units::quantity;

use super::input::Input;
use super::misfit::sentence_of_misfit;
use super::parameters::parameter_title;
use crate::number::counted;
use crate::word::word;

/// Candidates calibrated on one record; the first is the one that is requested, the others are its alternatives.
#[derive(Debug)]
pub struct CalibratedRecord {
    /// The record.
    pub input: Input,
    /// What was fitted.
    pub data: CalibrationData,
    /// Each candidate with what was found, or why nothing was.
    pub rows: Vec<(Candidate, Result<Calibration, CalibrateError>)>,
    /// Profile intervals of what is requested; none if they were not.
    pub profiles: Vec<ParameterProfile>,
}

impl CalibratedRecord {
    /// The calibrations that were made, in the order of their candidates.
    pub fn made(&self) -> impl Iterator<Item = &Calibration> {
        self.rows.iter().filter_map(|(_, made)| made.as_ref().ok())
    }

    /// What was requested, if it could be made.
    #[must_use]
    pub fn chosen(&self) -> Option<&Calibration> {
        self.rows.first().and_then(|(_, made)| made.as_ref().ok())
    }

    /// BIC less the lowest of those candidates whose search ended at an optimum; `None` where it did not: there is no telling how low it would be.
    #[must_use]
    pub fn delta_bic(&self, made: &Calibration) -> Option<f64> {
        let least = self.ranked().map(|made| made.criteria.bic).fold(f64::INFINITY, f64::min);
        Some(made.criteria.bic - least).filter(|delta| made.termination.is_good() && delta.is_finite())
    }

    /// Candidates whose search ended at an optimum.
    fn ranked(&self) -> impl Iterator<Item = &Calibration> {
        self.made().filter(|made| made.termination.is_good())
    }

    /// What the record shows against the law that was requested: another law that refutes it, or else residuals that follow a course.
    #[must_use]
    pub fn misfit(&self) -> Option<Misfit> {
        let chosen = self.chosen()?;
        let others = self.rows[1..].iter().filter_map(|(_, made)| made.as_ref().ok());
        let refuting = chosen.refuted_by(others).map(|other| other.material.candidate());
        refuting
            .map(|Candidate { law, rate, .. }| Misfit::Law { law, rate })
            .or_else(|| chosen.course.map(|_| Misfit::Residuals))
    }

    /// What the table says in a sentence: the same figures rank.
    #[must_use]
    pub fn sentence(&self) -> Option<String> {
        let chosen = self.chosen().filter(|_| self.made().count() > 1)?;
        let score = |made: &Calibration| made.holdout.map_or(made.criteria.bic, |holdout| holdout.rmse);
        let best = self.ranked().min_by(|a, b| score(a).total_cmp(&score(b)))?;
        let (law, other) = (chosen.material.candidate(), best.material.candidate());
        let by = if chosen.holdout.is_some() { "predicts the rest of the record best" } else { "has the lowest BIC" };
        Some(if law == other {
            format!("Of the laws tried, {law} {by}.")
        } else if !chosen.termination.is_good() {
            format!(
                "Of the laws tried, {other} {by}; the search of {law} did not end at an optimum, so that it has no rank."
            )
        } else {
            let cost = match (chosen.holdout, best.holdout) {
                (Some(mine), Some(least)) => format!("{:.2} times its error", mine.rmse / least.rmse),
                _ => format!("{:.0} more", self.delta_bic(chosen).unwrap_or(0.0)),
            };
            format!("Of the laws tried, {other} {by}; {law} has {cost}.")
        })
    }

    /// The answer in lines: the law with its values put in, how closely it describes the record, and what it predicts of the held-out
    /// part.
    #[must_use]
    pub fn answer(&self) -> Vec<String> {
        let Some(chosen) = self.chosen() else {
            return vec!["The law could not be calibrated on this record.".to_owned()];
        };
        let law = chosen.material.candidate();
        let mut lines = vec![match chosen.termination.is_good() {
            true => format!("Law calibrated on this record: {law}."),
            false => format!(
                "The record does not determine the law {law}: the search did not end at an optimum ({}). What follows is where it ended.",
                word(chosen.termination).replace('_', " ")
            ),
        }];
        lines.extend(formula_of_material(&chosen.material));
        let percent = |share: f64| significant(100.0 * share, 2);
        let fitted = format!("Root mean square residual: {}", quantity(chosen.rmse, "N", 3));
        lines.push(format!("{fitted}, {} % of the peak force.", percent(chosen.relative)));
        lines.push(match chosen.holdout {
            Some(held) => format!(
                "Held-out error beyond the fitted part: {}, {} % of the peak force.",
                quantity(held.rmse, "N", 3),
                percent(held.relative)
            ),
            None => "No part was held out: how far the law predicts is not tested (--fit-until).".to_owned(),
        });
        lines
    }

    /// What a calibration shows that its parameters alone do not tell.
    #[must_use]
    pub fn remarks(&self) -> Vec<String> {
        let mut remarks: Vec<String> = self.sentence().into_iter().collect();
        if let Some(chosen) = self.chosen() {
            // Residuals have a remark of their own.
            let refuted = self.misfit().filter(|misfit| *misfit != Misfit::Residuals);
            remarks.extend(refuted.map(|by| sentence_of_misfit(&by, &chosen.material.candidate().to_string())));
            if chosen.material.candidate().rate == RateLaw::ByStrain && self.data.depths_held() < 2 {
                remarks.push("The record holds one displacement: only the ramps determine the dependence of v on strain, so that an error of the law there biases it. Holds at several displacements would determine it.".to_owned());
            }
            remarks.extend(remarks_of(chosen));
            remarks.extend(exact(self.data.instrument()));
        }
        remarks
    }
}

/// The remark where no instrument is described: what the intervals contain that was found in the record, and what counts as exact.
fn exact(instrument: &Instrument) -> Option<String> {
    // Others were stated.
    let is_found = |input: &InstrumentInput| input.uncertainty.name.ends_with(", as found");
    if !instrument.inputs.iter().all(is_found) {
        return None;
    }
    let is_found = |name: &str| instrument.inputs.iter().any(|input| input.quantity.name() == name);
    let (touch, zero) = (is_found("touch"), is_found("force"));
    let found = [
        (touch, "first touch"),
        (zero, "the zero of the force"),
        (is_found("force_drift"), "the slope of its baseline"),
    ];
    let found: Vec<&str> = found.into_iter().filter_map(|(is_found, title)| is_found.then_some(title)).collect();
    let known = match found.as_slice() {
        [] => String::new(),
        [one] => format!(", and of {one} as found"),
        [first @ .., last] => format!(", and of {} and {last} as found", first.join(", ")),
    };
    let cell = if zero { "gain of the load cell" } else { "load cell" };
    let first_touch = if touch { "" } else { ", first touch" };
    Some(format!(
        "The intervals are those of the scatter of the samples (Type A){known}: {cell}, displacement{first_touch} and the sizes of the body count as exact. [instrument] in the test description states their uncertainty."
    ))
}

fn remarks_of(made: &Calibration) -> Vec<String> {
    let mut remarks = Vec::new();
    if made.termination != Termination::Converged {
        let how = match made.termination {
            Termination::TermsMerged => {
                "Terms of the series merged: their time constants are not distinguishable. Fewer terms suffice."
                    .to_owned()
            }
            Termination::Singular => {
                "The record does not determine the parameters separately; holds of different excess strain would."
                    .to_owned()
            }
            Termination::IterationLimit => "The search reached its step limit before an optimum.".to_owned(),
            at_bound => format!(
                "The search ended at a bound ({}): the record does not determine a parameter.",
                word(at_bound).replace('_', " ")
            ),
        };
        remarks.push(format!("{how} The parameters have no intervals."));
    } else if let Some(open) = made
        .material
        .parameters()
        .iter()
        .filter(|parameter| !Material::is_given(made.material.candidate(), &parameter.name))
        .find(|parameter| parameter.estimate.interval.is_none_or(|(low, high)| high > 100.0 * low))
        && made.material.uncertainty().is_some()
    {
        let name = parameter_title(&open.name);
        let how = match open.estimate.interval {
            Some(_) => "hardly determines {}: its interval spans more than two decades",
            None => "does not determine {}",
        };
        let how = how.replace("{}", &name);
        remarks.push(format!("The record {how}. Holds of different excess strain would determine it."));
    }
    let percent = |share: f64| significant(100.0 * share, 2);
    remarks.extend(made.course.map(|course| match course {
        ResidualCourse::Systematic => format!(
            "The residuals ({} % of the peak) are systematic: the law does not describe all of the record. Standard errors and intervals account for their correlation, not for a law of another form; --fit-until reports a held-out error.",
            percent(made.relative)
        ),
        ResidualCourse::Slow => format!(
            "The residuals ({} % of the peak) go slowly: the law misses part of the record, or the force drifts, as of a body that swells. Standard errors and intervals account for their correlation, neither for a law of another form nor for a drift.",
            percent(made.relative)
        ),
        ResidualCourse::Ramps { relative } => format!(
            "The residuals follow a course in ramps or right after them (up to {} % of the peak, root mean square): the law misses what the body does there, as of one that stiffens. Parameters that the ramps determine, such as overshoots, may be off by more than their intervals.",
            percent(relative)
        ),
    }));
    remarks.push(range_remark(made.material.range()));
    remarks.extend(bonded_remark(&made.material));
    remarks
}

/// That jaws can pull on a body of constant section, which a description assumes where it is silent and a protocol does not.
pub(super) fn bonded_remark(material: &Material) -> Option<String> {
    let body = material.body();
    let is_so = body.separation == Separation::Bonded && matches!(body.shape, Shape::Prism { .. });
    is_so.then(|| {
        "The jaws count as bonded to the body and can pull: separation = false in [contact], the default of a test of this shape. Where they only press, as in a grip, set separation = true.".to_owned()
    })
}

/// The range of the tests, in a sentence.
pub(super) fn range_remark(range: &CalibrationRange) -> String {
    let retreat = match range.farthest_retreat {
        0.0 => "loading alone".to_owned(),
        retreat => format!("retreats of up to {}", quantity(retreat, "m", 3)),
    };
    let holds: Vec<String> = [("", range.longest_hold), (" of the force", range.longest_force_hold)]
        .into_iter()
        .filter(|(_, longest)| *longest > 0.0)
        .map(|(what, longest)| format!("holds{what} of up to {}, ", quantity(longest, "s", 3)))
        .collect();
    format!(
        "Calibration range: {}displacements of up to {}, ramps of {} to {}, forces of up to {}, {retreat}, {}. Predictions beyond this range are marked as extrapolations, and their intervals are wider.",
        holds.concat(),
        quantity(range.deepest, "m", 3),
        quantity(range.slowest, "m/s", 3),
        quantity(range.fastest, "m/s", 3),
        quantity(range.largest_force, "N", 3),
        counted(range.loadings as usize, "loading")
    )
}

/// The law of a material with its values put in: the latency law as its rate, a linear law as the ratio of force and equilibrium force
/// after a step.
#[must_use]
pub fn formula_of_material(material: &Material) -> Option<String> {
    let value = |name: &str| material.estimate(name).map(|estimate| estimate.value);
    if let (Some(rate), Some(exponent)) = (value("rate_coefficient_per_s"), value("exponent")) {
        let (rate, exponent) = (significant(rate, 4), significant(exponent, 4));
        return Some(format!("dε/dt = −{rate} s⁻¹ · sgn(ε − εₑ) |ε − εₑ|^{exponent}"));
    }
    let terms: Vec<String> = (1..)
        .map_while(|term| Some((value(&format!("overshoot_{term}"))?, value(&format!("time_constant_{term}_s"))?)))
        .map(|(overshoot, time)| format!("{} · exp(−t/{})", significant(overshoot, 4), quantity(time, "s", 4)))
        .collect();
    (!terms.is_empty()).then(|| format!("F(t)/Fₑ = 1 + {}", terms.join(" + ")))
}
