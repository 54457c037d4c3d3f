//! The summary of a simulation holds the numbers of its series.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use palpate::contact::{Layers, Shape, Sides, Specimen};
use palpate::latency::LatencyLaw;
use palpate::simulate::{
    ContactModel, Drive, ForceHistory, Motion, ProgramStep, Sampling, Separation, SimulateError, energy, simulate,
    summary,
};

fn model(shape: Shape, separation: Separation) -> ContactModel {
    ContactModel {
        specimen: Specimen::new(shape, 1e5, Sides::Two).unwrap(),
        law: LatencyLaw::new(3.0, 200.0).unwrap(),
        layers: Layers::new(8.0).unwrap(),
        separation,
    }
}

const BALL: Shape = Shape::Ball { radius: 0.035 };
const BLOCK: Shape = Shape::Prism {
    area: 1e-3,
    length: 0.08,
};

fn agrees(drive: Drive<'_>, model: &ContactModel, sampling: &Sampling) {
    let found = summary(drive, model, sampling).unwrap();
    let (series, work) = (simulate(drive, model, sampling).unwrap(), energy(drive, model, sampling).unwrap());
    let last = series.len() - 1;
    assert_eq!(found.end_time, series.time[last]);
    assert_eq!(found.force, series.force[last]);
    assert_eq!(found.displacement, series.displacement[last]);
    assert_eq!((found.strain, found.excess_strain), (series.strain[last], series.excess_strain[last]));
    let most = series.force.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    // Chunks of samples go through other vector lanes than a whole series.
    assert!((found.peak_force / most - 1.0).abs() < 1e-12, "{} {most}", found.peak_force);
    let at = series.time.iter().position(|time| *time == found.peak_time).unwrap();
    assert!((series.force[at] / most - 1.0).abs() < 1e-12);
    assert_eq!(found.events, series.events);
    // Work is added up piece by piece, and samples cut the pieces.
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-8 * most * 0.01, "{a} is not {b}");
    close(found.work, work.work[last]);
    close(found.given_back, work.given_back[last]);
    assert_eq!(found.stored.is_some(), work.split.is_some());
    if let (Some(split), Some(stored), Some(lost)) = (&work.split, found.stored, found.lost) {
        close(stored, split.stored[last]);
        close(lost, split.lost[last]);
        assert!(lost > 0.0);
    }
}

#[test]
fn a_summary_is_what_the_series_comes_to() {
    let motion = Motion::new(vec![0.0, 0.4, 8.0, 8.2, 20.0], vec![0.0, 0.012, 0.012, 0.004, 0.004]).unwrap();
    let history = ForceHistory::new(vec![0.0, 1.0, 30.0, 31.0, 60.0], vec![0.0, 10.0, 10.0, 0.0, 0.0]).unwrap();
    let program = [
        ProgramStep::MoveToForce { force: 8.0, rate: 0.01 },
        ProgramStep::HoldPosition { duration: 5.0 },
        ProgramStep::Press { to: 12.0, rate: 4.0 },
        ProgramStep::HoldForce { duration: 5.0 },
        ProgramStep::Move { to: 0.001, rate: 0.01 },
    ];
    for shape in [BALL, BLOCK] {
        for separation in [Separation::Unilateral, Separation::Bonded] {
            let model = model(shape.clone(), separation);
            for drive in [Drive::Motion(&motion), Drive::Program(&program)] {
                agrees(drive, &model, &Sampling::Rate(500.0));
                agrees(drive, &model, &Sampling::Rate(3.0));
            }
        }
        agrees(Drive::Force(&history), &model(shape, Separation::Unilateral), &Sampling::Rate(100.0));
    }
}

#[test]
fn knots_count_where_times_leave_them_out() {
    let motion = Motion::new(vec![0.0, 1.0, 11.0], vec![0.0, 0.01, 0.01]).unwrap();
    let model = model(BLOCK, Separation::Bonded);
    let found = summary(&motion, &model, &Sampling::Times(vec![0.5, 5.0])).unwrap();
    let knots = simulate(&motion, &model, &Sampling::Times(vec![1.0, 11.0])).unwrap();
    assert_eq!((found.peak_time, found.peak_force), (1.0, knots.force[0]));
    assert_eq!((found.end_time, found.force), (11.0, knots.force[1]));
}

#[test]
fn a_summary_refuses_what_a_simulation_refuses() {
    let motion = Motion::new(vec![0.0, 1.0], vec![0.0, 0.2]).unwrap();
    let model = model(BALL, Separation::Unilateral);
    let refused = summary(&motion, &model, &Sampling::Rate(10.0));
    assert!(matches!(refused, Err(SimulateError::Displacement { .. })), "{refused:?}");
    let motion = Motion::new(vec![0.0, 1.0], vec![0.0, 0.01]).unwrap();
    let refused = summary(&motion, &model, &Sampling::Times(vec![2.0]));
    assert!(matches!(refused, Err(SimulateError::SampleTime { .. })), "{refused:?}");
}
