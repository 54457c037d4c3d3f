//! Contacts of a calibrated material.

use super::*;

/// The ball of `model`, with numbers 10 % off on average and errors that say so.
pub(super) fn material(stiffer: f64) -> palpate::calibrate::Material {
    use palpate::calibrate::{
        Body, CalibrationRange, Candidate, EquilibriumLaw, Material, MaterialParameter, MaterialParts,
        MaterialUncertainty, MaterialUnit,
    };
    use palpate::laws::{ExponentChoice, Law};
    let model = model();
    let thickness = model.layers.thickness(model.specimen.depth());
    let number = |name: &str, unit, value: f64, share: f64| MaterialParameter {
        name: name.to_owned(),
        unit,
        estimate: Estimate {
            value,
            standard_error: Some(share * value),
            white_standard_error: None,
            interval: Some((value * (1.0 - 2.0 * share), value * (1.0 + 2.0 * share))),
        },
    };
    let variance = |share: f64| share * share;
    let mut covariance = vec![vec![0.0; 4]; 4];
    (covariance[0][0], covariance[1][1], covariance[2][2], covariance[3][3]) =
        (variance(0.02), variance(0.01), variance(0.1), variance(0.02));
    Material::new(MaterialParts {
        body: Body {
            shape: model.specimen.shape().clone(),
            sides: model.specimen.sides(),
            separation: Separation::Unilateral,
            levels: Vec::new(),
        },
        candidate: Candidate::new(
            Law::Latency {
                exponent: ExponentChoice::Free,
            },
            EquilibriumLaw::UniformStrain,
        ),
        parameters: vec![
            number("modulus_pa", MaterialUnit::Pascal, stiffer * model.specimen.modulus(), 0.02),
            number("exponent", MaterialUnit::One, 5.03, 0.01),
            number("rate_coefficient_per_s", MaterialUnit::PerSecond, 2.1e4, 0.1),
            number("layer_thickness_m", MaterialUnit::Metre, 1.01 * thickness, 0.02),
        ],
        uncertainty: Some(MaterialUncertainty {
            confidence: 0.95,
            freedom: 2000.0,
            systematic: Vec::new(),
            covariance,
        }),
        noise: 0.05,
        range: CalibrationRange {
            longest_hold: 60.0,
            longest_force_hold: 0.0,
            deepest: 0.01,
            fastest: 0.01,
            slowest: 0.001,
            largest_force: 5.0,
            farthest_retreat: 0.01,
            loadings: 1,
        },
    })
    .unwrap()
}

/// Observers of a contact that slips after a time, which know the exponent alike: from the hold alone, and with a material.
fn without_and_with(material: palpate::calibrate::Material, slip_after: f64) -> [ObserverOptions; 2] {
    let plain = ObserverOptions {
        exponent_standard_error: 0.05,
        ..slipping_at(force_after(slip_after))
    };
    let material = Some(material);
    [plain.clone(), ObserverOptions { material, ..plain }]
}

#[test]
fn a_material_tells_the_excess_at_once_and_the_time_to_slip_early() {
    let slip_after = 30.0;
    let course = squeeze(slip_after);
    let [plain, informed] = without_and_with(material(1.03), slip_after);
    let end = model().law.excess_after(0.133_032_479_302, 0.3);
    for after in [0.3, 3.0, 20.0] {
        let (mut inside, mut widths, seeds) = (0, [0.0; 2], repeats(12, 50));
        for seed in 0..seeds {
            let until = ((STOP + after) * RATE) as usize;
            let truth = slip_after - after;
            for (width, options) in widths.iter_mut().zip([&plain, &informed]) {
                let observed = *watched(&course[..until], seed, options).last().unwrap();
                let Some(SlipForecast::Known {
                    low: TimeToSlip::After(low),
                    high: TimeToSlip::After(high),
                    ..
                }) = observed.time_to_slip
                else {
                    continue;
                };
                *width += (high / low.max(1e-3)).ln() / seeds as f64;
                if options.material.is_some() {
                    inside += u64::from(low <= truth * 1.001 && truth <= high * 1.001);
                    if after == 0.3 {
                        let strain = observed.excess_strain.unwrap();
                        assert!(
                            (strain.value - end).abs() < 5.0 * error(strain) && error(strain) < 0.1 * end,
                            "{strain:?} {end}"
                        );
                    }
                }
            }
        }
        println!("observed at {after} s: inside {inside} of {seeds}, ln(high/low) {widths:?}");
        assert!(inside >= least_inside(seeds), "{after}: {inside}");
        // Readings that follow closely count as fewer, so that later the hold alone tells as much.
        assert!(widths[1] < if after < 1.0 { 0.3 } else { 1.3 } * widths[0], "{after}: {widths:?}");
    }
}

/// A squeeze of 5 mm at a speed (m/s), the body stepped a thousand times a reading, read at a rate (1/s) for `hold` s after the jaw stops, which it
/// does between two readings.
fn read_at(speed: f64, rate: f64, hold: f64) -> Vec<(f64, f64, f64)> {
    const FINE: usize = 1000;
    let (model, mut contact, mut force) = (model(), ContactState::default(), 0.0);
    let begins = 1.37 / rate;
    (1..=((begins + 5e-3 / speed + hold) * rate) as usize)
        .map(|i| {
            let at = |k: usize| {
                (5e-3f64).min(speed * ((i - 1) as f64 / rate + k as f64 / (FINE as f64 * rate) - begins).max(0.0))
            };
            for k in 1..=FINE {
                force = contact.step(&model, 1.0 / (FINE as f64 * rate), at(k)).unwrap();
            }
            (i as f64 / rate, at(FINE), force)
        })
        .collect()
}

/// The error of one step a reading, 2 to 7 % of the force of a ramp, was taken for the body: 0 of 40 equilibria were within their intervals.
#[test]
fn intervals_contain_the_truth_however_seldom_a_ramp_is_read() {
    let body = model().specimen;
    let place = body.contact_displacement(5e-3);
    let equilibrium = body.force(body.equilibrium_strain(place), place);
    for (speed, rate) in [(0.0083, 10.0), (0.0083, 20.0), (0.0083, 50.0), (0.05, 100.0), (0.1, 100.0), (0.1, 1000.0)] {
        for after in [0.5, 5.0] {
            let course = read_at(speed, rate, after);
            let (mut inside, mut known, mut away, seeds) = (0, 0, 0.0, repeats(40, 200));
            for seed in 0..seeds {
                let options = ObserverOptions {
                    material: Some(material(1.0)),
                    noise: Some((1e-6, 0.02)),
                    ..slipping_at(1.0)
                };
                let found = watched_with_drift(&course, 0.0, seed, &options).equilibrium_force;
                if let Some(found) = found {
                    known += 1;
                    inside += u64::from((found.value - equilibrium).abs() < 2.0 * error(found));
                    away += (found.value - equilibrium) / error(found) / seeds as f64;
                }
            }
            println!("{speed} m/s, {rate} Hz, {after} s: {inside} of {known}, mean {away:.2}");
            assert!(inside >= least_inside(seeds), "{speed} {rate} {after}: {inside} of {known}");
            assert!(away.abs() < 1.0, "{speed} {rate} {after}: {away}");
        }
    }
}

/// One reading of 50 N moved the equilibrium by six standard errors for the rest of the hold.
#[test]
fn a_reading_that_is_none_of_the_body_moves_nothing() {
    let course = squeeze(15.0);
    let options = ObserverOptions {
        material: Some(material(1.0)),
        noise: Some((1e-6, 0.05)),
        ..ObserverOptions::default()
    };
    for strange in [50.0, 200.0, 0.0] {
        for seed in 0..10 {
            let [plain, found] = [false, true].map(|is_strange| {
                let mut course = course.clone();
                if is_strange {
                    course[((STOP + 3.0) * RATE) as usize].2 = strange;
                }
                watched_with_drift(&course, 0.0, seed, &options).equilibrium_force.unwrap()
            });
            let moved = (found.value - plain.value) / error(plain);
            assert!(moved.abs() < 0.5, "{strange} N, {seed}: {moved} standard errors");
        }
    }
}

/// Readings that share their noise were counted as independent: 44 to 75 of 100 equilibria and 47 to 72 of 100 times were within their intervals.
#[test]
fn intervals_contain_the_truth_under_noise_that_correlates() {
    let slip_after = 30.0;
    let course = squeeze(slip_after);
    let [plain, informed] = without_and_with(material(1.0), slip_after);
    let body = model().specimen;
    let place = body.contact_displacement(5e-3);
    let equilibrium = body.force(body.equilibrium_strain(place), place);
    for after in [1.0, 3.0, 20.0] {
        for options in [&plain, &informed] {
            let (mut times, mut forces, mut never, seeds) = (0, 0, 0, repeats(40, 300));
            for seed in 0..seeds {
                let until = ((STOP + after) * RATE) as usize;
                let observed = watched_with_drift(&course[..until], 0.9, seed, options);
                let truth = slip_after - after;
                match observed.time_to_slip {
                    Some(SlipForecast::Known { low, high, .. }) => {
                        never += u64::from(low == TimeToSlip::Never);
                        let early = low.seconds().is_some_and(|low| low <= truth * 1.001);
                        times += u64::from(early && high.covers(truth / 1.001));
                    }
                    _ => times += 1,
                }
                let is_within = |found: Estimate| {
                    found.interval.is_none_or(|(low, high)| low <= equilibrium && equilibrium <= high)
                };
                forces += u64::from(observed.equilibrium_force.is_none_or(is_within));
            }
            let of = if options.material.is_some() { "material" } else { "hold alone" };
            println!("{of}, after {after} s: times {times}, equilibria {forces} of {seeds}, never {never}");
            let least = (0.86 * seeds as f64) as u64;
            assert!(times >= least && forces >= least && never <= seeds / 20, "{of} {after}: {times} {forces} {never}");
        }
    }
}

/// A material calibrated with little noise, its numbers off the true ones as its covariance says.
fn drawn(random: &mut Rng) -> palpate::calibrate::Material {
    let mut parts = material(1.0).into_parts();
    let truth = model();
    let thickness = truth.layers.thickness(truth.specimen.depth());
    let truths = [truth.specimen.modulus(), truth.law.exponent(), truth.law.rate_coefficient(), thickness];
    for (parameter, value) in parts.parameters.iter_mut().zip(truths) {
        let share = parameter.estimate.standard_error.unwrap() / parameter.estimate.value;
        parameter.estimate.value = value * (share * random.normal()).exp();
    }
    parts.noise = 0.005;
    palpate::calibrate::Material::new(parts).unwrap()
}

/// The noise of the last displacement went into every number, and that of the forces was taken for that of the calibration: 12 to 62 % of
/// the intervals of the time to slip contained it.
#[test]
fn intervals_of_a_material_contain_the_truth_with_noise_of_the_displacement() {
    let (slip_after, rate) = (15.0, 100.0);
    let course: Vec<_> = squeeze(slip_after).into_iter().skip(4).step_by(5).collect();
    let body = model().specimen;
    let place = body.contact_displacement(5e-3);
    let equilibrium = body.equilibrium_force(place);
    let slip_force = force_after(slip_after);
    let seeds = repeats(40, 400);
    for (jaw_noise, force_noise) in [(0.0, 0.01), (2e-6, 0.01), (1e-5, 0.01), (2e-6, 0.05)] {
        let after = [0.5, 3.0, 10.0];
        let mut inside = [[0; 3]; 3];
        for seed in 0..seeds {
            let mut random = Rng::new(seed);
            let options = ObserverOptions {
                material: Some(drawn(&mut random)),
                ..slipping_at(slip_force)
            };
            let mut observer = Observer::new(options).unwrap();
            let observed: Vec<Observation> = course
                .iter()
                .map(|(time, displacement, force)| {
                    let displacement = displacement + jaw_noise * random.normal();
                    observer.feed(*time, Some(displacement), force + force_noise * random.normal()).unwrap()
                })
                .collect();
            for (after, inside) in after.iter().zip(&mut inside) {
                let at = observed[((STOP + after) * rate) as usize - 1];
                let excess = model().law.excess_after(0.133_032_479_302, at.time - STOP);
                let holds = |found: Option<Estimate>, truth: f64| {
                    found.is_some_and(|found| (found.value - truth).abs() < 1.96 * error(found))
                };
                inside[0] += u64::from(holds(at.excess_strain, excess));
                inside[1] += u64::from(holds(at.equilibrium_force, equilibrium));
                let left = STOP + slip_after - at.time;
                inside[2] += u64::from(matches!(at.time_to_slip, Some(SlipForecast::Known { low, high, .. })
                    if low.seconds().is_some_and(|low| low <= left * 1.001) && high.covers(left / 1.001)));
            }
        }
        for (after, [excess, equilibrium, slip]) in after.iter().zip(inside) {
            println!("{jaw_noise} m, {force_noise} N, {after} s: {excess} {equilibrium} {slip} of {seeds}");
        }
        let least = (0.85 * seeds as f64) as u64;
        assert!(inside.iter().flatten().all(|inside| *inside >= least), "{jaw_noise} m, {force_noise} N: {inside:?}");
    }
}

#[test]
fn a_material_whose_rate_depends_on_the_strain_is_watched_by_that() {
    use palpate::calibrate::{Material, MaterialParameter, MaterialUnit, RateLaw};
    use palpate::simulate::{Motion, Sampling, simulate};
    let mut parts = material(1.0).into_parts();
    parts.candidate.rate = RateLaw::ByStrain;
    parts.parameters.push(MaterialParameter {
        name: "strain_factor".to_owned(),
        unit: MaterialUnit::One,
        estimate: Estimate::fixed(0.02),
    });
    let covariance = &mut parts.uncertainty.as_mut().unwrap().covariance;
    covariance.iter_mut().for_each(|row| row.push(0.0));
    covariance.push(vec![0.0; 5]);
    let varying = Material::new(parts).unwrap();
    let truth = varying.contact();
    let motion = Motion::new(vec![0.0, STOP, 8.0], vec![0.0, 5e-3, 5e-3]).unwrap();
    let times = (1..(8.0 * RATE) as usize).map(|i| i as f64 / RATE).collect();
    let course = simulate(&motion, truth, &Sampling::Times(times)).unwrap();
    let ticks: Vec<_> = (0..course.len()).map(|i| (course.time[i], course.displacement[i], course.force[i])).collect();
    let informed = |material| ObserverOptions {
        material: Some(material),
        ..ObserverOptions::default()
    };
    let observed = watched(&ticks, 3, &informed(varying));
    // Right after the stop, when the hold itself tells little, and later.
    for at in [0.8, 2.0, 7.9] {
        let index = (at * RATE) as usize - 1;
        let strain = observed[index].excess_strain.unwrap();
        let exact = course.excess_strain[index];
        assert!(
            (strain.value - exact).abs() < 4.0 * error(strain) + 1e-4 && error(strain) < 0.1 * exact,
            "{at} s: {strain:?} {exact}"
        );
    }
    // A body with one rate coefficient is not this one.
    let plain = watched(&ticks, 3, &informed(material(1.0)));
    let last = plain.last().unwrap();
    let exact = course.excess_strain.last().unwrap();
    assert!(
        last.excess_strain.is_none_or(|strain| (strain.value - exact).abs() > 4.0 * error(strain)),
        "{last:?} {exact}"
    );
}

#[test]
fn forces_of_another_body_are_fitted_as_they_are() {
    let course = squeeze(10.0);
    let options = ObserverOptions {
        material: Some(material(3.0)),
        ..slipping_at(0.5)
    };
    let observed = *watched(&course, 1, &options).last().unwrap();
    assert!(observed.excess_strain.is_none() && observed.equilibrium_force.is_some());
    let mut observer = Observer::new(options).unwrap();
    assert!(matches!(observer.feed(0.0, Some(1.0), 0.0), Err(ObserveError::Displacement { .. })));
    assert!(observer.feed(0.0, Some(0.0), 0.0).is_ok());
}

/// A material that never saw the jaw stated that there is no force, and that what is held slips.
#[test]
fn a_material_says_nothing_where_no_displacement_is_read() {
    let (course, mut noise) = (squeeze(10.0), Rng::new(5));
    let forces: Vec<(f64, f64)> = course.iter().map(|tick| (tick.0, tick.2 + 0.02 * noise.normal())).collect();
    let informed = ObserverOptions {
        material: Some(material(1.0)),
        ..slipping_at(0.5)
    };
    let [mut with, mut without] = [informed, slipping_at(0.5)].map(|options| Observer::new(options).unwrap());
    for (time, force) in forces {
        let (a, b) = (with.feed(time, None, force).unwrap(), without.feed(time, None, force).unwrap());
        // What it knows of the exponent goes into the fit of the force alone.
        assert!((a.force - b.force).abs() < 0.02 * (0.5 + b.force.abs()), "{time}: {a:?} {b:?}");
        assert!(a.excess_strain.is_none() && a.slip != Slip::Slipping || time < 0.5, "{time}: {a:?}");
    }
}
