//! What a simulation costs, counted: a slow-down shows here without a clock.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use palpate::contact::Layers;
use palpate::latency::LatencyLaw;
use palpate::simulate::{
    ContactModel, ForceHistory, LinearContact, LinearLaw, LinearTerm, Memory, Sampling, Separation, SimulationWork,
    simulate, strain_wave, strain_wave_within,
};
use palpate::test_problems::{paper_ball, paper_test_a};
use palpate::watch::Unwatched;

/// At most as many steps and evaluations as once counted, and at least half of them: fewer would not be the same work.
fn is_near(work: SimulationWork, steps: u64, evaluations: u64) {
    // Rounding may cost a step more on another machine.
    assert!(work.steps <= steps + 2 + steps / 50, "{work:?}, expected {steps} steps");
    assert!(
        work.evaluations <= evaluations + 40 + evaluations / 50,
        "{work:?}, expected {evaluations} evaluations"
    );
    assert!(2 * work.steps > steps && 2 * work.evaluations > evaluations, "{work:?}");
}

fn end() -> Sampling {
    Sampling::Times(vec![66.0])
}

#[test]
fn the_papers_test_takes_one_ramp_and_a_little() {
    let work = simulate(&paper_test_a(), &paper_ball(Separation::Bonded), &end()).unwrap().work;
    assert_eq!((work.closed_forms, work.ramps, work.events), (6, 6, 0));
    is_near(work, 60, 1_034);
}

#[test]
fn a_fast_law_costs_no_more() {
    let model = ContactModel {
        law: LatencyLaw::new(5.0, 2e14).unwrap(),
        ..paper_ball(Separation::Bonded)
    };
    is_near(simulate(&paper_test_a(), &model, &end()).unwrap().work, 57, 989);
}

#[test]
fn all_layers() {
    let (motion, model) = (paper_test_a(), paper_ball(Separation::Bonded));
    is_near(strain_wave(&motion, &model, &end()).unwrap().work, 853, 11_330);
    is_near(strain_wave_within(&motion, &model, &end(), 1e-8, &mut Unwatched).unwrap().work, 297, 4_394);
    let thin = ContactModel {
        layers: Layers::new(512.0).unwrap(),
        ..model
    };
    is_near(strain_wave_within(&motion, &thin, &end(), 1e-8, &mut Unwatched).unwrap().work, 8_554, 105_021);
}

#[test]
fn a_held_force() {
    let history = ForceHistory::new(vec![0.0, 1.0, 61.0], vec![0.0, 10.0, 10.0]).unwrap();
    let work = simulate(&history, &paper_ball(Separation::Bonded), &Sampling::Times(vec![61.0])).unwrap().work;
    assert_eq!((work.closed_forms, work.ramps), (1, 1));
    // A ramp of force and a minute of creep.
    is_near(work, 130, 2_060);
}

#[test]
fn a_force_on_a_linear_law() {
    let terms = [(1.0, 0.01), (0.5, 0.3), (2.0, 6.0)].map(|(overshoot, rate)| LinearTerm { overshoot, rate });
    let contact = LinearContact {
        specimen: paper_ball(Separation::Bonded).specimen,
        law: LinearLaw::new(&terms).unwrap(),
        memory: Memory::Strain,
        separation: Separation::Bonded,
    };
    let history = ForceHistory::new(vec![0.0, 1.0, 61.0], vec![0.0, 10.0, 10.0]).unwrap();
    let work = simulate(&history, &contact, &Sampling::Times(vec![61.0])).unwrap().work;
    assert_eq!((work.closed_forms, work.ramps), (0, 2));
    is_near(work, 220, 897);
}
