//! The paper's study: both tests simulated, re-identified, and checked against what the paper reports.

use palpate::analysis::{AnalysisError, AnalysisOptions, Geometry, HoldAnalysis, LayersChoice, analyze_watched};
use palpate::number::significant;
use palpate::record::{Record, RecordError};
use palpate::segment::{After, ContactChoice, RelaxationType};
use palpate::simulate::{
    ContactEventKind, ContactModel, Motion, Sampling, Separation, Trajectory, WAVE_TOLERANCE, simulate_watched,
    strain_wave_within,
};
use palpate::test_problems::{paper_ball, paper_test_a, paper_test_b};
use palpate::watch::{Progress, Watch};
use palpate_report::document::ReproductionDocument;
use palpate_report::result::{Check, ReproducedTest, Reproduction};
use palpate_report::study::reproduction_text;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{ErrorKind, JobError, Outcome, Results};

/// Start of the last unloading of test (a) in the paper's simulation, s.
const LAST_UNLOADING: f64 = 53.0;
/// Samples a second of the simulated records.
const SAMPLE_RATE: f64 = 100.0;

/// Reproduce the paper's study: simulate its tests, identify the law again, check the results.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Reproduce {}

impl Reproduce {
    /// Simulates and re-identifies the paper's two tests.
    ///
    /// # Errors
    /// [`JobError`] where the watch ends it; no other is expected.
    pub fn run(self, watch: &mut dyn Watch) -> Result<Outcome<Reproduction>, JobError> {
        let model = paper_ball(Separation::Bonded);
        let mut result = Reproduction {
            test_a: reproduced(&paper_test_a(), &model, watch)?,
            test_b: reproduced(&paper_test_b(), &model, watch)?,
            model,
            checks: Vec::new(),
        };
        let all: [fn(&Reproduction) -> Check; 6] =
            [types, amounts, agreement, lowest_order, identified, last_unloading];
        result.checks = all.map(|check| check(&result)).into();
        let passed = result.all_passed();
        Ok(Outcome::of(result).answered(passed))
    }
}

impl Results for Reproduction {
    type Document = ReproductionDocument;

    fn document(&self) -> ReproductionDocument {
        ReproductionDocument::new(self)
    }

    fn text(&self) -> String {
        reproduction_text(self)
    }
}

fn reproduced(motion: &Motion, model: &ContactModel, watch: &mut dyn Watch) -> Result<ReproducedTest, JobError> {
    watch.report(Progress::open("simulating and re-identifying the paper's tests", 0))?;
    let sampling = Sampling::Rate(SAMPLE_RATE);
    let free = ContactModel {
        separation: Separation::Unilateral,
        ..model.clone()
    };
    let bonded = simulate_watched(motion, model, &sampling, watch).map_err(JobError::simulation)?;
    let record = Record::new(bonded.time.clone(), Some(bonded.displacement.clone()), bonded.force.clone());
    let record = record.map_err(|error: RecordError| JobError::new(ErrorKind::Record, error, None))?;
    let options = AnalysisOptions {
        geometry: Some(Geometry {
            shape: model.specimen.shape().clone(),
            sides: model.specimen.sides(),
            modulus: Some(model.specimen.modulus()),
            equilibrium: model.specimen.equilibrium().clone(),
        }),
        touch: ContactChoice::AsRecorded,
        separation: Separation::Bonded,
        layers: Some(LayersChoice::Count(model.layers.count())),
        exponents: vec![1.0, 3.0, 5.0, 7.0],
        ..AnalysisOptions::default()
    };
    Ok(ReproducedTest {
        analysis: analyze_watched(&record, &options, watch).map_err(|error| match error {
            AnalysisError::Cancelled(cancelled) => cancelled.into(),
            error => JobError::new(ErrorKind::Record, error, None),
        })?,
        unilateral: simulate_watched(motion, &free, &sampling, watch).map_err(JobError::simulation)?,
        wave: strain_wave_within(motion, model, &Sampling::Rate(10.0), WAVE_TOLERANCE, watch)
            .map_err(JobError::simulation)?,
        bonded,
    })
}

fn check(name: &str, criterion: &str, found: String, passed: bool) -> Check {
    Check {
        name: name.to_owned(),
        criterion: criterion.to_owned(),
        found,
        passed,
    }
}

fn types(study: &Reproduction) -> Check {
    let holds: Vec<&HoldAnalysis> = study.test_a.loaded().chain(study.test_b.loaded()).collect();
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

fn amounts(study: &Reproduction) -> Check {
    let drops: Vec<f64> = study.test_a.loaded().map(|hold| hold.force_start - hold.force_end).collect();
    let shown: Vec<String> = drops.iter().map(|drop| significant(*drop, 3)).collect();
    check(
        "The amount of relaxation increases with displacement",
        "larger force drop at each step of test (a)",
        format!("{} N", shown.join(", ")),
        drops.len() == 5 && drops.windows(2).all(|pair| pair[1] > pair[0]),
    )
}

fn agreement(study: &Reproduction) -> Check {
    let n = study.model.law.exponent();
    let mut largest: f64 = 0.0;
    let mut pairs = 0;
    for after_unloading in study.test_b.loaded().filter(|hold| hold.after == Some(After::Unloading)) {
        for after_loading in study.test_a.loaded() {
            let (Some(a), Some(b)) = (after_loading.displacement, after_unloading.displacement) else {
                continue;
            };
            let (Some(x), Some(y)) = (after_loading.fit_with(n), after_unloading.fit_with(n)) else {
                continue;
            };
            if (a - b).abs() < 1e-5 {
                pairs += 1;
                largest = largest.max((x.equilibrium().value - y.equilibrium().value).abs());
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

fn lowest_order(study: &Reproduction) -> Check {
    let found = [&study.test_a, &study.test_b].map(|test| test.analysis.across.common_exponent);
    let n = study.model.law.exponent();
    let shown = found.map(|n| n.map_or("none".to_owned(), |n| n.to_string()));
    check(
        "n = 5 is the lowest odd order with the best fit",
        "chosen from 1, 3, 5, 7 in both tests",
        format!("(a) n = {}, (b) n = {}", shown[0], shown[1]),
        found == [Some(n), Some(n)],
    )
}

fn identified(study: &Reproduction) -> Check {
    let error = study.largest_coefficient_error();
    check(
        "The fit recovers the law from the simulated records",
        "v within 0.1 % in every hold",
        format!("largest error {} %", significant(100.0 * error, 2)),
        error < 1e-3,
    )
}

fn last_unloading(study: &Reproduction) -> Check {
    let test = &study.test_a;
    let begins = last_at_top(&test.bonded);
    let lowest = test.bonded.force.iter().fold(0.0, |low: f64, force| low.min(*force));
    let lost = test.unilateral.events.iter().find(|event| event.kind == ContactEventKind::Lost);
    let never_pulls = test.unilateral.force.iter().all(|force| *force >= 0.0);
    check(
        "The last unloading of test (a) begins at t ≈ 53 s",
        "at 53 s; the bonded contact goes into tension and the free jaw leaves the ball",
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
