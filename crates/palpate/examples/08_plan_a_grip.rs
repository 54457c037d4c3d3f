//! A calibrated ball in a gripper: how long a squeeze holds, what holds longer, and how to squeeze so that the force stays.
//!
//! Run it with `cargo run --release -p palpate --example 08_plan_a_grip`.

use palpate::analysis::Geometry;
use palpate::calibrate::{CalibrationData, Candidate, EquilibriumLaw, Material, calibrate};
use palpate::grip::{Band, Grasp, Grip, Limits, Objective, Plan, Regrip, TimeToSlip};
use palpate::simulate::{Separation, simulate_force};
use palpate::test_problems::{PAPER_RATE, Rng, paper_ball, paper_test_a};
use palpate::watch::Unwatched;

/// The paper's ball, calibrated on the paper's test (a) at 10 Hz with a load cell good to 0.05 N.
fn calibrated() -> Result<Material, Box<dyn std::error::Error>> {
    let (motion, ball) = (paper_test_a(), paper_ball(Separation::Unilateral));
    let times: Vec<f64> = (0..=660).map(|i| 0.1 * f64::from(i)).collect();
    let mut noise = Rng::new(1);
    let forces = simulate_force(&motion, &ball, &times)?
        .into_iter()
        .map(|force| force + 0.05 * noise.normal())
        .collect();
    let body = Geometry {
        shape: ball.specimen.shape().clone(),
        sides: ball.specimen.sides(),
        modulus: None,
        equilibrium: ball.specimen.equilibrium().clone(),
    };
    let held = [0.005, 0.010, 0.015, 0.020, 0.025];
    let data = CalibrationData::new(body, ball.separation, motion, times, forces, &held)?;
    let candidate = Candidate::new("latency".parse()?, EquilibriumLaw::UniformStrain);
    Ok(calibrate(&data, candidate, 0.95, &mut Unwatched)?.material)
}

fn reported(lasts: TimeToSlip) -> String {
    lasts.seconds().map_or_else(|| "always".to_owned(), |time| format!("{time:.2} s"))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let ball = calibrated()?;
    // 250 g between fingers with μ = 0.6, and a hand that starts upwards with 2 m/s².
    let grasp = Grasp {
        acceleration_up: 2.0,
        ..Grasp::new(0.25, 0.6)?
    };
    let grip = Grip::new(&ball, grasp, Limits::new(PAPER_RATE)?, 0.95)?;

    for squeeze in [6.0e-3, 7.0e-3, 8.0e-3] {
        let holding = grip.position_hold(&Plan::squeeze(squeeze, PAPER_RATE))?;
        let (low, high) = holding.interval.ok_or("no interval")?;
        println!(
            "{:.0} mm: {:.2} N, needs {:.2} N, holds {} ({} to {})",
            1e3 * squeeze,
            holding.start_force,
            holding.needed_force,
            reported(holding.time_to_slip),
            reported(low),
            reported(high)
        );
    }

    // A minute: by the best estimate, and with a confidence.
    for confidence in [None, Some(0.95)] {
        let least = grip.least(Objective::Squeeze, 60.0, confidence)?;
        let by =
            confidence.map_or_else(|| "by the best estimate".to_owned(), |share| format!("with {} %", 100.0 * share));
        println!("holds for a minute {by}: {:.3} mm", 1e3 * least.displacement);
    }

    let backed = grip.back_off(Some(9e-3), 60.0, None)?;
    println!(
        "9 mm over {:.2} mm: {:+.4} N in a minute; squeezed plainly {:+.4} N",
        1e3 * backed.over,
        backed.drift,
        backed.plain_drift
    );
    let pressed = grip.force_hold(None, 60.0)?;
    println!(
        "{:.2} N held: the body creeps from {:.2} mm to {:.2} mm",
        pressed.force,
        1e3 * pressed.displacement_start,
        1e3 * pressed.displacement_end
    );
    let schedule = grip.regrip(Band { low: 2.5, high: 3.2 }, Regrip::default(), 600.0)?;
    println!("kept between 2.5 N and 3.2 N for ten minutes by {} moves, at", schedule.moves.len());
    for squeeze in &schedule.moves {
        println!("  {:6.1} s to {:.2} mm", squeeze.time, 1e3 * squeeze.to);
    }
    Ok(())
}
