//! What the paper concludes, on a record of one's own.

use crate::analysis::{Analysis, HoldAnalysis, Signal};
use crate::fit::{Estimate, LatencyFit};
use crate::paper::study::loaded;
use crate::paper::{Claim, Comparison, Evidence, Place, Relation};
use crate::segment::{After, RelaxationType};

use super::{millimetres, sorted};

/// The paper's exponent.
const ORDER: f64 = 5.0;
/// Two displacements are the same up to this share of the larger.
const SAME: f64 = 0.02;
/// Half of a 95 % interval in standard errors.
const COVERAGE: f64 = 1.959_963_984_540_054;

/// What the paper concludes from its tests, on the analysis of a record; conclusions that the record cannot show say why.
///
/// The analysis has to include n = 5 among its exponents.
///
/// ```
/// use palpate::paper::{Published, Verdict, record_claims, reproduce, LaboratoryOptions};
/// use palpate::watch::Unwatched;
/// let few = LaboratoryOptions { seeds: 1, sample_rate: 10.0 };
/// let study = reproduce(&Published::default(), &few, &mut Unwatched)?;
/// // A simulated test (a) has n = 5 and one v.
/// let claims = record_claims(&study.test_a.analysis);
/// let of = |start: &str| claims.iter().find(|claim| claim.statement.starts_with(start)).unwrap().verdict();
/// assert_eq!(of("n = 5"), Verdict::Reproduced);
/// assert_eq!(of("v falls"), Verdict::NotReproduced);
/// assert_eq!(of("εₑ agrees"), Verdict::CannotBeChecked); // no hold after unloading
/// # Ok::<(), palpate::paper::PaperError>(())
/// ```
#[must_use]
pub fn record_claims(analysis: &Analysis) -> Vec<Claim> {
    sorted(vec![
        matching(analysis),
        types(analysis),
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
const FEW: &str = "Fewer than two displacements are held after loading and fitted with n = 5.";

fn types(analysis: &Analysis) -> Claim {
    let count = |which: After, kind: RelaxationType| {
        let holds = after(analysis, which);
        (holds.iter().filter(|hold| hold.relaxation.kind == kind).count(), holds.len())
    };
    let claim = Claim::new(Place::Figure("1(a)"), "Type I relaxation follows loading and Type II follows unloading.");
    let loading = count(After::Loading, RelaxationType::TypeI);
    let unloading = count(After::Unloading, RelaxationType::TypeII);
    let all = [
        ("holds after loading with a falling force", loading),
        ("holds after unloading with a rising force", unloading),
    ];
    let compared = all
        .into_iter()
        .filter(|(_, (_, of))| *of > 0)
        .map(|(name, (found, of))| Comparison::all(name, found, of));
    let claim = claim.compared(compared).shown_by(Evidence::Figure("figure_4"));
    if loading.1 + unloading.1 == 0 {
        return claim.remark("The record has no hold after a ramp.");
    }
    claim
}

fn order(analysis: &Analysis) -> Claim {
    let claim = Claim::new(Place::Equation("10"), "n = 5 is the lowest order that fits best.")
        .shown_by(Evidence::Table("orders"));
    match analysis.across.common_exponent {
        Some(found) => claim.compared([Comparison::new(
            "lowest listed n whose summed information criterion is within 2 of the lowest",
            "",
            (ORDER, Relation::Equal, found),
            (0.0, "an order is one of a list"),
        )]),
        None => claim.remark("No hold is fitted with every listed exponent."),
    }
}

fn stepwise(analysis: &Analysis) -> Claim {
    let claim = Claim::new(Place::Section("Abstract"), "The equilibrium strain increases step by step.")
        .shown_by(Evidence::Table("table_1"));
    let fits = by_displacement(fitted(analysis, After::Loading));
    if !has_strain(analysis) {
        return claim.remark(NO_STRAIN);
    }
    if fits.len() < 2 {
        return claim.remark(FEW);
    }
    let rising = fits.windows(2).filter(|pair| pair[1].1.equilibrium().value > pair[0].1.equilibrium().value).count();
    claim.compared([Comparison::all("steps to a larger displacement with a larger εₑ", rising, fits.len() - 1)])
}

fn falling(analysis: &Analysis) -> Claim {
    let claim = Claim::new(Place::Section("III-C"), "v falls from step to step of loading.")
        .shown_by(Evidence::Figure("rate_coefficients"));
    let fits = by_displacement(fitted(analysis, After::Loading));
    if fits.len() < 2 {
        return claim.remark(FEW);
    }
    let falling = fits
        .windows(2)
        .filter(|pair| pair[1].1.rate_coefficient().value < pair[0].1.rate_coefficient().value)
        .count();
    claim.compared([Comparison::all("steps to a larger displacement with a smaller v", falling, fits.len() - 1)])
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
            let error = COVERAGE * a.standard_error?.hypot(b.standard_error?);
            Some(Comparison::new(
                format!("εₑ at {} mm after unloading against after loading", millimetres(level)),
                "",
                ((-a.value, COVERAGE * a.standard_error?), Relation::Equal, (-b.value, COVERAGE * b.standard_error?)),
                (error, "95 % interval of the difference of two fits"),
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
    let mut drops: Vec<(f64, f64)> = after(analysis, After::Loading)
        .into_iter()
        .filter_map(|hold| Some((hold.displacement?, hold.force_start - hold.force_end)))
        .collect();
    drops.sort_by(|a, b| a.0.total_cmp(&b.0));
    drops.dedup_by(|later, earlier| same(later.0, earlier.0));
    if drops.len() < 2 {
        return claim.remark("Fewer than two displacements are held after loading.");
    }
    let larger = drops.windows(2).filter(|pair| pair[1].1 > pair[0].1).count();
    claim.compared([Comparison::all(
        "steps to a larger displacement with a larger fall of the force",
        larger,
        drops.len() - 1,
    )])
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
