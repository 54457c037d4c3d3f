//! The order of the steps.

use super::effects::{Causes, error_of_modulus};
use super::holds::{HoldAnalysis, complete_hold, fit_exponents, forecast_holds, imposed, prepare_hold};
use super::prepare::{ClockSkew, Prepared, corrected_watched, signal_findings};
use super::together::{
    Across, EstimatedModulus, ImpliedModulus, LoadingModulus, ModulusSource, Overlay, across, changing_rate,
    exponent_not_listed, implied_modulus, loading_modulus, overlay, ramp_relaxes,
};
use super::{AnalysisError, AnalysisOptions, Finding};
use crate::budget::{Budget, Contribution, InputQuantity};
use crate::contact::Specimen;
use crate::fit::{ErrorParts, Fit, Parameter};
use crate::forecast::RampChoice;
use crate::laws::Loading;
use crate::number::significant;
use crate::record::{Record, SignalReport};
use crate::segment::{ContactPoint, Phase, SegmentError, Segmentation};
use crate::watch::{Cancelled, Progress, Unwatched, Watch};

/// The study of one record.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Analysis {
    /// The record after repair and tare; it knows what was done to it.
    pub record: Record,
    /// What its columns were like before.
    pub signals: SignalReport,
    /// Delay of the force stamps after those of the displacement, where the ramps determine it.
    pub skew: Option<ClockSkew>,
    /// The requested options.
    pub options: AnalysisOptions,
    /// Phases and the thresholds that found them.
    pub segmentation: Segmentation,
    /// First touch and what was subtracted.
    pub contact: ContactPoint,
    /// The body with its modulus, where the geometry is known.
    pub specimen: Option<Specimen>,
    /// Where the modulus comes from.
    pub modulus_source: Option<ModulusSource>,
    /// The modulus with its uncertainty, where it was estimated.
    pub modulus: Option<EstimatedModulus>,
    /// Input quantities of the budgets, in the order of the effects in [`ErrorParts`](crate::fit::ErrorParts): those of the instrument, then first touch and modulus
    /// where they were estimated. Empty where no instrument is described.
    pub inputs: Vec<InputQuantity>,
    /// Modulus of the first loading ramp, where the geometry is known.
    pub loading_modulus: Option<LoadingModulus>,
    /// Every hold.
    pub holds: Vec<HoldAnalysis>,
    /// Results over several holds.
    pub across: Across,
    /// The record simulated with the fitted parameters.
    pub overlay: Option<Overlay>,
    /// What to know about the record as a whole.
    pub findings: Vec<Finding>,
}

impl Analysis {
    /// The budget of a parameter of a fit to one of the holds; `None` where no instrument is described, and for a parameter that the data do not
    /// determine.
    #[must_use]
    pub fn budget(&self, fit: &Fit, parameter: &Parameter) -> Option<Budget> {
        let freedom = fit.uncertainty.as_ref()?.freedom;
        self.budget_of(parameter.estimate.value, parameter.parts.as_ref()?, freedom)
    }

    /// The budget of the modulus that the equilibrium forces imply.
    #[must_use]
    pub fn budget_of_modulus(&self) -> Option<Budget> {
        let modulus = self.modulus.as_ref()?;
        self.budget_of(modulus.estimate.value, modulus.parts.as_ref()?, f64::INFINITY)
    }

    fn budget_of(&self, value: f64, parts: &ErrorParts, freedom: f64) -> Option<Budget> {
        let inputs = self.inputs.iter().zip(&parts.effects);
        let others = inputs.filter(|(_, effect)| **effect != 0.0).map(|(input, effect)| Contribution {
            input: input.clone(),
            effect: *effect,
        });
        Some(Budget::of_estimate(value, parts.scatter?, freedom, others))
    }
}

/// Root mean square error of an overlay, as a share of the largest force, from which on it is called poor.
const POOR: f64 = 0.05;

/// Analyses a record: phases, first touch, strains, laws per hold and over holds, overlay.
///
/// # Errors
/// [`AnalysisError`] when the record has neither a hold nor a [modulus of its first ramp](Analysis::loading_modulus), a requested correction
/// cannot be made, the geometry is invalid or smaller than the travel of the jaw, or no hold has anything to fit.
pub fn analyze(record: &Record, options: &AnalysisOptions) -> Result<Analysis, AnalysisError> {
    analyze_watched(record, options, &mut Unwatched)
}

/// As [`analyze`]; the watch hears of every fit.
///
/// # Errors
/// Those of [`analyze`], and [`AnalysisError::Cancelled`].
pub fn analyze_watched(
    record: &Record,
    options: &AnalysisOptions,
    watch: &mut dyn Watch,
) -> Result<Analysis, AnalysisError> {
    let (analysis, no_hold) = examined(record, options, watch)?;
    match no_hold {
        Some(error) if analysis.loading_modulus.is_none() => Err(error.into()),
        _ => nothing_to_fit(&analysis.holds).map(|()| analysis),
    }
}

/// As [`analyze_watched`], but a record without a hold, or without one that can be fitted, is no error: its findings, or those of its holds,
/// give the reasons.
///
/// # Errors
/// Those of [`analyze_watched`] but [`AnalysisError::NothingToFit`], and [`AnalysisError::Segment`] only where phases cannot be sought.
pub fn examine(record: &Record, options: &AnalysisOptions, watch: &mut dyn Watch) -> Result<Analysis, AnalysisError> {
    examined(record, options, watch).map(|(analysis, _)| analysis)
}

/// An analysis, and why the record has no hold, if it has none.
fn examined(
    record: &Record,
    options: &AnalysisOptions,
    watch: &mut dyn Watch,
) -> Result<(Analysis, Option<SegmentError>), AnalysisError> {
    let signals = record.signals();
    let (corrected, no_hold) = corrected_watched(record, options, watch)?.or_ramps_alone(options);
    let mut hear = |task: &str| watch.report(Progress::open(task, 0));
    hear("finding first touch")?;
    let prepared = corrected.prepared(options, options.touch)?;
    hear("examining the columns")?;
    let mut findings = signal_findings((record, &signals), &corrected, &prepared, options);
    findings.extend(no_hold.as_ref().map(|error| Finding::NoHold {
        reason: error.to_string(),
    }));
    let skew = corrected.skew;
    let Prepared {
        record,
        segmentation,
        contact,
    } = prepared;
    hear("estimating the modulus")?;
    let (specimen, implied) = specimen(&record, &segmentation, options, &mut findings, watch)?.unzip();
    let mut hear = |task: &str| watch.report(Progress::open(task, 0));
    let implied = implied.flatten();
    let modulus_source = specimen.as_ref().map(|_| match implied {
        Some(_) => ModulusSource::Estimated,
        None => ModulusSource::Given,
    });
    let causes = Causes::new(options, &contact, specimen.as_ref(), implied.as_ref());
    // Without causes it has no error, nor has it one that first touch would add to.
    let modulus = implied
        .as_ref()
        .map(|implied| causes.as_ref().map_or_else(|| implied.estimate(), |causes| causes.of_modulus(implied)));
    findings.extend(modulus.iter().map(|modulus| Finding::ModulusEstimated {
        modulus: modulus.estimate.value,
        standard_error: modulus.estimate.standard_error,
        without_equilibrium: implied.as_ref().is_some_and(|implied| implied.without_equilibrium),
    }));
    let loading_modulus = loading_modulus(&record, &segmentation, &contact, options.geometry.as_ref());
    let segments = &segmentation.segments;
    let held = (0..segments.len()).filter(|index| segments[*index].phase == Phase::Hold);
    let measured = options.compare.as_ref().is_some_and(|compare| compare.ramps == RampChoice::Measured);
    let (mut holds, loadings): (Vec<HoldAnalysis>, Vec<Option<Loading>>) = held
        .zip(1..)
        .map(|(index, number)| {
            hear("preparing the holds")?;
            let loading = measured.then(|| imposed(&record, segments, index, options.separation)).flatten();
            Ok((prepare_hold(&record, (segments, index), number, specimen.as_ref(), options), loading))
        })
        .collect::<Result<Vec<_>, Cancelled>>()?
        .into_iter()
        .unzip();
    findings.extend(until_beyond(&holds, options));
    let (exponents, extension) = fit_exponents(&mut holds, options, watch)?;
    findings.extend(extension);
    for (hold, loading) in holds.iter_mut().zip(&loadings) {
        complete_hold(hold, &record, loading.as_ref(), options, watch)?;
    }
    forecast_holds(&mut holds, &loadings, options, watch)?;
    // Where causes are known the intervals contain that of first touch.
    let exact = specimen.as_ref().filter(|_| causes.is_none());
    findings.extend(exact.and_then(|specimen| uncertain_touch(&contact, specimen, &holds)));
    let across = across(&holds, &exponents, options, 4.0 * segmentation.settings.tolerance, watch)?;
    if !measured {
        findings.extend(ramp_relaxes(&record, &segmentation, &contact, &holds));
    }
    findings.extend(changing_rate(&across));
    findings.extend(exponent_not_listed(&holds, &across.evidence));
    let overlay = specimen.as_ref().filter(|_| !holds.is_empty()).and_then(|specimen| {
        let result = overlay((&record, &segmentation, &contact), specimen, &holds, across.common_exponent, options);
        result.map_err(|reason| findings.push(Finding::NoOverlay { reason })).ok()
    });
    if let Some(relative) = overlay.as_ref().map(|overlay| overlay.relative).filter(|relative| *relative > POOR) {
        findings.push(Finding::OverlayPoor { relative });
    }
    for hold in &mut holds {
        hold.modulus_error = error_of_modulus(hold, options, &contact);
    }
    // What holds have in common is no difference between them: all comparisons come first.
    if let Some(causes) = &causes {
        holds.iter_mut().try_for_each(|hold| causes.add_to(hold, watch))?;
    }
    let analysis = Analysis {
        inputs: causes.map_or_else(Vec::new, |causes| causes.inputs),
        modulus,
        record,
        signals,
        skew,
        options: options.clone(),
        segmentation,
        contact,
        specimen,
        modulus_source,
        loading_modulus,
        holds,
        across,
        overlay,
        findings,
    };
    Ok((analysis, no_hold))
}

/// The specimen with its given modulus, or with the one that the equilibrium forces imply.
fn specimen(
    record: &Record,
    segmentation: &Segmentation,
    options: &AnalysisOptions,
    findings: &mut Vec<Finding>,
    watch: &mut dyn Watch,
) -> Result<Option<(Specimen, Option<ImpliedModulus>)>, AnalysisError> {
    let Some(geometry) = options.geometry.as_ref().filter(|_| record.displacement().is_some()) else {
        return Ok(None);
    };
    let implied = implied_modulus(record, segmentation, geometry, options, watch)?;
    match (geometry.modulus, implied) {
        (Some(given), implied) => {
            let specimen = geometry.specimen(given)?;
            // A force that still falls by a law without an equilibrium is above the one that it tends to.
            let is_apart = |implied: &ImpliedModulus| {
                let ratio = implied.value / given;
                ratio < 0.8 || ratio > 1.25 && !implied.without_equilibrium
            };
            if let Some(implied) = implied.filter(is_apart) {
                findings.push(Finding::ModulusMismatch {
                    given,
                    implied: implied.value,
                });
            }
            Ok(Some((specimen, None)))
        }
        (None, Some(implied)) => {
            let specimen = geometry.specimen(implied.value)?;
            Ok(Some((specimen, Some(implied))))
        }
        // Validates the geometry even where no modulus can be determined.
        (None, None) => Ok(geometry.specimen(1.0).map(|_| None)?),
    }
}

/// A finding if the error of first touch moves an equilibrium strain by more than its interval says.
///
/// ε = F/S(u₁), so an error of u₁ moves it by the share S′/S · δu₁.
fn uncertain_touch(contact: &ContactPoint, specimen: &Specimen, holds: &[HoldAnalysis]) -> Option<Finding> {
    let error = contact.displacement_error?;
    let shares = holds.iter().filter_map(|hold| {
        let equilibrium = hold.preferred()?.equilibrium();
        let (low, high) = equilibrium.interval?;
        let u = specimen.contact_displacement(hold.displacement?);
        let moved = specimen.contact_displacement(error);
        let shift = specimen.stiffness(u + moved).0 / specimen.stiffness(u).0 - 1.0;
        Some((hold.number, shift, 0.5 * (high - low) / equilibrium.value.abs()))
    });
    let worst = shares.max_by(|a, b| (a.1 / a.2).total_cmp(&(b.1 / b.2)));
    // What rounding alone leaves open is no uncertainty.
    worst.filter(|(_, shift, interval)| *shift > interval.max(1e-5)).map(|(hold, shift, interval)| {
        Finding::TouchUncertain {
            error,
            hold,
            shift,
            interval,
        }
    })
}

/// The one force of all holds.
fn constant_force(holds: &[HoldAnalysis]) -> Option<f64> {
    let force = holds.first()?.force_start;
    let is_constant =
        |hold: &HoldAnalysis| hold.force_start == force && hold.values.iter().all(|value| *value == hold.values[0]);
    (force != 0.0 && holds.iter().all(is_constant)).then_some(force)
}

/// A finding if fits were to end later than every hold.
fn until_beyond(holds: &[HoldAnalysis], options: &AnalysisOptions) -> Option<Finding> {
    let longest = holds.iter().filter_map(|hold| hold.times.last()).copied().reduce(f64::max)?;
    let until = options.fit_until.filter(|until| *until > longest)?;
    Some(Finding::UntilBeyondHolds { until, longest })
}

/// An error unless some hold was fitted, with the reason that most likely can be helped.
fn nothing_to_fit(holds: &[HoldAnalysis]) -> Result<(), AnalysisError> {
    if holds.is_empty() || holds.iter().any(|hold| !hold.fits.is_empty()) {
        return Ok(());
    }
    let findings = || holds.iter().flat_map(|hold| hold.findings.iter().map(move |finding| (hold, finding)));
    let with = |code: &str| findings().find(|(_, finding)| finding.code() == code);
    // A start after almost all of the hold leaves too little to see whether anything relaxes.
    let late = holds.iter().find(|hold| {
        let left = hold.segment.end - hold.segment.fit_start;
        left < 8 && hold.segment.len() >= left + 8
    });
    let (reason, hint) = if let Some(hold) = late {
        let left = hold.segment.end - hold.segment.fit_start;
        (
            format!("the fit starts so late that only {left} of the {} samples of a hold remain", hold.segment.len()),
            "start the fit earlier: hold_start = \"settled\", or a shorter time after the peak",
        )
    } else if let Some((_, held)) = with("feedback_controlled") {
        let hint = "fit the displacement as creep: ⟨compare/creep⟩";
        (format!("the machine held the force; {}", held.observation()), hint)
    } else if let Some((hold, few)) = with("too_few_samples") {
        let needed = if let Finding::TooFewSamples { needed, .. } = few { *needed } else { 0 };
        let observed = few.observation();
        if hold.fitted < hold.times.len() && hold.times.len() >= needed {
            (format!("{observed} (up to the time set with until)"), "raise until (⟨fit_until⟩)")
        } else {
            (observed, "hold longer or sample faster; `palpate inspect` shows the detected phases")
        }
    } else if let Some((_, area)) = with("no_contact_area") {
        (
            area.observation(),
            "check first touch (touch), the radius, and the unit and sign of the displacement",
        )
    } else if let Some(force) = constant_force(holds) {
        let reason = format!("the force is {} N throughout: there is no relaxation", significant(force, 4));
        let hint = "check the force column and that the load cell was connected; for creep use `⟨compare/creep⟩`";
        (reason, hint)
    } else if let Some((_, still)) = with("no_relaxation") {
        let reason = format!("the force does not change in any hold ({} in the first)", still.observation());
        (reason, "check the force column and its unit; without relaxation there is no law to fit")
    } else {
        let observed = findings().next().map(|(_, finding)| finding.observation());
        let reason = observed.unwrap_or_else(|| "no fit converged".to_owned());
        (reason, "`palpate inspect` shows the detected phases")
    };
    Err(AnalysisError::NothingToFit {
        holds: holds.len(),
        reason,
        hint,
    })
}
