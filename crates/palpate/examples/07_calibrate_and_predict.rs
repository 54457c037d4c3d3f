//! One test calibrates a body; any other squeeze of it is then predicted, with what the test leaves open.

use palpate::analysis::Geometry;
use palpate::calibrate::{CalibrationData, Candidate, EquilibriumLaw, calibrate};
use palpate::simulate::{ProtocolStep, Sampling, Separation, protocol, simulate_force};
use palpate::test_problems::{PAPER_RATE, Rng, paper_ball, paper_test_a};
use palpate::watch::Unwatched;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // The paper's test (a) on its ball, at 10 Hz, with a load cell good to 0.2 N.
    let (motion, ball) = (paper_test_a(), paper_ball(Separation::Unilateral));
    let times: Vec<f64> = (0..=660).map(|i| 0.1 * f64::from(i)).collect();
    let mut noise = Rng::new(1);
    let forces: Vec<f64> = simulate_force(&motion, &ball, &times)?
        .into_iter()
        .map(|force| force + 0.2 * noise.normal())
        .collect();
    let body = Geometry {
        shape: ball.specimen.shape().clone(),
        sides: ball.specimen.sides(),
        modulus: None,
        equilibrium: ball.specimen.equilibrium().clone(),
    };
    let held = [0.005, 0.010, 0.015, 0.020, 0.025];
    let data = CalibrationData::new(body, ball.separation, motion, times, forces, &held)?;

    for law in ["latency", "standard-linear-solid", "prony:2"] {
        let candidate = Candidate::new(law.parse()?, EquilibriumLaw::UniformStrain);
        let found = calibrate(&data, candidate, 0.95, &mut Unwatched)?;
        println!("{law}: leaves {:.3} N, BIC {:.0}", found.rmse, found.criteria.bic);
        for parameter in found.material.parameters() {
            println!("  {} {:.4e} {:?}", parameter.name, parameter.estimate.value, parameter.estimate.interval);
        }
        // Squeezed by 22 mm, six times as long as any hold of the test.
        let squeeze = protocol(&[ProtocolStep {
            to: 0.022,
            rate: PAPER_RATE,
            hold: 60.0,
        }])?;
        let later = found.material.predict(&squeeze, &Sampling::Times(vec![squeeze.end()]), 0.95)?;
        let force = later.trajectory.force[0];
        match later.force_interval(0) {
            Some((low, high)) => println!("  after a minute at 22 mm: {force:.2} N, {low:.2} to {high:.2} N"),
            None => println!("  after a minute at 22 mm: {force:.2} N, with an error that is not known"),
        }
        for beyond in &later.extrapolations {
            println!("  {beyond}");
        }
    }
    Ok(())
}
