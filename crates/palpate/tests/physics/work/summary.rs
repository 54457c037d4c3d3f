//! The summary of a simulation holds the numbers of its series.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use palpate::batch::{Run, summaries};
use palpate::contact::{Layers, RateDependence, Shape, Sides, Specimen};
use palpate::latency::LatencyLaw;
use palpate::simulate::{
    Contact, ContactModel, Drive, ForceHistory, LinearContact, LinearLaw, Memory, Motion, ProgramStep, ProtocolStep,
    Sampling, Separation, SimulateError, energy, energy_watched, protocol, simulate, simulate_watched, step_ends,
    strain_wave_within, summary, work_by_step_watched,
};
use palpate::watch::{Cancelled, Progress, Unwatched, Watch};

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

#[test]
fn summaries_of_many_runs_are_those_of_each() {
    let motion = Motion::new(vec![0.0, 0.4, 8.0, 8.2, 20.0, 21.0], vec![0.0, 0.012, 0.012, 0.0, 0.0, 0.004]).unwrap();
    let history = ForceHistory::new(vec![0.0, 1.0, 30.0], vec![0.0, 10.0, 10.0]).unwrap();
    let steps = [
        ProgramStep::Move { to: 0.012, rate: 0.012 },
        ProgramStep::HoldPosition { duration: 5.0 },
        ProgramStep::HoldForce { duration: 5.0 },
        ProgramStep::Move { to: 0.004, rate: 0.1 },
    ];
    let latency = model(BALL, Separation::Unilateral);
    let linear = LinearContact {
        specimen: latency.specimen.clone(),
        law: LinearLaw::standard(2.0, 3.0).unwrap(),
        memory: Memory::Strain,
        separation: Separation::Unilateral,
    };
    let contacts = [
        Contact::from(latency.clone()),
        Contact::Latency {
            model: latency,
            rate: RateDependence::Strain { factor: 0.5 },
        },
        Contact::from(linear),
    ];
    let (sampling, times) = (Sampling::Rate(100.0), [0.2, 0.4, 3.0, 9.0]);
    let drives = [Drive::from(&motion), Drive::from(&history), Drive::from(&steps)];
    let runs: Vec<Run<'_>> = contacts
        .iter()
        .flat_map(|contact| {
            drives.map(|drive| Run {
                drive,
                contact: contact.into(),
                sampling: &sampling,
                times: &times,
            })
        })
        .collect();
    let mut heard = Vec::new();
    let found = summaries(&runs, &mut |progress: Progress<'_>| {
        heard.push((progress.done, progress.total));
        Ok(())
    });
    for (run, found) in runs.iter().zip(found.unwrap()) {
        let found = found.unwrap();
        assert_eq!(found.summary, summary(run.drive, run.contact, &sampling).unwrap());
        let series = simulate(run.drive, run.contact, &Sampling::Times(times.to_vec())).unwrap();
        for (found, force) in found.forces.unwrap().iter().zip(&series.force) {
            // In a hold the stiffness is taken out of the sum.
            assert!((found - force).abs() <= 1e-14 * force.abs(), "{found} {force}");
        }
        if let Drive::Program(steps) = run.drive {
            assert_eq!(found.ends, step_ends(steps, run.contact).unwrap());
        }
    }
    assert_eq!((heard[0], *heard.last().unwrap()), ((0, Some(9)), (9, Some(9))));
    // A motion is a program of moves and holds.
    let motion = protocol(&[
        ProtocolStep {
            to: 0.012,
            rate: 0.012,
            hold: 5.0,
        },
        ProtocolStep {
            to: 0.004,
            rate: 0.1,
            hold: 0.0,
        },
    ])
    .unwrap();
    let steps = [steps[0], steps[1], steps[3]];
    for contact in &contacts {
        let run = Run {
            drive: (&motion).into(),
            contact: contact.into(),
            sampling: &sampling,
            times: &[],
        };
        let found = summaries(&[run], &mut Unwatched).unwrap().remove(0).unwrap();
        assert_eq!(found.ends, step_ends(&steps, contact).unwrap());
    }
    // What cannot be simulated says so in its place, times outside are no forces, and who watches may end it.
    let outside = Run {
        times: &[99.0],
        ..runs[0]
    };
    let deep = Motion::new(vec![0.0, 1.0], vec![0.0, 0.2]).unwrap();
    let refused = Run {
        drive: (&deep).into(),
        ..runs[0]
    };
    let found = summaries(&[outside, refused], &mut Unwatched).unwrap();
    assert!(found[0].as_ref().unwrap().forces.is_none());
    assert!(matches!(found[1], Err(SimulateError::Displacement { .. })));
    assert_eq!(summaries(&runs, &mut |_: Progress<'_>| Err(Cancelled)), Err(Cancelled));
}

/// A squeeze and a thousand turns: what a long protocol is like.
fn long() -> Motion {
    let knots = (0..=1000).map(f64::from);
    Motion::new(knots.clone().collect(), knots.map(|i| 4e-3 * (i % 3.0) / 2.0).collect()).unwrap()
}

#[test]
fn long_simulations_report_progress_and_end_when_they_are_reported_to() {
    let (motion, model) = (long(), model(BLOCK, Separation::Bonded));
    let sampling = Sampling::Rate(10.0);
    type Work<'a> = &'a dyn Fn(&mut dyn Watch) -> Result<(), SimulateError>;
    let works: [Work<'_>; 4] = [
        &|watch| simulate_watched(&motion, &model, &sampling, watch).map(drop),
        &|watch| energy_watched(&motion, &model, &sampling, watch).map(drop),
        &|watch| work_by_step_watched(&motion, &model, watch).map(drop),
        &|watch| strain_wave_within(&motion, &model, &sampling, 1e-6, watch).map(drop),
    ];
    for work in works {
        let mut heard = Vec::new();
        work(&mut |progress: Progress<'_>| {
            heard.push((progress.done, progress.total.unwrap()));
            Ok(())
        })
        .unwrap();
        assert!(heard.len() > 1000 && heard.windows(2).all(|pair| pair[0].0 <= pair[1].0));
        let (done, total) = *heard.last().unwrap();
        assert_eq!(done, total);
        let mut reports = 0;
        let ended = work(&mut |_: Progress<'_>| {
            reports += 1;
            if reports < 300 { Ok(()) } else { Err(Cancelled) }
        });
        assert_eq!((ended, reports), (Err(SimulateError::Cancelled(Cancelled)), 300));
    }
}
