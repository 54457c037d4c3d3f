//! A contact watched tick by tick: when the hold began, where it tends, when it slips, and what a tick costs.
//!
//! Run it with `cargo run --release -p palpate --example 09_watch_a_hold`.

use std::time::Instant;

use palpate::grip::TimeToSlip;
use palpate::observe::{ContactPhase, Observer, ObserverOptions, Slip, SlipForecast};
use palpate::simulate::{ContactState, Separation};
use palpate::test_problems::{Rng, paper_ball};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = paper_ball(Separation::Unilateral);
    let mut contact = ContactState::default();
    let mut noise = Rng::new(1);
    // A gripper at 1 kHz: 5 mm within 0.6 s, then a hold; what it holds slips below 1.6 N.
    let mut observer = Observer::new(ObserverOptions {
        slip_force: Some(1.6),
        ..ObserverOptions::default()
    })?;
    let (mut warned, mut slipped, mut reported, mut worst, mut all) = (false, false, 0, 0.0f64, 0.0f64);
    let ticks = 60_000;
    for tick in 1..=ticks {
        let time = 1e-3 * f64::from(tick);
        let displacement = 5e-3 * (time / 0.6).min(1.0);
        let force = contact.step(&model, 1e-3, displacement)?;
        let (displacement, force) = (displacement + 1e-6 * noise.normal(), force + 0.05 * noise.normal());
        let started = Instant::now();
        let observed = observer.feed(time, Some(displacement), force)?;
        let cost = started.elapsed().as_secs_f64();
        worst = worst.max(cost);
        all += cost;
        if observed.began {
            println!("{time:.3} s: a hold began at {:.3} s", observed.held_since.unwrap_or(time));
        }
        if observed.phase == ContactPhase::Holding && time > 0.7 + 2.0 * f64::from(reported) && reported < 4 {
            reported += 1;
            match observed.time_to_slip {
                Some(SlipForecast::Known {
                    best: TimeToSlip::After(value),
                    low: TimeToSlip::After(low),
                    high: TimeToSlip::After(high),
                }) => {
                    println!("{time:.3} s: slips in {value:.1} s ({low:.1} to {high:.1} s)");
                }
                _ => println!("{time:.3} s: time to slip is still open"),
            }
        }
        if observed.slip == Slip::Soon && !warned && time > 1.0 {
            warned = true;
            println!("{time:.3} s: warned, {:.2} N", observed.force);
        }
        if observed.slip == Slip::Slipping && !slipped {
            slipped = true;
            println!("{time:.3} s: slips");
        }
    }
    println!("a tick took {:.2} µs on average and {:.0} µs at worst", 1e6 * all / f64::from(ticks), 1e6 * worst);
    println!("an observer takes {} bytes", std::mem::size_of::<Observer>());
    Ok(())
}
