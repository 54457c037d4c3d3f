//! What must hold for any numbers: the law, the simulation, the search for phases and the fits.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use palpate::contact::{Layers, Shape, Sides, Specimen};
use palpate::fit::{ExponentChoice, FitOptions, LatencyFit, Termination, fit_hold, fit_rates};
use palpate::latency::{LatencyLaw, decay, decay_columns};
use palpate::record::Record;
use palpate::segment::{
    ContactChoice, Phase, RelaxationType, SegmentOptions, Segmentation, classify_relaxation, find_contact_of,
    find_phases,
};
use palpate::simulate::{
    ContactModel, Motion, ProtocolStep, Sampling, Separation, Trajectory, protocol, simulate, simulate_force,
    strain_wave,
};
use palpate::strain::{RateWindow, contact_strain, strain_rates};
use palpate::test_problems::{Rng, paper_ball};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// The same cases every time; `PROPTEST_CASES` and another seed explore further.
fn cases(count: u32) -> ProptestConfig {
    ProptestConfig {
        cases: std::env::var("PROPTEST_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(count),
        rng_seed: RngSeed::Fixed(std::env::var("PROPTEST_SEED").ok().and_then(|text| text.parse().ok()).unwrap_or(1)),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

/// Numbers spread evenly over the decades from 10^low to 10^high.
fn decades(low: f64, high: f64) -> impl Strategy<Value = f64> + Clone {
    (low..high).prop_map(|power| 10f64.powf(power))
}

fn exponents() -> impl Strategy<Value = f64> + Clone {
    prop_oneof![
        0.05..12.0f64,
        proptest::sample::select(vec![0.5, 1.0, 2.0, 3.0, 5.0]),
        (-1e-6..1e-6f64).prop_map(|p| 1.0 + p),
    ]
}

/// φ, ∂φ/∂ln λ and ∂φ/∂n at λt = s.
fn with_gradient(s: f64, n: f64) -> [f64; 3] {
    let mut all = [[0.0]; 3];
    decay_columns(&[s], 1.0, n, all.each_mut().map(<[f64; 1]>::as_mut_slice));
    all.map(|[number]| number)
}

proptest! {
    #![proptest_config(cases(1000))]

    #[test]
    fn excess_falls_monotonously_and_keeps_its_sign(
        n in exponents(), v in decades(-3.0, 6.0), x in -1.0..1.0f64, t in decades(-6.0, 6.0), later in 1.0..50.0f64,
    ) {
        let law = LatencyLaw::new(n, v).unwrap();
        let (early, late) = (law.excess_after(x, t), law.excess_after(x, t * later));
        let rounding = 1e-12 * x.abs();
        prop_assert!(early.abs() <= x.abs() && late.abs() <= early.abs() + rounding, "{early} {late}");
        prop_assert!(early * x >= 0.0 && late * x >= 0.0);
        prop_assert!(law.rate(x) * x <= 0.0);
        prop_assert_eq!(law.excess_after(x, 0.0), x);
    }

    #[test]
    fn two_waits_are_one(
        n in exponents(), v in decades(-3.0, 6.0), x in -1.0..1.0f64, first in decades(-4.0, 3.0), second in decades(-4.0, 3.0),
    ) {
        let law = LatencyLaw::new(n, v).unwrap();
        let at_once = law.excess_after(x, first + second);
        let in_two = law.excess_after(law.excess_after(x, first), second);
        prop_assert!((at_once - in_two).abs() <= 1e-12 * x.abs(), "{at_once:e} {in_two:e}");
    }

    #[test]
    fn pull_mirrors_push(n in exponents(), v in decades(-3.0, 6.0), x in -1.0..1.0f64, t in decades(-6.0, 6.0)) {
        let law = LatencyLaw::new(n, v).unwrap();
        prop_assert_eq!(law.excess_after(-x, t), -law.excess_after(x, t));
        prop_assert_eq!(law.rate(-x), -law.rate(x));
        prop_assert_eq!(law.relative_rate(-x), law.relative_rate(x));
    }

    #[test]
    fn exponents_near_one_join_smoothly(p in decades(-17.0, -3.0), s in decades(-6.0, 1.5)) {
        let [one, one_by_rate, one_by_exponent] = with_gradient(s, 1.0);
        for n in [1.0 - p, 1.0 + p] {
            // φ(s; n) = φ(s; 1) + (n − 1) ∂φ/∂n + …, the next term is near (n − 1)² s⁴ φ.
            let [near, by_rate, by_exponent] = with_gradient(s, n);
            let step = (n - 1.0) * one_by_exponent;
            let bound = 1e-14 + 2.0 * (p * (1.0 + s * s)).powi(2);
            prop_assert!((near - one - step).abs() <= bound, "n = {n}: {near} {one}");
            prop_assert!((by_rate - one_by_rate).abs() <= 1e-13 + 4.0 * p * (1.0 + s * s));
            prop_assert!((by_exponent - one_by_exponent).abs() <= 1e-13 + 4.0 * p * (1.0 + s * s));
        }
    }

    #[test]
    fn no_exponent_and_no_time_gives_nan(n in decades(-6.0, 3.0), s in decades(-300.0, 308.0)) {
        prop_assert!((0.0..=1.0).contains(&decay(s, n)));
        let times = [s; 9];
        let [mut value, mut by_rate, mut by_exponent] = [[0.0; 9]; 3];
        decay_columns(&times, 1.0, n, [&mut value, &mut by_rate, &mut by_exponent]);
        prop_assert!(value.iter().all(|v| (0.0..=1.0).contains(v)), "{value:?}");
        prop_assert!(by_rate.iter().chain(&by_exponent).all(|v| v.is_finite()), "{by_rate:?} {by_exponent:?}");
    }
}

/// A contact, and a motion that strains it by 6 to 15 % beyond equilibrium.
#[derive(Debug, Clone)]
struct Scene {
    model: ContactModel,
    steps: Vec<ProtocolStep>,
}

impl Scene {
    fn motion(&self) -> Motion {
        protocol(&self.steps).unwrap()
    }

    fn samples(&self, count: u32) -> Vec<f64> {
        let motion = self.motion();
        let step = (motion.end() - motion.start()) / f64::from(count);
        let mut times: Vec<f64> = (0..count).map(|i| motion.start() + step * f64::from(i)).collect();
        times.extend(motion.times());
        times.sort_by(f64::total_cmp);
        times
    }

    fn run(&self, separation: Separation) -> Trajectory {
        let model = ContactModel {
            separation,
            ..self.model.clone()
        };
        simulate(&self.motion(), &model, &Sampling::Times(self.samples(400))).unwrap()
    }
}

fn models() -> impl Strategy<Value = ContactModel> + Clone {
    let shape = prop_oneof![
        decades(-3.0, -0.5).prop_map(|radius| Shape::Ball { radius }),
        (decades(-6.0, -2.0), decades(-3.0, -0.5)).prop_map(|(area, length)| Shape::Prism { area, length }),
    ];
    let sides = proptest::sample::select(vec![Sides::One, Sides::Two]);
    let layers = prop_oneof![1.5..100.0f64, proptest::sample::select(vec![2.0, 8.0, 64.0])];
    (shape, sides, layers, decades(3.0, 7.0), exponents(), decades(-2.0, 5.0)).prop_map(
        |(shape, sides, m, modulus, n, v)| ContactModel {
            specimen: Specimen::new(shape, modulus, sides).unwrap(),
            law: LatencyLaw::new(n, v).unwrap(),
            layers: Layers::new(m).unwrap(),
            separation: Separation::Bonded,
        },
    )
}

/// Levels as shares of the depth, the steady excess strain that sets the speed, holds in units of the relaxation time.
fn scenes() -> impl Strategy<Value = Scene> {
    let step = (0.0..0.5f64, 0.06..0.15f64, 0.1..30.0f64);
    (models(), proptest::collection::vec(step, 1..6)).prop_map(|(model, steps)| {
        let per_contact = 1.0 / model.specimen.contact_displacement(1.0);
        let depth = model.specimen.depth();
        let step = |(share, excess, waits): (f64, f64, f64)| ProtocolStep {
            to: share * depth * per_contact,
            rate: -model.law.rate(excess) * depth / (model.layers.count() - 1.0) * per_contact,
            hold: waits / model.law.relative_rate(excess),
        };
        let steps = steps.into_iter().map(step).collect();
        Scene { model, steps }
    })
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most: f64, value| most.max(value.abs()))
}

proptest! {
    #![proptest_config(cases(200))]

    #[test]
    fn a_simulation_starts_from_nothing_and_agrees_with_itself(scene in scenes()) {
        for separation in [Separation::Bonded, Separation::Unilateral] {
            let result = scene.run(separation);
            prop_assert_eq!((result.force[0], result.strain[0], result.excess_strain[0]), (0.0, 0.0, 0.0));
            let specimen = &scene.model.specimen;
            let force = largest(&result.force);
            for k in 0..result.len() {
                let u = result.contact_displacement[k];
                prop_assert!((result.force[k] - specimen.force(result.strain[k], u)).abs() <= 1e-14 * force);
                let parts = result.equilibrium_strain[k] + result.excess_strain[k];
                prop_assert!((result.strain[k] - parts).abs() <= 1e-15);
                let off_the_body = specimen.contact_displacement(result.displacement[k]) < u * (1.0 - 1e-9);
                if let (false, Some(strain)) = (off_the_body, contact_strain(result.force[k], result.displacement[k], specimen)) {
                    prop_assert!((strain - result.strain[k]).abs() <= 1e-12, "{strain} {}", result.strain[k]);
                }
            }
            let model = ContactModel { separation, ..scene.model.clone() };
            let alone = simulate_force(&scene.motion(), &model, &result.time).unwrap();
            for (a, b) in alone.iter().zip(&result.force) {
                prop_assert!((a - b).abs() <= 1e-14 * force);
            }
        }
    }

    #[test]
    fn a_jaw_that_cannot_pull_never_does(scene in scenes()) {
        let result = scene.run(Separation::Unilateral);
        let force = largest(&result.force);
        for k in 0..result.len() {
            prop_assert!(result.force[k] >= -1e-11 * force, "{} N at {} s", result.force[k], result.time[k]);
            let share = scene.model.specimen.contact_displacement(result.displacement[k]);
            let depth = scene.model.specimen.depth();
            prop_assert!(result.contact_displacement[k] >= share - 1e-11 * depth, "the jaw is inside the body");
        }
        // As long as it never has to let go, a bond makes no difference.
        let bonded = scene.run(Separation::Bonded);
        if result.events.is_empty() {
            prop_assert_eq!(&result.force, &bonded.force);
        }
        // Times and kinds of events alternate.
        for pair in result.events.windows(2) {
            prop_assert!(pair[0].time <= pair[1].time && pair[0].kind != pair[1].kind);
        }
    }

    #[test]
    fn bonded_holds_relax_down_after_loading_and_up_after_unloading(
        model in models(), excess in 0.02..0.1f64, back in 0.3..0.6f64, waits in 1.0..30.0f64,
    ) {
        // Ramps long enough for the excess strain to reach its steady value, whatever it was before.
        let (depth, per_contact) = (model.specimen.depth(), 1.0 / model.specimen.contact_displacement(1.0));
        let gain = model.layers.count() - 1.0;
        prop_assume!(gain * 0.8 * (1.0 - back) > 6.0 * excess);
        let rate = -model.law.rate(excess) * depth / gain * per_contact;
        let hold = waits / model.law.relative_rate(excess);
        let level = |share: f64| ProtocolStep { to: share * depth * per_contact, rate, hold };
        let scene = Scene { model, steps: vec![level(0.8), level(0.8 * back)] };
        let result = scene.run(Separation::Bonded);
        let motion = scene.motion();
        for (from, kind) in [(1, RelaxationType::TypeI), (3, RelaxationType::TypeII)] {
            let (start, end) = (motion.times()[from], motion.times()[from + 1]);
            let inside = |k: &usize| result.time[*k] >= start && result.time[*k] <= end;
            let hold: Vec<f64> = (0..result.len()).filter(inside).map(|k| result.force[k]).collect();
            let fall = if kind == RelaxationType::TypeI { 1.0 } else { -1.0 };
            let rounding = 1e-12 * largest(&hold);
            prop_assert!(hold.windows(2).all(|pair| fall * (pair[0] - pair[1]) >= -rounding), "{hold:?}");
            // Enough samples that noise, which is judged by second differences, is given from the steep first fall.
            let fine: Vec<f64> = (0..=2000).map(|i| start + (end - start) * f64::from(i) / 2000.0).map(|t| t.min(end)).collect();
            let force = simulate_force(&motion, &scene.model, &fine).unwrap();
            prop_assert_eq!(classify_relaxation(&force).kind, kind);
        }
    }

    #[test]
    fn one_layer_is_elastic(scene in scenes()) {
        let model = ContactModel { layers: Layers::new(1.0).unwrap(), ..scene.model.clone() };
        let result = Scene { model: model.clone(), ..scene }.run(Separation::Unilateral);
        prop_assert!(result.events.is_empty());
        for k in 0..result.len() {
            prop_assert_eq!(result.excess_strain[k], 0.0);
            let u = result.contact_displacement[k];
            let elastic = model.specimen.modulus() * (u / model.specimen.depth()) * model.specimen.contact_area(u);
            prop_assert!((result.force[k] - elastic).abs() <= 1e-15 * elastic.abs());
        }
    }

    /// The drive is g = u̇ (m − 1)/depth and ẋ = g − v|x|ⁿ sgn x: with m − 1 and v c^(1 − n) both c times x follows c times
    /// the drive, and a motion c times as fast under c times v goes through the same states.
    #[test]
    fn layers_and_time_scale_as_the_equation_says(scene in scenes(), c in 0.3..3.0f64) {
        let reference = scene.run(Separation::Bonded);
        let (n, v, m) = (scene.model.law.exponent(), scene.model.law.rate_coefficient(), scene.model.layers.count());
        let stiffer = ContactModel {
            law: LatencyLaw::new(n, v * c.powf(1.0 - n)).unwrap(),
            layers: Layers::new(1.0 + c * (m - 1.0)).unwrap(),
            ..scene.model.clone()
        };
        let scaled = simulate(&scene.motion(), &stiffer, &Sampling::Times(reference.time.clone())).unwrap();
        let scale = largest(&reference.excess_strain);
        for k in 0..reference.len() {
            let (a, b) = (reference.excess_strain[k], scaled.excess_strain[k] / c);
            prop_assert!((a - b).abs() <= 1e-9 * scale, "{a} {b} at {} s", reference.time[k]);
        }
        let faster = ContactModel { law: LatencyLaw::new(n, v * c).unwrap(), ..scene.model.clone() };
        let times = scene.motion().times().iter().map(|t| t / c).collect();
        let motion = Motion::new(times, scene.motion().displacements().to_vec()).unwrap();
        let last = motion.end();
        let sooner: Vec<f64> = reference.time.iter().map(|t| (t / c).min(last)).collect();
        let scaled = simulate(&motion, &faster, &Sampling::Times(sooner)).unwrap();
        for k in 0..reference.len() {
            let (a, b) = (reference.excess_strain[k], scaled.excess_strain[k]);
            prop_assert!((a - b).abs() <= 1e-9 * scale, "{a} {b} at {} s", reference.time[k]);
        }
    }

    /// For n < 1 see [`a_strain_wave_that_comes_to_rest_is_no_endless_work`].
    #[test]
    fn a_strain_wave_is_finite_and_begins_with_the_contact_layer(
        scene in scenes().prop_filter("n ≥ 1", |scene| scene.model.law.exponent() >= 1.0), layers in 2..40u32,
    ) {
        let scene = Scene { model: ContactModel { layers: Layers::new(f64::from(layers)).unwrap(), ..scene.model.clone() }, ..scene };
        let sampling = Sampling::Times(scene.samples(50));
        for separation in [Separation::Bonded, Separation::Unilateral] {
            let model = ContactModel { separation, ..scene.model.clone() };
            let contact = simulate(&scene.motion(), &model, &sampling).unwrap();
            let wave = strain_wave(&scene.motion(), &model, &sampling).unwrap();
            let numbers = || wave.strain.iter().chain(&wave.displacement).flatten();
            prop_assert!(numbers().all(|value| value.is_finite()), "{:?}", model);
            for k in 0..wave.time.len() {
                let apart = (wave.strain[0][k] - contact.strain[k]).abs();
                prop_assert!(apart <= 1e-7, "{separation:?}: {apart:e} at {} s", wave.time[k]);
            }
        }
    }
}

/// A law with n < 1 comes to rest in finite time, where its rate has no derivative; steps must not shrink to nothing there.
#[test]
fn a_strain_wave_that_comes_to_rest_is_no_endless_work() {
    for (n, layers) in [(0.7, 3.0), (0.6, 4.0)] {
        let model = ContactModel {
            specimen: Specimen::new(Shape::Ball { radius: 0.035 }, 28e3, Sides::Two).unwrap(),
            law: LatencyLaw::new(n, 0.5).unwrap(),
            layers: Layers::new(layers).unwrap(),
            separation: Separation::Bonded,
        };
        let step = |to: f64| ProtocolStep {
            to,
            rate: 0.002,
            hold: 10.0,
        };
        let motion = protocol(&[step(0.010), step(0.005)]).unwrap();
        let wave = strain_wave(&motion, &model, &Sampling::Rate(1.0)).unwrap();
        assert!(wave.work.steps < 50_000, "n = {n}, {layers} layers: {} steps for 25 s", wave.work.steps);
    }
}

/// Whether segments follow each other from the first sample to the last, each with a sample to fit from inside it.
fn covers(segmentation: &Segmentation, samples: usize) -> bool {
    let segments = &segmentation.segments;
    segments.first().is_some_and(|segment| segment.start == 0)
        && segments.last().is_some_and(|segment| segment.end == samples)
        && segments.windows(2).all(|pair| pair[0].end == pair[1].start)
        && segments.iter().all(|segment| segment.start < segment.end)
        && segments.iter().all(|segment| segment.fit_start < segment.end)
}

proptest! {
    #![proptest_config(cases(200))]

    /// Steps of at least a tenth of the depth, holds of a third of a ramp or more: what a test bench does.
    #[test]
    fn phases_cover_the_record_and_find_every_hold(
        levels in proptest::collection::vec((0.1..0.3f64, any::<bool>(), 0.5..8.0f64), 1..7),
        noise in decades(-7.0, -3.0), seed in any::<u64>(), rate in 20.0..200.0f64, with_displacement in any::<bool>(),
    ) {
        let mut at = 0.0;
        let mut steps = Vec::new();
        for (change, up, hold) in levels {
            at = if (up || at < change) && at + change < 0.9 { at + change } else { at - change };
            // One side, 35 mm deep; a tenth of the depth takes a second.
            steps.push(ProtocolStep { to: 0.035 * at, rate: 0.0035, hold });
        }
        let model = ContactModel {
            specimen: Specimen::new(Shape::Ball { radius: 0.035 }, 28e3, Sides::One).unwrap(),
            law: LatencyLaw::new(5.0, 2e4).unwrap(),
            layers: Layers::new(8.0).unwrap(),
            separation: Separation::Unilateral,
        };
        let motion = protocol(&steps).unwrap();
        let result = simulate(&motion, &model, &Sampling::Rate(rate)).unwrap();
        let mut random = Rng::new(seed);
        let (range, force) = (largest(&result.displacement), largest(&result.force));
        let displacement = result.displacement.iter().map(|d| d + noise * range * random.normal()).collect();
        let measured: Vec<f64> = result.force.iter().map(|f| f + noise * force * random.normal()).collect();
        let record = Record::new(result.time.clone(), with_displacement.then_some(displacement), measured).unwrap();
        match find_phases(&record, &SegmentOptions::default()) {
            Ok(found) => {
                prop_assert!(covers(&found, record.len()), "{:?}", found.segments);
                if with_displacement {
                    prop_assert_eq!(found.holds().count(), steps.len(), "{:?}", found);
                    for (hold, knot) in found.holds().zip(motion.times()[1..].chunks(2)) {
                        let (start, end) = (record.time()[hold.start], record.time()[hold.end - 1]);
                        prop_assert!((start - knot[0]).abs() < 0.15 && (end - knot[1]).abs() < 0.15, "{start} {end} {knot:?}");
                    }
                }
            }
            Err(error) => prop_assert!(!with_displacement, "{error}"),
        }
    }
}

/// Any finite number, and every one that is not.
fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => -1.0..1.0f64,
        2 => proptest::sample::select(vec![0.0, 1.0, -1.0, 1e-300, 1e300, -1e300, f64::MIN_POSITIVE, f64::MAX, f64::MIN]),
        1 => proptest::num::f64::ANY,
    ]
}

/// Columns of a record: from tame to absurd, of equal or different length.
fn columns() -> impl Strategy<Value = (Vec<f64>, Vec<f64>, Vec<f64>)> {
    let steps = prop_oneof![decades(-3.0, 1.0).boxed(), decades(-300.0, 300.0).boxed(), any_number().boxed()];
    let steps = (0..60usize).prop_flat_map(move |count| proptest::collection::vec(steps.clone(), count));
    let times = (steps, any::<bool>()).prop_map(|(steps, rising)| {
        let mut at = 0.0;
        let sum = |step: f64| {
            at += step;
            at
        };
        if rising { steps.into_iter().map(sum).collect() } else { steps }
    });
    let tame = || (0..8i32).prop_map(f64::from);
    let column = || prop_oneof![proptest::collection::vec(tame(), 60), proptest::collection::vec(any_number(), 60)];
    (times, column(), column(), 0..20u32).prop_map(|(times, mut a, mut b, odd)| {
        a.truncate(times.len());
        b.truncate(times.len() + usize::from(odd == 0));
        (times, a, b)
    })
}

/// No number of a converged fit may be NaN.
fn is_valid(fit: &LatencyFit) -> bool {
    let estimates = [fit.exponent(), fit.equilibrium(), fit.amplitude(), fit.relative_rate(), fit.rate_coefficient()];
    let sound = |number: f64| !number.is_nan();
    let whole = estimates.iter().all(|estimate| {
        let (low, high) = estimate.interval.unwrap_or((0.0, 0.0));
        sound(estimate.value) && sound(estimate.white_standard_error.unwrap_or(0.0)) && sound(low) && sound(high)
    });
    let numbers = fit.white_covariance.iter().flatten().flatten().copied();
    whole && numbers.chain([fit.residual_square, fit.rmse, fit.residual_correlation]).all(sound)
}

fn choices() -> impl Strategy<Value = ExponentChoice> {
    prop_oneof![
        Just(ExponentChoice::Free),
        exponents().prop_map(ExponentChoice::Fixed),
        any_number().prop_map(ExponentChoice::Fixed),
    ]
}

proptest! {
    #![proptest_config(cases(1500))]

    #[test]
    fn no_columns_make_a_fit_panic((times, values, _) in columns(), choice in choices()) {
        if let Ok(fit) = fit_hold(&times, &values, choice, &FitOptions::default()) {
            prop_assert!(fit.termination != Termination::Converged || is_valid(&fit), "{fit:?}");
        }
    }

    #[test]
    fn no_columns_make_a_fit_of_rates_panic((_, strains, rates) in columns(), choice in choices()) {
        if let Ok(fit) = fit_rates(&strains, &rates, choice, &FitOptions::default()) {
            prop_assert!(fit.termination != Termination::Converged || is_valid(&fit), "{fit:?}");
        }
        let _ = strain_rates(&strains, &rates, &RateWindow::default());
    }

    #[test]
    fn no_columns_make_the_search_for_phases_panic((times, displacement, force) in columns(), with_displacement in any::<bool>()) {
        if let Ok(record) = Record::new(times, with_displacement.then_some(displacement), force) {
            let record = record.repaired();
            if let Ok(found) = find_phases(&record, &SegmentOptions::default()) {
                prop_assert!(covers(&found, record.len()), "{:?}", found.segments);
                let ball = paper_ball(Separation::Unilateral).specimen;
                let _ = find_contact_of(&record, &found, Some(&ball), ContactChoice::Auto);
                for hold in found.holds().filter(|hold| hold.phase == Phase::Hold) {
                    let _ = classify_relaxation(&record.force()[hold.start..hold.end]);
                }
            }
        }
    }

    /// A hold is short of a few samples, or repeats itself: nothing odd follows.
    #[test]
    fn ordinary_holds_end_honestly(
        n in 0.3..10.0f64, scaled_rate in decades(-3.0, 4.0), noise in decades(-6.0, 0.0), samples in 6..80usize,
        seed in any::<u64>(), free in any::<bool>(), digits in 1..6i32,
    ) {
        let mut random = Rng::new(seed);
        let times: Vec<f64> = (0..samples).map(|i| i as f64 / (samples - 1) as f64).collect();
        let grid = 10f64.powi(digits);
        let value = |t: &f64| ((1.0 + decay(scaled_rate * t, n) + noise * random.normal()) * grid).round() / grid;
        let values: Vec<f64> = times.iter().map(value).collect();
        let choice = if free { ExponentChoice::Free } else { ExponentChoice::Fixed(n) };
        if let Ok(fit) = fit_hold(&times, &values, choice, &FitOptions::default()) {
            prop_assert!(is_valid(&fit) || !fit.termination.is_good(), "{fit:?}");
            let errors = [fit.equilibrium(), fit.amplitude(), fit.relative_rate()].map(|estimate| estimate.white_standard_error);
            if !fit.termination.is_good() {
                prop_assert_eq!(errors, [None; 3], "errors on numbers that are not determined");
            }
        }
    }
}

/// Spans and first steps at the ends of the range of doubles.
#[test]
fn times_of_any_scale_do_not_panic() {
    for (first, rest) in [(1e-200, 1e200), (5e-324, 1.0), (1e-305, 1.0), (1.0, 2e307), (1e-300, 5e-300)] {
        let times: Vec<f64> = (0..9).map(|i| if i < 2 { first * f64::from(i) } else { rest * f64::from(i) }).collect();
        for unit in [1.0, 1e-300, 1e300, f64::MAX] {
            let values: Vec<f64> = (0..9).map(|i| unit * (1.0 / (1.0 + f64::from(i)) - 0.5)).collect();
            for choice in [ExponentChoice::Free, ExponentChoice::Fixed(0.5), ExponentChoice::Fixed(5.0)] {
                if let Ok(fit) = fit_hold(&times, &values, choice, &FitOptions::default()) {
                    assert!(is_valid(&fit) || !fit.termination.is_good(), "{times:?} {values:?}: {fit:?}");
                }
            }
        }
    }
}

#[test]
fn odd_options_and_empty_signals_do_not_panic() {
    let times: Vec<f64> = (0..40).map(f64::from).collect();
    let values: Vec<f64> = times.iter().map(|t| 1.0 / (1.0 + t)).collect();
    let odd = [
        FitOptions {
            exponent_range: (5.0, 1.0),
            ..FitOptions::default()
        },
        FitOptions {
            exponent_range: (f64::NAN, 1.0),
            ..FitOptions::default()
        },
        FitOptions {
            exponent_range: (-3.0, -1.0),
            ..FitOptions::default()
        },
        FitOptions {
            confidence: 1.0,
            ..FitOptions::default()
        },
        FitOptions {
            confidence: 1.5,
            ..FitOptions::default()
        },
        FitOptions {
            confidence: f64::NAN,
            ..FitOptions::default()
        },
        FitOptions {
            most_iterations: 0,
            ..FitOptions::default()
        },
    ];
    let panics = |options: &FitOptions, choice: ExponentChoice| {
        std::panic::catch_unwind(|| {
            let _ = fit_hold(&times, &values, choice, options);
            let _ = fit_rates(&values, &times, choice, options);
        })
        .is_err()
    };
    let mut bad: Vec<String> = Vec::new();
    for options in &odd {
        for choice in [ExponentChoice::Free, ExponentChoice::Fixed(2.0)] {
            if panics(options, choice) {
                bad.push(format!("{choice:?}, {options:?}"));
            }
        }
    }
    if std::panic::catch_unwind(|| classify_relaxation(&[])).is_err() {
        bad.push("classify_relaxation of no samples".to_owned());
    }
    assert!(bad.is_empty(), "these panic:\n{}", bad.join("\n"));
}
