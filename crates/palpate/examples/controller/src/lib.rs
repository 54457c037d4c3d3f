//! The contact in a controller: no operating system, no standard library, no allocator.
//!
//! `cargo build --release` makes a static library of it, with `--target thumbv7em-none-eabihf` for a Cortex-M4. Of anything in it that
//! needed std the compiler would refuse the panic handler, of anything that allocated it would ask for an allocator.

#![no_std]

use palpate::contact::{Layers, Shape, Sides, Specimen};
use palpate::latency::LatencyLaw;
use palpate::simulate::{ContactModel, ContactState, Separation};

/// Moves the jaw to `displacement` (m, since first touch) within `dt` (s) and returns the contact force (N).
///
/// `state` is the contact between two ticks; zeros are a body at rest at first touch. A step that cannot be taken gives NaN and
/// leaves the state as it was.
#[unsafe(no_mangle)]
pub extern "C" fn contact_step(state: &mut [u8; 16], dt: f64, displacement: f64) -> f64 {
    step(state, dt, displacement).unwrap_or(f64::NAN)
}

fn step(state: &mut [u8; 16], dt: f64, displacement: f64) -> Option<f64> {
    let model = fingertip()?;
    let mut contact = ContactState::from_bytes(*state).ok()?;
    let force = contact.step(&model, dt, displacement).ok()?;
    *state = contact.to_bytes();
    Some(force)
}

/// A gripper's fingertip of 10 mm radius with 4 mm of silicone, as `palpate analyze` found its law.
fn fingertip() -> Option<ContactModel> {
    let pad = Shape::Pad {
        radius: 0.01,
        thickness: 0.004,
    };
    Some(ContactModel {
        specimen: Specimen::new(pad, 1.2e5, Sides::One).ok()?,
        law: LatencyLaw::new(4.3, 8e3).ok()?,
        layers: Layers::new(6.0).ok()?,
        separation: Separation::Unilateral,
    })
}

/// What a machine does about a mistake of ours is its own: a reset, a brake.
#[panic_handler]
fn stop(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {
        core::hint::spin_loop();
    }
}
