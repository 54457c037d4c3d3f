//! What the paper concludes, on a record of one's own.

use crate::analysis::{Analysis, HoldAnalysis, Signal};
use crate::fit::{Estimate, LatencyFit};
use crate::paper::study::loaded;
use crate::paper::{Claim, Comparison, Evidence, Place, Relation};
use crate::segment::{After, RelaxationType};
use crate::statistics::{noise, normal_factor};

use super::{millimetres, sorted};

/// The paper's exponent.
const ORDER: f64 = 5.0;
/// Two displacements are the same up to this share of the larger.
const SAME: f64 = 0.02;
/// Coverage of the intervals that verdicts go by.
const CONFIDENCE: f64 = 0.95;
/// Two equilibrium strains agree if they differ by no more than this, in percent.
const AGREES: f64 = 10.0;
/// Difference of an information criterion that is evidence.
const EVIDENCE: f64 = 2.0;

/// What the paper concludes from its tests, on the analysis of a record; conclusions that the record cannot show say why.
///
/// The analysis has to include n = 5 among its exponents.
///
/// ```
/// use palpate::paper::{Published, Verdict, record_claims, reproduce, LaboratoryOptions};
/// use palpate::watch::Unwatched;
/// let few = LaboratoryOptions { seeds: 1, sample_rate: 10.0, ..LaboratoryOptions::default() };
/// let study = reproduce(&Published::default(), &few, &mut Unwatched)?;
/// // A simulated test (a) has n = 5 and one v.
/// let claims = record_claims(&study.test_a.analysis);
/// let of = |start: &str| claims.iter().find(|claim| claim.statement.starts_with(start)).unwrap().verdict();
/// assert_eq!(of("n = 5"), Verdict::Reproduced);
/// assert_eq!(of("v falls"), Verdict::NotReproduced); // without noise v has no error
/// assert_eq!(of("εₑ agrees"), Verdict::CannotBeChecked); // no hold after unloading
/// # Ok::<(), palpate::paper::PaperError>(())
/// ```
#[must_use]
pub fn record_claims(analysis: &Analysis) -> Vec<Claim> {
    sorted(vec![
        matching(analysis),
        types(analysis, After::Loading),
        types(analysis, After::Unloading),
        stepwise(analysis),
        order(analysis),
        agreeing(analysis),
        falling(analysis),
        amounts(analysis),
    ])
}

fn after(analysis: &Analysis, after: After) -> Vec<&HoldAnalysis> {
    loaded(analysis).filter(|hold| hold.after == Some(after)).collect()
}

/// Holds after loading with their fits by n = 5, in the order of the record.
fn fitted(analysis: &Analysis, which: After) -> Vec<(&HoldAnalysis, &LatencyFit)> {
    let holds = after(analysis, which).into_iter();
    holds
        .filter_map(|hold| Some((hold, hold.fit_with(ORDER)?)))
        .filter(|(_, fit)| fit.termination.is_good())
        .collect()
}

fn has_strain(analysis: &Analysis) -> bool {
    analysis.holds.iter().any(|hold| hold.signal == Signal::Strain)
}

const NO_STRAIN: &str = "The record has no strain: its description lacks the body, or its columns the displacement.";
const FEW: &str =
    "Fewer than two displacements are held after loading and fitted with n = 5 and an error that the data determine.";

/// Half of an interval of a number with this standard error.
fn half(standard_error: f64) -> f64 {
    normal_factor(CONFIDENCE) * standard_error
}

fn types(analysis: &Analysis, which: After) -> Claim {
    let (statement, kind, quantity) = match which {
        After::Loading => (
            "Type I relaxation follows loading.",
            RelaxationType::TypeI,
            "holds after loading with a falling force",
        ),
        After::Unloading => (
            "Type II relaxation follows unloading.",
            RelaxationType::TypeII,
            "holds after unloading with a rising force",
        ),
    };
    let claim = Claim::new(Place::Figure("1(a)"), statement).shown_by(Evidence::Figure("figure_4"));
    let holds = after(analysis, which);
    if holds.is_empty() {
        return claim.remark("The record has no such hold.");
    }
    let found = holds.iter().filter(|hold| hold.relaxation.kind == kind).count();
    claim.compared([Comparison::all(quantity, found, holds.len())])
}

/// The information criterion of n = 5 less that of a free exponent, summed over all holds.
fn against_free(analysis: &Analysis) -> Option<f64> {
    let of_hold = |hold: &HoldAnalysis| {
        let candidates = &hold.order.as_ref()?.candidates;
        let five = candidates.iter().find(|one| !one.free && one.exponent == ORDER)?;
        Some(five.delta_bic - candidates.iter().find(|one| one.free)?.delta_bic)
    };
    let fitted = analysis.holds.iter().filter(|hold| hold.order.is_some());
    fitted.map(of_hold).sum()
}

fn order(analysis: &Analysis) -> Claim {
    let claim = Claim::new(Place::Equation("10"), "n = 5 is the lowest order that fits best.")
        .shown_by(Evidence::Table("orders"));
    let Some(found) = analysis.across.common_exponent else {
        return claim.remark("No hold is fitted with every listed exponent.");
    };
    let alike: Vec<String> = analysis
        .across
        .evidence
        .iter()
        .filter(|(_, delta)| *delta <= EVIDENCE)
        .map(|(n, _)| n.to_string())
        .collect();
    let free = against_free(analysis).map(|more| {
        Comparison::new(
            "summed information criterion of n = 5 less that of a free n, which pays for its further parameter",
            "",
            (0.0, Relation::AtMost, more),
            (EVIDENCE, "a difference that is no evidence"),
        )
    });
    claim
        .compared([Comparison::new(
            "lowest listed n whose summed information criterion is within 2 of the lowest",
            "",
            (ORDER, Relation::Equal, found),
            (0.0, "an order is one of a list"),
        )])
        .compared(free)
        .remark(format!("Listed orders that are within 2 of the lowest criterion: {}.", alike.join(", ")))
}

/// Whether numbers, each with its displacement and half of its 95 % interval, rise at every step.
fn steps_up(quantity: &str, unit: &str, levels: &[(f64, f64, f64)]) -> Vec<Comparison> {
    let step = |pair: &[(f64, f64, f64)]| {
        let ((from, a, a_error), (to, b, b_error)) = (pair[0], pair[1]);
        Comparison::new(
            format!("{quantity} from {} to {} mm", millimetres(from), millimetres(to)),
            unit,
            (0.0, Relation::AtLeast, (b - a, a_error.hypot(b_error))),
            (0.0, "the whole 95 % interval has to be above 0"),
        )
    };
    levels.windows(2).map(step).collect()
}

fn stepwise(analysis: &Analysis) -> Claim {
    let claim = Claim::new(Place::Section("Abstract"), "The equilibrium strain increases step by step.")
        .shown_by(Evidence::Table("table_1"));
    if !has_strain(analysis) {
        return claim.remark(NO_STRAIN);
    }
    let level = |(hold, fit): &(&HoldAnalysis, &LatencyFit)| {
        let found = fit.equilibrium();
        Some((hold.displacement?, found.value, half(found.standard_error?)))
    };
    let levels: Vec<_> = by_displacement(fitted(analysis, After::Loading)).iter().filter_map(level).collect();
    if levels.len() < 2 {
        return claim.remark(FEW);
    }
    claim.compared(steps_up("increase of |εₑ|", "", &levels))
}

fn falling(analysis: &Analysis) -> Claim {
    let claim = Claim::new(Place::Section("III-C"), "v falls from step to step of loading.")
        .shown_by(Evidence::Figure("rate_coefficients"));
    let level = |(hold, fit): &(&HoldAnalysis, &LatencyFit)| {
        let v = fit.rate_coefficient();
        Some((hold.displacement?, -v.value.ln(), half(v.standard_error? / v.value)))
    };
    let levels: Vec<_> = by_displacement(fitted(analysis, After::Loading)).iter().filter_map(level).collect();
    if levels.len() < 2 {
        return claim.remark(FEW);
    }
    claim.compared(steps_up("fall of ln v", "", &levels))
}

/// One hold for each displacement, the first, ascending.
fn by_displacement<'a>(mut fits: Vec<(&'a HoldAnalysis, &'a LatencyFit)>) -> Vec<(&'a HoldAnalysis, &'a LatencyFit)> {
    let displacement = |hold: &HoldAnalysis| hold.displacement.unwrap_or(0.0);
    if fits.iter().all(|(hold, _)| hold.displacement.is_some()) {
        fits.sort_by(|a, b| displacement(a.0).total_cmp(&displacement(b.0)));
        fits.dedup_by(|later, earlier| same(displacement(later.0), displacement(earlier.0)));
    }
    fits
}

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME * a.abs().max(b.abs())
}

fn agreeing(analysis: &Analysis) -> Claim {
    let claim = Claim::new(Place::Section("III-C"), "εₑ agrees between loading and unloading at one displacement.")
        .shown_by(Evidence::Figure("equilibria"));
    if !has_strain(analysis) {
        return claim.remark(NO_STRAIN);
    }
    let loading = fitted(analysis, After::Loading);
    let compared: Vec<Comparison> = fitted(analysis, After::Unloading)
        .into_iter()
        .filter_map(|(below, unloading)| {
            let level = below.displacement?;
            let partner = loading.iter().rev().find(|(hold, _)| hold.displacement.is_some_and(|d| same(d, level)))?;
            let (a, b): (Estimate, Estimate) = (partner.1.equilibrium(), unloading.equilibrium());
            let percent = 100.0 / a.value.abs();
            Some(Comparison::new(
                format!("difference of εₑ at {} mm after unloading from that after loading", millimetres(level)),
                "%",
                (
                    0.0,
                    Relation::AtMost,
                    (percent * (a.value - b.value).abs(), half(percent * a.standard_error?.hypot(b.standard_error?))),
                ),
                (AGREES, "the whole 95 % interval has to be below a tenth of εₑ"),
            ))
        })
        .collect();
    if compared.is_empty() {
        return claim
            .remark("No displacement is held both after loading and after unloading, with n = 5 fitted to both.");
    }
    claim.compared(compared)
}

fn amounts(analysis: &Analysis) -> Claim {
    let claim =
        Claim::new(Place::Section("V-A"), "The amount of relaxation is larger where the displacement is larger.")
            .shown_by(Evidence::Figure("figure_4"));
    let level = |hold: &HoldAnalysis| {
        let force = &analysis.record.force()[hold.segment.start..hold.segment.end];
        let error = half(std::f64::consts::SQRT_2 * noise(force));
        Some((hold.displacement?, hold.force_start - hold.force_end, error))
    };
    let mut levels: Vec<_> = after(analysis, After::Loading).into_iter().filter_map(level).collect();
    levels.sort_by(|a, b| a.0.total_cmp(&b.0));
    levels.dedup_by(|later, earlier| same(later.0, earlier.0));
    if levels.len() < 2 {
        return claim.remark("Fewer than two displacements are held after loading.");
    }
    claim.compared(steps_up("increase of the fall of the force", "N", &levels))
}

fn matching(analysis: &Analysis) -> Claim {
    /// Error of a simulation, in percent of the largest force, up to which it matches.
    const MATCH: f64 = 5.0;
    let claim = Claim::new(Place::Section("Abstract"), "Simulation and experiment match well.")
        .shown_by(Evidence::Figure("figure_8"));
    match &analysis.overlay {
        Some(overlay) => claim.compared([Comparison::new(
            "root mean square difference over the largest force",
            "%",
            (0.0, Relation::AtMost, 100.0 * overlay.relative),
            (MATCH, "the limit of the finding overlay_poor"),
        )]),
        None => claim.remark("The record cannot be simulated: the body, or the displacement, is not known."),
    }
}
