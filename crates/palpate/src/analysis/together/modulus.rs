//! The modulus that the equilibrium forces imply.

use serde::{Deserialize, Serialize};

use crate::analysis::drifting::drifting;
use crate::analysis::options::{AnalysisOptions, Geometry};
use crate::contact::Specimen;
use crate::fit::{
    ErrorParts, Estimate, ExponentChoice, Fit, IntervalMethod, LawOptions, ParameterKind, Samples, fit_law_watched,
    fitted,
};
use crate::forecast::criteria;
use crate::instrument::Deviation;
use crate::laws::Law;
use crate::record::{Baseline, Record};
use crate::segment::{After, Phase, Segment, Segmentation};
use crate::statistics::{median, noise, range};
use crate::watch::{Cancelled, Watch};

/// Where the modulus comes from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ModulusSource {
    /// Given by the user.
    Given,
    /// Estimated from the equilibrium forces of the holds.
    Estimated,
}

/// A modulus that the equilibrium forces imply.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EstimatedModulus {
    /// E, Pa.
    pub estimate: Estimate,
    /// What its error is made of, where the instrument is described.
    pub parts: Option<ErrorParts>,
}

/// A modulus from equilibrium forces.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::analysis) struct ImpliedModulus {
    /// E, Pa.
    pub(in crate::analysis) value: f64,
    /// Its standard error, Pa; `None` where no fit gave the equilibrium forces, or the likeliest law has none.
    pub(in crate::analysis) standard_error: Option<f64>,
    /// Whether the likeliest law of the holds has no equilibrium.
    pub(in crate::analysis) without_equilibrium: bool,
    /// The forces that it follows from, by each law that may be that of the body.
    laws: Vec<ByLaw>,
}

/// The equilibrium forces of the holds by one law.
#[derive(Debug, Clone, PartialEq)]
struct ByLaw {
    /// Probability of the law.
    weight: f64,
    forces: Vec<RelaxedForce>,
}

/// The force that a hold tends to.
#[derive(Debug, Clone, Copy, PartialEq)]
struct RelaxedForce {
    /// Displacement of the jaw, m.
    displacement: f64,
    /// When the fit begins, s.
    time: f64,
    /// F_e, N.
    force: f64,
    /// What a slope of the force from then on adds to it, N per N/s.
    per_slope: f64,
    /// Its standard error, N.
    error: f64,
}

/// A hold in contact, and the fits to its force.
struct RelaxedHold {
    displacement: f64,
    /// When the fits begin, s.
    time: f64,
    /// How long it lasts from then on, s.
    duration: f64,
    last: f64,
    after_loading: bool,
    /// A law each; `None` where it could not be fitted.
    fits: Vec<Option<Fit>>,
    /// What a slope of the force adds to the equilibrium force of each, N per N/s; the last of the hold where none was looked for.
    per_slope: Vec<f64>,
}

/// Laws besides the latency law: those that end at an equilibrium, and two that have none, beside which the others may be unlikely.
const OTHERS: [Law; 7] = [
    Law::StandardLinearSolid,
    Law::Prony { terms: 2 },
    Law::Prony { terms: 3 },
    Law::Stretched,
    Law::FractionalZener,
    Law::Power,
    Law::Logarithmic,
];

/// A law of a smaller probability, over that of the likeliest, is left out.
const LEAST: f64 = 1e-3;

/// Probability of the laws that give an equilibrium, at least, whose error is that of the modulus.
const KNOWN: f64 = 0.05;

/// E from the holds: weighted least squares of F_e = E g(u₁), with g the equilibrium force of the body at 1 Pa: A(u₁) u₁/depth in
/// equation (11).
///
/// F_e is where the force of each hold tends to by a law that all holds have in common; it needs no E, since force and strain of a hold differ by
/// a factor. The laws are the latency law with the exponents of the options, series of exponentials, the stretched one and the fractional Zener model; each counts by exp(−½ Σ ΔBIC) over
/// the holds, and its E and their scatter between laws are those of the mixture (Buckland, Burnham and Augustin 1997); where a power or a logarithm of time, which
/// have no equilibrium, are far likelier than all of these, E has no error. Holds whose fit did not end well do
/// not count; the others count by the standard error of their F_e, and the error of E is widened where they scatter by more. Where nothing can be fitted
/// (a body that does not relax) the last forces of the holds after loading stand in. `None` if no hold has an area, or the
/// forces are negative.
pub(in crate::analysis) fn implied_modulus(
    record: &Record,
    segmentation: &Segmentation,
    geometry: &Geometry,
    options: &AnalysisOptions,
    watch: &mut dyn Watch,
) -> Result<Option<ImpliedModulus>, Cancelled> {
    let (Ok(body), Some(displacement)) = (geometry.specimen(1.0), record.displacement()) else {
        return Ok(None);
    };
    let latency = options.choices().map(|exponent| Law::Latency { exponent });
    let laws: Vec<Law> = latency.chain(OTHERS).collect();
    let mut holds: Vec<RelaxedHold> = Vec::new();
    for hold in segmentation.holds() {
        holds.extend(relaxed_hold(record, displacement, (hold, &laws), &body, options, watch)?);
    }
    Ok(implied_by(&holds, laws.len(), &body))
}

/// E from these holds, to each of which so many laws were fitted.
fn implied_by(holds: &[RelaxedHold], laws: usize, body: &Specimen) -> Option<ImpliedModulus> {
    // A law that ends well on few holds is none that they have in common.
    let by_law = |law: usize| {
        let forces: Vec<RelaxedForce> = holds.iter().filter_map(|hold| hold.tends_to(law)).collect();
        let found = weighted(&forces, body).filter(|_| 2 * forces.len() >= holds.len())?;
        Some((law, found, forces))
    };
    let evidence = evidence(holds, laws);
    let likeliest = (0..laws).max_by(|a, b| evidence[*a].total_cmp(&evidence[*b]))?;
    let ends = |fit: &Fit| fit.parameter(ParameterKind::Equilibrium).is_some();
    let without_equilibrium = holds.iter().filter_map(|hold| hold.fits[likeliest].as_ref()).any(|fit| !ends(fit));
    let known: Vec<(usize, (f64, f64), Vec<RelaxedForce>)> = (0..laws).filter_map(by_law).collect();
    // Weights count from the likeliest of these, which keep their shares beside a law without an equilibrium that is likelier by far.
    let best = known.iter().map(|(law, ..)| evidence[*law]).fold(f64::NEG_INFINITY, f64::max);
    let weight = |law: usize| (evidence[law] - best).exp();
    let whole: f64 = (0..laws).map(weight).sum();
    let found = known.into_iter().map(|(law, found, forces)| {
        (
            found,
            ByLaw {
                weight: weight(law),
                forces,
            },
        )
    });
    let found: Vec<((f64, f64), ByLaw)> = found.filter(|(_, law)| law.weight > LEAST).collect();
    if found.is_empty() {
        let last = |hold: &RelaxedHold| RelaxedForce {
            displacement: hold.displacement,
            time: hold.time,
            force: hold.last,
            per_slope: hold.duration,
            error: 1.0,
        };
        let forces: Vec<RelaxedForce> = holds.iter().filter(|hold| hold.after_loading).map(last).collect();
        let (value, _) = weighted(&forces, body)?;
        return Some(ImpliedModulus {
            value,
            standard_error: None,
            without_equilibrium,
            laws: vec![ByLaw { weight: 1.0, forces }],
        });
    }
    let all: f64 = found.iter().map(|(_, law)| law.weight).sum();
    let mean = |of: &dyn Fn(f64, f64) -> f64| {
        found.iter().map(|((value, error), law)| law.weight * of(*value, *error)).sum::<f64>() / all
    };
    let value = mean(&|value, _| value);
    let variance = mean(&|of_law, error| error * error + (of_law - value).powi(2));
    Some(ImpliedModulus {
        value,
        // Where the likely laws give no equilibrium, the error of an unlikely one is none.
        standard_error: (all > KNOWN * whole).then(|| variance.sqrt()),
        without_equilibrium,
        laws: found.into_iter().map(|(_, law)| law).collect(),
    })
}

impl RelaxedHold {
    /// The force that the hold tends to by a law; `None` where its fit did not end well.
    fn tends_to(&self, law: usize) -> Option<RelaxedForce> {
        let fit = self.fits[law].as_ref().filter(|fit| fit.termination.is_good())?;
        let equilibrium = fit.estimate("equilibrium")?;
        // Noise-free holds leave rounding only, which is no measure of their weight.
        let floor = 1e-9 * fit.predict(0.0).abs().max(equilibrium.value.abs());
        Some(RelaxedForce {
            displacement: self.displacement,
            time: self.time,
            force: equilibrium.value,
            per_slope: self.per_slope[law],
            error: equilibrium.standard_error?.max(floor),
        })
    }

    /// BIC of each law at the effective number of samples, infinite where it was not fitted.
    fn criteria(&self) -> Option<Vec<f64>> {
        let fits = || self.fits.iter().flatten();
        let closest = fits().min_by(|a, b| a.residual_square.total_cmp(&b.residual_square))?;
        // Noise-free records leave rounding only; below this share of the signal all residuals are equal.
        let floor = (1e-9 * closest.predict(0.0)).powi(2) * closest.samples as f64;
        let effective = closest.effective_samples();
        let share = effective / closest.samples as f64;
        let of =
            |fit: &Fit| criteria(fit.residual_square.max(floor) * share, effective, fit.free_parameters() as f64).bic;
        Some(self.fits.iter().map(|fit| fit.as_ref().map_or(f64::INFINITY, of)).collect())
    }
}

/// Logarithms of the probabilities of so many laws by the sums of their BIC over the holds that have samples enough for each, up to a constant.
fn evidence(holds: &[RelaxedHold], laws: usize) -> Vec<f64> {
    let has_all = |hold: &&RelaxedHold| hold.fits.iter().all(Option::is_some);
    let any_has_all = holds.iter().any(|hold| has_all(&hold));
    let mut sums = vec![0.0; laws];
    let counted = holds.iter().filter(|hold| !any_has_all || has_all(hold));
    for criteria in counted.filter_map(RelaxedHold::criteria) {
        sums.iter_mut().zip(criteria).for_each(|(sum, of_hold)| *sum += of_hold);
    }
    let least = sums.iter().copied().fold(f64::INFINITY, f64::min);
    sums.iter()
        .map(|sum| if sum.is_finite() { -0.5 * (sum - least) } else { f64::NEG_INFINITY })
        .collect()
}

impl ImpliedModulus {
    /// With the error that the scatter of the forces leaves.
    pub(in crate::analysis) fn estimate(&self) -> EstimatedModulus {
        EstimatedModulus {
            estimate: Estimate {
                standard_error: self.standard_error,
                ..Estimate::fixed(self.value)
            },
            parts: None,
        }
    }

    /// What the same holds imply with a quantity of the instrument off its estimate, Pa, at the temperature of the test; `None` where they
    /// imply none.
    pub(in crate::analysis) fn with(&self, geometry: &Geometry, deviation: &Deviation) -> Option<f64> {
        let body = geometry.with_shape(deviation.shape(&geometry.shape)).specimen(1.0).ok()?;
        let changed = |found: &RelaxedForce| RelaxedForce {
            displacement: deviation.displacement(found.displacement, found.force),
            force: deviation.force_at(found.force, found.time) + deviation.drift() * found.per_slope,
            ..*found
        };
        let all: f64 = self.laws.iter().map(|law| law.weight).sum();
        let of_law = |law: &ByLaw| {
            let forces: Vec<RelaxedForce> = law.forces.iter().map(changed).collect();
            Some(law.weight / all * weighted(&forces, &body)?.0)
        };
        self.laws.iter().map(of_law).sum()
    }
}

/// E = Σ w g F/Σ w g² with w = 1/σ², g the force at 1 Pa; its variance 1/Σ w g², times χ² per freedom where that exceeds 1.
///
/// `None` unless E is above zero.
fn weighted(forces: &[RelaxedForce], body: &Specimen) -> Option<(f64, f64)> {
    let unit = |found: &RelaxedForce| unit_force(body, found.displacement);
    let (mut square, mut shared) = (0.0, 0.0);
    for found in forces {
        square += (unit(found) / found.error).powi(2);
        shared += unit(found) * found.force / (found.error * found.error);
    }
    let value = shared / square;
    let off = |found: &RelaxedForce| ((found.force - value * unit(found)) / found.error).powi(2);
    let chi: f64 = forces.iter().map(off).sum();
    let freedom = (forces.len() as f64 - 1.0).max(1.0);
    (value.is_finite() && value > 0.0).then(|| (value, ((chi / freedom).max(1.0) / square).sqrt()))
}

/// The force that a body of 1 Pa keeps at a displacement of the jaw (m), N.
fn unit_force(body: &Specimen, displacement: f64) -> f64 {
    body.equilibrium_force(body.contact_displacement(displacement))
}

/// The fits to the force of a hold; `None` where the jaw may not touch the body.
fn relaxed_hold(
    record: &Record,
    displacement: &[f64],
    (hold, laws): (&Segment, &[Law]),
    body: &Specimen,
    options: &AnalysisOptions,
    watch: &mut dyn Watch,
) -> Result<Option<RelaxedHold>, Cancelled> {
    debug_assert_eq!(hold.phase, Phase::Hold);
    let rows = hold.fit_start..hold.end;
    let every = rows.len().div_ceil(2000).max(1);
    let start = record.time()[rows.start];
    let times: Vec<f64> = rows.clone().step_by(every).map(|i| record.time()[i] - start).collect();
    let force: Vec<f64> = rows.clone().step_by(every).map(|i| record.force()[i]).collect();
    let after_loading = hold.after == Some(After::Loading);
    // A jaw that retreats may leave the body, and the force of an open contact says nothing about the modulus.
    let lowest = force.iter().fold(f64::MAX, |least, f| least.min(*f));
    let displacement = median(&mut displacement[rows].to_vec());
    let last = force
        .last()
        .copied()
        .filter(|_| unit_force(body, displacement) > 0.0 && (after_loading || lowest > 5.0 * noise(&force)));
    let Some(last) = last else { return Ok(None) };
    let until = options.fitted(&times);
    let samples = Samples::new(&times[..until], &force[..until]);
    let fitting = |law: &Law| {
        let exponent = match law {
            Law::Latency { exponent } => *exponent,
            _ => ExponentChoice::Fixed(1.0),
        };
        // Standard errors are those of curvature anyway.
        LawOptions {
            intervals: IntervalMethod::Curvature,
            ..options.fit.of_latency(exponent)
        }
    };
    let fit = |law: &Law| fitted(fit_law_watched(&samples, *law, &fitting(law), watch));
    let fits = laws.iter().map(fit).collect::<Result<Vec<Option<Fit>>, Cancelled>>()?;
    let duration = times[times.len() - 1];
    let mut per_slope = vec![duration; laws.len()];
    if options.corrections.baseline == Some(Baseline::Sloped) && duration > 0.0 {
        /// What a slope adds by the end of the hold, as a share of the change of the force.
        const SMALL: f64 = 1e-3;
        let slope = SMALL * range(&force) / duration;
        for ((law, found), per_slope) in laws.iter().zip(&fits).zip(&mut per_slope) {
            let Some(level) = found.as_ref().and_then(|found| found.value("equilibrium")) else {
                continue;
            };
            let with = drifting(*law, &samples, &fitting(law), slope, watch)?;
            if let Some(moved) = with.and_then(|with| with.value("equilibrium")) {
                *per_slope = (moved - level) / slope;
            }
        }
    }
    Ok(Some(RelaxedHold {
        displacement,
        time: start,
        duration,
        last,
        after_loading,
        fits,
        per_slope,
    }))
}
