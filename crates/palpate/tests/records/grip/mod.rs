//! Grips: how long squeezes hold, the least of them, retreats, held forces, schedules; what is answered and what is refused.
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

mod answers;
mod holds;

use palpate::calibrate::{
    Body, CalibrationRange, Candidate, EquilibriumLaw, Material, MaterialParameter, MaterialParts, MaterialUncertainty,
    MaterialUnit,
};
use palpate::contact::{Shape, Sides};
use palpate::fit::Estimate;
use palpate::grip::{
    Band, Control, Grasp, Grip, GripError, Limits, Objective, Plan, PlanKind, PositionHold, Question, Regrip,
    TimeToSlip,
};
use palpate::simulate::{ProgramStep, Sampling, Separation, step_ends};
use palpate::watch::{Cancelled, Progress};

const SPEED: f64 = 0.5 / 60.0;

/// The paper's ball; its numbers with these relative errors, or without.
fn ball(errors: Option<[f64; 4]>) -> Material {
    let names = [
        ("modulus_pa", MaterialUnit::Pascal, 28e3),
        ("exponent", MaterialUnit::One, 5.0),
        ("rate_coefficient_per_s", MaterialUnit::PerSecond, 2e4),
        ("layer_thickness_m", MaterialUnit::Metre, 0.035 / 8.0),
    ];
    let number = |(index, (name, unit, value)): (usize, (&str, MaterialUnit, f64))| MaterialParameter {
        name: name.to_owned(),
        unit,
        estimate: Estimate {
            standard_error: errors.map(|errors| errors[index] * value),
            ..Estimate::fixed(value)
        },
    };
    let uncertainty = errors.map(|errors| MaterialUncertainty {
        confidence: 0.95,
        freedom: 1e6,
        systematic: Vec::new(),
        covariance: (0..4).map(|i| (0..4).map(|j| if i == j { errors[i].powi(2) } else { 0.0 }).collect()).collect(),
    });
    Material::new(MaterialParts {
        body: Body {
            shape: Shape::Ball { radius: 0.035 },
            sides: Sides::Two,
            separation: Separation::Unilateral,
            levels: vec![],
        },
        candidate: Candidate::new("latency".parse().unwrap(), EquilibriumLaw::UniformStrain),
        parameters: names.into_iter().enumerate().map(number).collect(),
        uncertainty,
        noise: 0.05,
        range: CalibrationRange {
            longest_hold: 20.0,
            longest_force_hold: 0.0,
            deepest: 0.015,
            fastest: SPEED,
            slowest: SPEED,
            largest_force: 14.3,
            farthest_retreat: 0.01,
            loadings: 1,
        },
    })
    .unwrap()
}

fn linear(terms: usize) -> Material {
    let mut parts = ball(None).into_parts();
    parts.candidate.law = format!("prony:{terms}").parse().unwrap();
    parts.parameters.truncate(1);
    for term in 1..=terms {
        for (name, unit, value) in [
            (format!("overshoot_{term}"), MaterialUnit::One, 0.8),
            (format!("time_constant_{term}_s"), MaterialUnit::Second, 0.5 * 10f64.powi(term as i32 - 1)),
        ] {
            parts.parameters.push(MaterialParameter {
                name,
                unit,
                estimate: Estimate::fixed(value),
            });
        }
    }
    Material::new(parts).unwrap()
}

fn grip(material: &Material, mass: f64) -> Grip<'_> {
    Grip::new(material, Grasp::new(mass, 0.6).unwrap(), Limits::new(SPEED).unwrap(), 0.95).unwrap()
}

fn seconds(lasts: TimeToSlip) -> f64 {
    lasts.seconds().unwrap()
}

/// A record of one hold: the exponent is 2.2, or 0.005 to 990, and every other parameter goes with it.
fn hardly_determined() -> Material {
    let mut parts = ball(Some([0.1; 4])).into_parts();
    for (parameter, value) in parts.parameters.iter_mut().zip([36_688.0, 2.2425, 8.076, 0.014_395]) {
        parameter.estimate.value = value;
    }
    let uncertainty = parts.uncertainty.as_mut().unwrap();
    uncertainty.freedom = 916.0;
    uncertainty.covariance = vec![
        vec![1.625_021, -3.813_909, -17.600_371, 1.560_975],
        vec![-3.813_909, 9.637_354, 45.921_755, -3.712_727],
        vec![-17.600_371, 45.921_755, 222.356_438, -17.225_632],
        vec![1.560_975, -3.712_727, -17.225_632, 1.562_223],
    ];
    Material::new(parts).unwrap()
}
