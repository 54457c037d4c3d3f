//! How long squeezes hold, the least of them, retreats, held forces, schedules.

use super::*;

#[test]
fn it_slips_when_the_closed_form_of_the_hold_says_so() {
    let material = ball(None);
    let grip = grip(&material, 0.25);
    for displacement in [0.0045, 0.005, 0.006] {
        let found = grip.position_hold(&Plan::squeeze(displacement, SPEED)).unwrap();
        // F = E A (ε_e + x) with x from its value at the start of the hold by equation (4).
        let u = displacement / 2.0;
        let stiffness = 28e3 * std::f64::consts::PI * (2.0 * 0.035 * u - u * u);
        let (start, slip) = (found.start_force / stiffness - u / 0.035, found.needed_force / stiffness - u / 0.035);
        let time = (slip.powi(-4) - start.powi(-4)) / (4.0 * 2e4);
        assert!(
            (seconds(found.time_to_slip) / time - 1.0).abs() < 1e-9,
            "{displacement}: {:?} {time}",
            found.time_to_slip
        );
        assert_eq!(found.interval, None);
        assert!(found.equilibrium_force < found.needed_force && found.peak_force == found.start_force);
        let (more, less) = (displacement * (1.0 + 1e-5), displacement * (1.0 - 1e-5));
        let times = grip.neighbours(&[less, more], SPEED);
        let slope = (seconds(times[1].1) / seconds(times[0].1)).ln() / (more - less);
        assert!((found.sharpness.unwrap() / slope - 1.0).abs() < 1e-3);
    }
    let shallow = grip.position_hold(&Plan::squeeze(0.003, SPEED)).unwrap();
    assert_eq!((shallow.time_to_slip, shallow.sharpness), (TimeToSlip::After(0.0), None));
    let deep = grip.position_hold(&Plan::squeeze(0.008, SPEED)).unwrap();
    assert!(
        deep.time_to_slip == TimeToSlip::Never
            && deep.equilibrium_force > deep.needed_force
            && deep.time_to_slip.covers(1e12)
    );
}

#[test]
fn the_interval_of_the_time_is_where_the_edges_of_the_band_slip() {
    let material = ball(Some([0.02, 0.01, 0.05, 0.01]));
    let grip = grip(&material, 0.25);
    let plan = Plan::squeeze(0.005, SPEED);
    let found = grip.position_hold(&plan).unwrap();
    let (low, high) = found.interval.unwrap();
    assert!(low < found.time_to_slip && found.time_to_slip < high, "{found:?}");
    for (time, edge) in [(seconds(low), 0), (seconds(high), 1)] {
        let course = grip.course(&plan, time, 8).unwrap();
        let band = course.force_interval(course.trajectory.len() - 1).unwrap();
        let force = if edge == 0 { band.0 } else { band.1 };
        assert!((force / found.needed_force - 1.0).abs() < 1e-9, "{force} {}", found.needed_force);
    }
    // Near to where it holds always, the later end is open.
    let near = grip.position_hold(&Plan::squeeze(0.0069, SPEED)).unwrap();
    assert!(near.time_to_slip != TimeToSlip::Never && near.interval.unwrap().1 == TimeToSlip::Never, "{near:?}");
}

#[test]
fn the_least_squeeze_holds_as_long_as_was_requested_and_less_does_not() {
    for material in [ball(None), linear(1), linear(3)] {
        let grip = grip(&material, 0.25);
        for duration in [1.0, 60.0, f64::INFINITY] {
            let least = grip.least(Objective::Squeeze, duration, None).unwrap();
            assert!(least.time_to_slip.covers(duration.min(3.1e8) * (1.0 - 1e-6)), "{least:?}");
            let PlanKind::Squeeze { displacement, speed } = least.plan.kind else {
                panic!("{least:?}")
            };
            let less = grip.position_hold(&Plan::squeeze(displacement * (1.0 - 1e-4), speed)).unwrap();
            assert!(!less.time_to_slip.covers(duration.min(3.1e8)), "{less:?}");
            // Of the other objectives none squeezes less, each has least of its own.
            let [peak, work] =
                [Objective::PeakForce, Objective::Work].map(|objective| grip.least(objective, duration, None).unwrap());
            assert!(peak.displacement >= displacement * (1.0 - 1e-9));
            assert!(peak.peak_force <= least.peak_force && peak.peak_force <= work.peak_force * (1.0 + 1e-9));
            assert!(work.work <= least.work && work.work <= peak.work * (1.0 + 1e-9));
            for found in [&peak, &work] {
                assert!(found.time_to_slip.covers(duration.min(3.1e8) * (1.0 - 1e-6)), "{found:?}");
                assert!(found.closing <= 2.0 * (1.0 + 1e-9));
            }
        }
    }
    let sure = ball(Some([0.02, 0.01, 0.05, 0.01]));
    let grip = grip(&sure, 0.25);
    let [best, confident] =
        [None, Some(0.95)].map(|confidence| grip.least(Objective::Squeeze, 60.0, confidence).unwrap());
    assert!(confident.displacement > best.displacement);
    assert!((seconds(confident.assured.unwrap()) / 60.0 - 1.0).abs() < 1e-3, "{confident:?}");
    assert_eq!(best.assured, None);
    // The probability of the same plans, and of what the calibration says nothing of.
    let probability = |found: &PositionHold| grip.probability(&found.plan, 60.0).unwrap().unwrap();
    assert!((probability(&confident) - 0.95).abs() < 1e-6 && (probability(&best) - 0.5).abs() < 1e-6);
    assert_eq!(self::grip(&ball(None), 0.25).probability(&best.plan, 60.0), Ok(None));
}

#[test]
fn after_a_retreat_the_force_stays_where_it_is() {
    let material = ball(Some([0.02, 0.01, 0.05, 0.01]));
    let grip = grip(&material, 0.25);
    let found = grip.back_off(None, 3600.0, None).unwrap();
    assert!(found.over > found.backed.displacement && found.backed.displacement == found.plain.displacement);
    assert!(found.drift.abs() < 1e-9 * found.backed.start_force, "{}", found.drift);
    assert!(found.plain_drift < -0.5 * found.backed.start_force, "{}", found.plain_drift);
    assert!((found.backed.start_force / found.backed.needed_force - 1.0).abs() < 1e-6);
    assert_eq!(found.backed.time_to_slip, TimeToSlip::Never);
    // Farther and it rises, nearer and it falls; by little, for an excess this small hardly relaxes where n = 5.
    for (by, sign) in [(1.02, 1.0), (0.98, -1.0)] {
        let plan = Plan::back_off(found.over * by, found.backed.displacement, SPEED);
        let ends = step_ends(&plan.held(3600.0), material.contact()).unwrap();
        assert!((ends[2].force - ends[1].force) * sign > 1e-3, "{by}: {ends:?}");
    }
    // What 1 % of a number does, done by hand.
    for (index, stated) in found.sensitivities.iter().enumerate() {
        let mut factors = [1.0; 4];
        factors[index] = 1.01;
        let contact = material.contact_off(&factors).unwrap();
        let ends = step_ends(&Plan::back_off(found.over, found.backed.displacement, SPEED).steps, &contact).unwrap();
        let body = contact.specimen();
        let u = found.backed.displacement / 2.0;
        let missed = ends[1].force - body.force(body.equilibrium_strain(u), u);
        assert!((stated.missed - missed).abs() < 0.1 * missed.abs().max(1e-5), "{stated:?} {missed}");
        assert_eq!(stated.error.map(|error| (1e6 * error).round()), Some([2e4, 1e4, 5e4, 1e4][index]));
    }
    assert_eq!(found.sensitivities.len(), 4);
    // The modulus scales all forces alike.
    assert!(found.sensitivities[0].missed.abs() < 1e-9 && found.sensitivities[0].over.abs() < 1e-9);
    // One linear term has one excess, which can be made to vanish; of three the sum can, and a drift is left.
    let [one, three] = [linear(1), linear(3)].map(|material| {
        let grip = self::grip(&material, 0.25);
        let found = grip.back_off(Some(0.008), 60.0, None).unwrap();
        found.drift / found.backed.start_force
    });
    assert!(one.abs() < 1e-9 && three.abs() > 1e-3, "{one} {three}");
}

/// Half of the numbers that go with the record slip from the least squeeze whose equilibrium force is enough.
#[test]
fn a_retreat_with_a_confidence_holds_with_the_lower_end_of_its_interval() {
    let material = ball(Some([0.02, 0.01, 0.05, 0.01]));
    let grip = grip(&material, 0.25);
    let [best, confident] = [None, Some(0.95)].map(|confidence| grip.back_off(None, 3600.0, confidence).unwrap());
    assert_eq!(best.backed.interval.unwrap().0, TimeToSlip::After(0.0));
    assert!(confident.backed.assured.unwrap().covers(3600.0), "{confident:?}");
    let less = grip.back_off(Some(confident.backed.displacement * (1.0 - 1e-5)), 3600.0, Some(0.95)).unwrap();
    assert!(!less.backed.assured.unwrap().covers(3600.0), "{less:?}");
    // Not more than a few standard errors of the equilibrium force, which rises with the square of the squeeze.
    let more = confident.backed.displacement / best.backed.displacement - 1.0;
    assert!((0.01..0.1).contains(&more), "{more}");
    let limits = Limits {
        stroke: Some(best.over * 1.001),
        ..Limits::new(SPEED).unwrap()
    };
    let short = Grip::new(&material, *grip.grasp(), limits, 0.95).unwrap();
    assert!(short.back_off(None, 3600.0, None).is_ok());
    assert!(matches!(short.back_off(None, 3600.0, Some(0.95)), Err(GripError::NoBackOff { .. })));
}

#[test]
fn held_forces_do_not_slip_and_creep() {
    let material = ball(None);
    let mut grasp = Grasp::new(0.25, 0.6).unwrap();
    let held = grip(&material, 0.25).force_hold(None, 3600.0).unwrap();
    assert!((held.force - 0.25 * 9.806_65 / 1.2).abs() < 1e-12 && held.holds);
    let relaxed = held.displacement_relaxed.unwrap();
    assert!(held.displacement_start < held.displacement_end && held.displacement_end < relaxed, "{held:?}");
    assert!((grip(&material, 0.25).equilibrium_force(relaxed) / held.force - 1.0).abs() < 1e-9);
    // A stroke that ends on the way.
    let limits = Limits {
        stroke: Some(0.5 * (held.displacement_start + held.displacement_end)),
        ..Limits::new(SPEED).unwrap()
    };
    let short = Grip::new(&material, grasp, limits, 0.95).unwrap().force_hold(None, 3600.0).unwrap();
    let ends = short.stroke_ends.unwrap();
    let there = step_ends(&[short.steps[0], ProgramStep::HoldForce { duration: ends }], material.contact());
    assert!((there.unwrap()[1].displacement / limits.stroke.unwrap() - 1.0).abs() < 1e-9);
    // Torsion needs more force where the contact is small: the least is where both meet.
    grasp.off_centre = 0.02;
    let twisted = Grip::new(&material, grasp, Limits::new(SPEED).unwrap(), 0.95)
        .unwrap()
        .force_hold(None, 60.0)
        .unwrap();
    assert!((twisted.force / twisted.needed_force - 1.0).abs() < 1e-9 && twisted.force > 1.5 * held.force);
}

#[test]
fn schedules_keep_the_force_in_the_band() {
    let material = ball(None);
    let grip = grip(&material, 0.25);
    let band = Band { low: 2.1, high: 3.0 };
    let fewest = grip.regrip(band, Regrip::default(), 3600.0).unwrap();
    let least = grip.regrip(band, Regrip::LeastWork { shortest_pause: 0.1 }, 3600.0).unwrap();
    assert!(fewest.moves.len() > 1 && least.moves.len() >= fewest.moves.len() && least.work < fewest.work);
    for schedule in [&fewest, &least] {
        let course = grip.schedule_course(schedule, 200).unwrap();
        let after = schedule.moves[0].to / SPEED;
        for (time, force) in course.trajectory.time.iter().zip(&course.trajectory.force) {
            let inside = *force > band.low * (1.0 - 1e-9) && *force < band.high * (1.0 + 1e-9);
            assert!(inside || *time < after, "{time}: {force}");
        }
        assert!((course.trajectory.time.last().unwrap() - after - 3600.0).abs() < 1e-6);
        for pair in schedule.moves.windows(2) {
            assert!((pair[1].force_from / band.low - 1.0).abs() < 1e-6 && pair[1].to > pair[0].to);
        }
    }
    // The shortest pause counted for nothing of the fewest moves.
    for objective in [Regrip::LeastWork { shortest_pause: 0.5 }, Regrip::FewestMoves { shortest_pause: 0.5 }] {
        let hasty = grip.regrip(band, objective, 3600.0).unwrap_err();
        assert!(matches!(hasty, GripError::TooManyMoves { moves: 1, .. }), "{hasty}");
    }
    assert_eq!(grip.regrip(band, Regrip::FewestMoves { shortest_pause: 0.1 }, 3600.0).unwrap().moves, fewest.moves);
    let narrow = grip.regrip(Band { low: 2.1, high: 2.1001 }, Regrip::default(), 3600.0).unwrap_err();
    assert!(matches!(narrow, GripError::TooManyMoves { .. }) && narrow.is_answer(), "{narrow}");
}
