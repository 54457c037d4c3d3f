//! Simulates the paper's first squeeze and shows how the force relaxes.

use palpate::contact::{Layers, Shape, Sides, Specimen};
use palpate::latency::LatencyLaw;
use palpate::simulate::{ContactModel, ProtocolStep, Sampling, Separation, protocol, simulate};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = ContactModel {
        specimen: Specimen::new(Shape::Ball { radius: 0.035 }, 28e3, Sides::Two)?,
        law: LatencyLaw::new(5.0, 2e4)?,
        layers: Layers::new(8.0)?,
        separation: Separation::Unilateral,
    };
    let squeeze = ProtocolStep {
        to: 5e-3,
        rate: 0.5 / 60.0,
        hold: 10.0,
    };
    let motion = protocol(&[squeeze])?;
    let times = vec![0.3, 0.6, 0.7, 1.0, 2.0, 5.0, 10.6];
    let series = simulate(&motion, &model, &Sampling::Times(times))?;
    println!("time (s)   force (N)   excess strain");
    for i in 0..series.len() {
        println!("{:8.1} {:11.4} {:15.5}", series.time[i], series.force[i], series.excess_strain[i]);
    }
    Ok(())
}
