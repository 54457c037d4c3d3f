//! Work of the jaw: the exact split at constant section, closed cycles, no work where nothing moves.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use palpate::contact::{Curve, Equilibrium, Layers, Shape, Sides, Specimen};
use palpate::latency::LatencyLaw;
use palpate::simulate::{
    ContactModel, Energy, Motion, ProgramStep, Sampling, Separation, cycles, energy, simulate, work_by_step,
};

fn model(shape: Shape, exponent: f64, rate: f64, layers: f64, separation: Separation) -> ContactModel {
    ContactModel {
        specimen: Specimen::new(shape, 1e5, Sides::Two).unwrap(),
        law: LatencyLaw::new(exponent, rate).unwrap(),
        layers: Layers::new(layers).unwrap(),
        separation,
    }
}

const BLOCK: Shape = Shape::Prism {
    area: 1e-3,
    length: 0.08,
};

/// d/dt of what is lost, from samples of the excess strain: E A depth v |x|ⁿ⁺¹/(m − 1) for each of two contacts.
fn loss_by_the_law(model: &ContactModel, motion: &Motion, times: &[f64]) -> Vec<f64> {
    let result = simulate(motion, model, &Sampling::Times(times.to_vec())).unwrap();
    let (n, v) = (model.law.exponent(), model.law.rate_coefficient());
    let scale = 1e5 * 1e-3 * model.specimen.depth() / (model.layers.count() - 1.0);
    let rate: Vec<f64> = result.excess_strain.iter().map(|x| 2.0 * scale * v * x.abs().powf(n + 1.0)).collect();
    let mut lost = vec![0.0];
    for i in 1..times.len() {
        lost.push(lost[i - 1] + 0.5 * (rate[i] + rate[i - 1]) * (times[i] - times[i - 1]));
    }
    lost
}

#[test]
fn at_constant_section_work_is_stored_or_lost_by_the_law() {
    let times: Vec<f64> = (0..=20_000).map(|i| 1e-3 * f64::from(i)).collect();
    for (exponent, rate, layers) in [(1.0, 2.0, 8.0), (2.0, 50.0, 8.5), (5.0, 2e4, 64.0), (0.5, 0.5, 4.0)] {
        for separation in [Separation::Bonded, Separation::Unilateral] {
            let model = model(BLOCK, exponent, rate, layers, separation);
            let motion =
                Motion::new(vec![0.0, 2.0, 6.0, 7.0, 12.0, 20.0], vec![0.0, 0.02, 0.02, 0.0, 0.01, 0.004]).unwrap();
            let energy = energy(&motion, &model, &Sampling::Times(times.clone())).unwrap();
            let split = energy.split.unwrap();
            let by_law = loss_by_the_law(&model, &motion, &times);
            let most = *by_law.last().unwrap();
            for i in 0..times.len() {
                let off = (split.lost[i] - by_law[i]).abs();
                assert!(
                    off < 2e-5 * most,
                    "n = {exponent}, {separation:?}, t = {}: {} {}",
                    times[i],
                    split.lost[i],
                    by_law[i]
                );
                // Nothing is won back from heat.
                assert!(i == 0 || split.lost[i] >= split.lost[i - 1] - 1e-13 * most, "t = {}", times[i]);
                assert!(split.stored[i] >= 0.0);
            }
        }
    }
}

#[test]
fn a_closed_cycle_of_the_papers_ball_loses_what_is_not_given_back() {
    let ball = Shape::Ball { radius: 0.035 };
    let model = model(ball, 5.0, 2e4, 8.0, Separation::Unilateral);
    let motion = Motion::new(vec![0.0, 1.0, 2.0, 1e4], vec![0.0, 0.02, 0.0, 0.0]).unwrap();
    let samples = Sampling::Times(vec![0.0, 1.0, 2.0, 1e4]);
    let energy: Energy = energy(&motion, &model, &samples).unwrap();
    assert!(energy.split.is_none());
    assert_eq!(energy.work[2], energy.work[3]);
    let (done, back) = (energy.work[1], energy.given_back[2]);
    assert!(done > 0.0 && back > 0.0 && back < done);
    assert!((energy.work[3] - energy.work[0] - (done - back)).abs() < 1e-15);
    // By the trapezoidal rule from the series.
    let times: Vec<f64> = (0..=200_000).map(|i| 1e-5 * f64::from(i)).collect();
    let series = simulate(&motion, &model, &Sampling::Times(times)).unwrap();
    let area: f64 = (1..series.len())
        .map(|i| 0.5 * (series.force[i] + series.force[i - 1]) * (series.displacement[i] - series.displacement[i - 1]))
        .sum();
    assert!((area / energy.work[2] - 1.0).abs() < 1e-7, "{area} {}", energy.work[2]);
}

#[test]
fn under_a_force_work_is_force_times_way() {
    for shape in [BLOCK, Shape::Ball { radius: 0.04 }] {
        let model = model(shape.clone(), 3.0, 500.0, 8.0, Separation::Unilateral);
        let program = [
            ProgramStep::Press { to: 8.0, rate: 4.0 },
            ProgramStep::HoldForce { duration: 30.0 },
            ProgramStep::Press { to: 2.0, rate: 6.0 },
            ProgramStep::HoldForce { duration: 5.0 },
        ];
        let times: Vec<f64> = (0..=38_000).map(|i| 1e-3 * f64::from(i)).collect();
        let sampling = Sampling::Times(times.clone());
        let energy = energy(&program, &model, &sampling).unwrap();
        let series = simulate(&program, &model, &sampling).unwrap();
        let parts = series.force.windows(2).zip(series.displacement.windows(2));
        let mut by_samples = 0.0;
        for ((force, way), work) in parts.zip(&energy.work[1..]) {
            by_samples += 0.5 * (force[0] + force[1]) * (way[1] - way[0]);
            assert!((work - by_samples).abs() < 1e-5 * energy.work[2000], "{shape:?}: {work} {by_samples}");
        }
        // While the force is held the jaw follows: F Δd.
        let creep = 8.0 * (series.displacement[32_000] - series.displacement[2000]);
        assert!((energy.work[32_000] - energy.work[2000] - creep).abs() < 1e-12);
        if let Some(split) = energy.split {
            assert!((0..times.len()).all(|i| i == 0 || split.lost[i] >= split.lost[i - 1] - 1e-12));
        }
    }
}

#[test]
fn one_layer_loses_nothing() {
    let model = model(BLOCK, 5.0, 2e4, 1.0, Separation::Bonded);
    let motion = Motion::new(vec![0.0, 1.0, 3.0], vec![0.0, 0.02, -0.01]).unwrap();
    let energy = energy(&motion, &model, &Sampling::Times(vec![0.0, 0.5, 1.0, 2.0, 3.0])).unwrap();
    assert!(energy.split.unwrap().lost.iter().all(|lost| lost.abs() < 1e-16));
}

/// What is given back does not depend on when one looks.
#[test]
fn work_given_back_is_the_same_whatever_the_samples() {
    let model = model(BLOCK, 5.0, 2e4, 8.0, Separation::Bonded);
    let elastic = ContactModel {
        layers: Layers::new(1.0).unwrap(),
        ..model.clone()
    };
    let motion = Motion::new(vec![0.0, 1.0, 2.0, 3.0], vec![0.0, 0.02, -0.02, 0.0]).unwrap();
    for model in [model, elastic.clone()] {
        let few = energy(&motion, &model, &Sampling::Times(vec![3.0])).unwrap();
        let many = energy(&motion, &model, &Sampling::Rate(977.0)).unwrap();
        let last = many.time.len() - 1;
        assert!(
            (few.given_back[0] / many.given_back[last] - 1.0).abs() < 1e-9,
            "{:?} {}",
            few,
            many.given_back[last]
        );
        assert!(
            (few.work[0] - many.work[last]).abs()
                < 1e-9 * many.work.iter().fold(0.0, |most: f64, work| most.max(*work))
        );
    }
    // Of an elastic block all of it comes back, twice E A u²/(2 depth) for each of two contacts.
    let few = energy(&motion, &elastic, &Sampling::Times(vec![3.0])).unwrap();
    let expected = 2.0 * 2.0 * 0.5 * 1e5 * 1e-3 * 0.01 * 0.01 / 0.04;
    assert!((few.given_back[0] / expected - 1.0).abs() < 1e-12, "{} {expected}", few.given_back[0]);
}

#[test]
fn steps_and_cycles_share_out_the_work_of_the_jaw() {
    let program = [
        ProgramStep::MoveToForce { force: 8.0, rate: 0.01 },
        ProgramStep::HoldPosition { duration: 3.0 },
        ProgramStep::HoldForce { duration: 5.0 },
        ProgramStep::Move { to: 0.0, rate: 0.01 },
        ProgramStep::HoldPosition { duration: 2e4 },
        ProgramStep::Move { to: 0.012, rate: 0.01 },
        ProgramStep::Move { to: 0.0, rate: 0.01 },
        ProgramStep::Move { to: 0.006, rate: 0.01 },
    ];
    for (shape, separation) in [
        (BLOCK, Separation::Bonded),
        (BLOCK, Separation::Unilateral),
        (Shape::Ball { radius: 0.04 }, Separation::Unilateral),
    ] {
        let model = model(shape.clone(), 3.0, 500.0, 8.0, separation);
        let steps = work_by_step(&program, &model).unwrap();
        assert_eq!(steps.len(), program.len());
        let whole = energy(&program, &model, &Sampling::Times(vec![steps[7].until])).unwrap();
        let sum = |of: fn(&palpate::simulate::StepWork) -> f64| steps.iter().map(of).sum::<f64>();
        assert!((sum(|step| step.work) - whole.work[0]).abs() < 1e-14);
        assert!((sum(|step| step.given_back) - whole.given_back[0]).abs() < 1e-14);
        // A jaw that stands still does no work, one that goes on under a kept force does.
        assert_eq!(steps[1].work, 0.0);
        assert!(steps[2].work > 0.0 && steps[3].given_back > 0.0, "{steps:?}");
        for step in &steps {
            // The law only ever takes: to rounding of what was done.
            assert_eq!(step.lost.is_some(), shape == BLOCK);
            assert!(step.lost.is_none_or(|lost| lost >= -1e-14), "{step:?}");
        }
        let cycles = cycles(&steps);
        assert_eq!(cycles.len(), 3);
        assert_eq!(cycles[0].until, steps[4].until);
        // The body rests behind the first release only.
        assert!(cycles[0].is_closed && !cycles[1].is_closed && !cycles[2].is_closed, "{cycles:?}");
        for cycle in &cycles {
            let inside = steps.iter().filter(|step| cycle.from <= step.from && step.until <= cycle.until);
            // An open loop has no area: a "loss" of done less given back was below 0 where a body gave back what an earlier cycle left in it.
            let area = cycle.is_closed.then_some(cycle.done - cycle.given_back);
            let lost = inside.map(|step| step.lost).sum::<Option<f64>>().or(area);
            assert!(cycle.lost.is_none_or(|found| (found - lost.unwrap()).abs() < 1e-15 && found >= 0.0), "{cycle:?}");
            assert_eq!((cycle.lost.is_some(), cycle.share_lost.is_some()), (lost.is_some(), cycle.is_closed));
        }
        let share =
            |cycle: &palpate::simulate::Cycle| cycle.share_lost.is_some_and(|share| 0.05 < share && share < 1.0);
        assert!(share(&cycles[0]), "{cycles:?}");
    }
}

/// A dent that was still there, and a force with which a bonded block pulled, were in the loss of a cycle that counted as closed.
#[test]
fn a_cycle_is_closed_where_the_body_is_back_and_not_the_jaw_alone() {
    for shape in [BLOCK, Shape::Ball { radius: 0.04 }] {
        for separation in [Separation::Bonded, Separation::Unilateral] {
            let model = model(shape.clone(), 5.0, 2e4, 8.0, separation);
            // No rest behind the second squeeze.
            let motion = Motion::new(vec![0.0, 1.0, 2.0, 602.0, 603.0, 604.0], vec![0.0, 0.02, 0.0, 0.0, 0.02, 0.0]);
            let motion = motion.unwrap();
            let found = cycles(&work_by_step(&motion, &model).unwrap());
            let (rested, hasty) = (found[0], found[1]);
            assert!(rested.is_closed && !hasty.is_closed, "{separation:?}: {rested:?} {hasty:?}");
            let split = energy(&motion, &model, &Sampling::Times(vec![602.0, 604.0])).unwrap().split;
            assert_eq!([split.is_some(), hasty.lost.is_some()], [shape == BLOCK; 2]);
            assert!(hasty.share_lost.is_none() && rested.share_lost.is_some());
            if let Some(split) = split {
                let (lost, heat) = (hasty.lost.unwrap(), split.lost[1] - split.lost[0]);
                assert!((lost / heat - 1.0).abs() < 1e-12 && lost < hasty.done - hasty.given_back, "{lost} {heat}");
            }
        }
    }
}

/// Hertz's force begins like u^(3/2), and a table bends at its rows: work is integrated between such places, as exactly as elsewhere.
#[test]
fn work_on_bodies_that_stiffen_unevenly_is_as_exact() {
    let elastic = |specimen: Specimen| ContactModel {
        specimen,
        law: LatencyLaw::new(1.0, 1.0).unwrap(),
        layers: Layers::new(1.0).unwrap(),
        separation: Separation::Bonded,
    };
    let motion = Motion::new(vec![0.0, 1.0], vec![0.0, 0.002]).unwrap();
    let done = |model: &ContactModel| energy(&motion, model, &Sampling::Times(vec![1.0])).unwrap().work[0];
    let ball = Specimen::new(Shape::Ball { radius: 0.02 }, 1e5, Sides::One).unwrap();
    let hertz = elastic(ball.clone().with_equilibrium(Equilibrium::Hertz { poisson_ratio: 0.5 }).unwrap());
    let exact = 0.4 * 0.002 * hertz.specimen.force(0.1, 0.002);
    assert!((done(&hertz) / exact - 1.0).abs() < 1e-10, "{}", done(&hertz) / exact - 1.0);
    let rows = [(0.0, 0.0), (0.0004, 0.01), (0.0009, 0.05), (0.0016, 0.2), (0.004, 0.8)];
    let area: Vec<(f64, f64)> = rows.iter().map(|(u, force)| (*u, 1e-3 * force)).collect();
    let area = Curve::new(&area).unwrap();
    let profile = Specimen::new(Shape::Profile { depth: 0.02, area }, 1e5, Sides::One).unwrap();
    for body in [ball.with_equilibrium(Equilibrium::measured(&rows).unwrap()).unwrap(), profile] {
        let model = elastic(body);
        // Simpson's rule, from row to row.
        let (mut exact, force) = (0.0, |u: f64| model.specimen.force(u / 0.02, u));
        for pair in [0.0, 0.0004, 0.0009, 0.0016, 0.002].windows(2) {
            let width = (pair[1] - pair[0]) / 1000.0;
            for i in 0..1000 {
                let u = pair[0] + width * f64::from(i);
                exact += width / 6.0 * (force(u) + 4.0 * force(u + 0.5 * width) + force(u + width));
            }
        }
        assert!((done(&model) / exact - 1.0).abs() < 1e-10, "{}", done(&model) / exact - 1.0);
    }
}
