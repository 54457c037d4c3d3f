//! What must hold for any body, any law and any drive: symmetries of the equations, signs, energy, and that all results agree.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

mod scenes;

use palpate::simulate::{
    ContactEventKind, ForceHistory, Motion, ProgramStep, ProtocolStep, Sampling, Separation, SimulateError, Trajectory,
    energy, protocol, simulate, simulate_force, step_ends, summary,
};
use proptest::prelude::*;
use proptest::test_runner::{FileFailurePersistence, RngSeed};
use scenes::{Body, Scene, blocks, decades, knots, scenes, scenes_of, steps};

/// The same cases every time, and what ever failed; `PROPTEST_CASES` and another seed explore further.
fn cases(count: u32) -> ProptestConfig {
    ProptestConfig {
        cases: std::env::var("PROPTEST_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(count),
        rng_seed: RngSeed::Fixed(std::env::var("PROPTEST_SEED").ok().and_then(|text| text.parse().ok()).unwrap_or(1)),
        failure_persistence: Some(Box::new(FileFailurePersistence::WithSource("regressions"))),
        ..ProptestConfig::default()
    }
}

/// What a program may be refused for, whatever the numbers: never that the numbers ran out.
fn may_be_refused(error: &SimulateError) -> bool {
    use SimulateError as E;
    matches!(
        error,
        E::NoContact { .. }
            | E::Unreachable { .. }
            | E::Force { .. }
            | E::Tension { .. }
            | E::EmptyProgram
            | E::TooStiff { .. }
            | E::NoArea { .. }
    )
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most: f64, value| most.max(value.abs()))
}

/// The knots, and `count` times between each two of them, crowded after the first.
fn samples(knots: &[f64], count: u32) -> Vec<f64> {
    let mut times = vec![knots[0]];
    for pair in knots.windows(2) {
        let width = pair[1] - pair[0];
        let inside = (1..count).map(|i| (f64::from(i) / f64::from(count)).powi(3)).map(|part| pair[0] + part * width);
        times.extend(inside.filter(|time| *time < pair[1]));
        times.push(pair[1]);
    }
    times.dedup();
    times
}

/// How far a series is from another, divided by `factor`, as a share of the largest of it.
fn far(a: &[f64], b: &[f64], factor: f64) -> f64 {
    far_of(a, b, factor, largest(a))
}

/// The same as a share of `size`.
fn far_of(a: &[f64], b: &[f64], factor: f64, size: f64) -> f64 {
    assert_eq!(a.len(), b.len());
    let size = size.max(f64::MIN_POSITIVE);
    a.iter().zip(b).map(|(a, b)| (a - b / factor).abs()).fold(0.0, f64::max) / size
}

fn run(scene: &Scene, motion: &Motion) -> Trajectory {
    simulate(motion, &scene.model(), &Sampling::Times(samples(motion.times(), 20))).unwrap()
}

proptest! {
    #![proptest_config(cases(80))]

    #[test]
    fn a_later_start_changes_nothing(scene in scenes(), knots in knots(), later in -3.0..3.0f64) {
        let motion = scene.motion(&knots);
        let by = later * motion.end();
        let shifted = Motion::new(motion.times().iter().map(|t| t + by).collect(), motion.displacements().to_vec());
        let shifted = shifted.unwrap();
        let (first, last) = (shifted.start(), shifted.end());
        let result = run(&scene, &motion);
        let times = result.time.iter().map(|t| (t + by).clamp(first, last)).collect();
        let moved = simulate(&shifted, &scene.model(), &Sampling::Times(times)).unwrap();
        prop_assert!(far(&result.force, &moved.force, 1.0) < 1e-8, "{:e}", far(&result.force, &moved.force, 1.0));
        // Of a memory of force the surface is a root: what rounding leaves of no force is a dent of a hundred-thousandth.
        let dent = if scene.remembers_force() { 1e-4 } else { 1e-9 };
        let off = far_of(&result.contact_displacement, &moved.contact_displacement, 1.0, scene.body.deepest());
        prop_assert!(off < dent, "{off:e}");
        prop_assert_eq!(result.events.len(), moved.events.len());
        // Under the force that came of it, where there is one that can be requested.
        let forces: Vec<f64> = result.force.iter().map(|force| force.max(0.0)).collect();
        let times: Vec<f64> = result.time.clone();
        let history = ForceHistory::new(times.clone(), forces.clone()).unwrap();
        let shifted = ForceHistory::new(times.iter().map(|t| t + by).collect(), forces).unwrap();
        let at = Sampling::Times(shifted.times().to_vec());
        match (simulate(&history, &scene.model(), &Sampling::Times(times)), simulate(&shifted, &scene.model(), &at)) {
            (Ok(a), Ok(b)) => prop_assert!(far_of(&a.displacement, &b.displacement, 1.0, scene.body.deepest()) < 1e-7),
            (a, b) => prop_assert!(a.is_err_and(|error| may_be_refused(&error)) && b.is_err_and(|error| may_be_refused(&error))),
        }
    }

    #[test]
    fn stiffer_larger_and_faster_bodies_do_the_same(
        scene in scenes(), knots in knots(), c in decades(-3.0, 3.0), steps in steps(),
    ) {
        let with = |modulus: f64, depth: f64, unit: f64| {
            let body = Body { modulus: modulus * scene.body.modulus, depth: depth * scene.body.depth, ..scene.body.clone() };
            Scene { body, unit: unit * scene.unit, ..scene.clone() }
        };
        let result = run(&scene, &scene.motion(&knots));
        let program = simulate(&scene.program(&steps), &scene.model(), &Sampling::Times(Vec::new()));
        let ends = |scene: &Scene| step_ends(&scene.program(&steps), &scene.model());
        let expected = ends(&scene);
        prop_assert_eq!(program.is_ok(), expected.is_ok());
        for (scaled, force, length) in [(with(c, 1.0, 1.0), c, 1.0), (with(1.0, c, 1.0), c * c, c), (with(1.0, 1.0, c), 1.0, 1.0)] {
            let found = run(&scaled, &scaled.motion(&knots));
            // A jaw that leaves a hair later is somewhere else by as much.
            prop_assert!(far(&result.force, &found.force, force) < 1e-8, "{:e}", far(&result.force, &found.force, force));
            let dent = if scene.remembers_force() { 1e-4 } else { 1e-8 };
            let off = far_of(&result.contact_displacement, &found.contact_displacement, length, scene.body.deepest());
            prop_assert!(off < dent, "{off:e}");
            prop_assert!(far(&result.strain, &found.strain, 1.0) < 1e-7);
            match (&expected, ends(&scaled)) {
                (Ok(expected), Ok(found)) => {
                    let time = scaled.unit / scene.unit;
                    let series = |ends: &[palpate::simulate::StepEnd], of: fn(&palpate::simulate::StepEnd) -> f64| {
                        ends.iter().map(of).collect::<Vec<f64>>()
                    };
                    for (factor, of) in [
                        (time, (|end| end.time) as fn(&palpate::simulate::StepEnd) -> f64),
                        (length, |end| end.displacement),
                        (force, |end| end.force),
                    ] {
                        let off = far(&series(expected, of), &series(&found, of), factor);
                        prop_assert!(off < 1e-7, "{off:e}: {expected:?} {found:?}");
                    }
                }
                (Err(one), Err(other)) => {
                    prop_assert!(may_be_refused(one), "{one}");
                    prop_assert_eq!(std::mem::discriminant(one), std::mem::discriminant(&other), "{} {}", one, other);
                }
                (one, other) => prop_assert!(false, "{one:?} {other:?}"),
            }
        }
    }

    #[test]
    fn a_jaw_that_cannot_pull_pushes_or_is_off(scene in scenes(), knots in knots(), steps in steps()) {
        let scene = Scene { separation: Separation::Unilateral, ..scene };
        let motion = scene.motion(&knots);
        let by_motion = run(&scene, &motion);
        let program = scene.program(&steps);
        let by_program = match step_ends(&program, &scene.model()) {
            Ok(ends) => {
                let ends: Vec<f64> = [0.0].into_iter().chain(ends.iter().map(|end| end.time)).collect();
                simulate(&program, &scene.model(), &Sampling::Times(samples(&ends, 20))).unwrap()
            }
            Err(error) => {
                prop_assert!(may_be_refused(&error), "{error}");
                Trajectory::default()
            }
        };
        for result in [by_motion, by_program] {
            let most = largest(&result.force);
            let mut off = Vec::new();
            for event in &result.events {
                match event.kind {
                    ContactEventKind::Lost => off.push((event.time, f64::INFINITY)),
                    ContactEventKind::Regained => off.last_mut().unwrap().1 = event.time,
                }
            }
            let specimen = scene.body.specimen();
            for k in 0..result.len() {
                let (time, force) = (result.time[k], result.force[k]);
                prop_assert!(force >= -1e-11 * most, "{force} N at {time} s");
                if off.iter().any(|(from, until)| *from < time && time < *until) {
                    prop_assert_eq!(force, 0.0);
                }
                let share = specimen.contact_displacement(result.displacement[k]);
                let depth = specimen.depth();
                prop_assert!(result.contact_displacement[k] >= share - 1e-11 * depth, "the jaw is inside the body at {time} s");
                // A body at rest does not follow a jaw that goes away.
                prop_assert!(result.contact_displacement[k] >= -1e-11 * depth, "the body is pulled at {time} s");
            }
        }
    }

    /// Loaded from rest every excess is above zero, and stays there while the jaw stands or the force is kept: ẋ_k = g_k q̇ − λ_k x_k with
    /// q̇ ≥ 0, and under a kept force q̇ is Σ λ_k x_k times something above zero.
    #[test]
    fn after_loading_a_kept_place_relaxes_and_a_kept_force_creeps(
        scene in scenes(), levels in proptest::collection::vec((0.0..0.2f64, decades(-2.0, 1.5), any::<bool>()), 1..5),
        wait in decades(-1.0, 3.0), long in decades(-1.0, 3.0),
    ) {
        let (mut at, mut program) = (0.02, Vec::new());
        for (more, rate, waits) in levels {
            at += 0.5 * more + 0.01;
            program.push(ProgramStep::Move { to: at * scene.body.deepest(), rate: rate * scene.body.deepest() / scene.unit });
            if waits {
                program.push(ProgramStep::HoldPosition { duration: wait * scene.unit });
            }
        }
        program.push(ProgramStep::HoldPosition { duration: wait * scene.unit });
        let start = program.len();
        program.push(ProgramStep::HoldForce { duration: long * scene.unit });
        let ends = match step_ends(&program, &scene.model()) {
            Ok(ends) => ends,
            // The body gives way.
            Err(error) => {
                prop_assert!(matches!(error, SimulateError::Force { .. }), "{error}");
                return Ok(());
            }
        };
        let times = |from: usize| samples(&[ends[from].time, ends[from + 1].time], 60);
        let result = simulate(&program, &scene.model(), &Sampling::Times(times(start - 2 + usize::from(start < 2)))).unwrap();
        if start >= 2 {
            let rounding = 1e-13 * largest(&result.force);
            prop_assert!(result.force.windows(2).all(|pair| pair[1] <= pair[0] + rounding), "{:?}", result.force);
        }
        let result = simulate(&program, &scene.model(), &Sampling::Times(times(start - 1))).unwrap();
        // The steps of a kept force are good to 10⁻¹² of the displacement each.
        let rounding = 1e-11 * scene.body.deepest();
        let creep = &result.displacement;
        prop_assert!(creep.windows(2).all(|pair| pair[1] >= pair[0] - rounding), "{creep:?}");
        prop_assert!(largest(&result.force) - result.force[0] <= 1e-13 * result.force[0]);
    }
}

proptest! {
    #![proptest_config(cases(60))]

    /// At constant section the work splits exactly, for any drive.
    #[test]
    fn at_constant_section_nothing_is_won_back_from_heat(
        scene in scenes_of(blocks()), knots in knots(), steps in steps(),
    ) {
        let program = scene.program(&steps);
        let motion = scene.motion(&knots);
        let mut accounts = vec![energy(&motion, &scene.model(), &Sampling::Times(samples(motion.times(), 20))).unwrap()];
        if let Ok(ends) = step_ends(&program, &scene.model()) {
            let ends: Vec<f64> = [0.0].into_iter().chain(ends.iter().map(|end| end.time)).collect();
            accounts.push(energy(&program, &scene.model(), &Sampling::Times(samples(&ends, 20))).unwrap());
        }
        for account in accounts {
            let split = account.split.unwrap();
            let rounding = 1e-10 * scene.force() * scene.body.deepest();
            let size = largest(&account.work).max(largest(&account.given_back)).max(rounding);
            prop_assert!(split.stored.iter().all(|stored| *stored >= 0.0));
            prop_assert!(split.lost.windows(2).all(|pair| pair[1] >= pair[0] - 1e-10 * size), "{:?}", split.lost);
            prop_assert!(account.given_back.windows(2).all(|pair| pair[1] >= pair[0]));
            for i in 0..account.time.len() {
                prop_assert!((split.stored[i] + split.lost[i] - account.work[i]).abs() <= 1e-13 * size);
            }
        }
    }

    /// A jaw that ends where it began, or off the body, has done work on it and not the other way round, whatever the body and however
    /// it went: a body cannot drive an engine.
    ///
    /// For every term the work is ∮ S x du (of the equilibrium force, along which no work remains, F_e du). In the plane of u and
    /// y = x − g u/depth a motion goes straight, and relaxation alone moves y: down where x > 0, up where x < 0. Where a loop ran
    /// counterclockwise it would at some height y rise on the right, with y < −g u/depth, and fall on the left, with y > −g u/depth, and u
    /// on the left would be greater than on the right. All loops therefore run clockwise, and the area in them, weighted with S ≥ 0, is
    /// work done. The same holds for a memory of force with F_e for u and its slope for 1/S, and for the latency law. From where the
    /// jaw ends, at no displacement or off, the body goes back to rest without work, so that the loop is closed.
    #[test]
    fn no_cycle_of_any_body_yields_work(scene in scenes(), knots in knots(), back in decades(-2.0, 1.5)) {
        prop_assume!(!(scene.remembers_force() && scene.separation == Separation::Bonded));
        let mut motion = scene.motion(&knots);
        let (mut times, mut at) = (motion.times().to_vec(), motion.displacements().to_vec());
        times.push(motion.end() + back * scene.unit);
        at.push(0.0);
        motion = Motion::new(times, at).unwrap();
        let account = energy(&motion, &scene.model(), &Sampling::Times(samples(motion.times(), 5)));
        prop_assert!(account.is_ok(), "{account:?}");
        let account = account.unwrap();
        let last = account.time.len() - 1;
        let (work, done) = (account.work[last], account.work[last] + account.given_back[last]);
        prop_assert!(work >= -1e-9 * done, "{work:e} J of {done:e} J");
    }

    /// The jaw's work is the area under the force.
    #[test]
    fn work_is_the_area_under_the_force(scene in scenes(), knots in knots(), steps in steps()) {
        let program = scene.program(&steps);
        let motion = scene.motion(&knots);
        let mut runs = Vec::new();
        let times = Sampling::Times(samples(motion.times(), 300));
        runs.push((simulate(&motion, &scene.model(), &times).unwrap(), energy(&motion, &scene.model(), &times).unwrap()));
        if let Ok(ends) = step_ends(&program, &scene.model()) {
            let ends: Vec<f64> = [0.0].into_iter().chain(ends.iter().map(|end| end.time)).collect();
            let times = Sampling::Times(samples(&ends, 300));
            runs.push((simulate(&program, &scene.model(), &times).unwrap(), energy(&program, &scene.model(), &times).unwrap()));
        }
        for (series, account) in runs {
            let rounding = 1e-12 * scene.force() * scene.body.deepest();
            let (mut area, mut way) = (0.0, 0.0);
            let most = largest(&series.force);
            for i in 1..series.len() {
                let by = series.displacement[i] - series.displacement[i - 1];
                area += 0.5 * (series.force[i] + series.force[i - 1]) * by;
                way += by.abs();
                prop_assert!((area - account.work[i]).abs() <= 3e-3 * most * way + rounding, "{area:e} J {:e} J at {} s", account.work[i], series.time[i]);
            }
        }
    }

    #[test]
    fn all_results_of_a_program_agree(scene in scenes(), steps in steps()) {
        let (program, model) = (scene.program(&steps), scene.model());
        let ends = match step_ends(&program, &model) {
            Ok(ends) => ends,
            Err(error) => {
                prop_assert!(may_be_refused(&error), "{error}");
                prop_assert_eq!(simulate(&program, &model, &Sampling::Rate(1.0)), Err(error));
                return Ok(());
            }
        };
        let knots: Vec<f64> = [0.0].into_iter().chain(ends.iter().map(|end| end.time)).collect();
        let many = samples(&knots, 12);
        let fine = simulate(&program, &model, &Sampling::Times(many.clone())).unwrap();
        let (force, depth) = (largest(&fine.force), scene.body.deepest());
        for (end, step) in ends.iter().zip(&program) {
            match *step {
                ProgramStep::MoveToForce { force: requested, .. } | ProgramStep::Press { to: requested, .. } => {
                    prop_assert!((end.force - requested).abs() <= 1e-9 * requested, "{requested} N, found {} N", end.force);
                }
                ProgramStep::Move { to, .. } => prop_assert!((end.displacement - to).abs() <= 1e-12 * depth),
                ProgramStep::HoldPosition { .. } | ProgramStep::HoldForce { .. } => {}
            }
            let at = fine.time.iter().rposition(|time| *time == end.time).unwrap();
            prop_assert!((fine.displacement[at] - end.displacement).abs() <= 1e-11 * depth, "{} {end:?}", fine.displacement[at]);
            prop_assert!((fine.force[at] - end.force).abs() <= 1e-9 * force, "{} {end:?}", fine.force[at]);
        }
        // Few samples or many, they are the same.
        let few: Vec<f64> = many.iter().copied().skip(1).step_by(7).collect();
        let coarse = simulate(&program, &model, &Sampling::Times(few.clone())).unwrap();
        let (every, some) = (
            energy(&program, &model, &Sampling::Times(many.clone())).unwrap(),
            energy(&program, &model, &Sampling::Times(few.clone())).unwrap(),
        );
        let work = largest(&every.work).max(largest(&every.given_back));
        for (k, time) in few.iter().enumerate() {
            let at = many.iter().position(|other| other == time).unwrap();
            prop_assert_eq!((coarse.force[k], coarse.displacement[k]), (fine.force[at], fine.displacement[at]));
            prop_assert!((every.work[at] - some.work[k]).abs() <= 1e-9 * work, "{:e} of {work:e}", every.work[at] - some.work[k]);
            prop_assert!((every.given_back[at] - some.given_back[k]).abs() <= 1e-7 * work, "{:e} {:e} of {work:e}", every.given_back[at], some.given_back[k]);
        }
        prop_assert_eq!(&coarse.events, &fine.events);
        let whole = summary(&program, &model, &Sampling::Times(many)).unwrap();
        let last = fine.len() - 1;
        prop_assert_eq!((whole.end_time, whole.force, whole.displacement), (fine.time[last], fine.force[last], fine.displacement[last]));
        prop_assert!((whole.peak_force - fine.force.iter().fold(f64::NEG_INFINITY, |most, force| most.max(*force))).abs() <= 1e-12 * force);
        prop_assert!((whole.work - every.work[last]).abs() <= 1e-9 * work);
        prop_assert!((whole.given_back - every.given_back[last]).abs() <= 1e-7 * work);
        prop_assert_eq!(whole.stored.is_some(), scene.body.has_constant_section());
        if let (Some(stored), Some(split)) = (whole.stored, &every.split) {
            prop_assert!((stored - split.stored[last]).abs() <= 1e-12 * work.max(stored));
        }
        prop_assert_eq!(whole.events, fine.events);
    }

    #[test]
    fn moves_and_holds_are_a_motion(scene in scenes(), levels in proptest::collection::vec((0.0..0.9f64, decades(-1.5, 1.0), decades(-2.0, 1.5)), 1..5)) {
        let at = |level: f64| (scene.least() + (1.0 - scene.least()) * level) * scene.body.deepest();
        let rate = |rate: f64| rate * scene.body.deepest() / scene.unit;
        let steps: Vec<ProtocolStep> =
            levels.iter().map(|(level, speed, wait)| ProtocolStep { to: at(*level), rate: rate(*speed), hold: wait * scene.unit }).collect();
        let program: Vec<ProgramStep> = steps
            .iter()
            .flat_map(|step| [ProgramStep::Move { to: step.to, rate: step.rate }, ProgramStep::HoldPosition { duration: step.hold }])
            .collect();
        let (motion, model) = (protocol(&steps).unwrap(), scene.model());
        let one = run(&scene, &motion);
        let ends = step_ends(&program, &model).unwrap();
        let knots: Vec<f64> = [0.0].into_iter().chain(ends.iter().map(|end| end.time)).collect();
        let other = simulate(&program, &model, &Sampling::Times(samples(&knots, 20))).unwrap();
        prop_assert!(far(&one.time, &other.time, 1.0) < 1e-13);
        prop_assert!(far(&one.force, &other.force, 1.0) < 1e-9, "{:e}", far(&one.force, &other.force, 1.0));
        prop_assert!(far_of(&one.contact_displacement, &other.contact_displacement, 1.0, scene.body.deepest()) < 1e-10);
        let force = simulate_force(&motion, &model, &one.time).unwrap();
        prop_assert!(far(&one.force, &force, 1.0) < 1e-12);
        prop_assert_eq!(one.events.len(), other.events.len());
    }

    /// The force that a motion brings forth, imposed in many straight pieces, brings back the motion.
    #[test]
    fn a_force_read_off_a_motion_brings_it_back(scene in scenes(), ramp in decades(-1.0, 1.0), wait in decades(-1.0, 1.0), level in 0.1..0.5f64) {
        let to = level * scene.body.deepest();
        let motion = Motion::new(vec![0.0, ramp * scene.unit, (ramp + wait) * scene.unit], vec![0.0, to, to]).unwrap();
        let times = samples(motion.times(), 120);
        let moved = simulate(&motion, &scene.model(), &Sampling::Times(times.clone())).unwrap();
        let history = ForceHistory::new(times.clone(), moved.force.clone()).unwrap();
        let pressed = match simulate(&history, &scene.model(), &Sampling::Times(times)) {
            Ok(pressed) => pressed,
            Err(error) => {
                prop_assert!(matches!(error, SimulateError::TooStiff { .. }), "{error}");
                return Ok(());
            }
        };
        prop_assert!(far(&moved.displacement, &pressed.displacement, 1.0) < 0.01, "{:e}", far(&moved.displacement, &pressed.displacement, 1.0));
    }
}
