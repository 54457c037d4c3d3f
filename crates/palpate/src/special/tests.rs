//! Against 40-digit numbers, against each other, and what must hold everywhere.

use serde::Deserialize;

use super::exponential_integral::RULE;
use super::*;

#[derive(Deserialize)]
struct Reference {
    e1_rule: Vec<(f64, f64)>,
    cases: Vec<Case>,
}

#[derive(Deserialize)]
#[serde(tag = "of", rename_all = "snake_case")]
enum Case {
    MittagLeffler {
        alpha: f64,
        s: f64,
        value: f64,
        by_log_s: f64,
        by_alpha: f64,
    },
    E1 {
        x: f64,
        value: f64,
    },
    Fung {
        slow: f64,
        fast: f64,
        value: f64,
        by_log_slow: f64,
        by_log_fast: f64,
    },
    Diffusion {
        s: f64,
        value: f64,
        by_log_s: f64,
    },
}

fn reference() -> Reference {
    let text = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../validation/reference/special_functions.json"));
    serde_json::from_str(text).expect("a reference file")
}

/// Below this the functions may give 0.
const UNDERFLOW: f64 = 1e-300;

/// What is further from its reference than it may, relatively.
struct Score {
    tolerance: f64,
    beyond: Vec<String>,
    compared: usize,
}

impl Score {
    fn new(tolerance: f64) -> Self {
        Self {
            tolerance,
            beyond: Vec::new(),
            compared: 0,
        }
    }

    fn add(&mut self, at: impl std::fmt::Debug, found: f64, expected: f64) {
        let error = (found - expected).abs();
        self.compared += 1;
        if error.is_nan() || error > self.tolerance * expected.abs() + UNDERFLOW {
            self.beyond.push(format!("{at:?}: {found:e} for {expected:e}, {:.1e}", error / expected.abs()));
        }
    }

    fn finish(self, what: &str, least: usize) {
        assert!(self.beyond.is_empty(), "{what}\n{}", self.beyond.join("\n"));
        assert!(self.compared >= least, "{what}: {} values", self.compared);
    }
}

#[test]
fn mittag_leffler_matches_forty_digits() {
    let (mut phi, mut log, mut order) = (Score::new(1e-11), Score::new(1e-10), Score::new(1e-10));
    for case in reference().cases {
        if let Case::MittagLeffler {
            alpha,
            s,
            value,
            by_log_s,
            by_alpha,
        } = case
        {
            let found = mittag_leffler_decay(s, alpha);
            phi.add((alpha, s), found.value, value);
            log.add((alpha, s), found.by_log_rate, by_log_s);
            order.add((alpha, s), found.by_alpha, by_alpha);
        }
    }
    phi.finish("φ", 190);
    log.finish("∂φ/∂ln s", 190);
    order.finish("∂φ/∂α", 190);
}

#[test]
fn exponential_integral_matches_forty_digits() {
    let mut score = Score::new(1e-14);
    let reference = reference();
    assert_eq!(reference.e1_rule, RULE);
    for case in reference.cases {
        if let Case::E1 { x, value } = case {
            let (found, exponential) = exponential_integral(x);
            score.add(x, found, value);
            assert!((exponential - (-x).exp()).abs() <= 1e-15 * exponential);
        }
    }
    score.finish("E1", 25);
}

/// Fung's continuous spectrum at one time.
fn fung_continuous(time: f64, rate_slow: f64, rate_fast: f64) -> [f64; 3] {
    let [mut value, mut slow, mut fast] = [[0.0]; 3];
    fung_continuous_many(&[time], rate_slow, rate_fast, &mut value, &mut slow, &mut fast);
    [value[0], slow[0], fast[0]]
}

#[test]
fn fung_spectrum_matches_forty_digits() {
    let (mut phi, mut slow_end, mut fast_end) = (Score::new(1e-13), Score::new(1e-12), Score::new(1e-12));
    for case in reference().cases {
        if let Case::Fung {
            slow,
            fast,
            value,
            by_log_slow,
            by_log_fast,
        } = case
        {
            let found = fung_continuous(1.0, slow, fast);
            phi.add((slow, fast), found[0], value);
            slow_end.add((slow, fast), found[1], by_log_slow);
            fast_end.add((slow, fast), found[2], by_log_fast);
        }
    }
    phi.finish("φ", 20);
    slow_end.finish("∂φ/∂ln λ_slow", 20);
    fast_end.finish("∂φ/∂ln λ_fast", 20);
}

#[test]
fn diffusion_matches_forty_digits() {
    let (mut phi, mut log) = (Score::new(2e-15), Score::new(2e-15));
    for case in reference().cases {
        if let Case::Diffusion { s, value, by_log_s } = case {
            let found = diffusion_decay(s);
            phi.add(s, found.0, value);
            log.add(s, found.1, by_log_s);
        }
    }
    phi.finish("φ", 20);
    log.finish("∂φ/∂ln s", 20);
}

/// 0, then 400 times over 40 decades, then a few out of order.
fn times() -> Vec<f64> {
    let mut times = vec![0.0];
    times.extend((0..400).map(|i| 10f64.powf(f64::from(i) * 0.1 - 20.0)));
    times.extend([3.0, 0.2, 1e-3]);
    times
}

#[test]
fn many_at_once_equal_one_at_a_time() {
    let times = times();
    let rate = 0.37;
    let mut out = [vec![9.0; times.len()], vec![9.0; times.len()], vec![9.0; times.len()]];
    let mut alone = vec![9.0; times.len()];
    let [value, first, second] = &mut out;
    for alpha in [0.05, 0.4, 0.99, 0.993, 1.0] {
        mittag_leffler_decay_many(&times, rate, alpha, value, first, second);
        mittag_leffler_decay_value_many(&times, rate, alpha, &mut alone);
        for (i, t) in times.iter().enumerate() {
            let one = mittag_leffler_decay(rate * t, alpha);
            assert_eq!([value[i], first[i], second[i]], [one.value, one.by_log_rate, one.by_alpha]);
            assert_eq!(alone[i], one.value);
        }
    }
    for (slow, fast) in [(0.01, 5.0), (0.3, 0.31), (0.4, 0.4), (2.0, 0.1)] {
        fung_continuous_many(&times, slow, fast, value, first, second);
        for (i, t) in times.iter().enumerate() {
            assert_eq!([value[i], first[i], second[i]], fung_continuous(*t, slow, fast));
        }
    }
    diffusion_decay_many(&times, rate, value, first);
    for (i, t) in times.iter().enumerate() {
        assert_eq!((value[i], first[i]), diffusion_decay(rate * t));
    }
}

/// Every shape with its derivatives by the logarithms of its rates, for the tests below.
fn shapes(t: f64, factors: [f64; 2]) -> Vec<(f64, [f64; 2])> {
    let mut shapes = Vec::new();
    for alpha in [0.05, 0.3, 0.7, 0.95, 0.99, 0.9901, 0.9999, 1.0] {
        let one = mittag_leffler_decay(t * factors[0], alpha);
        shapes.push((one.value, [one.by_log_rate, 0.0]));
    }
    for (slow, fast) in [(1e-3, 10.0), (0.5, 0.7), (0.5, 0.85), (0.2, 0.2)] {
        let [value, by_log_slow, by_log_fast] = fung_continuous(t, slow * factors[0], fast * factors[1]);
        shapes.push((value, [by_log_slow, by_log_fast]));
    }
    let (value, by_log) = diffusion_decay(t * factors[0]);
    shapes.push((value, [by_log, 0.0]));
    shapes
}

#[test]
fn shapes_fall_from_one_to_zero() {
    for (value, by_log) in shapes(0.0, [1.0; 2]) {
        assert_eq!(value, 1.0);
        assert_eq!(by_log.map(f64::abs), [0.0; 2]);
    }
    let mut before = shapes(0.0, [1.0; 2]);
    for i in 0..3000 {
        let t = 10f64.powf(f64::from(i) * 0.012 - 16.0);
        let now = shapes(t, [1.0; 2]);
        for (j, (now, before)) in now.iter().zip(&before).enumerate() {
            // Near t = 0 a step changes less than the rounding.
            assert!((0.0..=1.0).contains(&now.0), "shape {j} at {t}: {}", now.0);
            assert!(now.0 <= before.0 * (1.0 + 1e-14), "shape {j} at {t}: {} after {}", now.0, before.0);
            assert!(now.1.iter().all(|slope| *slope <= 0.0), "shape {j} at {t}: {:?}", now.1);
        }
        before = now;
    }
}

#[test]
fn derivatives_are_those_of_the_value() {
    let step = 1e-5f64;
    for i in 0..240 {
        let t = 10f64.powf(f64::from(i) * 0.05 - 8.0);
        let at = shapes(t, [1.0; 2]);
        for direction in 0..2 {
            let mut factors = [[1.0; 2], [1.0; 2]];
            factors[0][direction] = (-step).exp();
            factors[1][direction] = step.exp();
            let [down, up] = factors.map(|factors| shapes(t, factors));
            for (j, ((down, up), at)) in down.iter().zip(&up).zip(&at).enumerate() {
                let difference = (up.0 - down.0) / (2.0 * step);
                let error = (difference - at.1[direction]).abs();
                assert!(error <= 2e-9, "shape {j} at {t}: {} for {difference}", at.1[direction]);
            }
        }
        for alpha in [0.06, 0.3, 0.7, 0.95, 0.99, 0.995, 0.9999] {
            let [down, up] = [-step, step].map(|step| mittag_leffler_decay(t, alpha + step).value);
            let (difference, found) = ((up - down) / (2.0 * step), mittag_leffler_decay(t, alpha).by_alpha);
            assert!((difference - found).abs() <= 2e-8, "α = {alpha}, s = {t}: {found} for {difference}");
        }
    }
}

#[test]
fn limits_are_reached() {
    for i in 0..200 {
        let t = 10f64.powf(f64::from(i) * 0.03 - 3.5);
        // α = 1 and equal rates are one exponential, to the last digits and with its derivative.
        let exponential = (-t).exp();
        let one = mittag_leffler_decay(t, 1.0);
        assert_eq!(one.value, exponential);
        assert!((one.by_log_rate + t * exponential).abs() <= 1e-15 * t * exponential);
        let [value, by_log_slow, by_log_fast] = fung_continuous(t, 1.0, 1.0);
        assert!((value - exponential).abs() <= 1e-15 * exponential);
        assert!((by_log_slow + by_log_fast + t * exponential).abs() <= 2e-15 * t * exponential);
    }
}

#[test]
fn numbers_in_the_documentation_hold() {
    assert!((mittag_leffler_decay(1.0, 0.5).value - 0.427_583_576_155_807).abs() < 1e-14);
    assert!((exponential_integral(1.0).0 - 0.219_383_934_395_520_27).abs() < 1e-16);
    assert!((fung_continuous(0.5, 1.0, 2.0)[0] - 0.491_078).abs() < 1e-6);
    assert!((diffusion_decay(1.0).0 - 0.298_203).abs() < 1e-6);
}
