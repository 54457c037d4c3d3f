//! First touch and modulus against known truth.
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

use palpate::analysis::{Analysis, AnalysisError, AnalysisOptions, Finding, Geometry, LayersChoice, analyze};
use palpate::contact::{Equilibrium, Layers, Shape, Sides, Specimen};
use palpate::latency::LatencyLaw;
use palpate::record::Record;
use palpate::segment::{
    ContactChoice, ContactPoint, HoldMode, HoldStart, SegmentOptions, find_contact_of, find_phases,
};
use palpate::simulate::{ContactModel, Motion, ProtocolStep, Separation, protocol, simulate_force};
use palpate::test_problems::{PAPER_RATE, Rng, paper_ball};

use crate::repeats::repeats;

/// A test bench: what meets the body, how, and how well it is observed.
#[derive(Clone)]
struct Bench {
    model: ContactModel,
    /// Travel through air before first touch, m.
    air: f64,
    /// Standstill before the first ramp, s.
    rest: f64,
    /// Speed of the jaw, m/s.
    speed: f64,
    /// Samples a second.
    rate: f64,
    /// Standard deviation of the force, N.
    noise: f64,
    /// Step of the encoder, m.
    encoder: f64,
    /// Force without contact, N.
    zero: f64,
    /// Displacement at the start, m.
    start: f64,
}

impl Bench {
    fn paper(air: f64, noise: f64) -> Self {
        Self {
            model: paper_ball(Separation::Unilateral),
            air,
            rest: 0.0,
            speed: PAPER_RATE,
            rate: 100.0,
            noise,
            encoder: 0.0,
            zero: 0.0,
            start: 0.0,
        }
    }

    /// Steps to `levels` (m of travel in contact), each held for `hold` seconds; counted from where the jaw started.
    fn record(&self, levels: &[f64], hold: f64, seed: u64) -> Record {
        let steps: Vec<ProtocolStep> = levels
            .iter()
            .map(|to| ProtocolStep {
                to: *to,
                rate: self.speed,
                hold,
            })
            .collect();
        let touching = protocol(&steps).unwrap();
        let late = self.rest + self.air / self.speed;
        let end = touching.end() + late;
        let mut random = Rng::new(seed);
        let time: Vec<f64> = (0..=(end * self.rate) as u32).map(|i| f64::from(i) / self.rate).collect();
        let motion = Motion::new(
            std::iter::once(-1.0).chain(touching.times().iter().copied()).collect(),
            std::iter::once(0.0).chain(touching.displacements().iter().copied()).collect(),
        )
        .unwrap();
        let since: Vec<f64> = time.iter().map(|t| (t - late).clamp(-1.0, touching.end())).collect();
        let clean = simulate_force(&motion, &self.model, &since).unwrap();
        let force = clean.iter().map(|f| f + self.zero + self.noise * random.normal()).collect();
        let place = |t: &f64| {
            let d = if *t < late {
                self.speed * (t - self.rest).max(0.0)
            } else {
                self.air + touching.displacement_at(t - late)
            };
            let d = self.start + d;
            if self.encoder > 0.0 { (d / self.encoder).round() * self.encoder } else { d }
        };
        Record::new(time.clone(), Some(time.iter().map(place).collect()), force).unwrap()
    }

    fn touch(&self, record: &Record) -> ContactPoint {
        let record = record.repaired();
        let phases = find_phases(&record, &SegmentOptions::default()).unwrap();
        find_contact_of(&record, &phases, Some(&self.model.specimen), ContactChoice::Auto)
    }
}

fn strip(air: f64, noise: f64) -> Bench {
    let shape = Shape::Prism {
        area: 1e-3,
        length: 0.07,
    };
    Bench {
        model: ContactModel {
            specimen: Specimen::new(shape, 28e3, Sides::One).unwrap(),
            law: LatencyLaw::new(5.0, 2e4).unwrap(),
            layers: Layers::new(8.0).unwrap(),
            separation: Separation::Unilateral,
        },
        ..Bench::paper(air, noise)
    }
}

/// Errors (mm) of first touch and the same in standard errors, over `seeds` records; panics unless air is found in each.
fn errors(bench: &Bench, levels: &[f64], seeds: u64) -> (Vec<f64>, Vec<f64>) {
    let one = |seed| {
        let touch = bench.touch(&bench.record(levels, 10.0, seed));
        let error = touch.tare.displacement - (bench.air + bench.start);
        (1e3 * error, error / touch.displacement_error.unwrap())
    };
    (1..=seeds).map(one).unzip()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most: f64, value| most.max(value.abs()))
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

/// Steps that 5, 10 and 25 mm begin with.
const LEVELS: [[f64; 2]; 3] = [[0.005, 0.01], [0.01, 0.02], [0.025, 0.03]];

#[test]
fn without_noise_first_touch_behind_air_is_exact() {
    for levels in LEVELS {
        for bench in [Bench::paper(0.001, 0.0), Bench::paper(0.005, 0.0), Bench::paper(0.02, 0.0), strip(0.003, 0.0)] {
            for zero in [0.0, -0.7] {
                let bench = Bench { zero, ..bench.clone() };
                let touch = bench.touch(&bench.record(&levels, 10.0, 1));
                let error = touch.tare.displacement - bench.air;
                assert!(error.abs() < 1e-7, "{levels:?} after {} m: {error:e} m", bench.air);
                assert!((touch.tare.force - zero).abs() < 1e-9, "{touch:?}");
                assert!((touch.air_travel - bench.air).abs() < 1e-7, "{touch:?}");
            }
        }
    }
}

#[test]
fn noise_moves_first_touch_by_no_more_than_its_standard_error_says() {
    let mut pulls = Vec::new();
    for levels in LEVELS {
        let balls = [(0.005, 0.02), (0.005, 0.05), (0.02, 0.05)].map(|(air, noise)| Bench::paper(air, noise));
        for bench in balls.into_iter().chain([strip(0.003, 0.05)]) {
            let (found, standard) = errors(&bench, &levels, repeats(4, 8));
            println!(
                "{levels:?} after {} m, {} N: worst {:.3} mm, rms {:.3} mm = {:.2} standard errors",
                bench.air,
                bench.noise,
                largest(&found),
                rms(&found),
                rms(&standard)
            );
            assert!(largest(&found) < 0.15, "{levels:?} after {} m at {} N: {found:?} mm", bench.air, bench.noise);
            pulls.extend(standard);
        }
    }
    assert!((0.7..1.4).contains(&rms(&pulls)), "{}", rms(&pulls));
    assert!(largest(&pulls) < 4.5, "{pulls:?}");
}

#[test]
fn a_record_without_air_is_not_tared() {
    let slow = Bench {
        speed: 0.005 / 60.0,
        rate: 10.0,
        encoder: 1e-5,
        ..Bench::paper(0.0, 0.0)
    };
    for seed in 1..=repeats(6, 25) {
        for noise in [0.0, 0.02, 0.05] {
            let levels = LEVELS[seed as usize % 3];
            for bench in [Bench::paper(0.0, noise), strip(0.0, noise), Bench { noise, ..slow.clone() }] {
                let touch = bench.touch(&bench.record(&levels, 10.0, seed));
                assert_eq!((touch.tare.displacement, touch.air_travel), (0.0, 0.0), "seed {seed} {levels:?} {noise}");
                assert_eq!(touch.tare.force, 0.0);
            }
        }
    }
}

#[test]
fn a_rest_before_the_ramp_gives_the_zero_of_the_force() {
    let bench = Bench {
        rest: 3.0,
        zero: 1.5,
        start: 0.02,
        ..Bench::paper(0.0, 0.05)
    };
    let touch = bench.touch(&bench.record(&LEVELS[0], 10.0, 3));
    assert!((touch.tare.force - 1.5).abs() < 0.02, "{touch:?}");
    assert!((touch.tare.displacement - 0.02).abs() < 1e-9 && touch.air_travel == 0.0, "{touch:?}");
}

#[test]
fn a_first_step_through_air_alone_is_no_first_touch() {
    // 4 mm through air, a stop, then the step that meets the body.
    let stopped = Bench {
        start: 0.0,
        ..Bench::paper(0.002, 0.01)
    };
    let record = stopped.record(&LEVELS[1], 10.0, 2);
    let pause = 5.0;
    let before = (0..(pause * 100.0) as u32).map(|i| f64::from(i) / 100.0);
    let shift = pause + 1.0;
    let time: Vec<f64> = before.clone().chain(record.time().iter().map(|t| t + shift)).collect();
    let approach = before.clone().map(|t| (PAPER_RATE * t).min(0.004));
    let displacement: Vec<f64> = approach.chain(record.displacement().unwrap().iter().map(|d| d + 0.004)).collect();
    let mut random = Rng::new(9);
    let force: Vec<f64> = before.map(|_| 0.01 * random.normal()).chain(record.force().iter().copied()).collect();
    let touch = stopped.touch(&Record::new(time, Some(displacement), force).unwrap());
    assert!((touch.tare.displacement - 0.006).abs() < 5e-5, "{touch:?}");
}

/// Options for a ball of the paper, with or without its modulus.
fn ball(modulus: Option<f64>) -> AnalysisOptions {
    let geometry = Geometry {
        shape: Shape::Ball { radius: 0.035 },
        sides: Sides::Two,
        modulus,
        equilibrium: Equilibrium::UniformStrain,
    };
    AnalysisOptions {
        geometry: Some(geometry),
        touch: ContactChoice::Auto,
        ..AnalysisOptions::default()
    }
}

#[test]
fn the_paper_ball_gives_back_its_equilibrium_strains() {
    for air in [0.0, 0.005] {
        let bench = Bench::paper(air, 0.0);
        let analysis = analyze(&bench.record(&[0.005, 0.01, 0.015], 10.0, 1), &ball(Some(28e3))).unwrap();
        assert!(analysis.contact.tare.force.abs() < 1e-12, "{:?}", analysis.contact);
        for (hold, expected) in analysis.holds.iter().zip([0.0025, 0.005, 0.0075]) {
            let found = hold.fit_with(5.0).unwrap().equilibrium().value;
            assert!((found - expected / 0.035).abs() < 1e-6, "air {air}: {found}");
        }
        let codes: Vec<&str> = analysis.findings.iter().map(Finding::code).collect();
        assert!(codes.iter().all(|code| *code == "air_travel"), "{codes:?}");
    }
}

fn modulus(analysis: &Analysis) -> (f64, f64) {
    let estimate = analysis.findings.iter().find_map(|finding| match finding {
        Finding::ModulusEstimated {
            modulus,
            standard_error,
            ..
        } => Some((*modulus, standard_error.unwrap())),
        _ => None,
    });
    estimate.unwrap()
}

#[test]
fn the_modulus_does_not_depend_on_the_exponent() {
    let mut pulls = Vec::new();
    for (n, v) in [(1.0, 0.5), (2.0, 4.0), (3.0, 50.0), (5.0, 2e4), (4.0, 1e3)] {
        for (noise, seeds) in [(0.0, 1), (0.02, repeats(2, 6))] {
            for seed in 1..=seeds {
                let mut bench = Bench::paper(0.0, noise);
                bench.model.law = LatencyLaw::new(n, v).unwrap();
                let analysis = analyze(&bench.record(&[0.005, 0.01, 0.015, 0.01], 20.0, seed), &ball(None)).unwrap();
                let (found, error) = modulus(&analysis);
                if noise == 0.0 {
                    assert!((found / 28e3 - 1.0).abs() < 1e-6, "n = {n}: {found} Pa");
                } else {
                    println!("n = {n}: {found:.0} ± {error:.0} Pa");
                    assert!((found / 28e3 - 1.0).abs() < 0.03, "n = {n}: {found} ± {error} Pa");
                    pulls.push((found - 28e3) / error);
                }
            }
        }
    }
    println!("rms {:.2} standard errors", rms(&pulls));
    assert!(rms(&pulls) < 1.8, "{pulls:?}");
}

#[test]
fn a_jaw_that_goes_through_the_body_is_an_error() {
    let record = |reach: f64| {
        let time: Vec<f64> = (0..2000).map(|i| 0.01 * f64::from(i)).collect();
        let d: Vec<f64> = time.iter().map(|t| (0.02 * t).min(reach)).collect();
        let force = time.iter().map(|t| if *t < reach / 0.02 { t * t } else { 5.0 + 5.0 / (1.0 + t) }).collect();
        Record::new(time, Some(d), force).unwrap()
    };
    let options = |shape, sides, separation| AnalysisOptions {
        geometry: Some(Geometry {
            shape,
            sides,
            modulus: Some(28e3),
            equilibrium: Equilibrium::UniformStrain,
        }),
        separation,
        ..AnalysisOptions::default()
    };
    let ball = Shape::Ball { radius: 0.035 };
    let cylinder = Shape::Prism {
        area: 1e-3,
        length: 0.005,
    };
    for (shape, sides, reach, limit) in [
        (ball.clone(), Sides::Two, 0.075, 0.07),
        (ball, Sides::One, 0.036, 0.035),
        (cylinder.clone(), Sides::One, 0.01, 0.005),
    ] {
        let error = analyze(&record(reach), &options(shape, sides, Separation::Unilateral)).unwrap_err();
        let AnalysisError::BeyondBody {
            limit: found, sample, ..
        } = &error
        else {
            panic!("{error:?}")
        };
        assert!((found - limit).abs() < 1e-12 && *sample > 1, "{error}");
        assert!(error.to_string().contains("mm") && error.hint().contains("unit"), "{error}");
    }
    // A block whose jaws can pull was squeezed to nothing and below without a word: its modulus was a tenth.
    let held = AnalysisOptions {
        squeezed: true,
        ..options(cylinder.clone(), Sides::One, Separation::Bonded)
    };
    let error = analyze(&record(0.01), &held).unwrap_err();
    assert!(matches!(error, AnalysisError::BeyondBody { limit, .. } if (limit - 0.005).abs() < 1e-12), "{error}");
    assert!(error.hint().contains("separation = false"), "{}", error.hint());
    assert!(analyze(&record(0.004), &held).is_ok());
    // A strip in grips stretched to three times its length is nothing special.
    let strip = analyze(&record(0.01), &options(cylinder, Sides::One, Separation::Bonded)).unwrap();
    assert!(strip.overlay.is_some(), "{:?}", strip.findings);
}

#[test]
fn a_first_touch_that_the_jaw_does_not_reach_is_refused() {
    let record = Bench::paper(0.0, 0.02).record(&LEVELS[0], 10.0, 1);
    let farthest = record.displacement().unwrap().iter().copied().fold(f64::MIN, f64::max);
    let options = AnalysisOptions {
        touch: ContactChoice::Displacement(farthest + 1e-3),
        ..AnalysisOptions::default()
    };
    let error = analyze(&record, &options).unwrap_err();
    let AnalysisError::TouchBeyond {
        requested,
        farthest: found,
    } = error
    else {
        panic!("{error:?}")
    };
    assert!((requested - found - 1e-3).abs() < 1e-15 && found == farthest);
}

/// A first touch that was given left the zero of the load cell in the force: 1 N of offset made the equilibrium modulus half as much again.
#[test]
fn a_first_touch_that_is_given_has_its_own_zero_of_the_force() {
    let levels = [0.01, 0.02];
    for (rest, air, given) in [(2.0, 2e-3, 2e-3), (0.0, 2e-3, 2e-3), (2.0, 2e-3, 2.2e-3)] {
        let bench = Bench {
            rest,
            zero: 1.0,
            ..Bench::paper(air, 0.02)
        };
        let options = AnalysisOptions {
            touch: ContactChoice::Displacement(given),
            ..ball(Some(28e3))
        };
        let analysis = analyze(&bench.record(&levels, 10.0, 1), &options).unwrap();
        let tare = analysis.contact.tare;
        assert!((tare.force - 1.0).abs() < 0.02 && tare.displacement == given, "{rest} {given}: {tare:?}");
        let codes: Vec<&str> = analysis.findings.iter().map(Finding::code).collect();
        assert!(!codes.contains(&"force_not_zero"), "{codes:?}");
    }
    // Nothing before first touch gives no zero, and a finding says that there is a force.
    let bench = Bench {
        zero: 1.0,
        ..Bench::paper(0.0, 0.02)
    };
    let options = AnalysisOptions {
        touch: ContactChoice::Displacement(0.0),
        ..ball(Some(28e3))
    };
    let analysis = analyze(&bench.record(&levels, 10.0, 1), &options).unwrap();
    assert_eq!(analysis.contact.tare.force, 0.0);
    let codes: Vec<&str> = analysis.findings.iter().map(Finding::code).collect();
    assert!(codes.contains(&"force_not_zero"), "{codes:?}");
}

#[test]
fn what_cannot_be_fitted_says_why() {
    let record = Bench::paper(0.0, 0.02).record(&LEVELS[0], 10.0, 1);
    let hint = |options: &AnalysisOptions| {
        let error = analyze(&record, options).unwrap_err();
        println!("{error}: {}", error.hint());
        error.hint()
    };
    assert!(
        hint(&AnalysisOptions {
            fit_until: Some(0.01),
            ..ball(Some(28e3))
        })
        .contains("until")
    );
    let mut late = ball(Some(28e3));
    late.segment.hold_start = HoldStart::AfterPeak(9.999);
    assert!(hint(&late).contains("earlier"));
    assert!(
        hint(&AnalysisOptions {
            touch: ContactChoice::Displacement(0.05),
            ..ball(Some(28e3))
        })
        .contains("touch")
    );
    let quiet = Bench::paper(0.0, 0.0);
    let (time, d) = (record.time().to_vec(), record.displacement().unwrap().to_vec());
    let mut random = Rng::new(4);
    let still = d.iter().map(|d| 200.0 * d + 0.05 * random.normal()).collect();
    let error = analyze(&Record::new(time, Some(d), still).unwrap(), &ball(Some(quiet.model.specimen.modulus())));
    assert!(error.unwrap_err().to_string().contains("does not change in any hold"));
}

#[test]
fn columns_that_count_the_other_way_round_are_suspicious() {
    let record = Bench::paper(0.0, 0.02).record(&LEVELS[0], 10.0, 1);
    let signs = |d: f64, f: f64| {
        let turned = |values: &[f64], sign: f64| values.iter().map(|value| sign * value).collect::<Vec<f64>>();
        let displacement = turned(record.displacement().unwrap(), d);
        let turned = Record::new(record.time().to_vec(), Some(displacement), turned(record.force(), f)).unwrap();
        let options = AnalysisOptions::default();
        let found = analyze(&turned, &options).unwrap().findings;
        let column = |finding: &Finding| match finding {
            Finding::SignSuspicious { column, .. } => Some(column.clone()),
            _ => None,
        };
        found.iter().filter_map(column).collect::<Vec<String>>()
    };
    assert!(signs(1.0, 1.0).is_empty());
    assert_eq!(signs(1.0, -1.0), ["force"]);
    assert_eq!(signs(-1.0, 1.0), ["displacement"]);
    assert_eq!(signs(-1.0, -1.0), ["displacement", "force"]);
}

/// An end of the fits behind the end of every hold was passed over: nothing was predicted, without a word about it.
#[test]
fn an_end_of_the_fits_behind_that_of_all_holds_is_stated() {
    let record = Bench::paper(0.0, 0.02).record(&LEVELS[0], 10.0, 1);
    let stated = |until: f64| {
        let options = AnalysisOptions {
            fit_until: Some(until),
            ..ball(Some(28e3))
        };
        let findings = analyze(&record, &options).unwrap().findings;
        findings.iter().find(|finding| finding.code() == "until_beyond_holds").map(Finding::observation)
    };
    assert_eq!(stated(5.0), None);
    let observed = stated(600.0).unwrap();
    assert!(
        observed.starts_with("the fits were to end 600 s after their start, and the longest hold ends"),
        "{observed}"
    );
}

#[test]
fn touch_and_overlay_that_cannot_be_trusted_are_stated() {
    let noisy = Bench {
        rate: 50.0,
        ..Bench::paper(0.005, 0.05)
    };
    let analysis = analyze(&noisy.record(&LEVELS[0], 60.0, 1), &ball(Some(28e3))).unwrap();
    let codes = |analysis: &Analysis| analysis.findings.iter().map(Finding::code).collect::<Vec<_>>();
    assert!(codes(&analysis).contains(&"touch_uncertain"), "{:?} {:?}", analysis.contact, analysis.findings);
    let record = Bench::paper(0.0, 0.0).record(&LEVELS[0], 10.0, 1);
    let wrong = analyze(
        &record,
        &AnalysisOptions {
            layers: Some(LayersChoice::Count(1.5)),
            ..ball(Some(28e3))
        },
    );
    assert!(codes(&wrong.unwrap()).contains(&"overlay_poor"));
}

/// A body that loads as Hertz's does, and relaxes, behind 3 mm of air: the loading curve of palpate's own ball begins half a millimetre early.
#[test]
fn a_loading_curve_that_stands_alone_is_stated_and_its_error_is_as_large() {
    let mut random = Rng::new(3);
    let time: Vec<f64> = (0..1200).map(|i| 0.05 * f64::from(i)).collect();
    let jaw = |t: f64| (1e-3 * (t - 2.0)).clamp(0.0, 9e-3);
    let force = |t: f64| {
        let squeeze = (jaw(t) - 3e-3).max(0.0) * 1e3;
        let relaxed = if t < 11.0 { 1.0 } else { 0.6 + 0.4 / (1.0 + (t - 11.0)).powf(0.4) };
        4.0 * squeeze.powf(1.5) * relaxed
    };
    let displacement = time.iter().map(|t| jaw(*t) + 1e-6 * random.normal()).collect();
    let forces = time.iter().map(|t| force(*t) + 0.05 * random.normal()).collect();
    let record = Record::new(time, Some(displacement), forces).unwrap();
    let found = analyze(&record, &ball(None)).unwrap();
    let touch = found.contact.tare.displacement;
    let off = (touch - 3e-3).abs();
    let stated = found.findings.iter().any(|finding| matches!(finding, Finding::TouchApart { .. }));
    assert!(
        off < 0.1e-3 || (stated && found.contact.displacement_error.unwrap() > 0.7 * off),
        "{:?}",
        found.contact
    );
    assert!(stated, "{:?}", found.contact);
}

/// A block of 400 mm² and 20 mm, E = 250 kPa at rest and 2.5 times that at once, time constant 3 s: 1 s of rest at `zero` (N), 4 mm within 2 s of which the
/// first `air` (mm) go through air, 60 s of hold in which the jaw goes on by `drift` (mm), and back to `back` (mm) for 20 s.
fn block(zero: f64, air: f64, drift: f64, back: f64) -> Analysis {
    block_found(ContactChoice::AsRecorded, 4, [zero, air, drift, back])
}

fn block_found(touch: ContactChoice, seed: u64, [zero, air, drift, back]: [f64; 4]) -> Analysis {
    let mut random = Rng::new(seed);
    let jaw = |t: f64| match t {
        t if t < 3.0 => 2.0 * (t - 1.0).max(0.0),
        t if t < 63.0 => 4.0 + drift * (t - 3.0) / 60.0,
        t if t < 65.0 => 4.0 + drift - (4.0 + drift - back) * (t - 63.0) / 2.0,
        _ => back,
    };
    let (mut time, mut displacement, mut force, mut memory) = (Vec::new(), Vec::new(), Vec::new(), 0.0);
    let mut last = (jaw(0.0) - air).max(0.0);
    for i in 0..4250 {
        let t = 0.02 * f64::from(i);
        let squeeze = (jaw(t) - air).max(0.0);
        memory = (memory + 7.5 * (squeeze - last)) * (-0.02_f64 / 3.0).exp();
        last = squeeze;
        time.push(t);
        displacement.push(1e-3 * jaw(t) + 5e-7 * random.normal());
        force.push(zero + 5.0 * squeeze + memory + 0.02 * random.normal());
    }
    let options = AnalysisOptions {
        geometry: Some(Geometry {
            shape: Shape::Prism {
                area: 4e-4,
                length: 0.02,
            },
            sides: Sides::One,
            modulus: None,
            equilibrium: Equilibrium::UniformStrain,
        }),
        separation: Separation::Bonded,
        squeezed: true,
        touch,
        ..AnalysisOptions::default()
    };
    analyze(&Record::new(time, Some(displacement), force).unwrap(), &options).unwrap()
}

fn stated(analysis: &Analysis, code: &str) -> bool {
    let findings = analysis.findings.iter().chain(analysis.holds.iter().flat_map(|hold| &hold.findings));
    findings.into_iter().any(|finding| finding.code() == code)
}

/// Half a millimetre of air before a block took 13 % off its modulus, 1 N that was not tared 5 %, both without a word.
#[test]
fn air_and_a_force_before_a_stated_first_touch_are_stated() {
    for code in ["air_as_travel", "force_not_zero"] {
        assert!(!stated(&block(0.0, 0.0, 0.0, 1.0), code), "{code}");
    }
    assert!(stated(&block(0.0, 0.5, 0.0, 1.0), "air_as_travel"));
    assert!(
        stated(&block(1.0, 0.0, 0.0, 1.0), "force_not_zero") && stated(&block(-1.0, 0.0, 0.0, 1.0), "force_not_zero")
    );
}

/// A relaxation that is over before its hold ends was a hold of the force where the jaw drifted by half a per cent of its way.
#[test]
fn a_jaw_that_drifts_behind_a_relaxation_holds_no_force() {
    for drift in [0.02, -0.02, 0.04, 0.08] {
        let analysis = block(0.0, 0.0, drift, 1.0);
        let mode = analysis.holds[0].segment.mode;
        assert_ne!(mode, Some(HoldMode::ForceHeld), "{drift}");
        assert!(!stated(&analysis, "feedback_controlled"), "{drift}");
    }
}

/// A bonded body whose force goes from below zero to above it "pulled at rest".
#[test]
fn an_equilibrium_above_zero_behind_a_force_below_it_does_not_pull() {
    let mut analysis = block(0.4, 0.0, 0.0, 0.0);
    analysis.holds.retain(|hold| hold.segment.start > 3000);
    let hold = &analysis.holds[0];
    assert!(hold.preferred().is_some_and(|fit| fit.equilibrium().value > 0.0), "{hold:?}");
    assert!(!stated(&analysis, "equilibrium_beyond_zero"));
}

/// The zero of the force, as found from 50 samples of rest, was exact: the modulus from an equilibrium force held the truth in 4 of 12.
#[test]
fn a_zero_that_was_found_is_in_the_error_of_the_modulus() {
    let z = |seed: u64| {
        let modulus = block_found(ContactChoice::Auto, seed, [0.0, 0.5, 0.0, 1.0]).modulus.unwrap();
        (modulus.estimate.value - 250e3) / modulus.estimate.standard_error.unwrap()
    };
    let found: Vec<f64> = (0..24).map(z).collect();
    let count = found.iter().filter(|z| z.abs() < 2.0).count();
    println!("{count} of 24: {found:.1?}");
    assert!(count >= 20, "{count} of 24: {found:.1?}");
}
