//! Steps contacts at 1 kHz as a controller does, and prints every force and displacement to the last bit. Given a file of such parameters,
//! it says how far they are from its own.
//!
//! `controller/` builds it as well, without std and therefore with other elementary functions: `./test bare` compares the two.

use std::error::Error;
use std::process::ExitCode;

use palpate::contact::{Equilibrium, Layers, Shape, Sides, Specimen};
use palpate::latency::LatencyLaw;
use palpate::simulate::{ContactModel, ContactState, Separation};

/// How far two builds may be apart, in units in the last place of the largest parameter of a contact.
const MOST_UNITS: f64 = 8.0;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let mut other = match std::env::args().nth(1) {
        Some(path) => std::fs::read_to_string(path)?,
        None => String::new(),
    };
    let is_alone = other.is_empty();
    let mut worst: f64 = 0.0;
    for (name, model) in contacts()? {
        for (quantity, own) in [("forces", forces(&model)?), ("displacements", displacements(&model)?)] {
            if is_alone {
                own.iter().for_each(|parameter| println!("{parameter}"));
                continue;
            }
            let rest: Vec<&str> = other.splitn(own.len() + 1, '\n').collect();
            let theirs: Result<Vec<f64>, _> = rest[..own.len()].iter().map(|line| line.parse()).collect();
            let units = units_apart(&own, &theirs?);
            println!("{name}, {quantity}: {units:.1} units in the last place");
            worst = worst.max(units);
            other = rest[own.len()].to_owned();
        }
    }
    Ok(if worst <= MOST_UNITS { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Exponents that are products and roots, and those that are powers, logarithms and exponentials; every shape without a table.
fn contacts() -> Result<Vec<(&'static str, ContactModel)>, Box<dyn Error>> {
    let ball = Specimen::new(Shape::Ball { radius: 0.035 }, 28e3, Sides::Two)?;
    let hertz = ball.clone().with_equilibrium(Equilibrium::Hertz { poisson_ratio: 0.5 })?;
    let pad = Shape::Pad {
        radius: 0.02,
        thickness: 0.015,
    };
    let pad = Specimen::new(pad, 1e5, Sides::One)?;
    let block = Shape::Prism {
        area: 1e-4,
        length: 0.05,
    };
    let block = Specimen::new(block, 1e6, Sides::Two)?;
    let contact = |specimen: &Specimen, exponent, rate_coefficient, separation| {
        Ok::<_, Box<dyn Error>>(ContactModel {
            specimen: specimen.clone(),
            law: LatencyLaw::new(exponent, rate_coefficient)?,
            layers: Layers::new(8.0)?,
            separation,
        })
    };
    Ok(vec![
        ("ball, n = 5", contact(&ball, 5.0, 2e4, Separation::Unilateral)?),
        ("ball by Hertz, n = 4.3", contact(&hertz, 4.3, 2e4, Separation::Unilateral)?),
        ("pad, n = 1", contact(&pad, 1.0, 2.0, Separation::Unilateral)?),
        ("block, n = 0.7", contact(&block, 0.7, 0.5, Separation::Unilateral)?),
        ("bonded block, n = 2.5", contact(&block, 2.5, 50.0, Separation::Bonded)?),
    ])
}

/// Forces (N) at every tick of two strokes of 10 mm, the first with a hold; between them the jaw leaves the body, unless it is bonded.
fn forces(model: &ContactModel) -> Result<Vec<f64>, Box<dyn Error>> {
    let mut contact = ContactState::default();
    let stroke = |tick: u32| match tick {
        0..=999 => tick,
        1000..=2999 => 1000,
        3000..=3999 => 4000 - tick,
        4000..=4499 => 0,
        _ => tick - 4500,
    };
    (1..=5500u32).map(|tick| Ok(contact.step(model, 1e-3, 1e-5 * f64::from(stroke(tick)))?)).collect()
}

/// Displacements of the jaw (m) at every tick of a grip that rises to 4 N within 1 s and is kept for 2 s.
fn displacements(model: &ContactModel) -> Result<Vec<f64>, Box<dyn Error>> {
    let mut contact = ContactState::default();
    (1..=3000u32)
        .map(|tick| Ok(contact.step_force(model, 1e-3, 4e-3 * f64::from(tick.min(1000)))?))
        .collect()
}

/// Largest difference between two series, in units in the last place of the largest parameter in them.
fn units_apart(own: &[f64], theirs: &[f64]) -> f64 {
    let largest = own.iter().fold(0.0, |most: f64, parameter| most.max(parameter.abs()));
    let apart = own.iter().zip(theirs).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
    apart / (largest.next_up() - largest)
}
