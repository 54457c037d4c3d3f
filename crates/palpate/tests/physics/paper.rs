//! The simulation of the paper (section IV) against numbers from other software.

use palpate::simulate::{Sampling, Separation, simulate, strain_wave};
use palpate::test_problems::{PAPER_TEST_A, PAPER_TEST_B, paper_ball, paper_test_a, paper_test_b};

#[test]
fn golden_values_of_both_tests() {
    let model = paper_ball(Separation::Bonded);
    for (motion, goldens) in [(paper_test_a(), PAPER_TEST_A), (paper_test_b(), PAPER_TEST_B)] {
        let times = goldens.iter().map(|golden| golden.time).collect();
        let result = simulate(&motion, &model, &Sampling::Times(times)).unwrap();
        for (i, golden) in goldens.iter().enumerate() {
            let (x, f) = (result.excess_strain[i], result.force[i]);
            assert!((x / golden.excess_strain - 1.0).abs() < 1e-9, "x at {} s: {x}", golden.time);
            assert!((f / golden.force - 1.0).abs() < 1e-9, "F at {} s: {f}", golden.time);
        }
    }
}

#[test]
fn first_layer_of_the_wave_is_the_contact_layer() {
    for separation in [Separation::Bonded, Separation::Unilateral] {
        let model = paper_ball(separation);
        let sampling = Sampling::Rate(10.0);
        let contact = simulate(&paper_test_b(), &model, &sampling).unwrap();
        let wave = strain_wave(&paper_test_b(), &model, &sampling).unwrap();
        assert_eq!(wave.time, contact.time);
        for (k, t) in wave.time.iter().enumerate() {
            assert!((wave.strain[0][k] - contact.strain[k]).abs() < 1e-9, "{separation:?} {t} s");
            assert!(
                (wave.displacement[0][k] - contact.contact_displacement[k]).abs() < 1e-11,
                "{separation:?} {t} s {} {}",
                wave.displacement[0][k],
                contact.contact_displacement[k]
            );
        }
    }
}

#[test]
fn work_counters_are_golden() {
    // A change of these numbers is a change of the method: say so in the changelog.
    let model = paper_ball(Separation::Unilateral);
    let result = simulate(&paper_test_b(), &model, &Sampling::Rate(100.0)).unwrap();
    assert_eq!((result.work.ramps, result.work.closed_forms, result.work.events), (6, 7, 3));
    assert!(result.work.steps < 250, "{:?}", result.work);
}
