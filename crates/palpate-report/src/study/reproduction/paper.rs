//! The paper's study: both tests simulated, re-identified, and checked against what the paper reports.

use palpate::analysis::{Analysis, AnalysisOptions, Geometry, HoldAnalysis, LayersChoice, analyze};
use palpate::record::Record;
use palpate::segment::{After, ContactChoice, RelaxationType};
use palpate::simulate::{
    ContactEventKind, ContactModel, Motion, Sampling, Separation, StrainWave, Trajectory, simulate, strain_wave,
};
use palpate::test_problems::{paper_ball, paper_test_a, paper_test_b};

use crate::document::CheckDocument;
use crate::number::significant;
use crate::study::bundle::StudyError;

/// Equilibrium strains of Table I as the authors measured them (compression negative in the paper).
pub(super) const MEASURED_EQUILIBRIUM: [f64; 5] = [0.1661, 0.2193, 0.2623, 0.3031, 0.3144];
/// Rate coefficients of Table I that are legible in the paper's text, 1/s.
pub(super) const MEASURED_COEFFICIENT: [Option<f64>; 5] = [None, Some(2.6e4), Some(2.0e4), None, None];
/// Start of the last unloading of test (a) in the paper's simulation, s.
const LAST_UNLOADING: f64 = 53.0;
/// Samples a second of the simulated records.
const SAMPLE_RATE: f64 = 100.0;

/// One test of the paper, simulated and analysed.
#[derive(Debug, Clone)]
pub struct ReproducedTest {
    /// Bonded contact, as in the paper.
    pub bonded: Trajectory,
    /// The jaw can leave the ball.
    pub unilateral: Trajectory,
    /// All layers (bonded).
    pub wave: StrainWave,
    /// The bonded record analysed as if it had been measured.
    pub analysis: Analysis,
}

/// The whole study.
#[derive(Debug, Clone)]
pub struct Reproduction {
    /// The model.
    pub model: ContactModel,
    /// Test (a): loading in five steps.
    pub test_a: ReproducedTest,
    /// Test (b): one loading, unloading in steps.
    pub test_b: ReproducedTest,
    /// What the paper reports in words, checked.
    pub checks: Vec<CheckDocument>,
}

impl Reproduction {
    /// Whether every check passes.
    #[must_use]
    pub fn all_passed(&self) -> bool {
        self.checks.iter().all(|check| check.passed)
    }

    /// Largest relative error of a re-identified rate coefficient.
    #[must_use]
    pub fn largest_coefficient_error(&self) -> f64 {
        let v = self.model.law.rate_coefficient();
        let holds = self.test_a.analysis.holds.iter().chain(&self.test_b.analysis.holds);
        let fits = holds.filter_map(|hold| hold.fit_with(self.model.law.exponent()));
        fits.map(|fit| (fit.rate_coefficient.value / v - 1.0).abs()).fold(0.0, f64::max)
    }
}

/// Simulates and re-identifies the paper's two tests.
///
/// # Errors
/// [`StudyError`]; none is expected.
pub fn reproduce() -> Result<Reproduction, StudyError> {
    let model = paper_ball(Separation::Bonded);
    let test_a = reproduce_test(&paper_test_a(), &model)?;
    let test_b = reproduce_test(&paper_test_b(), &model)?;
    let mut study = Reproduction {
        model,
        test_a,
        test_b,
        checks: Vec::new(),
    };
    study.checks = checks(&study);
    Ok(study)
}

fn reproduce_test(motion: &Motion, model: &ContactModel) -> Result<ReproducedTest, StudyError> {
    let sampling = Sampling::Rate(SAMPLE_RATE);
    let free = ContactModel {
        separation: Separation::Unilateral,
        ..model.clone()
    };
    let bonded = simulate(motion, model, &sampling)?;
    let record = Record::new(bonded.time.clone(), Some(bonded.displacement.clone()), bonded.force.clone())?;
    let options = AnalysisOptions {
        geometry: Some(Geometry {
            shape: model.specimen.shape().clone(),
            sides: model.specimen.sides(),
            modulus: Some(model.specimen.modulus()),
        }),
        touch: ContactChoice::AsRecorded,
        separation: Separation::Bonded,
        layers: Some(LayersChoice::Count(model.layers.count())),
        exponents: vec![1.0, 3.0, 5.0, 7.0],
        ..AnalysisOptions::default()
    };
    Ok(ReproducedTest {
        analysis: analyze(&record, &options)?,
        unilateral: simulate(motion, &free, &sampling)?,
        wave: strain_wave(motion, model, &Sampling::Rate(10.0))?,
        bonded,
    })
}

/// Holds with a contact: the last one, at first touch, has none.
pub(super) fn loaded(test: &ReproducedTest) -> impl Iterator<Item = &HoldAnalysis> {
    test.analysis.holds.iter().filter(|hold| hold.displacement.is_some_and(|d| d > 1e-4))
}

fn checks(study: &Reproduction) -> Vec<CheckDocument> {
    vec![
        types(study),
        amounts(study),
        agreement(study),
        lowest_order(study),
        identified(study),
        last_unloading(study),
    ]
}

fn check(name: &str, criterion: &str, found: String, passed: bool) -> CheckDocument {
    CheckDocument {
        name: name.to_owned(),
        criterion: criterion.to_owned(),
        found,
        passed,
    }
}

fn types(study: &Reproduction) -> CheckDocument {
    let holds: Vec<&HoldAnalysis> = loaded(&study.test_a).chain(loaded(&study.test_b)).collect();
    let count = |after, kind| {
        let of_kind = holds.iter().filter(|hold| hold.after == Some(after));
        (of_kind.clone().filter(|hold| hold.relaxation.kind == kind).count(), of_kind.count())
    };
    let (first, loadings) = count(After::Loading, RelaxationType::TypeI);
    let (second, unloadings) = count(After::Unloading, RelaxationType::TypeII);
    check(
        "Type I after every loading step, Type II after every unloading step",
        "all holds of tests (a) and (b) in contact",
        format!("{first} of {loadings} Type I after loading, {second} of {unloadings} Type II after unloading"),
        first == loadings && second == unloadings && loadings == 6 && unloadings == 4,
    )
}

fn amounts(study: &Reproduction) -> CheckDocument {
    let drops: Vec<f64> = loaded(&study.test_a).map(|hold| hold.force_start - hold.force_end).collect();
    let shown: Vec<String> = drops.iter().map(|drop| significant(*drop, 3)).collect();
    check(
        "The amount of relaxation grows with displacement",
        "drop of the force larger at every step of test (a)",
        format!("{} N", shown.join(", ")),
        drops.len() == 5 && drops.windows(2).all(|pair| pair[1] > pair[0]),
    )
}

fn agreement(study: &Reproduction) -> CheckDocument {
    let n = study.model.law.exponent();
    let mut largest: f64 = 0.0;
    let mut pairs = 0;
    for after_unloading in loaded(&study.test_b).filter(|hold| hold.after == Some(After::Unloading)) {
        for after_loading in loaded(&study.test_a) {
            let (Some(a), Some(b)) = (after_loading.displacement, after_unloading.displacement) else {
                continue;
            };
            let (Some(x), Some(y)) = (after_loading.fit_with(n), after_unloading.fit_with(n)) else {
                continue;
            };
            if (a - b).abs() < 1e-5 {
                pairs += 1;
                largest = largest.max((x.equilibrium.value - y.equilibrium.value).abs());
            }
        }
    }
    check(
        "Equilibrium strains agree between loading and unloading at one displacement",
        "difference below 0.001 at 5, 10, 15 and 20 mm",
        format!("largest difference {} over {pairs} displacements", significant(largest, 2)),
        pairs == 4 && largest < 1e-3,
    )
}

fn lowest_order(study: &Reproduction) -> CheckDocument {
    let found = [&study.test_a, &study.test_b].map(|test| test.analysis.across.common_exponent);
    let n = study.model.law.exponent();
    let shown = found.map(|n| n.map_or("none".to_owned(), |n| n.to_string()));
    check(
        "n = 5 is the lowest odd order that fits best",
        "chosen from 1, 3, 5, 7 in both tests",
        format!("(a) n = {}, (b) n = {}", shown[0], shown[1]),
        found == [Some(n), Some(n)],
    )
}

fn identified(study: &Reproduction) -> CheckDocument {
    let error = study.largest_coefficient_error();
    check(
        "The law is found again in the simulated records",
        "v within 0.1 % in every hold",
        format!("largest error {} %", significant(100.0 * error, 2)),
        error < 1e-3,
    )
}

fn last_unloading(study: &Reproduction) -> CheckDocument {
    let test = &study.test_a;
    let begins = last_at_top(&test.bonded);
    let lowest = test.bonded.force.iter().fold(0.0, |low: f64, force| low.min(*force));
    let lost = test.unilateral.events.iter().find(|event| event.kind == ContactEventKind::Lost);
    let never_pulls = test.unilateral.force.iter().all(|force| *force >= 0.0);
    check(
        "The last unloading of test (a) begins at t ≈ 53 s",
        "at 53 s; there the bonded contact goes into tension and the free jaw leaves the ball",
        format!(
            "begins at {} s; bonded force down to {} N; jaw leaves at {} s",
            significant(begins, 4),
            significant(lowest, 3),
            lost.map_or("no time".to_owned(), |event| significant(event.time, 4))
        ),
        (begins - LAST_UNLOADING).abs() < 0.05 && lowest < 0.0 && lost.is_some() && never_pulls,
    )
}

/// The last time at which the jaw is at its largest displacement.
fn last_at_top(trajectory: &Trajectory) -> f64 {
    let (mut top, mut time) = (f64::MIN, 0.0);
    for (t, d) in trajectory.time.iter().zip(&trajectory.displacement) {
        if *d >= top - 1e-9 {
            (top, time) = (*d, *t);
        }
    }
    time
}
